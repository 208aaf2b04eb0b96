// The meshes that bound-verify judges, as they are read and prepared.

#include "mesh_input.h"

#include <kaboum/base/error.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/verify/cover.h>

namespace kaboum::tools {

namespace {

MeshInput read(const std::string& path, io::Format format, const UnitOption& unit = {},
               std::size_t density = 0) {
  std::vector<char> bytes;
  io::ReadResult r = io::read_mesh(path, format, &bytes);
  apply(r, unit, path);
  MeshInput out;
  out.unit = r.unit;
  out.deviation = r.deviation;
  out.about_exact = io::about_exact_faces(r);
  out.about_import = io::about_import(r);
  out.single_precision = r.single_precision;
  if (density > 0 && io::is_cad(r.format))
    out.exact =
        verify::read_exact_points(bytes, r.format, path, density, unit.scale, r.exact_faces);
  out.mesh = std::move(r.mesh);
  out.quads = std::move(r.bent_quads);
  out.sha256 = io::sha256(bytes);
  out.notes = std::move(r.notes);
  if (r.collapsed_triangles != 0)
    out.notes.push_back(std::to_string(r.collapsed_triangles) +
                        " triangles with repeated corners bound nothing and are left out");
  return out;
}

geom::PrepareOptions options_of(const MeshInput& original, bool drop_sheets) {
  geom::PrepareOptions options;
  options.drop_sheets = drop_sheets;
  options.holes = geom::Holes::Fill;
  options.quads = original.quads;
  options.diagonal = original.diagonal;
  return options;
}

}  // namespace

MeshInput read_original(const VerifyMeshOptions& o) {
  using Diagonal = geom::PrepareOptions::Diagonal;
  const bool inner = o.relation == verify::Relation::Inner;
  // Whether points of exact faces are inside what encloses, or is covered, is what they can tell.
  MeshInput out = read(o.original, format_for(o.original, o.original_format), o.unit,
                       inner ? 0 : o.how.exact_points);
  out.diagonal = inner ? Diagonal::Inward : Diagonal::Outward;
  return out;
}

ApproximationInput read_approximation(const VerifyMeshOptions& o) {
  constexpr const char* kOption = "--approximation-format";
  const bool folder = is_folder(o.approximation);
  const bool surely_set = o.relation == verify::Relation::Cover || o.set || folder;
  std::optional<io::Format> format;
  if (!folder) format = format_for(o.approximation, o.approximation_format, kOption);
  const bool may_have_record = o.approximation != "-" && format == io::Format::Glb;
  ApproximationInput out;
  if (surely_set || may_have_record) {
    io::SetReadDetails details;
    out.set = io::read_convex_set(o.approximation, format, &details);
    out.is_set = surely_set || details.has_record;
    if (out.is_set && o.relation == verify::Relation::Outer)
      throw Error(ErrorCode::InvalidArgument,
                  o.approximation +
                      " is a set of convex bodies: bound-verify cover decides whether it "
                      "covers the original");
    if (out.is_set) {
      out.mesh = verify::sum_of(out.set);
      out.sha256 = io::sha256(details.bytes);
      out.unit = details.unit;
      out.notes = std::move(details.notes);
      return out;
    }
    out.set = {};
  }
  static_cast<MeshInput&>(out) = read(o.approximation, *format);
  return out;
}

void prepare(MeshInput& original, verify::Relation relation, bool drop_sheets) {
  verify::Subject subject =
      verify::prepared_subject(original.mesh, options_of(original, drop_sheets));
  if (!subject.refusal.empty() && relation == verify::Relation::Inner)
    throw Error(ErrorCode::InvalidInput, subject.refusal);
  if (relation == verify::Relation::Cover && (subject.has_more || !subject.refusal.empty()))
    original.measured = verify::measured_mesh(subject, original.mesh);
  original.mesh = std::move(subject.mesh);
  original.filled_triangles = subject.filled_triangles;
  original.dropped_sheets = subject.report.dropped_sheets;
  original.notes.insert(original.notes.end(), subject.report.notes.begin(),
                        subject.report.notes.end());
  if (!subject.refusal.empty())
    original.notes.push_back("every triangle is judged as it is, for which solid they bound " +
                             ("cannot be told (" + subject.refusal) + ")");
  original.subject = std::move(subject);
}

std::string change_by_preparing(const MeshInput& original) {
  for (const bool drop_sheets : {false, true}) {
    geom::PreparationReport prepared;
    try {
      prepared = geom::prepare(original.mesh, options_of(original, drop_sheets)).report;
    } catch (const Error&) {  // it cannot be prepared
      continue;
    }
    std::string text = drop_sheets ? "with --drop-sheets" : "";
    for (const std::string& note : prepared.notes) text += (text.empty() ? "" : "; ") + note;
    if (!original.quads.empty())
      text += std::string(text.empty() ? "" : "; ") +
              "it chooses which diagonal splits quads that are not plane";
    return text;
  }
  return {};
}

geom::Prepared prepare_original(const geom::Mesh& mesh, bool drop_sheets, bool fill) {
  geom::PrepareOptions options;
  options.drop_sheets = drop_sheets;
  options.holes = fill ? geom::Holes::Fill : geom::Holes::Keep;
  return geom::prepare(mesh, options);
}

}  // namespace kaboum::tools
