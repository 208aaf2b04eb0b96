// Scene files: what they say, checked against the files they name.

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/world/allowed_pairs.h>
#include <kaboum/world/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "located_json.h"

namespace kaboum::world {
namespace {

using detail::Located;
using Kind = Located::Kind;

class Parser {
 public:
  Parser(std::string_view text, const std::string& name, const FileReader& read)
      : text_(text), name_(name), read_(read) {}

  World run() {
    const Located root = detail::parse_located(text_, name_);
    known(root, {"kaboum_scene", "unit", "robots", "objects", "regions", "allowed_contacts",
                 "attachments"});
    if (number(need(root, "kaboum_scene")) != 1)
      fail(need(root, "kaboum_scene"), "this version reads scenes of version 1");
    world_.unit = string(need(root, "unit"));
    for (const Located& r : list(root, "robots")) add_robot(r);
    for (const Located& o : list(root, "objects")) add_object(o);
    for (const Located& r : list(root, "regions")) add_region(r);
    for (const Located& c : list(root, "allowed_contacts")) add_contact(c);
    world_.attachments.resize(world_.objects.size());
    for (const Located& a : list(root, "attachments")) attach(a);
    return std::move(world_);
  }

  std::vector<std::string> notes;

 private:
  // What is wrong, and where.

  [[noreturn]] void fail(const Located& at, const std::string& what) const {
    throw Error(ErrorCode::InvalidInput,
                name_ + ": " + detail::place_of(text_, at.at) + ": " + what);
  }

  void known(const Located& object, const std::vector<std::string>& names) const {
    if (object.kind != Kind::Object)
      fail(object, std::string("an object is expected, not ") + detail::name_of(object.kind));
    for (std::size_t i = 0; i < object.names.size(); ++i) {
      const std::string& name = object.names[i];
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      throw Error(ErrorCode::InvalidInput,
                  name_ + ": " + detail::place_of(text_, object.names_at[i]) + ": '" + name +
                      "' is not known here" + did_you_mean(name, names));
    }
  }

  static const Located* find(const Located& object, const char* name) {
    for (std::size_t i = 0; i < object.names.size(); ++i)
      if (object.names[i] == name) return &object.values[i];
    return nullptr;
  }
  const Located& need(const Located& object, const char* name) const {
    if (const Located* value = find(object, name)) return *value;
    fail(object, std::string("'") + name + "' is missing");
  }
  const std::vector<Located>& list(const Located& object, const char* name) const {
    static const std::vector<Located> kNone;
    const Located* value = find(object, name);
    return value == nullptr ? kNone : array(*value);
  }
  const std::vector<Located>& array(const Located& value) const {
    if (value.kind != Kind::Array)
      fail(value, std::string("an array is expected, not ") + detail::name_of(value.kind));
    return value.items;
  }
  const std::string& string(const Located& value) const {
    if (value.kind != Kind::String)
      fail(value, std::string("a string is expected, not ") + detail::name_of(value.kind));
    if (value.text.empty()) fail(value, "an empty string");
    return value.text;
  }
  double number(const Located& value) const {
    if (value.kind != Kind::Number || !std::isfinite(value.number))
      fail(value, std::string("a number is expected, not ") + detail::name_of(value.kind));
    return value.number;
  }
  std::vector<double> numbers(const Located& value, std::size_t count) const {
    std::vector<double> out;
    for (const Located& item : array(value)) out.push_back(number(item));
    if (out.size() != count)
      fail(value,
           std::to_string(count) + " numbers are expected, not " + std::to_string(out.size()));
    return out;
  }
  Vec3 vector(const Located& value) const {
    const std::vector<double> v = numbers(value, 3);
    return {v[0], v[1], v[2]};
  }
  Vec3 unit_vector(const Located& value) const {
    const Vec3 v = vector(value);
    if (!(v.norm() > 1e-100) || !(v.norm() < 1e100)) fail(value, "a direction of length 0");
    return v.normalized();
  }

  /// The pose in the members of an object.
  Transform pose(const Located& object) const {
    Transform out;
    if (const Located* position = find(object, "position")) out.translation = vector(*position);
    const Located *rpy = find(object, "rpy"), *quaternion = find(object, "quaternion");
    if (rpy != nullptr && quaternion != nullptr)
      fail(*quaternion, "'rpy' and 'quaternion' are one too many: leave one out");
    if (rpy != nullptr) {
      const Vec3 angles = vector(*rpy);
      if (!angles.isZero(0))
        out.linear = robot::rotation_from_rpy(angles.x(), angles.y(), angles.z());
    }
    if (quaternion != nullptr) {
      const std::vector<double> q = numbers(*quaternion, 4);
      const Eigen::Quaterniond r(q[3], q[0], q[1], q[2]);
      if (!(std::abs(r.norm() - 1) < 1e-3))
        fail(*quaternion, "a quaternion [x, y, z, w] of length 1 is expected");
      if (!r.vec().isZero(0)) out.linear = r.normalized().toRotationMatrix();
    }
    return out;
  }
  Transform pose_member(const Located& object, const char* name) const {
    const Located* value = find(object, name);
    if (value == nullptr) return {};
    known(*value, {"position", "rpy", "quaternion"});
    return pose(*value);
  }

