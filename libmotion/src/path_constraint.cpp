// Constraints that a motion keeps at every instant: each is a bound of the norm of a vector that
// moves smoothly, decided by its ends and its second derivative.
// docs/algorithms/motion-planning.md.

#include <kaboum/base/error.h>
#include <kaboum/base/number_text.h>
#include <kaboum/motion/path_constraint.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/features.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "constraint_bands.h"

namespace kaboum::motion {
namespace {

using geom::Transform;
using geom::Vec3;
using kinematics::Relation;
using Measure = ConstraintBand::Measure;
using Certainty = ConstraintAnswer::Outcome;
using To = world::FixedFeature::To;

constexpr double kPi = std::numbers::pi;
/// Bounds the rounding of the few operations that a band's limits and residuals take.
constexpr double kOutward = 1 + 0x1p-40;
/// Where the room between two instants is this part of a band, and it is still not certain, it is
/// given up: the motion touches the tolerance.
constexpr double kLeastRoom = 1e-6;

/// No unit vectors are farther apart.
constexpr double kAnyChord = 2 + 0x1p-20;
constexpr std::size_t kInstantsTold = 256;  // instants

[[noreturn]] void refuse(const std::string& what) { throw Error(ErrorCode::InvalidArgument, what); }

enum Kind : std::size_t { kPoint, kLine, kPlane, kSurface };

Vec3 position_of(const kinematics::Feature& f) {
  return std::visit([](const auto& x) { return x.position; }, f);
}

Vec3 direction_of(const kinematics::Feature& f) {
  if (const auto* line = std::get_if<kinematics::Line>(&f)) return line->direction.normalized();
  if (const auto* plane = std::get_if<kinematics::Plane>(&f)) return plane->normal.normalized();
  return std::get<kinematics::Surface>(f).normal.normalized();
}

bool moves_with(const world::FixedFeature& feature, std::size_t robot) {
  return feature.to == To::Link && feature.index == robot;
}

Eigen::Matrix3d along(const Vec3& d) { return d * d.transpose(); }

class Bands {
 public:
  Bands(std::span<const PathConstraint> constraints, const world::RobotModel& robot,
        std::span<const double> start)
      : constraints_(constraints), robot_(robot) {
    if (!constraints.empty()) links_ = robot::forward(robot.kinematics, start);
  }

  std::vector<ConstraintBand> run() {
    for (at_ = 0; at_ < constraints_.size(); ++at_) add(constraints_[at_]);
    return std::move(bands_);
  }

 private:
  void add(const PathConstraint& c) {
    const std::size_t moving = c.moving.index(), resting = c.resting.index();
    const bool mixed = (moving == kLine) != (resting == kLine);  // a line and a plane
    switch (c.relation) {
      case Relation::Coincident:
        add_point(c);
        if (moving == kPoint) return;
        return mixed ? add_sine(c) : add_parallel(c);
      case Relation::Distance:
        return add_point(c);
      case Relation::Parallel:
        return mixed ? add_sine(c) : add_parallel(c);
      case Relation::Perpendicular:
        return mixed ? add_parallel(c) : add_sine(c);
      case Relation::Angle:
        return add_angle(c, direction_of(c.resting), mixed ? kPi / 2 - c.value : c.value);
    }
  }

  ConstraintBand& add_band(const PathConstraint& c, Measure measure, double value, double within) {
    ConstraintBand band;
    band.constraint = at_;
    band.link = c.link;
    band.measure = measure;
    band.value = value;
    band.within = within;
    bands_.push_back(band);
    return bands_.back();
  }

  /// The moving feature's point, and the feature that stays.
  void add_point(const PathConstraint& c) {
    ConstraintBand& band = add_band(c, Measure::Length, c.value, c.within);
    band.own = position_of(c.moving);
    band.center = position_of(c.resting);
    if (c.resting.index() == kLine)
      band.across = Eigen::Matrix3d::Identity() - along(direction_of(c.resting));
    if (c.resting.index() == kPlane) band.across = along(direction_of(c.resting));
    if (const auto* surface = std::get_if<kinematics::Surface>(&c.resting)) {
      band.surface = shifted(*surface, c.value);
      band.value = 0;
      band.high = c.within / kOutward;
      return;
    }
    band.low = std::max(0.0, c.value - c.within) * kOutward;
    band.high = (c.value + c.within) / kOutward;
  }

