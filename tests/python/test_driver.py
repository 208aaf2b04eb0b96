"""Robot drivers as a class: what methods are called for what is told, what is answered, how a run ends."""

import io
import json
import pathlib
import subprocess
import sys
import time

import pytest
from kaboum.driver import Driver, Failure, Motion

BEGIN = {"do": "begin", "robots": {"arm": {"joint_names": ["a", "b"], "q": [0.0, 1.0]}},
         "objects": {"o1": {"pose": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]}, "o2": {"held_by": "arm"}}}


def curve(t):
    """Values, velocities, accelerations of two joints at a time from 0 to 1, from rest to rest."""
    s, v, a = 10 * t**3 - 15 * t**4 + 6 * t**5, 30 * t**2 * (1 - t) ** 2, 60 * t * (1 - t) * (1 - 2 * t)
    return [s, 1 - 2 * s], [v, -2 * v], [a, -2 * a]


def trajectory(count=10):
    points = [dict(zip(("positions", "velocities", "accelerations"), curve(k / count)), time_from_start=k / count) for k in range(count + 1)]
    return {"joint_names": ["a", "b"], "points": points}


class Recorder(Driver):
    def __init__(self):
        super().__init__()
        self.calls = []

    def begin(self, robots, objects):
        self.calls.append(("begin", sorted(robots), sorted(objects)))

    def act(self, action):
        self.calls.append(("act", action))

    def move(self, robot, motion):
        self.calls.append(("move", robot, motion.duration))

    def close(self, robot, link):
        self.calls.append(("close", robot, link))

    def open(self, robot, link):
        self.calls.append(("open", robot, link))

    def attach(self, robot, object, link):
        self.calls.append(("attach", robot, object, link))

    def detach(self, robot, object):
        self.calls.append(("detach", robot, object))

    def finish(self, objects):
        self.calls.append(("finish", sorted(objects)))

    def stop(self):
        self.calls.append(("stop",))


def speak(driver, *messages):
    """Answers to messages, which get their ids."""
    told = "".join(json.dumps({"id": k + 1, **m}) + "\n" for k, m in enumerate(messages))
    out = io.StringIO()
    driver.run(io.StringIO(told), out)
    first, *answers = [json.loads(line) for line in out.getvalue().splitlines()]
    assert first == {"kaboum_driver": 1}
    return answers


def test_each_message_is_a_method():
    driver = Recorder()
    answers = speak(driver, BEGIN, {"do": "act", "action": "fetch(arm, o1)"}, {"do": "move", "robot": "arm", "trajectory": trajectory()},
                    {"do": "finish", "objects": {"o1": {"away": True}}})
    assert answers == [{"done": True, "id": k} for k in (1, 2, 3, 4)]
    assert driver.calls == [("begin", ["arm"], ["o1", "o2"]), ("act", "fetch(arm, o1)"), ("move", "arm", 1.0), ("finish", ["o1"]), ("stop",)]
    assert driver.q == {"arm": [1.0, -1.0]}
    assert driver.timing["move"]["count"] == 1 and driver.timing["move"]["longest"] <= driver.timing["move"]["seconds"] < 1


def test_a_gripper_closes_and_opens_once():
    driver = Recorder()
    link = {"robot": "arm", "link": "hand"}
    answers = speak(driver, {**BEGIN, "objects": {}}, {"do": "take", "object": "o1", **link}, {"do": "take", "object": "lid", **link},
                    {"do": "take", "object": "lid", **link}, {"do": "release", "robot": "arm", "object": "lid"},
                    {"do": "release", "robot": "arm", "object": "o1"}, {"do": "release", "robot": "arm", "object": "o1"})
    assert driver.calls[1:-1] == [("close", "arm", "hand"), ("attach", "arm", "o1", "hand"), ("attach", "arm", "lid", "hand"), ("detach", "arm", "lid"),
                                  ("detach", "arm", "o1"), ("open", "arm", "hand")]
    assert ["failed" in a for a in answers] == [False, False, False, True, False, False, True]


