"""Table 4.1 and the thesis's illustrations that show something made: Figures 4.1, 4.4 and 5.3."""

import json
import math
import subprocess

import judged
import meshes
from calls import Calls
from document import figure
from lines import count

STEPS = 24


def _ball(centre, radius):
    """A convex sphere round a ball: the corners are on the sphere that the facets' middles would touch from outside."""
    rings, around = 24, 48
    out = radius / (math.cos(math.pi / rings) * math.cos(math.pi / around))
    points = [(0, 0, out)] + [(out * math.sin(a) * math.cos(b), out * math.sin(a) * math.sin(b), out * math.cos(a))
                              for a in (math.pi * i / rings for i in range(1, rings)) for b in (2 * math.pi * k / around for k in range(around))] + [(0, 0, -out)]
    triangles = []
    for k in range(around):
        n = (k + 1) % around
        triangles += [[0, 1 + k, 1 + n], [len(points) - 1, len(points) - 1 - around + n, len(points) - 1 - around + k]]
        for i in range(rings - 2):
            a, b = 1 + around * i + k, 1 + around * i + n
            triangles += [[a, a + around, b], [b, a + around, b + around]]
    return [tuple(c + x for c, x in zip(centre, p)) for p in points], triangles


def _box(low, high):
    points = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return points, [t for a, b, c, d in quads for t in ([a, b, c], [a, c, d])]


def figure_4_1_section(context, document):
    """Bounding volumes of one mesh, coarse to fine."""
    if context.collecting:
        return
    document.heading("Figure 4.1: bounding volumes, coarse to fine")
    models = [m for m in context.models if m.name == "bunny"] or [m for m in context.models if not m.robot][:1]
    if not models:
        document.paragraph("Left out: no scan among the models of this run.")
        return
    model, call = models[0], Calls(context, "volumes")
    whole = f"{model.name}.off"
    if call("prepared", call.programs / "bmesh-decimate", [model.path, "-o", whole, "--drop-sheets", "--holes", "fill", "--precision", "double", "--vertices", 10 ** 9],
            [model.path], [whole], (0, 1)) is None:
        return
    points, _ = meshes.read_off(call.folder / whole)
    low, high = ([f(axis) for axis in zip(*points)] for f in (min, max))
    centre = [(a + b) / 2 for a, b in zip(low, high)]
    meshes.write_off(call.folder / "sphere.off", *_ball(centre, max(math.dist(centre, p) for p in points)))
    meshes.write_off(call.folder / "box.off", *_box(low, high))
    shown = [("sphere", "sphere.off"), ("box along the axes", "box.off")]
    if call("hull", call.programs / "bcd-decompose", [whole, "-o", "hull.obj", "--max-bodies", 1, "--max-vertices-per-body", 100000, "--effort", "fast"],
            [call.folder / whole], ["hull.obj"], (0, 1)) is not None:
        shown.append(("convex hull", "hull.obj"))
    for n in (250, 1000, 5000):
        if n < len(points) and call(f"bounding-{n}", call.programs / "bmesh-decimate", [whole, "-o", f"bounding-{n}.off", "--vertices", n],
                                    [call.folder / whole], [f"bounding-{n}.off"], (0, 1)) is not None:
            shown.append((f"bounding mesh {n}", f"bounding-{n}.off"))
    rows = []
    for title, file in shown:
        said, out, beyond = judged.cells(judged.solids(call, file.split(".")[0], call.folder / whole, file, False))
        read = meshes.read_obj if file.endswith(".obj") else meshes.read_off
        rows.append([title, count(len(read(call.folder / file)[0])), beyond, out, said])
    document.paragraph(f"{model.title}, holes closed: how far each volume reaches beyond the solid, and the solid out of it, in percent of the diagonal.")
    document.table(["volume", "vertices", "volume → solid", "solid sticks out", "verdict"], rows)
    path = call.folder / "figure-4-1.png"
    files = [*(file for _, file in shown), whole]
    subprocess.run([call.programs / "mesh-picture", *(call.folder / f for f in files), "-o", path, "--titles",
                    ",".join([*(title for title, _ in shown), "original"]), "--colours", "orange", "--width", str(320 * len(files)), "--height", "420", "--view", model.view],
                   check=True)
    document.picture(path, "Figure 4.1: bounding volumes of one mesh; the last panel is the original")


