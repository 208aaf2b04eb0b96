"""What all scenarios do: make the scene, plan, check, execute every branch among the exact meshes, draw.

Each has NAME/run [N] [--seed S] [--out DIR]; the last line that is printed is one JSON object.
"""
import argparse
import json
import math
import os
import pathlib
import random
import resource
import shlex
import subprocess
import sys
import time

import parts

HERE = pathlib.Path(__file__).resolve().parent
DOWN = 3.141592653589793  # a tool that points down


def tool(name):
    """A program: in $KABOUM_BIN, in the build folder of the checkout, or on PATH."""
    for folder in (os.environ.get("KABOUM_BIN"), HERE.parent.parent / "build/release/bin"):
        if folder and (pathlib.Path(folder) / name).exists():
            return str(pathlib.Path(folder).resolve() / name)
    return name


class Cell:
    """A scene as it grows; `make` writes it."""

    def __init__(self, epsilon="0.002"):
        self.robots, self.objects, self.meshes, self.shapes = {}, {}, {}, {}
        self.files = {}  # of robots that are not made here
        self.epsilon = epsilon
        self.allowed, self.regions, self.constraints = [], [], []

    def robot(self, name, made, home, base=(0, 0, 0), yaw=0.0, tool_name="hand", features=(), grippers=()):
        urdf, meshes, along = made
        self.meshes.update({file: mesh.off() for file, mesh in meshes.items()})
        self.meshes[f"{name}.urdf"] = urdf
        self.robots[name] = {"base": {"position": list(base), "rpy": [0, 0, yaw]}, "home": home,
                             "tools": [{"name": tool_name, "link": "hand", "position": [0, 0, along]}], "features": list(features), "grippers": list(grippers)}

    def real_robot(self, name, file, tool, home, base=(0, 0, 0), yaw=0.0):
        """Of a URDF elsewhere; `tool`: as in a scene."""
        self.files[name] = str(file)
        self.robots[name] = {"base": {"position": list(base), "rpy": [0, 0, yaw]}, "home": home, "tools": [tool]}

    def object(self, name, shape, mesh, position, features=(), grasps=(), rpy=(0, 0, 0)):
        """`shape` is the mesh's file; things of one shape share it."""
        self.meshes[f"{shape}.off"] = mesh.off()
        self.shapes[name] = f"{shape}.off"
        self.objects[name] = {"pose": {"position": list(position), "rpy": list(rpy)}, "features": list(features), "grasps": list(grasps)}

    def region(self, name, size, position):
        """A box that things may be asked to lie in."""
        self.regions.append({"name": name, "pose": {"position": list(position)}, "shape": {"box": {"size": list(size)}}})

    def make(self, folder):
        folder.mkdir(parents=True, exist_ok=True)
        for file, text in self.meshes.items():
            (folder / file).write_text(text)
        command = [tool("kaboum-scene"), "make", "cell.json", "--force", "--quiet", "--epsilon", self.epsilon, "--effort", "fast"]
        for name in self.robots:
            command += ["--robot", f"{name}={self.files.get(name, name + '.urdf')}"]
        for name, file in self.shapes.items():
            command += ["--object", f"{name}={file}"]
        subprocess.run(command, check=True, cwd=folder)
        cell = json.loads((folder / "cell.json").read_text())
        for robot in cell["robots"]:
            robot.update(self.robots[robot["name"]])
        for thing in cell["objects"]:
            thing.update(self.objects[thing["name"]])
        cell["allowed_contacts"] = self.allowed
        if self.regions:
            cell["regions"] = self.regions
        if self.constraints:
            cell["constraints"] = self.constraints
        (folder / "cell.json").write_text(json.dumps(cell, indent=2) + "\n")


def point(name, x, y, z):
    return {"name": name, "point": [x, y, z]}


def plane(name, at, normal):
    return {"name": name, "plane": {"point": list(at), "normal": list(normal)}}


def from_above(name, z, turns=4):
    """Grasps by a tool that points down at height z of the object, turned about the vertical."""
    return [{"name": f"{name}{k}", "position": [0, 0, z], "rpy": [DOWN, 0, 2 * DOWN * k / turns]} for k in range(turns)]


def problem(constants, facts, goal=""):
    text = "".join(f"constants: {kind} {', '.join(names)}\n" for kind, names in constants if names)
    text += "init:\n  " + ",\n  ".join(facts) + "\n"
    return text + (f"goal:\n  {goal}\n" if goal else "")


