#!/usr/bin/env bash
# synthesize.sh MIMIK FOLDER SHARED: what a shell meets of 'mimik synthesize'.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

"$mimik" synthesize x --expressions 4,12,12L --dry-run --quiet >plan.txt
"$mimik" synthesize x --expressions au4,AU12,au12_l --dry-run --quiet | cut -d, -f1 | diff <(cut -d, -f1 plan.txt) -
claim "an expression may be typed in every way in which it is written"

expect_code 2 "--spacing: spacing_mm is 0" "$mimik" synthesize x --spacing 0
expect_code 2 "--eye-holes: eye_hole_share is 2" "$mimik" synthesize x --eye-holes 2
expect_code 2 $'--seed\n-1' "$mimik" synthesize x --seed -1
[ ! -e x ]
claim "wrong input is named, ends with 2 and leaves nothing behind"

borrow_database
expect_plan_in_json "synthesize x"
expect_code 2 "db1: exists already" "$mimik" synthesize db1 --dry-run
expect_code 2 "MB free" "$mimik" synthesize x --subjects 1000 --expressions all --spacing 0.2 --texture-density 10 --dry-run
[ ! -e x ]
ln -s later link
"$mimik" synthesize link --subjects 1 --expressions N --dry-run --quiet >/dev/null
[ ! -e later ]
claim "a dry run refuses what the run would and writes nothing"
expect_refusal_of_bad_folders synthesize
claim "a folder that takes no database is found out before the work and in a dry run"

mkdir stopped
"$mimik" synthesize stopped/db --subjects 30 --expressions all 2>stopped.txt &
job=$!
for _ in $(seq 600); do [ -n "$(ls -A stopped)" ] && break; sleep 0.1; done
[ -n "$(ls -A stopped)" ] || { cat stopped.txt; fail "nothing was begun"; }
kill -TERM $job
code=0
wait $job || code=$?
[ "$code" -eq 143 ] && [ -z "$(ls -A stopped)" ] || { cat stopped.txt; fail "exit code $code, left: $(ls -A stopped)"; }
claim "a run that is told to stop leaves nothing behind"
