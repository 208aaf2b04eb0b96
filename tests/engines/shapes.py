#!/usr/bin/env python3
"""Robots with spheres, capsules and boxes as shapes, loaded by the engines of today: MuJoCo, Drake, Pinocchio.

usage: shapes.py ROBOT_POSES BIN

A URDF, an MJCF and an SDF robot are written with each kind of bodies in each format, and judged by bound-verify. The engines must have
the same shapes, of the same kinds and sizes in the same places (1e-9), and links where they are by our own kinematics. A URDF of
spheres is taken apart as the generator of VAMP's kernels takes it: by Pinocchio, with nothing but spheres whose radii float32 holds,
and with the SRDF's pairs.
Run by the Python of `scripts/setup --engines`; exit code 77 where there is no MuJoCo.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

try:
    import numpy as np
    import readers
except ImportError:
    print("shapes.py: skipped: no MuJoCo here; scripts/setup --engines", file=sys.stderr)
    sys.exit(77)

from checks import check, exit_code
from simulated import boxes_obj

EPSILON = "0.03"
LIMITS = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
INERTIAL = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
URDF = f"""<robot name="arm"><link name="base">{INERTIAL}<collision><origin xyz="0.1 0 0" rpy="0.3 0.2 0.1"/><geometry><mesh filename="meshes/part.obj"/></geometry></collision></link>
<link name="fore">{INERTIAL}<collision><origin rpy="0 1.5707963267948966 0.4"/><geometry><mesh filename="meshes/part.obj" scale="1 -1 1"/></geometry></collision></link>
<link name="hand">{INERTIAL}<collision><geometry><box size="0.1 0.1 0.3"/></geometry></collision></link>
<joint name="j" type="revolute"><parent link="base"/><child link="fore"/><origin xyz="0 0 0.3" rpy="0.1 0.2 0"/><axis xyz="0 1 0"/>{LIMITS}</joint>
<joint name="k" type="revolute"><parent link="fore"/><child link="hand"/><origin xyz="0 0.3 0"/><axis xyz="1 0 0"/>{LIMITS}</joint></robot>"""
MJCF = """<mujoco model="arm"><compiler angle="radian"/><default><default class="c"><geom type="mesh" mesh="part" friction="0.9"/></default></default>
<asset><mesh name="part" file="meshes/part.obj"/></asset>
<worldbody><body name="base" pos="0 0 1"><joint name="j" axis="0 0 1" range="-1 1"/><frame euler="0.3 0 0" pos="0.1 0 0"><geom type="mesh" mesh="part" quat="1 0 0 1"/></frame>
<geom type="mesh" mesh="part" pos="0 0.2 0"/><body name="hand" pos="0.4 0 0"><joint name="k" type="slide" axis="1 0 0" range="0 1"/>
<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><geom type="mesh" mesh="part" euler="0 0 1"/></body></body></worldbody></mujoco>"""
SDF = """<sdf version="1.9"><model name="arm"><link name="base"><pose>0 0 1 0 0 0.3</pose><collision name="c"><pose>0.1 0 0 0.3 0.2 0.1</pose><geometry><mesh><uri>meshes/part.obj</uri></mesh></geometry></collision></link>
<link name="hand"><pose>0 0.4 1 0 0.2 0</pose><collision name="c"><geometry><mesh><uri>meshes/part.obj</uri></mesh></geometry></collision></link>
<joint name="j" type="revolute"><parent>base</parent><child>hand</child><axis><xyz>0 0 1</xyz><limit><lower>-1</lower><upper>1</upper></limit></axis></joint></model></sdf>"""
ROBOTS = {"arm.urdf": URDF, "arm12.urdf": URDF.replace('name="arm"', 'name="arm" version="1.2"', 1), "arm.xml": MJCF, "arm.sdf": SDF,
          "old.sdf": SDF.replace("1.9", "1.6")}
WRITTEN = {"arm.urdf": (".urdf", ".xml", ".sdf"), "arm12.urdf": (".urdf",), "arm.xml": (".xml",), "arm.sdf": (".sdf", ".xml"), "old.sdf": (".sdf",)}
ENGINES = {".urdf": ("pinocchio",), ".xml": ("mujoco",), ".sdf": ("drake",)}


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    check(done.returncode == 0, f"exit code {done.returncode}: {' '.join(str(c) for c in command)}: {done.stdout[-300:]}{done.stderr[-300:]}")
    return done


def compare(program, robot, written, tools):
    run(tools / "bound-verify", "robot", robot, "--bodies", written, "--epsilon", "0.0301", "--quiet")
    read = json.loads(run(program, written).stdout)[str(written)]
    for engine in ENGINES[written.suffix]:
        answer = readers.load(engine, written, read)
        check(answer["loaded"], f"{written.name}: {engine} does not load it: {answer.get('why')}")
        for fault in answer.get("faults", []):
            check(False, f"{written.name}: {engine}: {fault}")
        check((answer.get("worst") or 0) <= readers.TOLERANCE, f"{written.name}: links are {answer.get('worst')} away in {engine}")
        check(answer.get("shapes", 0) > 0, f"{written.name}: {engine} has no shape")
    return len(ENGINES[written.suffix])


def take_as_vamp(place, tools):
    """What the generator does before it traces: Pinocchio's model and shapes, all spheres; pairs of the SRDF taken out."""
    import pinocchio
    robot, written = place / "arm.urdf", place / "spherized.urdf"
    run(tools / "bcd-decompose", robot, "-o", written, "--bodies", "spheres", "--epsilon", EPSILON, "--effort", "fast")
    run(tools / "bound-verify", "robot", robot, "--spheres", written, "--epsilon", EPSILON)
    run(tools / "kaboum-pairs", robot, "--srdf", place / "arm.srdf")
    report = place / "spheres.json"
    run(tools / "bound-verify", "robot", robot, "--spheres", written, "--report", report)
    model = pinocchio.buildModelFromUrdf(str(written))
    shapes = pinocchio.buildGeomFromUrdf(model, str(written), pinocchio.GeometryType.COLLISION)
    check(len(shapes.geometryObjects) == json.loads(report.read_text())["count"], "Pinocchio has another number of spheres")
    for g in shapes.geometryObjects:
        check(type(g.geometry).__name__ == "Sphere", f"{g.name} is no sphere")
        check(float(np.float32(g.geometry.radius)) == g.geometry.radius, f"{g.name}: float32 does not hold the radius")
    shapes.addAllCollisionPairs()
    before = len(shapes.collisionPairs)
    pinocchio.removeCollisionPairs(model, shapes, str(place / "arm.srdf"), False)
    srdf = ElementTree.parse(place / "arm.srdf").getroot()
    disabled = [{e.get("link1"), e.get("link2")} for e in srdf.iter("disable_collisions")]
    check(disabled and len(shapes.collisionPairs) < before, "no pair is taken out")
    for pair in shapes.collisionPairs:
        links = {model.frames[shapes.geometryObjects[i].parentFrame].name for i in (pair.first, pair.second)}
        check(links not in disabled, f"{links} is still to be checked")


def main():
    program, tools = sys.argv[1], pathlib.Path(sys.argv[2])
    compared = 0
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        (place / "meshes").mkdir()
        (place / "meshes/part.obj").write_text(boxes_obj(((-0.05, -0.04, 0), (0.05, 0.04, 0.4)), ((0, -0.03, 0.3), (0.25, 0.03, 0.38))))
        for name, text in ROBOTS.items():
            (place / name).write_text(text)
            for suffix in WRITTEN[name]:
                for kind in ("spheres", "capsules", "boxes", "mixed"):
                    written = place / f"{name.replace('.', '-')}-{kind}{suffix}"
                    run(tools / "bcd-decompose", place / name, "-o", written, "--bodies", kind, "--epsilon", EPSILON, "--effort", "fast")
                    if written.exists():
                        compared += compare(program, place / name, written, tools)
        take_as_vamp(place, tools)
    print(f"compared: {compared} robots")
    return exit_code()


if __name__ == "__main__":
    sys.exit(main())
