#!/usr/bin/env python3
"""Solves the example examples/pybullet/kuka of PDDLStream once and writes its plan, motions and user CPU time.

theirs.py PDDLSTREAM ROBOT.urdf OUT.json [--seed S] [--algorithm NAME]. Run by compare.py, with a Python that has pybullet.
World, streams and planner are theirs, as they are; only the random numbers are seeded, and the robot's file is given.
"""
import argparse
import collections
import collections.abc
import contextlib
import json
import os
import pathlib
import random
import resource
import sys
import tempfile

# The example was written for Pythons whose `collections` had these.
for name in ("MutableSet", "Mapping", "Sequence", "Iterable", "Callable"):
    if not hasattr(collections, name):
        setattr(collections, name, getattr(collections.abc, name))


def user_seconds():
    """Of this process and of Fast Downward, which it runs."""
    return sum(resource.getrusage(who).ru_utime for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def pose_json(pose):
    return {"position": list(pose[0]), "quaternion_xyzw": list(pose[1])}


def motions_of(command, names):
    """Each path with what is held on it."""
    out = []
    for part in command.body_paths:
        if hasattr(part, "path"):
            held = [{"object": names[g.body], "link": "iiwa_link_ee_kuka", **pose_json(g.grasp_pose)} for g in part.attachments]
            out.append({"path": [list(q) for q in part.path], "held": held})
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("pddlstream", type=pathlib.Path)
    parser.add_argument("robot", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--algorithm", default="adaptive")
    parser.add_argument("--both", action="store_true", help="both blocks are to be cooked, not the one of the example")
    parser.add_argument("--max-time", type=float, default=120)
    o = parser.parse_args()
    robot_file, out = str(o.robot.resolve()), o.out.resolve()
    sys.path.insert(0, str(o.pddlstream.resolve()))
    sys.argv = sys.argv[:1]
    os.chdir(tempfile.mkdtemp(prefix="pddlstream-"))  # it leaves files where it runs

    import numpy
    import examples.pybullet.kuka.run as kuka
    from examples.pybullet.utils.pybullet_tools import utils

    random.seed(o.seed)
    numpy.random.seed(o.seed)
    utils.connect(use_gui=False)
    kuka.DRAKE_IIWA_URDF = robot_file
    with open(os.devnull, "w", encoding="utf-8") as nowhere, contextlib.redirect_stdout(nowhere):
        robot, names, movable = kuka.load_world()
        problem = kuka.pddlstream_from_problem(robot, movable=movable)
        if o.both:
            problem = problem._replace(goal=(*problem.goal, ("Cooked", movable[1])))
        objects = {names[b]: pose_json(utils.get_pose(b)) for b in movable}
        before = user_seconds()
        plan, _, _ = kuka.solve(problem, algorithm=o.algorithm, unit_costs=False, success_cost=kuka.INF, max_time=o.max_time)
        seconds = user_seconds() - before
    result = {"seed": o.seed, "algorithm": o.algorithm, "solved": plan is not None, "user_s": seconds, "process_s": user_seconds()}
    if plan is not None:
        command = kuka.postprocess_plan(plan)
        result.update(actions=[a.name for a in plan], objects=objects, motions=motions_of(command, names))
    out.write_text(json.dumps(result))


main()
