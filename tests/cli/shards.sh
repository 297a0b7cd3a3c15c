#!/usr/bin/env bash
# shards.sh MIMIK FOLDER SHARED: an experiment in parts, each on its own, and one of all.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_database
borrow_workspace
cat >smile.toml <<'END'
schema = 1
workspace = "work1"
expressions = ["12", "4"]
methods = ["thesis", "sparse-mean"]
END
results="experiment.json rows.csv rows.sqlite scores.json scores.csv summary.md tables/explained.tex tables/error_mm.tex tables/intervals.tex statistics/methods.csv statistics/differences.csv statistics/source_dependence.csv manifest.json"
expect_same() {  # folder, folder
  local file
  for file in $results; do cmp "$1/$file" "$2/$file" || fail "$file of $2 is another"; done
}
"$mimik" run smile.toml -o whole --quiet >/dev/null

# Six units in four shards: 1, 2, 1, 2. Two at the same time, in no order.
"$mimik" run smile.toml -o parts --shard 4/4 --quiet >/dev/null &
"$mimik" run smile.toml -o parts --shard 2/4 --quiet >/dev/null
wait $!
expect_code 2 "parts: 2 shards of 4 missing: 1, 3; make each with 'mimik run $PWD/smile.toml -o parts --shard 1/4'" "$mimik" merge parts
[ "$("$mimik" merge parts --list-missing)" = "1,3" ] || fail "list of the missing"
[ ! -e parts/rows.csv ]
for k in 3 1; do "$mimik" run smile.toml -o parts --shard $k/4 --quiet >/dev/null; done
[ -z "$("$mimik" merge parts --list-missing)" ]
"$mimik" merge parts --quiet >summary.txt
expect_same whole parts
cmp summary.txt parts/summary.md
"$mimik" verify parts --quiet >verified.txt
grep -q ' equal$' verified.txt
claim "shards make the same bytes as one run, and what is missing is named with its command"

# More shards than units: the empty ones are files, too.
for k in $(seq 8); do "$mimik" run smile.toml -o many --shard $k/8 --quiet >/dev/null; done
"$mimik" merge many --quiet >/dev/null
expect_same whole many
claim "there may be more shards than units"

# An attempt that was killed: its whole units count, its torn tail does not.
"$mimik" run smile.toml -o torn --shard 1/1 --quiet >/dev/null
cp torn/shards/1-of-1.rows all.rows
lines=$(grep -n '^# unit 12 bs001' all.rows | cut -d: -f1)
{ head -n "$lines" all.rows; echo 'bs001,bs002,12,the'; } >torn/shards/1-of-1.0123456789abcdef.part
head -c 20 all.rows >torn/shards/1-of-1.0123456789abcdee.part
rm torn/shards/1-of-1.rows
"$mimik" run smile.toml -o torn --shard 1/1 >out.txt 2>err.txt
grep -q '^shard 1/1: 6 units (2 of an earlier attempt) in ' out.txt || { cat out.txt; fail "what was found"; }
cmp torn/shards/1-of-1.rows all.rows
[ "$(ls torn/shards)" = "$(printf '1-of-1.json\n1-of-1.rows')" ] || fail "attempts are left"
"$mimik" run smile.toml -o torn --shard 1/1 >out.txt 2>err.txt
grep -q 'was run already' err.txt
claim "a done unit is never done again, and a torn tail is dropped"

sed -i '0,/,mm,/s//,cm,/' torn/shards/1-of-1.rows
expect_code 2 "torn/shards/1-of-1.rows: is damaged after byte
remove it, and make it again" "$mimik" merge torn
sed 's/"12", "4"/"4"/' smile.toml >other.toml
expect_code 2 "torn: holds another experiment (experiment/expressions/0/code is " "$mimik" run other.toml -o torn --shard 1/1
"$mimik" run other.toml -o other --shard 1/1 --quiet >/dev/null
cp other/shards/1-of-1.rows torn/shards/1-of-1.rows
expect_code 2 "torn/shards/1-of-1.rows: holds rows of another experiment; remove it" "$mimik" merge torn
"$mimik" run smile.toml -o parts2 --shard 1/2 --quiet >/dev/null
"$mimik" run smile.toml -o parts2 --shard 1/3 --quiet >/dev/null
expect_code 2 "cut into 2 and 3 parts; say which with --shards" "$mimik" merge parts2
expect_code 2 "1 shard of 2 missing: 2; make it with" "$mimik" merge parts2 --shards 2
expect_code 2 "work1: holds no shard of an experiment that is whole" "$mimik" merge work1
for bad in 0/4 5/4 4 a/b 1/0 1/100001; do expect_code 2 "shard '$bad' is none; give i/n" "$mimik" run smile.toml -o x --shard "$bad"; done
[ ! -e x ]
claim "damaged, foreign and mixed shards are named"

