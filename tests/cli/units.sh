# --scale and --unit: files without a unit in any unit, recorded, the same in every program; lengths of two units are
# not compared.
. "$(dirname "$0")/common.sh"
D=$BIN/bmesh-decimate
V=$BIN/bound-verify
B=$BIN/bcd-decompose
H=$BIN/hausdorff-eval
P=$BIN/mesh-prepare
S=$BIN/kaboum-scene

# Twelve millimetres across.
tetrahedron | sed 's/^1 0 0$/12.3 0 0/; s/^0 1 0$/0 12.3 0/; s/^0 0 1$/0 0 12.3/' >mm.off
export KABOUM_CACHE="$PWD/cache"

# Factors that are none, in every program that takes one.
for bad in 0 -1 nan inf 1e300 1e-300 1e-12 0x10 '' 1% mm; do
  expect 2 'scale' "$D" mm.off -o none.ply --epsilon 1% "--scale=$bad"
  expect 2 'scale' "$B" mm.off -o none.glb "--scale=$bad"
  expect 2 'scale' "$P" mm.off -o none.ply "--scale=$bad"
  expect 2 'scale' "$H" mm.off mm.off "--scale=$bad"
  expect 2 'scale' "$V" mesh --outer mm.off mm.off "--scale=$bad"
  expect 2 'scale' "$BIN/bmesh-replay" mm.off none.log none.ply "--scale=$bad"
  expect 2 'scale' "$S" make none.json --object a=mm.off --scale "a=$bad"
done
absent none.ply none.glb none.json
# Beyond the range of doubles.
tetrahedron | sed 's/^1 0 0$/1e305 0 0/; s/^0 1 0$/0 1e305 0/; s/^0 0 1$/0 0 1e305/' >huge.off
expect 3 'huge.off: its coordinate 1e+305, times 1e+06, is beyond the range of doubles' "$P" huge.off -o none.ply --scale 1e6
tetrahedron | sed 's/^1 0 0$/1e-305 0 0/' >tiny.off
expect 3 'tiny.off: .*beyond the range of doubles' "$P" tiny.off -o none.ply --scale 1e-6
absent none.ply

# mesh-prepare: the products, and both numbers in the report.
expect 0 'multiplied by 0.001' "$P" mm.off -o m.ply --scale 0.001 --unit m --report r.json
python3 - <<'END' || fail "mesh-prepare: $(cat r.json)"
import json
r = json.load(open("r.json"))
assert r["unit"] == "m" and r["scale"] == 0.001, r
END
strings m.ply | grep -q 'scale 0.001' || fail "no scale in the file's comment"
expect 0 '' "$P" m.ply -o m.off
grep -q '^0.0123 0 0$' m.off || fail "not scaled: $(cat m.off)"

# bmesh-decimate, its log, a progressive file, and what judges them.
expect 0 'multiplied by 0.001' "$D" mm.off -o d.ply --vertices 4 --log d.log --scale 0.001 --unit m --report r.json
python3 - <<'END' || fail "bmesh-decimate: $(cat r.json)"
import json
r = json.load(open("r.json"))
assert r["input"]["unit"] == "m" and r["input"]["scale"] == 0.001 and r["distance"]["bbox_diagonal"] < 0.03, r
END
shows 0 'verified' "$BIN/bmesh-replay" mm.off d.log d.ply --scale 0.001
expect 3 'd.log: it was made with --scale 0.001: give that here, too' "$BIN/bmesh-replay" mm.off d.log d.ply
expect 3 'd.log: it was made with --scale 0.001' "$BIN/bmesh-replay" mm.off d.log d.ply --scale 0.01
expect 0 '' "$D" mm.off --progressive d.pm --vertices 4 --scale 0.001
shows 0 'verified' "$V" progressive mm.off d.pm --scale 0.001
shows 0 'verified' "$V" mesh --outer mm.off d.ply --scale 0.001
expect 3 'd.pm: it was made with --scale 0.001' "$V" progressive mm.off d.pm
shows 0 'verified' "$V" mesh --outer mm.off d.ply --scale 0.001 --report r.json
grep -q '"scale": 0.001' r.json || fail "bound-verify: $(cat r.json)"
expect 1 '' "$V" mesh --outer mm.off d.ply
shows 0 'Hausdorff' "$H" mm.off d.ply --scale 0.001 --at-most 1e-9
expect 1 '' "$H" mm.off d.ply --at-most 1
expect 2 'from' "$D" --from d.pm -o none.ply --vertices 4 --scale 0.001

