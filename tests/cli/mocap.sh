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
head -c 1100 take.c3d >cut.c3d
expect_code 2 "cut.c3d: " "$mimik" mocap info cut.c3d
[ ! -e o.csv ] || fail "written all the same"
claim "what there is not is named, and nothing is written"

python3 - <<'TAKE'
import math
names = {"forehead_low": (0, 70, -20), "glabella": (0, 51, -22), "nose_root": (0, 31, -25), "nose_tip": (0, 0, 0),
         "temple_left": (62, 36, -52), "temple_right": (-62, 36, -52), "chin": (0, -69, -20), "mouth_corner_left": (25, -39, -29),
         "mouth_corner_right": (-25, -39, -29), "lip_lower_middle": (0, -48, -15), "chin_fold": (0, -58, -18),
         "HEAD1": (-60, 120, -40), "HEAD2": (60, 120, -40), "HEAD3": (0, 130, -90)}
with open("talk.csv", "w") as f:
    f.write("frame,time," + ",".join(f"{n}_{a}" for n in names for a in "xyz") + "\n")
    for k in range(30):
        row = [str(k + 1), str(k / 120)]
        for n, (x, y, z) in names.items():
            if y < -45: y -= 5 - 5 * math.cos(0.4 * k)          # the mouth opens
            if n == "glabella" and 10 <= k < 14:
                row += ["", "", ""]
                continue
            c, s = math.cos(0.02 * k), math.sin(0.02 * k)       # the head turns and sinks
            row += [repr(c * x + s * z), repr(y - k), repr(-s * x + c * z)]
        f.write(",".join(row) + "\n")
with open("labels.csv", "w") as f:
    f.write("name,x,y,z\n")
    for n, (x, y, z) in names.items():
        if n[:4] != "HEAD": f.write(f"{n},{1.25 * x},{1.25 * y},{1.25 * z}\n")
TAKE
"$mimik" mocap clean talk.csv -o clean.csv --jig HEAD1,HEAD2,HEAD3 --json >clean.json
"$mimik" mocap clean talk.csv -o robust.csv --json >robust.json
"$mimik" mocap retarget clean.csv --to labels.csv -o there.csv --json >there.json
python3 - <<'CHECK' || fail "cleaning or retargeting"
import csv, json
d = json.load(open("clean.json"))
assert d["points"] == 11 and d["rest_frame"] == 1 and d["residual_mm"]["largest"] < 1e-9, d
assert d["gaps"] == [{"marker": "glabella", "filled": 4, "missing": 0}], d
rows = list(csv.DictReader(open("clean.csv")))
for r in rows:  # what is fixed to the skull stands still, the gap of the glabella among it
    for name, x, y, z in (("nose_root", 0, 31, -25), ("glabella", 0, 51, -22)):
        off = max(abs(float(r[f"{name}_{a}"]) - v) for a, v in zip("xyz", (x, y, z)))
        assert off < 1e-9, (r["frame"], name, off)
t = json.load(open("there.json"))
assert abs(t["scale"] - 1.25) < 1e-9, t
for r, s in zip(rows, csv.DictReader(open("there.csv"))):
    assert abs(float(s["chin_y"]) - 1.25 * float(r["chin_y"])) < 1e-6, r["frame"]
CHECK
claim "the head's motion comes off, gaps are filled, and a larger face moves as much more"

"$mimik" mocap markers >set.toml
"$mimik" mocap markers --lint set.toml | grep -q "no findings" || fail "the built-in set"
sed '0,/"forehead_high"/s//"forehead_hihg"/' set.toml >bad.toml
expect_code 1 "there is no marker" "$mimik" mocap markers --lint bad.toml
expect_code 2 "bad.toml: line" "$mimik" mocap clean talk.csv -o o.csv --set bad.toml
expect_code 2 "--jig: jig names 2 markers" "$mimik" mocap clean talk.csv -o o.csv --jig HEAD1,HEAD2
expect_code 2 "4 are the least" "$mimik" mocap retarget take.csv --to labels.csv -o o.csv
[ ! -e o.csv ] || fail "written all the same"
claim "marker sets are checked, and what cannot be done is said"
