// The program bcd-decompose: options, certify::certify_set or certify_robot, files.

#include <kaboum/io/convex_io.h>

#include <CLI/CLI.hpp>

#include "common/set_format.h"
#include "options.h"
#include "picture.h"
#include "preview.h"
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
  const io::Format format = format_for(o.input, o.input_format, "--input-format");
  return certify::certify_file(o.input, format, certify::request_of(o.set),
                               o.no_cache ? nullptr : &cache, hooks);
}

int decompose_mesh(const DecomposeOptions& o) {
  const io::SetFormat format = set_format_for(o.output, o.output_format);
  if (format == io::SetFormat::Directory) io::require_replaceable(o.output);
  const certify::CertifiedFile made = certify_mesh(o);
  const geom::ConvexSet& set = made.found.set.artefact();
  const certify::SetCertificate& certificate = made.found.set.certificate();
  log(o.common.quiet, summary(certificate) + (made.found.cached ? " (from the cache)" : ""));
  const std::string why = shortfall(certificate);
  if (!why.empty()) log(o.common.quiet, why);
  if (is_page(o.preview))
    io::write_file(o.preview, page_of_set(o, certificate, set));
  else if (!o.preview.empty())
    io::write_file(o.preview, picture_of(set, o.explode));
  if (!o.common.report.empty()) {
    Json report = report_of(made);
    report["input"] = {{"file", o.input}, {"sha256", made.sha256}};
    report["parameters"] = set.provenance.parameters;
    write_report(o.common, "bcd-decompose", report);
  }
  if (!o.depfile.empty()) {
    std::vector<std::string> inputs{o.input};
    inputs.insert(inputs.end(), made.other_files.begin(), made.other_files.end());
    write_depfile(o.depfile, {o.output}, inputs);
  }
  if (format == io::SetFormat::Glb) {
    io::write_file(o.output, made.found.set.bytes());
  } else {
    io::write_convex_set(o.output, set, format);
  }
  return code_of(certificate);
}

int decompose(const CLI::App& app, DecomposeOptions& o) {
  require_meaning(app, o);
  apply_preset(app, o);
  std::vector<std::string> inputs{o.input};
  if (!o.robot.epsilons.empty()) inputs.push_back(o.robot.epsilons);
  require_apart({{"--output", o.output},
                 {"--report", o.common.report},
                 {"--html-report", o.robot.html},
                 {"--preview", o.preview},
                 {"--depfile", o.depfile}},
                inputs);
  const ThreadLimit threads(o.common.threads);
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
