"""Decimation, decomposition, distances: what the tools do, and the same bytes."""

import json
import os
import signal
import subprocess
import threading
import time

import numpy as np
import pytest

import kaboum
from conftest import cube, signed_volume, torus

BIN = os.environ["KABOUM_BIN"]


def test_nothing_is_enclosed_by_nothing():
    solid = (np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]),
             np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]))
    none = np.zeros((0, 3), int)
    for nothing in ((np.zeros((0, 3)), none), (solid[0] * 100, none)):
        for verdict in (kaboum.verify_mesh(nothing, solid), kaboum.verify_cover(nothing, [solid])):
            assert not verdict and verdict.answer == "undefined"
    for faces in ([[0, 1, 2]], [[0, 1, 1]], [[1, 0, 0]], [[1, 1, 1]]):
        out = (np.array([[0.0, 0, 0], [9, 0, 0], [5, 0, 0]]), np.array(faces))
        for verdict in (kaboum.verify_mesh(out, solid), kaboum.verify_cover(out, [solid])):
            assert not verdict and verdict.answer == "refuted"
            assert verdict.claims["surface"]["answer"] == "refuted"
        within = (out[0] / 9, out[1])
        assert kaboum.verify_mesh(within, solid) and kaboum.verify_cover(within, [solid])
        assert kaboum.verify_mesh(within, solid, claims="solid").answer == "undefined"


def test_what_cannot_be_prepared_is_judged_as_it_is():
    """A sheet, whose triangle stands in both orientations."""
    solid = (np.array([[-1.0, -1, -1], [9, -1, -1], [-1, 9, -1], [-1, -1, 9]]),
             np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]))
    sheet = (np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 1]]))
    for verdict in (kaboum.verify_mesh(sheet, solid, prepare=True), kaboum.verify_cover(sheet, [solid], prepare=True)):
        assert verdict and any("judged as it is" in note for note in verdict.notes)
    out = (sheet[0] * 20, sheet[1])
    for verdict in (kaboum.verify_mesh(out, solid, prepare=True), kaboum.verify_cover(out, [solid], prepare=True)):
        assert verdict.answer == "refuted" and verdict.claims["surface"]["answer"] == "refuted"
    with pytest.raises(kaboum.Error, match="sheet"):
        kaboum.verify_mesh(sheet, solid, relation="inner", prepare=True)


def test_outer_and_inner(ring):
    volume = signed_volume(*ring)
    outer = kaboum.decimate(ring, epsilon="2%", verify=True)
    inner = kaboum.decimate(ring, epsilon="2%", direction="inner")
    assert len(inner.vertices) < len(ring[0]) > len(outer.vertices)
    assert signed_volume(inner.vertices, inner.faces) < volume < signed_volume(outer.vertices, outer.faces)
    assert outer.reached and outer.closed and outer.stop == "epsilon"
    assert {c["answer"] for c in outer.claims} == {"verified"}
    assert outer.distances["hausdorff"][1] <= outer.epsilon
    assert kaboum.verify_mesh(ring, outer, epsilon=outer.epsilon)
    assert kaboum.verify_mesh(ring, inner, relation="inner")
    refuted = kaboum.verify_mesh(ring, inner)
    assert not refuted and refuted.answer == "refuted" and refuted.claims["solid"]["depth"] > 0


def test_certificates_have_one_shape(ring):
    results = {
        "outer": [kaboum.decimate(ring, epsilon="2%"), kaboum.decompose(ring, epsilon="5%", effort="fast"), kaboum.wrap(ring)],
        "inner": [kaboum.decimate(ring, epsilon="2%", direction="inner")],
    }
    for direction, made in results.items():
        for result in made:
            certificate = result.certificate
            assert set(certificate) == {"direction", "of", "claims", "distance"}
            assert certificate["direction"] == direction
            assert certificate["claims"] and all(c["answer"] == "verified" and c["basis"] for c in certificate["claims"])
            if certificate["distance"]:
                assert 0 <= certificate["distance"]["lower"] <= certificate["distance"]["upper"]
            if isinstance(result, kaboum.CertifiedSet):
                assert tuple(certificate["distance"].values()) == result.distance


def test_series_is_nested(ring):
    fine, coarse = kaboum.decimate(ring, vertices=[300, 100])
    assert len(fine.vertices) == 300 and len(coarse.vertices) == 100
    assert kaboum.verify_mesh(fine, coarse)


@pytest.mark.parametrize("several", [
    np.array([300, 100]), {300, 100}, (n for n in (300, 100)), {300: 1, 100: 2}.keys(), map(int, "300 100".split())])
