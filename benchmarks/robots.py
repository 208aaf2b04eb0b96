#!/usr/bin/env python3
"""A table of public robots: what each becomes, what that takes, what decides, and what loads it.

    build/engines/bin/python benchmarks/robots.py SOURCES --results FOLDER [-o docs/robots-table.md]
        [--list benchmarks/robots.txt] [--match PATTERN] [--build build/release] [--epsilon 2cm]
        [--effort fast] [--visual] [--cpu 60] [--again] [--only-table]
    benchmarks/robots.py FOLDER... --read [--build build/release]

SOURCES has a folder for each public repository that the list names. Each robot of the list is
decomposed, its printed check is run, and what was written is loaded by MuJoCo, Drake and Pinocchio
(`scripts/setup --engines`), each in a process of its own, which also compares the poses of all
links at 100 configurations with ours. Results are kept in FOLDER, a file a robot: those that are
there are not made again, so that a run can be ended and gone on with. The table is made of all that
are there. `--cpu` limits each program's CPU seconds. For xacro, `xacro` is on PATH, and the packages
that files include are found as it finds them ($AMENT_PREFIX_PATH).

Snapshots of repositories may lack large files. Of MJCF, what needs a missing file is left out, and
the row says so.

With --read, all robots below the folders are only read; what is refused is counted by its reason.
"""

import argparse
import collections
import datetime
import fnmatch
import hashlib
import importlib.util
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET

HERE = pathlib.Path(__file__).resolve().parent
# Drake reads MJCF, too, but no STL there, which MJCF robots draw.
ENGINES = {"mujoco": {".xml", ".urdf"}, "drake": {".urdf", ".sdf"}, "pinocchio": {".urdf"}}
TOLERANCE = 1e-9
LATER = "not measured yet"


# --- finding robots -------------------------------------------------------------------------------

def robots_below(folder):
    """Files of robots, in order."""
    for path in sorted(pathlib.Path(folder).rglob("*")):
        name = path.name.lower()
        if not path.is_file():
            continue
        if name.endswith((".urdf", ".sdf", ".urdf.xacro")):
            yield path
        elif name.endswith(".xml") and not name.startswith("scene"):
            text = path.read_text(errors="replace")
            if "<mujoco" in text and "<worldbody" in text:
                yield path


def listed(path):
    """(file, arguments of xacro) of each line."""
    for line in pathlib.Path(path).read_text().splitlines():
        words = line.split("#")[0].split()
        if words:
            yield words[0], words[1:]


def without_missing_files(path):
    """An MJCF file without the meshes and textures whose files are missing, beside it.
    @return its path, and how many shapes it has less"""
    tree = ET.parse(path)
    root = tree.getroot()
    folder = path.parent
    meshes = textures = ""
    for compiler in root.iter("compiler"):
        meshes = textures = compiler.get("assetdir", meshes)
        meshes = compiler.get("meshdir", meshes)
        textures = compiler.get("texturedir", textures)
    lacking, materials = set(), set()
    for asset in root.iter("asset"):
        for tag, base, names in (("mesh", meshes, lacking), ("texture", textures, set())):
            for e in list(asset.findall(tag)):
                file = e.get("file")
                if not file or (folder / base / file).exists():
                    continue
                if tag == "texture":
                    materials.add(e.get("name", pathlib.Path(file).stem))
                names.add(e.get("name", pathlib.Path(file).stem))
                asset.remove(e)
    for e in root.iter("material"):
        if e.get("texture") in materials:
            del e.attrib["texture"]
    if not lacking and not materials:
        return path, 0
    lost = 0
    for parent in list(root.iter()):
        for e in list(parent):
            if e.get("mesh") in lacking:
                lost += e.tag == "geom"
                parent.remove(e)
    out = path.with_name("without-missing-" + path.name)
    tree.write(out)
    return out, lost


# --- running --------------------------------------------------------------------------------------

def cpu_of_children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(command, limit, **more):
    """Exit code (None: stopped), what it said, CPU seconds."""
    def limited():
        resource.setrlimit(resource.RLIMIT_CPU, (int(limit), int(limit) + 5))

    before = cpu_of_children()
    done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False,
                          preexec_fn=limited, **more)
    code = None if done.returncode in (-24, -9) else done.returncode
    return code, done.stderr + done.stdout, cpu_of_children() - before


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


def load_engines():
    """The comparing module, with the engines that are there loaded: once, before any fork."""
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    spec = importlib.util.spec_from_file_location("readers", HERE.parent / "tests/engines/readers.py")
    readers = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(readers)
    for name in ("pinocchio", "pydrake.multibody.parsing", "pydrake.multibody.plant"):
        importlib.import_module(name)
    return readers


