// Features by their names: those of a scene, and the parts of frames.

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/world/features.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kaboum::world {
namespace {

using To = FixedFeature::To;

[[noreturn]] void refuse(const std::string& what) { throw Error(ErrorCode::InvalidArgument, what); }

struct FramePart {
  const char* name;
  Feature::Kind kind;
  int axis;  ///< the direction's or normal's; of a point none
};
constexpr std::array<FramePart, 7> kParts{{{"origin", Feature::Kind::Point, 0},
                                           {"x", Feature::Kind::Line, 0},
                                           {"y", Feature::Kind::Line, 1},
                                           {"z", Feature::Kind::Line, 2},
                                           {"xy", Feature::Kind::Plane, 2},
                                           {"yz", Feature::Kind::Plane, 0},
                                           {"zx", Feature::Kind::Plane, 1}}};

/// Looks for a feature, and notes the names that there are.
class Search {
 public:
  Search(const World& world, const std::string& name) : world_(world), name_(name) {}

  FixedFeature run() {
    look_at_named();
    if (found_.size() > 1)
      refuse("the feature '" + name_ + "' is there in two kinds: give them different names");
    if (!found_.empty()) return found_.front();
    const std::size_t dot = name_.rfind('.');
    if (dot != std::string::npos) look_at_frames(name_.substr(0, dot), name_.substr(dot + 1));
    if (!found_.empty()) return found_.front();
    for (const std::string& frame : frames_)
      for (const FramePart& part : kParts) names_.push_back(frame + "." + part.name);
    std::string why = did_you_mean(name_, names_);
    if (why.empty())
      why =
          "; a feature is OBJECT/FEATURE or ROBOT/FEATURE of the scene, or a part of a frame, as "
          "world.z, OBJECT.origin, ROBOT/TOOL.xy";
    refuse("there is no feature '" + name_ + "'" + why);
  }

 private:
  void look_at_named() {
    for (std::size_t o = 0; o < world_.objects.size(); ++o)
      for (const Feature& f : world_.objects[o].features)
        offer(world_.objects[o].name, {To::Object, o, 0, f});
    for (std::size_t r = 0; r < world_.robots.size(); ++r)
      for (const LinkFeature& f : world_.robots[r].features)
        offer(world_.robots[r].name, {To::Link, r, f.link, f.feature});
  }

  void offer(const std::string& owner, FixedFeature feature) {
    names_.push_back(owner + "/" + feature.feature.name);
    if (names_.back() == name_) found_.push_back(std::move(feature));
  }

  void look_at_frames(const std::string& frame, const std::string& part) {
    offer_frame("world", frame, part, {});
    for (std::size_t o = 0; o < world_.objects.size(); ++o)
      offer_frame(world_.objects[o].name, frame, part, {To::Object, o, 0, {}});
    for (std::size_t r = 0; r < world_.robots.size(); ++r) {
      const RobotModel& robot = world_.robots[r];
      offer_frame(robot.name, frame, part, {To::Link, r, 0, {}});
      for (const ToolFrame& tool : robot.tools)
        offer_frame(robot.name + "/" + tool.name, frame, part, {To::Link, r, tool.link, {}},
                    tool.pose);
      for (std::uint32_t l = 0; l < robot.kinematics.links.size(); ++l)
        offer_frame(robot.name + "/" + robot.kinematics.links[l].name, frame, part,
                    {To::Link, r, l, {}});
    }
  }

  void offer_frame(const std::string& own, const std::string& frame, const std::string& part,
                   FixedFeature fixed, const Transform& pose = {}) {
    frames_.push_back(own);
    if (own != frame) return;
    std::optional<Feature> feature = find_frame_part(part);
    if (!feature) return;
    feature->name = name_;
    fixed.feature = moved(*feature, pose);
    found_.push_back(std::move(fixed));
  }

  const World& world_;
  const std::string& name_;
  std::vector<FixedFeature> found_;
  std::vector<std::string> names_, frames_;
};

}  // namespace

double distance_from(const Feature& f, const Vec3& p) {
  switch (f.kind) {
    case Feature::Kind::Point:
      return (p - f.point).norm();
    case Feature::Kind::Line:
      return (p - f.point).cross(f.direction).norm();
    case Feature::Kind::Plane:
      return std::abs((p - f.point).dot(f.direction));
    default:
      return (p - nearest_point(std::get<kinematics::Surface>(kinematics_feature(f)), p)).norm();
  }
}

double radius_of(const Feature& f) {
  double out = f.radius;
  for (const Vec3& corner : f.outline) out = std::max(out, (corner - f.point).norm());
  return out;
}

bool is_met(const ToleratedConstraint& c, const Transform& first, const Transform& second) {
  using Kind = Feature::Kind;
  using kinematics::Relation;
  Feature a = moved(c.first.feature, first), b = moved(c.second.feature, second);
  if (a.kind > b.kind) std::swap(a, b);
  const double apart = distance_from(b, a.point);
  if (c.relation == Relation::Distance) {
    if (b.kind != Kind::Surface) return std::abs(apart - c.value) <= c.within;
    return distance_from(moved(b, {Eigen::Matrix3d::Identity(), c.value * b.direction}), a.point) <=
           c.within;
  }
  if (c.relation == Relation::Coincident && apart > c.within &&
      (a.kind != b.kind || distance_from(a, b.point) > c.within))
    return false;
  if (a.kind == Kind::Point) return true;
  const bool mixed = (a.kind == Kind::Line) != (b.kind == Kind::Line);
  const double angle =
      std::atan2(a.direction.cross(b.direction).norm(), a.direction.dot(b.direction));
  if (c.relation == Relation::Angle)
    return std::abs((mixed ? std::numbers::pi / 2 - angle : angle) - c.value) <= c.within_angle;
  const double skew = std::min(angle, std::numbers::pi - angle);
  const bool aligned = (c.relation != Relation::Perpendicular) != mixed;
  return (aligned ? skew : std::numbers::pi / 2 - skew) <= c.within_angle;
}

std::optional<Feature> find_frame_part(std::string_view part) {
  const auto* const found = std::ranges::find(kParts, part, &FramePart::name);
  if (found == kParts.end()) return std::nullopt;
  Feature out{std::string(part), found->kind};
  if (found->kind != Feature::Kind::Point) out.direction = Vec3::Unit(found->axis);
  return out;
}

std::string describe(const ToleratedConstraint& c) {
  return std::string(name_of(c.relation))
      .append(" '")
      .append(c.first.feature.name)
      .append("' '")
      .append(c.second.feature.name)
      .append("'");
}

FixedFeature find_feature(const World& world, const std::string& name) {
  return Search(world, name).run();
}

Feature moved(const Feature& feature, const Transform& pose) {
  Feature out = feature;
  out.point = pose * feature.point;
  if (feature.kind != Feature::Kind::Point)
    out.direction = (pose.linear * feature.direction).normalized();
  for (Vec3& corner : out.outline) corner = pose * corner;
  return out;
}

FixedFeature at_state(const World& world, const WorldState& state, const FixedFeature& feature) {
  if (feature.to != To::Object) return feature;
  const std::size_t object = feature.index;
  if (object >= world.objects.size() || object >= state.attachments.size())
    refuse("a feature of an object of another world");
  if (const auto& held = state.attachments[object])
    return {To::Link, held->robot, held->link, moved(feature.feature, held->pose)};
  return {To::World, 0, 0, moved(feature.feature, state.poses[object])};
}

bool is_usual_constraint(std::string_view name) {
  return std::ranges::find(kUsualConstraints, name) != kUsualConstraints.end();
}

kinematics::Feature kinematics_feature(const Feature& f) {
  if (f.kind == Feature::Kind::Point) return kinematics::Point{f.point};
  if (f.kind == Feature::Kind::Line) return kinematics::Line{f.point, f.direction};
  if (f.kind == Feature::Kind::Plane) return kinematics::Plane{f.point, f.direction};
  return kinematics::Surface{f.point, f.direction, f.outline, f.radius};
}

kinematics::Constraint kinematics_constraint(const ToleratedConstraint& c) {
  using Kind = kinematics::FrameId::Kind;
  return {c.relation,
          {{Kind::Object, 0}, kinematics_feature(c.first.feature)},
          {{Kind::Object, 1}, kinematics_feature(c.second.feature)},
          c.value};
}

}  // namespace kaboum::world
