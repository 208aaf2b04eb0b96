. "$(dirname "$0")/common.sh"
H=$BIN/hausdorff-eval
D=$BIN/bmesh-decimate

shows 0 'certified' "$H" --help
expect 0 '' "$H" --version
"$D" "$BRACKET" -o b.ply --ratio 0.1 --quiet || fail "decimate"
shows 0 'Hausdorff distance' "$H" "$BRACKET" b.ply --report r.json --csv c.csv --heatmap h.png
for key in '"a_to_b"' '"b_to_a"' '"min"' '"mean"' '"rms"' '"max_lower"' '"max_upper"' '"max_at"' \
  '"mean_standard_error"' '"hausdorff_lower"' '"hausdorff_upper"' '"bbox_diagonal"' '"queries"' \
  '"resources"' '"measure": "surface to surface"'; do
  grep -q "$key" r.json || fail "no $key in the report"
done
[ "$(wc -l <c.csv)" = 3 ] || fail "CSV: $(cat c.csv)"
[ "$(head -c 4 h.png | tail -c 3)" = PNG ] || fail "no PNG"
expect 0 '' "$H" "$BRACKET" b.ply --heatmap h.ply --quiet
[ ! -s out.txt ] || fail "--quiet is not quiet"
expect 0 '' "$H" h.ply "$BRACKET" --csv again.csv
awk -F, 'NR>1 { bad = bad || $9 > 1e-8 } END { exit bad }' again.csv || fail "heatmap: $(cat again.csv)"

# Known distances: a tetrahedron moved by 3 along x, and the same file twice.
tetrahedron >t.off
awk 'NR>2 && NR<7 {print $1+3, $2, $3; next} {print}' t.off >moved.off
expect 0 '' "$H" t.off moved.off --csv k.csv
awk -F, 'NR>1 { bad = bad || !($2 <= 2 && $3 >= 2 && $3 < 2.0001 && $8 <= 3 && $9 >= 3 && $9 <= 3.0031) }
  END { exit bad }' k.csv || fail "moved tetrahedron: $(cat k.csv)"
expect 0 '' "$H" t.off t.off --csv k.csv
awk -F, 'NR>1 { bad = bad || $3 != 0 || $9 > 2e-9 } END { exit bad }' k.csv || fail "same: $(cat k.csv)"

# Far from the origin nothing changes where a common shift is exact.
awk 'NR>2 && NR<7 {printf "%.17g %.17g %.17g\n", $1+1e9+1/512, $2-2e9, $3+3e9; next} {print}' t.off >far.off
expect 0 '' "$H" far.off far.off --csv k.csv --report far.json
awk -F, 'NR>1 { bad = bad || $8 != 0 || $9 > 2e-9 || $4 > 1e-12 } END { exit bad }' k.csv || fail "far: $(cat k.csv)"
grep -q 'mean_and_rms_rounding' far.json || fail "no rounding of mean and rms"
grep -A1 '"max_at"' far.json | grep -q '100000000' || fail "max_at is not in the file's coordinates"

# Gap, backends, bounds.
expect 0 '' "$H" "$BRACKET" b.ply --gap 1e-6 --csv fine.csv
awk -F, 'NR>1 { bad = bad || $9 > $8 * (1 + 1.1e-6) } END { exit bad }' fine.csv || fail "gap: $(cat fine.csv)"
expect 0 '' "$H" "$BRACKET" b.ply --backend own --csv own.csv
paste -d, c.csv own.csv | awk -F, 'NR>1 { bad = bad || $8 > $19 || $18 > $9 } END { exit bad }' ||
  fail "backends disagree: $(cat c.csv own.csv)"
expect 0 '' "$H" "$BRACKET" b.ply --at-most 10%
expect 1 'exceeds' "$H" "$BRACKET" b.ply --at-most 1e-7

# Same bytes on any number of threads; timings apart.
for n in 1 2 5; do
  "$H" "$BRACKET" b.ply --report t$n.json --heatmap t$n.ply --threads $n >t$n.txt || fail "run"
  sed -e '/"resources"/,/}/d' t$n.json >s$n.json
