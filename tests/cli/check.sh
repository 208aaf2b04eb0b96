# shellcheck shell=sh disable=SC2154
# kaboum-scene and kaboum-check: scenes of files, free and other answers, what is refused.
. "$(dirname "$0")/common.sh"
mkdir meshes
slab 1 >meshes/cube.off
slab 3 >meshes/bar.off
link() { echo "<link name=\"$1\"><collision><geometry><mesh filename=\"meshes/$2.off\"/></geometry></collision></link>"; }
joint() {
  echo "<joint name=\"$1\" type=\"revolute\"><parent link=\"$2\"/><child link=\"$3\"/><origin xyz=\"$4\"/>
<axis xyz=\"0 0 1\"/><limit lower=\"-3\" upper=\"3\" effort=\"1\" velocity=\"1\"/></joint>"
}
echo "<robot name=\"arm\">$(link base cube)$(link upper bar)$(link tip cube)$(joint j1 base upper '0 0 2')$(joint j2 upper tip '5 0 0')</robot>" >arm.urdf
expect 0 '5 sets' "$BIN/kaboum-scene" make cell.json --robot arm=arm.urdf --object box=meshes/cube.off --inner --no-cache
[ -f cell/arm/upper.glb ] || fail "no set of the upper arm"
# The box is put where the tip reaches it when the arm is turned by about a quarter.
put() {
  python3 - "$@" <<'END' || fail "scene $*"
import json, sys
cell = json.load(open("cell.json"))
cell["objects"][0]["pose"] = {"position": [float(x) for x in sys.argv[2:5]]}
json.dump(cell, open(sys.argv[1], "w"), indent=1)
END
}
grep -q '"made_from"' cell.json || fail "no word of what sets were made from"
put free.json 20 0 2
put near.json 0 5 2
shows 0 '^free$' "$BIN/kaboum-check" free.json
shows 0 'nearest: arm/base and arm/tip, sets 4.123' "$BIN/kaboum-check" free.json --distance
shows 0 '^free$' "$BIN/kaboum-check" near.json --configuration 0,0
# The tip's own set has no inner one: nothing is certain.
shows 1 'arm/tip and box are within epsilon' "$BIN/kaboum-check" near.json --configuration 1.57,0
printf 'j1,j2\n0,0\n1.57,0\n0.5,0\n' >some.csv
shows 1 'configuration 2: arm/tip and box' "$BIN/kaboum-check" near.json --configurations some.csv
grep -q 'configuration 3: free' out.txt || fail "the third configuration is free"
# The same at once, from CSV and from an array of NumPy.
shows 1 '^2 of 3 configurations are free, 1 are not' "$BIN/kaboum-check" near.json --batch some.csv --verdicts free.txt
[ "$(tr -d '\n' <free.txt)" = 101 ] || fail "verdicts: $(cat free.txt)"
npy() {
  python3 - "$@" <<'END' || fail "array $*"
import struct, sys
name, shape, type = sys.argv[1:4]
values = [float(x) for x in (sys.argv[4] if len(sys.argv) > 4 else "0 0 1.57 0 0.5 0").split()]
order = len(sys.argv) > 5
code = {"f8": "d", "f4": "f", "i8": "q", "i4": "i"}[type.strip("'<>")] if type.startswith("'") else "f"
header = f"{{'descr': {type}, 'fortran_order': {order}, 'shape': {shape}, }}\n".encode()
body = struct.pack(f"<{len(values)}{code}", *(values if code in "df" else [int(x) for x in values]))
open(name, "wb").write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + body)
END
}
npy rows.npy '(3, 2)' "'<f8'"
shows 1 '^2 of 3 ' "$BIN/kaboum-check" near.json --batch rows.npy --verdicts free.npy --report batch.json
[ "$(tail -c 3 free.npy | od -An -tu1 | tr -d ' \n')" = 101 ] || fail "verdicts of an array"
[ $(($(wc -c <free.npy) % 64)) = 3 ] || fail "the header of an array is not aligned"
grep -q '"not_free": 1' batch.json || fail "no batch in the report"
npy rows.npy '(3, 2)' "'<f4'"
shows 1 '^2 of 3 ' "$BIN/kaboum-check" near.json --batch rows.npy
shows 0 '^3 of 3 ' "$BIN/kaboum-check" free.json --batch rows.npy
npy bad.npy '(4, 2)' "'<f4'"
expect 3 'other than 4 rows' "$BIN/kaboum-check" near.json --batch bad.npy
npy bad.npy '(6,)' "'<f8'"
expect 3 'a row for each' "$BIN/kaboum-check" near.json --batch bad.npy
npy bad.npy '(3, 2)' "'>f8'"
expect 3 'float32, float64, int32 or int64' "$BIN/kaboum-check" near.json --batch bad.npy
npy bad.npy '(3, 2)' "[('<f4', '<f4'), ('b', '<f4')]"
expect 3 'float32, float64, int32 or int64' "$BIN/kaboum-check" near.json --batch bad.npy
npy bad.npy '(2, 3)' "'<f8'"
expect 3 'bad.npy: 3 columns, and 2 are expected: j1, j2, in this order' "$BIN/kaboum-check" near.json --batch bad.npy
npy bad.npy '(3, 2)' "'<f8'" '0 0 0 0 nan 0'
expect 3 'bad.npy: row 3: a number that is not finite' "$BIN/kaboum-check" near.json --batch bad.npy
npy bad.npy '(0, 2)' "'<f8'" ''
expect 3 'bad.npy: the array has no rows' "$BIN/kaboum-check" near.json --batch bad.npy
cp bad.npy bad.npz
expect 3 'numpy.save' "$BIN/kaboum-check" near.json --batch bad.npz
# Whole numbers, and columns one after the other.
npy whole.npy '(2, 2)' "'<i8'" '0 0 1 0'
npy narrow.npy '(2, 2)' "'<i4'" '0 0 1 0'
npy turned.npy '(3, 2)' "'<f8'" '0 1.57 0.5 0 0 0' fortran
shows 1 '^2 of 3 ' "$BIN/kaboum-check" near.json --batch turned.npy --verdicts turned.txt
cmp -s free.txt turned.txt || fail "verdicts of columns one after the other: $(cat turned.txt)"
for file in whole.npy narrow.npy; do
  shows 0 '^2 of 2 ' "$BIN/kaboum-check" near.json --batch "$file"
