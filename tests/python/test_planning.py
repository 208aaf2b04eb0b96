"""Plans, and their check."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

import kaboum
from conftest import SOURCE


def problem_of(name, size, folder):
    """Domain and problem of an example."""
    place = SOURCE / "examples" / "domains" / name
    text = subprocess.run([sys.executable, place / "make-problem", size], check=True, capture_output=True).stdout
    (folder / "problem.kpl").write_bytes(text)
    return place / "domain.kpl", folder / "problem.kpl"


@pytest.fixture
def stacked(tmp_path):
    return problem_of("stacked", "4", tmp_path)


@pytest.fixture
def sensing(tmp_path):
    return problem_of("force-sensing", "3", tmp_path)


def test_plan_is_found_and_holds(stacked):
    solution = kaboum.solve(*stacked, search="astar")
    assert solution and solution.outcome == "solved"
    check = kaboum.check_plan(*stacked, solution)
    assert check and check.violation == "" and check.states > 0 and check.ends > 0 and check.size == solution.size
    assert kaboum.check_plan(*stacked, solution.plan)
    assert solution.text and solution.statistics["states_expanded"] > 0


def test_plan_of_another_problem_is_refuted(stacked):
    plan = kaboum.solve(*stacked).plan
    changed = stacked[1].with_name("changed.kpl")
    text = stacked[1].read_text()
    changed.write_text(text[: text.index("init:")] + "init:\n")
    try:
        check = kaboum.check_plan(stacked[0], changed, plan)
        assert not check and check.violation
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
    assert kaboum.check_plan(*files, solution, scene=scene)


def test_plans_are_the_programs(stacked, tmp_path):
    """solve and show, in process and by the program."""
    code, text = run("kaboum-plan", "solve", *stacked, "--search", "astar", "-o", tmp_path / "theirs.json")
    assert code == 0, text
    solution = kaboum.solve(*stacked, search="astar")
    solution.write(tmp_path / "ours.json")
    assert (tmp_path / "ours.json").read_bytes() == (tmp_path / "theirs.json").read_bytes()
    assert solution.size["nodes"] > 0 and solution.failed_calls == []
    for form, suffix in (("text", "txt"), ("dot", "dot"), ("svg", "svg")):
        for tree in (False, True):
            out = tmp_path / f"drawn.{suffix}"
            code, text = run("kaboum-plan", "show", *stacked, "--plan", tmp_path / "ours.json", "-o", out, *["--tree"] * tree)
            assert code == 0, text
            assert kaboum.draw_plan(*stacked, tmp_path / "ours.json", format=form, tree=tree) == out.read_text()


def test_domains_are_converted(sensing, tmp_path):
    simple = tmp_path / "simple.kpl"
    simple.write_text("types: thing\nconstants: thing a\npredicates: ready(thing)\nclosed: all\naction prepare(?o : thing)\n"
                      "  preconds: K(!ready(?o))\n  effects: add(Kf, ready(?o))\ninit: K(!ready(a))\ngoal: K(ready(a))\n")
    for files, to in (((simple,), "pddl"), ((simple,), "kpl"), (sensing, "kpl")):
        code, text = run("kaboum-plan", "convert", *files, "-o", tmp_path / f"both.{to}")
        assert code == 0, text
        assert kaboum.convert_domain(*files, to=to) == (tmp_path / f"both.{to}").read_text()
    with pytest.raises(kaboum.Error, match="PDDL cannot say"):
        kaboum.convert_domain(*sensing, to="pddl")
    with pytest.raises(kaboum.Error, match="language"):
        kaboum.convert_domain(tmp_path / "domain.txt", to="pddl")
    with pytest.raises(kaboum.Error, match="xml"):
        kaboum.convert_domain(*sensing, to="xml")
    (tmp_path / "domain.txt").write_text(simple.read_text())
    assert kaboum.convert_domain(tmp_path / "domain.txt", to="kpl", input_format="kpl") == kaboum.convert_domain(simple, to="kpl")


def test_assumptions_leave_branches_out(sensing):
    whole = kaboum.solve(*sensing)
    branch = next(line.split("[", 1)[-1].split("]")[0] for line in whole.text.splitlines() if "isSpillable" in line)
    atom = branch[branch.index("isSpillable"):].split(")")[0] + ")"
    less = kaboum.solve(*sensing, assume={atom: False})
    assert less and less.size["leaves"] < whole.size["leaves"]
    check = kaboum.check_plan(*sensing, less)
    assert not check and check.violation
    with pytest.raises(kaboum.Error, match="outcomes"):
        kaboum.solve(*sensing, assume={atom: 3})
    with pytest.raises(kaboum.Error, match="outcomes"):
        kaboum.solve(*sensing, assume=[atom])


def test_processes_answer_external_functions(stacked):
    with pytest.raises(kaboum.Error) as error:
        kaboum.solve(*stacked, processes="exit 1")
    assert error.value.code == "invalid_input"
    with pytest.raises(kaboum.Error, match="processes"):
        kaboum.solve(*stacked, processes=3)


def test_plans_are_carried_out(tmp_path):
    """As kaboum-plan run: every branch, one of a seed, one that is given; wrong plans are not good."""
    scene = make_cell(tmp_path / "cell")
    files = SOURCE / "examples" / "scenarios" / "stacked" / "domain.kpl", tmp_path / "cell" / "problem.kpl"
    solution = kaboum.solve(*files, scene=scene, seed=3)
    solution.write(tmp_path / "plan.json")
    stages = []
    done = kaboum.run_plan(*files, solution, scene=scene, rate=100, trajectories=tmp_path / "ours", progress=stages.append)
    assert done and done.problems == [] and done.replans == [] and stages
    code, text = run("kaboum-plan", "run", *files, "--scene", scene, "--plan", tmp_path / "plan.json", "--rate", "100",
                     "--trajectories", tmp_path / "theirs", "--report", tmp_path / "report.json")
    assert code == 0, text
    report = json.loads((tmp_path / "report.json").read_text())
    assert done.counts == {name: report[name] for name in done.counts}
    ours, theirs = (sorted((tmp_path / name).iterdir()) for name in ("ours", "theirs"))
    assert [f.name for f in ours] == [f.name for f in theirs] and ours
    assert all(a.read_bytes() == b.read_bytes() for a, b in zip(ours, theirs))
    one = kaboum.run_plan(*files, solution, scene=scene, rate=100, outcomes=7)
    assert one and one.counts == {**one.counts, "branches": 1, "samples": done.counts["samples"]}
    too_fast = kaboum.run_plan(*files, solution, scene=scene, rate=100, outcomes=7, time_optimal=True)
    assert "most_velocity" in too_fast.counts

    class Enough(Exception):
        pass

    def stop(_):
        raise Enough

    with pytest.raises(Enough):
        kaboum.run_plan(*files, solution, scene=scene, progress=stop)
    with pytest.raises(Enough):
        kaboum.check_plan(*files, solution, scene=scene, progress=stop)
    with pytest.raises(kaboum.Error, match="rate"):
        kaboum.run_plan(*files, solution, scene=scene, rate=0)
    with pytest.raises(kaboum.Error, match="outcomes"):
        kaboum.run_plan(*files, solution, scene=scene, outcomes=1.5)


def test_pages_are_the_programs(tmp_path):
    """write_plan_page as `show --html`, the plan as a tree too; progress, and what it refuses."""
    scene = make_cell(tmp_path / "cell")
    files = SOURCE / "examples" / "scenarios" / "stacked" / "domain.kpl", tmp_path / "cell" / "problem.kpl"
    solution = kaboum.solve(*files, scene=scene, seed=3)
    solution.write(tmp_path / "plan.json")
    for tree in (False, True):
        code, text = run("kaboum-plan", "show", *files, "--scene", scene, "--plan", tmp_path / "plan.json", "--html",
                         tmp_path / "theirs.html", *["--tree"] * tree)
        assert code == 0, text
        stages = []
        notes = kaboum.write_plan_page(tmp_path / "ours.html", *files, solution, scene=scene, tree=tree, progress=stages.append)
        assert (tmp_path / "ours.html").read_bytes() == (tmp_path / "theirs.html").read_bytes()
        assert stages and all(note in text for note in notes)

    class Enough(Exception):
        pass

    def stop(_):
        raise Enough

    with pytest.raises(Enough):
        kaboum.write_plan_page(tmp_path / "none.html", *files, solution, scene=scene, progress=stop)
    assert not (tmp_path / "none.html").exists()
    with pytest.raises(Enough):
        kaboum.draw_plan(*files, solution, scene=scene, progress=stop)
    with pytest.raises(Enough):
        kaboum.convert_domain(*files, to="kpl", progress=stop)
    with pytest.raises(kaboum.Error, match="scene"):
        kaboum.write_plan_page(tmp_path / "none.html", *files, solution, scene=None)
    with pytest.raises(TypeError, match="package_path"):
        kaboum.write_plan_page(tmp_path / "none.html", *files, solution, scene=scene, package_pat="x")


def test_run_pages_are_the_programs(tmp_path):
    """write_run_page as `kaboum-plan page`; progress, and what it refuses."""
    scene = make_cell(tmp_path / "cell")
    files = SOURCE / "examples" / "scenarios" / "stacked" / "domain.kpl", tmp_path / "cell" / "problem.kpl"
    kaboum.solve(*files, scene=scene, seed=3).write(tmp_path / "plan.json")
    journal = tmp_path / "run.jsonl"
    code, text = run("kaboum-plan", "run", *files, "--scene", scene, "--plan", tmp_path / "plan.json", "--journal", journal,
                     "--robot", f"{sys.executable} {SOURCE / 'examples' / 'drivers' / 'driver.py'}")
    assert code == 0, text
    code, text = run("kaboum-plan", "page", journal, "--scene", scene, "-o", tmp_path / "theirs.html")
    assert code == 0, text
    stages = []
    notes = kaboum.write_run_page(tmp_path / "ours.html", journal, scene=scene, progress=stages.append)
    assert (tmp_path / "ours.html").read_bytes() == (tmp_path / "theirs.html").read_bytes()
    assert stages and all(note in text for note in notes)
    damaged = tmp_path / "damaged.jsonl"
    damaged.write_text("{}\n")
    with pytest.raises(kaboum.Error, match="damaged.jsonl, line 1"):
        kaboum.write_run_page(tmp_path / "none.html", damaged, scene=scene)
    with pytest.raises(TypeError, match="package_path"):
        kaboum.write_run_page(tmp_path / "none.html", journal, scene=scene, package_pat="x")
    assert not (tmp_path / "none.html").exists()


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


def test_contacts_by_libraries_of_others(cell):
    world = kaboum.World(cell)
    home = world.home()
    rows = home + np.random.default_rng(8).uniform(-2, 2, (60, len(home)))
    own = world.contact_pairs(rows)
    assert [not pairs for pairs in own] == world.are_free(rows).tolist()
    assert world.contact_pairs(rows[0]) == own[0]
    for engine in ("fcl", "bullet", "ode"):
        try:
            said = world.contact_pairs(rows, engine=engine)
        except kaboum.Error as error:
            assert "KABOUM_WITH_" in str(error)
            continue
        # What barely touches is a matter of rounding.
        assert sum(a != b for a, b in zip(own, said)) <= 2
        for pairs, exact in zip(own, world.contact_pairs(rows, engine=engine, engine_shapes="meshes")):
            assert set(exact) <= set(pairs)
    with pytest.raises(kaboum.Error, match="engine must be own, fcl, bullet or ode"):
        world.contact_pairs(home, engine="physx")


def test_motions_in_batches_are_as_those_of_check_motion(cell, tmp_path):
    world = kaboum.World(cell)
    home = world.home()
    rng = np.random.default_rng(9)
    starts = home + rng.uniform(-2, 2, (1200, len(home)))
    goals = starts + rng.uniform(-0.5, 0.5, starts.shape)
    few = world.motions_are_free(starts[:60], goals[:60])  # by check_motion
    many = world.motions_are_free(starts, goals)  # by the vector code first
    assert few.tolist() == many[:60].tolist() and 0 < many.sum() < len(many)
    for i in range(0, len(starts), 12):
        assert bool(world.check_motion([starts[i], goals[i]])) == many[i]
    coarse = world.motions_are_free(starts, goals, resolution=0.05)
    for i in range(0, len(starts), 12):
        assert bool(world.check_motion([starts[i], goals[i]], resolution=0.05)) == coarse[i]
    # One start, and the same from files.
    assert world.motions_are_free(home, goals).tolist() == world.motions_are_free(np.tile(home, (1200, 1)), goals).tolist()
    rows = np.stack([starts, goals], axis=1).reshape(-1, len(home))
    for name, how, expected in (("rows.npy", "pairs", many), ("chain.npy", "consecutive", world.motions_are_free(goals[:-1], goals[1:]))):
        np.save(tmp_path / name, rows if how == "pairs" else goals)
        code, text = run("kaboum-check", cell, "--batch", tmp_path / name, "--motions", how, "--ignore-limits", "--verdicts", tmp_path / "v.npy")
        assert code == 1 and f"{expected.sum()} of {len(expected)} motions are free at every instant" in text, text
        assert np.load(tmp_path / "v.npy").tolist() == expected.astype(int).tolist()
    assert world.motions_are_free(starts[:0].reshape(0, len(home)), goals[:0]).shape == (0,)
    for wrong in ((starts, goals[:5]), (starts[:, :1], goals), (starts * np.nan, goals)):
        with pytest.raises(kaboum.Error):
            world.motions_are_free(*wrong)


def test_clouds_are_obstacles(cell, tmp_path):
    world = kaboum.World(cell)
    home = world.home()
    rng = np.random.default_rng(11)
    rows = home + rng.uniform(-2, 2, (60, len(home)))
    before = world.are_free(rows)
    points = rng.uniform(-1, 1, (3000, 3)) * [1, 1, 0.6] + [0, 0, 0.5]
    seen = world.with_cloud(points, 0.01, name="scan")
    assert seen.objects == world.objects + ["scan"] and "scan" not in world.objects
    after = seen.are_free(rows)
    assert (after <= before).all() and after.sum() < before.sum()
    for q, free in zip(rows, after):
        contacts = seen.check(q).pairs
        assert free == (not contacts)
        for contact in contacts:
            assert (contact["point"] is None) == ("scan" not in contact["pair"])
            if contact["point"] is not None:  # that point alone is in contact as well
                alone = world.with_cloud(points[[contact["point"] - 1]], 0.01).check(q)
                assert any("cloud" in c["pair"] for c in alone.pairs)
    np.save(tmp_path / "scan.npy", points)
    assert kaboum.World(cell).with_cloud(tmp_path / "scan.npy", 0.01).are_free(rows).tolist() == after.tolist()
    holed = np.vstack([[[np.nan, 0, 0]], points])
    with pytest.raises(kaboum.Error, match="point 1 .*drop_invalid"):
        world.with_cloud(holed, 0.01)
    assert world.with_cloud(holed, 0.01, drop_invalid=True).are_free(rows).tolist() == after.tolist()
    for wrong in (points[:, :2], points.astype(str), "nothing.xyz"):
        with pytest.raises(kaboum.Error):
            world.with_cloud(wrong, 0.01)
    for radius in (0, -1, np.nan):
        with pytest.raises(kaboum.Error, match="radius"):
            world.with_cloud(points, radius)
    with pytest.raises(kaboum.Error, match="another one"):
        seen.with_cloud(points, 0.01, name="scan")


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
    with pytest.raises(kaboum.Error, match="no path"):
        refused.trajectory()


def test_paths_query_after_query(cell, tmp_path):
    world = kaboum.World(cell)
    home = world.home()
    rng = np.random.default_rng(3)
    goals = [q for q in home + rng.uniform(-1, 1, (60, len(home))) if world.check(q)][:12]
    finder = world.path_finder()
    assert finder.nodes == 0
    with pytest.raises(kaboum.Error, match="no roadmap"):
        finder.write_roadmap(tmp_path / "map.json")
    by_trees = [finder.find_path(home, q, max_work=0.2) for q in goals]
    assert any(by_trees)
    finder.make_roadmap(nodes=100)
    assert finder.nodes == 100 and finder.edges > 0
    by_roadmap = [finder.find_path(home, q, max_work=0.2) for q in goals]
    for path in by_trees + by_roadmap:
        assert not path or world.check_motion(path.waypoints)
    finder.write_roadmap(tmp_path / "map.json")
    other = kaboum.World(cell).path_finder()
    other.read_roadmap(tmp_path / "map.json")
    assert other.nodes == 100 and other.edges == finder.edges
    for q, path in zip(goals, by_roadmap):
        assert np.array_equal(other.find_path(home, q, max_work=0.2).waypoints, path.waypoints)
    kept = [p for p in (other.find_path(home, q, keep="upright=0.8", max_work=0.1) for q in goals) if p]
    assert kept and all(world.check_motion(p.waypoints, keep="upright=0.8") for p in kept)
    # The program reads it too; of a world with a margin it is another one's.
    code, text = run("kaboum-move", cell, "--to=" + spelled(goals[0]), "-o", tmp_path / "path.csv", "--roadmap", tmp_path / "map.json")
    assert code in (0, 7), text
    with pytest.raises(kaboum.Error, match="another scene"):
        kaboum.World(cell, margin=0.01).path_finder().read_roadmap(tmp_path / "map.json")
    with pytest.raises(kaboum.Error):
        finder.find_path(home, goals[0], max_work=0)
    with pytest.raises(kaboum.Error):
        finder.make_roadmap(nodes=0)


def test_motions_keep_what_is_asked_for(cell):
    world = kaboum.World(cell)
    home = world.home()
    rng = np.random.default_rng(3)
    goals = [q for q in home + rng.uniform(-1, 1, (60, len(home))) if world.check(q)]
    tried = [(q, world.find_path(home, q, keep="upright=0.4", max_work=0.1)) for q in goals]
    kept = [path for _, path in tried if path]
    off = [(q, path) for q, path in tried if path.outcome == "goal breaks a constraint"]
    assert kept and off
    for path in kept:
        motion = world.check_motion(path.waypoints, keep=["upright=0.4"])
        assert motion and motion.kept == "kept" and motion.deviation is None
        assert path.kept.startswith("upright within 0.4 rad (") and path.broken is None
    (q, path), plain = off[0], next(p for p in (world.find_path(home, q) for q, _ in off) if p)
    assert path.broken.startswith("'upright' is off by") and not len(path)
    motion = world.check_motion(plain.waypoints, keep="upright=0.4")
    assert not motion and motion.outcome == "free" and motion.kept == "broken"
    assert motion.kept_until[1] > 0 and motion.deviation.startswith("'upright' is off by")
    assert world.check_motion(plain.waypoints).kept is None and plain.kept == ""
    far = world.pose_goals(np.diag([1, 1, 1, 1]) + 99 * np.eye(4, k=3), start=home)
    assert far.shape == (0, len(home))
    assert path.kept == "" and "broken" in repr(motion)
    with pytest.raises(kaboum.Error, match="keep"):
        world.check_motion([home, home], keep={"upright": 0.1})
    for wrong, words in ((dict(keep="uprigt"), "did you mean 'upright'"), (dict(keep="upright=0"), "above 0"),
                         (dict(keep="line", tool="nobody"), "tool")):
        with pytest.raises(kaboum.Error, match=words):
            world.check_motion([home, home], **wrong)


def test_robots_that_move_at_once(tmp_path):
    arm = """<robot name="arm"><link name="base"/><link name="bar"><collision><origin xyz="0.5 0 0"/><geometry><box
