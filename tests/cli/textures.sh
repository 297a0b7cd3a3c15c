#!/usr/bin/env bash
# textures.sh MIMIK FOLDER: the pictures of other people's meshes, kept or left out with a word.
set -euo pipefail
foreign=$(cd "$(dirname "${BASH_SOURCE[0]}")/../data/foreign" && pwd)
source "$(dirname "${BASH_SOURCE[0]}")/claims.sh"

warp() {  # input, output
  "$mimik" warp --from "$foreign/from.csv" --to "$foreign/to.csv" "$1" -o "$2" 2>note.txt >/dev/null || { cat note.txt; fail "warp of $1"; }
}
for extension in ply obj; do
  warp "$foreign/mtl-unused-first/a.obj" used.$extension
  cmp used_texture.png "$foreign/mtl-unused-first/skin.png"
  rm used_texture.png
done
claim "the picture is that of the material in use"
for name in a b; do
  warp "$foreign/mtl-case-of-name/$name.obj" case_$name.ply
  cmp case_${name}_texture.png "$foreign/mtl-case-of-name/skin.png"
done
warp "$foreign/obj-spaces-in-names/optspace.obj" blank.ply
cmp blank_texture.png "$foreign/obj-spaces-in-names/my face.png"
for name in backslash absolute unixabs parent; do
  warp "$foreign/mtl-windows-path/$name.obj" path_$name.ply
  cmp path_${name}_texture.png "$foreign/mtl-windows-path/skin.png" || cmp path_${name}_texture.png "$foreign/mtl-windows-path/tex/skin.png"
done
claim "pictures are found whatever machine named them: capitals, blanks, options, drives, other folders"
for extension in ply obj; do
  warp "$foreign/ply-two-textures/a.ply" two.$extension
  cmp two_texture.png "$foreign/ply-two-textures/lower.png"
  cmp two_texture_2.png "$foreign/ply-two-textures/upper.png"
  rm two_texture*.png
done
grep -q '^usemtl face_2$' two.obj && grep -qa '^property int texnumber$' two.ply || fail "faces do not say which picture they have"
warp "$foreign/ply-two-textures/a.ply" two.stl
grep -q "two.stl: the format names no image" note.txt || fail "no word of the lost pictures"
claim "several pictures stay apart, and a format that holds none says so"

mkdir private trap
printf 'a key' >private/key.png
ln -s "$folder/private/key.png" trap/key.png
printf 'mtllib a.mtl\nv 0 0 0\nv 9 0 0\nv 0 9 0\nusemtl a\nf 1 2 3\n' >trap/a.obj
printf 'newmtl a\nmap_Kd key.png\n' >trap/a.mtl
warp trap/a.obj stolen.ply
[ ! -e stolen_texture.png ] && grep -q 'key.png' note.txt || fail "a link out of the folder was followed"
cp private/key.png trap/other.png
printf 'newmtl a\nmap_Kd other.png\n' >trap/a.mtl
warp trap/a.obj stolen.ply
[ ! -e stolen_texture.png ] && grep -q 'other.png: is neither a PNG' note.txt || fail "what is no image was copied"
claim "only images that lie with the mesh are handed on"

# A database whose v runs from -1 to 0, and what its image may be.
cp -r "$foreign/uv-outside-unit" db
"$mimik" preprocess db -o work --quiet >/dev/null
animate() {  # output
  expect_code 0 "$1" "$mimik" animate work --source bs000 --target bs001 --au 12 -o "$1"
}
for extension in ply obj vtp glb; do animate f.$extension; done
cmp f_texture.png db/bs001/N_N.png
grep -a '^vt ' f.obj | awk '$3 < -1e-3 || $3 > 1.001 { exit 1 }' || fail "v outside the image"
claim "texture positions in another copy of the image are moved into it"
cp -r "$foreign/texture-format-blocks" blocks
"$mimik" preprocess blocks -o blocks_work --quiet >/dev/null
for extension in obj vtp glb ply; do
  expect_code 0 "b.$extension" "$mimik" animate blocks_work --source bs000 --target bs001 --au 12 -o b.$extension
  ! grep -q 'no picture' err.txt || fail "a BMP is not read"