done
npy bad.npy '(2, 2)' "'<i8'" '0 0 1e17 0'
expect 3 'row 2: a whole number beyond' "$BIN/kaboum-check" near.json --batch bad.npy
# Verdicts alone on standard output; margins are said.
"$BIN/kaboum-check" near.json --batch some.csv --verdicts - >verdicts.txt 2>said.txt
cmp -s free.txt verdicts.txt || fail "more than verdicts: $(cat verdicts.txt)"
grep -q '^2 of 3 configurations' said.txt || fail "no summary beside verdicts: $(cat said.txt)"
shows 0 'are not, with margins kept: ' "$BIN/kaboum-check" free.json --batch rows.npy --margin 0.01
expect 2 'needs --batch' "$BIN/kaboum-check" near.json --verdicts v.npy
# Motions between rows: from 0,0 to 1.57,0 into the box, and on to 0.5,0 out of it; or two and two.
shows 1 '^0 of 2 motions are free at every instant, 2 are not' "$BIN/kaboum-check" near.json --batch rows.npy --motions consecutive
printf 'j1,j2\n0,0\n0.5,0.1\n0.5,0\n3,0\n' >pairs.csv
shows 1 '^1 of 2 motions' "$BIN/kaboum-check" near.json --batch pairs.csv --motions pairs --verdicts motions.txt --report batch.json
[ "$(tr -d '\n' <motions.txt)" = 10 ] || fail "verdicts of motions: $(cat motions.txt)"
json batch.json 'r["batch"]["motions"] == 2 and r["batch"]["free"] == 1'
shows 0 '^2 of 2 motions' "$BIN/kaboum-check" free.json --batch rows.npy --motions consecutive --resolution 0.5
expect 3 'pairs.csv: .*even' sh -c "echo 0,0 >>pairs.csv; '$BIN/kaboum-check' near.json --batch pairs.csv --motions pairs"
expect 3 'one.csv: one row; a motion needs two' sh -c "echo 0,0 >one.csv; '$BIN/kaboum-check' near.json --batch one.csv --motions consecutive"
expect 2 'needs --batch' "$BIN/kaboum-check" near.json --motions pairs
expect 2 'motions' "$BIN/kaboum-check" near.json --batch rows.npy --motions every
expect 2 'resolution needs --path' "$BIN/kaboum-check" near.json --batch rows.npy --resolution 0.1
expect 2 'not for --batch' "$BIN/kaboum-check" near.json --batch rows.npy --distance
printf 'j1,j2\n0,0\n3,0\n' >through.csv
shows 1 'free until waypoint 1 + 0\.[34]' "$BIN/kaboum-check" near.json --path through.csv --report motion.json
grep -q '"outcome": "contact"' motion.json || fail "no outcome in the report"
# Waypoints are counted from 1 everywhere.
[ "$(grep -c '"waypoint": 1' motion.json)" = 2 ] || fail "waypoints in the report: $(cat motion.json)"
# Paths as others have them: ROS's and MoveIt's in YAML and JSON, cuRobo's, arrays; with times, when it touches.
cat >through.yaml <<'END'
header:
  stamp: {sec: 0, nanosec: 0}
  frame_id: ''
joint_names:
- j2
- j1
points:
- positions: [0.0, 0.0]
  velocities: []
  time_from_start: {sec: 1, nanosec: 0}
- positions:
  - 0
  - 3.0
  velocities: [0.0, 0.5]
  time_from_start:
    sec: 4
    nanosec: 0
---
END
shows 1 'free until waypoint 1 + 0\.[34].*arm/tip and box .* (free until 2\.[0-9]* s, in contact at 2\.[0-9]* s)' "$BIN/kaboum-check" near.json --path through.yaml --report motion.json
grep -q 'splines' err.txt || fail "no word of velocities: $(cat err.txt)"
json motion.json '2 < r["motion"]["free_until"]["time"] <= r["motion"]["contact"]["time"] < 3'
sed -n '/^joint_names/,/^---/p' through.yaml | sed '/---/d' | sed 's/^/  /' | sed '1i joint_trajectory:' >moveit.yml
cp moveit.yml moveit.txt
python3 -c 'import json
json.dump({"trajectory": [{"joint_trajectory": {"joint_names": ["j1", "j2"], "points": [
  {"positions": [0, 0], "time_from_start": 0.0}, {"positions": [3, 0], "time_from_start": 1.5}]}}]}, open("moveit.json", "w"))
