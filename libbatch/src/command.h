#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "process.h"
#include "record.h"

namespace kaboum::batch {

// Names in a job's scratch folder.
inline constexpr const char* kMessages = "messages.txt";
inline constexpr const char* kReport = "report.json";
inline constexpr const char* kPicture = "picture.png";
inline constexpr const char* kSources = "sources.list";

/// Where the program writes its result, which is moved when it is whole.
fs::path result_in(const fs::path& scratch, const Job& job);

/// What is run. `{input}`, `{output}`, `{report}` and `{name}` stand for files; a command without
/// `{input}` gets what KABouM's programs take: INPUT -o OUTPUT --report REPORT --depfile SOURCES
/// --threads 1.
/// @param programs  BatchRequest::programs
std::vector<std::string> command_of(const Job& job, const fs::path& folder, const fs::path& scratch,
                                    const fs::path& programs);

/// The options, in one line.
std::string parameters_of(const Job& job);

/// "done", "no", "failed", "timeout" or "memory". @param late  ended at the time limit
std::string state_of(const Ended& ended, bool late, const std::string& last_words);
std::string reason_of(const Ended& ended, bool late, const std::string& last_words);

/// Files that the result depends on beside the input, as the program says: a robot's meshes, what
/// xacro or a scene includes. One that changed while the program ran, so that it is not known which
/// was read, is given no time, and differs at the next look.
/// @param since  when the program was started, by the file system's clock [ns]
std::vector<FileState> sources_in(const fs::path& scratch, const Job& job, std::int64_t since);

/// Adds what the program's report says, where there is one.
void add_report_in(const fs::path& scratch, Record& record);

}  // namespace kaboum::batch
