# kaboum-pairs: verdicts, a file judged and corrected, what is written for others, exit codes.
. "$(dirname "$0")/common.sh"
P=$BIN/kaboum-pairs
box() { # NAME X Y Z SX SY SZ
  echo "<link name=\"$1\"><collision><origin xyz=\"$2 $3 $4\"/><geometry><box size=\"$5 $6 $7\"/></geometry></collision></link>"
}
joint() { # NAME PARENT CHILD XYZ AXIS LIMIT
  echo "<joint name=\"$1\" type=\"revolute\"><parent link=\"$2\"/><child link=\"$3\"/><origin xyz=\"$4\"/>
<axis xyz=\"$5\"/><limit lower=\"-$6\" upper=\"$6\" effort=\"1\" velocity=\"1\"/></joint>"
}
{
  echo '<robot name="arm">'
  box base 0 0 0.05 0.4 0.4 0.1
  box turret 0 0 0.1 0.1 0.1 0.3
  box upper 0 0 0.25 0.08 0.08 0.5
  box fore 0 0 0.25 0.06 0.06 0.5
  joint waist base turret '0 0 0.1' '0 0 1' 3
  joint shoulder turret upper '0 0 0.2' '0 1 0' 0.3
  joint elbow upper fore '0 0 0.5' '0 1 0' 3.1
  echo '</robot>'
} >arm.urdf
expect 0 '6 pairs: ' "$P" arm.urdf --json --srdf arm.srdf
python3 - <<'END' || fail "verdicts: $(cat out.txt)"
import json
pairs = {tuple(p["links"]): p for p in json.load(open("out.txt"))["pairs"]}
assert len(pairs) == 6
assert pairs["base", "upper"]["verdict"] == "never"
assert pairs["base", "upper"]["distance"]["at_least"] > 0
folded = pairs["turret", "fore"]
assert folded["verdict"] == "can touch" and folded["depth"]["at_least"] > 0
assert abs(folded["configuration"]["elbow"]) > 2
assert pairs["turret", "upper"]["relation"] == "adjacent"
assert pairs["turret", "upper"]["away_from_joint"]["verdict"] in ("never", "can touch")
END
grep -q 'link1="base" link2="upper" reason="Never"' arm.srdf || fail "arm.srdf: $(cat arm.srdf)"
grep -q 'turret" link2="fore' arm.srdf && fail 'a pair that touches was switched off'

