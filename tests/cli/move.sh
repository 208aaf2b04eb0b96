# shellcheck shell=sh disable=SC2154
# kaboum-move: paths round what is in the way, their execution, reasons where there is none.
. "$(dirname "$0")/common.sh"
bar() {
  printf 'OFF\n8 12 0\n0 -0.1 -0.1\n%s -0.1 -0.1\n%s 0.1 -0.1\n0 0.1 -0.1\n0 -0.1 0.1\n%s -0.1 0.1\n%s 0.1 0.1\n0 0.1 0.1\n' "$1" "$1" "$1" "$1"
  printf '3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n'
}
bar 1 >bar.off
link() { echo "<link name=\"$1\"><collision><geometry><mesh filename=\"bar.off\"/></geometry></collision></link>"; }
joint() {
  echo "<joint name=\"$1\" type=\"revolute\"><parent link=\"$2\"/><child link=\"$3\"/><origin xyz=\"$4\"/>
<axis xyz=\"0 0 1\"/><limit lower=\"-3\" upper=\"3\" effort=\"1\" velocity=\"$5\"/></joint>"
}
echo "<robot name=\"arm\"><link name=\"base\"/>$(link upper)$(link tip)$(joint j1 base upper '0 0 0' 2)$(joint j2 upper tip '1 0 0' 0)</robot>" >arm.urdf
expect 0 '' "$BIN/kaboum-scene" make cell.json --robot arm=arm.urdf --object box=bar.off --no-cache
# The box is where the stretched arm passes, out of the upper arm's reach.
python3 - <<'END' || fail "scene"
import json
cell = json.load(open("cell.json"))
cell["objects"][0]["pose"] = {"position": [1.5, 0, 0]}
json.dump(cell, open("cell.json", "w"))
END
M=$BIN/kaboum-move
expect 1 '' "$BIN/kaboum-check" cell.json --configuration=0,0
expect 0 'free at every instant' "$M" cell.json --from=-0.8,0 --to 0.8,0 -o path.csv --trajectory samples.csv --report move.json
head -1 path.csv | grep -qx 'j1,j2' || fail "no names of joints: $(head -1 path.csv)"
grep -q '"straight": false' move.json || fail "a straight line through the box"
grep -q '"arm/tip"' move.json || fail "nobody is named that was in the way"
[ "$(wc -l <path.csv)" -ge 4 ] || fail "too few waypoints: $(cat path.csv)"
# Both are read by others, and are free.
shows 0 'free at every instant' "$BIN/kaboum-check" cell.json --path path.csv
shows 0 'free at every instant' "$BIN/kaboum-check" cell.json --path samples.csv --resolution 1e-8 --max-intervals 100000000
python3 - <<'END' || fail "samples"
import csv, json
rows = list(csv.reader(open("samples.csv")))
path = list(csv.reader(open("path.csv")))
assert rows[0] == ["time_from_start", "j1", "j2"], rows[0]
values = [[float(x) for x in row] for row in rows[1:]]
assert [row[1:] for row in (rows[1], rows[-1])] == [path[1], path[-1]]
for a, b in zip(values, values[1:]):
    step = b[0] - a[0]
    assert abs(step - 0.001) < 1e-9, step
    # The URDF lets the first turn at 2 rad/s, and says nothing of the other.
    assert abs(b[1] - a[1]) <= 2 * step + 1e-9 and abs(b[2] - a[2]) <= step + 1e-9, (a, b)
report = json.load(open("move.json"))
assert report["trajectory"]["samples"] == len(values)
assert report["trajectory"]["max_velocity"] == [2, 1]
assert report["outcome"] == "found" and len(report["waypoints"]) == len(path) - 1
END
# The same seed gives the same bytes on any number of threads; another one another path.
for n in 1 2 5; do
  expect 0 '' "$M" cell.json --from=-0.8,0 --to 0.8,0 -o "p$n.csv" --threads $n --seed 7 --report "r$n.json"
  sed -e '/"resources"/,/}/d' -e "s/p$n\.//" "r$n.json" >"s$n.json"
done
for n in 2 5; do
  cmp -s p1.csv p$n.csv || fail "path differs on $n threads"
  cmp -s s1.json s$n.json || fail "report differs on $n threads"
