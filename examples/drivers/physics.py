#!/usr/bin/env python3
"""A robot driver whose robots are simulated by MuJoCo: arms follow trajectories by torques, things fall, slip and collide.

    kaboum-plan run ... --robot 'python3 physics.py --scene cell.json --robot arm=arm.xml --measure "isSpillable=weight>0.3"'

A robot is the MJCF that `bcd-decompose ROBOT.urdf --robot-format mjcf` writes; things of the scene are the convex bodies of their
sets. What has grasps in the scene can move; the rest stands still. What is taken is held by a suction cup, which takes nothing
farther than --reach metres, pulls it to where the plan holds it (a weld, not friction), and sets it down before it lets go. A gripper with
joints closes its fingers with its force, and holds by contact and friction of its pads alone. A part that is let go where it touches
one that another robot holds sits on that. --report FILE.json has what went otherwise
than planned: how far joints were from where they were told to be, contacts that the plan does not know, how far things end from where the
plan has them. --log FILE.jsonl has samples of all joints and poses, --film DIRECTORY pictures.

docs/planning/drivers.md says what the lines are. Needs the Python packages mujoco and numpy (scripts/setup --engines).
"""
import argparse
import json
import math
import os
import pathlib
import re
import struct
import sys
import zlib

if "DISPLAY" not in os.environ:
    os.environ.setdefault("MUJOCO_GL", "egl")  # pictures without a screen

import mujoco
import numpy as np

try:
    from kaboum.driver import Driver, Failure
except ImportError:  # in a checkout: the file itself, which needs nothing else
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python/kaboum"))
    from driver import Driver, Failure

STEP = 0.002        # of the simulation [s]
FINE = 0.001        # likewise, with fingers that hold by friction [s]
HARD, FIRM = 4, 0.99  # of contacts of pads: their time constant in steps, and MuJoCo's largest impedance
SAMPLED = 5         # steps between samples of what was executed
STIFF = 100.0       # of the control of joints: it corrects with this frequency, critically damped [rad/s]
ROTOR = 0.5         # inertia of motors behind their gears [kg m², or kg]
SETTLE = 0.5        # things come to rest before it begins, and after each release [s]
TRACKED = 2e-3      # a motion has ended when all joints are so near [rad or m]
DOWN = 0.03         # how fast things are set down [m/s]
FIT = 2e-3          # a part that is let go so near to one that another robot holds sits on it, as in a press fit [m]
DEEP = 5e-4         # contacts deeper than that are told [m]
CLOSING = 0.3       # the force of fingers that close grows for so long [s]
FINGER = 20000.0    # stiffness of fingers that hold nothing [N/m]
DAMPING = 500.0     # of fingers [N s/m]
SLOW = 1e-3         # fingers stand that are slower [m/s]
PAD = (1.0, 0.01, 0.001)  # friction of pads: sliding, torsional [m], rolling [m]
GRAVITY = 9.81
COLOURS = ((0.85, 0.35, 0.25), (0.25, 0.5, 0.8), (0.35, 0.65, 0.35), (0.85, 0.65, 0.2), (0.55, 0.4, 0.7))


def bodies_of_set(file):
    """Corners of the convex bodies of a set in GLB."""
    data = pathlib.Path(file).read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    scene, binary = json.loads(data[20:20 + length]), data[28 + length:]
    out = []
    for mesh in scene["meshes"]:
        for part in mesh["primitives"]:
            accessor = scene["accessors"][part["attributes"]["POSITION"]]
            view = scene["bufferViews"][accessor["bufferView"]]
            at = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
            stride = view.get("byteStride", 12)
            out.append([struct.unpack_from("<3f", binary, at + stride * i) for i in range(accessor["count"])])
    return out