json.dump({"position": [[[0, 0], [3, 0]]], "joint_names": ["j1", "j2"], "interpolation_dt": 0.02}, open("curobo.json", "w"))'
npy vamp.npy '(2, 2)' "'<f4'" '0 0 3 0'
npy batch.npy '(1, 2, 2)' "'<f8'" '0 0 3 0'
printf 'time,j1,j2\n0,0,0\n1.5,3,0\n' >timed.csv
for file in moveit.yml moveit.txt moveit.json curobo.json vamp.npy batch.npy timed.csv; do
  shows 1 'free until waypoint 1 + 0\.[34]' "$BIN/kaboum-check" near.json --path $file
  shows 0 'free at every instant' "$BIN/kaboum-check" free.json --path $file
done
expect 3 'through.yaml: joint_names: the robot has no joint .k1.' sh -c "sed -i 's/^- j1/- k1/' through.yaml; '$BIN/kaboum-check' near.json --path through.yaml"
expect 3 'through.yaml: joint_names: no column for joint .j1.' sh -c "sed -i '/^- k1/d; /3.0/d; s/0.0, 0.0/0.0/' through.yaml; '$BIN/kaboum-check' near.json --path through.yaml"
expect 3 'bad.yaml: line [0-9]*, column [0-9]*: not YAML' sh -c "printf 'points:\n- [\n' >bad.yaml; '$BIN/kaboum-check' near.json --path bad.yaml"
expect 3 'bad.yaml: 2 documents' sh -c "cat moveit.yml >bad.yaml; echo --- >>bad.yaml; cat moveit.yml >>bad.yaml; '$BIN/kaboum-check' near.json --path bad.yaml"
python3 -c 'names = "abcdefgh"
print("a: &a [1]", *(f"{y}: &{y} [" + ",".join(["*" + x] * 9) + "]" for x, y in zip(names, names[1:])), sep="\n")' >bad.yaml
expect 3 'bad.yaml: line [0-9]*: aliases stand for' "$BIN/kaboum-check" near.json --path bad.yaml
npy bad.npy '(2, 2, 2)' "'<f8'" '0 0 3 0 0 0 3 0'
expect 3 'bad.npy: an array of three dimensions: 2 paths' "$BIN/kaboum-check" near.json --path bad.npy
printf 'j1,j2\n1.57,0\n3,0\n' >inside.csv
shows 1 'not free from the first waypoint on; at waypoint 1' "$BIN/kaboum-check" near.json --path inside.csv
for how in '--path through.csv' '--configuration 1.57,0' '--configuration 1.57,0 --distance'; do
  # shellcheck disable=SC2086
  run_tool 1 "$BIN/kaboum-check" near.json $how --quiet
  [ ! -s out.txt ] || fail "prints with --quiet: $how: $(cat out.txt)"
done
expect 2 '2 values are expected, one for each of j1,j2, not 1' "$BIN/kaboum-check" near.json --configuration 0
expect 2 'not 3' "$BIN/kaboum-check" near.json --configuration 0,0,0
# What says how a configuration is meant is not ignored without one: another state would be looked at.
expect 2 'joint needs --path, --configuration' "$BIN/kaboum-check" near.json --joint j2=1.5
expect 2 'degrees needs' "$BIN/kaboum-check" near.json --degrees
expect 2 'resolution needs --path' "$BIN/kaboum-check" near.json --configuration 0,0 --resolution 0.1
# Points of a sensor: where the tip comes when the arm is turned by a quarter, point 3 of 200.
python3 - <<'END'
import struct
points = [(30 + i, -40, 7) for i in range(200)]
points[2] = (-0.5, 5.5, 2.5)
lines = lambda ps: "".join("%r %r %r\n" % p for p in ps)
open("scan.xyz", "w").write("x y z\n" + lines(points))
open("far.xyz", "w").write(lines(points[3:]))
header = "VERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 20\nHEIGHT 10\nVIEWPOINT 0 0 %d 1 0 0 0\nPOINTS 200\nDATA binary\n"
body = b"".join(struct.pack("<fffI", *p, 7) for p in points)
open("scan.pcd", "wb").write((header % 0).encode() + body)
open("view.pcd", "wb").write((header % 1).encode() + body)
open("cut.pcd", "wb").write((header % 0).encode() + body[:-1])
open("hole.pcd", "wb").write((header % 0).encode() + struct.pack("<fffI", float("nan"), 0, 0, 0) + body[16:])
open("scan.ply", "wb").write(b"ply\nformat binary_little_endian 1.0\nelement vertex 200\nproperty float x\nproperty float y\nproperty float z\nproperty uint c\nend_header\n" + body)
END
for cloud in scan.xyz scan.pcd scan.ply; do
  shows 0 '^free$' "$BIN/kaboum-check" free.json --cloud $cloud --cloud-radius 0.1
  shows 1 'arm/tip and scan (point 3) ' "$BIN/kaboum-check" free.json --cloud $cloud --cloud-radius 0.1 --configuration 1.57,0 --report cloud.json
  shows 1 'free until waypoint 1 + 0\.[34].*arm/tip and scan (point 3)' "$BIN/kaboum-check" free.json --path through.csv --cloud $cloud --cloud-radius 0.1
  shows 1 '^2 of 3 configurations' "$BIN/kaboum-check" free.json --batch some.csv --cloud $cloud --cloud-radius 0.1
  shows 1 '^0 of 2 motions' "$BIN/kaboum-check" free.json --batch some.csv --motions consecutive --cloud $cloud --cloud-radius 0.1
