#!/usr/bin/env bash
# rooms_are_shown.sh: the graphs of README.md and CONTRIBUTING.md, and the table of the latter, are cmake/rooms.txt.
set -euo pipefail
cd "$(dirname "$0")/../.."

edges=$(awk -F: '/^[a-z]+:/ { n = split($2, uses, " "); for (k = 1; k <= n; ++k) print $1, uses[k] }' cmake/rooms.txt | sort)
rows=$(awk -F: '/^[a-z]+:/ { gsub(/^ +| +$/, "", $2); gsub(/ +/, ", ", $2); print $1 ": " ($2 == "" ? "-" : $2) }' cmake/rooms.txt)
wrong=0
for page in README.md CONTRIBUTING.md; do
  diff -u --label cmake/rooms.txt --label "$page, graph" <(echo "$edges") \
    <(sed -n 's/^ *\([a-z]*\) --> \([a-z]*\)$/\1 \2/p' "$page" | sort) || wrong=1
done
diff -u --label cmake/rooms.txt --label "CONTRIBUTING.md, table" <(echo "$rows") \
  <(sed -n 's/^| `\([a-z]*\)` | \([a-z, -]*\) |.*/\1: \2/p' CONTRIBUTING.md | grep -E "^($(cut -d: -f1 <<<"$rows" | paste -sd'|')): ") || wrong=1
exit $wrong