def test_a_gripper_with_joints_is_told_how_far_and_motions_begin_there():
    class Hand(Recorder):
        def close(self, robot, link):
            self.calls.append(self.gripper and (self.gripper["name"], self.gripper["to"], self.gripper["within"]))

        open = close

        def where(self, robot):
            return self.q[robot]

    gripper = {"name": "fingers", "joint_names": ["b"], "from": [1.0], "to": [0.25], "within": 0.01, "pads": ["pad"]}
    take = {"do": "take", "robot": "arm", "object": "o1", "link": "hand"}
    driver = Hand()
    answers = speak(driver, {**BEGIN, "objects": {}}, {**take, "gripper": {**gripper, "joint_names": ["c"]}}, {**take, "gripper": gripper},
                    {"do": "move", "robot": "arm", "trajectory": trajectory()},
                    {"do": "release", "robot": "arm", "object": "o1", "gripper": {**gripper, "to": [1.0]}}, {**take, "object": "o2"})
    assert "failed" in answers[1] and answers[2]["done"] and len(answers[2]["q"]) == 2
    assert "begins elsewhere" in answers[3]["failed"], "it was told to be at 0.25 since then"
    assert [c for c in driver.calls if c is None or c[0] == "fingers"] == [("fingers", [0.25], 0.01), ("fingers", [1.0], 0.01), None]
    assert driver.gripper is None


def test_where_it_is_is_said():
    class Known(Recorder):
        at = [0.0, 1.0]

        def where(self, robot):
            return self.at

        def move(self, robot, motion):
            self.at = [0.999, -1.0]
            return [[0.0, 0.0, 1.0], [1.0, 0.999, -1.0]]

    assert speak(Known(), BEGIN, {"do": "move", "robot": "arm", "trajectory": trajectory()}) == [
        {"done": True, "q": {"arm": [0.0, 1.0]}, "id": 1},
        {"done": True, "q": [0.999, -1.0], "executed": [[0.0, 0.0, 1.0], [1.0, 0.999, -1.0]], "id": 2}]


def test_a_failure_says_why_and_where():
    class Stuck(Recorder):
        def where(self, robot):
            return [0.0, 1.0]

        def move(self, robot, motion):
            raise Failure("a fuse has blown")

    assert speak(Stuck(), BEGIN, {"do": "move", "robot": "arm", "trajectory": trajectory()})[1] == {
        "failed": "a fuse has blown", "q": [0.0, 1.0], "id": 2}
    assert "failed" in speak(Recorder(), BEGIN, {"do": "sense", "fact": "p(o1)", "values": ["true", "false"]})[1]


def test_what_is_sensed():
    class Senses(Recorder):
        def sense(self, fact, values):
            return {"p(o1)": True, "q(o1)": False, "f(o1)": "b"}[fact]

    asked = [{"do": "sense", "fact": f, "values": []} for f in ("p(o1)", "q(o1)", "f(o1)")]
    assert [a["sensed"] for a in speak(Senses(), *asked)] == ["true", "false", "b"]


@pytest.mark.parametrize("damage", [
    lambda t: t["points"].clear(), lambda t: t["points"].reverse(), lambda t: t["points"][3].update(positions=[1.0]),
    lambda t: t["points"][3].update(velocities=[1.0, float("nan")]), lambda t: t["points"][0].update(velocities=[1.0, 0.0]),
    lambda t: t["points"][-1].update(velocities=[0.0, 1e-3]), lambda t: t["points"][0].update(time_from_start=0.01), lambda t: t.pop("points"),
    lambda t: t["joint_names"].reverse(), lambda t: t["points"][0].update(positions=[0.0, 1.001])])
def test_what_is_no_trajectory_is_not_followed(damage):
    told = trajectory()
    damage(told)
    driver = Recorder()
    answer = speak(driver, BEGIN, {"do": "move", "robot": "arm", "trajectory": told})[1]
    assert "failed" in answer and not any(call[0] == "move" for call in driver.calls)


def test_other_robots_and_messages_fail():
    answers = speak(Recorder(), BEGIN, {"do": "move", "robot": "leg", "trajectory": trajectory()}, {"do": "dance"})
    assert "leg" in answers[1]["failed"] and "dance" in answers[2]["failed"]


def test_it_stops_however_it_ends(capsys):
    driver = Recorder()
    speak(driver, BEGIN, {"do": "stop"}, {"do": "act", "action": "never"})
    assert driver.calls[-1] == ("stop",) and ("act", "never") not in driver.calls

    class Broken(Recorder):
        def act(self, action):
            print("this is no answer")
            raise RuntimeError("a mistake of the driver")

    driver, out = Broken(), io.StringIO()
    with pytest.raises(RuntimeError):
        driver.run(io.StringIO(json.dumps({"id": 1, "do": "act", "action": "x"}) + "\n"), out)
    assert driver.calls[-1] == ("stop",) and out.getvalue() == '{"kaboum_driver": 1}\n'
    assert "this is no answer" in capsys.readouterr().err and sys.stdout is not sys.stderr


