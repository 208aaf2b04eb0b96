#!/usr/bin/env python3
"""Plans carried out by robots that MuJoCo simulates (examples/drivers/physics.py): things end where the plans have them, weighing decides
the branch, and what goes wrong is seen: a cup that does not reach, things that stand elsewhere, a robot that is pushed aside.

usage: physics.py ROBOT_POSES BIN
Run by the Python of `scripts/setup --engines`; exit code 77 where there is no MuJoCo.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

try:
    import mujoco  # noqa: F401
    import numpy  # noqa: F401
except ImportError:
    print("physics.py: skipped: no MuJoCo here; scripts/setup --engines", file=sys.stderr)
    sys.exit(77)

from checks import check, exit_code  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(sys.argv[2]).resolve()


def scenario(folder, name, *more, out=None):
    environment = dict(os.environ, KABOUM_BIN=str(BIN), KABOUM_CACHE=str(folder / "cache"), KABOUM_ENGINES=sys.prefix)
    done = subprocess.run([ROOT / f"examples/scenarios/{name}/run", *more, "--plan-only", "--out", folder / (out or name)], env=environment, capture_output=True,
                          text=True, check=False)
    return done, json.loads(done.stdout.splitlines()[-1]) if done.stdout else {}


def carry_out(folder, name, *driver, out=None):
    """The plan of a scenario that was made, by a driver with other options."""
    at = folder / (out or name)
    robots = [x for xml in (at / "physics").glob("*/*.xml") for x in ("--robot", f"{xml.parent.name}={xml}")]
    command = " ".join([sys.executable, str(ROOT / "examples/drivers/physics.py"), "--scene", str(at / "cell.json"), *robots, "--report", str(at / "said.json"),
                        *driver])
    done = subprocess.run([BIN / "kaboum-plan", "run", ROOT / f"examples/scenarios/{name}/domain.kpl", at / "problem.kpl", "--scene", at / "cell.json",
                           "--plan", at / "plan.json", "--robot", command, "--robot-timeout", "60", "--report", at / "done.json", "--quiet"],
                          capture_output=True, text=True, check=False)
    return done, json.loads((at / "said.json").read_text()), json.loads((at / "done.json").read_text())


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for what, n, runs, blend in (("force-sensing", 2, 2, "0.5"), ("stacked", 3, 1, "0"), ("bimanual-assembly", 4, 1, "0.5")):
            done, said = scenario(folder, what, str(n), "--physics", str(runs), "--blend", blend)
            physics = said.get("physics", {})
            check(done.returncode == 0 and physics.get("good") == runs, f"{what}: {physics}, {done.stderr[-500:]}")
            check(0 < physics.get("most_below", 0) < 0.03, f"{what}: nothing has settled: {physics}")
            for file in sorted((folder / what / "physics").glob("run-*.json")):
                report = json.loads(file.read_text())
                executed = report["driver"]["executed"]
                check((report["blends"] > 3) == (blend != "0"), f"{what}: {report['blends']} blends")
                check(executed["samples"] > 500 and executed["collisions"] == 0, f"{what}: {executed}")
                check(0 < executed["margin"] < 0.003, f"{what}: margin {executed['margin']}")

        # What things weigh decides.
        for mass, branch in (("0.6", "transferUpright"), ("0.1", "transferFast")):
            done, said, report = carry_out(folder, "force-sensing", *(f"--mass o{i}={mass}" for i in (1, 2)), "--measure 'isSpillable=weight>0.3'")
            check(done.returncode == 0 and report["driver"]["end"] == "goal", f"{mass} kg: {done.stderr[-300:]}")
            for i in (1, 2):
                told = [w for w in done.stderr.split("\n") if w.startswith(f"physics.py: o{i} weighs")]
                check(len(told) == 1 and abs(float(told[0].split()[3]) - float(mass)) < 0.01, f"{mass} kg: {told}")

        # Fingers close and hold by friction; with too little force they lose what they hold, and the run ends there.
        for what in ("force-sensing", "bartender"):
            done, said = scenario(folder, what, "2", "--fingers", "--physics", "1", "--blend", "0.5", out="fingers")
            physics = said.get("physics", {})
            check(done.returncode == 0 and physics.get("good") == 1 and physics["unplanned_contacts"] == 0, f"{what}, fingers: {physics}, {done.stderr[-500:]}")
            executed = json.loads((folder / "fingers/physics/run-1.json").read_text())["driver"]["executed"]
            check(executed["samples"] > 500 and executed["collisions"] == 0 and executed["margin"] < 0.003, f"{what}, fingers: {executed}")
            if what != "force-sensing":
                continue
            cell = json.loads((folder / "fingers/cell.json").read_text())
            cell["robots"][0]["grippers"][0]["force"] = 2
            (folder / "fingers/cell.json").write_text(json.dumps(cell))
            done, _, report = carry_out(folder, what, "--mass o1=0.6", "--mass o2=0.6", out="fingers")
            check(done.returncode == 1 and "joint 'finger'" in report["driver"]["reason"], f"loose fingers: {report['driver']}")

        # What goes wrong is not called good.
        done, _, report = carry_out(folder, "force-sensing", "--reach 0.0001")
        check(done.returncode == 1 and report["driver"]["end"] == "failed" and "nothing is held" in report["driver"]["reason"], f"reach: {report['driver']}")
        done, said, _ = carry_out(folder, "stacked", "--disturb 0.06 --seed 2")
        check(done.returncode == 1 or said["most"]["beside"] > 0.005, f"elsewhere: {said['most']}")
        done, _, report = carry_out(folder, "stacked", "--push 400")
        check(done.returncode == 1 and report["driver"]["end"] == "elsewhere" or report["driver"]["executed"]["most_strayed"] > 0.003,
              f"pushed: {report['driver']}")
    return exit_code()


sys.exit(main())
