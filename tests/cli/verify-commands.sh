# bound-verify's commands: each has the options that mean something for it, and is named where a flag is given instead.
. "$(dirname "$0")/common.sh"
V=$BIN/bound-verify

# cube LOW HIGH: an axis-aligned cube as OFF.
cube() {
  awk -v a="$1" -v b="$2" 'BEGIN {
    print "OFF"; print 8, 12, 0
    for (i = 0; i < 8; i++) print (i % 2 ? b : a), (int(i / 2) % 2 ? b : a), (i > 3 ? b : a)
    split("0 2 1,1 2 3,4 5 6,5 7 6,0 1 4,1 5 4,2 6 3,3 6 7,0 4 2,2 4 6,1 3 5,3 7 5", t, ",")
    for (i = 1; i <= 12; i++) print 3, t[i] }'
}
cube 0 1 >one.off
cube -1 2 >three.off

# decides CODE COMMAND...: that exit code, and a report with the verdict; none where there is none.
decides() {
  code=$1
  shift
  rm -f r.json
  expect "$code" '' "$V" "$@" --report r.json
  case $code in
    0) grep -q '"verdict": "verified"\|"relation": "progressive"' r.json || fail "no verdict of $*: $(cat r.json)" ;;
    1) grep -q '"verdict": "refuted"' r.json || fail "no verdict of $*: $(cat r.json)" ;;
    7) grep -q '"verdict": "undecided"' r.json || fail "no verdict of $*: $(cat r.json)" ;;
    *) [ ! -e r.json ] || fail "a report of $*" ;;
  esac
}

decides 0 mesh --outer one.off three.off
decides 1 mesh three.off one.off --outer --witness w.obj
decides 0 mesh --inner three.off one.off --epsilon 2
decides 3 mesh --outer one.off nowhere.off
decides 7 mesh --outer one.off three.off --max-contacts 1 --claims solid --epsilon 1.7320508075688772
decides 0 cover one.off three.off --epsilon 1.74 --prepare
decides 1 cover three.off one.off --claims surface --witness w.obj

# robot NAME MESH: one link that turns.
robot() {
  cat >"$1.urdf" <<END
<robot name="r"><link name="base"/>
  <link name="arm"><collision><geometry><mesh filename="$2"/></geometry></collision></link>
  <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/></joint>
</robot>
END
}
robot thin one.off
robot thick three.off
decides 0 robot thin.urdf thick.urdf --epsilon 2
decides 1 robot thick.urdf thin.urdf
decides 0 robot thin.urdf thick.urdf --visual
printf '0\n0.5\n' >path.csv
decides 0 sweep thin.urdf path.csv three.off
decides 1 sweep thick.urdf path.csv one.off --claims surface --witness w.obj
cube -0.5 1.4 >near.off
decides 0 sweep thin.urdf path.csv near.off
decides 7 sweep thin.urdf path.csv near.off --gap 9
decides 2 sweep thin.urdf path.csv three.off --links no
"$BIN/bmesh-decimate" "$BRACKET" --vertices 900 --effort fast --progressive p.pm --quiet || fail 'decimation'
decides 0 progressive "$BRACKET" p.pm
decides 3 progressive one.off p.pm

# Options that mean nothing for a command, files that are missing or too many.
refused() {
  expect 2 '' "$V" "$@"
  [ -s err.txt ] || fail "nothing is said: $*"
}
for option in '--geometry visual' --visual '--links arm' '--gap 1' --degrees '--joint a=1' '--package-path .' --cover; do
  # shellcheck disable=SC2086
  refused mesh --outer one.off three.off $option
  # shellcheck disable=SC2086
  refused cover one.off three.off $option
done
for option in --outer --inner --set; do refused cover one.off three.off $option; done
for option in --set '--witness w.obj' '--input-format off' '--approximation-format off' '--gap 1'; do
  # shellcheck disable=SC2086
  refused robot thin.urdf thick.urdf $option
done
for option in '--epsilon 1' --set '--claims solid' '--input-format off' '--max-contacts 5' --drop-sheets; do
  # shellcheck disable=SC2086
  refused sweep thin.urdf path.csv three.off $option
done
for option in '--epsilon 1' --prepare '--claims all' '--witness w.obj' '--max-contacts 5' --visual; do
  # shellcheck disable=SC2086
  refused progressive "$BRACKET" p.pm $option
done
expect 2 'unknown option --esilon; did you mean --epsilon' "$V" cover one.off three.off --esilon 1
expect 2 'unknown option --esilon; did you mean --epsilon' "$V" mesh --outer one.off three.off --esilon 1
expect 2 'unknown option --wrong (see bound-verify mesh --help)' "$V" mesh one.off three.off --inner --wrong

# A flag instead of a command: one error, which names the command.
instead() {
  command=$1
  shift
  expect 2 "a command is to come first: instead of $1, bound-verify $command" "$V" "$@"
  [ "$(wc -l <err.txt)" = 1 ] || fail "more than one line: $(cat err.txt)"
}
instead 'mesh --outer ORIGINAL RESULT' --outer one.off three.off
instead 'mesh --inner ORIGINAL RESULT' --inner three.off one.off --epsilon 2
instead 'cover ORIGINAL SET' --cover one.off three.off --prepare
instead 'robot ORIGINAL RESULT' --robot thin.urdf thick.urdf
instead 'sweep ROBOT PATH SWEPT' --sweep thin.urdf path.csv three.off
instead 'progressive ORIGINAL FILE' --progressive "$BRACKET" p.pm
expect 2 'instead of --cover, bound-verify cover ORIGINAL SET' "$V" one.off --quiet three.off --cover
expect 2 'instead of --cover, bound-verify cover ORIGINAL SET' "$V" mesh-a.off three.off --cover
refused mesh one.off three.off
refused mesh --outer --inner one.off three.off
refused mesh --outer one.off
refused cover one.off
refused robot thin.urdf
refused sweep thin.urdf path.csv
refused sweep thin.urdf path.csv three.off one.off
refused progressive p.pm
refused --quiet mesh --outer one.off three.off

# Files may be called like commands.
cp three.off cover
shows 0 '^verified$' "$V" mesh --outer one.off cover --approximation-format off
shows 1 '^refuted$' "$V" mesh --outer ./cover one.off --input-format off

# Each command's help: its own options and files.
shows 0 'bound-verify sweep ROBOT PATH SWEPT' "$V" --help
grep -qE -- '^ *--(cover|robot|sweep)' out.txt && fail "flags in the help: $(cat out.txt)"
for command in mesh cover robot sweep progressive; do
  for width in 80 100; do
    shows 0 'Exit codes' env COLUMNS=$width "$V" $command --help
    LC_ALL=C awk -v width=$width 'length > width' out.txt >wide.txt
    [ ! -s wide.txt ] || fail "wider than $width columns: $command: $(cat wide.txt)"
  done
  grep -q -- "Usage: bound-verify $command " out.txt || fail "usage of $command"
  case $command in
    sweep) grep -q -- '--gap' out.txt || fail 'no --gap' ;;
    *) if grep -q -- '--gap' out.txt; then fail "$command has --gap"; fi ;;
  esac
done
finish
