// Scenes put together in process: entries are made when it is known where the scene is to be.

#include <kaboum/base/error.h>
#include <kaboum/io/file_unit.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/scene/scene_draft.h>

#include <algorithm>
#include <mutex>
#include <system_error>
#include <utility>

#include "set_maker.h"

namespace kaboum::scene {
namespace {

namespace fs = std::filesystem;

/// Of a scene that was not written yet.
constexpr const char* kUnnamed = "scene.json";

Json parsed(const std::string& text, const std::string& what) {
  try {
    return Json::parse(text);
  } catch (const Json::exception&) {
    throw Error(ErrorCode::InvalidInput, what + ": not JSON");
  }
}

Json object_of(const std::string& text, const std::string& name,
               const std::vector<std::string>& own) {
  Json out = parsed(text, name);
  if (!out.is_object())
    throw Error(ErrorCode::InvalidArgument, name + ": an object of members is expected");
  const auto stated =
      std::ranges::find_if(own, [&](const std::string& member) { return out.contains(member); });
  if (stated != own.end())
    throw Error(ErrorCode::InvalidArgument,
                name + ": '" + *stated + "' follows from the sets and cannot be stated");
  return out;
}

/// An inner set of another scale is not in the object: contacts with it would be called certain.
void require_one_scale(const std::string& name, const SceneSet& outer, const SceneSet& inner) {
  const geom::Provenance& out = outer.set.artefact().provenance;
  const geom::Provenance& in = inner.set.artefact().provenance;
  if (out.source_sha256 == in.source_sha256 &&
      io::recorded_scale(out.parameters, name) != io::recorded_scale(in.parameters, name))
    throw Error(ErrorCode::InvalidArgument,
                "object '" + name +
                    "': its inner set is of another scale than the outer one, and not inside it");
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  return fs::absolute(a, error).lexically_normal() == fs::absolute(b, error).lexically_normal();
}

}  // namespace

struct SceneDraft::State {
  struct AddedRobot {
    std::string name;
    std::shared_ptr<const robot::RobotFile> file;
    certify::CertifiedRobot made;
    Json members;
  };

  /// An object, or a region, which has an inner set only.
  struct AddedThing {
    std::string name;
    std::optional<SceneSet> outer, inner;
    Json members;
  };

  Json base;
  fs::path file = {};       ///< where it was read or written last
  std::string sha256 = {};  ///< of this file then
  bool was_read = false;
  std::vector<std::string> stems = {};  ///< stems of the containers that were there when read
  std::vector<AddedRobot> robots = {};
  std::vector<AddedThing> objects = {}, regions = {};
  mutable std::mutex mutex = {};  ///< of all that is above

  [[nodiscard]] std::string unit() const { return base.value("unit", "m"); }
  void require_new(const std::string& name) const;
  void require_unchanged() const;
  [[nodiscard]] Json entry_of(const AddedThing& thing, SetMaker& sets, const fs::path& folder,
                              io::FileNames& names) const;
  [[nodiscard]] Json made_by(SetMaker& sets, const fs::path& scene) const;
};

void SceneDraft::State::require_new(const std::string& name) const {
  if (name.empty()) throw Error(ErrorCode::InvalidArgument, "a name is empty");
  const auto is_same = [&](const auto& thing) { return thing.name == name; };
  bool taken = std::ranges::any_of(robots, is_same) || std::ranges::any_of(objects, is_same) ||
               std::ranges::any_of(regions, is_same);
  for (const char* list : {"robots", "objects", "regions"})
    if (base.contains(list))
      for (const Json& thing : base.at(list)) taken = taken || thing.value("name", "") == name;
  if (taken) throw Error(ErrorCode::InvalidArgument, "the name '" + name + "' is used twice");
}

/// Refuses to replace what somebody else has written meanwhile.
void SceneDraft::State::require_unchanged() const {
  std::error_code error;
  if (fs::exists(file, error) && io::sha256(io::read_file(file)) != sha256)
    throw Error(ErrorCode::InvalidArgument,
                file.string() +
                    " has changed since it was read or written here; replacing it "
                    "(force) loses all that was edited in it");
}

Json SceneDraft::State::entry_of(const AddedThing& thing, SetMaker& sets, const fs::path& folder,
                                 io::FileNames& names) const {
  Json out = {{"name", thing.name}, {"pose", {{"position", {0, 0, 0}}}}};
  const auto container = [&](const std::string& stem) {
    return folder / (names.unique(stem) + ".glb");
  };
  if (thing.outer)
    out["outer"] =
        sets.set_of(thing.name, thing.outer->set, thing.outer->sources, container(thing.name));
  if (thing.inner)
    out["inner"] = sets.set_of(thing.name, thing.inner->set, thing.inner->sources,
                               container(thing.name + "-inner"));
  for (const auto& [member, value] : thing.members.items()) out[member] = value;
  return out;
}

Json SceneDraft::State::made_by(SetMaker& sets, const fs::path& scene) const {
  const fs::path folder = fs::path(scene).replace_extension();
  io::FileNames names;
  for (const std::string& stem : stems) names.reserve(stem);  // what was there stays
  Json out = base;
  for (const char* list : {"robots", "objects", "regions"})
    if (!out.contains(list)) out[list] = Json::array();
  for (const AddedRobot& robot : robots) {
    io::FileNames in_robot;
    Json entry = sets.robot_of(robot.name, *robot.file, robot.made,
                               folder / names.unique(robot.name), in_robot);
    for (const auto& [member, value] : robot.members.items()) entry[member] = value;
    out["robots"].push_back(std::move(entry));
  }
  for (const AddedThing& thing : objects)
    out["objects"].push_back(entry_of(thing, sets, folder, names));
  for (const AddedThing& thing : regions)
    out["regions"].push_back(entry_of(thing, sets, folder, names));
  return out;
}

SceneDraft::SceneDraft(const std::string& unit)
    : state_(new State{{{"kaboum_scene", 1},
                        {"unit", unit},
                        {"robots", Json::array()},
                        {"objects", Json::array()},
                        {"regions", Json::array()},
                        {"allowed_contacts", Json::array()},
                        {"attachments", Json::array()}}}) {}

SceneDraft SceneDraft::read(const fs::path& file) {
  static_cast<void>(world::read_scene(file.string()));  // is one
  const std::vector<char> bytes = io::read_file(file);
  SceneDraft out;
  out.state_->base =
      parsed(world::scene_as_json({bytes.data(), bytes.size()}, file.string()), file.string());
  out.state_->file = file;
  out.state_->sha256 = io::sha256(bytes);
  out.state_->was_read = true;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(fs::path(file).replace_extension(), error))
    out.state_->stems.push_back(entry.path().stem().string());
  return out;
}

