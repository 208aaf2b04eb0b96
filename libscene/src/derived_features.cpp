// Grasps and places derived from convex sets: faces, pairs of faces, and what the hand allows.

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/geom/closest_point.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/scene/derived_features.h>
#include <kaboum/world/checker.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include "set_maker.h"

namespace kaboum::scene {
namespace {

using geom::Transform;
using geom::Vec3;
using Vec2 = Eigen::Vector2d;

/// Between normals of faces that count as parallel, and from level. [rad]
constexpr double kParallel = 1e-3;
/// Between normals of triangles of one face. [rad]
constexpr double kSameFace = 1e-6;
/// Share of a size that counts as nothing.
constexpr double kNothing = 1e-9;
/// Shares of the way from the middle of two faces to their edge at which a tool is put.
constexpr std::array kShares{0.0, 0.25, 0.5, 0.75, 0.95};

/// A flat face of a convex body.
struct Face {
  std::size_t body = 0;
  Vec3 normal;
  double offset = 0;          ///< normal · x of its points
  std::vector<Vec3> corners;  ///< of its triangles; some are there twice
};

/// A set's flat faces: the facets of its bodies' cores, moved out by their radii. What is round has
/// none.
class Faces {
 public:
  explicit Faces(const collide::BoundingSet& set)
      : set_(set), size_(set.box().diagonal()), first_of_(set.size() + 1, 0) {
    for (std::size_t i = 0; i < set.size(); ++i) {
      first_of_[i] = all_.size();
      add(set.body(i), i);
    }
    first_of_[set.size()] = all_.size();
  }

  [[nodiscard]] const std::vector<Face>& all() const { return all_; }
  [[nodiscard]] double size() const { return size_; }

  /// True if the point just outside of a face is in another body.
  [[nodiscard]] bool is_covered(const Face& face, const Vec3& point) const {
    const Vec3 outside = point + 1e-6 * size_ * face.normal;
    for (std::size_t body = 0; body < set_.size(); ++body)
      if (body != face.body && holds(body, outside)) return true;
    return false;
  }

 private:
  [[nodiscard]] bool holds(std::size_t body, const Vec3& point) const {
    const geom::Mesh& core = set_.body(body).core;
    const double radius = set_.body(body).radius;
    const auto begin = all_.begin() + static_cast<std::ptrdiff_t>(first_of_[body]);
    const auto end = all_.begin() + static_cast<std::ptrdiff_t>(first_of_[body + 1]);
    const auto is_below = [&](double by) {
      return std::all_of(begin, end,
                         [&](const Face& f) { return f.normal.dot(point) < f.offset - by; });
    };
    if (radius == 0) return is_below(0);
    const auto is_near = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      return (geom::closest_point(point, a, b, c) - point).norm() < radius;
    };
    if (core.triangles.empty())  // a point or a segment
      return is_near(core.vertices.front(), core.vertices.back(), core.vertices.back());
    return is_below(radius) || std::ranges::any_of(core.triangles, [&](const geom::Triangle& t) {
             return is_near(core.vertices[t[0]], core.vertices[t[1]], core.vertices[t[2]]);
           });
  }

  void add(const geom::ConvexBody& of, std::size_t body) {
    const geom::Mesh& mesh = of.core;
    const std::size_t first = all_.size();
    for (const geom::Triangle& t : mesh.triangles) {
      const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      const Vec3 across = (b - a).cross(c - a);
      if (!(across.norm() > kNothing * kNothing * size_ * size_)) continue;
      const Vec3 normal = across.normalized();
      const auto same = std::find_if(
          all_.begin() + static_cast<std::ptrdiff_t>(first), all_.end(), [&](const Face& f) {
            return f.normal.cross(normal).norm() < kSameFace && f.normal.dot(normal) > 0;
          });
      Face& face = same == all_.end() ? all_.emplace_back() : *same;
      if (face.corners.empty()) face = {body, normal, normal.dot(a) + of.radius, {}};
      const Vec3 out = of.radius * face.normal;
      face.corners.insert(face.corners.end(), {a + out, b + out, c + out});
    }
  }

