# Bodies of a robot that are nearer in regions fixed in frames of its links: made, decided, and refuted where they are not.
. "$(dirname "$0")/common.sh"
B=$BIN/bcd-decompose
V=$BIN/bound-verify

# A hand that is a bar with notches, turned in its link, with a finger and a frame that nothing is drawn in.
python3 - <<'P' || fail "no mesh"
notches = [(8.5, 9.5), (6.5, 7.5), (4.5, 5.5), (0.5, 1.5)]
outline = [(0, 0), (10, 0), (10, 1)] + [p for l, r in notches for p in ((r, 1), (r, 0.5), (l, 0.5), (l, 1))] + [(0, 1)]
n = len(outline)
# Convex parts of the outline, as triangles between its corners: below the notches, beside the first, beside others.
quads = [[0, 1] + [3 + 4 * i + k for i in range(len(notches)) for k in (1, 2)], [1, 2, 3, 4], [0, n - 3, n - 2, n - 1]]
quads += [[5 + 4 * i, 6 + 4 * i, 7 + 4 * i, 8 + 4 * i] for i in range(len(notches) - 1)]
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
mesh() { echo "<collision>$1<geometry><mesh filename=\"notched.off\" scale=\"0.01 0.01 0.01\"/></geometry></collision>"; }
cat >arm.urdf <<P
<robot name="arm">
  <link name="base"><collision><geometry><box size="0.2 0.2 0.1"/></geometry></collision></link>
  <link name="forearm">$(mesh '')</link>
  <link name="flange"/>
  <link name="hand">$(mesh '<origin xyz="0.02 -0.01 0.03" rpy="0.3 -0.8 1.1"/>')</link>
  <link name="tcp"/>
  <link name="finger">$(mesh '<origin xyz="0 0.05 0"/>')</link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="forearm"/><origin xyz="0 0 0.1" rpy="0.1 0.2 0.3"/>
    <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="wrist" type="revolute"><parent link="forearm"/><child link="flange"/><origin xyz="0.1 0 0"/>
    <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="mount" type="fixed"><parent link="flange"/><child link="hand"/><origin xyz="0.03 0.01 0" rpy="0.5 0.4 -0.3"/></joint>
  <joint name="point" type="fixed"><parent link="hand"/><child link="tcp"/><origin xyz="0.02 -0.01 0.03" rpy="0.3 -0.8 1.1"/></joint>
  <joint name="grip" type="prismatic"><parent link="hand"/><child link="finger"/><origin xyz="0.02 0 0"/>
    <axis xyz="0 1 0"/><limit lower="0" upper="0.03" effort="1" velocity="1"/></joint>
</robot>
P
# Round one notch of the hand, whose frame tcp has its mesh's axes.
echo '{"regions": [{"name": "notch", "frame": "tcp", "epsilon": "0.5mm", "ball": {"center": [0.01, 0.008, 0.005], "radius": 0.012}}]}' >ball.json
echo '{"regions": [{"name": "notch", "frame": "tcp", "epsilon": "0.5mm", "box": [[-0.01, -0.01, -0.01], [0.014, 0.02, 0.02]]}]}' >box.json
echo '{"regions": [{"name": "notch", "frame": "tcp", "epsilon": "0.5mm", "half_space": {"normal": [2, 0, 0], "offset": 0.028}}]}' >half.json
echo '{"regions": [{"name": "notch", "frame": "tcp", "radius": 0.016, "epsilon": "0.5%"}]}' >share.json

