. "$(dirname "$0")/common.sh"
V=$BIN/bound-verify
D=$BIN/bmesh-decimate

# cube LOW HIGH [FACES]: an axis-aligned cube as OFF, all twelve triangles or the first few.
cube() {
  awk -v a="$1" -v b="$2" -v n="${3:-12}" 'BEGIN {
    print "OFF"; print 8, n, 0
    for (i = 0; i < 8; i++) print (i % 2 ? b : a), (int(i / 2) % 2 ? b : a), (i > 3 ? b : a)
    split("0 2 1,1 2 3,4 5 6,5 7 6,0 1 4,1 5 4,2 6 3,3 6 7,0 4 2,2 4 6,1 3 5,3 7 5", t, ",")
    for (i = 1; i <= n; i++) print 3, t[i] }'
}
cube 0 1 >one.off
cube -1 2 >three.off
cube 0 1 11 >open.off

# What the answers are, and that they reach the exit code.
shows 0 'solid claim: verified' "$V" mesh --outer one.off three.off
shows 0 'surface claim: verified' "$V" mesh --outer one.off three.off
shows 1 'solid claim: refuted' "$V" mesh --outer three.off one.off
shows 0 '^verified$' "$V" mesh --inner three.off one.off
shows 1 '^refuted$' "$V" mesh --inner one.off three.off
expect 0 '' "$V" mesh --outer one.off one.off
expect 0 '' "$V" mesh --inner one.off one.off
shows 1 'surface claim: refuted: 12 .*they stick out by at least 1.7320.* and at most 1.7320.*, triangle' "$V" mesh --outer three.off one.off
shows 1 'solid claim: refuted.*sticks out by at least 1.7.* and at most 1.7' "$V" mesh --outer three.off one.off
cube 0 0.9999999999 >less.off
shows 1 'refuted' "$V" mesh --outer one.off less.off
expect 0 '' "$V" mesh --inner one.off less.off

# Sheets: no solid, but a surface. --claims chooses what decides.
printf 'OFF\n3 2 0\n5 0 0\n6 0 0\n5 1 0\n3 0 1 2\n3 0 2 1\n' >sheet.off
shows 1 'surface claim: refuted' "$V" mesh --outer sheet.off one.off
shows 0 'surface claim: refuted' "$V" mesh --outer sheet.off one.off --claims solid
expect 1 '' "$V" mesh --outer sheet.off one.off --claims surface

# A prism that crosses itself: a part of it is inside out, and its far edge 1.25 from the rest, the
# solid. Which claim holds, and which does not.
printf 'OFF\n8 12 0\n0 0 0\n4 3 0\n4 0 0\n0 1 0\n0 0 1\n4 3 1\n4 0 1\n0 1 1\n' >fold.off
for t in '0 1 2' '0 2 3' '4 6 5' '4 7 6' '0 4 5' '0 5 1' '1 5 6' '1 6 2' '2 6 7' '2 7 3' '3 7 4' '3 4 0'; do
  echo "3 $t"
done >>fold.off
expect 1 'solid is enclosed, but not all of its triangles: 10 stick out, by at least 1.2' "$D" fold.off -o folded.off --vertices 8 \
  --report fold.json --prepare strict
grep -q '"surface_triangles_outside": 10' fold.json || fail 'no number of triangles that stick out'
shows 1 'solid claim: undecided: a part of the surface crosses itself' "$V" mesh --outer fold.off folded.off --prepare
grep -q 'surface claim: refuted: 10 .*stick out by at least 1.2' out.txt || fail "no depth: $(cat out.txt)"

for options in '--vertices 40' '--epsilon 10%' '--vertices 40 --verify' '--epsilon 10% --cost planes'; do
  # shellcheck disable=SC2086  # options
  expect 0 'the input is wrapped' "$D" fold.off -o folded.off $options --effort fast
  shows 0 'surface claim: verified' "$V" mesh --outer fold.off folded.off --raw
