#!/usr/bin/env bash
# single_mesh.sh MIMIK FOLDER SHARED: one mesh with its landmarks, and no workspace.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_workspace
"$mimik" panels work1 --source bs000 --target bs001 --au 12 -o panel --quiet || [ $? -eq 1 ]  # 1: nothing to draw with
mesh=$(find panel -name target_neutral.ply) marks=$(find panel -name target_landmarks.csv)
rm -r work1
[ -s "$mesh" ] && [ -s "$marks" ] || fail "no mesh to begin with"
faces() { sed -n 's/^element face //p' "$1" | head -n 1; }
largest() { sed -n 's/^ *"largest_displacement_mm": \(.*\),/\1/p' "$1" | tail -n 1; }

"$mimik" animate --mesh "$mesh" --landmarks "$marks" --au 12 -o smile.ply --json >smile.json
[ "$(faces smile.ply)" = "$(faces "$mesh")" ] || fail "faces of the mesh are lost"
grep -q '"source": "the built-in faces"' smile.json || fail "nobody says who smiles"
# A smile moves the corners of a mouth by 5 to 15 mm.
awk -v mm="$(largest smile.json)" 'BEGIN { exit !(mm > 4 && mm < 16) }' || fail "a smile of $(largest smile.json) mm"
claim "a mesh smiles without a database"

"$mimik" animate --mesh "$mesh" --landmarks "$marks" --au 12 --threads 1 -o smile1.ply --quiet
cmp smile.ply smile1.ply
claim "the same mesh, whatever the number of threads"

"$mimik" animate --mesh "$mesh" --landmarks "$marks" --au arkit --arkit-names -o shapes.glb --json >shapes.json
for shape in jawOpen mouthSmileLeft mouthSmileRight browInnerUp eyeBlinkLeft; do
  grep -qa "\"$shape\"" shapes.glb || fail "the file has no $shape"
done
[ "$(grep -c '"magnitude": 0.0' shapes.json)" -ge 20 ] || fail "the shapes are not at rest"
claim "all expressions that ARKit has are blendshapes of one file, at rest"

"$mimik" animate --mesh "$mesh" --landmarks "$marks" --au 12,26:0.5 -o two.glb --quiet
grep -qa '"AU12"' two.glb && grep -qa '"AU26"' two.glb || fail "morph targets without names"
"$mimik" animate --mesh "$mesh" --landmarks "$marks" --au 12,26:0.5 --combine parallel -o one.glb --quiet
grep -qa '"AU12+AU26"' one.glb || fail "the parallel resultant is not one target"
claim "a mesh of one's own goes into a GLB with its expressions"

expect_code 2 $'is a subject of a workspace\ngive WORK' "$mimik" animate --target bs001 --au 12 -o none.ply
expect_code 2 $'--source\ngive WORK' "$mimik" animate --source bs000 --mesh "$mesh" --landmarks "$marks" --au 12 -o none.ply
expect_code 2 $'--method thesis\ngive WORK' "$mimik" animate --method thesis --mesh "$mesh" --landmarks "$marks" --au 12 -o none.ply
expect_code 2 "the built-in faces do not show" "$mimik" animate --mesh "$mesh" --landmarks "$marks" --au 11 -o none.ply
expect_code 2 "no such file" "$mimik" animate --mesh nothere.obj --landmarks "$marks" --au 12 -o none.ply
expect_code 2 ".glb, not '.fbx'" "$mimik" animate --mesh "$mesh" --landmarks "$marks" --au 12 -o none.fbx
[ ! -e none.ply ]
claim "what needs a workspace is refused by name, and nothing is left behind"
