#!/usr/bin/env python3
"""What is read of a robot is what MuJoCo, Drake and Pinocchio load: poses of all links at 100 configurations within 1e-9, limits, shapes.

usage: readers.py ROBOT_POSES BIN [FOLDER...]

Robots are made here; those below the folders, and below $KABOUM_ROBOTS, are compared as well. Then each MJCF robot is
decomposed, and MuJoCo loads what is written: the same bodies, masses and poses, and no explosion in 5 s. Run by the
Python of `scripts/setup --engines`; exit code 77 where it has no MuJoCo.
"""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

try:
    import mujoco
    import numpy as np
except ImportError:
    print("readers.py: skipped: no MuJoCo here; scripts/setup --engines", file=sys.stderr)
    sys.exit(77)

TOLERANCE = 1e-9
BOX = """OFF
8 12 0
0 0 0\n0.2 0 0\n0.2 0.1 0\n0 0.1 0\n0 0 0.05\n0.2 0 0.05\n0.2 0.1 0.05\n0 0.1 0.05
3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7
"""

# Classes in classes, frames, all ways of stating a rotation, several joints of a body, replicas, ref, includes.
MJCF = """<mujoco model="m"><compiler angle="degree" eulerseq="ZyX" meshdir="meshes"/>
<include file="defaults.xml"/>
<asset><mesh name="part" file="part.obj" scale="1 2 0.5"/><mesh file="part.obj" name="moved" refpos="0.1 0 0" refquat="1 0 1 0"/></asset>
<worldbody><geom type="plane" size="1 1 1"/>
 <body name="base" pos="0 0 0.3" euler="10 20 30" childclass="arm"><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
  <geom class="collision" type="box" size="0.1 0.2 0.3" axisangle="0 1 1 40"/>
  <frame pos="0.1 0 0" zaxis="0 1 1"><geom class="collision" type="capsule" fromto="0 0 0 0.1 0.2 0.3" size="0.02"/>
   <body name="a" xyaxes="0 1 0 -1 0.3 0"><joint name="j1" pos="0.1 0.2 0.3" axis="0 1 1" ref="15"/><joint name="j2" type="slide" range="-1 1"/>
    <joint name="j3" axis="1 0 0" range="-30 60"/><geom class="visual" type="mesh" mesh="part" pos="0 0 0.1" quat="1 2 3 4"/>
    <geom class="collision" type="mesh" mesh="part" pos="0 0 0.1" euler="1 2 3"/><geom class="collision" type="mesh" mesh="moved"/>
    <body name="b" pos="0 0 0.4"><joint name="j4" class="stiff"/><geom class="collision" type="ellipsoid" size="0.1 0.05 0.02"/>
     <replicate count="3" offset="0.1 0 0" euler="0 0 20" sep="-"><body name="c" pos="0 0.1 0"><joint name="jc" axis="0 1 0"/>
      <geom class="collision" type="cylinder" size="0.02 0.05"/></body></replicate></body></body></frame></body></worldbody></mujoco>"""
