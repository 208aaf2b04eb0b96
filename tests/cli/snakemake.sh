# shellcheck shell=sh disable=SC2154
# examples/pipeline by Snakemake: made in parts, the bytes of one machine, verified; then nothing to do until something changes.
HERE=$(cd "$(dirname "$0")" && pwd)
command -v snakemake >/dev/null || exit 77
. "$HERE/common.sh"
KABOUM_CACHE=$WORK/cache XDG_CACHE_HOME=$WORK/xdg
export KABOUM_CACHE XDG_CACHE_HOME
cp -r "$HERE/../../examples/pipeline" pipeline
cd pipeline || exit 1
flow() { snakemake --cores 2 --config bin="$BIN/" >../snakemake.txt 2>&1; }
flow || fail "snakemake: $(tail -n 5 ../snakemake.txt)"
for name in ring plate arm; do grep -q '"verdict": "verified"' $name.verdict || fail "$name is not verified"; done
"$BIN/kaboum-batch" ring.obj plate.obj arm.urdf -o alone --no-pictures --quiet --command bcd-decompose --epsilon 1% || fail "alone"
diff -r alone/results batch/results >../diff.txt || fail "other results: $(cat ../diff.txt)"
grep -q '"to_do": 0' batch/summary.json || fail "summary"
flow || fail "snakemake again"
grep -q 'Nothing to be done' ../snakemake.txt || fail "the second time does something: $(cat ../snakemake.txt)"
sleep 1.1
echo '# changed' >>plate.obj
flow || fail "after a change: $(tail -n 5 ../snakemake.txt)"
[ "$(cat batch/.kaboum-batch/journal-*.jsonl | wc -l)" = 5 ] || fail "not only the plate and the arm that refers to it are made anew"
cd .. || exit 1
finish