done
for n in 2 5; do
  cmp -s s1.json s$n.json || fail "report differs on $n threads"
  cmp -s t1.txt t$n.txt || fail "table differs on $n threads"
  cmp -s t1.ply t$n.ply || fail "heatmap differs on $n threads"
done

# Pipes.
"$H" - b.ply --input-format obj --csv - <"$BRACKET" >pipe.csv || fail "pipe"
cmp -s pipe.csv c.csv || fail "a pipe gives another result"
expect 2 'input-format' "$H" - b.ply
expect 2 'both' "$H" - -
shows 0 '"tool"' "$H" t.off moved.off --report -

# A union of bodies: two boxes that overlap, as one OBJ; inner faces do not count.
cube() { # name offset first-index
  echo "o $1"
  for z in 0 1; do for y in 0 1; do for x in 0 1; do echo "v $x.$2 $y $z"; done; done; done
  for f in '1 3 4 2' '5 6 8 7' '1 2 6 5' '3 7 8 4' '1 5 7 3' '2 4 8 6'; do
    echo "$f" | awk -v s="$3" '{ print "f", $1+s, $2+s, $3+s, $4+s }'
  done
}
{ cube one 0 0; cube two 5 8; } >two.obj
awk 'BEGIN { print "o box"; for (z = 0; z < 2; z++) for (y = 0; y < 2; y++) for (x = 0; x < 2; x++) print "v", 1.5*x, y, z
  n = split("1 3 4 2,5 6 8 7,1 2 6 5,3 7 8 4,1 5 7 3,2 4 8 6", f, ","); for (i = 1; i <= n; i++) print "f", f[i] }' >one.obj
expect 0 '' "$H" two.obj one.obj --report u.json --csv u.csv
grep -q 'boundary of the union' u.json || fail "not taken as a set"
awk -F, 'NR>1 { bad = bad || $9 > 3e-9 } END { exit bad }' u.csv || fail "union: $(cat u.csv)"
expect 0 '' "$H" two.obj one.obj --a-as mesh --csv m.csv
awk -F, 'NR==2 { bad = !($8 > 0.49 && $9 < 0.51) } END { exit bad }' m.csv || fail "as mesh: $(cat m.csv)"
expect 3 'not convex' "$H" "$BRACKET" one.obj --a-as set

# Solid to solid: a cavity that A fills, an inner fold that does not count.
block() { # low high first-index inwards
  for z in $1 $2; do for y in $1 $2; do for x in $1 $2; do echo "v $x $y $z"; done; done; done
  for f in '1 3 4 2' '5 6 8 7' '1 2 6 5' '3 7 8 4' '1 5 7 3' '2 4 8 6'; do
    echo "$f" | awk -v s="$3" -v turn="$4" '{ if (turn > 0) print "f", $4+s, $3+s, $2+s, $1+s; else print "f", $1+s, $2+s, $3+s, $4+s }'
  done
}
block 0 1 0 0 >full.obj
{ block 0 1 0 0; block 0.25 0.75 8 1; } >hollow.obj
{ block 0 1 0 0; block 0.25 0.75 8 0; } >folded.obj
shows 0 'solid to solid' "$H" --solid full.obj hollow.obj --csv solid.csv --report solid.json --samples 1e3
awk -F, 'NR==2 { bad = !($8 > 0.2499 && $8 <= 0.25 && $9 >= 0.25 && $9 < 0.2503) }
  NR==3 { bad = bad || $9 > 2e-9 } END { exit bad }' solid.csv || fail "cavity: $(cat solid.csv)"
