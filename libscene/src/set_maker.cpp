// Sets of scenes: certified, kept with what they were made from, written once.

#include "set_maker.h"

#include <kaboum/base/error.h>
#include <kaboum/base/notes.h>
#include <kaboum/certify/inner_links.h>
#include <kaboum/certify/set_options.h>
#include <kaboum/io/file_unit.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <cstdio>

namespace kaboum::scene {
namespace {

namespace fs = std::filesystem;

void create(const fs::path& folder) {
  if (folder.empty()) return;  // the present one
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Error(ErrorCode::OutputFailed,
                folder.string() + ": cannot be created: " + error.message());
}

/// What a file holds is what its set says it holds: a scale that is wrong by a thousand is free of
/// everything.
void require_unit(const std::string& file, double scale, const std::string& needed) {
  io::ReadResult read = io::read_mesh(file);
  io::scale(read, scale, file);
  const std::string& unit = read.unit;
  if (unit.empty() || unit == needed) return;
  throw Error(ErrorCode::InvalidInput, file + ": its vertices are in " + unit +
                                           " as read (docs/formats.md), the scene is in " + needed +
                                           ": bring it into " + needed +
                                           " (scale), or make a scene of this unit (unit)");
}

io::Format format_of(const std::string& file, const SceneSetOptions& options) {
  if (options.format_of) return options.format_of(file);
  if (const auto format = io::format_from_name(fs::path(file).extension().string())) return *format;
  throw Error(ErrorCode::InvalidInput, file + ": no format of meshes is known by this extension");
}

/// Has the format of each mesh looked at before anything is computed.
void require_formats(const robot::LinkMeshes& meshes, const SceneSetOptions& options) {
  for (const robot::LinkMesh& mesh : meshes.meshes)
    static_cast<void>(format_of(mesh.file.string(), options));
}

}  // namespace

std::optional<std::string> apply_parameters(const std::string& parameters,
                                            SceneSetOptions& options) {
  certify::RobotSetOptions stated;
  std::string unknown = read_record(certify::robot_set_options(), parameters, stated);
  if (!unknown.empty()) return unknown;
  stated.set.request.unit = options.sets.unit;
  stated.set.request.frame = options.sets.frame;
  stated.set.request.direction = options.sets.direction;
  options.sets = certify::request_of(stated.set);
  options.visual = stated.visual;
  return std::nullopt;
}

std::string SetMaker::seen_from_scene(const fs::path& file) const {
  return fs::relative(fs::absolute(file), fs::absolute(scene_).parent_path()).generic_string();
}

Json SetMaker::keep(const fs::path& path, std::vector<char> bytes, const Json& made_from) {
  Json out = {
      {"file", seen_from_scene(path)}, {"sha256", io::sha256(bytes)}, {"made_from", made_from}};
  files_.emplace_back(path, std::move(bytes));
  return out;
}

/// A mesh and what it refers to, as they are compared when the scene is read.
void SetMaker::add_sources(Json& sources, const fs::path& file,
                           const certify::CertifiedFile& made) const {
  const auto add = [&](const fs::path& source, const std::string& sha256) {
    Json one = {{"file", seen_from_scene(source)}, {"sha256", sha256}};
    if (std::find(sources.begin(), sources.end(), one) == sources.end())
      sources.push_back(std::move(one));
  };
  add(file, made.sha256);
  for (const std::string& other : made.other_files) add(other, io::sha256(io::read_file(other)));
}

Json SetMaker::robot(const std::string& name, const std::string& path, const fs::path& folder,
                     const SceneSetOptions& options) {
  const robot::RobotFile file = robot::read_robot(path);
  certify::RobotRequest request{
      options.sets, {options.links, options.visual, options.packages}, {}, {}};
  request.tool = "kaboum-scene " KABOUM_VERSION;
  if (!request.set.wrap) request.set.wrap.emplace().where_needed = true;
  request.partial = true;
  require_formats(robot::link_meshes(file, request.shapes), options);
  Notes of_meshes;
  certify::RobotHooks hooks = certify::hooks_of(of_meshes, options.progress);
  hooks.made = [&](const certify::CertifiedLinkMesh& mesh) {
    if (mesh.held && !mesh.made.found.set.certificate().reached())
      of_meshes.add(mesh.mesh.file.string(),
                    "the decomposition does not reach " + mesh.epsilon->text());
  };
  const certify::CertifiedRobot made = certify::certify_robot(file, request, options.cache, hooks);
  for (std::string& note : robot::notes_on_flat_shapes(file, options.visual))
    notes.push_back(std::move(note));
  for (std::string& line : of_meshes.lines()) notes.push_back(std::move(line));
  io::FileNames names;
  Json out = robot_of(name, file, made, folder, names);
  if (options.inner_links) add_inner_links(out["links"], file, request, folder, names, options);
  return out;
}

Json SetMaker::robot_of(const std::string& name, const robot::RobotFile& file,
                        const certify::CertifiedRobot& made, const fs::path& folder,
                        io::FileNames& names) {
  const certify::BodiesCertificate& bodies = made.bodies.certificate();
  inputs.insert(file.path.string());
  for (const fs::path& input : bodies.files) inputs.insert(input.string());
  add_bad_links(name, file.robot, certify::verdicts(made));
  Json links = Json::array(), without = Json::array();
  for (const certify::CertifiedLink& link : made.links) {
    const std::uint32_t number = link.certificate().link;
    const std::string& link_name = file.robot.links[number].name;
    if (link.artefact().bodies.empty()) {  // points only
      without.push_back(link_name);
      continue;
    }
    links.push_back({{"link", link_name},
                     {"outer", keep(folder / (names.unique(link_name) + ".glb"), link.bytes(),
                                    sources_of(number, bodies.shapes, bodies.meshes))}});
  }
  Json out = {{"name", name},
              {"urdf", {{"file", seen_from_scene(file.path)}, {"sha256", file.sha256}}},
              {"base", {{"position", {0, 0, 0}}, {"rpy", {0, 0, 0}}}},
              {"links", links},
              {"tools", Json::array()}};
  if (bodies.choice.visual) out["shapes"] = "visual";
  if (!without.empty()) out["links_without_set"] = std::move(without);
  return out;
}

Json SetMaker::set_of(const std::string& name, const certify::CertifiedSet& set,
                      const std::vector<fs::path>& sources, const fs::path& container) {
  Json made_from = Json::array();
  for (const fs::path& source : sources) {
    made_from.push_back(
        {{"file", seen_from_scene(source)}, {"sha256", io::sha256(io::read_file(source))}});
    inputs.insert(source.string());
  }
  say_size(name, set.artefact(), set.artefact().provenance.unit);
  Json out = keep(container, set.bytes(), made_from);
  if (sources.empty()) out.erase("made_from");
  return out;
}

std::vector<char> SetMaker::read(const fs::path& folder, const std::string& file) const {
  for (const auto& [path, bytes] : files_)
    if (path.lexically_normal() == (folder / file).lexically_normal()) return bytes;
  return io::read_file(folder / file);
}

void SetMaker::add_bad_links(const std::string& name, const robot::Robot& robot,
                             const std::vector<certify::LinkVerdict>& verdicts) {
  using certify::Outcome;
  for (const certify::LinkVerdict& link : verdicts) {
    if (link.outcome == Outcome::Held) continue;
    const std::string& link_name = robot.links[link.link].name;
    std::string line = "robot '";
    line.append(name).append("', link '").append(link_name).append("': ").append(link.sentence);
    if (link.outcome >= Outcome::Kept) {
      kept_[name].push_back(link_name);
      line += "; it has no set, and the scene is refused until it has one";
    }
    bad_links.push_back(std::move(line));
  }
}

Json SetMaker::sources_of(std::uint32_t link, const std::vector<robot::LinkShape>& shapes,
                          const std::vector<certify::CertifiedLinkMesh>& meshes) const {
  Json out = Json::array();
  for (const robot::LinkShape& shape : shapes)
    if (shape.link == link && shape.mesh)
      add_sources(out, meshes[*shape.mesh].mesh.file, meshes[*shape.mesh].made);
  return out;
}

void SetMaker::add_inner_links(Json& links, const robot::RobotFile& file,
                               certify::RobotRequest request, const fs::path& folder,
                               io::FileNames& names, const SceneSetOptions& options) {
  request.shapes.links.clear();
  for (const Json& entry : links) {
    const std::string name = entry.at("link");
    if (options.inner_links->empty() ||
        std::ranges::find(*options.inner_links, name) != options.inner_links->end())
      request.shapes.links.push_back(name);
  }
  if (request.shapes.links.empty()) return;
  Notes of_meshes;  // said of the outer sets
  const certify::InnerLinks made = certify::certify_inner_links(
      file, request, options.cache, certify::hooks_of(of_meshes, options.progress));
  for (const certify::CertifiedInnerLink& link : made.links) {
    const std::uint32_t number = link.certificate().link;
    const std::string& name = file.robot.links[number].name;
    for (Json& entry : links)
      if (entry.at("link") == name)
        entry["inner"] = keep(folder / (names.unique(name + "-inner") + ".glb"), link.bytes(),
                              sources_of(number, made.shapes, made.meshes));
  }
  for (const auto& [number, why] : made.without)
    notes.push_back(file.path.string() + ": link '" + file.robot.links[number].name +
                    "' has no inner set, its contacts are never certain: " + why);
}

/// The box of a set in its own frame.
void SetMaker::say_size(const std::string& name, const geom::ConvexSet& set,
                        const std::string& unit) {
  geom::Box3 box;
  for (const geom::ConvexBody& body : set.bodies)
    for (const geom::Vec3& p : body.core.vertices) box.extend(p);
  const geom::Vec3 size = box.max - box.min;
  char text[96];
  std::snprintf(text, sizeof text, "%.3g x %.3g x %.3g %s", size.x(), size.y(), size.z(),
                unit.c_str());
  const std::string line = name + ": " + text;
  if (sizes.empty() || sizes.back() != line) sizes.push_back(line);
}

Json SetMaker::mesh(const std::string& name, const std::string& file,
                    certify::SetRequest::Direction direction, const fs::path& container,
                    const SceneSetOptions& options) {
  require_unit(file, options.sets.scale, options.sets.unit);
  Notes of_mesh;
  certify::SetRequest request = options.sets;
  request.direction = direction;
  if (direction != certify::SetRequest::Direction::Outer)
    request.wrap.reset();
  else if (!request.wrap)
    request.wrap.emplace().where_needed = true;
  const auto note = [&](const std::string& text) { of_mesh.add(file, text); };
  const certify::CertifiedFile made = certify::certify_file(
      file, format_of(file, options), request, options.cache, {options.progress, note});
  for (std::string& line : of_mesh.lines()) notes.push_back(std::move(line));
  inputs.insert(file);
  inputs.insert(made.other_files.begin(), made.other_files.end());
  if (made.found.set.artefact().bodies.empty()) return nullptr;
  if (!made.found.set.certificate().reached())
    notes.push_back(file + ": the decomposition does not reach " + request.epsilon->text());
  say_size(name, made.found.set.artefact(), options.sets.unit);
  Json sources = Json::array();
  add_sources(sources, file, made);
  return keep(container, made.found.set.bytes(), sources);
}

MadeScene SetMaker::report() {
  MadeScene out;
  out.inputs.assign(inputs.begin(), inputs.end());
  out.notes = std::move(notes);
  out.sizes = std::move(sizes);
  out.bad_links = std::move(bad_links);
  return out;
}

MadeScene SetMaker::write(const Json& scene) {
  const bool yaml = scene_.extension() != ".json";
  const std::string text = yaml ? to_yaml(scene) : scene.dump(2) + "\n";
  const fs::path folder = scene_.parent_path();
  Json readable = scene;
  if (!kept_.empty())  // a scene may be without "robots"
    for (Json& robot : readable.at("robots"))
      if (const auto kept = kept_.find(robot.at("name")); kept != kept_.end())
        for (const std::string& link : kept->second) robot["links_without_set"].push_back(link);
  static_cast<void>(
      world::parse_scene(readable.dump(2), scene_.string() + " (as JSON)",
                         [&](const std::string& file) { return read(folder, file); }));
  MadeScene out = report();
  for (const auto& [path, bytes] : files_) {
    create(path.parent_path());
    io::write_file(path, bytes);
    out.containers.push_back(path);
  }
  io::write_file(scene_, {text.data(), text.size()});
  return out;
}

}  // namespace kaboum::scene
