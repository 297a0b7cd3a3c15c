#!/usr/bin/env bash
# end_to_end.sh MIMIK FOLDER: the whole way of a user, with three built-in subjects; every claim is checked, the first that
# fails ends it.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

# Seed 5 has closed lips whose two inner landmarks share a vertex: once that stopped a whole database.
for threads in 1 2; do
  "$mimik" synthesize "db$threads" --subjects 3 --expressions 4,12,12L --seed 5 --threads "$threads" --quiet
  "$mimik" preprocess db1 -o "work$threads" --threads "$threads" >out.txt 2>remarks.txt
  "$mimik" evaluate "work$threads" --expression 4,12,12L --threads "$threads" --json --quiet >"scores$threads.json"
  "$mimik" animate "work$threads" --source mean --target bs001 --au 12L --au 4:0.5 -o "face$threads.glb" --threads "$threads" --quiet
done
diff -r db1 db2
claim "a database is the same on 1 thread and on 2"
diff -r work1 work2
claim "so is a workspace"
cmp scores1.json scores2.json
claim "so are the scores"
cmp face1.glb face2.glb
claim "so is an animated face"

[ "$(grep -c ' closed lips, both inner marks on one grid vertex' remarks.txt)" -eq 1 ] && ! grep -q '^note: ' remarks.txt || { cat remarks.txt; fail "remarks"; }
claim "closed lips are one line for all scans"

"$mimik" preprocess db1 -o work1 --json >again.json
grep -q '"preprocessed": 0' again.json
claim "a second run finds everything done"

"$mimik" animate work1 --source bs000 --target bs001 --au 12L,4:0.5 -o face.glb --quiet
"$mimik" animate work1 --source bs000 --target bs001 --au AU12_L --au au4:0.5 -o named.glb --quiet
cmp face.glb named.glb
"$mimik" panels work1 --source bs000 --target bs001 --au AU12_L -o panels --dry-run | grep -q "AU12_L_bs000_on_bs001"
"$mimik" model work1 --source BS000 --au AU12_L -o typed --quiet >/dev/null
[ -s typed/bs000/AU12_L.json ]
"$mimik" preprocess db1 -o x --au au12_l --dry-run --quiet | grep -q '^9 scans'
"$mimik" evaluate work1 --au au12_l --dry-run --quiet >/dev/null
"$mimik" synthesize x --expressions 4,12,12L --dry-run --quiet >plan.txt
"$mimik" synthesize x --expressions au4,AU12,au12_l --dry-run --quiet | cut -d, -f1 | diff <(cut -d, -f1 plan.txt) -
"$mimik" scans db1 --au AU12 --side left --no-catalogue 2>/dev/null | grep -q ': 3 scans of 3 subjects'
expect_code 2 $'--au is \'12L\'\n--side' "$mimik" scans db1 --au 12L
claim "an expression may be typed in every way in which it is written"
"$mimik" animate work1 --source BS000 --target Bs001 --au 12L,4:0.5 -o face2.glb --quiet
cmp face.glb face2.glb
"$mimik" panels work1 --source BS000 --target BS001 --au 12 -o panels --dry-run | grep -q "AU12_bs000_on_bs001"
expect_code 2 "'BS077'" "$mimik" animate work1 --target BS077 --au 12 -o nothing.ply
expect_code 2 "no subject bs077, Bs078;" "$mimik" preprocess db1 -o x --subject bs077,bs000,Bs078
claim "subjects are found in capitals too, and one that is not there is named as it was typed"

