"""Scenes made in process and from files."""

import json
import os
import pathlib
import re
import subprocess
import threading

import numpy as np
import pytest

import kaboum
from conftest import ARM, SOURCE, cube

BIN = pathlib.Path(os.environ["KABOUM_BIN"])


def program(folder, *arguments, code=0):
    done = subprocess.run([BIN / "kaboum-scene", *map(str, arguments)], check=False, capture_output=True, text=True, cwd=folder)
    assert done.returncode == code, done.stderr
    return done.stderr


def files_in(folder):
    return {str(f.relative_to(folder)): f.read_bytes() for f in sorted(folder.rglob("*")) if f.is_file()}


@pytest.fixture
def parts(arm):
    """A folder with an arm of three links and a box of 0.2 m."""
    vertices, faces = cube(0.2)
    kaboum.write((vertices - 0.1, faces), arm.parent / "box.off")
    return arm.parent


def test_grasps_and_places_are_the_programs(parts, monkeypatch):
    """add_grasps and add_places write the same bytes as kaboum-scene, and say the same."""
    monkeypatch.chdir(parts)
    kaboum.make_scene("a.json", robots={"arm": "arm.urdf"}, at={"post": (5, 5, 0.1)}, epsilon="5%", effort="fast",
                      objects={"post": {"box": {"size": [0.04, 0.06, 0.2]}}, "ball": {"sphere": {"radius": 0.1}}})
    scene = json.loads((parts / "a.json").read_text())
    with pytest.raises(kaboum.Error, match="no tools"):
        kaboum.add_grasps("a.json")
    scene["robots"][0]["tools"] = [{"name": "tip", "link": scene["robots"][0]["links"][-1]["link"], "position": [0, 0, 3]}]
    for name in ("a.json", "b.json"):
        (parts / name).write_text(json.dumps(scene))
    said = program(parts, "places", "a.json", code=1)  # nobody stands on a ball
    places = kaboum.add_places("b.json")
    assert places["names"]["post"] == ["bottom", "top", "face"] and "stands on no face" in places["without"]["ball"]
    assert "ball: none; it stands on no face" in said
    program(parts, "grasps", "a.json", "--object", "post", "--closing", "x", "--opening", "0.05", "--directions", 3, "--tip", 0.01)
    grasps = kaboum.add_grasps("b.json", "post", closing="x", opening="5cm", directions=3, tip="10mm")
    assert grasps["names"] == {"post": [f"tip/side-{i}" for i in (1, 2, 3, 4)]} and grasps["without"] == {}
    family = json.loads((parts / "b.json").read_text())["objects"][0]["grasps"][3]
    assert len(family["slides"]) == 2 and family["slides"][0]["to"] == 0.095 and family["rank"] == 1
    assert (parts / "a.json").read_bytes() == (parts / "b.json").read_bytes()
    with pytest.raises(kaboum.Error, match="did you mean 'post'"):
        kaboum.add_grasps("b.json", ["posts"])
    for call in (kaboum.add_grasps, kaboum.add_places):
        with pytest.raises(kaboum.Error, match="objects is empty.*leave it out"):
            call("b.json", [])
        for wrong in (3, b"post", [b"post"], ["post", 3]):
            with pytest.raises(kaboum.Error, match="objects must be a str or a sequence of str"):
                call("b.json", wrong)
    assert (parts / "a.json").read_bytes() == (parts / "b.json").read_bytes()
    # What is not found anew stays.
    none = kaboum.add_grasps("b.json", "post", closing="x", opening=0.001)
    assert none["names"] == {"post": []} and none["kept"] == grasps["names"] and "are kept" in none["without"]["post"]
    again = kaboum.add_places("b.json", "post")
    assert again["kept"] == {"post": ["bottom", "top", "face"]} and again["without"] == {}


