"""Robots, sweeps and what the verifier says of them."""

import json
import os
import pathlib
import re
import subprocess

import numpy as np
import pytest

import kaboum
from conftest import ARM, cube

BIN = pathlib.Path(os.environ["KABOUM_BIN"])


def program(name, *arguments, code=0):
    done = subprocess.run([BIN / name, *map(str, arguments)], check=False, capture_output=True, text=True)
    assert done.returncode == code, done.stderr
    return done.stderr


def files_in(folder):
    return {str(f.relative_to(folder)): f.read_bytes() for f in sorted(folder.rglob("*")) if f.is_file()}


def test_robot(arm):
    robot = kaboum.read_robot(arm)
    assert robot.name == "arm" and robot.links == ["base", "upper", "tool"]
    assert robot.variables == ["shoulder", "slide"] and robot.limits == [(-2, 2), (0, 0.3)]
    assert robot.joints[1] == {"name": "slide", "type": "prismatic", "parent": "upper", "child": "tool"}


def test_joints_that_are_not_modelled(arm, tmp_path):
    """Shapes do not depend on them; motions do."""
    text = arm.read_text().replace('type="prismatic"', 'type="floating"')
    other = arm.parent / "floating.urdf"
    other.write_text(text)
    robot = kaboum.read_robot(other)
    assert robot.variables == ["shoulder"] and "'slide' is planar or floating" in robot.unmodelled[0]
    assert set(kaboum.certify_robot(robot, epsilon="5%").links) == {"base", "upper", "tool"}
    with pytest.raises(kaboum.Error, match="planar or floating"):
        kaboum.sweep(robot, [[0], [1]])
    with pytest.raises(kaboum.Error, match="NAME.xacro"):
        kaboum.read_robot(arm, xacro_args=["a:=1"])


def test_links_are_held(arm):
    made = kaboum.certify_robot(arm, epsilon="5%")
    assert set(made.links) == {"base", "upper", "tool"}
    assert kaboum.verify_cover(arm.parent / "tool.ply", made.links["tool"])
    only = kaboum.certify_robot(kaboum.read_robot(arm), links=["tool"], epsilon=0.01)
    assert set(only.links) == {"tool"} and only.distance <= 0.01
    with pytest.raises(kaboum.Error, match="nose"):
        kaboum.certify_robot(arm, links=["nose"])


def test_regions_as_the_tool(arm, tmp_path):
    """The same bytes and answers of a map in a file, a map in Python, and the programs."""
    regions = [{"name": "end", "frame": "tool", "radius": 1, "epsilon": "1%"}, {"link": "upper", "epsilon": "2%"}]
    file = tmp_path / "map.json"
    file.write_text(json.dumps({"regions": regions}))
    made = kaboum.certify_robot(arm, epsilon="10%", effort="fast", epsilon_map=regions)
    assert [(r["name"], r["links"], r["answer"], r["reached"]) for r in made.regions] == [("'end'", ["tool"], "verified", True)]
    made.write(tmp_path / "mine")
    program("bcd-decompose", arm, "-o", tmp_path / "its", "--epsilon", "10%", "--effort", "fast", "--epsilon-map", file, "--quiet")
    assert files_in(tmp_path / "mine") == files_in(tmp_path / "its")
    result = tmp_path / "mine" / "arm.urdf"
    for given in (regions, file):
        verdict = kaboum.verify_robot(arm, result, prepare=True, epsilon="10%", epsilon_map=given)
        assert verdict
        assert [s["region"] for s in verdict.claims["shapes"] if "region" in s] == ["'end'"]
    kaboum.certify_robot(arm, epsilon="10%", effort="fast").write(tmp_path / "coarse")
    coarse = kaboum.verify_robot(arm, tmp_path / "coarse" / "arm.urdf", prepare=True, epsilon="10%", epsilon_map=regions)
    assert coarse.answer == "refuted"
    spheres = tmp_path / "s.yaml"
    lengths = [{"frame": "tool", "radius": 1, "epsilon": "20mm"}]
    kaboum.write_spheres(arm, spheres, epsilon=0.05, effort="fast", epsilon_map=lengths)
    verdict = kaboum.verify_spheres(arm, spheres, epsilon_map=lengths)
    assert verdict and [r["answer"] for link in verdict.claims["links"] for r in link.get("regions", [])] == ["verified"]
    for wrong, says in (([{"frame": "nose", "radius": 1, "epsilon": 1}], "epsilon_map: region 1: robot 'arm' has no frame 'nose'"),
                        ({}, "epsilon_map must be"), ([{"frame": "tool", "epsilon": 1}], "one of radius")):
        with pytest.raises(kaboum.Error, match=says):
            kaboum.certify_robot(arm, epsilon_map=wrong)
        with pytest.raises(kaboum.Error, match=says):
            kaboum.verify_robot(arm, result, epsilon_map=wrong)
    with pytest.raises(kaboum.Error, match="epsilon_map .*epsilons"):
        kaboum.certify_robot(arm, epsilon_map=regions, epsilons={"tool": 0.1})
    # Percentages are of the largest diagonal that a shape of the link has.
    assert kaboum.verify_spheres(arm, spheres, epsilon_map=regions).answer == "refuted"
    shares = kaboum.verify_spheres(arm, spheres, epsilon_map=[{"frame": "tool", "radius": 1, "epsilon": "1000%"}])
    assert shares and [r["bound"] > 0.02 for link in shares.claims["links"] for r in link.get("regions", [])] == [True]


