// Options that a library describes, as keywords of Python.

#include "request_options.h"

#include <kaboum/base/similar_name.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "arguments.h"

namespace kaboum::python {
namespace {

using Kind = OptionDescription::Kind;

constexpr std::size_t kWidth = 96;  ///< of lines of docstrings

[[noreturn]] void refuse(const OptionDescription& option, const std::string& what,
                         const py::object& value) {
  throw Error(ErrorCode::InvalidArgument, keyword_of(option) + " must be " + what + ", not " +
                                              py::repr(value).cast<std::string>());
}

/// Of Python's kind, in words.
const char* type_words(const OptionDescription& option) {
  switch (option.kind) {
    case Kind::Flag:
      return "bool";
    case Kind::Count:
      return "int";
    case Kind::Counts:
      return "int or sequence of int";
    case Kind::Number:
      return "float";
    case Kind::Memory:
      return "int or str";
    case Kind::Length:
      return "float or str";
    case Kind::Files:
      return "path or sequence of paths";
    case Kind::Names:
      return "str or sequence of str";
    case Kind::Settings:
      return option.absolute ? "float, str or dict" : option.for_all ? "float or dict" : "dict";
    case Kind::Choice:
      if (!option.implied.empty()) return "bool or str";
      break;
    case Kind::Text:
      break;
  }
  return "str";
}

std::string text_of_counts(const OptionDescription& option, const py::object& value) {
  if (const auto digits = whole_number(value)) return *digits;
  const char* what = "an int or a sequence of them";
  if (py::isinstance<py::str>(value) || !py::isinstance<py::iterable>(value))
    refuse(option, what, value);
  std::string out;
  for (const py::handle one : value) {
    const auto digits = whole_number(one);
    if (!digits) refuse(option, what, value);
    out.append(out.empty() ? "" : ",").append(*digits);
  }
  return out;
}

/// The lines of texts: of one, or of a sequence.
/// @param may_be_path  os.PathLike, too
std::string text_of_texts(const OptionDescription& option, const py::object& value,
                          bool may_be_path) {
  const char* what = may_be_path ? "a path or a sequence of paths" : "a str or a sequence of str";
  const auto line = [&](const py::object& one) -> std::optional<std::string> {
    if (!py::isinstance<py::str>(one) && !may_be_path) return std::nullopt;
    const auto text = path_of(one);
    // An empty text is no name and no folder; an end of line would make two of one.
    if (!text || text->empty() || text->find('\n') != std::string::npos) return std::nullopt;
    return *text + '\n';
  };
  if (const auto one = line(value)) return *one;
  if (py::isinstance<py::str>(value) || py::isinstance<py::dict>(value) ||
      !py::isinstance<py::iterable>(value))
    refuse(option, what, value);
  std::string out;
  for (const py::handle one : value) {
    const auto text = line(py::reinterpret_borrow<py::object>(one));
    if (!text) refuse(option, what, value);
    out += *text;
  }
  return out;
}

std::string text_of_settings(const OptionDescription& option, const py::object& value) {
  const char* what = option.absolute  ? "a length, or a dict of names and lengths"
                     : option.for_all ? "a number, or a dict of names and numbers"
                                      : "a dict of names and numbers";
  // A number or, of lengths, a text such as '5mm'.
  const auto text_of_one = [&](const py::handle& one) -> std::optional<std::string> {
    if (option.absolute && py::isinstance<py::str>(one)) {
      auto text = one.cast<std::string>();
      if (text.find_first_of("=\n") != std::string::npos) refuse(option, what, value);
      return text;
    }
    const auto number = number_of(one);
    return number ? std::optional(option_text::of(*number)) : std::nullopt;
  };
  if (const auto one = option.for_all ? text_of_one(value) : std::nullopt) return *one + '\n';
  if (!py::isinstance<py::dict>(value)) refuse(option, what, value);
  std::string out;
  for (const auto& [name, number] : value.cast<py::dict>()) {
    const auto given = text_of_one(number);
    if (!py::isinstance<py::str>(name) || !given) refuse(option, what, value);
    const auto key = name.cast<std::string>();
    if (key.find('\n') != std::string::npos) refuse(option, what, value);
    out += (key.empty() && option.for_all ? key : key + '=') + *given + '\n';
  }
  return out;
}

/// A default as Python writes it.
std::string literal(const Keyword& keyword) {
  if (!keyword.initial) return keyword.option.implied.empty() ? "None" : "False";
  switch (keyword.option.kind) {
    case Kind::Flag:
      return *keyword.initial == "true" ? "True" : "False";
    case Kind::Count:
      return *keyword.initial;
    case Kind::Length:
      if (!keyword.option.absolute) break;
      [[fallthrough]];
    case Kind::Number: {
      double value = 0;
      option_text::parse(*keyword.initial, value);
      return py::repr(py::float_(value)).cast<std::string>();
    }
    default:
      break;
  }
  return py::repr(py::str(*keyword.initial)).cast<std::string>();
}

/// `text` in lines after `indent` blanks.
std::string wrapped(const std::string& text, std::size_t indent) {
  std::istringstream words(text);
  std::string out, line(indent, ' '), word;
  while (words >> word) {
    if (line.size() + 1 + word.size() > kWidth && line.size() > indent) {
      out += line + "\n";
      line.assign(indent, ' ');
    }
    line += (line.size() > indent ? " " : "") + word;
  }
  return out + line + "\n";
}

std::string entry_of(const Keyword& keyword) {
  const OptionDescription& o = keyword.option;
  const auto spelled = [](const std::string& text) { return meaning(text, with_underscores); };
  std::string text = spelled(o.text);
  if (const std::string facts = facts_of(o); !facts.empty()) text += " (" + facts + ")";
  text += '.';
  if (!o.otherwise.empty()) text += " By default " + spelled(o.otherwise) + ".";
  return keyword_of(o) + " : " + type_words(o) + (keyword.initial ? "" : ", optional") + "\n" +
         wrapped(text, 4);
}

constexpr const char* kCacheEntry =
    R"(no_cache : bool
    Neither use nor store results of earlier runs ($KABOUM_CACHE, else $XDG_CACHE_HOME/kaboum, else
    ~/.cache/kaboum).
)";
constexpr const char* kThreadsEntry =
    R"(threads : int
    0: one per core. The result is the same for any number.
)";
constexpr const char* kProgressEntry =
    R"(progress : callable, optional
    Called with what is being done; what it raises ends the work, as Ctrl-C does.
)";

}  // namespace

