# shellcheck shell=sh disable=SC2154
# What a robot's run says on a terminal page, and what a signal leaves of it.
. "$(dirname "$0")/common.sh"
D=$BIN/bcd-decompose
S=$BIN/bmesh-decimate
V=$BIN/bound-verify
KABOUM_CACHE=$WORK/cache
export KABOUM_CACHE

# A robot of 40 links: meshes, some of them open or empty, and boxes.
mkdir -p m
tetrahedron >m/t.off
cp "$BRACKET" m/bracket.obj
printf 'OFF\n8 5 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n4 0 3 2 1\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n' >m/open.off
printf 'solid x\nendsolid x\n' >m/empty.stl
python3 - >many.urdf <<'END'
print('<robot name="many"><link name="base"/>')
for i in range(40):
    name = f"a_link_with_a_name_that_is_so_long_that_no_table_has_a_place_for_it_{i}"
    shape = ['<box size="0.1 0.2 0.3"/>', '<mesh filename="m/t.off"/>', '<mesh filename="m/open.off" scale="0.5 0.5 0.5"/>', '<mesh filename="m/bracket.obj"/>'][i % 4]
    if i in (8, 9):
        shape = '<mesh filename="m/empty.stl"/>'
    other = '<visual><geometry><box size="1 1 1"/></geometry></visual>' if i % 5 == 0 else ""
    print(f'<link name="{name}">{other}<collision><geometry>{shape}</geometry></collision><collision><geometry><cylinder radius="0.1" length="0"/></geometry></collision></link>')
    print(f'<joint name="j{i}" type="revolute"><parent link="base"/><child link="{name}"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>')
print("</robot>")
END
for tool in "$D" "$S"; do
  expect 1 'NOT every triangle is known to be inside: 2 of 40 links are not held' "$tool" many.urdf -o out --epsilon 4cm --effort fast --report r.json
  [ "$(wc -l <err.txt)" -le 24 ] || fail "more than a terminal page: $(wc -l <err.txt) lines: $(cat err.txt)"
  # Both links that are not held are in the table and named in words; what is left out is counted.
  [ "$(grep -c ' NOT held$' err.txt)" = 2 ] || fail "not both in the table: $(cat err.txt)"
  grep -q "^links '.*_8' and '.*_9': NOT enclosed" err.txt || fail "no sentence about the two: $(cat err.txt)"
  grep -q '^30 others ' err.txt || fail "the others are not counted: $(cat err.txt)"
  grep -q '^from the files alone: bound-verify robot many.urdf out/many.urdf' err.txt || fail "no command: $(cat err.txt)"
  grep -q 'and 3[0-9] more such notes: --verbose prints them' err.txt || fail "flat shapes: $(cat err.txt)"
  # The table fits 80 columns, and its sums are those of the report.
  python3 - <<'END' || fail "table: $(cat err.txt)"
import json, re
lines = open("err.txt").read().splitlines()
table = lines[:next(i for i, line in enumerate(lines) if line[:1].isdigit()) + 1]
assert all(len(line) <= 80 for line in table) and len(table) == 12, table
report = json.load(open("r.json"))
cells = [re.split(r"  +", line) for line in table]
sums = [sum(0 if row[i] == "-" else int(row[i]) for row in cells[1:]) for i in (1, 2)]
# Meshes of several links are counted once by bmesh-decimate.
assert report["tool"] == "bmesh-decimate" or sums == [report["bodies"], report["vertices"]], (sums, cells)
assert all("40 mm" in row for row in cells[1:-1]), cells
assert report["notes"], "no notes"
END
  expect 1 ' more such notes' "$tool" many.urdf -o out --epsilon 4cm --effort fast
  expect 1 'm/bracket.obj: .* vertices' "$tool" many.urdf -o out --epsilon 4cm --effort fast --verbose
  [ "$(grep -c 'cylinder of length 0' err.txt)" = 40 ] || fail "--verbose leaves notes out"
  "$tool" many.urdf -o out --epsilon 4cm --effort fast --quiet >out.txt 2>err.txt
  [ $? = 1 ] && [ ! -s err.txt ] || fail "--quiet says: $(cat err.txt)"
  rm -rf out
done
expect 2 'for robots' "$D" m/t.off -o x.glb --verbose
# A wrong unit is seen, once.
echo '<robot name="a"><link name="l"><collision><geometry><mesh filename="m/bracket.obj"/></geometry></collision></link></robot>' >arm0.urdf
expect 0 'WARNING: epsilon is 4, ' "$D" many.urdf -o out --epsilon 4 --effort fast --links "$(
  for i in 1 2 5 6; do printf 'a_link_with_a_name_that_is_so_long_that_no_table_has_a_place_for_it_%s,' $i; done | sed 's/,$//')"
[ "$(grep -c 'WARNING: epsilon' err.txt)" = 2 ] || fail "warnings: $(cat err.txt)"
expect 0 'm/bracket.obj: WARNING: epsilon is 4, ' "$S" arm0.urdf -o large --epsilon 4

