"""Tests of reproduce/, with the real programs on the project's bracket.

    python3 reproduce_test.py FOLDER-OF-PROGRAMS
"""

import contextlib
import copy
import csv
import dataclasses
import io
import json
import os
import pathlib
import re
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "reproduce"))
sys.dont_write_bytecode = True

import author  # noqa: E402
import executions  # noqa: E402
import gains  # noqa: E402
import illustrations  # noqa: E402
import keep  # noqa: E402
import lines  # noqa: E402
import main  # noqa: E402
import meshes  # noqa: E402
import models  # noqa: E402
import report  # noqa: E402
import scenarios  # noqa: E402
import sets  # noqa: E402
import sweeps  # noqa: E402
import thesis  # noqa: E402
from document import Document  # noqa: E402
from runs import Run, Runner  # noqa: E402

PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()
BRACKET = models.own(ROOT)[0]
# Sections that take long, and say of the programs what other tests do.
SLOW = {"ring", "collisions", "sampling", "circular-rearrange", "stacked", "assembly", "exact-meshes", "whole-searches", "engine-searches", "remove", "executions", "simplifiers",
        "wraps", "motions", "figure-5-3"}


class Thesis(unittest.TestCase):
    def test_both_tables_agree_where_they_print_the_same_runs(self):
        outer = {(r.model, r.vertices): r.mm for r in thesis.table_4_2() if r.direction == "outer"}
        again = {(r.model, r.vertices): r.mm for r in thesis.table_b_1() if r.cost == "planes-adapted"}
        self.assertEqual(outer, again)
        self.assertEqual(len(outer), 12)

    def test_vertices_within(self):
        rows = [r for r in thesis.table_4_2() if (r.model, r.direction) == ("COMAU", "outer")]
        n = thesis.vertices_within(rows, 1)
        self.assertTrue(11000 < n < 11500, n)  # the text: "roughly 11,000 vertices needed"
        self.assertEqual(thesis.vertices_within(rows, 100), 2500)
        self.assertIsNone(thesis.vertices_within(rows, 1e-6))
        # On a line of the table: that line.
        self.assertEqual(thesis.vertices_within(rows, rows[1].percent["hausdorff"]), 10000)


class Planning(unittest.TestCase):
    def test_tables(self):
        said = thesis.by_search("table-6-2.csv")
        self.assertEqual(said["actions_in_plan", "breadth_first"], "10.66 ± 0.47")
        self.assertEqual({key for key, _ in said}, set(scenarios.QUANTITIES) - {"waypoints_in_plan", *scenarios.VOLUMES})
        bounded = thesis.by_search("table-6-7.csv", geometry="bounded_0.02m", library="Bullet")
        self.assertEqual({key for key, _ in bounded}, set(scenarios.QUANTITIES) - set(scenarios.VOLUMES))
        self.assertLessEqual(set(scenarios.TABLE_IV.values()), set(thesis.planning("table-iv.csv")[0]))
        ratios = {(library, search): ratio for library, search, ratio in thesis.exact_ratios()}
        self.assertAlmostEqual(ratios["Bullet", "depth_first"], 11.874 / 0.713)
        self.assertTrue(all(16 < r < 45 for r in ratios.values()), ratios)
        self.assertEqual({r["case"] for r in thesis.planning("table-iv.csv")}, {"random", "worst"})

    def test_statistics(self):
        payload = '[{"robot": "arm", "path": [[0], [1], [2]]}, {"robot": "arm", "path": [[2]]}]'
        plan = {"nodes": [{"calls": [{"payload": payload}, {"payload": "no json"}, {}]}, {"branch": "p"}]}
        solve = {"geometry": {"ik_calls": 7, "ik_s": 0.5, "predicate_calls": 40, "positive": 10, "path_s": 1.0,
                              "volumes": 2, "volume_s": 0.2, "volume_triangles": 96, "volume_bodies": 6, "volume_tests": 5,
                              "volume_test_s": 0.1},
                 "statistics": {"external_s": 1.6, "states_kept": 9}, "plan": {"longest_path": 3},
                 "resources": {"user_seconds_searching": 1.0, "wall_seconds": 2.0}}
        found = scenarios.statistics_of(solve, plan)
        self.assertEqual(list(found), list(scenarios.QUANTITIES))
        self.assertEqual([round(v, 9) for v in found.values()], [1, 0.2, 0.8, 7, 0.25, 40, 0.5, 25, 9, 3, 2, 0.5, 0.1, 96, 6, 5, 0.05])

    def test_lines_of_the_benchmark(self):
        line = "FCL on the exact meshes                        mean      3.70 us, median      0.10, 99 %     44.00, most    120.00 (4.6 times)"
        found = scenarios.LINE.match(line)
        self.assertEqual((found["what"], found["mean"], found["late"], found["times"]), ("FCL on the exact meshes", "3.70", "44.00", "4.6"))


