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
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET

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
    <geom class="collision" type="mesh" mesh="part" pos="0 0 0.1" euler="1 2 3"/><geom class="collision" type="mesh" mesh="moved"/><geom class="collision" type="capsule" mesh="part" pos="0.1 0 0" euler="3 2 1" fitscale="0.8"/><geom class="collision" type="box" mesh="moved"/>
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
# Models in models, placed by a frame of their own; joints across them, and one that follows another.
NESTED = """<sdf version="1.11"><model name="n"><link name="base"><pose>0 0 1 0 0.2 0</pose></link>
<model name="arm" placement_frame="mount"><pose relative_to="base">0.1 0 0.2 0.1 0.2 0.3</pose><frame name="mount" attached_to="lower"><pose>0 0 -0.1 0 0 0.4</pose></frame>
<link name="lower"><pose>0.2 0 0 0 0.3 0</pose></link><link name="upper"><pose relative_to="lower">0 0 0.5 0 0 0</pose></link>
<joint name="elbow" type="revolute"><parent>lower</parent><child>upper</child><axis><xyz expressed_in="__model__">0 1 0</xyz></axis></joint>
<model name="hand"><pose relative_to="upper">0 0 0.3 0 0 0.5</pose><link name="palm"><collision name="c"><pose relative_to="tip">0 0 0.1 0 0 0</pose><geometry><box><size>0.1 0.1 0.2</size></box></geometry></collision></link>
<link name="finger"><pose>0.05 0 0.1 0 0 0</pose></link><frame name="tip" attached_to="palm"><pose>0 0.1 0 0.3 0 0</pose></frame>
<joint name="grip" type="prismatic"><parent>palm</parent><child>finger</child><axis><xyz>1 0 0</xyz></axis></joint></model>
<joint name="wrist" type="revolute"><parent>upper</parent><child>hand::palm</child><axis><xyz>0 0 1</xyz></axis></joint></model>
<joint name="shoulder" type="revolute"><parent>base</parent><child>arm::lower</child><axis><xyz>0 0 1</xyz></axis></joint>
<link name="hook"><pose>1 0 0 0 0 0</pose></link><joint name="follows" type="revolute"><parent>base</parent><child>hook</child>
<axis><xyz>1 0 0</xyz><mimic joint="shoulder"><multiplier>0.5</multiplier><offset>0.2</offset><reference>0.1</reference></mimic></axis></joint></model></sdf>"""
# A model attached whole, a body and a frame of it, with prefixes; its angles are in another unit and order, its classes
# are its own, its mesh lies in its own folder, and it attaches another one itself.
ATTACHED = {
    "attach.xml": """<mujoco model="main"><compiler angle="degree" meshdir="meshes"/>
<default><geom contype="1" density="5"/><joint axis="1 0 0" damping="2"/><default class="mc"><geom contype="0" conaffinity="0"/><joint range="-10 10"/></default></default>
<asset><mesh file="part.obj"/><model name="arm" file="sub/arm.xml"/></asset>
<worldbody><body name="table" childclass="mc"><joint name="turn"/><geom class="main" type="mesh" mesh="part"/>
<frame pos="0 0 1" euler="0 0 90"><attach model="arm" body="base" prefix="l_"/></frame><attach model="arm" body="base" prefix="r_"/>
<replicate count="2" offset="0 1 0"><attach model="arm" frame="mount" prefix="f"/></replicate></body><attach model="arm" prefix="w_"/></worldbody></mujoco>""",
    "sub/arm.xml": """<mujoco model="a"><compiler angle="radian" meshdir="parts" eulerseq="ZYx" autolimits="true"/>
<default><geom type="box"/><default class="c"><geom size="0.02 0.03 0.04"/><joint range="-1 1" axis="0 1 0" ref="0.1"/>
<default class="slides"><joint type="slide" range="-0.2 0.3"/></default></default></default>
<asset><mesh name="part" file="part.obj" scale="1 1 2"/><model file="hand.xml"/></asset>
<worldbody><geom name="floor" size="1 1 .1"/><body name="base" pos="0 0 1" euler="0.1 0.2 0.3" childclass="c"><joint name="j" pos="0.1 0 0"/>
<geom name="g" type="capsule" fromto="0 0 0 0 0.1 .3" size="0.02"/><geom type="mesh" mesh="part" axisangle="0 1 1 0.7"/>
<frame name="mount" pos="0.1 0 0" euler="0.3 0 0.1"><geom size="0.01 0.02 0.03"/></frame>
<body name="tip" pos="0 0 .3"><joint name="j2" class="slides"/><geom/><attach model="hand" prefix="h_"/></body></body><body name="other"><geom size=".1 .1 .1"/></body></worldbody>
<contact><exclude body1="base" body2="tip"/><exclude body1="base" body2="other"/><exclude body1="world" body2="base"/></contact>
<equality><joint joint1="j" joint2="j2"/></equality><actuator><motor joint="j" name="a"/></actuator><sensor><actuatorfrc actuator="a"/><framepos objtype="body" objname="tip"/></sensor></mujoco>""",
    "sub/hand.xml": """<mujoco model="hand"><compiler angle="radian"/><worldbody><body name="palm" pos="0 0 0.1" euler="0.2 0.1 0"><joint name="grip" axis="0 0 1" range="0 0.5"/>
<geom type="sphere" size="0.03"/></body></worldbody></mujoco>"""}
# Models that are included: with and without a name, a pose and a placement frame, of an older version, and in one another.
INCLUDED = {
    "i.sdf": """<sdf version="1.9"><model name="i"><link name="base"><pose>0 0 1 0 0.2 0</pose></link>
<include><uri>model://wrist/</uri><name>left</name><pose relative_to="base">0.1 0.2 0.3 0.1 0.2 0.3</pose><placement_frame>mount</placement_frame></include>
<include><uri>model://wrist/</uri></include><joint name="l" type="revolute"><parent>base</parent><child>left::palm</child><axis><xyz>0 1 0</xyz></axis></joint>
<joint name="r" type="prismatic"><parent>base</parent><child>wrist::palm</child><axis><xyz>0 0 1</xyz></axis></joint></model></sdf>""",
    "models/wrist/model.config": """<model><name>wrist</name><sdf version="1.4">old.sdf</sdf><sdf version="1.8">new.sdf</sdf></model>""",
    "models/wrist/new.sdf": """<sdf version="1.8"><model name="wrist"><pose>0.5 0 0 0 0 0.5</pose><link name="palm"><collision name="c"><geometry><mesh><uri>meshes/part.obj</uri></mesh></geometry></collision></link>
<frame name="mount" attached_to="palm"><pose>0 0 -0.1 0 0 0.4</pose></frame><include><name>tip</name><uri>model://finger/</uri><pose relative_to="palm">0 0 0.2 0 0 0.1</pose></include>
<joint name="w" type="revolute"><parent>palm</parent><child>tip::finger</child><axis><xyz>1 0 0</xyz></axis></joint></model></sdf>""",
    "models/finger/model.config": """<model><sdf version="1.5">model.sdf</sdf></model>""",
    "models/finger/model.sdf": """<sdf version="1.5"><model name="finger"><link name="finger"><pose>0 0.1 0 0.3 0 0</pose><collision name="c"><geometry><box><size>0.1 0.1 0.2</size></box></geometry></collision></link>
<link name="nail"><pose>0 0.1 0.2 0 0.4 0</pose></link><joint name="n" type="revolute"><parent>finger</parent><child>nail</child>
<axis><xyz>0 0 1</xyz><use_parent_model_frame>true</use_parent_model_frame></axis></joint></model></sdf>"""}
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
    for name, text in {"m.xml": MJCF, "defaults.xml": DEFAULTS, "s.sdf": SDF, "n.sdf": NESTED, "u.urdf": URDF, **ATTACHED, **INCLUDED}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    for place in ("sub/parts", "models/wrist/meshes"):
        shutil.copytree(folder / "meshes", folder / place)
    os.environ["ROS_PACKAGE_PATH"] = os.pathsep.join([str(folder / "models"), *filter(None, [os.environ.get("ROS_PACKAGE_PATH")])])
    return [folder / name for name in ("m.xml", "s.sdf", "n.sdf", "u.urdf", "attach.xml", "i.sdf")]


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


