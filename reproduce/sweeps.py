"""Swept volumes and what convex sets buy in collision checking: Figures 4.9 and 4.10, Eq. 4.20.

The robots are those of $KABOUM_MESHES/robots; without it, or without the programs, the section says what is
left out. Results are kept beside a key of what they depend on.
"""

import csv
import math
import os
import pathlib
import subprocess
import sys

from calls import Calls

ROOT = pathlib.Path(__file__).resolve().parent.parent
RULES = {"uniform": "uniform (Eq. 4.20)", "subset": "joints before the link", "second-order": "second order",
         "adaptive": "adaptive", "balanced": "balanced (default)"}
BODY_EPSILON = 0.01  # of the bodies at rest, where only the margin is to change [m]
EPSILONS = (0.05, 0.016, 0.005, 0.0016, 0.0005, 0.00016, 0.00005)
ROBOTS = (("UR5", "ur5-description/urdf/ur5-robot.urdf", (1, 1, 1, 1, 1, 1)),
          ("KUKA KR 120 R2500 pro", "kuka-kr120-support/urdf/kr120r2500pro.urdf", (0.8, -0.5, 0.6, 1, -0.7, 0.9)))
QUERIES = 300


def slope(points):
    """Of the straight line of least squares through (log x, log y)."""
    logs = [(math.log(x), math.log(y)) for x, y in points]
    mx, my = (sum(column) / len(logs) for column in zip(*logs))
    return sum((x - mx) * (y - my) for x, y in logs) / sum((x - mx) ** 2 for x, _ in logs)


def statistics(path):
    """(library, model) -> mean, 99 %, largest time [µs], in the file's order."""
    times = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            times.setdefault((row["library"], row["model"]), []).append(float(row["microseconds"]))
    out = {}
    for key, values in times.items():
        values.sort()
        out[key] = (sum(values) / len(values), values[int(0.99 * (len(values) - 1))], values[-1])
    return out


def _path_file(folder, name, goal):
    path = folder / f"{name}.csv"
    path.write_text(",".join("0" for _ in goal) + "\n" + ",".join(map(str, goal)) + "\n")
    return path


def _sweeps(call, robot, title, goal, document):
    short = title.split()[0].lower() if title == "UR5" else "kr120"
    path = _path_file(call.folder, short, goal)
    program, inputs = call.programs / "sweep-approx", [robot, path, call.programs / "bcd-decompose"]
    rows, uniform = [], None
    for rule, name in RULES.items():
        step, picture = f"{short}-{rule}", ["--preview", f"{short}.png"] if rule == "balanced" else []
        arguments = [robot, "--path", path, "--epsilon", "0.005", "--bound", rule, "-o", f"{step}.glb",
                     "--implicit-margin", "--report", f"{step}-report.json", *picture]
        if call(step, program, arguments, inputs, [f"{step}.glb", f"{step}-report.json"]) is None:
            continue
        report = call.report(f"{step}-report.json")
        uniform = uniform or report["bodies"]
        rows.append([name, f"{report['bodies']:,}", f"{uniform / report['bodies']:.1f}×",
                     f"{1000 * report['margin']:.3f}", f"{1000 * report['reach']:.1f}"])
    if not rows:
        return
    document.heading(title, 3)
    document.paragraph(f"Largest margin 5 mm, {report['bodies_at_rest']} bodies at rest, joints from 0 to "
                       f"{', '.join(map(str, goal))} rad.")
    document.table(["steps", "bodies", "fewer", "margin [mm]", "reach [mm]"], rows)
    if (call.folder / f"{short}.png").is_file():
        document.picture(call.folder / f"{short}.png", f"The volume that the {title} sweeps (as Figure 4.10)")
    step, swept = f"{short}-verify", call.folder / f"{short}-balanced.glb"
    if swept.is_file():
        code = call(step, call.programs / "bound-verify",
                    ["sweep", robot, path, swept, "--report", f"{step}-report.json"], [robot, path, swept],
                    [f"{step}-report.json"], (0, 1, 7))
        if code is not None:
            report = call.report(f"{step}-report.json")
            document.paragraph(
                f"bound-verify sweep, for the links' original meshes and the whole motion: {report['verdict']}; of "
                f"{report['samples']:,} places sampled the farthest from the bodies is "
                f"{1000 * report['largest_found']['distance']:.3f} mm away.")


