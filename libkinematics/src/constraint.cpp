// Costs of geometric constraints and their derivatives; docs/algorithms/constraint-sampling.md.
#include <kaboum/base/error.h>
#include <kaboum/kinematics/constraint.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tolerances.h"

namespace kaboum::kinematics {
namespace {

/// A feature in the world: a point, and the direction of a line or normal of a plane with two that
/// are perpendicular to it and fixed to the same frame.
struct PosedFeature {
  Vec3 origin, point, direction, side, other;  ///< origin: of the frame
};

/// Two directions perpendicular to d: a function of d alone, so that they turn with the frame.
/// Source: Duff et al., Building an Orthonormal Basis, Revisited, JCGT 6(1), 2017.
std::pair<Vec3, Vec3> perpendiculars(const Vec3& d) {
  const double sign = std::copysign(1.0, d.z()), a = -1 / (sign + d.z()), b = d.x() * d.y() * a;
  return {{1 + sign * d.x() * d.x() * a, sign * b, -sign * d.x()},
          {b, sign + d.y() * d.y() * a, -d.y()}};
}

Vec3 onto_plane(const Surface& s, const Vec3& p) {
  return p - (p - s.position).dot(s.normal) * s.normal;
}

PosedFeature see(const Feature& feature, const Transform& frame) {
  PosedFeature s;
  s.origin = frame.translation;
  const auto place = [&](const Vec3& position, const Vec3& direction) {
    s.point = frame * position;
    s.direction = frame.linear * direction;
    const auto [side, other] = perpendiculars(direction);
    s.side = frame.linear * side;
    s.other = frame.linear * other;
  };
  if (const auto* point = std::get_if<Point>(&feature)) {
    s.point = frame * point->position;
  } else if (const auto* line = std::get_if<Line>(&feature)) {
    place(line->position, line->direction);
  } else if (const auto* plane = std::get_if<Plane>(&feature)) {
    place(plane->position, plane->normal);
  } else {
    const auto& surface = std::get<Surface>(feature);
    place(surface.position, surface.normal);
  }
  return s;
}

/// Collects rows: values, and how they change with the twists of both frames.
class Rows {
 public:
  Rows(const PosedFeature& a, const PosedFeature& b, double length)
      : a_(a), b_(b), between_(a.point - b.point), length_(length) {
    resize(4);
  }

  /// u · (p₁ − p₂), u fixed to the first frame, to the second, or to neither.
  void along(const Vec3& u, int frame) {
    add(u.dot(between_) / length_);
    add_point(u / length_);
    if (frame == 1) turn_first() += u.cross(between_ / length_).transpose();
    if (frame == 2) turn_second() += u.cross(between_ / length_).transpose();
  }
  /// How far p₁ is beside a surface of the second frame, in its plane.
  void beside(const Surface& surface, const Transform& frame) {
    const Vec3 in_frame = frame.linear.transpose() * (a_.point - frame.translation);
    const Vec3 off =
        frame.linear * (onto_plane(surface, in_frame) - nearest_point(surface, in_frame));
    const double far = off.norm();
    add(far / length_);
    if (!(far > 0)) return;
    // The nearest point stays where it is in the second frame, to first order along u.
    const Vec3 u = off / (far * length_);
    const Vec3 arm = a_.point - a_.origin, other = a_.point - b_.origin;
    move_first() = u.transpose();
    turn_first() = arm.cross(u).transpose();
    move_second() = -u.transpose();
    turn_second() = -other.cross(u).transpose();
  }
  /// u · v, u fixed to the first frame, v to the second.
  void dot(const Vec3& u, const Vec3& v) {
    add(u.dot(v));
    const Vec3 c = u.cross(v);
    turn_first() = c.transpose();
    turn_second() = -c.transpose();
  }
  /// The angle between u and v, or what it lacks to a right one, less a value.
  void angle(const Vec3& u, const Vec3& v, bool complement, double value) {
    Vec3 c = u.cross(v);
    const double sine = c.norm(), angle = std::atan2(sine, u.dot(v));
    c = sine > 1e-12 ? Vec3(c / sine) : perpendiculars(u).first;  // aligned: any way out will do
    const double sign = complement ? -1 : 1;
    add((complement ? kPi / 2 - angle : angle) - value);
    turn_first() = -sign * c.transpose();
    turn_second() = sign * c.transpose();
  }
  /// Replaces all rows by their norm less a value [length]; where it is 0, any way out will do.
  void norm(double value) {
    double norm = 0;
    for (Eigen::Index i = 0; i < size_; ++i) norm += out_.value[i] * out_.value[i];
    norm = std::sqrt(norm);
    Eigen::Matrix<double, 1, 6> first = out_.first.row(0), second = out_.second.row(0);
    if (norm > 1e-14) {
      first.setZero();
      second.setZero();
      for (Eigen::Index i = 0; i < size_; ++i) {
        first += out_.value[i] / norm * out_.first.row(i);
        second += out_.value[i] / norm * out_.second.row(i);
      }
    }
    size_ = 0;
    add(norm - value / length_);
    out_.first.row(0) = first;
    out_.second.row(0) = second;
  }

