#!/usr/bin/env bash
# json_errors.sh MIMIK FOLDER SHARED: with --json standard output is one JSON document with a schema, whatever happens.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_database
borrow_workspace
printf 'v 0 0 0\nv 40 0 0\nv 40 40 0\nv 0 40 0\nf 1 2 3 4\n' >low.obj
printf 'v 0 0 3\nv 40 0 3\nv 40 40 3\nv 0 40 3\nf 1 2 3 4\n' >high.obj
printf 'name,x,y,z\na,0,0,0\nb,40,0,0\nc,0,40,0\nd,0,0,40\n' >box.csv
is_document() {  # words that it must have (one per line)
  [ "$(head -c 1 out.txt)" = '{' ] && [ "$(grep -c '^{' out.txt)" -eq 1 ] && [ "$(tail -n 1 out.txt)" = '}' ] || { cat out.txt; fail "no document: $2"; }
  grep -q '"schema": 1' out.txt || { cat out.txt; fail "no schema: $2"; }
  while read -r word; do grep -qF -- "$word" out.txt || { cat out.txt; fail "no $word: $2"; }; done <<<"$1"
}
while read -r command; do
  "$mimik" $command --json >out.txt 2>err.txt || { cat err.txt; fail "$command"; }
  is_document '"schema"' "$command"
  ! grep -q '"error": "' out.txt || fail "an error: $command"
done <<'END'
synthesize x --subjects 1 --expressions 12 --dry-run
scans db1 --no-index
scans db1 --check --no-index
preprocess db1 -o x --dry-run
register work1 --subject bs000 --au 12
animate work1 --source bs000 --target bs001 --au 12 -o face.ply
model work1 --source bs000 --au 12 -o models
evaluate work1 --au 12 --no-reference --no-whole-face
evaluate work1 --au 12 --dry-run
panels work1 --source bs000 --target bs001 --au 12 -o x --dry-run
warp --from box.csv --to box.csv low.obj -o same.obj
distance low.obj high.obj
regions work1
catalogue
catalogue --lint
version
END
claim "the output of every command has its schema"
"$mimik" distance low.obj high.obj --json >out.txt
[ "$(grep -c '"border_hits": 4' out.txt)" -eq 2 ] || { cat out.txt; fail "border"; }
claim "distances come with the number of those that end on a border"

expect_error() {  # code, words, command...
  local wanted=$1 words=$2 code=0
  shift 2
  "$mimik" "$@" --json >out.txt 2>err.txt || code=$?
  [ "$code" -eq "$wanted" ] || { cat out.txt err.txt; fail "exit code $code: $*"; }
  is_document "\"exit_code\": $wanted"$'\n'"$words" "$*"
  grep -q '^mimik[a-z-]*: ' err.txt || fail "nothing on standard error: $*"
}
expect_error 2 '"file": "nothing.ply"' distance nothing.ply high.obj
expect_error 2 '"option": "--exprssion"' animate work1 --exprssion 12
expect_error 2 '"option": "--rows"' preprocess db1 -o x --rows 1e
expect_error 2 "no command 'distnace'" distnace
expect_error 2 '"option": "--target"' animate work1 -o nothing.ply
printf 'name,x,y,z\na,0,0,0\nb,40,zero,0\n' >bad.csv
expect_error 2 $'"file": "bad.csv"\n"line": 3' warp --from bad.csv --to box.csv low.obj -o nothing.obj
printf 'name,x,y,z\na,0,0,0\nb,1,0,0\nc,2,1,0\nd,0,1,0\n' >flat.csv
expect_error 3 '"file": "flat.csv"' warp --from flat.csv --to flat.csv low.obj -o nothing.obj
expect_error 2 '"file": "nowhere"' evaluate nowhere
expect_error 2 '"file": "empty.json"' figure --description empty.json -o nothing.png
expect_error 2 '"error": "' panels work1 --target nobody --au 12 -o x
claim "errors are documents, too, which name the file, the line and the option, and the code is kept"
