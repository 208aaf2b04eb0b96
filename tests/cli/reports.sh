# Every program's report keeps to docs/report.schema.json.
. "$(dirname "$0")/common.sh"
SCHEMA=$(cd "$(dirname "$3")" && pwd)/$(basename "$3")
mkdir reports
box() {
  printf 'OFF\n8 12 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n'
  printf '3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n'
}
box >box.off
box | sed 's/^\([01] [01] [01]\)$/\1/; s/^1 /2 /' >wide.off
cat >arm.urdf <<'END'
<robot name="arm"><link name="base"><collision><geometry><mesh filename="box.off"/></geometry></collision></link>
<link name="tool"/><joint name="j" type="revolute"><parent link="base"/><child link="tool"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>
END
printf 'j\n0\n1\n' >path.csv

run() {
  name=$1
  shift
  expect 0 '' "$@" --report "reports/$name.json"
}
run decimate "$BIN/bmesh-decimate" "$BRACKET" -o outer.ply --vertices 300 --log outer.log
run levels "$BIN/bmesh-decimate" "$BRACKET" -o 'level-{vertices}.ply' --vertices 300,200 --progressive outer.pm
run from "$BIN/bmesh-decimate" --from outer.pm --vertices 250 -o from.ply
run replay "$BIN/bmesh-replay" "$BRACKET" outer.log outer.ply
run prepare "$BIN/mesh-prepare" "$BRACKET" -o prepared.obj --verify
run wrap "$BIN/mesh-prepare" box.off -o wrapped.stl --prepare wrap --seal 10%
run decompose "$BIN/bcd-decompose" "$BRACKET" -o set.glb --epsilon 5% --effort fast --no-cache
run inner "$BIN/bcd-decompose" wide.off -o inner.glb --direction inner --epsilon 20% --no-cache
run robot "$BIN/bcd-decompose" arm.urdf -o safe --effort fast --no-cache
run robot-meshes "$BIN/bmesh-decimate" arm.urdf -o round --ratio 0.9 --effort fast --no-cache
run robot-spheres "$BIN/bcd-decompose" arm.urdf -o arm.yaml --bodies spheres --epsilon 0.4 --effort fast --no-cache
run robot-repair "$BIN/bcd-decompose" arm.urdf -o mended.yaml --repair arm.yaml --epsilon 0.4
run robot-capsules "$BIN/bcd-decompose" arm.urdf -o arm-capsules.xml --bodies capsules --epsilon 0.4 --effort fast --no-cache
run sweep "$BIN/sweep-approx" arm.urdf --path path.csv -o swept.glb --epsilon 0.2 --no-cache
run distance "$BIN/hausdorff-eval" box.off wide.off --samples 100
run verify-outer "$BIN/bound-verify" mesh --outer "$BRACKET" outer.ply
run verify-cover "$BIN/bound-verify" cover "$BRACKET" set.glb --epsilon 5%
run verify-robot "$BIN/bound-verify" robot arm.urdf safe/arm.urdf
run verify-spheres "$BIN/bound-verify" robot arm.urdf --spheres arm.yaml --epsilon 0.4
expect 1 '' "$BIN/bound-verify" robot arm.urdf --bodies arm-capsules.xml --epsilon 0.001 --report reports/verify-bodies.json
run verify-sweep "$BIN/bound-verify" sweep arm.urdf path.csv swept.glb
run verify-progressive "$BIN/bound-verify" progressive "$BRACKET" outer.pm
run scene "$BIN/kaboum-scene" make cell.json --robot arm=arm.urdf --object box=wide.off --no-cache
python3 -c 'import json
cell = json.load(open("cell.json"))
cell["objects"][0]["pose"] = {"position": [9, 0, 0]}
json.dump(cell, open("cell.json", "w"))'
run pairs "$BIN/kaboum-scene" pairs cell.json
run state "$BIN/kaboum-check" cell.json --distance
run batch-check "$BIN/kaboum-check" cell.json --batch path.csv
python3 -c 'import json
cell = json.load(open("cell.json"))
cell["objects"][0]["pose"] = {"position": [0, 0, 0]}
json.dump(cell, open("met.json", "w"))'
expect 1 '' "$BIN/kaboum-check" met.json --batch path.csv --report reports/batch-not-free.json
run motion "$BIN/kaboum-check" cell.json --path path.csv
run move "$BIN/kaboum-move" cell.json --from 0 --to 1 -o moved.csv --trajectory samples.csv
expect 1 '' "$BIN/bound-verify" mesh --outer wide.off box.off --report reports/refuted.json
printf '<robot name="arm">\n<disable_collisions link1="no" link2="such"/>\n<disable_collisions link1="base" link2="far"/>\n</robot>\n' >arm.srdf
sed 's#<link name="tool"/>#<link name="tool"><collision><geometry><mesh filename="wide.off"/></geometry></collision></link>#' arm.urdf |
  sed 's#</robot>#<link name="far"><collision><geometry><box size="1 1 1"/></geometry></collision></link><joint name="f" type="fixed"><parent link="tool"/><child link="far"/><origin xyz="0 0 100"/></joint></robot>#' >two.urdf
run links "$BIN/kaboum-pairs" two.urdf --judge arm.srdf
run ik "$BIN/kaboum-ik" arm.urdf --pose-of 0.5
cat >domain.pddl <<'END'
(define (domain d) (:requirements :strips) (:predicates (done)) (:action act :parameters () :precondition () :effect (done)))
END
printf '(define (problem p) (:domain d) (:init) (:goal (done)))\n' >problem.pddl
mkdir some
cp box.off wide.off some
run batch "$BIN/kaboum-batch" some -o batch --no-pictures
for command in list verify prune; do run "cache-$command" "$BIN/kaboum-cache" "$command" --folder absent; done
run solve "$BIN/kaboum-plan" solve domain.pddl problem.pddl -o plan.json
run check "$BIN/kaboum-plan" check domain.pddl problem.pddl --plan plan.json

python3 - "$SCHEMA" reports/*.json <<'END' || fail "a report does not keep to the schema"
import json, sys
import jsonschema
schema = json.load(open(sys.argv[1]))
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
bad = 0
for name in sys.argv[2:]:
    report = json.load(open(name))
    for error in validator.iter_errors(report):
        bad += 1
        print(f"{name}: {'/'.join(map(str, error.absolute_path))}: {error.message[:200]}")
    for field in schema["required"]:  # the schema itself can fail
        if not list(validator.iter_errors({k: v for k, v in report.items() if k != field})):
            bad += 1
            print(f"{name}: would pass without {field}")
sys.exit(bad != 0)
END
finish