DEFAULTS = """<mujocoinclude><default><joint axis="0 0 1" damping="0.1"/><default class="arm"><joint axis="1 1 0"/>
 <default class="stiff"><joint range="-45 45" axis="0 1 0"/></default></default>
 <default class="visual"><geom contype="0" conaffinity="0" group="2"/></default><default class="collision"><geom group="3" friction="0.7"/></default>
</default></mujocoinclude>"""
SDF = """<sdf version="1.9"><model name="s"><frame name="f" attached_to="l1"><pose>0.1 0.2 0.3 0.3 0.2 0.1</pose></frame>
<link name="l0"><pose>0 0 1 0 0.1 0</pose><inertial><mass>1</mass></inertial></link><link name="l1"><pose relative_to="l0">0.3 0 0 0.1 0 0.2</pose></link>
<link name="l2"><pose relative_to="f">0 0 0.2 90 0 0</pose></link><link name="l3"><pose degrees="true">1 0 0 0 0 45</pose></link>
<joint name="a" type="revolute"><parent>l0</parent><child>l1</child><axis><xyz expressed_in="l0">0 1 1</xyz><limit><lower>-1</lower><upper>2</upper></limit></axis></joint>
<joint name="b" type="prismatic"><pose>0.1 0 0 0 0 0.5</pose><parent>l1</parent><child>l2</child><axis><xyz>1 0 0</xyz></axis></joint>
<joint name="c" type="revolute"><pose relative_to="f"/><parent>l2</parent><child>l3</child><axis><xyz>0 0 1</xyz></axis></joint></model></sdf>"""
URDF = """<robot name="u" version="1.2"><link name="l0"/><link name="l1"><collision><origin quat_xyzw="0 0 0.6 0.8" xyz="1 2 3"/>
<geometry><capsule radius="0.1" length="0.5"/></geometry></collision></link><link name="l2"/><link name="l3"/>
<joint name="a" type="revolute"><parent link="l0"/><child link="l1"/><origin xyz="0.1 0 0.2" quat_xyzw="0.5 0.5 0.5 0.5"/><axis xyz="0 1 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1" acceleration="1" deceleration="2" jerk="3"/></joint>
<joint name="b" type="continuous"><parent link="l1"/><child link="l2"/><origin rpy="1 2 3"/><axis xyz="0 0 2"/></joint>
<joint name="c" type="prismatic"><parent link="l2"/><child link="l3"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>"""


def make_robots(folder):
    (folder / "meshes").mkdir()
    vertices = [line for line in BOX.splitlines()[2:10]]
    faces = [line.split()[1:] for line in BOX.splitlines()[10:]]
    (folder / "meshes/part.obj").write_text("".join(f"v {v}\n" for v in vertices) +
                                            "".join(f"f {' '.join(str(int(i) + 1) for i in f)}\n" for f in faces))
    for name, text in {"m.xml": MJCF, "defaults.xml": DEFAULTS, "s.sdf": SDF, "u.urdf": URDF}.items():
        (folder / name).write_text(text)
    return [folder / name for name in ("m.xml", "s.sdf", "u.urdf")]


def below(folder):
    for path in sorted(pathlib.Path(folder).rglob("*")):
        if path.suffix in (".sdf", ".urdf") or path.suffix == ".xml" and not path.name.startswith("scene"):
            yield path


class Failures:
    def __init__(self):
        self.count = 0

    def __call__(self, path, what):
        self.count += 1
        print(f"{path}: {what}")


def difference(ours, rotation, translation):
    return max(np.abs(np.reshape(ours[:9], (3, 3)) - rotation).max(), np.abs(np.array(ours[9:]) - translation).max())


def compare_mujoco(path, read, fail):
    """@return whether MuJoCo loads it."""
    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except ValueError:
        return False
    if "error" in read:
        fail(path, "MuJoCo loads it, and it is refused: " + read["error"])
        return True
    data = mujoco.MjData(model)
    joints = [j for j in range(model.njnt) if model.jnt_type[j] in (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))]
    if len(joints) != len(read["variables"]):
        fail(path, f"{len(read['variables'])} joints, MuJoCo has {len(joints)}")
        return True
    for j, ours in zip(joints, read["variables"]):
        limits = [None, None] if not model.jnt_limited[j] else list(model.jnt_range[j])
        if any((a is None) != (b is None) or a is not None and abs(a - b) > TOLERANCE
               for a, b in zip((ours["lower"], ours["upper"]), limits)):
            fail(path, f"joint {ours['name']}: limits {ours['lower']}, {ours['upper']}, not {limits}")
    links = {link["name"]: i for i, link in enumerate(read["links"])}
    worst, where = 0, ""
    for configuration in read["configurations"]:
        data.qpos[:] = model.qpos0
        for j, q in zip(joints, configuration["q"]):
            data.qpos[model.jnt_qposadr[j]] = q
        mujoco.mj_kinematics(model, data)
        for b in range(model.nbody):
            name = model.body(b).name
            if name and name not in links:
                fail(path, f"there is no link {name}")
                return True
            if name:
                off = difference(configuration["poses"][links[name]], data.xmat[b].reshape(3, 3), data.xpos[b])
                if off > worst:
                    worst, where = off, name
    if worst > TOLERANCE:
        fail(path, f"{where} is {worst} away from where MuJoCo has it")
    compare_geoms(path, read, model, links, fail)
    return True


