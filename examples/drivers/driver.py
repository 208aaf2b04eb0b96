#!/usr/bin/env python3
"""A robot driver that has no robot: it answers what a robot would, at once or in the time that motions take.

    kaboum-plan run ... --robot 'python3 examples/drivers/driver.py --sense "isSpillable(o1)=true"'

A real one moves motors where this one sleeps: it replaces `move`, `take`, `release` and `sense`. docs/planning/drivers.md says what
the lines are. --faults shows what kaboum-plan makes of a driver that is late, dies, lies, answers twice or fails.
"""
import argparse
import json
import math
import random
import sys
import time


class Driver:
    def __init__(self, options):
        self.options, self.random, self.q, self.held = options, random.Random(options.seed), {}, set()
        self.sensed = dict(text.rsplit("=", 1) for text in options.sense)

    def begin(self, message):
        self.q = {name: robot["q"] for name, robot in message["robots"].items()}
        self.held = {(name, o["held_by"]) for name, o in message["objects"].items() if "held_by" in o}
        return {"done": True, "q": self.q}

    def act(self, message):
        return {"done": True}

    def move(self, message):
        points = message["trajectory"]["points"]
        if points[0]["positions"] != self.q[message["robot"]]:
            return {"failed": "the trajectory begins elsewhere", "q": self.q[message["robot"]]}
        if self.options.real_time:
            time.sleep(points[-1]["time_from_start"])
        self.q[message["robot"]] = points[-1]["positions"]
        reply = {"done": True, "q": self.q[message["robot"]]}
        if self.options.stray is not None:  # what encoders would have seen: farthest off half way
            end = points[-1]["time_from_start"]
            reply["executed"] = [[p["time_from_start"], *(x + self.options.stray * math.sin(math.pi * p["time_from_start"] / end) for x in p["positions"])]
                                 for p in points]
        return reply

    def take(self, message):
        hold = message["object"], message["robot"]
        if hold in self.held:
            return {"failed": message["object"] + " is held already"}
        self.held.add(hold)
        return {"done": True}

    def release(self, message):
        hold = message["object"], message["robot"]
        if hold not in self.held:
            return {"failed": message["object"] + " is not held by it"}
        self.held.remove(hold)
        return {"done": True}

    def sense(self, message):
        said = self.sensed.get(message["fact"])
        return {"sensed": said if said is not None else self.random.choice(message["values"])}

    def finish(self, message):
        return {"done": True}

    def answer(self, message):
        """What is said to a message: lines, one of them if all is well."""
        fault = self.random.choice(FAULTS) if self.random.random() < self.options.faults else None
        if fault == "dead":
            sys.exit(3)
        if fault == "late":
            time.sleep(self.options.late)
        if fault == "fails":
            reply = {"failed": "by chance"}
            if message["do"] == "move":
                reply["q"] = self.q[message["robot"]]
            return [{**reply, "id": message["id"]}]
        reply = {**getattr(self, message["do"])(message), "id": message["id"]}
        if fault == "twice":
            return [reply, reply]
        if fault == "wrong id":
            return [{**reply, "id": message["id"] + 1}]
        if fault == "elsewhere" and message["do"] == "move":
            return [{**reply, "q": [x + 0.5 for x in reply["q"]]}]
        if fault == "nonsense":
            return ["{", [], {"id": message["id"]}, {"id": message["id"], "done": False}][self.random.randrange(4):][:1]
        return [reply]


FAULTS = ("dead", "late", "fails", "twice", "wrong id", "elsewhere", "nonsense")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--real-time", action="store_true", help="motions take their time")
    parser.add_argument("--sense", action="append", default=[], metavar="FACT=VALUE", help="what a fact turns out to be; others at random")
    parser.add_argument("--seed", type=int, default=1, help="of what is random [1]")
    parser.add_argument("--faults", type=float, default=0, metavar="SHARE", help="of messages that something goes wrong at [0]")
    parser.add_argument("--stray", type=float, metavar="RAD", help="say how joints moved: so far beside the trajectory half way [not said]")
    parser.add_argument("--late", type=float, default=60, metavar="SECONDS", help="how long a late answer takes [60]")
    driver = Driver(parser.parse_args())
    print(json.dumps({"kaboum_driver": 1}), flush=True)
    for line in sys.stdin:  # its end: kaboum-plan has ended, and a robot has to stand still
        message = json.loads(line)
        if message["do"] == "stop":
            break
        for reply in driver.answer(message):
            print(reply if isinstance(reply, str) else json.dumps(reply), flush=True)


if __name__ == "__main__":
    main()
