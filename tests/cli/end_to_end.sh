#!/usr/bin/env bash
# end_to_end.sh MIMIK FOLDER SHARED: the whole way of a user once more, on one thread instead of two.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

# A workspace names its database, so both are made of the same one.
"$mimik" synthesize db1 --subjects 3 --expressions 4,12,12L --seed 5 --threads 1 --quiet
diff -r "$shared/db1" db1
claim "a database is the same on 1 thread and on 2"
"$mimik" preprocess "$shared/db1" -o work1 --threads 1 --quiet >/dev/null 2>&1
diff -r "$shared/work1" work1
claim "so is a workspace"
for threads in 1 2; do
  "$mimik" evaluate work1 --expression 4,12,12L --threads "$threads" -o "scores$threads" --json --quiet >"scores$threads.json"
  "$mimik" animate work1 --source mean --target bs001 --au 12L --au 4:0.5 -o "face$threads.glb" --threads "$threads" --quiet
done
cmp scores1.json scores2.json
diff -r scores1 scores2
claim "so are the scores"
cmp face1.glb face2.glb
claim "so is an animated face"