def ask_engine(readers, name, file, read, limit):
    """What an engine says of a robot, in a process of its own, which may crash or hang."""
    place = tempfile.NamedTemporaryFile(mode="w+", suffix=".json")
    child = os.fork()
    if child == 0:
        try:
            resource.setrlimit(resource.RLIMIT_CPU, (int(limit), int(limit) + 5))
            null = os.open(os.devnull, os.O_WRONLY)
            os.dup2(null, 1)
            os.dup2(null, 2)
            place.write(json.dumps(readers.load(name, file, read)))
            place.flush()
        finally:
            os._exit(0)
    status = os.waitpid(child, 0)[1]
    with place:
        text = pathlib.Path(place.name).read_text()
    if text:
        return json.loads(text)
    signal = os.WTERMSIG(status) if os.WIFSIGNALED(status) else None
    return {"loaded": False, "why": f"ended by signal {signal}" if signal else "failed in the comparison"}


def ask_engines(args, files):
    """By file and engine."""
    done = subprocess.run([str(args.build / "tests/engines/robot-poses"), *map(str, files)],
                          capture_output=True, text=True, check=True)
    reads = json.loads(done.stdout)
    return {file: {name: ask_engine(args.readers, name, file, reads[str(file)], args.cpu)
                   for name, formats in ENGINES.items() if file.suffix.lower() in formats}
            for file in files}


def expanded(path, words, place):
    """A xacro file as what engines load: its text expanded; any other file as it is."""
    if path.suffix != ".xacro":
        return path
    out = place / "original" / path.with_suffix("").with_suffix(".urdf").name
    out.parent.mkdir()
    done = subprocess.run(["xacro", str(path), *words, "-o", str(out)], capture_output=True, check=False)
    return out if done.returncode == 0 else None


def commit():
    """Of the sources; with "+" where they have changes that are not committed."""
    name = subprocess.run(["git", "-C", str(HERE), "rev-parse", "--short", "HEAD"],
                          capture_output=True, text=True, check=False).stdout.strip()
    changed = subprocess.run(["git", "-C", str(HERE), "diff", "--quiet", "HEAD"], check=False).returncode != 0
    return name + "+" if changed else name


def measure(path, words, args, sources):
    """The row of one robot."""
    row = {"robot": str(path.relative_to(sources)), "format": path.suffix[1:], "epsilon": args.epsilon,
           "effort": args.effort, "shapes": "visual" if args.visual else "collision",
           "date": datetime.date.today().isoformat(), "commit": commit()}
    if words:
        row["arguments"] = words
    if not path.exists():
        return {**row, "missing": "not in the snapshot"}
    if path.suffix == ".xml":
        path, row["without"] = without_missing_files(path)
    place = pathlib.Path(tempfile.mkdtemp(prefix="robots."))
    tools = args.build / "bin"
    environment = {**os.environ, "PATH": f"{tools}{os.pathsep}{os.environ['PATH']}"}
    repository = sources / path.relative_to(sources).parts[0]
    os.environ["ROS_PACKAGE_PATH"] = os.pathsep.join(
        map(str, (repository, sources, path.parent.parent, path.parent.parent.parent)))
    try:
        command = ["bcd-decompose", str(path), "-o", str(place / "out"), "--epsilon", args.epsilon,
                   "--effort", args.effort, "--no-cache", "--package-path",
                   str(repository),
                   "--report", str(place / "report.json")]
        if path.suffix != ".xml":
            command += ["--for", "drake"]  # which reads OBJ, as the others do
        if words:
            command += ["--xacro-args", *words]
        if args.visual:
            command.append("--visual")
        row["code"], said, row["cpu"] = run(command, args.cpu, env=environment)
        if "try --geometry visual" in said:  # nothing collides there
            row["shapes"] = "visual"
            row["code"], said, row["cpu"] = run([*command, "--visual"], args.cpu, env=environment)
        if not (place / "report.json").exists():
            lines = [x for x in said.strip().splitlines() if x]
            row["refused"] = (f"stopped after {args.cpu:g} s of CPU" if row["code"] is None
                              else (lines or ["no word"])[-1].replace(f"{sources}/", "").replace(str(sources), "SOURCES"))
            original = expanded(path, words, place)
            row["original"] = ask_engines(args, [original])[original] if original else {}
            return row
        report = json.loads((place / "report.json").read_text())
        row["links"] = len(report["links"])
        row["bodies"] = sum(link.get("bodies", 0) for link in report["links"])
        row["verdicts"] = dict(collections.Counter(link["verdict"] for link in report["links"]))
        row["not_held"] = {link["link"]: link.get("sentence", "") for link in report["links"]
                           if link["verdict"] != "held"}
        if "check" in report:
            row["check"], _, row["check_cpu"] = run(["sh", "-c", report["check"]], 4 * args.cpu,
                                                    env=environment)
        written, original = pathlib.Path(report["urdf"]), expanded(path, words, place)
        answers = ask_engines(args, [x for x in (original, written) if x])
        row["original"], row["written"] = answers.get(original, {}), answers[written]
    finally:
        shutil.rmtree(place, ignore_errors=True)
    return row


