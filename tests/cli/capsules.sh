# Covers by capsules, boxes and mixed bodies: made, decided, and mutants of them.
. "$(dirname "$0")/common.sh"
B=$BIN/bcd-decompose
V=$BIN/bound-verify

printf 'OFF\n8 12 0\n0 0 0\n4 0 0\n0 1 0\n4 1 0\n0 0 1\n4 0 1\n0 1 1\n4 1 1\n' >bar.off
for t in '0 2 1' '1 2 3' '4 5 6' '5 7 6' '0 1 4' '1 5 4' '2 6 3' '3 6 7' '0 4 2' '2 4 6' '1 3 5' '3 7 5'; do
  echo "3 $t" >>bar.off
done

# Within epsilon, and by a number of them; the same bytes for any number of threads.
for kind in capsules boxes mixed; do
  expect 0 '' "$B" bar.off -o $kind.glb --bodies $kind --epsilon 0.4 --effort fast --no-cache --report $kind.json
  json $kind.json "1 <= r['bodies'] <= 4 and r['reach']['upper'] <= 0.4"
  shows 0 '^verified' "$V" cover bar.off $kind.glb --epsilon 0.4
  expect 0 '' "$B" bar.off -o again.glb --bodies $kind --epsilon 0.4 --effort fast --no-cache --threads 1
  cmp $kind.glb again.glb
done
json boxes.json "r['bodies'] == 1"
expect 0 '' "$B" bar.off -o three.glb --bodies capsules --max-bodies 3 --effort fast --no-cache --report three.json
json three.json "r['bodies'] <= 3"
shows 0 '^verified' "$V" cover bar.off three.glb

# From the cache, the second time.
expect 0 '' "$B" bar.off -o capsules.glb --bodies capsules --epsilon 0.4 --effort fast
"$B" bar.off -o again.glb --bodies capsules --epsilon 0.4 --effort fast 2>&1 | grep -q 'from the cache' || fail "not from the cache"
cmp capsules.glb again.glb

# A capsule that is a little thinner holds it no more.
python3 - <<'P' || fail "no radius to change"
import json, struct
data = bytearray(open("three.glb", "rb").read())
length = struct.unpack_from("<I", data, 12)[0]
text = data[20:20 + length].decode()
scene = json.loads(text)
def shrink(node):
    found = 0
    if isinstance(node, dict):
        for key, value in node.items():
            if key == "radius" and isinstance(value, (int, float)):
                node[key] = value * 0.8
                found += 1
            elif key == "radii" and isinstance(value, list):
                node[key] = [0.8 * x for x in value]
                found += 1
            else:
                found += shrink(value)
    elif isinstance(node, list):
        for value in node:
            found += shrink(value)
    return found
assert shrink(scene) > 0
out = json.dumps(scene).encode()
out += b" " * (-len(out) % 4)
rest = bytes(data[20 + length:])
open("thin.glb", "wb").write(struct.pack("<III", 0x46546C67, 2, 20 + len(out) + len(rest)) + struct.pack("<II", len(out), 0x4E4F534A) + out + rest)
P
shows 1 '^refuted' "$V" cover bar.off thin.glb

# What means nothing beside them.
expect 2 'bodies' "$B" bar.off -o x.glb --bodies capsules --direction inner
expect 2 'min-thickness' "$B" bar.off -o x.glb --bodies boxes --min-thickness 0.1
expect 2 'only .glb states radii' "$B" bar.off -o x.obj --bodies capsules
expect 0 '' "$B" bar.off -o boxes.obj --bodies boxes --epsilon 0.4 --effort fast
shows 0 '^verified' "$V" cover bar.off boxes.obj --epsilon 0.4

# A robot: its shapes, written, judged, and judged with one digit less.
cat >arm.urdf <<'U'
<robot name="arm">
  <link name="base"><collision><origin xyz="0.1 0.2 0.3" rpy="0.3 0.2 0.1"/><geometry><mesh filename="bar.off"/></geometry></collision></link>
  <link name="hand"><collision><origin xyz="0 0 1" rpy="0.1 0 0.7"/><geometry><box size="0.1 0.1 1"/></geometry></collision><collision><geometry><sphere radius="0.5"/></geometry></collision></link>
  <joint name="j" type="fixed"><parent link="base"/><child link="hand"/></joint>
</robot>
U
expect 2 '.urdf' "$B" arm.urdf -o arm.yaml --bodies capsules --epsilon 0.4
for kind in capsules boxes mixed; do
  expect 0 '' "$B" arm.urdf -o $kind.urdf --bodies $kind --epsilon 0.4 --effort fast --no-cache --report robot.json
  json robot.json "r['bodies'] >= 2 and r['reach_upper'] <= 0.4001"
  shows 0 '^verified: .* hold 2 of 2 links' "$V" robot arm.urdf --bodies $kind.urdf --report judged.json
  json judged.json "r['verdict'] == 'verified' and r['links_held'] == 2"
