// The files that bmesh-decimate writes: results, log, progressive file, report and dependency rule.

#include <kaboum/bmesh/progressive.h>

#include "decimation_case.h"
#include "result_files.h"

namespace kaboum::tools {
namespace {

bmesh::Progressive progressive(const DecimationCase& run) {
  bmesh::Progressive p{run.log,
                       run.series().plan.precision == bmesh::Precision::Double,
                       run.original().solid.mesh(),
                       {}};
  for (const certify::CertifiedMesh& made : run.series().meshes) {
    const certify::MeshCertificate& c = made.certificate();
    p.levels.push_back({c.requested.value_or(c.vertices), c.vertices, c.steps});
  }
  return p;
}

void write_rule(const DecimationCase& run) {
  std::vector<std::string> targets = run.files;
  if (!run.asked.progressive.empty()) targets.push_back(run.asked.progressive);
  std::vector<std::string> inputs{run.asked.input};
  inputs.insert(inputs.end(), run.input.other_files.begin(), run.input.other_files.end());
  write_depfile(run.asked.depfile, targets, inputs);
}

}  // namespace

void require_separate_files(const DecimationOptions& asked, const std::vector<std::string>& files) {
  std::vector<std::pair<std::string, std::string>> outputs{{"--log", asked.log},
                                                           {"--progressive", asked.progressive},
                                                           {"--preview", asked.preview},
                                                           {"--report", asked.common.report},
                                                           {"--depfile", asked.depfile}};
  for (const std::string& file : files) outputs.emplace_back("--output", file);
  require_apart(outputs, {asked.input});
}

void write_files(const DecimationCase& run) {
  const DecimationOptions& o = run.asked;
  std::vector<std::pair<std::string, std::function<void()>>> files;
  files.emplace_back(o.log, [&] { io::write_file(o.log, bmesh::serialise_log(run.log)); });
  files.emplace_back(o.progressive, [&] {
    io::write_file(o.progressive, bmesh::serialise_progressive(progressive(run)));
  });
  files.emplace_back(o.preview, [&] { io::write_file(o.preview, page_of(run)); });
  files.emplace_back(o.common.report,
                     [&] { write_report(o.common, "bmesh-decimate", report_of(run)); });
  files.emplace_back(o.depfile, [&] { write_rule(run); });
  for (std::size_t i = 0; i < run.series().meshes.size(); ++i)
    files.emplace_back(run.files[i],
                       [&run, i] { io::write_file(run.files[i], run.series().meshes[i].bytes()); });
  write_together(files);
}

}  // namespace kaboum::tools
