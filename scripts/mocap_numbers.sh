#!/usr/bin/env bash
# mocap_numbers.sh [FOLDER with ict-facekit and makehuman-world] [--write] [--only motion|labels]: how far faces that
# markers move are from the truth, on two people of each world, and how far labels that are fitted to a new face are;
# fixed seeds. --write makes docs/measured/motion_capture.md and mesh_registration.md anew. Builds bench/mocap_accuracy.cpp
# and label_fit_accuracy.cpp with the preset `bench` (scripts/setup.sh --bench).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
data=${MIMIK_SHARED_DATA:-}
write=no
only=
while [ $# -gt 0 ]; do
  case "$1" in
    --write) write=yes ;;
    --only)
      [[ ${2:-} =~ ^(motion|labels)$ ]] || { echo "mocap_numbers.sh: --only needs motion or labels" >&2; exit 2; }
      only=$2
      shift
      ;;
    *) data=$1 ;;
  esac
  shift
done
[ -f build/bench/CMakeCache.txt ] || cmake --preset bench >/dev/null
cmake --build --preset bench --target mimik_mocap_accuracy mimik_label_fit_accuracy >/dev/null
ict=() worlds=(--people 2 --per-unit)
[ -n "$data" ] && [ -d "$data/ict-facekit" ] && ict=(--ict "$data/ict-facekit")
worlds+=("${ict[@]}")
[ -n "$data" ] && [ -d "$data/makehuman-world" ] && worlds+=(--makehuman "$data/makehuman-world")

heading() {  # title, section of the results
  echo "# Measured: $1"
  echo
  echo "Written by \`scripts/mocap_numbers.sh --write\`, whole, at commit $(git rev-parse --short=12 HEAD 2>/dev/null || echo unknown): what is changed by"
  echo "hand here is lost. [Results](../results.md#$2) says what the words mean."
  echo
}
motion() {
  heading "motion capture" motion-capture
  build/bench/bin/mimik_mocap_accuracy "${worlds[@]}"
}
labels() {
  local fit=build/bench/bin/mimik_label_fit_accuracy
  heading "mesh registration" mesh-registration
  echo "Over the 64 labels that were not placed by hand. \`22 landmarks\` are labels that landmarks place, \`RBF warp\` those of the"
  echo "map of space before they are put on the skin. Times are only to be compared with each other."
  echo
  "$fit" "${ict[@]}" --pairs 4 --no-simplex
  "$fit" "${ict[@]}" --pairs 4 --no-simplex --noise 1
  "$fit" "${ict[@]}" --pairs 4 --no-simplex --rest reference
  "$fit" "${ict[@]}" --pairs 4 --no-simplex --projected 0
  echo "With the simplex, as published:"
  echo
  "$fit" "${ict[@]}" --pairs 2
}
page() {  # what, page
  [ -z "$only" ] || [ "$only" = "$1" ] || return 0
  if [ "$write" = no ]; then
    "$1"
    return
  fi
  mkdir -p out docs/measured
  "$1" >"out/$2.md"
  mv "out/$2.md" "docs/measured/$2.md"
}
page motion motion_capture
page labels mesh_registration
