#pragma once

#include <kaboum/base/error.h>
#include <kaboum/base/option.h>

#include <set>
#include <string>
#include <vector>

#include "bindings.h"

/// Options that a library describes, as keywords of Python.
namespace kaboum::python {

/// What every call that may take long is given besides.
struct RunKeywords {
  bool no_cache = false;
  int threads = 0;
  py::object progress = py::none();
};

/// A description and its default value.
struct Keyword {
  OptionDescription option;
  std::optional<std::string> initial;
};

template <class Request>
std::vector<Keyword> keywords_of(const std::vector<Option<Request>>& options) {
  std::vector<Keyword> out;
  for (const Option<Request>& option : options) out.push_back({option, default_of(option)});
  return out;
}

/// "max_bodies" of "max-bodies".
std::string with_underscores(const std::string& name);

/// The keyword of an option.
std::string keyword_of(const OptionDescription& option);

/// The digits of an int, also NumPy's; nullopt for all else, True and False too.
std::optional<std::string> whole_number(const py::handle& value);

/// The value of a keyword as text; nullopt for None.
/// @throws Error{InvalidArgument} naming the keyword: a value of another type, or a wrong one
std::optional<std::string> text_of(const OptionDescription& option, const py::object& value);

/// Keywords of RunKeywords that a function has.
enum class Runs {
  Briefly,  ///< none
  Alone,    ///< progress
  Threads,  ///< threads, progress
  Cached    ///< no_cache, threads, progress
};

/// Takes threads and progress out of keywords, and no_cache.
/// @throws py::type_error on other types
RunKeywords take_run_keywords(py::dict& keywords, Runs runs = Runs::Cached);

/// @throws py::type_error naming a keyword that nothing took, and one like it
void require_all_taken(const char* function, const py::dict& keywords,
                       const std::vector<Keyword>& known, Runs runs = Runs::Cached);

/// @param contradiction  why options do not go together; empty: they do
/// @throws Error{InvalidArgument}
void require_none(const std::string& contradiction);

/// Takes a request's options out of keywords.
/// @return the names of those that are stated
/// @throws Error{InvalidArgument} as text_of
template <class Request>
std::set<std::string> take_options(const std::vector<Option<Request>>& options, py::dict& keywords,
                                   Request& request) {
  std::set<std::string> stated;
  for (const Option<Request>& option : options) {
    const py::str name(keyword_of(option));
    if (!keywords.contains(name)) continue;
    if (const auto text = text_of(option, keywords[name])) {
      option.assign(request, *text);
      // As by default: nothing is stated.
      if (text != default_of(option)) stated.insert(option.name);
    }
    keywords.attr("pop")(name);
  }
  return stated;
}

/// Takes all keywords of a call.
/// @throws as take_options, take_run_keywords and require_all_taken
template <class Request>
RunKeywords take_keywords(const char* function, const std::vector<Option<Request>>& options,
                          py::dict keywords, Request& request, Runs runs) {
  take_options(options, keywords, request);
  RunKeywords out = take_run_keywords(keywords, runs);
  require_all_taken(function, keywords, keywords_of(options), runs);
  return out;
}

/// The keywords of two tables.
inline std::vector<Keyword> operator+(std::vector<Keyword> a, const std::vector<Keyword>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// A docstring: the signature in its first line, the text, and a section for the keywords in the
/// place of "{keywords}".
/// @param positional  parameters before the options: "mesh: object"; keywords after "*"
/// @param result      the type of what is returned
std::string document(const std::string& function, const std::string& positional,
                     const std::vector<Keyword>& keywords, const std::string& result,
                     const std::string& text, Runs runs = Runs::Cached);

/// The table of a function's keywords, for stub and reference: a list of dicts.
py::list table_of(const std::vector<Keyword>& keywords);

}  // namespace kaboum::python
