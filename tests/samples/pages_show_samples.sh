#!/usr/bin/env bash
# pages_show_samples.sh [--write]: docs/algorithms/PAGE.md shows, as its blocks of C++, what stands between `// [sample]`
# and `// [end]` in tests/samples/PAGE.cpp, and nothing else. --write puts the samples into the pages.
set -euo pipefail
cd "$(dirname "$0")/../.."

sample() { awk '/^\/\/ \[end\]$/ { inside = 0 } inside; /^\/\/ \[sample\]$/ { inside = 1 }' "$1"; }
shown() { awk '/^```$/ { inside = 0 } inside; /^```cpp$/ { inside = 1 }' "$1"; }

wrong=0 count=0
for page in docs/algorithms/*.md; do
  source=tests/samples/$(basename "$page" .md).cpp
  [ -e "$source" ] || { echo "$page: there is no $source"; wrong=1; continue; }
  if [ "${1:-}" = --write ]; then
    [ "$(grep -c '^```cpp$' "$page")" = 1 ] || { echo "$page: needs one block of C++ to write into"; wrong=1; continue; }
    written=$(mktemp)
    sample "$source" >"$written"
    awk -v sample="$written" '
      /^```$/ { inside = 0 }
      !inside
      /^```cpp$/ { inside = 1; while ((getline line <sample) > 0) print line }' "$page" >"$written.page"
    cat "$written.page" >"$page"
    rm "$written" "$written.page"
  fi
  [ -n "$(sample "$source")" ] || { echo "$source: has no '// [sample]'"; wrong=1; }
  diff -u --label "$source" --label "$page" <(sample "$source") <(shown "$page") || wrong=1
  count=$((count + 1))
done
for source in tests/samples/*.cpp; do
  [ -e "docs/algorithms/$(basename "$source" .cpp).md" ] || { echo "$source: is the sample of no page"; wrong=1; }
done
[ $wrong -eq 0 ] || echo "tests/samples/pages_show_samples.sh --write puts the samples into the pages"
echo "$count pages"
exit $wrong