def test_scene_is_the_programs(parts, monkeypatch):
    """make_scene and kaboum-scene make write the same bytes; so does update after a mesh has changed."""
    monkeypatch.chdir(parts)
    (parts / "a").mkdir()
    (parts / "b").mkdir()
    program(parts, "make", "a/cell.json", "--robot", "arm=arm.urdf", "--object", "box=box.off", "--region", "room=box.off", "--at",
            "box=1,0,0.5,0,0,0.3", "--at", "arm=0,0,0.1", "--scale", "room=2", "--inner", "--epsilon", "5%", "--effort", "fast", "--primitive", "post=cylinder:0.1,0.5")
    made = kaboum.make_scene("b/cell.json", robots={"arm": "arm.urdf"}, regions={"room": "box.off"},
                             objects={"box": "box.off", "post": {"cylinder": {"radius": 0.1, "length": 0.5}}},
                             at={"box": [1, 0, 0.5, 0, 0, 0.3], "arm": (0, 0, 0.1)}, scale={"room": 2}, inner=True, epsilon="5%",
                             effort="fast")
    assert files_in(parts / "a") == files_in(parts / "b")
    assert len(made["containers"]) == 6 and made["bad_links"] == []
    assert kaboum.update_scene("b/cell.json")["containers"] == []
    vertices, faces = cube(0.2)
    kaboum.write((vertices - 0.11, faces), parts / "box.off")
    with pytest.raises(kaboum.Error, match="box"):
        kaboum.World("b/cell.json")
    program(parts, "update", "a/cell.json")
    assert len(kaboum.update_scene("b/cell.json")["containers"]) == 3
    assert files_in(parts / "a") == files_in(parts / "b")
    for wrong, says in (({"path": "b/cell.json"}, "exists"), ({"path": "c.json", "at": {"bax": (0, 0, 0)}}, "did you mean 'box'"),
                        ({"path": "c.json", "unit": "mm"}, "URDFs are in m"), ({"path": "c.txt"}, "ends in .json"),
                        ({"path": "c.json", "at": {"box": (0, 0)}}, "x, y, z"),
                        ({"path": "c.json", "objects": {"ball": {"sphere": {"size": 1}}}}, "object 'ball'.*size")):
        with pytest.raises(kaboum.Error, match=says):
            kaboum.make_scene(**{"robots": {"arm": "arm.urdf"}, "objects": {"box": "box.off"}, **wrong})
    with pytest.raises(kaboum.Error, match="nothing is asked for"):
        kaboum.make_scene("c.json")


def filled(parts, robot=None):
    scene = kaboum.Scene()
    scene.add_robot("arm", robot or kaboum.certify_robot(parts / "arm.urdf", epsilon="5%"), at=(0, 0, 0.1), home=[0, 0],
                    tools=[{"name": "tip", "link": "tool", "position": np.zeros(3)}])
    scene.add_object("box", parts / "box.off", at=(0.45, 0, 0.5, 0, 0, 0.3), epsilon="5%",
                     features=[{"name": "top", "point": [0, 0, 0.1]}])
    return scene


def test_scene_in_process_is_the_one_on_disk(parts, tmp_path):
    scene = filled(parts)
    scene.allow_contact("arm/base", "box")
    before = kaboum.World(scene)
    assert scene.path is None and before.robots == ["arm"] and before.objects == ["box"]
    (tmp_path / "there").mkdir()
    written = scene.write(tmp_path / "there" / "cell.yaml")
    assert len(written["containers"]) == 4 and written["bad_links"] == []
    after = kaboum.World(tmp_path / "there" / "cell.yaml")
    rows = np.random.default_rng(1).uniform([-2, 0], [2, 0.3], (300, 2))
    free = before.are_free(rows)
    assert np.array_equal(free, after.are_free(rows)) and free.any() and not free.all()
    assert kaboum.World(scene).home().tolist() == [0, 0]
    # The programs read it.
    done = subprocess.run([BIN / "kaboum-check", tmp_path / "there" / "cell.yaml"], capture_output=True, text=True, check=False)
    assert done.returncode in (0, 1), done.stderr
    again = kaboum.Scene.read(tmp_path / "there" / "cell.yaml")
    assert again.data == scene.data and again.path == str(tmp_path / "there" / "cell.yaml")
    with pytest.raises(kaboum.Error, match="exists"):
        filled(parts).write(tmp_path / "there" / "cell.yaml")


