"""The installed package: the programs are its entry points, and of the system it takes only what its tag promises.

scripts/wheel runs this in environments of wheels. A build tree has no programs beside the module: skipped there.
"""

import importlib.metadata
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

import pytest

import kaboum
from conftest import SOURCE, cube

PACKAGE = pathlib.Path(kaboum.__file__).resolve().parent
PROGRAMS = PACKAGE / "bin"
if not PROGRAMS.is_dir():
    pytest.skip("kaboum is not installed from a wheel (scripts/wheel)", allow_module_level=True)

LOADER = next(p for pattern in ("lib64/ld-linux-*", "lib/ld-linux-*") for p in pathlib.Path("/").glob(pattern))
ENTRIES = pathlib.Path(sys.executable).parent
NAMES = sorted(p.name for p in PROGRAMS.iterdir())
# What PEP 600 promises of any system with the glibc of the tag.
PROMISED = re.compile(r"(linux-vdso|ld-linux.*|lib(c|m|mvec|dl|rt|util|pthread|anl|nsl|resolv|gcc_s|stdc\+\+|atomic|z|expat|nss_.*))\.so[-.0-9]*$")


def program(name, *arguments, **more):
    return subprocess.run([str(ENTRIES / name), *map(str, arguments)], capture_output=True, text=True, **more)


def libraries_of(file):
    """What the system's loader would load for a program or library."""
    done = subprocess.run([str(LOADER), "--list", str(file)], capture_output=True, text=True)
    assert "not found" not in done.stdout and done.returncode == 0, done.stdout + done.stderr
    return {os.path.realpath(p) for p in re.findall(r"(?:=> )?(/\S+) \(0x", done.stdout)}


def foreign(files):
    """The libraries that are neither the environment's, nor the interpreter's own, nor promised."""
    own = [str(pathlib.Path(p).resolve()) for p in (sys.prefix, os.path.dirname(os.__file__))]
    if sys.base_prefix != "/usr":
        own.append(str(pathlib.Path(sys.base_prefix).resolve()))
    needed = set()  # by the interpreter's modules
    for module in pathlib.Path(os.__file__).parent.glob("lib-dynload/*.so"):
        needed |= libraries_of(module)
    files = {os.path.realpath(f) for f in files}
    return {f for f in files if not PROMISED.search(f) and f not in needed and not any(f.startswith(o + "/") for o in own)}


def test_every_program_is_an_entry_point():
    entries = importlib.metadata.distribution("kaboum").entry_points
    assert sorted(e.name for e in entries if e.group == "console_scripts") == NAMES
    for name in NAMES:
        done = program(name, "--version")
        assert (done.returncode, done.stdout.split()) == (0, [name, kaboum.__version__]), done.stderr
        assert program(name, "--help").returncode == 0
    assert importlib.metadata.version("kaboum") == kaboum.__version__


def test_exit_codes_are_the_programs(tmp_path, bracket):
    part = tmp_path / "part.ply"
    kaboum.write(cube(), part)
    assert program("bound-verify", "mesh", "--outer", part, part).returncode == 0
    assert program("bound-verify", "mesh", "--outer", part, bracket).returncode == 1
    assert program("bmesh-decimate", part, "--no-such-option").returncode == 2
    (tmp_path / "bad.stl").write_text("solid")
    assert program("mesh-prepare", tmp_path / "bad.stl", "-o", tmp_path / "x.ply").returncode == 3
    assert program("mesh-prepare", part, "-o", tmp_path / "no" / "folder" / "x.ply").returncode == 4


def test_what_is_left_out_says_so(tmp_path):
    file = tmp_path / "part.step"
    file.write_text("ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n")
    done = program("mesh-prepare", file, "-o", tmp_path / "x.ply")
    assert done.returncode == 5 and "STEP" in done.stderr
    with pytest.raises(kaboum.Error) as caught:
        kaboum.read(file)
    assert caught.value.code == "not_built"


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGKILL])
def test_signals_reach_the_program(number):
    """The process is the program's, so that nothing is left running."""
    waiting = subprocess.Popen([str(ENTRIES / "bmesh-decimate"), "-", "--input-format", "ply", "-o", "-", "--output-format", "ply", "--vertices", "60"],
                               stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               preexec_fn=lambda: signal.signal(number, signal.SIG_DFL) if number != signal.SIGKILL else None)  # background jobs ignore some
    try:
        for _ in range(600):
            if os.readlink(f"/proc/{waiting.pid}/exe") == str(PROGRAMS / "bmesh-decimate"):
                break
            time.sleep(0.05)
        assert os.readlink(f"/proc/{waiting.pid}/exe") == str(PROGRAMS / "bmesh-decimate")
        time.sleep(0.2)
        waiting.send_signal(number)
        assert waiting.wait(30) == -number
    finally:
        waiting.kill()
        waiting.communicate()


