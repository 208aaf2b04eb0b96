# shellcheck shell=sh disable=SC2154
# Scenarios end to end, small ones: planned, checked, every branch executed among the exact meshes.
HERE=$(cd "$(dirname "$0")" && pwd)
. "$HERE/common.sh"
S=$HERE/../../examples/scenarios
KABOUM_BIN=$BIN
KABOUM_CACHE=$WORK/cache
export KABOUM_BIN KABOUM_CACHE
# scenario NAME N NODES BRANCHES OPTIONS...: solved with so many nodes, so many branches executed, nothing wrong.
scenario() {
  name=$1 n=$2 nodes=$3 branches=$4
  shift 4
  "$S/$name/run" "$n" --out "$name" "$@" >said.txt 2>err.txt || fail "$name: exit code $?: $(tail -3 err.txt)"
  tail -1 said.txt >last.json
  python3 - "$name" "$n" "$nodes" "$branches" <<'END' || fail "$name: $(cat last.json)"
import json, sys
r = json.load(open("last.json"))
name, n, nodes, branches = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])
keys = ["scenario", "n", "seed", "solved", "actions", "nodes", "leaves", "plan_s", "predicate_calls", "ik_calls",
        "executed_branches", "samples", "collisions", "limit_violations"]
assert list(r)[:len(keys)] == keys, list(r)
assert r["scenario"] == name and r["n"] == n and r["solved"] and r["checked"], "not solved"
assert r["nodes"] <= nodes and r["executed_branches"] == branches, (r["nodes"], r["executed_branches"])
assert r["collisions"] == r["limit_violations"] == r["jumps"] == 0 and r["samples"] > 1000
assert r["predicate_calls"] > 0 and r["ik_calls"] > 0
END
  [ -s "$name/plan.svg" ] || fail "$name: no drawing"
}
scenario force-sensing 2 10 4
scenario bimanual-assembly 4 8 1
P=$BIN/kaboum-plan
D=$S/bimanual-assembly/domain.kpl
set -- "$D" bimanual-assembly/problem.kpl --scene bimanual-assembly/cell.json
# Of a second run nothing is asked again; its plan is the same.
expect 0 solved "$P" solve "$@" -o again.json --report again-report.json
cmp -s again.json bimanual-assembly/plan.json || fail "another plan from kept answers"
python3 -c 'import json; g = json.load(open("again-report.json"))["geometry"]; assert g["answers_reused"] > 0 and g["paths"] == 0, g' ||
  fail "answers are not reused"
expect 0 solved "$P" solve "$@" -o anew.json --no-cache --threads 2
cmp -s anew.json again.json || fail "another plan without kept answers"
# A bearing that is held inside does not go onto the tree: the geometry finds it, and says so.
sed '/^action move/,/^  effects: add(Kf, conf/d; s/^goal:.*/goal: K(containsBearing(o4))/
  s/K(isABearing(?b)) & K(isATree(?t))/K(isABearing(?b)) \& K(isATree(?t)) \& K(?r != robot1)/' "$D" >inner.kpl
expect 7 'join(robot2, o[12], o4, home): not found.*does not slide into o4' "$P" solve inner.kpl bimanual-assembly/problem.kpl \
  --scene bimanual-assembly/cell.json -o none.json --explain --timeout 8
[ ! -e none.json ] || fail "a plan was written"
finish
