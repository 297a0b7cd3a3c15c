#!/usr/bin/env bash
# remesh.sh MIMIK FOLDER SHARED: what a shell meets of mimik-remesh, which is built beside it.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"
remesh=$(dirname "$mimik")/mimik-remesh

! readelf -d "$mimik" | grep NEEDED | grep -iE 'mpfr|pcl_|opencv_' || fail "mimik links what the other programs are for"
"$remesh" --help | grep -q 'GPL-3.0-or-later' || fail "no word of the licence"
claim "the program says its licence, and mimik links nothing of it"

borrow_workspace
"$remesh" work1/faces/bs000/bs000_N_N_0.ply -o small.ply --vertices 3000 --resample-border --json >small.json
count=$(sed -n 's/^ *"vertices": \([0-9]*\),$/\1/p' small.json)
[ "$count" -ge 2970 ] && [ "$count" -le 3030 ] || { cat small.json; fail "$count vertices"; }
grep -qa "^element vertex $count$" small.ply || fail "the file has another number"
claim "a face of a workspace gets the number of vertices asked for, within 1 in 100"

# Both ways along the vertices, which the Hausdorff distance bounds.
"$mimik" distance small.ply work1/faces/bs000/bs000_N_N_0.ply --json >distance.json
awk '/"hausdorff"/ { inside = 1 } inside && /"to_input"/ { sub(/.*: /, ""); sub(/,.*/, ""); far = $0 + 0; inside = 0 }
     /"test_to_reference"/ { test = 1 } test && /"max"/ { sub(/.*: /, ""); sub(/,.*/, ""); most = $0 + 0; test = 0 }
     END { exit !(most > 0 && far + 0.011 >= most && far < 3) }' small.json distance.json || { cat small.json distance.json; fail "distances"; }
claim "the Hausdorff distance is not below what 'mimik distance' finds at the vertices"

"$remesh" work1/faces/bs000/bs000_N_N_0.ply -o again.ply --vertices 3000 --resample-border --threads 1 --quiet >/dev/null
cmp small.ply again.ply
grep -qa '^comment .*bs000' small.ply || fail "the file does not say whose face it is"
claim "the same bytes come out every time, and the file says whose face it is"

printf 'v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nf 1 2 3 4\n' >square.obj
"$remesh" square.obj -o square.stl --edge-mm 1 >out.txt
grep -q 'Hausdorff distance 0.0' out.txt || { cat out.txt; fail "a flat square moved"; }
claim "a square stays one"

expect_code 2 "--edge-mm: edge_mm is 0" "$remesh" square.obj -o x.ply --edge-mm 0
expect_code 2 "--vertices: vertices is 3" "$remesh" square.obj -o x.ply --vertices 3
expect_code 2 "square.obj" "$remesh" square.obj -o x.ply --edge-mm 1e-9
expect_code 2 ".txt" "$remesh" square.obj -o x.txt
printf 'v 0 0 0\nv 9 0 0\n' >cloud.obj
expect_code 2 $'cloud.obj\nno face' "$remesh" cloud.obj -o x.ply
[ ! -e x.ply ]
claim "wrong input is named, ends with 2 and leaves nothing behind"

cp -r "$shared/work1" hidden
echo bs000 >hidden/unallowed_subjects.txt
expect_code 2 "bs000" "$remesh" hidden/faces/bs000/bs000_N_N_0.ply -o x.ply
[ ! -e x.ply ]
claim "a hidden subject's face is not remeshed"
