"""The report: which runs each table and figure needs, and how it is made of their results.

A section is a function (Context, Document) that asks for its runs with `context.row` and adds blocks to
the document; SECTIONS lists them. Every section is called twice: first to collect the runs that it asks
for, then, with the results there, to be written.
"""

import subprocess
import sys
import time
import traceback

import author
import executions
import gains
import illustrations
import keep
import peers
import plots
import ring
import sampling
import scenarios
import sets
import sweeps
import thesis
from document import Document, figure, written
from lines import DIRECTIONS, HEADER, NOTHING, TABLE_COUNTS, count, distances, result_line, robots, table_row, write_table
from runs import OURS, THESIS_COSTS, Run

SERIES = (40000, 20000, 10000, 5000, 2500, 1250, 625, 312, 156)


class Context:
    """What a section may ask for."""

    def __init__(self, models, runner, folder, quick, others=None):
        """@param others  programs of others, by their names: boundingmesh, bounding-convex-decomposition, python (which has the packages of
        requirements.txt)"""
        self.models, self.runner, self.folder, self.quick, self.others = models, runner, folder, quick, others or {}
        self.collecting = True
        self.wanted = []

    def row(self, run):
        """The result of a run; None while collecting, and where it failed."""
        if self.collecting:
            self.wanted.append(run)
            return None
        return self.runner.results.get(run)

    def counts(self, model, wanted):
        """Of the wanted vertex counts those that are a simplification of the model."""
        return [n for n in wanted if n <= 0.9 * model.vertices()]

    def series(self, model):
        """The vertex counts of a figure."""
        total = model.vertices()
        counts = [n for n in SERIES if n <= 0.7 * total and (n >= 1250 or n >= 0.015 * total)]
        return counts[::2] if self.quick else counts


def models_section(context, document):
    document.heading("Models")
    document.paragraph(
        "The robots of the thesis are not public. These are the same makers' robots as far as published, "
        "with other and coarser tessellations: distances in percent of the diagonal can be compared, if "
        "with care; a given number of vertices is a milder simplification of a coarser mesh, but a coarser "
        "mesh also has sharper features to lose. Open meshes bound no solid: enclosure is then certified "
        "of the generalised winding number only, and bmesh-decimate contracts without global optimisation.")
    rows, printed = [], thesis.diagonals()
    for model in context.models:
        any_run = next((row for run, row in context.runner.results.items() if run.model == model), None)
        diagonal = NOTHING if any_run is None else f"{any_run['diagonal']:.4g}"
        rows.append([
            model.title, f"{model.thesis} (Figure {model.figure})" if model.thesis else NOTHING,
            count(model.thesis_vertices) if model.thesis_vertices else NOTHING, count(model.vertices()),
            f"{printed[model.thesis] / 1000:.4g} m" if model.thesis in printed else NOTHING, diagonal,
            NOTHING if any_run is None else "closed" if any_run["closed"] else "open",
            model.differs or "not in the thesis; for Proposition 1"])
    document.table(["model", "stands for", "its vertices", "vertices here", "its diagonal", "diagonal here",
                    "surface", "how it differs"], rows)


def table_4_2_section(context, document):
    document.heading("Table 4.2: bounding meshes of robots, outer and inner")
    document.paragraph(
        "o→a: distances from the original to the approximation, a→o: back; in percent of the diagonal of "
        "the respective original. The thesis optimises plane distances with adaptation of the constant "
        "term (planes-adapted). Maxima of ours are certified upper bounds, means come from 100,000 samples "
        "a side; all are measured against the published file without its inner walls and sheets. All "
        "minima are 0, as in the thesis. Counts that are no simplification of our mesh are left out. CSV: "
        "table-4-2.csv (with the thesis's millimetres).")
    table, mm = [], thesis.table_4_2()
    for model in robots(context, document):
        document.heading(f"{model.thesis} ({model.title} here)", 3)
        for direction in DIRECTIONS:
            lines = []
            for n in TABLE_COUNTS:
                for row in (r for r in mm if (r.model, r.direction, r.vertices) == (model.thesis, direction, n)):
                    lines.append([count(n), "thesis", *distances(row.percent), ""])
                    table.append(table_row([model.thesis, direction, n], "thesis", row.percent, row.mm))
                if n not in context.counts(model, TABLE_COUNTS):
                    continue
                for cost in ("planes-adapted", OURS):
                    row = context.row(Run(model, direction, cost, vertices=n))
                    lines.append(result_line(row, n, cost))
                    if row:
                        table.append(table_row([model.name, direction, n], cost, row))
            document.paragraph(f"{direction.capitalize()} bounding meshes")
            document.table(["vertices", "by", *HEADER, "user time"], lines)
    if not context.collecting:
        write_table(context.folder / "table-4-2.csv", ["model", "direction", "vertices"], table)


