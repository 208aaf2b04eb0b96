#!/usr/bin/env python3
"""What is written of robots, loaded and simulated by the engines of today: MuJoCo, Drake, Pinocchio with Coal, PyBullet.

usage: simulated.py ROBOT_POSES BIN

Robots are made here, and decomposed. Every engine must have the bodies that were written, each with its vertices where they
belong, and links where they are by our own kinematics, at 100 configurations. Then a humanoid stands on its new feet for 5 s,
and a gripper holds a box for 5 s, as both did before.
Run by the Python of `scripts/setup --engines`; an engine that is not there is named; exit code 77 where there is no MuJoCo.
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

try:
    import mujoco
    import numpy as np
except ImportError:
    print("simulated.py: skipped: no MuJoCo here; scripts/setup --engines", file=sys.stderr)
    sys.exit(77)

from checks import check, exit_code, failures  # noqa: E402

SECONDS = 5
POSES = 1e-9       # how far engines' kinematics may be apart [m, -]
VERTICES = 2e-6    # float32 coordinates of parts below 1 m; engines drop vertices that are no corners [m]


# --- robots ---

def boxes_obj(*boxes):
    """Boxes (min, max) as an OBJ of closed parts."""
    text, base = "", 0
    for low, high in boxes:
        for k in range(8):
            text += "v " + " ".join(str((high if k >> i & 1 else low)[i]) for i in range(3)) + "\n"
        for a, b, c, d in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
            text += f"f {base + a + 1} {base + b + 1} {base + c + 1}\nf {base + a + 1} {base + c + 1} {base + d + 1}\n"
        base += 8
    return text


MESHES = {
    # A sole with a hollow under the arch, and an ankle; a shin with a calf; a torso with shoulders; a finger with a pad.
    "foot": [((-0.08, -0.05, -0.07), (-0.02, 0.05, -0.03)), ((0.06, -0.05, -0.07), (0.16, 0.05, -0.03)),
             ((-0.08, -0.05, -0.045), (0.16, 0.05, -0.02)), ((-0.03, -0.03, -0.03), (0.03, 0.03, 0.02))],
    "shin": [((-0.03, -0.03, -0.3), (0.03, 0.03, 0)), ((-0.06, -0.03, -0.15), (0, 0.03, -0.05))],
    "torso": [((-0.06, -0.1, 0), (0.06, 0.1, 0.35)), ((-0.05, -0.22, 0.3), (0.05, 0.22, 0.36))],
    "finger": [((-0.012, -0.015, -0.12), (0.012, 0.015, 0)), ((-0.03, -0.02, -0.14), (0.01, 0.02, -0.09))],
    "palm": [((-0.1, -0.03, 0), (0.1, 0.03, 0.05)), ((-0.03, -0.03, 0.04), (0.03, 0.03, 0.12))],
}


def geom(mesh):
    return f'<geom type="mesh" mesh="{mesh}" friction="1 0.01 0.001"/>'


def leg(side, y):
    joint = '<joint name="{0}_{1}" axis="{2}" range="-1.5 1.5" armature="0.05"/>'
    return f"""<body name="{side}_thigh" pos="0 {y} 0">{joint.format(side, "hip", "0 1 0")}<inertial pos="0 0 -0.15" mass="2" diaginertia="0.02 0.02 0.005"/>
{geom("shin")}<body name="{side}_shin" pos="0 0 -0.32">{joint.format(side, "knee", "0 1 0")}<inertial pos="0 0 -0.15" mass="2" diaginertia="0.02 0.02 0.005"/>
{geom("shin")}<body name="{side}_foot" pos="0 0 -0.32">{joint.format(side, "ankle", "0 1 0")}<inertial pos="0.03 0 -0.03" mass="1" diaginertia="0.002 0.004 0.004"/>
{geom("foot")}</body></body></body>"""


def assets():
    return "<asset>" + "".join(f'<mesh name="{name}" file="meshes/{name}.obj"/>' for name in MESHES) + "</asset>"


HUMANOID = f"""<mujoco model="humanoid"><compiler angle="radian"/><option timestep="0.002"/>{assets()}
<worldbody><geom name="floor" type="plane" size="5 5 1" friction="1 0.01 0.001"/>
<body name="torso" pos="0 0 0.711"><freejoint/><inertial pos="0 0 0.18" mass="10" diaginertia="0.2 0.15 0.1"/>{geom("torso")}
{leg("left", 0.08)}{leg("right", -0.08)}</body></worldbody>
<contact><exclude body1="torso" body2="left_thigh"/><exclude body1="torso" body2="right_thigh"/></contact>
<actuator>{"".join(f'<position joint="{s}_{j}" kp="300" dampratio="1"/>' for s in ("left", "right") for j in ("hip", "knee", "ankle"))}</actuator>
</mujoco>"""
GRIPPER = f"""<mujoco model="gripper"><compiler angle="radian"/><option timestep="0.002" cone="elliptic" impratio="10"/>{assets()}
<worldbody><geom name="floor" type="plane" size="5 5 1"/>
<body name="palm" pos="0 0 0.5"><inertial pos="0 0 0" mass="1" diaginertia="0.01 0.01 0.01"/>{geom("palm")}
<body name="left" pos="-0.06 0 0"><joint name="left" type="slide" axis="1 0 0" range="0 0.06" damping="5"/><inertial pos="0 0 -0.06" mass="0.2" diaginertia="0.001 0.001 0.001"/>
<geom type="mesh" mesh="finger" euler="0 0 3.141592653589793" friction="1 0.05 0.001"/></body>
<body name="right" pos="0.06 0 0"><joint name="right" type="slide" axis="-1 0 0" range="0 0.06" damping="5"/><inertial pos="0 0 -0.06" mass="0.2" diaginertia="0.001 0.001 0.001"/>
<geom type="mesh" mesh="finger" friction="1 0.05 0.001"/></body></body>
<body name="box" pos="0 0 0.385"><freejoint/><geom name="box" type="box" size="0.025 0.02 0.03" density="800" friction="1 0.05 0.001"/></body></worldbody>
<contact><exclude body1="palm" body2="left"/><exclude body1="palm" body2="right"/></contact>
<actuator><motor joint="left" ctrlrange="0 20"/><motor joint="right" ctrlrange="0 20"/></actuator></mujoco>"""


def urdf(name, links, joints):
    text = f'<robot name="{name}">'
    for link, (mesh, mass, rpy) in links.items():
        text += (f'<link name="{link}"><inertial><origin xyz="0 0 -0.03"/><mass value="{mass}"/>'
                 f'<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial><collision><origin xyz="0 0 0.001" rpy="{rpy}"/>'
                 f'<geometry><mesh filename="meshes/{mesh}.obj"/></geometry></collision></link>')
    for joint, (kind, parent, child, xyz, rpy, axis, lower, upper) in joints.items():
        text += (f'<joint name="{joint}" type="{kind}"><parent link="{parent}"/><child link="{child}"/><origin xyz="{xyz}" rpy="{rpy}"/>'
                 f'<axis xyz="{axis}"/><limit lower="{lower}" upper="{upper}" effort="100" velocity="5"/></joint>')
    return text + "</robot>"


# Rotated joints and axes, for kinematics; a gripper as URDF, for Drake and PyBullet.
ARM = urdf("arm", {"base": ("palm", 2, "0 0 0"), "upper": ("torso", 2, "0.1 0.2 0.3"), "lower": ("shin", 1, "0 0 0"),
                   "hand": ("foot", 0.5, "1 0 0")},
           {"a": ("revolute", "base", "upper", "0 0 0.1", "0.1 0 0.4", "0 0 1", -3, 3),
            "b": ("revolute", "upper", "lower", "0.2 0 0.4", "1 0.5 0", "0 0.6 0.8", -2, 2),
            "c": ("prismatic", "lower", "hand", "0 0.1 -0.3", "0 0 1", "1 0 0", -0.2, 0.3)})
HAND = urdf("hand", {"palm": ("palm", 1, "0 0 0"), "left": ("finger", 0.2, "0 0 3.141592653589793"), "right": ("finger", 0.2, "0 0 0")},
            {"left_slide": ("prismatic", "palm", "left", "-0.06 0 0", "0 0 0", "1 0 0", 0, 0.06),
             "right_slide": ("prismatic", "palm", "right", "0.06 0 0", "0 0 0", "-1 0 0", 0, 0.06)})


def make_robots(place):
    (place / "meshes").mkdir()
    for name, boxes in MESHES.items():
        (place / "meshes" / f"{name}.obj").write_text(boxes_obj(*boxes))
    for name, text in {"humanoid.xml": HUMANOID, "gripper.xml": GRIPPER, "arm.urdf": ARM, "hand.urdf": HAND}.items():
        (place / name).write_text(text)


def decompose(tools, robot, out, *more):
    done = subprocess.run([str(tools / "bcd-decompose"), str(robot), "-o", str(out), "--epsilon", "5mm", "--effort", "fast", "--quiet", *more],
                          capture_output=True, text=True, check=False)
    check(done.returncode == 0, f"bcd-decompose {robot.name} {more}: exit code {done.returncode}: {done.stderr[-300:]}")
    verified = subprocess.run([str(tools / "bound-verify"), "robot", str(robot), str(out / robot.name), "--prepare", "--quiet"]
                              + [m for m in more if m == "--visual"], capture_output=True, text=True, check=False)
    check(verified.returncode == 0, f"bound-verify {robot.name} {more}: exit code {verified.returncode}: {verified.stderr[-300:]}")
    return out / robot.name


# --- what was written, read here ---

def read_mesh(path):
    """Vertices of an STL (binary) or OBJ, and its volume."""
    if path.suffix == ".obj":
        vertices, faces = [], []
        for line in path.read_text().splitlines():
            word = line.split()
            if word and word[0] == "v":
                vertices.append([float(x) for x in word[1:4]])
            if word and word[0] == "f":
                faces.append([int(x.split("/")[0]) - 1 for x in word[1:]])
        corners = np.array([[vertices[f[0]], vertices[f[k]], vertices[f[k + 1]]] for f in faces for k in range(1, len(f) - 1)])
    else:
        data = path.read_bytes()
        count = int.from_bytes(data[80:84], "little")
        kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
        corners = np.frombuffer(data, kind, count, 84)["corners"].astype(float)
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    return np.unique(corners.reshape(-1, 3), axis=0), volume


def rotation(rpy):
    (sr, sp, sy), (cr, cp, cy) = np.sin(rpy), np.cos(rpy)
    return np.array([[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                     [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr], [-sp, cp * sr, cp * cr]])


def bodies_of_urdf(path):
    """By link: vertices in its frame and volume of each body."""
    out = {}
    for link in ElementTree.parse(path).getroot().findall("link"):
        out[link.get("name")] = []
        for collision in link.findall("collision"):
            origin = collision.find("origin")
            rpy, xyz = ([float(x) for x in origin.get(key, "0 0 0").split()] for key in ("rpy", "xyz"))
            vertices, volume = read_mesh(path.parent / collision.find("geometry/mesh").get("filename"))
            out[link.get("name")].append((vertices @ rotation(rpy).T + xyz, volume))
    return out


def distance_of_hulls(a, b):
    """The farthest that either hull reaches beyond the other, in many directions and those of the axes."""
    directions = np.vstack([np.eye(3), np.random.default_rng(2).normal(size=(2000, 3))])
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    directions = np.vstack([directions, -directions])
    return np.abs((np.asarray(a) @ directions.T).max(axis=0) - (np.asarray(b) @ directions.T).max(axis=0)).max()


def compare_bodies(engine, robot, link, ours, theirs):
    """@param theirs  vertices and volume (or None) of each body, in any order"""
    check(len(ours) == len(theirs), f"{engine}: {robot}: {link}: {len(theirs)} bodies, {len(ours)} were written")
    left = list(theirs)
    for vertices, volume in ours:
        apart = [distance_of_hulls(vertices, other[0]) for other in left]
        found = [k for k, distance in enumerate(apart) if distance <= VERTICES]
        check(bool(found), f"{engine}: {robot}: {link}: a body is not where it was written, but {min(apart, default=math.inf)} away")
        if found:
            other = left.pop(found[0])[1]
            check(other is None or abs(other - volume) <= 1e-5 * volume, f"{engine}: {robot}: {link}: a volume of {other}, {volume} was written")


# --- engines: bodies and kinematics ---

def random_configurations(lower, upper):
    random = np.random.default_rng(1)
    return [random.uniform(lower, upper) for _ in range(100)]


def read_poses(program, path):
    return json.loads(subprocess.run([program, str(path)], capture_output=True, text=True, check=True).stdout)[str(path)]


def matrix(ours):
    out = np.eye(4)
    out[:3, :3], out[:3, 3] = np.reshape(ours[:9], (3, 3)), ours[9:]
    return out


def with_mujoco(path, bodies, read):
    """The MJCF that was written beside a URDF."""
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    for link, ours in bodies.items():
        body, theirs = model.body(link).id, []
        for g in range(model.ngeom):
            if model.geom_bodyid[g] != body or model.geom_type[g] != mujoco.mjtGeom.mjGEOM_MESH:
                continue
            mesh, r = model.geom_dataid[g], np.zeros(9)
            first = model.mesh_vertadr[mesh]
            mujoco.mju_quat2Mat(r, model.geom_quat[g])
            vertices = model.mesh_vert[first:first + model.mesh_vertnum[mesh]].astype(float)
            theirs.append((vertices @ r.reshape(3, 3).T + model.geom_pos[g], None))
        compare_bodies("MuJoCo", path.name, link, ours, theirs)
    worst = 0
    for configuration in read["configurations"]:
        for variable, q in zip(read["variables"], configuration["q"]):
            data.qpos[model.joint(variable["name"]).qposadr[0]] = q
        mujoco.mj_kinematics(model, data)
        for link, pose in zip(read["links"], configuration["poses"]):
            body = model.body(link["name"]).id
            worst = max(worst, np.abs(matrix(pose)[:3, 3] - data.xpos[body]).max(), np.abs(matrix(pose)[:3, :3] - data.xmat[body].reshape(3, 3)).max())
    check(worst <= POSES, f"MuJoCo: {path.name}: links are {worst} away")
    return len(read["configurations"])


def with_pinocchio(path, bodies, read):
    import pinocchio
    model = pinocchio.buildModelFromUrdf(str(path))
    shapes = pinocchio.buildGeomFromUrdf(model, str(path), pinocchio.GeometryType.COLLISION, None, [str(path.parent)])
    for link, ours in bodies.items():
        frame = model.getFrameId(link)
        at = pinocchio.SE3(model.frames[frame].placement)
        theirs = []
        for g in shapes.geometryObjects:
            if g.parentFrame != frame:
                continue
            vertices = np.array([g.geometry.vertex(k) for k in range(g.geometry.num_vertices)]).reshape(-1, 3)
            pose = at.inverse() * g.placement
            theirs.append((vertices @ pose.rotation.T + pose.translation, abs(g.geometry.computeVolume())))
        compare_bodies("Coal", path.name, link, ours, theirs)
    data, worst = model.createData(), 0
    for configuration in read["configurations"]:
        q = pinocchio.neutral(model)
        for variable, value in zip(read["variables"], configuration["q"]):
            q[model.joints[model.getJointId(variable["name"])].idx_q] = value
        pinocchio.framesForwardKinematics(model, data, q)
        for link, pose in zip(read["links"], configuration["poses"]):
            worst = max(worst, np.abs(data.oMf[model.getFrameId(link["name"])].homogeneous - matrix(pose)).max())
    check(worst <= POSES, f"Pinocchio: {path.name}: links are {worst} away")
    return len(read["configurations"])


def drake_plant(step):
    import logging
    logging.disable(logging.CRITICAL)
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
    from pydrake.systems.framework import DiagramBuilder
    builder = DiagramBuilder()
    plant, scene = AddMultibodyPlantSceneGraph(builder, step)
    return builder, plant, scene


def with_drake(path, bodies, read):
    from pydrake.geometry import Role
    from pydrake.multibody.parsing import Parser
    _, plant, scene = drake_plant(0.0)
    Parser(plant).AddModels(str(path))
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName(read["links"][0]["name"]))
    plant.Finalize()
    inspector = scene.model_inspector()
    for link, ours in bodies.items():
        frame = plant.GetBodyFrameIdOrThrow(plant.GetBodyByName(link).index())
        theirs = []
        for g in inspector.GetGeometries(frame, Role.kProximity):
            hull, pose = inspector.GetShape(g).GetConvexHull(), inspector.GetPoseInFrame(g)
            vertices = np.array([hull.vertex(k) for k in range(hull.num_vertices())])
            theirs.append((vertices @ pose.rotation().matrix().T + pose.translation(), hull.CalcVolume() if hasattr(hull, "CalcVolume") else None))
        compare_bodies("Drake", path.name, link, ours, theirs)
    context, worst = plant.CreateDefaultContext(), 0
    for configuration in read["configurations"]:
        for variable, q in zip(read["variables"], configuration["q"]):
            joint = plant.GetJointByName(variable["name"])
            (joint.set_angle if hasattr(joint, "set_angle") else joint.set_translation)(context, q)
        for link, pose in zip(read["links"], configuration["poses"]):
            theirs = plant.EvalBodyPoseInWorld(context, plant.GetBodyByName(link["name"])).GetAsMatrix4()
            worst = max(worst, np.abs(theirs - matrix(pose)).max())
    check(worst <= POSES, f"Drake: {path.name}: links are {worst} away")
    return len(read["configurations"])


def with_pybullet(path, bodies, read):
    """Its importer keeps poses in float32 in places, adds 1 mm round hulls, and rounds vertices: boxes are compared within that."""
    import pybullet
    client = pybullet.connect(pybullet.DIRECT)
    try:
        robot = pybullet.loadURDF(str(path), useFixedBase=True, physicsClientId=client)
        index = {pybullet.getBodyInfo(robot)[0].decode(): -1}
        joints = {}
        for j in range(pybullet.getNumJoints(robot)):
            info = pybullet.getJointInfo(robot, j)
            index[info[12].decode()], joints[info[1].decode()] = j, j
        worst = 0
        for configuration in read["configurations"]:
            for variable, q in zip(read["variables"], configuration["q"]):
                pybullet.resetJointState(robot, joints[variable["name"]], q)
            base = None
            for link, pose in zip(read["links"], configuration["poses"]):
                k = index[link["name"]]
                if k < 0:
                    base = matrix(pose)
                    inertial = pybullet.getDynamicsInfo(robot, -1)[3:5]
                    at = pybullet.multiplyTransforms(*pybullet.getBasePositionAndOrientation(robot), *pybullet.invertTransform(*inertial))
                else:
                    at = pybullet.getLinkState(robot, k, computeForwardKinematics=True)[4:6]
                theirs = np.eye(4)
                theirs[:3, :3], theirs[:3, 3] = np.reshape(pybullet.getMatrixFromQuaternion(at[1]), (3, 3)), at[0]
                if k < 0:
                    shift = base @ np.linalg.inv(theirs)
                worst = max(worst, np.abs(shift @ theirs - matrix(pose)).max())
                if configuration is not read["configurations"][0]:
                    continue
                shapes = pybullet.getCollisionShapeData(robot, k)
                check(len(shapes) == len(bodies[link["name"]]), f"PyBullet: {path.name}: {link['name']}: {len(shapes)} bodies, {len(bodies[link['name']])} were written")
                points = np.vstack([v for v, _ in bodies[link["name"]]]) @ theirs[:3, :3].T + theirs[:3, 3]
                low, high = pybullet.getAABB(robot, k)
                low, high = points.min(axis=0) - low, np.array(high) - points.max(axis=0)
                check(min(low.min(), high.min()) > -1e-4 and max(low.max(), high.max()) < 0.25 * np.ptp(points, axis=0).max(),
                      f"PyBullet: {path.name}: {link['name']}: its box is {low}, {high} beyond the bodies")
        check(worst <= 1e-6, f"PyBullet: {path.name}: links are {worst} away")
        return len(read["configurations"])
    finally:
        pybullet.disconnect(client)


# --- simulations ---

def simulate(path, control):
    """@return the model, its state, and the largest |velocity| on the way"""
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    if model.nkey and control is None:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    elif control is not None:
        data.ctrl[:] = control
    fastest = 0
    while data.time < SECONDS and not any(w.number for w in data.warning):
        mujoco.mj_step(model, data)
        fastest = max(fastest, np.abs(data.qvel).max())
    check(np.isfinite(data.qpos).all() and not any(w.number for w in data.warning), f"MuJoCo: {path}: it explodes")
    return model, data, fastest


def stands(path, base, control, tolerance):
    """Whether a base is as high after 5 s, and as upright."""
    model = mujoco.MjModel.from_xml_path(str(path))
    first = mujoco.MjData(model)
    if model.nkey and control is None:
        mujoco.mj_resetDataKeyframe(model, first, 0)
    mujoco.mj_kinematics(model, first)
    body = model.body(base).id
    before, up = first.xpos[body].copy(), first.xmat[body].reshape(3, 3)[:, 2].copy()
    _, data, _ = simulate(path, control)
    fallen, lean = before[2] - data.xpos[body][2], math.acos(min(1, max(-1, float(up @ data.xmat[body].reshape(3, 3)[:, 2]))))
    check(abs(fallen) < tolerance and lean < 0.1, f"MuJoCo: {path}: {base} is {fallen} m lower, and leans by {lean}")
    return fallen


def contacts_of(path, control, one):
    """Names of bodies that touch a body in the end."""
    model, data, _ = simulate(path, control)
    body, out = model.body(one).id, set()
    for c in data.contact:
        pair = [model.geom_bodyid[g] for g in c.geom]
        if body in pair:
            out.add(model.body(pair[1 - pair.index(body)]).name)
    return out, data.body(one).xpos.copy()


def hold_with_mujoco(path):
    touching, at = contacts_of(path, 12, "box")
    check(touching == {"left", "right"} and abs(at[2] - 0.385) < 0.005, f"MuJoCo: {path}: the box is at {at}, touched by {touching}")


BOX = """<robot name="box"><link name="box"><inertial><mass value="0.1"/><inertia ixx="5e-5" iyy="5e-5" izz="4e-5" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size="0.05 0.04 0.06"/></geometry><drake:proximity_properties xmlns:drake="http://drake.mit.edu"><drake:mu_dynamic value="1"/>
<drake:mu_static value="1"/></drake:proximity_properties></collision></link></robot>"""


def hold_with_drake(path):
    from pydrake.geometry import DefaultProximityProperties, SceneGraphConfig
    from pydrake.math import RigidTransform
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import ContactModel, DiscreteContactApproximation
    from pydrake.systems.analysis import Simulator
    from pydrake.systems.primitives import ConstantVectorSource
    # By areas of contact: by one point for each two bodies, the box would turn about the line between the fingers.
    builder, plant, scene = drake_plant(0.002)
    scene.set_config(SceneGraphConfig(default_proximity_properties=DefaultProximityProperties(compliance_type="compliant")))
    plant.set_contact_model(ContactModel.kHydroelasticWithFallback)
    plant.set_discrete_contact_approximation(DiscreteContactApproximation.kLagged)
    Parser(plant).AddModels(str(path))
    Parser(plant).AddModelsFromString(BOX, "urdf")
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName("palm"), RigidTransform([0, 0, 0.5]))
    plant.Finalize()
    box, forces = plant.GetBodyByName("box"), np.zeros(plant.num_velocities())
    for joint in ("left_slide", "right_slide"):
        forces[plant.GetJointByName(joint).velocity_start()] = 12
    builder.Connect(builder.AddSystem(ConstantVectorSource(forces)).get_output_port(), plant.get_applied_generalized_force_input_port())
    diagram = builder.Build()
    simulator = Simulator(diagram)
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    plant.SetFreeBodyPose(context, box, RigidTransform([0, 0, 0.385]))
    # Nearly closed already, so that the box has not fallen before it is held.
    for joint in ("left_slide", "right_slide"):
        plant.GetJointByName(joint).set_translation(context, 0.0045)
    simulator.AdvanceTo(SECONDS)
    at = plant.EvalBodyPoseInWorld(context, box).translation()
    check(np.isfinite(at).all() and abs(at[2] - 0.385) < 0.005, f"Drake: {path}: the box is at {at}")


def hold_with_pybullet(path):
    import pybullet
    client = pybullet.connect(pybullet.DIRECT)
    try:
        pybullet.setGravity(0, 0, -9.81)
        hand = pybullet.loadURDF(str(path), [0, 0, 0.5], useFixedBase=True)
        # The base's position is that of its centre of mass.
        at = pybullet.getBasePositionAndOrientation(hand)[0][2]
        palm = at - pybullet.getDynamicsInfo(hand, -1)[3][2]
        shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=[0.025, 0.02, 0.03])
        box = pybullet.createMultiBody(0.1, shape, basePosition=[0, 0, palm - 0.115])
        for body, link in ((hand, 0), (hand, 1), (box, -1)):
            pybullet.changeDynamics(body, link, lateralFriction=1, spinningFriction=0.01)
        for j in range(pybullet.getNumJoints(hand)):
            pybullet.resetJointState(hand, j, 0.003)
            pybullet.setJointMotorControl2(hand, j, pybullet.POSITION_CONTROL, targetPosition=0.06, force=12)
        for _ in range(240 * SECONDS):
            pybullet.stepSimulation()
        height = pybullet.getBasePositionAndOrientation(box)[0][2]
        check(math.isfinite(height) and abs(height - palm + 0.115) < 0.01, f"PyBullet: {path}: the box is at {height}, {palm - 0.115} is where it was")
    finally:
        pybullet.disconnect(client)


def main():
    program, tools = sys.argv[1], pathlib.Path(sys.argv[2]).absolute()
    engines = {"Pinocchio with Coal": with_pinocchio, "Drake": with_drake, "PyBullet": with_pybullet}
    with tempfile.TemporaryDirectory() as place:
        place = pathlib.Path(place)
        make_robots(place)
        for name in ("arm", "hand"):
            written = decompose(tools, place / f"{name}.urdf", place / f"out_{name}", "--robot-format", "mjcf", "--for", "drake")
            bodies, read = bodies_of_urdf(written), read_poses(program, written)
            print(f"{name}: {sum(len(b) for b in bodies.values())} bodies; MuJoCo: {with_mujoco(written.with_suffix('.xml'), bodies, read)} configurations")
            for engine, compare in engines.items():
                try:
                    print(f"{name}: {engine}: {compare(written, bodies, read)} configurations")
                except ImportError as error:
                    print(f"skipped: no {engine}: {error}")
        before = stands(place / "humanoid.xml", "torso", 0, 0.02)
        after = stands(decompose(tools, place / "humanoid.xml", place / "out_humanoid"), "torso", 0, 0.02)
        check(abs(before - after) < 0.01, f"the humanoid stands {before - after} m higher than before")
        print(f"humanoid: {before:.4f} m lower before, {after:.4f} m with its new feet")
        hold_with_mujoco(place / "gripper.xml")
        hold_with_mujoco(decompose(tools, place / "gripper.xml", place / "out_gripper"))
        for engine, hold in (("Drake", hold_with_drake), ("PyBullet", hold_with_pybullet)):
            try:
                before = len(failures)
                hold(place / "out_hand" / "hand.urdf")
                print(f"gripper: {engine} {'holds' if len(failures) == before else 'does NOT hold'} the box")
            except ImportError as error:
                print(f"skipped: no {engine}: {error}")
    return exit_code()


if __name__ == "__main__":
    sys.exit(main())
