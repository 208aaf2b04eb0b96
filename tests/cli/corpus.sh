# The dirty meshes of the collection: a result (0), a valid "no" (1), the best within the work allowed (7), or a
# clear refusal (3); nothing else.
. "$(dirname "$0")/common.sh"
D=$BIN/bmesh-decimate
tried=0
for f in "${KABOUM_MESHES:?names the folder of the collection}"/dirty-*; do
  [ -e "$f" ] || fail "no dirty-* in $KABOUM_MESHES"
  tried=$((tried + 1))
  rm -f dirty.ply
  # 60 s of processor time, so that other work on the machine does not matter.
  (ulimit -t 60 && exec "$D" "$f" -o dirty.ply --ratio 0.1 --log dirty.log) >out.txt 2>err.txt
  code=$?
  case $code in
    0 | 1 | 7) "$BIN/bmesh-replay" "$f" dirty.log dirty.ply >/dev/null || fail "replay of $f" ;;
    3) grep -q "$(basename "$f")" err.txt || fail "message for $f: $(cat err.txt)"
       absent dirty.ply ;;
    *) fail "$f: exit $code: $(head -c 300 err.txt)" ;;
  esac
  rm -f dirty.log
done
echo "$tried meshes"
finish
