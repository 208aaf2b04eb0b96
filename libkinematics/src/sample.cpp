// Samples of configurations and poses that meet constraints: random starts, projected by damped
// least squares, on the joints or, where the inverse kinematics has a closed form, on poses.
// Source: [gaschler2016] Alg. 3; docs/algorithms/constraint-sampling.md.
#include <kaboum/base/error.h>
#include <kaboum/kinematics/closed_form.h>
#include <kaboum/kinematics/copies.h>
#include <kaboum/kinematics/sample.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "frames.h"
#include "free_motions.h"
#include "joint_limits.h"

namespace kaboum::kinematics {
namespace {

using Kind = FrameId::Kind;

/// A pose after the twist: turned about its own origin, and moved.
Transform moved(const Transform& pose, const Eigen::Ref<const Eigen::VectorXd>& twist) {
  const Vec3 turn = twist.tail<3>();
  const double angle = turn.norm();
  Transform out{pose.linear, pose.translation + twist.head<3>()};
  if (angle > 0) out.linear = robot::rotation_about(turn / angle, angle) * pose.linear;
  return out;
}

Mat3 random_rotation(Random& random) {
  // A uniform unit quaternion (Shoemake).
  const double u = random.between(0, 1), a = random.between(0, 2 * std::numbers::pi),
               b = random.between(0, 2 * std::numbers::pi);
  return Eigen::Quaterniond(std::sqrt(u) * std::cos(b), std::sqrt(1 - u) * std::sin(a),
                            std::sqrt(1 - u) * std::cos(a), std::sqrt(u) * std::sin(b))
      .toRotationMatrix();
}

/// @throws Error{InvalidArgument} when the problem has no such frame.
void require_frame(const ConstraintProblem& problem, const FrameId& id) {
  const auto require = [](bool there, const char* what, std::size_t index) {
    if (!there)
      throw Error(ErrorCode::InvalidArgument, std::string("constraint: there is no ") + what +
                                                  " number " + std::to_string(index));
  };
  if (id.kind == Kind::Object) require(id.index < problem.objects.size(), "object", id.index);
  if (id.kind != Kind::Tool && id.kind != Kind::Link) return;
  require(id.index < problem.robots.size(), "robot", id.index);
  if (id.kind == Kind::Link)
    require(id.link < problem.robots[id.index].links.size(), "link of that robot", id.link);
}

}  // namespace

void require_valid(const ConstraintProblem& problem) {
  for (const PlacedArm& robot : problem.robots)
    for (const ArmFrame& link : robot.links)
      if (link.axes > robot.arm.axes.size())
        throw Error(ErrorCode::InvalidArgument, "constraints: a link has more axes than its arm");
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    const Constraint& c = problem.constraints[i];
    try {
      require_valid(c);
      require_frame(problem, c.first.frame);
      require_frame(problem, c.second.frame);
    } catch (const Error& error) {
      throw Error(error.code(), std::string(error.what()) + " (constraint " + std::to_string(i) +
                                    ", counted from 0)");
    }
  }
}

Costs evaluate(const ConstraintProblem& problem, const Placement& at, double length) {
  require_valid(problem);
  Frames frames;
  for (std::size_t i = 0; i < problem.robots.size(); ++i) {
    frames.add_robot(problem.robots[i], false);
    frames.place(problem.robots[i], i, at.joints[i]);
  }
  for (std::size_t i = 0; i < at.objects.size(); ++i) {
    frames.add_object();
    frames.objects[i].pose = at.objects[i];
  }
  Costs out;
  assemble(problem.constraints, frames, length, out);
  return out;
}

double Costs::largest() const {
  double most = 0;
  for (const double v : value) most = larger(most, std::abs(v));
  return most;
}

namespace {

/// Solves A x = b for A symmetric and positive definite: L D Lᵀ in place of A, x in place of b.
/// False: rounding has made A indefinite.
bool solve_in_place(Eigen::MatrixXd& a, Eigen::VectorXd& b) {
  const Eigen::Index n = b.size();
  for (Eigen::Index k = 0; k < n; ++k) {
    if (!(a(k, k) > 0)) return false;
    for (Eigen::Index i = k + 1; i < n; ++i) {
      const double factor = a(i, k) / a(k, k);
      for (Eigen::Index j = i; j < n; ++j) a(j, i) -= factor * a(j, k);
      b[i] -= factor * b[k];
    }
  }
  for (Eigen::Index k = n; k-- > 0;) {
    double sum = b[k];
    for (Eigen::Index i = k + 1; i < n; ++i) sum -= a(i, k) * b[i];
    b[k] = sum / a(k, k);
  }
  return true;
}

/// Placements at which motions are tried, and starts for them at most.
constexpr int kProbes = 3, kProbeStarts = 12;

/// The ball of an arm that stands in the world.
ReachBall ball_of(const PlacedArm& robot, const ClosedForm& form) {
  ReachBall ball = reach_ball(form);
  ball.centre = robot.base * ball.centre;
  return ball;
}

}  // namespace