# Ctrl-C: what is done is kept, nothing is in the folder, the same command goes on and makes the same bytes.
mkdir parts
python3 - "$BRACKET" <<'END'
import sys
lines = open(sys.argv[1]).read().splitlines()
for i in range(1, 6):  # other shapes each: the cache has nothing of the next one
    with open(f"parts/p{i}.obj", "w") as out:
        for line in lines:
            if line.startswith("v "):
                x, y, z = map(float, line.split()[1:4])
                line = f"v {x * (1 + 0.1 * i)!r} {y!r} {z * (1 + 0.05 * i)!r}"
            print(line, file=out)
with open("arm.urdf", "w") as out:
    print('<robot name="arm"><link name="l0"/>', file=out)
    for i in range(1, 6):
        print(f'<link name="l{i}"><collision><geometry><mesh filename="parts/p{i}.obj"/></geometry></collision></link>'
              f'<joint name="j{i}" type="fixed"><parent link="l{i - 1}"/><child link="l{i}"/></joint>', file=out)
    print("</robot>", file=out)
END
for kind in folder spheres; do
  rm -rf cache
  python3 - "$D" $kind <<'END' || fail "a signal, $kind"
import os, pathlib, signal, subprocess, sys, time
program, kind = sys.argv[1:]
out = "stopped" if kind == "folder" else "stopped.yaml"
command = [program, "arm.urdf", "-o", out, "--effort", "fast"] + (["--epsilon", "1%"] if kind == "folder" else ["--epsilon", "10%", "--bodies", "spheres"])
for what in (signal.SIGINT, signal.SIGTERM):
    before = len(list(pathlib.Path("cache").glob("*.set")))
    run = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    while run.poll() is None and len(list(pathlib.Path("cache").glob("*.set"))) <= before:
        time.sleep(0.002)
    time.sleep(0.05)
    run.send_signal(what)
    said = run.communicate()[1]
    assert run.returncode == -what, (run.returncode, said)
    assert "ended by a signal; " in said and "of 5 meshes" in said and "The cache keeps them: the same command goes on there" in said, said
    assert not os.path.exists(out), os.listdir()
done = subprocess.run(command, stderr=subprocess.PIPE, text=True)
assert done.returncode == 0 and (kind != "folder" or "from the cache" in done.stderr), done.stderr
assert [name for name in os.listdir() if ".tmp" in name] == []
END
done
expect 0 '' "$D" arm.urdf -o whole --epsilon 1% --effort fast --no-cache --threads 1
diff -r stopped whole >diff.txt || fail "another result after signals: $(cat diff.txt)"
python3 - "$D" <<'END' || fail "a signal without a cache"
import signal, subprocess, sys, time
run = subprocess.Popen([sys.argv[1], "arm.urdf", "-o", "none", "--epsilon", "0.1%", "--no-cache"], stderr=subprocess.PIPE, text=True)
time.sleep(0.3)
run.terminate()
said = run.communicate()[1]
assert run.returncode == -signal.SIGTERM and "Nothing is kept (--no-cache)" in said, said
quiet = subprocess.Popen([sys.argv[1], "arm.urdf", "-o", "none", "--epsilon", "0.1%", "--no-cache", "--quiet"], stderr=subprocess.PIPE, text=True)
time.sleep(0.3)
quiet.terminate()
assert quiet.communicate()[1] == "" and quiet.returncode == -signal.SIGTERM
END
absent none
# A budget: what is looked for is said at once, and when a signal ends it.
for kind in polytopes spheres; do
  python3 - "$D" $kind <<'END' || fail "a budget, $kind"
import os, signal, subprocess, sys, time
program, kind = sys.argv[1:]
out = "budget.yaml" if kind == "spheres" else "budget"
command = [program, "arm.urdf", "-o", out, "--bodies", kind, "--robot-bodies", "60"]
words = "looking for the least epsilon with no more than 60 " + ("spheres" if kind == "spheres" else "bodies")
for what in (signal.SIGINT, signal.SIGTERM):
    for more in ([], ["--no-cache"]):
        run = subprocess.Popen(command + more, stderr=subprocess.PIPE, text=True, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        line = run.stderr.readline()
        assert line.startswith(words), line
        time.sleep(0.2)
        run.send_signal(what)
        said = run.communicate()[1]
        assert run.returncode == -what, (run.returncode, said)
        assert "bcd-decompose: ended by a signal while it was " + words + "; nothing is written. " in said, said
        assert ("--no-cache" if more else "The cache keeps") in said, said
        assert not os.path.exists(out) and not [name for name in os.listdir() if ".tmp" in name], os.listdir()
END
done
# On a terminal: which mesh, what is left, and no line longer than the window.
python3 - "$D" <<'END' || fail "progress on a terminal"
import fcntl, os, pty, re, struct, sys, termios
columns = 50
pid, terminal = pty.fork()
if pid == 0:
    os.execv(sys.argv[1], [sys.argv[1], "arm.urdf", "-o", "shown", "--epsilon", "1%", "--effort", "fast", "--no-cache"])
fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
said = b""
while True:
    try:
        part = os.read(terminal, 65536)
    except OSError:
        break
    if not part:
        break
    said += part
assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 0
lines = [line for line in re.split(r"\r|\n", re.sub(r"\x1b\[K", "", said.decode())) if line.startswith(tuple("12345")) and " of 5 meshes: " in line]
assert lines and all(len(line) < columns for line in lines[3:]), lines
assert any(re.match(r"4 of 5 meshes: p4.obj: ", line) for line in lines), lines
END
finish
