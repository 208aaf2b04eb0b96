# shellcheck shell=sh disable=SC2154
# One verdict a link: terminal, page, report and exit code say the same, and each command that a page prints ends as
# the page says. Robots with meshes that bound no solid, bad ones and none.
. "$(dirname "$0")/common.sh"
KABOUM_CACHE=$WORK/cache
export KABOUM_CACHE
mkdir -p "it's a robot/m"

python3 - "it's a robot" <<'END'
import sys
folder = sys.argv[1]

def off(name, vertices, faces):
    with open(f"{folder}/m/{name}.off", "w") as f:
        f.write(f"OFF\n{len(vertices)} {len(faces)} 0\n")
        for v in vertices:
            f.write("%.9g %.9g %.9g\n" % tuple(v))
        for t in faces:
            f.write(f"{len(t)} " + " ".join(map(str, t)) + "\n")

def prism(polygon, low, high):
    """Of a polygon in the plane of x and y; triangles."""
    n = len(polygon)
    vertices = [(x, y, z) for z in (low, high) for x, y in polygon]
    faces = [(0, i + 1, i) for i in range(1, n - 1)] + [(n, n + i, n + i + 1) for i in range(1, n - 1)]
    for i in range(n):
        j = (i + 1) % n
        faces += [(i, j, n + j), (i, n + j, n + i)]
    return vertices, faces

def add(*parts):
    vertices, faces = [], []
    for v, f in parts:
        faces += [tuple(i + len(vertices) for i in t) for t in f]
        vertices += v
    return vertices, faces

def turned(part):
    return part[0], [t[::-1] for t in part[1]]

box = prism([(0, 0), (1, 0), (1, 1), (0, 1)], 0, 1)
flap = [(1, 0.2, 0.5), (1.3, 0.2, 0.5), (1.3, 0.8, 0.55)]
sheet = flap, [(0, 1, 2), (0, 2, 1)]
off("good", *box)
off("sheet", *add(box, sheet))
off("plate", [(0, 0, 0), (1, 0, 0), (1, 1, 0.1), (0, 1, 0)], [(0, 1, 2), (0, 2, 3), (2, 1, 0), (3, 2, 0)])
off("inverted", *turned(box))
# Half of it winds the other way, whichever way it is turned.
off("crossed", *prism([(0, 0), (1, 1), (1, 0), (0, 1)], 0, 0.5))
off("open", box[0], box[1][:2] + box[1][4:])
# A fin of two triangles back to back, joined to the box at an edge that others have.
off("fold", *add(box, ([(1, 0, 0), (1, 1, 0), (1.2, 0.5, -0.2)], [(0, 1, 2), (1, 0, 2)])))
# The same with other diagonals on its two sides: no triangle has an opposite copy.
off("fin", *add(box, ([(1.1, 0.2, 0.5), (1.4, 0.2, 0.5), (1.4, 0.8, 0.5), (1.1, 0.8, 0.5)],
                      [(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)])))
off("empty", [], [])
with open(f"{folder}/m/damaged.stl", "wb") as f:
    f.write(b"\0" * 80 + (1000).to_bytes(4, "little") + b"\1" * 70)

def robot(name, links):
    text = f'<robot name="{name}">\n'
    for i, (link, shapes) in enumerate(links):
        text += f'<link name="{link}">' + "".join(
            f'<{kind}><origin xyz="{0.1 * k} 0 0"/><geometry>{g}</geometry></{kind}>'
            for k, g in enumerate(shapes) for kind in ("visual", "collision")) + "</link>\n"
        if i:
            text += (f'<joint name="j{i}" type="revolute"><parent link="{links[i - 1][0]}"/><child link="{link}"/>'
                     '<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>\n')
    with open(f"{folder}/{name}.urdf", "w") as f:
        f.write(text + "</robot>\n")

def mesh(name, scale=None):
    return f'<mesh filename="m/{name}"' + (f' scale="{scale}"' if scale else "") + "/>"

odd = ["sheet", "plate", "inverted", "crossed", "open", "fold", "fin"]
robot("odd", [("base", [mesh("good.off"), '<box size="0.2 0.2 0.1"/>'])] +
      [(name, [mesh(name + ".off")]) for name in odd] +
      [("scaled", [mesh("sheet.off", "0.5 -0.5 1"), mesh("good.off")])])
