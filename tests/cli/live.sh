#!/usr/bin/env bash
# live.sh MIMIK FOLDER: a video stands in for a camera, and a face moves as its performer does; no camera, no display.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"
unset DISPLAY

expect_code 2 "--output is 'out.avi'; it is written as .mp4" "$mimik" live 0 --examples face -o out.avi
expect_code 2 "--face is '0'; give the number of a face or a pixel" "$mimik" live 0 --examples face -o out.mp4 --face 0
expect_code 2 "--tracker onnx: --model is missing" "$mimik" live 0 --examples face -o out.mp4 --tracker onnx
video=$(dirname "$mimik")/mimik-video
if [ ! -x "$video" ]; then
  expect_code 2 "install libopencv-dev and opencv-data" "$mimik" live 0 --examples face -o out.mp4
  echo "mimik-video is not built: the rest is left out"
  exit 0
fi
echo "a net" >net.mp4
expect_code 2 "--output is './net.mp4', the same file as --model" \
  "$mimik" live 0 --examples face -o ./net.mp4 --tracker onnx --model net.mp4
expect_code 2 "--weights is 'face/features.csv', the same file as --source-examples" \
  "$mimik" live 0 --examples face -o out.mp4 --source-examples face/features.csv --weights face/features.csv
expect_code 2 "--output: is empty; name a file, or leave it out" "$mimik" live 0 --examples face -o ""
claim "options are checked before"

"$mimik" examples built-in -o face --example smile_left=12 --example mouth_a=27 --example brows_up=1+2 --quiet >/dev/null
"$video" render -o made --frames 12 --fps 10 --width 480 --height 360 >/dev/null
"$mimik" live made.mp4 --examples face -o out.mp4 --neutral 0:1 --json >said.json
python3 - said.json <<'CHECK' || fail "$(cat said.json)"
import json, sys
d = json.load(open(sys.argv[1]))
assert d["schema"] == 1 and d["frames"] == 12 and d["tracked"] == 12 and d["frames_a_second"] > 0, d
assert list(d["latency"]) == ["read", "track", "map", "blend", "draw", "show", "total"], d
for stage in d["latency"].values():
    assert 0 <= stage["median_ms"] <= stage["p95_ms"], d
CHECK
[ -s out.mp4 ] || fail "no out.mp4"
"$mimik" live made.mp4 --examples face -o few.mp4 --neutral 0:1 --frames 5 >said.txt
grep -q "few.mp4: 5 frames, the face in 5 of them; .* frames a second" said.txt || fail "$(cat said.txt)"
grep -q "^  total " said.txt || fail "$(cat said.txt)"
claim "frames, their rate and the latency of every stage are said"

# Live is capture and perform in one: the weights of both are the same, and the face moves. The rest is that of the
# frames 4 to 6 alone.
"$mimik" live made.mp4 --examples face -o moved.mp4 --neutral 4:6 --weights live.csv --quiet >/dev/null
"$mimik" capture made.mp4 -o late.csv --neutral 4:6 --quiet >/dev/null
"$mimik" perform late.csv --examples face --neutral 4:6 -o late.glb --weights late_weights.csv --quiet >/dev/null
python3 - live.csv late_weights.csv <<'CHECK' || fail "$(cat live.csv late_weights.csv)"
import csv, sys
live, late = (list(csv.DictReader(open(f))) for f in sys.argv[1:])
assert len(live) == len(late) == 12
assert all(float(row[name]) == 0 for row in live[:7] for name in ("smile_left", "mouth_a", "brows_up")), live
most = 0
for a, b in zip(live[7:], late[7:]):
    for name in ("smile_left", "mouth_a", "brows_up"):
        # late.csv has four decimals of a millimetre, examples move by some
        assert abs(float(a[name]) - float(b[name])) < 1e-3, (name, a, b)
        most = max(most, abs(float(a[name])))
assert most > 0.1, most
CHECK
"$mimik" live made.mp4 --examples face -o rest.mp4 --neutral 0:9 --frames 5 >said.txt 2>notes.txt
grep -qF "made.mp4: ended before the neutral frames did (--neutral 0:9), so the face did not move" notes.txt || fail "$(cat notes.txt)"
"$mimik" live made.mp4 --examples face -o nobody.mp4 --neutral 0:1 --frames 5 --face 2 >said.txt 2>notes.txt
grep -qF "made.mp4: no face was found in any frame" notes.txt || fail "$(cat notes.txt)"
expect_code 2 "--face: x_px, y_px are 480, 10, and frames have 480 x 360 pixels" \
  "$mimik" live made.mp4 --examples face -o o.mp4 --face 480,10
claim "the face moves as capture and perform say, and where it does not, that is said"

