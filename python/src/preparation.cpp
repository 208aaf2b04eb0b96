// Preparation: the solid that a mesh stands for.

#include <kaboum/certify/mesh.h>

#include "arguments.h"
#include "mesh.h"
#include "preparation.h"
#include "request_options.h"
#include "running.h"

namespace kaboum::python {
namespace {

using certify::PreparationOptions;

PreparedValue prepare(const py::object& mesh, const py::kwargs& given) {
  PreparationOptions asked;
  take_keywords("prepare", repair_options(), given, asked, Runs::Briefly);
  const MeshValue value = mesh_of(mesh, "mesh");
  const geom::PrepareOptions options = asked.preparing();
  return run(0, [&] {
    auto prepared = std::make_shared<geom::Prepared>(certify::prepare_mesh(*value.mesh, options));
    if (value.deviation > 0)
      prepared->report.notes.emplace_back(
          "The triangles stand for exact faces; what is certified of them is about the triangles.");
    return PreparedValue{std::move(prepared)};
  });
}

template <class Member>
auto number(Member geom::PreparationReport::*member) {
  return [member](const PreparedValue& p) { return p.prepared->report.*member; };
}

constexpr const char* kPreparationDoc =
    R"(Gives a mesh a solid, as all tools do first (docs/algorithms/preparation.md).

Equal vertices are merged, inconsistent triangles turned to agree, walls and copies dropped, holes
filled, and shells that are inside out turned.

Parameters
----------
mesh : mesh
{keywords}

Raises
------
Error
    'invalid_input' when no solid can be given.)";

}  // namespace

std::vector<Option<PreparationOptions>> repair_options() {
  return options_named(certify::preparation_options(certify::PreparedFor::Preparing),
                       {"drop-sheets", "holes", "keep-orientation"});
}

void bind_preparation(py::module_& module) {
  py::class_<PreparedValue>(module, "Prepared",
                            R"(A mesh whose solid is defined, and how it came from the input.

What is certified of results is certified with respect to it. It may be given wherever a mesh is
expected; `decimate` does not prepare it again.)")
      .def_property_readonly(
          "vertices", [](const PreparedValue& p) { return vertices_of(p.mesh()); },
          "n x 3 float64, a view that cannot be written. [length]")
      .def_property_readonly(
          "faces", [](const PreparedValue& p) { return faces_of(p.mesh()); },
          "m x 3 uint32, a view that cannot be written.")
      .def_property_readonly(
          "source",
          [](const PreparedValue& p) {
            return view_of(p.prepared->report.source.data(),
                           {static_cast<py::ssize_t>(p.prepared->report.source.size())},
                           p.prepared);
          },
          "Of each face that does not fill a hole, its index in the input.")
      .def_property_readonly(
          "closed", [](const PreparedValue& p) { return p.prepared->solid.closed(); },
          "Whether it has a solid; else nothing is enclosed.")
      .def_property_readonly("components", number(&geom::PreparationReport::components),
                             "Number of parts connected by shared edges.")
      .def_property_readonly("holes", number(&geom::PreparationReport::holes),
                             "Number of holes filled.")
      .def_property_readonly("largest_hole", number(&geom::PreparationReport::largest_hole),
                             "Diagonal of the largest hole's box. [length]")
      .def_property_readonly("dropped_copies", number(&geom::PreparationReport::dropped_copies),
                             "Number of identical triangles dropped.")
      .def_property_readonly("dropped_sheets", number(&geom::PreparationReport::dropped_sheets),
                             "Number of triangles without volume dropped, on request.")
      .def_property_readonly("turned_triangles",
                             number(&geom::PreparationReport::reversed_triangles),
                             "Number of triangles whose orientation was reversed.")
      .def_property_readonly("guessed", number(&geom::PreparationReport::guessed),
                             "Whether which solid is meant is a guess, which notes explain.")
      .def_property_readonly(
          "notes", [](const PreparedValue& p) { return spelled(p.prepared->report.notes); },
          "What was changed, one sentence each.");
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  const std::string text = document("prepare", "mesh: object", keywords_of(repair_options()),
                                    "kaboum.Prepared", kPreparationDoc, Runs::Briefly);
  module.def("prepare", &prepare, py::arg("mesh"), text.c_str());
}

}  // namespace kaboum::python
