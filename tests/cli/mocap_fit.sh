#!/usr/bin/env bash
# mocap_fit.sh MIMIK FOLDER: the labels of one face are put on another one by twelve points.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

"$mimik" mocap synthesize take --seconds 0.1 --rate 30 --truth-every 0 --quiet >/dev/null
pick() {  # names as a pattern
  awk -F, -v names="^($1)$" 'NR == 1 || $1 ~ names' take/target_markers.csv
}
hand='forehead_high|eye_(outer|inner)_(left|right)|nose_tip|mouth_corner_(left|right)|lip_upper_middle|chin|jaw_outer_(left|right)'
pick "$hand" >points.csv
[ "$(wc -l <points.csv)" -eq 13 ] || fail "$(cat points.csv)"
faces=(take/source.ply take/target.ply --labels take/source_markers.csv)
fit() { "$mimik" mocap fit "${faces[@]}" --points points.csv "$@"; }

fit -o labels.csv --truth take/target_markers.csv >fit.txt
grep -q 'labels.csv: 76 labels by 12 placed by hand; dense' fit.txt || fail "$(cat fit.txt)"
[ "$(wc -l <labels.csv)" -eq 77 ] || fail "$(wc -l labels.csv)"
fit -o again.csv --threads 1 --quiet >/dev/null
cmp labels.csv again.csv
claim "76 labels come of 12 points, the same on any number of threads"

fit -o compared.csv --by levenberg --compare --evaluations 3000 --truth take/target_markers.csv --json >compared.json
python3 - <<'CHECK' || fail "$(cat compared.json)"
import json
d = json.load(open("compared.json"))
fits = {f["by"]: f for f in d["fits"]}
assert d["labels"] == 76 and d["points"] == 12 and d["by"] == "levenberg", d
assert {"start", "levenberg", "dense"} <= set(fits), fits.keys()
own = fits["levenberg"]
assert own["energy"]["total"] < own["start_energy"]["total"], own
for way in ("ceres", "simplex"):
    if way not in fits:
        assert any(r.startswith(way) for r in d["remarks"]), d["remarks"]
        continue
    assert fits[way]["energy"]["total"] < fits[way]["start_energy"]["total"], fits[way]
    if way == "simplex":
        assert own["energy"]["total"] <= fits[way]["energy"]["total"], fits
assert all(f["error"]["labels"] == 64 for f in fits.values()), fits
CHECK
claim "every way that there is reports its energy, evaluations and time"

head -n 4 points.csv >few.csv
expect_code 2 $'few.csv\n3 points are placed by hand\n4 are the least' "$mimik" mocap fit "${faces[@]}" --points few.csv -o o.csv
sed 's/^nose_tip/nose_tp/' points.csv >typo.csv
expect_code 2 $'no label \'nose_tp\'\nnose_tip' "$mimik" mocap fit "${faces[@]}" --points typo.csv -o o.csv
awk -F, -v OFS=, '$1 == "chin" { $4 += 40 } 1' points.csv >off.csv
expect_code 2 $'1 point lies off the target (of 12): \'chin\' by\nmm, and 5 is the most' "$mimik" mocap fit "${faces[@]}" --points off.csv -o o.csv
expect_code 2 "--most-off: most_off_mm is -1" "$mimik" mocap fit "${faces[@]}" --points points.csv --most-off -1 -o o.csv
"$mimik" mocap fit "${faces[@]}" --points off.csv --most-off 60 -o far.csv --by start --quiet >/dev/null
printf 'ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n' >cloud.ply
expect_code 2 "cloud.ply: has points and no faces" "$mimik" mocap fit take/source.ply cloud.ply --labels take/source_markers.csv --points points.csv -o o.csv
expect_code 2 "o.pp: labels are written as .csv" "$mimik" mocap fit "${faces[@]}" --points points.csv -o o.pp
expect_code 2 "--strain: strain is -1" "$mimik" mocap fit "${faces[@]}" --points points.csv --by levenberg --strain -1 -o o.csv
expect_code 2 $'mimik-ceres.so is not there\nlibceres-dev' env MIMIK_COMPANIONS=/nowhere "$mimik" mocap fit "${faces[@]}" --points points.csv --by ceres -o o.csv

expect_code 2 $'--strain: serves levenberg, ceres and simplex\nby dense' "$mimik" mocap fit "${faces[@]}" --points points.csv --strain 1 -o o.csv
expect_code 2 "--evaluations: serves simplex" "$mimik" mocap fit "${faces[@]}" --points points.csv --by levenberg --evaluations 9 -o o.csv
cp points.csv kept.csv
expect_code 2 "kept.csv: is read by this very call" "$mimik" mocap fit "${faces[@]}" --points kept.csv -o kept.csv
cmp points.csv kept.csv
awk -F, -v OFS=, 'NR > 1 { $2 += 300 } 1' take/source_markers.csv >away.csv
expect_code 2 $'away.csv\n76 points lie off the reference (of 76)' "$mimik" mocap fit take/source.ply take/target.ply --labels away.csv --points points.csv -o o.csv
expect_code 2 $'times as far apart\nmend the unit' "$mimik" mocap fit "${faces[@]}" --points points.csv --mesh-unit m -o o.csv
pick 'eye_inner_(left|right)|jaw_outer_(left|right)' >plane.csv
expect_code 3 "of one plane" "$mimik" mocap fit "${faces[@]}" --points plane.csv --by levenberg -o o.csv
[ ! -e o.csv ] && [ ! -e o.pp ] || fail "written all the same"
claim "what is wrong is named in mm and by name, and nothing is written"

mkdir junk
: >junk/mimik-ceres.so
MIMIK_COMPANIONS=$PWD/junk "$mimik" mocap fit "${faces[@]}" --points points.csv -o junk.csv --by start --compare --evaluations 200 >junk.txt 2>&1
grep -q 'ceres is not compared' junk.txt || fail "$(cat junk.txt)"
grep -q 'projected from the axis of the head' junk.txt || fail "$(cat junk.txt)"
claim "a library that does not load costs its own row alone"

fit -o cm.csv --by start --reference-unit cm --mesh-unit cm --quiet >/dev/null
awk -F, 'FNR == 1 { next } NR == FNR { x[$1] = $2; next } $1 in x { ++n; d = x[$1] - $2; if (d > 0.01 || d < -0.01) exit 1 } END { exit n != 12 }' \
  points.csv cm.csv || fail "$(cat cm.csv)"
claim "labels are written in the unit of their mesh"
