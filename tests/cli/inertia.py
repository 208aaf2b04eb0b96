#!/usr/bin/env python3
"""bcd-decompose --inertia: bounds hold the exact integrals, by fractions and another formula than the program's.

usage: inertia.py BIN
"""
import itertools
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from fractions import Fraction

TOOLS = pathlib.Path(sys.argv[1]).absolute()
PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
PI = (Fraction(314159265358979323846264338327, 10**29), Fraction(314159265358979323846264338328, 10**29))


def fail(what):
    raise SystemExit(f"inertia.py: {what}")


def box(low, high):
    return [[tuple(Fraction(str((high if k >> i & 1 else low)[i])) for i in range(3)) for k in t]
            for q in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)) for t in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]


def turned(triangles):
    return [[t[0], t[2], t[1]] for t in triangles]


def monomial(triangle, exponents):
    """∫ over the surface of x^a y^b z^c times the normal's x, by barycentric coordinates, exactly."""
    poly = {(0, 0, 0): Fraction(1)}
    for axis, exponent in enumerate(exponents):
        for _ in range(exponent):
            grown = {}
            for (i, j, k), value in poly.items():
                for corner in range(3):
                    key = tuple(x + (corner == n) for n, x in enumerate((i, j, k)))
                    grown[key] = grown.get(key, 0) + value * triangle[corner][axis]
            poly = grown
    p, q, r = triangle
    normal_x = (q[1] - p[1]) * (r[2] - p[2]) - (q[2] - p[2]) * (r[1] - p[1])
    return normal_x * sum(v * Fraction(math.factorial(i) * math.factorial(j) * math.factorial(k), math.factorial(i + j + k + 2))
                          for (i, j, k), v in poly.items())


def integral(triangles, exponents):
    """∫ over the solid of a monomial: the divergence of x^(a+1)/(a+1) y^b z^c along x."""
    a, b, c = exponents
    return sum(monomial(t, (a + 1, b, c)) for t in triangles) / (a + 1)


def moments(triangles):
    """∫ of 1, x, y, z and the six products."""
    keys = [(0, 0, 0)] + [tuple(int(i == k) for k in range(3)) for i in range(3)] + [tuple((i == n) + (k == n) for n in range(3)) for i, k in PAIRS]
    return [integral(triangles, key) for key in keys]


def mass_of(m, density=None, mass=None):
    """Mass, centre, inertia, of exact moments."""
    density = Fraction(mass) / m[0] if density is None else Fraction(density)
    centre = [m[1 + i] / m[0] for i in range(3)]
    c = [density * (m[4 + p] - m[0] * centre[i] * centre[k]) for p, (i, k) in enumerate(PAIRS)]
    return density * m[0], centre, [c[1] + c[2], c[0] + c[2], c[0] + c[1], -c[3], -c[4], -c[5]]


def off(triangles):
    points = sorted({p for t in triangles for p in t})
    at = {p: i for i, p in enumerate(points)}
    return (f"OFF\n{len(points)} {len(triangles)} 0\n" + "".join(" ".join(repr(float(x)) for x in p) + "\n" for p in points) +
            "".join("3 " + " ".join(str(at[p]) for p in t) + "\n" for t in triangles))


def exact(triangles):
    """The doubles that the program reads, as fractions."""
    return [[tuple(Fraction(float(x)) for x in p) for p in t] for t in triangles]


def run(place, robot, *options, code=0):
    done = subprocess.run([str(TOOLS / "bcd-decompose"), robot, "-o", f"out_{pathlib.Path(robot).stem}", "--epsilon", "5%", "--effort", "fast", "--no-cache", "--report", "report.json",
                           *options], cwd=place, capture_output=True, text=True, check=False)
    if done.returncode != code:
        fail(f"{robot} {options}: exit code {done.returncode}, not {code}: {done.stderr}")
    return json.loads((place / "report.json").read_text()), done.stderr


def within(what, bounds, number, tight):
    lower, upper = (Fraction(x) for x in bounds)
    if not lower <= number <= upper:
        fail(f"{what}: {float(number)!r} is not within {bounds}")
    if tight and upper - lower > abs(number) * Fraction(1, 10**12) + Fraction(1, 10**15):
        fail(f"{what}: {bounds} are far apart")