def compare_geoms(path, read, model, links, fail):
    kinds = {mujoco.mjtGeom.mjGEOM_SPHERE: ("sphere", lambda s: [s[0]]), mujoco.mjtGeom.mjGEOM_CAPSULE: ("capsule", lambda s: [s[0], 2 * s[1]]),
             mujoco.mjtGeom.mjGEOM_ELLIPSOID: ("ellipsoid", list), mujoco.mjtGeom.mjGEOM_CYLINDER: ("cylinder", lambda s: [s[0], 2 * s[1]]),
             mujoco.mjtGeom.mjGEOM_BOX: ("box", lambda s: list(2 * s)), mujoco.mjtGeom.mjGEOM_MESH: ("mesh", None)}
    kinds = {int(kind): what for kind, what in kinds.items()}
    for b in range(model.nbody):
        name = model.body(b).name
        geoms = [g for g in range(model.ngeom) if model.geom_bodyid[g] == b and model.geom_type[g] in kinds and
                 (model.geom_contype[g] or model.geom_conaffinity[g])]
        if not name or model.npair:
            continue
        ours = read["links"][links[name]]["collision"]
        if len(ours) != len(geoms):
            fail(path, f"{name}: {len(ours)} shapes, MuJoCo has {len(geoms)}")
            continue
        for shape, g in zip(ours, geoms):
            kind, size = kinds[int(model.geom_type[g])]
            if shape["kind"] != kind:
                fail(path, f"{name}: a {shape['kind']}, in MuJoCo a {kind}")
                continue
            if size is None:
                continue  # MuJoCo moves meshes to their middles: volumes are compared where they are written
            matrix = np.zeros(9)
            mujoco.mju_quat2Mat(matrix, model.geom_quat[g])
            off = difference(shape["origin"], matrix.reshape(3, 3), model.geom_pos[g])
            off = max(off, max(abs(a - b) for a, b in zip(shape["size"], size(model.geom_size[g]))))
            if off > TOLERANCE:
                fail(path, f"{name}: a {kind} is off by {off}")


def compare_pinocchio(path, read, fail):
    try:
        import pinocchio
        model = pinocchio.buildModelFromUrdf(str(path))
    except (ImportError, ValueError):
        return False
    if "error" in read:
        return False  # urdfdom is laxer in places (docs/formats.md)
    if read["unmodelled"]:
        return False
    data = model.createData()
    names = [v["name"] for v in read["variables"]]
    links = {link["name"]: i for i, link in enumerate(read["links"])}
    if any(not model.existJointName(name) for name in names):
        fail(path, "Pinocchio has not all joints")
        return True
    mimics = model.nq != sum(model.joints[model.getJointId(name)].nq for name in names)
    if mimics:
        return False  # it moves joints that mimic others by themselves
    worst = 0
    for configuration in read["configurations"]:
        q = pinocchio.neutral(model)
        for name, value in zip(names, configuration["q"]):
            joint = model.joints[model.getJointId(name)]
            if joint.nq == 2:
                q[joint.idx_q:joint.idx_q + 2] = math.cos(value), math.sin(value)
            else:
                q[joint.idx_q] = value
        pinocchio.framesForwardKinematics(model, data, q)
        for frame, pose in zip(model.frames, data.oMf):
            if frame.type == pinocchio.FrameType.BODY and frame.name in links:
                worst = max(worst, difference(configuration["poses"][links[frame.name]], pose.rotation, pose.translation))
    if worst > TOLERANCE:
        fail(path, f"links are {worst} away from where Pinocchio has them")
    return True


