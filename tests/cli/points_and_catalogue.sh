#!/usr/bin/env bash
# points_and_catalogue.sh MIMIK FOLDER: warp, distance and catalogue as a shell meets them, on files small enough to know the
# answers by heart; the first claim that fails ends it.
set -euo pipefail
page=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/docs/facs_catalogue.md
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

# A row of a points CSV is what it must be, within 1e-9: coordinates below 100 round at 1e-14, the solve adds a few digits.
expect_row() {  # file, name, x y z
  awk -F, -v name="$2" -v x="$3" -v y="$4" -v z="$5" '
    function off(a, b) { return a - b > 1e-9 || b - a > 1e-9 }
    $1 == name { found = 1; if (off($2, x) || off($3, y) || off($4, z)) { print; wrong = 1 } }
    END { exit wrong || !found }' "$1" || { cat "$1"; fail "$1: $2 is not at $3 $4 $5"; }
}
expect_json() {  # file, object, key, value (within 1e-9)
  awk -v object="\"$2\"" -v key="\"$3\":" -v value="$4" '
    index($0, object) { inside = 1 }
    inside && index($0, key) { sub(/.*: */, ""); sub(/,.*/, ""); found = 1; d = $0 - value; wrong = d > 1e-9 || d < -1e-9; exit }
    END { exit wrong || !found }' "$1" || { cat "$1"; fail "$1: $2 $3 is not $4"; }
}

cat >box.csv <<'END'
name,x,y,z
a,0,0,0
b,40,0,0
c,0,40,0
d,0,0,40
e,40,40,40
END
awk -F, -v OFS=, 'NR > 1 { $2 += 5; $3 -= 2; $4 += 0.5 } { print }' box.csv >moved.csv
printf 'name,x,y,z\nlast,1,2,3\nfirst,10,-20,30\nlast,70,7,7\n' >points.csv

for kernel in r r2logr; do
  for smoothing in 0 10; do
    "$mimik" warp --from box.csv --to box.csv --kernel $kernel --smoothing $smoothing points.csv -o same.csv --quiet
    expect_row same.csv first 10 -20 30
    "$mimik" warp --from box.csv --to moved.csv --kernel $kernel --smoothing $smoothing points.csv -o shifted.csv --quiet
    expect_row shifted.csv first 15 -22 30.5
  done
done
claim "landmarks that stay move nothing, and landmarks that all move alike move every point alike, for any kernel and smoothing"
for kernel in r2 R 1; do
  expect_code 2 $'--kernel\nr2logr' "$mimik" warp --from box.csv --to box.csv --kernel $kernel points.csv -o nothing.csv
done
[ ! -e nothing.csv ] || fail "a kernel that there is not"
claim "a kernel of another name is refused with the names that there are"
[ "$(cut -d, -f1 shifted.csv | tr '\n' ' ')" = "name last first last " ] || fail "names and order"
claim "names and order of a CSV are kept"

# Two squares of 40 mm, 3 mm apart.
square() {  # z
  printf 'v 0 0 %s\nv 40 0 %s\nv 40 40 %s\nv 0 40 %s\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n' "$1" "$1" "$1" "$1"
}
square 0 >low.obj
square 3 >high.obj
"$mimik" warp --from box.csv --to moved.csv low.obj -o low_moved.obj --json >warp.json
grep -q '"landmarks": 5' warp.json && grep -q '"points": 4' warp.json || fail "report of warp"
grep -q '^f 1/1 2/2 3/3 4/4' low_moved.obj && [ "$(grep -c '^vt ' low_moved.obj)" -eq 4 ] || fail "faces or texture of the mesh"
awk '$1 == "v" { d = $2 - 45; n += (d < 1e-9 && d > -1e-9) } END { exit n != 2 }' low_moved.obj || fail "corners of the moved square"
claim "a warped mesh keeps its faces and texture coordinates"

"$mimik" warp --from box.csv --to moved.csv low.obj -o $'caf\xe9.obj' --json >warp.json || fail "a name that is no UTF-8"
grep -q '"points": 4' warp.json && iconv -f UTF-8 -t UTF-8 warp.json >copy.json || fail "JSON of a name that is no UTF-8"
claim "--json is UTF-8 whatever the bytes of a file's name"

