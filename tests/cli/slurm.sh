# shellcheck shell=sh disable=SC2154
# A batch by two nodes of a Slurm cluster, which is started here: the bytes of one machine, each file once, also where
# tasks were ended and are submitted again.
HERE=$(cd "$(dirname "$0")" && pwd)
. "$HERE/common.sh"
. "$HERE/../support/slurm-cluster.sh"
trap 'stop_cluster; rm -rf "$WORK"' EXIT
start_cluster "$WORK/cluster"
case $? in
  0) ;;
  77) exit 77 ;;
  *)
    fail "no cluster: $(tail -n 3 "$WORK"/cluster/*.txt)"
    finish
    ;;
esac
B=$BIN/kaboum-batch
SCRIPT=$HERE/../../share/slurm/kaboum-batch.slurm
KABOUM_CACHE=$WORK/cache KABOUM_BIN=$BIN/
export KABOUM_CACHE KABOUM_BIN
mkdir -p in/sub
i=0
while [ $i -lt 36 ]; do
  tetrahedron | sed "s/^1 0 0/1.$i 0 0/" >"in/m$i.off"
  i=$((i + 1))
done
tetrahedron >'in/sub/a b & c.off'
tetrahedron >in/m1.obj # not an OBJ
head -c 60 in/m2.off >in/cut.off
cat >in/arm.urdf <<'END'
<robot name="arm"><link name="base"><collision><geometry><mesh filename="m3.off"/></geometry></collision></link></robot>
END
echo "*.urdf: bcd-decompose --epsilon 2%" >rules.txt
batch() { "$B" in -o "$@" --no-pictures --quiet --rules rules.txt --command bmesh-decimate --epsilon 1%; }
submit() { sbatch --parsable --output="slurm-%j.txt" "$@"; }
# slurm OUT SBATCH_OPTIONS...: the job's number.
slurm() {
  out=$1
  shift
  submit "$@" "$SCRIPT" in -o "$out" --no-pictures --rules rules.txt --command bmesh-decimate --epsilon 1%
}
# The summary's rows but for what is measured.
rows() {
  python3 -c '
import json, sys
summary = json.load(open(sys.argv[1] + "/summary.json"))
assert summary["to_do"] == 0, summary["to_do"]
for row in summary["rows"]:
    for measured in ("wall_seconds", "cpu_seconds", "peak_megabytes"): del row[measured]
    row["reason"] = row["reason"].replace(sys.argv[1], "OUT")
print(json.dumps(summary["rows"], indent=1))' "$1"
}
same_as_alone() {
  diff -r alone/results "$1/results" >diff.txt || fail "$1: other results: $(cat diff.txt)"
  rows "$1" >rows.txt || fail "$1: summary"
  cmp -s alone.txt rows.txt || fail "$1: another summary: $(diff alone.txt rows.txt)"
  [ "$(cat "$1"/.kaboum-batch/journal*.jsonl | wc -l)" = 40 ] || fail "$1: not each file once"
  [ -z "$(find "$1/.kaboum-batch" -name 'scratch*')" ] || fail "$1: scratch folders stay"
}
batch alone
[ $? = 1 ] || fail "alone"
rows alone >alone.txt

# Six parts by two nodes, then the summary; nothing is left for the next submission.
job=$(slurm shared --array=1-6)
slurm shared --wait --dependency="afterany:$job" >/dev/null
same_as_alone shared
grep -q '"state":"failed"' shared/summary.json || fail "no reasons"
for node in 1 2; do grep -q 'Launching batch job' "$WORK/cluster/node$node.txt" || fail "node$node has no task"; done
[ "$(cat shared/.kaboum-batch/journal-*.jsonl | wc -l)" = 40 ] || fail "something is not done by a part"
slurm shared --wait --array=1-6 >/dev/null || fail "submitted again"
same_as_alone shared

# Tasks that are ended, and submitted again with other parts.
cat >slow <<'END'
#!/bin/sh
[ -e "$WORK/quick" ] || sleep 0.5
exec "$BIN/bmesh-decimate" "$@" --epsilon 1%
END
chmod +x slow
export BIN WORK
slow() { sbatch --parsable --output="slurm-%j.txt" "$@" "$SCRIPT" in -o slow-out --no-pictures --rules rules.txt --command "$WORK/slow"; }
job=$(slow --array=1-2)
done_files() { [ "$(cat slow-out/.kaboum-batch/journal-*.jsonl 2>/dev/null | wc -l)" -ge 6 ]; }
wait_for done_files || fail "no task works: $(cat slurm-*.txt)"
scancel --signal=KILL --full "$job"
is_over() { [ -z "$(squeue -h -j "$job" 2>/dev/null)" ]; }
wait_for is_over || fail "the job does not end"
[ "$(cat slow-out/.kaboum-batch/journal-*.jsonl | wc -l)" -lt 40 ] || fail "ended too late"
: >quick
slow --wait --array=1-3 >/dev/null || fail "submitted again after an end"
expect 1 '38 done, 2 failed' "$B" in -o slow-out --summary --no-pictures --rules rules.txt --command "$WORK/slow"
diff -r alone/results slow-out/results >diff.txt || fail "other results after an end: $(cat diff.txt)"
[ "$(cut -d'"' -f4 slow-out/.kaboum-batch/journal-*.jsonl | sort | uniq -d)" = '' ] || fail "done twice"
finish
