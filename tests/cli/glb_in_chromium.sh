#!/usr/bin/env bash
# glb_in_chromium.sh MIMIK FOLDER SHARED: moving faces of 'mocap animate' and 'perform' in a browser, by three.js, and before
# the validator of Khronos where it is installed (tests/gltf/validate.mjs). Ends with 77 where there is no browser, no node,
# or no three.js (it comes with the report's page). Pictures stay in pictures/.
set -euo pipefail
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

chromium=$(command -v chromium || true)
[ -n "$chromium" ] || { echo "skipped: there is no chromium (scripts/setup.sh --browser)"; exit 77; }
command -v node >/dev/null || { echo "skipped: there is no node (scripts/setup.sh --page)"; exit 77; }
modules=$(dirname "$mimik")/../report/page/node_modules
[ -x "$modules/.bin/esbuild" ] || { echo "skipped: the report's page was not built, and three.js comes with it"; exit 77; }

borrow_workspace
mkdir pictures
"$mimik" mocap synthesize take --seconds 1 --rate 30 --truth-every 0 --quiet >/dev/null
jig=jig_1,jig_2,jig_3,jig_4,jig_5,jig_6,jig_7
"$mimik" mocap animate take/recording_b.c3d --jig $jig --target work1:bs000 --method bones -o mocap_scan.glb --quiet >/dev/null
"$mimik" mocap animate take/recording_b.c3d --jig $jig --target take/target.ply --landmarks take/target_landmarks.csv \
  --method bones -o mocap_mesh.glb --quiet >/dev/null
printf 'Timecode,BlendShapeCount,JawOpen,EyeBlinkLeft,EyeBlinkRight\n' >link.csv
for frame in 00 01 02 03 04 05 06 07; do
  printf '10:00:00:%s,3,%s,%s,%s\n' $frame $((10#$frame == 3)) $((10#$frame == 6)) $((10#$frame == 6))
done >>link.csv
for face in work1:bs000 built-in; do
  name=perform_${face#*:}
  "$mimik" examples $face -o $name --quiet >/dev/null
  "$mimik" perform link.csv --examples $name -o $name.glb --quiet >/dev/null
done

files=(mocap_scan.glb mocap_mesh.glb perform_bs000.glb perform_built-in.glb)
code=0
node "$tests/gltf/validate.mjs" "${files[@]}" || code=$?
[ $code -eq 0 ] || [ $code -eq 77 ] || fail "the validator has a fault to find"
[ $code -eq 77 ] || claim "the validator finds no error and warns of nothing"
node "$tests/page/glb_in_chromium.mjs" "$chromium" "$modules" pictures "${files[@]}"
