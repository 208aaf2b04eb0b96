# shellcheck shell=sh disable=SC2154,SC2016
# Robots as xacro: expanded by the program of that name, here one that stands for it; what goes wrong is said.
. "$(dirname "$0")/common.sh"
D=$BIN/bcd-decompose
KABOUM_CACHE=$WORK/cache
export KABOUM_CACHE
mkdir -p robot/meshes bin none
tetrahedron >robot/meshes/t.off
cat >robot/arm.urdf.xacro <<'END'
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="reach" value="0.5"/>
  <link name="base"><collision><geometry><mesh filename="meshes/t.off"/></geometry></collision></link>
  <link name="tool"><collision><geometry><mesh filename="meshes/t.off" scale="${reach} 1 1"/></geometry></collision></link>
  <joint name="j" type="revolute"><parent link="base"/><child link="tool"/><axis xyz="0 0 1"/>
    <origin xyz="0 0 ${reach}"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>
END
expanded() { sed '/xacro:property/d; s/ xmlns:xacro="[^"]*"//; s/${reach}/0.5/' "$1"; }
expanded robot/arm.urdf.xacro >robot/arm.urdf
# xacro BODY: a program of this name.
xacro() {
  printf '#!/bin/sh\n%s\n' "$1" >bin/xacro
  chmod +x bin/xacro
}
with_xacro() { PATH="$WORK/bin:$PATH" "$@"; }
xacro '[ "$1" != --deps ] || { printf "%s/part.xacro" "$(dirname "$2")"; exit; }; sed '\''/xacro:property/d; s/ xmlns:xacro="[^"]*"//; s/${reach}/0.5/'\'' "$1"; echo note >&2'

: >robot/part.xacro
# The same as of the URDF; names of meshes are relative to the file's folder, from wherever it is called.
expect 0 '2 links' with_xacro "$D" robot/arm.urdf.xacro -o of-xacro --epsilon 2% --depfile x.d
expect 0 '' "$D" robot/arm.urdf -o of-urdf --epsilon 2%
cmp -s of-xacro/arm.urdf of-urdf/arm.urdf || fail "another URDF: $(diff of-xacro/arm.urdf of-urdf/arm.urdf)"
diff -r of-xacro/bodies of-urdf/bodies >diff.txt || fail "other bodies: $(cat diff.txt)"
grep -q "^of-xacro/arm.urdf: robot/arm.urdf.xacro .*robot/part.xacro " x.d || fail "dependency file: $(cat x.d)"
shows 0 '^verified: 2 of 2 links' with_xacro "$BIN/bound-verify" robot robot/arm.urdf.xacro of-xacro/arm.urdf --epsilon 2%
(cd robot/meshes && with_xacro "$D" ../arm.urdf.xacro -o ../../inside --epsilon 2% --quiet) || fail "from another folder"
cmp -s inside/arm.urdf of-xacro/arm.urdf || fail "from another folder: another URDF"
cp robot/arm.urdf.xacro robot/plain.XACRO
expect 0 '' with_xacro "$BIN/bmesh-decimate" robot/plain.XACRO -o plain --epsilon 2%
[ -s plain/plain.urdf ] || fail "no URDF of plain.XACRO: $(ls plain)"
# What somebody has written himself beside the xacro file stays.
cp robot/arm.urdf kept.urdf
for tool in bcd-decompose bmesh-decimate; do
  expect 4 'robot/arm.urdf: exists, and is not marked as a result' with_xacro "$BIN/$tool" robot/arm.urdf.xacro -o robot --epsilon 2%
  cmp -s robot/arm.urdf kept.urdf || fail "$tool: robot/arm.urdf is another"
