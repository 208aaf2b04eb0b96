# --importer assimp: formats that have no reader here, in every program that reads a mesh; refused without it, and said
# to be so wherever something is claimed.
. "$(dirname "$0")/common.sh"
D=$BIN/bmesh-decimate
V=$BIN/bound-verify
B=$BIN/bcd-decompose
H=$BIN/hausdorff-eval
P=$BIN/mesh-prepare
A='--importer assimp'
export KABOUM_CACHE="$PWD/cache"

# slab_ac X: a block of X by 1 by 1, AC3D.
slab_ac() {
  printf 'AC3Db\nMATERIAL "m" rgb 1 1 1  amb 1 1 1  emis 0 0 0  spec 0 0 0  shi 10  trans 0\n'
  printf 'OBJECT world\nkids 1\nOBJECT poly\nname "slab"\nnumvert 8\n'
  printf '0 0 0\n%s 0 0\n%s 1 0\n0 1 0\n0 0 1\n%s 0 1\n%s 1 1\n0 1 1\nnumsurf 6\n' "$1" "$1" "$1" "$1"
  for face in '0 3 2 1' '4 5 6 7' '0 1 5 4' '1 2 6 5' '2 3 7 6' '3 0 4 7'; do
    printf 'SURF 0x0\nmat 0\nrefs 4\n'
    for corner in $face; do echo "$corner 0 0"; done
  done
  echo 'kids 0'
}

slab_ac 3 >slab.ac
slab 3 >slab.off

if "$D" slab.ac -o built.ply --vertices 8 --importer assimp 2>&1 | grep -q 'which this build leaves out'; then
  # shellcheck disable=SC2086
  expect 5 'KABOUM_WITH_ASSIMP=ON' "$D" slab.ac -o none.ply --vertices 8 $A
  finish
fi
rm -f built.ply

# Without the option it is refused, and the option named; so it is for files that are not there.
for command in "$D slab.ac -o none.ply --vertices 8" "$B slab.ac -o none.glb --epsilon 1%" "$P slab.ac -o none.ply" \
  "$H slab.ac slab.off" "$H slab.off slab.ac" "$BIN/mesh-picture slab.ac -o none.png" \
  "$BIN/bmesh-replay slab.ac none.log none.ply" "$V mesh --outer slab.ac slab.off" "$V cover slab.ac slab.off" \
  "$V progressive slab.ac none.pm"; do
  # shellcheck disable=SC2086
  expect 3 'slab.ac: .*--importer assimp' $command
done
absent none.ply none.glb none.png
# shellcheck disable=SC2086
{
  expect 3 'no such file' "$D" none.ac -o none.ply --vertices 8
  expect 3 'none.ac' "$D" none.ac -o none.ply --vertices 8 $A
  expect 3 'none.lws: .*3ds, ac, ' "$D" none.lws -o none.ply --vertices 8 $A
  expect 3 'standard input: .*name one' "$D" - -o none.ply --vertices 8 $A
  expect 2 'input-format' "$D" slab.ac -o none.ply --vertices 8 $A --input-format obj
  expect 2 'importer' "$D" slab.ac -o none.ply --vertices 8 --importer magic
  expect 3 'is a folder' "$D" . -o none.ply --vertices 8 $A
}
absent none.ply

# A result and what judges it: the note, the report, the end of the verdict.
# shellcheck disable=SC2086
{
  expect 0 'note: Warning: assimp' "$D" slab.ac -o slab.ply --vertices 8 --log slab.log --report r.json $A
  json r.json 'r["input"]["reader_delivers_float32"] and any(n.startswith("Warning: assimp") for n in r["preparation"]["notes"])'
  shows 0 '^verified, of the triangles that assimp delivered: of what it may have left out' \
    "$V" mesh --outer slab.ac slab.ply --report v.json $A
  grep -q 'slab.ac: Warning: assimp' err.txt || fail "the verdict comes without the warning: $(cat err.txt)"
  json v.json 'r["original"]["importer"] == "assimp" and r["original"]["single_precision"] and any(n.startswith("Warning: assimp") for n in r["original"]["notes"])'
  shows 0 'of the triangles that assimp delivered' "$BIN/bmesh-replay" slab.ac slab.log slab.ply --report p.json $A
  json p.json 'any(n.startswith("Warning: assimp") for n in r["notes"])'
  expect 0 '' "$D" slab.ac --progressive slab.pm --vertices 8 $A
  shows 0 'of the triangles that assimp delivered' "$V" progressive slab.ac slab.pm --report p.json $A
  json p.json 'any(n.startswith("Warning: assimp") for n in r["original"]["notes"])'
  expect 0 'Warning: assimp' "$B" slab.ac -o slab.glb --epsilon 1% --report b.json $A
  json b.json 'any(n.startswith("Warning: assimp") for n in r["notes"])'
  shows 0 '^verified, of the triangles that assimp delivered' "$V" cover slab.ac slab.glb $A
  expect 0 'Warning: assimp' "$B" slab.ac -o again.glb --epsilon 1% $A # from the cache
  cmp slab.glb again.glb || fail "another set from the cache"
  expect 0 '' "$BIN/mesh-picture" slab.ac slab.off -o two.png $A
}
# A refutation needs no such end.
slab 2 >small.off
# shellcheck disable=SC2086
shows 1 'refuted' "$V" mesh --outer slab.ac small.off $A
grep -q 'assimp delivered' out.txt && fail "a refutation ends as a verdict: $(cat out.txt)"

# The triangles are those of the same block in OFF; scaled and with a unit as others are.
# shellcheck disable=SC2086
{
  shows 0 'Hausdorff' "$H" slab.ac slab.off --at-most 1e-9 --report h.json $A
  grep -q 'note: slab.ac: Warning: assimp' err.txt || fail "distances come without the warning: $(cat err.txt)"
  json h.json 'any(n.startswith("Warning: assimp") for n in r["a"]["notes"])'
  expect 0 '' "$P" slab.ac -o slab.obj --report s.json --scale 0.001 --unit m $A
  json s.json 'r["unit"] == "m" and r["scale"] == 0.001'
  shows 0 '^verified$' "$V" mesh --outer slab.off slab.obj --scale 0.001
}
# What has a reader here is read by it.
# shellcheck disable=SC2086
shows 0 '^verified$' "$V" mesh --outer slab.off slab.off --report v.json $A
json v.json '"importer" not in r["original"] and not r["original"]["single_precision"]'

# Robots: their meshes are to be of formats that all programs read.
cat >arm.urdf <<'END'
<robot name="arm"><link name="base"><collision><geometry><mesh filename="slab.ac"/></geometry></collision></link></robot>
END
expect 3 'slab.ac: .*mesh-prepare' "$D" arm.urdf -o arm --ratio 0.5
# shellcheck disable=SC2086
{
  expect 2 'mesh-prepare MESH --importer assimp' "$D" arm.urdf -o arm --ratio 0.5 $A
  expect 2 'mesh-prepare MESH --importer assimp' "$B" arm.urdf -o arm --epsilon 1% $A
}
absent arm
finish
