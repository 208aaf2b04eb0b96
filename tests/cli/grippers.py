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
    begin = json.loads(json.loads((folder / "held.jsonl").read_text().splitlines()[2])["told"])
    if begin["robots"]["arm"]["q"][-1] != 0.0115 or begin["objects"]["o1"] != {"held_by": "arm"}:
        fail(f"begin: {begin}")


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


main()
