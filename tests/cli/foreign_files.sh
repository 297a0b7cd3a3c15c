#!/usr/bin/env bash
# foreign_files.sh MIMIK FOLDER: files as other programs write them (tests/data/foreign), as a user meets them.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"
data=$(cd "$(dirname "${BASH_SOURCE[0]}")/../data/foreign" && pwd)

# Points over the notches: one point a file, so that the mean is its distance.
sed -n '1p;2p' "$data/obj-concave-polygon/points.csv" >over_arrow.csv
sed -n '1p;3p' "$data/obj-concave-polygon/points.csv" >over_u.csv
for file in arrow0.obj arrow1.obj arrow2.obj arrow3.obj; do
  "$mimik" distance over_arrow.csv "$data/obj-concave-polygon/$file" --json >d.json
  expect_json d.json test_to_reference mean 13.416407864998739
done
for file in u.obj u.ply; do
  "$mimik" distance over_u.csv "$data/obj-concave-polygon/$file" --json >d.json
  expect_json d.json test_to_reference mean 20
done
claim "a concave polygon leaves its notch open, whatever corner is first"

far=$data/far-from-origin
"$mimik" distance "$far/b.ply" "$far/a.ply" --json >far.json
expect_json far.json test_to_reference n 25
awk '/"max"/ { sub(/.*: */, ""); exit !($0 + 0 > 0.2499 && $0 + 0 < 0.2501) }' far.json || { cat far.json; fail "b lies 0.25 above a"; }
expect_code 0 "lose up to 0.25 mm" "$mimik" warp --from "$far/from.csv" --to "$far/to.csv" "$far/a.ply" -o out.stl
claim "distances far from the origin are those near it, and STL says what it loses"

# A slope that no half turn brings onto itself, once in LPS and once in RAS.
ply() {  # frame, sign
  printf 'ply\nformat ascii 1.0\ncomment %s\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n' "$1"
  printf 'element face 1\nproperty list uchar int vertex_indices\nend_header\n'
  printf '%s 10 0\n%s 10 1\n%s 50 9\n%s 50 2\n4 0 1 2 3\n' "$2"20 "$2"60 "$2"60 "$2"20 | sed "s/ \([15]0\) / $2\1 /"
}
ply "SPACE=LPS" "" >lps.ply
ply "SPACE=RAS" "-" >ras.ply
ply "made by hand" "" >plain.ply
ply "made by hand" "-" >plain_ras.ply
for pair in "lps.ply ras.ply" "ras.ply lps.ply" "ras.ply plain.ply" "plain.ply ras.ply" "lps.ply plain_ras.ply"; do
  "$mimik" distance $pair --json >d.json 2>err.txt
  expect_json d.json test_to_reference max 0
  grep -q "x and y of the reference are negated" err.txt || fail "no word of the frames: $pair"
done
"$mimik" distance ras.ply plain_ras.ply --json >d.json
expect_json d.json test_to_reference max 0
ply "SPACE=LAS" "" >las.ply
expect_code 2 "las.ply
SPACE is 'las'; it must be LPS" "$mimik" distance las.ply lps.ply
claim "surfaces that state their frames are measured in one"

"$mimik" distance "$data/pcd-organised-nan/a.pcd" "$data/ref.ply" --json >d.json 2>err.txt
expect_json d.json test_to_reference n 22
grep -q "3 points that were not measured" err.txt || fail "no word of unmeasured points"
for file in stl-ascii-words/comment.stl stl-ascii-words/oneline.stl stl-trailing-bytes/tail.stl ply-tristrips/strips.ply; do
  "$mimik" distance "$data/$file" "$data/ref.ply" --json --quiet >d.json
  awk '/"max"/ { sub(/.*: */, ""); exit !($0 + 0 < 1e-5) }' d.json || { cat d.json; fail "$file is not ref.ply"; }
done
claim "what was not measured is left out, and other spellings are the same surface"

expect_code 2 "from.csv
the header line is missing" "$mimik" warp --from "$data/csv-no-header/from.csv" --to "$data/to.csv" "$data/ref.ply" -o no.ply
[ ! -e no.ply ] || fail "a refused warp wrote"
expect_code 0 "paired by their order" "$mimik" warp --pair-by order --from "$data/from.csv" --to "$data/to.csv" \
  "$data/ref.ply" -o out.ply
claim "what is wrong is named with its file"

for database in backslashes empty-last-row; do
  "$mimik" scans "$data/manifest-windows/$database" --json --no-index >scans.json
  [ "$(grep -c '"error": null' scans.json)" -eq 4 ] && [ "$(grep -c '"sex"' scans.json)" -eq 2 ] || { cat scans.json; fail "$database"; }
  expect_code 0 "4 faces preprocessed, 0 already up to date, 0 failed" "$mimik" preprocess "$data/manifest-windows/$database" -o "work-$database"
done
claim "a manifest may have backslashes, and a last row of commas"
