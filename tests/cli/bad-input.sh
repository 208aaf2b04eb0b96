. "$(dirname "$0")/common.sh"
D=$BIN/bmesh-decimate

expect 3 'cannot' "$D" missing.off -o x.off --vertices 4
: >empty.off
: >empty.stl
: >empty.ply
: >empty.obj
for f in empty.off empty.stl empty.ply empty.obj; do expect 3 '' "$D" $f -o x.off --vertices 4; done
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n' >truncated.off
expect 3 '' "$D" truncated.off -o x.off --vertices 4
printf 'OFF\n0 0 0\n' >zero.off
expect 3 '' "$D" zero.off -o x.off --vertices 4
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\nnan 1 0\n3 0 1 2\n' >nan.off
expect 3 'finite' "$D" nan.off -o x.off --vertices 4
printf 'v 0 0 0\nv 1 0 0\nv 0 inf 0\nf 1 2 3\n' >inf.obj
expect 3 'finite' "$D" inf.obj -o x.off --vertices 4
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n' >index.off
expect 3 '' "$D" index.off -o x.off --vertices 4
printf 'OFF\n2147483648 2147483648 0\n0 0 0\n' >huge.off
expect 3 '' "$D" huge.off -o x.off --vertices 4
{ head -c 80 /dev/zero; printf '\377\377\377\177'; head -c 100 /dev/zero; } >huge.stl
expect 3 '' "$D" huge.stl -o x.off --vertices 4
printf 'ply\nformat binary_little_endian 1.0\nelement vertex 4294967295\nproperty float x\nproperty float y\nproperty float z\nelement face 4294967295\nproperty list uchar int vertex_indices\nend_header\nabcdefgh' >huge.ply
expect 3 '' "$D" huge.ply -o x.off --vertices 4
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n' >flat.off
expect 3 'lie in one plane' "$D" flat.off -o x.off --vertices 4 --keep-orientation
printf 'OFF\n3 2 0\n0 0 0\n1 0 0\n2 0 0\n3 0 0 1\n3 1 1 1\n' >degenerate.off
expect 3 '' "$D" degenerate.off -o x.off --vertices 4
printf 'OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 1\n' >sheet.off
expect 3 'drop-sheets' "$D" sheet.off -o x.off --vertices 4 --prepare strict
expect 3 '' "$D" sheet.off -o x.off --vertices 4 --drop-sheets
tetrahedron | sed '$d' | sed 's/^4 4 0/4 3 0/' >open.off
expect 3 'holes fill' "$D" open.off -o x.off --vertices 4 --require-closed
expect 3 'holes fill' "$D" open.off -o x.off --vertices 4 --holes refuse
expect 3 'holes fill' "$BIN/bcd-decompose" open.off -o x.obj --holes refuse --no-cache
expect 2 '' "$D" open.off -o x.off --vertices 4 --require-closed --holes keep
expect 2 'fill or refuse' "$BIN/bcd-decompose" open.off -o x.obj --holes keep --no-cache
# Möbius strip of five quads.
awk 'BEGIN { n = 5; print "OFF"; print 2 * n, 2 * n, 0; pi = atan2(0, -1)
  for (i = 0; i < n; i++) for (s = -1; s <= 1; s += 2) { u = 2 * pi * i / n; r = 1 + 0.3 * s * cos(u / 2)
    printf "%.9g %.9g %.9g\n", r * cos(u), r * sin(u), 0.3 * s * sin(u / 2) }
  for (i = 0; i < n; i++) { a = 2 * i; b = a + 1; c = a + 2; d = a + 3
    if (i == n - 1) { c = 1; d = 0 }
    print 3, a, c, b; print 3, b, c, d } }' >moebius.off
expect 3 'one-sided' "$D" moebius.off -o x.off --vertices 4 --prepare strict
absent x.off

# Folders that cannot be looked into (here: names too long) are no internal errors; nor is /proc.
tetrahedron >t.off
long=$(printf '%300s' '' | tr ' ' x)
for tool in bmesh-decimate bcd-decompose; do
  for name in "$long.off" "$long/x.off" "$long/$long/x.glb"; do
    case $tool$name in bcd*.off) name=${name%off}glb ;; esac
    expect 4 'too long' "$BIN/$tool" t.off -o "$name" --epsilon 5%
  done
  expect 4 'too long' "$BIN/$tool" t.off -o x.obj --epsilon 5% --report "$long/r.json"
  expect 3 'too long' "$BIN/$tool" "$long.off" -o x.obj --epsilon 5%
