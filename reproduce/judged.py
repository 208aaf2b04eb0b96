"""What is measured of anybody's mesh or set in the same way: surface distances, how far the original sticks out, and what bound-verify decides."""

from document import figure

GAP, SECONDS = 0.1, 120  # of distances between solids: relative, CPU time
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


BAD_INPUT = 3  # bodies that are not convex, exactly: hulls of others, rounded. They are taken as one mesh then


def verdict(call, name, original, here, is_set):
    """Whether the original is inside, by bound-verify."""
    commands = [["cover", original, here]] * is_set + [["mesh", "--outer", original, here]]
    for number, command in enumerate(commands):
        step = f"{name}-verdict" + "-as-mesh" * number
        result = f"{step}-report.json"
        code = call(step, call.programs / "bound-verify", [*command, "--quiet", "--report", result],
                    [original, call.folder / here], [result], (0, 1, 7, *[BAD_INPUT] * (number + 1 < len(commands))))
        if code in (0, 1, 7):
            return {"verified": "encloses", "refuted": "sticks out"}.get(call.report(result)["verdict"], "undecided")
    return "not decided"


def solids(call, name, original, here, is_set):
    """(verdict, how far the original sticks out of what bounds it, how far that reaches beyond the original) in percent, both certified upper
    bounds of the farthest point of the solids; None where measuring failed or took too long. Where bound-verify has decided that the original is
    inside, it sticks out by 0, and a mesh reaches beyond it by no more than its surface does: measuring what is nearly 0 takes long."""
    said = verdict(call, name, original, here, is_set)
    if said == "encloses" and not is_set:
        found = surfaces(call, name, original, here)
        return said, 0, None if found is None else found["a2o_max"]
    for number, kind in enumerate([["--b-as", "set"]] * is_set + [["--b-as", "mesh"]]):
        step = f"{name}-solid" + "-as-mesh" * number
        result = f"{step}-report.json"
        code = call(step, call.programs / "hausdorff-eval",
                    [original, here, "--solid", "--gap", GAP, "--samples", 1000, "--threads", "1", "--quiet", *kind, "--report", result],
                    [original, call.folder / here], [result], (0, 7, *STOPPED, *[BAD_INPUT] * (kind[1] == "set")), limit=SECONDS)
        if code != BAD_INPUT:
            break
    if code not in (0, 7):
        return said, 0 if said == "encloses" else None, None
    report = call.report(result)
    return said, 0 if said == "encloses" else percent_of(report, "max_upper", "a_to_b"), percent_of(report, "max_upper", "b_to_a")


def cells(found):
    """Verdict, how far out, how far beyond, as texts."""
    said, out, beyond = found
    return [said, *("—" if x is None else figure(x) for x in (out, beyond))]
