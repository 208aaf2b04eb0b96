#!/usr/bin/env python3
"""Grippers with joints, from a scene to a robot: planned, checked, judged by exact meshes, told to drivers, written as files; what must not
touch is refused.

usage: grippers.py BIN
"""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import jsonschema

TOOLS = pathlib.Path(sys.argv[1]).absolute()
ROOT = pathlib.Path(__file__).resolve().parents[2]
DRIVER = f"{sys.executable} {ROOT / 'examples/drivers/driver.py'}"
LINES = json.loads((ROOT / "docs/driver.schema.json").read_text())
FILES = json.loads((ROOT / "docs/plan-run.schema.json").read_text())
CLAIM = "free but for the pads arm/pad_left and arm/pad_right with what they hold"

# A driver whose fingers stop elsewhere.
LIAR = """class Liar(NoRobot):
    def close(self, robot, link):
        super().close(robot, link)
        self.q[robot][-1] += OFF


def main"""


def fail(what):
    raise SystemExit(f"grippers.py: {what}")


def plan(folder, command, *more, scene="cell.json", problem="problem.kpl"):
    domain = ROOT / "examples/scenarios/force-sensing/domain.kpl"
    report = folder / "report.json"
    report.unlink(missing_ok=True)
    done = subprocess.run([TOOLS / "kaboum-plan", command, domain, problem, "--scene", scene, "--report", "report.json", *more], cwd=folder,
                          capture_output=True, text=True, timeout=300, env=dict(os.environ, PYTHONPATH=str(ROOT / "python/kaboum")))
    return done, json.loads(report.read_text()) if report.exists() else {}


def changed(folder, name, change):
    """The scene with something else in it."""
    scene = json.loads((folder / "cell.json").read_text())
    change(scene)
    (folder / name).write_text(json.dumps(scene))
    return name


def is_planned_and_carried_out(folder):
    done, report = plan(folder, "solve", "-o", "plan.json", "--no-cache")
    if done.returncode != 0 or report["claim"] != CLAIM or CLAIM not in done.stderr:
        fail(f"solve: {done.stderr}, {report.get('claim')}")
    calls = [call for node in json.loads((folder / "plan.json").read_text())["nodes"] for call in node.get("calls", [])]
    motions = [motion for call in calls if call.get("payload", "").startswith("[") for motion in json.loads(call["payload"])]
    closing, opening = ([m for m in motions if kind in m] for kind in ("closes", "opens"))
    if not closing or not opening or any(" by side" not in c["value"] for c in calls if c["external"] == "grasp"):
        fail("no motions of fingers, or no grasps")
    for motion in motions:
        still = [len({row[j] for row in motion["path"]}) == 1 for j in range(7)]
        if still[6] == (motion in closing + opening) or ((motion in closing + opening) and not all(still[:6])):
            fail("fingers or the arm move, not both")
    done, report = plan(folder, "check", "--plan", "plan.json")
    if done.returncode != 0 or report["claim"] != CLAIM:
        fail(f"check: {done.stdout}")
    done, report = plan(folder, "run", "--plan", "plan.json", "--outcomes", "all", "--trajectories", "files", "--blend", "0.4")
    if done.returncode != 0 or report["collisions"] or report["jumps"] or report["limit_violations"] or report["claim"] != CLAIM:
        fail(f"run: {done.stdout}{done.stderr}")
    written = json.loads((folder / "files/plan.json").read_text())
    defs = {**FILES["$defs"], **{k: v for k, v in LINES["$defs"].items() if k not in FILES["$defs"]}}
    schema = json.loads(json.dumps({**FILES, "$defs": defs}).replace("driver.schema.json#", "#"))
    jsonschema.Draft202012Validator(schema).validate(written)
    events = [e for step in written["steps"] for e in step["events"] if e["event"] in ("take", "release")]
    if not events or any("gripper" not in e or not (folder / "files" / e["file"]).exists() or e["duration"] <= 0 for e in events):
        fail(f"events: {events[:2]}")


