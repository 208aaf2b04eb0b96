// Options of requests: texts of their values, and what is wrong with one.

#include <kaboum/base/length_unit.h>
#include <kaboum/base/number_text.h>
#include <kaboum/base/option.h>
#include <kaboum/base/parse_length.h>
#include <kaboum/base/similar_name.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <set>
#include <sstream>

namespace kaboum {
namespace {

using Kind = OptionDescription::Kind;

/// A whole text as a number; a plus sign may come first.
template <class Number>
std::optional<Number> parsed(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string out;
  for (const std::string& word : words) out.append(out.empty() ? "" : between).append(word);
  return out;
}

/// "a, b or c"
std::string alternatives(const std::vector<std::string>& words) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i)
    out += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return out;
}

/// Integers with commas between them.
std::optional<std::vector<std::size_t>> parsed_counts(std::string_view text) {
  std::vector<std::size_t> counts;
  for (bool more = true; more;) {
    const std::size_t comma = text.find(',');
    const auto count = parsed<std::size_t>(text.substr(0, comma));
    if (!count) return std::nullopt;
    counts.push_back(*count);
    more = comma != std::string_view::npos;
    if (more) text.remove_prefix(comma + 1);
  }
  return counts;
}

std::string counts_flaw(const OptionDescription& option, const std::string& value) {
  auto counts = parsed_counts(value);
  bool sound = counts.has_value();
  if (sound) {
    std::ranges::sort(*counts);
    sound = std::ranges::adjacent_find(*counts) == counts->end() &&
            static_cast<double>(counts->front()) >= option.low &&
            static_cast<double>(counts->back()) <= option.high;
  }
  const std::string range = range_words(option);
  return sound ? ""
               : "must be a whole number" + (range.empty() ? "" : ", " + range) +
                     ", or different ones separated by commas, without blanks, not " + value;
}

std::string limits_flaw(const OptionDescription& option, const std::string& value, bool whole) {
  const std::string range = range_words(option);
  return std::string("must be ") + (whole ? "a whole number" : "a number") +
         (range.empty()                    ? ""
          : range.starts_with("at least ") ? ", " + range
          : range.starts_with("between ")  ? " " + range
          : range.starts_with("above ")    ? " " + range
                                           : " from " + range) +
         (whole ? "" : ", without a unit") + ", not " + value;
}

bool is_within(const OptionDescription& option, double number) {
  return option.between ? number > option.low && number < option.high
                        : number >= option.low && number <= option.high;
}

/// "m, dm, cm"
std::string joined_units() { return joined({kLengthUnits.begin(), kLengthUnits.end()}, ", "); }

/// What an absolute length is, after "must be ".
std::string absolute_words(const OptionDescription& option, const char* kind) {
  return std::string(kind) + " in " + option.own_unit + ", or with a unit (" + joined_units() +
         "), as in 5mm, without blanks";
}

/// Why a length is no absolute one, at the end of what is said of it.
std::string percent_words(const std::optional<Length>& length) {
  return length && length->percent ? " (there is no diagonal that it could be a percentage of)"
                                   : "";
}

/// Name and value of "finger=0.04", or of "0.04", whose name is empty; nullopt: a name is missing.
std::optional<std::pair<std::string, std::string>> split_setting(const std::string& text) {
  const std::size_t sign = text.rfind('=');
  if (sign == 0) return std::nullopt;
  if (sign == std::string::npos) return std::pair(std::string(), text);
  return std::pair(text.substr(0, sign), text.substr(sign + 1));
}

/// The value of a setting that is a number or, in the same way, a length; nullopt: it is neither.
std::optional<Length> parsed_value(const std::string& text, bool length) {
  if (length) return parse_distance(text);
  const auto number = parsed<double>(text);
  return number && std::isfinite(*number) ? std::optional(Length{*number}) : std::nullopt;
}

/// What a setting is, after "must be ".
std::string setting_words(const OptionDescription& option) {
  const std::string value = option.absolute ? "LENGTH" : "NUMBER";
  return (option.for_all ? value + " or " : "") + "NAME=" + value +
         (option.absolute
              ? ", as in arm=5mm, each " + absolute_words(option, "a length of at least 0")
              : ", as in finger=0.04");
}

std::string settings_flaw(const OptionDescription& option, const std::string& value) {
  std::set<std::string> known;
  for (const std::string& text : option_text::parts(value, option)) {
    const auto setting = split_setting(text);
    const auto number = setting ? parsed_value(setting->second, option.absolute) : std::nullopt;
    if (!number || number->percent || (setting->first.empty() && !option.for_all))
      return "must be " + setting_words(option) + ", not " + text + percent_words(number);
    if (!is_within(option, number->value)) return limits_flaw(option, text, false);
    if (!known.insert(setting->first).second)
      return setting->first.empty() ? "gives a number for all twice"
                                    : "gives '" + setting->first + "' twice";
  }
  return known.empty() ? "must be " + setting_words(option) : "";
}

