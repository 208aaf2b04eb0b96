#!/usr/bin/env python3
"""Counts the public PDDL tasks that kaboum-plan solves.

pddl.py KABOUM-PLAN BENCHMARKS [--seconds 30] [--memory 3G] [--tasks 8] [--only WORD...] [--search NAME] [--list] [--check]

BENCHMARKS is a copy of https://github.com/aibasel/downward-benchmarks: the tasks of the international planning competitions. Which of
its tasks are taken is a rule, so that nobody chooses:

- Folders whose names differ only in what follows the domain's name (-sat11-strips, -opt14-adl, ...) are one domain. Of these the
  folder for satisficing planners of the latest year is taken, else the one for optimal planners of the latest year, else the last of the
  others by name. Formulations of one domain (strips and adl, split and not) count as one.
- Of its n tasks, in the order of their names with numbers as numbers, at most --tasks are taken: numbers floor((i + 1/2) n / tasks).

A task counts as solved when a plan is written within so many seconds of user CPU time (--seconds) and --memory; with --check it has to be
valid by `kaboum-plan check` besides. Tasks whose language is refused count as not solved. Prints a Markdown table, a row for each domain;
exits with 1 if a plan is invalid.
"""
import argparse
import collections
import json
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

FOLDER = re.compile(r"(?P<domain>.+?)(?:-split)?(?:-(?P<track>sat|opt|agl|mco)?(?P<year>\d\d))?(?:-(?:strips|adl|fulladl|simpleadl))?$")
OTHER = re.compile(r"-(?:notankage|tankage|large|middle|small|simpleadl|fulladl)$")


def split(name):
    """Domain, and what the folder is ranked by among those of the domain."""
    found = FOLDER.fullmatch(name)
    track = {"sat": 3, "opt": 2}.get(found["track"], 1 if found["track"] else 0)
    return OTHER.sub("", found["domain"]), (track, int(found["year"] or 0), "split" not in name, name)


def natural(path):
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", path.name)]


def files(folder):
    """Pairs of a domain's file and a task's, in order."""
    own = folder / "domain.pddl"
    out = []
    for task in sorted(folder.glob("*.pddl"), key=natural):
        if "domain" in task.name:
            continue
        for domain in (own, folder / f"domain_{task.name}", folder / f"{task.stem}-domain.pddl", folder / f"domain-{task.name}",
                       folder / f"{task.name[:3]}-domain.pddl"):
            if domain.exists():
                out.append((domain, task))
                break
    return out


def choose(benchmarks, most):
    best = {}
    for folder in sorted(benchmarks.iterdir()):
        if not folder.is_dir() or folder.name.startswith(".") or "unofficial" in folder.name or not files(folder):
            continue
        domain, rank = split(folder.name)
        best[domain] = max(best.get(domain, (rank, folder)), (rank, folder))
    chosen = {}
    for domain, (_, folder) in sorted(best.items()):
        tasks = files(folder)
        count = min(most, len(tasks))
        chosen[domain] = [tasks[(2 * i + 1) * len(tasks) // (2 * count)] for i in range(count)]
    return chosen


def solve(options, domain, task, plan):
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (options.seconds, options.seconds + 2))
    plan.unlink(missing_ok=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    run = subprocess.run([options.tool, "solve", domain, task, "--search", options.search, "--max-memory", options.memory, "--quiet",
                          "-o", plan], preexec_fn=limit, capture_output=True, text=True)
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    if run.returncode == 0 and options.check:
        if subprocess.run([options.tool, "check", domain, task, "--plan", plan, "--quiet"], capture_output=True).returncode != 0:
            return "invalid", seconds
    return {0: "solved", 1: "unsolvable", 3: "refused", 7: "limit"}.get(run.returncode, "time"), seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tool")
    parser.add_argument("benchmarks", type=pathlib.Path)
    parser.add_argument("--seconds", type=int, default=30)
    parser.add_argument("--memory", default="3G")
    parser.add_argument("--tasks", type=int, default=8)
    parser.add_argument("--search", default="greedy")
    parser.add_argument("--only", nargs="*", default=[], help="domains whose names begin so")
    parser.add_argument("--list", action="store_true", help="print the tasks and stop")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--log", type=pathlib.Path, help="a line of JSON for each task")
    options = parser.parse_args()
    chosen = choose(options.benchmarks, options.tasks)
    if options.only:
        chosen = {d: t for d, t in chosen.items() if any(d.startswith(word) for word in options.only)}
    if options.list:
        for domain, tasks in chosen.items():
            for _, task in tasks:
                print(domain, task.relative_to(options.benchmarks))
        return 0
    print("| domain | tasks | solved | user s of these | else |\n|---|---|---|---|---|")
    total, tried, invalid = 0, 0, 0
    with tempfile.TemporaryDirectory() as work:
        for domain, tasks in chosen.items():
            said, spent = collections.Counter(), 0.0
            for domain_file, task in tasks:
                status, seconds = solve(options, domain_file, task, pathlib.Path(work) / "plan.json")
                said[status] += 1
                spent += seconds if status == "solved" else 0
                if options.log:
                    with options.log.open("a") as log:
                        log.write(json.dumps({"task": str(task.relative_to(options.benchmarks)), "status": status,
                                              "user_s": round(seconds, 2)}) + "\n")
            total, tried, invalid = total + said["solved"], tried + len(tasks), invalid + said["invalid"]
            rest = ", ".join(f"{status} {n}" for status, n in sorted(said.items()) if status != "solved")
            print(f"| {domain} | {len(tasks)} | {said['solved']} | {spent:.1f} | {rest} |", flush=True)
    print(f"| all {len(chosen)} | {tried} | {total} | | |")
    return 1 if invalid else 0


sys.exit(main())
