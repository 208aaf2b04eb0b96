#pragma once

#include <span>
#include <string>
#include <vector>

#include "record.h"

/// What a batch comes to: one row for each file, in the order of their names.
namespace kaboum::batch {

struct Summary {
  std::span<const Record> records;
  std::size_t done_before = 0;  ///< by earlier runs
  std::size_t to_do = 0;        ///< files without a record

  [[nodiscard]] std::size_t count(const char* state) const;
  /// "1980 done, 20 failed".
  [[nodiscard]] std::string words() const;
  /// All but the rows.
  [[nodiscard]] Json head() const;
  [[nodiscard]] Json json() const;
};

/// A row in each line, so that a million of them are written without being a tree before.
std::string json_of(const Summary& summary);
std::string csv_of(const Summary& summary);
/// A page by itself, but for pictures and results that it links to; columns are sorted by a click.
/// Of more files than a browser shows with ease, those that are not done come first.
std::string html_of(const Summary& summary, const std::string& title);

}  // namespace kaboum::batch
