#!/usr/bin/env bash
# test.sh: installs what is missing, builds the release, runs every test. The last line is ctest's own summary.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh --page --browser --video --slurm
launcher=$(command -v ccache || true)  # not needed; a second build is quicker with it
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1  # clones in other folders share the cache
cmake --preset release ${launcher:+-DCMAKE_CXX_COMPILER_LAUNCHER="$launcher"}
cmake --build --preset release
ctest --preset release -j "$(nproc)"
