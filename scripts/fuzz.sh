#!/usr/bin/env bash
# fuzz.sh [SECONDS [TARGET...]]: builds the libFuzzer programs (clang, address and undefined-behaviour sanitizers) and runs
# each for SECONDS (FUZZ_SECONDS, or 60), as many at once as there are cores. A target is a reader: ply, obj, bnt, ... Found
# inputs grow in build/fuzz/corpus/TARGET; an input that breaks a reader is kept as build/fuzz/found/TARGET-* and ends the
# whole with 1. Chance has a fixed seed (FUZZ_SEED, or 1): who starts without build/fuzz searches the same way each time,
# as far as the machine gets; another seed or a longer time searches further.
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-${FUZZ_SECONDS:-60}}
[[ $seconds =~ ^[0-9]+$ ]] || { echo "fuzz.sh: SECONDS is '$seconds', not a whole number" >&2; exit 2; }
shift || true
seed=${FUZZ_SEED:-1}
[[ $seed =~ ^[1-9][0-9]*$ ]] || { echo "fuzz.sh: FUZZ_SEED is '$seed', not a whole number from 1 on" >&2; exit 2; }
launcher=$(command -v ccache || true)
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1  # clones in other folders share the cache
cmake --preset asan-ubsan ${launcher:+-DCMAKE_C_COMPILER_LAUNCHER="$launcher" -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher"} >/dev/null
cmake --build --preset asan-ubsan --target fuzzers
mkdir -p build/fuzz/found build/fuzz/log

targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  for program in build/asan-ubsan/bin/fuzz_*; do targets+=("${program##*/fuzz_}"); done
fi

run_one() {
  local target=$1 seconds=$2 seed=$3 program=build/asan-ubsan/bin/fuzz_$1 corpus=build/fuzz/corpus/$1 log=build/fuzz/log/$1
  [ -x "$program" ] || { echo "fuzz.sh: there is no target '$target'" >&2; return 2; }
  # TBB and other uninstrumented libraries keep memory until the end.
  export LSAN_OPTIONS=suppressions=$PWD/cmake/lsan.supp:print_suppressions=0
  MIMIK_FUZZ_SEEDS=$corpus "$program" || { echo "fuzz.sh: $target: the seeds could not be written" >&2; return 1; }
  if "$program" "$corpus" -seed="$seed" -max_total_time="$seconds" -max_len=262144 -timeout=10 -malloc_limit_mb=512 -rss_limit_mb=2048 \
    -artifact_prefix="build/fuzz/found/$target-" -print_final_stats=1 >"$log" 2>&1; then
    echo "$target: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs, $(ls "$corpus" | wc -l) kept, nothing found"
  else
    echo "$target: FOUND: $(grep -m1 -E 'ERROR: |SUMMARY: |broken promise|runtime error' "$log" || tail -1 "$log") (build/fuzz/log/$target)"
    return 1
  fi
}
export -f run_one

printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -I{} bash -c 'run_one "$1" "$2" "$3"' _ {} "$seconds" "$seed"
