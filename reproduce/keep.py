"""Results that are kept: the tables of a report as JSON, two of them compared, and the page of docs/ that is made of them.

A section that was run whole and one that was run quickly stand beside each other: results["whole"][NAME], results["quick"][NAME], each with
when, where and of what it was made. What is a time or a peak of memory differs from run to run and is never compared.
"""

import datetime
import json
import math
import os
import pathlib
import re
import subprocess

from document import Document

ROOT = pathlib.Path(__file__).resolve().parent.parent
KEPT, PAGE = ROOT / "docs/reproduction-results.json", ROOT / "docs/reproduction-results.md"
WORSE = 0.02  # a figure that changes by more of itself is named
SPENT = re.compile(r"\btimes?\b|÷ sets|\[µ?m?s\]|µs|\bms\b|CPU|MB|faster|per second|/s\b|seconds|wall", re.I)
MORE_IS_BETTER = re.compile(r"factor|fewer|within limits|inside|nearer|found|free|diagonal here|its diagonal", re.I)
NAMING = ("n", "by", "share", "the thesis's vertices")  # columns whose cells say what a row is of
VERDICTS = ("verdict", "Proposition 1", "inside?", "collides?", "")  # columns whose cells are results, though texts
GOOD = ("verified", "holds", "encloses", "covers", "yes")
NUMBER = re.compile(r"^[<≤]?\s*(-?\d[\d,]*(?:\.\d+)?)(?:\s*(?:×|%|s\b|mm|$)|\s*[±,(–])")


def machine():
    """CPU model and cores."""
    model = "unknown"
    try:
        for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                model = line.split(":", 1)[1].strip()
                break
    except OSError:
        pass
    return {"cpu": model, "cores": os.cpu_count()}


def commit():
    """That of the checkout, "+" after it where files differ from it; "" outside one."""
    def git(*arguments):
        done = subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True, check=False)
        return done.stdout.strip() if done.returncode == 0 else ""
    try:
        found = git("rev-parse", "--short=12", "HEAD")
        return found + "+" * bool(found and git("status", "--porcelain", "--untracked-files=no"))
    except OSError:
        return ""


def version(programs):
    done = subprocess.run([pathlib.Path(programs) / "bmesh-decimate", "--version"], capture_output=True, text=True, check=False)
    return (done.stdout.strip().splitlines() or ["unknown"])[0]


def made(document, programs, seconds, models):
    """What is kept of a section that was written just now. @param seconds  user CPU and wall time of its programs"""
    return {"date": datetime.date.today().isoformat(), "commit": commit(), "version": version(programs), "machine": machine(),
            "models": models, "seconds": {"cpu": round(seconds[0]), "wall": round(seconds[1])},
            "text": document.markdown(), "tables": document.tables()}


def read(path):
    """Of a file, or of results.json in a folder; nothing where there is none."""
    path = pathlib.Path(path)
    if path.is_dir():
        path /= "results.json"
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return {"whole": {}, "quick": {}}


def write(path, results):
    part = path.with_suffix(".part")
    part.write_text(json.dumps(results, indent=1, ensure_ascii=False, sort_keys=True) + "\n", encoding="utf-8")
    os.replace(part, path)


def merged(old, new):
    """The sections of `new`, and those of `old` that it has not."""
    return {kind: {**old.get(kind, {}), **new.get(kind, {})} for kind in ("whole", "quick")}


def number(cell):
    """The figure that a cell begins with; None where it begins with none."""
    found = NUMBER.match(cell)
    return float(found[1].replace(",", "")) if found else None


def _is_text(cell):
    return number(cell) is None and cell not in ("", "—")


def _cells(section):
    """(where, column) -> cell, but for what a run spends. A row is known by its first cell and its texts, and by how many rows like it
    stand above it."""
    out = {}
    for table in section["tables"]:
        under, seen = " / ".join(table["under"][-2:]), {}
        for row in table["rows"]:
            name = " · ".join([row[0], *(cell for column, cell in zip(table["header"][1:], row[1:]) if column in NAMING or
                                         _is_text(cell) and column not in VERDICTS and not SPENT.search(cell) and len(cell) < 40)])
            seen[name] = seen.get(name, 0) + 1
            where = under + " / " + name + (f" ({seen[name]})" if seen[name] > 1 else "")
            if SPENT.search(row[0]):
                continue
            for column, cell in zip(table["header"], row):
                if not SPENT.search(column):
                    out.setdefault((where, column), cell)
    return out


def changes(before, after):
    """(section, where, column, before, after, verdict) of all that differs between two results of one kind (section -> what is kept),
    of sections that both have. The verdict is worse, better, changed or gone. Of a section that was run for other models the figures
    that both have are compared."""
    out = []
    for name in sorted(set(before) & set(after)):
        old, new = _cells(before[name]), _cells(after[name])
        if before[name].get("models") != after[name].get("models"):
            old, new = ({key: cells[key] for key in cells if key in old and key in new} for cells in (old, new))
        for key in [*old, *(k for k in new if k not in old)]:
            was, now = old.get(key, ""), new.get(key, "")
            if was != now:
                out.append((name, *key, was or "none", now or "none", _verdict(key, was, now)))
    return out


