#pragma once

#include <kaboum/base/error.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "arguments.h"
#include "files.h"
#include "report.h"

namespace CLI {
class App;
}  // namespace CLI

/// What the command-line tools share: exit codes, common options, progress.
namespace kaboum::tools {

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
  kNotInferred = 8,
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
  bool quiet = false;
};
void add_common_options(CLI::App& app, CommonOptions& options);

/// Adds --xacro-args, of tools that read a robot.
void add_xacro_arguments(CLI::App& app, std::vector<std::string>& arguments);

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

}  // namespace kaboum::tools
