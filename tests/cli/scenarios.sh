# shellcheck shell=sh disable=SC2154
# Scenarios end to end, small ones: planned, checked, every branch executed among the exact meshes.
HERE=$(cd "$(dirname "$0")" && pwd)
. "$HERE/common.sh"
S=$HERE/../../examples/scenarios
KABOUM_BIN=$BIN
KABOUM_CACHE=$WORK/cache
export KABOUM_BIN KABOUM_CACHE
# scenario NAME N NODES BRANCHES OPTIONS...: solved with so many nodes, so many branches executed, nothing wrong.
scenario() {
  name=$1 n=$2 nodes=$3 branches=$4
  shift 4
  "$S/$name/run" "$n" --out "$name" "$@" >said.txt 2>err.txt || fail "$name: exit code $?: $(tail -3 err.txt)"
  tail -1 said.txt >last.json
  python3 - "$name" "$n" "$nodes" "$branches" <<'END' || fail "$name: $(cat last.json)"
import json, sys
r = json.load(open("last.json"))
name, n, nodes, branches = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])
keys = ["scenario", "n", "seed", "solved", "actions", "nodes", "leaves", "plan_s", "predicate_calls", "ik_calls",
        "executed_branches", "samples", "collisions", "limit_violations"]
assert list(r)[:len(keys)] == keys, list(r)
assert r["scenario"] == name and r["n"] == n and r["solved"] and r["checked"], "not solved"
assert r["nodes"] <= nodes and r["executed_branches"] == branches, (r["nodes"], r["executed_branches"])
assert r["collisions"] == r["limit_violations"] == r["jumps"] == 0 and r["samples"] > 1000
assert r["predicate_calls"] > 0 and r["ik_calls"] > 0
END
  [ -s "$name/plan.svg" ] || fail "$name: no drawing"
  player "$name"
}
# player NAME: the page holds all bodies, all steps, and nothing from elsewhere; its code plays every branch.
player() {
  python3 - "$1" "$S/../../libpage/src" <<'END_OF_PAGE' || fail "$1: the page"
import base64, html.parser, json, re, sys
name, player = sys.argv[1:]
page = open(f"{name}/plan.html", encoding="utf-8").read()
class Reader(html.parser.HTMLParser):
    ids, scripts, inside = set(), [], False
    def handle_starttag(self, tag, attributes):
        a = dict(attributes)
        assert "src" not in a and "href" not in a, (tag, a)
        if "id" in a:
            assert a["id"] not in self.ids, a["id"]
            self.ids.add(a["id"])
        if tag == "script":
            self.inside = True
            self.scripts.append("")
    def handle_endtag(self, tag):
        self.inside = self.inside and tag != "script"
    def handle_data(self, data):
        if self.inside:
            self.scripts[-1] += data
reader = Reader()
reader.feed(page)
assert "http" not in page.replace("http://www.w3.org/2000/svg", "") and "{{" not in page
data = json.loads(reader.scripts[0])
for script, file in zip(reader.scripts[1:], ("scene.js", "view.js", "cell.js", "player.js"), strict=True):
    assert script.strip() == open(f"{player}/{file}", encoding="utf-8").read().strip(), file
used = set(re.findall(r"\$\('([a-z]+)'\)", reader.scripts[3] + reader.scripts[4]))
assert used and used <= reader.ids, used - reader.ids
cell, plan = json.load(open(f"{name}/cell.json")), json.load(open(f"{name}/plan.json"))
links = [f"{r['name']}/{l['link']}" for r in cell["robots"] for l in r["links"]]
assert [s["name"] for s in data["shapes"]] == links + [o["name"] for o in cell["objects"]]
assert all(s["bodies"] and s["exact"] for s in data["shapes"])
assert {s["node"] for s in data["steps"]} == set(range(len(plan["nodes"])))
assert {f"node-{n}" for n in range(len(plan["nodes"]))} <= reader.ids, "the graph"
for said, node in zip(data["nodes"], plan["nodes"], strict=True):
    if "action" in node:
        assert said["action"] == f"{node['action']}({', '.join(node['arguments'])})", (said["action"], node)
box = [b for s in data["shapes"] if s["name"] == "table" for b in s["bodies"]]
if box:
    assert len(base64.b64decode(box[0]["points"])) == 8 * 3 * 4
END_OF_PAGE
  command -v node >/dev/null || fail "Node.js is missing (nodejs, which scripts/setup installs): the page's code has not been run"
  node "$HERE/play_page.js" "$1/plan.html" "$S/../../libpage/src" >said.txt 2>&1 || fail "$1: $(tail -5 said.txt)"
}
scenario force-sensing 3 15 8
# Weighing decides the path.
python3 - <<'END' || fail "force-sensing: both paths are the same: $(cat last.json)"
import json
r = json.load(open("last.json"))
assert r["compared"] == 3 and r["different_paths"] == 2, "the same paths"
assert max(r["upright_leans_deg"]) <= 15 < sorted(r["fast_leans_deg"])[1], "who leans"
assert 0 < r["fast_s"] < r["upright_s"], "fast is not fast"
END
scenario remove 6 12 1 --robots 2
python3 -c 'import json; print({n["arguments"][0] for n in json.load(open("remove/plan.json"))["nodes"]})' | grep -q 'arm2.*arm\|arm.*arm2' ||
  fail "one robot takes all blocks"
