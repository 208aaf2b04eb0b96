# shellcheck shell=sh disable=SC2154
# Contacts decided by collision libraries of others: what is said, that it is never certified, nor kept with what is.
HERE=$(cd "$(dirname "$0")" && pwd)
. "$HERE/common.sh"
CHECK=$BIN/kaboum-check
P=$BIN/kaboum-plan
schema() {
  python3 - "$HERE/../../docs/report.schema.json" "$1" <<'END' || fail "schema: $1"
import json, sys
import jsonschema
jsonschema.validate(json.load(open(sys.argv[2])), json.load(open(sys.argv[1])))
END
}
mkdir meshes
slab 1 >meshes/cube.off
slab 3 >meshes/bar.off
link() { echo "<link name=\"$1\"><collision><geometry><mesh filename=\"meshes/$2.off\"/></geometry></collision></link>"; }
joint() {
  echo "<joint name=\"$1\" type=\"revolute\"><parent link=\"$2\"/><child link=\"$3\"/><origin xyz=\"$4\"/>
<axis xyz=\"0 0 1\"/><limit lower=\"-3\" upper=\"3\" effort=\"1\" velocity=\"1\"/></joint>"
}
echo "<robot name=\"arm\">$(link base cube)$(link upper bar)$(link tip cube)$(joint j1 base upper '0 0 2')$(joint j2 upper tip '5 0 0')</robot>" >arm.urdf
"$BIN/kaboum-scene" make cell.json --robot arm=arm.urdf --object box=meshes/cube.off --at box=0,5,2 --no-cache --quiet
printf 'j1,j2\n0,0\n1.57,0\n0.5,0\n' >some.csv
printf 'j1,j2\n0,0\n3,0\n' >through.csv
printf 'j1,j2\n0,0\n-3,1\n' >away.csv
built=
for engine in fcl bullet ode; do
  "$CHECK" cell.json --engine $engine >out.txt 2>err.txt
  if [ $? = 5 ]; then
    grep -q 'engine: this build has no .* install lib.*-DKABOUM_WITH_' err.txt || fail "no remedy: $(cat err.txt)"
    continue
  fi
  built=$engine
  for shapes in sets meshes; do
    set -- --engine $engine --engine-shapes $shapes
    shows 0 '^no contact seen, by .*, not certified$' "$CHECK" cell.json --configuration 0,0 "$@" --report free.json
    shows 1 '^arm/tip and box meet, by .*, not certified$' "$CHECK" cell.json --configuration 1.57,0 "$@" --report meets.json
    grep -q '"certified": false' meets.json || fail "$engine: the report does not say that nothing is certified"
    grep -q '"answer": "free"' free.json && fail "$engine: 'free' is for what is certified"
    shows 0 '^no contact seen at [0-9]* samples, no point moving farther than 0.1 in between, by .*, not certified$' \
      "$CHECK" cell.json --path away.csv "$@" --engine-step 10cm --report motion.json
    shows 1 '^arm/tip and box meet at waypoint 1 + 0\.[34][0-9]* of the way to the next, by .*, not certified$' \
      "$CHECK" cell.json --path through.csv "$@"
    for report in free.json meets.json motion.json; do schema $report; done
  done
  shows 1 "own and $engine agree on all pairs of 3 of 3 states; user CPU: own" \
    "$CHECK" cell.json --configurations some.csv --engine $engine --compare --report compared.json
  schema compared.json
  shows 7 'undecided: more than 3 samples' "$CHECK" cell.json --path away.csv --engine $engine --max-intervals 3
  for own in '--distance' '--margin 0.1' '--preview a.png'; do
    # shellcheck disable=SC2086
    expect 2 'answered by --engine own only' "$CHECK" cell.json --configuration 0,0 --engine $engine $own
  done
done
expect 2 'engine-shapes needs --engine' "$CHECK" cell.json --engine-shapes meshes
expect 2 'compare needs --engine' "$CHECK" cell.json --compare
expect 2 'must be own, fcl, bullet or ode' "$CHECK" cell.json --engine physx
[ -n "$built" ] || finish
# Where own and others differ is said, and 1 is the exit code if either sees a contact: a box that a hollow's set fills.
python3 - <<'END' || fail "a bowl"
# A cube without its upper face, 0.2 thick.
def box(a, b):
    return [(x, y, z) for x in (a[0], b[0]) for y in (a[1], b[1]) for z in (a[2], b[2])]
parts = [((0, 0, 0), (3, 3, .2)), ((0, 0, .2), (.2, 3, 3)), ((2.8, 0, .2), (3, 3, 3)), ((.2, 0, .2), (2.8, .2, 3)), ((.2, 2.8, .2), (2.8, 3, 3))]
faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
points, triangles = [], []
for low, high in parts:
    triangles += [tuple(len(points) + i for i in f) for f in faces]
    points += box(low, high)
with open("meshes/bowl.off", "w") as out:
    out.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
    out.writelines("%g %g %g\n" % p for p in points)
    out.writelines("3 %d %d %d\n" % t for t in triangles)
END
"$BIN/kaboum-scene" make bowl.json --object bowl=meshes/bowl.off --object box=meshes/cube.off --at box=1,1,1 --epsilon 60% --no-cache --quiet
shows 1 '^bowl and box: in contact by own, not by ' "$CHECK" bowl.json --resting --engine "$built" --engine-shapes meshes --compare --report differ.json
grep -q '"differing": 1' differ.json || fail "no difference in the report: $(cat differ.json)"
schema differ.json
shows 0 '^no contact seen' "$CHECK" bowl.json --resting --engine "$built" --engine-shapes meshes
# Plans: what another library answers is said, recorded in the plan, and never kept.
G=$HERE/../../examples/geometry
S=$HERE/../../examples/scenarios/stacked/domain.kpl
KABOUM_SCENE=$BIN/kaboum-scene "$G/make-cell" stacked 3 stacked >make.txt 2>&1 || fail "make-cell: $(tail -1 make.txt)"
KABOUM_CACHE=$PWD/answers
export KABOUM_CACHE
set -- "$S" stacked/problem.kpl --scene stacked/cell.json
expect 0 'solved: .*, contacts by .* on bounding sets, not certified' "$P" solve "$@" -o other.json --engine "$built" --report other-report.json
schema other-report.json
[ -z "$(find answers -type f 2>/dev/null)" ] || fail "answers of another library are kept: $(find answers -type f)"
grep -q '"not_certified": "by ' other.json || fail "the plan does not say that nothing is certified"
shows 0 '^valid: .*, contacts by .*, not certified$' "$P" check "$@" --plan other.json --engine "$built"
run_tool 0 "$P" show "$@" --plan other.json
grep -q '^(contacts by .* not certified)$' out.txt || fail "show: $(head -2 out.txt)"
grep -q 'found with contacts by .* not certified' err.txt || fail "show, stderr: $(cat err.txt)"
run_tool 0 "$P" show "$@" --plan other.json --html other.html
grep -q '<title>.*not certified' other.html || fail "the page does not say that nothing is certified"
shows 0 '^good' "$P" run "$@" --plan other.json --rate 100
expect 0 'solved: ' "$P" solve "$@" -o own.json
grep -q 'not_certified' own.json && fail "own plan says that it is not certified"
[ -n "$(find answers -type f)" ] || fail "own answers are not kept"
run_tool 0 "$P" solve "$@" -o other2.json --engine "$built" --report again-report.json
grep -q '"answers_reused": 0' again-report.json || fail "another library's answers come from the cache"
cmp -s other.json other2.json || fail "another plan the second time"
expect 2 'engine-step needs --engine' "$P" solve "$@" --engine-step 0.1
finish
