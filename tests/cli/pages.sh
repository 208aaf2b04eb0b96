# shellcheck shell=sh disable=SC2154
# Pages with a view in three dimensions: what they hold, checked with Node.js. The pages are left in $4 for
# pages-seen.sh, which looks at them.
HERE=$(cd "$(dirname "$0")" && pwd)
. "$HERE/common.sh"
PLAYER=$HERE/../../libpage/src
PAGES=${4-}
KABOUM_CACHE=$WORK/cache
KABOUM_SCENE=$BIN/kaboum-scene
export KABOUM_CACHE KABOUM_SCENE
command -v node >/dev/null || { echo "Node.js is missing (nodejs, which scripts/setup installs): nothing is checked"; exit 1; }

# preview PAGE BOUND: its data hold, and no distance exceeds a certified one.
preview() {
  node "$HERE/check_preview.js" "$1" "$PLAYER" "$2" >said.txt 2>&1 || fail "$1: $(tail -5 said.txt)"
  cat said.txt
}
# figure FILE.JSON EXPRESSION: of a report r.
figure() { python3 -c "import json, sys; r = json.load(open(sys.argv[1])); print($2)" "$1"; }
refused() {
  ! node "$HERE/check_preview.js" "$1" "$PLAYER" "$2" >said.txt 2>&1 || fail "$1 is taken for good: $3"
}

# Bodies over a mesh, and inside one.
D=$BIN/bcd-decompose
expect 0 '' "$D" "$BRACKET" -o bodies.glb --epsilon 3% --effort fast --preview bodies.html --report bodies.json
preview bodies.html "$(figure bodies.json 'r["reach"]["upper"]')"
expect 0 'from the cache' "$D" "$BRACKET" -o again.glb --epsilon 3% --effort fast --preview again.html --threads 1
cmp -s bodies.html again.html || fail "another page from the cache, or on one thread"
expect 0 '' "$D" "$BRACKET" -o inner.glb --direction inner --epsilon 2% --effort fast --preview inner.html
preview inner.html -
grep -q 'decided exactly' bodies.html || fail "no verdict on the page"
# What would be wrong is found: a distance beyond what is certified, data cut, other code.
refused bodies.html 1e-6 'a distance beyond the certified one'
sed 's/"points":"[A-Za-z0-9+/]\{8\}/"points":"/' bodies.html >cut.html
refused cut.html - 'points are missing'
python3 - bodies.html >wrong.html <<'END_OF_DAMAGE' || fail "other distances"
import base64, re, struct, sys
def halved(m):
    values = base64.b64decode(m.group(1))
    n = len(values) // 4
    values = struct.pack(f"<{n}f", *(v / 2 if 0 <= v < 0.9 else v for v in struct.unpack(f"<{n}f", values)))
    return '"values":"' + base64.b64encode(values).decode() + '"'
print(re.sub(r'"values":"([^"]*)"', halved, open(sys.argv[1]).read()))
END_OF_DAMAGE
refused wrong.html - 'halved distances'
sed 's/const clear/const dear/; s/byValue/byVolume/' bodies.html >other.html
refused other.html - 'other code'

# Results over the mesh, one and a series.
expect 0 '' "$BIN/bmesh-decimate" "$BRACKET" -o outer.ply --epsilon 2% --effort fast --preview outer.html --report outer.json
preview outer.html "$(figure outer.json 'r["distance"]["hausdorff_upper"]')"
expect 0 '' "$BIN/bmesh-decimate" "$BRACKET" -o 'level-{vertices}.ply' --vertices 200,100 --effort fast --direction inner --preview levels.html
preview levels.html -
grep -q '"name":"200 vertices"' levels.html || fail "a level is missing"
expect 2 'ends with .html' "$BIN/bmesh-decimate" "$BRACKET" -o no.ply --ratio 0.5 --preview no.png
expect 2 'cannot both' "$BIN/bmesh-decimate" "$BRACKET" -o no.ply --ratio 0.5 --preview page.html --report page.html
absent no.ply page.html
expect 2 'standard input' "$D" - --input-format obj -o no.glb --preview no.html
expect 2 'explode' "$D" "$BRACKET" -o no.glb --preview no.html --explode 1
absent no.glb no.html

# A robot's bodies, and what it sweeps.
cat >arm.urdf <<'END_OF_ROBOT'
<robot name="arm">
  <link name="base"><collision><geometry><cylinder radius="0.12" length="0.1"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0.2 0 0"/><geometry><box size="0.4 0.08 0.06"/></geometry></collision></link>
  <link name="fore"><collision><geometry><mesh filename="t.off" scale="0.2 -0.1 0.15"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.1"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="slide" type="prismatic"><parent link="upper"/><child link="fore"/><origin xyz="0.45 0 0" rpy="0.3 0 0"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.3" effort="1" velocity="1"/></joint>
