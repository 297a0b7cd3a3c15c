#!/usr/bin/env bash
# evaluate.sh MIMIK FOLDER SHARED: what a shell meets of 'mimik evaluate'.
set -euo pipefail
page=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/docs/algorithms/estimators.md
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_workspace
"$mimik" evaluate work1 --expression 4,12 --method default,mean --no-reference -o scores --json --quiet >scores.json
for name in scores.md scores.csv scores.json cases.csv; do [ -s "scores/$name" ] || fail "scores/$name is not there"; done
cmp scores.json scores/scores.json
for line in '"marking_jitter": 1.0' '"spikes": 0.0' '"expressions": "4,12,12L"' '"neutrals": 2' '"subjects": 3'; do grep -qF "$line" scores.json || fail "scores.json has no $line"; done
grep -qF '"zones": "truth"' scores.json
"$mimik" evaluate work1 --expression 12 --method mean --no-reference --no-whole-face --zones catalogue -o drawn --json --quiet >drawn.json
grep -qF '"zones": "catalogue"' drawn.json
expect_code 2 "--zones" "$mimik" evaluate work1 --expression 12 --zones guess
claim "scores are written as text, table and JSON, and JSON is what is printed"
"$mimik" evaluate work1 --expression 12 --method thesis,thesis-tuned --no-whole-face --on-itself -o scores --json --quiet >itself.json
cmp itself.json scores/on_itself.json
cmp scores.json scores/scores.json || fail "rows of a source on itself went into the usual ones"
grep -qF '"pairs": "source on itself"' itself.json
awk -F, 'NR > 1 && !/^#/ && $1 != "" && $1 != $2 { exit 1 }' scores/cases_on_itself.csv || fail "two people in cases_on_itself.csv"
expect_code 2 "--on-itself"$'\nmethod \'mean\'' "$mimik" evaluate work1 --expression 12 --method mean --on-itself
claim "a source on itself has files of its own, and no mean"
"$mimik" tune work1 --au 12 --hold-out 3 --most 3 --first-step 2 --last-step 2 --most-evaluations 20 -o tuned.toml --json --quiet >tuned.json
"$mimik" catalogue tuned.toml --lint | grep -q ': 0 errors' || fail "the tuned catalogue has faults"
grep -q '^# Tuned on: .* seed 5, 2 subjects' tuned.toml && grep -q '^# Not seen: .* seed 5, 1 subject ' tuned.toml || { head -n 12 tuned.toml; fail "where it was tuned"; }
grep -q '"moved_mm"' tuned.json
"$mimik" evaluate work1 --expression 12 --method thesis --catalogue tuned.toml --no-reference --no-whole-face -o retuned --quiet >/dev/null
expect_code 2 "12L" "$mimik" tune work1 --au 12L -o none.toml
expect_code 2 "is tuned on, too" "$mimik" tune work1 --unseen work1 --au 12 -o none.toml
claim "tune writes a catalogue that says where it was tuned, and evaluate takes it"
# A comment line ends each unit of work: the cast of an expression, an expression of a target. No comma stands in a subject, an expression or a
# method: a row is split at every comma that is not within quotes.
awk '
  { row = $0; gsub(/"([^"]|"")*"/, "", row); columns = gsub(/,/, "", row) }
  /^#/ { units++; next }
  NR == 1 { wanted = columns; if ($0 !~ /(^|,)source,/ || $0 !~ /,target,/ || $0 !~ /,metric,/ || $0 !~ /,value(,|$)/) bad = 1 }
  NR > 1 && columns != wanted { print FILENAME ":" NR ": " $0; bad = 1 }
  NR > 1 && seen[$0]++ { print FILENAME ":" NR ": twice: " $0; bad = 1 }
  END { exit bad || NR < 2 || units != 8 }' scores/cases.csv || { head -n 5 scores/cases.csv; fail "rows of cases.csv"; }
for pair in bs000,bs001 bs001,bs000 bs002,bs000; do grep -q "$pair" scores/cases.csv || fail "no row of $pair"; done
claim "every case has its rows: a source on a target, a metric, a value"

# The rows of every experiment stay as they are; those that are asked for stand beside them.
"$mimik" evaluate work1 --expression 12 --method mean --no-reference -o plain --quiet >/dev/null
"$mimik" evaluate work1 --expression 12 --method mean --no-reference --estimator point-to-surface,landmarks/signed --region zone,nose \
  --check-estimators -o more --quiet >/dev/null
grep -v -e ',point-to-surface,' -e ',landmarks/signed,' more/cases.csv | grep -v '^#' | cmp - <(grep -v '^#' plain/cases.csv)
values() { awk -F, -v estimator="$1" '$6 == estimator && $7 == "zone" && $8 == "mean" && $4 != "second-scan" { print $9 }' more/cases.csv; }
cmp <(values point-to-surface) <(values surface_distance)
grep -q ',landmarks/signed,nose,mean_absolute,' more/cases.csv
grep -q '^point-to-surface,mean,12,zone,mean,3,' more/estimators.csv
[ -s more/estimators.md ]
grep -q ',second-scan,1,surface_distance,zone,mean,' plain/cases.csv
grep -q '^| scanner floor | anchor | 0\.' plain/scores.md
grep -q 'The performer floor is unknown: ' plain/scores.md
expect_code 2 "estimator 'best' is unknown; there are: point-to-surface, " "$mimik" evaluate work1 --expression 12 --estimator best
expect_code 2 "region 'ear' is unknown" "$mimik" evaluate work1 --expression 12 --region ear
claim "estimators that are asked for add rows, are checked against the truth, and change no other row; anchors stand in the tables"
"$mimik" help estimators | while read -r line; do
  grep -qxF "$line" "$page" || fail "$page lacks: $line"
done
claim "the page of estimators has the definitions that the program prints"

"$mimik" evaluate work1 --au au12_l --dry-run --quiet >/dev/null
claim "an expression may be typed in every way in which it is written"
expect_code 2 "asked for twice" "$mimik" evaluate work1 --expression 12,AU12
expect_code 2 "--method: 'thesis' is asked for twice" "$mimik" evaluate work1 --expression 12 --method thesis,mean,thesis
expect_code 2 "no finished workspace" "$mimik" evaluate "$shared/db1"
expect_code 2 "'99'" "$mimik" evaluate work1 --expression 99 --dry-run
expect_plan_in_json "evaluate work1 --expression 12"
claim "wrong input is named and ends with 2"

expect_refusal_of_bad_folders "evaluate work1 --expression 12 -o"
expect_refusal_of_bad_outputs "evaluate work1 --expression 12"
expect_code 2 "file/scores: the folder cannot be made" "$mimik" evaluate work1 --expression 12 -o file/scores
[ ! -s out.txt ]
expect_code 2 "--output: is empty; give a folder" "$mimik" evaluate work1 --expression 12 -o ""
mkdir empty
"$mimik" evaluate work1 --expression 12 -o empty --dry-run --quiet >/dev/null
[ -z "$(ls empty)" ]
expect_refusal_of_full_disk "evaluate work1 --expression 12 --no-reference --no-whole-face --json"
claim "a folder that takes no scores is found out before the work and in a dry run, which makes none, and a disk that takes no result ends with 2"
