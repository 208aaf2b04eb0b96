"""The typed stub says what the module has: names, parameters, kinds, defaults, properties."""

import ast
import inspect
import os
import pathlib
import re
import subprocess

import pytest

import kaboum

STUB = pathlib.Path(kaboum.__file__).with_name("__init__.pyi")
TREE = ast.parse(STUB.read_text())
FUNCTIONS = [n for n in TREE.body if isinstance(n, ast.FunctionDef)]
CLASSES = {n.name: n for n in TREE.body if isinstance(n, ast.ClassDef) and not n.name.startswith("_")}


def parameters(node):
    """Name, kind and default of each, without self."""
    a = node.args
    positional = a.posonlyargs + a.args
    defaults = [None] * (len(positional) - len(a.defaults)) + a.defaults
    out = [(p.arg, "positional", d) for p, d in zip(positional, defaults)]
    out += [(p.arg, "keyword", d) for p, d in zip(a.kwonlyargs, a.kw_defaults)]
    return [(n, k, None if d is None else ast.literal_eval(d)) for n, k, d in out if n != "self"]


def of_docstring(function):
    """The signature that pybind11 writes into a docstring's first line."""
    line = function.__doc__.splitlines()[0]
    line = re.sub(r"<[^<>]*>", "None", line)  # a default without a literal would not parse
    return parameters(ast.parse(f"def {line}: ...").body[0])


def test_all_names_are_there():
    assert set(kaboum.__all__) == {f.name for f in FUNCTIONS} | set(CLASSES)
    assert sorted(kaboum.__all__) == kaboum.__all__
    assert all(getattr(kaboum, name).__doc__ for name in kaboum.__all__)


@pytest.mark.parametrize("node", FUNCTIONS, ids=lambda n: n.name)
def test_function(node):
    there = of_docstring(getattr(kaboum, node.name))
    stated = parameters(node)
    overloaded = any(getattr(d, "id", "") == "overload" for d in node.decorator_list)
    assert [p[:2] for p in stated] == [p[:2] for p in there]
    for (name, _, a), (_, _, b) in zip(stated, there):
        assert a == b or (overloaded and name == "vertices"), name


@pytest.mark.parametrize("name", CLASSES)
def test_class(name):
    there = getattr(kaboum, name)
    stated = {n.name: n for n in CLASSES[name].body if isinstance(n, ast.FunctionDef)}
    fields = {n.target.id for n in CLASSES[name].body if isinstance(n, ast.AnnAssign)}
    special = {"__init__", "__len__", "__bool__"}
    has = {k for k, v in vars(there).items() if not k.startswith("_") or k in special}
    if issubclass(there, Exception):
        has -= special
    elif there.__init__.__doc__ is None or "(self: " not in there.__init__.__doc__:
        has -= {"__init__"}  # made by functions only
    assert has == set(stated) | fields
    for member, node in stated.items():
        value = inspect.getattr_static(there, member)
        is_property = any(getattr(d, "id", "") == "property" for d in node.decorator_list)
        assert isinstance(value, property) == is_property, member
        if not is_property and member not in ("__len__", "__bool__"):
            assert parameters(node) == [p for p in of_docstring(getattr(there, member)) if p[0] != "self"]


# By function of Python: its tables, its keywords that are no options, and the program that has the tables' options, too.
RUNS = {"threads", "progress"}
FRONT_ENDS = {
    "prepare": (["prepare"], set(), "mesh-prepare"),
    "wrap": (["wrap"], {"precision"} | RUNS, "mesh-prepare"),
    "decimate": (["decimate"], {"output_format"} | RUNS, "bmesh-decimate"),
    "decompose": (["decompose"], {"epsilon_map", "no_cache"} | RUNS, "bcd-decompose"),
    "certify_robot": (["held_shapes", "certify_robot"], {"epsilons", "epsilon_map", "robot_bodies", "robot_vertices", "partial", "no_cache"} | RUNS,
                      "bcd-decompose"),
    "decimate_robot": (["held_shapes", "decimate_robot"], {"epsilons", "output_format", "partial", "no_cache"} | RUNS, "bmesh-decimate"),
    "sweep": (["sweep"], {"verify", "no_cache"} | RUNS, "sweep-approx"),
    "hausdorff": (["hausdorff"], RUNS, "hausdorff-eval"),
    "verify_mesh": (["verify_mesh"], {"relation"} | RUNS, "bound-verify mesh"),
    "verify_cover": (["verify_cover"], {"epsilon_map"} | RUNS, "bound-verify cover"),
    "verify_robot": (["verify_robot"], {"epsilon_map"} | RUNS, "bound-verify robot"),
    "verify_spheres": (["shapes"], {"epsilon", "epsilon_map"} | RUNS, "bound-verify robot"),
    "write_spheres": (["shapes"], {"epsilon", "epsilon_map", "robot_bodies", "share", "effort", "pairs", "no_cache"} | RUNS, "bcd-decompose"),
    "repair_spheres": (["shapes"], {"epsilon", "effort"} | RUNS, "bcd-decompose"),
    "verify_sweep": (["verify_sweep"], RUNS, "bound-verify sweep"),
    "World.__init__": (["margins"], set(), "kaboum-check"),
    "write_heatmap": (["hausdorff"], RUNS, "hausdorff-eval"),
    "draw": (["draw"], set(), "mesh-picture"),
    "World.check": (["check"], {"robot", "progress"}, "kaboum-check"),
    "World.contact_pairs": (["engines"], {"robot", "progress"}, "kaboum-check"),
    "World.check_motion": (["check_motion", "keep"], {"robot", "progress"}, "kaboum-check"),
    "World.motions_are_free": (["check_motion"], {"robot", "progress"}, "kaboum-check"),
    "World.stays_inside": (["check_motion"], {"robot", "progress"}, "kaboum-check"),
    "World.nearest": (["check"], {"robot", "progress"}, "kaboum-check"),
    "World.draw": (["check"], {"robot"}, "kaboum-check"),
    "update_scene": (["update_scene"], {"no_cache"} | RUNS, "kaboum-scene update"),
    "add_grasps": (["add_grasps"], set(), "kaboum-scene grasps"),
    "add_places": (["add_places"], set(), "kaboum-scene places"),
    "World.find_path": (["find_path", "keep"], {"robot", "progress"}, "kaboum-move"),
    "Path.trajectory": (["trajectory"], {"progress"}, "kaboum-move"),
    "make_scene": (["make_scene"], {"robots", "objects", "regions", "at", "scale", "no_cache"} | RUNS, "kaboum-scene make"),
    "World.link_pairs": (["link_pairs"], {"robot", "progress"}, "kaboum-scene pairs"),
    "inverse_kinematics": (["inverse_kinematics"], {"tip", "base", "pose_of", "reference", "progress"}, "kaboum-ik"),
    "solve": (["solve", "task", "margins"], {"scene", "assume", "no_cache"} | RUNS, "kaboum-plan solve"),
    "check_plan": (["task", "margins"], {"scene"} | RUNS, "kaboum-plan check"),
    "draw_plan": (["task"], {"scene", "format", "tree", "progress"}, "kaboum-plan show"),
    "write_plan_page": (["plan_page", "task"], {"scene", "tree", "progress"}, "kaboum-plan show"),
    "write_run_page": (["plan_page"], {"scene", "progress"}, "kaboum-plan page"),
    "run_plan": (["run_plan", "task"], {"scene", "outcomes", "trajectories"} | RUNS, "kaboum-plan run"),
}


