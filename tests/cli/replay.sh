. "$(dirname "$0")/common.sh"
D=$BIN/bmesh-decimate
R=$BIN/bmesh-replay

"$D" "$BRACKET" -o outer.stl --ratio 0.1 --cost planes --effort fast --log outer.log --quiet || fail "decimation"
"$D" "$BRACKET" -o inner.ply --ratio 0.1 --cost planes --effort fast --log inner.log --quiet --direction inner || fail "decimation"
shows 0 'solid of the result contains that of the original' "$R" "$BRACKET" outer.log outer.stl --report r.json
grep -q '"verified": true' r.json || fail "report"
shows 0 'solid of the original contains' "$R" "$BRACKET" inner.log inner.ply
shows 1 'refuted' "$R" "$BRACKET" outer.log inner.ply
shows 1 'refuted' "$R" "$BRACKET" inner.log outer.stl
# Steps against the original.
"$D" "$BRACKET" -o tight.stl --ratio 0.1 --log tight.log --quiet || fail "decimation"
shows 0 'contains that of the original' "$R" "$BRACKET" tight.log tight.stl
shows 1 'refuted' "$R" "$BRACKET" tight.log outer.stl

# Progressive files: all levels at once.
V=$BIN/bound-verify
"$D" "$BRACKET" -o 'p-{vertices}.stl' --vertices 900,500 --progressive p.pm --quiet || fail "decimation"
shows 0 'contains that of the level before' "$V" progressive "$BRACKET" p.pm --report p.json
grep -q '"relation": "progressive"' p.json || fail "report"
"$D" "$BRACKET" --direction inner --vertices 900,500 --effort fast --progressive i.pm --quiet || fail "decimation"
shows 0 'contained in that of the level before' "$V" progressive "$BRACKET" i.pm
expect 2 'unknown option --epsilon' "$V" progressive "$BRACKET" p.pm --epsilon 1%
expect 3 'not a progressive file' "$V" progressive "$BRACKET" outer.log
# Damaged files are refused by all that read them; that what is wrong in an undamaged one is refuted,
# the tests of the library see.
size=$(wc -c <p.pm)
for at in 27 $((size / 2)) $((size - 16)) $((size - 1)); do
  cp p.pm mutant.pm
  byte=$(od -An -tu1 -j "$at" -N 1 p.pm | tr -d ' ')
  # shellcheck disable=SC2059
  printf "$(printf '\\%03o' $((byte ^ 1)))" | dd of=mutant.pm bs=1 seek="$at" conv=notrunc 2>/dev/null
  expect 3 'mutant.pm is damaged' "$V" progressive "$BRACKET" mutant.pm
  expect 3 'mutant.pm is damaged' "$D" --from mutant.pm --vertices 900 -o x.stl
  [ ! -e x.stl ] || fail "a mesh from a damaged file"
done

# Another original, a damaged log, missing files.
tetrahedron >t.off
expect 3 'another file' "$R" t.off outer.log outer.stl
expect 3 'from another one' "$V" progressive t.off p.pm
head -c 1000 outer.log >short.log
expect 3 'truncated' "$R" "$BRACKET" short.log outer.stl
printf 'not a log' >no.log
expect 3 'not a log' "$R" "$BRACKET" no.log outer.stl
expect 3 '' "$R" "$BRACKET" missing.log outer.stl
expect 3 '' "$R" missing.ply outer.log outer.stl
expect 2 '' "$R" "$BRACKET" outer.log

# Triangles turned by the log are named in the verdict.
tetrahedron | sed 's/^3 \([0-9]\) \([0-9]\) \([0-9]\)/3 \1 \3 \2/' >inverted.off
"$D" inverted.off -o upright.off --vertices 4 --log i.log --quiet || fail "inverted"
shows 0 'is not checked' "$R" inverted.off i.log upright.off

# Mutants of positions. One flipped bit of an exponent in the last step is refuted or refused. A step
# before it may go another way and leave a proof that still holds, but not every way.
size=$(wc -c <outer.log)
step=33 # bytes: a kind, two indices, three doubles

# mutant OFFSET BYTES: sets `code` to the verdict when BYTES (for printf) stand OFFSET bytes before the end.
mutant() {
  cp outer.log mutant.log
  # shellcheck disable=SC2059
  printf "$2" | dd of=mutant.log bs=1 seek=$((size - $1)) conv=notrunc 2>/dev/null
  cmp -s outer.log mutant.log && fail "no mutation"
  "$R" "$BRACKET" mutant.log outer.stl >/dev/null 2>&1
  code=$?
}

for offset in 1 9 17; do
  byte=$(od -An -tu1 -j $((size - offset)) -N 1 outer.log | tr -d ' ')
  mutant $offset "$(printf '\\%03o' $((byte ^ 4)))"
  [ $code = 1 ] || [ $code = 3 ] || fail "mutant at $offset bytes from the end: exit $code"
done
for before in 60 606; do
  refuted=0
  for axis in 2 10 18; do
    for huge in '\340\177' '\340\377'; do
      mutant $((before * step + axis)) "$huge"
      [ $code = 0 ] || [ $code = 1 ] || fail "mutant $before steps before the last: exit $code"
      refuted=$((refuted + code))
    done
  done
  [ $refuted -ge 2 ] || fail "$refuted of 6 mutants refuted $before steps before the last"
done
finish
