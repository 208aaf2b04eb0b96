#!/usr/bin/env python3
"""Queries for paths beside VAMP's: the same starts and goals, paths judged by exact meshes.

  benchmarks/planner_peers.py BUILD RESOURCES FOLDER [--robots panda,ur5,fetch] [--problems N] [--scenes N] [--repeats N]

BUILD has bin/kaboum-scene and benchmarks/path-query-benchmark; RESOURCES is VAMP's folder of that name (robots, and the
problems of MotionBenchMaker as problems.tar.bz2). The Python that runs this has vamp-planner, NumPy and PyYAML. FOLDER
keeps scenes and answers. Times are CPU time of one thread, the least of so many repeats, of the query alone: scenes are built
before, which is said besides. A table of each robot, the columns that are worse for this project first.
"""
import argparse
import json
import pathlib
import re
import subprocess
import tarfile
import time
import xml.etree.ElementTree as xml

import numpy
import yaml

import batch_scenes

try:
    import vamp
except ImportError:
    vamp = None  # judged_batches.py does without

ROBOTS = {
    # name: joints that a problem states and that stand still, pairs of links that touch by their shapes
    "panda": {"panda_finger_joint1": 0.065, "panda_finger_joint2": 0.065},
    "ur5": {},
    "fetch": {},
}
# Joints that VAMP moves.
JOINTS = {
    "panda": [f"panda_joint{i}" for i in range(1, 8)],
    "ur5": ["shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint", "wrist_3_joint"],
    "fetch": ["torso_lift_joint", "shoulder_pan_joint", "shoulder_lift_joint", "upperarm_roll_joint", "elbow_flex_joint",
              "forearm_roll_joint", "wrist_flex_joint", "wrist_roll_joint"],
}
# How high above the frame's origin the first joint is, in the scenes of batch_scenes.py, as in VAMP's own tests.
LIFTS = {"panda": 0.0, "ur5": 0.91, "fetch": 0.4}
# Pairs of links whose sets touch nearly everywhere, as in batch_scenes.py.
ALLOWED = {"panda": [["panda_link5", "panda_link7"]], "ur5": [], "fetch": []}
EPSILON = "5mm"


def with_fixed_joints(source, target, moving, values):
    """A copy of a URDF in which all other joints stand still, with its meshes named where they are."""
    tree = xml.parse(source)
    for joint in tree.getroot().iter("joint"):
        if joint.get("type") is None or joint.get("type") == "fixed" or joint.get("name") in moving:
            continue
        value, origin, axis = values.get(joint.get("name"), 0.0), joint.find("origin"), joint.find("axis")
        if value and joint.get("type") == "prismatic":
            if origin is None:
                origin = xml.SubElement(joint, "origin", xyz="0 0 0", rpy="0 0 0")
            if any(float(a) for a in origin.get("rpy", "0 0 0").split()):
                raise SystemExit(f"{joint.get('name')}: a slide in a turned frame")
            at = [float(a) for a in origin.get("xyz", "0 0 0").split()]
            along = [float(a) for a in axis.get("xyz").split()]
            origin.set("xyz", " ".join(repr(a + value * b) for a, b in zip(at, along)))
        elif value:
            raise SystemExit(f"{joint.get('name')}: cannot be fixed there")
        joint.set("type", "fixed")
        for child in list(joint):
            if child.tag in ("limit", "mimic", "axis", "dynamics", "safety_controller", "calibration"):
                joint.remove(child)
    for mesh in tree.getroot().iter("mesh"):
        name = mesh.get("filename").replace("package://", "")
        mesh.set("filename", str((source.parent / name).resolve()))
    for element in tree.getroot().iter("link"):
        for visual in element.findall("visual"):
            element.remove(visual)
    tree.write(target)


