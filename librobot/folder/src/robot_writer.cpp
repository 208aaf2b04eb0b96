// A robot with other shapes on its way into a folder: URDF and other formats.

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/inertial_edit.h>
#include <kaboum/robot/model_text.h>
#include <kaboum/robot_folder/robot_writer.h>
#include <kaboum/robot_folder/urdf_text.h>

#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "robot_document.h"
#include "written_files.h"

namespace kaboum::robot_folder {
namespace {

namespace fs = std::filesystem;
using robot::Geometry;

constexpr const char* kMjcf = ".xml";
constexpr const char* kSdf = ".sdf";
constexpr const char* kUsd = ".usda";

/// What MuJoCo does not read of meshes that stay.
void note_unread(const robot::Robot& robot, const std::string& file, const FileNote& note) {
  for (const robot::Link& link : robot.links)
    for (const Geometry& g : link.collision) {
      const auto format = io::format_from_name(fs::path(g.mesh).extension().string());
      if (g.shape != Geometry::Shape::Mesh || format == io::Format::Stl ||
          format == io::Format::Obj)
        continue;
      note(file, "Link '" + link.name + "' keeps " + g.mesh +
                     ", which MuJoCo does not read: STL and OBJ it does.");
    }
}

}  // namespace

struct RobotWriter::State {
  FolderOptions o;
  const robot::RobotFile& robot;
  RobotFolder folder;
  std::unique_ptr<RobotDocument> document;
  std::vector<std::string> links = {};
  std::vector<std::pair<std::string, std::string>> more = {};  ///< extension, text
  std::optional<certify::CacheFolder> cache = {};              ///< none: all is written
  PartsHash meshes_hash = {};                ///< of meshes' places and what is in them
  std::vector<std::string> places = {};      ///< of meshes, relative to the folder
  std::vector<std::string> unverified = {};  ///< links that have a mesh without a file
  robot::MeshOfFile mesh_of = [](const std::string& /*file*/) { return nullptr; };

  [[nodiscard]] std::vector<std::pair<std::string, std::string>> other_formats(
      const NewShapes& shapes, const FileNote& note) const;
  [[nodiscard]] std::vector<std::string> documents() const;
  void write_or_reuse(RobotContents& contents);

