#!/usr/bin/env bash
# register.sh MIMIK FOLDER SHARED: what a shell meets of 'mimik register', and of the files that it keeps.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_workspace
"$mimik" register work1 --subject BS000 --au AU12 --json --quiet >found.json
kept=work1/registered
for scan in bs000_N_N_0 bs000_LFAU_12_0; do
  [ -s $kept/bs000/$scan.ply ] && [ -s $kept/bs000/$scan.json ] || fail "$scan is not kept"
  grep -q "\"scan\": \"$scan\"" found.json || fail "$scan is not told"
  grep -q "^$scan,[01]\.[0-9]*," $kept/registrations.csv || fail "no row of $scan"
done
[ ! -e $kept/bs001 ] || fail "a subject that nobody asked for"
vertices() { sed -n 's/^element vertex //p' "$1"; }
[ "$(vertices $kept/template.ply)" -gt 3000 ]
for mesh in $kept/bs000/*.ply; do [ "$(vertices "$mesh")" = "$(vertices $kept/template.ply)" ] || fail "$mesh corresponds to no template"; done
[ "$(wc -l <$kept/template_landmarks.csv)" -gt 20 ]
claim "a template lies on each scan that was asked for, vertex for vertex, with a table of how well"

"$mimik" animate work1 --source bs000 --target bs000 --au 12 -o first/face.ply --quiet
touch -d '2001-01-01' $kept/bs000/*
"$mimik" animate work1 --source bs000 --target bs000 --au 12 -o again/face.ply --quiet
cmp first/face.ply again/face.ply
[ -z "$(find $kept/bs000 -newermt 2002-01-01 -type f)" ] || fail "what is kept was written again"
claim "what is kept is taken, and gives the same bytes"
sed -i 's/"made_from": "[0-9a-f]*"/"made_from": "0"/' $kept/bs000/bs000_N_N_0.json
printf x >>$kept/bs000/bs000_LFAU_12_0.ply
"$mimik" animate work1 --source bs000 --target bs000 --au 12 -o again/face.ply --quiet
cmp first/face.ply again/face.ply
[ "$(find $kept/bs000 -newermt 2002-01-01 -name '*.ply' | wc -l)" -eq 2 ] || fail "something stale or damaged was taken"
claim "what is stale or damaged is made again"
rm -r $kept
touch work1/registered
"$mimik" animate work1 --source bs000 --target bs000 --au 12 -o nowhere/face.ply --quiet
cmp first/face.ply nowhere/face.ply
expect_code 2 "registered" "$mimik" register work1 --subject bs000
rm work1/registered
claim "where nothing can be kept faces are animated all the same, and 'register' says so"

expect_code 2 "bs000, bs001, bs002" "$mimik" register work1 --subject bs009
expect_code 2 "AU99 is not in the catalogue" "$mimik" register work1 --au 99
[ ! -e $kept ] || fail "something was left behind"
claim "wrong input is named, ends with 2 and leaves nothing behind"
echo '{}' >work1/faces/bs001/bs001_LFAU_12_0.json
expect_code 1 $'bs001_LFAU_12_0' "$mimik" register work1 --subject bs000,bs001 --au 12 --quiet
grep -q '^bs001_LFAU_12_0,,,,,' $kept/registrations.csv && [ -s $kept/bs000/bs000_LFAU_12_0.ply ]
claim "a scan that cannot be used is told, and the rest goes on"