done
expect 1 '' "$D" fold.off -o folded.off --vertices 8 --log fold.log --quiet
expect 1 '' "$D" fold.off -o folded.off --vertices 8 --keep-orientation --quiet
# Triangles without area are segments and points, which stick out or not.
printf 'OFF\n3 1 0\n0.5 0.5 0.5\n5 0.5 0.5\n3 0.5 0.5\n3 0 1 2\n' >segment.off
shows 1 'surface claim: refuted: 1 .*they stick out by at least 3.999.* and at most 4' "$V" mesh --outer segment.off one.off --raw
expect 1 '' "$V" cover segment.off one.off --raw
shows 0 'every triangle of the original' "$V" mesh --outer segment.off one.off --scale 0.2 --raw
expect 3 'none of its triangles has an area' "$V" mesh --outer segment.off one.off --claims solid
{ sed 's/^8 12 0/9 13 0/; s/^\(1 1 1\)$/\1\n3 0.5 0.5/' one.off; echo 3 0 8 8; } >whisker.off
shows 1 'surface claim: refuted: 1 .*triangle 12' "$V" mesh --outer whisker.off one.off --raw
grep -q 'segment or point that no other triangle has' err.txt || fail "the whisker is not noted: $(cat err.txt)"
cube -1 4 >five.off
shows 0 'every triangle of the original' "$V" mesh --outer whisker.off five.off --raw
printf 'OFF\n2 1 0\n0 0 0\n9 0 0\n3 0 1 1\n' >only.off
expect 3 'no triangles: all 1 have two or more equal corners' "$V" mesh --outer only.off one.off --raw
printf 'v 0 0 0\nv 5 5 5\n' >points.obj
expect 3 'no triangles' "$V" mesh --outer points.obj one.off --raw

# Open meshes.
shows 0 'surface claim: verified' "$V" mesh --outer open.off three.off
expect 3 'not a closed mesh' "$V" mesh --outer one.off open.off
grep -q 'open.off' err.txt || fail 'the open file is not named'
expect 3 'not a closed mesh' "$V" mesh --outer open.off three.off --claims solid
shows 0 'same border' "$V" mesh --outer open.off open.off
expect 3 '' "$V" mesh --inner open.off one.off
shows 1 'surface claim: refuted' "$V" mesh --outer open.off less.off

shows 0 'as far as an open mesh defines it' "$V" mesh --outer open.off three.off

# What is said when something looks mistaken.
expect 1 '' "$V" mesh --outer three.off one.off
grep -q 'ORIGINAL comes first' err.txt || fail 'no word of swapped files'
cube 0 0.001 >small.off
expect 1 '' "$V" mesh --outer one.off small.off
grep -q 'same unit' err.txt || fail 'no word of units'
cube 1 0 >turned.off
expect 1 '' "$V" mesh --outer one.off turned.off
grep -q 'the approximation is inside out' err.txt || fail 'no word of the orientation'
# An empty solid is within any other: that alone is no verdict.
expect 3 'turned.off is inside out.*says nothing' "$V" mesh --inner one.off turned.off --claims solid
expect 3 'turned.off is inside out.*--prepare' "$V" mesh --outer turned.off three.off --claims solid --report empty.json
grep -q '"verdict": "undefined"' empty.json || fail 'the report has a verdict of an empty solid'
expect 3 'is inside out' "$V" mesh --outer turned.off one.off --claims solid
expect 0 '' "$V" mesh --outer turned.off three.off --claims solid --prepare
expect 0 '' "$V" mesh --outer turned.off three.off
expect 1 '' "$V" mesh --inner less.off turned.off --claims all
expect 3 'nowhere: no such file or folder' "$V" cover one.off nowhere
expect 3 'nowhere: no such file or folder' "$V" mesh --outer nowhere one.off
expect 2 'approximation-format' "$V" mesh --outer one.off - <three.off
expect 2 'prepare' "$V" mesh --outer one.off three.off --drop-sheets
cube 0 1 | awk 'NR == 2 { $0 = "11 14 0" } { print } NR == 10 { print "5 0 0\n6 0 0\n5 1 0" }
  END { print "3 8 9 10\n3 8 10 9" }' >sheeted.off
