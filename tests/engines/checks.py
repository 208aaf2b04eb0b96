"""Checks of a script, each of which is said where it fails."""

import sys

failures = []
sys.stdout.reconfigure(line_buffering=True)


def check(holds, what):
    if not holds:
        failures.append(what)
        print("FAILED:", what)


def exit_code():
    """Says how the checks went. 1 where one failed."""
    print("failed" if failures else "passed", f"({len(failures)} failures)")
    return 1 if failures else 0
