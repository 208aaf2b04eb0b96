# shellcheck shell=sh disable=SC2154
# kaboum-plan with external functions of other programs: good ones, and every way to be broken.
HERE=$(cd "$(dirname "$0")" && pwd)
. "$HERE/common.sh"
E=$HERE/../../examples/externals
P=$BIN/kaboum-plan
expect 0 solved "$P" solve "$E/shelf.kpl" --process "python3 $E/shelf.py" -o plan.json
shows 0 valid "$P" check "$E/shelf.kpl" --process "python3 $E/shelf.py" --plan plan.json
grep -q '"value": "over p2"' plan.json || fail "o2 is not reached: $(cat plan.json)"
grep -q 'waypoints' plan.json || fail "the payload is not kept"
# o1 has to go first: the program has read where it is.
[ "$(grep -c '"action": "grasp"' plan.json)" = 2 ] || fail "not two grasps"
grep -A2 -m1 '"action": "grasp"' plan.json | grep -q o1 || fail "o2 was reached through o1"
if [ -e "$BIN/../examples/shelf.so" ]; then
  expect 0 solved "$P" solve "$E/shelf.kpl" --plugin "$BIN/../examples/shelf.so" -o plugin.json
  cmp -s plan.json plugin.json || shows 0 valid "$P" check "$E/shelf.kpl" --process "python3 $E/shelf.py" --plan plugin.json
  expect 3 'bound twice' "$P" solve "$E/shelf.kpl" --plugin "$BIN/../examples/shelf.so" --process "python3 $E/shelf.py" -o none.json
fi
expect 3 'cannot be loaded' "$P" solve "$E/shelf.kpl" --plugin ./nothing.so -o none.json

# broken NAME: a program whose reach answers with the shell commands on stdin.
broken() {
  cat >"$1.sh"
  {
    echo "echo '{\"kaboum_externals\": 1, \"functions\": [\"reach\", \"isBox\"]}'"
    echo 'while read -r line; do'
    cat "$1.sh"
    echo 'done'
  } >"$1.program"
}
broken crash <<'END'
kill -SEGV $$
END
broken leave <<'END'
exit 3
END
broken nonsense <<'END'
echo 'hello, world'
END
broken both <<'END'
echo '{"value": "q", "holds": true}'
END
broken number <<'END'
echo '{"value": 7}'
END
broken absent <<'END'
echo '{"read": "colour", "arguments": ["o1"]}'; read -r line
END
broken slow <<'END'
sleep 60
END
broken flood <<'END'
yes | head -c 40000000 | tr -d '\n'
END
broken deep <<'END'
python3 -c 'print("{\"value\": \"q\", \"payload\": " + "[" * 100000 + "]" * 100000 + "}")'
END
broken fickle <<'END'
n=$((n + 1)); echo "{\"value\": \"q$n\"}"
END
for case in 'crash:signal 11' 'leave:exit code 3' 'nonsense:no JSON' 'both:one of' 'number:is no text' 'absent:no function of that name' \
  'flood:more than 16 MiB' 'deep:more than 64 lists and objects in each other'; do
  name=${case%%:*}
  expect 3 "${case#*:}" "$P" solve "$E/shelf.kpl" --process "sh $name.program" -o none.json
  grep -q "external function 'reach(o1)'\|external function 'isBox(p1)'" err.txt || fail "$name: the function is not named: $(cat err.txt)"
done
expect 7 'no answer within' "$P" solve "$E/shelf.kpl" --process 'sh slow.program' --process-timeout 0.3 -o none.json
grep -q "external function 'reach(o1)'\|external function 'isBox(p1)'" err.txt || fail "slow: the function is not named: $(cat err.txt)"
pgrep -f 'sh slow.program' >/dev/null && fail "the slow program still runs"
# Programs of arguments alone find something later as well.
cat >later.kpl <<'END'
domain later
types: object
constants: object o1
predicates: done(object)
externals: isBox(object)
action go(?o : object)
  preconds: extern(isBox(?o))
  effects: add(Kf, done(?o))
init: K(!done(o1))
goal: K(done(o1))
END
for list in functions of_arguments; do
  {
    echo "echo '{\"kaboum_externals\": 1, \"$list\": [\"isBox\"]}'"
    # shellcheck disable=SC2016
    echo 'while read -r q; do case $q in *\"attempt\":2*) echo "{\"holds\": true}";; *) echo "{\"not_found\": \"none yet\"}";; esac; done'
  } >later.program
  expect 0 solved "$P" solve later.kpl --process 'sh later.program' -o later.json
  shows 0 valid "$P" check later.kpl --process 'sh later.program' --plan later.json
  sed 's/attempt\\":2/attempt\\":99/' later.program >never.program
  expect 7 'isBox(o1): none yet' "$P" solve later.kpl --process 'sh never.program' -o none.json --explain
  grep -q 'none yet' err.txt || fail "$list: no reason: $(cat err.txt)"
done
# A planner that is killed leaves nothing behind.
"$P" solve later.kpl --process 'sleep 86399 & sleep 86398' --process-timeout 600 -o none.json 2>killed.txt &
planner=$!
tries=0
while ! pgrep -xf 'sleep 86398' >/dev/null && [ $tries -lt 300 ]; do
  sleep 0.1
  tries=$((tries + 1))
done
pgrep -xf 'sleep 86398' >/dev/null || fail "the program was not started: $(cat killed.txt)"
kill -9 $planner
tries=0
while pgrep -xf 'sleep 8639[89]' >/dev/null && [ $tries -lt 300 ]; do
  sleep 0.1
  tries=$((tries + 1))
done
pgrep -xf 'sleep 8639[89]' >/dev/null && fail "the program outlives the planner"
expect 3 'no JSON' "$P" solve "$E/shelf.kpl" --process 'echo hello' -o none.json
expect 3 'its first line' "$P" solve "$E/shelf.kpl" --process 'echo 7' -o none.json
expect 3 'its first line' "$P" solve "$E/shelf.kpl" --process 'echo {}' -o none.json
expect 3 'exit code 127' "$P" solve "$E/shelf.kpl" --process 'no-such-program-at-all' -o none.json
[ ! -e none.json ] || fail "a plan was written"
finish
