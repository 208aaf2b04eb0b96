from os import PathLike
from typing import Any, Callable, Literal, Mapping, Protocol, Sequence, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str
__all__: list[str]

class _HasFaces(Protocol):
    @property
    def vertices(self) -> Any: ...
    @property
    def faces(self) -> Any: ...

_Path = Union[str, PathLike[str]]
_Mesh = Union[_HasFaces, _Path, tuple[ArrayLike, ArrayLike]]
_Length = Union[float, str]
_EpsilonMap = Union[_Path, list[dict[str, Any]]]
_Progress = Callable[[str], object]
_Bracket = tuple[float, float]
_Answer = Literal["verified", "refuted", "undecided", "undefined"]
_Effort = Literal["fast", "normal", "best"]
_Language = Literal["kpl", "pddl"]

class Error(Exception):
    code: str
    exit_code: int

class Mesh:
    def __init__(self, vertices: ArrayLike, faces: ArrayLike) -> None: ...
    @property
    def vertices(self) -> NDArray[np.float64]: ...
    @property
    def faces(self) -> NDArray[np.uint32]: ...
    @property
    def source(self) -> str: ...
    @property
    def sha256(self) -> str: ...
    @property
    def unit(self) -> str: ...
    @property
    def deviation(self) -> float: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def volume(self) -> float: ...
    @property
    def diagonal(self) -> float: ...

class Prepared:
    @property
    def vertices(self) -> NDArray[np.float64]: ...
    @property
    def faces(self) -> NDArray[np.uint32]: ...
    @property
    def source(self) -> NDArray[np.uint32]: ...
    @property
    def closed(self) -> bool: ...
    @property
    def components(self) -> int: ...
    @property
    def holes(self) -> int: ...
    @property
    def largest_hole(self) -> float: ...
    @property
    def dropped_copies(self) -> int: ...
    @property
    def dropped_sheets(self) -> int: ...
    @property
    def turned_triangles(self) -> int: ...
    @property
    def guessed(self) -> bool: ...
    @property
    def notes(self) -> list[str]: ...

class BoundingMesh:
    @property
    def vertices(self) -> NDArray[np.float64]: ...
    @property
    def faces(self) -> NDArray[np.uint32]: ...
    @property
    def direction(self) -> str: ...
    @property
    def stop(self) -> str: ...
    @property
    def reached(self) -> bool: ...
    @property
    def holds(self) -> bool: ...
    @property
    def wrapped(self) -> bool: ...
    @property
    def closed(self) -> bool: ...
    @property
    def out_of_work(self) -> bool: ...
    @property
    def epsilon(self) -> float | None: ...
    @property
    def distances(self) -> dict[str, _Bracket] | None: ...
    @property
    def certificate(self) -> dict[str, Any]: ...
    @property
    def claims(self) -> list[dict[str, Any]]: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def bytes(self) -> bytes: ...
    def write(self, path: _Path) -> None: ...
    def write_preview(self, file: _Path) -> None: ...

class ConvexSet:
    def __init__(self, bodies: list[Any], *, radii: ArrayLike = 0.0) -> None: ...
    @property
    def bodies(self) -> list[Mesh]: ...
    @property
    def radii(self) -> NDArray[np.float64]: ...
    @property
    def record(self) -> dict[str, Any]: ...
    def write(self, path: _Path) -> None: ...
    def write_preview(self, file: _Path, *, explode: float = 0.5) -> None: ...
    def __len__(self) -> int: ...

class CertifiedSet:
    @property
    def certificate(self) -> dict[str, Any]: ...
    @property
    def bodies(self) -> list[Mesh]: ...
    @property
    def radii(self) -> NDArray[np.float64]: ...
    @property
    def record(self) -> dict[str, Any]: ...
    @property
    def report(self) -> dict[str, Any]: ...
    @property
    def reached(self) -> bool: ...
    @property
    def distance(self) -> _Bracket: ...
    @property
    def cached(self) -> bool: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def bytes(self) -> bytes: ...
    def write(self, path: _Path) -> None: ...
    def write_preview(self, file: _Path, *, explode: float = 0.5) -> None: ...
    def __len__(self) -> int: ...

class SweptSet:
    @property
    def certificate(self) -> dict[str, Any]: ...
    @property
    def set(self) -> ConvexSet: ...
    @property
    def bodies(self) -> list[Mesh]: ...
    @property
    def margin(self) -> float: ...
    @property
    def claim(self) -> str: ...
    @property
    def reach(self) -> float: ...
    @property
    def bodies_distance(self) -> float: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def bytes(self) -> bytes: ...
    def write(self, path: _Path) -> None: ...
    def write_preview(self, file: _Path) -> None: ...
    def __len__(self) -> int: ...

class Distances:
    @property
    def lower(self) -> float: ...
    @property
    def upper(self) -> float: ...
    @property
    def minimum(self) -> _Bracket: ...
    @property
    def a_to_b(self) -> dict[str, Any]: ...
    @property
    def b_to_a(self) -> dict[str, Any]: ...
    @property
    def diagonal(self) -> float: ...

class Verdict:
    @property
    def answer(self) -> _Answer: ...
    @property
    def claims(self) -> dict[str, Any]: ...
    @property
    def notes(self) -> list[str]: ...
    def __bool__(self) -> bool: ...

