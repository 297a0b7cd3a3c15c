#!/usr/bin/env bash
# setup.sh [--check] [--bench] [--adapters] [--page] [--browser] [--video] [--slurm]: installs the Debian 12 packages that
# Mimik is built and run with; does nothing where they are there. --check adds what scripts/check.sh needs (clang tools),
# --bench what scripts/bench.sh compares with, --adapters the three libraries of adapters/ and companions/ that nothing
# else needs, --page npm where none is on the PATH: it bundles the page of an experiment; --browser what tests that page;
# --video OpenCV, for mimik-video (libdlib-dev and libdlib-data add another tracker, if you want it); --slurm a Slurm for
# the test that starts one. Needs root or sudo to install.
set -euo pipefail

packages=(
  # tools
  build-essential cmake ninja-build pkg-config git ca-certificates
  # geometry and numbers
  libeigen3-dev libtbb-dev libboost-dev libcgal-dev libgmp-dev libnanoflann-dev libembree-dev libhwy-dev
  # files, options, the scan index
  libfmt-dev nlohmann-json3-dev libtomlplusplus-dev libcli11-dev libpng-dev libjpeg62-turbo-dev zlib1g-dev
  libpugixml-dev liblzf-dev libsqlite3-dev libkainjow-mustache-dev
  # figures: VTK, an OpenGL that needs no display, and letters; xvfb is the second way where EGL is missing; plots as PDF
  libvtk9-dev libgl-dev libegl-dev libx11-dev libegl1 libegl-mesa0 libgl1-mesa-dri xvfb fonts-dejavu-core
  librsvg2-bin
  # tests
  libgtest-dev libgmock-dev
  # the peers of our statistics (tests/statistics/peers.py): 28 MB to fetch
  python3-scipy python3-statsmodels
)
for option in "$@"; do
  case "$option" in
    --check) packages+=(clang-14 clang-format-14 clang-tidy-14 libclang-rt-14-dev llvm-14) ;;
    --bench) packages+=(libbenchmark-dev libpcl-dev python3-numpy python3-scipy) ;;
    --adapters) packages+=(libpcl-dev libopencv-dev libceres-dev) ;;
    --page) command -v npm >/dev/null || packages+=(nodejs npm) ;;
    --browser) packages+=(chromium) ;;
    --video) packages+=(libopencv-dev opencv-data) ;;
    --slurm) packages+=(slurmctld slurmd slurm-client munge) ;;
    *) echo "setup.sh: there is no option '$option'; there are --check, --bench, --adapters, --page, --browser, --video and --slurm" >&2; exit 2 ;;
  esac
done

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "setup.sh: root is needed to install: ${missing[*]}" >&2; exit 2; }
  as_root=(sudo)
fi
echo "Installing ${#missing[@]} packages: ${missing[*]}"
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
