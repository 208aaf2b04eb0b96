# shellcheck shell=sh disable=SC2154
# Programs that write into one folder at the same time: the last one wins, whole. A robot that is there is whole,
# whenever its program is ended.
. "$(dirname "$0")/common.sh"
D=$BIN/bcd-decompose
KABOUM_CACHE=$WORK/cache
export KABOUM_CACHE
mkdir robot
cp "$BRACKET" robot/bracket.obj
tetrahedron >robot/t.off
cat >robot/r.urdf <<'END'
<robot name="r">
  <link name="base"><collision><geometry><mesh filename="bracket.obj"/></geometry></collision></link>
  <link name="tool"><collision><geometry><mesh filename="t.off"/></geometry></collision>
    <collision><geometry><mesh filename="bracket.obj" scale="0.5 0.5 1"/></geometry></collision></link>
  <joint name="j" type="revolute"><parent link="base"/><child link="tool"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>
END

# make EPSILON OUT: of the mesh or the robot; fast, since results come from the cache.
make() { "$D" "$input" -o "$2" --epsilon "$1" --effort fast --quiet 2>>"err-$1.txt"; }
one_of_two() { diff -r "$1" "alone-2%" >/dev/null 2>&1 || diff -r "$1" "alone-6%" >/dev/null 2>&1; }

for input in robot/bracket.obj robot/r.urdf; do
  rm -rf alone-* both
  for epsilon in 2% 6%; do make "$epsilon" "alone-$epsilon" || fail "alone: $(cat "err-$epsilon.txt")"; done
  diff -r "alone-2%" "alone-6%" >/dev/null && fail "both epsilons have one result"
  round=0
  while [ $round -lt 15 ]; do
    [ $((round % 3)) != 0 ] || rm -rf both
    make 2% both &
    first=$!
    make 6% both &
    second=$!
    make 2% both || fail "$input, round $round: $(tail -n 1 'err-2%.txt')"
    wait "$first" || fail "$input, round $round: $(tail -n 1 'err-2%.txt')"
    wait "$second" || fail "$input, round $round: $(tail -n 1 'err-6%.txt')"
    one_of_two both || fail "$input, round $round: a mixture: $(diff -rq both 'alone-2%')"
    round=$((round + 1))
  done
  [ -z "$(find both -name '.*')" ] || fail "left behind: $(find both -name '.*')"
done

# Ended at any moment: no robot, or a whole one; the next run does not mind.
input=robot/r.urdf
for moment in 0.005 0.01 0.015 0.02 0.03 0.04 0.05 0.06 0.08 0.1; do
  make 6% both || fail "$moment: after an end: $(tail -n 1 'err-6%.txt')"
  one_of_two both || fail "$moment: not whole again: $(diff -rq both 'alone-6%')"
  "$D" "$input" -o both --epsilon 2% --effort fast --quiet &
  ended=$!
  sleep "$moment"
  kill -9 "$ended" 2>/dev/null
  wait "$ended" 2>/dev/null
  find both -depth -name '.kaboum-*.tmp' -exec rm -rf {} +
  if [ -e both/r.urdf ] && [ -z "$(find both -name '.kaboum-unfinished*')" ]; then
    one_of_two both || fail "$moment: a mixture"
  fi
  if [ -e both/r.urdf ]; then
    run_tool 0 "$BIN/bound-verify" robot robot/r.urdf both/r.urdf --prepare --epsilon 6%
  fi
done
finish
