#pragma once

#include <kaboum/geom/directed_distance.h>
#include <kaboum/geom/topology.h>

#include <nlohmann/json.hpp>
#include <string>

/// Reports as JSON (docs/reports.md).
namespace kaboum::tools {

using Json = nlohmann::ordered_json;
struct CommonOptions;

Json to_json(const geom::TopologyReport& topology);
Json to_json(const geom::DirectedDistance& distance, double diagonal);

/// Seconds of user CPU time and peak memory of this process so far.
double user_seconds();
double peak_megabytes();

/// Writes the report asked for, if one is: `body` with what all reports have in common
/// (docs/reports.md).
void write_report(const CommonOptions& options, const char* tool, const Json& body);

}  // namespace kaboum::tools
