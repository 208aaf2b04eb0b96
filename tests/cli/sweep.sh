# shellcheck shell=sh disable=SC2154
. "$(dirname "$0")/common.sh"
S=$BIN/sweep-approx
KABOUM_CACHE=$WORK/cache
export KABOUM_CACHE

# Two turning links and a sliding one; shapes of all kinds, a mesh by package:// and one beside it.
mkdir -p robots/urdf shapes
tetrahedron >shapes/t.off
tetrahedron >robots/urdf/u.off
cat >robots/urdf/r.urdf <<'END'
<robot name="r">
  <link name="base"><collision><geometry><box size="0.2 0.2 0.1"/></geometry></collision></link>
  <link name="arm"><collision><geometry><mesh filename="package://shapes/t.off" scale="0.2 0.2 0.5"/></geometry></collision></link>
  <link name="hand">
    <collision><geometry><cylinder radius="0.05" length="0.2"/></geometry></collision>
    <collision><geometry><mesh filename="u.off" scale="0.1 -0.1 0.1"/></geometry></collision>
  </link>
  <link name="finger"><collision><geometry><sphere radius="0.03"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="elbow" type="continuous"><parent link="arm"/><child link="hand"/><origin xyz="0 0 0.5"/><axis xyz="0 1 0"/></joint>
  <joint name="grip" type="prismatic"><parent link="hand"/><child link="finger"/><origin xyz="0 0 0.2"/>
    <limit lower="0" upper="0.1" effort="1" velocity="1"/></joint>
</robot>
END
R=robots/urdf/r.urdf
printf 'grip,shoulder,elbow\n0,0,0\n0.1,1,-1\n0,1.5,0\n' >path.csv
printf '{"joints": ["shoulder", "elbow", "grip"], "waypoints": [[0, 0, 0], [1, -1, 0.1], [1.5, 0, 0]]}' >path.json

shows 0 'Bounds the volume' "$S" --help
expect 0 'margin' "$S" "$R" --path path.csv --epsilon 0.005 -o a.glb --report a.json --preview a.png --depfile a.d --implicit-margin
grep -q '^WARNING: a.glb: its bodies alone do NOT contain the robot: add 0.00[0-9]* to every body' err.txt ||
  fail "nobody says that the margin is to be added"
expect 0 "margin of .* is left out" "$BIN/hausdorff-eval" a.glb "$BRACKET" --a-as mesh --samples 1000 --gap 0.9
for key in '"certified": true' '"hand"' '"margin": 0.00' '"reach"' '"waypoints": 3'; do
  grep -q "$key" a.json || fail "no $key in the report"
done
[ -s a.png ] || fail "no picture"
grep -q '^a.glb: .*r.urdf.*path.csv.*t.off' a.d || fail "dependency file"
expect 0 '' "$S" "$R" --path path.json -o b.glb --threads 1 --quiet
[ ! -s err.txt ] || fail "--quiet is not quiet"
expect 0 'margin 0;' "$S" "$R" --path path.csv -o two.glb --threads 2
cmp -s b.glb two.glb || fail "two threads give other bytes"
"$S" "$R" --path path.json -o c.glb --threads 1 --quiet --implicit-margin 2>err.txt
grep -q '^WARNING' err.txt || fail "--quiet hides that the margin is to be added"
cmp -s a.glb c.glb || fail "JSON, one thread or the cache give other bytes"

# The start and the end of the path, at rest, are covered.
printf '1 -1 0.1\n' >pose.csv
expect 0 '' "$S" "$R" --path pose.csv --links hand -o pose.obj
expect 0 '' "$S" "$R" --path path.csv --links hand -o swept.obj
[ "$(grep -c '^o ' pose.obj)" -lt "$(grep -c '^o ' swept.obj)" ] || fail "a pose takes as many bodies as a path"

