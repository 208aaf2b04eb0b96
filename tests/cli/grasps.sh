# shellcheck shell=sh disable=SC2154
# Grasps and places that are derived: from a scene of primitives to a plan, without a pose written by hand.
. "$(dirname "$0")/common.sh"
KABOUM_CACHE=$WORK/cache
export KABOUM_CACHE
S=$BIN/kaboum-scene

cat >arm.urdf <<'END'
<robot name="arm">
  <link name="base"><collision><origin xyz="0 0 0.12"/><geometry><box size="0.16 0.16 0.24"/></geometry></collision></link>
  <link name="shoulder"/><link name="elbow"/><link name="wrist"/>
  <link name="upper"><collision><origin xyz="0 0 0.25"/><geometry><box size="0.08 0.08 0.4"/></geometry></collision></link>
  <link name="forearm"><collision><origin xyz="0 0 0.15"/><geometry><box size="0.07 0.07 0.2"/></geometry></collision></link>
  <link name="hand">
    <collision><origin xyz="0 0 0.07"/><geometry><box size="0.07 0.03 0.02"/></geometry></collision>
    <collision><origin xyz="-0.02 0 0.11"/><geometry><box size="0.008 0.02 0.06"/></geometry></collision>
    <collision><origin xyz="0.02 0 0.11"/><geometry><box size="0.008 0.02 0.06"/></geometry></collision>
  </link>
END
# joint NAME PARENT CHILD HEIGHT AXIS LIMIT
joint() {
  echo "<joint name=\"$1\" type=\"revolute\"><parent link=\"$2\"/><child link=\"$3\"/><origin xyz=\"0 0 $4\"/><axis xyz=\"$5\"/>
    <limit lower=\"-$6\" upper=\"$6\" velocity=\"2\" effort=\"1\"/></joint>"
}
{
  joint j1 base shoulder 0.35 '0 0 1' 2.9
  joint j2 shoulder upper 0 '0 1 0' 2.2
  joint j3 upper elbow 0.5 '0 1 0' 2.7
  joint j4 elbow forearm 0.2 '0 0 1' 3.1
  joint j5 forearm wrist 0.25 '0 1 0' 2.3
  joint j6 wrist hand 0 '0 0 1' 3.1
  echo '</robot>'
} >>arm.urdf

expect 0 '' "$S" make cell.json --robot arm=arm.urdf --effort fast --epsilon 0.002 \
  --primitive table=box:0.4,0.3,0.04 --at table=0.52,-0.3,-0.02 --primitive shelf=box:0.2,0.15,0.02 --at shelf=0.45,0.3,0.05 \
  --primitive b1=box:0.024,0.024,0.06 --at b1=0.4,-0.25,0.0305 --primitive b2=box:0.024,0.024,0.06 --at b2=0.5,-0.25,0.0305,0,0,0.4 \
  --primitive b3=cylinder:0.011,0.06 --at b3=0.5,-0.35,0.0305
expect 2 'cell.json: .*has no tools' "$S" grasps cell.json
# with_tool FILE: the arm of a scene has a hand, and is at home where it stretches over the table.
with_tool() {
  python3 - "$1" <<'END'
import json, sys
d = json.load(open(sys.argv[1]))
arm = d["robots"][0]
arm["tools"] = [{"name": "hand", "link": "hand", "position": [0, 0, 0.135]}]
arm["home"] = {"j2": -0.5, "j3": 1.7, "j5": 1.9415926535897932}
json.dump(d, open(sys.argv[1], "w"), indent=1)
END
}
with_tool cell.json
cp cell.json before.json
expect 2 "cell.json: .*no object 'shelv'; did you mean 'shelf'" "$S" grasps cell.json --object shelv
expect 2 "cell.json: .*no tool 'hamd'; did you mean 'hand'" "$S" grasps cell.json --tool hamd
expect 2 'directions' "$S" grasps cell.json --directions 0
expect 2 'opening' "$S" grasps cell.json --opening -1
for option in --opening --tip --gap; do expect 2 "${option}.*there is no diagonal" "$S" grasps cell.json $option 1%; done
expect 2 'inset.*there is no diagonal' "$S" places cell.json --inset 1%
# A report is written over nothing that the scene names.
for command in grasps places update pairs; do
  expect 2 'report would overwrite' "$S" "$command" cell.json --report cell/arm/hand.glb
  expect 2 'report would overwrite' "$S" "$command" cell.json --report ./arm.urdf
done
expect 2 'srdf would overwrite' "$S" pairs cell.json --srdf arm.urdf
cmp cell.json before.json || fail "a refused request changed the scene"