def test_between_points_it_is_the_polynomial_of_degree_5():
    motion = Motion(trajectory(4))
    for k in range(101):
        for there, wanted in zip(motion.at(k / 100), curve(k / 100)):
            assert there == pytest.approx(wanted, abs=1e-12)
    assert motion.at(-1) == ([0.0, 1.0], [0.0, 0.0], [0.0, 0.0]) and motion.at(2)[0] == [1.0, -1.0]


def test_it_is_followed_in_its_time():
    driver = Recorder()
    sent = list(driver.follow(Motion(trajectory()), rate=200))
    times = [t for t, *_ in sent]
    assert times[0] == 0 and times[-1] == 1.0 and times == sorted(set(times)) and 20 < len(times) <= 201
    assert sent[-1][1] == [1.0, -1.0]


def test_no_setpoint_is_left_out():
    def steps(pause):
        at = []
        for _, q, *_ in Driver().follow(Motion(trajectory()), rate=100):
            at.append(q[0])
            if len(at) == 50:
                time.sleep(pause)
        return [b - a for a, b in zip(at, at[1:])]

    begun = time.monotonic()
    assert max(steps(0.045)) <= 1.875 / 100 * (1 + 1e-6)
    assert time.monotonic() - begun > 1 + 0.045 - 0.01 - 1e-3, "what follows is as much later"
    with pytest.raises(Failure, match="a setpoint was .* s late"):
        steps(0.08)
    for wrong in (0, -1, float("nan")):
        with pytest.raises(ValueError):
            Driver().follow(Motion(trajectory()), rate=wrong)


def test_it_stops_though_that_fails():
    class Stubborn(Recorder):
        def act(self, action):
            if action == "break":
                raise RuntimeError("a mistake of the driver")

        def stop(self):
            super().stop()
            raise ValueError("it does not stop")

    for action, error in (("break", RuntimeError), ("x", ValueError)):
        driver = Stubborn()
        with pytest.raises(error):
            speak(driver, {"do": "act", "action": action})
        assert driver.calls == [("stop",)]


def test_nothing_is_done_where_nobody_reads_or_without_an_id():
    class Closed(io.StringIO):
        def flush(self):
            raise BrokenPipeError

    driver = Recorder()
    with pytest.raises(BrokenPipeError):
        driver.run(io.StringIO('{"id": 1, "do": "act", "action": "x"}\n'), Closed())
    assert driver.calls == [("stop",)]
    with pytest.raises(KeyError):
        driver.run(io.StringIO('{"do": "act", "action": "x"}\n'), io.StringIO())
    assert driver.calls == [("stop",), ("stop",)]


def test_a_motion_begins_where_the_robot_is():
    class Displaced(Recorder):
        def __init__(self, by):
            super().__init__()
            self.at = [0.0, 1.0 + by]

        def where(self, robot):
            return self.at

    move = {"do": "move", "robot": "arm", "trajectory": trajectory()}
    assert speak(Displaced(0.04), BEGIN, move)[1]["done"]
    for by in (-0.06, 0.2, float("nan")):
        assert speak(Displaced(by), BEGIN, move)[1]["failed"].startswith("the trajectory begins elsewhere")
    wide = Displaced(0.2)
    wide.tracking = 0.3
    assert speak(wide, BEGIN, move)[1]["done"]
    # With what it was told last it is compared exactly, though it says itself where it is.
    elsewhere = trajectory()
    elsewhere["points"][0]["positions"] = [0.0, 1.001]
    assert "failed" in speak(Displaced(0), BEGIN, {**move, "trajectory": elsewhere})[1]
    assert "failed" in speak(Displaced(0), BEGIN, move, move)[2], "it has come to the end, as it was told"


def test_a_failure_is_answered_though_it_is_not_known_where():
    class Lost(Recorder):
        lost = False

        def where(self, robot):
            if self.lost:
                raise Failure("no encoder answers")

        def move(self, robot, motion):
            self.lost = True
            raise Failure("a fuse has blown")

    assert speak(Lost(), BEGIN, {"do": "move", "robot": "arm", "trajectory": trajectory()})[1] == {"failed": "a fuse has blown", "id": 2}


def test_the_file_stands_alone(tmp_path):
    file = pathlib.Path(sys.modules["kaboum.driver"].__file__)
    (tmp_path / "alone.py").write_text(f"import sys; sys.path.insert(0, {str(file.parent)!r}); from driver import Driver; Driver().run()\n")
    done = subprocess.run([sys.executable, "-S", "-E", str(tmp_path / "alone.py")], input='{"id": 7, "do": "act", "action": "x"}\n', capture_output=True,
                          text=True, check=True)
    assert done.stdout.splitlines() == ['{"kaboum_driver": 1}', '{"done": true, "id": 7}']