class Robot:
    @property
    def name(self) -> str: ...
    @property
    def path(self) -> str: ...
    @property
    def sha256(self) -> str: ...
    @property
    def links(self) -> list[str]: ...
    @property
    def joints(self) -> list[dict[str, str]]: ...
    @property
    def variables(self) -> list[str]: ...
    @property
    def limits(self) -> list[tuple[float | None, float | None]]: ...
    @property
    def unmodelled(self) -> list[str]: ...
    @property
    def notes(self) -> list[str]: ...

class CertifiedRobot:
    @property
    def links(self) -> dict[str, ConvexSet]: ...
    @property
    def verdicts(self) -> list[tuple[str, str, str]]: ...
    @property
    def regions(self) -> list[dict[str, Any]]: ...
    @property
    def distance(self) -> float: ...
    @property
    def notes(self) -> list[str]: ...
    def write(
        self,
        folder: _Path,
        *,
        formats: str | Sequence[str] | None = None,
        loader: Literal["moveit", "mujoco", "gazebo", "bullet", "drake"] | None = None,
        mesh_prefix: str | None = None,
        srdf: bool = False,
        no_cache: bool = False,
        progress: _Progress | None = None,
    ) -> dict[str, list[str]]: ...
    def write_preview(self, file: _Path, *, explode: float = 0.5) -> None: ...
    def write_page(self, file: _Path) -> None: ...

class EnclosedRobot:
    @property
    def meshes(self) -> list[dict[str, Any]]: ...
    @property
    def verdicts(self) -> list[tuple[str, str, str]]: ...
    @property
    def distance(self) -> float: ...
    @property
    def notes(self) -> list[str]: ...
    def write(
        self,
        folder: _Path,
        *,
        formats: str | Sequence[str] | None = None,
        loader: Literal["moveit", "mujoco", "gazebo", "bullet", "drake"] | None = None,
        mesh_prefix: str | None = None,
        no_cache: bool = False,
    ) -> dict[str, list[str]]: ...
    def write_page(self, file: _Path) -> None: ...
    def __bool__(self) -> bool: ...

class Solution:
    @property
    def outcome(self) -> Literal["solved", "unsolvable", "not inferred", "limit"]: ...
    @property
    def limit(self) -> str: ...
    @property
    def lost(self) -> str: ...
    @property
    def refused(self) -> str: ...
    @property
    def plan(self) -> dict[str, Any] | None: ...
    @property
    def text(self) -> str: ...
    @property
    def size(self) -> dict[str, int] | None: ...
    @property
    def failed_calls(self) -> list[dict[str, Any]]: ...
    @property
    def statistics(self) -> dict[str, Any]: ...
    @property
    def notes(self) -> list[str]: ...
    def write(self, path: _Path) -> None: ...
    def __bool__(self) -> bool: ...

class PlanCheck:
    @property
    def violation(self) -> str: ...
    @property
    def states(self) -> int: ...
    @property
    def ends(self) -> int: ...
    @property
    def size(self) -> dict[str, int]: ...
    def __bool__(self) -> bool: ...

class PlanRun:
    @property
    def counts(self) -> dict[str, Any]: ...
    @property
    def replans(self) -> list[dict[str, Any]]: ...
    @property
    def problems(self) -> list[str]: ...
    @property
    def notes(self) -> list[str]: ...
    def __bool__(self) -> bool: ...

class Batch:
    @property
    def rows(self) -> list[dict[str, Any]]: ...
    @property
    def counts(self) -> dict[str, int]: ...
    @property
    def done_before(self) -> int: ...
    @property
    def to_do(self) -> int: ...
    def __bool__(self) -> bool: ...
    def __len__(self) -> int: ...

class Contacts:
    @property
    def pairs(self) -> list[dict[str, Any]]: ...
    def __bool__(self) -> bool: ...
    def __len__(self) -> int: ...

class MotionCheck:
    @property
    def outcome(self) -> Literal["free", "contact", "undecided"]: ...
    @property
    def free_until(self) -> tuple[int, float]: ...
    @property
    def contact(self) -> dict[str, Any] | None: ...
    @property
    def kept(self) -> Literal["kept", "broken", "undecided"] | None: ...
    @property
    def kept_until(self) -> tuple[int, float]: ...
    @property
    def deviation(self) -> str | None: ...
    def __bool__(self) -> bool: ...

class Inclusion:
    @property
    def answer(self) -> Literal["inside", "not certainly inside", "undecided"]: ...
    @property
    def until(self) -> tuple[int, float] | None: ...
    def __bool__(self) -> bool: ...

class LinkPairs:
    @property
    def pairs(self) -> list[dict[str, Any]]: ...
    @property
    def never_in_contact(self) -> dict[str, Any]: ...
    @property
    def srdf(self) -> str: ...
    def __len__(self) -> int: ...

