#!/usr/bin/env python3
"""Random models that attach (MJCF) and include (SDF) one another are read as MuJoCo and Drake load them: poses at 100 configurations within
1e-9, limits, shapes.

usage: included.py ROBOT_POSES BIN [COUNT [SEED]]

Run by the Python of `scripts/setup --engines`; exit code 77 where it has no MuJoCo.
"""
import json
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

import readers  # ends with 77 where there is no MuJoCo


class Mjcf:
    """A model with classes in classes, frames, all ways of stating a rotation, in either unit and any order of angles."""

    def __init__(self, chance, files, level):
        self.chance, self.files, self.level = chance, files, level
        self.degrees = chance.random() < 0.5
        self.names, self.classes, self.attached, self.models = 0, [], 0, []

    def number(self, low=-1.0, high=1.0):
        return f"{self.chance.uniform(low, high):.3f}"

    def numbers(self, n, most=1.0):
        return " ".join(self.number(-most, most) for _ in range(n))

    def name(self, kind):
        self.names += 1
        return f"{kind}{self.names}"

    def place(self):
        turn = 60 if self.degrees else 1
        position = f' pos="{self.numbers(3)}"' if self.chance.random() < 0.7 else ""
        return position + self.chance.choice([
            "", f' euler="{self.numbers(3, turn)}"', f' axisangle="{self.numbers(2)} 1 {self.number(-turn, turn)}"', f' quat="1 {self.numbers(3)}"',
            f' zaxis="{self.numbers(2)} 1"', f' xyaxes="1 {self.numbers(3)} 1 {self.number()}"'])

    def of_class(self):
        return f' class="{self.chance.choice(self.classes)}"' if self.classes and self.chance.random() < 0.3 else ""

    def geom(self):
        kind = self.chance.choice(["", "", *(f' type="{k}"' for k in ("box", "sphere", "capsule", "cylinder", "ellipsoid"))])
        size = " ".join(self.number(0.05, 0.2) for _ in range(3))
        return f'<geom{kind} size="{size}"{self.place()}{self.of_class()}/>'

    def joint(self):
        turn = 60 if self.degrees else 1
        kind = self.chance.choice(["", ' type="hinge"', ' type="slide"'])
        most = 0.5 if "slide" in kind else turn
        more = f' range="{self.number(-most, -0.01)} {self.number(0.01, most)}"' if self.chance.random() < 0.5 else ""
        more += f' ref="{self.number(-0.2 * turn, 0.2 * turn)}"' if self.chance.random() < 0.3 else ""
        more += f' axis="{self.numbers(2)} 1"' if self.chance.random() < 0.6 else ""
        return f'<joint name="{self.name("j")}"{kind}{more} pos="{self.numbers(3)}"{self.of_class()}/>'

    def defaults(self, depth=0):
        turn = 60 if self.degrees else 1
        out = ""
        if self.chance.random() < 0.6:
            out += "<geom" + self.chance.choice([' type="box"', ' size="0.1 0.1 0.1"', ' contype="0"', ' group="2" density="10"', ' pos="0 0 0.1"']) + "/>"
        if self.chance.random() < 0.6:
            out += "<joint" + self.chance.choice([f' range="{self.number(-turn, -0.01)} {self.number(0.01, turn)}"', ' axis="0 1 0"', ' damping="0.4"',
                                                  ' type="slide"', f' ref="{self.number(-0.1 * turn, 0.1 * turn)}"']) + "/>"
        for _ in range(self.chance.randrange(3 - depth) if depth < 2 else 0):
            self.classes.append(self.name("c"))
            out += f'<default class="{self.classes[-1]}">{self.defaults(depth + 1)}</default>'
        return out

    def attach(self):
        if not self.models or self.attached > 3:
            return ""
        self.attached += 1
        model, bodies, frames = self.chance.choice(self.models)
        part = self.chance.choice([f' body="{self.chance.choice(bodies)}"'] * 3 + [""] + [f' frame="{frame}"' for frame in frames[:1]])
        return f'<attach model="{model}"{part} prefix="p{self.level}{self.attached}_"/>'

    def body(self, depth):
        own = f' childclass="{self.chance.choice(self.classes)}"' if self.classes and self.chance.random() < 0.4 else ""
        out = f'<body name="{self.name("b")}"{self.place()}{own}>'
        out += "".join(self.joint() for _ in range(self.chance.choice([0, 1, 1, 2])))
        out += '<geom type="sphere" size="0.1" mass="1"/>' + "".join(self.geom() for _ in range(self.chance.randrange(3)))
        if self.chance.random() < 0.4:
            out += f'<frame name="{self.name("f")}"{self.place()}>{self.geom()}</frame>'
        if self.chance.random() < 0.6:
            out += self.attach()
        if depth < 3:
            out += "".join(self.body(depth + 1) for _ in range(self.chance.choice([0, 1, 1, 2])))
        return out + "</body>"

    def write(self, file):
        """@return names of its bodies and frames"""
        assets = ""
        for i in range(self.chance.choice([1, 2]) if self.level == 0 else self.chance.choice([0, 1]) if self.level == 1 else 0):
            inner = f"s{len(self.files)}.xml"
            self.files[inner] = ""
            self.models.append((f"m{i}", *Mjcf(self.chance, self.files, self.level + 1).write(inner)))
            assets += f'<model name="m{i}" file="{inner}"/>'
        order = self.chance.choice(["", "", ' eulerseq="ZYX"', ' eulerseq="zxy"', ' eulerseq="XyZ"'])
        default = f"<default>{self.defaults()}</default>" if self.chance.random() < 0.8 else ""
        world = self.body(0) + self.body(1) + f"<frame{self.place()}>{self.attach()}</frame>" + self.attach()
        self.files[file] = (f'<mujoco model="x{self.level}"><compiler angle="{"degree" if self.degrees else "radian"}"{order}/>{default}'
                            f"<asset>{assets}</asset><worldbody>{world}</worldbody></mujoco>")
        return tuple(re.findall(rf'<{tag} name="(\w+)"', self.files[file]) for tag in ("body", "frame"))


