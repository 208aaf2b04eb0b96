"""Command line of scripts/reproduce-thesis."""

import argparse
import os
import pathlib
import sys

import keep
import models
import peers
import report
from runs import Runner

ROOT = pathlib.Path(__file__).resolve().parent.parent


def arguments(argv):
    parser = argparse.ArgumentParser(
        prog="reproduce-thesis",
        description="Runs the thesis's evaluation of bounding meshes on public models (in $KABOUM_MESHES; without it "
        "on the project's own) and writes the thesis's figures beside ours: index.html, report.md, CSV and SVG. "
        "What has been run already is not run again, also what gave no result (but with --retry).",
        epilog="Exit codes: 0 done, with --compare: the same; 1 some runs gave no result (the report lists them), with --compare: "
        "something differs; 2 usage; 3 a model or a program is missing.")
    parser.add_argument("--quick", action="store_true", help="few models, costs and vertex counts")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR", default=ROOT / "reproduction",
                        help="where results go [reproduction/ in the checkout]")
    parser.add_argument("--jobs", type=int, default=min(2, os.cpu_count() or 1), metavar="N",
                        help="decimations at a time, one thread each [2; 1 on one core]")
    parser.add_argument("--models", metavar="NAME,...", help="only these models")
    parser.add_argument("--limit", type=int, default=900, metavar="SECONDS", help="CPU time of a program [900]")
    parser.add_argument("--retry", action="store_true", help="run again what gave no result before")
    parser.add_argument("--programs", type=pathlib.Path, metavar="DIR", default=ROOT / "build/release/bin",
                        help="folder of the built programs [build/release/bin]")
    parser.add_argument("--sections", metavar="NAME,...", help="only these: " + ", ".join(report.SECTIONS))
    parser.add_argument("--bounding-mesh", type=pathlib.Path, metavar="PROGRAM",
                        help="the author's `boundingmesh`, to be run on the same files")
    parser.add_argument("--bounding-convex-decomposition", type=pathlib.Path, metavar="PROGRAM", help="the same of the author's other program")
    parser.add_argument("--peers", action="store_true", help="install the packages of reproduce/requirements.txt into an environment of their "
                        "own in --out, and run them on the same files; what cannot be installed is left out, and said")
    parser.add_argument("--keep", action="store_true", help="put the results of what is run into docs/, with date, machine and commit, and mark "
                        "what became worse")
    parser.add_argument("--compare", type=pathlib.Path, metavar="DIR", help="run nothing; say which figures of --out differ from those of DIR, a "
                        "folder that another call wrote, or results.json; times and memory apart. With --sections, of these")
    options = parser.parse_args(argv)
    if options.jobs < 1 or options.limit < 1:
        parser.error("--jobs and --limit must be at least 1")
    return parser, options


def compared(options):
    """The exit code of --compare."""
    for folder in (options.out, options.compare):
        if not (folder.is_file() or (folder / "results.json").is_file()):
            print(f"reproduce-thesis: {folder} has no results.json; run scripts/reproduce-thesis --out {folder}", file=sys.stderr)
            return 3
    first, second = keep.read(options.compare), keep.read(options.out)
    lines = keep.same_figures(first, second, options.sections and options.sections.split(","))
    for line in lines:
        print(line)
    figures = sum(len(s["tables"]) for kind in second.values() for s in kind.values())
    print(f"{figures} tables, times apart: " + (f"{len(lines)} differences" if lines else "the same figures"))
    return 1 if lines else 0


def main(argv):
    parser, options = arguments(argv)
    if options.compare:
        return compared(options)
    folder = os.environ.get("KABOUM_MESHES")
    known = models.corpus(folder) if folder else models.own(ROOT)
    if not folder:
        print("reproduce-thesis: KABOUM_MESHES is not set: the project's own meshes only", file=sys.stderr)
    chosen = [m for m in known if m.quick] if options.quick else known
    if options.models:
        names = options.models.split(",")
        unknown = set(names) - {m.name for m in known}
        if unknown:
            parser.error(f"unknown model {sorted(unknown)[0]}; there are {', '.join(m.name for m in known)}")
        chosen = [m for m in known if m.name in names]
    sections = options.sections.split(",") if options.sections else None
    if unknown := set(sections or ()) - set(report.SECTIONS):
        parser.error(f"unknown section {sorted(unknown)[0]}; there are {', '.join(report.SECTIONS)}")
    for model in chosen:
        if not model.path.is_file():
            print(f"reproduce-thesis: {model.path} is missing; correct KABOUM_MESHES, or leave the model out "
                  "with --models", file=sys.stderr)
            return 3
    for name in ("bmesh-decimate", "hausdorff-eval", "mesh-picture"):
        if not (options.programs / name).is_file():
            print(f"reproduce-thesis: {options.programs / name} is missing; scripts/build makes it", file=sys.stderr)
            return 3
    others = {"boundingmesh": options.bounding_mesh, "bounding-convex-decomposition": options.bounding_convex_decomposition}
    for program in filter(None, others.values()):
        if not os.access(program, os.X_OK):
            print(f"reproduce-thesis: {program} is no program; build it from https://github.com/gaschler/bounding-mesh", file=sys.stderr)
            return 3
    options.out.mkdir(parents=True, exist_ok=True)
    out = options.out.resolve()
    others = {name: program.resolve() for name, program in others.items() if program}
    if options.peers:
        others["python"] = peers.environment(out)
    runner = Runner(options.programs.resolve(), out / "runs", options.jobs, options.limit, options.retry)
    results = report.make(chosen, runner, out, options.quick, sections, others)
    if options.keep:
        keep.keep(results, report.SECTIONS)
    print(f"{out / 'index.html'}: {runner.executed + runner.called[0]} runs done, "
          f"{runner.kept + runner.called[1]} kept"
          + (f", {len(runner.failures)} without a result" if runner.failures else ""))
    return 1 if runner.failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