# A configuration that shows a contact does so to the program that checks sets.
Q=$(python3 -c 'import json
for p in json.load(open("out.txt"))["pairs"]:
    if p["links"] == ["turret", "fore"]: print(",".join(map(repr, p["configuration"].values())))')
"$BIN/kaboum-scene" make cell.json --robot arm=arm.urdf --no-cache --quiet || fail 'no scene'
expect 1 '' "$BIN/kaboum-check" cell.json --configuration="$Q"
grep -q 'turret' out.txt || fail "no contact of the turret: $(cat out.txt)"

# One fixed joint: the two are fixed to each other, and adjacent in MoveIt's words.
{
  echo '<robot name="pole">'
  box base 0 0 0 0.4 0.4 0.1
  box pole 0 0 0.3 0.1 0.1 0.6
  box eye 0 0 0.9 0.1 0.1 0.1
  echo '<joint name="a" type="fixed"><parent link="base"/><child link="pole"/></joint>'
  echo '<joint name="b" type="fixed"><parent link="pole"/><child link="eye"/></joint></robot>'
} >pole.urdf
expect 0 '3 pairs: ' "$P" pole.urdf --json --srdf pole.srdf
[ "$(grep -c '"relation": "fixed"' out.txt)" = 3 ] || fail "relations: $(cat out.txt)"
[ "$(grep -c 'reason="Adjacent"' pole.srdf)" = 2 ] || fail "pole.srdf: $(cat pole.srdf)"
grep -q 'link1="base" link2="eye" reason="Never"' pole.srdf || fail "pole.srdf: $(cat pole.srdf)"

# The same for any number of threads.
expect 0 '' "$P" arm.urdf --json --threads 1
mv out.txt one.txt
expect 0 '' "$P" arm.urdf --json --threads 2
cmp -s one.txt out.txt || fail 'threads change what is said'

cat >stated.srdf <<'END'
<robot name="arm">
  <!-- made by sampling -->
  <disable_collisions link1="base" link2="upper" reason="Never"/>
  <disable_collisions link1="fore" link2="turret" reason="Never"/>
  <disable_collisions link1="upper" link2="base" reason="Never"/>
  <disable_collisions link1="base" link2="hand" reason="Never"/>
  <disable_collisions link1="base" link2="turret" reason="Adjacent"/> <!-- waist -->
</robot>
END
expect 1 '3 pairs disabled: 1 proved never to touch, 1 connected, 0 always in contact, 1 refuted, 0 open; 2 faults' \
  "$P" arm.urdf --judge stated.srdf -o corrected.srdf --junit pairs.xml --sarif pairs.sarif
grep -q 'line 4: fore turret (Never): refuted: they touch at ' out.txt || fail "$(cat out.txt)"
grep -q "line 5: the pair 'base', 'upper' is stated in line 3 already" out.txt || fail "$(cat out.txt)"
grep -q "line 6: the robot has no link 'hand'" out.txt || fail "$(cat out.txt)"
grep -v 'fore\|hand\|upper" link2' stated.srdf | cmp -s - corrected.srdf || fail "corrected.srdf: $(cat corrected.srdf)"
expect 0 '0 faults' "$P" arm.urdf --judge corrected.srdf --fail-on open,faults
# Pairs that the file does not state are decided for what is written only.
expect 1 '^3 pairs: ' "$P" arm.urdf --judge stated.srdf --json
[ "$(grep -c '"relation"' out.txt)" = 3 ] || fail "pairs that nobody asked for: $(cat out.txt)"
expect 1 '^6 pairs: ' "$P" arm.urdf --judge stated.srdf --json --srdf all.srdf
cmp -s arm.srdf all.srdf || fail "all.srdf: $(cat all.srdf)"
# What replays a contact decides that configuration again.
"$P" arm.urdf --judge stated.srdf --quiet --report judged.json
python3 -c 'import json
for p in json.load(open("judged.json"))["matrix"]["disabled"]:
    if "replay" in p: print(p["replay"])' >replay.txt
[ "$(wc -l <replay.txt)" = 1 ] || fail "replays: $(cat replay.txt)"
expect 1 '1 pairs: 0 apart, .* 1 in contact, 0 open' sh -c "PATH=$BIN:\$PATH; $(cat replay.txt)"
grep -q '^turret fore: in contact, .* deep$' out.txt || fail "$(cat out.txt)"

# One configuration: contacts at joints are none; a picture shows the others.
expect 0 '6 pairs: 3 apart, 3 touch at a joint at most, 0 in contact, 0 open' \
  "$P" arm.urdf --configuration 0,0,0 --preview upright.png
grep -q '^turret fore: apart, distance at least 0\.' out.txt || fail "$(cat out.txt)"
expect 1 '' "$P" arm.urdf --configuration="$Q" --preview folded.png --report folded.json
python3 - <<'END' || fail 'a configuration: report or picture'
import json
report = json.load(open("folded.json"))
assert len(report["configuration"]) == 3
assert [p["links"] for p in report["pairs"] if p["verdict"] in ("always", "can touch") and p["relation"] == "moving"] == [["turret", "fore"]]
upright, folded = (open(n + ".png", "rb").read() for n in ("upright", "folded"))
assert upright[:4] == folded[:4] == b"\x89PNG" and len(folded) > 1000 and upright != folded
END
expect 2 '3 values are expected, one for each of waist,shoulder,elbow, not 2' "$P" arm.urdf --configuration 0,0
expect 2 'excludes' "$P" arm.urdf --configuration 0,0,0 --judge stated.srdf
expect 2 'requires' "$P" arm.urdf --preview a.png
expect 2 'ends with .png, not a.jpg' "$P" arm.urdf --configuration 0,0,0 --preview a.jpg
# An arm that folds into the link it hangs from: a contact away from the joint is one, and is shown.
shape() { # X Y Z SX SY SZ
  echo "<collision><origin xyz=\"$1 $2 $3\"/><geometry><box size=\"$4 $5 $6\"/></geometry></collision>"
}
{
  echo '<robot name="hook"><link name="stem">'
  shape 0 0 0.9 0.05 0.05 0.1
  shape 0 0 0.4 0.05 0.05 0.8
  echo '</link><link name="hook">'
  shape 0 0 0 0.06 0.06 0.06
  shape 0.22 0 0 0.36 0.05 0.05
  shape 0.38 0 -0.25 0.05 0.05 0.5
  echo '</link>'
  joint turn stem hook '0 0 0.9' '0 1 0' 1.5
  echo '</robot>'
} >hook.urdf
echo '<robot name="hook"><disable_collisions link1="stem" link2="hook" reason="Adjacent"/></robot>' >hook.srdf
expect 1 '1 refuted' "$P" hook.urdf --judge hook.srdf
sed -n 's/^  kaboum-pairs/kaboum-pairs/p' out.txt >replay.txt
[ "$(wc -l <replay.txt)" = 1 ] || fail "replays: $(cat out.txt)"
expect 1 '1 in contact, 0 open' sh -c "PATH=$BIN:\$PATH; $(cat replay.txt)"
grep -q '^stem hook: adjacent; in contact.*from the joint: in contact$' out.txt || fail "$(cat out.txt)"
expect 0 '1 touch at a joint at most, 0 in contact, 0 open' "$P" hook.urdf --configuration 0
python3 - <<'END' || fail 'JUnit or SARIF'
import json
import xml.etree.ElementTree as xml
suite = xml.parse("pairs.xml").getroot().find("testsuite")
assert suite.get("tests") == "3" and suite.get("failures") == "1"
failed = [c for c in suite.iter("testcase") if c.find("failure") is not None]
assert [(c.get("name"), c.get("line")) for c in failed] == [("fore turret", "4")]
assert "--configuration=" in failed[0].find("failure").text
run, = json.load(open("pairs.sarif"))["runs"]
rules = {r["id"] for r in run["tool"]["driver"]["rules"]}
found = [(r["ruleId"], r["locations"][0]["physicalLocation"]["region"]["startLine"]) for r in run["results"]]
assert found == [("refuted", 4), ("doubled", 5), ("unknown-link", 6)] and {r for r, _ in found} <= rules
END

# Faults of the file are named, and fail where they are asked for.
grep -v 'fore' stated.srdf >faulty.srdf
expect 0 '0 refuted, 0 open; 2 faults' "$P" arm.urdf --judge faulty.srdf --fail-on open
expect 0 '' "$P" arm.urdf --judge faulty.srdf --fail-on refuted --junit pairs.xml --sarif pairs.sarif
grep -q 'tests="2" failures="0"' pairs.xml || fail "$(cat pairs.xml)"
grep -q '"level": "error"' pairs.sarif && fail 'a fault that is no error'
for on in faults open,faults; do
  expect 1 '2 faults' "$P" arm.urdf --judge faulty.srdf --fail-on $on --junit pairs.xml --sarif pairs.sarif
  grep -q 'tests="4" failures="2"' pairs.xml || fail "$(cat pairs.xml)"
  grep -q 'name="unknown-link in line 5".*line="5"' pairs.xml || fail "$(cat pairs.xml)"
  [ "$(grep -c '"level": "error"' pairs.sarif)" = 2 ] || fail "$(cat pairs.sarif)"
done
grep -v 'hand\|upper" link2' faulty.srdf >clean.srdf
expect 0 '0 faults' "$P" arm.urdf --judge clean.srdf --fail-on open,faults
expect 2 'fail-on' "$P" arm.urdf --judge clean.srdf --fail-on warnings

# A file that disables nothing is said to be one.
echo '<robot name="arm"><group name="g"/></robot>' >none.srdf
expect 0 'none.srdf disables no pair of links: there is nothing to judge' "$P" arm.urdf --judge none.srdf

# Nothing is decided in no time, and that is said.
expect 7 '6 open' "$P" arm.urdf --timeout 1e-9 --srdf late.srdf
[ "$(grep -c 'open, .*; a longer --timeout or more --max-boxes may decide it' out.txt)" = 6 ] || fail "$(cat out.txt)"
grep -q 'late.srdf: 3 pairs of adjacent links are not disabled, .*: base turret; turret upper; upper fore' err.txt ||
  fail "$(cat err.txt)"
expect 1 '' "$P" arm.urdf --judge stated.srdf --timeout 1e-9 --fail-on open
expect 2 'requires' "$P" arm.urdf -o corrected.srdf
expect 2 'links' "$P" arm.urdf --judge stated.srdf --links base,upper
expect 3 'no two links with shapes' "$P" arm.urdf --links base
sed 's/collision/visual/g' arm.urdf >drawn.urdf
expect 3 'no two links with shapes, .*; --geometry visual takes shapes that are drawn' "$P" drawn.urdf
expect 0 '6 pairs: ' "$P" drawn.urdf --geometry visual
expect 3 'no pair; --geometry collision takes those for collisions' "$P" arm.urdf --geometry visual
expect 3 'no pair among those of --links' "$P" arm.urdf --links base
echo '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint></robot>' >bare.urdf
for geometry in collision visual; do
  expect 3 'no two links with shapes, so there is no pair$' "$P" bare.urdf --geometry $geometry
done
# Links that touch exactly at their joint: open there, and decided away from it.
{
  echo '<robot name="r">'
  box a 0 0 -0.5 0.2 0.2 1
  box b 0 0 0.5 0.2 0.2 1
  joint j a b '0 0 0' '0 0 1' 1
  echo '</robot>'
} >flush.urdf
expect 7 '' "$P" flush.urdf --max-boxes 1000
grep -q '^a b: adjacent; open at the joint, .*; farther than [0-9.]* from the joint: never;' out.txt || fail "$(cat out.txt)"
echo '<robot><disable_collisions link1="base"/></robot>' >bad.srdf
expect 3 "bad.srdf: line 1: <disable_collisions> has no 'link2'" "$P" arm.urdf --judge bad.srdf
expect 3 'absent.srdf' "$P" arm.urdf --judge absent.srdf
expect 3 'this is a robot (URDF), which states no pairs' "$P" arm.urdf --judge drawn.urdf

# Bodies in a solid are in it whatever is wrong with its mesh. Never is not said where it is not known.
cat >in.py <<'END'
import sys
corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
box = [(1, 2, 4), (1, 4, 3), (5, 7, 8), (5, 8, 6), (1, 5, 6), (1, 6, 2), (3, 4, 8), (3, 8, 7), (1, 3, 7), (1, 7, 5),
       (2, 6, 8), (2, 8, 4)]
sheet = [(9, 10, 11), (9, 11, 10)]
files = {
    "flipped": [(1, 4, 2)] + box[1:],
    "sheet": box[:-1] + sheet,
    "no_solid": sheet,
    "copies": box + box,
}
for name, triangles in files.items():
    with open(name + ".obj", "w") as out:
        for v in corners + [(3, 0, 0), (4, 0, 0), (4, 1, 0)]:
            out.write("v %g %g %g\n" % v)
        for t in triangles:
            out.write("f %d %d %d\n" % t)
END
python3 in.py || fail 'no meshes'
carried() { # LINK LINK [AXIS LOWER UPPER [OTHER AXIS]]: two joints that slide carry the last link
  echo "<robot name=\"r\" version=\"1.1\">$1<link name=\"m\"/>$2"
  echo "<joint name=\"x\" type=\"prismatic\"><parent link=\"a\"/><child link=\"m\"/><axis xyz=\"${6:-0 1 0}\"/>
<limit lower=\"-0.01\" upper=\"0.01\" effort=\"1\" velocity=\"1\"/></joint>"
  echo "<joint name=\"y\" type=\"prismatic\"><parent link=\"m\"/><child link=\"b\"/><axis xyz=\"${3:-1 0 0}\"/>
<limit lower=\"${4:--0.3}\" upper=\"${5:-0.3}\" effort=\"1\" velocity=\"1\"/></joint></robot>"
}
shape() { echo "<link name=\"$1\"><collision><origin xyz=\"$3\"/><geometry>$2</geometry></collision></link>"; }
for name in flipped copies; do
  carried "$(shape a "<mesh filename=\"$name.obj\"/>" '0 0 0')" "$(box b 0 0 0 0.2 0.2 0.2)" >in.urdf
  expect 0 '1 always do' "$P" in.urdf
