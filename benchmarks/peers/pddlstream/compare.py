#!/usr/bin/env python3
"""PDDLStream's example pybullet/kuka and the same kitchen planned by kaboum-plan, side by side.

compare.py --pddlstream DIR --python PYTHON [--bin DIR] [--seeds 12] [--out DIR]. DIR is a checkout of
github.com/caelan/pddlstream with its submodules and a built Fast Downward; PYTHON has pybullet, numpy, scipy, trimesh
and python-fcl. Prints a Markdown table. Without a checkout it says so and ends with code 0.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--pddlstream", type=pathlib.Path, help="checkout, with examples/pybullet/utils and a built downward")
    parser.add_argument("--python", default=sys.executable, help="a Python with pybullet, numpy, scipy, trimesh and python-fcl")
    parser.add_argument("--bin", type=pathlib.Path, default=HERE.parents[2] / "build/release/bin", help="folder of kaboum-plan and kaboum-scene")
    parser.add_argument("--seeds", type=int, default=12)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("peer-pddlstream"), help="folder of all results")
    return parser.parse_args()


def ours(o, scene, seed, both):
    name = f"ours-both-{seed}" if both else f"ours-{seed}"
    plan, report = o.out / f"{name}.plan.json", o.out / f"{name}.json"
    files = [HERE / "domain.kpl", HERE / ("problem-both.kpl" if both else "problem.kpl"), "--scene", scene]
    code = subprocess.run([o.bin / "kaboum-plan", "solve", *files, "--seed", str(seed), "--no-cache", "--quiet", "-o", plan,
                           "--report", report], check=False).returncode
    if code != 0:
        return {"solved": False}
    found = json.loads(report.read_text())
    subprocess.run([o.bin / "kaboum-plan", "check", *files, "--plan", plan, "--quiet"], check=True)
    run = o.out / f"{name}.run.json"
    subprocess.run([o.bin / "kaboum-plan", "run", *files, "--plan", plan, "--quiet", "--report", run], check=False)
    executed = json.loads(run.read_text())
    motions, actions = [], 0
    for node in json.loads(plan.read_text())["nodes"]:
        if "action" in node:
            actions += 1
        for call in node.get("calls", []):
            for m in json.loads(call.get("payload") or "[]"):
                motions.append({"path": m["path"], "held": list(m.get("holds", {}))})
    return {"solved": True, "user_s": found["resources"]["user_seconds_searching"], "process_s": found["resources"]["user_seconds"], "actions": actions, "motions": motions,
            "executed": [executed["samples"], executed["collisions"]]}


def theirs(o, robot, name, seed, both):
    file = o.out / f"{name}{'-both' if both else ''}-{seed}.json"
    file.unlink(missing_ok=True)
    subprocess.run([o.python, HERE / "theirs.py", o.pddlstream, robot, file, "--seed", str(seed), *(["--both"] if both else [])], check=False,
                   env={**os.environ, "PYTHONHASHSEED": str(seed)}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    found = json.loads(file.read_text()) if file.exists() else {"solved": False}
    if found["solved"]:
        found["actions"] = len(found["actions"])
        for m in found["motions"]:
            m["held"] = [h["object"] for h in m["held"]]
    return found


def row(name, found):
    solved = [f for f in found if f["solved"]]
    if not solved:
        return f"| {name} | 0 of {len(found)} | | | | | | |"
    mean = lambda key: statistics.fmean(key(f) for f in solved)
    seconds = [f["user_s"] for f in solved]
    colliding = [f for f in solved if f["contact"]]
    return (f"| {name} | {len(solved)} of {len(found)} | {statistics.fmean(seconds):.3f} ± {statistics.stdev(seconds) if len(seconds) > 1 else 0:.3f} | "
            f"{mean(lambda f: f['process_s']):.2f} | "
            f"{mean(lambda f: f['actions']):.1f} | {mean(lambda f: f['way']):.1f} | {len(colliding)} of {len(solved)} "
            f"({sum(f['contact'] for f in solved)} of {sum(f['samples'] for f in solved)} samples) | "
            f"{sum(1 for f in solved if f['deep'])} of {len(solved)} ({sum(f['deep'] for f in solved)} samples) |")


def main():
    o = arguments()
    if o.pddlstream is None or not (o.pddlstream / "pddlstream").is_dir():
        print("PDDLStream: left out; --pddlstream DIR takes a checkout of https://github.com/caelan/pddlstream")
        return 0
    o.out, o.pddlstream = o.out.resolve(), o.pddlstream.resolve()
    if os.path.abspath(o.python) != os.path.abspath(sys.executable) and "KABOUM_PEER" not in os.environ:
        os.environ["KABOUM_PEER"] = "1"  # judging needs the other Python's modules, too
        os.execv(o.python, [o.python, *sys.argv])
    import judge
    import numpy
    import scene

    file = scene.make(o.pddlstream, o.out, o.bin / "kaboum-scene")
    scene.robot_with_links(o.pddlstream, o.out / "iiwa14-moving-links.urdf", base=False)
    world = json.loads(file.read_text())
    boxes = {t["name"]: t["shape"]["box"]["size"] for t in world["objects"]}
    poses = {t["name"]: judge.frame(t["pose"]["position"]) for t in world["objects"]}
    arm = judge.Arm(o.out / "iiwa14.urdf")
    seeds = range(1, o.seeds + 1)
    print("| | solved | planning, user s | whole process | actions | way [rad] | plans in contact | deeper than 1 mm |\n"
          "|---|---|---|---|---|---|---|---|")
    everything = {}
    for both in (False, True):
        blocks = "both blocks" if both else "one block"
        results = {f"{blocks}: ours, all links, at every instant": [ours(o, file, s, both) for s in seeds],
                   f"{blocks}: PDDLStream as it is, last link only": [theirs(o, o.pddlstream / scene.ROBOT, "theirs", s, both) for s in seeds],
                   f"{blocks}: PDDLStream, all moving links": [theirs(o, o.out / "iiwa14-moving-links.urdf", "theirs-links", s, both) for s in seeds]}
        for name, found in results.items():
            for f in (f for f in found if f["solved"]):
                f["way"] = sum(numpy.abs(numpy.diff(numpy.array(m["path"]), axis=0)).max(axis=1).sum() for m in f["motions"])
                f["samples"], f["contact"], f["pairs"], _ = judge.judged(arm, boxes, poses, f["motions"])
                f["deep"] = judge.judged(arm, boxes, poses, f.pop("motions"), smaller=0.001)[1]
            print(row(name, found), flush=True)
        everything.update(results)
    for name, found in everything.items():
        met = sorted({tuple(p) for f in found if f["solved"] for p in f["pairs"]})
        print(f"\n{name}, in contact: " + (", ".join(f"{a} and {b}" for a, b in met) or "nothing"))
    mine = [f for name, found in everything.items() if "ours" in name for f in found]
    executed = [f["executed"] for f in mine if f["solved"]]
    print(f"\nkaboum-plan run, ours: {sum(e[0] for e in executed)} samples, {sum(e[1] for e in executed)} in contact")
    (o.out / "results.json").write_text(json.dumps(everything, indent=1))
    return 0 if all(f["solved"] and not f["contact"] for f in mine) else 1


sys.exit(main())
