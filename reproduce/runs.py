"""Runs of bmesh-decimate and hausdorff-eval, each kept in a folder named after all it depends on."""

import concurrent.futures
import dataclasses
import functools
import hashlib
import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import threading
import time

THESIS_COSTS = ("planes", "planes-adapted", "planes-diagonal", "triangles")
OURS = "distance"
FILES = ("result.ply", "decimate.json", "distance.json")  # of a run
RECORD = "run.json"  # written last: what the run depends on, and the hashes of its files, or why it has no result


@dataclasses.dataclass(frozen=True)
class Run:
    """One decimation. Of `vertices` and `epsilon` (percent of the diagonal) one is given."""
    model: object
    direction: str
    cost: str
    vertices: int = 0
    epsilon: float = 0
    effort: str = ""  # "": that of the cost
    sharp_angle: int = 0  # degrees; 0: the default

    def options(self):
        # The thesis contracts and does nothing else; our cost is for tightness.
        effort = self.effort or ("fast" if self.cost in THESIS_COSTS else "normal")
        goal = ["--vertices", str(self.vertices)] if self.vertices else ["--epsilon",
                                                                         f"{self.epsilon:g}%"]
        sharp = ["--sharp-angle", str(self.sharp_angle)] if self.sharp_angle else []
        return ["--direction", self.direction, "--cost", self.cost, "--effort", effort, *sharp, *goal, "--drop-sheets",
                "--holes", "keep"]

    def title(self):
        goal = f"{self.vertices}" if self.vertices else f"{self.epsilon:g}pc"
        more = [self.effort] * bool(self.effort) + [f"sharp{self.sharp_angle}"] * bool(self.sharp_angle)
        return "-".join([self.model.name, self.direction, self.cost, *more, goal])


class Failure(Exception):
    """A run that gave no result, now or when it was made (`kept`)."""

    def __init__(self, why, kept=False):
        super().__init__(why)
        self.kept = kept


@functools.lru_cache(maxsize=None)
def sha256(path):
    return hash_of(path)


def hash_of(path):
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def write_json(path, value):
    temporary = path.with_suffix(".part")
    temporary.write_text(json.dumps(value, indent=1) + "\n", encoding="utf-8")
    os.replace(temporary, path)


class Runner:
    """Runs each Run once; results stay in `folder` between calls of the script."""

    def __init__(self, programs, folder, jobs=1, limit=600, retry=False):
        """@param retry  runs that gave no result before are made again"""
        self.programs, self.folder, self.jobs, self.limit, self.retry = pathlib.Path(programs), folder, jobs, limit, retry
        self.results, self.failures = {}, {}
        self.spent = [0, 0]  # user and wall seconds of the calls of a section (calls.py), those that were kept among them
        self.executed, self.kept = 0, 0
        self.called = [0, 0]  # calls made now, and those that were kept (calls.py)
        self._lock = threading.Lock()

    def run_all(self, runs):
        """Fills `results` (Run -> dict) and `failures` (Run -> text)."""
        runs = [run for run in dict.fromkeys(runs)
                if run not in self.results and run not in self.failures]
        done, start = 0, time.monotonic()
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            futures = {pool.submit(self._one, run): run for run in runs}
            try:
                for future in concurrent.futures.as_completed(futures):
                    run, done = futures[future], done + 1
                    try:
                        self.results[run], kept = future.result()
                    except Failure as failure:
                        self.failures[run], kept = str(failure), failure.kept
                    self.executed, self.kept = self.executed + (not kept), self.kept + kept
                    if not kept:
                        self._say(f"[{done}/{len(runs)}, {(time.monotonic() - start) / 60:.0f} min] {run.title()}: "
                                  f"{self._summary(run)}")
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                raise

    def _summary(self, run):
        if run in self.failures:
            return self.failures[run]
        row = self.results[run]
        return (f"{row['vertices']} vertices, {row['hausdorff']:.4f} % of the diagonal, "
                f"{row['user_seconds']:.1f} s")

    @staticmethod
    def _say(text):
        print(text, file=sys.stderr, flush=True)

    def _one(self, run):
        """The row of a run, and whether its files were there already."""
        depends = {"input": sha256(run.model.path), "options": run.options(),
                   "programs": [sha256(self.programs / name)
                                for name in ("bmesh-decimate", "hausdorff-eval")]}
        key = hashlib.sha256(json.dumps(depends, sort_keys=True).encode()).hexdigest()
        folder = self.folder / f"{run.title()}-{key[:12]}"
        if (why := _why_none(folder, key, self.limit)) and not self.retry:
            raise Failure(why, kept=True)
        kept = _is_complete(folder, key)
        if not kept:
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
            try:
                self._make(run, folder)
            except Failure as failure:
                write_json(folder / RECORD, {"key": key, "depends": depends, "limit": self.limit, "failure": str(failure)})
                raise
            write_json(folder / RECORD, {"key": key, "depends": depends,
                                         "files": {name: hash_of(folder / name) for name in FILES}})
        return _row(run, folder), kept

    def _make(self, run, folder):
        """Decimates and measures. @raises Failure"""
        code = self._call("bmesh-decimate", run.model.path, "-o", folder / "result.ply", *run.options(),
                          "--report", folder / "decimate.json")
        if not (folder / "decimate.json").exists():
            raise Failure(f"bmesh-decimate gave no result (exit code {code})")
        original = self._original(run.model, folder / "decimate.json")
        # 7: an interval stayed wider than wished; it holds all the same.
        self._call("hausdorff-eval", original, folder / "result.ply", "--report", folder / "distance.json",
                   valid=(0, 7))

    def _original(self, model, report):
        """The mesh to measure against: what was simplified, which is the file without walls between touching
        bodies and without sheets."""
        changes = json.loads(report.read_text(encoding="utf-8"))["preparation"]
        if not any(changes[key] for key in ("cancelled_walls", "dropped_sheets", "dropped_copies")):
            return model.path
        mesh = self.folder / f"prepared-{model.name}-{sha256(model.path)[:12]}.ply"
        with self._lock:
            if not mesh.exists():
                part = mesh.with_name(f"part-{mesh.name}")
                self._call("bmesh-decimate", model.path, "-o", part, "--drop-sheets", "--holes", "keep",
                           "--precision", "double", "--vertices", 10 ** 9)
                os.replace(part, mesh)
        return mesh

    def _call(self, program, *arguments, valid=(0, 1)):
        """The exit code. @raises Failure if it is not valid, and on more CPU time than allowed."""
        command = [str(self.programs / program), *map(str, arguments), "--threads", "1", "--quiet"]
        limit = (self.limit, self.limit + 5)
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                              check=False,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, limit))
        if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
            raise Failure(f"{program} was stopped (CPU limit {self.limit} s, or out of memory)")
        if done.returncode not in valid:
            lines = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
            raise Failure(lines[-1])
        return done.returncode


