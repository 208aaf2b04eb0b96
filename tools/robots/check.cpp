// Verdicts on robots as exit codes, reports and commands.

#include "check.h"

#include <algorithm>
#include <string_view>

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
      break;
  }
  return kNo;
}

Json report_of(const certify::LinkVerdict& link) {
  return {{"verdict", name_of(link.outcome)}, {"sentence", link.sentence}};
}

void say_verdicts(const robot::Robot& robot, const std::vector<certify::LinkVerdict>& verdicts,
                  bool quiet) {
  for (const certify::LinkVerdict& link : verdicts)
    if (link.outcome != Outcome::Held)
      log(quiet, "link '" + robot.links[link.link].name + "': " + link.sentence);
  log(quiet, in_words(verdicts));
}

RobotCheck check_of(const std::string& original, const std::string& result,
                    const RobotOptions& options, const certify::PreparationOptions& preparation,
                    const std::optional<Length>& epsilon,
                    const std::vector<certify::LinkVerdict>& verdicts) {
  const auto file = [](const std::string& path) {
    return shell_word(path.starts_with('-') ? "./" + path : path);
  };
  RobotCheck out;
  out.passes = std::ranges::all_of(
      verdicts, [](const auto& link) { return link.outcome < Outcome::Undecided; });
  out.command = "bound-verify robot " + file(original) + " " + file(result);
  using Mode = certify::PreparationOptions::Mode;
  if (preparation.mode == Mode::Wrap)
    out.command += " --prepare=wrap";
  else if (preparation.mode != Mode::Off)
    out.command += " --prepare";
  // What is claimed then is about the triangles that stand for exact faces.
  if (!preparation.holds_exact_faces()) out.command += " --exact-points 0";
  if (options.shapes.visual) out.command += " --visual";
  if (preparation.drop_sheets) out.command += " --drop-sheets";
  if (!options.shapes.links.empty()) {
    std::string links;
    for (const std::string& link : options.shapes.links) links += (links.empty() ? "" : ",") + link;
    out.command += " --links " + shell_word(links);
  }
  for (const std::string& folder : options.shapes.packages)
    out.command += " --package-path " + shell_word(folder);
  if (epsilon) out.command += " --epsilon " + shell_word(epsilon->text());
  return out;
}

}  // namespace kaboum::tools
