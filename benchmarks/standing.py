#!/usr/bin/env python3
"""Whether Unitree's G1 of MuJoCo Menagerie stands for 5 s on what it has for feet, in MuJoCo.

    build/engines/bin/python benchmarks/standing.py MENAGERIE [--build build/release] [--epsilon 1cm]

It begins in its keyframe, on a plane, and its own controllers hold that. Feet are
- the spheres that Menagerie gives it;
- the meshes that are drawn, which MuJoCo takes the hulls of: nothing of this project is in that;
- bodies round the meshes that are drawn (`bcd-decompose --visual --links`), within epsilon;
the latter two also where feet and shanks, which no joint connects, are left out of collisions (<exclude>). Says of each how
far the pelvis has fallen and leans, which links touch each other at the start, and how many pairs of triangles of drawn feet
and shanks cross each other there.
"""

import argparse
import math
import pathlib
import re
import subprocess
import sys
import tempfile

import coal
import mujoco

SIDES = ("left", "right")
FEET = [f"{side}_ankle_roll_link" for side in SIDES]
SHANKS = [f"{side}_knee_link" for side in SIDES]
SECONDS = 5
FALLEN = 0.1  # [m]


def with_floor(text):
    return re.sub(r"<worldbody[^>]*>", lambda m: m[0] + '<geom name="floor" size="0 0 0.05" type="plane"/>', text, count=1)


def excluding(text):
    pairs = "".join(f'<exclude body1="{a}" body2="{b}"/>' for a, b in zip(FEET, SHANKS))
    return text.replace("</mujoco>", f"<contact>{pairs}</contact></mujoco>")


def with_drawn_feet(text):
    """Drawn meshes instead of spheres, with the spheres' friction."""
    text = re.sub(r'<geom class="foot"[^>]*/>', "", text)
    return re.sub(r'<geom class="visual" material="black" mesh="(\w+_ankle_roll_link)"/>',
                  r'<geom class="collision" mesh="\1" priority="1" friction="0.6" condim="3"/>', text)


def model_of(path, *changes):
    text = path.read_text()
    for change in changes:
        text = change(text)
    beside = path.with_name("standing-" + path.name)
    beside.write_text(with_floor(text))
    try:
        return mujoco.MjModel.from_xml_path(str(beside))
    finally:
        beside.unlink()


def in_keyframe(model):
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    return data


def stand(name, model):
    data = in_keyframe(model)
    floor = model.geom("floor").id
    touching = sorted({" and ".join(sorted(model.body(model.geom_bodyid[g]).name for g in c.geom))
                       for c in data.contact if floor not in c.geom})
    pelvis = model.body("pelvis").id
    before = data.xpos[pelvis][2]
    while data.time < SECONDS:
        mujoco.mj_step(model, data)
    fallen, up = before - data.xpos[pelvis][2], data.xmat[pelvis].reshape(3, 3)[2, 2]
    lean = math.degrees(math.acos(max(-1, min(1, up))))
    print(f"| {name} | {'stands' if fallen < FALLEN else 'falls'} | {fallen:.3f} | {lean:.1f} | {', '.join(touching) or 'none'} |")


def crossings(folder, model):
    """Pairs of triangles of each foot and shank as drawn that cross each other at the start."""
    data = in_keyframe(model)
    loader = coal.MeshLoader(coal.NODE_TYPE.BV_OBBRSS)
    out = []
    for pair in zip(FEET, SHANKS):
        meshes, places = [], []
        for body in pair:
            meshes.append(loader.load(str(folder / "assets" / f"{body}.STL")))
            place = coal.Transform3s()
            place.setRotation(data.body(body).xmat.reshape(3, 3).copy())
            place.setTranslation(data.body(body).xpos.copy())
            places.append(place)
        result = coal.CollisionResult()
        coal.collide(meshes[0], places[0], meshes[1], places[1],
                     coal.CollisionRequest(coal.CollisionRequestFlag.CONTACT, 100000), result)
        out.append(result.numContacts())
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("menagerie", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent / "build/release")
    parser.add_argument("--epsilon", default="1cm")
    args = parser.parse_args()
    folder = (args.menagerie / "unitree_g1").resolve()
    robot = folder / "g1.xml"
    print("| feet | | fallen [m] | leans [°] | links that touch at the start |\n|---|---|--:|--:|---|")
    stand("spheres of the original", model_of(robot))
    stand("drawn meshes, MuJoCo's hulls", model_of(robot, with_drawn_feet))
    stand("the same, foot and shank excluded", model_of(robot, with_drawn_feet, excluding))
    with tempfile.TemporaryDirectory() as place:
        subprocess.run([str(args.build / "bin/bcd-decompose"), str(robot), "-o", place, "--visual", "--epsilon", args.epsilon,
                        "--effort", "fast", "--quiet", "--links", ",".join(FEET)], check=True)
        written = pathlib.Path(place) / "g1.xml"
        stand(f"bodies within {args.epsilon}", model_of(written))
        stand("the same, foot and shank excluded", model_of(written, excluding))
    print("pairs of triangles of drawn foot and shank that cross at the start: " +
          ", ".join(f"{n} {side}" for n, side in zip(crossings(folder, model_of(robot)), SIDES)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
