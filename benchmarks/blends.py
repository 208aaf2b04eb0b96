#!/usr/bin/env python3
"""How long motions through corners take, divided by what they take from rest to rest.

usage: blends.py [--paths N] [MOVE-OPTION …]                     (programs on PATH)
       blends.py --plans DIRECTORY NAME …

Without --plans: paths of `kaboum-move` that have corners, between random configurations in two cells of
examples/geometry/make-cell; beside it what any motion between these takes at least, for the joint that has farthest to go. With it: plans of scenarios, from DIRECTORY/NAME/cell.json, problem.kpl and plan.json,
as `examples/scenarios/NAME/run --out DIRECTORY/NAME` leaves them; every branch.
"""
import argparse
import json
import math
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

EXAMPLES = pathlib.Path(__file__).resolve().parent.parent / "examples"
LIMITS = [2.9, 2.2, 2.7, 3.1, 2.3, 3.1]  # of the joints of make-cell's arm [rad]
ROWS = [("5 rad/s²", 2, 5, []), ("15 rad/s²", 2, 15, ["--max-acceleration", "15"]), ("5 rad/s², at most 1 rad/s", 1, 5, ["--max-velocity", "1"])]
BLENDS = ["--blend", "0.5"]


def motion(cell, ends, folder, options):
    """The report of a path; None where there is none."""
    report = folder / "report.json"
    command = ["kaboum-move", cell, "--from=" + ends[0], "--to=" + ends[1], "--max-work", "1", "-o", folder / "path.csv", "--trajectory",
               folder / "t.csv", "--report", report, "--quiet", *options]
    done = subprocess.run(command, capture_output=True, check=False)
    return json.loads(report.read_text()) if done.returncode == 0 else None


def seconds(*about):
    return motion(*about)["trajectory"]["seconds"]


def least(distance, velocity, acceleration, jerk):
    """The time that one joint takes at least, from rest to rest: a double-S."""
    speed = min(velocity, acceleration * (math.sqrt((acceleration / jerk) ** 2 + 4 * distance / acceleration) - acceleration / jerk) / 2)
    if speed < acceleration ** 2 / jerk:  # the full acceleration is not reached
        speed = min(velocity, (distance / 2) ** (2 / 3) * jerk ** (1 / 3))
        return distance / speed + 2 * math.sqrt(speed / jerk)
    return distance / speed + speed / acceleration + acceleration / jerk


def print_row(name, values):
    print(f"{name:40} worst {max(values):.3f}, median {statistics.median(values):.3f}, best {min(values):.3f}", flush=True)


def paths(count, options):
    for kind, number in (("stacked", "8"), ("remove", "16")):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            subprocess.run([sys.executable, EXAMPLES / "geometry/make-cell", kind, number, folder], check=True, capture_output=True)
            cell, chance, found = folder / "cell.json", random.Random(1), []
            while len(found) < count:
                ends = [",".join(f"{chance.uniform(-x, x):.6f}" for x in LIMITS) for _ in range(2)]
                report = motion(cell, ends, folder, [])
                if report and len((folder / "path.csv").read_text().splitlines()) > 3:
                    found.append(ends)
            for text, v, a, limits in ROWS:
                about = [(cell, ends, folder) for ends in found]
                reports = [motion(*a, [*limits, *BLENDS, *options]) for a in about]
                blended = [r["trajectory"]["seconds"] for r in reports]
                smaller = sum(x < 0.5 for r in reports for x in r["trajectory"]["blends"][1:-1])
                corners = sum(len(r["trajectory"]["blends"]) - 2 for r in reports)
                rests = [seconds(*a, limits) for a in about]
                trapezoids = [seconds(*a, [*limits, "--time-optimal"]) for a in about]
                print_row(f"{kind}, {text}, of quintics", [a / b for a, b in zip(blended, rests)])
                print_row(f"{kind}, {text}, of trapezoids", [a / b for a, b in zip(blended, trapezoids)])
                bounds = [max(least(abs(float(x) - float(y)), v, a, 20 * a) for x, y in zip(*(end.split(",") for end in ends))) for ends in found]
                print_row(f"{kind}, {text}, least of any motion", [a / b for a, b in zip(bounds, rests)])
                print(f"  {smaller} of {corners} corners have a smaller blend, or none")


def plans(folder, names, options):
    for name in names:
        files = pathlib.Path(folder) / name

        def run(*more):
            report = files / "motions.json"
            subprocess.run(["kaboum-plan", "run", EXAMPLES / "scenarios" / name / "domain.kpl", files / "problem.kpl", "--scene", files / "cell.json", "--plan",
                            files / "plan.json", "--report", report, "--quiet", *more], capture_output=True, check=True)
            return json.loads(report.read_text())["motion_s"]

        rests = run()
        kinds = [(BLENDS, "jerks of 20 times the acceleration"), ([*BLENDS, "--max-jerk", "500"], "of 100 times"), (["--time-optimal"], "trapezoids")]
        print(name + ": " + ", ".join(f"{text} {run(*more, *(options if '--blend' in more else [])) / rests:.3f}" for more, text in kinds), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--paths", type=int, default=25)
    parser.add_argument("--plans", metavar="DIRECTORY")
    o, rest = parser.parse_known_args()
    if o.plans:
        plans(o.plans, [x for x in rest if not x.startswith("-")], [])
    else:
        paths(o.paths, rest)


if __name__ == "__main__":
    main()
