#!/usr/bin/env python3
"""Makes bounding meshes and convex sets of a whole collection of meshes and has bound-verify judge each of them.

Every mesh file below KABOUM_MESHES (or --meshes DIR) goes through the cases

  outer, inner       bmesh-decimate --ratio 0.1
  cover, cover-fast  bcd-decompose --epsilon 2% --effort normal, fast
  inside             bcd-decompose --epsilon 2% --direction inner

and each result through bound-verify --prepare with the epsilon that was recorded, or asked for. Each process gets --seconds
of CPU at most, one at a time. Prints one line a case: exit codes (-9, -24: out of time) and user CPU seconds of producer and
verifier, then what bound-verify did not verify; at the end a summary: undecided, refuted, over 60 s, verifier over
ten times the producer (where it takes over a second). Exits with 1 if any of these is not empty.

With --record FILE.jsonl cases are kept there and not run again, so that a collection can be gone through in pieces; --summary
only prints what is there.
"""
import argparse
import json
import math
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

FORMATS = {".off", ".obj", ".ply", ".stl", ".wrl", ".dae", ".glb", ".3mf"}
CASES = {
    "outer": ("bmesh-decimate", ["--ratio", "0.1"], ["mesh", "--outer"]),
    "inner": ("bmesh-decimate", ["--ratio", "0.1", "--direction", "inner"], ["mesh", "--inner"]),
    "cover": ("bcd-decompose", ["--no-cache", "--epsilon", "2%"], ["cover"]),
    "cover-fast": ("bcd-decompose", ["--no-cache", "--epsilon", "2%", "--effort", "fast"], ["cover"]),
    "inside": ("bcd-decompose", ["--no-cache", "--epsilon", "2%", "--direction", "inner"], ["mesh", "--inner"]),
}
SLOW = 60  # seconds of CPU
FACTOR = 10


def run(command, seconds):
    """Exit code, user CPU seconds, standard output and error."""
    def limit():
        os.nice(10)
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))

    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, errors="replace",
                          preexec_fn=limit, check=False)
    used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    return done.returncode, used, done.stdout, done.stderr


def rounded_up(x):
    """Four digits, at least x."""
    if not x > 0:
        return x
    step = 10.0 ** (math.floor(math.log10(x)) - 3)
    y = math.ceil(x / step) * step
    return y if y >= x else (math.ceil(x / step) + 1) * step


def recorded_epsilon(report):
    """What bound-verify --epsilon is given for a result of bmesh-decimate; None without a claim."""
    distance = report.get("distance", {}).get("hausdorff_upper")
    if distance is None:
        return None
    return repr(rounded_up(max(distance, 1e-9 * report["distance"]["bbox_diagonal"])))


def last_line(text):
    lines = text.strip().splitlines()
    return lines[-1] if lines else ""


def judge(tools, mesh, case, work, seconds):
    tool, options, relation = CASES[case]
    result = work / ("result.ply" if tool == "bmesh-decimate" else "result.glb")
    report = work / "report.json"
    code, used, _, err = run([tools / tool, mesh, "-o", result, *options, "--report", report], seconds)
    row = {"case": case, "producer": code, "producer_seconds": round(used, 2)}
    if code == 3 and "--drop-sheets" in err:
        options = [*options, "--drop-sheets"]
        code, used, _, err = run([tools / tool, mesh, "-o", result, *options, "--report", report], seconds)
        row.update(producer=code, producer_seconds=round(used, 2))
    if code not in (0, 1) or not result.exists():
        row["said"] = last_line(err)
        return row
    facts = json.loads(report.read_text())
    row["triangles"] = facts["input"].get("triangles", 0)
    epsilon = "2%" if tool == "bcd-decompose" else recorded_epsilon(facts)
    if facts.get("preparation", {}).get("wrap"):  # whatever the file's solid: each of its triangles is inside
        command = [tools / "bound-verify", *relation, mesh, result, "--raw"]
    else:
        command = [tools / "bound-verify", *relation, mesh, result, "--prepare"]
        command += ["--drop-sheets"] if "--drop-sheets" in options else []
        command += ["--epsilon", epsilon] if epsilon else []
    code, used, out, err = run(command, seconds)
    row.update(verifier=code, verifier_seconds=round(used, 2), epsilon=epsilon)
    lines = out.strip().splitlines()
    row["said"] = "; ".join(l for l in lines if ": verified" not in l and l != "verified") or ""
    if code not in (0, 1):
        row["said"] = "; ".join(x for x in [row["said"], last_line(err)] if x)
    return row


