# shellcheck shell=sh disable=SC2154
. "$(dirname "$0")/common.sh"
D=$BIN/bcd-decompose
KABOUM_CACHE=$WORK/cache
export KABOUM_CACHE

# Shapes of all kinds: one mesh twice with another scale, two on one link, a pose, a box.
mkdir -p robot/meshes
tetrahedron >robot/meshes/t.off
cp "$BRACKET" robot/meshes/bracket.obj
cat >robot/r.urdf <<'END'
<robot name="r">
  <!-- kept: no <rlkin> -->
  <link name="base">
    <visual><geometry><mesh filename="meshes/seen.dae"/></geometry></visual>
    <collision><geometry><mesh filename="meshes/bracket.obj"/></geometry></collision>
  </link>
  <link name="arm/1">
    <collision><origin xyz="0.1 0 0" rpy="0.3 0 0"/><geometry><mesh filename="meshes/t.off" scale="0.2 -0.2 0.5"/></geometry></collision>
    <collision name="tool"><geometry><mesh filename="meshes/t.off" scale="0.2 -0.2 0.5"/></geometry></collision>
    <collision><geometry><box size="0.2 0.2 0.1"/></geometry></collision>
  </link>
  <link name="frame"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="arm/1"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="end" type="fixed"><parent link="arm/1"/><child link="frame"/></joint>
</robot>
END
expect 0 'bodies of 2 links, from 2 meshes' "$D" robot/r.urdf -o out --epsilon 3% --effort fast --report r.json --preview p.png --depfile r.d
mv err.txt err0.txt
for f in out/r.urdf out/links/base.glb out/links/arm_1.glb out/bodies/t/t-0000.stl out/bodies/bracket/bracket-0000.stl p.png; do
  [ -s "$f" ] || fail "no $f"
