#pragma once

#include <kaboum/base/error.h>
#include <kaboum/filter/batch_checker.h>
#include <kaboum/world/motion_check.h>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

/// OMPL's interfaces over this project's answers: its planners then find paths of which every state
/// and every motion is certified. Header only: nothing of this project is built with OMPL; who
/// includes it links OMPL (1.5 or later).
namespace kaboum::filter {

/// A robot of a scene as OMPL asks about it, all else staying where a state has it. Threads may
/// share it.
class OmplRobot {
 public:
  /// Refers to the checker.
  /// @throws as BatchChecker
  OmplRobot(const world::Checker& checker, const world::WorldState& state, std::size_t robot)
      : checker_(checker), state_(state), robot_(robot), batch_(checker, state, robot, {}) {}

  [[nodiscard]] std::size_t variables() const { return batch_.variables(); }

  /// A space with a dimension for each variable of the robot, within its limits; of joints without
  /// limits, a turn either way from 0 (a slide: 1 either way) or from the only limit, which
  /// setBounds may change.
  [[nodiscard]] std::shared_ptr<ompl::base::RealVectorStateSpace> make_space() const {
    const robot::Robot& kinematics = checker_.world().robots[robot_].kinematics;
    const auto& variables = kinematics.variables;
    auto space = std::make_shared<ompl::base::RealVectorStateSpace>(
        static_cast<unsigned int>(variables.size()));
    ompl::base::RealVectorBounds bounds(static_cast<unsigned int>(variables.size()));
    for (unsigned int i = 0; i < variables.size(); ++i) {
      const double most = robot::is_angle(kinematics, variables[i]) ? 2 * std::numbers::pi : 1;
      // Of joints with one limit, as wide from there.
      bounds.setLow(
          i, variables[i].lower.value_or(std::min(-most, variables[i].upper.value_or(0) - most)));
      bounds.setHigh(
          i, variables[i].upper.value_or(std::max(most, variables[i].lower.value_or(0) + most)));
      space->setDimensionName(i, variables[i].name);
    }
    space->setBounds(bounds);
    return space;
  }

  /// True: free for certain, and within the joints' limits.
  [[nodiscard]] bool is_free(const std::vector<double>& q) const {
    if (!checker_.is_within_limits(robot_, q)) return false;
    const Borrowed scratch(*this);
    world::WorldState state = state_;
    state.q[robot_] = q;
    return checker_.is_free(state, *scratch);
  }

  /// True: the straight motion is free at every instant, for certain, and within the limits.
  [[nodiscard]] bool is_free(const std::vector<double>& from, const std::vector<double>& to) const {
    if (!checker_.is_within_limits(robot_, from) || !checker_.is_within_limits(robot_, to))
      return false;
    std::array<std::uint8_t, 1> free{};
    batch_.decide_motions(from, to, free, {});
    return free[0] != 0;
  }

  /// The share of a motion up to which it is free at every instant, and within the limits; 1: all
  /// of it is.
  [[nodiscard]] double free_share(const std::vector<double>& from,
                                  const std::vector<double>& to) const {
    if (is_free(from, to)) return 1;
    if (!checker_.is_within_limits(robot_, from)) return 0;
    const double within = share_within_limits(from, to);
    std::vector<double> end = to;
    if (within < 1)
      for (std::size_t i = 0; i < end.size(); ++i) end[i] = from[i] + within * (to[i] - from[i]);
    const Borrowed scratch(*this);
    world::MotionOptions options;
    options.scratch = &*scratch;
    const world::MotionAnswer answer = check_motion(checker_, state_, robot_, {from, end}, options);
    return answer.outcome == world::MotionAnswer::Outcome::Free ? within : within * answer.share;
  }

 private:
  /// Memory of one thread, given back afterwards.
  class Borrowed {
   public:
    explicit Borrowed(const OmplRobot& of) : of_(of) {
      const std::scoped_lock lock(of_.mutex_);
      if (of_.idle_.empty()) return;
      scratch_ = std::move(of_.idle_.back());
      of_.idle_.pop_back();
    }
    ~Borrowed() {
      const std::scoped_lock lock(of_.mutex_);
      of_.idle_.push_back(std::move(scratch_));
    }
    Borrowed(const Borrowed&) = delete;
    Borrowed& operator=(const Borrowed&) = delete;
    world::Scratch& operator*() const { return *scratch_; }

   private:
    const OmplRobot& of_;
    std::unique_ptr<world::Scratch> scratch_ = std::make_unique<world::Scratch>();
  };