def test_each_value_of_a_row_has_a_place_of_its_own(parts):
    """Of arrays by their size, pybind11 2.10 took the strides from descriptors that NumPy 2 has no more."""
    scene = kaboum.Scene()
    scene.add_robot("arm", kaboum.certify_robot(parts / "arm.urdf", epsilon="5%"), home=[0.25, 0.125])
    home = kaboum.World(scene).home()
    assert home.tolist() == [0.25, 0.125] and home.strides == (8,)
    balls = kaboum.ConvexSet([np.zeros((1, 3)), np.ones((1, 3))], radii=[0.25, 0.5])
    assert balls.radii.tolist() == [0.25, 0.5]
    lost = 2**53 + 1
    for dtype in (np.int64, np.uint64):
        with pytest.raises(kaboum.Error, match="9007199254740993"):
            kaboum.World(scene).are_free(np.array([[0, lost]], dtype))


def test_scene_that_was_read_is_added_to(parts, tmp_path):
    filled(parts).write(tmp_path / "cell.json")
    kept = files_in(tmp_path / "cell")
    scene = kaboum.Scene.read(tmp_path / "cell.json")
    scene.add_object("second", kaboum.decompose(parts / "box.off", epsilon="5%"), at=(0, 1, 0))
    with pytest.raises(kaboum.Error, match="used twice"):
        scene.add_object("box", parts / "box.off")
    with pytest.raises(kaboum.Error, match="written where it was"):
        scene.write(tmp_path / "other.json")
    scene.write(tmp_path / "cell.json")
    assert kaboum.World(tmp_path / "cell.json").objects == ["box", "second"]
    assert {name: files_in(tmp_path / "cell")[name] for name in kept} == kept
    scene.attach(object="second", robot="arm", link="tool", position=[0, 0, 0.2])
    assert kaboum.World(scene).objects == ["box", "second"]


def test_objects_of_arrays_and_inner_sets(parts, tmp_path):
    scene = filled(parts)
    vertices, faces = cube(0.2)
    scene.add_object("plate", (vertices, faces), at=(0, 0, 2), inner=kaboum.decompose((vertices, faces), direction="inner"))
    scene.add_region("room", (vertices * 4, faces), at=(0, 0, 0), epsilon="2%")
    world = kaboum.World(scene)
    assert world.objects == ["box", "plate"]
    scene.write(tmp_path / "cell.json")
    data = json.loads((tmp_path / "cell.json").read_text())
    assert "made_from" not in data["objects"][1]["outer"] and data["objects"][0]["outer"]["made_from"]
    assert data["regions"][0]["name"] == "room" and "inner" in data["objects"][1]


def test_what_a_scene_refuses(parts, tmp_path):
    made = kaboum.certify_robot(parts / "arm.urdf", epsilon="5%")
    scene = kaboum.Scene()
    for call, says in ((lambda: scene.add_robot("arm", "arm.urdf"), "CertifiedRobot"),
                       (lambda: scene.add_robot("arm", made, at=(1, 2)), "x, y, z"),
                       (lambda: scene.add_robot("arm", made, links=[]), "follows from the sets"),
                       (lambda: scene.add_object("o", kaboum.decompose(cube()), epsilon=1), "made already"),
                       (lambda: scene.add_object("o", kaboum.decompose(cube(), direction="inner")), "an outer set"),
                       (lambda: scene.add_region("o", kaboum.decompose(cube())), "an inner set"),
                       (lambda: kaboum.World(3), "kaboum.Scene")):
        with pytest.raises(kaboum.Error, match=re.escape(says)):
            call()
    with pytest.raises(kaboum.Error, match="robot 'arm'.*finite"):
        scene.add_robot("arm", made, at=(float("nan"), 0, 0))
    for size in (float("nan"), object(), np.array([1, np.inf])):
        ball = {"sphere": {"radius": size}}
        for call in (lambda: scene.add_object("o", ball), lambda: kaboum.make_scene(tmp_path / "a.json", objects={"o": ball})):
            with pytest.raises(kaboum.Error, match="object 'o'.*finite"):
                call()
        with pytest.raises(kaboum.Error, match="region 'o'.*finite"):
            scene.add_region("o", ball)
    scene.add_robot("arm", made, nonsense=1)
    with pytest.raises(kaboum.Error, match="nonsense"):
        kaboum.World(scene)
    with pytest.raises(kaboum.Error, match="nonsense"):
        scene.write(tmp_path / "cell.json")
    assert not (tmp_path / "cell.json").exists()
    some = kaboum.Scene()
    some.add_robot("arm", kaboum.certify_robot(parts / "arm.urdf", epsilon="5%", links=["tool"]))
    with pytest.raises(kaboum.Error, match="no set"):
        kaboum.World(some)
    other = kaboum.Scene(unit="mm")
    other.add_object("o", kaboum.decompose(cube()))
    with pytest.raises(kaboum.Error, match="mm"):
        kaboum.World(other)


