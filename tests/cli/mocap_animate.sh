#!/usr/bin/env bash
# mocap_animate.sh MIMIK FOLDER: a recording with a truth is made and put on faces.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

"$mimik" mocap synthesize take --seconds 1 --rate 30 --truth-every 15 >made.txt
grep -q '68 markers and a jig of 7' made.txt || fail "$(cat made.txt)"
"$mimik" mocap info take/recording_b.c3d --json >info.json
python3 - info.json <<'CHECK' || fail "the recording"
import json, sys
d = json.load(open(sys.argv[1]))
assert d["points"] == 75 and d["rate_hz"] == 30 and d["frames"] == 30, d
CHECK
"$mimik" mocap synthesize again --seconds 1 --rate 30 --truth-every 0 --quiet >/dev/null
cmp take/recording_b.c3d again/recording_b.c3d
claim "a recording is made, alike for one seed"

jig=jig_1,jig_2,jig_3,jig_4,jig_5,jig_6,jig_7
on_source=(--target take/source.ply --landmarks take/source_landmarks.csv --markers take/source_markers.csv)
measure() {  # method
  "$mimik" mocap animate take/recording_b.c3d --jig $jig "${on_source[@]}" --method "$1" -o "frames_$1" --every 15 \
    --format ply --truth take/truth_b_source --json >"$1.json"
}
for method in still nearest bones; do measure $method; done
python3 - <<'CHECK' || fail "the errors"
import json
error = {m: json.load(open(m + ".json"))["truth"]["mean_mm"] for m in ("still", "nearest", "bones")}
assert error["bones"] < error["still"], error
assert error["bones"] < error["nearest"], error
CHECK
[ "$(ls frames_bones)" = $'frame_000001.ply\nframe_000016.ply' ] || fail "$(ls frames_bones)"
claim "planar bones are nearer to the truth than nothing and the nearest marker"

"$mimik" mocap animate take/recording_b.c3d --jig $jig --target take/target.ply --landmarks take/target_landmarks.csv \
  --method open-bones -o talk.glb --components 4 >glb.txt
grep -q 'no vertex is more than .* mm off in any frame' glb.txt || fail "$(cat glb.txt)"
[ "$(head -c 4 talk.glb)" = glTF ] || fail "no GLB"
claim "another face, placed by landmarks alone, talks in one file"

"$mimik" mocap animate take/recording_b.c3d --jig $jig "${on_source[@]}" --method units -o weights.csv >weights.txt
grep -q '30 rows, .* of the 61 channels of Live Link Face' weights.txt || fail "$(cat weights.txt)"
python3 - <<'CHECK' || fail "the weights"
import csv
rows = list(csv.DictReader(open("weights.csv")))
assert len(rows) == 30 and all(r["BlendShapeCount"] == "61" for r in rows)
assert rows[0]["Timecode"] == "00:00:00:00.000" and rows[29]["Timecode"] == "00:00:00:29.000"
values = [float(v) for r in rows for k, v in r.items() if k not in ("Timecode", "BlendShapeCount")]
assert min(values) >= 0 and max(values) <= 1
assert max(float(r["JawOpen"]) for r in rows) > 0.2  # who speaks opens the mouth
CHECK
claim "the strengths of AUs are written as Live Link Face writes them"

expect_code 2 "--method bones does not" "$mimik" mocap animate take/recording_b.c3d "${on_source[@]}" --method bones -o o.csv
expect_code 2 "there are: still, nearest" "$mimik" mocap animate take/recording_b.c3d "${on_source[@]}" --method tps -o o
expect_code 2 "--landmarks: is missing" "$mimik" mocap animate take/recording_b.c3d --target take/source.ply -o o
expect_code 2 "give a folder (no extension), a .glb, a .mp4 or a .csv" "$mimik" mocap animate take/recording_b.c3d "${on_source[@]}" -o o.fbx
[ ! -e o ] && [ ! -e o.csv ] || fail "written all the same"
claim "what there is not is named, and nothing is written"
