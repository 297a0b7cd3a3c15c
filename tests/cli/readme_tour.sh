#!/usr/bin/env bash
# readme_tour.sh MIMIK FOLDER: the tour of README.md runs exactly as it is printed, on three built-in subjects that bear
# the names of the tour; the first command that fails ends it.
set -euo pipefail
readme=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/README.md
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

"$mimik" synthesize made --subjects 3 --expressions 1,2,4,12,14,15,17,20,12L --quiet >/dev/null
mkdir DB
mv made/bs000 DB/
for pair in bs001:bs003 bs002:bs007; do
  mkdir "DB/${pair#*:}"
  for file in "made/${pair%:*}"/*; do
    name=$(basename "$file")
    mv "$file" "DB/${pair#*:}/${pair#*:}${name#"${pair%:*}"}"
  done
done

# Without a way to draw, 1 says that a picture is not there; everything else is.
can_draw=yes
printf 'v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n' >probe.obj
"$mimik" figure -o probe.png probe.obj --size 40x40 --quiet >/dev/null 2>&1 || can_draw=no

mimik() { command "$mimik" "$@"; }
tour=$(sed -n '/^## A first tour/,/^## /p' "$readme" | grep '^    ' | sed 's/^    //')
[ "$(grep -c '^mimik ' <<<"$tour")" -ge 12 ] || fail "the tour was not found"
while read -r line; do
  code=0
  eval "$line" >out.txt 2>err.txt || code=$?
  [ "$code" -eq 0 ] && continue
  [ "$can_draw" = no ] && grep -qE -- '--sheets|mimik (panels|figure)' <<<"$line" && continue
  cat out.txt err.txt
  fail "exit code $code: $line"
done <<<"$tour"
claim "the tour of README.md runs as it is printed"
