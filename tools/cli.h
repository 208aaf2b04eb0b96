#pragma once

#include <kaboum/base/error.h>
#include <kaboum/base/length.h>
#include <kaboum/geom/distance.h>
#include <kaboum/geom/topology.h>
#include <kaboum/io/mesh_io.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

/// What the command-line tools share: exit codes, common options, progress, reports.
namespace kaboum::tools {

using Json = nlohmann::ordered_json;

/// Exit codes; docs/exit-codes.md.
enum ExitCode {
  kDone = 0,
  kNo = 1,
  kUsage = 2,
  kBadInput = 3,
  kOutputFailed = 4,
  kNotBuilt = 5,
  kInternal = 6,
  kLimit = 7,
};

const char* version();

/// Parses the command line and runs `body`; prints errors on stderr and returns the exit code.
int run(CLI::App& app, int argc, char** argv, const std::function<int()>& body);

/// Refuses options that mean nothing beside `option`.
/// @throws Error{InvalidArgument}
void require_absent(const CLI::App& app, const std::string& option,
                    const std::vector<std::string>& others);

/// Options that every tool has.
struct CommonOptions {
  std::string report;
  int threads = 0;
  std::uint64_t seed = 1;
  bool quiet = false;
};
void add_common_options(CLI::App& app, CommonOptions& options);

/// Holds oneTBB to options.threads (0: all cores) while it lives.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

using kaboum::Length;

/// "0.005", "+0.005" or "0.5%"; nullopt unless it is a positive finite number.
std::optional<Length> parse_length(const std::string& text);

/// Refuses what is not a number from `low` to `high`, and says so.
CLI::Validator number_from(double low, double high);

/// Refuses names of pictures that are not .png: what is written is.
CLI::Validator png_name();

/// Units of length that a container may name.
CLI::Validator unit_name();

/// One line on stderr that is rewritten, if stderr is a terminal and not `quiet`; else nothing.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  void show(const std::string& text);

 private:
  bool active_;
  bool shown_ = false;
};

/// Prints a line on stderr unless `quiet`.
void log(bool quiet, const std::string& text);

/// Calls `work`; its errors name the file.
template <class Work>
auto naming(const std::string& file, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Error(error.code(), (file == "-" ? "standard input" : file) + ": " + error.what());
  }
}

/// Whether there is a folder of that name; false where that cannot be told.
bool is_folder(const std::filesystem::path& path);

/// Format named by --input-format/--output-format, else by the file name's extension.
/// @throws Error{InvalidArgument} when unknown.
io::Format format_for(const std::string& path, const std::string& name, const char* option);

Json to_json(const geom::TopologyReport& topology);
Json to_json(const geom::DirectedDistance& distance, double diagonal);

/// Seconds of user CPU time and peak memory of this process so far.
double user_seconds();
double peak_megabytes();

void write_json(const std::string& path, const Json& json);

/// Writes the report asked for, if one is: `body` with what all reports have in common
/// (docs/reports.md).
void write_report(const CommonOptions& options, const char* tool, const Json& body);

/// Refuses to write a file twice, over an input, or into a folder that does not exist or cannot be
/// looked into; outputs are
/// (option, file), empty files are none.
/// @throws Error{InvalidArgument}, Error{OutputFailed}
void require_apart(const std::vector<std::pair<std::string, std::string>>& outputs,
                   const std::vector<std::string>& inputs);

/// A Makefile rule saying that the targets (empty names are none) depend on `inputs`, each listed
/// once.
void write_depfile(const std::string& path, const std::vector<std::string>& targets,
                   const std::vector<std::string>& inputs);

}  // namespace kaboum::tools