def misused(text):
    print(text, file=sys.stderr)
    sys.exit(2)


def collection():
    """The folder of the mesh collection; ends the program where there is none."""
    folder = pathlib.Path(os.environ.get("KABOUM_MESHES", ""))
    if not (folder / "robots").is_dir():
        misused("--real needs the mesh collection: set KABOUM_MESHES to its folder")
    return folder.resolve()


def options(name, n, least, most, more=lambda parser: None):
    """@param more  adds options of the scenario's own."""
    parser = argparse.ArgumentParser(description=f"Plans, checks, executes and draws the scenario {name}.")
    parser.add_argument("n", nargs="?", type=int, default=n, help=f"size, {least} to {most} [{n}]")
    parser.add_argument("--seed", type=int, default=1, help="of the planner [1]")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path(f"scenario-{name}"), help="folder of all results [scenario-%s]" % name)
    parser.add_argument("--search", default="greedy", choices=["dfs", "bfs", "ids", "greedy", "astar"], help="of the planner [greedy]")
    parser.add_argument("--timeout", type=float, default=300, help="of planning, in seconds [300]")
    parser.add_argument("--scene-only", action="store_true", help="make scene and problem, and stop")
    parser.add_argument("--plan-only", action="store_true", help="plan and check; execute and draw nothing")
    parser.add_argument("--physics", type=int, nargs="?", const=1, default=0, metavar="RUNS",
                        help="carry the plan out in MuJoCo as well, so many times; needs scripts/setup --engines [1]")
    parser.add_argument("--blend", type=float, default=0.0, metavar="SHARE", help="robots go through corners without a stop, 0 to 0.5 [0]")
    parser.add_argument("--max-jerk", type=float, metavar="J", help="of these motions [100 rad/s³]")
    parser.add_argument("--film", action="store_true", help="pictures of the first of these runs")
    parser.add_argument("--no-cache", action="store_true", help="neither take the scene's answers from earlier runs nor keep them")
    parser.add_argument("--detail", type=int, default=1, choices=range(1, 9), metavar="K", help="K² times as many triangles, 1 to 8 [1]")
    parser.add_argument("--gaps", action="store_true", help="arms whose links end before the next one begins, and never touch it")
    more(parser)
    o = parser.parse_args()
    parts.detail, parts.gaps = o.detail, o.gaps
    if o.physics < 0 or (o.film and o.physics == 0):
        parser.error("--physics takes a number of runs from 1 on, and --film needs it")
    if o.max_jerk is not None and o.blend == 0:
        parser.error("--max-jerk goes with --blend: motions from rest to rest have no limit of jerk")
    o.motions = ["--blend", str(o.blend), *([] if o.max_jerk is None else ["--max-jerk", str(o.max_jerk)])]
    if not least <= o.n <= most:
        parser.error(f"N is from {least} to {most}")
    return o


MOVE = """
externals: wander(robot) : conf

action move(?r : robot)
  preconds: let ?q = extern(wander(?r))
  effects: add(Kf, conf(?r) = ?q)
"""


def add_move(parser):
    parser.add_argument("--move", action="store_true", help="with the action move, to random waypoints (thesis, Table 6.1)")


def add_fingers(parser):
    parser.add_argument("--fingers", action="store_true", help="two fingers that close and hold by friction, not a hand that stays as it is")


def necked(o, cell, name, home, base=(0, 0, 0)):
    """An arm with a gripper for bottles: with --fingers such as close."""
    if o.fingers:
        cell.robot(name, parts.arm6(name, "fingers"), {**home, "finger": parts.OPEN}, base, grippers=[parts.FINGERS])
    else:
        cell.robot(name, parts.arm6(name, "neck"), home, base)


def of_neck(o, grasps):
    """Grasps at the neck of a bottle: fingers close a little farther than to the neck, which stops them."""
    return [{**g, "opening": {"finger": parts.NECK - 0.0005}, "within": 0.001} if o.fingers else g for g in grasps]


def domain_of(o, name):
    """The scenario's domain, with the action move where it is asked for: last, as depth-first search takes actions in order."""
    if not o.move:
        return "domain.kpl"
    file = o.out.resolve() / "domain.kpl"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text((HERE / name / "domain.kpl").read_text() + MOVE)
    return file