done
json cloud.json 'r["clouds"][0]["points"] == 200 and r["configurations"][0]["contacts"][0]["point"] == 3'
grep -q 'scan.ply: 200 points from \[-0.5, -40, 2.5\] to \[229, 5.5, 7\] m' err.txt || fail "no word of the cloud: $(cat err.txt)"
shows 0 '^free$' "$BIN/kaboum-check" free.json --cloud far.xyz --cloud-radius 0.1 --configuration 1.57,0 --preview cloud.png
shows 0 '^free$' "$BIN/kaboum-check" free.json --cloud scan.xyz --cloud-radius 0.1 --configuration 1.57,0 --cloud-allow arm/tip
shows 0 '^free$' "$BIN/kaboum-check" free.json --cloud scan.xyz --cloud-radius 0.1 --configuration 1.57,0 --cloud-pose 0,0,9
shows 1 'scan (point 3)' "$BIN/kaboum-check" free.json --cloud far.xyz --cloud scan.xyz --cloud-radius 0.1 --configuration 1.57,0
shows 1 'arm/tip and scan (point 3) are within the margin' "$BIN/kaboum-check" free.json --cloud scan.xyz --cloud-radius 0.1 --configuration 1.57,0 --cloud-pose 0,0,3 --margin scan=4
expect 2 'needs --cloud-radius' "$BIN/kaboum-check" free.json --cloud scan.xyz
expect 2 'need --cloud' "$BIN/kaboum-check" free.json --cloud-radius 1
expect 2 'cloud-radius' "$BIN/kaboum-check" free.json --cloud scan.xyz --cloud-radius 0
expect 2 "no link of this name.*'arm/tip'" "$BIN/kaboum-check" free.json --cloud scan.xyz --cloud-radius 1 --cloud-allow arm/tap
expect 2 "cloud 'box': the scene has something of this name" sh -c "cp scan.xyz box.xyz; '$BIN/kaboum-check' free.json --cloud box.xyz --cloud-radius 1"
expect 2 'own predicates' "$BIN/kaboum-check" free.json --cloud scan.xyz --cloud-radius 1 --engine fcl
expect 3 'view.pcd: its VIEWPOINT' "$BIN/kaboum-check" free.json --cloud view.pcd --cloud-radius 0.1
shows 1 'scan (point 3)\|view (point 3)' "$BIN/kaboum-check" free.json --cloud view.pcd --cloud-radius 0.1 --cloud-pose 0,0,0 --configuration 1.57,0
expect 3 'cut.pcd: the PCD header states 200 points' "$BIN/kaboum-check" free.json --cloud cut.pcd --cloud-radius 0.1
expect 3 'hole.pcd: point 1 has a coordinate that is NaN' "$BIN/kaboum-check" free.json --cloud hole.pcd --cloud-radius 0.1
shows 1 'hole (point 3)' "$BIN/kaboum-check" free.json --cloud hole.pcd --cloud-radius 0.1 --cloud-drop-invalid --configuration 1.57,0
grep -q '1 without finite coordinates are left out' err.txt || fail "no word of points left out: $(cat err.txt)"
# Margins: the tip is 14 from the box.
shows 0 '^free, with margins kept: 13.9$' "$BIN/kaboum-check" free.json --margin 13.9 --report margin.json
grep -q '"margins": "13.9"' margin.json || fail "no margins in the report"
shows 1 'arm/tip and box are within the margin of 14.1: no farther apart than 14' "$BIN/kaboum-check" free.json --margin 14.1
shows 1 'arm/tip and box' "$BIN/kaboum-check" free.json --margin box=15 --report margin.json
grep -q '"margin": 15' margin.json || fail "no margin in the report"
shows 0 '^free, with margins kept: 15; arm,box=13$' "$BIN/kaboum-check" free.json --margin 15 --margin arm,box=13
shows 0 '^free, ' "$BIN/kaboum-check" free.json --margin 15 --margin 'arm, box=13'
expect 2 "'box,arm' gives 15 to box and arm/base, which another one gives 13" "$BIN/kaboum-check" free.json --margin arm,box=13 --margin box,arm=15
expect 2 "'box,box' names one thing twice" "$BIN/kaboum-check" free.json --margin box,box=13
expect 2 "a link is named with its robot: 'arm/tip'" "$BIN/kaboum-check" free.json --margin tip=13
expect 2 "no object, robot or link 'arm/tpi'; did you mean 'arm/tip'" "$BIN/kaboum-check" free.json --margin arm/tpi=1
expect 2 'at least 0' "$BIN/kaboum-check" free.json --margin=-1
# Lengths with units.
shows 0 '^free, with margins kept: 15m; arm,box=13900mm$' "$BIN/kaboum-check" free.json --margin 15m --margin arm,box=13900mm
shows 1 'arm/tip and box are within the margin of 14.1: ' "$BIN/kaboum-check" free.json --margin 1410cm
shows 1 'scan (point 3)' "$BIN/kaboum-check" free.json --cloud scan.xyz --cloud-radius 10cm --configuration 1.57,0 --report cloud.json
json cloud.json "r['clouds'][0]['radius'] == 0.1"
for option in --margin --cloud-radius --resolution; do
  expect 2 "${option}.*there is no diagonal" "$BIN/kaboum-check" free.json --cloud scan.xyz $option 1%
