// A mesh as it will be written: used vertices only, in the numbers of the format.
#include "output.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/float32.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "bytes.h"

namespace kaboum::io {

void Output::text(std::string_view s) { bytes_.insert(bytes_.end(), s.begin(), s.end()); }

bool is_float(double value) {
  return std::abs(value) <= std::numeric_limits<float>::max() && geom::is_float32(value);
}

bool all_float(const geom::Mesh& mesh) {
  for (const geom::Vec3& p : mesh.vertices)
    for (const double x : p)
      if (!is_float(x)) return false;
  return true;
}

void require_float(const geom::Mesh& mesh, const std::vector<std::uint32_t>& original,
                   std::string_view format) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double x = mesh.vertices[i][axis];
      if (is_float(x)) continue;
      Output digits;
      digits.number(x);
      const std::vector<char> value = digits.take();
      throw Error(
          ErrorCode::OutputFailed,
          std::string(format) + " holds 32-bit floats and cannot represent the coordinate " +
              "xyz"[axis] + " = " + std::string(value.begin(), value.end()) + " of vertex " +
              std::to_string(original[i]) +
              "; ask for double precision (ply), write stl-ascii, obj, off or ply-ascii, or round "
              "the mesh to floats first");
    }
  }
}

std::string one_line(std::string_view comment) {
  std::string line(comment);
  for (char& c : line)
    if ((c >= 0 && c < ' ') || c == 127) c = ' ';
  return line;
}

void write_lines(Output& out, const geom::Mesh& mesh) {
  for (const geom::Vec3& p : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0) out.text(" ");
      out.number(p[axis]);
    }
    out.text("\n");
  }
  for (const geom::Triangle& t : mesh.triangles) {
    out.text("3");
    for (const std::uint32_t corner : t) {
      out.text(" ");
      out.number(corner);
    }
    out.text("\n");
  }
}

Eigen::Vector3f facet_normal(const geom::Mesh& mesh, const geom::Triangle& t) {
  // Halved, the differences cannot overflow; scaled, their products neither over- nor underflow.
  const geom::Vec3 a = 0.5 * mesh.vertices[t[0]];
  geom::Vec3 u = 0.5 * mesh.vertices[t[1]] - a;
  geom::Vec3 v = 0.5 * mesh.vertices[t[2]] - a;
  const double scale_u = u.cwiseAbs().maxCoeff(), scale_v = v.cwiseAbs().maxCoeff();
  if (scale_u == 0 || scale_v == 0) return Eigen::Vector3f::Zero();
  u /= scale_u;
  v /= scale_v;
  const geom::Vec3 normal = u.cross(v);
  const double length = normal.norm();
  if (length == 0) return Eigen::Vector3f::Zero();
  return (normal / length).cast<float>().array() + 0.0F;  // no −0
}

}  // namespace kaboum::io
