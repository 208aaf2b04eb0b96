"""The programs of an installed package, as its entry points: each hands over to the program of its name in kaboum/bin.

The process becomes the program, so that exit codes, signals and standard streams are the program's own.
"""

import functools
import os
import pathlib
import sys

FOLDER = pathlib.Path(__file__).resolve().parent / "bin"


def _become(program):
    try:
        os.execv(FOLDER / program, [program, *sys.argv[1:]])
    except OSError as error:
        print(f"{program}: {FOLDER / program} cannot be run: {error.strerror}; install kaboum again", file=sys.stderr)
        sys.exit(6)


def __getattr__(name):
    program = name.replace("_", "-")
    if name.startswith("_") or not (FOLDER / program).is_file():
        raise AttributeError(f"kaboum has no program '{program}'")
    return functools.partial(_become, program)
