// Verdicts on robots as exit codes, reports and commands.

#include "check.h"

#include <kaboum/robot/robot_file.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace kaboum::tools {

using certify::Outcome;

int exit_code(Outcome outcome) {
  switch (outcome) {
    case Outcome::Held:
      return kDone;
    case Outcome::Late:
    case Outcome::Undecided:
      return kLimit;
    case Outcome::Far:
    case Outcome::Outside:
    case Outcome::Kept:
    case Outcome::Missing:
      break;
  }
  return kNo;
}

Json report_of(const certify::LinkVerdict& link) {
  return {{"verdict", name_of(link.outcome)}, {"sentence", link.sentence}};
}

void say_verdicts(const robot::Robot& robot, const std::vector<certify::LinkVerdict>& verdicts,
                  bool quiet) {
  std::vector<std::pair<std::string, std::vector<std::string>>> said;  // sentence, links
  for (const certify::LinkVerdict& link : verdicts) {
    if (link.outcome == Outcome::Held) continue;
    auto at = std::ranges::find(said, link.sentence, [](const auto& one) { return one.first; });
    if (at == said.end()) at = said.insert(at, {link.sentence, {}});
    at->second.push_back(robot.links[link.link].name);
  }
  std::vector<std::string> others;
  for (std::size_t i = 0; i < said.size(); ++i) {
    const auto& [sentence, links] = said[i];
    if (i < kLinesOfVerdicts)
      log(quiet,
          (links.size() == 1 ? "link " : "links ") + robot::names_of(links) + ": " + sentence);
    else
      others.insert(others.end(), links.begin(), links.end());
  }
  if (!others.empty())
    log(quiet, "links " + robot::names_of(others) + ": not held as asked for either");
  log(quiet, in_words(verdicts));
}

std::string reading_words(const RobotOptions& options) {
  std::string out;
  if (options.shapes.visual) out += " --visual";
  if (options.shapes.skip_missing) out += " --missing-meshes skip";
  if (!options.shapes.links.empty()) {
    std::string links;
    for (const std::string& link : options.shapes.links) links += (links.empty() ? "" : ",") + link;
    out += " --links " + shell_word(links);
  }
  if (!options.xacro_arguments.empty()) out += " --xacro-args";
  for (const std::string& argument : options.xacro_arguments) out += " " + shell_word(argument);
  for (const std::string& folder : options.shapes.packages)
    out += " --package-path " + shell_word(folder);
  return out;
}

RobotCheck check_of(const std::string& original, const std::string& result,
                    const RobotOptions& options, const certify::PreparationOptions& preparation,
                    const std::optional<Length>& epsilon, const std::optional<std::string>& map,
                    const std::vector<certify::LinkVerdict>& verdicts) {
  RobotCheck out;
  out.passes = std::ranges::all_of(
      verdicts, [](const auto& link) { return link.outcome < Outcome::Undecided; });
  out.command = "bound-verify robot " + shell_file(original) + " " + shell_file(result);
  using Mode = certify::PreparationOptions::Mode;
  if (preparation.mode == Mode::Wrap)
    out.command += " --prepare=wrap";
  else if (preparation.mode != Mode::Off)
    out.command += " --prepare";
  // What is claimed then is about the triangles that stand for exact faces.
  if (!preparation.holds_exact_faces()) out.command += " --exact-points 0";
  if (preparation.drop_sheets) out.command += " --drop-sheets";
  out.command += reading_words(options);
  if (epsilon) out.command += " --epsilon " + shell_word(epsilon->text());
  if (map) out.command += " --epsilon-map " + shell_word(*map);
  return out;
}

}  // namespace kaboum::tools