done
carried "$(shape a '<mesh filename="sheet.obj"/>' '0 0 0')" "$(box b 0 0 0 0.2 0.2 0.2)" >in.urdf
expect 7 '1 open' "$P" in.urdf
carried "$(shape a '<mesh filename="no_solid.obj"/>' '0 0 0')" "$(box b 3.8 0.3 0 0.2 0.2 0.2)" >in.urdf
shows 0 '^a b: .*, [0-9.]* to [0-9.]* deep' "$P" in.urdf
carried "$(shape a '<mesh filename="no_solid.obj"/>' '0 0 0')" "$(box b 0 0 0 0.2 0.2 0.2)" >in.urdf
expect 0 '1 never touch' "$P" in.urdf
grep -q "link 'a': a mesh has no solid .*: proofs are of its convex hull" err.txt || fail "$(cat err.txt)"

# Of a mesh whose solid is a guess, never is proved of its hull if it has a border, else of what it shuts off.
cat >guess.py <<'END'
import math
def write(name, corners, triangles):
    with open(name + ".obj", "w") as out:
        for v in corners:
            out.write("v %g %g %g\n" % v)
        for t in triangles:
            out.write("f %d %d %d\n" % tuple(i + 1 for i in t))
# Two sheets with two sides each.
corners = [(x, y, z) for z in (-1, 1) for x, y in ((-2, -2), (2, -2), (0, 3))]
write("sheets", corners, [(0, 1, 2), (0, 2, 1), (3, 4, 5), (3, 5, 4)])
# A bin and its waisted liner, both open on top, with one rim and one bottom.
ring = [(math.cos(k * math.pi / 6), math.sin(k * math.pi / 6)) for k in range(12)]
corners = [(r * x, r * y, z) for r, z in ((1, -1), (1, 1), (0.5, 0)) for x, y in ring] + [(0, 0, -1)]
def wall(low, high):
    return [t for k in range(12) for a, b in ((k, (k + 1) % 12),) for t in ((low + a, low + b, high + b), (low + a, high + b, high + a))]
