// Planes for cuts at the reflex edges of a solid.
// docs/algorithms/convex-decomposition.md, "Search".

#include "reflex_planes.h"

#include <kaboum/geom/topology.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace kaboum::bcd {
namespace {

/// An edge is reflex if the solid bends inwards there by this angle. [rad]
constexpr double kLeastAngle = 0.25;
/// Normals that differ less have no plane between them; it has this share of
/// the edge's weight.
constexpr double kLeastBisector = 0.05, kBisectorWeight = 0.5;
/// Planes are the same that have the same normal, in so many steps from 0 to 1,
/// and the same distance from the centre, in so many steps of the diagonal.
constexpr double kNormalSteps = 200, kOffsetSteps = 500;
/// Two edges have a plane where they are not in one line, by the sine of the
/// angle; neither may be behind the other's faces, nor off the plane, by shares
/// of their distance.
constexpr double kLeastSine = 0.1, kBehind = 1e-4, kInPlane = 1e-3;
/// A plane cuts a piece that is on both sides of it by this share of the
/// piece's diagonal.
constexpr double kCrossing = 1e-4;

/// An edge where the solid bends inwards, with the outer normals beside it.
struct ReflexEdge {
  Vec3 a, b;
  Vec3 p, q;
  std::array<std::uint32_t, 2> triangles;
  double weight;
};

/// A plane through two reflex edges.
struct Neck {
  Plane plane;
  std::array<std::uint32_t, 4> triangles;
  double weight;
};

/// For the heaviest edges, planes through each and the nearest ones such that
/// cutting there leaves neither reflex: a tooth is cut off at its foot.
std::vector<Neck> necks(std::vector<ReflexEdge> edges, double diagonal) {
  constexpr std::size_t kMostEdges = 256, kNearest = 2;
  std::stable_sort(edges.begin(), edges.end(),
                   [](const ReflexEdge& e, const ReflexEdge& f) { return e.weight > f.weight; });
  if (edges.size() > kMostEdges) edges.resize(kMostEdges);
  std::vector<Neck> out;
  for (const ReflexEdge& e : edges) {
    std::vector<std::pair<double, Neck>> found;
    const Vec3 along = e.b - e.a, from = 0.5 * (e.a + e.b);
    for (const ReflexEdge& f : edges) {
      const Vec3 across = 0.5 * (f.a + f.b) - from;
      const double length = across.norm();
      const Vec3 n = along.cross(across);
      if (!(n.norm() > kLeastSine * along.norm() * length)) continue;
      const double least = kBehind * length;
      if (across.dot(e.p) > least || across.dot(e.q) > least || across.dot(f.p) < -least ||
          across.dot(f.q) < -least)
        continue;
      const Plane plane{n.normalized(), n.normalized().dot(from)};
      if (std::max(std::abs(plane.height(f.a)), std::abs(plane.height(f.b))) > kInPlane * length)
        continue;
      found.emplace_back(length,
                         Neck{plane,
                              {e.triangles[0], e.triangles[1], f.triangles[0], f.triangles[1]},
                              (e.weight + f.weight) * (1 - length / diagonal)});
    }
    const std::size_t kept = std::min(kNearest, found.size());
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& x, const auto& y) { return x.first < y.first; });
    for (std::size_t i = 0; i < kept; ++i) out.push_back(found[i].second);
  }
  return out;
}

}  // namespace

