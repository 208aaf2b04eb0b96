"""Inverse kinematics: what kaboum-ik says, in process."""

import json
import os
import pathlib
import subprocess

import numpy as np
import pytest

import kaboum
from conftest import SOURCE

BIN = pathlib.Path(os.environ["KABOUM_BIN"])


@pytest.fixture
def six(tmp_path):
    """The tutorial's arm: six axes and a spherical wrist."""
    subprocess.run([SOURCE / "examples" / "tutorial" / "make-robot", tmp_path], check=True)
    return tmp_path / "arm.urdf"


def program(*arguments):
    done = subprocess.run([BIN / "kaboum-ik", *map(str, arguments), "--json"], capture_output=True, text=True, check=False)
    return json.loads(done.stdout)


@pytest.mark.parametrize("q", [(0.3, 0.5, 1.0, 0.4, 0.9, -0.2), (0.3, 0.5, 1.0, 0.4, 0, -0.2), (0, 0, 0, 0, 0, 0)])
def test_answers_are_the_programs(six, q):
    text = ",".join(map(str, q))
    theirs = program(six, "--tip", "hand", f"--pose-of={text}")
    ours = kaboum.inverse_kinematics(six, pose_of=q, tip="hand")
    assert ours.joints == theirs["joints"] and ours.complete == theirs["complete"] and ours.family == theirs["family"]
    assert ours.solutions.shape == (len(theirs["solutions"]), 6) and bool(ours) and len(ours) == len(theirs["solutions"])
    assert ours.solutions.tolist() == [s["q"] for s in theirs["solutions"]]
    assert [d["singular"] for d in ours.details] == [s["singular"] for s in theirs["solutions"]]
    assert [f["free"] for f in ours.families] == [f["free"] for f in theirs["families"]]
    for mine, other in zip(ours.families, theirs["families"]):
        assert mine["ranges"] == [(r["joint"], r["from"], r["to"]) for r in other["ranges"]]
        assert mine["representatives"].tolist() == other["representatives"]


def test_singular_pose_is_a_family(six):
    """With j5 at 0, axes 4 and 6 are one line: a joint is free."""
    found = kaboum.inverse_kinematics(six, pose_of=[0.3, 0.5, 1.0, 0.4, 0, -0.2])
    assert found.families and all(f["free"] and f["ranges"] for f in found.families)
    assert any("wrist" in f["singular"] for f in found.families)
    for family in found.families:
        assert family["representatives"].shape[1] == 6 and len(family["representatives"]) > 1


def test_poses(six):
    by_joints = kaboum.inverse_kinematics(six, pose_of=np.array([0, 0.5, 0.7, 0, 0.4, 0]))
    x, z, a = 0.5 * np.sin(0.5) + 0.45 * np.sin(1.2), 0.35 + 0.5 * np.cos(0.5) + 0.45 * np.cos(1.2), 1.6
    turn = [[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]]
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, (x, 0, z)
    for pose in (matrix, [x, 0, z, 0, a, 0], [x, 0, z, 0, np.sin(a / 2), 0, np.cos(a / 2)]):
        found = kaboum.inverse_kinematics(six, pose)
        assert len(found) == len(by_joints) and np.allclose(found.solutions, by_joints.solutions, atol=1e-9)
    numeric = kaboum.inverse_kinematics(six, matrix, numeric=True, starts=30)
    assert numeric.family is None and not numeric.complete and numeric.incomplete
    far = kaboum.inverse_kinematics(six, [9, 0, 0])
    assert not far and far.complete and far.solutions.shape == (0, 6)


@pytest.mark.parametrize("keywords, says", [
    ({"pose": [0, 0]}, "pose"), ({}, "give pose"), ({"pose": [0, 0, 1], "pose_of": [0] * 6}, "give pose"),
    ({"pose_of": [0] * 5}, "pose_of must have a value for each"), ({"pose": [0, 0, 1], "tip": "nose"}, "nose"),
    ({"pose": [0, 0, float("nan")]}, "not finite"), ({"pose": np.array([0, 0, 2**53 + 1])}, "pose"), ({"pose": "x"}, "row of numbers"),
    ({"pose": [0, 0, 1], "free_heading": True}, "five axes"), ({"pose": np.ones((4, 4))}, "last row"),
])
def test_what_is_refused(six, keywords, says):
    with pytest.raises(kaboum.Error, match=says):
        kaboum.inverse_kinematics(six, **keywords)