done
expect 0 '' "$M" cell.json --from=-0.8,0 --to 0.8,0 -o p8.csv --seed 8
! cmp -s p1.csv p8.csv || fail "the seed changes nothing"
expect 0 '' "$M" cell.json --from=-0.8,0 --to 0.8,0 -o p.csv --timeout 60 --seed 7
cmp -s p1.csv p.csv || fail "a limit of time changes the path"
# By a roadmap: made once, read afterwards; the same bytes on any number of threads; of another scene it is refused.
expect 0 'roadmap of 1000 nodes' "$M" cell.json --from=-0.8,0 --to 0.8,0 -o m1.csv --roadmap map1.json --threads 1
expect 0 'roadmap of 1000 nodes' "$M" cell.json --from=-0.8,0 --to 0.8,0 -o m2.csv --roadmap map2.json --threads 5
cmp -s map1.json map2.json || fail "another roadmap on 5 threads"
cmp -s m1.csv m2.csv || fail "another path by a roadmap on 5 threads"
expect 0 'free at every instant' "$M" cell.json --from=-0.8,0 --to 0.8,0 -o m2.csv --roadmap map1.json
cmp -s m1.csv m2.csv || fail "another path by a roadmap that is read"
cmp -s map1.json map2.json || fail "a roadmap that is read is written"
shows 0 'free at every instant' "$BIN/kaboum-check" cell.json --path m1.csv
expect 7 'does not say that there is none.*--max-work' "$M" cell.json --from=-0.8,0 --to 0.8,0 -o none.csv --roadmap map1.json --max-work 1e-6
sed 's/1\.5/1.50001/' cell.json >moved.json
! cmp -s cell.json moved.json || fail "nothing was moved"
expect 3 'of another scene' "$M" moved.json --from=-0.8,0 --to 0.8,0 -o none.csv --roadmap map1.json
echo '{}' >no-map.json
expect 3 'no roadmap' "$M" cell.json --from=-0.8,0 --to 0.8,0 -o none.csv --roadmap no-map.json
expect 2 '' "$M" cell.json --from=-0.8,0 --to 0.8,0 -o same.csv --roadmap same.csv
# Straight; from home; from where another path ends; to the nearest of several; in degrees.
expect 0 'straight' "$M" cell.json --from=0.5,0 --to 1,1 -o p.csv
shows 0 '^j1,j2$' "$M" cell.json --start p.csv --to 0.5,0
[ "$(sed -n 2p out.txt)" = 1,1 ] || fail "it does not begin where the other path ends: $(cat out.txt)"
expect 0 'to goal 2' "$M" cell.json --from=0.5,0 --to 3,0 --to 0.7,0 -o p.csv
printf 'j1,j2\n3,0\n0.8,0\n' >goals.csv
expect 0 'to goal 2' "$M" cell.json --from=0.5,0 --goals goals.csv -o p.csv
expect 0 'straight' "$M" cell.json --from=30,0 --to 60,0 --degrees -o p.csv
sed -n 3p p.csv | grep -qx '60,0' || fail "degrees are written as degrees: $(cat p.csv)"
shows 0 'free at every instant' "$BIN/kaboum-check" cell.json --path p.csv --degrees
# Round the box, up to a limit that is no double in degrees: what is read back is within it, and free.
expect 0 'free at every instant' "$M" cell.json --from=-45.8366236104659,0 --to 171.8873385392,0 --degrees -o d.csv --trajectory ds.csv --rate 100 --report d.json
shows 0 'free at every instant' "$BIN/kaboum-check" cell.json --path d.csv --degrees
shows 0 'free at every instant' "$BIN/kaboum-check" cell.json --path ds.csv --degrees --resolution 1e-8 --max-intervals 100000000
python3 - <<'END' || fail "degrees"
import csv, json, math
report = json.load(open("d.json"))
assert report["output_angles"] == "degrees"
rows = [[float(x) for x in row] for row in list(csv.reader(open("d.csv")))[1:]]
assert rows[0][0] == -45.8366236104659 and abs(rows[-1][0] - 171.8873385392) < 1e-9, rows
assert len(rows) == len(report["waypoints"])
for row, q in zip(rows, report["waypoints"]):
    assert [x * (math.pi / 180) for x in row] == q, (row, q)