done
expect 4 "no file can be created in '/proc'" "$D" t.off -o /proc/y.off --epsilon 5%
expect 3 'too long' "$BIN/hausdorff-eval" t.off "$long.off"
expect 3 'too long' "$BIN/bound-verify" cover t.off "$long.glb"
expect 3 'no such file or folder' "$BIN/bound-verify" cover t.off "$long"
# What is no mesh is answered with a way to one.
for f in part.step part.STP part.iges robot.urdf.xacro empty.xml; do : >$f; done
for f in part.step part.STP part.iges; do expect 3 "$f: the file is empty" "$D" $f -o x.off --epsilon 1%; done
: >part.brep
expect 3 'export it as STEP' "$D" part.brep -o x.off --epsilon 1%
echo '<robot name="r"><link name="l"/></robot>' >robot.urdf
echo '<!-- c --><sdf version="1.9"/>' >world.sdf
cp world.sdf world.xml
echo '<mujoco/>' >arm.xml
echo '<rlkin><kinematics/></rlkin>' >rl.xml
echo '<rlsg><scene href="a.wrl"/></rlsg>' >scene.xml
echo '<robot name="r"><group name="g"><link name="l"/></group></robot>' >robot.srdf
echo '<package/>' >package.xml
cp robot.urdf urdf.xml
expect 2 'need a folder' "$D" robot.urdf -o x.off --epsilon 1%
expect 2 'need a folder' "$D" urdf.xml -o x.off --epsilon 1%
expect 3 'bcd-decompose urdf.xml -o FOLDER' "$BIN/hausdorff-eval" urdf.xml t.off
expect 3 'xacro robot.urdf.xacro > robot.urdf' env PATH=/nowhere "$BIN/bcd-decompose" robot.urdf.xacro -o x
for tool in "$D" "$BIN/bcd-decompose"; do
  for f in world.sdf world.xml arm.xml; do expect 2 'need a folder' "$tool" $f -o x.obj --epsilon 1%; done
  expect 3 'world.sdf:1: <sdf>: no <model>' "$tool" world.sdf -o x --epsilon 1%
  expect 3 'arm.xml: no link has a ' "$tool" arm.xml -o x --epsilon 1%
  expect 3 'rl.xml: a robot of the Robotics Library.*sweep-approx' "$tool" rl.xml -o x.obj --epsilon 1%
  expect 3 'scene.xml: a scene of the Robotics Library.*href' "$tool" scene.xml -o x.obj --epsilon 1%
  expect 3 'robot.srdf: SRDF .*give the URDF' "$tool" robot.srdf -o x.obj --epsilon 1%
  expect 3 'package.xml: XML with the root <package>; neither a robot nor a mesh' "$tool" package.xml -o x.obj --epsilon 1%
  expect 3 'empty.xml: neither a mesh nor a robot: no XML: it is empty' "$tool" empty.xml -o x.obj --epsilon 1%
  expect 3 'none.xml: no such file' "$tool" none.xml -o x.obj --epsilon 1%
done
# Robots are known by what they are, and what is none is called what it is.
cp t.off off.urdf
expect 3 "off.urdf: no robot, but no XML: it begins with 'OFF" "$BIN/bcd-decompose" off.urdf -o x
cp package.xml package.urdf
expect 3 'package.urdf: no robot, but XML with the root <package>' "$BIN/bcd-decompose" package.urdf -o x
for f in robot.srdf scene.xml package.xml; do
  mkdir -p kinds
  cp $f kinds/$f.urdf
  expect 3 "give the \(robot as \)\?\(URDF\|rlkin\)" "$BIN/bcd-decompose" kinds/$f.urdf -o x
  expect 3 "$f: .*give the \(robot as \)\?\(URDF\|rlkin\)" "$BIN/sweep-approx" $f --path t.off -o x.glb
done
# What cannot be written is noticed before the work: nothing is written.
mkdir folder
expect 4 'report: folder is a folder' "$BIN/bcd-decompose" t.off -o x.glb --report folder
absent x.off x.obj x.glb x

# Values left out, as by variables of the shell that are not set; help is of the command that was given.
expect 2 'report is empty: give it a value' "$D" t.off -o x.off --vertices 4 --report ''
expect 2 'o.* is empty' "$D" t.off -o '' --vertices 4
expect 2 'A is empty' "$BIN/hausdorff-eval" '' t.off
expect 2 'see kaboum-scene make --help' "$BIN/kaboum-scene" make --foo
expect 2 'see bound-verify mesh --help' "$BIN/bound-verify" mesh --foo
: >empty.urdf
expect 3 'empty.urdf: the file is empty' "$BIN/bcd-decompose" empty.urdf -o x
printf 'j1\001\n0\n' >binary.csv
echo '<robot name="r"><link name="l"/></robot>' >r.urdf
expect 3 'binary.csv: not a text file; a path is CSV or JSON' "$BIN/sweep-approx" r.urdf --path binary.csv -o x.glb
absent x.off x x.glb

# A file cut at many places gives an error or, when only trailing bytes are missing, a result.
"$D" "$BRACKET" -o whole.stl --vertices 60 --quiet
for f in whole.stl; do
  size=$(wc -c <"$f")
  for n in 0 1 79 80 83 84 100 133 134 $((size / 2)) $((size - 1)); do
    head -c "$n" "$f" >cut.stl
    expect 3 '' "$D" cut.stl -o x.off --vertices 4
  done
done
absent x.off
finish
