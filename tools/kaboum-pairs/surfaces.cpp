// The meshes of a robot's links.

#include "surfaces.h"

#include <kaboum/base/error.h>
#include <kaboum/base/notes.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/geom/topology.h>
#include <kaboum/robot/exact_shapes.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace kaboum::tools {
namespace {

using geom::Mesh;
using geom::Vec3;
using robot::Geometry;

void append(Mesh& all, const Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(all.vertices.size());
  all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const geom::Triangle& t : mesh.triangles)
    all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

/// Triangles as a sheet with two sides, so that what is closed stays closed with them.
void append_sheet(Mesh& all, const Mesh& mesh) {
  Mesh both = mesh;
  for (const geom::Triangle& t : mesh.triangles) both.triangles.push_back({t[0], t[2], t[1]});
  append(all, both);
}

/// Of a shape that is round, a polytope that lies in it: the corners of the one that encloses it,
/// moved onto its surface, and a little less. Empty where rounding leaves nothing.
Mesh inscribed(const Geometry& shape) {
  constexpr double kDown = 1 - 1e-9;
  std::vector<Vec3> points;
  for (const Vec3& corner : robot::bounding_points(shape)) {
    const Vec3 p = shape.origin.linear.transpose() * (corner - shape.origin.translation);
    const double radius = shape.size.x() * kDown, half = 0.5 * shape.size.y() * kDown;
    const double end = p.z() > 0 ? half : -half;
    Vec3 q;
    switch (shape.shape) {
      case Geometry::Shape::Sphere:
        q = radius * p.normalized();
        break;
      case Geometry::Shape::Capsule:
        q = Vec3(0, 0, end) + radius * (p - Vec3(0, 0, end)).normalized();
        break;
      case Geometry::Shape::Ellipsoid:
        q = kDown * shape.size.cwiseProduct(p.cwiseQuotient(shape.size).normalized());
        break;
      default: {
        const double across = std::hypot(p.x(), p.y());
        q = {p.x() / across * radius, p.y() / across * radius, end};
      }
    }
    if (!q.allFinite()) return {};
    points.push_back(shape.origin * q);
  }
  return geom::convex_hull(points).value_or(Mesh{});
}

bool is_round(const Geometry& shape) {
  using Shape = Geometry::Shape;
  return shape.shape == Shape::Cylinder || shape.shape == Shape::Sphere ||
         shape.shape == Shape::Capsule || shape.shape == Shape::Ellipsoid;
}

/// What the shapes of a link become.
struct Made {
  Mesh outer, inner;
  bool same = true;  ///< inner is outer
  std::vector<std::string> unsure, guess;
};

void add_primitive(const Geometry& shape, Made& out) {
  const std::optional<Mesh> hull =
      robot::is_point(shape) ? std::nullopt : geom::convex_hull(robot::bounding_points(shape));
  if (!hull) {
    out.unsure.push_back("a " + robot::describe(shape) + " is a point, which has no mesh");
    out.same = false;
    return;
  }
  append(out.outer, *hull);
  if (!robot::is_flat(shape)) append(out.inner, is_round(shape) ? inscribed(shape) : *hull);
  out.same = out.same && !is_flat(shape) && !is_round(shape);
}

/// Whether a surface has a border, of which it is not known what closes it: an edge of one
/// triangle, copies taken for one, or one that is not walked along as often either way (two open
/// surfaces may share a rim).
bool has_border(const Mesh& exact) {
  const Mesh mesh = geom::weld(exact);
  struct Across {
    std::vector<std::uint32_t> apexes;
    int forwards = 0;  ///< less backwards
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Across> across;
  for (const geom::Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      Across& edge = across[{std::min(a, b), std::max(a, b)}];
      edge.apexes.push_back(t[(k + 2) % 3]);
      edge.forwards += a < b ? 1 : -1;
    }
  return std::ranges::any_of(across, [](const auto& edge) {
    const std::vector<std::uint32_t>& apexes = edge.second.apexes;
    return edge.second.forwards != 0 ||
           std::ranges::count(apexes, apexes.front()) == std::ssize(apexes);
  });
}

/// The convex hull, a little thicker where all is in a plane. nullopt: it is too large or too
/// small.
std::optional<Mesh> hull_of(const Mesh& mesh) {
  std::vector<Vec3> points = geom::weld(mesh).vertices;
  geom::Box3 box;
  for (const Vec3& p : points) box.extend(p);
  const double most = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  if (!(most < 1e50)) return std::nullopt;
  std::optional<Mesh> hull = geom::convex_hull(points);
  if (hull) return hull;
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
    for (const double more : {-1e-6, 1e-6})
      points.push_back(box.center() + more * (box.diagonal() + most) * axis);
  return geom::convex_hull(points);
}

/// A mesh whose solid is a guess. What it means is no more than its triangles shut off, or than its
/// convex hull where it is not known what closes them.
void add_guess(const Mesh& mesh, bool bordered, const std::string& why, Made& out) {
  const std::optional<Mesh> hull = bordered ? hull_of(mesh) : std::nullopt;
  if (bordered && !hull) {
    append(out.outer, mesh);
    out.unsure.push_back(why);
    return;
  }
  append(out.outer, bordered ? *hull : mesh);
  out.guess.push_back(why + (bordered ? ": proofs are of its convex hull"
                                      : ": proofs are of all that its triangles shut off"));
  out.same = out.same && !bordered;
}

/// The solid of a mesh file, with all of its triangles.
void add_mesh(const Mesh& exact, Made& out) {
  const auto prepared = [&](bool drop_sheets) {
    return geom::prepare(exact, {.drop_sheets = drop_sheets, .holes = geom::Holes::Fill});
  };
  std::optional<geom::Prepared> found;
  std::string why;
  for (const bool drop_sheets : {false, true}) {
    if (found) break;
    try {
      found = prepared(drop_sheets);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::InvalidInput) throw;
      if (why.empty()) why = error.what();
    }
  }
  if (!found) {
    append(out.inner, exact);
    add_guess(exact, has_border(exact), "a mesh has no solid (" + why + ")", out);
    return;
  }
  const geom::PreparationReport& report = found->report;
  Mesh solid = found->solid.mesh();
  // What the solid is made without is not of its surface, but may still be touched.
  for (const geom::LeftOut& left : report.left_out)
    append_sheet(solid, {{left.corners.begin(), left.corners.end()}, {{0, 1, 2}}});
  if (report.dropped_sheets > 0) append_sheet(solid, exact);
  const bool filled = found->solid.filled_triangles() > 0;
  append(out.inner, filled ? exact : solid);
  out.same = out.same && !filled;
  if (found->solid.closed() && !report.guessed && !report.hollow) {
    append(out.outer, solid);
    return;
  }
  std::string what = "which solid a mesh means is not certain";
  for (const std::string& note : report.notes)
    if (note.starts_with(kWarning)) what += ": " + note.substr(kWarning.size());
  add_guess(solid, !found->solid.closed() || report.guessed, what, out);
}

std::string joined(const std::vector<std::string>& texts) {
  std::string out;
  for (const std::string& text : texts) {
    if (!out.empty()) out += "; ";
    out += text;
  }
  return out;
}

}  // namespace

