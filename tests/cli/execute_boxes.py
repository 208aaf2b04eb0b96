#!/usr/bin/env python3
"""Executes a plan of examples/geometry and looks at every sample, by nothing but its files: forward kinematics of
arm.urdf, boxes against boxes by separating axes. Shares no code with what made the plan.

usage: execute_boxes.py FOLDER PLAN   (prints what was looked at; exit code 1: what is wrong)
"""
import json
import math
import pathlib
import sys
import xml.etree.ElementTree as ET

STEP = 0.01  # most that a joint moves between two samples [rad]


def mul(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def apply(m, v):
    return [sum(m[i][k] * v[k] for k in range(3)) for i in range(3)]


def compose(a, b):
    """Poses are (rotation, translation)."""
    return mul(a[0], b[0]), [x + y for x, y in zip(apply(a[0], b[1]), a[1])]


def rotation(axis, angle):
    x, y, z = axis
    c, s = math.cos(angle), math.sin(angle)
    t = 1 - c
    return [[t * x * x + c, t * x * y - s * z, t * x * z + s * y], [t * x * y + s * z, t * y * y + c, t * y * z - s * x],
            [t * x * z - s * y, t * y * z + s * x, t * z * z + c]]


def quaternion(x, y, z, w):
    n = math.sqrt(x * x + y * y + z * z + w * w)
    x, y, z, w = x / n, y / n, z / n, w / n
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]


IDENTITY = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]


def floats(text):
    return [float(x) for x in text.split()]


class Arm:
    def __init__(self, urdf):
        root = ET.parse(urdf).getroot()
        self.boxes = {}  # link -> (center, half)
        for link in root.findall("link"):
            if link.find("collision") is not None:
                size = floats(link.find("collision/geometry/box").get("size"))
                self.boxes[link.get("name")] = (floats(link.find("collision/origin").get("xyz")), [s / 2 for s in size])
        self.joints = [(j.find("parent").get("link"), j.find("child").get("link"), floats(j.find("origin").get("xyz")),
                        floats(j.find("axis").get("xyz")), float(j.find("limit").get("upper"))) for j in root.findall("joint")]

    def links(self, q):
        poses = {self.joints[0][0]: (IDENTITY, [0, 0, 0])}
        for (parent, child, origin, axis, limit), value in zip(self.joints, q):
            assert abs(value) <= limit + 1e-12, f"{child} at {value}, beyond {limit}"
            poses[child] = compose(compose(poses[parent], (IDENTITY, origin)), (rotation(axis, value), [0, 0, 0]))
        return poses


def boxes_meet(a, b):
    """Oriented boxes (pose, half lengths); separated by less than 1e-12 counts as meeting."""
    (ra, ta), ha = a
    (rb, tb), hb = b
    d = [y - x for x, y in zip(ta, tb)]
    if sum(x * x for x in d) > (math.hypot(*ha) + math.hypot(*hb)) ** 2:
        return False
    ca, cb = [[r[k] for r in ra] for k in range(3)], [[r[k] for r in rb] for k in range(3)]
    axes = ca + cb
    for u in ca:
        for v in cb:
            w = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            if sum(x * x for x in w) > 1e-12:
                axes.append(w)
    for axis in axes:
        reach = sum(h * abs(sum(x * y for x, y in zip(axis, c))) for h, c in zip(ha, ca))
        reach += sum(h * abs(sum(x * y for x, y in zip(axis, c))) for h, c in zip(hb, cb))
        if abs(sum(x * y for x, y in zip(axis, d))) > reach + 1e-12:
            return False
    return True


def off_half(path):
    lines = path.read_text().split("\n")
    count = int(lines[1].split()[0])
    return [max(abs(floats(line)[k]) for line in lines[2:2 + count]) for k in range(3)]


