"""Planning with geometry: Tables 6.2, 6.4 and 6.7 of the thesis and Table IV of the workshop paper beside ours."""

import json
import math
import pathlib
import re
import statistics

import thesis
from calls import Calls
from document import figure, written

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENARIOS = ROOT / "examples" / "scenarios"
SEARCHES = {"depth-first": "dfs", "breadth-first": "bfs", "iterative deepening": "ids", "greedy": "greedy"}
NOTHING = "—"
SLOW = 5  # seconds after which one run of Table 6.4 is enough
LIMIT = 60  # CPU seconds of the planner
REPEATS = 5  # runs that do the same: what differs is the timer
KILLED = (256 - 24, 256 - 9)  # exit codes of a script whose planner ran into LIMIT (SIGXCPU, SIGKILL)
QUANTITIES = {  # as the thesis's tables name them, and what they are here
    "total_time_s": "total time [s]", "symbolic_planning_s": "symbolic planning [s]",
    "geometric_search_s": "geometric search [s]", "inverse_kinematics_calls": "inverse kinematics, calls",
    "inverse_kinematics_s": "inverse kinematics [s]", "collision_checks": "collision checks",
    "collision_checking_s": "collision checking [s]", "positive_collision_checks_percent": "positive checks [%]",
    "geometric_states": "geometric states", "actions_in_plan": "actions in plan", "waypoints_in_plan": "waypoints in plan",
    "path_planning_s": "path planning [s]", "swept_volumes_s": "swept volumes [s]", "volume_triangles": "triangles",
    "volume_bodies": "convex bodies", "volume_tests": "tests of volumes", "volume_tests_s": "tests of volumes [s]"}
TIMES = {key for key in QUANTITIES if key.endswith("_s")}
VOLUMES = ("path_planning_s", "swept_volumes_s", "volume_triangles", "volume_bodies", "volume_tests", "volume_tests_s")
DIFFERS = (
    "Robots, parts and machine are not the thesis's: the scenes are those of examples/scenarios, robots with a spherical wrist and "
    "parts of 130 to 640 vertices that the project makes. What is counted differs as well. The thesis's collision check is "
    "one configuration on the way between given waypoints; here paths are searched for, a check is a configuration or a straight motion that is "
    "decided at every instant, and the row of collision checking holds all of that search. Positive checks are motions that were not "
    "free. Actions take the robot home again, where the thesis moves it by actions of their own; that shortens plans. So no factor is given. "
    "Times are user CPU seconds of one process, without loading, on a machine that others use; parts of them are stopped by the clock and scaled. "
    f"A planner may take {LIMIT} CPU seconds. Where all runs count the same, nothing but the timer varies: then counts are given once, and of times the "
    "median (least–most). Else x ± y: mean and standard deviation over the seeds. What compares worst with the thesis comes first.")


def statistics_of(solve, plan):
    """What the thesis's tables count, of one run's report and plan."""
    geometry, search = solve["geometry"], solve["statistics"]
    total = solve["resources"]["user_seconds_searching"]
    # Parts are stopped by the clock, which runs on while other programs have the processor.
    share = total / solve["resources"]["wall_seconds"]
    external = min(total, share * search["external_s"])
    return {
        "total_time_s": total, "symbolic_planning_s": total - external, "geometric_search_s": external,
        "inverse_kinematics_calls": geometry["ik_calls"], "inverse_kinematics_s": share * geometry["ik_s"],
        "collision_checks": geometry["predicate_calls"], "collision_checking_s": share * geometry["path_s"],
        "positive_collision_checks_percent": 100 * geometry["positive"] / max(1, geometry["predicate_calls"]),
        "geometric_states": search["states_kept"], "actions_in_plan": solve["plan"]["longest_path"],
        "waypoints_in_plan": waypoints(plan),
        "path_planning_s": share * geometry["path_s"], "swept_volumes_s": share * geometry["volume_s"],
        "volume_triangles": geometry["volume_triangles"], "volume_bodies": geometry["volume_bodies"],
        "volume_tests": geometry["volume_tests"], "volume_tests_s": share * geometry["volume_test_s"]}