expect 0 'shelf: 3' "$S" places cell.json --report p.json
expect 0 'b3: ' "$S" grasps cell.json --object b1 --object b2 --object b3 --closing x --opening 0.03 --report g.json
# A table is wider than the hand opens; that is said whatever is quiet, and is not 0.
expect 1 'table: none; no two parallel faces' "$S" grasps cell.json --object table --closing x --opening 0.03 --quiet
# Again: the same grasps, not twice as many.
cp cell.json once.json
expect 0 '' "$S" grasps cell.json --object b1 --object b2 --object b3 --closing x --opening 3cm --gap 1mm
expect 0 'the points and surfaces that it has are kept; --force' "$S" places cell.json --report kept.json
grep -q 'b1: 3 kept (bottom' err.txt || fail "does not say what is kept: $(cat err.txt)"
cmp cell.json once.json || fail "deriving again changed the scene"
python3 - <<'END' || fail "reports and scene differ"
import json
scene = json.load(open("cell.json"))
grasps = {o["name"]: [g["name"] for g in o.get("grasps", [])] for o in scene["objects"]}
points = {o["name"]: [f["name"] for f in o["features"]] for o in scene["objects"]}
for o in json.load(open("g.json"))["objects"]:
    assert o["names"] == grasps[o["object"]] and o["names"][0] == "hand/side-1" and not o["shortfall"], o
for o in json.load(open("p.json"))["objects"]:
    assert o["names"] == points[o["object"]] == ["bottom", "top", "face"] and not o["kept"] and not o["shortfall"], o
for o in json.load(open("kept.json"))["objects"]:
    assert o["kept"] == ["bottom", "top", "face"] and not o["names"] and not o["shortfall"], o
assert grasps["table"] == []
# Single poses first, then families, which are tried later; round b3 is held round its axis.
for o in scene["objects"]:
    found = o.get("grasps", [])
    single = [g for g in found if "turn" not in g]
    assert found[:len(single)] == single and len(single) <= 24, found
    assert all("rank" not in g for g in single) and all(g["rank"] >= 1 for g in found[len(single):]), found
    if o["name"] == "b3":
        families = found[len(single):]
        assert len(families) == 5 and all(g["turn"]["about"]["direction"] == [0, 0, 1] and len(g["turn"]) == 1 for g in families), families
END

cat >stow.kpl <<'END'
domain stow
types: object, block, robot, conf handle, pose handle
constants: robot arm; object table, shelf; block b1, b2, b3; conf home; pose start
predicates: stowed(block)
functions: conf(robot) : conf; pose(block) : pose
externals: transfer(robot, block, object, conf) : pose
action stow(?o : block)
  preconds: K(!stowed(?o)) & let ?p = extern(transfer(arm, ?o, shelf, home))
  effects: add(Kf, stowed(?o)), add(Kf, pose(?o) = ?p)
init: K(conf(arm) = home), K(pose(b1) = start), K(pose(b2) = start), K(pose(b3) = start),
  K(!stowed(b1)), K(!stowed(b2)), K(!stowed(b3))
goal: K(stowed(b1)) & K(stowed(b2)) & K(stowed(b3))
END
expect 0 'solved: 3 nodes' "$BIN/kaboum-plan" solve stow.kpl --scene cell.json -o plan.json
shows 0 'valid' "$BIN/kaboum-plan" check stow.kpl --scene cell.json --plan plan.json
shows 0 '^good' "$BIN/kaboum-plan" run stow.kpl --scene cell.json --plan plan.json
# Anywhere on the shelf by a mate with its surface, so much smaller that all of a base is on it.
cat >stow.task <<'END'
# Anywhere on the shelf, upright, a little above it.
scene shelf.json
mate anywhere: bottom distance face 1.5 mm within 0.5 mm; .z angle .z 0 deg within 0.1 deg
put b1 b2 b3 on shelf by anywhere
END
cp cell.json shelf.json
expect 0 'shelf: 3' "$S" places shelf.json --object shelf --inset 17mm --force --preview shelf.html
expect 0 'solved: ' "$BIN/kaboum-plan" solve stow.task -o plan.json
shows 0 'valid' "$BIN/kaboum-plan" check stow.task --plan plan.json
shows 0 '^good' "$BIN/kaboum-plan" run stow.task --plan plan.json
# The page has the sheet of the surface where it is in the world, and marks of both points.
python3 - <<'END' || fail "the page of places has not what it should show"
import json, re
data = json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', open("shelf.html").read(), re.S).group(1))
assert [layer["name"] for layer in data["layers"]] == ["shelf", "shelf: bottom", "shelf: top", "shelf: face"], data["layers"]
assert [len(layer["shapes"]) for layer in data["layers"]] == [1, 1, 1, 1]
assert dict(data["facts"])["shelf: face"] == "0.0193 m²", data["facts"]  # 0.166 x 0.116
END
expect 2 'html' "$S" places shelf.json --preview shelf.png
expect 0 'b1: 2' "$S" grasps cell.json --object b1 --hold face --form poses --directions 1
python3 -c '
import json
of = [g["name"] for o in json.load(open("cell.json"))["objects"] if o["name"] == "b1" for g in o["grasps"]]
assert "hand/side-1" in of and "hand/face-2" in of, of' || fail "grasps of the other kind are gone"