def compare_drake(path, read, fail):
    try:
        import logging
        logging.disable(logging.CRITICAL)
        from pydrake.multibody.parsing import Parser
        from pydrake.multibody.plant import MultibodyPlant
        plant = MultibodyPlant(0.0)
        Parser(plant).AddModels(str(path))
        plant.Finalize()
    except (ImportError, RuntimeError):
        return False
    if "error" in read or read["unmodelled"] or plant.num_model_instances() != 3:
        return False
    context, worst = plant.CreateDefaultContext(), 0
    for configuration in read["configurations"]:
        for variable, q in zip(read["variables"], configuration["q"]):
            joint = plant.GetJointByName(variable["name"])
            (joint.set_angle if hasattr(joint, "set_angle") else joint.set_translation)(context, q)
        first = None
        for link, ours in zip(read["links"], configuration["poses"]):
            if link["name"] == "world" or not plant.HasBodyNamed(link["name"]):
                continue
            theirs = plant.EvalBodyPoseInWorld(context, plant.GetBodyByName(link["name"])).GetAsMatrix4()
            here = np.eye(4)
            here[:3, :3], here[:3, 3] = np.reshape(ours[:9], (3, 3)), ours[9:]
            if first is None:
                first = np.linalg.inv(theirs), np.linalg.inv(here)
            worst = max(worst, np.abs(first[0] @ theirs - first[1] @ here).max())
    if worst > TOLERANCE:
        fail(path, f"links are {worst} away from where Drake has them")
    return True


def check_written(path, tools, fail):
    """MuJoCo loads what is made of an MJCF robot: the same bodies, masses and poses; and it stays where it is finite."""
    for more in ([], ["--visual"]):
        with tempfile.TemporaryDirectory() as place:
            out = pathlib.Path(place) / "out"
            done = subprocess.run([str(tools / "bcd-decompose"), str(path), "-o", str(out), "--epsilon", "2cm", "--effort", "fast", "--quiet", *more],
                                  capture_output=True, text=True, check=False)
            written = out / path.name
            if not written.exists():
                fail(path, f"nothing is written {more}: {done.stderr.strip()[-300:]}")
                continue
            before = mujoco.MjModel.from_xml_path(str(path))
            try:
                after = mujoco.MjModel.from_xml_path(str(written))
            except ValueError as error:
                fail(path, f"MuJoCo does not load what is written {more}: {error}")
                continue
            for what in ("body_mass", "body_inertia", "body_pos", "body_quat", "body_ipos", "jnt_range", "jnt_axis", "qpos0"):
                a, b = getattr(before, what), getattr(after, what)
                if a.shape != b.shape or a.size and np.abs(a - b).max() > 1e-9:
                    fail(path, f"{what} is another one {more}")
            data = mujoco.MjData(after)
            while data.time < 5:
                mujoco.mj_step(after, data)
            if not np.isfinite(data.qpos).all() or data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number:
                fail(path, f"it explodes {more}")
            # What moves beside what stands still may be free.
            verified = subprocess.run([str(tools / "bound-verify"), "robot", str(path), str(written), "--prepare", "--quiet", *more],
                                      capture_output=True, text=True, check=False)
            if verified.returncode != 0:
                fail(path, f"bound-verify: exit code {verified.returncode} {more}: {verified.stderr[-300:]}")


def main():
    program, tools, fail = sys.argv[1], pathlib.Path(sys.argv[2]), Failures()
    with tempfile.TemporaryDirectory() as place:
        own = make_robots(pathlib.Path(place))
        folders = sys.argv[3:] + [x for x in os.environ.get("KABOUM_ROBOTS", "").split(os.pathsep) if x]
        paths = own + [path for folder in folders for path in below(folder)]
        compared = {"mujoco": 0, "pinocchio": 0, "drake": 0}
        for path in paths:
            read = json.loads(subprocess.run([program, str(path)], capture_output=True, text=True, check=True).stdout)[str(path)]
            if path in own and "error" in read:
                fail(path, read["error"])
                continue
            if path.suffix == ".xml":
                compared["mujoco"] += compare_mujoco(path, read, fail)
            if path.suffix == ".urdf":
                compared["pinocchio"] += compare_pinocchio(path, read, fail)
            if path.suffix == ".sdf":
                compared["drake"] += compare_drake(path, read, fail)
        check_written(own[0], tools, fail)
    print("compared:", ", ".join(f"{n} with {engine}" for engine, n in compared.items()))
    return 1 if fail.count else 0


if __name__ == "__main__":
    sys.exit(main())