# Every vertex of the cases that were asked for, the same from shards.
cat >vertices.toml <<'END'
schema = 1
workspace = "work1"
expressions = ["12"]
methods = ["sparse", "sparse-mean"]
magnitudes = [0.8, 1]
[output]
per_vertex = ["bs000:12:sparse@0.8", "bs001:12:sparse-mean", "bs001:12:sparse:bs002"]
END
"$mimik" run vertices.toml -o vertices --quiet >/dev/null
[ "$(ls vertices/per_vertex | tr '\n' ' ')" = "bs000_12_sparse@0.8_bs001.ply bs000_12_sparse@0.8_bs002.ply bs001_12_sparse-mean_mean.ply bs001_12_sparse_bs002.ply cases.csv " ] || { ls vertices/per_vertex; fail "the cases"; }
head -c 2000 vertices/per_vertex/bs001_12_sparse_bs002.ply | grep -aq 'property double error_mm' || fail "no error per vertex"
row=$(grep '^bs002,bs001,12,sparse,1,surface_distance,zone,mean,' vertices/rows.csv | cut -d, -f9)
listed=$(grep '^bs001_12_sparse_bs002.ply,' vertices/per_vertex/cases.csv | cut -d, -f8)
awk -v a="$row" -v b="$listed" 'BEGIN { d = a - b; exit !(a > 0 && d < 1e-12 && d > -1e-12) }' || fail "the mean is $listed, the row says $row"  # rounding
for k in 1 2; do "$mimik" run vertices.toml -o vertices2 --shard $k/2 --quiet >/dev/null; done
"$mimik" merge vertices2 --quiet >/dev/null
expect_same vertices vertices2
diff -r vertices/per_vertex vertices2/per_vertex
sed 's/bs001:12:sparse:bs002/bs001:4:sparse/' vertices.toml >bad.toml
expect_code 2 "bad.toml:7: output.per_vertex: case \"bs001:4:sparse\": expression '4' is not run" "$mimik" run bad.toml -o x
sed 's/bs001:12:sparse:bs002/bs001:12:thesis/' vertices.toml >bad.toml
expect_code 2 "method 'thesis' is not run" "$mimik" run bad.toml -o x
sed 's/bs001:12:sparse:bs002/bs001:12/' vertices.toml >bad.toml
expect_code 2 "bad.toml:7: case 'bs001:12' is none; give TARGET:EXPRESSION:METHOD" "$mimik" run bad.toml -o x
rm -rf x
# A scan that cannot be read costs its own file and no more.
cp -r work1 work2
face=$(find work2/faces -name 'bs000_LFAU_12_0.ply')
head -c 1000 "$face" >cut.ply
mv cut.ply "$face"
sed 's/work1/work2/; s/^expressions.*/expressions = ["12", "4"]/; s/^per_vertex.*/per_vertex = ["bs000:12:sparse", "bs000:4:sparse:bs001"]/' vertices.toml >cut.toml
expect_code 1 "no case of target 'bs000' and expression '12'" "$mimik" run cut.toml -o cut
[ "$(ls cut/per_vertex | tr '\n' ' ')" = "bs000_4_sparse_bs001.ply cases.csv " ] && [ -e cut/manifest.json ] || { ls cut cut/per_vertex; fail "the cases of a cut scan"; }
claim "errors per vertex are those whose mean is the row, from shards, too"

# Somebody else's files stay, those of shards go.
mkdir -p parts/tables
echo mine >parts/tables/mine.tex
"$mimik" run other.toml -o parts --anew --quiet >/dev/null
[ "$(cat parts/tables/mine.tex)" = mine ] && [ ! -e parts/shards ] || fail "--anew took too much or too little"
! grep -q mine.tex parts/manifest.json || fail "somebody else's file is sealed"
claim "--anew removes what a run wrote and nothing else"

# From a database: preprocessed once, before all shards.
sed 's/^workspace.*/database = "db1"/; s/"12", "4"/"12"/' smile.toml >fresh.toml
expect_code 2 "fresh: the scans are not preprocessed yet; run 'mimik run fresh.toml -o fresh --only-preprocess' once" "$mimik" run fresh.toml -o fresh --shard 1/2
"$mimik" run fresh.toml -o fresh --only-preprocess --quiet >ready.txt
grep -q '^fresh: ready for 3 units$' ready.txt || { cat ready.txt; fail "only preprocess"; }
for k in 1 2; do "$mimik" run fresh.toml -o fresh --shard $k/2 --quiet >/dev/null; done
"$mimik" merge fresh --quiet >/dev/null
"$mimik" run fresh.toml -o fresh1 --quiet >/dev/null
expect_same fresh1 fresh
sed 's/"12"/"4"/' fresh.toml >fresh4.toml
expect_code 2 "preprocessed.json: other expressions were preprocessed" "$mimik" run fresh4.toml -o fresh --shard 1/2
mkdir db2
expect_code 2 "preprocessed.json: scans of $PWD/db1 were preprocessed, not of $PWD/db2" "$mimik" run fresh.toml --database db2 -o fresh --shard 1/2
"$mimik" run fresh.toml --database db1/ -o fresh --shard 1/2 --quiet >/dev/null
# The folder is whole: a shard whose rows were removed is made again.
cp fresh/shards/1-of-2.rows first.rows
rm fresh/shards/1-of-2.rows
"$mimik" run fresh.toml -o fresh --shard 1/2 --quiet >/dev/null
cmp first.rows fresh/shards/1-of-2.rows
"$mimik" run fresh.toml -o fresh --anew --quiet >/dev/null
[ ! -e fresh/preprocessed.json ] && [ ! -e fresh/faces.json ] || fail "--anew leaves marks of shards"
claim "preprocessing is done once, and asked for where it is missing"
