# shellcheck shell=sh disable=SC2154
# The pages of pages.sh ($4) as a browser draws them. 77, which ctest calls skipped: there is no Chromium.
HERE=$(cd "$(dirname "$0")" && pwd)
. "$HERE/common.sh"
CHROMIUM=$(command -v chromium || command -v chromium-browser || command -v google-chrome) ||
  { echo "SKIPPED: no chromium on this machine, so no page has been looked at"; exit 77; }
PAGES=$4
# Pages that are wrong: one that does not explode, one in other colours, one that says something on the console.
sed 's/position + explode \* away/position/' "$PAGES/bodies.html" >still.html
sed 's/mix(k, heat\[i + 1\]/mix(k, heat[0]/' "$PAGES/bodies.html" >dark.html
sed 's/const grey = /nothing();\n  const grey = /' "$PAGES/bodies.html" >broken.html
node "$HERE/look_at_pages.js" "$CHROMIUM" "$HERE/../../libpage/src/scene.js" seen.png \
  "$PAGES/bodies.html#layer0=hidden&layer1=shown" \
  "$PAGES/bodies.html#layer0=shown&layer1=shown&colours=bodies&explode=1" \
  "$PAGES/bodies.html" "whole:$PAGES/bodies.html" \
  "$PAGES/outer.html#layer0=hidden&layer1=shown" "$PAGES/outer.html#layer0=shown&layer1=hidden" \
  "$PAGES/hand.html#layer0=hidden&layer1=shown&colours=bodies" "whole:$PAGES/hand.html" \
  "$PAGES/swept.html#layer0=hidden&layer1=shown" "$PAGES/swept.html#layer0=shown&layer1=hidden&colours=plain&time=1" \
  "$PAGES/plan.html" "$PAGES/plan.html#shapes=exact&t=4" "whole:$PAGES/assumed.html#t=2" \
  "outline:still.html#layer0=hidden&layer1=shown&explode=1" "colours:dark.html#layer0=hidden&layer1=shown" \
  console:broken.html || fail "what is seen"
# A browser keeps 16 drawings at a time, so these are looked at by themselves.
node "$HERE/look_at_pages.js" "$CHROMIUM" "$HERE/../../libpage/src/scene.js" moved.png \
  "$PAGES/hand.html#layer0=hidden&layer1=shown&colours=bodies&joint0=1&joint1=-2&joint2=0.2" \
  "$PAGES/run.html" "$PAGES/run.html#shapes=exact&t=4" "whole:$PAGES/run.html#t=4" || fail "a robot whose joints are moved, or a run"
finish
