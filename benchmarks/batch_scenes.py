#!/usr/bin/env python3
"""Scenes of a Panda for batch-benchmark: a table, a bookshelf, a ring of boxes, a ring of spheres.

  benchmarks/batch_scenes.py BIN panda.urdf FOLDER

BIN has kaboum-scene. FOLDER gets table.json, bookshelf.json, boxes.json and spheres.json; for programs of others, a
file of lines for each with the same obstacles: `box x y z roll pitch yaw dx dy dz`, `cylinder x y z radius length`,
`sphere x y z radius`.
"""
import copy
import json
import math
import pathlib
import subprocess
import sys


def box(name, at, size, rpy=(0, 0, 0)):
    return {"name": name, "pose": {"position": list(at), "rpy": list(rpy)}, "shape": {"box": {"size": list(size)}}}


def cylinder(name, at, radius, length):
    return {"name": name, "pose": {"position": list(at)}, "shape": {"cylinder": {"radius": radius, "length": length}}}


def sphere(name, at, radius):
    return {"name": name, "pose": {"position": list(at)}, "shape": {"sphere": {"radius": radius}}}


def scenes():
    table = [box("table", (0.75, 0, 0.15), (0.7, 1.4, 0.3)), box("wall", (1.2, 0, 0.7), (0.05, 1.4, 0.8)),
             cylinder("can1", (0.6, 0.2, 0.36), 0.035, 0.12), cylinder("can2", (0.55, -0.25, 0.36), 0.035, 0.12),
             sphere("ball", (0.7, 0, 0.36), 0.06), box("cereal", (0.65, 0.4, 0.42), (0.06, 0.18, 0.24), (0, 0, 0.4))]
    shelf = [box(f"shelf{i}", (0.75, 0, 0.05 + 0.3 * i), (0.35, 1.0, 0.02)) for i in range(5)]
    shelf += [box("left", (0.75, 0.5, 0.65), (0.35, 0.02, 1.25)), box("right", (0.75, -0.5, 0.65), (0.35, 0.02, 1.25)),
              box("back", (0.93, 0, 0.65), (0.02, 1.0, 1.25))]
    shelf += [cylinder(f"can{i}", (0.68, -0.3 + 0.2 * i, 0.42 + 0.3 * (i % 2)), 0.035, 0.12) for i in range(4)]
    ring = [box(f"box{i}", (0.65 * math.cos(a), 0.65 * math.sin(a), 0.6 + 0.25 * (i % 3 - 1)), (0.14,) * 3, (0.3 * i, 0.2 * i, a))
            for i, a in enumerate(2 * math.pi * k / 14 for k in range(14))]
    low = [(0.55, 0), (0.35, 0.35), (0, 0.55), (-0.55, 0), (-0.35, -0.35), (0, -0.55), (0.35, -0.35)]
    high = [(0.35, 0.35), (0, 0.55), (-0.35, 0.35), (-0.55, 0), (-0.35, -0.35), (0, -0.55), (0.35, -0.35)]
    places = [(*p, 0.25) for p in low] + [(*p, 0.8) for p in high]
    return {"table": table, "bookshelf": shelf, "boxes": ring, "spheres": [sphere(f"s{i}", p, 0.2) for i, p in enumerate(places)]}


def line(thing):
    (kind, size), = thing["shape"].items()
    numbers = list(thing["pose"]["position"])
    if kind == "box":
        numbers += thing["pose"]["rpy"] + size["size"]
    else:
        numbers += size.values()
    return " ".join([kind, *map(str, numbers)]) + "\n"


def main():
    program, urdf, folder = pathlib.Path(sys.argv[1]) / "kaboum-scene", sys.argv[2], pathlib.Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    alone = folder / "panda.json"
    subprocess.run([program, "make", alone, "--robot", f"panda={urdf}", "--epsilon", "5mm", "--effort", "fast"], check=True)
    scene = json.loads(alone.read_text())
    scene["robots"][0]["allowed_contacts"] = [["panda_leftfinger", "panda_rightfinger"], ["panda_link5", "panda_link7"]]
    alone.write_text(json.dumps(scene))
    said = subprocess.run([program, "pairs", alone], check=True, capture_output=True, text=True).stdout
    never = next(text for text in said.splitlines() if "never_in_contact" in text)
    scene["robots"][0]["never_in_contact"] = json.loads(never[never.index('{"proved_for'):])
    for name, things in scenes().items():
        made = copy.deepcopy(scene)
        made["objects"] = things
        (folder / f"{name}.json").write_text(json.dumps(made, indent=1))
        (folder / f"{name}.txt").write_text("".join(map(line, things)))


if __name__ == "__main__":
    main()
