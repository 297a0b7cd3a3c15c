# Sourced by the shell tests of the programs with their arguments MIMIK FOLDER: starts in the emptied FOLDER.
mimik=$1
folder=$2
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

claim() { echo "checked: $1"; }
fail() { echo "failed: $1"; exit 1; }
expect_code() {  # code, words that the message must have (one per line), command...
  local wanted=$1 words=$2 code=0
  shift 2
  "$@" >out.txt 2>err.txt || code=$?
  [ "$code" -eq "$wanted" ] || { cat out.txt err.txt; fail "exit code $code, not $wanted: $*"; }
  while read -r word; do
    grep -qF -- "$word" out.txt err.txt || { cat out.txt err.txt; fail "no word of '$word': $*"; }
  done <<<"$words"
}