def test_any_series_of_numbers_gives_all_results(ring, several):
    assert [len(made.vertices) for made in kaboum.decimate(ring, vertices=several)] == [300, 100]


def test_one_number_gives_one_result(ring):
    for one in (300, np.int64(300), np.array(300)):
        assert len(kaboum.decimate(ring, vertices=one).vertices) == 300
    for series in ([300], np.array([300])):
        assert [len(made.vertices) for made in kaboum.decimate(ring, vertices=series)] == [300]


def test_arrays_in_place_of_numbers_are_refused(ring):
    pair = np.array([3, 4])
    for call, name in ((lambda: kaboum.decimate(ring, vertices=np.array([300.0, 100.0])), "vertices"),
                       (lambda: kaboum.decimate(ring, epsilon=pair), "epsilon"),
                       (lambda: kaboum.decimate(ring, ratio=pair), "ratio"),
                       (lambda: kaboum.decompose(ring, max_bodies=pair), "max_bodies"),
                       (lambda: kaboum.decompose(ring, scale=pair), "scale")):
        with pytest.raises(kaboum.Error, match=name + " must be"):
            call()
    for threads in (pair, 1 << 80, "1"):
        with pytest.raises(TypeError, match="threads must be"):
            kaboum.decimate(ring, vertices=100, threads=threads)


def test_same_bytes_as_the_tool(bracket, tmp_path):
    result = tmp_path / "b.ply"
    subprocess.run([f"{BIN}/bmesh-decimate", bracket, "-o", result, "--vertices", "300"], check=True,
                   capture_output=True)
    made = kaboum.decimate(bracket, vertices=300)
    assert made.bytes == result.read_bytes()
    assert kaboum.decimate(kaboum.prepare(bracket), vertices=300, threads=1).bytes == made.bytes
    made.write(tmp_path / "again.ply")
    assert (tmp_path / "again.ply").read_bytes() == made.bytes
    made.write(tmp_path / "again.stl")
    assert kaboum.hausdorff(tmp_path / "again.stl", made, samples=2).upper < 1e-12


def test_same_container_as_the_tool(bracket, tmp_path):
    result = tmp_path / "b.glb"
    subprocess.run([f"{BIN}/bcd-decompose", bracket, "-o", result, "--epsilon", "5%", "--effort", "fast", "--no-cache"], check=True,
                   capture_output=True)
    made = kaboum.decompose(bracket, epsilon="5%", effort="fast")
    assert made.bytes == result.read_bytes() and not made.cached
    again = kaboum.decompose(bracket, epsilon="5%", effort="fast")
    assert again.cached and again.bytes == made.bytes
    assert made.report["bodies"] == len(made) == len(made.bodies)
    assert kaboum.verify_cover(bracket, made, epsilon=made.distance[1])
    assert kaboum.verify_cover(bracket, result)
    without_one = kaboum.ConvexSet(made.bodies[1:])
    assert kaboum.verify_cover(bracket, without_one).answer == "refuted"


def test_regions_as_the_tool(bracket, tmp_path):
    """The same bytes and answers of a map in a file, a map in Python, and the programs."""
    vertices = kaboum.read(bracket).vertices
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    size = float(np.linalg.norm(high - low))
    near = {"name": "corner", "epsilon": "2%", "box": [low, 0.5 * (low + high)]}
    regions = [near, {"epsilon": f"{0.03 * size}m", "ball": {"center": [high[0], low[1], low[2]], "radius": 0.2 * size}}]
    file, result, report = tmp_path / "map.json", tmp_path / "b.glb", tmp_path / "r.json"
    file.write_text(json.dumps({"regions": regions}, default=lambda a: a.tolist()))
    subprocess.run([f"{BIN}/bcd-decompose", bracket, "-o", result, "--epsilon", "6%", "--effort", "fast", "--no-cache",
                    "--epsilon-map", file, "--report", report], check=True, capture_output=True)
    made = kaboum.decompose(bracket, epsilon="6%", effort="fast", epsilon_map=regions)
    assert made.bytes == result.read_bytes()
    assert kaboum.decompose(bracket, epsilon="6%", effort="fast", epsilon_map=file).cached
    assert made.report["cover"]["regions"] == json.loads(report.read_text())["cover"]["regions"]
    assert [n for n in made.notes if "m is brought into m; another one is stated by unit='mm'" in n]
    coarse = kaboum.decompose(bracket, epsilon="6%", effort="fast")
    assert coarse.bytes != made.bytes
    coarse.write(tmp_path / "coarse.glb")
    for judged, bodies in ((made, result), (coarse, tmp_path / "coarse.glb")):
        subprocess.run([f"{BIN}/bound-verify", "cover", bracket, bodies, "--epsilon", "6%", "--epsilon-map", file, "--report", report],
                       capture_output=True)
        said = json.loads(report.read_text())
        verdict = kaboum.verify_cover(bracket, judged, epsilon="6%", epsilon_map=regions)
        assert verdict.answer == said["verdict"]
        assert [r["name"] for r in verdict.claims["regions"]] == ["'corner'", "region 2"]
        for mine, its in zip(verdict.claims["regions"], said["claims"]["regions"]):
            assert mine.pop("at") == pytest.approx(its.pop("at"), abs=0)
            its.pop("pieces")
            assert mine == its
        assert [n for n in verdict.notes if "m is brought into m, which is that of the set" in n]
    assert kaboum.verify_cover(bracket, made, epsilon="6%", epsilon_map=[near])
    assert "regions" not in kaboum.verify_cover(bracket, made).claims
    fine = kaboum.verify_cover(bracket, coarse, epsilon_map=[near | {"epsilon": "0.1%"}])
    assert fine.answer == fine.claims["regions"][0]["answer"] == "refuted"
    with pytest.raises(kaboum.Error, match="epsilon_map: region 1: there is no member 'bocks'"):
        kaboum.verify_cover(bracket, made, epsilon_map=[{"epsilon": 1, "bocks": []}])
    with pytest.raises(kaboum.Error, match="no.json"):
        kaboum.decompose(bracket, epsilon_map=tmp_path / "no.json")