def quadrics(steps=STEPS):
    """Figure 4.4 in one dimension and in numbers: two quadrics, their sum, and what adapting the constant makes of it. (x, min(Q1, Q2), sum,
    adapted): the constant is lowered until the sum meets the lower of both where it is least."""
    first, second = (lambda x: (x - 0.25) ** 2), (lambda x: 2 * (x - 0.75) ** 2)
    xs = [i / steps for i in range(steps + 1)]
    total = [first(x) + second(x) for x in xs]
    least = min(range(len(xs)), key=total.__getitem__)
    shift = total[least] - min(first(xs[least]), second(xs[least]))
    return [(x, min(first(x), second(x)), t, t - shift) for x, t in zip(xs, total)]


def figure_4_4_section(context, document):
    if context.collecting:
        return
    document.heading("Figure 4.4: what the sum of two quadrics overestimates")
    rows = quadrics()
    mean = [sum(abs(row[k] - row[1]) for row in rows) / len(rows) for k in (2, 3)]
    document.paragraph(
        "Q₁ = (x − ¼)², Q₂ = 2 (x − ¾)²: a squared distance to the nearer of two planes is min(Q₁, Q₂); contractions add quadrics. "
        f"Over 0 ≤ x ≤ 1 the sum is off by {mean[0]:.4f} on the mean, with the constant adapted (planes-adapted) by {mean[1]:.4f}. What the costs do "
        "with meshes is in Table B.1.")
    document.table(["x", "min(Q₁, Q₂)", "Q₁ + Q₂", "constant adapted"], [[f"{x:.3f}", *(f"{y:.4f}" for y in more)] for x, *more in rows[::3]])


def figure_5_3_section(context, document):
    """Grasp families of a box and a cylinder by one hand, derived by kaboum-scene grasps."""
    if context.collecting:
        return
    from scenarios import SCENARIOS
    document.heading("Figure 5.3: families of grasps")
    if not (context.runner.programs / "kaboum-scene").is_file():
        document.paragraph("Left out: kaboum-scene is not built.")
        return
    call, folder = Calls(context, "grasps"), "bartender-1"
    made = call("scene of grasps", SCENARIOS / "bartender" / "run", [1, "--scene-only", "--out", folder],
                [call.programs / "kaboum-scene", SCENARIOS / "parts.py", SCENARIOS / "scenario.py"], [f"{folder}/cell.json"])
    if made is None:
        return
    script = call.folder / "derive"
    script.write_text(f'#!/bin/sh\nset -e\ncp {folder}/cell.json {folder}/grasps.json\n'
                      f'exec "{call.programs / "kaboum-scene"}" grasps {folder}/grasps.json --robot robot1 --form families --opening 0.08 --object o1 --quiet --preview grasps.html\n',
                      encoding="utf-8")
    script.chmod(0o755)
    if call("families", script, [], [call.programs / "kaboum-scene", call.folder / folder / "cell.json"], [f"{folder}/grasps.json", "grasps.html"]) is None:
        return
    scene = json.loads((call.folder / folder / "grasps.json").read_text(encoding="utf-8"))
    rows = [[thing["name"], grasp["name"], ", ".join(sorted(key for key in grasp if key not in ("name", "position", "rpy", "quaternion", "rank", "derived")))]
            for thing in scene["objects"] for grasp in thing.get("grasps", []) if "slides" in grasp or "turn" in grasp]
    document.paragraph("Grasps that kaboum-scene derives for an object from its convex sets and the hand's, each a family with something free (a turn about an axis, "
                       "a slide along it), certified free of contact between hand and object at every member. The page sweeps them: grasps/grasps.html.")
    document.table(["object", "family", "what is free"], rows)