shows 1 'surface claim: refuted' "$V" mesh --outer sheeted.off three.off
# Where preparing refuses a mesh, every triangle of the file is judged, and what they wind round, whichever way.
expect 1 'every triangle is judged as it is, .*drop-sheets' "$V" mesh --outer sheeted.off three.off --prepare
cube -1 7 >seven.off
for relation in 'mesh --outer' cover; do
  # shellcheck disable=SC2086
  shows 0 'surface claim: verified' "$V" $relation sheeted.off seven.off --prepare --report r.json
  grep -q '"cannot_be_prepared": ".*sheets' r.json || fail "nothing in the report: $(cat r.json)"
  # shellcheck disable=SC2086
  shows 1 'surface claim: refuted: 2 .*they stick out by at least 3.99.* and at most 4.0.*, triangle 1[23]' "$V" $relation sheeted.off three.off --prepare
done
shows 0 'distance from the union to the solid: verified' "$V" cover sheeted.off seven.off --prepare --epsilon 11
shows 1 'distance from the union to the solid: refuted' "$V" cover sheeted.off seven.off --prepare --epsilon 6
expect 3 'sheets' "$V" mesh --inner sheeted.off one.off --prepare
# The box inside out: what it winds round is held, or not.
awk 'NR > 13 && NR < 26 { print 3, $2, $4, $3; next } { print }' sheeted.off >turned-sheeted.off
shows 0 'solid claim: verified' "$V" cover turned-sheeted.off seven.off --prepare
{
  printf 'OFF\n16 24 0\n'
  cube -1 7 | sed -n 3,10p
  cube 0.2 0.8 | sed -n 3,10p
  cube -1 7 | sed -n 11,22p
  cube 0.2 0.8 | sed -n 11,22p | awk '{ print 3, $2 + 8, $4 + 8, $3 + 8 }'
} >hollow.off
for f in sheeted turned-sheeted; do
  shows 1 'solid claim: refuted: .*it sticks out by at least 0\.[23]' "$V" mesh --outer $f.off hollow.off --prepare
  shows 0 'surface claim: verified' "$V" mesh --outer $f.off hollow.off --prepare --claims surface
  expect 1 '' "$V" mesh --outer $f.off hollow.off --prepare --claims solid
done
shows 0 'surface claim: verified' "$V" mesh --outer sheeted.off three.off --prepare --drop-sheets

# A distance alone refuted: its triangle is the witness.
shows 1 'refuted' "$V" mesh --outer one.off three.off --epsilon 0.5 --witness far.obj
[ "$(grep -c '^f' far.obj)" -ge 1 ] || fail 'no witness of a distance'

# Where nothing can be written, nothing is computed and nothing is called verified.
expect 4 'no-such-folder' "$V" mesh --outer one.off three.off --report no-such-folder/r.json
if [ -w /dev/full ]; then
  code=0
  "$V" mesh --outer one.off three.off >/dev/full 2>err.txt || code=$?
  [ "$code" -eq 4 ] || fail "exit code $code when standard output is full"
  code=0
  "$V" --help >/dev/full 2>err.txt || code=$?
  [ "$code" -eq 4 ] || fail "exit code $code when the help does not fit"
fi

cube 0.25 0.75 >core.off

# A set of bodies is no mesh: its margin would be lost.
mkdir -p core && "$BIN/bmesh-decimate" core.off -o core/a.stl --vertices 8 --quiet || fail 'core'
expect 2 'bound-verify cover decides whether it covers' "$V" mesh --outer one.off core
expect 2 'bound-verify cover decides whether it covers' "$V" mesh --outer one.off core.off --set

# Inner sets: bodies inside, and what they leave out.
shows 0 'convexity: verified' "$V" mesh --inner one.off core
shows 0 'depth: verified' "$V" mesh --inner one.off core --epsilon 0.26
shows 1 'depth: refuted' "$V" mesh --inner one.off core --epsilon 0.24 --witness deep.obj
[ "$(grep -c '^f' deep.obj)" -ge 1 ] || fail 'no witness of a depth'
shows 0 'depth: verified' "$V" mesh --inner one.off core.off --set --epsilon 0.26
cube 0.3 0.7 >smaller.off
shows 1 'solid claim: refuted' "$V" mesh --inner smaller.off core

