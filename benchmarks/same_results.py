#!/usr/bin/env python3
"""Runs the same commands with the programs of two builds and compares every byte that they write.

  same_results.py OLD NEW [--instructions] [--match REGEX]

OLD and NEW are folders of programs (build/release/bin of two checkouts). Outputs, exit codes and what
is printed have to be equal, times and resources of JSON reports apart. --instructions counts them as
well (valgrind --tool=callgrind, slow) and prints the ratio of each run. Meshes of $KABOUM_MESHES are
used where it is set. Exits with 1 when anything differs.
"""
import argparse
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
ARM = """<robot name="arm">
<link name="base"><collision><geometry><box size="0.4 0.4 0.2"/></geometry></collision></link>
<link name="upper"><collision><origin xyz="0 0 0.2"/><geometry><mesh filename="bracket.obj"/></geometry></collision></link>
<link name="lower"><collision><geometry><cylinder radius="0.05" length="0.3"/></geometry></collision></link>
<joint name="a" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.1" rpy="0.1 0 0.2"/>
<axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
<joint name="b" type="prismatic"><parent link="upper"/><child link="lower"/><origin xyz="0 0 0.4"/>
<axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>
"""
MOTION = "a,b\n0,0\n0.8,0.2\n1.5,-0.3\n"
RUNS = """
bmesh-decimate bracket.obj -o outer.stl --ratio 0.1 --report outer.json
bmesh-decimate bracket.obj -o inner.ply --direction inner --epsilon 1% --log inner.log
bmesh-decimate bracket.obj -o planes.off --ratio 0.1 --cost planes --effort fast --verify
bmesh-decimate bracket.obj --vertices 400,200,100 -o level-{vertices}.stl --progressive level.pm
bmesh-decimate --from level.pm --vertices 150 -o level-150.stl
bmesh-replay bracket.obj inner.log inner.ply
bound-verify mesh --outer bracket.obj outer.stl --report verdict.json
bound-verify mesh --inner bracket.obj inner.ply
bound-verify mesh --outer bracket.obj inner.ply
bound-verify progressive bracket.obj level.pm
bcd-decompose bracket.obj -o cover.glb --no-cache --epsilon 2% --report cover.json
bcd-decompose bracket.obj -o fast.obj --no-cache --epsilon 1% --effort fast
bcd-decompose bracket.obj -o budget.glb --no-cache --max-bodies 8
bcd-decompose bracket.obj -o inside.glb --no-cache --epsilon 3% --direction inner
bound-verify cover bracket.obj cover.glb --epsilon 2.1%
bound-verify cover bracket.obj inside.glb
bcd-decompose arm.urdf -o safe-arm --no-cache --epsilon 2%
bound-verify robot arm.urdf safe-arm/arm.urdf
sweep-approx arm.urdf --path motion.csv -o swept.glb --epsilon 0.01 --report swept.json
bound-verify sweep arm.urdf motion.csv swept.glb
hausdorff-eval bracket.obj outer.stl --report distance.json
hausdorff-eval bracket.obj outer.stl --solid
kaboum-plan solve stacked.kpl problem.kpl --search astar -o plan.json
kaboum-plan check stacked.kpl problem.kpl --plan plan.json
kaboum-plan show stacked.kpl problem.kpl --plan plan.json -o plan.svg
"""
REAL = {
    "robots/ur5-description/meshes/ur5/collision/forearm.stl": "forearm.stl",
    "thesis-parts/spool.off": "spool.off",
}
REAL_RUNS = """
bmesh-decimate forearm.stl -o forearm-outer.stl --epsilon 1%
bcd-decompose forearm.stl -o forearm.glb --no-cache --epsilon 1% --effort fast
bound-verify cover forearm.stl forearm.glb --prepare
"""
VOLATILE = re.compile(r"second|time|resource|cpu|memory|mega|_s$|rss|threads|version|tool")


def without_times(value):
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if not VOLATILE.search(k)}
    return [without_times(v) for v in value] if isinstance(value, list) else value