bottom = [(36, (k + 1) % 12, k) for k in range(12)]
write("liner", corners, wall(0, 12) + bottom + wall(0, 24) + wall(24, 12) + bottom)
# A floor and a wall at its end, of sheets with two sides, in small parts.
def plate(p, u, v, parts):
    at = lambda i, j: tuple(p[k] + i / parts * u[k] + j / parts * v[k] for k in range(3))
    corners = [at(i, j) for i in range(parts + 1) for j in range(parts + 1)]
    cells = [i * (parts + 1) + j for i in range(parts) for j in range(parts)]
    return corners, [t for c in cells for t in ((c, c + 1, c + parts + 2), (c, c + parts + 2, c + parts + 1))]
corners, triangles = plate((-0.3, -0.3, 0), (3, 0, 0), (0, 0.6, 0), 16)
more, others = plate((2.7, -0.3, 0), (0, 0.6, 0), (0, 0, 1), 16)
triangles += [tuple(len(corners) + k for k in t) for t in others]
write("hook", corners + more, triangles + [t[::-1] for t in triangles])
# A prism that crosses itself: a large part, and a small one that is inside out.
bow = [(-3, -3), (1, 1), (1, -1), (-3, 3)]
corners = [(x, y, z) for z in (-1, 1) for x, y in bow]
sides = [t for i in range(4) for t in ((i, (i + 1) % 4, 4 + (i + 1) % 4), (i, 4 + (i + 1) % 4, 4 + i))]
write("bow", corners, [(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7)] + sides)
END
python3 guess.py || fail 'no meshes'
guess() { # MESH X: a box in it, or beside it
  carried "$(shape a "<mesh filename=\"$1.obj\"/>" '0 0 0')" "$(box b "$2" 0 0 0.1 0.1 0.1)" '1 0 0' -0.05 0.05 >in.urdf
}
for name in sheets bow; do
  guess $name 3
  expect 0 '1 never touch' "$P" in.urdf
