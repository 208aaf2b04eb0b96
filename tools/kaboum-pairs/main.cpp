// kaboum-pairs: which links of a robot can touch each other, decided by exact meshes.

#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/robot_file.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <iostream>
#include <mutex>

#include "options.h"
#include "results.h"
#include "surfaces.h"

namespace {

using namespace kaboum;  // the tool's own names are few
using tools::PairsOptions;

std::vector<pairs::DecidedPair> decide(const robot::RobotFile& file, const PairsOptions& o) {
  std::vector<std::string> notes;
  const std::vector<pairs::LinkSurface> surfaces =
      tools::naming(o.robot, [&] { return tools::surfaces_of(file, o.choice, notes); });
  for (const std::string& note : notes) tools::log(o.common.quiet, note);
  if (surfaces.size() < 2)
    throw Error(ErrorCode::InvalidInput,
                o.robot + ": there are no two links with shapes, so there is no pair");
  tools::Progress progress(o.common.quiet);
  std::mutex one;
  std::chrono::steady_clock::time_point shown;
  pairs::DecideOptions options = o.decide;
  options.progress = [&](std::size_t decided, std::size_t all) {
    const std::unique_lock lock(one, std::try_to_lock);
    const auto now = std::chrono::steady_clock::now();
    if (!lock || now - shown < std::chrono::milliseconds(200)) return;
    shown = now;
    progress.show(std::to_string(decided) + " of " + std::to_string(all) + " pairs decided");
  };
  return pairs::decide_pairs(file.robot, surfaces, options);
}

int run(const PairsOptions& o) {
  tools::require_apart({{"--srdf", o.srdf}, {"--report", o.common.report}}, {o.robot});
  const auto begin = std::chrono::steady_clock::now();
  const robot::RobotFile file = robot::read_robot(o.robot);
  const std::vector<pairs::DecidedPair> pairs = decide(file, o);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const tools::Json report = {{"robot", {{"file", o.robot}, {"sha256", file.sha256}}},
                              {"pairs", tools::pairs_json(file.robot, pairs)}};
  if (o.json) {
    std::cout << report.dump(2, ' ', false, tools::Json::error_handler_t::replace) << '\n';
  } else if (!o.common.quiet) {
    for (const pairs::DecidedPair& pair : pairs)
      std::cout << tools::line_of(file.robot, pair) << '\n';
  }
  tools::log(o.common.quiet, tools::summary_of(pairs, seconds));
  if (!o.srdf.empty()) {
    const std::string text = tools::to_srdf(file.robot, pairs);
    io::write_file(o.srdf, {text.data(), text.size()});
  }
  tools::write_report(o.common, "kaboum-pairs", report);
  const bool open = std::ranges::any_of(pairs, [](const pairs::DecidedPair& pair) {
    return pair.verdict == pairs::Verdict::Open;
  });
  return open ? tools::kLimit : tools::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Decides which links of a robot can touch each other, by their exact meshes: never or always, "
      "proved over all of the joints' limits, or a configuration in which they do.",
      "kaboum-pairs");
  PairsOptions options;
  tools::describe(app, options);
  return tools::run(app, argc, argv, [&] {
    const tools::ThreadLimit threads(options.common.threads);
    return run(options);
  });
}
