# Covers by spheres: made, decided, judged, and mutants of all of them.
. "$(dirname "$0")/common.sh"
B=$BIN/bcd-decompose
V=$BIN/bound-verify

printf 'OFF\n8 12 0\n0 0 0\n4 0 0\n0 1 0\n4 1 0\n0 0 1\n4 0 1\n0 1 1\n4 1 1\n' >bar.off
for t in '0 2 1' '1 2 3' '4 5 6' '5 7 6' '0 1 4' '1 5 4' '2 6 3' '3 6 7' '0 4 2' '2 4 6' '1 3 5' '3 7 5'; do
  echo "3 $t" >>bar.off
done

# Within epsilon, and by a number of them; the same bytes for any number of threads.
expect 0 '' "$B" bar.off -o bar.glb --bodies spheres --epsilon 0.4 --effort fast --no-cache --report bar.json
shows 0 '^verified' "$V" cover bar.off bar.glb --epsilon 0.4
expect 0 '' "$B" bar.off -o again.glb --bodies spheres --epsilon 0.4 --effort fast --no-cache --threads 1
cmp bar.glb again.glb
expect 0 '' "$B" bar.off -o five.glb --bodies spheres --max-bodies 5 --effort fast --no-cache --report five.json
json five.json "r['bodies'] <= 5 and r['reach']['upper'] < 0.5"
shows 0 '^verified' "$V" cover bar.off five.glb

# What means nothing beside spheres.
expect 2 'direction' "$B" bar.off -o x.glb --bodies capsules --direction inner
expect 2 'max-work' "$B" bar.off -o x.glb --bodies spheres --direction inner --max-work 3
expect 2 'min-thickness' "$B" bar.off -o x.glb --bodies spheres --min-thickness 0.1

# Before any search: a format that states no radii.
expect 2 'only .glb states radii' "$B" bar.off -o x.obj --bodies spheres
[ ! -e x.obj ] || fail "x.obj was written"
"$B" bar.off -o bar.glb --bodies spheres --epsilon 0.4 --effort fast --no-cache 2>&1 | grep -q '[0-9] spheres; cover verified exactly' || fail "spheres are called bodies"

# Inside: in the solid, nothing deeper than epsilon left out; the same bytes for any number of threads. No cover.
expect 0 '[0-9] spheres; inside verified exactly' "$B" bar.off -o in.glb --bodies spheres --direction inner --epsilon 0.2 --effort fast --no-cache --report in.json
json in.json "r['inside'] == 'verified' and r['depth'] == {'answer': 'verified', 'bound': 0.2} and r['reach']['upper'] == 0.2 and 'depth_decided' not in r"
shows 0 'depth: verified' "$V" mesh --inner bar.off in.glb --epsilon 0.2 --report judged.json
shows 0 'surface claim: verified: every point of the union' "$V" mesh --inner bar.off in.glb --epsilon 0.2
json judged.json "r['verdict'] == 'verified' and r['claims']['depth']['bound'] == 0.2"
shows 1 'depth: refuted: .* is in no ball' "$V" mesh --inner bar.off in.glb --epsilon 0.1
expect 1 'note: the set was made to lie inside: bound-verify mesh --inner bar.off in.glb decides that' "$V" cover bar.off in.glb
# With the options that it was asked with.
sed '2!s/^\([0-9.]*\) \([0-9.]*\) \([0-9.]*\)$/\10 \20 \30/' bar.off >'ten times.off'
expect 1 "bound-verify mesh --inner 'ten times.off' in.glb --scale 0.1 --claims solid --epsilon 0.2 --prepare decides that" "$V" cover 'ten times.off' in.glb --scale 0.1 --claims solid --epsilon 0.2 --prepare
# What is printed decides it as it is: of sets inside and outside, by epsilon and by number, scaled, in parts, of other formats.
cp bar.off bar
sed 's/^3 0 2 1$/3 0 1 2/' bar.off >turned.off
sed -e 's/^8 12 0$/8 10 0/' -e '/^3 1 3 5$/d' -e '/^3 3 7 5$/d' bar.off >cup.off
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >sheet.off
while IFS='|' read -r input output options; do
  # shellcheck disable=SC2086
  expect 0 '' "$B" $input -o "$output" --effort fast $options --report made.json
  printed=$(sed -n 's/^from the files alone: //p' err.txt)
  case $printed in bound-verify*) ;; *) fail "no command: $input $options: $(cat err.txt)" ;; esac
  shows 0 '^verified' sh -c "$BIN/$printed"
  PRINTED=$printed json made.json "r['check'] == __import__('os').environ['PRINTED']"
