// Boxes, volumes and validity of meshes.
#include <kaboum/base/error.h>
#include <kaboum/geom/mesh.h>

namespace kaboum::geom {

Box3 bounding_box(const Mesh& mesh) {
  Box3 box;
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) box.extend(mesh.vertices[v]);
  return box;
}

double signed_volume(const Mesh& mesh) {
  const Box3 box = bounding_box(mesh);
  if (box.empty()) return 0.0;
  const Vec3 o = box.center();
  double six_volumes = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - o, b = mesh.vertices[t[1]] - o,
               c = mesh.vertices[t[2]] - o;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6.0;
}

double area(const Mesh& mesh) {
  double twice = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    twice += (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
  }
  return 0.5 * twice;
}

void require_valid(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t v : mesh.triangles[i]) {
      if (v >= mesh.vertices.size())
        throw Error(ErrorCode::InvalidInput,
                    "triangle " + std::to_string(i) + " refers to vertex " + std::to_string(v) +
                        ", but there are only " + std::to_string(mesh.vertices.size()));
      if (!mesh.vertices[v].allFinite())
        throw Error(ErrorCode::InvalidInput, "vertex " + std::to_string(v) + " of triangle " +
                                                 std::to_string(i) +
                                                 " has a coordinate that is not a finite number");
    }
  }
}

}  // namespace kaboum::geom