std::string with_underscores(const std::string& name) {
  std::string out = name;
  std::replace(out.begin(), out.end(), '-', '_');
  return out;
}

std::string keyword_of(const OptionDescription& option) {
  return with_underscores(option.plural.empty() ? option.name : option.plural);
}

std::optional<std::string> whole_number(const py::handle& value) {
  if (PyBool_Check(value.ptr()) || PyIndex_Check(value.ptr()) == 0) return std::nullopt;
  const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
  if (!index) {  // arrays of several numbers
    PyErr_Clear();
    return std::nullopt;
  }
  return py::str(index).cast<std::string>();
}

std::optional<std::string> text_of(const OptionDescription& option, const py::object& value) {
  if (value.is_none()) return std::nullopt;
  std::string text;
  const bool is_text = py::isinstance<py::str>(value);
  switch (option.kind) {
    case Kind::Flag:
      if (!py::isinstance<py::bool_>(value)) refuse(option, "True or False", value);
      text = value.cast<bool>() ? "true" : "false";
      break;
    case Kind::Count:
      if (const auto digits = whole_number(value))
        text = *digits;
      else
        refuse(option, "an int", value);
      break;
    case Kind::Counts:
      text = text_of_counts(option, value);
      break;
    case Kind::Number:
      if (const auto given = number_of(value))
        text = option_text::of(*given);
      else
        refuse(option, "a number", value);
      break;
    case Kind::Memory:
      if (is_text)
        text = value.cast<std::string>();
      else if (const auto digits = whole_number(value))
        text = *digits;
      else
        refuse(option, "a number of bytes, or a size such as '500M'", value);
      break;
    case Kind::Length:
      if (is_text)
        text = value.cast<std::string>();
      else if (const auto given = number_of(value))
        text = option_text::of(*given);
      else if (option.absolute)
        refuse(option, "a positive number, or a length such as '5mm'", value);
      else
        refuse(option,
               "a positive number, a length such as '5mm', or a percentage of the diagonal such as "
               "'0.5%'",
               value);
      break;
    case Kind::Files:
    case Kind::Names:
      text = text_of_texts(option, value, option.kind == Kind::Files);
      if (text.empty()) return std::nullopt;
      break;
    case Kind::Settings:
      text = text_of_settings(option, value);
      if (text.empty()) return std::nullopt;
      break;
    case Kind::Choice:
      if (!option.implied.empty() && py::isinstance<py::bool_>(value)) {
        if (!value.cast<bool>()) return std::nullopt;
        text = option.implied;
        break;
      }
      if (!option.implied.empty() && !is_text) refuse(option, "True, False or a str", value);
      [[fallthrough]];
    case Kind::Text:
      if (!is_text) refuse(option, "a str", value);
      text = value.cast<std::string>();
      break;
  }
  if (const std::string flaw = flaw_of(option, text); !flaw.empty())
    throw Error(ErrorCode::InvalidArgument, keyword_of(option) + " " + flaw);
  return text;
}