def test_sweep_holds_the_robot_at_every_instant(arm):
    path = [[0, 0], [1, 0.2], [1, 0.3]]
    swept = kaboum.sweep(arm, path, epsilon=0.02)
    assert swept.claim == "proved" and swept.margin == 0 and len(swept) == len(swept.bodies)
    assert kaboum.verify_sweep(arm, path, swept)
    refuted = kaboum.verify_sweep(arm, [[0, 0], [1.5, 0.2]], swept)
    assert refuted.answer == "refuted" and "witness" in refuted.claims["surface"]
    assert kaboum.sweep(arm, path[:2], epsilon=0.02, verify=True).claim == "decided"
    stated = kaboum.sweep(arm, path, epsilon=0.02, implicit_margin=True)
    assert 0 < stated.margin <= 0.02 and (stated.set.radii == stated.margin).all()


def test_motions_are_judged_as_the_program_judges_them(arm, tmp_path):
    """Where the robot stands, bodies in a URDF, and a mesh that cannot be prepared."""
    tool = os.environ["KABOUM_BIN"] + "/sweep-approx"
    (tmp_path / "p.csv").write_text("shoulder,slide\n0,0\n0.5,0.1\n")
    away = "1,2,3,0,0,1"
    subprocess.run([tool, arm, "--path", tmp_path / "p.csv", "-o", tmp_path / "swept.urdf", "--base-pose", away, "--epsilon", "0.02", "--quiet"],
                   check=True)
    judge = lambda **k: kaboum.verify_sweep(arm, tmp_path / "p.csv", tmp_path / "swept.urdf", **k)
    assert judge(base_pose=away)
    assert judge().answer == "refuted"
    with pytest.raises(kaboum.Error, match="base_pose"):
        judge(base_pose="1,2")
    vertices, faces = cube(0.1)
    kaboum.write((vertices, np.concatenate([faces[:1], faces[:1, ::-1]])), tmp_path / "tool.ply")  # a sheet
    found = judge(base_pose=away, prepare=True)
    assert any("judged as it is, for it cannot be prepared" in note for note in found.notes), found.notes
    assert "exact_points" not in found.claims


def test_parts_that_are_inside_out_are_not_called_held(tmp_path):
    """A large cube and a small one whose normals point inwards: as it is, its inside is in no solid."""
    vertices, faces = cube()
    both = np.concatenate([3 * vertices, vertices + 10]), np.concatenate([faces, faces[:, ::-1] + 8])
    kaboum.write(both, tmp_path / "part.off")
    (tmp_path / "r.urdf").write_text(
        '<robot name="r"><link name="base"><collision><geometry><mesh filename="part.off"/></geometry></collision></link>'
        '<link name="tip"/><joint name="j" type="prismatic"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/>'
        '<limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>')
    plates = []
    for axis in range(3):
        for side in (0, 1):
            size, low = np.full(3, 1.02), np.full(3, 9.99)
            size[axis], low[axis] = 0.02, 10 + side - 0.01
            plates.append((vertices * size + low, faces))
    bodies = [(3.02 * vertices - 0.01, faces), *plates]
    found = kaboum.verify_sweep(tmp_path / "r.urdf", [[0], [1]], bodies)
    assert found.answer == "undecided" and found.claims["surface"]["answer"] == "verified"
    assert "inside out" in found.claims["solid"]["reason"]
    assert kaboum.verify_sweep(tmp_path / "r.urdf", [[0], [1]], bodies, prepare=True).answer == "refuted"


