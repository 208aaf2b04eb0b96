// Gives the triangles of a file a solid, or wraps them, and says what it changed where.
#include <kaboum/base/error.h>
#include <kaboum/certify/large_epsilon.h>
#include <kaboum/certify/mesh.h>
#include <kaboum/certify/mesh_bytes.h>
#include <kaboum/certify/preparation_options.h>
#include <kaboum/geom/float32.h>
#include <kaboum/io/file_unit.h>
#include <kaboum/verify/inclusion.h>

#include <CLI/CLI.hpp>
#include <set>

#include "common/cli.h"
#include "common/request_options.h"
#include "common/unit_option.h"
#include "repairs.h"

namespace kaboum::tools {
namespace {

struct PrepareToolOptions {
  std::string input, output, output_format, depfile;
  InputFormat input_format;
  bool verify = false;
  certify::PreparationOptions preparation;
  certify::WrapOptions wrap;     ///< its epsilon; offset and seal are those of preparation
  std::set<std::string> stated;  ///< names of the library's options that were stated
  UnitOption unit;
  CommonOptions common;

  [[nodiscard]] bool wraps() const {
    return preparation.mode == certify::PreparationOptions::Mode::Wrap;
  }
};

/// What was made of which file.
struct PrepareCase {
  PrepareToolOptions asked;  ///< its lengths in the unit of what is read
  io::ReadResult input = {};
  std::string sha256 = {};
  geom::Mesh mesh = {};  ///< that is written
  std::vector<std::string> notes = {};
  Json report = {};
  int code = kDone;
};

void note(PrepareCase& run, const std::string& text) {
  log(run.asked.common.quiet, "note: " + text);
  run.notes.push_back(text);
}

bool all_float32(const geom::Mesh& mesh) {
  for (const geom::Vec3& p : mesh.vertices)
    if (!geom::is_float32(p)) return false;
  return true;
}

/// Every triangle of the file lies in the solid: asked for, not promised, of what is not wrapped.
void verify_raw(PrepareCase& run) {
  Progress progress(run.asked.common.quiet);
  verify::InclusionOptions options;
  options.surface_only = true;
  options.progress = [&](const std::string& what) { progress.show("verifying: " + what); };
  const verify::Claim claim = verify::verify_inclusion(run.input.mesh, run.mesh, options).surface;
  run.report["every_triangle_inside"] = verify::name_of(claim.answer);
  if (claim.answer == verify::Answer::Verified) return;
  run.code = claim.answer == verify::Answer::Undecided ? kLimit : kNo;
  note(run,
       "that every triangle of the file lies in the solid is " +
           std::string(verify::name_of(claim.answer)) +
           (claim.inner_triangles.empty()
                ? ": " + claim.reason
                : ": not so of " + std::to_string(claim.inner_triangles.size()) + " triangles") +
           "; --prepare wrap holds all of them");
}

void prepare(PrepareCase& run) {
  const PrepareToolOptions& o = run.asked;
  const geom::Prepared prepared = naming(o.input, [&] {
    try {
      return certify::prepare_mesh(run.input.mesh, o.preparation.preparing());
    } catch (const Error& error) {
      throw Error(error.code(), std::string(error.what()) +
                                    "; --prepare wrap encloses whatever triangles there are");
    }
  });
  for (const std::string& text : prepared.report.notes) note(run, text);
  const std::vector<Repair> repairs = repairs_of(run.input, prepared);
  log(o.common.quiet, "changed: " + in_words(repairs));
  run.report["repairs"] = to_json(repairs);
  run.report["closed"] = prepared.solid.closed();
  run.mesh = prepared.solid.mesh();
  if (!prepared.solid.closed()) run.code = kNo;
  if (o.verify) verify_raw(run);
}

void wrap(PrepareCase& run, bool doubles) {
  const PrepareToolOptions& o = run.asked;
  certify::WrapRequest request;
  request.offset = o.preparation.offset;
  request.seal = o.preparation.seal;
  if (o.wrap.epsilon) {
    const double diagonal = geom::bounding_box(run.input.mesh).diagonal();
    if (const std::string text = certify::warning_of(*o.wrap.epsilon, diagonal); !text.empty())
      note(run, text);
    request.farthest = o.wrap.epsilon->of(diagonal);
  }
  request.clearance = run.input.deviation;
  request.quads = run.input.bent_quads;
  request.float32 = !doubles || all_float32(run.input.mesh);
  request.may_be_double = doubles;
  certify::CertifiedWrap made;
  {
    Progress progress(o.common.quiet);
    request.progress = [&](const std::string& stage) { progress.show(stage); };
    made = naming(o.input, [&] { return certify::certify_wrap(run.input.mesh, request); });
  }
  const certify::WrapCertificate& c = made.certificate();
  log(o.common.quiet, in_words(c));
  run.report["wrap"] = Json::parse(certify::to_json(c));
  run.report["repairs"] = Json::array({{{"kind", "triangles wrapped"},
                                        {"count", c.input_triangles},
                                        {"place", {c.at.x(), c.at.y(), c.at.z()}},
                                        {"size", c.farthest_upper}}});
  run.report["closed"] = true;
  run.report["every_triangle_inside"] = "verified";
  run.mesh = made.artefact();
}

/// Into the unit of what was read.
void bring_lengths(PrepareCase& run) {
  bring_lengths_into(run.input.unit, certify::preparation_options(certify::PreparedFor::Preparing),
                     run.asked.preparation);
  bring_lengths_into(run.input.unit, certify::wrap_options(), run.asked.wrap);
}

/// Reads the triangles, or makes them of a CAD file.
void read(PrepareCase& run) {
  const PrepareToolOptions& o = run.asked;
  std::vector<char> bytes;
  run.input = io::read_mesh(o.input, format_for(o.input, o.input_format), &bytes);
  apply(run.input, o.unit, o.input);
  if (io::is_cad(run.input.format)) run.report["deviation"] = run.input.deviation;
  run.sha256 = io::sha256(bytes);
  for (const std::string& text : run.input.notes) note(run, text);
}

int prepare_file(const CLI::App& app, const PrepareToolOptions& o) {
  const std::string mode = value_of(certify::preparation_options(certify::PreparedFor::Preparing),
                                    "prepare", o.preparation);
  require_none(certify::contradiction(o.preparation, o.stated));
  require_absent(app, "--prepare " + mode, {o.wraps() ? "--verify" : "--epsilon"});
  require_apart({{"--output", o.output}, {"--report", o.common.report}, {"--depfile", o.depfile}},
                {o.input});
  const io::Format format = format_for(o.output, o.output_format, "--output-format");
  const ThreadLimit threads(o.common.threads);
  PrepareCase run{.asked = o};
  read(run);
  naming(o.input, [&] { bring_lengths(run); });
  const bool doubles = io::holds_double(format);
  if (o.wraps()) {
    wrap(run, doubles);
  } else {
    prepare(run);
  }
  const std::vector<char> written =
      certify::serialise_checked(run.mesh, format, doubles && !all_float32(run.mesh),
                                 std::string("mesh-prepare ") + version() + o.unit.words());
  Json report{{"input", {{"file", o.input}, {"sha256", run.sha256}}},
              {"prepare", mode},
              {"unit", run.input.unit},
              {"scale", o.unit.scale}};
  report.update(run.report);
  report["output"] = {{"file", o.output},
                      {"vertices", run.mesh.vertices.size()},
                      {"triangles", run.mesh.triangles.size()}};
  report["notes"] = run.notes;
  write_report(o.common, "mesh-prepare", report);
  if (!o.depfile.empty()) {
    std::vector<std::string> inputs{o.input};
    inputs.insert(inputs.end(), run.input.other_files.begin(), run.input.other_files.end());
    write_depfile(o.depfile, {o.output}, inputs);
  }
  io::write_file(o.output, written);
  return run.code;
}

void describe(CLI::App& app, PrepareToolOptions& o) {
  app.add_option("INPUT", o.input, "Triangles (- for stdin)")->required()->type_name("FILE");
  app.add_option("-o,--output", o.output, "Where the prepared mesh goes (- for stdout)")
      ->required()
      ->type_name("FILE");
  add_request_options(app, certify::preparation_options(certify::PreparedFor::Preparing),
                      o.preparation, o.stated);
  add_request_options(app, options_named(certify::wrap_options(), {"epsilon"}), o.wrap, o.stated);
  app.add_flag("--verify", o.verify,
               "Decide exactly whether every triangle of the file lies in the solid (a wrap's "
               "always do, decided in any case)");
  add_unit_options(app, o.unit, "INPUT");
  app.add_option(
         "--depfile", o.depfile,
         "Write a Makefile dependency rule; names that have no place in one are refused. If "
         "FILE ends in .list: the inputs, each followed by a zero byte")
      ->type_name("FILE");
  add_input_format(app, o.input_format, "Format of INPUT [by extension]");
  app.add_option("--output-format", o.output_format, "Format of the result [by extension]")
      ->type_name("NAME");
  add_common_options(app, o.common);
  app.footer(
      "Exit codes: 0 done; 1 the mesh is open and --prepare off leaves it so, or --verify found "
      "triangles that stick out (the result is written); 2 usage; 3 bad input, or no solid can be "
      "given; 4 output failed; 5 feature not built; 6 internal error; 7 limit reached.");
}

}  // namespace
}  // namespace kaboum::tools

int main(int argc, char** argv) {
  using namespace kaboum;
  CLI::App app{
      "Gives the triangles of a file a solid: repairs them, or wraps a closed mesh round them.",
      "mesh-prepare"};
  tools::PrepareToolOptions options;
  tools::describe(app, options);
  return tools::run(app, argc, argv, [&] { return tools::prepare_file(app, options); });
}