def is_told_to_drivers(folder):
    robot = DRIVER + ' --sense "isSpillable(o1)=true" --sense "isSpillable(o2)=false"'
    done, report = plan(folder, "run", "--plan", "plan.json", "--robot", robot, "--journal", "journal.jsonl")
    if done.returncode != 0 or report["verdict"] != "good":
        fail(f"driver: {done.stdout}{done.stderr}")
    told = [json.loads(line["told"]) for line in map(json.loads, (folder / "journal.jsonl").read_text().splitlines()) if "told" in line]
    lines = jsonschema.Draft202012Validator({**LINES, "anyOf": [{"$ref": "#/$defs/told"}]})
    for message in told:
        lines.validate(message)
    takes = [m for m in told if m["do"] == "take"]
    if [m["gripper"]["to"] for m in takes] != [[0.0115]] * 2 or any(m["gripper"]["pads"] != ["pad_left", "pad_right"] for m in takes):
        fail(f"takes: {takes}")
    wrong = json.loads(json.dumps(takes[0]))
    wrong["gripper"]["within"] = -1
    if lines.is_valid(wrong):
        fail("the schema takes anything")
    # Fingers that stop elsewhere than the plan can vouch for end the run; a little off is what `within` is for.
    for off, code in ((0.0009, 0), (0.0011, 1), (-0.004, 1)):
        liar = folder / "liar.py"
        text = (ROOT / "examples/drivers/driver.py").read_text().replace("def main", LIAR.replace("OFF", str(off)))
        liar.write_text(text.replace("    NoRobot(parser", "    Liar(parser"))
        done, report = plan(folder, "run", "--plan", "plan.json", "--robot",
                            f'{sys.executable} {liar} --sense "isSpillable(o1)=true" --sense "isSpillable(o2)=false"')
        if done.returncode != code or (code and "away from where it was told to be" not in done.stderr):
            fail(f"fingers {off} m off: {done.returncode} {done.stderr}")


def what_is_held_at_first_is_held_so(folder):
    """A container in the hand when the plan begins: fingers are as its grasp says, and a driver is held to it."""
    scene = json.loads((folder / "cell.json").read_text())
    scene["attachments"] = [{"object": "o1", "robot": "arm", "gripper": "fingers", "grasp": "side3"}]
    (folder / "held.json").write_text(json.dumps(scene))
    problem = (folder / "problem.kpl").read_text().replace("K(!isGrasped(o1))", "K(isGrasped(o1)), K(!isSpillable(o1))").replace("K(emptyGripper)", "K(!emptyGripper)")
    (folder / "held.kpl").write_text(problem)
    done, _ = plan(folder, "solve", "-o", "held-plan.json", "--no-cache", scene="held.json", problem="held.kpl")
    if done.returncode != 0 or "contact of o1 and arm/pad_left and arm/pad_right, which hold it, is left out" not in done.stderr:
        fail(f"held: {done.returncode} {done.stderr}")
    liar = folder / "begun.py"
    for off, code in ((0.0, 0), (0.002, 1)):
        text = (ROOT / "examples/drivers/driver.py").read_text()
        liar.write_text(text.replace("    def where(", f"    def begin(self, robots, objects):\n        self.q['arm'][-1] += {off}\n\n    def where("))
        done, _ = plan(folder, "run", "--plan", "held-plan.json", "--robot", f'{sys.executable} {liar} --sense "isSpillable(o1)=true" --sense "isSpillable(o2)=true"',
                       "--journal", "held.jsonl", scene="held.json", problem="held.kpl")
        if done.returncode != code or (code and "away from where it was told to be" not in done.stderr):
            fail(f"held, {off} m off: {done.returncode} {done.stdout} {done.stderr}")
    begin = next(json.loads(line["told"]) for line in map(json.loads, (folder / "held.jsonl").read_text().splitlines()) if "told" in line)
    if begin["robots"]["arm"]["q"][-1] != 0.0115 or begin["objects"]["o1"] != {"held_by": "arm"}:
        fail(f"begin: {begin}")


