"""Fetches the models of the evaluation from where they are published, and makes of them the files that it reads.

sources.csv lists the files: where each goes, the repository, commit and path that it comes from, its SHA-256 and its licence. What is there
already with the right hash is not fetched again; what arrives with another hash is refused.
"""

import argparse
import csv
import hashlib
import math
import os
import pathlib
import subprocess
import sys
import urllib.error
import urllib.request
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parent
FROM = "https://raw.githubusercontent.com/{repository}/{commit}/{path}"
SECONDS = 60  # for an answer

# Made of fetched files: a mesh as bmesh-decimate welds it, without sheets, which have no volume.
CONVERTED = {
    **{f"thesis-robots/{name}-whole-welded.ply": f"sources/{scene}/{scene}.wrl" for name, scene in (
        ("mitsubishi-rv6s", "mitsubishi-rv6s"), ("mitsubishi-rv6sl", "mitsubishi-rv6sl"),
        ("kuka-kr240-r2500-prime", "kuka-kr240-r2500-prime"), ("comau-smart5-nj4-220-27", "comau-smart5-nj4-220-27"))},
    "robot-puma560-whole-welded.ply": "robots/puma560-vrml/unimation-puma560.wrl",
    "scan-stanford-bunny-34834-holes.ply": "sources/bunny.off",
}
ASSEMBLED = {  # at joint position 0
    "robot-ur5-whole-welded.ply": "robots/ur5-description/urdf/ur5-robot.urdf",
    "robot-kuka-kr120-r2500-pro-whole-welded.ply": "robots/kuka-kr120-support/urdf/kr120r2500pro.urdf",
}
# Names of packages and files in the two URDF files, and those of the folders here.
RENAMED = {
    "robots/ur5-description/urdf/ur5-robot.urdf": (("example-robot-data/robots/ur_description", "ur5-description"),),
    "robots/kuka-kr120-support/urdf/kr120r2500pro.urdf": (("kuka_kr120_support", "kuka-kr120-support"), ("base_link.", "base-link."),
                                                         *((f"link_{i}.", f"link-{i}.") for i in range(1, 7))),
}
BY_HAND = ("scan-stanford-dragon-437645.ply: the full reconstruction of the Stanford dragon (437,645 vertices), from the Stanford 3D "
           "Scanning Repository")


class Refused(Exception):
    pass


def write(path, data):
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(path.name + ".part")
    part.write_bytes(data)
    os.replace(part, path)


def fetched(row, template):
    url = template.format(**row)
    try:
        with urllib.request.urlopen(url, timeout=SECONDS) as answer:
            data = answer.read()
    except (urllib.error.URLError, OSError) as error:
        raise Refused(f"{url}: {getattr(error, 'reason', error)}; try again, or give --from") from error
    found = hashlib.sha256(data).hexdigest()
    if found != row["sha256"]:
        raise Refused(f"{url}: its SHA-256 is {found}, not {row['sha256']}; it is not the file that was measured")
    return data


def numbers(text):
    return [float(word) for word in text.split()]


def placement(origin):
    """3 by 4 matrix of an <origin> (fixed axes roll, pitch, yaw); the identity without."""
    x, y, z = numbers(origin.get("xyz", "0 0 0")) if origin is not None else (0, 0, 0)
    roll, pitch, yaw = numbers(origin.get("rpy", "0 0 0")) if origin is not None else (0, 0, 0)
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (math.cos, math.sin))
    return [[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, x],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr, y], [-sp, cp * sr, cp * cr, z]]


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) + (a[i][3] if j == 3 else 0) for j in range(4)] for i in range(3)]


def visual_meshes(urdf):
    """(file, placement) of every visual mesh, all joints at 0."""
    robot = xml.etree.ElementTree.parse(urdf).getroot()
    parent = {joint.find("child").get("link"): (joint.find("parent").get("link"), placement(joint.find("origin")))
              for joint in robot.findall("joint")}

    def where(link):
        if link not in parent:
            return placement(None)
        above, step = parent[link]
        return times(where(above), step)
    folder = urdf.parents[2]  # of the packages
    return [(folder / mesh.get("filename").removeprefix("package://"), times(where(link.get("name")), placement(visual.find("origin"))))
            for link in robot.findall("link") for visual in link.findall("visual") for mesh in visual.iter("mesh")]


