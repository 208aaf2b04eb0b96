"""Pictures and pages: the programs' bytes, and what is refused."""

import json
import os
import re
import subprocess

import numpy as np
import pytest

import kaboum
from conftest import SOURCE, cube, torus


def run(program, *arguments):
    """A program that has to succeed."""
    done = subprocess.run([os.environ["KABOUM_BIN"] + "/" + program, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def same(ours, theirs):
    """Two files have the same bytes, some at least."""
    assert ours.read_bytes() == theirs.read_bytes() and ours.stat().st_size > 0


@pytest.fixture
def pair(tmp_path):
    """Files of a torus and of a mesh round it."""
    kaboum.write(torus(32, 16), tmp_path / "a.ply")
    kaboum.decimate(tmp_path / "a.ply", vertices=80).write(tmp_path / "b.ply")
    return tmp_path / "a.ply", tmp_path / "b.ply"


def test_shapes_are_drawn_side_by_side(pair, tmp_path):
    bodies = kaboum.decompose(pair[0], epsilon="10%", effort="fast")
    bodies.write(tmp_path / "set.glb")
    files = [*pair, tmp_path / "set.glb"]
    run("mesh-picture", *files, "-o", tmp_path / "theirs.png", "--width", "600", "--height", "300", "--titles", "one,two", "--view", "20,-10",
        "--colours", "red,green", "--edges")
    options = {"width": 600, "height": 300, "titles": "one,two", "view": "20,-10", "colours": "red,green", "edges": True}
    drawn = kaboum.draw([torus(32, 16), kaboum.read(pair[1]), bodies], tmp_path / "ours.png", **options)
    same(tmp_path / "ours.png", tmp_path / "theirs.png")
    assert drawn == (tmp_path / "ours.png").read_bytes() == kaboum.draw(files, **options)
    run("mesh-picture", pair[0], "-o", tmp_path / "theirs.png")
    assert kaboum.draw(torus(32, 16)) == (tmp_path / "theirs.png").read_bytes()
    run("mesh-picture", pair[0], "-o", tmp_path / "theirs.png", "--colors", "green")
    assert kaboum.draw(pair[0], colours="green") == (tmp_path / "theirs.png").read_bytes()


def test_what_cannot_be_drawn_is_refused(pair, tmp_path):
    for options, says in (({"view": "up"}, "view: give"), ({"colours": "mauve"}, "colours: 'mauve'"), ({"titles": "one,two"}, "titles: more"),
                          ({"width": 8}, "width must be"), ({"file": tmp_path / "a.jpg"}, "ends with .png")):
        with pytest.raises(kaboum.Error, match=says) as error:
            kaboum.draw(pair[0], **options)
        assert error.value.code == "invalid_argument"
    with pytest.raises(kaboum.Error, match="no mesh"):
        kaboum.draw([])
    with pytest.raises(kaboum.Error, match=".png, .html or .ply"):
        kaboum.write_heatmap(tmp_path / "a.jpg", *pair)
    with pytest.raises(kaboum.Error, match="a page is written"):
        kaboum.decimate(pair[0], vertices=80).write_preview(tmp_path / "a.png")
    with pytest.raises(kaboum.Error, match="a picture or a page is written"):
        kaboum.decompose(pair[0], epsilon="20%").write_preview(tmp_path / "a.jpg")
    with pytest.raises(kaboum.Error, match="explode must be"):
        kaboum.decompose(pair[0], epsilon="20%").write_preview(tmp_path / "a.png", explode=-1)
    assert not list(tmp_path.glob("a.[jhp]?[gm]*"))


@pytest.mark.parametrize("extension", ["png", "html", "ply"])
def test_heatmaps(pair, tmp_path, extension):
    ours, theirs = (tmp_path / f"{name}.{extension}" for name in ("ours", "theirs"))
    for solid in (False, True):
        run("hausdorff-eval", *pair, "--heatmap", theirs, "--quiet", *["--solid"] * solid)
        found = kaboum.write_heatmap(ours, *pair, solid=solid)
        same(ours, theirs)
        assert found.upper == kaboum.hausdorff(*pair, solid=solid).upper
    if extension == "ply":
        kaboum.write_heatmap(ours, torus(32, 16), kaboum.read(pair[1]), solid=True)
        same(ours, theirs)


def test_previews_of_sets(bracket, tmp_path):
    for direction in ("outer", "inner"):
        made = kaboum.decompose(bracket, epsilon="5%", effort="fast", direction=direction)
        options = ["--epsilon", "5%", "--effort", "fast", "--direction", direction, "-o", tmp_path / "set.glb"]
        for name, explode in (("page.html", {}), ("apart.png", {}), ("set.png", {"explode": 0})):
            run("bcd-decompose", bracket, *options, "--preview", tmp_path / name, *(["--explode", 0] if explode else []))
            made.write_preview(tmp_path / ("our-" + name), **explode)
            same(tmp_path / ("our-" + name), tmp_path / name)
    kaboum.read_set(tmp_path / "set.glb").write_preview(tmp_path / "read.png", explode=0)
    same(tmp_path / "read.png", tmp_path / "set.png")
    with pytest.raises(kaboum.Error, match="ends with .png"):
        kaboum.read_set(tmp_path / "set.glb").write_preview(tmp_path / "read.html")
    kaboum.decompose(cube(), epsilon="5%").write_preview(tmp_path / "cube.html")
    assert "Bodies of the mesh" in (tmp_path / "cube.html").read_text()


def test_previews_of_meshes(bracket, tmp_path):
    """But for the name of the result's file, which the page of the program says."""
    run("bmesh-decimate", bracket, "-o", tmp_path / "out.ply", "--epsilon", "3%", "--effort", "fast", "--preview", tmp_path / "theirs.html")
    made = kaboum.decimate(bracket, epsilon="3%", effort="fast", measure=True)
    made.write_preview(tmp_path / "ours.html")
    theirs = (tmp_path / "theirs.html").read_text()
    assert f"{tmp_path}/out.ply: " in theirs
    assert (tmp_path / "ours.html").read_text() == theirs.replace(f"{tmp_path}/out.ply: ", "")
    levels = kaboum.decimate(kaboum.prepare(torus(32, 16)), vertices=[120, 80])
    levels[0].write_preview(tmp_path / "levels.html")
    text = (tmp_path / "levels.html").read_text()
    assert '"name":"120 vertices"' in text and '"name":"80 vertices"' in text


def test_previews_of_robots(arm, tmp_path):
    options = ["--epsilon", "5%", "-o", tmp_path / "folder"]
    run("bcd-decompose", arm, *options, "--preview", tmp_path / "theirs.html")
    made = kaboum.certify_robot(arm, epsilon="5%")  # its meshes are in the cache, for both
    run("bcd-decompose", arm, *options, "--preview", tmp_path / "theirs.png", "--html-report", tmp_path / "report.html")
    for extension in ("html", "png"):
        made.write_preview(tmp_path / f"ours.{extension}")
    same(tmp_path / "ours.png", tmp_path / "theirs.png")
    ours, theirs = (json.loads(re.search(r'type="application/json">(.*?)</script>', (tmp_path / f"{whose}.html").read_text(), re.S)[1])
                    for whose in ("ours", "theirs"))
    assert theirs.pop("steps") and "steps" not in ours  # what to do next with the folder, which only the program writes
    assert ours == theirs
    made.write_page(tmp_path / "page.html")
    ours, theirs = ((tmp_path / name).read_text() for name in ("page.html", "report.html"))
    assert ours[ours.index("<table>"):ours.index("</table>")] == theirs[theirs.index("<table>"):theirs.index("</table>")]
    assert "bound-verify" in theirs and "bound-verify" not in ours and ours.endswith("</html>\n")


def test_pages_of_enclosed_robots(arm, tmp_path):
    kaboum.decimate_robot(arm, epsilon="5%")  # its meshes are in the cache, for both
    run("bmesh-decimate", arm, "--epsilon", "5%", "-o", tmp_path / "folder", "--html-report", tmp_path / "report.html")
    kaboum.decimate_robot(arm, epsilon="5%").write_page(tmp_path / "page.html")
    ours, theirs = ((tmp_path / name).read_text() for name in ("page.html", "report.html"))
    assert ours[ours.index("<table>"):ours.index("</table>")] == theirs[theirs.index("<table>"):theirs.index("</table>")]
    assert "bound-verify" in theirs and "bound-verify" not in ours and ours.endswith("</html>\n")


def test_previews_of_sweeps(arm, tmp_path):
    (tmp_path / "path.csv").write_text("-0.3,0\n0.2,0.2\n0,0\n")
    made = kaboum.sweep(arm, tmp_path / "path.csv", epsilon=0.02)
    for extension in ("html", "png"):
        run("sweep-approx", arm, "--path", tmp_path / "path.csv", "--epsilon", "0.02", "-o", tmp_path / "set.glb", "--preview",
            tmp_path / f"theirs.{extension}")
        made.write_preview(tmp_path / f"ours.{extension}")
        same(tmp_path / f"ours.{extension}", tmp_path / f"theirs.{extension}")
    kaboum.sweep(arm, np.array([[-0.3, 0], [0.2, 0.2]]), epsilon=0.02).write_preview(tmp_path / "array.html")
    assert re.search("the path, 2 waypoints", (tmp_path / "array.html").read_text())


def test_worlds(arm, tmp_path):
    scene = kaboum.make_scene(tmp_path / "cell.json", robots={"arm": arm}, objects={"block": SOURCE / "meshes" / "bracket.obj"}, scale={"block": 0.01})
    assert scene
    world = kaboum.World(tmp_path / "cell.json")
    for q in ([0.0, 0.0], [1.5, 0.1]):
        drawn = world.draw(q, tmp_path / "ours.png")
        subprocess.run([os.environ["KABOUM_BIN"] + "/kaboum-check", tmp_path / "cell.json", "--configuration=" + ",".join(map(str, q)), "--preview",
                        tmp_path / "theirs.png"], capture_output=True)
        same(tmp_path / "ours.png", tmp_path / "theirs.png")
        assert drawn == (tmp_path / "ours.png").read_bytes() == world.draw(q)
    with pytest.raises(kaboum.Error, match="one configuration"):
        world.draw([[0, 0], [1, 0]])


def test_what_cannot_be_drawn_is_refused():
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    for v in (1e155, 1e300, 1e-320):
        vertices = np.array([[0, 0, 0], [v, 0, 0], [0, v, 0.0], [0, 0, v]])
        if v > 1:
            with pytest.raises(kaboum.Error, match="cannot be drawn"):
                kaboum.draw((vertices, faces))
        else:
            assert kaboum.draw((vertices, faces))
    with pytest.raises(kaboum.Error, match="more than 64,000,000 pixels"):
        kaboum.draw(torus(32, 16), width=16384, height=16384)
