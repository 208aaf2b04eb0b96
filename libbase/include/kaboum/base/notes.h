#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kaboum {

/// How a note begins that users have to see, even where others are only counted.
inline constexpr std::string_view kWarning = "WARNING: ";

/// Notes on several files, each sentence once.
class Notes {
 public:
  void add(const std::string& file, const std::string& text);
  /// "FILE: text" for each text, in the order of their first files; the names of further files
  /// follow the first.
  /// @param wanted  of a text; by default all are
  [[nodiscard]] std::vector<std::string> lines(
      const std::function<bool(std::string_view)>& wanted = {}) const;

 private:
  std::vector<std::pair<std::string, std::vector<std::string>>> notes_;  // text, files
};

}  // namespace kaboum