"$mimik" model work1 --source bs000 --expression 12 -o models --quiet
"$mimik" animate work1 --source bs000 --target bs001 --au 12:0.5 -o measured.glb --quiet
"$mimik" animate work1 --target bs001 --model models/bs000/AU12.json:0.5 -o stored.glb --quiet
cmp measured.glb stored.glb
expect_code 2 "scores1.json: is no expression model; give a file of 'mimik model'" "$mimik" animate work1 --target bs001 --model scores1.json -o nothing.ply
expect_code 2 "nothing to animate" "$mimik" animate work1 --target bs001 -o nothing.ply
"$mimik" model work1 --source bs000 --expression 12 --quiet
cmp models/bs000/AU12.json work1/models/default/bs000/AU12.json
"$mimik" model work1 --source bs000 --expression 12 --kernel r2logr --no-anchors --quiet
cmp models/bs000/AU12.json work1/models/default/bs000/AU12.json
other=work1/models/default_r2logr_no-anchors/bs000/AU12.json
grep -q '"kernel": "r2logr"' "$other" && grep -q '"anchors": false' "$other" && grep -q '"mimik"' "$other"
"$mimik" animate work1 --target bs001 --model "$other" -o stored.glb >out.txt 2>err.txt
grep -q "kernel r2logr, here r" err.txt
"$mimik" animate work1 --target bs001 --model models/bs000/AU12.json -o stored.glb >out.txt 2>err.txt
grep -qF "made otherwise" err.txt && fail "a difference where there is none"
expect_code 3 "AU12 at magnitude 1e+300" "$mimik" animate work1 --source bs000 --target bs001 --au 12:1e300 -o nothing.ply
[ ! -e nothing.ply ]
claim "a stored model says how it was made, keeps its file from others, and animates as the one that is measured does"

for extension in ply obj vtp; do
  "$mimik" animate work1 --source bs000 --target bs001 --au 12 --method thesis -o "face.$extension" --quiet
  [ -s "face.$extension" ]
done
for command in "model work1 -o thesis_models" "animate work1 --target bs001 --au 12 -o nothing.ply" \
               "panels work1 --target bs001 --au 12 -o nothing" "panels work1 --target bs001 --au 12 -o nothing --dry-run"; do
  expect_code 2 $'the thesis method has no mean\nbs000' "$mimik" $command --method thesis
done
[ ! -e thesis_models ] && [ ! -e nothing.ply ] && [ ! -e nothing ]
claim "the thesis has no mean, and that is said before any work"

"$mimik" animate work1 --source bs000 --target bs001 --au 12 --keep-bridged -o kept.obj --json >kept.json
grep -q '"vertex_values": "kept_vertices.csv"' kept.json && grep -q 'are in kept_vertices.csv' kept.json || fail "no word of the table"
[ "$(head -n 1 kept_vertices.csv)" = vertex,displacement_mm_x,displacement_mm_y,displacement_mm_z,origin ] || fail "columns"
[ "$(tail -n +2 kept_vertices.csv | wc -l)" -eq "$(grep -c '^v ' kept.obj)" ] || fail "rows"
grep -q ',1$' kept_vertices.csv && grep -q ',2$' kept_vertices.csv || fail "bridged vertices are not marked"
"$mimik" animate work1 --source bs000 --target bs001 --au 12 --keep-bridged -o kept.glb --quiet
grep -qa '"_ORIGIN"' kept.glb && grep -qa '"_DISPLACEMENT_MM"' kept.glb || fail "GLB without values per vertex"
claim "every format says how each vertex moved and which were bridged, an OBJ in the table beside it"

largest() { sed -n 's/^ *"largest_displacement_mm": \(.*\),/\1/p' "$1" | tail -n 1; }
for frame in scanner average; do
  "$mimik" animate work1 --source bs000 --target bs001 --au 12 --frame $frame --keep-bridged -o frame.ply --json >$frame.json
  "$mimik" animate work1 --source bs000 --target bs001 --au 12:0 --frame $frame --keep-bridged -o frame0.ply --quiet
done
[ "$(largest scanner.json)" != "$(largest average.json)" ]
claim "lengths in the result are those of the frame that is written"

"$mimik" synthesize lips --subjects 2 --expressions 1,12,27 --seed 5 --quiet  # the inner lips of bs001 are 0.7 mm apart
"$mimik" preprocess lips -o lips_work --quiet
for unit in 1 12 27; do
  "$mimik" animate lips_work --source bs000 --target bs001 --au $unit -o lips.ply --json >lips$unit.json
done
grep -q '"AU27 pulls the lips apart, but those of bs001_N_N_0 are closed' lips27.json || fail "no word of closed lips"
expect_code 0 "note: AU27 pulls the lips apart" "$mimik" animate lips_work --source bs000 --target bs001 --au 27 -o lips.ply
! grep -q 'lips apart' lips1.json lips12.json || fail "a note on lips that stay together"
claim "who opens a closed mouth is told that it stays one piece, and nobody else"

