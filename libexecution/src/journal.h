#pragma once

#include <kaboum/execution/robot_driver.h>

#include <chrono>
#include <cstddef>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace kaboum::execution {

/// JSON in one line, with a sign in place of what is no UTF-8.
std::string dump(const nlohmann::json& value);

/// The journal of a run: each line is there at once, whatever happens next.
class Journal {
 public:
  /// Without a line. @throws Error{OutputFailed} for a file that cannot be opened
  explicit Journal(const DriverOptions& options);
  /// Whether anybody reads it.
  [[nodiscard]] bool is_kept() const { return file_.is_open() || noted_; }
  /// Adds an entry, an object, with the time. @throws Error{OutputFailed}
  void note(const nlohmann::json& entry);
  /// An entry of one member, a text that is JSON in one line: motions are long, and a robot waits.
  void note_text(const char* name, const std::string& json);
  /// An entry as text.
  void add(std::string entry);

 private:
  std::string name_;
  std::ofstream file_;
  std::function<void(const std::string&)> noted_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Reads the journal of a run. A last line without its end was cut when the run was killed, and is
/// not there.
/// @param entry  gets each line, as it is and as an object
/// @throws Error{InvalidInput} for a file that is no journal, naming the line; what `entry` throws
void read_journal(
    const std::string& file,
    const std::function<void(std::string line, nlohmann::json entry, std::size_t number)>& entry);

/// @throws Error{InvalidInput} that names the line
[[noreturn]] void refuse_journal(const std::string& file, std::size_t number,
                                 const std::string& what);

}  // namespace kaboum::execution
