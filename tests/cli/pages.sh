# shellcheck shell=sh disable=SC2154
# Pages with a view in three dimensions: what they hold, checked with Node.js. The pages are left in $4 for
# pages-seen.sh, which looks at them.
HERE=$(cd "$(dirname "$0")" && pwd)
. "$HERE/common.sh"
PLAYER=$HERE/../../libpage/src
PAGES=${4-}
KABOUM_CACHE=$WORK/cache
KABOUM_SCENE=$BIN/kaboum-scene
export KABOUM_CACHE KABOUM_SCENE
command -v node >/dev/null || { echo "Node.js is missing (nodejs, which scripts/setup installs): nothing is checked"; exit 1; }

# preview PAGE BOUND: its data hold, and no distance exceeds a certified one.
preview() {
  node "$HERE/check_preview.js" "$1" "$PLAYER" "$2" >said.txt 2>&1 || fail "$1: $(tail -5 said.txt)"
  cat said.txt
}
# figure FILE.JSON EXPRESSION: of a report r.
figure() { python3 -c "import json, sys; r = json.load(open(sys.argv[1])); print($2)" "$1"; }
refused() {
  ! node "$HERE/check_preview.js" "$1" "$PLAYER" "$2" >said.txt 2>&1 || fail "$1 is taken for good: $3"
}

# Bodies over a mesh, and inside one.
D=$BIN/bcd-decompose
expect 0 '' "$D" "$BRACKET" -o bodies.glb --epsilon 3% --effort fast --preview bodies.html --report bodies.json
preview bodies.html "$(figure bodies.json 'r["reach"]["upper"]')"
expect 0 'from the cache' "$D" "$BRACKET" -o again.glb --epsilon 3% --effort fast --preview again.html --threads 1
cmp -s bodies.html again.html || fail "another page from the cache, or on one thread"
expect 0 '' "$D" "$BRACKET" -o inner.glb --direction inner --epsilon 2% --effort fast --preview inner.html
preview inner.html -
grep -q 'decided exactly' bodies.html || fail "no verdict on the page"
# What would be wrong is found: a distance beyond what is certified, data cut, other code.
refused bodies.html 1e-6 'a distance beyond the certified one'
sed 's/"points":"[A-Za-z0-9+/]\{8\}/"points":"/' bodies.html >cut.html
refused cut.html - 'points are missing'
python3 - bodies.html >wrong.html <<'END_OF_DAMAGE' || fail "other distances"
import base64, re, struct, sys
def halved(m):
    values = base64.b64decode(m.group(1))
    n = len(values) // 4
    values = struct.pack(f"<{n}f", *(v / 2 if 0 <= v < 0.9 else v for v in struct.unpack(f"<{n}f", values)))
    return '"values":"' + base64.b64encode(values).decode() + '"'
print(re.sub(r'"values":"([^"]*)"', halved, open(sys.argv[1]).read()))
END_OF_DAMAGE
refused wrong.html - 'halved distances'
sed 's/const clear/const dear/; s/byValue/byVolume/' bodies.html >other.html
refused other.html - 'other code'

# Results over the mesh, one and a series.
expect 0 '' "$BIN/bmesh-decimate" "$BRACKET" -o outer.ply --epsilon 2% --effort fast --preview outer.html --report outer.json
preview outer.html "$(figure outer.json 'r["distance"]["hausdorff_upper"]')"
expect 0 '' "$BIN/bmesh-decimate" "$BRACKET" -o 'level-{vertices}.ply' --vertices 200,100 --effort fast --direction inner --preview levels.html
preview levels.html -
grep -q '"name":"200 vertices"' levels.html || fail "a level is missing"
expect 2 'ends with .html' "$BIN/bmesh-decimate" "$BRACKET" -o no.ply --ratio 0.5 --preview no.png
expect 2 'cannot both' "$BIN/bmesh-decimate" "$BRACKET" -o no.ply --ratio 0.5 --preview page.html --report page.html
absent no.ply page.html
expect 2 'standard input' "$D" - --input-format obj -o no.glb --preview no.html
expect 2 'explode' "$D" "$BRACKET" -o no.glb --preview no.html --explode 1
absent no.glb no.html