size="1 0.1 0.1"/></geometry></collision></link><joint name="j" type="revolute"><parent link="base"/><child link="bar"/><axis
xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint></robot>"""
    (tmp_path / "arm.urdf").write_text(arm)
    scene = str(tmp_path / "two.json")
    kaboum.make_scene(scene, robots={"left": str(tmp_path / "arm.urdf"), "right": str(tmp_path / "arm.urdf")},
                      at={"right": [1.5, 0, 0]})
    world = kaboum.World(scene)
    swing, follow, wait = [[1.5], [0.0]], [[1.0], [-0.5]], [[3.0], [3.0]]
    assert world.check_motion({"left": swing, "right": follow})
    met = world.check_motion({"left": swing, "right": wait})
    assert not met and sorted(met.contact["pair"]) == ["left/bar", "right/bar"]
    for wrong, words in (({"left": swing, "right": [[3.0]]}, "equally many waypoints"), ({"up": swing}, "no robot 'up'"),
                         ({}, "no robot")):
        with pytest.raises(kaboum.Error, match=words):
            world.check_motion(wrong)
    with pytest.raises(kaboum.Error, match="names the robots itself"):
        world.check_motion({"left": swing}, robot="left")


def test_margins_keep_things_apart(cell):
    world = kaboum.World(cell)
    home = world.home()
    between = world.nearest(home)["lower"]
    near = [kaboum.World(cell, margin=m) for m in (0.0, 100.0, {"": 100.0})]
    assert [bool(w.check(home)) for w in near] == [True, False, False]
    pair = near[1].check(home).pairs[0]
    assert pair["margin"] == 100 and pair["epsilon"] >= 100 and not pair["certain"] and between > 0
    (robot,), thing = world.robots, world.objects[0]
    assert not kaboum.World(cell, margin={f"{robot},{thing}": 100.0}).check(home)
    assert kaboum.World(cell, margin={"": 100.0} | {f"{robot},{o}": 0.0 for o in world.objects}).check(home)
    with pytest.raises(kaboum.Error, match="no object, robot or link 'nobody'"):
        kaboum.World(cell, margin={"nobody": 1.0})


def test_lengths_take_units(cell):
    world = kaboum.World(cell)
    home = world.home()
    (robot,), thing = world.robots, world.objects[0]
    near = kaboum.World(cell, margin={"": "10000cm", thing: 100.0, f"{robot},{thing}": "1km"})
    assert sorted(near.margins.split("; ")) == sorted(["10000cm", f"{robot},{thing}=1km", f"{thing}=100"])
    assert {c["margin"] for c in near.check(home).pairs} <= {100.0, 1000.0}
    same = [[(c["pair"], c["margin"]) for c in kaboum.World(cell, margin=m).check(home).pairs] for m in ("100m", 100)]
    assert same[0] == same[1] and same[0]
    for wrong in ("1%", "5 mm", "robot=5mm", "", -1, {"": "1%"}, {robot: "5nm"}, {robot: [1]}):
        with pytest.raises(kaboum.Error, match="margin must be"):
            kaboum.World(cell, margin=wrong)
    with pytest.raises(kaboum.Error, match="no diagonal"):
        kaboum.World(cell, margin="1%")
    points = np.random.default_rng(12).uniform(-1, 1, (300, 3))
    rows = home + np.random.default_rng(13).uniform(-2, 2, (40, len(home)))
    seen = [world.with_cloud(points, radius).are_free(rows) for radius in (0.04, "40mm", "4cm")]
    assert (seen[0] == seen[1]).all() and (seen[0] == seen[2]).all()
    for wrong in ("1%", "0mm", "40 mm", None, True, [0.04]):
        with pytest.raises(kaboum.Error, match="radius must be"):
            world.with_cloud(points, wrong)
    path = np.stack([home, home + 0.01])
    answers = [world.check_motion(path, resolution=r).outcome for r in (0.0001, "0.1mm")]
    assert answers[0] == answers[1]
    assert world.check_motion(np.stack([home, home]), keep="level=1mm")
    with pytest.raises(kaboum.Error, match="no diagonal"):
        world.check_motion(path, resolution="1%")
    with pytest.raises(kaboum.Error, match="in radians, without a unit"):
        world.check_motion(path, keep="upright=1mm")


def test_trajectories_are_those_of_the_program(cell, tmp_path):
    world = kaboum.World(cell)
    home = world.home()
    rng = np.random.default_rng(3)
    goals = [q for q in home + rng.uniform(-1, 1, (60, len(home))) if world.check(q)]
    found = next(p for p in (world.find_path(home, q) for q in goals) if p)
    stages = []
    made = found.trajectory(rate=50, max_velocity=0.5, max_acceleration={"": 2.0}, progress=stages.append)
    assert stages and len(made) == len(made.positions) and made.rate == 50
    assert np.isclose(made.duration, (len(made) - 1) / 50)
    assert np.array_equal(made.positions[0], home) and np.array_equal(made.positions[-1], found.waypoints[-1])
    assert (np.abs(made.velocities) <= 0.5 + 1e-9).all() and (np.abs(made.accelerations) <= 2 + 1e-9).all()
    assert (made.velocities[[0, -1]] == 0).all()
    steps = np.abs(np.diff(made.positions, axis=0))
    assert steps.max() <= 0.5 / 50 + 1e-9
    made.write(tmp_path / "python.csv")
    code, text = run("kaboum-move", cell, "--from=" + spelled(home), "--to=" + spelled(found.waypoints[-1]), "-o",
                     tmp_path / "path.csv", "--trajectory", tmp_path / "program.csv", "--rate", "50", "--max-velocity", "0.5",
                     "--max-acceleration", "2")
    assert code == 0, text
    assert (tmp_path / "python.csv").read_bytes() == (tmp_path / "program.csv").read_bytes()
    faster = found.trajectory(rate=50, max_velocity=0.5, max_acceleration=2.0, time_optimal=True)
    assert faster.duration < made.duration
    assert made.blends == [] and made.between_samples == [0] * len(home)
    blended = found.trajectory(rate=50, blend=0.5, max_velocity=0.5, max_acceleration=2.0, max_jerk=30.0)
    assert len(blended.blends) == len(found) and blended.between_samples == pytest.approx([3 * 2 / (16 * 50**2)] * len(home), rel=1e-12)
    assert (blended.velocities[[0, -1]] == 0).all() and (blended.accelerations[[0, -1]] == 0).all()
    for limit, order in ((0.5, 1), (2, 2), (30, 3)):
        assert np.abs(np.diff(blended.positions, order, axis=0) * 50**order).max() <= limit * (1 + 1e-6)
    for name in ("python.csv", "python.json", "python.yaml"):
        blended.write(tmp_path / name)
        code, text = run("kaboum-move", cell, "--from=" + spelled(home), "--to=" + spelled(found.waypoints[-1]), "-o",
                         tmp_path / "path.csv", "--trajectory", tmp_path / ("program" + name[6:]), "--rate", "50",
                         "--max-velocity", "0.5", "--max-acceleration", "2", "--max-jerk", "30", "--blend", "0.5")
        assert code == 0, text
        assert (tmp_path / name).read_bytes() == (tmp_path / ("program" + name[6:])).read_bytes()
    for wrong, says in (({"max_velocity": 0}, "above 0"), ({"max_velocity": {"nobody": 1}}, "no joint 'nobody'"),
                        ({"rate": 0}, "rate must be"), ({"max_jerk": 5}, "max_jerk is kept with blend"),
                        ({"blend": 0.5, "time_optimal": True}, "leave it out with blend")):
        with pytest.raises(kaboum.Error, match=says) as error:
            found.trajectory(**wrong)
        assert error.value.code == "invalid_argument"


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


def test_fingers_that_hold_something_stay(tmp_path):
    subprocess.run([sys.executable, SOURCE / "examples" / "scenarios" / "force-sensing" / "run", "2", "--fingers", "--scene-only", "--out", tmp_path], check=True,
                   env={**os.environ}, capture_output=True)
    scene = json.loads((tmp_path / "cell.json").read_text())
    scene["attachments"] = [{"object": "o1", "robot": "arm", "gripper": "fingers", "grasp": "side3"}]
    (tmp_path / "held.json").write_text(json.dumps(scene))
    world = kaboum.World(tmp_path / "held.json")
    home, there = [0, -0.5, 1.7, 0, 1.9415926535897932, 0], [2.2, -0.5, 1.7, 0, 1.9415926535897932, 0]
    path = world.find_path(None, [there + [0.0115]])  # from where it is: with the thing between its fingers
    assert path.outcome == "found"
    assert {q[-1] for q in path.waypoints} == {0.0115}
    assert world.check_motion([home + [0.0115], there + [0.0121]]).outcome == "free"
    for ask in (lambda: world.check_motion([home + [0.0115], there + [0.018]]), lambda: world.find_path(None, [there + [0.018]])):
        with pytest.raises(kaboum.Error, match="'finger' of 'arm' is at 0.018, but its gripper holds 'o1' by a grasp with 0.0115"):
            ask()
    # Many at once: refused, and not free, where paths are.
    rows = [home + [0.0115], there + [0.0121]]
    assert world.check(rows[0]) and world.are_free(rows).all() and world.motions_are_free(rows[0], rows).all()
    beyond = [home + [0.0115], there + [0.018]]
    for ask, words in ((lambda: world.check(beyond), "row 2"), (lambda: world.are_free(beyond), "row 2"), (lambda: world.motions_are_free(beyond[0], beyond), "motion 2, row 2")):
        with pytest.raises(kaboum.Error, match=f"{words}: the joint 'finger' of 'arm' is at 0.018"):
            ask()
    for grasp in (grasp for thing in scene["objects"] for grasp in thing["grasps"]):  # wherever they stop: in the neck as well
        grasp["within"] = 0.008
    (tmp_path / "loose.json").write_text(json.dumps(scene))
    loose = kaboum.World(tmp_path / "loose.json")
    assert loose.check(rows[0])  # as it is
    assert not loose.are_free(rows).any() and not loose.motions_are_free(rows[0], rows).any()
    finder = world.path_finder()
    assert finder.find_path(None, [there + [0.0115]]).outcome == "found"
    finder.make_roadmap(nodes=10)
    with pytest.raises(kaboum.Error, match="goes by no roadmap"):
        finder.find_path(None, [there + [0.0115]])
