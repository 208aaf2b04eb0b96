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

THESIS_COSTS = ("planes", "planes-adapted", "planes-diagonal", "triangles")
OURS = "distance"


@dataclasses.dataclass(frozen=True)
class Run:
    """One decimation. Of `vertices` and `epsilon` (percent of the diagonal) one is given."""
    model: object
    direction: str
    cost: str
    vertices: int = 0
    epsilon: float = 0

    def options(self):
        # The thesis contracts and does nothing else; our cost runs as bmesh-decimate does by default.
        effort = ["--effort", "fast"] if self.cost in THESIS_COSTS else []
        goal = ["--vertices", str(self.vertices)] if self.vertices else ["--epsilon",
                                                                         f"{self.epsilon:g}%"]
        return ["--direction", self.direction, "--cost", self.cost, *effort, *goal, "--drop-sheets"]

    def title(self):
        goal = f"{self.vertices}" if self.vertices else f"{self.epsilon:g}pc"
        return f"{self.model.name}-{self.direction}-{self.cost}-{goal}"


class Failure(Exception):
    """A run that gave no result."""


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

    def __init__(self, programs, folder, jobs=1, limit=600):
        self.programs, self.folder, self.jobs, self.limit = pathlib.Path(programs), folder, jobs, limit
        self.results, self.failures = {}, {}
        self.executed = 0
        self._lock = threading.Lock()

    def run_all(self, runs):
        """Fills `results` (Run -> dict) and `failures` (Run -> text)."""
        runs = [run for run in dict.fromkeys(runs)
                if run not in self.results and run not in self.failures]
        done = 0
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            futures = {pool.submit(self._one, run): run for run in runs}
            try:
                for future in concurrent.futures.as_completed(futures):
                    run, done = futures[future], done + 1
                    try:
                        self.results[run], kept = future.result()
                    except Failure as failure:
                        self.failures[run], kept = str(failure), False
                    if not kept:
                        self._say(f"[{done}/{len(runs)}] {run.title()}: {self._summary(run)}")
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
        """The row of a run, and whether it was there already."""
        depends = {"input": sha256(run.model.path), "options": run.options(),
                   "programs": [sha256(self.programs / name)
                                for name in ("bmesh-decimate", "hausdorff-eval")]}
        key = hashlib.sha256(json.dumps(depends, sort_keys=True).encode()).hexdigest()
        folder = self.folder / f"{run.title()}-{key[:12]}"
        record, mesh = folder / "run.json", folder / "result.ply"
        kept = self._kept(record, mesh, key)
        if kept:
            return kept, True
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        code = self._call("bmesh-decimate", run.model.path, "-o", mesh, *run.options(), "--report",
                          folder / "decimate.json")
        self._call("hausdorff-eval", run.model.path, mesh, "--report", folder / "distance.json")
        row = self._row(run, folder, code)
        row["mesh"] = str(mesh)
        write_json(record, {"key": key, "mesh_sha256": hash_of(mesh), "depends": depends, "row": row})
        with self._lock:
            self.executed += 1
        return row, False

    @staticmethod
    def _kept(record, mesh, key):
        try:
            kept = json.loads(record.read_text(encoding="utf-8"))
            if kept["key"] == key and kept["mesh_sha256"] == hash_of(mesh):
                return {**kept["row"], "mesh": str(mesh)}
        except (OSError, ValueError, KeyError, TypeError):
            pass  # absent or damaged: done anew
        return None

    def _call(self, program, *arguments):
        """Exit code, 0 or 1. @raises Failure on others, and on more CPU time than allowed."""
        command = [str(self.programs / program), *map(str, arguments), "--threads", "1", "--quiet"]
        limit = (self.limit, self.limit + 5)
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                              check=False,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, limit))
        if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
            raise Failure(f"{program} was stopped (CPU limit {self.limit} s, or out of memory)")
        if done.returncode not in (0, 1):
            lines = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
            raise Failure(lines[-1])
        return done.returncode

    @staticmethod
    def _row(run, folder, code):
        try:
            report = json.loads((folder / "decimate.json").read_text(encoding="utf-8"))
            distance = json.loads((folder / "distance.json").read_text(encoding="utf-8"))
        except OSError as error:
            raise Failure(f"no result (exit code {code})") from error
        diagonal = report["distance"]["bbox_diagonal"]
        percent = 100 / diagonal
        there, back = distance["a_to_b"], distance["b_to_a"]
        row = {
            "model": run.model.name, "file": run.model.path.name, "sha256": report["input"]["sha256"],
            "direction": run.direction, "cost": run.cost, "effort": report["options"]["effort"],
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
        }
        row["hausdorff"] = max(row["o2a_max"], row["a2o_max"])
        row["mean"] = max(row["o2a_mean"], row["a2o_mean"])
        return row