done
grep -q '^out/r.urdf: .*t.off' r.d || fail "dependency file: $(cat r.d)"
grep -q '"reach_upper"' r.json || fail "report"
# What has nothing to do with collisions stays; names lead to the same files.
grep -q '<!-- kept: no <rlkin> -->' out/r.urdf || fail "comments are lost"
grep -q 'filename="../robot/meshes/seen.dae"' out/r.urdf || fail "the drawing's mesh is not found from the folder"
[ "$(grep -c 'bodies/t/t-0000.stl" scale="0.2 -0.2 0.5"' out/r.urdf)" = 2 ] || fail "scale"
[ "$(grep -c 'box size' out/r.urdf)" = 1 ] || fail "box"
[ "$(grep -c '<collision ' out/r.urdf)" = "$(($(find out/bodies/bracket -name '*.stl' | wc -l) + 3))" ] || fail "number of bodies"
grep -q 'rpy="0.3 0 0"' out/r.urdf || fail "pose"
# The claims hold of the files.
shows 0 'verified' "$BIN/bound-verify" cover robot/meshes/t.off out/bodies/t
shows 0 'verified' "$BIN/bound-verify" cover robot/meshes/bracket.obj out/bodies/bracket
epsilon=$(sed -n 's/.*"epsilon": \([^,]*\).*/\1/p' out/bodies/bracket/*.json)
shows 0 'distance from the union to the solid: verified' "$BIN/bound-verify" cover robot/meshes/bracket.obj \
  out/bodies/bracket --prepare --epsilon "$epsilon"
shows 0 'verified' "$BIN/bound-verify" cover robot/meshes/bracket.obj out/links/base.glb
# In the link's frame the transformed mesh is covered, as far as numbers of 17 digits tell.
awk 'NR < 3 || NR > 6 { print; next } NR == 3 { c = cos(0.3); s = sin(0.3) }
  { x = 0.2 * $1; y = -0.2 * $2; z = 0.5 * $3
    printf "%.17g %.17g %.17g\n", x + 0.1, c * y - s * z, s * y + c * z }' robot/meshes/t.off |
  sed 's/^3 \([0-9]\) \([0-9]\) \([0-9]\)/3 \1 \3 \2/' >posed.off
shows 0 'verified' "$BIN/bound-verify" cover posed.off out/links/arm_1.glb
# Files are told apart by their stems alone; whoever loads the URDF finds them.
[ -z "$(find out -name '*.stl' | sed 's,.*/,,' | sort -f | uniq -di)" ] || fail "two meshes of one name"
grep -q 'out/r.urdf names its meshes relative to itself (bodies/...), .*RViz and MoveIt need --mesh-prefix' err0.txt ||
  fail "how meshes are found"
[ "$(grep -c '<compiler strippath="false"/>' out/r.urdf)" = 1 ] || fail "MuJoCo does not find the meshes"
sed 's,<link name="frame"/>,&<mujoco><compiler meshdir="nowhere" balanceinertia="true"/><option timestep="0.001"/></mujoco>,' \
  robot/r.urdf >robot/m.urdf
expect 0 '' "$D" robot/m.urdf -o merged --epsilon 3% --effort fast
[ "$(grep -c '<mujoco>' merged/m.urdf)" = 1 ] && grep -q 'timestep="0.001"' merged/m.urdf || fail "<mujoco> is not merged"
grep -q '<compiler balanceinertia="true" strippath="false"/>' merged/m.urdf || fail "what is said to MuJoCo: $(grep compiler merged/m.urdf)"
# It finds no package://: shapes for drawing that it should load are left out, and a note says so.
mkdir -p drawn
cp robot/meshes/t.off drawn
cat >drawn/d.urdf <<'END'
<robot name="d"><mujoco><compiler meshdir="m" discardvisual="false"/></mujoco><link name="l">
  <visual><geometry><mesh filename="package://p/seen.stl"/></geometry></visual>
  <collision><geometry><mesh filename="t.off"/></geometry></collision></link></robot>
END
expect 0 'leave out shapes for drawing' "$D" drawn/d.urdf -o drawn/out --effort fast --verbose
grep -q '<compiler discardvisual="true" strippath="false"/>' drawn/out/d.urdf || fail "MuJoCo looks for package://"
sed 's,package://p/seen.stl,t.off,' drawn/d.urdf >drawn/e.urdf
expect 0 '' "$D" drawn/e.urdf -o drawn/out_e --effort fast
grep -q 'discardvisual="false"' drawn/out_e/e.urdf || fail "MuJoCo draws no more"
# A URDF called .xml is one, and becomes NAME.urdf: NAME.xml is its MJCF.
cp drawn/e.urdf drawn/e.xml
expect 0 '' "$D" drawn/e.xml -o drawn/out_x --effort fast --robot-format mjcf
cmp drawn/out_e/e.urdf drawn/out_x/e.urdf || fail "a URDF called .xml"
grep -q '<mujoco' drawn/out_x/e.xml || fail "the MJCF of a URDF called .xml"
shows 0 'verified' "$BIN/bound-verify" robot drawn/e.xml drawn/out_x/e.urdf --prepare
# Thin bodies that rounding moves are enlarged like others: no container leaves a margin to its readers.
mkdir -p thin
awk 'NR > 2 && NR < 7 { $3 = $3 * 1e-5 } { print }' robot/meshes/t.off >thin/plate.off
cat >thin/p.urdf <<'END'
<robot name="p"><link name="l"><collision><origin xyz="0.1 0 0" rpy="0.3 0 0"/><geometry><mesh filename="plate.off"/></geometry></collision></link></robot>
END
expect 0 '' "$D" thin/p.urdf -o thin/out --effort fast
for set in thin/out/links/l.glb out/links/*.glb; do
  LC_ALL=C grep -a -q '"margin":0\.0,' "$set" || fail "$set has a margin"
done
awk 'NR < 3 || NR > 6 { print; next } NR == 3 { c = cos(0.3); s = sin(0.3) }
  { printf "%.17g %.17g %.17g\n", $1 + 0.1, c * $2 - s * $3, s * $2 + c * $3 }' thin/plate.off >thin/posed.off
shows 0 'verified' "$BIN/bound-verify" cover thin/posed.off thin/out/links/l.glb
# All links at once, from the two robots' files.
V=$BIN/bound-verify
shows 0 "link 'arm/1': verified: every triangle is inside: 2 meshes in [0-9]* bod.*; 1 shape is as it was" "$V" robot robot/r.urdf out/r.urdf --prepare --epsilon 3% --report v.json
[ "$(grep -c ': verified' out.txt)" = 3 ] || fail "not all shapes: $(cat out.txt)"
grep -q '"relation": "robot"' v.json || fail "report"
grep -q 'bodies/t/t-0000.stl' v.json || fail "the report does not name what holds the meshes"
shows 0 'every triangle is inside' "$V" robot robot/r.urdf out/r.urdf --claims surface
shows 1 'refuted: bodies: at least' "$V" robot robot/r.urdf out/r.urdf --epsilon 0.01%
# What is no longer there, somewhere else, or moves in another way is noticed.
cp -r out bad
sed 's,bracket-0001.stl,bracket-0000.stl,' out/r.urdf >bad/r.urdf
cmp -s out/r.urdf bad/r.urdf && fail "no second body of the base"
shows 1 "refuted: robot/meshes/bracket.obj: [0-9]* triangles* .* not inside .* by at most" "$V" robot robot/r.urdf bad/r.urdf
sed 's,<collision name="base_1">,<collision name="x"><origin xyz="0 0 1e-9"/>,' out/r.urdf >bad/r.urdf
shows 7 'the 1 shape of other poses' "$V" robot robot/r.urdf bad/r.urdf
sed 's/scale="0.2 -0.2 0.5"/scale="0.2 -0.2 0.4"/' out/r.urdf >bad/r.urdf
shows 7 'no closed mesh of its pose and scale' "$V" robot robot/r.urdf bad/r.urdf
sed 's/box size="0.2 0.2 0.1"/box size="0.2 0.2 0.11"/' out/r.urdf >bad/r.urdf
shows 7 'undecided: box.*the result has none of its size' "$V" robot robot/r.urdf bad/r.urdf
sed 's,<link name="frame">,<link name="frame"><collision><geometry><sphere radius="9"/></geometry></collision>,
  s,<link name="frame"/>,<link name="frame"><collision><geometry><sphere radius="9"/></geometry></collision></link>,' \
  out/r.urdf >bad/r.urdf
shows 0 'verified' "$V" robot robot/r.urdf bad/r.urdf
shows 7 "link 'frame': undecided: how far 1 shape" "$V" robot robot/r.urdf bad/r.urdf --epsilon 3%
# A link that lost its shapes holds nothing, whatever they were; limits are the robot's, too.
sed '/<collision/,/<\/collision>/d' out/r.urdf >bad/r.urdf
shows 1 "refuted: robot/meshes/t.off: the result's link has no.*; nor are 2 other shapes" "$V" robot robot/r.urdf bad/r.urdf
"$V" robot robot/r.urdf bad/r.urdf --quiet --report gone.json
grep -q "the result's link has no shape at all" gone.json || fail "a box that is gone: $(cat gone.json)"
sed 's/upper="2"/upper="2.5"/' out/r.urdf >bad/r.urdf
shows 1 "joints: refuted: joint '[a-z]*' has other limits" "$V" robot robot/r.urdf bad/r.urdf
sed 's/<axis xyz="0 1 0"/<axis xyz="0 0 1"/' out/r.urdf >bad/r.urdf
shows 1 "joints: refuted: joint 'shoulder'" "$V" robot robot/r.urdf bad/r.urdf
sed 's/"frame"/"other"/' out/r.urdf >bad/r.urdf
shows 1 "no link 'frame'" "$V" robot robot/r.urdf bad/r.urdf
sed 's,</robot>,<link name="world"/><joint name="w" type="prismatic"><parent link="world"/><child link="base"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>,' \
  out/r.urdf >bad/r.urdf
shows 1 "root is 'world'" "$V" robot robot/r.urdf bad/r.urdf
sed 's/rpy="0.3 0 0"/quat_xyzw="0 0 0 1"/' out/r.urdf >bad/r.urdf
expect 3 'write the rotation as rpy' "$V" robot robot/r.urdf bad/r.urdf
rm -r bad
expect 2 't.off is a mesh' "$V" robot robot/r.urdf robot/meshes/t.off
expect 2 'RESULT or --spheres FILE or --bodies FILE is needed' "$V" robot robot/r.urdf
expect 2 'unknown option --geometry' "$V" cover robot/meshes/t.off out/bodies/t --geometry visual
# Meshes that are closed only together hold nothing; one that is inside out is not held by anything.
mkdir -p one
cp robot/meshes/t.off one/t.off
for i in 3 4 5 6; do
  awk -v keep="$((i + 4))" 'NR == 2 { $2 = 1 } NR < 7 || NR == keep' robot/meshes/t.off >"one/face$i.off"
done
sed 's/^3 \([0-9]\) \([0-9]\) \([0-9]\)/3 \1 \3 \2/' one/t.off >one/inverse.off
# one_link FILE MESH...
one_link() {
  urdf=$1
  shift
  echo '<robot name="o"><link name="l">' >"$urdf"
  for mesh; do echo "<collision><geometry><mesh filename=\"$mesh\"/></geometry></collision>" >>"$urdf"; done
  echo '</link></robot>' >>"$urdf"
}
one_link one/t.urdf t.off
one_link one/faces.urdf face3.off face4.off face5.off face6.off
one_link one/inverse.urdf inverse.off
one_link one/both.urdf t.off face3.off
one_link one/face.urdf face3.off
shows 0 'verified' "$V" robot one/t.urdf one/t.urdf
shows 7 'no closed mesh' "$V" robot one/t.urdf one/faces.urdf
grep -q 'face3.off and 3 more meshes: it is not closed' err.txt || fail "the open mesh is not named"
shows 1 'one mesh of its pose and scale, which does not hold it' "$V" robot one/face.urdf one/face.urdf
shows 0 'every triangle is inside: 1 mesh in 1 body' "$V" robot one/t.urdf one/both.urdf
shows 0 'as far as open meshes define it' "$V" robot one/face.urdf one/t.urdf
expect 7 'inside out' "$V" robot one/inverse.urdf one/t.urdf --claims solid
expect 2 'report' "$V" robot one/t.urdf one/t.urdf --report one/t.off
cp one/t.off one/more.off
sed '$d' one/t.urdf >one/more.urdf
cat >>one/more.urdf <<'END'
</link><link name="m"><collision><geometry><mesh filename="more.off"/></geometry></collision></link>
<joint name="j" type="fixed"><parent link="l"/><child link="m"/></joint></robot>
END
expect 2 'report' "$V" robot one/t.urdf one/more.urdf --report one/more.off
cmp -s one/more.off one/t.off && cmp -s one/t.off robot/meshes/t.off || fail "a report was written over a mesh"
# Two meshes of one pose are measured together.
sed 's/^\([-0-9.]*\) \([-0-9.]*\) \([-0-9.]*\)$/\1 \2 1\3/; 2s/.*/4 4 0/' one/t.off >one/u.off
one_link one/two.urdf t.off u.off
expect 0 'bodies' "$D" one/two.urdf -o two --epsilon 3% --effort fast
shows 0 'verified' "$V" robot one/two.urdf two/two.urdf --epsilon 3%
# A mesh found twice, with other contents.
mkdir -p old/pack/meshes new/pack/meshes
cp one/t.off old/pack/meshes/t.off
sed '3s/.*/0.4 0 0/' one/t.off >new/pack/meshes/t.off
one_link old/pack/r.urdf package://pack/meshes/t.off
cp old/pack/r.urdf new/pack/r.urdf
expect 3 'is found twice' "$V" robot old/pack/r.urdf new/pack/r.urdf --package-path old
# The new robot is a robot, and another run gives the same bytes.
expect 0 'bodies of 2 links' "$D" out/r.urdf -o again --effort fast
expect 0 '' "$D" robot/r.urdf -o out2 --epsilon 3% --effort fast --quiet --no-cache --mesh-prefix package://r/
[ ! -s err.txt ] || fail "--quiet is not quiet"
sed 's,package://r/,,' out2/r.urdf | cmp -s - out/r.urdf || fail "another URDF"
expect 0 'MuJoCo needs names without' "$D" robot/r.urdf -o slashless --epsilon 3% --effort fast --mesh-prefix package://r
cmp -s out2/r.urdf slashless/r.urdf || fail "a slash after the prefix makes a difference"
cmp -s out/links/arm_1.glb out2/links/arm_1.glb || fail "another container"

# A slash after the folder's name; one that is within no folder.
expect 0 '' "$D" robot/r.urdf -o out3/ --epsilon 3% --effort fast --quiet
diff -r out out3 >diff.txt || fail "a slash after the folder's name makes a difference: $(cat diff.txt)"
rm -r out3
expect 4 'create it first' "$D" robot/r.urdf -o no/out3/

# A folder, not a file, and none that holds other things.
for extension in glb obj STL urdf; do
  expect 2 "such as out3, not out3.$extension" "$D" robot/r.urdf -o "out3.$extension"
done
expect 0 '' "$D" robot/r.urdf -o v1.2 --epsilon 3% --effort fast --quiet
diff -r out v1.2 >diff.txt || fail "the folder's name makes a difference: $(cat diff.txt)"
expect 2 'name a file' "$D" robot/meshes/t.off -o out3/ --output-format glb
mkdir -p out4/bodies/t && echo note >out4/bodies/t/note.txt
expect 4 'note.txt' "$D" robot/r.urdf -o out4 --effort fast
absent out3 out3.glb out3.urdf

# Shapes for drawing; lengths in the robot's unit.
sed 's/seen.dae/t.off/' robot/r.urdf >robot/v.urdf
expect 0 "link 'arm/1' has no visual shape, only collision ones, which stay" "$D" robot/v.urdf -o seen --visual --epsilon 0.05
grep -q 'of 1 link, from 1 mesh$' err.txt || fail "counts: $(cat err.txt)"
grep -q 'bodies/t/t-0000.stl' seen/v.urdf || fail "no bodies for drawing shapes"
grep -q 'box size' seen/v.urdf || fail "a link without a shape for drawing lost its collision shape"
shows 0 'verified' "$V" robot robot/v.urdf seen/v.urdf --geometry visual
grep -q "link 'arm/1': verified: .*1 shape is as it was" out.txt || fail "collision shapes of a link that is not drawn are not judged"
grep -q 'filename="../robot/meshes/t.off"' seen/v.urdf || fail "a mesh that stays is not found from the folder"

sed '3,6s/1/3/' robot/meshes/t.off >robot/meshes/large.off
echo '<robot name="k"><link name="l"><visual><geometry><mesh filename="meshes/t.off"/></geometry></visual>
<collision><geometry><mesh filename="meshes/large.off"/></geometry></collision></link></robot>' >robot/kinds.urdf
expect 0 '' "$D" robot/kinds.urdf -o kinds --visual --epsilon 3% --effort fast
expect 1 'made of a visual mesh of the original: judge them with --visual' "$V" robot robot/kinds.urdf kinds/kinds.urdf --report kinds.json
grep -q '"triangles_outside"' kinds.json || fail "no witness in the report"
shows 0 '^verified: 1 of 1 link judged' "$V" robot robot/kinds.urdf kinds/kinds.urdf --visual

# Files of the same bytes that refer to other files are other meshes.
for side in a b; do
  mkdir -p "wrap/$side"
  printf '#VRML V2.0 utf8\nInline { url "part.wrl" }\n' >"wrap/$side/m.wrl"
done
inlined 1 >wrap/a/part.wrl
inlined 3 >wrap/b/part.wrl
cat >wrap/r.urdf <<'END'
<robot name="r"><link name="l">
  <collision><geometry><mesh filename="a/m.wrl"/></geometry></collision>
  <collision><geometry><mesh filename="b/m.wrl"/></geometry></collision>
</link></robot>
END
# The dependency file lists those as well, whether the cache has the bodies or not.
for run in made cached; do
  expect 0 'from 2 meshes' "$D" wrap/r.urdf -o wrapped --epsilon 5% --effort fast --depfile w.d
  [ "$(cat w.d)" = 'wrapped/r.urdf: wrap/r.urdf wrap/a/m.wrl wrap/a/part.wrl wrap/b/m.wrl wrap/b/part.wrl' ] ||
    fail "dependency file, $run: $(cat w.d)"
done
shows 0 'verified' "$BIN/bound-verify" cover wrap/b/m.wrl wrapped/links/l.glb

# Some links only.
expect 0 'of 1 link, from 1 mesh ' "$D" robot/r.urdf -o some --links arm/1 --epsilon 3% --effort fast
grep -q 'filename="../robot/meshes/bracket.obj"' some/r.urdf || fail "a link that was not asked for is changed"
shows 0 'verified' "$V" robot robot/r.urdf some/r.urdf
expect 0 'from 2 meshes' "$D" robot/r.urdf -o rerun --epsilon 3% --effort fast
grep -q 'not of this result' err.txt && fail "stale files in a new folder"
expect 0 "rerun: 'bodies/bracket' and 'links/base.glb' are not of this result" "$D" robot/r.urdf -o rerun --links arm/1 \
  --epsilon 3% --effort fast --report rerun.json
[ -f rerun/links/base.glb ] || fail "a file is gone that may be somebody's own"
grep -q '"links/base.glb"' rerun.json || fail "no word of what is stale in the report"
expect 2 "no link 'leg'" "$D" robot/r.urdf -o x --links arm/1,leg
expect 2 'for robots' "$D" robot/meshes/t.off -o x --links a

# Files that are not ours stay.
mkdir -p mine && cp out/bodies/t/t-0000.stl mine/part.stl
expect 4 'part.stl' "$D" robot/meshes/t.off -o mine --effort fast
cp mine/part.stl out/bodies/t/part.stl
expect 4 'part.stl' "$D" robot/r.urdf -o out --epsilon 3% --effort fast
[ -s mine/part.stl ] && [ -s out/bodies/t/part.stl ] || fail "a file of the user is gone"
rm out/bodies/t/part.stl
expect 2 'overwrite' "$D" robot/r.urdf -o robot
cp robot/r.urdf robot/s.urdf
expect 4 'out/r.urdf: another robot' "$D" robot/s.urdf -o out --epsilon 3% --effort fast
[ ! -e out/s.urdf ] || fail "two robots in one folder"
mkdir -p theirs && echo '<robot name="theirs"/>' >theirs/r.urdf
expect 4 'theirs/r.urdf: exists' "$D" robot/r.urdf -o theirs
[ "$(ls theirs)" = r.urdf ] && grep -q theirs theirs/r.urdf || fail "a robot of the user is gone"
expect 2 'folder' "$D" robot/r.urdf -o -
expect 2 'one by one' "$D" robot/r.urdf -o x --direction inner
expect 3 'no mesh file for' "$D" robot/r.urdf -o x --visual
sed 's,meshes/t.off,meshes/finger%201.off,' robot/r.urdf >robot/percent.urdf
expect 3 '%20 stands for a blank in URIs, .*name the file with a blank' "$D" robot/percent.urdf -o x
sed 's/<link name="frame"\/>//' robot/r.urdf >robot/bad.urdf
expect 3 'bad.urdf' "$D" robot/bad.urdf -o x
absent x
: >afile
expect 4 '' "$D" robot/r.urdf -o afile --effort fast

# What is there as it was written is left alone, and the robot counts as made now; whatever is not, is written again.
expect 0 '' "$D" robot/r.urdf -o kept --epsilon 3% --effort fast --robot-format sdf --report first.json
cp -r kept first
state() {
  ls -iR kept | grep -v '^total'
}
again() {
  expect 0 '' "$D" robot/r.urdf -o kept --epsilon 3% --effort fast --robot-format sdf --report k.json "$@"
  diff -r first kept >diff.txt || fail "not as it was at first: $(cat diff.txt)"
}
state >before.txt
touch -d '1 hour ago' kept/r.urdf kept/r.sdf
: >reference
again
state | cmp -s before.txt - || fail "files are written again though nothing changed"
for f in kept/r.urdf kept/r.sdf; do
  [ "$f" -ot reference ] && fail "$f does not count as made now"
done
for j in first k; do grep -v '"cached"\|seconds\|megabytes' $j.json >$j.txt; done
grep -q '"stale": \[\]' k.json || fail "a container is said to be of another result"
cmp -s first.txt k.txt || fail "another report: $(diff first.txt k.txt)"
printf 'x' | dd of=kept/bodies/bracket/bracket-0001.stl bs=1 seek=100 conv=notrunc 2>/dev/null
again
rm kept/bodies/t/t-0000.stl
again
cp kept/bodies/t/t-0000.stl kept/bodies/t/t-0001.stl  # whoever reads the folder takes it for a body
again
rm kept/links/base.glb
again
sed 's/base_0/other/' first/r.urdf >kept/r.urdf
again
: >kept/.kaboum-unfinished
again
state >before.txt
again --no-cache
state | cmp -s before.txt - && fail "--no-cache leaves files as they are"
expect 0 '' "$D" robot/r.urdf -o kept --epsilon 3% --effort fast --robot-format sdf --for drake
[ -s kept/bodies/t/t-0000.obj ] || fail "other bodies are not written"
again
# Links whose shapes are points: the robot is made all the same, and they are named.
for shape in '<sphere radius="0"/>' '<box size="0 0 0"/>' '<cylinder radius="0" length="0"/>'; do
  cat >point.urdf <<END
<robot name="z"><link name="a"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
<link name="dot"><collision><geometry>$shape</geometry></collision></link>
<link name="c"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
<joint name="j" type="fixed"><parent link="a"/><child link="dot"/></joint>
<joint name="k" type="revolute"><parent link="a"/><child link="c"/><origin xyz="3 0 0"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>
END
  rm -rf dotted
  expect 0 "link 'dot'.* is a point: it is not covered" "$D" point.urdf -o dotted --srdf --preview dotted.html --html-report links.html
  grep -q 'disable_collisions' dotted/*.srdf || fail "no pairs beside a point"
  grep -q 'dot.*its shapes are points, which no body covers' dotted.html || fail "the page does not name the point's link"
done
finish
