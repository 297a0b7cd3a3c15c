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
"$mimik" run smile.toml -o whole --quiet >/dev/null

RANDOM=20  # the moments are the same in every run of this test
# Kills at random moments until 20 met a living process; what is whole is begun anew.
kill_20_times() {  # what is there when it is whole, what to remove then, command ...
  local whole=$1 remove=$2 kills=0 code begun took_ms
  shift 2
  begun=$(date +%s%N)
  "$@" >/dev/null
  took_ms=$((($(date +%s%N) - begun) / 1000000))
  for _ in $(seq 200); do
    [ "$kills" -lt 20 ] || break
    [ ! -e "$whole" ] || rm -rf "$remove"
    "$@" >/dev/null 2>&1 &
    sleep "$(awk -v ms="$took_ms" -v r="$RANDOM" 'BEGIN { printf "%.3f", ms * r / 32768 / 1000 }')"
    kill -KILL $! 2>/dev/null || true
    code=0
    wait $! 2>/dev/null || code=$?
    [ "$code" -ne 137 ] || kills=$((kills + 1))  # 128 + SIGKILL: it was alive
  done
  [ "$kills" -eq 20 ] || fail "$kills kills of 200 met a living process: $*"
}
kill_20_times killed/manifest.json killed "$mimik" run smile.toml -o killed --quiet
"$mimik" run smile.toml -o killed --quiet >/dev/null
kill_20_times parts/shards/1-of-1.rows parts "$mimik" run smile.toml -o parts --shard 1/1 --quiet
"$mimik" run smile.toml -o parts --shard 1/1 --quiet >/dev/null
kill_20_times parts/manifest.json parts/manifest.json "$mimik" merge parts --quiet
"$mimik" merge parts --quiet >/dev/null
for file in $results; do
  cmp "whole/$file" "killed/$file" && cmp "whole/$file" "parts/$file" || fail "$file is another after 20 kills"
done
[ -z "$(ls parts/shards killed | grep '\.part$' || true)" ] || fail "an attempt is left"
claim "killed 20 times at random moments and gone on with, the bytes are the same"