def test_paths(arm, tmp_path):
    (tmp_path / "p.csv").write_text("shoulder,slide\n0,0\n20,0.1\n")
    assert kaboum.sweep(arm, tmp_path / "p.csv", degrees=True, epsilon=0.02).bytes == \
        kaboum.sweep(arm, [[0, 0], [20, 0.1]], degrees=True, epsilon=0.02).bytes
    for path in ([[0, 0, 0]], [0, 0], [], "absent.csv", [[0, 9]]):
        with pytest.raises(kaboum.Error):
            kaboum.sweep(arm, path)
    assert kaboum.sweep(arm, [[0, 9]], ignore_limits=True)
    with pytest.raises(kaboum.Error, match="length"):
        kaboum.sweep(arm, [[0, 0]], epsilon="1%")


@pytest.mark.parametrize("options", [
    {},
    {"epsilon": 0.02, "body_epsilon": "5%", "effort": "fast", "max_vertices_per_body": 12, "unit": "mm"},
    {"epsilon": 0.02, "bound": "adaptive", "simplify": 0.25, "max_reach": 1, "no_merge": True, "implicit_margin": True},
    {"epsilon": 0.02, "links": ["tool", "upper"], "base_pose": "1,2,3", "drop_sheets": True, "package_path": ["."]},
])
def test_sweeps_have_the_bytes_of_the_program(arm, tmp_path, options):
    (tmp_path / "p.csv").write_text("shoulder,slide\n0,0\n0.5,0.1\n")
    arguments = []
    for name, value in options.items():
        arguments.append("--" + name.replace("_", "-"))
        if value is not True:
            arguments.append(",".join(value) if isinstance(value, list) else value)
    program("sweep-approx", arm, "--path", tmp_path / "p.csv", "-o", tmp_path / "p.glb", *arguments)
    assert kaboum.sweep(arm, tmp_path / "p.csv", **options).bytes == (tmp_path / "p.glb").read_bytes()


def test_joints_without_a_column(arm, tmp_path):
    (tmp_path / "p.csv").write_text("shoulder\n0\n20\n")
    program("sweep-approx", arm, "--path", tmp_path / "p.csv", "-o", tmp_path / "p.glb", "--epsilon", 0.02,
            "--joint", "slide=0.1", "--degrees")
    swept = kaboum.sweep(arm, tmp_path / "p.csv", epsilon=0.02, joint={"slide": 0.1}, degrees=True)
    assert swept.bytes == (tmp_path / "p.glb").read_bytes()
    with pytest.raises(kaboum.Error, match="joint must be a dict"):
        kaboum.sweep(arm, tmp_path / "p.csv", joint="slide=0.1")


def test_notes_name_options_as_keywords(arm, tmp_path):
    (tmp_path / "p.csv").write_text("shoulder,slide\n13,0\n13.01,0\n")
    notes = kaboum.sweep(arm, tmp_path / "p.csv", epsilon=0.02, ignore_limits=True).notes
    assert any("if these are degrees, give degrees" in note for note in notes) and "«" not in "".join(notes), notes


def test_robot_held_by_a_robot(arm, tmp_path):
    hull = kaboum.decompose(arm.parent / "tool.ply", max_bodies=1)
    hull.write(tmp_path / "hull.obj")
    safe = tmp_path / "safe.urdf"
    safe.write_text(ARM.replace("tool.ply", "hull.obj"))
    verdict = kaboum.verify_robot(arm, safe, epsilon="60%")
    assert verdict and len(verdict.claims["shapes"]) == 4
    assert not kaboum.verify_robot(arm, safe, epsilon="1%")
    assert not kaboum.verify_robot(safe, arm)  # the ring holds no hull of itself
    kaboum.write((0.5 * hull.bodies[0].vertices, hull.bodies[0].faces), tmp_path / "hull.obj")
    assert kaboum.verify_robot(arm, safe).answer == "refuted"
    other = tmp_path / "other.urdf"
    other.write_text(ARM.replace('axis xyz="0 1 0"', 'axis xyz="1 0 0"'))
    moved = kaboum.verify_robot(arm, other)
    assert moved.answer == "refuted" and moved.claims["joints"]["reason"]