  const collide::BoundingSet& set_;
  double size_;
  std::vector<Face> all_;
  std::vector<std::size_t> first_of_;
};

/// A plane's coordinates.
struct Axes {
  explicit Axes(const Vec3& normal) : u(normal.unitOrthogonal()), v(normal.cross(u)) {}
  Vec3 u, v;
  [[nodiscard]] Vec2 operator()(const Vec3& p) const { return {u.dot(p), v.dot(p)}; }
};

using Polygon = std::vector<Vec2>;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The convex hull of points of a plane, counterclockwise (monotone chain).
Polygon hull_of(Polygon points) {
  std::ranges::sort(points, [](const Vec2& a, const Vec2& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  Polygon hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= first + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    if (!hull.empty()) hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

/// A face in a plane's coordinates.
Polygon flattened(const Face& face, const Axes& axes) {
  Polygon points;
  for (const Vec3& corner : face.corners) points.push_back(axes(corner));
  return hull_of(std::move(points));
}

/// The common part of two convex polygons, counterclockwise (Sutherland and Hodgman 1974).
Polygon common_part(Polygon a, const Polygon& b) {
  for (std::size_t i = 0; i < b.size() && !a.empty(); ++i) {
    const Vec2& from = b[i];
    const Vec2 along = b[(i + 1) % b.size()] - b[i];
    Polygon kept;
    for (std::size_t k = 0; k < a.size(); ++k) {
      const Vec2 &p = a[k], &q = a[(k + 1) % a.size()];
      const double at_p = cross(along, p - from), at_q = cross(along, q - from);
      if (at_p >= 0) kept.push_back(p);
      if ((at_p >= 0) != (at_q >= 0)) kept.emplace_back(p + at_p / (at_p - at_q) * (q - p));
    }
    a = std::move(kept);
  }
  return a;
}

struct Middle {
  Vec2 place = Vec2::Zero();
  double area = 0;
};

Middle middle_of(const Polygon& polygon) {
  Middle out;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const double area = 0.5 * cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
    out.place += area / 3 * (polygon[0] + polygon[i] + polygon[i + 1]);
    out.area += area;
  }
  if (out.area > 0) out.place /= out.area;
  return out;
}

/// How far a ray from a point within a convex polygon reaches.
double reach_within(const Polygon& polygon, const Vec2& from, const Vec2& along) {
  double out = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    const double falls = cross(edge, along);
    if (falls < 0) out = std::min(out, cross(edge, from - polygon[i]) / -falls);
  }
  return std::isfinite(out) ? std::max(out, 0.0) : 0;
}

/// Along the longest edge.
Vec2 longest_edge(const Polygon& polygon) {
  Vec2 out = Vec2::UnitX();
  double longest = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (edge.norm() > longest * (1 + kNothing)) {
      longest = edge.norm();
      out = edge / longest;
    }
  }
  return out;
}

/// Where a tool may hold an object: part of a face, or of two that face each other.
struct Hold {
  Vec3 middle;
  Vec3 normal;    ///< of the first face
  Polygon where;  ///< along `axes`
  Axes axes;
  double area = 0;
};

/// Places where tools may hold an object, the largest first.
std::vector<Hold> holds_of(const Faces& faces, const GraspRequest& request) {
  std::vector<Hold> out;
  const std::vector<Face>& all = faces.all();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Face& first = all[i];
    const Axes axes(first.normal);
    const Polygon own = flattened(first, axes);
    const auto add = [&](const Polygon& where, double level, const Face* second) {
      const Middle middle = middle_of(where);
      if (!(middle.area > kNothing * faces.size() * faces.size())) return;
      const Vec3 place = middle.place.x() * axes.u + middle.place.y() * axes.v;
      if (faces.is_covered(first, place + first.offset * first.normal)) return;
      if (second != nullptr && faces.is_covered(*second, place - second->offset * first.normal))
        return;
      out.push_back({place + level * first.normal, first.normal, where, axes, middle.area});
    };
    if (request.hold == GraspRequest::Hold::Face) {
      add(own, first.offset, nullptr);
      continue;
    }
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      const Face& second = all[j];
      if (second.normal.dot(first.normal) > 0 ||
          second.normal.cross(first.normal).norm() > kParallel)
        continue;
      const double thickness = first.offset + second.offset;
      if (!(thickness > kNothing * faces.size() && thickness <= request.opening)) continue;
      add(common_part(own, flattened(second, axes)), 0.5 * (first.offset - second.offset), &second);
    }
  }
  std::ranges::stable_sort(
      out, [](const Hold& a, const Hold& b) { return a.area > b.area * (1 + kNothing); });
  return out;
}

