// Any lines of a program that answers external functions make functions, and answers to calls of
// them, or throw Error; what the program says went wrong is thrown as std::runtime_error. Later
// lines ask for the state, or answer.

#include <sys/socket.h>
#include <unistd.h>

#include "../../libexternal/src/asked_process.h"
#include "fuzz.h"

namespace {

using namespace kaboum;

/// Has terms and atoms by the lengths of their names: some are not known, some not there.
struct State final : plan::StateView {
  std::optional<std::string> value(const std::string& function,
                                   const std::vector<std::string>& arguments) override {
    if (!is_known(function)) return std::nullopt;
    return arguments.empty() ? "\xff is no UTF-8" : arguments.front();
  }
  std::optional<bool> truth(const std::string& predicate,
                            const std::vector<std::string>& arguments) override {
    return is_known(predicate) ? std::optional(arguments.empty()) : std::nullopt;
  }
  bool has_term(const std::string& function,
                const std::vector<std::string>& /*arguments*/) override {
    return function.size() % 4 != 3;
  }

 private:
  static bool is_known(const std::string& name) {
    if (name.size() % 4 == 3) throw Error(ErrorCode::InvalidInput, "no term of that name");
    return name.size() % 4 != 2;
  }
};

void look_at(const plan::Answer& answer) {
  const bool found = answer.kind == plan::Answer::Kind::Value;
  if (!found && (!answer.value.empty() || !answer.payload.empty()))
    fuzz::broken("no value", answer.value + answer.payload);
}

void call_all(int socket) {
  const external::ProcessOptions options{1};
  const plan::ExternalBindings all = external::AskedProcess::bindings(
      std::make_shared<external::AskedProcess>("fuzz", options, socket));
  if (all.empty()) fuzz::broken("functions", "none");
  State state;
  const std::vector<std::string> arguments{"o1"};
  for (unsigned attempt = 0;; ++attempt)  // until the lines end
    for (const auto& entry : all) try {
        look_at(entry.second({arguments, state, 1, attempt}));
      } catch (const Error&) {
        throw;
      } catch (const std::runtime_error&) {
        continue;  // the program's own error
      }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) fuzz::broken("socketpair", "failed");
  static_cast<void>(send(ends[1], data, size, MSG_DONTWAIT));  // what it holds
  shutdown(ends[1], SHUT_WR);
  fuzz::survive([&] { call_all(ends[0]); });
  close(ends[1]);
  return 0;
}
