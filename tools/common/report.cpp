// What all reports have in common.

#include "report.h"

#include <kaboum/io/mesh_io.h>

#include <sys/resource.h>

#include "cli.h"

namespace kaboum::tools {

Json to_json(const geom::TopologyReport& t) {
  return {{"vertices", t.vertices},
          {"triangles", t.triangles},
          {"edges", t.edges},
          {"components", t.components},
          {"closed", t.closed()},
          {"manifold", t.manifold()},
          {"open_edges", t.open_edges},
          {"nonmanifold_edges", t.nonmanifold_edges},
          {"inconsistent_edges", t.inconsistent_edges},
          {"unbalanced_edges", t.unbalanced_edges},
          {"nonmanifold_vertices", t.nonmanifold_vertices},
          {"degenerate_triangles", t.degenerate_triangles},
          {"duplicate_triangles", t.duplicate_triangles}};
}

Json to_json(const geom::DirectedDistance& d, double diagonal) {
  return {{"max_lower", d.max_lower},
          {"max_upper", d.max_upper},
          {"max_upper_percent", diagonal > 0 ? 100 * d.max_upper / diagonal : 0.0},
          {"at", {d.at.x(), d.at.y(), d.at.z()}}};
}

double user_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void write_report(const CommonOptions& options, const char* tool, const Json& body) {
  if (options.report.empty()) return;
  Json report{{"schema", 1}, {"tool", tool}, {"version", version()}};
  report.update(body);
  report["resources"]["user_seconds"] = user_seconds();
  report["resources"]["peak_megabytes"] = peak_megabytes();
  io::write_file(options.report, report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace kaboum::tools
