#!/usr/bin/env bash
# model.sh MIMIK FOLDER SHARED: what a shell meets of 'mimik model', and of its files in 'mimik animate'.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_workspace
"$mimik" model work1 --source BS000 --au AU12_L -o typed --quiet >/dev/null
[ -s typed/bs000/AU12_L.json ]
claim "subjects and expressions may be typed in every way in which they are written"

"$mimik" model work1 --source bs000 --expression 12 -o models --quiet
"$mimik" animate work1 --source bs000 --target bs001 --au 12:0.5 -o measured.glb --quiet
"$mimik" animate work1 --target bs001 --model models/bs000/AU12.json:0.5 -o stored.glb --quiet
same_but_for_origin measured.glb stored.glb
"$mimik" model work1 --source bs000 --expression 12 --quiet
cmp models/bs000/AU12.json work1/models/default/bs000/AU12.json
"$mimik" model work1 --source bs000 --expression 12 --method sparse --kernel r2logr --no-anchors --quiet
cmp models/bs000/AU12.json work1/models/default/bs000/AU12.json
other=work1/models/sparse_r2logr_no-anchors/bs000/AU12.json
grep -q '"kernel": "r2logr"' "$other" && grep -q '"anchors": false' "$other" && grep -q '"mimik"' "$other" || fail "$other does not say how it was made"
"$mimik" animate work1 --target bs001 --model "$other" -o stored.glb >out.txt 2>err.txt
grep -q "correspondence sparse, here dense; kernel r2logr, here r" err.txt
expect_code 2 "--kernel and --no-anchors change control points" "$mimik" model work1 --source bs000 --expression 12 --kernel r2logr -o x
"$mimik" animate work1 --target bs001 --model models/bs000/AU12.json -o stored.glb >out.txt 2>err.txt
! grep -F "made otherwise" err.txt || fail "a difference where there is none"
"$mimik" preprocess "$shared/db1" -o work2 --subject bs001,bs002 --expression 4 --quiet >/dev/null
"$mimik" animate work2 --target bs001 --model models/bs000/AU12.json -o elsewhere.ply --json >elsewhere.json 2>err.txt
awk '/"largest_displacement_mm"/ { sub(/.*: */, ""); if ($0 + 0 > 3) good = 1 } END { exit !good }' elsewhere.json || fail "no smile elsewhere"
grep -q 'average face' elsewhere.json || { cat elsewhere.json; fail "no note on the average face"; }
claim "a model animates a face of another workspace where nobody shows the expression, and says on whose average it stands"
claim "a stored model says how it was made, keeps its file from others, and animates as the one that is measured does"

expect_code 2 $'the thesis method has no mean\nbs000' "$mimik" model work1 -o thesis_models --method thesis
[ ! -e thesis_models ]
claim "the thesis has no mean, and that is said before any work"

expect_code 2 "--source: 'bs000' is asked for twice" "$mimik" model work1 --source bs000,BS000 --expression 12 -o x
expect_code 2 "--expression: '12' is asked for twice" "$mimik" model work1 --source bs000 --expression 12,AU12 -o x
expect_code 2 "AU99 is not in the catalogue" "$mimik" model work1 --source bs000 --expression 12,99 -o x
expect_code 2 "bs000, bs001, bs002" "$mimik" model work1 --source bs009 --expression 12 -o x
[ ! -e x ]
claim "wrong input is named, ends with 2 and leaves nothing behind"
touch file
expect_refusal_of_bad_outputs "model work1 --expression 12"
expect_code 2 "--output: is empty; give a folder" "$mimik" model work1 --expression 12 -o ""
claim "a folder that takes no models is found out before the work"

echo '{}' >work1/faces/bs000/bs000_LFAU_12_0.json
expect_code 1 $'left out of the mean\nbs000_LFAU_12_0' "$mimik" model work1 --expression 12 --quiet
claim "a scan that a mean cannot use is a failure (1)"
