# shellcheck shell=sh disable=SC2154
# Robots with meshes that are not there: all of them are named at once, and on request the rest is held.
. "$(dirname "$0")/common.sh"
KABOUM_CACHE=$WORK/cache
export KABOUM_CACHE
D=$BIN/bcd-decompose
mkdir -p m
tetrahedron >m/t.off

python3 - <<'END'
def mesh(name):
    return f'<mesh filename="{name}"/>'

def link(name, collision, visual):
    return f'<link name="{name}">\n' + "".join(
        f'<{kind}><geometry>{g}</geometry></{kind}>\n' for kind, shapes in (("visual", visual), ("collision", collision)) for g in shapes) + "</link>\n"

def robot(name, links):
    text = f'<robot name="{name}">\n'
    for i, l in enumerate(links):
        text += link(*l)
        if i:
            text += (f'<joint name="j{i}" type="revolute"><parent link="{links[i - 1][0]}"/><child link="{l[0]}"/>'
                     '<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>\n')
    open(f"{name}.urdf", "w").write(text + "</robot>\n")

t, gone, far = mesh("m/t.off"), mesh("m/gone.stl"), mesh("package://nowhere/far.stl")
box = '<box size="1 1 1"/>'
robot("some", [("base", [t], [t]), ("arm", [gone, t], [gone]), ("hand", [far], [t]), ("tip", [box, gone], [box])])
robot("all", [("base", [gone], [gone]), ("arm", [far], [far])])
robot("one", [("base", [t], [t]), ("arm", [gone], [gone])])
# What collides is there, what is drawn is not.
robot("drawn", [("base", [t], [t]), ("arm", [box], [gone]), ("hand", [gone], [gone])])
open("arm.xml", "w").write("""<mujoco><asset><mesh name="t" file="m/t.obj"/><mesh name="gone" file="m/gone.obj"/></asset>
<worldbody><body name="base"><geom type="mesh" mesh="t"/><body name="arm" pos="0 0 1"><joint name="j" axis="0 0 1"/>
<geom name="lost" type="mesh" mesh="gone"/><geom class="main" type="mesh" mesh="gone" contype="0" conaffinity="0"/><geom type="box" size="1 1 1"/></body></body></worldbody>
<contact><pair geom1="lost" geom2="lost"/></contact></mujoco>""")
open("arm.sdf", "w").write("""<sdf version="1.9"><model name="m">
<link name="base"><collision name="c"><geometry><mesh><uri>m/t.off</uri></mesh></geometry></collision></link>
<link name="arm"><collision name="c"><geometry><mesh><uri>m/gone.off</uri></mesh></geometry></collision></link></model></sdf>""")
END
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n' >m/t.obj

# All at once, with file and line, why, and what helps; nothing is written.
for tool in bcd-decompose bmesh-decimate; do
  expect 3 'some.urdf: 2 meshes have no file:' "$BIN/$tool" some.urdf -o x --epsilon 2%
  grep -q "^  some.urdf:[0-9]*: no mesh file for 'm/gone.stl' of links 'arm' and 'tip'$" err.txt || fail "$tool: $(cat err.txt)"
  grep -q "^  some.urdf:[0-9]*: no mesh file for 'package://nowhere/far.stl' of link 'hand'$" err.txt || fail "$tool: $(cat err.txt)"
  grep -q 'there is no file ./m/gone.stl' err.txt || fail "$tool: no reason: $(cat err.txt)"
  grep -q 'by --package-path; --missing-meshes skip leaves them out' err.txt || fail "$tool: no remedy: $(cat err.txt)"
  expect 3 "one.urdf:[0-9]*: no mesh file for 'm/gone.stl' of link 'arm': there is no file ./m/gone.stl; --missing-meshes skip" "$BIN/$tool" one.urdf -o x --epsilon 2%
  # Of the links that are meant, and of their shapes.
  expect 0 '' "$BIN/$tool" some.urdf -o "base-$tool" --epsilon 2% --links base
  absent x
  # Where nothing is left, nothing is made.
  expect 3 'there is no file' "$BIN/$tool" all.urdf -o x --epsilon 2% --missing-meshes skip
  absent x
done
line=$(grep -n 'gone.stl' some.urdf | sed -n 2p | cut -d: -f1)
expect 3 "some.urdf:$line: no mesh file for 'm/gone.stl'" "$D" some.urdf -o x --epsilon 2%

# On request the rest is held, and what is not is named everywhere: exit code 1.
for tool in bcd-decompose bmesh-decimate; do
  expect 1 "links 'arm' and 'tip': NOT verified, its mesh is missing and left out: some.urdf:$line: no mesh file for 'm/gone.stl'" "$BIN/$tool" some.urdf -o "$tool" --epsilon 2% --missing-meshes skip --report r.json --html-report p.html
  grep -q "link 'hand': NOT verified" err.txt || fail "$tool: 'hand' is not named: $(cat err.txt)"
  grep -q '^arm .*NOT verified$' err.txt || fail "$tool: not in the table: $(cat err.txt)"
  grep -q 'NOT every triangle is known to be inside: 3 of 4 links are not held' err.txt || fail "$tool: $(cat err.txt)"
  grep -q 'NOT verified, its mesh is missing' p.html || fail "$tool: the page does not say so"
  python3 - "$tool" <<'END' || fail "$tool: the report"
