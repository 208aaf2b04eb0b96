#!/usr/bin/env python3
"""A robot driver that has no robot: it answers what a robot would, at once or in the time that motions take.

    kaboum-plan run ... --robot 'python3 examples/drivers/driver.py --sense "isSpillable(o1)=true"'

A real one moves motors where this one sleeps: it replaces `move`, `close`, `open` and `sense` of kaboum.driver.Driver
(docs/planning/drivers.md). --faults shows what kaboum-plan makes of a driver that is late, dies, lies, answers twice or fails.
"""
import argparse
import json
import math
import pathlib
import random
import sys
import time

try:
    from kaboum.driver import Driver
except ImportError:  # in a checkout: the file itself, which needs nothing else
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python/kaboum"))
    from driver import Driver


class NoRobot(Driver):
    def __init__(self, options):
        super().__init__()
        self.options, self.random = options, random.Random(options.seed)
        self.sensed = dict(text.rsplit("=", 1) for text in options.sense)

    def where(self, robot):
        return self.q[robot]

    def move(self, robot, motion):
        if self.options.real_time:
            for _ in self.follow(motion, rate=100):
                pass
        self.q[robot] = motion.positions[-1]
        if self.options.stray is not None:  # what encoders would have seen: farthest off half way
            return [[t, *(x + self.options.stray * math.sin(math.pi * t / motion.duration) for x in q)] for t, q in zip(motion.times, motion.positions)]

    def close(self, robot, link):
        if self.gripper:  # it has joints: they are there at once
            for joint, to in zip(self.gripper["joint_names"], self.gripper["to"]):
                self.q[robot][self.robots[robot].index(joint)] = to

    open = close

    def sense(self, fact, values):
        said = self.sensed.get(fact)
        return said if said is not None else self.random.choice(values)

    def lines(self, message):
        """What is said to a message: a line, if all is well."""
        fault = self.random.choice(FAULTS) if self.random.random() < self.options.faults else None
        if fault == "dead":
            sys.exit(3)
        if fault == "late":
            time.sleep(self.options.late)
        if fault == "fails":
            reply = {"failed": "by chance", "id": message["id"]}
            if message["do"] == "move":
                reply["q"] = self.q[message["robot"]]
            return [json.dumps(reply)]
        reply = self.answer(message)
        if fault == "twice":
            return 2 * [json.dumps(reply)]
        if fault == "wrong id":
            return [json.dumps({**reply, "id": message["id"] + 1})]
        if fault == "elsewhere" and message["do"] == "move":
            return [json.dumps({**reply, "q": [x + 0.5 for x in reply["q"]]})]
        if fault == "nonsense":
            nonsense = ["{", "[]", json.dumps({"id": message["id"]}), json.dumps({"id": message["id"], "done": False})]
            return [self.random.choice(nonsense)]
        return [json.dumps(reply)]


FAULTS = ("dead", "late", "fails", "twice", "wrong id", "elsewhere", "nonsense")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--real-time", action="store_true", help="motions take their time")
    parser.add_argument("--sense", action="append", default=[], metavar="FACT=VALUE", help="what a fact turns out to be; others at random")
    parser.add_argument("--seed", type=int, default=1, help="of what is random [1]")
    parser.add_argument("--faults", type=float, default=0, metavar="SHARE", help="of messages that something goes wrong at [0]")
    parser.add_argument("--stray", type=float, metavar="RAD", help="say how joints moved: so far beside the trajectory half way [not said]")
    parser.add_argument("--late", type=float, default=60, metavar="SECONDS", help="how long a late answer takes [60]")
    NoRobot(parser.parse_args()).run()


if __name__ == "__main__":
    main()
