// Wraps: kaboum.wrap, as mesh-prepare --prepare wrap.

#include <kaboum/certify/preparation_options.h>
#include <kaboum/certify/wrap.h>

#include "answers.h"
#include "arguments.h"
#include "mesh.h"
#include "request_options.h"
#include "running.h"

namespace kaboum::python {
namespace {

struct WrapValue {
  std::shared_ptr<const certify::CertifiedWrap> made;
  std::vector<std::string> notes;

  /// Keeps what it looks into.
  [[nodiscard]] std::shared_ptr<const geom::Mesh> mesh() const { return {made, &made->artefact()}; }
};

WrapValue wrap(const py::object& mesh, const std::string& precision, const py::kwargs& given) {
  certify::WrapOptions asked;
  const RunKeywords running =
      take_keywords("wrap", certify::wrap_options(), given, asked, Runs::Threads);
  const MeshValue value = mesh_of(mesh, "mesh");
  bring_lengths_into(value.unit, certify::wrap_options(), asked);
  if (precision != "float" && precision != "double")
    refuse_name("precision", precision, {"float", "double"});
  certify::WrapRequest request;
  request.offset = asked.offset;
  request.seal = asked.seal;
  if (asked.epsilon)
    request.farthest = asked.epsilon->of(geom::bounding_box(*value.mesh).diagonal());
  request.clearance = value.deviation;
  request.quads = value.bent_quads;
  request.float32 = precision == "float";
  Watch watch(running.progress);
  request.progress = watch.hook();
  return run(running.threads, [&] {
    return WrapValue{
        std::make_shared<certify::CertifiedWrap>(certify::certify_wrap(*value.mesh, request)),
        value.notes};
  });
}

constexpr const char* kWrapDoc =
    R"(A closed mesh whose solid holds every triangle of the input, whatever they are like.

Decided exactly by what shares nothing with the search, as `mesh-prepare --prepare wrap`
(docs/algorithms/wrapping.md). The result may be given wherever a mesh is expected.

Parameters
----------
mesh : mesh
precision : str
    Of the wrap's numbers: 'float' or 'double'.
{keywords}

Raises
------
Error
    'invalid_input' where there is nothing to wrap, or it would be farther than `epsilon`.)";

}  // namespace

void bind_wraps(py::module_& module) {
  py::class_<WrapValue>(module, "Wrap", "A closed mesh that was decided to hold all triangles.")
      .def_property_readonly(
          "vertices", [](const WrapValue& w) { return vertices_of(w.mesh()); },
          "n x 3 float64, a view that cannot be written. [length]")
      .def_property_readonly(
          "faces", [](const WrapValue& w) { return faces_of(w.mesh()); },
          "m x 3 uint32, a view that cannot be written.")
      .def_property_readonly(
          "certificate",
          [](const WrapValue& w) { return dict_of(certify::certificate_of(*w.made)); },
          kCertificateDoc)
      .def_property_readonly(
          "report",
          [](const WrapValue& w) {
            return py::module_::import("json").attr("loads")(
                certify::to_json(w.made->certificate()));
          },
          "A dict, as in mesh-prepare's report: 'offset', 'seal', distances.")
      .def_property_readonly(
          "distance",
          [](const WrapValue& w) {
            const certify::WrapCertificate& c = w.made->certificate();
            return py::make_tuple(c.farthest_lower, c.farthest_upper);
          },
          "Certified bracket of the largest distance of its points from the "
          "triangles. [length]")
      .def_property_readonly("notes", notes_of(&WrapValue::notes), "What a user should know.")
      .def("__repr__", [](const WrapValue& w) {
        return "<kaboum.Wrap of " + std::to_string(w.made->artefact().vertices.size()) +
               " vertices, " + std::to_string(w.made->artefact().triangles.size()) + " faces>";
      });
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  std::string text = document("wrap", "mesh: object", keywords_of(certify::wrap_options()),
                              "kaboum.Wrap", kWrapDoc, Runs::Threads);
  text.replace(text.find("*,"), 2, "*, precision: str = 'float',");
  module.def("wrap", &wrap, py::arg("mesh"), py::kw_only(), py::arg("precision") = "float",
             text.c_str());
}

}  // namespace kaboum::python