# Limit.
cube 0.5 1.5 >moved.off
shows 7 'undecided' "$V" mesh --outer one.off moved.off --max-contacts 1

# Usage and bad input.
expect 2 '' "$V"
expect 2 '' "$V" one.off three.off
expect 2 '' "$V" mesh --outer one.off
expect 2 '' "$V" mesh --outer --inner one.off three.off
expect 2 '' "$V" mesh --outer one.off three.off --claims some
expect 2 '' "$V" mesh --outer one.off three.off --wrong
expect 2 'epsilon' "$V" mesh --outer one.off three.off --epsilon -1
expect 2 'epsilon' "$V" mesh --outer one.off three.off --epsilon nonsense
expect 2 '' "$V" mesh --outer - - --input-format off --approximation-format off
expect 2 '' "$V" mesh --outer one.off three.off --max-contacts 0
expect 3 'missing.off' "$V" mesh --outer missing.off three.off
expect 3 'missing.off' "$V" mesh --outer one.off missing.off
expect 3 'missing.off' "$V" cover one.off missing.off
head -c 60 one.off >cut.off
expect 3 'cut.off' "$V" mesh --outer one.off cut.off
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\nnan 1 0\n3 0 1 2\n' >nan.off
expect 3 'finite' "$V" mesh --outer nan.off three.off
shows 0 'Exit codes' "$V" --help
expect 0 '' "$V" --version

# Witness: the offending triangles, only when refuted; in any format that is written.
expect 1 '' "$V" mesh --outer three.off one.off --witness w.ply
expect 0 '' "$V" mesh --outer w.ply three.off --claims surface
expect 1 '' "$V" mesh --outer three.off one.off --witness w.obj
grep -q '^f ' w.obj || fail 'no triangle in the witness'
expect 0 '' "$V" mesh --outer one.off three.off --witness none.ply
absent none.ply
# Where nothing can be written the code says so, and no report is left that would look complete.
expect 4 '' "$V" mesh --outer three.off one.off --witness no/such/folder/w.ply --report r4.json
expect 4 '' "$V" mesh --outer one.off three.off --report no/such/folder/r.json
absent no r4.json

# Distances.
shows 0 'nowhere more than' "$V" mesh --outer one.off three.off --epsilon 1.74
shows 1 'distance from approximation to original: refuted' "$V" mesh --outer one.off three.off --epsilon 1.73
expect 0 '' "$V" mesh --outer one.off three.off --epsilon 101%
expect 1 '' "$V" mesh --outer one.off three.off --epsilon 99%

# Covers.
{ echo 'o left'; cube 0 1 | awk 'NF == 3 && NR > 2 { print "v", $1, $2, $3 } NF == 4 { print "f", $2 + 1, $3 + 1, $4 + 1 }'
  echo 'o right'; cube 0.5 2 | awk 'NF == 3 && NR > 2 { print "v", $1, $2, $3 } NF == 4 { print "f", $2 + 9, $3 + 9, $4 + 9 }'
} >set.obj
cube 0 2 >two.off
shows 0 'convexity: verified: all 2 bodies are convex' "$V" cover one.off set.obj
shows 1 'solid claim: refuted' "$V" cover two.off set.obj --report cover.json
grep -q '"bodies": 2' cover.json || fail 'no number of bodies in the report'
shows 0 'distance from the union to the solid' "$V" cover one.off set.obj --epsilon 1.74
expect 1 '' "$V" cover one.off set.obj --epsilon 1.73
printf 'OFF\n5 6 0\n0 0 0\n2 0 0\n0 2 0\n0 0 2\n.3 .3 .3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 4\n3 2 3 4\n3 3 1 4\n' >dent.off
shows 1 'convexity: refuted' "$V" cover dent.off dent.off
shows 1 'convexity: refuted' "$V" cover open.off open.off