off("line", [(0, 0, 0), (2, 0, 0), (1, 0, 0)], [(0, 1, 2)])
robot("zero", [("base", [mesh("good.off")]), ("line", [mesh("line.off")]), ("ball", ['<sphere radius="0"/>']), ("flat", ['<box size="0 0 0"/>'])])
robot("bad", [("base", [mesh("good.off")]), ("broken", [mesh("damaged.stl"), mesh("good.off")]),
              ("nothing", [mesh("empty.off")]), ("sheet", [mesh("sheet.off")])])
with open(f"{folder}/m/empty.stl", "wb") as f:
    f.write(b"\0" * 84)
robot("empty", [("base", [mesh("good.off")]), ("nothing", [mesh("empty.stl")])])
robot("worst", [("base", [mesh("damaged.stl")])])
def ring(n, inner, outer):
    """Of rectangular section: not convex."""
    import math
    vertices = [(r * math.cos(2 * math.pi * i / n), r * math.sin(2 * math.pi * i / n), z)
                for i in range(n) for r, z in ((inner, 0), (outer, 0), (outer, 0.5), (inner, 0.5))]
    faces = []
    for i in range(n):
        for k in range(4):
            a, b = 4 * i + k, 4 * i + (k + 1) % 4
            c, d = (a + 4) % (4 * n), (b + 4) % (4 * n)
            faces += [(a, c, b), (b, c, d)]
    return vertices, faces

off("ring", *ring(40, 0.6, 1))
robot("ring", [("base", [mesh("ring.off"), mesh("ring.off", "0.5 0.5 -1")]), ("arm", [mesh("good.off")])])
robot("some", [("base", [mesh("good.off")])] + [(name, [mesh(name + ".off")]) for name in odd[:6]])
# The same in a box: every triangle is inside, and half of what it winds round is a hollow.
off("hollow", *add(prism([(-1, -1), (2, -1), (2, 2), (-1, 2)], -1, 1), prism([(0, 0), (1, 1), (1, 0), (0, 1)], 0, 0.5)))
off("bow", *prism([(0, 0), (1, 1), (1.5, 0.5), (1, 0), (0, 1)], 0, 0.5))
for name in ("hollow", "crossed", "bow", "sheet", "open"):
    robot("one-" + name, [("base", [mesh("good.off")]), (name, [mesh(name + ".off")])])
robot("few", [("base", [mesh("good.off")]), ("plate", [mesh("plate.off")]), ("tool", [mesh("sheet.off")])])
END

# look EXIT FOLDER: whether page, report and terminal of the last run say what its exit code says, and whether the
# page's commands end as it says.
cat >look.py <<'END'
import html, json, re, subprocess, sys
code, page, report, terminal = int(sys.argv[1]), re.sub('src="[^"]*"', "", open("p.html").read()), json.load(open("r.json")), open("err.txt").read()
held = code == 0
bad = []
def require(condition, what):
    if not condition:
        bad.append(what)
require((report["verdict"] == "held") == held, f"report: {report['verdict']}")
require(all((l["verdict"] == "held") == (l["sentence"].startswith(("every triangle is inside", "its shapes are", "its shapes stay")) and "not as near" not in l["sentence"]
        and "ended before" not in l["sentence"]) for l in report["links"]), "a link's verdict is not its sentence")
require(report["sentence"] in terminal, "the terminal has another sentence")
rows = re.findall(r'<td class="(yes|no)">(.*?)</td></tr>', page)
require(len(rows) == len(report["links"]) + 1, f"{len(rows)} rows")
for row, link in zip(rows, report["links"]):
    require(html.unescape(row[1]) == link["sentence"] and (row[0] == "yes") == (link["verdict"] == "held"), f"page: {row}")
require(html.unescape(rows[-1][1]) == report["sentence"] and (rows[-1][0] == "yes") == held, f"page: {rows[-1]}")
for text, name in ((page, "page"), (terminal, "terminal")):
    lines = [l for l in re.split("\n|<br>", text) if re.search("\\bNOT\\b", l) and "dropped on request" not in l]
    require(not held or not lines, f"{name}: a NOT beside exit code 0: {lines[:3]}")