def robot_scene(args, name):
    """The scene of a robot alone, with what an SRDF allows and pairs proved apart; its URDF."""
    folder = args.folder / name
    folder.mkdir(parents=True, exist_ok=True)
    source, urdf, scene = args.resources / name / f"{name}.urdf", folder / f"{name}.urdf", folder / "robot.json"
    if scene.exists():
        return scene, urdf
    with_fixed_joints(source, urdf, JOINTS[name], ROBOTS[name])
    program = args.build / "bin/kaboum-scene"
    subprocess.run([program, "make", scene, "--robot", f"{name}={urdf}", "--epsilon", EPSILON, "--effort", "fast", "--quiet"], check=True)
    made = json.loads(scene.read_text())
    links = {link.get("name") for link in xml.parse(urdf).getroot().iter("link") if link.find("collision") is not None}
    allowed = [[p.get("link1"), p.get("link2")] for p in xml.parse(args.resources / name / f"{name}.srdf").getroot().iter("disable_collisions")]
    made["robots"][0]["allowed_contacts"] = [p for p in allowed + ALLOWED[name] if set(p) <= links]
    scene.write_text(json.dumps(made, indent=1))
    said = subprocess.run([program, "pairs", scene], check=True, capture_output=True, text=True).stdout
    for text in said.splitlines():
        if '{"proved_for' in text:
            made["robots"][0]["never_in_contact"] = json.loads(text[text.index('{"proved_for'):])
    scene.write_text(json.dumps(made, indent=1))
    return scene, urdf


