# outputs.sh TOOLS FOLDER: makes robots that are hard to load, and what the tools write of them. The
# URDFs' names, relative to FOLDER, go to list.txt.
set -eu
BIN=$(cd "$1" && pwd)
rm -rf "$2"
mkdir -p "$2/robots/a" "$2/robots/b" "$2/robots/c d é" "$2/set"
cd "$2"
KABOUM_CACHE=$PWD/cache  # the sweeps' bodies are those of the robots
export KABOUM_CACHE

decompose() { "$BIN/bcd-decompose" --quiet --effort fast "$@"; }
sweep() { "$BIN/sweep-approx" --quiet --effort fast "$@"; }

# A prism over an L: not convex, not symmetric. ell WIDTH HEIGHT
ell() {
  printf 'OFF\n12 20 0\n'
  for z in 0 "$2"; do
    printf '0 0 %s\n%s 0 %s\n%s 0.1 %s\n0.1 0.1 %s\n0.1 0.3 %s\n0 0.3 %s\n' "$z" "$1" "$z" "$1" "$z" "$z" "$z" "$z"
  done
  printf '3 0 3 1\n3 1 3 2\n3 0 5 3\n3 3 5 4\n3 6 7 9\n3 7 8 9\n3 6 9 11\n3 9 10 11\n'
  for i in 0 1 2 3 4 5; do
    j=$(((i + 1) % 6))
    printf '3 %s %s %s\n3 %s %s %s\n' $i $j $((j + 6)) $i $((j + 6)) $((i + 6))
  done
}

# Files of one name in three folders; names that others could become; one letter in another case.
ell 0.4 0.1 >robots/a/part.off
ell 0.5 0.2 >robots/b/part.off
ell 0.6 0.05 >'robots/c d é/part.off'
ell 0.3 0.3 >robots/part-2.off
ell 0.2 0.2 >robots/Part.off
ell 0.2 0.4 >robots/part-0000.off

inertial='<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
cat >robots/hard.urdf <<END
<robot name="hard">
  <link name="base">$inertial
    <visual><geometry><mesh filename="a/drawn.dae"/></geometry></visual>
    <collision><geometry><mesh filename="a/part.off"/></geometry></collision>
    <collision><origin xyz="0.7 0 0.1" rpy="0.1 0.2 0.3"/><geometry><mesh filename="b/part.off"/></geometry></collision>
  </link>
  <link name="arm 1/é">$inertial
    <collision><origin xyz="0 0.1 0" rpy="0 0.5 0"/><geometry><mesh filename="c d é/part.off" scale="0.5 -0.7 2"/></geometry></collision>
    <collision><geometry><box size="0.2 0.3 0.4"/></geometry></collision>
    <collision><geometry><mesh filename="part-2.off"/></geometry></collision>
  </link>
  <link name="arm_1_é">$inertial
    <collision><origin xyz="0 0.1 1" rpy="2 0.5 0"/><geometry><mesh filename="a/part.off" scale="-1 -1 -1"/></geometry></collision>
    <collision name="twin"><geometry><mesh filename="a/part.off" scale="1 1 2"/></geometry></collision>
    <collision name="twin"><geometry><mesh filename="a/part.off" scale="1 1 3"/></geometry></collision>
    <collision><origin xyz="0 0 -0.5" rpy="1 0 0"/><geometry><cylinder radius="0.1" length="0.4"/></geometry></collision>
  </link>
  <link name="hand">$inertial
    <collision><geometry><mesh filename="Part.off"/></geometry></collision>
    <collision><geometry><mesh filename="part-0000.off"/></geometry></collision>
    <collision><geometry><mesh filename="a/part.off"/></geometry></collision>
  </link>
  <link name="finger">$inertial
    <collision><origin xyz="0.1 0.2 0.3" rpy="0 0 0"/><geometry><sphere radius="0.1"/></geometry></collision>
    <collision><geometry><mesh filename="a/part.off" scale="0.001 0.001 0.001"/></geometry></collision>
  </link>
  <link name="frame"/>
  <joint name="first" type="revolute"><parent link="base"/><child link="arm 1/é"/><origin xyz="0 0 1" rpy="0.3 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="second" type="continuous"><parent link="arm 1/é"/><child link="arm_1_é"/><origin xyz="0.2 0 1" rpy="0.3 1 2"/><axis xyz="0 0 1"/></joint>
  <joint name="third" type="fixed"><parent link="arm_1_é"/><child link="hand"/><origin xyz="0.2 0.1 0.3" rpy="0.3 0 0.4"/></joint>
  <joint name="fourth" type="prismatic"><parent link="hand"/><child link="finger"/><origin xyz="0 0 0.2"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.1" effort="1" velocity="1"/></joint>
  <joint name="last" type="fixed"><parent link="finger"/><child link="frame"/><origin xyz="0 0 0.1"/></joint>
</robot>
END
decompose robots/hard.urdf -o hard --epsilon 3% --report hard.json
mv hard.json hard/report.json
echo hard/hard.urdf >list.txt

# A robot made for MuJoCo, where its meshes are elsewhere.
sed '/<robot/a <mujoco><compiler meshdir="nowhere" balanceinertia="true" fusestatic="true"/><size njmax="500"/></mujoco>' \
  robots/hard.urdf >robots/mujoco.urdf
decompose robots/mujoco.urdf -o 'for mujoco' --epsilon 5% --max-vertices-per-body 16
echo 'for mujoco/mujoco.urdf' >>list.txt

decompose robots/hard.urdf -o prefixed --epsilon 5% --mesh-prefix package://cell/prefixed

printf 'first,second,fourth\n0,0,0\n0.3,-0.4,0.1\n' >path.csv
sweep robots/hard.urdf --path path.csv -o swept.urdf --epsilon 0.02 --body-epsilon 5%
echo swept.urdf >>list.txt

for set in parts parts.glb parts.obj; do
  decompose robots/b/part.off -o "set/$set" --epsilon 1%
done

# Real robots, where they are.
if [ -n "${KABOUM_MESHES:-}" ]; then
  mkdir real
  find "$KABOUM_MESHES" -name '*.urdf' | sort | while read -r robot; do
    name=$(basename "$robot" .urdf)
    decompose "$robot" -o "real/$name" --epsilon 5% --drop-sheets --report report.json
    mv report.json "real/$name"
    echo "real/$name/$name.urdf" >>list.txt
  done
  printf '0,0,0,0,0,0\n0.3,-0.2,0.2,0.1,0.2,0.3\n' >six.csv
  find "$KABOUM_MESHES" -name '*.urdf' -o -name '*rlmdl.xml' | sort | while read -r robot; do
    name=$(basename "$robot")
    name=${name%.*}
    sweep "$robot" --path six.csv -o "real/swept $name.urdf" --epsilon 0.01 --body-epsilon 5% --ignore-limits --drop-sheets
    echo "real/swept $name.urdf" >>list.txt
  done
fi
