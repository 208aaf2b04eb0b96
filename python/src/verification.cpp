// Claims about meshes and sets: kaboum.verify_mesh and verify_cover, as bound-verify.

#include <kaboum/base/parse_length.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/exact_points.h>
#include <kaboum/verify/mesh_verdict.h>
#include <kaboum/verify/region_excess.h>
#include <kaboum/verify/subject.h>
#include <kaboum/verify/verdict_options.h>

#include <cmath>
#include <filesystem>

#include "answers.h"
#include "convex_set.h"
#include "mesh.h"
#include "request_options.h"
#include "running.h"

namespace kaboum::python {
namespace {

using Options = verify::MeshVerdictOptions;

/// The original as it is, or as the tools prepare it.
std::optional<verify::Subject> subject_of(const MeshValue& original, verify::Relation relation,
                                          const Options& asked, std::vector<std::string>& notes) {
  notes = original.notes;
  if (!asked.prepare) return std::nullopt;
  using Diagonal = geom::PrepareOptions::Diagonal;
  const bool inner = relation == verify::Relation::Inner;
  verify::Subject out = verify::prepared_subject(
      *original.mesh, {.drop_sheets = asked.drop_sheets,
                       .holes = geom::Holes::Fill,
                       .quads = original.bent_quads,
                       .diagonal = inner ? Diagonal::Inward : Diagonal::Outward});
  notes.insert(notes.end(), out.report.notes.begin(), out.report.notes.end());
  if (out.refusal.empty()) return out;
  if (inner) throw Error(ErrorCode::InvalidInput, out.refusal);
  notes.push_back("every triangle is judged as it is, for which solid they bound cannot be told (" +
                  out.refusal + ")");
  return out;
}

/// Of a mesh that was read from a file with exact faces, unless it is to enclose.
std::optional<verify::ExactPoints> exact_points_of(const MeshValue& original,
                                                   verify::Relation relation, std::size_t density) {
  if (!original.format || density == 0 || relation == verify::Relation::Inner) return std::nullopt;
  const std::vector<char> bytes = io::read_file(original.source);
  if (io::sha256(bytes) != original.sha256)
    throw Error(ErrorCode::InvalidInput,
                original.source + ": it has changed since the mesh was read; read it again");
  return verify::read_exact_points(bytes, *original.format, original.source, density, 1,
                                   original.exact_faces);
}

py::dict claims_of(const verify::MeshVerdict& found) {
  py::dict out;
  if (found.convex) out["convex"] = dict_of(*found.convex);
  out["solid"] = dict_of(found.inclusion.solid);
  out["surface"] = dict_of(found.inclusion.surface);
  for (const verify::DistanceVerdict& d : found.distances) {
    py::dict distance;
    distance["answer"] = verify::name_of(d.claim.answer);
    distance["reason"] = d.claim.reason;
    distance["bracket"] = py::make_tuple(d.bracket.lower, d.bracket.upper);
    out[verify::name_of(d.between)] = distance;
  }
  if (found.depth) out["depth"] = dict_of(*found.depth);
  if (found.exact_points) out["exact_points"] = dict_of(*found.exact_points);
  return out;
}

/// Of each region a dict, in their order.
py::list regions_of(const verify::MeshVerdict& found, const geom::ConvexSet& set) {
  py::list out;
  for (const verify::RegionVerdict& one : found.regions) {
    py::dict region;
    region["name"] = one.region.name;
    region["answer"] = verify::name_of(one.claim.answer);
    region["reason"] = one.claim.reason;
    region["bound"] = one.region.epsilon;
    region["largest_found"] = one.claim.largest;
    region["at"] = array_of(one.claim.at);
    region["reached"] = verify::may_reach(set, one.region.region);
    out.append(region);
  }
  return out;
}

/// Brings lengths into the unit of the original or, where it states none, into that of the set.
void bring_into_unit(const MeshValue& original, const geom::ConvexSet* set, Options& asked,
                     std::vector<geom::RequestedRegion>& regions, std::vector<std::string>& notes) {
  std::vector<Length*> lengths;
  if (asked.epsilon) lengths.push_back(&*asked.epsilon);
  for (geom::RequestedRegion& one : regions) lengths.push_back(&one.epsilon);
  std::string unit = original.unit;
  if (unit.empty() && set != nullptr && !set->provenance.unit.empty()) {
    unit = set->provenance.unit;
    std::vector<Length> stated;
    stated.reserve(lengths.size());
    for (const Length* length : lengths) stated.push_back(*length);
    for (std::string& note : notes_on_unit(stated, unit + ", which is that of the set"))
      notes.push_back(std::move(note));
  }
  for (Length* length : lengths) *length = length->in(unit);
}

Verdict decide(verify::Relation relation, const MeshValue& original,
               const geom::Mesh& approximation, const geom::ConvexSet* set, Options asked,
               std::vector<geom::RequestedRegion> regions, const RunKeywords& running) {
  Watch watch(running.progress);
  Verdict out;
  const verify::MeshVerdict found = run(running.threads, [&] {
    const auto subject = subject_of(original, relation, asked, out.notes);
    const geom::Mesh& mesh = subject ? subject->mesh : *original.mesh;
    const bool cover = relation == verify::Relation::Cover && set != nullptr;
    const double margin = cover ? geom::margin_of(*set).value_or(0) : 0;
    const double diagonal = geom::bounding_box(mesh).diagonal();
    bring_into_unit(original, set, asked, regions, out.notes);
    std::optional<double> bound;
    if (asked.epsilon) {
      bound = asked.epsilon->of(diagonal);
      if (!std::isfinite(*bound) || !(*bound > margin))
        throw Error(ErrorCode::InvalidArgument,
                    "epsilon must be larger than the set's margin, and finite");
    }
    const auto exact = exact_points_of(original, relation, asked.exact_points);
    std::optional<verify::PointQuestion> points;
    if (exact) points = verify::PointQuestion{exact->points, exact->of_face, exact->rounding};
    std::optional<verify::MeasuredMesh> measured;
    if (subject && relation == verify::Relation::Cover &&
        (subject->has_more || !subject->refusal.empty()))
      measured = verify::measured_mesh(*subject, *original.mesh);
    return verify::decide({mesh, approximation, set, relation, asked.claims, bound,
                           asked.max_contacts, asked.max_work, watch.hook(), points,
                           subject ? &*subject : nullptr, measured ? &*measured : nullptr,
                           geom::bounded(regions, diagonal)});
  });
  out.answer = found.answer;
  out.claims = claims_of(found);
  if (!found.regions.empty()) out.claims["regions"] = regions_of(found, *set);
  if (original.exact_faces > 0 && !found.exact_points)
    out.claims["exact_points"] = exact_points_not_looked_at();
  return out;
}

/// What approximation stands for, as a mesh and as a set.
struct Approximation {
  geom::Mesh sum;
  MeshValue mesh;
  std::shared_ptr<const geom::ConvexSet> set;