# All count alike.
foot = re.findall("<td[^>]*>(.*?)</td>", re.search("<tfoot>(.*?)</tfoot>", page).group(1))
made = report["bodies"] if "bodies" in report else report["meshes"] - report["meshes_kept"]
said = re.search(r"urdf: (\d+) \w+ of (\d+) links?(?:, from (\d+) mesh\w*)?(?:, of which (\d+) stay)?", terminal)
counts = [made, len(report["links"]), report["meshes"] if said.group(3) else None, report["meshes_kept"] or None]
require([int(n) if n else None for n in said.groups()] == counts, f"terminal: {said.group(0)}, not {counts}")
require([int(n) for n in re.findall(r"\d+", foot[0])][:2] == [len(report["links"]), report["meshes"]] and foot[3:5] == [str(made), str(report["vertices"])], f"page: {foot}")
# A mesh that is kept has no result, once for each scale of it; one that is only not near enough has a flaw, too, but a result.
require(report["meshes_kept"] == len({(l["link"], m["file"]) for l in report["links"] for m in l.get("meshes", []) if "result" not in m}), "meshes kept")
commands = [html.unescape(c) for c in re.findall(r"<code>(.*?)</code>", page)]
commands = sorted({c for c in commands if c.startswith("bound-verify ")})  # the others are of programs that may not be here
require(commands == [report["check"]], f"commands: {commands}")
for command in commands:
    run = subprocess.run(command, shell=True, capture_output=True, text=True)
    inside = all(l["verdict"] in ("held", "epsilon not reached", "work ended") for l in report["links"])
    require(run.returncode == (0 if inside else code), f"{command}: exit {run.returncode}: {run.stdout[-600:]} {run.stderr[-300:]}")
    require(("exit code above 0" in page) == (not inside), "the page does not say how its command ends")
    said = dict(re.findall("^link '(.*?)': ([a-z]*): ", run.stdout, re.M))
    require(len(said) == len(report["links"]), f"links: {run.stdout}")
    for link in report["links"]:
        held = link["verdict"] in ("held", "epsilon not reached", "work ended")
        require(held or said.get(link["link"]) != "verified", f"link '{link['link']}': {run.stdout}")
    if run.returncode == 0:
        said = [l for l in run.stdout.splitlines() if l.startswith("link ")]
        require(len(said) == len(report["links"]) and all(": verified: " in l for l in said), f"links: {run.stdout}")
print("\n".join(bad))
sys.exit(1 if bad else 0)
END
PATH=$BIN:$PATH
# made CODE WORDS PROGRAM ARGUMENT...
made() {
  rm -rf out p.html r.json
  expect "$@" --html-report p.html --report r.json
  python3 look.py "$got" >looked.txt || fail "$*: $(cat looked.txt)"
}

R="it's a robot"
for geometry in collision visual; do
  made 0 'every triangle of 9 links is inside' bcd-decompose "$R/odd.urdf" -o out --epsilon 0.05 --effort fast --geometry $geometry
  made 0 'every triangle of 9 links is inside' bmesh-decimate "$R/odd.urdf" -o out --epsilon 0.05 --geometry $geometry
