#pragma once

#include <kaboum/base/option.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

/// Options that a library describes, on the command line.
namespace kaboum::tools {

/// Adds one option.
/// @param initial  its default value
/// @param assign   is given the value, where the option is stated and the value is sound
void add_request_option(CLI::App& app, const OptionDescription& option,
                        const std::optional<std::string>& initial,
                        const std::function<void(const std::string&)>& assign);

/// Adds all options of a request.
/// @param stated  gets the names of those that are stated
template <class Request>
void add_request_options(CLI::App& app, const std::vector<Option<Request>>& options,
                         Request& request, std::set<std::string>& stated) {
  for (const Option<Request>& option : options)
    add_request_option(app, option, default_of(option),
                       [&request, &stated, option](const std::string& value) {
                         option.assign(request, value);
                         stated.insert(option.name);
                       });
}

/// A library's words about options as command lines spell these: "{max-bodies}" as "--max-bodies".
std::string with_dashes(const std::string& text);

/// @param contradiction  why options do not go together; empty: they do
/// @throws Error{InvalidArgument}
void require_none(const std::string& contradiction);

}  // namespace kaboum::tools
