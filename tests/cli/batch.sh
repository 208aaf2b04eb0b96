# shellcheck shell=sh disable=SC2154
# kaboum-batch: all that can be done is done, whatever fails; ended by kill -9, it goes on where it was.
HERE=$(cd "$(dirname "$0")" && pwd)
. "$HERE/common.sh"
B=$BIN/kaboum-batch
KABOUM_CACHE=$WORK/cache
export KABOUM_CACHE
mkdir -p in/sub
for i in 1 2 3 4 5 6 7 8; do tetrahedron | sed "s/^1 0 0/1.$i 0 0/" >"in/t$i.off"; done
tetrahedron >"in/sub/a b & c.off"
tetrahedron >in/t1.obj                   # not an OBJ
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n' >in/cut.off
tetrahedron | sed 's/^1 0 0/nan 0 0/' >in/nan.off
echo text >in/readme.md

expect 1 '9 done, 3 failed' "$B" in -o out --rule 'sub/*: bcd-decompose --epsilon 2%' --command bmesh-decimate --epsilon 1%
[ -s "out/results/sub/a b & c.glb" ] || fail "no result of the rule"
[ -s out/results/t1.off-result.ply ] || fail "no result of t1.off, whose name another input has"
[ "$(find out/results -type f | wc -l)" = 9 ] || fail "results: $(find out/results -type f)"
[ -s "out/pictures/results/t2.ply.png" ] || fail "no picture"
grep -q 'a b &amp; c.off' out/summary.html || fail "no row in the page"
grep -q 'src="pictures/results/sub/a%20b%20%26%20c.glb.png"' out/summary.html || fail "no picture in the page"
[ "$(wc -l <out/summary.csv)" = 13 ] || fail "rows: $(wc -l <out/summary.csv)"
grep -q '^cut.off,.*failed,3,' out/summary.csv || fail "cut.off: $(grep ^cut out/summary.csv)"
grep -q '"verdict":"certified"' out/summary.json || fail "no verdict"
python3 -c '
import json
rows = json.load(open("out/summary.json"))["rows"]
done = [r for r in rows if r["state"] == "done"]
assert len(done) == 9 and all(r["distance"] is not None and r["vertices_after"] == 4 for r in done), done
assert all(r["reason"] for r in rows if r["state"] != "done")' || fail "figures of the summary"
"$BIN/bmesh-decimate" in/t3.off -o alone.ply --epsilon 1% --quiet
cmp -s alone.ply out/results/t3.ply || fail "another result than alone"

# A batch may write where its inputs are: its results are no inputs, neither its own nor another's.
mkdir beside
tetrahedron >beside/t.off
one() { expect 0 '^1 done' "$B" beside --no-pictures "$@" --command bmesh-decimate --epsilon 1%; }
one -o beside
expect 0 'results of a batch' "$B" beside -o beside --no-pictures --command bmesh-decimate --epsilon 1%
one -o beside
one -o beside/out
one -o elsewhere
[ "$(find beside -name '*.ply' | wc -l)" = 2 ] || fail "results: $(find beside -name '*.ply')"
expect 2 'beside/results/t.ply lies in beside/results, where this batch writes' "$B" beside/results/t.ply -o beside

# Nothing is done twice; what changed is, what failed with --retry, and what was removed.
lines() { wc -l <out/.kaboum-batch/journal.jsonl; }
again() { "$B" in -o out --rule 'sub/*: bcd-decompose --epsilon 2%' --quiet "$@" --command bmesh-decimate --epsilon 1%; }
before=$(lines)
again
[ "$(lines)" = "$before" ] || fail "something is done again"
touch in/t2.off
rm out/results/t4.ply
again
[ "$(lines)" = $((before + 2)) ] || fail "done again: $(($(lines) - before)), not 2"
again --retry
[ "$(lines)" = $((before + 5)) ] || fail "with --retry: $(($(lines) - before)), not 5"

