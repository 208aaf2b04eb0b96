// Bounding meshes: kaboum.decimate, as bmesh-decimate.

#include <kaboum/certify/mesh.h>
#include <kaboum/certify/mesh_bytes.h>
#include <kaboum/certify/mesh_file.h>

#include <filesystem>

#include "arguments.h"
#include "mesh.h"
#include "running.h"

namespace kaboum::python {
namespace {

using certify::CertifiedMesh;
using certify::MeshCertificate;

constexpr std::array<std::pair<const char*, bmesh::Direction>, 3> kDirections{
    {{"outer", bmesh::Direction::Outer},
     {"inner", bmesh::Direction::Inner},
     {"any", bmesh::Direction::Any}}};
constexpr std::array<std::pair<const char*, bmesh::Cost>, 6> kCosts{
    {{"distance", bmesh::Cost::Distance},
     {"mean", bmesh::Cost::Mean},
     {"planes", bmesh::Cost::Planes},
     {"planes-adapted", bmesh::Cost::PlanesAdapted},
     {"planes-diagonal", bmesh::Cost::PlanesDiagonal},
     {"triangles", bmesh::Cost::Triangles}}};
constexpr std::array<std::pair<const char*, bmesh::Effort>, 3> kEfforts{
    {{"fast", bmesh::Effort::Fast},
     {"normal", bmesh::Effort::Normal},
     {"best", bmesh::Effort::Best}}};
using Numbers = certify::MeshRequest::Numbers;
constexpr std::array<std::pair<const char*, Numbers>, 3> kNumbers{
    {{"auto", Numbers::Auto}, {"float", Numbers::Float}, {"double", Numbers::Double}}};
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

