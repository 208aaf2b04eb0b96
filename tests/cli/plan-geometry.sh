# shellcheck shell=sh disable=SC2154
# kaboum-plan with a scene: plans whose motions a program that shares no code with it executes.
HERE=$(cd "$(dirname "$0")" && pwd)
. "$HERE/common.sh"
G=$HERE/../../examples/geometry
S=$HERE/../../examples/scenarios
P=$BIN/kaboum-plan
KABOUM_SCENE=$BIN/kaboum-scene
export KABOUM_SCENE
for task in 'stacked 3' 'remove 5'; do
  # shellcheck disable=SC2086
  set -- $task
  "$G/make-cell" "$1" "$2" "$1" >make.txt 2>&1 || fail "make-cell $task: $(tail -1 make.txt)"
  set -- "$1" "$S/$1/domain.kpl" "$1/problem.kpl" --scene "$1/cell.json"
  name=$1
  shift
  for threads in 1 2; do
    expect 0 solved "$P" solve "$@" -o "$name/plan$threads.json" --seed 3 --threads $threads
  done
  cmp -s "$name/plan1.json" "$name/plan2.json" || fail "$name: another plan on two threads"
  shows 0 valid "$P" check "$@" --plan "$name/plan1.json" --margin 0mm
  shows 0 '^good: 1 branch, .* 0 collisions, 0 limit violations, 0 jumps' "$P" run "$@" --plan "$name/plan1.json" --rate 250
  python3 "$HERE/execute_boxes.py" "$name" "$name/plan1.json" >said.txt 2>&1 || fail "$name: $(tail -1 said.txt)"
  grep -q 'actions, [0-9]* samples' said.txt || fail "$name: $(cat said.txt)"
done
# A mate by constraints of the scene: no pose of it is listed anywhere.
cat >mate.kpl <<'END'
-- A block is put where constraints of the scene say, by itself.
domain mate

types: robot, thing, constraints, conf handle, pose handle
constants: robot arm; thing o1, o2, o3; constraints above; conf home; pose start
predicates: isEmpty, isHeld(thing), isMated(thing)
functions: conf(robot) : conf; pose(thing) : pose
externals: reach(robot, thing) : conf; grasp(robot, thing, conf) : pose; satisfy(robot, constraints) : conf
           release(robot, thing, conf) : pose

action take(?o : thing)
  preconds:
    K(isEmpty) & let ?q = extern(reach(arm, ?o)) & let ?p = extern(grasp(arm, ?o, ?q))
  effects:
    add(Kf, !isEmpty), add(Kf, isHeld(?o)), add(Kf, conf(arm) = ?q), add(Kf, pose(?o) = ?p)

action mate(?o : thing, ?c : constraints)
  preconds:
    K(isHeld(?o)) & let ?q = extern(satisfy(arm, ?c)) & let ?p = extern(release(arm, ?o, ?q))
  effects:
    add(Kf, isEmpty), add(Kf, !isHeld(?o)), add(Kf, isMated(?o)),
    add(Kf, conf(arm) = ?q), add(Kf, pose(?o) = ?p)

init: K(isEmpty), K(conf(arm) = home), K(pose(o1) = start), K(pose(o2) = start), K(pose(o3) = start)
goal: K(isMated(o1)) & K(isEmpty)
END
python3 - <<'END' || fail "scene with a mate"
import json
cell = json.load(open("stacked/cell.json"))
cell["constraints"] = [{"name": "above", "all": [
    {"relation": "angle", "first": "o1.z", "second": "place3.z", "value": 0},
    {"relation": "coincident", "first": "o1/bottom", "second": "place3.z"},
    {"relation": "distance", "first": "o1/bottom", "second": "place3.xy", "value": 0.013, "within": 0.0005}]}]
