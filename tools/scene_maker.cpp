// Scenes are made of certified sets; each is written once, with its hash in the scene.

#include "scene_maker.h"

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <cstdio>
#include <set>

#include "cli.h"
#include "file_names.h"
#include "robot_bodies.h"

namespace kaboum::tools {
namespace {

namespace fs = std::filesystem;

class Maker {
 public:
  explicit Maker(const SceneMaker& o)
      : o_(o),
        folder_(fs::path(o.scene).replace_extension()),
        base_(fs::absolute(o.scene).parent_path()) {}

  MadeScene run() {
    // Everything is computed before anything is written.
    Json robots = Json::array(), objects = Json::array(), regions = Json::array();
    for (const NamedFile& r : o_.robots) robots.push_back(robot(r));
    for (const NamedFile& object : o_.objects) {
      Json out = {{"name", object.name}, {"pose", {{"position", {0, 0, 0}}}}};
      out["outer"] = mesh(object, certify::SetRequest::Direction::Outer, "");
      if (o_.inner) out["inner"] = mesh(object, certify::SetRequest::Direction::Inner, "-inner");
      objects.push_back(std::move(out));
    }
    for (const NamedFile& region : o_.regions)
      regions.push_back({{"name", region.name},
                         {"pose", {{"position", {0, 0, 0}}}},
                         {"inner", mesh(region, certify::SetRequest::Direction::Inner, "-inner")}});
    const Json scene = {
        {"kaboum_scene", 1},           {"unit", o_.sets.unit}, {"robots", robots},
        {"objects", objects},          {"regions", regions},   {"allowed_contacts", Json::array()},
        {"attachments", Json::array()}};
    out_.text = scene.dump(2) + "\n";
    for (const auto& [path, bytes] : files_) {
      create(path.parent_path());
      io::write_file(path, bytes);
      out_.containers.push_back(path);
    }
    io::write_file(o_.scene, {out_.text.data(), out_.text.size()});
    return std::move(out_);
  }

 private:
  static void create(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
      throw Error(ErrorCode::OutputFailed,
                  folder.string() + ": cannot be created: " + error.message());
  }

  /// The file as the scene names it.
  [[nodiscard]] std::string seen_from_scene(const fs::path& file) const {
    return fs::relative(fs::absolute(file), fs::absolute(base_)).generic_string();
  }

  Json keep(const fs::path& path, std::vector<char> bytes, const Json& made_from) {
    Json out = {
        {"file", seen_from_scene(path)}, {"sha256", io::sha256(bytes)}, {"made_from", made_from}};
    files_.emplace_back(path, std::move(bytes));
    return out;
  }

  /// A mesh and what it refers to, as they are compared when the scene is read.
  void add_sources(Json& sources, const fs::path& file, const certify::CertifiedFile& made) {
    const auto add = [&](const fs::path& source, const std::string& sha256) {
      Json one = {{"file", seen_from_scene(source)}, {"sha256", sha256}};
      if (std::find(sources.begin(), sources.end(), one) == sources.end())
        sources.push_back(std::move(one));
    };
    add(file, made.sha256);
    for (const std::string& other : made.other_files) add(other, io::sha256(io::read_file(other)));
  }