def test_a_robot_whose_file_changed_is_refused(parts):
    scene = filled(parts)
    (parts / "arm.urdf").write_text(ARM.replace('upper="0.3"', 'upper="0.2"'))
    with pytest.raises(kaboum.Error, match="arm.urdf"):
        kaboum.World(scene)


def test_robots_are_named(parts):
    scene = filled(parts)
    scene.add_robot("second", kaboum.certify_robot(parts / "arm.urdf", epsilon="5%"), at=(0, 3, 0))
    world = kaboum.World(scene)
    with pytest.raises(kaboum.Error, match="several robots"):
        world.home()
    with pytest.raises(kaboum.Error, match="did you mean 'second'"):
        world.home("secnd")
    assert world.home("second").tolist() == [0, 0]


def extent(world_or_set):
    vertices = np.vstack([body.vertices for body in world_or_set.bodies])
    return vertices.max(0) - vertices.min(0)


def test_inner_meshes_get_the_options_of_outer_ones(parts, tmp_path):
    """An inner set of another scale would reach out of the object, and call free places contacts."""
    vertices, faces = cube(0.2)
    given = kaboum.Mesh(vertices, faces)
    scene = kaboum.Scene(unit="mm")
    scene.add_object("box", parts / "box.off", inner=parts / "box.off", scale=0.5, unit="mm", epsilon="5%")
    scene.add_object("array", given, inner=given, scale=0.5, unit="mm", epsilon="5%")
    scene.write(tmp_path / "cell.json")
    for name in ("box", "array"):
        outer, inner = (kaboum.read_set(tmp_path / "cell" / f"{name}{end}.glb") for end in ("", "-inner"))
        assert np.all(extent(inner) <= 0.1) and np.all(extent(inner) > 0.09) and np.all(extent(outer) >= 0.1)
        assert inner.record["unit"] == outer.record["unit"] == "mm"
    # A box and a sheet beside it: what is dropped outside is dropped inside.
    sheet = np.array([[0, 0, 5], [1, 0, 5], [0, 1, 5]]) * 0.1
    part = np.vstack([vertices, sheet]), np.vstack([faces, [[8, 9, 10], [8, 10, 9]]])
    scene = kaboum.Scene()
    scene.add_object("part", part, inner=part, drop_sheets=True)
    scene.write(tmp_path / "part.json")
    for end in ("", "-inner"):
        assert "--drop-sheets" in kaboum.read_set(tmp_path / "part" / f"part{end}.glb").record["parameters"]
    for options in ({"prepare": "wrap"}, {"simplify": 0.2}):
        with pytest.raises(kaboum.Error, match="direction outer"):
            scene.add_object("other", given, inner=given, **options)


