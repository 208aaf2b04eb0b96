# Files of spheres, capsules and boxes: every format that is written, read back and judged; pairs, scenes, distances.
. "$(dirname "$0")/common.sh"
B=$BIN/bcd-decompose
V=$BIN/bound-verify

printf 'OFF\n8 12 0\n0 0 0\n4 0 0\n0 1 0\n4 1 0\n0 0 1\n4 0 1\n0 1 1\n4 1 1\n' >bar.off
for t in '0 2 1' '1 2 3' '4 5 6' '5 7 6' '0 1 4' '1 5 4' '2 6 3' '3 6 7' '0 4 2' '2 4 6' '1 3 5' '3 7 5'; do
  echo "3 $t" >>bar.off
done
make() { expect 0 '' "$B" "$1" -o "$2" --bodies "$3" --epsilon 0.4 --effort fast; }

cat >arm.urdf <<'U'
<robot name="arm">
  <link name="base"><visual><geometry><mesh filename="bar.off"/></geometry></visual><collision><origin xyz="0.1 0.2 0.3" rpy="0.3 0.2 0.1"/><geometry><mesh filename="bar.off"/></geometry></collision></link>
  <link name="fore"><collision><origin xyz="1 0 0" rpy="0.7 0 2"/><geometry><mesh filename="bar.off"/></geometry></collision></link>
  <link name="hand"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 1" rpy="0.1 0 0.7"/><geometry><box size="0.1 0.1 1"/></geometry></collision><collision><geometry><sphere radius="0.5"/></geometry></collision></link>
  <joint name="j" type="revolute"><parent link="base"/><child link="fore"/><origin xyz="0 0 1" rpy="0.3 0.1 0"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="k" type="revolute"><parent link="fore"/><child link="hand"/><origin xyz="0 4 1"/><axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>
U

# The robot in other formats, with native shapes; judged, within epsilon as well.
mkdir -p other
for kind in spheres capsules boxes mixed; do
  for file in arm-$kind.xml other/arm-$kind.sdf; do
    make arm.urdf "$file" $kind
    printed=$(sed -n "s,^from the files alone: \(bound-verify robot arm.urdf --bodies $file --epsilon .*\),\1,p" err.txt)
    PATH=$BIN:$PATH sh -c "${printed:-false}" >/dev/null || fail "$file: the command that is to decide it: $printed"
    shows 0 '^verified: .* hold 3 of 3 links; of 3 links none is farther than 0.4001$' "$V" robot arm.urdf --bodies "$file" --epsilon 0.4001 --report judged.json
    json judged.json "r['epsilon'] == 0.4001 and r['joints']['answer'] == 'verified' and all(l['claims']['distance']['answer'] == 'verified' for l in r['links'])"
  done
done
grep -q 'type="capsule"' arm-capsules.xml || fail 'no capsule in MJCF'
grep -q '<capsule>' other/arm-capsules.sdf || fail 'no <capsule> in SDF'
grep -q 'type="mesh"' arm-capsules.xml && fail 'a mesh is left'
# A distance that they do not keep is refuted, with a place.
shows 1 "link 'base': refuted: .*they reach .*, farther than 0.05, at (" "$V" robot arm.urdf --bodies arm-capsules.xml --epsilon 0.05 --report judged.json
json judged.json "r['verdict'] == 'refuted' and r['links_held'] == 3 and r['links'][0]['claims']['distance']['witness']['distance'] > 0.05"
shows 0 '^verified' "$V" robot arm.urdf --bodies arm-capsules.xml --epsilon 0.5m
make arm.urdf arm.yaml spheres
shows 0 '^verified: .*; of 3 links none is farther than 0.4' "$V" robot arm.urdf --spheres arm.yaml --epsilon 40cm --report judged.json
json judged.json "r['epsilon'] == 0.4 and all(l['claims']['distance']['answer'] == 'verified' for l in r['links'])"
shows 1 "farther than 0.05" "$V" robot arm.urdf --spheres arm.yaml --epsilon 0.05
expect 2 'percentage' "$V" robot arm.urdf --spheres arm.yaml --epsilon 5%
# Frames elsewhere in another format.
sed 's/pos="0 4 1"/pos="0 4 1.001"/' arm-capsules.xml >moved.xml
cmp -s moved.xml arm-capsules.xml && fail 'nothing was moved'
shows 1 "^joints: refuted: the frame of link 'hand' is not where the robot has it" "$V" robot arm.urdf --bodies moved.xml
# A capsule of half the radius.
sed 's/type="capsule" size="[^ ]*/type="capsule" size="0.1/' arm-capsules.xml >thin.xml
shows 1 '^refuted' "$V" robot arm.urdf --bodies thin.xml

