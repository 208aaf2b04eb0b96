// `bound-verify mesh` and `cover`: reads two files, has the claims decided, says what was found.
#include "mesh.h"

#include <kaboum/base/error.h>
#include <kaboum/base/parse_length.h>
#include <kaboum/io/file_unit.h>
#include <kaboum/io/region_file.h>

#include <cmath>
#include <iostream>

#include "common/verdict.h"
#include "mesh_report.h"
#include "witness_file.h"

namespace kaboum::tools {
namespace {

using verify::Answer;

void require_possible(const VerifyMeshOptions& o, const CommonOptions& common) {
  require_apart({{"--report", common.report}, {"--witness", o.witness}},
                {o.original, o.approximation, o.epsilon_map.value_or(o.original)});
  require_witness_format(o.witness);
}

using Regions = std::vector<geom::RequestedRegion>;

/// Notes that lengths with a unit are brought into that of the set, where the original states none.
void note_unit(MeshCase& run, const Regions& regions) {
  const std::string& unit = run.approximation.unit;
  if (!run.original.unit.empty() || unit.empty()) return;
  std::vector<Length> lengths;
  if (run.asked.how.epsilon) lengths.push_back(*run.asked.how.epsilon);
  for (const geom::RequestedRegion& one : regions) lengths.push_back(one.epsilon);
  for (std::string& note :
       notes_on_unit(lengths, unit + ", which is that of " + run.asked.approximation))
    run.original.notes.push_back(std::move(note));
}

/// Reads both files, and says what is to be known of them.
MeshCase read(const VerifyMeshOptions& o, const Regions& regions, bool quiet) {
  MeshCase run{o, read_original(o), read_approximation(o), {}, 0, {}, {}};
  io::require_same_unit(o.original, run.original.unit, o.approximation, run.approximation.unit);
  note_unit(run, regions);
  if (const geom::Provenance& made = run.approximation.set.provenance;
      made.source_sha256 == run.original.sha256)
    io::require_recorded_scale(o.approximation, made.parameters, o.unit.scale);
  if (o.how.prepare)
    naming(o.original, [&] { prepare(run.original, o.relation, o.how.drop_sheets); });
  for (const std::string& note : run.original.notes) log(quiet, o.original + ": " + note);
  for (const std::string& note : run.approximation.notes) log(quiet, o.approximation + ": " + note);
  if (!o.how.prepare) run.inside_out = geom::find_inside_out(run.original.mesh);
  if (run.inside_out) log(false, "warning: " + o.original + ": " + text_of(*run.inside_out));
  run.diagonal = diagonal_of(run.original.mesh);
  return run;
}

/// Of both files: one may leave it out.
const std::string& unit_of(const MeshCase& run) {
  return run.original.unit.empty() ? run.approximation.unit : run.original.unit;
}

/// @throws Error where the length is none of this mesh's, or below a cover's margin.
void set_bound(MeshCase& run, const Length& epsilon) {
  const double bound = epsilon.of(run.diagonal),
               margin = run.inner() ? 0 : geom::margin_of(run.approximation.set).value_or(0);
  if (!std::isfinite(bound))
    throw Error(
        ErrorCode::InvalidInput,
        run.asked.original + ": its diagonal exceeds all numbers; give --epsilon as a length");
  if (!(bound > margin))
    throw Error(ErrorCode::InvalidArgument, "--epsilon: it must be larger than the set's margin, " +
                                                number(margin) + ", and than 0");
  run.bound = bound;
}

std::optional<verify::PointQuestion> points_of(const MeshCase& run) {
  const auto& exact = run.original.exact;
  if (!exact) return std::nullopt;
  return verify::PointQuestion{exact->points, exact->of_face, exact->rounding};
}

/// @throws Error where a length is none of this mesh's.
std::vector<geom::BoundedRegion> bounded(const MeshCase& run, Regions regions) {
  return naming(run.asked.original, [&] {
    for (geom::RequestedRegion& one : regions) one.epsilon = one.epsilon.in(unit_of(run));
    return geom::bounded(regions, run.diagonal);
  });
}

}  // namespace

int verify_mesh(const VerifyMeshOptions& o, const CommonOptions& common) {
  require_possible(o, common);
  const ThreadLimit threads(common.threads);
  if (o.original == "-" && o.approximation == "-")
    throw Error(ErrorCode::InvalidArgument, "only one of the two files can be standard input");
  Regions regions;
  if (o.epsilon_map) regions = io::read_regions(*o.epsilon_map);
  MeshCase run = read(o, regions, common.quiet);
  if (o.how.epsilon)
    set_bound(run, naming(o.original, [&] { return o.how.epsilon->in(unit_of(run)); }));

  Progress progress(common.quiet);
  std::ostream& out = common.report == "-" ? std::cerr : std::cout;
  const auto say = [&](const std::vector<std::string>& lines) {
    if (common.quiet) return;
    progress.show("");
    for (const std::string& line : lines) out << line << '\n';
    out.flush();
  };
  const verify::MeshQuestion question{run.original.mesh,
                                      run.approximation.mesh,
                                      run.approximation.is_set ? &run.approximation.set : nullptr,
                                      o.relation,
                                      o.how.claims,
                                      run.bound,
                                      o.how.max_contacts,
                                      o.how.max_work,
                                      [&](const std::string& what) { progress.show(what); },
                                      points_of(run),
                                      run.original.subject ? &*run.original.subject : nullptr,
                                      run.original.measured ? &*run.original.measured : nullptr,
                                      bounded(run, regions)};
  run.verdict = verify::decide(question, [&](const verify::MeshVerdict& enclosure) {
    run.verdict = enclosure;
    say(lines_of_enclosure(run));  // at once: a distance may take long
  });
  const Answer answer = run.verdict.answer;
  if (!o.witness.empty() && answer == Answer::Refuted)
    if (const geom::Mesh mesh = verify::offending_triangles(question, run.verdict);
        !mesh.triangles.empty())
      write_witness(o.witness, mesh, "triangles that bound what refutes the claim");
  if (!common.report.empty()) write_report(common, "bound-verify", report_of(run));
  say(lines_of_distances(run));
  if (answer != Answer::Verified && answer != Answer::Undecided && !o.how.prepare)
    if (const std::string change = change_by_preparing(run.original); !change.empty())
      log(common.quiet, "note: bmesh-decimate and bcd-decompose speak of " + o.original +
                            " as prepared; --prepare judges that: " + change);
  if (answer == Answer::Undefined) throw Error(ErrorCode::InvalidInput, why_undefined(run));
  if (!common.quiet) out << last_line(run) << '\n';
  for (const std::string& note : notes_on(run)) log(common.quiet, "note: " + note);
  return exit_code(answer);
}

}  // namespace kaboum::tools
