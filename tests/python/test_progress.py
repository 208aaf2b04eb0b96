"""Long calls say what they do, and end by Ctrl-C and by what their progress raises."""

import os
import signal
import subprocess
import threading
import time

import numpy as np
import pytest

import kaboum
from conftest import SOURCE, cube, torus


class Enough(Exception):
    pass


def stop(_):
    raise Enough


def wall(parts):
    """A world of an arm between two plates that only touch what it cannot get past."""
    scene = kaboum.Scene()
    scene.add_robot("arm", kaboum.certify_robot(parts, epsilon="5%"), home=[0, 0])
    vertices, faces = cube(1)
    for name, x in (("left", 0.3), ("right", -0.4)):
        scene.add_object(name, (vertices * [0.1, 0.1, 2] + [x, -0.05, 0.3], faces), epsilon="1%")
    return kaboum.World(scene)


@pytest.fixture
def world(arm):
    return wall(arm)


@pytest.fixture
def calls(arm, world, tmp_path):
    """Calls that take `progress`, by name."""
    ring = torus(32, 16)
    kaboum.write(ring, tmp_path / "ring.ply")
    subprocess.run([os.environ["KABOUM_BIN"] + "/bmesh-decimate", tmp_path / "ring.ply", "--vertices", "60", "--prepare", "strict", "-o",
                    tmp_path / "out.ply", "--log", tmp_path / "out.log", "--quiet"], check=True)
    subprocess.run([SOURCE / "examples" / "tutorial" / "make-robot", tmp_path / "six"], check=True)
    path = [[-0.3, 0], [0.2, 0.2], [0, 0]]
    rows = np.zeros((100, 2))
    certified = kaboum.certify_robot(arm, epsilon="5%")
    return {
        "check": lambda **k: world.check(rows, **k),
        "nearest": lambda **k: world.nearest([0, 0], **k),
        "are_free": lambda **k: world.are_free(rows, **k),
        "motions_are_free": lambda **k: world.motions_are_free(rows, rows + 0.1, **k),
        "contact_pairs": lambda **k: world.contact_pairs(rows, **k),
        "check_motion": lambda **k: world.check_motion([[0, 0], [1.5, 0]], **k),
        "find_path": lambda **k: world.find_path([0, 0], [1.8, 0.1], max_work=0.05, **k),
        "inverse_kinematics": lambda **k: kaboum.inverse_kinematics(
            tmp_path / "six" / "arm.urdf", pose_of=[0.3, 0.5, 1.0, 0.4, 0.9, -0.2], numeric=True, **k),
        "replay": lambda **k: kaboum.replay(tmp_path / "ring.ply", tmp_path / "out.log", tmp_path / "out.ply", **k),
        "sweep": lambda **k: kaboum.sweep(arm, path, epsilon=0.01, **k),
        "wrap": lambda **k: kaboum.wrap(ring, **k),
        "make_scene": lambda **k: kaboum.make_scene(tmp_path / "cell.json", robots={"arm": arm}, force=True, no_cache=True, **k),
        "cache_entries": lambda **k: kaboum.cache_entries(**k),
        "write": lambda **k: certified.write(tmp_path / "written", srdf=True, **k),
        "certify_robot": lambda **k: kaboum.certify_robot(arm, epsilon="5%", no_cache=True, **k),
    }


NAMES = ["check", "nearest", "are_free", "contact_pairs", "check_motion", "find_path", "inverse_kinematics", "replay", "sweep", "wrap", "make_scene", "certify_robot", "cache_entries", "write"]


@pytest.mark.parametrize("name", NAMES)
def test_progress_is_told_and_ends_the_call(calls, name, monkeypatch):
    stages = []
    calls[name](progress=stages.append)
    assert stages and all(isinstance(stage, str) and stage for stage in stages)
    with pytest.raises(Enough):
        calls[name](progress=stop)
    with pytest.raises(kaboum.Error, match="progress must be"):
        calls[name](progress=3)


def test_the_sweep_itself_is_told_of(arm):
    """Not only its bodies, which are in the cache the second time."""
    path = [[-0.3, 0], [0.2, 0.2], [0, 0]]
    kaboum.sweep(arm, path, epsilon=0.01)

    def stop_at_steps(stage):
        if stage.startswith(("steps of", "body")):
            raise Enough

    with pytest.raises(Enough):
        for _ in range(50):  # it is told at most twenty times a second
            kaboum.sweep(arm, np.array(path * 200), epsilon=0.001, progress=stop_at_steps)


def interrupted(call, seconds=10.0):
    """Ctrl-C half a second after the call has begun ends it soon."""
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    before = time.monotonic()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        call()
        timer.join()  # it came to its end too early
    timer.join()
    assert time.monotonic() - before < seconds


def test_interrupt_ends_the_search_for_a_path(world):
    goal = [1.8, 0.1]
    assert world.check([0, 0]) and world.check(goal)
    answer = world.find_path([0, 0], goal, max_work=0.02)
    assert not answer and answer.outcome == "work ended"
    interrupted(lambda: world.find_path([0, 0], goal, max_work=1e6, max_nodes=10**9))


def test_interrupt_ends_the_check_of_a_motion(world):
    path = [[0, 0], [0.1, 0.1]] * 100_000
    interrupted(lambda: world.check_motion(path, max_intervals=10**9))


def test_interrupt_ends_checks_of_configurations(world):
    rows = np.zeros((5_000_000, 2))
    interrupted(lambda: world.are_free(rows), 30)
    interrupted(lambda: world.check(rows), 30)


def test_interrupt_ends_inverse_kinematics(calls, tmp_path):
    interrupted(lambda: kaboum.inverse_kinematics(
        tmp_path / "six" / "arm.urdf", pose_of=[0.3, 0.5, 1.0, 0.4, 0.9, -0.2], numeric=True, starts=10**6))


def test_interrupt_ends_the_sweep(arm):
    path = np.array([[-0.3, 0], [0.2, 0.2], [0, 0]] * 1000)
    kaboum.sweep(arm, path[:3], epsilon=0.001)  # its bodies are in the cache
    interrupted(lambda: kaboum.sweep(arm, path, epsilon=0.001, no_merge=True, verify=True))
