// The program bcd-decompose: options, certify::certify_set or certify_robot, files.

#include <kaboum/base/number_text.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/io/file_unit.h>
#include <kaboum/io/region_file.h>
#include <kaboum/page/set_page.h>
#include <kaboum/picture/bodies.h>
#include <kaboum/picture/png_file.h>
#include <kaboum/robot_folder/sphere_text.h>

#include <CLI/CLI.hpp>

#include "common/set_format.h"
#include "common/shell_word.h"
#include "options.h"
#include "robot.h"
#include "words.h"

namespace kaboum::tools {
namespace {

/// The set of one mesh, from the cache where possible.
certify::CertifiedFile certify_mesh(const DecomposeOptions& o) {
  Progress progress(o.common.quiet);
  const certify::Hooks hooks{
      [&](const std::string& stage) { progress.show(stage); },
      [&](const std::string& text) { log(o.common.quiet, o.input + ": " + text); }};
  const certify::SetCache cache(certify::SetCache::default_folder());
  const io::Format format = format_for(o.input, o.input_format);
  return certify::certify_file(o.input, format, certify::request_of(o.set),
                               o.no_cache ? nullptr : &cache, hooks);
}

/// The page, of the mesh that is read again.
std::string page_of(const DecomposeOptions& o, const certify::SetCertificate& certificate,
                    const geom::ConvexSet& set) {
  const certify::SetRequest request = certify::request_of(o.set);
  io::ReadResult read = io::read_mesh(o.input, format_for(o.input, o.input_format));
  io::scale(read, request.scale, o.input);
  return naming(o.input, [&] {
    return page::page_of_set({o.input, read.mesh, request.preparation}, certificate, set,
                             remedy_of_program);
  });
}

/// The command that decides it from the files alone; empty where one of them is a pipe.
std::string check_of(const DecomposeOptions& o, io::SetFormat format,
                     const certify::SetCertificate& c, const geom::ConvexSet& set) {
  if (o.input == "-" || o.output == "-") return {};
  const bool outer = c.direction == certify::SetRequest::Direction::Outer;
  std::string out = outer ? "bound-verify cover " : "bound-verify mesh --inner ";
  out += shell_file(o.input) + " " + shell_file(o.output);
  if (!outer && format == io::SetFormat::Obj) out += " --set";
  if (o.set.request.scale != 1) out += " --scale " + Length{o.set.request.scale}.text();
  if (!o.input_format.name.empty()) out += " --input-format " + o.input_format.name;
  if (!o.input_format.importer.empty()) out += " --importer " + o.input_format.importer;
  if (!o.output_format.empty() && format != io::SetFormat::Directory)
    out += " --approximation-format " + o.output_format;
  const certify::PreparationOptions& preparation = o.set.preparation;
  // A wrap holds triangles of which the solid need not be known.
  if (preparation.mode != certify::PreparationOptions::Mode::Off && !c.wrap) out += " --prepare";
  if (preparation.drop_sheets) out += " --drop-sheets";
  // What is claimed then is about the triangles that stand for exact faces.
  if (outer && !preparation.holds_exact_faces()) out += " --exact-points 0";
  // Depths left out are decided of spheres; of a wrap, distances are to it as well.
  const bool decides = outer ? !c.wrap : c.depth_decided;
  const std::optional<Length> wanted = o.set.request.wanted_epsilon();
  constexpr double kMore = 1.001;  // so that it is decided
  if (decides && outer && c.reached() && wanted)
    out += " --epsilon " + wanted->in(set.provenance.unit).text();
  else if (decides && c.distance_upper > 0)
    out += " --epsilon " +
           (outer ? number_up(kMore * c.distance_upper) : Length{c.distance_upper}.text());
  if (outer && decides && o.epsilon_map) out += " --epsilon-map " + shell_word(*o.epsilon_map);
  return out;
}

int decompose_mesh(const DecomposeOptions& o) {
  if (o.output_format.empty() && robot_folder::sphere_format_of(o.output))
    throw Error(ErrorCode::InvalidArgument,
                o.output +
                    ": such files hold the spheres of a robot's links; the bodies of a mesh "
                    "go into a .glb, an .obj or a folder");
  const io::SetFormat format = set_format_for(o.output, o.output_format);
  using Kind = certify::SetRequest::BodyKind;
  const Kind kind = o.set.request.body_kind;
  if (kind != Kind::Polytopes && kind != Kind::Boxes && format != io::SetFormat::Glb)
    throw Error(ErrorCode::InvalidArgument,
                "--bodies with radii: only .glb states radii; end --output in .glb, or state "
                "--output-format glb");
  if (format == io::SetFormat::Directory) io::require_replaceable(o.output);
  const certify::CertifiedFile made = certify_mesh(o);
  const geom::ConvexSet& set = made.found.set.artefact();
  const certify::SetCertificate& certificate = made.found.set.certificate();
  log(o.common.quiet,
      page::summary_of(certificate) + (made.found.cached ? " (from the cache)" : ""));
  const std::optional<Length> epsilon = o.set.request.wanted_epsilon();
  for (const certify::SetCertificate::Region& one : certificate.regions) {
    const bool is_idle = epsilon && epsilon->of(certificate.diagonal) <= one.epsilon;
    log(o.common.quiet,
        one.reached
            ? "distance in the region " + one.name + ": verified: nowhere more than " +
                  number_up(one.epsilon) +
                  (is_idle ? "; no less than outside of it, so that it changes nothing" : "")
            : "note: no body reaches the region " + one.name);
  }
  const std::string check = check_of(o, format, certificate, set);
  const std::string why = page::shortfall_of(certificate);
  if (!why.empty()) log(o.common.quiet, why);
  if (is_page(o.preview))
    io::write_file(o.preview, page_of(o, certificate, set));
  else if (!o.preview.empty())
    io::write_file(o.preview, picture::encode_png(picture::draw_bodies(set, o.explode)));
  if (!o.common.report.empty()) {
    Json report = report_of(made);
    report["input"] = {{"file", o.input}, {"sha256", made.sha256}};
    report["parameters"] = set.provenance.parameters;
    if (!check.empty()) report["check"] = check;
    write_report(o.common, "bcd-decompose", report);
  }
  if (!o.depfile.empty()) {
    std::vector<std::string> inputs{o.input};
    if (o.epsilon_map) inputs.push_back(*o.epsilon_map);
    inputs.insert(inputs.end(), made.other_files.begin(), made.other_files.end());
    write_depfile(o.depfile, {o.output}, inputs);
  }
  if (format == io::SetFormat::Glb) {
    io::write_file(o.output, made.found.set.bytes());
  } else {
    io::write_convex_set(o.output, set, format);
  }
  if (!check.empty()) log(o.common.quiet, "from the files alone: " + check);
  return code_of(certificate);
}

int decompose(const CLI::App& app, DecomposeOptions& o) {
  require_meaning(app, o);
  apply_preset(app, o);
  std::vector<std::string> inputs{o.input};
  if (!o.robot.epsilons.empty()) inputs.push_back(o.robot.epsilons);
  if (!o.repair.empty()) inputs.push_back(o.repair);
  if (!o.pairs.empty()) inputs.push_back(o.pairs);
  if (o.epsilon_map) inputs.push_back(*o.epsilon_map);
  require_apart({{"--output", o.output},
                 {"--report", o.common.report},
                 {"--html-report", o.robot.html},
                 {"--preview", o.preview},
                 {"--depfile", o.depfile}},
                inputs);
  if (o.epsilon_map && !is_robot(o.input)) o.set.request.regions = io::read_regions(*o.epsilon_map);
  const ThreadLimit threads(o.common.threads);
  if (is_robot(o.input) && o.robot_bodies + o.robot_vertices == 0) certify::be_of_robot(o.set);
  try {
    return is_robot(o.input) ? decompose_robot(o) : decompose_mesh(o);
  } catch (const certify::TooCoarse& error) {  // a valid "no"
    log(false, std::string(error.what()) + ". Nothing is written");
    return kNo;
  }
}

}  // namespace
}  // namespace kaboum::tools

int main(int argc, char** argv) {
  using namespace kaboum;
  CLI::App app{"Decomposes a solid into few convex bodies whose union provably contains it.",
               "bcd-decompose"};
  tools::DecomposeOptions options;
  tools::describe(app, options);
  return tools::run(app, argc, argv, [&] { return tools::decompose(app, options); });
}
