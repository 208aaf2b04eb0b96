// Closest point on a triangle: [ericson2005], 5.1.5; the bounds
// around it are derived in docs/algorithms/distances.md.
#include <kaboum/base/error.h>
#include <kaboum/geom/rounding.h>
#include <kaboum/geom/triangle_search.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kaboum::geom {
namespace {

/// Weights (s, t) of a point a + s·(b−a) + t·(c−a) of the triangle that is closest to the origin,
/// up to rounding; s, t ≥ 0 and s + t ≤ 1 up to 2^-52.
std::pair<double, double> closest_weights(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double d1 = -ab.dot(a), d2 = -ac.dot(a);
  if (d1 <= 0 && d2 <= 0) return {0, 0};
  const double d3 = -ab.dot(b), d4 = -ac.dot(b);
  if (d3 >= 0 && d4 <= d3) return {1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 > d3 ? d1 / (d1 - d3) : 0, 0};
  const double d5 = -ab.dot(c), d6 = -ac.dot(c);
  if (d6 >= 0 && d5 <= d6) return {0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 > d6 ? d2 / (d2 - d6) : 0};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double sum = (d4 - d3) + (d5 - d6);
    const double w = sum > 0 ? (d4 - d3) / sum : 0;
    return {1 - w, w};
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return {0, 0};
  const double s = std::clamp(vb / sum, 0.0, 1.0);
  return {s, std::clamp(vc / sum, 0.0, 1.0 - s)};
}

/// Bounds that a point q of the triangle gives, and a direction that the triangle is seen in: no
/// point of it is nearer than its nearest corner along that direction.
DistanceBounds bounds_from(const Vec3& q, const Vec3& direction, const Vec3& a, const Vec3& b,
                           const Vec3& c, double slack) {
  const double upper = q.norm() * (1 + kDistanceRounding) + slack;
  const double length = direction.norm();
  if (!(length > 0)) return {0, upper};
  const double support = std::min({direction.dot(a), direction.dot(b), direction.dot(c)}) / length;
  return {std::max(0.0, support * (1 - kDistanceRounding) - slack), upper};
}

/// Bounds for the triangle (a, b, c) given relative to the query point; wider ones where it is
/// farther than `enough`.
DistanceBounds bounds_at_origin(const Vec3& a, const Vec3& b, const Vec3& c,
                                double enough = std::numeric_limits<double>::infinity()) {
  const double slack =
      kDistanceRounding * a.cwiseAbs().cwiseMax(b.cwiseAbs()).cwiseMax(c.cwiseAbs()).maxCoeff();
  const auto [s, t] = closest_weights(a, b, c);
  const Vec3 ab = b - a, ac = c - a;
  const Vec3 nearest = a + s * ab + t * ac;
  DistanceBounds best{0, 0};
  if (const double length = nearest.norm(); length > 0) {
    best.upper = length * (1 + kDistanceRounding) + slack;
    const double support = std::min({nearest.dot(a), nearest.dot(b), nearest.dot(c)}) / length;
    best.lower = std::max(0.0, support * (1 - kDistanceRounding) - slack);
  } else {
    best.upper = slack;
  }
  if (best.upper - best.lower <= 4 * slack + 1e-12 * best.upper || best.lower > enough) return best;
  // A sliver, or a point very close: the weights come from differences of squares, and the
  // direction to the nearest point from a difference of neighbours. Normals and edges lose fewer
  // digits.
  const auto improve = [&](const Vec3& q, const Vec3& direction) {
    const DistanceBounds d = bounds_from(q, direction, a, b, c, slack);
    best.lower = std::max(best.lower, d.lower);
    best.upper = std::min(best.upper, d.upper);
  };
  const auto improve_on_segment = [&](const Vec3& from, const Vec3& to) {
    const Vec3 edge = to - from;
    const double length = edge.squaredNorm();
    if (!(length > 0)) return;
    const Vec3 q = from + std::clamp(-from.dot(edge) / length, 0.0, 1.0) * edge;
    improve(q, q);
    improve(q, q - (q.dot(edge) / length) * edge);
  };
  improve_on_segment(a, b);
  improve_on_segment(b, c);
  improve_on_segment(c, a);
  const Vec3 n = ab.cross(ac);
  const double square = n.squaredNorm();
  if (square > 0) {
    const double u = n.dot(ac.cross(a)) / square, v = n.dot(a.cross(ab)) / square;
    if (u >= 0 && v >= 0 && u + v <= 1) improve(a + u * ab + v * ac, n.dot(a) < 0 ? Vec3(-n) : n);
  }
  return best;
}

/// Lower bound of the squared distance of p to a box.
inline double squared_distance(const Vec3& p, const Vec3& min, const Vec3& max) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double d = std::max(std::max(min[k] - p[k], p[k] - max[k]), 0.0);
    sum += d * d;
  }
  return sum * (1 - kDistanceRounding);
}
inline double squared_distance(const Vec3& p, const Box3& box) {
  return squared_distance(p, box.min, box.max);
}

}  // namespace