# What bcd-decompose claims of an open mesh is about the mesh as prepared.
cube 0 1 10 >gap.off
"$BIN/bcd-decompose" gap.off -o gap.glb --epsilon 1% --no-cache --quiet || fail 'decompose gap'
expect 1 'prepare judges that: 1 hole is filled with 4 triangles' "$V" cover gap.off gap.glb --epsilon 1%
shows 0 'distance from the union to the solid: verified' "$V" cover gap.off gap.glb --epsilon 1% --prepare
grep -q '1 hole is filled with 4 triangles, 1.414 across' err.txt || fail 'no word of the filling'
# So with one of mixed orientation.
sed 's/^3 4 5 6$/3 4 6 5/' one.off >mixed.off
expect 1 'prepare judges that: 3 edges with neighbours of opposite orientation' "$V" mesh --outer mixed.off less.off
shows 0 'solid claim: verified' "$V" mesh --outer mixed.off three.off --prepare

# A part that is inside out is said even where everything is verified, and --prepare judges it.
{
  printf 'OFF\n16 24 0\n'
  cube 0 4 | sed -n 3,10p
  cube 6 7 | sed -n 3,10p
  cube 0 4 | sed -n 11,22p
  cube 6 7 | sed -n 11,22p | awk '{ print 3, $2 + 8, $4 + 8, $3 + 8 }'
} >inverted.off
shows 0 'solid claim: verified' "$V" mesh --outer inverted.off inverted.off --claims solid --report inverted.json
grep -q 'warning: inverted.off: 1 part of it is inside out (the first at triangle 12' err.txt || fail 'no word of the part'
grep -q '"inside_out_parts": 1' inverted.json || fail 'no word of the part in the report'
shows 1 'solid claim: refuted' "$V" mesh --outer inverted.off inverted.off --prepare

# An inward box at a wall of the one round it: as well a notch. It is said, and cannot be prepared: both are to be held.
{
  printf 'OFF\n16 24 0\n'
  printf '%s\n' '3 0 3' '4 0 3' '3 2 3' '4 2 3' '3 0 4' '4 0 4' '3 2 4' '4 2 4'
  printf '%s\n' '3 0 3' '4 0 3' '3 1 3' '4 1 3' '3 0 4' '4 0 4' '3 1 4' '4 1 4'
  cube 0 1 | sed -n 11,22p
  cube 0 1 | sed -n 11,22p | awk '
    { t[NR] = $2 + 8 " " $4 + 8 " " $3 + 8 }
    END { for (i = 1; i <= NR; ++i) if (i != 5 && i != 6) print 3, t[i]; print "3 8 13 9"; print "3 8 12 13" }'
} >notch.off
shows 0 'solid claim: verified' "$V" mesh --outer notch.off notch.off --claims solid --report notch.json
grep -q 'warning: notch.off: what its surfaces enclose near (3' err.txt || fail 'no word of the hollow'
grep -q '"hollow_at"' notch.json || fail 'no word of the hollow in the report'
expect 1 'every triangle is judged as it is.*bodies that share a wall' "$V" mesh --outer notch.off notch.off --prepare
expect 3 'bodies that share a wall' "$BIN/bmesh-decimate" notch.off -o n.off --vertices 8 --prepare strict

# Sheets that were dropped are in no body; the note says what judges that.
"$BIN/bcd-decompose" sheeted.off -o sheeted.glb --epsilon 1% --drop-sheets --no-cache --quiet || fail 'decompose sheeted'
expect 1 'prepare judges that: with --drop-sheets' "$V" cover sheeted.off sheeted.glb --epsilon 1%
[ "$(grep 'prepare judges' err.txt | tr ';' '\n' | sed 's/.*judges that: //' | sort | uniq -d | wc -l)" = 0 ] ||
  fail 'a note twice'
shows 0 'distance from the union to the solid: verified' "$V" cover sheeted.off sheeted.glb --epsilon 1% --prepare --drop-sheets

# Lengths whose squares exceed all doubles.
cube 0 1e300 >vast.off
cube 0 1.001e300 >vaster.off
shows 0 'verified: nowhere more than 1.73205e+298' "$V" mesh --outer vast.off vaster.off --epsilon 1%
shows 1 'refuted: a point is farther away' "$V" mesh --outer vast.off vaster.off --epsilon 0.01%
shows 1 'distance from the union to the solid: refuted' "$V" cover vast.off vaster.off --epsilon 0.01%
cube -1.7e308 1.7e308 >beyond.off
expect 3 'give --epsilon as a length' "$V" mesh --outer beyond.off beyond.off --epsilon 1%

