# shellcheck shell=sh disable=SC2154
. "$(dirname "$0")/common.sh"
D=$BIN/bcd-decompose
KABOUM_CACHE=$WORK/cache
export KABOUM_CACHE

shows 0 'Decomposes' "$D" --help
expect 0 'verified exactly' "$D" "$BRACKET" -o a.glb --epsilon 3% --effort fast --report a.json --preview a.png --depfile a.d
for key in '"stop": "done"' '"surface": "verified"' '"solid": "verified"' '"cached": false' '"upper"'; do
  grep -q "$key" a.json || fail "no $key in the report"
done
[ -s a.png ] || fail "no picture"
grep -q "^a.glb: .*bracket" a.d || fail "dependency file"
shows 0 'verified' "$BIN/bound-verify" cover "$BRACKET" a.glb

# The cache: same bytes; a damaged entry is rebuilt; --no-cache.
expect 0 'from the cache' "$D" "$BRACKET" -o b.glb --epsilon 3% --effort fast
cmp -s a.glb b.glb || fail "the cache gives other bytes"
for f in cache/*.set; do printf 'x' | dd of="$f" bs=1 seek=200 conv=notrunc 2>/dev/null; done
expect 0 '' "$D" "$BRACKET" -o c.glb --epsilon 3% --effort fast --report c.json
grep -q '"cached": false' c.json || fail "a damaged entry was used"
cmp -s a.glb c.glb || fail "rebuilding gives other bytes"
expect 0 '' "$D" "$BRACKET" -o d.glb --epsilon 3% --effort fast --no-cache --threads 1 --quiet
[ ! -s err.txt ] || fail "--quiet is not quiet"
cmp -s a.glb d.glb || fail "one thread gives other bytes"

# An entry under another one's name is found out, even if only its container is; so is a cut one.
mkdir swapped
expect 0 '' env KABOUM_CACHE=swapped "$D" "$BRACKET" -o e.glb --epsilon 3% --effort fast --quiet
mine=$(cd swapped && grep -l "^KABOUM-SET" -- *)
tetrahedron >other.off
expect 0 '' env KABOUM_CACHE=other "$D" other.off -o other.glb --epsilon 3% --effort fast
cp other/*.set "swapped/$mine"
expect 0 'another input or of other options; it is made again' env KABOUM_CACHE=swapped "$D" "$BRACKET" -o e.glb --epsilon 3% --effort fast
cmp -s a.glb e.glb || fail "an entry of another mesh was used"
expect 0 'from the cache' env KABOUM_CACHE=swapped "$D" "$BRACKET" -o e.glb --epsilon 3% --effort fast
cat other/*.set >forged.set
key=${mine%.set}
{ echo "$key"; tail -n +4 forged.set; } >rest
{ echo 'KABOUM-SET 3'; sha256sum rest | cut -d ' ' -f 1; cat rest; } >"swapped/$mine"
expect 0 'container is that of another input' env KABOUM_CACHE=swapped "$D" "$BRACKET" -o e.glb --epsilon 3% --effort fast
cmp -s a.glb e.glb || fail "a container of another mesh was used"
head -c 300 "swapped/$mine" >short && cp short "swapped/$mine"
expect 0 'damaged; it is made again' env KABOUM_CACHE=swapped "$D" "$BRACKET" -o e.glb --epsilon 3% --effort fast
: >"swapped/$mine"
expect 0 'damaged, or of another version' env KABOUM_CACHE=swapped "$D" "$BRACKET" -o e.glb --epsilon 3% --effort fast
# Files that refer to others: by what is read, not by their own bytes.
printf '#VRML V2.0 utf8\nInline { url "part.wrl" }\n' >whole.wrl
for size in 1 3 1; do
  inlined $size >part.wrl
  expect 0 '' "$D" whole.wrl -o "w$size.glb" --epsilon 3% --effort fast --report w.json --depfile w.d
  [ "$(cat w.d)" = "w$size.glb: whole.wrl ./part.wrl" ] || fail "dependency file: $(cat w.d)"
  shows 0 'verified' "$BIN/bound-verify" cover whole.wrl "w$size.glb"
done
grep -q '"cached": true' w.json || fail "a file that refers to another is not cached"

# Other formats, and a pipe.
expect 0 '' "$D" "$BRACKET" -o set.obj --epsilon 3% --effort fast
expect 0 '' "$D" "$BRACKET" -o folder --epsilon 3% --effort fast
shows 0 'verified' "$BIN/bound-verify" cover "$BRACKET" set.obj
shows 0 'verified' "$BIN/bound-verify" cover "$BRACKET" folder
"$D" - -o - --input-format obj --output-format obj --epsilon 3% --effort fast --quiet <"$BRACKET" >pipe.obj || fail "pipe"
[ "$(grep -c '^o ' pipe.obj)" = "$(grep -c '^o ' set.obj)" ] || fail "the pipe gives another number of bodies"

# Few bodies.
expect 0 '' "$D" "$BRACKET" -o two.obj --max-bodies 2 --effort fast
[ "$(grep -c '^o ' two.obj)" -le 2 ] || fail "more bodies than allowed"
expect 0 'verified exactly' "$D" "$BRACKET" -o pre.glb --epsilon 5% --effort fast --pre-step on --no-cache
shows 0 'verified' "$BIN/bound-verify" cover "$BRACKET" pre.glb --epsilon 5%
expect 0 '' "$D" "$BRACKET" -o lean.glb --max-bodies 4 --max-total-vertices 40 --effort fast --report lean.json
[ "$(sed -n 's/^ *"vertices": \([0-9]*\).*/\1/p' lean.json)" -le 40 ] || fail "more vertices than allowed"
expect 2 'outer' "$D" "$BRACKET" -o no.glb --max-total-vertices 40 --direction inner
expect 1 'limits' "$D" "$BRACKET" -o few.glb --max-bodies 2 --epsilon 2% --effort fast
[ -s few.glb ] || fail "the best result was not written"