samples = [[float(x) for x in row] for row in list(csv.reader(open("ds.csv")))[1:]]
assert max(abs(x) for row in samples for x in row[1:]) > 90
END
# Limits of speed.
expect 0 '' "$M" cell.json --from=0.5,0 --to 1,1 -o p.csv --trajectory slow.csv --rate 100 --max-velocity 0.1 --max-acceleration j2=0.5
[ "$(wc -l <slow.csv)" -gt 1800 ] || fail "too fast: $(wc -l <slow.csv)"
# What the URDF states is never exceeded.
sed 's/velocity="2"/velocity="0.1"/' arm.urdf >slow.urdf
expect 0 '' "$BIN/kaboum-scene" make slow.json --robot arm=slow.urdf
for option in '' '--max-velocity 3' '--max-velocity j1=0.05 --max-velocity 3' '--max-velocity 3 --max-velocity j1=0.05'; do
  # shellcheck disable=SC2086
  expect 0 '' "$M" slow.json --from=0.5,0 --to 1,0 -o p.csv --trajectory slow.csv --rate 100 $option
  [ "$(wc -l <slow.csv)" -gt 900 ] || fail "faster than the URDF allows: $(wc -l <slow.csv)"
done
expect 2 'above what the robot' "$M" slow.json --from=0.5,0 --to 1,0 -o none.csv --trajectory none2.csv --max-velocity j1=0.2
# Corners that are blended: limits of jerk besides; faster; each file with the same numbers, read by others.
GO='--from=-0.8,0 --to 0.8,0 -o b.csv --rate 500'
# shellcheck disable=SC2086
for extension in csv json yaml; do
  expect 0 'free at every instant' "$M" cell.json $GO --blend 0.5 --max-jerk 60 --max-jerk j2=40 --trajectory b-samples.$extension --report b-$extension.json
  shows 0 'free at every instant' "$BIN/kaboum-check" cell.json --path b-samples.$extension --resolution 1e-8 --max-intervals 100000000
done
# shellcheck disable=SC2086
expect 0 '' "$M" cell.json $GO --trajectory b-rests.csv
[ "$(wc -l <b-samples.csv)" -lt "$(wc -l <b-rests.csv)" ] || fail "not faster: $(wc -l b-samples.csv b-rests.csv)"
# shellcheck disable=SC2086
expect 0 '' "$M" cell.json $GO --blend 0.5 --max-jerk 60 --max-jerk j2=40 --trajectory b-again.csv --threads 3
cmp -s b-samples.csv b-again.csv || fail "other samples on 3 threads"
python3 - <<'END' || fail "blended samples"
import csv, json
rows = [[float(x) for x in row] for row in list(csv.reader(open("b-samples.csv")))[1:]]
report = json.load(open("b-csv.json"))
made = report["trajectory"]
assert made["max_jerk"] == [60, 40] and made["samples"] == len(rows), made
assert len(made["blends"]) == len(report["waypoints"]) and made["blends"][0] == made["blends"][-1] == 0
assert any(0 < x <= 0.5 for x in made["blends"]), made["blends"]
assert len(made["between_samples"]) == 2 and all(abs(x - 3 * 5 / (16 * 500**2)) < 1e-15 for x in made["between_samples"])
for joint in (1, 2):
    values = [row[joint] for row in rows]
    for limits in (made["max_velocity"], made["max_acceleration"], made["max_jerk"]):
        values = [(b - a) * 500 for a, b in zip(values, values[1:])]
        assert max(map(abs, values)) <= limits[joint - 1] * (1 + 1e-5), (joint, limits)
message = json.load(open("b-samples.json"))
assert message["joint_names"] == ["j1", "j2"]
points = message["points"]
assert [p["positions"] for p in points] == [row[1:] for row in rows]
times = [p["time_from_start"]["sec"] + 1e-9 * p["time_from_start"]["nanosec"] for p in points]
assert all(abs(a - row[0]) < 1e-9 for a, row in zip(times, rows))
for end in (points[0], points[-1]):
    assert end["velocities"] == end["accelerations"] == [0, 0], end
