#!/usr/bin/env bash
# scans.sh MIMIK FOLDER SHARED: what a shell meets of 'mimik scans'.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_database
"$mimik" scans db1 --json --no-index >scans.json
grep -q '"schema"' scans.json
"$mimik" scans db1 --check --no-index >check.txt 2>remarks.txt
! grep -q warning check.txt && grep -q '0 of 15 scans have errors' check.txt || { cat check.txt; fail "warnings"; }
! grep -v "^checking: " remarks.txt || fail "remarks"
claim "the doctor has neither a warning nor a remark on a synthetic database"

# All in one folder; the scans themselves are not touched.
mkdir cm
echo "subject,expression,scan,landmarks,unit" >cm/manifest.csv
for subject in bs000 bs001 bs002; do
  for scan in N_N_0 LFAU_12_0; do
    cp "$shared/db1/$subject/${subject}_$scan".{bnt,lm3} cm/
    echo "$subject,${scan%_0},${subject}_$scan.bnt,${subject}_$scan.lm3,cm" >>cm/manifest.csv
  done
done
expect_code 1 $'error (unit): 6 scans\nlooks like millimetres, though manifest.csv says cm\nand 3 more; --list names every one\nput mm in the column unit' "$mimik" scans cm --check --no-index
[ "$(grep -c 'error (unit)' out.txt)" -eq 1 ] && [ "$(grep -c 'mend: put mm' out.txt)" -eq 1 ] || { cat out.txt; fail "groups"; }
expect_code 1 "error (unit): 6 scans" "$mimik" scans cm --check --no-index --list
for subject in bs000 bs001 bs002; do
  [ "$(grep -c "^    ${subject}_N_N_0: its landmarks are" out.txt)" -eq 1 ] || { cat out.txt; fail "$subject stands there once"; }
done
"$mimik" scans cm --check --no-index --json >cm.json 2>/dev/null || [ $? -eq 1 ]
grep -A 4 '"finding_counts"' cm.json | grep -q '"severity": "error"' && grep -q '"scans": 6' cm.json || fail "counts in JSON"
claim "what is alike is said once with the number of scans, each of them once"

"$mimik" scans db1 --au AU12 --side left --no-index 2>/dev/null | grep -q ': 3 scans of 3 subjects'
expect_code 2 $'--au is \'12L\'\n--side' "$mimik" scans db1 --au 12L
claim "a side is asked for by its own option, and who types it into the Action Unit is told so"
expect_code 2 "--landmark-off-mm: landmark_off_scan_mm is 0" "$mimik" scans db1 --landmark-off-mm 0
claim "wrong input is named and ends with 2"

expect_code 0 "note: --no-catalogue is called --no-index now" "$mimik" scans db1 --no-catalogue
"$mimik" scans db1 --no-catalogue --json 2>note.txt >old.json
"$mimik" scans db1 --no-index --json 2>new.txt >new.json
cmp old.json new.json && [ ! -s new.txt ] && grep -q '"index": {' new.json || fail "the flags differ"
! "$mimik" scans --help | grep -q no-catalogue || fail "the old flag is in the help"
claim "the flag that was called otherwise still works, with a note"
