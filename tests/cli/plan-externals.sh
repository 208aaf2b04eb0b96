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
broken fickle <<'END'
n=$((n + 1)); echo "{\"value\": \"q$n\"}"
END
for case in 'crash:signal 11' 'leave:exit code 3' 'nonsense:no JSON' 'both:one of' 'number:is no text' 'absent:no function of that name' \
  'flood:more than 16 MiB'; do
  name=${case%%:*}
  expect 3 "${case#*:}" "$P" solve "$E/shelf.kpl" --process "sh $name.program" -o none.json
  grep -q "external function 'reach(o1)'\|external function 'isBox(p1)'" err.txt || fail "$name: the function is not named: $(cat err.txt)"
done
expect 7 'no answer within' "$P" solve "$E/shelf.kpl" --process 'sh slow.program' --process-timeout 0.3 -o none.json
grep -q "external function 'reach(o1)'\|external function 'isBox(p1)'" err.txt || fail "slow: the function is not named: $(cat err.txt)"
pgrep -f 'sh slow.program' >/dev/null && fail "the slow program still runs"
expect 3 'no JSON' "$P" solve "$E/shelf.kpl" --process 'echo hello' -o none.json
expect 3 'its first line' "$P" solve "$E/shelf.kpl" --process 'echo 7' -o none.json
expect 3 'its first line' "$P" solve "$E/shelf.kpl" --process 'echo {}' -o none.json
expect 3 'exit code 127' "$P" solve "$E/shelf.kpl" --process 'no-such-program-at-all' -o none.json
[ ! -e none.json ] || fail "a plan was written"
finish
