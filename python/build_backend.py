"""Builds the wheel (PEP 517): CMake compiles the module, this packs it.

Environment: KABOUM_BUILD names a build folder in which the target kaboum_python is built; by default
build/wheel, which is configured for this interpreter.
"""

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SUMMARY = "Collision geometry that can be trusted"


def version():
    found = re.search(r"project\(kaboum VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())
    return found.group(1)


def build_module():
    """The folder of the built package."""
    folder = pathlib.Path(os.environ.get("KABOUM_BUILD") or ROOT / "build" / "wheel").resolve()
    if not (folder / "CMakeCache.txt").exists():
        subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                        "-DKABOUM_BUILD_TESTS=OFF", f"-DPython3_EXECUTABLE={sys.executable}"], check=True)
    jobs = os.environ.get("KABOUM_JOBS") or str(os.cpu_count() or 1)
    subprocess.run(["cmake", "--build", folder, "-j", jobs, "--target", "kaboum_python"], check=True)
    return folder / "python" / "kaboum"


def tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def metadata():
    return (f"Metadata-Version: 2.1\nName: kaboum\nVersion: {version()}\nSummary: {SUMMARY}\n"
            "License: Apache-2.0\nRequires-Python: >=3.9\nRequires-Dist: numpy\n")


def record_line(name, data):
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(data)}\n"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    package = build_module()
    info = f"kaboum-{version()}.dist-info"
    files = {f"kaboum/{p.name}": p.read_bytes() for p in sorted(package.iterdir()) if p.is_file()}
    files[f"{info}/METADATA"] = metadata().encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: kaboum\nRoot-Is-Purelib: false\nTag: {tag()}\n".encode()
    files[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    record = "".join(record_line(name, data) for name, data in files.items()) + f"{info}/RECORD,,\n"
    files[f"{info}/RECORD"] = record.encode()
    wheel = f"kaboum-{version()}-{tag()}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():  # with one date, so that the same files make the same wheel
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            archive.writestr(entry, data, zipfile.ZIP_DEFLATED)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    raise NotImplementedError("wheels are built from a checkout; there is no source distribution")