for before, now, after in zip(points, points[1:], points[2:]):
    for i in (0, 1):
        slope = (after["positions"][i] - before["positions"][i]) * 250
        assert abs(slope - now["velocities"][i]) <= made["max_jerk"][i] * 0.002**2 / 6 + 1e-9
try:
    import yaml
except ImportError:
    yaml = None
if yaml:
    read = yaml.safe_load(open("b-samples.yaml"))
    assert read == message
    assert all(isinstance(x, float) for p in read["points"] for key in ("positions", "velocities", "accelerations") for x in p[key])
END
# The command that is named decides the file anew, what controllers make of it as well.
for extension in csv json yaml; do
  check=$(python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["trajectory"]["check"])' b-$extension.json)
  # shellcheck disable=SC2086
  expect 0 "b-samples.$extension: [0-9]* samples in [0-9.]* s; what decides it anew: kaboum-check cell.json --path=b-samples.$extension" "$M" cell.json $GO --blend 0.5 --max-jerk 60 --max-jerk j2=40 --trajectory b-samples.$extension
  grep -qF "$check" err.txt || fail "the command of the report is not named: $check"
  of=''
  [ $extension = csv ] || of=' of the quintic polynomials'
  shows 0 "free at every instant$of\$" sh -c "'$BIN'/$check"
