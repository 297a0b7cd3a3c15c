#!/usr/bin/env bash
# regions.sh MIMIK FOLDER SHARED: what a shell meets of 'mimik regions', and of its file in 'mimik animate --hold'.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_workspace
"$mimik" regions work1 --quiet >/dev/null
"$mimik" regions work1 --quiet >/dev/null
"$mimik" animate work1 --source bs000 --target bs001 --au 12 --hold nose -o drawn/face.ply --quiet
sed -i 's/,nose$/,mine/' work1/average/regions.csv
"$mimik" animate work1 --source bs000 --target bs001 --au 12 --hold mine -o edited/face.ply --quiet
cmp drawn/face.ply edited/face.ply
expect_code 2 $'regions.csv\n--force' "$mimik" regions work1
grep -q ',mine$' work1/average/regions.csv
claim "edited regions are used where they lie, and kept"
sed '1s/average face .*/average face 0123456789abcdef/' work1/average/regions.csv >other.csv
expect_code 2 "0123456789abcdef" "$mimik" animate work1 --target bs001 --au 12 --hold mine --regions other.csv -o nothing.ply
expect_code 2 "--hold" "$mimik" animate work1 --target bs001 --au 12 --regions other.csv -o nothing.ply
[ ! -e nothing.ply ]
"$mimik" regions work1 --force --quiet >/dev/null
expect_code 2 "'mine'" "$mimik" animate work1 --target bs001 --au 12 --hold mine -o nothing.ply
claim "regions of another face are refused, and names that no region bears"
