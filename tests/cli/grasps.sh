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
expect 2 'has no tools' "$S" grasps cell.json
python3 - <<'END'
import json
d = json.load(open("cell.json"))
arm = d["robots"][0]
arm["tools"] = [{"name": "hand", "link": "hand", "position": [0, 0, 0.135]}]
arm["home"] = {"j2": -0.5, "j3": 1.7, "j5": 1.9415926535897932}
json.dump(d, open("cell.json", "w"), indent=1)
END
cp cell.json before.json
expect 2 "no object 'shelv'; did you mean 'shelf'" "$S" grasps cell.json --object shelv
expect 2 "no tool 'hamd'; did you mean 'hand'" "$S" grasps cell.json --tool hamd
expect 2 'directions' "$S" grasps cell.json --directions 0
expect 2 'opening' "$S" grasps cell.json --opening -1
cmp cell.json before.json || fail "a refused request changed the scene"

expect 0 'shelf: 2' "$S" places cell.json --report p.json
expect 0 'b3: ' "$S" grasps cell.json --object b1 --object b2 --object b3 --closing x --opening 0.03 --report g.json
# A table is wider than the hand opens; that is said whatever is quiet, and is not 0.
expect 1 'table: none; no two parallel faces' "$S" grasps cell.json --object table --closing x --opening 0.03 --quiet
# Again: the same grasps, not twice as many.
cp cell.json once.json
expect 0 '' "$S" grasps cell.json --object b1 --object b2 --object b3 --closing x --opening 0.03
expect 0 'the points that it has are kept; --force' "$S" places cell.json
cmp cell.json once.json || fail "deriving again changed the scene"
python3 - <<'END' || fail "reports and scene differ"
import json
scene = json.load(open("cell.json"))
grasps = {o["name"]: [g["name"] for g in o.get("grasps", [])] for o in scene["objects"]}
points = {o["name"]: [f["name"] for f in o["features"]] for o in scene["objects"]}
for o in json.load(open("g.json"))["objects"]:
    assert o["names"] == grasps[o["object"]] and o["names"][0] == "hand/side-1" and not o["shortfall"], o
for o in json.load(open("p.json"))["objects"]:
    assert o["names"] == points[o["object"]] == ["bottom", "top"], o
assert 0 < len(grasps["b3"]) <= 24 and grasps["table"] == []
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
expect 0 'b1: 2' "$S" grasps cell.json --object b1 --hold face --directions 1
python3 -c '
import json
of = [g["name"] for o in json.load(open("cell.json"))["objects"] if o["name"] == "b1" for g in o["grasps"]]
assert "hand/side-1" in of and "hand/face-2" in of, of' || fail "grasps of the other kind are gone"
finish
