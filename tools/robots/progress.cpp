// How far the work on a robot's meshes is: a line that is rewritten on a terminal, one now and then
// elsewhere, and one for Ctrl-C.

#include "progress.h"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <numeric>

namespace kaboum::tools {
namespace {

/// Where there is no terminal, so often something is said. [s]
constexpr double kSilence = 30;

double seconds(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

/// "40 s", "3 min", "2 h"
std::string time_text(double s) {
  if (s < 90) return std::to_string(static_cast<int>(s)) + " s";
  if (s < 5400) return std::to_string(std::lround(s / 60)) + " min";
  return std::to_string(std::lround(s / 3600)) + " h";
}

/// Whether there is no terminal that shows more, and nothing was said for long; then it is now.
bool is_time_to_speak(std::chrono::steady_clock::time_point& said) {
  const auto now = std::chrono::steady_clock::now();
  if (::isatty(STDERR_FILENO) == 1 || seconds(now - said) < kSilence) return false;
  said = now;
  return true;
}

}  // namespace

MeshProgress::MeshProgress(const std::string& program, bool quiet, const robot::LinkMeshes& meshes,
                           bool kept)
    : program_(program), quiet_(quiet), kept_(kept), progress_(quiet), words_(quiet) {
  for (const robot::LinkMesh& mesh : meshes.meshes) {
    std::error_code error;
    const auto size = std::filesystem::file_size(mesh.file, error);
    names_.push_back(mesh.file.filename().string());
    sizes_.push_back(error ? 1.0 : static_cast<double>(size) + 1);
  }
  say_end();
}

std::string MeshProgress::show(const std::string& stage) {
  std::string line = stage;
  if (done_ < names_.size())
    line = std::to_string(done_ + 1) + " of " + std::to_string(names_.size()) +
           (names_.size() == 1 ? " mesh: " : " meshes: ") + names_[done_] + ": " + stage;
  line += ", " + time_text(seconds(Clock::now() - begin_)) + time_left();
  progress_.show(line);
  if (is_time_to_speak(said_)) log(quiet_, line);
  return line;
}

void MeshProgress::made(bool cached) {
  const Clock::time_point now = Clock::now();
  if (!cached && done_ < sizes_.size()) {
    worked_ += sizes_[done_];
    worked_seconds_ += seconds(now - last_);
  }
  last_ = now;
  ++done_;
  progress_.show("");
  say_end();
  if (done_ >= names_.size() || !is_time_to_speak(said_)) return;
  log(quiet_, std::to_string(done_) + " of " + std::to_string(names_.size()) +
                  " meshes are done, " + time_text(seconds(now - begin_)) + time_left());
}

void MeshProgress::other(const std::string& stage, const std::string& left) {
  progress_.show(stage);
  words_.set(program_ + ": ended by a signal; " + left);
}

/// By the sizes of the files, from two meshes on.
std::string MeshProgress::time_left() const {
  if (done_ < 2 || !(worked_ > 0) || done_ >= sizes_.size()) return {};
  const double left =
      std::accumulate(sizes_.begin() + static_cast<std::ptrdiff_t>(done_), sizes_.end(), 0.0);
  return "; perhaps " + time_text(left * worked_seconds_ / worked_) + " left";
}

void MeshProgress::say_end() {
  words_.set(program_ + ": ended by a signal; " + std::to_string(done_) + " of " +
             std::to_string(names_.size()) + (names_.size() == 1 ? " mesh " : " meshes ") +
             (done_ == 1 ? "is" : "are") + " done, and nothing is written. " +
             (kept_ ? "The cache keeps them: the same command goes on there"
                    : "Nothing is kept (--no-cache)"));
}

SearchProgress::SearchProgress(const std::string& program, bool quiet, const std::string& what,
                               bool kept)
    : what_(what), quiet_(quiet), progress_(quiet), words_(quiet) {
  words_.set(program + ": ended by a signal while it was looking for " + what +
             "; nothing is written. " +
             (kept ? "The cache keeps what was tried: the same command is through with that at once"
                   : "Nothing is kept (--no-cache)"));
  if (::isatty(STDERR_FILENO) != 1) log(quiet, "looking for " + what + ", by some ten runs");
}

void SearchProgress::show(const std::string& stage) {
  const std::string line =
      "looking for " + what_ + ", " + time_text(seconds(Clock::now() - begin_)) + ": " + stage;
  progress_.show(line);
  if (is_time_to_speak(said_)) log(quiet_, line);
}

}  // namespace kaboum::tools
