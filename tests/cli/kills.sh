#!/usr/bin/env bash
# kills.sh MIMIK FOLDER SHARED: killed 20 times at random moments, as one run and as a shard, an experiment ends in the
# same bytes.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_workspace
cat >smile.toml <<'END'
schema = 1
workspace = "work1"
expressions = ["12", "4"]
methods = ["thesis", "sparse-mean"]
END
results="experiment.json rows.csv rows.sqlite scores.json scores.csv summary.md tables/explained.tex tables/error_mm.tex tables/intervals.tex statistics/methods.csv statistics/differences.csv statistics/source_dependence.csv manifest.json"
begun=$(date +%s%N)
"$mimik" run smile.toml -o whole --quiet >/dev/null
took_ms=$((($(date +%s%N) - begun) / 1000000))

RANDOM=20  # the moments are the same in every run of this test
kill_20_times() {  # command ...
  local kills=0 k
  for k in $(seq 20); do
    "$@" >/dev/null 2>&1 &
    sleep "$(awk -v ms="$took_ms" -v r="$RANDOM" 'BEGIN { printf "%.3f", ms * r / 32768 / 1000 }')"
    if kill -KILL $! 2>/dev/null; then kills=$((kills + 1)); fi
    wait $! 2>/dev/null || true
  done
  echo "$kills of 20 met it alive"
}
kill_20_times "$mimik" run smile.toml -o killed --quiet
"$mimik" run smile.toml -o killed --quiet >/dev/null
kill_20_times "$mimik" run smile.toml -o parts --shard 1/1 --quiet
"$mimik" run smile.toml -o parts --shard 1/1 --quiet >/dev/null
kill_20_times "$mimik" merge parts --quiet
"$mimik" merge parts --quiet >/dev/null
for file in $results; do
  cmp "whole/$file" "killed/$file" && cmp "whole/$file" "parts/$file" || fail "$file is another after 20 kills"
done
[ -z "$(ls parts/shards killed | grep '\.part$' || true)" ] || fail "an attempt is left"
claim "killed 20 times at random moments and gone on with, the bytes are the same"