RunKeywords take_run_keywords(py::dict& keywords, Runs runs) {
  RunKeywords out;
  const auto take = [&](const char* name) -> py::object {
    return keywords.attr("pop")(name, py::none());
  };
  const auto wrong = [](const char* name, const char* type) {
    return py::type_error(std::string(name) + " must be " + type);
  };
  if (const py::object value = runs == Runs::Cached ? take("no_cache") : py::none();
      !value.is_none()) {
    if (!py::isinstance<py::bool_>(value)) throw wrong("no_cache", "True or False");
    out.no_cache = value.cast<bool>();
  }
  if (const py::object value = runs >= Runs::Threads ? take("threads") : py::none();
      !value.is_none()) {
    try {
      if (!whole_number(value)) throw wrong("threads", "an int");
      out.threads = value.cast<int>();
    } catch (const py::cast_error&) {
      throw wrong("threads", "an int from 0 to 1024");
    }
  }
  if (runs != Runs::Briefly) out.progress = take("progress");
  return out;
}

void require_all_taken(const char* function, const py::dict& keywords,
                       const std::vector<Keyword>& known, Runs runs) {
  if (keywords.empty()) return;
  const std::string first = py::str(keywords.attr("__iter__")().attr("__next__")());
  std::vector<std::string> names;
  if (runs != Runs::Briefly) names.emplace_back("progress");
  if (runs >= Runs::Threads) names.emplace_back("threads");
  if (runs == Runs::Cached) names.emplace_back("no_cache");
  for (const Keyword& keyword : known) names.push_back(keyword_of(keyword.option));
  throw py::type_error(std::string(function) + "() got an unexpected keyword argument '" + first +
                       "'" + did_you_mean(first, names));
}

void require_none(const std::string& contradiction) {
  if (!contradiction.empty())
    throw Error(ErrorCode::InvalidArgument, meaning(contradiction, with_underscores));
}

std::string document(const std::string& function, const std::string& positional,
                     const std::vector<Keyword>& keywords, const std::string& result,
                     const std::string& text, Runs runs) {
  std::string signature = function + "(" + positional;
  if (positional.find('*') == std::string::npos) signature += ", *";
  std::string entries;
  for (const Keyword& keyword : keywords) {
    signature += ", " + keyword_of(keyword.option) + ": object = " + literal(keyword);
    entries += entry_of(keyword);
  }
  if (runs == Runs::Cached) {
    signature += ", no_cache: bool = False";
    entries += kCacheEntry;
  }
  if (runs >= Runs::Threads) {
    signature += ", threads: int = 0";
    entries += kThreadsEntry;
  }
  if (runs != Runs::Briefly) {
    signature += ", progress: object = None";
    entries += kProgressEntry;
  }
  signature += ") -> " + result + "\n\n";
  const std::string place = "{keywords}\n";
  const std::size_t at = text.find(place);
  return signature + text.substr(0, at) + entries +
         (at == std::string::npos ? "" : text.substr(at + place.size()));
}

py::list table_of(const std::vector<Keyword>& keywords) {
  py::list out;
  for (const Keyword& keyword : keywords) {
    const OptionDescription& o = keyword.option;
    py::dict entry;
    entry["name"] = o.name;
    entry["keyword"] = keyword_of(o);
    entry["type"] = type_words(o);
    entry["choices"] = py::cast(o.values.empty() ? o.choices : std::vector<std::string>());
    entry["values"] = value_words(o);
    entry["range"] = range_words(o);
    entry["unit"] = unit_words(o);
    entry["default"] = literal(keyword);
    entry["otherwise"] = meaning(o.otherwise, [](const std::string& n) { return "`" + n + "`"; });
    entry["text"] = meaning(o.text, [](const std::string& n) { return "`" + n + "`"; });
    out.append(entry);
  }
  return out;
}

}  // namespace kaboum::python