  /// A document with a comment that names the links that nothing is claimed of.
  [[nodiscard]] std::string with_unverified(std::string text) const {
    if (unverified.empty()) return text;
    std::string names;
    for (const std::string& link : unverified) names += (names.empty() ? " " : ", ") + link;
    for (std::size_t at = names.find("--"); at != std::string::npos; at = names.find("--"))
      names.replace(at, 2, "- -");  // which ends no comment
    if (text.starts_with("#usda")) text += "# ";
    return text + "<!-- NOT verified, for meshes of theirs are missing and left out:" + names +
           " -->\n";
  }
};

RobotWriter::RobotWriter(FolderOptions options, const std::string& folder,
                         const robot::RobotFile& robot, std::string part, std::string extension)
    : state_(new State{std::move(options), robot,
                       RobotFolder(folder, robot, std::move(part), std::move(extension)),
                       document_of(robot, folder)}) {
  const bool own = robot.format == robot::RobotFile::Format::Mjcf ||
                   robot.format == robot::RobotFile::Format::Sdf;
  if (own && state_->o.urdf)
    throw Error(ErrorCode::InvalidArgument,
                robot.path.string() + ": robots in MJCF or SDF are not written as URDF");
  // Its own format is written in any case.
  if (robot.format == robot::RobotFile::Format::Mjcf) state_->o.mjcf = false;
  if (robot.format == robot::RobotFile::Format::Sdf) state_->o.sdf = false;
}

RobotWriter::~RobotWriter() = default;

const FolderOptions& RobotWriter::options() const { return state_->o; }
const robot::RobotFile& RobotWriter::robot() const { return state_->robot; }
const RobotFolder& RobotWriter::folder() const { return state_->folder; }
RobotFolder& RobotWriter::folder() { return state_->folder; }

void RobotWriter::add_document(std::string extension, std::string text) {
  state_->more.emplace_back(std::move(extension), std::move(text));
}

void RobotWriter::plan(const robot::LinkMeshes& meshes) {
  const robot::ShapeChoice& shapes = state_->o.shapes;
  state_->unverified.clear();
  for (const robot::LinkShape& shape : meshes.shapes) {
    if (!shape.mesh || meshes.meshes[*shape.mesh].missing.empty()) continue;
    const std::string& link = state_->robot.robot.links[shape.link].name;
    if (state_->unverified.empty() || state_->unverified.back() != link)
      state_->unverified.push_back(link);
    state_->document->leave_out(
        shapes.shapes_of(state_->robot.robot.links[shape.link])[shape.index].mesh);
  }
  for (const robot::Link& link : state_->robot.robot.links)
    if (shapes.has(link))
      state_->document->require_shapes(link.name, shapes.visual, shapes.shapes_of(link).size());
  state_->folder.name_meshes(meshes, shapes, state_->document->mesh_stems());
  if (state_->o.mjcf) state_->folder.require_own_document(kMjcf);
  if (state_->o.sdf) state_->folder.require_own_document(kSdf);
  if (state_->o.usd) state_->folder.require_own_document(kUsd);
}

std::vector<std::pair<std::string, std::string>> RobotWriter::State::other_formats(
    const NewShapes& shapes, const FileNote& note) const {
  std::vector<std::pair<std::string, std::string>> out;
  const auto add = [&](const char* extension, robot::ModelText made) {
    for (const std::string& text : made.notes)
      if (note) note(folder.document(extension).string(), text);
    out.emplace_back(extension, std::move(made.text));
  };
  const auto model_with = [&](const std::string& prefix, KeptNames kept) {
    robot::Model model = new_model(robot, o.shapes, shapes, folder.path(), prefix, kept);
    for (const auto& [link, inertial] : o.inertials) model.dynamics.links[link] = inertial;
    return model;
  };
  if (o.mjcf) {
    const robot::Model model = model_with({}, KeptNames::Files);
    if (note) note_unread(model.robot, folder.document(kMjcf).string(), note);
    add(kMjcf, robot::to_mjcf(model));
  }
  if (o.sdf) add(kSdf, robot::to_sdf(model_with(with_slash(o.mesh_prefix), KeptNames::Moved)));
  if (o.usd) add(kUsd, robot::to_usd(model_with({}, KeptNames::Files), mesh_of));
  return out;
}

void RobotWriter::set_meshes(robot::MeshOfFile meshes) { state_->mesh_of = std::move(meshes); }

void RobotWriter::reuse(const certify::CacheFolder& cache,
                        const std::map<std::size_t, std::span<const char>>& meshes) {
  state_->cache = cache;
  std::map<std::string, std::span<const char>> by_name;
  for (const auto& [shape, bytes] : meshes) by_name.emplace(state_->folder.place_of(shape), bytes);
  for (const auto& [place, bytes] : by_name) {
    state_->places.push_back(place);
    state_->meshes_hash.add(state_->places.back());
    state_->meshes_hash.add({bytes.data(), bytes.size()});
  }
}

/// Where all is there already, the robot counts as written now, for Make.
void RobotWriter::State::write_or_reuse(RobotContents& contents) {
  links = RobotFolder::link_files(contents);
  if (!cache) {
    folder.write(contents);
    return;
  }
  PartsHash key = meshes_hash;
  for (const std::string& word : {std::string(KABOUM_VERSION), o.bodies}) key.add(word);
  // What is known of files before they are written, by place.
  std::map<std::string, std::string_view> known;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const std::span<const char> container = contents.links[i].second;
    known.emplace(links[i], std::string_view(container.data(), container.size()));
  }
  for (const auto& [extension, text] : contents.documents)
    known.emplace(folder.document(extension).filename().string(), text);
  const std::string urdf_name = folder.urdf().filename().string();
  std::vector<std::string> all = places;
  for (const auto& [place, bytes] : known) {
    key.add(place);
    key.add(bytes);
    all.push_back(place);
  }
  key.add(urdf_name);
  key.add(contents.urdf);
  all.push_back(urdf_name);
  WrittenFiles files(*cache, folder.path(), key.hash());
  if (files.are_there(all) && !folder.has_other_documents(contents)) {
    std::error_code error;
    for (const std::string& file : documents())
      fs::last_write_time(file, fs::file_time_type::clock::now(), error);
    return;
  }
  contents.write_mesh = [&, write = std::move(contents.write_mesh)](const StoredMesh& mesh,
                                                                    const fs::path& place) {
    write(mesh, place);
    files.note_written(folder.place_of(mesh));
  };
  folder.write(contents);
  for (const auto& [place, bytes] : known) files.note(place, bytes);
  files.note(urdf_name, contents.urdf);
  files.remember();
}

void RobotWriter::write(const NewShapes& shapes, decltype(RobotContents::write_mesh) write_mesh,
                        std::vector<std::pair<std::string, std::span<const char>>> links,
                        const FileNote& note) {
  State& s = *state_;
  RobotContents contents{
      std::move(write_mesh), std::move(links), s.other_formats(shapes, note), {}};
  const MeshNames names{with_slash(state_->o.mesh_prefix), state_->o.declare_convex};
  contents.documents.insert(contents.documents.end(), state_->more.begin(), state_->more.end());
  for (auto& [extension, text] : contents.documents)
    text = s.with_unverified(marked(std::move(text)));
  std::string text = s.document->text(shapes, s.o.shapes.visual, names);
  if (note)
    for (const std::string& said : s.document->notes()) note(s.folder.urdf().string(), said);
  if (!s.o.inertials.empty())
    text = robot::with_inertials(text, s.folder.urdf().string(), s.o.inertials).text;
  contents.urdf = s.with_unverified(marked(std::move(text)));
  s.write_or_reuse(contents);
}

std::vector<std::string> RobotWriter::State::documents() const {
  std::vector<std::string> out{folder.urdf().string()};
  if (o.mjcf) out.push_back(folder.document(kMjcf).string());
  if (o.sdf) out.push_back(folder.document(kSdf).string());
  if (o.usd) out.push_back(folder.document(kUsd).string());
  for (const auto& [extension, text] : more) out.push_back(folder.document(extension).string());
  return out;
}

const std::vector<std::string>& RobotWriter::link_files() const { return state_->links; }

std::vector<std::string> RobotWriter::documents() const { return state_->documents(); }

std::vector<std::string> RobotWriter::stale() const { return state_->folder.stale(state_->links); }

robot::BareLinks RobotWriter::bare_links() const {
  const robot::ShapeChoice& shapes = state_->o.shapes;
  return robot::bare_links(state_->robot.robot, shapes.visual, shapes.links);
}

}  // namespace kaboum::robot_folder