grep -q '"measure": "solid to solid"' solid.json || fail "the report does not say what was measured"
# What bounds nothing is not measured, and that is said.
printf 'OFF\n7 5 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n9 0 0\n8 0 0\n7 0 0\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n3 4 5 6\n' >spur.off
printf '3 6 5 4\n' | cat spur.off - | sed '2s/5/6/' >spurs.off
expect 0 'spurs.off: 2 triangles without area bound nothing: with --solid' "$H" --solid spurs.off spurs.off --samples 1e3
# A solid within the other one is at distance 0 exactly, and nothing is searched.
sed -n '/"b_to_a"/,/"cells"/p' solid.json >within.txt
grep -q '"max_upper": 0.0,' within.txt || fail "no distance 0 of what lies within: $(cat within.txt)"
grep -q '"cells": 0$' within.txt || fail 'space was searched for a solid within the other one'
grep -q '"max_inside": true' solid.json || fail "the largest distance is not inside"
expect 0 '' "$H" --solid full.obj folded.obj --b-as mesh --csv solid.csv
awk -F, 'NR>1 { bad = bad || $9 > 2e-9 } END { exit bad }' solid.csv || fail "fold: $(cat solid.csv)"
expect 0 '' "$H" full.obj folded.obj --b-as mesh --csv solid.csv
awk -F, 'NR==3 { bad = !($9 > 0.249) } END { exit bad }' solid.csv || fail "surface: $(cat solid.csv)"
for n in 1 4; do
  "$H" --solid full.obj hollow.obj --threads $n --report solid$n.json --quiet || fail "run"
  sed -e '/"resources"/,/}/d' solid$n.json >s$n.json
done
cmp -s s1.json s4.json || fail "the solids' report differs on 4 threads"
# A triangle with a repeated corner that is no edge of another one is a segment, and counts as one.
{ cat full.obj; printf 'v 50 0 0\nv 90 0 0\nf -1 -2 -1\n'; } >segment.obj
expect 0 'segment.obj: 1 triangle with equal corners is a segment or point that no other triangle has; it counts as such' "$H" full.obj segment.obj --b-as mesh
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >open.off
expect 3 'open.off: no closed chain' "$H" --solid full.obj open.off
block 0 1 0 1 >inverted.obj
expect 3 'solid is empty' "$H" --solid inverted.obj full.obj
# Several bodies, one of which is not convex, are a mesh, and that is said.
{ cube one 0 0; echo 'o two'; block 0 1 8 1; } >crooked.obj
expect 0 '' "$H" crooked.obj full.obj --report crooked.json
grep -q "not exactly convex" crooked.json || fail "a set taken as a mesh without a note"
grep -q "not exactly convex" err.txt || fail "no note on stderr"

# Usage and bad input.
expect 2 '' "$H"
expect 2 '' "$H" t.off
expect 2 'from 1e-09 to 1' "$H" t.off t.off --gap 0
expect 2 '' "$H" t.off t.off --samples 1
expect 2 '' "$H" t.off t.off --samples 1e5.5
expect 2 '' "$H" t.off t.off --backend best
expect 2 '' "$H" t.off t.off --nonsense
expect 2 'png, .html or .ply' "$H" t.off t.off --heatmap x.jpg
expect 2 'cannot both' "$H" t.off t.off --report x --csv x
expect 2 'overwrite' "$H" t.off moved.off --csv moved.off
expect 3 '' "$H" missing.off t.off
: >empty.off
expect 3 '' "$H" t.off empty.off
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\nnan 1 0\n3 0 1 2\n' >nan.off
expect 3 'finite' "$H" t.off nan.off
awk 'NR>2 && NR<7 {printf "%.17g %.17g %.17g\n", $1*1e80, $2*1e80, $3*1e80; next} {print}' t.off >vast.off
expect 3 'scale' "$H" vast.off t.off
awk 'NR>2 && NR<7 {printf "%.17g %.17g %.17g\n", $1*1e-307, $2*1e-307, $3*1e-307; next} {print}' t.off >minute.off
expect 3 'scale' "$H" minute.off minute.off
expect 0 '' "$H" t.off open.off
expect 4 '' "$H" t.off t.off --report /nonexistent/dir/r.json
finish
