// Grasps and places derived from convex sets: faces, pairs of faces, and what the hand allows.

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/scene/derived_features.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include "faces.h"
#include "grasp_families.h"
#include "hand.h"
#include "round_sides.h"
#include "set_maker.h"
#include "upper_surfaces.h"

namespace kaboum::scene {
namespace {

using geom::Transform;
/// Shares of the way from the middle of two faces to their edge at which a tool is put.
constexpr std::array kShares{0.0, 0.25, 0.5, 0.75, 0.95};
/// Degrees by which a tool that holds a round side comes from above; those of kTilted come last.
constexpr double kTilted = 45;
constexpr std::array kElevations{0.0, 90.0, -90.0, kTilted, -kTilted};
/// Cosine of the angle between an axis and the normals of faces that are parts of its round side.
constexpr double kAlmostAcross = 0.02;
/// Share of an object's size: points that are so near to a surface are on it.
constexpr double kNear = 1e-6;
/// Holds of less than that share of the largest one's area are tried later.
constexpr double kSmallShare = 0.25;

/// Where a tool may hold an object: part of a face, or of two that face each other.
struct Hold {
  const Face* first;
  const Face* second;  ///< null: of one face
  Vec3 middle;
  Vec3 normal;     ///< of the first face
  Polygon2 where;  ///< along `axes`
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
    const Polygon2 own = flattened(first, axes);
    const auto add = [&](const Polygon2& where, double level, const Face* second) {
      const Centroid middle = centroid_of(where);
      if (!(middle.area > kNothing * faces.size() * faces.size())) return;
      const Vec3 place = middle.place.x() * axes.u + middle.place.y() * axes.v;
      out.push_back(
          {&first, second, place + level * first.normal, first.normal, where, axes, middle.area});
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

/// True if another body covers the middle of a face that is held.
bool is_covered(const Faces& faces, const Hold& hold) {
  const Vec3 place = hold.middle - hold.normal.dot(hold.middle) * hold.normal;
  return faces.is_covered(*hold.first, place + hold.first->offset * hold.normal) ||
         (hold.second != nullptr &&
          faces.is_covered(*hold.second, place - hold.second->offset * hold.normal));
}

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

bool is_round(const collide::BoundingSet& set) {
  for (std::size_t i = 0; i < set.size(); ++i)
    if (!set.body(i).core.triangles.empty()) return false;
  return true;
}

std::string why_none(const DerivedGrasps& found, const GraspRequest& request,
                     const collide::BoundingSet& set) {
  const bool sides = request.hold == GraspRequest::Hold::Sides;
  const bool families = request.form != GraspRequest::Form::Poses;
  if (is_round(set) && !(sides && families)) return "it is round: it has no flat face";
  if (found.faces == 0 && sides)
    return "no two parallel faces face each other" +
           std::string(families ? ", and no side is round," : "") +
           (std::isfinite(request.opening) ? " within the opening" : "") +
           (request.tip ? " with room for the tips" : "");
  if (found.faces == 0)
    return families && request.tip ? "no face has room for the cup" : "no face is uncovered";
  return "the hand is in contact at each of the " + std::to_string(found.in_contact) +
         " that were tried" + (found.contact.empty() ? "" : ": " + found.contact) +
         (sides ? "; fingers that may touch it need an allowed contact" : "");
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

/// What grasps of an object are derived of.
struct Task {
  const GraspRequest& request;
  const Faces& faces;
  Hand& hand;
  double gap;  ///< from the tool to a face that it holds by suction
  [[nodiscard]] bool is_sides() const { return request.hold == GraspRequest::Hold::Sides; }
};

/// Single poses, in several directions.
std::vector<StatedGrasp> single_poses(const Task& task, DerivedGrasps& out) {
  const GraspRequest& request = task.request;
  std::vector<Hold> holds = holds_of(task.faces, request);
  std::erase_if(holds, [&](const Hold& hold) { return is_covered(task.faces, hold); });
  out.faces = holds.size();
  std::vector<StatedGrasp> poses;
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
      const auto is_free = [&](const ToolPlace& tool) {
        const StatedGrasp grasp = grasp_of(tool, request.closing, task.faces.size());
        contact = task.hand.contact_at(grasp.read().pose);
        if (!contact) poses.push_back(grasp);
        return !contact;
      };
      if (task.is_sides()) {
        const double room = reach_within(hold.where, hold.axes(hold.middle), -turned);
        for (const double share : kShares)
          if (is_free({direction, hold.normal, hold.middle - share * room * direction})) break;
      } else {
        is_free({-hold.normal, direction, hold.middle + task.gap * hold.normal});
      }
      if (!contact) continue;
      ++out.in_contact;
      if (out.contact.empty()) out.contact = *contact;
    }
  }
  return poses;
}

/// Where a tool has something to hold on faces: in a convex polygon, and not where other bodies
/// are.
class Ground {
 public:
  /// @param tip  how far round the tool's origin it needs something to hold
  Ground(const Faces& faces, const Hold& hold, double tip) : tip_(tip), axes_(hold.axes) {
    const Centroid middle = centroid_of(hold.where);
    if (tip > 0) {
      where_ = eroded(hold.where, tip);
    } else {
      for (const Vec2& corner : hold.where)
        where_.emplace_back(middle.place + kShares.back() * (corner - middle.place));
    }
    middle_ = middle.place;
    covers_ = faces.covers(*hold.first, axes_);
    if (hold.second != nullptr)
      for (Polygon2& cover : faces.covers(*hold.second, axes_)) covers_.push_back(std::move(cover));
    along_ = longest_edge(hold.where);
    across_ = Vec2(-along_.y(), along_.x());
  }