def _convergence(call, robot, title, goal, document):
    """Proposition 3 speaks of one robot's m bodies and one path: only ε changes here. Bodies of their own ε for each
    row would be more and more, too."""
    path = _path_file(call.folder, "kr120", goal)
    rows, points, seconds = [], [], 0
    for epsilon in EPSILONS:
        step = f"convergence-{epsilon:g}"
        if call(step, call.programs / "sweep-approx",
                [robot, "--path", path, "--epsilon", f"{epsilon:f}", "--body-epsilon", f"{BODY_EPSILON:g}", "--bound",
                 "uniform", "-o", f"{step}.glb", "--implicit-margin", "--report", f"{step}-report.json"],
                [robot, path], [f"{step}-report.json"]) is None:
            continue
        report = call.report(f"{step}-report.json")
        rest, bodies = report["bodies_at_rest"], report["bodies"]
        seconds += call.seconds(step)
        points.append((epsilon, bodies))
        rows.append([f"{1000 * epsilon:g}", f"{rest}", f"{bodies:,}", f"{bodies / rest:,.1f}",
                     f"{bodies * math.sqrt(epsilon):.2f}"])
    if len(points) > 2:
        document.heading("Quadratic convergence (Proposition 3)", 3)
        document.paragraph(
            f"{title}, uniform steps, joints from 0 to {', '.join(map(str, goal))} rad: the robot's bodies (within "
            f"{1000 * BODY_EPSILON:g} mm) and the path are the same in every row, as the proposition has them; ε is the "
            "margin. It says that bodies grow with 1/√ε, so the last column is to be constant.")
        document.table(["ε [mm]", "bodies at rest", "bodies", "per body at rest", "bodies · √(ε / m)"], rows)
        document.paragraph(f"Slope of log bodies over log ε: {slope(points):.3f}, and {slope(points[-3:]):.3f} of the "
                           f"last three; −0.5 is what Proposition 3 states. User CPU time: {seconds:.0f} s.")


def _collisions(call, robot, document):
    program = call.programs.parent / "benchmarks" / "collision-benchmark"
    if not program.is_file():
        document.paragraph(
            "Left out: collision-benchmark is not built. It needs FCL, libccd, ODE, Bullet and OMPL (scripts/setup "
            "--benchmarks) and cmake --preset release -DKABOUM_BUILD_BENCHMARKS=ON.")
        return
    if call("collision", program, [robot, QUERIES, "collision-times.csv"], [robot], ["collision-times.csv"]) is None:
        return
    times = call.folder / "collision-times.csv"
    found = statistics(times)
    rows = []
    for (library, model), (mean, most_of, most) in found.items():
        base = found.get((library, "triangle meshes"))
        ratios = [f"{base[k] / x:.1f}×" if base and model != "triangle meshes" else "—" for k, x in ((2, most), (1, most_of), (0, mean))]
        rows.append([library, model, f"{mean:.1f}", f"{most_of:.1f}", f"{most:.1f}", *ratios])
    document.paragraph(f"UR5 between two walls with windows: {QUERIES} queries of RRT-Connect replayed on triangle "
                       "meshes, hulls of links and bounding sets; microseconds. The thesis states about a factor of 10 "
                       "between the maxima. Factors are against triangle meshes in the same library; below 1× sets are slower. Maxima are "
                       "those of single queries, and the least certain. Bullet looks for all contacts of two meshes.")
    document.table(["library", "model", "mean [µs]", "99 % [µs]", "max [µs]", "max, faster", "99 %, faster", "mean, faster"], rows)
    picture = call.folder / "figure-4-9.svg"
    subprocess.run([sys.executable, ROOT / "benchmarks/collision/plot.py", times, picture], check=True)
    document.picture(picture, "Distribution of the time of a collision check; lines: mean and maximum")


def _robots():
    meshes = os.environ.get("KABOUM_MESHES")
    robots = [(title, pathlib.Path(meshes) / "robots" / path, goal) for title, path, goal in ROBOTS] if meshes else []
    return [entry for entry in robots if entry[1].is_file()]


def section(context, document):
    if context.collecting:
        return
    document.heading("Swept volumes")
    robots = _robots()
    if not robots:
        document.paragraph("Left out: the robots of $KABOUM_MESHES/robots are not there.")
        return
    missing = [name for name in ("sweep-approx", "bcd-decompose", "bound-verify")
               if not (context.runner.programs / name).is_file()]
    if missing:
        document.paragraph(f"Left out: {', '.join(missing)} not built; scripts/build makes them.")
        return
    call = Calls(context, "sweeps")
    for title, robot, goal in robots[:1] if context.quick else robots:
        _sweeps(call, robot, title, goal, document)
    if not context.quick:
        title, robot, goal = robots[-1]
        _convergence(call, robot, title, goal, document)


def collisions_section(context, document):
    if context.collecting:
        return
    document.heading("Collision checks (Figure 4.9)")
    robots = _robots()
    if not robots:
        document.paragraph("Left out: the robots of $KABOUM_MESHES/robots are not there.")
        return
    _collisions(Calls(context, "sweeps"), robots[0][1], document)