def waypoints(plan):
    """Of all motions of a plan, each one's start left out."""
    total = 0
    for node in plan["nodes"]:
        for call in node.get("calls", []):
            try:
                motions = json.loads(call.get("payload") or "null")
            except ValueError:
                continue
            if isinstance(motions, list):
                total += sum(max(0, len(m.get("path", [])) - 1) for m in motions if isinstance(m, dict))
    return total


class Runs:
    """Runs of scenarios, each once."""

    def __init__(self, context):
        self.call = Calls(context, "scenarios")
        self.programs = context.runner.programs
        self.quick = context.quick
        self.seeds = range(1, 4 if context.quick else 13)
        self.table, self.unchecked = [], []

    def one(self, name, n, search, seed, *options):
        """The report of a run; None: no plan within the limit."""
        folder = "-".join([name, str(n), search, f"seed{seed}", *(o.strip("-") for o in options)])
        solve, plan = f"{folder}/solve.json", f"{folder}/plan.json"
        inputs = [self.programs / "kaboum-scene", self.programs / "kaboum-plan", SCENARIOS / name / ("volumes.kpl" if "--volumes" in options else "domain.kpl"),
                  SCENARIOS / "parts.py", SCENARIOS / "scenario.py"]
        # 1, 7: no plan within the limits; 8: none that the knowledge state can infer. The limit is of CPU time; that of the program, of
        # the clock, is out of the way.
        code = self.call(folder, SCENARIOS / name / "run",
                         [n, "--seed", seed, "--search", search, "--timeout", 1000 * LIMIT, "--no-cache", "--plan-only",
                          "--out", folder, *options], inputs, [solve, plan], codes=(0, 1, 7, 8, *KILLED), limit=LIMIT)
        if code in KILLED and all((self.call.folder / file).is_file() for file in (solve, plan)):
            self.unchecked.append(f"{name} {n} {search}")  # planning ended, and checking the plan did not
        elif code != 0:
            return None
        found = statistics_of(self.call.report(solve), self.call.report(plan))
        self.table.append([name, n, search, seed, " ".join(options), *found.values()])
        return found

    def several(self, name, n, search, *options):
        """Runs with all seeds; none where the first one finds no plan; no more than REPEATS where seeds change nothing."""
        found = []
        for seed in self.seeds:
            one = self.one(name, n, search, seed, *options)
            if one is None:
                break
            found.append(one)
            if one["total_time_s"] > SLOW and name == "stacked" or len(found) >= REPEATS and not varies(found):
                break
        return found

    def write(self, document, folder, name):
        if self.unchecked:
            document.paragraph(f"Plans that were not checked within {LIMIT} s of CPU time: {', '.join(dict.fromkeys(self.unchecked))}.")
        written(folder / f"scenarios-{name}.csv", ["scenario", "n", "search", "seed", "options", *QUANTITIES], self.table)


def varies(found):
    """Whether anything that is counted differs between runs."""
    counted = [key for key in found[0] if key not in TIMES]
    return any([one[key] for key in counted] != [found[0][key] for key in counted] for one in found)


def cell(found, key):
    """What runs say of a quantity."""
    values = [one[key] for one in found]
    if varies(found) and (key in TIMES or len(set(values)) > 1):
        return f"{figure(statistics.fmean(values))} ± {figure(statistics.stdev(values))}"
    if key not in TIMES and values[0] == int(values[0]):
        return f"{values[0]:,.0f}"
    if key not in TIMES or len(values) == 1:
        return figure(values[0])
    return f"{figure(statistics.median(values))} ({figure(min(values))}–{figure(max(values))})"


