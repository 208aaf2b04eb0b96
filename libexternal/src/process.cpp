// External functions of another program, asked by JSON lines.

#include <kaboum/base/error.h>
#include <kaboum/external/process.h>

#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>

#include "line_channel.h"

namespace kaboum::external {
namespace {

using nlohmann::json;
using plan::Answer;
using plan::Question;

constexpr std::size_t kQuoted = 80;  ///< of a line that makes no sense [bytes]

std::string excerpt(const std::string& line) {
  return "'" + line.substr(0, kQuoted) + (line.size() > kQuoted ? "...'" : "'");
}

std::string dump(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

class Process {
 public:
  Process(const std::string& command, const ProcessOptions& options)
      : command_(command), options_(options), channel_(command) {}

  /// Its first line.
  std::vector<std::string> functions() {
    double seconds = options_.most_seconds;
    std::string line;
    const json hello = receive(line, seconds);
    std::vector<std::string> out;
    if (hello.is_object() && hello.value("kaboum_externals", json()) == json(1) &&
        hello.contains("functions") && hello["functions"].is_array())
      for (const json& name : hello["functions"])
        if (name.is_string()) out.push_back(name.get<std::string>());
    if (out.empty() || out.size() != hello.at("functions").size())
      fail(R"(its first line is to be {"kaboum_externals": 1, "functions": ["NAME", ...]}, not )" +
           excerpt(line));
    return out;
  }

  Answer ask(const std::string& function, const Question& question) {
    const std::lock_guard lock(mutex_);
    double seconds = options_.most_seconds;
    send({{"function", function},
          {"arguments",
           json(std::vector<std::string>(question.arguments.begin(), question.arguments.end()))},
          {"seed", question.seed},
          {"attempt", question.attempt}},
         seconds);
    for (;;) {
      std::string line;
      const json said = receive(line, seconds);
      if (!said.is_object()) fail("it answered " + excerpt(line) + ", which is no JSON object");
      if (said.contains("read") || said.contains("truth"))
        send(read(said, question.state, line), seconds);
      else
        return answer(said, line);
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what, ErrorCode code = ErrorCode::InvalidInput) {
    throw Error(code, "program '" + command_ + "': " + what);
  }

  json receive(std::string& line, double& seconds) {
    switch (channel_.read_line(line, seconds)) {
      case LineChannel::Got::Line:
        break;
      case LineChannel::Got::End:
        fail(channel_.end() + " without an answer");
      case LineChannel::Got::Late:
        channel_.end();
        fail("no answer within " + dump(options_.most_seconds) + " s; it was ended",
             ErrorCode::LimitReached);
      case LineChannel::Got::TooLong:
        channel_.end();
        fail("it answered with a line of more than 16 MiB");
    }
    json out = json::parse(line, nullptr, false);
    if (out.is_discarded()) fail("it answered " + excerpt(line) + ", which is no JSON");
    return out;
  }

  void send(const json& message, double& seconds) {
    if (!channel_.write_line(dump(message), seconds)) fail(channel_.end() + ", or reads nothing");
  }

  /// What it asks of the state.
  json read(const json& said, plan::StateView& state, const std::string& line) {
    const bool truth = said.contains("truth");
    const json& name = said[truth ? "truth" : "read"];
    const json list = said.value("arguments", json::array());
    std::vector<std::string> arguments;
    if (list.is_array())
      for (const json& a : list)
        if (a.is_string()) arguments.push_back(a.get<std::string>());
    if (!name.is_string() || !list.is_array() || arguments.size() != list.size())
      fail("it asks what cannot be understood: " + excerpt(line));
    try {
      if (truth) {
        const auto known = state.truth(name.get<std::string>(), arguments);
        return {{"truth", known ? json(*known) : json()}};
      }
      const auto known = state.value(name.get<std::string>(), arguments);
      return {{"value", known ? json(*known) : json()}};
    } catch (...) {
      // The call is over for whoever made it: the value is sensed only when the plan runs, or there
      // is no such term.
      double seconds = options_.most_seconds;
      channel_.write_line(R"({"stop": true})", seconds);
      throw;
    }
  }

  Answer answer(const json& said, const std::string& line) {
    const auto text = [&](const char* member) {
      if (!said[member].is_string())
        fail("in its answer '" + std::string(member) + "' is no text: " + excerpt(line));
      return said[member].get<std::string>();
    };
    std::size_t kinds = 0;
    for (const char* kind : {"value", "holds", "not_found", "impossible"})
      kinds += said.contains(kind) ? 1 : 0;
    if (kinds != 1)
      fail(R"(an answer has one of "value", "holds", "not_found" and "impossible", not )" +
           excerpt(line));
    if (said.contains("not_found")) return Answer::not_found(text("not_found"));
    if (said.contains("impossible")) return Answer::impossible(text("impossible"));
    if (said.contains("holds")) {
      if (!said["holds"].is_boolean()) fail("'holds' is true or false, not " + excerpt(line));
      return Answer::holds(said["holds"].get<bool>(),
                           said.contains("reason") ? text("reason") : "");
    }
    std::string payload;
    if (said.contains("payload"))
      payload =
          said["payload"].is_string() ? said["payload"].get<std::string>() : dump(said["payload"]);
    return Answer::found(text("value"), std::move(payload));
  }

  std::string command_;
  ProcessOptions options_;
  LineChannel channel_;
  std::mutex mutex_;
};

}  // namespace

plan::ExternalBindings start_process(const std::string& command, const ProcessOptions& options) {
  if (!(options.most_seconds > 0))
    throw Error(ErrorCode::InvalidArgument, "the time for an answer is not above 0");
  const auto process = std::make_shared<Process>(command, options);
  plan::ExternalBindings out;
  for (const std::string& name : process->functions())
    out[name] = [process, name](const Question& question) { return process->ask(name, question); };
  return out;
}

}  // namespace kaboum::external