def write_png(file, picture):
    """Rows of pixels of three bytes."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    height, width = picture.shape[:2]
    rows = b"".join(b"\0" + row.tobytes() for row in picture)
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def quaternion(matrix):
    out = np.zeros(4)
    mujoco.mju_mat2Quat(out, np.asarray(matrix, float).reshape(9))
    return out


def of_rpy(rpy):
    (sr, cr), (sp, cp), (sy, cy) = ((math.sin(a), math.cos(a)) for a in rpy)
    return quaternion([[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                       [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr], [-sp, cp * sr, cp * cr]])


def relative(a_at, a_turn, b_at, b_turn):
    """Pose of b in the frame of a: place and quaternion."""
    back, turn, place = np.zeros(4), np.zeros(4), np.zeros(3)
    mujoco.mju_negQuat(back, a_turn)
    mujoco.mju_rotVecQuat(place, np.asarray(b_at) - np.asarray(a_at), back)
    mujoco.mju_mulQuat(turn, back, b_turn)
    return place, turn


def composed(a_at, a_turn, at, turn):
    place, out = np.zeros(3), np.zeros(4)
    mujoco.mju_rotVecQuat(place, at, a_turn)
    mujoco.mju_mulQuat(out, a_turn, turn)
    return np.asarray(a_at) + place, out


def angle_between(a, b):
    return 2 * math.acos(min(1.0, abs(float(np.dot(a, b)))))


class World:
    """Robots and things in MuJoCo, and beside them what the plan takes them to be."""

    def __init__(self, options, robots, objects):
        """Robots and objects as kaboum-plan says them when it begins."""
        self.options = options
        scene_file = pathlib.Path(options.scene)
        scene = json.loads(scene_file.read_text())
        spec = mujoco.MjSpec()
        with_fingers = any(g.get("joints") for robot in scene["robots"] for g in robot.get("grippers", []))
        self.dt = FINE if with_fingers else STEP
        spec.option.timestep, spec.option.gravity = self.dt, [0, 0, -GRAVITY]
        spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        spec.add_texture(name="sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, builtin=mujoco.mjtBuiltin.mjBUILTIN_FLAT, rgb1=[1, 1, 1], rgb2=[1, 1, 1],
                         width=32, height=32 * 6)
        spec.visual.headlight.diffuse, spec.visual.headlight.ambient = [0.6] * 3, [0.3] * 3
        spec.worldbody.add_light(pos=[0, 0, 3], dir=[0, 0, -1], diffuse=[0.5, 0.5, 0.5])
        spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        files = dict(text.split("=", 1) for text in options.robot)
        self.robots = {}
        for robot in scene["robots"]:
            name = robot["name"]
            if name not in files:
                raise Failure(f"robot '{name}' has no --robot {name}=FILE.xml")
            arm = mujoco.MjSpec.from_file(files[name])
            arm.compiler.boundmass, arm.compiler.boundinertia = 0.05, 1e-4
            fingers = {joint for gripper in robot.get("grippers", []) for joint in gripper.get("joints", [])}
            fingers |= {e.name1 for e in arm.equalities if e.type == mujoco.mjtEq.mjEQ_JOINT and e.name2 in fingers}
            pads = {pad for gripper in robot.get("grippers", []) if gripper.get("joints") for pad in gripper["pads"]}
            for joint in arm.joints:
                joint.armature = ROTOR
                if joint.name in fingers:
                    joint.armature = 0.2 * ROTOR
                    joint.damping = np.full_like(joint.damping, DAMPING) if np.ndim(joint.damping) else DAMPING
            for body in arm.bodies:
                for geom in body.geoms if body.name in pads else ():
                    geom.friction, geom.condim, geom.priority = PAD, 4, 1
                    geom.solref[:], geom.solimp[:3] = (HARD * self.dt, 1), (0.95, FIRM, 0.0005)
            if pads:  # that what they hold creeps is an artefact of soft contacts
                spec.option.impratio, spec.option.noslip_iterations = 10, 5
                if hasattr(mujoco.mjtEnableBit, "mjENBL_MULTICCD"):  # later versions have it on
                    spec.option.enableflags |= mujoco.mjtEnableBit.mjENBL_MULTICCD
            base = robot.get("base", {})
            frame = spec.worldbody.add_frame(pos=base.get("position", [0, 0, 0]), quat=of_rpy(base.get("rpy", [0, 0, 0])))
            spec.attach(arm, prefix=name + "/", frame=frame)
            self.robots[name] = robots[name]["joint_names"]
        links = {name: [b.name for b in spec.bodies if b.name.startswith(name + "/")] for name in self.robots}
        self.things = []
        sets = dict(text.split("=", 1) for text in options.set)
        masses = dict(text.split("=", 1) for text in options.mass)
        for thing in scene["objects"]:
            name, where = thing["name"], objects.get(thing["name"])
            if not isinstance(where, dict) or "pose" not in where:
                raise Failure(f"'{name}' does not stand anywhere when it begins")
            pose, free = np.array(where["pose"], float), bool(thing.get("grasps"))
            body = spec.worldbody.add_body(name=name, pos=pose[:, 3], quat=quaternion(pose[:, :3]))
            parts = bodies_of_set(sets.get(name, scene_file.parent / thing["outer"]["file"]))
            for i, corners in enumerate(parts):
                mesh = spec.add_mesh(name=f"{name}#{i}")
                mesh.uservert = np.array(corners, np.float32).reshape(-1)
                mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
                geom = body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=mesh.name, friction=[0.8, 0.01, 0.001])
                geom.density = 500
                geom.rgba = [*COLOURS[len(self.things) % len(COLOURS)], 1] if free else [0.55, 0.5, 0.45, 1]
                if name in masses:
                    geom.mass = float(masses[name]) / len(parts)
            if free:
                body.add_freejoint()
                self.things.append(name)
        for robot, names in links.items():
            for link in names:
                for thing in self.things:
                    weld = spec.add_equality(name=f"{link}+{thing}", type=mujoco.mjtEq.mjEQ_WELD, objtype=mujoco.mjtObj.mjOBJ_BODY,
                                             name1=link, name2=thing, active=False)
                    weld.solref[0] = 0.02
        self.model = spec.compile()
        self.owner = [self._owner(i) for i in range(self.model.ngeom)]
        self.held, self.held_by_plan, self.leaving = {}, {}, set()
        self._separate()
        self.data, self.plan = mujoco.MjData(self.model), mujoco.MjData(self.model)
        self.dofs, self.places = {}, {}
        for name, joints in self.robots.items():
            ids = [self.model.joint(f"{name}/{joint}").id for joint in joints]
            self.places[name] = np.array([self.model.jnt_qposadr[i] for i in ids])
            self.dofs[name] = np.array([self.model.jnt_dofadr[i] for i in ids])
        self._find_fingers(scene)
        self.target = {name: (np.array(robots[name]["q"], float), 0.0, 0.0) for name in self.robots}
        # Nobody has put them down exactly there.
        random = np.random.default_rng(options.seed)
        for thing in self.things:
            start = self.model.jnt_qposadr[self.model.body_jntadr[self.model.body(thing).id]]
            self.data.qpos[start:start + 2] += options.disturb * random.uniform(-1, 1, 2) / math.sqrt(2)
        for data in (self.data, self.plan):
            for name in self.robots:
                data.qpos[self.places[name]] = self.target[name][0]
            self._mimic(data)
            mujoco.mj_forward(self.model, data)
        self.time, self.farthest, self.contacts, self.ends = 0.0, 0.0, {}, {}
        self.action, self.samples, self.log, self.renderer, self.frames = "", 0, None, None, 0
        if options.log:
            self.log = open(options.log, "w", encoding="utf-8")
        if options.film:
            pathlib.Path(options.film).mkdir(parents=True, exist_ok=True)
            self.renderer = mujoco.Renderer(self.model, 480, 640)
        self.run(SETTLE)

    def _find_fingers(self, scene):
        """Joints of grippers, each with those that mimic it; links that are pads; what is held by these."""
        m = self.model
        self.fingers, self.pads, self.gripped, self.squeeze, self.parting = {}, {}, {}, {}, set()
        for robot in scene["robots"]:
            name = robot["name"]
            for gripper in robot.get("grippers", []):
                for joint in gripper.get("joints", []):
                    driving = m.joint(f"{name}/{joint}").id
                    moved = [(driving, 1.0)]
                    for e in range(m.neq):
                        if m.eq_type[e] == mujoco.mjtEq.mjEQ_JOINT and m.eq_obj2id[e] == driving:
                            moved.append((m.eq_obj1id[e], float(m.eq_data[e, 1])))
                            m.eq_solref[e] = HARD * self.dt, 1
                    self.fingers[name, joint] = [(int(m.jnt_dofadr[i]), int(m.jnt_qposadr[i]), by) for i, by in moved]
                if gripper.get("joints"):
                    self.pads.setdefault(name, set()).update(m.body(f"{name}/{pad}").id for pad in gripper["pads"])
        driven = {name: {self.fingers[n, j][0][0] for n, j in self.fingers if n == name} for name in self.robots}
        self.of_arm = {name: np.array([d not in driven[name] for d in self.dofs[name]]) for name in self.robots}

    def _mimic(self, data):
        for moved in self.fingers.values():
            for _, place, by in moved[1:]:
                data.qpos[place] = by * data.qpos[moved[0][1]]

    def _finger_forces(self):
        """Fingers that hold push with their force; others are held where they were told to be."""
        d = self.data
        for (robot, joint), moved in self.fingers.items():
            force, since = self.squeeze.get((robot, joint), (None, 0.0))
            told = self.target[robot][0][self.robots[robot].index(joint)]
            for dof, place, by in moved:
                if force is None:
                    pushes = float(np.clip(FINGER * (by * told - d.qpos[place]), -100, 100))
                else:
                    pushes = by * force * min(1.0, (self.time - since) / CLOSING)
                d.qfrc_applied[dof] = pushes + d.qfrc_bias[dof]

    def _separate(self):
        """Which contacts there are: all but those of a robot with itself, which the plan keeps apart, and with what it holds, and
        of things that one robot holds. What was let go counts as held by it until it is apart from it."""
        m, names = self.model, list(self.robots)
        of_robot = {name: 2 << k for k, name in enumerate(names)}
        of_held = {name: 2 << (len(names) + k) for k, name in enumerate(names)}
        robots, held = sum(of_robot.values()), sum(of_held.values())
        for geom in range(m.ngeom):
            owner = self.owner[geom]
            if owner in of_robot:
                m.geom_contype[geom], m.geom_conaffinity[geom] = of_robot[owner], robots & ~of_robot[owner]
                continue
            holders = {robot for robot, thing in self.leaving if thing == owner}
            if owner in self.held:
                holders.add(self.held[owner][0])
            mine = sum(of_robot[r] for r in holders), sum(of_held[r] for r in holders)
            m.geom_contype[geom] = mine[1] or 1
            m.geom_conaffinity[geom] = 1 | (robots & ~mine[0]) | (held & ~mine[1])

    def _part(self):
        """What was let go and is apart from the robot that held it."""
        apart = {(robot, thing) for robot, thing in self.leaving if self.gap(robot, thing, 0.01) > 0}
        if apart:
            self.leaving -= apart
            self._separate()

    def _owner(self, geom):
        name = self.model.body(self.model.geom_bodyid[geom]).name
        return name.split("/", 1)[0] if "/" in name else name

    # --- simulation ---

    def step(self):
        """One step: torques that make each arm follow its target, as inverse dynamics has them."""
        m, d = self.model, self.data
        wished, torque = np.zeros(m.nv), np.zeros(m.nv)
        for name, (q, v, a) in self.target.items():
            arm = self.of_arm[name]
            dofs = self.dofs[name][arm]
            off = (q - d.qpos[self.places[name]])[arm]
            wished[dofs] = (a + 2 * STIFF * (v - d.qvel[self.dofs[name]]) + STIFF ** 2 * (q - d.qpos[self.places[name]]))[arm]
            self.farthest = max(self.farthest, float(np.max(np.abs(off), initial=0)))
        mujoco.mj_mulM(m, d, torque, wished)
        d.qfrc_applied[:] = 0
        for name, dofs in self.dofs.items():
            dofs = dofs[self.of_arm[name]]
            d.qfrc_applied[dofs] = torque[dofs] + d.qfrc_bias[dofs]
            d.qfrc_applied[dofs[0]] += self.options.push
        self._finger_forces()
        mujoco.mj_step(m, d)
        self._bend_ways()
        self.time += self.dt
        self._look()
        self.samples += 1
        if self.leaving and self.samples % 10 == 0:
            self._part()
        if self.samples % 5 == 0 and self.log:
            self.log.write(json.dumps({"t": round(self.time, 4), "action": self.action,
                                       "q": {n: list(d.qpos[p]) for n, p in self.places.items()},
                                       "poses": {t: list(d.body(t).xpos) + list(d.body(t).xquat) for t in self.things}}) + "\n")
        if self.renderer and self.samples % 20 == 0:
            self._picture()

    def _look(self):
        """Contacts between what moves with a robot and what does not."""
        carrier = {thing: robot for thing, (robot, _) in (*self.held.items(), *self.gripped.items()) if thing not in self.parting}
        for i in range(self.data.ncon):
            contact = self.data.contact[i]
            if contact.dist > -DEEP:
                continue
            a, b = (self.owner[g] for g in contact.geom)
            of_a, of_b = carrier.get(a, a), carrier.get(b, b)
            if of_a not in self.robots and of_b not in self.robots:
                continue
            beside = self._is_beside_pads(a, b, contact.geom)
            if beside is False or (of_a == of_b and not beside):
                continue
            key = (self.action, *sorted((a, b)))
            self.contacts[key] = max(self.contacts.get(key, 0.0), -float(contact.dist))

    def _bend_ways(self):
        """MuJoCo's constraints leave out how the link's Jacobian changes. So what friction alone has follow a link on a curve, of acceleration a,
        creeps outwards: with e its velocity beside the link, e changes by −b e − a, b = 2 / (impedance · time constant), and e comes to −a / b.
        In a step of h the two part by h² a (1 / (b h) − 1/2); that is put right here, and the force that friction has to give stays."""
        m, d = self.model, self.data
        along, about, turn = np.zeros((3, m.nv)), np.zeros((3, m.nv)), np.zeros(3)
        part = self.dt ** 2 * (0.5 * FIRM * HARD - 0.5)
        for thing, (_, link) in self.gripped.items():
            start = m.jnt_qposadr[m.body_jntadr[m.body(thing).id]]
            mujoco.mj_jacDot(m, d, along, about, d.qpos[start:start + 3].copy(), m.body(link).id)
            d.qpos[start:start + 3] += part * along @ d.qvel
            # MuJoCo turns free bodies in their own frame.
            mujoco.mju_rotVecQuat(turn, about @ d.qvel, np.array([1, -1, -1, -1]) * d.qpos[start + 3:start + 7])
            mujoco.mju_quatIntegrate(d.qpos[start + 3:start + 7], turn, part)

    def _is_beside_pads(self, a, b, geoms):
        """Whether a link that is no pad touches what pads hold; False: a pad does. None: it is about something else."""
        for thing, robot, geom in ((a, b, geoms[1]), (b, a, geoms[0])):
            if thing in self.gripped and robot == self.gripped[thing][0]:
                return bool(self.model.geom_bodyid[geom] not in self.pads[robot])
        return None

    def _picture(self):
        camera = mujoco.MjvCamera()
        camera.lookat[:], camera.distance, camera.azimuth, camera.elevation = self.model.stat.center, 1.2 * self.model.stat.extent, 150, -20
        self.renderer.update_scene(self.data, camera)
        write_png(pathlib.Path(self.options.film) / f"{self.frames:05d}.png", self.renderer.render())
        self.frames += 1

    def run(self, seconds):
        for _ in range(round(seconds / self.dt)):
            self.step()

    def joints(self):
        return {name: [float(x) for x in self.data.qpos[places]] for name, places in self.places.items()}

    # --- what robots do ---

    def move(self, robot, motion):
        executed = []
        for k in range(round(motion.duration / self.dt)):
            t = k * self.dt
            if k % SAMPLED == 0:
                executed.append([t, *map(float, self.data.qpos[self.places[robot]])])
            self.target[robot] = tuple(map(np.array, motion.at(t)))
            self.step()
        end = np.array(motion.positions[-1])
        self.target[robot] = (end, 0.0, 0.0)
        for k in range(round(1 / self.dt)):
            if k % SAMPLED == 0:
                executed.append([motion.duration + k * self.dt, *map(float, self.data.qpos[self.places[robot]])])
            if np.max(np.abs(end - self.data.qpos[self.places[robot]]), initial=0) < TRACKED and \
                    np.max(np.abs(self.data.qvel[self.dofs[robot]]), initial=0) < 0.05:
                break
            self.step()
        self.plan.qpos[self.places[robot]] = end
        self._carry_in_plan()
        return executed

    def _carry_in_plan(self):
        self._mimic(self.plan)
        mujoco.mj_kinematics(self.model, self.plan)
        for thing, (link, at, turn) in self.held_by_plan.items():
            body = self.plan.body(link)
            place, out = composed(body.xpos, body.xquat, at, turn)
            start = self.model.jnt_qposadr[self.model.body_jntadr[self.model.body(thing).id]]
            self.plan.qpos[start:start + 3], self.plan.qpos[start + 3:start + 7] = place, out
        mujoco.mj_kinematics(self.model, self.plan)

    def gap(self, robot, thing, most=1.0):
        """Least distance between a robot, or a thing, and a thing, up to a limit."""
        ours = [g for g in range(self.model.ngeom) if self.owner[g] == robot]
        theirs = [g for g in range(self.model.ngeom) if self.owner[g] == thing]
        line = np.zeros(6)
        return min((mujoco.mj_geomDistance(self.model, self.data, a, b, most, line) for a in ours for b in theirs), default=most)

    def take(self, robot, link, thing, gripper=None):
        name = f"{robot}/{link}"
        if thing not in self.things:
            raise Failure(f"'{thing}' has no grasps in the scene, so it stands fast here")
        gap = self.gap(robot, thing)
        if gap > self.options.reach:
            raise Failure(f"'{thing}' is {1000 * gap:.0f} mm from '{robot}': nothing is held")
        self._let_go(thing)
        if gripper:
            self._close(robot, name, thing, gripper)
            return
        self._weld(thing, robot, name)
        self.run(SETTLE)

    def _close(self, robot, name, thing, gripper):
        """Closes fingers on a thing; they stop where their pads touch it."""
        a, b = self.plan.body(name), self.plan.body(thing)
        at, turn = relative(a.xpos, a.xquat, b.xpos, b.xquat)
        self.gripped[thing] = (robot, name)
        for joint, begin, to in zip(gripper["joint_names"], gripper["from"], gripper["to"]):
            force = gripper.get("force", self.options.force) * (1 if to > begin else -1)
            self.squeeze[robot, joint] = (force, self.time)
        self._stand(robot, gripper, 2.0)
        for joint, to in zip(gripper["joint_names"], gripper["to"]):
            is_at = float(self.data.qpos[self.fingers[robot, joint][0][1]])
            if abs(is_at - to) > gripper["within"]:
                self._open(robot, thing, {**gripper, "to": gripper["from"]})
                raise Failure(f"the fingers do not stop at '{thing}': {joint} is {1000 * abs(is_at - to):.1f} mm from where it should hold")
        self._tell_fingers(robot, gripper)
        self.held_by_plan[thing] = (name, at, turn)

    def _open(self, robot, thing, gripper):
        self.parting.add(thing)  # it may touch what it is put on
        for joint in gripper["joint_names"]:
            self.squeeze.pop((robot, joint), None)
        self._tell_fingers(robot, gripper)
        self._stand(robot, gripper, 2.0)
        self.parting.discard(thing)
        self.gripped.pop(thing, None)
        self.held_by_plan.pop(thing, None)

    def _tell_fingers(self, robot, gripper):
        q = np.array(self.target[robot][0])
        for joint, to in zip(gripper["joint_names"], gripper["to"]):
            q[self.robots[robot].index(joint)] = to
        self.target[robot] = (q, 0.0, 0.0)
        self.plan.qpos[self.places[robot]] = q

    def _stand(self, robot, gripper, most):
        """Until fingers stand. @param most  [s]"""
        dofs = [dof for joint in gripper["joint_names"] for dof, _, _ in self.fingers[robot, joint]]
        begun = self.time
        while self.time - begun < most:
            self.step()
            if self.time - begun > 1.5 * CLOSING and np.max(np.abs(self.data.qvel[dofs])) < SLOW:
                return

    def _weld(self, thing, robot, name):
        """Holds a thing by a link: bellows pull it to where the plan holds it."""
        a, b = self.plan.body(name), self.plan.body(thing)
        at, turn = relative(a.xpos, a.xquat, b.xpos, b.xquat)
        weld = self.model.equality(f"{name}+{thing}").id
        self.model.eq_data[weld, 0:3] = 0                  # the anchor, in the thing
        self.model.eq_data[weld, 3:6], self.model.eq_data[weld, 6:10] = at, turn
        self.model.eq_data[weld, 10] = 1
        self.data.eq_active[weld] = 1
        self.held[thing] = (robot, weld)
        self._separate()
        self.held_by_plan[thing] = (name, at, turn)

    def _let_go(self, thing):
        if thing in self.held:
            robot, weld = self.held.pop(thing)
            self.data.eq_active[weld] = 0
            self.leaving.add((robot, thing))
            self._separate()
            self.held_by_plan.pop(thing, None)

    def release(self, robot, thing, gripper=None):
        if thing in self.gripped and gripper:
            self._open(robot, thing, gripper)
            self.run(SETTLE)
            return
        if thing not in self.held:
            raise Failure(f"'{thing}' is not held")
        # Handed over: another robot has taken it.
        if self.held[thing][0] != robot:
            return
        self._set_down(robot)
        self._let_go(thing)
        for other, (holder, weld) in list(self.held.items()):
            if holder != robot and self.gap(other, thing, FIT) < FIT:
                self._weld(thing, holder, self.model.body(self.model.eq_obj1id[weld]).name)
                break
        self.run(SETTLE)

    def _set_down(self, robot):
        """The cup's spring lowers what a robot holds until it stands on something, as far as --reach."""
        held = {thing: weld for thing, (by, weld) in self.held.items() if by == robot}
        geoms = {g for g in range(self.model.ngeom) if self.owner[g] in held}
        for _ in range(round(self.options.reach / (DOWN * self.dt))):
            if any((a in geoms) != (b in geoms) and c.dist < 0 for c in self.data.contact[:self.data.ncon] for a, b in [c.geom]):
                break
            for weld in held.values():
                link = self.model.eq_obj1id[weld]
                self.model.eq_data[weld, 3:6] -= DOWN * self.dt * self.data.xmat[link].reshape(3, 3)[2]
            self.step()

    def weight(self, thing):
        """What a held thing weighs, by the force at the link that holds it, at rest [kg]."""
        if thing not in self.held and thing not in self.gripped:
            raise Failure(f"'{thing}' is held by no robot: it cannot be weighed")
        link = self.model.body(self.gripped[thing][1]).id if thing in self.gripped else self.model.eq_obj1id[self.held[thing][1]]
        total, count = 0.0, 200
        for _ in range(count):
            self.step()
            mujoco.mj_rnePostConstraint(self.model, self.data)
            total += float(self.data.cfrc_int[link][5])
        return abs(total) / count / GRAVITY - float(self.model.body_subtreemass[link])

    def end(self, objects):
        """Where things are, beside where the plan has them: what is left or right of it, below it, and turned."""
        self.run(SETTLE)
        for thing in self.things:
            if "pose" not in objects.get(thing, {}):
                continue  # away, or held
            pose, body = np.array(objects[thing]["pose"], float), self.data.body(thing)
            off = body.xpos - pose[:, 3]
            self.ends[thing] = {"beside": float(np.linalg.norm(off[:2])), "below": float(-off[2]),
                                "turned": angle_between(body.xquat, quaternion(pose[:, :3]))}

    def report(self):
        most = {key: max((abs(end[key]) for end in self.ends.values()), default=0.0) for key in ("beside", "below", "turned")}
        return {"seconds": round(self.time, 3), "steps": self.samples, "tracking": self.farthest, "ends": self.ends, "most": most,
                "contacts": [{"action": k[0], "between": k[1:], "depth": v} for k, v in sorted(self.contacts.items())]}


