// A batch from its request to its summary.

#include <kaboum/batch/batch.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "pool.h"
#include "result.h"
#include "summary.h"

namespace kaboum::batch {
namespace {

/// Whether a record holds: the job's other sources are as they were, and the result is that very
/// one, for a batch with other options may have written there since. Of what failed it is not known
/// which other files were in the way.
bool holds(const Job& job, const Record& record, const fs::path& folder) {
  for (const FileState& source : record.sources)
    if (file_state(source.path) != source) return false;
  if (!record.has_result())
    return record.done() || !record.sources.empty() || !job.may_refer_to_others();
  return digest_of(folder / record.output) == record.sha256;
}

std::vector<const Job*> waiting_of(const std::vector<Job>& jobs, const Journal& journal,
                                   bool retry) {
  std::vector<const Job*> waiting;
  for (const Job& job : jobs) {
    const Record* record = journal.find(job.name);
    if (record == nullptr || (retry && !record->done())) waiting.push_back(&job);
  }
  return waiting;
}

std::vector<Record> records_of(const std::vector<Job>& jobs, const Journal& journal) {
  std::vector<Record> records;
  for (const Job& job : jobs)
    if (const Record* record = journal.find(job.name)) records.push_back(*record);
  return records;
}

void write_summary(const fs::path& folder, const BatchResult& result) {
  const auto write = [&](const char* name, const std::string& text) {
    io::write_file(folder / name, text);
  };
  write("summary.html", html_of(result, "Batch " + folder.filename().string()));
  write("summary.csv", csv_of(result));
  write("summary.json", result.json());
}

PoolOptions pool_options(const BatchRequest& request, const Journal& journal) {
  PoolOptions options{.folder = request.folder,
                      .scratch = journal.scratch(),
                      .jobs = request.jobs,
                      .memory = request.memory,
                      .most_memory = request.most_memory,
                      .timeout = request.timeout,
                      .pictures = request.pictures,
                      .programs = request.programs,
                      .progress = request.progress,
                      .stop = request.stop};
  if (options.jobs == 0) options.jobs = std::max(1U, std::thread::hardware_concurrency());
  return options;
}

}  // namespace

std::uintmax_t BatchRequest::free_memory() {
  std::ifstream file("/proc/meminfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("MemAvailable:"))
      return std::stoull(line.substr(line.find(':') + 1)) * 1024 / 5 * 4;
  return 0;
}

BatchResult run_batch(const BatchRequest& request) {
  const std::vector<Job> jobs = find_jobs(request);
  Journal journal(
      {request.folder, request.shard, request.only_summary}, jobs,
      [&](const Job& job, const Record& record) { return holds(job, record, request.folder); });
  std::vector<const Job*> waiting = waiting_of(jobs, journal, request.retry);
  const std::size_t before = jobs.size() - waiting.size();
  BatchResult result;
  if (!request.only_summary) {
    result.done_before = before;
    Pool pool(pool_options(request, journal), journal);
    result.stopped = !pool.run(std::move(waiting));
  }
  result.records = records_of(jobs, journal);
  result.to_do = jobs.size() - result.records.size();
  if (!request.shard) write_summary(request.folder, result);
  return result;
}

}  // namespace kaboum::batch