done
guess bow 0.7
expect 7 "link 'a': which solid a mesh means is not certain: .*: proofs are of all that its triangles shut off" "$P" in.urdf --json
python3 - <<'END' || fail "why a pair is open: $(cat out.txt)"
import json
said = json.load(open("out.txt"))
pair, = said["pairs"]
assert pair["verdict"] == "open" and "not certain" in pair["why"] and "not certain" in said["notes"][0], said
assert pair["distance"]["at_least"] == 0 and "unfinished" not in pair, said
END
guess sheets 0
expect 7 '1 open' "$P" in.urdf
# Two open surfaces on one rim: what is in the inner one may be in the solid.
guess liner 0
expect 7 "a mesh has no solid .*: proofs are of its convex hull" "$P" in.urdf --json
# Of a hull nobody knows where it meets what hangs from it: that is looked for by the mesh.
{
  echo '<robot name="r">'
  shape a '<mesh filename="hook.obj"/>' '0 0 0'
  echo '<link name="b">'
  for z in -0.03 0.07 0.17 0.27 0.37 0.47 0.57 0.67 0.77 0.87 0.97 1.07 1.17 1.27 1.37 1.47 1.57 1.67 1.77 1.87 1.97; do
    echo "<collision><origin xyz=\"0 0 $z\"/><geometry><box size=\"0.06 0.06 0.1\"/></geometry></collision>"
  done
  echo '</link>'
  joint j a b '0 0 0.05' '0 1 0' 1.6
  echo '</robot>'
} >hook.urdf
echo '<robot name="r"><disable_collisions link1="a" link2="b" reason="Adjacent"/></robot>' >hook.srdf
expect 1 'refuted' "$P" hook.urdf --judge hook.srdf --timeout 20
guess bow -2
expect 0 '1 always do' "$P" in.urdf

