"""Meshes of trimesh, in and out; skipped where trimesh is not installed (scripts/wheel installs it)."""

import numpy as np
import pytest

import kaboum
from conftest import cube, signed_volume, torus

trimesh = pytest.importorskip("trimesh")


def test_a_trimesh_is_a_mesh(ring):
    solid = trimesh.Trimesh(*ring, process=False)
    outer = kaboum.decimate(solid, vertices=60)
    assert outer.bytes == kaboum.decimate(ring, vertices=60).bytes
    assert kaboum.verify_mesh(solid, outer)
    bodies = kaboum.decompose(solid, epsilon="5%")
    assert kaboum.verify_cover(solid, bodies, epsilon="5%")
    assert kaboum.hausdorff(solid, outer).lower > 0


def test_the_same_numbers_come_back(ring):
    outer = kaboum.decimate(ring, vertices=60)
    out = kaboum.to_trimesh(outer)
    assert isinstance(out, trimesh.Trimesh) and out.is_watertight and out.is_winding_consistent
    assert np.array_equal(out.vertices, outer.vertices) and np.array_equal(out.faces, outer.faces)
    assert np.isclose(out.volume, signed_volume(outer.vertices, outer.faces))
    again = kaboum.from_trimesh(out)
    assert np.array_equal(again.vertices, outer.vertices) and np.array_equal(again.faces, outer.faces)
    before = outer.vertices.copy()
    out.vertices *= 2  # a copy, which may be changed
    assert np.array_equal(outer.vertices, before)


def test_vertices_that_are_equal_or_unused_stay():
    vertices = np.vstack([cube()[0], cube()[0][:1], [[5.0, 5, 5]]])
    out = kaboum.to_trimesh((vertices, cube()[1]))
    assert np.array_equal(out.vertices, vertices)


def test_bodies_are_meshes_each(ring):
    bodies = kaboum.decompose(ring, epsilon="5%")
    meshes = kaboum.to_trimesh(bodies)
    assert len(meshes) == len(bodies) > 1
    for mesh, body in zip(meshes, bodies.bodies):
        assert mesh.is_watertight and np.array_equal(mesh.vertices, body.vertices)
        heights = np.einsum("fk,fvk->fv", mesh.face_normals, mesh.vertices[None] - mesh.triangles[:, :1])
        assert heights.max() < 1e-6  # convex
    assert kaboum.verify_cover(ring, kaboum.ConvexSet(meshes))


def test_round_bodies_are_refused():
    ball = kaboum.ConvexSet([np.zeros(3)], radii=0.5)
    with pytest.raises(kaboum.Error, match="has a radius") as caught:
        kaboum.to_trimesh(ball)
    assert caught.value.code == "invalid_argument"


@pytest.mark.parametrize("what", ["file.stl", [cube()], 5, None])
def test_what_is_no_mesh_is_refused(what):
    with pytest.raises(kaboum.Error) as caught:
        kaboum.to_trimesh(what)
    assert caught.value.code == "invalid_argument"
    with pytest.raises(kaboum.Error) as caught:
        kaboum.from_trimesh(what)
    assert caught.value.code == "invalid_argument"


def test_units_go_along():
    solid = trimesh.Trimesh(*cube(100.0), process=False)
    with pytest.raises(kaboum.Error):
        kaboum.decimate(kaboum.from_trimesh(solid), epsilon="5mm")  # of no unit
    for stated, unit in (("millimeters", "mm"), ("meters", "m"), ("inches", "in")):
        solid.units = stated
        mesh = kaboum.from_trimesh(solid)
        assert mesh.unit == unit and kaboum.to_trimesh(mesh).units == stated
        kaboum.decimate(mesh, epsilon="5mm")
    solid.units = "furlongs"
    mesh = kaboum.from_trimesh(solid)
    assert mesh.unit == "" and "furlongs" in mesh.notes[0]
    assert kaboum.to_trimesh(mesh).units is None


def test_bodies_keep_the_unit():
    solid = trimesh.Trimesh(*cube(100.0), process=False)
    solid.units = "mm"
    bodies = kaboum.decompose(kaboum.from_trimesh(solid), epsilon="1mm")
    assert [kaboum.from_trimesh(body).unit for body in kaboum.to_trimesh(bodies)] == ["mm"] * len(bodies)


@pytest.mark.parametrize("other, refused", [("mm", True), (None, True), ("m", False)])
def test_scenes_of_two_units_are_refused(other, refused):
    scene = trimesh.Scene()
    for name, unit in (("one", "meters"), ("two", other)):
        solid = trimesh.Trimesh(*cube(), process=False)
        solid.units = unit
        scene.add_geometry(solid, geom_name=name, transform=np.eye(4))
    if not refused:
        assert kaboum.from_trimesh(scene).unit == "m"
        return
    with pytest.raises(kaboum.Error, match="'two' states .*unit.*, 'one' the unit 'm'"):
        kaboum.from_trimesh(scene)
    scene.units = "mm"
    assert kaboum.from_trimesh(scene).unit == "mm"


def test_a_scene_is_taken_as_it_stands():
    box = trimesh.Trimesh(*cube(), process=False)
    ring = trimesh.Trimesh(*torus(32, 16), process=False)
    scene = trimesh.Scene()
    scene.add_geometry(ring, geom_name="ring")
    scene.add_geometry(box, geom_name="box", transform=trimesh.transformations.translation_matrix([4, 0, 0]))
    mirror = np.diag([-2.0, 1, 1, 1])
    mirror[0, 3] = -4
    scene.add_geometry(box, node_name="mirrored", geom_name="box", transform=mirror)
    mesh = kaboum.from_trimesh(scene)
    assert any("rounded" in note for note in mesh.notes)
    assert len(mesh.faces) == len(ring.faces) + 24
    assert np.isclose(mesh.volume, ring.volume + 1 + 2)  # the mirrored one is no hole
    assert np.allclose(np.sort(mesh.vertices, 0), np.sort(scene.to_geometry().vertices, 0))
    assert kaboum.verify_mesh(mesh, kaboum.decimate(mesh, epsilon="2%"))


def test_a_scene_without_moves_has_the_same_numbers(ring):
    mesh = kaboum.from_trimesh(trimesh.Scene(trimesh.Trimesh(*ring, process=False)))
    assert np.array_equal(mesh.vertices, ring[0]) and np.array_equal(mesh.faces, ring[1]) and not mesh.notes


def test_what_a_scene_has_beside_triangles_is_refused():
    scene = trimesh.Scene(trimesh.Trimesh(*cube(), process=False))
    scene.add_geometry(trimesh.PointCloud(np.zeros((3, 3))), geom_name="points")
    with pytest.raises(kaboum.Error, match="'points' is a PointCloud, which has no triangles"):
        kaboum.from_trimesh(scene)
    with pytest.raises(kaboum.Error, match="no triangles"):
        kaboum.from_trimesh(trimesh.Scene())
    flat = trimesh.Scene()
    flat.add_geometry(trimesh.Trimesh(*cube(), process=False), transform=np.diag([1.0, 1, 0, 1]))
    with pytest.raises(kaboum.Error, match="flattened"):
        kaboum.from_trimesh(flat)


def test_files_that_trimesh_reads_give_the_same(bracket):
    ours, theirs = kaboum.read(bracket), kaboum.from_trimesh(trimesh.load(bracket, process=False))
    assert np.isclose(ours.volume, theirs.volume) and len(ours.faces) == len(theirs.faces)