  /// A name that no other robot, object or region has.
  std::string new_name(const Located& object) {
    const Located& value = need(object, "name");
    const std::string& name = string(value);
    if (name.find('/') != std::string::npos) fail(value, "a name with '/'");
    if (!names_.insert(name).second) fail(value, "the name '" + name + "' is there twice");
    return name;
  }

  // Files.

  struct File {
    std::string name;
    std::vector<char> bytes;
    std::string sha256;
  };
  File file(const Located& value) const {
    known(value, {"file", "sha256"});
    File out{string(need(value, "file")), {}, {}};
    try {
      out.bytes = read_(out.name);
    } catch (const Error& error) {
      fail(need(value, "file"), error.what());
    }
    out.sha256 = io::sha256(out.bytes);
    const Located& stated = need(value, "sha256");
    if (string(stated) != out.sha256)
      fail(stated, out.name + " is not the file that this scene was made with: its SHA-256 is " +
                       out.sha256 + "; make the scene anew, or put that hash here");
    return out;
  }

  struct Loaded {
    geom::ConvexSet set;
    File file;
  };
  Loaded container(const Located& value, const char* direction) const {
    Loaded out;
    out.file = file(value);
    const Located& at = need(value, "file");
    if (!out.file.name.ends_with(".glb"))
      fail(at, out.file.name + " is no container of convex sets (.glb)");
    try {
      io::SetReadDetails details;
      out.set = io::parse_convex_set(out.file.bytes, io::Format::Glb, out.file.name, &details);
      if (!details.has_record) fail(at, out.file.name + " has no record of what it bounds");
    } catch (const Error& error) {
      fail(at, error.what());
    }
    const geom::Provenance& p = out.set.provenance;
    if (p.direction != direction)
      fail(at, out.file.name + " is " +
                   (p.direction.empty() ? "not said to be an outer or an inner set"
                                        : "an " + p.direction + " set") +
                   ", but an " + direction + " one is needed here");
    if (p.unit != world_.unit)
      fail(at, out.file.name + " is in " + p.unit + ", the scene in " + world_.unit);
    return out;
  }
  BoundingSet set(const Loaded& loaded, const Located& value) const {
    try {
      return BoundingSet(loaded.set);
    } catch (const Error& error) {
      fail(need(value, "file"), loaded.file.name + ": " + error.what());
    }
  }
  BoundingSet set(const Located& object, const char* member, const char* direction) const {
    const Located& value = need(object, member);
    return set(container(value, direction), value);
  }
  std::optional<BoundingSet> optional_inner(const Located& object) const {
    if (find(object, "inner") == nullptr) return std::nullopt;
    return set(object, "inner", "inner");
  }

  // Robots.

  std::uint32_t link_of(const robot::Robot& robot, const Located& value) const {
    const std::string& name = string(value);
    if (const auto link = robot.find_link(name)) return *link;
    std::vector<std::string> names;
    for (const robot::Link& link : robot.links) names.push_back(link.name);
    fail(value, "the robot has no link '" + name + "'" + did_you_mean(name, names));
  }
  std::size_t variable_of(const robot::Robot& robot, const std::string& name,
                          const Located& at) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < robot.variables.size(); ++i) {
      if (robot.variables[i].name == name) return i;
      names.push_back(robot.variables[i].name);
    }
    fail(at, "no joint '" + name + "' of the robot moves by itself" + did_you_mean(name, names));
  }

  void read_limits(const Located& value, robot::Robot& robot) const {
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
  std::vector<double> read_home(const Located* value, const Located& at,
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
        fail(value == nullptr ? at : *value,
             "home is outside the limits of joint '" + v.name + "'");
    }
    return out;
  }

