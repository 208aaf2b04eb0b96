# shellcheck shell=sh disable=SC2154
. "$(dirname "$0")/common.sh"
I=$BIN/kaboum-ik
joint() { # NAME PARENT CHILD XYZ AXIS LIMIT
  echo "<link name=\"$3\"/><joint name=\"$1\" type=\"revolute\"><parent link=\"$2\"/><child link=\"$3\"/>
<origin xyz=\"$4\"/><axis xyz=\"$5\"/><limit lower=\"-$6\" upper=\"$6\" effort=\"1\" velocity=\"1\"/></joint>"
}
{
  echo '<robot name="arm"><link name="base"/>'
  joint j1 base l1 '0 0 0.3' '0 0 1' 3
  joint j2 l1 l2 '0.1 0 0.1' '0 1 0' 3
  joint j3 l2 l3 '0 0 0.5' '0 1 0' 3
  joint j4 l3 l4 '0 0 0.2' '0 0 1' 6.5
  joint j5 l4 l5 '0 0 0.2' '0 1 0' 3
  joint j6 l5 l6 '0 0 0.1' '0 0 1' 3
  echo '</robot>'
} >arm.urdf
sed 's/0 0 0.2"/0.05 0.03 0.2"/' arm.urdf >offset.urdf

# Every printed configuration reaches the pose: by the program's own --pose-of, solved again.
expect 0 'spherical wrist, closed form: 4 solutions, 3 within' "$I" arm.urdf --pose-of 0.1,0.4,0.7,0.3,0.9,-0.2
[ "$(head -1 out.txt)" = j1,j2,j3,j4,j5,j6 ] || fail "no line of names: $(cat out.txt)"
cat >near.py <<'END'
# FILE Q: whether a line of the file has these values but for rounding
import sys
wanted = [float(x) for x in sys.argv[2].split(",")]
rows = [[float(x) for x in line.split("#")[0].split(",")] for line in open(sys.argv[1]).readlines()[1:]]
sys.exit(not any(max(abs(a - b) for a, b in zip(row, wanted)) < 1e-12 for row in rows))
END
python3 near.py out.txt 0.1,0.4,0.7,0.3,0.9,-0.2 || fail "the configuration itself is not among them: $(cat out.txt)"
cp out.txt first.csv
sed 1d first.csv | while read -r q; do
  expect 0 '' "$I" arm.urdf --pose-of "$q" --json
  python3 - out.txt <<'END' || echo "FAILED: $q is elsewhere" >elsewhere
import json, sys
p = json.load(open(sys.argv[1]))["pose"]
open("pose.txt", "a").write(",".join(f"{x:.6f}" for x in p) + "\n")
END
done
absent elsewhere
[ "$(sort -u pose.txt | wc -l)" = 1 ] || fail "several poses: $(cat pose.txt)"
shows 0 'j1,j2' "$I" arm.urdf --pose "$(head -1 pose.txt)"
shows 0 '5.7295' "$I" arm.urdf --pose-of 5.72957795131,20,40,17,50,-11 --degrees

# An arm that is only near its family is solved, but what is found need not be all.
grep -q '"complete": true' out.txt || expect 0 '' "$I" arm.urdf --pose-of 0.1,0.4,0.7,0.3,0.9,-0.2 --json
grep -q '"complete": true' out.txt || fail "an exact arm is complete: $(head -c 300 out.txt)"
sed '0,/0 1 0"/s//0 1 0.00001"/' arm.urdf >near.urdf
expect 0 '' "$I" near.urdf --pose-of 0.1,0.4,0.7,0.3,0.9,-0.2 --json
grep -q '"complete": false' out.txt || fail "an arm near its family is not complete: $(head -c 300 out.txt)"

# Whole turns, limits, references.
expect 0 'configurations within the limits, whole turns counted' "$I" arm.urdf --pose-of 0.1,0.4,0.7,0.3,0.9,-0.2 --copies
[ "$(wc -l <out.txt)" -gt "$(wc -l <first.csv)" ] || fail "--copies adds none"
expect 0 '' "$I" arm.urdf --pose-of 0.1,0.4,0.7,0.3,0.9,-0.2 --reference 0,0,0,-6,0,0
python3 near.py out.txt 0.1,0.4,0.7,-5.983185307179586,0.9,-0.2 || fail "not the turn near the reference: $(cat out.txt)"
sed 's/"-3"/"2.9"/' arm.urdf >narrow.urdf
expect 1 "outside the joints' limits only; see --ignore-limits" "$I" narrow.urdf --pose-of 0.1,0.4,0.7,0.3,0.9,-0.2
shows 0 '# outside the limits' "$I" narrow.urdf --pose-of 0.1,0.4,0.7,0.3,0.9,-0.2 --ignore-limits
shows 0 'singular: wrist' "$I" arm.urdf --pose-of 0.1,0.4,0.7,0.3,0,-0.2
expect 1 'the pose is out of reach' "$I" arm.urdf --pose 5,0,0,0,0,0,1

