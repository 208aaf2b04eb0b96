// The pool: starts programs, collects them, moves results to their places.

#include "pool.h"

#include <kaboum/base/error.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include "command.h"
#include "result.h"

namespace kaboum::batch {
namespace {

constexpr std::uintmax_t kLeastMemory = std::uintmax_t{48} << 20U;  // of any program [bytes]
constexpr auto kSignOfLife = std::chrono::minutes(10);
constexpr double kFirstGuess = 60;  // memory for each byte of an input, before one was seen

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Whether a program was ended by who ends the whole batch, as clusters do at limits of time,
/// signal by signal and program by program: it has not failed.
bool is_stopped(const Ended& ended, bool by_us) {
  if (by_us) return false;
  // Who kills all kills this process next; where only the program was killed, for want of memory as
  // a rule, the wait costs little.
  if (ended.signal == SIGKILL) std::this_thread::sleep_for(std::chrono::milliseconds(500));
  return ended.signal == SIGTERM || ended.signal == SIGINT || ended.signal == SIGHUP;
}

}  // namespace

Pool::Pool(PoolOptions options, Journal& journal)
    : o_(std::move(options)), journal_(journal), begin_(Clock::now()) {
  std::error_code error;
  fs::remove_all(o_.scratch, error);
  fs::create_directories(o_.scratch, error);
  if (error) throw Error(ErrorCode::OutputFailed, o_.scratch.string() + ": " + error.message());
}

Pool::~Pool() {
  for (const auto& [id, run] : running_) kill(id, SIGKILL);
  for (const auto& [id, run] : running_) {
    while (!end_of(id)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (run.watch >= 0) close(run.watch);
  }
  std::error_code error;
  fs::remove_all(o_.scratch, error);
}

bool Pool::run(std::vector<const Job*> jobs) {
  all_ = jobs.size();
  // The largest last would run alone in the end.
  std::stable_sort(jobs.begin(), jobs.end(),
                   [](const Job* a, const Job* b) { return a->state.bytes > b->state.bytes; });
  std::deque<const Job*> waiting(jobs.begin(), jobs.end());
  while (!waiting.empty() || !running_.empty()) {
    start_what_fits(waiting);
    show(waiting.size());
    wait();
    if (o_.stop && o_.stop()) return false;
    end_those_done();
    end_late_ones();
    show_life();
  }
  return true;
}

/// Until a program has ended, a signal came, or a tenth of a second has passed.
void Pool::wait() const {
  std::vector<pollfd> watches;
  for (const auto& [id, run] : running_)
    if (run.watch >= 0) watches.push_back({run.watch, POLLIN, 0});
  const bool all_watched = watches.size() == running_.size();
  poll(watches.data(), watches.size(), all_watched ? 100 : 5);
}

void Pool::end_those_done() {
  std::vector<Ended> all;
  for (const auto& [id, run] : running_)
    if (const auto ended = end_of(id)) all.push_back(*ended);
  for (const Ended& ended : all) end(ended);
}

void Pool::start_what_fits(std::deque<const Job*>& waiting) {
  for (auto next = waiting.begin(); next != waiting.end() && running_.size() < o_.jobs;) {
    const std::uintmax_t memory = expected_memory(**next);
    if (o_.memory > 0 && !running_.empty() && used_ + memory > o_.memory) {
      ++next;  // a smaller one may fit
      continue;
    }
    begin(**next, memory);
    next = waiting.erase(next);
  }
}

void Pool::begin(const Job& job, std::uintmax_t memory) {
  Running run;
  run.job = &job;
  run.scratch = o_.scratch / std::to_string(++number_);
  run.begin = Clock::now();
  run.memory = memory;
  std::error_code error;
  fs::create_directories(run.scratch, error);
  run.since = file_state(run.scratch).changed;  // by the clock of the file system
  run.before = marks_of(o_.folder / job.output);
  used_ += memory;
  const pid_t id = start(command_of(job, o_.folder, run.scratch, o_.programs),
                         run.scratch / kMessages, o_.most_memory);
  run.watch = watched(id);
  running_.emplace(id, std::move(run));
}

void Pool::end(const Ended& ended) {
  const auto at = running_.find(ended.id);
  if (at == running_.end()) return;
  Running run = std::move(at->second);
  running_.erase(at);
  if (run.watch >= 0) close(run.watch);
  run.watch = -1;
  if (is_stopped(ended, run.ended_by_us)) {
    // Nothing is written down: it is to be done again.
  } else if (run.drawing) {
    Record record = std::move(*run.drawing);
    const fs::path picture = run.scratch / kPicture;
    if (ended.exit_code == 0 && size_of(picture) > 0) {
      record.picture = "pictures/" + run.job->output + ".png";
      move(picture, o_.folder / record.picture);
    }
    add(record);
  } else {
    conclude(run, ended);
    if (run.drawing) return;
  }
  used_ -= run.memory;
  std::error_code error;
  fs::remove_all(run.scratch, error);
}

void Pool::conclude(Running& run, const Ended& ended) {
  const Job& job = *run.job;
  learn(job, ended);
  Record r;
  r.name = job.name;
  r.key = job.key();
  r.output = job.output;
  const std::string words = ended.exit_code == 0 ? "" : last_line(run.scratch / kMessages);
  r.state = state_of(ended, run.ended_by_us, words);
  r.exit_code = ended.exit_code;
  r.input_bytes = job.state.bytes;
  r.wall_seconds = seconds_since(run.begin);
  r.cpu_seconds = ended.cpu_seconds;
  r.peak_megabytes = ended.peak_megabytes;
  r.parameters = parameters_of(job);
  if (!r.done()) r.reason = reason_of(ended, run.ended_by_us, words);
  const fs::path place = o_.folder / job.output;
  const fs::path made = job.makes_folder() ? place : result_in(run.scratch, job);
  if (r.state == "done" || r.state == "no") {
    if (!marks_of(made).empty() && marks_of(made) != run.before) {
      r.sha256 = digest_of(made);  // of what this program has made, whoever else writes there
      r.output_bytes = size_of(made);
      if (!job.makes_folder()) move(made, place);
    }
    add_report_in(run.scratch, r);
  }
  r.sources = sources_in(run.scratch, job, run.since);
  if (!(o_.pictures && r.has_result() && draw(run, r))) add(r);
}

/// @return whether a program draws it now
bool Pool::draw(Running& run, Record& record) {
  const fs::path picture = run.scratch / kPicture;
  if (run.job->makes_folder()) return false;
  const pid_t id =
      start({find_program("mesh-picture", o_.programs), (o_.folder / record.output).string(), "-o",
             picture.string(), "--width", "320", "--height", "220"},
            run.scratch / kMessages, o_.most_memory);
  run.drawing = std::move(record);
  run.begin = Clock::now();
  run.watch = watched(id);
  running_.emplace(id, run);
  return true;
}

void Pool::add(const Record& record) {
  journal_.add(record);
  ++done_;
  if (!record.done()) ++short_;
}

/// Of a scratch folder that was not touched for long, others think that its run is dead.
void Pool::show_life() {
  if (Clock::now() < next_sign_) return;
  next_sign_ = Clock::now() + kSignOfLife;
  std::error_code error;
  fs::last_write_time(o_.scratch, fs::file_time_type::clock::now(), error);
}

void Pool::end_late_ones() {
  if (o_.timeout <= 0) return;
  for (auto& [id, run] : running_) {
    if (run.ended_by_us || seconds_since(run.begin) < o_.timeout) continue;
    run.ended_by_us = true;
    kill(id, SIGKILL);
  }
}

std::uintmax_t Pool::expected_memory(const Job& job) const {
  const auto known = bytes_per_byte_.find(job.command.front());
  const double factor = known == bytes_per_byte_.end() ? kFirstGuess : known->second;
  return kLeastMemory + static_cast<std::uintmax_t>(factor * static_cast<double>(job.state.bytes));
}

/// The most that was seen is expected of the next ones. Small files say little.
void Pool::learn(const Job& job, const Ended& ended) {
  const double peak = ended.peak_megabytes * 1048576 - static_cast<double>(kLeastMemory);
  if (job.state.bytes < 100'000 || peak <= 0) return;
  double& factor = bytes_per_byte_[job.command.front()];
  factor = std::max(factor, 1.2 * peak / static_cast<double>(job.state.bytes));
}

void Pool::show(std::size_t waiting) const {
  if (!o_.progress) return;
  std::string text = std::to_string(done_) + " of " + std::to_string(all_) + " done, " +
                     std::to_string(short_) + " with a reason";
  if (done_ > 0 && waiting > 0) {
    const double left =
        seconds_since(begin_) / static_cast<double>(done_) * static_cast<double>(all_ - done_);
    text += ", about " + std::to_string(static_cast<long>(left)) + " s left";
  }
  if (!running_.empty()) text += ": " + running_.begin()->second.job->name;
  o_.progress(text);
}

}  // namespace kaboum::batch