def test_one_bad_mesh_is_named(arm):
    bad = arm.parent / "bad.urdf"
    text = arm.read_text()
    at = text.index("tool.ply")
    bad.write_text(text[:at] + "broken.off" + text[at + len("tool.ply"):])
    (arm.parent / "broken.off").write_text("OFF\n1 0 0\n0 0 0\n")
    with pytest.raises(kaboum.Error, match="broken.off"):
        kaboum.certify_robot(bad, epsilon="5%")
    made = kaboum.certify_robot(bad, epsilon="5%", partial=True)
    assert set(made.links) == {"base", "upper"}
    assert [(link, verdict) for link, verdict, _ in made.verdicts] == [
        ("base", "held"), ("upper", "held"), ("tool", "kept")]
    assert "broken.off" in made.verdicts[2][2]
    # Two triangles back to back bound nothing: they are wrapped, and inside.
    (arm.parent / "broken.off").write_text("OFF\n3 2 0\n0 0 0\n.1 0 0\n0 .1 0\n3 0 1 2\n3 0 2 1\n")
    made = kaboum.certify_robot(bad, epsilon="5%")
    assert all(verdict == "held" for _, verdict, _ in made.verdicts)
    assert kaboum.verify_cover(arm.parent / "broken.off", made.links["tool"])


VISUAL = ARM.replace('<link name="tool">', '<link name="tool"><visual><geometry><mesh filename="tool.ply"/></geometry></visual>')


@pytest.mark.parametrize("options, keywords", [
    ([], {}),
    (["--robot-format", "mjcf,sdf", "--srdf"], {"formats": ["mjcf", "sdf"], "srdf": True}),
    (["--for", "drake"], {"loader": "drake"}),
    (["--for", "moveit", "--mesh-prefix", "package://x"], {"loader": "moveit", "mesh_prefix": "package://x"}),
    (["--for", "gazebo", "--robot-format", "mjcf"], {"loader": "gazebo", "formats": "mjcf"}),
])
def test_folder_is_the_programs(arm, tmp_path, options, keywords):
    """Python and bcd-decompose write the same bytes under the same names."""
    arm.write_text(VISUAL)
    program("bcd-decompose", arm, "-o", tmp_path / "by-program", "--epsilon", "5%", *options)
    made = kaboum.certify_robot(arm, epsilon="5%")
    written = made.write(tmp_path / "by-python", **keywords)
    program_files, python_files = files_in(tmp_path / "by-program"), files_in(tmp_path / "by-python")
    assert program_files.keys() == python_files.keys()
    assert [name for name in program_files if program_files[name] != python_files[name]] == []
    assert set(written["links"]) == {f"links/{link}.glb" for link in ("base", "upper", "tool")}
    assert pathlib.Path(written["documents"][0]) == tmp_path / "by-python" / "arm.urdf"
    assert all(pathlib.Path(d).is_file() for d in written["documents"])
    if "mesh_prefix" not in keywords:
        assert kaboum.verify_robot(arm, tmp_path / "by-python" / "arm.urdf")


def test_robot_options_are_the_programs(arm, tmp_path):
    """Every option reaches the sets, and their records."""
    (tmp_path / "e.yaml").write_text("tool: 3%\n")
    program("bcd-decompose", arm, "-o", tmp_path / "a", "--epsilon", "5%", "--effort", "fast", "--min-thickness", "0.001",
            "--max-vertices-per-body", "32", "--epsilons", tmp_path / "e.yaml", "--simplify", "0.2")
    kaboum.certify_robot(arm, epsilon="5%", effort="fast", min_thickness=0.001, max_vertices_per_body=32,
                         epsilons={"tool": "3%"}, simplify=0.2).write(tmp_path / "b")
    assert files_in(tmp_path / "a") == files_in(tmp_path / "b")
    program("bcd-decompose", arm, "-o", tmp_path / "c", "--robot-bodies", "20")
    made = kaboum.certify_robot(arm, robot_bodies=20)
    made.write(tmp_path / "d")
    assert files_in(tmp_path / "c") == files_in(tmp_path / "d")
    assert sum(len(link) for link in made.links.values()) <= 20
    for wrong, says in (({"epsilons": {"nose": 1}}, "nose"), ({"epsilons": {"tool": -1}}, "epsilons"),
                        ({"robot_bodies": 20, "epsilon": 1}, "epsilon means nothing"), ({"effort": "fats"}, "fast")):
        with pytest.raises(kaboum.Error, match=says):
            kaboum.certify_robot(arm, **wrong)
    with pytest.raises(TypeError, match="max_bodies"):
        kaboum.certify_robot(arm, max_bodie=3)