done
shows 0 'free at every instant of the cubic polynomials$' "$BIN/kaboum-check" cell.json --path b-samples.json --between cubic --resolution 1e-8 --max-intervals 100000000
expect 0 'names with blanks.*--robot=arm .*--margin=0 --margin=arm/tip,box=0.001 --keep=upright' "$M" cell.json --robot arm --from=0.5,0 --to 1,1 -o p.csv --trajectory 'names with blanks.json' --margin arm/tip,box=0.001 --margin 0 --keep upright
shows 0 'of the quintic polynomials, with margins kept' sh -c "'$BIN'/$(sed -n 's/.*anew: //p' err.txt)"
# What joints do between waypoints is another motion by polynomials: through the box where the straight line is free of it, and round it.
message() { # file, then of each of two points: time, positions, velocities
  echo "{\"joint_names\": [\"j1\", \"j2\"], \"points\": [{\"time_from_start\": $2, \"positions\": $3, \"velocities\": $4}, {\"time_from_start\": $5, \"positions\": $6, \"velocities\": $7}]}" >"$1"
}
message into.json 0 '[0.5, 0]' '[-3, 0]' 1 '[0.5, 0]' '[3, 0]'
shows 0 'free at every instant$' "$BIN/kaboum-check" cell.json --path into.json
grep -q 'makes splines.*(--between decides these)' err.txt || fail "velocities are passed over silently: $(cat err.txt)"
shows 1 'free until waypoint 1 + 0.1426.*arm/tip and box' "$BIN/kaboum-check" cell.json --path into.json --between cubic --report into-report.json
message round.json 1 '[-1.2, 0]' '[0, 12]' 2 '[1.2, 0]' '[0, -12]'
shows 1 'arm/tip and box' "$BIN/kaboum-check" cell.json --path round.json
shows 0 'free at every instant of the cubic polynomials$' "$BIN/kaboum-check" cell.json --path round.json --between cubic --keep upright --report round-report.json
python3 - <<'END' || fail "reports of polynomials"
import json
into, round = (json.load(open(f"{name}-report.json")) for name in ("into", "round"))
assert into["waypoints"] == round["waypoints"] == 2 and round["kept"]["answer"] == "kept"
assert round["curve"]["between"] == "cubic" and round["curve"]["lines"] > 100 and all(0 < x < 1e-5 for x in round["curve"]["room"]["arm"])
# Until then the joint goes from 0.5 by -3 t + 3 t^2 to where the arm meets the box.
t = into["motion"]["contact"]["time"]
assert into["motion"]["contact"]["waypoint"] == 1 and 0.1 < t < 0.3 and into["motion"]["contact"]["share"] == t, into["motion"]
assert 0.05 < 0.5 - 3 * t + 3 * t * t < 0.2, t
END
message beyond.json 0 '[2.9, 0]' '[2, 0]' 1 '[2.9, 0]' '[-2, 0]'
expect 3 "behind waypoint 1 the polynomial takes joint 'j1' to 3" "$BIN/kaboum-check" cell.json --path beyond.json --between cubic
expect 3 'needs the accelerations of all points' "$BIN/kaboum-check" cell.json --path into.json --between quintic
expect 3 'needs the velocities' "$BIN/kaboum-check" cell.json --path b-samples.csv --between cubic
expect 3 'needs the times' "$BIN/kaboum-check" cell.json --path path.csv --between cubic
message still.json 1 '[0.5, 0]' '[-3, 0]' 1 '[0.5, 0]' '[3, 0]'
expect 3 '' "$BIN/kaboum-check" cell.json --path still.json --between cubic
sed 's/, "velocities": \[3, 0\]//' into.json >some.json
expect 3 'point 2 has no velocities' "$BIN/kaboum-check" cell.json --path some.json --between cubic
# Lists that do not fit, and accelerations that the polynomials do not have.
sed 's/"velocities": \[3, 0\]/"velocities": [3]/' into.json >short.json
expect 3 'point 2, velocities: a number for each joint is expected' "$BIN/kaboum-check" cell.json --path short.json --between cubic
shows 0 'free at every instant$' "$BIN/kaboum-check" cell.json --path short.json
grep -q 'velocities and accelerations are passed over' err.txt || fail "velocities that do not fit are passed over silently: $(cat err.txt)"
sed 's/"velocities": \[3, 0\]/&, "accelerations": [0, 0]/; s/"velocities": \[-3, 0\]/&, "accelerations": [8, 0]/' into.json >bent.json
"$BIN/kaboum-check" cell.json --path bent.json --between cubic >out.txt 2>err.txt
grep -q 'WARNING: bent.json states accelerations.*--between quintic decides that' err.txt || fail "accelerations are left out silently: $(cat err.txt)"
"$BIN/kaboum-check" cell.json --path bent.json --between quintic >out.txt 2>err.txt
! grep -q WARNING err.txt || fail "a warning of accelerations that are taken: $(cat err.txt)"
expect 7 'larger --resolution' "$BIN/kaboum-check" cell.json --path into.json --between cubic --resolution 1e-14
expect 2 'leave out --between' "$BIN/kaboum-check" cell.json --path into.json --between cubic --inside arm/tip=box
expect 2 '' "$BIN/kaboum-check" cell.json --between cubic
expect 2 'quartic' "$BIN/kaboum-check" cell.json --path into.json --between quartic
# A motion that is straight has no corners; those from rest to rest are messages as well.
expect 0 '' "$M" cell.json --from=0.5,0 --to 1,1 -o p.csv --blend 0.25 --trajectory b-straight.csv --report b-straight.json
grep -A3 '"blends"' b-straight.json | tr -d ' \n' | grep -q '\[0.0,0.0\]' || fail "blends of a straight path: $(cat b-straight.json)"
expect 0 '' "$M" cell.json --from=0.5,0 --to 1,1 -o p.csv --trajectory rests.yml --rate 50
shows 0 'free at every instant' "$BIN/kaboum-check" cell.json --path rests.yml
expect 2 'time-optimal.*leave it out with' "$M" cell.json --from=0.5,0 --to 1,1 -o none.csv --trajectory none2.csv --blend 0.5 --time-optimal
expect 2 'max-jerk.*blend' "$M" cell.json --from=0.5,0 --to 1,1 -o none.csv --trajectory none2.csv --max-jerk 5
expect 2 'blend' "$M" cell.json --from=0.5,0 --to 1,1 -o none.csv --trajectory none2.csv --blend 0.96
expect 2 'radians' "$M" cell.json --from=30,0 --to 60,0 --degrees -o none.csv --trajectory none2.yaml
# Reasons.
expect 1 'the start is not free: arm/tip and box' "$M" cell.json --from=0,0 --to 1,1 -o none.csv --report none.json
grep -q '"outcome": "start in contact"' none.json || fail "no outcome in the report"
expect 1 'the goal is not free: arm/tip and box' "$M" cell.json --from=0.5,0 --to 0,0 -o none.csv
expect 1 'no goal is free' "$M" cell.json --from=0.5,0 --to 0,0 --to 0.01,0 -o none.csv
expect 7 'does not say that there is none.*--max-work.*arm/tip and box' "$M" cell.json --from=-0.8,0 --to 0.8,0 -o none.csv --max-work 1e-6
expect 7 'max-nodes' "$M" cell.json --from=-0.8,0 --to 0.8,0 -o none.csv --max-nodes 1
# Misuse.
expect 2 'limits' "$M" cell.json --from=4,0 --to 1,1 -o none.csv
expect 2 'where to' "$M" cell.json -o none.csv
expect 2 'is empty' "$M" cell.json --to '' -o none.csv
expect 2 'excludes' "$M" cell.json --to 1,1 --from 0,0 --start p.csv
expect 2 "no robot 'arn'; did you mean 'arm'" "$M" cell.json --robot arn --to 1,1
expect 2 "no joint 'j3'" "$M" cell.json --from=0.5,0 --to 1,1 -o none.csv --trajectory none2.csv --max-velocity j3=1
expect 2 'above 0' "$M" cell.json --from=0.5,0 --to 1,1 -o none.csv --trajectory none2.csv --max-velocity 0
expect 2 'trajectory' "$M" cell.json --from=0.5,0 --to 1,1 -o none.csv --rate 5
expect 2 '' "$M" cell.json --to 1,1 -o cell.json
# Nor is any file that the scene names written over.
for file in arm.urdf $(find cell -name '*.glb' | head -1); do
  cp "$file" kept.bin
  expect 2 'overwrite' "$M" cell.json --from=0.5,0 --to 1,1 -o "$file"
  expect 2 'overwrite' "$M" cell.json --from=0.5,0 --to 1,1 -o none.csv --report "$file"
  cmp -s "$file" kept.bin || fail "$file is written over"