void ReflexPlanes::find(const SolidField& solid) {
  const Mesh& mesh = solid.mesh();
  const std::vector<geom::EdgeUse> uses = geom::edge_uses(mesh);
  of_.resize(mesh.triangles.size());
  std::map<std::array<int, 4>, std::uint32_t> known;
  const auto plane_of = [&](std::uint32_t t, Plane& plane) {
    const auto& v = mesh.vertices;
    const Triangle& tri = mesh.triangles[t];
    const Vec3 n = (v[tri[1]] - v[tri[0]]).cross(v[tri[2]] - v[tri[0]]);
    const double length = n.norm();
    if (!(length > 0)) return false;
    plane.n = n / length;
    plane.d = plane.n.dot(v[tri[0]]);
    return true;
  };
  const auto number_of = [&](Plane plane, double weight) {
    // Opposite normals are the same cut.
    int axis = 0;
    plane.n.cwiseAbs().maxCoeff(&axis);
    if (plane.n[axis] < 0) {
      plane.n = -plane.n;
      plane.d = -plane.d;
    }
    const double center = plane.n.dot(solid.box().center());
    const std::array<int, 4> key{
        static_cast<int>(std::lround(kNormalSteps * plane.n.x())),
        static_cast<int>(std::lround(kNormalSteps * plane.n.y())),
        static_cast<int>(std::lround(kNormalSteps * plane.n.z())),
        static_cast<int>(std::lround(kOffsetSteps * (plane.d - center) / solid.diagonal()))};
    const auto [at, fresh] = known.emplace(key, static_cast<std::uint32_t>(planes_.size()));
    if (fresh) planes_.push_back({plane, weight});
    return at->second;
  };
  std::vector<ReflexEdge> edges;
  for (std::size_t i = 0; i + 1 < uses.size(); ++i) {
    if (uses[i].lo != uses[i + 1].lo || uses[i].hi != uses[i + 1].hi) continue;
    const std::uint32_t s = uses[i].triangle, t = uses[i + 1].triangle;
    Plane p, q;
    if (!plane_of(s, p) || !plane_of(t, q)) continue;
    const std::uint32_t apex = mesh.triangles[t][(uses[i + 1].corner + 2) % 3];
    const double sine = p.n.cross(q.n).norm();
    const double cosine = p.n.dot(q.n);
    if (p.height(mesh.vertices[apex]) <= 0) continue;
    if (std::atan2(sine, cosine) < kLeastAngle) continue;
    const Vec3 &a = mesh.vertices[uses[i].lo], &b = mesh.vertices[uses[i].hi];
    const double weight = (b - a).norm() * std::atan2(sine, cosine);
    edges.push_back({a, b, p.n, q.n, {s, t}, weight});
    for (const Plane& plane : {p, q}) {
      const std::uint32_t number = number_of(plane, 0);
      of_[s].push_back(number);
      of_[t].push_back(number);
      planes_[number].weight = std::max(planes_[number].weight, weight);
    }
    Vec3 across = p.n - q.n;
    if (across.norm() > kLeastBisector) {
      Plane bisector;
      bisector.n = across.normalized();
      bisector.d = bisector.n.dot(0.5 * a + 0.5 * b);
      const std::uint32_t number = number_of(bisector, 0);
      of_[s].push_back(number);
      of_[t].push_back(number);
      planes_[number].weight = std::max(planes_[number].weight, kBisectorWeight * weight);
    }
  }
  for (const Neck& neck : necks(std::move(edges), solid.diagonal())) {
    const std::uint32_t number = number_of(neck.plane, 0);
    for (const std::uint32_t t : neck.triangles) of_[t].push_back(number);
    planes_[number].weight = std::max(planes_[number].weight, neck.weight);
  }
}

std::vector<std::uint32_t> ReflexPlanes::crossing(const CutNode& node) const {
  Box3 box;
  for (const Vec3& p : node.hull) box.extend(p);
  const double least = kCrossing * box.diagonal();
  std::map<std::uint32_t, double> weight;
  for (const std::uint32_t t : node.piece.source)
    for (const std::uint32_t r : of_[t]) weight[r] += planes_[r].weight;
  std::vector<std::pair<double, std::uint32_t>> order;
  for (const auto& [r, w] : weight) {
    const auto [low, high] = extent(node.hull, planes_[r].plane.n);
    if (low < planes_[r].plane.d - least && high > planes_[r].plane.d + least)
      order.emplace_back(-w, r);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::uint32_t> out;
  out.reserve(order.size());
  for (const auto& [w, r] : order) out.push_back(r);
  return out;
}

}  // namespace kaboum::bcd
