# shellcheck shell=sh disable=SC2154
# Robots that we write are robots to check_urdf, by which ROS judges them.
command -v check_urdf >/dev/null || { echo "SKIPPED: no check_urdf on this machine (liburdfdom-tools)"; exit 77; }
. "$(dirname "$0")/common.sh"
KABOUM_CACHE=$WORK/cache
export KABOUM_CACHE

mkdir -p robot/meshes
cp "$BRACKET" robot/meshes/bracket.obj
cat >robot/arm.urdf <<'END'
<robot name="arm">
  <link name="base"><visual><geometry><mesh filename="meshes/bracket.obj"/></geometry></visual></link>
  <link name="tip"><visual><origin xyz="0.1 0 0" rpy="0.3 0 0"/><geometry><mesh filename="meshes/bracket.obj" scale="0.5 -0.5 0.5"/></geometry></visual>
    <collision><geometry><cylinder radius="0.1" length="0.2"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="tip"/><origin xyz="0 0 0.5"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
</robot>
END

# judge NAME: the robot of the folder has the links and joints of the original.
judge() {
  check_urdf robot/arm.urdf >original.txt 2>&1 || fail "check_urdf refuses the original: $(cat original.txt)"
  check_urdf "$1/arm.urdf" >judged.txt 2>&1 || fail "check_urdf refuses $1: $(cat judged.txt)"
  diff original.txt judged.txt >diff.txt || fail "another robot in $1: $(cat diff.txt)"
}
for format in stl obj; do
  expect 0 '' "$BIN/bmesh-decimate" robot/arm.urdf -o "round-$format" --visual --epsilon 3% --effort fast --output-format $format
  judge "round-$format"
done
for preset in moveit gazebo drake; do
  expect 0 '' "$BIN/bcd-decompose" robot/arm.urdf -o "bodies-$preset" --visual --epsilon 3% --effort fast --for $preset
  judge "bodies-$preset"
done
finish