def worst_first(keys, pairs):
    """The keys, those first where one of ours is largest for what the other has; `pairs`: (key -> printed text or None, runs)."""
    def ratio(key):
        logs = []
        for printed, found in pairs:
            said = float(str(printed.get(key) or 0).split(" ")[0] or 0)
            mean = statistics.fmean(one[key] for one in found) if found else 0
            if said > 0 and mean > 0:
                logs.append(math.log(mean / said))
        return -max(logs) if logs else math.inf
    return sorted(keys, key=ratio)


def how_many(found):
    if len(found) == 1:
        return "one run"
    return f"{len(found)} seeds" if varies(found) else f"{len(found)} runs, all alike"


def compared(document, runs, name, n, printed, quantities):
    """A table as 6.2 and 6.7: each quantity, the thesis's and ours, by search."""
    ours = {title: runs.several(name, n, search) for title, search in SEARCHES.items()}

    def said(key, title):
        return printed.get((key, title.replace(" ", "_").replace("-", "_")))
    pairs = [({key: said(key, title) for key in quantities}, found) for title, found in ours.items() if title != "greedy"]
    rows = []
    for key in worst_first(quantities, pairs):
        row = [QUANTITIES[key]]
        for title, found in ours.items():
            if title != "greedy":
                row.append(said(key, title) or NOTHING)
            row.append(cell(found, key) if found else NOTHING)
        rows.append(row)
    header = ["quantity"]
    for title in SEARCHES:
        header += [f"thesis, {title}", f"ours, {title}"] if title != "greedy" else ["ours, greedy"]
    document.table(header, rows)
    document.paragraph("Ours: " + "; ".join(f"{title}: {how_many(found)}" if found else f"{title}: no plan within {LIMIT} s of CPU time"
                                            for title, found in ours.items()) + ".")


def row_of(by, keys, cell_of):
    """The cells of one side of a table: what `cell_of` says of each quantity."""
    return [by, *(cell_of(key) or NOTHING for key in keys)]


def own_row(found, keys):
    return row_of(f"ours, {how_many(found)}", keys, lambda key: cell(found, key))


TABLE_6_4 = {"total_time_s": "total_time_s", "symbolic_planning_s": "symbolic_planning_s", "geometric_search_s": "geometric_search_s",
             "inverse_kinematics_calls": "ik_calls", "inverse_kinematics_s": "ik_time_s", "collision_checks": "collision_checks",
             "collision_checking_s": "collision_time_s", "positive_collision_checks_percent": None, "geometric_states": None,
             "waypoints_in_plan": None, "actions_in_plan": "actions"}
MOST = {"depth-first": 7, "breadth-first": 6, "iterative deepening": 7, "greedy": 20}


def stacked_section(context, document):
    runs = start(context, document, "Table 6.4: STACKED n OBJECTS")
    if runs is None:
        return
    document.paragraph("The thesis has one run each, and a limit of 300 s; its robot has five axes as well. The first run beyond "
                       f"{SLOW} s is the only one. A larger n is not tried where a smaller one was not solved.")
    printed = {(r["search"], int(r["n"])): r for r in thesis.planning("table-6-4.csv")}
    lines, pairs = [], []
    for title, search in SEARCHES.items():
        solved = True
        for n in (2, 3, 4) if runs.quick else (2, 3, 4, 5, 6, 7, 8, 12, 20):
            said = printed.get((title.replace(" ", "_").replace("-", "_"), n))
            tried = solved and n <= MOST[title]
            found = runs.several("stacked", n, search) if tried else []
            if not found and said is None:
                break
            lines.append((title, n, said, found, tried))
            if said and said["total_time_s"].replace(".", "").isdigit():
                pairs.append(({key: said.get(name or "") for key, name in TABLE_6_4.items()}, found))
            solved = bool(found)
    keys = worst_first(TABLE_6_4, pairs)
    rows = []
    for title, n, said, found, tried in lines:
        if said is not None:
            rows.append([title, str(n), *row_of("thesis", keys, lambda key, said=said: said.get(TABLE_6_4[key] or ""))])
        rows.append([title, str(n), *(own_row(found, keys) if found else [f"ours: none in {LIMIT} s of CPU time" if tried else "ours: not tried",
                                                                          *(NOTHING for _ in keys)])])
    document.table(["search", "n", "by", *(QUANTITIES[key] for key in keys)], rows)
    runs.write(document, context.folder, "stacked")


