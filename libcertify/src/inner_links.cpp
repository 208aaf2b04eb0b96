// Inner sets of links: bodies within the shapes, placed in the link, shrunk by what scale and pose
// are rounded by, serialised, read back, decided.

#include <kaboum/base/error.h>
#include <kaboum/certify/inner_links.h>
#include <kaboum/io/convex_io.h>

#include <algorithm>
#include <array>
#include <map>

#include "issuer.h"
#include "link_polytopes.h"
#include "link_shapes.h"

namespace kaboum::certify {
namespace {

using robot::Geometry;

/// Allowances for rounding, tried one after the other.
constexpr std::array<double, 3> kInnerAllowance{1, 16, 256};

/// The polytope round this much smaller a cylinder, or sphere, capsule or ellipsoid, lies in the
/// shape: it reaches 0.5 % or 2 % of the radius beyond what it is round (robot::bounding_excess).
constexpr double kInnerCylinder = 1 / (1.005 * (1 + 1e-9)), kInnerSphere = 1 / (1.02 * (1 + 1e-9));

/// Points whose hull lies in a shape that is no mesh; none where it has no volume.
std::vector<geom::Vec3> inscribed_points(Geometry g) {
  if (robot::is_flat(g)) return {};
  if (g.shape == Geometry::Shape::Cylinder) g.size.x() *= kInnerCylinder;
  if (g.shape == Geometry::Shape::Sphere || g.shape == Geometry::Shape::Capsule)
    g.size.x() *= kInnerSphere;
  if (g.shape == Geometry::Shape::Ellipsoid) g.size *= kInnerSphere;
  return robot::bounding_points(g);
}

/// The meshes of a request, each with its inner set, or why it has none.
class InnerMeshes {
 public:
  InnerMeshes(const WantedMeshes& found, const RobotRequest& request, const SetCache* cache,
              const RobotHooks& hooks)
      : why_(found.meshes.size()) {
    for (std::size_t i = 0; i < found.meshes.size(); ++i) try {
        made.push_back(
            certify_link_mesh(found.meshes[i], found.epsilons[i], {}, request, cache, hooks));
        if (hooks.made) hooks.made(made.back());
        index_[i] = made.size() - 1;
      } catch (const Error& error) {
        if (error.code() != ErrorCode::InvalidInput && error.code() != ErrorCode::LimitReached)
          throw;
        why_[i] = error.what();
      }
  }

  /// Why a shape has no inner set; empty where it has one, or is none of a mesh.
  [[nodiscard]] std::string why_not(const robot::LinkShape& shape) const {
    return shape.mesh ? why_[*shape.mesh] : std::string();
  }
  /// @pre the shape is of a mesh that has one.
  [[nodiscard]] std::size_t index(const robot::LinkShape& shape) const {
    return index_.at(*shape.mesh);
  }

  std::vector<CertifiedLinkMesh> made;

