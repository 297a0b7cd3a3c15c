#!/usr/bin/env bash
# distance.sh MIMIK FOLDER: what a shell meets of 'mimik distance', on files small enough to know the answers by heart.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

# Two squares of 40 mm, 3 mm apart.
square() {  # z
  printf 'v 0 0 %s\nv 40 0 %s\nv 40 40 %s\nv 0 40 %s\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n' "$1" "$1" "$1" "$1"
}
square 0 >low.obj
square 3 >high.obj

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
expect_refusal_of_full_disk "distance low.obj high.obj --json"
claim "a result that standard output does not take ends with 2"

touch bs000_N_N_0.bnt
for command in "distance low.obj bs000_N_N_0.bnt" "distance bs000_N_N_0.bnt low.obj"; do
  expect_code 2 $'bs000_N_N_0.bnt: is a range scan\nWORK/faces/SUBJECT/bs000_N_N_0.ply' "$mimik" $command
done
expect_code 2 "cloud.csv" "$mimik" distance low.obj cloud.csv
expect_code 2 "missing.ply" "$mimik" distance missing.ply high.obj
claim "range scans, references without a surface and missing files are named"
