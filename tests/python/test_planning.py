"""Plans, and their check."""

import os
import subprocess
import sys

import numpy as np
import pytest

import kaboum
from conftest import SOURCE

STACKED = SOURCE / "examples" / "domains" / "stacked"


@pytest.fixture
def stacked(tmp_path):
    """Domain and problem."""
    text = subprocess.run([sys.executable, STACKED / "make-problem", "4"], check=True, capture_output=True).stdout
    (tmp_path / "problem.kpl").write_bytes(text)
    return STACKED / "domain.kpl", tmp_path / "problem.kpl"


def test_plan_is_found_and_holds(stacked):
    solution = kaboum.solve(*stacked, search="astar")
    assert solution and solution.outcome == "solved"
    assert kaboum.check_plan(*stacked, solution) == (True, "")
    assert kaboum.check_plan(*stacked, solution.plan)[0]
    assert solution.text and solution.statistics["states_expanded"] > 0


def test_plan_of_another_problem_is_refuted(stacked):
    plan = kaboum.solve(*stacked).plan
    changed = stacked[1].with_name("changed.kpl")
    text = stacked[1].read_text()
    changed.write_text(text[: text.index("init:")] + "init:\n")
    try:
        valid, violation = kaboum.check_plan(stacked[0], changed, plan)
        assert not valid and violation
    except kaboum.Error as error:
        assert error.code == "invalid_input"


def test_damaged_plan_is_refused(stacked):
    plan = kaboum.solve(*stacked).plan
    plan["root"] = 10**6
    with pytest.raises(kaboum.Error) as error:
        kaboum.check_plan(*stacked, plan)
    assert error.value.code == "invalid_input"


def test_limits_and_errors(stacked, tmp_path):
    limited = kaboum.solve(*stacked, max_memory=1)
    assert not limited and limited.outcome == "limit" and limited.plan is None
    broken = tmp_path / "broken.kpl"
    broken.write_text("domain broken\nnonsense here\n")
    with pytest.raises(kaboum.Error, match="broken.kpl:"):
        kaboum.solve(broken)
    with pytest.raises(kaboum.Error, match="search"):
        kaboum.solve(*stacked, search="fastest")
    with pytest.raises(kaboum.Error, match="language"):
        kaboum.solve(stacked[0].with_suffix(".txt"))


def make_cell(folder):
    """A cell with an arm; its scene."""
    subprocess.run([sys.executable, SOURCE / "examples" / "geometry" / "make-cell", "stacked", "3", folder], check=True,
                   env={**os.environ, "KABOUM_SCENE": os.environ["KABOUM_BIN"] + "/kaboum-scene"}, capture_output=True)
    return folder / "cell.json"


def test_scene(tmp_path):
    make_cell(tmp_path / "cell")
    files = SOURCE / "examples" / "scenarios" / "stacked" / "domain.kpl", tmp_path / "cell" / "problem.kpl"
    scene = tmp_path / "cell" / "cell.json"
    solution = kaboum.solve(*files, scene=scene, seed=3)
    assert solution and solution.statistics["external_calls"] > 0
    assert kaboum.check_plan(*files, solution, scene=scene)[0]


@pytest.fixture(scope="module")
def cell(tmp_path_factory):
    return make_cell(tmp_path_factory.mktemp("cell") / "cell")


def run(program, *arguments):
    """Exit code and output of a program."""
    done = subprocess.run([os.environ["KABOUM_BIN"] + "/" + program, *map(str, arguments)], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def spelled(q):
    return ",".join(repr(float(v)) for v in q)


def test_world_says_what_the_programs_say(cell):
    world = kaboum.World(cell)
    (robot,), home = world.robots, world.home()
    assert len(world.variables()) == len(home) and world.objects and world.unit == "m"
    assert world.check(home) and world.check(home).pairs == []
    rng = np.random.default_rng(7)
    configurations = home + rng.uniform(-2, 2, (40, len(home)))
    checks = world.check(configurations)
    free = world.are_free(configurations)
    assert [bool(c) for c in checks] == free.tolist() and 0 < free.sum() < len(free)
    for q, check in list(zip(configurations, checks))[:8]:
        code, text = run("kaboum-check", cell, "--configuration=" + spelled(q), "--ignore-limits")
        assert (code == 0) == bool(check), text
        assert len(check) == len(check.pairs)
        for pair in check.pairs:
            assert " and ".join(pair["pair"]) in text
            assert pair["certain"] or pair["epsilon"] > 0


def test_paths_are_free_at_every_instant(cell):
    world = kaboum.World(cell)
    home = world.home()
    rng = np.random.default_rng(3)
    goals = [q for q in home + rng.uniform(-1, 1, (60, len(home))) if world.check(q)]
    found = next(p for p in (world.find_path(home, q) for q in goals) if p)
    assert found.outcome == "found" and found.goal == 0 and found.blockers is not None
    assert np.array_equal(found.waypoints[0], home) and len(found) == len(found.waypoints)
    assert world.check_motion(found.waypoints)
    again = kaboum.World(cell).find_path(home, found.waypoints[-1])
    assert np.array_equal(again.waypoints, found.waypoints)
    bad = next(q for q in home + rng.uniform(-2, 2, (200, len(home))) if not world.check(q))
    motion = world.check_motion([home, bad])
    assert not motion and motion.outcome == "contact" and motion.contact["pair"] and motion.free_until[0] == 0
    refused = world.find_path(home, bad)
    assert not refused and refused.goal is None and len(refused) == 0


def test_wrong_configurations_are_refused(cell):
    world = kaboum.World(cell)
    home = world.home()
    for call in (lambda: world.check(home[:-1]), lambda: world.check([[home]]), lambda: world.check(home * np.nan),
                 lambda: world.check([2**53 + 1] * len(home)), lambda: world.check(["0"] * len(home)),
                 lambda: world.check(home, robot="another"), lambda: world.find_path([home, home], home),
                 lambda: world.find_path(home, home, max_work=0), lambda: world.check_motion([home], resolution=0)):
        with pytest.raises(kaboum.Error) as error:
            call()
        assert error.value.code == "invalid_argument"
    with pytest.raises(kaboum.Error) as error:
        kaboum.World(cell.with_name("none.json"))
    assert error.value.code == "invalid_input"
