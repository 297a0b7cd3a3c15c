#!/usr/bin/env bash
# figure.sh MIMIK FOLDER SHARED: what a shell meets of 'mimik figure'; what it draws is tested in tests/figures.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

printf 'v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n' >face.obj
expect_code 2 "mimik-figure is neither" without_drawing_program figure face.obj -o nothing.png
[ ! -e nothing.png ]
claim "without the drawing program 2 says that the picture is not there"
if can_draw; then
  "$mimik" figure face.obj face.obj --size 40x40 --caption a --caption b -o out.png --quiet
  is_png out.png
  claim "a mesh is drawn"
fi
expect_code 2 "face.obj: the mesh has no attribute 'nope'" "$mimik" figure face.obj --scalar nope -o nothing.png
expect_code 2 "give one of front, left, right, three-quarter-left, three-quarter-right" "$mimik" figure face.obj --view back -o nothing.png
! grep -q 'three-quarter$' err.txt || fail "a view without its side is offered"
[ ! -e nothing.png ]
claim "an attribute and a view that there are not are refused by name"

cp "$shared/work1/average/average_face.ply" face.ply
expect_code 2 "face.ply: the mesh has no attribute 'nope'; it has: " "$mimik" figure face.ply --scalar nope -o nothing.png
claim "and the attributes that there are are named"