# Every rule; those after the first need fewer bodies. Baginski's is not certified.
last=100000
for bound in uniform subset second-order adaptive balanced; do
  expect 0 '' "$S" "$R" --path path.csv -o "$bound.obj" --bound "$bound"
  n=$(grep -c '^o ' "$bound.obj")
  [ "$n" -le "$last" ] || fail "$bound needs more bodies than the rule before"
  last=$n
done
printf 'shoulder,elbow,grip\n0,0,0\n1,-1,0\n' >turn.csv
expect 0 'NOT certified' "$S" "$R" --path turn.csv -o baginski.glb --bound baginski --report baginski.json
grep -q '"certified": false' baginski.json || fail "baginski is called certified"
expect 2 'revolute' "$S" "$R" --path path.csv -o x.glb --bound baginski

# Margins that are explicit, folders, pipes, limits of reach.
expect 0 'margin 0' "$S" "$R" --path path.csv -o folder
expect 0 'margin 0' "$S" "$R" --path path.csv -o slash/
diff -r folder slash >diff.txt || fail "a slash after the folder's name makes a difference: $(cat diff.txt)"
expect 4 'create it first' "$S" "$R" --path path.csv -o no/folder/
expect 4 'create it first' "$S" "$R" --path path.csv -o x.glb --report no-file/
expect 2 'cannot both' "$S" "$R" --path path.csv -o both/ --report both
expect 2 'only .glb can state' "$S" "$R" --path path.csv -o x.obj --implicit-margin
expect 2 'for an output that is a .urdf' "$S" "$R" --path path.csv -o x.glb --mesh-prefix package://cell
expect 0 'margin 0;' "$S" "$R" --path path.csv -o all.urdf
grep -q 'all.urdf names its meshes relative to itself (all/...)' err.txt || fail "how meshes are found"
for kind in collision visual; do
  [ "$(grep -c "<$kind " all.urdf)" = "$(find all -name 'all-*.stl' | wc -l)" ] || fail "one $kind shape per body"
done
cp all.urdf all0.urdf
for prefix in package://cell package://cell/; do
  expect 0 'package://cell/all/' "$S" "$R" --path path.csv -o all.urdf --mesh-prefix "$prefix"
  sed 's,package://cell/,,' all.urdf | cmp -s - all0.urdf || fail "a prefix changes more than names"
done
cp all0.urdf all.urdf
sed -n 's/.*filename="\([^"]*\)".*/\1/p' all.urdf | while read -r f; do [ -s "$f" ] || echo lost; done | grep -q lost &&
  fail "a body's file is missing"
expect 0 '' "$S" "$R" --path path.csv -o d.glb --max-reach 1cm
expect 0 '' "$S" "$R" --path path.csv -o e.glb --simplify 0.3 --report e.json --implicit-margin
[ "$(sed -n 's/.*"vertices": \([0-9]*\).*/\1/p' e.json)" -lt "$(sed -n 's/.*"vertices": \([0-9]*\).*/\1/p' a.json)" ] ||
  fail "simplified hulls have as many vertices"
expect 2 '' "$S" "$R" --path path.csv -o x.glb --simplify 1
expect 2 'from 0 to 0.9' "$S" "$R" --path path.csv -o x.glb --simplify +-0.3
expect 0 '' "$S" "$R" --path path.csv -o plus.glb --simplify +0.3 --epsilon +0.005
"$S" "$R" --path - --output-format obj -o - --quiet <path.csv >pipe.obj || fail "pipe"
cmp -s pipe.obj balanced.obj || fail "the pipe gives other bytes"

