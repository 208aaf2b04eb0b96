"""Figures 6.2 to 6.8: scenarios planned, carried out in simulation and judged by exact meshes; pictures of the states that a plan goes through.

The states are read from the page that kaboum-plan makes of a plan (docs/pages.md, "The page's data").
"""

import array
import base64
import json
import math
import re
import subprocess

import meshes
from calls import Calls
from scenarios import LIMIT, SCENARIOS

# scenario, n, options, seeds of sensing: what the thesis's figure shows
FIGURES = (
    ("6.2", "bartender", 4, (), "BARTENDER, four bottles: one branch of what is sensed"),
    ("6.3", "circular-rearrange", 3, ("--search", "bfs"), "BIMANUAL CIRCULAR REARRANGE, three objects, a shortest plan"),
    ("6.4", "stacked", 3, ("--search", "bfs"), "STACKED 3 OBJECTS (photographs in the thesis)"),
    ("6.5", "stacked", 4, ("--search", "bfs"), "STACKED 4 OBJECTS, a shortest plan"),
    ("6.7, 6.8", "bimanual-assembly", 4, (), "BIMANUAL ASSEMBLY from the first state to the goal"))
QUICK = ("6.3", "6.5", "6.7, 6.8")
PANELS = 6
IDENTITY = [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]


def multiply(a, b):
    """Poses of 12 numbers: a rotation row by row, then a translation."""
    out = [sum(a[3 * i + k] * b[3 * k + j] for k in range(3)) for i in range(3) for j in range(3)]
    return out + [sum(a[3 * i + k] * b[9 + k] for k in range(3)) + a[9 + i] for i in range(3)]


def turn(axis, angle):
    x, y, z = axis
    c, s = math.cos(angle), math.sin(angle)
    k = 1 - c
    return [c + k * x * x, k * x * y - s * z, k * x * z + s * y, k * x * y + s * z, c + k * y * y, k * y * z - s * x,
            k * x * z - s * y, k * y * z + s * x, c + k * z * z, 0, 0, 0]


def forward(robot, q):
    """Poses of all links."""
    poses = {0: robot["base"]}
    for number, joint in enumerate(robot["joints"]):
        local = joint["origin"]
        if joint["type"] != "fixed":
            value = joint["multiplier"] * q[joint["variable"]] + joint["offset"]
            shift = IDENTITY[:9] + [x * value for x in joint["axis"]]
            local = multiply(local, turn(joint["axis"], value) if joint["type"] == "revolute" else shift)
        poses[number + 1] = multiply(poses[joint["parent"]], local)
    return poses


def data_of(page):
    """The data of a page, which is a file."""
    found = re.search(r'<script id="data" type="application/json">(.*?)</script>', page.read_text(encoding="utf-8"), re.S)
    return json.loads(found[1])


def steps_to_goal(data, most=10 ** 4):
    """States of the branch whose first way is taken at each step, the first state included, and the actions between."""
    states, actions, at = [], [], data["root"]
    while at is not None and len(actions) < most:
        step = data["steps"][at]
        way = step["ways"][0]
        if not states:
            states.append(step["before"])
        node = data["nodes"][step["node"]]
        actions.append(node.get("action") or node.get("name") or str(step["node"]))
        states.append(way["after"])
        at = way["next"]
    return states, actions


def _mesh(shape):
    """Points and triangles of a shape: the exact mesh, or its bodies where there is none."""
    points, triangles = [], []
    for part in [shape["exact"]] if shape.get("exact") else shape["bodies"]:
        numbers, corners = array.array("f"), array.array("I")
        numbers.frombytes(base64.b64decode(part["points"]))
        corners.frombytes(base64.b64decode(part["triangles"]))
        first = len(points)
        points += list(zip(numbers[::3], numbers[1::3], numbers[2::3]))
        triangles += [[first + i for i in corners[k:k + 3]] for k in range(0, len(corners), 3)]
    return points, triangles