class NotLoaded(Exception):
    """An engine does not load a robot, and says why."""


class Compared:
    """What an engine that loads a robot has otherwise."""

    def __init__(self):
        self.faults = []
        self.worst = None  # the farthest that a link is from where the engine has it
        self.shapes = 0  # for collisions that were compared

    def fault(self, what):
        self.faults.append(what)

    def off(self, distance):
        self.worst = max(self.worst or 0.0, float(distance))


def turn_between(kind, ours, theirs):
    """How far two rotations of a shape are apart that makes no difference to some of them."""
    if kind == "sphere":
        return 0
    between = ours.T @ theirs
    if kind in ("box", "ellipsoid"):  # half turns about its axes
        between = between * np.sign(np.diag(between))
    if kind in ("cylinder", "capsule"):
        return np.abs(np.abs(between[:, 2]) - [0, 0, 1]).max()
    return np.abs(between - np.eye(3)).max()


def compare_shape(out, name, ours, kind, size, rotation, translation):
    """@param size  as JSON of robot-poses has it; None: not known"""
    out.shapes += 1
    if ours["kind"].split()[0] != kind:
        out.fault(f"{name}: a {ours['kind']}, there a {kind}")
        return
    off = 0 if size is None else max(abs(a - b) for a, b in zip(ours["size"], size))
    if rotation is not None:
        off = max(off, turn_between(kind, np.reshape(ours["origin"][:9], (3, 3)), rotation),
                  np.abs(np.array(ours["origin"][9:]) - translation).max())
    if off > TOLERANCE:
        out.fault(f"{name}: a {kind} is off by {off}")


