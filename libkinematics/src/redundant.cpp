// Inverse kinematics of arms with redundant joints before a closed form: the redundant joints are
// free parameters; docs/algorithms/inverse-kinematics.md, "Redundant joints".
#include <kaboum/base/error.h>
#include <kaboum/base/radical_inverse.h>
#include <kaboum/kinematics/copies.h>
#include <kaboum/kinematics/redundant.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "reach_ball.h"
#include "tolerances.h"

namespace kaboum::kinematics {
namespace {

constexpr std::size_t kClosed = 6;  ///< axes of the closed form
constexpr std::array<unsigned, 6> kBases{2, 3, 5, 7, 11, 13};

/// Values of a joint, both ends included.
struct Range {
  double lower = 0, upper = 0;
  [[nodiscard]] double width() const { return upper - lower; }
};

/// One target of a redundant arm.
class RedundantSearch {
 public:
  RedundantSearch(const RedundantArm& arm, const Transform& target, const RedundantOptions& options)
      : arm_(arm),
        target_(target),
        options_(options),
        ball_(reach_ball(arm.form)),
        wrist_(target * ball_.point),
        reference_(options.reference) {
    if (reference_.empty()) reference_.assign(arm.arm.axes.size(), 0.0);
    if (reference_.size() != arm.arm.axes.size())
      throw Error(ErrorCode::InvalidArgument, "reference: a value for each of the " +
                                                  std::to_string(arm.arm.axes.size()) +
                                                  " joints is expected");
    if (!options.limits)
      for (Axis& axis : carrier_.axes) {
        axis.upper = std::numeric_limits<double>::infinity();
        axis.lower = -axis.upper;
      }
    // The wrist of the arm, not of its model, is held by a ball that is larger by what is between
    // them, and by rounding.
    const PoseError& model = arm.form.model_error;
    ball_.radius += model.position + model.rotation * ball_.point.norm() +
                    kSlack * (arm.form.reach + wrist_.norm() + reach(carrier_));
    set_ranges();
  }

  RedundantSolutions run() {
    RedundantSolutions out;
    if (is_out_of_reach()) {
      out.out_of_reach = true;
      return out;
    }
    std::vector<double> q = reference_;
    std::size_t values = 0;
    for (std::size_t i = 0; i < options_.tries && values < options_.values; ++i)
      if (take_values(i, q) && add(q, out.found)) ++values;
    std::ranges::stable_sort(out.found, {},
                             [&](const RedundantSolution& s) { return distance(s.q); });
    return out;
  }

  /// Configurations with the redundant joints of q. @return whether there are any.
  bool add(const std::vector<double>& q, std::vector<RedundantSolution>& out) const {
    const std::size_t count = arm_.count;
    const Transform base = forward(carrier_, std::span(q).first(count));
    SolveOptions options;
    std::copy(q.begin() + static_cast<long>(count), q.end(), options.reference.begin());
    options.bound = options_.bound;
    options.leave_outside = options_.limits;
    bool any = false;
    for (const Solution& s : solve(arm_.form, inverse(base) * target_, options)) {
      RedundantSolution found;
      found.q = q;
      std::copy(s.q.begin(), s.q.end(), found.q.begin() + static_cast<long>(count));
      if (options_.limits && !nearest_copy(arm_.arm, found.q, reference_)) continue;
      found.error = difference(forward(arm_.arm, found.q), target_);
      if (!(found.error.position <= options_.bound * arm_.form.reach &&
            found.error.rotation <= options_.bound))
        continue;
      found.singular = s.singular;
      out.push_back(std::move(found));
      any = true;
    }
    return any;
  }

 private:
  /// Of the arm's and the target's size, more than the rounding of poses.
  static constexpr double kSlack = 1e-12;
  /// Boxes of the redundant joints' values that a proof may take.
  static constexpr int kMostBoxes = 4000;

