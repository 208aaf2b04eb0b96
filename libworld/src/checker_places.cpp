// Where the things of a world are in a state.

#include <kaboum/base/error.h>

#include <algorithm>
#include <cmath>

#include "link_poses.h"
#include "placement.h"
#include "state_places.h"

namespace kaboum::world {

Scratch::Scratch() : impl_(std::make_unique<Impl>()) {}
Scratch::~Scratch() = default;
Scratch::Scratch(Scratch&&) noexcept = default;
Scratch& Scratch::operator=(Scratch&&) noexcept = default;

namespace {

/// Values beyond that are refused: rounding of doubles would not be small against any robot.
constexpr double kLargest = 1e9;
/// Of the matrices of links that may be looked at as balls and boxes first.
constexpr double kSmallDefect = 1e-9;

void require_joint_values(const World& world, const WorldState& state) {
  bool fits = state.q.size() == world.robots.size() && state.poses.size() == world.objects.size() &&
              state.attachments.size() == world.objects.size() &&
              (state.absent.empty() || state.absent.size() == world.objects.size()) &&
              (state.absent_robots.empty() || state.absent_robots.size() == world.robots.size());
  for (std::size_t r = 0; fits && r < world.robots.size(); ++r)
    fits = state.q[r].size() == world.robots[r].kinematics.variables.size();
  if (!fits) throw Error(ErrorCode::InvalidArgument, "a state of another world");
  for (const auto& q : state.q)
    for (const double value : q)
      if (!(std::abs(value) <= kLargest))
        throw Error(ErrorCode::InvalidArgument, "a joint value that is not from -1e9 to 1e9");
}

void require_place(const World& world, const WorldState& state, std::size_t o) {
  const auto& a = state.attachments[o];
  // NaN is not compared: the largest of several coefficients may pass it over.
  const geom::Vec3& at = state.poses[o].translation;
  if (!a && !(at.allFinite() && at.cwiseAbs().maxCoeff() <= kLargest))
    throw Error(ErrorCode::InvalidArgument, "a position that is not from -1e9 to 1e9");
  if (a && (a->robot >= world.robots.size() ||
            a->link >= world.robots[a->robot].kinematics.links.size()))
    throw Error(ErrorCode::InvalidArgument, "an attachment to a link that does not exist");
}

bool are_same(const Transform& a, const Transform& b) {
  return a.linear == b.linear && a.translation == b.translation;
}

}  // namespace

void detail::require_fits(const World& world, const WorldState& state) {
  require_joint_values(world, state);
  for (std::size_t o = 0; o < world.objects.size(); ++o) require_place(world, state, o);
}

double detail::defect_of(const RobotModel& robot, const LinkPoses& kinematics) {
  const Eigen::Matrix3d& l = robot.base.linear;
  if (!(l.determinant() > 0)) return HUGE_VAL;
  return kinematics.defect() + 2 * (l.transpose() * l - Eigen::Matrix3d::Identity()).norm();
}

void Checker::place(const WorldState& state, Scratch& scratch) const {
  require_joint_values(*world_, state);
  Scratch::Impl& s = *scratch.impl_;
  if (s.checker != identity_) start(s);
  std::size_t next = 0;
  for (std::size_t r = 0; r < world_->robots.size(); ++r) next = place_robot(state, r, next, s);
  for (std::size_t o = 0; o < world_->objects.size(); ++o) {
    if (!state.absent.empty() && state.absent[o]) continue;
    const bool rests = !state.attachments[o];
    if (rests && s.resting[o] && are_same(*s.resting[o], state.poses[o])) continue;
    s.resting[o].reset();  // also if placing throws
    require_place(*world_, state, o);
    place_object(state, o, next + o, s);
    if (rests) s.resting[o] = state.poses[o];
  }
}

void Checker::start(Scratch::Impl& s) const {
  s = {};
  const std::size_t n = items_.size();
  for (const Item& item : items_) s.sets.emplace_back(world_->outer(item));
  s.placed.assign(n, 0);
  s.poses.resize(n);
  s.errors.assign(n, 0);
  s.balls = detail::Balls(n);
  s.half_margin = 0.5 * largest_margin_;
  for (const collide::PosedSet& set : s.sets) {
    const collide::BoundingSet::Ball& ball = set.set().ball();
    s.hulls.push_back({ball.center, ball.radius * (1 + 1e-8) + 1e-12 * ball.center.lpNorm<1>()});
  }
  s.links.resize(world_->robots.size());
  s.held.assign(world_->objects.size(), std::nullopt);
  s.resting.assign(world_->objects.size(), std::nullopt);
  s.checker = identity_;
}

std::size_t Checker::place_robot(const WorldState& state, std::size_t r, std::size_t next,
                                 Scratch::Impl& s) const {
  const RobotModel& robot = world_->robots[r];
  const std::vector<double>& q = state.q[r];
  kinematics_[r]->compute(q, s.links[r]);
  if (!state.absent_robots.empty() && state.absent_robots[r]) return next + robot.shapes.size();
  const bool usual = is_usual(r, q);
  for (std::size_t i = 0; i < robot.shapes.size(); ++i, ++next) {
    const std::uint32_t link = robot.shapes[i].link;
    double error = error_[r][i];
    if (!usual)
      error = detail::placement_error(
          sweep::MotionBounds(sweep::LinkMotion(robot.kinematics, link, q, q), reaches_[r][i]),
          robot.base);
    kinematics_[r]->place(link, s.links[r], s.poses[next]);
    s.put(next, error);
    if (!(defects_[r] <= kSmallDefect)) s.set(next);  // throws, or its ball is no matter
  }
  return next;
}

void Checker::place_object(const WorldState& state, std::size_t o, std::size_t item,
                           Scratch::Impl& s) const {
  const auto& attachment = state.attachments[o];
  if (!attachment) {
    const Transform& pose = state.poses[o];
    s.poses[item] = pose;
    s.put(item, detail::rotation_error(pose, radius_[item]));
    s.set(item);
    return;
  }
  const double error = error_of_held(state, o, item, s);
  Transform link;
  kinematics_[attachment->robot]->place(attachment->link, s.links[attachment->robot], link);
  s.poses[item] = link * attachment->pose;
  s.put(item, error);
  s.set(item);
}

double Checker::error_of_held(const WorldState& state, std::size_t o, std::size_t item,
                              Scratch::Impl& s) const {
  const Attachment& attachment = *state.attachments[o];
  const RobotModel& robot = world_->robots[attachment.robot];
  const std::vector<double>& q = state.q[attachment.robot];
  auto& held = s.held[o];
  const bool usual = is_usual(attachment.robot, q);
  const auto is_as_before = [&] {
    return held && held->robot == attachment.robot && held->link == attachment.link &&
           held->pose.linear == attachment.pose.linear &&
           held->pose.translation == attachment.pose.translation;
  };
  if (usual && is_as_before()) return held->error;
  std::vector<Vec3> points;
  for (const Vec3& p : hulls_.at(items_[item])) points.emplace_back(attachment.pose * p);
  const sweep::LinkMotion motion =
      usual ? sweep::LinkMotion(robot.kinematics, attachment.link, low_[attachment.robot],
                                high_[attachment.robot])
            : sweep::LinkMotion(robot.kinematics, attachment.link, q, q);
  const double error = detail::placement_error(sweep::MotionBounds(motion, points), robot.base) +
                       detail::attachment_error(attachment.pose, radius_[item]);
  if (usual) held = {attachment.robot, attachment.link, attachment.pose, error};
  return error;
}

bool Checker::is_usual(std::size_t robot, const std::vector<double>& q) const {
  for (std::size_t i = 0; i < q.size(); ++i)
    if (!(q[i] >= low_[robot][i] && q[i] <= high_[robot][i])) return false;
  return true;
}

std::vector<Checker::PosedItem> Checker::places(const WorldState& state,
                                                const std::vector<Item>& items,
                                                Scratch& scratch) const {
  place(state, scratch);
  std::vector<PosedItem> out;
  for (const Item& item : items) {
    const auto i = static_cast<std::size_t>(std::ranges::find(items_, item) - items_.begin());
    out.push_back({item, scratch.impl_->set(i)});
  }
  return out;
}

}  // namespace kaboum::world
