#pragma once

#include <kaboum/base/error.h>
#include <kaboum/base/length.h>

#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

/// Options of requests, each described once: command lines, keywords of Python, records in
/// containers, keys of caches and the reference pages are made of these descriptions.
namespace kaboum {

/// Name, values, default and meaning of one option.
struct OptionDescription {
  enum class Kind {
    Flag,    ///< stated or not
    Count,   ///< an integer
    Counts,  ///< different integers, the largest first: "20000,10000"
    Number,  ///< a finite number
    Memory,  ///< bytes, more than 0: "500M", "2G"; k, K, M and G are powers of 1024
    Length,  ///< a positive length, or a percentage of a diagonal: "0.002", "2mm", "0.5%"
    Choice,  ///< one of `choices`
    Text,
    Files,     ///< files or folders, each stated by itself
    Names,     ///< different names with commas between them: "arm,hand"
    Settings,  ///< numbers by name, each stated by itself: "finger=0.04"; limits are of each.
               ///< Or lengths, also 0: "arm=5mm"
  };

  std::string name;  ///< words in small letters, joined by hyphens: "max-bodies"
  /// Meaning, without a full stop at its end. "{max-bodies}" stands for another option's name as
  /// the front end spells it.
  std::string text;
  std::string values = {};  ///< placeholder of a value in usage: "SECONDS"; empty: by its kind
  double low = -std::numeric_limits<double>::infinity();  ///< least value; 0 allows a length of 0
  double high = std::numeric_limits<double>::infinity();  ///< largest count or number
  bool between = false;   ///< a number lies between the limits and is none of them
  bool absolute = false;  ///< a length is no percentage; a number is such a length, in metres
  /// Unit of an absolute length that states none, in words.
  std::string own_unit = "metres";
  bool for_all = false;  ///< of settings: a number without a name is of all, with an empty name
  /// Name of a list where all its parts are stated at once: "plugins"; empty: `name`.
  std::string plural = {};
  /// Default in words; empty: that of the request, if it has one.
  std::string otherwise = {};
  /// Of a choice that may be stated without a value: the one that is meant then. A value is joined
  /// to the option's name on command lines: "--prepare=wrap".
  std::string implied = {};
  /// Part of each record, its default too.
  bool always_recorded = false;
  /// Part of no record's line: containers have a field of its own for it.
  bool unrecorded = false;