# Other methods are benchmarks.
expect 2 '--method' "$D" "$BRACKET" -o x.glb --method voxels

# Thick bodies: within epsilon, or said not to be.
expect 0 'verified exactly' "$D" "$BRACKET" -o thick.glb --epsilon 5% --effort fast --min-thickness 0.005 --report thick.json
grep -q '"min_thickness"' thick.json || fail "no thickness in the report"
shows 0 'verified' "$BIN/bound-verify" cover "$BRACKET" thick.glb --epsilon 5%
expect 1 'min-thickness' "$D" "$BRACKET" -o thick.glb --epsilon 3% --effort fast --min-thickness 0.1
expect 2 'thicken' "$D" "$BRACKET" -o x.glb --direction inner --min-thickness 0.1
expect 2 'pre-step' "$D" "$BRACKET" -o x.glb --direction inner --pre-step on
expect 2 'min-thickness' "$D" "$BRACKET" -o x.glb --min-thickness nan
expect 2 'must be a positive number, perhaps with a unit' "$D" "$BRACKET" -o x.glb --min-thickness 1%%
# A length with its unit and a share of the diagonal are the same as the number; the record keeps what was stated.
expect 0 '' "$D" "$BRACKET" -o unit.glb --epsilon 5% --effort fast --min-thickness 5mm
expect 0 '' "$D" "$BRACKET" -o share.glb --epsilon 5% --effort fast --min-thickness 2% --report share.json
python3 - <<'END' || fail "thickness in other words"
import json
number, share = (json.load(open(name)) for name in ("thick.json", "share.json"))
assert number["min_thickness"]["wished"] == 0.005, number["min_thickness"]
assert abs(share["min_thickness"]["wished"] - 0.02 * share["diagonal"]) < 1e-12, share["min_thickness"]
assert "--min-thickness 2%" in share["parameters"]
END
expect 0 'verified exactly' "$D" "$BRACKET" -o aspect.glb --epsilon 5% --effort fast --max-aspect 30 --report aspect.json
grep -q '"max_aspect"' aspect.json || fail "no aspect in the report"
shows 0 'verified' "$BIN/bound-verify" cover "$BRACKET" aspect.glb --epsilon 5%
# What cannot be kept with both is said, and is no success.
printf 'OFF\n8 12 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 0.001\n1 0 0.001\n1 1 0.001\n0 1 0.001\n3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n' >sheet.off
expect 1 'epsilon could not be reached with --max-aspect' "$D" sheet.off -o sheet.glb --epsilon 1% --effort fast --max-aspect 5
expect 0 '' "$D" sheet.off -o sheet.glb --epsilon 20% --effort fast --max-aspect 5
expect 2 'max-aspect' "$D" "$BRACKET" -o x.glb --max-aspect 3
expect 2 'aspect' "$D" "$BRACKET" -o x.glb --max-aspect 10 --max-total-vertices 100
expect 2 'thicken' "$D" "$BRACKET" -o x.glb --direction inner --max-aspect 10
expect 2 'max-aspect' "$D" "$BRACKET" -o x.glb --bodies spheres --max-aspect 10
expect 2 'simplify' "$D" "$BRACKET" -o x.glb --simplify nan
expect 2 'simplify' "$D" "$BRACKET" -o x.glb --simplify 0.5 --direction inner
expect 2 'simplify' "$D" "$BRACKET" -o x.glb --simplify 0.2 --max-total-vertices 100
expect 2 '' "$D" "$BRACKET" -o x.glb --min-thickness -1

