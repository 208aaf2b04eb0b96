// Scenes are made of certified sets; each is written once, with its hash in the scene.

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/io/file_names.h>
#include <kaboum/scene/scene_maker.h>

#include <Eigen/Geometry>
#include <set>

#include "set_maker.h"

namespace kaboum::scene {

namespace fs = std::filesystem;

namespace {

/// Refuses places and scales of things that are not there.
void require_names(const char* what, const std::vector<std::string>& given,
                   const std::set<std::string>& names) {
  for (const std::string& name : given)
    if (!names.contains(name))
      throw Error(ErrorCode::InvalidArgument,
                  std::string(what) + ": there is nothing of the name '" + name + "'" +
                      did_you_mean(name, std::vector(names.begin(), names.end())));
}

template <class Value>
std::vector<std::string> keys_of(const std::map<std::string, Value>& values) {
  std::vector<std::string> out;
  out.reserve(values.size());
  for (const auto& [name, value] : values) out.push_back(name);
  return out;
}

/// Of one mesh.
SceneSetOptions options_of(const SceneMaker& maker, const std::string& name) {
  SceneSetOptions out = maker.options;
  if (const auto scale = maker.scales.find(name); scale != maker.scales.end())
    out.sets.scale = scale->second;
  return out;
}

/// As scene files state poses; what is turned, by the quaternion nearest to its rotation.
Json pose_json(const SceneMaker& maker, const std::string& name) {
  const auto place = maker.places.find(name);
  if (place == maker.places.end()) return {{"position", {0, 0, 0}}};
  const geom::Transform& pose = place->second;
  Json out = {{"position", {pose.translation.x(), pose.translation.y(), pose.translation.z()}}};
  if (pose.linear != Eigen::Matrix3d::Identity()) {
    const Eigen::Quaterniond turn = Eigen::Quaterniond(pose.linear).normalized();
    out["quaternion"] = {turn.x(), turn.y(), turn.z(), turn.w()};
  }
  return out;
}

/// Refuses what contradicts itself, or would replace something.
void require_sound(const SceneMaker& maker) {
  if (maker.robots.empty() && maker.objects.empty() && maker.regions.empty() &&
      maker.primitives.empty())
    throw Error(ErrorCode::InvalidArgument,
                "nothing is asked for: give a robot, an object or a region");
  require_free_place(maker.scene, maker.replace);
  // Lengths in URDFs are metres; an arm that is a thousand times too small is free of everything.
  if (!maker.robots.empty() && maker.options.sets.unit != "m")
    throw Error(ErrorCode::InvalidArgument,
                "unit " + maker.options.sets.unit +
                    ": URDFs are in m, and so are scenes with robots; bring the meshes of objects "
                    "into m (scale)");
  if (maker.options.inner_links && maker.robots.empty())
    throw Error(ErrorCode::InvalidArgument, "inner sets of links: no robot is asked for");
}

}  // namespace

void require_free_place(const fs::path& scene, bool replace) {
  const std::string name = scene.string();
  if (!name.ends_with(".json") && !name.ends_with(".yaml") && !name.ends_with(".yml"))
    throw Error(ErrorCode::InvalidArgument, name + ": a scene's name ends in .json, .yaml or .yml");
  std::error_code error;
  if (const fs::path parent = scene.parent_path(); !parent.empty() && !fs::exists(parent, error))
    throw Error(ErrorCode::OutputFailed,
                name + ": there is no folder " + parent.string() + "; create it first");
  if (replace) return;
  if (fs::exists(scene, error))
    throw Error(ErrorCode::InvalidArgument,
                name + " exists; replacing it (force) loses all that was edited in it");
  const fs::path folder = fs::path(scene).replace_extension();
  if (fs::exists(folder, error) && !fs::is_empty(folder, error))
    throw Error(ErrorCode::InvalidArgument,
                folder.string() + ", where the sets of " + name +
                    " go, is there already, perhaps of another scene; force writes into it");
}

MadeScene make_scene(const SceneMaker& maker) {
  require_sound(maker);
  std::set<std::string> names;
  for (const NamedPrimitive& p : maker.primitives)
    if (!names.insert(p.name).second)
      throw Error(ErrorCode::InvalidArgument, "the name '" + p.name + "' is used twice");
  for (const auto* files : {&maker.robots, &maker.objects, &maker.regions})
    for (const NamedFile& file : *files)
      if (!names.insert(file.name).second)
        throw Error(ErrorCode::InvalidArgument, "the name '" + file.name + "' is used twice");
  require_names("at", keys_of(maker.places), names);
  for (const NamedFile& robot : maker.robots)
    if (maker.scales.contains(robot.name))
      throw Error(ErrorCode::InvalidArgument,
                  "scale: '" + robot.name + "' is a robot, which states its meshes' scales itself");
  for (const NamedPrimitive& p : maker.primitives)
    if (maker.scales.contains(p.name))
      throw Error(ErrorCode::InvalidArgument,
                  "scale: '" + p.name + "' is a primitive, which states its sizes itself");
  require_names("scale", keys_of(maker.scales), names);
  // What is not there is noticed before anything is computed, which takes long.
  for (const auto* files : {&maker.robots, &maker.objects, &maker.regions})
    for (const NamedFile& file : *files)
      if (!fs::exists(file.file))
        throw Error(ErrorCode::InvalidInput,
                    file.file + ": there is no such file (" + file.name + ")");
  // Everything is computed before anything is written.
  using Direction = certify::SetRequest::Direction;
  const fs::path folder = fs::path(maker.scene).replace_extension();
  SetMaker sets(maker.scene);
  io::FileNames in_folder;
  const auto container = [&](const std::string& name) {
    return folder / (in_folder.unique(name) + ".glb");
  };
  Json robots = Json::array(), objects = Json::array(), regions = Json::array();
  for (const NamedFile& r : maker.robots) {
    Json out = sets.robot(r.name, r.file, folder / in_folder.unique(r.name), maker.options);
    if (maker.places.contains(r.name)) out["base"] = pose_json(maker, r.name);
    robots.push_back(std::move(out));
  }
  for (const NamedFile& o : maker.objects) {
    const SceneSetOptions options = options_of(maker, o.name);
    Json out = {{"name", o.name}, {"pose", pose_json(maker, o.name)}};
    out["outer"] = sets.mesh(o.name, o.file, Direction::Outer, container(o.name), options);
    if (maker.inner) {
      Json inner =
          sets.mesh(o.name, o.file, Direction::Inner, container(o.name + "-inner"), options);
      if (inner.is_null())
        sets.notes.push_back(o.name + ": no body lies within " + o.file +
                             " at this epsilon; it has no inner set");
      else
        out["inner"] = std::move(inner);
    }
    objects.push_back(std::move(out));
  }
  for (const NamedPrimitive& p : maker.primitives)
    objects.push_back({{"name", p.name},
                       {"pose", pose_json(maker, p.name)},
                       {"shape", Json::parse(world::to_json(p.primitive))}});
  for (const NamedFile& r : maker.regions) {
    Json inner = sets.mesh(r.name, r.file, Direction::Inner, container(r.name + "-inner"),
                           options_of(maker, r.name));
    if (inner.is_null())
      throw Error(ErrorCode::InvalidInput, "region '" + r.name + "': no body lies within " +
                                               r.file + " at this epsilon: give a smaller one");
    regions.push_back(
        {{"name", r.name}, {"pose", pose_json(maker, r.name)}, {"inner", std::move(inner)}});
  }
  const Json scene = {{"kaboum_scene", 1},
                      {"unit", maker.options.sets.unit},
                      {"robots", robots},
                      {"objects", objects},
                      {"regions", regions},
                      {"allowed_contacts", Json::array()},
                      {"attachments", Json::array()}};
  return sets.write(scene);
}

}  // namespace kaboum::scene