SceneDraft::SceneDraft(SceneDraft&&) noexcept = default;
SceneDraft& SceneDraft::operator=(SceneDraft&&) noexcept = default;
SceneDraft::~SceneDraft() = default;

std::string SceneDraft::unit() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->unit();
}

fs::path SceneDraft::file() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->file;
}

void SceneDraft::add_robot(const std::string& name, std::shared_ptr<const robot::RobotFile> file,
                           certify::CertifiedRobot made, const std::string& members) {
  const std::scoped_lock lock(state_->mutex);
  state_->require_new(name);
  Json extra = object_of(members, "robot '" + name + "'",
                         {"name", "urdf", "links", "links_without_set", "shapes"});
  state_->robots.push_back({name, std::move(file), std::move(made), std::move(extra)});
}

void SceneDraft::add_object(const std::string& name, SceneSet outer, std::optional<SceneSet> inner,
                            const std::string& members) {
  if (inner) require_one_scale(name, outer, *inner);
  const std::scoped_lock lock(state_->mutex);
  state_->require_new(name);
  Json extra = object_of(members, "object '" + name + "'", {"name", "shape", "outer", "inner"});
  state_->objects.push_back({name, std::move(outer), std::move(inner), std::move(extra)});
}

void SceneDraft::add_region(const std::string& name, SceneSet inner, const std::string& members) {
  const std::scoped_lock lock(state_->mutex);
  state_->require_new(name);
  Json extra = object_of(members, "region '" + name + "'", {"name", "shape", "outer", "inner"});
  state_->regions.push_back({name, std::nullopt, std::move(inner), std::move(extra)});
}

void SceneDraft::add_primitive_object(const std::string& name, const std::string& shape,
                                      const std::string& members) {
  const std::scoped_lock lock(state_->mutex);
  state_->require_new(name);
  Json extra = object_of(members, "object '" + name + "'", {"name", "shape", "outer", "inner"});
  extra["shape"] = parsed(shape, "the shape of '" + name + "'");
  state_->objects.push_back({name, std::nullopt, std::nullopt, std::move(extra)});
}

void SceneDraft::add_primitive_region(const std::string& name, const std::string& shape,
                                      const std::string& members) {
  const std::scoped_lock lock(state_->mutex);
  state_->require_new(name);
  Json extra = object_of(members, "region '" + name + "'", {"name", "shape", "outer", "inner"});
  extra["shape"] = parsed(shape, "the shape of '" + name + "'");
  state_->regions.push_back({name, std::nullopt, std::nullopt, std::move(extra)});
}

void SceneDraft::add_entry(const std::string& list, const std::string& entry) {
  ensure(list == "allowed_contacts" || list == "attachments", "a list of a scene");
  const std::scoped_lock lock(state_->mutex);
  Json& entries = state_->base[list];
  if (entries.is_null()) entries = Json::array();
  entries.push_back(parsed(entry, list));
}

std::string SceneDraft::json() const {
  const std::scoped_lock lock(state_->mutex);
  const fs::path scene = state_->file.empty() ? fs::path(kUnnamed) : state_->file;
  SetMaker sets(scene);
  return state_->made_by(sets, scene).dump(2) + "\n";
}

world::SceneFile SceneDraft::world() const {
  const std::scoped_lock lock(state_->mutex);
  const fs::path scene = state_->file.empty() ? fs::path(kUnnamed) : state_->file;
  SetMaker sets(scene);
  const std::string text = state_->made_by(sets, scene).dump(2) + "\n";
  world::SceneFile out;
  out.inputs.push_back(scene.string());
  out.sha256 = io::sha256({text.data(), text.size()});
  world::SceneNotes notes;
  out.world = world::parse_scene(
      text, scene.string() + (scene.extension() == ".json" ? "" : " (as JSON)"),
      [&](const std::string& file) {
        out.inputs.push_back((scene.parent_path() / file).string());
        return sets.read(scene.parent_path(), file);
      },
      &notes);
  out.notes = std::move(notes.notes);
  return out;
}

MadeScene SceneDraft::write(const fs::path& scene, bool replace) {
  State& s = *state_;
  const std::scoped_lock lock(s.mutex);
  const bool is_here = !s.file.empty() && is_same_file(scene, s.file);
  if (s.was_read && !is_here)
    throw Error(ErrorCode::InvalidArgument,
                scene.string() + ": a scene that was read is written where it was, " +
                    s.file.string() + ", since it names its files from there");
  require_free_place(scene, replace || is_here);
  if (is_here && !replace) s.require_unchanged();
  SetMaker sets(scene);
  const Json text = s.made_by(sets, scene);
  MadeScene out = sets.write(text);
  s.file = scene;
  s.sha256 = io::sha256(io::read_file(scene));
  return out;
}

}  // namespace kaboum::scene
