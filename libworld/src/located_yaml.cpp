// YAML by yaml-cpp's parser, with the place of every value.

#include <kaboum/base/error.h>
#include <kaboum/base/json_damage.h>

#include "located_json.h"

#ifdef KABOUM_HAS_YAML

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <sstream>

namespace kaboum::world::detail {
namespace {

/// What a plain scalar says, by the core schema of YAML 1.2 without what its version 1.1 reads
/// otherwise.
Located plain(const std::string& text) {
  Located v;
  v.text = text;
  v.kind = Located::Kind::String;
  if (text.empty() || text == "~" || text == "null") {
    v.kind = Located::Kind::Null;
  } else if (text == "true" || text == "false") {
    v.kind = Located::Kind::Boolean;
    v.boolean = text == "true";
  } else {
    const char *begin = text.data(), *end = begin + text.size();
    if (*begin == '+' && text.find_first_of("+-", 1) != 1) ++begin;
    const bool is_digit = text.find_first_of("0123456789") != std::string::npos &&
                          text.find_first_not_of("0123456789+-.eE") == std::string::npos;
    const auto [stop, error] = std::from_chars(begin, end, v.number);
    if (is_digit && error == std::errc() && stop == end) v.kind = Located::Kind::Number;
  }
  return v;
}

/// Whether it can be said in JSON as well.
bool is_utf8(const std::string& text) {
  try {
    (void)nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

/// 010 is eight to some programs and ten to others.
bool is_octal_to_some(const std::string& text) {
  const std::size_t first = text.find_first_not_of("+-");
  return first != std::string::npos && text[first] == '0' && first + 1 < text.size() &&
         text[first + 1] >= '0' && text[first + 1] <= '9';
}

/// Takes the parser's events.
class YamlBuilder : public YAML::EventHandler {
 public:
  YamlBuilder(std::string_view text, const std::string& name) : text_(text), name_(name) {
    starts_.push_back(0);
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n') starts_.push_back(i + 1);
  }

  Located take() { return std::move(root_); }

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& what) const {
    throw Error(ErrorCode::InvalidInput,
                name_ + ": " + place_in_text(text_, byte_of(mark)) + ": " + what);
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1) fail(mark, "a second document; a scene is one");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    refuse_anchor(mark, anchor);
    if (expects_name()) fail(mark, "a member without a name");
    Located v;
    v.at = byte_of(mark);
    add(std::move(v));
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override {
    refuse_anchor(mark, 1);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_anchor(mark, anchor);
    if (!is_utf8(value)) fail(mark, "not UTF-8");
    const bool quoted = tag == "!" || tag == "tag:yaml.org,2002:str";
    if (!quoted && tag != "?" && !tag.empty()) fail(mark, "the tag " + tag + " is not read");
    if (expects_name()) {
      open_.back().names.push_back(value);
      open_.back().names_at.push_back(byte_of(mark));
      return;
    }
    Located v;
    if (quoted) {
      v.kind = Located::Kind::String;
      v.text = value;
    } else {
      v = plain(value);
      if (v.kind == Located::Kind::Number && is_octal_to_some(value))
        fail(mark, "a number that begins with 0: leave the 0 out, or put quotation marks round it");
    }
    v.at = byte_of(mark);
    add(std::move(v));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    open(Located::Kind::Array, mark, tag, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    open(Located::Kind::Object, mark, tag, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  [[nodiscard]] std::size_t byte_of(const YAML::Mark& mark) const {
    if (mark.line < 0 || static_cast<std::size_t>(mark.line) >= starts_.size()) return text_.size();
    return std::min(text_.size(), starts_[static_cast<std::size_t>(mark.line)] +
                                      static_cast<std::size_t>(std::max(mark.column, 0)));
  }
  void refuse_anchor(const YAML::Mark& mark, YAML::anchor_t anchor) const {
    if (anchor != 0) fail(mark, "anchors and aliases are not read: write out what is meant");
  }
  [[nodiscard]] bool expects_name() const {
    return !open_.empty() && open_.back().kind == Located::Kind::Object &&
           open_.back().names.size() == open_.back().values.size();
  }
  void open(Located::Kind kind, const YAML::Mark& mark, const std::string& tag,
            YAML::anchor_t anchor) {
    constexpr std::size_t kDeepest = 64;
    refuse_anchor(mark, anchor);
    if (tag != "?" && tag != "!" && !tag.empty()) fail(mark, "the tag " + tag + " is not read");
    if (expects_name()) fail(mark, "the name of a member is expected");
    if (open_.size() >= kDeepest) fail(mark, "more than 64 lists and objects in each other");
    Located v;
    v.kind = kind;
    v.at = byte_of(mark);
    open_.push_back(std::move(v));
  }
  void close() {
    Located done = std::move(open_.back());
    open_.pop_back();
    if (const auto i = repeated_member(done))
      throw Error(ErrorCode::InvalidInput, name_ + ": " + place_in_text(text_, done.names_at[*i]) +
                                               ": '" + done.names[*i] + "' is used twice");
    add(std::move(done));
  }
  void add(Located value) {
    if (open_.empty())
      root_ = std::move(value);
    else if (open_.back().kind == Located::Kind::Array)
      open_.back().items.push_back(std::move(value));
    else
      open_.back().values.push_back(std::move(value));
  }

  std::string_view text_;
  const std::string& name_;
  std::vector<std::size_t> starts_;  ///< of the lines
  std::size_t documents_ = 0;
  Located root_;
  std::vector<Located> open_;
};

}  // namespace

Located parse_located_yaml(std::string_view text, const std::string& name) {
  YamlBuilder builder(text, name);
  std::istringstream stream{std::string(text)};
  try {
    YAML::Parser parser(stream);
    bool any = false;
    while (parser.HandleNextDocument(builder)) any = true;
    if (!any) throw Error(ErrorCode::InvalidInput, name + ": there is nothing in it");
  } catch (const YAML::Exception& error) {
    builder.fail(error.mark, "not YAML: " + error.msg);
  }
  return builder.take();
}

}  // namespace kaboum::world::detail

#else

namespace kaboum::world::detail {

Located parse_located_yaml(std::string_view /*text*/, const std::string& name) {
  throw Error(ErrorCode::NotBuilt, name +
                                       ": this build reads no YAML (it was made without yaml-cpp); "
                                       "write the scene as JSON");
}

}  // namespace kaboum::world::detail

#endif
