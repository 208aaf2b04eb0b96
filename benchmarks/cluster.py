#!/usr/bin/env python3
"""Many files through kaboum-batch, alone and by two nodes of a Slurm cluster that is started here: the same bytes, and what a file costs.

usage: cluster.py BIN WORK [N [COLLECTION]]    (N meshes, 2000; those of a folder besides generated ones, 20 damaged)
       cluster.py BIN WORK --rows N            (only what N files in a batch's list and journals cost its runs)
"""
import hashlib
import json
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import time

import batch

HERE = pathlib.Path(__file__).resolve().parent
PARTS = 8
DECIMATE = ["--command", "bmesh-decimate", "--epsilon", "2%", "--effort", "fast", "--cost", "planes"]
DECOMPOSE = ["--command", "bcd-decompose", "--epsilon", "5%", "--effort", "fast"]
CLUSTER = """
. "$1"; cluster=$2; shift 2
trap stop_cluster EXIT
start_cluster "$cluster" || { echo "no cluster" >&2; exit 2; }
job=$(sbatch --parsable --output="$cluster/%j.txt" --array=1-PARTS "$@") || exit 2
sbatch --wait --output="$cluster/%j.txt" --dependency="afterany:$job" "$@" >/dev/null
grep -c 'Launching batch job' "$cluster"/node1.txt "$cluster"/node2.txt >&2
"""


def counted(command):
    """Seconds by the clock, of the processor, and what the kernel counted of the process and all that it started."""
    begin, before = time.time(), resource.getrusage(resource.RUSAGE_CHILDREN)
    process = subprocess.Popen(command)
    os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
    io = dict(line.split(": ") for line in pathlib.Path(f"/proc/{process.pid}/io").read_text().splitlines())
    process.wait()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"exit": process.returncode, "wall": time.time() - begin, "cpu": cpu, **{k: int(v) for k, v in io.items()}}


def rows(out):
    summary = json.loads((out / "summary.json").read_text())
    for row in summary["rows"]:
        for measured in ("wall_seconds", "cpu_seconds", "peak_megabytes"):
            del row[measured]
        row["reason"] = row["reason"].replace(str(out), "OUT")
    return summary["rows"], summary["states"], summary["to_do"]


def size_of(folder):
    files = [p for p in folder.rglob("*") if p.is_file()]
    return len(files), sum(p.stat().st_size for p in files)


def say(name, c, files):
    print(f"{name}: exit code {c['exit']}, {c['wall']:.1f} s, per file {1000 * c['wall'] / files:.1f} ms by the clock, "
          f"{1000 * c['cpu'] / files:.1f} ms of CPU, read {c['rchar'] / files / 1000:.1f} kB in {c['syscr'] / files:.0f} calls, "
          f"written {c['wchar'] / files / 1000:.1f} kB in {c['syscw'] / files:.0f} calls", flush=True)


def many_rows(binary, work, count):
    """A batch of which all is known: what is left is reading the list and journals, and writing the summary."""
    (work / "out/.kaboum-batch").mkdir(parents=True)
    version = subprocess.run([binary / "kaboum-batch", "--version"], capture_output=True, text=True).stdout.split()[-1]
    names = [f"cell-{i % 997}/assembly-{i % 89}/part-{i:07}.off" for i in range(count)]
    (work / "list.txt").write_text("\n".join(names) + "\n")
    # All have one result, of about the size of those above.
    result = b"ply\n" + 2100 * b"x"
    row = dict(sha256=hashlib.sha256(result).hexdigest(), sources=[], state="done", exit_code=0, reason="", input_bytes=0,
               output_bytes=len(result), wall_seconds=0.0123, cpu_seconds=0.0101, peak_megabytes=12.5, vertices_before=812, vertices_after=97,
               bodies=None, ratio=0.119, distance=0.0123, diagonal=1.2345, verdict="certified", parameters="bmesh-decimate --epsilon 1%", picture="")
    for folder in {pathlib.Path(name).parent for name in names}:
        (work / "out/results" / folder).mkdir(parents=True)
    journals = [(work / f"out/.kaboum-batch/journal-{k}.jsonl").open("w") for k in range(100)]
    for i, name in enumerate(names):
        output = "results/" + name[:-4] + ".ply"
        key = hashlib.sha256(f"{work / name}\n0 0 0 {version}\nbmesh-decimate\n--epsilon\n1%\n{output}".encode()).hexdigest()
        (work / "out" / output).write_bytes(result)
        journals[i % 100].write(json.dumps(dict(name=name, key=key, output=output, **row), separators=(",", ":")) + "\n")
    for journal in journals:
        journal.close()
    for name, options in (("summary", ["--summary"]), ("a part with nothing to do", ["--shard", "1/1000"])):
        usage = work / "peak.txt"
        c = counted(["/usr/bin/env", "python3", "-c", PEAK, usage, binary / "kaboum-batch", work / "list.txt", "-o", work / "out",
                     "--no-pictures", "--quiet"] + options)
        print(f"{name}: {c['wall']:.1f} s, {c['cpu']:.1f} s of CPU, {usage.read_text().strip()} MB at most", flush=True)
    summary = json.loads((work / "out/summary.json").read_text())
    assert len(summary["rows"]) == count and summary["to_do"] == 0
    print(", ".join(f"{p.name} {p.stat().st_size / 1e6:.0f} MB" for p in sorted((work / "out").glob("summary.*"))))