# Other options and back, an input changed and back: a result is only done earlier if it is that very one.
mkdir back
cp "$BRACKET" back/bracket.obj
twice() { "$BIN/mesh-prepare" "$BRACKET" -o back/t.off --scale "$1" --quiet; }
twice 2
ways() { # OUT OPTIONS...
  for direction in outer inner outer; do
    expect 0 '2 done; [^0-9]' "$B" back -o "$@" --command bmesh-decimate --ratio 0.5 --direction $direction
  done
  for f in t.ply bracket.ply; do cmp -s "back-first/results/$f" "$1/results/$f" || fail "$1: $f is not the outer one"; done
  expect 0 '2 of them earlier' "$B" back -o "$@" --command bmesh-decimate --ratio 0.5 --direction outer
}
expect 0 '2 done' "$B" back -o back-first --no-pictures --command bmesh-decimate --ratio 0.5 --direction outer
ways back-whole --no-pictures
ways back-part --no-pictures --shard 1/1
cp -p back/t.off kept.off
twice 3
again_back() { expect 0 "$1" "$B" back -o back-whole --no-pictures --command bmesh-decimate --ratio 0.5 --direction outer; }
again_back '1 of them earlier'
cp -p kept.off back/t.off
again_back '1 of them earlier'
cmp -s back-first/results/t.ply back-whole/results/t.ply || fail "of an input that was changed and put back: another result"
# What fails, or writes nothing, takes nothing away, and is not said to have a result.
for command in 'bmesh-decimate --ratio 2' no-such-program "true {input}"; do
  # shellcheck disable=SC2086
  "$B" back -o back-whole --no-pictures --quiet --report said.json --command $command 2>err.txt
  cmp -s back-first/results/t.ply back-whole/results/t.ply || fail "$command: the result of other options is another"
  [ "$(grep -c '"sha256": ""\|"sha256":""' said.json)" -ge 1 ] || fail "$command: a result: $(cat said.json)"
done
again_back '2 of them earlier'
# Another input of the same name, size and time.
mkdir pa pb
tetrahedron | sed 's/^1 0 0/1.5 0 0/' >pa/t.off
tetrahedron | sed 's/^1 0 0/9.5 0 0/' >pb/t.off
touch -d @1 pa/t.off pb/t.off
expect 0 '1 done; p-out' "$B" pa -o p-out --no-pictures
expect 0 '1 done; p-out' "$B" pb -o p-out --no-pictures
"$BIN/bound-verify" mesh --outer pb/t.off p-out/results/t.ply --quiet || fail "the result of another input"
expect 2 'depfile' "$B" back -o x --command bmesh-decimate --ratio 0.5 --depfile=x.d

