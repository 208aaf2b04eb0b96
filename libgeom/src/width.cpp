// Width of a convex hull: the least extent over directions across facets and pairs of edges.
#include <CGAL/Exact_rational.h>
#include <CGAL/Mpzf.h>
#include <kaboum/geom/topology.h>
#include <kaboum/geom/width.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace kaboum::geom {
namespace {

constexpr double kUnit = std::numeric_limits<double>::epsilon();

#ifdef CGAL_HAS_MPZF
using Exact = CGAL::Mpzf;
#else
using Exact = CGAL::Exact_rational;
#endif

/// A unit vector up to rounding, and how far it is at most from the one that is meant.
struct Normal {
  Vec3 n = Vec3::Zero();
  double error = 0;
};

struct Edge {
  Vec3 from, to;
};

/// Across both edges, of which the coordinates are exact. @return false when they are parallel.
bool across(const Edge& a, const Edge& b, Normal& out) {
  const Vec3 e = a.to - a.from, f = b.to - b.from;
  const Vec3 n = e.cross(f);
  const double length = n.norm();
  const double error = 20 * kUnit * e.norm() * f.norm();
  if (error < 2e-10 * length) {
    out = {n / length, 2 * error / length + 4 * kUnit};
    return true;
  }
  std::array<Exact, 3> x, y;
  for (int k = 0; k < 3; ++k) {
    x[k] = Exact(a.to[k]) - Exact(a.from[k]);
    y[k] = Exact(b.to[k]) - Exact(b.from[k]);
  }
  Vec3 exact;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    exact[k] = CGAL::to_double(Exact(x[i] * y[j] - x[j] * y[i]));
  }
  // Short vectors would underflow.
  const double largest = exact.cwiseAbs().maxCoeff();
  if (!(largest > 0)) return false;
  out = {(exact / largest).normalized(), 16 * kUnit};
  return true;
}

class Search {
 public:
  explicit Search(const Mesh& hull) : hull_(hull) {
    const Vec3 center = bounding_box(hull).center();
    points_.resize(3, static_cast<Eigen::Index>(hull.vertices.size()));
    for (std::size_t i = 0; i < hull.vertices.size(); ++i) {
      points_.col(static_cast<Eigen::Index>(i)) = hull.vertices[i] - center;
      radius_ = std::max(radius_, (hull.vertices[i] - center).norm());
    }
    radius_ *= 1 + 8 * kUnit;
    // Distances in which most directions are seen to be wide.
    for (int i = 0; i < 13; ++i) {
      const int code = i + 14, y = code / 3 % 3, z = code / 9;
      const Vec3 n(code % 3 - 1, y - 1, z - 1);
      Eigen::Index low = 0, high = 0;
      const Eigen::RowVectorXd h = n.transpose() * points_;
      h.minCoeff(&low);
      h.maxCoeff(&high);
      chords_.col(i) = points_.col(high) - points_.col(low);
    }
  }

  /// Half the width that a ball round the vertices' mean shows; at most 0 when none does.
  [[nodiscard]] double ball() const {
    const Vec3 center = points_.rowwise().mean();
    double radius = std::numeric_limits<double>::infinity();
    for (const Triangle& t : hull_.triangles) {
      Normal normal;
      if (!facet(t, normal)) continue;
      const double height = normal.n.dot(Vec3(points_.col(t[0])) - center);
      radius = std::min(radius, height - lost(normal));
    }
    return radius;
  }

  Width run() {
    Width best{std::numeric_limits<double>::infinity(), Vec3::Zero()};
    const auto consider = [&](const Normal& normal) {
      const double least = lost(normal);
      if ((normal.n.transpose() * chords_).cwiseAbs().maxCoeff() - least >= best.lower) return;
      const Eigen::RowVectorXd h = normal.n.transpose() * points_;
      const double width = h.maxCoeff() - h.minCoeff() - least;
      if (width < best.lower) best = {width, normal.n};
    };
    Normal normal;
    for (const Triangle& t : hull_.triangles)
      if (facet(t, normal)) consider(normal);
    std::vector<Edge> edges;
    for (const EdgeUse& use : edge_uses(hull_))
      if (use.forward) edges.push_back({hull_.vertices[use.lo], hull_.vertices[use.hi]});
    for (std::size_t i = 0; i < edges.size(); ++i)
      for (std::size_t j = i + 1; j < edges.size(); ++j)
        if (across(edges[i], edges[j], normal)) consider(normal);
    best.lower = std::max(best.lower, 0.0);
    return best;
  }

 private:
  bool facet(const Triangle& t, Normal& out) const {
    const auto& v = hull_.vertices;
    return across({v[t[0]], v[t[1]]}, {v[t[0]], v[t[2]]}, out);
  }
  /// Most by which rounding makes a width or height across the normal too large: the width changes
  /// by no more than the diameter times the normal's error, and a product is off by a few units of
  /// the radius.
  [[nodiscard]] double lost(const Normal& normal) const {
    return radius_ * (2 * normal.error + 32 * kUnit);
  }

  const Mesh& hull_;
  Eigen::Matrix3Xd points_;  // from the box's centre
  double radius_ = 0;
  Eigen::Matrix<double, 3, 13> chords_;
};

}  // namespace

Width least_width(const Mesh& hull, double enough) {
  Search search(hull);
  if (2 * search.ball() >= enough) return {enough, Vec3::Zero()};
  Width out = search.run();
  out.lower = std::min(out.lower, enough);
  return out;
}

double longest_upper(const std::vector<Vec3>& points) {
  constexpr std::size_t kMost = 4096;
  constexpr double kUp = 1 + 8 * kUnit;
  if (points.size() > kMost) {
    Box3 box;
    for (const Vec3& p : points) box.extend(p);
    return box.diagonal() * kUp;
  }
  double squared = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      squared = std::max(squared, (points[i] - points[j]).squaredNorm());
  return std::sqrt(squared) * kUp;
}

}  // namespace kaboum::geom
