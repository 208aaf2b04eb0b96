"""Convex bodies for a simulator, instead of V-HACD: they cover the part, and no farther than 1 %.

usage: replace_vhacd.py MESH FOLDER
"""
import sys

import kaboum

bodies = kaboum.decompose(sys.argv[1], epsilon="1%", max_vertices_per_body=64)
bodies.write(sys.argv[2])  # a folder of STL files, one for each body
assert kaboum.verify_cover(sys.argv[1], bodies, epsilon=bodies.distance[1], prepare=True)
print(f"{len(bodies)} bodies, no point farther than {bodies.distance[1]:.3g} from the solid; verified")
