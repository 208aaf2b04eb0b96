#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "job.h"
#include "record.h"

namespace kaboum::batch {

/// Whose journal is written.
struct JournalOptions {
  fs::path folder;             ///< of results
  std::optional<Shard> shard;  ///< a part of the batch
  bool read_only = false;      ///< nobody's
};

/// What is known of jobs: the journals of all runs of a batch are read, one is written, a line for
/// each record, which only grows: what is in it survives kill -9, and a line that was cut short is
/// passed over.
///
/// A run of the whole batch continues its journal, and a second one is refused while this lives. A
/// run of a part has a journal and a scratch folder of its own, so that no two runs write to the
/// same file, on several machines or by mistake, and none needs a lock.
class Journal {
 public:
  /// Whether what a record says of a job, whose key it has, is still so.
  using Holds = std::function<bool(const Job&, const Record&)>;

  /// @param jobs  in the order of their names; only records of these as they are now are known
  /// @throws Error{OutputFailed}
  Journal(const JournalOptions& options, std::span<const Job> jobs, const Holds& holds);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The record of a job, or null: of the newest of each journal one that holds, done if there is.
  [[nodiscard]] const Record* find(const std::string& name) const;
  /// @throws Error{OutputFailed}
  void add(const Record& record);

  /// Folder for what this run has begun.
  [[nodiscard]] const fs::path& scratch() const { return scratch_; }

 private:
  void take_whole();
  void take_part(const Shard& shard);
  void read_all(std::span<const Job> jobs, const Holds& holds);

  fs::path folder_, path_, scratch_;
  int file_ = -1;
  bool written_ = false, own_ = false;
  std::map<std::string, Record> known_;
};

}  // namespace kaboum::batch