# <capsule> where the file is of URDF 1.2, or 1.1.
sed 's/<robot name="arm"/<robot name="arm" version="1.2"/' arm.urdf >arm12.urdf
make arm12.urdf capsules12.urdf capsules
grep -q '<capsule radius=' capsules12.urdf || fail 'no <capsule>'
grep -q '<cylinder' capsules12.urdf && fail 'a <cylinder>'
shows 0 '^verified' "$V" robot arm12.urdf --bodies capsules12.urdf --epsilon 0.4001
make arm.urdf capsules10.urdf capsules
grep -q '<capsule' capsules10.urdf && fail 'URDF 1.0 has no <capsule>'
shows 0 '^verified' "$V" robot arm.urdf --bodies capsules10.urdf

# MJCF that stays MJCF: classes that say otherwise, contacts, pairs, masses of geoms, frames.
cat >arm.xml <<'X'
<mujoco model="arm">
  <compiler angle="radian"/>
  <default>
    <default class="col"><geom type="mesh" friction="0.9 0.1 0.1" euler="0.1 0 0" group="3" condim="4"/></default>
  </default>
  <asset><mesh name="bar" file="bar.stl"/></asset>
  <worldbody>
    <geom name="floor" type="plane" size="9 9 1"/>
    <geom name="post" type="box" size="0.1 0.2 1" pos="3 0 1"/>
    <body name="base" pos="0 0 1">
      <joint name="j" type="hinge" axis="0 0 1"/>
      <frame pos="0.1 0 0" euler="0.3 0 0"><geom name="first" class="col" mesh="bar" quat="1 0 0 1"/></frame>
      <geom name="second" class="col" mesh="bar" pos="0 2 0"/>
      <body name="hand" pos="4 0 0" childclass="col">
        <joint name="k" type="slide" axis="1 0 0" pos="0.1 0 0"/>
        <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
        <geom mesh="bar"/>
        <geom type="capsule" size="0.2 0.5" contype="0" conaffinity="0"/>
      </body>
    </body>
  </worldbody>
  <contact><pair geom1="first" geom2="floor"/><pair geom1="second" geom2="floor"/></contact>
</mujoco>
X
expect 0 '' "$BIN/mesh-prepare" bar.off -o bar.stl
for kind in spheres capsules boxes; do
  make arm.xml other/arm-$kind.xml $kind
  shows 0 '^verified: .* hold 3 of 3 links' "$V" robot arm.xml --bodies other/arm-$kind.xml --epsilon 0.4001
done
python3 - <<'P' || fail 'MJCF that was edited'
import xml.etree.ElementTree as tree
root = tree.parse("other/arm-capsules.xml").getroot()
base = root.find("worldbody/body")
geoms = [g for g in base.iter("geom") if g.get("type") == "capsule" and g.get("class") == "col"]
assert geoms and all(g.get("pos") and g.get("quat") and g.get("mesh") is None for g in geoms)
own = [g for g in base.findall("geom") if g.get("type") == "capsule"]
assert all(g.get("mass") == "0" for g in own), "the body is weighed by its old geoms"
assert all(g.get("mass") is None for g in base.find("body").findall("geom") if g.get("mesh") is None)
pairs = [(p.get("geom1"), p.get("geom2")) for p in root.findall("contact/pair")]
assert sorted(pairs) == sorted((g.get("name"), "floor") for g in own), pairs
assert root.find("asset/mesh").get("file") == "../bar.stl"
P
# What collides with one of the old geoms does with the new ones, whatever class and frame they are in.
sed 's/<geom name="second" class="col"/& contype="4" conaffinity="2"/; s/<default class="col"><geom/& contype="1" conaffinity="8"/
  s/<frame pos="0.1 0 0" euler="0.3 0 0"><geom name="first" class="col"/<frame childclass="col" pos="0.1 0 0" euler="0.3 0 0"><geom name="first"/' arm.xml >bits.xml