class ConstraintSampler::Impl {
 public:
  Impl(ConstraintProblem problem, const SampleOptions& options)
      : problem_(std::move(problem)), options_(options), random_(options.seed) {
    require_valid(problem_);
    constraints_ = without_end_links(problem_);
    length_ = options.length;
    for (const PlacedArm& robot : problem_.robots) {
      if (!(options.length > 0)) length_ = std::max(length_, reach(robot.arm));
      forms_.push_back(options.closed_form ? recognise(robot.arm) : std::nullopt);
      // Five axes reach some poses only: those that the projection of poses gives are none.
      if (forms_.back() && forms_.back()->family == Family::FiveAxes) forms_.back().reset();
    }
    // Nor does a tool's pose place the links before it.
    for (const Constraint& c : constraints_)
      for (const FrameId& id : {c.first.frame, c.second.frame})
        if (id.kind == Kind::Link) forms_[id.index].reset();
    if (!(length_ > 0)) length_ = 1;
    find_aims();
    for (std::size_t i = 0; i < problem_.robots.size(); ++i) {
      frames_.add_robot(problem_.robots[i], forms_[i].has_value());
      check_.add_robot(problem_.robots[i], false);
    }
    for (std::size_t i = 0; i < problem_.objects.size(); ++i) {
      frames_.add_object();
      check_.add_object();
    }
    joints_.resize(problem_.robots.size());
    frames_before_ = frames_;
    joints_before_ = joints_;
    find_motions();
  }

  std::optional<Sample> next() {
    for (int draw = 1; draw <= options_.draws; ++draw) {
      ++tally_.draws;
      start();
      if (!project()) continue;
      ++tally_.projected;
      Sample sample;
      sample.draws = draw;
      if (!finish(sample)) continue;
      ++tally_.samples;
      return sample;
    }
    return std::nullopt;
  }

  Tally tally_;

 private:
  [[nodiscard]] Transform pose_of(const FrameId& id) const {
    const Frame* frame = frames_.find(id);
    return frame != nullptr ? frame->pose : Transform();
  }

  /// Which motions of tools the constraints leave free.
  void find_motions() {
    motions_.resize(forms_.size());
    if (options_.motions == 0) return;
    for (std::size_t i = 0; i < forms_.size(); ++i)
      if (forms_[i]) {
        motions_[i] = FreeMotions(constraints_, {Kind::Tool, i}, length_);
        balls_.push_back(ball_of(problem_.robots[i], *forms_[i]));
      } else {
        balls_.emplace_back();
      }
    const Random unused = random_;  // samples do not depend on what is drawn here
    int probes = 0;
    const auto pose = [&](const FrameId& id) { return pose_of(id); };
    for (int k = 0; k < kProbeStarts && probes < kProbes; ++k) {
      start();
      if (!project()) continue;
      ++probes;
      for (FreeMotions& motions : motions_) motions.keep_free(pose, options_.bound, random_);
    }
    for (FreeMotions& motions : motions_) {
      if (probes < kProbes) motions = {};
      motions.keep_independent(pose);
    }
    random_ = unused;
  }

  /// The first of the surfaces on which a frame has a point: there every other draw aims at a point
  /// of the surface, evenly spread. Other draws, and points on its other surfaces, are projected:
  /// other constraints may leave room for that only.
  void find_aims() {
    std::vector<std::array<FrameId, 2>> known;
    for (std::size_t i = 0; i < constraints_.size(); ++i) {
      Constraint& c = constraints_[i];
      if (c.relation != Relation::Coincident && c.relation != Relation::Distance) continue;
      const bool first = std::holds_alternative<Surface>(c.first.feature);
      if (!first && !std::holds_alternative<Surface>(c.second.feature)) continue;
      const std::array<FrameId, 2> frames{c.first.frame, c.second.frame},
          other{c.second.frame, c.first.frame};
      if (std::ranges::find(known, frames) != known.end() ||
          std::ranges::find(known, other) != known.end())
        continue;
      known.push_back(frames);
      Feature& feature = (first ? c.first : c.second).feature;
      Surface surface = shifted(std::get<Surface>(feature), c.value);
      feature = surface;
      c.relation = Relation::Coincident;
      c.value = 0;
      aims_.push_back({i, first, std::move(surface)});
    }
  }