PEAK = """
import pathlib, resource, subprocess, sys
code = subprocess.run(sys.argv[2:]).returncode
pathlib.Path(sys.argv[1]).write_text(str(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024))
sys.exit(code)
"""


def main():
    binary, work = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).absolute()
    if len(sys.argv) > 4 and sys.argv[3] == "--rows":
        shutil.rmtree(work, ignore_errors=True)
        return many_rows(binary, work, int(sys.argv[4]))
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 2000
    collection = pathlib.Path(sys.argv[4]) if len(sys.argv) > 4 else None
    shutil.rmtree(work, ignore_errors=True)
    damaged, collected = batch.generate(work / "in", count, collection)
    os.environ.update(KABOUM_CACHE=str(work / "cache"), KABOUM_BIN=f"{binary}/")
    arguments = lambda out: [str(work / "in"), "-o", str(work / out), "--no-pictures", "--quiet", "--timeout", "120"]
    tool = [str(binary / "kaboum-batch")]
    print(f"{count} files, {collected} collected, {len(damaged)} damaged; {size_of(work / 'in')[1] / count / 1000:.1f} kB each", flush=True)
    say("alone", counted(tool + arguments("alone") + ["--jobs", "2"] + DECIMATE), count)
    say("again, nothing to do", counted(tool + arguments("alone") + ["--jobs", "2"] + DECIMATE), count)
    say("no work: true", counted(tool + arguments("none") + ["--jobs", "2", "--command", "true", "{input}"]), count)
    begin = time.time()
    script = CLUSTER.replace("PARTS", str(PARTS))
    helper, job = HERE.parent / "tests/support/slurm-cluster.sh", HERE.parent / "share/slurm/kaboum-batch.slurm"
    code = subprocess.run(["sh", "-c", script, "sh", helper, work / "cluster", job] + arguments("shared") + DECIMATE).returncode
    print(f"two nodes, {PARTS} parts: exit code {code}, {time.time() - begin:.1f} s, of which some for the cluster to start")
    same = subprocess.run(["diff", "-rq", work / "alone/results", work / "shared/results"]).returncode == 0
    alone, shared = rows(work / "alone"), rows(work / "shared")
    print(f"states {shared[1]}, to do {shared[2]}; results the same bytes: {same}; rows of the summary the same: {alone == shared}")
    say("bcd-decompose", counted(tool + arguments("sets") + ["--jobs", "2"] + DECOMPOSE), count)
    entries, size = size_of(work / "cache")
    print(f"cache: {entries} entries, {size / max(entries, 1) / 1000:.1f} kB each; results {size_of(work / 'sets/results')[1] / max(entries, 1) / 1000:.1f} kB each")
    shutil.rmtree(work / "sets")
    say("bcd-decompose from the cache", counted(tool + arguments("sets") + ["--jobs", "2"] + DECOMPOSE), count)
    journal = (work / "alone/.kaboum-batch/journal.jsonl").stat().st_size
    print(f"journal {journal / count:.0f} bytes per file; summary " + ", ".join(
        f"{p.name} {p.stat().st_size / count:.0f}" for p in sorted((work / "alone").glob("summary.*"))) + " bytes per file")
    return 0 if same and alone == shared else 1


if __name__ == "__main__":
    sys.exit(main())
