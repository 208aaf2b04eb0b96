// Options that a library describes, on the command line.

#include "request_options.h"

#include <kaboum/base/error.h>

#include <CLI/CLI.hpp>
#include <memory>

namespace kaboum::tools {
namespace {

/// "Most bodies (1 to 100000) [64]", "Largest margin (metres, or with a unit, as in 5mm) [0.005]"
std::string text_of(const OptionDescription& option, const std::optional<std::string>& initial) {
  std::string out = with_dashes(option.text);
  if (const std::string facts = facts_of(option); !facts.empty()) out += " (" + facts + ")";
  if (!option.otherwise.empty())
    out += " [" + with_dashes(option.otherwise) + "]";
  else if (initial && !initial->empty() && option.kind != OptionDescription::Kind::Flag)
    out += " [" + *initial + "]";
  return out;
}

}  // namespace

void add_request_option(CLI::App& app, const OptionDescription& option,
                        const std::optional<std::string>& initial,
                        const std::function<void(const std::string&)>& assign) {
  const std::string name = "--" + option.name, text = text_of(option, initial);
  if (option.kind == OptionDescription::Kind::Flag) {
    app.add_flag_callback(
        name, [assign] { assign("true"); }, text);
    return;
  }
  if (!option.implied.empty()) {
    const auto stated = std::make_shared<std::string>();
    app.add_flag(name + '{' + option.implied + '}', *stated, text)
        ->check(CLI::Validator(
            [option](const std::string& value) { return flaw_of(option, value); }, ""))
        ->each([assign, stated](const std::string& value) { assign(value); })
        ->type_name(value_words(option));
    return;
  }
  const bool names = option.kind == OptionDescription::Kind::Names;
  if (is_repeated(option) || names) {
    CLI::Option* const added =
        app.add_option_function<std::vector<std::string>>(
               name,
               [name, assign, option](const std::vector<std::string>& parts) {
                 for (const std::string& part : parts)
                   if (part.find('\n') != std::string::npos)
                     throw CLI::ValidationError(
                         name, "a value with a line break; write it on one line, or a script");
                 const std::string value = option_text::of(parts, option);
                 const std::string flaw = flaw_of(option, value);
                 if (!flaw.empty()) throw CLI::ValidationError(name, flaw);
                 assign(value);
               },
               text)
            ->type_name(value_words(option));
    if (names) added->delimiter(',');
    if (names || option.kind == OptionDescription::Kind::Settings) added->allow_extra_args(false);
    return;
  }
  app.add_option_function<std::string>(name, assign, text)
      ->check([option](const std::string& value) { return flaw_of(option, value); })
      ->type_name(value_words(option));
}

std::string with_dashes(const std::string& text) {
  return meaning(text, [](const std::string& name) { return "--" + name; });
}

void require_none(const std::string& contradiction) {
  if (!contradiction.empty()) throw Error(ErrorCode::InvalidArgument, with_dashes(contradiction));
}

}  // namespace kaboum::tools
