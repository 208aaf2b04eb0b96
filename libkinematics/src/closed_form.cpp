// Closed-form inverse kinematics of three families of arms.
// Source: [gaschler2016] App. A.3, with the corrections and for the families that
// docs/algorithms/inverse-kinematics.md derives. x1 … z4 are axes of the frames there.
#include <kaboum/kinematics/closed_form.h>
#include <kaboum/kinematics/copies.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>

#include "improve.h"
#include "tolerances.h"

namespace kaboum::kinematics {
namespace {

double square(double x) { return x * x; }
double length(double x, double y) { return std::sqrt(x * x + y * y); }

}  // namespace

ShoulderTurns shoulder_turns(const ClosedForm& form, const FreeWithin& within, double side,
                             const Vec3& t, const Vec3& z) {
  ShoulderTurns out;
  const double across = length(t.x(), t.y()), rest = square(across) - square(form.lateral);
  if (rest < -kBorder * square(form.reach)) return out;
  const double r = rest > 0 ? std::sqrt(rest) : 0, near = across / form.reach;
  const bool on_axis = across <= within.length;
  // With five axes joint 1 is to put axis 5 into a plane through axis 1, too: that says more of it
  // than the wrist's place does where this is near axis 1, or at the border of reach.
  const bool five = form.family == Family::FiveAxes;
  const double level = length(z.x(), z.y());
  if (five && level > within.angle && (level > 1e-3 || level > r / form.reach)) {
    out.angle = {std::atan2(z.y(), z.x()), std::atan2(z.y(), z.x()) + kPi};
    out.count = 2;
    out.nearly = near < kNearlySingular && level < kNearlySingular;
    out.error = kRounding / level;
    return out;
  }
  out.free = on_axis && std::abs(form.lateral) <= within.length;
  out.nearly =
      !out.free && near < kNearlySingular && std::abs(form.lateral) < kNearlySingular * form.reach;
  if (on_axis) return out;
  out.single = r < kNothing * form.reach;
  out.count = out.single ? 1 : 2;
  // r is a root of what is known to `near` times the rounding: near 0 it is known to its root.
  out.error =
      std::min(kRounding * form.reach / std::max(r, 1e-300), std::sqrt(2 * kRounding / near));
  const double d = side * form.lateral;
  for (int branch = 0; branch < out.count; ++branch) {
    const double kappa = branch == 0 ? r : -r;
    out.angle[static_cast<std::size_t>(branch)] =
        std::atan2(kappa * t.y() - d * t.x(), kappa * t.x() + d * t.y());
  }
  return out;
}

double error_after_elbow(const ClosedForm& form, double error, double distance, double second,
                         bool folded) {
  const double cosine =
                   (square(distance) - square(form.a2) - square(second)) / (2 * form.a2 * second),
               sine = std::sqrt(std::max(0.0, 1 - square(cosine))),
               cosine_error = kRounding + error * std::max(distance, kNearlySingular * form.reach) *
                                              form.reach / (form.a2 * second),
               elbow = std::min(cosine_error / std::max(sine, 1e-300), std::sqrt(2 * cosine_error));
  if (folded) return error + elbow;
  return error * (1 + form.reach / distance) + elbow * (1 + second / distance);
}

namespace {

double wrapped(double angle) {
  while (angle > kPi) angle -= 2 * kPi;
  while (angle <= -kPi) angle += 2 * kPi;
  return angle;
}

/// A joint's value, and sine and cosine of the angle in the formulas that this value gives.
struct Turn {
  double q = 0, s = 0, c = 1;
};

/// One call of solve: a target in the closed form's own frames.
class Solver {
 public:
  Solver(const ClosedForm& form, const Transform& target, const SolveOptions& options,
         Solutions& out)
      : f_(form), within_(form, options.bound), options_(options), out_(out) {
    const Transform flange = form.base_inverse * target * form.tool_inverse;
    n_ = flange.linear.col(0);
    s_ = flange.linear.col(1);
    z_ = flange.linear.col(2);
    t_ = flange.translation;
    reach_ = f_.reach;
    // Elsewhere Newton's method moves what is found here.
    leave_outside_ = options.leave_outside &&
                     form.model_error.position <= options.bound / 2 * form.reach &&
                     form.model_error.rotation <= options.bound / 2;
  }

  void spherical_wrist() {
    for_each_shoulder(1, [&] {
      const double y = -t_.z();
      error_ = shoulder_error_;
      for_each_elbow(along_ - f_.a1, y, f_.forearm, f_.bend, [&] { spherical_wrist_of_elbow(); });
    });
  }

