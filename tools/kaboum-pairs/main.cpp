// kaboum-pairs: which links of a robot can touch each other, decided by exact meshes.

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/path_file.h>
#include <kaboum/robot/robot_file.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>
#include <iterator>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "common/shell_word.h"
#include "judgement.h"
#include "options.h"
#include "results.h"
#include "surfaces.h"

namespace {

using namespace kaboum;  // the tool's own names are few
using tools::PairsOptions;

/// Of a robot of which no two links have shapes that are looked at.
[[noreturn]] void refuse_no_pair(const robot::RobotFile& file, const PairsOptions& o) {
  // Whether shapes of the other kind, or those of all links, would be two.
  const auto two = [&](bool visual, bool all_links) {
    return std::ranges::count_if(file.robot.links, [&](const robot::Link& link) {
             const bool meant = all_links || o.choice.links.empty() ||
                                std::ranges::count(o.choice.links, link.name) > 0;
             return meant && !(visual ? link.visual : link.collision).empty();
           }) >= 2;
  };
  std::string hint;
  if (two(!o.choice.visual, false))
    hint = o.choice.visual ? "; --geometry collision takes those for collisions"
                           : "; --geometry visual takes shapes that are drawn";
  else if (!o.choice.links.empty() && two(o.choice.visual, true))
    hint = " among those of --links";
  throw Error(ErrorCode::InvalidInput,
              o.robot + ": there are no two links with shapes, so there is no pair" + hint);
}

/// Those of the links that a file states, first; all others then, where they are written.
std::vector<pairs::DecidedPair> decide_stated(const robot::RobotFile& file, const PairsOptions& o,
                                              const pairs::Matrix& matrix,
                                              const std::vector<pairs::LinkSurface>& surfaces,
                                              pairs::DecideOptions options) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> stated;
  for (const pairs::DisabledPair& pair : matrix.pairs)
    stated.insert(
        std::minmax(file.robot.find_link(pair.a).value(), file.robot.find_link(pair.b).value()));
  const auto begin = std::chrono::steady_clock::now();
  options.wanted = [&](std::uint32_t a, std::uint32_t b) { return stated.contains({a, b}); };
  const double most_seconds = options.most_seconds;
  if (!o.srdf.empty()) options.most_seconds *= 0.5;  // the others are of use, too
  std::vector<pairs::DecidedPair> out = pairs::decide_pairs(file.robot, surfaces, options);
  if (o.srdf.empty()) return out;
  options.wanted = [&](std::uint32_t a, std::uint32_t b) { return !stated.contains({a, b}); };
  options.most_seconds =
      most_seconds -
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (pairs::DecidedPair& pair : pairs::decide_pairs(file.robot, surfaces, options))
    out.push_back(std::move(pair));
  std::ranges::sort(out, {}, [](const auto& pair) { return std::pair(pair.a, pair.b); });
  return out;
}

/// @param notes  gets what a user should know, besides being printed
std::vector<pairs::LinkSurface> read_surfaces(const robot::RobotFile& file, const PairsOptions& o,
                                              std::vector<std::string>& notes) {
  notes = file.robot.notes;
  for (const std::string& note :
       robot::notes_on({{}, robot::bare_links(file.robot, o.choice.visual, o.choice.links).other},
                       o.choice.visual, ": nothing of this is looked at"))
    notes.push_back(note);
  std::vector<pairs::LinkSurface> surfaces =
      tools::naming(o.robot, [&] { return tools::surfaces_of(file, o.choice, notes); });
  for (const std::string& note : notes) tools::log(o.common.quiet, note);
  if (surfaces.size() < 2) refuse_no_pair(file, o);
  return surfaces;
}

/// @param matrix  null: all pairs are decided
/// @param q  the configuration that is meant; empty: all of them
std::vector<pairs::DecidedPair> decide(const robot::RobotFile& file, const PairsOptions& o,
                                       const std::vector<pairs::LinkSurface>& surfaces,
                                       const pairs::Matrix* matrix, const std::vector<double>& q) {
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
  if (!q.empty()) return pairs::decide_pairs_at(file.robot, q, surfaces, options);
  return matrix != nullptr ? decide_stated(file, o, *matrix, surfaces, options)
                           : pairs::decide_pairs(file.robot, surfaces, options);
}

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string out{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw Error(ErrorCode::InvalidInput, path + ": cannot be read");
  return out;
}

template <typename Text>
void write(const std::string& path, const Text& text) {
  if (path.empty()) return;
  const std::string written = text();
  io::write_file(path, {written.data(), written.size()});
}

void say_judgement(const tools::JudgedMatrix& judged) {
  for (const pairs::JudgedPair& pair : judged.pairs) {
    std::cout << tools::line_of(pair) << '\n';
    const std::string replay = tools::replay_of(judged, pair);
    if (!replay.empty()) std::cout << "  " << replay << '\n';
  }
  for (const pairs::MatrixFault& fault : judged.matrix.faults)
    std::cout << "line " << fault.line << ": " << fault.text << '\n';
}

/// The command that decides pairs of the same shapes of the robot.
std::string again(const PairsOptions& o) {
  std::string out = "kaboum-pairs " + tools::shell_file(o.robot);
  if (o.choice.visual) out += " --geometry visual";
  for (const std::string& folder : o.choice.packages)
    out += " --package-path " + tools::shell_word(folder);
  for (const std::string& argument : o.xacro_arguments)
    out += " --xacro-args " + tools::shell_word(argument);
  return out;
}