done
expect 4 '' "$M" cell.json --from=0.5,0 --to 1,1 -o nowhere/p.csv
expect 4 'long' "$M" cell.json --from=0.5,0 --to 1,1 -o none.csv --trajectory none2.csv --report "$(printf '%300s' '' | tr ' ' x)"
absent none.csv none2.csv
expect 7 'samples' "$M" cell.json --from=0.5,0 --to 1,1 -o none.csv --trajectory none2.csv --max-velocity 1e-6
expect 7 'more than 5000000' "$M" cell.json --from=0.5,0 --to 1,1 -o none.csv --trajectory none2.csv --max-velocity 1e-4
absent none.csv none2.csv
# What is kept: the tool's end on the straight line to a pose, certified; the same path without is not.
python3 - <<'END' || fail "scene with a tool"
import json
cell = json.load(open("cell.json"))
cell["robots"][0]["tools"] = [{"name": "end", "link": "tip", "position": [1, 0, 0]}]
cell["constraints"] = [{"name": "off-wall", "all": [
    {"relation": "distance", "first": "world.zx", "second": "arm/end.origin", "value": 1.5, "within": 0.5}]}]
cell["objects"][0]["features"] = [{"name": "middle", "point": [0.3, 0, 0]}, {"name": "pad", "surface": {"outline": [[0.1, 0.6, 0], [0.4, 0.6, 0], [0.4, 0.9, 0], [0.1, 0.9, 0]]}}]
cell["constraints"].append({"name": "not-into-the-box", "all": [{"relation": "coincident", "first": "arm/end.origin", "second": "world.xy"}],
    "prefer": [{"relation": "coincident", "first": "arm/end.origin", "second": "box/middle"}]})
on_pad = {"relation": "coincident", "first": "arm/end.origin", "second": "box/pad"}
cell["constraints"].append({"name": "on-pad", "all": [on_pad],
    "prefer": [{"relation": "angle", "first": "arm/end.x", "second": "world.x", "value": 0.9, "within_angle": 0.3}]})
json.dump(cell, open("kept.json", "w"))
cell["constraints"].append({"name": "both", "all": [
    {"relation": "distance", "first": "arm/end.origin", "second": "box/pad", "value": 0.1}, on_pad]})
