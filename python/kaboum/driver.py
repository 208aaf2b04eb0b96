"""Robot drivers: what `kaboum-plan run --robot COMMAND` tells and is answered, as methods of a class.

    from kaboum.driver import Driver, Failure

    class Arm(Driver):
        def move(self, robot, motion):
            for time, q, velocity, acceleration in self.follow(motion, rate=250):
                self.bus.send(q)
        def close(self, robot, link): ...
        def open(self, robot, link): ...
        def sense(self, fact, values): ...

    Arm().run()

The file needs nothing but Python's own library: it works as `kaboum.driver`, and beside a driver that has no kaboum.
docs/planning/drivers.md says what the lines are.
"""

import bisect
import json
import math
import sys
import time

__all__ = ["Driver", "Failure", "Motion"]


class Failure(Exception):
    """What a robot says why it could not; nothing in the world has changed."""


class Motion:
    """A trajectory as a driver is told it, from rest to rest, or from rest to rest through blended corners.

    `joint_names`; `times` [s], from 0 on; `positions`, `velocities`, `accelerations`: for each time a value per joint.
    """

    def __init__(self, trajectory):
        """Raises ValueError for what is no trajectory."""
        self.joint_names = list(trajectory["joint_names"])
        points = trajectory["points"]
        self.times = [p["time_from_start"] for p in points]
        self.positions, self.velocities, self.accelerations = ([p[key] for p in points] for key in ("positions", "velocities", "accelerations"))
        if not points or self.times[0] != 0 or any(not a < b for a, b in zip(self.times, self.times[1:])):
            raise ValueError("times of a trajectory grow from 0 on")
        for row in (*self.positions, *self.velocities, *self.accelerations):
            if len(row) != len(self.joint_names) or not all(map(math.isfinite, row)):
                raise ValueError("a trajectory has a number for each joint at each time")
        if any(abs(v) > 1e-9 for row in (self.velocities[0], self.velocities[-1]) for v in row):
            raise ValueError("a trajectory begins and ends at rest")

    @property
    def duration(self):
        """[s]"""
        return self.times[-1]

    def at(self, when):
        """Values, velocities and accelerations at a time [s], by the polynomials of degree 5 through the points: certified, as straight
        lines between them are. Before the start and after the end: there, at rest."""
        if when <= 0 or when >= self.duration:
            rest = [0.0] * len(self.joint_names)
            return list(self.positions[0 if when <= 0 else -1]), rest, list(rest)
        k = bisect.bisect_right(self.times, when) - 1
        step = self.times[k + 1] - self.times[k]
        u = (when - self.times[k]) / step
        q, v, a = [], [], []
        for j in range(len(self.joint_names)):
            begin, change = self.positions[k][j], self.positions[k + 1][j] - self.positions[k][j]
            v0, v1 = self.velocities[k][j] * step, self.velocities[k + 1][j] * step
            a0, a1 = self.accelerations[k][j] * step * step, self.accelerations[k + 1][j] * step * step
            c3 = 10 * change - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1
            c4 = -15 * change + 8 * v0 + 7 * v1 + 1.5 * a0 - a1
            c5 = 6 * change - 3 * (v0 + v1) + 0.5 * (a1 - a0)
            q.append(begin + u * (v0 + u * (0.5 * a0 + u * (c3 + u * (c4 + u * c5)))))
            v.append((v0 + u * (a0 + u * (3 * c3 + u * (4 * c4 + u * 5 * c5)))) / step)
            a.append((a0 + u * (6 * c3 + u * (12 * c4 + u * 20 * c5))) / (step * step))
        return q, v, a


