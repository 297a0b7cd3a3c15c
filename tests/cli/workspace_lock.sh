#!/usr/bin/env bash
# workspace_lock.sh MIMIK FOLDER SHARED: one writer for a workspace, and a narrower run hides nothing.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"
command -v flock >/dev/null || { echo "skipped: no flock"; exit 0; }

borrow_database
borrow_workspace
# As another mimik does it: the lock is on the folder itself.
exec 9<work1
flock -x 9
expect_code 2 "work1: another mimik process is writing this folder; wait until it has ended" "$mimik" preprocess db1 -o work1
expect_code 2 "work1: another mimik process is writing" "$mimik" animate work1 --source mean --target bs001 --au 4 -o a.ply
flock -u 9
flock -s 9
expect_code 2 "work1: another mimik process is reading this folder" "$mimik" preprocess db1 -o work1
"$mimik" animate work1 --source mean --target bs001 --au 4 -o a.ply --quiet >/dev/null
exec 9<&-
claim "a workspace has one writer or many readers, and a lock ends with its process"

before=$(cd work1 && find . -type f ! -path './models/*' | sort | xargs cat | cksum)
"$mimik" preprocess db1 -o work1 --subject bs000,bs001 --au 4 --json >narrow.json
grep -q '"from_earlier_runs": 9' narrow.json || { cat narrow.json; fail "how many stay"; }
[ "$before" = "$(cd work1 && find . -type f ! -path './models/*' | sort | xargs cat | cksum)" ] || fail "files changed"
"$mimik" animate work1 --source bs002 --target bs001 --au 12 -o b.ply --quiet >/dev/null
claim "a narrower run hides nothing of what a wider one made"

touch work1/faces/bs000/bs000_N_N_0.ply.123-0.part
"$mimik" preprocess db1 -o work1 --quiet >/dev/null
[ -z "$(find work1 -name '*.part')" ] || fail "a half-written file is left"
claim "what a killed run left is removed by the next"