def values_of(read, configuration):
    """Of every joint that moves, by its name."""
    return {j["name"]: j["multiplier"] * configuration["q"][j["variable"]] + j["offset"] for j in read["joints"]}


def compare_mujoco(path, read):
    """@throws NotLoaded"""
    out = Compared()
    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except ValueError as error:
        raise NotLoaded(str(error)) from error
    if "error" in read:
        out.fault("MuJoCo loads it, and it is refused: " + read["error"])
        return out
    data = mujoco.MjData(model)
    joints = [j for j in range(model.njnt) if model.jnt_type[j] in (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))]
    links = {link["name"]: i for i, link in enumerate(read["links"])}
    urdf = path.suffix == ".urdf"
    moving = read["joints"] if urdf else read["variables"]
    if len(joints) != len(moving):
        out.fault(f"{len(moving)} joints, MuJoCo has {len(joints)}")
        return out
    if not urdf:
        for j, ours in zip(joints, read["variables"]):
            limits = [None, None] if not model.jnt_limited[j] else list(model.jnt_range[j])
            if any((a is None) != (b is None) or a is not None and abs(a - b) > TOLERANCE
                   for a, b in zip((ours["lower"], ours["upper"]), limits)):
                out.fault(f"joint {ours['name']}: limits {ours['lower']}, {ours['upper']}, not {limits}")
    for configuration in read["configurations"]:
        data.qpos[:] = model.qpos0
        values = values_of(read, configuration)
        for j, q in zip(joints, configuration["q"] if not urdf else joints):
            data.qpos[model.jnt_qposadr[j]] = values.get(model.joint(j).name, 0) if urdf else q
        mujoco.mj_kinematics(model, data)
        for b in range(model.nbody):
            name = model.body(b).name
            if not name or name == "world":
                continue
            if name not in links:
                out.fault(f"there is no link {name}")
                return out
            out.off(difference(configuration["poses"][links[name]], data.xmat[b].reshape(3, 3), data.xpos[b]))
    if not urdf:  # of URDF MuJoCo puts shapes of several links together
        compare_geoms(read, model, links, out)
    return out


def compare_geoms(read, model, links, out):
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
            out.fault(f"{name}: {len(ours)} shapes, MuJoCo has {len(geoms)}")
            continue
        for shape, g in zip(ours, geoms):
            kind, size = kinds[int(model.geom_type[g])]
            if size is None:  # MuJoCo moves meshes to their middles: volumes are compared where they are written
                compare_shape(out, name, shape, kind, None, None, None)
                continue
            matrix = np.zeros(9)
            mujoco.mju_quat2Mat(matrix, model.geom_quat[g])
            compare_shape(out, name, shape, kind, size(model.geom_size[g]), matrix.reshape(3, 3), model.geom_pos[g])


