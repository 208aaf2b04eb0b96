#!/usr/bin/env python3
"""bcd-decompose beside CoACD's results: bodies at its distance, and distance at its bodies.

compare.py BIN WORK MESH... [--efforts normal,fast]

NAME.coacd-0.05.obj is beside NAME.obj: CoACD's bodies, one object each (decompose.py makes such files). A mesh that is open is
closed first, as bcd-decompose would (mesh-prepare). Distances are solid to solid, certified and by hausdorff-eval for both: how
far the farthest point of the union is from the mesh's solid, in the mesh's unit. Ours is asked for --epsilon of theirs (the
lower end of its interval), and for --max-bodies of theirs. CPU seconds are of one thread, nothing cached. Those with most bodies
beside CoACD's come first; the last line has geometric means. Writes WORK/coacd.json as well.
"""
import argparse
import json
import math
import pathlib
import resource
import subprocess
import sys


def run(*command):
    """Exit code and user CPU seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(list(map(str, command)), check=False, capture_output=True, text=True)
    return done.returncode, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def farthest(programs, bodies, mesh, report):
    """Interval of the farthest distance of the union from the solid, as a length."""
    report.unlink(missing_ok=True)
    run(programs / "hausdorff-eval", bodies, mesh, "--a-as", "mesh", "--b-as", "mesh", "--solid", "--gap", "0.02", "--threads", "1", "--report", report)
    measured = json.loads(report.read_text(encoding="utf-8"))
    return measured["a_to_b"]["max_lower"], measured["a_to_b"]["max_upper"]


def decomposed(options, mesh, effort, name, *wish):
    """Bodies, certified reach as a length, CPU seconds."""
    report = options.work / f"{name}.json"
    report.unlink(missing_ok=True)
    code, seconds = run(options.programs / "bcd-decompose", mesh, "-o", options.work / f"{name}.glb", "--effort", effort, "--threads", "1", "--no-cache", "--quiet",
                        "--report", report, *wish)
    if code not in (0, 1):
        raise SystemExit(f"compare.py: {mesh}: bcd-decompose {' '.join(map(str, wish))} ended with exit code {code}")
    made = json.loads(report.read_text(encoding="utf-8"))
    return made["bodies"], made["reach"]["upper"], seconds


def row(options, source, effort):
    name, theirs = source.stem, source.with_name(f"{source.stem}.coacd-0.05.obj")
    mesh = options.work / f"{name}.ply"
    code, _ = run(options.programs / "mesh-prepare", source, "-o", mesh, "--quiet")
    if code != 0:
        raise SystemExit(f"compare.py: {source}: mesh-prepare ended with exit code {code}")
    count = sum(line.startswith(("o ", "g ")) for line in theirs.read_text(encoding="utf-8").splitlines())
    lower, upper = farthest(options.programs, theirs, mesh, options.work / f"{name}-theirs.json")
    bodies, reach, seconds = decomposed(options, mesh, effort, f"{name}-{effort}-at-distance", "--epsilon", lower)
    as_many, at_bodies, seconds_at_bodies = decomposed(options, mesh, effort, f"{name}-{effort}-at-bodies", "--max-bodies", count)
    return {"model": name, "effort": effort, "coacd": {"bodies": count, "farthest": [lower, upper]},
            "at_distance": {"bodies": bodies, "farthest": reach, "seconds": seconds, "ratio": bodies / count},
            "at_bodies": {"bodies": as_many, "farthest": at_bodies, "seconds": seconds_at_bodies, "ratio": at_bodies / lower}}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("meshes", type=pathlib.Path, nargs="+")
    parser.add_argument("--efforts", default="normal", help="of bcd-decompose [%(default)s]")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    rows = []
    for effort in options.efforts.split(","):
        for mesh in options.meshes:
            rows.append(row(options, mesh, effort))
            print(f"{mesh.stem}, {effort}", file=sys.stderr)
            (options.work / "coacd.json").write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
        print(f"\n| {effort} | CoACD: bodies, farthest | ours at its distance: bodies | ÷ theirs | CPU | ours at its bodies: farthest | ÷ theirs | CPU |\n"
              "|---|---:|---:|---:|---:|---:|---:|---:|")
        own = sorted((r for r in rows if r["effort"] == effort), key=lambda r: -r["at_distance"]["ratio"])
        for r in own:
            there, here = r["at_distance"], r["at_bodies"]
            print(f"| {r['model']} | {r['coacd']['bodies']}, {r['coacd']['farthest'][0]:.4g} | {there['bodies']} | {there['ratio']:.2f} | {there['seconds']:.1f} s | "
                  f"{here['bodies']}, {here['farthest']:.4g} | {here['ratio']:.2f} | {here['seconds']:.1f} s |")
        mean = [math.exp(sum(math.log(r[what]["ratio"]) for r in own) / len(own)) for what in ("at_distance", "at_bodies")]
        print(f"| geometric mean | | | {mean[0]:.2f} | | | {mean[1]:.2f} | |")


if __name__ == "__main__":
    main()