TABLE_IV = {"total_time_s": "total_planning_s", "inverse_kinematics_s": "inverse_kinematics_s", "path_planning_s": "path_planning_s",
            "swept_volumes_s": "swept_volume_s", "volume_triangles": "triangles", "volume_bodies": "convex_bodies",
            "volume_tests": "collision_tests", "volume_tests_s": "collision_s"}


def remove_section(context, document):
    runs = start(context, document, "Workshop paper, Table IV: REMOVE n OBJECTS")
    if runs is None:
        return
    document.paragraph("The paper's eight columns, those first in which ours compare worst. Greedy search; random: scenes drawn anew for each seed; "
                       "worst: in lines, where the foremost block of each hides the others. \"Ours\" makes the volume of fetching each block "
                       "(run --volumes) and tries it against each block that still stands, as the paper does; bodies follow their motion within "
                       "2 mm, certified at every instant, where the paper's are samples with 16 triangles each. Volumes are made in parallel, "
                       "so that their seconds, wall time by the share of this process, may be more than their part of the total. "
                       "\"Without volumes\" decides motions themselves (run): checks are configurations and motions, and there are no volumes.")
    lines, pairs = [], []
    without = dict.fromkeys(VOLUMES[1:], NOTHING)
    for case, options in (("random", ()), ("worst", ("--line",))):
        for said in (r for r in thesis.planning("table-iv.csv") if r["case"] == case):
            n = int(said["n"])
            if runs.quick and n not in (2, 5):
                continue
            found = {by: runs.several("remove", n, "greedy", *options, *more) for by, more in (("volumes", ("--volumes",)), ("without volumes", ()))}
            lines.append((case, n, said, found))
            pairs.append(({key: said.get(name) for key, name in TABLE_IV.items()}, found["volumes"]))
    keys, rows = worst_first(TABLE_IV, pairs), []
    for case, n, said, found in lines:
        rows.append([case, str(n), *row_of("paper", keys, lambda key, said=said: said.get(TABLE_IV[key]))])
        for by, some in found.items():
            if not some:
                rows.append([case, str(n), f"ours, {by}: none in {LIMIT} s of CPU time", *(NOTHING for _ in keys)])
                continue
            by_and_cells = own_row(some, keys)
            if by != "volumes":
                by_and_cells[1:] = [without.get(key, text) for key, text in zip(keys, by_and_cells[1:])]
            rows.append([case, str(n), by_and_cells[0] + (", without volumes" if by != "volumes" else ""), *by_and_cells[1:]])
    document.table(["case", "n", "by", *(QUANTITIES[key] for key in keys)], rows)
    runs.write(document, context.folder, "remove")


LINE = re.compile(r"^(?P<what>.+?)\s+mean +(?P<mean>[\d.]+) us, median +[\d.]+, 99 % +(?P<late>[\d.]+), most +[\d.]+"
                  r"(?: \((?P<times>[\d.]+) times\))?")


