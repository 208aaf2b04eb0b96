"""CoACD's package on one mesh: decompose.py MESH.off RESULT.obj THRESHOLD REPORT.json; one object per convex body.

Run by an interpreter that has the packages of reproduce/requirements.txt. Seed 0; one thread as far as the package allows.
"""

import importlib.metadata
import json
import pathlib
import resource
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "reproduce"))
import meshes  # noqa: E402


def main(mesh, result, threshold, report):
    import coacd
    import numpy
    points, triangles = meshes.read_off(mesh)
    coacd.set_log_level("error")

    def seconds():
        return resource.getrusage(resource.RUSAGE_SELF).ru_utime
    before = seconds()
    parts = coacd.run_coacd(coacd.Mesh(numpy.array(points), numpy.array(triangles)), threshold=float(threshold), seed=0)
    spent = seconds() - before
    bodies = [([tuple(map(float, p)) for p in vertices], [list(map(int, t)) for t in faces]) for vertices, faces in parts]
    meshes.write_objects(result, bodies)
    pathlib.Path(report).write_text(json.dumps({"version": importlib.metadata.version("coacd"), "bodies": len(bodies),
                                                "vertices": sum(len(p) for p, _ in bodies), "user_seconds": spent}) + "\n", encoding="utf-8")


main(*sys.argv[1:])
