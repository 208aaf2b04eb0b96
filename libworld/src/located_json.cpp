// JSON by nlohmann's lexer, with the place of every value.

#include "located_json.h"

#include <kaboum/base/error.h>
#include <kaboum/base/read_json.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

namespace kaboum::world::detail {
namespace {

/// Takes the lexer's events.
class Builder : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(std::string_view text, const std::string& name, const char** read)
      : text_(text), name_(name), read_(read) {}

  Located take() { return std::move(root_); }

  bool null() override { return add(word(Located::Kind::Null)); }
  bool boolean(bool value) override {
    Located v = word(Located::Kind::Boolean);
    v.boolean = value;
    return add(std::move(v));
  }
  bool number_integer(number_integer_t value) override {
    return add_number(static_cast<double>(value));
  }
  bool number_unsigned(number_unsigned_t value) override {
    return add_number(static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t& /*text*/) override {
    return add_number(value);
  }
  bool string(string_t& value) override {
    Located v;
    v.kind = Located::Kind::String;
    v.at = start_of_json_string(text_, read());
    v.text = value;
    return add(std::move(v));
  }
  bool binary(binary_t& /*value*/) override { return false; }
  bool start_object(std::size_t /*size*/) override { return open(Located::Kind::Object, '{'); }
  bool start_array(std::size_t /*size*/) override { return open(Located::Kind::Array, '['); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& value) override {
    open_.back().names.push_back(value);
    open_.back().names_at.push_back(start_of_json_string(text_, read()));
    return true;
  }
  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const nlohmann::detail::exception& /*error*/) override {
    throw Error(ErrorCode::InvalidInput, name_ + ": " + describe_json_damage(text_, position));
  }

 private:
  [[nodiscard]] std::size_t read() const { return static_cast<std::size_t>(*read_ - text_.data()); }

  /// The byte of the last `c` that was read.
  [[nodiscard]] std::size_t last(char c) const {
    const std::size_t at = text_.substr(0, read()).rfind(c);
    return at == std::string_view::npos ? 0 : at;
  }
  /// Of the word or number that ends where the lexer is, or one byte before.
  [[nodiscard]] std::size_t start_of_word() const {
    const auto is_part = [](char c) {
      return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || c == 'E' || c == '+' || c == '-' ||
             c == '.';
    };
    std::size_t end = std::min(read(), text_.size());
    while (end > 0 && !is_part(text_[end - 1])) --end;
    while (end > 0 && is_part(text_[end - 1])) --end;
    return end;
  }
  [[nodiscard]] Located word(Located::Kind kind) const {
    Located v;
    v.kind = kind;
    v.at = start_of_word();
    return v;
  }
  bool add_number(double value) {
    Located v = word(Located::Kind::Number);
    v.number = value;
    return add(std::move(v));
  }
  bool open(Located::Kind kind, char bracket) {
    constexpr std::size_t kDeepest = 64;
    Located v;
    v.kind = kind;
    v.at = last(bracket);
    if (open_.size() >= kDeepest)
      throw Error(ErrorCode::InvalidInput, name_ + ": " + place_in_text(text_, v.at) +
                                               ": more than 64 brackets in each other");
    open_.push_back(std::move(v));
    return true;
  }
  bool close() {
    Located done = std::move(open_.back());
    open_.pop_back();
    if (const auto i = repeated_member(done))
      throw Error(ErrorCode::InvalidInput, name_ + ": " + place_in_text(text_, done.names_at[*i]) +
                                               ": '" + done.names[*i] + "' is used twice");
    return add(std::move(done));
  }
  bool add(Located value) {
    if (open_.empty()) {
      root_ = std::move(value);
    } else if (open_.back().kind == Located::Kind::Array) {
      open_.back().items.push_back(std::move(value));
    } else {
      open_.back().values.push_back(std::move(value));
    }
    return true;
  }

  std::string_view text_;
  const std::string& name_;
  const char** read_;
  Located root_;
  std::vector<Located> open_;
};

}  // namespace

const char* name_of(Located::Kind kind) {
  switch (kind) {
    case Located::Kind::Null:
      return "null";
    case Located::Kind::Boolean:
      return "true or false";
    case Located::Kind::Number:
      return "a number";
    case Located::Kind::String:
      return "a string";
    case Located::Kind::Array:
      return "an array";
    default:
      return "an object";
  }
}

std::optional<std::size_t> repeated_member(const Located& object) {
  std::set<std::string_view> before;
  for (std::size_t i = 0; i < object.names.size(); ++i)
    if (!before.insert(object.names[i]).second) return i;
  return std::nullopt;
}

Located parse_located(std::string_view text, const std::string& name) {
  const char* read = text.data();
  Builder builder(text, name, &read);
  nlohmann::json::sax_parse(CountedText(text.data(), &read),
                            CountedText(text.data() + text.size(), &read), &builder);
  return builder.take();
}

}  // namespace kaboum::world::detail