done <<'E'
bar.off|in.glb|--bodies spheres --direction inner --epsilon 0.2
bar.off|in.glb|--bodies spheres --direction inner --epsilon 5%
bar.off|in.glb|--bodies spheres --direction inner --max-bodies 7
bar.off|in.glb|--bodies spheres --direction inner --epsilon 2 --scale 10
bar.off|in.glb|--direction inner --epsilon 0.2
bar.off|in.obj|--direction inner --epsilon 0.2
bar.off|in|--direction inner --epsilon 0.2
bar.off|out.glb|--epsilon 0.2
bar.off|out.glb|--epsilon 5% --prepare off
bar.off|out.glb|--epsilon 200mm
bar.off|out.obj|--epsilon 200mm
bar.off|out file|--epsilon 5% --output-format glb
bar|out.glb|--epsilon 5% --input-format off
bar.off|out.glb|--epsilon 2 --scale 10
bar.off|out|--max-bodies 1
bar.off|out.glb|--bodies spheres --epsilon 0.4
bar.off|out.glb|--bodies spheres --max-bodies 5
bar.off|out.glb|--bodies capsules --epsilon 0.4
bar.off|out.glb|--bodies mixed --epsilon 0.4
bar.off|out.glb|--epsilon 0.2 --prepare wrap
cup.off|out.glb|--epsilon 0.2 --prepare wrap
cup.off|out.glb|--bodies spheres --epsilon 0.6 --prepare wrap
turned.off|out.glb|--epsilon 0.2
sheet.off|out.glb|--epsilon 0.2
E
rm -f 'out file'
"$B" - -o in.glb --input-format off --bodies spheres --direction inner --epsilon 0.2 --effort fast <bar.off 2>err.txt || fail "a pipe: $(cat err.txt)"
grep -q 'from the files alone' err.txt && fail "a command that reads a pipe again: $(cat err.txt)"
expect 0 '' "$B" bar.off -o in.glb --bodies spheres --direction inner --epsilon 0.2 --effort fast --report in.json
expect 0 '' "$B" bar.off -o around.glb --bodies spheres --epsilon 0.4 --effort fast
expect 1 'note: the set was made to cover: bound-verify cover bar.off around.glb decides that' "$V" mesh --inner bar.off around.glb
expect 0 '' "$B" bar.off -o again.glb --bodies spheres --direction inner --epsilon 0.2 --effort fast --no-cache --threads 1
cmp in.glb again.glb
sed 's/^4 \(. .\)$/3 \1/' bar.off >short.off
shows 1 'surface claim: refuted: .* balls reach out of the solid' "$V" mesh --inner short.off in.glb
expect 0 '' "$B" bar.off -o seven.glb --bodies spheres --direction inner --max-bodies 7 --effort fast --no-cache --report seven.json
json seven.json "1 <= r['bodies'] <= 7 and 0.2 < r['reach']['upper'] < 0.5"
shows 0 '^verified' "$V" mesh --inner bar.off seven.glb --epsilon "$(python3 -c "import json; print(json.load(open('seven.json'))['reach']['upper'])")"
expect 1 'nothing nearer was found' "$B" bar.off -o few.glb --bodies spheres --direction inner --max-bodies 7 --epsilon 0.1 --effort fast --no-cache

# A robot: its spheres, written, judged, and judged less one digit.
cat >arm.urdf <<'U'
<robot name="arm">
  <link name="base"><collision><origin xyz="0.1 0.2 0.3" rpy="0.3 0.2 0.1"/><geometry><mesh filename="bar.off"/></geometry></collision></link>
  <link name="hand"><collision><origin xyz="0 0 1"/><geometry><box size="0.1 0.1 1"/></geometry></collision><collision><geometry><sphere radius="0.5"/></geometry></collision></link>
  <joint name="j" type="fixed"><parent link="base"/><child link="hand"/></joint>