  // Set by option() and choice(), but for Names, Settings and Memory.
  Kind kind = Kind::Text;
  std::vector<std::string> choices = {};
};

/// Placeholder of a value of the option in usage: "N", "outer|inner"; empty for flags.
std::string value_words(const OptionDescription& option);

/// The range of a count or number: "1 to 100000", "at least 0"; empty without limits.
std::string range_words(const OptionDescription& option);

/// The unit of an absolute length: "metres, or with a unit, as in 5mm"; empty for all else.
std::string unit_words(const OptionDescription& option);

/// Range and unit: "at least 0; metres, or with a unit, as in 5mm"; empty without either.
std::string facts_of(const OptionDescription& option);

/// Text of an option with the names of other ones as a front end spells them.
/// @param spelled  of a name: "--max-bodies", "max_bodies"
std::string meaning(const std::string& text,
                    const std::function<std::string(const std::string&)>& spelled);

/// A remedy in an error or a note of a library, with options as a front end names them. Libraries
/// write an option as «name» or «name=value».
/// @param spelled  of a name and a value, which may be empty: "--prepare wrap", "prepare='wrap'"
std::string remedy(
    const std::string& text,
    const std::function<std::string(const std::string& name, const std::string& value)>& spelled);
/// As command lines do: "--prepare wrap", "--drop-sheets".
std::string remedy_of_program(const std::string& text);
/// As Python does: "prepare='wrap'", "drop_sheets", "scale=1000".
std::string remedy_of_python(const std::string& text);

/// Objection to a text as a value of the option ("must be ..."); empty where it is one.
std::string flaw_of(const OptionDescription& option, const std::string& value);

/// True if a value is a list whose parts are stated each by itself. Its text has a line for each.
bool is_repeated(const OptionDescription& option);

/// Numbers by name, of texts such as "finger=0.04"; the name of a number alone is empty.
/// @pre flaw_of finds nothing.
std::map<std::string, double> numbers_by_name(const std::vector<std::string>& settings);
/// Lengths by name, of texts such as "arm=5mm", in the same way.
std::map<std::string, Length> lengths_by_name(const std::vector<std::string>& settings);

/// Bytes of "500M", "2G" or "1000"; nullopt unless it is a size from 1 to 1e15.
std::optional<std::size_t> parse_memory(const std::string& text);

/// Texts of values: the fewest digits that read back as the same number.
namespace option_text {
std::string of(bool value);
std::string of(std::size_t value);
std::string of(const std::vector<std::size_t>& value);
std::string of(double value);
std::string of(const Length& value);
std::string of(const std::string& value);
/// With commas or, where the option is repeated, ends of lines between the parts.
std::string of(const std::vector<std::string>& value, const OptionDescription& option);

/// @pre flaw_of finds nothing.
void parse(const std::string& text, bool& value);
void parse(const std::string& text, std::size_t& value);
void parse(const std::string& text, std::vector<std::size_t>& value);
void parse(const std::string& text, double& value);
void parse(const std::string& text, Length& value);
void parse(const std::string& text, std::string& value);
/// The parts of a list: its lines or, where it has but one and is not repeated, what is between
/// commas. Empty ones are left out.
std::vector<std::string> parts(const std::string& text, const OptionDescription& option);
}  // namespace option_text

/// An option of a Request: its description, and how its value is read and set, as text.
template <class Request>
struct Option : OptionDescription {
  /// nullopt where nothing is stated.
  std::function<std::optional<std::string>(const Request&)> value;
  /// @pre flaw_of finds nothing.
  std::function<void(Request&, const std::string&)> assign;
};

namespace option_detail {
/// A length in another unit, as it is where it states none.
std::string length_in(std::string_view unit, const std::string& text);

template <class T>
struct Content {
  using Type = T;
  static constexpr bool optional = false;
};
template <class T>
struct Content<std::optional<T>> {
  using Type = T;
  static constexpr bool optional = true;
};

template <class T>
constexpr OptionDescription::Kind kind_of() {
  using Kind = OptionDescription::Kind;
  if constexpr (std::is_same_v<T, bool>)
    return Kind::Flag;
  else if constexpr (std::is_same_v<T, std::size_t>)
    return Kind::Count;
  else if constexpr (std::is_same_v<T, std::vector<std::size_t>>)
    return Kind::Counts;
  else if constexpr (std::is_same_v<T, double>)
    return Kind::Number;
  else if constexpr (std::is_same_v<T, Length>)
    return Kind::Length;
  else
    return Kind::Text;
}

/// The kind that a list of texts has: the one that its description states.
inline OptionDescription::Kind kind_of_list(OptionDescription::Kind stated) {
  using Kind = OptionDescription::Kind;
  return stated == Kind::Names || stated == Kind::Settings ? stated : Kind::Files;
}

/// An option of one value, or of several counts. An infinite number states nothing.
template <class Request, class Member>
Option<Request> single(OptionDescription description, Member member) {
  using Stored = std::remove_cvref_t<decltype(member(std::declval<Request&>()))>;
  using Content = option_detail::Content<Stored>;
  description.kind = option_detail::kind_of<typename Content::Type>();
  if (description.absolute) description.kind = OptionDescription::Kind::Length;
  return {std::move(description),
          [member](const Request& request) -> std::optional<std::string> {
            const Stored& stored = member(request);
            if constexpr (Content::optional) {
              if (!stored) return std::nullopt;
              return option_text::of(*stored);
            } else if constexpr (std::is_same_v<Stored, std::vector<std::size_t>>) {
              if (stored.empty()) return std::nullopt;
              return option_text::of(stored);
            } else if constexpr (std::is_same_v<Stored, double>) {
              if (stored > std::numeric_limits<double>::max()) return std::nullopt;
              return option_text::of(stored);
            } else {
              return option_text::of(stored);
            }
          },
          [member](Request& request, const std::string& text) {
            typename Content::Type parsed{};
            option_text::parse(text, parsed);
            member(request) = std::move(parsed);
          }};
}

/// An option of several texts; none states nothing.
template <class Request, class Member>
Option<Request> list(OptionDescription description, Member member) {
  description.kind = kind_of_list(description.kind);
  return {description,
          [member, description](const Request& request) -> std::optional<std::string> {
            if (member(request).empty()) return std::nullopt;
            return option_text::of(member(request), description);
          },
          [member, description](Request& request, const std::string& text) {
            member(request) = option_text::parts(text, description);
          }};
}

/// An option of numbers or lengths by name; none states nothing.
template <class Request, class Member>
Option<Request> settings(OptionDescription description, Member member) {
  description.kind = OptionDescription::Kind::Settings;
  return {description,
          [member, description](const Request& request) -> std::optional<std::string> {
            if (member(request).empty()) return std::nullopt;
            std::vector<std::string> lines;
            for (const auto& [name, value] : member(request))
              lines.push_back((name.empty() ? name : name + '=') + option_text::of(value));
            return option_text::of(lines, description);
          },
          [member, description](Request& request, const std::string& text) {
            const std::vector<std::string> parts = option_text::parts(text, description);
            if constexpr (std::is_same_v<std::remove_cvref_t<decltype(member(request))>,
                                         std::map<std::string, Length>>)
              member(request) = lengths_by_name(parts);
            else
              member(request) = numbers_by_name(parts);
          }};
}
}  // namespace option_detail

/// An option whose value is a member of the request: a bool, size_t, double, Length, string,
/// vector of size_t or strings, or map of numbers or lengths by name, or an optional one. An empty
/// vector or map states nothing.
/// @param member  of a request, const or not: a reference to the value
template <class Request, class Member>
Option<Request> option(OptionDescription description, Member member) {
  using Stored = std::remove_cvref_t<decltype(member(std::declval<Request&>()))>;
  if constexpr (std::is_same_v<Stored, std::vector<std::string>>)
    return option_detail::list<Request>(std::move(description), member);
  else if constexpr (std::is_same_v<Stored, std::map<std::string, double>> ||
                     std::is_same_v<Stored, std::map<std::string, Length>>)
    return option_detail::settings<Request>(std::move(description), member);
  else
    return option_detail::single<Request>(std::move(description), member);
}

/// An option whose value is a number or, with the kind Memory, bytes. 0 stands for none.
template <class Request, class Member>
Option<Request> limit_option(OptionDescription description, Member member) {
  const bool memory = description.kind == OptionDescription::Kind::Memory;
  Option<Request> out = option<Request>(std::move(description), member);
  if (memory) {
    out.kind = OptionDescription::Kind::Memory;
    out.assign = [member](Request& request, const std::string& text) {
      member(request) = parse_memory(text).value_or(0);
    };
  }
  out.value = [member](const Request& request) -> std::optional<std::string> {
    if (member(request) == 0) return std::nullopt;
    return option_text::of(member(request));
  };
  return out;
}

/// An option whose value is one of several, each of which has a name.
/// @param names  pairs of a name and its value
template <class Request, class Member, class Names>
Option<Request> choice(OptionDescription description, Member member, const Names& names) {
  using Value = std::remove_cvref_t<decltype(member(std::declval<Request&>()))>;
  description.kind = OptionDescription::Kind::Choice;
  description.choices.clear();
  std::vector<Value> values;
  for (const auto& [name, value] : names) {
    description.choices.emplace_back(name);
    values.push_back(value);
  }
  return {description,
          [member, values, words = description.choices](const Request& request) {
            std::optional<std::string> out;
            for (std::size_t i = 0; i < values.size(); ++i)
              if (member(request) == values[i]) out = words[i];
            return out;
          },
          [member, values, words = description.choices](Request& request, const std::string& text) {
            for (std::size_t i = 0; i < values.size(); ++i)
              if (text == words[i]) member(request) = values[i];
          }};
}

/// Options of a part of a larger request.
/// @param part  of the larger request, const or not: a reference to the part
template <class Whole, class Part, class Member>
std::vector<Option<Whole>> options_of_part(const std::vector<Option<Part>>& options, Member part) {
  std::vector<Option<Whole>> out;
  out.reserve(options.size());
  for (const Option<Part>& option : options)
    out.push_back({option,
                   [part, value = option.value](const Whole& whole) { return value(part(whole)); },
                   [part, assign = option.assign](Whole& whole, const std::string& text) {
                     assign(part(whole), text);
                   }});
  return out;
}

/// Brings lengths that are stated in a unit into that of what they are about.
/// @param unit  one of kLengthUnits: m for robots
/// @throws Error{InvalidArgument} where one is stated and `unit` is none.
template <class Request>
void bring_lengths_into(std::string_view unit, const std::vector<Option<Request>>& options,
                        Request& request) {
  for (const Option<Request>& option : options) {
    if (option.kind != OptionDescription::Kind::Length) continue;
    const std::optional<std::string> value = option.value(request);
    if (value) option.assign(request, option_detail::length_in(unit, *value));
  }
}

/// The option of that name.
/// @pre There is one.
template <class Request>
const Option<Request>& option_named(const std::vector<Option<Request>>& options,
                                    std::string_view name) {
  for (const Option<Request>& option : options)
    if (option.name == name) return option;
  throw Error(ErrorCode::Internal, "there is no option " + std::string(name));
}

/// Those of these names, in this order.
/// @pre There are some.
template <class Request>
std::vector<Option<Request>> options_named(const std::vector<Option<Request>>& options,
                                           std::initializer_list<std::string_view> names) {
  std::vector<Option<Request>> out;
  for (const std::string_view name : names) out.push_back(option_named(options, name));
  return out;
}

/// The default value of an option: that of a request nobody has touched.
template <class Request>
std::optional<std::string> default_of(const Option<Request>& option) {
  static const Request plain{};
  return option.value(plain);
}

/// The value of the option of that name as text; empty where there is none.
template <class Request>
std::string value_of(const std::vector<Option<Request>>& options, std::string_view name,
                     const Request& request) {
  for (const Option<Request>& option : options)
    if (option.name == name) return option.value(request).value_or(std::string());
  return {};
}

namespace option_detail {
/// An option and its value in a record; a repeated one as often as it has parts.
std::string recorded_words(const OptionDescription& option, const std::string& value);
}  // namespace option_detail

/// The options of a request that are not as by default, in one line: the record of what a result
/// was made with. "--epsilon 1% --drop-sheets"
template <class Request>
std::string record_of(const std::vector<Option<Request>>& options, const Request& request) {
  std::string out;
  for (const Option<Request>& option : options) {
    const std::optional<std::string> value = option.value(request);
    if (option.unrecorded || !value) continue;
    if (!option.always_recorded && value == default_of(option)) continue;
    if (!out.empty()) out += ' ';
    out += option_detail::recorded_words(option, *value);
  }
  return out;
}

namespace option_detail {
/// The next word of a line, taken from it; empty at its end.
std::string next_word(std::string_view& line);
}  // namespace option_detail

/// The value of one option in a record; nullopt where the record does not state it.
std::optional<std::string> recorded(std::string_view record, std::string_view name);

/// Sets what a record says.
/// @return what of it is not understood: an unknown option, or one with a wrong value; empty: all
///   is.
template <class Request>
std::string read_record(const std::vector<Option<Request>>& options, std::string_view record,
                        Request& request) {
  for (std::string word = option_detail::next_word(record); !word.empty();
       word = option_detail::next_word(record)) {
    const Option<Request>* found = nullptr;
    for (const Option<Request>& option : options)
      if (!option.unrecorded && word == "--" + option.name) found = &option;
    if (found == nullptr) return word;
    const bool flag = found->kind == OptionDescription::Kind::Flag;
    std::string value = flag ? "true" : option_detail::next_word(record);
    if (!flaw_of(*found, value).empty())
      return value.empty() ? word : word.append(" ").append(value);
    if (const auto before = found->value(request); before && is_repeated(*found))
      value.insert(0, 1, '\n').insert(0, *before);
    found->assign(request, value);
  }
  return {};
}

}  // namespace kaboum