"$mimik" distance low.obj high.obj --json >planes.json
for side in test_to_reference reference_to_test; do
  expect_json planes.json $side n 4
  for key in mean rms median p95 max; do expect_json planes.json $side $key 3; done
done
grep -q '"units": "mm"' planes.json || fail "units"
claim "parallel squares are as far apart as they are, in every figure and both ways"
printf 'name,x,y,z\nabove,20,20,4\nbeside,44,20,6\n' >cloud.csv
"$mimik" distance cloud.csv high.obj --json >cloud.json
expect_json cloud.json test_to_reference n 2
expect_json cloud.json test_to_reference mean 3  # 1 above, and 3-4-5 beside the edge
expect_json cloud.json test_to_reference median 3
expect_json cloud.json test_to_reference p95 4.8  # 1 + 0.95 (5 - 1)
expect_json cloud.json test_to_reference max 5
grep -q '"reference_to_test": null' cloud.json || fail "a cloud has no surface to measure to"
claim "points are measured to the nearest point of the surface, edges included"
(cat low.obj; printf 'v 20 20 3\nv 20 20 13\n') >loose.obj
"$mimik" distance loose.obj high.obj --json >loose.json 2>err.txt
grep -qF "note: loose.obj: 2 vertices belong to no face and count all the same" err.txt || fail "vertices without a face"
expect_json loose.json test_to_reference n 6
expect_json loose.json test_to_reference max 10
"$mimik" distance loose.obj high.obj --quiet 2>err.txt | grep -q "test to reference"
! [ -s err.txt ] || fail "remarks though quiet"
for clean in low.obj cloud.csv; do
  "$mimik" distance $clean high.obj >out.txt 2>err.txt
  ! [ -s err.txt ] || fail "a remark on $clean"
done
claim "vertices without a face count, and it is said how many they are"
"$mimik" distance low.obj high.obj -o low.vtp --quiet >/dev/null
grep -q 'Name="distance_mm"' low.vtp || fail "values per vertex"
claim "distances per vertex are written"
for extension in vtp ply; do  # the distances of another reference are there already
  square 7 >higher.obj
  "$mimik" distance low.obj high.obj -o first.$extension --quiet >/dev/null
  "$mimik" distance first.$extension higher.obj -o second.$extension --quiet >/dev/null
  [ "$(grep -aoE 'Name="distance_mm"|property [a-z0-9]+ distance_mm' second.$extension | wc -l)" -eq 1 ] || fail "distance_mm twice"
done
"$mimik" distance second.ply higher.obj -o third.ply --quiet >/dev/null
cmp second.ply third.ply || fail "the new distances are not those in the file"
claim "distances replace those that the mesh had"
for extension in stl obj csv; do
  expect_code 2 $'lost.'$extension$'\n.vtp or .ply' "$mimik" distance low.obj missing.obj -o lost.$extension
  [ ! -e lost.$extension ] || fail "a file that should not be"
done
claim "a format that holds no distances is refused before any file is read"
for command in "distance low.obj high.obj --json" "catalogue --text" "catalogue --help"; do
  code=0
  "$mimik" $command >/dev/full 2>err.txt || code=$?
  [ "$code" -eq 2 ] && grep -q "standard output" err.txt || fail "a full disk is no success: $command"
done
claim "a result that standard output does not take ends with 2"
expect_code 0 "Ends with 0: done; 1: done, with failures" "$mimik" --help
claim "the help says with which code a command ends"
expect_code 2 $'no command \'distnace\'\ndistance' "$mimik" distnace low.obj high.obj
claim "an unknown command is named with the nearest"

touch bs000_N_N_0.bnt
for command in "warp --from box.csv --to moved.csv bs000_N_N_0.bnt -o nothing.ply" "distance low.obj bs000_N_N_0.bnt" "distance bs000_N_N_0.bnt low.obj"; do
  expect_code 2 $'bs000_N_N_0.bnt: is a range scan\nWORK/faces/SUBJECT/bs000_N_N_0.ply' "$mimik" $command
done
expect_code 2 "give .csv, .ply, .obj, .stl or .vtp" "$mimik" warp --from box.csv --to moved.csv low.obj -o nothing.glb
! grep -q pcd err.txt || fail "a format that is not written is offered"
expect_code 2 ".csv, .ply, .obj, .stl or .vtp" "$mimik" warp --from box.csv --to moved.csv low.obj -o nothing.pcd
claim "who gives a range scan is told how to get a mesh, and formats are offered that are written"

