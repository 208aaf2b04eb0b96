#!/usr/bin/env python3
"""kaboum-plan run --robot: a driver that behaves, ones that do not, journals repeated, plans made again.

usage: drive.py BIN
"""
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import time

import jsonschema
import yaml

TOOLS = pathlib.Path(sys.argv[1]).absolute()
ROOT = pathlib.Path(__file__).resolve().parents[2]
DRIVER = f"{sys.executable} {ROOT / 'examples/drivers/driver.py'}"
SCHEMA = json.loads((ROOT / "docs/driver.schema.json").read_text())
RUNS = int(os.environ.get("KABOUM_TEST_DRIVERS", "25"))  # with faults at random

# A driver in front of another one that answers the end of the plan twice.
TWICE = """import subprocess, sys
driver = subprocess.Popen(sys.argv[1:], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
print(driver.stdout.readline(), end="", flush=True)
for line in sys.stdin:
    driver.stdin.write(line)
    driver.stdin.flush()
    print(driver.stdout.readline() * (2 if '"finish"' in line else 1), end="", flush=True)
"""


# A driver as the example is, but for what it answers to motions.
LIAR = """class Liar(NoRobot):
    def answer(self, message):
        reply = super().answer(message)
        if message["do"] == "move":
            STATEMENT
        return reply


def main"""


def fail(what):
    raise SystemExit(f"drive.py: {what}")


def run(folder, robot, *more):
    files = [x for option, file in (("--report", "report.json"), ("--journal", "journal.jsonl")) if option not in more for x in (option, file)]
    command = [TOOLS / "kaboum-plan", "run", "domain.kpl", "problem.kpl", "--scene", "cell.json", "--plan", "plan.json", "--quiet",
               *files, *(["--robot", robot] if robot else []), *more]
    (folder / "report.json").unlink(missing_ok=True)
    environment = dict(os.environ, PYTHONPATH=str(ROOT / "python/kaboum"))  # for drivers that are written here
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300, env=environment)
    if done.returncode < 0:
        fail(f"{robot}: signal {-done.returncode}")
    report = folder / "report.json"
    return done, json.loads(report.read_text()) if report.exists() else None


def journal(folder, name="journal.jsonl"):
    return [json.loads(line) for line in (folder / name).read_text().splitlines()]


def lie(folder, statement):
    """The command of a driver that says something else of motions."""
    file = folder / "liar.py"
    text = (ROOT / "examples/drivers/driver.py").read_text()
    file.write_text(text.replace("def main", LIAR.replace("STATEMENT", statement)).replace("    NoRobot(parser", "    Liar(parser"))
    return f"{sys.executable} {file}"


def keeps_schema(folder):
    """Every line of a run keeps to the schema; one that lacks something, or has a word of another kind, does not."""
    def validator(part):
        return jsonschema.Draft202012Validator({**SCHEMA, "anyOf": [{"$ref": f"#/$defs/{part}"}]})
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    kinds = set()
    for number, entry in enumerate(journal(folder)[1:]):
        for key, part in (("told", "told"), ("heard", "answered" if number else "ready")):
            if key not in entry:
                continue
            line = json.loads(entry[key])
            for points in ([line["trajectory"]["points"]] if "trajectory" in line else []):
                del points[2:-2]
            check = validator(part)
            for error in check.iter_errors(line):
                fail(f"{entry[key][:200]}: {error.message[:200]}")
            kind = line.get("do", part)
            if kind in kinds:
                continue
            kinds.add(kind)
            for field in line:
                if (kind, field) not in (("finish", "objects"), ("answered", "q")) and check.is_valid({k: v for k, v in line.items() if k != field}):
                    fail(f"{entry[key][:200]} would do without '{field}'")
    if not kinds >= {"ready", "begin", "act", "move", "take", "release", "sense", "finish", "answered"}:
        fail(f"what was looked at: {kinds}")


def told_motions(folder):
    return [m["trajectory"]["points"] for m in (json.loads(e["told"]) for e in journal(folder) if "told" in e) if m["do"] == "move"]