def compare_pinocchio(path, read):
    """@throws NotLoaded"""
    out = Compared()
    try:
        import pinocchio
        model = pinocchio.buildModelFromUrdf(str(path))
    except (ImportError, ValueError, RuntimeError) as error:
        raise NotLoaded(str(error)) from error
    if "error" in read:
        return out  # urdfdom is laxer in places (docs/formats.md)
    links = {link["name"]: i for i, link in enumerate(read["links"])}
    if not read["unmodelled"]:
        data = model.createData()
        for configuration in read["configurations"]:
            q = pinocchio.neutral(model)
            for name, value in values_of(read, configuration).items():
                if not model.existJointName(name):
                    out.fault(f"Pinocchio has no joint {name}")
                    return out
                joint = model.joints[model.getJointId(name)]
                if joint.nq == 2:
                    q[joint.idx_q:joint.idx_q + 2] = math.cos(value), math.sin(value)
                elif joint.nq == 1:
                    q[joint.idx_q] = value
            pinocchio.framesForwardKinematics(model, data, q)
            for frame, pose in zip(model.frames, data.oMf):
                if frame.type == pinocchio.FrameType.BODY and frame.name in links:
                    out.off(difference(configuration["poses"][links[frame.name]], pose.rotation, pose.translation))
    compare_pinocchio_shapes(path, read, model, out)
    return out


def compare_pinocchio_shapes(path, read, model, out):
    import pinocchio
    packages = [str(path.parent), *[x for x in os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep) if x]]
    try:
        geometry = pinocchio.buildGeomFromUrdf(model, str(path), pinocchio.GeometryType.COLLISION, package_dirs=packages)
    except (ValueError, RuntimeError) as error:
        raise NotLoaded(str(error)) from error
    sizes = {"Box": ("box", lambda g: 2 * g.halfSide), "Sphere": ("sphere", lambda g: [g.radius]),
             "Cylinder": ("cylinder", lambda g: [g.radius, 2 * g.halfLength]), "Capsule": ("capsule", lambda g: [g.radius, 2 * g.halfLength])}
    found = {}
    for g in geometry.geometryObjects:
        found.setdefault(model.frames[g.parentFrame].name, []).append(g)
    for link in read["links"]:
        theirs, ours = found.get(link["name"], []), link["collision"]
        if len(theirs) != len(ours):
            out.fault(f"{link['name']}: {len(ours)} shapes, Pinocchio has {len(theirs)}")
            continue
        for shape, g in zip(ours, theirs):
            kind, size = sizes.get(type(g.geometry).__name__, ("mesh", lambda _, g=g: g.meshScale))
            pose = model.frames[g.parentFrame].placement.inverse() * g.placement
            compare_shape(out, link["name"], shape, kind, size(g.geometry), pose.rotation, pose.translation)


def add_packages(packages, path):
    """The folders of $ROS_PACKAGE_PATH that a file names as packages."""
    names = set(re.findall(r"(?:package|model)://([^/\"<]+)/", path.read_text(errors="replace")))
    if "<include>" in path.read_text(errors="replace"):  # whatever those include
        names.update(p.name for x in os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep) if x for p in pathlib.Path(x).iterdir())
    for folder in [pathlib.Path(x) for x in os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep) if x]:
        found = {name: folder / name for name in names if (folder / name).is_dir()}
        if names - found.keys():  # a folder may have another name than its package
            for package in [p for depth in ("", "*/", "*/*/") for p in folder.glob(depth + "package.xml")]:
                name = re.search(r"<name>\s*(\S+?)\s*</name>", package.read_text(errors="replace"))
                if name and name[1] in names:
                    found.setdefault(name[1], package.parent)
        for name, place in sorted(found.items()):
            if packages.Contains(name):  # drake_models would be fetched
                packages.Remove(name)
            packages.Add(name, str(place))


def of_model(plant, name):
    """The model that is nested as "a::b" says, and the name in it."""
    from pydrake.multibody.tree import ModelInstanceIndex
    *models, inside = name.split("::")
    first = min((plant.GetModelInstanceName(ModelInstanceIndex(i)) for i in range(2, plant.num_model_instances())), key=len)
    whole = "::".join([first, *models])
    return (plant.GetModelInstanceByName(whole), inside) if plant.HasModelInstanceNamed(whole) else (None, inside)


def drake_body(plant, name):
    model, inside = of_model(plant, name)
    if name == "world" or model is None or not plant.HasBodyNamed(inside, model):
        return None
    return plant.GetBodyByName(inside, model)


