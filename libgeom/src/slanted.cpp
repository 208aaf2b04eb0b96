// Boxes of triangles that lie slantwise, cut until few of them are met in vain [ernst2007].
#include "slanted.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

namespace kaboum::geom {
namespace {

/// Corners made by cuts are rounded; this times the largest |coordinate| is above what
/// kMostCuts cuts may be off by (docs/algorithms/distances.md, "Nearest triangle").
constexpr double kCutError = 1e-13;
constexpr int kMostCuts = 24;
/// Boxes that a line through the mesh may meet in vain.
constexpr double kFew = 16;
/// Parts per triangle, on the whole.
constexpr std::size_t kParts = 8;

/// Proportional to the chance that a line meets the box.
double half_area(const Box3& box) {
  const Vec3 d = box.max - box.min;
  return d.x() * d.y() + d.y() * d.z() + d.z() * d.x();
}

struct Part {
  std::vector<Vec3> corners;
  Box3 box;
  double empty = 0;  ///< area of the box beyond that of a right triangle's in it
  std::uint32_t triangle = 0;
  int cuts = 0;
  bool operator<(const Part& o) const {
    if (empty != o.empty) return empty < o.empty;
    return triangle != o.triangle
               ? triangle > o.triangle
               : box.min.sum() + box.max.sum() > o.box.min.sum() + o.box.max.sum();
  }
};

/// Twice the area of the polygon's projections, summed.
double shade(const std::vector<Vec3>& corners) {
  Vec3 n = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    n += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  return n.cwiseAbs().sum();
}

void enclose(Part& part, double error) {
  part.box = {};
  for (const Vec3& p : part.corners) part.box.extend(p);
  part.empty = half_area(part.box) - shade(part.corners);
  part.box.min.array() -= error;
  part.box.max.array() += error;
}

/// Cuts a part across the middle of its box's longest side.
std::pair<Part, Part> halves(const Part& part, double error) {
  int axis = 0;
  (part.box.max - part.box.min).maxCoeff(&axis);
  const double middle = part.box.center()[axis];
  std::pair<Part, Part> out;
  for (std::size_t i = 0; i < part.corners.size(); ++i) {
    const Vec3 &a = part.corners[i], &b = part.corners[(i + 1) % part.corners.size()];
    if (a[axis] <= middle) out.first.corners.push_back(a);
    if (a[axis] >= middle) out.second.corners.push_back(a);
    if ((a[axis] < middle) == (b[axis] < middle) || a[axis] == middle || b[axis] == middle)
      continue;
    Vec3 p = a + ((middle - a[axis]) / (b[axis] - a[axis])) * (b - a);
    p[axis] = middle;
    out.first.corners.push_back(p);
    out.second.corners.push_back(p);
  }
  for (Part* half : {&out.first, &out.second}) {
    half->triangle = part.triangle;
    half->cuts = part.cuts + 1;
    enclose(*half, error);
  }
  return out;
}

}  // namespace

std::vector<BoxedPiece> cut_slanted(const Mesh& mesh) {
  const double all = half_area(bounding_box(mesh));
  const auto box_of = [&](const Triangle& t) {
    Box3 box;
    for (const std::uint32_t v : t) box.extend(mesh.vertices[v]);
    return box;
  };
  double empty = 0;
  const auto empty_of = [&](const Triangle& t) {
    const auto& v = mesh.vertices;
    const Vec3 n = (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]);
    return half_area(box_of(t)) - n.cwiseAbs().sum();
  };
  for (const Triangle& t : mesh.triangles) empty += empty_of(t);
  if (!(empty > kFew * all)) return {};

  // Those that are no worse than the rest are left alone.
  const double least = all / static_cast<double>(mesh.triangles.size());
  const auto error_of = [&](std::uint32_t triangle) {
    double magnitude = 0;
    for (const std::uint32_t v : mesh.triangles[triangle])
      magnitude = std::max(magnitude, mesh.vertices[v].cwiseAbs().maxCoeff());
    return kCutError * magnitude;
  };
  std::priority_queue<Part> open;
  std::vector<BoxedPiece> out;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    if (!(empty_of(t) > least)) {
      out.push_back({box_of(t), i});
      continue;
    }
    Part part;
    for (const std::uint32_t v : t) part.corners.push_back(mesh.vertices[v]);
    part.triangle = i;
    enclose(part, 0);
    open.push(std::move(part));
  }
  const std::size_t most = kParts * mesh.triangles.size();
  while (!open.empty()) {
    const Part part = open.top();
    open.pop();
    if (!(empty > kFew * all) || out.size() + open.size() >= most || !(part.empty > least) ||
        part.cuts >= kMostCuts) {
      out.push_back({part.box, part.triangle});
      continue;
    }
    auto [a, b] = halves(part, error_of(part.triangle));
    empty += a.empty + b.empty - part.empty;
    open.push(std::move(a));
    open.push(std::move(b));
  }
  std::stable_sort(out.begin(), out.end(), [](const BoxedPiece& a, const BoxedPiece& b) {
    return a.triangle < b.triangle;
  });
  return out;
}

}  // namespace kaboum::geom
