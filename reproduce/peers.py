"""Other programs of today on the same files: CGAL and meshoptimizer simplifying, CGAL's alpha wrap, CoACD's convex bodies, OMPL's paths.

Their results are judged as ours are (judged.py): certified distances, and how far the original sticks out of what stands for it.
"""

import json
import os
import pathlib
import re
import subprocess
import sys

import author
import judged
import lines
import meshes
from calls import Calls
from document import figure
from scenarios import SCENARIOS

ROOT = pathlib.Path(__file__).resolve().parent.parent
REQUIREMENTS = pathlib.Path(__file__).with_name("requirements.txt")
FAILED = "peers-left-out.json"


def environment(out):
    """The interpreter of a virtual environment in `out` that has what can be installed of requirements.txt; what cannot is in FAILED, and is not
    tried again until that file is removed. None: there can be no environment."""
    folder = out / "environment"
    python = folder / "bin/python"
    wanted = [line.split("#")[0].strip() for line in REQUIREMENTS.read_text(encoding="utf-8").splitlines()]
    wanted = [line for line in wanted if line]
    if not python.is_file():
        done = subprocess.run(["/usr/bin/python3" if os.access("/usr/bin/python3", os.X_OK) else sys.executable, "-m", "venv", folder],
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            (out / FAILED).write_text(json.dumps({name: "no virtual environment (python3-venv)" for name in wanted}), encoding="utf-8")
            return None
    listed = subprocess.run([python, "-m", "pip", "freeze"], capture_output=True, text=True, check=False).stdout.split()
    failed = {}
    if (out / FAILED).is_file():
        failed = {name: why for name, why in json.loads((out / FAILED).read_text(encoding="utf-8")).items() if name in wanted and name not in listed}
    for name in wanted:
        if name in listed or name in failed:
            continue
        print(f"installing {name} into {folder} ...", file=sys.stderr, flush=True)
        done = subprocess.run([python, "-m", "pip", "install", "-q", name], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            said = [line.strip() for line in done.stderr.splitlines() if re.search("error", line, re.I)]
            failed[name] = next((line for line in said if "CMake Error" in line or "No matching" in line), (said or ["pip failed"])[-1])
    (out / FAILED).write_text(json.dumps(failed, indent=1) + "\n", encoding="utf-8")
    return python


def _benchmark(context, document, name):
    """A program beside ours in benchmarks/; None where it is not built, which is said."""
    program = context.runner.programs.parent / "benchmarks" / name
    if program.is_file():
        return program
    document.paragraph(f"Left out: {name} is not built; scripts/reproduce-thesis builds it, or cmake --preset release -DKABOUM_BUILD_BENCHMARKS=ON.")
    return None


def _debian(package):
    done = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", package], capture_output=True, text=True, check=False)
    return done.stdout.strip() or "version unknown"


METHODS = {"cgal": "CGAL, Garland–Heckbert", "meshopt": "meshoptimizer", "planes": "planes (ours)", "distance": "distance (ours)"}


def simplifiers_section(context, document):
    if context.collecting:
        return
    document.heading("Beside other simplifiers")
    program = _benchmark(context, document, "simplifiers")
    if program is None:
        return
    document.paragraph(
        f"CGAL {_debian('libcgal-dev')}, meshoptimizer {_debian('libmeshoptimizer-dev')}: the same prepared, closed mesh, the same number of vertices, one thread, a "
        "process each. Theirs are two-sided: they need not enclose, and so stay nearer to the surface. Of each result: distances of surfaces, how far the original "
        "sticks out of it, and whether it encloses, all in percent of the diagonal. Least time of three runs.")
    call = Calls(context, "simplifiers")
    for model in (m for m in context.models if m.name in ("mitsubishi", "kr120", "bunny", "bracket")):
        original = author._closed(call, model)
        if original is None:
            continue
        name, rows = f"{model.name}-all", []
        share = 0.1
        files = [f"{model.name}-results/{original.stem}-{method}.off" for method in METHODS]
        (call.folder / f"{model.name}-results").mkdir(exist_ok=True)
        if call(name, program, ["--methods", ",".join(METHODS), "--ratios", share, "--repeat", 3, "--out", f"{model.name}-results", "--json", f"{name}-rows.json", original],
                [original], [f"{name}-rows.json", *files]) is None:
            continue
        for row, file in zip(call.report(f"{name}-rows.json"), files):
            method = f"{model.name}-{row['method']}"
            said, out, _ = judged.cells(judged.solids(call, method, original, file, False))
            rows.append([METHODS[row["method"]], f"{row['seconds']:.2f} s", out, said,
                         figure(max(row["to_result_max"], row["to_original_max"])), figure(max(row["to_result_mean"], row["to_original_mean"])),
                         lines.count(row["vertices"]), f"{row['peak_megabytes']:.0f} MB"])
        document.heading(f"{model.title}, closed, to {share:.0%} of the vertices", 3)
        document.table(["by", "CPU time", "original sticks out", "verdict", "Hausdorff", "mean", "vertices", "memory [MB]"], rows)


WRAPPED = ("clean-elephant.off", "dirty-elephant-with-holes.off", "thesis-robots/mitsubishi-rv6s-whole-welded.ply")
WRAP_COLUMNS = ("triangles in", "triangles, ours", "alpha wrap", "crossing, ours", "crossing, alpha wrap", "volume, ours ÷ theirs", "CPU time, ours [s]",
                "CPU time, alpha wrap [s]", "CPU time, ours ÷ theirs", "distance, ours", "distance, alpha wrap", "distance, ours ÷ theirs", "every triangle inside, ours, theirs")


def wraps_section(context, document):
    if context.collecting:
        return
    document.heading("Beside CGAL's alpha wrap")
    program = _benchmark(context, document, "wrapping-benchmark")
    folder = os.environ.get("KABOUM_MESHES")
    files = [path for path in (pathlib.Path(folder or "/nonexistent") / name for name in WRAPPED) if path.is_file()]
    if program is None or not files:
        document.paragraph("Left out." if program is None else "Left out: the meshes of $KABOUM_MESHES are not there.")
        return
    offset, seal = 0.01, 0.02
    document.paragraph(f"CGAL {_debian('libcgal-dev')}, `alpha_wrap_3`: offset {100 * offset:g} % of the diagonal, gaps up to {100 * seal:g} % sealed (alpha is half of it). Distances are "
                       "certified and in percent. Both are judged by libverify.")
    call = Calls(context, "wraps")
    script = call.folder / "wrap"
    script.write_text(f'#!/bin/sh\nout=$1; shift\nexec "{program}" "$@" > "$out"\n', encoding="utf-8")
    script.chmod(0o755)
    rows = []
    for path in files[:2] if context.quick else files:
        result = f"{path.stem}.txt"
        if call(path.stem, script, [result, offset, seal, path], [program, path], [result]) is None:
            continue
        cells = [cell.strip() for cell in (call.folder / result).read_text(encoding="utf-8").strip().splitlines()[-1].strip("| ").split("|")]
        rows.append(cells)
    document.table(["model", *WRAP_COLUMNS], rows)


def _said_missing(context, document, package):
    """Says that a package is not there, and why."""
    try:
        failed = json.loads((context.folder / FAILED).read_text(encoding="utf-8"))
    except FileNotFoundError:
        failed = {}
    why = next((f"{name} could not be installed: {said}" for name, said in failed.items() if name.startswith(package + "==")), "")
    document.paragraph(f"Left out: {why or 'scripts/reproduce-thesis --peers installs ' + package + ' (reproduce/requirements.txt)'}.")


def _has(python, module):
    return python is not None and subprocess.run([python, "-c", f"import {module}"], capture_output=True, check=False).returncode == 0


COACD = ("acd-peers/torus1.obj", "acd-peers/snowflake.obj", "acd-peers/rocker-arm.obj", "acd-peers/ur5e-link0.obj")
THRESHOLD = 0.05


def coacd_section(context, document):
    if context.collecting:
        return
    document.heading("Beside CoACD")
    python = context.others.get("python")
    folder = os.environ.get("KABOUM_MESHES")
    files = [path for path in (pathlib.Path(folder or "/nonexistent") / name for name in COACD) if path.is_file()]
    if not _has(python, "coacd"):
        _said_missing(context, document, "coacd")
        return
    call, rows, version = Calls(context, "coacd"), [], ""
    for path in files[:2] if context.quick else files:
        name = path.stem
        original = call.folder / f"{name}.off"
        meshes.write_off(original, *meshes.read_obj(path))
        if call(f"{name}-theirs", python, [ROOT / "benchmarks/peers/coacd/decompose.py", original, f"{name}-theirs.obj", THRESHOLD, f"{name}-theirs-set.json"],
                [original], [f"{name}-theirs.obj", f"{name}-theirs-set.json"]) is None:
            continue
        report = call.report(f"{name}-theirs-set.json")
        version = report["version"]
        rows.append(_bodies(call, f"{name}-theirs", name, "CoACD", original, report["bodies"], report["vertices"], report["user_seconds"]))
        for by, options in (("ours, as many bodies", ["--max-bodies", report["bodies"]]), ("ours, ε 1 %", ["--epsilon", "1%"])):
            step = f"{name}-{by.split(', ')[1].replace(' ', '-').replace('%', 'pc')}"
            if call(step, call.programs / "bcd-decompose", [original, "-o", f"{step}.obj", "--effort", "fast" if context.quick else "normal", *options, "--report",
                                                            f"{step}-set.json"], [original], [f"{step}.obj", f"{step}-set.json"], (0, 1)) is None:
                continue
            own = call.report(f"{step}-set.json")
            rows.append(_bodies(call, step, name, by, original, own["bodies"], own["vertices"], call.seconds(step)))
    document.paragraph(f"CoACD {version} by its package, threshold {THRESHOLD}, seed 0, else its defaults, from the same file. In percent of the diagonal, certified for every point: how "
                       "far the original sticks out of the union, and how far the union reaches beyond it. Its own measure is another one, and it does not mean to enclose. "
                       "CPU seconds of the process, all threads.")
    document.table(["model", "by", "CPU time", "bodies", "vertices", "union → solid", "original sticks out", "verdict"], rows)


def _bodies(call, step, name, by, original, bodies, vertices, seconds):
    said, out, beyond = judged.cells(judged.solids(call, step, original, f"{step}.obj", True))
    return [name, by, f"{seconds:.1f} s", str(bodies), lines.count(vertices), beyond, out, said]


MOTION = re.compile(r"^(?P<what>.+?)\s+median\s+(?P<median>[\d.]+) ms, mean\s+(?P<mean>[\d.]+), 90 %\s+(?P<late>[\d.]+), most\s+(?P<most>[\d.]+) \((?P<count>\d+)\)")


def motions_section(context, document):
    if context.collecting:
        return
    document.heading("Motions, beside OMPL")
    program = _benchmark(context, document, "motion-benchmark")
    if program is None or not (context.runner.programs / "kaboum-scene").is_file():
        return
    call, folder = Calls(context, "motions"), "bimanual-assembly-4-scene"
    if call("scene of the assembly", SCENARIOS / "bimanual-assembly" / "run", [4, "--scene-only", "--out", folder],
            [call.programs / "kaboum-scene", SCENARIOS / "parts.py", SCENARIOS / "scenario.py"], [f"{folder}/robot1.urdf", f"{folder}/pipe.off"]) is None:
        return
    pipes = [text for k in range(20) for text in ("--object", f"pipe{k}={folder}/pipe.off")]
    if call("scene of pipes", call.programs / "kaboum-scene", ["make", f"{folder}/pipes.json", "--force", "--epsilon", "1%", "--effort", "fast", "--robot",
                                                               f"robot1={folder}/robot1.urdf", *pipes], [call.folder / folder / "pipe.off"], [f"{folder}/pipes.json"]) is None:
        return
    queries = 50 if context.quick else 300
    script = call.folder / "paths"
    script.write_text(f'#!/bin/sh\nexec "{program}" {folder}/pipes.json {folder}/robot1.urdf {folder}/pipe.off "$1" > paths.txt\n', encoding="utf-8")
    script.chmod(0o755)
    if call("paths", script, [queries], [program, call.folder / folder / "pipes.json"], ["paths.txt"]) is None:
        return
    text = (call.folder / "paths.txt").read_text(encoding="utf-8").splitlines()
    found = [m for m in map(MOTION.match, text) if m]
    document.paragraph(f"OMPL {_debian('libompl-dev')} (Debian's), RRT-Connect with its usual resolution and the same predicate for configurations, beside find_path, whose paths are free at every "
                       f"instant and made shorter: {queries} queries of a robot among twenty pipes, CPU time, one process. OMPL asks for less: configurations at samples.")
    document.table(["by", "median [ms]", "mean [ms]", "90 % [ms]", "most [ms]", "paths found"],
                   [[m["what"], m["median"], m["mean"], m["late"], m["most"], m["count"]] for m in sorted(found, key=lambda m: not m["what"].startswith("find"))])
    for line in text:
        if line.startswith("of OMPL's paths") or " found, " in line and "straight" in line:
            said = line.split("; work")[0]
            document.paragraph(said[0].upper() + said[1:] + ".")
    for package in ("ompl", "vamp-planner"):
        module = {"ompl": "ompl", "vamp-planner": "vamp"}[package]
        if not _has(context.others.get("python"), module):
            _said_missing(context, document, package)
    if _has(context.others.get("python"), "ompl"):
        document.paragraph("OMPL 2.0.1's package installs; it has neither headers to build with nor VAMP, and asking our predicate through Python would measure Python. It is not timed.")
