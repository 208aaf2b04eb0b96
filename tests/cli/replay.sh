. "$(dirname "$0")/common.sh"
D=$BIN/bmesh-decimate
R=$BIN/bmesh-replay

"$D" "$BRACKET" -o outer.stl --ratio 0.1 --log outer.log --quiet || fail "decimation"
"$D" "$BRACKET" -o inner.ply --ratio 0.1 --log inner.log --quiet --direction inner || fail "decimation"
expect 0 'solid of the result contains that of the original' "$R" "$BRACKET" outer.log outer.stl --report r.json
grep -q '"verified": true' r.json || fail "report"
expect 0 'solid of the original contains' "$R" "$BRACKET" inner.log inner.ply
expect 1 'refuted' "$R" "$BRACKET" outer.log inner.ply
expect 1 'refuted' "$R" "$BRACKET" inner.log outer.stl
# Steps against the original.
"$D" "$BRACKET" -o tight.stl --ratio 0.1 --cost distance --effort normal --log tight.log --quiet || fail "decimation"
expect 0 'contains that of the original' "$R" "$BRACKET" tight.log tight.stl
expect 1 'refuted' "$R" "$BRACKET" tight.log outer.stl

# Another original, a damaged log, missing files.
tetrahedron >t.off
expect 3 'another file' "$R" t.off outer.log outer.stl
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
expect 0 'is not checked' "$R" inverted.off i.log upright.off

# One flipped bit in the last step's position: refuted (or, in an unused bit of the header, refused).
size=$(wc -c <outer.log)
for offset in 1 9 17 2001 20003; do
  at=$((size - offset))
  cp outer.log mutant.log
  byte=$(od -An -tu1 -j "$at" -N 1 outer.log | tr -d ' ')
  printf "$(printf '\\%03o' $((byte ^ 4)))" | dd of=mutant.log bs=1 seek="$at" conv=notrunc 2>/dev/null
  cmp -s outer.log mutant.log && fail "no mutation"
  "$R" "$BRACKET" mutant.log outer.stl >/dev/null 2>&1
  code=$?
  [ $code = 1 ] || [ $code = 3 ] || fail "mutant at $offset bytes from the end: exit $code"
done
finish