# --- the table ------------------------------------------------------------------------------------

def short(text):
    return (text if len(text) < 100 else text[:100] + "…").replace("|", "/").replace("<", "&lt;")


def loaded_before(row, name):
    """Whether an engine loads the original."""
    return row.get("original", {}).get(name, {}).get("loaded", False)


def engines_of(row):
    """What loaded a written robot."""
    out, neither = [], []
    for name, answer in row.get("written", {}).items():
        if not answer["loaded"]:
            if not loaded_before(row, name):
                neither.append(name)
                continue
            why = re.sub(r"\S*/(\S*): (?=error)|^Error: ", "", answer["why"])
            out.append(f"NOT {name}, which loads the original ({short(why)})")
        elif answer.get("worst") is not None and answer["worst"] > TOLERANCE:
            out.append(f"{name} (poses off by {answer['worst']:.1e})")
        elif answer.get("faults"):
            out.append(f"{name} ({short(answer['faults'][0])})")
        else:
            out.append(name)
    if neither:
        out.append(f"not {', '.join(neither)}: nor the original")
    return ", ".join(out)


def table_of(rows):
    """Markdown."""
    out = ["| robot | format | links | ε | bodies | CPU s | links held | its check | loaded by |",
           "|---|---|--:|---|--:|--:|---|---|---|"]
    for row in rows:
        name = row["robot"] + "".join(f" {x}" for x in row.get("arguments", []))
        if row.get("shapes") == "visual":
            name += " (visual)"
        if row.get("without"):
            name += f" (without {row['without']} shapes whose files are missing)"
        if "missing" in row or "refused" in row:
            why = row.get("missing") or "refused: " + row["refused"].replace("bcd-decompose: ", "")
            why = why.replace("|", "/").replace("<", "&lt;")[:240]
            loading = [name for name in row.get("original", {}) if loaded_before(row, name)]
            if loading:
                why += f" ({', '.join(loading)} load{'s' if len(loading) == 1 else ''} it)"
            elif "refused" in row:
                why += " (no engine loads it)"
            cpu = f"{row['cpu']:.1f}" if "cpu" in row else ""
            out.append(f"| {name} | {row['format']} | | {row['epsilon']} | | {cpu} | {why} | | |")
            continue
        held = row["verdicts"].get("held", 0)
        verdict = f"all {held}" if held == row["links"] else f"{held} of {row['links']}; not " + \
            ", ".join(list(row["not_held"])[:4]) + (" …" if len(row["not_held"]) > 4 else "")
        expected = 0 if held == row["links"] else 1
        check = {expected: "passes" if expected == 0 else "names them", None: "stopped"}.get(
            row.get("check"), f"exit {row.get('check')}")
        out.append(f"| {name} | {row['format']} | {row['links']} | {row['epsilon']} | {row['bodies']} "
                   f"| {row['cpu']:.1f} | {verdict} | {check} | {engines_of(row)} |")
    return "\n".join(out) + "\n"