"$mimik" regions work1 --quiet >/dev/null
"$mimik" regions work1 --quiet >/dev/null
"$mimik" animate work1 --source bs000 --target bs001 --au 12 --hold nose -o drawn/face.ply --quiet
sed -i 's/,nose$/,mine/' work1/average/regions.csv
"$mimik" animate work1 --source bs000 --target bs001 --au 12 --hold mine -o edited/face.ply --quiet
cmp drawn/face.ply edited/face.ply
expect_code 2 $'regions.csv\n--force' "$mimik" regions work1
grep -q ',mine$' work1/average/regions.csv
sed '1s/average face .*/average face 0123456789abcdef/' work1/average/regions.csv >other.csv
expect_code 2 "0123456789abcdef" "$mimik" animate work1 --target bs001 --au 12 --hold mine --regions other.csv -o nothing.ply
expect_code 2 "--hold" "$mimik" animate work1 --target bs001 --au 12 --regions other.csv -o nothing.ply
[ ! -e nothing.ply ]
"$mimik" regions work1 --force --quiet >/dev/null
expect_code 2 "'mine'" "$mimik" animate work1 --target bs001 --au 12 --hold mine -o nothing.ply
claim "edited regions are used where they lie, kept, and refused of another face"

"$mimik" animate work1 --source bs000 --target bs001 --au 12:0 -o neutral.ply --quiet
"$mimik" distance neutral.ply neutral.ply --json | awk '/"max"/ { sub(/.*: /, ""); if ($0 + 0 > 1e-6) exit 1 }'
claim "a face is nowhere off itself"  # a vertex that no polygon uses would be
"$mimik" distance face.ply neutral.ply --json >distance.json
grep -q '"units": "mm"' distance.json
claim "faces are written in every format and can be measured"

# What comes out of the drawing program needs a way to draw; what goes in does not.
can_draw=yes
"$mimik" figure -o probe.png neutral.ply --size 40x40 --quiet 2>/dev/null || can_draw=no
mkdir alone
cp "$mimik" alone/mimik
"$mimik" panels work1 --source bs000 --target bs001 --au 4,12L -o panels --dry-run >planned.txt
diff <(head -n 2 planned.txt) - <<'END'
panels/AU4_bs000_on_bs001_default.png
panels/AU12_L_bs000_on_bs001_default.png
END
grep -q '^2 pictures of 20 panels: about [0-9]* s, [0-9]* MB in panels$' planned.txt
[ ! -e panels ]
claim "panels can be listed before they are made"
expect_code 1 "mimik-figure is neither" env PATH=nowhere alone/mimik panels work1 --source bs000 --target bs001 --au 12 -o panels
for name in source_neutral source_animated source_real target_neutral target_animated target_real; do
  [ -s "panels/AU12_bs000_on_bs001_default/$name.ply" ]
done
claim "without the drawing program the faces of the panels are there and 1 says that the picture is not"
if [ "$can_draw" = yes ]; then
  "$mimik" panels work1 --source mean --target bs001 --au 4 --method default -o panels --quiet
  "$mimik" panels work1 --source bs000 --target bs001 --au 12 --method thesis -o panels --quiet
  "$mimik" panels work1 --source bs000 --target bs001 --au 4,12 --series 0,1 -o panels --quiet
  for name in AU4_mean_on_bs001_default AU12_bs000_on_bs001_thesis AU4_AU12_series_bs000_on_bs001_default; do
    [ "$(head -c 4 "panels/$name.png" | tail -c 3)" = PNG ]
  done
  expect_code 2 "neutral.ply: the mesh has no attribute 'nope'; it has: " "$mimik" figure neutral.ply --scalar nope -o nothing.png
  expect_code 2 "give one of front, left, right, three-quarter-left, three-quarter-right" "$mimik" figure neutral.ply --view back -o nothing.png
  ! grep -q 'three-quarter$' err.txt
  claim "panels of one source, of a mean, of the thesis and of a series are drawn"
