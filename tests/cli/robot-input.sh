# shellcheck shell=sh disable=SC2154
. "$(dirname "$0")/common.sh"
D=$BIN/bcd-decompose
S=$BIN/sweep-approx
V=$BIN/bound-verify
KABOUM_CACHE=$WORK/cache
export KABOUM_CACHE
unset ROS_PACKAGE_PATH AMENT_PREFIX_PATH

# one_link FILE SHAPES: a robot of one link
one_link() {
  echo "<robot name=\"r\"><link name=\"l\">$2</link></robot>" >"$1"
}
# collision GEOMETRY, visual GEOMETRY
collision() { echo "<collision><geometry>$1</geometry></collision>"; }
visual() { echo "<visual><geometry>$1</geometry></visual>"; }
mesh() { echo "<mesh filename=\"$1\"/>"; }

# A package: by its folder's name or by package.xml, given itself or by a folder that holds it.
mkdir -p ros/stack/arm-1.2/meshes plain/arm/meshes prefix/share/arm/meshes else/deep
echo '<package><name> arm </name></package>' >ros/stack/arm-1.2/package.xml
for folder in ros/stack/arm-1.2 plain/arm prefix/share/arm; do tetrahedron >$folder/meshes/t.off; done
one_link else/deep/r.urdf "$(collision "$(mesh package://arm/meshes/t.off)")"
E=else/deep/r.urdf
# shellcheck disable=SC2317
decompose_with() { env "$@" "$D" "$E" -o out --epsilon 5% --effort fast --quiet; }
# shellcheck disable=SC2317
decompose_from() { "$D" "$E" -o out --epsilon 5% --effort fast --quiet --package-path "$@"; }
# shellcheck disable=SC2016
expect 3 'no folder called arm, or with a package.xml of that <name>, is in or is one of --package-path (none), $ROS_PACKAGE_PATH (none)' decompose_with A=B
grep -q "above ($WORK/else/deep, $WORK/else, $WORK" err.txt || fail "the folders tried are not listed: $(cat err.txt)"
for place in ros ros/stack ros/stack/arm-1.2 ros/stack/arm-1.2/ plain plain/arm; do
  expect 0 '' decompose_from $place
  expect 0 '' decompose_with ROS_PACKAGE_PATH="nowhere:$WORK/$place"
done
expect 0 '' decompose_with AMENT_PREFIX_PATH="$WORK/nowhere:$WORK/prefix"
expect 3 "(out), .*(else)" decompose_with ROS_PACKAGE_PATH=out AMENT_PREFIX_PATH=else
shows 0 'verified' "$V" robot $E out/r.urdf --package-path plain/arm
(cd plain/arm && sed 's,t.off,../meshes/t.off,' ../../$E >r.urdf)
expect 0 '' "$D" plain/arm/r.urdf -o out2 --epsilon 5% --effort fast --quiet
sed 's/meshes/parts/' $E >else/deep/lost.urdf
expect 3 'the package is plain/arm, without a file parts/t.off' "$D" else/deep/lost.urdf -o x --package-path plain/arm
sed 's,package://arm/,package://,; s,meshes/t.off,arm,' $E >else/deep/odd.urdf
expect 3 'package://NAME/FILE' "$D" else/deep/odd.urdf -o x
sed 's,package://arm/,package:///arm/,' $E >else/deep/slash.urdf
expect 0 '' "$D" else/deep/slash.urdf -o out3 --epsilon 5% --effort fast --quiet --package-path plain/arm
# A folder that hides packages; one package that is found twice.
: >ros/stack/COLCON_IGNORE
expect 3 'one of --package-path (ros)' decompose_from ros
rm ros/stack/COLCON_IGNORE
sed -i '3s/.*/0.4 0 0/' ros/stack/arm-1.2/meshes/t.off
expect 3 'is found twice' "$V" robot $E out/r.urdf --package-path plain --package-path ros
printf "[[]]" >pose.json
expect 3 'is found twice' "$V" sweep $E pose.json out/bodies --package-path plain --package-path ros

# Shapes without volume: named with their line, kept, covered.
cat >flat.urdf <<END
<robot name="r">
  <link name="base">
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
    <collision><origin xyz="0 0 1"/><geometry>
      <cylinder length="0" radius="0.2"/>
    </geometry></collision>
  </link>
  <link name="arm">
    <collision><geometry><box size="0.1 0 0.2"/></geometry></collision>
    <collision><geometry><cylinder length="0.3" radius="0"/></geometry></collision>
    <collision><geometry><sphere radius="0"/></geometry></collision>
  </link>
  <link name="seen">$(visual '<box size="1 1 1"/>')</link>
  <link name="tool"/>
  <joint name="j" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="k" type="prismatic"><parent link="arm"/><child link="tool"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint>
  <joint name="f" type="fixed"><parent link="arm"/><child link="seen"/></joint>
</robot>
END
expect 0 "flat.urdf:5: link 'base': a cylinder of length 0 has no volume" "$D" flat.urdf -o flat --epsilon 5%
grep -q "flat.urdf:9: link 'arm': a box with 1 of 3 sides 0" err.txt || fail "no box: $(cat err.txt)"
grep -q "flat.urdf:10: link 'arm': a cylinder of radius 0" err.txt || fail "no line: $(cat err.txt)"
grep -q "flat.urdf:11: link 'arm': a sphere of radius 0 is a point: it is not covered" err.txt || fail "no point: $(cat err.txt)"
grep -q "link 'seen' has no collision shape, only visual ones" err.txt || fail "no bare link: $(cat err.txt)"
grep -q "'tool'" err.txt && fail "a link without any shape is named"
grep -q 'cylinder length="0" radius="0.2"' flat/flat.urdf || fail "the disc is gone"
shows 0 "link 'base': verified: .*2 shapes are as they were" "$V" robot flat.urdf flat/flat.urdf --report v.json
grep -q "^verified: 2 of 4 links judged; not 'seen'" out.txt || fail "verdict: $(cat out.txt)"
grep -q "link 'seen' has no collision shape, only visual ones: nothing of this is judged" err.txt || fail "$(cat err.txt)"
grep -q "link 'tool' has no collision shape: nothing" err.txt || fail "$(cat err.txt)"
tr -d ' \n' <v.json | grep -q '"links_without_shapes":\["tool","seen"\],"links_with_other_shapes_only":\["seen"\]' || fail "$(cat v.json)"
shows 0 "2 of 4 links judged; not 'seen'" "$V" robot flat.urdf flat/flat.urdf --epsilon 1%
printf '0\n1\n' >turn.csv
expect 0 "cylinder of length 0" "$S" flat.urdf --path turn.csv --joint k=0 -o flat.glb
shows 0 "^verified: 2 of 4 links judged; not 'seen'" "$V" sweep flat.urdf turn.csv flat.glb --joint k=0 --report v.json
grep -q "flat.urdf:11: .* a point" err.txt || fail "the point is not named: $(cat err.txt)"
tr -d ' \n' <v.json | grep -q '"links":{"asked":4,"judged":2,"without_shapes":\["tool","seen"\]' || fail "$(cat v.json)"
shows 0 "2 of 2 links judged" "$V" sweep flat.urdf turn.csv flat.glb --joint k=0 --links base,arm
sed 's/length="0"/length="-1"/' flat.urdf >negative.urdf
expect 3 "negative.urdf:5: link 'base': a cylinder whose size is negative" "$D" negative.urdf -o x
sed 's/radius="0.2"/radius="wide"/' flat.urdf >word.urdf
expect 3 "word.urdf:5: <cylinder>: " "$D" word.urdf -o x

# xacro that is not expanded.
sed 's,<link name="tool"/>,&\n<xacro:include filename="more.xacro"/>,' flat.urdf >include.urdf
expect 3 'include.urdf:15: <xacro:include> is xacro that is not expanded; run: xacro include.urdf' "$D" include.urdf -o x
# shellcheck disable=SC2016
sed 's,radius="0.2",radius="${r}",' flat.urdf >value.urdf
expect 3 'value.urdf:5: radius=' "$S" value.urdf --path turn.csv -o x.glb
absent x x.glb

# Paths: times, quotation marks, separators at the end, joints that stay where they are.
printf 'j,k\n0,0.5\n1,0.5\n' >plain.csv
expect 0 '' "$S" flat.urdf --path plain.csv -o a.obj
printf 'time,"j","k",\n0,0,0.5,\n1.5,1,0.5,\n' >timed.csv
expect 0 "the column 'time' is passed over" "$S" flat.urdf --path timed.csv -o b.obj
cmp -s a.obj b.obj || fail "a column of times makes a difference"
printf '{"joints": ["j"], "waypoints": [[0], [1]]}' >j.json
# Times may stay, but not go back.
printf 'j,time,k\n0,0,0.5\n# a pause\n0,0,0.5\n1,2.5,0.5\n' >pause.csv
expect 0 '' "$S" flat.urdf --path pause.csv -o pause.obj
printf 'j,time,k\n0,0,0.5\n# a pause\n0,2,0.5\n1,1.5,0.5\n' >back.csv
expect 3 'back.csv: line 5, column 2: time 1.5 is before 2 ' "$S" flat.urdf --path back.csv -o x.glb
expect 3 'back.csv: line 5, column 2: time 1.5 is before 2 ' "$V" sweep flat.urdf back.csv pause.obj
printf '{"joints": ["t", "j", "k"], "waypoints": [[1, 0, 0.5], [0, 1, 0.5]]}' >back.json
expect 3 'back.json: waypoint 2, column 1: t 0 is before 1 ' "$S" flat.urdf --path back.json -o x.glb
# Degrees: converted where asked for, warned about where likely.
printf 'j,k\n0,0.5\n90,0.5\n' >degrees.csv
expect 0 "^WARNING: degrees.csv: line 3, waypoint 2: joint 'j' at 90 radians .* give --degrees" "$S" flat.urdf --path degrees.csv -o wound.obj --ignore-limits
expect 0 "^WARNING: degrees.csv: line 3" "$V" sweep flat.urdf degrees.csv wound.obj
printf 'j,k\n0,0.5\n1.5707963267948966,0.5\n' >radians.csv
expect 0 '' "$S" flat.urdf --path radians.csv -o radians.obj
expect 0 '' "$S" flat.urdf --path degrees.csv -o degrees.obj --degrees
grep -q WARNING err.txt && fail "a warning about degrees that are given as such"
for set in radians degrees; do grep -v '^#' $set.obj >$set.txt; done
cmp -s radians.txt degrees.txt || fail "90 degrees are not a quarter turn"
shows 0 '^verified' "$V" sweep flat.urdf degrees.csv degrees.obj --degrees
shows 1 '^refuted' "$V" sweep flat.urdf degrees.csv degrees.obj
expect 3 "outside its limits, -2 to 2 (radians.*--degrees" "$S" flat.urdf --path degrees.csv -o x.glb

expect 0 '' "$S" flat.urdf --path j.json -o c.obj --joint k=0.5
for set in a c; do grep -v '^#' $set.obj >$set.txt; done
cmp -s a.txt c.txt || fail "a joint that does not move makes a difference"
expect 3 "no column for joint 'k'; .*--joint k=0" "$S" flat.urdf --path j.json -o x.glb
expect 3 "joint 'k' at 3 is outside" "$S" flat.urdf --path j.json -o x.glb --joint k=3
expect 2 'has a column and a value' "$S" flat.urdf --path plain.csv -o x.glb --joint k=3
expect 2 "no joint 'q'" "$S" flat.urdf --path plain.csv -o x.glb --joint q=3
for joint in k= k =1 k=x k=nan; do expect 2 'NAME=NUMBER' "$S" flat.urdf --path j.json -o x.glb --joint $joint; done
expect 2 "gives 'k' twice" "$S" flat.urdf --path j.json -o x.glb --joint k=1 --joint k=2
expect 2 'there is no diagonal' "$S" flat.urdf --path plain.csv -o x.glb --epsilon 1%
absent x.glb
# JSON that is cut or wrong.
printf '{"joints": ["j"],\n "waypoints": [[0], [1' >cut.json
expect 3 'cut.json: the JSON is cut short: it ends at line 2, column' "$S" flat.urdf --path cut.json -o x.glb --joint k=0.5
printf '{"joints": ["j"],\n "waypoints": [[0], [1,]]}' >comma.json
expect 3 "comma.json: not JSON at line 2, column 24, near '.*\[1,\]" "$S" flat.urdf --path comma.json -o x.glb --joint k=0.5
printf '{"joints": ["j"],\n "waypoints": [[0]],\n "waypoints": [[0], [1]]}' >twice.json
expect 3 "twice.json: line 3, column 2: 'waypoints' is given twice; mend the path there" "$S" flat.urdf --path twice.json -o x.glb --joint k=0.5
"$S" flat.urdf --path plain.csv -o recorded --quiet
printf '{\n"unit": m}' >recorded/convex-set.json
expect 3 'recorded/convex-set.json: not JSON at line 2, column 9.*; write the set again' "$V" sweep flat.urdf plain.csv recorded
printf '{"asset": {"version": "2.0"}\n, "meshes": [' >cut.gltf
expect 3 'cut.gltf: the JSON is cut short: it ends at line 2, column 13; .*get or export it again' "$D" cut.gltf -o x.glb --epsilon 1%
printf '{"unit": "mm",\n"unit": "m"}' >recorded/convex-set.json
expect 3 "recorded/convex-set.json: line 2, column 1: 'unit' is given twice; write the set again" "$V" sweep flat.urdf plain.csv recorded
# Names that are misspelt.
cat >named.urdf <<END
<robot name="r">
  <link name="base">$(collision '<box size="1 1 1"/>')</link>
  <link name="upper-arm">$(collision '<box size="1 1 1"/>')</link>
  <link name="hand">$(collision '<box size="1 1 1"/>')</link>
  <joint name="elbow" type="continuous"><parent link="base"/><child link="upper-arm"/></joint>
  <joint name="grip" type="continuous"><parent link="upper-arm"/><child link="hand"/></joint>
</robot>
END
printf '[[0, 0]]' >names.json
expect 2 "no joint 'gripp' .*did you mean 'grip'?" "$S" named.urdf --path j.json -o x.glb --joint gripp=3
printf 'Elbow,grip\n0,0\n' >names.csv
expect 3 "no joint 'Elbow' .*did you mean 'elbow'?" "$S" named.urdf --path names.csv -o x.glb
expect 2 "no link 'uper-arm'; did you mean 'upper-arm'?" "$D" named.urdf -o x --links uper-arm,hand
expect 2 "no link 'uper-arm'; did you mean 'upper-arm'?" "$S" named.urdf --path names.json -o x.glb --links uper-arm
expect 2 "no link 'uper-arm'; did you mean 'upper-arm'?" "$V" sweep named.urdf names.json a.obj --links uper-arm
expect 2 "no link 'wheel'; it has 'base', 'upper-arm' and 'hand'" "$D" named.urdf -o x --links wheel
# What sweep-approx writes as a URDF is read as a set.
expect 0 '' "$S" flat.urdf --path plain.csv -o swept.urdf
shows 0 '^verified' "$V" sweep flat.urdf timed.csv swept.urdf
sed 's/<mesh /<mesh scale="1 1 1.5" /' swept.urdf >scaled.urdf
expect 3 'moved or scaled' "$V" sweep flat.urdf timed.csv scaled.urdf
expect 3 'several links' "$V" sweep flat.urdf timed.csv flat.urdf
# Shapes for drawing.
expect 0 "no visual shape, only collision ones" "$S" flat.urdf --path plain.csv -o seen.glb --visual
shows 0 '1 of 4 links judged' "$V" sweep flat.urdf plain.csv seen.glb --visual
# A robot is what is in its file, whatever the file is called; the result's name says it.
mkdir -p kinds
cat >kinds/a.urdf <<'END'
<robot name="r"><link name="l"><collision><geometry><box size="1 1 1"/></geometry></collision></link></robot>
END
cat >kinds/b.sdf <<'END'
<sdf version="1.9"><model name="m"><link name="l"><collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision></link></model></sdf>
END
cat >kinds/c.xml <<'END'
<mujoco model="m"><worldbody><body name="l"><geom type="box" size="1 1 1"/></body></worldbody></mujoco>
END
cp kinds/a.urdf kinds/d.xml
cp kinds/a.urdf kinds/e.sdf
cp kinds/b.sdf kinds/f.urdf
cp kinds/b.sdf kinds/g.xml
cp kinds/c.xml kinds/h.urdf
for case in a.urdf:a.urdf b.sdf:b.sdf c.xml:c.xml d.xml:d.urdf e.sdf:e.urdf f.urdf:f.sdf g.xml:g.sdf h.urdf:h.xml; do
  from=${case%:*} to=${case#*:}
  out=kind-${from%.*}
  expect 0 "$out/$to" "$BIN/bcd-decompose" "kinds/$from" -o "$out" --epsilon 2%
  [ -s "$out/$to" ] || fail "$from: $(ls "$out")"
  shows 0 '^verified' "$BIN/bound-verify" robot "kinds/$from" "$out/$to"
done
expect 0 '' "$BIN/bcd-decompose" kinds/d.xml -o kind-both --epsilon 2% --robot-format mjcf
[ -s kind-both/d.urdf ] && [ -s kind-both/d.xml ] || fail "both: $(ls kind-both)"

# A joint begins at a link `world` that the file does not have: what is written has it.
{
  echo '<robot name="r"><link name="a"><collision><geometry><mesh filename="t.off"/></geometry></collision></link>'
  echo '<joint name="j" type="fixed"><parent link="world"/><child link="a"/></joint></robot>'
} >implied.urdf
tetrahedron >t.off
for program in bcd-decompose bmesh-decimate; do
  expect 0 "joint 'j' begins at link 'world'" "$BIN/$program" implied.urdf -o "implied-$program" --epsilon 2% --verbose
  grep -q '<link name="world"/>' "implied-$program/implied.urdf" || fail "$program: world is not stated"
  shows 0 '^verified' "$BIN/bound-verify" robot implied.urdf "implied-$program/implied.urdf"
done

finish
