// The planner's side of external functions that another process answers, by JSON lines.
#include "asked_process.h"

#include <kaboum/base/error.h>
#include <kaboum/base/json_damage.h>

#include <algorithm>
#include <stdexcept>

namespace kaboum::external {
namespace {

using nlohmann::json;
using plan::Answer;
using plan::Question;

constexpr std::size_t kQuoted = 80;  ///< of a line that makes no sense [bytes]

std::string excerpt(const std::string& line) {
  return "'" + line.substr(0, kQuoted) + (line.size() > kQuoted ? "...'" : "'");
}

/// Things among which a call may choose.
constexpr std::uint64_t kMostChoices = 1'000'000;

std::string dump(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Of functions that said that they do not read it.
class NoState final : public plan::StateView {
 public:
  std::optional<std::string> value(const std::string& function,
                                   const std::vector<std::string>& /*arguments*/) override {
    refuse(function);
  }
  std::optional<bool> truth(const std::string& predicate,
                            const std::vector<std::string>& /*arguments*/) override {
    refuse(predicate);
  }
  bool has_term(const std::string& function,
                const std::vector<std::string>& /*arguments*/) override {
    refuse(function);
  }

 private:
  [[noreturn]] static void refuse(const std::string& name) {
    throw Error(ErrorCode::InvalidInput,
                "it reads '" + name + "', but is among the functions 'of_arguments' alone");
  }
};

}  // namespace

std::vector<std::pair<std::string, bool>> AskedProcess::functions() {
  double seconds = options_.most_seconds;
  std::string line;
  const json hello = receive(line, seconds);
  if (hello.is_object() && hello.contains("error") && hello["error"].is_string())
    fail(hello["error"].get<std::string>());
  std::vector<std::pair<std::string, bool>> out;
  bool good = hello.is_object() && hello.value("kaboum_externals", json()) == json(1);
  const auto add = [&](const char* member, bool reads_state) {
    const json names = good ? hello.value(member, json::array()) : json();
    good = good && names.is_array();
    for (const json& name : good ? names : json::array()) {
      good = good && name.is_string();
      if (good) out.emplace_back(name.get<std::string>(), reads_state);
      if (good &&
          std::ranges::count(out, out.back().first, &std::pair<std::string, bool>::first) > 1)
        fail("it offers the function '" + out.back().first + "' twice");
    }
  };
  add("functions", true);
  add("of_arguments", false);
  if (!good || out.empty())
    fail(R"(its first line is to be {"kaboum_externals": 1, "functions": ["NAME", ...]}, not )" +
         excerpt(line));
  return out;
}

plan::ExternalBindings AskedProcess::bindings(const std::shared_ptr<AskedProcess>& process) {
  plan::ExternalBindings out;
  for (const auto& [name, reads_state] : process->functions()) {
    const auto answer = [process, name = name, reads = reads_state](const Question& q) {
      NoState none;
      return process->ask(name, {q.arguments, reads ? q.state : none, q.seed, q.attempt, q.choice});
    };
    out[name] = plan::ExternalBinding(answer, reads_state);
  }
  return out;
}

Answer AskedProcess::ask(const std::string& function, const Question& question) {
  const std::lock_guard lock(mutex_);
  double seconds = options_.most_seconds;
  send({{"function", function},
        {"arguments",
         json(std::vector<std::string>(question.arguments.begin(), question.arguments.end()))},
        {"seed", question.seed},
        {"attempt", question.attempt},
        {"choice", question.choice}},
       seconds);
  for (;;) {
    std::string line;
    const json said = receive(line, seconds);
    if (!said.is_object()) fail("it answered " + excerpt(line) + ", which is no JSON object");
    if (said.contains("read") || said.contains("truth") || said.contains("term"))
      send(read(said, question.state, line), seconds);
    else
      return answer(said, line);
  }
}

void AskedProcess::fail(const std::string& what, ErrorCode code) {
  throw Error(code, name_ + ": " + what);
}

json AskedProcess::receive(std::string& line, double& seconds) {
  switch (channel_.lines().read_line(line, seconds)) {
    case LineSocket::ReadOutcome::Line:
      break;
    case LineSocket::ReadOutcome::End:
      fail(channel_.end() + " without an answer");
    case LineSocket::ReadOutcome::Late:
      channel_.end();
      fail("no answer within " + dump(options_.most_seconds) + " s; it was ended",
           ErrorCode::LimitReached);
    case LineSocket::ReadOutcome::TooLong:
      channel_.end();
      fail("it answered with a line of more than 16 MiB");
  }
  if (is_nested_too_deep(line))
    fail("it answered " + excerpt(line) + ", with " + describe_json_depth());
  json out = json::parse(line, nullptr, false);
  if (out.is_discarded()) fail("it answered " + excerpt(line) + ", which is no JSON");
  return out;
}

void AskedProcess::send(const json& message, double& seconds) {
  std::string line;
  try {
    line = message.dump();
  } catch (const json::type_error&) {  // replaced, two words would become one
    fail("it is told in UTF-8, which a word of the state or the arguments is not");
  }
  if (!channel_.lines().write_line(std::move(line), seconds))
    fail(channel_.end() + ", or reads nothing");
}

/// What it asks of the state.
json AskedProcess::read(const json& said, plan::StateView& state, const std::string& line) {
  const char* kind = said.contains("truth") ? "truth" : said.contains("term") ? "term" : "read";
  const json& name = said[kind];
  const json list = said.value("arguments", json::array());
  std::vector<std::string> arguments;
  if (list.is_array())
    for (const json& a : list)
      if (a.is_string()) arguments.push_back(a.get<std::string>());
  if (!name.is_string() || !list.is_array() || arguments.size() != list.size())
    fail("it asks what cannot be understood: " + excerpt(line));
  try {
    if (said.contains("term"))
      return {{"truth", state.has_term(name.get<std::string>(), arguments)}};
    if (said.contains("truth")) {
      const auto known = state.truth(name.get<std::string>(), arguments);
      return {{"truth", known ? json(*known) : json()}};
    }
    const auto known = state.value(name.get<std::string>(), arguments);
    return {{"value", known ? json(*known) : json()}};
  } catch (...) {
    // The call is over for whoever made it: the value is sensed only when the plan runs, or there
    // is no such term.
    double seconds = options_.most_seconds;
    channel_.lines().write_line(R"({"stop": true})", seconds);
    throw;
  }
}

Answer AskedProcess::answer(const json& said, const std::string& line) {
  const auto text = [&](const char* member) {
    if (!said[member].is_string())
      fail("in its answer '" + std::string(member) + "' is no text: " + excerpt(line));
    return said[member].get<std::string>();
  };
  std::size_t kinds = 0;
  for (const char* kind : {"value", "holds", "not_found", "impossible"})
    kinds += said.contains(kind) ? 1 : 0;
  if (said.contains("error")) throw std::runtime_error(text("error"));
  if (kinds != 1)
    fail(R"(an answer has one of "value", "holds", "not_found" and "impossible", not )" +
         excerpt(line));
  const auto flag = [&](const char* member) {
    if (!said.contains(member)) return false;
    if (!said[member].is_boolean())
      fail("'" + std::string(member) + "' is true or false, not " + excerpt(line));
    return said[member].get<bool>();
  };
  Answer out;
  if (said.contains("not_found")) {
    out = Answer::not_found(text("not_found"));
  } else if (said.contains("impossible")) {
    out = Answer::impossible(text("impossible"));
  } else if (said.contains("holds")) {
    out = Answer::holds(flag("holds"), said.contains("reason") ? text("reason") : "");
  } else {
    out = Answer::found(text("value"));
    if (said.contains("payload"))
      out.payload =
          said["payload"].is_string() ? said["payload"].get<std::string>() : dump(said["payload"]);
  }
  out.chosen = flag("chosen");
  out.listed = flag("listed");
  out.fixed = flag("fixed");
  if (said.contains("choices") && out.kind == Answer::Kind::Impossible)
    fail(
        "what is impossible is so whatever is chosen: 'choices' goes with a value or 'not_found', "
        "not with " +
        excerpt(line));
  if (said.contains("choices")) {
    if (!said["choices"].is_number_unsigned() ||
        said["choices"].get<std::uint64_t>() > kMostChoices)
      fail("'choices' is a whole number of at most " + std::to_string(kMostChoices) + ", not " +
           excerpt(line));
    out.choices = said["choices"].get<unsigned>();
  }
  return out;
}

}  // namespace kaboum::external
