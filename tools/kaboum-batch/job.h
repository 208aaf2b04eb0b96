#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "shard.h"

/// kaboum-batch: one program for many files.
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

/// A file as it was at a moment; all but the path 0 where there is none.
struct FileState {
  fs::path path;  ///< absolute
  std::uintmax_t bytes = 0;
  std::int64_t modified = 0;  ///< [ns]
  std::int64_t changed = 0;   ///< [ns] which, unlike `modified`, nobody can set

  bool operator==(const FileState&) const = default;
};
FileState file_state(const fs::path& file);

/// A file, and what is made of it.
struct Job {
  std::string name;  ///< what the input is called below its folder
  fs::path input;
  std::string output;                ///< below the folder of results
  std::vector<std::string> command;  ///< of its rule
  FileState state = {};              ///< of the input

  /// Whether the result is a folder, as robots are.
  [[nodiscard]] bool makes_folder() const {
    return input.extension() == ".urdf" || input.extension() == ".xacro";
  }
  /// Whether the input's format is one whose files refer to others.
  [[nodiscard]] bool may_refer_to_others() const;
  /// Changes with the input, the options and the version. What else the result depends on is known
  /// when it has been made (Record::sources).
  [[nodiscard]] std::string key() const;
};

struct JobOptions {
  std::vector<std::string> inputs;  ///< folders, lists and files
  std::vector<Rule> rules;          ///< the first that matches counts
  std::string extension;            ///< of results; empty: by program
  fs::path results;                 ///< folder of the batch, whose files are no inputs
  std::optional<Shard> shard;       ///< only the jobs of this part
  std::function<void(const std::string& text)> note;  ///< what a user should know; may be empty
};

/// A job for each input that matches a rule, in the order of their names. Of folders all that is in
/// them and can be read, a robot's meshes as well, but not xacro, which may be parts of robots, nor
/// the results of batches; of lists (.txt) a file for each line, relative to the list. A part may
/// have no job.
/// @throws Error{InvalidInput} when a list or folder cannot be read, or nothing matches;
///   Error{InvalidArgument} when a file lies where the results are written.
std::vector<Job> find_jobs(const JobOptions& options);

}  // namespace kaboum::batch