# A robot's bodies, and what it sweeps.
cat >arm.urdf <<'END_OF_ROBOT'
<robot name="arm">
  <link name="base"><collision><geometry><cylinder radius="0.12" length="0.1"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0.2 0 0"/><geometry><box size="0.4 0.08 0.06"/></geometry></collision></link>
  <link name="fore"><collision><geometry><mesh filename="t.off" scale="0.2 -0.1 0.15"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.1"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="slide" type="prismatic"><parent link="upper"/><child link="fore"/><origin xyz="0.45 0 0" rpy="0.3 0 0"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.3" effort="1" velocity="1"/></joint>
</robot>
END_OF_ROBOT
tetrahedron >t.off
printf 'turn,slide\n0,0\n1.2,0\n1.2,0.2\n' >path.csv
expect 0 '' "$D" arm.urdf -o links --epsilon 3% --effort fast --preview links.html --report links.json
preview links.html "$(figure links.json 'max(l["reach_upper"] for l in r["links"])')"
expect 0 '' "$BIN/sweep-approx" arm.urdf --path path.csv -o swept.glb --epsilon 0.02 --preview swept.html --report swept.json
preview swept.html "$(figure swept.json 'r["reach"] + r["bodies_epsilon"]')"
expect 0 '' "$BIN/sweep-approx" arm.urdf --path path.csv -o placed.glb --epsilon 0.02 --base-pose 1,2,0,0,0,1 --preview placed.html --report placed.json
preview placed.html "$(figure placed.json 'r["reach"] + r["bodies_epsilon"]')"
expect 0 '' "$BIN/sweep-approx" arm.urdf --path path.csv -o swept.glb --epsilon 0.02 --preview swept.png
[ "$(head -c 4 swept.png | tail -c 3)" = PNG ] || fail "no picture"

# A plan, and one under assumptions: outcomes without a branch are said.
P=$BIN/kaboum-plan
S=$HERE/../../examples/scenarios
"$HERE/../../examples/geometry/make-cell" remove 2 remove >make.txt 2>&1 || fail "make-cell: $(tail -1 make.txt)"
set -- "$S/remove/domain.kpl" remove/problem.kpl --scene remove/cell.json
expect 0 solved "$P" solve "$@" -o plan.json
expect 0 '' "$P" show "$@" --plan plan.json --html plan.html
node "$HERE/play_page.js" plan.html "$PLAYER" >said.txt 2>&1 || fail "plan.html: $(tail -5 said.txt)"
grep -q ' 0 left out' said.txt || fail "plan.html: $(cat said.txt)"
python3 - "$S/remove/domain.kpl" >weighed.kpl <<'END_OF_DOMAIN' || fail "domain with weights"
import sys
text = open(sys.argv[1]).read().replace("isHeld(block)", "isHeld(block), isHeavy(block)")
remove = text[text.index("action remove("):text.index("goal:")]
light = remove.replace("K(isHeld(?o)) &", "K(isHeld(?o)) & K(!isHeavy(?o)) &")
weigh = "action weigh(?o : block)\n  preconds:\n    K(isHeld(?o)) & !Kw(isHeavy(?o))\n  effects:\n    add(Kw, isHeavy(?o))\n\n"
print(text.replace(remove, light + weigh))
END_OF_DOMAIN
echo '{"isHeavy(o1)": false, "isHeavy(o2)": false}' >light.json
set -- weighed.kpl remove/problem.kpl --scene remove/cell.json
expect 0 'under 2 assumptions' "$P" solve "$@" --assume light.json -o assumed.json
expect 0 '' "$P" show "$@" --plan assumed.json --html assumed.html
node "$HERE/play_page.js" assumed.html "$PLAYER" >said.txt 2>&1 || fail "assumed.html: $(tail -5 said.txt)"
grep -q ' 2 left out' said.txt || fail "assumed.html: $(cat said.txt)"

if [ -n "$PAGES" ]; then
  mkdir -p "$PAGES"
  cp bodies.html outer.html swept.html plan.html assumed.html "$PAGES/" || fail "pages for pages-seen.sh"
fi
finish
