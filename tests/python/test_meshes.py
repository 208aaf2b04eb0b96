"""Meshes in and out: arrays, objects that look like meshes, files, errors."""

import fractions
import os
import pathlib
import re
import subprocess
import types

import numpy as np
import pytest

import kaboum
from conftest import cube, signed_volume, torus


def test_arrays_are_views_that_cannot_be_written(box):
    mesh = kaboum.Mesh(*box)
    first, second = mesh.vertices, mesh.vertices
    assert first.dtype == np.float64 and mesh.faces.dtype == np.uint32
    assert first.ctypes.data == second.ctypes.data and not first.flags.owndata
    with pytest.raises(ValueError):
        first[0, 0] = 5
    del mesh
    np.testing.assert_array_equal(first, box[0])  # the array keeps what it looks into


@pytest.mark.parametrize("vertices", [np.float32, np.float64, list])
@pytest.mark.parametrize("faces", [np.int32, np.int64, np.uint32, np.uint64, np.int8, list])
def test_dtypes(box, vertices, faces):
    convert = lambda a, t: a.tolist() if t is list else a.astype(t)
    mesh = kaboum.Mesh(convert(box[0], vertices), convert(box[1], faces))
    np.testing.assert_array_equal(mesh.vertices, box[0])
    np.testing.assert_array_equal(mesh.faces, box[1])


@pytest.mark.parametrize("other", [0.5, 1])
def test_whole_numbers_in_lists_are_not_rounded(other):
    """Beside a number with a fraction, NumPy makes float64 of them without a word."""
    rows = [[0, 0, other], [1, 0, 2**53 + 1], [0, 1, 0]]
    with pytest.raises(kaboum.Error, match=re.escape(f"vertices[1, 2] is {2**53 + 1}, which is no float64")):
        kaboum.Mesh(rows, [[0, 1, 2]])
    rows[1][2] = 2**53
    assert kaboum.Mesh(rows, [[0, 1, 2]]).vertices[1, 2] == 2**53
    with pytest.raises(kaboum.Error, match=f"{2**53 + 1} is no float64"):
        kaboum.decompose(cube(), epsilon=2**53 + 1)
    with pytest.raises(kaboum.Error, match="is no float64"):
        kaboum.decompose(cube(), epsilon=np.longdouble(1) + np.longdouble(2) ** -60)


@pytest.mark.parametrize("number, ok", [
    (np.int64(2**53), True),
    (np.int64(2**53 + 1), False),
    (np.int64(2**63 - 1), False),
    (np.int64(-2**63), True),
    (np.uint64(2**64 - 1), False),
    (np.uint64(2**63), True),
    (np.longdouble(0.5), True),
    (np.longdouble(1) + np.longdouble(2) ** -60, False),
    (np.longdouble("1e400"), False),
    (fractions.Fraction(3, 8), True),
    (fractions.Fraction(1, 3), False),
    (2**70, True),
    (2**70 + 1, False),
    (2**53 + 1, False),
    (np.float16(0.25), True),
    (1j, False),
    ("0.1", False),
])
def test_numbers_are_never_rounded(box, number, ok):
    vertices = [[0, 0, 0], [1, 0, number], [0, 1, 0]]
    if isinstance(number, np.generic):
        vertices = np.array(vertices, dtype=number.dtype)
        vertices[1, 2] = number
    if ok:
        assert kaboum.Mesh(vertices, [[0, 1, 2]]).vertices[1, 2] == number
        return
    with pytest.raises(kaboum.Error) as error:
        kaboum.Mesh(vertices, [[0, 1, 2]])
    assert error.value.code == "invalid_argument"
    if not isinstance(number, (str, complex)):
        assert "vertices[1, 2] is " + str(number) in str(error.value)


def test_layouts(box):
    wide = np.zeros((8, 6))
    wide[:, ::2] = box[0]
    assert signed_volume(kaboum.Mesh(wide[:, ::2], np.asfortranarray(box[1])).vertices, box[1]) == 1


def test_what_looks_like_a_mesh_is_one(box):
    like = types.SimpleNamespace(vertices=box[0], faces=box[1])
    for mesh in (like, box, list(box), kaboum.Mesh(*box), kaboum.prepare(box)):
        assert kaboum.hausdorff(mesh, box, samples=2).upper < 1e-12


@pytest.mark.parametrize("faces, code", [
    (np.array([[0, 1, 8]]), "invalid_input"),
    (np.array([[0, 1, -1]]), "invalid_input"),
    (np.array([[0, 1, 2**63]], np.uint64), "invalid_input"),
    (np.array([[0.0, 1, 2]]), "invalid_argument"),
    (np.array([[0, 1, 2, 3]]), "invalid_argument"),
    (np.array([0, 1, 2]), "invalid_argument"),
    ("abc", "invalid_argument"),
    (None, "invalid_argument"),
])
def test_faces_that_are_none(box, faces, code):
    with pytest.raises(kaboum.Error) as error:
        kaboum.Mesh(box[0], faces)
    assert error.value.code == code


