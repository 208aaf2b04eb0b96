// VRML 97 (ISO/IEC 14772-1): text becomes the nodes of a scene.

#include <map>

#include "scene_graph.h"
#include "text.h"

namespace kaboum::io {
namespace {

class VrmlParser {
 public:
  explicit VrmlParser(SceneFile& file) : file_(file), source_(file.source), at_(source_.begin()) {}

  void read() {
    read_header();
    for (;;) {
      const std::string_view word = token();
      if (word.empty()) return;
      if (is_statement(word)) {
        read_statement(word);
      } else if (const SceneNode* const node = read_node(word)) {
        file_.roots.push_back(node);
      }
    }
  }

 private:
  // --- tokens: words and numbers, "strings" with their quotes, and single brackets ---

  std::string_view token() {
    skip_space();
    last_ = at_;
    if (at_ == source_.end()) return {};
    if (is_bracket(*at_)) return {at_++, 1};
    if (*at_ == '"') return string_token();
    const char* const first = at_;
    while (at_ != source_.end() && !is_space(*at_) && !is_bracket(*at_) && *at_ != '"' &&
           *at_ != '#')
      ++at_;
    return {first, static_cast<std::size_t>(at_ - first)};
  }

  std::string_view string_token() {
    const char* const first = at_++;
    while (at_ != source_.end() && *at_ != '"')
      at_ += *at_ == '\\' && at_ + 1 != source_.end() ? 2 : 1;
    if (at_ == source_.end())
      fail(source_, first, "a string without closing quote; the file is damaged");
    ++at_;
    return {first, static_cast<std::size_t>(at_ - first)};
  }

  void skip_space() {
    while (at_ != source_.end()) {
      if (*at_ == '#') {
        while (at_ != source_.end() && detail::char_class(*at_) != detail::kEol) ++at_;
      } else if (is_space(*at_)) {
        ++at_;
      } else {
        return;
      }
    }
  }

  static bool is_space(char c) { return c == ',' || detail::char_class(c) != detail::kOther; }
  static bool is_bracket(char c) { return c == '{' || c == '}' || c == '[' || c == ']'; }

  std::string_view need(std::string_view what) {
    const std::string_view found = token();
    if (found.empty())
      fail(source_, source_.end(),
           "the file ends where " + std::string(what) +
               " is expected; it is truncated, get it again");
    return found;
  }

  void expect(std::string_view word) {
    const std::string_view found = need(in_quotes(word));
    if (found != word)
      fail(source_, last_,
           in_quotes(found) + " where '" + std::string(word) +
               "' is expected; the file is damaged or not VRML 97");
  }

  /// The next token without taking it.
  std::string_view peek() {
    const char* const at = at_;
    const char* const last = last_;
    const std::string_view found = token();
    at_ = at;
    last_ = last;
    return found;
  }

  static bool is_value(std::string_view word) {
    const char c = word.empty() ? '\0' : word.front();
    return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.' || c == '"' ||
           word == "TRUE" || word == "FALSE";
  }

  void read_header() {
    const std::string_view text = without_byte_order_mark(source_.bytes);
    at_ = text.data();
    if (text.starts_with("#VRML V1.0"))
      fail(source_, at_, "VRML 1.0 is not supported; convert the file to VRML 97 (V2.0)");
    if (text.starts_with("#X3D"))
      fail(source_, at_,
           "X3D in classic encoding is not supported; convert the file to X3D in XML");
    if (!text.starts_with("#VRML V2.0"))
      fail(source_, at_, "the file does not begin with '#VRML V2.0'; it is not a VRML 97 file");
  }

  static bool is_statement(std::string_view word) {
    return word == "ROUTE" || word == "PROTO" || word == "EXTERNPROTO";
  }

  void read_statement(std::string_view word) {
    if (word != "ROUTE")
      fail(source_, last_,
           std::string(word) + " is not supported; export the scene without prototypes");
    for (int i = 0; i < 3; ++i) need("the rest of a ROUTE");
    file_.routed = true;
  }

