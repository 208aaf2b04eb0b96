#pragma once

#include <string>

namespace kaboum::external {

/// A program that lines are exchanged with.
class LineChannel {
 public:
  /// Starts a command of the shell. @throws Error{InvalidInput} when that fails.
  explicit LineChannel(const std::string& command);
  /// Ends the program, and all that it started.
  ~LineChannel();
  LineChannel(const LineChannel&) = delete;
  LineChannel& operator=(const LineChannel&) = delete;

  enum class Got { Line, End, Late, TooLong };
  /// @param seconds  that are left; less afterwards by what it took.
  Got read_line(std::string& line, double& seconds);
  /// false: the program takes no more, or not in this time.
  bool write_line(std::string line, double& seconds);

  /// Ends the program. @return in words how it ended: "it ended with exit code 1".
  std::string end();

 private:
  int socket_ = -1;
  int process_ = -1;
  std::string buffer_;
};

}  // namespace kaboum::external
