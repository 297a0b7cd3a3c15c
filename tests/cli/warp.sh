#!/usr/bin/env bash
# warp.sh MIMIK FOLDER: what a shell meets of 'mimik warp', on files small enough to know the answers by heart.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

# A row of a points CSV is what it must be, within 1e-9: coordinates below 100 round at 1e-14, the solve adds a few digits.
expect_row() {  # file, name, x y z
  awk -F, -v name="$2" -v x="$3" -v y="$4" -v z="$5" '
    function off(a, b) { return a - b > 1e-9 || b - a > 1e-9 }
    $1 == name { found = 1; if (off($2, x) || off($3, y) || off($4, z)) { print; wrong = 1 } }
    END { exit wrong || !found }' "$1" || { cat "$1"; fail "$1: $2 is not at $3 $4 $5"; }
}
cat >box.csv <<'END'
name,x,y,z
a,0,0,0
b,40,0,0
c,0,40,0
d,0,0,40
e,40,40,40
END
awk -F, -v OFS=, 'NR > 1 { $2 += 5; $3 -= 2; $4 += 0.5 } { print }' box.csv >moved.csv
printf 'name,x,y,z\nlast,1,2,3\nfirst,10,-20,30\nlast,70,7,7\n' >points.csv

for kernel in r r2logr; do
  for smoothing in 0 10; do
    "$mimik" warp --from box.csv --to box.csv --kernel $kernel --smoothing $smoothing points.csv -o same.csv --quiet
    expect_row same.csv first 10 -20 30
    "$mimik" warp --from box.csv --to moved.csv --kernel $kernel --smoothing $smoothing points.csv -o shifted.csv --quiet
    expect_row shifted.csv first 15 -22 30.5
  done
done
claim "landmarks that stay move nothing, and landmarks that all move alike move every point alike, for any kernel and smoothing"
for kernel in r2 R 1; do
  expect_code 2 $'--kernel\nr2logr' "$mimik" warp --from box.csv --to box.csv --kernel $kernel points.csv -o nothing.csv
done
[ ! -e nothing.csv ] || fail "a kernel that there is not"
claim "a kernel of another name is refused with the names that there are"
[ "$(cut -d, -f1 shifted.csv | tr '\n' ' ')" = "name last first last " ] || fail "names and order"
claim "names and order of a CSV are kept"

# Two squares of 40 mm, 3 mm apart.
square() {  # z
  printf 'v 0 0 %s\nv 40 0 %s\nv 40 40 %s\nv 0 40 %s\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n' "$1" "$1" "$1" "$1"
}
square 0 >low.obj

"$mimik" warp --from box.csv --to moved.csv low.obj -o low_moved.obj --json >warp.json
grep -q '"landmarks": 5' warp.json && grep -q '"points": 4' warp.json || fail "report of warp"
grep -q '^f 1/1 2/2 3/3 4/4' low_moved.obj && [ "$(grep -c '^vt ' low_moved.obj)" -eq 4 ] || fail "faces or texture of the mesh"
awk '$1 == "v" { d = $2 - 45; n += (d < 1e-9 && d > -1e-9) } END { exit n != 2 }' low_moved.obj || fail "corners of the moved square"
claim "a warped mesh keeps its faces and texture coordinates"

"$mimik" warp --from box.csv --to moved.csv low.obj -o $'caf\xe9.obj' --json >warp.json || fail "a name that is no UTF-8"
grep -q '"points": 4' warp.json && iconv -f UTF-8 -t UTF-8 warp.json >copy.json || fail "JSON of a name that is no UTF-8"
claim "--json is UTF-8 whatever the bytes of a file's name"

touch bs000_N_N_0.bnt
expect_code 2 $'bs000_N_N_0.bnt: is a range scan\nWORK/faces/SUBJECT/bs000_N_N_0.ply' "$mimik" warp --from box.csv --to moved.csv bs000_N_N_0.bnt -o nothing.ply
expect_code 2 "give .csv, .ply, .obj, .stl or .vtp" "$mimik" warp --from box.csv --to moved.csv low.obj -o nothing.glb
! grep -q pcd err.txt || fail "a format that is not written is offered"
expect_code 2 ".csv, .ply, .obj, .stl or .vtp" "$mimik" warp --from box.csv --to moved.csv low.obj -o nothing.pcd
claim "who gives a range scan is told how to get a mesh, and formats are offered that are written"

grep -v '^b,' box.csv >fewer.csv
printf 'f,1,1,1\ng,2,2,2\n' >>fewer.csv
expect_code 2 $'b\nf\ng' "$mimik" warp --from box.csv --to fewer.csv points.csv -o nothing.csv
for name in b f g; do grep -qwF "$name" err.txt || fail "$name is not named"; done

printf 'name,x,y,z\na,0,0,0\nb,1,0,0\nc,2,1,0\nd,0,1,0\n' >flat.csv
expect_code 3 "plane" "$mimik" warp --from flat.csv --to flat.csv points.csv -o nothing.csv
[ ! -e nothing.csv ] || fail "a file that should not be"
printf 'name,x,y,z\nnear,1,2,3\nfar,1e200,0,0\n' >far.csv
expect_code 3 "'far'" "$mimik" warp --from box.csv --to moved.csv far.csv -o nothing.csv
[ ! -e nothing.csv ] || fail "a file that should not be"
claim "landmarks without a partner are all named, as are flat landmarks and points beyond all numbers (3)"
