#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "journal.h"
#include "process.h"

namespace kaboum::batch {

struct PoolOptions {
  fs::path folder;                 ///< of results
  fs::path scratch;                ///< of this run alone, in the same file system
  std::size_t jobs = 1;            ///< at a time
  std::uintmax_t memory = 0;       ///< of all of them together; 0: no limit [bytes]
  std::uintmax_t most_memory = 0;  ///< of one; 0: no limit [bytes]
  double timeout = 0;              ///< of one; 0: none [s]
  bool pictures = false;
  fs::path programs = {};                                 ///< BatchRequest::programs
  std::function<void(const std::string&)> progress = {};  ///< as of BatchRequest
  std::function<bool()> stop = {};
};

/// Runs jobs at the same time, largest inputs first, as many as the processors and the memory
/// allow, and writes down what becomes of each. Results appear under their names when they are
/// whole; what was begun and not finished is in a folder of its own that is emptied at the start.
class Pool {
 public:
  Pool(PoolOptions options, Journal& journal);
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  /// @return false if `stop` ended it before all jobs were done.
  /// @throws Error{OutputFailed} when the folder cannot be written
  bool run(std::vector<const Job*> jobs);

 private:
  /// A job at work.
  struct Running {
    const Job* job = nullptr;
    fs::path scratch;
    Clock::time_point begin;
    std::int64_t since = 0;         ///< its program is at work [ns]
    std::vector<FileState> before;  ///< what was in the result's place
    std::uintmax_t memory = 0;      ///< expected [bytes]
    bool ended_by_us = false;
    int watch = -1;                 ///< as watched says
    std::optional<Record> drawing;  ///< the program is done, its picture is being drawn
  };

  void begin(const Job& job, std::uintmax_t memory);
  void end(const Ended& ended);
  void conclude(Running& run, const Ended& ended);
  bool draw(Running& run, Record& record);
  void add(const Record& record);
  void wait() const;
  void end_those_done();
  void end_late_ones();
  void show_life();
  void start_what_fits(std::deque<const Job*>& waiting);
  [[nodiscard]] std::uintmax_t expected_memory(const Job& job) const;
  void learn(const Job& job, const Ended& ended);
  void show(std::size_t waiting) const;

  PoolOptions o_;
  Journal& journal_;
  std::map<pid_t, Running> running_;
  std::map<std::string, double> bytes_per_byte_;  // of programs: memory for each byte of input
  std::size_t all_ = 0, done_ = 0, short_ = 0, number_ = 0;
  std::uintmax_t used_ = 0;  // memory expected of what runs [bytes]
  Clock::time_point begin_, next_sign_;
};

}  // namespace kaboum::batch