# Polytopes: the hand has more bodies, the other links as many as without a map.
expect 0 '' "$B" arm.urdf -o coarse --epsilon 6mm --effort fast --report coarse.json
expect 0 '' "$B" arm.urdf -o fine --epsilon 0.5mm --effort fast --report fine.json
count() { python3 -c "
import json, sys
r = json.load(open(sys.argv[1]))
print(*(l['bodies'] for l in r['links'] if l['link'] == sys.argv[2]))" "$1" "$2"; }
for map in ball box half share; do
  expect 0 'distance in the region .notch.: verified: nowhere more than 0.0005' "$B" arm.urdf -o $map --epsilon 6mm --effort fast --epsilon-map $map.json --report $map.made.json
  json $map.made.json "[(g['name'], g['links'], g['answer'], g['reached']) for g in r['regions']] == [(\"'notch'\", ['hand'], 'verified', True)]"
  json $map.made.json "'--epsilon 0.006 --epsilon-map $map.json' in r['check']"
  shows 0 '^verified' "$V" robot arm.urdf $map/arm.urdf --prepare --epsilon 6mm --epsilon-map $map.json --report $map.json.report
  json $map.json.report "[s['region'] for l in r['links'] for s in l['shapes'] if 'region' in s and s['answer'] == 'verified' and s['reached']] == [\"'notch'\"]"
  shows 1 'hand.: refuted: .*in the region .notch. at least' "$V" robot arm.urdf coarse/arm.urdf --prepare --epsilon 6mm --epsilon-map $map.json
  for link in forearm finger; do
    [ "$(count $map.made.json $link)" = "$(count coarse.json $link)" ] || fail "$map: a map of the hand changes $link"
  done
  [ "$(count $map.made.json hand)" -gt "$(count coarse.json hand)" ] || fail "$map: the hand has no more bodies than without"
  [ "$(count $map.made.json hand)" -lt "$(count fine.json hand)" ] || fail "$map: the hand has as many bodies as if all were fine"
done
shows 0 '^verified' "$V" robot arm.urdf coarse/arm.urdf --prepare --epsilon 6mm
# Other notches are not of the region: all of them within it would take more bodies.
echo '{"regions": [{"name": "rest", "frame": "tcp", "epsilon": "0.5mm", "half_space": {"normal": [-1, 0, 0], "offset": -0.03}}]}' >rest.json
shows 1 'hand.: refuted: .*in the region .rest. at least' "$V" robot arm.urdf ball/arm.urdf --prepare --epsilon-map rest.json
shows 0 '^verified' "$V" robot arm.urdf fine/arm.urdf --prepare --epsilon-map rest.json
# One more body, in the notch: farther from its walls than the region allows, and nearer than 6 mm. Beside it, it may be.
add_body() {
  rm -rf out
  cp -r ball out
  python3 - "$1" <<'P' || fail "no body is added"
import re, struct, sys
left = float(sys.argv[1])
low, high = (left, 0.4, 0.4), (left + 0.2, 0.7, 0.6)
faces = []
for k in range(3):
    for side in (0, 1):
        corners = []
        for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
            bits = [0, 0, 0]
            bits[k], bits[(k + 1) % 3], bits[(k + 2) % 3] = side, u, v
            corners.append(tuple(high[i] if bits[i] else low[i] for i in range(3)))
        if side == 0:
            corners.reverse()
        faces += [(corners[0], corners[1], corners[2]), (corners[0], corners[2], corners[3])]
with open("out/more.stl", "wb") as stl:
    stl.write(bytes(80) + struct.pack("<I", len(faces)))
    for f in faces:
        stl.write(struct.pack("<3f", 0, 0, 0) + b"".join(struct.pack("<3f", *p) for p in f) + bytes(2))
text = open("out/arm.urdf").read()
at = text.index("<collision", text.index('<link name="hand"'))
end = text.index("</collision>", at) + len("</collision>")
more = re.sub(r'filename="[^"]*"', 'filename="more.stl"', text[at:end])
open("out/arm.urdf", "w").write(text[:at] + more + text[at:])
P
}
add_body 0.9
shows 1 'in the region .notch. at least' "$V" robot arm.urdf out/arm.urdf --prepare --epsilon 6mm --epsilon-map ball.json
shows 0 '^verified' "$V" robot arm.urdf out/arm.urdf --prepare --epsilon 6mm
add_body 4.9
shows 0 '^verified' "$V" robot arm.urdf out/arm.urdf --prepare --epsilon 6mm --epsilon-map ball.json

# Bodies with radii, in one file; lengths only. Balls take many: the region is no finer than needed.
sed 's/0.5mm/3mm/' ball.json >wide.json
for kind in boxes capsules mixed spheres; do
  map=ball.json
  file=urdf
  judge=--bodies
  [ $kind = boxes ] || map=wide.json
  [ $kind != spheres ] || { file=yaml; judge=--spheres; }
  expect 0 'distance in the region .notch.: verified' "$B" arm.urdf -o $kind.$file --bodies $kind --links hand,finger --epsilon 6mm --effort fast --epsilon-map $map
  shows 0 '^verified' "$V" robot arm.urdf $judge $kind.$file --links hand,finger --epsilon 6mm --epsilon-map $map --report $kind.json
  json $kind.json "[(g['name'], g['answer'], g['reached']) for l in r['links'] for g in l['claims'].get('regions', [])] == [(\"'notch'\", 'verified', True)]"
  expect 0 '' "$B" arm.urdf -o again.$file --bodies $kind --links hand,finger --epsilon 6mm --effort fast --epsilon-map $map --no-cache --threads 1
  sed "s/again/$kind/" again.$file | cmp - $kind.$file || fail "$kind: other bytes for one thread, or from the cache"
  expect 0 '' "$B" arm.urdf -o plain.$file --bodies $kind --links hand,finger --epsilon 6mm --effort fast
  shows 0 '^verified' "$V" robot arm.urdf $judge plain.$file --links hand,finger --epsilon 6mm
  shows 1 'hand.: refuted: .*in the region .notch. they reach' "$V" robot arm.urdf $judge plain.$file --links hand,finger --epsilon 6mm --epsilon-map $map
  grep -q "^refuted: .*; farther than asked in the region 'notch' of 'hand'" out.txt || fail "the summary does not name the region: $(grep ^refuted out.txt)"
done

# The command that is printed decides it as it is, whatever the lengths are stated in.
echo '{"regions": [{"name": "notch", "frame": "tcp", "radius": 0.016, "epsilon": "3%"}, {"link": "finger", "epsilon": "5%"}]}' >shares.json
for kind in polytopes boxes capsules mixed spheres; do
  for epsilon in 6mm 6%; do
    file=shares-$kind.urdf
    case $kind in polytopes) file=shares ;; spheres) file=shares.yaml ;; esac
    expect 0 '' "$B" arm.urdf -o $file --bodies $kind --links hand,finger --epsilon $epsilon --effort fast --epsilon-map shares.json
    command=$(sed -n 's/^from the files alone: //p' err.txt)
    case $command in *--epsilon-map*) ;; *) fail "$kind, $epsilon: no map in: $command" ;; esac
    shows 0 '^verified' sh -c "$BIN/$command --report printed.json"
    [ $kind = polytopes ] || json printed.json "abs(next(g['bound'] for l in r['links'] if l['link'] == 'hand' for g in l['claims']['regions']) - 0.03 * 0.01 * 102 ** .5) < 1e-9"
  done
