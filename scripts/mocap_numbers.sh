#!/usr/bin/env bash
# The tables of docs/results.md, "Motion capture": how far faces that markers move are from the truth. Fixed seeds.
#     scripts/mocap_numbers.sh [FOLDER with ict-facekit and makehuman-world]
# Builds bench/mocap_accuracy.cpp with the preset `bench` (scripts/setup.sh --bench).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
data=${1:-${MIMIK_SHARED_DATA:-}}
[ -f build/bench/CMakeCache.txt ] || cmake --preset bench >/dev/null
cmake --build --preset bench --target mimik_mocap_accuracy >/dev/null
arguments=(--people 2 --per-unit)
[ -n "$data" ] && [ -d "$data/ict-facekit" ] && arguments+=(--ict "$data/ict-facekit")
[ -n "$data" ] && [ -d "$data/makehuman-world" ] && arguments+=(--makehuman "$data/makehuman-world")
build/bench/bench/mimik_mocap_accuracy "${arguments[@]}"
