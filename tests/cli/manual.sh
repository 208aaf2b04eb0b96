# shellcheck shell=sh disable=SC2154
# Manual pages and completions, made of --help: every tool has them, with every option.
HERE=$(cd "$(dirname "$0")" && pwd)
. "$HERE/common.sh"
MADE=$(cd "$BIN/.." && pwd)
count=0
for page in "$MADE"/man/*.1; do
  tool=$(basename "$page" .1)
  count=$((count + 1))
  grep -q '^\.SH SYNOPSIS' "$page" || fail "$tool: no synopsis"
  "$BIN/$tool" --help | sed -n 's/^  \(-[-a-z,]*\).*/\1/p' | tr , '\n' >options.txt
  [ -s options.txt ] || fail "$tool: no options"
  while read -r option; do
    escaped=$(printf '%s' "$option" | sed 's/-/\\-/g')
    grep -qF -- "$escaped" "$page" || fail "$tool: $option is not on its page"
    grep -q -- "[ |\"]${option}[ |\")]" "$MADE/completions/$tool" || fail "$tool: $option is not completed"
  done <options.txt
  bash -n "$MADE/completions/$tool" || fail "$tool: its completion is no bash"
done
[ "$count" -ge 13 ] || fail "only $count pages"

completed() {
  bash -c 'source "$1/completions/$2"; f=_${2//-/_}; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); $f; echo "${COMPREPLY[@]}"' - "$MADE" "$@"
}
[ "$(completed bmesh-decimate a.stl --direction i)" = inner ] || fail "values of --direction: $(completed bmesh-decimate a.stl --direction i)"
[ "$(completed kaboum-plan s)" = 'solve show' ] || fail "commands: $(completed kaboum-plan s)"
[ "$(completed kaboum-plan solve --search a)" = astar ] || fail "values of a command's option"
: >some.stl
[ "$(completed bmesh-decimate so)" = some.stl ] || fail "files"
finish
