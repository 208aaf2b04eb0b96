// Scene files: what they say, checked against the files they name.

#include <kaboum/base/error.h>
#include <kaboum/base/length_unit.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/world/constraint_conflict.h>
#include <kaboum/world/features.h>
#include <kaboum/world/grasp_family.h>
#include <kaboum/world/gripper.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "scene_robot.h"

namespace kaboum::world {
namespace {

using detail::Located;

/// Of the sine of the angle between two slides.
constexpr double kNotParallel = 1e-3;
/// Of bounds that are stated in decimals. [1]
constexpr double kRounding = 1e-9;
/// Of slides and turns. [length or rad]
constexpr double kFarthestBound = 1e6;
constexpr double kLastRank = 100;
/// Of the opening of a gripper. [rad or length]
constexpr double kMostWithin = 0.1;
/// Of constraints of grasps. [length, rad]
constexpr double kLeastTolerance = 1e-6;
/// Of features of the tool that holds an object.
constexpr std::string_view kOfTool = "tool.";

class Parser : detail::SceneRobot {
 public:
  Parser(const Located& root, const detail::SceneValues& values, const FileReader& read)
      : SceneRobot(values, read, values.string(values.need(root, "unit"))) {
    const Located& unit = need(root, "unit");
    world_.unit = string(unit);
    if (std::find(kLengthUnits.begin(), kLengthUnits.end(), world_.unit) == kLengthUnits.end())
      fail(unit,
           "'" + world_.unit + "' is no unit of length: one of m, dm, cm, mm, um, km, in, ft");
    // An arm that is a thousand times too small would be free of everything.
    if (!list(root, "robots").empty() && world_.unit != "m")
      fail(unit, "lengths in URDFs are in m, so a scene with robots is, too");
    for (const Located& r : list(root, "robots")) {
      const std::string name = new_name(r);
      world_.robots.push_back(SceneRobot::read(r, name));
    }
    for (const Located& o : list(root, "objects")) add_object(o);
    for (const Located& r : list(root, "regions")) add_region(r);
    for (const Located& c : list(root, "allowed_contacts")) add_contact(c);
    world_.attachments.resize(world_.objects.size());
    for (const Located& a : list(root, "attachments")) attach(a);
    for (const Located& c : list(root, "constraints")) add_constraints(c);
    note_unknown_sources();
    for (std::string& note : notes_of_pads(world_)) notes.push_back(std::move(note));
  }

  World take() { return std::move(world_); }
  using SceneRobot::notes;

 private:
  /// A name that no other robot, object or region has.
  std::string new_name(const Located& object) {
    const Located& value = need(object, "name");
    const std::string& name = string(value);
    if (name.find('/') != std::string::npos) fail(value, "a name with '/'");
    if (!names_.insert(name).second) fail(value, "the name '" + name + "' is used twice");
    return name;
  }

  void add_object(const Located& o) {
    known(o, {"name", "pose", "shape", "outer", "inner", "features", "grasps", "upright"});
    const std::string name = new_name(o);
    const Transform pose_of_object = pose_member(o, "pose");
    std::optional<Primitive> shape = shape_of(o);
    auto [outer, inner] =
        shape ? std::pair{outer_set(*shape), std::optional{inner_set(*shape)}} : sets_of(o);
    Object out{name, pose_of_object, std::move(outer), std::move(inner), {}, {}, shape};
    std::set<std::string> taken;
    for (const Located& f : list(o, "features")) {
      known(f, {"name", "point", "line", "plane", "surface"});
      out.features.push_back(feature(f, taken));
    }
    if (const Located* upright = find(o, "upright")) {
      out.upright = number(*upright);
      if (!(*out.upright > 0) || *out.upright > std::numbers::pi)
        fail(*upright,
             "an angle above 0 and at most pi is expected, in radians: most that the object may "
             "lean");
    }
    world_.objects.push_back(std::move(out));
    for (const Located& g : list(o, "grasps")) add_grasp(g);
  }

