"""The thesis author's two public programs (https://github.com/gaschler/bounding-mesh) on the same files, where a user has built them."""

import judged
import lines
import meshes
import sets
from calls import Calls
from document import figure
from runs import OURS, Run

# Its name -> ours. Unless --init says otherwise, MinConstant begins with the distances to triangles' centres.
METRICS = {"QEM_Classic": "planes", "MinConstant": "triangles"}
COUNTS = (10000, 5000, 2500)
HEADER = ["vertices", "by", "original sticks out", *lines.HEADER, "verdict", "CPU time"]
WHERE = "built from https://github.com/gaschler/bounding-mesh"


def _closed(call, model):
    """The model closed, as OFF; None where that failed."""
    make = sets.Sets(call, model, True)
    name = f"{model.name}-closed.off"
    if not make.prepared():
        return None
    meshes.write_off(call.folder / name, *meshes.read_obj(make.closed))
    return call.folder / name


def _as_published(call, model):
    """The model as the other program reads it, prepared as ours is; None where that failed."""
    name = f"{model.name}-prepared.off"
    code = call(f"{model.name}-prepared", call.programs / "bmesh-decimate",
                [model.path, "-o", name, "--drop-sheets", "--holes", "keep", "--precision", "double", "--vertices", 10 ** 9, "--quiet"],
                [model.path], [name], (0, 1))
    return None if code is None else call.folder / name


def _judged(call, name, original, here, closed):
    """A row of a result; None where measuring failed."""
    row = judged.surfaces(call, name, original, here)
    if row is None:
        return None
    points, triangles = meshes.read_off(call.folder / here)
    row["vertices"], row["user_seconds"] = len(points), call.seconds(name)
    if closed:
        row["verdict"], row["out"] = judged.verdict(call, name, original, here, False)
    else:
        inner = f"{name}-no-border.off"
        meshes.write_off(call.folder / inner, *meshes.without_border(points, triangles))
        rest = judged.surfaces(call, f"{name}-no-border", original, inner)
        row["no_border"] = None if rest is None else rest["a2o_max"]
    return row


def _theirs(call, program, original, name, n, metric, closed):
    name = f"{name}-{metric}-{n}"
    if call(name, program, ["--direction", "Outward", "--metric", metric, "--vertices", n, original, f"{name}.off"], [original],
            [f"{name}.off"]) is None:
        return None
    return _judged(call, name, original, f"{name}.off", closed)


def _ours(call, original, name, n, cost, closed):
    name = f"{name}-{cost}-{n}"
    effort = "normal" if cost == OURS else "fast"
    if call(name, call.programs / "bmesh-decimate",
            [original, "-o", f"{name}.off", "--cost", cost, "--effort", effort, "--vertices", n, "--holes", "keep", "--precision", "double",
             "--threads", "1", "--quiet"], [original], [f"{name}.off"], (0, 1)) is None:
        return None
    return _judged(call, name, original, f"{name}.off", closed)


def _cells(n, by, row):
    if row is None:
        return [lines.count(n), by, *["—"] * 6, "no result", "—"]
    return [lines.count(n), by, judged.bracket(row["out"]), *lines.distances(row), row["verdict"],
            f"{row['user_seconds']:.1f} s" + (f", stopped at {lines.count(row['vertices'])}" if row["vertices"] > n else "")]


