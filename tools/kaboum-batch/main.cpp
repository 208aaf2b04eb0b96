// One program for many files, in parallel, resumable.

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <thread>

#include "command.h"
#include "common/cli.h"
#include "pool.h"
#include "result.h"
#include "summary.h"

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

/// Four fifths of what is free; 0, which is no limit, where that is not known.
std::uintmax_t free_memory() {
  std::ifstream file("/proc/meminfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("MemAvailable:"))
      return std::stoull(line.substr(line.find(':') + 1)) * 1024 / 5 * 4;
  return 0;
}

/// Whether a record holds: the job's other sources are as they were, and the result is that very
/// one, for a batch with other options may have written there since. Of what failed it is not known
/// which other files were in the way.
bool holds(const batch::Job& job, const batch::Record& record, const Options& o) {
  for (const batch::FileState& source : record.sources)
    if (batch::file_state(source.path) != source) return false;
  if (!record.has_result())
    return record.done() || !record.sources.empty() || !job.may_refer_to_others();
  return batch::digest_of(fs::path(o.output) / record.output) == record.sha256;
}

std::vector<const batch::Job*> waiting_of(const std::vector<batch::Job>& jobs,
                                          const batch::Journal& journal, bool retry) {
  std::vector<const batch::Job*> waiting;
  for (const batch::Job& job : jobs) {
    const batch::Record* record = journal.find(job.name);
    if (record == nullptr || (retry && !record->done())) waiting.push_back(&job);
  }
  return waiting;
}

std::vector<batch::Record> records_of(const std::vector<batch::Job>& jobs,
                                      const batch::Journal& journal) {
  std::vector<batch::Record> records;
  for (const batch::Job& job : jobs)
    if (const batch::Record* record = journal.find(job.name)) records.push_back(*record);
  return records;
}

void write_summary(const Options& o, const batch::Summary& summary) {
  const fs::path folder(o.output);
  const auto write = [&](const char* name, const std::string& text) {
    io::write_file(folder / name, text);
  };
  write("summary.html", batch::html_of(summary, "Batch " + folder.filename().string()));
  write("summary.csv", batch::csv_of(summary));
  write("summary.json", batch::json_of(summary));
}

void report(const Options& o, const batch::Summary& summary, double wall_seconds) {
  if (!o.common.report.empty()) {
    batch::Json report = summary.json();
    report["resources"] = {{"wall_seconds", wall_seconds}};
    tools::write_report(o.common, "kaboum-batch", report);
  }
  constexpr int kShown = 5;
  int shown = 0;
  for (const batch::Record& record : summary.records)
    if (!record.done() && !record.reason.empty() && ++shown <= kShown)
      tools::log(o.common.quiet, record.name + ": " + record.reason);
  const std::string where = o.shard.empty() ? (fs::path(o.output) / "summary.html").string()
                                            : "part " + o.shard + " of " + o.output;
  tools::log(o.common.quiet, summary.words() + "; " + where);
}

batch::PoolOptions pool_options(const Options& o, const batch::Journal& journal) {
  batch::PoolOptions options{
      .folder = o.output,
      .scratch = journal.scratch(),
      .jobs = o.jobs,
      .memory = o.memory.empty() ? free_memory() : tools::parse_memory(o.memory, "--memory"),
      .most_memory = tools::parse_memory(o.most_memory, "--max-memory"),
      .timeout = o.timeout,
      .pictures = !o.no_pictures,
      .quiet = o.common.quiet};
  if (options.jobs == 0) options.jobs = std::max(1U, std::thread::hardware_concurrency());
  return options;
}

int run(const Options& o) {
  const auto begin = batch::Clock::now();
  std::optional<batch::Shard> shard;
  if (!o.shard.empty()) shard = batch::parse_shard(o.shard);
  const std::vector<batch::Job> jobs =
      batch::find_jobs({o.inputs, rules_of(o), o.extension, o.output, shard,
                        [&](const std::string& text) { tools::log(o.common.quiet, text); }});
  batch::Journal journal(
      {o.output, shard, o.summary}, jobs,
      [&](const auto& job, const auto& record) { return holds(job, record, o); });
  std::vector<const batch::Job*> waiting = waiting_of(jobs, journal, o.retry);
  const std::size_t before = jobs.size() - waiting.size();
  bool whole = true;
  if (!o.summary) {
    batch::Pool pool(pool_options(o, journal), journal);
    whole = pool.run(std::move(waiting));
  }
  const std::vector<batch::Record> records = records_of(jobs, journal);
  const batch::Summary summary{records, o.summary ? 0 : before, jobs.size() - records.size()};
  if (!shard) write_summary(o, summary);
  report(o, summary, std::chrono::duration<double>(batch::Clock::now() - begin).count());
  if (!whole) return tools::kLimit;
  return summary.count("done") == jobs.size() ? tools::kDone : tools::kNo;
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