def test_inner_sets_of_another_scale_are_refused(parts):
    scene = kaboum.Scene()
    box = parts / "box.off"
    with pytest.raises(kaboum.Error, match="scale"):
        scene.add_object("box", box, inner=kaboum.decompose(box, direction="inner"), scale=0.5)
    with pytest.raises(kaboum.Error, match="scale"):
        scene.add_object("box", kaboum.decompose(box, scale=2), inner=box)
    # With a set that was made already, options are the inner mesh's.
    scene.add_object("box", kaboum.decompose(box, scale=2), inner=box, scale=2)
    assert kaboum.World(scene).objects == ["box"]


def test_scenes_are_used_by_several_threads(parts, tmp_path):
    box = kaboum.decompose(parts / "box.off", epsilon="5%")
    scene = kaboum.Scene()
    scene.add_object("first", box)
    ended = threading.Event()
    seen, failed = [], []

    def look(what):
        try:
            while not ended.is_set():
                seen.append(what())
        except Exception as error:
            failed.append(error)

    def written():
        scene.write(tmp_path / "cell.json", force=True)
        return len(kaboum.World(tmp_path / "cell.json").objects)

    threads = [threading.Thread(target=look, args=(what,)) for what in (
        lambda: len(scene.data["objects"]), lambda: len(kaboum.World(scene).objects), written, lambda: repr(scene) and scene.unit and 1)]
    for thread in threads:
        thread.start()
    for i in range(200):
        scene.add_object(f"box{i}", box)
        scene.allow_contact(f"box{i}", "first")
    ended.set()
    for thread in threads:
        thread.join()
    assert not failed and all(1 <= number <= 201 for number in seen)
    assert len(scene.data["objects"]) == 201 and len(scene.data["allowed_contacts"]) == 200


def test_what_was_edited_is_not_overwritten(parts, tmp_path):
    file = tmp_path / "cell.json"
    filled(parts).write(file)
    scene = kaboum.Scene.read(file)
    edited = file.read_text().replace('"allowed_contacts": []', '"allowed_contacts": [["arm/base", "box"]]')
    assert edited != file.read_text()
    file.write_text(edited)
    scene.add_object("second", parts / "box.off", at=(0, 1, 0), epsilon="5%")
    containers = files_in(tmp_path / "cell")
    with pytest.raises(kaboum.Error, match="has changed since"):
        scene.write(file)
    assert file.read_text() == edited and files_in(tmp_path / "cell") == containers
    scene.write(file, force=True)
    assert kaboum.World(file).objects == ["box", "second"]
    # What it wrote itself it may replace; not what came after that.
    scene.allow_contact("arm/base", "second")
    scene.write(file)
    file.write_text(edited)
    with pytest.raises(kaboum.Error, match="has changed since"):
        scene.write(file)
    file.unlink()
    scene.write(file)
    assert kaboum.Scene.read(file).data == scene.data


def test_what_write_says_of_the_scene(parts, tmp_path):
    scene = filled(parts)
    vertices, faces = cube(0.2)
    scene.add_region("room", (vertices * 4, faces), epsilon="2%")
    written = scene.write(tmp_path / "cell.json")
    assert {pathlib.Path(file).name for file in written["inputs"]} == {"arm.urdf", "tool.ply", "box.off"}
    assert [size.split(":")[0] for size in written["sizes"]] == ["box", "room"]
    assert all(re.fullmatch(r"\w+: \S+ x \S+ x \S+ m", size) for size in written["sizes"])


def test_a_scene_needs_its_folder(parts, tmp_path):
    for scene in (filled(parts), kaboum.Scene()):
        with pytest.raises(kaboum.Error, match="no folder.*absent"):
            scene.write(tmp_path / "absent" / "cell.json")
        assert not (tmp_path / "absent").exists()


def spelled(q):
    return ",".join(repr(float(v)) for v in q)


