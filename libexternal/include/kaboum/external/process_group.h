#pragma once

namespace kaboum::external {

/// A group of processes that ends together, and with this process however it ends, kill -9 and the
/// key that interrupts included: a guard leads the group, and ends it when nobody holds the pipe
/// any more that it reads from.
class ProcessGroup {
 public:
  ProcessGroup() = default;
  ~ProcessGroup() { end(); }
  ProcessGroup(const ProcessGroup&) = delete;
  ProcessGroup& operator=(const ProcessGroup&) = delete;

  /// @return false: no process can be started; errno says why.
  bool start();
  /// Makes a child of this process, and what it starts later, a member. To be called on both sides
  /// of the fork. @param process  0: itself. @return false: the group has ended.
  [[nodiscard]] bool add(int process) const;
  /// Ends all members.
  void end();

 private:
  int guard_ = -1;
  int held_ = -1;  ///< this side of the pipe
};

/// Closes all files but one and those below `from`.
void close_others(int kept, int from);

}  // namespace kaboum::external