  void parallel_axes() {
    for_each_shoulder(-1, [&] {
      const Vec3 z1(turn_[0].s, -turn_[0].c, 0);
      const double zn = z1.dot(n_), zs = z1.dot(s_), zz = z1.dot(z_), off = length(zn, zs);
      const bool free = look_at_wrist(off, 5);
      for (int branch = 0; branch < (free ? 1 : 2); ++branch) {
        const double sigma = branch == 0 ? 1 : -1;
        turn_[4] = turn(4, std::atan2(sigma * off, zz));
        turn_[5] = free ? kept(5) : turn(5, std::atan2(-sigma * zs, sigma * zn));
        error_ = free ? shoulder_error_ : (kRounding + shoulder_error_) / off;
        const Vec3 z4 = -(turn_[5].s * n_ + turn_[5].c * s_);
        forearm_of(turn_[0].c * z4.x() + turn_[0].s * z4.y(), -z4.z());
      }
    });
  }

  void five_axes() {
    for_each_shoulder(-1, [&] {
      const Vec3 z1(turn_[0].s, -turn_[0].c, 0);
      turn_[4] = turn(4, std::atan2(z1.dot(n_), z1.dot(s_)));
      error_ = shoulder_error_;
      forearm_of(turn_[0].c * z_.x() + turn_[0].s * z_.y(), -z_.z());
    });
  }

 private:
  /// The joint's value for an angle in the formulas.
  [[nodiscard]] Turn turn(std::size_t joint, double angle) const {
    return at(joint, value(joint, angle));
  }
  [[nodiscard]] double value(std::size_t joint, double angle) const {
    return wrapped(f_.sign[joint] * (angle - f_.offset[joint]));
  }
  [[nodiscard]] Turn kept(std::size_t joint) const {
    return at(joint, wrapped(options_.reference[joint]));
  }
  [[nodiscard]] Turn at(std::size_t joint, double q) const {
    const double angle = f_.sign[joint] * q + f_.offset[joint];
    return {q, std::sin(angle), std::cos(angle)};
  }

  /// True if a joint's value is to be left out with all that go with it.
  bool is_left(std::size_t joint) {
    if (!leave_outside_ || has_copy(f_.arm.axes[joint], turn_[joint].q, kOnLimit)) return false;
    out_.left_outside = true;
    return true;
  }

  /// `along_` is what joint 1 leaves of the wrist's place: c0 tx + s0 ty.
  template <class Next>
  void for_each_shoulder(double side, const Next& next) {
    const ShoulderTurns turns = shoulder_turns(f_, within_, side, t_, z_);
    out_.nearly_singular |= turns.nearly;
    shoulder_ = turns.free || turns.single ? kShoulder : kRegular;
    free_shoulder_ = turns.free ? 1U : 0U;
    shoulder_error_ = turns.error;
    for (int branch = 0; branch < (turns.free ? 1 : turns.count); ++branch) {
      turn_[0] = turns.free ? kept(0) : turn(0, turns.angle[static_cast<std::size_t>(branch)]);
      along_ = turn_[0].c * t_.x() + turn_[0].s * t_.y();
      next();
    }
  }

  /// @param off  sine of the angle between two axes; where they are aligned `joint` is free.
  bool look_at_wrist(double off, std::size_t joint) {
    const bool free = off <= within_.angle;
    out_.nearly_singular |= !free && off < kNearlySingular;
    wrist_ = free ? kWrist : kRegular;
    free_wrist_ = free ? 1U << joint : 0U;
    return free;
  }

  /// Joints 2 and 3 of two links in a plane: a2 e^{iθ1} + second e^{i(θ1 + θ2 + bend)} = x + iy,
  /// where x and y are known to `error_` times the reach.
  template <class Next>
  void for_each_elbow(double x, double y, double second, double bend, const Next& next) {
    const double v = x * x + y * y;
    double cosine = (v - square(f_.a2) - square(second)) / (2 * f_.a2 * second);
    if (!(std::abs(cosine) <= 1 + kBorder) || is_left(0)) return;
    cosine = std::min(1.0, std::max(-1.0, cosine));
    const double sine = std::sqrt(1 - square(cosine)), inner = std::atan2(sine, cosine);
    const double k1 = f_.a2 + second * cosine;
    const bool folded = v <= square(within_.length), single = sine == 0 || folded;
    out_.nearly_singular |= !folded && v < square(kNearlySingular * reach_);
    elbow_ = single ? kElbow : kRegular;
    free_elbow_ = folded ? 1U << 1U : 0U;
    elbow_error_ = error_after_elbow(f_, error_, std::sqrt(v), second, folded);
    for (int branch = 0; branch < (single ? 1 : 2); ++branch) {
      const double epsilon = branch == 0 ? 1 : -1, k2 = epsilon * second * sine;
      turn_[1] = folded ? kept(1) : turn(1, std::atan2(k1 * y - k2 * x, k1 * x + k2 * y));
      if (is_left(1)) continue;
      turn_[2] = turn(2, epsilon * inner - bend);
      if (is_left(2)) continue;
      c12_ = turn_[1].c * turn_[2].c - turn_[1].s * turn_[2].s;
      s12_ = turn_[1].s * turn_[2].c + turn_[1].c * turn_[2].s;
      next();
    }
  }

