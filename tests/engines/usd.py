#!/usr/bin/env python3
"""Robots written as USD: OpenUSD reads them, its checkers find no fault, and bodies, frames and limits are those that were written.

usage: usd.py ROBOT_POSES BIN

Rules of simulation assets are checked as far as they are published as statements on UsdPhysics: metres, kilograms, Z up, a default
prim, one articulation root, rigid bodies side by side, each with colliders below it or none, joints between bodies that exist, limits in
order, masses and inertias above 0, convex hulls within 64 vertices by --max-vertices-per-body. Run by the Python of
`scripts/setup --engines`; exit code 77 where it has no OpenUSD.
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

try:
    import numpy as np
    from pxr import Usd, UsdGeom, UsdPhysics, UsdUtils
except ImportError:
    print("usd.py: skipped: no OpenUSD here; scripts/setup --engines", file=sys.stderr)
    sys.exit(77)

from checks import check, exit_code  # noqa: E402

BOX = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))


def obj(*boxes):
    text, base = "", 0
    for low, high in boxes:
        text += "".join("v " + " ".join(str((high if k >> i & 1 else low)[i]) for i in range(3)) + "\n" for k in range(8))
        text += "".join(f"f {base + a + 1} {base + b + 1} {base + c + 1} {base + d + 1}\n" for a, b, c, d in BOX)
        base += 8
    return text


INERTIAL = ('<inertial><origin xyz="0.1 0.2 0.3" rpy="0.4 0.5 0.6"/><mass value="2.5"/>'
            '<inertia ixx="0.3" iyy="0.4" izz="0.5" ixy="0.01" ixz="0.02" iyz="-0.03"/></inertial>')
# Names that are no identifiers, one that another becomes; a mirrored scale; all shapes and joints; a joint that mimics.
ROBOT = f"""<robot name="test robot"><link name="base">{INERTIAL}<collision><geometry><mesh filename="ell.obj"/></geometry></collision></link>
<link name="arm 1/é">{INERTIAL}<collision><origin xyz="0.1 0 0" rpy="0.1 0.2 0.3"/><geometry><mesh filename="ell.obj" scale="0.5 -0.7 2"/></geometry></collision>
<collision><geometry><box size="0.2 0.3 0.4"/></geometry></collision></link>
<link name="arm_1__"><collision><origin xyz="0 0 -0.5" rpy="1 0 0"/><geometry><cylinder radius="0.1" length="0.4"/></geometry></collision></link>
<link name="hand">{INERTIAL}<collision><geometry><sphere radius="0.1"/></geometry></collision></link><link name="finger">{INERTIAL}</link>
<joint name="first" type="revolute"><parent link="base"/><child link="arm 1/é"/><origin xyz="0 0 1" rpy="0.3 0 0"/><axis xyz="0 1 0.5"/>
<limit lower="-2" upper="1.5" effort="1" velocity="1"/></joint>
<joint name="second" type="continuous"><parent link="arm 1/é"/><child link="arm_1__"/><origin xyz="0.2 0 1" rpy="0.3 1 2"/><axis xyz="-1 0 0"/></joint>
<joint name="third" type="fixed"><parent link="arm_1__"/><child link="hand"/><origin xyz="0.2 0.1 0.3" rpy="0.3 0 0.4"/></joint>
<joint name="fourth" type="prismatic"><parent link="hand"/><child link="finger"/><origin xyz="0 0 0.2"/><axis xyz="0 0 1"/>
<limit lower="0" upper="0.1" effort="1" velocity="1"/></joint></robot>"""


def transform(ours):
    out = np.eye(4)
    out[:3, :3], out[:3, 3] = np.reshape(ours[:9], (3, 3)), ours[9:]
    return out


def from_usd(matrix):
    return np.array(matrix).T  # its vectors are rows


def vertices_of(path):
    data = path.read_bytes()
    kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    return np.unique(np.frombuffer(data, kind, int.from_bytes(data[80:84], "little"), 84)["corners"].reshape(-1, 3), axis=0)


def run_checkers(path):
    if hasattr(UsdUtils, "ComplianceChecker"):  # before 26
        checker = UsdUtils.ComplianceChecker(arkit=False, skipARKitRootLayerCheck=True)
        checker.CheckCompliance(str(path))
        for found in checker.GetErrors() + checker.GetFailedChecks():
            check(False, f"OpenUSD's checker: {found}")
    try:
        from pxr import UsdValidation
    except ImportError:
        print("OpenUSD has no UsdValidation here")
        return
    registry = UsdValidation.ValidationRegistry()
    names = [m.name for m in registry.GetAllValidatorMetadata()]
    validators = registry.GetOrLoadValidatorsByName(names)
    errors = UsdValidation.ValidationContext(validators).Validate(Usd.Stage.Open(str(path)))
    for error in errors:
        check(False, f"OpenUSD's validator: {error.GetName()}: {error.GetMessage()}")
    print(f"{len(names)} validators of OpenUSD")


def check_rules(stage):
    check(UsdGeom.GetStageMetersPerUnit(stage) == 1 and UsdPhysics.GetStageKilogramsPerUnit(stage) == 1, "metres and kilograms")
    check(UsdGeom.GetStageUpAxis(stage) == "Z", "Z is up")
    check(bool(stage.GetDefaultPrim()), "a default prim")
    prims = list(stage.Traverse())
    check([p for p in prims if p.HasAPI(UsdPhysics.ArticulationRootAPI)] == [stage.GetDefaultPrim()], "one articulation root")
    bodies = [p for p in prims if p.HasAPI(UsdPhysics.RigidBodyAPI)]
    for body in bodies:
        check(body.GetParent() == stage.GetDefaultPrim(), f"{body.GetPath()}: rigid bodies are side by side")
        if body.HasAPI(UsdPhysics.MassAPI):
            mass = UsdPhysics.MassAPI(body)
            check(mass.GetMassAttr().Get() > 0 and min(mass.GetDiagonalInertiaAttr().Get()) > 0, f"{body.GetPath()}: its mass")
    for p in prims:
        if p.HasAPI(UsdPhysics.CollisionAPI):
            check(p.GetParent() in bodies and p.IsA(UsdGeom.Gprim), f"{p.GetPath()}: a collider is a shape of a body")
        if p.IsA(UsdGeom.Mesh):
            check(UsdPhysics.MeshCollisionAPI(p).GetApproximationAttr().Get() == "convexHull", f"{p.GetPath()}: its approximation")
            check(len(UsdGeom.Mesh(p).GetPointsAttr().Get()) <= 64, f"{p.GetPath()}: more than 64 vertices")
        if p.IsA(UsdPhysics.Joint):
            joint = UsdPhysics.Joint(p)
            targets = joint.GetBody0Rel().GetTargets() + joint.GetBody1Rel().GetTargets()
            check(len(joint.GetBody1Rel().GetTargets()) == 1 and all(stage.GetPrimAtPath(t) in bodies for t in targets), f"{p.GetPath()}: its bodies")
    return bodies


def check_bodies(stage, folder, names, read):
    """Vertices, scales and poses in the link are those of the URDF; links are where our kinematics has them with all joints at 0."""
    root = stage.GetDefaultPrim().GetPath()
    count = 0
    for link in ElementTree.parse(folder / "robot.urdf").getroot().findall("link"):
        prim = stage.GetPrimAtPath(root.AppendChild(names[link.get("name")]))
        shapes = [c for c in prim.GetChildren() if c.HasAPI(UsdPhysics.CollisionAPI)]
        elements = link.findall("collision")
        check(len(shapes) == len(elements), f"{prim.GetPath()}: {len(shapes)} shapes, not {len(elements)}")
        ours = [l for l in read["links"] if l["name"] == link.get("name")][0]["collision"]
        for shape, element, own in zip(shapes, elements, ours):
            matrix = from_usd(UsdGeom.Xformable(shape).GetLocalTransformation())
            mesh = element.find("geometry/mesh")
            scale = np.array(own["size"]) if mesh is not None or element.find("geometry/box") is not None else np.ones(3)
            check(np.abs(matrix - transform(own["origin"]) @ np.diag([*scale, 1])).max() < 1e-15, f"{shape.GetPath()}: its pose")
            if mesh is None:
                continue
            points = np.array(UsdGeom.Mesh(shape).GetPointsAttr().Get(), dtype=np.float32)
            check(np.array_equal(np.unique(points, axis=0), vertices_of(folder / mesh.get("filename"))), f"{shape.GetPath()}: its vertices are others")
            check(min(np.bincount(UsdGeom.Mesh(shape).GetFaceVertexIndicesAttr().Get())) >= 3, f"{shape.GetPath()}: its faces")
            extent = UsdGeom.Mesh(shape).GetExtentAttr().Get()
            check(np.array_equal(np.array(extent), [points.min(axis=0), points.max(axis=0)]), f"{shape.GetPath()}: its extent")
            count += 1
    return count


def check_joints(stage, names):
    """Both frames of each joint are in one place, with all joints at 0; limits as in the URDF."""
    cache = UsdGeom.XformCache()
    seen = 0
    for p in stage.Traverse():
        if not p.IsA(UsdPhysics.Joint):
            continue
        joint, places = UsdPhysics.Joint(p), []
        for rel, position, turn in ((joint.GetBody0Rel(), joint.GetLocalPos0Attr(), joint.GetLocalRot0Attr()), (joint.GetBody1Rel(), joint.GetLocalPos1Attr(), joint.GetLocalRot1Attr())):
            body = from_usd(cache.GetLocalToWorldTransform(stage.GetPrimAtPath(rel.GetTargets()[0]))) if rel.GetTargets() else np.eye(4)
            q = turn.Get()
            w, (x, y, z) = q.GetReal(), q.GetImaginary()
            local = np.eye(4)
            local[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                             [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
            local[:3, 3] = position.Get()
            places.append(body @ local)
        check(np.abs(places[0] - places[1]).max() < 1e-6, f"{p.GetPath()}: its frames are {np.abs(places[0] - places[1]).max()} apart")
        seen += 1
        if p.GetName() == "first":
            typed = UsdPhysics.RevoluteJoint(p)
            check(abs(typed.GetLowerLimitAttr().Get() - math.degrees(-2)) < 1e-5 and abs(typed.GetUpperLimitAttr().Get() - math.degrees(1.5)) < 1e-5, "limits of first")
            axis = places[0][:3, 0]
            body = from_usd(cache.GetLocalToWorldTransform(stage.GetPrimAtPath(joint.GetBody1Rel().GetTargets()[0])))
            check(np.abs(axis - body[:3, :3] @ (np.array([0, 1, 0.5]) / math.sqrt(1.25))).max() < 1e-6, "the axis of first")
        if p.GetName() == "second":
            check(not math.isfinite(UsdPhysics.RevoluteJoint(p).GetLowerLimitAttr().Get() or -math.inf), "second has no limits")
        if p.GetName() == "fourth":
            typed = UsdPhysics.PrismaticJoint(p)
            check(typed.GetLowerLimitAttr().Get() == 0 and abs(typed.GetUpperLimitAttr().Get() - 0.1) < 1e-7, "limits of fourth")
    check(seen == 5, f"{seen} joints, not 5")


def main():
    program, tools = sys.argv[1], pathlib.Path(sys.argv[2]).absolute()
    with tempfile.TemporaryDirectory() as place:
        place = pathlib.Path(place)
        (place / "ell.obj").write_text(obj(((0, 0, 0), (0.4, 0.1, 0.1)), ((0, 0.05, 0), (0.1, 0.3, 0.1))))
        (place / "robot.urdf").write_text(ROBOT)
        texts = []
        for threads in ("1", "2"):
            done = subprocess.run([str(tools / "bcd-decompose"), "robot.urdf", "-o", "out", "--epsilon", "2mm", "--effort", "fast", "--robot-format", "usd", "--no-cache",
                                   "--threads", threads, "--max-vertices-per-body", "64"], cwd=place, capture_output=True, text=True, check=False)
            check(done.returncode == 0, f"bcd-decompose: exit code {done.returncode}: {done.stderr[-300:]}")
            texts.append((place / "out/robot.usda").read_bytes())
        check(texts[0] == texts[1], "other bytes with other threads")
        path = place / "out/robot.usda"
        run_checkers(path)
        stage = Usd.Stage.Open(str(path))
        bodies = check_rules(stage)
        names = {p.GetMetadata("displayName") or p.GetName(): p.GetName() for p in bodies}
        check(sorted(names) == sorted(["base", "arm 1/é", "arm_1__", "hand", "finger"]), f"links: {names}")
        read = json.loads(subprocess.run([program, str(place / "out/robot.urdf")], capture_output=True, text=True, check=True).stdout)[str(place / "out/robot.urdf")]
        print(f"{len(bodies)} links, {check_bodies(stage, place / 'out', names, read)} bodies")
        check_joints(stage, names)
    return exit_code()


if __name__ == "__main__":
    sys.exit(main())
