#pragma once

#include <kaboum/base/error.h>
#include <kaboum/base/json_damage.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum {

/// A pointer into a text that tells how far a parser has read.
class CountedText {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  /// @param read  is moved on to the farthest byte that was passed
  CountedText(const char* at, const char** read) : at_(at), read_(read) {}
  reference operator*() const { return *at_; }
  CountedText& operator++() {
    *read_ = std::max(*read_, ++at_);
    return *this;
  }
  CountedText operator++(int) {
    const CountedText before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountedText& other) const { return at_ == other.at_; }
  bool operator!=(const CountedText& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  const char** read_;
};

/// Where the last string before byte `end` of a JSON text begins: from its closing quotation mark
/// back to the one that no odd number of backslashes precedes.
inline std::size_t start_of_json_string(std::string_view text, std::size_t end) {
  const std::size_t last = text.substr(0, end).rfind('"');
  std::size_t at = last == std::string_view::npos ? 0 : last;
  while (at > 0) {
    --at;
    if (text[at] != '"') continue;
    std::size_t slashes = 0;
    while (slashes < at && text[at - 1 - slashes] == '\\') ++slashes;
    if (slashes % 2 == 0) break;
  }
  return at;
}

/// The value of JSON from elsewhere. Members that are given twice, of which parsers take the last
/// one, are refused.
/// @tparam Json    nlohmann::json or nlohmann::ordered_json
/// @param name     of the file, for messages
/// @param remedy   how every message ends, as "write the plan again"
/// @throws Error{InvalidInput} naming line and column: not JSON, cut short, a member given twice;
/// besides: deeper than kDeepestJson, a number out of range.
template <class Json>
Json read_json(std::string_view text, const std::string& name, const std::string& remedy) {
  using Event = typename Json::parse_event_t;
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorCode::InvalidInput,
                std::string(name).append(": ").append(what) + "; " + remedy);
  };
  if (is_nested_too_deep(text)) fail(describe_json_depth());
  const char* read = text.data();
  std::vector<std::set<std::string>> members;
  const auto look = [&](int /*depth*/, Event event, Json& value) {
    if (event == Event::object_start) members.emplace_back();
    if (event == Event::object_end) members.pop_back();
    if (event == Event::key && !members.back().insert(value.template get<std::string>()).second)
      fail(place_in_text(text, start_of_json_string(text, read - text.data())) + ": '" +
           value.template get<std::string>() + "' is given twice");
    return true;
  };
  try {
    return Json::parse(CountedText(text.data(), &read),
                       CountedText(text.data() + text.size(), &read), look);
  } catch (const typename Json::parse_error& error) {
    fail(describe_json_damage(text, error.byte));
  } catch (const typename Json::exception&) {
    fail("a number in it is out of range");
  }
  return {};
}

}  // namespace kaboum
