#!/usr/bin/env bash
# options.sh MIMIK FOLDER: what is typed wrongly is said in one line of our own, with the nearest that there is.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

# 2, and one line that begins with the program's name; the words as expect_code.
expect_line() {
  expect_code 2 "$@"
  [ "$(wc -l <err.txt)" -eq 1 ] && grep -q '^mimik: ' err.txt || { cat err.txt; fail "not one line of ours: ${*:2}"; }
  [ ! -s out.txt ] || fail "a result all the same: ${*:2}"
}

expect_line $'--exprssion: is no option of \'mimik animate\'\ndid you mean --expression?' "$mimik" animate WORK --exprssion 12
expect_line $'--out: is no option of \'mimik evaluate\'\ndid you mean --output?' "$mimik" evaluate WORK --out scores
expect_line $'-quiet: is no option\ndid you mean --quiet?' "$mimik" scans DB -quiet
expect_line $'--captoin: is no option of \'mimik figure\'\ndid you mean --caption?' "$mimik" figure a.ply --captoin=x -o a.png
expect_line $'--wxyz: is no option of \'mimik warp\'\n\'mimik warp --help\' lists all' "$mimik" warp --wxyz
expect_line $'--treads: is no option of \'mimik\'' "$mimik" --treads
claim "an option that there is not is named with the nearest, before anything that is missing"
expect_line $'no command \'distnace\'\ndid you mean distance?' "$mimik" distnace low.obj high.obj
expect_line $'no command \'preproces\'\ndid you mean preprocess?' "$mimik" help preproces
expect_line "a command is missing; 'mimik --help' lists them" "$mimik"
expect_line $'no command \'inf\'\ndid you mean info?\n\'mimik mocap --help\' lists all' "$mimik" mocap inf
expect_line $'--fames: is no option of \'mimik mocap convert\'\ndid you mean --frames?' "$mimik" mocap convert --fames
expect_line "a command is missing; 'mimik mocap --help' lists them" "$mimik" mocap
claim "so is a command, and a command of a command"
expect_line $'--kernel is \'r2log\'; give one of r, r2logr; did you mean r2logr?' "$mimik" warp --from a.csv --to b.csv c.csv -o d.csv --kernel r2log
expect_line $'--method is \'thesi\'; give one of \ndid you mean thesis?' "$mimik" model WORK --method thesi
expect_line $'--method is \'expression-cloning\'\nmakes no model that could be kept\nmimik evaluate' "$mimik" model WORK --method expression-cloning
expect_line $'--method is \'mean\'\n--source mean' "$mimik" animate WORK --target a --au 12 -o b.ply --method mean
expect_line $'--frame is \'\'; give one of scanner, average' "$mimik" animate WORK --target a -o b.ply --frame ''
claim "so is a choice"
for word in 1e 0x10 010x 1.5 '' ' 5' 5mm; do
  expect_line "--rows is '$word'; give a whole number" "$mimik" preprocess DB -o WORK --rows "$word"
  expect_line "--threads is '$word'; give a whole number" "$mimik" scans DB --threads "$word"
done
for word in 1e 0x10 '' ' 5' 5mm; do
  expect_line "--trim is '$word'; give a number" "$mimik" preprocess DB -o WORK --trim "$word"
  expect_line "--smoothing is '$word'; give a number" "$mimik" warp --from a.csv --to b.csv c.csv -o d.csv --smoothing "$word"
done
expect_line "--trim is '0,9'; give a number with a point" "$mimik" preprocess DB -o WORK --trim 0,9
for word in nan inf -inf 1e999; do expect_line "--trim is $word; give a finite number" "$mimik" preprocess DB -o WORK --trim="$word"; done
expect_line "--rows is '99999999999999999999'; the number is too large" "$mimik" preprocess DB -o WORK --rows 99999999999999999999
expect_line "--rows is 9999999999; give a whole number up to" "$mimik" preprocess DB -o WORK --rows 9999999999
expect_line "--seed is -1; give a whole number of 0 or more" "$mimik" synthesize OUT --seed -1
expect_line "--threads is 1025; give 0 to 1024" "$mimik" scans DB --threads 1025
expect_line "--range is 'x'; give a number" "$mimik" figure a.ply --scalar s --range 0 x -o a.png
claim "numbers are read whole, with the same words everywhere"
expect_line $'--from: is missing (Landmarks on\nusage: mimik warp INPUT --from TEXT' "$mimik" warp a.ply -o b.ply
expect_line $'--target: is missing (Subject whose\nor --mesh and --landmarks' "$mimik" animate WORK -o a.ply
expect_line $'REFERENCE: is missing (Mesh with faces)\nusage: mimik distance TEST REFERENCE' "$mimik" distance a.ply
expect_line "'c.ply': more than 'mimik distance' takes" "$mimik" distance a.ply b.ply c.ply
expect_line "--target: its value is missing; give one: Subject" "$mimik" animate WORK --target
expect_line "--target: is given 2 times; give it once" "$mimik" animate WORK --target a --target b -o a.ply
expect_line "--range: needs 2 values" "$mimik" figure a.ply -o a.png --scalar s --range 0
expect_line "--regions needs --hold; give both" "$mimik" animate WORK --target a -o a.ply --regions b.csv
expect_line "excludes" "$mimik" catalogue --lint --text
expect_line "--output is 'a\\nb.ply'; give a name without line breaks" "$mimik" animate WORK --target a -o $'a\nb.ply'
expect_line "--output is 'a\\x1bb'; give a name without" "$mimik" evaluate WORK -o $'a\x1bb'
expect_line "--output is '=a.ply'; give it behind a blank: -o a.ply" "$mimik" animate WORK --target a -o=a.ply
expect_line "OUT is 'a\\tb'; give a name without" "$mimik" synthesize $'a\tb'
claim "what is missing, too much or given twice is named with the usage"