</robot>
U
expect 2 'yaml' "$B" arm.urdf -o out --bodies spheres --epsilon 0.4
expect 2 'direction inner: decompose' "$B" arm.urdf -o out.yaml --bodies spheres --direction inner --epsilon 0.4
expect 0 '' "$B" arm.urdf -o arm.yaml --bodies spheres --epsilon 0.4 --effort fast --no-cache
grep -q '^seen in a browser: by --preview FILE.html here, or --page FILE.html there$' err.txt || fail "nothing says what draws them: $(cat err.txt)"
shows 0 '^verified: .* hold 2 of 2 links' "$V" robot arm.urdf --spheres arm.yaml --report judged.json
# A page of them, as bound-verify writes it; of capsules none.
for file in page.yaml page.urdf; do
  expect 0 '' "$B" arm.urdf -o $file --bodies spheres --epsilon 0.4 --effort fast --preview mine.html
  expect 0 '' "$V" robot arm.urdf --spheres $file --page its.html
  cmp mine.html its.html || fail "another page than bound-verify's"
done
expect 2 'of spheres in .yaml, .xrdf, .srdf and .urdf also a page' "$B" arm.urdf -o x.urdf --bodies capsules --epsilon 0.4 --preview x.html
expect 2 'not x.png' "$B" arm.urdf -o x.yaml --bodies spheres --epsilon 0.4 --preview x.png
absent x.urdf x.yaml x.html x.png
json judged.json "r['verdict'] == 'verified' and r['share_outside']['upper'] == 0"
# The same spheres in other formats, which are judged alike.
mkdir -p other
for file in arm.xrdf arm.srdf arm-spheres.urdf other/arm.urdf; do
  expect 0 '' "$B" arm.urdf -o "$file" --bodies spheres --epsilon 0.4 --effort fast
  shows 0 '^verified: .* hold 2 of 2 links' "$V" robot arm.urdf --spheres "$file" --report one.json
  python3 - <<'P' || fail "$file: other spheres"
import json
a, b = json.load(open("judged.json")), json.load(open("one.json"))
assert a["count"] == b["count"] and [l["spheres"] for l in a["links"]] == [l["spheres"] for l in b["links"]]
P
done
grep -q -- '-\\-epsilon' arm.srdf || fail "the comment has other options: $(head -5 arm.srdf)"
expect 2 'link_sphere_approximation' "$B" arm.urdf -o arm.txt --bodies spheres --epsilon 0.4
# So many for all links: no link is farther than it has to be.
expect 0 '' "$B" arm.urdf -o twelve.yaml --bodies spheres --robot-bodies 12 --effort fast --no-cache --report twelve.json
json twelve.json "2 < r['spheres'] <= 12 and r['mean_reach_upper'] <= r['reach_upper'] < 0.4"
expect 0 '' "$B" arm.urdf -o mean.yaml --bodies spheres --robot-bodies 12 --share mean --effort fast --no-cache --report mean.json
json mean.json "2 < r['spheres'] <= 12"
shows 0 '^verified: .* hold 2 of 2 links' "$V" robot arm.urdf --spheres mean.yaml
expect 0 '' "$B" arm.urdf -o again.yaml --bodies spheres --robot-bodies 12 --share mean --effort fast --no-cache --threads 1
cmp mean.yaml again.yaml
expect 2 'robot-bodies' "$B" arm.urdf -o x.yaml --bodies spheres --epsilon 0.4 --share mean
expect 2 'bodies spheres' "$B" arm.urdf -o x --robot-bodies 12 --share mean
expect 2 'farthest' "$B" arm.urdf -o x.yaml --bodies spheres --robot-bodies 12 --share median
shows 0 '^verified: .* hold 2 of 2 links' "$V" robot arm.urdf --spheres twelve.yaml
expect 2 'budget is less' "$B" arm.urdf -o x.yaml --bodies spheres --robot-bodies 2 --effort fast --no-cache
expect 2 'no vertices' "$B" arm.urdf -o x.yaml --bodies spheres --robot-vertices 20

