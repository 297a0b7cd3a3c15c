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
claim "options are checked before"

"$mimik" examples built-in -o face --example smile=12 --example open=27 --example brows_up=1+2 --quiet >/dev/null
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

"$mimik" capture made.mp4 -o motion.csv --neutral 0:1 --quiet >/dev/null
"$mimik" perform motion.csv --examples face --neutral 0:1 -o beside.mp4 --video made.mp4 --beside face --size 200 --quiet >/dev/null
[ -s beside.mp4 ] || fail "no beside.mp4"
"$video" track beside.mp4 -o again.csv --neutral 0:1 --face 1 --quiet >/dev/null
[ "$(wc -l <again.csv)" = 14 ] || fail "beside.mp4 has not 12 frames: $(wc -l <again.csv) lines"
"$video" render -o short --frames 4 --fps 10 --width 480 --height 360 >/dev/null
expect_code 2 "short.mp4: ends at frame 4, before the performance" \
  "$mimik" perform motion.csv --examples face --neutral 0:1 -o o.mp4 --video short.mp4 --size 64
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
  claim "a window shows it where there is a display"
fi
