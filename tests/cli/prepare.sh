# mesh-prepare and --prepare: what is repaired, wrapped and refused; bound-verify --raw judges the file's triangles.
. "$(dirname "$0")/common.sh"
P=$BIN/mesh-prepare
V=$BIN/bound-verify

tetrahedron >closed.off
tetrahedron | sed '$d' | sed 's/^4 4 0/4 3 0/' >open.off
tetrahedron | sed 's/^3 0 2 1$/3 0 1 2/' >mixed.off
printf 'OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 1\n' >sheet.off
# Triangles that share nothing.
printf 'OFF\n6 2 0\n0 0 0\n1 0 0\n0 1 0\n0.2 0.2 -1\n0.2 0.3 1\n0.4 0.2 1\n3 0 1 2\n3 3 4 5\n' >crossing.off

expect 0 'changed: nothing' "$P" closed.off -o p.off
expect 0 'changed: .*triangles turned' "$P" mixed.off -o p.off --verify --report r.json
grep -q '"every_triangle_inside": "verified"' r.json || fail "no answer in $(cat r.json)"
expect 0 '1 holes filled' "$P" open.off -o p.off --report r.json
python3 - <<'END' || fail "place and size of the hole: $(cat r.json)"
import json
hole = [r for r in json.load(open("r.json"))["repairs"] if r["kind"].startswith("hole")][0]
assert abs(hole["size"] - 2 ** 0.5) < 1e-6 and hole["place"] == [0, 0.5, 0.5], hole
END
shows 0 'verified' "$V" mesh --outer open.off p.off --raw
expect 3 'prepare wrap' "$P" open.off -o none.off --prepare strict
expect 3 'prepare wrap' "$P" sheet.off -o none.off
expect 3 '' "$P" crossing.off -o none.off --prepare strict
expect 1 '' "$P" open.off -o kept.off --prepare off
expect 2 '--seal needs --prepare wrap' "$P" open.off -o none.off --seal 1%
expect 2 '' "$P" open.off -o none.off --prepare wrap --seal 0
expect 2 '' "$P" open.off -o none.off --prepare other

for f in closed open sheet crossing; do
  expect 0 'each lies inside, exactly' "$P" $f.off -o w.stl --prepare wrap --seal 4%
  shows 0 'verified' "$V" mesh --outer $f.off w.stl --raw
  expect 0 '' "$BIN/bmesh-decimate" $f.off -o d.stl --prepare wrap --epsilon 5% --effort fast
  shows 0 'verified' "$V" mesh --outer $f.off d.stl --raw
done
for f in closed open sheet crossing; do
  expect 0 'each lies inside, exactly' "$BIN/bcd-decompose" $f.off -o b.glb --prepare wrap --epsilon 5% --effort fast --no-cache --report r.json
  shows 0 'verified' "$V" cover $f.off b.glb --raw
  grep -q '"of": "a wrap round all triangles of the input' r.json || fail "what is covered, in $(cat r.json)"
  python3 - <<'END' || fail "epsilon of bodies round a wrap: $(cat r.json)"
import json
r = json.load(open("r.json"))
assert r["reach"]["upper_percent"] <= 5 and 0 < r["wrap"]["farthest_upper"] < r["reach"]["upper"], r
END
done
# Sheets meant as plates: a wrap gives them a thickness within epsilon, on both sides; auto fills what they go round.
python3 - <<'END'
import math
n = 12
with open("tube.off", "w") as f:
    print("OFF\n%d %d 0" % (2 * n, 2 * n), file=f)
    for z in (0, 2):
        for i in range(n):
            print(math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n), z, file=f)
    for i in range(n):
        j = (i + 1) % n
        print("3 %d %d %d\n3 %d %d %d" % (i, j, n + j, i, n + j, n + i), file=f)
END
printf 'OFF\n6 4 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n0 1 1\n3 0 1 2\n3 0 2 3\n3 0 3 5\n3 0 5 4\n' >bent.off
for f in tube bent; do
  expect 0 '' "$BIN/bmesh-decimate" $f.off -o plate.ply --prepare wrap --epsilon 3% --effort fast --report r.json
  shows 0 'verified' "$V" mesh --outer $f.off plate.ply --raw
  shows 0 'Hausdorff' "$BIN/hausdorff-eval" plate.ply $f.off --at-most 3%
  expect 0 '' "$BIN/bcd-decompose" $f.off -o plate.glb --prepare wrap --epsilon 3% --effort fast --no-cache
  shows 0 'verified' "$V" cover $f.off plate.glb --raw --epsilon 3%
  expect 0 'holes filled\|hole filled' "$P" $f.off -o full.ply
  expect 1 '' "$BIN/hausdorff-eval" full.ply $f.off --at-most 3%
done
expect 3 'have a wrap give the sheets a thickness' "$BIN/bmesh-decimate" sheet.off -o none.off --epsilon 5% --prepare strict
for f in sheet crossing; do
  expect 0 'the input is wrapped' "$BIN/bmesh-decimate" $f.off -o auto.ply --epsilon 5% --effort fast
  shows 0 'verified' "$V" mesh --outer $f.off auto.ply --raw