/// What moves with a link: the links fixed to it, and all that they carry.
/// @param only_fixed  without what joints move
std::vector<bool> moving_with(const robot::Robot& robot, std::uint32_t link, bool only_fixed) {
  const auto is_fixed = [&](std::size_t joint) {
    return robot.joints[joint].type == robot::JointType::Fixed;
  };
  while (link > 0 && is_fixed(link - 1)) link = robot.joints[link - 1].parent;
  std::vector<bool> out(robot.links.size(), false);
  out[link] = true;
  for (std::size_t i = link; i < robot.joints.size(); ++i)
    out[i + 1] = out[i + 1] || (out[robot.joints[i].parent] && (!only_fixed || is_fixed(i)));
  return out;
}

/// The largest ε of what is fixed to a link.
double epsilon_at(const world::RobotModel& robot, std::uint32_t link) {
  const std::vector<bool> fixed = moving_with(robot.kinematics, link, true);
  double out = 0;
  for (const world::LinkShape& shape : robot.shapes)
    if (fixed[shape.link]) out = std::max(out, shape.outer.epsilon());
  return out;
}

/// Tries grasps of an object in the hand, away from all else.
class Hand {
 public:
  Hand(const world::World& world, std::size_t object, std::size_t robot,
       const world::ToolFrame& tool)
      : world_(world),
        object_(object),
        robot_(robot),
        checker_(world),
        state_(initial_state(world)),
        hand_(moving_with(world.robots[robot].kinematics, tool.link, false)) {
    state_.absent.assign(world.objects.size(), true);
    state_.absent[object] = false;
    state_.absent_robots.assign(world.robots.size(), true);
    state_.absent_robots[robot] = false;
    for (auto& attachment : state_.attachments) attachment.reset();
    const world::RobotModel& model = world.robots[robot];
    tool_ = model.base * robot::forward(model.kinematics, model.home)[tool.link] * tool.pose;
  }

  /// A link of the hand that the object is in contact with; nullopt: none.
  std::optional<std::string> contact_at(const Transform& grasp) {
    state_.poses[object_] = tool_ * grasp;
    for (const world::Contact& contact :
         checker_.find_contacts(state_, scratch_, world::Checker::Options{})) {
      for (const auto& [a, b] : {std::pair(contact.items[0], contact.items[1]),
                                 std::pair(contact.items[1], contact.items[0])}) {
        if (a != world::Item{world::Item::kObject, object_} || b.robot != robot_) continue;
        if (hand_[world_.robots[robot_].shapes[b.index].link]) return world_.name_of(b);
      }
    }
    return std::nullopt;
  }

  /// The part of the hand whose contact with the object is not looked at.
  struct Unchecked {
    std::vector<std::string> links;  ///< without a set, or with an allowed contact
    bool all = true;
  };
  [[nodiscard]] Unchecked unchecked() const {
    Unchecked out;
    const world::RobotModel& model = world_.robots[robot_];
    const world::Item object{world::Item::kObject, object_};
    for (std::uint32_t link = 0; link < hand_.size(); ++link) {
      if (!hand_[link]) continue;
      bool looked_at = false, has_set = false;
      for (std::size_t s = 0; s < model.shapes.size(); ++s) {
        if (model.shapes[s].link != link) continue;
        has_set = true;
        const world::Item shape{robot_, s};
        looked_at = looked_at || std::ranges::none_of(world_.allowed, [&](const auto& pair) {
                      return pair == std::array{object, shape} || pair == std::array{shape, object};
                    });
      }
      if (looked_at)
        out.all = false;
      else if (has_set || !model.kinematics.links[link].collision.empty())
        out.links.push_back(model.name + "/" + model.kinematics.links[link].name);
    }
    return out;
  }

 private:
  const world::World& world_;
  std::size_t object_, robot_;
  world::Checker checker_;
  world::Scratch scratch_;
  world::WorldState state_;
  std::vector<bool> hand_;
  Transform tool_;
};

/// The angles of n directions evenly round a circle, such that the first ones are far apart. [rad]
std::vector<double> angles_round(std::size_t n) {
  std::vector<double> out{0};
  std::vector<bool> taken(n, false);
  taken[0] = true;
  for (std::size_t step = n; out.size() < n;) {
    step = std::max<std::size_t>(1, (step + 1) / 2);
    for (std::size_t i = 0; i < n; i += step) {
      if (!taken[i])
        out.push_back(2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n));
      taken[i] = true;
    }
  }
  return out;
}

