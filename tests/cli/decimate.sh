. "$(dirname "$0")/common.sh"
D=$BIN/bmesh-decimate

shows 0 'Simplifies' "$D" --help
expect 0 '' "$D" --version
expect 0 'certified' "$D" "$BRACKET" -o a.stl --ratio 0.2 --report a.json --log a.log --depfile a.d
for key in '"sha256"' '"contractions"' '"exact_fallbacks"' '"max_upper"' '"peak_megabytes"' '"stop": "vertices"' \
  '"closed": true' '"version"'; do
  grep -q "$key" a.json || fail "no $key in the report"
done
grep -q "^a.stl: .*bracket" a.d || fail "dependency file: $(cat a.d)"
# It lists what the input refers to, each file once; make takes its names as they are.
inlined >'part $1 #a.wrl'
printf '#VRML V2.0 utf8\nInline { url "part $1 #a.wrl" }\nTransform { translation 5 0 0 children Inline { url "part $1 #a.wrl" } }\n' >whole.wrl
expect 0 '' "$D" whole.wrl -o whole.stl --vertices 8 --depfile whole.d --quiet
[ "$(cat whole.d)" = 'whole.stl: whole.wrl ./part\ $$1\ \#a.wrl' ] || fail "dependency file: $(cat whole.d)"
tetrahedron_gltf
expect 0 '' "$D" t.gltf -o g.stl --vertices 4 --depfile g.d --quiet
[ "$(cat g.d)" = 'g.stl: t.gltf ./my\ buf.bin' ] || fail "dependency file: $(cat g.d)"
expect 0 '' "$D" "$BRACKET" -o in.obj --direction inner --vertices 500 --effort fast --quiet
[ ! -s err.txt ] || fail "--quiet is not quiet: $(cat err.txt)"
[ "$(grep -c '^v ' in.obj)" = 500 ] || fail "inner: $(grep -c '^v ' in.obj) vertices instead of 500"
expect 0 'within' "$D" "$BRACKET" -o eps.ply --epsilon 0.5%
expect 0 '' "$D" "$BRACKET" -o any.off --direction any --ratio 0.5 --effort fast
for cost in planes planes-adapted planes-diagonal triangles mean; do
  expect 0 'certified' "$D" "$BRACKET" -o c.glb --ratio 0.3 --cost $cost --effort fast
done
expect 0 'certified' "$D" "$BRACKET" -o c.glb --ratio 0.1 --effort fast
expect 0 'certified' "$D" "$BRACKET" -o c.glb --ratio 0.1 --cost planes --report n.json
grep -q '"cost": "planes"' n.json && grep -q '"effort": "normal"' n.json || fail "no cost and effort in the report"
expect 0 '' "$D" "$BRACKET" -o default.ply --ratio 0.1 --log default.log --quiet
expect 0 '' "$D" "$BRACKET" -o named.ply --ratio 0.1 --log named.log --quiet --cost distance --effort normal
cmp -s default.ply named.ply && cmp -s default.log named.log || fail "distance and normal are not the defaults"
for format in stl stl-ascii obj ply ply-ascii off glb; do
  expect 0 '' "$D" "$BRACKET" -o "f.$format" --output-format $format --ratio 0.5 --effort fast --quiet
done

# Stopping at epsilon before the wished count is success.
expect 0 '' "$D" "$BRACKET" -o e.ply --vertices 4 --epsilon 0.1% --cost planes --effort fast --report e.json
grep -q '"stop": "epsilon"' e.json || fail "epsilon did not stop"