def summary_of(rows):
    """Sentences before the table."""
    there = [row for row in rows if "missing" not in row]
    later = [row for row in rows if row.get("missing") == LATER]
    absent = len(rows) - len(there) - len(later)
    written = [row for row in there if "refused" not in row]
    loads = [row for row in written if any(x["loaded"] for x in row["written"].values())]
    held = [row for row in written if row["verdicts"].get("held", 0) == row["links"]]
    checked = [row for row in written if row.get("check") in (0, 1)]
    compared = [(name, answer) for row in there for what in ("original", "written")
                for name, answer in row.get(what, {}).items() if answer.get("worst") is not None]
    loadable = [row for row in there if any(loaded_before(row, x) for x in row.get("original", {}))]
    kept = [row for row in loadable if any(loaded_before(row, name) and answer["loaded"]
                                           for name, answer in row.get("written", {}).items())]
    pairs = [(row, name) for row in loadable for name in row["original"] if loaded_before(row, name)]
    pairs_kept = [1 for row, name in pairs if row.get("written", {}).get(name, {}).get("loaded")]
    near = [1 for _, answer in compared if answer["worst"] <= TOLERANCE]
    worst = max((answer["worst"] for _, answer in compared if answer["worst"] <= TOLERANCE), default=0)
    return (f"{len(rows)} robots are listed. {absent} of them are not in the snapshots, {len(later)} are not measured yet. "
            f"Of the other {len(there)}:\n\n"
            f"- {len(written)} are written, {len(there) - len(written)} refused or stopped;\n"
            f"- {len(loads)} of those written are loaded by one engine at least;\n"
            f"- of {len(loadable)} robots an engine loads the original: of {len(kept)} of these it loads what is written, too "
            f"(by single engines: {len(pairs_kept)} of {len(pairs)});\n"
            f"- of {len(held)} every link is held; of {len(checked)} the printed check decided;\n"
            f"- kinematics were compared {len(compared)} times with an engine's, originals and what is "
            f"written: {len(near)} times all links are where the engine has them, within {worst:.1e}.\n")


def page_of(rows):
    commits = sorted({row["commit"] for row in rows if row.get("missing") != LATER})
    dates = sorted({row["date"] for row in rows})
    efforts = sorted({row["effort"] for row in rows if "effort" in row})
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        machine = re.search(r"model name\s*: (.*)", file.read())
    return ("# A table of robots\n\n"
            "Public robots, each decomposed for collision checks, its links judged, its printed check run, and what was\n"
            "written loaded by the engines of [today](engines.md#engines-of-today). The shapes are those for collisions, but\n"
            "where a row says otherwise: links with shapes for drawing only are not counted, and nothing is made for them.\n"
            f"Effort: {', '.join(efforts)}. CPU seconds are those of `bcd-decompose` without cache. Made by\n"
            "`benchmarks/robots.py`, which says how; sources are folders of public repositories, named as in\n"
            "`benchmarks/robots.txt`.\n\n"
            f"Measured {dates[0]}{'' if len(dates) == 1 else ' to ' + dates[-1]}, commit "
            f"{', '.join(commits)}, {machine.group(1) if machine else 'unknown processor'}, {os.cpu_count()} cores.\n\n"
            + summary_of(rows) + "\n" + table_of(rows))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sources", nargs="+")
    parser.add_argument("--list", default=HERE / "robots.txt")
    parser.add_argument("--match", default="*")
    parser.add_argument("--build", type=pathlib.Path, default=HERE.parent / "build/release")
    parser.add_argument("--epsilon", default="2cm")
    parser.add_argument("--effort", default="fast")
    parser.add_argument("--visual", action="store_true")
    parser.add_argument("--cpu", type=float, default=60)
    parser.add_argument("--results", type=pathlib.Path)
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--only-table", action="store_true")
    parser.add_argument("--read", action="store_true")
    parser.add_argument("-o", "--output")
    args = parser.parse_args()
    args.build = args.build.resolve()
    if args.read:
        read_all([x for folder in args.sources for x in robots_below(folder)
                  if fnmatch.fnmatch(str(x), args.match)], args.build)
        return 0
    if args.results is None or len(args.sources) != 1:
        parser.error("one folder of sources, and --results")
    args.results.mkdir(parents=True, exist_ok=True)
    sources = pathlib.Path(args.sources[0]).resolve()
    args.readers = None if args.only_table else load_engines()
    rows = []
    for file, words in listed(args.list):
        if not fnmatch.fnmatch(file, args.match):
            continue
        key = hashlib.sha256(json.dumps([file, words, args.epsilon, args.effort,
                                         args.visual]).encode()).hexdigest()[:16]
        kept = args.results / f"{key}.json"
        if (args.again or not kept.exists()) and not args.only_table:
            row = measure(sources / file, words, args, sources)
            partial = kept.with_suffix(".part")
            partial.write_text(json.dumps(row, indent=1))
            partial.rename(kept)
            print(json.dumps({k: v for k, v in row.items() if k not in ("original",)}),
                  file=sys.stderr, flush=True)
        if kept.exists():
            rows.append(json.loads(kept.read_text()))
        else:
            rows.append({"robot": file, "format": pathlib.Path(file).suffix[1:],
                         "epsilon": args.epsilon, "missing": LATER,
                         "date": datetime.date.today().isoformat(), "commit": commit()})
    text = page_of(rows)
    if args.output:
        pathlib.Path(args.output).write_text(text)
    else:
        print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