# A mesh that gets none within epsilon, of which its wrap leaves nothing: some within a few times that, and exit code 1.
sed '/name="hand"/d; /<joint/d; s/<origin.*rpy="0.3 0.2 0.1"\/>//' arm.urdf >base.urdf
expect 1 'has spheres within 0.8' "$B" base.urdf -o base-wrapped.yaml --bodies spheres --epsilon 0.4 --prepare wrap --offset 0.3 --effort fast --no-cache
shows 0 '^verified' "$V" robot base.urdf base-wrapped.yaml

cat >one.yaml <<'Y'
robot_cfg:
  kinematics:
    collision_sphere_buffer: 0.5
    collision_spheres:
      base:
        - center: [2, 0.5, 0.5]
          radius: 0.5
      hand:
        - "center": [0, 0, 0]
          "radius": 0.1
Y
shows 1 "link 'base': refuted: between .* % of the surface is outside its 1 sphere, by" "$V" robot arm.urdf --spheres one.yaml
shows 1 "link 'hand': refuted" "$V" robot arm.urdf --spheres one.yaml
sed 's/radius: 0.5/radius: -1/' one.yaml >negative.yaml
expect 3 'negative.yaml:[0-9]*: .*above 0' "$V" robot arm.urdf --spheres negative.yaml
sed 's/base:/bsae:/' one.yaml >stranger.yaml
expect 3 "stranger.yaml:5: .*no link 'bsae'" "$V" robot arm.urdf --spheres stranger.yaml
printf 'collision_spheres:\n  base:\n    - center: [0, 0' >cut.yaml
expect 3 'cut.yaml:3' "$V" robot arm.urdf --spheres cut.yaml
printf 'collision_spheres:\n  base:\n    - center: [0, 0]\n      radius: 1\n' >two.yaml
expect 3 'two.yaml:3: .*three numbers' "$V" robot arm.urdf --spheres two.yaml
expect 2 'RESULT or --spheres' "$V" robot arm.urdf
shows 0 '^verified: .* hold 2 of 2 links' "$V" robot arm.urdf arm.yaml  # known by its name
# Names of such files without --bodies spheres.
expect 2 'bodies spheres' "$B" arm.urdf -o foo.yaml --epsilon 0.4
expect 2 'of a mesh' "$B" bar.off -o foo.yaml --epsilon 0.4
[ ! -e foo.yaml ] || fail "foo.yaml was made"
expect 2 'state one' "$V" robot arm.urdf arm.urdf --spheres one.yaml
# Files of another kind: what they are, and what takes them.
cp arm.urdf arm.xml
mkdir -p folder
while IFS='|' read -r code words arguments; do
  # shellcheck disable=SC2086
  expect "$code" "$words" "$V" robot $arguments
done <<'E'
2|bar.off is a mesh or a set of bodies: --spheres takes those of a robot's links|arm.urdf --spheres bar.off
2|bar.glb is a mesh or a set of bodies: --spheres takes|arm.urdf --spheres bar.glb
2|arm.xml is a robot: --bodies takes it|arm.urdf --spheres arm.xml
2|arm.yaml is a file of spheres: --spheres takes it|arm.urdf --bodies arm.yaml
2|bar.off is a mesh or a set of bodies: --bodies takes a robot|arm.urdf --bodies bar.off
2|bar.off is a mesh or a set of bodies: bound-verify cover|arm.urdf bar.off
2|bar.off is a mesh or a set of bodies: bound-verify cover|bar.off --spheres arm.yaml
2|arm.yaml is a file of spheres: the robot comes first|arm.yaml arm.urdf
2|folder is a mesh or a set of bodies: name the robot in it, as in folder/robot.urdf|arm.urdf folder
3|shapes are to be spheres; this is a mesh.* meshes are judged as RESULT|arm.urdf --spheres arm.urdf
E
# Nothing that was asked for is passed over.
for option in '--epsilon 1%' --prepare --raw '--max-work 1'; do
  # shellcheck disable=SC2086
  expect 2 "${option%% *}" "$V" robot arm.urdf --spheres one.yaml $option
