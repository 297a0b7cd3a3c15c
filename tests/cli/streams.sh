#!/usr/bin/env bash
# streams.sh MIMIK FOLDER SHARED: closed streams, pipes that nobody reads, terminals, and names that are no plain text.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_database
"$mimik" preprocess db1 -o whole >/dev/null 2>&1
for closed in '0<&-' '1>&-' '2>&-' '0<&- 1>&- 2>&-'; do
  eval '"$mimik" preprocess db1 -o streams '"$closed" >out.txt 2>err.txt || fail "ends with $? at $closed"
  diff -r -x registered whole streams || fail "other faces at $closed"
  rm -r streams
  eval '"$mimik" animate whole --source bs000 --target bs001 --au 12 -o closed/face.ply '"$closed" >out.txt 2>err.txt || fail "ends with $? at $closed"
  "$mimik" animate whole --source bs000 --target bs001 --au 12 -o open/face.ply --quiet >/dev/null
  diff -r closed open || fail "another face at $closed"
done
claim "no message gets into a file when standard streams are closed"

code=0
{ "$mimik" scans db1 --json --no-index 2>err.txt; echo $? >code.txt; } | true || code=$?
[ "$(cat code.txt)" -le 2 ] && [ ! -s err.txt ] || { cat code.txt err.txt; fail "a reader that goes"; }
{ "$mimik" preprocess db1 -o piped 2>&1 >/dev/null; echo $? >code.txt; } | true
[ "$(cat code.txt)" -eq 0 ] || fail "a run ends with the reader of its progress"
diff -r -x registered whole piped
claim "a run outlives the readers of what it says"

# A name with everything in it that a terminal would obey, and one that would look like a message of ours.
evil=$'a\x1b[31m\x07\xc2\x9b\x7f\xe2\x80\xae\xff'
printf 'v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n' >face.obj
cp face.obj "$evil.obj"
cp face.obj $'two\nmimik: lines.obj'
plain() {  # the command's words hold no control character but line breaks
  local code=0
  "$@" >out.txt 2>err.txt || code=$?
  ! cat out.txt err.txt | LC_ALL=C grep -qP '[\x00-\x08\x0b-\x1f\x7f]|\xc2[\x80-\x9f]|\xe2\x80\xae|\xff' || { cat -v out.txt err.txt; fail "control characters: $*"; }
  iconv -f UTF-8 -t UTF-8 out.txt >/dev/null || fail "no UTF-8: $*"
}
plain "$mimik" distance "$evil.ply" face.obj
grep -qF 'a\x1b[31m\x07\u009b\u007f\u202e\xff.ply' err.txt || { cat -v err.txt; fail "the name is not written out"; }
plain "$mimik" distance "$evil.obj" "$evil.obj" --json
plain "$mimik" distance "$evil.obj" nothing.obj --json
plain "$mimik" warp --from "$evil" --to "$evil" face.obj -o b.ply
plain "$mimik" figure "$evil" -o c.png
plain "$mimik" "$evil"
plain "$mimik" scans "$evil"
plain "$mimik" scans db1 "--$evil"
plain "$mimik" distance $'two\nmimik: lines.ply' face.obj
[ "$(wc -l <err.txt)" -eq 1 ] || fail "a name breaks the line"
mkdir "db$evil"
cp -r "$shared/db1/bs000" "db$evil/$evil"
plain "$mimik" scans "db$evil" --no-index
plain "$mimik" scans "db$evil" --no-index --json
printf 'file,subject,expression\n%s,%s,N\n' face.obj $'e\x1b[2J' >"db$evil/manifest.csv"
cp face.obj "db$evil/"
plain "$mimik" scans "db$evil" --check --no-index
"$mimik" catalogue --text | sed 's/name = "Lip Corner Puller"/name = "Lip \\u001b[2J \\n Puller"/' >own.toml
plain "$mimik" catalogue own.toml
grep -q 'Lip .x1b' out.txt || fail "the name is gone"
claim "control characters of names are written out, in messages and in lists"
"$mimik" catalogue own.toml --text | cmp - own.toml
claim "what is printed as a file is not changed"

code=0
printf '%s = 1\n' "$(printf 'a.%.0s' {1..50000})a" >deep.toml
{ printf 'a = '; printf '[%.0s' {1..50000}; } >brackets.toml
for file in deep.toml brackets.toml; do
  expect_code 2 "$file" "$mimik" catalogue $file
  expect_code 2 "deeper than" "$mimik" animate whole --target bs001 --au 12 --catalogue $file -o nothing.ply
  expect_code 2 "$file:1: error: " "$mimik" catalogue $file --lint
done
{ printf '{"schema": 1, "x": '; printf '[%.0s' {1..50000}; } >deep.json
expect_code 2 $'deep.json\ndeeper than' "$mimik" animate whole --target bs001 --model deep.json -o nothing.ply
expect_code 2 $'deep.json\ndeeper than' "$mimik" figure --description deep.json -o nothing.png
claim "TOML and JSON that nest too deep are refused"

TMPDIR=$PWD/tmp
export TMPDIR
mkdir tmp
"$mimik" evaluate whole -o ended --quiet >/dev/null 2>&1 &
job=$!
for _ in $(seq 200); do
  [ -e ended/cases.csv.part ] && break
  kill -0 $job 2>/dev/null || break
  sleep 0.02
done
kill -TERM $job 2>/dev/null || true
code=0
wait $job || code=$?
[ "$code" -eq 143 ] || [ -s ended/scores.md ] || fail "ends with $code"
[ -z "$(ls tmp)" ] && ! ls ended | grep -q part || { ls tmp ended; fail "a temporary file is left"; }
claim "an evaluation that is ended leaves no temporary file"

awk 'BEGIN { for (i = 0; i < 1000000; ++i) print "v", i, 0, 0 }' >large.obj
awk 'BEGIN { print "name,x,y,z"; for (i = 0; i < 1000000; ++i) print "p" i "," i ",0,0" }' >large.csv
printf 'name,x,y,z\na,0,0,0\nb,40,0,0\nc,0,40,0\nd,0,0,40\n' >box.csv
memory=60000  # kB: the program starts with less, the files need more
small() { (ulimit -v $memory && exec "$@"); }
small "$mimik" version >/dev/null || fail "the program needs more than $memory kB to start"
expect_code 2 $'mimik: large.obj: \nmemory' small "$mimik" distance large.obj face.obj
expect_code 2 $'large.csv: \nmemory' small "$mimik" distance large.csv face.obj
expect_code 2 $'large.obj: \nmemory' small "$mimik" warp --from box.csv --to box.csv large.obj -o nothing.obj
claim "a file for which there is not enough memory is named"

if command -v script >/dev/null; then
  script -qec "TERM=xterm '$mimik' preprocess db1 -o shown" typescript >/dev/null </dev/null
  grep -q ' left bs' typescript || fail "no remaining time on the bar"
  script -qec "TERM=xterm '$mimik' distance nothing.ply face.obj" typescript >/dev/null </dev/null || true
  grep -q $'\x1b\\[1;31mmimik:\x1b\\[0m' typescript || { cat -v typescript; fail "no colour on a terminal"; }
  for plain in "NO_COLOR=1 TERM=xterm" "TERM=dumb"; do
    script -qec "env $plain '$mimik' distance nothing.ply face.obj" typescript >/dev/null </dev/null || true
    ! grep -q $'\x1b' typescript || fail "colours in spite of $plain"
  done
  claim "a terminal shows colours and the remaining time, and no colours to who wants none"
fi
! "$mimik" --help | grep -q $'\x1b' || fail "colours in a pipe"
claim "pipes and files get no colours"