# Nor where shapes are not read, or of the other kind.
cat >floor.xml <<'END'
<mujoco><worldbody>
 <geom type="plane" size="5 5 .1"/>
 <body name="base" pos="0 0 1"><geom type="box" size=".1 .1 .1"/>
  <body name="arm"><joint name="j" type="slide" axis="0 0 1" range="-2 2"/><geom type="box" size=".05 .05 .05" pos="1 0 0"/></body>
 </body>
</worldbody>
<contact><exclude body1="world" body2="arm"/></contact></mujoco>
END
expect 7 'floor.xml:2: a plane' "$P" floor.xml --judge floor.xml
grep -q "world arm: open: .*link 'world': a plane is not looked at" out.txt || fail "$(cat out.txt)"
expect 7 '' "$P" floor.xml --json
python3 - <<'END' || fail "a floor that is not read: $(cat out.txt)"
import json
said = json.load(open("out.txt"))
assert any("floor.xml:2: a plane" in note for note in said["notes"]), said["notes"]
found = {tuple(p["links"]): p for p in said["pairs"]}
for link in "base", "arm":
    pair = found["world", link]
    assert pair["verdict"] == "open" and "a plane" in pair["why"] and pair["distance"]["at_least"] == 0, pair
END
cat >floor.sdf <<'END'
<sdf version="1.9"><model name="m">
 <link name="ground"><collision name="c"><geometry><plane><normal>0 0 1</normal></plane></geometry></collision></link>
 <link name="arm"><collision name="c"><pose>1 0 1 0 0 0</pose><geometry><box><size>.1 .1 .1</size></box></geometry></collision></link>
 <joint name="j" type="prismatic"><parent>ground</parent><child>arm</child><axis><xyz>0 0 1</xyz><limit><lower>-2</lower><upper>2</upper></limit></axis></joint>