def convert(program, mesh, result):
    done = subprocess.run([program, mesh, "-o", result, "--vertices", str(10 ** 9), "--drop-sheets", "--holes", "keep", "--precision",
                           "double", "--quiet"], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1) or not result.is_file():
        raise Refused((done.stderr.strip().splitlines() or [f"{program}: exit code {done.returncode}"])[-1])


def assemble(program, urdf, result):
    """All visual meshes of a robot as one OBJ, then as `result`."""
    whole, part = result.with_suffix(".whole.obj"), result.with_suffix(".link.obj")
    first = 0
    with open(whole, "w", encoding="utf-8") as file:
        for mesh, at in visual_meshes(urdf):
            convert(program, mesh, part)
            count = 0
            for words in map(str.split, part.read_text(encoding="utf-8").splitlines()):
                if words[:1] == ["v"]:
                    point = [*map(float, words[1:4]), 1]
                    file.write("v " + " ".join(repr(sum(c * p for c, p in zip(line, point))) for line in at) + "\n")
                    count += 1
                elif words[:1] == ["f"]:
                    file.write("f " + " ".join(str(int(word.split("/")[0]) + first) for word in words[1:]) + "\n")
            first += count
    convert(program, whole, result)
    part.unlink()
    whole.unlink()


def main(argv):
    parser = argparse.ArgumentParser(prog="fetch-models", description=__doc__.splitlines()[0],
                                     epilog=f"To be had by hand: {BY_HAND}. Exit codes: 0 all there; 1 something is not; 2 usage; 3 a program is missing.")
    parser.add_argument("folder", type=pathlib.Path, metavar="DIR", help="where they go; then KABOUM_MESHES=DIR")
    parser.add_argument("--from", dest="template", default=FROM, metavar="URL",
                        help=f"where files are, with {{repository}}, {{commit}} and {{path}} [{FROM.replace('%', '%%')}]")
    parser.add_argument("--list", action="store_true", help="print files, sources and licences, and fetch nothing")
    parser.add_argument("--programs", type=pathlib.Path, metavar="DIR", default=ROOT.parent / "build/release/bin")
    options = parser.parse_args(argv)
    with open(ROOT / "sources.csv", newline="", encoding="utf-8") as file:
        sources = list(csv.DictReader(file))
    if options.list:
        for row in sources:
            print(f"{row['file']}: {FROM.format(**row)} ({row['licence']})")
        return 0
    program = options.programs / "bmesh-decimate"
    if not program.is_file():
        print(f"fetch-models: {program} is missing; scripts/build makes it", file=sys.stderr)
        return 3
    failed = 0

    def attempt(action):
        nonlocal failed
        try:
            action()
        except Refused as why:
            print(f"fetch-models: {why}", file=sys.stderr)
            failed += 1
    for number, row in enumerate(sources, 1):
        path = options.folder / row["file"]
        kept = path.with_name(path.name + ".original") if row["file"] in RENAMED else path

        def one(row=row, path=path, kept=kept):
            if not kept.is_file() or hashlib.sha256(kept.read_bytes()).hexdigest() != row["sha256"]:
                print(f"[{number}/{len(sources)}] {row['file']}", file=sys.stderr)
                write(kept, fetched(row, options.template))
            if row["file"] in RENAMED:
                text = kept.read_text(encoding="utf-8")
                for old, new in RENAMED[row["file"]]:
                    text = text.replace(old, new)
                write(path, text.encode())
        attempt(one)
    for makers, make in ((CONVERTED, convert), (ASSEMBLED, assemble)):
        for result, source in makers.items():
            here = options.folder / result
            if not here.is_file() and (options.folder / source).is_file():
                print(result, file=sys.stderr)
                here.parent.mkdir(parents=True, exist_ok=True)
                part = here.with_name(f"part-{here.name}")

                def one(make=make, source=source, here=here, part=part):
                    make(program, options.folder / source, part)
                    os.replace(part, here)
                attempt(one)
    if not (options.folder / BY_HAND.split(":", maxsplit=1)[0]).is_file():
        print(f"fetch-models: by hand: {BY_HAND}", file=sys.stderr)
    print(f"{options.folder}: {len(sources)} files" + (f", {failed} failed" if failed else ""))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