scenario remove 3 3 1 --volumes
# Two blocks in the middle are taken one after the other, four two at a time.
scenario shared-table 2 4 1
! grep -q Together shared-table/plan.json || fail "both arms are in the middle at once"
scenario shared-table 4 4 1
[ "$(grep -c Together shared-table/plan.json)" = 4 ] || fail "the arms do not go at once"
expect 2 'set KABOUM_MESHES' env KABOUM_MESHES= "$S/remove/run" 2 --real ur5 --out none
scenario circular-rearrange 3 6 1 --move
grep -q 'action move' circular-rearrange/domain.kpl || fail "no action move"
P=$BIN/kaboum-plan
scenario logistics 2 8 1 --task
scenario logistics 2 14 1
# Parcels are held from the side in the rack and from above in crates; a tall one is not inside of the flat crate.
D=$S/logistics/domain.kpl
"$S/logistics/run" 1 --scene-only --out parcel || fail "one parcel"
for kept in above side; do
  python3 -c 'import json, sys
cell = json.load(open("parcel/cell.json"))
for thing in cell["objects"]:
    thing["grasps"] = [g for g in thing["grasps"] if g["name"].startswith(sys.argv[1])]
json.dump(cell, open(f"parcel/{sys.argv[1]}.json", "w"))' "$kept"
done
# stowed GOAL FOLDER CELL: whether there is a plan, the code and what is said of it.
stowed() {
  sed "s/^goal:.*/goal: $1/" "$D" >stowed.kpl
  expect "$4" "$5" "$P" solve stowed.kpl "$2/problem.kpl" --scene "$2/$3.json" -o none.json --explain --timeout 3 --no-cache
}
stowed 'K(isStowed(o1))' parcel cell 0 solved
stowed 'K(isHeld(o1))' parcel above 7 'fetch(robot1, o1, home): impossible.*and rack'
stowed 'K(isHeld(o1))' parcel side 0 solved
stowed 'K(isStowed(o1))' parcel side 7 'put(robot2, o1, flat, home): not found.*and flat'
stowed 'K(isOn(o2, flat))' logistics cell 0 solved
stowed 'K(isOn(o2, flat)) \& K(isStowed(o2))' logistics cell 7 'inside(o2, in-flat): impossible'
rm none.json
# Plates are pushed over the edge of a bench, since none of their grasps is free before.
scenario pushing 2 6 1
D=$S/pushing/domain.kpl
python3 -c 'import json; print([n["action"] for n in json.load(open("pushing/plan.json"))["nodes"]].count("push"))' | grep -qx 2 || fail "not both plates are pushed"
sed '/^action push/,/^  effects:/d' "$D" >unpushed.kpl
expect 7 'fetch(robot1, o1, home): none of the 8 grasps listed for o1 is free of contact: robot1/.* and bench' "$P" solve unpushed.kpl \
  pushing/problem.kpl --scene pushing/cell.json -o none.json --explain --timeout 20 --no-cache
