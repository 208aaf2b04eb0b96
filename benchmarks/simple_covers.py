#!/usr/bin/env python3
"""Covers by capsules, boxes and mixed bodies of many meshes: makes each, has it decided, and prints a table.

simple_covers.py BUILD-FOLDER MESH... [--epsilons 0.02,0.01] [--kinds capsules,boxes,mixed,polytopes] [--effort fast]
                 [--seconds 600]

Lengths are those of the meshes. A line has the mesh, the kind, epsilon, the number of bodies, CPU seconds of making and
of deciding, and the verdict of bound-verify. The exit code is 1 unless every set that was made is verified.
"""
import argparse
import json
import pathlib
import resource
import subprocess
import sys
import tempfile


def run(command, seconds):
    """Exit code (None: out of time) and CPU seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    try:
        code = subprocess.run(command, capture_output=True, timeout=seconds, check=False).returncode
    except subprocess.TimeoutExpired:
        code = None
    return code, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("meshes", type=pathlib.Path, nargs="+")
    parser.add_argument("--epsilons", default="0.02,0.01")
    parser.add_argument("--kinds", default="capsules,boxes,mixed,polytopes")
    parser.add_argument("--effort", default="fast")
    parser.add_argument("--seconds", type=float, default=600)
    options = parser.parse_args()
    wrong = 0
    print(f"{'mesh':30} {'kind':10} {'epsilon':>8} {'bodies':>7} {'making':>8} {'deciding':>8}  verdict")
    with tempfile.TemporaryDirectory() as folder:
        out, report = pathlib.Path(folder) / "set.glb", pathlib.Path(folder) / "report.json"
        for mesh in options.meshes:
            for epsilon in options.epsilons.split(","):
                for kind in options.kinds.split(","):
                    for file in (out, report):
                        file.unlink(missing_ok=True)
                    code, making = run([options.build / "bin/bcd-decompose", mesh, "-o", out, "--bodies", kind,
                                        "--epsilon", epsilon, "--effort", options.effort, "--no-cache",
                                        "--report", report], options.seconds)
                    if not out.exists():
                        print(f"{mesh.name:30} {kind:10} {epsilon:>8} {'-':>7} {making:8.1f} {'-':>8}  not made ({code})",
                              flush=True)
                        continue
                    bodies = json.loads(report.read_text())["bodies"]
                    code, deciding = run([options.build / "bin/bound-verify", "cover", mesh, out, "--prepare"],
                                         options.seconds)
                    verdict = {0: "verified", 1: "refuted", None: "out of time"}.get(code, f"exit code {code}")
                    wrong += code != 0
                    print(f"{mesh.name:30} {kind:10} {epsilon:>8} {bodies:7} {making:8.1f} {deciding:8.1f}  {verdict}",
                          flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