def test_folders_of_others_are_left(arm, tmp_path):
    made = kaboum.certify_robot(arm, epsilon="5%")
    with pytest.raises(kaboum.Error, match="overwrite the input"):
        made.write(arm.parent)
    (tmp_path / "theirs").mkdir()
    (tmp_path / "theirs" / "arm.urdf").write_text("<robot/>")
    with pytest.raises(kaboum.Error, match="remove it") as error:
        made.write(tmp_path / "theirs")
    assert error.value.code == "output_failed" and (tmp_path / "theirs" / "arm.urdf").read_text() == "<robot/>"
    with pytest.raises(kaboum.Error, match="did you mean 'gazebo'"):
        made.write(tmp_path / "new", loader="gazeboo")
    with pytest.raises(kaboum.Error, match="mjcf"):
        made.write(tmp_path / "new", formats="mjfc")
    assert not (tmp_path / "new").exists()


def test_what_is_kept_is_written_as_the_program_does(arm, tmp_path):
    (arm.parent / "tool.ply").write_bytes(b"nothing")
    program("bcd-decompose", arm, "-o", tmp_path / "a", "--epsilon", "5%", code=1)
    made = kaboum.certify_robot(arm, epsilon="5%", partial=True)
    made.write(tmp_path / "b")
    assert files_in(tmp_path / "a") == files_in(tmp_path / "b")


def test_pairs_of_some_links_are_refused(arm, tmp_path):
    """Links that were not asked for are no frames without shapes, across which others would be adjacent."""
    for links in (["base", "tool"], ["base", "upper", "tool"]):
        made = kaboum.certify_robot(arm, epsilon="5%", links=links)
        with pytest.raises(kaboum.Error, match="all links") as error:
            made.write(tmp_path / "new", srdf=True)
        assert error.value.code == "invalid_argument" and not (tmp_path / "new").exists()
    made.write(tmp_path / "new")


SHOWN = """<robot name="r">
  <link name="base"><visual><geometry><box size="0.2 0.2 0.1"/></geometry></visual></link>
  <link name="turned"><visual><geometry><mesh filename="tool.ply"/></geometry></visual></link>
  <link name="tip"><visual><origin xyz="0 0 0.02"/><geometry><box size="0.1 0.1 0.1"/></geometry></visual></link>
  <joint name="j" type="revolute"><parent link="base"/><child link="turned"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="k" type="fixed"><parent link="turned"/><child link="tip"/></joint>
</robot>
"""


def test_links_that_could_not_be_held_are_no_frames(arm, tmp_path):
    """By shapes for drawing: base and tip are adjacent only where the link between them has no shape."""
    shown = tmp_path / "shown.urdf"
    shown.write_text(SHOWN)

    def pairs(folder):
        text = (folder / "shown.srdf").read_text()
        return set(re.findall(r'link1="(\w+)" link2="(\w+)" reason="(\w+)"', text))

    kaboum.certify_robot(shown, geometry="visual", epsilon="5%").write(tmp_path / "all", srdf=True)
    assert pairs(tmp_path / "all") == {("base", "turned", "Adjacent"), ("turned", "tip", "Adjacent")}
    (arm.parent / "tool.ply").write_bytes(b"nothing")
    some = kaboum.certify_robot(shown, geometry="visual", epsilon="5%", partial=True)
    assert set(some.links) == {"base", "tip"}
    some.write(tmp_path / "some", srdf=True)
    assert pairs(tmp_path / "some") == pairs(tmp_path / "all")
    program("bcd-decompose", shown, "-o", tmp_path / "by-program", "--visual", "--epsilon", "5%", "--srdf", code=1)
    assert files_in(tmp_path / "by-program") == files_in(tmp_path / "some")


def test_a_function_that_raises_ends_the_work(arm):
    class Enough(Exception):
        pass

    def stop(_):
        raise Enough

    with pytest.raises(Enough):
        kaboum.certify_robot(arm, epsilon="0.5%", no_cache=True, progress=stop)


