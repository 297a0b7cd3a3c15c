#!/usr/bin/env bash
# page_in_chromium.sh MIMIK FOLDER SHARED: the page in a browser. Ends with 77 where there is no browser, no node, or no
# script of the page.
set -euo pipefail
browser_test=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)/page/page_in_chromium.mjs
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

chromium=$(command -v chromium || true)
[ -n "$chromium" ] || { echo "skipped: there is no chromium (scripts/setup.sh --browser)"; exit 77; }
command -v node >/dev/null || { echo "skipped: there is no node (scripts/setup.sh --page)"; exit 77; }
[ -s "$(dirname "$mimik")/../share/mimik/report/page.js" ] || { echo "skipped: the page's script was not built"; exit 77; }

borrow_workspace
cat >faces.toml <<'END'
schema = 1
workspace = "work1"
expressions = ["12", "4", "12L"]
methods = ["thesis", "default", "mean"]
END
"$mimik" run faces.toml -o out --quiet >/dev/null
mkdir pictures
if can_draw; then
  for subject in bs000 bs001 bs002; do
    "$mimik" figure -o pictures/figure_$subject.png work1/faces/$subject/${subject}_N_N_0.ply --size 500x500 --quiet >/dev/null
  done
fi
node "$browser_test" "$chromium" out/report.html pictures
