#!/usr/bin/env python3
"""Draws the times that collision-benchmark wrote: one distribution per library and model.

usage: plot.py TIMES.csv OUT.svg
"""

import csv
import math
import sys

COLOURS = {"triangle meshes": "#c0504d", "hulls of links": "#4f81bd", "bounding sets": "#5d9b4c"}
BINS, ROW, LEFT, WIDTH = 120, 46, 210, 640


def main() -> int:
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    times: dict[tuple[str, str], list[float]] = {}
    with open(sys.argv[1], newline="") as file:
        for row in csv.DictReader(file):
            key = (row["library"], row["model"])
            times.setdefault(key, []).append(max(float(row["microseconds"]), 0.01))
    if not times:
        print("plot.py: no times in " + sys.argv[1], file=sys.stderr)
        return 3
    low = math.floor(math.log10(min(min(t) for t in times.values())))
    high = math.ceil(math.log10(max(max(t) for t in times.values())))
    height = ROW * len(times) + 50

    def x_of(microseconds: float) -> float:
        return LEFT + WIDTH * (math.log10(microseconds) - low) / (high - low)

    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{LEFT + WIDTH + 40}" height="{height}" '
        'font-family="sans-serif" font-size="12">',
        '<rect width="100%" height="100%" fill="white"/>',
    ]
    for power in range(low, high + 1):
        x = x_of(10**power)
        label = f"{10**power:g} µs" if power < 3 else f"{10 ** (power - 3):g} ms"
        out.append(f'<line x1="{x}" x2="{x}" y1="10" y2="{height - 35}" stroke="#ddd"/>')
        out.append(f'<text x="{x}" y="{height - 15}" text-anchor="middle">{label}</text>')
    for number, ((library, model), values) in enumerate(times.items()):
        base = 10 + ROW * (number + 1) - 6
        counts = [0] * BINS
        for value in values:
            place = (math.log10(value) - low) / (high - low)
            counts[min(int(place * BINS), BINS - 1)] += 1
        most = max(counts)
        points = [f"{LEFT},{base}"]
        for i, count in enumerate(counts):
            points.append(f"{LEFT + WIDTH * (i + 0.5) / BINS},{base - (ROW - 14) * count / most}")
        points.append(f"{LEFT + WIDTH},{base}")
        colour = COLOURS.get(model, "#777")
        out.append(f'<polygon points="{" ".join(points)}" fill="{colour}" fill-opacity="0.7"/>')
        for value in (sum(values) / len(values), max(values)):
            x = x_of(value)
            out.append(f'<line x1="{x}" x2="{x}" y1="{base}" y2="{base - ROW + 14}" stroke="black"/>')
        out.append(f'<text x="10" y="{base - 4}">{library}: {model}</text>')
    out.append("</svg>\n")
    with open(sys.argv[2], "w") as file:
        file.write("\n".join(out))
    return 0


if __name__ == "__main__":
    sys.exit(main())
