// The verdict on a motion, from the files of robot, path and bodies.

#include <kaboum/base/error.h>
#include <kaboum/base/sha256.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/robot/mesh_files.h>
#include <kaboum/verify/motion_verdict.h>
#include <kaboum/verify/moving_robot.h>

#include <filesystem>
#include <utility>

namespace kaboum::verify {
namespace {

using robot::Geometry;

/// A mesh of the robot as the file has it, or as prepared where that can be.
/// @param exact  points of its exact faces, where it has any
geom::Mesh read_link_mesh(const std::string& path, const MotionShapeOptions& o, MotionShapes& out,
                          ExactPoints& exact) {
  std::vector<char> bytes;
  io::ReadResult read = io::read_mesh(path, {}, &bytes);
  if (o.exact_points > 0 && io::is_cad(read.format))
    exact = read_exact_points(bytes, read.format, path, o.exact_points, 1, read.exact_faces);
  for (const std::string& note : read.notes) out.mesh_notes.add(path, note);
  out.cad = out.cad || io::is_cad(read.format);
  if (!o.prepare) return std::move(read.mesh);
  try {
    const geom::Prepared prepared =
        geom::prepare(read.mesh, {.drop_sheets = o.drop_sheets, .holes = geom::Holes::Fill});
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

/// The shapes of one link.
void add_link(const robot::RobotFile& file, std::uint32_t index, const MotionShapeOptions& o,
              robot::MeshFiles& files, MotionShapes& out) {
  const robot::Link& link = file.robot.links[index];
  ++out.asked;
  std::size_t count = 0;
  const std::size_t before = out.shapes.size();
  for (const Geometry& g : o.choice.shapes_of(link)) {
    geom::Mesh mesh;
    ExactPoints exact;
    if (g.shape == Geometry::Shape::Mesh) {
      out.files.push_back(files.only(g.mesh).string());
      mesh = read_link_mesh(out.files.back(), o, out, exact);
    }
    const std::string name = link.name + "/" + std::to_string(count++);
    auto shape = moving_shape(file.robot, index, g, std::move(mesh));
    if (!shape) continue;
    shape->name = name;
    if (!exact.points.empty())
      out.exact.push_back({name, scaled(std::move(exact), g.size), shape->chain});
    out.shapes.push_back(std::move(*shape));
    out.links.push_back(index);
  }
  if (out.shapes.size() > before) ++out.judged;
}

/// The only link's collision shapes, meshes in the link's frame and unit.
geom::ConvexSet read_swept_urdf(const std::string& path, const std::vector<std::string>& packages,
                                std::vector<char>& bytes) {
  const robot::RobotFile file = robot::read_robot(path);
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::InvalidInput,
                path + ": " + why +
                    "; a swept volume as sweep-approx writes it is the collision meshes of one "
                    "link, neither moved nor scaled");
  };
  if (file.robot.links.size() != 1) refuse("it has several links");
  bytes = io::read_file(path);
  geom::ConvexSet set;
  robot::MeshFiles files(path, packages);
  for (const Geometry& g : file.robot.links[0].collision) {
    if (g.shape != Geometry::Shape::Mesh) refuse("it has a " + describe(g));
    if (!g.origin.linear.isIdentity(0) || !g.origin.translation.isZero(0) || !g.size.isOnes(0))
      refuse("a mesh is moved or scaled");
    const std::filesystem::path mesh = files.only(g.mesh);
    std::vector<char> more;
    set.bodies.push_back({mesh.filename().string(), io::read_mesh(mesh, {}, &more).mesh});
    bytes.insert(bytes.end(), more.begin(), more.end());
  }
  if (set.bodies.empty()) refuse("it has no collision shape");
  return set;
}

}  // namespace

MotionShapes read_motion_shapes(const robot::RobotFile& file, const MotionShapeOptions& o) {
  const std::vector<std::string>& links = o.choice.links;
  robot::require_links(file, links);
  const bool visual = o.choice.visual;
  MotionShapes out;
  out.bare = robot::bare_links(file.robot, visual, links);
  out.notes = file.robot.notes;
  for (const std::string& note : robot::notes_on_flat_shapes(file, visual, links))
    out.notes.push_back(note);
  for (const std::string& note : robot::notes_on(out.bare, visual, ": nothing of this is judged"))
    out.notes.push_back(file.path.string() + ": " + note);
  robot::MeshFiles files(file.path, o.choice.packages);
  for (std::uint32_t l = 0; l < file.robot.links.size(); ++l)
    if (o.choice.has(file.robot.links[l])) add_link(file, l, o, files, out);
  if (out.shapes.empty())
    throw Error(ErrorCode::InvalidInput, file.path.string() + ": no link has a shape" +
                                             (visual ? "" : "; try «geometry=visual»"));
  return out;
}

SweptBodies read_swept_bodies(const std::string& path, std::optional<io::Format> format,
                              const std::vector<std::string>& packages) {
  io::SetReadDetails details;
  SweptBodies out;
  if (!format && std::filesystem::path(path).extension() == ".urdf")
    out.set = read_swept_urdf(path, packages, details.bytes);
  else
    out.set = io::read_convex_set(path, format, &details);
  out.sha256 = sha256(details.bytes);
  out.notes = std::move(details.notes);
  return out;
}

MotionVerdict decide(const MotionQuestion& q) {
  ensure(same_poses(q.robot, q.shapes.shapes, q.shapes.links, q.path),
         "two ways to compute a link's pose disagree");
  MotionVerdict out;
  SweepOptions options;
  options.gap = out.gap = q.gap.value_or(default_gap(q.set));
  options.max_cells = q.max_cells;
  options.solids = q.claims != Claims::Surface;
  options.progress = q.progress;
  out.claims = verify_sweep(q.shapes.shapes, q.path, q.set, options);
  out.answer = answer_of(out.claims, q.claims);
  if (q.shapes.exact.empty()) return out;
  if (q.progress) q.progress("points of exact faces");
  out.exact = verify_moving_points(q.shapes.exact, q.path, q.set);
  if (out.exact) out.answer = worse(out.answer, out.exact->points.answer);
  return out;
}

}  // namespace kaboum::verify
