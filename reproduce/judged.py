"""What is measured of anybody's mesh or set in the same way: surface distances, how far the original sticks out, and what bound-verify decides."""

import collections

import meshes
from document import figure

GAP, SECONDS = 0.1, 30  # of distances between solids: relative, CPU time
STOPPED = (-24, -9)  # by that limit


def percent_of(report, key, side):
    return 100 * report[side][key] / report["bbox_diagonal"]


def surfaces(call, name, original, here, more=()):
    """Distances in percent between the surfaces of two files; None where measuring failed."""
    result = f"{name}-distance-report.json"
    if call(f"{name}-distance", call.programs / "hausdorff-eval", [original, here, "--threads", "1", "--quiet", *more, "--report", result],
            [original, call.folder / here], [result], (0, 7)) is None:
        return None
    report = call.report(result)
    row = {"o2a_mean": percent_of(report, "mean", "a_to_b"), "o2a_max": percent_of(report, "max_upper", "a_to_b"),
           "a2o_mean": percent_of(report, "mean", "b_to_a"), "a2o_max": percent_of(report, "max_upper", "b_to_a")}
    row["hausdorff"] = max(row["o2a_max"], row["a2o_max"])
    row["mean"] = max(row["o2a_mean"], row["a2o_mean"])
    return row


BAD_INPUT = 3  # bodies that are not convex, exactly (they are taken as one mesh then), or a mesh that is not closed


def is_closed(path):
    """Whether each edge of a mesh is run through as often one way as the other. Of formats that are not read here: yes."""
    if path.suffix not in (".off", ".obj"):
        return True
    edges = collections.Counter()
    for t in (meshes.read_off if path.suffix == ".off" else meshes.read_obj)(path)[1]:
        for a, b in zip(t, t[1:] + t[:1]):
            edges[min(a, b), max(a, b)] += 1 if a < b else -1
    return not any(edges.values())


def verdict(call, name, original, here, is_set):
    """What bound-verify says of whether the original's solid is inside, and the bracket of how far it sticks out [percent], None where
    nothing is decided, and where a mesh is not closed: simplifiers of surfaces may leave gaps, and gaps bound no solid. Faces of the original that enclose nothing may stick out of what encloses the solid."""
    result = f"{name}-verdict-report.json"
    command = ["cover", original, here] if is_set else ["mesh", "--outer", original, here]
    code = call(f"{name}-verdict", call.programs / "bound-verify", [*command, "--quiet", "--report", result], [original, call.folder / here], [result],
                (0, 1, 7) if is_set or is_closed(call.folder / here) else (0, 1, 7, BAD_INPUT))
    if code is None:
        return "not decided", None
    if code == BAD_INPUT:
        return "not a closed mesh", None
    report = call.report(result)
    solid, surface = report["claims"]["solid"], report["claims"].get("surface", {})
    if solid["answer"] == "verified":
        return "encloses" if surface.get("answer", "verified") == "verified" else "encloses the solid, not all faces", (0, 0)
    if solid["answer"] == "refuted":
        depth = solid.get("depth") or surface.get("depth")
        return "sticks out", depth and tuple(100 * depth[key] / report["bbox_diagonal"] for key in ("lower", "upper"))
    return "undecided", None


def solids(call, name, original, here, is_set):
    """(verdict, bracket of how far the original sticks out, how far what stands for it reaches beyond it) in percent. The last is certified of every
    point of a set, as solids; of a mesh it is that of its surface. None where measuring failed or took too long."""
    said, out = verdict(call, name, original, here, is_set)
    if not is_set:
        found = surfaces(call, name, original, here)
        return said, out, None if found is None else found["a2o_max"]
    for kind in ("set", "mesh"):
        step = f"{name}-solid-as-{kind}"
        result = f"{step}-report.json"
        code = call(step, call.programs / "hausdorff-eval",
                    [original, here, "--solid", "--gap", GAP, "--samples", 1000, "--threads", "1", "--quiet", "--b-as", kind, "--report", result],
                    [original, call.folder / here], [result], (0, 7, *STOPPED, BAD_INPUT), limit=SECONDS)
        if code != BAD_INPUT:
            break
    return said, out, percent_of(call.report(result), "max_upper", "b_to_a") if code in (0, 7) else None


def cells(found):
    """Verdict, how far out, how far beyond, as texts."""
    said, out, beyond = found
    return [said, bracket(out), "—" if beyond is None else figure(beyond)]


def bracket(out):
    if out is None:
        return "—"
    return figure(out[1]) if out[0] == out[1] else f"{figure(out[0])}–{figure(out[1])}"
