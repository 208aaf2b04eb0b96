// The cache of results: what is in it, whether it is whole, making room.

#include <kaboum/base/error.h>
#include <kaboum/certify/cache_folder.h>
#include <tbb/parallel_for.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <iostream>

#include "common/cli.h"

namespace {

using namespace kaboum;  // the tool's own names are few
using certify::CacheFolder;
using tools::Json;

struct Options {
  std::string folder, size;
  bool all = false, remove = false;
  tools::CommonOptions common;
};

void add_common(CLI::App& app, Options& o) {
  app.add_option("--folder", o.folder,
                 "The cache [$KABOUM_CACHE, else $XDG_CACHE_HOME/kaboum, else ~/.cache/kaboum]")
      ->type_name("DIR");
  app.add_option("--report", o.common.report, "Write a JSON report to this file (- for stdout)")
      ->type_name("FILE");
  app.add_flag("--quiet", o.common.quiet, "Print errors only");
}

CacheFolder cache_of(Options& o) {
  if (o.folder.empty()) o.folder = CacheFolder::default_folder().string();
  if (o.folder.empty())
    throw Error(ErrorCode::InvalidArgument,
                "there is no cache: none of $KABOUM_CACHE, $XDG_CACHE_HOME and $HOME is set; give "
                "--folder");
  return CacheFolder(o.folder);
}

double seconds_since(std::filesystem::file_time_type time) {
  return std::chrono::duration<double>(std::filesystem::file_time_type::clock::now() - time)
      .count();
}

void report(const Options& o, const char* command, Json body) {
  body["command"] = command;
  body["folder"] = o.folder;
  tools::write_report(o.common, "kaboum-cache", body);
}

int list(Options& o) {
  const std::uintmax_t limit = CacheFolder::size_limit();
  const std::vector<CacheFolder::Entry> entries = cache_of(o).entries();
  Json rows = Json::array();
  std::uintmax_t sum = 0;
  const bool print = !o.common.quiet && o.common.report != "-";
  for (const CacheFolder::Entry& entry : entries) {
    const std::string kind = CacheFolder::kind_of(entry), name = entry.path.stem().string();
    sum += entry.bytes;
    rows.push_back({{"entry", name},
                    {"kind", kind},
                    {"bytes", entry.bytes},
                    {"seconds_since_use", seconds_since(entry.used)}});
    if (print)
      std::cout << name << "  " << kind << "  " << entry.bytes << " bytes, used "
                << static_cast<long>(seconds_since(entry.used) / 60) << " min ago\n";
  }
  if (print)
    std::cout << entries.size() << " entries, " << sum << " of " << limit << " bytes, in "
              << o.folder << '\n';
  report(o, "list", {{"entries", rows}, {"bytes", sum}, {"limit", limit}});
  return tools::kDone;
}

int verify(Options& o) {
  const std::vector<CacheFolder::Entry> entries = cache_of(o).entries();
  std::vector<std::string> flaws(entries.size());
  tbb::parallel_for(std::size_t{0}, entries.size(),
                    [&](std::size_t i) { flaws[i] = CacheFolder::flaw_of(entries[i]); });
  Json damaged = Json::array();
  const bool print = !o.common.quiet && o.common.report != "-";
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (flaws[i].empty()) continue;
    damaged.push_back({{"entry", entries[i].path.stem().string()}, {"flaw", flaws[i]}});
    std::error_code error;
    if (o.remove) std::filesystem::remove(entries[i].path, error);
    if (print)
      std::cout << entries[i].path.string() << ": " << flaws[i] << (o.remove ? "; removed" : "")
                << '\n';
  }
  if (print)
    std::cout << entries.size() - damaged.size() << " of " << entries.size()
              << " entries are whole\n";
  const bool whole = damaged.empty();
  report(o, "verify", {{"looked_at", entries.size()}, {"damaged", std::move(damaged)}});
  return whole || o.remove ? tools::kDone : tools::kNo;
}

int prune(Options& o) {
  const CacheFolder cache = cache_of(o);
  const std::uintmax_t most = o.all            ? 0
                              : o.size.empty() ? CacheFolder::size_limit()
                                               : tools::parse_memory(o.size, "--size");
  const std::vector<CacheFolder::Entry> removed = cache.prune(most);
  std::uintmax_t sum = 0;
  for (const CacheFolder::Entry& entry : removed) sum += entry.bytes;
  if (!o.common.quiet && o.common.report != "-")
    std::cout << removed.size() << " entries removed, " << sum << " bytes\n";
  report(o, "prune", {{"removed", removed.size()}, {"bytes", sum}, {"size", most}});
  return tools::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Looks at the cache of results that KABouM's programs keep between runs.",
               "kaboum-cache");
  app.require_subcommand(1);
  Options o;
  CLI::App* lists =
      app.add_subcommand("list", "Entries, those not used for the longest time first");
  CLI::App* verifies = app.add_subcommand("verify", "Are all entries whole?");
  CLI::App* prunes = app.add_subcommand(
      "prune", "Remove what was not used for the longest time until the rest is small enough");
  for (CLI::App* command : {lists, verifies, prunes}) add_common(*command, o);
  verifies->add_flag("--remove", o.remove, "Remove those that are not");
  prunes->add_option("--size", o.size, "Most that is left, e.g. 500M [$KABOUM_CACHE_SIZE, else 4G]")
      ->type_name("SIZE");
  prunes->add_flag("--all", o.all, "Remove all")->excludes("--size");
  app.footer(
      "Programs make room by themselves, now and then, down to $KABOUM_CACHE_SIZE.\n"
      "Exit codes: 0 done; 1 entries are damaged (programs make those again); 2 usage; 4 output "
      "failed; 6 internal error.");
  return tools::run(app, argc, argv, [&] {
    if (lists->parsed()) return list(o);
    return verifies->parsed() ? verify(o) : prune(o);
  });
}
