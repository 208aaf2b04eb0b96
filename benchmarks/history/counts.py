#!/usr/bin/env python3
"""Instructions that programs take for a few fixed inputs, beside those that are on record.

counts.py BUILD-FOLDER [--check | --record NOTE] [--only REGEX] [--folder DIR]

Each run is counted by valgrind (callgrind) on one thread. Counts hardly depend on what else the machine does, so that they can be
compared over months. counts.csv beside this file has a row for each record, the newest last: date, the commit that it was made
after, a note, the compiler and the processor, and millions of instructions for each run.

Prints a line for each run: millions, those of the newest row, and the ratio. --check exits with 1 where a run takes more than 5 %
more than in the newest row; where compiler or processor differ from that row's, it says so and compares nothing. --record appends a
row: to be done on purpose, with a reason, in the commit that changes the counts. --folder keeps what the runs write.
"""
import argparse
import csv
import datetime
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
RECORD = HERE / "counts.csv"
ABOUT = ("date", "after", "note", "compiler", "processor")
MOST = 1.05

# Later runs read what earlier ones wrote.
RUNS = """
decimate-planes     bmesh-decimate knob.obj -o planes.off --vertices 600 --cost planes --effort fast
decimate-distance   bmesh-decimate knob.obj -o outer.off --vertices 600 --cost distance --effort fast
decimate-default    bmesh-decimate small.obj -o default.off --vertices 150
decimate-inner      bmesh-decimate small.obj -o inner.off --vertices 150 --direction inner --effort fast
prepare             mesh-prepare knob.obj -o prepared.off
hausdorff           hausdorff-eval knob.obj outer.off
verify-mesh         bound-verify mesh --outer knob.obj outer.off
decompose-fast      bcd-decompose small.obj -o cover.glb --no-cache --epsilon 4% --effort fast
verify-cover        bound-verify cover small.obj cover.glb --epsilon 4.1%
spheres             bcd-decompose small.obj -o spheres.glb --no-cache --bodies spheres --epsilon 10% --effort fast
verify-spheres      bound-verify cover small.obj spheres.glb --epsilon 10%
capsules            bcd-decompose small.obj -o capsules.glb --no-cache --bodies capsules --epsilon 10% --effort fast
verify-capsules     bound-verify cover small.obj capsules.glb --epsilon 10%
sweep               sweep-approx arm.urdf --path motion.csv -o swept.glb --epsilon 0.05
verify-sweep        bound-verify sweep arm.urdf motion.csv swept.glb
plan                kaboum-plan solve stacked.kpl problem.kpl --search astar -o plan.json
"""

ARM = """<robot name="arm">
<link name="base"><collision><geometry><box size="0.4 0.4 0.2"/></geometry></collision></link>
<link name="upper"><collision><origin xyz="0 0 0.2"/><geometry><mesh filename="small.obj" scale="0.1 0.1 0.2"/></geometry></collision></link>
<joint name="a" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.1" rpy="0.1 0 0.2"/>
<axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
</robot>
"""
MOTION = "a\n0\n0.4\n"


