"""Calls of programs whose results are kept beside a key of what they depend on."""

import dataclasses
import hashlib
import json
import os
import resource
import signal
import subprocess
import sys
import time

from runs import hash_of, sha256, write_json


@dataclasses.dataclass(frozen=True)
class Step:
    """A call that failed, as the report lists it."""
    name: str

    def title(self):
        return self.name


class Calls:
    """Runs programs; a result is kept while the programs, inputs and arguments stay the same, also that there is none."""

    def __init__(self, context, folder):
        self.programs, self.limit, self.retry = context.runner.programs, context.runner.limit, context.runner.retry
        self.folder = context.folder / folder
        self.folder.mkdir(parents=True, exist_ok=True)
        self.failures, self.spent, self.called = context.runner.failures, context.runner.spent, context.runner.called

    def __call__(self, name, program, arguments, inputs, results, codes=(0,), limit=None):
        """@param limit  CPU seconds of each process of the call, instead of those of all calls
        @return the exit code; None when the program failed, which is noted. Then, and where a code of `codes` means
        so, results are missing, never those of an earlier call."""
        key = hashlib.sha256(json.dumps(
            [sha256(program), [str(a) for a in arguments], [hash_of(p) for p in inputs], limit]).encode()).hexdigest()
        record, seconds = self.folder / f"{name}.json", limit or self.limit
        assert record.name not in results, f"{name}: its result would overwrite its record"
        try:
            kept = json.loads(record.read_text())
            if kept["key"] == key and "failure" in kept and kept["limit"] >= seconds and not self.retry:
                self._spend(kept)
                self.called[1] += 1
                self.failures[Step(name)] = kept["failure"]
                return None
            if kept["key"] == key and kept["files"] == self._hashes(results):
                self._spend(kept)
                self.called[1] += 1
                return kept["code"]
        except (OSError, ValueError, KeyError, TypeError):
            pass
        for stale in (record, *(self.folder / r for r in results)):
            stale.unlink(missing_ok=True)
        # Another build's cached sets are not this one's results.
        decompose = self.programs / "bcd-decompose"
        cache = f"cache-{sha256(decompose)[:12]}" if decompose.is_file() else "cache"
        environment = dict(os.environ, KABOUM_CACHE=str(self.folder / cache), KABOUM_BIN=str(self.programs),
                           PATH=f"{self.programs}{os.pathsep}{os.environ.get('PATH', '')}")
        print(f"{name} ...", end="", file=sys.stderr, flush=True)
        start, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        self.called[0] += 1
        done = subprocess.run([program, *map(str, arguments)], cwd=self.folder, env=environment, capture_output=True,
                              text=True, check=False,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5)))
        print(f" {time.monotonic() - start:.1f} s", file=sys.stderr, flush=True)
        user = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        made = {"key": key, "code": done.returncode, "user_seconds": user, "wall_seconds": time.monotonic() - start}
        self._spend(made)
        if done.returncode not in codes:
            for partial in results:
                (self.folder / partial).unlink(missing_ok=True)
            why = (f"stopped (CPU limit {seconds} s, or out of memory)"
                   if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL) else
                   (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1])
            self.failures[Step(name)] = why
            write_json(record, {**made, "limit": seconds, "failure": why})
            return None
        write_json(record, {**made, "files": self._hashes(results)})
        return done.returncode

    def _spend(self, made):
        """Notes what a call takes, whenever it was made."""
        self.spent[0] += made["user_seconds"]
        self.spent[1] += made.get("wall_seconds", 0)

    def _hashes(self, results):
        """Of the results that are there."""
        return {r: hash_of(self.folder / r) for r in results if (self.folder / r).is_file()}

    def seconds(self, name):
        """User CPU time of a call that succeeded, children included."""
        return json.loads((self.folder / f"{name}.json").read_text())["user_seconds"]

    def report(self, name):
        return json.loads((self.folder / name).read_text())
