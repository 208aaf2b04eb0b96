#!/usr/bin/env python3
"""Many files through kaboum-batch, some damaged, the batch ended twice with kill -9: what has to hold, and what it costs.

usage: batch.py BIN WORK [N [COLLECTION]]    (N meshes, 2000; those of a folder besides generated ones)
"""
import collections
import json
import math
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

DAMAGED = 20


def ring(rng):
    around, across = rng.randrange(5, 14), rng.randrange(4, 8)
    radius, tube = rng.uniform(0.5, 2), rng.uniform(0.1, 0.4)
    at = lambda i, j: i % around * across + j % across
    vertices = []
    for i in range(around):
        for j in range(across):
            u, v = 2 * math.pi * i / around, 2 * math.pi * j / across
            r = radius + tube * math.cos(v)
            vertices.append((r * math.cos(u), r * math.sin(u), tube * math.sin(v)))
    return vertices, [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for i in range(around) for j in range(across)]


def prism(rng):
    n, height = rng.randrange(3, 24), rng.uniform(0.1, 3)
    corners = [(math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n) * rng.uniform(0.9, 1)) for i in range(n)]
    vertices = [(x, y, z) for z in (0, height) for x, y in corners]
    return vertices, [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)] + [tuple(range(n - 1, -1, -1)), tuple(range(n, 2 * n))]


def text(vertices, faces):
    return "".join("v %.9g %.9g %.9g\n" % v for v in vertices) + "".join(
        "f " + " ".join(str(i + 1) for i in f) + "\n" for f in faces)


def damage(data, kind):
    if kind % 4 == 0:
        return data[: len(data) // 3] + b"f 1 2\n"
    if kind % 4 == 1:
        return b"\x00\xff" * 300
    if kind % 4 == 2:
        return b""
    return data.replace(b"f 1 ", b"f 99999 ", 1)


def generate(folder, count, collection):
    rng = random.Random(24)
    found = []
    if collection:
        found = [p for p in sorted(collection.rglob("*")) if p.suffix in (".stl", ".ply", ".obj", ".off") and p.stat().st_size < 60_000]
    for i in range(count):
        place = folder / f"{i % 10}"
        place.mkdir(parents=True, exist_ok=True)
        if i < len(found):
            shutil.copy(found[i], place / f"m{i:04}{found[i].suffix}")
        else:
            (place / f"m{i:04}.obj").write_text(text(*(ring if i % 2 else prism)(rng)))
    generated = sorted(p for p in folder.rglob("*.obj") if int(p.stem[1:]) >= len(found))
    names = set()
    for kind, path in enumerate(rng.sample(generated, DAMAGED)):
        path.write_bytes(damage(path.read_bytes(), kind))
        names.add(path.relative_to(folder).as_posix())
    return names, len(found)


def main():
    binary, work = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 2000
    collection = pathlib.Path(sys.argv[4]) if len(sys.argv) > 4 else None
    shutil.rmtree(work, ignore_errors=True)
    damaged, collected = generate(work / "in", count, collection)
    command = [binary / "kaboum-batch", work / "in", "-o", work / "out", "--jobs", "2", "--no-pictures", "--quiet",
               "--report", work / "report.json", "--timeout", "120",
               "--command", "bmesh-decimate", "--epsilon", "2%", "--effort", "fast", "--cost", "planes"]
    journal = work / "out" / ".kaboum-batch" / "journal.jsonl"
    lines = lambda: len(journal.read_bytes().splitlines()) if journal.exists() else 0
    for part in (0.3, 0.6):
        batch = subprocess.Popen(command)
        while lines() < part * count:
            time.sleep(0.02)
        os.kill(batch.pid, signal.SIGKILL)
        batch.wait()
        print(f"kill -9 after {lines()} files")
    before = lines()
    code = subprocess.run(command).returncode
    report = json.loads((work / "report.json").read_text())
    rows = {r["name"]: r for r in report["rows"]}
    names = collections.Counter(json.loads(l)["name"] for l in journal.read_text().splitlines() if l.strip())
    states = collections.Counter(r["state"] for r in rows.values())
    bad = [n for n in damaged if rows[n]["state"] != "failed"]
    others = [r for n, r in rows.items() if n not in damaged and r["state"] not in ("done",)]
    missing = [n for n, r in rows.items() if r["state"] == "done" and (work / "out" / r["output"]).stat().st_size != r["output_bytes"]]
    left = [p for p in (work / "out").rglob("*") if p.name.endswith(".tmp")]
    run = report["files"] - report["done_before"]
    busy = sum(rows[json.loads(l)["name"]]["wall_seconds"] for l in journal.read_text().splitlines()[before:] if l.strip())
    wall = report["resources"]["wall_seconds"]
    print(f"{len(rows)} files ({collected} collected), exit code {code}, states {dict(states)}")
    print(f"damaged that did not fail: {bad}")
    print(f"others that are not done: {[(r['name'], r['reason'][:100]) for r in others]}")
    print(f"results of another size: {missing}; left behind: {left}; done twice: {[n for n, c in names.items() if c > 1]}")
    print(f"last run: {run} files in {wall:.2f} s; programs at work {busy:.2f} s; "
          f"overhead per file {1000 * (2 * wall - busy) / run:.2f} ms of a job's place, "
          f"{1000 * report['resources']['user_seconds'] / run:.2f} ms of user CPU")
    return 1 if bad or missing or left or any(c > 1 for c in names.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