class Sdf:
    """A model of any version since 1.5, with frames, joints and axes in them, and others included."""

    def __init__(self, chance, name, minor, others):
        self.chance, self.name, self.minor, self.others = chance, name, minor, others
        self.new = minor >= 7  # frames are named
        self.links = [f"l{i}" for i in range(chance.choice([1, 2, 3]))]
        self.frames = list(self.links)

    def numbers(self, n):
        return " ".join(f"{self.chance.uniform(-1, 1):.3f}" for _ in range(n))

    def pose(self, frames):
        frame = f' relative_to="{self.chance.choice(frames)}"' if self.new and frames and self.chance.random() < 0.5 else ""
        return f"<pose{frame}>{self.numbers(6)}</pose>" if self.chance.random() < 0.8 else ""

    def joint(self, name, parent, child):
        kind = self.chance.choice(["revolute", "prismatic"])
        frame = f' expressed_in="{self.chance.choice(["__model__", *self.frames])}"' if self.new and self.chance.random() < 0.5 else ""
        old = "" if self.new else self.chance.choice(["", *(f"<use_parent_model_frame>{x}</use_parent_model_frame>" for x in ("true", "false"))])
        pose = self.pose(self.links) if "::" not in child else ""
        return (f'<joint name="{self.name}_{name}" type="{kind}">{pose}<parent>{parent}</parent><child>{child}</child>'
                f"<axis><xyz{frame}>{self.numbers(2)} 1</xyz>{old}<limit><lower>-1</lower><upper>1</upper></limit></axis></joint>")

    def text(self):
        out = ""
        for i, link in enumerate(self.links):
            out += (f'<link name="{link}">{self.pose(self.links[:i])}<inertial><mass>1</mass></inertial><collision name="c">{self.pose([])}'
                    "<geometry><box><size>0.1 0.2 0.3</size></box></geometry></collision></link>")
        if self.new and self.chance.random() < 0.6:
            out += f'<frame name="fr" attached_to="{self.chance.choice(self.links)}"><pose>{self.numbers(6)}</pose></frame>'
            self.frames.append("fr")
        for i in range(1, len(self.links)):
            out += self.joint(f"j{i}", self.chance.choice(self.links[:i]), self.links[i])
        for i, other in enumerate(self.others):
            name = f"m{i}" if self.chance.random() < 0.8 else other.name
            include = f"<uri>model://{other.name}/</uri>" + (f"<name>{name}</name>" if name != other.name else "")
            pose = self.pose(self.frames)
            if pose and self.chance.random() < 0.6:
                include += f"<placement_frame>{self.chance.choice(other.frames)}</placement_frame>"
            out += f"<include>{include}{pose}</include>" + self.joint(f"k{i}", self.chance.choice(self.links), f"{name}::{other.links[0]}")
        return f'<sdf version="1.{self.minor}"><model name="{self.name}">{self.pose([])}{out}</model></sdf>'