# A count that cannot be reached: best result, exit code 1.
tetrahedron >t.off
expect 0 '' "$D" t.off -o t4.off --vertices 4
expect 2 'cannot be joined' "$D" t.off -o x.off --vertices 4 --sharp-angle 60
expect 2 'cannot be joined' "$D" t.off -o x.off --vertices 4 --cost planes --as-printed
absent x.off
# Open meshes are decimated without global optimisation, and the report says so.
sed 's/^4 4 0/4 3 0/;$d' t.off >open.off
expect 1 '' "$D" open.off -o open-out.off --vertices 4 --effort normal --holes keep --report open.json
grep -q '"effort": "fast"' open.json || fail "the report tells of an effort that was not made"
sed 's/^4 4 0/8 8 0/' t.off | awk '{print} NR==6{print "5 0 0\n6 0 0\n5 1 0\n5 0 1"} END{print "3 4 6 5\n3 4 5 7\n3 5 6 7\n3 6 4 7"}' >two.off
expect 1 'cannot be reached' "$D" two.off -o two-out.off --vertices 4
[ -s two-out.off ] || fail "the best result was not written"

# So it is in every mode: the reason is given, the result is written, and it is what it claims to be.
for direction in outer inner; do
  for method in 'planes fast' 'planes-adapted fast' 'planes-diagonal fast' 'triangles fast' 'distance fast' \
    'planes normal' 'distance normal' 'distance best' \
    'mean fast' 'mean normal'; do
    rm -f two-out.off
    # shellcheck disable=SC2086
    expect 1 'cannot be reached with --cost [a-z-]*: no further contraction is possible at 8' "$D" two.off -o two-out.off --vertices 6 \
      --direction $direction --cost ${method% *} --effort ${method#* }
    expect 0 '' "$BIN/bound-verify" mesh --$direction two.off two-out.off --quiet
  done
done
expect 1 'cannot be reached' "$D" two.off -o two-out.off --ratio 0.5
expect 1 'cannot be reached' "$D" two.off -o two-out.off --vertices 4 --precision double
expect 1 'cannot be reached' "$D" two.off -o two-out.off --vertices 4 --epsilon 100
expect 1 'cannot be reached' "$D" two.off -o - --output-format off --vertices 4

# What becomes of too few vertices is said without being measured.
expect 1 '% of the diagonal away from the result; use more' "$D" "$BRACKET" -o warned.ply --vertices 8 --cost planes --effort fast
expect 0 '' "$D" "$BRACKET" -o warned.ply --vertices 1000 --effort fast
grep -q warning err.txt && fail "a warning of what is near"

# One number of vertices of a small mesh is reached twice, the second time nearer; a series is not.
expect 0 '' "$D" "$BRACKET" -o small.ply --vertices 1000 --effort fast --quiet
expect 7 'the work allowed has ended' "$D" small.ply -o work.ply --ratio 0.1 --max-work 0.001 --report work.json
grep -q '"out_of_work": true' work.json && grep -q '"stop": "out of work"' work.json || fail "report of a limit"
expect 0 '' "$BIN/bound-verify" mesh --outer small.ply work.ply --quiet
expect 2 '' "$D" small.ply -o x.ply --ratio 0.1 --max-work 0
farthest() { "$BIN/hausdorff-eval" small.ply "$1" | sed -n 's/^max .*, \([0-9.e+-]*\)\]$/\1/p'; }
for n in 120 150 200; do  # mostly: not at each number
  expect 0 '' "$D" small.ply -o twice-$n.ply --vertices $n --quiet
  expect 0 '' "$D" small.ply -o 'once-{vertices}.ply' --vertices $n,$((n - 1)) --quiet
  echo "$(farthest twice-$n.ply) $(farthest once-$n.ply)"
done >twice.txt
awk '{ twice += $1; once += $2 } END { exit !(NR == 3 && twice > 0 && twice < 0.95 * once) }' twice.txt ||
  fail "not nearer the second time: $(cat twice.txt)"

# A series: nested, one file per level, the same from the progressive file.
expect 0 'certified' "$D" "$BRACKET" --vertices 300,900,500 -o 's-{vertices}.ply' --progressive s.pm --report s.json \
  --depfile s.d --verify
for n in 900 500 300; do
  [ "$(grep -ac "^element vertex $n\$" s-$n.ply)" = 1 ] || fail "s-$n.ply has not $n vertices"
  grep -q "\"file\": \"s-$n.ply\"" s.json || fail "no s-$n.ply in the report"
done
[ "$(grep -c '"nested": "verified"' s.json)" = 2 ] || fail "nesting is not verified twice"
[ "$(grep -c '"stop": "vertices"' s.json)" = 3 ] || fail "not every level is reported"
grep -q '^s-900.ply s-500.ply s-300.ply s.pm: ' s.d || fail "dependency file: $(cat s.d)"
expect 0 'a level' "$D" --from s.pm --vertices 900,300,500 -o 't-{vertices}.ply' --report t.json
for n in 900 500 300; do cmp -s s-$n.ply t-$n.ply || fail "t-$n.ply is not s-$n.ply"; done
expect 0 'between levels' "$D" --from s.pm --vertices 700 -o t.stl
expect 1 'cannot be reached' "$D" --from s.pm --vertices 100 -o t-100.ply
expect 1 'a level' "$D" --from s.pm --vertices 100 -o t-100.ply
cmp -s t-100.ply s-300.ply || fail "the coarsest mesh was not written"
expect 0 '' "$D" "$BRACKET" --vertices 500 --effort fast --progressive only.pm --quiet
expect 0 '' "$D" "$BRACKET" --epsilon 0.5% --effort fast --progressive epsilon.pm -o epsilon.ply --quiet
n=$(sed -n 's/^element vertex //p;/^end_header/q' epsilon.ply)
expect 0 'a level' "$D" --from epsilon.pm --vertices "$n" -o e2.ply
cmp -s epsilon.ply e2.ply || fail "the level within epsilon is another one"
expect 1 'cannot be reached' "$D" two.off --vertices 7,6,4 -o 'two-{vertices}.off'
for n in 7 6 4; do [ -s two-$n.off ] || fail "two-$n.off was not written"; done
expect 0 'epsilon allows no fewer' "$D" "$BRACKET" --vertices 2000,10,5 --epsilon 0.5% --effort fast -o 'b-{vertices}.ply'
cmp -s b-10.ply b-5.ply || fail "levels beyond epsilon differ"
expect 2 'need {vertices}' "$D" "$BRACKET" --vertices 300,200 -o x.ply
expect 2 'need {vertices}' "$D" "$BRACKET" --vertices 300,200 -o - --output-format ply
expect 2 'needs --vertices' "$D" "$BRACKET" --ratio 0.5 -o 'x-{vertices}.ply'
expect 2 'joined with --ratio' "$D" "$BRACKET" --ratio 0.5 --vertices 300,200 -o 'x-{vertices}.ply'
expect 2 '--progressive holds' "$D" "$BRACKET" --vertices 300,200 -o 'x-{vertices}.ply' --log x.log
for bad in 300,300 300, ,300 300,3 300,x '300, 200' 99999999999999999999; do
  expect 2 'different ones separated by commas' "$D" "$BRACKET" --vertices "$bad" -o 'x-{vertices}.ply'
done
awk '/^v / { print $1, 1.1 * $2, 1.1 * $3, 1.1 * $4; next } { print }' "$BRACKET" >decimal.obj
expect 0 '' "$D" decimal.obj --vertices 900,800 --effort fast --cost planes --progressive decimal.pm --quiet
expect 1 'hold doubles; or take one of the levels 900, 800' "$D" --from decimal.pm --vertices 1500 -o x.stl
expect 0 'between levels' "$D" --from decimal.pm --vertices 1500 -o decimal.ply
expect 2 'INPUT, or --from' "$D" --vertices 300 -o x.ply
expect 2 'joined with --cost' "$D" --from s.pm --vertices 300 -o x.ply --cost planes
expect 2 'joined with INPUT' "$D" "$BRACKET" --from s.pm --vertices 300 -o x.ply
expect 2 'needs --vertices' "$D" --from s.pm -o x.ply
expect 2 'overwrite' "$D" epsilon.ply --vertices 100 -o ./epsilon.ply
expect 2 'overwrite' "$D" --from s.pm --vertices 300 -o s.pm --output-format ply
expect 3 'not a progressive file' "$D" --from s.json --vertices 300 -o x.ply
head -c 5000 s.pm >short.pm
expect 3 'truncated' "$D" --from short.pm --vertices 300 -o x.ply
absent x.ply x-300.ply x-200.ply x.log

# Convexity.
mkdir -p folder.stl
for folder in . folder.stl; do expect 3 'is a folder' "$D" "$folder" -o k.ply --ratio 0.5; done
expect 3 'not convex' "$D" "$BRACKET" -o k.ply --ratio 0.5 --keep-convex
expect 0 '' "$D" t.off -o k.ply --vertices 4 --keep-convex

# Precision: far from the origin float32 is too coarse.
awk 'NR>2 && NR<7 {printf "%.17g %.17g %.17g\n", $1+20000, $2, $3; next} {print}' t.off >far.off
expect 1 'float32' "$D" far.off -o far.stl --vertices 4
expect 1 '--precision double' "$D" far.off -o far.ply --vertices 4 --precision float
absent far.stl far.ply
expect 0 'writing double' "$D" far.off -o far.ply --vertices 4
expect 0 '' "$D" far.off -o far.off2 --output-format off --vertices 4 --precision double
expect 2 'float32 only' "$D" far.off -o far.stl --vertices 4 --precision double

# An epsilon as large as the part is mostly one in another unit.
expect 0 'WARNING: epsilon is 5, and the part is only' "$D" t.off -o large.off --epsilon 5
expect 0 'WARNING: epsilon' "$BIN/bcd-decompose" t.off -o large.glb --epsilon 95% --effort fast --no-cache
expect 0 'WARNING: epsilon' "$BIN/mesh-prepare" t.off -o large.off --prepare wrap --epsilon 50%
expect 0 '' "$D" t.off -o large.off --epsilon 45%
! grep -q WARNING err.txt || fail "a warning of 45 %"

# The border of an open mesh does not move.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0.1\nv 0 0 1\nf 1 3 2\nf 1 2 4\n' >open.obj
expect 1 'border stays where it is.*Write .ply, .obj, .off' "$D" open.obj -o x.stl --vertices 4 --holes keep
expect 1 'writing double' "$D" open.obj -o open.ply --vertices 4 --holes keep
grep -q 'it has no solid that the result could enclose' err.txt || fail 'no word that nothing is enclosed'
grep -q 'NOTHING IS ENCLOSED' err.txt || fail 'the summary does not say that nothing is enclosed'
expect 0 '' "$D" open.obj -o open.ply --vertices 4 --holes keep --direction any

# Without --holes keep, holes are filled, the steps are replayed, and the original is held.
expect 0 '1 hole is filled with 4 triangles, 1.7' "$D" open.obj -o filled.ply --vertices 4 --log filled.log \
  --report filled.json --verify
grep -q '"filled_triangles": 4' filled.json || fail 'no word of the filling in the report'
grep -q 'with 1 hole filled, its solid the one so closed' filled.json || fail 'the claim does not say of which solid it is'
shows 0 'its holes filled with 4 triangles that the log adds' "$BIN/bmesh-replay" open.obj filled.log filled.ply
shows 0 'surface claim: verified' "$BIN/bound-verify" mesh --outer open.obj filled.ply --prepare
expect 0 '' "$D" open.obj -o filled.ply --vertices 4 --progressive filled.pm
shows 0 'filled with 4 triangles that the file adds' "$BIN/bound-verify" progressive open.obj filled.pm
expect 0 '' "$D" --from filled.pm --vertices 4 -o again.ply
cmp -s filled.ply again.ply || fail 'a level of a mesh whose holes are filled is another one'
for kind in LOG PROGRESSIVE; do printf 'KABOUM-BMESH-%s 2\n0123456789' $kind >"old.$kind"; done
expect 3 'earlier version (2); make it again' "$BIN/bmesh-replay" open.obj old.LOG filled.ply
expect 3 'earlier version (2); make it again' "$D" --from old.PROGRESSIVE --vertices 4 -o x.off

# Sizes whose products would overflow or vanish.
awk 'NR>2 && NR<7 {printf "%.17g %.17g %.17g\n", $1*1e80, $2*1e80, $3*1e80; next} {print}' t.off >vast.off
expect 3 'scale the mesh' "$D" vast.off -o x.off --vertices 4
awk 'NR>2 && NR<7 {printf "%.17g %.17g %.17g\n", $1*1e-80, $2*1e-80, $3*1e-80; next} {print}' t.off >minute.off
expect 3 'scale the mesh' "$D" minute.off -o x.off --vertices 4

# Random triangles, which bound nothing: they are wrapped, or else what sticks out is said, as far as the work allowed goes.
awk 'BEGIN { n = 60; print "OFF"; print 3*n, n, 0; x = 7
  for (i = 0; i < 9*n; ++i) { x = (x * 16807) % 2147483647; printf "%.9g%s", x / 2147483647, i % 3 == 2 ? "\n" : " " }
  for (i = 0; i < n; ++i) print 3, 3*i, 3*i+1, 3*i+2 }' >soup.off
