#!/bin/sh
# The rules of scripts/include-graph hold for the sources, and each fails where it is broken.
# usage: include-rules.sh SOURCES
set -eu
sources=$1
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
(cd "$sources" && find lib* -name '*.h' && find libplan libjudge libverify -name '*.cpp') |
  tar -C "$sources" -cf - -T - | tar -C "$tmp" -xf -

graph() { "$sources/scripts/include-graph" --root "$tmp" >/dev/null 2>"$tmp/said"; }
graph || { echo "the sources break a rule: $(cat "$tmp/said")" >&2; exit 1; }

# refused FILE INCLUDE MESSAGE: with that line more it is refused, and the message says why.
refused() {
  cp "$tmp/$1" "$tmp/kept"
  printf '#include %s\n' "$2" >>"$tmp/$1"
  if graph; then
    echo "$1 may include $2" >&2
    exit 1
  fi
  grep -q "$3" "$tmp/said" || { echo "$1 with $2: $(cat "$tmp/said")" >&2; exit 1; }
  mv "$tmp/kept" "$tmp/$1"
}
cp "$tmp/libgeom/include/kaboum/geom/mesh.h" "$tmp/kept"
echo 'inline const char* remedy = "try --prepare wrap";' >>"$tmp/libgeom/include/kaboum/geom/mesh.h"
if graph; then echo "a library may name an option" >&2; exit 1; fi
grep -q 'names an option of a program: "try --prepare wrap"' "$tmp/said" || { cat "$tmp/said" >&2; exit 1; }
mv "$tmp/kept" "$tmp/libgeom/include/kaboum/geom/mesh.h"
refused libplan/src/check/check.cpp '"task/knowledge_view.h"' "libplan/src/check includes libplan/src/task/knowledge_view.h, by libplan/src/check/check.cpp"
refused libplan/src/check/transitions.h '"search/search.h"' "libplan/src/check includes libplan/src/search/search.h"
refused libplan/src/check/world_rules.cpp '"worlds/world_sets.h"' "libplan/src/check includes libplan/src/worlds/world_sets.h"
refused libplan/src/check/check.cpp '<kaboum/plan/solve.h>' "libplan/src/check includes libplan/include/kaboum/plan/solve.h"
# On a way round: by what is shared.
refused libplan/src/plan/named_fact.h '"task/layout.h"' "libplan/src/check includes libplan/src/task/layout.h, by libplan/src/plan/named_fact.h"
refused libplan/include/kaboum/plan/plan.h '<kaboum/plan/solve.h>' "libplan/src/check includes libplan/include/kaboum/plan/solve.h"
refused libplan/src/language/model.cpp '"task/task.h"' "libplan/src/language includes libplan/src/task/task.h"
refused libplan/src/plan/plan.cpp '"task/task.h"' "libplan/src/plan includes libplan/src/task/task.h"
header_of() { (cd "$tmp" && find "$1/include" -name '*.h' | sort | head -n 1 | sed 's|.*/include/||'); }
for room in libworld libcollide libexecution libplan libbcd; do
  refused libjudge/src/solid.cpp "<$(header_of "$room")>" "libjudge includes what makes things: .*$room"
done
refused libverify/include/"$(header_of libverify)" "<$(header_of libbcd)>" "libverify includes what makes things: .*libbcd"
