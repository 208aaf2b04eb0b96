// A convex polytope in a union of others: what one of them holds is cut off, and the rest has to be
// in the remaining ones. Polytopes are cut by the double description method (T. S. Motzkin et al.,
// 1953), in numbers that are exact where intervals do not decide.

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <kaboum/base/error.h>
#include <kaboum/collide/inclusion.h>
#include <kaboum/geom/body_polytopes.h>
#include <kaboum/geom/convex_hull.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

namespace kaboum::collide {
namespace {

using geom::Vec3;
using Number = CGAL::Epeck::FT;
using Vector = std::array<Number, 3>;

struct Plane {
  Vector normal;
  Number offset;  ///< below where normal · x < offset
};

CGAL::Sign side(const Plane& plane, const Vector& p) {
  return CGAL::sign(plane.normal[0] * p[0] + plane.normal[1] * p[1] + plane.normal[2] * p[2] -
                    plane.offset);
}

struct Corner {
  Vector p;
  std::vector<std::size_t> planes;  ///< of the polytope that it lies on, ascending
};

/// With inner points.
struct Piece {
  std::vector<Corner> corners;
  std::size_t planes = 0;  ///< numbers given to planes so far
};

Vector placed(const geom::Transform& pose, const Vec3& p) {
  Vector out;
  for (int i = 0; i < 3; ++i) {
    out[i] = Number(pose.translation[i]);
    for (int j = 0; j < 3; ++j) out[i] += Number(pose.linear(i, j)) * Number(p[j]);
  }
  return out;
}

std::vector<Vector> corners_of(const geom::Mesh& hull, const geom::Transform& pose) {
  std::vector<Vector> out;
  for (const Vec3& p : hull.vertices) out.push_back(placed(pose, p));
  return out;
}

/// Outward: the pose is a rotation.
std::vector<Plane> planes_of(const geom::Mesh& hull, const std::vector<Vector>& at) {
  std::vector<Plane> out;
  for (const auto& [i, j, k] : hull.triangles) {
    const Vector &a = at[i], &b = at[j], &c = at[k];
    const Vector u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const Vector v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    Plane plane{{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]},
                Number(0)};
    plane.offset = plane.normal[0] * a[0] + plane.normal[1] * a[1] + plane.normal[2] * a[2];
    out.push_back(std::move(plane));
  }
  return out;
}

Piece piece_of(const geom::Mesh& hull, const geom::Transform& pose) {
  const std::vector<Vector> at = corners_of(hull, pose);
  const std::vector<Plane> planes = planes_of(hull, at);
  Piece out;
  out.planes = planes.size();
  for (const Vector& p : at) {
    Corner corner{p, {}};
    for (std::size_t i = 0; i < planes.size(); ++i)
      if (side(planes[i], p) == CGAL::ZERO) corner.planes.push_back(i);
    out.corners.push_back(std::move(corner));
  }
  return out;
}

std::vector<std::size_t> common(const Corner& a, const Corner& b) {
  std::vector<std::size_t> out;
  std::set_intersection(a.planes.begin(), a.planes.end(), b.planes.begin(), b.planes.end(),
                        std::back_inserter(out));
  return out;
}

/// Whether two corners are ends of one edge: no third one lies on all planes that both lie on.
bool are_joined(const Piece& piece, std::size_t i, std::size_t j,
                const std::vector<std::size_t>& shared) {
  if (shared.size() < 2) return false;
  for (std::size_t k = 0; k < piece.corners.size(); ++k) {
    const auto& planes = piece.corners[k].planes;
    if (k != i && k != j &&
        std::includes(planes.begin(), planes.end(), shared.begin(), shared.end()))
      return false;
  }
  return true;
}

/// Both parts of a piece, which has corners on both sides.
struct Parts {
  Piece below, above;
};

Parts cut(const Piece& piece, const Plane& plane, const std::vector<CGAL::Sign>& sides) {
  Parts out;
  out.below.planes = out.above.planes = piece.planes + 1;
  const auto add_to_both = [&](Corner corner) {
    corner.planes.push_back(piece.planes);
    out.below.corners.push_back(corner);
    out.above.corners.push_back(std::move(corner));
  };
  const std::size_t n = piece.corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (sides[i] == CGAL::NEGATIVE) out.below.corners.push_back(piece.corners[i]);
    if (sides[i] == CGAL::POSITIVE) out.above.corners.push_back(piece.corners[i]);
    if (sides[i] == CGAL::ZERO) add_to_both(piece.corners[i]);
  }
  const auto height = [&](const Vector& p) {
    return plane.normal[0] * p[0] + plane.normal[1] * p[1] + plane.normal[2] * p[2] - plane.offset;
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (sides[i] != CGAL::NEGATIVE) continue;
    for (std::size_t j = 0; j < n; ++j) {
      if (sides[j] != CGAL::POSITIVE) continue;
      std::vector<std::size_t> shared = common(piece.corners[i], piece.corners[j]);
      if (!are_joined(piece, i, j, shared)) continue;
      const Vector &p = piece.corners[i].p, &q = piece.corners[j].p;
      const Number low = height(p), at = low / (low - height(q));
      Vector between;
      for (int k = 0; k < 3; ++k) {
        between[k] = p[k] + at * (q[k] - p[k]);
        between[k].exact();  // keeps what the number came from from growing without end
      }
      add_to_both({between, std::move(shared)});
    }
  }
  return out;
}

