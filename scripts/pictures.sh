#!/usr/bin/env bash
# pictures.sh [--write]: draws every picture of README and docs anew, by Mimik's commands alone, of the 12 built-in people of
# seed 1, into out/pictures; all but lids.png, which is of a MakeHuman head (docs/algorithms/lids.md). Look at them beside
# those of docs/images; --write puts them there. Needs build/release and pngquant, which makes them small; MIMIK names
# another program than that of build/release.
set -euo pipefail
cd "$(dirname "$0")/.."
write=no
case "${1:-}" in
  '') ;;
  --write) write=yes ;;
  *) echo "pictures.sh: there is no option '$1'; give --write or nothing" >&2; exit 2 ;;
esac
mimik=${MIMIK:-$PWD/build/release/bin/mimik}
[ -x "$mimik" ] || { echo "pictures.sh: $mimik is missing; run scripts/test.sh or scripts/reproduce.sh first" >&2; exit 2; }
command -v pngquant >/dev/null || { echo "pictures.sh: pngquant is missing; apt-get install pngquant" >&2; exit 2; }
out=$PWD/out/pictures
rm -rf "$out"
mkdir -p "$out/made"
cd "$out"

"$mimik" synthesize db --subjects 12 --seed 1 --quiet >/dev/null
"$mimik" preprocess db -o work --quiet >/dev/null
scan() { echo "db/$1/$1_$2"; }         # subject, expression: without its extension
truth() { echo "db/truth/$1/$1_$2.ply"; }
face() { echo "work/faces/$1/$1_$2.ply"; }
draw() { "$mimik" figure -o "made/$1.png" --quiet "${@:2}" >/dev/null; }
animate() { "$mimik" animate work -o "$1" --quiet "${@:2}" >/dev/null; }
# Three numbers, a line each, behind a key: what JSON files of Mimik have. $1: the keys; the table is name,x,y,z.
marks() { awk -v wanted="$1" 'BEGIN { print "name,x,y,z" } /"(brow|eye|nose|mouth|upper|lower)_|"chin"/ && $0 ~ wanted {
  gsub(/[^a-z_]/, ""); row = $0; for (k = 0; k < 3; ++k) { getline; gsub(/[ ,]/, ""); row = row "," $0 } print row }' "$2"; }
