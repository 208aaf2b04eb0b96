"""What is measured of anybody's mesh or set in the same way: surface distances, how far the original sticks out, and what bound-verify decides."""

from document import figure

GAP, SECONDS = "10%", 300  # of distances between solids


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


def verdict(call, name, original, here, is_set):
    """Whether the original is inside, by bound-verify."""
    result = f"{name}-verdict-report.json"
    command = ["cover", original, here] if is_set else ["mesh", "--outer", original, here]
    if call(f"{name}-verdict", call.programs / "bound-verify", [*command, "--quiet", "--report", result], [original, call.folder / here], [result],
            (0, 1, 7)) is None:
        return "not decided"
    return {"verified": "encloses", "refuted": "sticks out"}.get(call.report(result)["verdict"], "undecided")


def solids(call, name, original, here, is_set):
    """(verdict, how far the original sticks out of what bounds it, how far that reaches beyond the original) in percent, both certified
    upper bounds of the farthest point, 0 where bound-verify has decided so; None where measuring failed. Between solids a distance
    within a tenth of itself does: looking for where two surfaces are nearly the same takes long."""
    said = verdict(call, name, original, here, is_set)
    result = f"{name}-solid-report.json"
    kind = ["--b-as", "set"] if is_set else []
    if call(f"{name}-solid", call.programs / "hausdorff-eval",
            [original, here, "--solid", "--gap", GAP, "--samples", 1000, "--threads", "1", "--quiet", *kind, "--report", result],
            [original, call.folder / here], [result], (0, 7), limit=SECONDS) is None:
        return said, None, None
    report = call.report(result)
    return said, 0 if said == "encloses" else percent_of(report, "max_upper", "a_to_b"), percent_of(report, "max_upper", "b_to_a")


def cells(found):
    """Verdict, how far out, how far beyond, as texts."""
    said, out, beyond = found
    return [said, *("—" if x is None else figure(x) for x in (out, beyond))]