  /// Below 1 where the motion ends beyond a limit: less, by rounding, than where it is reached.
  [[nodiscard]] double share_within_limits(const std::vector<double>& from,
                                           const std::vector<double>& to) const {
    const auto& variables = checker_.world().robots[robot_].kinematics.variables;
    double out = 1;
    for (std::size_t i = 0; i < variables.size(); ++i) {
      const double limit =
          to[i] > from[i] ? variables[i].upper.value_or(to[i]) : variables[i].lower.value_or(to[i]);
      if (to[i] > from[i] ? to[i] > limit : to[i] < limit)
        out = std::min(out, (1 - 1e-12) * (limit - from[i]) / (to[i] - from[i]));
    }
    return out;
  }

  const world::Checker& checker_;
  world::WorldState state_;
  std::size_t robot_;
  BatchChecker batch_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<world::Scratch>> idle_;
};

namespace ompl_detail {
/// @throws Error{InvalidArgument} for spaces whose straight lines are not the robot's
inline void require_space(const ompl::base::SpaceInformation& si, const OmplRobot& robot) {
  const auto* space =
      dynamic_cast<const ompl::base::RealVectorStateSpace*>(si.getStateSpace().get());
  if (space == nullptr || space->getDimension() != robot.variables())
    throw Error(
        ErrorCode::InvalidArgument,
        "a RealVectorStateSpace with a dimension for each variable of the robot is expected "
        "(OmplRobot::make_space)");
}

inline std::vector<double> values_of(const ompl::base::State* state, const OmplRobot& robot) {
  const double* values = state->as<ompl::base::RealVectorStateSpace::StateType>()->values;
  return {values, values + robot.variables()};
}
}  // namespace ompl_detail

/// States are valid if they are free for certain, and within the joints' limits.
class OmplStateValidityChecker final : public ompl::base::StateValidityChecker {
 public:
  /// @throws Error{InvalidArgument} for another space than OmplRobot::make_space makes.
  OmplStateValidityChecker(const ompl::base::SpaceInformationPtr& si,
                           std::shared_ptr<const OmplRobot> robot)
      : StateValidityChecker(si), robot_(std::move(robot)) {
    ompl_detail::require_space(*si, *robot_);
  }
  using StateValidityChecker::isValid;
  [[nodiscard]] bool isValid(const ompl::base::State* state) const override {
    return robot_->is_free(ompl_detail::values_of(state, *robot_));
  }

 private:
  std::shared_ptr<const OmplRobot> robot_;
};

/// Motions are valid if they are free at every instant, for certain: no resolution is looked at.
class OmplMotionValidator final : public ompl::base::MotionValidator {
 public:
  /// @throws as OmplStateValidityChecker
  OmplMotionValidator(const ompl::base::SpaceInformationPtr& si,
                      std::shared_ptr<const OmplRobot> robot)
      : MotionValidator(si), robot_(std::move(robot)) {
    ompl_detail::require_space(*si, *robot_);
  }

  [[nodiscard]] bool checkMotion(const ompl::base::State* from,
                                 const ompl::base::State* to) const override {
    return counted(robot_->is_free(ompl_detail::values_of(from, *robot_),
                                   ompl_detail::values_of(to, *robot_)));
  }

  /// @param last  gets the share of the motion up to which it is free, and the state there
  [[nodiscard]] bool checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                                 std::pair<ompl::base::State*, double>& last) const override {
    const double share = robot_->free_share(ompl_detail::values_of(from, *robot_),
                                            ompl_detail::values_of(to, *robot_));
    if (share < 1) {
      last.second = share;
      if (last.first != nullptr) si_->getStateSpace()->interpolate(from, to, share, last.first);
    }
    return counted(share >= 1);
  }

 private:
  bool counted(bool valid) const {
    const std::scoped_lock lock(mutex_);
    ++(valid ? valid_ : invalid_);
    return valid;
  }

  std::shared_ptr<const OmplRobot> robot_;
  mutable std::mutex mutex_;
};

/// Both for a space: OMPL's planners then find paths that are certified.
/// @throws as OmplStateValidityChecker
inline void use_certified_checks(const ompl::base::SpaceInformationPtr& si,
                                 const std::shared_ptr<const OmplRobot>& robot) {
  si->setStateValidityChecker(std::make_shared<OmplStateValidityChecker>(si, robot));
  si->setMotionValidator(std::make_shared<OmplMotionValidator>(si, robot));
}

}  // namespace kaboum::filter
