# shellcheck shell=sh disable=SC2154
# Robots made for programs that load them: enclosing meshes, MJCF and SDF, epsilon by link, presets, pages.
. "$(dirname "$0")/common.sh"
D=$BIN/bcd-decompose
S=$BIN/bmesh-decimate
V=$BIN/bound-verify
KABOUM_CACHE=$WORK/cache
export KABOUM_CACHE

mkdir -p robot/meshes
tetrahedron >robot/meshes/t.off
cp "$BRACKET" robot/meshes/bracket.obj
cat >robot/r.urdf <<'END'
<robot name="r">
  <link name="base"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="meshes/bracket.obj"/></geometry></visual>
    <collision><geometry><mesh filename="meshes/t.off"/></geometry></collision></link>
  <link name="wrist_1"><visual><origin xyz="0.1 0 0" rpy="0.3 0 0"/><geometry><mesh filename="meshes/bracket.obj" scale="0.5 -0.5 0.5"/></geometry></visual>
    <visual><geometry><box size="0.2 0.2 0.1"/></geometry></visual></link>
  <link name="wrist_2"><visual><geometry><mesh filename="meshes/bracket.obj" scale="0.5 0.5 0.5"/></geometry></visual></link>
  <joint name="a" type="revolute"><parent link="base"/><child link="wrist_1"/><origin xyz="0 0 0.5"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="b" type="revolute"><parent link="wrist_1"/><child link="wrist_2"/><origin xyz="0 0 0.5"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>
END

# What is drawn, by either name of the option.
expect 0 'of 3 links, from 2 meshes' "$D" robot/r.urdf -o drawn --from visual --epsilon 3% --effort fast --html-report page.html
expect 0 '' "$D" robot/r.urdf -o drawn2 --visual --epsilon 3% --effort fast --quiet
diff -r drawn drawn2 >diff.txt || fail "--from visual is not --visual: $(cat diff.txt)"
shows 0 '^verified: 3 of 3 links' "$V" robot robot/r.urdf drawn/r.urdf --visual --prepare --epsilon 3%
grep -q '<b>wrist_1</b>' page.html && grep -q 'every triangle of 3 links is inside' page.html || fail "the page says nothing of a link"
[ "$(grep -o 'data:image/png;base64,iVBOR' page.html | wc -l)" = 6 ] || fail "pictures"
expect 2 'for robots' "$D" robot/meshes/t.off -o x.glb --from visual
expect 2 'give a name that ends with .html' "$D" robot/r.urdf -o x --html-report robot/r.urdf

# Meshes round the meshes: few vertices, verified, the same from the cache and on one thread.
expect 0 '2 meshes of 3 links' "$S" robot/r.urdf -o round --from visual --epsilon 2% --effort fast --report round.json \
  --depfile round.d --html-report round.html