  void add_sine(const PathConstraint& c) {
    ConstraintBand& band = add_band(c, Measure::Sine, 0, c.within_angle);
    band.is_direction = true;
    band.own = direction_of(c.moving);
    band.across = along(direction_of(c.resting));
    band.high = c.within_angle < kPi / 2 ? std::sin(c.within_angle) / kOutward : kAnyChord;
  }

  /// In the sense that it has at the start.
  void add_parallel(const PathConstraint& c) {
    const Vec3 d = direction_of(c.resting);
    const Vec3 u = robot_.base.linear * (links_[c.link].linear * direction_of(c.moving));
    add_angle(c, u.dot(d) < 0 ? Vec3(-d) : d, 0);
  }

  /// Chords tell small angles apart, not those near half a turn: these are seen from behind.
  void add_angle(const PathConstraint& c, const Vec3& d, double value) {
    if (value > kPi / 2)
      add_chord(c, -d, kPi - value);
    else
      add_chord(c, d, value);
  }

  void add_chord(const PathConstraint& c, const Vec3& center, double value) {
    ConstraintBand& band = add_band(c, Measure::Chord, value, c.within_angle);
    band.is_direction = true;
    band.own = direction_of(c.moving);
    band.center = center;
    const double least = value - c.within_angle, most = value + c.within_angle;
    band.low = least > 0 ? 2 * std::sin(least / 2) * kOutward : 0;
    band.high = most < kPi ? 2 * std::sin(most / 2) / kOutward : kAnyChord;
  }

  std::span<const PathConstraint> constraints_;
  const world::RobotModel& robot_;
  std::vector<Transform> links_;
  std::size_t at_ = 0;
  std::vector<ConstraintBand> bands_;
};

/// Where on the straight line between two vectors the norm is least, as a share of it.
double least_share(const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double length = d.squaredNorm();
  return length > 0 ? std::clamp(-a.dot(d) / length, 0.0, 1.0) : 0;
}

/// The least norm on the straight line between two vectors.
double least_norm(const Vec3& a, const Vec3& b) { return (a + least_share(a, b) * (b - a)).norm(); }

/// No point of a surface is farther from the origin. [length]
double reach_of(const kinematics::Surface& surface) {
  double out = surface.position.norm() + surface.radius;
  for (const Vec3& corner : surface.outline) out = std::max(out, corner.norm());
  return out;
}

/// One band along one segment.
class BandCheck {
 public:
  BandCheck(const world::RobotModel& robot, const ConstraintBand& band,
            const sweep::LinkMotion& motion, const world::MotionOptions& options,
            ConstraintAnswer& answer)
      : base_(robot.base), band_(band), motion_(motion), options_(options), answer_(answer) {
    const std::array<Vec3, 2> points{band.is_direction ? Vec3(Vec3::Zero()) : band.own, band.own};
    const sweep::MotionBounds bounds(motion, points);
    second_ = !motion.moves()     ? 0
              : band.is_direction ? bounds.turn() * bounds.turn()
                                  : bounds.derivative(2);
    // Two points make a direction; 2^-44 is for the base, the projection and the norm. Outlines of
    // surfaces are convex up to less than 2^-36 of their size.
    error_ = ((band.is_direction ? 2 : 1) * bounds.error(0) +
              0x1p-44 * (bounds.extent() + base_.translation.norm() + band.center.norm() + 1) +
              (band.surface ? 0x1p-36 * reach_of(*band.surface) : 0)) *
             kOutward;
  }

  /// Leaves room for what is within options.around of the segment.
  /// @param out  from the end of the segment that is farther from 0, of each variable, away from it
  void leave_room(const sweep::LinkMotion& out) {
    if (!out.moves()) return;
    const std::array<Vec3, 2> points{band_.is_direction ? Vec3(Vec3::Zero()) : band_.own,
                                     band_.own};
    const sweep::MotionBounds bounds(out, points);
    error_ = (error_ + (band_.is_direction ? bounds.turn() : bounds.derivative(1))) * kOutward;
  }