def exact_section(context, document):
    """The ratio of Table 6.7: one configuration's check by exact meshes and by bounding sets, with several libraries."""
    runs = start(context, document, "Exact meshes against bounding sets (Table 6.7, Proposition 4)")
    if runs is None:
        return
    document.paragraph("Table 6.7 says of BIMANUAL ASSEMBLY, by the time of all collision checks: exact meshes took "
                       + " and ".join(f"{ratio:.0f} times with {library} ({search.replace('_', '-')})"
                                      for library, search, ratio in thesis.exact_ratios())
                       + " what bounding sets took. Here single configurations are looked at: "
                       "a robot of that scenario among twenty pipes at random places, links against objects. Whole searches are below.")
    program = runs.programs.parent / "benchmarks" / "world-benchmark"
    if not program.is_file():
        document.paragraph("Left out: world-benchmark is not built; cmake --preset release -DKABOUM_BUILD_BENCHMARKS=ON, with "
                           "FCL, Bullet and ODE.")
        return
    call, folder = runs.call, "bimanual-assembly-4-scene"
    made = call("scene of the assembly", SCENARIOS / "bimanual-assembly" / "run", [4, "--scene-only", "--out", folder],
                [runs.programs / "kaboum-scene", SCENARIOS / "parts.py", SCENARIOS / "scenario.py"],
                [f"{folder}/robot1.urdf", f"{folder}/pipe.off"])
    if made is None:
        return
    pipes = [text for k in range(20) for text in ("--object", f"pipe{k}=pipe.off")]
    command = ["make", f"{folder}/pipes.json", "--force", "--epsilon", "1%", "--effort", "fast", "--robot",
               f"robot1={folder}/robot1.urdf", *(t.replace("=", f"={folder}/") for t in pipes)]
    if call("scene of pipes", runs.programs / "kaboum-scene", command, [call.folder / folder / "pipe.off"],
            [f"{folder}/pipes.json"]) is None:
        return
    script = call.folder / "compare"
    script.write_text(f'#!/bin/sh\nexec "{program}" {folder}/pipes.json {folder}/robot1.urdf {folder}/pipe.off "$1" 0 > times.txt\n')
    script.chmod(0o755)
    if call("times of checks", script, [300 if runs.quick else 3000], [program, call.folder / folder / "pipes.json"],
            ["times.txt"]) is None:
        return
    rows, where = [], ""
    for line in (call.folder / "times.txt").read_text().splitlines():
        found = LINE.match(line)
        if line.endswith(":") and not found:
            where = line.rstrip(":")
        if found:
            rows.append([where, found["what"], found["mean"], found["late"], f"{found['times']}×" if found["times"] else NOTHING])
    document.paragraph("Of a library that has both, exact meshes against its own bounding sets is Proposition 4; where sets take longer, it does not "
                       "hold there.")
    document.table(["configurations", "by", "mean [µs]", "99 % [µs]", "times of the first"], rows)


SEARCH_TIMES = {"exact_fcl": "exact, FCL", "exact_ode": "exact, ODE", "exact_bullet": "exact, Bullet", "sets_fcl": "sets, FCL",
                "sets_bullet": "sets, Bullet", "sets_sampled": "sets, ours at samples", "sets_at_every_instant": "sets, ours at every instant"}


