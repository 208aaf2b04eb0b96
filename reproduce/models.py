"""The models of the thesis and what stands for them here."""

import dataclasses
import pathlib


@dataclasses.dataclass(frozen=True)
class Model:
    name: str  # short, also in file names
    title: str
    path: pathlib.Path
    thesis: str = ""  # its name in the tables of the thesis
    figure: str = ""  # of the thesis
    thesis_vertices: int = 0
    robot: bool = False
    quick: bool = False
    differs: str = ""  # how it differs from the thesis's model
    view: str = "-50,20"

    def vertices(self):
        """Vertices in the file, before welding."""
        with open(self.path, "rb") as file:
            if self.path.suffix == ".ply":
                for line in file:
                    if line.startswith(b"element vertex"):
                        return int(line.split()[2])
            return sum(line.startswith(b"v ") for line in file)


def corpus(folder):
    """Models of the corpus of public meshes: those of the thesis first, smallest first."""
    folder = pathlib.Path(folder)
    robots = folder / "thesis-robots"
    coarser = "the same maker's robot of the same class, as published with the Robotics Library, coarser"
    return [
        Model("mitsubishi", "Mitsubishi RV-6S", robots / "mitsubishi-rv6s-whole-welded.ply",
              "MITSUBISHI", "B.5", 108419, True, True, coarser),
        Model("bunny", "Stanford bunny", folder / "scan-stanford-bunny-34834-holes.ply",
              "STANFORD BUNNY", "B.3", 34835, False, True,
              "the published scan with its holes; one unused vertex less", "20,10"),
        Model("comau", "Comau Smart5 NJ4 220-2.7", robots / "comau-smart5-nj4-220-27-whole-welded.ply",
              "COMAU", "B.7", 241190, True, False, coarser + "; its diagonal agrees within 0.12 %"),
        Model("kuka", "KUKA KR 240 R2500 prime", robots / "kuka-kr240-r2500-prime-whole-welded.ply",
              "KUKA", "B.6", 251117, True, False, coarser),
        Model("rv6sl", "Mitsubishi RV-6SL", robots / "mitsubishi-rv6sl-whole-welded.ply", robot=True),
        Model("kr120", "KUKA KR 120 R2500 pro", folder / "robot-kuka-kr120-r2500-pro-whole-welded.ply",
              robot=True),
        Model("ur5", "Universal Robots UR5", folder / "robot-ur5-whole-welded.ply", robot=True),
        Model("puma560", "Unimation PUMA 560", folder / "robot-puma560-whole-welded.ply", robot=True),
        Model("dragon", "Stanford dragon", folder / "scan-stanford-dragon-437645.ply", "DRAGON", "B.4",
              437645, False, False, "the published reconstruction at full resolution", "10,10"),
    ]


def own(root):
    """Models that come with the project."""
    return [Model("bracket", "bracket (the project's own)", root / "meshes" / "bracket.obj", quick=True,
                  differs="no model of the thesis; it shows that the programs work")]