fi
expect_code 2 "stand in --series" "$mimik" panels work1 --target bs001 --au 12:0.5 --series 0,1 -o nothing
expect_code 2 "bs000, bs001, bs002" "$mimik" panels work1 --target bs009 --au 12 -o nothing
expect_code 2 "no scan of expression '17'" "$mimik" panels work1 --source bs000 --target bs001 --au 17 -o nothing
[ ! -e nothing ]
expect_code 2 "magnitude -1" "$mimik" panels work1 --source bs000 --target bs001 --au 12 --series 0,-1 -o nothing --dry-run
expect_code 2 "magnitude nan" "$mimik" panels work1 --source bs000 --target bs001 --au 12 --series 2,nan -o nothing
expect_code 2 "no other subject shows expression '15'" "$mimik" panels work1 --source mean --target bs001 --au 15 -o nothing --dry-run
[ ! -e nothing ]
expect_code 2 "asked for twice" "$mimik" panels work1 --source bs000 --target bs001 --au 12,AU12 -o nothing
claim "panels that cannot be are refused by name"

cp -r work1 work3
echo '{}' >work3/faces/bs001/bs001_UFAU_4_0.json
expect_code 1 "AU4_bs000_on_bs001_default: " "$mimik" panels work3 --source bs000 --target bs001 --au 4,12 -o panels3 --quiet
[ -s panels3/AU12_bs000_on_bs001_default/figure.json ]
claim "an AU that cannot be shown is named with 1, and the others are"
echo '{}' >work3/faces/bs000/bs000_LFAU_12_0.json
for command in "animate work3 --au 12 -o mean3.ply" "panels work3 --au 12 --source mean -o panels3"; do
  expect_code 1 $'left out of the mean\nbs000_LFAU_12_0' "$mimik" $command --target bs001 --quiet
done
expect_code 1 $'left out of the mean\nbs000_LFAU_12_0' "$mimik" model work3 --expression 12 --quiet
code=0
"$mimik" animate work3 --target bs001 --au 12 -o mean3.ply --json >mean3.json 2>/dev/null || code=$?
[ "$code" -eq 1 ] && grep -A1 '"failures": \[' mean3.json | grep -q bs000_LFAU_12_0
[ -s mean3.ply ]
claim "a scan that a mean cannot use is a failure (1), and the mean is of the others"

code=0
PATH=nowhere alone/mimik preprocess db1 -o work2 --sheets --quiet >out.txt 2>err.txt || code=$?
[ "$code" -eq 1 ] && [ "$(grep -c 'mimik-figure is neither' err.txt)" -eq 1 ] && [ ! -e work2/sheets ]
"$mimik" evaluate work2 --expression 12 --dry-run --quiet >/dev/null
claim "a missing drawing program is said once, with 1, and the workspace is whole"
if [ "$can_draw" = yes ]; then
  "$mimik" preprocess db1 -o work2 --sheets --json >sheets.json
  grep -q '"drawn": 3' sheets.json
  [ "$(head -c 4 work2/sheets/bs001.png | tail -c 3)" = PNG ]
  "$mimik" preprocess db1 -o work2 --sheets --json >sheets.json
  grep -q '"drawn": 0' sheets.json && grep -q '"failures": \[\]' sheets.json
  claim "quality sheets are drawn once"
fi

