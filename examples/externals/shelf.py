"""External functions for shelf.kpl, asked by JSON lines on standard input and output (docs/planning/externals.md)."""
import json
import sys


def say(message):
    print(json.dumps(message), flush=True)


def ask(message):
    """Reads something of the state. None: the call is over."""
    say(message)
    return json.loads(sys.stdin.readline())


def reach(arguments):
    """o2 is reached only when o1 does not stand in front of it any more."""
    here = ask({"read": "pose", "arguments": [arguments[0]]})
    if "stop" in here:
        return None
    if arguments[0] == "o2":
        front = ask({"read": "pose", "arguments": ["o1"]})
        if "stop" in front:
            return None
        if front["value"] == "p1":
            return {"impossible": "blocked by o1"}
    return {"value": f"over {here['value']}", "payload": {"waypoints": [[0, 0], [1, 1]]}}


def is_box(arguments):
    return {"holds": arguments[0] == "box"}


FUNCTIONS = {"reach": reach, "isBox": is_box}
say({"kaboum_externals": 1, "functions": list(FUNCTIONS)})
for line in sys.stdin:
    request = json.loads(line)
    if "stop" in request:
        continue
    answer = FUNCTIONS[request["function"]](request["arguments"])
    if answer is not None:
        say(answer)
