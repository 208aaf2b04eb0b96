"""The worked examples run, and do what they say."""

import os
import subprocess
import sys

import kaboum
from conftest import SOURCE, torus

EXAMPLES = SOURCE / "examples" / "python"


def run(name, *arguments):
    return subprocess.run([sys.executable, EXAMPLES / name, *map(str, arguments)], check=True, capture_output=True,
                          text=True, env=os.environ).stdout


def test_vertices_fall_with_distance(tmp_path):
    kaboum.write(torus(16, 8), tmp_path / "t.ply")
    out = run("vertices_over_distance.py", tmp_path / "t.ply", tmp_path / "t.svg")
    vertices = [int(line.split()[2]) for line in out.splitlines()]
    assert len(vertices) == 6 and vertices == sorted(vertices, reverse=True) and vertices[0] > vertices[-1]
    assert "<svg" in (tmp_path / "t.svg").read_text()


def test_bodies_instead_of_vhacd(tmp_path):
    kaboum.write(torus(16, 8), tmp_path / "t.ply")
    out = run("replace_vhacd.py", tmp_path / "t.ply", tmp_path / "bodies")
    assert out.endswith("verified\n")
    assert len(kaboum.read_set(tmp_path / "bodies")) == int(out.split()[0])