# bcd-decompose: in the container's record, and again from the cache, which knows other scales apart.
for i in 1 2; do expect 0 '' "$B" mm.off -o b$i.glb --scale 0.001 --report b$i.json; done
cmp b1.glb b2.glb || fail "another set from the cache"
grep -q '"parameters": "--epsilon 1%.* --scale 0.001"' b1.json || fail "no scale in $(cat b1.json)"
expect 0 '' "$B" mm.off -o b3.glb --unit mm
cmp b1.glb b3.glb >/dev/null 2>&1 && fail "the same set for another scale"
shows 0 'verified' "$V" cover mm.off b1.glb --scale 0.001 --epsilon 1%
expect 3 'b1.glb: it was made with --scale 0.001: give that here, too' "$V" cover mm.off b1.glb
expect 3 'b3.glb: it was made without --scale: leave that out' "$V" cover mm.off b3.glb --scale 0.001
shows 0 'verified' "$V" cover mm.off b3.glb
expect 2 'sets of bodies\|set of bodies' "$H" b1.glb mm.off --scale 1000
# A set with a margin, measured as a mesh, is scaled as other meshes.
python3 - <<'END' || fail "no margin to change"
data = open("b3.glb", "rb").read()
assert data.count(b'"margin":0.0,') == 1
open("margin.glb", "wb").write(data.replace(b'"margin":0.0,', b'"margin":0.5,'))
END
expect 2 'measure it as a mesh (--a-as mesh)' "$H" margin.glb m.off --scale 0.001
expect 0 "margin of 0.5 is left out" "$H" margin.glb m.off --a-as mesh --scale 0.001 --unit m --report r.json
grep -q 'multiplied by 0.001' err.txt || fail "not scaled: $(cat err.txt)"
grep -q '"unit": "m"' r.json || fail "the unit as scaled: $(cat r.json)"
expect 3 'its vertices are in m, not in cm' "$H" margin.glb m.off --a-as mesh --scale 0.001 --unit cm
mkdir bodies
tetrahedron >t.off
expect 0 '' "$P" t.off -o bodies/b.stl
expect 2 'have it made anew with --scale$' "$H" bodies m.off --scale 0.001
# The page is about the same triangles.
expect 0 '' "$B" mm.off -o b4.glb --scale 0.001 --preview b.html

