"""Meshes and robots of the scenarios, made from numbers: solids of revolution, boxes, arms with six axes and a
spherical wrist, arms with five axes on a mobile base, inner and outer grippers. Lengths are metres."""
import math

SEGMENTS = 32  # of a solid of revolution
detail = 1     # as many times as many segments, and rings of round ends
gaps = False   # links of arms end before the next one begins; else they overlap at joints, as those of real arms do


class Mesh:
    """Closed triangle mesh, normals outwards."""

    def __init__(self):
        self.vertices, self.triangles = [], []

    def add(self, other, shift=(0, 0, 0)):
        first = len(self.vertices)
        self.vertices += [tuple(a + b for a, b in zip(v, shift)) for v in other.vertices]
        self.triangles += [tuple(first + i for i in t) for t in other.triangles]
        return self

    def off(self):
        return (f"OFF\n{len(self.vertices)} {len(self.triangles)} 0\n" + "".join("%.9g %.9g %.9g\n" % v for v in self.vertices) +
                "".join("3 %d %d %d\n" % t for t in self.triangles))


def box(size, center=(0, 0, 0)):
    mesh = Mesh()
    x, y, z = (s / 2 for s in size)
    corners = [(sx * x, sy * y, sz * z) for sz in (-1, 1) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    mesh.vertices = [tuple(a + b for a, b in zip(c, center)) for c in corners]
    mesh.triangles = [(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4), (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6),
                      (3, 0, 4), (3, 4, 7)]
    return mesh


def quads(vertices, faces):
    mesh = Mesh()
    mesh.vertices = list(vertices)
    mesh.triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    return mesh


def crate(size, wall):
    """An open box with outer sides `size`; its floor is as thick as its walls. Stands on z = 0."""
    corners = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    x, y, z = size[0] / 2, size[1] / 2, size[2]
    rings = [(x, y, 0), (x, y, z), (x - wall, y - wall, z), (x - wall, y - wall, wall)]  # outside below, rim, floor
    vertices = [(sx * a, sy * b, h) for a, b, h in rings for sx, sy in corners]
    around = [(r + k, r + (k + 1) % 4, r + 4 + (k + 1) % 4, r + 4 + k) for r in (0, 4, 8) for k in range(4)]
    return quads(vertices, [(3, 2, 1, 0), *around, (12, 13, 14, 15)])


def rack(size, board):
    """A board, a back at the greatest x and a roof, open at the least x and at the ends along y. The board's top is z = 0."""
    x, y, z = size[0] / 2, size[1] / 2, size[2]
    outline = [(-x, -board), (x, -board), (x, z + board), (-x, z + board), (-x, z), (x - board, z), (x - board, 0), (-x, 0)]
    vertices = [(a, side, h) for side in (-y, y) for a, h in outline]
    ends = [(0, 1, 6, 7), (1, 2, 5, 6), (2, 3, 4, 5)]
    return quads(vertices, ends + [tuple(8 + k for k in face[::-1]) for face in ends] +
                 [(k, 8 + k, 8 + (k + 1) % 8, (k + 1) % 8) for k in range(8)])


def revolve(profile, closed=False):
    """A profile of (radius, height), from below to above on the outside; `closed`: a loop, as of a tube. Open profiles begin and
    end on the axis."""
    mesh, rings, segments = Mesh(), [], SEGMENTS * detail
    for r, z in profile:
        if r == 0:
            rings.append([len(mesh.vertices)] * segments)
            mesh.vertices.append((0.0, 0.0, z))
            continue
        rings.append(list(range(len(mesh.vertices), len(mesh.vertices) + segments)))
        mesh.vertices += [(r * math.cos(2 * math.pi * k / segments), r * math.sin(2 * math.pi * k / segments), z) for k in range(segments)]
    pairs = list(zip(rings, rings[1:])) + ([(rings[-1], rings[0])] if closed else [])
    for low, high in pairs:
        for k in range(segments):
            n = (k + 1) % segments
            if low[k] != low[n]:
                mesh.triangles.append((low[k], low[n], high[n]))
            if high[k] != high[n]:
                mesh.triangles.append((low[k], high[n], high[k]))
    return mesh


def rounded(low, high, radius, top=None):
    """A bar along z with round ends, perhaps tapered to the radius `top`."""
    top, rings = radius if top is None else top, 10 * detail
    profile = [(0.0, low)]
    for k in range(1, rings + 1):
        a = math.pi / 2 * k / rings
        profile.append((radius * math.sin(a), low + 0.5 * radius * (1 - math.cos(a))))
    for k in range(rings, 0, -1):
        a = math.pi / 2 * k / rings
        profile.append((top * math.sin(a), high - 0.5 * top * (1 - math.cos(a))))
    return revolve(profile + [(0.0, high)])


NECK = 0.012  # radius of a bottle's neck [m]


def bottle(height=0.16, radius=0.03, neck=NECK):
    """Standing on z = 0; the neck's top at z = height."""
    shoulder = 0.6 * height
    profile = [(0, 0), (radius - 0.003, 0), (radius, 0.003), (radius, shoulder)]
    for k in range(1, 8):  # the shoulder
        a = math.pi / 2 * k / 8
        profile.append((neck + (radius - neck) * math.cos(a), shoulder + 0.2 * height * math.sin(a)))
    profile += [(neck, 0.8 * height), (neck, height), (0, height)]
    return revolve(profile)


def tube(profile_outside, profile_inside):
    """Both from below to above."""
    return revolve(profile_outside + profile_inside[::-1], closed=True)


# ---- robots -------------------------------------------------------------------------------------------------------------------


def boxes_urdf(boxes):
    return "".join(f'<collision><origin xyz="{c[0]} {c[1]} {c[2]}"/><geometry><box size="{s[0]} {s[1]} {s[2]}"/></geometry></collision>'
                   for s, c in boxes)


def mesh_urdf(file):
    return f'<collision><geometry><mesh filename="{file}"/></geometry></collision>'


def gripper(kind):
    """Boxes of a hand along z of the last link, beyond 0.05, and where the tool is."""
    if kind == "suction":
        return [((0.03, 0.03, 0.07), (0, 0, 0.09))], 0.125
    if kind == "neck":  # two fingers round the neck of a bottle
        return ([((0.07, 0.03, 0.02), (0, 0, 0.07))] +
                [((0.008, 0.02, 0.06), (s * 0.020, 0, 0.11)) for s in (-1, 1)]), 0.135
    if kind == "outer":  # two long fingers round a part 50 mm wide
        return ([((0.09, 0.03, 0.02), (0, 0, 0.07))] +
                [((0.008, 0.02, 0.09), (s * 0.033, 0, 0.125)) for s in (-1, 1)]), 0.165
    if kind == "flat":  # two fingers round a plate 30 mm thick; the sides of the fingers push
        return ([((0.07, 0.03, 0.02), (0, 0, 0.07))] +
                [((0.008, 0.02, 0.09), (s * 0.024, 0, 0.125)) for s in (-1, 1)]), 0.165
    if kind == "inner":  # a pin that spreads inside of a ring
        return [((0.05, 0.05, 0.02), (0, 0, 0.07)), ((0.011, 0.011, 0.05), (0, 0, 0.105))], 0.125
    raise ValueError(kind)


# A gripper whose fingers move: two, along x of the hand, by one joint `finger`; its value is how far each pad is from the middle.
OPEN = 0.018   # of the fingers [m]
FORCE = 60     # with which a finger closes at most [N]
FINGERS = {"name": "fingers", "tool": "hand", "pads": ["pad_left", "pad_right"], "joints": ["finger"], "force": FORCE}


def fingers():
    """Boxes of the hand; further links and joints of the two fingers; where the tool is along z of the hand."""
    hand = [((0.09, 0.03, 0.02), (0, 0, 0.07))]
    links, joints = {}, []
    for side, s in (("left", 1), ("right", -1)):
        links[f"finger_{side}"] = boxes_urdf([((0.008, 0.02, 0.068), (s * 0.010, 0, 0.116))])
        links[f"pad_{side}"] = boxes_urdf([((0.006, 0.02, 0.03), (s * 0.003, 0, 0.135))])
        mimic = '<mimic joint="finger"/>' if side == "right" else ""
        joints.append(f'<joint name="finger{"" if side == "left" else "_right"}" type="prismatic"><parent link="hand"/>'
                      f'<child link="finger_{side}"/><axis xyz="{s} 0 0"/>'
                      f'<limit lower="0.004" upper="0.025" velocity="0.1" effort="{FORCE}"/>{mimic}</joint>'
                      f'<joint name="pad_{side}" type="fixed"><parent link="finger_{side}"/><child link="pad_{side}"/></joint>')
    return hand, links, "".join(joints), 0.135


def pushing_sides():
    """Planes of the flat gripper's link `hand` that push: the outer sides of its fingers, near their tips."""
    return [{"name": f"push{k}", "link": "hand", "plane": {"point": [s * 0.028, 0, 0.157], "normal": [s, 0, 0]}} for k, s in enumerate((1, -1))]


def bars(ends):
    """Links of an arm as bars along z: (low, high, radius[, radius at the top]), and how far each reaches beyond both of these where
    links have no gaps between them."""
    return {name: rounded(*bar) if gaps else rounded(bar[0] - below, bar[1] + above, *bar[2:]) for name, (bar, below, above) in ends.items()}


def arm6(prefix, hand, reach=1.0):
    """Six axes, spherical wrist. @return URDF, meshes by file, the tool's place along z of the link `hand`."""
    r = reach
    meshes = bars({
        "base": ((0, 0.2, 0.08), 0, 0.02),
        "shoulder": ((-0.14, -0.02, 0.06), 0, 0.06),
        "upper_arm": ((0, 0.5 * r, 0.045, 0.035), 0.03, 0.03),
        "elbow": ((0, 0.2 * r, 0.035, 0.03), 0.03, 0.02),
        "forearm": ((0.02, 0.22 * r, 0.03, 0.025), 0.03, 0.03 * r + 0.02),
        "wrist": ((0.0, 0.05, 0.022), 0.02, 0.02),
    })
    more, moving = {}, ""
    if hand == "fingers":
        boxes, more, moving, tool = fingers()
    else:
        boxes, tool = gripper(hand)
    links = {name: mesh_urdf(f"{prefix}-{name}.off") for name in meshes}
    links["hand"] = boxes_urdf(boxes)
    links.update(more)
    joints = [("j1", "base", "shoulder", 0.35, (0, 0, 1), 2.9), ("j2", "shoulder", "upper_arm", 0, (0, 1, 0), 2.2),
              ("j3", "upper_arm", "elbow", 0.5 * r, (0, 1, 0), 2.7), ("j4", "elbow", "forearm", 0.2 * r, (0, 0, 1), 3.1),
              ("j5", "forearm", "wrist", 0.25 * r, (0, 1, 0), 2.3), ("j6", "wrist", "hand", 0, (0, 0, 1), 3.1)]
    return urdf(prefix, links, joints, moving), {f"{prefix}-{n}.off": m for n, m in meshes.items()}, tool


def arm5(prefix, hand):
    """Five axes on a mobile base that is parked: turning, three parallel ones, and the hand's."""
    meshes = bars({
        "base": ((0, 0.22, 0.16), 0, 0.03),
        "shoulder": ((-0.09, -0.01, 0.06), 0, 0.05),
        "upper_arm": ((0, 0.4, 0.04, 0.035), 0.03, 0.03),
        "forearm": ((0.01, 0.35, 0.032, 0.028), 0.04, 0.03),
        "wrist": ((0.0, 0.05, 0.022), 0.02, 0.02),
    })
    boxes, tool = gripper(hand)
    links = {name: mesh_urdf(f"{prefix}-{name}.off") for name in meshes}
    links["hand"] = boxes_urdf(boxes)
    joints = [("j1", "base", "shoulder", 0.33, (0, 0, 1), 2.9), ("j2", "shoulder", "upper_arm", 0, (0, 1, 0), 2.2),
              ("j3", "upper_arm", "forearm", 0.4, (0, 1, 0), 2.7), ("j4", "forearm", "wrist", 0.36, (0, 1, 0), 2.3),
              ("j5", "wrist", "hand", 0, (0, 0, 1), 3.1)]
    return urdf(prefix, links, joints), {f"{prefix}-{n}.off": m for n, m in meshes.items()}, tool


def urdf(name, links, joints, more=""):
    text = f'<robot name="{name}">' + "".join(f'<link name="{n}">{shape}</link>' for n, shape in links.items())
    for joint, parent, child, z, axis, limit in joints:
        text += (f'<joint name="{joint}" type="revolute"><parent link="{parent}"/><child link="{child}"/><origin xyz="0 0 {z}"/>'
                 f'<axis xyz="{axis[0]} {axis[1]} {axis[2]}"/><limit lower="-{limit}" upper="{limit}" velocity="2" effort="1"/></joint>')
    return text + more + "</robot>\n"