class Path:
    @property
    def outcome(self) -> str: ...
    @property
    def waypoints(self) -> NDArray[np.float64]: ...
    @property
    def goal(self) -> int | None: ...
    @property
    def straight(self) -> bool: ...
    @property
    def contact(self) -> dict[str, Any] | None: ...
    @property
    def blockers(self) -> list[tuple[str, str, int]]: ...
    @property
    def kept(self) -> str: ...
    @property
    def broken(self) -> str | None: ...
    def trajectory(
        self,
        *,
        # options of trajectory
        time_optimal: bool = False,
        rate: float = 1000.0,
        blend: float = 0.0,
        max_velocity: float | Mapping[str, float] | None = None,
        max_acceleration: float | Mapping[str, float] | None = None,
        max_jerk: float | Mapping[str, float] | None = None,
        # end of options
        progress: _Progress | None = None,
    ) -> Trajectory: ...
    def __bool__(self) -> bool: ...
    def __len__(self) -> int: ...

class PathFinder:
    @property
    def nodes(self) -> int: ...
    @property
    def edges(self) -> int: ...
    def find_path(
        self,
        start: ArrayLike,
        goals: ArrayLike,
        *,
        # options of find_path
        max_work: float = 10.0,
        max_nodes: int = 100000,
        timeout: float | None = None,
        shortcuts: int = 60,
        seed: int = 1,
        resolution: _Length = 1e-05,
        # end of options
        # options of keep
        keep: str | Sequence[str] | None = None,
        tool: str = "",
        # end of options
        progress: _Progress | None = None,
    ) -> Path: ...
    def make_roadmap(
        self,
        *,
        nodes: int = 1000,
        neighbours: int = 12,
        seed: int = 1,
        progress: _Progress | None = None,
    ) -> None: ...
    def read_roadmap(self, file: _Path) -> None: ...
    def write_roadmap(self, file: _Path) -> None: ...

class Trajectory:
    @property
    def duration(self) -> float: ...
    @property
    def rate(self) -> float: ...
    @property
    def positions(self) -> NDArray[np.float64]: ...
    @property
    def velocities(self) -> NDArray[np.float64]: ...
    @property
    def accelerations(self) -> NDArray[np.float64]: ...
    @property
    def blends(self) -> list[float]: ...
    @property
    def between_samples(self) -> list[float]: ...
    def write(self, file: _Path) -> None: ...
    def __len__(self) -> int: ...

class InverseKinematics:
    @property
    def joints(self) -> list[str]: ...
    @property
    def solutions(self) -> NDArray[np.float64]: ...
    @property
    def details(self) -> list[dict[str, Any]]: ...
    @property
    def families(self) -> list[dict[str, Any]]: ...
    @property
    def complete(self) -> bool: ...
    @property
    def incomplete(self) -> str: ...
    @property
    def family(self) -> str | None: ...
    def __bool__(self) -> bool: ...
    def __len__(self) -> int: ...

class Wrap:
    @property
    def certificate(self) -> dict[str, Any]: ...
    @property
    def vertices(self) -> NDArray[np.float64]: ...
    @property
    def faces(self) -> NDArray[np.uint32]: ...
    @property
    def report(self) -> dict[str, Any]: ...
    @property
    def distance(self) -> _Bracket: ...
    @property
    def notes(self) -> list[str]: ...

class Scene:
    def __init__(self, *, unit: str = "m") -> None: ...
    @staticmethod
    def read(path: _Path) -> Scene: ...
    @property
    def unit(self) -> str: ...
    @property
    def path(self) -> str | None: ...
    @property
    def data(self) -> dict[str, Any]: ...
    def add_robot(self, name: str, robot: CertifiedRobot, *, at: Sequence[float] | None = None, **members: Any) -> None: ...
    def add_object(
        self,
        name: str,
        shape: CertifiedSet | _Mesh | dict[str, Any],
        *,
        at: Sequence[float] | None = None,
        inner: CertifiedSet | _Mesh | None = None,
        features: list[dict[str, Any]] | None = None,
        grasps: list[dict[str, Any]] | None = None,
        **options: Any,
    ) -> None: ...
    def add_region(
        self, name: str, shape: CertifiedSet | _Mesh | dict[str, Any], *, at: Sequence[float] | None = None, **options: Any
    ) -> None: ...
    def allow_contact(self, a: str, b: str) -> None: ...
    def attach(self, **members: Any) -> None: ...
    def write(self, path: _Path, *, force: bool = False) -> dict[str, list[str]]: ...