  void spherical_wrist_of_elbow() {
    const double s0 = turn_[0].s, c0 = turn_[0].c;
    const double px = f_.a1 + f_.a2 * turn_[1].c + f_.a3 * c12_ - f_.d4 * s12_;
    const double py = f_.a2 * turn_[1].s + f_.a3 * s12_ + f_.d4 * c12_;
    const Vec3 wrist(c0 * px - s0 * f_.lateral, s0 * px + c0 * f_.lateral, -py);
    const double position = (wrist - t_).norm();
    // The target's axes in frame 3.
    const Vec3 x3(c0 * c12_, s0 * c12_, -s12_), y3(s0, -c0, 0), z3(-c0 * s12_, -s0 * s12_, -c12_);
    const Vec3 n(x3.dot(n_), y3.dot(n_), z3.dot(n_)), s(x3.dot(s_), y3.dot(s_), z3.dot(s_)),
        z(x3.dot(z_), y3.dot(z_), z3.dot(z_));
    const double off = length(z.x(), z.y());
    const bool free = look_at_wrist(off, 3);
    const double a3 = free ? 0 : std::atan2(z.y(), z.x()), a4 = std::atan2(off, -z.z());
    turn_[3] = free ? kept(3) : turn(3, a3);
    turn_[4] = turn(4, a4);
    // z4 in the target's axes.
    const double a5 = std::atan2(turn_[3].s * n.x() - turn_[3].c * n.y(),
                                 turn_[3].s * s.x() - turn_[3].c * s.y());
    turn_[5] = turn(5, a5);
    if (!free) elbow_error_ = (kRounding + shoulder_error_ + elbow_error_) / off;
    const double rotation = spherical_rotation_error(n, s, z);
    emit(position, rotation);
    if (free) return;
    // The wrist's other side: sines and cosines are the same up to signs and to the rounding of
    // the angles (8 ulps of 2π, times √2 for the norm), which is added.
    turn_[3] = {value(3, a3 + kPi), -turn_[3].s, -turn_[3].c};
    turn_[4] = {value(4, -a4), -turn_[4].s, turn_[4].c};
    turn_[5] = {value(5, a5 + kPi), -turn_[5].s, -turn_[5].c};
    emit(position, rotation + 1e-14);
  }

  [[nodiscard]] double spherical_rotation_error(const Vec3& n, const Vec3& s, const Vec3& z) const {
    const double s3 = turn_[3].s, c3 = turn_[3].c, s4 = turn_[4].s, c4 = turn_[4].c,
                 s5 = turn_[5].s, c5 = turn_[5].c;
    const Vec3 x5(c3 * c4, s3 * c4, s4), z4(s3, -c3, 0), z5(c3 * s4, s3 * s4, -c4);
    return std::sqrt((c5 * x5 + s5 * z4 - n).squaredNorm() + (c5 * z4 - s5 * x5 - s).squaredNorm() +
                     (z5 - z).squaredNorm());
  }

  /// Joints 2 to 4 of the families with parallel axes; their angles add up to that of (c, s).
  void forearm_of(double s, double c) {
    const double sum = std::atan2(s, c), x = along_ - f_.a1 - f_.a4 * c - f_.d5 * s,
                 y = t_.z() - f_.a4 * s + f_.d5 * c;
    for_each_elbow(x, y, f_.a3, 0, [&] {
      const double first = f_.sign[1] * turn_[1].q + f_.offset[1],
                   second = f_.sign[2] * turn_[2].q + f_.offset[2];
      turn_[3] = turn(3, sum - first - second);
      check_parallel_axes();
    });
  }