def same_share_section(context, document):
    """Table 4.2 again with the shares of the original's vertices that the thesis's counts are."""
    document.heading("Table 4.2 at the same share of the vertices")
    document.paragraph(
        "Our robots have fewer vertices than the thesis's, so the same numbers of vertices flatter us. "
        "Here the targets are the same shares of the original's vertices instead, which is harder than the "
        "thesis's: the shapes are about as complex, but get far fewer vertices. The truth for the thesis's "
        "own meshes lies in between.")
    for model in robots(context, document):
        lines = []
        for direction in DIRECTIONS:
            for row in (r for r in thesis.table_4_2() if (r.model, r.direction) == (model.thesis, direction)):
                share = row.vertices / model.thesis_vertices
                target = round(share * model.vertices())
                first = f"{direction} {100 * share:.1f} %"
                lines.append([first, count(row.vertices), "thesis", *distances(row.percent), ""])
                for cost in ("planes-adapted", OURS):
                    result = context.row(Run(model, direction, cost, vertices=target))
                    lines.append([first, *result_line(result, target, cost)])
        document.heading(f"{model.thesis} ({model.title} here)", 3)
        document.table(["share", "vertices", "by", *HEADER, "user time"], lines)


def table_b_1_section(context, document):
    document.heading("Table B.1: cost functions, outer")
    document.paragraph(
        "The thesis's costs as we run them (bmesh-decimate --effort fast), each beside the thesis's "
        "figures for it; `planes` also without the planes that it puts on sharp edges (--sharp-angle 180), which is Eq. 4.4 "
        "as printed; then our cost, the measured distance, with --effort normal. CSV: "
        "table-b-1.csv.")
    table = []

    def add_ours(model, n, cost, lines, sharp_angle=0):
        if n not in context.counts(model, TABLE_COUNTS):
            return
        row = context.row(Run(model, "outer", cost, vertices=n, sharp_angle=sharp_angle))
        name = f"{cost}, no planes at edges" if sharp_angle else cost
        lines.append(result_line(row, n, name))
        if row:
            table.append(table_row([model.name, n, name], "kaboum", row))

    for model in robots(context, document):
        lines = []
        for n in TABLE_COUNTS:
            for cost in thesis.COSTS.values():
                for row in (r for r in thesis.table_b_1()
                            if (r.model, r.cost, r.vertices) == (model.thesis, cost, n)):
                    lines.append([count(n), f"thesis, {cost}", *distances(row.percent), ""])
                    table.append(table_row([model.thesis, n, cost], "thesis", row.percent, row.mm))
                add_ours(model, n, cost, lines)
                if cost == "planes":
                    add_ours(model, n, cost, lines, sharp_angle=180)
            add_ours(model, n, OURS, lines)
        document.heading(f"{model.thesis} ({model.title} here)", 3)
        document.table(["vertices", "by", *HEADER, "user time"], lines)
    if not context.collecting:
        write_table(context.folder / "table-b-1.csv", ["model", "vertices", "cost"], table)