/// As people read it: what is only rounding is 0.
double plain(double x, double size) { return std::abs(x) < 1e-15 * size ? 0 : x; }

Vec3 plain(const Vec3& v, double size) {
  return {plain(v.x(), size), plain(v.y(), size), plain(v.z(), size)};
}

Json numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// A pose by the numbers that a scene states.
struct StatedPose {
  Vec3 position;
  Eigen::Quaterniond turn;

  /// As scenes are read.
  [[nodiscard]] Transform pose() const {
    Transform out;
    out.translation = position;
    if (!turn.vec().isZero(0)) out.linear = turn.normalized().toRotationMatrix();
    return out;
  }
};

/// The pose of the object in the tool's frame, where the tool's axes and origin are given in the
/// object's. @param size  of the object
StatedPose grasp_of(const Vec3& approach, const Vec3& closing, GraspRequest::Axis axis,
                    const Vec3& origin, double size) {
  Eigen::Matrix3d tool;
  const Vec3 other =
      axis == GraspRequest::Axis::X ? Vec3(approach.cross(closing)) : Vec3(closing.cross(approach));
  tool.col(axis == GraspRequest::Axis::X ? 0 : 1) = closing;
  tool.col(axis == GraspRequest::Axis::X ? 1 : 0) = other;
  tool.col(2) = approach;
  const Eigen::Quaterniond q(Eigen::Matrix3d(tool.transpose()));
  return {plain(-(tool.transpose() * origin), size),
          {plain(q.w(), 1), plain(q.x(), 1), plain(q.y(), 1), plain(q.z(), 1)}};
}

std::vector<std::size_t> objects_named(const world::World& world,
                                       const std::vector<std::string>& names) {
  std::vector<std::size_t> out;
  std::vector<std::string> known;
  for (const world::Object& object : world.objects) known.push_back(object.name);
  for (const std::string& name : names) {
    const auto found = world.find_object(name);
    if (!found)
      throw Error(ErrorCode::InvalidArgument,
                  "the scene has no object '" + name + "'" + did_you_mean(name, known));
    if (std::ranges::find(out, *found) == out.end()) out.push_back(*found);
  }
  if (names.empty())
    for (std::size_t i = 0; i < world.objects.size(); ++i) out.push_back(i);
  if (out.empty()) throw Error(ErrorCode::InvalidInput, "the scene has no objects");
  return out;
}

/// Calls `work`; its errors name the scene.
template <typename Work>
auto naming(const std::filesystem::path& scene, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Error(error.code(), scene.string() + ": " + error.what());
  }
}

/// The entries of a list that are of a kind.
template <typename Of>
Json entries_of(const Json& list, const Of& of) {
  Json out = Json::array();
  for (const Json& one : list)
    if (of(one)) out.push_back(one);
  return out;
}

/// A list with other entries in the place of those of a kind; at its end where it has none.
template <typename Of>
Json with_replaced(const Json& list, const Of& of, const Json& by) {
  Json out = Json::array();
  const auto first = std::find_if(list.begin(), list.end(), of);
  for (auto one = list.begin();; ++one) {
    if (one == first) out.insert(out.end(), by.begin(), by.end());
    if (one == list.end()) return out;
    if (!of(*one)) out.push_back(*one);
  }
}

std::vector<std::string> names_of(const Json& entries) {
  std::vector<std::string> out;
  for (const Json& one : entries) out.push_back(one.at("name").get<std::string>());
  return out;
}

/// A scene that gets entries in a list of its objects.
class SceneEdit {
 public:
  explicit SceneEdit(std::filesystem::path scene) : scene_(std::move(scene)) {
    const std::vector<char> bytes = io::read_file(scene_);
    const std::string_view text(bytes.data(), bytes.size());
    world_ = world::parse_scene(
        text, scene_.string(),
        [&](const std::string& file) { return io::read_file(scene_.parent_path() / file); },
        &notes_);
    json_ = Json::parse(world::scene_as_json(text, scene_.string()));
  }

  [[nodiscard]] const world::World& world() const { return world_; }

