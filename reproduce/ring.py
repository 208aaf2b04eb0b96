"""Figure 4.8: a thin ring, which n equal segments cover best; the distance falls with the square of n."""

import math

from calls import Calls
from document import figure
from sweeps import slope

SEGMENTS, THIN, HEIGHT = 720, 0.002, 0.1  # of the mesh; radius 1
COUNTS = (4, 8, 12, 16, 20, 24, 32, 48)
QUICK_COUNTS = (4, 8, 16, 24, 32)
VERTICES = 8  # of a body, as in the thesis


def write_ring(path):
    """A closed ring of radius 1 as OBJ: four circles of vertices, four quads of triangles between each two."""
    corners = [(1 - THIN, -HEIGHT / 2), (1, -HEIGHT / 2), (1, HEIGHT / 2), (1 - THIN, HEIGHT / 2)]
    with open(path, "w", encoding="utf-8") as file:
        for i in range(SEGMENTS):
            angle = 2 * math.pi * i / SEGMENTS
            file.writelines(f"v {r * math.cos(angle)!r} {r * math.sin(angle)!r} {z!r}\n" for r, z in corners)
        for i in range(SEGMENTS):
            here, onward = 4 * i, 4 * ((i + 1) % SEGMENTS)
            for k in range(4):
                a, b = here + k + 1, here + (k + 1) % 4 + 1
                c, d = onward + k + 1, onward + (k + 1) % 4 + 1
                file.write(f"f {a} {b} {d}\nf {a} {d} {c}\n")


def section(context, document):
    if context.collecting:
        return
    document.heading("Figure 4.8: a thin ring")
    if not (context.runner.programs / "bcd-decompose").is_file():
        document.paragraph("Left out: bcd-decompose is not built; scripts/build makes it.")
        return
    call = Calls(context, "ring")
    mesh = call.folder / "ring.obj"
    write_ring(mesh)
    lines, points, shown = [], [], None
    for n in QUICK_COUNTS if context.quick else COUNTS:
        name, picture = f"ring-{n}", ["--preview", f"ring-{n}.png"] if n == 8 else []
        if call(name, call.programs / "bcd-decompose",
                [mesh, "-o", f"{name}.obj", "--max-bodies", n, "--max-vertices-per-body", VERTICES, "--report", f"{name}-report.json",
                 *picture], [mesh], [f"{name}.obj", f"{name}-report.json", *picture[1:]], (0, 1)) is None:
            continue
        report = call.report(f"{name}-report.json")
        reach = report["reach"]["upper"]
        half = math.pi / report["bodies"]
        inwards = (1 - THIN) * (1 - math.cos(math.pi / n))  # of as many segments as are allowed
        lines.append([str(n), str(report["bodies"]), str(report["vertices"]), figure(reach), figure(inwards), f"{reach / inwards:.2f}",
                      figure(1 / math.cos(half) - 1), figure(1 - math.cos(math.pi / (2 * n)))])
        points.append((report["bodies"], reach))
        if n == 8:
            shown = call.folder / f"ring-{n}.png"
    if not lines:
        return
    document.paragraph(
        f"A ring of radius 1, {THIN} thin, {HEIGHT} high, of {SEGMENTS} segments, covered by at most n bodies with {VERTICES} vertices each. The "
        "farthest point of the union from the ring is certified. Equal segments reach 1 − cos(π/n) inwards, in the middle of a chord, and "
        "1/cos(π/n) − 1 outwards, at the corners of trapezoids whose outer sides touch the ring. The thesis prints 1 − cos(π/2n), which is that of a segment of half the angle.")
    document.table(["n", "bodies", "vertices", "distance", "equal segments, inwards", "distance ÷ equal segments", "outwards", "as printed"], lines)
    if len(points) > 1:
        rises = [f"{b} bodies are farther away than {a}" for (a, x), (b, y) in zip(points, points[1:]) if y > x]
        document.paragraph(f"The distance goes with the number of bodies to the power {slope(points):.2f}; −2 is quadratic. "
                           + (f"**Not monotone: {'; '.join(rises)}.**" if rises else "More bodies are nearer throughout."))
    if shown and shown.is_file():
        document.picture(shown, "Figure 4.8: a thin ring and eight bodies; right: taken apart")
