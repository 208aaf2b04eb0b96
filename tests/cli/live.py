#!/usr/bin/env python3
"""kaboum-plan run --live: a run that a client follows, clients that do not behave, and the page of a journal.

usage: live.py BIN
"""
import contextlib
import http.client
import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time

import jsonschema

TOOLS = pathlib.Path(sys.argv[1]).absolute()
ROOT = pathlib.Path(__file__).resolve().parents[2]
DRIVER = ROOT / "examples/drivers/driver.py"

# A driver that waits: for a file before its first line, and for another one before it senses.
GATED = """import pathlib, subprocess, sys, time
def wait(name):
    while not pathlib.Path(name).exists():
        time.sleep(0.01)
wait("go")
driver = subprocess.Popen(sys.argv[1:], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
print(driver.stdout.readline(), end="", flush=True)
for line in sys.stdin:
    if '"do":"sense"' in line:
        wait("sense")
    driver.stdin.write(line)
    driver.stdin.flush()
    print(driver.stdout.readline(), end="", flush=True)
"""


def fail(what):
    raise SystemExit(f"live.py: {what}")


class Run:
    """kaboum-plan run --live of a scenario's folder, while it goes on."""

    def __init__(self, folder, *more, driver="", live=("--live",), o1="true"):
        self.folder = folder
        for name in ("go", "sense", "journal.jsonl", "run.html", "report.json"):
            (folder / name).unlink(missing_ok=True)
        robot = f"{sys.executable} gated.py {sys.executable} {DRIVER} --sense 'isSpillable(o1)={o1}' --sense 'isSpillable(o2)=false' {driver}"
        self.process = subprocess.Popen(
            [TOOLS / "kaboum-plan", "run", "domain.kpl", "problem.kpl", "--scene", "cell.json", "--plan", "plan.json", "--quiet", "--robot", robot,
             "--robot-timeout", "60", "--journal", "journal.jsonl", "--report", "report.json", *live, *more],
            cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        line = self.process.stderr.readline()
        found = re.fullmatch(r"kaboum-plan: the run is shown at http://127\.0\.0\.1:(\d+)(/[0-9a-f]{32}/)\n", line)
        if not found:
            fail(f"no address: {line}{self.process.stderr.read()}")
        self.port, self.secret = int(found[1]), found[2]

    def allow(self, name):
        (self.folder / name).touch()

    def end(self, code=0, seconds=120):
        out, err = self.process.communicate(timeout=seconds)
        if self.process.returncode != code:
            fail(f"exit code {self.process.returncode}: {out}{err}")
        return json.loads((self.folder / "report.json").read_text())


class Follower:
    """A client of the events, as a browser is one."""

    def __init__(self, run, after=None):
        self.connection = http.client.HTTPConnection("127.0.0.1", run.port, timeout=60)
        self.connection.request("GET", run.secret + "events", headers={} if after is None else {"Last-Event-ID": str(after)})
        self.answer = self.connection.getresponse()
        if self.answer.status != 200 or self.answer.headers["Content-Type"] != "text/event-stream":
            fail(f"events: {self.answer.status}")
        self.run = None if after is None else after.split("-")[0]
        self.events, self.next = [], 1 if after is None else int(after.split("-")[1]) + 1

    def read(self):
        """One more; None: there are no more."""
        lines = []
        while line := self.answer.readline().decode():
            if line != "\n":
                lines.append(line)
                continue
            if lines == [":\n"]:
                lines = []
                continue
            self.run = self.run or lines[0][4:].split("-")[0]
            if len(lines) != 2 or lines[0] != f"id: {self.run}-{self.next}\n" or not lines[1].startswith("data: "):
                fail(f"an event is {lines}")
            self.next += 1
            self.events.append(json.loads(lines[1][6:]))
            return self.events[-1]
        return None

    def read_until(self, wanted):
        while (event := self.read()) is not None:
            if wanted(event):
                return event
        fail("the events ended before")


def get(run):
    connection = http.client.HTTPConnection("127.0.0.1", run.port, timeout=20)
    connection.request("GET", run.secret)
    answer = connection.getresponse()
    return answer, answer.read()


def raw(port, text, seconds=20):
    """What is answered to these bytes."""
    with socket.create_connection(("127.0.0.1", port), timeout=seconds) as s, contextlib.suppress(ConnectionResetError, BrokenPipeError):
        s.sendall(text)
        out = b""
        while part := s.recv(65536):
            out += part
        return out
    return b"reset"


def is_same_motion(shown, told, executed):
    """A thinned motion: points of the one that was told, both ends, at most 0.04 s apart or as far as those."""
    if executed:
        points = [(row[0], row[1:]) for row in told]
    else:
        points = [(p["time_from_start"], p["positions"]) for p in told["points"]]
    kept = {round(t, 6): [round(x, 6) for x in q] for t, q in points}
    times = shown["times"]
    if times[0] != round(points[0][0], 6) or times[-1] != round(points[-1][0], 6) or len(times) != len(shown["positions"]):
        return False
    far = max(b - a for a, b in zip(times, times[1:]))
    step = max(b[0] - a[0] for a, b in zip(points, points[1:]))
    return far <= 0.04 + step + 1e-6 and all(t in kept and max(abs(a - b) for a, b in zip(kept[t], q)) < 2e-6 for t, q in zip(times, shown["positions"]))


def same_as_journal(events, folder):
    """Event by event what the journal has, in its order."""
    lines = [json.loads(line) for line in (folder / "journal.jsonl").read_text().splitlines()]
    if len(lines) != len(events):
        fail(f"{len(events)} events, {len(lines)} lines of the journal")
    heard = 0
    for event, line in zip(events, lines):
        wanted = dict(line)
        for key in ("told", "heard"):
            if key not in line:
                continue
            inner = json.loads(line[key])
            for part in ("trajectory", "executed"):
                if part in inner:
                    if not is_same_motion(event[key][part], inner[part], part == "executed"):
                        fail(f"a motion is shown otherwise: {str(event)[:300]}")
                    inner[part] = event[key][part]
                    heard += part == "executed"
            wanted[key] = inner
        if "graph" in wanted:
            graph = wanted.pop("graph")
            reached = {graph["root"]}
            while more := {e["to"] for n in reached for e in graph["nodes"][n]["next"]} - reached - {None}:
                reached |= more
            for number, node in enumerate(graph["nodes"]):
                if (f'id="node-{number}"' in event["svg"]) != (number in reached) or (number in reached and node["text"] not in event["svg"]):
                    fail(f"node {number} is drawn otherwise")
            wanted["svg"] = event["svg"]
        if event != wanted:
            fail(f"event and journal differ:\n{str(event)[:500]}\n{str(wanted)[:500]}")
    return heard


def follows_plan(events, plan, report):
    """Steps are those of the plan's graph by what is sensed; what is known changes with it; why it is planned again is said."""
    known, node, sensed, replans = set(), plan["root"], {}, []
    for event in events:
        for fact in event.get("gone", []):
            known.remove(fact)
        known.update(event.get("learned", []))
        if "step" in event:
            if event["plan"] == 0 and event["node"] != node:
                fail(f"the plan is at node {node}, and the event is {event}")
            if event["action"] and plan_action(plan, event) != event["action"].split("(")[0]:
                fail(f"another action: {event}")
        if "told" in event and event["told"]["do"] == "sense":
            fact = event["told"]["fact"]
            if fact in known or f"!{fact}" in known:
                fail(f"{fact} is known before it is sensed")
            asked = fact
        if "heard" in event and "sensed" in event["heard"]:
            sensed[asked] = event["heard"]["sensed"]
        if "step_done" in event:
            for fact, value in sensed.items():
                if (fact if value == "true" else f"!{fact}") not in known:
                    fail(f"{fact} was sensed to be {value}, and is not known after {event}")
            if event["next"] is not None:
                node = event["next"]
        if "replanning" in event:
            replans.append(event["replanning"])
            if replans[-1]["outcome"] not in known:
                fail(f"planned again without a reason: {event}")
        if "replanned" in event:
            if event["replanned"]["status"] != "solved" or event["replanned"]["plan"] != len(replans):
                fail(f"a new plan: {event}")
            node = None
    if [(r["outcome"], r["actions_before"], r["after_plan"]) for r in replans] != [(r["outcome"], r["actions_before"], r["after_plan"]) for r in report["replans"]]:
        fail(f"planned again: {replans}, {report['replans']}")
    return sensed, replans


def plan_action(plan, event):
    return plan["nodes"][event["node"]]["action"] if event["plan"] == 0 else event["action"].split("(")[0]


def keeps_schema(folder):
    """Entries of the journal are those of the schema, and none that has more or less is."""
    schema = json.loads((ROOT / "docs/journal.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    check = jsonschema.Draft202012Validator(schema)
    for line in (folder / "journal.jsonl").read_text().splitlines():
        entry = json.loads(line)
        for error in check.iter_errors(entry):
            fail(f"{line[:300]}: {error.message[:300]}")
        optional = {"q", "objects", "learned", "gone", "unplanned", "why"}
        for key in entry:
            if key not in optional and check.is_valid({k: v for k, v in entry.items() if k != key}):
                fail(f"{line[:200]} would do without '{key}'")
        if check.is_valid({**entry, "another": 1}):
            fail(f"{line[:200]} may have anything")


def refuses(run):
    """Requests that are none of a browser on this page."""
    port, secret = run.port, run.secret.encode()
    page, events = b"GET " + secret + b" HTTP/1.1\r\n", b"GET " + secret + b"events HTTP/1.1\r\n"
    other = secret[:-2] + (b"0" if secret[-2:-1] != b"0" else b"1") + b"/"
    host = f"Host: 127.0.0.1:{port}\r\n".encode()
    for text, status in (
            (page + host + b"\r\n", 200), (page + b"hOsT:   localhost:%d \r\n\r\n" % port, 200),
            (b"HEAD " + secret + b"events HTTP/1.1\r\n" + host + b"\r\n", 200),
            (page + b"\r\n", 400), (page + 2 * host + b"\r\n", 400),
            (page + b"Host: evil.example:%d\r\n\r\n" % port, 421), (page + b"Host: 127.0.0.1\r\n\r\n", 421),
            (events + b"Host: evil.example\r\n\r\n", 421), (page + b"Host: 127.0.0.1:%d.evil.example\r\n\r\n" % port, 421),
            (events + host + b"Origin: http://evil.example\r\n\r\n", 403), (page + host + b"Origin: null\r\n\r\n", 403),
            (b"POST " + secret + b" HTTP/1.1\r\n" + host + b"\r\n", 405), (b"OPTIONS " + secret + b"events HTTP/1.1\r\n" + host + b"\r\n", 405),
            (b"POST " + secret + b" HTTP/1.1\r\n" + host + b"Content-Length: 3\r\n\r\nabc", 400), (page + host + b"Transfer-Encoding: chunked\r\n\r\n", 400),
            (b"GET /../../etc/passwd HTTP/1.1\r\n" + host + b"\r\n", 404), (b"GET " + secret + b"events? HTTP/1.1\r\n" + host + b"\r\n", 404),
            (b"GET http://127.0.0.1/ HTTP/1.1\r\n" + host + b"\r\n", 400), (b"GET * HTTP/1.1\r\n" + host + b"\r\n", 400),
            (b"GET / HTTP/1.0\r\n" + host + b"\r\n", 505), (b"GET / HTTP/2.0\r\n" + host + b"\r\n", 505), (b"GET /\r\n" + host + b"\r\n", 400),
            (page + b" folded: x\r\n" + host + b"\r\n", 400), (page + b"no colon\r\n" + host + b"\r\n", 400),
            (page + b"X : y\r\n" + host + b"\r\n", 400), (page + b"X: \x00\r\n" + host + b"\r\n", 400),
            (events + host + b"Last-Event-ID: -1\r\n\r\n", 400),
            (events + host + b"Last-Event-ID: another-2\r\n\r\n", 204),
            (events + host + b"Sec-Fetch-Site: cross-site\r\n\r\n", 403), (b"GET /\xff HTTP/1.1\r\n" + host + b"\r\n", 400),
            # Who does not know the address gets nothing, and is not told what is wrong with it.
            *((b"GET " + path + b" HTTP/1.1\r\n" + host + b"\r\n", 404) for path in (
                b"/", b"/events", secret[:-1], secret[:-2] + b"/", other, other + b"events", secret.upper(), b"/" + secret, secret + b"/", b"/" + secret + b"events")
              if path != secret),
            (b"\r\n\r\n", 400), (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n", 400), (b"GET / HTTP/1.1\n" + host + b"\n\r\n\r\n", 400),
            (page + host + b"X: " + 8192 * b"a" + b"\r\n\r\n", 431), (70000 * b"a", 431),
            (page + host + 4000 * b"a: b\r\n" + b"\r\n", 431)):
        answer = raw(port, text)
        if answer != b"reset" and not answer.startswith(f"HTTP/1.1 {status} ".encode()):
            fail(f"{text[:200]}: {answer[:200]}, not {status}")
        if answer == b"reset" and len(text) < 8192:
            fail(f"{text[:200]}: reset")
    if b"\r\n\r\n" not in raw(port, b"HEAD " + secret + b" HTTP/1.1\r\n" + host + b"\r\n") or raw(port, b"HEAD " + secret + b" HTTP/1.1\r\n" + host + b"\r\n").split(b"\r\n\r\n", 1)[1]:
        fail("HEAD has a body")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name) / "fs"
        environment = dict(os.environ, KABOUM_BIN=str(TOOLS), KABOUM_CACHE=str(pathlib.Path(name) / "cache"))
        made = subprocess.run([ROOT / "examples/scenarios/force-sensing/run", "2", "--plan-only", "--out", folder], env=environment, capture_output=True, text=True)
        if made.returncode != 0:
            fail(f"no plan: {made.stderr[-500:]}")
        (folder / "domain.kpl").write_text((ROOT / "examples/scenarios/force-sensing/domain.kpl").read_text())
        (folder / "gated.py").write_text(GATED)
        plan = json.loads((folder / "plan.json").read_text())
        branch = next(n["branch"] for n in plan["nodes"] if n.get("branch", {}).get("arguments") == ["o1"])
        branch["cases"] = [c for c in branch["cases"] if c["value"] is False]
        (folder / "plan.json").write_text(json.dumps(plan))

        # A run that is followed while it goes on, and planned again.
        run = Run(folder, "--page", "run.html", driver="--stray 0.001")
        addresses = [line.split()[1] for line in pathlib.Path("/proc/net/tcp").read_text().splitlines()[1:] if line.split()[3] == "0A"]
        if [a for a in addresses if int(a.split(":")[1], 16) == run.port] != [f"0100007F:{run.port:04X}"]:
            fail(f"port {run.port} is heard at {addresses}")
        answer, page = get(run)
        if answer.status != 200 or "text/html" not in answer.headers["Content-Type"] or len(page) != int(answer.headers["Content-Length"]):
            fail(f"the page: {answer.status}")
        if "default-src 'none'" not in answer.headers["Content-Security-Policy"] or "connect-src 'self'" not in answer.headers["Content-Security-Policy"]:
            fail("the page may ask others")
        if b'"events"' in page.split(b'id="data"')[1].split(b"</script>")[0]:
            fail("the live page has events")
        follower = Follower(run)
        secrets = {run.secret}
        run.allow("go")
        follower.read_until(lambda e: "told" in e and e["told"]["do"] == "sense")
        if run.process.poll() is not None or (folder / "report.json").exists():
            fail("what is sensed is seen when the run is over")
        refuses(run)
        late = Follower(run)  # who comes later gets all as well
        middle = Follower(run, after=f"{follower.run}-{len(follower.events) - 2}")
        run.allow("sense")
        for client in (follower, late):
            client.read_until(lambda e: "verdict" in e)
        report = run.end()
        if follower.read() is not None or late.events != follower.events:
            fail("events after the last one, or others for who came later")
        middle.read_until(lambda e: "verdict" in e)
        if middle.events != follower.events[-len(middle.events):] or len(middle.events) >= len(follower.events):
            fail("who goes on after an event gets others")
        if same_as_journal(follower.events, folder) < 3:
            fail("how joints moved is not shown")
        sensed, replans = follows_plan(follower.events, plan, report)
        if sensed != {"isSpillable(o1)": "true", "isSpillable(o2)": "false"} or [r["outcome"] for r in replans] != ["isSpillable(o1)"]:
            fail(f"sensed {sensed}, planned again {replans}")
        keeps_schema(folder)

        # The page as a file: at the end of the run, and from its journal.
        done = subprocess.run([TOOLS / "kaboum-plan", "page", "journal.jsonl", "--scene", "cell.json", "-o", "again.html", "--quiet"], cwd=folder, capture_output=True, text=True)
        if done.returncode != 0 or (folder / "again.html").read_bytes() != (folder / "run.html").read_bytes():
            fail(f"the journal's page is another one: {done.stderr}")
        data = json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', (folder / "run.html").read_text(), re.DOTALL)[1])
        if data["events"] != follower.events:
            fail("the page has other events")
        if node := shutil.which("node"):
            played = subprocess.run([node, ROOT / "tests/cli/play_run.js", "run.html", ROOT / "libpage/src"], cwd=folder, capture_output=True, text=True)
            if played.returncode != 0:
                fail(f"the page: {played.stderr}")
            said = json.loads(played.stdout)
            again = [row for row in said["rows"] if row[1] == "plans again"]
            if said["events"] != len(follower.events) or said["verdict"] != "good" or said["ended"]["kind"] != "goal" or len(again) != 1 or \
                    "isSpillable(o1), and the plan has no branch for that" not in again[0][2] or "a new plan of" not in again[0][2]:
                fail(f"the page shows {said}")
        # Lines that no run wrote do no harm, and no drawing but the program's own is shown.
        lines = (folder / "journal.jsonl").read_text().splitlines()
        lines[3:3] = ['{"plan":1,"svg":"<img src=x onerror=alert(1)>","graph":{"root":0,"nodes":[{"text":"</script><b>","branches":false,"next":[{"to":null,"if":""}]}]}}',
                      '{"plan":2,"svg":"<img src=x onerror=alert(1)>"}', '{"plan":3,"graph":{"root":7,"nodes":[]}}', '{"told":"{\\"do\\":\\"move\\",\\"trajectory\\":7}"}',
                      '{"heard":"' + 70 * "[" + '"}', '{"plan":4,"graph":{"root":0,"nodes":[{"text":"a","branches":false,"next":[{"to":0,"if":""}]}]}}']
        (folder / "hostile.jsonl").write_text("\n".join(lines) + "\n")
        done = subprocess.run([TOOLS / "kaboum-plan", "page", "hostile.jsonl", "--scene", "cell.json", "-o", "hostile.html", "--quiet"], cwd=folder, capture_output=True, text=True)
        text = (folder / "hostile.html").read_text()
        if done.returncode != 0 or "alert(1)" in text or text.count("</script>") != (folder / "run.html").read_text().count("</script>") or text.count('{"unread":true}') != 3:
            fail(f"a hostile journal: exit code {done.returncode}: {done.stderr}: {text.count(chr(123) + chr(34) + 'unread')}")
        for text in ("", "{}\n", '{"kaboum_journal":1}\n[]\n', '{"kaboum_journal":1}\n' + 100 * "[" + "\n"):
            (folder / "bad.jsonl").write_text(text)
            done = subprocess.run([TOOLS / "kaboum-plan", "page", "bad.jsonl", "--scene", "cell.json", "-o", "bad.html"], cwd=folder, capture_output=True, text=True)
            if done.returncode != 3 or "bad.jsonl, line" not in done.stderr or (folder / "bad.html").exists():
                fail(f"no journal: exit code {done.returncode}: {done.stderr}")
        done = subprocess.run([TOOLS / "kaboum-plan", "page", "journal.jsonl", "--scene", "cell.json", "-o", "cell.json"], cwd=folder, capture_output=True, text=True)
        if done.returncode != 2:
            fail(f"a page over the scene: exit code {done.returncode}")

        # Clients that hang, are slow, or come in crowds: the run does not wait, and who behaves is served when they are cut off.
        started = time.monotonic()
        run = Run(folder, "--blend", "0.5", o1="false")  # nothing is planned again
        hosts = f"Host: 127.0.0.1:{run.port}\r\n\r\n".encode()
        hanging = []
        for _ in range(40):  # follow, and take nothing
            s = socket.socket()
            s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1024)
            s.connect(("127.0.0.1", run.port))
            s.sendall(f"GET {run.secret}events HTTP/1.1\r\n".encode() + hosts)
            hanging.append(s)
        for k in range(100):  # half a request, or nothing at all
            s = socket.create_connection(("127.0.0.1", run.port))
            with contextlib.suppress(OSError):
                s.sendall(b"GET / HTTP/1.1\r\nHost" if k % 2 else b"")
            hanging.append(s)
        if not raw(run.port, b"GET / HTTP/1.1\r\n" + hosts).startswith((b"HTTP/1.1 503 ", b"reset")):
            fail("more connections than there may be")
        run.allow("go")
        run.allow("sense")
        report = run.end()
        took = time.monotonic() - started
        mean = report["driver"]["wall_seconds_between"] / report["driver"]["messages"]
        if report["driver"]["end"] != "goal" or mean > 0.001 or report["driver"]["wall_seconds"] > took:
            fail(f"hanging clients: {report['driver']}")
        for s in hanging:
            s.close()
        secrets.add(run.secret)
        run = Run(folder)
        if len(secrets | {run.secret}) != 3:
            fail(f"an address is that of another run: {run.secret}")
        crowd = [socket.create_connection(("127.0.0.1", run.port)) for _ in range(64)]
        crowd[0].sendall(b"GET / HTT")
        time.sleep(0.2)
        if not raw(run.port, b"GET / HTTP/1.1\r\nHost: 127.0.0.1:%d\r\n\r\n" % run.port).startswith((b"HTTP/1.1 503 ", b"reset")):
            fail("more connections than there may be")
        time.sleep(6)  # until they are cut off
        if get(run)[0].status != 200 or not crowd[0].recv(100).startswith(b"HTTP/1.1 408 "):
            fail("half a request is waited for")

        # A port that is in use: nothing is moved. What is no port, or no robot to be followed.
        before = (folder / "journal.jsonl").read_text()
        for more, code, word in (((f"--live={run.port}",), 4, f"port {run.port} of 127.0.0.1 cannot be served: another program uses it"),
                                 (("--live=65536",), 2, "expected a port"), (("--live=-1",), 2, "expected a port"), (("--live=x",), 2, "expected a port")):
            done = subprocess.run([TOOLS / "kaboum-plan", "run", "domain.kpl", "problem.kpl", "--scene", "cell.json", "--plan", "plan.json", "--robot", "touch started; cat",
                                   "--journal", "other.jsonl", *more], cwd=folder, capture_output=True, text=True)
            if done.returncode != code or word not in done.stderr or (folder / "started").exists() or (folder / "other.jsonl").exists():
                fail(f"{more}: exit code {done.returncode}: {done.stderr}")
        for more, word in ((("--live",), "--live is of a robot's program"), (("--page", "x.html"), "--page is of a robot's program"),
                           (("--replay-journal", "journal.jsonl", "--live-linger", "1"), "--live-linger is of --live")):
            done = subprocess.run([TOOLS / "kaboum-plan", "run", "domain.kpl", "problem.kpl", "--scene", "cell.json", "--plan", "plan.json", *more], cwd=folder,
                                  capture_output=True, text=True)
            if done.returncode != 2 or word not in done.stderr:
                fail(f"{more}: exit code {done.returncode}: {done.stderr}")
        run.process.kill()
        run.process.communicate()
        for s in crowd:
            s.close()
        del before

        # The page stays for a while after the run; a run that stops says why; a repeated run is followed as well.
        run = Run(folder, "--live-linger", "3", driver="--faults 1 --late 0", live=("--live=0",))
        run.allow("go")
        run.allow("sense")
        while not (folder / "report.json").exists():
            time.sleep(0.02)
        follower = Follower(run)
        follower.read_until(lambda e: "verdict" in e)
        if not any("stopped" in e and e["why"] for e in follower.events):
            fail(f"nothing says why it stopped: {follower.events[-3:]}")
        run.end(code=1)
        print(f"{len(data['events'])} events; with 140 clients that hang {1000 * mean:.2f} ms from an answer to what is told next")


if __name__ == "__main__":
    main()