done
sed '/hand:/,$d' one.yaml >base.yaml
# A link without spheres is uncovered, and near to nothing.
shows 1 "^refuted: 1 sphere holds 0 of 2 links; .* 0 links none is farther than 0.1; uncovered, without a sphere: 'hand'" "$V" robot arm.urdf --spheres base.yaml --epsilon 0.1 --report base.json
json base.json "r['uncovered'] == ['hand'] and 'distance' not in r['links'][1]['claims']"
shows 1 "^link 'hand': refuted: uncovered: it has no spheres$" "$V" robot arm.urdf --spheres base.yaml --epsilon 0.1
# A link that has no shape but a point is none that could be covered, and that is said.
sed '/<joint/i <link name="dot"><collision><geometry><sphere radius="0"/></geometry></collision></link>' arm.urdf |
  sed '/<joint/a <joint name="k" type="fixed"><parent link="base"/><child link="dot"/></joint>' >dot.urdf
expect 0 "link 'dot' has no shape but points: nothing of it is judged" "$V" robot dot.urdf arm.yaml --report dot.json
json dot.json "r['verdict'] == 'verified' and r['uncovered'] == [] and len(r['links']) == 2"
sed '/<joint/i <link name="drawn"><visual><geometry><box size="1 1 1"/></geometry></visual></link>' arm.urdf |
  sed '/<joint/a <joint name="k" type="fixed"><parent link="base"/><child link="drawn"/></joint>' >drawn.urdf
expect 0 "link 'drawn' has no collision shape, only visual ones: nothing of this is judged" "$V" robot drawn.urdf arm.yaml
# A file of ours that is cut at the end of whatever line is no set with fewer spheres; nor one with others in it.
for file in arm.yaml arm.xrdf; do
  [ "$(grep -c radius: $file)" -gt 3 ] || fail "$file has few spheres"
  n=1
  while [ $n -lt "$(wc -l <$file)" ]; do
    head -n $n $file >"cut.${file##*.}"
    expect 3 "cut.${file##*.}" "$V" robot arm.urdf "cut.${file##*.}"
    n=$((n + 1))
  done
done
head -n $((n - 2)) arm.xrdf >cut.xrdf
expect 3 'cut.xrdf:[0-9]*: [0-9]* spheres are stated, and [0-9]* are here: is the file cut?' "$V" robot arm.urdf cut.xrdf
sed 's/^\(# spheres in this file:\).*/\1 many/' arm.yaml >many.yaml
expect 3 'many.yaml:[0-9]*: the number of spheres is to be stated here' "$V" robot arm.urdf many.yaml
# Of others' files: a sphere without its end, a link without its list, a link that is named.
sed '$d' one.yaml >open.yaml
expect 3 'open.yaml:[0-9]*: .*is the file cut' "$V" robot arm.urdf --spheres open.yaml
sed '/hand:/q' one.yaml >open.yaml
expect 3 "open.yaml:8: link 'hand': a list of spheres is expected (is the file cut?)" "$V" robot arm.urdf --spheres open.yaml
sed 's/^    collision_spheres:/    collision_link_names: [base, hand]\n&/; /hand:$/,$d' one.yaml >named.yaml
expect 1 "collision_link_names names 'hand', without a sphere here: is the file cut" "$V" robot arm.urdf --spheres named.yaml
# Spherised URDF; and shapes of it that are no spheres.
sed 's|<mesh filename="bar.off"/>|<sphere radius="9"/>|; s|<box size="0.1 0.1 1"/>|<sphere radius="0.6"/>|' arm.urdf >spheres.urdf
shows 0 '^verified' "$V" robot arm.urdf --spheres spheres.urdf
sed 's|<mesh filename="bar.off"/>|<sphere radius="9"/>|; s|<box size="0.1 0.1 1"/>|<sphere radius="0.6"/>|' dot.urdf >dots.urdf
expect 0 "link 'dot' has no shape but points: nothing of it is judged" "$V" robot dot.urdf --bodies dots.urdf
expect 3 'are to be spheres' "$V" robot arm.urdf --spheres arm.urdf
# Frames elsewhere: at other values of the joints than 0, and under a root of another name.
cat >turning.urdf <<'U'
<robot name="r">
  <link name="base"/>
  <link name="b"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="c"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <joint name="j" type="revolute"><parent link="base"/><child link="b"/><origin xyz="0 0 1"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="k" type="revolute"><parent link="b"/><child link="c"/><limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="j" multiplier="2"/></joint>
