#!/usr/bin/env python3
"""Motions of two arms at once, twelve joints, certified at every instant: CPU time for each.

  benchmarks/two_arms.py BIN ur5.urdf FOLDER [--motions 20] [--epsilon 3%]

BIN has kaboum-scene and kaboum-check. Two UR5 stand 1.05 m from each other; both go from one configuration to another
by up to 1.2 rad a joint, drawn at random, at once. Each motion that is free is decided 199 times, there and back; what
reading the scene takes is taken off. Of the others, how long it takes to find the contact is not counted.
"""
import argparse
import json
import pathlib
import random
import statistics
import subprocess

HOME = [0, -1.2, 1.2, -1.5, -1.5, 0]
TIMES = 199


def user_seconds(bin_, scene, folder, paths):
    """Exit code, and CPU time of one run."""
    command = [bin_ / "kaboum-check", scene, "--quiet", "--threads", "1", "--report", folder / "report.json"]
    command += ["--ignore-limits"] if paths else []
    for name, rows in paths.items():
        file = folder / f"{name}.csv"
        file.write_text("".join(",".join(map(repr, row)) + "\n" for row in rows))
        command += ["--path", f"{name}={file}"]
    code = subprocess.run(command, check=False).returncode
    return code, json.loads((folder / "report.json").read_text())["resources"]["user_seconds"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("urdf", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--motions", type=int, default=20)
    parser.add_argument("--epsilon", default="3%")
    args = parser.parse_args()
    args.folder.mkdir(parents=True, exist_ok=True)
    scene = args.folder / "arms.json"
    if not scene.exists():
        subprocess.run([args.bin / "kaboum-scene", "make", scene, "--robot", f"left={args.urdf}", "--robot", f"right={args.urdf}",
                        "--epsilon", args.epsilon, "--effort", "fast", "--quiet"], check=True)
        text = json.loads(scene.read_text())
        text["robots"][1]["base"] = {"position": [1.05, 0.1, 0], "rpy": [0, 0, 3.14159]}
        scene.write_text(json.dumps(text, indent=1))
    rng = random.Random(7)
    start = min(user_seconds(args.bin, scene, args.folder, {})[1] for _ in range(3))
    taken, tried = [], 0
    while len(taken) < args.motions:
        tried += 1
        ends = {name: [[x + rng.uniform(-0.6, 0.6) for x in HOME] for _ in range(2)] for name in ("left", "right")}
        code, seconds = user_seconds(args.bin, scene, args.folder, {n: (e * (TIMES // 2 + 1))[:TIMES + 1] for n, e in ends.items()})
        if code == 0:
            taken.append(1000 * (seconds - start) / TIMES)
    print(f"{len(taken)} free motions of {tried}: median {statistics.median(taken):.2f} ms, largest {max(taken):.2f} ms of CPU time each")


if __name__ == "__main__":
    main()