</model></sdf>
END
echo '<robot name="m"><disable_collisions link1="ground" link2="arm" reason="Never"/></robot>' >floor.srdf
expect 7 "a plane of link 'ground'" "$P" floor.sdf --judge floor.srdf
grep -q "ground arm (Never): open: " out.txt || fail "$(cat out.txt)"
{
  echo '<robot name="r"><link name="a"><visual><geometry><box size="1 1 1"/></geometry></visual></link><link name="f"/>'
  box m 0 0 5 0.1 0.1 0.1
  box b 0 0 0 0.9 0.8 0.7
  joint i a m '0 0 0' '0 1 0' 1
  joint j m b '0 0 0' '1 0 0' 1
  echo '<joint name="k" type="fixed"><parent link="b"/><child link="f"/></joint></robot>'
} >drawn.urdf
echo '<robot name="r"><disable_collisions link1="a" link2="b"/><disable_collisions link1="f" link2="m"/></robot>' >drawn.srdf
expect 7 "link 'a' has no collision shape, only visual ones" "$P" drawn.urdf --judge drawn.srdf
grep -q 'a b: open: ' out.txt || fail "$(cat out.txt)"
grep -q "f m: proved: link 'f' has no shapes" out.txt || fail "$(cat out.txt)"

# A carriage that hits the wall at the end of its rail: that is not at the joint, and is not accepted.
{
  echo '<robot name="r"><link name="rail"><collision><geometry><box size="1 .1 .1"/></geometry></collision>'
  echo '<collision><origin xyz="2 0 .5"/><geometry><box size=".1 1 1"/></geometry></collision></link>'
  box carriage 0 0 0.3 0.2 0.2 0.2
  echo '<joint name="j" type="prismatic"><parent link="rail"/><child link="carriage"/><axis xyz="1 0 0"/>
<limit lower="-1" upper="3" effort="1" velocity="1"/></joint></robot>'
} >rail.urdf
echo '<robot name="r"><disable_collisions link1="rail" link2="carriage" reason="Adjacent"/></robot>' >rail.srdf
expect 7 '0 connected, 0 always in contact, 0 refuted, 1 open' "$P" rail.urdf --judge rail.srdf --srdf wrote.srdf
grep -q 'open: .*one joint connects them, and contacts at it are not told from others' out.txt || fail "$(cat out.txt)"
grep -q disable wrote.srdf && fail 'a carriage that hits a wall was switched off'

# What is flat is looked at as well; points are not, and that is said.
for what in '<cylinder radius="0.3" length="0"/>' '<sphere radius="0"/>' '<sphere radius="1e-200"/>'; do
  carried "$(box a 0 0 0 1 1 1)" "$(shape b "$what" '0 0 0')" >flat.urdf
  expect 7 '1 pairs: 0 never touch, 0 always do, 0 can, 1 open' "$P" flat.urdf
done

# Of what is round, the inner meshes lie in it: 2.8 mm beyond them nothing is said.
for what in '<capsule radius="1" length="1"/>' '<sphere radius="1"/>'; do
  z=0
  case $what in *capsule*) z=-0.5 ;; esac
  carried "$(shape a "$what" "0 0 $z")" "$(box b 0 0 0 0.0001 0.0001 0.0001)" '0 1 1.6180339887' 1.003 1.0035 '1 0 0' >round.urdf
  expect 7 '1 open' "$P" round.urdf
  carried "$(shape a "$what" "0 0 $z")" "$(box b 0 0 0 0.0001 0.0001 0.0001)" '0 1 1.6180339887' 0.5 0.9 >round.urdf
  expect 0 '1 always do' "$P" round.urdf
done
cat >round.xml <<'END'
<mujoco><compiler angle="radian"/><worldbody>
 <body name="a"><geom type="ellipsoid" size="1 1 1"/>
  <body name="m"><joint name="x" type="slide" axis="1 0 0" range="0 0.0001"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
   <body name="b"><joint name="y" type="slide" axis="0 1 1.6180339887" range="1.003 1.0035"/>
    <geom type="box" size="0.00005 0.00005 0.00005"/></body></body></body>
</worldbody></mujoco>
END
expect 7 '1 open' "$P" round.xml
sed -i 's/1.003 1.0035/0.5 0.9/' round.xml
expect 0 '1 always do' "$P" round.xml
finish