done
expect 2 'arm=1% (there is no diagonal' "$BIN/kaboum-check" free.json --margin arm=1%
printf 'j1,j2\n0,0\n-3,1\n' >away.csv
shows 0 'free at every instant' "$BIN/kaboum-check" near.json --path away.csv
shows 0 'free at every instant' "$BIN/kaboum-check" near.json --path away.csv --robot arm --resolution 1mm
shows 7 'undecided' "$BIN/kaboum-check" near.json --path through.csv --max-intervals 1
# Degrees, limits, names.
shows 1 'within epsilon' "$BIN/kaboum-check" near.json --configuration 90,0 --degrees
expect 2 'limits' "$BIN/kaboum-check" near.json --configuration 4,0
shows 0 free "$BIN/kaboum-check" near.json --configuration=-3.5,0 --ignore-limits
expect 2 "no robot 'arn'; did you mean 'arm'" "$BIN/kaboum-check" near.json --robot arn
expect 2 'excludes' "$BIN/kaboum-check" near.json --path away.csv --configuration 0,0
# Pictures.
expect 1 '' "$BIN/kaboum-check" near.json --configuration 1.57,0 --preview near.png
expect 1 '' "$BIN/kaboum-check" near.json --path through.csv --preview motion.png
for f in near.png motion.png; do head -c 4 $f | grep -q PNG || fail "$f is no picture"; done
expect 2 'a PNG is written' "$BIN/kaboum-check" near.json --preview near.jpg
absent near.jpg
expect 2 'would overwrite\|same file\|input' "$BIN/kaboum-check" near.json --report near.json
# Things in regions.
slab 1 | awk 'NR > 2 && NR <= 10 { print $1 * 9 - 4, $2 * 9 - 4, $3 * 9 - 4; next } { print }' >meshes/room.off
expect 0 '' "$BIN/kaboum-scene" make room.json --robot arm=arm.urdf --object box=meshes/cube.off --region room=meshes/room.off --no-cache
python3 -c '
import json, sys
room = json.load(open("room.json"))
room["objects"][0]["pose"] = {"position": [-3, -3, -3]}
json.dump(room, sys.stdout)' >in.json
shows 0 'box in room: inside' "$BIN/kaboum-check" in.json --inside box=room --report in-report.json
grep -q '"answer": "inside"' in-report.json || fail "no inclusion in the report"
shows 1 'arm in room: not certainly inside' "$BIN/kaboum-check" in.json --inside arm=room
shows 0 'arm/base in room: inside' "$BIN/kaboum-check" in.json --inside arm/base=room --inside box=room
# At every instant of a motion: the arm reaches out of the room.
shows 0 'arm/base in room: inside at every instant' "$BIN/kaboum-check" in.json --path away.csv --inside arm/base=room --inside box=room
shows 1 'arm/tip in room: not certainly inside from waypoint 1 + ' "$BIN/kaboum-check" in.json --path away.csv --inside arm/tip=room --resolution 0.01 --report in-report.json
grep -q '"inside_until"' in-report.json || fail "no place where it leaves in the report"
# The same scene as YAML.
expect 2 'cell, where the sets of cell.yaml go, is there already' "$BIN/kaboum-scene" make cell.yaml --object box=meshes/cube.off
expect 0 '' "$BIN/kaboum-scene" make cell.yaml --force --robot arm=arm.urdf --object box=meshes/cube.off --inner --no-cache
grep -q '^robots:' cell.yaml || fail "no YAML: $(head -5 cell.yaml)"
shows 1 'arm/base and box are within epsilon' "$BIN/kaboum-check" cell.yaml --configuration 0,0
expect 3 'bad.yaml: line 1, column 1: ' sh -c "{ echo 'thing: 1'; cat cell.yaml; } >bad.yaml; '$BIN/kaboum-check' bad.yaml"
expect 3 'bad.yaml: line [0-9]*, column [0-9]*: not YAML' sh -c "{ cat cell.yaml; echo '  ]'; } >bad.yaml; '$BIN/kaboum-check' bad.yaml"
sed 's/"name": "arm",/"name": "arm", "links_without_set": ["tip"],/' in.json >partly.json
python3 -c 'import json; s = json.load(open("partly.json")); r = s["robots"][0]
r["links"] = [l for l in r["links"] if l["link"] != "tip"]; json.dump(s, open("partly.json", "w"))'
expect 3 "link 'tip' has shapes but no set, so it is not known whether it is inside" "$BIN/kaboum-check" partly.json --inside arm=room
expect 2 "no region 'rom'; did you mean 'room'" "$BIN/kaboum-check" in.json --inside box=rom
expect 2 "no object, link or robot 'bx'" "$BIN/kaboum-check" in.json --inside bx=room
expect 2 'are for configurations' "$BIN/kaboum-check" near.json --path away.csv --resting
# Files that are not what they were.
cp cell/box.glb kept.glb
cp cell/box-inner.glb cell/box.glb
expect 3 'line [0-9]*, column [0-9]*: cell/box.glb is not the file' "$BIN/kaboum-check" near.json
cp kept.glb cell/box.glb
# Nor what they were made from.
cp meshes/cube.off kept.off
slab 2 >meshes/cube.off
expect 3 'meshes/cube.off has changed since cell/.*.glb was made from it' "$BIN/kaboum-check" near.json
cp near.json old.json
python3 - <<'END'
import json
old = json.load(open("old.json"))
old["robots"][0]["home"] = {"j1": 0.5}
old["robots"][0]["never_in_contact"] = {"proved_for": "", "pairs": []}
json.dump(old, open("old.json", "w"))
END
expect 0 'never_in_contact.*is taken out' "$BIN/kaboum-scene" update old.json --no-cache
grep -q '"j1": 0.5' old.json || fail "the update loses what was edited"
shows 0 '^free$' "$BIN/kaboum-check" old.json
expect 0 'nothing is out of date' "$BIN/kaboum-scene" update old.json --no-cache
# A hash that was put there by hand does not make a set one of the mesh as it is.
python3 - <<'END'
import hashlib, json
hand = json.load(open("near.json"))
digest = hashlib.sha256(open("meshes/cube.off", "rb").read()).hexdigest()
for thing in [hand["objects"][0]["outer"], hand["objects"][0]["inner"]] + [l["outer"] for l in hand["robots"][0]["links"]]:
    for source in thing["made_from"]:
        if source["file"] == "meshes/cube.off":
            source["sha256"] = digest