# What nothing was found for stays: grasps that were derived before, and points with --force.
cp cell.json once.json
expect 1 "b1: [0-9]* kept (hand/side-1 …); no two parallel faces.*within the opening; those derived before are kept" \
  "$S" grasps cell.json --object b1 --closing x --opening 0.001 --report g.json
cmp cell.json once.json || fail "grasps are gone where none were found"
# edit PROGRAM: of the scene d, in Python
edit() {
  python3 -c "
import json
d = json.load(open('once.json'))
of = {o['name']: o for o in d['objects']}
arm = d['robots'][0]
$1
json.dump(d, open('edited.json', 'w'), indent=1)"
  cp edited.json before.json
}
edit "of['b1']['pose'] = {'position': [0.4, -0.25, 0.04], 'rpy': [0.5, 0.3, 0]}"
expect 1 "b1: 3 kept (bottom …); it stands on no face: 'bottom' is kept; no face looks up: 'top' is kept; no face that looks up is wide enough: 'face' is kept" \
  "$S" places edited.json --object b1 --force
cmp edited.json before.json || fail "points are gone where none were found"
# Nor does a point go that the scene needs.
edit "
of['b1']['features'].append({'name': 'top2', 'point': [0, 0, 0]})
d['constraints'] = [{'name': 'c', 'all': [{'relation': 'coincident', 'first': 'b1/top2', 'second': 'b2/top'}]}]"
expect 0 'b1: 4 kept' "$S" places edited.json --object b1
expect 3 "edited.json: nothing is written, .* 'b1/top2'" "$S" places edited.json --object b1 --force
cmp edited.json before.json || fail "a point that a constraint names is gone"
# A pyramid stands, and nothing stands on it.
cat >pyramid.off <<'END'
OFF
5 6 0
-1 -1 0
1 -1 0
1 1 0
-1 1 0
0 0 1
3 0 2 1
3 0 3 2
3 0 1 4
3 1 2 4
3 2 3 4
3 3 0 4
END
expect 0 '' "$S" make pyramid.json --object pyramid=pyramid.off --epsilon 1%
expect 1 'pyramid: 1 (bottom …); no face looks up' "$S" places pyramid.json --quiet
expect 1 'pyramid: 1 kept (bottom …); no face looks up' "$S" places pyramid.json

# An object that is attached by a derived grasp stays where it is.
edit "d['attachments'] = [{'object': 'b1', 'robot': 'arm', 'tool': 'hand', 'grasp': 'hand/side-3'}]"
expect 0 'b1: [0-9]' "$S" grasps edited.json --object b1 --closing x --opening 0.03
cmp edited.json before.json || fail "deriving the same grasps beside others changed the scene"
for most in '--most 2' '--directions 3'; do
  cp edited.json before.json
  # shellcheck disable=SC2086
  expect 3 "edited.json: the attachment of object 'b1' names its grasp 'hand/side-3', which .*state the pose" \
    "$S" grasps edited.json --object b1 --closing x --opening 0.03 $most
  cmp edited.json before.json || fail "a grasp that is attached by was changed"
done

# Grasps belong to tools by name only: nobody's are replaced by another robot's.
edit "
other = json.loads(json.dumps(arm))
other.update(name='second', base={'position': [3, 0, 0]})
other['tools'][0]['position'] = [0, 0, 0.13]
d['robots'].append(other)"
expect 0 "robot 'second' has a tool 'hand', too" "$S" grasps edited.json --robot arm --object b1 --closing x --opening 0.03
expect 3 "edited.json: object 'b1' has grasps hand/side-1, …, which may be those of robot 'arm'" \
  "$S" grasps edited.json --robot second --object b1 --closing x --opening 0.03 --directions 3
cmp edited.json before.json || fail "the grasps of another robot were replaced"