  [[nodiscard]] const geom::Mesh& triangles() const { return set ? sum : *mesh.mesh; }
};

/// Whether a file says that it holds a set of convex bodies: a folder, or a container.
bool holds_bodies(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return true;
  if (io::format_from_name(std::filesystem::path(path).extension().string()) != io::Format::Glb)
    return false;
  const std::vector<char> bytes = io::read_file(path);
  try {
    io::SetReadDetails details;
    io::parse_convex_set(bytes, io::Format::Glb, path, &details);
    return details.has_record;
  } catch (const Error&) {  // the reader of meshes says what is wrong
    return false;
  }
}

Approximation approximation_of(const py::object& value, verify::Relation relation) {
  Approximation out;
  const auto path = path_of(value);
  const bool is_set_in_file = path && holds_bodies(*path);
  if (relation == verify::Relation::Cover) {
    out.set = set_of(value);
    if (!out.set)
      throw Error(ErrorCode::InvalidArgument,
                  "set: a set is a ConvexSet, the name of a file or folder, or a list of meshes");
  } else if (is_set_in_file || py::isinstance<SetValue>(value) ||
             py::isinstance<CertifiedSetValue>(value)) {
    if (relation == verify::Relation::Outer)
      throw Error(ErrorCode::InvalidArgument,
                  "approximation is a set of convex bodies: ask verify_cover whether it covers");
    out.set = set_of(value);
  } else {
    out.mesh = mesh_of(value, "approximation");
  }
  if (out.set) out.sum = verify::sum_of(*out.set);
  return out;
}

using Table = std::vector<Option<Options>>;

Verdict verify_relation(const char* function, verify::Relation relation, const Table& table,
                        const py::object& original, const py::object& approximation,
                        const py::kwargs& given, std::vector<geom::RequestedRegion> regions = {}) {
  Options asked;
  const RunKeywords running = take_keywords(function, table, given, asked, Runs::Threads);
  require_none(contradiction(asked));
  const MeshValue first = mesh_of(original, "original");
  const Approximation second = approximation_of(approximation, relation);
  return decide(relation, first, second.triangles(), second.set.get(), asked, std::move(regions),
                running);
}

void bind_verification_class(py::module_& module) {
  py::class_<Verdict>(module, "Verdict",
                      R"(What was decided, exactly. True if and only if it is 'verified'.)")
      .def_property_readonly(
          "answer", [](const Verdict& v) { return verify::name_of(v.answer); },
          "'verified', 'refuted', 'undecided' (within limits) or 'undefined' "
          "(the claims mean nothing for these shapes).")
      .def_readonly("claims", &Verdict::claims,
                    "By its name, each claim: a dict with 'answer', 'reason' and, where it is "
                    "refuted, 'witness' (a point) and 'depth'.")
      .def_property_readonly("notes", notes_of(&Verdict::notes),
                             "What a user should know of the input.")
      .def("__bool__", [](const Verdict& v) { return v.answer == verify::Answer::Verified; })
      .def("__repr__", [](const Verdict& v) {
        return std::string("<kaboum.Verdict: ") + verify::name_of(v.answer) + ">";
      });
}

constexpr const char* kMeshDoc =
    R"(Decides exactly whether one mesh encloses the other, as `bound-verify mesh`.

It shares nothing with what makes such meshes (docs/algorithms/exact-inclusion.md).

Parameters
----------
original, approximation : mesh
    With relation 'inner', the approximation may be a ConvexSet.
relation : str
    'outer': the approximation encloses the original; 'inner': the other way round.
{keywords}

Raises
------
Error
    'invalid_input' on numbers that are not finite.)";

constexpr const char* kCoverDoc =
    R"(Decides exactly whether bodies are convex and cover a mesh, as `bound-verify cover`.

Parameters
----------
original : mesh
set : ConvexSet, name of a file or folder, or list of meshes
epsilon_map : name of a file, or list of dict, optional
    Also decide that no point of the union in a region is farther from the solid than the region's
    own epsilon, as `decompose` takes it; 'regions' of the claims is a list of dicts.
{keywords}

Raises
------
Error
    As `verify_mesh`.)";

}  // namespace