done
rm robot/arm.urdf
for run in 1 2; do expect 0 '' with_xacro "$BIN/bmesh-decimate" robot/arm.urdf.xacro -o robot --epsilon 2%; done
grep -q 'Made by KABouM' robot/arm.urdf || fail "no word of whose it is: $(cat robot/arm.urdf)"
expect 0 '' with_xacro "$BIN/bcd-decompose" of-xacro/arm.urdf -o again --epsilon 2%
[ "$(grep -c 'Made by KABouM' again/arm.urdf)" = 1 ] || fail "said twice: $(cat again/arm.urdf)"
echo robot/arm.urdf.xacro >list.txt
expect 0 '1 done' with_xacro "$BIN/kaboum-batch" list.txt -o batch --command bcd-decompose --epsilon 2%
cmp -s batch/results/robot/arm/arm.urdf of-xacro/arm.urdf || fail "in a batch: $(find batch/results)"
echo '<!-- changed -->' >robot/part.xacro
expect 0 '1 done; batch' with_xacro "$BIN/kaboum-batch" list.txt -o batch --command bcd-decompose --epsilon 2%
expect 0 '1 of them earlier' with_xacro "$BIN/kaboum-batch" list.txt -o batch --command bcd-decompose --epsilon 2%

# Not there, or it fails, or what it makes is no robot.
refused() {
  words=$1
  shift
  expect 3 "$words" "$@" "$D" robot/arm.urdf.xacro -o x --epsilon 2%
  grep -q '^bcd-decompose: robot/arm.urdf.xacro' err.txt || fail "the file is not named: $(cat err.txt)"
  absent x
}
refused 'install xacro.*xacro robot/arm.urdf.xacro > robot.urdf' env PATH="$WORK/none"
xacro 'echo "name reach is not defined" >&2; exit 2'
refused 'exit code 2: name reach is not defined' with_xacro
xacro 'exit 0'
refused 'makes nothing of it' with_xacro
xacro 'kill -SEGV $$'
refused 'signal' with_xacro
xacro 'exec yes "<robot/>"'
refused 'more than 64 MiB' with_xacro
xacro 'cat "$1"'
refused '(expanded):2: <xacro:property>' with_xacro
xacro 'echo "<sdf version=\"1.9\"/>"'
refused '<sdf>: no <model>' with_xacro
# Arguments: handed on as they are, and part of the printed check; only for xacro.
xacro '[ "$2" = "of:=a b" ] && [ "$3" = "reach:=0.5" ] && [ $# = 3 ] || { echo "got: $*" >&2; exit 3; }; sed '\''/xacro:property/d; s/ xmlns:xacro="[^"]*"//; s/${reach}/0.5/'\'' "$1"'
expect 0 '2 links' with_xacro "$D" robot/arm.urdf.xacro -o with --epsilon 2% --xacro-args 'of:=a b' reach:=0.5 --report with.json
grep -q "xacro-args 'of:=a b' reach:=0.5" with.json || fail "the check has no arguments: $(cat with.json)"
shows 0 '^verified: 2 of 2 links' with_xacro "$BIN/bound-verify" robot robot/arm.urdf.xacro with/arm.urdf --epsilon 2% --xacro-args 'of:=a b' --xacro-args reach:=0.5
expect 3 'xacro fails, exit code 3: got: .*; arguments that it wants are stated by --xacro-args' with_xacro "$D" robot/arm.urdf.xacro -o x --epsilon 2%
for bad in reach :=1 --deps:=1; do
  expect 2 'is no argument of xacro: NAME:=VALUE is meant' with_xacro "$D" robot/arm.urdf.xacro -o x --epsilon 2% --xacro-args "$bad"
done
expect 2 'are for files called NAME.xacro' "$D" of-urdf/arm.urdf -o x --epsilon 2% --xacro-args a:=1
# $(find NAME): packages are found as those of meshes are, with Python's module of ROS or without; also those that
# included files name, and by the other programs.
cat >bin/xacro <<'END'
#!/usr/bin/env python3
import os, re, sys
from ament_index_python.packages import get_package_share_directory
def text_of(name):
    text = re.sub(r"\$\(find ([^)]*)\)", lambda m: get_package_share_directory(m.group(1).strip()), open(name).read())
    here = os.path.dirname(name)
    return re.sub(r'<xacro:include filename="([^"]*)"/>', lambda m: text_of(os.path.join(here, m.group(1))), text)