</robot>
END_OF_ROBOT
tetrahedron >t.off
printf 'turn,slide\n0,0\n1.2,0\n1.2,0.2\n' >path.csv
expect 0 '' "$D" arm.urdf -o links --epsilon 3% --effort fast --preview links.html --report links.json
preview links.html "$(figure links.json 'max(l["reach_upper"] for l in r["links"])')"
# Its joints are moved by sliders: poses are those of inverse kinematics' program and, with a joint that follows another
# one, those that Python computes here. Ranges keep the limits of both.
sed 's,</robot>,<link name="tip"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link><joint name="follow" type="revolute"><parent link="fore"/><child link="tip"/><origin xyz="0.1 0 0.2" rpy="0.3 0 1"/><axis xyz="1 2 3"/><mimic joint="turn" multiplier="-0.5" offset="0.1"/><limit lower="-1" upper="1.2" effort="1" velocity="1"/></joint><link name="wheel"><collision><geometry><sphere radius="0.1"/></geometry></collision></link><joint name="spin" type="continuous"><parent link="base"/><child link="wheel"/><axis xyz="0 1 0"/></joint></robot>,' arm.urdf >hand.urdf
expect 0 '' "$D" hand.urdf -o hand --epsilon 3% --effort fast --preview hand.html --html-report rows.html
preview hand.html -
cat >judge.py <<'END_OF_JUDGE'
import json, math, random, subprocess, sys
import xml.etree.ElementTree as tree

ik, script = sys.argv[1:]

def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]

def turn(axis, angle):
    x, y, z = (v / math.sqrt(sum(w * w for w in axis)) for v in axis)
    c, s = math.cos(angle), math.sin(angle)
    k = 1 - c
    return [[c + k * x * x, k * x * y - s * z, k * x * z + s * y, 0], [k * x * y + s * z, c + k * y * y, k * y * z - s * x, 0],
            [k * x * z - s * y, k * y * z + s * x, c + k * z * z, 0], [0, 0, 0, 1]]

def shift(x, y, z):
    return [[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z], [0, 0, 0, 1]]

def numbers(element, name, otherwise):
    words = element.get(name) if element is not None else None
    return [float(word) for word in words.split()] if words else otherwise

robot = tree.parse("hand.urdf").getroot()
links = [link.get("name") for link in robot.iter("link")]

def poses(values):
    out = {"base": shift(0, 0, 0)}
    for joint in list(robot.iter("joint")) * 3:  # parents may come later
        parent, child = joint.find("parent").get("link"), joint.find("child").get("link")
        if parent not in out:
            continue
        origin, axis = joint.find("origin"), numbers(joint.find("axis"), "xyz", [1, 0, 0])
        r, p, y = numbers(origin, "rpy", [0, 0, 0])
        local = product(shift(*numbers(origin, "xyz", [0, 0, 0])), product(turn([0, 0, 1], y), product(turn([0, 1, 0], p), turn([1, 0, 0], r))))
        mimic = joint.find("mimic")
        value = values[joint.get("name")] if mimic is None else float(mimic.get("multiplier")) * values[mimic.get("joint")] + float(mimic.get("offset"))
        motion = shift(*(value * a for a in axis)) if joint.get("type") == "prismatic" else turn(axis, value)
        out[child] = product(product(out[parent], local), motion)
    return out

def flat(pose):
    return [pose[i][j] for i in range(3) for j in range(3)] + [pose[i][3] for i in range(3)]

def page(values):
    return json.loads(subprocess.run(["node", script, "hand.html", values], capture_output=True, text=True, check=True).stdout)

def rotation(x, y, z, w):
    return [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
            2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]

start = page("")
ranges = {s["name"]: (s["low"], s["high"]) for s in start["sliders"]}
near = lambda a, b: abs(a - b) < 1e-12
assert near(ranges["turn"][0], -2.2) and near(ranges["turn"][1], 2.2), ranges  # -0.5 turn + 0.1 is from -1 to 1.2
assert ranges["slide"] == (0, 0.3) and near(ranges["spin"][1], math.pi) and near(ranges["spin"][0], -math.pi), ranges
assert all(s["value"] == 0 for s in start["sliders"])
names = [s["name"] for s in start["sliders"]]
random.seed(1)
largest = 0
for trial in range(12):
    values = {name: random.uniform(*ranges[name]) for name in names}
    seen = page(",".join(repr(values[name]) for name in names))
    expected = poses(values)
    assert len(seen["poses"]) == len(links)
    found = {}
    for link, pose in seen["poses"].items():
        gap, name = min((max(abs(pose[k] - flat(other)[k]) for k in range(12)), name) for name, other in expected.items())
        found[name] = gap
        largest = max(largest, gap)
    assert len(found) == len(links), found  # each link is somewhere else
    subprocess.run([ik, "arm.urdf", "--tip", "fore", "--pose-of", f"{values['turn']!r},{values['slide']!r}", "--report", "ik.json"], capture_output=True)
    pose = json.load(open("ik.json"))["pose"]
    wanted = rotation(*pose[3:]) + pose[:3]
    largest = max(largest, min(max(abs(a - b) for a, b in zip(wanted, p)) for p in seen["poses"].values()))