def test_vertices_that_are_none(box):
    for vertices in (box[0][:, :2], box[0].ravel(), "abc", [[None] * 3], object()):
        with pytest.raises(kaboum.Error):
            kaboum.Mesh(vertices, box[1])
    with pytest.raises(kaboum.Error) as error:
        broken = box[0].copy()
        broken[3, 1] = np.nan
        kaboum.prepare((broken, box[1]))
    assert error.value.code == "invalid_input"


def test_not_a_mesh():
    with pytest.raises(kaboum.Error, match="int"):
        kaboum.prepare(5)


@pytest.mark.parametrize("name", ["m.ply", "m.obj", "m.off", "m.stl"])
def test_files_keep_coordinates(ring, tmp_path, name):
    vertices = ring[0].astype(np.float32).astype(float) if name == "m.stl" else ring[0]
    kaboum.write((vertices, ring[1]), tmp_path / name)
    back = kaboum.read(tmp_path / name)
    assert back.source.endswith(name) and len(back.sha256) == 64
    np.testing.assert_array_equal(back.vertices[back.faces], vertices[ring[1]])


def test_stl_cannot_hold_doubles(ring, tmp_path):
    with pytest.raises(kaboum.Error) as error:
        kaboum.write(ring, tmp_path / "m.stl")
    assert error.value.code == "output_failed" and error.value.exit_code == 4
    assert not (tmp_path / "m.stl").exists()


def test_errors_name_file_and_remedy(tmp_path):
    broken = tmp_path / "broken.obj"
    broken.write_text("v 0 0 0\nf 1 2 3\n")
    with pytest.raises(kaboum.Error, match="broken.obj") as error:
        kaboum.read(broken)
    assert error.value.code == "invalid_input"
    with pytest.raises(kaboum.Error, match="format"):
        kaboum.read(broken, format="bja")
    with pytest.raises(kaboum.Error):
        kaboum.read(tmp_path / "absent.ply")


def test_prepare_says_what_it_did(box):
    open_box = (box[0], box[1][:-2])
    prepared = kaboum.prepare(open_box)
    assert prepared.closed and prepared.holes == 1 and prepared.notes
    assert not kaboum.prepare(open_box, holes="keep").closed
    with pytest.raises(kaboum.Error):
        kaboum.prepare(open_box, holes="refuse")
    inside_out = kaboum.prepare((box[0], box[1][:, ::-1]))
    assert signed_volume(inside_out.vertices, inside_out.faces) == pytest.approx(1)
    assert inside_out.turned_triangles == 12


PROGRAMS = pathlib.Path(os.environ["KABOUM_BIN"])


def program(name, *arguments, code=0):
    done = subprocess.run([PROGRAMS / name, *map(str, arguments)], check=False, capture_output=True, text=True)
    assert done.returncode == code, done.stderr


def test_wrap_is_the_programs(tmp_path):
    """A soup of triangles that bound nothing is held by a closed mesh, the one that mesh-prepare writes."""
    rng = np.random.default_rng(3)
    soup = rng.uniform(0, 1, (8, 1, 3)) + rng.uniform(-0.3, 0.3, (8, 3, 3))
    vertices, faces = soup.reshape(-1, 3), np.arange(24).reshape(-1, 3)
    kaboum.write((vertices, faces), tmp_path / "soup.off")
    made = kaboum.wrap(tmp_path / "soup.off", offset="1%", seal="5%")
    program("mesh-prepare", tmp_path / "soup.off", "-o", tmp_path / "wrap.stl", "--prepare", "wrap", "--offset", "1%", "--seal", "5%")
    theirs = kaboum.read(tmp_path / "wrap.stl")
    assert np.array_equal(np.sort(made.vertices[made.faces].reshape(-1, 9), axis=0),
                          np.sort(theirs.vertices[theirs.faces].reshape(-1, 9), axis=0))
    assert kaboum.verify_mesh((vertices, faces), made, claims="surface")
    assert 0 < made.distance[0] <= made.distance[1] and made.report["offset"] > 0
    with pytest.raises(kaboum.Error, match="beyond the triangles"):
        kaboum.wrap((vertices, faces), offset="1%", seal="30%", epsilon="1e-6%")
    with pytest.raises(kaboum.Error, match="float"):
        kaboum.wrap((vertices, faces), precision="half")

    def stop(_):
        raise KeyError("enough")

    with pytest.raises(KeyError):
        kaboum.wrap((vertices, faces), progress=stop)


