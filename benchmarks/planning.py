#!/usr/bin/env python3
"""Measures the planner's goals: user CPU seconds of whole runs of kaboum-plan, best of three.

planning.py path/to/kaboum-plan [RUNS]. Every plan is checked by `kaboum-plan check`; a problem's
constants are permuted where the goal asks for it. Prints a Markdown table; exits with 1 if a bound, an aim,
or an expected plan is missed.
"""
import json
import pathlib
import resource
import subprocess
import sys
import tempfile

DOMAINS = pathlib.Path(__file__).resolve().parents[1] / "examples" / "domains"


def solve(tool, work, domain, arguments, search):
    problem = work / "problem.kpl"
    problem.write_text(subprocess.run([DOMAINS / domain / "make-problem", *arguments.split()],
                                      check=True, capture_output=True, text=True).stdout)
    files = [DOMAINS / domain / "domain.kpl", problem]
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run([tool, "solve", *files, "--search", search, "-o", work / "plan.json", "--report",
                    work / "report.json", "--quiet"], check=True)
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    subprocess.run([tool, "check", *files, "--plan", work / "plan.json", "--quiet"], check=True)
    return seconds, json.loads((work / "report.json").read_text())


# scenario, N [SEED], search, seconds at most, seconds aimed at, what the report must say
ROWS = [
    ("stacked", "6", "bfs", 0.05, 0.015, {"longest_path": 11}),
    ("stacked", "7", "bfs", None, None, {"longest_path": 13}),
    ("stacked", "8", "bfs", 4, 1.5, {"longest_path": 15, "bytes_per_state": 40}),
    ("stacked", "7", "ids", 5, 0.5, {"longest_path": 13}),
    ("stacked", "8", "ids", None, None, {"longest_path": 15}),
    ("stacked", "20", "astar", 10, None, {"longest_path": 39}),
    ("stacked", "20 1", "astar", 10, None, {"longest_path": 39}),
    ("stacked", "50", "astar", None, 1, {"longest_path": 99}),
    ("stacked", "50 1", "astar", None, 1, {"longest_path": 99}),
    ("stacked", "50 2", "astar", None, 1, {"longest_path": 99}),
    ("stacked", "20 1", "greedy", None, None, {}),
    ("force-sensing", "10", "dfs", 0.05, None, {"nodes": 50}),
    ("force-sensing", "10", "greedy", 0.05, None, {"nodes": 50}),
    ("force-sensing", "50", "dfs", None, 0.2, {"nodes": 250}),
    ("force-sensing", "50", "greedy", None, None, {"nodes": 250}),
    ("force-sensing", "8", "bfs", None, None, {"nodes": 40}),
    ("bartender", "6", "greedy", None, None, {"leaves": 64}),
    ("bartender", "12", "greedy", None, None, {"leaves": 4096}),
    ("circular-rearrange", "3", "bfs", None, None, {}),
    ("circular-rearrange", "5", "astar", None, None, {}),
    ("bimanual-assembly", "1", "bfs", None, None, {"longest_path": 6}),
    ("remove", "20", "bfs", None, None, {"longest_path": 20}),
    ("remove", "100", "dfs", None, None, {"longest_path": 100}),
]


def main():
    tool = sys.argv[1]
    runs = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    print("| scenario | n [seed] | search | user s, best | worst | at most | aim | nodes | longest | leaves | states "
          "| bytes/state |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    missed = []
    with tempfile.TemporaryDirectory() as directory:
        for domain, arguments, search, limit, aim, must in ROWS:
            results = [solve(tool, pathlib.Path(directory), domain, arguments, search) for _ in range(runs)]
            seconds = [s for s, _ in results]
            plan, stats = results[0][1]["plan"], results[0][1]["statistics"]
            name = f"{domain} {arguments} {search}"
            for what, value in must.items():
                if what == "bytes_per_state":
                    if stats[what] > value:
                        missed.append(f"{name}: {stats[what]:.0f} bytes per state, at most {value}")
                elif plan[what] != value:
                    missed.append(f"{name}: {what} is {plan[what]}, not {value}")
            for kind, bound in (("at most", limit), ("aim", aim)):
                if bound is not None and min(seconds) > bound:
                    missed.append(f"{name}: {min(seconds):.3f} s, {kind} {bound} s")
            print(f"| {domain} | {arguments} | {search} | {min(seconds):.3f} | {max(seconds):.3f} | {limit or ''} | "
                  f"{aim or ''} | {plan['nodes']} | {plan['longest_path']} | {plan['leaves']} | "
                  f"{stats['states_kept']} | {stats['bytes_per_state']:.0f} |", flush=True)
    for line in missed:
        print("missed:", line, file=sys.stderr)
    sys.exit(1 if missed else 0)


main()