# Results of bmesh-decimate; a pipe; the report.
"$D" "$BRACKET" -o outer.ply --ratio 0.1 --quiet || fail 'decimate'
"$D" "$BRACKET" -o inner.ply --ratio 0.1 --direction inner --quiet || fail 'decimate'
expect 0 '' "$V" mesh --outer "$BRACKET" outer.ply
expect 0 '' "$V" mesh --inner "$BRACKET" inner.ply
expect 1 '' "$V" mesh --outer "$BRACKET" inner.ply
expect 1 '' "$V" mesh --inner "$BRACKET" outer.ply
"$V" mesh --outer "$BRACKET" - --approximation-format ply <outer.ply >out.txt 2>err.txt || fail "pipe: $(cat err.txt)"
grep -q '^verified$' out.txt || fail 'no verdict from the pipe'
"$V" mesh --inner - inner.ply --input-format obj <"$BRACKET" >out.txt 2>err.txt || fail "pipe: $(cat err.txt)"
"$V" mesh --outer "$BRACKET" outer.ply --quiet >out.txt 2>err.txt || fail 'quiet run'
if [ -s out.txt ] || [ -s err.txt ]; then fail '--quiet is not quiet'; fi
expect 1 '' "$V" mesh --outer outer.ply "$BRACKET" --report r.json --witness w.ply
for field in tool version relation verdict deciding_claims original approximation sha256 triangles \
  closed unbalanced_edges bbox_diagonal claims solid surface relative answer reason witness point \
  depth exact inner_triangles outer_triangles triangles_without_area contacts samples resources; do
  grep -q "\"$field\"" r.json || fail "no $field in the report"
done
grep -q '"verdict": "refuted"' r.json || fail 'verdict in the report'
grep -q "\"sha256\": \"$(sha256sum "$BRACKET" | cut -d' ' -f1)\"" r.json || fail 'hash in the report'

grep -q '"limited": false' r.json || fail 'a limit in the report'

# What a limit leaves open is counted.
tetrahedra() {
  awk -v n=60 -v x="$1" 'BEGIN { print "OFF"; print 4*n, 4*n, 0
    for (i = 0; i < 12*n; ++i) { x = (x * 16807) % 2147483647; printf "%.9g%s", x / 2147483647, i % 3 == 2 ? "\n" : " " }
    for (a = 0; a < 4*n; a += 4) { print 3, a, a+2, a+1; print 3, a, a+1, a+3; print 3, a, a+3, a+2; print 3, a+1, a+2, a+3 } }'
}
tetrahedra 7 >these.off
tetrahedra 99 >those.off
expect 1 'triangles were not decided: --max-work allows more' "$V" mesh --outer these.off those.off --max-work 1 --report limited.json
grep -q '"limited": true' limited.json || fail 'no limit in the report'
grep -q '"triangles_left_out": [1-9]' limited.json || fail 'no triangles left out in the report'

# Same report on any number of threads, yes or no.
for n in 1 2 5; do
  "$V" mesh --outer "$BRACKET" outer.ply --epsilon 5% --report "yes$n.json" --threads $n >"yes$n.txt" || fail 'run'
  "$V" mesh --inner "$BRACKET" outer.ply --witness "w$n.ply" --report "no$n.json" --threads $n >"no$n.txt"
  [ $? = 1 ] || fail 'run'
  for f in yes no; do sed -i '/"resources"/,/}/d' "$f$n.json"; done
done
for n in 2 5; do
  for f in yes no; do
    cmp -s ${f}1.json $f$n.json || fail "$f: report differs on $n threads: $(diff ${f}1.json $f$n.json | head -5)"
    cmp -s ${f}1.txt $f$n.txt || fail "$f: output differs on $n threads"
  done
  cmp -s w1.ply w$n.ply || fail "witness differs on $n threads"
done
finish
