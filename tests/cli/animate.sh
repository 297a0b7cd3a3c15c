#!/usr/bin/env bash
# animate.sh MIMIK FOLDER SHARED: what a shell meets of 'mimik animate'.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_workspace
"$mimik" animate work1 --source bs000 --target bs001 --au 12L,4:0.5 -o face.glb --quiet
"$mimik" animate work1 --source bs000 --target bs001 --au AU12_L --au au4:0.5 -o named.glb --quiet
cmp face.glb named.glb
claim "an expression may be typed in every way in which it is written"
"$mimik" animate work1 --source BS000 --target Bs001 --au 12L,4:0.5 -o face2.glb --quiet
cmp face.glb face2.glb
expect_code 2 "'BS077'" "$mimik" animate work1 --target BS077 --au 12 -o nothing.ply
claim "subjects are found in capitals too, and one that is not there is named as it was typed"

echo '{"schema": 1}' >scores.json
expect_code 2 "scores.json: is no expression model; give a file of 'mimik model'" "$mimik" animate work1 --target bs001 --model scores.json -o nothing.ply
expect_code 2 "nothing to animate" "$mimik" animate work1 --target bs001 -o nothing.ply
expect_code 3 "AU12 at magnitude 1e+300" "$mimik" animate work1 --source bs000 --target bs001 --au 12:1e300 -o nothing.ply
expect_code 2 "AU99 is not in the catalogue; there are: 1, 2" "$mimik" animate work1 --target bs001 --au 99 -o nothing.ply
expect_code 2 "no scan of expression '17'" "$mimik" animate work1 --source bs000 --target bs001 --au 17 -o nothing.ply
expect_code 2 "bs000, bs001, bs002" "$mimik" animate work1 --source bs000 --target bs009 --au 12 -o nothing.ply
expect_code 2 $'the thesis method has no mean\nbs000' "$mimik" animate work1 --target bs001 --au 12 -o nothing.ply --method thesis
[ ! -e nothing.ply ]
claim "wrong input is named, ends with 2 (3: the numbers allow no answer) and leaves nothing behind"

"$mimik" animate work1 --source bs000 --target bs001 --au A4A12 -o both.ply 2>notes.txt
grep -q 'A4A12\|AU4+AU12' notes.txt && grep -q 'composed of AU4 + AU12 (--combine sum)' notes.txt || { cat notes.txt; fail "no word of the parts"; }
"$mimik" animate work1 --source bs000 --target bs001 --au 4,12 -o parts.ply --quiet
cmp <(tail -c 100000 both.ply) <(tail -c 100000 parts.ply) || fail "the parts by their name are not the parts"
"$mimik" animate work1 --source bs000 --target bs001 --au HAPPY --method thesis --combine parallel -o happy.ply 2>notes.txt
grep -q 'HAPPY: no scan shows it, so it is composed of AU12 (--combine parallel); AU6 left out' notes.txt || { cat notes.txt; fail "HAPPY"; }
expect_code 2 "no scan of expression 'SURPRISE'" "$mimik" animate work1 --source bs000 --target bs001 --au SURPRISE -o nothing.ply
[ ! -e nothing.ply ]
claim "an expression of several AUs that no scan shows is composed of those that are shown"

for extension in ply obj vtp; do
  "$mimik" animate work1 --source bs000 --target bs001 --au 12 --method thesis -o "face.$extension" --quiet
  [ -s "face.$extension" ]
done
claim "faces are written in every format"

"$mimik" animate work1 --source bs000 --target bs001 --au 12 --keep-bridged -o kept.obj --json >kept.json
grep -q '"vertex_values": "kept_vertices.csv"' kept.json && grep -q 'are in kept_vertices.csv' kept.json || fail "no word of the table"
[ "$(head -n 1 kept_vertices.csv)" = vertex,displacement_mm_x,displacement_mm_y,displacement_mm_z,origin ] || fail "columns"
[ "$(tail -n +2 kept_vertices.csv | wc -l)" -eq "$(grep -c '^v ' kept.obj)" ] || fail "rows"
grep -q ',1$' kept_vertices.csv && grep -q ',2$' kept_vertices.csv || fail "bridged vertices are not marked"
"$mimik" animate work1 --source bs000 --target bs001 --au 12 --keep-bridged -o kept.glb --quiet
grep -qa '"_ORIGIN"' kept.glb && grep -qa '"_DISPLACEMENT_MM"' kept.glb || fail "GLB without values per vertex"
claim "every format says how each vertex moved and which were bridged, an OBJ in the table beside it"