def whole_searches_section(context, document):
    """The same for all that the predicates were asked in whole searches."""
    runs = start(context, document, "Exact meshes against bounding sets, all checks of a search")
    if runs is None:
        return
    document.paragraph("All that the predicates are asked during a search is recorded and decided again, in one process and by CPU time: by exact "
                       "meshes in FCL, ODE and Bullet as packaged (trees of triangles; boxes along the axes first), by bounding sets as convex shapes in FCL and "
                       "Bullet, and by our predicates. The libraries know no motions at every instant: they look at them at samples between which no point of the robot "
                       "moves farther than 2 cm, the thesis's ε, and stop at the first contact; between samples that proves nothing. First the times, then what exact "
                       "meshes take for what bounding sets take that the planner decides at every instant, and for the same library's bounding sets at the same samples. "
                       "Below 1× sets take longer than exact meshes in the same library, against Proposition 4. Contacts found differ where a "
                       "library's answer does; sets enclose the meshes, so that fewer than by exact meshes are wrong.")
    program = runs.programs.parent / "benchmarks" / "search-benchmark"
    if not program.is_file():
        document.paragraph("Left out: search-benchmark is not built; cmake --preset release -DKABOUM_BUILD_BENCHMARKS=ON, with FCL, Bullet and ODE.")
        return
    rows, counts = [], []
    cases = [("bimanual-assembly", 4, "bfs", 1), ("bimanual-assembly", 4, "dfs", 1), ("bimanual-assembly", 4, "dfs", 4),
             ("bimanual-assembly", 4, "ids", 1), ("circular-rearrange", 3, "greedy", 1), ("stacked", 7, "greedy", 1)]
    for name, n, search, detail in (cases[1:2] + cases[4:5]) if runs.quick else cases:
        call, folder = runs.call, f"{name}-{n}-scene" + (f"-{detail}" if detail > 1 else "")
        files = [f"{folder}/problem.kpl", f"{folder}/cell.json"]
        if call(f"making {folder}", SCENARIOS / name / "run", [n, "--scene-only", "--detail", detail, "--out", folder],
                [runs.programs / "kaboum-scene", SCENARIOS / "parts.py", SCENARIOS / "scenario.py", SCENARIOS / name / "run"], files) is None:
            continue
        result = f"whole-{name}-{n}-{search}-{detail}.txt"
        script = call.folder / f"{result}.sh"
        script.write_text(f'#!/bin/sh\nexec "{program}" "$1" {" ".join(files)} {search} > {result}\n')
        script.chmod(0o755)
        if call(f"exact meshes, {name} {n} {search} {detail}", script, [SCENARIOS / name / "domain.kpl"],
                [program, SCENARIOS / name / "domain.kpl", *(call.folder / f for f in files)], [result]) is None:
            continue
        found = json.loads((call.folder / result).read_text())
        seconds = {key: found[key]["s"] for key in SEARCH_TIMES}
        times = lambda exact, sets: f"{seconds[exact] / seconds[sets]:.1f}×"
        what = [f"{name} {n}", search, str(found["triangles"])]
        rows.append([*what, *(times(f"exact_{l}", f"sets_{l}") for l in ("fcl", "bullet")),
                     *(times(f"exact_{l}", "sets_at_every_instant") for l in ("fcl", "ode", "bullet")), *(figure(s) for s in seconds.values())])
        counts.append([*what, str(found["bodies"]), str(found["configurations"]), str(found["motions"]), str(found["exact_fcl"]["configurations"]),
                       *(str(found[key]["in_contact"]) for key in SEARCH_TIMES), str(found["missed"])])
    document.table(["scenario", "search", "triangles", *(f"exact ÷ sets, {l}, times" for l in ("FCL", "Bullet")),
                    *(f"exact, {l} ÷ ours, times" for l in ("FCL", "ODE", "Bullet")), *(f"{what} [s]" for what in SEARCH_TIMES.values())], rows)
    document.paragraph("What was asked, and how much of it each says to be in contact; missed: in contact by exact meshes, and free by our sets.")
    document.table(["scenario", "search", "triangles", "bodies of sets", "configurations", "motions", "samples",
                    *(f"in contact: {what}" for what in SEARCH_TIMES.values()), "missed"], counts)


ENGINES = {("own", "sets"): "ours, sets, at every instant", **{(engine, shapes): f"{name}, {what}" for engine, name in
           (("fcl", "FCL"), ("bullet", "Bullet"), ("ode", "ODE")) for shapes, what in (("meshes", "exact meshes"), ("sets", "sets"))}}
ENGINE_STEP = 0.02  # how far a point moves between samples of others [m]: the thesis's epsilon


