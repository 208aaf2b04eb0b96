// What is said when a signal ends the program: the handler writes a text that is ready, and lets
// the signal do its work.

#include "last_words.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>

namespace kaboum::tools {
namespace {

/// Texts that were set stay where they are: a handler may be writing one.
struct Text {
  std::array<char, 1024> characters{};
  std::size_t size = 0;
};
std::array<Text, 2> texts;
std::atomic<const Text*> current = nullptr;
static_assert(std::atomic<const Text*>::is_always_lock_free);

void end(int signal) {
  if (const Text* text = current.load()) {
    ssize_t written = ::write(STDERR_FILENO, text->characters.data(), text->size);
    static_cast<void>(written);
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void handle(void (*handler)(int)) {
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction before {};
    ::sigaction(signal, nullptr, &before);
    if (before.sa_handler == SIG_IGN) continue;  // as nohup and `&` of shells ask for
    struct sigaction action {};
    action.sa_handler = handler;
    ::sigaction(signal, &action, nullptr);
  }
}

}  // namespace

LastWords::LastWords(bool quiet) : active_(!quiet) {
  if (active_) handle(end);
}

LastWords::~LastWords() {
  if (!active_) return;
  handle(SIG_DFL);
  current.store(nullptr);
}

void LastWords::set(const std::string& text) {
  if (!active_) return;
  Text& other = texts[current.load() == texts.data() ? 1 : 0];
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  const std::string whole = (terminal ? "\r\033[K" : "") + text;
  other.size = std::min(whole.size(), other.characters.size() - 1);
  std::memcpy(other.characters.data(), whole.data(), other.size);
  other.characters[other.size++] = '\n';
  current.store(&other);
}

}  // namespace kaboum::tools