def _verdict(key, was, now):
    if not now:
        return "gone"
    a, b = number(was), number(now)
    if a is None or b is None:
        good = [text.startswith(GOOD) for text in (was, now)]
        if key[1] in VERDICTS and good[0] != good[1]:
            return "worse" if good[0] else "better"
        return "changed"
    if math.isclose(a, b, rel_tol=WORSE, abs_tol=1e-12):
        return "changed"
    more = b > a
    return "better" if more == bool(MORE_IS_BETTER.search(key[1]) or MORE_IS_BETTER.search(key[0].rsplit(" / ", 1)[-1])) else "worse"


def same_figures(first, second, wanted=None):
    """Lines on all that differs between two results, whatever they are of; none where all figures are the same but for times.
    Whole sections are compared with whole ones, quick with quick; where one has none of a kind, that kind is not compared.
    @param wanted  sections; None: all"""
    lines = []
    kinds = [kind for kind in ("whole", "quick") if first.get(kind) and second.get(kind)]
    if not kinds:
        return ["one is whole, the other quick: nothing can be compared"]
    for kind in kinds:
        a, b = ({name: kept for name, kept in results.get(kind, {}).items() if wanted is None or name in wanted} for results in (first, second))
        lines += [f"{kind}: {name} is in one of them only" for name in sorted(set(a) ^ set(b))]
        lines += [f"{kind}: {name}: {where}: {column}: {was} | {now}" for name, where, column, was, now, _ in changes(a, b)]
    return lines


def told(document, before, after):
    """A section on what differs from the results kept."""
    document.heading("Beside the results kept before")
    found = [(kind, *change) for kind in ("whole", "quick") for change in changes(before.get(kind, {}), after.get(kind, {}))]
    compared = sum(len(set(before.get(kind, {})) & set(after.get(kind, {}))) for kind in ("whole", "quick"))
    regressions = [f for f in found if f[-1] in ("worse", "gone")]
    document.paragraph(
        f"Sections that both have, whole and quick ones counted apart: {compared}. Figures that differ, times and memory apart: {len(found)}; **regressions: {len(regressions)}** "
        f"(worse by more than {100 * WORSE:g} %, or no longer there; larger is worse, but for factors and what is counted as found). "
        "Figures of other models, programs or rows have nothing to be compared with.")
    document.table(["section", "figure", "column", "before", "now", ""],
                   [[section, where, column, was, now, verdict] for _, section, where, column, was, now, verdict in
                    sorted(found, key=lambda f: (f[-1] not in ("worse", "gone"), f[-1] != "better"))[:200]])


def page(results, before, order):
    """The page of docs/: all sections that are kept, whole where they were run whole, in an order of names."""
    document = Document("Results kept")
    document.paragraph(
        "Made by `make reproduce` (`scripts/reproduce-thesis --keep`); not to be edited. Questions, set-up and what the tables show: "
        "[reproduction](reproduction.md). The same figures for programs: [JSON](reproduction-results.json). Pictures are left out. A section was run "
        "*whole*, or *quick*, with fewer models and seeds; each says when, of which commit (+: with changes not committed) and on what machine. "
        "Times are of machines that others use as well.")
    chosen = {name: ("whole", kept) for name, kept in results["whole"].items()}
    for name, kept in results["quick"].items():
        chosen.setdefault(name, ("quick", kept))
    chosen = {name: chosen[name] for name in order if name in chosen}
    rows = [[name, kind, kept["date"], kept["version"].split()[-1], kept["commit"] or "—", f"{kept['machine']['cpu']}, {kept['machine']['cores']} cores",
             kept.get("models", ""), *(f"{kept['seconds'][key]:,}" if kept["seconds"][key] else "—" for key in ("cpu", "wall"))] for name, (kind, kept) in chosen.items()]
    document.heading("What was run when")
    document.paragraph("User CPU and wall seconds of a section's programs when they were run; decimations of `bmesh-decimate` with their measuring are shared by sections, and not "
                       "among them.")
    document.table(["section", "run", "date", "version", "commit", "machine", "models", "CPU [s]", "wall [s]"], rows)
    told(document, before, results)
    return "\n".join([document.markdown(), *(f"<!-- {name}, {kind} -->\n\n" + kept["text"] for name, (kind, kept) in chosen.items())])


def keep(new, order):
    """Puts results into docs/. @param order  of sections on the page"""
    before = read(KEPT)
    after = merged(before, new)
    after = {kind: {name: after[kind][name] for name in order if name in after[kind]} for kind in after}
    PAGE.write_text(page(after, before, order), encoding="utf-8")
    write(KEPT, after)
