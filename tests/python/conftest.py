"""What the tests share: shapes with known answers, the project's meshes and robots."""

import os
import pathlib

import numpy as np
import pytest

import kaboum

SOURCE = pathlib.Path(os.environ["KABOUM_SOURCE"])


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("KABOUM_CACHE", str(tmp_path / "cache"))


def cube(size=1.0):
    """Vertices and faces of [0, size]^3, normals outwards."""
    vertices = np.array([[x, y, z] for x in (0, size) for y in (0, size) for z in (0, size)], float)
    faces = np.array(
        [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
         [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])
    return vertices, faces


def torus(around=48, across=24, radius=1.0, tube=0.3):
    """Vertices and faces of a torus, normals outwards."""
    u, v = np.meshgrid(np.arange(around) * 2 * np.pi / around, np.arange(across) * 2 * np.pi / across,
                       indexing="ij")
    ring = radius + tube * np.cos(v)
    vertices = np.stack([ring * np.cos(u), ring * np.sin(u), tube * np.sin(v)], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = i * across + j, (i + 1) % around * across + j
    c, d = (i + 1) % around * across + (j + 1) % across, i * across + (j + 1) % across
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    return vertices, faces


@pytest.fixture
def box():
    return cube()


@pytest.fixture
def ring():
    return torus(32, 16)


@pytest.fixture
def bracket():
    return SOURCE / "meshes" / "bracket.obj"


ARM = """<robot name="arm">
  <link name="base"><collision><geometry><box size="0.2 0.2 0.1"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0 0 0.25"/><geometry><box size="0.1 0.1 0.5"/></geometry></collision></link>
  <link name="tool"><collision><geometry><mesh filename="tool.ply"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="slide" type="prismatic"><parent link="upper"/><child link="tool"/><origin xyz="0 0 0.5"/>
    <axis xyz="0 0 1"/><limit lower="0" upper="0.3" effort="1" velocity="1"/></joint>
</robot>
"""


@pytest.fixture
def arm(tmp_path):
    kaboum.write(torus(16, 8, 0.1, 0.03), tmp_path / "tool.ply")
    path = tmp_path / "arm.urdf"
    path.write_text(ARM)
    return path


def signed_volume(vertices, faces):
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6
