#!/usr/bin/env bash
# cleaning.sh MIMIK FOLDER SHARED: 'mimik preprocess --cleaning pcl', with the module and without it.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_database
expect_code 2 $'--cleaning\nlibpcl-dev' env MIMIK_COMPANIONS=/nowhere "$mimik" preprocess db1 -o x --cleaning pcl
expect_code 2 "libpcl-dev" env MIMIK_COMPANIONS=/nowhere "$mimik" preprocess db1 -o x --cleaning pcl --dry-run
expect_code 2 "give own or pcl" "$mimik" preprocess db1 -o x --cleaning pvl
expect_code 2 "--pcl-deviations is an option of --cleaning pcl" "$mimik" preprocess db1 -o x --pcl-deviations 2
expect_code 2 "--spike-mm is an option of --cleaning own" "$mimik" preprocess db1 -o x --cleaning pcl --spike-mm 2
[ ! -e x ]
claim "a module that is not there is named with the package, and no option is passed over"

"$mimik" preprocess "$shared/db1" -o "$shared/work1" --cleaning own --dry-run | grep -q ' 0 remain' || fail "another fingerprint"
claim "the own cleaning makes the faces that it made before"

if [ ! -e "$(dirname "$mimik")/../libexec/mimik/mimik-pcl.so" ]; then
  echo "not checked: mimik-pcl.so is not built (scripts/setup.sh --adapters installs PCL)"
  exit 0
fi
expect_code 2 "--pcl-neighbours: neighbours is 0" "$mimik" preprocess db1 -o x --cleaning pcl --pcl-neighbours 0
[ ! -e x ]
"$mimik" preprocess db1 -o work --cleaning pcl --threads 1 --json >one.json
grep -q '"preprocessed": 15' one.json || { cat one.json; fail "faces"; }
grep -q 'clean pcl 24 3' work/workspace.json || fail "the workspace does not say how it was cleaned"
"$mimik" preprocess db1 -o two --cleaning pcl --threads 2 --quiet >/dev/null
diff -r work/faces two/faces
claim "PCL cleans a database, the workspace says so, and threads change no byte"
"$mimik" preprocess db1 -o two --cleaning pcl --dry-run | grep -q '15 up to date' || fail "not up to date"
"$mimik" preprocess db1 -o two --cleaning pcl --pcl-deviations 4 --dry-run | grep -q ' 0 up to date' || fail "another value is not seen"
"$mimik" preprocess db1 -o two --dry-run | grep -q ' 0 up to date' || fail "another cleaning is not seen"
claim "another cleaning, or another value of it, makes the faces anew"