CASES = (("d < −ε", -3.0), ("−ε < d < 0", -0.5), ("0 < d < ε", 0.5), ("ε < d", 3.0))


def table_4_1_section(context, document):
    """What the predicates say of two boxes at signed distances from each other."""
    if context.collecting:
        return
    document.heading("Table 4.1: bounded predicates at signed distances")
    missing = [name for name in ("kaboum-scene", "kaboum-check") if not (context.runner.programs / name).is_file()]
    if missing:
        document.paragraph(f"Left out: {', '.join(missing)} not built.")
        return
    call = Calls(context, "truth-table")
    epsilon, rows = 0.01, []
    meshes.write_off(call.folder / "hand.off", *_ball((0, 0, 0), 0.1))
    meshes.write_off(call.folder / "wall.off", *_box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)))
    (call.folder / "slide.urdf").write_text(
        "<robot name='slide'><link name='rail'/><link name='hand'><collision><geometry><mesh filename='hand.off'/></geometry></collision></link>"
        "<joint name='x' type='prismatic'><parent link='rail'/><child link='hand'/><axis xyz='1 0 0'/>"
        "<limit lower='-5' upper='5' effort='1' velocity='1'/></joint></robot>\n", encoding="utf-8")
    if call("scene of two things", call.programs / "kaboum-scene", ["make", "two.json", "--force", "--robot", "slide=slide.urdf", "--object", "wall=wall.off",
                                                                     "--epsilon", epsilon], [call.folder / "hand.off", call.folder / "wall.off", call.folder / "slide.urdf"],
            ["two.json"]) is None:
        return
    scene = json.loads((call.folder / "two.json").read_text(encoding="utf-8"))
    scene["regions"] = [{"name": "room", "pose": {"position": [0, 0, 0]}, "shape": {"box": {"size": [1, 1, 1]}}}]
    (call.folder / "cell.json").write_text(json.dumps(scene), encoding="utf-8")
    points, _ = meshes.read_off(call.folder / "hand.off")
    reach = max(p[0] for p in points)
    for title, share in CASES:
        # The nearest point of the hand is `share` ε in front of the wall's face; for inclusion the farthest is as far inside of it.
        outside, inside = -(0.5 + reach + share * epsilon), 0.5 - reach + share * epsilon
        said = {}
        for what, at, more in (("collides", outside, []), ("inside", inside, ["--inside", "slide=room"])):
            name = f"{what} {share:g}"
            code = call(name, call.programs / "kaboum-check", ["cell.json", "--configuration", f"{at!r}", *more, "--report", f"{what}{share:g}.json"],
                        [call.folder / "cell.json"], [f"{what}{share:g}.json"], (0, 1, 7))
            said[what] = None if code is None else call.report(f"{what}{share:g}.json")
        rows.append([title, *_answers(said, share)])
    document.paragraph(
        f"A ball and a box, ε = {1000 * epsilon:g} mm. d is the signed distance of the ball's nearest point from the box for the collision predicate (3 ε and ½ ε to either "
        "side), and of its farthest point from the region of the same size for inclusion. The thesis asks of the collision predicate true for d < 0 and false for ε < d, "
        "and of inclusion true for d < −ε and false for 0 < d; between, either answer is allowed.")
    document.table(["d", "collides?", "asked for", "inside?", "asked for "], rows)


def _answers(said, share):
    hit, held = ("—" if said[what] is None else said[what]["configurations"][0] for what in ("collides", "inside"))
    if hit != "—":
        hit = "false" if hit["free"] else "true"
    if held != "—":
        held = held["inside"][0]["answer"]
    return [hit, "true" if share < 0 else "false" if share > 1 else "either", held, "true" if share < -1 else "false" if share > 0 else "either"]
