// Robots of scenes: every link with shapes has a set of its own, of this robot.

#include "scene_robot.h"

#include <kaboum/base/error.h>
#include <kaboum/base/option.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/world/allowed_pairs.h>
#include <kaboum/world/gripper.h>

#include <algorithm>
#include <set>

namespace kaboum::world::detail {

using Kind = Located::Kind;

/// Corners of an outline at most; how far they may be off its plane, of its size.
constexpr std::size_t kMostCorners = 256;
constexpr double kFlat = 1e-6;

std::uint32_t SceneRobot::link_of(const robot::Robot& robot, const Located& value) const {
  const std::string& name = string(value);
  if (const auto link = robot.find_link(name)) return *link;
  std::vector<std::string> names;
  for (const robot::Link& link : robot.links) names.push_back(link.name);
  fail(value, "the robot has no link '" + name + "'" + did_you_mean(name, names));
}

std::size_t SceneRobot::variable_of(const robot::Robot& robot, const std::string& name,
                                    const Located& at) const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < robot.variables.size(); ++i) {
    if (robot.variables[i].name == name) return i;
    names.push_back(robot.variables[i].name);
  }
  fail(at, "no joint '" + name + "' of the robot moves by itself" + did_you_mean(name, names));
}

void SceneRobot::read_limits(const Located& value, robot::Robot& robot) const {
  if (value.kind != Kind::Object) fail(value, "an object of joints is expected");
  for (std::size_t i = 0; i < value.names.size(); ++i) {
    const Located& range = value.values[i];
    robot::Variable& variable = robot.variables[variable_of(robot, value.names[i], range)];
    const std::vector<double> ends = numbers(range, 2);
    if (!(ends[0] <= ends[1])) fail(range, "the lower limit is above the upper one");
    variable.lower = ends[0];
    variable.upper = ends[1];
  }
}

std::vector<double> SceneRobot::read_home(const Located* value, const Located& at,
                                          const robot::Robot& robot) const {
  std::vector<double> out;
  if (value != nullptr && value->kind == Kind::Array) {
    out = numbers(*value, robot.variables.size());
  } else {
    for (const robot::Variable& v : robot.variables)
      out.push_back(std::clamp(0.0, v.lower.value_or(-1e300), v.upper.value_or(1e300)));
    if (value != nullptr) {
      if (value->kind != Kind::Object) fail(*value, "an array or an object is expected");
      for (std::size_t i = 0; i < value->names.size(); ++i)
        out[variable_of(robot, value->names[i], value->values[i])] = number(value->values[i]);
    }
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    const robot::Variable& v = robot.variables[i];
    if ((v.lower && out[i] < *v.lower) || (v.upper && out[i] > *v.upper))
      fail(value == nullptr ? at : *value, "home is outside the limits of joint '" + v.name + "'");
  }
  return out;
}

RobotModel SceneRobot::read(const Located& r, const std::string& name) {
  known(r, {"name", "urdf", "shapes", "base", "home", "limits", "links", "links_without_set",
            "tools", "grippers", "features", "allowed_contacts", "never_in_contact"});
  RobotModel out;
  out.name = name;
  const File urdf = file(need(r, "urdf"));
  try {
    out.kinematics = robot::parse_urdf({urdf.bytes.data(), urdf.bytes.size()}, urdf.name);
  } catch (const Error& error) {
    fail(need(r, "urdf"), error.what());
  }
  const bool visual = is_of_visual_shapes(r);
  note_bare_links(out, visual);
  // From here on, shapes are those that the sets stand for.
  if (visual)
    for (robot::Link& link : out.kinematics.links) link.collision = link.visual;
  out.base = pose_member(r, "base");
  if (const Located* limits = find(r, "limits")) read_limits(*limits, out.kinematics);
  out.home = read_home(find(r, "home"), r, out.kinematics);
  add_shapes(r, urdf, visual, out);
  for (const Located& tool : list(r, "tools")) {
    known(tool, {"name", "link", "position", "rpy", "quaternion"});
    out.tools.push_back(
        {string(need(tool, "name")), link_of(out.kinematics, need(tool, "link")), pose(tool)});
  }
  for (const Located& gripper : list(r, "grippers")) {
    Gripper g = gripper_of(out, gripper);
    out.grippers.push_back(std::move(g));
  }
  add_features(r, out);
  require_above_fingers(r, out);
  out.fingerprint = fingerprint_of(out);
  out.allowed = connected_links(out);
  for (const Located& pair : list(r, "allowed_contacts"))
    out.allowed.push_back(pair_of(out, pair, AllowedPair::Reason::Stated));
  add_proved(r, out);
  return out;
}

