# Sourced by the tests: helpers that count failures and say what went wrong.
BIN=$1
MESHES=$2
WORK=$(mktemp -d)
# A test that ends without finish() fails all the same.
trap 'code=$?; rm -rf "$WORK"; [ "$code" != 0 ] || exit "$FAILED"' EXIT
cd "$WORK" || exit 1
FAILED=0
BRACKET=$MESHES/bracket.obj

fail() {
  echo "FAILED: $*"
  FAILED=1
}

# run_tool CODE COMMAND...: what it prints into out.txt and err.txt, and its exit code. Who is misused or cannot
# write has no result to print.
run_tool() {
  code=$1
  shift
  "$@" >out.txt 2>err.txt </dev/null
  got=$?
  [ "$got" = "$code" ] || fail "exit $got instead of $code: $*: $(head -c 300 err.txt)"
  case $code in 2 | 4) [ ! -s out.txt ] || fail "prints to stdout, exit $code: $*: $(head -c 300 out.txt)" ;; esac
}

# names_place COMMAND...: whether stderr names an option, a file or a value of some length: one of the command, or
# what it has to have.
names_place() {
  shift
  for word in "$@"; do
    case $word in
      -?*) word=${word%%=*} ;;
      *.* | */* | ?????*) ;;
      *) continue ;;
    esac
    grep -qF -- "$word" err.txt && return 0
  done
  grep -qE -- '--[a-z]|[A-Z]+ (is|are) required|subcommand is required|standard input' err.txt
}

# expect CODE WORDS COMMAND...: the exit code, and words of the log, on stderr. '' stands for any, but a refusal
# (2, 3, 4) has to name an option or a file, and a "no" or a limit (1, 7) has to say something.
expect() {
  code=$1
  words=$2
  shift 2
  run_tool "$code" "$@"
  if [ -n "$words" ]; then
    grep -q -- "$words" err.txt || fail "no '$words' on stderr of: $*: $(head -c 300 err.txt)"
    return
  fi
  case $code in
    2 | 3 | 4) names_place "$@" || fail "no option or file named on stderr of: $*: $(head -c 300 err.txt)" ;;
    1 | 7) [ -s out.txt ] || [ -s err.txt ] || fail "nothing said, exit $code: $*" ;;
  esac
}

# shows CODE WORDS COMMAND...: the exit code, and words of the result, on stdout.
shows() {
  code=$1
  words=$2
  shift 2
  run_tool "$code" "$@"
  grep -q -- "$words" out.txt || fail "no '$words' on stdout of: $*: $(head -c 300 out.txt) $(head -c 300 err.txt)"
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

# A VRML file of a tetrahedron of the size $1, 1 unless given.
inlined() {
  echo "#VRML V2.0 utf8
Shape { geometry IndexedFaceSet { coord Coordinate { point [0 0 0, ${1:-1} 0 0, 0 ${1:-1} 0, 0 0 ${1:-1}] }
  coordIndex [0 2 1 -1 0 1 3 -1 1 2 3 -1 2 0 3 -1] } }"
}

# t.gltf and its buffer, 'my buf.bin'.
tetrahedron_gltf() {
  one='\000\000\200\077' zero='\000\000\000\000'
  {
    printf '%b' "$zero$zero$zero" "$one$zero$zero" "$zero$one$zero" "$zero$zero$one"
    printf '\000\002\001\000\001\003\001\002\003\002\000\003'
  } >'my buf.bin'
  echo '{"asset": {"version": "2.0"}, "buffers": [{"uri": "my%20buf.bin", "byteLength": 60}],
    "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
    "accessors": [
      {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
      {"bufferView": 1, "componentType": 5121, "count": 12, "type": "SCALAR"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0}' >t.gltf
}

# json FILE CONDITION: of the report r.
json() {
  python3 -c "import json, sys; r = json.load(open(sys.argv[1])); sys.exit(not ($2))" "$1" || fail "$1: not $2"
}

# slab X: a block of X by 1 by 1, OFF.
slab() {
  printf 'OFF\n8 12 0\n0 0 0\n%s 0 0\n%s 1 0\n0 1 0\n0 0 1\n%s 0 1\n%s 1 1\n0 1 1\n' "$1" "$1" "$1" "$1"
  printf '3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n'
}
