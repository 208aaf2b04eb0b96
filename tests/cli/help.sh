# shellcheck shell=sh disable=SC2154
. "$(dirname "$0")/common.sh"

# narrow WIDTH COMMAND...: help of which no line is wider.
narrow() {
  width=$1
  shift
  shows 0 'Usage: ' env COLUMNS="$width" "$@" --help
  LC_ALL=C awk -v width="$width" 'length > width' out.txt >wide.txt
  [ ! -s wide.txt ] || fail "wider than $width columns: $*: $(cat wide.txt)"
}

tools=0
for tool in "$BIN"/*; do
  if [ ! -f "$tool" ] || [ ! -x "$tool" ]; then continue; fi
  tools=$((tools + 1))
  for width in 80 100; do narrow $width "$tool"; done
done
[ $tools -ge 8 ] || fail "only $tools tools"
for command in solve check show convert; do
  for width in 80 100; do narrow $width "$BIN/kaboum-plan" $command; done
done
# Not a terminal, nothing said of its width.
expect 0 '' env -u COLUMNS "$BIN/bound-verify" --help
LC_ALL=C awk 'length > 80' out.txt >wide.txt
[ ! -s wide.txt ] || fail "wider than 80 columns: $(cat wide.txt)"
finish
