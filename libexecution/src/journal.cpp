// Journals of runs: written line by line, and read again.

#include "journal.h"

#include <kaboum/base/error.h>
#include <kaboum/base/json_damage.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <csignal>
#include <ctime>
#include <utility>
#include <vector>

namespace kaboum::execution {
namespace {

using nlohmann::json;

/// While it lives, a pipe that nobody reads any more is an error of who writes, and no signal that
/// ends the program: the driver is to be stopped first.
class BrokenPipeIsAnError {
 public:
  BrokenPipeIsAnError() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    sigset_t waiting{};
    sigpending(&waiting);
    was_waiting_ = sigismember(&waiting, SIGPIPE) == 1;
    pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~BrokenPipeIsAnError() {
    const timespec now{};
    if (!was_waiting_) sigtimedwait(&pipe_, nullptr, &now);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  BrokenPipeIsAnError(const BrokenPipeIsAnError&) = delete;
  BrokenPipeIsAnError& operator=(const BrokenPipeIsAnError&) = delete;

 private:
  sigset_t pipe_{}, before_{};
  bool was_waiting_ = false;
};

}  // namespace

std::string dump(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

Journal::Journal(const DriverOptions& options) : name_(options.journal), noted_(options.noted) {
  if (name_.empty()) return;
  file_.open(name_);
  if (!file_) throw Error(ErrorCode::OutputFailed, name_ + ": cannot be written");
}

void Journal::note(const json& entry) {
  if (is_kept()) add(dump(entry));
}

void Journal::note_text(const char* name, const std::string& json) {
  if (!is_kept()) return;
  std::string entry = std::string("{\"") + name + "\":\"";
  entry.reserve(json.size() + json.size() / 4 + 64);
  // JSON has no signs that cannot be in a text but these; between them it is copied as it is.
  std::size_t from = 0, quote = json.find('"'), slash = json.find('\\');
  for (std::size_t at = std::min(quote, slash); at != std::string::npos;
       at = std::min(quote, slash)) {
    entry.append(json, from, at - from) += '\\';
    from = at;
    if (at == quote) quote = json.find('"', at + 1);
    if (at == slash) slash = json.find('\\', at + 1);
  }
  entry.append(json, from);
  entry += "\"}";
  add(std::move(entry));
}

void Journal::add(std::string entry) {
  if (!is_kept()) return;
  const double t = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  entry.pop_back();
  entry += ",\"t\":" + dump(t) + "}";
  if (file_.is_open()) {
    const BrokenPipeIsAnError held;
    file_ << entry << std::endl;  // NOLINT(performance-avoid-endl)
    if (!file_) {
      file_.close();  // what it still has would be written when it is closed later
      throw Error(ErrorCode::OutputFailed, name_ + ": cannot be written");
    }
  }
  if (noted_) noted_(entry);
}

void refuse_journal(const std::string& file, std::size_t number, const std::string& what) {
  throw Error(ErrorCode::InvalidInput, file + ", line " + std::to_string(number) + ": " + what +
                                           "; a journal is what a run wrote («journal»)");
}

void read_journal(const std::string& file,
                  const std::function<void(std::string, json, std::size_t)>& entry) {
  const std::vector<char> bytes = io::read_file(file);
  std::string line;
  std::size_t number = 0;
  for (const char c : bytes) {
    if (c != '\n') {
      line += c;
      continue;
    }
    ++number;
    if (is_nested_too_deep(line)) refuse_journal(file, number, "has " + describe_json_depth());
    json read = json::parse(line, nullptr, false);
    if (!read.is_object()) refuse_journal(file, number, "is no JSON object");
    if (number == 1 && (!read.contains("kaboum_journal") || read["kaboum_journal"] != 1))
      refuse_journal(file, number, R"(is not {"kaboum_journal": 1, ...})");
    entry(std::move(line), std::move(read), number);
    line.clear();
  }
  if (number == 0) refuse_journal(file, 1, "is empty");
}

}  // namespace kaboum::execution