/// Fingers by their links; or pads, which alone may touch what is held, and joints that move them.
Gripper SceneRobot::gripper_of(const RobotModel& robot, const Located& gripper) const {
  known(gripper, {"name", "tool", "links", "pads", "joints", "force"});
  Gripper out{string(need(gripper, "name")), tool_of(robot, need(gripper, "tool")), {}};
  for (const Located& link : list(gripper, "links"))
    out.links.push_back(link_of(robot.kinematics, link));
  if (find(gripper, "pads") == nullptr) {
    for (const char* member : {"joints", "force"})
      if (const Located* given = find(gripper, member))
        fail(*given, "a gripper with '" + std::string(member) +
                         "' states its 'pads': the links that alone may touch what it holds");
    return out;
  }
  if (const Located* links = find(gripper, "links"))
    fail(*links, "a gripper has 'links' or 'pads': where there are pads nothing else may touch");
  const std::uint32_t hand = robot.tools[out.tool].link;
  if (gripper_with_pads(robot, hand) != nullptr)
    fail(need(gripper, "tool"), "two grippers with pads at one link");
  for (const Located& joint : list(gripper, "joints")) {
    const auto variable =
        static_cast<std::uint32_t>(variable_of(robot.kinematics, string(joint), joint));
    for (const Gripper& other : robot.grippers)
      if (std::ranges::find(other.joints, variable) != other.joints.end())
        fail(joint, "the joint '" + joint.text + "' is one of the gripper '" + other.name + "'");
    if (std::ranges::find(out.joints, variable) != out.joints.end())
      fail(joint, "the joint '" + joint.text + "' is there twice");
    for (std::uint32_t at = hand; at > 0; at = robot.kinematics.joints[at - 1].parent)
      if (robot.kinematics.joints[at - 1].type != robot::JointType::Fixed &&
          robot.kinematics.joints[at - 1].variable == variable)
        fail(joint, "the joint '" + joint.text + "' moves the tool itself, not only its pads");
    out.joints.push_back(variable);
  }
  std::set<std::uint32_t> moving;  // joints that move a pad against the tool
  const auto rigid = [&](std::uint32_t link) {
    while (link > 0 && robot.kinematics.joints[link - 1].type == robot::JointType::Fixed)
      link = robot.kinematics.joints[link - 1].parent;
    return link;
  };
  for (const Located& pad : list(gripper, "pads")) {
    const std::uint32_t link = link_of(robot.kinematics, pad);
    if (std::ranges::find(robot.shapes, link, &LinkShape::link) == robot.shapes.end())
      fail(pad, "the pad '" + pad.text + "' has no shape: what touches needs one");
    if (std::ranges::find(out.pads, link) != out.pads.end())
      fail(pad, "the pad '" + pad.text + "' is there twice");
    for (std::uint32_t at = rigid(link); at != rigid(hand);) {
      if (at == 0)
        fail(pad, "the pad '" + pad.text + "' does not hang from the link of the tool, '" +
                      robot.kinematics.links[hand].name + "'");
      const std::uint32_t variable = robot.kinematics.joints[at - 1].variable;
      if (std::ranges::find(out.joints, variable) == out.joints.end())
        fail(pad, "the joint '" + robot.kinematics.variables[variable].name + "' moves the pad '" +
                      pad.text + "' against the tool, and is none of the gripper's 'joints'");
      moving.insert(variable);
      at = rigid(robot.kinematics.joints[at - 1].parent);
    }
    out.pads.push_back(link);
  }
  if (out.pads.empty()) fail(need(gripper, "pads"), "at least one pad is expected");
  for (std::size_t i = 0; i < out.joints.size(); ++i)
    if (!moving.contains(out.joints[i]))
      fail(need(gripper, "joints").items[i], "the joint moves no pad against the tool");
  std::ranges::sort(out.pads);
  if (const Located* force = find(gripper, "force")) {
    out.force = number(*force);
    if (!(out.force > 0)) fail(*force, "a force above 0 is expected");
  }
  return out;
}

