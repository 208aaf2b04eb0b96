#!/usr/bin/env python3
"""Collision queries on sets of several settings: makes them with bcd-decompose, then runs set-collision-benchmark.

set_collision.py BUILD-FOLDER MESH... [--epsilons 2,1,0.5,0.3] [--vertices 32,64] [--effort fast] [--queries 5000]
[--out FOLDER]. Epsilons are percent of the diagonal. Sets that are in FOLDER (set-collision) already are not made
again. NAME.coacd-0.05.obj beside NAME.obj is compared with.
"""
import argparse
import pathlib
import subprocess
import sys


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("meshes", type=pathlib.Path, nargs="+")
    parser.add_argument("--epsilons", default="2,1,0.5,0.3")
    parser.add_argument("--vertices", default="32,64")
    parser.add_argument("--effort", default="fast")
    parser.add_argument("--queries", default="5000")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("set-collision"))
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    for mesh in options.meshes:
        for epsilon in options.epsilons.split(","):
            for vertices in options.vertices.split(","):
                result = options.out / f"{mesh.stem}.eps{epsilon}-v{vertices}-{options.effort}.glb"
                if result.exists():
                    continue
                code = subprocess.run(
                    [options.build / "bin/bcd-decompose", mesh, "-o", result, "--epsilon", f"{epsilon}%",
                     "--max-vertices-per-body", vertices, "--effort", options.effort, "--drop-sheets"],
                    check=False).returncode
                if code != 0:
                    result.unlink(missing_ok=True)
                    print(f"set_collision.py: {result} was not made, or not within epsilon", file=sys.stderr)
                    return 1
    return subprocess.run(
        [options.build / "benchmarks/set-collision-benchmark", "--queries", options.queries, "--sets", options.out,
         "--csv", options.out / "queries.csv", *options.meshes], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
