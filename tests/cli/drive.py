#!/usr/bin/env python3
"""kaboum-plan run --robot: a driver that behaves, ones that do not, journals repeated, plans made again.

usage: drive.py BIN
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

TOOLS = pathlib.Path(sys.argv[1]).absolute()
ROOT = pathlib.Path(__file__).resolve().parents[2]
DRIVER = f"{sys.executable} {ROOT / 'examples/drivers/driver.py'}"
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


def fail(what):
    raise SystemExit(f"drive.py: {what}")


def run(folder, robot, *more):
    files = [x for option, file in (("--report", "report.json"), ("--journal", "journal.jsonl")) if option not in more for x in (option, file)]
    command = [TOOLS / "kaboum-plan", "run", "domain.kpl", "problem.kpl", "--scene", "cell.json", "--plan", "plan.json", "--quiet",
               *files, *(["--robot", robot] if robot else []), *more]
    (folder / "report.json").unlink(missing_ok=True)
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)
    if done.returncode < 0:
        fail(f"{robot}: signal {-done.returncode}")
    report = folder / "report.json"
    return done, json.loads(report.read_text()) if report.exists() else None


def journal(folder, name="journal.jsonl"):
    return [json.loads(line) for line in (folder / name).read_text().splitlines()]


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
        for what, end in (('"q": [x + 0.5 for x in self.q[message["robot"]]]', "elsewhere"), ('"failed": "pushed"', "failed")):
            liar = folder / "liar.py"
            liar.write_text((ROOT / "examples/drivers/driver.py").read_text().replace(
                "        return reply\n\n    def take", "        del reply['done']\n        return {" + ("'done': True, " if end == "elsewhere" else "") +
                "**reply, " + what + "}\n\n    def take"))
            done, report = run(scenario, f"{sys.executable} {liar} --stray 0.9", "--robot-retries", "0")
            executed = report["driver"]["executed"]
            if done.returncode != 1 or report["driver"]["end"] != end or executed["motions"] != 1 or executed["most_strayed"] < 0.89:
                fail(f"{end}: exit code {done.returncode}: {report['driver']}")
        for rows in ("[[0, 1]]", "7", "[[1] + 6 * [0], 7 * [0]]", "[6 * [0] + ['x']]"):
            liar = folder / "liar.py"
            liar.write_text((ROOT / "examples/drivers/driver.py").read_text().replace(
                "        return reply\n\n    def take", f'        return {{**reply, "executed": {rows}}}\n\n    def take'))
            done, report = run(scenario, f"{sys.executable} {liar}")
            if done.returncode != 1 or report["driver"]["end"] != "nonsense":
                fail(f"executed is {rows}: exit code {done.returncode}: {done.stderr}")
        done, report = run(scenario, DRIVER)
        (end,) = [json.loads(e["told"]) for e in journal(scenario) if "told" in e and json.loads(e["told"])["do"] == "finish"]
        if set(end["objects"]) != {o["name"] for o in json.loads((scenario / "cell.json").read_text())["objects"]} or "pose" not in end["objects"]["o1"]:
            fail(f"where things are at the end: {end}")

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
            done, report = run(scenario, f"{DRIVER} --seed {seed} --faults 0.03 --late 30", "--robot-timeout", "1")
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
        done, report = run(scenario, spillable, "--replan", "0")
        if done.returncode != 1 or report["driver"]["end"] != "uncertified" or report["driver"]["messages"] or "no case" not in done.stderr:
            fail(f"a plan with gaps and nobody to plan again: exit code {done.returncode}: {report and report['driver']}: {done.stderr}")

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
