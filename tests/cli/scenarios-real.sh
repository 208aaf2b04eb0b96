# shellcheck shell=sh disable=SC2154
# A scenario with a real robot of the mesh collection, small: planned, checked, executed among its exact meshes.
HERE=$(cd "$(dirname "$0")" && pwd)
. "$HERE/common.sh"
KABOUM_BIN=$BIN
export KABOUM_BIN
"$HERE/../../examples/scenarios/remove/run" 2 --real ur5 --out ur5 >said.txt 2>err.txt || fail "exit code $?: $(tail -3 err.txt)"
tail -1 said.txt | python3 -c '
import json, sys
r = json.load(sys.stdin)
assert r["solved"] and r["checked"] and r["actions"] == 4 and r["samples"] > 1000, r
assert r["collisions"] == r["limit_violations"] == r["jumps"] == 0, r' || fail "ur5: $(tail -1 said.txt)"
[ -s ur5/plan.html ] || fail "no page"
finish
