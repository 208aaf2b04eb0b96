"""The figures that the thesis prints ([gaschler2016]: Tables 4.2, 4.3 and B.1), in millimetres."""

import csv
import dataclasses
import math
import pathlib

FOLDER = pathlib.Path(__file__).parent / "thesis"
DISTANCES = ("o2a_mean", "o2a_max", "a2o_mean", "a2o_max")
COSTS = {"planes": "planes", "planes_adapted": "planes-adapted", "triangles": "triangles"}


class Row:
    """One line of a table; distances in percent of the diagonal, and as printed in mm."""

    def __init__(self, fields, diagonal, cost, direction):
        self.model = fields["model"]
        self.direction = direction
        self.cost = cost
        self.vertices = int(fields["vertices"])
        self.mm = {key: float(fields[key]) for key in DISTANCES}
        self.percent = {key: 100 * value / diagonal for key, value in self.mm.items()}
        self.percent["hausdorff"] = max(self.percent["o2a_max"], self.percent["a2o_max"])
        self.percent["mean"] = max(self.percent["o2a_mean"], self.percent["a2o_mean"])


def _read(name):
    with open(FOLDER / name, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def diagonals():
    """Model -> diagonal of its bounding box in mm."""
    return {row["model"]: float(row["bbox_diagonal_mm"]) for row in _read("table-4-2.csv")}


def original_vertices():
    return {row["model"]: int(row["original_vertices"]) for row in _read("table-4-2.csv")}


def table_4_2():
    return [Row(row, float(row["bbox_diagonal_mm"]), "planes-adapted", row["direction"])
            for row in _read("table-4-2.csv")]


def table_b_1():
    diagonal = diagonals()
    return [Row(row, diagonal[row["model"]], COSTS[row["cost_function"]], "outer")
            for row in _read("table-b-1.csv")]


@dataclasses.dataclass(frozen=True)
class Set:
    """One line of Table 4.3; distances in percent of the diagonal."""
    stage: str  # hulls, segmentation, bounding
    bodies: int
    vertices: int
    in_a_body: tuple  # fewest, mean, most vertices
    percent: dict


def table_4_3():
    diagonal = diagonals()["MITSUBISHI"]
    stages = {"convex_hulls_of_rigid_bodies": "hulls"}
    return [Set(stages.get(row["stage"], row["stage"]), int(row["convexes"]), int(row["vertices"]),
                (int(row["vertices_per_convex_min"]), float(row["vertices_per_convex_mean"]), int(row["vertices_per_convex_max"])),
                {key: 100 * float(row[key]) / diagonal for key in DISTANCES})
            for row in _read("table-4-3.csv") if row["stage"] != "original"]


def vertices_within(rows, percent):
    """Vertices at which the Hausdorff distance falls to `percent` of the diagonal: straight lines
    between the rows on log axes. None where the rows do not reach it; the fewest vertices of the
    table where all of them are nearer."""
    points = sorted((row.vertices, row.percent["hausdorff"]) for row in rows)
    if points[0][1] <= percent:
        return points[0][0]
    for (n, far), (more, near) in zip(points, points[1:]):
        if near <= percent < far:
            share = math.log(far / percent) / math.log(far / near)
            return round(n * (more / n) ** share)
    return None


def planning(name):
    """The lines of a table about planning, as they are."""
    return _read(name)


def by_search(name, **where):
    """Of Tables 6.2 and 6.7: (quantity, search) -> "mean ± standard deviation" as printed."""
    return {(row["quantity"], search): f"{row[search]} ± {row[search + '_sd']}" for row in _read(name)
            if all(row[key] == value for key, value in where.items())
            for search in ("depth_first", "breadth_first", "iterative_deepening")}


def exact_ratios():
    """(library, search, time of collision checks of exact meshes / of bounding sets) where Table 6.7 has both."""
    time = {(row["geometry"], row["library"], search): float(row[search]) for row in _read("table-6-7.csv")
            if row["quantity"] == "collision_checking_s" for search in ("depth_first", "breadth_first", "iterative_deepening")}
    return [(library, search, seconds / time["bounded_0.02m", library, search])
            for (geometry, library, search), seconds in time.items()
            if geometry == "exact" and ("bounded_0.02m", library, search) in time]
