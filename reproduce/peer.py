"""The thesis author's public implementation (https://github.com/gaschler/bounding-mesh) on the same files, where a user has built it."""

import lines
from calls import Calls
from document import written
from runs import OURS, Run

METRICS = {"QEM_Classic": "planes", "MinConstant": "planes-adapted"}  # its name -> ours


def _off(call, model, context):
    """The model as the other program reads it, prepared as ours is; None where that failed."""
    name = f"{model.name}-prepared.off"
    code = call(f"{model.name}-prepared", call.programs / "bmesh-decimate",
                [model.path, "-o", name, "--drop-sheets", "--holes", "keep", "--precision", "double", "--vertices", 10 ** 9, "--quiet"],
                [model.path], [name], (0, 1))
    return None if code is None else call.folder / name


def _run(call, program, model, original, n, metric):
    """A row; None where it failed, which is noted."""
    name = f"{model.name}-{metric}-{n}"
    if call(name, program, ["--direction", "Outward", "--metric", metric, "--vertices", n, original, f"{name}.off"], [original],
            [f"{name}.off"]) is None:
        return None
    here = call.folder / f"{name}.off"
    if call(f"{name}-distance", call.programs / "hausdorff-eval", [original, here, "--threads", "1", "--quiet", "--report",
                                                                  f"{name}-report.json"],
            [original, here], [f"{name}-report.json"], (0, 7)) is None:
        return None
    report = call.report(f"{name}-report.json")
    percent, there, back = 100 / report["bbox_diagonal"], report["a_to_b"], report["b_to_a"]
    with open(here, encoding="utf-8") as file:
        vertices = next(int(line.split()[0]) for line in list(file)[1:] if line.strip() and not line.startswith("#"))
    row = {"vertices": vertices, "o2a_mean": percent * there["mean"], "o2a_max": percent * there["max_upper"],
           "a2o_mean": percent * back["mean"], "a2o_max": percent * back["max_upper"], "user_seconds": call.seconds(name)}
    row["hausdorff"] = max(row["o2a_max"], row["a2o_max"])
    return row


def section(context, document):
    document.heading("The author's implementation on the same files")
    if context.peer is None:
        document.paragraph("Left out: --bounding-mesh PROGRAM takes the program `boundingmesh`, built from "
                           "https://github.com/gaschler/bounding-mesh.")
        return
    document.paragraph(
        "boundingmesh --direction Outward, with the metric that is the thesis's cost, beside ours, on the same prepared files; "
        "distances measured by hausdorff-eval, in percent of the diagonal. Whether its results enclose is not judged here: the "
        "robots are open. Its time includes reading and writing. CSV: bounding-mesh.csv.")
    call = None if context.collecting else Calls(context, "bounding-mesh")
    table = []
    for model in (m for m in context.models if m.thesis and m.vertices() < 100000):
        original = None if call is None else _off(call, model, context)
        rows = []
        for n in context.counts(model, lines.TABLE_COUNTS[1:3] if context.quick else lines.TABLE_COUNTS):
            for metric, cost in METRICS.items():
                row = None if original is None else _run(call, context.peer, model, original, n, metric)
                ours = context.row(Run(model, "outer", cost, vertices=n))
                rows += [lines.result_line(row, n, f"boundingmesh, {metric}"), lines.result_line(ours, n, cost)]
                table += [lines.table_row([model.name, n, cost], by, found) for by, found in (("boundingmesh", row), ("kaboum", ours)) if found]
            ours = context.row(Run(model, "outer", OURS, vertices=n))
            rows.append(lines.result_line(ours, n, OURS))
        if call:
            document.heading(model.title, 3)
            document.table(["vertices", "by", *lines.HEADER, "user time"], rows)
    if call:
        lines.write_table(context.folder / "bounding-mesh.csv", ["model", "vertices", "cost"], table)
