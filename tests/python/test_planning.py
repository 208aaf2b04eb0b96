"""Plans, and their check."""

import os
import subprocess
import sys

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


def test_scene(tmp_path):
    geometry = SOURCE / "examples" / "geometry"
    subprocess.run([sys.executable, geometry / "make-cell", "stacked", "3", tmp_path / "cell"], check=True,
                   env={**os.environ, "KABOUM_SCENE": os.environ["KABOUM_BIN"] + "/kaboum-scene"}, capture_output=True)
    files = SOURCE / "examples" / "scenarios" / "stacked" / "domain.kpl", tmp_path / "cell" / "problem.kpl"
    scene = tmp_path / "cell" / "cell.json"
    solution = kaboum.solve(*files, scene=scene, seed=3)
    assert solution and solution.statistics["external_calls"] > 0
    assert kaboum.check_plan(*files, solution, scene=scene)[0]
