"""Plots how many vertices an outer mesh needs over how far it may be from the original.

usage: vertices_over_distance.py MESH [PICTURE.svg]

With matplotlib, if it is there, as PNG, PDF or SVG; else as an SVG drawn here.
"""
import sys

import kaboum


def points(file, shares=(0.1, 0.2, 0.5, 1, 2, 5)):
    """Pairs of epsilon in percent of the diagonal, and vertices."""
    prepared = kaboum.prepare(file)  # once for all
    return [(share, len(kaboum.decimate(prepared, epsilon=f"{share}%").vertices)) for share in shares]


def draw_svg(data, file):
    import math

    width, height, edge = 480, 320, 50
    xs, ys = ([math.log10(p[k]) for p in data] for k in (0, 1))
    place = lambda v, values, size: edge + (v - min(values)) / ((max(values) - min(values)) or 1) * (size - 2 * edge)
    dots = [(place(x, xs, width), height - place(y, ys, height)) for x, y in zip(xs, ys)]
    with open(file, "w") as f:
        f.write(f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" '
                f'font-size="11">\n<rect width="{width}" height="{height}" fill="white"/>\n')
        f.write('<polyline fill="none" stroke="#36c" points="' + " ".join(f"{x:.1f},{y:.1f}" for x, y in dots) + '"/>\n')
        for (x, y), (share, vertices) in zip(dots, data):
            f.write(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="#36c"/>'
                    f'<text x="{x + 5:.1f}" y="{y - 5:.1f}">{vertices} at {share} %</text>\n')
        f.write(f'<text x="{width / 2:.0f}" y="{height - 12}" text-anchor="middle">epsilon, % of the diagonal (log)</text>\n'
                f'<text x="12" y="20">vertices (log)</text>\n</svg>\n')


def draw(data, file):
    try:
        from matplotlib import pyplot
    except ImportError:
        return draw_svg(data, file)
    pyplot.loglog(*zip(*data), marker="o")
    pyplot.xlabel("epsilon, % of the diagonal")
    pyplot.ylabel("vertices")
    pyplot.savefig(file)


if __name__ == "__main__":
    found = points(sys.argv[1])
    for share, vertices in found:
        print(f"{share:5} %  {vertices:8} vertices")
    if len(sys.argv) > 2:
        draw(found, sys.argv[2])