# A hand that is not looked at is said, and is not 0; a part of it is said, whatever is quiet.
edit "
arm['links'] = [l for l in arm['links'] if l['link'] != 'hand']
arm['links_without_set'] = ['hand']"
expect 1 "b1: .*whether the hand touches it was not looked at: arm/hand" \
  "$S" grasps edited.json --object b1 --closing x --opening 0.03 --quiet --report g.json
edit "d['allowed_contacts'] = [['b1', 'arm/hand']]"
expect 1 "b1: .*whether the hand touches it was not looked at: arm/hand" "$S" grasps edited.json --object b1 --closing x --opening 0.03
edit "
arm['tools'].append({'name': 'low', 'link': 'forearm', 'position': [0, 0, 0.4]})
d['allowed_contacts'] = [['b1', 'arm/hand']]"
expect 0 'b1: whether arm/hand touches it was not looked at' \
  "$S" grasps edited.json --object b1 --tool low --closing x --opening 0.03 --form poses --most 1 --quiet --report g.json
python3 -c '
import json
o = json.load(open("g.json"))["objects"][0]
assert o["unchecked"] == ["arm/hand"] and not o["shortfall"] and len(o["names"]) == 1, o' || fail "the report does not say what was not looked at"
expect 0 'how far the fingers open was not stated (--opening)' "$S" grasps cell.json --object b2 --closing x