  void check_parallel_axes() {
    const double s0 = turn_[0].s, c0 = turn_[0].c, s4 = turn_[4].s, c4 = turn_[4].c;
    const double c = c12_ * turn_[3].c - s12_ * turn_[3].s,
                 s = s12_ * turn_[3].c + c12_ * turn_[3].s;
    const double px = f_.a1 + f_.a2 * turn_[1].c + f_.a3 * c12_ + f_.a4 * c + f_.d5 * s;
    const double py = f_.a2 * turn_[1].s + f_.a3 * s12_ + f_.a4 * s - f_.d5 * c;
    const Vec3 end(c0 * px + s0 * f_.lateral, s0 * px - c0 * f_.lateral, py);
    const Vec3 x4(c0 * c, s0 * c, s), y4(s0, -c0, 0), z4(c0 * s, s0 * s, -c);
    const Vec3 x5 = c4 * x4 + s4 * y4;
    double rotation = 0;
    if (f_.family == Family::FiveAxes) {
      rotation = (x5 - n_).squaredNorm() + (c4 * y4 - s4 * x4 - s_).squaredNorm() +
                 (z4 - z_).squaredNorm();
    } else {
      const double s5 = turn_[5].s, c5 = turn_[5].c;
      rotation = (c5 * x5 - s5 * z4 - n_).squaredNorm() + (-s5 * x5 - c5 * z4 - s_).squaredNorm() +
                 (c4 * y4 - s4 * x4 - z_).squaredNorm();
    }
    emit((end - t_).norm(), std::sqrt(rotation));
  }

  /// Takes the present turns as a solution, unless it is too far off.
  void emit(double position, double rotation) {
    position += f_.lever * rotation;
    const PoseError& model = f_.model_error;
    if (position > options_.bound * reach_ + 4 * model.position ||
        rotation > options_.bound + 4 * model.rotation)
      return;
    for (std::size_t i = 3; i < f_.arm.axes.size(); ++i)
      if (is_left(i)) return;
    Solution& out = out_.add();
    for (std::size_t i = 0; i < 6; ++i) out.q[i] = turn_[i].q;
    out.position_error = position + model.position;
    out.rotation_error = rotation + model.rotation;
    out.singular = shoulder_ | elbow_ | wrist_;
    out.free = free_shoulder_ | free_elbow_ | free_wrist_;
    out.accuracy = std::min(kPi, kRounding + shoulder_error_ + error_ + elbow_error_);
  }

  const ClosedForm& f_;
  const FreeWithin within_;
  const SolveOptions& options_;
  Solutions& out_;
  Vec3 n_, s_, z_, t_;  ///< the target: axes and origin of the last frame, in the first
  bool leave_outside_ = false;
  double reach_ = 0, along_ = 0, c12_ = 1, s12_ = 0;
  unsigned shoulder_ = kRegular, elbow_ = kRegular, wrist_ = kRegular;
  unsigned free_shoulder_ = 0, free_elbow_ = 0, free_wrist_ = 0;
  double shoulder_error_ = 0;  ///< how well joint 1 is known [rad]
  double error_ = 0;           ///< the same of what joints 2 and 3 follow from
  double elbow_error_ = 0;     ///< of them and all after them
  std::array<Turn, 6> turn_;
};

}  // namespace

bool improve(const ClosedForm& f, const Transform& target, const SolveOptions& options,
             Solution& solution) {
  const std::span<double> q(solution.q.data(), f.arm.axes.size());
  for (int step = 0;; ++step) {
    Transform pose;
    const auto j = jacobian(f.arm, q, &pose);
    const PoseError error = difference(pose, target);
    solution.position_error = error.position;
    solution.rotation_error = error.rotation;
    if (error.position <= options.bound * f.reach && error.rotation <= options.bound) break;
    if (step == 8) return false;
    const Mat3 turn = target.linear * pose.linear.transpose();
    Eigen::Matrix<double, 6, 1> gap;
    gap << target.translation - pose.translation, (turn(2, 1) - turn(1, 2)) / 2,
        (turn(0, 2) - turn(2, 0)) / 2, (turn(1, 0) - turn(0, 1)) / 2;
    const Eigen::VectorXd change = j.colPivHouseholderQr().solve(gap);
    if (!change.allFinite() || change.cwiseAbs().maxCoeff() > 0.5) return false;
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += change[static_cast<Eigen::Index>(i)];
  }
  for (double& value : q) value = wrapped(value);
  return true;
}

Solutions solve(const ClosedForm& form, const Transform& target, const SolveOptions& options) {
  Solutions found;
  Solver solver(form, target, options, found);
  if (form.family == Family::SphericalWrist) solver.spherical_wrist();
  if (form.family == Family::ParallelAxes) solver.parallel_axes();
  if (form.family == Family::FiveAxes) solver.five_axes();
  const auto good = [&](const Solution& s) {
    return s.position_error <= options.bound * form.reach && s.rotation_error <= options.bound;
  };
  found.keep_if([&](Solution& s) { return good(s) || improve(form, target, options, s); });
  return found;
}

}  // namespace kaboum::kinematics
