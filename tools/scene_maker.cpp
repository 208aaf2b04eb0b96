// Scenes are made of certified sets; each is written once, with its hash in the scene.

#include "scene_maker.h"

#include <kaboum/base/error.h>
#include <kaboum/io/convex_io.h>

#include <algorithm>
#include <set>

#include "certified_file.h"
#include "file_names.h"
#include "link_container.h"
#include "notes.h"

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
        {"kaboum_scene", 1},           {"unit", o_.unit},    {"robots", robots},
        {"objects", objects},          {"regions", regions}, {"allowed_contacts", Json::array()},
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

  Json keep(const fs::path& path, std::vector<char> bytes) {
    const Json out = {{"file", seen_from_scene(path)}, {"sha256", io::sha256(bytes)}};
    files_.emplace_back(path, std::move(bytes));
    return out;
  }

  Json robot(const NamedFile& named) {
    const RobotFile file = read_robot(named.file);
    out_.inputs.push_back(named.file);
    const LinkBodies made = bodies_of(file, o_.bodies);
    out_.inputs.insert(out_.inputs.end(), made.files.begin(), made.files.end());
    out_.notes.insert(out_.notes.end(), made.notes.begin(), made.notes.end());
    Json links = Json::array();
    FileNames names;
    for (std::uint32_t l = 0; l < file.robot.links.size(); ++l) {
      std::vector<robot::LinkBody> bodies;
      for (const robot::LinkBody& body : made.bodies)
        if (body.link == l) bodies.push_back(body);
      if (bodies.empty()) continue;
      auto [set, beyond] = link_container(bodies);
      const std::string& name = file.robot.links[l].name;
      geom::Provenance& p = set.provenance;
      p.source = file.path.filename().string();
      p.source_sha256 = file.sha256;
      p.tool = std::string("kaboum-scene ") + version();
      p.parameters = "--epsilon " + o_.bodies.epsilon.text();
      p.unit = o_.unit;
      p.frame = name;
      p.direction = "outer";
      p.epsilon = (made.epsilon + beyond) * (1 + 0x1p-50);
      links.push_back(
          {{"link", name},
           {"outer", keep(folder_ / plain_file_name(named.name) / (names.unique(name) + ".glb"),
                          io::serialise_convex_set(set, io::SetFormat::Glb))}});
    }
    return {{"name", named.name},
            {"urdf", {{"file", seen_from_scene(named.file)}, {"sha256", file.sha256}}},
            {"base", {{"position", {0, 0, 0}}, {"rpy", {0, 0, 0}}}},
            {"links", links},
            {"tools", Json::array()}};
  }

  Json mesh(const NamedFile& named, certify::SetRequest::Direction direction,
            const std::string& suffix) {
    Notes notes;
    certify::SetRequest request;
    request.direction = direction;
    request.epsilon = o_.bodies.epsilon;
    request.effort = o_.bodies.effort;
    request.unit = o_.unit;
    request.preparation.drop_sheets = o_.bodies.drop_sheets;
    const auto note = [&](const std::string& text) { notes.add(named.file, text); };
    const auto made =
        certify_file(named.file, "", request, o_.bodies.cache, {o_.bodies.progress, note});
    if (!made) throw Error(ErrorCode::InvalidInput, too_coarse(named.file));
    for (std::string& line : notes.lines()) out_.notes.push_back(std::move(line));
    out_.inputs.push_back(named.file);
    out_.inputs.insert(out_.inputs.end(), made->other_files.begin(), made->other_files.end());
    return keep(folder_ / (plain_file_name(named.name) + suffix + ".glb"),
                made->found.set.container);
  }

  const SceneMaker& o_;
  fs::path folder_, base_;
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
        throw Error(ErrorCode::InvalidArgument, "the name '" + file.name + "' is there twice");
  return Maker(maker).run();
}

}  // namespace kaboum::tools