# Bad input, usage, valid "no".
sed 's/type="continuous"/type="planar"/' "$R" >planar.urdf
expect 3 "planar.urdf:1[0-9]*: joint 'elbow' is planar or floating" "$S" planar.urdf --path path.csv -o x.glb
head -c 300 "$R" >cut.urdf
expect 3 'cut.urdf' "$S" cut.urdf --path path.csv -o x.glb
sed 's/t\.off/none.off/' "$R" >robots/urdf/lost.urdf
expect 3 'package://shapes/none.off' "$S" robots/urdf/lost.urdf --path path.csv -o x.glb
printf '0 0 0\n3 0 0\n' >limit.csv
expect 3 "waypoint 2: joint 'shoulder' at 3 is outside" "$S" "$R" --path limit.csv -o x.glb
expect 0 '' "$S" "$R" --path limit.csv -o ignored.glb --ignore-limits
printf '0 0\n' >narrow.csv
expect 3 'columns' "$S" "$R" --path narrow.csv -o x.glb
expect 3 'none.csv' "$S" "$R" --path none.csv -o x.glb
expect 2 'nothing' "$S" "$R" --path path.csv -o x.glb --links nothing
expect 2 '' "$S" "$R" --path path.csv -o x.glb --epsilon 0
expect 2 '' "$S" "$R" --path path.csv -o x.glb --bound best
expect 2 '' "$S" "$R" --path path.csv
expect 1 'too coarse' "$S" "$R" --path path.csv -o x.glb --epsilon 1e-6 --body-epsilon 1%
expect 4 '' "$S" "$R" --path path.csv -o /nonexistent/dir/x.glb
expect 4 '' "$S" "$R" --path path.csv -o /nonexistent/dir/x.urdf
absent x.glb

# Huge moves are named; a path that could be read in two ways is refused.
printf 'elbow,shoulder,grip\n0,0,0\n1e9,0,0\n' >huge.csv
expect 2 "joint 'elbow' moves most, by 1e+09 to waypoint 2" "$S" "$R" --path huge.csv -o x.glb
expect 2 'adaptive or balanced$' "$S" "$R" --path path.csv -o x.glb --bound uniform --max-reach 0.01
expect 2 'only, and a prismatic one moves$' "$S" "$R" --path path.csv -o x.glb --bound baginski
expect 2 'allow a larger epsilon or reach$' "$S" "$R" --path pose.csv -o x.glb --max-reach 1e-300
for comment in '# grip, shoulder, elbow' '\0357\0273\0277# grip shoulder elbow' '# joints: grip, shoulder, elbow' \
  '# shoulder [rad], grip [m], elbow [rad]' '#elbow(rad);shoulder(rad)' '# q = (grip, shoulder) and so on' \
  '\n# of the arm\n  # waypoints of grip|elbow' '0,0,0 # grip, elbow'; do
  printf '%b\n0,0,0\n' "$comment" >comment.csv
  expect 3 'a comment names joints in another order' "$S" "$R" --path comment.csv -o x.glb
done
grep -q 'line 1:' err.txt || fail 'no line of the comment'
for comment in '# joints: shoulder [rad], elbow [rad], grip [m]; shoulder first' '# grip-shoulder, elbow_2' '# grip: see below' \
  '0,0,0\n# grip, elbow' 'shoulder, elbow, grip\n# grip, elbow'; do
  printf '%b\n0,0,0\n' "$comment" >comment.csv
  expect 0 '' "$S" "$R" --path comment.csv -o commented.glb
done
sed 's/"elbow"/"upper joint"/; s/"shoulder"/"lower joint"/' "$R" >robots/urdf/blanks.urdf
printf '# upper joint, lower joint, grip\n0,0,0\n' >comment.csv
expect 3 'line 1: a comment names joints in another order' "$S" robots/urdf/blanks.urdf --path comment.csv -o x.glb
sed 's/"elbow"/"1"/; s/"shoulder"/"2"/; s/"grip"/"3"/' "$R" >robots/urdf/numbered.urdf
printf '3,2,1\n0,0,0\n' >numbers.csv
expect 3 'line 1: these numbers are also names of joints' "$S" robots/urdf/numbered.urdf --path numbers.csv -o x.glb
printf '\357\273\2773;2;1\n0;0;0\n' >numbers.csv
expect 3 'line 1: these numbers are also names of joints' "$S" robots/urdf/numbered.urdf --path numbers.csv -o x.glb
printf '0.3,2,1 # in 3.2.1 steps\n' >numbers.csv
expect 3 'at .* is outside its limits, .* to .* (radians' "$S" robots/urdf/numbered.urdf --path numbers.csv -o x.glb
absent x.glb