std::string length_flaw(const OptionDescription& option, const std::string& value) {
  const bool may_be_zero = option.low == 0;
  const auto length = may_be_zero ? parse_distance(value) : parse_length(value);
  if (length && !(option.absolute && length->percent)) return {};
  if (option.absolute)
    return "must be " +
           absolute_words(option, may_be_zero ? "a length of at least 0" : "a positive length") +
           ", not " + value + percent_words(length);
  return "must be a positive number, perhaps with a unit (" + joined_units() +
         "), as in 5mm, or a percentage such as 0.5%, without blanks, not " + value;
}

/// Values by name, as `of` makes them.
template <class Value, class Of>
std::map<std::string, Value> by_name(const std::vector<std::string>& settings, bool lengths,
                                     const Of& of) {
  std::map<std::string, Value> out;
  for (const std::string& text : settings)
    if (const auto setting = split_setting(text))
      if (const auto value = parsed_value(setting->second, lengths))
        out.emplace(setting->first, of(*value));
  return out;
}

}  // namespace

std::string value_words(const OptionDescription& option) {
  if (!option.values.empty()) return option.values;
  switch (option.kind) {
    case Kind::Flag:
      return {};
    case Kind::Count:
      return "N";
    case Kind::Counts:
      return "N[,N...]";
    case Kind::Memory:
      return "SIZE";
    case Kind::Number:
      return "X";
    case Kind::Length:
      return option.absolute ? "LENGTH" : "LENGTH|P%";
    case Kind::Choice:
      return joined(option.choices, "|");
    case Kind::Files:
      return "FILE";
    case Kind::Names:
      return "A,B";
    case Kind::Settings:
      return option.absolute  ? option.for_all ? "LENGTH|NAME=LENGTH" : "NAME=LENGTH"
             : option.for_all ? "X|NAME=X"
                              : "NAME=X";
    case Kind::Text:
      break;
  }
  return "NAME";
}

std::string range_words(const OptionDescription& option) {
  if (option.kind == Kind::Length && option.low == 0) return "at least 0";
  const bool whole = option.kind == Kind::Count || option.kind == Kind::Counts;
  if (!whole && option.kind != Kind::Number && option.kind != Kind::Settings) return {};
  const auto digits = [&](double limit) {
    return whole ? std::to_string(static_cast<std::size_t>(limit)) : number_text(limit);
  };
  if (std::isinf(option.low)) return {};
  if (option.between && std::isinf(option.high)) return "above " + digits(option.low);
  if (option.between) return "between " + digits(option.low) + " and " + digits(option.high);
  if (std::isinf(option.high)) return "at least " + digits(option.low);
  return digits(option.low) + " to " + digits(option.high);
}

std::string unit_words(const OptionDescription& option) {
  return option.absolute ? option.own_unit + ", or with a unit, as in 5mm" : "";
}

std::string facts_of(const OptionDescription& option) {
  const std::string range = range_words(option), unit = unit_words(option);
  return range + (range.empty() || unit.empty() ? "" : "; ") + unit;
}

std::string meaning(const std::string& text,
                    const std::function<std::string(const std::string&)>& spelled) {
  std::string out;
  std::size_t at = 0;
  for (std::size_t open = text.find('{'); open != std::string::npos; open = text.find('{', at)) {
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) break;
    out.append(text, at, open - at);
    out += spelled(text.substr(open + 1, close - open - 1));
    at = close + 1;
  }
  return out + text.substr(at);
}

std::string remedy(
    const std::string& text,
    const std::function<std::string(const std::string& name, const std::string& value)>& spelled) {
  constexpr std::string_view kOpen = "«", kClose = "»";
  std::string out;
  std::size_t at = 0;
  for (std::size_t open = text.find(kOpen); open != std::string::npos;
       open = text.find(kOpen, at)) {
    const std::size_t from = open + kOpen.size(), close = text.find(kClose, from);
    if (close == std::string::npos) break;
    const std::string option = text.substr(from, close - from);
    const std::size_t equals = option.find('=');
    out.append(text, at, open - at);
    out += spelled(option.substr(0, equals),
                   equals == std::string::npos ? "" : option.substr(equals + 1));
    at = close + kClose.size();
  }
  return out + text.substr(at);
}

std::string remedy_of_program(const std::string& text) {
  return remedy(text, [](const std::string& name, const std::string& value) {
    return "--" + name + (value.empty() ? "" : " " + value);
  });
}

std::string remedy_of_python(const std::string& text) {
  return remedy(text, [](std::string name, const std::string& value) {
    std::ranges::replace(name, '-', '_');
    if (value.empty()) return name;
    return name + "=" + (parsed<double>(value) ? value : "'" + value + "'");
  });
}