@pytest.mark.parametrize("options, keywords, writing", [
    ((), {}, {}),
    (("--for", "mujoco"), {}, {"loader": "mujoco"}),
    (("--robot-format", "sdf", "--output-format", "obj", "--prepare", "wrap", "--links", "tool"),
     {"output_format": "obj", "prepare": "wrap", "links": ["tool"]}, {"formats": "sdf"}),
])
def test_decimated_robot_is_the_programs(arm, tmp_path, options, keywords, writing):
    """Python and bmesh-decimate write the same bytes under the same names."""
    program("bmesh-decimate", arm, "-o", tmp_path / "by-program", "--epsilon", "5%", *options)
    made = kaboum.decimate_robot(arm, epsilon="5%", **keywords)
    assert made and [v[1] for v in made.verdicts] == ["held"] * len(made.verdicts)
    assert [m["flaw"] for m in made.meshes] == [""] and 0 < made.distance < 0.1
    assert made.meshes[0]["mesh"].vertices.shape[1] == 3 and made.meshes[0]["report"]["claims"]
    written = made.write(tmp_path / "by-python", **writing)
    assert files_in(tmp_path / "by-program") == files_in(tmp_path / "by-python")
    assert pathlib.Path(written["documents"][0]) == tmp_path / "by-python" / "arm.urdf" and written["links"] == []
    assert kaboum.verify_robot(arm, tmp_path / "by-python" / "arm.urdf", prepare="wrap" if "prepare" in keywords else "auto")


def test_decimation_of_robots_refuses_and_ends(arm, tmp_path):
    for wrong, says in (({"vertices": [100, 50]}, "no series"), ({"epsilon": "5%", "output_format": "ply"}, "stl or obj"),
                        ({"epsilon": "5%", "output_format": "stl", "precision": "double"}, "float32"), ({}, "epsilon"),
                        ({"epsilon": "5%", "epsilons": {"nose": 1}}, "nose"), ({"epsilon": "5%", "links": ["nose"]}, "nose")):
        with pytest.raises(kaboum.Error, match=says) as error:
            kaboum.decimate_robot(arm, **wrong)
        assert error.value.code == "invalid_argument"
    with pytest.raises(TypeError, match="direction"):
        kaboum.decimate_robot(arm, epsilon="5%", direction="inner")
    bad = arm.parent / "bad.urdf"
    bad.write_text(arm.read_text().replace('<box size="0.1 0.1 0.5"/>', '<mesh filename="broken.off"/>'))
    (arm.parent / "broken.off").write_text("OFF\n1 0 0\n0 0 0\n")
    with pytest.raises(kaboum.Error, match="broken.off"):
        kaboum.decimate_robot(bad, epsilon="5%")
    some = kaboum.decimate_robot(bad, epsilon="5%", partial=True)
    assert not some and {v[0]: v[1] for v in some.verdicts}["upper"] == "kept" and any("broken.off" in n for n in some.notes)

    class Enough(Exception):
        pass

    def stop(_):
        raise Enough

    with pytest.raises(Enough):
        kaboum.decimate_robot(arm, epsilon="5%", no_cache=True, progress=stop)