make bits.xml other/bits.xml capsules
shows 0 '^verified: .* hold 3 of 3 links' "$V" robot bits.xml --bodies other/bits.xml
python3 - <<'P' || fail 'bits of contacts'
import xml.etree.ElementTree as tree
base = tree.parse("other/bits.xml").getroot().find("worldbody/body")
own = [g for g in base.findall("geom") if g.get("type") == "capsule"]
assert own and all((g.get("contype"), g.get("conaffinity")) == ("5", "10") for g in own), [g.attrib for g in own]
P
# A class that would make another shape of it.
sed 's/<default class="col">/&<!-- -->/; s/group="3"/fitscale="2" mesh="bar" group="3"/' arm.xml >fitted.xml
expect 3 "link 'base'\|mesh of its class\|fits to" "$B" fitted.xml -o fitted-capsules.xml --bodies capsules --epsilon 0.4 --effort fast
[ ! -e fitted-capsules.xml ] || fail 'fitted-capsules.xml was written'
expect 3 'only a URDF' "$B" arm.xml -o x.urdf --bodies capsules --epsilon 0.4 --effort fast

# A floating base, and a ball joint, move in ways that no file of shapes says: links are judged in their frames all the same.
sed 's/<joint name="j" type="hinge" axis="0 0 1"\/>/<freejoint\/>/' arm.xml >free.xml
make free.xml free-capsules.xml capsules
shows 0 '^verified: .* hold 3 of 3 links' "$V" robot free.xml --bodies free-capsules.xml
make free.xml free.yaml spheres
shows 0 '^verified: .* hold 3 of 3 links' "$V" robot free.xml --spheres free.yaml
sed 's/radius: .*/radius: 0.3/' free.yaml >small.yaml
shows 1 '^refuted' "$V" robot free.xml --spheres small.yaml
expect 0 '' "$B" free.xml -o mended-free.yaml --repair small.yaml --epsilon 0.5 --effort fast
shows 0 '^verified: .* hold 3 of 3 links' "$V" robot free.xml --spheres mended-free.yaml

sed 's/name="j" type="revolute"/name="j" type="floating"/' arm.urdf >free.urdf
make free.urdf free-spheres.urdf spheres
shows 0 '^verified: .* hold 3 of 3 links' "$V" robot free.urdf --spheres free-spheres.urdf --epsilon 0.4001

# SDF that stays SDF; before 1.8 it has no capsules.
for version in 1.6 1.9; do
  cat >arm.sdf <<X
<sdf version="$version"><model name="arm">
  <link name="base"><pose>0 0 1 0 0 0.3</pose><collision name="c"><pose>0.1 0.2 0.3 0.3 0.2 0.1</pose><geometry><mesh><uri>bar.stl</uri></mesh></geometry>
    <surface><friction><ode><mu>0.3</mu></ode></friction></surface></collision></link>
  <link name="hand"><pose>0 4 1 0 0 0</pose><collision name="c"><geometry><mesh><uri>bar.stl</uri></mesh></geometry></collision></link>
  <joint name="j" type="revolute"><parent>base</parent><child>hand</child><axis><xyz>0 0 1</xyz><limit><lower>-1</lower><upper>1</upper></limit></axis></joint>
