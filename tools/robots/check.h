#pragma once

#include <kaboum/certify/link_verdict.h>
#include <kaboum/certify/preparation_options.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/shell_word.h"
#include "options.h"

/// What is said with the verdict on a robot that was made: exit code, report, and the command that
/// checks it from its files alone.
namespace kaboum::tools {

/// docs/exit-codes.md
int exit_code(certify::Outcome outcome);

/// Of a link, in reports.
Json report_of(const certify::LinkVerdict& link);

/// So many sentences about links are printed.
inline constexpr std::size_t kLinesOfVerdicts = 12;

/// One line for all links of which the same is to be said because they are not held as asked for,
/// some names of those for which there are too many lines, and one line for all.
void say_verdicts(const robot::Robot& robot, const std::vector<certify::LinkVerdict>& verdicts,
                  bool quiet);

/// The command that decides it from the files alone, and what to expect of it.
struct RobotCheck {
  std::string command;
  /// The exit code: 0 where every link is held; 1 where one is not.
  bool passes = true;
};

/// The options by which another program reads the same shapes of the same links; each after a
/// blank.
std::string reading_words(const RobotOptions& options);

/// @param original, result  URDFs
/// @param epsilon  that is to be decided as well
/// @param map      file of regions that are; nullopt: none
RobotCheck check_of(const std::string& original, const std::string& result,
                    const RobotOptions& options, const certify::PreparationOptions& preparation,
                    const std::optional<Length>& epsilon, const std::optional<std::string>& map,
                    const std::vector<certify::LinkVerdict>& verdicts);

}  // namespace kaboum::tools