done
shows 0 "^verified" "$V" robot arm.urdf --bodies boxes.urdf --links hand,finger --epsilon-map share.json
shows 1 "hand.: refuted: .*in the region .notch. they reach" "$V" robot arm.urdf --bodies capsules.urdf --links hand,finger --epsilon-map share.json

# A body on a link of the region's group that has no shape is near none.
for at in tcp flange; do
  rm -rf out
  cp -r ball out
  sed "s,<link name=\"$at\" */>,<link name=\"$at\"><collision><geometry><box size=\"0.5 0.5 0.5\"/></geometry></collision></link>," ball/arm.urdf >out/arm.urdf
  grep -q '0.5 0.5 0.5' out/arm.urdf || fail "no body at $at"
  shows 7 'undecided' "$V" robot arm.urdf out/arm.urdf --prepare --epsilon-map ball.json
  sed "s,<link name=\"$at\" */>,<link name=\"$at\"><collision><geometry><box size=\"0.5 0.5 0.5\"/></geometry></collision></link>," boxes.urdf >out.urdf
  grep -q '0.5 0.5 0.5' out.urdf || fail "no body at $at"
  shows 7 "link '$at': undecided: it has no shape" "$V" robot arm.urdf --bodies out.urdf --links hand,finger,$at --epsilon-map ball.json
  shows 7 "link '$at': undecided: it has no shape" "$V" robot arm.urdf --bodies out.urdf --links hand,finger,$at --epsilon 6mm
done
python3 - <<'P' || fail "no sphere at tcp"
import re
text = open("spheres.yaml").read()
text = text.replace('collision_link_names: [', 'collision_link_names: ["tcp", ', 1)
own = re.search(r'^  "hand":\n(    - center.*\n      radius.*\n)', text, re.M)
text = text[:own.start()] + '  "tcp":\n' + own.group(1) + text[own.start():]
count = text.count("radius:")
open("out.yaml", "w").write(re.sub(r"^(# spheres in this file: )\d+$", rf"\g<1>{count}", text, flags=re.M))
P
expect 7 "link 'tcp': undecided: it has no shape" "$V" robot arm.urdf --spheres out.yaml --links hand,finger,tcp --epsilon 6mm

# A scale that differs by axis makes ellipsoids of balls: the balls that are written reach farther, which is said.
sed 's/0.01 0.01 0.01/0.01 0.015 0.007/' arm.urdf >uneven.urdf
expect 1 'its scale differs by axis' "$B" uneven.urdf -o uneven.yaml --bodies spheres --links hand --epsilon 6mm --effort fast
expect 1 'in the region .notch.: NOT verified' "$B" uneven.urdf -o uneven.yaml --bodies spheres --links hand --epsilon 6mm --effort fast --epsilon-map wide.json
expect 0 '' "$B" uneven.urdf -o uneven.urdf.d --links hand --epsilon 6mm --effort fast --epsilon-map wide.json

