# shellcheck shell=sh disable=SC2154
# STEP and IGES: parts that OpenCASCADE made itself. Wraps hold the exact faces, by samples of them; tessellated parts are
# closed, and their deviation is stated; what is damaged is refused.
. "$(dirname "$0")/../cli/common.sh"
PARTS=$3
mkdir parts
"$PARTS" make parts >/dev/null || fail "the parts cannot be made"
[ "$(find parts -name '*.step' | wc -l)" = 12 ] || fail "parts are missing"
for part in parts/*.step; do
  name=$(basename "$part" .step)
  expect 0 'in millimetres' "$BIN/mesh-prepare" "$part" -o "$name.ply" --report r.json
  grep -q 'hole' err.txt && fail "$name is open: $(cat err.txt)"
  expect 0 'is inside, too: the exact faces' "$BIN/mesh-prepare" "$part" -o "$name-wrap.ply" --prepare wrap --epsilon 2%
  "$PARTS" check "$part" "$name-wrap.ply" 20000 2% >out.txt || fail "$name: $(cat out.txt)"
done
# The tessellation alone does not hold the exact faces: the check can fail.
"$PARTS" check parts/sphere.step sphere.ply 1000 2% >/dev/null && fail "the sphere's triangles hold the sphere"
expect 0 '50 solids' "$BIN/mesh-prepare" parts/assembly.step -o a.ply
for f in flange box; do expect 0 'in millimetres' "$BIN/mesh-prepare" parts/$f.iges -o i.ply; done
# Bodies cover the exact faces; an .obj of bodies reads as one mesh whose winding number counts them.
for part in flange sphere vase; do
  expect 0 'is inside, too: the exact faces' "$BIN/bcd-decompose" parts/$part.step -o $part.obj --epsilon 2% --effort fast --no-cache
  "$PARTS" check parts/$part.step $part.obj 20000 2% >out.txt || fail "bodies of $part: $(cat out.txt)"
done
expect 0 '' "$BIN/bcd-decompose" parts/sphere.step -o strict.obj --prepare strict --epsilon 2% --effort fast --no-cache
grep -q 'is inside, too' err.txt && fail "the triangles' bodies are said to hold the exact faces"
# A second reading of the part looks at points of its exact faces: bodies of a wrap hold them, those of the triangles do not.
for part in flange sphere vase; do
  shows 0 'exact points: verified' "$BIN/bound-verify" cover parts/$part.step $part.obj --report r.json
  python3 - <<'END' || fail "the report on $part"
import json
r = json.load(open("r.json"))
points = r["claims"]["exact_points"]
assert r["verdict"] == "verified" and points["answer"] == "verified" and points["points"] > 200 and points["outside"] == 0
assert r["original"]["deviation"] > 0 and r["original"]["exact_faces"] > 0
END
done
shows 1 'exact points: refuted: .* stick out of the union of the bodies, by up to .*, near (.*), face 1' \
  "$BIN/bound-verify" cover parts/sphere.step strict.obj --prepare
shows 1 'solid claim: verified' "$BIN/bound-verify" cover parts/sphere.step strict.obj --prepare
shows 0 'verified, of the triangles, which stand for exact faces within .*; of these nothing is said' \
  "$BIN/bound-verify" cover parts/sphere.step strict.obj --prepare --exact-points 0
shows 1 'exact points: refuted' "$BIN/bound-verify" mesh --outer parts/vase.step vase.ply
shows 1 'exact points: refuted' "$BIN/bound-verify" cover parts/flange.step vase.obj
shows 0 'exact points: verified' "$BIN/bound-verify" mesh --outer parts/assembly.step assembly-wrap.ply
shows 0 'exact points: verified' "$BIN/bound-verify" mesh --outer parts/flange.iges flange-wrap.ply
expect 0 '' "$BIN/mesh-prepare" parts/torus.step -o big.ply --scale 0.001 --prepare wrap
shows 0 'exact points: verified' "$BIN/bound-verify" mesh --outer parts/torus.step big.ply --scale 0.001
shows 1 'exact points: refuted' "$BIN/bound-verify" mesh --outer parts/torus.step big.ply
"$BIN/bound-verify" mesh --outer parts/vase.step vase-wrap.ply --exact-points 40 --threads 1 --report a.json >a.txt
"$BIN/bound-verify" mesh --outer parts/vase.step vase-wrap.ply --exact-points 40 --threads 3 --report b.json >b.txt
cmp a.txt b.txt || fail "the verdict depends on threads"
# In Python the same functions hold and judge exact faces.
if PYTHONPATH="$BIN/../python" python3 -c 'import numpy, kaboum' 2>/dev/null; then
  PYTHONPATH="$BIN/../python" python3 - <<'END' || fail "STEP in Python"
import kaboum
part = kaboum.read("parts/vase.step")
assert part.unit == "mm" and 0 < part.deviation < 0.1, part.deviation
held = kaboum.verify_cover(part, kaboum.decompose(part, epsilon="2%", effort="fast", no_cache=True))
assert held and held.claims["exact_points"]["answer"] == "verified", held.claims
own = kaboum.verify_mesh("parts/vase.step", part)
assert own.answer == "refuted" and own.claims["exact_points"]["outside"] > 0, own.claims
assert kaboum.verify_mesh(part, part, exact_points=0)
END
fi
# Every program that reads a mesh reads these, too.
expect 0 'the exact faces' "$BIN/bmesh-decimate" parts/vase.step -o simple.ply --epsilon 2% --effort fast
"$PARTS" check parts/vase.step simple.ply 20000 2.5% >out.txt || fail "decimated: $(cat out.txt)"
shows 0 'exact points: verified' "$BIN/bound-verify" mesh --outer parts/vase.step simple.ply
expect 0 'what is said is about the triangles' "$BIN/bmesh-decimate" parts/vase.step -o simple.ply --epsilon 0.05% --prepare strict --effort fast
shows 1 'exact points: refuted' "$BIN/bound-verify" mesh --outer parts/vase.step simple.ply --epsilon 3%
expect 2 'mesh-prepare' "$BIN/bmesh-decimate" parts/vase.step -o simple.ply --ratio 0.5 --log l
expect 0 '' "$BIN/bmesh-decimate" parts/vase.step -o simple.ply --ratio 0.5 --log l --prepare strict --effort fast
shows 0 'verified' "$BIN/bmesh-replay" parts/vase.step l simple.ply
expect 0 'what is said is about the triangles' "$BIN/bcd-decompose" parts/box.step -o in.glb --direction inner --epsilon 5% --no-cache
shows 0 'verified, of the triangles' "$BIN/bound-verify" mesh --inner parts/box.step in.glb --prepare --report r.json
grep -q 'an inner claim is about the triangles' r.json || fail "the report on an inner set does not say what it is about"
shows 0 'not looked at: an inner claim is about the triangles; the exact faces may lie up to .* inside' \
  "$BIN/bound-verify" mesh --inner parts/box.step in.glb --prepare
expect 0 'exact faces' "$BIN/hausdorff-eval" parts/vase.step vase.ply --samples 100 --at-most 1%
expect 0 'to the exact faces nothing is certain' "$BIN/hausdorff-eval" parts/vase.step vase.ply --samples 100 --at-most 1%
expect 1 'not certain.*deviation of exact faces.*is added' "$BIN/hausdorff-eval" parts/vase.step vase.ply --samples 100 --at-most 1e-9
expect 0 '' "$BIN/mesh-picture" parts/vase.step parts/flange.iges -o vase.png
cat >arm.urdf <<'END'
<robot name="arm"><link name="base"><collision><geometry><mesh filename="parts/vase.step" scale="0.001 0.001 0.001"/></geometry></collision></link>
<link name="tool"/><joint name="j" type="revolute"><parent link="base"/><child link="tool"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>
END
printf 'j\n0\n1\n' >path.csv
expect 0 '' "$BIN/bcd-decompose" arm.urdf -o armed --epsilon 5% --effort fast --no-cache
shows 0 '^verified: .*no point of these that was looked at sticks out' "$BIN/bound-verify" robot arm.urdf armed/arm.urdf --prepare --report r.json
grep -q '"exact_points"' r.json || fail "no points of exact faces: $(cat r.json)"
# Bodies of the triangles alone: points of the exact faces refute the link, unless they are not looked at.
sed 's/vase/sphere/' arm.urdf >ball.urdf
expect 0 '' "$BIN/bcd-decompose" ball.urdf -o strict-ball --prepare strict --epsilon 2% --effort fast --no-cache --report s.json
grep -q '"check": "bound-verify robot .* --exact-points 0' s.json || fail "the command looks at exact faces: $(grep '"check"' s.json)"
shows 1 "link 'base': refuted: .*every triangle is inside, but [1-9].* points of its exact faces stick out" \
  "$BIN/bound-verify" robot ball.urdf strict-ball/ball.urdf --prepare --report r.json
grep -q '"faces_outside": [1-9]' r.json || fail "no faces outside: $(cat r.json)"
shows 0 '^verified: .*exact faces: of these nothing is said' "$BIN/bound-verify" robot ball.urdf strict-ball/ball.urdf --prepare --exact-points 0
expect 0 '' "$BIN/sweep-approx" arm.urdf --path path.csv -o swept.glb --epsilon 0.01 --no-cache
shows 0 '^verified: .*no point of these that was looked at sticks out' "$BIN/bound-verify" sweep arm.urdf path.csv swept.glb --prepare --report r.json
grep -q '"exact_points"' r.json || fail "no points of exact faces: $(cat r.json)"
# Bodies of the triangles alone: points refute the motion, too, unless they are not looked at.
sed 's/ scale="[^"]*"//' ball.urdf >mm.urdf
printf 'j\n0\n' >still.csv
expect 0 '' "$BIN/bcd-decompose" mm.urdf -o strict-mm --prepare strict --epsilon 2% --effort fast --no-cache
shows 1 'points of exact faces: refuted: [1-9][0-9]* of ' "$BIN/bound-verify" sweep mm.urdf still.csv strict-mm/links/base.glb --prepare
shows 0 '^verified: .*exact faces: of these nothing is said' \
  "$BIN/bound-verify" sweep mm.urdf still.csv strict-mm/links/base.glb --prepare --exact-points 0
# Python's verdict on a motion is the program's.
if PYTHONPATH="$BIN/../python" python3 -c 'import numpy, kaboum' 2>/dev/null; then
  PYTHONPATH="$BIN/../python" python3 - <<'END' || fail "motions of exact faces in Python"
import kaboum

held = kaboum.verify_sweep("arm.urdf", "path.csv", "swept.glb", prepare=True)
assert held and held.claims["exact_points"]["answer"] == "verified", held.claims
assert held.claims["exact_points"]["configurations"] > 1
own = kaboum.verify_sweep("mm.urdf", "still.csv", "strict-mm/links/base.glb", prepare=True)
assert own.answer == "refuted", own.claims
points = own.claims["exact_points"]
assert points["outside"] > 0 and points["farthest"] > 0 and points["shape"] == "base/0", points
triangles = kaboum.verify_sweep("mm.urdf", "still.csv", "strict-mm/links/base.glb", prepare=True, exact_points=0)
assert triangles and triangles.claims["exact_points"]["answer"] == "undefined", triangles.claims
END
fi
expect 0 'the exact faces' "$BIN/kaboum-scene" make cell.json --object vase=parts/vase.step --scale vase=0.001 --epsilon 2% --effort fast --no-cache
shows 0 'exact points: verified' "$BIN/bound-verify" cover parts/vase.step cell/vase.glb --scale 0.001
head -c 2000 parts/vase.step >cut.step
expect 3 'cut.step' "$BIN/mesh-prepare" cut.step -o none.ply
# Numbers are numbers; those that OpenCASCADE takes for infinite make it count for ever.
for wrong in 1.E400:'beyond 1e100' -1.E101:'beyond 1e100' abc:'is no number' 1.5.2:'is no number' nan:'is no number'; do
  sed "0,/CARTESIAN_POINT('',(-*[0-9.]*,/s//CARTESIAN_POINT('',(${wrong%%:*},/" parts/vase.step >wrong.step
  expect 3 "${wrong#*:}" "$BIN/mesh-prepare" wrong.step -o none.ply
done
sed '0,/25[.]980762114,/s//1.E400,      /' parts/flange.iges >wrong.iges
expect 3 'beyond 1e100' "$BIN/mesh-prepare" wrong.iges -o none.ply
sed "s/LENGTH_UNIT() *NAMED_UNIT(\*) *SI_UNIT(.MILLI.,.METRE.)/LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.NANO.,.METRE.)/" parts/box.step >tiny.step
expect 3 'mm large.*is its unit right' "$BIN/mesh-prepare" tiny.step -o none.ply
# OpenCASCADE turns what an operator mirrors, does not scale, and confuses two placements neither of which is the origin.
python3 - <<'END' || fail "no placed parts"
import re
text = open("parts/box.step").read()
shape, axis, context = re.search(
    r"(#\d+) = ADVANCED_BREP_SHAPE_REPRESENTATION\('',\((#\d+),#\d+\),\s*(#\d+)\);", text).groups()
operator = "CARTESIAN_TRANSFORMATION_OPERATOR_3D('','','',%s)"
for name, target, origin in [
    ("same", operator % "#9014,#9011,#9013,1.,#9012", axis), ("bare", operator % "$,$,#9013,$,$", axis),
    ("turned", "AXIS2_PLACEMENT_3D('',#9013,#9012,#9010)", axis),
    ("moved", "AXIS2_PLACEMENT_3D('',#9013,$,$)", "#9021"),
    ("not-mirrored", operator % "#9010,#9011,#9013,1.,#9012", axis),
    ("not-mirrored-y", operator % "#9014,#9016,#9013,1.,#9012", axis),
    ("not-mirrored-z", operator % "#9014,#9011,#9013,1.,#9015", axis),
    ("not-half", operator % "#9010,$,#9013,1.,#9012", axis),
    ("not-scaled", operator % "#9014,#9011,#9013,2.,#9012", axis),
    ("not-operator", operator % "#9014,#9011,#9013,1.,#9012", "#9021"),
    ("not-axis", "AXIS2_PLACEMENT_3D('',#9013,#9012,#9010)", "#9021"),
    ("not-second", "AXIS2_PLACEMENT_3D('',#9013,#9014,$)", axis),
]:
    placed = re.sub(r"(SHAPE_DEFINITION_REPRESENTATION\(#\d+,)" + shape + r"\)", r"\1#9003)", text)
    more = f"""#9000=REPRESENTATION_MAP({origin},{shape});
#9001=MAPPED_ITEM('',#9000,#9002);
#9002={target};
#9003=SHAPE_REPRESENTATION('',({axis},#9001),{context});
#9010=DIRECTION('',(-1.,0.,0.));
#9011=DIRECTION('',(0.,1.,0.));
#9012=DIRECTION('',(0.,0.,1.));
#9013=CARTESIAN_POINT('',(-5.,3.,1.));
#9014=DIRECTION('',(1.,0.,0.));
#9015=DIRECTION('',(0.,0.,-1.));
#9016=DIRECTION('',(0.,-1.,0.));
#9020=CARTESIAN_POINT('',(100.,0.,0.));
#9021=AXIS2_PLACEMENT_3D('',#9020,$,$);
"""
    end = placed.rindex("ENDSEC;")
    open(f"placed-{name}.step", "w").write(placed[:end] + more + placed[end:])
END
for part in placed-*.step; do
  case $part in
    placed-not-*) expect 3 'is not read\|: not read\|has no second direction' "$BIN/mesh-prepare" "$part" -o none.ply ;;
    *)
      expect 0 '' "$BIN/mesh-prepare" "$part" -o placed.ply
      case $part in
        *-turned.step) box='-35 -17 1 -5 3 11' ;;
        *-moved.step) box='-105 3 1 -75 23 11' ;;
        *) box='-5 3 1 25 23 11' ;;
      esac
      "$PARTS" box placed.ply "$box" >out.txt || fail "$part is not where it should be"
      ;;
  esac
done
# Units that it does not understand, where it takes millimetres.
mm='LENGTH_UNIT() NAMED_UNIT(\*) SI_UNIT(.MILLI.,.METRE.)'
unit() { sed "s/^\(#[0-9]*\) = ( $mm );/#9001 = ( $1 );\\n\1 = $2;\\n$3/" parts/box.step >unit.step; }
si='LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.)'
inch="( CONVERSION_BASED_UNIT('INCH',#9002) LENGTH_UNIT() NAMED_UNIT(#9003) )"
zero='#9003 = DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);'
unit "$si" "$inch" "#9002 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#9001);$zero"
expect 0 '' "$BIN/mesh-prepare" unit.step -o placed.ply
"$PARTS" box placed.ply '0 0 0 762 508 254' >out.txt || fail "inches: $(cat out.txt)"
unit "$si" "$inch" "#9002 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(12.),#9004);#9004 = ( CONVERSION_BASED_UNIT('INCH',#9005) LENGTH_UNIT() NAMED_UNIT(#9003) );#9005 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#9001);$zero"
expect 3 '#9004 .*known prefix' "$BIN/mesh-prepare" unit.step -o none.ply
unit "$si" "$inch" "#9002 = ( LENGTH_MEASURE_WITH_UNIT() MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#9001) );$zero"
expect 3 'a measure in this form' "$BIN/mesh-prepare" unit.step -o none.ply
unit 'LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.GRAM.)' "$inch" "#9002 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#9001);$zero"
expect 3 'METRE' "$BIN/mesh-prepare" unit.step -o none.ply
unit "$si" '( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.DEKA.,.METRE.) )' ''
expect 3 'known prefix' "$BIN/mesh-prepare" unit.step -o none.ply
sed 's/^\(GLOBAL_UNIT_ASSIGNED_CONTEXT.*\|((\|(\)\(#[0-9]*\),\(#[0-9]*,#[0-9]*)) REPRESENTATION_CONTEXT\)/\1\3/' parts/box.step >unit.step
expect 3 'no unit of length' "$BIN/mesh-prepare" unit.step -o none.ply
sed 's/,1[.],2,2HMM,/,.5,2,2HMM,/' parts/box.iges >wrong.iges
expect 3 'has a scale' "$BIN/mesh-prepare" wrong.iges -o none.ply
sed 's/,1[.],2,2HMM,/,1.,1,2HMM,/' parts/box.iges >wrong.iges
expect 3 'its unit' "$BIN/mesh-prepare" wrong.iges -o none.ply
# IGES: the same of matrices.
cat >matrix.py <<'END'
import sys
source, result, kind, rows = sys.argv[1:]
lines = open(source).read().split("\n")
section = lambda s: [line for line in lines if len(line) > 72 and line[72] == s]
D, P = section("D"), section("P")
at, first = len(D) + 1, len(P) + 1
for i in range(0, len(D), 2):
    if D[i][:8].strip() == kind:
        D[i] = D[i][:48] + f"{at:8}" + D[i][56:]
D.append(f"{124:8}{first:8}" + 5 * f"{0:8}" + f"{0:8}" + "00000000" + f"D{at:7}")
D.append(f"{124:8}{0:8}{0:8}{1:8}{0:8}{'':24}{0:8}D{at + 1:7}")
P.append(f"{'124,' + rows + ';':64}{at:8}P{first:7}")
end = f"S{len(section('S')):7}G{len(section('G')):7}D{len(D):7}P{len(P):7}"
open(result, "w").write("\n".join(section("S") + section("G") + D + P + [f"{end:72}T{1:7}", ""]))
END
turned='-1.,0.,0.,-5.,0.,-1.,0.,3.,0.,0.,1.,1.'
for kind in 186 514 510 508 116 190; do
  python3 matrix.py parts/box.iges wrong.iges $kind $turned || fail "no matrix of $kind"
  expect 3 "(type $kind.*) is moved by a matrix" "$BIN/mesh-prepare" wrong.iges -o none.ply
done
python3 matrix.py parts/flange.iges wrong.iges 402 2.,0.,0.,0.,0.,2.,0.,0.,0.,0.,2.,0.
expect 3 'is not rigid' "$BIN/mesh-prepare" wrong.iges -o none.ply
python3 matrix.py parts/flange.iges group.iges 402 $turned
expect 0 '' "$BIN/mesh-prepare" group.iges -o placed.ply
"$PARTS" box placed.ply '-45 -37 1 35 43 31' >out.txt || fail "the group is elsewhere: $(cat out.txt)"
# What carries no shape may be wrong, in both readings of the file; what may carry some may not.
for extra in "COLOUR_RGB('',0.1,0.2)" "STYLED_ITEM('',(#1),#1)" "(COLOUR() COLOUR_RGB('',0.1))" "DATE_AND_TIME(#1)"; do
  sed "0,/^#1 *=/s//#90001 = $extra;\n#1 =/" parts/box.step >extra.step
  expect 0 '' "$BIN/mesh-prepare" extra.step -o extra.ply
  shows 0 'exact points: verified' "$BIN/bound-verify" mesh --outer extra.step extra.ply
done
sed "0,/^#1 *=/s//#90001 = PLANE('',0.1);\n#1 =/" parts/box.step >extra.step
expect 3 '#90001 PLANE' "$BIN/mesh-prepare" extra.step -o none.ply
# No point of an edge or a face is farther than what is claimed: twelve parts, ribs of any width between the mesher's samples.
mkdir more
"$PARTS" more more >/dev/null || fail "the parts that are hard to read cannot be made"
for part in parts/*.step more/rib-*.step more/sheet.step more/moved-outside.step more/turned-*.step; do
  "$PARTS" within "$part" >out.txt || fail "not within its deviation: $(cat out.txt)"
done
# (The check measures reach at triangles of OpenCASCADE's own, which miss the rib: 10 %.)
for width in 0.3 0.01; do
  expect 0 'is inside, too: the exact faces' "$BIN/bcd-decompose" more/rib-$width.step -o rib.obj --epsilon 2% --effort fast --no-cache
  "$PARTS" check more/rib-$width.step rib.obj 20000 10% >out.txt || fail "bodies of a rib: $(cat out.txt)"
done
# An edge with a rib that OpenCASCADE loses where it projects the edge onto its face.
expect 3 'edge .* beside face' "$BIN/mesh-prepare" more/projected.step -o none.ply
# What is in the file is read, or the file is refused by the entity's name: also surfaces that no product reaches.
python3 - <<'END' || fail "no loose surfaces"
import re
text = open("parts/box.step").read()
axis, context = re.search(r"ADVANCED_BREP_SHAPE_REPRESENTATION\('',\((#\d+),#\d+\),\s*(#\d+)\);", text).groups()
surface = f"#9001=RECTANGULAR_TRIMMED_SURFACE('',#9002,-40.,40.,-40.,40.,.T.,.T.);\n#9002=PLANE('',{axis});\n"
for name, more in [
    ("set", "#9000=GEOMETRIC_SET('',(#9001));\n"), ("alone", ""),
    ("shape", f"#9000=GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION('',({axis},#9003),{context});\n"
              "#9003=GEOMETRIC_SET('',(#9001));\n"),
    ("bare", f"#9000=SHAPE_REPRESENTATION('',({axis},#9001),{context});\n")]:
    end = text.rindex("ENDSEC;")
    open(f"loose-{name}.step", "w").write(text[:end] + more + surface + text[end:])
END
for name in set alone shape bare; do
  expect 3 '#9001 RECTANGULAR_TRIMMED_SURFACE.* no product' "$BIN/mesh-prepare" loose-$name.step -o none.ply
done
# The verifier's own reading refuses them as well.
for name in set alone shape bare; do
  expect 3 '#9001 .*no part of the file has' "$PARTS" points loose-$name.step 6
done
shows 0 ' points of 6 faces' "$PARTS" points parts/box.step 6
expect 3 '6 exact faces were found' "$PARTS" points parts/box.step 7
sed "s/PRODUCT_CONTEXT('',/PRODUCT_CONTEXT($(printf '%0200d' 0 | tr 0 '(')/" parts/box.step >deep.step
expect 3 'more than 100 brackets' "$BIN/mesh-prepare" deep.step -o none.ply
expect 3 'TESSELLATED_SOLID' "$BIN/mesh-prepare" more/tessellated.step -o none.ply
[ "$(find more/variants -name '*.step' | wc -l)" -ge 48 ] || fail "variants are missing"
for part in more/variants/*-renamed.step; do
  type=$(basename "$part" -renamed.step)
  expect 3 "X_$type" "$BIN/mesh-prepare" "$part" -o none.ply
  expect 3 "X_$type" "$BIN/bcd-decompose" "$part" -o none.glb --no-cache
done
for part in more/variants/*-dropped.step; do
  for tool in "mesh-prepare $part -o whole.ply" "bcd-decompose --no-cache --effort fast --epsilon 5% $part -o whole.obj"; do
    # shellcheck disable=SC2086
    if "$BIN"/$tool >out.txt 2>err.txt; then
      "$PARTS" covers-box "${tool##* -o }" || fail "$part: exit 0, and the box is not covered"
    elif [ $? -ne 3 ]; then
      fail "$part: $(cat err.txt)"
    fi
  done
done
# IGES: a face of an unknown type, and one on a surface of another.
sed 's/^     510\(.\{64\}D000\)/     511\1/' parts/box.iges >face.iges
cmp -s parts/box.iges face.iges && fail "the IGES file is as it was"
expect 3 'type 51' "$BIN/mesh-prepare" face.iges -o none.ply
printf 'ISO-10303-21;\n' >head.step
expect 3 'head.step' "$BIN/mesh-prepare" head.step -o none.ply
cp parts/box.step box.iges
expect 3 'box.iges' "$BIN/mesh-prepare" box.iges -o none.ply
absent none.ply
finish