  bool run() {
    if (band_.low == 0 && band_.high >= kAnyChord && band_.is_direction) return true;
    const Vec3 begin = residual(0), end = residual(1);
    return is_kept(0, begin) && is_kept(1, end) && stays(0, 1, begin, end);
  }

 private:
  Vec3 residual(double share) {
    if (answer_.instants++ % kInstantsTold == kInstantsTold - 1 && options_.progress)
      options_.progress(std::to_string(answer_.instants) + " instants of what is to be kept");
    Vec3 g = band_.residual(base_ * motion_.at(share));
    double& part = answer_.parts[band_.constraint];
    part = std::max(part, band_.deviation(g.norm()) / band_.within);
    return g;
  }

  bool is_kept(double share, const Vec3& g) {
    const double norm = g.norm();
    if (norm + error_ <= band_.high && (band_.low == 0 || norm - error_ >= band_.low)) return true;
    // The limits themselves are a little within the tolerance.
    const bool outside = norm - error_ > band_.high * kOutward * kOutward ||
                         norm + error_ < band_.low / (kOutward * kOutward);
    return fail(outside ? Certainty::Broken : Certainty::Undecided, share, norm);
  }

  /// @pre both ends are kept
  bool stays(double begin, double end, const Vec3& first, const Vec3& last) {
    const double length = end - begin;
    // Between two instants a vector is off the line between its values by an eighth of the second
    // derivative, times the square of the time, at most. On that line the distance from what is
    // convex is largest at an end.
    const double room = 0.125 * second_ * length * length * kOutward;
    const double most = std::max(first.norm(), last.norm());
    if (most + room + error_ <= band_.high &&
        (band_.low == 0 || least_norm(first, last) - room - error_ >= band_.low))
      return true;
    const double middle = 0.5 * begin + 0.5 * end;
    const bool given_up = room < kLeastRoom * (band_.high - band_.low) ||
                          !(begin < middle && middle < end) ||
                          answer_.instants >= options_.most_intervals;
    if (given_up) {
      // What fails here is where the norm is least, or nowhere for certain.
      const double at = begin + least_share(first, last) * length;
      const Vec3 there = residual(at);
      return is_kept(at, there) && fail(Certainty::Undecided, at, there.norm());
    }
    const Vec3 between = residual(middle);
    return is_kept(middle, between) && stays(begin, middle, first, between) &&
           stays(middle, end, between, last);
  }

  bool fail(Certainty outcome, double share, double norm) {
    answer_.outcome = outcome;
    answer_.share = share;
    answer_.constraint = band_.constraint;
    answer_.deviation = band_.deviation(norm);
    answer_.of_direction = band_.is_direction;
    return false;
  }

