#pragma once

#include <string>

/// A sentence for Ctrl-C and for the end of a job.
namespace kaboum::tools {

/// What is said when SIGINT or SIGTERM ends the program, while it lives. The program ends at once
/// and by that signal, as it does without it: 130 and 143 in a shell. One at a time.
class LastWords {
 public:
  /// @param quiet  nothing is said
  explicit LastWords(bool quiet);
  ~LastWords();
  LastWords(const LastWords&) = delete;
  LastWords& operator=(const LastWords&) = delete;

  /// From now on this is said; a newline follows it.
  void set(const std::string& text);

 private:
  bool active_;
};

}  // namespace kaboum::tools
