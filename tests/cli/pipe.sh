. "$(dirname "$0")/common.sh"
D=$BIN/bmesh-decimate

"$D" "$BRACKET" -o file.off --vertices 300 --quiet
"$D" - --input-format obj -o - --output-format off --vertices 300 <"$BRACKET" >pipe.off 2>err.txt || fail "pipe"
cmp -s file.off pipe.off || fail "a pipe gives another result than files"
"$D" "$BRACKET" -o - --output-format ply --vertices 600 --quiet |
  "$D" - --input-format ply -o chained.off --vertices 300 --quiet || fail "chain"
[ -s chained.off ] || fail "chain wrote nothing"
expect 2 'output-format' "$D" "$BRACKET" -o - --vertices 300
expect 2 'input-format' "$D" - -o x.off --vertices 300
expect 2 'cannot both' "$D" "$BRACKET" -o - --output-format off --vertices 300 --report -
shows 0 '"tool"' "$D" "$BRACKET" -o y.off --vertices 300 --report -
finish
