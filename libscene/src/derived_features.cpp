// Grasps and places derived from convex sets: faces, pairs of faces, and what the hand allows.

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/geom/body_polytopes.h>
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

/// A face of a convex body.
struct Face {
  std::size_t body = 0;
  Vec3 normal;
  double offset = 0;          ///< normal · x of its points
  std::vector<Vec3> corners;  ///< of its triangles; some are there twice
};

/// A set's faces, and its bodies as half-spaces.
class Faces {
 public:
  explicit Faces(const collide::BoundingSet& set)
      : size_(set.box().diagonal()), first_of_(set.size() + 1, 0) {
    for (std::size_t i = 0; i < set.size(); ++i) {
      first_of_[i] = all_.size();
      add(geom::surface_of(set.body(i)), i);
    }
    first_of_[set.size()] = all_.size();
  }

  [[nodiscard]] const std::vector<Face>& all() const { return all_; }
  [[nodiscard]] double size() const { return size_; }

  /// True if the point just outside of a face is in another body.
  [[nodiscard]] bool is_covered(const Face& face, const Vec3& point) const {
    const Vec3 outside = point + 1e-6 * size_ * face.normal;
    for (std::size_t body = 0; body + 1 < first_of_.size(); ++body) {
      if (body == face.body) continue;
      const auto begin = all_.begin() + static_cast<std::ptrdiff_t>(first_of_[body]);
      const auto end = all_.begin() + static_cast<std::ptrdiff_t>(first_of_[body + 1]);
      if (std::all_of(begin, end, [&](const Face& f) { return f.normal.dot(outside) < f.offset; }))
        return true;
    }
    return false;
  }

 private:
  void add(const geom::Mesh& mesh, std::size_t body) {
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
      if (face.corners.empty()) face = {body, normal, normal.dot(a), {}};
      face.corners.insert(face.corners.end(), {a, b, c});
    }
  }

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

