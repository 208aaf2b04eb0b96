# Bodies that are nearer to the solid in regions: made, decided, and refuted where they are not.
. "$(dirname "$0")/common.sh"
B=$BIN/bcd-decompose
V=$BIN/bound-verify

# A bar with a notch at each end; fine at the one.
python3 - <<'P' || fail "no mesh"
outline = [(0, 0), (10, 0), (10, 1), (9.5, 1), (9.5, 0.5), (8.5, 0.5), (8.5, 1), (1.5, 1), (1.5, 0.5), (0.5, 0.5), (0.5, 1), (0, 1)]
n = len(outline)
# Convex parts of the outline, as triangles between its corners.
quads = [(0, 1, 5, 8), (0, 8, 9), (0, 9, 10, 11), (1, 2, 3, 4), (1, 4, 5), (5, 6, 7, 8)]
faces = []
for q in quads:
    for i in range(1, len(q) - 1):
        a, b, c = q[0], q[i], q[i + 1]
        faces += [(a, c, b), (a + n, b + n, c + n)]
for i in range(n):
    j = (i + 1) % n
    faces += [(i, j, j + n), (i, j + n, i + n)]
with open("notched.off", "w") as out:
    out.write(f"OFF\n{2 * n} {len(faces)} 0\n")
    for z in (0, 1):
        for x, y in outline:
            out.write(f"{x} {y} {z}\n")
    for f in faces:
        out.write("3 %d %d %d\n" % f)
P
echo '{"regions": [{"name": "left", "epsilon": 0.05, "box": [[-1, -1, -1], [1.4, 2, 2]]}]}' >left.json
echo '{"regions": [{"epsilon": 0.05, "half_space": {"normal": [-2, 0, 0], "offset": -16}}]}' >right.json
echo '{"regions": [{"epsilon": 0.05, "ball": {"center": [1, 0.8, 0.5], "radius": 0.2}}]}' >ball.json

sed 's/0.05/0.3/' left.json >wide.json  # flat ends take many spheres
for kind in polytopes boxes spheres capsules mixed; do
  map=left.json
  [ $kind = polytopes ] || [ $kind = boxes ] || map=wide.json
  expect 0 '' "$B" notched.off -o $kind.glb --bodies $kind --epsilon 0.6 --epsilon-map $map --effort fast --no-cache
  shows 0 'the region .left.: verified' "$V" cover notched.off $kind.glb --epsilon 0.6 --epsilon-map $map --report $kind.json
  json $kind.json "r['claims']['regions'][0]['answer'] == 'verified' and r['claims']['regions'][0]['bound'] <= 0.3"
  expect 0 '' "$B" notched.off -o again.glb --bodies $kind --epsilon 0.6 --epsilon-map $map --effort fast --no-cache --threads 1
  cmp $kind.glb again.glb || fail "$kind: other bytes for one thread"
done
# One body for all is within 0.6; the notch of the region is not filled, the other one is.
expect 0 '' "$B" notched.off -o coarse.glb --epsilon 0.6 --effort fast --no-cache --report coarse.json
json coarse.json "r['bodies'] == 1"
for map in left right ball; do
  shows 1 'the region .*: refuted' "$V" cover notched.off coarse.glb --epsilon 0.6 --epsilon-map $map.json
done
shows 0 '^verified' "$V" cover notched.off polytopes.glb --epsilon 0.6 --epsilon-map ball.json
shows 1 'the region .*: refuted' "$V" cover notched.off polytopes.glb --epsilon 0.6 --epsilon-map right.json
# Not from the cache of what was made without regions.
expect 0 '' "$B" notched.off -o coarse.glb --epsilon 0.6 --effort fast
expect 0 '' "$B" notched.off -o fine.glb --epsilon 0.6 --effort fast --epsilon-map left.json
cmp fine.glb polytopes.glb || fail "regions from the cache are others"

# What cannot be.
for text in '' '{' '{"regions": []}' '{"regions": [{"epsilon": 1}]}' '{"regions": [{"box": [[0,0,0],[1,1,1]]}]}' \
    '{"regions": [{"epsilon": -1, "box": [[0,0,0],[1,1,1]]}]}' '{"regions": [{"epsilon": 1, "box": [[2,0,0],[1,1,1]]}]}' \
    '{"regions": [{"epsilon": 1, "ball": {"center": [0,0,0], "radius": 0}}]}' \
    '{"regions": [{"epsilon": 1, "half_space": {"normal": [0,0,0], "offset": 0}}]}' \
    '{"regions": [{"epsilon": 1, "box": [[0,0,0],[1,1,1]], "colour": 1}]}' \
    '{"regions": [{"epsilon": 1, "box": [[0,0,0],[1,1,1]]}], "regions": [{"epsilon": 1, "box": [[0,0,0],[1,1,1]]}]}'; do
  echo "$text" >bad.json
  expect 3 'bad.json' "$B" notched.off -o out.glb --epsilon 0.6 --epsilon-map bad.json