def tool(folder, name, *arguments):
    done = subprocess.run([TOOLS / name, *arguments], cwd=folder, capture_output=True, text=True, timeout=300)
    return done


def paths_keep_fingers_where_they_hold(folder):
    """What is in the hand: paths are found and decided with its fingers where the grasp has them, and wherever they may stop."""
    home = [0, -0.5, 1.7, 0, 1.9415926535897932, 0]
    there = [2.2, *home[1:]]

    def rows(*configurations):
        (folder / "given.csv").write_text("".join(",".join(map(str, q)) + "\n" for q in configurations))

    scene = json.loads((folder / "held.json").read_text())
    # In between, so that it goes round.
    scene["objects"].append({"name": "wall", "shape": {"box": {"size": [0.5, 0.02, 0.4]}}, "pose": {"position": [0.18, 0.356, 0.85], "rpy": [0, 0, 1.1]}})
    (folder / "wall.json").write_text(json.dumps(scene))
    to = ",".join(map(str, [*there, 0.0115]))
    done = tool(folder, "kaboum-move", "wall.json", "--to", to, "-o", "way.csv")
    if done.returncode != 0:
        fail(f"move: {done.returncode} {done.stderr}")
    way = [line.split(",") for line in (folder / "way.csv").read_text().splitlines()]
    way = way[1:] if way[0][0] == "j1" else way
    if len(way) < 3 or {float(q[-1]) for q in way} != {0.0115}:
        fail(f"move: fingers move: {[q[-1] for q in way]}")
    done = tool(folder, "kaboum-check", "wall.json", "--path", "way.csv")
    if done.returncode != 0:
        fail(f"check of it: {done.stdout} {done.stderr}")
    for goal, words in (([*there, 0.018], ("goal", "'finger'", "'o1'", "0.0115", "0.018")), ([*there, 0.0121], ())):
        done = tool(folder, "kaboum-move", "held.json", "--to", ",".join(map(str, goal)), "-o", "no.csv")
        if (done.returncode != 0) != bool(words) or any(word not in done.stderr for word in words):
            fail(f"move to {goal}: {done.returncode} {done.stderr}")
        rows([*home, 0.0115], goal)
        done = tool(folder, "kaboum-check", "held.json", "--path", "given.csv")
        if (done.returncode != 0) != bool(words) or any(word not in done.stderr for word in words if word != "goal"):
            fail(f"check to {goal}: {done.returncode} {done.stdout} {done.stderr}")
    done = tool(folder, "kaboum-move", "held.json", "--to", to, "--roadmap", "map.json", "-o", "no.csv")
    if done.returncode == 0 or "--roadmap" not in done.stderr or (folder / "map.json").exists():
        fail(f"roadmap: {done.returncode} {done.stderr}")