/// What moves with a tool: the links fixed to its link, and all that they carry.
std::vector<bool> hand_of(const robot::Robot& robot, std::uint32_t link) {
  while (link > 0 && robot.joints[link - 1].type == robot::JointType::Fixed)
    link = robot.joints[link - 1].parent;
  std::vector<bool> out(robot.links.size(), false);
  out[link] = true;
  for (std::size_t i = link; i < robot.joints.size(); ++i)
    out[i + 1] = out[i + 1] || out[robot.joints[i].parent];
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
        hand_(hand_of(world.robots[robot].kinematics, tool.link)) {
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

/// The pose of the object in the tool's frame, where the tool's axes and origin are given in the
/// object's.
Transform grasp_of(const Vec3& approach, const Vec3& closing, GraspRequest::Axis axis,
                   const Vec3& origin) {
  Transform tool;
  const Vec3 other =
      axis == GraspRequest::Axis::X ? Vec3(approach.cross(closing)) : Vec3(closing.cross(approach));
  tool.linear.col(axis == GraspRequest::Axis::X ? 0 : 1) = closing;
  tool.linear.col(axis == GraspRequest::Axis::X ? 1 : 0) = other;
  tool.linear.col(2) = approach;
  return {tool.linear.transpose(), -(tool.linear.transpose() * origin)};
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

/// As people read it: what is only rounding is 0.
double plain(double x, double size) { return std::abs(x) < 1e-15 * size ? 0 : x; }

Json numbers(const Vec3& v, double size) {
  return {plain(v.x(), size), plain(v.y(), size), plain(v.z(), size)};
}

/// A scene that gets entries in a list of its objects.
class SceneEdit {
 public:
  explicit SceneEdit(const std::filesystem::path& scene)
      : scene_(scene), file_(world::read_scene(scene.string())) {
    const std::vector<char> bytes = io::read_file(scene);
    json_ = Json::parse(world::scene_as_json({bytes.data(), bytes.size()}, scene.string()));
  }

  [[nodiscard]] const world::World& world() const { return file_.world; }

  /// Calls derive(object, entries, added) for each object that is named: it changes the entries of
  /// the list, and says what was added. Writes the scene where something has changed.
  template <typename Derive>
  AddedFeatures run(const std::vector<std::string>& objects, const char* list,
                    const Derive& derive) {
    AddedFeatures out;
    out.notes = file_.notes;
    bool changed = false;
    for (const std::size_t object : objects_named(world(), objects)) {
      AddedFeatures::OfObject& added = out.objects.emplace_back();
      added.object = world().objects[object].name;
      Json& entry = entry_of(added.object);
      const Json before = entry.value(list, Json::array());
      Json after = before;
      derive(object, after, added);
      if (after == before) continue;
      changed = true;
      entry[list] = std::move(after);
    }
    if (changed) SetMaker(scene_).write(json_);
    return out;
  }

 private:
  Json& entry_of(const std::string& object) {
    for (Json& entry : json_["objects"])
      if (entry.at("name") == object) return entry;
    throw Error(ErrorCode::Internal, "an object that was read is in the scene");
  }

  std::filesystem::path scene_;
  world::SceneFile file_;
  Json json_;
};

/// Takes entries out of a list.
template <typename Old>
void erase_entries(Json& list, const Old& old) {
  Json kept = Json::array();
  for (const Json& one : list)
    if (!old(one)) kept.push_back(one);
  list = std::move(kept);
}

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

std::string why_none(const DerivedGrasps& found, const GraspRequest& request) {
  const bool sides = request.hold == GraspRequest::Hold::Sides;
  if (found.faces == 0)
    return sides ? "no two parallel faces face each other" +
                       std::string(std::isfinite(request.opening) ? " within the opening" : "")
                 : "no face is uncovered";
  return "the hand is in contact at each of the " + std::to_string(found.in_contact) +
         " that were tried: " + found.contact +
         (sides ? "; fingers that may touch it need an allowed contact" : "");
}

}  // namespace

DerivedGrasps derive_grasps(const world::World& world, std::size_t object,
                            const GraspRequest& request) {
  const std::size_t r = robot_named(world, request.robot);
  const world::ToolFrame& tool = tool_named(world.robots[r], request.tool);
  const collide::BoundingSet& set = world.objects.at(object).outer;
  const std::vector<Hold> holds = holds_of(Faces(set), request);
  const bool sides = request.hold == GraspRequest::Hold::Sides;
  double gap = request.gap + set.epsilon();
  for (const world::LinkShape& shape : world.robots[r].shapes)
    if (shape.link == tool.link) gap += shape.outer.epsilon();
  Hand hand(world, object, r, tool);
  DerivedGrasps out;
  out.faces = holds.size();
  // The first direction of each hold, then the second …: the first grasps differ most.
  for (const double angle : angles_round(request.directions)) {
    for (const Hold& hold : holds) {
      if (out.grasps.size() >= request.most) return out;
      const Vec2 edge = longest_edge(hold.where);
      // Across the longest edge first.
      const Vec2 across(-edge.y(), edge.x());
      const Vec2 turned = std::cos(angle) * across + std::sin(angle) * edge;
      const Vec3 direction = turned.x() * hold.axes.u + turned.y() * hold.axes.v;
      std::optional<std::string> contact;
      if (sides) {
        const double room = reach_within(hold.where, hold.axes(hold.middle), -turned);
        for (const double share : kShares) {
          const Transform grasp = grasp_of(direction, hold.normal, request.closing,
                                           hold.middle - share * room * direction);
          contact = hand.contact_at(grasp);
          if (contact) continue;
          out.grasps.push_back({{}, grasp});
          break;
        }
      } else {
        const Transform grasp =
            grasp_of(-hold.normal, direction, request.closing, hold.middle + gap * hold.normal);
        contact = hand.contact_at(grasp);
        if (!contact) out.grasps.push_back({{}, grasp});
      }
      if (contact) {
        ++out.in_contact;
        if (out.contact.empty()) out.contact = *contact;
      } else {
        out.grasps.back().name =
            tool.name + "/" + word_of(request.hold) + "-" + std::to_string(out.grasps.size());
      }
    }
  }
  return out;
}

std::vector<world::Feature> derive_places(const world::World& world, std::size_t object,
                                          const PlaceRequest& request) {
  const world::Object& thing = world.objects.at(object);
  const Faces faces(thing.outer);
  const Vec3 up = thing.pose.linear.transpose() * Vec3::UnitZ();
  double lowest = std::numeric_limits<double>::infinity();
  for (const Face& face : faces.all())
    for (const Vec3& corner : face.corners) lowest = std::min(lowest, up.dot(corner));
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
  const world::ToolFrame& tool =
      tool_named(world.robots[robot_named(world, request.robot)], request.tool);
  const std::string prefix = tool.name + "/" + word_of(request.hold) + "-";
  return edit.run(
      objects, "grasps", [&](std::size_t object, Json& list, AddedFeatures::OfObject& added) {
        const DerivedGrasps found = derive_grasps(world, object, request);
        if (found.grasps.empty()) added.shortfall = why_none(found, request);
        erase_entries(list, [&](const Json& one) {
          const std::string of = one.value("name", "");
          return of.starts_with(prefix) && is_number(std::string_view(of).substr(prefix.size()));
        });
        const double size = world.objects[object].outer.box().diagonal();
        for (const world::Grasp& grasp : found.grasps) {
          const Eigen::Quaterniond q(grasp.pose.linear);
          list.push_back({{"name", grasp.name},
                          {"position", numbers(grasp.pose.translation, size)},
                          {"quaternion",
                           {plain(q.x(), 1), plain(q.y(), 1), plain(q.z(), 1), plain(q.w(), 1)}}});
          added.names.push_back(grasp.name);
        }
      });
}

AddedFeatures add_places(const std::filesystem::path& scene,
                         const std::vector<std::string>& objects, const PlaceRequest& request) {
  SceneEdit edit(scene);
  const world::World& world = edit.world();
  std::vector<std::string> kept;
  AddedFeatures out = edit.run(
      objects, "features", [&](std::size_t object, Json& list, AddedFeatures::OfObject& added) {
        const auto is_point = [](const Json& one, bool top) {
          const std::string of = one.value("name", "");
          return one.contains("point") && (top ? is_top(of) : of == "bottom");
        };
        const std::vector<world::Feature> found = derive_places(world, object, request);
        const double size = world.objects[object].outer.box().diagonal();
        for (const bool top : {false, true}) {
          const auto same = [&](const Json& one) { return is_point(one, top); };
          if (request.replace) erase_entries(list, same);
          const bool has = std::any_of(list.begin(), list.end(), same);
          if (has && (kept.empty() || kept.back() != added.object)) kept.push_back(added.object);
          bool any = has;
          for (const world::Feature& feature : found) {
            if (is_top(feature.name) != top) continue;
            any = true;
            if (has) continue;
            list.push_back({{"name", feature.name}, {"point", numbers(feature.point, size)}});
            added.names.push_back(feature.name);
          }
          if (!any)
            added.shortfall +=
                std::string(added.shortfall.empty() ? "" : "; ") +
                (top ? "no face looks up" : "it stands on no face, so that it has no bottom");
        }
      });
  for (const std::string& object : kept)
    out.notes.push_back("object '" + object +
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
