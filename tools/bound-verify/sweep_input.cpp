// What bound-verify sweep reads: robot, path, set, and the meshes of links as they are or
// prepared.

#include "sweep_input.h"

#include <kaboum/base/error.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/robot/mesh_files.h>
#include <kaboum/verify/exact_points.h>
#include <kaboum/verify/moving_robot.h>

#include <algorithm>
#include <sstream>

#include "mesh_input.h"

namespace kaboum::tools {
namespace {

using robot::Geometry;

/// A mesh of the robot as the file has it, or as prepared where that can be.
/// @param exact  points of its exact faces, where it has any
geom::Mesh read_link_mesh(const std::string& path, const VerifySweepOptions& o, SweepShapes& out,
                          verify::ExactPoints& exact) {
  std::vector<char> bytes;
  io::ReadResult read = io::read_mesh(path, {}, &bytes);
  if (o.exact_points > 0 && io::is_cad(read.format))
    exact =
        verify::read_exact_points(bytes, read.format, path, o.exact_points, 1, read.exact_faces);
  for (const std::string& note : read.notes) out.mesh_notes.add(path, note);
  out.cad = out.cad || io::is_cad(read.format);
  if (!o.prepare) return std::move(read.mesh);
  try {
    const geom::Prepared prepared = prepare_original(read.mesh, o.drop_sheets, true);
    for (const std::string& note : prepared.report.notes) out.mesh_notes.add(path, note);
    if (prepared.report.dropped_sheets > 0) out.dropped[path] = prepared.report.dropped_sheets;
    return prepared.solid.mesh();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::InvalidInput || o.drop_sheets)
      throw Error(error.code(), path + ": " + error.what());
    out.mesh_notes.add(path,
                       std::string("judged as it is, for it cannot be prepared: ") + error.what());
    return std::move(read.mesh);
  }
}

std::vector<std::string> listed(const std::string& text) {
  std::vector<std::string> names;
  std::istringstream list(text);
  for (std::string name; std::getline(list, name, ',');)
    if (!name.empty()) names.push_back(name);
  return names;
}

/// The shapes of one link.
void add_link(const robot::RobotFile& file, std::uint32_t index, const VerifySweepOptions& o,
              SweepShapes& out) {
  const robot::Link& link = file.robot.links[index];
  ++out.asked;
  std::size_t count = 0;
  const std::size_t before = out.shapes.size();
  for (const Geometry& g : o.geometry == "visual" ? link.visual : link.collision) {
    geom::Mesh mesh;
    verify::ExactPoints exact;
    if (g.shape == Geometry::Shape::Mesh) {
      out.files.push_back(robot::find_only_mesh(g.mesh, file.path, o.packages).string());
      mesh = read_link_mesh(out.files.back(), o, out, exact);
    }
    const std::string name = link.name + "/" + std::to_string(count++);
    auto shape = verify::moving_shape(file.robot, index, g, std::move(mesh));
    if (!shape) continue;
    shape->name = name;
    if (!exact.points.empty())
      out.exact.push_back({name, verify::scaled(std::move(exact), g.size), shape->chain});
    out.shapes.push_back(std::move(*shape));
    out.links.push_back(index);
  }
  if (out.shapes.size() > before) ++out.judged;
}

/// The bodies of a URDF as sweep-approx writes it: the only link's collision shapes, meshes in the
/// link's frame and unit.
geom::ConvexSet read_swept_urdf(const std::string& path, const VerifySweepOptions& o,
                                io::SetReadDetails& details) {
  const robot::RobotFile file = robot::read_robot(path);
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::InvalidInput, path + ": " + why +
                                             "; a swept volume as sweep-approx writes it is the "
                                             "collision meshes of one link, neither moved nor "
                                             "scaled");
  };
  if (file.robot.links.size() != 1) refuse("it has several links");
  details.bytes = io::read_file(path);
  geom::ConvexSet set;
  for (const Geometry& g : file.robot.links[0].collision) {
    if (g.shape != Geometry::Shape::Mesh) refuse("it has a " + describe(g));
    if (!g.origin.linear.isIdentity(0) || !g.origin.translation.isZero(0) || !g.size.isOnes(0))
      refuse("a mesh is moved or scaled");
    const std::filesystem::path mesh = robot::find_only_mesh(g.mesh, file.path, o.packages);
    std::vector<char> bytes;
    set.bodies.push_back({mesh.filename().string(), io::read_mesh(mesh, {}, &bytes).mesh});
    details.bytes.insert(details.bytes.end(), bytes.begin(), bytes.end());
  }
  if (set.bodies.empty()) refuse("it has no collision shape");
  return set;
}

}  // namespace

SweepShapes read_shapes(const robot::RobotFile& file, const VerifySweepOptions& o) {
  const std::vector<std::string> wanted = listed(o.links);
  robot::require_links(file, wanted);
  const bool visual = o.geometry == "visual";
  SweepShapes out;
  out.bare = robot::bare_links(file.robot, visual, wanted);
  out.notes = robot::notes_on_flat_shapes(file, visual, wanted);
  for (const std::string& note : robot::notes_on(out.bare, visual, ": nothing of this is judged"))
    out.notes.push_back(o.files[0] + ": " + note);
  for (std::uint32_t l = 0; l < file.robot.links.size(); ++l)
    if (wanted.empty() ||
        std::find(wanted.begin(), wanted.end(), file.robot.links[l].name) != wanted.end())
      add_link(file, l, o, out);
  if (out.shapes.empty()) {
    std::string why = file.path.string();
    why += ": no link has a shape";
    if (!visual) why += "; try --geometry visual";
    throw Error(ErrorCode::InvalidInput, why);
  }
  return out;
}

std::string preparing_hint(const SweepShapes& shapes) {
  std::string changed;
  for (const std::string& path : shapes.files) {
    const geom::Mesh mesh = io::read_mesh(path).mesh;
    const auto prepared = [&](bool drop_sheets) -> std::optional<geom::Prepared> {
      try {
        return prepare_original(mesh, drop_sheets, true);
      } catch (const Error&) {
        return std::nullopt;
      }
    };
    if (const auto plain = prepared(false)) {
      if (changed.empty() && !plain->report.notes.empty()) changed = path;
    } else if (prepared(true)) {
      return path +
             ": sweep-approx takes it with --drop-sheets only, and as prepared; --prepare "
             "--drop-sheets judges that";
    }
  }
  if (changed.empty()) return {};
  return changed + ": sweep-approx speaks of the mesh as prepared; --prepare judges that";
}

SweptInput read_swept(const std::string& path, const VerifySweepOptions& o) {
  io::SetReadDetails details;
  SweptInput out;
  if (o.set_format.empty() && std::filesystem::path(path).extension() == ".urdf") {
    out.set = read_swept_urdf(path, o, details);
  } else {
    std::optional<io::Format> format;
    if (!is_folder(path)) format = format_for(path, o.set_format, "--approximation-format");
    out.set = io::read_convex_set(path, format, &details);
  }
  out.sha256 = io::sha256(details.bytes);
  out.notes = std::move(details.notes);
  return out;
}

}  // namespace kaboum::tools