def figures_section(context, document):
    document.heading("Figures B.3–B.7: distance over vertices")
    document.paragraph(
        "Upper row: Hausdorff distance, certified. Lower row: mean distance, the larger one of both ways. "
        f"Percent of the diagonal, both axes logarithmic; cut off at {plots.LARGEST} %, where only spikes "
        "are. Dotted: the thesis's tables, of its own models.")
    printed = [*(r for r in thesis.table_4_2() if r.direction == "inner"), *thesis.table_b_1()]
    costs = [c for c in THESIS_COSTS if not context.quick or c != "planes-diagonal"] + [OURS]
    for model in sorted((m for m in context.models if m.figure or not m.robot), key=lambda m: m.figure):
        panels = []
        for value, label in (("hausdorff", "Hausdorff distance"), ("mean", "mean distance")):
            for direction in DIRECTIONS:
                curves = []
                for cost in costs:
                    rows = [context.row(Run(model, direction, cost, vertices=n)) for n in context.series(model)]
                    curves.append(plots.Curve(cost, [(r["vertices"], r[value]) for r in rows if r]))
                for cost in thesis.COSTS.values():
                    points = [(r.vertices, r.percent[value]) for r in printed
                              if (r.model, r.direction, r.cost) == (model.thesis, direction, cost)]
                    curves.append(plots.Curve(cost, points, thesis=True))
                panels.append((f"{model.title}, {direction}", label, [c for c in curves if c.points]))
        if context.collecting or not any(curves for _, _, curves in panels) or not plots.available():
            continue
        number = model.figure.lower().replace(".", "")
        path = context.folder / ("-".join(filter(None, ("figure", number, model.name))) + ".svg")
        plots.distance_plot(path, panels)
        document.picture(path, (f"Figure {model.figure}: " if model.figure else "") + f"{model.title}, "
                         f"{count(model.vertices())} vertices" + (f"; {model.differs}" if model.differs else ""))
    if not plots.available():
        document.paragraph("Left out: gnuplot is not installed (scripts/setup --reproduce).")


def pictures_section(context, document):
    document.heading("Figures 4.6, B.1 and B.2: series of bounding meshes")
    document.paragraph("--cost distance --effort normal. Orange encloses the original, blue lies inside it. "
                       "ε: certified Hausdorff distance in percent of the diagonal.")
    figures = {"MITSUBISHI": "Figure 4.6", "KUKA": "Figure B.1", "COMAU": "Figure B.2"}
    for model in (m for m in context.models if m.thesis in figures or not (m.thesis or m.robot)):
        wanted = TABLE_COUNTS if model.thesis else context.series(model)
        for direction, colour in (("outer", "orange"), ("inner", "blue")):
            counts = context.counts(model, wanted)[-3:]
            if context.quick and model.thesis:
                counts = [n for n in counts if n in context.series(model)]
            rows = [row for n in counts if (row := context.row(Run(model, direction, OURS, vertices=n)))]
            if context.collecting or not rows:
                continue
            path = context.folder / f"picture-{model.name}-{direction}.png"
            titles = [f"original {model.vertices()}"] + [f"{r['vertices']}: {r['hausdorff']:.2f} %" for r in rows]
            subprocess.run([context.runner.programs / "mesh-picture", model.path, *(r["mesh"] for r in rows), "-o",
                            path, "--titles", ",".join(titles), "--colours", f"grey,{colour}", "--width",
                            str(420 * len(titles)), "--height", "620", "--view", model.view], check=True)
            text = ", ".join(f"{count(r['vertices'])} vertices ε < {r['hausdorff']:.2f} %" for r in rows)
            document.picture(path, f"{figures.get(model.thesis, 'Series')}, {direction}: {model.title}, original "
                             f"with {count(model.vertices())} vertices; {text}")