def make_mjcf(chance, place):
    files = {"main.xml": ""}
    Mjcf(chance, files, 0).write("main.xml")
    for name, text in files.items():
        (place / name).write_text(text)
    return place / "main.xml"


def make_sdf(chance, place):
    others = []
    for depth in (2, 1):
        made = []
        for k in range(chance.choice([1, 2])):
            minor = chance.choice([5, 6, 7, 8, 9, 10])
            model = Sdf(chance, f"s{depth}{k}", minor, [other for other in others if minor >= 7 and chance.random() < 0.6])
            folder = place / "models" / model.name
            folder.mkdir(parents=True)
            (folder / "model.config").write_text(f'<model><name>{model.name}</name><sdf version="1.{minor}">model.sdf</sdf></model>')
            (folder / "model.sdf").write_text(model.text())
            made.append(model)
        others = made
    (place / "r.sdf").write_text(Sdf(chance, "r", chance.choice([7, 8, 9, 10, 11]), others).text())
    os.environ["ROS_PACKAGE_PATH"] = str(place / "models")
    return place / "r.sdf"


def main():
    program, count = str(pathlib.Path(sys.argv[1]).resolve()), int(sys.argv[3]) if len(sys.argv) > 3 else 40
    chance, fail = random.Random(int(sys.argv[4]) if len(sys.argv) > 4 else 1), readers.Failures()
    compared = {"mujoco": 0, "drake": 0}
    for make, engine in ((make_mjcf, "mujoco"), (make_sdf, "drake")):
        for number in range(count):
            with tempfile.TemporaryDirectory() as place:
                os.chdir(place)  # where MuJoCo writes its log
                path = make(chance, pathlib.Path(place))
                read = json.loads(subprocess.run([program, str(path)], capture_output=True, text=True, check=True).stdout)[str(path)]
                answer = readers.load(engine, path, read)
                if not answer["loaded"]:  # some have what the engine refuses
                    continue
                compared[engine] += 1
                if "error" in read:
                    fail(number, f"{engine} loads it, and it is refused: {read['error']}")
                for fault in answer["faults"]:
                    fail(number, f"{engine}: {fault}")
                if (answer["worst"] or 0) > readers.TOLERANCE:
                    fail(number, f"links are {answer['worst']} away from where {engine} has them")
        if compared[engine] < count / 2:
            fail(engine, f"it loads {compared[engine]} of {count} models alone")
    print("compared:", ", ".join(f"{n} with {engine}" for engine, n in compared.items()))
    return 1 if fail.count else 0


if __name__ == "__main__":
    sys.exit(main())
