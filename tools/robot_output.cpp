// The folder of a robot with other shapes: URDF and other formats, and what is said of them.

#include "robot_output.h"

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>

#include <string_view>
#include <system_error>
#include <utility>

#include "cli.h"
#include "urdf_output.h"

namespace kaboum::tools {
namespace {

namespace fs = std::filesystem;
using robot::Geometry;

constexpr const char* kMjcf = ".xml";
constexpr const char* kSdf = ".sdf";

/// What MuJoCo does not read of meshes that stay.
void note_unread(const robot::Robot& robot, const std::string& file, Notes& notes) {
  for (const robot::Link& link : robot.links)
    for (const Geometry& g : link.collision) {
      const auto format = io::format_from_name(fs::path(g.mesh).extension().string());
      if (g.shape != Geometry::Shape::Mesh || format == io::Format::Stl ||
          format == io::Format::Obj)
        continue;
      notes.add(file, "Link '" + link.name + "' keeps " + g.mesh +
                          ", which MuJoCo does not read: STL and OBJ it does.");
    }
}

}  // namespace

std::string counted(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + ' ' + (n == 1 ? one : many);
}

void require_robot_folder(const std::string& output, const std::string& output_format) {
  if (!output_format.empty() || output == "-" || output.empty())
    throw Error(ErrorCode::InvalidArgument, "-o: a robot's bodies need a folder");
  const fs::path folder(output);
  const bool names_file = is_robot(output) || io::format_from_name(folder.extension().string());
  if (names_file && !is_folder(folder))
    throw Error(ErrorCode::InvalidArgument,
                "-o: a robot's bodies need a folder, which gets a URDF, the bodies and a container "
                "per link; name one without the extension of a file, such as " +
                    fs::path(folder).replace_extension().string() + ", not " + output);
}

RobotOutput::RobotOutput(const RobotOptions& options, const std::string& output,
                         const robot::RobotFile& robot, std::string part, std::string extension)
    : o_(options),
      robot_(robot),
      folder_(output, robot, std::move(part), std::move(extension)),
      urdf_(robot, output) {}

void RobotOutput::plan(const robot::LinkMeshes& meshes) {
  const robot::ShapeChoice shapes = choice();
  for (const robot::Link& link : robot_.robot.links)
    if (shapes.has(link))
      urdf_.require_shapes(link.name, shapes.visual, shapes.shapes_of(link).size());
  folder_.name_meshes(meshes, shapes, urdf_.mesh_stems());
  if (o_.writes("mjcf")) folder_.require_own_document(kMjcf);
  if (o_.writes("sdf")) folder_.require_own_document(kSdf);
}

std::vector<std::pair<std::string, std::string>> RobotOutput::other_formats(const NewShapes& shapes,
                                                                            Notes& notes) const {
  std::vector<std::pair<std::string, std::string>> out;
  const auto add = [&](const char* extension, robot::ModelText made) {
    for (const std::string& text : made.notes)
      notes.add(folder_.document(extension).string(), text);
    out.emplace_back(extension, std::move(made.text));
  };
  if (o_.writes("mjcf")) {
    const robot::Model model =
        new_model(robot_, urdf_.original(), choice(), shapes, folder_.path(), {}, KeptNames::Files);
    note_unread(model.robot, folder_.document(kMjcf).string(), notes);
    add(kMjcf, robot::to_mjcf(model));
  }
  if (o_.writes("sdf"))
    add(kSdf, robot::to_sdf(new_model(robot_, urdf_.original(), choice(), shapes, folder_.path(),
                                      with_slash(o_.prefix), KeptNames::Moved)));
  return out;
}

void RobotOutput::reuse(const certify::CacheFolder& cache,
                        const std::map<std::size_t, std::span<const char>>& meshes) {
  cache_ = cache;
  std::map<std::string, std::span<const char>> by_name;
  for (const auto& [shape, bytes] : meshes) by_name.emplace(folder_.place_of(shape), bytes);
  for (const auto& [place, bytes] : by_name) {
    places_.push_back(place);
    meshes_hash_.add(places_.back());
    meshes_hash_.add({bytes.data(), bytes.size()});
  }
}

/// Where all is there already, the robot counts as written now, for Make.
void RobotOutput::write_or_reuse(RobotContents& contents) {
  links_ = RobotFolder::link_files(contents);
  if (!cache_) {
    folder_.write(contents);
    return;
  }
  PartsHash key = meshes_hash_;
  for (const std::string& word : {std::string(version()), o_.bodies}) key.add(word);
  // What is known of files before they are written, by place.
  std::map<std::string, std::string_view> known;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const std::span<const char> container = contents.links[i].second;
    known.emplace(links_[i], std::string_view(container.data(), container.size()));
  }
  for (const auto& [extension, text] : contents.documents)
    known.emplace(folder_.document(extension).filename().string(), text);
  const std::string urdf = folder_.urdf().filename().string();
  std::vector<std::string> places = places_;
  for (const auto& [place, bytes] : known) {
    key.add(place);
    key.add(bytes);
    places.push_back(place);
  }
  key.add(urdf);
  key.add(contents.urdf);
  places.push_back(urdf);
  RobotFiles files(*cache_, folder_.path(), key.hash());
  if (files.are_there(places) && !folder_.has_other_documents(contents)) {
    std::error_code error;
    for (const std::string& file : documents())
      fs::last_write_time(file, fs::file_time_type::clock::now(), error);
    return;
  }
  contents.write_mesh = [&, write = std::move(contents.write_mesh)](const StoredMesh& mesh,
                                                                    const fs::path& place) {
    write(mesh, place);
    files.note_written(folder_.place_of(mesh));
  };
  folder_.write(contents);
  for (const auto& [place, bytes] : known) files.note(place, bytes);
  files.note(urdf, contents.urdf);
  files.remember();
}

