// Command lines of jobs, and what their ends mean.

#include "command.h"

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>

namespace kaboum::batch {
namespace {

/// With all `{name}` replaced.
std::string filled(std::string word, const std::string& name, const std::string& value) {
  for (std::size_t at = word.find(name); at != std::string::npos;
       at = word.find(name, at + value.size()))
    word.replace(at, name.size(), value);
  return word;
}

/// Names that end with a null character each, as programs write them into NAME.list.
std::vector<std::string> files_in_list(const fs::path& list) {
  std::error_code error;
  if (!fs::exists(list, error)) return {};
  const std::vector<char> text = io::read_file(list);
  std::vector<std::string> names;
  for (auto at = text.begin(); at != text.end();) {
    const auto end = std::find(at, text.end(), '\0');
    names.emplace_back(at, end);
    at = end == text.end() ? end : end + 1;
  }
  return names;
}

}  // namespace

fs::path result_in(const fs::path& scratch, const Job& job) {
  return scratch / fs::path(job.output).filename();
}

std::vector<std::string> command_of(const Job& job, const fs::path& folder, const fs::path& scratch,
                                    const fs::path& programs) {
  // A robot's URDF refers to files by their places, so that it is made where it will be.
  const fs::path made = job.makes_folder() ? folder / job.output : result_in(scratch, job);
  if (job.makes_folder()) fs::create_directories(made.parent_path());
  const std::array<std::pair<const char*, std::string>, 4> values{
      {{"{input}", job.input.string()},
       {"{output}", made.string()},
       {"{report}", (scratch / kReport).string()},
       {"{name}", job.name}}};
  std::vector<std::string> command;
  bool explicit_input = false;
  for (std::string word : job.command) {
    explicit_input = explicit_input || word.find("{input}") != std::string::npos;
    for (const auto& [name, value] : values) word = filled(std::move(word), name, value);
    command.push_back(std::move(word));
  }
  command.front() = find_program(command.front(), programs);
  if (explicit_input) return command;
  command.insert(command.begin() + 1, {job.input.string(), "-o", made.string(), "--report",
                                       (scratch / kReport).string(), "--threads", "1"});
  command.insert(command.end(), {"--depfile", (scratch / kSources).string()});
  return command;
}

std::string parameters_of(const Job& job) {
  std::string text;
  for (const std::string& word : job.command) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::string state_of(const Ended& ended, bool late, const std::string& last_words) {
  if (late) return "timeout";
  if (ended.exit_code == 0) return "done";
  if (ended.exit_code == 1) return "no";
  const bool memory = ended.signal == SIGKILL || last_words.ends_with("out of memory");
  return memory ? "memory" : "failed";
}

std::string reason_of(const Ended& ended, bool late, const std::string& last_words) {
  if (late) return "ended at the time limit";
  const std::string words = last_words.empty() ? "" : "; " + last_words;
  if (ended.signal != 0)
    return std::string("ended by a signal: ") + strsignal(ended.signal) + words;
  return last_words.empty() ? "exit code " + std::to_string(ended.exit_code) : last_words;
}

std::vector<FileState> sources_in(const fs::path& scratch, const Job& job, std::int64_t since) {
  std::vector<FileState> sources;
  for (const std::string& name : files_in_list(scratch / kSources)) {
    if (name == job.input.string()) continue;
    sources.push_back(file_state(name));
    if (sources.back().changed >= since) sources.back().modified = -1;
  }
  return sources;
}

void add_report_in(const fs::path& scratch, Record& record) {
  std::error_code error;
  const fs::path file = scratch / kReport;
  if (!fs::exists(file, error)) return;
  try {
    const std::vector<char> bytes = io::read_file(file);
    const Json report = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
    if (report.is_object()) add_report(record, report);
  } catch (const Error&) {  // NOLINT(bugprone-empty-catch): figures are then not known
  }
}

}  // namespace kaboum::batch