largest() { sed -n 's/^ *"largest_displacement_mm": \(.*\),/\1/p' "$1" | tail -n 1; }
for frame in scanner average; do
  "$mimik" animate work1 --source bs000 --target bs001 --au 12 --frame $frame --keep-bridged -o frame.ply --json >$frame.json
  "$mimik" animate work1 --source bs000 --target bs001 --au 12:0 --frame $frame --keep-bridged -o frame0.ply --quiet
done
[ -n "$(largest scanner.json)" ] && [ "$(largest scanner.json)" != "$(largest average.json)" ] || fail "the same length in both frames"
claim "lengths in the result are those of the frame that is written"

"$mimik" synthesize lips --subjects 2 --expressions 1,12,27 --seed 5 --quiet  # the inner lips of bs001 are 0.7 mm apart
"$mimik" preprocess lips -o lips_work --quiet
for unit in 1 12 27; do
  "$mimik" animate lips_work --source bs000 --target bs001 --au $unit --method sparse -o lips.ply --json >lips$unit.json
done
grep -q '"AU27 pulls the lips apart, but those of bs001_N_N_0 are closed' lips27.json || fail "no word of closed lips"
expect_code 0 "note: AU27 pulls the lips apart" "$mimik" animate lips_work --source bs000 --target bs001 --au 27 --method sparse -o lips.ply
! grep -q 'lips apart' lips1.json lips12.json || fail "a note on lips that stay together"
claim "who opens a closed mouth by control points is told that it stays one piece, and nobody else"

"$mimik" animate lips_work --source bs000 --target bs001 --au 27 -o dense.ply --json >dense.json
! grep -q 'lips apart' dense.json || fail "the template's lips part, and are said not to"
faces() { sed -n 's/^element face //p' "$1" | head -n 1; }
"$mimik" animate lips_work --source bs000 --target bs001 --au 27:0 -o rest.ply --quiet
[ "$(faces dense.ply)" -lt "$(faces rest.ply)" ] || fail "the surface between the lips is still there"
"$mimik" model lips_work --source bs000 --au 27 -o dense_models --quiet
"$mimik" animate lips_work --target bs001 --model dense_models/bs000/AU27.json -o stored.ply --quiet
"$mimik" distance dense.ply stored.ply --json | grep -q '"max": 0.0' || fail "a stored dense model moves a face otherwise"
claim "a dense model opens a closed mouth, and a stored one does the same"

"$mimik" panels lips_work --source bs000 --target bs001 --au 12 -o own --quiet
mesh=$(find own -name target_neutral.ply) marks=$(find own -name target_landmarks.csv)
"$mimik" animate lips_work --source bs000 --mesh "$mesh" --landmarks "$marks" --au 12 -o own.ply --json >own.json
[ "$(faces own.ply)" = "$(faces "$mesh")" ] || fail "faces of the mesh are lost"
grep -q '"target": "target_neutral.ply"\|"target": ".*target_neutral.ply"' own.json || fail "the mesh is not named"
expect_code 2 "give it, or --mesh and --landmarks" "$mimik" animate lips_work --au 12 -o none.ply
expect_code 2 "are for faces of the workspace; leave them out" "$mimik" animate lips_work --mesh "$mesh" --landmarks "$marks" --au 12 --keep-bridged -o none.ply
[ ! -e none.ply ]
claim "a mesh of one's own is animated with all its faces"

"$mimik" animate work1 --source bs000 --target bs001 --au 12:0 -o neutral.ply --quiet
"$mimik" distance neutral.ply neutral.ply --json | awk '/"max"/ { sub(/.*: /, ""); if ($0 + 0 > 1e-6) exit 1 }'
claim "a face is nowhere off itself"  # a vertex that no polygon uses would be
"$mimik" distance face.ply neutral.ply --json >distance.json
grep -q '"units": "mm"' distance.json
claim "faces can be measured"

echo '{}' >work1/faces/bs000/bs000_LFAU_12_0.json
expect_code 1 $'left out of the mean\nbs000_LFAU_12_0' "$mimik" animate work1 --au 12 -o mean.ply --target bs001 --quiet
code=0
"$mimik" animate work1 --target bs001 --au 12 -o mean.ply --json >mean.json 2>/dev/null || code=$?
[ "$code" -eq 1 ] && grep -A1 '"failures": \[' mean.json | grep -q bs000_LFAU_12_0 || fail "no failure in the JSON"
[ -s mean.ply ]
claim "a scan that a mean cannot use is a failure (1), and the mean is of the others"