json.dump(hand, open("hand.json", "w"))
END
expect 0 'sets made anew' "$BIN/kaboum-scene" update hand.json --no-cache
shows 0 '^free$' "$BIN/kaboum-check" hand.json
# Only what is out of date is made anew: the bar's set is a file that nobody wrote to.
cp cell/arm/upper.glb upper.glb
touch -d '2001-01-01' cell/arm/upper.glb
slab 1.5 >meshes/cube.off
expect 0 '4 sets made anew' "$BIN/kaboum-scene" update hand.json --no-cache
cmp -s cell/arm/upper.glb upper.glb || fail "the bar's set has changed"
[ "$(date -r cell/arm/upper.glb +%Y)" = 2001 ] || fail "the bar's set was written"
# Back to what they were: so are all sets, byte by byte.
mv kept.off meshes/cube.off
expect 0 'sets made anew' "$BIN/kaboum-scene" update old.json --no-cache
shows 0 '^free$' "$BIN/kaboum-check" near.json
# Sets that others made of a link are not thrown away, nor replaced by ones that hold less.
cp arm.urdf arm-kept.urdf
for change in by-hand of-another-file with-other-options inner; do
  python3 - "$BIN" $change <<'END' || fail "$change"
import json, subprocess, sys
change = sys.argv[2]
scene = json.load(open("near.json"))
links = scene["robots"][0]["links"]
tip = next(l for l in links if l["link"] == "tip")
urdf = open("arm-kept.urdf").read()
if change == "by-hand":  # the shape that the set was made from is gone
    urdf = urdf.replace('<link name="tip"><collision>', '<link name="tip"><visual>')
    at = urdf.index("</collision>", urdf.index('<link name="tip">'))
    urdf = urdf[:at] + "</visual>" + urdf[at + len("</collision>"):]
elif change == "of-another-file":
    tip["outer"].pop("made_from")
elif change == "with-other-options":
    subprocess.run([sys.argv[1] + "/kaboum-scene", "make", "other.json", "--robot", "arm=arm.urdf", "--epsilon", "7%",
                    "--no-cache", "--quiet"], check=True)
    other = json.load(open("other.json"))["robots"][0]["links"]
    links[links.index(tip)] = next(l for l in other if l["link"] == "tip")
else:
    tip["inner"] = dict(tip["outer"])
    tip["inner"].pop("made_from")
json.dump(scene, open("theirs.json", "w"))
open("arm.urdf", "w").write(urdf + "<!-- changed -->\n")
END
  cp theirs.json before.json
  expect 3 "robot 'arm', link '.*': its set .*; make the sets of this robot anew by hand" "$BIN/kaboum-scene" update theirs.json --no-cache
  cmp -s theirs.json before.json || fail "$change: the scene was changed"
done
cp arm-kept.urdf arm.urdf
# Inner sets of links: contacts with them are certain.
"$BIN/kaboum-scene" make deep.json --robot arm=arm.urdf --object box=meshes/cube.off --inner --inner-links --no-cache --quiet || fail "inner links"
[ "$(grep -c '"inner"' deep.json)" = 4 ] || fail "not an inner set for each link: $(grep -c '"inner"' deep.json)"
python3 - <<'END' || fail "deep scene"
import json
deep = json.load(open("deep.json"))
deep["objects"][0]["pose"] = {"position": [-0.75, 5.25, 2.25]}
json.dump(deep, open("deep.json", "w"), indent=1)
END
shows 1 'arm/tip and box collide' "$BIN/kaboum-check" deep.json --configuration 1.5707963,0
shows 0 '^free$' "$BIN/kaboum-check" deep.json --configuration=-1,0
expect 2 'inner sets of links: no robot' "$BIN/kaboum-scene" make bad.json --object box=meshes/cube.off --inner-links
# They are made anew as the outer ones are, by the same options.
cp meshes/bar.off kept.off
slab 4 >meshes/bar.off
expect 3 'has changed since' "$BIN/kaboum-check" deep.json
expect 0 '2 sets made anew' "$BIN/kaboum-scene" update deep.json --no-cache
[ "$(grep -c '"inner"' deep.json)" = 4 ] || fail "the update loses inner sets"
shows 1 'arm/tip and box collide' "$BIN/kaboum-check" deep.json --configuration 1.5707963,0
mv kept.off meshes/bar.off
expect 0 '2 sets made anew' "$BIN/kaboum-scene" update deep.json --no-cache
python3 - <<'END'
import json
deep = json.load(open("deep.json"))
links = deep["robots"][0]["links"]
links[0]["inner"] = links[2]["inner"]
json.dump(deep, open("crossed.json", "w"), indent=1)
links[0]["inner"] = deep["objects"][0]["inner"]
json.dump(deep, open("strange.json", "w"), indent=1)
END
expect 3 "crossed.json: line [0-9]*, column [0-9]*: .* is in the frame of 'tip', not of link 'base'" "$BIN/kaboum-check" crossed.json
expect 3 "strange.json: line [0-9]*, column [0-9]*: .*not of link 'base'" "$BIN/kaboum-check" strange.json
# A mesh mirrored by its scale: the wedge is where the mirror image is, and nowhere else.
printf 'OFF\n4 4 0\n0 0 0\n4 0 0\n0 2 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n' >meshes/wedge.off
for scale in '1 1 1' '-1 1 1' '1 -1 1' '-1 -1 -1'; do
  echo "<robot name=\"w\"><link name=\"l\"><collision><geometry><mesh filename=\"meshes/wedge.off\" scale=\"$scale\"/></geometry></collision></link><link name=\"m\"/><joint name=\"j\" type=\"prismatic\"><parent link=\"l\"/><child link=\"m\"/><limit lower=\"0\" upper=\"1\" effort=\"1\" velocity=\"1\"/></joint></robot>" >wedge.urdf
  rm -rf wedge wedge.json
  expect 0 '' "$BIN/kaboum-scene" make wedge.json --robot w=wedge.urdf --object box=meshes/cube.off --inner --inner-links --no-cache
  for at in '1 1 1' '-1 1 1' '1 -1 1' '-1 -1 -1'; do
    python3 - "$scale" "$at" <<'END' || fail "wedge at $at"