# Bodies inside.
expect 0 'inside verified exactly' "$D" "$BRACKET" -o inner.glb --direction inner --epsilon 2% --effort fast --report inner.json
grep -q '"inside": "verified"' inner.json || fail "no verdict in the report"
shows 1 'refuted' "$BIN/bound-verify" cover "$BRACKET" inner.glb

# Valid "no", usage, bad input, output that cannot be written.
tetrahedron >t.off
awk 'NR>2 && NR<7 {printf "%.17g %.17g %.17g\n", $1+200000, $2, $3; next} {print}' t.off >far.off
expect 1 'float32 numbers are .* apart' "$D" far.off -o far.glb
absent far.glb
expect 2 '' "$D" t.off
expect 2 '' "$D" t.off -o x.glb --epsilon -1
expect 2 '' "$D" t.off -o x.glb --max-bodies 0
expect 2 '' "$D" t.off -o x.glb --max-vertices-per-body 7
expect 2 '' "$D" t.off -o x.glb --direction sideways
expect 2 'extension' "$D" t.off -o x.step
expect 2 'output-format' "$D" t.off -o -
# Facets of bodies are counted from files alone, as the limit counts them.
V=$BIN/bound-verify
for limit in '' '--max-facets-per-body 9'; do
  # shellcheck disable=SC2086
  expect 0 '' "$D" "$BRACKET" -o facets.glb --epsilon 3% --effort fast $limit
  expect 0 '' "$V" cover "$BRACKET" facets.glb --epsilon 3% --prepare --report judged.json
  json judged.json "r['approximation']['bodies'] > 1 and 4 <= r['approximation']['most_vertices'] <= 64"
  # shellcheck disable=SC2015
  [ -n "$limit" ] && json judged.json "4 <= r['approximation']['most_facets'] <= 9" || json judged.json "r['approximation']['most_facets'] > 9"
done
echo "<robot name=\"r\"><link name=\"l\"><collision><geometry><mesh filename=\"$BRACKET\"/></geometry></collision></link></robot>" >facets.urdf
expect 0 '' "$D" facets.urdf -o facets --epsilon 3% --effort fast --max-facets-per-body 9
expect 0 '' "$V" robot facets.urdf facets/facets.urdf --prepare --report judged.json
json judged.json "(lambda held: len(held) > 1 and all(4 <= one['facets'] <= 9 <= one['vertices'] + 5 for one in held))(r['links'][0]['shapes'][0]['held_by'])"
expect 0 '' "$D" "$BRACKET" -o facets.glb --bodies capsules --epsilon 5% --effort fast
expect 0 '' "$V" cover "$BRACKET" facets.glb --prepare --report judged.json
json judged.json "r['approximation']['most_facets'] is None and r['approximation']['most_vertices'] == 2"

# What has no effect, or would be misread later, is refused at once.
expect 2 'ends with .png' "$D" t.off -o x.glb --preview x.jpg
expect 2 'unit' "$D" t.off -o x.glb --unit parsec
expect 2 'preview' "$D" t.off -o x.glb --explode 1
expect 2 'mesh-prefix is for robots' "$D" t.off -o x.glb --mesh-prefix package://r/
expect 2 'geometry is for robots' "$D" t.off -o x.glb --geometry visual
expect 2 'visual is for robots' "$D" t.off -o x.glb --visual
expect 2 'package-path is for robots' "$D" t.off -o x.glb --package-path .
mkdir foreign && echo note >foreign/note.txt
expect 4 'note.txt' "$D" none.off -o foreign  # before the input is looked at
echo 'OFF nonsense' >bad.off
expect 3 'bad.off' "$D" bad.off -o x.glb
expect 3 '' "$D" none.off -o x.glb
expect 4 '' "$D" t.off -o /nonexistent/dir/x.glb
absent x.glb
# A name that is not UTF-8.
odd=$(printf 'a\377')
cp t.off "$odd.off"
expect 0 '' "$D" "$odd.off" -o odd.glb --preview odd.html
iconv -f utf-8 -t utf-8 odd.html >/dev/null || fail "the page is not UTF-8"
finish