  /// Calls derive(object, entries, added) for each object that is named: it changes the entries of
  /// the list, and says what was added. Writes the scene where something has changed.
  template <typename Derive>
  AddedFeatures run(const std::vector<std::string>& objects, const char* list,
                    const Derive& derive) {
    AddedFeatures out;
    out.notes = notes_.notes;
    bool changed = false;
    for (const std::size_t object :
         naming(scene_, [&] { return objects_named(world(), objects); })) {
      AddedFeatures::OfObject& added = out.objects.emplace_back();
      added.object = world().objects[object].name;
      Json& entry = entry_of(added.object);
      const Json before = entry.value(list, Json::array());
      Json after = before;
      naming(scene_, [&] { derive(object, after, added); });
      if (after == before) continue;
      require_attached_kept(added.object, before, after);
      changed = true;
      entry[list] = std::move(after);
    }
    if (changed) write();
    return out;
  }

 private:
  Json& entry_of(const std::string& object) {
    for (Json& entry : json_["objects"])
      if (entry.at("name") == object) return entry;
    throw Error(ErrorCode::Internal, "an object that was read is in the scene");
  }

  void write() const try { SetMaker(scene_).write(json_); } catch (const Error& error) {
    // As of points that constraints name: the place is one of a text that nobody has.
    if (error.code() != ErrorCode::InvalidInput) throw;
    throw Error(error.code(), scene_.string() +
                                  ": nothing is written, as the scene would be refused with what "
                                  "is derived: " +
                                  error.what());
  }

  /// Refuses to move an object that is attached by one of its grasps.
  void require_attached_kept(const std::string& object, const Json& before,
                             const Json& after) const {
    if (!json_.contains("attachments")) return;
    for (const Json& attachment : json_.at("attachments")) {
      if (attachment.at("object") != object || !attachment.contains("grasp")) continue;
      const Json& name = attachment.at("grasp");
      const auto is_it = [&](const Json& one) { return one.at("name") == name; };
      const Json then = entries_of(before, is_it), now = entries_of(after, is_it);
      if (then == now) continue;
      throw Error(ErrorCode::InvalidInput,
                  scene_.string() + ": the attachment of object '" + object +
                      "' names its grasp '" + name.get<std::string>() +
                      "', which deriving grasps again would " +
                      (now.empty() ? "take out" : "change") +
                      "; give that grasp a name that is not derived, or state the pose in the "
                      "attachment");
    }
  }

  std::filesystem::path scene_;
  world::World world_;
  world::SceneNotes notes_;
  Json json_;
};

const char* word_of(GraspRequest::Hold hold) {
  return hold == GraspRequest::Hold::Sides ? "side" : "face";
}

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// "top", "top2", …
bool is_top(std::string_view name) {
  return name == "top" || (name.starts_with("top") && is_number(name.substr(3)));
}

bool is_round(const collide::BoundingSet& set) {
  for (std::size_t i = 0; i < set.size(); ++i)
    if (!set.body(i).core.triangles.empty()) return false;
  return true;
}

