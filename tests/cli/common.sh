# Sourced by the tests: helpers that count failures and say what went wrong.
BIN=$1
MESHES=$2
WORK=$(mktemp -d)
trap 'rm -rf "$WORK"' EXIT
cd "$WORK" || exit 1
FAILED=0
BRACKET=$MESHES/bracket.obj

fail() {
  echo "FAILED: $*"
  FAILED=1
}

# expect CODE WORDS COMMAND...: the exit code, and words that the output must contain ('' for any).
expect() {
  code=$1
  words=$2
  shift 2
  "$@" >out.txt 2>err.txt </dev/null
  got=$?
  [ "$got" = "$code" ] || fail "exit $got instead of $code: $*: $(head -c 300 err.txt)"
  if [ -n "$words" ] && ! cat out.txt err.txt | grep -q -- "$words"; then
    fail "no '$words' in the output of: $*: $(head -c 300 err.txt)"
  fi
}

absent() {
  for f in "$@"; do [ ! -e "$f" ] || fail "$f should not exist"; done
}

finish() {
  # Nothing temporary may be left behind.
  for f in .*.tmp* *.tmp*; do [ ! -e "$f" ] || fail "left behind: $f"; done
  exit $FAILED
}

tetrahedron() {
  printf 'OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n'
}