import json, sys
r = json.load(open("r.json"))
said = {l["link"]: l["verdict"] for l in r["links"]}
assert said == {"base": "held", "arm": "missing", "hand": "missing", "tip": "missing"}, said
assert r["verdict"] == "missing" and "--missing-meshes skip" in r["check"], r
END
  # Nothing of them is left for a program to stumble over, and the file says of which links it says nothing.
  python3 - "$tool" <<'END' || fail "$tool: $(cat "$tool/some.urdf")"
import sys, xml.etree.ElementTree as ET
links = ET.parse(sys.argv[1] + "/some.urdf").getroot().findall("link")
made = {l.get("name"): [m.get("filename") for m in l.findall("collision/geometry/mesh")] for l in links}
assert not any("gone" in m or "far" in m for meshes in made.values() for m in meshes), made
assert made["base"] and made["arm"] and not made["hand"] and not made["tip"], made
assert all(l.find("collision/geometry/box") is not None for l in links if l.get("name") == "tip")
assert any("gone" in m.get("filename") for l in links for m in l.findall("visual/geometry/mesh")), "what is drawn stays"
END
  grep -q 'NOT verified, for meshes of theirs are missing and left out: arm, hand, tip' "$tool/some.urdf" || fail "$tool: no word in the URDF"
  shows 1 "^link 'base': verified" "$BIN/bound-verify" robot some.urdf "$tool/some.urdf" --prepare --missing-meshes skip
  grep -q "^link 'arm': refuted: m/gone.stl: it is not held, for it cannot be judged: there is no file ./m/gone.stl$" out.txt || fail "bound-verify: $(cat out.txt)"
  expect 3 'some.urdf: 2 meshes have no file' "$BIN/bound-verify" robot some.urdf "$tool/some.urdf" --prepare
done
# The same bytes a second time, from the cache.
cp -r bcd-decompose first
expect 1 'NOT verified' "$D" some.urdf -o bcd-decompose --epsilon 2% --missing-meshes skip
diff -r first bcd-decompose >diff.txt || fail "another robot: $(cat diff.txt)"
[ ! -e bcd-decompose/links/arm.glb ] && [ -s bcd-decompose/links/base.glb ] || fail "containers: $(ls bcd-decompose/links)"

# Of what is drawn: a link whose drawn mesh is missing keeps what collided, where that is there.
expect 1 "links 'arm' and 'hand': NOT verified" "$D" drawn.urdf -o drawn --visual --epsilon 2% --missing-meshes skip
python3 - <<'END' || fail "drawn: $(cat drawn/drawn.urdf)"
import xml.etree.ElementTree as ET
shapes = {l.get("name"): l.findall("collision") for l in ET.parse("drawn/drawn.urdf").getroot().findall("link")}
assert len(shapes["arm"]) == 1 and shapes["arm"][0].find("geometry/box") is not None
assert not shapes["hand"] and shapes["base"]
END
shows 1 "^link 'arm': refuted" "$BIN/bound-verify" robot drawn.urdf drawn/drawn.urdf --visual --prepare --missing-meshes skip

# In the other formats, and written as them.
expect 1 "link 'arm': NOT verified" "$D" arm.xml -o mjcf --epsilon 2% --missing-meshes skip
grep -q 'gone\|lost' mjcf/arm.xml && fail "MuJoCo would not read it: $(cat mjcf/arm.xml)"
grep -q 'missing and left out: arm' mjcf/arm.xml || fail "no word in the MJCF"
expect 1 "link 'arm': NOT verified" "$D" arm.sdf -o sdf --epsilon 2% --missing-meshes skip
grep -q gone sdf/arm.sdf && fail "it is still there: $(cat sdf/arm.sdf)"
expect 1 '' "$D" one.urdf -o formats --epsilon 2% --missing-meshes skip --robot-format mjcf --robot-format sdf --robot-format usd
grep -l gone formats/one.xml formats/one.usda && fail "it is still there"
for f in urdf xml sdf usda; do grep -q 'missing and left out: arm' formats/one.$f || fail "no word in one.$f"; done

# Spheres, and what repairs them, have to be of all links that are asked for.
expect 2 'is for --bodies polytopes' "$D" one.urdf -o x.yaml --bodies spheres --epsilon 10% --missing-meshes skip
expect 3 'one.urdf:[0-9]*: no mesh file' "$D" one.urdf -o x.yaml --bodies spheres --epsilon 10%
expect 2 'must be error or skip, not maybe' "$D" one.urdf -o x --missing-meshes maybe
expect 2 'missing-meshes is for robots' "$D" m/t.off -o x.glb --missing-meshes skip

# A motion of it: links that are not held are not swept.
printf 'j1\n0\n0.2\n' >path.csv
expect 1 "link 'arm': NOT verified.*NOT swept" "$BIN/sweep-approx" one.urdf --path path.csv -o swept.glb --epsilon 0.05 --missing-meshes skip
expect 3 'no mesh file.*--missing-meshes skip' "$BIN/sweep-approx" one.urdf --path path.csv -o x.glb --epsilon 0.05
expect 3 'some.urdf: 2 meshes have no file' "$BIN/kaboum-pairs" some.urdf
finish
