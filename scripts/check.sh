#!/usr/bin/env bash
# check.sh [STEP...]: what a change must pass beside its tests. Steps, in this order unless named: format layers rules
# sanitizers threads tidy fuzz. A step beside them: tidy-all (tidy looks only at what changed lately). FUZZ_SECONDS (60) is
# the time per reader.
set -euo pipefail
cd "$(dirname "$0")/.."

steps=("$@")
[ ${#steps[@]} -gt 0 ] || steps=(format layers rules sanitizers threads tidy fuzz)
jobs=$(nproc)
launcher=$(command -v ccache || true)
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1  # clones in other folders share the cache

# The table of rooms; ${below[room]} is all that a room may use, its own name among them.
rooms=()
declare -A direct below
while IFS=: read -r room uses; do
  [[ $room =~ ^[a-z]+$ ]] || continue
  rooms+=("$room")
  direct[$room]=$uses
  below[$room]=" $room "
  for use in $uses; do
    for its in ${below[$use]}; do [[ ${below[$room]} == *" $its "* ]] || below[$room]+="$its "; done
  done
done <cmake/rooms.txt

# Without git, so that an exported tree or one of another owner is looked at all the same.
sources() { find "${rooms[@]}" tests bench \( -name '*.h' -o -name '*.cpp' \) -print0 | sort -z; }
fail() { echo "check.sh: $*" >&2; exit 1; }
configure() { cmake --preset "$1" ${launcher:+-DCMAKE_CXX_COMPILER_LAUNCHER="$launcher"} >/dev/null; }

check_format() {
  sources | xargs -0 clang-format-14 --dry-run -Werror || fail "format: run clang-format-14 -i on the files above"
}

# What a room includes is its own or of a room that it may use; mimik_add_module holds the CMake targets to the same table.
check_layers() {
  local room wrong=0
  for room in "${rooms[@]}"; do
    find "$room" \( -name '*.h' -o -name '*.cpp' \) -print0 | sort -z |
      xargs -0r awk -v room="$room" -v allowed="${below[$room]}" -v rooms=" ${rooms[*]} " '
        match($0, /^ *# *include *[<"][^>"]*/) {
          name = substr($0, RSTART, RLENGTH)
          quoted = name ~ /"/
          sub(/^[^<"]*[<"]/, "", name)
          first = name
          sub(/\/.*/, "", first)
          if (first == name) first = ""
          if (index(allowed, " " first " ") && first != "") next
          if (quoted || (first != "" && index(rooms, " " first " "))) {
            print FILENAME ":" FNR ": " room " must not include " name; wrong = 1
          }
        }
        END { exit wrong }' || wrong=1
  done
  [ $wrong -eq 0 ] || fail "layers: the includes above are of no room that theirs may use (cmake/rooms.txt)"
}

# Headers that are not installed: *-inl.h, and what a room names in PRIVATE_HEADERS.
private_headers() {  # room
  awk -v room="$1" '
    { sub(/#.*/, ""); gsub(/[()]/, " & ") }
    { for (k = 1; k <= NF; ++k) {
        if ($k ~ /^[A-Z_]+$/ || $k == ")") inside = $k == "PRIVATE_HEADERS"
        else if (inside) print room "/" $k } }' "$1/CMakeLists.txt"
}

check_rules() {
  local room header
  # Adapters are there for these libraries; no other header includes them.
  find "${rooms[@]}" -name '*.h' ! -path 'adapters/*' -print0 | xargs -0 grep -nE \
    '#include [<"](pcl|CGAL|vtk|opencv2|dlib|embree3|hwy|sqlite3|png|jpeglib|zlib|lzf|pugixml|nanoflann|toml\+\+|tbb|X11|EGL|GL)[./>A-Z_a-z]' &&
    fail "rules: heavy libraries stay in .cpp files: see above"
  for room in "${rooms[@]}"; do
    [ "$room" = cli ] || [ "$room" = adapters ] && continue
    private_headers "$room" >build/private_headers
    find "$room" -name '*.h' ! -name '*-inl.h' | sort | awk -v list=build/private_headers '
      BEGIN { while ((getline line <list) > 0) hidden[line] = 1 }
      { path = $0; while (path) { if (path in hidden) next; if (!sub(/\/[^\/]*$/, "", path)) break } print }'
  done >build/installed_headers
  xargs grep -nE '^ *# *include *<' <build/installed_headers | grep -vE '<(Eigen/[A-Za-z]+|[a-z_0-9]+)>' &&
    fail "rules: a header that is installed names the standard library, Eigen and rooms alone: see above"
  grep -rnE --include=CMakeLists.txt --include='*.cmake' --include=CMakePresets.json -e '-march=|-mavx|-mfma|-ffast-math' \
    CMakeLists.txt CMakePresets.json cmake tests bench "${rooms[@]}" &&
    fail "rules: no such flag (Eigen and the libraries disagree then); SIMD goes through run-time dispatch: see above"
  for room in "${rooms[@]}"; do
    grep -qE "^HeaderFilterRegex: .*[(|]$room[|)]" .clang-tidy || fail "rules: HeaderFilterRegex in .clang-tidy does not name $room"
  done
  sources | xargs -0 wc -l | awk '$2 != "total" && $1 > 700' | grep . && fail "rules: sources of more than 700 lines: see above"
  return 0
}

# The rooms' test programs; the fuzzers are built along, so that no object is compiled twice.
check_sanitizers() {
  configure asan-ubsan
  cmake --build --preset asan-ubsan --target test_programs fuzzers
  ctest --preset asan-ubsan -j "$jobs"
}

# The programs whose tests use several threads, with plain threads in the place of TBB (base/executor_threads.cpp).
check_threads() {
  local programs=(test_base test_geometry test_statistics test_capture test_database test_synthesis test_preprocessing
    test_modeling test_animation test_builtin test_evaluation test_report)
  configure tsan
  cmake --build --preset tsan --target "${programs[@]}"
  ctest --preset tsan -j "$jobs" -R "^($(IFS='|'; echo "${programs[*]}"))\$"
}

# The release build's commands are what clang-tidy reads; sources alone, their headers come along. Largest first: the
# longest is not left for the end.
tidy() {  # reads names of sources
  configure release
  local generated
  generated=$(cd build/release && ninja -t targets all | sed -n 's/^\([^:]*\.inc\): .*/\1/p' | sort -u)
  [ -z "$generated" ] || ninja -C build/release $generated >/dev/null
  xargs -r -d '\n' ls -S | xargs -r -d '\n' -P "$jobs" -n 1 clang-tidy-14 -p build/release --quiet --warnings-as-errors='*' \
    2>build/tidy.log || fail "tidy: see above (and build/tidy.log)"
}
check_tidy-all() { find "${rooms[@]}" -name '*.cpp' | sort | tidy; }

# Sources that changed in the last 20 commits or since; a header stands for the source of its name, or else for one that
# includes it. Everything where there is no such history. Who changes .clang-tidy runs tidy-all.
recent_sources() {
  local changed file
  if [ "$(git rev-list --count HEAD 2>/dev/null || echo 0)" -lt 21 ] || ! git rev-parse -q --verify HEAD~20 >/dev/null; then
    find "${rooms[@]}" -name '*.cpp'
    return
  fi
  changed=$(git diff --name-only --diff-filter=d HEAD~20 -- "${rooms[@]}"; git ls-files --others --exclude-standard -- "${rooms[@]}")
  for file in $changed; do
    case "$file" in
      *.cpp) echo "$file" ;;
      *.h)
        if [ -e "${file%.h}.cpp" ]; then
          echo "${file%.h}.cpp"
        else
          { grep -rlF "#include \"$file\"" --include='*.cpp' "${rooms[@]}" || true; } | sort | sed -n 1p
        fi
        ;;
    esac
  done
}
check_tidy() {
  recent_sources | sort -u >build/tidy_sources
  echo "$(wc -l <build/tidy_sources) of $(find "${rooms[@]}" -name '*.cpp' | wc -l) sources changed in the last 20 commits"
  tidy <build/tidy_sources
}

check_fuzz() {
  scripts/fuzz.sh
}

for step in "${steps[@]}"; do
  case "$step" in
    format | layers | rules | sanitizers | threads | tidy | tidy-all | fuzz) ;;
    *) fail "there is no step '$step'" ;;
  esac
done
scripts/setup.sh --check
mkdir -p build
for step in "${steps[@]}"; do
  echo "== $step"
  SECONDS=0
  "check_$step"
  echo "== $step: passed in $SECONDS s"
done
