"""The example's world as a scene of ours, made from PDDLStream's own files: robot, floor, sink, stove and two blocks."""
import json
import math
import pathlib
import subprocess
import xml.etree.ElementTree as ET

MODELS = pathlib.Path("examples/pybullet/utils/models")
ROBOT = MODELS / "drake/iiwa_description/urdf/iiwa14_polytope_collision.urdf"
# What examples/pybullet/kuka/run.py loads, and where it puts it. Boxes are those for collision.
BOXES = {"sink": (MODELS / "sink.urdf", (-0.5, 0)), "stove": (MODELS / "stove.urdf", (0.5, 0)),
         "celery": (MODELS / "drake/objects/block_for_pick_and_place_mid_size.urdf", (0, 0.5)),
         "radish": (MODELS / "drake/objects/block_for_pick_and_place.urdf", (0, -0.5)),
         "floor": (MODELS / "short_floor.urdf", (0, 0))}
BLOCKS = ("celery", "radish")
# Of sink and stove, which measure 0.25 m; theirs are drawn at random.
PLACES = (("top", 0, 0.06), ("top2", 0, -0.06), ("top3", 0.06, 0), ("top4", -0.06, 0))
TOOL = 0.045  # from link 7 to iiwa_link_ee_kuka, along z [m]
GAP = 0.003  # between flange and block [m], more than the ε of the flange: theirs is half a millimetre


def robot_with_links(root, target, base):
    """Writes the robot with the mesh of each link as its shape for collision. The example's file has one of the last link only.
    @param base  with the link that stands on the floor, which theirs would take for a collision"""
    source = root / ROBOT
    tree = ET.parse(source)
    for link in tree.getroot().iter("link"):
        name = link.get("name")
        for old in link.findall("collision"):
            link.remove(old)
        if not name.startswith("iiwa_link_") or not name[-1].isdigit() or (name.endswith("_0") and not base):
            continue
        mesh = (source.parent / f"../meshes/collision/link_{name[-1]}.obj").resolve()
        geometry = ET.SubElement(ET.SubElement(link, "collision"), "geometry")
        ET.SubElement(geometry, "mesh", filename=str(mesh))
    for mesh in tree.getroot().iter("mesh"):
        mesh.set("filename", str((source.parent / mesh.get("filename")).resolve()))
    tree.write(target)


def box(root, name):
    """Size and centre of the first box for collision."""
    collision = ET.parse(root / BOXES[name][0]).getroot().find("link").find("collision")
    origin = collision.find("origin")
    at = [float(w) for w in origin.get("xyz").split()] if origin is not None else [0.0, 0.0, 0.0]
    return [float(w) for w in collision.find("geometry/box").get("size").split()], at


def make(root, folder, scene_tool, epsilon="0.002"):
    """Writes iiwa14.urdf, kitchen.json and all that it names. @return the scene's file"""
    folder.mkdir(parents=True, exist_ok=True)
    robot_with_links(root, folder / "iiwa14.urdf", base=True)
    file = folder / "kitchen.json"
    subprocess.run([scene_tool, "make", file, "--force", "--quiet", "--robot", f"arm={folder / 'iiwa14.urdf'}",
                    "--epsilon", epsilon, "--effort", "fast"], check=True)
    scene = json.loads(file.read_text())
    scene["robots"][0]["tools"] = [{"name": "flange", "link": "iiwa_link_7", "position": [0, 0, TOOL]}]
    scene["objects"] = []
    for name, (_, (x, y)) in BOXES.items():
        size, centre = box(root, name)
        z = centre[2] if name not in BLOCKS else size[2] / 2 + 0.0025
        thing = {"name": name, "pose": {"position": [x, y, z]}, "shape": {"box": {"size": size}}}
        if name in BLOCKS:
            thing["features"] = [{"name": "bottom", "point": [0, 0, -size[2] / 2]}]
            thing["grasps"] = [{"name": f"top{k}", "position": [0, 0, size[2] / 2 + GAP], "rpy": [math.pi, 0, k * math.pi / 2]} for k in range(4)]
        elif name != "floor":
            thing["features"] = [{"name": name, "point": [x, y, size[2] / 2]} for name, x, y in PLACES]
        scene["objects"].append(thing)
    scene["allowed_contacts"] = [["arm/iiwa_link_0", "floor"]]
    file.write_text(json.dumps(scene, indent=1) + "\n")
    return file
