#!/usr/bin/env bash
# slurm.sh MIMIK FOLDER SHARED: an experiment on a real Slurm of four virtual nodes, one of which is taken down half way.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/claims.sh"
submit=$here/../../scripts/slurm/submit.sh

borrow_workspace
cluster=$(mktemp -d /tmp/mimik-slurm-XXXXXX)  # a socket's name has to be short
"$here/local_slurm.sh" start "$cluster" 4 || { code=$?; [ "$code" -ne 77 ] || rm -rf "$cluster"; exit "$code"; }
trap '"$here/local_slurm.sh" stop "$cluster"; rm -rf "$cluster"' EXIT
export SLURM_CONF=$cluster/slurm.conf MIMIK=$mimik

# Units slow enough that a node can be lost within one of three shards.
cat >many.toml <<'END'
schema = 1
workspace = "work1"
expressions = ["12", "4", "12L"]
methods = ["thesis", "thesis-half", "default", "mean", "sparse", "displacement-copy", "deformation-transfer"]
magnitudes = [0.6, 0.8, 1, 1.2]
END
"$mimik" run many.toml -o whole --quiet >/dev/null

MIMIK_WAIT=1 "$submit" many.toml out 3 --no-requeue >submit.txt 2>&1 &
first=$!
for _ in $(seq 200); do [ ! -s out/log/jobs ] || break; sleep 0.05; done
expect_code 1 "jobs of an earlier call are still queued" "$submit" many.toml out 3
# As soon as a shard has stored a target, its node goes.
lost=
for _ in $(seq 1200); do
  for part in out/shards/*.part; do
    { grep -q '^# unit [0-9L]* bs00[01]' "$part"; } 2>/dev/null || continue
    index=$(basename "$part")
    index=${index%%-*}
    node=$(squeue --noheader --states=RUNNING --array --format='%K %N' | awk -v index_="$index" '$1 == index_ { print $2 }')
    [ -z "$node" ] || { scontrol update nodename="$node" state=down reason=test; lost="$index on $node"; break 2; }
  done
  kill -0 "$first" 2>/dev/null || break
  sleep 0.05
done
[ -n "$lost" ] || { cat submit.txt; fail "no shard was met half way"; }
code=0
wait "$first" || code=$?
index=${lost%% *}
[ "$code" -eq 1 ] && grep -q 'not all was done' submit.txt || { cat submit.txt; fail "the first call ended with $code"; }
[ ! -e "out/shards/$index-of-3.rows" ] && [ ! -e out/manifest.json ] || fail "the shard of the lost node is there"
claim "a node that is lost takes its shard with it (shard $lost)"

for _ in $(seq 600); do [ -n "$(squeue --noheader --states=PENDING,RUNNING)" ] || break; sleep 0.1; done
missing=$("$mimik" merge out --shards 3 --list-missing)
MIMIK_WAIT=1 "$submit" many.toml out 3 --no-requeue >submit.txt 2>&1 || { cat submit.txt out/log/*; fail "the second call"; }
grep -q "^submitted shards $missing of 3" submit.txt || { cat submit.txt; fail "other shards than the missing"; }
grep -q ' of an earlier attempt) in ' "out/log/shard-$index.txt" || { cat out/log/*; fail "units were done again"; }
for file in experiment.json rows.csv rows.sqlite scores.json scores.csv summary.md tables/explained.tex tables/error_mm.tex tables/intervals.tex statistics/methods.csv statistics/differences.csv statistics/source_dependence.csv manifest.json; do
  cmp "whole/$file" "out/$file" || fail "$file is another than that of a local run"
done
"$submit" many.toml out 3 >submit.txt
grep -q 'is whole, nothing is to be submitted' submit.txt
claim "the next call does what is missing, and the bytes are those of a local run"