  void add_robot(const Located& r) {
    known(r, {"name", "urdf", "base", "home", "limits", "links", "links_without_set", "tools",
              "grippers", "allowed_contacts", "never_in_contact"});
    RobotModel out;
    out.name = new_name(r);
    const File urdf = file(need(r, "urdf"));
    try {
      out.kinematics = robot::parse_urdf({urdf.bytes.data(), urdf.bytes.size()}, urdf.name);
    } catch (const Error& error) {
      fail(need(r, "urdf"), error.what());
    }
    out.base = pose_member(r, "base");
    if (const Located* limits = find(r, "limits")) read_limits(*limits, out.kinematics);
    out.home = read_home(find(r, "home"), r, out.kinematics);
    add_shapes(r, urdf, out);
    for (const Located& tool : list(r, "tools")) {
      known(tool, {"name", "link", "position", "rpy", "quaternion"});
      out.tools.push_back(
          {string(need(tool, "name")), link_of(out.kinematics, need(tool, "link")), pose(tool)});
    }
    for (const Located& gripper : list(r, "grippers")) {
      known(gripper, {"name", "tool", "links"});
      Gripper g{string(need(gripper, "name")), tool_of(out, need(gripper, "tool")), {}};
      for (const Located& link : list(gripper, "links"))
        g.links.push_back(link_of(out.kinematics, link));
      out.grippers.push_back(std::move(g));
    }
    out.fingerprint = fingerprint_of(out);
    out.allowed = connected_links(out.kinematics);
    for (const Located& pair : list(r, "allowed_contacts"))
      out.allowed.push_back(pair_of(out, pair, AllowedPair::Reason::Stated));
    add_proved(r, out);
    world_.robots.push_back(std::move(out));
  }

  void add_shapes(const Located& r, const File& urdf, RobotModel& out) {
    std::set<std::uint32_t> has;
    for (const Located& l : list(r, "links")) {
      known(l, {"link", "outer", "inner"});
      const std::uint32_t link = link_of(out.kinematics, need(l, "link"));
      const std::string& name = out.kinematics.links[link].name;
      if (!has.insert(link).second) fail(l, "link '" + name + "' is there twice");
      const Loaded loaded = container(need(l, "outer"), "outer");
      const geom::Provenance& p = loaded.set.provenance;
      if (!p.frame.empty() && p.frame != name)
        fail(need(l, "outer"), loaded.file.name + " is in the frame of '" + p.frame +
                                   "', not of link '" + name + "'");
      if (p.source.ends_with(".urdf") && p.source_sha256 != urdf.sha256)
        fail(need(l, "outer"), loaded.file.name + " was made of another robot than " + urdf.name +
                                   " is now: make it anew");
      out.shapes.push_back({link, set(loaded, need(l, "outer")), optional_inner(l)});
    }
    std::set<std::uint32_t> without;
    for (const Located& l : list(r, "links_without_set"))
      without.insert(link_of(out.kinematics, l));
    for (std::uint32_t l = 0; l < out.kinematics.links.size(); ++l) {
      const robot::Link& link = out.kinematics.links[l];
      if (link.collision.empty() || has.contains(l)) continue;
      if (!without.contains(l))
        fail(r,
             "link '" + link.name +
                 "' has shapes for collisions, but no set: give it one in 'links', or name it in "
                 "'links_without_set', and nothing will be checked of it");
      notes.push_back(name_ + ": robot '" + out.name + "': link '" + link.name +
                      "' has no set: nothing is checked of it");
    }
  }

  AllowedPair pair_of(const RobotModel& robot, const Located& value,
                      AllowedPair::Reason reason) const {
    if (array(value).size() != 2) fail(value, "two links are expected");
    std::uint32_t a = link_of(robot.kinematics, value.items[0]),
                  b = link_of(robot.kinematics, value.items[1]);
    if (a == b) fail(value, "a link and itself");
    if (a > b) std::swap(a, b);
    return {a, b, reason};
  }

  void add_proved(const Located& r, RobotModel& robot) const {
    const Located* proved = find(r, "never_in_contact");
    if (proved == nullptr) return;
    known(*proved, {"proved_for", "pairs"});
    const Located& stated = need(*proved, "proved_for");
    if (string(stated) != robot.fingerprint)
      fail(stated,
           "these pairs were proved for other limits or other sets; prove them anew "
           "(kaboum-scene pairs), whose hash is " +
               robot.fingerprint);
    for (const Located& pair : list(*proved, "pairs"))
      robot.allowed.push_back(pair_of(robot, pair, AllowedPair::Reason::Never));
  }

