"""Calls of programs whose results are kept beside a key of what they depend on."""

import dataclasses
import hashlib
import json
import os
import subprocess
import sys

from runs import sha256

LIMIT = 600  # seconds of a program


@dataclasses.dataclass(frozen=True)
class Step:
    """A call that failed, as the report lists it."""
    name: str

    def title(self):
        return self.name


class Calls:
    """Runs programs; a result is kept while the programs, inputs and arguments stay the same."""

    def __init__(self, context, folder):
        self.programs = context.runner.programs
        self.folder = context.folder / folder
        self.folder.mkdir(parents=True, exist_ok=True)
        self.failures = context.runner.failures

    def __call__(self, name, program, arguments, inputs, results, codes=(0,)):
        """@return the exit code; None when the program failed, which is noted."""
        key = hashlib.sha256(json.dumps(
            [sha256(program), [str(a) for a in arguments], [sha256(p) for p in inputs]]).encode()).hexdigest()
        record = self.folder / f"{name}.json"
        try:
            kept = json.loads(record.read_text())
            if kept["key"] == key and all((self.folder / r).is_file() for r in results):
                return kept["code"]
        except (OSError, ValueError, KeyError, TypeError):
            pass
        environment = dict(os.environ, KABOUM_CACHE=str(self.folder / "cache"),
                           PATH=f"{self.programs}{os.pathsep}{os.environ.get('PATH', '')}")
        print(f"{name} ...", file=sys.stderr)
        try:
            done = subprocess.run([program, *map(str, arguments)], cwd=self.folder, env=environment, timeout=LIMIT,
                                  capture_output=True, text=True, check=False)
            why = (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
            code = done.returncode
        except subprocess.TimeoutExpired:
            code, why = None, f"more than {LIMIT} s"
        if code not in codes:
            self.failures[Step(name)] = why
            return None
        record.write_text(json.dumps({"key": key, "code": code}))
        return code

    def report(self, name):
        return json.loads((self.folder / name).read_text())
