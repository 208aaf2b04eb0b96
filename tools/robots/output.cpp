// What is said of the folder of a robot with other shapes.

#include "output.h"

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot_folder/urdf_text.h>

#include "common/cli.h"
#include "urdf_output.h"

namespace kaboum::tools {

namespace fs = std::filesystem;

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

robot_folder::FolderOptions folder_options(const RobotOptions& o) {
  return {.shapes = o.shapes,
          .mesh_prefix = o.prefix,
          .mjcf = o.writes("mjcf"),
          .sdf = o.writes("sdf"),
          .urdf = o.writes("urdf"),
          .bodies = o.bodies,
          .declare_convex = o.declare_convex};
}

robot_folder::FileNote note_in(Notes& notes) {
  return [&notes](const std::string& file, const std::string& text) { notes.add(file, text); };
}

void say(const robot_folder::RobotWriter& writer, bool quiet, const Notes& notes) {
  const robot_folder::FolderOptions& o = writer.options();
  const bool visual = o.shapes.visual;
  const robot_folder::RobotFolder& folder = writer.folder();
  if (writer.robot().format == robot::RobotFile::Format::Urdf)
    log(quiet, how_meshes_are_found(folder.urdf(), folder.part(),
                                    robot_folder::with_slash(o.mesh_prefix)));
  for (const std::string& text : notes.lines()) log(quiet, text);
  const robot::Robot& robot = writer.robot().robot;
  for (const std::string& text : robot.notes) log(quiet, text);
  for (const std::string& text : robot.unmodelled)
    log(quiet, text + "; the shapes of links do not depend on it");
  for (const std::string& text :
       robot::notes_on_flat_shapes(writer.robot(), visual, o.shapes.links))
    log(quiet, text);
  const std::vector<std::string> old = writer.stale();
  if (!old.empty())
    log(quiet, folder.path().string() + ": " + robot::names_of(old) +
                   (old.size() == 1 ? " is" : " are") +
                   " not of this result (perhaps of an earlier one), and left there");
  for (const std::string& text :
       robot::notes_on({{}, writer.bare_links().other}, visual,
                       visual ? ", which stay as they are"
                              : ": nothing of this is covered (--visual covers those)"))
    log(quiet, writer.robot().path.string() + ": " + text);
}

Json report_of(const robot_folder::RobotWriter& writer) {
  const std::vector<std::string> files = writer.documents();
  return {{"urdf", files.front()},
          {"documents", files},
          {"stale", writer.stale()},
          {"links_without_shapes", writer.bare_links().all()}};
}

}  // namespace kaboum::tools
