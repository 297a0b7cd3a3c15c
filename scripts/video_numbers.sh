#!/usr/bin/env bash
# video_numbers.sh [CLIPS]: tables of docs/results.md on faces in video: `mimik capture` by the paper's tracker and by
# dlib, on a rendered performance with its truth, on a rendered face at rest, and on the clips of scripts/fetch_clips.sh
# (out/clips, or CLIPS), beside each other. Work files stay in out/video_numbers. Needs build/release; dlib if there is.
set -euo pipefail
cd "$(dirname "$0")/.."
clips=${1:-$PWD/out/clips}
program=${MIMIK_VIDEO:-$PWD/build/release/bin/mimik-video}
[ -x "$program" ] || { echo "video_numbers.sh: $program is missing; run scripts/setup.sh --video and build" >&2; exit 2; }
work=$PWD/out/video_numbers
mkdir -p "$work"
cd "$work"

[ -s rendered.mp4 ] || "$program" render -o rendered --frames 240 --seed 1 >/dev/null
[ -s still.mp4 ] || "$program" render -o still --frames 120 --seed 2 --head-motion 0 --expression 0 --light-change 0 >/dev/null

follow() {  # name video tracker; where it fails, nothing of an earlier run is left to be taken for its numbers
  rm -f "$1.$3.csv" "$1.$3.68.csv" "$1.$3.png" "$1.$3.json"
  "$program" track "$2" -o "$1.$3.csv" --landmarks68 "$1.$3.68.csv" --sheet "$1.$3.png" --tracker "$3" --json >"$1.$3.json"
}
for name in rendered still; do
  for tracker in paper dlib; do follow "$name" "$name.mp4" "$tracker" || echo "$name: no $tracker" >&2; done
done
names=()
for clip in "$clips"/*.mp4; do
  [ -e "$clip" ] || { echo "video_numbers.sh: no clips in $clips; scripts/fetch_clips.sh fetches them" >&2; break; }
  name=$(basename "$clip" .mp4)
  names+=("$name")
  for tracker in paper dlib; do follow "$name" "$clip" "$tracker" || echo "$name: no $tracker" >&2; done
done

python3 - "${names[@]}" <<'TABLE'
import csv, json, math, os, statistics, sys

def points(file):
    rows = []
    for row in csv.reader(open(file)):
        if row[0] == "frame": continue
        rows.append([float(v) for v in row[2:]] if row[1] == "1" else None)
    return rows

def eyes(p): return math.hypot(p[90] - p[72], p[91] - p[73])

def error(a, b, first, last):
    return [100 * math.hypot(a[2 * k] - b[2 * k], a[2 * k + 1] - b[2 * k + 1]) / eyes(b) for k in range(first, last + 1)]

def pooled(seen, true, first, last):
    all = [e for a, b in zip(seen, true) if a and b for e in error(a, b, first, last)]
    return statistics.median(all) if all else float("nan")

def median_of_frames(pairs):
    all = [e for a, b in pairs if a and b for e in error(a, b, 17, 67)]
    return statistics.median(all) if all else float("nan")

def jitter(seen, where):
    """rms of the points 17 to 67 about their mean over ten frames, % of the eyes; of the stillest tenth of such windows
    by `where`, after the head's shift is taken off"""
    windows = []
    for start in range(0, len(seen) - 10, 5):
        rows, judge = seen[start:start + 10], where[start:start + 10]
        if not all(rows) or not all(judge): continue
        def spread(rows):
            total = count = 0
            rows = [[v - sum(r[34 + a::2]) / 51 for a, v in zip([0, 1] * 51, r[34:])] for r in rows]
            for k in range(102):
                mean = sum(r[k] for r in rows) / len(rows)
                total += sum((r[k] - mean) ** 2 for r in rows)
                count += len(rows)
            return math.sqrt(2 * total / count)
        windows.append((spread(judge), 100 * spread(rows) / eyes(rows[0])))
    windows.sort()
    still = [w[1] for w in windows[:max(1, len(windows) // 10)]]
    return statistics.median(still) if still else float("nan")

print("| video | tracker | beside | frames with the face | inner points 17-67 | brows | eyes | mouth | first tenth | last tenth | still | frames a second |")
print("| --- | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
for name in ["rendered", "still"] + sys.argv[1:]:
    made = os.path.exists(f"{name}_points.csv")
    for tracker in ("paper", "dlib"):
        if not os.path.exists(f"{name}.{tracker}.68.csv") or not os.path.getsize(f"{name}.{tracker}.json"): continue
        said = json.load(open(f"{name}.{tracker}.json"))
        seen = points(f"{name}.{tracker}.68.csv")
        reference = f"{name}_points.csv" if made else f"{name}.dlib.68.csv"
        # Without a reference there is nothing to be beside: a tracker compared with itself would be without fault.
        known = os.path.exists(reference)
        true = points(reference) if known else [None] * len(seen)
        both = [(a, b) for a, b in zip(seen, true) if b]
        tenth = max(1, len(both) // 10)
        rate = said["frames"] / said["tracking_s"]
        cells = [pooled(seen, true, 17, 67), pooled(seen, true, 17, 26), pooled(seen, true, 36, 47), pooled(seen, true, 48, 67),
                 median_of_frames(both[:tenth]), median_of_frames(both[-tenth:])]
        if not known: both = [(a, a) for a in seen]
        found = sum(1 for a, b in both if a)
        cells.append(jitter(seen, true if known else seen))
        print(f"| {name} | {tracker} | {'truth' if made else 'dlib' if known else ''} | {found} of {len(both)} |",
              " | ".join("" if math.isnan(c) else f"{c:.2f}" for c in cells), f"| {rate:.0f} |")
TABLE