# A box whose normals point inwards encloses nothing as it is; plates round its faces do not hold its inside.
mkdir inwards
python3 - <<'END_OF_BOXES'
def box(low, high, first=1):
    corners = [(high[0] if i & 1 else low[0], high[1] if i & 2 else low[1], high[2] if i & 4 else low[2]) for i in range(8)]
    faces = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]
    return corners, faces
corners, faces = box((0, 0, 0), (1, 1, 1))
with open("inwards/in.off", "w") as out:
    out.write("OFF\n8 12 0\n" + "".join("%g %g %g\n" % c for c in corners) + "".join("3 %d %d %d\n" % (a, c, b) for a, b, c in faces))
with open("inwards/plates.obj", "w") as out:
    n = 1
    for axis in range(3):
        for side in (0, 1):
            low, high = [-0.01] * 3, [1.01] * 3
            low[axis], high[axis] = side - 0.01, side + 0.01
            corners, faces = box(low, high)
            out.write("o plate%d\n" % n + "".join("v %g %g %g\n" % c for c in corners))
            out.write("".join("f %d %d %d\n" % tuple(n + i for i in f) for f in faces))
            n += 8
END_OF_BOXES
cat >inwards/r.urdf <<'END_OF_ROBOT'
<robot name="r"><link name="base"><collision><geometry><mesh filename="in.off"/></geometry></collision></link><link name="tip"/>
<joint name="j" type="prismatic"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>
END_OF_ROBOT
printf 'j\n0\n1\n' >inwards/path.csv
shows 7 'solid claim: undecided: .*is inside out' "$BIN/bound-verify" sweep inwards/r.urdf inwards/path.csv inwards/plates.obj
expect 1 '' "$BIN/bound-verify" sweep inwards/r.urdf inwards/path.csv inwards/plates.obj --prepare
shows 0 'surface claim: verified' "$BIN/bound-verify" sweep inwards/r.urdf inwards/path.csv inwards/plates.obj --claims surface

# The whole motion decided from files alone; a set whose margin is cut, one that lacks a body, another path.
V=$BIN/bound-verify
shows 0 'surface claim: verified' "$V" sweep "$R" path.csv a.glb --report v.json
for key in '"relation": "sweep"' '"verdict": "verified"' '"largest_found"' '"configuration"' '"cells"'; do
  grep -q "$key" v.json || fail "no $key in the report"
done
shows 0 'solid claim: verified' "$V" sweep "$R" path.json b.glb
for set in uniform.obj adaptive.obj folder all c.glb d.glb e.glb; do
  shows 0 '^verified: 4 of 4 links judged$' "$V" sweep "$R" path.csv "$set"
done
# Upright and leaning cylinders, whose hulls have corners in a line but for the last bits.
cat >drum.urdf <<'END'
<robot name="drum">
  <link name="base"><collision><geometry><cylinder radius="0.2" length="0.1"/></geometry></collision>
    <collision><origin rpy="0.3 0.2 0.1"/><geometry><cylinder radius="0.1" length="0.5"/></geometry></collision></link>
  <link name="arm"><collision><geometry><cylinder radius="0.1" length="0.3"/></geometry></collision></link>
  <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/><origin xyz="0 0 0.2"/><axis xyz="0 0 1"/></joint>