shows 0 '^verified: 3 of 3 links' "$V" robot robot/r.urdf round/r.urdf --visual --prepare
[ "$(grep -c 'meshes/bracket-outer.*stl' round/r.urdf)" = 3 ] || fail "meshes of the URDF: $(grep filename round/r.urdf)"
grep -q 'scale="0.5 -0.5 0.5"' round/r.urdf || fail "scale"
grep -q '^round/r.urdf: .*robot/r.urdf .*bracket.obj' round.d || fail "dependency file: $(cat round.d)"
grep -q 'every triangle is inside' round.html || fail "the page of enclosing meshes"
expect 0 'from the cache' "$S" robot/r.urdf -o round2 --visual --epsilon 2% --effort fast --threads 1
diff -r round round2 >diff.txt || fail "another result from the cache: $(cat diff.txt)"
expect 0 '' "$S" robot/r.urdf -o round3 --visual --epsilon 2% --effort fast --threads 1 --no-cache
grep -q 'from the cache' err.txt && fail "--no-cache looks into the cache"
diff -r round round3 >diff.txt || fail "another result on one thread: $(cat diff.txt)"
# A damaged entry is made again.
for entry in "$KABOUM_CACHE"/*.set; do
  head -n 1 "$entry" | grep -q 'KABOUM-MESH' || continue
  printf 'X' | dd of="$entry" bs=1 seek=300 conv=notrunc 2>/dev/null
done
expect 0 '' "$S" robot/r.urdf -o round4 --visual --epsilon 2% --effort fast
# On one core the second of the two meshes finds what the first one has made again.
grep -q '(2 from the cache)' err.txt && fail "a damaged entry is used"
diff -r round round4 >diff.txt || fail "another result after damage: $(cat diff.txt)"
shows 0 'are whole' "$BIN/kaboum-cache" verify
# Where float32 is too coarse, that mesh alone is written with more digits, unless one format is asked for.
mkdir -p far/meshes
printf 'OFF\n4 4 0\n40000.1 0 0\n40001.1 0 0\n40000.1 1 0\n40000.1 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n' >far/meshes/far.off
tetrahedron >far/meshes/near.off
cat >far/r.urdf <<'END'
<robot name="far"><link name="a"><visual><geometry><mesh filename="meshes/far.off"/></geometry></visual>
  <visual><geometry><mesh filename="meshes/near.off"/></geometry></visual></link></robot>
END
for run in 1 2; do
  expect 0 'too coarse' "$S" far/r.urdf -o mixed --visual --epsilon 2% --effort fast
  [ "$(ls mixed/meshes | tr '\n' ' ')" = 'far-outer.obj near-outer.stl ' ] || fail "run $run: $(ls mixed/meshes)"
  shows 0 '^verified: 1 of 1 link ' "$V" robot far/r.urdf mixed/r.urdf --visual --prepare
done
expect 0 'from the cache' "$S" far/r.urdf -o mixed2 --visual --epsilon 2% --effort fast
diff -r mixed mixed2 >diff.txt || fail "another result from the cache: $(cat diff.txt)"
expect 1 'choose a format that holds doubles' "$S" far/r.urdf -o stl --visual --epsilon 2% --output-format stl

expect 0 '' "$S" robot/r.urdf -o objs --visual --epsilon 2% --effort fast --output-format obj --verify
shows 0 '^verified' "$V" robot robot/r.urdf objs/r.urdf --visual --prepare
expect 0 '' "$S" robot/r.urdf -o few --visual --vertices 100 --effort fast --links base --verbose
grep -q '→ 100 vertices' err.txt || fail "a number of vertices: $(cat err.txt)"
expect 2 'direction' "$S" robot/r.urdf -o x --epsilon 2% --direction inner
expect 2 'progressive' "$S" robot/r.urdf -o x --epsilon 2% --progressive x.pm
expect 2 'series' "$S" robot/r.urdf -o x --vertices 300,200
expect 2 'stl or obj' "$S" robot/r.urdf -o x --epsilon 2% --output-format ply
expect 2 'at least one of' "$S" robot/r.urdf -o x
expect 2 'folder' "$S" robot/r.urdf -o x.stl --epsilon 2%
expect 2 'for robots' "$S" robot/meshes/t.off -o x.ply --epsilon 2% --visual
expect 4 'exists' "$S" robot/r.urdf -o drawn --visual --epsilon 2%
absent x x.stl

# Every mesh has the epsilon of its link; patterns, and lines that are for nothing.
cat >e.yaml <<'END'
# nearer at the hand
wrist_2: 1%
wrist_*: 5%
END
expect 0 'from 3 meshes' "$D" robot/r.urdf -o near --visual --epsilon 3% --effort fast --epsilons e.yaml --depfile near.d
grep -q 'near/r.urdf: robot/r.urdf e.yaml' near.d || fail "dependency file: $(cat near.d)"
for link in base wrist_1 wrist_2; do
  case $link in base) e=3% ;; wrist_1) e=5% ;; *) e=1% ;; esac
  LC_ALL=C grep -a -q -- "--epsilon $e " "near/links/$link.glb" || fail "$link has not epsilon $e"
  shows 0 '^verified' "$V" cover "near/links/$link.glb" "near/links/$link.glb"
done
shows 1 'refuted' "$V" robot robot/r.urdf near/r.urdf --visual --prepare --epsilon 3%
shows 0 '^verified' "$V" robot robot/r.urdf near/r.urdf --visual --prepare --epsilon 5%
echo '{"wrist_?": "4%", "*": 0.1}' >e.json
expect 0 '2 meshes of 3 links' "$S" robot/r.urdf -o near2 --visual --epsilon 3% --effort fast --epsilons e.json
wrong() {
  printf '%b' "$1" >wrong.yaml
  expect 3 "$2" "$D" robot/r.urdf -o x --visual --epsilons wrong.yaml
}
wrong 'base: 1%\nwrist_3: 1%\n' "wrong.yaml:2: no link is called 'wrist_3'; did you mean"
wrong '\nbase: much\n' "wrong.yaml:2: .*positive number"
wrong 'base: -1\n' 'wrong.yaml:1: .*positive'
wrong 'base: 1%\nbase: 2%\n' "wrong.yaml:2: 'base' is there already, in line 1"
wrong '[1, 2]' 'wrong.yaml:1: give links'
wrong 'base: [1]\n' 'wrong.yaml:1: give links'
wrong 'base: {' 'wrong.yaml:'
wrong 'base: 1%\n---\nwrist_1: 2%\n' 'wrong.yaml:2: a second document'
wrong 'base: &a 1%\nwrist_1: *a\n' 'wrong.yaml:2: anchors and aliases'
wrong '' 'wrong.yaml: give links'
expect 3 'absent.yaml' "$D" robot/r.urdf -o x --epsilons absent.yaml
absent x

# Other formats, and what programs need.
expect 0 '' "$D" robot/r.urdf -o formats --visual --epsilon 3% --effort fast --robot-format mjcf --robot-format sdf --report formats.json \
  --depfile formats.d
grep -q '<sdf version="1.9">' formats/r.sdf && grep -q '<mujoco model="r">' formats/r.xml || fail "formats"
grep -q '^formats/r.urdf formats/r.xml formats/r.sdf: ' formats.d || fail "dependency file: $(cat formats.d)"
grep -q '"formats/r.sdf"' formats.json || fail "report"
# Formats that are not made again do not stay beside other bodies.
cp -r formats fewer
expect 0 '' "$D" robot/r.urdf -o fewer --visual --epsilon 9% --effort fast
[ -e fewer/r.urdf ] && [ ! -e fewer/r.sdf ] && [ ! -e fewer/r.xml ] || fail "formats of before: $(ls fewer)"
expect 0 '' "$D" robot/r.urdf -o fewer --visual --epsilon 9% --effort fast --srdf
expect 0 '' "$D" robot/r.urdf -o fewer --visual --epsilon 9% --effort fast
[ ! -e fewer/r.srdf ] || fail "pairs of before, where nothing else is written anew"
# Pairs of links.
sed 's,</robot>,<link name="eye"/><joint name="c" type="fixed"><parent link="base"/><child link="eye"/><origin xyz="0 0 0.1"/></joint><link name="lens"/><joint name="d" type="fixed"><parent link="base"/><child link="lens"/></joint></robot>,' robot/r.urdf >robot/pairs.urdf
expect 0 '4 adjacent, 1 proved never to touch, 1 fixed' "$D" robot/pairs.urdf -o pairs --visual --epsilon 3% --effort fast --srdf --report pairs.json --depfile pairs.d
grep -q '^pairs/pairs.urdf pairs/pairs.srdf: ' pairs.d || fail "dependency file: $(cat pairs.d)"
python3 - <<'END' || fail "pairs: $(cat pairs/pairs.srdf)"
import json
import xml.etree.ElementTree as tree
said = json.load(open("pairs.json"))["pairs_of_links"]
found = [p.get("reason") for p in tree.parse("pairs/pairs.srdf").getroot().iter("disable_collisions")]
assert sorted(found) == 4 * ["Adjacent"] + ["Default", "Never"], found
assert said == {"adjacent": 4, "never_in_contact": 1, "fixed_to_each_other": 1, "others": 0}, said
END
# A budget for all links: within it, and no coarser than with half of it.
reach() { python3 -c '
import json, sys
r = json.load(open(sys.argv[1]))
assert r["bodies"] <= int(sys.argv[2]) and r["vertices"] <= int(sys.argv[3]), r
print(max(l["reach_upper"] for l in r["links"]))' "$@" || fail "budget: $(cat "$1")"; }
for n in 6 12; do
  expect 0 '' "$D" robot/r.urdf -o "budget-$n" --visual --effort fast --robot-bodies $n --report "b$n.json"
  shows 0 '^verified: 3 of 3 links' "$V" robot robot/r.urdf "budget-$n/r.urdf" --visual --prepare
done
python3 -c "assert $(reach b12.json 12 1000000) < $(reach b6.json 6 1000000)" || fail "more bodies are no nearer"
expect 0 '' "$D" robot/r.urdf -o budget-v --visual --effort fast --robot-vertices 200 --report bv.json
reach bv.json 1000000 200 >/dev/null
expect 2 'are 4 bodies' "$D" robot/r.urdf -o x --visual --effort fast --robot-bodies 3
expect 2 '--epsilon' "$D" robot/r.urdf -o x --visual --robot-bodies 24 --epsilon 1%
expect 2 'for robots' "$D" robot/meshes/t.off -o x.glb --robot-bodies 24
absent x x.glb
expect 2 '--links' "$D" robot/r.urdf -o x --visual --srdf --links base
expect 2 'for robots' "$D" robot/meshes/t.off -o x.glb --srdf
for program in moveit mujoco gazebo bullet drake; do
  expect 0 '' "$D" robot/r.urdf -o "$program" --visual --epsilon 3% --effort fast --for "$program"
  shows 0 '^verified' "$V" robot robot/r.urdf "$program/r.urdf" --visual --prepare
done
grep -q 'filename="package://moveit/bodies/' moveit/r.urdf || fail "--for moveit: $(grep filename moveit/r.urdf)"
[ -f mujoco/r.xml ] && [ ! -f mujoco/r.sdf ] || fail "--for mujoco"
# What its least thickness does not go with is said by the option's name.
for option in '--max-facets-per-body 12' '--max-total-vertices 99'; do
  expect 2 "for mujoco means --min-thickness 1e-04, .* ${option% *}" \
    "$D" robot/r.urdf -o x --visual --effort fast --for mujoco $option
done
[ -f gazebo/r.sdf ] && [ ! -f gazebo/r.xml ] || fail "--for gazebo"
grep -q '"bodies/.*stl"' bullet/r.urdf || fail "--for bullet"
grep -q 'bodies/.*obj' drake/r.urdf && grep -q '<drake:declare_convex/>' drake/r.urdf || fail "--for drake"
[ "$(find drake -name '*.stl' | wc -l)" = 0 ] || fail "--for drake writes STL"
expect 0 '' "$D" robot/r.urdf -o drake --visual --epsilon 3% --effort fast --for drake # over its own result
expect 0 '' "$D" robot/r.urdf -o other --visual --epsilon 3% --effort fast --for moveit --mesh-prefix package://arm --robot-format sdf
grep -q 'package://arm/bodies' other/r.urdf && grep -q 'model://arm/bodies' other/r.sdf || fail "an option that --for would set"
expect 2 'for robots' "$D" robot/meshes/t.off -o x.glb --for drake
expect 2 '' "$D" robot/r.urdf -o x --for rviz
mkdir -p theirs && echo note >theirs/r.xml
expect 4 'theirs/r.xml' "$D" robot/r.urdf -o theirs --visual --epsilon 3% --effort fast --for mujoco
[ "$(cat theirs/r.xml)" = note ] && [ ! -e theirs/r.urdf ] || fail "a file of the user is gone"
sed 's,<mass value="1"/>,<mass value="heavy"/>,' robot/r.urdf >robot/heavy.urdf
expect 3 'heavy.urdf:2: .*heavy' "$D" robot/heavy.urdf -o x --visual --epsilon 3% --effort fast --robot-format mjcf
absent x
finish
