#!/usr/bin/env python3
"""Bounded predicates judged by exact meshes, in four scenes: a UR5, a KR 120, both, a UR5 that carries.

KABOUM_MESHES=/path/to/meshes benchmarks/judged_scenes.py BUILD --configurations N --segments M --out DIR
makes the scenes (kept in DIR) and runs judged-benchmark on each, N and M shared out among them.
"""

import argparse
import json
import math
import os
import random
import subprocess
import sys
from pathlib import Path

PARTS = ["clean-rotor.off", "clean-fandisk.off", "clean-knot1.off", "clean-joint.off", "clean-spool.off",
         "clean-elephant.off"]
UR5 = "robots/ur5-description/urdf/ur5-robot.urdf"
KR120 = "robots/kuka-kr120-support/urdf/kr120r2500pro.urdf"


def scaled(source, target, diagonal):
    """A copy of an OFF file with this diagonal, about its middle."""
    words = source.read_text().split()
    count, faces = int(words[1]), int(words[2])
    values = [float(w) for w in words[4:4 + 3 * count]]
    points = [values[3 * i:3 * i + 3] for i in range(count)]
    low = [min(p[k] for p in points) for k in range(3)]
    high = [max(p[k] for p in points) for k in range(3)]
    factor = diagonal / math.dist(low, high)
    lines = ["OFF", f"{count} {faces} 0"]
    lines += [" ".join(repr(factor * (p[k] - 0.5 * (low[k] + high[k]))) for k in range(3)) for p in points]
    rest = words[4 + 3 * count:]
    lines += [" ".join(rest[4 * i:4 * i + 4]) for i in range(faces)]
    target.write_text("\n".join(lines) + "\n")


def made_scene(args, name, robots, objects, reach, carried=None):
    """The scene's file, with objects put by chance off the axis of the first robot."""
    file = args.out / f"{name}.json"
    if file.exists():
        return file
    command = [args.build / "bin/kaboum-scene", "make", file, "--quiet", "--epsilon", args.epsilon, "--effort", "fast"]
    for robot, urdf, _ in robots:
        command += ["--robot", f"{robot}={urdf}"]
    for part, mesh in objects:
        command += ["--object", f"{part}={mesh}"]
    subprocess.run(command, check=True)
    scene = json.loads(file.read_text())
    rng = random.Random(name)
    for stated, (_, _, base) in zip(scene["robots"], robots):
        stated["base"] = {"position": base, "rpy": [0, 0, rng.uniform(-3, 3)]}
    for stated in scene["objects"]:
        while True:
            at = [reach * rng.uniform(-1, 1) for _ in range(3)]
            if all(math.dist(at[:2], base[:2]) > 0.3 * reach for _, _, base in robots):
                break
        stated["pose"] = {"position": at, "rpy": [rng.uniform(-3, 3) for _ in range(3)]}
    if carried is not None:
        scene["attachments"] = [{"object": carried[0], "robot": robots[0][0], "link": carried[1],
                                 "position": carried[2], "rpy": [0.3, 0.2, 0.1]}]
    file.write_text(json.dumps(scene, indent=1))
    return file


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=Path)
    parser.add_argument("--configurations", type=int, default=4000)
    parser.add_argument("--segments", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--epsilon", default="2%")
    parser.add_argument("--scenes", default="ur5,kr120,two,carried")
    parser.add_argument("--out", type=Path, default=Path("judged"))
    args = parser.parse_args()
    args.build = args.build.resolve()
    args.out.mkdir(parents=True, exist_ok=True)
    args.out = args.out.resolve()
    meshes = Path(os.environ.get("KABOUM_MESHES", ""))
    if not (meshes / UR5).exists():
        sys.exit("KABOUM_MESHES does not lead to the collection of meshes")
    for size, diagonal in [("small", 0.3), ("large", 0.9)]:
        for part in PARTS:
            if not (args.out / f"{size}-{part}").exists():
                scaled(meshes / part, args.out / f"{size}-{part}", diagonal)

    def parts(size, count):
        return [(f"part{i}", args.out / f"{size}-{PARTS[i % len(PARTS)]}") for i in range(count)]

    ur5, kr120 = meshes / UR5, meshes / KR120
    scenes = {
        "ur5": dict(robots=[("ur5", ur5, [0, 0, 0])], objects=parts("small", 12), reach=0.9),
        "kr120": dict(robots=[("kr120", kr120, [0, 0, 0])], objects=parts("large", 12), reach=2.6),
        "two": dict(robots=[("ur5", ur5, [0, 0, 0.4]), ("kr120", kr120, [1.4, 0.3, 0])],
                    objects=parts("small", 4), reach=1.2),
        "carried": dict(robots=[("ur5", ur5, [0, 0, 0])], objects=parts("small", 8), reach=0.9,
                        carried=("part0", "wrist_3_link", [0, 0.25, 0])),
    }
    chosen = args.scenes.split(",")
    wrong = []
    for name in chosen:
        scene = scenes[name]
        file = made_scene(args, name, **scene)
        named = [f"{n}={f}" for n, f, *_ in scene["robots"] + scene["objects"]]
        run = subprocess.run([args.build / "benchmarks/judged-benchmark", file,
                              str(args.configurations // len(chosen)), str(args.segments // len(chosen)),
                              str(args.seed), *named])
        if run.returncode != 0:
            wrong.append(name)
    if wrong:
        sys.exit("wrong answers, or no run: " + ", ".join(wrong))


if __name__ == "__main__":
    main()
