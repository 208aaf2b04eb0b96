#pragma once

#include <kaboum/base/error.h>
#include <kaboum/base/json_damage.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_set>
#include <utility>
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

/// Builds a JSON value of a parser's events (nlohmann's SAX interface), in linear time, and says
/// of a member that its object has already.
/// @tparam Json  nlohmann::json or nlohmann::ordered_json
template <class Json>
class JsonBuilder {
 public:
  using String = typename Json::string_t;

  bool null() { return put(Json(nullptr)); }
  bool boolean(bool value) { return put(Json(value)); }
  bool number_integer(typename Json::number_integer_t value) { return put(Json(value)); }
  bool number_unsigned(typename Json::number_unsigned_t value) { return put(Json(value)); }
  bool number_float(typename Json::number_float_t value, const String& /*text*/) {
    return put(Json(value));
  }
  bool string(String& value) { return put(Json(std::move(value))); }
  bool binary(typename Json::binary_t& value) { return put(Json(std::move(value))); }
  bool start_object(std::size_t /*size*/) {
    members_.emplace_back();
    return open(Json::object());
  }
  bool start_array(std::size_t /*size*/) { return open(Json::array()); }
  bool end_array() {
    open_.pop_back();
    return true;
  }
  bool end_object() {
    members_.pop_back();
    return end_array();
  }
  bool key(String& name) {
    if (!members_.back().insert(name).second) {
      doubled_ = name;
      return false;
    }
    key_ = std::move(name);
    return true;
  }
  template <class Exception>
  bool parse_error(std::size_t byte, const std::string& /*token*/, const Exception& /*error*/) {
    constexpr bool kDamage = std::is_same_v<Exception, typename Json::parse_error>;
    if constexpr (kDamage)
      damage_ = byte;
    else
      out_of_range_ = true;
    return false;
  }

  [[nodiscard]] Json& value() { return value_; }
  /// The name of the member that is given twice.
  [[nodiscard]] const std::optional<String>& doubled() const { return doubled_; }
  /// Number of bytes to where the text stops being JSON; nullopt: it is.
  [[nodiscard]] std::optional<std::size_t> damage() const { return damage_; }
  [[nodiscard]] bool out_of_range() const { return out_of_range_; }

 private:
  Json* add(Json&& value) {
    if (open_.empty()) {
      value_ = std::move(value);
      return &value_;
    }
    Json& in = *open_.back();
    if (in.is_array()) {
      auto& items = in.template get_ref<typename Json::array_t&>();
      return &items.emplace_back(std::move(value));
    }
    // The key is new; an ordered object's own emplace would look through all others.
    auto& object = in.template get_ref<typename Json::object_t&>();
    if constexpr (requires { object.emplace_back(std::move(key_), std::move(value)); })
      return &object.emplace_back(std::move(key_), std::move(value)).second;
    else
      return &object.emplace(std::move(key_), std::move(value)).first->second;
  }
  bool put(Json&& value) {
    add(std::move(value));
    return true;
  }
  bool open(Json&& value) {
    open_.push_back(add(std::move(value)));
    return true;
  }

  Json value_;
  std::vector<Json*> open_;  // the last item of each is the next one, so that none of them moves
  std::vector<std::unordered_set<String>> members_;
  String key_;
  std::optional<String> doubled_;
  std::optional<std::size_t> damage_;
  bool out_of_range_ = false;
};

/// The value of JSON from elsewhere. Members that are given twice, of which parsers take the last
/// one, are refused.
/// @tparam Json    nlohmann::json or nlohmann::ordered_json
/// @param name     of the file, for messages
/// @param remedy   how every message ends, as "write the plan again"
/// @throws Error{InvalidInput} naming line and column: not JSON, cut short, a member given twice;
/// besides: deeper than kDeepestJson, a number out of range.
template <class Json>
Json read_json(std::string_view text, const std::string& name, const std::string& remedy) {
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorCode::InvalidInput,
                std::string(name).append(": ").append(what) + "; " + remedy);
  };
  if (is_nested_too_deep(text)) fail(describe_json_depth());
  const char* read = text.data();
  JsonBuilder<Json> builder;
  const bool done = Json::sax_parse(CountedText(text.data(), &read),
                                    CountedText(text.data() + text.size(), &read), &builder);
  if (builder.doubled())
    fail(place_in_text(text, start_of_json_string(text, read - text.data())) + ": '" +
         *builder.doubled() + "' is given twice");
  if (builder.damage()) fail(describe_json_damage(text, *builder.damage()));
  if (!done) fail("a number in it is out of range");
  return std::move(builder.value());
}

}  // namespace kaboum