def proposition_1_section(context, document):
    document.heading("Proposition 1")
    document.paragraph(
        "“The bounding mesh algorithm can reduce most robot geometries to an enclosing single-sided "
        "approximation at the order of 4,000–12,000 vertices within a precision of 1% of the diagonal of "
        "the geometry. In relative numbers, most triangulations from CAD software can be compressed by a "
        "factor of 10–20 at this precision.”")
    lines = []
    for name in thesis.diagonals():
        for direction in DIRECTIONS:
            rows = [r for r in thesis.table_4_2() if (r.model, r.direction) == (name, direction)]
            n, total = thesis.vertices_within(rows, 1), thesis.original_vertices()[name]
            lines.append([name, direction, count(total), count(n) if n else "more than 20,000",
                          f"{total / n:.1f}×" if n else NOTHING])
    document.paragraph("What the thesis's Table 4.2 says of its own models, read off between its lines "
                       "(straight on logarithmic axes):")
    document.table(["model", "direction", "vertices", "needed for 1 %", "factor"], lines)

    document.paragraph("Ours: bmesh-decimate --epsilon 1%, as few vertices as a certified 1 % allows, and "
                       "the certified Hausdorff distance of the result. “Holds” where 12,000 vertices or "
                       "fewer, and a tenth of the original's or fewer, suffice; meshes of fewer than 4,000 "
                       "vertices are not counted. CSV: proposition-1.csv.")
    costs = ["planes-adapted", OURS] if context.quick else ["planes", "planes-adapted", OURS]
    lines, factors, needed, table = [], {}, {}, []
    for model in context.models:
        if not (model.robot or not model.thesis):
            continue
        for direction in DIRECTIONS:
            for cost in costs:
                row = context.row(Run(model, direction, cost, epsilon=1))
                if row is None:
                    lines.append([model.title, direction, cost, *[NOTHING] * 5, "no result"])
                    continue
                factor = row["vertices_in"] / row["vertices"]
                coarse = row["vertices_in"] < 4000
                if not coarse:
                    factors.setdefault((cost, direction), []).append(factor)
                    needed.setdefault((cost, direction), []).append(row["vertices"])
                small, compressed = row["vertices"] <= 12000, factor >= 10
                verdict = ("does not hold: beyond 1 %" if row["hausdorff_lower"] > 1 else
                           "does not apply: coarse already" if coarse else
                           "holds" if small and compressed else
                           "holds, but factor below 10" if small else "does not hold: more than 12,000 vertices")
                lines.append([model.title, direction, cost, count(row["vertices_in"]), count(row["vertices"]),
                              f"{factor:.1f}×", figure(row["hausdorff"]), f"{row['user_seconds']:.1f} s", verdict])
                table.append([model.name, direction, cost, row["vertices_in"], row["vertices"], factor,
                              row["hausdorff"], verdict])
    document.table(["model", "direction", "cost", "vertices", "at 1 %", "factor", "Hausdorff %", "user time",
                    "Proposition 1"], lines)
    for (cost, direction), values in factors.items():
        mean = _geometric_mean(values)
        document.paragraph(
            f"{cost}, {direction}: "
            f"{count(min(needed[cost, direction]))}–{count(max(needed[cost, direction]))} vertices where "
            f"the thesis says 4,000–12,000; factor {min(values):.1f}–{max(values):.1f}, geometric mean "
            f"{mean:.1f}, over {len(values)} model{'s'[:len(values) > 1]}, at least 10 on "
            f"{sum(v >= 10 for v in values)}, where the thesis says 10–20.")
    if not context.collecting:
        written(context.folder / "proposition-1.csv", ["model", "direction", "cost", "vertices_in", "vertices",
                                                       "factor", "hausdorff_percent", "verdict"], table)


def _geometric_mean(values):
    product = 1.0
    for value in values:
        product *= value
    return product ** (1 / len(values))


def resources_section(context, document):
    document.heading("Speed and memory")
    document.paragraph("The thesis: about 10,000 contractions per second on a 2.8 GHz desktop and 25 MB "
                       "for each 10,000 input vertices. Ours: one thread, user CPU time of the decimation "
                       "without reading and measuring, peak memory of the whole process, at the smallest "
                       "number of vertices of each series. Times on a shared machine are upper bounds.")
    lines = []
    costs = ("planes", "planes-adapted", "triangles", OURS)
    for model in (m for m in context.models if m.figure or not m.robot):
        for cost in costs:
            counts = context.series(model)
            row = context.row(Run(model, "outer", cost, vertices=counts[-1])) if counts else None
            if row:
                removed = row["vertices_in"] - row["vertices"]
                lines.append([model.title, cost, row["effort"], count(row["vertices_in"]), count(row["vertices"]),
                              count(round(removed / max(row["user_seconds"], 1e-3))),
                              f"{row['peak_megabytes'] / row['vertices_in'] * 1e4:.1f}"])
    document.table(["model", "cost", "effort", "vertices", "to", "contractions/s", "MB per 10,000 vertices"], lines)


