#pragma once

#include <kaboum/external/process_group.h>

#include <functional>
#include <optional>
#include <string>

namespace kaboum::external {

/// Lines through a socket, which it closes.
class LineSocket {
 public:
  explicit LineSocket(int socket) : socket_(socket) {}
  ~LineSocket() { close(); }
  LineSocket(const LineSocket&) = delete;
  LineSocket& operator=(const LineSocket&) = delete;

  enum class ReadOutcome { Line, End, Late, TooLong };
  /// @param seconds  that are left; less afterwards by what it took.
  ReadOutcome read_line(std::string& line, double& seconds);
  /// A line that is there already, or the beginning of one; nothing is waited for.
  std::optional<std::string> take_what_is_there();
  /// false: the other side takes no more, or not in this time.
  bool write_line(std::string line, double& seconds);
  /// The other side reads the end.
  void end_writing();
  void close();
  /// Goes on with another socket.
  void reset(int socket);

 private:
  int socket_;
  std::string buffer_;
};

/// A process that lines are exchanged with.
class LineChannel {
 public:
  /// Starts a command of the shell. @throws Error{InvalidInput} when that fails.
  explicit LineChannel(const std::string& command);
  /// Does `work` in a child of this process, which then ends. What it prints goes to standard
  /// error. @throws as above.
  LineChannel(const std::string& name, const std::function<void(LineSocket&)>& work);
  /// Takes over a socket to whatever is on its other side: there is no process to be ended.
  explicit LineChannel(int socket) : lines_(socket) {}
  /// Ends the process, and all that it started.
  ~LineChannel();
  LineChannel(const LineChannel&) = delete;
  LineChannel& operator=(const LineChannel&) = delete;

  [[nodiscard]] LineSocket& lines() { return lines_; }

  /// Ends the process. @return in words how it ended: "it ended with exit code 1".
  std::string end();

 private:
  /// @param child  what the child does with its end of the socket.
  void start(const std::string& name, const std::function<void(int)>& child);

  ProcessGroup group_;
  int process_ = -1;
  LineSocket lines_{-1};
};

}  // namespace kaboum::external
