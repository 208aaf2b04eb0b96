#!/usr/bin/env python3
"""Configurations of a Panda, UR5 or Fetch asked of our batch and of VAMP, and judged by exact meshes.

  benchmarks/batch_peers.py BUILD RESOURCES VAMP FOLDER [--robots panda,ur5,fetch] [--rows 2000] [--seed 1]

BUILD has bin/kaboum-scene and benchmarks/batch-peer-benchmark; RESOURCES is VAMP's folder of that name; VAMP has the programs
vamp-rows-ROBOT that benchmarks/peers/vamp/build.py makes. Scenes are those of batch_scenes.py and the first of each kind of
MotionBenchMaker's. In each there are four kinds of so many rows: drawn from all values, halved towards contact by the exact meshes,
halved by our batch, and places along motions that our batch calls free. Both get the same rows, and the exact meshes say which are in
contact. VAMP's time is that of packs of eight that are answered as one; *with an answer of its own* it is that of one by one. *Missed*: called free of those that are in contact; of --depths of them, which are between links of the robot, how deep the deepest is
at least, and the median; *false alarms*: called not free of those that are free. A pair of links that a robot's SRDF allows does not count for anybody. The last line of a robot is the sum.

FOLDER keeps all files. The exit code is 1 where our batch misses a contact.
"""
import argparse
import json
import pathlib
import subprocess
import sys

import numpy

import planner_peers as peers

KINDS = {"drawn": "drawn", "meshes": "at contact by the meshes", "sets": "at contact by our sets", "along": "along free motions"}


def scene_lines(kind, objects):
    """A scene as vamp-rows reads it, with the shapes of VAMP's own problem_dict_to_vamp: cylinders become capsules, in `box` boxes."""
    out = []
    for thing in objects:
        (shape, size), = thing["shape"].items()
        numbers = list(thing["position"])
        if shape == "sphere":
            numbers.append(size["radius"])
        elif shape == "box":
            numbers += thing["euler"] + [0.5 * a for a in size["size"]]
        elif kind == "box":
            numbers += thing["euler"] + [size["radius"], size["radius"], 0.5 * size["length"]]
        else:
            numbers += thing["euler"] + [size["radius"], size["length"]]
        word = "sphere" if shape == "sphere" else "cuboid" if shape == "box" or kind == "box" else "capsule"
        out.append(" ".join([word, *(repr(float(n)) for n in numbers)]) + "\n")
    return "".join(out)


def verdicts(file):
    return numpy.fromfile(file, dtype=numpy.uint8).astype(bool)


def measure(args, name, scene, urdf, kind, objects):
    """Counts of a scene, by kind of rows."""
    folder = args.folder / name / kind
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "objects").write_text(json.dumps(objects) + "\n")
    (folder / "scene.txt").write_text(scene_lines(kind, objects))
    program, common = args.build / "benchmarks/batch-peer-benchmark", [scene, urdf, folder / "objects"]
    kept, asked = folder / f"said-{args.rows}-{args.seed}.json", [program, "rows", *common, str(args.rows), str(args.seed), folder]
    if not kept.exists():
        kept.write_text(subprocess.run(asked, check=True, capture_output=True, text=True).stdout)
    said = json.loads(kept.read_text())
    out = {}
    for rows in KINDS:
        file = folder / f"{rows}.rows"
        theirs = json.loads(subprocess.run([args.vamp / f"vamp-rows-{name}", folder / "scene.txt", file, folder / f"{rows}.vamp"], check=True,
                                           stdout=subprocess.PIPE).stdout)
        values, free = numpy.fromfile(file), verdicts(folder / f"{rows}.meshes")
        values = values.reshape(len(free), -1)
        for who, nanoseconds, alone in (("KABouM", said[rows], said[rows]), ("VAMP", theirs["nanoseconds"], theirs["nanoseconds alone"])):
            called = verdicts(folder / f"{rows}.{'ours' if who == 'KABouM' else 'vamp'}")
            missed = values[called & ~free]
            depths = []
            if len(missed):
                (folder / "missed").write_bytes(missed[:args.depths].tobytes())
                subprocess.run([program, "depths", *common, folder / "missed", folder / f"{rows}.{who}.depths"], check=True)
                depths = [line.split() for line in (folder / f"{rows}.{who}.depths").read_text().splitlines()]
            out[rows, who] = {"rows": len(free), "in contact": int((~free).sum()), "called free": int(called.sum()), "missed": len(missed),
                              "depths": numpy.array([float(d) for d, *_ in depths]), "of links": sum("/" in a and "/" in b for _, a, b in depths),
                              "false alarms": int((free & ~called).sum()), "nanoseconds": nanoseconds, "alone": alone}
    return out


def line(title, rows, who, parts):
    """Of the same kind of rows in some scenes."""
    total = lambda key: sum(p[key] for p in parts)
    depths = numpy.concatenate([p["depths"] for p in parts])
    alarms, free = total("false alarms"), total("rows") - total("in contact")
    share = lambda a, b: f"{a:,} ({100 * a / b:.2g} %)" if b else "–"
    return "| " + " | ".join([
        title, KINDS[rows], who, f"{numpy.median([p['nanoseconds'] for p in parts]):.0f}", f"{numpy.median([p['alone'] for p in parts]):.0f}", share(alarms, free), f"{total('called free'):,}",
        share(total("missed"), total("in contact")), share(total("of links"), len(depths)), f"{1e3 * depths.max():.1f}" if len(depths) else "–",
        f"{1e3 * numpy.median(depths):.1f}" if len(depths) else "–", f"{total('in contact'):,} of {total('rows'):,}"]) + " |"


HEAD = """
| scene | configurations | by | ns each | ns each, with an answer of its own | false alarms, of those free | called free | missed, of those in contact | between links | deepest [mm] | median depth [mm] | in contact |
|---|---|---|---|---|---|---|---|---|---|---|---|"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("resources", type=pathlib.Path)
    parser.add_argument("vamp", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--robots", default="panda,ur5,fetch")
    parser.add_argument("--rows", type=int, default=2000, help="of each kind in each scene")
    parser.add_argument("--depths", type=int, default=200, help="of missed rows, whose depth is measured, in each scene and kind")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    args.build, args.folder, args.vamp = args.build.resolve(), args.folder.resolve(), args.vamp.resolve()
    missed = 0
    for name in args.robots.split(","):
        scene, urdf = peers.robot_scene(args, name)
        scenes = {}
        print(f"\n{name}{HEAD}")
        for kind, objects in peers.first_scenes(args.resources, name):
            scenes[kind] = measure(args, name, scene, urdf, kind, objects)
            for key, part in scenes[kind].items():
                print(line(kind, *key, [part]), flush=True)
                missed += part["missed"] if key[1] == "KABouM" else 0
        for rows in KINDS:
            for who in ("KABouM", "VAMP"):
                print(line(f"{name}, {len(scenes)} scenes", rows, who, [parts[rows, who] for parts in scenes.values()]), flush=True)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
