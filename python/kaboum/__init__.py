"""KABouM: collision geometry that can be trusted.

Simplified meshes that provably enclose the original or are provably enclosed by it, convex
decompositions that provably cover it, swept volumes of robots, distances with certified bounds, and
plans.

A *mesh* is a `Mesh` or another result that is one, the name of a file, a pair of arrays (vertices,
faces), or anything with `vertices` and `faces`, such as a trimesh.Trimesh. Lengths are in the mesh's
own unit. Calls run without the interpreter's lock, and give the same result on any number of threads.
Whatever goes wrong is an `Error`.
"""

from ._kaboum import (
    BoundingMesh,
    CertifiedRobot,
    CertifiedSet,
    Contacts,
    ConvexSet,
    Distances,
    Error,
    Mesh,
    MotionCheck,
    Path,
    Prepared,
    Robot,
    Solution,
    SweptSet,
    Verdict,
    World,
    __version__,
    certify_robot,
    check_plan,
    decimate,
    decompose,
    hausdorff,
    prepare,
    read,
    read_robot,
    read_set,
    solve,
    sweep,
    verify_cover,
    verify_mesh,
    verify_robot,
    verify_sweep,
    write,
)

__all__ = [
    "BoundingMesh",
    "CertifiedRobot",
    "CertifiedSet",
    "Contacts",
    "ConvexSet",
    "Distances",
    "Error",
    "Mesh",
    "MotionCheck",
    "Path",
    "Prepared",
    "Robot",
    "Solution",
    "SweptSet",
    "Verdict",
    "World",
    "certify_robot",
    "check_plan",
    "decimate",
    "decompose",
    "hausdorff",
    "prepare",
    "read",
    "read_robot",
    "read_set",
    "solve",
    "sweep",
    "verify_cover",
    "verify_mesh",
    "verify_robot",
    "verify_sweep",
    "write",
]