  [[nodiscard]] const MeshCertificate& certificate() const { return made.certificate(); }
  /// Keeps what it looks into.
  [[nodiscard]] std::shared_ptr<const geom::Mesh> mesh() const {
    auto kept = std::make_shared<CertifiedMesh>(made);
    return {kept, &kept->artefact()};
  }
};

py::list claims_of(const BoundingMesh& m) {
  py::list out;
  for (const certify::MeshClaim& claim : certify::claims(m.made)) {
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

void bind_class(py::module_& module) {
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
      .def_property_readonly(
          "direction",
          [](const BoundingMesh& m) { return name_of(kDirections, m.certificate().direction); },
          "'outer', 'inner' or 'any'.")
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
      .def_property_readonly("claims", &claims_of,
                             "All that is claimed: dicts of 'claim', 'answer', 'basis' (what the "
                             "answer rests on), 'reason' and 'distance'.")
      .def_readonly("notes", &BoundingMesh::notes, "What a user should know of the input.")
      .def_property_readonly(
          "bytes",
          [](const BoundingMesh& m) {
            return py::bytes(m.made.bytes().data(), m.made.bytes().size());
          },
          "The certified file, in the format that was asked for.")
      .def("write", &write, py::arg("path"),
           "Writes the certified file; another extension: the same coordinates in that format.")
      .def("__repr__", [](const BoundingMesh& m) {
        return std::string("<kaboum.BoundingMesh (") +
               name_of(kDirections, m.certificate().direction) + ") of " +
               std::to_string(m.certificate().vertices) + " vertices>";
      });
}

/// One number or several.
std::vector<std::size_t> counts_of(const py::object& vertices, bool& several) {
  several = false;
  if (vertices.is_none()) return {};
  if (PyIndex_Check(vertices.ptr()) != 0) return {vertices.cast<std::size_t>()};
  several = true;
  return vertices.cast<std::vector<std::size_t>>();
}

std::vector<BoundingMesh> decimated(const py::object& mesh,
                                    const certify::MeshPreparation& preparation,
                                    const certify::MeshRequest& request, int threads,
                                    const py::object& progress) {
  Watch watch(progress);
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
  return run(threads, [&] {
    const certify::MeshHooks hooks{.progress = watch.hook(), .found = {}, .prepared = {}};
    certify::BoundedMesh made;
    if (original) {
      made.series = certify::certify_meshes(*original, request, hooks);
      notes.insert(notes.end(), original->report.notes.begin(), original->report.notes.end());
    } else {
      using Wrap = certify::MeshPreparation::Wrap;
      certify::MeshPreparation asked = preparation;
      // Of STEP and IGES the exact faces are what is enclosed.
      if (value.deviation > 0 && request.direction == bmesh::Direction::Outer &&
          asked.wrap == Wrap::WhereNeeded)
        asked.wrap = Wrap::Always;
      asked.wrapping.clearance = value.deviation;
      if (request.direction != bmesh::Direction::Any) {
        using Diagonal = geom::PrepareOptions::Diagonal;
        asked.options.quads = value.bent_quads;
        asked.options.diagonal =
            request.direction == bmesh::Direction::Outer ? Diagonal::Outward : Diagonal::Inward;
      }
      made = certify::bound_mesh(*value.mesh, request, asked, hooks);
      for (std::string& text : certify::notes_of(made)) notes.push_back(std::move(text));
    }
    if (made.series.meshes.empty()) throw certify::TooCoarse(name);
    std::vector<BoundingMesh> out;
    for (const CertifiedMesh& one : made.series.meshes)
      out.push_back({one, request.format, notes, made.wrap.has_value(), made.series.plan.diagonal});
    return out;
  });
}

constexpr std::array<std::pair<const char*, certify::MeshPreparation::Wrap>, 4> kPreparations{
    {{"auto", certify::MeshPreparation::Wrap::WhereNeeded},
     {"strict", certify::MeshPreparation::Wrap::Never},
     {"wrap", certify::MeshPreparation::Wrap::Always},
     {"off", certify::MeshPreparation::Wrap::Never}}};

py::object decimate(const py::object& mesh, const py::object& vertices,
                    const std::optional<double>& ratio, const py::object& epsilon,
                    const std::string& direction, const std::string& cost,
                    const std::string& effort, const std::optional<double>& max_work,
                    bool as_printed, const std::string& precision, double sharp_angle,
                    bool keep_convex, const std::string& prepare, const py::object& offset,
                    const py::object& seal, bool drop_sheets, const std::string& holes,
                    bool keep_orientation, bool verify, bool measure,
                    const std::string& output_format, int threads, const py::object& progress) {
  certify::MeshRequest r;
  bool several = false;
  r.vertices = counts_of(vertices, several);
  r.ratio = ratio;
  r.epsilon = length_of(epsilon, "epsilon");
  if (r.vertices.empty() && !r.ratio && !r.epsilon)
    throw Error(ErrorCode::InvalidArgument, "give at least one of vertices, ratio and epsilon");
  r.direction = value_of(kDirections, direction, "direction");
  r.cost = value_of(kCosts, cost, "cost");
  r.effort = value_of(kEfforts, effort, "effort");
  r.max_work = max_work;
  r.as_printed = as_printed;
  r.numbers = value_of(kNumbers, precision, "precision");
  if (cost.starts_with("planes") || sharp_angle != bmesh::kSharpAngle) r.sharp_angle = sharp_angle;
  r.keep_convex = keep_convex;
  r.decide = verify;
  r.measure = measure;
  r.format = *format_of(output_format, "output_format");
  r.comment = "bmesh-decimate " KABOUM_VERSION;
  certify::MeshPreparation preparation;
  preparation.wrap = value_of(kPreparations, prepare, "prepare");
  preparation.options = {.drop_sheets = drop_sheets,
                         .holes = prepare == "strict" ? geom::Holes::Refuse
                                  : prepare == "off"  ? geom::Holes::Keep
                                                      : holes_of(holes, true),
                         .keep_orientation = keep_orientation || prepare == "off"};
  preparation.wrapping.offset = length_of(offset, "offset");
  preparation.wrapping.seal = length_of(seal, "seal");
  std::vector<BoundingMesh> made = decimated(mesh, preparation, r, threads, progress);
  if (several) return py::cast(std::move(made));
  return py::cast(std::move(made.front()));
}

constexpr const char* kDoc =
    R"(Simplifies a mesh so that the result provably encloses it, or is enclosed by it.

Options and defaults are those of bmesh-decimate (docs/algorithms/bounding-mesh.md).

Parameters
----------
mesh : mesh
    Prepared first, unless it is a `Prepared`.
vertices : int or sequence of int, optional
    Stop at this many vertices. Several, falling, give a list: each result encloses (inner: is
    enclosed by) the ones before.
ratio : float, optional
    Stop at this share of the vertices, between 0 and 1.
epsilon : float or str, optional
    Keep every point of either surface this near to the other: a length, or a percentage of the
    diagonal such as '0.5%'. The first of the three that is reached stops.
direction : str
    'outer', 'inner', or 'any', which claims nothing.
cost : str
    'distance', 'mean', 'planes', 'planes-adapted', 'planes-diagonal' or 'triangles'.
effort : str
    'fast', 'normal' or 'best'.
max_work : float, optional
    End after work of about so many seconds; the result does not depend on the machine.
precision : str
    'auto', 'float' or 'double'.
sharp_angle : float
    Edges sharper than this resist spikes (costs 'planes...' only). [degrees]
keep_convex : bool
    Convex in, convex out, exactly.
prepare : str
    'auto', 'strict', 'wrap' or 'off': how the triangles get a solid. 'auto' wraps the mesh where some
    triangle would not be enclosed otherwise, or there is no solid.
offset, seal : float or str, optional
    Of a wrap, as for `wrap`.
drop_sheets, holes, keep_orientation
    As for `kaboum.prepare`.
verify : bool
    Decide all claims anew, exactly and by independent means.
measure : bool
    Certified brackets of distances, which epsilon and verify measure anyway.
output_format : str
    Of `bytes`.
threads : int
    0: one per core. The result is the same for any number.
progress : callable, optional
    Called with what is being done; what it raises ends the work, as Ctrl-C does.

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
  bind_class(module);
  module.def(
      "decimate", &decimate, py::arg("mesh"), py::kw_only(), py::arg("vertices") = py::none(),
      py::arg("ratio") = py::none(), py::arg("epsilon") = py::none(),
      py::arg("direction") = "outer", py::arg("cost") = "distance", py::arg("effort") = "normal",
      py::arg("max_work") = py::none(), py::arg("as_printed") = false,
      py::arg("precision") = "auto", py::arg("sharp_angle") = 90.0, py::arg("keep_convex") = false,
      py::arg("prepare") = "auto", py::arg("offset") = py::none(), py::arg("seal") = py::none(),
      py::arg("drop_sheets") = false, py::arg("holes") = "fill",
      py::arg("keep_orientation") = false, py::arg("verify") = false, py::arg("measure") = false,
      py::arg("output_format") = "ply", py::arg("threads") = 0, py::arg("progress") = py::none(),
      kDoc);
}

}  // namespace kaboum::python
