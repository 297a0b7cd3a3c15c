#!/usr/bin/env bash
# scans.sh MIMIK FOLDER SHARED: what a shell meets of 'mimik scans'.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_database
"$mimik" scans db1 --json --no-catalogue >scans.json
grep -q '"schema"' scans.json
"$mimik" scans db1 --check --no-catalogue >check.txt 2>remarks.txt
! grep -q warning check.txt && grep -q '0 of 15 scans have errors' check.txt || { cat check.txt; fail "warnings"; }
! grep -v "^checking: " remarks.txt || fail "remarks"
claim "the doctor has neither a warning nor a remark on a synthetic database"

"$mimik" scans db1 --au AU12 --side left --no-catalogue 2>/dev/null | grep -q ': 3 scans of 3 subjects'
expect_code 2 $'--au is \'12L\'\n--side' "$mimik" scans db1 --au 12L
claim "a side is asked for by its own option, and who types it into the Action Unit is told so"
expect_code 2 "--landmark-off-mm: landmark_off_scan_mm is 0" "$mimik" scans db1 --landmark-off-mm 0
claim "wrong input is named and ends with 2"