</robot>
END
printf '0\n1\n' >drum.csv
expect 0 '' "$S" drum.urdf --path drum.csv -o drum.glb
shows 0 '^verified: 2 of 2 links judged$' "$V" sweep drum.urdf drum.csv drum.glb
LC_ALL=C sed 's/"margin":0.0049/"margin":0.0029/' a.glb >thin.glb
cmp -s a.glb thin.glb && fail "the margin was not cut"
shows 1 'surface claim: refuted' "$V" sweep "$R" path.csv thin.glb --witness w.obj --report thin.json
grep -q '^f ' w.obj || fail "no witness"
grep -q '"place"' thin.json || fail "no place in the report"
awk '/^o / { n++ } n != 3 || !/^f / { print }' adaptive.obj >lacking.obj
shows 1 'refuted' "$V" sweep "$R" path.csv lacking.obj
sed 's/1.5/1.6/' path.csv >other.csv
shows 1 'refuted' "$V" sweep "$R" other.csv a.glb
shows 1 'refuted' "$V" sweep "$R" path.csv swept.obj
expect 0 '' "$V" sweep "$R" path.csv swept.obj --links hand
shows 7 'undecided' "$V" sweep "$R" path.csv a.glb --gap 100cm
shows 7 'undecided' "$V" sweep "$R" path.csv a.glb --max-cells 1
expect 3 'none.csv' "$V" sweep "$R" none.csv a.glb
expect 3 'cut.urdf' "$V" sweep cut.urdf path.csv a.glb
expect 3 'none.glb' "$V" sweep "$R" path.csv none.glb
expect 2 '' "$V" sweep "$R" path.csv
expect 2 '' "$V" sweep "$R" path.csv a.glb x.off
expect 2 '' "$V" sweep "$R" path.csv a.glb --epsilon 1
expect 2 '' "$V" sweep "$R" path.csv a.glb --drop-sheets
expect 2 '' "$V" sweep "$R" path.csv a.glb --claims solid
expect 2 'unknown option --input-format' "$V" sweep "$R" path.csv a.glb --input-format stl
expect 2 'unknown option --max-contacts' "$V" sweep "$R" path.csv a.glb --max-contacts 5
expect 2 '' "$V" mesh --outer shapes/t.off shapes/t.off --links hand
expect 2 'nothing' "$V" sweep "$R" path.csv a.glb --links nothing
expect 4 'no-such' "$V" sweep "$R" path.csv a.glb --report no-such/v.json
# Meshes as sweep-approx prepared them: a part that is inside out, a hole, a sheet beside it.
{ printf 'OFF\n7 5 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n5 0 0\n6 0 0\n5 1 0\n'
  printf '3 0 1 2\n3 0 3 1\n3 1 3 2\n3 4 5 6\n3 4 6 5\n'; } >robots/urdf/sheeted.off
sed 's/u\.off/sheeted.off/' "$R" >robots/urdf/sheeted.urdf
H=robots/urdf/sheeted.urdf
expect 0 'A wrap takes the place of the mesh' "$S" $H --path path.csv -o x.glb --body-epsilon 5% --effort fast
shows 0 '^verified' "$V" sweep $H path.csv x.glb
expect 0 'NOT enclosed' "$S" $H --path path.csv -o sheeted.glb --drop-sheets
expect 1 "sheeted.off: .*--prepare --drop-sheets judges that" "$V" sweep $H path.csv sheeted.glb
expect 1 'sheeted.off: judged as it is, .*sheets' "$V" sweep $H path.csv sheeted.glb --prepare
shows 0 '^verified: 4 of 4 links judged; nothing is said of the 2 triangles of sheets dropped from robots/urdf/sheeted.off$' \
  "$V" sweep $H path.csv sheeted.glb --prepare --drop-sheets --report v.json
tr -d ' \n' <v.json | grep -q '"prepared":true,"dropped_sheet_triangles":{"robots/urdf/sheeted.off":2}' || fail "$(cat v.json)"
grep -q 'meshes are not closed' out.txt && fail 'the filled hole is open'
expect 0 'but the 2 of sheets that were dropped on request' "$BIN/bcd-decompose" $H -o sheeted --drop-sheets --epsilon 1%
shows 0 'judged; nothing is said of the 2 triangles of sheets dropped from robots/urdf/sheeted.off$' \
  "$V" robot $H sheeted/sheeted.urdf --prepare --drop-sheets