"$mimik" preprocess --help >help.txt
"$mimik" preprocess -h | cmp - help.txt
"$mimik" help preprocess | cmp - help.txt
"$mimik" help methods >methods.txt
for method in default thesis-half deformation-transfer landmarks true-field; do grep -q "^  $method " methods.txt || fail "help methods"; done
grep -q "^  thesis-half  *\*" methods.txt && ! grep "^  deformation-transfer  *\*" methods.txt || fail "which methods make models"
! awk 'length > 119' methods.txt | grep . || fail "help methods is too wide"
"$mimik" help | cmp - <("$mimik" --help)
[ "$("$mimik" -V)" = "$("$mimik" --version)" ] && [ "$("$mimik" scans -V)" = "$("$mimik" --version)" ]
! awk 'length > 100' help.txt | grep . || fail "help is wider than 100 columns"
! "$mimik" --help | awk 'length > 110' | grep . || fail "a command has more than one line"
commands=$("$mimik" --help | sed -n '/^Commands/,/^Options/s/^  \([a-z]*\) .*/\1/p')
[ "$(echo $commands)" = "synthesize scans preprocess register animate model evaluate run merge report verify compare tune sensitivity additivity panels figures figure warp distance mocap capture examples perform live regions catalogue version help" ] || fail "order: $commands"
for command in $commands; do
  "$mimik" $command --help | grep "^Usage: mimik $command" >/dev/null || fail "usage of $command"
  [ "$command" = help ] || "$mimik" $command --help | grep -e "--json" >/dev/null || fail "--json of $command"
done
"$mimik" mocap convert --help >help.txt
"$mimik" help mocap convert | cmp - help.txt
claim "help is the same in every way in which it is asked for, commands stand in the order of work"

"$mimik" version | grep '^compiler  *[A-Z]' >/dev/null && "$mimik" version | grep '^  VTK  *[0-9]' >/dev/null
"$mimik" version --json >version.json
grep -q '"schema": 1' version.json && grep -q "\"mimik\": \"$("$mimik" -V)\"" version.json && grep -q '"Eigen": "3' version.json
claim "the program says of what it was built"

share=$(dirname "$mimik")/../share
if [ -d "$share/man/man1" ]; then
  "$mimik" help --format man | cmp - "$share/man/man1/mimik.1"
  "$mimik" help --format bash | cmp - "$share/bash-completion/completions/mimik"
  "$mimik" help --format zsh | cmp - "$share/zsh/site-functions/_mimik"
fi
"$mimik" help --format man | sed 's/\\-/-/g' >man.txt
"$mimik" help --format bash >bash.txt
"$mimik" help --format zsh >zsh.txt
for command in $commands; do
  grep -q "^.SS $command\$" man.txt || fail "manual of $command"
  for option in $("$mimik" $command --help | grep -oE '^  (-[a-zA-Z], )?--[a-z0-9-]+' | grep -oE -- '--[a-z0-9-]+'); do
    sed -n "/^.SS $command\$/,/^.S[SH] /p" man.txt | grep -F -- "$option" >/dev/null || fail "$option of $command is not in the manual"
    grep "^        $command) words=" bash.txt | grep -F -- "$option" >/dev/null || fail "$option of $command is not completed in bash"
    sed -n "/^    $command)\$/,/;;/p" zsh.txt | grep -F -- "'*$option[" >/dev/null || fail "$option of $command is not completed in zsh"
  done
done
! grep -nE '^\.[^A-Z]' man.txt || fail "a line that roff would take for a command"
if command -v groff >/dev/null; then [ -z "$("$mimik" help --format man | groff -man -Tutf8 -ww -z 2>&1)" ] || fail "groff complains"; fi
claim "manual page and completions have every option of every command"
complete_words() {  # words..., the last to be completed
  (
    source bash.txt
    COMP_WORDS=("$@")
    COMP_CWORD=$(($# - 1))
    _mimik
    echo "${COMPREPLY[*]}"
  )
}
[ "$(complete_words mimik sc)" = scans ] || fail "a command in bash"
[ "$(complete_words mimik animate --comb)" = --combine ] || fail "an option in bash"
[ "$(complete_words mimik animate --combine p)" = parallel ] || fail "a choice in bash"
[ "$(complete_words mimik help pre)" = preprocess ] || fail "help in bash"
[ "$(complete_words mimik scans D)" = "" ] || fail "files are left to bash"
[ "$(complete_words mimik mocap inf)" = info ] || fail "a command of a command in bash"
[ "$(complete_words mimik mocap convert --fra)" = --frames ] || fail "its option in bash"
claim "bash completes commands, options and choices"