def icosphere(levels):
    g = (1 + 5 ** 0.5) / 2
    points = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1),
              (-g, 0, -1), (-g, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
             (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(levels):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(points)
                points.append(tuple((x + y) / 2 for x, y in zip(points[a], points[b])))
            return middles[key]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = finer
    return points, faces


def write_knob(path, levels):
    """A ball with bumps and dents, long in one direction."""
    points, faces = icosphere(levels)
    with open(path, "w", encoding="ascii") as out:
        for p in points:
            length = math.hypot(*p)
            x, y, z = (v / length for v in p)
            r = 1 + 0.12 * math.sin(5 * x) * math.cos(4 * y) + 0.05 * math.sin(9 * z + 2 * x)
            print(f"v {1.6 * r * x:.6f} {r * y:.6f} {0.8 * r * z:.6f}", file=out)
        for face in faces:
            print("f", *(i + 1 for i in face), file=out)


def prepare(folder):
    write_knob(folder / "knob.obj", 4)
    write_knob(folder / "small.obj", 3)
    (folder / "arm.urdf").write_text(ARM, encoding="ascii")
    (folder / "motion.csv").write_text(MOTION, encoding="ascii")
    domain = ROOT / "examples/domains/stacked"
    (folder / "stacked.kpl").write_bytes((domain / "domain.kpl").read_bytes())
    made = subprocess.run([domain / "make-problem", "6"], check=True, capture_output=True)
    (folder / "problem.kpl").write_bytes(made.stdout)


def count(tools, words, folder):
    """Millions of instructions."""
    out = folder / "callgrind.out"
    command = ["taskset", "-c", "0", "valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", str(tools / words[0]), *words[1:]]
    # Nothing is taken from earlier runs.
    environment = {**os.environ, "KABOUM_CACHE": str(folder / "cache")}
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, errors="replace", check=False, env=environment)
    if done.returncode != 0:
        sys.exit(f"counts.py: {' '.join(words)}: exit code {done.returncode}\n{done.stderr[-2000:]}")
    total = re.search(r"^(?:summary|totals): (\d+)", out.read_text(), re.M)
    out.unlink()
    return int(total.group(1)) / 1e6


def compiler_of(build):
    cache = (build / "CMakeCache.txt").read_text(errors="replace")
    program = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", cache, re.M).group(1)
    return subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout.splitlines()[0]


def processor():
    """The C library has code of its own for some."""
    found = re.search(r"^model name\s*: (.*)$", pathlib.Path("/proc/cpuinfo").read_text(errors="replace"), re.M)
    return found.group(1).strip() if found else "unknown"


def commit():
    done = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "--short=10", "HEAD"], check=False, capture_output=True, text=True)
    return done.stdout.strip() or "unknown"


def newest_row():
    if not RECORD.exists():
        return None
    with open(RECORD, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return rows[-1] if rows else None


def append_row(row, names):
    old = []
    if RECORD.exists():
        with open(RECORD, newline="", encoding="utf-8") as file:
            old = list(csv.DictReader(file))
    with open(RECORD, "w", newline="", encoding="utf-8") as file:
        out = csv.DictWriter(file, [*ABOUT, *names], restval="", extrasaction="ignore", lineterminator="\n")
        out.writeheader()
        out.writerows([*old, row])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--record", metavar="NOTE")
    parser.add_argument("--only", default="", metavar="REGEX")
    parser.add_argument("--folder", type=pathlib.Path)
    options = parser.parse_args()
    if options.record is not None and options.only:
        parser.error("a record has all runs: leave --only out")
    here = {"compiler": compiler_of(options.build), "processor": processor()}
    last = newest_row()
    alike = last is not None and all(last[key] == here[key] for key in here)
    if last is not None and not alike:
        print("not compared: on record are counts of", *(last[key] for key in here), "and this is", *here.values())
        if options.check:
            return 0
    counts, slower = {}, []
    with tempfile.TemporaryDirectory() as scratch:
        folder = (options.folder or pathlib.Path(scratch)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        prepare(folder)
        for line in RUNS.strip().splitlines():
            name, *words = line.split()
            tools = (options.build / "bin").resolve()
            if options.only and not re.search(options.only, name):
                subprocess.run([str(tools / words[0]), *words[1:]], cwd=folder, capture_output=True, check=False)
                continue
            counts[name] = count(tools, words, folder)
            before = float(last[name]) if alike and last.get(name) else None
            ratio = counts[name] / before if before else None
            if ratio is not None and ratio > MOST:
                slower.append(name)
            print(f"{name:20} {counts[name]:10.1f}" + (f" {before:10.1f} {ratio:7.3f}" if ratio is not None else ""), flush=True)
    if options.record is not None:
        append_row({"date": datetime.date.today().isoformat(), "after": commit(), "note": options.record, **here,
                    **{name: f"{value:.1f}" for name, value in counts.items()}}, list(counts))
    if slower:
        print("more than 5 % slower than on record:", ", ".join(slower))
        print("if that is meant, say why: counts.py BUILD-FOLDER --record NOTE")
    return 1 if options.check and slower else 0


if __name__ == "__main__":
    sys.exit(main())