# A value on a limit is printed as one within it, in radians and in degrees.
cat >within.py <<'END'
import math, sys
lower, unit = float(sys.argv[2]), math.pi / 180 if sys.argv[3] == "degrees" else 1
values = [float(line.split(",")[2]) * unit for line in open(sys.argv[1]).readlines()[1:]]
sys.exit(not any(abs(x - lower) < 1e-9 for x in values) or min(values) < lower)
END
for limit in 0.70000000000049 0.7000000000017 0.71000000000033; do
  sed "/name=\"l3\"/,/limit/s/lower=\"-3\"/lower=\"$limit\"/" arm.urdf >edge.urdf
  expect 0 '' "$I" edge.urdf --pose-of 0.1,0.4,$limit,0.3,0.9,-0.2
  python3 within.py out.txt $limit radians || fail "outside the limit $limit: $(cat out.txt)"
  q=$(python3 -c "import math; print(','.join(repr(math.degrees(x)) for x in (0.1, 0.4, $limit, 0.3, 0.9, -0.2)))")
  expect 0 '' "$I" edge.urdf --pose-of "$q" --degrees
  python3 within.py out.txt $limit degrees || fail "outside the limit $limit in degrees: $(cat out.txt)"
done

# Without a closed form.
expect 0 'numeric, 100 starts' "$I" offset.urdf --pose-of 0.1,0.4,0.7,0.3,0.9,-0.2 --json
grep -q '"complete": false' out.txt || fail "said to be complete"
cp out.txt one.json
expect 0 '' "$I" offset.urdf --pose-of 0.1,0.4,0.7,0.3,0.9,-0.2 --json
cmp -s out.txt one.json || fail "twice the same, another answer"
expect 7 'no proof' "$I" offset.urdf --pose 5,0,0,0,0,0,1 --starts 3
expect 0 '' "$I" arm.urdf --numeric --pose-of 0.1,0.4,0.7,0.3,0.9,-0.2

# On a rail: some of infinitely many, none only where that is proved.
{
  echo '<robot name="railed"><link name="floor"/><joint name="rail" type="prismatic"><parent link="floor"/><child link="base"/>'
  echo '<axis xyz="0 1 0"/><limit lower="-1.5" upper="1.5" effort="1" velocity="1"/></joint>'
  sed 's/<robot name="arm">//' arm.urdf
} >rail.urdf
expect 0 'joints before the last six are redundant' "$I" rail.urdf --pose-of 0.7,0.1,0.4,0.7,0.3,0.9,-0.2
grep -q 'closed form' err.txt || fail "not in closed form: $(cat err.txt)"
grep -q '# free: rail' out.txt || fail "the rail is not said to be free: $(cat out.txt)"
expect 0 '' "$I" rail.urdf --pose-of 0.7,0.1,0.4,0.7,0.3,0.9,-0.2 --reference 0.7,0,0,0,0,0,0
python3 near.py out.txt 0.7,0.1,0.4,0.7,0.3,0.9,-0.2 || fail "not where the rail is: $(cat out.txt)"
expect 0 '' "$I" rail.urdf --pose 0.5,1.9,0.5,0,0,0,1 --json
grep -q '"complete": false' out.txt || fail "said to be complete"
expect 1 'the pose is out of reach' "$I" rail.urdf --pose 0.5,4,0.5,0,0,0,1
expect 7 'no proof' "$I" rail.urdf --pose 0.5,4,0.5,0,0,0,1 --numeric --starts 3
expect 0 '' "$I" rail.urdf --pose 0.5,4,0.5,0,0,0,1 --ignore-limits
sed 's/lower="-3"/lower="2.99"/' rail.urdf >stiff.urdf
expect 7 'no proof that there is none: joints before the last six' "$I" stiff.urdf --pose 0.5,0,0.5,0,0,0,1
expect 2 'for the 7 joints' "$I" rail.urdf --pose 0.5,0,0.5,0,0,0,1 --reference 0,0

