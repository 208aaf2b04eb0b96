// Meshes and sets to measure, told apart by what is in their files.
#include "shape_file.h"

#include <kaboum/base/error.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/verify/cover.h>

#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

#include "common/cli.h"
#include "common/verdict.h"

namespace kaboum::tools {
namespace {

namespace fs = std::filesystem;

/// Where what a file refers to is looked for.
fs::path folder_of(const std::string& file) {
  const fs::path path(file);
  return path.has_parent_path() ? path.parent_path() : ".";
}

/// Scaled, with the unit that is said.
void take_mesh(ShapeFile& out, io::ReadResult result, const UnitOption& unit) {
  apply(result, unit, out.shape.name);
  out.unit = result.unit;
  out.deviation = result.deviation;
  out.notes.insert(out.notes.end(), result.notes.begin(), result.notes.end());
  if (result.collapsed_triangles != 0)
    out.notes.push_back(std::to_string(result.collapsed_triangles) +
                        (result.collapsed_triangles == 1 ? " triangle" : " triangles") +
                        " with repeated corners left out: no distance from or to the segments "
                        "that they span is measured");
  out.shape.mesh = std::move(result.mesh);
}

/// A set with a margin that is measured as a mesh on request, with a note. False: no such set.
bool parse_without_margin(ShapeFile& out, const std::vector<char>& bytes, const UnitOption& unit) {
  geom::ConvexSet set;
  io::SetReadDetails details;
  try {
    set = io::parse_convex_set(bytes, io::Format::Glb, out.shape.name, &details);
  } catch (const Error&) {  // the mesh reader says what is wrong
    return false;
  }
  if (geom::margin_of(set) == 0.0) return false;
  if (!geom::margin_of(set))
    throw Error(ErrorCode::InvalidInput,
                out.shape.name +
                    ": its bodies have radii of their own, and are no mesh; measure solid to solid "
                    "(--solid)");
  char margin[40];
  std::snprintf(margin, sizeof margin, "%.6g", *geom::margin_of(set));
  out.notes.push_back("read as a mesh: the set's margin of " + std::string(margin) +
                      " is left out");
  io::ReadResult bodies;
  bodies.mesh = verify::sum_of(set);
  bodies.unit = details.unit;
  take_mesh(out, std::move(bodies), unit);
  return true;
}

/// The file's bodies, where they are meant to be a set; else a note on why not, if there is one.
bool parse_set(ShapeFile& out, const std::vector<char>& bytes, std::optional<io::Format> format,
               bool asked_for) {
  const std::string& file = out.shape.name;
  io::SetReadDetails details;
  geom::ConvexSet set = format
                            ? io::parse_convex_set(bytes, *format, file, &details, folder_of(file))
                            : io::read_convex_set(file, {}, &details);
  const bool several = set.bodies.size() > 1;
  const auto crooked = several ? geom::find_not_convex(set) : std::nullopt;
  if (!asked_for && format && !io::is_meant_as_set(set, details)) {
    if (crooked)
      out.notes.push_back("taken as a mesh, not as a set of bodies: body '" +
                          set.bodies[*crooked].name + "' is not exactly convex");
    return false;
  }
  out.sha256 = io::sha256(format ? bytes : details.bytes);
  out.unit = details.unit;
  out.notes = details.notes;
  out.is_set = true;
  out.bodies = set.bodies.size();
  out.margin = margin_json(set);
  out.shape.set = std::move(set);
  return true;
}

/// A set says itself what it is in.
ShapeFile with_unit(ShapeFile out, const UnitOption& option) {
  if (option.scale != 1)
    throw Error(ErrorCode::InvalidArgument,
                "--scale is for meshes, and " + out.shape.name +
                    " is a set of bodies, whose record would not hold: have it made anew with "
                    "--scale" +
                    (is_folder(out.shape.name) ? "" : ", or measure it as a mesh (--a-as mesh)"));
  if (out.unit.empty()) out.unit = option.unit;
  if (!option.unit.empty() && option.unit != out.unit)
    throw Error(ErrorCode::InvalidInput,
                out.shape.name + ": it is in " + out.unit + ", not in " + option.unit);
  return out;
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
    return with_unit(std::move(out), options.unit);
  }
  const bool known =
      path != "-" && io::format_from_name(fs::path(path).extension().string()).has_value();
  const io::Format format = format_for(path, known ? InputFormat{} : options.format);
  const std::vector<char> bytes = io::read_file(path);
  out.sha256 = io::sha256(bytes);
  const bool may_be_set = format == io::Format::Glb || format == io::Format::Obj;
  if (options.as == "set" || (options.as == "auto" && may_be_set)) {
    if (parse_set(out, bytes, format, options.as == "set"))
      return with_unit(std::move(out), options.unit);
  } else if (format == io::Format::Glb && parse_without_margin(out, bytes, options.unit)) {
    return out;
  }
  take_mesh(out, io::parse_mesh(bytes, format, path, folder_of(path)), options.unit);
  return out;
}

}  // namespace kaboum::tools