done
shows 0 '^verified' "$V" robot arm.urdf --bodies boxes.urdf --links base
# Every size of every shape, one after the other, made half as large: none is verified then.
python3 - "$V" <<'P' || fail "mutants of boxes"
import re, subprocess, sys
text = open("boxes.urdf").read()
places = list(re.finditer(r'size="([^"]*)"', text))
refuted = 0
for place in places:
    smaller = " ".join(repr(0.5 * float(x)) for x in place.group(1).split())
    open("mutant.urdf", "w").write(text[:place.start(1)] + smaller + text[place.end(1):])
    code = subprocess.run([sys.argv[1], "robot", "arm.urdf", "--bodies", "mutant.urdf"], capture_output=True).returncode
    # Of a round shape without triangles it is not decided that it sticks out.
    assert code in (1, 7), code
    refuted += code == 1
assert refuted >= 2, (refuted, len(places))
P
# A link whose shapes are gone; a mesh; a stranger.
sed '/<link name="hand"/,/<\/link>/{/collision/,/\/collision/d}' boxes.urdf >gone.urdf
shows 1 "link 'hand': refuted" "$V" robot arm.urdf --bodies gone.urdf
expect 3 'this is a mesh' "$V" robot arm.urdf --bodies arm.urdf
# Without --bodies each mesh would need a closed mesh that holds it: the way out is named.
expect 7 'bound-verify robot arm.urdf --bodies boxes.urdf' "$V" robot arm.urdf boxes.urdf
sed 's/"base"/"bsae"/g' boxes.urdf >stranger.urdf
expect 3 "no link 'bsae'" "$V" robot arm.urdf --bodies stranger.urdf
expect 2 'state one' "$V" robot arm.urdf arm.urdf --bodies boxes.urdf
# Frames elsewhere, however large the shapes are.
cat >turning.urdf <<'U'
<robot name="r">
  <link name="a"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="b"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="c"/>
  <joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 1"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="k" type="revolute"><parent link="b"/><child link="c"/><limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="j" multiplier="2"/></joint>
</robot>
U
sed 's/0.2 0.2 0.2/0.3 0.3 0.3/' turning.urdf >turning-bodies.urdf
shows 0 '^joints: verified' "$V" robot turning.urdf --bodies turning-bodies.urdf --report judged.json
json judged.json "r['verdict'] == 'verified' and r['joints'] == {'answer': 'verified', 'reason': ''}"
while IFS='|' read -r edit words; do
  sed "$edit" turning-bodies.urdf >moved.urdf
  cmp -s moved.urdf turning-bodies.urdf && fail "nothing was changed by $edit"
  shows 1 "^joints: refuted: $words" "$V" robot turning.urdf --bodies moved.urdf --report judged.json
  json judged.json "r['verdict'] == 'refuted' and r['joints']['answer'] == 'refuted' and r['links_held'] == 2"
done <<'E'
s/xyz="0 0 1"\/><axis/xyz="0 0 3"\/><axis/|joint 'j' has another origin
s/axis xyz="0 0 1"/axis xyz="1 0 0"/|joint 'j' has another axis
s/name="j" type="revolute"/name="j" type="prismatic"/|joint 'j' is of another type
s/multiplier="2"/multiplier="3"/|joint 'k' mimics in another way
s/lower="-1"/lower="-2"/|joint 'j' has other limits
s/<parent link="b"/<parent link="a"/|joint 'k' has another parent
s/"c"/"d"/|the result has no link 'c'
E
expect 2 'epsilon' "$V" robot arm.urdf --bodies boxes.urdf --epsilon 1%

# <capsule>: of the file, and of the robot. 0.3 long with 0.1 at its ends, it holds the box; a little less does not.
link() { echo "<robot name=\"r\" version=\"1.2\"><link name=\"a\"><collision>$1</collision></link></robot>"; }
at='<origin xyz="0.1 0.2 0.3" rpy="0.1 0.2 0.3"/>'
capsule() { link "$at<geometry><capsule radius=\"$1\" length=\"$2\"/></geometry>"; }
link "$at<geometry><box size=\"0.12 0.12 0.3\"/></geometry>" >box.urdf
capsule 0.1 0.3 >capsule.urdf
shows 0 '^verified: 1 shape holds 1 of 1 link$' "$V" robot box.urdf --bodies capsule.urdf
capsule 0.09 0.25 >thin.urdf  # sqrt(0.06² + 0.06² + 0.025²) is 0.0885
shows 0 '^verified' "$V" robot box.urdf --bodies thin.urdf
capsule 0.088 0.25 >thin.urdf
shows 1 "link 'a': refuted: .* triangles stick out" "$V" robot box.urdf --bodies thin.urdf
capsule 0.1 0 >ball.urdf
shows 1 "link 'a': refuted: .* triangles stick out" "$V" robot box.urdf --bodies ball.urdf
shows 0 '^verified' "$V" robot capsule.urdf --bodies capsule.urdf
shows 7 '^undecided' "$V" robot ball.urdf --bodies capsule.urdf  # but for what the pose is rounded by
capsule 0.0999999 0 >ball.urdf
shows 0 '^verified' "$V" robot ball.urdf --bodies capsule.urdf
for size in '0.101 0.3' '0.1 0.301' '0.102 0.298'; do
  # shellcheck disable=SC2086
  capsule $size >other.urdf
  shows 0 '^verified' "$V" robot capsule.urdf --bodies other.urdf
  shows 7 '^undecided' "$V" robot other.urdf --bodies capsule.urdf
