#!/usr/bin/env bash
# mocap_numbers.sh [FOLDER with ict-facekit and makehuman-world] [--write]: how far faces that markers move are from the
# truth, on two people of each world; fixed seeds. --write puts the tables into docs/measured/motion_capture.md.
# Builds bench/mocap_accuracy.cpp with the preset `bench` (scripts/setup.sh --bench).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
data=${MIMIK_SHARED_DATA:-}
write=no
for word in "$@"; do
  case "$word" in
    --write) write=yes ;;
    *) data=$word ;;
  esac
done
[ -f build/bench/CMakeCache.txt ] || cmake --preset bench >/dev/null
cmake --build --preset bench --target mimik_mocap_accuracy >/dev/null
arguments=(--people 2 --per-unit)
[ -n "$data" ] && [ -d "$data/ict-facekit" ] && arguments+=(--ict "$data/ict-facekit")
[ -n "$data" ] && [ -d "$data/makehuman-world" ] && arguments+=(--makehuman "$data/makehuman-world")
if [ "$write" = no ]; then
  build/bench/bin/mimik_mocap_accuracy "${arguments[@]}"
  exit
fi
mkdir -p docs/measured
{
  echo "# Measured: motion capture"
  echo
  echo "Written by \`scripts/mocap_numbers.sh --write\`, whole: what is changed by hand here is lost."
  echo "[Results](../results.md#motion-capture) says what the words mean."
  echo
  build/bench/bin/mimik_mocap_accuracy "${arguments[@]}"
} >docs/measured/motion_capture.part
mv docs/measured/motion_capture.part docs/measured/motion_capture.md
