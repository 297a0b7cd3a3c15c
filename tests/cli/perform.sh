#!/usr/bin/env bash
# perform.sh MIMIK FOLDER: examples of the built-in face are made, and a performer's table moves them.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

"$mimik" examples built-in -o face --example smile=12 --example open=27 --example brows_up=1+2 --json --quiet >made.json
python3 - made.json <<'CHECK' || fail "the examples: $(cat made.json)"
import json, sys
d = json.load(open(sys.argv[1]))
assert d["features"] == 48, d["features"]
assert [e["name"] for e in d["examples"]] == ["smile", "open", "brows_up"]
assert all(e["largest_displacement_mm"] > 2 for e in d["examples"]), d["examples"]
CHECK
for file in neutral.ply smile.ply open.ply brows_up.ply features.csv examples.toml; do
  [ -s "face/$file" ] || fail "$file is not there"
done
claim "examples are meshes, a list and a table of features"

# A performer who is at rest for 20 frames and then does each example in turn; a lost frame between.
python3 - face/features.csv motion.csv <<'MAKE'
import csv, sys
rows = list(csv.reader(open(sys.argv[1])))
names = [c[:-2] for c in rows[0][1::3]]
table = {r[0]: [float(x) for x in r[1:]] for r in rows[1:]}
with open(sys.argv[2], "w") as out:
    out.write("# mimik motion, schema 1, rate_hz 25\n")
    out.write("frame,time,state,confidence,rx,ry,rz,tx,ty,tz")
    for n in names: out.write("".join(f",{n}_{a}" for a in "uvxyz"))
    out.write("\n")
    for f, who in enumerate(["neutral"] * 20 + ["smile", None, "open", "brows_up"]):
        out.write(f"{f},{f / 25},{'tracked' if who else 'lost'},{1 if who else 0},,,,,,")
        for k in range(len(names)):
            out.write(",,," + (",".join(str(x) for x in table[who][3 * k:3 * k + 3]) if who else ",,"))
        out.write("\n")
MAKE
"$mimik" perform motion.csv --examples face --source-examples face/features.csv -o out.glb --weights w.csv --json >out.json
python3 - out.json w.csv out.glb <<'CHECK' || fail "the performance: $(cat out.json w.csv)"
import csv, json, struct, sys
d = json.load(open(sys.argv[1]))
assert d["frames"] == 24 and d["lost"] == 1 and d["rate_hz"] == 25, d
rows = list(csv.DictReader(open(sys.argv[2])))
for frame, who in ((5, None), (20, "smile"), (22, "open"), (23, "brows_up")):
    for name in ("smile", "open", "brows_up"):
        assert abs(float(rows[frame][name]) - (1 if name == who else 0)) < 2e-6, (frame, rows[frame])
assert rows[21]["state"] == "lost" and abs(float(rows[21]["smile"]) - 1) < 2e-6, rows[21]
glb = open(sys.argv[3], "rb").read()
j = json.loads(glb[20:20 + struct.unpack("<I", glb[12:16])[0]])
assert j["meshes"][0]["extras"]["targetNames"] == ["smile", "open", "brows_up"]
sampler = j["animations"][0]["samplers"][0]
assert j["accessors"][sampler["input"]]["count"] == 24 and j["accessors"][sampler["output"]]["count"] == 72
CHECK
claim "weights are exact at the examples, held while the face is lost, and move the shapes of a GLB"

"$mimik" perform motion.csv --examples face --key smile=20 --key open=22 -o out2.glb --weights w2.csv --gain 0.5 >said.txt 2>notes.txt
grep -q "nothing drives brows_up" notes.txt || fail "$(cat notes.txt)"
awk -F, 'NR == 22 { exit !($4 > 0.4999 && $4 < 0.5001) }' w2.csv || fail "$(cat w2.csv)"
"$mimik" perform motion.csv --examples face -o frames --size 64 --quiet >/dev/null
[ "$(ls frames | wc -l)" = 24 ] && [ -s frames/frame_000023.png ] || fail "frames"
cmp -s frames/frame_000000.png frames/frame_000001.png || fail "a face at rest moves"
! cmp -s frames/frame_000000.png frames/frame_000023.png || fail "raised brows are not seen"
claim "key frames are examples of the performer's own; pictures are written"