  /// Of the object that was read last.
  void add_grasp(const Located& g) {
    known(g, {"name", "position", "rpy", "quaternion", "slides", "turn", "rank", "all", "opening",
              "within", "pads"});
    Grasp out{string(need(g, "name")), pose(g)};
    if (find(g, "all") != nullptr) add_constraints_of(g, out);
    for (const Located& s : list(g, "slides")) {
      known(s, {"along", "from", "to"});
      FreeSlide slide;
      slide.direction = axis_of_object(need(s, "along")).direction;
      slide.from = bound(need(s, "from"));
      slide.to = bound(need(s, "to"));
      require_order(s, slide.from, slide.to);
      for (const FreeSlide& other : out.slides)
        if (!(other.direction.cross(slide.direction).norm() > kNotParallel))
          fail(s, "two slides in one direction: one is enough, with wider bounds");
      out.slides.push_back(slide);
    }
    if (out.slides.size() > 2) fail(need(g, "slides"), "at most two slides are expected");
    if (const Located* t = find(g, "turn")) {
      known(*t, {"about", "from", "to"});
      const Feature axis = axis_of_object(need(*t, "about"));
      FreeTurn turn{axis.point, axis.direction};
      const Located *from = find(*t, "from"), *to = find(*t, "to");
      if ((from == nullptr) != (to == nullptr))
        fail(*t, "give both 'from' and 'to', or neither: then it turns all round");
      if (from != nullptr) {
        turn.from = bound(*from);
        turn.to = bound(*to);
        require_order(*t, turn.from, turn.to);
        if (turn.to - turn.from > 2 * std::numbers::pi * (1 + kRounding))
          fail(*t, "more than a whole turn: bounds at most 2 pi apart are expected, in radians");
      }
      out.turn = turn;
    }
    if (const Located* rank = find(g, "rank")) {
      const double value = number(*rank);
      if (!(value >= 0 && value <= kLastRank && value == std::floor(value)))
        fail(*rank, "a rank from 0 to 100 is expected: the lowest is tried first");
      out.rank = static_cast<unsigned>(value);
    }
    if (is_family(out)) require_tool(need(g, "name"));
    read_opening(g, out);
    world_.objects.back().grasps.push_back(std::move(out));
  }

  /// How far grippers with joints are open while they hold the object that was read last, and which
  /// pads touch it.
  void read_opening(const Located& g, Grasp& out) const {
    if (const Located* opening = find(g, "opening")) {
      if (opening->kind != Located::Kind::Object)
        fail(*opening, "an object with a value for each joint of the gripper is expected");
      for (std::size_t i = 0; i < opening->names.size(); ++i)
        out.opening.emplace_back(opening->names[i], bound(opening->values[i]));
    }
    if (const Located* within = find(g, "within")) {
      if (out.opening.empty()) fail(*within, "a tolerance of an 'opening', which is not stated");
      out.within = number(*within);
      if (!(out.within >= 0 && out.within <= kMostWithin))
        fail(*within, "a number from 0 to 0.1 is expected: how far a joint may be off");
    }
    for (const Located& pad : list(g, "pads")) out.pads.push_back(string(pad));
    std::vector<std::string> joints;
    bool with_pads = false;
    for (const RobotModel& robot : world_.robots)
      for (const ToolFrame& tool : robot.tools) {
        const Gripper* gripper = gripper_with_pads(robot, tool.link);
        if (gripper == nullptr || !fits(tool, out)) continue;
        with_pads = true;
        if (const auto misfit = find_misfit(robot, *gripper, out))
          fail(g, "the grasp '" + out.name + "' " + *misfit);
        for (const std::uint32_t variable : gripper->joints)
          joints.push_back(robot.kinematics.variables[variable].name);
      }
    for (std::size_t i = 0; i < out.opening.size(); ++i)
      if (std::ranges::find(joints, out.opening[i].first) == joints.end())
        fail(need(g, "opening").values[i], "no gripper that may use this grasp has the joint '" +
                                               out.opening[i].first + "'" +
                                               did_you_mean(out.opening[i].first, joints));
    if (!with_pads) {
      if (!out.pads.empty()) fail(need(g, "pads"), "no gripper with pads may use this grasp");
      return;
    }
    // What is held by pads is held by a grasp of this name.
    for (const Grasp& other : world_.objects.back().grasps)
      if (other.name == out.name)
        fail(need(g, "name"), "the name '" + out.name +
                                  "' is used twice, and grippers with pads "
                                  "tell grasps by their names");
    if (out.name.find_first_of("\n\r") != std::string::npos)
      fail(need(g, "name"), "a name with the end of a line");
  }

