#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>

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
  /// @param jobs  in the order of their names; only records of these as they are now are known
  /// @throws Error{OutputFailed}
  Journal(const JournalOptions& options, std::span<const Job> jobs);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The record of a job, or null: the newest of each journal, of these one that is done.
  [[nodiscard]] const Record* find(const std::string& name) const;
  /// @throws Error{OutputFailed}
  void add(const Record& record);
  /// As if there were none: its result is gone.
  void forget(const std::string& name) { known_.erase(name); }

  /// Folder for what this run has begun.
  [[nodiscard]] const fs::path& scratch() const { return scratch_; }

 private:
  struct Known {
    Record record;
    std::size_t journal = 0;  ///< of which it is
  };

  void take_whole();
  void take_part(const Shard& shard);
  void read_all(std::span<const Job> jobs);

  fs::path folder_, path_, scratch_;
  int file_ = -1;
  bool written_ = false, own_ = false;
  std::map<std::string, Known> known_;
};

}  // namespace kaboum::batch
