#!/usr/bin/env bash
# catalogue.sh MIMIK FOLDER: what a shell meets of 'mimik catalogue'.
set -euo pipefail
page=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/docs/facs_catalogue.md
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

"$mimik" catalogue --lint >lint.txt
grep -q ': 0 errors' lint.txt || fail "the catalogue that is shipped has faults"
"$mimik" catalogue --text >own.toml
"$mimik" catalogue own.toml --json >own.json
"$mimik" catalogue --json | diff <(grep -v '"catalogue"' own.json) <(grep -v '"catalogue"') || fail "its text is not what it is"
"$mimik" catalogue >table.txt  # grep -q hears no more than it needs, and a closed pipe is a failure
grep -q "Table 3-2 (pp. 36-37), AU 12, after FACS (1978); course: .* Table 3-1 (pp. 30-32) (AU 12)" table.txt || fail "references of the muscles"
grep -q '"reference": "Erdogdu 2010, Table 3-2' own.json || fail "reference of a muscle"
"$mimik" catalogue --thesis --text >thesis.toml
grep -q '^# Tuned on: ' thesis.toml || fail "where the points of the thesis were tuned"
grep -q '^FEAR  *thesis  *1+2+4+5+20+27' table.txt || fail "the emotions of Table 3-3"
claim "the catalogue that is shipped has no fault, and its text reads back the same"
for other in --json --lint; do
  expect_code 2 $'--text\n'$other "$mimik" catalogue --text $other
  ! grep -q '\[' out.txt || fail "the text all the same"
done
claim "the text of a catalogue is neither JSON nor a check, and what asks for both is refused"
sed -n '/^```toml$/,/^```$/p' "$page" | grep -v '^```' >printed.toml
grep -q '^\[\[au\]\]' printed.toml && grep -q '^\[\[emotion\]\]' printed.toml || fail "the example was not found"
expect_code 0 ": 0 errors" "$mimik" catalogue printed.toml --lint
claim "the catalogue that the documentation prints has no error"
line=$(grep -n -m1 'mouth_corner = 1.0' own.toml | cut -d: -f1)
sed "${line}s/mouth_corner = 1.0/mouth_korner = 1.0/" own.toml >wrong.toml
expect_code 2 "wrong.toml:$line: error: "$'\nmouth_korner' "$mimik" catalogue wrong.toml --lint
expect_code 2 "$line"$'\nmouth_korner' "$mimik" catalogue wrong.toml
sed "${line}s/ = 1.0/ = = 1.0/" own.toml >broken.toml
expect_code 2 "broken.toml:$line: error: " "$mimik" catalogue broken.toml --lint
claim "a wrong name and broken TOML are said with file and line"
for command in "catalogue --text" "catalogue --help"; do expect_refusal_of_full_disk "$command"; done
claim "a catalogue that standard output does not take ends with 2"
