# shellcheck shell=sh disable=SC2154
# The commands on spheres that README.md and docs/usage.md show, one after the other, as they stand there.
ROOT=$(cd "$(dirname "$0")/../.." && pwd)
. "$(dirname "$0")/common.sh"
PATH=$BIN:$PATH
KABOUM_CACHE=$WORK/cache
export PATH KABOUM_CACHE

tetrahedron >link.off
mesh-prepare link.off -o link.stl --quiet || fail "no link.stl"
cat >robot.urdf <<'U'
<robot name="robot">
  <link name="base"><collision><geometry><mesh filename="link.stl" scale="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="arm"><collision><origin xyz="0.1 0 0.3"/><geometry><box size="0.08 0.06 0.3"/></geometry></collision></link>
  <joint name="j" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>
U
# Somebody's spheres, one of which is too small.
bcd-decompose robot.urdf -o own.yaml --bodies spheres --epsilon 2cm --effort fast --quiet || fail "no spheres"
awk '/radius: / && !done { sub(/radius: .*/, "radius: 0.001"); done = 1 } 1' own.yaml >others.yaml
{
  grep '^[a-z-]* .*spheres' "$ROOT/README.md"
  sed -n '/^## Spheres of a robot/,/^## Pairs/p' "$ROOT/docs/usage.md" | grep '^[a-z-]* .*\(robot.urdf\|link.stl\)'
} >commands.txt
[ "$(wc -l <commands.txt)" = 12 ] || fail "other commands: $(cat commands.txt)"
while IFS= read -r command; do
  wanted=0
  case $command in *'exit code 1'*) wanted=1 ;; esac
  sh -c "$command" >out.txt 2>err.txt </dev/null
  [ $? = $wanted ] || fail "not $wanted: $command: $(cat out.txt err.txt)"
done <commands.txt
for file in spheres.html others.html few.yaml; do [ -s $file ] || fail "no $file"; done
grep -q 'self_collision_ignore:$' spheres.yaml || fail "no pairs are stated"
finish
