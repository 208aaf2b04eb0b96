"""Lines of the tables of distances."""

import thesis
from document import figure, written

TABLE_COUNTS = (20000, 10000, 5000, 2500)
DIRECTIONS = ("outer", "inner")
NOTHING = "—"


def count(n):
    return f"{n:,}"


def distances(of):
    """The cells that all distance tables share; `of` maps names to percent."""
    return [figure(of[key]) for key in (*thesis.DISTANCES, "hausdorff")]


HEADER = ["mean o→a", "max o→a", "mean a→o", "max a→o", "Hausdorff"]


def result_line(row, target, title):
    """A line of a table for one of our results."""
    if row is None:
        return [count(target), title, *[NOTHING] * 5, "no result"]
    remark = f"{row['user_seconds']:.1f} s"
    if row["vertices"] > target:
        remark += f", stopped at {count(row['vertices'])}"
    return [count(target), title, *distances(row), remark]


def table_row(keys, by, percent, mm=None):
    """A row of the CSV of a distance table; `mm` are millimetres that the thesis prints."""
    return [*keys, by, *(mm[key] if mm else "" for key in thesis.DISTANCES),
            *(percent[key] for key in (*thesis.DISTANCES, "hausdorff"))]


def write_table(path, keys, rows):
    written(path, [*keys, "by", *(f"{key}_mm" for key in thesis.DISTANCES),
                   *(f"{key}_percent" for key in (*thesis.DISTANCES, "hausdorff"))], rows)


def robots(context, document):
    """The models that stand for the robots of the thesis's tables; says which are not there."""
    here = [model for model in context.models if model.thesis in thesis.diagonals()]
    missing = set(thesis.diagonals()) - {model.thesis for model in here}
    if missing:
        document.paragraph(f"Left out here, for no model stands for them in this run: {', '.join(sorted(missing))}.")
    return here