# Whole links: the same as a line of --epsilons.
echo '{"regions": [{"link": "finger", "epsilon": "0.5mm"}]}' >link.json
echo 'finger: 0.5mm' >link.yaml
expect 0 '' "$B" arm.urdf -o by_map --epsilon 6mm --effort fast --epsilon-map link.json --report by_map.json
expect 0 '' "$B" arm.urdf -o by_line --epsilon 6mm --effort fast --epsilons link.yaml
cmp by_map/links/finger.glb by_line/links/finger.glb || fail "a link of a map is not as a line of --epsilons"
[ "$(count by_map.json finger)" -gt "$(count coarse.json finger)" ] || fail "the finger is not finer"
shows 0 '^verified' "$V" robot arm.urdf by_map/arm.urdf --prepare --epsilon 6mm --epsilon-map link.json
shows 1 'finger.: refuted' "$V" robot arm.urdf coarse/arm.urdf --prepare --epsilon 6mm --epsilon-map link.json
expect 2 'epsilon-map .*epsilons' "$B" arm.urdf -o x --epsilon 6mm --epsilon-map link.json --epsilons link.yaml

# What is no finer than elsewhere changes nothing.
sed 's/"epsilon": [^,}]*/"epsilon": "8mm"/' ball.json >idle.json
expect 0 'notch.: verified: .*it changes nothing' "$B" arm.urdf -o idle --epsilon 6mm --effort fast --epsilon-map idle.json

# What no body reaches is noted.
sed 's/0.01, 0.008/3, 3/' ball.json >far.json
expect 0 'no body reaches the region .notch.' "$B" arm.urdf -o far --epsilon 6mm --effort fast --epsilon-map far.json
expect 0 'no body of a mesh reaches the region .notch.' "$V" robot arm.urdf far/arm.urdf --prepare --epsilon 6mm --epsilon-map far.json

# What cannot be.
for text in '{"frame": "tpc", "radius": 1, "epsilon": 1}' '{"frame": "tcp", "epsilon": 1}' '{"radius": 1, "epsilon": 1}' \
    '{"frame": "tcp", "radius": 1}' '{"frame": "tcp", "radius": 1, "epsilon": 1, "epsilon": 2}' '{"link": "tcp", "epsilon": 1}' \
    '{"link": "hand", "radius": 1, "epsilon": 1}' '{"frame": "tcp", "radius": 1, "epsilon": 1, "colour": 2}' \
    '{"epsilon": 1, "box": [[0,0,0],[1,1,1]]}'; do
  echo "{\"regions\": [$text]}" >bad.json
  expect 3 'bad.json: region 1: ' "$B" arm.urdf -o x --epsilon 6mm --epsilon-map bad.json
  expect 3 'bad.json: region 1: ' "$V" robot arm.urdf coarse/arm.urdf --epsilon-map bad.json
  expect 3 'bad.json: region 1: ' "$V" robot arm.urdf --bodies boxes.urdf --epsilon-map bad.json
done
echo '{"regions": [{"frame": "hannd", "radius": 1, "epsilon": 1}]}' >bad.json
expect 3 "no frame 'hannd'; did you mean 'hand'" "$B" arm.urdf -o x --epsilon 6mm --epsilon-map bad.json
expect 3 "no shape that is meant is fixed to frame 'tcp'" "$B" arm.urdf -o x --links forearm --epsilon 6mm --epsilon-map ball.json
expect 3 'a mesh has no frames' "$B" notched.off -o x.glb --epsilon 0.6 --epsilon-map ball.json
for other in '--robot-bodies 9' '--robot-vertices 99' '--max-bodies 3' '--min-thickness 1mm' '--max-aspect 9'; do
  expect 2 'epsilon-map' "$B" arm.urdf -o x $other --epsilon-map ball.json
done
expect 3 'none.json' "$V" robot arm.urdf ball/arm.urdf --epsilon-map none.json
expect 2 'epsilon-map is empty' "$V" robot arm.urdf ball/arm.urdf --epsilon-map ''
expect 2 'epsilon-map is empty' "$B" arm.urdf -o x --epsilon 6mm --epsilon-map ''

# A percentage is of the link's own size, where scales differ by axis, too.
printf 'OFF\n8 12 0\n' >slab.off
for z in -5 5; do for y in -5 5; do for x in -0.5 0.5; do echo "$x $y $z" >>slab.off; done; done; done
printf '3 0 2 3\n3 0 3 1\n3 4 5 7\n3 4 7 6\n3 0 1 5\n3 0 5 4\n3 2 6 7\n3 2 7 3\n3 0 4 6\n3 0 6 2\n3 1 3 7\n3 1 7 5\n' >>slab.off
echo '<robot name="slab"><link name="base"><collision><geometry><mesh filename="slab.off" scale="10 0.1 0.1"/></geometry></collision></link></robot>' >slab.urdf
echo '{"regions": [{"link": "base", "epsilon": "1%"}]}' >slab.json
printf 'collision_spheres:\n  base:\n    - center: [0, 0, 0]\n      radius: 6\n' >slab.yaml
expect 1 '' "$V" robot slab.urdf --spheres slab.yaml --epsilon-map slab.json
finish