grep -v '^b,' box.csv >fewer.csv
printf 'f,1,1,1\ng,2,2,2\n' >>fewer.csv
expect_code 2 $'b\nf\ng' "$mimik" warp --from box.csv --to fewer.csv points.csv -o nothing.csv
for name in b f g; do grep -qwF "$name" err.txt || fail "$name is not named"; done
expect_code 2 "points.csv" "$mimik" distance low.obj points.csv
expect_code 2 "missing.ply" "$mimik" distance missing.ply high.obj

mkdir -p db/bs003
cp low.obj db/bs003/bs003_N_N_0.obj
cp box.csv db/bs003/bs003_N_N_0.csv
echo bs003 >db/unallowed_subjects.txt
scan=db/bs003/bs003_N_N_0
expect_code 2 "'bs003' stands in" "$mimik" warp --from box.csv --to moved.csv $scan.obj -o nothing.csv
expect_code 2 "'bs003' stands in" "$mimik" warp --from $scan.csv --to moved.csv points.csv -o nothing.csv
expect_code 2 "'bs003' stands in" "$mimik" warp --from box.csv --to $scan.csv points.csv -o nothing.csv
expect_code 2 "'bs003' stands in" "$mimik" distance $scan.obj high.obj -o nothing.ply
expect_code 2 "'bs003' stands in" "$mimik" distance low.obj $scan.obj -o nothing.ply
[ ! -e nothing.csv ] && [ ! -e nothing.ply ] || fail "a file of a hidden subject"
claim "scans and points of a hidden subject are neither warped nor measured"

printf 'name,x,y,z\na,0,0,0\nb,1,0,0\nc,2,1,0\nd,0,1,0\n' >flat.csv
expect_code 3 "plane" "$mimik" warp --from flat.csv --to flat.csv points.csv -o nothing.csv
[ ! -e nothing.csv ] || fail "a file that should not be"
printf 'name,x,y,z\nnear,1,2,3\nfar,1e200,0,0\n' >far.csv
expect_code 3 "'far'" "$mimik" warp --from box.csv --to moved.csv far.csv -o nothing.csv
[ ! -e nothing.csv ] || fail "a file that should not be"
claim "landmarks without a partner are all named, as are missing files, references without a surface, flat landmarks and points beyond all numbers (3)"

"$mimik" catalogue --lint >lint.txt
grep -q ': 0 errors' lint.txt || fail "the catalogue that is shipped has faults"
"$mimik" catalogue --text >own.toml
"$mimik" catalogue own.toml --json >own.json
"$mimik" catalogue --json | diff <(grep -v '"catalogue"' own.json) <(grep -v '"catalogue"') || fail "its text is not what it is"
"$mimik" catalogue | grep -q "Gray's Anatomy, muscles of facial expression (AU 1, 2, 4, 12" || fail "references of the muscles"
grep -q '"reference": "FACS' own.json || fail "reference of a muscle"
claim "the catalogue that is shipped has no fault, and its text reads back the same"
for other in --json --lint; do
  expect_code 2 $'--text\n'$other "$mimik" catalogue --text $other
  ! grep -q '\[' out.txt || fail "the text all the same"
done
claim "the text of a catalogue is neither JSON nor a check, and what asks for both is refused"
sed -n '/^```toml$/,/^```$/p' "$page" | grep -v '^```' >printed.toml
grep -q '^\[\[au\]\]' printed.toml && grep -q '^\[\[emotion\]\]' printed.toml || fail "the example was not found"
expect_code 0 ": 0 errors" "$mimik" catalogue printed.toml --lint
claim "the catalogue that the documentation prints has no error"
line=$(grep -n -m1 'mouth_corner = 1.0' own.toml | cut -d: -f1)
sed "${line}s/mouth_corner = 1.0/mouth_korner = 1.0/" own.toml >wrong.toml
expect_code 2 "wrong.toml:$line: error: "$'\nmouth_korner' "$mimik" catalogue wrong.toml --lint
expect_code 2 "$line"$'\nmouth_korner' "$mimik" catalogue wrong.toml
sed "${line}s/ = 1.0/ = = 1.0/" own.toml >broken.toml
expect_code 2 "broken.toml:$line: error: " "$mimik" catalogue broken.toml --lint
claim "a wrong name and broken TOML are said with file and line"
