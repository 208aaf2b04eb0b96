"""Robots, sweeps and what the verifier says of them."""

import numpy as np
import pytest

import kaboum
from conftest import ARM, cube


def test_robot(arm):
    robot = kaboum.read_robot(arm)
    assert robot.name == "arm" and robot.links == ["base", "upper", "tool"]
    assert robot.variables == ["shoulder", "slide"] and robot.limits == [(-2, 2), (0, 0.3)]
    assert robot.joints[1] == {"name": "slide", "type": "prismatic", "parent": "upper", "child": "tool"}


def test_links_are_held(arm):
    made = kaboum.certify_robot(arm, epsilon="5%")
    assert set(made.links) == {"base", "upper", "tool"}
    assert kaboum.verify_cover(arm.parent / "tool.ply", made.links["tool"])
    only = kaboum.certify_robot(kaboum.read_robot(arm), links=["tool"], epsilon=0.01)
    assert set(only.links) == {"tool"} and only.distance <= 0.01
    with pytest.raises(kaboum.Error, match="nose"):
        kaboum.certify_robot(arm, links=["nose"])


def test_sweep_holds_the_robot_at_every_instant(arm):
    path = [[0, 0], [1, 0.2], [1, 0.3]]
    swept = kaboum.sweep(arm, path, epsilon=0.02)
    assert swept.claim == "proved" and swept.margin == 0 and len(swept) == len(swept.bodies)
    assert kaboum.verify_sweep(arm, path, swept)
    refuted = kaboum.verify_sweep(arm, [[0, 0], [1.5, 0.2]], swept)
    assert refuted.answer == "refuted" and "witness" in refuted.claims["surface"]
    assert kaboum.sweep(arm, path[:2], epsilon=0.02, verify=True).claim == "decided"
    stated = kaboum.sweep(arm, path, epsilon=0.02, implicit_margin=True)
    assert 0 < stated.margin <= 0.02 and stated.set.margin == stated.margin


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