</robot>
U
sed 's/<box size="0.2 0.2 0.2"/<sphere radius="0.3"/' turning.urdf >turning-spheres.urdf
shows 0 '^verified' "$V" robot turning.urdf --spheres turning-spheres.urdf
sed '/<link name="base"/d; /name="j"/d; s/<mimic.*>/<\/joint>/; s/<joint name="k".*//' turning-spheres.urdf | sed '/<link name="c"/d' >bare.urdf
shows 1 "link 'c': refuted: uncovered: it has no spheres" "$V" robot turning.urdf --spheres bare.urdf
while IFS='|' read -r edit words; do
  sed "$edit" turning-spheres.urdf >moved.urdf
  cmp -s moved.urdf turning-spheres.urdf && fail "nothing was changed by $edit"
  expect 3 "moved.urdf:[0-9]*: the frame of link '$words" "$V" robot turning.urdf --spheres moved.urdf
done <<'E'
s/axis xyz="0 0 1"/axis xyz="1 0 0"/|b' is not where the robot has it: joint 'j' has another axis
s/name="j" type="revolute"/name="j" type="prismatic"/|b' is not where the robot has it: joint 'j' is of another type
s/multiplier="2"/multiplier="3"/|c' is not where the robot has it: joint 'k' mimics in another way
s/"base"/"world"/; s/xyz="0 0 1"\/><axis/xyz="0 0 3"\/><axis/|b' is not where the robot has it: a step beside joint 'j' is 2 away
E

# XRDF: the geometry that is meant, its buffers; SRDF.
xrdf() { # RADIUS BUFFER
  cat <<X
format: xrdf
format_version: 1.0
collision:
  geometry: large
  buffer_distance:
    base: $2
geometry:
  small:
    spheres:
      base:
        - center: [0, 0, 0]
          radius: 0.01
  large:
    spheres:
      base:
        - center: [2, 0.5, 0.5]
          radius: $1
      hand:
        - center: [0, 0, 0.4]
          radius: 3
X
}
xrdf 9 0 >robot.xrdf
shows 0 '^verified: 2 spheres hold 2 of 2 links' "$V" robot arm.urdf --spheres robot.xrdf
grep -q "^link 'base': verified: 1 sphere holds every triangle and the solid$" out.txt || fail "$(cat out.txt)"
xrdf 0.1 8.9 >robot.yaml
shows 0 '^verified' "$V" robot arm.urdf --spheres robot.yaml
xrdf 0.1 0 >robot.xrdf
shows 1 "link 'base': refuted" "$V" robot arm.urdf --spheres robot.xrdf
xrdf 9 0 | sed 's/geometry: large/geometry: huge/' >bad.xrdf
expect 3 "bad.xrdf:4: there is no geometry 'huge'" "$V" robot arm.urdf --spheres bad.xrdf
xrdf 9 0 | sed 's/1\.0/7/' >bad.xrdf
expect 3 'bad.xrdf:2: .*format_version' "$V" robot arm.urdf --spheres bad.xrdf
xrdf 9 0 | sed '/^collision/,/base: 0/d' >bad.xrdf
expect 3 'which geometry' "$V" robot arm.urdf --spheres bad.xrdf
xrdf 9 0 | sed 's/^  large:/&\n    capsules: {}/' >bad.xrdf
expect 3 "bad.xrdf:14: .*no 'capsules'" "$V" robot arm.urdf --spheres bad.xrdf
xrdf -9 0 >bad.xrdf
expect 3 'bad.xrdf:16: .*above 0' "$V" robot arm.urdf --spheres bad.xrdf
printf 'format: xrdf\nformat_version: 1.0\n' >bad.xrdf
expect 3 'as XRDF has them' "$V" robot arm.urdf --spheres bad.xrdf
srdf() { # RADIUS
  cat <<X
<robot name="arm">
  <group name="all"/>
  <link_sphere_approximation link="base">
    <sphere center="2 0.5 0.5" radius="$1"/>
  </link_sphere_approximation>
  <link_sphere_approximation link="hand">
    <sphere center="0 0 0.4" radius="3"/>
  </link_sphere_approximation>
</robot>
X
}
srdf 9 >robot.srdf
shows 0 '^verified: 2 spheres hold 2 of 2 links' "$V" robot arm.urdf --spheres robot.srdf
srdf 0 >robot.srdf
shows 1 "link 'base': refuted: uncovered: it has no spheres" "$V" robot arm.urdf --spheres robot.srdf
srdf -1 >bad.srdf
expect 3 'bad.srdf:4: .*negative' "$V" robot arm.urdf --spheres bad.srdf
srdf nine >bad.srdf
expect 3 'bad.srdf:4: ' "$V" robot arm.urdf --spheres bad.srdf
srdf 9 | sed 's/link="hand"/link="base"/' >bad.srdf
expect 3 "bad.srdf:6: .*has one already" "$V" robot arm.urdf --spheres bad.srdf
srdf 9 | sed 's/link="hand"/link="hnad"/' >bad.srdf
expect 3 "bad.srdf:6: .*no link 'hnad'" "$V" robot arm.urdf --spheres bad.srdf
srdf 9 | sed 's/<sphere center="0 0 0.4"/<box size="1 1 1"/' >bad.srdf
expect 3 'bad.srdf:7: .*<sphere> is expected' "$V" robot arm.urdf --spheres bad.srdf
srdf 9 | head -5 >bad.srdf
expect 3 'bad.srdf' "$V" robot arm.urdf --spheres bad.srdf
echo '<robot name="arm"/>' >bad.srdf
expect 3 'as SRDF has them' "$V" robot arm.urdf --spheres bad.srdf