def configurations_are_free_wherever_fingers_stop(folder):
    """One, those of a file, those of a batch, and motions of several robots, as paths are."""
    home = [0, -0.5, 1.7, 0, 1.9415926535897932, 0, 0.0115]
    one, off = ",".join(map(str, home)), ",".join(map(str, [*home[:-1], 0.018]))
    (folder / "few.csv").write_text(f"{one}\n{one}\n")
    (folder / "off.csv").write_text(f"{one}\n{off}\n")
    ways = (["--configuration", one], ["--configurations", "few.csv"], ["--batch", "few.csv"], ["--batch", "few.csv", "--motions", "pairs"])
    held = json.loads((folder / "held.json").read_text())
    loose = json.loads(json.dumps(held))
    for g in [g for o in loose["objects"] for g in o["grasps"]]:  # wherever they stop: in the neck as well
        g["within"] = 0.008
    other = dict(json.loads(json.dumps(held["robots"][0])), name="other", base={"position": [5, 0, 0]})
    for name, scene, code in (("held", held, 0), ("loose-held", loose, 1)):
        (folder / f"{name}.json").write_text(json.dumps(scene))
        (folder / f"{name}-two.json").write_text(json.dumps({**scene, "robots": [*scene["robots"], other]}))
        for way in ([], *ways):
            done = tool(folder, "kaboum-check", f"{name}.json", *way, "--report", "checked.json")
            report = json.loads((folder / "checked.json").read_text())
            if done.returncode != code or (report["answer"] == "free") != (code == 0):
                fail(f"{name} {way}: {done.returncode} {done.stdout} {done.stderr}")
            if code and way[:1] != ["--batch"] and "not free for certain wherever fingers stop" not in done.stdout:
                fail(f"{name} {way}: {done.stdout}")
            # One that stands has no waypoints, and nothing of the way.
            said = [line for line in done.stdout.splitlines() if "wherever fingers stop" in line]
            if "waypoint" in "".join(said) or any(" and " not in line.split(": ", 1 + ("configuration" in line))[-1] for line in said):
                fail(f"{name} {way}: words of what stands: {said}")
            for one in report.get("configurations", []):
                if "fingers" in one and ("waypoint" in json.dumps(one["fingers"]) or "pair" not in one["fingers"]["contact"]):
                    fail(f"{name} {way}: {one['fingers']}")
        done = tool(folder, "kaboum-check", f"{name}-two.json", "--path", "arm=few.csv", "--path", "other=few.csv")
        if done.returncode != code:
            fail(f"{name}, two robots: {done.returncode} {done.stdout} {done.stderr}")
        # Of a robot that holds nothing, beside one that does.
        for way in ways:
            done = tool(folder, "kaboum-check", f"{name}-two.json", "--robot", "other", *way)
            if done.returncode != code:
                fail(f"{name}, the other robot {way}: {done.returncode} {done.stdout} {done.stderr}")
    # Each row of a batch is looked at, also where a grasp has no room and the first row is as it says.
    exact = json.loads(json.dumps(held))
    for g in [g for o in exact["objects"] for g in o["grasps"]]:
        g["within"] = 0
    (folder / "exact.json").write_text(json.dumps(exact))
    done = tool(folder, "kaboum-check", "exact.json", "--batch", "off.csv")
    if done.returncode != 3 or "row 2" not in done.stderr:
        fail(f"exact: {done.returncode} {done.stdout} {done.stderr}")
    for way in (["--configuration", off], ["--configurations", "off.csv"], ["--batch", "off.csv"], ["--batch", "off.csv", "--motions", "pairs"]):
        done = tool(folder, "kaboum-check", "held.json", *way)
        if done.returncode != 3 or any(word not in done.stderr for word in (way[1] if "off" in way[1] else way[0], "'finger'", "0.018", "state 0.0115")):
            fail(f"off {way}: {done.returncode} {done.stdout} {done.stderr}")


def fingers_that_are_there_already_close(folder):
    """Where the opening is that of home: told, and held to, as any other."""
    def as_home(scene):
        scene["robots"][0]["home"]["finger"] = 0.0135
        for o in scene["objects"]:
            for g in o["grasps"]:
                g["opening"]["finger"] = 0.0135

    name = changed(folder, "still.json", as_home)
    done, _ = plan(folder, "solve", "-o", "still-plan.json", "--no-cache", scene=name)
    if done.returncode != 0:
        fail(f"still: {done.returncode} {done.stderr}")
    sense = '--sense "isSpillable(o1)=true" --sense "isSpillable(o2)=false"'
    done, report = plan(folder, "run", "--plan", "still-plan.json", "--robot", f"{DRIVER} {sense}", "--journal", "still.jsonl", scene=name)
    if done.returncode != 0 or report["verdict"] != "good":
        fail(f"still: {done.returncode} {done.stdout} {done.stderr}")
    told = [json.loads(line["told"]) for line in map(json.loads, (folder / "still.jsonl").read_text().splitlines()) if "told" in line]
    takes = [m for m in told if m["do"] == "take"]
    if len(takes) != 2 or any(m.get("gripper", {}).get("to") != [0.0135] or m["gripper"]["from"] != [0.0135] for m in takes):
        fail(f"still: {takes}")
    done, report = plan(folder, "run", "--plan", "still-plan.json", "--outcomes", "all", "--trajectories", "still-files", scene=name)
    if done.returncode != 0 or report["jumps"] or report["collisions"]:
        fail(f"still files: {done.stdout} {done.stderr}")
    liar = folder / "liar.py"
    text = (ROOT / "examples/drivers/driver.py").read_text().replace("def main", LIAR.replace("OFF", "0.004"))
    liar.write_text(text.replace("    NoRobot(parser", "    Liar(parser"))
    done, _ = plan(folder, "run", "--plan", "still-plan.json", "--robot", f"{sys.executable} {liar} {sense}", scene=name)
    if done.returncode != 1 or "away from where it was told to be" not in done.stderr:
        fail(f"still, off: {done.returncode} {done.stderr}")