def test_streams_pass_and_bytes_are_the_modules(ring):
    text = subprocess.run([str(ENTRIES / "bmesh-decimate"), "-", "--input-format", "ply", "-o", "-", "--output-format", "ply", "--vertices", "60"],
                          input=ply_of(ring), capture_output=True)
    assert text.returncode == 0, text.stderr
    assert text.stdout == kaboum.decimate(ring, vertices=60).bytes


def ply_of(mesh):
    vertices, faces = mesh
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}", *(f"property double {c}" for c in "xyz"),
             f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(map(repr, map(float, v))) for v in vertices] + [f"3 {a} {b} {c}" for a, b, c in faces]
    return ("\n".join(lines) + "\n").encode()


def test_batches_find_the_programs(tmp_path, ring, monkeypatch):
    (tmp_path / "parts").mkdir()
    kaboum.write(ring, tmp_path / "parts" / "ring.ply")
    monkeypatch.setenv("PATH", "/nowhere")
    assert kaboum.run_batch(tmp_path / "parts", tmp_path / "out", "bcd-decompose --epsilon 5%")
    done = program("kaboum-batch", tmp_path / "parts", "-o", tmp_path / "again", "--command", "bcd-decompose", "--epsilon", "5%",
                   env={"PATH": "/nowhere", "KABOUM_CACHE": str(tmp_path / "cache")})
    assert done.returncode == 0, done.stderr


def test_nothing_of_the_system_is_used_but_what_is_promised():
    work = """
import numpy as np, kaboum, re, sys
sys.path.insert(0, sys.argv[1])
from conftest import torus
part = torus(32, 16)
kaboum.hausdorff(part, kaboum.decimate(part, vertices=60))
kaboum.draw([kaboum.Mesh(*part)])
assert kaboum.verify_cover(part, kaboum.decompose(part, epsilon="5%", no_cache=True))
for line in open("/proc/self/maps"):
    if re.search(r"\\.so[-.0-9]*$", line.strip()): print(line.split()[-1])
"""
    done = subprocess.run([sys.executable, "-c", work, str(pathlib.Path(__file__).parent)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    loaded = set(done.stdout.split())
    assert any(f.startswith(str(PACKAGE)) for f in loaded) and any("embree" in f for f in loaded)
    assert foreign(loaded) == set()


@pytest.mark.parametrize("name", NAMES)
def test_a_program_uses_nothing_else_either(name):
    files = libraries_of(PROGRAMS / name)
    assert any(f.startswith(str(PACKAGE)) for f in files)
    assert foreign(files) == set()


FBX = """; FBX 7.3.0 project file
FBXHeaderExtension:  {
	FBXVersion: 7300
}
GlobalSettings:  {
	Version: 1000
}
Objects:  {
	Geometry: 10, "Geometry::g", "Mesh" {
		Vertices: *12 {
			a: 0,0,0,1,0,0,0,1,0,0,0,1
		}
		PolygonVertexIndex: *12 {
			a: 0,2,-2,0,1,-4,1,2,-4,2,0,-4
		}
		GeometryVersion: 124
	}
	Model: 20, "Model::m", "Mesh" {
		Version: 232
	}
}
Connections:  {
	C: "OO",20,0
	C: "OO",10,20
}
"""


def test_formats_of_other_libraries_are_read(tmp_path):
    """By assimp, libzip and tinyxml2, which are in the package."""
    (tmp_path / "part.fbx").write_text(FBX)
    seeds = SOURCE / "tests" / "fuzz" / "seeds" / "parse_mesh"
    for name in ("t.3mf", "t.dae", "t.glb", "t.x3d"):
        (tmp_path / name).write_bytes((seeds / name).read_bytes()[1:])  # a byte stands for the format before it
    files = list(tmp_path.iterdir())
    assert len(files) == 5
    for file in files:
        assert len(kaboum.read(file).faces) > 0, file.name
        assert program("mesh-prepare", file, "-o", tmp_path / "x.ply").returncode == 0, file.name


def test_licences_of_what_is_inside_are_there():
    files = importlib.metadata.files("kaboum")
    texts = {f.name for f in files if ".dist-info/licenses" in str(f)}
    assert "LICENSE" in texts
    for library in ("libgmp", "libmpfr", "libembree", "libtbb", "libassimp", "libzip"):
        assert any(t.startswith(library) for t in texts), library
    assert any("man/man1/kaboum-plan.1" in str(f) for f in files)