expect 0 'NOT enclosed' "$BIN/bcd-decompose" robots/urdf/sheeted.off -o cover.glb --drop-sheets --epsilon 1%
shows 0 '^verified; nothing is said of the 2 triangles of sheets dropped from robots/urdf/sheeted.off$' \
  "$V" cover robots/urdf/sheeted.off cover.glb --prepare --drop-sheets
"$V" sweep "$R" path.csv a.glb --quiet >out.txt 2>err.txt || fail "quiet run"
if [ -s out.txt ] || [ -s err.txt ]; then fail '--quiet is not quiet'; fi
for n in 1 2; do
  "$V" sweep "$R" path.csv thin.glb --report "t$n.json" --threads $n >"t$n.txt"
  sed -i '/"resources"/,/}/d' "t$n.json"
done
cmp -s t1.json t2.json || fail "the report differs on two threads"
cmp -s t1.txt t2.txt || fail "the output differs on two threads"
# The dependency file lists what meshes refer to.
inlined 0.1 >robots/part.wrl
printf '#VRML V2.0 utf8\nInline { url "part.wrl" }\n' >robots/whole.wrl
echo '<robot name="w"><link name="l"><visual><geometry><mesh filename="whole.wrl"/></geometry></visual></link></robot>' >robots/w.urdf
printf '[[]]' >rest.json
expect 0 '' "$S" robots/w.urdf --path rest.json -o w.glb --visual --depfile w.d
[ "$(cat w.d)" = 'w.glb: robots/w.urdf rest.json robots/whole.wrl robots/part.wrl' ] || fail "dependency file: $(cat w.d)"
# Where the robot stands.
base=0.5,-1,2,0.1,0.2,0.3
expect 0 'bound-verify sweep needs --base-pose' "$S" $R --path path.csv -o stands.glb --base-pose $base --epsilon 0.01
written=$(sed -n 's/.*--base-pose //p' err.txt)
expect 0 '' "$BIN/bound-verify" sweep $R path.csv stands.glb --base-pose "$written" --prepare
expect 0 '' "$BIN/bound-verify" sweep $R path.csv stands.glb --base-pose $base --prepare
run_tool 1 "$BIN/bound-verify" sweep $R path.csv stands.glb --prepare
run_tool 1 "$BIN/bound-verify" sweep $R path.csv stands.glb --base-pose 0.5,-1,2.1,0.1,0.2,0.3 --prepare
expect 2 '5 numbers; a pose is' "$S" $R --path path.csv -o none.glb --base-pose 1,2,3,4,5
expect 2 'no rotation' "$S" $R --path path.csv -o none.glb --base-pose 0,0,0,1,0,0,0,1,0,0,0,2
expect 2 'which robot' "$S" --path path.csv -o none.glb
# As it stands in a scene, with the scene's limits.
expect 0 '' "$BIN/kaboum-scene" make cell.json --robot r=$R --epsilon 0.01
python3 - <<'END'
import json
cell = json.load(open("cell.json"))
cell["robots"][0]["base"] = {"position": [0.5, -1, 2], "rpy": [0.1, 0.2, 0.3]}
json.dump(cell, open("cell.json", "w"))
cell["robots"][0]["limits"] = {"shoulder": [-1, 1]}
json.dump(cell, open("narrow.json", "w"))
END
expect 0 '' "$S" --scene cell.json --robot r --path path.csv -o scene.glb --epsilon 0.01
cmp -s scene.glb stands.glb || run_tool 0 "$BIN/bound-verify" sweep $R path.csv scene.glb --base-pose $base --prepare
expect 3 'outside its limits' "$S" --scene narrow.json --path path.csv -o none.glb
expect 2 "no robot 'q'" "$S" --scene cell.json --robot q --path path.csv -o none.glb
expect 4 'long' "$S" $R --path path.csv -o none.glb --epsilon 0.01 --report "$(printf '%300s' '' | tr ' ' x)"
absent none.glb
finish
