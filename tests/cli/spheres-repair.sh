# Spheres of somebody's: what of a robot they miss, as a report and a page, and how they are repaired.
. "$(dirname "$0")/common.sh"
B=$BIN/bcd-decompose
V=$BIN/bound-verify

printf 'OFF\n8 12 0\n0 0 0\n4 0 0\n0 1 0\n4 1 0\n0 0 1\n4 0 1\n0 1 1\n4 1 1\n' >bar.off
for t in '0 2 1' '1 2 3' '4 5 6' '5 7 6' '0 1 4' '1 5 4' '2 6 3' '3 6 7' '0 4 2' '2 4 6' '1 3 5' '3 7 5'; do
  echo "3 $t" >>bar.off
done

cat >arm.urdf <<'U'
<robot name="arm">
  <link name="base"><collision><origin xyz="0.1 0.2 0.3" rpy="0.3 0.2 0.1"/><geometry><mesh filename="bar.off"/></geometry></collision></link>
  <link name="hand"><collision><origin xyz="0 0 1"/><geometry><box size="0.1 0.1 1"/></geometry></collision><collision><geometry><sphere radius="0.5"/></geometry></collision></link>
  <joint name="j" type="fixed"><parent link="base"/><child link="hand"/></joint>
</robot>
U
for file in arm.yaml arm.xrdf arm.srdf arm-spheres.urdf; do
  expect 0 '' "$B" arm.urdf -o "$file" --bodies spheres --epsilon 0.4 --effort fast
done
cat >one.yaml <<'Y'
robot_cfg:
  kinematics:
    collision_sphere_buffer: 0.05  # kept
    collision_spheres:
      base:
        - center: [2, 0.5, 0.5]
          radius: 0.95
      hand:
        - "center": [0, 0, 0]
          "radius": 0.55