  Json robot(const NamedFile& named) {
    const robot::RobotFile file = robot::read_robot(named.file);
    out_.inputs.push_back(named.file);
    certify::RobotRequest request{o_.sets, {{}, o_.visual, o_.packages}, {}, {}};
    request.tool = std::string("kaboum-scene ") + version();
    require_formats(robot::link_meshes(file, request.shapes), "");
    Notes notes;
    certify::RobotHooks hooks = hooks_of(notes, o_.progress);
    hooks.made = [&](const certify::CertifiedLinkMesh& mesh) {
      if (!mesh.made.found.set.certificate().reached())
        notes.add(mesh.mesh.file.string(),
                  "the decomposition does not reach " + mesh.epsilon->text());
    };
    const certify::CertifiedRobot made = certify::certify_robot(file, request, o_.cache, hooks);
    for (std::string& input : strings(made.bodies.certificate().files))
      out_.inputs.push_back(std::move(input));
    for (std::string& note : robot::notes_on_flat_shapes(file, o_.visual))
      out_.notes.push_back(std::move(note));
    for (std::string& line : notes.lines()) out_.notes.push_back(std::move(line));
    Json links = Json::array();
    FileNames names;
    const std::string folder = names_.unique(named.name);
    for (const certify::CertifiedLink& link : made.links) {
      if (link.artefact().bodies.empty()) continue;  // points only
      const std::uint32_t number = link.certificate().link;
      const std::string& name = file.robot.links[number].name;
      Json sources = Json::array();
      for (const robot::LinkShape& shape : made.bodies.certificate().shapes) {
        if (shape.link != number || !shape.mesh) continue;
        const certify::CertifiedLinkMesh& mesh = made.bodies.certificate().meshes[*shape.mesh];
        add_sources(sources, mesh.mesh.file, mesh.made);
      }
      links.push_back({{"link", name},
                       {"outer", keep(folder_ / folder / (names.unique(name) + ".glb"),
                                      link.bytes(), sources)}});
    }
    Json out = {{"name", named.name},
                {"urdf", {{"file", seen_from_scene(named.file)}, {"sha256", file.sha256}}},
                {"base", {{"position", {0, 0, 0}}, {"rpy", {0, 0, 0}}}},
                {"links", links},
                {"tools", Json::array()}};
    if (o_.visual) out["shapes"] = "visual";
    return out;
  }

  /// What a file holds is what its set says it holds: a scale that is wrong by a thousand is free
  /// of everything.
  void require_unit(const std::string& file) const {
    const std::string unit = io::read_mesh(file).unit;
    if (unit.empty() || unit == o_.sets.unit) return;
    throw Error(ErrorCode::InvalidInput, file + ": its vertices are in " + unit +
                                             " as read (docs/formats.md), the scene is in " +
                                             o_.sets.unit + ": export it in " + o_.sets.unit +
                                             (o_.robots.empty() ? ", or give --unit" : ""));
  }

  /// The box of the sets, each in its own frame.
  void say_size(const std::string& name, const std::vector<const geom::ConvexSet*>& sets) {
    geom::Box3 box;
    for (const geom::ConvexSet* set : sets)
      for (const geom::ConvexBody& body : set->bodies)
        for (const geom::Vec3& p : body.hull.vertices) box.extend(p);
    const geom::Vec3 size = box.max - box.min;
    char text[96];
    std::snprintf(text, sizeof text, "%.3g x %.3g x %.3g %s", size.x(), size.y(), size.z(),
                  o_.sets.unit.c_str());
    const std::string line = name + ": " + text;
    if (out_.sizes.empty() || out_.sizes.back() != line) out_.sizes.push_back(line);
  }

  Json mesh(const NamedFile& named, certify::SetRequest::Direction direction,
            const std::string& suffix) {
    require_unit(named.file);
    Notes notes;
    certify::SetRequest request = o_.sets;
    request.direction = direction;
    const auto note = [&](const std::string& text) { notes.add(named.file, text); };
    const certify::CertifiedFile made =
        certify::certify_file(named.file, format_for(named.file, "", "--input-format"), request,
                              o_.cache, {o_.progress, note});
    for (std::string& line : notes.lines()) out_.notes.push_back(std::move(line));
    out_.inputs.push_back(named.file);
    out_.inputs.insert(out_.inputs.end(), made.other_files.begin(), made.other_files.end());
    say_size(named.name, {&made.found.set.artefact()});
    Json sources = Json::array();
    add_sources(sources, named.file, made);
    return keep(folder_ / (names_.unique(named.name + suffix) + ".glb"), made.found.set.bytes(),
                sources);
  }

  const SceneMaker& o_;
  fs::path folder_, base_;
  FileNames names_;  ///< in the folder of the sets
  std::vector<std::pair<fs::path, std::vector<char>>> files_;
  MadeScene out_;
};

}  // namespace

NamedFile parse_named_file(const std::string& text, const char* option) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size() ||
      text.find('/') < equals)
    throw Error(ErrorCode::InvalidArgument,
                std::string(option) + ": NAME=FILE is expected, not '" + text + "'");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

MadeScene make_scene(const SceneMaker& maker) {
  std::set<std::string> names;
  for (const auto* files : {&maker.robots, &maker.objects, &maker.regions})
    for (const NamedFile& file : *files)
      if (!names.insert(file.name).second)
        throw Error(ErrorCode::InvalidArgument, "the name '" + file.name + "' is used twice");
  return Maker(maker).run();
}

}  // namespace kaboum::tools