  /// The node that begins with `word`; nullptr for NULL.
  const SceneNode* read_node(std::string_view word) {
    if (word == "NULL") return nullptr;
    if (word == "USE") {
      const std::string_view name = need("a node name");
      const auto found = defined_.find(name);
      if (found == defined_.end())
        fail(source_, last_,
             "USE " + in_quotes(name) + " without a DEF before; the file is damaged");
      return found->second;
    }
    std::string_view name;
    if (word == "DEF") {
      name = need("a node name");
      word = need("a node");
    }
    if (is_bracket(word.front()) || is_value(word))
      fail(source_, last_, in_quotes(word) + " where a node is expected; the file is damaged");
    if (++depth_ > kMaxSceneDepth) fail_depth();
    SceneNode& node = file_.nodes.emplace_back(SceneNode{word, last_});
    if (!name.empty()) defined_[name] = &node;
    expect("{");
    if (word == "Script") {
      skip_script();
    } else {
      read_fields(node);
    }
    --depth_;
    return &node;
  }

  [[noreturn]] void fail_depth() const {
    fail(source_, last_,
         "nodes are nested more than " + std::to_string(kMaxSceneDepth) +
             " deep; flatten the scene");
  }

  /// Up to the closing brace.
  void read_fields(SceneNode& node) {
    for (;;) {
      const std::string_view name = need("a field or '}'");
      if (name == "}") return;
      if (is_bracket(name.front()) || is_value(name))
        fail(source_, last_, in_quotes(name) + " where a field is expected; the file is damaged");
      if (is_statement(name)) {
        read_statement(name);
      } else {
        read_value({name, {}, {}, last_}, node);
      }
    }
  }

  void read_value(SceneField field, SceneNode& node) {
    std::string_view word = need("a value");
    const char* const first = last_;
    if (word == "[") {
      const char* const begin = at_;
      word = need("a value or ']'");
      if (is_value(word)) {
        while (is_value(word)) word = need("a value or ']'");
        if (word != "]")
          fail(source_, last_, in_quotes(word) + " among values; the file is damaged");
        field.text = {begin, static_cast<std::size_t>(last_ - begin)};
      } else {
        for (; word != "]"; word = need("a node or ']'")) {
          if (word == "NULL") fail(source_, last_, "NULL among nodes; the file is damaged");
          field.nodes.push_back(read_node(word));
        }
      }
    } else if (is_value(word)) {
      while (is_value(peek())) token();
      field.text = {first, static_cast<std::size_t>(at_ - first)};
    } else if (const SceneNode* const inner = read_node(word)) {
      field.nodes.push_back(inner);
    }
    if (node.fields.size() >= kMaxSceneFields)
      fail(source_, field.where, "a node with too many fields; the file is damaged");
    for (const SceneField& other : node.fields) {
      if (other.name != field.name) continue;
      if (node.type == "Material")
        return;  // Robotics Library: two materials in one; colours say nothing of shapes
      fail(source_, field.where,
           "the field " + in_quotes(field.name) + " is given twice; the file is damaged");
    }
    node.fields.push_back(std::move(field));
  }

  /// A Script declares fields of its own, whose nodes may be used elsewhere.
  void skip_script() {
    for (std::size_t open = 1; open > 0;) {
      const std::string_view word = need("a closing bracket");
      if (word == "{" || word == "[") ++open;
      if (open > 2 * kMaxSceneDepth) fail_depth();
      if (word == "}" || word == "]") --open;
      if (word == "DEF") read_node(word);
    }
  }

  SceneFile& file_;
  const Source& source_;
  const char* at_;
  const char* last_ = at_;  ///< start of the latest token
  std::size_t depth_ = 0;
  std::map<std::string_view, const SceneNode*> defined_;
};

}  // namespace

void parse_vrml(SceneFile& file) {
  file.siblings_move = true;
  VrmlParser(file).read();
}

}  // namespace kaboum::io