  /// How far a joint moves what is after it, at most, by a unit of its value.
  [[nodiscard]] double speed(std::size_t joint) const {
    const Axis& axis = carrier_.axes[joint];
    return axis.turns ? axis.rate * lever_[joint] : axis.rate;
  }

  /// Ranges of the redundant joints' values that are looked at: their limits; a whole turn; the
  /// values with which the wrist may be reached whatever the others are.
  void set_ranges() {
    const std::vector<Axis>& axes = carrier_.axes;
    lever_.assign(arm_.count, 0.0);
    ranges_.resize(arm_.count);
    // From an axis to the ball's centre, at most, as long as joints without limits are at 0.
    double beyond = (ball_.centre - axes.back().point).norm();
    for (std::size_t i = arm_.count; i-- > 0;) {
      lever_[i] = beyond;
      if (i > 0) beyond += (axes[i].point - axes[i - 1].point).norm();
      if (!axes[i].turns && !is_endless(axes[i]))
        beyond += axes[i].rate * std::max(std::abs(axes[i].lower), std::abs(axes[i].upper));
    }
    // The centre is then no farther from the first axis than `beyond`, where it is at 0 as well. A
    // joint without limits that moves it farther than this moves it past the wrist.
    const double far = (wrist_ - ball_.centre).norm() + ball_.radius + 2 * beyond;
    double widest = -1;
    for (std::size_t i = arm_.count; i-- > 0;) {
      ranges_[i] = axes[i].turns ? turns_of(axes[i], reference_[i])
                                 : Range{std::max(axes[i].lower, -far / axes[i].rate),
                                         std::min(axes[i].upper, far / axes[i].rate)};
      if (axes[i].turns) continue;
      if (is_endless(axes[i])) {
        ++endless_;
        for (std::size_t k = 0; k < i; ++k) lever_[k] += far;
      }
      if (ranges_[i].width() * axes[i].rate > widest) {
        widest = ranges_[i].width() * axes[i].rate;
        along_ = i;
      }
    }
    slides_ = widest >= 0;
  }

  static bool is_endless(const Axis& axis) {
    return !(std::isfinite(axis.lower) && std::isfinite(axis.upper));
  }

  /// A joint's limits, or a whole turn of them about a value.
  static Range turns_of(const Axis& axis, double value) {
    const double turn = 2 * kPi / axis.rate;
    if (axis.upper - axis.lower <= turn) return {axis.lower, axis.upper};
    const double lower = std::max(axis.lower, value - turn / 2);
    return lower + turn > axis.upper ? Range{axis.upper - turn, axis.upper}
                                     : Range{lower, lower + turn};
  }

  [[nodiscard]] Vec3 centre(std::span<const double> q) const {
    return forward(carrier_, q.first(arm_.count)) * ball_.centre;
  }

  /// The redundant joints' values number i: the reference's, then those of the sequence.
  /// @return false: the wrist is out of reach with them.
  bool take_values(std::size_t i, std::vector<double>& q) const {
    for (std::size_t k = 0; k < arm_.count; ++k)
      q[k] = i == 0 ? std::clamp(reference_[k], ranges_[k].lower, ranges_[k].upper)
                    : ranges_[k].lower + ranges_[k].width() * radical_inverse(i, kBases[k]);
    if (i > 0 && slides_) {
      const std::optional<Range> within = reaching(q);
      if (!within) return false;
      q[along_] = within->lower + within->width() * radical_inverse(i, kBases[along_]);
      return true;
    }
    return (centre(q) - wrist_).norm() <= ball_.radius;
  }

  /// Values of the joint that moves along with which the wrist is in the ball, the others being
  /// those of q.
  [[nodiscard]] std::optional<Range> reaching(std::vector<double>& q) const {
    const Axis& axis = carrier_.axes[along_];
    q[along_] = 0;
    const Transform before = forward(
        {{carrier_.axes.begin(), carrier_.axes.begin() + static_cast<long>(along_)}, {}, {}},
        std::span(q).first(along_));
    const Chord c = chord(centre(q) - wrist_, before.linear * axis.direction, ball_.radius);
    const Range& all = ranges_[along_];
    const Range out{std::max(all.lower, (c.middle - c.half) / axis.rate),
                    std::min(all.upper, (c.middle + c.half) / axis.rate)};
    if (c.half < 0 || out.width() < 0) return std::nullopt;
    return out;
  }