DistanceBounds point_triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  return bounds_at_origin(a - p, b - p, c - p);
}

bool box_beyond(const Vec3& p, const std::array<Vec3, 3>& t, double radius) {
  const auto& [a, b, c] = t;
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double low = std::min(std::min(a[k], b[k]), c[k]) - p[k];
    const double high = p[k] - std::max(std::max(a[k], b[k]), c[k]);
    const double d = std::max(std::max(low, high), 0.0);
    sum += d * d;
  }
  return sum * (1 - kDistanceRounding) > radius * radius;
}

double point_triangle_upper(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 x = a - p, y = b - p, z = c - p;
  const Vec3 u = y - x, v = z - x;
  if (!(u.cross(v).squaredNorm() > 1e-8 * u.squaredNorm() * v.squaredNorm()))
    return bounds_at_origin(x, y, z).upper;
  const auto [s, t] = closest_weights(x, y, z);
  const Vec3 nearest = x + s * u + t * v;
  const double slack =
      kDistanceRounding * x.cwiseAbs().cwiseMax(y.cwiseAbs()).cwiseMax(z.cwiseAbs()).maxCoeff();
  return nearest.norm() * (1 + kDistanceRounding) + slack;
}

Vec3 nearest_point(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto [s, t] = closest_weights(a - p, b - p, c - p);
  return a + s * (b - a) + t * (c - a);
}

TriangleSearch::TriangleSearch(const Mesh& mesh, std::span<const std::uint32_t> order) {
  if (mesh.empty()) throw Error(ErrorCode::InvalidInput, "distance to a mesh without triangles");
  corners_.reserve(order.size());
  position_.resize(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const Triangle& t = mesh.triangles[order[i]];
    corners_.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
    position_[order[i]] = i;
    for (const Vec3& corner : corners_.back()) box_.extend(corner);
  }
}

namespace {

/// Each index once, where it is first.
std::vector<std::uint32_t> distinct(std::span<const std::uint32_t> order, std::size_t count) {
  std::vector<char> seen(count, 0);
  std::vector<std::uint32_t> out;
  out.reserve(count);
  for (const std::uint32_t i : order)
    if (std::exchange(seen[i], 1) == 0) out.push_back(i);
  return out;
}

}  // namespace

DistanceQuery::DistanceQuery(const Mesh& mesh) : DistanceQuery(mesh, Bvh::of_parts(mesh)) {}

DistanceQuery::DistanceQuery(const Mesh& mesh, Bvh bvh)
    : TriangleSearch(mesh, distinct(bvh.order(), mesh.triangles.size())), bvh_(std::move(bvh)) {
  place_.reserve(bvh_.order().size());
  for (const std::uint32_t triangle : bvh_.order()) place_.push_back(position_[triangle]);
}