  std::size_t tool_of(const RobotModel& robot, const Located& value) const {
    const std::string& name = string(value);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < robot.tools.size(); ++i) {
      if (robot.tools[i].name == name) return i;
      names.push_back(robot.tools[i].name);
    }
    fail(value, "the robot has no tool '" + name + "'" + did_you_mean(name, names));
  }

  // Objects, regions, contacts.

  void add_object(const Located& o) {
    known(o, {"name", "pose", "outer", "inner", "features", "grasps"});
    Object out{new_name(o), pose_member(o, "pose"), set(o, "outer", "outer"), optional_inner(o), {},
               {}};
    for (const Located& f : list(o, "features")) out.features.push_back(feature(f));
    for (const Located& g : list(o, "grasps")) {
      known(g, {"name", "position", "rpy", "quaternion"});
      out.grasps.push_back({string(need(g, "name")), pose(g)});
    }
    world_.objects.push_back(std::move(out));
  }

  Feature feature(const Located& f) const {
    known(f, {"name", "point", "line", "plane"});
    Feature out;
    out.name = string(need(f, "name"));
    const Located *point = find(f, "point"), *line = find(f, "line"), *plane = find(f, "plane");
    if ((point != nullptr ? 1 : 0) + (line != nullptr ? 1 : 0) + (plane != nullptr ? 1 : 0) != 1)
      fail(f, "a feature is one of 'point', 'line' and 'plane'");
    if (point != nullptr) {
      out.point = vector(*point);
    } else if (line != nullptr) {
      known(*line, {"point", "direction"});
      out.kind = Feature::Kind::Line;
      out.point = vector(need(*line, "point"));
      out.direction = unit_vector(need(*line, "direction"));
    } else {
      known(*plane, {"point", "normal"});
      out.kind = Feature::Kind::Plane;
      out.point = vector(need(*plane, "point"));
      out.direction = unit_vector(need(*plane, "normal"));
    }
    return out;
  }

  void add_region(const Located& r) {
    known(r, {"name", "pose", "inner"});
    world_.regions.push_back({new_name(r), pose_member(r, "pose"), set(r, "inner", "inner")});
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
        if (a == b) fail(c, "a thing and itself");
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
    if (const Located* grasp = find(a, "grasp")) {
      const auto& grasps = world_.objects[*object].grasps;
      const auto found = std::find_if(grasps.begin(), grasps.end(),
                                      [&](const Grasp& g) { return g.name == string(*grasp); });
      if (found == grasps.end()) fail(*grasp, "the object has no grasp '" + grasp->text + "'");
      if (find(a, "position") != nullptr || find(a, "rpy") != nullptr ||
          find(a, "quaternion") != nullptr)
        fail(*grasp, "a grasp and a pose are one too many");
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
        const auto found =
            std::find_if(model.grippers.begin(), model.grippers.end(),
                         [&](const Gripper& g) { return g.name == string(*gripper); });
        if (found == model.grippers.end())
          fail(*gripper, "the robot has no gripper '" + gripper->text + "'");
        frame = found->tool;
        out.touching = found->links;
        std::sort(out.touching.begin(), out.touching.end());
      }
      out.link = model.tools[frame].link;
      out.pose = model.tools[frame].pose * out.pose;
    }
    world_.attachments[*object] = std::move(out);
  }

  std::string_view text_;
  const std::string& name_;
  const FileReader& read_;
  World world_;
  std::set<std::string> names_;
};

void append(std::string& text, double x) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%a ", x);
  text += buffer;
}

void append(std::string& text, const Transform& t) {
  for (int i = 0; i < 9; ++i) append(text, t.linear(i / 3, i % 3));
  for (int i = 0; i < 3; ++i) append(text, t.translation[i]);
}

}  // namespace

std::string fingerprint_of(const RobotModel& robot) {
  std::string text = "pairs 1\n";
  for (const robot::Joint& joint : robot.kinematics.joints) {
    text += std::to_string(static_cast<int>(joint.type)) + " " + std::to_string(joint.parent) +
            " " + std::to_string(joint.variable) + " ";
    append(text, joint.origin);
    for (int i = 0; i < 3; ++i) append(text, joint.axis[i]);
    append(text, joint.multiplier);
    append(text, joint.offset);
    text += "\n";
  }
  for (const robot::Variable& v : robot.kinematics.variables) {
    append(text, v.lower.value_or(-HUGE_VAL));
    append(text, v.upper.value_or(HUGE_VAL));
    text += "\n";
  }
  for (const LinkShape& shape : robot.shapes) {
    text += robot.kinematics.links[shape.link].name + "\n";
    for (std::size_t i = 0; i < shape.outer.size(); ++i) {
      append(text, shape.outer.body(i).margin);
      for (const Vec3& p : shape.outer.body(i).hull.vertices)
        for (int k = 0; k < 3; ++k) append(text, p[k]);
      text += "\n";
    }
  }
  return io::sha256(text);
}

World parse_scene(std::string_view text, const std::string& name, const FileReader& read,
                  SceneNotes* notes) {
  Parser parser(text, name, read);
  World out = parser.run();
  if (notes != nullptr) notes->notes = std::move(parser.notes);
  return out;
}

}  // namespace kaboum::world