  Cost result() {
    resize(size_);
    return out_;
  }

 private:
  /// What is there stays.
  void resize(Eigen::Index rows) {
    out_.value.conservativeResize(rows);
    out_.first.conservativeResize(rows, Eigen::NoChange);
    out_.second.conservativeResize(rows, Eigen::NoChange);
  }
  void add(double value) {
    out_.value[size_] = value;
    out_.first.row(size_).setZero();
    out_.second.row(size_).setZero();
    ++size_;
  }
  using Part = Eigen::Block<Cost::Derivative, 1, 3>;
  // The last row, by velocities of the origins and by angular velocities.
  Part move_first() { return out_.first.block<1, 3>(size_ - 1, 0); }
  Part turn_first() { return out_.first.block<1, 3>(size_ - 1, 3); }
  Part move_second() { return out_.second.block<1, 3>(size_ - 1, 0); }
  Part turn_second() { return out_.second.block<1, 3>(size_ - 1, 3); }
  /// g · (velocity of p₁ − velocity of p₂).
  void add_point(const Vec3& g) {
    move_first() += g.transpose();
    turn_first() += (a_.point - a_.origin).cross(g).transpose();
    move_second() -= g.transpose();
    turn_second() -= (b_.point - b_.origin).cross(g).transpose();
  }