def digest(path, folder):
    data = path.read_bytes().replace(str(folder).encode(), b"")
    if path.suffix == ".json":
        data = json.dumps(without_times(json.loads(data)), sort_keys=True).encode()
    return hashlib.sha256(data).hexdigest()


def printed(text, folder):
    """Without durations, amounts of memory and the folder's name."""
    text = re.sub(r"\d+(\.\d+)? ?(ms|s|MB|GB|min)\b", "#", text.replace(str(folder), ""))
    return "\n".join(line.split("\r")[-1] for line in text.splitlines())


def prepare(folder):
    (folder / "bracket.obj").write_bytes((ROOT / "meshes/bracket.obj").read_bytes())
    (folder / "arm.urdf").write_text(ARM)
    (folder / "motion.csv").write_text(MOTION)
    domain = ROOT / "examples/domains/stacked"
    (folder / "stacked.kpl").write_bytes((domain / "domain.kpl").read_bytes())
    (folder / "problem.kpl").write_bytes(subprocess.run([domain / "make-problem", "6"], check=True,
                                                        capture_output=True).stdout)
    runs = RUNS
    meshes = os.environ.get("KABOUM_MESHES")
    if meshes and all((pathlib.Path(meshes) / name).exists() for name in list(REAL)[:1]):
        for name, local in REAL.items():
            if (pathlib.Path(meshes) / name).exists():
                (folder / local).write_bytes((pathlib.Path(meshes) / name).read_bytes())
        runs += REAL_RUNS
    return [line.split() for line in runs.splitlines() if line]


def run(tools, command, folder, count):
    words = [str(tools / command[0]), *command[1:]]
    if count:
        words = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/callgrind.out", *words]
    environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "TBB_NUM_THREADS": "1"}
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, errors="replace",
                          env=environment, check=False)
    instructions = 0
    if count:
        out = folder / "callgrind.out"
        found = re.search(r"^(?:summary|totals): (\d+)", out.read_text(), re.M)
        instructions = int(found.group(1)) if found else 0
        out.unlink()
    error = "\n".join(line for line in done.stderr.splitlines() if not line.startswith("=="))
    return (done.returncode, printed(done.stdout, folder), printed(error, folder)), instructions


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=pathlib.Path)
    parser.add_argument("new", type=pathlib.Path)
    parser.add_argument("--instructions", action="store_true", help="count them with callgrind")
    parser.add_argument("--match", default="", help="only compare runs that hold this expression")
    options = parser.parse_args()
    differences, known = 0, set()
    with tempfile.TemporaryDirectory() as top:
        sides = [(pathlib.Path(tools).resolve(), pathlib.Path(top) / name)
                 for tools, name in ((options.old, "old"), (options.new, "new"))]
        for _, folder in sides:
            folder.mkdir()
            commands = prepare(folder)
        for command in commands:
            wanted = re.search(options.match, " ".join(command)) is not None
            results = [run(tools, command, folder, options.instructions and wanted)
                       for tools, folder in sides]
            files = [{p.relative_to(folder): digest(p, folder) for p in folder.rglob("*") if p.is_file()}
                     for _, folder in sides]
            what = []
            if results[0][0][0] != results[1][0][0]:
                what.append(f"exit code {results[0][0][0]} -> {results[1][0][0]}")
            what += [name for name, i in (("output", 1), ("messages", 2))
                     if results[0][0][i] != results[1][0][i]]
            changed = {str(name) for name in files[0].keys() | files[1].keys()
                       if files[0].get(name) != files[1].get(name)}
            what += sorted(changed - known)
            known |= changed
            ratio = ""
            if options.instructions and wanted and results[0][1]:
                ratio = f"  {results[1][1] / results[0][1]:.3f} of the instructions"
            print(("same   " if not what else "DIFFERS") + f" [{results[1][0][0]}] {' '.join(command)}{ratio}"
                  + (": " + ", ".join(what) if what else ""), flush=True)
            differences += bool(what)
    print(f"{len(commands)} runs, {differences} differ")
    return 1 if differences else 0


sys.exit(main())
