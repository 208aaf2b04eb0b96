// Meshes of trimesh: kaboum.from_trimesh and kaboum.to_trimesh.

#include <kaboum/geom/transform.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "arguments.h"
#include "convex_set.h"
#include "mesh.h"

namespace kaboum::python {
namespace {

/// Units as trimesh names them, and as files and options here do.
constexpr std::array<std::pair<const char*, const char*>, 8> kUnits{{{"meters", "m"},
                                                                     {"meter", "m"},
                                                                     {"m", "m"},
                                                                     {"millimeters", "mm"},
                                                                     {"millimeter", "mm"},
                                                                     {"mm", "mm"},
                                                                     {"centimeters", "cm"},
                                                                     {"inches", "in"}}};

/// The unit that a mesh or scene of trimesh states, in words of files where it is one of those;
/// empty: none.
std::string unit_of(const py::object& shape) {
  if (!py::hasattr(shape, "units") || shape.attr("units").is_none()) return {};
  std::string stated = py::str(shape.attr("units"));
  for (const auto& [name, unit] : kUnits)
    if (stated == name) return unit;
  return stated;
}

void take_unit(const std::string& stated, MeshValue& mesh) {
  for (const auto& [name, unit] : kUnits)
    if (stated == unit) mesh.unit = unit;
  if (mesh.unit.empty() && !stated.empty())
    mesh.notes.push_back("trimesh states the unit '" + stated +
                         "', which is none of KABouM's: coordinates are taken as they are.");
}

[[noreturn]] void refuse_geometry(const std::string& name, const std::string& why) {
  throw Error(ErrorCode::InvalidInput, "shape: the scene's geometry '" + name + "' " + why);
}

/// Where a scene has a geometry.
geom::Transform placement_of(const py::object& matrix, const std::string& name) {
  const auto m = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(matrix);
  if (!m || m.ndim() != 2 || m.shape(0) != 4 || m.shape(1) != 4) {
    PyErr_Clear();
    refuse_geometry(name, "is placed by something that is no 4 x 4 matrix");
  }
  const auto at = m.unchecked<2>();
  if (at(3, 0) != 0 || at(3, 1) != 0 || at(3, 2) != 0 || at(3, 3) != 1)
    refuse_geometry(name, "is placed by a matrix whose last row is not 0 0 0 1");
  geom::Transform out;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) out.linear(i, k) = at(i, k);
    out.translation[i] = at(i, 3);
  }
  if (!out.linear.allFinite() || !out.translation.allFinite())
    refuse_geometry(name, "is placed by numbers that are not finite");
  if (out.linear.determinant() == 0) refuse_geometry(name, "is flattened where it is placed");
  return out;
}

bool moves(const geom::Transform& t) {
  return t.linear != Eigen::Matrix3d::Identity() || t.translation != geom::Vec3::Zero();
}

/// Adds a scene's geometry where the scene has it.
/// @return whether its coordinates have been moved
bool add_placed(const py::object& geometry, const py::object& matrix, const std::string& name,
                geom::Mesh& mesh) {
  if (!py::hasattr(geometry, "faces"))
    refuse_geometry(name, "is a " +
                              py::str(py::type::of(geometry).attr("__name__")).cast<std::string>() +
                              ", which has no triangles; take it out of the scene");
  const geom::Transform placement = placement_of(matrix, name);
  const MeshValue part = mesh_of(geometry, "shape");
  const bool moved = moves(placement), turned = placement.linear.determinant() < 0;
  const std::size_t first = mesh.vertices.size();
  if (first + part.mesh->vertices.size() >= 0xFFFFFFFE)
    refuse_geometry(name, "makes too many vertices of the scene");
  for (const geom::Vec3& v : part.mesh->vertices)
    mesh.vertices.push_back(moved ? geom::Vec3(placement * v) : v);
  for (geom::Triangle t : part.mesh->triangles) {
    for (std::uint32_t& v : t) v += static_cast<std::uint32_t>(first);
    if (turned) std::swap(t[1], t[2]);
    mesh.triangles.push_back(t);
  }
  return moved;
}

/// @throws Error{InvalidInput} where two geometries are not in one unit: they would be joined as
///   if they were
void require_one_unit(const std::string& first, const std::string& first_unit,
                      const std::string& name, const std::string& unit) {
  if (unit == first_unit) return;
  const auto in_words = [](const std::string& stated) {
    return stated.empty() ? std::string("no unit") : "the unit '" + stated + "'";
  };
  refuse_geometry(name, "states " + in_words(unit) + ", '" + first + "' " + in_words(first_unit) +
                            "; convert them to one, or set scene.units if they are in it");
}

