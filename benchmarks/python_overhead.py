#!/usr/bin/env python3
"""CPU time of kaboum.decimate from NumPy arrays beside that of bmesh-decimate on a file with the same mesh.

usage: python_overhead.py BIN [N [ROUNDS]]    (about N vertices; kaboum on PYTHONPATH)
"""
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

import numpy as np

import kaboum


def torus(n):
    across = int((n / 2) ** 0.5)
    around = 2 * across
    u, v = np.meshgrid(np.arange(around) * 2 * np.pi / around, np.arange(across) * 2 * np.pi / across, indexing="ij")
    ring = 1 + (0.3 + 0.02 * np.sin(9 * u)) * np.cos(v)
    vertices = np.stack([ring * np.cos(u), ring * np.sin(u), 0.3 * np.sin(v)], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    at = lambda i, j: (i % around * across + j % across).ravel()
    a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
    return vertices, np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)])


def cpu(who):
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


def main():
    binary = pathlib.Path(sys.argv[1])
    n, rounds = (int(sys.argv[2]) if len(sys.argv) > 2 else 100_000), (int(sys.argv[3]) if len(sys.argv) > 3 else 3)
    vertices, faces = torus(n)
    with tempfile.TemporaryDirectory() as folder:
        kaboum.write((vertices, faces), f"{folder}/in.ply")
        tool, module = [], []
        for _ in range(rounds):
            before = cpu(resource.RUSAGE_CHILDREN)
            subprocess.run([binary / "bmesh-decimate", f"{folder}/in.ply", "-o", f"{folder}/out.ply", "--ratio", "0.05", "--cost",
                            "planes", "--effort", "fast", "--quiet", "--threads", "1"], check=True)
            tool.append(cpu(resource.RUSAGE_CHILDREN) - before)
            before = cpu(resource.RUSAGE_SELF)
            made = kaboum.decimate((vertices, faces), ratio=0.05, cost="planes", effort="fast", threads=1)
            module.append(cpu(resource.RUSAGE_SELF) - before)
        same = made.bytes == pathlib.Path(folder, "out.ply").read_bytes()
    print(f"{len(vertices)} vertices: program {min(tool):.3f} s, module {min(module):.3f} s of CPU "
          f"({100 * (min(module) / min(tool) - 1):+.1f} %), {'same' if same else 'OTHER'} bytes")


main()