/// Decides pairs in one configuration.
int run_at(const robot::RobotFile& file, const PairsOptions& o) {
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<double> q = robot::parse_configuration(o.configuration, "--configuration",
                                                           file.robot, {.check_limits = false})
                                    .front();
  std::vector<std::string> notes;
  const std::vector<pairs::LinkSurface> surfaces = read_surfaces(file, o, notes);
  const std::vector<pairs::DecidedPair> pairs = decide(file, o, surfaces, nullptr, q);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const tools::Json report = {{"robot", {{"file", o.robot}, {"sha256", file.sha256}}},
                              {"notes", notes},
                              {"configuration", q},
                              {"pairs", tools::pairs_json(file.robot, pairs)}};
  if (o.json) {
    std::cout << report.dump(2, ' ', false, tools::Json::error_handler_t::replace) << '\n';
  } else if (!o.common.quiet) {
    for (const pairs::DecidedPair& pair : pairs)
      std::cout << tools::line_of(file.robot, pair, tools::Span::Configuration) << '\n';
  }
  tools::log(o.common.quiet, tools::summary_of(pairs, tools::Span::Configuration, seconds));
  if (!o.preview.empty())
    io::write_file(o.preview, tools::picture_of(file.robot, surfaces, q, pairs));
  tools::write_report(o.common, "kaboum-pairs", report);
  if (std::ranges::any_of(pairs, tools::is_contact)) return tools::kNo;
  return std::ranges::any_of(pairs, tools::is_unknown) ? tools::kLimit : tools::kDone;
}

int run(const PairsOptions& o) {
  tools::require_valid(o);
  tools::require_apart({{"--srdf", o.srdf},
                        {"--output", o.output},
                        {"--junit", o.junit},
                        {"--sarif", o.sarif},
                        {"--preview", o.preview},
                        {"--report", o.common.report}},
                       {o.robot, o.judge});
  const auto begin = std::chrono::steady_clock::now();
  const robot::RobotFile file =
      robot::read_robot(o.robot, robot::Motions::All, o.xacro_arguments, o.choice.packages);
  if (!o.configuration.empty()) return run_at(file, o);
  std::optional<pairs::Matrix> matrix;
  if (!o.judge.empty()) {
    matrix = pairs::parse_matrix(text_of(o.judge), o.judge, file.robot);
    pairs::require_own(*matrix, o.judge, file.robot);
  }
  std::vector<std::string> notes;
  const bool is_idle = matrix && matrix->pairs.empty();
  std::vector<pairs::DecidedPair> pairs;
  if (!is_idle || !o.srdf.empty()) {
    const std::vector<pairs::LinkSurface> surfaces = read_surfaces(file, o, notes);
    pairs = decide(file, o, surfaces, matrix ? &*matrix : nullptr, {});
  }
  if (is_idle) {
    notes.push_back(o.judge + " disables no pair of links: there is nothing to judge");
    tools::log(o.common.quiet, notes.back());
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  tools::Json report = {{"robot", {{"file", o.robot}, {"sha256", file.sha256}}},
                        {"notes", notes},
                        {"pairs", tools::pairs_json(file.robot, pairs)}};
  std::optional<tools::JudgedMatrix> judged;
  if (matrix) {
    judged = tools::JudgedMatrix{again(o), o.judge, std::move(*matrix), {}};
    judged->pairs = pairs::judge(judged->matrix, file.robot, pairs);
    report["matrix"] = tools::matrix_json(*judged);
  }
  if (o.json) {
    std::cout << report.dump(2, ' ', false, tools::Json::error_handler_t::replace) << '\n';
  } else if (o.common.quiet) {
    // Errors only, and files.
  } else if (judged) {
    say_judgement(*judged);
  } else {
    for (const pairs::DecidedPair& pair : pairs)
      std::cout << tools::line_of(file.robot, pair, tools::Span::Limits) << '\n';
  }
  tools::log(o.common.quiet, tools::summary_of(pairs, tools::Span::Limits, seconds));
  if (judged) tools::log(o.common.quiet, tools::summary_of(*judged));
  write(o.srdf, [&] { return tools::to_srdf(file.robot, pairs); });
  if (const std::string left = tools::left_out_of_srdf(file.robot, pairs);
      !o.srdf.empty() && !left.empty())
    tools::log(o.common.quiet, o.srdf + ": " + left);
  if (judged) {
    write(o.junit, [&] { return tools::to_junit(*judged, o.fail_on); });
    write(o.sarif, [&] { return tools::to_sarif(*judged, o.fail_on).dump(2) + "\n"; });
    write(o.output, [&] { return pairs::corrected(judged->matrix, judged->pairs, file.robot); });
  }
  tools::write_report(o.common, "kaboum-pairs", report);
  if (judged) {
    const bool open_pair = judged->count(pairs::Judgement::Open) > 0;
    return judged->fails(o.fail_on) ? tools::kNo : open_pair ? tools::kLimit : tools::kDone;
  }
  const bool open = std::ranges::any_of(
      pairs, [](const pairs::DecidedPair& pair) { return pair.verdict == pairs::Verdict::Open; });
  return open ? tools::kLimit : tools::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Decides which links of a robot can touch each other, by their exact meshes: never or "
      "always, "
      "proved over all of the joints' limits, or a configuration in which they do.",
      "kaboum-pairs");
  PairsOptions options;
  tools::describe(app, options);
  return tools::run(app, argc, argv, [&] {
    const tools::ThreadLimit threads(options.common.threads);
    return run(options);
  });
}