  /// Of a grasp of the object that was read last: between the tool that holds it and the object.
  void add_constraints_of(const Located& g, Grasp& out) const {
    for (const char* stated : {"position", "rpy", "quaternion", "slides", "turn"})
      if (const Located* member = find(g, stated))
        fail(*member, std::string("a grasp with constraints ('all') has no '") + stated + "'");
    for (const Located& one : array(need(g, "all"))) {
      out.constraints.push_back(
          constraint(one, [&](const Located& value) { return feature_of_grasp(value); }));
      ToleratedConstraint& c = out.constraints.back();
      if (c.second.to == FixedFeature::To::World) std::swap(c.first, c.second);
      if (c.within < kLeastTolerance || c.within_angle < kLeastTolerance)
        fail(one, "a tolerance of at least 1e-6 is expected: poses are rounded to a tenth of that");
    }
    if (out.constraints.empty())
      fail(need(g, "all"), "at least one constraint is expected in 'all'");
    require_no_contradiction(need(g, "all"), out.constraints);
    const auto& ball = world_.objects.back().outer.ball();
    out.members = draw_members(out.constraints, ball.center, 2 * ball.radius);
    if (out.members.empty())
      fail(g,
           "no hold was found that meets these constraints: look at their values, and at where "
           "the features are");
    out.pose = out.members.front();
  }

  /// "tool.PART" of the tool that holds, else a feature of the object that was read last.
  FixedFeature feature_of_grasp(const Located& value) const {
    const std::string& name = string(value);
    if (name.starts_with(kOfTool)) {
      auto part = find_frame_part(std::string_view(name).substr(kOfTool.size()));
      if (!part) fail(value, "a tool has the parts origin, x, y, z, xy, yz and zx, as in 'tool.z'");
      part->name = name;
      return {FixedFeature::To::World, 0, 0, std::move(*part)};
    }
    FixedFeature out;
    try {
      out = find_feature(world_, name);
      out.feature.name = name;
    } catch (const Error& error) {
      fail(value, std::string(error.what()) + "; those of the tool are called 'tool.z'");
    }
    if (out.to != FixedFeature::To::Object || out.index + 1 != world_.objects.size())
      fail(value, "'" + name + "' is neither a part of the tool, as 'tool.z', nor a feature of '" +
                      world_.objects.back().name + "', whose grasp this is");
    return out;
  }

  double bound(const Located& value) const {
    const double out = number(value);
    if (!(std::abs(out) <= kFarthestBound)) fail(value, "a number from -1e6 to 1e6 is expected");
    return out;
  }

  void require_order(const Located& at, double from, double to) const {
    if (from > to) fail(at, "no value is within the bounds: 'from' is above 'to'");
    if (from > 0 || to < 0)
      fail(at,
           "the stated pose is to be one of the family, where the value is 0: 'from' is 0 or "
           "below, 'to' 0 or above");
  }

  /// A line, or the normal of a plane, of the object that was read last: by its name, or stated.
  Feature axis_of_object(const Located& value) const {
    if (value.kind == Located::Kind::Object) {
      known(value, {"point", "direction"});
      const Located* point = find(value, "point");
      return {"", Feature::Kind::Line, point != nullptr ? vector(*point) : Vec3(Vec3::Zero()),
              unit_vector(need(value, "direction"))};
    }
    const FixedFeature out = feature_named(value);
    if (out.to != FixedFeature::To::Object || out.index + 1 != world_.objects.size())
      fail(value, "'" + value.text + "' is no feature of the object '" +
                      world_.objects.back().name + "', whose grasp this is");
    if (out.feature.kind == Feature::Kind::Point)
      fail(value, "'" + value.text +
                      "' is a point: a line, or a plane or surface for its normal, is expected");
    return out.feature;
  }