/// Whether pieces are in the union of bodies, which are given by their planes.
class Subtraction {
 public:
  Subtraction(std::vector<std::vector<Plane>> bodies, std::size_t most_pieces)
      : bodies_(std::move(bodies)), left_(most_pieces) {}

  Inclusion decide(Piece piece, std::size_t from = 0) {
    for (std::size_t b = from; b < bodies_.size(); ++b) {
      if (left_ == 0) return Inclusion::Undecided;
      if (lies_apart(piece, bodies_[b])) continue;
      for (const Plane& plane : bodies_[b]) {
        const std::vector<CGAL::Sign> sides = sides_of(piece, plane);
        if (std::count(sides.begin(), sides.end(), CGAL::POSITIVE) == 0) continue;
        if (std::count(sides.begin(), sides.end(), CGAL::NEGATIVE) == 0)
          return decide(std::move(piece), b + 1);  // nothing of it is inside
        if (left_ == 0) return Inclusion::Undecided;
        --left_;
        Parts parts = cut(piece, plane, sides);
        const Inclusion rest = decide(std::move(parts.above), b + 1);
        if (rest != Inclusion::Included) return rest;
        piece = std::move(parts.below);
      }
      return Inclusion::Included;
    }
    return Inclusion::NotIncluded;
  }

 private:
  static std::vector<CGAL::Sign> sides_of(const Piece& piece, const Plane& plane) {
    std::vector<CGAL::Sign> out;
    for (const Corner& corner : piece.corners) out.push_back(side(plane, corner.p));
    return out;
  }

  /// Whether one of its planes has nothing of the piece below it.
  static bool lies_apart(const Piece& piece, const std::vector<Plane>& body) {
    return std::any_of(body.begin(), body.end(), [&](const Plane& plane) {
      return std::none_of(piece.corners.begin(), piece.corners.end(),
                          [&](const Corner& c) { return side(plane, c.p) == CGAL::NEGATIVE; });
    });
  }

  std::vector<std::vector<Plane>> bodies_;
  std::size_t left_;
};

/// More than what a pose's matrix shrinks lengths by, and rounding: where LᵀL is off from I by less
/// than 1e-9 in its entries, no length is shrunk or stretched by more than 1.6e-9 of it.
constexpr double kCube = 1.0001;