</model></sdf>
X
  for kind in spheres capsules boxes; do
    make arm.sdf other/arm-$version-$kind.sdf $kind
    shows 0 '^verified: .* hold 2 of 2 links' "$V" robot arm.sdf --bodies other/arm-$version-$kind.sdf --epsilon 0.4001
  done
  grep -q '<mu>0.3</mu>' other/arm-$version-capsules.sdf || fail "$version: what a collision says of contacts is gone"
done
sed 's/<mu>0.3.*<\/surface>/<mu>0.3<\/mu><\/ode><\/friction><contact><collide_bitmask>0x05<\/collide_bitmask><\/contact><\/surface>/
  s/<link name="base">.*/&<!-- -->/' arm.sdf | python3 -c "
import sys
text = sys.stdin.read()
first = text.index('<collision'), text.index('</collision>') + len('</collision>')
second = text[first[0]:first[1]].replace('name=\"c\"', 'name=\"d\"').replace('0x05', '10')
print(text[:first[1]] + second + text[first[1]:])" >bits.sdf
make bits.sdf other/bits.sdf capsules
shows 0 '^verified: .* hold 2 of 2 links' "$V" robot bits.sdf --bodies other/bits.sdf
[ "$(grep -c '<collide_bitmask>15</collide_bitmask>' other/bits.sdf)" -gt 0 ] || fail "bits: $(grep bitmask other/bits.sdf)"
grep '<collide_bitmask>' other/bits.sdf | grep -vq '>15<' && fail "bits of one: $(grep bitmask other/bits.sdf)"
grep -q '<capsule>' other/arm-1.9-capsules.sdf || fail 'SDF 1.9: no <capsule>'
grep -q '<capsule>' other/arm-1.6-capsules.sdf && fail 'SDF 1.6 has no <capsule>'

# Pairs that need no check, in the formats that have them; buffers are 0.
expect 0 '' "$BIN/kaboum-pairs" arm.urdf --srdf pairs.srdf
cat >more.srdf <<'U'
<robot name="arm"><disable_collisions link1="hand" link2="base" reason="Never"/><disable_collisions link1="base" link2="fore" reason="Adjacent"/>
<disable_collisions link1="base" link2="hand" reason="Never"/></robot>
U
for pairs in pairs.srdf more.srdf; do
  for file in p.yaml p.xrdf p.srdf; do
    expect 0 '' "$B" arm.urdf -o $file --bodies spheres --epsilon 0.4 --effort fast --pairs $pairs
    shows 0 '^verified: .* hold 3 of 3 links' "$V" robot arm.urdf $file
    expect 0 '' "$BIN/kaboum-pairs" arm.urdf --judge $file
  done
done
grep -q '^self_collision_ignore:$' p.yaml && grep -q '^  "base": \["fore", "hand"\]$' p.yaml || fail "pairs of cuRobo: $(grep -A3 ignore p.yaml)"
grep -q '^    "base": \["fore", "hand"\]$' p.xrdf || fail "pairs of XRDF: $(grep -A3 ignore p.xrdf)"
[ "$(grep -c '<disable_collisions' p.srdf)" = 2 ] || fail 'pairs of SRDF'
"$V" robot arm.urdf p.yaml 2>&1 | grep buffer && fail 'a buffer of 0 is no news'
# What is written of it is edited as a file that somebody wrote.
expect 0 '' "$B" arm.urdf -o mended.yaml --repair p.yaml --epsilon 0.4
shows 0 '^verified' "$V" robot arm.urdf mended.yaml
grep -q '"base": \["fore", "hand"\]' mended.yaml || fail 'repairing took the pairs away'
expect 2 'pairs' "$B" arm.urdf -o x.urdf --bodies spheres --epsilon 0.4 --pairs pairs.srdf
expect 2 'pairs' "$B" arm.urdf -o x.xml --bodies capsules --epsilon 0.4 --pairs pairs.srdf
expect 2 'pairs' "$B" arm.urdf -o x --pairs pairs.srdf
expect 3 'none.srdf' "$B" arm.urdf -o x.yaml --bodies spheres --epsilon 0.4 --pairs none.srdf
printf '<robot name="o">\n<disable_collisions link1="u" link2="v" reason="Never"/>\n</robot>\n' >others.srdf
expect 3 "others.srdf:2: none of its pairs .* another robot's" "$B" arm.urdf -o x.yaml --bodies spheres --epsilon 0.4 --pairs others.srdf
expect 0 'x.yaml: no pairs of links are stated that need no check' "$B" arm.urdf -o x.yaml --bodies spheres --epsilon 0.4 --effort fast

