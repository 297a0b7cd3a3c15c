#!/usr/bin/env bash
# make_shared.sh MIMIK FOLDER: what the tests of single commands read, made once. Does not end before its remarks are right.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

# Seed 5 has closed lips whose two inner landmarks share a vertex: once that stopped a whole database.
"$mimik" synthesize db1 --subjects 3 --expressions 4,12,12L --seed 5 --threads 2 --quiet
"$mimik" preprocess db1 -o work1 --threads 2 >out.txt 2>remarks.txt

[ "$(grep -c ' closed lips, both inner marks on one grid vertex' remarks.txt)" -eq 1 ] && ! grep -q '^note: ' remarks.txt || { cat remarks.txt; fail "remarks"; }
claim "closed lips are one line for all scans"
