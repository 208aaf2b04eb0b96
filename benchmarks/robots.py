#!/usr/bin/env python3
"""A table of robots: what each becomes, what that takes, what decides and what loads it.

    benchmarks/robots.py FOLDER... [--build build/release] [--epsilon 1cm] [--visual] [--read]
                         [--match PATTERN] [--limit SECONDS] [-o TABLE.md] [--json FILE]

Every URDF, xacro, MJCF and SDF below the folders is a robot, but scenes (scene*.xml). With --read
they are only read, and the reasons for which some are refused are counted. Else each is decomposed,
its printed check is run, and the result is loaded by the engines that are installed: MuJoCo (MJCF
and URDF) and Pinocchio (URDF), from the environment of `scripts/setup --engines`.
"""

import argparse
import collections
import fnmatch
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile

LOADERS = {  # by engine: formats, and what loads a file
    "mujoco": ({".xml", ".urdf"}, "import mujoco, sys; mujoco.MjModel.from_xml_path(sys.argv[1])"),
    "pinocchio": ({".urdf"}, "import pinocchio, sys, os; pinocchio.buildGeomFromUrdf("
                             "pinocchio.buildModelFromUrdf(sys.argv[1]), sys.argv[1], "
                             "pinocchio.GeometryType.COLLISION, [os.path.dirname(sys.argv[1])])"),
}


def robots_below(folder):
    """Files of robots, in order."""
    for path in sorted(pathlib.Path(folder).rglob("*")):
        name = path.name.lower()
        if not path.is_file():
            continue
        if name.endswith((".urdf", ".sdf")):
            yield path
        elif name.endswith(".urdf.xacro"):
            yield path
        elif name.endswith(".xml") and not name.startswith("scene"):
            text = path.read_text(errors="replace")
            if "<mujoco" in text and "<worldbody" in text:
                yield path


def cpu_of_children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(command, limit, **more):
    """Exit code (None: stopped), standard error, CPU seconds."""
    before = cpu_of_children()
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit,
                              errors="replace", **more)
        code, said = done.returncode, done.stderr + done.stdout
    except subprocess.TimeoutExpired as stopped:
        code, said = None, (stopped.stderr or b"").decode(errors="replace")
    return code, said, cpu_of_children() - before


def engines():
    """Those that are installed in the environment that runs this."""
    return [name for name in LOADERS
            if subprocess.run([sys.executable, "-c", f"import {name}"], capture_output=True,
                              check=False).returncode == 0]


def reason_of(message, path):
    """A message without what is special of one robot."""
    text = message.replace(str(path), "").strip().splitlines()
    text = text[-1] if text else "no message"
    text = re.sub(r"^[^:]*: error: |^[a-z-]+: ", "", text)
    text = re.sub(r"'[^']*'|\"[^\"]*\"", "'…'", text)
    text = re.sub(r"\S*/\S*", "…", text)
    return re.sub(r"\d+", "N", text)[:150]


def read_all(paths, build):
    """Counts what is refused, and why."""
    sys.path.insert(0, str(build / "python"))
    import kaboum  # pylint: disable=import-outside-toplevel

    why, examples = collections.Counter(), {}
    for path in paths:
        try:
            kaboum.read_robot(str(path))
        except kaboum.Error as error:
            reason = reason_of(str(error), path)
            why[reason] += 1
            examples.setdefault(reason, (path, str(error)))
    print(f"{len(paths)} robots, {sum(why.values())} refused")
    for reason, count in why.most_common():
        print(f"{count:5}  {reason}\n         {examples[reason][1][:300]}")


def measure(path, args, installed):
    """The row of one robot."""
    row = {"robot": f"{path.parent.name}/{path.name}", "format": path.suffix[1:]}
    place = pathlib.Path(tempfile.mkdtemp(prefix="robots."))
    try:
        command = [str(args.build / "tools/bcd-decompose/bcd-decompose"), str(path), "-o",
                   str(place / "out"), "--epsilon", args.epsilon, "--report",
                   str(place / "report.json")]
        for folder in args.package_path:
            command += ["--package-path", folder]
        if args.visual:
            command.append("--visual")
        row["code"], said, row["cpu"] = run(command, args.limit)
        if not (place / "report.json").exists():
            lines = [x for x in said.strip().splitlines() if x]
            row["refused"] = "stopped" if row["code"] is None else (lines or ["?"])[-1]
            return row
        report = json.loads((place / "report.json").read_text())
        links = report["links"]
        row["links"] = len(links)
        row["bodies"] = sum(link.get("bodies", 0) for link in links)
        row["verdicts"] = dict(collections.Counter(link["verdict"] for link in links))
        written = report["urdf"]
        check = report.get("check")
        if check:
            tools = os.pathsep.join(str(x) for x in (args.build / "tools").iterdir() if x.is_dir())
            environment = {**os.environ, "PATH": tools + os.pathsep + os.environ["PATH"]}
            row["check"], _, row["check_cpu"] = run(["sh", "-c", check], args.limit,
                                                    env=environment)
        row["loaded"] = {}
        for engine in installed:
            formats, loader = LOADERS[engine]
            if pathlib.Path(written).suffix in formats:
                code, said, _ = run([sys.executable, "-c", loader, written], args.limit)
                row["loaded"][engine] = code == 0 or said.strip().splitlines()[-1][:200]
    finally:
        shutil.rmtree(place, ignore_errors=True)
    return row


def table_of(rows, epsilon):
    """Markdown."""
    out = ["| robot | format | links | ε | bodies | CPU s | verdict of links | its check | loaded by |",
           "|---|---|--:|---|--:|--:|---|---|---|"]
    for row in rows:
        if "refused" in row:
            out.append(f"| {row['robot']} | {row['format']} | | | | {row['cpu']:.1f} | "
                       f"refused: {row['refused'].replace('|', '/')[:200]} | | |")
            continue
        verdicts = ", ".join(f"{n} {what}" for what, n in sorted(row["verdicts"].items()))
        loaded = ", ".join(name if ok is True else f"NOT {name}"
                           for name, ok in row["loaded"].items())
        check = {0: "passes", None: "stopped"}.get(row.get("check"), f"exit {row.get('check')}")
        out.append(f"| {row['robot']} | {row['format']} | {row['links']} | {epsilon} | "
                   f"{row['bodies']} | {row['cpu']:.1f} | {verdicts} | {check} | {loaded} |")
    return "\n".join(out) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build/release"))
    parser.add_argument("--epsilon", default="1cm")
    parser.add_argument("--visual", action="store_true")
    parser.add_argument("--read", action="store_true")
    parser.add_argument("--match", default="*")
    parser.add_argument("--package-path", action="append", default=[])
    parser.add_argument("--limit", type=float, default=600)
    parser.add_argument("-o", "--output", default="-")
    parser.add_argument("--json")
    args = parser.parse_args()
    paths = [path for folder in args.folders for path in robots_below(folder)
             if fnmatch.fnmatch(str(path), args.match)]
    if args.read:
        read_all(paths, args.build)
        return 0
    installed, rows = engines(), []
    for path in paths:
        rows.append(measure(path, args, installed))
        print(f"{len(rows)} of {len(paths)}: {rows[-1]}", file=sys.stderr, flush=True)
    if args.json:
        pathlib.Path(args.json).write_text(json.dumps(rows, indent=1))
    text = table_of(rows, args.epsilon)
    if args.output == "-":
        print(text)
    else:
        pathlib.Path(args.output).write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
