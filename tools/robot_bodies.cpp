#include "robot_bodies.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "certified_file.h"
#include "cli.h"
#include "find_mesh.h"
#include "notes.h"

namespace kaboum::tools {
namespace {

namespace fs = std::filesystem;
using robot::Geometry;

/// The certified bodies of a mesh. Appends the files read to `files`.
geom::ConvexSet decompose(const fs::path& mesh, const BodyOptions& options, kaboum::Length epsilon,
                          Notes& notes, std::vector<std::string>& files) {
  const std::string file = mesh.string();
  const auto note = [&](const std::string& text) { notes.add(file, text); };
  certify::SetRequest request;
  request.epsilon = epsilon;
  request.max_vertices = options.max_vertices;
  request.effort = options.effort;
  request.preparation.drop_sheets = options.drop_sheets;
  auto made = certify_file(file, "", request, options.cache, {options.progress, note});
  if (!made) throw Error(ErrorCode::InvalidInput, too_coarse(file));
  files.push_back(file);
  files.insert(files.end(), made->other_files.begin(), made->other_files.end());
  if (!made->found.set.certificate.reached())
    note("the decomposition does not reach " + epsilon.text());
  return std::move(made->found.set.set);
}

}  // namespace

kaboum::Length epsilon_of_mesh(kaboum::Length epsilon, double scale) {
  if (!epsilon.percent) epsilon.value /= scale;
  return epsilon;
}

void place_shape(const Geometry& g, const geom::ConvexSet* set, const std::string& link,
                 std::uint32_t index, std::vector<robot::LinkBody>& bodies) {
  const auto name = [&] {
    const auto same = [&](const robot::LinkBody& b) { return b.link == index; };
    return link + "/" + std::to_string(std::count_if(bodies.begin(), bodies.end(), same));
  };
  // The points' own rounding where shape and link lie far from one another's origin.
  const auto rounding = [&](double size) { return 0x1p-46 * (size + g.origin.translation.norm()); };
  if (robot::is_point(g)) return;
  if (g.shape != Geometry::Shape::Mesh) {
    bodies.push_back({name(), index, robot::bounding_points(g), rounding(2 * g.size.norm())});
    return;
  }
  int exponent = 0;
  const bool exact = g.origin.linear.isIdentity(0) && g.origin.translation.isZero(0) &&
                     std::all_of(g.size.begin(), g.size.end(), [&](double s) {
                       return std::abs(std::frexp(s, &exponent)) == 0.5;
                     });
  for (const geom::ConvexBody& body : set->bodies) {
    robot::LinkBody b{name(), index, {}, g.size.cwiseAbs().maxCoeff() * set->margin};
    double size = 0;
    for (const geom::Vec3& p : body.hull.vertices) {
      const geom::Vec3 scaled = p.cwiseProduct(g.size);
      size = std::max(size, scaled.norm());
      b.points.emplace_back(exact ? scaled : g.origin * scaled);
    }
    if (!exact) b.margin += rounding(size);
    bodies.push_back(std::move(b));
  }
}

LinkBodies bodies_of(const RobotFile& robot, const BodyOptions& options) {
  require_links(robot, options.links);
  Notes notes;
  LinkBodies out;
  out.bare = bare_links(robot.robot, options.visual, options.links);
  out.notes = notes_on_flat_shapes(robot, options.visual, options.links);
  std::map<std::pair<std::string, double>, geom::ConvexSet> decomposed;  // by file and scale
  for (std::uint32_t l = 0; l < robot.robot.links.size(); ++l) {
    const robot::Link& link = robot.robot.links[l];
    if (!options.links.empty() &&
        std::find(options.links.begin(), options.links.end(), link.name) == options.links.end())
      continue;
    const std::vector<Geometry>& shapes = options.visual ? link.visual : link.collision;
    for (const Geometry& g : shapes) {
      if (g.shape != Geometry::Shape::Mesh) {
        place_shape(g, nullptr, link.name, l, out.bodies);
        out.epsilon = std::max(out.epsilon, robot::bounding_excess(g));
        continue;
      }
      const fs::path mesh = resolve_mesh(g.mesh, robot.path, options.packages);
      const double scale = g.size.cwiseAbs().maxCoeff();
      const kaboum::Length epsilon = epsilon_of_mesh(options.epsilon, scale);
      const std::pair key{mesh.string(), epsilon.value};
      auto it = decomposed.find(key);
      if (it == decomposed.end()) {
        it = decomposed.emplace(key, decompose(mesh, options, epsilon, notes, out.files)).first;
      }
      out.epsilon = std::max(out.epsilon, scale * std::max(it->second.provenance.epsilon, 0.0));
      place_shape(g, &it->second, link.name, l, out.bodies);
    }
  }
  for (std::string& line : notes.lines()) out.notes.push_back(std::move(line));
  if (out.bodies.empty())
    throw Error(ErrorCode::InvalidInput,
                robot.path.string() + ": no link has a shape" +
                    (options.visual ? std::string() : "; try --geometry visual"));
  return out;
}

}  // namespace kaboum::tools
