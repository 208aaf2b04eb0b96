#!/usr/bin/env python3
"""How time and memory grow with a mesh, from thousands of triangles to tens of millions.

growth.py BUILD-FOLDER WORK MESH [--times 4] [--ratio 0.05] [--effort fast] [--timeout 3600]

MESH is closed. It is cut into four triangles each, 0 to N times; then each program below runs on each of them, in a process of
its own, on one thread, with nothing cached. User CPU seconds and peak memory are written to WORK/growth.csv and as a table to
WORK/growth.md. The exponent between two sizes is log(seconds ratio) / log(triangles ratio): 1 is proportional.

  prepare    mesh-prepare
  decimate   bmesh-decimate --ratio R --effort E
  verify     bound-verify mesh --outer: that the decimated mesh encloses the mesh, decided exactly
  distance   hausdorff-eval: the certified distance of both surfaces

Exit code 1: a program did not do what was asked (its exit code is in the table).
"""
import argparse
import csv
import math
import os
import pathlib
import resource
import subprocess
import sys

COLUMNS = ("program", "triangles", "seconds", "megabytes", "exit_code")


def run(command, timeout, folder):
    """Exit code, user CPU seconds and peak megabytes of a process."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (timeout, timeout + 5))
    with open(folder / "output.txt", "a", encoding="utf-8") as output:
        print("$", *command, file=output, flush=True)
        process = subprocess.Popen(list(map(str, command)), stdout=output, stderr=output, preexec_fn=limit)
        _, status, usage = os.wait4(process.pid, 0)
    return os.waitstatus_to_exitcode(status), usage.ru_utime, usage.ru_maxrss / 1024


def table(rows):
    """Rows as Markdown, a program's exponents between neighbouring sizes."""
    lines = ["| program | triangles | CPU | per million | exponent | memory | per million |", "|---|---:|---:|---:|---:|---:|---:|"]
    before, programs = {}, list(dict.fromkeys(row["program"] for row in rows))
    for row in sorted(rows, key=lambda r: (programs.index(r["program"]), r["triangles"])):
        millions, last = row["triangles"] / 1e6, before.get(row["program"])
        exponent = "" if last is None else f"{math.log(row['seconds'] / last['seconds']) / math.log(row['triangles'] / last['triangles']):.2f}"
        said = "" if row["exit_code"] == 0 else f" (exit code {row['exit_code']})"
        lines.append(f"| {row['program']}{said} | {row['triangles']:,} | {row['seconds']:.2f} s | {row['seconds'] / millions:.1f} s | {exponent} | "
                     f"{row['megabytes']:,.0f} MB | {row['megabytes'] / millions:,.0f} MB |")
        before[row["program"]] = row
    return "\n".join(lines) + "\n"


def commands(options, mesh, folder):
    """The command of each program, by name; the later ones use what the second makes."""
    programs, result = options.build / "bin", folder / "decimated.ply"
    one = ["--threads", "1"]
    return {
        "prepare": [programs / "mesh-prepare", mesh, "-o", folder / "prepared.ply", *one],
        "decimate": [programs / "bmesh-decimate", mesh, "-o", result, "--ratio", options.ratio, "--effort", options.effort, "--no-cache", "--quiet", *one],
        "verify": [programs / "bound-verify", "mesh", "--outer", "--prepare", mesh, result, *one],
        "distance": [programs / "hausdorff-eval", mesh, result, *one],
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("mesh", type=pathlib.Path)
    parser.add_argument("--times", type=int, default=4, help="how often the mesh is cut into four [%(default)s]")
    parser.add_argument("--ratio", default="0.05", help="of bmesh-decimate [%(default)s]")
    parser.add_argument("--effort", default="fast", help="of bmesh-decimate [%(default)s]")
    parser.add_argument("--timeout", type=int, default=3600, help="CPU seconds of a process [%(default)s]")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    (options.work / "output.txt").write_text("", encoding="utf-8")
    rows = []
    for times in range(options.times + 1):
        mesh = options.work / "mesh.ply"
        made = subprocess.run([options.build / "benchmarks/subdivide", options.mesh, "-o", mesh, "--times", str(times)], check=True, capture_output=True, text=True)
        for program, command in commands(options, mesh, options.work).items():
            code, seconds, megabytes = run(command, options.timeout, options.work)
            rows.append(dict(zip(COLUMNS, (program, int(made.stdout), seconds, megabytes, code))))
            print(f"{program}, {int(made.stdout):,} triangles: {seconds:.2f} s, {megabytes:,.0f} MB, exit code {code}", flush=True)
        with open(options.work / "growth.csv", "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS)
            writer.writeheader()
            writer.writerows(rows)
    (options.work / "growth.md").write_text(table(rows), encoding="utf-8")
    print(table(rows), end="")
    return 0 if all(row["exit_code"] == 0 for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