import json, sys
wedge = json.load(open("wedge.json"))
at = [float(x) for x in sys.argv[2].split()]
# The cube's corner at 0.1, 0.1, 0.1 of this octant, the cube farther out.
wedge["objects"][0]["pose"] = {"position": [0.1 if x > 0 else -1.1 for x in at]}
json.dump(wedge, open("wedge-at.json", "w"))
END
    if [ "$at" = "$scale" ]; then
      shows 1 'w/l and box collide' "$BIN/kaboum-check" wedge-at.json
    else
      shows 0 '^free$' "$BIN/kaboum-check" wedge-at.json
    fi
  done
done
# A set in millimetres in a scene in metres.
expect 0 '' "$BIN/bcd-decompose" meshes/cube.off -o cell/mm.glb --unit mm --no-cache
python3 - <<'END'
import hashlib, json
mm = json.load(open("near.json"))
mm["objects"][0]["outer"] = {"file": "cell/mm.glb", "sha256": hashlib.sha256(open("cell/mm.glb", "rb").read()).hexdigest()}
json.dump(mm, open("mm-set.json", "w"), indent=1)
END
expect 3 'mm-set.json: line [0-9]*, column [0-9]*: cell/mm.glb is in mm, the scene in m' "$BIN/kaboum-check" mm-set.json
mkdir elsewhere
cp near.json elsewhere/near.json
expect 3 'arm.urdf: cannot be .*moved or copied with all files that it names' "$BIN/kaboum-check" elsewhere/near.json
sed 's/box-inner.glb/box.glb/; s/"inner"/"innr"/' near.json >typo.json
expect 3 "'innr' is not known here; did you mean 'inner'" "$BIN/kaboum-check" typo.json
expect 3 'cut short' sh -c "head -c 200 near.json >cut.json; '$BIN/kaboum-check' cut.json"
expect 3 'cannot be' "$BIN/kaboum-check" absent.json
# Pairs of links.
shows 0 'base upper: adjacent' "$BIN/kaboum-scene" pairs near.json --srdf arm.srdf
grep -q 'link1="base" link2="tip" reason="Never"' arm.srdf || fail "base and tip never touch: $(cat arm.srdf)"
sed -n 's/^for the robot in the scene: //p' out.txt >never.txt
sed "s/\"name\": \"arm\",/\"name\": \"arm\", $(cat never.txt),/" near.json >proved.json
shows 0 '^free$' "$BIN/kaboum-check" proved.json
sed 's/"name": "arm",/"name": "arm", "limits": {"j2": [-1, 1]},/' proved.json >other.json
expect 3 'proved for other limits or other sets' "$BIN/kaboum-check" other.json
# Making scenes.
expect 2 'NAME=FILE is expected' "$BIN/kaboum-scene" make bad.json --object meshes/cube.off
expect 0 '2 sets$' "$BIN/kaboum-scene" make placed.json --object a=meshes/cube.off --object b=meshes/bar.off --at b=1,2,3,0,0,1.5707963267948966 --at a=0,0,-1 --no-cache
python3 - <<'END' || fail "--at is elsewhere: $(cat placed.json)"
import json, sys
a, b = (o["pose"] for o in json.load(open("placed.json"))["objects"])
turn = b["quaternion"]
sys.exit(a != {"position": [0, 0, -1]} or b["position"] != [1, 2, 3] or abs(turn[2] - 0.5 ** 0.5) + abs(turn[3] - 0.5 ** 0.5) > 1e-15)
END
expect 0 '4 sets$' "$BIN/kaboum-scene" make stands.json --robot arm=arm.urdf --region room=meshes/room.off --at arm=0,0,0.8,0,0,3 --at room=1,0,0 --no-cache
shows 0 '^free$' "$BIN/kaboum-check" stands.json
expect 2 "at: there is nothing of the name 'boz'; did you mean 'box'" "$BIN/kaboum-scene" make bad.json --object box=meshes/cube.off --at boz=0,0,1
expect 2 "at: 'box' is placed twice" "$BIN/kaboum-scene" make bad.json --object box=meshes/cube.off --at box=0,0,1 --at box=0,0,2
expect 2 'at box: expected numbers with commas between' "$BIN/kaboum-scene" make bad.json --object box=meshes/cube.off --at box=0,0,z
expect 2 'at: NAME=POSE is expected' "$BIN/kaboum-scene" make bad.json --object box=meshes/cube.off --at 0,0,1
expect 2 'is used twice' "$BIN/kaboum-scene" make bad.json --object a=meshes/cube.off --object a=meshes/bar.off
for option in --path --configuration --configurations; do expect 2 'is empty' "$BIN/kaboum-check" near.json $option ''; done
sed 's/"unit": "m"/"unit": "mm"/' near.json >mm.json
expect 3 'URDFs are in m' "$BIN/kaboum-check" mm.json
expect 2 'cell.json exists; replacing it (force)' "$BIN/kaboum-scene" make cell.json --object box=meshes/cube.off
expect 2 'ends in .json' "$BIN/kaboum-scene" make cell --object box=meshes/cube.off
expect 2 'URDFs are in m' "$BIN/kaboum-scene" make bad.json --unit mm --robot arm=arm.urdf --object box=meshes/cube.off
# Files that state their unit, and others: a set is in the unit that it says.
printf '<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit meter="0.001"/></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="12">0 0 0 1 0 0 0 1 0 0 0 1</float_array><technique_common>
<accessor source="#a" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 1 3 1 2 3 2 0 3</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>' >cup.dae
expect 3 'cup.dae: its vertices are in m as read' "$BIN/kaboum-scene" make cup.json --object cup=cup.dae --unit mm --no-cache
absent cup.json cup
expect 0 '' "$BIN/kaboum-scene" make cup.json --object cup=cup.dae --no-cache
expect 0 'in m as read, and so is its set, not in mm' "$BIN/bcd-decompose" cup.dae -o cup.glb --unit mm --no-cache
expect 2 'nothing is asked for' "$BIN/kaboum-scene" make bad.json
expect 3 'absent.stl: there is no such file' "$BIN/kaboum-scene" make bad.json --robot arm=arm.urdf --object a=absent.stl --no-cache
# Too thin for bodies within it.
printf 'OFF\n8 12 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1e-6\n1 0 1e-6\n0 1 1e-6\n1 1 1e-6\n' >thin.off
printf '3 %s\n' '0 2 3' '0 3 1' '4 5 7' '4 7 6' '0 1 5' '0 5 4' '2 6 7' '2 7 3' '0 4 6' '0 6 2' '1 3 7' '1 7 5' >>thin.off
expect 0 'no body lies within thin.off at this epsilon; it has no inner set' \
  "$BIN/kaboum-scene" make thin.json --object thin=thin.off --inner --epsilon 20% --no-cache