def holds(entry, mass, centre, inertia, tight=True):
    name = entry["link"]
    if "kept" in entry:
        fail(f"{name}: {entry['kept']}")
    within(f"{name}: mass", entry["mass_bounds"], mass, tight)
    for i in range(3):
        within(f"{name}: centre {i}", entry["centre_bounds"][i], centre[i], tight)
    for p in range(6):
        within(f"{name}: inertia {p}", entry["inertia_bounds"][p], inertia[p], tight)
    for value, bounds in [(entry["mass"], entry["mass_bounds"])] + list(zip(entry["centre"] + entry["inertia"], entry["centre_bounds"] + entry["inertia_bounds"])):
        if not bounds[0] <= value <= bounds[1]:
            fail(f"{name}: {value} is outside its bounds {bounds}")


INERTIAL = '<inertial><origin xyz="0.25 0 0" rpy="0.5 0 0"/><mass value="2.5"/><inertia ixx="3" iyy="4" izz="5" ixy="0" ixz="0" iyz="0.125"/></inertial>'


def urdf(links):
    """A robot whose links stand in a row; links: name -> shapes, with a mass or without."""
    text, names = '<robot name="r">', list(links)
    for name, (shapes, has_mass) in links.items():
        text += f'\n<link name="{name}">{INERTIAL if has_mass else ""}' + "".join(f"<collision>{s}</collision>" for s in shapes) + "</link>"
    for a, b in itertools.pairwise(names):
        text += f'<joint name="to_{b}" type="fixed"><parent link="{a}"/><child link="{b}"/><origin xyz="2 0 0"/></joint>'
    return text + "</robot>\n"


def mesh(name, more="", scale="1 1 1"):
    return f'{more}<geometry><mesh filename="{name}.off" scale="{scale}"/></geometry>'


def masses_stay_apart(place):
    """Links and foreign elements of one name: each inertial is in the element of its link."""
    shape = '<collision name="c"><geometry><box><size>{0} {0} {0}</size></box></geometry></collision>'
    (place / "nested.sdf").write_text(
        '<sdf version="1.9"><model name="outer" canonical_link="base"><model name="inner"><link name="base"><inertial><mass>3</mass></inertial></link></model>'
        f'<link name="base"><inertial><mass>100</mass></inertial>{shape.format(2)}</link>'
        '<joint name="j" type="fixed"><parent>base</parent><child>inner::base</child></joint></model></sdf>')
    (place / "plugin.urdf").write_text('<robot name="r"><gazebo><plugin name="p" filename="x"><link name="base"/></plugin></gazebo>'
                                       f'<link name="base">{INERTIAL}<collision><geometry><box size="1 1 1"/></geometry></collision></link></robot>')
    bodies = "".join(f'<body {name}><joint axis="0 0 1"/><geom type="box" size="{size} {size} {size}"/><inertial pos="0 0 0" mass="{mass}" diaginertia="1 1 1"/></body>'
                     for name, size, mass in (("", 1, 100), ('name="body1" pos="5 0 0"', 0.1, 2)))
    (place / "names.xml").write_text(f"<mujoco><worldbody>{bodies}</worldbody></mujoco>")
    for name in ("nested.sdf", "plugin.urdf", "names.xml"):
        run(place, name, "--inertia", "mass")
    written = {name: ElementTree.parse(place / f"out_{pathlib.Path(name).stem}" / name).getroot() for name in ("nested.sdf", "plugin.urdf", "names.xml")}
    got = [[link.findtext("inertial/mass"), link.find("inertial/pose") is not None] for link in written["nested.sdf"].iter("link")]
    if [[float(mass), new] for mass, new in got] != [[3, False], [100, True]]:
        fail(f"nested.sdf: inner::base and base have {got}")
    if written["plugin.urdf"].find("gazebo/plugin/link/inertial") is not None or written["plugin.urdf"].find("link/inertial/mass").get("value") != "2.5":
        fail("plugin.urdf: an inertial is in a foreign element")
    if written["plugin.urdf"].find("link/inertial/inertia").get("ixx") == "3":
        fail("plugin.urdf: the link has its old inertial")
    got = [[float(body.find("inertial").get("mass")), float((body.find("inertial").get("fullinertia") or "nan").split()[0])] for body in written["names.xml"].iter("body")]
    if [mass for mass, _ in got] != [100, 2] or not all(math.isclose(moment, mass * size**2 * 2 / 3, rel_tol=1e-12) for (mass, moment), size in zip(got, (1, 0.1))):
        fail(f"names.xml: masses and moments of the bodies are {got}")


