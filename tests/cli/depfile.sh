# shellcheck shell=sh disable=SC2154,SC1003
# Names of any kind in dependency files, as make and ninja read them; those that have no place there are refused
# before anything is made.
. "$(dirname "$0")/common.sh"
P=$BIN/mesh-prepare
printf 'OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n' >t.off

# in_make OUT IN: the rule in `d` holds and is seen by make.
in_make() {
  { cat d; printf '\t@echo made\n'; } >mk
  touch -d '2001-01-01' "$2"
  touch -d '2002-01-01' "$1"
  make -rf mk >make.txt 2>&1 || fail "make, of '$1': $(cat make.txt)"
  grep -q '^made' make.txt && fail "make makes '$1' anew: $(cat make.txt)"
  touch -d '2003-01-01' "$2"
  make -rf mk >make.txt 2>&1 || fail "make, of '$1': $(cat make.txt)"
  grep -q '^made' make.txt || fail "make does not see '$2': $(cat make.txt)"
}

# in_ninja OUT IN: the same for ninja.
in_ninja() {
  command -v ninja >/dev/null || return 0
  rm -rf .ninja_log
  out=$(printf '%s' "$1" | sed 's/[$ :]/$&/g')
  # shellcheck disable=SC2016 # ninja's
  printf 'rule r\n command = touch $out\n depfile = d\nbuild %s: r\n' "$out" >build.ninja
  touch -d '2001-01-01' "$2"
  ninja >ninja.txt 2>&1 || fail "ninja, of '$1': $(cat ninja.txt)"
  ninja >ninja.txt 2>&1
  grep -q 'no work' ninja.txt || fail "ninja makes '$1' anew: $(cat ninja.txt)"
  touch -d '2090-01-01' "$2"
  ninja >ninja.txt 2>&1
  grep -q 'touch' ninja.txt || fail "ninja does not see '$2': $(cat ninja.txt)"
}

# shellcheck disable=SC2016 # names
for name in plain 'a b' ' a' 'a  b' 'a#b' '#a' 'a$b' '$(x)b' 'a:b' 'a\b' 'a\\b' 'a\ b' 'a\\ b' 'é' 'a,b' 'a@b' \
  'a(b)c' 'a~b' 'a{b}c' 'a+b' 'a!b'; do
  cp t.off "$name.off"
  expect 0 '' "$P" "$name.off" -o "$name.ply" --depfile d --quiet
  in_make "$name.ply" "$name.off"
  in_ninja "$name.ply" "$name.off"
done
for name in 'a%b'; do
  cp t.off "$name.off"
  expect 0 '' "$P" "$name.off" -o plain.ply --depfile d --quiet
  in_make plain.ply "$name.off"
  in_ninja plain.ply "$name.off"
  expect 2 'no place in a rule' "$P" t.off -o "$name.ply" --depfile d --quiet
done

# A name must not become a recipe, a variable or another file.
for name in 'a
	touch injected' 'a	b' 'a*' 'a?' 'a[b]' 'a=b' 'a;touch injected' 'a|b' 'a&b' 'a^b' 'a<b' "it's" 'a"b' 'a`b' 'a\#b' 'a\:b' '~a'; do
  rm -f r.ply d
  cp t.off "$name.off"
  expect 2 'no place in a rule' "$P" "$name.off" -o r.ply --depfile d --quiet
  absent r.ply d
  expect 2 'no place in a rule' "$P" t.off -o "$name.ply" --depfile d --quiet
  # A list holds any.
  expect 0 '' "$P" "$name.off" -o r.ply --depfile d.list --quiet
  printf '%s.off\0' "$name" | cmp -s - d.list || fail "not in the list: '$name'"
done
cp t.off 'b)'
expect 2 'no place in a rule' "$P" 'b)' --input-format off -o r.ply --depfile d --quiet
cp t.off 'b\'
expect 2 'no place in a rule' "$P" 'b\' --input-format off -o r.ply --depfile d --quiet
absent injected
finish