TriangleSearch::Nearest DistanceQuery::nearest(const Vec3& p, std::uint32_t hint) const {
  Nearest best{0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  double best_squared = best.upper;
  const auto consider = [&](std::uint32_t place, std::uint32_t triangle) {
    const auto& [a, b, c] = corners_[place];
    ++best.looked;
    if (box_beyond(p, corners_[place], best.upper)) return;
    const DistanceBounds d = bounds_at_origin(a - p, b - p, c - p, best.upper);
    best.lower = std::min(best.lower, d.lower);
    if (d.upper < best.upper) {
      best.upper = d.upper;
      best.triangle = triangle;
      best_squared = d.upper * d.upper * (1 + kDistanceRounding);
    }
  };
  if (hint != kNone) consider(position_[hint], hint);

  const auto nodes = bvh_.nodes();
  struct Entry {
    double squared;
    std::uint32_t node;
  };
  Entry stack[Bvh::kMaxDepth];
  int size = 0;
  stack[size++] = {squared_distance(p, nodes[0].box), 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.squared > best_squared) continue;
    const Bvh::Node& node = nodes[entry.node];
    if (node.leaf()) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        consider(place_[i], bvh_.order()[i]);
      continue;
    }
    Entry near{squared_distance(p, nodes[entry.node + 1].box), entry.node + 1};
    Entry far{squared_distance(p, nodes[node.first].box), node.first};
    if (far.squared < near.squared) std::swap(near, far);
    if (far.squared <= best_squared) stack[size++] = far;
    if (near.squared <= best_squared) stack[size++] = near;
  }
  return best;
}

std::uint32_t DistanceQuery::within(const Vec3& p, double radius, std::uint32_t hint) const {
  const auto is_within = [&](std::uint32_t place) {
    if (box_beyond(p, corners_[place], radius)) return false;
    const auto& [a, b, c] = corners_[place];
    return point_triangle_distance(p, a, b, c).upper <= radius;
  };
  if (hint != kNone && is_within(position_[hint])) return hint;
  const auto nodes = bvh_.nodes();
  const double limit = radius * radius;
  std::uint32_t stack[Bvh::kMaxDepth];
  int size = 0;
  if (squared_distance(p, nodes[0].box) <= limit) stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t index = stack[--size];
    const Bvh::Node& node = nodes[index];
    if (node.leaf()) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        if (is_within(place_[i])) return bvh_.order()[i];
      continue;
    }
    std::uint32_t near = index + 1, far = node.first;
    double to_near = squared_distance(p, nodes[near].box),
           to_far = squared_distance(p, nodes[far].box);
    if (to_far < to_near) {
      std::swap(near, far);
      std::swap(to_near, to_far);
    }
    if (to_far <= limit) stack[size++] = far;
    if (to_near <= limit) stack[size++] = near;
  }
  return kNone;
}

bool DistanceQuery::all_within(const ConvexPolygon& polygon, double radius, int max_pieces) const {
  struct Entry {
    ConvexPolygon polygon;
    std::uint32_t hint;
    int depth;
  };
  constexpr int kStack = 96;
  std::array<Entry, kStack> stack;
  int size = 0;
  stack[size++] = {polygon, kNone, 0};
  while (size > 0) {
    const Entry e = stack[--size];
    if (--max_pieces < 0) return false;
    const Nearest at = nearest(e.polygon.centroid(), e.hint);
    if (!(at.upper <= radius)) return false;
    bool near = true;
    for (int i = 0; i < e.polygon.size && near; ++i)
      near = to_triangle(e.polygon.corner[i], at.triangle).upper <= radius;
    if (near) continue;
    const auto& [a, b, c] = corners(at.triangle);
    const PrismCut pieces = cut_by_prism(e.polygon, a, b, c, e.depth % 3 == 2);
    if (size + pieces.count > kStack) return false;
    for (int i = 0; i < pieces.count; ++i)
      stack[size++] = {pieces.piece[i], at.triangle, e.depth + 1};
  }
  return true;
}

}  // namespace kaboum::geom
