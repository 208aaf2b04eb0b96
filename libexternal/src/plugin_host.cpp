// The other side of a plug-in's functions: the shared library is loaded here, and asked.
#include "plugin_host.h"

#include <dlfcn.h>
#include <kaboum/base/error.h>
#include <kaboum/external/plugin.h>

#include <exception>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace kaboum::external {
namespace {

using nlohmann::json;
using plan::Answer;

constexpr double kForever = 1e9;  // the planner's side has the limit [s]

/// Thrown through a function whose call is over: it read what may not be told.
struct CallOver {};

/// What is no UTF-8 is replaced, as of sentences.
bool write(LineSocket& lines, const json& message) {
  double seconds = kForever;
  return lines.write_line(message.dump(-1, ' ', false, json::error_handler_t::replace), seconds);
}

/// Words and payloads are not replaced: two words would become one.
/// @throws std::runtime_error
void require_utf8(const std::string& text, const char* what) {
  try {
    static_cast<void>(json(text).dump());
  } catch (const json::type_error&) {
    throw std::runtime_error(std::string(what) + " is not UTF-8");
  }
}

bool read(LineSocket& lines, json& message) {
  double seconds = kForever;
  std::string line;
  if (lines.read_line(line, seconds) != LineSocket::ReadOutcome::Line) return false;
  message = json::parse(line, nullptr, false);
  return message.is_object();
}

/// The state, which the planner's side reads.
class DistantState final : public plan::StateView {
 public:
  explicit DistantState(LineSocket& lines) : lines_(lines) {}

  std::optional<std::string> value(const std::string& function,
                                   const std::vector<std::string>& arguments) override {
    const json said = ask({{"read", function}, {"arguments", arguments}}).at("value");
    return said.is_null() ? std::nullopt : std::optional(said.get<std::string>());
  }
  std::optional<bool> truth(const std::string& predicate,
                            const std::vector<std::string>& arguments) override {
    const json said = ask({{"truth", predicate}, {"arguments", arguments}}).at("truth");
    return said.is_null() ? std::nullopt : std::optional(said.get<bool>());
  }
  bool has_term(const std::string& function, const std::vector<std::string>& arguments) override {
    return ask({{"term", function}, {"arguments", arguments}}).at("truth").get<bool>();
  }
  [[nodiscard]] bool over() const { return over_; }

 private:
  json ask(const json& question) {
    json said;
    if (!over_) over_ = !write(lines_, question) || !read(lines_, said) || said.contains("stop");
    if (over_) throw CallOver();
    return said;
  }

  LineSocket& lines_;
  bool over_ = false;
};

json message_of_kind(const Answer& answer) {
  switch (answer.kind) {
    case Answer::Kind::NotFound:
      return {{"not_found", answer.reason}};
    case Answer::Kind::Impossible:
      return {{"impossible", answer.reason}};
    case Answer::Kind::Value:
      break;
  }
  if (answer.value.empty() && answer.payload.empty()) return {{"holds", true}};
  require_utf8(answer.value, "the value that it returned");
  require_utf8(answer.payload, "the payload that it returned");
  json out = {{"value", answer.value}};
  if (!answer.payload.empty()) out["payload"] = answer.payload;
  return out;
}

json message_of(const Answer& answer) {
  json out = message_of_kind(answer);
  for (const auto& [name, set] :
       {std::pair("chosen", answer.chosen), {"listed", answer.listed}, {"fixed", answer.fixed}})
    if (set) out[name] = true;
  if (answer.choices > 0 && answer.kind != Answer::Kind::Impossible)
    out["choices"] = answer.choices;
  return out;
}

/// @return false: nobody asks any more.
bool answer(const plan::ExternalBindings& bindings, LineSocket& lines) {
  json asked;
  if (!read(lines, asked)) return false;
  if (asked.contains("stop")) return true;
  const auto function = bindings.find(asked.at("function").get<std::string>());
  const auto arguments = asked.at("arguments").get<std::vector<std::string>>();
  DistantState state(lines);
  json said;
  try {
    said = message_of(function->second({arguments, state, asked.at("seed").get<std::uint64_t>(),
                                        asked.at("attempt").get<unsigned>(),
                                        asked.at("choice").get<unsigned>()}));
  } catch (const CallOver&) {
    return true;
  } catch (const std::exception& error) {
    said = {{"error", error.what()}};
  } catch (...) {
    said = {{"error", "it threw what is no std::exception"}};
  }
  return state.over() || write(lines, said);
}

/// @throws Error{InvalidInput} when it cannot be loaded, or binds nothing.
plan::ExternalBindings bindings_of(const std::string& file) {
  const auto fail = [](const std::string& what) { throw Error(ErrorCode::InvalidInput, what); };
  // A name without a slash would be looked for in the system's folders.
  const std::string path = file.find('/') == std::string::npos ? "./" + file : file;
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) fail(std::string("cannot be loaded: ") + dlerror());
  using Entry = void (*)(plan::ExternalBindings&);
  const auto entry = reinterpret_cast<Entry>(dlsym(library, kPluginEntry));
  if (entry == nullptr)
    fail(std::string("has no function ") + kPluginEntry + " (docs/planning/externals.md)");
  plan::ExternalBindings out;
  try {
    entry(out);
  } catch (const std::exception& error) {
    fail(std::string(kPluginEntry) + " failed: " + error.what());
  } catch (...) {
    fail(std::string(kPluginEntry) + " failed: it threw what is no std::exception");
  }
  if (out.empty()) fail(std::string(kPluginEntry) + " binds no functions");
  return out;
}

}  // namespace

void serve_plugin(const std::string& file, LineSocket& lines) {
  plan::ExternalBindings bindings;
  try {
    bindings = bindings_of(file);
  } catch (const std::exception& error) {
    write(lines, {{"error", error.what()}});
    return;
  }
  json hello = {
      {"kaboum_externals", 1}, {"functions", json::array()}, {"of_arguments", json::array()}};
  for (const auto& [name, function] : bindings)
    hello[function.reads_state() ? "functions" : "of_arguments"].push_back(name);
  write(lines, hello);
  while (answer(bindings, lines)) {
  }
}

}  // namespace kaboum::external