# Files that state their unit: millimetres by a factor are metres.
printf '<?xml version="1.0"?><X3D version="3.3"><head><unit category="length" name="mm" conversionFactor="0.001"/></head><Scene><Shape>
<IndexedFaceSet coordIndex="0 2 1 -1 0 1 3 -1 1 2 3 -1 2 0 3 -1"><Coordinate point="0 0 0 12 0 0 0 12 0 0 0 12"/></IndexedFaceSet></Shape></Scene></X3D>' >mm.x3d
expect 0 '' "$P" mm.x3d -o x.obj --scale 0.001 --unit m
expect 3 'mm.x3d: its vertices are in mm, not in m; .*--scale' "$P" mm.x3d -o none.obj --unit m
expect 3 'its vertices are in m, not in cm' "$P" mm.x3d -o none.obj --unit cm --scale 0.001
expect 0 '' "$D" mm.x3d -o x.glb --vertices 4 --precision float
shows 0 'verified' "$V" mesh --outer mm.x3d x.glb
# Metres that are stated are a unit; X3D without one says nothing.
sed 's/0.001/1/' mm.x3d >m.x3d
expect 3 'its vertices are in m, not in cm' "$P" m.x3d -o none.obj --unit cm
sed 's/<unit[^>]*>//' mm.x3d >none.x3d
expect 0 '' "$P" none.x3d -o n.obj --unit cm
# Two units: bound-verify, hausdorff-eval, a scene.
tetrahedron_gltf
expect 3 'mm.x3d is in mm and t.gltf in m as read.*--scale 0.001' "$V" mesh --outer mm.x3d t.gltf
expect 1 '' "$V" mesh --outer t.gltf mm.x3d --scale 1000
shows 0 'verified' "$V" mesh --outer mm.x3d t.gltf --scale 0.001
expect 3 'mm.x3d is in mm and t.gltf in m as read.*--scale 0.001' "$H" mm.x3d t.gltf
shows 0 'Hausdorff' "$H" mm.x3d t.gltf --scale 0.001
expect 3 'mm.off is in mm and t.gltf in m' "$V" mesh --outer mm.off t.gltf --unit mm
expect 3 'mm.off is in mm and t.gltf in m' "$H" mm.off t.gltf --unit mm
expect 0 '' "$B" mm.x3d -o x-set.glb
shows 0 'verified' "$V" cover mm.x3d x-set.glb
expect 3 't.gltf is in m and x-set.glb in mm' "$V" cover t.gltf x-set.glb
expect 3 't.gltf is in m and x-set.glb in mm' "$H" t.gltf x-set.glb
expect 3 'mm.x3d: its vertices are in mm as read.*bring it into m (scale)' "$S" make none.json --object a=mm.x3d --no-cache
absent none.json

# Scenes: an object in metres by its factor; brought up to date with the same.
expect 0 'a: 0.012 x 0.012 x 0.012 m' "$S" make a.json --object a=mm.x3d --scale a=0.001 --inner --no-cache
shows 0 '^free$' "$BIN/kaboum-check" a.json
sed 's/12 0 0/13 0 0/' mm.x3d >moved.x3d
mv moved.x3d mm.x3d
expect 0 'a: 0.013 x 0.012 x 0.012 m' "$S" update a.json --no-cache
# A container of a program that had another option is read, with its scale; what is not known is named.
LC_ALL=C sed 's/--max-vertices-per-body 64/--method voxels           /' a/a.glb >voxels.glb
grep -aq -- '--method voxels' voxels.glb || fail "no such option in the record"
shows 0 'verified' "$V" cover mm.x3d voxels.glb --scale 0.001
expect 3 'with --scale 0.001' "$V" cover mm.x3d voxels.glb
cp voxels.glb a/a.glb
expect 3 'was made with .--method., which is not known here.* --method voxels .*--scale 0.001' "$S" update a.json --no-cache
expect 2 "scale: there is nothing of the name 'b'" "$S" make none.json --object a=mm.x3d --scale b=0.001
expect 2 "scale: NAME=FACTOR is expected, not '0.001'" "$S" make none.json --object a=mm.x3d --scale 0.001
expect 2 "scale: 'a' is scaled twice" "$S" make none.json --object a=mm.x3d --scale a=1 --scale a=2

# Robots state their meshes' scales themselves.
printf '<robot name="r"><link name="l"><collision><geometry><mesh filename="mm.off"/></geometry></collision></link></robot>' >r.urdf
expect 2 'robot.*--scale\|--scale.*robot' "$B" r.urdf -o none --scale 0.001
expect 2 'robot.*--scale\|--scale.*robot' "$D" r.urdf -o none --epsilon 1% --scale 0.001
expect 2 'robot' "$V" robot r.urdf r.urdf --scale 0.001
absent none none.obj none.ply
finish
