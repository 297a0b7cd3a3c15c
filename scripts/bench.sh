#!/usr/bin/env bash
# bench.sh [FILTER]: builds the benchmarks, runs Mimik and its peers one after another on this machine, prints one Markdown
# table (medians of 5). FILTER is a regular expression on benchmark names; with one, the Python peers are left out.
# Result files stay in out/bench. Needs what scripts/setup.sh --bench installs.
set -euo pipefail
cd "$(dirname "$0")/.."
filter=${1:-.}
results=out/bench
mkdir -p "$results"

cmake --preset bench >"$results/configure.log"
cmake --build --preset bench >"$results/build.log" || { tail -30 "$results/build.log" >&2; exit 1; }

files=()
for program in build/bench/bin/bench_*; do
  name=$(basename "$program")
  echo "bench.sh: $name" >&2
  "$program" --benchmark_filter="$filter" --benchmark_min_time=0.05 --benchmark_repetitions=5 \
    --benchmark_enable_random_interleaving=true --benchmark_report_aggregates_only=true \
    --benchmark_out="$results/$name.json" --benchmark_out_format=json >/dev/null 2>"$results/$name.log" \
    || { cat "$results/$name.log" >&2; exit 1; }
  [ -s "$results/$name.json" ] && files+=("$results/$name.json")
done
if [ "$filter" = . ]; then
  # Debian's own Python has Debian's SciPy; another one in the PATH may not.
  python=/usr/bin/python3
  if "$python" -c 'import scipy' 2>/dev/null; then
    echo "bench.sh: Python peers" >&2
    for peers in peers gridding_peers; do
      OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 "$python" "bench/$peers.py" >"$results/$peers.json"
      files+=("$results/$peers.json")
    done
  else
    echo "bench.sh: python3-scipy is not installed: no Python peers" >&2
  fi
fi

echo "$(sed -n 's/^model name[[:space:]]*: //p' /proc/cpuinfo | head -1), $(nproc) cores, load $(cut -d' ' -f1 /proc/loadavg) at the end;" \
  "$(${CXX:-g++} --version | head -1); $(date -I); one thread unless a task says otherwise"
echo
python3 bench/table.py "${files[@]}"
