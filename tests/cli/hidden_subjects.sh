#!/usr/bin/env bash
# hidden_subjects.sh MIMIK FOLDER SHARED: a rule for all commands: nothing shows a subject who must not be shown; and one cut scan spoils no others.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

cp -rs "$shared/db1" broken
rm broken/bs002/bs002_LFAU_12_0.bnt
head -c 1000 "$shared/db1/bs002/bs002_LFAU_12_0.bnt" >broken/bs002/bs002_LFAU_12_0.bnt
expect_code 1 "bs002_LFAU_12_0" "$mimik" preprocess broken -o broken_work --quiet
[ -e broken_work/faces/bs002/bs002_UFAU_4_0.json ]
expect_code 1 "bs002_LFAU_12_0" "$mimik" scans broken --no-index
claim "one cut scan is reported with 1, and the rest is done"

echo BS001 >broken/Unallowed_Subjects.txt  # neither case is that of the scans
code=0
"$mimik" preprocess broken -o broken_work --quiet >/dev/null 2>&1 || code=$?
[ "$code" -eq 1 ]
expect_code 2 "bs001" "$mimik" animate broken_work --source mean --target bs001 --au 4 -o hidden.ply
expect_code 2 "bs001" "$mimik" panels broken_work --target bs001 --au 4 -o hidden
expect_code 2 "bs001" "$mimik" panels broken_work --source bs001 --target bs000 --au 4 -o hidden
face=broken_work/faces/bs001/bs001_N_N_0.ply
expect_code 2 "'bs001' stands in" "$mimik" figure $face -o hidden.png
expect_code 2 "'bs001' stands in" "$mimik" distance $face broken_work/average/average_face.ply -o hidden.vtp
mkdir elsewhere
for extension in ply obj vtp; do
  "$mimik" animate broken_work --source mean --target bs002 --au 4 -o elsewhere/face.$extension --quiet >/dev/null
done
"$mimik" distance elsewhere/face.ply broken_work/average/average_face.ply -o elsewhere/far.vtp --quiet >/dev/null
printf 'name,x,y,z\na,0,0,0\nb,40,0,0\nc,0,40,0\nd,0,0,40\ne,40,40,40\n' >box.csv
"$mimik" warp --from box.csv --to box.csv elsewhere/face.ply -o elsewhere/again.ply --quiet >/dev/null
! grep -aFe "$PWD" -e "$shared" elsewhere/*.{ply,obj,mtl} || fail "a file tells where its database lies"
grep -qa '^comment database: broken ([0-9a-f]\{16\})$' elsewhere/face.ply && grep -qa '^comment database: broken (' elsewhere/again.ply || fail "no word of the database"
claim "what is passed on names its database and no folder of this machine"
echo bs002 >>broken/Unallowed_Subjects.txt  # is heeded without another preprocessing
for shown in broken_work/faces/bs002/bs002_N_N_0.ply elsewhere/face.ply elsewhere/face.obj elsewhere/face.vtp elsewhere/far.vtp elsewhere/again.ply; do
  expect_code 2 "'bs002' stands in" "$mimik" figure $shown -o hidden.png
  expect_code 2 "'bs002' stands in" "$mimik" distance $shown broken_work/average/average_face.ply -o hidden.vtp
  expect_code 2 "'bs002' stands in" "$mimik" warp --from $shown --to $shown $shown -o hidden.ply
done
mkdir -p folder_list && cp -rs "$shared/db1" folder_list/db && mkdir folder_list/db/unallowed_subjects.txt
expect_code 2 "unallowed_subjects.txt: is a folder, so nobody knows whom it hides" "$mimik" scans folder_list/db --no-index
expect_code 2 "bs002" "$mimik" animate broken_work --source mean --target bs002 --au 4 -o hidden.ply
[ ! -e hidden.ply ] && [ ! -e hidden ] && [ ! -e hidden.png ] && [ ! -e hidden.vtp ] || fail "a file of a hidden subject"
echo BS001 >broken/Unallowed_Subjects.txt
"$mimik" preprocess broken -o broken_work --sheets --quiet >/dev/null 2>&1 || [ $? -eq 1 ]
[ ! -e broken_work/sheets/bs001.png ] && { ! can_draw || [ -e broken_work/sheets/bs000.png ]; } || fail "sheets"
claim "a subject who must not be shown is not"

mkdir -p db/bs003
printf 'v 0 0 0\nv 40 0 0\nv 40 40 0\nv 0 40 0\nf 1 2 3 4\n' >plain.obj
cp plain.obj db/bs003/bs003_N_N_0.obj
cp box.csv db/bs003/bs003_N_N_0.csv
echo bs003 >db/unallowed_subjects.txt
scan=db/bs003/bs003_N_N_0
expect_code 2 "'bs003' stands in" "$mimik" warp --from box.csv --to box.csv $scan.obj -o nothing.csv
expect_code 2 "'bs003' stands in" "$mimik" warp --from $scan.csv --to box.csv box.csv -o nothing.csv
expect_code 2 "'bs003' stands in" "$mimik" warp --from box.csv --to $scan.csv box.csv -o nothing.csv
expect_code 2 "'bs003' stands in" "$mimik" distance $scan.obj plain.obj -o nothing.ply
expect_code 2 "'bs003' stands in" "$mimik" distance plain.obj $scan.obj -o nothing.ply
[ ! -e nothing.csv ] && [ ! -e nothing.ply ] || fail "a file of a hidden subject"
claim "scans and points of a hidden subject are neither warped nor measured"
