# Sourced by the shell tests of the programs with their arguments MIMIK FOLDER SHARED: starts in the emptied FOLDER.
# SHARED is what make_shared.sh made, for reading alone: a database db1 of three built-in subjects and its workspace work1.
mimik=$1
folder=$2
shared=${3:-}
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
export XDG_CACHE_HOME=$PWD.cache  # not the user's
rm -rf "$XDG_CACHE_HOME"

claim() { echo "checked: $1"; }
fail() { echo "failed: $1"; exit 1; }
# db1 is a link: no command may write into a database. work1 is a copy: models and regions go into a workspace.
borrow_database() { ln -s "$shared/db1" db1; }
borrow_workspace() { cp -r "$shared/work1" work1; }
expect_code() {  # code, words that the message must have (one per line), command...
  local wanted=$1 words=$2 code=0
  shift 2
  "$@" >out.txt 2>err.txt || code=$?
  [ "$code" -eq "$wanted" ] || { cat out.txt err.txt; fail "exit code $code, not $wanted: $*"; }
  while read -r word; do
    grep -qF -- "$word" out.txt err.txt || { cat out.txt err.txt; fail "no word of '$word': $*"; }
  done <<<"$words"
}
expect_json() {  # file, object, key, value (within 1e-9)
  awk -v object="\"$2\"" -v key="\"$3\":" -v value="$4" '
    index($0, object) { inside = 1 }
    inside && index($0, key) { sub(/.*: */, ""); sub(/,.*/, ""); found = 1; d = $0 - value; wrong = d > 1e-9 || d < -1e-9; exit }
    END { exit wrong || !found }' "$1" || { cat "$1"; fail "$1: $2 $3 is not $4"; }
}

# Two GLB files that differ in nothing but what their `asset` says of who made them.
same_but_for_origin() {
  local file bytes
  for file in "$1" "$2"; do
    bytes=$(od -An -tu4 -j12 -N4 "$file")
    head -c $((20 + bytes)) "$file" | tail -c +21 | sed 's/"asset":{\("extras":{[^}]*}\)\{0,1\}[^}]*}//; s/ *$//' >"$file.json"
    tail -c +$((21 + bytes)) "$file" >"$file.numbers"
  done
  cmp "$1.numbers" "$2.numbers" && cmp "$1.json" "$2.json"
}

# What comes out of the drawing program needs a way to draw; what goes in does not.
can_draw() {
  printf 'v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n' >probe.obj
  "$mimik" figure -o probe.png probe.obj --size 40x40 --quiet >/dev/null 2>&1
}
is_png() { [ "$(head -c 4 "$1" | tail -c 3)" = PNG ] || fail "$1 is no PNG"; }
# A `mimik` that finds no drawing program: neither beside it nor, with PATH=nowhere, elsewhere.
without_drawing_program() {
  mkdir -p alone
  [ -e alone/mimik ] || cp "$mimik" alone/mimik
  env PATH=nowhere alone/mimik "$@"
}

expect_plan_in_json() {  # command, which would write into x
  local key
  "$mimik" $1 --dry-run --json >plan.json
  for key in '"dry_run": true' '"seconds"' '"megabytes"'; do grep -q "$key" plan.json || fail "no $key: $1"; done
  [ ! -e x ] || fail "a dry run wrote: $1"
}
expect_refusal_of_bad_folders() {  # command, to which the output folder is added as its last word
  local place
  touch file
  ln -sfn loop loop
  for place in file file/x /proc/mimik loop "$(printf 'x%.0s' {1..300})"; do
    expect_code 2 "$place" "$mimik" $1 "$place"
    grep '^mimik: ' err.txt >run.txt || { cat err.txt; fail "not our message: $1 $place"; }
    expect_code 2 "$place" "$mimik" $1 "$place" --dry-run
    grep '^mimik: ' err.txt | diff run.txt - || fail "a dry run says otherwise: $1 $place"
  done
  "$mimik" $1 new/folder --dry-run --quiet >/dev/null
  [ ! -e new ] || fail "a dry run made a folder: $1"
}
expect_refusal_of_bad_outputs() {  # command without its -o
  expect_code 2 "mimik: file: is a file; give a folder" "$mimik" $1 -o file
  expect_code 2 "mimik: /proc/mimik: " "$mimik" $1 -o /proc/mimik
}
expect_refusal_of_full_disk() {  # command that writes to standard output
  local code=0
  "$mimik" $1 >/dev/full 2>err.txt || code=$?
  [ "$code" -eq 2 ] && grep -q "standard output" err.txt || fail "a full disk is no success: $1"
}