class Runs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def execute(self, run, **options):
        runner = Runner(PROGRAMS, self.folder, **options)
        with contextlib.redirect_stderr(io.StringIO()):
            runner.run_all([run, run])
        return runner

    def test_second_run_is_kept_and_damage_is_noticed(self):
        run = Run(BRACKET, "outer", "planes", vertices=300)
        first = self.execute(run)
        self.assertEqual((first.executed, first.failures), (1, {}))
        row = first.results[run]
        self.assertEqual(row["vertices"], 300)
        self.assertLess(row["mean"], row["hausdorff_lower"])
        self.assertLessEqual(row["hausdorff_lower"], row["hausdorff"])
        second = self.execute(run)
        self.assertEqual(second.executed, 0)
        self.assertEqual(second.results[run], row)
        mesh = pathlib.Path(row["mesh"])
        for damage in (lambda: mesh.write_bytes(mesh.read_bytes()[:-1]), mesh.unlink,
                       lambda: (mesh.parent / "distance.json").write_text("{"),
                       lambda: (mesh.parent / "run.json").write_text("[]")):
            damage()
            again = self.execute(run)
            self.assertEqual(again.executed, 1)
            self.assertEqual(again.results[run]["hausdorff"], row["hausdorff"])
        other = self.execute(Run(BRACKET, "outer", "planes", vertices=301))
        self.assertEqual(other.executed, 1)

    def test_a_failed_run_says_why_and_is_kept(self):
        path = self.folder / "bad.obj"
        path.write_text("v 0 0 0\nf 1 2 3\n")
        run = Run(models.Model("bad", "bad", path), "outer", "planes", vertices=10)
        for calls, options in ((1, {}), (0, {}), (0, {"limit": 100}), (1, {"limit": 1000}), (1, {"retry": True}), (0, {})):
            with mock.patch.object(Runner, "_call", autospec=True, side_effect=Runner._call) as called:
                runner = self.execute(run, **options)
            self.assertEqual(called.call_count, calls, options)
            self.assertEqual(runner.results, {})
            self.assertIn("bad.obj", runner.failures[run])
        path.write_bytes(BRACKET.path.read_bytes())
        limited = Runner(PROGRAMS, self.folder, limit=1)
        slow = Run(BRACKET, "inner", "distance", epsilon=0.001)
        original, limited._call = limited._call, None

        def impatient(program, *arguments, **options):
            limited.limit = 0
            return original(program, *arguments, **options)
        limited._call = impatient
        with contextlib.redirect_stderr(io.StringIO()):
            limited.run_all([slow])
        self.assertIn("CPU limit", limited.failures[slow])