  /// Refuses a family that is called after a tool that no robot has: it would never be tried.
  /// Single grasps may be those of attachments.
  void require_tool(const Located& name) const {
    const std::size_t slash = name.text.find('/');
    if (slash == std::string::npos || world_.robots.empty()) return;
    const std::string tool = name.text.substr(0, slash);
    std::vector<std::string> tools;
    for (const RobotModel& robot : world_.robots)
      for (const ToolFrame& frame : robot.tools) tools.push_back(frame.name);
    if (std::ranges::find(tools, tool) == tools.end())
      fail(name, "no robot has the tool '" + tool + "', which alone may use this grasp" +
                     did_you_mean(tool, tools));
  }

  void add_region(const Located& r) {
    known(r, {"name", "pose", "shape", "inner"});
    const std::optional<Primitive> shape = shape_of(r);
    world_.regions.push_back({new_name(r), pose_member(r, "pose"),
                              shape ? inner_set(*shape) : set(r, "inner", "inner")});
  }

  /// The primitive that a thing is; none: it has sets.
  std::optional<Primitive> shape_of(const Located& thing) const {
    const Located* shape = find(thing, "shape");
    if (shape == nullptr) return std::nullopt;
    for (const char* set : {"outer", "inner"})
      if (const Located* given = find(thing, set))
        fail(*given, "a thing with a 'shape' needs no sets; give one of them");
    return primitive(*shape);
  }

  /// "OBJECT", "ROBOT/LINK", or all shapes of "ROBOT".
  std::vector<Item> items_of(const Located& value) const {
    const std::string& name = string(value);
    if (const auto object = world_.find_object(name)) return {{Item::kObject, *object}};
    std::vector<Item> out;
    std::vector<std::string> names;
    for (const Object& object : world_.objects) names.push_back(object.name);
    for (std::size_t r = 0; r < world_.robots.size(); ++r) {
      names.push_back(world_.robots[r].name);
      for (std::size_t s = 0; s < world_.robots[r].shapes.size(); ++s) {
        names.push_back(world_.name_of({r, s}));
        if (name == world_.robots[r].name || name == names.back()) out.push_back({r, s});
      }
    }
    if (out.empty())
      fail(value, "there is no object '" + name +
                      "', and no robot or link ROBOT/LINK of that "
                      "name with a set" +
                      did_you_mean(name, names));
    return out;
  }

  void add_contact(const Located& c) {
    if (array(c).size() != 2) fail(c, "two names are expected");
    for (const Item& a : items_of(c.items[0]))
      for (const Item& b : items_of(c.items[1])) {
        if (a == b) fail(c, "both names mean '" + world_.name_of(a) + "'");
        world_.allowed.push_back({a, b});
      }
  }

  void attach(const Located& a) {
    known(a,
          {"object", "robot", "link", "tool", "gripper", "grasp", "position", "rpy", "quaternion"});
    const Located& object_name = need(a, "object");
    const auto object = world_.find_object(string(object_name));
    if (!object) fail(object_name, "there is no object '" + object_name.text + "'");
    if (world_.attachments[*object]) fail(object_name, "the object is attached twice");
    const Located& robot_name = need(a, "robot");
    const auto robot = world_.find_robot(string(robot_name));
    if (!robot) fail(robot_name, "there is no robot '" + robot_name.text + "'");
    const RobotModel& model = world_.robots[*robot];
    Attachment out;
    out.robot = *robot;
    out.pose = pose(a);
    const auto& grasps = world_.objects[*object].grasps;
    auto found = grasps.end();
    if (const Located* grasp = find(a, "grasp")) {
      found = std::find_if(grasps.begin(), grasps.end(),
                           [&](const Grasp& g) { return g.name == string(*grasp); });
      if (found == grasps.end()) fail(*grasp, "the object has no grasp '" + grasp->text + "'");
      if (!found->constraints.empty())
        fail(*grasp, "the grasp '" + grasp->text +
                         "' is by constraints, which many poses meet: give a pose instead");
      if (find(a, "position") != nullptr || find(a, "rpy") != nullptr ||
          find(a, "quaternion") != nullptr)
        fail(*grasp, "give either a grasp or a pose, not both");
      out.pose = found->pose;
    }
    const Located *link = find(a, "link"), *tool = find(a, "tool"), *gripper = find(a, "gripper");
    if ((link != nullptr ? 1 : 0) + (tool != nullptr ? 1 : 0) + (gripper != nullptr ? 1 : 0) != 1)
      fail(a, "an attachment is to one of 'link', 'tool' and 'gripper'");
    if (link != nullptr) {
      out.link = link_of(model.kinematics, *link);
    } else {
      std::size_t frame = 0;
      if (tool != nullptr) {
        frame = tool_of(model, *tool);
      } else {
        const auto by = std::find_if(model.grippers.begin(), model.grippers.end(),
                                     [&](const Gripper& g) { return g.name == string(*gripper); });
        if (by == model.grippers.end())
          fail(*gripper, "the robot has no gripper '" + gripper->text + "'");
        frame = by->tool;
        if (!by->pads.empty()) {
          if (found == grasps.end())
            fail(*gripper, "what a gripper with pads holds is held by a 'grasp', which is missing");
          if (!fits(model.tools[frame], *found) || find_misfit(model, *by, *found))
            fail(a, "the grasp '" + found->name + "' is not for the gripper '" + by->name + "'");
          for (const auto& other : world_.attachments)
            if (other && other->robot == *robot && !other->link_touches &&
                gripper_with_pads(model, other->link) == &*by)
              fail(*gripper, "the gripper '" + by->name + "' holds another object already");
          world_.attachments[*object] = hold_by(world_, *robot, model.tools[frame].link,
                                                model.tools[frame].pose * out.pose, *found);
          return;
        }
        out.touching = by->links;
        std::sort(out.touching.begin(), out.touching.end());
      }
      out.link = model.tools[frame].link;
      out.pose = model.tools[frame].pose * out.pose;
    }
    require_no_pads(link != nullptr ? *link : tool != nullptr ? *tool : *gripper, model, out.link);
    world_.attachments[*object] = std::move(out);
  }

