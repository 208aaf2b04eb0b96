// Journals: appended to by single writes, read once.

#include "journal.h"

#include <fcntl.h>
#include <kaboum/base/error.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>

namespace kaboum::batch {
namespace {

constexpr const char* kFolder = ".kaboum-batch";
constexpr auto kOld = std::chrono::hours(24 * 7);  // live runs touch theirs every few minutes

[[noreturn]] void fail(const fs::path& file) {
  throw Error(ErrorCode::OutputFailed, file.string() + ": " + std::strerror(errno));
}

/// "2-of-8.HOST.PROCESS"
std::string run_name(const Shard& shard) {
  std::array<char, 65> host{};
  if (gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  return std::to_string(shard.number) + "-of-" + std::to_string(shard.count) + "." + host.data() +
         "." + std::to_string(getpid());
}

/// Scratch folders of parts whose runs were ended by kill -9 some time ago, wherever they ran.
void remove_old_scratches(const fs::path& folder) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (!entry.path().filename().string().starts_with("scratch-")) continue;
    const auto used = entry.last_write_time(error);
    if (!error && fs::file_time_type::clock::now() - used > kOld)
      fs::remove_all(entry.path(), error);
  }
}

/// In the order of their names.
std::vector<fs::path> journals_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().filename().string().starts_with("journal") &&
        entry.path().extension() == ".jsonl")
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

const Job* job_of(std::span<const Job> jobs, const std::string& name) {
  const auto at = std::lower_bound(jobs.begin(), jobs.end(), name,
                                   [](const Job& j, const std::string& n) { return j.name < n; });
  return at != jobs.end() && at->name == name ? &*at : nullptr;
}

/// The last record of each job as it is now. One of other options or another input, later on, takes
/// nothing back: whether the result is still the record's is seen at the result.
std::map<std::string, Record> newest_in(const fs::path& journal, std::span<const Job> jobs) {
  std::map<std::string, Record> newest;
  std::ifstream lines(journal, std::ios::binary);
  for (std::string line; std::getline(lines, line);) {
    auto record = record_from(line);
    if (!record) continue;
    const Job* job = job_of(jobs, record->name);
    if (job != nullptr && job->key() == record->key)
      newest.insert_or_assign(job->name, std::move(*record));
  }
  if (lines.bad()) throw Error(ErrorCode::InvalidInput, journal.string() + ": cannot be read");
  return newest;
}

}  // namespace

Journal::Journal(const JournalOptions& options, std::span<const Job> jobs, const Holds& holds)
    : folder_(options.folder / kFolder) {
  if (!options.read_only) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) throw Error(ErrorCode::OutputFailed, folder_.string() + ": " + error.message());
    remove_old_scratches(folder_);
    if (options.shard)
      take_part(*options.shard);
    else
      take_whole();
  }
  read_all(jobs, holds);
}

Journal::~Journal() {
  if (file_ >= 0) close(file_);
  if (own_ && !written_) unlink(path_.c_str());
}

void Journal::take_whole() {
  path_ = folder_ / "journal.jsonl";
  scratch_ = folder_ / "scratch";
  file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) fail(path_);
  // The lock is the kernel's, which lets it go however a process ends. Where a file system has
  // none, nothing is protected but from a second batch started by mistake.
  if (flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(file_);
    throw Error(ErrorCode::OutputFailed,
                folder_.parent_path().string() +
                    ": another batch writes here; several machines share one with «shard»");
  }
  char last = '\n';
  const off_t size = lseek(file_, 0, SEEK_END);
  if (size > 0 && pread(file_, &last, 1, size - 1) == 1 && last != '\n' &&
      write(file_, "\n", 1) != 1)  // a line cut short
    fail(path_);
}

void Journal::take_part(const Shard& shard) {
  const std::string name = run_name(shard);
  for (int attempt = 0; file_ < 0; ++attempt) {  // machines may have one name
    const std::string run = attempt == 0 ? name : name + "." + std::to_string(attempt);
    path_ = folder_ / ("journal-" + run + ".jsonl");
    scratch_ = folder_ / ("scratch-" + run);
    file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
    if (file_ < 0 && (errno != EEXIST || attempt > 1000)) fail(path_);
  }
  own_ = true;
}

void Journal::read_all(std::span<const Job> jobs, const Holds& holds) {
  for (const fs::path& file : journals_in(folder_)) {
    for (auto& [name, record] : newest_in(file, jobs)) {
      if (!holds(*job_of(jobs, name), record)) continue;
      const auto at = known_.find(name);
      if (at == known_.end() || record.done() || !at->second.done())
        known_.insert_or_assign(name, std::move(record));
    }
  }
}

const Record* Journal::find(const std::string& name) const {
  const auto at = known_.find(name);
  return at == known_.end() ? nullptr : &at->second;
}

void Journal::add(const Record& record) {
  const std::string line =
      to_json(record).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  if (write(file_, line.data(), line.size()) != static_cast<ssize_t>(line.size())) fail(path_);
  written_ = true;
  known_.insert_or_assign(record.name, record);
}

}  // namespace kaboum::batch