/// Tools and planes that push are put somewhere by inverse kinematics: joints of grippers, which
/// what they hold decides, must not be among those that do it.
void SceneRobot::require_above_fingers(const Located& r, const RobotModel& robot) const {
  const auto require = [&](const Located& value, std::uint32_t link, const std::string& what) {
    const auto finger = finger_joint_above(robot, link);
    if (!finger) return;
    fail(value, "the joint '" + robot.kinematics.variables[*finger].name +
                    "' of a gripper moves the link '" + robot.kinematics.links[link].name +
                    "': " + what +
                    " is on a link that no joint of a gripper moves, as that of the "
                    "gripper's tool");
  };
  const auto& tools = list(r, "tools");
  for (std::size_t i = 0; i < robot.tools.size(); ++i)
    require(need(tools[i], "link"), robot.tools[i].link, "a tool");
  const auto& features = list(r, "features");
  for (std::size_t i = 0; i < robot.features.size(); ++i)
    if (const Feature& f = robot.features[i].feature;
        f.kind == Feature::Kind::Plane && f.name.starts_with("push"))
      require(need(features[i], "link"), robot.features[i].link, "a plane 'push…'");
}

bool SceneRobot::is_of_visual_shapes(const Located& r) const {
  const Located* shapes = find(r, "shapes");
  if (shapes == nullptr || string(*shapes) == "collision") return false;
  if (shapes->text != "visual") fail(*shapes, "'collision' or 'visual' is expected");
  return true;
}

void SceneRobot::note_bare_links(const RobotModel& robot, bool visual) {
  std::vector<std::string> bare;
  for (const robot::Link& link : robot.kinematics.links)
    if ((visual ? link.visual : link.collision).empty() &&
        !(visual ? link.collision : link.visual).empty())
      bare.push_back(link.name);
  if (bare.empty()) return;
  std::string names;
  for (const std::string& name : bare) names += (names.empty() ? "'" : ", '") + name + "'";
  notes.push_back(file_name() + ": robot '" + robot.name + "': " + names +
                  (bare.size() == 1 ? " has" : " have") + " shapes for " +
                  (visual ? "collisions" : "drawing") +
                  " only: nothing is checked of them unless 'links' gives a set");
}

void SceneRobot::require_shapes(const Loaded& loaded, const Located& value, bool visual) const {
  const geom::Provenance& p = loaded.set.provenance;
  const bool of_visual = recorded(p.parameters, "geometry") == "visual";
  if (of_visual && !visual)
    fail(
        need(value, "file"),
        loaded.file.name +
            " was made of the shapes for drawing (visual), not of those for collisions; if that is "
            "meant, state \"shapes\": \"visual\" in the robot");
  if (visual && !of_visual && !p.parameters.empty())
    fail(need(value, "file"), loaded.file.name +
                                  " was made of the shapes for collisions, but the robot states "
                                  "\"shapes\": \"visual\"");
}

