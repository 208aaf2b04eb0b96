#!/usr/bin/env python3
"""Covers by spheres, capsules, boxes and mixed bodies of many meshes: makes each, has it decided, and prints a table.

simple_covers.py BUILD-FOLDER MESH|FOLDER... [--epsilons 0.02,0.01] [--kinds spheres,capsules,boxes,mixed] [--effort fast]
                 [--seconds 600] [--closed] [--record FILE.jsonl] [--summary]

Of a folder all mesh files below it; with --closed those that MANIFEST.json (in KABOUM_MESHES) calls closed. Lengths are those of the
meshes. A line has the mesh, the kind, epsilon, the number of bodies, CPU seconds of making and of deciding, and the verdict of
bound-verify: that the bodies hold the mesh, and that none is farther than epsilon. What bounds no solid alone is wrapped: of it is
decided that the bodies hold it; epsilon is counted from the wrap, which is not in the files. Processes are run with nice 19. With --record
cases are kept there and not run again, so that a collection can be gone through in pieces. The last lines are counts. The exit code is
1 unless every set that was made is verified.
"""
import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

FORMATS = {".off", ".obj", ".ply", ".stl", ".wrl", ".dae", ".glb", ".3mf"}


def run(command, seconds):
    """Exit code (None: out of time), CPU seconds and the last line of the log."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    try:
        done = subprocess.run(["nice", "-n", "19", *map(str, command)], capture_output=True, text=True, errors="replace",
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5)), check=False)
        code = None if done.returncode in (-24, -9, 152, 137) else done.returncode
        said = (done.stderr.strip().splitlines() or [""])[-1]
    except OSError as error:
        code, said = None, str(error)
    return code, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, said


def closed_files():
    """Files of the collection that are closed, by its manifest."""
    root = os.environ.get("KABOUM_MESHES")
    if not root:
        sys.exit("--closed: set KABOUM_MESHES")
    entries = json.loads((pathlib.Path(root) / "MANIFEST.json").read_text())["entries"]
    return {(pathlib.Path(root) / e["file"]).resolve() for e in entries if e.get("closed")}


def meshes_of(options):
    known = closed_files() if options.closed else None
    for place in options.meshes:
        files = [place] if place.is_file() else sorted(p for p in place.rglob("*") if p.suffix.lower() in FORMATS)
        for file in files:
            if known is None or file.resolve() in known:
                yield file


def judge(options, mesh, kind, epsilon, folder):
    out, report = folder / "set.glb", folder / "report.json"
    row = {"mesh": str(mesh), "kind": kind, "epsilon": epsilon}
    tools = options.build / "bin"
    row["code"], row["making"], row["said"] = run(
        [tools / "bcd-decompose", mesh, "-o", out, "--bodies", kind, "--epsilon", epsilon, "--effort", options.effort,
         "--no-cache", "--report", report], options.seconds)
    if not out.exists():
        row["verdict"] = "out of time" if row["code"] is None else f"not made ({row['code']})"
        return row
    made = json.loads(report.read_text())
    row["bodies"] = made["bodies"]
    wrapped = made["wrap"] is not None
    claims = [] if wrapped else ["--prepare", "--epsilon", epsilon]
    code, row["deciding"], said = run([tools / "bound-verify", "cover", mesh, out, *claims], options.seconds)
    row["verdict"] = {0: "verified", 1: "refuted", 7: "undecided", None: "out of time"}.get(code, f"exit code {code}")
    if wrapped and code == 0:
        row["verdict"] = "holds all; epsilon is of the wrap"
    if code != 0:
        row["said"] = said
    return row


def line_of(row):
    bodies, deciding = row.get("bodies", "-"), f"{row['deciding']:8.1f}" if "deciding" in row else f"{'-':>8}"
    more = "" if row["verdict"].startswith(("verified", "holds all")) else "  " + row["said"][:160]
    return f"{row['mesh'][-44:]:44} {row['kind']:10} {row['epsilon']:>8} {bodies:>7} {row['making']:8.1f} {deciding}  {row['verdict']}{more}"


def summary(rows):
    """Counts for each kind and epsilon."""
    for kind, epsilon in sorted({(r["kind"], r["epsilon"]) for r in rows}):
        own = [r for r in rows if (r["kind"], r["epsilon"]) == (kind, epsilon)]
        counts = {}
        for row in own:
            counts[row["verdict"]] = counts.get(row["verdict"], 0) + 1
        decided = [r for r in own if "deciding" in r]
        yield (f"{kind} within {epsilon}: {len(own)} meshes, " + ", ".join(f"{n} {v}" for v, n in sorted(counts.items())) +
               f"; {sum(r.get('bodies', 0) for r in own)} bodies; CPU {sum(r['making'] for r in own):.0f} s, deciding "
               f"{sum(r['deciding'] for r in decided):.0f} s")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("meshes", type=pathlib.Path, nargs="*")
    parser.add_argument("--epsilons", default="0.02,0.01")
    parser.add_argument("--kinds", default="spheres,capsules,boxes,mixed")
    parser.add_argument("--effort", default="fast")
    parser.add_argument("--seconds", type=int, default=600, help="CPU limit of each process [%(default)s]")
    parser.add_argument("--closed", action="store_true")
    parser.add_argument("--record", type=pathlib.Path)
    parser.add_argument("--summary", action="store_true", help="run nothing")
    options = parser.parse_args()
    rows = []
    if options.record and options.record.exists():
        rows = [json.loads(line) for line in options.record.read_text().splitlines()]
    known = {(r["mesh"], r["kind"], r["epsilon"]) for r in rows}
    if not options.summary:
        print(f"{'mesh':44} {'kind':10} {'epsilon':>8} {'bodies':>7} {'making':>8} {'deciding':>8}  verdict", flush=True)
        for mesh in meshes_of(options):
            for epsilon in options.epsilons.split(","):
                for kind in options.kinds.split(","):
                    if (str(mesh), kind, epsilon) in known:
                        continue
                    with tempfile.TemporaryDirectory() as folder:
                        rows.append(judge(options, mesh, kind, epsilon, pathlib.Path(folder)))
                    print(line_of(rows[-1]), flush=True)
                    if options.record:
                        with options.record.open("a") as file:
                            file.write(json.dumps(rows[-1]) + "\n")
    for line in summary(rows):
        print(line)
    good = ("verified", "holds all", "not made")
    return 0 if all(r["verdict"].startswith(good) for r in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