done
made 0 'A wrap takes the place of the mesh' bcd-decompose "$R/odd.urdf" -o "it's out" --epsilon 0.05 --effort fast --verbose
made 0 'every triangle' bcd-decompose "$R/odd.urdf" -o out --epsilon 0.05 --effort fast --prepare wrap
made 0 'every triangle' bmesh-decimate "$R/odd.urdf" -o out --epsilon 0.05 --prepare wrap
made 0 'every triangle' bcd-decompose "$R/one-sheet.urdf" -o out --effort fast
# Only some links: the others, that hold nothing, are not judged either.
made 0 'every triangle of 1 link is inside' bcd-decompose "$R/few.urdf" -o out --links tool --epsilon 0.05 --effort fast
made 0 'every triangle of 2 links is inside' bmesh-decimate "$R/few.urdf" -o out --links tool,base --epsilon 0.05
# What was left out on request is said, and not called inside.
made 0 'but the 2 of sheets that were dropped on request' bcd-decompose "$R/few.urdf" -o out --links tool --drop-sheets --effort fast
grep -q '^tool .*  inside but sheets$' err.txt || fail "the row of a link without its sheets: $(cat err.txt)"
# Nothing is verified about nothing, and a shape of size 0 is no obstacle.
made 0 'every triangle of 4 links is inside' bcd-decompose "$R/zero.urdf" -o out --epsilon 0.05 --effort fast
made 0 'every triangle of 4 links is inside' bmesh-decimate "$R/zero.urdf" -o out --epsilon 0.05
# One bad mesh does not refuse the robot: it stays where it was, is named, and the exit code says so.
for program in 'bcd-decompose --effort fast' bmesh-decimate; do
  # shellcheck disable=SC2086
  made 1 "link 'broken': NOT enclosed, its mesh stays as it was: .*damaged.stl" $program "$R/bad.urdf" -o out --epsilon 0.05
  grep -q "link 'nothing': NOT enclosed" err.txt || fail "the empty mesh is not named: $(cat err.txt)"
  for kept in damaged.stl empty.off; do
    grep -q "<collision.*\|filename=\"../it's a robot/m/$kept\"\|filename=\"../it&apos;s a robot/m/$kept\"" out/bad.urdf || fail "$kept is lost"
  done
  [ "$(grep -c '<collision ' out/bad.urdf)" -ge 5 ] || fail "collision shapes are lost: $(cat out/bad.urdf)"
  [ ! -e out/links/broken.glb ] || fail "a set of a link without one of its shapes"
  # shellcheck disable=SC2086
  made 1 "link 'nothing': NOT enclosed, its mesh stays as it was: .*empty.stl" $program "$R/empty.urdf" -o out --epsilon 0.05
  shows 1 "link 'base': verified: every triangle is inside" bound-verify robot "$R/empty.urdf" out/empty.urdf --prepare --report v.json
  grep -q "^link 'nothing': refuted: .*empty.stl: it is not held, for it cannot be judged: no triangles" out.txt || fail "the empty mesh: $(cat out.txt)"
  grep -q '"answer": "verified"' v.json || fail "no link of the report is verified: $(cat v.json)"
done
# Another mesh of the result that cannot be read is bad input, and so is a robot of which nothing can be judged.
sed 's|filename="[^"]*"|filename="m/damaged.stl"|g' "$R/empty.urdf" >"$R/other.urdf"
expect 3 'damaged.stl' bound-verify robot "$R/empty.urdf" "$R/other.urdf" --prepare
expect 3 'damaged.stl' bound-verify robot "$R/worst.urdf" "$R/worst.urdf" --prepare
# Where nothing can be made, nothing is written.
for program in bcd-decompose bmesh-decimate; do
  rm -rf out
  expect 3 'damaged.stl' $program "$R/worst.urdf" -o out --epsilon 0.05
  absent out
done

# Distances of meshes that are not convex are decided as well, one epsilon for all links.
made 0 'every triangle of 2 links is inside' bmesh-decimate "$R/ring.urdf" -o out --epsilon 0.05
grep -q '"check": ".*--epsilon 0.05"' r.json || fail "no epsilon in $(grep '"check"' r.json)"
shows 0 'whose surface is nowhere farther from it than asked' bound-verify robot "$R/ring.urdf" out/ring.urdf --prepare --epsilon 0.05
shows 1 'at least 0\.0[0-9]* from the solid' bound-verify robot "$R/ring.urdf" out/ring.urdf --prepare --epsilon 0.0001

# A scene of a robot with a bad mesh: the rest is made; the link has no set, so the scene is refused until it has one.
expect 1 "robot 'r', link 'broken': NOT enclosed, .*damaged.stl.*the scene is refused until" kaboum-scene make bad.json --robot "r=$R/bad.urdf" \
  --epsilon 5% --effort fast --report r.json
[ -s bad/r/sheet.glb ] || fail "sets: $(ls bad/r)"
absent bad/r/broken.glb
grep -q "bad_links.*" r.json || fail "the report does not name the links"
expect 3 "link 'broken' has shapes for collisions, but no set" kaboum-check bad.json --configuration 0,0,0
# What bounds no solid is wrapped: a set that holds every triangle.
expect 0 '7 sets' kaboum-scene make odd.json --robot "r=$R/some.urdf" --epsilon 5% --effort fast
grep -q 'A wrap takes the place of the mesh' err.txt || fail "nothing is said of wraps: $(cat err.txt)"
# Too near for a wrap: held farther away, named, and not 0.
expect 1 "link 'plate': every triangle is inside, but not as near" kaboum-scene make near.json --robot "r=$R/few.urdf" --epsilon 1e-7 --effort fast

# Nor does it refuse a motion: links that are not held are named, and not swept.
printf '0,0,0\n0.1,0,0.1\n' >path.csv
expect 1 "link 'broken': NOT enclosed, .*damaged.stl.*it is NOT swept" sweep-approx "$R/bad.urdf" --path path.csv -o swept.glb --epsilon 0.1 --effort fast \
  --report r.json
