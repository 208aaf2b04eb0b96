// One program for many files, in parallel, resumable.

#include <kaboum/base/error.h>
#include <kaboum/batch/batch.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>

#include "common/cli.h"

namespace {

using namespace kaboum;  // the tool's own names are few
namespace fs = std::filesystem;

struct Options {
  std::vector<std::string> inputs, rules, command;
  std::string output, rules_file, extension, memory, most_memory, shard;
  std::size_t jobs = 0;
  double timeout = 0;
  bool retry = false, no_pictures = false, summary = false;
  tools::CommonOptions common;
};

void describe(CLI::App& app, Options& o) {
  app.add_option("INPUT", o.inputs,
                 "Folders (all meshes and robots in them but results of batches), lists of files "
                 "(.txt, a line each), or "
                 "files")
      ->required()
      ->type_name("DIR|LIST|FILE");
  app.add_option("-o,--output", o.output,
                 "Folder of results, summaries (summary.html, .csv, .json) and the journal that a "
                 "batch is resumed by")
      ->required()
      ->type_name("DIR");
  app.add_option("--command", o.command,
                 "Program and options for files that no rule matches; the last option: all that "
                 "follows belongs to it [bmesh-decimate --epsilon 1%]")
      ->type_name("PROGRAM OPTIONS...");
  app.add_option("--rule", o.rules,
                 "PATTERN: PROGRAM OPTIONS, as in '*.urdf: bcd-decompose --epsilon 1%'; the first "
                 "one that matches counts; repeatable. {input}, {output} and {report} stand for "
                 "files, for programs that are not KABouM's")
      ->allow_extra_args(false)
      ->type_name("RULE");
  app.add_option("--rules", o.rules_file, "File of rules, a line each, after those of --rule")
      ->type_name("FILE");
  app.add_option("--extension", o.extension,
                 "Of results [.glb of bcd-decompose, .ply of others; robots become folders]")
      ->type_name("EXT");
  app.add_option("--jobs", o.jobs, "Files at a time; 0: one per core")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--memory", o.memory,
                 "Of all programs at a time, e.g. 8G: fewer run where they are expected to need "
                 "more, as earlier ones did [80% of what is free]")
      ->type_name("SIZE");
  app.add_option("--max-memory", o.most_memory, "Address space of one program, e.g. 4G [no limit]")
      ->type_name("SIZE");
  app.add_option("--timeout", o.timeout, "End a program after so many seconds; 0: never")
      ->check(tools::number_from(0, 1e9))
      ->capture_default_str()
      ->type_name("S");
  auto* shard = app.add_option("--shard", o.shard,
                               "Work on one part of N, as several machines do in one folder: files "
                               "belong to parts by their names. --summary, or the batch without "
                               "--shard, which does what is missing, writes the summary of all")
                    ->type_name("K/N");
  app.add_flag("--summary", o.summary, "Work on nothing, write the summary of what is done so far")
      ->excludes(shard);
  app.add_flag("--retry", o.retry, "Also do again what was not done for a reason");
  app.add_flag("--no-pictures", o.no_pictures, "Draw no results for the summary");
  app.add_option("--report", o.common.report, "Write a JSON report to this file (- for stdout)")
      ->type_name("FILE");
  app.add_flag("--quiet", o.common.quiet, "Print errors only");
  app.footer(
      "Programs that are not given {input} are called with INPUT -o OUTPUT --report FILE --threads "
      "1 "
      "--depfile FILE.\n"
      "A batch that was ended, however, goes on where it was when it is called again; files that "
      "have changed, or whose options have, are done anew.\n"
      "Exit codes: 0 all done; 1 some are not, for reasons in the summary; 2 usage; 3 bad input; 4 "
      "output failed; 6 internal error; 7 ended by a signal.");
}

std::vector<batch::Rule> rules_of(const Options& o) {
  std::vector<batch::Rule> rules;
  for (const std::string& text : o.rules) rules.push_back(batch::parse_rule(text));
  if (!o.rules_file.empty()) {
    const std::vector<batch::Rule> more = batch::read_rules(o.rules_file);
    rules.insert(rules.end(), more.begin(), more.end());
  }
  if (!o.command.empty())
    rules.push_back({"*", o.command});
  else if (rules.empty())
    rules.push_back({"*", {"bmesh-decimate", "--epsilon", "1%"}});
  return rules;
}

void report(const Options& o, const batch::BatchResult& result, double wall_seconds) {
  if (!o.common.report.empty()) {
    tools::Json report = tools::Json::parse(result.json());
    report["resources"] = {{"wall_seconds", wall_seconds}};
    tools::write_report(o.common, "kaboum-batch", report);
  }
  constexpr int kShown = 5;
  int shown = 0;
  for (const batch::Record& record : result.records)
    if (!record.done() && !record.reason.empty() && ++shown <= kShown)
      tools::log(o.common.quiet, record.name + ": " + record.reason);
  const std::string where = o.shard.empty() ? (fs::path(o.output) / "summary.html").string()
                                            : "part " + o.shard + " of " + o.output;
  tools::log(o.common.quiet, result.words() + "; " + where);
}

volatile std::sig_atomic_t is_stopped = 0;

/// Ctrl-C and the end of a job of a cluster end the programs, and are written down nowhere.
void catch_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { is_stopped = 1; };
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}

int run(const Options& o) {
  const auto begin = std::chrono::steady_clock::now();
  batch::BatchRequest request;
  if (!o.shard.empty()) request.shard = batch::parse_shard(o.shard);
  request.inputs = o.inputs;
  request.rules = rules_of(o);
  request.folder = o.output;
  request.extension = o.extension;
  request.only_summary = o.summary;
  request.retry = o.retry;
  request.jobs = o.jobs;
  if (!o.memory.empty()) request.memory = tools::parse_memory(o.memory, "--memory");
  request.most_memory = tools::parse_memory(o.most_memory, "--max-memory");
  request.timeout = o.timeout;
  request.pictures = !o.no_pictures;
  request.note = [&](const std::string& text) { tools::log(o.common.quiet, text); };
  request.stop = [] { return is_stopped != 0; };
  catch_signals();
  const batch::BatchResult result = [&] {
    tools::Progress progress(o.common.quiet);
    request.progress = [&](const std::string& text) { progress.show(text.substr(0, 120)); };
    return batch::run_batch(request);
  }();
  report(o, result,
         std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  if (result.stopped) return tools::kLimit;
  return result.complete() ? tools::kDone : tools::kNo;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Runs a program on many files, in parallel; goes on where it was ended.",
               "kaboum-batch");
  Options options;
  describe(app, options);
  // What follows --command is another program's, whose options look like ours.
  const auto end = std::find(argv, argv + argc, std::string_view("--command"));
  if (end != argv + argc) options.command.assign(end + 1, argv + argc);
  return tools::run(app, static_cast<int>(end - argv), argv, [&] {
    if (end != argv + argc && options.command.empty())
      throw Error(ErrorCode::InvalidArgument, "--command: give a program and its options");
    return run(options);
  });
}