def test_balls_and_capsules_are_bodies(tmp_path):
    """A cube of side 1 about the origin, in bodies with radii."""
    solid = (cube()[0] - 0.5, cube()[1])
    ends, centre = np.array([[0, 0, -0.5], [0, 0, 0.5]]), np.zeros(3)
    corner = np.sqrt(0.75)
    for bodies, radii, covers in (([centre], 0.87, True), ([centre], 0.86, False),
                                  ([ends], np.sqrt(0.5) + 1e-9, True), ([ends], [0.7], False),
                                  ([ends, centre], [0.6, 0.87], True),
                                  ([solid, centre], [0, 0.1], True)):
        made = kaboum.ConvexSet(bodies, radii=radii)
        verdict = kaboum.verify_cover(solid, made)
        assert bool(verdict) == covers and verdict.answer == ("verified" if covers else "refuted")
        path = tmp_path / "set.glb"
        made.write(path)
        back = kaboum.read_set(path)
        assert (back.radii == np.broadcast_to(radii, len(bodies))).all() and len(back) == len(bodies)
        done = subprocess.run([f"{BIN}/bound-verify", "cover", write_cube(tmp_path, solid), path], check=False,
                              capture_output=True, text=True)
        assert done.returncode == (0 if covers else 1), done.stdout + done.stderr
    ball = kaboum.ConvexSet([centre], radii=1)
    assert kaboum.verify_cover(solid, ball, epsilon=0.51) and not kaboum.verify_cover(solid, ball, epsilon=0.49)
    assert ball.bodies[0].vertices.shape == (1, 3) and ball.bodies[0].faces.shape == (0, 3)
    found = kaboum.hausdorff(solid, ball, solid=True, samples=1000)
    assert found.lower <= 0.5 <= found.upper <= 0.51
    inner = kaboum.ConvexSet([centre, ends * 0.4], radii=[0.49, 0.25])
    assert kaboum.verify_mesh(solid, inner, relation="inner", epsilon=0.3)
    assert kaboum.verify_mesh(solid, ball, relation="inner").answer == "refuted"
    with pytest.raises(kaboum.Error, match="radius must be above 0"):
        kaboum.ConvexSet([centre])
    with pytest.raises(kaboum.Error, match="one for each"):
        kaboum.ConvexSet([ends, centre], radii=[1, 2, 3])
    with pytest.raises(kaboum.Error, match="at least 0"):
        kaboum.ConvexSet([ends], radii=-corner)
    with pytest.raises(kaboum.Error, match="cannot state the radius"):
        ball.write(tmp_path / "set.obj")


def write_cube(folder, mesh):
    path = folder / "cube.stl"
    kaboum.write(mesh, path)
    return path


def test_inner_set(ring):
    inner = kaboum.decompose(ring, direction="inner", epsilon="6%")
    assert kaboum.verify_mesh(ring, inner, relation="inner")
    assert inner.record["direction"] == "inner"


def test_a_large_epsilon_is_warned_of():
    for make in (lambda e: kaboum.decompose(cube(), epsilon=e, no_cache=True), lambda e: kaboum.decimate(cube(), epsilon=e)):
        assert any("WARNING: epsilon is" in note for note in make(5).notes)
        assert not any("WARNING" in note for note in make("1%").notes)