std::string why_none(const DerivedGrasps& found, const GraspRequest& request,
                     const collide::BoundingSet& set) {
  const bool sides = request.hold == GraspRequest::Hold::Sides;
  if (is_round(set)) return "it is round: it has no flat face";
  if (found.faces == 0)
    return sides ? "no two parallel faces face each other" +
                       std::string(std::isfinite(request.opening) ? " within the opening" : "")
                 : "no face is uncovered";
  return "the hand is in contact at each of the " + std::to_string(found.in_contact) +
         " that were tried: " + found.contact +
         (sides ? "; fingers that may touch it need an allowed contact" : "");
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

/// Grasps by the numbers that a scene states: these are the poses that are decided.
std::vector<StatedPose> poses_of_grasps(const world::World& world, std::size_t object,
                                        const GraspRequest& request, DerivedGrasps& out) {
  if (request.directions == 0)
    throw Error(ErrorCode::InvalidArgument, "«directions» must be at least 1");
  const std::size_t r = robot_named(world, request.robot);
  const world::ToolFrame& tool = tool_named(world.robots[r], request.tool);
  const collide::BoundingSet& set = world.objects.at(object).outer;
  const double size = set.box().diagonal();
  const std::vector<Hold> holds = holds_of(Faces(set), request);
  const bool sides = request.hold == GraspRequest::Hold::Sides;
  const double gap = request.gap + set.epsilon() + epsilon_at(world.robots[r], tool.link);
  Hand hand(world, object, r, tool);
  const Hand::Unchecked unchecked = hand.unchecked();
  out.unchecked = unchecked.links;
  out.hand_unchecked = unchecked.all;
  out.faces = holds.size();
  std::vector<StatedPose> poses;
  // The first direction of each hold, then the second …: the first grasps differ most.
  for (const double angle : angles_round(request.directions)) {
    for (const Hold& hold : holds) {
      if (poses.size() >= request.most) return poses;
      const Vec2 edge = longest_edge(hold.where);
      // Across the longest edge first.
      const Vec2 across(-edge.y(), edge.x());
      const Vec2 turned = std::cos(angle) * across + std::sin(angle) * edge;
      const Vec3 direction = turned.x() * hold.axes.u + turned.y() * hold.axes.v;
      std::optional<std::string> contact;
      const auto is_free = [&](const StatedPose& grasp) {
        contact = hand.contact_at(grasp.pose());
        if (!contact) poses.push_back(grasp);
        return !contact;
      };
      if (sides) {
        const double room = reach_within(hold.where, hold.axes(hold.middle), -turned);
        for (const double share : kShares)
          if (is_free(grasp_of(direction, hold.normal, request.closing,
                               hold.middle - share * room * direction, size)))
            break;
      } else {
        is_free(grasp_of(-hold.normal, direction, request.closing, hold.middle + gap * hold.normal,
                         size));
      }
      if (!contact) continue;
      ++out.in_contact;
      if (out.contact.empty()) out.contact = *contact;
    }
  }
  return poses;
}

std::string prefix_of(const std::string& tool, GraspRequest::Hold hold) {
  return tool + "/" + word_of(hold) + "-";
}

/// Another robot with a tool of that name; null: none.
const world::RobotModel* other_with_tool(const world::World& world, std::size_t robot,
                                         const std::string& tool) {
  for (std::size_t r = 0; r < world.robots.size(); ++r)
    if (r != robot && std::ranges::any_of(world.robots[r].tools,
                                          [&](const auto& other) { return other.name == tool; }))
      return &world.robots[r];
  return nullptr;
}

/// Where an object is at first, from its frame to the world.
Transform pose_at_first(const world::World& world, std::size_t object) {
  const world::Object& thing = world.objects.at(object);
  if (object >= world.attachments.size() || !world.attachments[object]) return thing.pose;
  const world::Attachment& held = *world.attachments[object];
  const world::RobotModel& robot = world.robots[held.robot];
  return robot.base * robot::forward(robot.kinematics, robot.home)[held.link] * held.pose;
}

}  // namespace

DerivedGrasps derive_grasps(const world::World& world, std::size_t object,
                            const GraspRequest& request) {
  DerivedGrasps out;
  const std::vector<StatedPose> poses = poses_of_grasps(world, object, request, out);
  const std::string prefix = prefix_of(
      tool_named(world.robots[robot_named(world, request.robot)], request.tool).name, request.hold);
  for (const StatedPose& pose : poses)
    out.grasps.push_back({prefix + std::to_string(out.grasps.size() + 1), pose.pose()});
  return out;
}

std::vector<world::Feature> derive_places(const world::World& world, std::size_t object,
                                          const PlaceRequest& request) {
  const world::Object& thing = world.objects.at(object);
  const Faces faces(thing.outer);
  const Vec3 up = pose_at_first(world, object).linear.transpose() * Vec3::UnitZ();
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < thing.outer.size(); ++i)
    for (const Vec3& corner : thing.outer.body(i).core.vertices)
      lowest = std::min(lowest, up.dot(corner) - thing.outer.body(i).radius);
  struct Top {
    Vec3 place;
    double area;
  };
  Vec3 bottom = Vec3::Zero();
  double below = 0;
  std::vector<Top> tops;
  for (const Face& face : faces.all()) {
    if (face.normal.cross(up).norm() > kParallel) continue;
    const Axes axes(face.normal);
    const Middle middle = middle_of(flattened(face, axes));
    if (!(middle.area > kNothing * faces.size() * faces.size())) continue;
    const Vec3 place =
        middle.place.x() * axes.u + middle.place.y() * axes.v + face.offset * face.normal;
    if (face.normal.dot(up) > 0) {
      if (!faces.is_covered(face, place)) tops.push_back({place, middle.area});
    } else if (up.dot(place) < lowest + 1e-3 * faces.size()) {
      bottom += middle.area * place;
      below += middle.area;
    }
  }
  std::ranges::stable_sort(
      tops, [](const Top& a, const Top& b) { return a.area > b.area * (1 + kNothing); });
  std::vector<world::Feature> out;
  if (below > 0) {
    // At the lowest: what stands on it does not sink in.
    bottom /= below;
    out.push_back({"bottom", world::Feature::Kind::Point, bottom + (lowest - up.dot(bottom)) * up,
                   Vec3::Zero()});
  }
  for (std::size_t i = 0; i < std::min(request.most, tops.size()); ++i)
    out.push_back({i == 0 ? "top" : "top" + std::to_string(i + 1), world::Feature::Kind::Point,
                   tops[i].place, Vec3::Zero()});
  return out;
}