json.dump(cell, open("contradicting.json", "w"))
cell["constraints"].pop()
cell["constraints"][0]["all"][0]["second"] = "arm/ende.origin"
json.dump(cell, open("misspelt.json", "w"))
END
POSE=$(python3 -c "from math import *; print(cos(1.2) + cos(1.8), sin(1.2) + sin(1.8), 0, 0, 0, 1.8, sep=',')")
expect 0 'kept: line within 0.001 (' "$M" kept.json --from=0.6,1 "--to-pose=$POSE" --keep line=1mm --margin 0mm --resolution 0.01mm -o line.csv --trajectory line-samples.csv --report line.json
shows 0 'kept at every instant: line within 0.001' "$BIN/kaboum-check" kept.json --path line.csv --keep line=1mm --report kept-report.json
shows 0 'kept at every instant' "$BIN/kaboum-check" kept.json --path line-samples.csv --keep line=0.001 --resolution 1e-8 --max-intervals 100000000
# Blends keep it as well: they are decided with it.
expect 0 'kept: line within 0.001 (' "$M" kept.json --from=0.6,1 "--to-pose=$POSE" --keep line=1mm --margin 0mm --resolution 0.01mm -o line.csv --blend 0.5 --trajectory line-blended.csv --report line-blended.json
shows 0 'kept at every instant' "$BIN/kaboum-check" kept.json --path line-blended.csv --keep line=0.001 --resolution 1e-8 --max-intervals 100000000
python3 - <<'END' || fail "the end is not on the line"
import csv, json, math
def end(q): return complex(math.cos(q[0]) + math.cos(q[0] + q[1]), math.sin(q[0]) + math.sin(q[0] + q[1]))
rows = [[float(x) for x in row] for row in list(csv.reader(open("line.csv")))[1:]]
assert len(rows) > 3, rows
a, b = end(rows[0]), end(rows[-1])
for p, q in zip(rows, rows[1:]):
    for k in range(101):
        z = end([x + (y - x) * k / 100 for x, y in zip(p, q)])
        assert abs(((z - a) * (b - a).conjugate()).imag) / abs(b - a) <= 0.001, (p, q, k)
assert json.load(open("line.json"))["kept"][0]["used"] <= 1
kept = json.load(open("kept-report.json"))["kept"]
assert kept["answer"] == "kept" and kept["constraints"][0]["relation"] == "coincident", kept
END
expect 0 '' "$M" kept.json --from=0.6,1 "--to-pose=$POSE" -o plain.csv
shows 1 "not kept: 'line' is off by" "$BIN/kaboum-check" kept.json --path plain.csv --keep line=0.001
expect 0 'kept: off-wall within 0.5' "$M" kept.json --from=0.6,1 "--to-pose=$POSE" --keep off-wall -o wall.csv
expect 0 'kept: upright' "$M" kept.json --from=0.6,1 --reach off-wall --keep upright -o wall.csv
tail -1 wall.csv | python3 -c "from math import *; a, b = map(float, input().split(',')); y = sin(a) + sin(a + b); assert 1 <= abs(y) <= 2, y" || fail "not where it should be"
expect 2 "did you mean 'off-wall'" "$M" kept.json --from=0.6,1 --reach off-wal -o none.csv
# A surface is reached anywhere within its outline, as is preferred, and kept at every instant.
expect 0 '' "$M" kept.json --from=0.6,1 --reach on-pad -o pad.csv
tail -1 pad.csv | python3 -c "
from math import *
a, b = map(float, input().split(','))
x, y = cos(a) + cos(a + b) - 1.5, sin(a) + sin(a + b)
assert 0.099 <= x <= 0.401 and 0.599 <= y <= 0.901 and abs(abs(a + b) - 0.9) <= 0.301, (x, y, a + b)" || fail "not on the pad: $(tail -1 pad.csv)"
# What is preferred and in contact is not gone to.
expect 0 '' "$M" kept.json --from=0.6,1 --reach not-into-the-box -o beside.csv
END_ON_PAD=$(tail -1 pad.csv)
expect 0 'kept: on-pad within 0.001' "$M" kept.json "--from=$END_ON_PAD" "--to=$END_ON_PAD" --keep on-pad -o stay.csv
expect 1 "the goal breaks a constraint: 'on-pad' is off by" "$M" kept.json "--from=$END_ON_PAD" --to=0.3,0 --keep on-pad -o none.csv
expect 3 "contradicting.json: line .*contradict each other, wherever the things are: distance 'arm/end.origin' 'box/pad', coincident 'arm/end.origin' 'box/pad'" \
  "$M" contradicting.json --from=0.6,1 --to=0.3,0 -o none.csv