# Neither robots nor flat faces.
cat >nor.json <<'END'
{"kaboum_scene": 1, "unit": "mm", "objects": [{"name": "b", "shape": {"box": {"size": [10, 10, 10]}}}]}
END
expect 0 'b: 3' "$S" places nor.json
# Smaller surfaces, in place of those that it has; none are left of too small ones, and these stay.
expect 0 'b: 3' "$S" places nor.json --inset 2 --force
python3 - <<'END' || fail "the surface is not as much smaller as was asked for"
import json
outline = json.load(open("nor.json"))["objects"][0]["features"][2]["surface"]["outline"]
assert sorted(outline) == [[x, y, 5] for x in (-3, 3) for y in (-3, 3)], outline
END
expect 1 "b: 2 (bottom …), 1 kept (face …); no face that looks up is wide enough: 'face' is kept" "$S" places nor.json --inset 5 --force
grep -q 'so that it has no surface' err.txt && fail "what is kept is said not to be there"
expect 2 'inset' "$S" places nor.json --inset -1
# Another feature of a name leaves that name to it: constraints name features of all kinds.
python3 - <<'END'
import json
d = json.load(open("nor.json"))
d["objects"][0]["features"] = [{"name": "face", "plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}]
json.dump(d, open("other.json", "w"))
END
expect 0 'b: 3' "$S" places other.json
python3 -c '
import json
of = [f["name"] for f in json.load(open("other.json"))["objects"][0]["features"]]
assert of == ["face", "bottom", "top", "face2"], of' || fail "a name is there in two kinds"
grep -q '"robots"' nor.json && fail "a scene got robots"
expect 2 'nor.json: .*no robot' "$S" grasps nor.json
edit "d['objects'].append({'name': 'ball', 'shape': {'sphere': {'radius': 0.015}}})"
expect 1 'ball: none; it is round' "$S" grasps edited.json --object ball --closing x --opening 0.04 --form poses
expect 1 'ball: none; no two parallel faces face each other, and no side is round, within the opening' \
  "$S" grasps edited.json --object ball --closing x --opening 0.029
expect 0 'ball: 15' "$S" grasps edited.json --object ball --closing x --opening 0.04
expect 1 'ball: none; it is round' "$S" grasps edited.json --object ball --hold face

# A can among walls: from the side, where its single poses are, no hand gets in. From above one does.
expect 0 '' "$S" make can.json --robot arm=arm.urdf --effort fast --epsilon 0.002 \
  --primitive table=box:0.4,0.3,0.04 --at table=0.52,-0.3,-0.02 --primitive shelf=box:0.2,0.15,0.02 --at shelf=0.45,0.3,0.05 \
  --primitive can=cylinder:0.011,0.06 --at can=0.5,-0.3,0.0305 \
  --primitive w1=box:0.004,0.08,0.05 --at w1=0.462,-0.3,0.0255 --primitive w2=box:0.004,0.08,0.05 --at w2=0.538,-0.3,0.0255 \
  --primitive w3=box:0.08,0.004,0.05 --at w3=0.5,-0.338,0.0255 --primitive w4=box:0.08,0.004,0.05 --at w4=0.5,-0.262,0.0255
with_tool can.json
cat >can.kpl <<'END'
domain can
types: object, block, robot, conf handle, pose handle
constants: robot arm; object table, shelf; block can; conf home; pose start
predicates: stowed(block)
functions: conf(robot) : conf; pose(block) : pose
externals: transfer(robot, block, object, conf) : pose
action stow(?o : block)
  preconds: K(!stowed(?o)) & let ?p = extern(transfer(arm, ?o, shelf, home))
  effects: add(Kf, stowed(?o)), add(Kf, pose(?o) = ?p)
init: K(conf(arm) = home), K(pose(can) = start), K(!stowed(can))
goal: K(stowed(can))
END
expect 0 '' "$S" places can.json --object can --object shelf
cp can.json poses.json
expect 0 'can: 24' "$S" grasps poses.json --object can --closing x --opening 0.03 --form poses
expect 7 '' "$BIN/kaboum-plan" solve can.kpl --scene poses.json -o none.json
expect 0 'can: 29' "$S" grasps can.json --object can --closing x --opening 0.03 --preview can.html
expect 0 'solved: 1 nodes' "$BIN/kaboum-plan" solve can.kpl --scene can.json -o plan.json
shows 0 'valid' "$BIN/kaboum-plan" check can.kpl --scene can.json --plan plan.json
shows 0 '^good' "$BIN/kaboum-plan" run can.kpl --scene can.json --plan plan.json
# The page has a layer for the can and for each of its grasps, with the hand and pointers of each.
python3 - <<'END' || fail "the page of grasps has not what it should show"
import json, re
data = json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', open("can.html").read(), re.S).group(1))
names = [layer["name"] for layer in data["layers"]]
assert names == ["can"] + [f"can: hand/side-{i + 1}" for i in range(29)], names
shapes = [len(layer["shapes"]) for layer in data["layers"]]
assert shapes == [1] + 24 * [1 + 3] + 5 * [60 + 4 * 3], shapes
assert [layer["view"] for layer in data["layers"]] == ["shown", "shown"] + 28 * ["hidden"]
facts = dict(data["facts"])
assert facts["can: hand/side-25"].startswith("turns all round, slides by 0.05") and facts["can: hand/side-1"] == "one pose", facts
END
expect 2 'html' "$S" grasps can.json --object can --preview can.png
expect 2 'form' "$S" grasps can.json --object can --form all
expect 2 'tip' "$S" grasps can.json --object can --tip -1
# Tips that are higher than the can.
expect 1 'can: [0-9]* kept .*with room for the tips; those derived before are kept' \
  "$S" grasps can.json --object can --closing x --opening 0.03 --form families --tip 0.1
# A turned part, in convex bodies of a mesh: no two of its faces are parallel, and it is held at its neck.
python3 - <<'END'
import math
profile, n = [(0.02, 0), (0.02, 0.04), (0.011, 0.055), (0.011, 0.09)], 23
points = [(0, 0, 0), (0, 0, 0.09)] + [(r * math.cos(2 * math.pi * k / n), r * math.sin(2 * math.pi * k / n), z) for r, z in profile for k in range(n)]
at = lambda i, k: 2 + i * n + k % n
faces = [(0, at(0, k + 1), at(0, k)) for k in range(n)] + [(1, at(3, k), at(3, k + 1)) for k in range(n)]
for i in range(3):
    for k in range(n):
        faces += [(at(i, k), at(i, k + 1), at(i + 1, k + 1)), (at(i, k), at(i + 1, k + 1), at(i + 1, k))]
with open("bottle.off", "w") as f:
    print("OFF\n", len(points), len(faces), 0, file=f)
    for row in points:
        print(*row, file=f)
    for row in faces:
        print(3, *row, file=f)
END
expect 0 '' "$S" make bottle.json --robot arm=arm.urdf --effort fast --epsilon 0.001 --object bottle=bottle.off
python3 - <<'END'
import json
d = json.load(open("bottle.json"))
d["robots"][0]["tools"] = [{"name": "hand", "link": "hand", "position": [0, 0, 0.135]}]
json.dump(d, open("bottle.json", "w"), indent=1)
END
expect 1 'bottle: none; no two parallel faces' "$S" grasps bottle.json --closing x --opening 0.03 --form poses
expect 0 'bottle: [345]' "$S" grasps bottle.json --closing x --opening 0.03
python3 - <<'END' || fail "a bottle is not held at its neck"
import json
for g in json.load(open("bottle.json"))["objects"][0]["grasps"]:
    about, slide = g["turn"]["about"], g["slides"][0]
    assert max(abs(about["point"][0]), abs(about["point"][1])) < 2e-4 and slide["along"]["direction"] == [0, 0, 1], g
    low, high = about["point"][2] + slide["from"], about["point"][2] + slide["to"]
    assert 0.053 <= low <= high <= 0.0915, g
END
finish