# A robot is done again when one of its meshes has changed.
mkdir robot
cp "$BRACKET" robot/part.obj
echo '<robot name="a"><link name="b"><collision><geometry><mesh filename="part.obj"/></geometry></collision></link></robot>' >robot/a.urdf
robot() { expect 0 "$1" "$B" robot/a.urdf -o robots --no-pictures --command bcd-decompose --epsilon "$2" --effort fast; }
robot '1 done; robots' 3%
robot '1 of them earlier' 3%
[ "$(head -n 1 robots/summary.csv | tr , '\n' | wc -l)" = "$(tail -n 1 robots/summary.csv | sed 's/"[^"]*"//g' | tr , '\n' | wc -l)" ] || fail "columns: $(cat robots/summary.csv)"
tetrahedron >t.off
"$BIN/mesh-prepare" t.off -o robot/part.obj --quiet
robot '1 done; robots' 3%
robot '1 of them earlier' 3%
robot '1 done; robots' 8%
robot '1 done; robots' 3%
# One that failed for its mesh; one where the program writes nothing; somebody's own robot.
expect 1 '1 failed' "$B" robot/a.urdf -o robots2 --no-pictures --command bcd-decompose --epsilon 3% --effort slow
echo no mesh >robot/part.obj
expect 1 '1 failed' "$B" robot/a.urdf -o robots2 --no-pictures --command bcd-decompose --epsilon 3% --effort fast
"$BIN/mesh-prepare" t.off -o robot/part.obj --quiet
expect 0 '1 done; robots2' "$B" robot/a.urdf -o robots2 --no-pictures --command bcd-decompose --epsilon 3% --effort fast
expect 0 '1 done' "$B" robot/a.urdf -o robots2 --no-pictures --report said.json --command true '{input}' '{output}'
grep -q '"sha256": ""' said.json || fail "a robot of before is the result of a program that writes nothing: $(cat said.json)"
mkdir -p robots3/results/a
echo own >robots3/results/a/mine.urdf
expect 1 '1 failed' "$B" robot/a.urdf -o robots3 --no-pictures --command bcd-decompose --epsilon 3% --effort fast
[ "$(cat robots3/results/a/mine.urdf)" = own ] || fail "somebody's robot is gone"
robot '1 done; robots' 3%
"$BIN/bound-verify" robot robot/a.urdf robots/results/a/a.urdf --epsilon 3% --quiet || fail "the robot is another batch's"

# A second batch in the same folder, limits, programs that are not there, lists.
cat >slow <<'END'
#!/bin/sh
sleep "${3:-30}"
cp "$1" "$2"
END
chmod +x slow
printf 'in/t1.off\n# comment\n\nin/t2.off\nin/absent.off\n' >list.txt
expect 1 '3 timeout' "$B" list.txt -o late --no-pictures --timeout 0.3 --command ./slow '{input}' '{output}'
expect 1 '3 failed' "$B" list.txt -o none --no-pictures --command no-such-program
grep -q 'no-such-program: cannot be run' none/summary.csv || fail "no reason"
expect 1 '2 done, 1 failed' "$B" list.txt -o listed --no-pictures --jobs 3
"$B" list.txt -o busy --no-pictures --quiet --command ./slow '{input}' '{output}' 5 &
first=$!
while [ ! -s busy/.kaboum-batch/journal.jsonl ] && [ ! -d busy/.kaboum-batch/scratch/1 ]; do sleep 0.05; done
expect 4 'another batch' "$B" list.txt -o busy
kill -INT "$first"
wait "$first"
[ $? = 7 ] || fail "Ctrl-C: exit code"
[ -s busy/summary.html ] || fail "no summary after Ctrl-C"
pgrep -f "$WORK/busy" >/dev/null && fail "a program still runs"

# Ended with kill -9 at several moments: no program outlives it, no result is half, nothing done is done again.
mkdir many
i=0
while [ $i -lt 40 ]; do
  tetrahedron | sed "s/^1 0 0/1.$i 0 0/" >"many/m$i.off"
  i=$((i + 1))
done
for files in 8 20; do
  "$B" many -o kept --no-pictures --quiet &
  batch=$!
  journal=kept/.kaboum-batch/journal.jsonl
  while [ ! -f $journal ] || [ "$(wc -l <$journal)" -lt $files ]; do sleep 0.02; done
  kill -9 "$batch"
  wait "$batch" 2>/dev/null
done
tries=0
while pgrep -f "$WORK/kept" >/dev/null && [ $tries -lt 50 ]; do
  sleep 0.1
  tries=$((tries + 1))
done
pgrep -f "$WORK/kept" >/dev/null && fail "a program outlives its batch"
expect 0 '40 done; [0-9]* of them earlier' "$B" many -o kept --no-pictures
[ "$(cut -d'"' -f4 kept/.kaboum-batch/journal.jsonl | sort | uniq -d | wc -l)" = 0 ] || fail "done twice"
[ "$(find kept/results -name '*.ply' | wc -l)" = 40 ] || fail "not 40 results"
[ -z "$(find kept -name '*.tmp')" ] || fail "left behind: $(find kept -name '*.tmp')"
absent kept/.kaboum-batch/scratch
"$B" many -o fresh --no-pictures --quiet || fail "fresh"
for f in fresh/results/*; do cmp -s "$f" "kept/results/${f##*/}" || fail "$f differs"; done

# In parts, by several runs at the same time: each file once, and all as in one run, whoever does it.
shards() { # OUT N
  k=0
  while [ $k -lt "$2" ]; do
    k=$((k + 1))
    "$B" many -o "$1" --no-pictures --quiet --shard $k/"$2" &
  done
  wait
}
shards parts 3
[ -f parts/summary.html ] && fail "a part writes the summary of all"
[ "$(cat parts/.kaboum-batch/journal-*.jsonl | cut -d'"' -f4 | sort | uniq | wc -l)" = 40 ] || fail "not all files are of one part"
[ "$(cat parts/.kaboum-batch/journal-*.jsonl | wc -l)" = 40 ] || fail "some files are of two parts"
expect 0 '40 done; .*summary.html' "$B" many -o parts --no-pictures --summary
diff -r fresh/results parts/results >diff.txt || fail "other results in parts: $(cat diff.txt)"
rows() { sed -n 's/"wall_seconds.*"vertices_before"//p' "$1/summary.json"; }
rows fresh >fresh.txt
rows parts >parts.txt
[ "$(wc -l <parts.txt)" = 40 ] && cmp -s fresh.txt parts.txt || fail "another summary in parts: $(diff fresh.txt parts.txt | head -n 3)"
# Another number of parts, or none: nothing is left to do, unless a result is gone.
shards parts 2
expect 0 '40 done; 40 of them earlier' "$B" many -o parts --no-pictures
[ "$(cat parts/.kaboum-batch/journal*.jsonl | wc -l)" = 40 ] || fail "something is done again"
rm parts/results/m7.ply
expect 1 '39 done; 1 to do' "$B" many -o parts --no-pictures --summary
shards parts 5
expect 0 '40 done' "$B" many -o parts --no-pictures --summary
[ -s parts/results/m7.ply ] || fail "what is gone is not made again"
# One part twice at the same time: done twice, and harmless.
for run in 1 2; do "$B" many -o twice --no-pictures --quiet --shard 1/1 & done
wait
expect 0 '40 done' "$B" many -o twice --no-pictures --summary
diff -r fresh/results twice/results >diff.txt || fail "other results twice: $(cat diff.txt)"
[ -z "$(find parts twice -name '*.tmp' -o -name 'scratch*')" ] || fail "left behind by parts"
# Ended by kill -9 and cut short, of all machines; what is old is removed.
"$B" many -o killed --no-pictures --quiet --shard 1/2 &
batch=$!
while [ "$(cat killed/.kaboum-batch/journal-*.jsonl 2>/dev/null | wc -l)" -lt 5 ]; do sleep 0.02; done
kill -9 "$batch"
wait "$batch" 2>/dev/null
for journal in killed/.kaboum-batch/journal-*.jsonl; do printf '{"name":"m0.off","key":"' >>"$journal"; done
touch -d '8 days ago' killed/.kaboum-batch/scratch-*
mkdir killed/.kaboum-batch/scratch-of-another
shards killed 2
expect 0 '40 done' "$B" many -o killed --no-pictures --summary
diff -r fresh/results killed/results >diff.txt || fail "other results after an end: $(cat diff.txt)"
[ "$(cd killed/.kaboum-batch && echo scratch*)" = scratch-of-another ] || fail "scratch: $(ls killed/.kaboum-batch)"
for wrong in 0/2 3/2 1 1/0 a/b 1/2/3 -1/2; do
  expect 2 '--shard' "$B" many -o x --shard="$wrong"
done
expect 2 '' "$B" many -o x --shard 1/2 --summary
absent x

# Programs that are told to end with their batch have not failed: they are done the next time.
cat >told <<'END'
#!/bin/sh
[ -e go ] || kill -TERM $$
cp "$1" "$2"
END
chmod +x told
expect 1 '3 to do' "$B" list.txt -o told-out --no-pictures --command ./told '{input}' '{output}'
: >go
expect 1 '2 done, 1 no' "$B" list.txt -o told-out --no-pictures --command ./told '{input}' '{output}'

# A robot with a dot in its name becomes a folder, once.
mkdir -p dotted
tetrahedron >dotted/t.off
echo '<robot name="a"><link name="b"><collision><geometry><mesh filename="t.off"/></geometry></collision></link></robot>' >dotted/arm.v2.urdf
for run in 1 2; do
  expect 0 '1 done' "$B" dotted -o dots --no-pictures --rule '*.urdf: bcd-decompose --epsilon 2%'
done
[ -s dots/results/arm.v2/arm.v2.urdf ] || fail "no robot: $(find dots/results)"
[ "$(wc -l <dots/.kaboum-batch/journal.jsonl)" = 1 ] || fail "a robot is done again"

# Results within the folder of inputs are no inputs the next time.
expect 0 '8 done' "$B" in -o in/results --no-pictures --rule 't[1-8].off: bmesh-decimate --epsilon 1%'
expect 0 '8 done; 8 of them earlier' "$B" in -o in/results --no-pictures --rule 't[1-8].off: bmesh-decimate --epsilon 1%' --rule 'results/*: false'
run_tool 3 "$B" in/sub/absent -o x --rule 'y: z'
expect 2 'PATTERN: PROGRAM' "$B" in -o x --rule bad
finish