class Driver:
    """A robot driver: subclass it, and call `run`.

    Methods that a robot needs: `move`; `take` and `release`, or `close`, `open`, `attach`, `detach`, which these call; `sense`; `where`, if the
    robot knows where it is; `stop`. Each may raise Failure. Here they do nothing, and `sense` fails.

    `robots`: joint names of each robot. `q`: where each robot is, by what it was told last or by `where`. `held`: for each held object its
    robot and link. `timing`: for each kind of message how many there were, and their seconds, all and the longest.
    `tracking`: how far each joint may be, by `where`, from where a motion begins [rad or length].
    `gripper`: in `take` and `release`, of a gripper with joints, how far they close or open: {"name", "joint_names", "from", "to", "within",
    "pads", "force"}; else None. Each joint stops where the pads touch, at most `within` from `to`.
    """

    def __init__(self):
        self.robots, self.q, self.held, self.timing = {}, {}, {}, {}
        self.tracking = 0.05
        self.gripper = None
        self._told = {}  # where each robot was told to be last

    # --- what a robot does ---

    def begin(self, robots, objects):
        """Called first. `robots`: {NAME: {"joint_names": [...], "q": [...]}}; `objects`: {NAME: {"pose": three rows} or {"held_by": ROBOT} or
        {"away": True}}."""

    def act(self, action):
        """What follows belongs to this action: "grasp(arm, o1)"."""

    def move(self, robot, motion):
        """Moves a robot along a Motion, and comes back when it stands. May return how the joints really moved: rows [TIME, VALUE, ...]."""

    def take(self, robot, object, link):
        """Holds an object by a link. Another robot may hold it until it releases it; what is mounted on a held object comes with it."""
        if not any(by == (robot, link) for by in self.held.values()):
            self.close(robot, link)
        self.attach(robot, object, link)

    def release(self, robot, object):
        """Lets an object go."""
        by = self.held[object, robot]
        self.detach(robot, object)
        if not any(other == by for hold, other in self.held.items() if hold != (object, robot)):
            self.open(robot, by[1])

    def close(self, robot, link):
        """Closes the gripper of a link, or switches its suction on. `self.gripper` says how far, if it has joints."""

    def open(self, robot, link):
        """Opens the gripper of a link, or switches its suction off; likewise."""

    def attach(self, robot, object, link):
        """An object moves with a link from now on."""

    def detach(self, robot, object):
        """It does not any more."""

    def sense(self, fact, values):
        """Says which of the values a fact has: "isSpillable(o1)", ["true", "false"]."""
        raise Failure("nothing here senses " + fact)

    def where(self, robot):
        """Values of a robot's joints, as they are; None: not known."""

    def finish(self, objects):
        """The plan has ended; `objects` as of `begin`, where the plan has them now."""

    def stop(self):
        """Called last, however the run ends: robots are to stand still. Not of a process that is killed: a robot has to see by itself that nothing
        comes any more."""

    # --- time ---

    def follow(self, motion, rate, latest=0.05):
        """Times, values, velocities and accelerations of a motion `rate` times a second, each when it is due, the end included. None is left out:
        where one is late, all that follow are as much later; by more than `latest` seconds: Failure. Raises ValueError unless rate > 0."""
        if not (rate > 0 and math.isfinite(rate) and latest >= 0):
            raise ValueError("a rate is above 0, and a delay not below")
        return self._follow(motion, rate, latest)

    @staticmethod
    def _follow(motion, rate, latest):
        due, when, k = time.monotonic(), 0.0, 0
        while True:
            step = min(k / rate, motion.duration)
            due += step - when
            when = step
            time.sleep(max(0.0, due - time.monotonic()))
            now = time.monotonic()
            if now - due > latest:
                raise Failure(f"a setpoint was {now - due:g} s late")
            due = max(due, now)  # what follows is as much later
            yield (when, *motion.at(when))
            if when >= motion.duration:
                return
            k += 1

    # --- the protocol ---

    def run(self, reader=None, writer=None):
        """Speaks with kaboum-plan on standard input and output until the run ends. What is printed meanwhile goes to standard error."""
        reader, writer = reader or sys.stdin, writer or sys.stdout
        printed, sys.stdout = sys.stdout, sys.stderr
        try:
            self._speak(reader, writer)
        except BaseException:
            try:
                self.stop()
            except Exception:  # the first one is told of
                pass
            raise
        else:
            self.stop()
        finally:
            sys.stdout = printed

    def _speak(self, reader, writer):
        self._write(writer, json.dumps({"kaboum_driver": 1}))
        for line in reader:  # its end: kaboum-plan has ended
            message = json.loads(line)
            if message["do"] == "stop":
                break
            message["id"]  # who has none is not answered, so nothing is done
            for answer in self.lines(message):
                self._write(writer, answer)

    @staticmethod
    def _write(writer, line):
        writer.write(line + "\n")
        writer.flush()

    def lines(self, message):
        """What is answered to a message: one line."""
        return [json.dumps(self.answer(message))]

    def answer(self, message):
        """The answer to a message, which is what a method does of it."""
        begun, do = time.monotonic(), message["do"]
        try:
            handle = {"begin": self._begin, "act": self._act, "move": self._move, "take": self._take, "release": self._release,
                      "sense": self._sense, "finish": self._finish}.get(do)
            if handle is None:
                raise Failure(f"nothing is known of '{do}' here")
            out = handle(message)
        except Failure as failure:
            out = {"failed": str(failure)}
            if do == "move" and message["robot"] in self.robots and (q := self._known(message["robot"])) is not None:
                out["q"] = list(q)
        seconds = time.monotonic() - begun
        kept = self.timing.setdefault(do, {"count": 0, "seconds": 0.0, "longest": 0.0})
        kept.update(count=kept["count"] + 1, seconds=kept["seconds"] + seconds, longest=max(kept["longest"], seconds))
        return {**out, "id": message["id"]}

    def _begin(self, message):
        self.robots = {name: list(robot["joint_names"]) for name, robot in message["robots"].items()}
        self.q = {name: list(robot["q"]) for name, robot in message["robots"].items()}
        self._told = {name: list(q) for name, q in self.q.items()}
        self.held = {(name, o["held_by"]): (o["held_by"], None) for name, o in message["objects"].items() if "held_by" in o}
        self.begin(message["robots"], message["objects"])
        known = {name: list(q) for name in self.robots if (q := self.where(name)) is not None}
        self.q.update(known)
        return {"done": True, "q": known} if known else {"done": True}

    def _act(self, message):
        self.act(message["action"])
        return {"done": True}

    def _move(self, message):
        robot = self._robot(message)
        try:
            motion = Motion(message["trajectory"])
        except (KeyError, TypeError, ValueError) as error:
            raise Failure(f"this is no trajectory: {error}") from None
        if motion.joint_names != self.robots[robot]:
            raise Failure("joints in another order than when it began")
        if motion.positions[0] != self._told[robot]:
            raise Failure("the trajectory begins elsewhere")
        if (at := self.where(robot)) is not None:
            if len(at) != len(motion.joint_names):
                raise Failure("where it is has another number of joints")
            for name, is_at, begin in zip(motion.joint_names, at, motion.positions[0]):
                if not abs(is_at - begin) <= self.tracking:
                    raise Failure(f"the trajectory begins elsewhere: joint {name} is {abs(is_at - begin):g} away")
        executed = self.move(robot, motion)
        self._told[robot] = list(motion.positions[-1])
        q = self.where(robot)
        self.q[robot] = list(motion.positions[-1] if q is None else q)
        out = {"done": True}
        if q is not None:
            out["q"] = list(q)
        if executed is not None:
            out["executed"] = executed
        return out

    def _take(self, message):
        robot, thing = self._robot(message), message["object"]
        if (thing, robot) in self.held:
            raise Failure(thing + " is held already")
        return self._move_fingers(robot, message, lambda: self.take(robot, thing, message["link"]),
                                  lambda: self.held.update({(thing, robot): (robot, message["link"])}))

    def _release(self, message):
        robot, thing = self._robot(message), message["object"]
        if (thing, robot) not in self.held:
            raise Failure(thing + " is not held by it")
        return self._move_fingers(robot, message, lambda: self.release(robot, thing), lambda: self.held.pop((thing, robot)))

    def _move_fingers(self, robot, message, act, note):
        """Takes or releases; where the robot's gripper has joints, they are told to be elsewhere then."""
        gripper = message.get("gripper")
        if gripper and not set(gripper["joint_names"]) <= set(self.robots[robot]):
            raise Failure(f"'{robot}' does not have all joints of the gripper")
        self.gripper = gripper
        try:
            act()
        finally:
            self.gripper = None
        note()
        if not gripper:
            return {"done": True}
        for joint, to in zip(gripper["joint_names"], gripper["to"]):
            self._told[robot][self.robots[robot].index(joint)] = to
        q = self.where(robot)
        self.q[robot] = list(self._told[robot] if q is None else q)
        return {"done": True} if q is None else {"done": True, "q": list(q)}

    def _sense(self, message):
        said = self.sense(message["fact"], message["values"])
        if said is True or said is False:
            said = "true" if said else "false"
        return {"sensed": str(said)}

    def _finish(self, message):
        self.finish(message.get("objects", {}))
        return {"done": True}

    def _known(self, robot):
        try:
            return self.where(robot)
        except Failure:  # it does not know that either
            return None

    def _robot(self, message):
        if message["robot"] not in self.robots:
            raise Failure(f"there is no robot '{message['robot']}'")
        return message["robot"]