void RobotOutput::write(const NewShapes& shapes, decltype(RobotContents::write_mesh) write_mesh,
                        std::vector<std::pair<std::string, std::span<const char>>> links,
                        Notes& notes) {
  RobotContents contents{std::move(write_mesh), std::move(links), other_formats(shapes, notes), {}};
  const MeshNames names{with_slash(o_.prefix), o_.declare_convex};
  for (std::size_t l = 0; l < shapes.size(); ++l) {
    const std::string& name = robot_.robot.links[l].name;
    if (shapes[l].empty())
      urdf_.keep(name);
    else
      urdf_.replace(name, o_.visual(), shapes[l], names);
  }
  contents.documents.insert(contents.documents.end(), more_.begin(), more_.end());
  for (auto& [extension, text] : contents.documents) text = marked(std::move(text));
  contents.urdf = marked(urdf_.text());
  write_or_reuse(contents);
}

std::vector<std::string> RobotOutput::documents() const {
  std::vector<std::string> out{folder_.urdf().string()};
  if (o_.writes("mjcf")) out.push_back(folder_.document(kMjcf).string());
  if (o_.writes("sdf")) out.push_back(folder_.document(kSdf).string());
  for (const auto& [extension, text] : more_) out.push_back(folder_.document(extension).string());
  return out;
}

robot::BareLinks RobotOutput::bare() const {
  return robot::bare_links(robot_.robot, o_.visual(), o_.links);
}

void RobotOutput::say(bool quiet, const Notes& notes) const {
  const bool visual = o_.visual();
  const std::string& part = folder_.part();
  log(quiet, how_meshes_are_found(folder_.urdf(), part, with_slash(o_.prefix)));
  for (const std::string& text : notes.lines()) log(quiet, text);
  for (const std::string& text : robot::notes_on_flat_shapes(robot_, visual, o_.links))
    log(quiet, text);
  const std::vector<std::string> old = folder_.stale(links_);
  if (!old.empty())
    log(quiet, folder_.path().string() + ": " + robot::names_of(old) +
                   (old.size() == 1 ? " is" : " are") +
                   " not of this result (perhaps of an earlier one), and left there");
  for (const std::string& text :
       robot::notes_on({{}, bare().other}, visual,
                       visual ? ", which stay as they are"
                              : ": nothing of this is covered (--visual covers those)"))
    log(quiet, robot_.path.string() + ": " + text);
}

Json RobotOutput::report() const {
  const std::vector<std::string> files = documents();
  return {{"urdf", files.front()},
          {"documents", files},
          {"stale", folder_.stale(links_)},
          {"links_without_shapes", bare().all()}};
}

}  // namespace kaboum::tools
