"""What pyproject.toml says of the package, and the entry points; test_wheel.py looks at an installed one."""

import importlib.util
import os
import re
import subprocess
import sys

import pytest

import kaboum
from conftest import SOURCE

PROJECT = (SOURCE / "pyproject.toml").read_text()
FILE = SOURCE / "python" / "kaboum" / "_programs.py"


def entry_points():
    return dict(re.findall(r'^([\w-]+) = "kaboum\._programs:(\w+)"$', PROJECT, re.M))


def programs():
    specification = importlib.util.spec_from_file_location("programs", FILE)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def test_every_program_is_an_entry_point():
    tools = re.findall(r"kaboum_add_tool\(([\w-]+)", (SOURCE / "tools" / "CMakeLists.txt").read_text())
    assert {name: name.replace("-", "_") for name in tools} == entry_points()
    assert len(tools) > 10


def test_the_version_is_the_projects():
    pattern = re.search(r"^regex = '(.*)'$", PROJECT, re.M).group(1)
    assert re.search(pattern, (SOURCE / "CMakeLists.txt").read_text()).group("value") == kaboum.__version__


def test_an_entry_point_becomes_its_program():
    module = programs()
    with pytest.raises(AttributeError, match="no program 'bcd-decompose'"):
        module.bcd_decompose  # there are none beside the sources
    call = f"import runpy, pathlib, sys; m = runpy.run_path({str(FILE)!r}); m['_become'].__globals__['FOLDER'] = pathlib.Path({os.environ['KABOUM_BIN']!r})\n"
    done = subprocess.run([sys.executable, "-c", call + "m['_become']('bcd-decompose')", "--no-such-option"], capture_output=True, text=True)
    assert done.returncode == 2 and "bcd-decompose" in done.stderr
    done = subprocess.run([sys.executable, "-c", call + "m['_become']('bcd-decompose')", "--version"], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, f"bcd-decompose {kaboum.__version__}\n")
    done = subprocess.run([sys.executable, "-c", call + "m['_become']('none-such')"], capture_output=True, text=True)
    assert done.returncode == 6 and "none-such cannot be run" in done.stderr