# A cylinder is held by way of a polytope round it: what that adds is taken off epsilon. What is plainly missed is refuted.
echo '<robot name="can"><link name="can"><collision><geometry><cylinder radius="0.09" length="0.2"/></geometry></collision></link></robot>' >can.urdf
expect 0 '' "$B" can.urdf -o can.yaml --bodies spheres --epsilon 0.04 --effort fast --no-cache --report can.json
json can.json "r['reach_upper'] <= 0.04"
shows 0 '^verified' "$V" robot can.urdf --spheres can.yaml
sed 's/radius: [0-9.]*/radius: 0.001/' can.yaml >tiny.yaml
cmp -s can.yaml tiny.yaml && fail "no radius was made smaller"
shows 1 "refuted: its point (.*), of a shape without triangles, is in none of its [0-9]* spheres" "$V" robot can.urdf --spheres tiny.yaml
expect 1 'up to 0.00045.* farther: allow an epsilon above that' "$B" can.urdf -o fine.yaml --bodies spheres --epsilon 0.0004 --no-cache

# What a reader of YAML would pass over: members that are given twice, other ones, documents, buffers of nobody.
while IFS='|' read -r text place; do
  # shellcheck disable=SC2059
  printf "$text" >bad.yaml
  expect 3 "bad.yaml:$place" "$V" robot arm.urdf --spheres bad.yaml
