#!/usr/bin/env bash
# submit.sh EXPERIMENT OUT SHARDS [OPTION OF SBATCH ...]: an experiment as a Slurm job array, one task per shard, and a
# merge when all are done. Called again it submits only what is missing, and nothing when all is there or while jobs of
# an earlier call are still queued (their numbers are in OUT/log/jobs).
#
#   scripts/slurm/submit.sh thesis.toml /shared/thesis 20 --time=0:30:00 --mem=2G --cpus-per-task=4
#
# MIMIK        the program (default: mimik)
# MIMIK_MOST   tasks that run at the same time (default: as many as the site allows)
# MIMIK_WAIT   1: stay until all is done, and end as it did
set -euo pipefail

[ $# -ge 3 ] || { sed -n '2,11s/^# \{0,1\}//p' "$0" >&2; exit 2; }
experiment=$(realpath "$1")
out=$2
shards=$3
shift 3
mimik=$(command -v "${MIMIK:-mimik}") || { echo "submit.sh: ${MIMIK:-mimik}: no such program; set MIMIK" >&2; exit 2; }
mkdir -p "$out/log"
out=$(realpath "$out")
wait=()
[ "${MIMIK_WAIT:-0}" = 1 ] && wait=(--wait)

if [ -e "$out/manifest.json" ]; then
  echo "$out: is whole, nothing is to be submitted"
  exit 0
fi
# Two arrays at one experiment would do everything twice.
touch "$out/log/jobs"
queued=$(squeue --noheader --states=PENDING,RUNNING,SUSPENDED --format=%F)
queued=$(tr -d ' ' <<<"$queued" | grep -Fxf "$out/log/jobs" | sort -u | tr '\n' ' ' || true)
if [ -n "$queued" ]; then
  echo "submit.sh: jobs of an earlier call are still queued: ${queued% }; wait for them, or 'scancel ${queued% }' first" >&2
  exit 1
fi
: >"$out/log/jobs"
missing=$("$mimik" merge "$out" --shards "$shards" --list-missing)
after=()
if [ -n "$missing" ]; then
  # Before all shards: whatever they have in common. It is quick where it was done.
  if [ ! -e "$out/preprocessed.json" ]; then
    first=$(sbatch --parsable --job-name=mimik-prepare --output="$out/log/prepare.txt" "$@" \
      --wrap "$(printf '%q ' "$mimik" run "$experiment" -o "$out" --only-preprocess --quiet) || [ \$? -eq 1 ]")
    echo "${first%%;*}" >>"$out/log/jobs"
    after=(--dependency="afterok:${first%%;*}" --kill-on-invalid-dep=yes)
  fi
  # A task that is killed or loses its node goes on where it stopped, under Slurm's own requeue or the next call's.
  array=$(sbatch --parsable "${after[@]}" --array="$missing${MIMIK_MOST:+%$MIMIK_MOST}" --job-name=mimik-shard --requeue \
    --open-mode=append --output="$out/log/shard-%a.txt" "$@" \
    --wrap "$(printf '%q ' "$mimik" run "$experiment" -o "$out" --quiet)--threads \${SLURM_CPUS_PER_TASK:-1} --shard \$SLURM_ARRAY_TASK_ID/$shards")
  echo "${array%%;*}" >>"$out/log/jobs"
  after=(--dependency="afterok:${array%%;*}" --kill-on-invalid-dep=yes)
  echo "submitted shards $missing of $shards as job ${array%%;*}"
fi
merge=$(sbatch --parsable "${wait[@]}" "${after[@]}" --job-name=mimik-merge --output="$out/log/merge.txt" "$@" \
  --wrap "$(printf '%q ' "$mimik" merge "$out" --shards "$shards" --quiet) || [ \$? -eq 1 ]") || true
[ -z "$merge" ] || echo "${merge%%;*}" >>"$out/log/jobs"
if [ ${#wait[@]} -eq 0 ]; then
  [ -n "$merge" ] || exit 1
  echo "the merge is job ${merge%%;*}; when it has ended, results are in $out"
elif [ ! -e "$out/manifest.json" ]; then
  # Not by the code of sbatch: a merge that is cancelled since a shard failed ends with 0.
  echo "submit.sh: not all was done; see $out/log, and call it again: it submits what is missing" >&2
  exit 1
fi
