#pragma once

#include <map>
#include <string>

#include "record.h"

namespace kaboum::batch {

/// The records of a batch, one line each, which only grows: what is in it survives kill -9, and a
/// line that was cut short is passed over.
class Journal {
 public:
  /// Reads what is there, and takes the folder: a second batch in it is refused while this lives.
  /// @throws Error{OutputFailed}
  explicit Journal(const fs::path& file);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The newest record of a name, or null.
  [[nodiscard]] const Record* find(const std::string& name) const;
  /// @throws Error{OutputFailed}
  void add(const Record& record);

 private:
  fs::path path_;
  int file_ = -1;
  std::map<std::string, Record> records_;
};

}  // namespace kaboum::batch