def matrix(pose):
    x, y, z, w = (numpy.array(pose["orientation"]) / numpy.linalg.norm(pose["orientation"])).tolist()
    out = numpy.eye(4)
    out[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                   [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                   [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    out[:3, 3] = pose["position"]
    return out


def quaternion(m):
    k = numpy.array([[m[0, 0] - m[1, 1] - m[2, 2], 0, 0, 0], [m[0, 1] + m[1, 0], m[1, 1] - m[0, 0] - m[2, 2], 0, 0],
                     [m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], m[2, 2] - m[0, 0] - m[1, 1], 0],
                     [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], m[0, 0] + m[1, 1] + m[2, 2]]]) / 3
    values, vectors = numpy.linalg.eigh(k)
    return vectors[:, -1].tolist()  # x, y, z, w


def euler_xyz(m):
    """Fixed axes x, y, z, as VAMP's shapes take it."""
    pitch = numpy.arcsin(-numpy.clip(m[2, 0], -1, 1))
    return [float(numpy.arctan2(m[2, 1], m[2, 2])), float(pitch), float(numpy.arctan2(m[1, 0], m[0, 0]))]


def object_of(name, m, shape):
    return {"name": name, "position": m[:3, 3].tolist(), "quaternion": quaternion(m), "euler": euler_xyz(m), "shape": shape}


def objects_of(scene):
    """Those of a scene of MotionBenchMaker."""
    out = []
    for thing in scene["world"]["collision_objects"]:
        primitive = thing["primitives"][0]
        m = matrix(thing["pose"]) if "pose" in thing else numpy.eye(4)
        m = m @ matrix(thing["primitive_poses"][0])
        size = primitive["dimensions"]
        shape = {"box": lambda: {"box": {"size": size}}, "sphere": lambda: {"sphere": {"radius": size[0]}},
                 "cylinder": lambda: {"cylinder": {"radius": size[1], "length": size[0]}}}[primitive["type"]]()
        out.append(object_of(thing["id"], m, shape))
    return out


def pose_matrix(pose):
    """Of a position and fixed-axis angles."""
    r, p, y = pose.get("rpy", (0, 0, 0))
    cr, sr, cp, sp, cy, sy = numpy.cos(r), numpy.sin(r), numpy.cos(p), numpy.sin(p), numpy.cos(y), numpy.sin(y)
    m = numpy.eye(4)
    m[:3, :3] = [[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                 [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr], [-sp, cp * sr, cp * cr]]
    m[:3, 3] = pose["position"]
    return m


def within_limits(values, name, resources):
    """Values of joints; those that are beyond a limit by less than 1e-5 are at it. The Fetch has ±3.14159 where problems have ±π."""
    limits = {joint.get("name"): joint.find("limit") for joint in xml.parse(resources / name / f"{name}.urdf").getroot().iter("joint")}
    out = []
    for joint, value in zip(JOINTS[name], values):
        low, high = float(limits[joint].get("lower")), float(limits[joint].get("upper"))
        nearest = min(max(value, low), high)
        out.append(nearest if abs(nearest - value) < 1e-5 else value)
    return out


def benchmark_problems(args, name):
    """The problems of MotionBenchMaker that come with VAMP, some of each kind."""
    files = {}
    with tarfile.open(args.resources / name / "problems.tar.bz2", "r:bz2") as tar:
        for member in tar.getmembers():
            found = re.fullmatch(r"problems/(\w+)_%s/(scene|request)(\d+)\.yaml" % name, member.name)
            if found and int(found[3]) <= args.problems:
                files[found[1], int(found[3]), found[2]] = yaml.load(tar.extractfile(member).read(), Loader=getattr(yaml, "CLoader", yaml.Loader))
    joints = JOINTS[name]
    out = []
    for kind, index in sorted({(k, i) for k, i, _ in files}):
        if (kind, index, "request") not in files or (kind, index, "scene") not in files:
            continue
        objects, request = objects_of(files[kind, index, "scene"]), files[kind, index, "request"]
        state = request["start_state"]["joint_state"]
        stated = dict(zip(state["name"], state["position"]))
        goal = {c["joint_name"]: c["position"] for c in request["goal_constraints"][0]["joint_constraints"]}
        out.append({"problem": kind, "index": index, "objects": objects, "start": within_limits([stated[j] for j in joints], name, args.resources),
                    "goal": within_limits([goal[j] for j in joints], name, args.resources)})
    return out


def lifted_scenes(name):
    """Name and objects of each of the scenes of batch_scenes.py."""
    for scene, things in batch_scenes.scenes().items():
        objects = []
        for thing in things:
            m = pose_matrix(thing["pose"])
            m[2, 3] += LIFTS[name]
            objects.append(object_of(thing["name"], m, thing["shape"]))
        yield scene, objects


def first_scenes(resources, name):
    """Name and objects of the scenes of batch_scenes.py, and of the first of each kind of MotionBenchMaker's."""
    yield from lifted_scenes(name)
    with tarfile.open(resources / name / "problems.tar.bz2", "r:bz2") as tar:
        for member in tar.getmembers():
            found = re.fullmatch(r"problems/(\w+)_%s/scene0*1\.yaml" % name, member.name)
            if found:
                yield found[1], objects_of(yaml.load(tar.extractfile(member).read(), Loader=getattr(yaml, "CLoader", yaml.Loader)))


def scene_problems(args, name):
    """Pairs of configurations drawn at random in the scenes of batch_scenes.py that VAMP says are free."""
    robot, out = getattr(vamp, name), []
    low, high = numpy.array(robot.lower_bounds()), numpy.array(robot.upper_bounds())
    random = numpy.random.default_rng(1)
    for scene, objects in lifted_scenes(name):
        environment = vamp_environment({"problem": scene, "objects": objects})
        free = []
        while len(free) < 2 * args.scenes:
            q = (low + (high - low) * random.random(len(low))).astype(numpy.float32).astype(float)
            q = numpy.clip(q, low.astype(float), high.astype(float))
            if robot.validate(q.tolist(), environment):
                free.append(q.tolist())
        out += [{"problem": scene, "index": i, "objects": objects, "start": free[2 * i], "goal": free[2 * i + 1]} for i in range(args.scenes)]
    return out


def vamp_environment(problem):
    """As VAMP's own problem_dict_to_vamp."""
    environment = vamp.Environment()
    for thing in problem["objects"]:
        (kind, size), = thing["shape"].items()
        if kind == "sphere":
            environment.add_sphere(vamp.Sphere(thing["position"], size["radius"]))
        elif kind == "box":
            environment.add_cuboid(vamp.Cuboid(thing["position"], thing["euler"], [0.5 * a for a in size["size"]]))
        elif problem["problem"] == "box":
            environment.add_cuboid(vamp.Cuboid(thing["position"], thing["euler"], [size["radius"], size["radius"], size["length"] / 2]))
        else:
            environment.add_capsule(vamp.Cylinder(thing["position"], thing["euler"], size["radius"], size["length"]))
    return environment


def by_vamp(name, problems, repeats):
    robot, planner, settings, simplification = vamp.configure_robot_and_planner_with_kwargs(name, "rrtc")
    settings.max_iterations = settings.max_samples = 100000
    out = []
    for problem in problems:
        environment = vamp_environment(problem)
        best = None
        for _ in range(repeats):
            random, start = robot.halton(), time.process_time_ns()
            found = planner(problem["start"], [problem["goal"]], environment, settings, random)
            seconds, path = found.nanoseconds * 1e-9, []
            if found.solved:
                simple = robot.simplify(found.path, environment, simplification, random)
                seconds += simple.nanoseconds * 1e-9
                path = simple.path.numpy().astype(float).tolist()
            seconds = min(seconds, 1e-9 * (time.process_time_ns() - start))  # its own is of the clock on the wall
            best = seconds if best is None else min(best, seconds)
        refused = not robot.validate(problem["start"], environment) or not robot.validate(problem["goal"], environment)
        out.append({"outcome": "found" if path else "end in contact" if refused else "not found", "seconds": best, "path": path})
    return out


def length(path):
    rows = numpy.array(path)
    return float(numpy.linalg.norm(numpy.diff(rows, axis=0), axis=1).sum()) if len(rows) > 1 else 0.0


def judged(args, scene, urdf, folder, who, answers):
    (folder / f"{who}.paths").write_text("".join(json.dumps(a["path"]) + "\n" for a in answers))
    subprocess.run([args.build / "benchmarks/path-query-benchmark", "judge", scene, urdf, folder / "problems", folder / f"{who}.paths",
                    folder / f"{who}.verdicts", str(args.step)], check=True)
    return [json.loads(line) for line in (folder / f"{who}.verdicts").read_text().splitlines()]


def table(title, rows):
    print(f"\n{title}\n")
    print("| problems | by | median [µs] | 95 % [µs] | found | ends refused | not found | length | paths in contact by exact meshes | samples in contact |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for row in rows:
        print("| " + " | ".join(row) + " |")


def summary(problem, who, answers, verdicts, both):
    found = [i for i, a in enumerate(answers) if a["outcome"] == "found"]
    times = sorted(1e6 * answers[i]["seconds"] for i in found)
    refused = sum("contact" in a["outcome"] or "limits" in a["outcome"] for a in answers)
    touching = [i for i in found if verdicts[i]["contacts"]]
    at = lambda share: f"{times[min(len(times) - 1, int(share * len(times)))]:.0f}" if times else "–"
    mean = numpy.mean([length(answers[i]["path"]) for i in both]) if both else 0
    return [problem, who, at(0.5), at(0.95), f"{len(found)} of {len(answers)}", str(refused), str(len(answers) - len(found) - refused),
            f"{mean:.2f}", str(len(touching)), f"{sum(v['contacts'] for v in verdicts)} of {sum(v['samples'] for v in verdicts)}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("resources", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--robots", default="panda,ur5,fetch")
    parser.add_argument("--problems", type=int, default=100, help="of each kind of MotionBenchMaker's")
    parser.add_argument("--scenes", type=int, default=100, help="queries in each scene of batch_scenes.py")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--step", type=float, default=0.01, help="between samples that the exact meshes judge [rad]; 0: they are left out")
    parser.add_argument("--nodes", type=int, default=2000, help="of a roadmap of each scene of batch_scenes.py; 0: none")
    args = parser.parse_args()
    args.build, args.folder = args.build.resolve(), args.folder.resolve()
    for name in args.robots.split(","):
        compare(args, name)


def by_kaboum(args, scene, problems, answers, nodes):
    subprocess.run([args.build / "benchmarks/path-query-benchmark", "plan", scene, problems, answers, str(args.repeats), str(nodes)], check=True)
    return [json.loads(line) for line in answers.read_text().splitlines()]


def compare(args, name):
    scene, urdf = robot_scene(args, name)
    drawn = scene_problems(args, name)
    problems = benchmark_problems(args, name) + drawn
    folder = args.folder / name
    write = lambda file, some: (folder / file).write_text("".join(json.dumps(p) + "\n" for p in some))
    write("problems", problems)
    write("drawn", drawn)
    answers = {"KABouM": by_kaboum(args, scene, folder / "problems", folder / "answers", 0), "VAMP": by_vamp(name, problems, args.repeats)}
    if args.nodes:
        mapped = by_kaboum(args, scene, folder / "drawn", folder / "mapped", args.nodes)
        answers["KABouM, roadmap"] = [None] * (len(problems) - len(drawn)) + mapped
        print(f"\n{name}: a roadmap of {args.nodes} nodes takes {numpy.median([a['setup'] for a in mapped]):.1f} s")
    print(f"{name}: a scene's checker takes {1e3 * numpy.median([a['setup'] for a in answers['KABouM']]):.0f} ms")
    nothing = [{"contacts": 0, "samples": 0}] * len(problems)
    verdicts = {who: nothing if not args.step else judged(args, scene, urdf, folder, who.split()[-1].lower(), [a or {"path": []} for a in some])
                for who, some in answers.items()}
    rows = []
    for kind in list(dict.fromkeys(p["problem"] for p in problems)) + ["all"]:
        some = [i for i, p in enumerate(problems) if kind in (p["problem"], "all")]
        by = {who: [of[i] for i in some] for who, of in answers.items() if all(of[i] for i in some)}
        both = [k for k in range(len(some)) if all(of[k]["outcome"] == "found" for of in by.values())]
        for who, of in by.items():
            rows.append(summary(kind, who, of, [verdicts[who][i] for i in some], both))
    table(name, rows)


if __name__ == "__main__":
    main()
