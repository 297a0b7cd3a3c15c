#!/usr/bin/env bash
# units.sh MIMIK FOLDER: a database in a unit that nobody said becomes no face in wrong millimetres.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"
inches=$(cd "$(dirname "${BASH_SOURCE[0]}")/../data/foreign/units-unsaid/inches" && pwd)

"$mimik" scans "$inches" --check --no-index >doctor.txt || true
what='looks like inches'
mend='multiply all coordinates of scan and landmarks by 25.4'
grep -qF "$what" doctor.txt && grep -qF "$mend" doctor.txt || { cat doctor.txt; fail "the doctor does not see the unit"; }
expect_code 2 "bs000_N_N_0
$what
$mend" "$mimik" preprocess "$inches" -o work --quiet
[ ! -e work/workspace.json ] && [ ! -e work/faces ] || fail "faces in inches"
claim "inches without a word are refused in the doctor's words, with 2 as no scan is left"

"$mimik" preprocess "$inches" -o work --unit inch --json >inch.json
grep -q '"preprocessed": 4' inch.json
"$mimik" distance work/average/average_face.ply work/faces/bs000/bs000_N_N_0.ply --json --quiet >/dev/null
awk '/"eye_outer_left"|"eye_outer_right"/ { found = 1 } END { exit !found }' work/average/average_face.json
claim "with their unit given they are faces in millimetres"

mkdir table
cp -r "$inches"/bs00* table
awk 'NR == 1 { print $0 ",unit" } NR > 1 { print $0 (/bs000,N/ ? ",cm" : ",inch") }' "$inches/manifest.csv" >table/manifest.csv
expect_code 2 "bs000_N_N_0" "$mimik" preprocess table -o work2 --quiet
sed -i 's/,cm$/,inch/; s/\(bs001,AU12.*\),inch$/\1,m/' table/manifest.csv
expect_code 1 "bs001_LFAU_12_0: 
--unit
--accept unit" "$mimik" preprocess table -o work2 --quiet
[ -e work2/faces/bs000/bs000_LFAU_12_0.ply ] && [ ! -e work2/faces/bs001/bs001_LFAU_12_0.ply ] || fail "which faces"
claim "the manifest says the unit of each scan, and one wrong scan is refused alone, with 1"

expect_code 2 "unit 'foot' is not known" "$mimik" preprocess table -o work3 --unit foot
expect_code 2 "--accept: accept is 'holes'; give unit, frame" "$mimik" preprocess table -o work3 --accept holes
[ ! -e work3 ] || fail "a folder for nothing"
claim "other words for a unit or an error are refused"