  /// Random joints, and the poses that they give; random poses of objects; random points of
  /// surfaces.
  void start() {
    for (const Aim& aim : aims_) {
      Constraint& c = constraints_[aim.constraint];
      const double u = random_.between(0, 1), v = random_.between(0, 1);
      Feature& feature = (aim.first ? c.first : c.second).feature;
      feature = aim.surface;
      if (tally_.draws % 2 != 0) feature = Point{point_at(aim.surface, u, v)};
    }
    for (std::size_t i = 0; i < problem_.robots.size(); ++i) {
      const PlacedArm& robot = problem_.robots[i];
      std::vector<double>& q = joints_[i];
      q.clear();
      for (const Axis& axis : robot.arm.axes) q.push_back(random_value(axis, length_, random_));
      if (forms_[i])
        frames_.tools[i].pose = robot.base * forward(robot.arm, q);
      else
        frames_.place(robot, i, q);
    }
    for (std::size_t i = 0; i < problem_.objects.size(); ++i) {
      const FreeObject& object = problem_.objects[i];
      Transform& pose = frames_.objects[i].pose;
      for (int k = 0; k < 3; ++k)
        pose.translation[k] = random_.between(object.lower[k], object.upper[k]);
      pose.linear = random_rotation(random_);
    }
  }

  /// All unknowns after a step; what they were is kept.
  void step(const Eigen::VectorXd& change) {
    std::swap(frames_, frames_before_);
    std::swap(joints_, joints_before_);
    std::swap(costs_, costs_before_);
    for (std::size_t i = 0; i < problem_.robots.size(); ++i) {
      Frame& frame = frames_.tools[i];
      const auto part = change.segment(frame.first, frame.count);
      joints_[i] = joints_before_[i];
      if (frame.rigid) {
        frame.pose = moved(frames_before_.tools[i].pose, part);
        continue;
      }
      const Arm& arm = problem_.robots[i].arm;
      for (std::size_t k = 0; k < joints_[i].size(); ++k) {
        double& q = joints_[i][k];
        q += part[static_cast<Eigen::Index>(k)];
        if (options_.limits) q = into_limits(arm.axes[k], q);
      }
      frames_.place(problem_.robots[i], i, joints_[i]);
    }
    for (std::size_t i = 0; i < frames_.objects.size(); ++i) {
      Frame& frame = frames_.objects[i];
      frame.pose = moved(frames_before_.objects[i].pose, change.segment(frame.first, frame.count));
    }
    assemble(constraints_, frames_, length_, costs_);
  }
  void take_back_step() {
    std::swap(frames_, frames_before_);
    std::swap(joints_, joints_before_);
    std::swap(costs_, costs_before_);
  }

  /// Joints on a limit that a step would take past it do not take part in it.
  void freeze(Costs& costs) const {
    if (!options_.limits) return;
    for (std::size_t i = 0; i < problem_.robots.size(); ++i) {
      const Frame& frame = frames_.tools[i];
      if (frame.rigid) continue;
      for (std::size_t k = 0; k < joints_[i].size(); ++k) {
        const Axis& axis = problem_.robots[i].arm.axes[k];
        auto column = costs.derivative.col(frame.first + static_cast<Eigen::Index>(k));
        const double uphill = column.dot(costs.value);
        if ((joints_[i][k] <= axis.lower && uphill > 0) ||
            (joints_[i][k] >= axis.upper && uphill < 0))
          column.setZero();
      }
    }
  }

  /// The least change of the unknowns that leads to the costs' zero, to first order and damped:
  /// −Jᵀ(JJᵀ + λ)⁻¹ f. False where rounding leaves none.
  bool find_change(double damping) {
    const Costs::Derivative& j = costs_.derivative;
    normal_.resize(j.rows(), j.rows());
    for (Eigen::Index a = 0; a < j.rows(); ++a) {
      for (Eigen::Index b = 0; b <= a; ++b) normal_(a, b) = j.row(a).dot(j.row(b));
      normal_(a, a) += damping;
    }
    multipliers_ = costs_.value;
    if (!solve_in_place(normal_, multipliers_)) return false;
    change_.setZero(j.cols());
    for (Eigen::Index a = 0; a < j.rows(); ++a) change_ -= multipliers_[a] * j.row(a).transpose();
    return true;
  }

  /// Levenberg–Marquardt.
  bool project() {
    assemble(constraints_, frames_, length_, costs_);
    if (costs_.value.size() == 0) return true;
    double damping = 1e-6;
    for (int i = 0; i < options_.iterations; ++i) {
      if (costs_.largest() <= options_.bound / 100) break;
      freeze(costs_);
      if (!find_change(damping)) {
        damping *= 32;
        continue;
      }
      const double longest = change_.cwiseAbs().maxCoeff();
      if (!std::isfinite(longest)) return false;
      if (longest > 1) change_ /= longest;  // a radian, or a unit of length, at a time
      step(change_);
      if (costs_.value.norm() < costs_before_.value.norm()) {
        damping = std::max(damping / 8, 1e-14);
        continue;
      }
      if (damping > 1e3 || longest < 1e-13) return false;  // a local minimum
      damping *= 32;
      take_back_step();
    }
    return costs_.largest() <= options_.bound / 10;
  }

