#!/usr/bin/env bash
# faults.sh MIMIK FOLDER SHARED: a disk that is full, a folder that takes nothing, a scan that vanishes half way.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

borrow_workspace
cat >smile.toml <<'END'
schema = 1
workspace = "work1"
expressions = ["12", "4"]
methods = ["thesis", "sparse-mean"]
END
"$mimik" run smile.toml -o whole --quiet >/dev/null
rows=$(stat -c %s whole/rows.csv)

# A file may not grow beyond a few kB: what a full disk is to whoever writes. SIGXFSZ is ignored, so that write() fails.
limited() {  # blocks of 1024 bytes, command ...
  local blocks=$1
  shift
  (trap '' XFSZ; ulimit -f "$blocks"; exec "$@")
}
# Some targets fit, the next does not.
fits=$((rows / 2 / 1024))
[ "$fits" -ge 2 ] || fail "too few rows to cut ($rows bytes)"
expect_code 2 "full/rows.part: takes no more (disk full?)" limited "$fits" "$mimik" run smile.toml -o full --quiet
done_units=$(grep -c '^# unit .* bs' full/rows.part || true)
[ "$done_units" -ge 1 ] || fail "what was done is lost"
"$mimik" run smile.toml -o full >/dev/null 2>err.txt
grep -q '^going on after ' err.txt || { cat err.txt; fail "it begins again"; }
for file in rows.csv rows.sqlite scores.json manifest.json; do cmp "whole/$file" "full/$file"; done
expect_code 2 "takes no more (disk full?)" limited "$fits" "$mimik" run smile.toml -o parts --shard 1/1 --quiet
"$mimik" run smile.toml -o parts --shard 1/1 >out.txt 2>/dev/null
grep -q ' of an earlier attempt) in ' out.txt || { cat out.txt; fail "the shard begins again"; }
"$mimik" merge parts --quiet >/dev/null
cmp whole/rows.csv parts/rows.csv
# All rows fit, their tables do not: the rows stay.
expect_code 2 "full2/rows.sqlite: cannot be written" limited $((rows * 5 / 4 / 1024 + 2)) "$mimik" run smile.toml -o full2 --quiet
[ -s full2/rows.part ] && [ ! -e full2/manifest.json ] || fail "the rows are gone"
"$mimik" run smile.toml -o full2 --quiet >/dev/null
cmp whole/rows.sqlite full2/rows.sqlite
claim "a full disk is named, and what was done stays"

# Root may write anywhere, so that somebody else tries.
as_nobody=()
if [ "$(id -u)" -eq 0 ]; then as_nobody=(setpriv --reuid=65534 --regid=65534 --clear-groups); fi
mkdir closed
cp whole/experiment.json closed
chmod 555 closed
if "${as_nobody[@]}" "$mimik" --version >/dev/null 2>&1; then
  expect_code 2 "closed: " "${as_nobody[@]}" "$mimik" run smile.toml -o closed --quiet
  expect_code 2 "closed: " "${as_nobody[@]}" "$mimik" run smile.toml -o closed --shard 1/2 --quiet
  [ "$(ls closed)" = experiment.json ] || fail "something was written"
fi
chmod 755 closed
expect_code 2 "/proc/mimik" "$mimik" run smile.toml -o /proc/mimik --shard 1/2
expect_code 2 "mimik: rows.txt: is a file; give a folder" bash -c "touch rows.txt; '$mimik' run smile.toml -o rows.txt --shard 1/2"
claim "a folder that takes no files is named before any work"

# One expressive scan goes while the run is under way: of whom it was is said, and the others are scored.
cp -r work1 work2
# One thread and many methods: between the first target of AU 4 and the first look at AU 12 lie two targets.
sed 's/work1/work2/; s/"12", "4"/"4", "12"/; s/^methods.*/methods = ["thesis", "thesis-half", "default", "mean", "sparse", "displacement-copy", "deformation-transfer"]/' smile.toml >vanish.toml
echo 'magnitudes = [0.6, 0.8, 1, 1.2]' >>vanish.toml
"$mimik" run vanish.toml -o vanish --threads 1 --quiet >/dev/null 2>&1 &
run=$!
for _ in $(seq 3000); do
  { grep -q '^# unit 4 bs000' vanish/rows.part; } 2>/dev/null && break
  kill -0 $run 2>/dev/null || break
  sleep 0.01
done
kill -STOP $run 2>/dev/null || true
gone=$(find work2 -name 'bs002_LFAU_12_0.ply')
rm "$gone"
kill -CONT $run 2>/dev/null || true
code=0
wait $run || code=$?
case $code in
  1) grep -q 'bs002_LFAU_12_0.ply' vanish/summary.md || { cat vanish/summary.md; fail "the scan is not named"; } ;;
  0) fail "a scan that is gone was scored" ;;
  *) fail "ended with $code" ;;
esac
grep -q ',bs001,4,' vanish/rows.csv && grep -q ',bs001,12,\|left out' vanish/rows.csv vanish/summary.md || fail "the others are not scored"
# The next run says which face is gone, and mixes nothing.
expect_code 2 "bs002_LFAU_12_0.ply: there is no such file" "$mimik" run vanish.toml -o vanish
claim "a scan that vanishes is named, and the others are scored"
