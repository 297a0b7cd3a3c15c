#!/usr/bin/env bash
# program.sh MIMIK FOLDER SHARED: what is so of every command: its start, its help, its name.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

! readelf -d "$mimik" | grep NEEDED | grep -i libvtk || fail "mimik asks for VTK itself"
readelf -d "$mimik" | grep -q NEEDED || fail "readelf says nothing"
! ldd "$mimik" | grep -i libvtk || fail "mimik loads VTK through another library"
claim "mimik starts without VTK"
expect_code 0 "Ends with 0: done; 1: done, with failures" "$mimik" --help
claim "the help says with which code a command ends"
expect_code 2 $'no command \'distnace\'\ndistance' "$mimik" distnace low.obj high.obj
claim "an unknown command is named with the nearest"