  const Transform& base_;
  const ConstraintBand& band_;
  const sweep::LinkMotion& motion_;
  const world::MotionOptions& options_;
  ConstraintAnswer& answer_;
  double second_ = 0, error_ = 0;
};

}  // namespace

double ConstraintBand::deviation(double norm) const {
  if (measure == Measure::Length) return std::abs(norm - value);
  if (measure == Measure::Sine) return std::asin(std::min(1.0, norm));
  return std::abs(2 * std::asin(std::min(1.0, norm / 2)) - value);
}

std::vector<ConstraintBand> bands_of(std::span<const PathConstraint> constraints,
                                     const world::RobotModel& robot,
                                     std::span<const double> start) {
  return Bands(constraints, robot, start).run();
}

bool check_segment(const world::RobotModel& robot, std::span<const ConstraintBand> bands,
                   std::span<const double> from, std::span<const double> to,
                   const world::MotionOptions& options, ConstraintAnswer& answer) {
  std::optional<sweep::LinkMotion> motion, out;
  std::uint32_t link = 0;
  const bool has_room = !options.around.empty();
  const auto [base, moved] = has_room ? world::outward(from, to, options.around)
                                      : std::pair<std::vector<double>, std::vector<double>>();
  for (const ConstraintBand& band : bands) {
    if (!motion || link != band.link) {
      motion.emplace(robot.kinematics, link = band.link, from, to);
      if (has_room) out.emplace(robot.kinematics, link, base, moved);
    }
    BandCheck check(robot, band, *motion, options, answer);
    if (out) check.leave_room(*out);
    if (!check.run()) return false;
  }
  return true;
}

ConstraintAnswer check_bands(const world::RobotModel& robot, std::span<const ConstraintBand> bands,
                             std::size_t constraints, const robot::Path& path,
                             const world::MotionOptions& options) {
  ConstraintAnswer answer;
  answer.parts.assign(constraints, 0);
  for (std::size_t i = 0; i == 0 || i + 1 < path.size(); ++i) {
    answer.segment = i;
    if (!check_segment(robot, bands, path[i], path[std::min(i + 1, path.size() - 1)], options,
                       answer))
      break;
  }
  return answer;
}

kinematics::Constraint kinematics_constraint(const PathConstraint& c) {
  using FrameKind = kinematics::FrameId::Kind;
  return {
      c.relation, {{FrameKind::Link, 0, 0}, c.moving}, {{FrameKind::World}, c.resting}, c.value};
}

const char* name_of(ConstraintAnswer::Outcome outcome) {
  return outcome == Certainty::Kept     ? "kept"
         : outcome == Certainty::Broken ? "broken"
                                        : "undecided";
}

bool is_of_motion(const world::World& world, const world::WorldState& state, std::size_t robot,
                  const world::ConstraintSet& set) {
  const auto is_of = [&](const world::ToleratedConstraint& c) {
    return moves_with(at_state(world, state, c.first), robot) !=
           moves_with(at_state(world, state, c.second), robot);
  };
  return std::ranges::all_of(set.constraints, is_of) && std::ranges::all_of(set.preferred, is_of);
}

std::vector<PathConstraint> path_constraints(const world::World& world,
                                             const world::WorldState& state, std::size_t robot,
                                             const world::ConstraintSet& set,
                                             std::size_t preferred) {
  std::vector<PathConstraint> out;
  const world::RobotModel& model = world.robots.at(robot);
  std::vector<world::ToleratedConstraint> all = set.constraints;
  all.insert(all.end(), set.preferred.begin(),
             set.preferred.begin() +
                 static_cast<std::ptrdiff_t>(std::min(preferred, set.preferred.size())));
  for (const world::ToleratedConstraint& c : all) {
    std::array<world::FixedFeature, 2> features{at_state(world, state, c.first),
                                                at_state(world, state, c.second)};
    const auto moves = [&](const world::FixedFeature& f) { return moves_with(f, robot); };
    const std::string which = "the constraint of '" + c.first.feature.name + "' and '" +
                              c.second.feature.name + "' in '" + set.name + "'";
    if (moves(features[0]) == moves(features[1]))
      refuse(which +
             (moves(features[0]) ? " is between two parts of robot '"
                                 : " has no part that moves with robot '") +
             model.name +
             "': one feature of a constraint that a motion keeps moves with the robot, "
             "and the other stays");
    if (moves(features[1])) std::swap(features[0], features[1]);
    world::Feature resting = features[1].feature;
    if (features[1].to == To::Link) {
      const world::RobotModel& other = world.robots[features[1].index];
      resting =
          moved(resting, other.base * robot::forward(other.kinematics,
                                                     state.q[features[1].index])[features[1].link]);
    }
    out.push_back({set.name, c.relation, features[0].link, kinematics_feature(features[0].feature),
                   kinematics_feature(resting), c.value, c.within, c.within_angle});
    try {
      require_keepable(out.back(), model.kinematics);
    } catch (const Error& error) {
      refuse(which + ": " + error.what());
    }
  }
  return out;
}

PathConstraint upright_constraint(const world::World& world, const world::Attachment& held,
                                  std::size_t object, double within_angle) {
  PathConstraint out;
  out.name = world.objects[object].name + " upright";
  // From no angle on: parallel directions might as well be opposite.
  out.relation = Relation::Angle;
  out.link = held.link;
  const Vec3 up = world.objects[object].pose.linear.transpose() * Vec3::UnitZ();
  out.moving = kinematics::Line{held.pose.translation, (held.pose.linear * up).normalized()};
  out.resting = kinematics::Line{};
  out.within_angle = within_angle;
  return out;
}

std::vector<PathConstraint> carried_constraints(const world::World& world,
                                                const world::WorldState& state, std::size_t robot) {
  std::vector<PathConstraint> out;
  for (std::size_t o = 0; o < world.objects.size(); ++o) {
    const auto& held = state.attachments[o];
    const std::optional<double>& upright = world.objects[o].upright;
    if (held && held->robot == robot && upright)
      out.push_back(upright_constraint(world, *held, o, *upright));
  }
  return out;
}

void require_keepable(const PathConstraint& c, const robot::Robot& robot) {
  require_valid(kinematics_constraint(c));
  if (c.link >= robot.links.size()) refuse("a constraint of a link that the robot lacks");
  if (!(c.within > 0) || !(c.within_angle > 0)) refuse("a tolerance must be above 0");
  const std::size_t moving = c.moving.index(), resting = c.resting.index();
  const bool positions = c.relation == Relation::Coincident || c.relation == Relation::Distance;
  if (positions && resting < moving)
    refuse(std::string("whether a ") +
           (moving == kLine    ? "line"
            : moving == kPlane ? "plane"
                               : "surface") +
           " that moves holds a " + (resting == kPoint ? "point" : "line") +
           " that stays is not decided; let the smaller one move");
}

ConstraintAnswer check_constraints(const world::RobotModel& robot, const robot::Path& path,
                                   std::span<const PathConstraint> constraints,
                                   const world::MotionOptions& options) {
  if (constraints.empty() || path.empty())
    return check_bands(robot, {}, constraints.size(), {{}}, options);
  return check_bands(robot, bands_of(constraints, robot, path.front()), constraints.size(), path,
                     options);
}

std::string describe(const ConstraintAnswer& answer, std::span<const PathConstraint> constraints) {
  const PathConstraint& c = constraints[answer.constraint];
  const std::string unit = answer.of_direction ? " rad" : "";
  return "'" + c.name + "' is off by " + number_text(answer.deviation) + unit + ", " +
         number_text(answer.of_direction ? c.within_angle : c.within) + unit + " are allowed";
}

ConstraintProjection::ConstraintProjection(const world::RobotModel& robot,
                                           std::span<const PathConstraint> constraints,
                                           std::span<const ConstraintBand> bands)
    : robot_(robot), constraints_(constraints), bands_(bands) {}

double ConstraintProjection::largest(std::span<const Transform> links) const {
  double out = 0;
  for (const ConstraintBand& band : bands_)
    out = std::max(
        out, band.deviation(band.residual(robot_.base * links[band.link]).norm()) / band.within);
  return out;
}

bool ConstraintProjection::project(std::vector<double>& q, double share) const {
  constexpr int kSteps = 25;
  constexpr double kLongest = 0.5, kDamping = 1e-8;
  const robot::Robot& robot = robot_.kinematics;
  const auto n = static_cast<Eigen::Index>(q.size());
  for (int step = 0; step < kSteps; ++step) {
    const std::vector<Transform> links = robot::forward(robot, q);
    if (largest(links) <= share) return true;
    Eigen::MatrixXd rows(0, n);
    Eigen::VectorXd values(0);
    for (const PathConstraint& c : constraints_) {
      const kinematics::Cost cost =
          kinematics::cost(kinematics_constraint(c), robot_.base * links[c.link], Transform{}, 1);
      Eigen::Matrix<double, 6, Eigen::Dynamic> twist =
          robot::jacobian(robot, q, c.link, Vec3::Zero());
      twist.topRows<3>() = robot_.base.linear * twist.topRows<3>();
      twist.bottomRows<3>() = robot_.base.linear * twist.bottomRows<3>();
      const Eigen::Index m = cost.value.size(), at = values.size();
      rows.conservativeResize(at + m, n);
      values.conservativeResize(at + m);
      rows.bottomRows(m) = cost.first * twist;
      values.tail(m) = cost.value;
    }
    Eigen::MatrixXd square = rows * rows.transpose();
    square.diagonal().array() += kDamping * (1 + square.trace());
    Eigen::VectorXd change = rows.transpose() * square.ldlt().solve(values);
    const double length = change.norm();
    if (!std::isfinite(length)) return false;
    if (length > kLongest) change *= kLongest / length;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const robot::Variable& v = robot.variables[k];
      q[k] -= change[i];
      if (v.lower) q[k] = std::max(q[k], *v.lower);
      if (v.upper) q[k] = std::min(q[k], *v.upper);
    }
  }
  return largest(robot::forward(robot, q)) <= share;
}

}  // namespace kaboum::motion