done
link "$at<geometry><cylinder radius=\"0.1\" length=\"0.3\"/></geometry>" >cylinder.urdf
shows 0 '^verified' "$V" robot cylinder.urdf --bodies cylinder.urdf
shows 7 '^undecided' "$V" robot capsule.urdf --bodies cylinder.urdf
shows 7 '^undecided' "$V" robot cylinder.urdf --bodies capsule.urdf
# As the program writes it: of a robot with a capsule.
expect 0 '' "$B" capsule.urdf -o written.urdf --bodies capsules --epsilon 0.05 --effort fast --no-cache
shows 0 '^verified' "$V" robot capsule.urdf --bodies written.urdf
# An ellipsoid is held, but does not hold.
model() { echo "<mujoco model=\"m\"><worldbody><body name=\"a\"><geom type=\"$1\"/></body></worldbody></mujoco>"; }
model 'ellipsoid" size="0.1 0.2 0.3' >ellipsoid.xml
model 'sphere" size="0.31' >sphere.xml
shows 0 '^verified' "$V" robot ellipsoid.xml --bodies sphere.xml
expect 3 "ellipsoid.xml:[0-9]*: link 'a': .*this is an ellipsoid" "$V" robot ellipsoid.xml --bodies ellipsoid.xml

# The ball at a capsule's end, written beside it, is no body of its own: with both, points of a concave edge of two boxes
# which that surface nearly touches would stay undecided.
{
  printf 'OFF\n12 10 0\n'
  for x in -1 1; do printf -- "$x %s\n" '-1 -1' '1 -1' '1 0' '0 0' '0 1' '-1 1'; done
  printf '%s\n' '4 3 2 1 0' '4 5 4 3 0' '4 6 7 8 9' '4 6 9 10 11' '4 0 1 7 6' '4 1 2 8 7' '4 2 3 9 8' '4 3 4 10 9' '4 4 5 11 10' '4 5 0 6 11'
} >corner.off
link '<geometry><mesh filename="corner.off"/></geometry>' >corner.urdf
python3 - <<'P' >touching.urdf
import math
# Boxes that reach beyond the faces by 5e-13 at the edge, more than their poses are rounded by.
more = 5e-13
shapes = [f'<box size="2.1 2.1 {1.1 + 2 * more!r}"/>', f'<box size="2.1 {1.1 + 2 * more!r} 2.1"/>']
places = [(0, 0, -0.55), (0, -0.55, 0)]
center, radius = (0.0, 0.3, 0.3), math.sqrt(0.18 + 1e-10)
for at, shape in [(center, f'<sphere radius="{radius!r}"/>'), ((0.0, 0.3, 1.3), f'<sphere radius="{radius!r}"/>'),
                  ((0.0, 0.3, 0.8), f'<cylinder radius="{radius!r}" length="1.0"/>')]:
    places.append(at)
    shapes.append(shape)
print('<robot name="r"><link name="a">' + "".join(
    f'<collision><origin xyz="{x!r} {y!r} {z!r}"/><geometry>{s}</geometry></collision>' for (x, y, z), s in zip(places, shapes)) +
    '</link></robot>')
P
shows 0 '^verified' "$V" robot corner.urdf --bodies touching.urdf
# What needs a whole ball: corners on its surface.
{
  printf 'OFF\n6 8 0\n'
  for p in '0.25 0 0' '-0.25 0 0' '0 0.25 0' '0 -0.25 0' '0 0 0.25' '0 0 -0.25'; do echo "$p"; done
  for t in '0 2 4' '2 1 4' '1 3 4' '3 0 4' '2 0 5' '1 2 5' '3 1 5' '0 3 5'; do echo "3 $t"; done
} >octahedron.off
link '<geometry><mesh filename="octahedron.off"/></geometry>' >octahedron.urdf
part() { echo "<collision><origin xyz=\"0 0 $1\"/><geometry><$2/></geometry></collision>"; }
{
  echo '<robot name="r"><link name="a">'
  part 0 'sphere radius="0.25"'
  part 1 'sphere radius="0.25"'
  part 0.5 'cylinder radius="0.25" length="1"'
  echo '</link></robot>'
} >ends.urdf
shows 0 '^verified' "$V" robot octahedron.urdf --bodies ends.urdf
finish
