"""Batches in process: as kaboum-batch, whose journal and summaries they share."""

import json
import os
import pathlib
import subprocess
import sys

import pytest

import kaboum
from conftest import cube
from test_progress import interrupted

BIN = pathlib.Path(os.environ["KABOUM_BIN"])


@pytest.fixture
def parts(tmp_path):
    folder = tmp_path / "parts"
    folder.mkdir()
    for size in (1, 2, 3):
        kaboum.write(cube(size), folder / f"cube{size}.off")
    (folder / "cut.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n")
    return folder


def batch(parts, folder, commands="bmesh-decimate --epsilon 1%", **k):
    return kaboum.run_batch(parts, folder, commands, programs=BIN, pictures=False, **k)


def measured(row):
    return {k: v for k, v in row.items() if k not in ("wall_seconds", "cpu_seconds", "peak_megabytes", "key")}


def test_batches_are_those_of_the_program(parts, tmp_path):
    stages = []
    ours = batch(parts, tmp_path / "ours", progress=stages.append)
    assert not ours and len(ours) == 4 and ours.counts["done"] == 3 and ours.counts["failed"] == 1 and stages
    subprocess.run([BIN / "kaboum-batch", parts, "-o", tmp_path / "theirs", "--no-pictures", "--quiet"], check=False)
    theirs = json.loads((tmp_path / "theirs" / "summary.json").read_text())
    assert [measured(r) for r in ours.rows] == [measured(r) for r in theirs["rows"]]
    assert ours.rows == json.loads((tmp_path / "ours" / "summary.json").read_text())["rows"]
    for row in ours.rows:
        assert (row["state"] == "done") == (row["reason"] == "")
        if row["output"] and row["sha256"]:
            assert (tmp_path / "ours" / row["output"]).read_bytes() == (tmp_path / "theirs" / row["output"]).read_bytes()
    # Resumed by either: nothing is done twice.
    again = batch(parts, tmp_path / "theirs")
    assert again.done_before == 4 and [measured(r) for r in again.rows] == [measured(r) for r in ours.rows]
    kaboum.write(cube(5), parts / "cube2.off")
    assert batch(parts, tmp_path / "theirs").done_before == 3


def test_parts_rules_and_limits(parts, tmp_path):
    out = tmp_path / "out"
    first = batch(parts, out, shard="1/2")
    second = batch(parts, out, shard="2/2")
    assert len(first) + len(second) == 4 and not (out / "summary.html").exists()
    assert len(batch(parts, out, summary=True)) == 4 and (out / "summary.html").exists()
    rules = {"cube1*": "bcd-decompose --epsilon 2%", "cube2*": [sys.executable, "-c", "import time; time.sleep(60)", "{input}"]}
    made = batch(parts, tmp_path / "rules", rules, timeout=5)
    assert {r["name"]: r["state"] for r in made.rows} == {"cube1.off": "done", "cube2.off": "timeout"}
    assert made.rows[0]["output"].endswith(".glb") and made.rows[0]["bodies"] == 1
    little = batch(parts, tmp_path / "little", {"cube1*": "bmesh-decimate --epsilon 1%"}, max_memory=1 << 20)
    assert not little and little.rows[0]["reason"]


def test_other_children_of_the_process_are_left_alone(parts, tmp_path):
    child = subprocess.Popen([sys.executable, "-c", "raise SystemExit(7)"])
    assert batch(parts, tmp_path / "out").counts["done"] == 3
    assert child.wait() == 7


def test_ctrl_c_ends_the_programs(parts, tmp_path):
    sleep = [sys.executable, "-c", "import time; time.sleep(600)", "{input}"]
    interrupted(lambda: batch(parts, tmp_path / "out", sleep))
    # Nothing was written down: all is to be done.
    assert batch(parts, tmp_path / "out", sleep, summary=True).to_do == 4


@pytest.mark.parametrize("given, says", [
    ({"commands": 3}, "commands must be"), ({"commands": []}, "needs a program"), ({"shard": "3/2"}, "shard"),
    ({"jobs": 5000}, "jobs must be"), ({"timeout": -1}, "timeout must be"), ({"progress": 3}, "progress must be"),
    ({"commands": {"*.stl": "bmesh-decimate"}}, "matches a rule"), ({"commands": "bmesh-decimate --depfile x"}, "depfile"),
])
def test_wrong_requests_are_refused(parts, tmp_path, given, says):
    with pytest.raises(kaboum.Error, match=says):
        batch(parts, tmp_path / "out", **given)
