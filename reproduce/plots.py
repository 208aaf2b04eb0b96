"""Plots of distance over vertices as SVG, drawn by gnuplot."""

import dataclasses
import shutil
import subprocess

# Wong's colours, told apart by the colour-blind too.
COLOURS = {"planes": "#0072b2", "planes-adapted": "#e69f00", "planes-diagonal": "#cc79a7",
           "triangles": "#009e73", "distance": "#000000",
           "30 bodies": "#0072b2", "64 bodies": "#000000", "105 bodies": "#e69f00"}
LARGEST = 30  # percent of the diagonal: spikes beyond it would squeeze everything else
POINTS = {"planes": 4, "planes-adapted": 6, "planes-diagonal": 8, "triangles": 10, "distance": 7,
          "30 bodies": 4, "64 bodies": 7, "105 bodies": 6}


@dataclasses.dataclass
class Curve:
    cost: str
    points: list  # (vertices, percent of the diagonal)
    thesis: bool = False


def _quoted(text):
    return "'" + text.replace("'", "''") + "'"


def available():
    return shutil.which("gnuplot") is not None


def distance_plot(path, panels, across="vertices"):
    """Writes `path` (.svg) and the gnuplot script beside it.

    `panels`: rows of two (title, label of the vertical axis, curves).
    """
    script = [
        f"set terminal svg size 1040,{40 + 430 * (len(panels) // 2)} enhanced font 'sans-serif,13'"
        " background '#ffffff'",
        f"set output '{path.name}'",
        f"set multiplot layout {len(panels) // 2},2",
        "set logscale xy",
        "set grid xtics ytics mxtics mytics lc rgb '#b0b0b0' lw 0.6, lc rgb '#dddddd' lw 0.4",
        "set format y '%g %%'", "set format x '%.0f'", f"set xlabel {_quoted(across)}",
        "set tics font ',11'", "set key bottom left Left reverse font ',11' samplen 3 spacing 1.1",
    ]
    every = [n for _, _, curves in panels for curve in curves for n, _ in curve.points]
    script.append(f"set xrange [{min(every) / 1.25:g}:{max(every) * 1.25:g}]")
    ticks = [n for n in (156, 312, 625, 1250, 2500, 5000, 10000, 20000, 40000) if
             min(every) / 1.25 <= n <= max(every) * 1.25]
    script.append("set xtics (" + ", ".join(f"'{n:,}' {n}" for n in ticks) + ")")
    for number, (title, label, curves) in enumerate(panels):
        if not curves:
            script.append("set multiplot next")
            continue
        row = panels[number - number % 2:][:2]  # the same axis for outer and inner
        values = [y for _, _, beside in row for curve in beside for _, y in curve.points if y > 0]
        script += [f"set title {_quoted(title)} noenhanced", f"set ylabel {_quoted(label)}",
                   f"set yrange [{min(values) / 1.5:g}:{min(max(values) * 1.5, LARGEST):g}]"]
        drawn = []
        for i, curve in enumerate(curves):
            block = f"$data_{number}_{i}"
            script += [f"{block} << end"] + [f"{n} {y:.6g}" for n, y in sorted(curve.points)] + ["end"]
            colour, point = COLOURS[curve.cost], POINTS[curve.cost]
            width = 2.6 if curve.cost == "distance" else 1.6
            name = f"thesis, {curve.cost}" if curve.thesis else curve.cost
            dash = "dt 3 lw 1.2" if curve.thesis else f"lw {width}"
            point = 3 if curve.thesis else point
            drawn.append(f"{block} using 1:2 with linespoints {dash} pt {point} ps 0.7 "
                         f"lc rgb '{colour}' title '{name}' noenhanced")
        script.append("plot " + ", \\\n  ".join(drawn))
    script.append("unset multiplot")
    source = path.with_suffix(".gp")
    source.write_text("\n".join(script) + "\n", encoding="utf-8")
    subprocess.run(["gnuplot", source.name], cwd=path.parent, check=True)
