#!/usr/bin/env python3
"""Spheres that others publish for a robot beside ours, at the same distance.

compare.py ROBOT.urdf SPHERES [--package-path DIR] [--bin DIR] [--effort fast] [--out DIR]

SPHERES is what bound-verify robot --spheres reads: sets of cuRobo, VAMP, foam. Of each link all radii of theirs grow by
the largest distance of its surface from their union (as certified above), so that they hold the surface. How far they then
reach from the link's solid is measured from below (at the corners of polytopes in the spheres), which favours theirs. Ours are made within that distance, link by link, and judged. Prints a Markdown table: a row for each link, and the sums.
"""
import argparse
import base64
import json
import math
import pathlib
import re
import subprocess
import sys

import numpy

HERE = pathlib.Path(__file__).resolve().parent


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("robot", type=pathlib.Path)
    parser.add_argument("spheres", type=pathlib.Path)
    parser.add_argument("--package-path", type=pathlib.Path)
    parser.add_argument("--bin", type=pathlib.Path, default=HERE.parents[2] / "build/release/bin")
    parser.add_argument("--effort", default="fast")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("peer-spheres"))
    return parser.parse_args()


def run(o, name, *words, codes=(0,)):
    done = subprocess.run([o.bin / name, *map(str, words)], check=False, capture_output=True, text=True)
    if done.returncode not in codes:
        sys.exit(f"{name} {' '.join(map(str, words))}: {done.stderr}")
    return done


def packages(o):
    return ["--package-path", o.package_path] if o.package_path else []


def ball(center, radius):
    """Vertices and faces of a polytope with its corners on a sphere."""
    g = (1 + 5 ** 0.5) / 2
    points = [numpy.array(p) / math.hypot(1, g) for p in
              ((-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g),
               (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1))]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
             (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(1):
        finer = []
        for a, b, c in faces:
            middles = []
            for i, k in ((a, b), (b, c), (c, a)):
                p = points[i] + points[k]
                points.append(p / numpy.linalg.norm(p))
                middles.append(len(points) - 1)
            ab, bc, ca = middles
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = finer
    return [center + radius * p for p in points], faces


def segment(p, a, b):
    d = b - a
    t = numpy.clip(((p - a) * d).sum(1) / numpy.maximum((d * d).sum(1), 1e-300), 0, 1)
    return numpy.linalg.norm(p - a - t[:, None] * d, axis=1)


def distance(p, a, b, c):
    """From a point to the nearest of triangles."""
    n = numpy.cross(b - a, c - a)
    length = numpy.maximum(numpy.linalg.norm(n, axis=1), 1e-300)
    height = ((p - a) * n).sum(1) / length
    foot = p - height[:, None] * n / length[:, None]
    inside = numpy.ones(len(a), bool)
    for u, v in ((a, b), (b, c), (c, a)):
        inside &= (numpy.cross(v - u, foot - u) * n).sum(1) >= 0
    out = numpy.minimum(segment(p, a, b), numpy.minimum(segment(p, b, c), segment(p, c, a)))
    return float(numpy.where(inside, numpy.abs(height), out).min())


def winding(p, a, b, c):
    """How often triangles wind round a point: the sum of their solid angles."""
    a, b, c = a - p, b - p, c - p
    la, lb, lc = (numpy.linalg.norm(x, axis=1) for x in (a, b, c))
    above = (a * numpy.cross(b, c)).sum(1)
    below = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
    return float(numpy.arctan2(above, below).sum() / (2 * math.pi))


def farthest(balls, a, b, c):
    """The farthest point found of balls, on polytopes in them, from the solid of triangles."""
    out = 0.0
    for center, radius in balls:
        points, _ = ball(center, radius)
        if radius + distance(center, a, b, c) <= out:
            continue  # none of its points is farther
        for far, p in sorted(((distance(p, a, b, c), tuple(p)) for p in points), reverse=True):
            if far <= out:
                break
            if winding(numpy.array(p), a, b, c) < 0.5:
                out = far
                break
    return out


def pieces(page):
    """By link, the triangles of its shapes in its frame, from a page of bound-verify: float32 numbers."""
    data = json.loads(re.search(r'<script id="data"[^>]*>(.*?)</script>', page.read_text(), re.S)[1])
    out = {}
    for layer in data["layers"]:
        for shape in layer["shapes"]:
            points = numpy.frombuffer(base64.b64decode(shape["points"]), "<f4").reshape(-1, 3)
            corners = numpy.frombuffer(base64.b64decode(shape["triangles"]), "<u4").reshape(-1, 3)
            out.setdefault((shape["link"], layer["name"] == "spheres"), []).append((points, corners))
    return out


def main():
    o = arguments()
    o.out.mkdir(parents=True, exist_ok=True)
    run(o, "bound-verify", "robot", o.robot, "--spheres", o.spheres, *packages(o), "--report", o.out / "theirs.json",
        "--page", o.out / "theirs.html", codes=(0, 1, 7))
    report = json.loads((o.out / "theirs.json").read_text())
    shown = pieces(o.out / "theirs.html")
    rows, epsilons = [], {}
    numbers = sorted({link for link, _ in shown})
    for number, link in zip(numbers, report["links"]):
        if link["spheres"] == 0:
            continue
        grow = link.get("depth", {"upper": 0})["upper"]
        balls = []
        for points, _ in shown[number, True]:
            center = (points.max(0) + points.min(0)).astype(float) / 2
            balls.append((center, float(numpy.linalg.norm(points - center, axis=1).max()) + grow))
        triangles = numpy.concatenate([points[corners].astype(float) for points, corners in shown[number, False]])
        far = farthest(balls, *(triangles[:, k] for k in range(3)))
        epsilons[link["link"]] = far
        rows.append([link["link"], link["spheres"], grow, far])
    (o.out / "epsilons.yaml").write_text("".join(f'"{name}": {value}\n' for name, value in epsilons.items()))
    run(o, "bcd-decompose", o.robot, "-o", o.out / "ours.yaml", "--bodies", "spheres", "--epsilons", o.out / "epsilons.yaml",
        "--epsilon", "5%", "--effort", o.effort, "--links", ",".join(epsilons), *packages(o), codes=(0, 1))
    run(o, "bound-verify", "robot", o.robot, "--spheres", o.out / "ours.yaml", *packages(o), "--links", ",".join(epsilons),
        "--report", o.out / "ours.json")
    ours = {link["link"]: link["spheres"] for link in json.loads((o.out / "ours.json").read_text())["links"]}
    print("| link | theirs | grown by [mm] | farthest [mm] | ours |\n|---|---|---|---|---|")
    for name, count, grow, far in rows:
        print(f"| {name} | {count} | {1000 * grow:.1f} | {1000 * far:.1f} | {ours[name]} |")
    theirs = sum(row[1] for row in rows)
    print(f"| all | {theirs} | | {1000 * sum(r[3] for r in rows) / len(rows):.1f} on the mean | {sum(ours[r[0]] for r in rows)} "
          f"({sum(ours[r[0]] for r in rows) / theirs:.2f}) |")


main()