SceneRobot::Loaded SceneRobot::link_set(const Located& entry, const char* direction,
                                        const std::string& link, const File& urdf, bool visual) {
  const Located& value = need(entry, direction);
  Loaded loaded = container(value, direction);
  const geom::Provenance& p = loaded.set.provenance;
  if (p.frame != link)
    fail(value,
         loaded.file.name + " is in the frame of '" + p.frame + "', not of link '" + link + "'");
  require_source(loaded, value, urdf.sha256);
  require_shapes(loaded, value, visual);
  return loaded;
}

void SceneRobot::add_features(const Located& r, RobotModel& out) const {
  std::set<std::string> taken;
  for (const Located& f : list(r, "features")) {
    known(f, {"name", "link", "point", "line", "plane", "surface"});
    out.features.push_back({link_of(out.kinematics, need(f, "link")), feature(f, taken)});
  }
}

/// A disc, or a convex outline in a plane. The plane of an outline is the one that fits its area.
void SceneRobot::read_surface(const Located& s, Feature& out) const {
  out.kind = Feature::Kind::Surface;
  if (find(s, "outline") == nullptr) {
    known(s, {"point", "normal", "radius"});
    out.point = vector(need(s, "point"));
    out.direction = unit_vector(need(s, "normal"));
    out.radius = number(need(s, "radius"));
    if (!(out.radius > 0))
      fail(need(s, "radius"), "an empty surface: a radius above 0 is expected");
    return;
  }
  known(s, {"outline"});
  const Located& outline = need(s, "outline");
  for (const Located& corner : array(outline)) out.outline.push_back(vector(corner));
  if (out.outline.size() < 3 || out.outline.size() > kMostCorners)
    fail(outline, "from 3 to " + std::to_string(kMostCorners) + " corners are expected");
  out.point = Vec3::Zero();
  for (const Vec3& corner : out.outline)
    out.point += corner / static_cast<double>(out.outline.size());
  Vec3 area = Vec3::Zero();
  for (std::size_t i = 0; i < out.outline.size(); ++i)
    area +=
        (out.outline[i] - out.point).cross(out.outline[(i + 1) % out.outline.size()] - out.point);
  if (!(area.norm() > 0)) fail(outline, "an empty surface: its corners are on a line");
  out.direction = area.normalized();
  double size = 0, off = 0;
  for (Vec3& corner : out.outline) {
    const double above = out.direction.dot(corner - out.point);
    size = std::max(size, (corner - out.point).norm());
    off = std::max(off, std::abs(above));
    corner -= above * out.direction;
  }
  if (off > kFlat * size) fail(outline, "the corners of a surface are in one plane");
  const kinematics::PlacedFeature surface{
      {kinematics::FrameId::Kind::Object, 0},
      kinematics::Surface{out.point, out.direction, out.outline, out.radius}};
  try {
    require_valid(kinematics::Constraint{
        kinematics::Relation::Coincident, surface, {{}, kinematics::Point{}}, 0});
  } catch (const Error&) {
    fail(outline,
         "the corners of a surface go round a convex outline once, counterclockwise as seen from "
         "outside, each at another place");
  }
}

Feature SceneRobot::feature(const Located& f, std::set<std::string>& taken) const {
  Feature out;
  const Located& name = need(f, "name");
  out.name = string(name);
  const Located *point = find(f, "point"), *line = find(f, "line"), *plane = find(f, "plane"),
                *surface = find(f, "surface");
  if ((point != nullptr ? 1 : 0) + (line != nullptr ? 1 : 0) + (plane != nullptr ? 1 : 0) +
          (surface != nullptr ? 1 : 0) !=
      1)
    fail(f, "a feature is one of 'point', 'line', 'plane' and 'surface'");
  if (point != nullptr) {
    out.point = vector(*point);
  } else if (line != nullptr) {
    known(*line, {"point", "direction"});
    out.kind = Feature::Kind::Line;
    out.point = vector(need(*line, "point"));
    out.direction = unit_vector(need(*line, "direction"));
  } else if (surface != nullptr) {
    read_surface(*surface, out);
  } else {
    known(*plane, {"point", "normal"});
    out.kind = Feature::Kind::Plane;
    out.point = vector(need(*plane, "point"));
    out.direction = unit_vector(need(*plane, "normal"));
  }
  const char* kind = point != nullptr   ? "point"
                     : line != nullptr  ? "line"
                     : plane != nullptr ? "plane"
                                        : "surface";
  if (!taken.insert(std::string(kind).append(" '").append(out.name) + "'").second)
    fail(name, std::string("the ") + kind + " '" + out.name + "' is there twice");
  return out;
}