done
is_png b_texture.png
[ "$(od -An -tx1 -j16 -N8 b_texture.png | tr -d ' \n')" = 0000003000000040 ] || fail "the picture has another size"
grep -qa '"mimeType":"image/png"' b.glb || fail "the GLB has no picture"
claim "the pictures of a database that has them as BMP go along"
grep -qa '^comment made_by: Mimik ' f.ply && grep -qa '^comment expressions: AU12 x 1$' f.ply || fail "PLY does not say what made it"
grep -qa '^comment target: bs001_N_N_0$' f.ply && grep -qa '"target":"bs001_N_N_0"' f.glb && grep -q 'Name="made_by"' f.vtp || fail "no target"
claim "an animated face says what made it"
for image in bmp tiff cut; do
  case $image in
    bmp) { printf 'BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x01\0\0\0\x01\0\0\0\x01\0\x18\0'; head -c 24 /dev/zero; printf '\x5a\x78\xc8\0'; } >db/bs001/N_N.png ;;
    tiff) printf 'II*\0\x08\0\0\0\0\0\0\0' >db/bs001/N_N.png ;;
    cut) head -c 200 "$foreign/uv-outside-unit/bs001/N_N.png" >db/bs001/N_N.png ;;
  esac
  for extension in ply obj vtp glb; do
    rm -f f_texture.png
    animate f.$extension
    if [ $image = bmp ]; then
      ! grep -q 'no picture' err.txt || fail "a BMP is not read"
    else
      [ ! -e f_texture.png ] && grep -q 'note: the face has no picture: .*N_N.png' err.txt || { cat err.txt; fail "$image: no word"; }
    fi
  done
done
claim "a picture that cannot be read never keeps a face from being animated"

# Two photographs: the subject's left half has one, the right half another.
printf 'newmtl l\nmap_Kd left.png\nnewmtl r\nmap_Kd right.png\n' >db/bs001/N_N.mtl
cp "$foreign/ply-two-textures/lower.png" db/bs001/left.png
cp "$foreign/ply-two-textures/upper.png" db/bs001/right.png
awk '$1 == "v" { x[++n] = $2 } $1 == "usemtl" { next } $1 == "f" { split($2, c, "/"); m = x[c[1]] > 0 ? "l" : "r"; if (m != last) print "usemtl " m; last = m } { print }' \
  "$foreign/uv-outside-unit/bs001/N_N.obj" >db/bs001/N_N.obj
"$mimik" preprocess db -o work --json >preprocess.json
grep -q 'its texture has 2 images: the resampled face gets a picture of its own' preprocess.json || fail "no word of the new picture"
animate g.glb
animate g.ply
is_png g_texture.png
cmp g_texture.png work/faces/bs001/bs001_N_N_0.png
mv work moved
expect_code 0 moved.ply "$mimik" animate moved --source bs000 --target bs001 --au 12 -o moved.ply
cmp moved_texture.png g_texture.png
claim "a scan with two photographs is animated with one new picture, also from a workspace that was moved"

mkdir store
printf 'old' >store/real.ply
ln -s store/real.ply link.ply
expect_code 0 link.ply "$mimik" animate moved --source bs000 --target bs001 --au 12 -o link.ply
[ -L link.ply ] && grep -qa '^element vertex' store/real.ply || fail "the link's goal has the old content"
expect_code 2 "control character" "$mimik" animate moved --source bs000 --target bs001 --au 12 -o $'bad\nname.obj'
[ -z "$(find . -name 'bad*')" ] || fail "files of a bad name"
touch .mimik-0123456789abcdef.part
expect_code 0 n.ply "$mimik" animate moved --source bs000 --target bs001 --au 12 -o n.ply
[ -z "$(find . -name '.mimik-*')" ] || fail "leftovers stay"
claim "an output that is a link is written where it leads, a name with a line break is refused, leftovers go"