done
expect 3 'Nor is it wrapped' "$BIN/bmesh-decimate" sheet.off -o none.off --epsilon 1e-9
# Quads that are not plane: both ways of splitting them are enclosed, and enclose.
bent_box() { # CORNERS OF THE TOP: as given, or turned by one
  printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1.2\nv 1 1 1\nv 0 1 1.1\n'
  printf 'f 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n%s\n' "$1"
}
bent_box 'f 5 6 7 8' >bent-a.obj
bent_box 'f 6 7 8 5' >bent-b.obj
expect 0 '1 polygon is not plane, by up to 0' "$BIN/bmesh-decimate" bent-a.obj -o bent.ply --vertices 8
for f in bent-a bent-b; do
  for g in bent-a bent-b; do
    expect 0 '' "$BIN/bmesh-decimate" $f.obj -o bent.ply --vertices 8
    shows 0 'verified' "$V" mesh --outer $g.obj bent.ply
    expect 0 '' "$BIN/bmesh-decimate" $f.obj -o bent.ply --vertices 8 --direction inner
    shows 0 'verified' "$V" mesh --inner $g.obj bent.ply
    expect 0 '' "$BIN/bcd-decompose" $f.obj -o bent.glb --epsilon 5% --no-cache
    shows 0 'verified' "$V" cover $g.obj bent.glb
    expect 0 '' "$BIN/bmesh-decimate" $f.obj -o bent.ply --prepare wrap --epsilon 5% --effort fast
    shows 0 'verified' "$V" mesh --outer $g.obj bent.ply --raw
  done
done
expect 3 'have a wrap give the sheets a thickness' "$BIN/bcd-decompose" sheet.off -o none.glb --no-cache --prepare strict
expect 0 'A wrap takes the place of the mesh, so that every triangle is inside' "$BIN/bcd-decompose" sheet.off -o thick.glb --no-cache
shows 0 'verified' "$BIN/bound-verify" cover sheet.off thick.glb --raw
# From the cache the same, and of other lengths another.
for i in 1 2; do
  expect 0 'each lies inside, exactly' env KABOUM_CACHE="$PWD/cache" "$BIN/bcd-decompose" crossing.off -o c$i.glb --prepare wrap --epsilon 5% --effort fast --report c$i.json
done
cmp c1.glb c2.glb || fail "another set from the cache"
grep -q '"cached": true' c2.json || fail "not from the cache: $(cat c2.json)"
expect 0 '' env KABOUM_CACHE="$PWD/cache" "$BIN/bcd-decompose" crossing.off -o c3.glb --prepare wrap --seal 9% --epsilon 20% --effort fast --report c3.json
grep -q '"cached": false' c3.json || fail "another request's set: $(cat c3.json)"
expect 3 'the mesh is open' "$BIN/bcd-decompose" open.off -o none.glb --prepare strict --no-cache
expect 3 '' "$BIN/bcd-decompose" open.off -o none.glb --prepare off --no-cache
expect 2 'direction outer' "$BIN/bcd-decompose" closed.off -o none.glb --prepare wrap --direction inner
expect 2 'prepare wrap' "$BIN/bcd-decompose" closed.off -o none.glb --prepare wrap --drop-sheets
expect 2 'prepare wrap' "$BIN/bcd-decompose" closed.off -o none.glb --seal 1%
# The other way round it must be refuted; so must a result that is too small.
"$V" mesh --outer w.stl crossing.off --raw >/dev/null 2>&1 && fail "two triangles hold their wrap"
expect 0 '' "$P" closed.off -o w.off --prepare wrap --seal 4%
sed 's/^1 0 0$/1.5 0 0/' closed.off >larger.off
expect 1 '' "$V" mesh --outer larger.off w.off --raw
# Units are recorded, and not mixed.
expect 0 '' "$P" closed.off -o p.off --unit mm --report r.json
grep -q '"unit": "mm"' r.json || fail "no unit in $(cat r.json)"
tetrahedron_gltf
expect 3 'are in m, not in mm' "$P" t.gltf -o none.off --unit mm
# The same bytes on any number of threads.
"$P" crossing.off -o w1.stl --prepare wrap --threads 1 --quiet
"$P" crossing.off -o w2.stl --prepare wrap --threads 4 --quiet
cmp w1.stl w2.stl || fail "wraps differ"
expect 3 "epsilon" "$P" crossing.off -o none.off --prepare wrap --seal 60% --offset 0.1% --epsilon 0.2%
expect 2 'direction outer' "$BIN/bmesh-decimate" closed.off -o none.off --prepare wrap --epsilon 5% --direction inner
expect 2 'mesh-prepare first' "$BIN/bmesh-decimate" closed.off -o none.off --prepare wrap --epsilon 5% --log l.log
expect 2 '' "$V" mesh --outer closed.off w.stl --raw --prepare
absent none.off
# Sizes beyond those that can be worked on, and lengths that have nothing to do with the mesh.
for size in 1e-100 1e-165 1.7e308; do
  awk -v s="$size" 'BEGIN { print "OFF\n4 4 0\n0 0 0\n" s " 0 0\n0 " s " 0\n0 0 " s "\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3" }' >size.off
  expect 3 'coordinates up to 1e60 and extents from 1e-60 can be worked on' "$P" size.off -o size.ply --prepare wrap
  absent size.ply
done
printf 'OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n' >unit.off
for option in --offset --seal --epsilon; do
  for length in 1e-100 1e100; do
    expect 2 'times the diagonal' "$P" unit.off -o size.ply --prepare wrap $option $length
  done
done
finish
