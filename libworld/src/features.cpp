// Features by their names: those of a scene, and the parts of frames.

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/world/features.h>

#include <algorithm>
#include <array>

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
    for (const FramePart& p : kParts) {
      if (part != p.name) continue;
      Feature feature{name_, p.kind, Vec3::Zero(), Vec3::Zero()};
      if (p.kind != Feature::Kind::Point) feature.direction = Vec3::Unit(p.axis);
      fixed.feature = moved(feature, pose);
      found_.push_back(std::move(fixed));
      return;
    }
  }

  const World& world_;
  const std::string& name_;
  std::vector<FixedFeature> found_;
  std::vector<std::string> names_, frames_;
};

}  // namespace

FixedFeature find_feature(const World& world, const std::string& name) {
  return Search(world, name).run();
}

Feature moved(const Feature& feature, const Transform& pose) {
  Feature out = feature;
  out.point = pose * feature.point;
  if (feature.kind != Feature::Kind::Point)
    out.direction = (pose.linear * feature.direction).normalized();
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
  return kinematics::Plane{f.point, f.direction};
}

kinematics::Constraint kinematics_constraint(const ToleratedConstraint& c) {
  using Kind = kinematics::FrameId::Kind;
  return {c.relation,
          {{Kind::Object, 0}, kinematics_feature(c.first.feature)},
          {{Kind::Object, 1}, kinematics_feature(c.second.feature)},
          c.value};
}

}  // namespace kaboum::world