def test_replay_of_a_log(tmp_path, ring):
    kaboum.write(ring, tmp_path / "ring.off")
    program("bmesh-decimate", tmp_path / "ring.off", "-o", tmp_path / "outer.ply", "--ratio", "0.5", "--log", tmp_path / "outer.log")
    verdict = kaboum.replay(tmp_path / "ring.off", tmp_path / "outer.log", tmp_path / "outer.ply")
    assert verdict and verdict.claims["replay"]["steps"] > 0 and verdict.claims["replay"]["direction"] == "outer"
    result = kaboum.read(tmp_path / "outer.ply")
    moved = result.vertices.copy()
    moved[0, 0] += 0.001
    refuted = kaboum.replay(tmp_path / "ring.off", tmp_path / "outer.log", (moved, result.faces))
    assert refuted.answer == "refuted" and refuted.claims["replay"]["reason"]
    kaboum.write(result, tmp_path / "other.off")
    with pytest.raises(kaboum.Error, match="another file"):
        kaboum.replay(tmp_path / "other.off", tmp_path / "outer.log", result)


def test_cache(tmp_path, bracket):
    folder = pathlib.Path(os.environ["KABOUM_CACHE"])
    assert kaboum.cache_entries() == []
    assert not kaboum.decompose(bracket, epsilon="5%").cached and kaboum.decompose(bracket, epsilon="5%").cached
    entries = kaboum.cache_entries(verify=True)
    assert entries and all(e["flaw"] == "" and e["bytes"] > 0 and e["kind"].startswith("KABOUM") for e in entries)
    one = next(f for f in folder.rglob("*") if f.is_file() and f.stem == entries[0]["entry"])
    one.write_bytes(one.read_bytes()[:-1] + b"?")
    assert any(e["flaw"] for e in kaboum.cache_entries(folder=folder, verify=True))
    assert kaboum.prune_cache(size=0)["removed"] == len(entries) and kaboum.cache_entries() == []


def test_files_of_sets_are_sets(tmp_path):
    part, bodies = torus(32, 16), tmp_path / "set.glb"
    made = kaboum.decompose(part, epsilon="5%", effort="fast")
    made.write(bodies)
    kaboum.write(part, tmp_path / "part.ply")
    by_file, by_value = kaboum.hausdorff(part, bodies), kaboum.hausdorff(part, kaboum.read_set(bodies))
    assert (by_file.lower, by_file.upper) == (by_value.lower, by_value.upper)
    with pytest.raises(kaboum.Error, match="verify_cover"):
        kaboum.verify_mesh(part, bodies)
    inner = kaboum.decompose(part, epsilon="5%", direction="inner", effort="fast")
    inner.write(tmp_path / "inner.glb")
    for set_ in (tmp_path / "inner.glb", inner):
        assert kaboum.verify_mesh(part, set_, relation="inner", prepare=True, epsilon="5%")


TETRAHEDRON_AC3D = """AC3Db
MATERIAL "m" rgb 1 1 1  amb 1 1 1  emis 0 0 0  spec 0 0 0  shi 10  trans 0
OBJECT world
kids 1
OBJECT poly
numvert 4
0 0 0
1 0 0
0 1 0
0 0 1
numsurf 4
""" + "".join(f"SURF 0x0\nmat 0\nrefs 3\n{a} 0 0\n{b} 0 0\n{c} 0 0\n" for a, b, c in [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]) + "kids 0\n"


def test_what_only_assimp_reads_is_asked_for(tmp_path):
    file = tmp_path / "tetrahedron.ac"
    file.write_text(TETRAHEDRON_AC3D)
    for refused in (lambda: kaboum.read(file), lambda: kaboum.decimate(file, ratio=0.5)):
        with pytest.raises(kaboum.Error, match=r"tetrahedron\.ac: .*importer='assimp'") as caught:
            refused()
        assert caught.value.code == "invalid_input"
    for keywords, says in [({"importer": "magic"}, "'assimp', not 'magic'"), ({"importer": "assimp", "format": "obj"}, "leave format out")]:
        with pytest.raises(kaboum.Error, match=says):
            kaboum.read(file, **keywords)
    try:
        mesh = kaboum.read(file, importer="assimp")
    except kaboum.Error as error:
        assert error.code == "not_built"
        return
    assert {tuple(p) for p in mesh.vertices} == {(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)} and len(mesh.faces) == 4
    assert any(note.startswith("Warning: assimp") for note in mesh.notes)
    verdict = kaboum.verify_mesh(mesh, mesh, relation="outer")
    assert verdict and any(note.startswith("Warning: assimp") for note in verdict.notes)
    result = kaboum.decimate(mesh, vertices=4)
    assert any(note.startswith("Warning: assimp") for note in result.notes)
