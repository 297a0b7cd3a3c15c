#!/usr/bin/env bash
# check.sh [STEP...]: what a change must pass beside its tests. Steps, in this order unless named: format layers rules
# sanitizers tidy fuzz. FUZZ_SECONDS (60) is the time per reader.
set -euo pipefail
cd "$(dirname "$0")/.."

steps=("$@")
[ ${#steps[@]} -gt 0 ] || steps=(format layers rules sanitizers tidy fuzz)
jobs=$(nproc)
launcher=$(command -v ccache || true)
layers=(geometry database synthesis preprocessing modeling animation evaluation figures cli)

# Without git, so that an exported tree or one of another owner is looked at all the same.
sources() { find "${layers[@]}" tests bench \( -name '*.h' -o -name '*.cpp' \) -print0 | sort -z; }
fail() { echo "check.sh: $*" >&2; exit 1; }

check_format() {
  sources | xargs -0 clang-format-14 --dry-run -Werror || fail "format: run clang-format-14 -i on the files above"
}

# A folder includes only what stands left of it; the CMake targets are held to the same order by mimik_add_module.
check_layers() {
  local wrong=0 place later
  for ((place = 0; place + 1 < ${#layers[@]}; ++place)); do
    later=$(IFS='|'; echo "${layers[*]:place+1}")
    grep -rnE "#include [<\"]($later)/" "${layers[place]}" && wrong=1
  done
  [ $wrong -eq 0 ] || fail "layers: the includes above climb (order: ${layers[*]})"
}

check_rules() {
  grep -rnE '#include <(pcl|CGAL|vtk|opencv2|embree3|hwy|sqlite3|png)' --include='*.h' "${layers[@]:0:${#layers[@]}-1}" &&
    fail "rules: heavy libraries stay in .cpp files: see above"
  grep -rnE --include=CMakeLists.txt --include='*.cmake' --include=CMakePresets.json -e '-march=|-mavx|-mfma|-ffast-math' \
    CMakeLists.txt CMakePresets.json cmake tests bench "${layers[@]}" &&
    fail "rules: no such flag (Eigen and the libraries disagree then); SIMD goes through run-time dispatch: see above"
  sources | xargs -0 wc -l | awk '$2 != "total" && $1 > 700' | grep . && fail "rules: sources of more than 700 lines: see above"
  return 0
}

check_sanitizers() {
  cmake --preset asan-ubsan ${launcher:+-DCMAKE_CXX_COMPILER_LAUNCHER="$launcher"} >/dev/null
  cmake --build --preset asan-ubsan
  ctest --preset asan-ubsan -j "$jobs"
}

# The release build's commands are what clang-tidy reads; sources alone, their headers come along. Largest first: the
# longest is not left for the end.
check_tidy() {
  cmake --preset release ${launcher:+-DCMAKE_CXX_COMPILER_LAUNCHER="$launcher"} >/dev/null
  cmake --build --preset release --target modeling/include/modeling/facs_toml.inc >/dev/null
  find "${layers[@]}" -name '*.cpp' -printf '%s %p\n' | sort -rn | cut -d' ' -f2 |
    xargs -P "$jobs" -n 1 clang-tidy-14 -p build/release --quiet --warnings-as-errors='*' 2>build/tidy.log ||
    fail "tidy: see above (and build/tidy.log)"
}

check_fuzz() {
  scripts/fuzz.sh
}

scripts/setup.sh --check
for step in "${steps[@]}"; do
  case "$step" in format | layers | rules | sanitizers | tidy | fuzz) ;; *) fail "there is no step '$step'" ;; esac
  echo "== $step"
  SECONDS=0
  "check_$step"
  echo "== $step: passed in $SECONDS s"
done
