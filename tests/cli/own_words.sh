#!/usr/bin/env bash
# own_words.sh MIMIK FOLDER SHARED: an expression that only the database has a word for, from its manifest to its scores.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

# The built-in faces' AU 12 and AU 4 under words of their own.
mkdir own
echo "subject,expression,scan,landmarks" >own/manifest.csv
for subject in bs000 bs001 bs002; do
  mkdir "own/$subject"
  while read -r word scan; do
    cp "$shared/db1/$subject/${subject}_$scan.bnt" "$shared/db1/$subject/${subject}_$scan.lm3" "own/$subject/"
    echo "$subject,$word,$subject/${subject}_$scan.bnt,$subject/${subject}_$scan.lm3" >>own/manifest.csv
  done <<<$'N N_N_0\nsneer LFAU_12_0'
done
sed -i '$d' own/manifest.csv  # bs002 has a word of another spelling
echo "bs002,SNEER,bs002/bs002_LFAU_12_0.bnt,bs002/bs002_LFAU_12_0.lm3" >>own/manifest.csv

"$mimik" preprocess own -o work --quiet >/dev/null
"$mimik" model work --source bs000,mean --expression sneer -o models --quiet >/dev/null
[ -s models/bs000/SNEER.json ] && [ -s models/mean/SNEER.json ]
"$mimik" animate work --source bs000 --target bs001 --au sneer:0.5 -o measured.glb --quiet >/dev/null
"$mimik" animate work --target bs001 --model models/bs000/SNEER.json:0.5 -o stored.glb --quiet >/dev/null
same_but_for_origin measured.glb stored.glb
"$mimik" evaluate work --expression Sneer --method default,mean -o scores --quiet >/dev/null
[ "$(grep -c '^bs00.,bs00.,SNEER,default,1,surface_distance,zone,mean,' scores/cases.csv)" -eq 6 ]
expect_json scores/scores.json rows cases 6
awk -F: '/"explained"/ { if ($2 + 0 > 0.1) good = 1 } END { exit !good }' scores/scores.json || fail "a smile by another name is not explained"
claim "a word of the database's own is preprocessed, modelled, animated and scored"

expect_code 2 $'neither an AU\nnor a word of this workspace (SNEER)' "$mimik" animate work --target bs001 --au snear -o x.ply
expect_code 1 $'SNEER\nno muscle points' "$mimik" model work --source bs000 --expression sneer --method thesis -o thesis --quiet
claim "what no scan shows is named with the words there are, and the thesis says that it has no points for one"

[ "$("$mimik" evaluate work --expression sneer,17 --method default -o more --json 2>/dev/null | grep -c "expression '17': left out: 0 subjects show it")" -eq 1 ] || fail "AU 17 is not named"
grep -q ',SNEER,default,' more/cases.csv
expect_code 1 "expression '17'" "$mimik" evaluate work --expression sneer,17 --method default -o more
expect_code 2 "expression '17'" "$mimik" evaluate work --expression 17 -o none
[ ! -e none ]
claim "an expression that nobody shows is named (1), and the rest is scored"

"$mimik" evaluate work --expression sneer --method default --quiet >/dev/null
grep -q ',SNEER,default,' work/scores/cases.csv
claim "rows of every case are kept also where nobody named a folder"