AddedFeatures add_grasps(const std::filesystem::path& scene,
                         const std::vector<std::string>& objects, const GraspRequest& request) {
  SceneEdit edit(scene);
  const world::World& world = edit.world();
  const std::size_t r = naming(scene, [&] { return robot_named(world, request.robot); });
  const std::string tool =
      naming(scene, [&] { return tool_named(world.robots[r], request.tool).name; });
  const std::string prefix = prefix_of(tool, request.hold);
  const world::RobotModel* other = other_with_tool(world, r, tool);
  AddedFeatures out = edit.run(
      objects, "grasps", [&](std::size_t object, Json& list, AddedFeatures::OfObject& added) {
        DerivedGrasps found;
        Json derived = Json::array();
        for (const StatedPose& pose : poses_of_grasps(world, object, request, found)) {
          added.names.push_back(prefix + std::to_string(derived.size() + 1));
          derived.push_back(
              {{"name", added.names.back()},
               {"position", numbers(pose.position)},
               {"quaternion", {pose.turn.x(), pose.turn.y(), pose.turn.z(), pose.turn.w()}}});
        }
        const auto is_derived = [&](const Json& one) {
          const auto name = one.at("name").get<std::string>();
          return name.starts_with(prefix) &&
                 is_number(std::string_view(name).substr(prefix.size()));
        };
        const Json before = entries_of(list, is_derived);
        if (derived.empty()) {
          added.shortfall = why_none(found, request, world.objects[object].outer);
          added.kept = names_of(before);
          if (!added.kept.empty()) added.shortfall += "; those derived before are kept";
          return;
        }
        added.unchecked = found.unchecked;
        if (found.hand_unchecked)
          added.shortfall = "whether the hand touches it was not looked at: " +
                            (found.unchecked.empty()
                                 ? "nothing that moves with tool '" + tool + "' has a set"
                                 : joined(found.unchecked) +
                                       ": no set ('links_without_set'), or an allowed contact");
        if (other != nullptr && !before.empty() && before != derived)
          throw Error(ErrorCode::InvalidInput,
                      "object '" + added.object + "' has grasps " + prefix +
                          "1, …, which may be those of robot '" + other->name +
                          "', whose tool is called '" + tool +
                          "', too: call one of the tools otherwise, or take these grasps out of "
                          "the scene");
        list = with_replaced(list, is_derived, derived);
      });
  if (other != nullptr)
    out.notes.push_back("robot '" + other->name + "' has a tool '" + tool +
                        "', too: planners take these grasps for those of both, so that the tools "
                        "need different names unless their hands are the same");
  if (request.hold == GraspRequest::Hold::Sides && !std::isfinite(request.opening))
    out.notes.push_back(
        "how far the fingers open was not stated («opening»): faces are taken "
        "however far apart they are");
  return out;
}