# Where a joint is free, its family is given: the joint, its range, configurations within the limits.
{
  echo '<robot name="parallel"><link name="base"/>'
  joint j1 base l1 '0 0 0.089' '0 0 1' 6.28
  joint j2 l1 l2 '0 0.136 0' '0 1 0' 6.28
  joint j3 l2 l3 '0 -0.12 0.425' '0 1 0' 6.28
  joint j4 l3 l4 '0 0 0.392' '0 1 0' 6.28
  joint j5 l4 l5 '0 0.093 0' '0 0 1' 6.28
  joint j6 l5 l6 '0 0 0.095' '0 1 0' 6.28
  echo '</robot>'
} >parallel.urdf
cat >family.py <<'END'
# FILE JOINT VALUE [LOWER UPPER]: whether a family has the joint free at the value, all of it within
import json, math, sys
out, joint, value = json.load(open(sys.argv[1])), sys.argv[2], float(sys.argv[3])
lower, upper = (float(x) for x in sys.argv[4:6] or ("-6.28", "6.28"))
assert out["complete"], out.get("incomplete")
turns = [value + 2 * math.pi * k for k in (-1, 0, 1)]
found = False
for f in out["families"]:
    if f["free"] != [joint]:
        continue
    at = out["joints"].index(joint)
    for r in f["ranges"]:
        assert r["joint"] == joint and lower <= r["from"] <= r["to"] <= upper, r
        found = found or any(r["from"] - 2e-5 < t < r["to"] + 2e-5 for t in turns)
    for q in f["representatives"]:
        assert any(r["from"] <= q[at] <= r["to"] for r in f["ranges"]), (q, f["ranges"])
        assert q in [s["q"] for s in out["solutions"]]
assert found, out["families"]
END
for q in 0,0.7,-0.7,-1.5707963267948966,0,-1.5707963267948966 -1.04,-0.39,0.3,-1.81,0,1.86 0.3,0.5,1.0,1.5,0,1.6416; do
  expect 0 'a family: j6 is free, from' "$I" parallel.urdf --pose-of "$q" --json
  python3 family.py out.txt j6 "${q##*,}" || fail "not in a family: $q"
  # Its own value comes first where it is the reference.
  expect 0 '' "$I" parallel.urdf --pose-of "$q" --reference "$q"
  python3 near.py out.txt "$q" || python3 - out.txt "$q" <<'END' || fail "$q is not among them: $(cat out.txt)"
import sys
wanted = [float(x) for x in sys.argv[2].split(",")]
rows = [[float(x) for x in line.split("#")[0].split(",")] for line in open(sys.argv[1]).readlines()[1:]]
sys.exit(not any(max(abs(a - b) for a, b in zip(row, wanted)) < 1e-7 for row in rows))
END
done
# Limits: of the family what is within; where a limit is in the way of all of it, that is proved.
sed '/name="l6"/,/limit/s/lower="-6.28" upper="6.28"/lower="1.8" upper="1.9"/' parallel.urdf >part.urdf
expect 0 'j6 is free, from 1.8' "$I" part.urdf --pose-of -1.04,-0.39,0.3,-1.81,0,1.86 --json
python3 family.py out.txt j6 1.86 1.8 1.9 || fail "a part of a family: $(head -c 600 out.txt)"
sed '/name="l5"/,/limit/s/lower="-6.28" upper="6.28"/lower="0.1" upper="1"/' parallel.urdf >none.urdf
expect 1 "outside the joints' limits only" "$I" none.urdf --pose-of -1.04,-0.39,0.3,-1.81,0,1.86
shows 0 '# free: j6' "$I" none.urdf --pose-of -1.04,-0.39,0.3,-1.81,0,1.86 --ignore-limits
# Nearly singular: what rounding decides is not complete.
expect 0 'nearly singular' "$I" parallel.urdf --pose-of -1.04,-0.39,0.3,-1.81,1e-8,1.86 --json
grep -q '"complete": false' out.txt || fail "complete, nearly singular"
grep -q '"incomplete": "the pose is nearly singular' out.txt || fail "not said why it is not complete"

# Five axes: most poses are reached with another heading only.
{
  echo '<robot name="five"><link name="base"/>'
  joint j1 base l1 '0 0 0.2' '0 0 1' 3
  joint j2 l1 l2 '0 0 0' '0 1 0' 3
  joint j3 l2 l3 '0 0 0.19' '0 1 0' 3
  joint j4 l3 l4 '0 0 0.139' '0 1 0' 3
  joint j5 l4 l5 '0 0 0.3' '0 0 1' 3
  echo '</robot>'
} >five.urdf
expect 0 'five axes, closed form' "$I" five.urdf --pose-of 0.3,0.5,0.6,0.4,0.2
expect 1 'with another heading only, see --free-heading' "$I" five.urdf --pose 0.4,0.1,0.3,0.5,0.5,0.5,0.5
expect 0 'closed form' "$I" five.urdf --pose 0.4,0.1,0.3,0.5,0.5,0.5,0.5 --free-heading --json
python3 - <<'END' || fail "headings: $(head -c 400 out.txt)"
import json, subprocess, sys
out = json.load(open("out.txt"))
assert out["solutions"]
for s in out["solutions"]:
    assert all(abs(a - b) < 1e-9 for a, b in zip(s["pose"], [0.4, 0.1, 0.3])), s