"$mimik" perform motion.csv --examples face --source-examples face/features.csv -o open --size 64 --quiet >/dev/null
python3 - open/frame_000000.png open/frame_000022.png <<'CHECK' || fail "the inside of the mouth"
import struct, sys, zlib
def dark_red(file):
    data, at, body = open(file, "rb").read(), 8, b""
    while at < len(data):
        n, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR": w, h = struct.unpack(">II", data[at + 8:at + 16])
        if kind == b"IDAT": body += data[at + 8:at + 8 + n]
        at += n + 12
    raw, above, found = zlib.decompress(body), bytes(3 * w), 0
    for row in range(h):
        how, line = raw[row * (3 * w + 1)], bytearray(raw[row * (3 * w + 1) + 1:(row + 1) * (3 * w + 1)])
        for k in range(3 * w):
            a, b, c = line[k - 3] if k > 2 else 0, above[k], above[k - 3] if k > 2 else 0
            near = min((a, b, c), key=lambda v: abs(a + b - c - v))
            line[k] = (line[k] + (0, a, b, (a + b) // 2, near)[how]) % 256
        # Skin in any light has 1.2 times as much red as green, the inside 1.7 times.
        found += sum(line[k] > 1.45 * line[k + 1] for k in range(0, 3 * w, 3))
        above = line
    return found
assert dark_red(sys.argv[1]) == 0, dark_red(sys.argv[1])
assert dark_red(sys.argv[2]) > 10, dark_red(sys.argv[2])
CHECK
claim "an open mouth is dark inside, a closed one shows nothing of it"

printf 'Timecode,BlendShapeCount,JawOpen,MouthSmileLeft\n10:00:00:00,2,0.5,0\n10:00:00:01,0\n' >link.csv
expect_code 2 "no example stands for a shape of the motion" "$mimik" perform link.csv --examples face -o out3.glb
sed -i 's/^file = "open.ply"/&\narkit = ["jawOpen"]/' face/examples.toml
"$mimik" perform link.csv --examples face -o out3.glb --weights w3.csv --quiet >/dev/null
awk -F, 'NR == 2 { exit !($4 == 0.5) }' w3.csv || fail "$(cat w3.csv)"
claim "a telephone's weights drive the examples that stand for them"

expect_code 2 "motion.csv: frames 30 to 30 are not all in a motion of 24 frames" \
  "$mimik" perform motion.csv --examples face --neutral 30 -o out4.glb
expect_code 2 "out.mov: a performance is written as .glb, .mp4 or pictures in a folder" \
  "$mimik" perform motion.csv --examples face -o out.mov
expect_code 2 "smile=21: the face is lost there" "$mimik" perform motion.csv --examples face --key smile=21 -o out4.glb
expect_code 2 "take.csv: 'a,b' is no header of a motion" \
  bash -c 'echo a,b >take.csv && exec "$0" perform take.csv --examples face -o out4.glb' "$mimik"
[ ! -e out4.glb ] || fail "a file for nothing"
expect_code 2 "--rate is 10: motion.csv says its rate, 25 a second" \
  "$mimik" perform motion.csv --examples face -o out4.glb --rate 10
expect_code 2 "--outer-eye-mm is 90: it is for tables of pixels, and motion.csv is in millimetres" \
  "$mimik" perform motion.csv --examples face -o out4.glb --outer-eye-mm 90
expect_code 2 "--source-examples: is empty" "$mimik" perform motion.csv --examples face -o out4.glb --source-examples ""
[ ! -e out4.glb ] || fail "a file for nothing"
claim "what is wrong is named"

cp motion.csv kept.csv
cp -r face kept
expect_code 2 "--weights is './motion.csv', the same file as MOTION" \
  "$mimik" perform motion.csv --examples face -o out5.glb --weights ./motion.csv
expect_code 2 "--weights is 'w.txt'; it is written as .csv" \
  "$mimik" perform motion.csv --examples face -o out5.glb --weights w.txt
expect_code 2 "--weights is 'face/features.csv', the same file as --source-examples" \
  "$mimik" perform motion.csv --examples face --source-examples face/features.csv -o out5.glb --weights face/features.csv
expect_code 2 "--weights is 'face/features.csv', the same file as a file of face" \
  "$mimik" perform motion.csv --examples face -o out5.glb --weights face/features.csv
cmp motion.csv kept.csv && diff -r face kept && [ ! -e out5.glb ] || fail "something was written over"
claim "nothing is written over what is read"