def triangles_of(tools, mesh):
    """Of the file as it is read; None when it cannot be read."""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        run([tools / "bound-verify", "mesh", "--outer", mesh, mesh, "--claims", "surface", "--max-contacts", "1",
             "--report", report, "--quiet"], 60)
        return json.loads(report.read_text())["original"]["triangles"] if report.exists() else None


def line_of(row):
    verifier = f"{row['verifier']:>4}{row['verifier_seconds']:9.2f}" if "verifier" in row else f"{'-':>4}{'-':>9}"
    return (f"{row['mesh'][-44:]:44} {row['case']:10} {row['producer']:>4}{row['producer_seconds']:9.2f} {verifier}"
            f"  {row.get('said', '')[:200]}")


def summary(rows):
    """Lines, and whether there is nothing to complain of."""
    verified = [r for r in rows if "verifier" in r]
    classes = {
        "producer failed": [r for r in rows if "verifier" not in r],
        "undecided or out of time": [r for r in verified if r["verifier"] not in (0, 1, 3)],
        "refuted": [r for r in verified if r["verifier"] == 1],
        "nothing claimed of this file (exit code 3)": [r for r in verified if r["verifier"] == 3],
        f"over {SLOW} s of CPU": [r for r in rows if max(r["producer_seconds"], r.get("verifier_seconds", 0)) > SLOW],
        f"verifier over {FACTOR} times the producer": [
            r for r in verified if r["verifier_seconds"] > max(1, FACTOR * r["producer_seconds"])],
    }
    lines = [f"{len(rows)} cases, {sum(r['verifier'] == 0 for r in verified)} verified; CPU of producers "
             f"{sum(r['producer_seconds'] for r in rows):.0f} s, of bound-verify "
             f"{sum(r['verifier_seconds'] for r in verified):.0f} s"]
    for name, found in classes.items():
        lines.append(f"{name}: {len(found)}")
        lines += [f"    {line_of(r)}" for r in found]
    bad = [name for name, found in classes.items() if found and not name.startswith(("producer", "nothing"))]
    return lines, not bad


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tools", nargs="?", default="build/release/bin", help="folder of the programs [%(default)s]")
    parser.add_argument("--meshes", default=os.environ.get("KABOUM_MESHES"), help="folder [$KABOUM_MESHES]")
    parser.add_argument("--max-triangles", type=int, default=20000, help="leave larger meshes out [%(default)s]")
    parser.add_argument("--min-triangles", type=int, default=0, help="leave smaller meshes out [%(default)s]")
    parser.add_argument("--match", default="", help="only files whose path holds this regular expression")
    parser.add_argument("--cases", default=",".join(CASES), help="[%(default)s]")
    parser.add_argument("--seconds", type=int, default=120, help="CPU limit of each process [%(default)s]")
    parser.add_argument("--record", type=pathlib.Path, help="file of what has been run, one JSON object a line")
    parser.add_argument("--summary", action="store_true", help="run nothing")
    o = parser.parse_args()
    wanted = o.cases.split(",")
    if set(wanted) - set(CASES):
        parser.error(f"--cases: one or more of {', '.join(CASES)}")
    rows = []
    if o.record and o.record.exists():
        rows = [json.loads(l) for l in o.record.read_text().splitlines()]
    if not o.summary:
        if not o.meshes:
            parser.error("set KABOUM_MESHES or give --meshes DIR")
        tools, root = pathlib.Path(o.tools), pathlib.Path(o.meshes)
        done = {(r["mesh"], r["case"]) for r in rows}
        for mesh in sorted((p for p in root.rglob("*") if p.suffix.lower() in FORMATS), key=lambda p: p.stat().st_size):
            name = str(mesh.relative_to(root))
            if not re.search(o.match, name) or all((name, c) in done for c in wanted):
                continue
            count = triangles_of(tools, mesh)
            if count is not None and not o.min_triangles <= count <= o.max_triangles:
                continue
            for case in wanted:
                if (name, case) in done:
                    continue
                with tempfile.TemporaryDirectory() as folder:
                    row = {"mesh": name, **judge(tools, mesh, case, pathlib.Path(folder), o.seconds)}
                print(line_of(row), flush=True)
                rows.append(row)
                if o.record:
                    with o.record.open("a") as f:
                        f.write(json.dumps(row) + "\n")
    lines, good = summary(rows)
    print("\n".join(lines))
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
