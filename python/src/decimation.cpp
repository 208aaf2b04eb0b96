// Bounding meshes: kaboum.decimate, as bmesh-decimate.

#include <kaboum/certify/large_epsilon.h>
#include <kaboum/certify/mesh_bytes.h>
#include <kaboum/certify/mesh_file.h>
#include <kaboum/certify/mesh_options.h>
#include <kaboum/page/mesh_page.h>

#include <filesystem>

#include "answers.h"
#include "arguments.h"
#include "mesh.h"
#include "pictures.h"
#include "request_options.h"
#include "running.h"

namespace kaboum::python {
namespace {

using certify::CertifiedMesh;
using certify::MeshCertificate;

constexpr std::array<std::pair<const char*, bmesh::Stop>, 4> kStops{
    {{"vertices", bmesh::Stop::VertexTarget},
     {"epsilon", bmesh::Stop::ErrorBound},
     {"exhausted", bmesh::Stop::Exhausted},
     {"out of work", bmesh::Stop::OutOfWork}}};

template <class Names, class Value>
const char* name_of(const Names& names, Value value) {
  for (const auto& [name, known] : names)
    if (known == value) return name;
  return "";
}

/// A certified result, and the format of its bytes.
struct BoundingMesh {
  CertifiedMesh made;
  io::Format format = io::Format::Ply;
  std::vector<std::string> notes;
  bool wrapped = false;
  double diagonal = 0;
  std::shared_ptr<const certify::BoundedMesh> series = nullptr;  ///< that it is one of
  std::string name = {};                                         ///< of the original