  const PosedFeature &a_, &b_;
  Vec3 between_;
  double length_;
  Cost out_;
  Eigen::Index size_ = 0;
};

/// Kinds of the two features as one number: point 0, line 1, plane 2 (of surfaces, theirs).
constexpr std::size_t kinds(std::size_t first, std::size_t second) { return 3 * first + second; }
/// Of a surface's size: how far corners may be off its plane, and an edge, or an area at its
/// square, is longer; how far an outline may be from convex.
constexpr double kFlat = 1e-9, kConvex = 1e-12;
constexpr std::size_t kPointPoint = kinds(0, 0), kPointLine = kinds(0, 1),
                      kPointPlane = kinds(0, 2), kLineLine = kinds(1, 1), kLinePlane = kinds(1, 2),
                      kPlanePlane = kinds(2, 2);

/// A surface as the plane that it is a part of.
std::size_t kind_of(const Feature& feature) { return std::min<std::size_t>(feature.index(), 2); }

bool is_surface(const Feature& feature) { return std::holds_alternative<Surface>(feature); }

/// Whether a relation is about where a point is on a surface.
bool is_on_surface(const Constraint& c) {
  return (is_surface(c.first.feature) || is_surface(c.second.feature)) &&
         (c.relation == Relation::Coincident || c.relation == Relation::Distance);
}

bool supported(Relation relation, std::size_t pair) {
  const bool with_point = pair == kPointPoint || pair == kPointLine || pair == kPointPlane;
  if (relation == Relation::Coincident) return true;
  return relation == Relation::Distance ? with_point : !with_point;
}

void coincident(Rows& rows, const PosedFeature& a, const PosedFeature& b, std::size_t pair) {
  switch (pair) {
    case kPointPoint:
      for (int i = 0; i < 3; ++i) rows.along(Vec3::Unit(i), 0);
      return;
    case kPointLine:
      rows.along(b.side, 2);
      rows.along(b.other, 2);
      return;
    case kPointPlane:
      return rows.along(b.direction, 2);
    case kLineLine:
      rows.along(a.side, 1);
      rows.along(a.other, 1);
      rows.dot(a.side, b.direction);
      return rows.dot(a.other, b.direction);
    case kLinePlane:
      rows.along(b.direction, 2);
      return rows.dot(a.direction, b.direction);
    default:
      rows.along(b.direction, 2);
      rows.dot(a.side, b.direction);
      return rows.dot(a.other, b.direction);
  }
}

/// @param aligned  the directions are to be the same or opposite; else at right angles.
void directions(Rows& rows, const PosedFeature& a, const PosedFeature& b, bool aligned) {
  if (!aligned) return rows.dot(a.direction, b.direction);
  rows.dot(a.side, b.direction);
  rows.dot(a.other, b.direction);
}

/// Off its plane, and beside it.
Cost on_surface(const Constraint& c, const PosedFeature& a, PosedFeature b, const Transform& frame,
                double length) {
  const auto& surface = std::get<Surface>(c.second.feature);
  b.point += c.value * b.direction;
  Rows rows(a, b, length);
  rows.along(b.direction, 2);
  rows.beside(surface, frame);
  return rows.result();
}

const char* name_of(const Feature& feature) {
  constexpr std::array<const char*, 4> kNames{"point", "line", "plane", "surface"};
  return kNames[feature.index()];
}

/// A convex polygon in its plane with the corners that way round, or a disc; of some area.
bool is_bounded_surface(const Surface& s) {
  if (s.outline.empty()) return s.radius > 0 && std::isfinite(s.radius);
  const std::size_t n = s.outline.size();
  double size = 0, area = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 a = s.outline[i] - s.position, b = s.outline[(i + 1) % n] - s.position;
    size = std::max(size, a.norm());
    area += 0.5 * s.normal.dot(a.cross(b));
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 &a = s.outline[i], edge = s.outline[(i + 1) % n] - a;
    const bool flat = std::abs(s.normal.dot(a - s.position)) <= kFlat * size;
    if (!flat || !(edge.norm() > kFlat * size)) return false;
    for (const Vec3& p : s.outline)
      if (s.normal.dot(edge.cross(p - a)) < -kConvex * size * edge.norm()) return false;
  }
  return n >= 3 && std::isfinite(size) && area > kFlat * size * size;
}

bool is_unit(const Feature& feature) {
  if (const auto* line = std::get_if<Line>(&feature))
    return line->position.allFinite() && std::abs(line->direction.norm() - 1) < 1e-9;
  if (const auto* plane = std::get_if<Plane>(&feature))
    return plane->position.allFinite() && std::abs(plane->normal.norm() - 1) < 1e-9;
  if (const auto* surface = std::get_if<Surface>(&feature))
    return surface->position.allFinite() && std::abs(surface->normal.norm() - 1) < 1e-9;
  return std::get<Point>(feature).position.allFinite();
}

}  // namespace

Vec3 nearest_point(const Surface& s, const Vec3& p) {
  const Vec3 flat = onto_plane(s, p);
  if (s.outline.empty()) {
    const Vec3 out = flat - s.position;
    return out.norm() <= s.radius ? flat : Vec3(s.position + s.radius * out.normalized());
  }
  bool inside = true;
  Vec3 nearest = s.outline.front();
  for (std::size_t i = 0; i < s.outline.size(); ++i) {
    const Vec3& a = s.outline[i];
    const Vec3 edge = s.outline[(i + 1) % s.outline.size()] - a;
    inside = inside && s.normal.dot(edge.cross(flat - a)) >= 0;
    const double share = std::clamp(edge.dot(flat - a) / edge.squaredNorm(), 0.0, 1.0);
    const Vec3 on_edge = a + share * edge;
    if ((on_edge - flat).squaredNorm() < (nearest - flat).squaredNorm()) nearest = on_edge;
  }
  return inside ? flat : nearest;
}

