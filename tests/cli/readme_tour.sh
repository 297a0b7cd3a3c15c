#!/usr/bin/env bash
# readme_tour.sh MIMIK FOLDER: the tour of README.md runs exactly as it is printed, on three built-in subjects that bear
# the names of the tour; the first command that fails ends it.
set -euo pipefail
readme=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/README.md
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

"$mimik" synthesize made --subjects 3 --expressions 1,2,4,12,14,15,17,20,12L --quiet >/dev/null
mkdir DB
mv made/bs001 DB/
for pair in bs000:bs003 bs002:bs007; do  # bs000 of seed 1 has closed lips whose two inner landmarks are one point
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

reproduce=$(dirname "$readme")/scripts/reproduce.sh
grep -q '^out=$PWD/out/reproduce$' "$reproduce" && grep -q '"$mimik" synthesize "$out/database"' "$reproduce"
grep -q '^mimik=$PWD/build/release/bin/mimik$' "$reproduce" && grep -q '^export PATH=$PWD/build/release/bin:$PATH$' "$readme"
grep -q '^mkdir out/tour && cd out/tour$' "$readme" && grep -q '^ln -s ../reproduce/database DB$' "$readme" || fail "the tour's database is not that of reproduce.sh"
tail -n 2 "$reproduce" | grep -q 'Database: %s  Program: %s' || fail "the last line of reproduce.sh names no database or no program"
claim "the tour starts from what reproduce.sh leaves, and that script's last line names the database and the program"

for way in bs003_on_bs007 bs007_on_bs003; do
  [ -d "../AU12_${way}_default" ] || (cd ../.. && mimik panels WORK --source bs007 --target bs003 --au 12 -o figures --quiet >/dev/null) || [ "$can_draw" = no ]
  cd "../AU12_${way}_default"
  for role in source target; do
    ! grep -q lower_lip_inner ${role}_landmarks.csv && grep -q upper_lip_inner ${role}_landmarks.csv || fail "landmarks of the $role in $way"
  done
  mimik warp --from source_landmarks.csv --to target_landmarks.csv source_neutral.ply -o warped.ply --quiet
done
claim "of landmarks that lie on one another on either person both files of a panel have the first, so that they go into a warp"