def test_whatever_triangles_are_wrapped():
    soup = (np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, -1], [0.2, 0.3, 1], [0.4, 0.2, 1]]), np.arange(6).reshape(2, 3))
    with pytest.raises(kaboum.Error, match="seal needs prepare wrap"):
        kaboum.decompose(soup, epsilon="10%", seal="4%")
    made = kaboum.decompose(soup, prepare="wrap", epsilon="10%", seal="4%", effort="fast", no_cache=True)
    assert 0 < made.report["wrap"]["farthest_upper"] < made.distance[1] <= 0.1 * made.report["wrap"]["diagonal"]
    assert any("round all 2 triangles" in note for note in made.notes)


def test_bodies_are_views(ring):
    bodies = kaboum.decompose(ring, epsilon="5%").bodies
    copies = [b.vertices.copy() for b in bodies]
    views = [b.vertices for b in bodies]
    del bodies
    for view, copy in zip(views, copies):
        np.testing.assert_array_equal(view, copy)


def test_sets_survive_files(ring, tmp_path):
    made = kaboum.decompose(ring, epsilon="5%")
    made.write(tmp_path / "set.obj")
    made.write(tmp_path / "folder")
    for path in (tmp_path / "set.obj", tmp_path / "folder"):
        back = kaboum.read_set(path)
        assert len(back) == len(made)
        assert kaboum.verify_cover(ring, back)


def test_distances_of_cubes():
    found = kaboum.hausdorff(cube(1.0), cube(2.0), samples=1000)
    assert found.lower <= np.sqrt(3) <= found.upper < 1.74
    assert found.minimum == (0, 0)
    assert found.a_to_b["max"][1] == pytest.approx(1, rel=1e-2)
    within = kaboum.hausdorff(cube(1.0), cube(2.0), solid=True, samples=2)
    assert within.a_to_b["max"] == (0, 0)


@pytest.mark.parametrize("options", [
    {}, {"epsilon": 0}, {"epsilon": -1}, {"epsilon": "5"+"%%"}, {"epsilon": True}, {"epsilon": float("nan")},
    {"vertices": 100, "direction": "outside"}, {"ratio": 2.0}, {"vertices": 100, "threads": -1},
    {"vertices": 100, "progress": 5}, {"vertices": 100, "output_format": "x3d"}, {"vertices": [100, 100]},
])
def test_options_that_contradict(ring, options):
    with pytest.raises(kaboum.Error) as error:
        kaboum.decimate(ring, **options)
    assert error.value.code == "invalid_argument"


def test_unknown_names_are_explained(ring):
    with pytest.raises(kaboum.Error, match="did you mean 'outer'"):
        kaboum.decimate(ring, vertices=100, direction="outr")
    with pytest.raises(TypeError):
        kaboum.decimate(ring, vertexes=100)
    for call, other in ((lambda: kaboum.decimate(ring, vertices=100, no_cache=True), ""),
                        (lambda: kaboum.decimate(ring, vertices=100, thread=1), "threads"),
                        (lambda: kaboum.decompose(ring, no_cach=True), "no_cache")):
        with pytest.raises(TypeError) as error:
            call()
        assert ("did you mean" in str(error.value)) == bool(other) and other in str(error.value)


def test_progress_is_told_and_may_cancel():
    ring = torus(96, 48)
    stages = []
    kaboum.decimate(ring, vertices=100, progress=stages.append)
    assert stages and all(isinstance(s, str) for s in stages)

    class Enough(Exception):
        pass

    def stop(_):
        raise Enough

    for call in (lambda: kaboum.decimate(ring, vertices=100, progress=stop),
                 lambda: kaboum.decompose(ring, epsilon="1%", progress=stop, no_cache=True),
                 lambda: kaboum.hausdorff(ring, cube(), progress=stop),
                 lambda: kaboum.verify_mesh(ring, ring, progress=stop)):
        with pytest.raises(Enough):
            call()


def test_interrupt_ends_the_work():
    big = torus(400, 200)
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        kaboum.decimate(big, vertices=100, effort="best")
    timer.join()


def test_other_threads_run_meanwhile():
    counted = [0]
    done = threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    before = counted[0]
    kaboum.decimate(torus(96, 48), vertices=100)
    during = counted[0] - before
    done.set()
    thread.join()
    assert during > 5


def test_calls_of_several_threads(ring):
    results = [None] * 4

    def work(i):
        results[i] = kaboum.decimate(ring, vertices=100, effort="fast").bytes

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert results[0] and len(set(results)) == 1