# Of a run in physics that counts as a success: things end so far beside [m] and below [m] the plan's places, and so much turned [rad].
# Plans keep gaps between things that rest on each other; in a stack these add up.
BESIDE, BELOW, TURNED = 0.005, 0.03, 0.1


def in_physics(o, cell, files, plan, driver_options):
    """The plan carried out by robots that MuJoCo simulates, --physics times; things begin up to a millimetre beside their places.
    @param driver_options  more options of the driver, for a source of chance"""
    root = HERE.parent.parent
    python = str(pathlib.Path(os.environ.get("KABOUM_ENGINES", root / "build/engines")) / "bin/python")
    if not pathlib.Path(python).exists() or subprocess.run([python, "-c", "import mujoco, numpy"], capture_output=True, check=False).returncode != 0:
        misused(f"--physics needs MuJoCo: run scripts/setup --engines, or set KABOUM_ENGINES to a Python environment with mujoco and numpy ({python})")
    out = o.out.resolve() / "physics"
    out.mkdir(exist_ok=True)
    decompose = [tool("bcd-decompose"), "--effort", "fast", "--quiet"]
    command = [python, str(root / "examples/drivers/physics.py"), "--scene", str(o.out.resolve() / "cell.json"), "--disturb", "0.001"]
    for name in cell.robots:
        robot = pathlib.Path(o.out.resolve() / cell.files.get(name, name + ".urdf"))
        subprocess.run([*decompose, str(robot), "-o", str(out / name), "--robot-format", "mjcf", "--epsilon", "5mm"], check=True)
        command += ["--robot", f"{name}={out / name / robot.stem}.xml"]
    for file in sorted(set(cell.shapes.values())):
        made = out / pathlib.Path(file).with_suffix(".glb")
        made.unlink(missing_ok=True)
        subprocess.run([*decompose, file, "-o", str(made), "--epsilon", "0.3%"], check=True, cwd=o.out)
    for name, file in cell.shapes.items():
        command += ["--set", f"{name}={out / pathlib.Path(file).with_suffix('.glb')}"]
    page = out / "run.html"  # of the first run
    page.unlink(missing_ok=True)
    good, most, contacts, why = 0, {"beside": 0.0, "below": 0.0, "turned": 0.0, "tracking": 0.0}, 0, []
    for k in range(o.physics):
        seed = o.seed + k
        report = out / f"robot-{seed}.json"
        report.unlink(missing_ok=True)
        robot = [*command, "--seed", str(seed), "--report", str(report), *driver_options(random.Random(seed))]
        if o.film and k == 0:
            robot += ["--film", str(out / "film")]
        pages = ["--page", str(page)] if k == 0 else []
        done = subprocess.run([tool("kaboum-plan"), "run", *files, "--plan", plan, *o.motions, *pages, "--robot", shlex.join(robot), "--journal", str(out / f"run-{seed}.jsonl"),
                               "--report", str(out / f"run-{seed}.json"), "--robot-timeout", "120", "--quiet"], capture_output=True, text=True, check=False)
        if not report.exists():
            why.append(f"seed {seed}: exit code {done.returncode}: {(done.stderr.strip().splitlines() or [''])[-1]}")
            continue
        said = json.loads(report.read_text())
        ends = said["most"]
        for key, value in {**ends, "tracking": said["tracking"]}.items():
            most[key] = max(most[key], value)
        contacts += len(said["contacts"])
        if done.returncode == 0 and ends["beside"] <= BESIDE and ends["below"] <= BELOW and ends["turned"] <= TURNED:
            good += 1
        else:
            why.append(f"seed {seed}: exit code {done.returncode}, {ends}, {said['contacts'][:2]}: {(done.stderr.strip().splitlines() or [''])[-1]}")
    for line in why:
        print(line, file=sys.stderr)
    return {"runs": o.physics, "good": good, "unplanned_contacts": contacts, **{f"most_{k}": round(v, 5) for k, v in most.items()}}


def say(result, pages, status):
    """The result in one line, the last one on standard output; then, on standard error, pages to look at."""
    print(json.dumps(result), flush=True)
    for page in pages:
        print(f"see {page}", file=sys.stderr)
    return status


