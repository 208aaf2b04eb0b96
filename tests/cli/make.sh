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

# A box and a sheet, whose triangles stand in both orientations: wrapped, and the verdict is about every triangle.
cat >pipeline/flap.off <<'END'
OFF
11 14 0
0 0 0
1 0 0
0 1 0
1 1 0
0 0 1
1 0 1
0 1 1
1 1 1
1 0.2 0.5
1.3 0.2 0.5
1.3 0.8 0.55
3 0 2 1
3 1 2 3
3 4 5 6
3 5 7 6
3 0 1 4
3 1 5 4
3 2 6 3
3 3 6 7
3 0 4 2
3 2 4 6
3 1 3 5
3 3 7 5
3 8 9 10
3 8 10 9
END
{ sed -n '1,1p' pipeline/flap.off; echo '11 2 0'; sed -n '3,13p;26,27p' pipeline/flap.off; } >pipeline/sheet.off
cat >pipeline/flap.urdf <<'END'
<robot name="flap"><link name="base"><collision><geometry><mesh filename="flap.off"/></geometry></collision></link></robot>
END
for result in flap.outer.ply flap.bcd.glb sheet.outer.stl sheet.bcd.obj flap.safe; do
  build "$result.verified" >sheets.txt 2>&1 || fail "$result.verified: $(tail -3 sheets.txt)"
  grep -q '"verdict": "verified"' "pipeline/$result.verified" || fail "$result is not verified"
done
# The sheet alone outside is seen.
build KABOUM_OUTER_FLAGS=--drop-sheets flap.outer.ply >sheets.txt 2>&1 || fail "without the sheet: $(tail -3 sheets.txt)"
build KABOUM_OUTER_FLAGS=--drop-sheets flap.outer.ply.verified >sheets.txt 2>&1 && fail "a sheet that is outside is verified"
absent pipeline/flap.outer.ply.verified
finish