"$mimik" scans db1 --json --no-catalogue >scans.json
grep -q '"schema"' scans.json
"$mimik" scans db1 --check --no-catalogue >check.txt 2>remarks.txt
! grep -q warning check.txt && grep -q '0 of 15 scans have errors' check.txt || { cat check.txt; fail "warnings"; }
! grep -v "^checking: " remarks.txt || fail "remarks"
claim "the doctor has neither a warning nor a remark on a synthetic database"
expect_code 2 "AU99 is not in the catalogue; there are: 1, 2" "$mimik" animate work1 --target bs001 --au 99 -o x.ply
expect_code 2 "no scan of expression '17'" "$mimik" animate work1 --source bs000 --target bs001 --au 17 -o x.ply
expect_code 2 "asked for twice" "$mimik" evaluate work1 --expression 12,AU12
expect_code 2 "--method: 'thesis' is asked for twice" "$mimik" evaluate work1 --expression 12 --method thesis,mean,thesis
expect_code 2 "--source: 'bs000' is asked for twice" "$mimik" model work1 --source bs000,BS000 --expression 12 -o x
expect_code 2 "--expression: '12' is asked for twice" "$mimik" model work1 --source bs000 --expression 12,AU12 -o x
expect_code 2 "AU99 is not in the catalogue" "$mimik" model work1 --source bs000 --expression 12,99 -o x
expect_code 2 "bs000, bs001, bs002" "$mimik" model work1 --source bs009 --expression 12 -o x
expect_code 2 "bs000, bs001, bs002" "$mimik" animate work1 --source bs000 --target bs009 --au 12 -o x.ply
expect_code 2 "is not a folder" "$mimik" preprocess nowhere -o x
expect_code 2 "no finished workspace" "$mimik" evaluate db1
[ ! -e x.ply ] && [ ! -e x ]
expect_code 2 "--spacing: spacing_mm is 0" "$mimik" synthesize x --spacing 0
expect_code 2 "--eye-holes: eye_hole_share is 2" "$mimik" synthesize x --eye-holes 2
expect_code 2 "--trim: trim is 2" "$mimik" preprocess db1 -o x --trim 2
expect_code 2 "--landmark-off-mm: landmark_off_scan_mm is 0" "$mimik" scans db1 --landmark-off-mm 0
expect_code 2 $'--seed\n-1' "$mimik" synthesize x --seed -1
[ ! -e x ]
claim "wrong input is named, ends with 2 and leaves nothing behind"

echo "no table" >bad.toml
expect_code 2 "'99'" "$mimik" evaluate work1 --expression 99 --dry-run
expect_code 2 "trim is nan" "$mimik" preprocess db1 -o x --trim nan --dry-run
expect_code 2 "100000" "$mimik" preprocess db1 -o x --rows 100000 --dry-run
ls -R db1 >before.txt
for place in db1 db1/work db1/bs000 db1/truth/work work1/../db1/new; do
  for dry in "" --dry-run; do expect_code 2 "nothing is written" "$mimik" preprocess db1 -o $place $dry; done
done
ls -R db1 | cmp before.txt - || fail "the database was written into"
claim "no workspace is made in a database"
for command in "evaluate work1 --expression 12" "preprocess db1 -o x" "synthesize x" "panels work1 --target bs001 --au 12 -o x"; do
  "$mimik" $command --dry-run --json >plan.json
  for key in '"dry_run": true' '"seconds"' '"megabytes"'; do grep -q "$key" plan.json || fail "no $key: $command"; done
done
"$mimik" preprocess db1 -o work1 --dry-run | grep -qx '15 scans: 15 up to date, 0 remain: about 0 s, 0 MB in work1' || fail "what is there is not done again"
"$mimik" preprocess db1 -o x --dry-run | grep -q '^15 scans: 0 up to date, 15 remain: about [0-9]* s, [0-9]* MB in x$' || fail "nothing is there yet"
"$mimik" preprocess db1 -o x --dry-run --json --threads "$(nproc)" >estimate.json
"$mimik" preprocess db1 -o x --dry-run --json --threads 1024 | diff estimate.json -
expect_code 2 "db1: exists already" "$mimik" synthesize db1 --dry-run
expect_code 2 "bad.toml" "$mimik" preprocess db1 -o x --catalogue bad.toml --dry-run
[ ! -e x ]
expect_code 2 "MB free" "$mimik" synthesize x --subjects 1000 --expressions all --spacing 0.2 --texture-density 10 --dry-run
claim "a dry run says the same of every command, refuses what the run would, and believes in no more threads than there are cores"

touch file
expect_code 2 "file/scores: the folder cannot be made" "$mimik" evaluate work1 --expression 12 -o file/scores
[ ! -s out.txt ]
for command in "evaluate work1 --expression 12" "model work1 --expression 12" "panels work1 --target bs001 --au 12"; do
  expect_code 2 "mimik: file: is a file; give a folder" "$mimik" $command -o file
  expect_code 2 "mimik: /proc/mimik: " "$mimik" $command -o /proc/mimik