def compare_drake(path, read):
    """@throws NotLoaded"""
    import logging
    logging.disable(logging.CRITICAL)
    out = Compared()
    if path.suffix == ".urdf" and ET.parse(path).getroot().get("version", "1.0") not in ("1", "1.0"):
        raise NotLoaded("Drake 1.51 reads URDF 1.0 only, and passes over what is new")
    try:
        from pydrake.multibody.parsing import Parser
        from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
        from pydrake.systems.framework import DiagramBuilder
        builder = DiagramBuilder()
        plant, scene = AddMultibodyPlantSceneGraph(builder, 0.0)
        parser = Parser(plant)
        add_packages(parser.package_map(), path)
        parser.AddModels(str(path))
        plant.Finalize()
    except (ImportError, RuntimeError) as error:
        raise NotLoaded(str(error)) from error
    if "error" in read or read["unmodelled"] or plant.num_model_instances() < 3:
        return out
    context = plant.CreateDefaultContext()
    for configuration in read["configurations"]:
        for name, q in values_of(read, configuration).items():
            # Drake has a joint in the model of its child.
            named = [plant.get_joint(j) for j in plant.GetJointIndices() if plant.get_joint(j).name() == name.split("::")[-1]]
            if len(named) > 1:
                models = name.split("::")[:-1]
                named = [joint for joint in named
                         if plant.GetModelInstanceName(joint.model_instance()).split("::")[1:len(models) + 1] == models]
            if len(named) != 1:
                out.fault(f"Drake has {len(named)} joints {name}")
                return out
            joint = named[0]
            if joint.num_positions() != 1:
                out.fault(f"Drake's joint {name} has {joint.num_positions()} positions")
                return out
            (joint.set_angle if hasattr(joint, "set_angle") else joint.set_translation)(context, q)
        first = None
        for link, ours in zip(read["links"], configuration["poses"]):
            body = drake_body(plant, link["name"])
            if body is None:
                continue
            theirs = plant.EvalBodyPoseInWorld(context, body).GetAsMatrix4()
            here = np.eye(4)
            here[:3, :3], here[:3, 3] = np.reshape(ours[:9], (3, 3)), ours[9:]
            if first is None:
                first = np.linalg.inv(theirs), np.linalg.inv(here)
            out.off(np.abs(first[0] @ theirs - first[1] @ here).max())
    compare_drake_shapes(read, plant, scene.model_inspector(), out)
    return out


def compare_drake_shapes(read, plant, inspector, out):
    sizes = {"Box": ("box", lambda s: s.size()), "Sphere": ("sphere", lambda s: [s.radius()]),
             "Cylinder": ("cylinder", lambda s: [s.radius(), s.length()]), "Capsule": ("capsule", lambda s: [s.radius(), s.length()]),
             "Ellipsoid": ("ellipsoid", lambda s: [s.a(), s.b(), s.c()]), "Mesh": ("mesh", lambda s: s.scale3()),
             "Convex": ("mesh", lambda s: s.scale3())}
    for link in read["links"]:
        body = drake_body(plant, link["name"])
        if body is None:
            continue
        geometries = plant.GetCollisionGeometriesForBody(body)
        if len(geometries) != len(link["collision"]):
            out.fault(f"{link['name']}: {len(link['collision'])} shapes, Drake has {len(geometries)}")
            continue
        for shape, g in zip(link["collision"], geometries):
            theirs = inspector.GetShape(g)
            kind, size = sizes[type(theirs).__name__]
            pose = inspector.GetPoseInFrame(g)
            compare_shape(out, link["name"], shape, kind, size(theirs), pose.rotation().matrix(), pose.translation())


COMPARE = {"mujoco": compare_mujoco, "pinocchio": compare_pinocchio, "drake": compare_drake}


def load(engine, path, read):
    """What an engine makes of a robot, for tables."""
    try:
        out = COMPARE[engine](path, read)
    except NotLoaded as error:
        return {"loaded": False, "why": str(error).strip().replace("\n", " ")[:300]}
    return {"loaded": True, "worst": out.worst, "shapes": out.shapes, "faults": out.faults}


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
            for engine, suffixes in (("mujoco", (".xml",)), ("pinocchio", (".urdf",)), ("drake", (".sdf", ".urdf"))):
                if path.suffix not in suffixes:
                    continue
                answer = load(engine, path, read)
                compared[engine] += answer["loaded"]
                if path in own and not answer["loaded"] and "1.0 only" not in answer["why"]:
                    fail(path, f"{engine} does not load it: {answer['why']}")
                for fault in answer.get("faults", []):
                    fail(path, f"{engine}: {fault}")
                if (answer.get("worst") or 0) > TOLERANCE:
                    fail(path, f"links are {answer['worst']} away from where {engine} has them")
        check_written(own[0], tools, fail)
        check_written(own[4], tools, fail)
    print("compared:", ", ".join(f"{n} with {engine}" for engine, n in compared.items()))
    return 1 if fail.count else 0


if __name__ == "__main__":
    sys.exit(main())