done <<'E'
collision_spheres:\n  base:\n    - center: [0, 0, 0]\n      radius: 1\n      radius: 5\n|5: 'radius' is there already
collision_spheres:\n  base:\n    - center: [0, 0, 0]\n      radius: 1\ncollision_spheres:\n  hand: []\n|5: 'collision_spheres' is there already
collision_spheres:\n  base:\n    - center: [0, 0, 0]\n      radius: 1\n---\ncollision_spheres:\n  hand: []\n|[67]: a second document
collision_spheres:\n  base:\n    - center: [0, 0, 0]\n      radius: 1\n      offset: 3\n|5: .*no 'offset'
collision_sphere_buffer: {bsae: 1}\ncollision_spheres:\n  base:\n    - center: [0, 0, 0]\n      radius: 1\n|1: a buffer of link 'bsae'
collision_spheres:\n  base:\n    - center: [0, 0, 0]\n      radius:\n|5: a radius must be a number
geometry:\n  g:\n    spheres:\n      base: []\n| an XRDF says
E
# Links that cuRobo does not look at have no spheres; a file that may be cut, and one of another robot, are noted.
printf 'collision_link_names: [hand]\ncollision_spheres:\n  base:\n    - center: [2, 0.5, 0.5]\n      radius: 9\n  hand:\n    - center: [0, 0, 0]\n      radius: 9' >named.yaml
shows 1 "link 'base': refuted: uncovered: it has no spheres" "$V" robot arm.urdf --spheres named.yaml
expect 1 "the spheres of 'base' are none: collision_link_names does not name them" "$V" robot arm.urdf --spheres named.yaml
expect 1 'does not end with a line break: is it cut' "$V" robot arm.urdf --spheres named.yaml
srdf 9 | sed 's/robot name="arm"/robot name="panda"/' >other.srdf
expect 0 "says that it is of robot 'panda'; this one is 'arm'" "$V" robot arm.urdf --spheres other.srdf
# The number of all spheres is looked at below something, too, and behind a byte order mark; names are words.
{ echo 'robot_cfg:'; echo '  kinematics:'; sed 's/^/    /' arm.yaml; } >deep.yaml
expect 0 '' "$V" robot arm.urdf --spheres deep.yaml
sed 's/# spheres in this file: /&9/' deep.yaml >cut.yaml
expect 3 'cut.yaml:[0-9]*: .*spheres' "$V" robot arm.urdf --spheres cut.yaml
{ printf '\357\273\277# spheres in this file: 7\n'; grep -v '^#' arm.yaml; } >cut.yaml
expect 3 'cut.yaml:1: .*spheres' "$V" robot arm.urdf --spheres cut.yaml
printf 'collision_link_names: &n\n  - base\n  - *n\ncollision_spheres:\n  base:\n    - center: [2, 0.5, 0.5]\n      radius: 4\n' >cyc.yaml
expect 3 'cyc.yaml:[0-9]*: collision_link_names: the name of a link' "$B" arm.urdf --repair cyc.yaml -o x.yaml --epsilon 4
sed 's/collision_link_names: \[hand\]/collision_link_names: [base]/' named.yaml >unnamed.yaml
expect 3 "unnamed.yaml:[0-9]*: spheres of link 'hand', which collision_link_names does not name" "$B" arm.urdf --repair unnamed.yaml -o x.yaml --epsilon 9
absent x.yaml

# Spheres that always meet though their links do not are told, and no longer with a smaller epsilon.
cat >near.urdf <<'U'
<robot name="near">
  <link name="base"><collision><geometry><box size="1 1 0.2"/></geometry></collision></link>
  <link name="turret"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <link name="arm"><collision><geometry><box size="1 1 0.2"/></geometry></collision></link>
  <joint name="a" type="revolute"><parent link="base"/><child link="turret"/><origin xyz="0 0 0.15"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="b" type="revolute"><parent link="turret"/><child link="arm"/><origin xyz="0 0 0.15"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
</robot>
U
expect 0 "spheres of 'base' and 'arm' meet in 1000 of 1000 .*--epsilons" "$B" near.urdf -o near.yaml --bodies spheres --epsilon 0.2 --effort fast --report near.json
json near.json "r['meeting'] == [{'links': ['base', 'arm'], 'of_thousand': 1000}]"
expect 0 "spheres of 'base' and 'arm' meet in 1000 of 1000" "$B" near.urdf -o mended.yaml --repair near.yaml --epsilon 0.2
expect 0 '' "$B" near.urdf -o near.yaml --bodies spheres --epsilon 0.03 --effort fast --report near.json
json near.json "r['meeting'] == []"
echo '<robot name="near"><disable_collisions link1="arm" link2="base" reason="Never"/></robot>' >near.srdf
expect 0 'its pairs: kaboum-pairs near.urdf --judge near.yaml --fail-on open' "$B" near.urdf -o near.yaml --bodies spheres --epsilon 0.2 --effort fast --pairs near.srdf --report near.json
json near.json "r['meeting'] == []"
finish