def test_spheres_are_written_judged_and_repaired(arm, tmp_path):
    """The same bytes as the program's; less of them is refuted, with a place; repaired they hold again."""
    made = kaboum.write_spheres(arm, tmp_path / "arm.yaml", epsilon=0.05, effort="fast")
    assert made["spheres"] > 2 and 0 < made["mean_reach"] <= made["reach"] <= 0.05
    program("bcd-decompose", arm, "-o", tmp_path / "program.yaml", "--bodies", "spheres", "--epsilon", 0.05, "--effort", "fast")
    assert (tmp_path / "arm.yaml").read_bytes() == (tmp_path / "program.yaml").read_bytes()
    for inputs in ({}, {"pairs": tmp_path / "arm.yaml"}):
        with pytest.raises(kaboum.Error, match="would be overwritten"):
            kaboum.write_spheres(arm, arm if not inputs else tmp_path / "arm.yaml", epsilon=0.05, **inputs)
    verdict = kaboum.verify_spheres(arm, tmp_path / "arm.yaml")
    assert verdict and [link["link"] for link in verdict.claims["links"]] == ["base", "upper", "tool"]
    assert verdict.claims["share_outside"] == (0, 0)
    assert kaboum.verify_spheres(arm, tmp_path / "arm.yaml", epsilon="5cm")
    far = kaboum.verify_spheres(arm, tmp_path / "arm.yaml", epsilon=0.001)
    assert far.answer == "refuted" and "refuted" in [link["distance"] for link in far.claims["links"]]
    with pytest.raises(kaboum.Error, match="percentage"):
        kaboum.verify_spheres(arm, tmp_path / "arm.yaml", epsilon="1%")

    text = (tmp_path / "arm.yaml").read_text()
    radius = re.search(r'radius"?: ([0-9.e-]+)', text)
    (tmp_path / "less.yaml").write_text(text[: radius.start(1)] + str(0.5 * float(radius[1])) + text[radius.end(1):])
    less = kaboum.verify_spheres(arm, tmp_path / "less.yaml")
    assert less.answer == "refuted"
    wrong = [link for link in less.claims["links"] if link["answer"] == "refuted"]
    assert len(wrong) == 1 and len(wrong[0]["missed"]) == 3 and wrong[0]["depth"] > 0 and wrong[0]["share_outside"][1] > 0
    mended = kaboum.repair_spheres(arm, tmp_path / "less.yaml", tmp_path / "mended.yaml", epsilon=0.05, effort="fast")
    assert sum(link["kept"] for link in mended["links"]) >= made["spheres"] - 2
    assert kaboum.verify_spheres(arm, tmp_path / "mended.yaml")

    few = kaboum.write_spheres(arm, tmp_path / "few.xrdf", robot_bodies=12, share="mean", effort="fast")
    assert few["spheres"] <= 12 and kaboum.verify_spheres(arm, tmp_path / "few.xrdf")
    # Pairs that need no check, as the program writes them.
    program("kaboum-pairs", arm, "--srdf", tmp_path / "pairs.srdf")
    for name in ("paired.yaml", "paired.xrdf", "paired.srdf"):
        paired = kaboum.write_spheres(arm, tmp_path / name, epsilon=0.05, effort="fast", pairs=tmp_path / "pairs.srdf")
        assert paired["notes"] == []
        program("bcd-decompose", arm, "-o", tmp_path / ("program-" + name), "--bodies", "spheres", "--epsilon", 0.05,
                "--effort", "fast", "--pairs", tmp_path / "pairs.srdf")
        written = (tmp_path / name).read_bytes()
        assert b"upper" in written and written == (tmp_path / ("program-" + name)).read_bytes()
    assert 'self_collision_ignore:\n  "base": ["upper"' in (tmp_path / "paired.yaml").read_text()
    with pytest.raises(kaboum.Error, match="have a place in .yaml"):
        kaboum.write_spheres(arm, tmp_path / "x.urdf", epsilon=0.05, pairs=tmp_path / "pairs.srdf")
    (tmp_path / "other.srdf").write_text('<robot name="r"><disable_collisions link1="nose" link2="ear"/></robot>')
    with pytest.raises(kaboum.Error, match="are they another robot's"):
        kaboum.write_spheres(arm, tmp_path / "x.yaml", epsilon=0.05, pairs=tmp_path / "other.srdf")

    with pytest.raises(kaboum.Error, match="one of epsilon and robot_bodies"):
        kaboum.write_spheres(arm, tmp_path / "x.yaml")
    with pytest.raises(kaboum.Error, match="written to .yaml"):
        kaboum.write_spheres(arm, tmp_path / "x.txt", epsilon=0.05)
    (tmp_path / "one.yaml").write_text("collision_spheres:\n  base:\n    - center: [0, 0, 0]\n      radius: 9\n")
    one = kaboum.verify_spheres(arm, tmp_path / "one.yaml", epsilon=20)
    assert one.answer == "refuted" and one.claims["uncovered"] == ["upper", "tool"]
    assert [link.get("distance") for link in one.claims["links"]] == ["verified", None, None]
    cut = (tmp_path / "arm.yaml").read_text().splitlines(keepends=True)[:-2]
    (tmp_path / "cut.yaml").write_text("".join(cut))
    with pytest.raises(kaboum.Error, match="is the file cut"):
        kaboum.verify_spheres(arm, tmp_path / "cut.yaml")
    with pytest.raises(kaboum.Error, match="no link 'nose'"):
        (tmp_path / "nose.yaml").write_text("collision_spheres:\n  nose:\n    - center: [0, 0, 0]\n      radius: 1\n")
        kaboum.verify_spheres(arm, tmp_path / "nose.yaml")