# In the order of the report. Those that a quick run leaves out cost much and say least.
SECTIONS = {
    "models": models_section, "table-4-1": illustrations.table_4_1_section, "figure-4-1": illustrations.figure_4_1_section,
    "figure-4-4": illustrations.figure_4_4_section, "proposition-1": proposition_1_section, "printed": gains.printed_section,
    "table-4-2": table_4_2_section, "same-share": same_share_section, "table-b-1": table_b_1_section, "gains": gains.section,
    "author": author.section, "author-sets": author.sets_section, "figures": figures_section, "pictures": pictures_section,
    "sets": sets.section, "ring": ring.section, "sweeps": sweeps.section, "collisions": sweeps.collisions_section,
    "sampling": sampling.section, "figure-5-3": illustrations.figure_5_3_section, "circular-rearrange": scenarios.circular_section,
    "stacked": scenarios.stacked_section, "assembly": scenarios.assembly_section, "exact-meshes": scenarios.exact_section,
    "whole-searches": scenarios.whole_searches_section, "engine-searches": scenarios.engine_searches_section,
    "remove": scenarios.remove_section, "executions": executions.section,
    "simplifiers": peers.simplifiers_section, "wraps": peers.wraps_section, "coacd": peers.coacd_section, "motions": peers.motions_section,
    "resources": resources_section}
NOT_QUICK = {"same-share", "table-b-1"}


def _written(context, section, name):
    """The section's own document; what goes wrong in it is a failure of its own, and the others go on."""
    document = Document("")
    try:
        section(context, document)
    except Exception as error:  # pylint: disable=broad-except
        traceback.print_exc(file=sys.stderr)
        context.runner.failures[f"section {name}"] = f"{type(error).__name__}: {error}"
    return document


def make(models, runner, folder, quick, wanted=None, others=None):
    """Runs what is needed and writes report.md, index.html, results.json, the tables and figures into `folder`; `wanted`: names of SECTIONS,
    all where it is None. @return what is kept of the sections (keep.py)"""
    context = Context(models, runner, folder, quick, others)
    sections = {name: section for name, section in SECTIONS.items() if (name in wanted if wanted else not (quick and name in NOT_QUICK))}
    for section in sections.values():
        section(context, Document(""))
    context.collecting = False
    runner.run_all(sorted(dict.fromkeys(context.wanted), key=lambda run: run.model.vertices()))

    before = keep.read(folder)
    kind, made, start = "quick" if quick else "whole", {}, time.monotonic()
    names = ", ".join(model.name for model in models)
    document = Document("Figures of the thesis, reproduced" + (" (quick)" if quick else ""))
    document.paragraph(
        "Bounding meshes after A. Gaschler, Efficient Geometric Predicates for Integrated Task and Motion "
        "Planning: the figures that the thesis prints beside those of this build of KABouM. Written by "
        "scripts/reproduce-thesis.")
    for number, (name, section) in enumerate(sections.items()):
        left = list(sections)[number + 1:]
        print(f"[section {number + 1} of {len(sections)}, {(time.monotonic() - start) / 60:.0f} min] {name}" +
              (f"; left: {', '.join(left)}" if left else ""), file=sys.stderr, flush=True)
        runner.spent[:] = 0, 0
        part = _written(context, section, name)
        document.add(part)
        if f"section {name}" not in runner.failures and part.tables():
            made[name] = keep.made(part, runner.programs, runner.spent, names)
            keep.write(folder / "results.json", keep.merged(before, {kind: made}))
    if runner.failures:
        document.heading("Runs without a result")
        document.table(["run", "reason"], [[run if isinstance(run, str) else run.title(), why] for run, why in runner.failures.items()])
    results = {kind: made}
    keep.told(document, keep.read(keep.KEPT), results)
    rows = [{key: value for key, value in row.items() if key != "mesh"} for row in runner.results.values()]
    if rows:
        written(folder / "results.csv", rows[0].keys(), [row.values() for row in rows])
    (folder / "report.md").write_text(document.markdown(folder), encoding="utf-8")
    (folder / "index.html").write_text(document.html(), encoding="utf-8")
    return results