expect 0 'kept: upright' "$M" kept.json --from=0.6,1 --to=0.3,0 --tool tip --keep upright -o tip.csv
expect 2 "no tool or link 'tipp'; did you mean 'tip'" "$M" kept.json --from=0.6,1 --to=0.3,0 --tool tipp -o none.csv
expect 1 "the goal breaks a constraint: 'off-wall' is off by" "$M" kept.json --from=0.6,1 --to=0.3,0 --keep off-wall -o none.csv
expect 7 'no configuration within the limits puts .*the search for them is numeric' "$M" kept.json --from=0.6,1 --to-pose=3,0,0 -o none.csv
expect 2 "did you mean 'off-wall'" "$M" kept.json --from=0.6,1 "--to-pose=$POSE" --keep of-wall -o none.csv
expect 3 "there is no feature 'arm/ende.origin'; did you mean 'arm/end.origin'?" "$M" misspelt.json --from=0.6,1 "--to-pose=$POSE" -o none.csv
expect 2 'CSV is written' "$M" kept.json --from=0.6,1 --to=0.3,0 -o wrong.json
expect 2 'keep needs --path' "$BIN/kaboum-check" kept.json --keep level
absent none.csv wrong.json
# Two robots at once: each alone is free, together they meet half way; one that waits lets the other pass.
expect 0 '' "$BIN/kaboum-scene" make two.json --robot left=arm.urdf --robot right=arm.urdf --at right=2.5,0,0,0,0,3.14159265 --no-cache
printf 'j1,j2\n0.8,0\n-0.8,0\n' >down.csv
printf 'j1,j2\n1.5,0\n1.5,0\n' >up.csv
printf 'j1,j2\n-1.5,0\n-1.5,0\n' >wait.csv
printf 'j1,j2\n1.5,0\n0.8,0\n' >come.csv
shows 0 'free at every instant' "$BIN/kaboum-check" two.json --path left=down.csv --path right=wait.csv
shows 0 'free at every instant' "$BIN/kaboum-check" two.json --path left=up.csv --path right=down.csv
shows 1 'left/.* and right/' "$BIN/kaboum-check" two.json --path left=down.csv --path right=down.csv --report two-report.json --preview two.png
shows 0 'free at every instant' "$BIN/kaboum-check" two.json --path left=come.csv --path right=come.csv
grep -q '"robots"' two-report.json || fail "no robots in the report"
[ -s two.png ] || fail "no picture of two robots"
expect 2 'names its robot' "$BIN/kaboum-check" two.json --path left=down.csv --path down.csv
expect 2 "'left' has two paths" "$BIN/kaboum-check" two.json --path left=down.csv --path left=up.csv
expect 2 'for one robot that moves' "$BIN/kaboum-check" two.json --path left=down.csv --path right=wait.csv --keep level
printf 'j1,j2\n0.8,0\n' >one.csv
expect 2 "equally many waypoints: 'right' has 1, 'left' has 2" "$BIN/kaboum-check" two.json --path left=down.csv --path right=one.csv
shows 0 'free at every instant' "$BIN/kaboum-check" two.json --path right=come.csv
expect 2 'names another robot' "$BIN/kaboum-check" two.json --robot left --path right=come.csv
# A robot with several last links and no tools: none need be named for joints.
{
  echo '<robot name="fork">'
  for link in a b c; do echo "<link name=\"$link\"><collision><geometry><box size=\"0.1 0.1 0.1\"/></geometry></collision></link>"; done
  for link in b c; do
    echo "<joint name=\"j$link\" type=\"revolute\"><parent link=\"a\"/><child link=\"$link\"/><origin xyz=\"0 $([ $link = b ] && echo 1 || echo -1) 0\"/><axis xyz=\"0 0 1\"/><limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/></joint>"
  done
  echo '</robot>'
} >fork.urdf
"$BIN/kaboum-scene" make fork.json --robot fork=fork.urdf --no-cache --quiet || fail 'no scene'
expect 0 '' "$BIN/kaboum-move" fork.json --from=-0.5,0 --to=0.5,0.2 -o fork.csv
expect 2 'several last links' "$BIN/kaboum-move" fork.json --from=-0.5,0 --to-pose '0 0 0' -o fork.csv
finish