class Simulated(Driver):
    def __init__(self, options):
        super().__init__()
        self.options, self.world, self.random = options, None, np.random.default_rng(options.seed)
        self.sensed = dict(text.rsplit("=", 1) for text in options.sense)
        self.measures = [re.fullmatch(r"(\w+)=weight>([0-9.e+-]+)", text) for text in options.measure]
        if None in self.measures:
            sys.exit("physics.py: --measure is FACT=weight>KILOGRAMS")

    def begin(self, robots, objects):
        self.world = World(self.options, robots, objects)

    def where(self, robot):
        return self.world.joints()[robot]

    def act(self, action):
        self.world.action = action

    def move(self, robot, motion):
        return self.world.move(robot, motion)

    def take(self, robot, object, link):
        self.world.take(robot, link, object, self.gripper)

    def release(self, robot, object):
        self.world.release(robot, object, self.gripper)

    def sense(self, fact, values):
        for measure in self.measures:
            told = re.fullmatch(r"(\w+)\((\w+)\)", fact)
            if told and told.group(1) == measure.group(1):
                weight = self.world.weight(told.group(2))
                print(f"physics.py: {told.group(2)} weighs {weight:.3f} kg", file=sys.stderr)
                return weight > float(measure.group(2))
        said = self.sensed.get(fact)
        return said if said is not None else self.random.choice(values)

    def finish(self, objects):
        self.world.end(objects)
        self.stop()
        self.world = None

    def stop(self):
        if self.world is None:
            return
        report = self.world.report()
        if self.options.report:
            pathlib.Path(self.options.report).write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
        most = report["most"]
        print(f"physics.py: {report['seconds']:.1f} s simulated; joints within {report['tracking']:.2g} of where they were told to be; "
              f"{len(report['ends'])} things end within {1000 * most['beside']:.1f} mm beside, {1000 * most['below']:.1f} mm below and "
              f"{math.degrees(most['turned']):.1f}° of where the plan has them; {len(report['contacts'])} contacts that it does not know",
              file=sys.stderr)
        if self.world.log:
            self.world.log.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--scene", required=True, metavar="FILE.json", help="the scene of the plan")
    parser.add_argument("--robot", action="append", default=[], metavar="NAME=FILE.xml", help="the MJCF of a robot of the scene")
    parser.add_argument("--set", action="append", default=[], metavar="OBJECT=FILE.glb", help="bodies of an object [its outer set in the scene]")
    parser.add_argument("--mass", action="append", default=[], metavar="OBJECT=KG", help="of an object [500 kg/m³]")
    parser.add_argument("--measure", action="append", default=[], metavar="FACT=weight>KG", help="what the force at the wrist decides, of what is held")
    parser.add_argument("--sense", action="append", default=[], metavar="FACT=VALUE", help="what a fact turns out to be; others at random")
    parser.add_argument("--disturb", type=float, default=0.0, metavar="METRES", help="things begin up to so far beside their places, at random [0]")
    parser.add_argument("--push", type=float, default=0.0, metavar="NM", help="a torque at the first joint of each robot that it does not know of [0]")
    parser.add_argument("--seed", type=int, default=1, help="of what is random [1]")
    parser.add_argument("--force", type=float, default=40.0, metavar="N", help="of fingers whose gripper states none in the scene [40]")
    parser.add_argument("--reach", type=float, default=0.03, metavar="METRES", help="the suction cup takes what is so near [0.03]")
    parser.add_argument("--report", metavar="FILE.json", help="what went otherwise than planned")
    parser.add_argument("--log", metavar="FILE.jsonl", help="joints and poses, 100 times a second")
    parser.add_argument("--film", metavar="DIRECTORY", help="pictures, 25 a second")
    Simulated(parser.parse_args()).run()


if __name__ == "__main__":
    main()