def within_limits(points, velocity, acceleration, jerk):
    """By differences of the points, which are equally far apart; and velocities and accelerations are those of the curve, as far as the jerk
    lets them be otherwise between."""
    h = points[1]["time_from_start"] - points[0]["time_from_start"]
    q = [p["positions"] for p in points]
    for k in range(len(points) - 1):
        for j in range(len(q[0])):
            if abs(q[k + 1][j] - q[k][j]) > velocity * h * (1 + 1e-6):
                fail("a motion is too fast")
            a, b = points[k], points[k + 1]
            if abs(b["velocities"][j] - a["velocities"][j]) > acceleration * h * (1 + 1e-6) or abs(a["accelerations"][j]) > acceleration * (1 + 1e-6):
                fail("a motion accelerates too much")
            if abs(b["accelerations"][j] - a["accelerations"][j]) > jerk * h * (1 + 1e-6):
                fail("an acceleration jumps")
            if abs(q[k + 1][j] - q[k][j] - h / 2 * (a["velocities"][j] + b["velocities"][j])) > jerk * h**3 / 12 * (1 + 1e-6) + 1e-12:
                fail("velocities are not those of the points")


def folder_of_files(folder, *more):
    """--trajectories has what a robot is told: motions with their points, what is taken, let go and sensed, in this order."""
    done, report = run(folder, DRIVER, "--robot-rate", "200", *more)
    if done.returncode != 0:
        fail(f"{done.stderr}")
    told = [json.loads(e["told"]) for e in journal(folder) if "told" in e]
    heard = {m["id"]: m for m in (json.loads(e["heard"]) for e in journal(folder) if "heard" in e) if "id" in m}
    sensed = {m["fact"]: heard[m["id"]]["sensed"] for m in told if m["do"] == "sense"}
    for form in ("csv", "json", "yaml"):
        done = subprocess.run([TOOLS / "kaboum-plan", "run", "domain.kpl", "problem.kpl", "--scene", "cell.json", "--plan", "plan.json", "--quiet", "--rate", "200",
                               "--trajectories", f"files-{form}", "--trajectory-format", form, *more], cwd=folder, capture_output=True, text=True)
        if done.returncode != 0:
            fail(f"files: exit code {done.returncode}: {done.stderr}")
        plan = json.loads((folder / f"files-{form}/plan.json").read_text())
        schema = json.loads((ROOT / "docs/plan-run.schema.json").read_text())
        places = schema["properties"]["plans"]["items"]["properties"]["start"]["properties"]
        places["objects"] = SCHEMA["$defs"]["places"]
        check = jsonschema.Draft202012Validator(schema)
        for error in check.iter_errors(plan):
            fail(f"plan.json: {error.message[:200]}")
        for field in schema["required"]:
            if check.is_valid({k: v for k, v in plan.items() if k != field}):
                fail(f"plan.json would do without '{field}'")
        begin = next(m for m in told if m["do"] == "begin")
        if plan["plans"][0]["start"]["robots"] != {name: r["q"] for name, r in begin["robots"].items()} or \
                plan["plans"][0]["start"]["objects"] != begin["objects"]:
            fail("the start is not that of the robot")
        events, number = [], plan["plans"][0]["first"]
        while number is not None:
            step = plan["steps"][number]
            events.append(("act", step["action"]))
            # With what was sensed: other ways are there, too.
            way = way_of(step, sensed)
            time = 0
            for event in [*step["events"], *way["events"]]:
                if event["time"] != time:
                    fail(f"{event} at another time than {time}")
                time += event.get("duration", 0)
                events.append(seen_in_files(folder / f"files-{form}", event))
            number = way["next"]
        wanted = []
        for m in told:
            if m["do"] == "move":
                points = m["trajectory"]["points"]
                wanted.append(("move", m["robot"], points[-1]["time_from_start"], points[len(points) // 2]["positions"]))
            elif m["do"] in ("take", "release"):
                wanted.append((m["do"], m["robot"], m["object"]))
            elif m["do"] == "sense":
                wanted.append(("sense", m["fact"], sensed[m["fact"]]))
            elif m["do"] == "act":
                wanted.append(("act", m["action"]))
        if [e for e in events if e != ("act", "")] != wanted:
            fail(f"files and robot: {[x for x in zip(events, wanted) if x[0] != x[1]][:2]}, {len(events)} and {len(wanted)}")
        lines = (folder / f"files-{form}/events.csv").read_text().splitlines()
        count = sum(len(s["events"]) + sum(len(w["events"]) + 1 for w in s["ways"]) for s in plan["steps"])
        if len(lines) != count + 1 or lines[0] != "step,way,action,time,event,robot,object,link,file,duration,fact,value,next,plan":
            fail(f"events.csv has {len(lines)} lines, for {count} events")
        rows = list(csv.DictReader(lines))
        if sum(r["event"] == "take" and r["link"] == "hand" for r in rows) != sum(
                e["event"] == "take" for s in plan["steps"] for e in [*s["events"], *(x for w in s["ways"] for x in w["events"])]):
            fail("what is taken is not in events.csv")


def way_of(step, sensed):
    """The way of a step by what is sensed, found as docs/planning/trajectories.md says."""
    if len({json.dumps([w["if"], w["sensed"]]) for w in step["ways"]}) < len(step["ways"]):
        fail(f"ways that nothing tells apart: {step}")
    fitting = [w for w in step["ways"] if (w["if"] is None or sensed[w["if"]["fact"]] == w["if"]["value"]) and all(sensed[f] == v for f, v in w["sensed"].items())]
    if len(fitting) != 1:
        fail(f"{len(fitting)} ways fit in {step}")
    return fitting[0]


def planned_again_in_files(folder, *more):
    """Where a plan lacks a branch its files name the plan that goes on; only the goal has neither a next step nor a plan."""
    done = subprocess.run([TOOLS / "kaboum-plan", "run", "domain.kpl", "problem.kpl", "--scene", "cell.json", "--plan", "plan.json", "--quiet",
                           "--trajectories", "files-again", "--report", "again.json", *more], cwd=folder, capture_output=True, text=True)
    plan, report = (json.loads((folder / f).read_text()) for f in ("files-again/plan.json", "again.json"))
    schema = json.loads((ROOT / "docs/plan-run.schema.json").read_text())
    schema["properties"]["plans"]["items"]["properties"]["start"]["properties"]["objects"] = SCHEMA["$defs"]["places"]
    check = jsonschema.Draft202012Validator(schema)
    for error in check.iter_errors(plan):
        fail(f"plan.json: {error.message[:200]}")
    missing = [(w["if"], w["plan"]) for s in plan["steps"] for w in s["ways"] if "plan" in w]
    rows = list(csv.DictReader((folder / "files-again/events.csv").read_text().splitlines()))
    if [(r["fact"], r["plan"]) for r in rows if r["plan"]] != [(i["fact"], str(p)) for i, p in missing if p is not None]:
        fail("events.csv names other plans")
    if any(w["next"] is not None for s in plan["steps"] for w in s["ways"] if "plan" in w):
        fail("a way that is not planned for goes on")
    return done, plan, report, missing


def seen_in_files(folder, event):
    """An event as a robot is told it."""
    if event["event"] == "sense":
        return ("sense", event["fact"], event["value"])
    if event["event"] != "move":
        return (event["event"], event["robot"], event["object"])
    text = (folder / event["file"]).read_text()
    if event["file"].endswith(".csv"):
        points = [[float(x) for x in line.split(",")][1:] for line in text.splitlines()[1:]]
    else:
        points = [p["positions"] for p in (json.loads(text) if event["file"].endswith(".json") else yaml.safe_load(text))["points"]]
    if abs((len(points) - 1) / 200 - event["duration"]) > 1e-9:
        fail(f"{event} has {len(points)} samples")
    return ("move", event["robot"], event["duration"], points[len(points) // 2])


def judge(folder, finished):
    """What the robot was told, by rules of this test: motions join, points are joined by straight lines in time, one message at a time,
    nothing after a stop; what is held is taken once and let go by who holds it."""
    at, held, waiting, stopped, finish = {}, set(), False, False, False
    for entry in journal(folder)[1:]:
        if "told" in entry:
            waiting, message, before = True, json.loads(entry["told"]), waiting
            if before or stopped or finish and message["do"] != "finish":  # which is said again where it has failed
                fail(f"told out of turn: {entry}")
            if message["do"] == "begin":
                at = {name: robot["q"] for name, robot in message["robots"].items()}
                held = {(name, o["held_by"]) for name, o in message["objects"].items() if "held_by" in o}
            elif message["do"] == "move":
                points = message["trajectory"]["points"]
                if points[0]["positions"] != at[message["robot"]]:
                    fail("a motion does not begin where the robot is")
                times = [p["time_from_start"] for p in points]
                if times != sorted(set(times)) or times[0] != 0:
                    fail("times do not grow")
                for p in (points[0], points[-1]):
                    if any(abs(v) > 1e-9 for v in p["velocities"]):
                        fail("a motion does not begin and end at rest")
            elif message["do"] == "take":
                if (message["object"], message["robot"]) in held:
                    fail("taken twice")
            elif message["do"] == "release" and (message["object"], message["robot"]) not in held:
                fail("let go by another one")
            finish = message["do"] == "finish"
        elif "heard" in entry:
            if not waiting and at:
                fail(f"heard out of turn: {entry}")
            waiting = False
            answer = json.loads(entry["heard"]) if entry["heard"].startswith("{") and entry["heard"].endswith("}") else {}
            if at and isinstance(answer, dict) and answer.get("done") is True and answer.get("id") == message["id"]:
                if message["do"] == "move":
                    at[message["robot"]] = message["trajectory"]["points"][-1]["positions"]
                elif message["do"] == "take":
                    held.add((message["object"], message["robot"]))
                elif message["do"] == "release":
                    held.remove((message["object"], message["robot"]))
        elif "stopped" in entry:
            stopped, waiting = True, False
    if finish != finished and not (finish and stopped):
        fail("the end of the plan is said though it was not reached" if finish else "the end of the plan is not said")


def journals_that_fail(folder):
    """A journal that nobody reads from a line on: the robot is stopped, unless it has come to its end, and the report is there."""
    os.mkfifo(folder / "pipe.jsonl")
    for last, end in (("finished", "goal"), ("heard", "journal"), ("step_done", "journal"), ("kaboum_journal", "journal"), ("stopped", "failed")):
        lines = []

        def read_until_last(last=last, lines=lines):
            with open(folder / "pipe.jsonl", encoding="utf-8") as pipe:
                for line in pipe:
                    lines.append(json.loads(line))
                    if last in lines[-1] and (last != "heard" or "done" in lines[-1]["heard"]):
                        return

        reader = threading.Thread(target=read_until_last, daemon=True)
        reader.start()
        robot = DRIVER if end != "failed" else lie(folder, 'reply = {"id": message["id"], "failed": "for a test"}')
        done, report = run(folder, robot, "--journal", "pipe.jsonl")
        reader.join()
        if done.returncode != 4 or "pipe.jsonl: cannot be written: the journal lacks the end of the run" not in done.stderr:
            fail(f"a journal that nobody reads after '{last}': exit code {done.returncode}: {done.stderr}")
        if report is None or report["driver"]["end"] != end or "pipe.jsonl" not in report["driver"]["not_noted"] or (report["verdict"] == "good") != (end == "goal"):
            fail(f"a journal that nobody reads after '{last}': {report and report['driver']}")
        if last == "step_done" and report["samples"] < 100:
            fail(f"a journal that nobody reads after a step: {report['samples']} samples are judged")
    if pathlib.Path("/dev/full").exists():
        done, report = run(folder, DRIVER, "--journal", "/dev/full")
        if done.returncode != 4 or report is None or report["driver"]["messages"] != 0 or report["driver"]["end"] != "journal":
            fail(f"a full disk: exit code {done.returncode}: {report and report['driver']}: {done.stderr}")


def stopped_before_it_is_judged(folder):
    """The driver is told to stop before the exact meshes are looked at: its last word is older than the verdict."""
    driver = """from driver import Driver, Failure


class Stopping(Driver):
    moved = 0

    def move(self, robot, motion):
        self.moved += 1
        if self.moved == 4:
            raise Failure("for a test")

    def sense(self, fact, values):
        return values[0]

    def stop(self):
        open("stopped", "w").close()


Stopping().run()
"""
    (folder / "stopping.py").write_text(driver)
    done, report = run(folder, f"{sys.executable} stopping.py", "--robot-retries", "0")
    if done.returncode != 1 or report["driver"]["end"] != "failed" or report["motions"] < 3 or "verdict" not in journal(folder)[-1]:
        fail(f"a driver that fails: exit code {done.returncode}: {report and report['driver']}: {done.stderr}")
    if not (folder / "stopped").stat().st_mtime_ns < (folder / "journal.jsonl").stat().st_mtime_ns:
        fail("the driver is told to stop after the run was judged")


def stops_without_its_planner(folder):
    """The planner is killed while the driver moves: the driver sees the end of its input, and has time to stop."""
    driver = """import json, sys, time

print('{"kaboum_driver": 1}', flush=True)
for line in sys.stdin:
    message = json.loads(line)
    if message["do"] == "move":
        open("moving", "w").close()  # and says nothing
    elif "id" in message:
        print(json.dumps({"id": message["id"], "done": True}), flush=True)
time.sleep(0.05)
open("stopped", "w").close()
"""
    (folder / "alone.py").write_text(driver)
    for name in ("moving", "stopped"):
        (folder / name).unlink(missing_ok=True)
    command = [TOOLS / "kaboum-plan", "run", "domain.kpl", "problem.kpl", "--scene", "cell.json", "--plan", "plan.json", "--quiet",
               "--robot", f"{sys.executable} alone.py"]
    planner = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    for _ in range(600):
        if (folder / "moving").exists():
            break
        time.sleep(0.1)
    planner.kill()
    planner.wait()
    time.sleep(1)
    if not (folder / "stopped").exists():
        fail("a driver whose planner was killed has no time to stop")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        environment = dict(os.environ, KABOUM_BIN=str(TOOLS), KABOUM_CACHE=str(folder / "cache"))
        scenario = folder / "fs"
        made = subprocess.run([ROOT / "examples/scenarios/force-sensing/run", "2", "--out", scenario], env=environment, capture_output=True, text=True)
        if made.returncode != 0:
            fail(f"no plan: {made.stderr[-500:]}")
        (scenario / "domain.kpl").write_text((ROOT / "examples/scenarios/force-sensing/domain.kpl").read_text())

        # Every outcome of sensing, with a driver that behaves.
        for seed in range(1, 5):
            done, report = run(scenario, f"{DRIVER} --seed {seed}")
            if done.returncode != 0 or report["driver"]["end"] != "goal" or report["verdict"] != "good":
                fail(f"seed {seed}: exit code {done.returncode}: {done.stderr}")
            if report["collisions"] + report["limit_violations"] + report["jumps"] or report["samples"] < 1000:
                fail(f"seed {seed}: {report}")
            judge(scenario, True)
        stops_without_its_planner(scenario)
        keeps_schema(scenario)
        sensed = {json.loads(e["told"])["fact"] for e in journal(scenario) if "told" in e and json.loads(e["told"])["do"] == "sense"}
        if len(sensed) != 2:
            fail(f"sensed: {sensed}")

        # How joints moved is judged: as told; a little beside it; far beside it, into something; and nonsense.
        for stray, code in (("0", 0), ("0.001", 0), ("0.9", 1)):
            done, report = run(scenario, f"{DRIVER} --stray {stray}")
            executed = report["driver"]["executed"]
            if done.returncode != code or (executed["collisions"] > 0) != (code == 1) or executed["motions"] != report["motions"]:
                fail(f"executed {stray} beside: exit code {done.returncode}: {executed}, {done.stderr}")
            if abs(executed["most_strayed"] - float(stray)) > 1e-6 + 1e-3 * float(stray):
                fail(f"executed {stray} beside: {executed}")
            # An arm of six joints that is about one metre long.
            if not float(stray) <= executed["margin"] + 1e-9 <= 12 * float(stray) + 1e-6:
                fail(f"executed {stray} beside: {executed}")
        # Where it ends elsewhere, or fails, is looked at, too.
        for what, end in (('reply["q"] = [x + 0.5 for x in reply["q"]]', "elsewhere"), ('del reply["done"]; reply["failed"] = "pushed"', "failed")):
            liar = lie(folder, what)
            done, report = run(scenario, f"{liar} --stray 0.9", "--robot-retries", "0")
            executed = report["driver"]["executed"]
            if done.returncode != 1 or report["driver"]["end"] != end or executed["motions"] != 1 or executed["most_strayed"] < 0.89:
                fail(f"{end}: exit code {done.returncode}: {report['driver']}")
        for rows in ("[[0, 1]]", "7", "[[1] + 6 * [0], 7 * [0]]", "[6 * [0] + ['x']]"):
            done, report = run(scenario, lie(folder, f'reply["executed"] = {rows}'))
            if done.returncode != 1 or report["driver"]["end"] != "nonsense":
                fail(f"executed is {rows}: exit code {done.returncode}: {done.stderr}")
        done, report = run(scenario, DRIVER)
        (end,) = [json.loads(e["told"]) for e in journal(scenario) if "told" in e and json.loads(e["told"])["do"] == "finish"]
        if set(end["objects"]) != {o["name"] for o in json.loads((scenario / "cell.json").read_text())["objects"]} or "pose" not in end["objects"]["o1"]:
            fail(f"where things are at the end: {end}")

        # Through corners: faster, within all limits, judged as ever, and repeated byte for byte.
        rests = sum(points[-1]["time_from_start"] for points in told_motions(scenario))
        for more, jerk in (((), 100), (("--max-jerk", "40"), 40)):
            done, report = run(scenario, f"{DRIVER} --stray 0", "--blend", "0.5", *more)
            if done.returncode != 0 or report["blends"] < 5 or report["limit_violations"] + report["collisions"] + report["driver"]["executed"]["collisions"]:
                fail(f"through corners: exit code {done.returncode}: {report}: {done.stderr}")
            if not 0.9 < report["most_jerk"] <= 1.001 or report["driver"]["executed"]["most_strayed"] > 1e-9:
                fail(f"through corners: {report}")
            judge(scenario, True)
            keeps_schema(scenario)
            for points in told_motions(scenario):
                within_limits(points, 2, 5, jerk)
        if not sum(points[-1]["time_from_start"] for points in told_motions(scenario)) < 0.9 * rests:
            fail("through corners it is not faster")
        (scenario / "blended.jsonl").write_text((scenario / "journal.jsonl").read_text())
        done, again = run(scenario, None, "--replay-journal", "blended.jsonl", "--blend", "0.5", "--max-jerk", "40")
        if done.returncode != 0 or again["blends"] != report["blends"]:
            fail(f"through corners, repeated: exit code {done.returncode}: {done.stderr}")
        done, _ = run(scenario, None, "--replay-journal", "blended.jsonl")
        if done.returncode != 3 or "something else" not in done.stderr:
            fail(f"repeated from rest to rest: exit code {done.returncode}: {done.stderr}")
        for wrong, word in ((("--blend", "0.96"), "blend"), (("--max-jerk", "5"), "max-jerk"), (("--blend", "0.5", "--time-optimal"), "time-optimal"),
                            (("--max-velocity", "j99=1"), "no robot of the scene has a joint")):
            done, _ = run(scenario, DRIVER, *wrong)
            if done.returncode != 2 or word not in done.stderr:
                fail(f"{wrong}: exit code {done.returncode}: {done.stderr}")
        done, report = run(scenario, DRIVER)

        # A plan's files say what the robot is told, in the same order; with what was sensed then.
        folder_of_files(scenario, "--blend", "0.5")
        done, report = run(scenario, DRIVER)

        # The example in C++ is told the same, and answers like the one in Python.
        compiled = TOOLS.parent / "examples/example-driver"
        if not compiled.exists():
            print("drive.py: skipped: the driver in C++, as the examples are not built", file=sys.stderr)
        else:
            done, report = run(scenario, str(compiled), "--blend", "0.5")
            executed = report["driver"]["executed"]
            # By its polynomials, which are within the room that is certified.
            if done.returncode != 0 or not 0 < executed["most_strayed"] < 3 * 5 / (16 * 100**2) or executed["motions"] != report["motions"]:
                fail(f"the driver in C++: exit code {done.returncode}, {executed}: {done.stderr}")
            judge(scenario, True)
            keeps_schema(scenario)
            sensed = {m["fact"]: m["values"][0] for m in (json.loads(e["told"]) for e in journal(scenario) if "told" in e) if m["do"] == "sense"}
            told = [[e["told"] for e in journal(scenario) if "told" in e]]
            done, report = run(scenario, f"{DRIVER} {' '.join(f'--sense {chr(39)}{f}={v}{chr(39)}' for f, v in sensed.items())}", "--blend", "0.5")
            if done.returncode != 0 or told[0] != [e["told"] for e in journal(scenario) if "told" in e]:
                fail(f"the drivers in C++ and Python are told different things: {done.stderr}")
            done, report = run(scenario, DRIVER)

        # What is handed over is taken before it is let go.
        handed = folder / "handed"
        made = subprocess.run([ROOT / "examples/scenarios/bimanual-assembly/run", "--hand-over", "--plan-only", "--out", handed], env=environment, capture_output=True,
                              text=True)
        if made.returncode != 0:
            fail(f"no plan that hands over: {made.stderr[-500:]}")
        (handed / "domain.kpl").write_text((ROOT / "examples/scenarios/bimanual-assembly/domain.kpl").read_text())
        done, _ = run(handed, DRIVER)
        if done.returncode != 0:
            fail(f"handing over: exit code {done.returncode}: {done.stderr}")
        judge(handed, True)
        holders, passed = {}, 0
        for message in (json.loads(e["told"]) for e in journal(handed) if "told" in e):
            by = holders.setdefault(message.get("object"), set())
            if message["do"] == "take":
                passed += bool(by)
                by.add(message["robot"])
            elif message["do"] == "release":
                by.remove(message["robot"])
        if passed < 1:
            fail("nothing is handed over from hand to hand")

        # A journal is repeated: the same messages; and not with another plan's rate, nor when it is damaged.
        (scenario / "kept.jsonl").write_text((scenario / "journal.jsonl").read_text())
        done, again = run(scenario, None, "--replay-journal", "kept.jsonl")
        if done.returncode != 0 or again["driver"]["messages"] != report["driver"]["messages"]:
            fail(f"repeated: exit code {done.returncode}: {done.stderr}")
        told = [[e["told"] for e in journal(scenario, n) if "told" in e] for n in ("kept.jsonl", "journal.jsonl")]
        if told[0] != told[1]:
            fail("a repeated run is told something else")
        done, _ = run(scenario, None, "--replay-journal", "kept.jsonl", "--robot-rate", "50")
        if done.returncode != 3 or "something else" not in done.stderr:
            fail(f"another rate: exit code {done.returncode}: {done.stderr}")
        lines = (scenario / "kept.jsonl").read_text().splitlines()
        for damaged, code in (("", 3), ("{", 3), ("\n".join(["{}", *lines[1:]]), 3), ("\n".join([*lines[:2], "[]", *lines[2:]]), 3),
                              ("\n".join(lines[:len(lines) // 2]) + "\n", 1)):
            (scenario / "damaged.jsonl").write_text(damaged)
            done, _ = run(scenario, None, "--replay-journal", "damaged.jsonl")
            if done.returncode != code or "damaged.jsonl" not in done.stderr and code == 3:
                fail(f"damaged journal: exit code {done.returncode}: {done.stderr}")

        journals_that_fail(scenario)
        stopped_before_it_is_judged(scenario)

        # Drivers that do not behave, one by one.
        ready = 'echo \'{"kaboum_driver": 1}\''
        for robot, end, word in (
                ("exit 3", "ended", "exit code 3"), ("sleep 100", "late", "no answer within"), ("echo hello; cat", "nonsense", "no JSON"),
                ("echo '{}'; cat", "nonsense", "first line"), (f"{ready}; cat", "nonsense", "one of"), (f"{ready}; read x; sleep 100", "late", "no answer"),
                (f"{ready}; echo '{{\"id\": 1, \"done\": true}}'; sleep 100", "nonsense", "nobody asked"),
                (f"{ready}; read x; echo '{{\"id\": 1, \"sensed\": \"a\"}}'; sleep 100", "nonsense", "'done' or 'failed'"),
                (f"{ready}; read x; echo '{{\"id\": 1, \"done\": true, \"q\": {{\"arm\": [9, 9, 9, 9, 9, 9]}}}}'; sleep 100", "elsewhere", "away"),
                (f"{ready}; read x; head -c 20000000 /dev/zero | tr '\\0' a; sleep 100", "nonsense", "16 MiB"),
                (f"{ready}; echo; exec sleep 100", "nonsense", "nobody asked"), ("printf '{\"kaboum_driver\": 1}\\n{\"id\"'; read x; sleep 100", "nonsense", "nobody asked"),
                (f"{ready}; cat /dev/zero", "nonsense", "it "), (f"{ready}; read x; printf '\\377\\n'; sleep 100", "nonsense", "no UTF-8"),
                (f"{ready}; read x; echo '{{\"id\": 1, \"done\": true, \"q\": {{\"amr\": [0]}}}}'; sleep 100", "nonsense", "'amr'"),
                (f"{DRIVER} --sense 'isSpillable(o1)=perhaps'", None, "one of")):
            done, report = run(scenario, robot, "--robot-timeout", "1.5" if end == "late" else "60")
            if done.returncode not in (1,) or (end and report["driver"]["end"] != end) or word not in done.stderr:
                fail(f"{robot}: exit code {done.returncode}, {report and report['driver']}: {done.stderr}")
            if report["verdict"] == "good":
                fail(f"{robot}: good")

        # The last answer twice at once.
        (scenario / "twice.py").write_text(TWICE)
        done, report = run(scenario, f"{sys.executable} twice.py {DRIVER}")
        if done.returncode != 1 or report["driver"]["end"] != "nonsense" or "at the end" not in done.stderr:
            fail(f"the last answer twice: exit code {done.returncode}: {done.stderr}")

        # What is read is not overwritten, by whatever name.
        for option, file in (("--journal", "plan.json"), ("--journal", "./domain.kpl"), ("--journal", "cell.json"), ("--report", "plan.json")):
            before = (scenario / file).read_bytes()
            done, _ = run(scenario, DRIVER, option, file)
            if done.returncode != 2 or "overwrite" not in done.stderr or (scenario / file).read_bytes() != before:
                fail(f"{option} {file}: exit code {done.returncode}: {done.stderr}")
        done, _ = run(scenario, None, "--replay-journal", "kept.jsonl", "--journal", "./kept.jsonl")
        if done.returncode != 2 or not (scenario / "kept.jsonl").read_bytes():
            fail(f"a journal over itself: exit code {done.returncode}: {done.stderr}")

        # Faults at random: each run ends stopped or at the goal.
        ends = {}
        for seed in range(1, RUNS + 1):
            done, report = run(scenario, f"{DRIVER} --seed {seed} --faults 0.03 --late 30", "--robot-timeout", "1", *(["--blend", "0.5"] if seed % 2 else []))
            if done.returncode not in (0, 1) or report is None:
                fail(f"faults, seed {seed}: exit code {done.returncode}: {done.stderr}")
            end = report["driver"]["end"]
            if (done.returncode == 0) != (end == "goal") or (report["verdict"] == "good") != (end == "goal"):
                fail(f"faults, seed {seed}: {end}, exit code {done.returncode}")
            if report["collisions"] + report["limit_violations"] + report["jumps"]:
                fail(f"faults, seed {seed}: {report['problems']}")
            judge(scenario, end == "goal")
            ends[end] = ends.get(end, 0) + 1
        if len(ends) < 3:
            fail(f"ends: {ends}")

        # A plan without one of its branches: it is planned again from what is known then, and not with --replan 0.
        plan = json.loads((scenario / "plan.json").read_text())
        whole = json.dumps(plan)
        branch = next(n["branch"] for n in plan["nodes"] if n.get("branch", {}).get("arguments") == ["o1"])
        branch["cases"] = [c for c in branch["cases"] if c["value"] is False]
        (scenario / "plan.json").write_text(json.dumps(plan))
        spillable = f"{DRIVER} --sense 'isSpillable(o1)=true' --sense 'isSpillable(o2)=false'"
        done, report = run(scenario, spillable)
        if done.returncode != 0 or [r["outcome"] for r in report["replans"]] != ["isSpillable(o1)"] or report["driver"]["end"] != "goal":
            fail(f"planned again: exit code {done.returncode}: {report and report['replans']}: {done.stderr}")
        judge(scenario, True)
        done, files, again, missing = planned_again_in_files(scenario)
        if done.returncode != 0 or {i["fact"] for i, _ in missing} != {"isSpillable(o1)"} or {i["value"] for i, _ in missing} != {"true"}:
            fail(f"files of plans made again: exit code {done.returncode}: {missing}: {done.stderr}")
        if sorted({p for _, p in missing}) != list(range(1, len(files["plans"]))) or len(files["plans"]) < 2 or len(files["plans"]) != 1 + sum(
                not r["known_before"] for r in again["replans"]):
            fail(f"plans that go on: {missing}, of {len(files['plans'])}")
        for _, number in missing:
            first = files["steps"][files["plans"][number]["first"]]
            if first["plan"] != number:
                fail(f"plan {number} begins with {first}")
        done, report = run(scenario, spillable, "--replan", "0")
        if done.returncode != 1 or report["driver"]["end"] != "uncertified" or report["driver"]["messages"] or "no case" not in done.stderr:
            fail(f"a plan with gaps and nobody to plan again: exit code {done.returncode}: {report and report['driver']}: {done.stderr}")

        # Motions that take too many points: nothing is told.
        (scenario / "plan.json").write_text(whole)
        done, report = run(scenario, DRIVER, "--max-velocity", "1e-7")
        if done.returncode in (0, 1) or "more than 100000000 samples" not in done.stderr or any("told" in e for e in journal(scenario)):
            fail(f"too many points: exit code {done.returncode}: {done.stderr}")

        # A path without points is reported, with files as well.
        damaged = json.loads(whole)
        call = next(c for n in damaged["nodes"] for c in n.get("calls", []) if c.get("payload", "").startswith('[{'))
        motions = json.loads(call["payload"])
        call["payload"] = json.dumps([{**motions[0], "path": []}, *motions])
        (scenario / "plan.json").write_text(json.dumps(damaged))
        done, files, report, _ = planned_again_in_files(scenario)
        if done.returncode != 1 or report["jumps"] < 1 or not any("does not begin where it is" in p for p in report["problems"]):
            fail(f"a path without points: exit code {done.returncode}: {done.stderr}")

        # A plan with a motion that nobody certified is not told.
        damaged = json.loads(whole)
        call = next(c for n in damaged["nodes"] for c in n.get("calls", []) if c.get("payload", "").startswith('[{'))
        motions = json.loads(call["payload"])
        motions[0]["path"][1][0] += 0.2
        call["payload"] = json.dumps(motions)
        (scenario / "plan.json").write_text(json.dumps(damaged))
        done, report = run(scenario, DRIVER)
        if done.returncode != 1 or report["driver"]["end"] != "uncertified" or report["driver"]["messages"]:
            fail(f"an uncertified motion: exit code {done.returncode}: {report and report['driver']}: {done.stderr}")
        print(f"ends with faults at random: {dict(sorted(ends.items()))}")


if __name__ == "__main__":
    main()
