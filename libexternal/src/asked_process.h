#pragma once

#include <kaboum/base/error.h>
#include <kaboum/external/process.h>

#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include <kaboum/external/line_channel.h>

namespace kaboum::external {

/// A process that answers external functions (docs/planning/externals.md).
class AskedProcess {
 public:
  /// @param name     of it in messages: "program 'sh f.sh'".
  /// @param channel  how it is started.
  template <class... Channel>
  AskedProcess(std::string name, const ProcessOptions& options, Channel&&... channel)
      : name_(std::move(name)), options_(options), channel_(std::forward<Channel>(channel)...) {}

  /// Those of its first line, of arguments alone or with the state.
  /// @throws Error{InvalidInput}, also what the line says went wrong.
  static plan::ExternalBindings bindings(const std::shared_ptr<AskedProcess>& process);

  /// @throws Error{InvalidInput} when it ends or answers what is no answer, Error{LimitReached} if
  ///   it takes too long (it is ended then), std::runtime_error of what it says went wrong.
  plan::Answer ask(const std::string& function, const plan::Question& question);

 private:
  /// Their names, and whether they ask for the state.
  std::vector<std::pair<std::string, bool>> functions();
  [[noreturn]] void fail(const std::string& what, ErrorCode code = ErrorCode::InvalidInput);
  nlohmann::json receive(std::string& line, double& seconds);
  void send(const nlohmann::json& message, double& seconds);
  /// What it asks of the state.
  nlohmann::json read(const nlohmann::json& said, plan::StateView& state, const std::string& line);
  plan::Answer answer(const nlohmann::json& said, const std::string& line);

  std::string name_;
  ProcessOptions options_;
  LineChannel channel_;
  std::mutex mutex_;
};

}  // namespace kaboum::external