def checked(*arguments):
    """Exit code and output of kaboum-check."""
    done = subprocess.run([BIN / "kaboum-check", *map(str, arguments)], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def test_what_is_inside_is_what_the_program_says(parts, tmp_path):
    scene = filled(parts)
    vertices, faces = cube(1)
    scene.add_region("room", (vertices * [2, 2, 0.9] - [1, 1, 0.05], faces), epsilon="1%")
    scene.write(tmp_path / "cell.json")
    world = kaboum.World(tmp_path / "cell.json")
    assert world.regions == ["room"]
    answers = set()
    for what in ("arm", "arm/tool", "arm/base", "box"):
        for q in ([0, 0], [1.2, 0.1], [0.4, 0.3]):
            found = world.is_inside(what, "room", q)
            code, text = checked(tmp_path / "cell.json", "--configuration=" + spelled(q), "--inside", what + "=room", "--ignore-limits")
            assert f"{what} in room: {found.answer}\n" in text, text
            assert bool(found) == (found.answer == "inside") and found.until is None
            answers.add(found.answer)
    assert answers == {"inside", "not certainly inside"}
    assert [bool(v) for v in world.is_inside("arm", "room", [[0, 0.3], [1.5, 0]])] == [False, True]
    assert bool(world.is_inside("box", "room")) == bool(world.is_inside("box", "room", [0, 0]))
    stays = world.stays_inside("arm/tool", "room", [[1.5, 0.3], [0, 0.3]])
    (tmp_path / "path.csv").write_text("shoulder,slide\n1.5,0.3\n0,0.3\n")
    code, text = checked(tmp_path / "cell.json", "--path", tmp_path / "path.csv", "--inside", "arm/tool=room")
    assert not stays and code == 1 and f"arm/tool in room: {stays.answer} from waypoint {stays.until[0] + 1}" in text, text
    assert 0 < stays.until[1] < 1 and world.stays_inside("arm/tool", "room", [[1.5, 0.3], [1.4, 0.3]])
    for call, says in ((lambda: world.is_inside("bx", "room"), "no object, link or robot 'bx'"),
                       (lambda: world.is_inside("box", "roon"), "did you mean 'room'"),
                       (lambda: world.is_inside("box", "room", [0]), "q must be"),
                       (lambda: world.is_inside("box", "room", ["0", "0"]), "q")):
        with pytest.raises(kaboum.Error, match=says) as error:
            call()
        assert error.value.code == "invalid_argument"


def test_nearest_is_the_programs(parts, tmp_path):
    filled(parts).write(tmp_path / "cell.json")
    world = kaboum.World(tmp_path / "cell.json")
    found = world.nearest([0, 0.1])
    code, text = checked(tmp_path / "cell.json", "--configuration=0,0.1", "--distance", "--report", tmp_path / "report.json")
    report = json.loads((tmp_path / "report.json").read_text())["configurations"][0]["distance"]
    assert found == {"pair": tuple(report["pair"]), "lower": report["lower"], "upper": report["upper"]}
    assert 0 < found["lower"] <= found["upper"]
    with pytest.raises(kaboum.Error, match="one configuration"):
        world.nearest([[0, 0]])


def test_pairs_of_links_are_the_programs(parts, tmp_path):
    filled(parts).write(tmp_path / "cell.json")
    program(tmp_path, "pairs", "cell.json", "--srdf", "a.srdf", "--report", "report.json")
    report = json.loads((tmp_path / "report.json").read_text())
    pairs = kaboum.World(tmp_path / "cell.json").link_pairs()
    assert len(pairs) == len(report["pairs"]) > 0 and pairs.srdf == (tmp_path / "a.srdf").read_text()
    assert pairs.never_in_contact == report["never_in_contact"]
    for mine, theirs in zip(pairs.pairs, report["pairs"]):
        assert mine["links"] == tuple(theirs["links"]) and (mine["reason"] or "unproved") == theirs["reason"]
        assert (mine["contact_found"], mine["contact_always"]) == (theirs["contact_found"], theirs["contact_always"])

    class Enough(Exception):
        pass

    def stop(_):
        raise Enough

    with pytest.raises(Enough):
        kaboum.World(tmp_path / "cell.json").link_pairs(progress=stop)
    with pytest.raises(kaboum.Error, match="max_boxes"):
        kaboum.World(tmp_path / "cell.json").link_pairs(max_boxes=0)