Y
# What is missed is a place and a depth in the report; the page has it in red, and a row for each link.
shows 1 'refuted' "$V" robot arm.urdf one.yaml --report missed.json --page missed.html
json missed.json "len(r['links']) == 2 and all(len(l['missed']['point']) == 3 and l['missed']['depth'] > 0 for l in r['links'])"
json missed.json "r['links'][1]['missed']['depth'] >= r['links'][1]['depth']['lower']"
python3 - <<'P' || fail "the page's data"
import json, re
data = json.loads(re.search(r'<script id="data"[^>]*>(.*?)</script>', open("missed.html").read(), re.S)[1])
layers = {layer["name"]: layer for layer in data["layers"]}
assert layers["shapes, outside"]["colour"] == [0.85, 0.1, 0.1] and len(layers["shapes, outside"]["shapes"]) == 2
assert len(layers["spheres"]["shapes"]) == 2
rows = data["table"]["rows"]
assert [row[0] for row in rows] == ["base", "hand"] and all(row[2] == "refuted" and len(row) == len(data["table"]["head"]) for row in rows)
P
shows 0 '^verified' "$V" robot arm.urdf arm.yaml --page held.html
python3 - <<'P' || fail "nothing of what is held is outside"
import json, re
data = json.loads(re.search(r'<script id="data"[^>]*>(.*?)</script>', open("held.html").read(), re.S)[1])
assert [layer["name"] for layer in data["layers"]] == ["shapes, held", "spheres"]
P
expect 2 'shows spheres' "$V" robot arm.urdf arm.urdf --page x.html
expect 2 'html' "$V" robot arm.urdf arm.yaml --page x.png
# Spheres of another robot, of other frames, and elsewhere.
sed 's/base:/torso:/; s/hand:/head:/' one.yaml >another.yaml
expect 3 "another.yaml:5: .*another robot's" "$V" robot arm.urdf another.yaml
sed 's|<joint name="j" type="fixed">|&<origin xyz="0 0 1"/>|' arm-spheres.urdf >frames.urdf
expect 3 "frames.urdf:[0-9]*: the frame of link 'hand' is not where the robot has it" "$V" robot arm.urdf --spheres frames.urdf
sed 's/center: \[2, /center: [200, /' one.yaml >away.yaml
run_tool 1 "$V" robot arm.urdf away.yaml
grep -q "no sphere of 'base' comes near" err.txt || fail "spheres far away are not noted"
# Repaired, in the format of the input; what is not touched stays.
expect 0 'added' "$B" arm.urdf -o mended.yaml --repair one.yaml --epsilon 0.4 --effort fast --report mended.json
shows 0 '^verified' sh -c "$BIN/$(sed -n 's/^from the files alone: //p' err.txt)"
json mended.json "r['check'] == 'bound-verify robot arm.urdf --spheres mended.yaml --epsilon 0.4'"
expect 0 'added' "$B" arm.urdf -o mended.yaml --repair one.yaml --epsilon 10% --effort fast --links base
printed=$(sed -n 's/^from the files alone: //p' err.txt)
case $printed in *'--links base --epsilon 0.'*) ;; *) fail "the command: $printed" ;; esac
shows 0 '^verified' sh -c "$BIN/$printed"
expect 0 'added' "$B" arm.urdf -o mended.yaml --repair one.yaml --epsilon 0.4 --effort fast --report mended.json
shows 0 '^verified' "$V" robot arm.urdf mended.yaml
json mended.json "r['kept'] + r['grown'] + r['moved'] + r['shrunk'] == 2 and r['added'] > 0 and r['reach_upper'] <= 0.4"
grep -q 'collision_sphere_buffer: 0.05  # kept' mended.yaml || fail "the buffer is lost"
expect 0 'kept' "$B" arm.urdf -o same.yaml --repair arm.yaml --epsilon 0.4 --effort fast --report same.json
json same.json "r['grown'] + r['moved'] + r['shrunk'] + r['added'] == 0 and r['kept'] == r['spheres']"
cmp arm.yaml same.yaml
for file in arm.yaml arm.xrdf arm.srdf arm-spheres.urdf; do
  # One sphere smaller by a third.
  python3 - "$file" >"less-$file" <<'P'
import re, sys
done = []
def less(m):
    done.append(1)
    return m[1] + str(float(m[2]) * 0.7) if len(done) == 2 else m[0]
sys.stdout.write(re.sub(r'(radius"?(?:: |="))([0-9.e-]+)', less, open(sys.argv[1]).read()))
P
  shows 1 '^refuted' "$V" robot arm.urdf --spheres "less-$file"
  expect 0 'kept' "$B" arm.urdf -o "again-$file" --repair "less-$file" --epsilon 0.4 --effort fast --report again.json
  shows 0 '^verified' "$V" robot arm.urdf --spheres "again-$file"
  json again.json "r['grown'] + r['moved'] + r['shrunk'] + r['added'] in (1, 2) and r['added'] <= 1"
done
# Spheres that reach too far are made smaller; a link without spheres gets some.
sed 's/radius: 0.95/radius: 5/' one.yaml | sed '/hand:/,$d' >large.yaml
expect 0 'smaller\|moved' "$B" arm.urdf -o mended.yaml --repair large.yaml --epsilon 0.6 --effort fast
shows 0 '^verified' "$V" robot arm.urdf mended.yaml
expect 2 'format that they have' "$B" arm.urdf -o x.xrdf --repair arm.yaml --epsilon 0.4
expect 2 'bar.off is a mesh or a set of bodies; it takes spheres' "$B" arm.urdf -o x.yaml --repair bar.off --epsilon 0.4
expect 2 'repair' "$B" bar.off -o x.yaml --repair arm.yaml --epsilon 0.4
expect 2 'bodies' "$B" arm.urdf -o x.yaml --repair arm.yaml --epsilon 0.4 --bodies spheres
expect 2 'epsilon' "$B" arm.urdf -o x.yaml --repair arm.yaml
finish