json.dump(cell, open("stacked/mate.json", "w"))
END
expect 0 solved "$P" solve mate.kpl --scene stacked/mate.json -o mate-plan.json
shows 0 valid "$P" check mate.kpl --scene stacked/mate.json --plan mate-plan.json
shows 0 '^good: 1 branch, .* 0 collisions, 0 limit violations, 0 jumps' "$P" run mate.kpl --scene stacked/mate.json --plan mate-plan.json --rate 250
sed 's/constraints above/constraints abov/' mate.kpl >abov.kpl
expect 3 "no constraints 'abov'; did you mean 'above'" "$P" solve abov.kpl --scene stacked/mate.json -o none.json
# A scene may be YAML for exact meshes, too.
{
  echo '# a cell'
  cat stacked/cell.json
} >stacked/cell.yaml
shows 0 '^good: 1 branch' "$P" run "$S/stacked/domain.kpl" stacked/problem.kpl --scene stacked/cell.yaml --plan stacked/plan1.json --rate 50
# The program that executes plans would see it: a table that stands 3 cm higher, and 20 cm farther.
python3 - <<'END' || fail "table in the way"
import json
cell = json.load(open("remove/cell.json"))
cell["objects"][0]["pose"]["position"] = [0.7, 0, -0.02]
json.dump(cell, open("remove/blocked.json", "w"))
cell["objects"][1]["grasps"] = []
json.dump(cell, open("remove/bare.json", "w"))
END
mkdir blocked && cp remove/*.off remove/*.urdf blocked && cp remove/blocked.json blocked/cell.json
! python3 "$HERE/execute_boxes.py" blocked remove/plan1.json >said.txt 2>&1 || fail "a collision was not seen"
grep -q hits said.txt || fail "not for a collision: $(cat said.txt)"
shows 1 '^not good' "$P" run "$S/remove/domain.kpl" remove/problem.kpl --scene remove/blocked.json --plan remove/plan1.json --rate 100
expect 2 'expected all, seed:N' "$P" run "$S/remove/domain.kpl" remove/problem.kpl --scene remove/cell.json --plan remove/plan1.json --outcomes seed:x
expect 0 '' "$P" run "$S/remove/domain.kpl" remove/problem.kpl --scene remove/cell.json --plan remove/plan1.json --rate 50 \
  --outcomes seed:2 --trajectories csv --report run.json
[ "$(find csv -name '0*.csv' | wc -l)" = "$(python3 -c 'import json; print(json.load(open("run.json"))["motions"])')" ] || fail "not a file for each motion"
# Assumed outcomes: where one is wrong it is planned again. Blocks that are heavy go by another action.
python3 - "$S/remove/domain.kpl" >weighed.kpl <<'END' || fail "domain with weights"
import sys
text = open(sys.argv[1]).read().replace("isHeld(block)", "isHeld(block), isHeavy(block)")
remove = text[text.index("action remove("):text.index("goal:")]
light = remove.replace("K(isHeld(?o)) &", "K(isHeld(?o)) & K(!isHeavy(?o)) &")
heavy = remove.replace("K(isHeld(?o)) &", "K(isHeld(?o)) & K(isHeavy(?o)) &").replace("action remove", "action removeHeavy")
weigh = "action weigh(?o : block)\n  preconds:\n    K(isHeld(?o)) & !Kw(isHeavy(?o))\n  effects:\n    add(Kw, isHeavy(?o))\n\n"
print(text.replace(remove, light + heavy + weigh))
END
echo '{"isHeavy(o1)": false, "isHeavy(o2)": false, "isHeavy(o3)": false, "isHeavy(o4)": false, "isHeavy(o5)": false}' >light.json
expect 0 'solved under 5 assumptions: ' "$P" solve weighed.kpl remove/problem.kpl --scene remove/cell.json --assume light.json -o assumed.json
shows 1 'no case' "$P" check weighed.kpl remove/problem.kpl --scene remove/cell.json --plan assumed.json
sed 's/"isHeavy(o2)": false/"isHeavy(o2)": true/' light.json >heavy.json
shows 0 '^good: .*planned again 1 time' "$P" run weighed.kpl remove/problem.kpl --scene remove/cell.json --plan assumed.json --rate 100 \
  --outcomes heavy.json --report replanned.json
python3 - <<'END' || fail "report of replanning: $(cat replanned.json)"
import json
r = json.load(open("replanned.json"))
assert [(p["outcome"], p["status"], p["after_plan"]) for p in r["replans"]] == [("isHeavy(o2)", "solved", 0)]
assert r["collisions"] == r["jumps"] == r["limit_violations"] == 0 and r["replans"][0]["nodes"] > 0
END
shows 0 '^good: 1 branch, [0-9]* motions, [0-9]* samples, 0 collisions, 0 limit violations, 0 jumps$' "$P" run weighed.kpl remove/problem.kpl \
  --scene remove/cell.json --plan assumed.json --rate 100 --outcomes light.json
expect 3 'no case for isHeavy(o2)' "$P" run weighed.kpl remove/problem.kpl --scene remove/cell.json --plan assumed.json --outcomes heavy.json --replan 0
# Where there is no plan for what was sensed, the run is not good.
cat >luck.kpl <<'END'
domain luck
types: object, robot, block
constants: robot arm; block o1
predicates: s, done
action look
  preconds: !Kw(s)
  effects: add(Kw, s)
action easy
  preconds: K(!s)
  effects: add(Kf, done)
init: K(!done)
goal: K(done)
END
echo '{"s": false}' >good.json
echo '{"s": true}' >bad.json
expect 0 'solved under 1 assumption: ' "$P" solve luck.kpl --assume good.json -o luck.json
shows 0 '^good: 1 branch,' "$P" run luck.kpl --scene remove/cell.json --plan luck.json --outcomes good.json
for outcomes in all bad.json; do
  shows 1 '^not good: .*planned again 1 time' "$P" run luck.kpl --scene remove/cell.json --plan luck.json --outcomes $outcomes --report luck.report
  grep -q '"verdict": "not good"' luck.report || fail "the report says nothing: $(cat luck.report)"
done
grep -q '"verdict": "good"' replanned.json || fail "no verdict: $(cat replanned.json)"
echo '{"isHeavy(o2)": "yes"}' >yes.json
expect 3 'true or false, not yes' "$P" run weighed.kpl remove/problem.kpl --scene remove/cell.json --plan assumed.json --outcomes yes.json
# Payloads of another kind are bad input.
for damage in 's/\\"robot\\":\\"[^\\]*\\"/\\"robot\\":5/' 's/\\"path\\":\[\[[^],]*/\\"path\\":[[null/'; do
  sed "$damage" remove/plan1.json >kind.json
  cmp -s kind.json remove/plan1.json && fail "nothing was changed by $damage"
  for command in "run --rate 50" "show --html kind.html"; do
    # shellcheck disable=SC2086
    expect 3 'node [0-9]*, [A-Za-z]*(.*): a path of the plan is to be' "$P" $command "$S/remove/domain.kpl" remove/problem.kpl --scene remove/cell.json \
      --plan kind.json
  done
done
echo '{"isGreen(o2)": true}' >green.json
expect 2 'does not have' "$P" solve weighed.kpl remove/problem.kpl --scene remove/cell.json --assume green.json -o none.json
# A plan for another scene does not hold in this one; nor does one whose path or value was changed.
shows 1 invalid "$P" check "$S/remove/domain.kpl" remove/problem.kpl --scene remove/blocked.json --plan remove/plan1.json
sed 's/\(\\"path\\":\[\[[^]]*\],\[\)[-0-9.]*/\10.123/' remove/plan1.json >changed.json
cmp -s changed.json remove/plan1.json && fail "nothing was changed"
shows 1 invalid "$P" check "$S/remove/domain.kpl" remove/problem.kpl --scene remove/cell.json --plan changed.json
# Out of reach is proved by the closed form: no plan.
python3 - <<'END' || fail "far block"
import json
cell = json.load(open("remove/cell.json"))
cell["objects"][1]["pose"]["position"] = [3, 0, 0.1]
json.dump(cell, open("remove/far.json", "w"))
END
expect 1 unsolvable "$P" solve "$S/remove/domain.kpl" remove/problem.kpl --scene remove/far.json -o far.json
# Messages name the function and what is missing.
expect 3 'has no grasps' "$P" solve "$S/remove/domain.kpl" remove/problem.kpl --scene remove/bare.json -o none.json
sed 's/robot arm/robot leg/; s/(arm/(leg/g' "$S/remove/domain.kpl" >leg.kpl
sed 's/(arm)/(leg)/' remove/problem.kpl >leg-problem.kpl
expect 3 "no robot 'leg'" "$P" solve leg.kpl leg-problem.kpl --scene remove/cell.json -o none.json
sed 's/move(robot, conf) : conf/move(robot) : conf/; s/move(arm, home)/move(arm)/' "$S/remove/domain.kpl" >arity.kpl
expect 3 'takes 2 arguments' "$P" solve arity.kpl remove/problem.kpl --scene remove/cell.json -o none.json
[ ! -e none.json ] || fail "a plan was written"
finish
