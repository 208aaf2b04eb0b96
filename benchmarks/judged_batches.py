#!/usr/bin/env python3
"""What the batch checks call free, judged by exact meshes: configurations and motions of a Panda, UR5 or Fetch.

  benchmarks/judged_batches.py BUILD RESOURCES FOLDER [--robots panda] [--configurations 10000000] [--motions 100000] [--parts K/N]

BUILD has bin/kaboum-scene and benchmarks/path-query-benchmark; RESOURCES is VAMP's folder of that name (robots, and the scenes of
MotionBenchMaker as problems.tar.bz2). Scenes are those of batch_scenes.py and the first of each kind of MotionBenchMaker's;
configurations and motions are shared out among them. Half of the configurations are drawn, half are halved towards contact; motions
begin at such, and are judged as if at every sample at 10 kHz. The exit code is 1 where something that is called free is in contact.
With --parts only each N-th scene is taken, from the K-th on, so that several may run side by side.
"""
import argparse
import json
import pathlib
import subprocess
import sys

import planner_peers as peers


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("resources", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--robots", default="panda")
    parser.add_argument("--configurations", type=int, default=10_000_000)
    parser.add_argument("--motions", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--parts", default="1/1")
    args = parser.parse_args()
    args.build, args.folder = args.build.resolve(), args.folder.resolve()
    part, parts = map(int, args.parts.split("/"))
    wrong = False
    for name in args.robots.split(","):
        scene, urdf = peers.robot_scene(args, name)
        all_scenes = list(peers.first_scenes(args.resources, name))
        for kind, objects in all_scenes[part - 1::parts]:
            file = args.folder / name / f"{kind}.objects"
            file.write_text(json.dumps(objects) + "\n")
            run = subprocess.run([args.build / "benchmarks/path-query-benchmark", "batches", scene, urdf, file,
                                  str(args.configurations // len(all_scenes)), str(args.motions // len(all_scenes)), str(args.seed)],
                                 capture_output=True, text=True)
            print(name, kind, run.stdout.strip(), run.stderr.strip(), flush=True)
            wrong = wrong or run.returncode != 0
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
