#!/usr/bin/env python3
"""Pairs of links of many robots: how many kaboum-pairs decides, in what time, and whether samples of exact meshes agree.

  benchmarks/pairs/robots.py BUILD SOURCES OUT [--list FILE] [--timeout SECONDS] [--samples N]

BUILD has bin/kaboum-pairs and benchmarks/pairs-judge-benchmark. The list has a robot's file below SOURCES in each line (# begins
a comment); by default robots.txt beside this file. OUT keeps the answer of each robot, so that the work can go on after an end, or with more samples.
Printed: a table, those with most open pairs first, and the sum. The exit code is 1 where a program ended as it should not, or
something that is claimed is wrong.
"""
import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import time


def listed(path):
    for text in pathlib.Path(path).read_text().splitlines():
        text = text.split("#")[0].strip()
        if text:
            yield text


def run(command, **more):
    """What a program said, its exit code, seconds and seconds of CPU time."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True, errors="replace", **more)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done, time.monotonic() - start, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def kept_file(args, robot, ending):
    return args.out / (robot.replace("/", "+") + ending)


def keep(file, text):
    partial = file.with_suffix(".part")
    partial.write_text(text)
    os.replace(partial, file)


def measure(args, robot):
    command = [args.build / "bin/kaboum-pairs", args.sources / robot, "--json", "--quiet"]
    command += ["--timeout", str(args.timeout)] if args.timeout else []
    row = {"robot": robot, "date": time.strftime("%Y-%m-%d")}
    try:
        done, row["seconds"], row["cpu"] = run(command, timeout=600)
    except subprocess.TimeoutExpired:
        return {**row, "code": "no end in 600 s", "said": ""}
    row["code"], row["said"] = done.returncode, done.stderr.strip()[-2000:]
    if done.returncode not in (0, 7):
        return row
    pairs = json.loads(done.stdout)["pairs"]
    row["pairs"] = len(pairs)
    for verdict in ("never", "always", "can touch", "open"):
        row[verdict] = sum(p["verdict"] == verdict for p in pairs)
    row["why"] = sorted({p["why"] for p in pairs if p["verdict"] == "open" and "why" in p})
    row["without a reason"] = sum(p["verdict"] == "open" and "why" not in p for p in pairs)
    row["open away from the joint"] = sum(p.get("away_from_joint", {}).get("verdict") == "open" for p in pairs)
    keep(kept_file(args, robot, ".pairs"), done.stdout)
    return row


def judge(args, robot, row):
    """Adds what the exact meshes say at so many samples, if they were fewer before."""
    report = kept_file(args, robot, ".pairs")
    if row.get("samples", 0) >= args.samples or not report.exists():
        return False
    judged, row["judge's seconds"], _ = run([args.build / "benchmarks/pairs-judge-benchmark", args.sources / robot, report, str(args.samples), "7"])
    row["judged"] = json.loads(judged.stdout) if judged.returncode in (0, 1) else {"failed": judged.stderr.strip()[-500:]}
    row["samples"] = args.samples
    return True


def is_wrong(row):
    judged = row.get("judged", {})
    return row["code"] not in (0, 7) and row["code"] != 3 or bool(judged.get("wrong"))


def table(rows):
    print("| robot | pairs | open | of these unsure | decided | never | always | can touch | s | CPU s | samples of *never* | wrong |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    good = [r for r in rows if "pairs" in r]
    for r in sorted(good, key=lambda r: -r["open"]):
        judged = r.get("judged", {})
        said = "; ".join(judged["wrong"]) if judged.get("wrong") else judged.get("failed", "0" if judged else "–")
        print(f"| {r['robot']} | {r['pairs']} | {r['open']} | {r['open'] - r['without a reason']} | {r['pairs'] - r['open']} | {r['never']} | {r['always']} "
              f"| {r['can touch']} | {r['seconds']:.1f} | {r['cpu']:.1f} | {judged.get('never', 0):,} | {said} |")
    for r in rows:
        if "pairs" not in r:
            print(f"| {r['robot']} | exit code {r['code']} | {r['said'][-200:]} |")
    total = lambda key: sum(r[key] for r in good)
    if good:
        print(f"\n{len(good)} robots of {len(rows)}: {total('pairs'):,} pairs, {total('open'):,} open ({100 * total('open') / total('pairs'):.2f} %), "
              f"{total('open') - total('without a reason'):,} of these with a reason, {total('open away from the joint'):,} adjacent ones open away "
              f"from their joint; {sum(r['open'] == 0 for r in good)} robots have none; "
              f"{sum(r.get('judged', {}).get('never', 0) for r in good):,} samples of *never*, "
              f"{sum(r.get('judged', {}).get('shown', 0) for r in good):,} shown contacts, "
              f"{sum(len(r.get('judged', {}).get('wrong') or []) for r in good)} pairs wrong")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("sources", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--list", default=pathlib.Path(__file__).resolve().parent / "robots.txt")
    parser.add_argument("--timeout", type=float, help="of kaboum-pairs, if another than its own")
    parser.add_argument("--samples", type=int, default=1000, help="configurations that the exact meshes judge; 0: none")
    parser.add_argument("--only-table", action="store_true", help="of what OUT has")
    args = parser.parse_args()
    args.build, args.sources = args.build.resolve(), args.sources.resolve()
    args.out.mkdir(parents=True, exist_ok=True)
    rows = []
    for robot in listed(args.list):
        kept = kept_file(args, robot, ".json")
        row = json.loads(kept.read_text()) if kept.exists() else None
        if not args.only_table:
            known, row = row is not None, row or measure(args, robot)
            if judge(args, robot, row) or not known:
                keep(kept, json.dumps(row, indent=1))
                print(json.dumps({k: v for k, v in row.items() if k != "said"}), file=sys.stderr, flush=True)
        if row:
            rows.append(row)
    table(rows)
    return 1 if any(map(is_wrong, rows)) else 0


if __name__ == "__main__":
    sys.exit(main())
