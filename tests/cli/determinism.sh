. "$(dirname "$0")/common.sh"
D=$BIN/bmesh-decimate

# Same bytes on any number of threads and in any run; reports differ in resources only.
for n in 1 2 5; do
  "$D" "$BRACKET" -o "o$n.ply" --ratio 0.1 --cost planes --effort fast --log "l$n.log" --report "r$n.json" --threads $n --quiet || fail "run"
  "$D" "$BRACKET" -o "e$n.ply" --epsilon 0.5% --effort fast --threads $n --quiet || fail "run"
  "$D" "$BRACKET" -o "t$n.ply" --ratio 0.1 --threads $n --quiet || fail "run"
  "$D" "$BRACKET" -o "w$n.ply" --ratio 0.1 --max-work 0.2 --threads $n --quiet || fail "run"
  sed -e '/"resources"/,/}/d' -e "s/[ol]$n\././" "r$n.json" >"s$n.json"
done
for n in 2 5; do
  cmp -s o1.ply o$n.ply || fail "result differs on $n threads"
  cmp -s l1.log l$n.log || fail "log differs on $n threads"
  cmp -s e1.ply e$n.ply || fail "epsilon result differs on $n threads"
  cmp -s t1.ply t$n.ply || fail "result of pulling back differs on $n threads"
  cmp -s w1.ply w$n.ply || fail "result of little work differs on $n threads"
  cmp -s s1.json s$n.json || fail "report differs on $n threads: $(diff s1.json s$n.json | head -5)"
done
finish