std::vector<pairs::LinkSurface> surfaces_of(const robot::RobotFile& file,
                                            const robot::ShapeChoice& choice,
                                            std::vector<std::string>& notes) {
  robot::require_meshes(file, choice);
  std::vector<pairs::LinkSurface> out;
  robot::MeshFiles files(file.path, choice.packages);
  for (std::uint32_t l = 0; l < file.robot.links.size(); ++l) {
    const robot::Link& link = file.robot.links[l];
    if (!choice.has(link)) continue;
    Made made;
    for (const Geometry& shape : choice.shapes_of(link)) {
      if (shape.shape == Geometry::Shape::Mesh) {
        const Mesh exact = robot::exact_shapes({shape}, files);
        geom::require_valid(exact);
        add_mesh(exact, made);
      } else {
        add_primitive(shape, made);
      }
    }
    for (const robot::UnreadShape& unread : link.unread)
      if (choice.visual || !unread.visual) made.unsure.push_back(unread.what + " is not looked at");
    if (made.outer.empty() && made.unsure.empty()) continue;
    pairs::LinkSurface surface{l, std::move(made.outer), std::nullopt, joined(made.unsure),
                               joined(made.guess)};
    if (!made.same) surface.inner = std::move(made.inner);
    for (const std::string& why : {surface.unsure, surface.guess})
      if (!why.empty()) notes.push_back("link '" + link.name + "': " + why);
    out.push_back(std::move(surface));
  }
  return out;
}

}  // namespace kaboum::tools
