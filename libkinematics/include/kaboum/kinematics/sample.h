#pragma once

#include <kaboum/kinematics/constraint.h>

#include <memory>
#include <optional>

namespace kaboum::kinematics {

/// A robot whose configuration is sought.
struct PlacedArm {
  Arm arm;
  Transform base;                    ///< of its base in the world
  std::vector<ArmFrame> links = {};  ///< that features are fixed to, besides the tool
};

/// An object whose pose is sought; its position is drawn from a box before it is projected.
struct FreeObject {
  Vec3 lower = Vec3::Constant(-1), upper = Vec3::Constant(1);  ///< in the world [length]
};

/// Constraints between features of the world, of robots' tools and links, and of objects; all hold
/// at once.
struct ConstraintProblem {
  std::vector<PlacedArm> robots;
  std::vector<FreeObject> objects;
  std::vector<Constraint> constraints;
};

/// Configurations of the robots and poses of the objects, in the problem's order.
struct Placement {
  std::vector<std::vector<double>> joints;
  std::vector<Transform> objects;
};

/// The costs of all constraints, one below the other, and their derivative by all joints and then
/// by the twists of all objects (velocity of the origin, angular velocity).
struct Costs {
  using Derivative = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::VectorXd value;
  Derivative derivative;

  /// The largest magnitude; 0 without costs; NaN when one of them is.
  [[nodiscard]] double largest() const;
};
/// @param length  as in `cost`.
/// @throws Error{InvalidArgument} as require_valid.
Costs evaluate(const ConstraintProblem& problem, const Placement& at, double length);

/// Throws where a constraint is not valid or names what the problem does not have.
/// @throws Error{InvalidArgument}
void require_valid(const ConstraintProblem& problem);

struct SampleOptions {
  std::uint64_t seed = 1;
  int draws = 100;      ///< at most so many random starts for a sample
  int iterations = 60;  ///< of the projection, from one of them
  double bound = 1e-9;  ///< no cost of a sample is larger [rad, or in parts of `length`]
  double length = 0;    ///< as in `cost`; 0: the largest reach of the robots, or 1
  bool limits = true;   ///< whether joints are to be within their limits
  /// True: the tool's pose of a robot with a closed form is projected, and the joints are solved
  /// for. False: joints are projected, as the thesis does. So are those of robots with features
  /// between base and tool, which the tool's pose does not place.
  bool closed_form = true;
  /// A pose without joints is moved at most so often by what the constraints leave free, until it
  /// has some; 0: the draw has failed then.
  int motions = 64;
};

struct Sample {
  Placement at;
  double error = 0;  ///< the largest cost, by forward kinematics
  int draws = 0;     ///< that it took
};

/// Draws random samples that meet constraints: Alg. 3 of [gaschler2016] with damping, limits and
/// retries, and with closed-form inverse kinematics where there is one. Every sample is checked by
/// forward kinematics. The same problem and options give the same samples, to the bit.
class ConstraintSampler {
 public:
  /// @throws Error{InvalidArgument} as require_valid(ConstraintProblem).
  explicit ConstraintSampler(ConstraintProblem problem, const SampleOptions& options = {});
  ~ConstraintSampler();
  ConstraintSampler(ConstraintSampler&&) noexcept;
  ConstraintSampler& operator=(ConstraintSampler&&) noexcept;

  /// The next sample; nullopt when no draw led to one, which does not say that there is none.
  std::optional<Sample> next();

  /// Outcomes of all draws so far.
  struct Tally {
    std::size_t draws = 0;
    std::size_t projected =
        0;                    ///< met the constraints, at least with tools where joints are unknown
    std::size_t reached = 0;  ///< and with joints, whatever the limits
    std::size_t samples = 0;  ///< and within the limits
    std::size_t solved = 0;   ///< poses that closed forms were asked for
  };
  [[nodiscard]] const Tally& tally() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kaboum::kinematics
