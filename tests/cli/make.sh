# shellcheck shell=sh disable=SC2154
# examples/pipeline with the installed rules: built, then nothing to do; right after interruption and when options change.
HERE=$(cd "$(dirname "$0")" && pwd)
. "$HERE/common.sh"
ROOT=$HERE/../..
build() { make --no-print-directory -C pipeline -j2 KABOUM_BIN="$BIN/" KABOUM_MK="$ROOT/share/kaboum.mk" "$@"; }
sums() { (cd pipeline && sha256sum ./*.ply ./*.glb arm.safe/*.urdf); }
cp -r "$ROOT/examples/pipeline" pipeline

build >made.txt 2>&1 || fail "make: $(tail -3 made.txt)"
sums >first.txt
for result in ring.outer.ply plate.bcd.glb arm.safe; do
  grep -q '"verdict": "verified"' "pipeline/$result.verified" || fail "$result is not verified"
done
build >again.txt 2>&1 || fail "make again: $(tail -3 again.txt)"
grep -q 'Nothing to be done' again.txt || fail "the second time does something: $(tail -3 again.txt)"
build -q || fail "make -q"

# A mesh that only the robot's description names: the robot is made anew, and what else is of it.
touch pipeline/ring.obj
build -n >ring.txt 2>&1
for of in ring.outer.ply ring.bcd.glb arm.safe; do grep -q -- "-o '$of'" ring.txt || fail "$of is not made anew"; done
grep -q -- "-o 'plate" ring.txt && fail "the plate is made anew"
build >/dev/null 2>&1 || fail "make after touch"

# Ended at several moments, with all that it started: what is there is whole, and the rest is made.
for moment in 0.3 1; do
  rm -rf pipeline/*.outer.* pipeline/*.inner.* pipeline/*.bcd.* pipeline/arm.safe*
  setsid make -C pipeline -j2 KABOUM_BIN="$BIN/" KABOUM_MK="$ROOT/share/kaboum.mk" >/dev/null 2>&1 &
  made=$!
  sleep "$moment"
  kill -9 -- "-$made" 2>/dev/null
  wait "$made" 2>/dev/null
  build >after.txt 2>&1 || fail "make after kill at $moment: $(tail -3 after.txt)"
  sums >second.txt
  cmp -s first.txt second.txt || fail "other results after kill at $moment"
  build -q || fail "make -q after kill at $moment"
done

# Other options: everything anew.
build -n KABOUM_EPSILON=2% >options.txt 2>&1
for of in ring.outer.ply plate.outer.ply ring.bcd.glb arm.safe; do
  grep -q -- "-o '$of' --epsilon '2%'" options.txt || fail "$of is not made anew"
done

# What does not enclose is not verified, and the failed verdict leaves no file.
printf 'OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n' >pipeline/t.off
build t.outer.off.verified >/dev/null 2>&1 || fail "t.outer.off.verified"
sed 's/^1 0 0/0.5 0 0/' pipeline/t.off >pipeline/small.off
sleep 0.1
cp pipeline/small.off pipeline/t.outer.off
build t.outer.off.verified >wrong.txt 2>&1 && fail "a smaller mesh is verified"
absent pipeline/t.outer.off.verified
rm -f pipeline/*.part
finish