MeshValue mesh_of_scene(const py::object& scene) {
  auto mesh = std::make_shared<geom::Mesh>();
  std::optional<std::pair<std::string, std::string>> first;  // geometry, and its unit
  std::size_t moved = 0;
  for (const py::handle node : scene.attr("graph").attr("nodes_geometry")) {
    const py::tuple placed = scene.attr("graph").attr("get")(node);
    const std::string name = py::str(placed[1]);
    const py::object geometry = scene.attr("geometry")[placed[1]];
    const std::string unit = unit_of(geometry);
    if (!first) first.emplace(name, unit);
    if (add_placed(geometry, placed[0], name, *mesh)) ++moved;
    require_one_unit(first->first, first->second, name, unit);
  }
  if (mesh->triangles.empty())
    throw Error(ErrorCode::InvalidInput, "shape: the scene has no triangles");
  MeshValue out{std::move(mesh)};
  take_unit(first->second, out);
  if (moved > 0)
    out.notes.push_back(
        "coordinates were moved to where the scene has them, and rounded: what is "
        "claimed is of the rounded ones.");
  return out;
}

MeshValue from_trimesh(const py::object& shape) {
  const bool scene = py::hasattr(shape, "geometry") && py::hasattr(shape, "graph");
  if (!scene && !(py::hasattr(shape, "vertices") && py::hasattr(shape, "faces")))
    throw Error(ErrorCode::InvalidArgument, "shape must be a trimesh.Trimesh or a trimesh.Scene");
  if (scene) return mesh_of_scene(shape);
  MeshValue out = mesh_of(shape, "shape");
  take_unit(unit_of(shape), out);
  return out;
}

py::object trimesh_of(const MeshValue& mesh, const py::module_& trimesh) {
  const py::object made = trimesh.attr("Trimesh")(
      py::arg("vertices") = vertices_of(mesh.mesh).attr("copy")(),
      py::arg("faces") = faces_of(mesh.mesh).attr("astype")("int64"), py::arg("process") = false);
  for (const auto& [name, unit] : kUnits)
    if (mesh.unit == unit && made.attr("units").is_none()) made.attr("units") = name;
  return made;
}

py::object bodies_to_trimesh(const geom::ConvexSet& set, const py::module_& trimesh) {
  py::list out;
  for (const geom::ConvexBody& body : set.bodies) {
    if (body.radius > 0)
      throw Error(ErrorCode::InvalidArgument,
                  "shape: body '" + body.name +
                      "' has a radius, and triangles would lie inside of it; write() the set, or "
                      "take `bodies` and `radii`");
    MeshValue core;
    core.mesh = std::make_shared<const geom::Mesh>(body.core);
    core.unit = set.provenance.unit;
    out.append(trimesh_of(core, trimesh));
  }
  return out;
}

py::object to_trimesh(const py::object& shape) {
  const bool file = path_of(shape).has_value();
  const bool set = py::hasattr(shape, "bodies") && py::hasattr(shape, "radii");
  if (file || py::isinstance<py::list>(shape))
    throw Error(ErrorCode::InvalidArgument,
                "shape must be a mesh or a set of bodies; read files with read() or read_set()");
  const MeshValue mesh = set ? MeshValue{} : mesh_of(shape, "shape");
  py::module_ trimesh;
  try {
    trimesh = py::module_::import("trimesh");
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_ImportError)) throw;
    throw Error(ErrorCode::NotBuilt, "trimesh cannot be imported: pip install trimesh");
  }
  return set ? bodies_to_trimesh(*set_of(shape), trimesh) : trimesh_of(mesh, trimesh);
}

}  // namespace

void bind_trimesh(py::module_& module) {
  module.def(
      "from_trimesh", &from_trimesh, py::arg("shape"),
      R"(The mesh of a trimesh.Trimesh, or of all geometry of a trimesh.Scene where the scene has it.

Functions that take a mesh take a Trimesh as it is; this keeps its `units`, which lengths such as '5mm' need.
What counts is the triangles, also of trimesh's round primitives.

Parameters
----------
shape : trimesh.Trimesh or trimesh.Scene

Returns
-------
Mesh
    With trimesh's coordinates. Those that a scene moves are rounded; `notes` says so.

Raises
------
Error
    'invalid_input' where a scene has geometry without triangles or of another unit, naming it, or none.)");
  module.def("to_trimesh", &to_trimesh, py::arg("shape"),
             R"(A mesh as a trimesh.Trimesh, with the same vertices and faces in the same order.

Of a set of convex bodies: a list with one for each. They have the unit of the mesh or the set.

Parameters
----------
shape : mesh, or set
    A `Mesh` or a result that is one; a `ConvexSet` or `CertifiedSet`.

Returns
-------
trimesh.Trimesh or list of trimesh.Trimesh
    Copies, which may be changed: what a certificate says is of the shape here.

Raises
------
Error
    'invalid_argument' where a body has a radius; 'not_built' without trimesh.)");
}

}  // namespace kaboum::python