  /// True if it is proved that no values of the redundant joints bring the ball to the wrist. From
  /// the middle of a box the ball's centre moves by at most the sum of speed times half width.
  [[nodiscard]] bool is_out_of_reach() const {
    if (endless_ > 1) return false;  // their ranges hold what is tried, not all
    for (const Range& range : ranges_)
      if (!(range.width() >= 0)) return true;  // the joint is far from the wrist at its limits
    std::vector<std::vector<Range>> open{ranges_};
    std::vector<double> middle(arm_.count);
    for (int boxes = 0; !open.empty(); ++boxes) {
      if (boxes == kMostBoxes) return false;
      std::vector<Range> box = std::move(open.back());
      open.pop_back();
      double moves = 0, most = -1;
      std::size_t widest = 0;
      for (std::size_t k = 0; k < arm_.count; ++k) {
        middle[k] = (box[k].lower + box[k].upper) / 2;
        const double move = speed(k) * box[k].width() / 2;
        moves += move;
        if (move > most) {
          most = move;
          widest = k;
        }
      }
      const double away = (centre(middle) - wrist_).norm();
      if (away > ball_.radius + moves) continue;
      if (!(away > ball_.radius)) return false;
      open.push_back(box);
      open.back()[widest].lower = box[widest].upper = middle[widest];
      open.push_back(std::move(box));
    }
    return true;
  }

  /// How far the redundant joints move the arm's base from where it is with the reference's, about.
  [[nodiscard]] double distance(const std::vector<double>& q) const {
    double sum = 0;
    for (std::size_t k = 0; k < arm_.count; ++k) sum += speed(k) * std::abs(q[k] - reference_[k]);
    return sum;
  }

  const RedundantArm& arm_;
  const Transform& target_;
  const RedundantOptions& options_;
  Arm carrier_ = arm_.carrier;  ///< with the limits that count
  ReachBall ball_;
  Vec3 wrist_;  ///< of the target
  std::vector<double> reference_;
  std::vector<Range> ranges_;
  std::vector<double> lever_;
  std::size_t along_ = 0;  ///< the joint that moves along farthest
  bool slides_ = false;    ///< there is one
  int endless_ = 0;        ///< joints that move along, without limits
};

}  // namespace

std::optional<RedundantArm> recognise_redundant(const Arm& arm) {
  if (arm.axes.size() <= kClosed || arm.axes.size() > kClosed + kBases.size()) return std::nullopt;
  RedundantArm out;
  out.count = arm.axes.size() - kClosed;
  const auto split = static_cast<std::ptrdiff_t>(out.count);
  const std::optional<ClosedForm> form =
      recognise({{arm.axes.begin() + split, arm.axes.end()}, arm.tool, {}});
  if (!form) return std::nullopt;
  out.form = *form;
  out.arm = arm;
  out.carrier = {{arm.axes.begin(), arm.axes.begin() + split}, {}, {}};
  return out;
}

RedundantSolutions solve_redundant(const RedundantArm& arm, const Transform& target,
                                   const RedundantOptions& options) {
  return RedundantSearch(arm, target, options).run();
}

std::vector<RedundantSolution> solve_with_redundant(const RedundantArm& arm,
                                                    const Transform& target,
                                                    std::span<const double> reference,
                                                    const RedundantOptions& options) {
  RedundantOptions kept = options;
  kept.reference.assign(reference.begin(), reference.end());
  std::vector<RedundantSolution> out;
  RedundantSearch(arm, target, kept).add(kept.reference, out);
  return out;
}

}  // namespace kaboum::kinematics
