# shellcheck shell=sh disable=SC2154
# Tasks of usual actions: mates and places in a few lines, which kaboum-plan solves without a domain.
HERE=$(cd "$(dirname "$0")" && pwd)
. "$HERE/common.sh"
P=$BIN/kaboum-plan
KABOUM_BIN=$BIN python3 "$HERE/../../examples/tasks/bearings/make-scene" bearings || fail "no scene"
cp "$HERE/../../examples/tasks/bearings/bearings.task" .
expect 0 solved "$P" solve bearings.task -o plan.json --report solve.json
grep -q '"scene": "bearings/cell.json"' solve.json || fail "the report does not name the scene: $(grep scene solve.json)"
shows 0 valid "$P" check bearings.task --plan plan.json
shows 0 'good: 1 branch' "$P" run bearings.task --plan plan.json
expect 0 '' "$P" show bearings.task --plan plan.json --html plan.html
expect 2 'needs --scene' "$P" show "$HERE/../../examples/externals/shelf.kpl" --plan plan.json --html none.html
[ "$(grep -c '"action": "mate"' plan.json)" = 2 ] || fail "not two mates"
[ "$(grep -c '"action": "put"' plan.json)" = 2 ] || fail "not two trees on the tray"
# The whole domain is text that can be read, and solved as it is.
expect 0 '' "$P" convert bearings.task -o all.kpl
grep -q 'mate seated: axis coincident axis' all.kpl && fail "comments are kept"
grep -q 'on(tree1, table)' all.kpl || fail "what stands where is not known"
# The judge has formulas of its own: what is mated is not where another mate would have it.
for other in 's/1 mm within/3 mm within/' 's/axis coincident axis within 0.2 mm/axis distance bottom 5 mm within 0.2 mm/'; do
  sed "$other" bearings.task >other.task
  expect 1 'nor where constraints of its mate have it' "$P" run other.task --plan plan.json
done
# Other constraints between the two do not make it right.
python3 - <<'END'
import json, pathlib
scene = json.loads(pathlib.Path("bearings/cell.json").read_text())
scene["constraints"] = [{"name": "loose", "all": [{"relation": "parallel", "first": "bearing1.z", "second": "tree1.z", "within_angle": 0.5}]}]
pathlib.Path("bearings/loose.json").write_text(json.dumps(scene))
scene["allowed_contacts"] = [["bearing1", "tree1"]]
for thing in scene["objects"]:
    if thing["name"] == "bearing1":  # round the shaft of tree1
        thing["pose"]["position"] = [*scene["objects"][[o["name"] for o in scene["objects"]].index("tree1")]["pose"]["position"][:2], 0.052]
    if thing["name"] == "tree1":
        thing["features"] += [{"name": "entry", "point": [0, 0, 0.1]}]
pathlib.Path("bearings/round.json").write_text(json.dumps(scene))
END
sed 's/1 mm within/3 mm within/; s/cell.json/loose.json/' bearings.task >other.task
expect 1 'nor where constraints of its mate have it' "$P" run other.task --plan plan.json
# What stands on a thing that is fetched goes first, also where its contact is allowed.
printf 'scene bearings/round.json\nhold tree1\n' >round.task
expect 0 solved "$P" solve round.task -o round-plan.json
grep -q '"bearing1"' round-plan.json || fail "the bearing is left in the air"
# The scene may be stated, and has to be somewhere.
grep -v '^scene' bearings.task >bare.task
expect 0 solved "$P" solve bare.task --scene bearings/cell.json -o bare.json
expect 2 "a line 'scene FILE' in it" "$P" solve bare.task -o none.json
expect 2 'needs no problem' "$P" solve bearings.task all.kpl -o none.json
# One thing: several put on one, and held at last.
printf 'scene bearings/cell.json\nput bearing1 bearing2 on tray\nhold tree2 with arm\n' >three.task
expect 0 solved "$P" solve three.task -o three.json
shows 0 'good: 1 branch' "$P" run three.task --plan three.json
# wrong WORDS: a task with these lines on stdin is refused with these words, and its line.
wrong() {
  cat >wrong.task
  expect 3 "wrong.task:$1" "$P" solve wrong.task --scene bearings/cell.json -o none.json
}
wrong "2: the scene has no object 'bearing3'; did you mean 'bearing1'" <<'END'
# a comment
put bearing3 on tray
END
wrong "1: there is no mate 'seat'; did you mean 'seated'" <<'END'
put bearing1 on tree1 by seat
mate seated: axis coincident axis
END
wrong "1: there is no feature 'bearing1/axes'" <<'END'
mate seated: axes coincident axis
put bearing1 on tree1 by seated
END
wrong "1: no relation 'touches'" <<'END'
mate seated: axis touches axis
END
wrong "1: 'bottom distance seat': expected" <<'END'
mate seated: bottom distance seat
END
wrong "1: 'bottom distance seat 1': expected" <<'END'
mate seated: bottom distance seat 1
END
wrong "1: 'bottom distance seat 1 deg': expected" <<'END'
mate seated: bottom distance seat 1 deg
END
wrong "1: 'axis coincident axis within -1 mm': expected" <<'END'
mate seated: axis coincident axis within -1 mm
END
wrong "1: the mate 'seated' has no relation" <<'END'
mate seated: ;
END
wrong "2: a second mate" <<'END'
mate seated: axis coincident axis
mate seated: axis coincident axis
END
wrong "1: expected 'scene', 'mate', 'put' or 'hold', not 'pit'" <<'END'
pit bearing1 on tray
END
wrong "1: 2 objects are put on 3" <<'END'
put bearing1 bearing2 on tree1 tree2 tray
END
wrong "1: no robot can grasp tray" <<'END'
put tray on table
END
wrong "1: table has no point 'top'" <<'END'
put bearing1 on table
END
wrong "1: the scene has no robot 'leg'" <<'END'
hold bearing1 with leg
END
wrong "2: this is asked for twice" <<'END'
mate seated: axis coincident axis
put bearing1 bearing1 on tree1 by seated
END
wrong "2: nothing is to be done" <<'END'
mate seated: axis coincident axis

END
# Constraints that contradict each other are refused, by a proof, before anything is looked for.
printf 'mate both: bottom distance seat 1 mm; bottom distance .origin 1 mm\nput bearing1 on tree1 by both\n' >both.task
expect 3 "both.task:1: the mate 'both': these constraints contradict each other.*'bearing1/bottom' 'tree1/seat'.*'tree1.origin'" \
  "$P" solve both.task --scene bearings/cell.json --no-cache -o none.json
# What no arm reaches is found out by the first call.
printf 'mate far: bottom distance seat 9 m\nput bearing1 on tree1 by far\n' >far.task
expect 7 'does not reach so far' "$P" solve far.task --scene bearings/cell.json --no-cache -o none.json --explain
# Preferences are met where that goes, and said to be some.
printf 'mate turned: axis coincident axis within 0.2 mm; axis angle axis 0 deg within 0.5 deg; bottom distance seat 1 mm within 0.2 mm; prefer .x angle .x 90 deg within 1 deg\nput bearing1 on tree1 by turned\n' >turned.task
expect 0 solved "$P" solve turned.task --scene bearings/cell.json --no-cache -o turned.json
shows 0 'good: 1 branch' "$P" run turned.task --scene bearings/cell.json --plan turned.json
wrong "1: the mate 'a' has no relation but what is preferred" <<'END'
mate a: prefer axis coincident axis
put bearing1 on tree1 by a
END
exit "$FAILED"
