"""Motions of either planner among exact triangle meshes, by FCL, at samples; kinematics of its own."""
import math
import xml.etree.ElementTree as ET

import fcl
import numpy
import trimesh

STEP = 0.01  # between samples no joint moves farther [rad]


def rotation(rpy):
    (sr, cr), (sp, cp), (sy, cy) = ((math.sin(a), math.cos(a)) for a in rpy)
    return numpy.array([[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr], [-sp, cp * sr, cp * cr]])


def frame(position, turn=numpy.eye(3)):
    out = numpy.eye(4)
    out[:3, :3], out[:3, 3] = turn, position
    return out


class Arm:
    """A chain of links, each with its mesh."""

    def __init__(self, file):
        robot = ET.parse(file).getroot()
        self.joints, self.meshes = [], {}
        for joint in robot.findall("joint"):
            origin, axis = joint.find("origin"), joint.find("axis")
            numbers = lambda element, name: [float(w) for w in element.get(name, "0 0 0").split()] if element is not None else [0.0] * 3
            at = frame(numbers(origin, "xyz"), rotation(numbers(origin, "rpy")))
            self.joints.append((joint.find("parent").get("link"), joint.find("child").get("link"), at,
                                numpy.array(numbers(axis, "xyz")) if joint.get("type") == "revolute" else None))
        for link in robot.findall("link"):
            shape = link.find("collision/geometry/mesh")
            if shape is not None:
                mesh = trimesh.load(shape.get("filename"), force="mesh", process=False)
                model = fcl.BVHModel()
                model.beginModel(len(mesh.vertices), len(mesh.faces))
                model.addSubModel(mesh.vertices, mesh.faces)
                model.endModel()
                self.meshes[link.get("name")] = fcl.CollisionObject(model)

    def frames(self, q):
        """Of all links; joints are in the file's order, parents first."""
        out, values = {self.joints[0][0]: numpy.eye(4)}, iter(q)
        for parent, child, at, axis in self.joints:
            turn = numpy.eye(4)
            if axis is not None:
                x, y, z = axis
                cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
                angle = next(values)
                turn[:3, :3] += math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
            out[child] = out[parent] @ at @ turn
        return out


def meet(a, b):
    return fcl.collide(a, b, fcl.CollisionRequest(), fcl.CollisionResult()) > 0


def put(thing, pose):
    thing.setTransform(fcl.Transform(pose[:3, :3], pose[:3, 3]))


def samples(path):
    path = [numpy.array(q) for q in path]
    yield path[0]
    for a, b in zip(path, path[1:]):
        count = max(1, math.ceil(numpy.abs(b - a).max() / STEP))
        for k in range(1, count + 1):
            yield a + (b - a) * k / count


def judged(arm, boxes, poses, motions, smaller=0.0):
    """Samples, those in contact, and the pairs in contact.

    @param boxes  size by name; `poses` says where each is at first
    @param motions  [{path, held: names}]; what is held moves with link 7 from where it is
    @param smaller  boxes are made so much smaller at each face [m]: contacts that are left are deeper
    """
    things = {n: fcl.CollisionObject(fcl.Box(*(s - 2 * smaller for s in size))) for n, size in boxes.items()}
    poses = dict(poses)
    names = list(arm.meshes)
    pairs = [(a, b) for i, a in enumerate(names) for b in names[i + 2:]]
    total, touching, found = 0, 0, set()
    for motion in motions:
        grasp = None
        for q in samples(motion["path"]):
            at = arm.frames(q)
            for name in names:
                put(arm.meshes[name], at[name])
            if grasp is None:
                hand = numpy.linalg.inv(at["iiwa_link_7"])
                grasp = {n: hand @ poses[n] for n in motion["held"]}
            for name, pose in grasp.items():
                poses[name] = at["iiwa_link_7"] @ pose
            for name, pose in poses.items():
                put(things[name], pose)
            now = {(a, b) for a, b in pairs if meet(arm.meshes[a], arm.meshes[b])}
            now |= {(n, t) for n in names[1:] for t in things if not (t in grasp and n == "iiwa_link_7") and meet(arm.meshes[n], things[t])}
            now |= {(h, t) for h in grasp for t in things if t not in grasp and meet(things[h], things[t])}
            total, touching, found = total + 1, touching + bool(now), found | now
    return total, touching, sorted(found), poses