class Report(unittest.TestCase):
    def test_every_program_is_built(self):
        script = (ROOT / "scripts/reproduce-thesis").read_text()
        built = set(re.search(r"--target ((?:[a-z-]+|\\\n|\s)+)", script)[1].replace("\\", " ").split())
        run = {name for file in (ROOT / "reproduce").glob("*.py") for name in re.findall(r'programs / "([a-z-]+)"', file.read_text())}
        self.assertGreater(len(run), 5)
        self.assertLessEqual(run, built)

    def test_document(self):
        document = Document("a < b")
        document.table(["n", "by"], [["1,000", "x | y & z"]])
        self.assertIn("a &lt; b", document.html())
        self.assertIn("x | y &amp; z", document.html())
        self.assertIn("| ---: | --- |", document.markdown("."))
        self.assertIn(r"x \| y & z", document.markdown("."))

    def test_quick_on_own_mesh(self):
        series, report.SERIES = report.SERIES, (625,)
        self.addCleanup(setattr, report, "SERIES", series)
        meshes = os.environ.pop("KABOUM_MESHES", None)
        if meshes is not None:
            self.addCleanup(os.environ.__setitem__, "KABOUM_MESHES", meshes)
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            sections = [s for s in report.SECTIONS if s not in SLOW | report.NOT_QUICK]
            arguments = ["--quick", "--out", name, "--programs", str(PROGRAMS), "--sections", ",".join(sections)]
            said = io.StringIO()
            with contextlib.redirect_stderr(io.StringIO()), contextlib.redirect_stdout(said):
                self.assertEqual(main.main(arguments), 0)
                self.assertEqual(main.main(arguments), 0)
            self.assertIn(" 0 runs done", said.getvalue())
            self.check_results(folder)
            page = (folder / "index.html").read_text()
            self.assertIn("Swept volumes", page)
            self.assertIn("Left out: the robots", page)
            # One part, a segmentation and a bounding set, none with figures of the thesis.
            with open(folder / "table-4-3.csv", newline="") as file:
                stages = list(csv.DictReader(file))
            self.assertEqual([(row["stage"], row["by"]) for row in stages],
                             [("hulls", "parts of the mesh"), ("segmentation", "planes"), ("bounding", "planes")])
            for row in stages:
                self.assertLessEqual(int(row["bodies"]), 6)
                self.assertLessEqual(float(row["a2o_mean_percent"]), float(row["a2o_max_percent"]))
                self.assertEqual(row["verdict"], "verified")
            self.assertLessEqual(int(stages[2]["vertices"]), 60)
            # What is far from the solid is about as far from its surface: cavities are filled, too.
            self.assertLessEqual(float(stages[2]["a2o_max_percent"]),
                                 1.01 * float(stages[2]["union_to_solid_percent"]) + 0.01)
            self.assertIn("taken apart", page)
            self.assertIsNone(re.search(r'src="(?!data:)', page))
            self.assertIn("data:image/png;base64,", page)
            with open(folder / "results.csv", newline="") as file:
                rows = list(csv.DictReader(file))
            # 4 costs and 2 directions to 625 vertices, 2 costs and 2 directions to 1 %; for the two gains 2 costs, 2 efforts, 2 directions.
            self.assertEqual(len(rows), 20)
            rows = [row for row in rows if row["target_vertices"] not in map(str, gains.QUICK_COUNTS)]
            self.assertEqual(len(rows), 12)
            for row in rows:
                if row["target_epsilon"]:
                    self.assertLessEqual(float(row["hausdorff_lower"]), 1)
                else:
                    # Vertices without a float32 position may be contracted away beyond the wish.
                    self.assertTrue(615 <= int(row["vertices"]) <= 625, row["vertices"])

    def check_results(self, folder):
        """What main wrote is compared: with itself, and with what was changed in it."""
        kept = keep.read(folder)
        self.assertEqual(kept["whole"] if "whole" in kept else {}, {})
        sections = kept["quick"]
        self.assertLessEqual({"models", "proposition-1", "gains", "sets", "table-4-1", "figure-4-1", "figure-4-4"}, set(sections))
        for section in sections.values():
            self.assertLessEqual({"date", "commit", "version", "machine", "text", "tables"}, set(section))
        truth = [row[1::2] for row in sections["table-4-1"]["tables"][0]["rows"]]
        self.assertEqual([row[0] for row in truth[:2] + truth[3:]], ["true", "true", "false"])  # between 0 and ε either is allowed
        self.assertEqual([row[1] == "inside" for row in truth], [True, truth[1][1] == "inside", False, False])
        volumes = sections["figure-4-1"]["tables"][0]["rows"]
        self.assertTrue(all(row[-1] == "encloses" for row in volumes), volumes)
        self.assertEqual(volumes[0][0], "sphere")
        with tempfile.TemporaryDirectory() as name:
            other = pathlib.Path(name)

            def compare(change):
                results = copy.deepcopy(kept)
                change(results["quick"])
                (other / "results.json").write_text(json.dumps(results))
                with contextlib.redirect_stdout(io.StringIO()) as said:
                    return main.main(["--compare", str(other), "--out", str(folder)]), said.getvalue()
            self.assertEqual(compare(lambda sections: None)[0], 0)
            self.assertEqual(compare(lambda sections: [s.update(date="1999-01-01", seconds={"cpu": 9, "wall": 9}) for s in sections.values()])[0], 0)
            at = sections["gains"]["tables"][0]["header"].index("Hausdorff")

            def farther(sections):
                sections["gains"]["tables"][0]["rows"][0][at] = "99.0"
            code, said = compare(farther)
            self.assertEqual(code, 1)
            self.assertIn("99.0", said)
            self.assertIn("1 differences", said)
            self.assertEqual(compare(lambda sections: sections.pop("gains"))[0], 1)
            with contextlib.redirect_stderr(io.StringIO()):
                self.assertEqual(main.main(["--compare", str(other / "none"), "--out", str(folder)]), 3)

    def test_parts(self):
        points = [f"v {i} 0 0\n" for i in range(7)]
        parts = sets.components(points, [[4, 5, 6], [0, 1, 2], [2, 1, 3]])
        self.assertEqual(parts, [(points[:4], [[0, 1, 2], [2, 1, 3]]), (points[4:], [[0, 1, 2]])])
        with tempfile.TemporaryDirectory() as name:
            path = pathlib.Path(name) / "parts.obj"
            sets.write_obj(path, parts)
            self.assertEqual(sets.read_obj(path), (points, [[0, 1, 2], [2, 1, 3], [4, 5, 6]]))
            self.assertEqual(path.read_text().count("o body-"), 2)

    def test_distances_at_vertices(self):
        """A point inside of a cube is near the face of a body within, far from the union's boundary."""
        def cube(half):
            points = [f"v {x} {y} {z}\n" for x in (-half, half) for y in (-half, half) for z in (-half, half)]
            quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
            return points, [list(t) for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
        with tempfile.TemporaryDirectory() as name, contextlib.redirect_stderr(io.StringIO()):
            folder = pathlib.Path(name)
            runner = Runner(PROGRAMS, folder)
            original = folder / "original.obj"
            sets.write_obj(original, [cube(10), cube(3)])
            make = sets.Sets(sets.Calls(report.Context([], runner, folder, True), "sets"), models.Model("nested", "", original), True)
            self.assertTrue(make.prepared())
            sets.write_obj(make.call.folder / "set.obj", [cube(10), cube(4)])
            row = make.measured("set", 2, 16)
            self.assertEqual(runner.failures, {})
        percent = 100 / (20 * 3 ** 0.5)
        for key, distance in {"o2a_max": 1, "o2a_mean": 0.5, "a2o_max": 3 ** 0.5, "a2o_mean": 3 ** 0.5 / 2,
                              "union_o2a_max": 7, "union_a2o_max": 0}.items():
            self.assertAlmostEqual(row[key], percent * distance, delta=0.02, msg=key)

    def test_table_4_3(self):
        rows = thesis.table_4_3()
        self.assertEqual([row.bodies for row in rows if row.stage != "bounding"], [7, 30, 64, 105])
        self.assertEqual(len(rows), 22)
        self.assertTrue(any((row.bodies, row.vertices) == (64, 942) and abs(row.percent["a2o_max"] - 1.586) < 1e-3
                            for row in rows))  # 19.66 mm
        robot = models.Model("mitsubishi", "", BRACKET.path, "MITSUBISHI")
        self.assertEqual([(s.bodies, len(s.vertices)) for s in sets.settings(robot, False)],
                         [(30, 6), (64, 6), (105, 6)])
        self.assertEqual(sets.settings(robot, True), [sets.Setting(64, (942,))])

    def test_sweeps(self):
        self.assertAlmostEqual(sweeps.slope([(x, 3 * x ** -0.5) for x in (0.1, 1, 7)]), -0.5)
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            times = folder / "t.csv"
            times.write_text("library,model,query,microseconds\n" + "".join(
                f"L,{m},{i},{t}\n" for m in ("triangle meshes", "sets") for i, t in enumerate((3, 1, 2))))
            self.assertEqual(sweeps.statistics(times)["L", "sets"], (2, 2, 3))
            runner = Runner(PROGRAMS, folder)
            call = sweeps.Calls(report.Context([], runner, folder, True), "sweeps")
            program = PROGRAMS / "bmesh-decimate"
            with contextlib.redirect_stderr(io.StringIO()) as said:
                for limit in (None, None, 1000, None, 10):
                    self.assertIsNone(call("bad", program, ["--wrong"], [], [], limit=limit))
                call.retry = True
                self.assertIsNone(call("bad", program, ["--wrong"], [], []))
            self.assertEqual(said.getvalue().count("bad"), 5)  # kept once
            self.assertEqual(len(runner.failures), 1)
            with contextlib.redirect_stderr(io.StringIO()) as said:
                for _ in range(2):
                    self.assertEqual(call("good", program, ["--version"], [], []), 0)
            self.assertEqual(said.getvalue().count("good"), 1)  # kept

    def test_results_of_earlier_calls_are_never_taken(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            runner = Runner(PROGRAMS, folder)
            call = sets.Calls(report.Context([], runner, folder, True), "sets")
            script = folder / "script"

            def run(text, codes=(0,)):
                script.write_text(text)
                with contextlib.redirect_stderr(io.StringIO()):
                    return call("step", "/bin/sh", [script], [script], ["result"], codes)

            result = call.folder / "result"
            self.assertEqual(run("echo 1 > result"), 0)
            result.write_text("damaged")
            self.assertEqual(run("echo 1 > result"), 0)
            self.assertEqual(result.read_text(), "1\n")
            self.assertEqual(run("exit 1", (0, 1)), 1)  # a valid no, without a result
            self.assertFalse(result.exists())
            self.assertEqual(run("echo 2 > result; exit 3"), None)
            self.assertFalse(result.exists())
            self.assertEqual(list(runner.failures.values()), ["exit code 3"])

    def test_the_two_gains_and_another_program(self):
        """Against the bracket in the place of a robot, and programs that hand their input on, the second one as VRML with a corner moved."""
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stderr(io.StringIO()):
            folder = pathlib.Path(folder)
            program, other = folder / "boundingmesh", folder / "decomposition"
            program.write_text("#!/bin/sh\nshift 6\nexec cp \"$1\" \"$2\"\n")
            points = [(x, y, z) for x in (-9, 9) for y in (-9, 9) for z in (-9, 9)]
            body = (", ".join(" ".join(map(str, p)) for p in points), "0, 1, 3, 2, -1, 4, 6, 7, 5, -1, 0, 4, 5, 1, -1, 2, 3, 7, 6, -1, 0, 2, 6, 4, -1, 1, 5, 7, 3, -1")
            other.write_text("#!/bin/sh\ncat > \"$6\" <<end\ngeometry IndexedFaceSet {{ coord Coordinate {{ point [ {} ] }} coordIndex [ {} ] }}\nend\n".format(*body))
            for script in (program, other):
                script.chmod(0o755)
            model = dataclasses.replace(BRACKET, thesis="KUKA", robot=True)
            runner = Runner(PROGRAMS, folder / "runs")
            with mock.patch.object(gains, "COUNTS", (300,)), mock.patch.object(author, "COUNTS", (300,)), mock.patch.object(author, "SETS", ((1, 1),)):
                report.make([model], runner, folder, False, ["gains", "author", "author-sets"], {"boundingmesh": program, "bounding-convex-decomposition": other})
            self.assertEqual(runner.failures, {})
            text = (folder / "report.md").read_text()
            gained = {name: float(mean) for name, mean in re.findall(r"^\| ([a-z, ']+) \| 2 \| [0-9.]+× \| ([0-9.]+)× \|", text, re.M)}
            self.assertEqual(len(gained), 5, text)
            for change in ("optimiser, on the thesis's cost", "cost, without optimiser", "both"):
                self.assertLess(gained[change], 1, text)
            kept = keep.read(folder)["whole"]
            rows = kept["author"]["tables"][0]["rows"]
            self.assertEqual([row[1] for row in rows], ["boundingmesh, QEM_Classic", "planes", "boundingmesh, MinConstant", "triangles", "distance"])
            self.assertTrue(all((row[2], row[-2]) == ("0", "encloses") for row in rows), rows)
            self.assertTrue(all(float(row[7]) < 1e-4 for row in rows if row[1].startswith("boundingmesh")), rows)
            self.assertTrue(all(float(row[7]) > 1e-3 for row in rows if not row[1].startswith("boundingmesh")), rows)
            sets_rows = kept["author-sets"]["tables"][0]["rows"]
            self.assertEqual([(row[1], row[4], row[6]) for row in sets_rows], [("the author's", "1", "encloses"), ("ours", "1", "encloses")])
            self.assertLess(float(sets_rows[1][3]), float(sets_rows[0][3]))  # a hull is nearer than that box

    def test_pictures_of_an_execution(self):
        with tempfile.TemporaryDirectory() as name, contextlib.redirect_stderr(io.StringIO()):
            folder = pathlib.Path(name)
            runner = Runner(PROGRAMS, folder / "runs")
            with mock.patch.object(executions, "FIGURES", (("6.4", "stacked", 2, ("--search", "bfs"), "two blocks"),)):
                report.make([], runner, folder, False, ["executions"])
            self.assertEqual(runner.failures, {})
            rows = keep.read(folder)["whole"]["executions"]["tables"][0]["rows"]
            self.assertEqual(rows[0][5:], ["0", "0", "holds"])
            page = (folder / "executions/stacked-2/plan.html")
            data = executions.data_of(page)
            states, actions = executions.steps_to_goal(data)
            self.assertEqual((len(states), str(len(actions))), (len(actions) + 1, rows[0][2]))
            first, last = (executions.scene_at(data, data["states"][s]) for s in (states[0], states[-1]))
            self.assertEqual(first[1], last[1])
            moved = [abs(a[2] - b[2]) for a, b in zip(first[0], last[0])]
            self.assertGreater(max(moved), 0.03)  # a block is higher
            self.assertTrue((folder / "executions/stacked-2/figure-6-4.png").is_file())

    def test_what_is_worse(self):
        def kept(rows, header=("n", "by", "Hausdorff", "factor", "CPU time", "verdict")):
            return {"t": {"tables": [{"under": ["T"], "header": list(header), "rows": rows}]}}
        before = kept([["10", "ours", "1.00", "3.0×", "1.0 s", "holds"], ["20", "ours", "0.50", "4.0×", "2.0 s", "holds"]])
        self.assertEqual(keep.changes(before, before), [])

        def verdicts(rows):
            return [(change[1], change[2], change[-1]) for change in keep.changes(before, kept(rows))]
        slower = [["10", "ours", "1.00", "3.0×", "9.0 s", "holds"], ["20", "ours", "0.50", "4.0×", "0.1 s", "holds"]]
        self.assertEqual(verdicts(slower), [])
        worse = [["10", "ours", "1.10", "3.0×", "1.0 s", "holds"], ["20", "ours", "0.505", "2.0×", "2.0 s", "does NOT hold"]]
        self.assertEqual(verdicts(worse), [("T / 10 · ours", "Hausdorff", "worse"), ("T / 20 · ours", "Hausdorff", "changed"), ("T / 20 · ours", "factor", "worse"),
                                           ("T / 20 · ours", "verdict", "worse")])
        better = [["10", "ours", "0.90", "6.0×", "1.0 s", "holds"]]
        self.assertEqual([v for _, _, v in verdicts(better)], ["better", "better", "gone", "gone", "gone", "gone", "gone"])
        self.assertEqual(keep.merged({"whole": {"a": 1}}, {"quick": {"a": 2}}), {"whole": {"a": 1}, "quick": {"a": 2}})
        self.assertTrue(keep.same_figures({"whole": {"a": before["t"]}}, {"whole": {}}))
        self.assertEqual(keep.same_figures({"whole": {"a": before["t"]}}, {"whole": {"a": before["t"]}, "quick": {"b": before["t"]}}), [])
        self.assertTrue(keep.same_figures({"whole": {"a": before["t"]}}, {"quick": {"a": before["t"]}}))

    def test_what_varies(self):
        runs = [{"total_time_s": s, "collision_checks": 7} for s in (1.0, 3.0, 2.0)]
        self.assertEqual((scenarios.cell(runs, "total_time_s"), scenarios.cell(runs, "collision_checks")), ("2.000 (1.000–3.000)", "7"))
        runs[0]["collision_checks"] = 10
        self.assertTrue(scenarios.cell(runs, "total_time_s").startswith("2.000 ± 1.0"))
        pairs = [({"a": "1 ± 0.1", "b": "10", "c": None}, [{"a": 2, "b": 100, "c": 5}])]
        self.assertEqual(scenarios.worst_first(["a", "c", "b"], pairs), ["b", "a", "c"])

    def test_borders_and_quadrics(self):
        points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (5, 5, 5)]
        solid = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
        self.assertEqual(meshes.without_border(points, solid), (points[:4], solid))
        self.assertEqual(meshes.without_border(points, [*solid, [0, 1, 4]])[1], [t for t in solid if not {0, 1, 4} & set(t)])
        for _, least, total, adapted in illustrations.quadrics():
            self.assertLessEqual(least, total)
            self.assertLess(adapted, total)

    def test_holes_are_closed(self):
        points = [f"v {x} {y} {z}\n" for x, y, z in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1))]
        solid = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 4], [2, 3, 4], [3, 1, 4]]
        self.assertEqual(sets.closed(points, solid), (points, solid))
        more, filled = sets.closed(points, solid[2:])  # without two triangles, a loop of four edges
        self.assertEqual((len(more), len(filled)), (6, 8))
        edges = [(a, b) for t in filled for a, b in zip(t, t[1:] + t[:1])]
        self.assertEqual(sorted(edges), sorted((b, a) for a, b in edges))

    def test_errors(self):
        with contextlib.redirect_stderr(io.StringIO()) as said:
            with self.assertRaises(SystemExit) as stop:
                main.main(["--models", "no-such-model"])
            self.assertEqual(stop.exception.code, 2)
            with self.assertRaises(SystemExit) as stop:
                main.main(["--sections", "no-such-section"])
            self.assertEqual(stop.exception.code, 2)
            self.assertEqual(main.main(["--quick", "--programs", "/nonexistent"]), 3)
            self.assertEqual(main.main(["--quick", "--programs", str(PROGRAMS), "--bounding-mesh", "/nonexistent"]), 3)
        for word in ("no-such-model", "no-such-section", "https://github.com/gaschler/bounding-mesh"):
            self.assertIn(word, said.getvalue())


if __name__ == "__main__":
    unittest.main()