# Points of a stored model of one kind: name,x,y,z, or as arrows x,y,z,to_x,to_y,to_z.
points() { awk -v wanted="$1" -v arrows="${3:-}" '
  BEGIN { print arrows ? "x,y,z,to_x,to_y,to_z" : "name,x,y,z" }
  function three(v, k) { for (k = 1; k <= 3; ++k) { getline; gsub(/[ ,]/, ""); v[k] = $0 } }
  /"points"/ { inside = 1 } !inside { next }
  /"displacement_mm"/ { three(d) } /"kind"/ { kind = $2; gsub(/[",]/, "", kind) }
  /"position_mm"/ { three(p); if (kind !~ wanted) next
    if (!arrows) print "p" ++n "," p[1] "," p[2] "," p[3]
    else print p[1] "," p[2] "," p[3] "," p[1] + d[1] "," p[2] + d[2] "," p[3] + d[3] }' "$2"; }
N=N_N_0 AU12=LFAU_12_0 AU4=UFAU_4_0

# README: as scripts/reproduce.sh draws it.
"$mimik" panels work --source bs000 --target bs001 --au 12 -o panels --quiet >/dev/null
panel=panels/AU12_bs000_on_bs001_default
# The same figure, of a size for a page.
sed -e 's/"panel_width_px": [0-9]*/"panel_width_px": 215/' -e 's/"panel_height_px": [0-9]*/"panel_height_px": 250/' \
  -e 's/"font_size_px": [0-9]*/"font_size_px": 13/' $panel/figure.json >$panel/page.json
"$mimik" figure -o made/au12.png --description $panel/page.json --quiet >/dev/null

draw builtin_face --columns 5 --size 220x290 --font-size 17 \
  "$(truth bs000 $N)" "$(truth bs001 $N)" "$(truth bs002 $N)" "$(truth bs002 $AU12)" "$(truth bs002 $AU4)" \
  --caption "one person" --caption another --caption "a third" --caption "the third: AU 12" --caption "the third: AU 4"

draw synthesis --columns 3 --size 330x390 "$(truth bs001 $AU12)" "$(scan bs001 $AU12).bnt" "$(scan bs001 $AU12).bnt" \
  --landmarks - --landmarks "$(scan bs001 $AU12).lm3" --landmarks - --texture - --texture - --texture "$(scan bs001 $AU12).png" \
  --caption "the truth" --caption "the scan, marked" --caption "with its photograph"

draw preprocessing --columns 4 --size 270x330 --font-size 17 "$(scan bs000 $N).bnt" "$(scan bs001 $N).bnt" "$(scan bs002 $N).bnt" \
  work/average/average_face.ply --landmarks "$(scan bs000 $N).lm3" --landmarks "$(scan bs001 $N).lm3" --landmarks "$(scan bs002 $N).lm3" --landmarks - \
  --caption "scan of one person" --caption "of another" --caption "of a third" --caption "average of 12"

cat >gridding.json <<END
{"schema": 1, "columns": 2, "panel_width_px": 400, "panel_height_px": 440, "panels": [
  {"mesh": "$(scan bs001 $AU12).bnt", "caption": "the scan: lattice of 0.77 mm, with holes"},
  {"mesh": "$(face bs001 $AU12)", "caption": "the grid: 150 x 150 vertices",
   "scalar": {"attribute": "origin", "label": "1 measured, 2 bridged", "range": [1, 2]}}]}
END
"$mimik" figure -o made/gridding.png --description gridding.json --quiet >/dev/null

# A warp of one face on to another's landmarks; those that closed lips lay upon others are no part of the panel's files.
"$mimik" warp --from $panel/source_landmarks.csv --to $panel/target_landmarks.csv $panel/source_neutral.ply -o warped.ply --quiet >/dev/null
draw thin_plate_spline --columns 3 --size 330x390 $panel/source_neutral.ply warped.ply $panel/target_neutral.ply \
  --landmarks $panel/source_landmarks.csv --landmarks $panel/target_landmarks.csv --landmarks $panel/target_landmarks.csv \
  --caption "one face" --caption "warped on to the landmarks of" --caption another

for m in 0 0.5 1 1.5; do animate m$m.ply --source mean --target bs001 --au 12:$m; done
animate two.ply --source mean --target bs001 --au 12L --au 1
draw animation --columns 5 --size 220x290 --font-size 17 m0.ply m0.5.ply m1.ply m1.5.ply two.ply \
  --caption "m = 0" --caption "m = 0.5" --caption "m = 1" --caption "m = 1.5" --caption "AU 12 left and AU 1"

"$mimik" panels work --source bs000 --target bs001 --au 12 --method thesis -o panels --quiet >/dev/null
"$mimik" panels work --source mean --target bs001 --au 12 -o panels --quiet >/dev/null
by_method=($panel/target_neutral.ply panels/AU12_bs000_on_bs001_thesis/target_animated.ply $panel/target_animated.ply
  panels/AU12_mean_on_bs001_default/target_animated.ply)
draw methods --columns 5 --size 220x290 --font-size 17 "${by_method[@]}" $panel/target_real.ply \
  --caption nothing --caption thesis --caption default --caption mean --caption "its own scan of it"
draw scoring --columns 4 --size 260x310 "${by_method[@]}" --scalar distance_mm --range 0 5 --label "distance to the scan, mm" \
  --caption nothing --caption thesis --caption default --caption mean

# Expressions of five others, put on the sixth by a template that was bent on to all.
"$mimik" synthesize jaw_db --subjects 6 --seed 1 --expressions 12,15,27 --quiet >/dev/null
"$mimik" preprocess jaw_db -o jaw_work --quiet >/dev/null
for au in 12 15 27; do
  "$mimik" animate jaw_work --target bs001 --au $au -o dense$au.ply --quiet >/dev/null
done
"$mimik" animate jaw_work --target bs001 --au 27 --method sparse -o sparse27.ply --quiet >/dev/null
draw dense --columns 5 --size 220x290 --font-size 17 $panel/target_neutral.ply dense12.ply dense15.ply dense27.ply sparse27.ply \
  --caption "neutral" --caption "AU 12" --caption "AU 15" --caption "AU 27" --caption "AU 27 by points"

"$mimik" distance $panel/target_animated.ply $panel/target_real.ply -o target_animated.vtp --quiet >/dev/null
"$mimik" distance $panel/target_real.ply $panel/target_animated.ply -o back.vtp --quiet >/dev/null
draw surface_distance --columns 2 --size 340x400 target_animated.vtp back.vtp --scalar distance_mm --range 0 4 --label "distance, mm" \
  --caption "animated face to scan" --caption "scan to animated face"

# A rendered performance and the curves that the tracker found.
video=$(dirname "$mimik")/mimik-video
[ -x "$video" ] || { echo "pictures.sh: $video is missing; run scripts/setup.sh --video, configure and build again" >&2; exit 2; }
"$video" render -o performance --frames 10 --fps 8 --seed 1 >/dev/null
"$video" track performance.mp4 -o performance.csv --neutral 0:1 --sheet made/video_capture.png --quiet >/dev/null

# The labels of one face on another one, by twelve points.
"$mimik" mocap synthesize take --seconds 0.1 --truth-every 0 --seed 1 --quiet >/dev/null
awk -F, 'NR == 1 || $1 ~ /^(forehead_high|eye_(outer|inner)_(left|right)|nose_tip|mouth_corner_(left|right)|lip_upper_middle|chin|jaw_outer_(left|right))$/' \
  take/target_markers.csv >twelve.csv
"$mimik" mocap fit take/source.ply take/target.ply --labels take/source_markers.csv --points twelve.csv -o fitted.csv --quiet >/dev/null
draw mesh_registration --columns 3 --size 330x390 take/source.ply take/target.ply take/target.ply \
  --landmarks take/source_markers.csv --landmarks twelve.csv --landmarks fitted.csv \
  --caption "the reference, with 76 labels" --caption "another face, with 12 points" --caption "its labels"

# Control points of the mean, with their displacements.
"$mimik" model work --source mean --expression 12,4,15 -o models --quiet >/dev/null
panels=
for au in 12 4 15; do
  markers=
  while read -r kind colour radius words; do
    points "^$kind$" models/mean/AU$au.json >AU${au}_$kind.csv
    markers+="${markers:+, }{\"file\": \"AU${au}_$kind.csv\", \"name\": \"$words\", \"colour\": \"$colour\", \"radius_mm\": $radius}"
  done <<<$'muscle #cc2020 2 muscle controls\nwrinkle #e09000 2 wrinkle controls\ncoverage #909090 1.2 coverage\nanchor #00a000 1.6 anchors'
  points . models/mean/AU$au.json arrows | awk -F, 'NR == 1 || ($1 - $4)^2 + ($2 - $5)^2 + ($3 - $6)^2 > 1' >AU${au}_moves.csv
  panels+="${panels:+, }{\"mesh\": \"work/average/average_face.ply\", \"caption\": \"AU $au\", \"arrows\": \"AU${au}_moves.csv\", \"markers\": [$markers]}"
done
echo "{\"schema\": 1, \"columns\": 3, \"panel_width_px\": 330, \"panel_height_px\": 420, \"legend\": true, \"panels\": [$panels]}" >controls.json
"$mimik" figure -o made/control_points.png --description controls.json --quiet >/dev/null

# The 22 landmarks on the mean of all people, who looks straight ahead.
still=(--amplitude-person 0 --asymmetry-person 0 --micro-expression 0 --pitch 0 --yaw 0 --roll 0 --translation 0)
"$mimik" synthesize mean_db --subjects 1 --expressions N --identity 0 "${still[@]}" --quiet >/dev/null
mean=mean_db/truth/bs000/bs000_$N
markers=
while read -r colour keys words; do
  marks "\"($keys)" $mean.json >"marks_${keys%%|*}.csv"
  markers+="${markers:+, }{\"file\": \"marks_${keys%%|*}.csv\", \"name\": \"$words\", \"colour\": \"$colour\", \"radius_mm\": 2}"
done <<'END'
#1f77b4 brow brow: outer, middle, inner
#2ca02c eye eye: outer, inner corner
#d62728 nose_saddle nose saddle
#ff9f1c nose_wing|nose_tip nose: wings, tip
#9467bd mouth|upper|lower mouth: corners, four on the lips
#000000 chin chin
END
echo "{\"schema\": 1, \"title\": \"The 22 landmarks on a synthetic (built-in) face\", \"columns\": 2, \"scale_bar_mm\": 50, \"legend\": true,
  \"panels\": [{\"mesh\": \"$mean.ply\", \"caption\": \"Front: the subject's left is right\", \"markers\": [$markers]},
  {\"mesh\": \"$mean.ply\", \"caption\": \"From the subject's left\", \"view\": \"three-quarter-left\", \"markers\": [$markers]}]}" >landmarks.json
"$mimik" figure -o made/landmarks.png --description landmarks.json --quiet >/dev/null

# Queries on a curve before the midline of the average face, and the nearest of its vertices, which lie 1 mm apart.
printf '%s\n' name,x,y,z a,0,0,0 b,90,0,0 c,0,90,0 d,0,0,90 e,90,90,90 >box.csv  # a warp that moves nothing: PLY to CSV
"$mimik" warp --from box.csv --to box.csv work/average/average_face.ply -o average.csv --quiet >/dev/null
awk -F, 'NR == 1 { next } { x[++n] = $2; y[n] = $3; z[n] = $4; if ($2 * $2 < 1) { if ($4 > front) front = $4; if ($3 > top) top = $3; if ($3 < low) low = $3 } }
  END { print "x,y,z,to_x,to_y,to_z"
    for (k = 0; k < 23; ++k) {
      qy = low + 10 + (top - low - 60) * k / 22; bend = (2 * k / 22 - 1)^2; qz = front + 25 - 14 * bend; best = 1e9
      for (i = 1; i <= n; ++i) { d = x[i]^2 + (y[i] - qy)^2 + (z[i] - qz)^2; if (d < best) { best = d; b = i } }
      print 0 "," qy "," qz "," x[b] "," y[b] "," z[b] } }' average.csv >closest.csv
awk -F, 'NR == 1 { print "name,x,y,z"; next } { print "q" NR "," $1 "," $2 "," $3 }' closest.csv >queries.csv
draw closest_point --columns 2 --size 400x440 work/average/average_face.ply work/average/average_face.ply --arrows closest.csv \
  --landmarks queries.csv --view left --view three-quarter-left --caption "queries and their closest points" --caption "the same, turned"

# A dot for every case of AU 12, by method, from the rows of an experiment.
"$mimik" evaluate work --expression 12 -o scores --quiet >/dev/null
dots=scores/cases.csv
awk -F, '
  function at(value) { return 347.1 + 392.9 * value }
  BEGIN { n = split("thesis default mean true-field true-field-mean", order, " ")
    split("thesis|default|mean|true field, one source|true field, mean", title, "|")
    print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 760 300\" width=\"760\" height=\"300\" font-family=\"DejaVu Sans, Arial, sans-serif\" font-size=\"14\">"
    print "<rect width=\"760\" height=\"300\" fill=\"#ffffff\"/>"
    for (v = -0.4; v < 1.05; v += 0.2) {
      printf "<line x1=\"%.1f\" y1=\"24\" x2=\"%.1f\" y2=\"236\" stroke=\"%s\"/>\n", at(v), at(v), v * v < 1e-6 ? "#888888" : "#e0e0e0"
      printf "<text x=\"%.1f\" y=\"256\" text-anchor=\"middle\" fill=\"#333333\">%.1f</text>\n", at(v), v + 1e-9 } }
  $6 == "surface_distance" && $7 == "zone" && $8 == "mean" { if ($4 == "nothing") nothing[$2] = $9; else { m = $4; value[m, ++count[m]] = $9; target[m, count[m]] = $2 } }
  END {
    for (k = 1; k <= n; ++k) {
      m = order[k]; y = 48 + 42 * (k - 1)
      printf "<text x=\"176\" y=\"%d\" text-anchor=\"end\" fill=\"#111111\">%s</text>\n", y + 5, title[k]
      for (i = 1; i <= count[m]; ++i) {
        e = 1 - value[m, i] / nothing[target[m, i]]; sorted[i] = e; if (e < -0.4) e = -0.4
        printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"#1f77b4\" fill-opacity=\"0.35\"/>\n", at(e), y - 12 + (i * 7) % 25 }
      for (i = 1; i <= count[m]; ++i) for (j = i + 1; j <= count[m]; ++j) if (sorted[j] < sorted[i]) { s = sorted[i]; sorted[i] = sorted[j]; sorted[j] = s }
      if (count[m]) printf "<line x1=\"%.1f\" y1=\"%d\" x2=\"%.1f\" y2=\"%d\" stroke=\"#d62728\" stroke-width=\"3\"/>\n", at(sorted[int((count[m] + 1) / 2)]), y - 16, at(sorted[int((count[m] + 1) / 2)]), y + 16 }
    print "<text x=\"465\" y=\"282\" text-anchor=\"middle\" fill=\"#333333\">explained fraction of each case (0: doing nothing, 1: perfect)</text>"
    print "</svg>" }' "$dots" >made/evaluation_rows.svg

# Five people as sources and targets, and what each pair weighs in a sample that drew them 2, 0, 1, 1 and 1 times.
awk 'BEGIN { n = split("A B C D E", who, " "); split("2 0 1 1 1", drawn, " ")
  split("#f2f2f2 #9ecae1 #4292c6 #08519c", colour, " ")
  print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 470 350\" width=\"470\" height=\"350\" font-family=\"DejaVu Sans, Arial, sans-serif\" font-size=\"14\" text-anchor=\"middle\">"
  print "<rect width=\"470\" height=\"350\" fill=\"#ffffff\"/>"
  print "<text x=\"285\" y=\"22\" fill=\"#333333\">target, and how often it was drawn</text>"
  print "<text transform=\"translate(24 200) rotate(-90)\" fill=\"#333333\">source</text>"
  for (i = 1; i <= n; ++i) {
    printf "<text x=\"%d\" y=\"48\" fill=\"#111111\">%s: %d</text>\n<text x=\"76\" y=\"%d\" fill=\"#111111\">%s: %d</text>\n", 75 + 70 * i, who[i], drawn[i], 40 + 53 * i, who[i], drawn[i]
    for (j = 1; j <= n; ++j) {
      w = drawn[i] * drawn[j]
      if (i == j) printf "<rect x=\"%d\" y=\"%d\" width=\"66\" height=\"49\" fill=\"none\" stroke=\"#dddddd\"/>\n", 42 + 70 * j, 10 + 53 * i
      else printf "<rect x=\"%d\" y=\"%d\" width=\"66\" height=\"49\" fill=\"%s\"/>\n<text x=\"%d\" y=\"%d\" fill=\"%s\">%d</text>\n", 42 + 70 * j, 10 + 53 * i, colour[w + 1], 75 + 70 * j, 40 + 53 * i, (w > 1 ? "#ffffff" : "#111111"), w } }
  print "<text x=\"285\" y=\"343\" fill=\"#333333\">what a pair weighs: both counts multiplied</text>"
  print "</svg>" }' >made/statistics.svg

"$mimik" figures work wrinkle-nasolabial -o named --quiet >/dev/null
cp named/wrinkle-nasolabial.svg made/wrinkle_nasolabial.svg
# The weights of three examples and of a face at rest on a line: hyperplanes, and what bells make of them.
awk '
  function bell(x) { x = x < 0 ? -x : x; return x >= 2 ? 0 : x >= 1 ? (2 - x) ^ 3 / 6 : 2 / 3 - x * x + x ^ 3 / 2 }
  function at_x(p) { return 60 + 128 * (p + 2.1) }
  function at_y(w) { return 216 - 140 * w }
  function line(i, p) { return mean[i] + slope[i] * (p - middle) }
  function weight(i, p,   j, w) { w = line(i, p); for (j = 1; j <= 4; ++j) w += r[j, i] * bell((p - c[j]) / width[j]); return w }
  BEGIN {
    split("-1.4 0.9 1.9 0", c, " "); split("frown smile laugh rest", name, " "); split("#1f77b4 #d62728 #2ca02c #888888", colour, " ")
    for (j = 1; j <= 4; ++j) { middle += c[j] / 4
      for (k = 1; k <= 4; ++k) { d = c[j] - c[k]; d = d < 0 ? -d : d; if (j != k && (!(j in width) || d < width[j])) width[j] = d } }
    for (j = 1; j <= 4; ++j) spread += (c[j] - middle) ^ 2
    for (i = 1; i <= 3; ++i) { mean[i] = 1 / 4; slope[i] = (c[i] - middle) / spread
      for (j = 1; j <= 4; ++j) { b[j] = (i == j) - line(i, c[j]); for (k = 1; k <= 4; ++k) m[j, k] = bell((c[j] - c[k]) / width[k]) }
      for (k = 1; k <= 4; ++k) for (j = 1; j <= 4; ++j) if (j != k) { f = m[j, k] / m[k, k]; b[j] -= f * b[k]; for (l = 1; l <= 4; ++l) m[j, l] -= f * m[k, l] }
      for (k = 1; k <= 4; ++k) r[k, i] = b[k] / m[k, k] }
    print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 720 330\" width=\"720\" height=\"330\" font-family=\"DejaVu Sans, Arial, sans-serif\" font-size=\"14\" text-anchor=\"middle\">"
    print "<rect width=\"720\" height=\"330\" fill=\"#ffffff\"/>"
    for (w = 0; w <= 1; ++w) { printf "<line x1=\"60\" y1=\"%d\" x2=\"680\" y2=\"%d\" stroke=\"#d0d0d0\"/>\n<text x=\"42\" y=\"%d\" fill=\"#333333\">%d</text>\n", at_y(w), at_y(w), at_y(w) + 5, w }
    for (j = 1; j <= 4; ++j) { printf "<line x1=\"%.1f\" y1=\"40\" x2=\"%.1f\" y2=\"272\" stroke=\"%s\" stroke-dasharray=\"2 4\"/>\n<text x=\"%.1f\" y=\"292\" fill=\"%s\">%s</text>\n", at_x(c[j]), at_x(c[j]), colour[j], at_x(c[j]), colour[j], name[j] }
    for (i = 1; i <= 3; ++i) {
      printf "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" stroke-dasharray=\"7 5\"/>\n<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"2.5\" points=\"", at_x(-2.1), at_y(line(i, -2.1)), at_x(2.7), at_y(line(i, 2.7)), colour[i], colour[i]
      for (p = -2.1; p < 2.705; p += 0.05) printf "%.1f,%.1f ", at_x(p), at_y(weight(i, p))
      print "\"/>"
      for (j = 1; j <= 4; ++j) printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%s\" fill=\"%s\"/>\n", at_x(c[j]), at_y(weight(i, c[j])), i == j ? 5 : 3, colour[i] }
    print "<text x=\"370\" y=\"318\" fill=\"#333333\">place in the parameter space: a performer on the way from frown to laugh</text>"
    print "<text transform=\"translate(20 146) rotate(-90)\" fill=\"#333333\">weight</text>"
    print "</svg>" }' >made/expression_mapping.svg

# Planar bones: the control surface of a recording, and the face that it moves.
"$mimik" mocap synthesize take --seconds 2.25 --rate 20 --truth-every 0 --quiet >/dev/null
"$mimik" mocap animate take/recording_b.c3d --jig jig_1,jig_2,jig_3,jig_4,jig_5,jig_6,jig_7 --target take/target.ply \
  --landmarks take/target_landmarks.csv --method bones -o take/bones.glb --components 1 --every 45 \
  --sheet made/planar_bones.png --panels 4 --quiet >/dev/null

for picture in made/*.png; do pngquant --force --ext .png --nofs --speed 1 256 "$picture"; done
cd - >/dev/null
for picture in docs/images/*; do
  [ "$(basename "$picture")" != lids.png ] || continue
  [ -s "$out/made/$(basename "$picture")" ] || { echo "pictures.sh: nothing draws $picture; add it" >&2; exit 1; }
done
for picture in "$out"/made/*; do
  [ "$(stat -c %s "$picture")" -lt 200000 ] || { echo "pictures.sh: $picture has more than 200 kB" >&2; exit 1; }
done
[ $write = no ] || cp "$out"/made/* docs/images/
echo "$out/made"
