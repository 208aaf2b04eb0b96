#!/usr/bin/env python3
"""Measures the planner's goals: user CPU seconds of whole runs of kaboum-plan, best of three.

planning.py path/to/kaboum-plan [RUNS]. Every plan is checked by `kaboum-plan check`; a problem's
constants are permuted where the goal asks for it. Prints a Markdown table.
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


def main():
    tool = sys.argv[1]
    runs = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    rows = [
        ("stacked", "6", "bfs"), ("stacked", "7", "bfs"), ("stacked", "8", "bfs"), ("stacked", "7", "ids"),
        ("stacked", "8", "ids"), ("stacked", "20 1", "astar"), ("stacked", "50 1", "astar"),
        ("force-sensing", "10", "dfs"), ("force-sensing", "50", "dfs"), ("force-sensing", "10", "greedy"),
        ("force-sensing", "50", "greedy"), ("bartender", "6", "greedy"), ("bartender", "12", "greedy"),
        ("circular-rearrange", "3", "bfs"), ("circular-rearrange", "5", "astar"),
        ("bimanual-assembly", "1", "bfs"), ("remove", "20", "bfs"), ("remove", "100", "dfs"),
    ]
    print("| scenario | n [seed] | search | user s, best | worst | nodes | longest | leaves | states | bytes/state |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as directory:
        for domain, arguments, search in rows:
            results = [solve(tool, pathlib.Path(directory), domain, arguments, search) for _ in range(runs)]
            seconds = [s for s, _ in results]
            plan, stats = results[0][1]["plan"], results[0][1]["statistics"]
            print(f"| {domain} | {arguments} | {search} | {min(seconds):.3f} | {max(seconds):.3f} | {plan['nodes']} | "
                  f"{plan['longest_path']} | {plan['leaves']} | {stats['states_kept']} | {stats['bytes_per_state']:.0f} |",
                  flush=True)


main()