done
for text in '"epsilon": 1, "box": [[0,0,0],[1,1,1]], "box": [[9,9,9],[10,10,10]]' \
    '"epsilon": 1, "ball": {"center": [0,0,0], "radius": 1, "radius": 2}' \
    '"epsilon": 1e999, "box": [[0,0,0],[1,1,1]]' '"epsilon": 1, "box": [[0,0,-1e999],[1,1,1]]'; do
  echo "{\"regions\": [{\"epsilon\": 1, \"ball\": {\"center\": [0,0,0], \"radius\": 1}}, {$text}]}" >bad.json
  expect 3 'bad.json: region 2: .*\(given twice\|out of range\)' "$B" notched.off -o out.glb --epsilon 0.6 --epsilon-map bad.json
  expect 3 'bad.json: region 2: .*\(given twice\|out of range\)' "$V" cover notched.off coarse.glb --epsilon 0.6 --epsilon-map bad.json
done
# A region with an epsilon above that of all else changes nothing, and that is said.
sed 's/0.05/0.7/' left.json >idle.json
expect 0 'left.: verified: nowhere more than 0.7.*; no less than outside of it, so that it changes nothing' \
  "$B" notched.off -o idle.glb --epsilon 0.6 --effort fast --epsilon-map idle.json --no-cache
python3 - coarse.glb idle.glb <<'P' || fail "an idle region changes bodies"
import struct, sys
def bodies(name):
    data = open(name, "rb").read()
    return data[20 + struct.unpack_from("<I", data, 12)[0]:]
assert bodies(sys.argv[1]) == bodies(sys.argv[2])
P

# Regions that no body reaches say nothing: that is noted.
echo '{"regions": [{"name": "far", "epsilon": 0.05, "box": [[100, 100, 100], [101, 101, 101]]}]}' >far.json
expect 0 'no body reaches the region .far.' "$B" notched.off -o far.glb --epsilon 0.6 --effort fast --epsilon-map far.json --no-cache --report far_made.json
json far_made.json "r['cover']['regions'] == [{'name': \"'far'\", 'answer': 'verified', 'bound': 0.05, 'reached': False}]"
expect 0 'region .left.: verified' "$B" notched.off -o left.glb --epsilon 0.6 --effort fast --epsilon-map left.json --report left_made.json
json left_made.json "r['cover']['regions'][0]['reached'] and r['cover']['regions'][0]['bound'] == 0.05"
# The same from the cache.
expect 0 'region .left.: verified' "$B" notched.off -o left.glb --epsilon 0.6 --effort fast --epsilon-map left.json --report left_kept.json
json left_kept.json "r['cover']['regions'][0]['reached'] and r['cover']['regions'][0]['bound'] == 0.05"
shows 0 'no body reaches' "$V" cover notched.off coarse.glb --epsilon 0.6 --epsilon-map far.json
for other in '--max-bodies 3' '--max-total-vertices 99' '--min-thickness 0.1' '--max-aspect 8' '--direction inner'; do
  expect 2 "epsilon-map .*${other%% *}" "$B" notched.off -o out.glb $other --epsilon-map left.json
done
for program in "$B notched.off -o out.glb" "$V cover notched.off coarse.glb"; do
  expect 2 'epsilon-map is empty' $program --epsilon 0.6 --epsilon-map ''
  expect 3 'none.json' $program --epsilon 0.6 --epsilon-map none.json
done
# A map with a unit, of a file without one: what it is taken for is noted on the terminal and in the report.
sed 's/0.05/"50mm"/' left.json >unit.json
for run in made kept; do
  expect 0 'does not state the unit.*: 50mm is brought into m; .*--unit mm' "$B" notched.off -o unit.glb --epsilon 0.6 --effort fast --epsilon-map unit.json --report unit_$run.json
  json unit_$run.json "[n for n in r['notes'] if '50mm is brought into m' in n] and r['cover']['regions'][0]['bound'] == 0.05"
done
json unit_kept.json "r['cached']"
expect 0 '50mm is brought into m, which is that of unit.glb' "$V" cover notched.off unit.glb --epsilon 0.6 --epsilon-map unit.json --report unit_judged.json
json unit_judged.json "[n for n in r['original']['notes'] if '50mm is brought into m' in n]"
expect 0 '' "$B" notched.off -o polytopes.obj --epsilon 0.6 --effort fast --epsilon-map left.json
expect 2 '50mm: the unit of the coordinates is not known' "$V" cover notched.off polytopes.obj --epsilon 0.6 --epsilon-map unit.json
finish
