#pragma once

#include <kaboum/batch/batch.h>

#include <string>
#include <vector>

/// Files that a batch is about, and what is made of each.
namespace kaboum::batch {

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

/// A job for each input that matches a rule, in the order of their names. Of folders all that is in
/// them and can be read, a robot's meshes as well, but not xacro, which may be parts of robots, nor
/// the results of batches; of lists (.txt) a file for each line, relative to the list. A part may
/// have no job.
/// @throws Error{InvalidInput} when a list or folder cannot be read, or nothing matches;
///   Error{InvalidArgument} when a file lies where the results are written.
std::vector<Job> find_jobs(const BatchRequest& request);

}  // namespace kaboum::batch
