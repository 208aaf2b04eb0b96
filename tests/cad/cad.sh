# shellcheck shell=sh disable=SC2154
# STEP and IGES: parts that OpenCASCADE made itself. Wraps hold the exact faces, by samples of them; tessellated parts are
# closed, and their deviation is stated; what is damaged is refused.
. "$(dirname "$0")/../cli/common.sh"
PARTS=$3
mkdir parts
"$PARTS" make parts >/dev/null || fail "the parts cannot be made"
[ "$(find parts -name '*.step' | wc -l)" = 12 ] || fail "parts are missing"
for part in parts/*.step; do
  name=$(basename "$part" .step)
  expect 0 'in millimetres' "$BIN/mesh-prepare" "$part" -o "$name.ply" --report r.json
  grep -q 'hole' err.txt && fail "$name is open: $(cat err.txt)"
  expect 0 'is inside, too: the exact faces' "$BIN/mesh-prepare" "$part" -o "$name-wrap.ply" --prepare wrap --epsilon 2%
  "$PARTS" check "$part" "$name-wrap.ply" 100000 2% >out.txt || fail "$name: $(cat out.txt)"
done
# The tessellation alone does not hold the exact faces: the check can fail.
"$PARTS" check parts/sphere.step sphere.ply 1000 2% >/dev/null && fail "the sphere's triangles hold the sphere"
expect 0 '50 solids' "$BIN/mesh-prepare" parts/assembly.step -o a.ply
for f in flange box; do expect 0 'in millimetres' "$BIN/mesh-prepare" parts/$f.iges -o i.ply; done
# Bodies cover the exact faces; an .obj of bodies reads as one mesh whose winding number counts them.
for part in flange sphere vase; do
  expect 0 'is inside, too: the exact faces' "$BIN/bcd-decompose" parts/$part.step -o $part.obj --epsilon 2% --effort fast --no-cache
  "$PARTS" check parts/$part.step $part.obj 100000 2% >out.txt || fail "bodies of $part: $(cat out.txt)"
done
expect 0 '' "$BIN/bcd-decompose" parts/sphere.step -o strict.obj --prepare strict --epsilon 2% --effort fast --no-cache
grep -q 'is inside, too' err.txt && fail "the triangles' bodies are said to hold the exact faces"
expect 3 'mesh-prepare parts/box.step -o' "$BIN/bmesh-decimate" parts/box.step -o none.stl --ratio 0.1
head -c 2000 parts/vase.step >cut.step
expect 3 'cut.step' "$BIN/mesh-prepare" cut.step -o none.ply
printf 'ISO-10303-21;\n' >head.step
expect 3 'head.step' "$BIN/mesh-prepare" head.step -o none.ply
cp parts/box.step box.iges
expect 3 'box.iges' "$BIN/mesh-prepare" box.iges -o none.ply
absent none.ply
finish