assert any(abs(a - b) > 0.01 for a, b in zip(out["solutions"][0]["pose"][3:], out["pose"][3:]))
END
expect 2 'for arms with five axes' "$I" arm.urdf --pose-of 0.1,0.4,0.7,0.3,0.9,-0.2 --free-heading
# Names of joints that would be read as something else are in quotation marks.
sed 's/name="j1"/name="1"/; s/name="j2"/name="a,b"/' five.urdf >names.urdf
shows 0 '^"1","a,b",j3' "$I" names.urdf --pose-of 0.3,0.5,0.6,0.4,0.2

# A robot of a scene stands in its world, with the scene's limits and tools.
cat >stands.py <<'END'
import json
scene = json.load(open("cell.json"))
robot = scene["robots"][0]
robot["base"] = {"position": [1, 2, 3], "rpy": [0, 0, 0.5]}
robot["limits"] = {"j6": [-0.1, 0.1]}
robot["tools"] = [{"name": "flange", "link": "l6", "position": [0, 0, 0.25]}]
json.dump(scene, open("cell.json", "w"))
END
sed 's,<link name="base"/>,<link name="base"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>,' arm.urdf >stands.urdf
"$BIN/kaboum-scene" make cell.json --robot arm=stands.urdf --no-cache --quiet || fail "a scene of an arm"
python3 stands.py
pose_of() { sed -n '/"pose"/,/]/p' out.txt | tr -d ' \n' | sed 's/.*\[//; s/\].*//'; }
expect 0 '' "$I" --scene cell.json --tool flange --pose-of 0.1,0.4,0.7,0.3,0.9,0.05 --json
world=$(pose_of)
expect 0 '' "$I" --scene cell.json --tool flange --pose "$world"
python3 near.py out.txt 0.1,0.4,0.7,0.3,0.9,0.05 || fail "the scene's arm is elsewhere: $(cat out.txt)"
expect 0 '' "$I" arm.urdf --pose-of 0.1,0.4,0.7,0.3,0.9,0.05 --json
python3 - "$world" "$(pose_of)" <<'END' || fail "the world's pose is not that of base, arm and tool"
import math, sys
world, arm = ([float(x) for x in text.split(",")] for text in sys.argv[1:])
x, y, z, qx, qy, qz, qw = arm
at = [x + 0.5 * (qx * qz + qw * qy), y + 0.5 * (qy * qz - qw * qx), z + 0.25 * (1 - 2 * (qx * qx + qy * qy))]
c, s = math.cos(0.5), math.sin(0.5)
at = [1 + c * at[0] - s * at[1], 2 + s * at[0] + c * at[1], 3 + at[2]]
sys.exit(max(abs(a - b) for a, b in zip(at, world)) > 1e-9)
END
expect 1 "outside the joints' limits" "$I" --scene cell.json --pose-of 0.1,0.4,0.7,0.3,0.9,0.5
expect 2 "has no tool 'flang'; did you mean 'flange'" "$I" --scene cell.json --tool flang --pose 0,0,1
expect 2 "no robot 'leg'" "$I" --scene cell.json --robot leg --pose 0,0,1
expect 2 'excludes' "$I" arm.urdf --scene cell.json --pose 0,0,1

# What is wrong, and what to do.
expect 2 'Give --pose X,Y,Z,QX,QY,QZ,QW or --pose-of' "$I" arm.urdf
expect 2 'excludes' "$I" arm.urdf --pose 0,0,0,0,0,0,1 --pose-of 0,0,0,0,0,0
expect 2 "arm.urdf: there is no link 'l7'; it has 'base', 'l1'" "$I" arm.urdf --tip l7 --pose-of 0,0,0,0,0,0
expect 2 'is not between' "$I" arm.urdf --base l5 --tip l2 --pose-of 0
expect 2 "5 values for the 6 joints 'j1'" "$I" arm.urdf --pose-of 0,0,0,0,0
expect 2 'expected numbers with commas' "$I" arm.urdf --pose-of 0,x,0,0,0,0
expect 2 'pose: the quaternion has the length 2' "$I" arm.urdf --pose 0,0,0,0,0,0,2
expect 2 'pose: expected numbers with commas between' "$I" arm.urdf --pose nan,0,0,0,0,0,1
expect 2 'pose: 2 numbers; a pose is' "$I" arm.urdf --pose 0,1
expect 2 'of which robot' "$I" --pose 0,0,1
expect 2 'tool' "$I" arm.urdf --tool flange --pose 0,0,1
expect 3 'missing.urdf' "$I" missing.urdf --pose-of 0
expect 0 '' "$I" arm.urdf --pose-of 0.1,0.4,0.7,0.3,0.9,-0.2 --report ik.json --quiet
[ ! -s err.txt ] || fail "--quiet is not: $(cat err.txt)"
finish
