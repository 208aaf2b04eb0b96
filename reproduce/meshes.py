"""Meshes as Python reads and writes them: OBJ and OFF, and the VRML that the author's decomposition writes."""

import math
import re


def read_off(path):
    """Points as tuples, triangles as indices."""
    with open(path, encoding="utf-8") as file:
        words = [word for line in file for word in line.split("#")[0].split()]
    words = words[1:] if words[0] == "OFF" else words
    n, m = int(words[0]), int(words[1])
    points = [tuple(map(float, words[3 + 3 * i:6 + 3 * i])) for i in range(n)]
    triangles, at = [], 3 + 3 * n
    for _ in range(m):
        size = int(words[at])
        corners = [int(w) for w in words[at + 1:at + 1 + size]]
        triangles += [[corners[0], b, c] for b, c in zip(corners[1:], corners[2:])]
        at += 1 + size
    return points, triangles


def read_obj(path):
    """The same of an OBJ file, whatever its objects."""
    points, triangles = [], []
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("v "):
                points.append(tuple(map(float, line.split()[1:4])))
            elif line.startswith("f "):
                corners = [int(word.split("/")[0]) - 1 for word in line.split()[1:]]
                triangles += [[corners[0], b, c] for b, c in zip(corners[1:], corners[2:])]
    return points, triangles


def write_off(path, points, triangles):
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        file.writelines("{!r} {!r} {!r}\n".format(*p) for p in points)
        file.writelines("3 {} {} {}\n".format(*t) for t in triangles)


def write_objects(path, bodies):
    """An OBJ with one object per body, each points and triangles."""
    first = 1
    with open(path, "w", encoding="utf-8") as file:
        for number, (points, triangles) in enumerate(bodies):
            file.write(f"o body-{number:04}\n")
            file.writelines("v {!r} {!r} {!r}\n".format(*p) for p in points)
            file.writelines("f " + " ".join(str(i + first) for i in t) + "\n" for t in triangles)
            first += len(points)


def read_vrml_sets(path):
    """The bodies of a VRML file of indexed face sets, as bounding-convex-decomposition writes it."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    bodies = []
    for points, corners in re.findall(r"point\s*\[([^\]]*)\].*?coordIndex\s*\[([^\]]*)\]", text, re.S):
        numbers = [float(w) for w in points.replace(",", " ").split()]
        faces, face = [], []
        for word in corners.replace(",", " ").split():
            if word == "-1":
                faces += [[face[0], b, c] for b, c in zip(face[1:], face[2:])]
                face = []
            else:
                face.append(int(word))
        bodies.append((list(zip(numbers[::3], numbers[1::3], numbers[2::3])), faces))
    return bodies


def diagonal(points):
    return math.dist(*([f(axis) for axis in zip(*points)] for f in (min, max)))


def without_border(points, triangles):
    """The triangles that have no corner on an edge of one triangle alone, and the points as they are."""
    edges = {}
    for t in triangles:
        for a, b in zip(t, t[1:] + t[:1]):
            edges[frozenset((a, b))] = edges.get(frozenset((a, b)), 0) + 1
    border = {i for edge, count in edges.items() if count == 1 for i in edge}
    kept = [t for t in triangles if not border & set(t)]
    number = {i: n for n, i in enumerate(sorted({i for t in kept for i in t}))}
    return [points[i] for i in number], [[number[i] for i in t] for t in kept]
