"""What our cost gives and what our optimiser gives: the thesis's cost with and without the optimiser, and ours."""

import math

import thesis
from document import figure
from lines import DIRECTIONS, HEADER, count, result_line, robots
from runs import OURS, Run

COSTS = ("planes-adapted", OURS)
EFFORTS = ("fast", "normal")  # contraction alone, as in the thesis; vertices are moved afterwards
COUNTS = (10000, 5000, 2500)
QUICK_COUNTS = (5000,)
VALUES = (("hausdorff", "Hausdorff"), ("mean", "mean"))


def ratio_line(name, pairs):
    """Geometric means of after / before, by value."""
    cells = []
    for value, _ in VALUES:
        logs = [math.log(after[value] / before[value]) for before, after in pairs if before[value] > 0 and after[value] > 0]
        cells.append(f"{math.exp(sum(logs) / len(logs)):.2f}×" if logs else "—")
    seconds = [after["user_seconds"] / max(before["user_seconds"], 1e-3) for before, after in pairs]
    cells.append(f"{math.exp(sum(math.log(max(s, 1e-3)) for s in seconds) / len(seconds)):.1f}×" if seconds else "—")
    return [name, str(len(pairs)), *cells]


def section(context, document):
    document.heading("The two gains: cost and optimiser")
    document.paragraph(
        "The thesis's cost (planes-adapted) and ours (distance), each with contraction alone, as the thesis works (--effort "
        "fast), and with vertices moved afterwards (--effort normal). The second half says what each gives by itself: distances "
        "and time after the change over those before it, geometric means over all models, directions and numbers of vertices.")
    made = {}
    for model in (m for m in context.models if m.robot or not m.thesis):
        lines = []
        for direction in DIRECTIONS:
            for n in context.counts(model, QUICK_COUNTS if context.quick else COUNTS):
                for cost in COSTS:
                    for effort in EFFORTS:
                        row = context.row(Run(model, direction, cost, vertices=n, effort=effort))
                        title = f"{direction}, {cost}, {effort}"
                        lines.append(result_line(row, n, title))
                        if row:
                            made[model.name, direction, n, cost, effort] = row
        if not context.collecting:
            document.heading(f"{model.title}, {count(model.vertices())} vertices", 3)
            document.table(["vertices", "by", *HEADER, "user time"], lines)
    if context.collecting or not made:
        return
    cases = sorted({key[:3] for key in made})

    def gain(before, after):
        moved = before[1] != after[1]
        return [(made[*case, *before], made[*case, *after]) for case in cases
                if (*case, *before) in made and (*case, *after) in made and (made[*case, *after]["closed"] or not moved)]
    document.table(["change", "cases", *(label for _, label in VALUES), "user time"], [
        ratio_line("optimiser, on the thesis's cost", gain((COSTS[0], "fast"), (COSTS[0], "normal"))),
        ratio_line("optimiser, on our cost", gain((COSTS[1], "fast"), (COSTS[1], "normal"))),
        ratio_line("cost, without optimiser", gain((COSTS[0], "fast"), (COSTS[1], "fast"))),
        ratio_line("cost, with optimiser", gain((COSTS[0], "normal"), (COSTS[1], "normal"))),
        ratio_line("both", gain((COSTS[0], "fast"), (COSTS[1], "normal")))])


def printed_section(context, document):
    """Our cost beside what the thesis prints, and beside the thesis's cost as it is made here. A ratio is given for the latter alone: there
    mesh and machine are the same."""
    document.heading("Our cost, the thesis's cost made here, and the thesis's printed figures")
    document.paragraph(
        "Hausdorff distances in percent of the diagonal. The thesis's robots are other and finer meshes than those here, so what it prints is "
        "not of the same work: at the same number of vertices ours simplify less, at the same share of the vertices far more. No factor "
        "is given for it. The rows in which ours is farthest behind what is printed come first.")
    targets = []
    for model in robots(context, document):
        for row in thesis.table_4_2():
            if row.model != model.thesis:
                continue
            same, share = row.vertices, round(row.vertices / model.thesis_vertices * model.vertices())
            for kind, n in (("same number", same), ("same share", share)):
                if (kind, context.quick) == ("same share", True) or n > 0.9 * model.vertices():
                    continue
                again, ours = (context.row(Run(model, row.direction, cost, vertices=n)) for cost in ("planes-adapted", OURS))
                if again and ours:
                    targets.append((ours["hausdorff"] / row.percent["hausdorff"], kind, model, row, again, ours))
    for kind in ("same number", "same share"):
        chosen = sorted((t for t in targets if t[1] == kind), key=lambda t: -t[0])
        if not chosen:
            continue
        document.heading(f"At the {kind} of vertices", 3)
        document.table(
            ["robot", "direction", "the thesis's vertices", "vertices here", "printed", "planes-adapted here", "distance (ours)", "ours ÷ planes-adapted here"],
            [[model.title, row.direction, count(row.vertices), count(ours["vertices"]) , figure(row.percent["hausdorff"]), figure(again["hausdorff"]),
              figure(ours["hausdorff"]), f"{ours['hausdorff'] / again['hausdorff']:.2f}"] for _, _, model, row, again, ours in chosen])
        logs = [math.log(ours["hausdorff"] / again["hausdorff"]) for *_, again, ours in chosen]
        document.paragraph(
            f"Nearer than what is printed in {sum(t[0] < 1 for t in chosen)} of {len(chosen)} rows; nearer than the thesis's cost made here in "
            f"{sum(log < 0 for log in logs)}, by the geometric mean to {math.exp(sum(logs) / len(logs)):.2f} of its distance.")