def main():
    ell = box((0, 0, 0), (0.4, 0.1, 0.3))
    nest = box((0, 0, 0), (1, 1, 1)) + box((0.25, 0.25, 0.25), (0.5, 0.5, 0.75))             # a body inside a body
    cavity = box((0, 0, 0), (1, 1, 1)) + turned(box((0.25, 0.25, 0.25), (0.5, 0.5, 0.75)))
    crossing = box((0, 0, 0), (1, 1, 1)) + box((0.5, 0.25, 0.25), (1.5, 0.75, 0.5))
    inverted = turned(box((0.1, 0.2, 0.3), (0.4, 0.9, 0.7)))
    opened = box((0, 0, 0), (1, 1, 1))[2:]
    far = box((1000, 1000, 1000), (1000.5, 1000.25, 1001))                                   # cancellation
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        for name, triangles in dict(ell=ell, nest=nest, cavity=cavity, crossing=crossing, inverted=inverted, opened=opened, far=far).items():
            (place / f"{name}.off").write_text(off(triangles))

        good = {"ell": ([mesh("ell")], True), "nest": ([mesh("nest")], True), "cavity": ([mesh("cavity")], True), "inverted": ([mesh("inverted")], True),
                "far": ([mesh("far")], True), "mirrored": ([mesh("ell", scale="1 -2 0.5")], True),
                "moved": ([mesh("ell", '<origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/>')], True),
                "box": (['<geometry><box size="0.2 0.3 0.4"/></geometry>'], False),
                "ball": (['<origin xyz="1 0 0"/><geometry><sphere radius="0.25"/></geometry>'], False),
                "rod": (['<geometry><cylinder radius="0.1" length="0.5"/></geometry>'], False), "none": ([], True)}
        (place / "good.urdf").write_text(urdf(good))
        before = (place / "good.urdf").read_text()

        # Without the option what was in the file stays, byte for byte.
        run(place, "good.urdf")
        as_read = re.sub(r">\s+<", "><", (place / "out_good/good.urdf").read_text())
        if as_read.count(INERTIAL) != before.count(INERTIAL):
            fail("inertials are other ones without --inertia")

        report, err = run(place, "good.urdf", "--inertia", "800", "--robot-format", "mjcf,sdf")
        entry = {e["link"]: e for e in report["inertia"]}
        if "none" in entry or len(entry) != 10:
            fail(f"links of the report: {sorted(entry)}")
        for name in ("ell", "cavity", "far"):
            holds(entry[name], *mass_of(moments(exact({"ell": ell, "cavity": cavity, "far": far}[name])), density=800))
        holds(entry["nest"], *mass_of(moments(exact(nest[:12])), density=800))
        holds(entry["inverted"], *mass_of(moments(exact(turned(inverted))), density=800))
        flat = [[(p[0], -2 * p[1], p[2] / 2) for p in t] for t in exact(ell)]
        holds(entry["mirrored"], *mass_of(moments(turned(flat)), density=800))
        quarter = [[(1 - p[1], 2 + p[0], 3 + p[2]) for p in t] for t in exact(ell)]
        holds(entry["moved"], *mass_of(moments(quarter), density=800), tight=False)
        if entry["moved"]["mass_bounds"][1] - entry["moved"]["mass_bounds"][0] > 1e-12:
            fail("a rotation changes the mass")
        holds(entry["box"], *mass_of(moments([[tuple(x * Fraction(s) for x, s in zip(p, (0.2, 0.3, 0.4))) for p in t] for t in box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))]), density=800))
        r, l = Fraction(0.25), Fraction(0.5)
        for pi in PI:
            m = 800 * pi * r**3 * 4 / 3
            i = m * r**2 * 2 / 5
            holds(entry["ball"], m, [1, 0, 0], [i, i, i, 0, 0, 0])
            r2 = Fraction(0.1)
            m = 800 * pi * r2**2 * l
            holds(entry["rod"], m, [0, 0, 0], [m * (3 * r2**2 + l**2) / 12] * 2 + [m * r2**2 / 2, 0, 0, 0])
        written = ElementTree.parse(place / "out_good/good.urdf").getroot()
        for link in written.findall("link"):
            if link.get("name") == "none":
                if link.find("inertial/mass").get("value") != "2.5":
                    fail("a link without shapes has another mass")
                continue
            e = entry[link.get("name")]
            if float(link.find("inertial/mass").get("value")) != e["mass"] or [float(x) for x in link.find("inertial/origin").get("xyz").split()] != e["centre"]:
                fail(f"{link.get('name')}: the URDF has other numbers than the report")
            if [float(link.find("inertial/inertia").get(k)) for k in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")] != e["inertia"]:
                fail(f"{link.get('name')}: the URDF has another inertia than the report")
        for name in ("good.xml", "good.sdf"):
            if not re.search(re.escape(repr(entry["box"]["mass"])), (place / "out_good" / name).read_text()):
                fail(f"{name} has not the mass {entry['box']['mass']!r}")

        # Masses that are kept; a link that has none.
        report, err = run(place, "good.urdf", "--inertia", "mass")
        for e in report["inertia"]:
            if e["link"] in ("box", "ball", "rod"):
                if e.get("kept") != "no mass in the file":
                    fail(f"{e['link']}: {e}")
            elif e["mass"] != 2.5 or e["mass_bounds"] != [2.5, 2.5]:
                fail(f"{e['link']}: another mass: {e['mass_bounds']}")
        holds({e["link"]: e for e in report["inertia"]}["cavity"], *mass_of(moments(exact(cavity)), mass=2.5))

        # Parts that cross each other, and shapes that overlap: wider bounds, which hold the union's.
        union = [a + b - c for a, b, c in zip(moments(box((0, 0, 0), (1, 1, 1))), moments(box((0.5, 0.25, 0.25), (1.5, 0.75, 0.5))), moments(box((0.5, 0.25, 0.25), (1, 0.75, 0.5))))]
        two = ['<geometry><box size="1 1 1"/></geometry>', '<origin xyz="0.75 0 0"/><geometry><box size="1 0.5 0.5"/></geometry>']
        both = [a + b - c for a, b, c in zip(moments(box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))), moments(box((0.25, -0.25, -0.25), (1.25, 0.25, 0.25))), moments(box((0.25, -0.25, -0.25), (0.5, 0.25, 0.25))))]
        (place / "wide.urdf").write_text(urdf({"crossing": ([mesh("crossing")], True), "two": (two, True)}))
        report, err = run(place, "wide.urdf", "--inertia", "1000")
        entry = {e["link"]: e for e in report["inertia"]}
        holds(entry["crossing"], *mass_of(union, density=1000), tight=False)
        holds(entry["two"], *mass_of(both, density=1000), tight=False)
        if not entry["crossing"]["overlaps"] or not entry["two"]["overlaps"] or "may have points in common" not in err:
            fail(f"overlaps are not said: {err}")

        # Nothing is known of an open mesh: exit code 1, and its file's inertial stays. The others have theirs.
        (place / "bad.urdf").write_text(urdf({"opened": ([mesh("opened")], True), "ell": ([mesh("ell")], True)}))
        report, err = run(place, "bad.urdf", "--inertia", "mass", code=1)
        if "link 'opened': NO inertia" not in err or report["inertia"][1]["mass"] != 2.5:
            fail(f"an open mesh: {err}")
        if re.sub(r">\s+<", "><", (place / "out_bad/bad.urdf").read_text() if (place / "out_bad/bad.urdf").exists() else "").count(INERTIAL) != 1:
            fail("the open link's inertial")

        masses_stay_apart(place)

        for wrong in ("-1", "0", "x", "nan", "1e999", ""):
            run(place, "good.urdf", "--inertia", wrong, code=2)
        done = subprocess.run([str(TOOLS / "bcd-decompose"), "ell.off", "-o", "x.glb", "--inertia", "mass"], cwd=place, capture_output=True, text=True, check=False)
        if done.returncode != 2 or "for robots" not in done.stderr:
            fail(f"a mesh with --inertia: {done.stderr}")
    print("inertia: bounds hold exact integrals")


if __name__ == "__main__":
    main()