  /// Of a link that may touch what it holds: a gripper's pads are to be the only ones.
  void require_no_pads(const Located& at, const RobotModel& model, std::uint32_t link) const {
    const Gripper* gripper = gripper_with_pads(model, link);
    const auto finger = finger_joint_above(model, link);
    if (gripper == nullptr && !finger) return;
    const std::string by = gripper != nullptr
                               ? "the gripper '" + gripper->name + "' has its pads at the link '"
                               : "the joint '" + model.kinematics.variables[*finger].name +
                                     "' of a gripper with pads moves the link '";
    fail(at, by + model.kinematics.links[link].name +
                 "', and pads alone may touch what is held: attach the object by a 'gripper' and a "
                 "'grasp'");
  }

  void add_constraints(const Located& c) {
    known(c, {"name", "all", "prefer"});
    const Located& name = need(c, "name");
    for (const ConstraintSet& other : world_.constraints)
      if (other.name == string(name)) fail(name, "the name '" + name.text + "' is used twice");
    if (is_usual_constraint(name.text))
      fail(name, "'" + name.text + "' is what a motion keeps of its start: another name is needed");
    if (name.text.find_first_of(",=") != std::string::npos)
      fail(name, "a name of constraints with ',' or '='");
    ConstraintSet out{name.text, {}};
    for (const Located& one : array(need(c, "all"))) out.constraints.push_back(constraint(one));
    if (out.constraints.empty()) fail(c, "at least one constraint is expected in 'all'");
    for (const Located& one : list(c, "prefer")) out.preferred.push_back(constraint(one));
    require_consistent(c, out);
    world_.constraints.push_back(std::move(out));
  }

  /// Refuses what no poses meet. @param all  where the constraints stand
  void require_no_contradiction(const Located& all,
                                const std::vector<ToleratedConstraint>& constraints) const {
    if (const auto found = find_contradiction(constraints))
      fail(all.items[found->front()], describe(constraints, *found));
  }

  /// Refuses what no poses meet, or no robot reaches.
  void require_consistent(const Located& c, const ConstraintSet& set) const {
    require_no_contradiction(need(c, "all"), set.constraints);
    require_within_reach(need(c, "all"), set.constraints);
    for (std::size_t i = 0; i < set.preferred.size(); ++i) {
      std::vector<ToleratedConstraint> with = set.constraints;
      with.push_back(set.preferred[i]);
      if (const auto found = find_contradiction(with))
        fail(need(c, "prefer").items[i],
             "what is preferred is never met: " + describe(with, *found));
    }
    if (!set.preferred.empty()) require_within_reach(need(c, "prefer"), set.preferred);
  }

