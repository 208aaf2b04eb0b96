// Masses of a robot's links, from their shapes.

#include <kaboum/base/error.h>
#include <kaboum/certify/inertia.h>
#include <kaboum/robot/dynamics.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kaboum::certify {
namespace {

using geom::Moments;
using robot::Geometry;

/// Moments of a file's solid in its own frame and unit, and its box.
struct MeshMoments {
  Moments moments;
  geom::Box3 box;
  std::string flaw;  ///< not empty: nothing is known
  bool hollow = false;
};

MeshMoments read_moments(const robot::LinkMesh& mesh, const InertiaRequest& request) {
  MeshMoments out;
  out.flaw = mesh.missing;
  if (!out.flaw.empty()) return out;
  try {
    const io::ReadResult read = io::read_mesh(mesh.file, request.format);
    if (read.deviation > 0) {
      out.flaw = "its triangles stand for exact faces";
    } else {
      const geom::Prepared prepared = geom::prepare(read.mesh, request.preparation.preparing());
      out.box = geom::bounding_box(prepared.solid.mesh());
      out.moments = geom::moments_of(prepared.solid);
      out.hollow = prepared.report.hollow.has_value();
    }
  } catch (const Error& error) {
    if (error.code() != ErrorCode::InvalidInput && error.code() != ErrorCode::LimitReached) throw;
    out.flaw = error.what();
  }
  if (!out.flaw.empty()) out.flaw.insert(0, mesh.file.string() + ": ");
  return out;
}

/// A shape in its own frame, not yet placed.
Moments moments_of(const Geometry& g, const MeshMoments* mesh) {
  using Shape = Geometry::Shape;
  switch (g.shape) {
    case Shape::Mesh:
      return mesh->moments.scaled(g.size);
    case Shape::Box:
      return Moments::of_box(g.size);
    case Shape::Sphere:
      return Moments::of_ellipsoid(geom::Vec3::Constant(g.size.x()));
    case Shape::Ellipsoid:
      return Moments::of_ellipsoid(g.size);
    case Shape::Cylinder:
      return Moments::of_cylinder(g.size.x(), g.size.y());
    case Shape::Capsule:
      return Moments::of_capsule(g.size.x(), g.size.y());
  }
  return {};
}

/// A box of the shape in the link's frame, enlarged by what rounding may take.
geom::Box3 box_of(const Geometry& g, const MeshMoments* mesh) {
  geom::Box3 out;
  if (g.shape == Geometry::Shape::Mesh) {
    for (int corner = 0; corner < 8; ++corner) {
      geom::Vec3 p;
      for (int i = 0; i < 3; ++i)
        p[i] = ((corner >> i) & 1) != 0 ? mesh->box.max[i] : mesh->box.min[i];
      out.extend(g.origin * p.cwiseProduct(g.size));
    }
  } else {
    for (const geom::Vec3& p : robot::bounding_points(g)) out.extend(p);
  }
  const double slack =
      0x1p-40 * std::max(out.min.cwiseAbs().maxCoeff(), out.max.cwiseAbs().maxCoeff());
  return {out.min.array() - slack, out.max.array() + slack};
}

/// All shapes of a link.
class LinkSum {
 public:
  void add(const Geometry& g, const MeshMoments* mesh) {
    const geom::Box3 box = box_of(g, mesh);
    sum_ += moments_of(g, mesh).moved(g.origin);
    for (const geom::Box3& other : boxes_)
      sum_.note_overlap({box.min.cwiseMax(other.min), box.max.cwiseMin(other.max)});
    boxes_.push_back(box);
  }
  [[nodiscard]] const Moments& moments() const { return sum_; }

 private:
  Moments sum_;
  std::vector<geom::Box3> boxes_;
};

void finish(const LinkSum& sum, const InertiaRequest& request, double mass, LinkInertia& link) {
  if (!sum.moments().has_volume()) {
    link.flaw = sum.moments().overlaps() ? "its shapes may have all points in common"
                                         : "its shapes have no volume";
    return;
  }
  link.overlaps = sum.moments().overlaps();
  link.found = request.density ? sum.moments().with_density(*request.density)
                               : sum.moments().with_mass(mass);
  if (link.found->is_of_body) return;
  link.found.reset();
  link.flaw = "too much of its surfaces crosses itself for its mass to be known";
}

}  // namespace

std::vector<LinkInertia> inertia_of_links(const robot::RobotFile& robot,
                                          const InertiaRequest& request) {
  if (request.density && !(*request.density > 0 && std::isfinite(*request.density)))
    throw Error(ErrorCode::InvalidArgument, "a density is a number above 0");
  const robot::LinkMeshes meshes = robot::link_meshes(robot, request.shapes);
  std::vector<std::optional<MeshMoments>> read(meshes.meshes.size());
  const robot::Dynamics dynamics = robot::dynamics_of(robot);
  std::vector<LinkInertia> out;
  for (std::size_t s = 0; s < meshes.shapes.size();) {
    const std::uint32_t index = meshes.shapes[s].link;
    const robot::Link& link = robot.robot.links[index];
    LinkInertia& made = out.emplace_back();
    made.link = index;
    const auto stated = dynamics.links.find(link.name);
    const double mass = stated == dynamics.links.end() ? 0 : stated->second.mass;
    made.without_mass = !request.density && !(mass > 0);
    LinkSum sum;
    for (; s < meshes.shapes.size() && meshes.shapes[s].link == index; ++s) {
      const robot::LinkShape& shape = meshes.shapes[s];
      const Geometry& g = request.shapes.shapes_of(link)[shape.index];
      if (made.without_mass || !made.flaw.empty() || robot::is_flat(g)) continue;
      const MeshMoments* mesh = nullptr;
      if (shape.mesh) {
        if (!read[*shape.mesh])
          read[*shape.mesh] = read_moments(meshes.meshes[*shape.mesh], request);
        mesh = &*read[*shape.mesh];
        made.flaw = mesh->flaw;
        made.hollow = made.hollow || mesh->hollow;
      }
      if (made.flaw.empty()) sum.add(g, mesh);
    }
    if (made.flaw.empty() && !made.without_mass) finish(sum, request, mass, made);
  }
  return out;
}

std::map<std::string, robot::Inertial> inertials_of(const robot::Robot& robot,
                                                    const std::vector<LinkInertia>& links) {
  std::map<std::string, robot::Inertial> out;
  for (const LinkInertia& link : links) {
    if (!link.found) continue;
    const geom::MassOf<double>& value = link.found->value;
    robot::Inertial inertial;
    inertial.mass = value.mass;
    inertial.origin.translation = {value.centre[0], value.centre[1], value.centre[2]};
    const auto& [xx, yy, zz, xy, xz, yz] = value.inertia;
    inertial.inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    out.emplace(robot.links[link.link].name, inertial);
  }
  return out;
}

}  // namespace kaboum::certify