  [[nodiscard]] Vec3 along() const { return along_.x() * axes_.u + along_.y() * axes_.v; }
  [[nodiscard]] Vec3 across() const { return across_.x() * axes_.u + across_.y() * axes_.v; }

  /// How far the polygon reaches from the hold's middle, along and across its longest edge; empty
  /// where the tips do not fit.
  [[nodiscard]] MemberBox reach() const {
    MemberBox out;
    if (!(centroid_of(where_).area > 0)) return out;
    for (const Vec2& direction : {along_, across_}) {
      constexpr double kFar = std::numeric_limits<double>::infinity();
      Range range{kFar, -kFar};
      for (const Vec2& corner : where_) {
        range.from = std::min(range.from, direction.dot(corner - middle_));
        range.to = std::max(range.to, direction.dot(corner - middle_));
      }
      out.push_back(range);
    }
    return out;
  }

  /// True if there is something to hold wherever a tool is in a rectangle.
  [[nodiscard]] bool holds(const MemberBox& box, double size) const {
    const double least = kNothing * size;
    for (std::size_t i = 0; i < where_.size(); ++i) {
      const Vec2 edge = where_[(i + 1) % where_.size()] - where_[i];
      if (!(edge.norm() > 0)) continue;
      for (const Vec2& corner : corners(box, 0))
        if (cross(edge.normalized(), corner - where_[i]) < -least) return false;
    }
    const Polygon2 ground = corners(box, tip_ + least);
    return std::ranges::none_of(
        covers_, [&](const Polygon2& cover) { return !common_part(ground, cover).empty(); });
  }

 private:
  [[nodiscard]] Polygon2 corners(const MemberBox& box, double more) const {
    const Range &a = box[0], &b = box[1];
    Polygon2 out;
    for (const auto& [x, y] :
         {std::pair(a.from - more, b.from - more), std::pair(a.to + more, b.from - more),
          std::pair(a.to + more, b.to + more), std::pair(a.from - more, b.to + more)})
      out.emplace_back(middle_ + x * along_ + y * across_);
    return out;
  }

