#!/usr/bin/env bash
# additivity.sh MIMIK FOLDER: what a shell meets of 'mimik additivity'.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

# Synthetic emotions are sums of their units, each with an intensity of its own, so the sum explains most of them.
"$mimik" synthesize db --subjects 3 --seed 2 --expressions 6,12,HAPPY,1 --quiet
"$mimik" preprocess db -o work --quiet
"$mimik" additivity work -o rows.csv --json --quiet >found.json
[ "$(wc -l <rows.csv)" -eq 4 ] || fail "not a row for each person"
grep -q '^HAPPY,6+12,bs000,[0-9]' rows.csv || fail "bs000 is missing"
value() { sed -n "/\"$1\": {/,/}/s/.*\"share\": \([-0-9.e]*\).*/\1/p" found.json | head -n 1; }
awk -v sum="$(value scaled_sum)" -v alone="$(value alone)" 'BEGIN { exit !(sum > 0.6 && sum > alone) }' ||
  fail "the sum explains $(value scaled_sum), one unit $(value alone)"
claim "every person with all scans is a row, and synthetic emotions are sums"

"$mimik" additivity work --threads 1 -o again.csv --quiet >table.md
cmp rows.csv again.csv
grep -q '^| HAPPY | 6+12 | 3 |' table.md || fail "no table"
claim "any number of threads gives the same bytes"

expect_code 2 "is one Action Unit" "$mimik" additivity work --expression 12
expect_code 2 "nobody was scanned with A1A12" "$mimik" additivity work --expression 1+12
expect_code 2 "moving" "$mimik" additivity work --moving 0
claim "what cannot be asked is said"