def _why_none(folder, key, limit):
    """Why a run of the same key gave no result, if it was given as much time."""
    try:
        record = json.loads((folder / RECORD).read_text(encoding="utf-8"))
        return record["failure"] if record["key"] == key and record["limit"] >= limit else ""
    except (OSError, ValueError, KeyError, TypeError):
        return ""


def _is_complete(folder, key):
    """Whether the folder holds the undamaged files of a run."""
    try:
        record = json.loads((folder / RECORD).read_text(encoding="utf-8"))
        return record["key"] == key and all(record["files"][name] == hash_of(folder / name) for name in FILES)
    except (OSError, ValueError, KeyError, TypeError):
        return False


def _row(run, folder):
    """What the report and results.csv say of a run; distances in percent of the diagonal."""
    report = json.loads((folder / "decimate.json").read_text(encoding="utf-8"))
    distance = json.loads((folder / "distance.json").read_text(encoding="utf-8"))
    diagonal = report["distance"]["bbox_diagonal"]
    percent = 100 / diagonal
    there, back = distance["a_to_b"], distance["b_to_a"]
    row = {
        "model": run.model.name, "file": run.model.path.name, "sha256": report["input"]["sha256"],
        "direction": run.direction, "cost": run.cost, "effort": report["options"]["effort"],
        "sharp_angle": run.sharp_angle or "",
        "target_vertices": run.vertices or "", "target_epsilon": run.epsilon or "",
        "vertices_in": report["input"]["vertices"], "closed": report["input"]["closed"],
        "dropped_sheets": report["preparation"]["dropped_sheets"],
        "vertices": report["output"]["vertices"], "triangles": report["output"]["triangles"],
        "stop": report["stop"], "diagonal": diagonal,
        "o2a_mean": percent * there["mean"], "o2a_max": percent * there["max_upper"],
        "a2o_mean": percent * back["mean"], "a2o_max": percent * back["max_upper"],
        "user_seconds": report["resources"]["user_seconds_decimating"],
        "peak_megabytes": report["resources"]["peak_megabytes"],
        "version": report["version"],
        "hausdorff_lower": percent * distance["hausdorff_lower"],
        "mesh": str(folder / "result.ply"),
    }
    row["hausdorff"] = max(row["o2a_max"], row["a2o_max"])
    row["mean"] = max(row["o2a_mean"], row["a2o_mean"])
    return row