std::string flaw_of(const OptionDescription& option, const std::string& value) {
  switch (option.kind) {
    case Kind::Flag:
      return value == "true" || value == "false" ? "" : "must be true or false, not " + value;
    case Kind::Count: {
      const auto count = parsed<std::size_t>(value);
      const bool sound = count && static_cast<double>(*count) >= option.low &&
                         static_cast<double>(*count) <= option.high;
      return sound ? "" : limits_flaw(option, value, true);
    }
    case Kind::Counts:
      return counts_flaw(option, value);
    case Kind::Number: {
      const auto number = parsed<double>(value);
      const bool sound = number && std::isfinite(*number) && is_within(option, *number);
      return sound ? "" : limits_flaw(option, value, false);
    }
    case Kind::Memory:
      return parse_memory(value) ? "" : "must be a size such as 500M or 2G, not " + value;
    case Kind::Length:
      return length_flaw(option, value);
    case Kind::Choice:
      return std::ranges::find(option.choices, value) != option.choices.end()
                 ? ""
                 : "must be " + alternatives(option.choices) + ", not " + value +
                       did_you_mean(value, option.choices);
    case Kind::Settings:
      return settings_flaw(option, value);
    case Kind::Files:
    case Kind::Names:
    case Kind::Text:
      break;
  }
  return {};
}

bool is_repeated(const OptionDescription& option) {
  return option.kind == Kind::Files || option.kind == Kind::Settings;
}

std::map<std::string, double> numbers_by_name(const std::vector<std::string>& settings) {
  return by_name<double>(settings, false, [](const Length& value) { return value.value; });
}

std::map<std::string, Length> lengths_by_name(const std::vector<std::string>& settings) {
  return by_name<Length>(settings, true, [](const Length& value) { return value; });
}

std::optional<std::size_t> parse_memory(const std::string& text) {
  std::string_view digits = text;
  double unit = 1;
  if (const auto at = std::string_view("kKMG").find(digits.empty() ? ' ' : digits.back());
      at != std::string_view::npos) {
    unit = at <= 1 ? 0x1p10 : at == 2 ? 0x1p20 : 0x1p30;
    digits.remove_suffix(1);
  }
  const double bytes = parsed<double>(digits).value_or(0) * unit;
  if (!(bytes >= 1 && bytes <= 1e15)) return std::nullopt;
  return static_cast<std::size_t>(bytes);
}

namespace option_text {

std::string of(bool value) { return value ? "true" : "false"; }
std::string of(std::size_t value) { return std::to_string(value); }
std::string of(const std::vector<std::size_t>& value) {
  std::string out;
  for (const std::size_t count : value)
    out.append(out.empty() ? "" : ",").append(std::to_string(count));
  return out;
}
std::string of(double value) { return Length{value}.text(); }
std::string of(const Length& value) { return value.text(); }
std::string of(const std::string& value) { return value; }
std::string of(const std::vector<std::string>& value, const OptionDescription& option) {
  return joined(value, is_repeated(option) ? "\n" : ",");
}

void parse(const std::string& text, bool& value) { value = text == "true"; }
void parse(const std::string& text, std::size_t& value) {
  value = parsed<std::size_t>(text).value_or(0);
}
void parse(const std::string& text, std::vector<std::size_t>& value) {
  value = parsed_counts(text).value_or(std::vector<std::size_t>());
  std::ranges::sort(value, std::greater<>());
}
void parse(const std::string& text, double& value) {
  const auto length = parse_distance(text);
  value = length && length->unit != Length::Unit::Own ? length->in("m").value
                                                      : parsed<double>(text).value_or(0);
}
void parse(const std::string& text, Length& value) {
  value = parse_length(text).value_or(Length{});
}
void parse(const std::string& text, std::string& value) { value = text; }
std::vector<std::string> parts(const std::string& text, const OptionDescription& option) {
  const bool lines = is_repeated(option) || text.find('\n') != std::string::npos;
  std::vector<std::string> out;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, lines ? '\n' : ',');)
    if (!part.empty()) out.push_back(part);
  return out;
}

}  // namespace option_text

namespace option_detail {

std::string length_in(std::string_view unit, const std::string& text) {
  const std::optional<Length> length = parse_length(text);
  return length && length->unit != Length::Unit::Own ? length->in(unit).text() : text;
}

std::string recorded_words(const OptionDescription& option, const std::string& value) {
  std::string name = "--" + option.name;
  if (option.kind == Kind::Flag) return name;
  if (!is_repeated(option)) return name + ' ' + value;
  std::string out;
  for (const std::string& part : option_text::parts(value, option))
    out.append(out.empty() ? "" : " ").append(name).append(" ").append(part);
  return out;
}

std::string next_word(std::string_view& line) {
  const std::size_t begin = std::min(line.find_first_not_of(" \n"), line.size());
  const std::size_t end = std::min(line.find_first_of(" \n", begin), line.size());
  std::string word(line.substr(begin, end - begin));
  line.remove_prefix(end);
  return word;
}

}  // namespace option_detail

std::optional<std::string> recorded(std::string_view record, std::string_view name) {
  for (std::string word = option_detail::next_word(record); !word.empty();
       word = option_detail::next_word(record))
    if (word.starts_with("--") && std::string_view(word).substr(2) == name)
      return option_detail::next_word(record);
  return std::nullopt;
}

}  // namespace kaboum
