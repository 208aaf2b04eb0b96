// The journal: appended to by single writes, read once.

#include "journal.h"

#include <fcntl.h>
#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <sstream>

namespace kaboum::batch {

Journal::Journal(const fs::path& file) : path_(file) {
  file_ = open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) throw Error(ErrorCode::OutputFailed, file.string() + ": " + std::strerror(errno));
  // The lock is the kernel's, which lets it go however a process ends. Where a file system has
  // none, nothing is protected but from a second batch started by mistake.
  if (flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(file_);
    throw Error(ErrorCode::OutputFailed,
                file.parent_path().parent_path().string() + ": another batch writes here");
  }
  const std::vector<char> bytes = io::read_file(file);
  std::istringstream stream(std::string(bytes.begin(), bytes.end()));
  for (std::string line; std::getline(stream, line);)
    if (auto record = record_from(line)) {
      std::string name = record->name;
      records_.insert_or_assign(std::move(name), std::move(*record));
    }
  if (!bytes.empty() && bytes.back() != '\n' && write(file_, "\n", 1) != 1)  // a line cut short
    throw Error(ErrorCode::OutputFailed, file.string() + ": " + std::strerror(errno));
}

Journal::~Journal() { close(file_); }

const Record* Journal::find(const std::string& name) const {
  const auto at = records_.find(name);
  return at == records_.end() ? nullptr : &at->second;
}

void Journal::add(const Record& record) {
  const std::string line =
      to_json(record).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  if (write(file_, line.data(), line.size()) != static_cast<ssize_t>(line.size()))
    throw Error(ErrorCode::OutputFailed, path_.string() + ": " + std::strerror(errno));
  records_.insert_or_assign(record.name, record);
}

}  // namespace kaboum::batch
