#!/usr/bin/env bash
# preprocess.sh MIMIK FOLDER SHARED: what a shell meets of 'mimik preprocess'.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_database
borrow_workspace
"$mimik" preprocess "$shared/db1" -o work1 --json >again.json
grep -q '"preprocessed": 0' again.json
claim "a second run finds everything done"

"$mimik" preprocess db1 -o x --au au12_l --dry-run --quiet | grep -q '^9 scans'
claim "an expression may be typed in every way in which it is written"

expect_code 2 "no subject bs077, Bs078;" "$mimik" preprocess db1 -o x --subject bs077,bs000,Bs078
expect_code 2 "is not a folder" "$mimik" preprocess nowhere -o x
expect_code 2 "--trim: trim is 2" "$mimik" preprocess db1 -o x --trim 2
[ ! -e x ]
claim "wrong input is named, ends with 2 and leaves nothing behind"

"$mimik" preprocess "$shared/db1" -o work1 --keep-all --dry-run | grep -q '^15 scans: 0 up to date, 15 remain' || fail "--keep-all changed nothing"
claim "--keep-all makes every face anew"

echo "no table" >bad.toml
expect_code 2 "trim is nan" "$mimik" preprocess db1 -o x --trim nan --dry-run
expect_code 2 "100000" "$mimik" preprocess db1 -o x --rows 100000 --dry-run
expect_code 2 "bad.toml" "$mimik" preprocess db1 -o x --catalogue bad.toml --dry-run
expect_plan_in_json "preprocess db1 -o x"
"$mimik" preprocess "$shared/db1" -o work1 --dry-run | grep -qx '15 scans: 15 up to date, 0 remain: about 0 s, 0 MB in work1' || fail "what is there is not done again"
"$mimik" preprocess db1 -o x --dry-run | grep -q '^15 scans: 0 up to date, 15 remain: about [0-9]* s, [0-9]* MB in x$' || fail "nothing is there yet"
"$mimik" preprocess db1 -o x --dry-run --json --threads "$(nproc)" >estimate.json
"$mimik" preprocess db1 -o x --dry-run --json --threads 1024 | diff estimate.json -
[ ! -e x ]
claim "a dry run refuses what the run would, and believes in no more threads than there are cores"

# A database of its own: should it be written into, the tests beside this one do not see it.
cp -rs "$shared/db1" own
ls -R own >before.txt
for place in own own/work own/bs000 own/truth/work work1/../own/new; do
  for dry in "" --dry-run; do expect_code 2 "nothing is written" "$mimik" preprocess own -o $place $dry; done
done
ls -R own | cmp before.txt - || fail "the database was written into"
claim "no workspace is made in a database"
expect_refusal_of_bad_folders "preprocess db1 -o"
expect_code 2 "--output: is empty; give a folder" "$mimik" preprocess db1 -o ""
claim "a folder that takes no workspace is found out before the work and in a dry run"

code=0
without_drawing_program preprocess db1 -o work2 --sheets --quiet >out.txt 2>err.txt || code=$?
[ "$code" -eq 1 ] && [ "$(grep -c 'mimik-figure is neither' err.txt)" -eq 1 ] && [ ! -e work2/sheets ] || { cat err.txt; fail "no drawing program: $code"; }
"$mimik" evaluate work2 --expression 12 --dry-run --quiet >/dev/null
claim "a missing drawing program is said once, with 1, and the workspace is whole"
if can_draw; then
  "$mimik" preprocess db1 -o work2 --sheets --json >sheets.json
  grep -q '"drawn": 3' sheets.json
  is_png work2/sheets/bs001.png
  "$mimik" preprocess db1 -o work2 --sheets --json >sheets.json
  grep -q '"drawn": 0' sheets.json && grep -q '"failures": \[\]' sheets.json || fail "sheets drawn again"
  claim "quality sheets are drawn once"
fi

# The same landmark is missing in every expressive scan.
cp -rL "$shared/db1" sparse
for file in sparse/*/*AU_*.lm3; do
  awk '/^Nose tip/ { getline; next } { print }' "$file" >marks.lm3
  sed 's/^\([0-9]*\) landmarks:/21 landmarks:/' marks.lm3 >"$file"
done
"$mimik" preprocess sparse -o sparse_work >/dev/null 2>notes.txt || true
[ "$(grep -c 'lacks nose_tip' notes.txt)" -eq 1 ] && grep -q '^note: bs000_LFAU_12_0 and 8 more: .*lacks nose_tip' notes.txt || { cat notes.txt; fail "notes are not grouped"; }
claim "a note that holds for many scans is one line with their count"
