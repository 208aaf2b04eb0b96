# outputs.sh TOOLS FOLDER: makes robots that are hard to load, and what the tools write of them. The
# URDFs' names, relative to FOLDER, go to list.txt.
set -eu
BIN=$(cd "$1" && pwd)
rm -rf "$2"
mkdir -p "$2/formats" "$2/robots/a" "$2/robots/b" "$2/robots/c d é" "$2/set"
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

# Other formats than URDF: inertials that are turned, joints that mimic, that can take one value only, of a link's
# name; names that SDF keeps for itself; a link that a joint moves and that has neither mass nor shape.
cat >robots/moving.urdf <<'END'
<robot name="moving">
  <link name="base"><collision><geometry><mesh filename="a/part.off"/></geometry></collision></link>
  <link name="arm"><inertial><origin xyz="0.1 0.2 0.3" rpy="0.4 0.5 0.6"/><mass value="2.5"/>
      <inertia ixx="0.3" iyy="0.4" izz="0.5" ixy="0.01" ixz="0.02" iyz="-0.03"/></inertial>
    <collision><origin xyz="0 0.1 0" rpy="0 0.5 0"/><geometry><mesh filename="b/part.off" scale="0.5 -0.7 2"/></geometry></collision>
    <collision><origin xyz="1 0 0" rpy="1 2 3"/><geometry><mesh filename="b/part.off"/></geometry></collision>
    <collision><geometry><box size="0.2 0.3 0.4"/></geometry></collision></link>
  <link name="left"><collision><geometry><cylinder radius="0.1" length="0.4"/></geometry></collision></link>
  <link name="right"><inertial><mass value="0"/><inertia ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="locked"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="3" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin rpy="0.1 0.2 0.3"/><geometry><mesh filename="Part.off"/></geometry></collision></link>
  <link name="__flange__"/>
  <link name="tool::tip"/>
  <joint name="arm" type="revolute"><parent link="base"/><child link="arm"/><origin xyz="0 0.1 1" rpy="0.3 0.2 0.1"/><axis xyz="1 2 3"/>
    <limit lower="-2" upper="1.5" effort="12" velocity="3"/><dynamics damping="0.7" friction="0.2"/></joint>
  <joint name="grip" type="prismatic"><parent link="arm"/><child link="left"/><origin xyz="0.5 0 0.1" rpy="0 0 1"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.1" effort="1" velocity="1"/></joint>
  <joint name="follow" type="prismatic"><parent link="arm"/><child link="right"/><origin xyz="0.5 0 -0.1" rpy="0 1 0"/><axis xyz="0 -1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="grip" multiplier="-2" offset="0.03"/></joint>
  <joint name="stuck" type="revolute"><parent link="arm"/><child link="locked"/><origin xyz="0 0 0.4" rpy="0.2 0 0"/><axis xyz="0 0 1"/>
    <limit lower="0.3" upper="0.3" effort="1" velocity="1"/></joint>
  <joint name="wheel" type="continuous"><parent link="locked"/><child link="__flange__"/><origin xyz="0 0 0.2"/><axis xyz="1 0 0"/></joint>
  <joint name="end" type="fixed"><parent link="__flange__"/><child link="tool::tip"/><origin xyz="0 0 0.1" rpy="0 0 2"/></joint>
</robot>
END
sed 's/"base"/"world"/' robots/moving.urdf >robots/world.urdf
sed 's,<collision><geometry><mesh filename="a/part.off"/></geometry></collision></link>,</link>,' robots/world.urdf >robots/bare.urdf
for robot in hard moving world bare; do
  decompose "robots/$robot.urdf" -o "formats/$robot" --epsilon 5% --robot-format mjcf,sdf \
    --mesh-prefix "package://cell/formats/$robot"
  echo "formats/$robot/$robot.urdf" >>formats.txt
done
"$BIN/bmesh-decimate" --quiet robots/hard.urdf -o formats/round --epsilon 5% --effort fast --robot-format mjcf,sdf
echo formats/round/hard.urdf >>formats.txt

for set in parts parts.glb parts.obj; do
  decompose robots/b/part.off -o "set/$set" --epsilon 1%
done

# Real robots, where they are.
if [ -n "${KABOUM_MESHES:-}" ]; then
  mkdir -p real
  find "$KABOUM_MESHES" -name '*.urdf' | sort | while read -r robot; do
    name=$(basename "$robot" .urdf)
    decompose "$robot" -o "real/$name" --epsilon 5% --drop-sheets --robot-format mjcf,sdf --report report.json
    mv report.json "real/$name"
    echo "real/$name/$name.urdf" | tee -a formats.txt >>list.txt
  done
  printf '0,0,0,0,0,0\n0.3,-0.2,0.2,0.1,0.2,0.3\n' >six.csv
  find "$KABOUM_MESHES" -name '*.urdf' -o -name '*rlmdl.xml' | sort | while read -r robot; do
    name=$(basename "$robot")
    name=${name%.*}
    sweep "$robot" --path six.csv -o "real/swept $name.urdf" --epsilon 0.01 --body-epsilon 5% --ignore-limits --drop-sheets
    echo "real/swept $name.urdf" >>list.txt
  done
fi