class Cell:
    def __init__(self, folder):
        cell = json.loads((folder / "cell.json").read_text())
        self.arm = Arm(folder / "arm.urdf")
        self.objects, self.start = {}, {}
        for thing in cell["objects"]:
            name = thing["name"]
            mesh = "table" if name == "table" else "place" if name.startswith("place") else "block"
            self.objects[name] = off_half(folder / f"{mesh}.off")
            self.start[name] = (IDENTITY, thing["pose"]["position"])
        home = cell["robots"][0]["home"]
        self.q = [home.get(f"j{i + 1}", 0) for i in range(6)]
        self.poses = dict(self.start)  # of what rests
        self.held = None               # (object, pose in the hand)
        self.samples = 0

    def look(self, q):
        self.samples += 1
        links = self.arm.links(q)
        moving = {name: ((lambda p: (p[0], p[1]))(compose(links[name], (IDENTITY, c))), h) for name, (c, h) in self.arm.boxes.items()}
        if self.held:
            moving[self.held[0]] = (compose(links["hand"], self.held[1]), self.objects[self.held[0]])
        for a, box in moving.items():
            for b, pose in self.poses.items():
                assert not boxes_meet(box, (pose, self.objects[b])), f"{a} hits {b} at {q}"
        if self.held:
            for link in ("shoulder", "upper_arm", "elbow", "forearm", "wrist"):
                assert not boxes_meet(moving[self.held[0]], moving[link]), f"{self.held[0]} hits {link} at {q}"

    def move(self, path):
        assert path[0] == self.q, f"a path starts at {path[0]}, the robot is at {self.q}"
        for a, b in zip(path, path[1:]):
            n = max(1, math.ceil(max(abs(x - y) for x, y in zip(a, b)) / STEP))
            for k in range(n + 1):
                self.look([x + (y - x) * k / n for x, y in zip(a, b)])
        self.q = path[-1]

    def take(self, name):
        """The hand is above the object, and points down at its top."""
        hand, pose = self.arm.links(self.q)["hand"], self.poses[name]
        tool = compose(hand, (IDENTITY, [0, 0, 0.155]))
        up = [row[2] for row in tool[0]]
        assert math.dist(up, [0, 0, -1]) < 1e-6, up
        top = [x + y for x, y in zip(pose[1], apply(pose[0], [0, 0, self.objects[name][2] + 0.002]))]
        assert math.dist(tool[1], top) < 1e-6, (tool[1], top)
        inverse = [list(row) for row in zip(*hand[0])]
        self.held = name, compose((inverse, apply(inverse, [-x for x in hand[1]])), pose)
        del self.poses[name]

    def let_go(self, word):
        name, pose = self.held
        self.held = None
        at = compose(self.arm.links(self.q)["hand"], pose)
        if word == "away":
            return
        if word == "start":
            then = self.start[name]
        else:
            numbers = floats(word.removeprefix("at "))
            then = quaternion(*numbers[3:]), numbers[:3]
        assert math.dist(at[1], then[1]) < 1e-6, f"{name} is let go at {at[1]}, not at {then[1]}"
        self.poses[name] = then
        lower = then[1][2] - self.objects[name][2]
        below = [other for other, p in self.poses.items() if other != name and
                 0 < lower - (p[1][2] + self.objects[other][2]) < 0.003 and all(abs(p[1][k] - then[1][k]) < self.objects[other][k] for k in (0, 1))]
        assert below, f"{name} stands on nothing"


def main():
    cell = Cell(pathlib.Path(sys.argv[1]))
    plan = json.loads(pathlib.Path(sys.argv[2]).read_text())
    at, actions = plan["root"], 0
    while at != "goal":
        node = plan["nodes"][at]
        actions += 1
        calls = {call["external"]: call for call in node["calls"]}
        if node["action"] == "move":
            call = calls["transfer"]
            for k, part in enumerate(json.loads(call["payload"])):
                cell.move(part["path"])
                if k == 0:
                    cell.take(node["arguments"][0])
                if k == 1:
                    cell.let_go(call["value"])
        elif node["action"] == "pick":
            for part in json.loads(calls["reach"]["payload"]):
                cell.move(part["path"])
            cell.take(node["arguments"][0])
        else:
            for part in json.loads(calls["move"]["payload"]):
                cell.move(part["path"])
            cell.let_go("away")
        at = node["next"]
    print(f"{actions} actions, {cell.samples} samples")


try:
    main()
except AssertionError as error:
    sys.exit(f"execute_boxes.py: {error}")