assert largest < 1e-12, largest
chosen = {"turn": "0.5", "slide": "0.1", "spin": "1"}
words = {s["name"]: s["words"] for s in page(",".join(chosen[name] for name in names))["sliders"]}
assert words == {"turn": "28.65°", "slide": "100 mm", "spin": "57.3°"}, words
print("largest difference", largest)
END_OF_JUDGE
python3 judge.py "$BIN/kaboum-ik" "$HERE/move_joints.js" >said.txt 2>&1 || fail "sliders: $(tail -3 said.txt)"
sed 's/joint.multiplier \* q/q/' hand.html >kept.html && cp hand.html good.html && cp kept.html hand.html
! python3 judge.py "$BIN/kaboum-ik" "$HERE/move_joints.js" >said.txt 2>&1 || fail "joints that follow none are taken for good"
cp good.html hand.html
# A verdict for each link, and what to do next.
python3 - <<'END_OF_CHECK' || fail "words of the robot's page"
import json
data = json.loads(open("hand.html").read().split('type="application/json">')[1].split("</script>")[0])
assert data["table"]["head"] == ["link", "bodies", "vertices", "within", "verdict"] and data["table"]["bad"] == []
assert sorted(row[0] for row in data["table"]["rows"]) == ["base", "fore", "tip", "upper", "wheel"] and all("inside" in row[4] for row in data["table"]["rows"])
steps = {step["name"]: step["command"] for step in data["steps"]}
assert steps["check it"].startswith("bound-verify robot hand.urdf hand/hand.urdf") and steps["MuJoCo"] == "python3 -m mujoco.viewer --mjcf=hand/hand.xml"
assert {"MoveIt", "MuJoCo", "Drake", "Isaac Lab", "Gazebo"} < set(steps), steps
rows = open("rows.html").read()
assert "bound-verify robot hand.urdf" in rows and "pydrake.visualization.model_visualizer hand/hand.urdf" in rows
END_OF_CHECK
expect 0 '' "$BIN/sweep-approx" arm.urdf --path path.csv -o swept.glb --epsilon 0.02 --preview swept.html --report swept.json
preview swept.html "$(figure swept.json 'r["reach"] + r["bodies_epsilon"]')"
expect 0 '' "$BIN/sweep-approx" arm.urdf --path path.csv -o placed.glb --epsilon 0.02 --base-pose 1,2,0,0,0,1 --preview placed.html --report placed.json
preview placed.html "$(figure placed.json 'r["reach"] + r["bodies_epsilon"]')"
expect 0 '' "$BIN/sweep-approx" arm.urdf --path path.csv -o swept.glb --epsilon 0.02 --preview swept.png
[ "$(head -c 4 swept.png | tail -c 3)" = PNG ] || fail "no picture"

# A plan, and one under assumptions: outcomes without a branch are said.
P=$BIN/kaboum-plan
S=$HERE/../../examples/scenarios
"$HERE/../../examples/geometry/make-cell" remove 2 remove >make.txt 2>&1 || fail "make-cell: $(tail -1 make.txt)"
set -- "$S/remove/domain.kpl" remove/problem.kpl --scene remove/cell.json
expect 0 solved "$P" solve "$@" -o plan.json
expect 0 '' "$P" show "$@" --plan plan.json --html plan.html
node "$HERE/play_page.js" plan.html "$PLAYER" >said.txt 2>&1 || fail "plan.html: $(tail -5 said.txt)"
grep -q ' 0 left out' said.txt || fail "plan.html: $(cat said.txt)"
expect 0 '' "$P" run "$@" --plan plan.json --robot "python3 '$HERE/../../examples/drivers/driver.py'" --page run.html
node "$HERE/play_run.js" run.html "$PLAYER" >said.txt 2>&1 || fail "run.html: $(tail -5 said.txt)"
python3 - "$S/remove/domain.kpl" >weighed.kpl <<'END_OF_DOMAIN' || fail "domain with weights"
import sys
text = open(sys.argv[1]).read().replace("isHeld(block)", "isHeld(block), isHeavy(block)")
remove = text[text.index("action remove("):text.index("goal:")]
light = remove.replace("K(isHeld(?o)) &", "K(isHeld(?o)) & K(!isHeavy(?o)) &")
weigh = "action weigh(?o : block)\n  preconds:\n    K(isHeld(?o)) & !Kw(isHeavy(?o))\n  effects:\n    add(Kw, isHeavy(?o))\n\n"
print(text.replace(remove, light + weigh))
END_OF_DOMAIN
echo '{"isHeavy(o1)": false, "isHeavy(o2)": false}' >light.json
set -- weighed.kpl remove/problem.kpl --scene remove/cell.json
expect 0 'under 2 assumptions' "$P" solve "$@" --assume light.json -o assumed.json
expect 0 '' "$P" show "$@" --plan assumed.json --html assumed.html
node "$HERE/play_page.js" assumed.html "$PLAYER" >said.txt 2>&1 || fail "assumed.html: $(tail -5 said.txt)"
grep -q ' 2 left out' said.txt || fail "assumed.html: $(cat said.txt)"

if [ -n "$PAGES" ]; then
  mkdir -p "$PAGES"
  cp bodies.html outer.html hand.html swept.html plan.html assumed.html run.html "$PAGES/" || fail "pages for pages-seen.sh"
fi
finish
