"""Tests of reproduce/fetch.py: hashes, and robots put together.

    python3 fetch_test.py FOLDER-OF-PROGRAMS
"""

import contextlib
import csv
import hashlib
import io
import math
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "reproduce"))
sys.dont_write_bytecode = True

import fetch  # noqa: E402

PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()
LINK = """<link name="{0}"><visual><origin xyz="0 0 {1}"/><geometry><mesh filename="package://arm/{0}.obj"/></geometry></visual></link>"""
URDF = ("<robot name='arm'>" + LINK.format("a", 0) + LINK.format("b", 1) +
        f"<joint name='j' type='revolute'><parent link='a'/><child link='b'/><origin xyz='10 0 0' rpy='0 0 {math.pi / 2}'/></joint></robot>")
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"


def run(folder, *more):
    """Exit code and what is said; files come from folder/from."""
    with contextlib.redirect_stderr(io.StringIO()) as said, contextlib.redirect_stdout(io.StringIO()):
        code = fetch.main([str(folder / "to"), "--programs", str(PROGRAMS), "--from", f"file://{folder}/from/{{path}}", *more])
    return code, said.getvalue()


class Fetch(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "from").mkdir()
        rows = []
        for name, text in (("a.obj", TETRAHEDRON), ("b.obj", TETRAHEDRON), ("arm.urdf", URDF)):
            (self.folder / "from" / name).write_text(text)
            place = "robots/arm/urdf/arm.urdf" if name == "arm.urdf" else f"robots/arm/{name}"
            rows.append([place, "some/repository", "0" * 40, name, hashlib.sha256(text.encode()).hexdigest(), "none"])
        with open(self.folder / "sources.csv", "w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([["file", "repository", "commit", "path", "sha256", "licence"], *rows])
        for name, value in (("ROOT", self.folder), ("CONVERTED", {"one.ply": "robots/arm/a.obj"}), ("RENAMED", {}),
                            ("ASSEMBLED", {"whole.obj": "robots/arm/urdf/arm.urdf"})):
            self.enterContext(mock.patch.object(fetch, name, value))

    def test_what_is_there_is_kept_and_robots_are_put_together(self):
        code, said = run(self.folder)
        self.assertEqual(code, 0, said)
        points = {tuple(round(float(x), 9) for x in line.split()[1:])
                  for line in (self.folder / "to" / "whole.obj").read_text().splitlines() if line.startswith("v ")}
        # The second link is turned by a quarter and its mesh is 1 higher.
        self.assertEqual(points, {(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (10, 0, 1), (10, 1, 1), (9, 0, 1), (10, 0, 2)})
        self.assertTrue((self.folder / "to" / "one.ply").is_file())
        for file in (self.folder / "from").iterdir():
            file.unlink()
        self.assertEqual(run(self.folder)[0], 0)
        self.assertEqual([p.name for p in (self.folder / "to").rglob("*part*")], [])

    def test_other_files_are_refused(self):
        (self.folder / "from" / "b.obj").write_text(TETRAHEDRON + "# other\n")
        code, said = run(self.folder)
        self.assertEqual(code, 1)
        self.assertIn("its SHA-256 is", said)
        self.assertFalse((self.folder / "to/robots/arm/b.obj").exists())
        (self.folder / "from" / "b.obj").unlink()
        self.assertEqual(run(self.folder)[0], 1)

    def test_list(self):
        with contextlib.redirect_stdout(io.StringIO()) as said:
            self.assertEqual(fetch.main(["nowhere", "--list"]), 0)
        self.assertEqual(len(said.getvalue().splitlines()), 3)


class Sources(unittest.TestCase):
    def test_every_model_has_its_source(self):
        with open(ROOT / "reproduce/sources.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        names = {row["file"] for row in rows}
        self.assertEqual(len(names), len(rows))
        self.assertLessEqual({*fetch.CONVERTED.values(), *fetch.ASSEMBLED.values(), *fetch.RENAMED}, names)
        self.assertTrue(all(len(row["sha256"]) == 64 and len(row["commit"]) == 40 for row in rows))
        import models
        wanted = {str(model.path.relative_to("/meshes")) for model in models.corpus("/meshes")}
        self.assertEqual(wanted - {*fetch.CONVERTED, *fetch.ASSEMBLED}, {fetch.BY_HAND.split(":", maxsplit=1)[0]})


if __name__ == "__main__":
    unittest.main()