# A scene to look at: links as nodes, shapes as instances of few meshes.
expect 0 '' "$B" arm.urdf -o mixed.urdf --bodies mixed --epsilon 0.4 --effort fast --preview mixed.glb
expect 0 '' "$B" arm.urdf -o s.yaml --bodies spheres --epsilon 0.4 --effort fast --preview spheres.glb --report s.json
python3 - <<'P' || fail 'scenes'
import json, struct
for name in ("mixed.glb", "spheres.glb"):
    data = open(name, "rb").read()
    magic, version, length = struct.unpack_from("<III", data)
    assert (magic, version, length) == (0x46546C67, 2, len(data))
    size, kind = struct.unpack_from("<II", data, 12)
    scene = json.loads(data[20:20 + size])
    rest, other = struct.unpack_from("<II", data, 20 + size)
    assert kind == 0x4E4F534A and other == 0x004E4942 and 28 + size + rest == len(data)
    nodes, meshes = scene["nodes"], scene["meshes"]
    assert [nodes[i]["name"] for i in nodes[0]["children"]] == ["base", "fore", "hand"]
    shapes = [node for node in nodes if "mesh" in node]
    if name == "spheres.glb":
        assert len(shapes) == json.load(open("s.json"))["spheres"] and len(meshes) == 3
        assert len({json.dumps(m["primitives"][0]["attributes"]) for m in meshes}) == 1
    for accessor in scene["accessors"]:
        view = scene["bufferViews"][accessor["bufferView"]]
        width = {"VEC3": 12, "SCALAR": 4}[accessor["type"]]
        assert view["byteLength"] == width * accessor["count"] and view["byteOffset"] + view["byteLength"] <= rest
P
# Nothing that the robot is of is written over, and where the file is refused there is no scene either.
cat >whole.xml <<'X'
<mujoco model="whole"><compiler angle="radian"/><asset><model name="arm" file="arm.xml"/></asset>
<worldbody><body name="t"><geom size="0.1"/><attach model="arm" body="base" prefix="l_"/></body></worldbody></mujoco>
X
cp arm.xml kept.xml
expect 2 'overwrite the input .*arm.xml' "$B" whole.xml -o arm.xml --bodies spheres --epsilon 0.4 --effort fast
cmp arm.xml kept.xml || fail 'an attached model was written over'
sed 's/bar.off/part.glb/g' arm.urdf >glb.urdf
expect 0 '' "$BIN/bcd-decompose" bar.off -o part.glb --epsilon 0.4
cp part.glb kept.glb
expect 2 'overwrite the input .*part.glb' "$B" glb.urdf -o x.yaml --bodies spheres --epsilon 0.4 --preview part.glb
cmp part.glb kept.glb || fail 'a mesh was written over'
expect 3 'fits to\|of its class' "$B" fitted.xml -o x.xml --bodies capsules --epsilon 0.4 --effort fast --preview none.glb
[ ! -e none.glb ] || fail 'a scene without its file'
expect 0 '' "$B" whole.xml -o whole.yaml --bodies spheres --epsilon 0.4 --effort fast --depfile whole.d
grep -q 'arm.xml' whole.d || fail "an attached model is no dependency: $(cat whole.d)"
expect 2 'glb' "$B" arm.urdf -o x --preview x.glb
expect 2 'capsules, boxes or mixed' "$B" arm.urdf -o x.xml --epsilon 0.4
finish
