#!/usr/bin/env bash
# single_mesh.sh MIMIK FOLDER SHARED: one mesh with its landmarks, and no workspace.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_workspace
"$mimik" panels work1 --source bs000 --target bs001 --au 12 -o panel --quiet || [ $? -eq 1 ]  # 1: nothing to draw with
mesh=$(find panel -name target_neutral.ply) marks=$(find panel -name target_landmarks.csv)
rm -r work1
[ -s "$mesh" ] && [ -s "$marks" ] || fail "no mesh to begin with"
own=(animate --mesh "$mesh" --landmarks "$marks")
faces() { sed -n 's/^element face //p' "$1" | head -n 1; }
largest() { sed -n 's/^ *"largest_displacement_mm": \(.*\),/\1/p' "$1" | tail -n 1; }

"$mimik" animate --mesh "$mesh" --landmarks "$marks" --au 12 -o smile.ply --json >smile.json
[ "$(faces smile.ply)" = "$(faces "$mesh")" ] || fail "faces of the mesh are lost"
grep -q '"source": "built-in"' smile.json || fail "nobody says who smiles"
# A smile moves the corners of a mouth by 5 to 15 mm.
awk -v mm="$(largest smile.json)" 'BEGIN { exit !(mm > 4 && mm < 16) }' || fail "a smile of $(largest smile.json) mm"
claim "a mesh smiles without a database"

"$mimik" animate --mesh "$mesh" --landmarks "$marks" --au 12 --threads 1 -o smile1.ply --quiet
cmp smile.ply smile1.ply
claim "the same mesh, whatever the number of threads"

"$mimik" animate --mesh "$mesh" --landmarks "$marks" --au arkit,12L:0.5 --arkit-names -o shapes.glb --json >shapes.json
for shape in jawOpen mouthSmileLeft mouthSmileRight browInnerUp eyeBlinkLeft; do
  grep -qa "\"$shape\"" shapes.glb || fail "the file has no $shape"
done
[ "$(grep -c '"expression"' shapes.json)" -eq 31 ] || fail "$(grep -c '"expression"' shapes.json) shapes, not the 31 of README"
[ "$(grep -c '"magnitude": 0.0' shapes.json)" -eq 30 ] || fail "more than what was asked for by name is not at rest"
claim "all expressions that ARKit has are blendshapes of one file, at rest"

"$mimik" animate --mesh "$mesh" --landmarks "$marks" --au 12,26:0.5 -o two.glb --quiet
grep -qa '"AU12"' two.glb && grep -qa '"AU26"' two.glb || fail "morph targets without names"
"$mimik" animate --mesh "$mesh" --landmarks "$marks" --au 12,26:0.5 --combine parallel -o one.glb --quiet
grep -qa '"AU12+AU26"' one.glb || fail "the parallel resultant is not one target"
claim "a mesh of one's own goes into a GLB with its expressions"

expect_code 2 $'is a subject of a workspace\ngive WORK' "$mimik" animate --target bs001 --au 12 -o none.ply
expect_code 2 $'--source\ngive WORK' "$mimik" animate --source bs000 --mesh "$mesh" --landmarks "$marks" --au 12 -o none.ply
awk -F, -v OFS=, 'NR > 1 { for (k = 2; k <= 4; ++k) $k = sprintf("%.9f", $k / 10) } { print }' "$marks" >cm.csv
"$mimik" "${own[@]}" --au 12:0 -o mm.obj --quiet
awk '$1 == "v" { printf "v %.9f %.9f %.9f\n", $2 / 10, $3 / 10, $4 / 10; next } { print }' mm.obj >cm.obj
expect_code 2 $'cm.obj
--unit mm, cm' "$mimik" animate --mesh cm.obj --landmarks cm.csv --au 12 -o none.ply
"$mimik" animate --mesh cm.obj --landmarks cm.csv --unit cm --au 12 -o of_cm.ply --quiet
"$mimik" distance of_cm.ply smile.ply --json >unit.json
awk '/"max"/ { sub(/.*: /, ""); if ($0 + 0 > 1e-3) exit 1 }' unit.json || fail "another unit, another face"
claim "a mesh in another unit is refused until its unit is said, and comes out in millimetres"

"$mimik" synthesize db --subjects 3 --expressions 12 --quiet >/dev/null
"$mimik" preprocess db -o work --quiet >/dev/null
"$mimik" model work --source bs000 --au 12 --quiet >/dev/null
"$mimik" animate --model work/models/default/bs000/AU12.json --mesh "$mesh" --landmarks "$marks" -o others.ply --quiet
echo bs000 >db/unallowed_subjects.txt
mkdir elsewhere
mv others.ply elsewhere
expect_code 2 "bs000" "$mimik" distance elsewhere/others.ply "$mesh"
claim "a stored model moves a mesh without its workspace, and whom it shows stays hidden wherever the mesh goes"

expect_code 2 $'--method thesis\ngive WORK' "$mimik" animate --method thesis --mesh "$mesh" --landmarks "$marks" --au 12 -o none.ply
expect_code 2 "the built-in faces do not show" "$mimik" animate --mesh "$mesh" --landmarks "$marks" --au 11 -o none.ply
expect_code 2 "--au arkit:0.5" "$mimik" "${own[@]}" --au arkit:0.5 -o none.glb
expect_code 2 "none.ply holds no blendshapes" "$mimik" "${own[@]}" --au arkit -o none.ply
expect_code 2 "--combine parallel" "$mimik" "${own[@]}" --au arkit -o none.glb --combine parallel
expect_code 2 "no such file" "$mimik" animate --mesh nothere.obj --landmarks "$marks" --au 12 -o none.ply
expect_code 2 ".glb, not '.fbx'" "$mimik" animate --mesh "$mesh" --landmarks "$marks" --au 12 -o none.fbx
[ ! -e none.ply ] && [ ! -e none.glb ]
claim "what needs a workspace is refused by name, and nothing is left behind"