def scene_at(data, state):
    """All that is there in a state, as points and triangles of the world."""
    links = [forward(robot, q) for robot, q in zip(data["robots"], state["q"])]
    points, triangles = [], []
    for shape in data["shapes"]:
        if "object" in shape:
            place = state["places"][shape["object"]]
            if place.get("away"):
                continue
            pose = place["pose"] if "robot" not in place else multiply(links[place["robot"]][place["link"]], place["pose"])
        else:
            pose = links[shape["robot"]][shape["link"]]
        first, (own, corners) = len(points), _mesh(shape)
        points += [tuple(sum(pose[3 * i + k] * p[k] for k in range(3)) + pose[9 + i] for i in range(3)) for p in own]
        triangles += [[first + i for i in t] for t in corners]
    return points, triangles


def _chosen(states):
    """At most PANELS of the states, spread evenly, the first and last among them."""
    if len(states) <= PANELS:
        return list(range(len(states)))
    return sorted({round(i * (len(states) - 1) / (PANELS - 1)) for i in range(PANELS)})


def section(context, document):
    if context.collecting:
        return
    document.heading("Executions (Figures 6.2 to 6.8)")
    if not (context.runner.programs / "kaboum-plan").is_file():
        document.paragraph("Left out: kaboum-plan is not built.")
        return
    document.paragraph("Each scenario is planned, the plan is checked, and every branch of it is carried out in simulation at 1 kHz among the exact meshes. "
                       "Pictures: states that the plan goes through; plan.html beside them plays all of it. Robots, parts and scenes are the project's own.")
    call, rows, pictures = Calls(context, "executions"), [], []
    for figure, name, n, options, text in FIGURES:
        if context.quick and figure not in QUICK:
            continue
        folder = f"{name}-{n}"
        files = [f"{folder}/plan.html", f"{folder}/run.json", f"{folder}/plan.json"]
        inputs = [call.programs / "kaboum-scene", call.programs / "kaboum-plan", SCENARIOS / "parts.py", SCENARIOS / "scenario.py", SCENARIOS / name / "domain.kpl"]
        code = call(f"execution of {name} {n}", SCENARIOS / name / "run", [n, "--timeout", 1000 * LIMIT, "--no-cache", "--out", folder, *options], inputs,
                    files, (0, 1), limit=5 * LIMIT)
        if code is None or not (call.folder / files[0]).is_file():
            rows.append([figure, f"{name} {n}", *["—"] * 5, "no plan carried out"])
            continue
        report = call.report(files[1])
        data = data_of(call.folder / files[0])
        states, actions = steps_to_goal(data)
        rows.append([figure, f"{name} {n}", str(len(actions)), str(report["branches"]), f"{report['samples']:,}", str(report["collisions"]),
                     str(report["limit_violations"]), "holds" if code == 0 else "does NOT hold"])
        pictures.append((figure, name, n, text, data, states, actions))
    document.table(["figure", "scenario", "actions of the branch shown", "branches carried out", "samples judged", "in contact", "beyond limits", ""], rows)
    for figure, name, n, text, data, states, actions in pictures:
        if name == "bimanual-assembly":
            folder = call.folder / f"{name}-{n}"
            parts, path = [folder / f"{part}.off" for part in ("bearing", "pipe", "tree")], folder / "figure-6-6.png"
            subprocess.run([context.runner.programs / "mesh-picture", *parts, "-o", path, "--titles", "bearing,pipe,tree", "--width", "1200", "--height", "420"],
                           check=True)
            document.picture(path, "Figure 6.6: the parts of BIMANUAL ASSEMBLY")
        _draw(context, call, document, (figure, name, n, text), data, states, actions)


def _draw(context, call, document, what, data, states, actions):
    figure, name, n, text = what
    folder, chosen, parts = call.folder / f"{name}-{n}", _chosen(states), []
    for number in chosen:
        parts.append(folder / f"state-{number:03}.off")
        meshes.write_off(parts[-1], *scene_at(data, data["states"][states[number]]))
    path = folder / f"figure-{figure.replace(', ', '-').replace('.', '-')}.png"
    titles = ["start"] + [f"after {number}" for number in chosen[1:]]
    subprocess.run([context.runner.programs / "mesh-picture", *parts, "-o", path, "--titles", ",".join(titles), "--colours", "orange", "--width",
                    str(420 * len(parts)), "--height", "460", "--view", "-60,25"], check=True)
    said = "; ".join(f"{number}: {actions[number - 1]}" for number in chosen[1:])
    document.picture(path, f"Figure {figure}: {text}. Actions before the states shown: {said}")