  /// Joints for the tools that are where they should be, and the check of all.
  bool finish(Sample& sample) {
    Solvability worst = Solvability::Within;
    for (std::size_t i = 0; i < problem_.robots.size(); ++i) {
      const PlacedArm& robot = problem_.robots[i];
      if (forms_[i])
        worst = std::min(worst, choose_moving(i));
      else if (options_.limits && !within_limits(robot.arm, joints_[i]))
        worst = std::min(worst, Solvability::Outside);
      if (worst == Solvability::None) return false;
    }
    ++tally_.reached;
    if (worst != Solvability::Within) return false;
    sample.at.joints = joints_;
    for (const Frame& frame : frames_.objects) sample.at.objects.push_back(frame.pose);
    sample.error = error_of(sample.at);
    return sample.error <= options_.bound;
  }

  enum class Solvability { None, Outside, Within };  ///< joints: none, none within the limits, some

  /// Joints for the tool's pose, else for poses to which the constraints let it move.
  Solvability choose_moving(std::size_t i) {
    Transform& pose = frames_.tools[i].pose;
    const auto place = [&](const FrameId& id) { return pose_of(id); };
    Solvability best = choose(i);
    const int motions = motions_[i].empty() ? 0 : options_.motions;
    for (int k = 0; k < motions && best != Solvability::Within; ++k) {
      pose = motions_[i].moved(pose, place, balls_[i], random_);
      best = std::max(best, choose(i));
    }
    return best;
  }

  /// One of the solutions within the limits, each as likely as any other.
  Solvability choose(std::size_t i) {
    ++tally_.solved;
    const ClosedForm& form = *forms_[i];
    std::vector<double>& q = joints_[i];
    SolveOptions options;
    for (std::size_t k = 0; k < q.size(); ++k) options.reference[k] = q[k];  // random values
    options.leave_outside = options_.limits;
    const Solutions found =
        solve(form, inverse(problem_.robots[i].base) * frames_.tools[i].pose, options);
    if (found.empty()) return found.left_outside ? Solvability::Outside : Solvability::None;
    const std::size_t first = random_.index(found.size());
    Joints near;
    for (std::size_t n = 0; n < found.size(); ++n) {
      const Solution& s = found[(first + n) % found.size()];
      if (!options_.limits)
        return q.assign(s.q.begin(), s.q.begin() + q.size()), Solvability::Within;
      // Of whole turns, those near the random start.
      if (find_nearest_copy(form.arm, {s.q.data(), q.size()}, q, near)) {
        q.assign(near.begin(), near.begin() + q.size());
        return Solvability::Within;
      }
    }
    return Solvability::Outside;
  }

  /// The largest cost, computed anew by forward kinematics.
  double error_of(const Placement& at) {
    for (std::size_t i = 0; i < at.joints.size(); ++i)
      check_.place_poses(problem_.robots[i], i, at.joints[i]);
    for (std::size_t i = 0; i < at.objects.size(); ++i) check_.objects[i].pose = at.objects[i];
    return largest_cost(problem_.constraints, check_, length_);
  }

  ConstraintProblem problem_;
  /// A point of a surface that each draw aims at, as a constraint of two points.
  struct Aim {
    std::size_t constraint = 0;
    bool first = false;  ///< whether the surface is its first feature
    Surface surface;
  };

  std::vector<Constraint> constraints_;  ///< with as few features of links as may be
  std::vector<Aim> aims_;
  SampleOptions options_;
  Random random_;
  double length_ = 0;
  std::vector<std::optional<ClosedForm>> forms_;
  std::vector<FreeMotions> motions_;  ///< of the robots that have closed forms
  std::vector<ReachBall> balls_;
  Frames frames_;
  Frames check_;  ///< of a sample
  std::vector<std::vector<double>> joints_;
  Costs costs_;
  // Of the step before; and what a step is made of.
  Frames frames_before_;
  std::vector<std::vector<double>> joints_before_;
  Costs costs_before_;
  Eigen::MatrixXd normal_;
  Eigen::VectorXd multipliers_, change_;
};

ConstraintSampler::ConstraintSampler(ConstraintProblem problem, const SampleOptions& options)
    : impl_(std::make_unique<Impl>(std::move(problem), options)) {}
ConstraintSampler::~ConstraintSampler() = default;
ConstraintSampler::ConstraintSampler(ConstraintSampler&&) noexcept = default;
ConstraintSampler& ConstraintSampler::operator=(ConstraintSampler&&) noexcept = default;

std::optional<Sample> ConstraintSampler::next() { return impl_->next(); }
const ConstraintSampler::Tally& ConstraintSampler::tally() const { return impl_->tally_; }

}  // namespace kaboum::kinematics