arguments = [a for a in sys.argv[1:] if ":=" in a]
if arguments not in ([], ["side:=left"]):
    sys.exit("got: " + str(sys.argv))
if sys.argv[1] == "--deps":
    sys.exit()
print(text_of(sys.argv[1]))
END
chmod +x bin/xacro
mkdir -p ws/arm_description/urdf ws/arm_description/meshes ws/grip/urdf found
cp robot/meshes/t.off ws/arm_description/meshes
echo '<package><name>grip_description</name></package>' >ws/grip/package.xml
echo '<link name="tool"><collision><geometry><mesh filename="package://arm_description/meshes/t.off"/></geometry></collision></link>' >ws/grip/urdf/grip.xacro
cat >ws/arm_description/urdf/links.xacro <<'END'
<link name="base"><collision><geometry><mesh filename="package://arm_description/meshes/t.off"/></geometry></collision></link>
<xacro:include filename="$(find grip_description)/urdf/grip.xacro"/>
END
cat >found/arm.urdf.xacro <<'END'
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:include filename="$(find arm_description)/urdf/links.xacro"/>
<joint name="j" type="revolute"><parent link="base"/><child link="tool"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>
END
expect 0 '2 links' with_xacro "$D" found/arm.urdf.xacro -o of-found --epsilon 2% --package-path ws --xacro-args side:=left --depfile y.d
shows 0 '^verified: 2 of 2 links' with_xacro "$BIN/bound-verify" robot found/arm.urdf.xacro of-found/arm.urdf --package-path ws
# A repository that is called as the package in it.
mkdir -p repositories/arm_description
cp -r ws/arm_description repositories/arm_description/description
echo '<package><name>arm_description</name></package>' >repositories/arm_description/description/package.xml
cp -r ws/grip repositories
expect 0 '2 links' with_xacro "$D" found/arm.urdf.xacro -o of-repository --epsilon 2% --package-path repositories
expect 0 '2 links' env ROS_PACKAGE_PATH="$WORK/ws" PATH="$WORK/bin:$PATH" "$D" found/arm.urdf.xacro -o of-ros --epsilon 2%
expect 3 "xacro fails.*\$(find arm_description) of found/arm.urdf.xacro:2 is no package that is found: name it, or the folder that holds it, by --package-path" with_xacro "$D" found/arm.urdf.xacro -o x --epsilon 2%
mkdir -p ros/ament_index_python
cat >ros/ament_index_python/packages.py <<'END'
import os, sys
def get_package_share_directory(name):
    print("the installed one", file=sys.stderr)
    return os.path.join(os.environ["AMENT_PREFIX_PATH"].split(":")[0], "share", name)
END
: >ros/ament_index_python/__init__.py
mkdir tmp
expect 0 '2 links' env TMPDIR="$WORK/tmp" PYTHONPATH="$WORK/ros" PATH="$WORK/bin:$PATH" "$D" found/arm.urdf.xacro -o of-module --epsilon 2% --package-path ws
[ -z "$(ls -A tmp)" ] || fail "folders are left behind: $(ls tmp)"
printf 'j\n0\n0.2\n' >path.csv
expect 0 '' with_xacro "$BIN/sweep-approx" found/arm.urdf.xacro --path path.csv -o swept.glb --epsilon 0.05 --package-path ws --xacro-args side:=left
shows 0 '' with_xacro "$BIN/bound-verify" sweep found/arm.urdf.xacro path.csv swept.glb --prepare --package-path ws --xacro-args side:=left
with_xacro "$BIN/kaboum-pairs" found/arm.urdf.xacro --package-path ws --xacro-args side:=left >out.txt 2>err.txt
case $? in 0 | 7) ;; *) fail "kaboum-pairs: $(cat err.txt)" ;; esac
shows 0 '' with_xacro "$BIN/kaboum-ik" found/arm.urdf.xacro --pose-of 0.5 --package-path ws --xacro-args side:=left
pgrep -f "$WORK/bin/xacro" >/dev/null && fail "xacro still runs"
finish