class World:
    def __init__(
        self,
        scene: Scene | _Path,
        *,
        # options of margins
        margin: _Length | Mapping[str, _Length] | None = None,
        # end of options
    ) -> None: ...
    @property
    def unit(self) -> str: ...
    @property
    def margins(self) -> str: ...
    @property
    def robots(self) -> list[str]: ...
    @property
    def objects(self) -> list[str]: ...
    @property
    def regions(self) -> list[str]: ...
    @property
    def notes(self) -> list[str]: ...
    def variables(self, robot: str | None = None) -> list[str]: ...
    def home(self, robot: str | None = None) -> NDArray[np.float64]: ...
    def check(
        self,
        q: ArrayLike,
        *,
        robot: str | None = None,
        # options of check
        resting: bool = False,
        # end of options
        progress: _Progress | None = None,
    ) -> Any: ...
    def contact_pairs(
        self,
        q: ArrayLike,
        *,
        robot: str | None = None,
        # options of engines
        engine: Literal["own", "fcl", "bullet", "ode"] = "own",
        engine_shapes: Literal["sets", "meshes"] = "sets",
        engine_step: _Length = 0.01,
        package_path: _Path | Sequence[_Path] | None = None,
        # end of options
        progress: _Progress | None = None,
    ) -> Any: ...
    def are_free(
        self, q: ArrayLike, *, robot: str | None = None, progress: _Progress | None = None
    ) -> NDArray[np.bool_]: ...
    def with_cloud(
        self,
        points: ArrayLike | _Path,
        radius: float,
        *,
        name: str = "cloud",
        pose: ArrayLike | None = None,
        allow: Sequence[str] = [],
        drop_invalid: bool = False,
    ) -> World: ...
    def check_motion(
        self,
        path: ArrayLike | Mapping[str, ArrayLike],
        *,
        robot: str | None = None,
        # options of check_motion
        resolution: _Length = 1e-05,
        max_intervals: int = 1000000,
        # end of options
        # options of keep
        keep: str | Sequence[str] | None = None,
        tool: str = "",
        # end of options
        progress: _Progress | None = None,
    ) -> MotionCheck: ...
    def motions_are_free(
        self,
        starts: ArrayLike,
        goals: ArrayLike,
        *,
        robot: str | None = None,
        # options of check_motion
        resolution: _Length = 1e-05,
        max_intervals: int = 1000000,
        # end of options
        progress: _Progress | None = None,
    ) -> NDArray[np.bool_]: ...
    def find_path(
        self,
        start: ArrayLike,
        goals: ArrayLike,
        *,
        robot: str | None = None,
        # options of find_path
        max_work: float = 10.0,
        max_nodes: int = 100000,
        timeout: float | None = None,
        shortcuts: int = 60,
        seed: int = 1,
        resolution: _Length = 1e-05,
        # end of options
        # options of keep
        keep: str | Sequence[str] | None = None,
        tool: str = "",
        # end of options
        progress: _Progress | None = None,
    ) -> Path: ...
    def nearest(
        self,
        q: ArrayLike,
        *,
        robot: str | None = None,
        # options of check
        resting: bool = False,
        # end of options
        progress: _Progress | None = None,
    ) -> dict[str, Any] | None: ...
    def draw(
        self,
        q: ArrayLike,
        file: _Path | None = None,
        *,
        robot: str | None = None,
        # options of check
        resting: bool = False,
        # end of options
    ) -> bytes: ...
    def is_inside(
        self,
        what: str,
        region: str,
        q: ArrayLike | None = None,
        *,
        robot: str | None = None,
        progress: _Progress | None = None,
    ) -> Any: ...
    def path_finder(self, *, robot: str | None = None) -> PathFinder: ...
    def pose_goals(
        self,
        pose: ArrayLike,
        *,
        start: ArrayLike | None = None,
        tool: str | None = None,
        robot: str | None = None,
        seed: int = 1,
        progress: _Progress | None = None,
    ) -> NDArray[np.float64]: ...
    def constraint_goals(
        self,
        name: str,
        *,
        start: ArrayLike | None = None,
        tool: str | None = None,
        robot: str | None = None,
        seed: int = 1,
    ) -> NDArray[np.float64]: ...
    def stays_inside(
        self,
        what: str,
        region: str,
        path: ArrayLike,
        *,
        robot: str | None = None,
        # options of check_motion
        resolution: _Length = 1e-05,
        max_intervals: int = 1000000,
        # end of options
        progress: _Progress | None = None,
    ) -> Inclusion: ...
    def link_pairs(
        self,
        *,
        robot: str | None = None,
        # options of link_pairs
        max_boxes: int = 20000,
        timeout: float | None = None,
        # end of options
        progress: _Progress | None = None,
    ) -> LinkPairs: ...

_Set = Union[ConvexSet, CertifiedSet, SweptSet, _Path, list[Any]]
_Robot = Union[Robot, _Path]