AddedFeatures add_places(const std::filesystem::path& scene,
                         const std::vector<std::string>& objects, const PlaceRequest& request) {
  SceneEdit edit(scene);
  const world::World& world = edit.world();
  AddedFeatures out = edit.run(
      objects, "features", [&](std::size_t object, Json& list, AddedFeatures::OfObject& added) {
        const auto is_point = [](const Json& one, bool top) {
          const auto name = one.at("name").get<std::string>();
          return one.contains("point") && (top ? is_top(name) : name == "bottom");
        };
        const std::vector<world::Feature> found = derive_places(world, object, request);
        const double size = world.objects[object].outer.box().diagonal();
        for (const bool top : {false, true}) {
          const bool any = std::ranges::any_of(
              found, [&](const world::Feature& feature) { return is_top(feature.name) == top; });
          // Nothing takes the place of what is not found.
          const auto same = [&](const Json& one) { return is_point(one, top); };
          const std::vector<std::string> has = names_of(entries_of(list, same));
          if (!has.empty() && (!request.replace || !any)) {
            added.kept.insert(added.kept.end(), has.begin(), has.end());
            if (request.replace)
              added.shortfall += std::string(added.shortfall.empty() ? "" : "; ") +
                                 (top ? "no face looks up" : "it stands on no face") + ": '" +
                                 has.front() + "' is kept";
            continue;
          }
          if (!any) {
            added.shortfall +=
                std::string(added.shortfall.empty() ? "" : "; ") +
                (top ? "no face looks up" : "it stands on no face, so that it has no bottom");
            continue;
          }
          Json derived = Json::array();
          for (const world::Feature& feature : found) {
            if (is_top(feature.name) != top) continue;
            derived.push_back(
                {{"name", feature.name}, {"point", numbers(plain(feature.point, size))}});
            added.names.push_back(feature.name);
          }
          list = with_replaced(list, same, derived);
        }
      });
  for (const AddedFeatures::OfObject& object : out.objects)
    if (!object.kept.empty() && !request.replace)
      out.notes.push_back("object '" + object.object +
                          "': the points that it has are kept; «force» replaces them");
  return out;
}

const std::vector<Option<GraspRequest>>& grasp_options() {
  using R = GraspRequest;
  static const std::vector<std::pair<const char*, R::Hold>> holds{{"sides", R::Hold::Sides},
                                                                  {"face", R::Hold::Face}};
  static const std::vector<std::pair<const char*, R::Axis>> axes{{"x", R::Axis::X},
                                                                 {"y", R::Axis::Y}};
  static const std::vector<Option<R>> options{
      option<R>(
          {.name = "robot", .text = "Which robot", .values = "NAME", .otherwise = "the only one"},
          [](auto& r) -> auto& { return r.robot; }),
      option<R>(
          {.name = "tool",
           .text = "Which tool of it: it approaches along its z axis, and the tips of its "
                   "fingers are at its origin",
           .values = "NAME",
           .otherwise = "the only one"},
          [](auto& r) -> auto& { return r.tool; }),
      choice<R>(
          {.name = "hold",
           .text = "Hold two parallel faces with fingers (sides), or one by suction (face)"},
          [](auto& r) -> auto& { return r.hold; }, holds),
      choice<R>(
          {.name = "closing", .text = "Axis of the tool along which its fingers close"},
          [](auto& r) -> auto& { return r.closing; }, axes),
      option<R>(
          {.name = "opening",
           .text = "Largest distance between two faces: how far the fingers open",
           .values = "LENGTH",
           .low = 0,
           .between = true,
           .absolute = true,
           .otherwise = "any"},
          [](auto& r) -> auto& { return r.opening; }),
      option<R>(
          {.name = "directions",
           .text = "Directions of approach, evenly round the axis of closing; of suction, "
                   "turns about the approach",
           .low = 1,
           .high = 360},
          [](auto& r) -> auto& { return r.directions; }),
      option<R>(
          {.name = "most", .text = "Most grasps of an object", .low = 1, .high = 1000},
          [](auto& r) -> auto& { return r.most; }),
      option<R>(
          {.name = "gap",
           .text = "From the tool to the face that it holds by suction, beyond the sets' "
                   "epsilon",
           .low = 0,
           .high = 1e9,
           .absolute = true},
          [](auto& r) -> auto& { return r.gap; })};
  return options;
}

const std::vector<Option<PlaceRequest>>& place_options() {
  using R = PlaceRequest;
  static const std::vector<Option<R>> options{
      option<R>(
          {.name = "most",
           .text = "Most points on top of an object: top, top2, …",
           .low = 1,
           .high = 100},
          [](auto& r) -> auto& { return r.most; }),
      option<R>(
          {.name = "force", .text = "Replace points of these names that the scene has"},
          [](auto& r) -> auto& { return r.replace; })};
  return options;
}

}  // namespace kaboum::scene