def what_is_held_without_a_motion_is_taken(folder):
    """A function of a user's own says that a thing is in the hand, and no motion goes there: fingers that are there are told to close all the same, and
    held to it."""
    calls = [call for node in json.loads((folder / "still-plan.json").read_text())["nodes"] for call in node.get("calls", [])]
    word = next(call["value"] for call in calls if call["external"] == "grasp" and "o1" in call["arguments"])
    (folder / "own.kpl").write_text("""domain own
types: object, container, robot, conf handle, pose handle
constants: robot arm; container o1; conf home; pose start
predicates: isHeld(container)
functions: conf(robot) : conf; pose(container) : pose
externals: hold(container) : pose
action hold(?o : container)
  preconds: K(!isHeld(?o)) & let ?p = extern(hold(?o))
  effects: add(Kf, isHeld(?o)), add(Kf, pose(?o) = ?p)
init: K(!isHeld(o1)), K(conf(arm) = home), K(pose(o1) = start)
goal: K(isHeld(o1))
""")
    (folder / "own.py").write_text(f"""import json, sys
print(json.dumps({{"kaboum_externals": 1, "functions": ["hold"]}}), flush=True)
for line in sys.stdin:
    if "function" in json.loads(line):
        print(json.dumps({{"value": {word!r}}}), flush=True)
""")
    task = ["own.kpl", "--scene", "still.json", "--process", f"{sys.executable} own.py"]
    done = tool(folder, "kaboum-plan", "solve", *task, "-o", "own-plan.json", "--no-cache")
    if done.returncode != 0:
        fail(f"own: {done.returncode} {done.stderr}")
    for robot, end in ((DRIVER, "goal"), (f"{sys.executable} liar.py", "elsewhere")):
        done = subprocess.run([TOOLS / "kaboum-plan", "run", *task, "--plan", "own-plan.json", "--robot", robot, "--journal", "own.jsonl", "--report", "own.json"], cwd=folder,
                              capture_output=True, text=True, timeout=300, env=dict(os.environ, PYTHONPATH=str(ROOT / "python/kaboum")))
        # That the thing is in the hand at once is seen by the judge.
        report = json.loads((folder / "own.json").read_text())
        if done.returncode != 1 or report["driver"]["end"] != end or (end == "goal" and not report["jumps"]):
            fail(f"own, {end}: {done.returncode} {report['driver']} {done.stderr}")
        told = [json.loads(line["told"]) for line in map(json.loads, (folder / "own.jsonl").read_text().splitlines()) if "told" in line]
        (take,) = [m for m in told if m["do"] == "take"]
        if any(m["do"] == "move" for m in told) or take["object"] != "o1" or take["gripper"]["from"] != [0.0135] or take["gripper"]["to"] != [0.0135]:
            fail(f"own, {end}: {take}")
    # With fingers elsewhere at home no motion closes them: that is no plan for a robot.
    still = json.loads((folder / "still.json").read_text())
    still["robots"][0]["home"]["finger"] = 0.016
    (folder / "open.json").write_text(json.dumps(still))
    task[2] = "open.json"
    done = tool(folder, "kaboum-plan", "run", *task, "--plan", "own-plan.json", "--robot", DRIVER, "--report", "own.json")
    if done.returncode != 1 or "no motion of the plan closes or opens it" not in done.stderr:
        fail(f"own, open: {done.returncode} {done.stdout} {done.stderr}")