grep -q '"inner"' thin.json && fail "an inner set without bodies"
expect 3 "region 'thin': no body lies within thin.off" "$BIN/kaboum-scene" make bad.json --region thin=thin.off --epsilon 20% --no-cache
absent bad.json bad
"$BIN/kaboum-scene" make again.json --robot arm=arm.urdf --object box=meshes/cube.off --inner --no-cache --quiet --threads 1
sed 's/again/cell/' again.json | cmp -s - cell.json || fail "another scene of the same files"
# Primitives: exact, so that contacts are certain, and how deep they are.
expect 0 '0 sets' "$BIN/kaboum-scene" make solids.json --primitive floor=plane:4,4,0.5 --primitive ball=sphere:0.25 --primitive can=cylinder:0.1,0.5 \
  --primitive pill=capsule:0.1,0.5 --primitive crate=box:1,1,1 --at ball=0,0,0.125 --at can=2,0,1 --at pill=-2,0,1 --at crate=0,2,3
shows 1 'floor and ball collide, 0.125 deep' "$BIN/kaboum-check" solids.json --resting --report solids-report.json
shows 1 'nearest: floor and ball, sets 0.125 to 0.125 deep in each other' "$BIN/kaboum-check" solids.json --resting --distance
grep -q '"depth"' solids-report.json || fail "no depth in the report"
expect 0 'nothing is out of date' "$BIN/kaboum-scene" update solids.json
sed 's/0\.125/0.2500001/' solids.json >apart.json
shows 0 '^free$' "$BIN/kaboum-check" apart.json --resting
for bad in floor=plane floor=plane:4,4 ball=sphere:0 ball=sphere:1,2 can=cylinder:1 tube=tube:1 =box:1,1,1 ball=sphere:nan; do
  expect 2 'primitive: NAME=box:X,Y,Z' "$BIN/kaboum-scene" make bad.json --primitive $bad
done
for bad in floor=box:1m,1m ball=sphere:1% ball=sphere:0mm ball=sphere:1e10m; do
  expect 2 'primitive: .*; \(box has\|sizes are\)' "$BIN/kaboum-scene" make bad.json --primitive $bad
done
absent bad.json bad
# A scene in another unit than metres: two cubes of 10 mm, 20 mm apart.
expect 0 '0 sets' "$BIN/kaboum-scene" make cubes.json --unit mm --primitive a=box:1cm,10,0.01m --primitive b=box:10,10,10 --at b=30,0,0
shows 0 '^free, with margins kept: 1.99cm$' "$BIN/kaboum-check" cubes.json --resting --margin 1.99cm
shows 0 '^free, with margins kept: 1; objects that rest are not looked at in pairs (--resting does)$' "$BIN/kaboum-check" cubes.json --margin 1
shows 1 'within the margin of 20.1' "$BIN/kaboum-check" cubes.json --resting --margin 20.1
shows 1 'within the margin of 20.1' "$BIN/kaboum-check" cubes.json --resting --margin a,b=0.0201m
finish