def section(context, document):
    if context.collecting:
        return
    document.heading("The author's bounding meshes on the same files")
    program = context.others.get("boundingmesh")
    if program is None:
        document.paragraph(f"Left out: --bounding-mesh PROGRAM takes the program `boundingmesh`, {WHERE}.")
        return
    document.paragraph(
        "boundingmesh --direction Outward, with the metric that is the thesis's cost, and the same cost of ours (--effort fast) and our own (--effort "
        "normal). MinConstant is of the distances to triangles' centres, with the constant adapted, so `triangles` stands beside it. All from the same **closed** file: the prepared mesh with its holes closed. Distances of the surfaces in percent of the diagonal, maxima "
        "certified; how far the original's solid sticks out of the result (bracket), and whether the result encloses it, by bound-verify. "
        "CPU time of the whole process, one thread.")
    call = Calls(context, "bounding-mesh")
    models = [m for m in context.models if m.thesis and m.vertices() < 100000 or m.name == "kr120"]
    counts = COUNTS[len(COUNTS) // 2:][:1] if context.quick else COUNTS
    for model in models:
        original = _closed(call, model)
        rows = []
        for n in context.counts(model, counts) if original else ():
            for metric, cost in METRICS.items():
                rows.append(_cells(n, f"boundingmesh, {metric}", _theirs(call, program, original, model.name, n, metric, True)))
                rows.append(_cells(n, cost, _ours(call, original, model.name, n, cost, True)))
            rows.append(_cells(n, OURS, _ours(call, original, model.name, n, OURS, True)))
        document.heading(f"{model.title}, closed", 3)
        document.table(HEADER, rows)
    _open_section(context, document, call, program, models)


def _open_section(context, document, call, program, models):
    """His spikes at the border of open meshes, told apart."""
    rows = []
    n = COUNTS[len(COUNTS) // 2]
    for model in models:
        original = _as_published(call, model)
        if original is None or n not in context.counts(model, COUNTS):
            continue
        if any(row["closed"] for run, row in context.runner.results.items() if run.model == model):
            continue
        for metric, cost in METRICS.items():
            for by, row in ((f"boundingmesh, {metric}", _theirs(call, program, original, f"{model.name}-open", n, metric, False)),
                            (cost, _ours(call, original, f"{model.name}-open", n, cost, False))):
                if row:
                    rest = row["no_border"]
                    rows.append([model.title, by, figure(row["a2o_max"]), "—" if rest is None else figure(rest)])
    document.heading("Open files, as published", 3)
    document.paragraph(f"To {n:,} vertices. An open mesh bounds no solid; what his program makes of one has spikes where the border was. Farthest "
                       "point of the result from the original, and the same without the triangles that touch the result's border.")
    document.table(["model", "by", "max a→o", "without border"], rows)


SETS = ((20000, 1), (100000, 0.3))  # voxels, alpha
QUICK_SETS = SETS[:1]


def sets_section(context, document):
    if context.collecting:
        return
    document.heading("The author's bounding convex decomposition on the same files")
    program = context.others.get("bounding-convex-decomposition")
    if program is None:
        document.paragraph(f"Left out: --bounding-convex-decomposition PROGRAM takes the program of that name, {WHERE}.")
        return
    document.paragraph(
        "bounding-convex-decomposition with its default error (2 % of the diagonal) and several numbers of voxels and values of alpha; ours with as many "
        "bodies and vertices in all (--max-bodies, --max-total-vertices), from the same closed file. How far the original sticks out of the union and how "
        "far the union reaches beyond it, in percent of the diagonal, certified for every point (—: not measured within the time). His last step simplifies each hull to a bounding mesh, "
        "which need not be convex: then the bodies are taken as they are, as one mesh. Times are CPU seconds.")
    call = Calls(context, "bounding-sets")
    models = [m for m in context.models if m.name in ("mitsubishi", "kr120", "bunny", "bracket")]
    for model in models:
        original = _closed(call, model)
        rows = []
        for voxels, alpha in (QUICK_SETS if context.quick else SETS) if original else ():
            name = f"{model.name}-{voxels}-{alpha}"
            found = call(f"{name}-theirs", program, ["--voxels", voxels, "--alpha", alpha, original, f"{name}.wrl"], [original], [f"{name}.wrl"])
            if found is None:
                rows.append([f"{voxels}, {alpha}", "the author's", *["—"] * 4, "no result", "—"])
                continue
            bodies = meshes.read_vrml_sets(call.folder / f"{name}.wrl")
            meshes.write_objects(call.folder / f"{name}-theirs.obj", bodies)
            vertices = sum(len(points) for points, _ in bodies)
            rows.append(_set_cells(call, f"{voxels}, {alpha}", "the author's", f"{name}-theirs", original, len(bodies), vertices))
            if call(f"{name}-ours", call.programs / "bcd-decompose",
                    [original, "-o", f"{name}-ours.obj", "--effort", "fast" if context.quick else "normal", "--max-bodies", len(bodies), "--max-total-vertices",
                     vertices, "--report", f"{name}-ours-set.json"], [original], [f"{name}-ours.obj", f"{name}-ours-set.json"], (0, 1)) is not None:
                report = call.report(f"{name}-ours-set.json")
                rows.append(_set_cells(call, f"{voxels}, {alpha}", "ours", f"{name}-ours", original, report["bodies"], report["vertices"]))
        document.heading(model.title, 3)
        document.table(["voxels, alpha", "by", "original sticks out", "union → solid", "bodies", "vertices", "verdict", "CPU time"], rows)


def _set_cells(call, setting, by, name, original, bodies, vertices):
    said, out, beyond = judged.cells(judged.solids(call, name, original, f"{name}.obj", True))
    return [setting, by, out, beyond, str(bodies), f"{vertices:,}", said, f"{call.seconds(name):.1f} s"]