grep -q '"verdict": "kept"' r.json || fail "the report does not tell: $(cat r.json)"
shows 0 'verified' bound-verify sweep "$R/bad.urdf" path.csv swept.glb --links base,sheet
expect 3 'damaged.stl' sweep-approx "$R/bad.urdf" --links broken --path path.csv -o none.glb
absent none.glb
printf '0,0\n0.1,0.1\n' >few.csv
expect 0 'A wrap takes the place of the mesh' sweep-approx "$R/few.urdf" --path few.csv -o wrapped.glb --epsilon 0.1 --effort fast
shows 0 'verified' bound-verify sweep "$R/few.urdf" few.csv wrapped.glb
expect 0 'sheet.off: judged as it is, for it cannot be prepared' bound-verify sweep "$R/few.urdf" few.csv wrapped.glb --prepare

# strict and off do as they are told: what they cannot hold stays, and is named.
made 1 "links* .*'sheet'.*: NOT enclosed" bcd-decompose "$R/odd.urdf" -o out --epsilon 0.05 --effort fast --prepare strict
# Which solid is meant is not known, and not all that may be is inside: undecided, as the verifier says.
for program in 'bcd-decompose --effort fast' bmesh-decimate; do
  # shellcheck disable=SC2086
  made 7 "link 'hollow': whether every triangle is inside is NOT decided: .*hollow.off: a part of the surface crosses itself" $program \
    "$R/one-hollow.urdf" -o out --epsilon 0.05 --prepare strict
  # shellcheck disable=SC2086
  made 7 "1 of 2 links is not held" $program "$R/one-hollow.urdf" -o out --epsilon 0.05 --prepare strict  # from the cache
  # shellcheck disable=SC2086
  made 0 'every triangle of 2 links is inside' $program "$R/one-hollow.urdf" -o out --epsilon 0.05
done
for name in crossed bow; do
  made 7 "link '$name': .* is NOT decided" bcd-decompose --effort fast "$R/one-$name.urdf" -o out --epsilon 0.05 --prepare strict
  made 1 "link '$name': NOT every triangle is inside" bmesh-decimate "$R/one-$name.urdf" -o out --epsilon 0.05 --prepare strict
done
made 7 "link 'bow': .* is NOT decided: .*inside out" bcd-decompose --effort fast "$R/one-bow.urdf" -o out --epsilon 0.05 --prepare off
# What stays as it was is refuted, too.
for program in 'bcd-decompose --effort fast' bmesh-decimate; do
  for name in sheet open; do
    # shellcheck disable=SC2086
    made 1 "link '$name': NOT enclosed" $program "$R/one-$name.urdf" -o out --epsilon 0.05 --prepare strict
  done
done
expect 7 'every triangle is inside, but whether all that they bound is, is NOT decided' bcd-decompose --effort fast "$R/m/hollow.off" -o h.glb \
  --prepare strict --epsilon 0.05
shows 7 'undecided' bound-verify cover "$R/m/hollow.off" h.glb --prepare
expect 7 'whether all that its triangles bound is enclosed is NOT decided' bmesh-decimate "$R/m/hollow.off" -o h.off --prepare strict --epsilon 0.05
shows 7 'undecided' bound-verify mesh --outer "$R/m/hollow.off" h.off --prepare
# Too near for a wrap: every triangle is inside, but not as near as asked for.
made 1 "link 'plate': every triangle is inside, but not as near" bcd-decompose "$R/few.urdf" -o out --links plate --epsilon 1e-7 --effort fast

# A result that lost a body is refuted, by how much it sticks out.
bcd-decompose "$R/few.urdf" -o out --links tool --epsilon 0.05 --effort fast --quiet
python3 - <<'END'
import re
text = open("out/few.urdf").read()
bodies = re.findall(r"<collision name=.*?</collision>", text, re.S)
mine = [b for b in bodies if "bodies/sheet" in b]
assert len(mine) > 1
open("out/few.urdf", "w").write(text.replace(mine[0], ""))
END
shows 1 "link 'tool': refuted: .*triangles* \(is\|are\) not inside the .*, by at most" bound-verify robot "$R/few.urdf" out/few.urdf \
  --prepare --links tool --report v.json
grep -q '"sticks_out_upper"' v.json || fail "by how much is not in the report"
finish
