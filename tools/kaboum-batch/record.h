#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "job.h"

namespace kaboum::batch {

using Json = nlohmann::ordered_json;

/// What became of a job.
struct Record {
  std::string name, key, output;
  std::string sha256;              ///< of the result, as digest_of says; empty: there is none
  std::vector<FileState> sources;  ///< other files that it depends on, as they were
  /// "done"; "no": a result with a shortfall, or a valid "no"; "failed"; "timeout"; "memory".
  std::string state;
  int exit_code = -1;  ///< -1: ended by a signal
  std::string reason;  ///< what the program said last, where it is not done
  std::uintmax_t input_bytes = 0, output_bytes = 0;
  double wall_seconds = 0, cpu_seconds = 0, peak_megabytes = 0;
  // Of the program's report, where it has them.
  std::optional<std::uint64_t> vertices_before, vertices_after, bodies;
  std::optional<double> ratio;     ///< of the vertices
  std::optional<double> distance;  ///< certified bound, both ways or of the set [length]
  std::optional<double> diagonal;  ///< of the input [length]
  std::string verdict, parameters, picture;

  [[nodiscard]] bool done() const { return state == "done"; }
  [[nodiscard]] bool has_result() const { return !sha256.empty(); }
};

Json to_json(const Record& record);
/// nullopt: it is none, as of a line that was cut short.
std::optional<Record> record_from(const std::string& line);

/// Takes from a program's report what is known of it.
void add_report(Record& record, const Json& report);

}  // namespace kaboum::batch