def read(path: _Path, *, format: str | None = None, importer: Literal["assimp"] | None = None) -> Mesh: ...
def write(
    mesh: _Mesh,
    path: _Path,
    *,
    format: str | None = None,
    precision: Literal["auto", "float", "double"] = "auto",
) -> None: ...
def read_set(path: _Path, *, format: str | None = None) -> ConvexSet: ...
@overload
def to_trimesh(shape: ConvexSet | CertifiedSet) -> list[Any]: ...
@overload
def to_trimesh(shape: _HasFaces | tuple[ArrayLike, ArrayLike]) -> Any: ...
def from_trimesh(shape: Any) -> Mesh: ...
def read_robot(
    path: _Path,
    *,
    xacro_args: str | Sequence[str] | None = None,
    package_path: _Path | Sequence[_Path] | None = None,
) -> Robot: ...
def prepare(
    mesh: _Mesh,
    *,
    # options of prepare
    drop_sheets: bool = False,
    holes: Literal["fill", "keep", "refuse"] = "fill",
    keep_orientation: bool = False,
    # end of options
) -> Prepared: ...
@overload
def decimate(
    mesh: _Mesh,
    *,
    # options of decimate, vertices: int | None = None
    direction: Literal["outer", "inner", "any"] = "outer",
    vertices: int | None = None,
    ratio: float | None = None,
    epsilon: _Length | None = None,
    cost: Literal["planes", "planes-adapted", "planes-diagonal", "triangles", "distance", "mean"] = "distance",
    effort: Literal["fast", "normal", "best"] = "normal",
    max_work: float | None = None,
    as_printed: bool = False,
    precision: Literal["auto", "float", "double"] = "auto",
    sharp_angle: float | None = None,
    keep_convex: bool = False,
    drop_sheets: bool = False,
    holes: Literal["fill", "keep", "refuse"] = "fill",
    keep_orientation: bool = False,
    prepare: Literal["auto", "strict", "wrap", "off"] = "auto",
    offset: _Length | None = None,
    seal: _Length | None = None,
    verify: bool = False,
    measure: bool = False,
    # end of options
    output_format: str = "ply",
    threads: int = 0,
    progress: _Progress | None = None,
) -> BoundingMesh: ...
@overload
def decimate(
    mesh: _Mesh,
    *,
    # options of decimate, vertices: Sequence[int]
    direction: Literal["outer", "inner", "any"] = "outer",
    vertices: Sequence[int],
    ratio: float | None = None,
    epsilon: _Length | None = None,
    cost: Literal["planes", "planes-adapted", "planes-diagonal", "triangles", "distance", "mean"] = "distance",
    effort: Literal["fast", "normal", "best"] = "normal",
    max_work: float | None = None,
    as_printed: bool = False,
    precision: Literal["auto", "float", "double"] = "auto",
    sharp_angle: float | None = None,
    keep_convex: bool = False,
    drop_sheets: bool = False,
    holes: Literal["fill", "keep", "refuse"] = "fill",
    keep_orientation: bool = False,
    prepare: Literal["auto", "strict", "wrap", "off"] = "auto",
    offset: _Length | None = None,
    seal: _Length | None = None,
    verify: bool = False,
    measure: bool = False,
    # end of options
    output_format: str = "ply",
    threads: int = 0,
    progress: _Progress | None = None,
) -> list[BoundingMesh]: ...
def decompose(
    mesh: _Mesh,
    *,
    epsilon_map: _EpsilonMap | None = None,
    # options of decompose
    epsilon: _Length | None = None,
    max_bodies: int | None = None,
    max_total_vertices: int | None = None,
    bodies: Literal["polytopes", "spheres", "capsules", "boxes", "mixed"] = "polytopes",
    direction: Literal["outer", "inner"] = "outer",
    min_thickness: _Length | None = None,
    max_aspect: float | None = None,
    max_vertices_per_body: int = 64,
    max_facets_per_body: int | None = None,
    effort: Literal["fast", "normal", "best"] = "normal",
    simplify: float | None = None,
    max_work: float | None = None,
    improve_work: float | None = None,
    pre_step: Literal["auto", "on", "off"] = "auto",
    scale: float = 1.0,
    drop_sheets: bool = False,
    holes: Literal["fill", "refuse"] = "fill",
    keep_orientation: bool = False,
    prepare: Literal["auto", "strict", "wrap", "off"] = "auto",
    offset: _Length | None = None,
    seal: _Length | None = None,
    unit: str = "m",
    frame: str = "",
    # end of options
    no_cache: bool = False,
    threads: int = 0,
    progress: _Progress | None = None,
) -> CertifiedSet: ...
def sweep(
    robot: _Robot,
    path: _Path | ArrayLike,
    *,
    verify: bool = False,
    # options of sweep
    epsilon: _Length = 0.005,
    bound: Literal["baginski", "uniform", "subset", "second-order", "adaptive", "balanced"] = "balanced",
    body_epsilon: _Length | None = None,
    max_vertices_per_body: int = 64,
    effort: Literal["fast", "normal", "best"] = "normal",
    geometry: Literal["collision", "visual"] = "collision",
    max_reach: _Length | None = None,
    simplify: float = 0.0,
    links: str | Sequence[str] | None = None,
    joint: Mapping[str, float] | None = None,
    degrees: bool = False,
    base_pose: str = "",
    drop_sheets: bool = False,
    implicit_margin: bool = False,
    no_merge: bool = False,
    ignore_limits: bool = False,
    package_path: _Path | Sequence[_Path] | None = None,
    missing_meshes: Literal["error", "skip"] = "error",
    unit: str = "m",
    # end of options
    no_cache: bool = False,
    threads: int = 0,
    progress: _Progress | None = None,
) -> SweptSet: ...
def hausdorff(
    a: _Mesh | _Set,
    b: _Mesh | _Set,
    *,
    # options of hausdorff
    solid: bool = False,
    gap: float = 0.001,
    samples: int = 100000,
    seed: int = 1,
    backend: Literal["embree", "own"] = "embree",
    # end of options
    threads: int = 0,
    progress: _Progress | None = None,
) -> Distances: ...
def write_heatmap(
    file: _Path,
    a: _Mesh | _Set,
    b: _Mesh | _Set,
    *,
    # options of hausdorff
    solid: bool = False,
    gap: float = 0.001,
    samples: int = 100000,
    seed: int = 1,
    backend: Literal["embree", "own"] = "embree",
    # end of options
    threads: int = 0,
    progress: _Progress | None = None,
) -> Distances: ...
def draw(
    shapes: _Mesh | ConvexSet | CertifiedSet | list[Any],
    file: _Path | None = None,
    *,
    # options of draw
    width: int = 1500,
    height: int = 620,
    titles: str = "",
    view: str = "-50,28",
    colours: str = "grey,blue,orange",
    edges: bool = False,
    # end of options
) -> bytes: ...
def verify_mesh(
    original: _Mesh,
    approximation: _Mesh | ConvexSet | CertifiedSet,
    *,
    relation: Literal["outer", "inner"] = "outer",
    # options of verify_mesh
    claims: Literal["all", "solid", "surface"] = "all",
    epsilon: _Length | None = None,
    prepare: bool | Literal["auto"] = False,
    drop_sheets: bool = False,
    exact_points: int = 17,
    max_contacts: int = 100000000,
    max_work: float | None = None,
    # end of options
    threads: int = 0,
    progress: _Progress | None = None,
) -> Verdict: ...
def verify_cover(
    original: _Mesh,
    set: _Set,
    *,
    epsilon_map: _EpsilonMap | None = None,
    # options of verify_cover
    claims: Literal["all", "solid", "surface"] = "all",
    epsilon: _Length | None = None,
    prepare: bool | Literal["auto"] = False,
    drop_sheets: bool = False,
    exact_points: int = 17,
    max_contacts: int = 100000000,
    max_work: float | None = None,
    # end of options
    threads: int = 0,
    progress: _Progress | None = None,
) -> Verdict: ...
def verify_sweep(
    robot: _Robot,
    path: _Path | ArrayLike,
    swept: _Set,
    *,
    # options of verify_sweep
    claims: Literal["all", "surface"] = "all",
    prepare: bool | Literal["auto"] = False,
    drop_sheets: bool = False,
    exact_points: int = 17,
    gap: _Length | None = None,
    max_cells: int = 20000,
    base_pose: str = "",
    joint: Mapping[str, float] | None = None,
    degrees: bool = False,
    links: str | Sequence[str] | None = None,
    geometry: Literal["collision", "visual"] = "collision",
    package_path: _Path | Sequence[_Path] | None = None,
    # end of options
    threads: int = 0,
    progress: _Progress | None = None,
) -> Verdict: ...
def verify_robot(
    original: _Robot,
    result: _Robot,
    *,
    epsilon_map: _EpsilonMap | None = None,
    # options of verify_robot
    claims: Literal["all", "solid", "surface"] = "all",
    epsilon: _Length | None = None,
    prepare: bool | Literal["auto", "wrap"] = False,
    drop_sheets: bool = False,
    exact_points: int = 17,
    max_contacts: int = 100000000,
    max_work: float | None = None,
    links: str | Sequence[str] | None = None,
    geometry: Literal["collision", "visual"] = "collision",
    package_path: _Path | Sequence[_Path] | None = None,
    missing_meshes: Literal["error", "skip"] = "error",
    # end of options
    threads: int = 0,
    progress: _Progress | None = None,
) -> Verdict: ...
def verify_spheres(
    robot: _Robot,
    spheres: _Path,
    *,
    epsilon: _Length | None = None,
    epsilon_map: _EpsilonMap | None = None,
    # options of shapes
    links: str | Sequence[str] | None = None,
    geometry: Literal["collision", "visual"] = "collision",
    package_path: _Path | Sequence[_Path] | None = None,
    # end of options
    threads: int = 0,
    progress: _Progress | None = None,
) -> Verdict: ...
def write_spheres(
    robot: _Robot,
    file: _Path,
    *,
    epsilon: _Length | None = None,
    epsilon_map: _EpsilonMap | None = None,
    robot_bodies: int | None = None,
    share: Literal["farthest", "mean"] = "farthest",
    effort: Literal["fast", "normal", "best"] = "normal",
    pairs: _Path | None = None,
    # options of shapes
    links: str | Sequence[str] | None = None,
    geometry: Literal["collision", "visual"] = "collision",
    package_path: _Path | Sequence[_Path] | None = None,
    # end of options
    no_cache: bool = False,
    threads: int = 0,
    progress: _Progress | None = None,
) -> dict[str, Any]: ...
def repair_spheres(
    robot: _Robot,
    spheres: _Path,
    file: _Path,
    *,
    epsilon: _Length,
    effort: Literal["fast", "normal", "best"] = "normal",
    # options of shapes
    links: str | Sequence[str] | None = None,
    geometry: Literal["collision", "visual"] = "collision",
    package_path: _Path | Sequence[_Path] | None = None,
    # end of options
    threads: int = 0,
    progress: _Progress | None = None,
) -> dict[str, Any]: ...
def certify_robot(
    robot: _Robot,
    *,
    epsilons: Mapping[str, _Length] | None = None,
    epsilon_map: _EpsilonMap | None = None,
    robot_bodies: int | None = None,
    robot_vertices: int | None = None,
    partial: bool = False,
    # options of held_shapes
    links: str | Sequence[str] | None = None,
    geometry: Literal["collision", "visual"] = "collision",
    package_path: _Path | Sequence[_Path] | None = None,
    missing_meshes: Literal["error", "skip"] = "error",
    # end of options
    # options of certify_robot
    epsilon: _Length | None = None,
    max_bodies: int | None = None,
    max_total_vertices: int | None = None,
    min_thickness: _Length | None = None,
    max_aspect: float | None = None,
    max_vertices_per_body: int = 64,
    max_facets_per_body: int | None = None,
    effort: Literal["fast", "normal", "best"] = "normal",
    simplify: float | None = None,
    max_work: float | None = None,
    improve_work: float | None = None,
    pre_step: Literal["auto", "on", "off"] = "auto",
    drop_sheets: bool = False,
    holes: Literal["fill", "refuse"] = "fill",
    keep_orientation: bool = False,
    prepare: Literal["auto", "strict", "wrap", "off"] = "auto",
    offset: _Length | None = None,
    seal: _Length | None = None,
    unit: str = "m",
    # end of options
    no_cache: bool = False,
    threads: int = 0,
    progress: _Progress | None = None,
) -> CertifiedRobot: ...
def decimate_robot(
    robot: _Robot,
    *,
    epsilons: Mapping[str, _Length] | None = None,
    output_format: Literal["stl", "obj"] | None = None,
    partial: bool = False,
    # options of held_shapes
    links: str | Sequence[str] | None = None,
    geometry: Literal["collision", "visual"] = "collision",
    package_path: _Path | Sequence[_Path] | None = None,
    missing_meshes: Literal["error", "skip"] = "error",
    # end of options
    # options of decimate_robot, vertices: int | None = None
    vertices: int | None = None,
    ratio: float | None = None,
    epsilon: _Length | None = None,
    cost: Literal["planes", "planes-adapted", "planes-diagonal", "triangles", "distance", "mean"] = "distance",
    effort: Literal["fast", "normal", "best"] = "normal",
    max_work: float | None = None,
    as_printed: bool = False,
    precision: Literal["auto", "float", "double"] = "auto",
    sharp_angle: float | None = None,
    keep_convex: bool = False,
    drop_sheets: bool = False,
    holes: Literal["fill", "keep", "refuse"] = "fill",
    keep_orientation: bool = False,
    prepare: Literal["auto", "strict", "wrap", "off"] = "auto",
    offset: _Length | None = None,
    seal: _Length | None = None,
    verify: bool = False,
    measure: bool = False,
    # end of options
    no_cache: bool = False,
    threads: int = 0,
    progress: _Progress | None = None,
) -> EnclosedRobot: ...
def inverse_kinematics(
    robot: _Robot,
    pose: ArrayLike | None = None,
    *,
    tip: str | None = None,
    base: str | None = None,
    pose_of: ArrayLike | None = None,
    reference: ArrayLike | None = None,
    # options of inverse_kinematics
    copies: bool = False,
    ignore_limits: bool = False,
    free_heading: bool = False,
    numeric: bool = False,
    starts: int = 100,
    seed: int = 1,
    # end of options
    progress: _Progress | None = None,
) -> InverseKinematics: ...
def wrap(
    mesh: _Mesh,
    *,
    precision: Literal["float", "double"] = "float",
    # options of wrap
    offset: _Length | None = None,
    seal: _Length | None = None,
    epsilon: _Length | None = None,
    # end of options
    threads: int = 0,
    progress: _Progress | None = None,
) -> Wrap: ...
def replay(
    original: _Path, log: _Path, result: _Mesh, *, scale: float = 1.0, progress: _Progress | None = None
) -> Verdict: ...
def cache_entries(
    *, folder: _Path | None = None, verify: bool = False, progress: _Progress | None = None
) -> list[dict[str, Any]]: ...
def prune_cache(*, folder: _Path | None = None, size: int | None = None) -> dict[str, int]: ...
def make_scene(
    path: _Path,
    *,
    robots: Mapping[str, _Path] | None = None,
    objects: Mapping[str, _Path | Mapping[str, Any]] | None = None,
    regions: Mapping[str, _Path] | None = None,
    at: Mapping[str, Sequence[float]] | None = None,
    scale: Mapping[str, float] = {},
    # options of make_scene
    inner: bool = False,
    inner_links: bool = False,
    geometry: Literal["collision", "visual"] = "collision",
    epsilon: _Length = "1%",
    effort: Literal["fast", "normal", "best"] = "normal",
    drop_sheets: bool = False,
    unit: str = "m",
    package_path: _Path | Sequence[_Path] | None = None,
    force: bool = False,
    # end of options
    no_cache: bool = False,
    threads: int = 0,
    progress: _Progress | None = None,
) -> dict[str, list[str]]: ...
def update_scene(
    path: _Path,
    *,
    # options of update_scene
    package_path: _Path | Sequence[_Path] | None = None,
    # end of options
    no_cache: bool = False,
    threads: int = 0,
    progress: _Progress | None = None,
) -> dict[str, list[str]]: ...
def add_grasps(
    path: _Path,
    objects: str | Sequence[str] | None = None,
    *,
    # options of add_grasps
    robot: str = "",
    tool: str = "",
    hold: Literal["sides", "face"] = "sides",
    form: Literal["both", "families", "poses"] = "both",
    closing: Literal["x", "y"] = "y",
    opening: _Length | None = None,
    tip: _Length | None = None,
    directions: int = 8,
    most: int = 24,
    gap: _Length = 0.001,
    # end of options
) -> dict[str, Any]: ...
def add_places(
    path: _Path,
    objects: str | Sequence[str] | None = None,
    *,
    # options of add_places
    most: int = 8,
    inset: _Length | None = None,
    force: bool = False,
    # end of options
) -> dict[str, Any]: ...
def run_batch(
    inputs: _Path | Sequence[_Path],
    folder: _Path,
    commands: str | Sequence[str] | Mapping[str, str | Sequence[str]],
    *,
    extension: str | None = None,
    jobs: int = 0,
    memory: int | None = None,
    max_memory: int | None = None,
    timeout: float | None = None,
    shard: str | None = None,
    summary: bool = False,
    retry: bool = False,
    pictures: bool = True,
    programs: _Path | None = None,
    progress: _Progress | None = None,
) -> Batch: ...
def solve(
    domain: _Path,
    problem: _Path | None = None,
    *,
    scene: _Path | None = None,
    assume: Mapping[str, bool | str] | _Path | None = None,
    # options of solve
    search: Literal["dfs", "bfs", "ids", "greedy", "astar"] = "greedy",
    timeout: float | None = None,
    max_memory: int | str | None = None,
    seed: int = 1,
    # end of options
    # options of task
    input_format: Literal["kpl", "pddl"] | None = None,
    problem_format: Literal["kpl", "pddl"] | None = None,
    processes: _Path | Sequence[_Path] | None = None,
    process_timeout: float = 10.0,
    plugins: _Path | Sequence[_Path] | None = None,
    # end of options
    # options of margins
    margin: _Length | Mapping[str, _Length] | None = None,
    # end of options
    no_cache: bool = False,
    threads: int = 0,
    progress: _Progress | None = None,
) -> Solution: ...
def check_plan(
    domain: _Path,
    problem: _Path | None,
    plan: Solution | dict[str, Any] | _Path,
    *,
    scene: _Path | None = None,
    # options of task
    input_format: Literal["kpl", "pddl"] | None = None,
    problem_format: Literal["kpl", "pddl"] | None = None,
    processes: _Path | Sequence[_Path] | None = None,
    process_timeout: float = 10.0,
    plugins: _Path | Sequence[_Path] | None = None,
    # end of options
    # options of margins
    margin: _Length | Mapping[str, _Length] | None = None,
    # end of options
    threads: int = 0,
    progress: _Progress | None = None,
) -> PlanCheck: ...
def run_plan(
    domain: _Path,
    problem: _Path | None,
    plan: Solution | dict[str, Any] | _Path,
    *,
    scene: _Path,
    outcomes: int | Mapping[str, bool | str] | _Path = "all",
    trajectories: _Path | None = None,
    # options of run_plan
    replan: int = 100,
    timeout: float | None = None,
    seed: int = 1,
    time_optimal: bool = False,
    rate: float = 1000.0,
    blend: float = 0.0,
    max_velocity: float | Mapping[str, float] | None = None,
    max_acceleration: float | Mapping[str, float] | None = None,
    max_jerk: float | Mapping[str, float] | None = None,
    trajectory_format: Literal["csv", "json", "yaml"] = "csv",
    package_path: _Path | Sequence[_Path] | None = None,
    # end of options
    # options of task
    input_format: Literal["kpl", "pddl"] | None = None,
    problem_format: Literal["kpl", "pddl"] | None = None,
    processes: _Path | Sequence[_Path] | None = None,
    process_timeout: float = 10.0,
    plugins: _Path | Sequence[_Path] | None = None,
    # end of options
    threads: int = 0,
    progress: _Progress | None = None,
) -> PlanRun: ...
def draw_plan(
    domain: _Path,
    problem: _Path | None,
    plan: Solution | dict[str, Any] | _Path,
    *,
    format: Literal["text", "dot", "svg"] = "svg",
    tree: bool = False,
    scene: _Path | None = None,
    # options of task
    input_format: Literal["kpl", "pddl"] | None = None,
    problem_format: Literal["kpl", "pddl"] | None = None,
    processes: _Path | Sequence[_Path] | None = None,
    process_timeout: float = 10.0,
    plugins: _Path | Sequence[_Path] | None = None,
    # end of options
    progress: _Progress | None = None,
) -> str: ...
def write_plan_page(
    file: _Path,
    domain: _Path,
    problem: _Path | None,
    plan: Solution | dict[str, Any] | _Path,
    *,
    scene: _Path,
    tree: bool = False,
    # options of plan_page
    package_path: _Path | Sequence[_Path] | None = None,
    # end of options
    # options of task
    input_format: Literal["kpl", "pddl"] | None = None,
    problem_format: Literal["kpl", "pddl"] | None = None,
    processes: _Path | Sequence[_Path] | None = None,
    process_timeout: float = 10.0,
    plugins: _Path | Sequence[_Path] | None = None,
    # end of options
    progress: _Progress | None = None,
) -> list[str]: ...
def write_run_page(
    file: _Path,
    journal: _Path,
    *,
    scene: _Path,
    # options of plan_page
    package_path: _Path | Sequence[_Path] | None = None,
    # end of options
    progress: _Progress | None = None,
) -> list[str]: ...
def convert_domain(
    domain: _Path,
    problem: _Path | None = None,
    *,
    to: _Language,
    input_format: _Language | None = None,
    problem_format: _Language | None = None,
    progress: _Progress | None = None,
) -> str: ...
