#!/usr/bin/env bash
# page.sh MIMIK FOLDER SHARED: the page of an experiment, made by a run and made again.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_workspace
cat >'smile <b>.toml' <<'END'
schema = 1
workspace = "work1"
expressions = ["12", "4"]
methods = ["sparse", "sparse-mean"]
[subjects]
sources = { next = 1 }
END
MIMIK_PAGE=$PWD/nowhere "$mimik" run 'smile <b>.toml' -o out >summary.txt 2>err.txt
[ ! -e out/report.html ] || fail "a page without its script"
[ "$(grep -c '^note: report.html: not made, since .*page.js is not there; install npm' err.txt)" -eq 1 ] || { cat err.txt; fail "no word of the missing page"; }
expect_code 2 "install npm" env MIMIK_PAGE="$PWD/nowhere" "$mimik" report out
claim "without the page's script a run is whole, and one line says how to get it"

# Template and style are the sources' own; the script needs npm, and what it does is tested in a browser.
mkdir parts
cp "$(dirname "${BASH_SOURCE[0]}")"/../../report/page/{page.mustache,style.css} parts/
echo 'document.title = "made";' >parts/page.js
export MIMIK_PAGE=$PWD/parts
"$mimik" report out >said.txt
grep -q '^out/report.html: .* MB$' said.txt || { cat said.txt; fail "what was made"; }
cp out/report.html first.html
"$mimik" report out --threads 1 --quiet >/dev/null
cmp first.html out/report.html
"$mimik" run 'smile <b>.toml' -o again --quiet --threads 2 >/dev/null
cmp first.html again/report.html
"$mimik" run 'smile <b>.toml' -o merged --shard 1/1 --quiet >/dev/null
"$mimik" merge merged --quiet >/dev/null
cmp first.html merged/report.html
! grep -q "$PWD" out/report.html || fail "a path of this machine is in the page"
claim "a run, a report and a merge make the same page, on any number of threads"

[ "$(stat -c %s out/report.html)" -lt 30000000 ] || fail "the page is too large"
! grep -q '<b>' <(sed '/<script>/,$d' out/report.html | grep '<title>\|<h1>') || fail "a file's name is markup"
grep -q '<h1>smile &lt;b&gt;</h1>' out/report.html || fail "the title"
! grep -qE '(src|href)="?(https?:)?//' out/report.html || fail "the page asks for something else"
claim "a page is below 30 MB, escapes what files are called, and asks for nothing"

"$mimik" report out --faces 0 --quiet --json >report.json
grep -q '"page": "out/report.html"' report.json || { cat report.json; fail "json"; }
grep -q '<script type="application/json" id="page-faces">null</script>' out/report.html || fail "faces, though none were wanted"
"$mimik" report out --target bs001 --method sparse --quiet >/dev/null
grep -q '"target":"bs001"' out/report.html && ! grep -q '"target":"bs000"' out/report.html || fail "another face"
expect_code 2 "target 'bs009'" "$mimik" report out --target bs009
expect_code 2 "method 'thesis' is none of the experiment; it has sparse, sparse-mean" "$mimik" report out --method thesis
mv work1 moved
expect_code 2 "work1" "$mimik" report out
"$mimik" report out --workspace moved --quiet >/dev/null
cmp first.html out/report.html
"$mimik" report out --no-workspace --quiet >/dev/null
expect_code 2 "is no finished experiment" "$mimik" report moved
claim "faces and methods are chosen, and a workspace that was moved is named"

# The tutorial's Python lines on these results say what the statistics say.
if command -v python3 >/dev/null; then
  mv out results
  sed -n '/^```python$/,/^```$/p' "$(dirname "${BASH_SOURCE[0]}")/../../docs/tutorial.md" | sed '/^```/d' >load.py
  python3 load.py | tr -d '\r' | sort >loaded.csv
  awk -F, '$1 == "zone" && $2 != "" { print $3 "," $2 "," $4 "," $6 }' results/statistics/methods.csv | sort >told.csv
  [ -s told.csv ] || fail "no statistics"
  grep -xFf told.csv loaded.csv | diff - told.csv || fail "the tutorial's lines"
  claim "rows are loaded as the tutorial prints it"
fi