def motions_of_fingers_are_such(folder):
    """Plans of others: fingers close and open by motions of their own, or the plan is not carried out."""
    def run(change):
        made = json.loads((folder / "plan.json").read_text())
        for node in made["nodes"]:
            for call in node.get("calls", []):
                if call["external"] == "grasp":
                    call["payload"] = json.dumps([change(motion) for motion in json.loads(call["payload"])])
        (folder / "changed-plan.json").write_text(json.dumps(made))
        return plan(folder, "run", "--plan", "changed-plan.json", "--outcomes", "all")

    def with_arm(motion):
        motion["path"][-1][0] += 0.01
        return motion

    def with_way(motion):
        motion["path"].append(motion["path"][-1])
        return motion

    for change in (with_arm, with_way):
        done, _ = run(change)
        if done.returncode == 0 or "two points that differ in joints of the gripper alone" not in done.stderr:
            fail(f"fingers: {done.returncode} {done.stdout} {done.stderr}")

    def by_another(motion):  # which opens as far
        motion["grasps"]["o1" if "o1" in motion["grasps"] else "o2"] = "side5"
        return motion

    done, report = run(by_another)
    if done.returncode == 0 or not report["jumps"] or "held by another grasp" not in done.stdout + done.stderr:
        fail(f"by another grasp: {done.returncode} {done.stdout} {done.stderr}")


def engines_claim_nothing(folder):
    done, report = plan(folder, "check", "--plan", "plan.json", "--engine", "fcl")
    if "unknown" in done.stderr or "not built" in done.stderr or "without" in done.stderr:
        return  # there is no such engine here
    if "claim" in report:
        fail(f"an engine's claim: {report['claim']} {done.stderr}")


def what_must_not_touch_is_refused(folder):
    def grasps(scene):
        return [g for o in scene["objects"] for g in o["grasps"]]

    def closed_too_far(scene):  # the fingers behind the pads would be in the neck
        for g in grasps(scene):
            g["opening"]["finger"] = 0.0055

    def loose(scene):  # wherever they stop within 8 mm: they would be in the neck as well
        for g in grasps(scene):
            g["within"] = 0.008

    def beside(scene):  # round each neck, between the open pads and where they close
        for o in [o for o in scene["objects"] if o["grasps"]]:
            x, y, z = o["pose"]["position"]
            for k in range(16):
                a = math.pi * k / 8
                scene["objects"].append({"name": f"post{k}-{o['name']}", "shape": {"cylinder": {"radius": 0.0008, "length": 0.01}},
                                         "pose": {"position": [x + 0.0155 * math.cos(a), y + 0.0155 * math.sin(a), z + 0.146]}})

    for name, change, words in (("far", closed_too_far, "does not close on o1, in the way: arm/finger"), ("loose", loose, "does not close on o1"),
                                ("beside", beside, "does not close on o1, in the way: arm/pad")):
        done, report = plan(folder, "solve", "-o", "no-plan.json", "--no-cache", "--explain", "--timeout", "30", scene=changed(folder, name + ".json", change))
        if done.returncode not in (1, 7) or words not in done.stderr or (folder / "no-plan.json").exists():
            fail(f"{name}: {done.returncode} {done.stderr}")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([ROOT / "examples/scenarios/force-sensing/run", "2", "--fingers", "--scene-only", "--out", folder], check=True,
                       env=dict(os.environ, KABOUM_BIN=str(TOOLS)), timeout=300)
        is_planned_and_carried_out(folder)
        is_told_to_drivers(folder)
        what_must_not_touch_is_refused(folder)
        what_is_held_at_first_is_held_so(folder)
        paths_keep_fingers_where_they_hold(folder)
        configurations_are_free_wherever_fingers_stop(folder)
        fingers_that_are_there_already_close(folder)
        what_is_held_without_a_motion_is_taken(folder)
        motions_of_fingers_are_such(folder)
        engines_claim_nothing(folder)


main()
