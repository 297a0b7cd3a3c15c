#!/usr/bin/env bash
# results.sh [WORLD...] [--data DIR] [--out DIR] [--write]: makes docs/measured/WORLD.md anew, each whole, from experiments/
# by Mimik's commands alone. Worlds: builtin (12 people that Mimik makes), ict (14 of ICT-FaceKit), makehuman (8 heads with
# artists' expressions). The last two are in the folders ict-facekit and makehuman-world of --data (or of the variable
# MIMIK_SHARED_DATA), and are left out with a word where they are not there. What --out has already is not made again.
# --write puts the pages into docs/measured. Two cores take about half an hour; MIMIK names another program than that of
# build/release.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
data=${MIMIK_SHARED_DATA:-}
out=$root/out/results
write=no
worlds=()
while [ $# -gt 0 ]; do
  case "$1" in
    builtin | ict | makehuman) worlds+=("$1") ;;
    --data | --out)
      [ $# -gt 1 ] || { echo "results.sh: $1 needs a folder" >&2; exit 2; }
      [ "$1" = --data ] && data=$2 || out=$2
      shift
      ;;
    --write) write=yes ;;
    *) echo "results.sh: there is no '$1'; give builtin, ict, makehuman, --data DIR, --out DIR or --write" >&2; exit 2 ;;
  esac
  shift
done
[ ${#worlds[@]} -gt 0 ] || worlds=(builtin ict makehuman)
mimik=${MIMIK:-$root/build/release/bin/mimik}
[ -x "$mimik" ] || { echo "results.sh: $mimik is missing; run scripts/test.sh or scripts/reproduce.sh first" >&2; exit 2; }
mkdir -p "$out"
cd "$out"

say() { printf 'results.sh: %s\n' "$*" >&2; }
# 1: done, with failures that the result lists.
tolerant() { "$@" || [ $? -eq 1 ]; }

database() {  # world: the folder of its scans
  case "$1" in
    builtin) [ -d builtin/database ] || "$mimik" synthesize builtin/database --subjects 12 --seed 1 --expressions all --quiet >/dev/null ;;
    ict) [ -d ict/database ] || "$mimik" synthesize ict/database --subjects 14 --seed 1 --face-model "$data/ict-facekit" --expressions all --quiet >/dev/null ;;
  esac
  [ "$1" = makehuman ] && echo "$data/makehuman-world" || echo "$1/database"
}
workspace() {  # world, landmark error in mm
  "$mimik" preprocess "$(database "$1")" -o "$1/work-$2" --landmark-error "$2" --quiet >/dev/null
}
experiment() {  # world, file of experiments/, landmark error in mm
  [ -e "$1/$2-$3/manifest.json" ] && return
  say "$1: $2.toml, landmark error $3 mm"
  tolerant "$mimik" run "$root/experiments/$2.toml" --workspace "$1/work-$3" -o "$1/$2-$3" --quiet >/dev/null
}
# What made the runs of a page, each once.
commits() { cat "$1"/*/experiment.json | sed -n 's/^ "commit": "\(.*\)",$/\1/p' | sort -u | paste -sd' '; }
# Tables of a run, up to those of single expressions.
tables() { sed '/^Whose expression it was/,$d' "$1/summary.md"; }

page() {  # world, title
  local world=$1 mm
  for mm in 0 1 2 4; do
    workspace "$world" $mm
    experiment "$world" landmark_error $mm
  done
  experiment "$world" thesis-full 0
  experiment "$world" thesis_on_itself 0
  echo "# Measured: $2"
  echo
  echo "Written by \`scripts/results.sh $world\`, whole: what is changed by hand here is lost. Runs are kept; this page's were made by commit $(commits "$world")"
  printf '\n## Every pair, every method\n\n`experiments/thesis-full.toml`\n\n'
  tables "$world/thesis-full-0"
  printf '\n## Each source on itself\n\n`experiments/thesis_on_itself.toml`\n\n'
  tables "$world/thesis_on_itself-0"
  printf '\n## Landmarks that are marked 0, 1, 2 and 4 mm off\n\n`experiments/landmark_error.toml`; errors of marking are drawn per landmark and scan (`mimik preprocess --landmark-error`).\n\n'
  "$mimik" compare "$world"/landmark_error-{0,1,2,4} --name "0 mm" --name "1 mm" --name "2 mm" --name "4 mm" --quiet |
    sed '/^Differences from the first run/,$d'
  if [ "$world" != makehuman ]; then
    [ -e "$world/estimators/estimators.md" ] || {
      say "$world: estimators against the truth"
      tolerant "$mimik" evaluate "$world/work-0" --check-estimators --method thesis,default,mean -o "$world/estimators" --quiet >/dev/null
    }
    printf '\n## Estimators against the true error\n\n`mimik evaluate WORK --check-estimators`\n\n'
    sed '/^| expression/,$d' "$world/estimators/estimators.md"
    printf '\n## Whether Action Units add up\n\n`mimik additivity WORK`\n\n'
    tolerant "$mimik" additivity "$world/work-0" --quiet
  fi
}

for world in "${worlds[@]}"; do
  case "$world" in
    builtin) title="12 people that Mimik makes" ;;
    ict) title="14 people of ICT-FaceKit" folder=ict-facekit ;;
    makehuman) title="8 heads of MakeHuman" folder=makehuman-world ;;
  esac
  if [ "$world" != builtin ] && [ ! -d "$data/$folder" ]; then
    say "$world: skipped; there is no folder $folder in '$data' (--data)"
    continue
  fi
  mkdir -p "$world"
  page "$world" "$title" >"$world/page.part"
  mv "$world/page.part" "$world/page.md"
  say "$out/$world/page.md"
  [ "$write" = no ] || { mkdir -p "$root/docs/measured" && cp "$world/page.md" "$root/docs/measured/$world.part" && mv "$root/docs/measured/$world.part" "$root/docs/measured/$world.md"; }
done
