"""The wheel: built from the checkout, unpacked elsewhere, imported without the build tree."""

import base64
import csv
import hashlib
import os
import pathlib
import subprocess
import sys
import zipfile

from conftest import SOURCE


def test_wheel_installs_and_imports(tmp_path):
    sys.path.insert(0, str(SOURCE / "python"))
    import build_backend

    os.environ["KABOUM_BUILD"] = str(pathlib.Path(os.environ["KABOUM_BIN"]).parent)
    wheel = build_backend.build_wheel(tmp_path)
    assert build_backend.build_wheel(tmp_path) == wheel  # into the same file
    with zipfile.ZipFile(tmp_path / wheel) as archive:
        archive.extractall(tmp_path / "site")
        names = set(archive.namelist())
        record = next(n for n in names if n.endswith("RECORD"))
        rows = list(csv.reader(archive.read(record).decode().splitlines()))
        assert {r[0] for r in rows} == names
        for name, digest, size in rows:
            if digest:
                data = archive.read(name)
                expected = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
                assert digest == "sha256=" + expected and int(size) == len(data)
    program = ("import kaboum, pathlib, sys\n"
               "assert 'site' in kaboum.__file__\n"
               "print(len(kaboum.decimate(sys.argv[1], vertices=100).vertices))")
    out = subprocess.run([sys.executable, "-c", program, SOURCE / "meshes" / "bracket.obj"], check=True,
                         capture_output=True, text=True, env={**os.environ, "PYTHONPATH": str(tmp_path / "site")})
    assert out.stdout.strip() == "100"
