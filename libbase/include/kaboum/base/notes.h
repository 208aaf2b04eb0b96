#pragma once

#include <string>
#include <utility>
#include <vector>

namespace kaboum {

/// Notes on several files, each sentence once.
class Notes {
 public:
  void add(const std::string& file, const std::string& text);
  /// "FILE: text" for each text, in the order of their first files; the names of further files
  /// follow the first.
  [[nodiscard]] std::vector<std::string> lines() const;

 private:
  std::vector<std::pair<std::string, std::vector<std::string>>> notes_;  // text, files
};

}  // namespace kaboum
