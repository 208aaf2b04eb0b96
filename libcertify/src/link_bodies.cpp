// The shapes of a robot's links as certified convex bodies in the links' frames.

#include <kaboum/base/error.h>
#include <kaboum/base/number_text.h>
#include <kaboum/certify/link_bodies.h>
#include <kaboum/certify/set_options.h>
#include <kaboum/geom/convex_hull.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <map>

#include "issuer.h"
#include "link_shapes.h"
#include "request.h"
#include "work_shares.h"

namespace kaboum::certify {

using robot::Geometry;

namespace {

using Regions = std::vector<geom::RequestedRegion>;

SetRequest request_for(const RobotRequest& request, const std::optional<Length>& epsilon,
                       const Regions& regions, const geom::Vec3& scale) {
  SetRequest out = request.set;
  out.regions = regions;
  if (epsilon) out.epsilon = epsilon;
  if (out.epsilon) out.epsilon = in_unit_of_mesh(*out.epsilon, scale);
  if (out.wrap)
    for (std::optional<Length>* length : {&out.wrap->offset, &out.wrap->seal})
      if (*length) *length = in_unit_of_mesh(**length, scale);
  // A little more than rounding takes away. A scale that differs by axis takes of the width what it
  // takes least, and leaves of the length what it leaves most.
  constexpr double kMore = 1 + 1e-12;
  const double stretch = scale.maxCoeff() / scale.minCoeff();
  if (out.thickness) {
    *out.thickness = in_unit_of_mesh(*out.thickness, scale);
    out.thickness->value *= stretch * kMore;
  }
  if (out.max_aspect) *out.max_aspect /= stretch * kMore;
  return out;
}

}  // namespace

CertifiedLinkMesh certify_link_mesh(const robot::LinkMesh& mesh,
                                    const std::optional<Length>& epsilon, const Regions& regions,
                                    const RobotRequest& request, const SetCache* cache,
                                    const RobotHooks& hooks) {
  const SetRequest asked = request_for(request, epsilon, regions, mesh.scale);
  Hooks of_mesh{hooks.progress, {}};
  if (hooks.note)
    of_mesh.note = [&](const std::string& text) { hooks.note(mesh.file.string(), text); };
  return {mesh, asked.wanted_epsilon(),
          certify_file(mesh.file, request.format, asked, cache, of_mesh)};
}

bool is_of_mesh(const Error& error) {
  return error.code() == ErrorCode::InvalidInput || error.code() == ErrorCode::LimitReached;
}

namespace {

/// One body round a wrap, however far it is from the mesh.
SetRequest loosest(SetRequest r) {
  r.epsilon.reset();
  r.regions.clear();
  r.max_total_vertices.reset();
  r.max_bodies = 1;
  r.wrap.emplace();
  return r;
}

/// The hooks, which set `ended` where one of them throws: that is no mesh's flaw.
RobotHooks watched(const RobotHooks& hooks, bool& ended) {
  RobotHooks out = hooks;
  if (hooks.progress)
    out.progress = [&](const std::string& stage) {
      ended = true;
      hooks.progress(stage);
      ended = false;
    };
  if (hooks.note)
    out.note = [&](const std::string& file, const std::string& text) {
      ended = true;
      hooks.note(file, text);
      ended = false;
    };
  if (hooks.made)
    out.made = [&](const CertifiedLinkMesh& mesh) {
      ended = true;
      hooks.made(mesh);
      ended = false;
    };
  return out;
}

/// Spheres, capsules or boxes for a mesh that none were found for: within a few times epsilon.
/// @return whether there are some; then `out` has them, and says so
bool hold_by_larger_ones(const RobotRequest& request, const Regions& regions, const SetCache* cache,
                         const RobotHooks& hooks, const bool& ended, CertifiedLinkMesh& out) {
  const std::optional<Length> wanted = out.epsilon ? out.epsilon : request.set.epsilon;
  if (request.set.body_kind == SetRequest::BodyKind::Polytopes || !wanted) return false;
  for (const double times : {2.0, 4.0, 8.0}) {
    Length larger = *wanted;
    larger.value *= times;
    Regions wider = regions;
    for (geom::RequestedRegion& one : wider) one.epsilon.value *= times;
    try {
      out.made = certify_link_mesh(out.mesh, larger, wider, request, cache, hooks).made;
    } catch (const Error& error) {
      if (ended || !is_of_mesh(error)) throw;
      continue;
    }
    out.held = true;
    out.flaw += std::string(". It has ") + plural_of(request.set.body_kind) + " within " +
                larger.text() + " instead";
    return true;
  }
  return false;
}

/// As certify_link_mesh, but for what may be wrong with the mesh: RobotRequest::partial.
CertifiedLinkMesh certify_somehow(const robot::LinkMesh& mesh, const std::optional<Length>& epsilon,
                                  const Regions& regions, const RobotRequest& request,
                                  const SetCache* cache, const RobotHooks& given,
                                  std::exception_ptr& first) {
  if (!mesh.missing.empty()) {
    if (!first) first = std::make_exception_ptr(Error(ErrorCode::InvalidInput, mesh.missing));
    return {mesh, epsilon, {}, mesh.missing, false};
  }
  bool ended = false;
  const RobotHooks hooks = watched(given, ended);
  std::string flaw;
  try {
    return certify_link_mesh(mesh, epsilon, regions, request, cache, hooks);
  } catch (const Error& error) {
    if (ended || !request.partial || !is_of_mesh(error)) throw;
    flaw = error.what();
    if (!first) first = std::current_exception();
  }
  CertifiedLinkMesh out{mesh, epsilon, {}, flaw, false};
  if (hold_by_larger_ones(request, regions, cache, hooks, ended, out)) return out;
  if (!request.set.wrap) return out;
  RobotRequest loose = request;
  loose.set = loosest(loose.set);
  try {
    out.made = certify_link_mesh(mesh, {}, {}, loose, cache, hooks).made;
    out.held = true;
  } catch (const Error& error) {
    if (ended || !is_of_mesh(error)) throw;
  }
  return out;
}

}  // namespace

bool is_placed_exactly(const Geometry& g) {
  int exponent = 0;
  return g.origin.linear.isIdentity(0) && g.origin.translation.isZero(0) &&
         std::all_of(g.size.begin(), g.size.end(),
                     [&](double s) { return std::abs(std::frexp(s, &exponent)) == 0.5; });
}

double placing_error(const Geometry& g, double size) {
  return 0x1p-46 * (size + g.origin.translation.norm());
}

namespace {

/// Whether a shape is a body of the kind itself.
bool is_of_kind(const Geometry& g, SetRequest::BodyKind kind) {
  using Kind = SetRequest::BodyKind;
  if (kind == Kind::Polytopes) return true;  // a polytope round it stands for it
  if (g.shape == Geometry::Shape::Sphere) return kind != Kind::Boxes;
  return g.shape == Geometry::Shape::Box && (kind == Kind::Boxes || kind == Kind::Mixed);
}

/// Bodies of the kind for a box, a cylinder or a sphere that is none, in the frame of its link. Its
/// polytope's corners are placed within placing_error. What the polytope is farther than the shape
/// is taken off epsilon, and off those of regions that its bodies can reach.
CertifiedSet bodies_for(const Geometry& g, const robot::RobotFile& robot, const std::string& link,
                        const RobotRequest& request) {
  SetRequest asked = request.set;
  if (const auto own = request.epsilons.find(link); own != request.epsilons.end())
    asked.epsilon = own->second;
  const std::vector<geom::Vec3> points = robot::bounding_points(g);
  if (asked.epsilon) {
    geom::Vec3 low = points.front(), high = low;
    for (const geom::Vec3& p : points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const double beyond = robot::bounding_excess(g) + placing_error(g, 2 * g.size.norm());
    const auto rest_of = [&](const Length& epsilon, const std::string& where) {
      const double rest = epsilon.of((high - low).norm()) - beyond;
      if (!(rest > 0))
        throw TooCoarse(robot.path.string() + ": link '" + link + "': its " + robot::describe(g) +
                        " is covered by way of a polytope that is up to " + number_text(beyond) +
                        " farther: allow an epsilon above that" + where);
      return Length{rest, false};
    };
    asked.epsilon = rest_of(*asked.epsilon, "");
    if (const auto own = request.regions.find(link); own != request.regions.end())
      for (const robot::LinkRegion& one : own->second) {
        geom::RequestedRegion region = *robot::region_in_link(one, robot::Side::Round);
        const double apart = geom::distance_from(region.region, points);
        if (apart > 2 * (asked.epsilon->value + beyond)) continue;
        region.epsilon = rest_of(region.epsilon, " in the region " + region.name);
        asked.regions.push_back(std::move(region));
      }
  }
  std::optional<CertifiedSet> set = certify_set(*geom::convex_hull(points), robot.sha256, asked);
  if (!set)
    throw TooCoarse(robot.path.string() + ": link '" + link +
                    "': float32 cannot hold bodies as near to its " + robot::describe(g));
  return *std::move(set);
}

/// Appends the bodies of one shape in the frame of its link, points within the bodies' radii:
/// those of `set` for a mesh, else a bounding polytope; none for a point.
/// @param set  of the mesh in its own frame and unit; unused for other shapes.
/// @param kind  of all but polytopes, a sphere stands for itself
void place_shape(const Geometry& g, const geom::ConvexSet* set, SetRequest::BodyKind kind,
                 const std::string& link, std::uint32_t index,
                 std::vector<robot::LinkBody>& bodies) {
  const auto name = [&] {
    const auto same = [&](const robot::LinkBody& b) { return b.link == index; };
    return link + "/" + std::to_string(std::count_if(bodies.begin(), bodies.end(), same));
  };
  if (robot::is_point(g)) return;
  if (g.shape == Geometry::Shape::Sphere && kind != SetRequest::BodyKind::Polytopes) {
    const double radius = g.size.x();
    bodies.push_back(
        {name(), index, {g.origin.translation}, radius + placing_error(g, 2 * radius)});
    return;
  }
  if (g.shape != Geometry::Shape::Mesh) {
    bodies.push_back(
        {name(), index, robot::bounding_points(g), placing_error(g, 2 * g.size.norm())});
    return;
  }
  const bool exact = is_placed_exactly(g);
  for (const geom::ConvexBody& body : set->bodies) {
    robot::LinkBody b{name(), index, {}, g.size.cwiseAbs().maxCoeff() * body.radius};
    double size = 0;
    for (const geom::Vec3& p : body.core.vertices) {
      const geom::Vec3 scaled = p.cwiseProduct(g.size);
      size = std::max(size, scaled.norm());
      b.points.emplace_back(exact ? scaled : g.origin * scaled);
    }
    if (!exact) b.margin += placing_error(g, size);
    bodies.push_back(std::move(b));
  }
}

}  // namespace

RobotHooks hooks_of(Notes& notes, std::function<void(const std::string&)> progress) {
  RobotHooks hooks;
  hooks.progress = std::move(progress);
  hooks.note = [&notes](const std::string& file, const std::string& text) {
    notes.add(file, text);
  };
  return hooks;
}

void RobotRequest::take(robot::LinkBounds bounds) {
  if (!epsilons.empty() && !bounds.epsilons.empty())
    throw Error(ErrorCode::InvalidArgument,
                "«epsilon-map» names whole links, and so does «epsilons»: state the epsilons of "
                "links in one of them");
  epsilons.merge(bounds.epsilons);
  regions = std::move(bounds.regions);
}

std::string RobotRequest::parameters() const {
  RobotSetOptions options{options_of(set), shapes.visual};
  options.set.request.epsilon = set.wanted_epsilon();
  std::string out = record_of(robot_set_options(), options);
  for (const auto& [link, epsilon] : epsilons) out += " " + link + ": " + epsilon.text();
  std::vector<geom::RequestedRegion> all;
  for (const auto& [link, own] : regions)
    for (const robot::LinkRegion& one : own) {
      all.push_back(one);
      all.back().name.insert(0, link + ": ");
    }
  return out + record_of(all);
}

std::string RobotRequest::parameters(const std::string& link) const {
  RobotRequest own{set, shapes, format, tool, {}, {}};
  if (const auto found = epsilons.find(link); found != epsilons.end())
    own.set.epsilon = found->second;
  if (const auto found = regions.find(link); found != regions.end()) own.regions.insert(*found);
  return own.parameters();
}

namespace {

/// What a body with a radius reaches farther than its image under a scale that differs by axis: the
/// image of its ball is an ellipsoid, and a ball round that is written. [length]
double rounded_beyond(const geom::Vec3& scale, const geom::ConvexSet& set) {
  double radius = 0;
  for (const geom::ConvexBody& body : set.bodies) radius = std::max(radius, body.radius);
  const geom::Vec3 sizes = scale.cwiseAbs();
  return (1 + 0x1p-40) * (sizes.maxCoeff() - sizes.minCoeff()) * radius;
}

/// Why a mesh's bodies are farther than asked once they are scaled; empty: they are not.
std::string flaw_of_scale(const CertifiedLinkMesh& mesh) {
  if (!mesh.held) return {};
  const SetCertificate& c = mesh.made.found.set.certificate();
  const double most = mesh.mesh.scale.cwiseAbs().maxCoeff(),
               beyond = rounded_beyond(mesh.mesh.scale, mesh.made.found.set.artefact());
  if (!(beyond > 0) || (!mesh.epsilon && c.regions.empty())) return {};
  const double reached = most * c.distance_upper + beyond;
  if (c.regions.empty() && reached <= most * mesh.epsilon->of(c.diagonal)) return {};
  return mesh.mesh.file.string() + ": its scale differs by axis, so round bodies are up to " +
         number_text(beyond) +
         " farther than within epsilon: allow a larger one, or take polytopes";
}

}  // namespace

double distance_of(const robot::RobotFile& robot, const BodiesCertificate& bodies,
                   const robot::LinkShape& shape) {
  const Geometry& g = bodies.choice.shapes_of(robot.robot.links[shape.link])[shape.index];
  if (!shape.mesh) return robot::bounding_excess(g);
  if (!bodies.meshes[*shape.mesh].held) return 0;  // the shape stays
  const geom::ConvexSet& set = bodies.meshes[*shape.mesh].made.found.set.artefact();
  return g.size.cwiseAbs().maxCoeff() * set.provenance.epsilon.value_or(0) +
         rounded_beyond(g.size, set);
}

double mean_distance(const CertifiedBodies& bodies) {
  const BodiesCertificate& made = bodies.certificate();
  std::map<std::uint32_t, double> of_link;
  for (const robot::LinkBody& body : bodies.artefact()) of_link[body.link] = 0;
  for (std::size_t i = 0; i < made.shapes.size(); ++i)
    if (const auto link = of_link.find(made.shapes[i].link); link != of_link.end())
      link->second = std::max(link->second, made.distances[i]);
  double sum = 0;
  for (const auto& [link, distance] : of_link) sum += distance;
  return of_link.empty() ? 0 : sum / static_cast<double>(of_link.size());
}

CertifiedBodies certify_bodies(const robot::RobotFile& robot, const RobotRequest& request,
                               const SetCache* cache, const RobotHooks& hooks) {
  if (request.set.direction != SetRequest::Direction::Outer)
    throw Error(ErrorCode::InvalidArgument, "a robot's links are held by outer sets only");
  if (!request.set.regions.empty())
    throw Error(ErrorCode::InvalidArgument, "regions of a robot are those of its links");
  WantedMeshes found = wanted_meshes(robot, request.shapes, request.epsilons, request.regions);
  BodiesCertificate out;
  std::vector<robot::LinkBody> bodies;
  out.choice = request.shapes;
  std::exception_ptr first;  // of meshes that are not held as asked for
  const std::vector<std::optional<double>> work = work_of_meshes(found, request.set);
  for (std::size_t i = 0; i < found.meshes.size(); ++i) {
    RobotRequest own = request;
    own.set.improve_work = work[i];
    out.meshes.push_back(certify_somehow(found.meshes[i], found.epsilons[i], found.regions[i], own,
                                         cache, hooks, first));
    if (out.meshes.back().flaw.empty()) out.meshes.back().flaw = flaw_of_scale(out.meshes.back());
    const CertifiedFile& made = out.meshes.back().made;
    if (found.meshes[i].missing.empty()) out.files.push_back(found.meshes[i].file);
    out.files.insert(out.files.end(), made.other_files.begin(), made.other_files.end());
    if (hooks.made) hooks.made(out.meshes.back());
  }
  out.files.insert(out.files.end(), found.files.begin(), found.files.end());
  out.shapes = std::move(found.shapes);
  for (const robot::LinkShape& shape : out.shapes) {
    const robot::Link& link = robot.robot.links[shape.link];
    out.distances.push_back(0);
    if (shape.mesh && !out.meshes[*shape.mesh].held) continue;
    const Geometry& g = request.shapes.shapes_of(link)[shape.index];
    if (g.shape != Geometry::Shape::Mesh && !is_of_kind(g, request.set.body_kind) &&
        !robot::is_point(g)) {
      const CertifiedSet set = bodies_for(g, robot, link.name, request);
      const double error = placing_error(g, 2 * g.size.norm());
      for (const geom::ConvexBody& body : set.artefact().bodies)
        bodies.push_back({link.name + "/" + std::to_string(bodies.size()), shape.link,
                          body.core.vertices, body.radius + error});
      out.distances.back() =
          distance_of(robot, out, shape) + error + set.artefact().provenance.epsilon.value_or(0);
      continue;
    }
    place_shape(g, shape.mesh ? &out.meshes[*shape.mesh].made.found.set.artefact() : nullptr,
                request.set.body_kind, link.name, shape.link, bodies);
    out.distances.back() = distance_of(robot, out, shape);
  }
  for (const double distance : out.distances) out.distance = std::max(out.distance, distance);
  if (bodies.empty() && first) std::rethrow_exception(first);
  if (bodies.empty())
    throw Error(ErrorCode::InvalidInput,
                robot.path.string() + ": no link has a shape" +
                    (request.shapes.visual ? std::string() : "; try «geometry=visual»"));
  return Issuer::issue(std::move(bodies), std::move(out), {});
}

}  // namespace kaboum::certify
