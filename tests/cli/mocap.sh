#!/usr/bin/env bash
# mocap.sh MIMIK FOLDER: recordings of markers are described, cut and converted without a loss.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

cat >take.csv <<'TABLE'
frame,time,LBRO_x,LBRO_y,LBRO_z,lip_x,lip_y,lip_z
7,0,1.5,2.25,-3,10,20,30
8,0.01,1.5,2.5,-3,,,
9,0.02,1.5,2.75,-3,0,0,0
TABLE
"$mimik" mocap info take.csv >info.txt
grep -q 'CSV, wide; 2 markers, 3 frames from 7 on, 100 Hz' info.txt || fail "$(cat info.txt)"
grep -q "1 sample is missing in 1 gap, most of 'lip' (1 of 3 frames)" info.txt || fail "gaps: $(cat info.txt)"
"$mimik" mocap info take.csv --json >info.json
python3 - info.json <<'CHECK' || fail "the JSON document"
import json, sys
d = json.load(open(sys.argv[1]))
assert d["schema"] == 1 and d["points"] == 2 and d["frames"] == 3 and d["rate_hz"] == 100 and d["unit"] == "mm", d
assert d["labels"] == ["LBRO", "lip"] and d["valid"] == [3, 2], d
assert d["gaps"] == [{"marker": "lip", "first": 8, "last": 8}], d
CHECK
claim "a recording is described, a marker at the origin is no gap"

"$mimik" mocap convert take.csv take.c3d
"$mimik" mocap convert take.c3d take.trc
"$mimik" mocap convert take.trc back.csv
cmp take.csv back.csv
claim "CSV, C3D and TRC hold the same"

"$mimik" mocap convert take.c3d part.csv --frames 8:9 --markers lip
printf 'frame,time,lip_x,lip_y,lip_z\n8,0,,,\n9,0.01,0,0,0\n' | cmp - part.csv
"$mimik" mocap convert take.csv metres.csv --unit m
grep -q '^7,0,1500,2250,-3000,' metres.csv || fail "$(cat metres.csv)"
claim "frames and markers are cut out, and units go before the file's"

expect_code 2 $'--frames: frames 1 to 9 are asked for\nthere are 7 to 9' "$mimik" mocap convert take.csv o.csv --frames 1:9
expect_code 2 "--markers: there is no marker 'lbro'; did you mean 'LBRO'?" "$mimik" mocap convert take.csv o.csv --markers lbro
expect_code 2 "there are .c3d, .trc, .csv and .tsv" "$mimik" mocap convert take.csv o.bvh
head -c 1200 take.c3d >cut.c3d
expect_code 2 "cut.c3d: " "$mimik" mocap info cut.c3d
[ ! -e o.csv ] || fail "written all the same"
claim "what there is not is named, and nothing is written"
