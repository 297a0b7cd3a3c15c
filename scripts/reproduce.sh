#!/usr/bin/env bash
# reproduce.sh [--face-model DIR] [--out DIR] [--seed N]: installs what is missing, builds, and runs the main job on faces
# that Mimik makes itself: a database of 12 subjects, preprocessing, models of the thesis's nine Action Units, animated
# faces, figures, and the experiment of experiments/thesis.toml: all 12 targets, of each the next four subjects as
# sources (432 of the 1188 pairs of two people and an expression). It ends with the page of the experiment and a sheet of
# pictures. With --face-model (a clone of ICT-FaceKit) the same on faces from scanned people.
set -euo pipefail
stand=$PWD  # where the user stands: relative folders start here
cd "$(dirname "$0")/.."

out=$PWD/out/reproduce
seed=1
model=()
usage="give --face-model DIR, --out DIR or --seed N"
while [ $# -gt 0 ]; do
  [ $# -gt 1 ] || { echo "reproduce.sh: nothing stands after '$1'; $usage" >&2; exit 2; }
  case "$1" in
    --face-model) model=(--face-model "$(cd "$stand" && realpath -ms "$2")") ;;
    --out) out=$(cd "$stand" && realpath -ms "$2") ;;
    --seed) seed=$2 ;;
    *) echo "reproduce.sh: there is no option '$1'; $usage" >&2; exit 2 ;;
  esac
  shift 2
done
# Only what an earlier run made is made anew; anything else in the folder is not ours to touch.
mark=$out/.mimik-reproduce
if [ -d "$out" ] && [ -n "$(ls -A "$out")" ] && [ ! -e "$mark" ]; then
  echo "reproduce.sh: $out is not empty and was not made by reproduce.sh; give another --out" >&2
  exit 2
fi

scripts/setup.sh --page
launcher=$(command -v ccache || true)
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1  # clones in other folders share the cache
# The folder of scripts/test.sh: what the one has built the other need not.
cmake --preset release ${launcher:+-DCMAKE_CXX_COMPILER_LAUNCHER="$launcher"}
cmake --build --preset release --target mimik mimik-figure report_page
mimik=$PWD/build/release/bin/mimik

step() { printf '\n[%s/%s] %s\n' "$1" 6 "$2"; }
mkdir -p "$out"
touch "$mark"
rm -rf "$out"/{database,workspace,animated,figures,scores,thesis}
mkdir "$out/animated" "$out/figures"
begin=$SECONDS

step 1 "Make a database of 12 subjects (seed $seed)"
"$mimik" synthesize "$out/database" --subjects 12 --seed "$seed" "${model[@]}"

step 2 "Preprocess it: clean, resample to 150x150, average face, normalise"
"$mimik" preprocess "$out/database" -o "$out/workspace"

step 3 "Model AU 1, 2, 4, 12, 14, 15, 17, 20 and 12 left on the average face"
"$mimik" model "$out/workspace" --source mean --expression 1,2,4,12,14,15,17,20,12L

step 4 "Animate neutral faces and compare them with the synthetic scans: Figs 6-1 to 6-3, 6-6 and 5-12"
source=bs000
target=bs001
"$mimik" panels "$out/workspace" --source "$source" --target "$target" --au 4,12,15,12L -o "$out/figures" --quiet
"$mimik" panels "$out/workspace" --source "$source" --target "$target" --au 4,12,15,12L --method thesis -o "$out/figures" --quiet
"$mimik" panels "$out/workspace" --source mean --target "$target" --au 4,12,15,12L -o "$out/figures" --quiet
"$mimik" panels "$out/workspace" --source mean --target "$target" --au 4,12 --series 0,0.25,0.5,0.75,1 -o "$out/figures" --quiet
"$mimik" animate "$out/workspace" --source mean --target "$target" --au 12L --au 12R --au 1 -o "$out/animated/$target.glb" --quiet
for method in default thesis; do
  "$mimik" animate "$out/workspace" --source "$source" --target "$target" --au 12 --method "$method" --quiet \
    -o "$out/animated/${target}_AU12_from_${source}_$method.ply"
done
neutrals=()
captions=()
for folder in "$out"/database/bs*; do
  neutrals+=("$folder/$(basename "$folder")_N_N_0.bnt")
  captions+=(--caption "$(basename "$folder")")
done
"$mimik" figure -o "$out/figures/subjects.png" --title "Synthetic subjects, a neutral scan each" --columns 6 --size 260x320 --quiet "${neutrals[@]}" "${captions[@]}"

step 5 "Run experiments/thesis.toml: six methods beside doing nothing and the true fields"
"$mimik" run experiments/thesis.toml --workspace "$out/workspace" -o "$out/thesis"

step 6 "Draw the sheet of pictures, and check the scans as 'mimik scans --check' does"
sheet=()
for au in 4 12 15 12_L; do  # as the folders of the panels are called
  by() { echo "$out/figures/AU${au}_$1/target_$2.ply"; }
  sheet+=("$(by "${source}_on_${target}_default" neutral)" --caption "AU $au: neutral"
    "$(by "${source}_on_${target}_thesis" animated)" --caption "thesis" "$(by "${source}_on_${target}_default" animated)" --caption "default"
    "$(by "mean_on_${target}_default" animated)" --caption "mean" "$(by "${source}_on_${target}_default" real)" --caption "synthetic scan")
done
"$mimik" figure -o "$out/figures/sheet.png" --title "$target by three methods (synthetic faces)" --columns 5 --size 260x320 --quiet "${sheet[@]}"
"$mimik" scans "$out/database" --check --no-index --quiet | tail -n 3 || true

printf '\nDone in %d s. Page: %s  Sheet: %s  Faces: %s  Database: %s  Program: %s\n' $((SECONDS - begin)) \
  "$out/thesis/report.html" "$out/figures/sheet.png" "$out/animated/" "$out/database/" "$mimik"
