// Pages of spheres over the robot that they are to hold.
#include "spheres_page.h"

#include <kaboum/geom/convex_hull.h>
#include <kaboum/page/preview.h>

#include <cmath>
#include <filesystem>
#include <sstream>

namespace kaboum::tools {
namespace {

using page::Layer;

constexpr std::size_t kPartsOfLink = 12'000;
constexpr double kPart = 0.01;  ///< of a link's diagonal: parts that are not cut further

/// A polytope with its corners on the unit sphere.
geom::Mesh unit_sphere() {
  robot::Geometry ball;
  ball.shape = robot::Geometry::Shape::Sphere;
  ball.size = geom::Vec3::Ones();
  geom::Mesh out = *geom::convex_hull(robot::bounding_points(ball));
  for (geom::Vec3& v : out.vertices) v.normalize();
  return out;
}

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

std::string three_digits(double x) {
  std::ostringstream out;
  out.precision(3);
  out << x;
  return out.str();
}

std::vector<std::string> row_of(const verify::LinkSpheresVerdict& link) {
  std::string share, depth, place;
  if (link.spheres == 0 || link.inclusion.surface.answer == verify::Answer::Refuted)
    share = three_digits(100 * link.outside.share_lower) + " to " +
            three_digits(100 * link.outside.share_upper);
  if (link.missed) {
    const geom::Vec3& p = link.missed->point;
    if (std::isfinite(link.missed->depth)) depth = three_digits(link.missed->depth);
    place = three_digits(p.x()) + ", " + three_digits(p.y()) + ", " + three_digits(p.z());
  }
  const char* verdict = link.spheres == 0 ? "uncovered" : verify::name_of(link.answer);
  return {link.link, std::to_string(link.spheres), verdict, share, depth, place};
}

}  // namespace

std::string page_of_spheres(const robot::RobotFile& robot, const std::string& file,
                            const verify::SpheresVerdict& verdict) {
  const geom::Mesh unit = unit_sphere();
  page::Preview preview{"Spheres of " + file_name(file), "m"};
  Layer held{"shapes, held", Layer::View::Shown, false};
  Layer outside{"shapes, outside", Layer::View::Shown, false};
  Layer spheres{"spheres", Layer::View::Transparent};
  held.no_edges = outside.no_edges = spheres.no_edges = true;
  outside.colour = {0.85, 0.1, 0.1};
  for (const verify::LinkSpheresVerdict& link : verdict.links) {
    if (!link.mesh.triangles.empty()) {
      const double size = geom::bounding_box(link.mesh).diagonal();
      verify::SplitMesh parts =
          verify::split_by_balls(link.mesh, link.balls, kPart * size, kPartsOfLink);
      if (!parts.held.triangles.empty())
        held.shapes.push_back({std::move(parts.held), {}, link.index});
      if (!parts.outside.triangles.empty())
        outside.shapes.push_back({std::move(parts.outside), {}, link.index});
    }
    for (const geom::ConvexBody& ball : link.balls.bodies) {
      geom::Mesh drawn = unit;
      for (geom::Vec3& v : drawn.vertices) v = ball.core.vertices[0] + ball.radius * v;
      spheres.shapes.push_back({std::move(drawn), {}, link.index});
    }
  }
  preview.facts = {{"robot", file_name(robot.path.string()) + ", at zero joint values"},
                   {"spheres", file_name(file)},
                   {"verdict", std::string(verify::name_of(verdict.answer)) + ": " +
                                   verdict.sentence + "; decided exactly"}};
  for (const std::string& note : verdict.notes) preview.facts.emplace_back("note", note);
  preview.table = {{"link", "spheres", "verdict", "outside [%]", "deepest [m]", "at"}, {}};
  for (const verify::LinkSpheresVerdict& link : verdict.links)
    preview.table.rows.push_back(row_of(link));
  for (Layer* layer : {&held, &outside, &spheres})
    if (!layer->shapes.empty()) preview.layers.push_back(std::move(*layer));
  preview.motion.emplace(
      page::Motion{robot.robot, {std::vector<double>(robot.robot.variables.size(), 0.0)}});
  return page::preview_page(preview);
}

}  // namespace kaboum::tools
