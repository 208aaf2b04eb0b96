// Constraints that contradict each other, and such that nothing reaches.
//
// Two things meet constraints at a pose (R, t) of the second one in the frame of the first. All
// rotations are covered by cells. A cell is left out where no rotation of it meets the constraints:
// angles differ by no more than it turns; and for one rotation each constraint of a point asks that
// t is near a point, a line or a plane, of which two may be too far apart. Where all cells are left
// out, no pose meets the constraints. docs/scene.md.
#include <kaboum/base/error.h>
#include <kaboum/world/constraint_conflict.h>
#include <kaboum/world/features.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

namespace kaboum::world {
namespace {

using kinematics::Relation;
using Kind = Feature::Kind;
using Mat3 = Eigen::Matrix3d;

constexpr double kPi = std::numbers::pi;
/// More than sums of a few lengths and angles lose: of a length, and an angle. [1; rad]
constexpr double kLost = 1e-9;
/// Cells of rotations that are looked at, times what is looked at in each.
constexpr std::size_t kMostWork = 100000;

/// An interval of the angle of two directions.
struct AngleBand {
  Vec3 first, second;  ///< in the frames of the first and the second thing, of unit length
  double low = 0, high = kPi;
  bool either = false;  ///< of either sense of the first direction
};

/// Whether both bands may hold for some rotation: the angles between their directions, of the first
/// thing and of the second, differ by no more than the bands allow.
bool may_hold(const AngleBand& a, const AngleBand& b) {
  const auto angle = [](const Vec3& u, const Vec3& v) {
    return std::atan2(u.cross(v).norm(), u.dot(v));
  };
  const double first = angle(a.first, b.first), second = angle(a.second, b.second);
  double apart = std::abs(first - second);
  if (a.either || b.either) apart = std::min(apart, std::abs(std::numbers::pi - first - second));
  return apart <= a.high + b.high;
}

/// What a constraint asks of a point: low ≤ |across · (x − center)| ≤ high, in one thing's frame.
struct PointBand {
  bool of_second = false;  ///< the point is the second thing's, the rest the first's; or vice versa
  Vec3 point, center;
  Mat3 across = Mat3::Identity();  ///< a projection
  double low = 0, high = 0;
};

Mat3 along(const Vec3& d) { return d * d.transpose(); }

bool is_flat(Kind kind) { return kind == Kind::Plane || kind == Kind::Surface; }

void add_angles(const ToleratedConstraint& c, std::vector<AngleBand>& out) {
  const Kind first = c.first.feature.kind, second = c.second.feature.kind;
  if (first == Kind::Point || second == Kind::Point || c.relation == Relation::Distance) return;
  const bool mixed = is_flat(first) != is_flat(second);
  AngleBand band{c.first.feature.direction, c.second.feature.direction};
  double value = 0;
  if (c.relation == Relation::Angle) {
    value = mixed ? kPi / 2 - c.value : c.value;
  } else {
    const bool aligned = (c.relation != Relation::Perpendicular) != mixed;
    value = aligned ? 0 : kPi / 2;
    band.either = true;
  }
  band.low = value - c.within_angle - kLost;
  band.high = value + c.within_angle + kLost;
  out.push_back(band);
}

void add_points(const ToleratedConstraint& c, std::vector<PointBand>& out) {
  if (c.relation != Relation::Coincident && c.relation != Relation::Distance) return;
  const Feature &first = c.first.feature, &second = c.second.feature;
  // The point is that of the smaller feature; of equal ones, whose tolerance is about the one that
  // moves, either may be meant: only points say the same both ways.
  if (first.kind != Kind::Point && second.kind != Kind::Point) return;
  PointBand band;
  band.of_second = first.kind != Kind::Point;
  const Feature &point = band.of_second ? second : first, &other = band.of_second ? first : second;
  band.point = point.point;
  band.center = other.point;
  double value = c.value;
  if (other.kind == Kind::Line) band.across -= along(other.direction);
  if (other.kind == Kind::Plane) band.across = along(other.direction);
  if (other.kind == Kind::Surface) {
    // It lies in a ball about the middle of its surface.
    band.center += value * other.direction;
    band.high = radius_of(other);
    value = 0;
    PointBand in_plane = band;
    in_plane.across = along(other.direction);
    in_plane.high = c.within * (1 + kLost);
    out.push_back(in_plane);
  }
  band.low = (value - c.within) * (1 - kLost);
  band.high = (band.high + value + c.within) * (1 + kLost);
  out.push_back(band);
}

/// A cell of rotations: a cube on one side of the cube of quaternions.
struct Cell {
  Eigen::Vector4d middle;
  double half = 1;
  int side = 0;
};

/// The angle that the rotations of a cell differ from its middle's by at most. Quaternions outside
/// the unit ball are no closer than their directions; rotations turn by twice as much. [rad]
double turn_of(const Cell& cell) {
  return 4 * std::asin(std::min(1.0, std::sqrt(3.0) * cell.half / 2)) + kLost;
}

Mat3 rotation_of(const Cell& cell) {
  const Eigen::Vector4d q = cell.middle.normalized();
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

/// Whether the angle of directions may be within a band, up to a turn.
bool may_hold(const AngleBand& band, const Mat3& rotation, double turn) {
  const Vec3 second = rotation * band.second;
  const double angle = std::atan2(band.first.cross(second).norm(), band.first.dot(second));
  const auto near = [&](double x) { return x + turn >= band.low && x - turn <= band.high; };
  return near(angle) || (band.either && near(kPi - angle));
}

/// Two bands of points whose rest is of the same thing: for one rotation Q each asks that
/// low ≤ |S (t − c)| ≤ high with c = center − Q point, for the same t.
struct PointPair {
  Vec3 centers, points;        ///< differences, in the frames of the rest and of the points
  Mat3 common = Mat3::Zero();  ///< onto what both projections keep
  bool of_second = false;      ///< Q is the rotation; else its inverse
  bool is_ball = false;        ///< both keep everything
  double high = 0;             ///< sum
  /// The low of one less the high of the other one, where that lies in a hole; 0: there is none.
  std::array<double, 2> holes{};
};

/// Onto what two projections (onto a point's space, a line's or a plane's) have in common. Where
/// that hangs on whether directions are the very same, they are when their numbers are.
Mat3 common_space(const Mat3& a, const Mat3& b) {
  constexpr double kSkew = 1e-3;
  if (a.isIdentity(0) || a == b) return b;
  if (b.isIdentity(0)) return a;
  const bool thin_a = a.trace() < 1.5, thin_b = b.trace() < 1.5;  // of a plane
  if (thin_a && thin_b) return Mat3::Zero();
  if (thin_a) return b * a == a ? a : Mat3(Mat3::Zero());
  if (thin_b) return a * b == b ? b : Mat3(Mat3::Zero());
  // Across both lines.
  const Mat3 off_a = Mat3::Identity() - a, off_b = Mat3::Identity() - b;
  Eigen::Index i = 0, k = 0;
  off_a.diagonal().maxCoeff(&i);
  off_b.diagonal().maxCoeff(&k);
  const Vec3 across = off_a.col(i).normalized().cross(off_b.col(k).normalized());
  return across.norm() > kSkew ? along(across.normalized()) : Mat3(Mat3::Zero());
}

std::optional<PointPair> pair_of(const PointBand& a, const PointBand& b) {
  const bool ball_a = a.across.isIdentity(0), ball_b = b.across.isIdentity(0);
  if (a.of_second != b.of_second && !ball_a && !ball_b) return std::nullopt;
  // What is about two points is the same from both sides.
  const bool of_second = ball_a ? b.of_second : a.of_second;
  const auto rest = [&](const PointBand& x) {
    return x.of_second == of_second ? x.center : x.point;
  };
  const auto own = [&](const PointBand& x) {
    return x.of_second == of_second ? x.point : x.center;
  };
  PointPair out;
  out.centers = rest(a) - rest(b);
  out.points = own(a) - own(b);
  out.common = common_space(a.across, b.across);
  out.of_second = of_second;
  out.is_ball = ball_a && ball_b;
  out.high = a.high + b.high;
  // Where one tube lies within the hole of the other one.
  if (a.low > 0 && out.common == a.across) out.holes[0] = a.low - b.high;
  if (b.low > 0 && out.common == b.across) out.holes[1] = b.low - a.high;
  return out;
}

/// Whether both bands may hold for a rotation, up to a turn.
bool may_hold(const PointPair& pair, const Mat3& rotation, double turn) {
  const Vec3 turned =
      pair.of_second ? Vec3(rotation * pair.points) : Vec3(rotation.transpose() * pair.points);
  const double far = pair.points.norm();
  const double chord = 2 * std::sin(std::min(turn, kPi) / 2) * far;
  const double rounding = kLost * (far + pair.centers.norm());
  const double apart = (pair.common * (pair.centers - turned)).norm();
  const double fixed = (pair.common * pair.centers).norm();
  // Whatever the rotation is, both points are as far from each other as they are.
  const double least = std::max({apart - chord, fixed - far, pair.is_ball ? far - fixed : 0.0});
  if (least > pair.high + rounding) return false;
  return std::ranges::none_of(pair.holes,
                              [&](double hole) { return apart + chord + rounding < hole; });
}

class Rotations {
 public:
  explicit Rotations(const std::vector<const ToleratedConstraint*>& constraints) {
    std::vector<PointBand> points;
    for (const ToleratedConstraint* c : constraints) {
      add_angles(*c, angles_);
      add_points(*c, points);
    }
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (auto pair = pair_of(points[i], points[k])) pairs_.push_back(*pair);
  }

  /// Whether no rotation is left.
  [[nodiscard]] bool are_none() const {
    for (std::size_t i = 0; i < angles_.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (!may_hold(angles_[i], angles_[k])) return true;
    std::vector<Cell> cells;
    cells.reserve(4);
    for (int side = 0; side < 4; ++side) cells.push_back({Eigen::Vector4d::Unit(side), 1, side});
    const std::size_t work = angles_.size() + pairs_.size();
    for (std::size_t looked = 0; !cells.empty(); looked += work) {
      const Cell cell = cells.back();
      cells.pop_back();
      const Mat3 rotation = rotation_of(cell);
      if (!is_left(rotation, turn_of(cell))) continue;
      if (looked >= kMostWork || is_left(rotation, 0)) return false;
      for (int part = 0; part < 8; ++part) {
        Cell& child = cells.emplace_back(cell);
        child.half = cell.half / 2;
        for (int axis = 0; axis < 3; ++axis)
          child.middle[(cell.side + 1 + axis) % 4] +=
              ((part >> axis) & 1) != 0 ? child.half : -child.half;
      }
    }
    return true;
  }

 private:
  [[nodiscard]] bool is_left(const Mat3& rotation, double turn) const {
    const auto may = [&](const auto& band) { return may_hold(band, rotation, turn); };
    return std::ranges::all_of(angles_, may) && std::ranges::all_of(pairs_, may);
  }

  std::vector<AngleBand> angles_;
  std::vector<PointPair> pairs_;
};

using Thing = std::tuple<FixedFeature::To, std::size_t, std::uint32_t>;

Thing thing_of(const FixedFeature& f) { return {f.to, f.index, f.link}; }

/// With the lesser thing first.
ToleratedConstraint in_order(ToleratedConstraint c) {
  if (thing_of(c.second) < thing_of(c.first)) std::swap(c.first, c.second);
  return c;
}

}  // namespace

std::optional<std::vector<std::size_t>> find_contradiction(
    const std::vector<ToleratedConstraint>& constraints) {
  std::vector<ToleratedConstraint> ordered;
  ordered.reserve(constraints.size());
  for (const ToleratedConstraint& c : constraints) ordered.push_back(in_order(c));
  std::map<std::pair<Thing, Thing>, std::vector<std::size_t>> between;
  for (std::size_t i = 0; i < ordered.size(); ++i)
    between[{thing_of(ordered[i].first), thing_of(ordered[i].second)}].push_back(i);
  const auto contradict = [&](const std::vector<std::size_t>& numbers) {
    std::vector<const ToleratedConstraint*> some;
    some.reserve(numbers.size());
    for (const std::size_t i : numbers) some.push_back(&ordered[i]);
    return numbers.size() > 1 && Rotations(some).are_none();
  };
  for (auto& [things, numbers] : between) {
    if (!contradict(numbers)) continue;
    for (std::size_t i = 0; i < numbers.size();) {
      std::vector<std::size_t> fewer = numbers;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
      if (contradict(fewer))
        numbers = std::move(fewer);
      else
        ++i;
    }
    return numbers;
  }
  return std::nullopt;
}

std::string describe(const std::vector<ToleratedConstraint>& constraints,
                     const std::vector<std::size_t>& contradiction) {
  std::string these;
  for (const std::size_t i : contradiction)
    these.append(these.empty() ? "" : ", ").append(describe(constraints[i]));
  return "these constraints contradict each other, wherever the things are: " + these +
         "; take one out, change its value, or widen its tolerance";
}

double longest_reach(const RobotModel& robot, std::uint32_t link, const Vec3& point) {
  const robot::Robot& chain = robot.kinematics;
  // Nothing but sliding changes how far a frame is from the one before it.
  double out = point.norm();
  for (std::uint32_t l = link; l != 0; l = chain.joints[l - 1].parent) {
    const robot::Joint& joint = chain.joints[l - 1];
    out += joint.origin.translation.norm();
    if (joint.type != robot::JointType::Prismatic) continue;
    const robot::Variable& v = chain.variables[joint.variable];
    constexpr double kNoLimit = std::numeric_limits<double>::infinity();
    const double most =
        std::max(std::abs(v.lower.value_or(kNoLimit)), std::abs(v.upper.value_or(kNoLimit)));
    out += std::abs(joint.multiplier) * most + std::abs(joint.offset);
  }
  return out * (1 + kLost);
}

bool is_beyond_reach(const RobotModel& robot, const ToleratedConstraint& c) {
  ensure(c.first.to == FixedFeature::To::Link && c.second.to == FixedFeature::To::World,
         "a feature of a link, and one of the world");
  if (c.relation != Relation::Coincident && c.relation != Relation::Distance) return false;
  if (c.first.feature.kind != Kind::Point) return false;
  const Feature& rest = c.second.feature;
  const Vec3 from = robot.base.translation;
  const double distance = distance_from(rest, from);
  const double rounding = kLost * (rest.point.norm() + from.norm() + std::abs(c.value));
  const double reach = longest_reach(robot, c.first.link, c.first.feature.point);
  return distance - c.value - c.within > reach + rounding ||
         c.value - c.within > reach + distance + rounding;
}

}  // namespace kaboum::world