/// A polytope within a body whose radius is above 0: of a radius that is a little smaller, against
/// rounding. No point of the body is farther from it than kLacking times the radius.
geom::Mesh within(geom::ConvexBody body) {
  static const geom::SpherePoints sphere = geom::sphere_points(2);
  double largest = 0;
  for (const Vec3& p : body.core.vertices) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  body.radius -= 0x1p-40 * body.radius + 0x1p-48 * largest;
  return body.radius > 0 ? geom::inscribed_polytope(body, sphere) : body.core;
}
constexpr double kLacking = 0.02;

/// The hull of cubes round the points, which hold balls of the radius.
geom::Mesh enlarged(const geom::Mesh& hull, double radius) {
  if (radius == 0) return hull;
  // The last term: where the sums of the corners are rounded.
  double largest = 0;
  for (const Vec3& p : hull.vertices) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  const double r = radius * kCube + 0x1p-50 * largest;
  std::vector<Vec3> points;
  for (const Vec3& p : hull.vertices)
    for (const double x : {-r, r})
      for (const double y : {-r, r})
        for (const double z : {-r, r}) points.emplace_back(p + Vec3(x, y, z));
  const auto out = geom::convex_hull(points);
  ensure(out.has_value(), "a polytope that was enlarged is flat");
  return *out;
}

}  // namespace

double tolerance_of_inclusion(const PosedSet& outer, const PosedSet& inner) {
  double margin = 0, size = 0, lacking = 0;
  for (std::size_t i = 0; i < outer.set().size(); ++i) {
    margin = std::max(margin, outer.set().body(i).radius);
    size = std::max(size, outer.set().polytope(i).magnitude().maxCoeff());
  }
  for (std::size_t j = 0; j < inner.set().size(); ++j)
    lacking = std::max(lacking, kLacking * inner.set().body(j).radius);
  const double enlarged_by = margin + outer.error() + inner.error();
  return outer.set().epsilon() + inner.set().epsilon() + outer.error() + inner.error() + lacking +
         (enlarged_by == 0 ? 0
                           : std::numbers::sqrt3 * kCube * kCube * (enlarged_by + 0x1p-49 * size));
}

Inclusion find_inclusion(const PosedSet& outer, const PosedSet& inner, std::size_t most_pieces) {
  if (outer.set().direction() != Direction::Outer || inner.set().direction() != Direction::Inner)
    throw Error(ErrorCode::InvalidArgument,
                "an inclusion is looked for with an outer set in an inner one");
  bool undecided = false;
  const std::vector<geom::Box3> boxes = inner.boxes();
  for (std::size_t i = 0; i < outer.set().size(); ++i) {
    const double errors = outer.error() + inner.error();
    const double radius = (outer.set().body(i).radius + errors) * (errors > 0 ? 1 + 0x1p-50 : 1);
    const geom::Mesh hull = enlarged(outer.set().body(i).core, radius);
    const geom::Box3 box = Posed(Polytope(hull.vertices), outer.pose()).box();
    std::vector<std::vector<Plane>> bodies;
    for (std::size_t j = 0; j < inner.set().size(); ++j) {
      if (((box.min - boxes[j].max).array() > 0).any() ||
          ((boxes[j].min - box.max).array() > 0).any())
        continue;
      const geom::ConvexBody& body = inner.set().body(j);
      const geom::Mesh polytope = body.radius > 0 ? within(body) : body.core;
      if (polytope.triangles.empty()) continue;  // without planes it would hold everything
      bodies.push_back(planes_of(polytope, corners_of(polytope, inner.pose())));
    }
    const Inclusion found =
        Subtraction(std::move(bodies), most_pieces).decide(piece_of(hull, outer.pose()));
    if (found == Inclusion::NotIncluded) return found;
    undecided = undecided || found == Inclusion::Undecided;
  }
  return undecided ? Inclusion::Undecided : Inclusion::Included;
}

}  // namespace kaboum::collide
