#!/usr/bin/env python3
"""Makes VAMP's Python module and vamp-rows from sources at hand, with its own flags, without a download.

  benchmarks/peers/vamp/build.py SOURCES OUT [--robots panda,ur5,fetch] [--compiler g++]

SOURCES has the folders vamp (vamp-planner of PyPI, or KavrakiLab/vamp), nigh, pdqsort and SIMDxorshift, at the revisions that
vamp/cmake/Dependencies.cmake names. OUT gets the package vamp, for PYTHONPATH, and a program vamp-rows-ROBOT for each robot. The
Python that runs this has nanobind.
"""
import argparse
import pathlib
import shutil
import subprocess
import sysconfig

import nanobind

# Those of VAMP's own build, for times that are its own. Nothing of ours is compiled with them.
FLAGS = ("-O3 -DNDEBUG -march=native -mavx2 -fno-math-errno -fno-signed-zeros -fno-trapping-math -fno-rounding-math -ffp-contract=fast "
         "-fassociative-math -fPIC -w").split()  # vamp/cmake/CompilerSettings.cmake
STRUCTS = {"panda": "Panda", "ur5": "UR5", "fetch": "Fetch"}


def filled(template, **words):
    text = template.read_text()
    for name, value in words.items():
        text = text.replace(f"@{name}@", value)
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("sources", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--robots", default="panda,ur5,fetch")
    parser.add_argument("--compiler", default="g++")
    args = parser.parse_args()
    robots, vamp = args.robots.split(","), args.sources / "vamp"
    objects, package = args.out / "objects", args.out / "vamp"
    objects.mkdir(parents=True, exist_ok=True)
    bindings = vamp / "src/impl/vamp/bindings/python"
    declarations = "".join(f"void init_{r}(nanobind::module_ &pymodule);\n" for r in robots)
    (objects / "vamp_python_init.hh").write_text(filled(bindings / "init.hh.in", VAMP_ROBOT_DECLS=declarations))
    (objects / "python.cc").write_text(filled(bindings / "python.cc.in", VAMP_ROBOT_INITS="".join(f"vb::init_{r}(pymodule);\n" for r in robots),
                                              VAMP_ROBOT_NAMES=", ".join(f'"{r}"' for r in robots)))
    for r in robots:
        (objects / f"{r}.cc").write_text(filled(bindings / "robot.cc.in", robot_name=r, robot_struct=STRUCTS[r]))
    binding = pathlib.Path(nanobind.include_dir())
    eigen = [p for p in ("/usr/include/eigen3", "/usr/local/include/eigen3") if pathlib.Path(p).exists()][:1]
    include = [f"-I{p}" for p in [vamp / "src/impl", args.sources / "nigh/src", args.sources / "pdqsort", args.sources / "SIMDxorshift/include",
                                  objects, binding, binding.parent / "ext/robin_map/include", sysconfig.get_paths()["include"], *eigen]]

    def compiled(source, language, name=None, more=()):
        target = objects / f"{name or source.stem}.o"
        if not target.exists():
            standard = ["-std=c++17"] if language == "c++" else []
            partial = target.with_suffix(".part")
            subprocess.run([args.compiler, "-x", language, *standard, *FLAGS, *more, *include, "-c", source, "-o", partial], check=True)
            partial.rename(target)
            print(target.name, flush=True)
        return target

    random = [compiled(args.sources / f"SIMDxorshift/src/{f}.c", "c") for f in ("simdxorshift128plus", "xorshift128plus")]
    here = pathlib.Path(__file__).resolve().parent
    for r in robots:
        rows = compiled(here / "rows.cpp", "c++", f"rows-{r}", [f"-DROBOT={STRUCTS[r]}", f'-DROBOT_FILE="vamp/robots/{r}.hh"'])
        subprocess.run([args.compiler, rows, *random, "-o", args.out / f"vamp-rows-{r}"], check=True)
    parts = [compiled(binding.parent / "src/nb_combined.cpp", "c++", more=["-fno-strict-aliasing"])]
    parts += [compiled(bindings / f, "c++") for f in ("environment.cc", "settings.cc")]
    parts += [compiled(objects / f"{f}.cc", "c++") for f in ["python", *robots]]
    shutil.copytree(vamp / "src/vamp", package, dirs_exist_ok=True)
    library = package / "_core" / ("_core_ext" + sysconfig.get_config_var("EXT_SUFFIX"))
    subprocess.run([args.compiler, "-shared", *parts, *random, "-o", library], check=True)


if __name__ == "__main__":
    main()
