// Meshes and sets to measure, told apart by what is in their files.
#include "shape_file.h"

#include <kaboum/base/error.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/verify/cover.h>

#include <cstdio>
#include <filesystem>
#include <optional>

#include "cli.h"

namespace kaboum::tools {
namespace {

namespace fs = std::filesystem;

void parse_mesh(ShapeFile& out, const std::vector<char>& bytes, io::Format format) {
  const std::string& file = out.shape.name;
  io::ReadResult result = io::parse_mesh(bytes, format, file, fs::path(file).parent_path());
  out.notes.insert(out.notes.end(), result.notes.begin(), result.notes.end());
  if (result.collapsed_triangles != 0)
    out.notes.push_back(std::to_string(result.collapsed_triangles) +
                        (result.collapsed_triangles == 1 ? " triangle" : " triangles") +
                        " with repeated corners left out: no distance from or to the segments "
                        "that they span is measured");
  out.shape.mesh = std::move(result.mesh);
}

/// A set with a margin that is measured as a mesh on request, with a note. False: no such set.
bool parse_without_margin(ShapeFile& out, const std::vector<char>& bytes) {
  geom::ConvexSet set;
  try {
    set = io::parse_convex_set(bytes, io::Format::Glb, out.shape.name);
  } catch (const Error&) {  // the mesh reader says what is wrong
    return false;
  }
  if (!(set.margin > 0)) return false;
  char margin[40];
  std::snprintf(margin, sizeof margin, "%.6g", set.margin);
  out.notes.push_back("read as a mesh: the set's margin of " + std::string(margin) +
                      " is left out");
  out.shape.mesh = verify::sum_of(set);
  return true;
}

/// The file's bodies, where they are meant to be a set; else a note on why not, if there is one.
bool parse_set(ShapeFile& out, const std::vector<char>& bytes, std::optional<io::Format> format,
               bool asked_for) {
  const std::string& file = out.shape.name;
  io::SetReadDetails details;
  geom::ConvexSet set =
      format ? io::parse_convex_set(bytes, *format, file, &details, fs::path(file).parent_path())
             : io::read_convex_set(file, {}, &details);
  const bool several = set.bodies.size() > 1;
  const auto crooked = several ? geom::find_not_convex(set) : std::nullopt;
  if (!asked_for && format && !details.has_record && (!several || crooked)) {
    if (crooked)
      out.notes.push_back("taken as a mesh, not as a set of bodies: body '" +
                          set.bodies[*crooked].name + "' is not exactly convex");
    return false;
  }
  out.sha256 = io::sha256(format ? bytes : details.bytes);
  out.notes = details.notes;
  out.is_set = true;
  out.bodies = set.bodies.size();
  out.margin = set.margin;
  out.shape.set = std::move(set);
  return true;
}

}  // namespace

ShapeFile read_shape(const std::string& path, const ShapeOptions& options) {
  ShapeFile out;
  out.shape.name = path;
  if (path != "-" && is_folder(path)) {
    if (options.as == "mesh")
      throw Error(ErrorCode::InvalidArgument,
                  path + " is a folder, which holds a set of bodies, not a mesh");
    parse_set(out, {}, {}, true);
    return out;
  }
  const bool known =
      path != "-" && io::format_from_name(fs::path(path).extension().string()).has_value();
  const io::Format format =
      format_for(path, known ? std::string() : options.format, "--input-format");
  const std::vector<char> bytes = io::read_file(path);
  out.sha256 = io::sha256(bytes);
  const bool may_be_set = format == io::Format::Glb || format == io::Format::Obj;
  if (options.as == "set" || (options.as == "auto" && may_be_set)) {
    if (parse_set(out, bytes, format, options.as == "set")) return out;
  } else if (format == io::Format::Glb && parse_without_margin(out, bytes)) {
    return out;
  }
  parse_mesh(out, bytes, format);
  return out;
}

}  // namespace kaboum::tools
