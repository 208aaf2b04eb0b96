"""The tutorial's commands and its Python session, as they stand on the page, run one after the other."""

import os
import re
import subprocess
import sys

import pytest

from conftest import SOURCE

PAGE = (SOURCE / "docs" / "tutorial.md").read_text()
SESSION, = re.findall(r"^```python\n(.*?)^```", PAGE, re.M | re.S)
COMMANDS = re.findall(r"^```sh\n(.*?)^```", PAGE, re.M | re.S)


@pytest.fixture
def folder(tmp_path):
    subprocess.run([SOURCE / "examples" / "tutorial" / "make-robot", tmp_path], check=True)
    return tmp_path


def run_session(folder, text):
    (folder / "session.py").write_text(text)  # a file, so that errors show the line that failed
    return subprocess.run([sys.executable, "session.py"], cwd=folder, env=os.environ, capture_output=True, text=True, check=False)


def test_session(folder):
    lines = [line for line in SESSION.splitlines() if line.strip()]
    assert 10 <= len(lines) <= 15
    done = run_session(folder, SESSION)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("\n") >= 3  # the start, the goal, and what leads round the post
    assert (folder / "safe-robot" / "arm.xml").is_file()


def test_session_would_notice(folder):
    """What the page asserts can fail: without a post the straight way is free."""
    without = re.sub(r'^scene.add_object\("post".*\n', "", SESSION, flags=re.M)
    assert without != SESSION
    done = run_session(folder, without)
    assert done.returncode != 0 and "assert not world.check_motion" in done.stderr


def test_commands(tmp_path):
    assert len(COMMANDS) >= 4
    env = os.environ | {"SOURCE": str(SOURCE), "PATH": os.environ["KABOUM_BIN"] + os.pathsep + os.environ["PATH"]}
    done = subprocess.run(["bash", "-e", "-c", "".join(COMMANDS)], cwd=tmp_path, env=env, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "every triangle of 7 links is inside" in done.stderr
    assert "they miss something" in done.stdout and "decided exactly" in done.stderr
    for page in ("spheres.html", "thin.html"):
        assert (tmp_path / page).is_file()
    assert "self_collision_ignore:\n" in (tmp_path / "spheres.yaml").read_text()
    assert "free" in done.stdout
