# shellcheck shell=sh disable=SC2154
# kaboum-cache: lists, finds damage, makes room; a hit takes nothing anew.
HERE=$(cd "$(dirname "$0")" && pwd)
. "$HERE/common.sh"
C=$BIN/kaboum-cache
KABOUM_CACHE=$WORK/cache
export KABOUM_CACHE
tetrahedron >t.off
shows 0 '^0 entries' "$C" list
for epsilon in 1% 2% 3%; do
  run_tool 0 "$BIN/bcd-decompose" t.off -o "$epsilon.glb" --epsilon "$epsilon"
  sleep 0.02
done
shows 0 '^3 entries' "$C" list
run_tool 0 "$BIN/bcd-decompose" t.off -o again.glb --epsilon 1%
grep -q 'from the cache' err.txt || fail "not from the cache: $(cat err.txt)"
cmp -s 1%.glb again.glb || fail "another result from the cache"
shows 0 '^3 of 3 entries are whole' "$C" verify

# The one used last is listed last, and stays.
last=$("$C" list | sed -n 3p | cut -d' ' -f1)
size=$(wc -c <"$KABOUM_CACHE/$last.set")
run_tool 0 "$C" prune --size $((size + 10)) --report r.json
grep -q '"removed": 2' r.json || fail "prune: $(cat r.json)"
[ -f "$KABOUM_CACHE/$last.set" ] || fail "the one used last is removed"
run_tool 0 "$BIN/bcd-decompose" t.off -o again.glb --epsilon 1%
grep -q 'from the cache' err.txt || fail "the one used last is not found"

# A changed byte is found, and told of; the result is made anew.
printf 'X' | dd of="$KABOUM_CACHE/$last.set" bs=1 seek=200 conv=notrunc 2>/dev/null
shows 1 'damaged' "$C" verify
expect 0 'made again' "$BIN/bcd-decompose" t.off -o again.glb --epsilon 1%
cmp -s 1%.glb again.glb || fail "another result after damage"
shows 0 '^1 of 1' "$C" verify
printf 'X' | dd of="$KABOUM_CACHE/$last.set" bs=1 seek=200 conv=notrunc 2>/dev/null
shows 0 'removed' "$C" verify --remove
shows 0 '^0 entries' "$C" list
expect 2 'no size\|must be a size' env KABOUM_CACHE_SIZE=big "$C" list
run_tool 2 "$C"
run_tool 2 "$C" prune --all --size 5
finish