def engine_searches_section(context, document):
    """Table 6.7 as the product's own comparison: the planner searches with each library, by exact meshes and by sets."""
    runs = start(context, document, "Whole searches by exact meshes and by sets (Table 6.7, Proposition 4)")
    if runs is None:
        return
    document.paragraph("`kaboum-plan solve --engine own|fcl|bullet|ode --engine-shapes sets|meshes`: a search of its own for each, as Table 6.7 compares them. Answers "
                       f"decide how a search goes on, so that searches by meshes and by sets ask different questions. Libraries look at motions at samples, {100 * ENGINE_STEP:g} cm "
                       "apart at most, and certify nothing. User CPU seconds of the search, without loading; one run each. ÷ sets: this time, divided by that of "
                       "the same library's sets; below 1 sets take longer, against Proposition 4.")
    cases = [("dfs", 1)] if runs.quick else [(search, detail) for search in ("bfs", "dfs", "ids") for detail in (1, 4)]
    for search, detail in cases:
        call, folder, domain = runs.call, "bimanual-assembly-4-scene" + (f"-{detail}" if detail > 1 else ""), SCENARIOS / "bimanual-assembly" / "domain.kpl"
        files = [f"{folder}/problem.kpl", f"{folder}/cell.json"]
        if call(f"making {folder}", SCENARIOS / "bimanual-assembly" / "run", [4, "--scene-only", "--detail", detail, "--out", folder],
                [runs.programs / "kaboum-scene", SCENARIOS / "parts.py", SCENARIOS / "scenario.py", SCENARIOS / "bimanual-assembly" / "run"], files) is None:
            continue
        found = {}
        for (engine, shapes), title in ENGINES.items():
            result = f"engine-{search}-{detail}-{engine}-{shapes}.json"
            options = [] if engine == "own" else ["--engine", engine, "--engine-shapes", shapes, "--engine-step", ENGINE_STEP]
            if call(f"assembly {search} {detail}, {title}", runs.programs / "kaboum-plan",
                    ["solve", domain, files[0], "--scene", files[1], "--search", search, "--no-cache", "--quiet", *options, "--report", result, "-o", f"plan-{result}"],
                    [domain, *(call.folder / file for file in files)], [result]) is not None:
                found[engine, shapes] = call.report(result)
        seconds = {key: report["resources"]["user_seconds_searching"] for key, report in found.items()}
        rows = [[ENGINES[key], figure(seconds[key]), f"{seconds[key] / seconds[key[0], 'sets']:.2f}×" if key[1] == "meshes" and (key[0], "sets") in seconds else NOTHING,
                 str(report["geometry"]["predicate_calls"]), str(report["geometry"]["positive"]), str(report["geometry"]["ik_calls"]), str(report["plan"]["longest_path"])]
                for key, report in sorted(found.items(), key=lambda item: -seconds[item[0]])]
        document.heading(f"BIMANUAL ASSEMBLY, {search}, {detail * detail} times the triangles", 3)
        document.table(["by", "search [s]", "÷ sets", "checks", "positive", "inverse kinematics, calls", "actions in plan"], rows)


def assembly_section(context, document):
    runs = start(context, document, "Table 6.7: BIMANUAL ASSEMBLY")
    if runs is None:
        return
    document.paragraph("The thesis's rows are those of bounding sets (ε < 0.02 m) with Bullet. Here ε is 1 % of each mesh's diagonal. What exact meshes "
                       "cost is in the two sections on exact meshes.")
    compared(document, runs, "bimanual-assembly", 4, thesis.by_search("table-6-7.csv", geometry="bounded_0.02m", library="Bullet"),
             [k for k in QUANTITIES if k not in VOLUMES])
    runs.write(document, context.folder, "assembly")


def circular_section(context, document):
    runs = start(context, document, "Table 6.2: BIMANUAL CIRCULAR REARRANGE, three objects")
    if runs is None:
        return
    document.paragraph(DIFFERS)
    compared(document, runs, "circular-rearrange", 3, thesis.by_search("table-6-2.csv"),
             [k for k in QUANTITIES if k != "waypoints_in_plan" and k not in VOLUMES])
    runs.write(document, context.folder, "circular-rearrange")


def start(context, document, heading):
    """Runs of scenarios; None where there is nothing to run, or not yet."""
    if context.collecting:
        return None
    document.heading(heading)
    if not (context.runner.programs / "kaboum-plan").is_file():
        document.paragraph("Left out: kaboum-plan is not built.")
        return None
    return Runs(context)