 private:
  std::vector<std::string> why_;
  std::map<std::size_t, std::size_t> index_;
};

/// What a link's set is made of.
struct InnerParts {
  std::vector<robot::LinkBody> bodies;  ///< margin: how far a point may be from where it should be
  std::size_t shapes = 0;               ///< that have bodies
  double shape_depth = 0;     ///< the largest of a shape, before anything is rounded [length]
  double half_diagonals = 0;  ///< of all shapes: nothing is deeper in their union [length]
};

void add_inner_body(InnerParts& parts, const robot::Link& link, std::uint32_t index,
                    std::vector<geom::Vec3> points, double error) {
  parts.bodies.push_back(
      {link.name + "/" + std::to_string(parts.bodies.size()), index, std::move(points), error});
}

void add_inner_shape(InnerParts& parts, const robot::Link& link, std::uint32_t index,
                     const Geometry& g, const CertifiedLinkMesh* mesh) {
  if (mesh == nullptr) {
    parts.half_diagonals +=
        (g.shape == Geometry::Shape::Box ? 0.5 : 2) * g.size.norm() * (1 + 1e-9);
    std::vector<geom::Vec3> points = inscribed_points(g);
    if (points.empty()) return;
    ++parts.shapes;
    // Of a box nothing is left out.
    if (g.shape != Geometry::Shape::Box)
      parts.shape_depth = std::max(parts.shape_depth, 0.02 * g.size.maxCoeff());
    add_inner_body(parts, link, index, std::move(points), placing_error(g, 2 * g.size.norm()));
    return;
  }
  const CertifiedSet& made = mesh->made.found.set;
  const double scale = g.size.cwiseAbs().maxCoeff();
  parts.half_diagonals += 0.5 * scale * made.certificate().diagonal * (1 + 1e-9);
  parts.shape_depth =
      std::max(parts.shape_depth, scale * made.artefact().provenance.epsilon.value());
  if (made.artefact().bodies.empty()) return;
  ++parts.shapes;
  const bool exact = is_placed_exactly(g);
  for (const geom::ConvexBody& body : made.artefact().bodies) {
    std::vector<geom::Vec3> points;
    double size = 0;
    for (const geom::Vec3& p : body.core.vertices) {
      const geom::Vec3 at = p.cwiseProduct(g.size);
      size = std::max(size, at.norm());
      points.emplace_back(exact ? at : g.origin * at);
    }
    add_inner_body(parts, link, index, std::move(points), exact ? 0 : placing_error(g, size));
  }
}

geom::Provenance inner_claims_of(const robot::RobotFile& robot, const RobotRequest& request,
                                 std::uint32_t link) {
  geom::Provenance p;
  p.source = robot.path.filename().string();
  p.source_sha256 = robot.sha256;
  p.tool = request.tool;
  p.parameters = request.parameters();
  p.unit = request.set.unit;
  p.frame = robot.robot.links[link].name;
  p.direction = "inner";
  return p;
}

/// @return nullopt where a body is too thin for float32.
std::optional<CertifiedInnerLink> certify_inner_link(const InnerParts& parts,
                                                     std::size_t all_shapes,
                                                     InnerLinkCertificate certificate,
                                                     const geom::Provenance& claims) {
  std::string wrong;
  for (const double allowance : kInnerAllowance) {
    std::optional<InnerPolytopes> made = inner_polytopes(parts.bodies, allowance);
    if (!made) return std::nullopt;
    // Between bodies that were shrunk, and between shapes, there are gaps, however deep.
    certificate.depth = made->is_exact && all_shapes == 1
                            ? std::min(parts.shape_depth, parts.half_diagonals)
                            : parts.half_diagonals;
    made->set.provenance = claims;
    made->set.provenance.epsilon = certificate.depth;
    std::vector<char> container = io::serialise_convex_set(made->set, io::SetFormat::Glb);
    // What is written is what is decided.
    geom::ConvexSet set = io::parse_convex_set(container, io::Format::Glb, "the result");
    wrong = inner_objection(set, parts.bodies);
    if (wrong.empty()) return Issuer::issue(std::move(set), certificate, std::move(container));
  }
  throw Error(ErrorCode::Internal, "link '" + claims.frame +
                                       "': no inner polytopes were found that pass the exact "
                                       "check (" +
                                       wrong + "); nothing is written");
}

}  // namespace

InnerLinks certify_inner_links(const robot::RobotFile& robot, const RobotRequest& asked,
                               const SetCache* cache, const RobotHooks& hooks) {
  if (asked.set.body_kind != SetRequest::BodyKind::Polytopes)
    throw Error(ErrorCode::InvalidArgument, "bodies inside the links of a robot are polytopes");
  RobotRequest request = asked;
  request.set.direction = SetRequest::Direction::Inner;
  request.set.wrap.reset();  // what lies in a wrap need not lie in the shapes
  const WantedMeshes found = wanted_meshes(robot, request.shapes, request.epsilons);
  InnerMeshes meshes(found, request, cache, hooks);
  InnerLinks out;
  for (std::size_t s = 0; s < found.shapes.size();) {
    const std::uint32_t number = found.shapes[s].link;
    const robot::Link& link = robot.robot.links[number];
    InnerParts parts;
    std::string why;
    std::vector<robot::LinkShape> shapes;
    for (; s < found.shapes.size() && found.shapes[s].link == number; ++s) {
      robot::LinkShape shape = found.shapes[s];
      if (why.empty()) why = meshes.why_not(shape);
      if (!why.empty()) continue;
      if (shape.mesh) shape.mesh = meshes.index(shape);
      add_inner_shape(parts, link, number, request.shapes.shapes_of(link)[shape.index],
                      shape.mesh ? &meshes.made[*shape.mesh] : nullptr);
      shapes.push_back(shape);
    }
    if (why.empty() && parts.bodies.empty()) why = "no body lies within its shapes at this epsilon";
    if (why.empty()) {
      auto made = certify_inner_link(parts, shapes.size(), {number, parts.shapes, 0},
                                     inner_claims_of(robot, request, number));
      if (made) {
        out.links.push_back(*std::move(made));
        out.shapes.insert(out.shapes.end(), shapes.begin(), shapes.end());
        continue;
      }
      why = "a body is too thin for float32";
    }
    out.without.emplace_back(number, std::move(why));
  }
  out.meshes = std::move(meshes.made);
  return out;
}

}  // namespace kaboum::certify