def options_in_help(program):
    name, *command = program.split()
    path = pathlib.Path(os.environ["KABOUM_BIN"]) / name
    text = subprocess.run([path, *command, "--help"], check=True, capture_output=True, text=True).stdout
    return {option for line in re.findall(r"^  (-[-a-z,]+)", text, re.M) for option in line.split(",")}


def test_every_table_has_front_ends():
    assert set(kaboum._kaboum._option_tables()) == {t for tables, _, _ in FRONT_ENDS.values() for t in tables}


@pytest.mark.parametrize("function", FRONT_ENDS)
def test_every_front_end_has_every_option(function):
    tables, own, program = FRONT_ENDS[function]
    owner, _, name = function.rpartition(".")
    nodes = [n for n in CLASSES[owner].body if isinstance(n, ast.FunctionDef)] if owner else FUNCTIONS
    node = next(n for n in nodes if n.name == name)
    documented = getattr(getattr(kaboum, owner) if owner else kaboum, name)
    all_tables = kaboum._kaboum._option_tables()
    options = [o for table in tables for o in all_tables[table]]
    keywords = {name for name, kind, _ in parameters(node) if kind == "keyword"}
    assert keywords == own | {o["keyword"] for o in options}
    assert {name for name, kind, _ in of_docstring(documented) if kind == "keyword"} == keywords
    for option in options:
        assert f"\n{option['keyword']} : {option['type']}" in documented.__doc__
    assert {f"--{o['name']}" for o in options} <= options_in_help(program)


@pytest.mark.parametrize("given, says", [
    ({"max_bodies": 0}, "max_bodies must be a whole number from 1 to 100000"),
    ({"max_bodies": 2.0}, "max_bodies must be an int"),
    ({"max_bodies": True}, "max_bodies must be an int"),
    ({"simplify": float("nan")}, "simplify must be a number from 0 to 1"),
    ({"epsilon": "1mn"}, "epsilon must be a positive number"),
    ({"epsilon": -1}, "epsilon must be a positive number"),
    ({"effort": "fastt"}, "did you mean 'fast'"),
    ({"drop_sheets": 1}, "drop_sheets must be True or False"),
    ({"seal": "1%"}, "seal needs prepare wrap"),
    ({"direction": "inner", "simplify": 0.25}, "simplify needs direction outer"),
    ({"epsilon_map": [{}], "max_bodies": 3}, "epsilon_map does not go with max_bodies"),
    ({"epsilon_map": [{}], "max_aspect": 8.0}, "epsilon_map does not go with max_aspect"),
    ({"epsilon_map": [{}], "direction": "inner"}, "epsilon_map needs direction outer"),
    ({"epsilon_map": {}}, "epsilon_map must be the name of a file, or a list of dicts"),
    ({"epsilon_map": [{"epsilon": float("nan")}]}, "epsilon_map: numbers must be finite"),
])
def test_wrong_values_are_named(given, says):
    with pytest.raises(kaboum.Error, match=re.escape(says)) as error:
        kaboum.decompose("none.off", **given)
    assert error.value.code == "invalid_argument"


def test_unknown_keywords_are_type_errors():
    with pytest.raises(TypeError, match="did you mean 'max_bodies'"):
        kaboum.decompose("none.off", max_bodie=3)