Vec3 point_at(const Surface& s, double u, double v) {
  if (s.outline.empty()) {
    const auto [side, other] = perpendiculars(s.normal);
    const double angle = 2 * kPi * v;
    return s.position +
           s.radius * std::sqrt(u) * (std::cos(angle) * side + std::sin(angle) * other);
  }
  // Of the triangles of a fan, the one that u falls in by their areas.
  const Vec3& apex = s.outline.front();
  const auto area = [&](std::size_t i) {
    return s.normal.dot((s.outline[i] - apex).cross(s.outline[i + 1] - apex));
  };
  double total = 0;
  for (std::size_t i = 1; i + 1 < s.outline.size(); ++i) total += area(i);
  double rest = u * total;
  std::size_t i = 1;
  while (i + 2 < s.outline.size() && rest >= area(i)) rest -= area(i++);
  const double along = std::sqrt(std::clamp(rest / area(i), 0.0, 1.0));
  return apex + along * ((1 - v) * (s.outline[i] - apex) + v * (s.outline[i + 1] - apex));
}

Surface shifted(Surface surface, double by) {
  surface.position += by * surface.normal;
  for (Vec3& p : surface.outline) p += by * surface.normal;
  return surface;
}

const char* name_of(Relation relation) {
  switch (relation) {
    case Relation::Coincident:
      return "coincident";
    case Relation::Parallel:
      return "parallel";
    case Relation::Perpendicular:
      return "perpendicular";
    case Relation::Distance:
      return "distance";
    default:
      return "angle";
  }
}

Measures measures_of(const Constraint& c) {
  if (c.relation == Relation::Distance) return {true, false};
  if (c.relation != Relation::Coincident) return {false, true};
  const bool points = c.first.feature.index() == 0 || c.second.feature.index() == 0;
  return {true, !points};
}

Cost cost(const Constraint& c, const Transform& first, const Transform& second, double length) {
  const std::size_t i = c.first.feature.index(), k = c.second.feature.index();
  if (i > k) {
    Cost out = cost({c.relation, c.second, c.first, c.value}, second, first, length);
    std::swap(out.first, out.second);
    return out;
  }
  const PosedFeature a = see(c.first.feature, first), b = see(c.second.feature, second);
  if (is_on_surface(c)) return on_surface(c, a, b, second, length);
  const std::size_t pair = kinds(kind_of(c.first.feature), kind_of(c.second.feature));
  Rows rows(a, b, length);
  switch (c.relation) {
    case Relation::Coincident:
      coincident(rows, a, b, pair);
      break;
    case Relation::Distance:
      coincident(rows, a, b, pair);
      rows.norm(c.value);
      break;
    case Relation::Parallel:
      directions(rows, a, b, pair != kLinePlane);
      break;
    case Relation::Perpendicular:
      directions(rows, a, b, pair == kLinePlane);
      break;
    case Relation::Angle:
      rows.angle(a.direction, b.direction, pair == kLinePlane, c.value);
      break;
  }
  return rows.result();
}

void require_valid(const Constraint& c) {
  const auto fail = [](const std::string& what) {
    throw Error(ErrorCode::InvalidArgument, "constraint: " + what);
  };
  if (!is_unit(c.first.feature) || !is_unit(c.second.feature))
    fail("a position is not finite or a direction not of unit length");
  for (const Feature* f : {&c.first.feature, &c.second.feature})
    if (const auto* surface = std::get_if<Surface>(f); surface != nullptr)
      if (!is_bounded_surface(*surface))
        fail("a surface is a disc with a radius above 0, or a flat convex outline with an area");
  const std::size_t i = kind_of(c.first.feature), k = kind_of(c.second.feature);
  const std::size_t pair = kinds(std::min(i, k), std::max(i, k));
  if (!supported(c.relation, pair) || (is_on_surface(c) && pair != kPointPlane)) {
    fail(std::string(name_of(c.relation)) + " of a " + name_of(c.first.feature) + " and a " +
         name_of(c.second.feature) + " is not defined");
  }
  if (c.first.frame == c.second.frame) fail("both features are fixed to the same frame");
  if (c.relation == Relation::Distance && !(c.value >= 0 && std::isfinite(c.value)))
    fail("a distance is a finite number of at least 0");
  const double low = pair == kLinePlane ? -kPi / 2 : 0, high = pair == kLinePlane ? kPi / 2 : kPi;
  if (c.relation == Relation::Angle && !(c.value >= low && c.value <= high))
    fail(pair == kLinePlane ? "the angle of a line and a plane is within -pi/2 and pi/2"
                            : "an angle of directions is within 0 and pi");
}

}  // namespace kaboum::kinematics