  /// @param all  where the constraints stand
  void require_within_reach(const Located& all,
                            const std::vector<ToleratedConstraint>& constraints) const {
    for (std::size_t i = 0; i < constraints.size(); ++i) {
      ToleratedConstraint one = constraints[i];
      if (one.second.to == FixedFeature::To::Link) std::swap(one.first, one.second);
      if (one.first.to != FixedFeature::To::Link || one.second.to != FixedFeature::To::World)
        continue;
      const RobotModel& robot = world_.robots[one.first.index];
      if (is_beyond_reach(robot, one))
        fail(all.items[i], "'" + robot.name + "' does not reach so far, whatever its joints are: " +
                               describe(constraints[i]) +
                               "; change its value, move the robot, or take the set out");
    }
  }

  ToleratedConstraint constraint(const Located& c) const {
    return constraint(c, [&](const Located& value) { return feature_named(value); });
  }

  template <typename FindFeature>
  ToleratedConstraint constraint(const Located& c, const FindFeature& find_named) const {
    known(c, {"relation", "first", "second", "value", "within", "within_angle"});
    ToleratedConstraint out;
    out.relation = relation(need(c, "relation"));
    out.first = find_named(need(c, "first"));
    out.second = find_named(need(c, "second"));
    if (out.first.to == out.second.to && out.first.index == out.second.index &&
        out.first.link == out.second.link)
      fail(c, "both features are fixed to the same thing: nothing can be moved to meet that");
    using kinematics::Relation;
    const bool measured = out.relation == Relation::Distance || out.relation == Relation::Angle;
    const Located* value = find(c, "value");
    if (measured) {
      out.value = number(need(c, "value"));
    } else if (value != nullptr) {
      fail(*value, std::string("'") + name_of(out.relation) + "' has no value");
    }
    const kinematics::Constraint plain = kinematics_constraint(out);
    try {
      require_valid(plain);
    } catch (const Error& error) {
      fail(c, error.what());
    }
    const kinematics::Measures measures = measures_of(plain);
    read_tolerance(c, "within", measures.length, "lengths", out.within);
    read_tolerance(c, "within_angle", measures.angle, "directions", out.within_angle);
    return out;
  }

  void read_tolerance(const Located& c, const char* name, bool meant, const char* what,
                      double& tolerance) const {
    const Located* given = find(c, name);
    if (given == nullptr) return;
    if (!meant) fail(*given, std::string("this constraint is not about ") + what);
    tolerance = number(*given);
    if (!(tolerance > 0)) fail(*given, "a tolerance above 0 is expected");
  }

  kinematics::Relation relation(const Located& value) const {
    using kinematics::Relation;
    std::vector<std::string> names;
    for (const Relation r : {Relation::Coincident, Relation::Parallel, Relation::Perpendicular,
                             Relation::Distance, Relation::Angle}) {
      if (string(value) == name_of(r)) return r;
      names.emplace_back(name_of(r));
    }
    const std::string similar = did_you_mean(value.text, names);
    fail(value,
         "there is no relation '" + value.text + "'" +
             (similar.empty() ? ": one of coincident, parallel, perpendicular, distance, angle"
                              : similar));
  }

  FixedFeature feature_named(const Located& value) const {
    try {
      FixedFeature out = find_feature(world_, string(value));
      out.feature.name = value.text;
      return out;
    } catch (const Error& error) {
      fail(value, error.what());
    }
  }

  World world_;
  std::set<std::string> names_;
};

}  // namespace

World parse_scene(std::string_view text, const std::string& name, const FileReader& read,
                  SceneNotes* notes) {
  const detail::SceneValues values(text, name);
  const Located root = detail::is_yaml(name) ? detail::parse_located_yaml(text, name)
                                             : detail::parse_located(text, name);
  values.known(root, {"kaboum_scene", "unit", "robots", "objects", "regions", "allowed_contacts",
                      "attachments", "constraints"});
  const Located& version = values.need(root, "kaboum_scene");
  if (values.number(version) != 1) values.fail(version, "this version reads scenes of version 1");
  Parser parser(root, values, read);
  if (notes != nullptr) notes->notes = std::move(parser.notes);
  return parser.take();
}

}  // namespace kaboum::world
