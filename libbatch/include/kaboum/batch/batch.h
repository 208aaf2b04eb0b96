#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// Batches: a program for each of many files, at the same time, with limits of time and memory, a
/// journal by which they are resumed, and a summary. docs/pipelines.md.
namespace kaboum::batch {

namespace fs = std::filesystem;

/// Files whose names match the pattern are given to a command.
struct Rule {
  std::string pattern;               ///< as fnmatch(3); `*` also matches slashes
  std::vector<std::string> command;  ///< program and options
};

/// "PATTERN: PROGRAM OPTIONS"; words as in a shell, with ' and ".
/// @throws Error{InvalidArgument}
Rule parse_rule(const std::string& text);
/// A rule for each line; `#` begins a comment. @throws Error naming file and line
std::vector<Rule> read_rules(const std::string& file);

/// One of the parts that a batch is divided into for several machines. A file belongs to the same
/// part whatever other files there are, so that machines need not see them at the same time.
struct Shard {
  std::size_t number = 1;  ///< from 1
  std::size_t count = 1;

  /// True of a file of this part, which its name's hash decides.
  [[nodiscard]] bool has(const std::string& name) const;
};

/// "2/8". @throws Error{InvalidArgument}
Shard parse_shard(const std::string& text);

/// A file as it was at a moment; all but the path 0 where there is none.
struct FileState {
  fs::path path;  ///< absolute
  std::uintmax_t bytes = 0;
  std::int64_t modified = 0;  ///< [ns]
  std::int64_t changed = 0;   ///< [ns] which, unlike `modified`, nobody can set

  bool operator==(const FileState&) const = default;
};

/// Record of a job that was done, or not.
struct Record {
  std::string name, key, output;
  std::string sha256;              ///< of the result, of a folder of its files'; empty: none
  std::vector<FileState> sources;  ///< other files that it depends on, as they were
  /// "done"; "no": a result with a shortfall, or a valid "no"; "failed"; "timeout"; "memory".
  std::string state;
  int exit_code = -1;  ///< -1: ended by a signal
  std::string reason;  ///< what the program said last, where it is not done
  std::uintmax_t input_bytes = 0, output_bytes = 0;
  double wall_seconds = 0, cpu_seconds = 0, peak_megabytes = 0;
  // From the program's report; none where it does not say.
  std::optional<std::uint64_t> vertices_before, vertices_after, bodies;
  std::optional<double> ratio;     ///< of the vertices
  std::optional<double> distance;  ///< certified bound, both ways or of the set [length]
  std::optional<double> diagonal;  ///< of the input [length]
  std::string verdict, parameters, picture;

  [[nodiscard]] bool done() const { return state == "done"; }
  [[nodiscard]] bool has_result() const { return !sha256.empty(); }
};

/// Request for a batch: files, and what is done with each.
struct BatchRequest {
  std::vector<std::string> inputs;  ///< folders, lists of files (.txt, a line each) and files
  /// The first whose pattern matches a file counts; commands without `{input}` get what KABouM's
  /// programs take.
  std::vector<Rule> rules;
  fs::path folder;                  ///< of results, journal and summaries
  std::string extension;            ///< of results; empty: by program
  std::optional<Shard> shard = {};  ///< only the files of this part; no summary is written
  bool only_summary = false;        ///< nothing is worked on
  bool retry = false;               ///< what was not done for a reason is done again
  std::size_t jobs = 0;             ///< at a time; 0: one per core
  /// Memory of all programs at a time, as earlier ones needed; 0: no limit. [bytes]
  std::uintmax_t memory = free_memory();
  std::uintmax_t most_memory = 0;  ///< of one, of address space; 0: no limit [bytes]
  double timeout = 0;              ///< of one; 0: none [s]
  bool pictures = true;            ///< of results, for the summary
  /// Folder that programs are looked for in first, then on PATH; empty: that of this process's
  /// program.
  fs::path programs = {};
  std::function<void(const std::string& text)> note = {};      ///< what a user should know
  std::function<void(const std::string& text)> progress = {};  ///< often; may throw, as `stop`
  /// Often asked; true: what runs is ended, and is to be done again.
  std::function<bool()> stop = {};

  /// Four fifths of what is free; 0 where that is not known. [bytes]
  static std::uintmax_t free_memory();
};

/// Result of a batch.
struct BatchResult {
  std::vector<Record> records;  ///< in the order of their files' names
  std::size_t done_before = 0;  ///< by earlier runs
  std::size_t to_do = 0;        ///< files without a record
  bool stopped = false;         ///< by BatchRequest::stop

  [[nodiscard]] std::size_t count(const char* state) const;
  /// All files are done.
  [[nodiscard]] bool complete() const { return to_do == 0 && count("done") == records.size(); }
  /// "1980 done, 20 failed".
  [[nodiscard]] std::string words() const;
  /// Counts and a row for each record, as in summary.json.
  [[nodiscard]] std::string json() const;
};

/// Starts a process for each file that is not done yet, the largest first, and writes down what
/// becomes of it; then the summaries (summary.html, .csv, .json). Called again after anything, it
/// goes on. Programs end with the thread that called this.
/// @throws Error{InvalidInput} when a list or folder cannot be read, or nothing matches;
///   Error{InvalidArgument} when a file lies where results are written; Error{OutputFailed}
BatchResult run_batch(const BatchRequest& request);

}  // namespace kaboum::batch