"$mimik" capture made.mp4 -o motion.csv --neutral 0:1 --quiet >/dev/null
"$mimik" perform motion.csv --examples face --neutral 0:1 -o beside.mp4 --video made.mp4 --beside face --size 200 --quiet >/dev/null
expect_size() {  # file width height frames
  "$video" look "$1" -o look.json
  python3 -c 'import json, sys; d = json.load(open("look.json")); assert [d["width"], d["height"], d["frames"]] == [int(v) for v in sys.argv[1:]], d' \
    "$2" "$3" "$4" || fail "$1: $(cat look.json)"
}
expect_size beside.mp4 666 200 12  # the performer's 480 x 360 at 200 rows, and two faces
"$mimik" perform motion.csv --examples face --neutral 0:1 -o beside.mp4 --video made.mp4 --quiet >/dev/null
expect_size beside.mp4 840 360 12  # as high as the clip
"$video" render -o short --frames 4 --fps 10 --width 480 --height 360 >/dev/null
expect_code 2 "--video short.mp4: ends at frame 4, before the performance of 12 frames" \
  "$mimik" perform motion.csv --examples face --neutral 0:1 -o o.mp4 --video short.mp4 --size 64
expect_code 2 "--video face: is a folder" "$mimik" perform motion.csv --examples face --neutral 0:1 -o o.mp4 --video face
expect_code 2 "--video 0: there is no such file" "$mimik" perform motion.csv --examples face --neutral 0:1 -o o.mp4 --video 0
head -c 2000 made.mp4 >cut.mp4
expect_code 2 "--video cut.mp4: cannot be read" "$mimik" perform motion.csv --examples face --neutral 0:1 -o o.mp4 --video cut.mp4
"$mimik" examples built-in -o jaw --example mouth_a=27 --quiet >/dev/null
"$mimik" perform motion.csv --examples face --beside jaw --neutral 0:1 -o two.mp4 --size 64 --weights two.csv >said.txt 2>notes.txt
grep -q "jaw: .*coordinates of features" notes.txt || fail "nothing of the second face: $(cat notes.txt)"
grep -q "two.csv: the weights of face, not of the faces beside it" notes.txt || fail "$(cat notes.txt)"
expect_code 2 "--video made.mp4: the performer stands beside the face in an .mp4 alone" \
  "$mimik" perform motion.csv --examples face -o o.glb --video made.mp4
expect_code 2 "--beside face: several faces stand in an .mp4 alone" \
  "$mimik" perform motion.csv --examples face -o o.glb --beside face
[ ! -e o.mp4 ] && [ ! -e o.glb ] || fail "a file for nothing"
claim "the performer stands beside the faces"

expect_code 2 "there is no display for a window (DISPLAY is not set); -o FILE.mp4 writes a video instead" \
  "$mimik" live made.mp4 --examples face
expect_code 2 "camera 7: gives no picture; is it connected" "$mimik" live 7 --examples face -o o.mp4 --frames 5
expect_code 2 "camera 7: gives no picture; is it connected" "$mimik" capture 7 -o o.csv --frames 5
expect_code 2 "camera 7: never ends, and a file has an end" "$mimik" live 7 --examples face -o o.mp4
expect_code 2 "nowhere.mp4: there is no such file, and no camera has that name" "$mimik" live nowhere.mp4 --examples face -o o.mp4
expect_code 2 "nobody" "$mimik" live made.mp4 --examples nobody -o o.mp4
echo "no net" >no.onnx
expect_code 2 "no.onnx: OpenCV" "$mimik" live made.mp4 --examples face -o o.mp4 --tracker onnx --model no.onnx
[ ! -e o.mp4 ] && [ ! -e o.csv ] || fail "a file for nothing"
claim "a camera that is not there, no display and a bad net are named"

if command -v xvfb-run >/dev/null && [ -e "$(dirname "$mimik")/../libexec/mimik/mimik-window.so" ]; then
  xvfb-run -a "$mimik" live made.mp4 --examples face --neutral 0:1 --frames 6 >said.txt 2>err.txt || fail "$(cat err.txt)"
  grep -q "made.mp4: 6 frames, the face in 6 of them" said.txt || fail "$(cat said.txt)"
  expect_code 2 "no window: the display does not open" env DISPLAY=:9876 "$mimik" live made.mp4 --examples face
  "$mimik" version >version.txt
  grep -q "^window_module .*mimik-window.so" version.txt || fail "$(cat version.txt)"
  "$video" render -o slow --frames 8 --fps 5 --width 480 --height 360 >/dev/null
  xvfb-run -a "$mimik" live slow.mp4 --examples face --neutral 0:1 --json >said.json 2>err.txt
  python3 - said.json <<'CHECK' || fail "$(cat said.json)"
import json, sys
d = json.load(open(sys.argv[1]))
# A file is shown as fast as it was taken, and the wait is no latency: to show a picture takes some milliseconds of 200.
assert d["frames_a_second"] < 5.5 and d["latency"]["show"]["median_ms"] < 60, d
CHECK
  claim "a window shows it where there is a display"
fi