# pushed WHAT SAID: a plan, or a scene, in which a push is another one is seen by the judge.
pushed() {
  python3 - "$1" <<'END_OF_PUSH' || fail "a plan with another push"
import json, sys
plan, cell = json.load(open("pushing/plan.json")), json.load(open("pushing/cell.json"))
call = next(n for n in plan["nodes"] if n["action"] == "push")["calls"][0]
motions = json.loads(call["payload"])
line = next(m for m in motions if "holds" in m)
if sys.argv[1] == "bent":
    line["path"][len(line["path"]) // 2][1] -= 0.02
elif sys.argv[1] == "bench":
    next(o for o in cell["objects"] if o["name"] == "bench")["pose"]["position"][2] -= 0.03
elif sys.argv[1] == "planes":
    cell["robots"][0]["features"] = []
call["payload"] = json.dumps(motions, separators=(",", ":"))
json.dump(plan, open("other.json", "w"))
json.dump(cell, open("pushing/other.json", "w"))
END_OF_PUSH
  expect 1 "$2" "$P" run "$D" pushing/problem.kpl --scene pushing/other.json --plan other.json --outcomes all
}
pushed bench 'o[12] is pushed where it rests on nothing'
pushed planes 'o[12] is held without a grasp'
pushed bent 'o[12] is pushed and does not stay on a straight line'
shows 1 "'push' returns another payload" "$P" check "$D" pushing/problem.kpl --scene pushing/cell.json --plan other.json
# Boxes are pushed by one arm and taken by the other one.
scenario pushing 2 6 1 --robots 2
python3 -c 'import json
acts = {(n["action"], n["arguments"][0]) for n in json.load(open("pushing/plan.json"))["nodes"]}
assert acts == {("push", "robot1"), ("pickUp", "robot2"), ("putDown", "robot2")}, acts' || fail "who pushes, who takes"
expect 7 'fetch(robot[12], o[12], home): o[12] is out of reach' "$P" solve unpushed.kpl pushing/problem.kpl --scene pushing/cell.json \
  -o none.json --explain --timeout 20 --no-cache
# Links of the arms overlap at joints, which are all on the axis z when all joints are 0; with --gaps the first ones are apart.
overlaps() {
  python3 - "$1" <<'END_OF_ARM'
import sys, xml.etree.ElementTree as tree
folder = sys.argv[1]
robot, least = tree.parse(f"{folder}/robot1.urdf").getroot(), 1.0
spans = {}
for link in robot.findall("link"):
    heights = []
    for mesh in link.iter("mesh"):  # OFF: a word, numbers of vertices and triangles, then these
        lines = open(f"{folder}/{mesh.get('filename')}").readlines()
        heights += [float(line.split()[2]) for line in lines[2:2 + int(lines[1].split()[0])]]
    for shape in link.findall("collision"):
        for size in shape.iter("box"):
            z, high = float(shape.find("origin").get("xyz").split()[2]), float(size.get("size").split()[2])
            heights += [z - high / 2, z + high / 2]
    spans[link.get("name")] = (min(heights), max(heights))
for joint in robot.findall("joint"):
    z = float(joint.find("origin").get("xyz").split()[2])
    below, above = spans[joint.find("parent").get("link")], spans[joint.find("child").get("link")]
    least = min(least, below[1] - z - above[0], above[1] + z - below[0])
print("overlap" if least > 0.005 else "apart")
END_OF_ARM
}
[ "$(overlaps pushing)" = overlap ] || fail "links of an arm do not overlap"
"$S/pushing/run" 1 --scene-only --gaps --out gaps || fail "an arm with gaps"
[ "$(overlaps gaps)" = apart ] || fail "links of an arm with gaps overlap"
D=$S/bimanual-assembly/domain.kpl
# Handing over is in the plan, and there is none without it.
scenario bimanual-assembly 4 7 1 --hand-over
python3 -c 'import json; print([n["action"] for n in json.load(open("bimanual-assembly/plan.json"))["nodes"]].count("handoverBearing"))' | grep -qx 1 ||
  fail "no bearing is handed over"
sed '/^action handoverBearing/,/^    add(Kf, conf/d; /^action move/,/^  effects: add(Kf, conf/d' "$D" >alone.kpl
expect 7 'fetch(robot1, o1, home): impossible.*out of reach' "$P" solve alone.kpl bimanual-assembly/problem.kpl \
  --scene bimanual-assembly/cell.json -o none.json --explain --timeout 10 --no-cache
scenario bimanual-assembly 4 8 1
set -- "$D" bimanual-assembly/problem.kpl --scene bimanual-assembly/cell.json
# Of a second run nothing is asked again; its plan is the same.
expect 0 solved "$P" solve "$@" -o again.json --report again-report.json
cmp -s again.json bimanual-assembly/plan.json || fail "another plan from kept answers"
python3 -c 'import json; g = json.load(open("again-report.json"))["geometry"]; assert g["answers_reused"] > 0 and g["paths"] == 0, g' ||
  fail "answers are not reused"
expect 0 solved "$P" solve "$@" -o anew.json --no-cache --threads 2
cmp -s anew.json again.json || fail "another plan without kept answers"
# A bearing that is held inside does not go onto the tree: the geometry finds it, and says so.
sed '/^action move/,/^  effects: add(Kf, conf/d; s/^goal:.*/goal: K(containsBearing(o4))/
  s/K(isABearing(?b)) & K(isATree(?t))/K(isABearing(?b)) \& K(isATree(?t)) \& K(?r != robot1)/' "$D" >inner.kpl
expect 7 'join(robot2, o[12], o4, home): not found.*does not slide into o4' "$P" solve inner.kpl bimanual-assembly/problem.kpl \
  --scene bimanual-assembly/cell.json -o none.json --explain --timeout 4
[ ! -e none.json ] || fail "a plan was written"
# A plan that swaps the grasps is refused where it does: a bearing that is held inside goes onto the tree, one that is held outside
# into the pipe. The same action with the other gripper is accepted.
"$S/bimanual-assembly/run" 4 --scene-only --out outer --grippers outer,outer || fail "two outer grippers"
# swapped CELL ACTION ARGUMENTS GOAL_OF_ACTION WHAT_IS_HELD: ACTION of the plan, its robot exchanged, after a plan that leads there.
swapped() {
  sed "s/^goal:.*/goal: $5/" "$D" >begun.kpl
  expect 0 solved "$P" solve begun.kpl "$1/problem.kpl" --scene "$1/cell.json" -o begun.json --no-cache
  sed "s/^goal:.*/goal: $4/" "$D" >goal.kpl
  python3 - again.json begun.json "$2" "$3" swapped.json <<'END_OF_SWAP' || fail "a plan that swaps grasps"
import json, sys
whole, begun, action, arguments, out = json.load(open(sys.argv[1])), json.load(open(sys.argv[2])), *sys.argv[3:]
node = next(n for n in whole["nodes"] if n["action"] == action)
names = dict(zip(node["arguments"], arguments.split(",")))
for call in node["calls"]:
    motions = json.loads(call["payload"])
    for motion in motions:
        motion["robot"] = names.get(motion["robot"], motion["robot"])
        if "holds" in motion:
            motion["holds"] = {names.get(o, o): link for o, link in motion["holds"].items()}
    call["payload"] = json.dumps(motions, separators=(",", ":"))
    call["arguments"] = [names.get(a, a) for a in call["arguments"]]
node.update(arguments=arguments.split(","), next="goal")
begun["nodes"][-1]["next"] = len(begun["nodes"])
json.dump(dict(begun, nodes=begun["nodes"] + [node]), open(out, "w"))
END_OF_SWAP
  shows "$6" "$7" "$P" check goal.kpl "$1/problem.kpl" --scene "$1/cell.json" --plan swapped.json
}
first=$(python3 -c 'import json; print(next(n for n in json.load(open("again.json"))["nodes"] if n["action"] == "assembleBearingTree")["arguments"][1])')
swapped bimanual-assembly assembleBearingTree "robot1,$first,o4" 'K(containsBearing(o4))' "K(isRobotGrasps(robot1, $first))" 0 valid
for bearing in o1 o2; do
  swapped bimanual-assembly assembleBearingTree "robot2,$bearing,o4" 'K(containsBearing(o4))' "K(isRobotGrasps(robot2, $bearing))" \
    1 "precondition of assembleBearingTree(robot2, $bearing, o4) does not hold"
  swapped outer assemblePipeBearing "robot1,o3,robot2,$bearing" 'K(containsBearing(o3))' \
    "K(isRobotGrasps(robot1, o3)) \\& K(isRobotGrasps(robot2, $bearing))" \
    1 "precondition of assemblePipeBearing(robot1, o3, robot2, $bearing) does not hold"
done
# Pages: what is needed; nothing is written where something is missing.
expect 2 'needs --scene' "$P" show "$D" bimanual-assembly/problem.kpl --plan again.json --html none.html
cp again.json again.html
expect 2 'would overwrite the input' "$P" show "$@" --plan again.html --html again.html
expect 2 'output' "$P" show "$@" --plan again.json --html none.html -o none.svg
expect 4 'no folder none' "$P" show "$@" --plan again.json --html none/page.html
rm bimanual-assembly/pipe.off
expect 3 'pipe.off' "$P" show "$@" --plan again.json --html none.html
[ ! -e none.html ] || fail "a page was written"
finish
