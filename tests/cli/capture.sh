#!/usr/bin/env bash
# capture.sh MIMIK FOLDER: a performance is rendered, captured and written; what is no video is refused by name.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

mkdir -p alone
cp "$mimik" alone/mimik
expect_code 2 "install libopencv-dev and opencv-data" alone/mimik capture take.mp4 -o motion.csv
rm -r alone
expect_code 2 "--output is 'motion.txt'; it is written as .csv" "$mimik" capture take.mp4 -o motion.txt
expect_code 2 "--neutral is '5'; give two frames A:B" "$mimik" capture take.mp4 -o motion.csv --neutral 5
echo "a take" >take.mp4
expect_code 2 "--video is './take.mp4', the same file as VIDEO" "$mimik" capture take.mp4 -o motion.csv --video ./take.mp4
expect_code 2 "--landmarks68 is 'x.csv', the same file as --output" "$mimik" capture take.mp4 -o x.csv --landmarks68 x.csv
[ "$(cat take.mp4)" = "a take" ] || fail "take.mp4 was written over"
rm take.mp4
expect_code 2 "--face is '3,x'; a pixel has two numbers" "$mimik" capture take.mp4 -o x.csv --face 3,x
expect_code 2 "--tracker is 'best'; there are paper, dlib and onnx" "$mimik" capture take.mp4 -o x.csv --tracker best
expect_code 2 "--tracker onnx: --model is missing" "$mimik" capture take.mp4 -o x.csv --tracker onnx
expect_code 2 "--model is 'a.onnx'; it goes with --tracker onnx" "$mimik" capture take.mp4 -o x.csv --model a.onnx
expect_code 2 "--colours: is empty; name a file, or leave it out" "$mimik" capture take.mp4 -o x.csv --colours ""
expect_code 2 "--neutral is '0:5000'; give two frames A:B with A <= B < 1000" \
  "$mimik" capture take.mp4 -o x.csv --neutral 0:5000
claim "without OpenCV's program it is said what to install, and options are checked before"

video=$(dirname "$mimik")/mimik-video
if [ ! -x "$video" ]; then
  echo "mimik-video is not built: the rest is left out"
  exit 0
fi
"$video" render -o made --frames 4 --fps 25 --width 480 --height 360 >/dev/null
[ "$(wc -l <made_points.csv)" = 5 ] || fail "made_points.csv: $(wc -l <made_points.csv) lines"
"$mimik" capture made.mp4 -o motion.csv --neutral 0:1 --landmarks68 points.csv --sheet sheet.png --video seen.mp4 --json >said.json
python3 - said.json <<'CHECK' || fail "$(cat said.json)"
import json, sys
d = json.load(open(sys.argv[1]))
assert d["schema"] == 1 and d["frames"] == 4 and d["tracked"] == 4 and d["rate_hz"] == 25, d
CHECK
[ "$(wc -l <motion.csv)" = 6 ] || fail "motion.csv: $(wc -l <motion.csv) lines"
[ "$(head -1 points.csv | cut -d, -f1-4)" = frame,detected,x0,y0 ] || fail "$(head -1 points.csv)"
[ "$(wc -l <points.csv)" = 5 ] || fail "points.csv: $(wc -l <points.csv) lines"
[ -s sheet.png ] && [ -s seen.mp4 ] || fail "no sheet or no video"
"$mimik" capture made.mp4 -o again.csv --neutral 0:1 --quiet
cmp motion.csv again.csv
claim "every frame has a row, and the same video gives the same bytes"

mkdir -p frames
cp sheet.png frames/frame_000000.png
cp sheet.png frames/frame_000001.png
"$video" write frames out.mp4 --fps 10 >/dev/null
[ -s out.mp4 ] || fail "no out.mp4"
[ -z "$("$video" write frames out.mp4 --fps 10 --quiet)" ] || fail "write --quiet speaks"
expect_code 2 "frames2: is no folder" "$video" write frames2 out.mp4
"$mimik" capture made.mp4 -o asked.csv --neutral 0:1 --face 240,170 --quiet
cmp motion.csv asked.csv || fail "the one face there is, asked for by its pixel, is another"
expect_code 2 "--face: x_px, y_px are 5000, 5000, and frames have 480 x 360 pixels" \
  "$mimik" capture made.mp4 -o far.csv --face 5000,5000
[ ! -e far.csv ] || fail "a table for nothing"
"$mimik" capture made.mp4 -o nobody.csv --neutral 0:1 --face 2 2>notes.txt >/dev/null
[ "$(grep -c ,lost, nobody.csv)" = 4 ] || fail "$(cut -c1-40 nobody.csv)"
claim "of several faces the one asked for is followed; one that is not there is lost"

"$video" write frames out2.mp4 --fps 10 --beside frames --performer made.mp4 --motion motion.csv --quiet
[ -s out2.mp4 ] || fail "no out2.mp4"
expect_code 2 "--motion is 'motion.csv'; it goes with --performer" "$video" write frames o.mp4 --motion motion.csv
claim "a folder of pictures is written as a video, beside others and the performer"

"$video" train made.mp4 made_points.csv -o colours.yml >/dev/null
"$mimik" capture made.mp4 -o own.csv --neutral 0:1 --colours colours.yml --quiet
expect_code 2 "not a colour network of Mimik" "$mimik" capture made.mp4 -o own.csv --colours made_points.csv
claim "a performer's own colours are learnt and used"

echo "no video" >text.mp4
head -c 2000 made.mp4 >cut.mp4
expect_code 2 "text.mp4: no frame can be decoded" "$mimik" capture text.mp4 -o o.csv
[ "$(wc -l <err.txt)" = 1 ] || { cat err.txt; fail "OpenCV speaks, too"; }
expect_code 2 "cut.mp4: no frame can be decoded" "$mimik" capture cut.mp4 -o o.csv
expect_code 2 "nowhere.mp4: there is no such file" "$mimik" capture nowhere.mp4 -o o.csv
expect_code 2 "camera 0: never ends" "$mimik" capture 0 -o o.csv
expect_code 2 "--tracker is 'best'" "$mimik" capture made.mp4 -o o.csv --tracker best
[ ! -e o.csv ] || fail "o.csv was left"
claim "what is no video is refused and leaves no table"