done
ln -s loop loop
for command in "evaluate work1 --expression 12 -o" "panels work1 --target bs001 --au 12 -o" "preprocess db1 -o" synthesize; do
  for place in file file/x /proc/mimik loop "$(printf 'x%.0s' {1..300})"; do
    expect_code 2 "$place" "$mimik" $command "$place"
    grep '^mimik: ' err.txt >run.txt || { cat err.txt; fail "not our message: $command $place"; }
    expect_code 2 "$place" "$mimik" $command "$place" --dry-run
    grep '^mimik: ' err.txt | diff run.txt - || fail "a dry run says otherwise: $command $place"
  done
  "$mimik" $command new/folder --dry-run --quiet >/dev/null
  [ ! -e new ]
done
for command in "evaluate work1 --expression 12" "model work1 --expression 12" "panels work1 --target bs001 --au 12" "preprocess db1"; do
  expect_code 2 "--output: is empty; give a folder" "$mimik" $command -o ""
done
mkdir empty
"$mimik" evaluate work1 --expression 12 -o empty --dry-run --quiet >/dev/null
[ -z "$(ls empty)" ]
ln -s later link
"$mimik" synthesize link --subjects 1 --expressions N --dry-run --quiet >/dev/null
[ ! -e later ]
code=0
"$mimik" evaluate work1 --expression 12 --no-reference --no-whole-face --json >/dev/full 2>err.txt || code=$?
[ "$code" -eq 2 ] && grep -q "standard output" err.txt
claim "a folder that takes no scores or faces is found out before the work and in a dry run, which makes none, and a disk that takes no result ends with 2"

head -c 1000 db1/bs002/bs002_LFAU_12_0.bnt >cut.bnt
cp -r db1 broken
mv cut.bnt broken/bs002/bs002_LFAU_12_0.bnt
expect_code 1 "bs002_LFAU_12_0" "$mimik" preprocess broken -o broken_work --quiet
[ -e broken_work/faces/bs002/bs002_UFAU_4_0.json ]
expect_code 1 "bs002_LFAU_12_0" "$mimik" scans broken --no-catalogue
claim "one cut scan is reported with 1, and the rest is done"

echo BS001 >broken/Unallowed_Subjects.txt  # neither case is that of the scans
code=0
"$mimik" preprocess broken -o broken_work --quiet >/dev/null 2>&1 || code=$?
[ "$code" -eq 1 ]
expect_code 2 "bs001" "$mimik" animate broken_work --source mean --target bs001 --au 4 -o hidden.ply
expect_code 2 "bs001" "$mimik" panels broken_work --target bs001 --au 4 -o hidden
expect_code 2 "bs001" "$mimik" panels broken_work --source bs001 --target bs000 --au 4 -o hidden
face=broken_work/faces/bs001/bs001_N_N_0.ply
expect_code 2 "'bs001' stands in" "$mimik" figure $face -o hidden.png
expect_code 2 "'bs001' stands in" "$mimik" distance $face broken_work/average/average_face.ply -o hidden.vtp
echo bs002 >>broken/Unallowed_Subjects.txt  # is heeded without another preprocessing
expect_code 2 "bs002" "$mimik" animate broken_work --source mean --target bs002 --au 4 -o hidden.ply
[ ! -e hidden.ply ] && [ ! -e hidden ] && [ ! -e hidden.png ] && [ ! -e hidden.vtp ]
echo BS001 >broken/Unallowed_Subjects.txt
"$mimik" preprocess broken -o broken_work --sheets --quiet >/dev/null 2>&1 || [ $? -eq 1 ]
[ ! -e broken_work/sheets/bs001.png ] && { [ "$can_draw" = no ] || [ -e broken_work/sheets/bs000.png ]; }
claim "a subject who must not be shown is not"

mkdir stopped
"$mimik" synthesize stopped/db --subjects 200 --expressions all 2>stopped.txt &
job=$!
for _ in $(seq 600); do [ -n "$(ls stopped)" ] && break; sleep 0.1; done
[ -n "$(ls stopped)" ] || fail "nothing was begun"
kill -TERM $job
code=0
wait $job || code=$?
[ "$code" -eq 143 ] && [ -z "$(ls stopped)" ] || { cat stopped.txt; fail "exit code $code, left: $(ls stopped)"; }
claim "a run that is told to stop leaves nothing behind"
