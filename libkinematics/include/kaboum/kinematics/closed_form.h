#pragma once

#include <kaboum/kinematics/arm.h>

#include <array>
#include <optional>

namespace kaboum::kinematics {

/// Arms whose inverse kinematics has a closed form; docs/algorithms/inverse-kinematics.md.
enum class Family {
  SphericalWrist,  ///< 6 axes: 2 ∥ 3, 1 ⟂ 2, 3 ⟂ 4 ⟂ 5 ⟂ 6, the last three through one point
  ParallelAxes,  ///< 6 axes: 2 ∥ 3 ∥ 4, 1 ⟂ 2, 4 ⟂ 5 ⟂ 6, the last two through one point
  FiveAxes,      ///< 5 axes: 2 ∥ 3 ∥ 4, 1 ⟂ 2, 4 ⟂ 5
};

/// Singular configurations: solutions coincide there, or are not isolated ones; `Solution::free`
/// tells which.
enum Singular : unsigned {
  kRegular = 0,
  kShoulder = 1,  ///< the wrist is on the first axis, or at the border of what it can reach
  kElbow = 2,     ///< the arm is stretched, or folded onto itself
  kWrist = 4,     ///< axes are aligned
};

using Joints = std::array<double, 6>;  ///< the last is 0 where there are five axes [rad]

struct Solution {
  Joints q{};                    ///< each in (−π, π]
  double position_error = 0;     ///< at most this far from the target [length]
  double rotation_error = 0;     ///< at most, as in PoseError
  unsigned singular = kRegular;  ///< of Singular
  /// Joints, as bits 1 << i, that may have any value, and have that of the reference here: others
  /// of the family are other solutions (solution_set.h).
  unsigned free = 0;
  /// Joints that are not free are known to this, the target's rounding included. [rad]
  double accuracy = 0;
};

/// At most eight solutions; no memory is allocated.
class Solutions {
 public:
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] const Solution& operator[](std::size_t i) const { return items_[i]; }
  [[nodiscard]] const Solution* begin() const { return items_.data(); }
  [[nodiscard]] const Solution* end() const { return items_.data() + size_; }
  Solution& add() { return items_[size_++]; }
  template <class Good>
  void keep_if(const Good& good) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i)
      if (good(items_[i])) {
        if (kept != i) items_[kept] = items_[i];
        ++kept;
      }
    size_ = kept;
  }

  /// Somewhere a joint is nearly free: what rounding has done to the target decides what is found.
  bool nearly_singular = false;
  /// Some were left out: SolveOptions::leave_outside.
  bool left_outside = false;

 private:
  std::array<Solution, 8> items_;
  std::size_t size_ = 0;
};

/// An arm in the form that the formulas take: its axes in the positions of distal
/// Denavit–Hartenberg frames. α is (−π/2, 0, −π/2, π/2, π/2) for a spherical wrist and (π/2, 0, 0,
/// π/2, −π/2) otherwise, d₁ and the last d being part of `base` and `tool`.
struct ClosedForm {
  Family family = Family::SphericalWrist;
  double a1 = 0;                 ///< from axis 1 to axis 2 [length]
  double a2 = 0;                 ///< from axis 2 to axis 3, above 0
  double a3 = 0;                 ///< from axis 3 to axis 4; above 0 unless the wrist is spherical
  double a4 = 0;                 ///< from axis 4 to axis 5; 0 when the wrist is spherical
  double lateral = 0;            ///< along axis 2, from axis 1 to the wrist
  double d4 = 0;                 ///< spherical wrist: along axis 4
  double d5 = 0;                 ///< three parallel axes: along axis 5
  double forearm = 0, bend = 0;  ///< spherical wrist: of (a3, d4), length and angle
  Transform base_inverse, tool_inverse;  ///< to the first frame; from the tool to the last frame
  Joints sign{}, offset{};               ///< angle in the formulas = sign · q + offset
  double lever = 0;                      ///< from the last frame to the tool [length]
  double reach = 0;                      ///< of the arm [length]
  /// At no configuration is the model's tool farther from the arm's, nor turned by more.
  PoseError model_error;
  Arm arm;  ///< what it was made of
};

/// The closed form of an arm, found from its axes: nothing when it is of no such family, or when
/// the model differs from the arm by more than `bound` (a part of the arm's reach) somewhere.
/// Joints that move along, or follow their variable at another rate than 1, are of no family.
std::optional<ClosedForm> recognise(const Arm& arm, double bound = 1e-3);

struct SolveOptions {
  Joints reference{};  ///< what free joints keep [rad]
  /// Solutions are dropped when they are farther off. The position's is times the arm's reach.
  double bound = 1e-9;
  /// Configurations that no whole turns bring within the joints' limits are left out as soon as
  /// that is known, which is faster. Where the model is not the arm but near it, none is.
  bool leave_outside = false;
};

/// All configurations that reach a pose, limits and whole turns apart: up to 8 with six axes, up to
/// 4 with five. Each is checked by forward kinematics. Where the model is not the arm but near it
/// (within 1e-3 of its reach), solutions are improved by Newton's method on the arm itself.
/// @param target  of the tool in the base's frame; a rotation up to rounding.
Solutions solve(const ClosedForm& form, const Transform& target, const SolveOptions& options = {});

/// Five axes reach poses only whose last axis lies in a plane through axis 1, or beside it. The
/// poses of that kind that differ from a target by a turn about axis 1's direction through the
/// tool's origin: its position, pitch and roll (App. A.3 of [gaschler2016]), its heading apart. At
/// most four, each reached if joints 2 to 4 reach far enough; the target itself where its last axis
/// is along axis 1, or its origin on it. Empty for other families.
std::vector<Transform> with_other_headings(const ClosedForm& form, const Transform& target);

/// True if a target's heading is free, too, or nearly: its last axis is along axis 1, or its origin
/// on it. `with_other_headings` gives the target alone there.
bool has_any_heading(const ClosedForm& form, const Transform& target);

const char* name_of(Family family);

}  // namespace kaboum::kinematics
