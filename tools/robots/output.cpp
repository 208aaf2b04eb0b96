// What is said of the folder of a robot with other shapes.

#include "output.h"

#include <kaboum/base/counted.h>
#include <kaboum/base/error.h>
#include <kaboum/certify/large_epsilon.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot_folder/urdf_text.h>

#include "common/cli.h"
#include "urdf_output.h"

namespace kaboum::tools {

namespace fs = std::filesystem;

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
  std::error_code error;
  if (fs::exists(folder, error) && !is_folder(folder))
    throw Error(ErrorCode::OutputFailed,
                output + ": is a file, and a robot's bodies need a folder; name another place");
}

robot_folder::FolderOptions folder_options(const RobotOptions& o) {
  return {.shapes = o.shapes,
          .mesh_prefix = o.prefix,
          .mjcf = o.writes("mjcf"),
          .sdf = o.writes("sdf"),
          .usd = o.writes("usd"),
          .urdf = o.writes("urdf"),
          .bodies = o.bodies,
          .declare_convex = o.declare_convex};
}

robot_folder::FileNote note_in(Notes& notes) {
  return [&notes](const std::string& file, const std::string& text) { notes.add(file, text); };
}

namespace {

/// The first lines and, of too many, how many there are.
void log_some(const std::vector<std::string>& lines, bool all, bool quiet) {
  constexpr std::size_t kMost = 4;
  const std::size_t shown = all || lines.size() <= kMost ? lines.size() : kMost - 1;
  for (std::size_t i = 0; i < shown; ++i) log(quiet, lines[i]);
  if (shown < lines.size())
    log(quiet,
        "and " + std::to_string(lines.size() - shown) + " more such notes: --verbose prints them");
}

}  // namespace

void say_notes(const RobotOptions& options, bool quiet, const Notes& notes) {
  const std::vector<std::string> lines = notes.lines();
  if (options.verbose) {
    for (const std::string& text : lines) log(quiet, text);
    return;
  }
  const auto is_of_epsilon = [](std::string_view text) {
    return text.starts_with(certify::kLargeEpsilonWarning);
  };
  const std::vector<std::string> of_epsilon = notes.lines(is_of_epsilon);
  const std::vector<std::string> others = notes.lines(
      [&](std::string_view text) { return text.starts_with(kWarning) && !is_of_epsilon(text); });
  for (const std::string& text : others) log(quiet, text);
  log_some(of_epsilon, false, quiet);
  const std::size_t left = lines.size() - others.size() - of_epsilon.size();
  if (left > 0)
    log(quiet,
        counted(left, "note", "notes") +
            " on how meshes are read and prepared: --verbose prints them, reports have them");
}

void say(const robot_folder::RobotWriter& writer, const RobotOptions& options, bool quiet) {
  const robot_folder::FolderOptions& o = writer.options();
  const bool visual = o.shapes.visual;
  const robot_folder::RobotFolder& folder = writer.folder();
  if (writer.robot().format == robot::RobotFile::Format::Urdf)
    log(quiet, how_meshes_are_found(folder.urdf(), folder.part(),
                                    robot_folder::with_slash(o.mesh_prefix)));
  const robot::Robot& robot = writer.robot().robot;
  log_some(robot.notes, options.verbose, quiet);
  std::vector<std::string> unmodelled = robot.unmodelled;
  for (std::string& text : unmodelled) text += "; the shapes of links do not depend on it";
  log_some(unmodelled, options.verbose, quiet);
  log_some(robot::notes_on_flat_shapes(writer.robot(), visual, o.shapes.links), options.verbose,
           quiet);
  const std::vector<std::string> old = writer.stale();
  if (!old.empty())
    log(quiet, folder.path().string() + ": " + robot::names_of(old) +
                   (old.size() == 1 ? " is" : " are") +
                   " not of this result (perhaps of an earlier one), and left there");
  for (const std::string& text :
       robot::notes_on({{}, writer.bare_links().other}, visual,
                       visual ? ", which stay as they are"
                              : ": nothing of this is covered (--visual covers those)"))
    log(quiet, writer.robot().path.filename().string() + ": " + text);
}

Json report_of(const robot_folder::RobotWriter& writer) {
  const std::vector<std::string> files = writer.documents();
  return {{"urdf", files.front()},
          {"documents", files},
          {"stale", writer.stale()},
          {"links_without_shapes", writer.bare_links().all()}};
}

}  // namespace kaboum::tools
