#!/usr/bin/env bash
# run.sh MIMIK FOLDER SHARED: an experiment file from the database to its tables, killed and gone on with.
set -euo pipefail
experiments=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/experiments
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_database
borrow_workspace
cat >smile.toml <<'END'
schema = 1
workspace = "work1"
expressions = ["12", "4"]
methods = ["thesis", "sparse-mean"]
magnitudes = [0.8, 1]
[subjects]
sources = { next = 1 }
END
"$mimik" run smile.toml -o out >summary.txt 2>err.txt
for name in experiment.json rows.csv rows.sqlite scores.json scores.csv summary.md tables/explained.tex tables/error_mm.tex manifest.json provenance.json; do
  [ -s "out/$name" ] || fail "out/$name is not there"
done
[ ! -e out/rows.part ] || fail "rows.part is left"
cmp summary.txt out/summary.md
grep -q 'sparse-mean@0.8' summary.txt && grep -q '^12: thesis@0.8 ' err.txt || { cat summary.txt err.txt; fail "magnitudes"; }
grep -q '^bs001,bs000,12,thesis,0.8,surface_distance,zone,mean,' out/rows.csv || { head -5 out/rows.csv; fail "rows"; }
! grep -q '^#\|,run,' out/rows.csv || fail "rows.csv has more than measures"
! grep -q "$PWD" out/experiment.json out/rows.csv out/summary.md || fail "a path of this machine is in a result"
claim "an experiment file gives rows, tables and scores, and says what was run"

"$mimik" run smile.toml -o out >again.txt 2>err.txt
cmp summary.txt again.txt
grep -q 'nothing is left to do' err.txt
sed 's/0.8, 1/0.9/' smile.toml >other.toml
expect_code 2 "out: holds another experiment (experiment/magnitudes/0 is 0.8 there and 0.9 here)
--anew" "$mimik" run other.toml -o out
"$mimik" run other.toml -o out --anew --quiet >/dev/null
grep -q ',thesis,0.9,' out/rows.csv
claim "a second run has nothing to do, and another experiment is not mixed with it"

"$mimik" verify out >verified.txt
grep -q ' equal$' verified.txt || { cat verified.txt; fail "verify"; }
cp out/rows.csv rows.csv
awk -F, 'BEGIN { OFS = "," } NR > 1 && $9 != "" && !done { $9 = $9 + 1; done = 1 } { print }' rows.csv >out/rows.csv
expect_code 1 "rows.csv: was changed after the run" "$mimik" verify out --units 6
grep -q ' there, .* here' out.txt || { cat out.txt; fail "the changed row is not found"; }
expect_code 2 "was changed after the run" "$mimik" run other.toml -o out
cp rows.csv out/rows.csv
claim "verify finds a number that was changed"

# Killed at any moment, it goes on to the same bytes.
"$mimik" run smile.toml -o whole --quiet --threads 1 >/dev/null
for moment in 0.15 0.3 0.5 0.7 0.9; do
  "$mimik" run smile.toml -o killed --quiet >/dev/null 2>&1 &
  sleep "$moment"
  kill -KILL $! 2>/dev/null || true
  wait $! 2>/dev/null || true  # it holds its lock until it is gone
done
"$mimik" run smile.toml -o killed --quiet --threads 2 >/dev/null
for file in experiment.json rows.csv rows.sqlite scores.json scores.csv summary.md tables/explained.tex tables/error_mm.tex manifest.json; do
  cmp "whole/$file" "killed/$file" || fail "$file is another after a kill"
done
claim "killed and gone on with, on one thread or two, the bytes are the same"

# From the database: what is still to be preprocessed goes into the results' folder.
sed 's/^workspace.*/database = "db1"/; s/"12", "4"/"12"/' smile.toml >fresh.toml
"$mimik" run fresh.toml -o fresh --quiet >/dev/null
[ -s fresh/workspace/workspace.json ] || fail "no workspace was made"
grep '^bs001,bs000,12,' fresh/rows.csv >a.txt
[ -s a.txt ]
sed '/^workspace/d' smile.toml >bare.toml
expect_code 2 "bare.toml: names no 'database' and no 'workspace'" "$mimik" run bare.toml -o x
"$mimik" run bare.toml --workspace work1 -o bare --quiet >/dev/null
cmp bare/rows.csv whole/rows.csv
claim "the folder may stand in the file or on the command line, preprocessed or not"

# Of the few expressions of this workspace some files find none: that is all that may be wrong.
for file in "$experiments"/*.toml; do
  "$mimik" run "$file" --workspace work1 -o shipped --dry-run --quiet >/dev/null 2>err.txt || grep -q 'left out: 0 subjects' err.txt || { cat err.txt; fail "$file"; }
done
claim "the experiments that are shipped are read"

sed 's/next = 1/sex = "x"/' smile.toml >bad.toml
expect_code 2 "bad.toml:7: 'subjects.sources.sex' is neither f nor m" "$mimik" run bad.toml -o x
sed 's/sources = .*/targets = ["bs009"]/' smile.toml >bad.toml
expect_code 2 "bad.toml:7: subjects.targets: no subject 'bs009'
bs000, bs001, bs002" "$mimik" run bad.toml -o x
sed 's/"12", "4"/"99"/' smile.toml >bad.toml
expect_code 2 "bad.toml:3: expressions
'99'" "$mimik" run bad.toml -o x
expect_code 2 "absent.toml" "$mimik" run absent.toml -o x
rm -rf x
"$mimik" run smile.toml -o x --dry-run --json >plan.json
grep -q '"transfers": ' plan.json && [ ! -e x ] || fail "a dry run"
expect_code 2 "is no finished experiment" "$mimik" verify work1
expect_refusal_of_bad_folders "run smile.toml -o"
claim "wrong input is named with its line and ends with 2"