void SceneRobot::add_shapes(const Located& r, const File& urdf, bool visual, RobotModel& out) {
  std::set<std::uint32_t> has;
  for (const Located& l : list(r, "links")) {
    known(l, {"link", "outer", "inner"});
    const std::uint32_t link = link_of(out.kinematics, need(l, "link"));
    const std::string& name = out.kinematics.links[link].name;
    if (!has.insert(link).second) fail(l, "link '" + name + "' has two entries");
    const Loaded outer = link_set(l, "outer", name, urdf, visual);
    LinkShape shape{link, set(outer, need(l, "outer")), std::nullopt};
    if (const Located* value = find(l, "inner")) {
      const Loaded inner = link_set(l, "inner", name, urdf, visual);
      require_within(inner, outer, *value);
      shape.inner = set(inner, *value);
    }
    out.shapes.push_back(std::move(shape));
  }
  std::set<std::uint32_t> without;
  for (const Located& l : list(r, "links_without_set")) without.insert(link_of(out.kinematics, l));
  for (std::uint32_t l = 0; l < out.kinematics.links.size(); ++l) {
    const robot::Link& link = out.kinematics.links[l];
    if (link.collision.empty() || has.contains(l)) continue;
    if (!without.contains(l))
      fail(r, "link '" + link.name + "' has shapes" + (visual ? "" : " for collisions") +
                  ", but no set: give it one in 'links', or name it in "
                  "'links_without_set', and nothing will be checked of it");
    notes.push_back(file_name() + ": robot '" + out.name + "': link '" + link.name +
                    "' has no set: nothing is checked of it");
  }
}

AllowedPair SceneRobot::pair_of(const RobotModel& robot, const Located& value,
                                AllowedPair::Reason reason) const {
  if (array(value).size() != 2) fail(value, "two links are expected");
  std::uint32_t a = link_of(robot.kinematics, value.items[0]),
                b = link_of(robot.kinematics, value.items[1]);
  if (a == b) fail(value, "both names mean one link");
  if (a > b) std::swap(a, b);
  return {a, b, reason};
}

void SceneRobot::add_proved(const Located& r, RobotModel& robot) const {
  const Located* proved = find(r, "never_in_contact");
  if (proved == nullptr) return;
  known(*proved, {"proved_for", "pairs"});
  std::vector<AllowedPair> pairs;
  for (const Located& pair : list(*proved, "pairs"))
    pairs.push_back(pair_of(robot, pair, AllowedPair::Reason::Never));
  const Located& stated = need(*proved, "proved_for");
  if (string(stated) != proof_hash(robot, pairs))
    fail(stated,
         "these pairs were proved for other limits or other sets, or are not the pairs that were "
         "proved; prove them anew (kaboum-scene pairs)");
  robot.allowed.insert(robot.allowed.end(), pairs.begin(), pairs.end());
}

std::size_t SceneRobot::tool_of(const RobotModel& robot, const Located& value) const {
  const std::string& name = string(value);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < robot.tools.size(); ++i) {
    if (robot.tools[i].name == name) return i;
    names.push_back(robot.tools[i].name);
  }
  fail(value, "the robot has no tool '" + name + "'" + did_you_mean(name, names));
}

}  // namespace kaboum::world::detail