expect 1 '120 stick out.*--prepare wrap encloses every triangle' "$D" soup.off -o soup.ply --epsilon 2% --log soup.log
expect 1 'for the work allowed was done; allow more with --max-work' "$D" soup.off -o soup.ply --epsilon 2% --max-work 0.01 --report soup.json \
  --keep-orientation
grep -q '"surface_triangles_left_out"' soup.json || fail "no number of triangles left out"
expect 0 'the input is wrapped: some triangles of the input bound no solid' "$D" soup.off -o soup.ply --epsilon 10% --effort fast --report soup.json
grep -q '"why_wrapped": "some' soup.json || fail "no reason for the wrap: $(cat soup.json)"
shows 0 'verified' "$BIN/bound-verify" mesh --outer soup.off soup.ply --raw

# Usage.
expect 2 '' "$D"
expect 2 'at least one of' "$D" t.off -o x.off
expect 2 '' "$D" t.off -o x.off --vertices four
expect 2 '' "$D" t.off -o x.off --vertices 3
expect 2 '' "$D" t.off -o x.off --vertices -5
expect 2 '' "$D" t.off -o x.off --ratio 1.5
expect 2 '' "$D" t.off -o x.off --ratio 0
expect 2 '' "$D" t.off -o x.off --epsilon 0
expect 2 '' "$D" t.off -o x.off --epsilon -1%
expect 2 '' "$D" t.off -o x.off --epsilon nan
expect 2 '' "$D" t.off -o x.off --vertices 4 --direction sideways
expect 2 '' "$D" t.off -o x.off --vertices 4 --cost volume
expect 2 '' "$D" t.off -o x.off --vertices 4 --effort none
expect 2 '' "$D" t.off -o x.off --vertices 4 --nonsense
expect 2 'unknown' "$D" t.off -o x.xyz --vertices 4
expect 2 '' "$D" t.off -o x.off --vertices 4 --threads many
absent x.off

# Every file once.
expect 2 'cannot both be' "$D" t.off -o x.off --vertices 4 --log ./x.off
expect 2 'cannot both be' "$D" t.off -o x.off --vertices 4 --report x.off
expect 2 'overwrite' "$D" t.off -o t.off --vertices 4 --log l.log
expect 2 'cannot both be' "$D" t.off -o - --output-format off --vertices 4 --log -

# Output that cannot be written; nothing that belongs to it stays behind.
expect 4 '' "$D" t.off -o /nonexistent/dir/x.off --vertices 4 --log gone.log --report gone.json --depfile gone.d
absent gone.log gone.json gone.d
expect 4 '' "$D" t.off -o /nonexistent/dir/x.off --vertices 4
expect 4 '' "$D" t.off -o x.off --vertices 4 --report /nonexistent/dir/r.json
finish
