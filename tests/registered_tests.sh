#!/usr/bin/env bash
# registered_tests.sh SOURCE BUILD [ROOM...]: every TEST, TEST_F and TEST_P in SOURCE/tests is a test that ctest runs in
# BUILD, but those of rooms that are not built.
set -euo pipefail
cd "$1"
# Asked from beside the build: ctest writes a log where it stands, over that of the run that this is part of.
scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT
echo "subdirs(\"$2\")" >"$scratch/CTestTestfile.cmake"
known=$(ctest --test-dir "$scratch" -N)
wrong=0 count=0
not_built=()
for room in "${@:3}"; do not_built+=(! -path "tests/$room/*"); done
while read -r kind suite name; do
  count=$((count + 1))
  [ "$kind" = TEST_P ] && pattern="[ /]$suite\.$name/" || pattern=" $suite\.$name\$"
  grep -qE "$pattern" <<<"$known" || { echo "ctest does not run $kind($suite, $name); is its file in a CMakeLists.txt?"; wrong=1; }
done < <(find tests -name '*.cpp' "${not_built[@]}" -exec cat {} + | tr '\n' ' ' | grep -oE '\bTEST(_F|_P)?\( *\w+, *\w+ *\)' | tr -s '(,)' ' ')
echo "$count tests in the sources, $(grep -c ' Test *#' <<<"$known") with their parameters"
[ "$count" -gt 0 ] && exit $wrong
echo "no test found in $1/tests"
exit 1