  double tip_;
  Axes axes_;
  Polygon2 where_;
  Vec2 middle_, along_, across_;
  std::vector<Polygon2> covers_;
};

/// Anywhere on faces, turned about their normal; nullopt where the tips do not fit.
std::optional<FreeHold> hold_of(const Task& task, const Hold& hold) {
  const double size = task.faces.size();
  const Ground ground(task.faces, hold, 0.5 * task.request.tip.value_or(0));
  const MemberBox reach = ground.reach();
  if (reach.empty()) return std::nullopt;
  FreeHold out;
  if (task.is_sides())
    out.tool = {ground.across(), hold.normal, hold.middle};
  else
    out.tool = {-hold.normal, ground.across(), hold.middle + task.gap * hold.normal};
  const std::array directions{ground.along(), ground.across()};
  for (std::size_t i = 0; i < 2; ++i)
    out.slides.push_back({directions[i], reach[i].from, reach[i].to});
  out.turn = world::FreeTurn{out.tool.origin, hold.normal};
  out.fits = [ground, size](const MemberBox& box) { return ground.holds(box, size); };
  out.area = hold.area;
  return out;
}

/// Round an axis, between two heights, in one direction of approach after the other.
std::vector<FreeHold> holds_of(const Task& task, const RoundSide& side) {
  std::vector<FreeHold> out;
  const double shorter = task.request.tip ? 0.5 * *task.request.tip
                                          : 0.5 * (1 - kShares.back()) * (side.high - side.low);
  const double half = 0.5 * (side.high - side.low) - shorter;
  if (half < 0) return out;
  const Vec3 outwards = Axes(side.axis).u;
  const Vec3 middle = side.point + 0.5 * (side.low + side.high) * side.axis;
  for (const double degrees : kElevations) {
    const double angle = degrees * std::numbers::pi / 180;
    const Vec3 from = std::cos(angle) * outwards + std::sin(angle) * side.axis;
    FreeHold& hold = out.emplace_back();
    hold.tool = {-from, side.axis.cross(outwards), middle};
    hold.slides.push_back({side.axis, -half, half});
    hold.turn = world::FreeTurn{middle, side.axis};
    hold.fits = [](const MemberBox&) { return true; };
    hold.area = 2 * side.radius * (side.high - side.low);
    if (std::abs(degrees) == kTilted) hold.rank = 1;
  }
  return out;
}

/// True if two faces are opposite parts of a round side.
bool is_part(const Hold& hold, const RoundSide& side) {
  const double thickness = hold.first->offset + hold.second->offset;
  return std::abs(hold.normal.dot(side.axis)) <= kAlmostAcross &&
         std::abs(0.5 * thickness - side.radius) <= side.tolerance &&
         std::abs(hold.normal.dot(hold.middle - side.point)) <= side.tolerance;
}

/// Families: of round sides, and of faces that are no parts of them.
std::vector<StatedGrasp> families(const Task& task, DerivedGrasps& out) {
  const GraspRequest& request = task.request;
  const double size = task.faces.size();
  std::vector<std::vector<StatedGrasp>> found;
  std::size_t tried = 0;
  double largest = 0;
  const auto add = [&](FreeHold hold) {
    ++tried;
    largest = std::max(largest, hold.area);
    if (hold.area < kSmallShare * largest) hold.rank = 1;
    std::vector<StatedGrasp> of_hold = families_of(hold, task.hand, request.closing, size);
    if (of_hold.empty()) {
      ++out.in_contact;
      if (out.contact.empty())
        out.contact = task.hand.contact_at(grasp_of(hold.tool, request.closing, size).read().pose)
                          .value_or("");
      return false;
    }
    found.push_back(std::move(of_hold));
    return true;
  };
  std::vector<RoundSide> held;
  if (task.is_sides())
    for (const RoundSide& side : round_sides_of(task.faces, request.opening)) {
      bool any = false;
      for (const FreeHold& hold : holds_of(task, side)) any = add(hold) || any;
      if (any) held.push_back(side);
    }
  for (const Hold& hold : holds_of(task.faces, request)) {
    if (found.size() >= request.most) break;
    if (std::ranges::any_of(held, [&](const RoundSide& side) { return is_part(hold, side); }))
      continue;
    if (const std::optional<FreeHold> free = hold_of(task, hold)) add(*free);
  }
  out.faces = std::max(out.faces, tried);
  // The first family of each hold, then the second …: the first grasps differ most.
  std::vector<StatedGrasp> in_order;
  for (std::size_t k = 0, any = 1; any > 0; ++k) {
    any = 0;
    for (const std::vector<StatedGrasp>& of_hold : found) {
      if (k >= of_hold.size()) continue;
      ++any;
      if (in_order.size() < request.most) in_order.push_back(of_hold[k]);
    }
  }
  return in_order;
}

/// Grasps by the numbers that a scene states: these are what is decided.
std::vector<StatedGrasp> stated_grasps(const world::World& world, std::size_t object,
                                       const GraspRequest& request, DerivedGrasps& out) {
  if (request.directions == 0)
    throw Error(ErrorCode::InvalidArgument, "«directions» must be at least 1");
  const std::size_t r = robot_named(world, request.robot);
  const world::ToolFrame& tool = tool_named(world.robots[r], request.tool);
  const collide::BoundingSet& set = world.objects.at(object).outer;
  const Faces faces(set);
  Hand hand(world, object, r, tool);
  const Hand::Unchecked unchecked = hand.unchecked();
  out.unchecked = unchecked.links;
  out.hand_unchecked = unchecked.all;
  const Task task{request, faces, hand,
                  request.gap + set.epsilon() + epsilon_at(world.robots[r], tool.link)};
  std::vector<StatedGrasp> grasps;
  if (request.form != GraspRequest::Form::Families) grasps = single_poses(task, out);
  if (request.form == GraspRequest::Form::Poses) return grasps;
  // Single poses, of which planners can tell that none is in reach, are tried first.
  const unsigned later = grasps.empty() ? 0 : 1;
  for (StatedGrasp& family : families(task, out)) {
    family.rank += later;
    grasps.push_back(std::move(family));
  }
  return grasps;
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

/// The middle of the faces on which an object stands, at its lowest: what stands on it does not
/// sink in.
std::optional<Vec3> bottom_of(const Faces& faces, const Vec3& up) {
  const collide::BoundingSet& set = faces.set();
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < set.size(); ++i)
    for (const Vec3& corner : set.body(i).core.vertices)
      lowest = std::min(lowest, up.dot(corner) - set.body(i).radius);
  Vec3 bottom = Vec3::Zero();
  double below = 0;
  for (const Face& face : faces.all()) {
    if (face.normal.dot(up) > 0 || face.normal.cross(up).norm() > kParallel) continue;
    const Axes axes(face.normal);
    const Centroid middle = centroid_of(flattened(face, axes));
    if (!(middle.area > kNothing * faces.size() * faces.size())) continue;
    const Vec3 place =
        middle.place.x() * axes.u + middle.place.y() * axes.v + face.offset * face.normal;
    if (!(up.dot(place) < lowest + 1e-3 * faces.size())) continue;
    bottom += middle.area * place;
    below += middle.area;
  }
  if (!(below > 0)) return std::nullopt;
  bottom /= below;
  return Vec3(bottom + (lowest - up.dot(bottom)) * up);
}

/// Middles of level faces that no other body covers there, the largest first; then those of
/// surfaces on which none of these is.
std::vector<Vec3> tops_of(const Faces& faces, const std::vector<Face>& level,
                          const std::vector<UpperSurface>& surfaces, double epsilon) {
  struct Top {
    Vec3 place;
    double area;
  };
  std::vector<Top> tops;
  for (const Face& face : level) {
    const Axes axes(face.normal);
    const Centroid middle = centroid_of(flattened(face, axes));
    const Vec3 place =
        middle.place.x() * axes.u + middle.place.y() * axes.v + face.offset * face.normal;
    if (!faces.is_covered(face, place)) tops.push_back({place, middle.area});
  }
  std::ranges::stable_sort(
      tops, [](const Top& a, const Top& b) { return a.area > b.area * (1 + kNothing); });
  std::vector<Vec3> out;
  out.reserve(tops.size() + surfaces.size());
  for (const Top& top : tops) out.push_back(top.place);
  const double within = epsilon + kNear * faces.size();
  for (const UpperSurface& surface : surfaces)
    if (std::ranges::none_of(tops,
                             [&](const Top& top) { return is_on(surface, top.place, within); }))
      out.push_back(surface.middle);
  return out;
}

/// "top", "top2", …
std::string numbered(const char* name, std::size_t index) {
  return index == 0 ? name : name + std::to_string(index + 1);
}

bool is_of_other_kind(const world::Object& object, const std::string& name) {
  return std::ranges::any_of(object.features, [&](const world::Feature& feature) {
    return feature.name == name && feature.kind != world::Feature::Kind::Surface;
  });
}

/// A kind of places, of which all are kept or replaced together.
struct PlaceKind {
  const char* name;    ///< of the first one; of others, with a number
  const char* member;  ///< of the scene's entries
  const char* none;    ///< why there are none
  const char* so;      ///< what follows of that, where it is a shortfall
};
constexpr std::array kPlaceKinds{
    PlaceKind{"bottom", "point", "it stands on no face", ", so that it has no bottom"},
    PlaceKind{"top", "point", "no face looks up", ""},
    PlaceKind{"face", "surface", "no face that looks up is wide enough", nullptr}};

bool is_called(std::string_view name, const PlaceKind& kind) {
  const std::string_view first = kind.name;
  return name == first ||
         (name.starts_with(first) && first != "bottom" && is_number(name.substr(first.size())));
}

Json as_json(const world::Feature& feature, double size) {
  Json out = {{"name", feature.name}};
  if (feature.kind == world::Feature::Kind::Point) {
    out["point"] = numbers(plain(feature.point, size));
    return out;
  }
  Json corners = Json::array();
  for (const Vec3& corner : feature.outline) corners.push_back(numbers(plain(corner, size)));
  out["surface"] = {{"outline", std::move(corners)}};
  return out;
}

}  // namespace

Transform pose_at_first(const world::World& world, std::size_t object) {
  const world::Object& thing = world.objects.at(object);
  if (object >= world.attachments.size() || !world.attachments[object]) return thing.pose;
  const world::Attachment& held = *world.attachments[object];
  const world::RobotModel& robot = world.robots[held.robot];
  return robot.base * robot::forward(robot.kinematics, robot.home)[held.link] * held.pose;
}

DerivedGrasps derive_grasps(const world::World& world, std::size_t object,
                            const GraspRequest& request) {
  DerivedGrasps out;
  const std::vector<StatedGrasp> grasps = stated_grasps(world, object, request, out);
  const std::string prefix = prefix_of(
      tool_named(world.robots[robot_named(world, request.robot)], request.tool).name, request.hold);
  for (const StatedGrasp& grasp : grasps)
    out.grasps.push_back(grasp.read(prefix + std::to_string(out.grasps.size() + 1)));
  return out;
}

std::vector<world::Feature> derive_places(const world::World& world, std::size_t object,
                                          const PlaceRequest& request) {
  const world::Object& thing = world.objects.at(object);
  const Faces faces(thing.outer);
  const Vec3 up = pose_at_first(world, object).linear.transpose() * Vec3::UnitZ();
  std::vector<world::Feature> out;
  if (const std::optional<Vec3> bottom = bottom_of(faces, up))
    out.push_back({"bottom", world::Feature::Kind::Point, *bottom, Vec3::Zero()});
  const std::vector<Face> level = level_faces(faces, up);
  const double epsilon = thing.outer.epsilon();
  std::vector<UpperSurface> surfaces = upper_surfaces(faces, level, epsilon);
  const std::vector<Vec3> tops = tops_of(faces, level, surfaces, epsilon);
  for (std::size_t i = 0; i < std::min(request.most, tops.size()); ++i)
    out.push_back({numbered("top", i), world::Feature::Kind::Point, tops[i], Vec3::Zero()});
  if (request.inset)
    surfaces = upper_surfaces(faces, level, epsilon + request.inset->in(world.unit).of(0));
  std::size_t next = 0;
  for (std::size_t i = 0; i < std::min(request.most, surfaces.size()); ++i) {
    // A name that is there in two kinds is of none.
    while (is_of_other_kind(thing, numbered("face", next))) ++next;
    world::Feature& face = out.emplace_back();
    face = {numbered("face", next++), world::Feature::Kind::Surface, surfaces[i].middle,
            surfaces[i].normal};
    face.outline = std::move(surfaces[i].outline);
  }
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
        for (const StatedGrasp& grasp : stated_grasps(world, object, request, found)) {
          added.names.push_back(prefix + std::to_string(derived.size() + 1));
          derived.push_back(grasp.json(added.names.back()));
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
  std::vector<std::string> notes;
  AddedFeatures out = edit.run(
      objects, "features", [&](std::size_t object, Json& list, AddedFeatures::OfObject& added) {
        const std::vector<world::Feature> found = derive_places(world, object, request);
        const double size = world.objects[object].outer.box().diagonal();
        bool top = false, face = false;
        const auto lacks = [&](const std::string& what) {
          added.shortfall += (added.shortfall.empty() ? "" : "; ") + what;
        };
        for (const PlaceKind& kind : kPlaceKinds) {
          const auto same = [&](const Json& one) {
            return one.contains(kind.member) && is_called(one.at("name").get<std::string>(), kind);
          };
          Json derived = Json::array();
          for (const world::Feature& feature : found)
            if (is_called(feature.name, kind)) derived.push_back(as_json(feature, size));
          // Nothing takes the place of what is not found.
          const std::vector<std::string> has = names_of(entries_of(list, same));
          const bool any = !derived.empty() || !has.empty();
          if (kind.name == std::string_view("top")) top = any;
          if (kind.name == std::string_view("face")) face = any;
          if (!has.empty() && (!request.replace || derived.empty())) {
            added.kept.insert(added.kept.end(), has.begin(), has.end());
            if (request.replace) lacks(std::string(kind.none) + ": '" + has.front() + "' is kept");
            continue;
          }
          if (derived.empty()) {
            if (kind.so != nullptr) lacks(std::string(kind.none) + kind.so);
            continue;
          }
          for (const std::string& name : names_of(derived)) added.names.push_back(name);
          list = with_replaced(list, same, derived);
        }
        if (top && !face)
          notes.push_back(
              "object '" + added.object +
              "': nothing is left of its faces that look up when they are taken smaller "
              "all round, so that it has no surface");
      });
  out.notes.insert(out.notes.end(), notes.begin(), notes.end());
  for (const AddedFeatures::OfObject& object : out.objects)
    if (!object.kept.empty() && !request.replace)
      out.notes.push_back("object '" + object.object +
                          "': the points and surfaces that it has are kept; «force» replaces them");
  return out;
}

const std::vector<Option<GraspRequest>>& grasp_options() {
  using R = GraspRequest;
  static const std::vector<std::pair<const char*, R::Hold>> holds{{"sides", R::Hold::Sides},
                                                                  {"face", R::Hold::Face}};
  static const std::vector<std::pair<const char*, R::Form>> forms{
      {"both", R::Form::Both}, {"families", R::Form::Families}, {"poses", R::Form::Poses}};
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
          {.name = "form",
           .text = "Single poses in several directions (poses), families, or both: families then "
                   "have a "
                   "higher rank, and are tried later"},
          [](auto& r) -> auto& { return r.form; }, forms),
      choice<R>(
          {.name = "closing", .text = "Axis of the tool along which its fingers close"},
          [](auto& r) -> auto& { return r.closing; }, axes),
      option<R>(
          {.name = "opening",
           .text = "Largest distance between two faces: how far the fingers open",
           .absolute = true,
           .otherwise = "any"},
          [](auto& r) -> auto& { return r.opening; }),
      option<R>(
          {.name = "tip",
           .text = "Of families: width of the fingers' tips, or diameter of the suction cup; it "
                   "stays within the faces, wherever it is turned",
           .absolute = true,
           .otherwise = "none"},
          [](auto& r) -> auto& { return r.tip; }),
      option<R>(
          {.name = "directions",
           .text = "Of single poses: directions of approach, evenly round the axis of closing; of "
                   "suction, turns about the approach",
           .low = 1,
           .high = 360},
          [](auto& r) -> auto& { return r.directions; }),
      option<R>(
          {.name = "most",
           .text = "Most single grasps of an object, and most families",
           .low = 1,
           .high = 1000},
          [](auto& r) -> auto& { return r.most; }),
      option<R>(
          {.name = "gap",
           .text = "From the tool to the face that it holds by suction, beyond the sets' "
                   "epsilon",
           .low = 0,
           .absolute = true},
          [](auto& r) -> auto& { return r.gap; })};
  return options;
}

const std::vector<Option<PlaceRequest>>& place_options() {
  using R = PlaceRequest;
  static const std::vector<Option<R>> options{
      option<R>(
          {.name = "most",
           .text =
               "Most points on top of an object (top, top2, …), and most surfaces (face, face2, …)",
           .low = 1,
           .high = 100},
          [](auto& r) -> auto& { return r.most; }),
      option<R>(
          {.name = "inset",
           .text = "How much smaller than faces surfaces are taken all round, beyond the set's "
                   "epsilon: the radius of what is to stand there with all of its base",
           .absolute = true,
           .own_unit = "the scene's unit",
           .otherwise = "none"},
          [](auto& r) -> auto& { return r.inset; }),
      option<R>(
          {.name = "force",
           .text = "Replace points and surfaces of these names that the scene has"},
          [](auto& r) -> auto& { return r.replace; })};
  return options;
}

}  // namespace kaboum::scene