  [[nodiscard]] const MeshCertificate& certificate() const { return made.certificate(); }
  /// Keeps what it looks into.
  [[nodiscard]] std::shared_ptr<const geom::Mesh> mesh() const {
    auto kept = std::make_shared<CertifiedMesh>(made);
    return {kept, &kept->artefact()};
  }
};

std::string direction_of(const BoundingMesh& m) {
  certify::MeshOptions options;
  options.request.direction = m.certificate().direction;
  return value_of(certify::mesh_options(), "direction", options);
}

py::list claims_of(const BoundingMesh& m) {
  py::list out;
  for (const certify::Claim& claim : certify::certificate_of(m.made).claims) {
    py::dict d;
    d["claim"] = certify::name_of(claim.kind);
    d["answer"] = verify::name_of(claim.answer);
    d["basis"] = certify::name_of(claim.basis);
    d["reason"] = claim.reason;
    d["distance"] = claim.distance;
    out.append(d);
  }
  return out;
}

py::object distances_of(const BoundingMesh& m) {
  const auto& there = m.certificate().original_to_result;
  const auto& back = m.certificate().result_to_original;
  if (!there || !back) return py::none();
  const auto bracket = [](const geom::DirectedDistance& d) {
    return py::make_tuple(d.max_lower, d.max_upper);
  };
  py::dict out;
  out["original_to_result"] = bracket(*there);
  out["result_to_original"] = bracket(*back);
  out["hausdorff"] = py::make_tuple(std::max(there->max_lower, back->max_lower),
                                    m.certificate().hausdorff_upper());
  return out;
}

/// Of which an extension makes no difference.
io::Format kind_of(io::Format format) {
  return format == io::Format::StlAscii   ? io::Format::Stl
         : format == io::Format::PlyAscii ? io::Format::Ply
                                          : format;
}

/// The certified bytes, or the same mesh in another format, read back and compared.
void write(const BoundingMesh& m, const py::object& path) {
  const auto file = path_of(path);
  if (!file) throw Error(ErrorCode::InvalidArgument, "path must be a str or an os.PathLike");
  const std::string extension = std::filesystem::path(*file).extension().string();
  const auto format = io::format_from_name(extension);
  run(0, [&] {
    const bool same = !format || kind_of(*format) == kind_of(m.format);
    io::write_file(*file, same ? m.made.bytes()
                               : certify::serialise_checked(m.made.artefact(), *format,
                                                            m.certificate().double_precision,
                                                            "KABouM " KABOUM_VERSION));
  });
}

void write_mesh_preview(const BoundingMesh& m, const py::object& file) {
  page::MeshWords words{m.name, {}, spelled(m.notes)};
  for (std::size_t i = 0; i < m.series->series.meshes.size(); ++i)
    words.summaries.push_back(page::summary_of(*m.series, i));
  write_preview(file, [&] { return page::page_of_meshes(words, *m.series); }, {});
}

void bind_decimation_class(py::module_& module) {
  const auto of = [](auto member) {
    return [member](const BoundingMesh& m) { return m.certificate().*member; };
  };
  py::class_<BoundingMesh>(
      module, "BoundingMesh",
      R"(A mesh that encloses its original, or is enclosed by it, and what is certified of it.

It may be given wherever a mesh is expected.)")
      .def_property_readonly(
          "vertices", [](const BoundingMesh& m) { return vertices_of(m.mesh()); },
          "n x 3 float64, a view that cannot be written. [length]")
      .def_property_readonly(
          "faces", [](const BoundingMesh& m) { return faces_of(m.mesh()); },
          "m x 3 uint32, a view that cannot be written.")
      .def_property_readonly("direction", &direction_of, "'outer', 'inner' or 'any'.")
      .def_property_readonly(
          "stop", [](const BoundingMesh& m) { return name_of(kStops, m.certificate().stop); },
          "Why it has no fewer vertices: 'vertices', 'epsilon', 'exhausted' or 'out of work'.")
      .def_property_readonly(
          "reached", [](const BoundingMesh& m) { return m.certificate().reached(); },
          "Whether there are as few vertices as wished, or epsilon allows no fewer.")
      .def_property_readonly(
          "holds",
          [](const BoundingMesh& m) {
            return m.certificate().surface_answer() == verify::Answer::Verified;
          },
          "Whether every triangle is where it should be: of the original in the result (inner: the "
          "other way round). `claims` says what is not.")
      .def_readonly("wrapped", &BoundingMesh::wrapped,
                    "Whether what is enclosed is a wrap of the original; `notes` say why.")
      .def_property_readonly("closed", of(&MeshCertificate::closed),
                             "Whether the original has a solid; else nothing is enclosed.")
      .def_property_readonly("out_of_work", of(&MeshCertificate::out_of_work),
                             "Whether it might be nearer with a larger max_work.")
      .def_property_readonly("epsilon", of(&MeshCertificate::epsilon),
                             "What no point of either surface is farther than, or None. [length]")
      .def_property_readonly("distances", &distances_of,
                             "Certified brackets (lower, upper) of the largest distances "
                             "'original_to_result', 'result_to_original' and 'hausdorff', surface "
                             "to surface, or None where they were not measured. [length]")
      .def_property_readonly(
          "certificate",
          [](const BoundingMesh& m) { return dict_of(certify::certificate_of(m.made)); },
          kCertificateDoc)
      .def_property_readonly("claims", &claims_of,
                             "All that is claimed: dicts of 'claim', 'answer', 'basis' (what the "
                             "answer rests on), 'reason' and 'distance'.")
      .def_property_readonly("notes", notes_of(&BoundingMesh::notes),
                             "What a user should know of the input.")
      .def_property_readonly(
          "bytes",
          [](const BoundingMesh& m) {
            return py::bytes(m.made.bytes().data(), m.made.bytes().size());
          },
          "The certified file, in the format that was asked for.")
      .def("write", &write, py::arg("path"),
           "Writes the certified file; another extension: the same coordinates in that format.")
      .def("write_preview", &write_mesh_preview, py::arg("file"),
           "Writes a page (.html) that shows the result over the original, of a list all results, "
           "as `bmesh-decimate --preview`.")
      .def("__repr__", [](const BoundingMesh& m) {
        return std::string("<kaboum.BoundingMesh (") + direction_of(m) + ") of " +
               std::to_string(m.certificate().vertices) + " vertices>";
      });
}

/// What is asked for, and the format of the bytes.
struct DecimateOptions {
  certify::MeshOptions mesh;
  std::string format = "ply";
};

const std::vector<Option<DecimateOptions>>& decimate_options() {
  static const std::vector<Option<DecimateOptions>> options = [] {
    auto out = options_of_part<DecimateOptions>(
        certify::mesh_options(), [](auto& r) -> auto& { return r.mesh; });
    out.push_back(option<DecimateOptions>(
        {.name = "output-format", .text = "Format of `bytes`"},
        [](auto& r) -> auto& { return r.format; }));
    return out;
  }();
  return options;
}

std::vector<BoundingMesh> decimated(const py::object& mesh, certify::MeshOptions options,
                                    const RunKeywords& running) {
  Watch watch(running.progress);
  std::shared_ptr<const geom::Prepared> original;
  std::string name = "the mesh";
  std::vector<std::string> notes;
  MeshValue value;
  if (py::isinstance<PreparedValue>(mesh)) {
    original = mesh.cast<PreparedValue>().prepared;
  } else {
    value = mesh_of(mesh, "mesh");
    if (!value.source.empty()) name = value.source;
    notes = value.notes;
  }
  bring_lengths_into(value.unit, certify::mesh_options(), options);
  return run(running.threads, [&] {
    const certify::MeshHooks hooks{.progress = watch.hook(), .found = {}, .prepared = {}};
    const certify::MeshRequest& request = options.request;
    certify::BoundedMesh made;
    const geom::Mesh& input = original ? original->solid.mesh() : *value.mesh;
    if (std::string text =
            certify::warning_of(request.epsilon, geom::bounding_box(input).diagonal());
        !text.empty())
      notes.push_back(std::move(text));
    if (original) {
      made.series = certify::certify_meshes(*original, request, hooks);
      notes.insert(notes.end(), original->report.notes.begin(), original->report.notes.end());
    } else {
      made = certify::bound_mesh(
          *value.mesh, request, certify::preparation_of(options, value.bent_quads, value.deviation),
          hooks);
      for (std::string& text : certify::notes_of(made)) notes.push_back(std::move(text));
    }
    if (made.series.meshes.empty()) throw certify::TooCoarse(name);
    if (original) made.original = *original;
    const auto kept = std::make_shared<const certify::BoundedMesh>(std::move(made));
    std::vector<BoundingMesh> out;
    for (const CertifiedMesh& one : kept->series.meshes)
      out.push_back({one, request.format, notes, kept->wrap.has_value(), kept->series.plan.diagonal,
                     kept, name});
    return out;
  });
}

py::object decimate(const py::object& mesh, const py::kwargs& given) {
  py::dict keywords = given;
  const py::object vertices = keywords.attr("get")("vertices");
  const bool several = !vertices.is_none() && !whole_number(vertices);
  DecimateOptions options;
  const std::set<std::string> stated = take_options(decimate_options(), keywords, options);
  const RunKeywords running = take_run_keywords(keywords, Runs::Threads);
  require_all_taken("decimate", keywords, keywords_of(decimate_options()), Runs::Threads);
  require_none(certify::contradiction(options.mesh, stated));
  options.mesh.request.format = *format_of(options.format, "output_format");
  options.mesh.request.comment = "bmesh-decimate " KABOUM_VERSION;
  std::vector<BoundingMesh> made = decimated(mesh, options.mesh, running);
  if (several) return py::cast(std::move(made));
  return py::cast(std::move(made.front()));
}

constexpr const char* kDecimationDoc =
    R"(Simplifies a mesh so that the result provably encloses it, or is enclosed by it.

Options and defaults are those of bmesh-decimate (docs/algorithms/bounding-mesh.md).

Parameters
----------
mesh : mesh
    Prepared first, unless it is a `Prepared`. Several numbers of vertices give a list, the largest
    number first.
{keywords}

Returns
-------
BoundingMesh, or a list of them
    Where a wished number cannot be reached, `reached` is False; the result encloses as ever. Where
    triangles stick out and no wrap may or can take the mesh's place, `holds` is False.

Raises
------
Error
    'invalid_input' when the mesh has no solid, or float32 is too coarse so far from the origin.)";

}  // namespace

void bind_decimation(py::module_& module) {
  bind_decimation_class(module);
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  const std::string text = document("decimate", "mesh: object", keywords_of(decimate_options()),
                                    "object", kDecimationDoc, Runs::Threads);
  module.def("decimate", &decimate, py::arg("mesh"), text.c_str());
}

}  // namespace kaboum::python