def run(name, o, cell, problem_text, domain="domain.kpl", compare=lambda plan: {}, driver_options=lambda chance: []):
    """All that comes after scene and problem. @param domain  None where the problem is a task in a few lines.
    @param compare  what the last line says more of a plan. @param driver_options  of examples/drivers/physics.py, for a source of chance."""
    out = o.out.resolve()
    cell.make(out)
    task = out / ("problem.kpl" if domain else "problem.task")
    task.write_text(problem_text)
    if o.scene_only:
        return 0
    plan, files = str(out / "plan.json"), [*([str(HERE / name / domain)] if domain else []), str(task), "--scene", str(out / "cell.json")]
    result = {"scenario": name, "n": o.n, "seed": o.seed, "solved": False, "actions": 0, "nodes": 0, "leaves": 0, "plan_s": 0.0,
              "predicate_calls": 0, "ik_calls": 0, "executed_branches": 0, "samples": 0, "collisions": 0, "limit_violations": 0}

    pages = []

    def call(command, *arguments):
        report = out / f"{command}.json"
        report.unlink(missing_ok=True)
        done = subprocess.run([tool("kaboum-plan"), command, *files, *arguments, "--report", str(report), "--quiet"], check=False)
        return done.returncode, json.loads(report.read_text()) if report.exists() else {}

    status, solved = call("solve", "-o", plan, "--seed", str(o.seed), "--search", o.search, "--timeout", str(o.timeout),
                          *(["--no-cache"] if o.no_cache else []))
    result["plan_s"] = round(solved.get("resources", {}).get("user_seconds_searching", 0.0), 4)
    result["predicate_calls"] = solved.get("geometry", {}).get("predicate_calls", 0)
    result["ik_calls"] = solved.get("geometry", {}).get("ik_calls", 0)
    result["external_calls"] = solved.get("statistics", {}).get("external_calls", 0)
    if status == 0:
        size = solved["plan"]
        result.update(solved=True, actions=size["longest_path"], nodes=size["nodes"], leaves=size["leaves"])
        result.update(compare(json.loads(pathlib.Path(plan).read_text())))
        checked, _ = call("check", "--plan", plan)
        result["checked"] = checked == 0
        if checked == 1:  # not that there is no plan: one was found that does not hold
            checked = 6
        if o.physics and checked == 0:
            result["physics"] = in_physics(o, cell, files, plan, driver_options)
            checked = int(result["physics"]["good"] < o.physics)
            pages = [page for page in [out / "physics/run.html"] if page.exists()]
        if o.plan_only:
            return say(result, pages, checked)
        executed, report = call("run", "--plan", plan, "--outcomes", "all", *o.motions)
        result.update(executed_branches=report.get("branches", 0), samples=report.get("samples", 0),
                      collisions=report.get("collisions", 0), limit_violations=report.get("limit_violations", 0),
                      jumps=report.get("jumps", 0))
        for drawing in (["-o", str(out / "plan.svg")], ["--html", str(out / "plan.html")]):
            subprocess.run([tool("kaboum-plan"), "show", *files, "--plan", plan, *drawing], check=True)
        status = max(checked, executed)
        pages.insert(0, out / "plan.html")
    return say(result, pages, status)


def grasp(name, z, y, at):
    """By a tool whose axes z and y point along these directions of the object, at a point of it."""
    x = [y[1] * z[2] - y[2] * z[1], y[2] * z[0] - y[0] * z[2], y[0] * z[1] - y[1] * z[0]]
    rows = [x, list(y), list(z)]  # from the object to the tool
    position = [-sum(r[k] * at[k] for k in range(3)) for r in rows]
    if math.hypot(rows[2][1], rows[2][2]) > 1e-9:
        roll, yaw = math.atan2(rows[2][1], rows[2][2]), math.atan2(rows[1][0], rows[0][0])
    else:  # pitch of a right angle: only the sum or the difference of the two is determined
        roll, yaw = 0.0, math.atan2(-rows[0][1], rows[1][1])
    return {"name": name, "position": position, "rpy": [roll, math.asin(max(-1.0, min(1.0, -rows[2][0]))), yaw]}


def ring_grasps(tool_name, where, z, up, turns=8):
    """By a tool that points along the axis of a ring, from above (up = -1) or below (1)."""
    out = []
    for k in range(turns):
        a = 2 * math.pi * k / turns
        out.append(grasp(f"{tool_name}/{where}{k}", (0, 0, up), (math.cos(a), math.sin(a), 0), (0, 0, z)))
    return out