py::dict dict_of(const verify::Claim& claim) {
  py::dict out;
  out["answer"] = verify::name_of(claim.answer);
  out["reason"] = claim.reason;
  if (claim.witness) {
    out["witness"] = array_of(claim.witness->point);
    out["depth"] = claim.witness->depth;
  }
  return out;
}

py::dict dict_of(const verify::PointClaim& claim) {
  py::dict out;
  out["answer"] = verify::name_of(claim.answer);
  out["reason"] = claim.reason;
  out["points"] = claim.points;
  out["outside"] = claim.outside;
  if (claim.outside > 0) {
    out["farthest"] = claim.farthest;
    out["at"] = array_of(claim.at);
    out["face"] = claim.face + 1;
  }
  return out;
}

py::dict exact_points_not_looked_at() {
  py::dict out;
  out["answer"] = verify::name_of(verify::Answer::Undefined);
  out["reason"] = "points of the exact faces were not looked at: this is about the triangles";
  return out;
}

void bind_verification(py::module_& module) {
  bind_verification_class(module);
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  std::string text = document("verify_mesh", "original: object, approximation: object",
                              keywords_of(verify::mesh_verdict_options()), "kaboum.Verdict",
                              kMeshDoc, Runs::Threads);
  text.replace(text.find("*,"), 2, "*, relation: str = 'outer',");
  module.def(
      "verify_mesh",
      [](const py::object& original, const py::object& approximation, const std::string& relation,
         const py::kwargs& given) {
        static constexpr std::array<std::pair<const char*, verify::Relation>, 2> kRelations{
            {{"outer", verify::Relation::Outer}, {"inner", verify::Relation::Inner}}};
        return verify_relation("verify_mesh", value_of(kRelations, relation, "relation"),
                               verify::mesh_verdict_options(), original, approximation, given);
      },
      py::arg("original"), py::arg("approximation"), py::kw_only(), py::arg("relation") = "outer",
      text.c_str());
  text = document("verify_cover", "original: object, set: object, *, epsilon_map: object = None",
                  keywords_of(verify::cover_verdict_options()), "kaboum.Verdict", kCoverDoc,
                  Runs::Threads);
  module.def(
      "verify_cover",
      [](const py::object& original, const py::object& set, const py::object& epsilon_map,
         const py::kwargs& given) {
        return verify_relation("verify_cover", verify::Relation::Cover,
                               verify::cover_verdict_options(), original, set, given,
                               regions_of(epsilon_map));
      },
      py::arg("original"), py::arg("set"), py::kw_only(), py::arg("epsilon_map") = py::none(),
      text.c_str());
}

}  // namespace kaboum::python
