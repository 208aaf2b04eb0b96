// The objects of FBX files: what kind they are, nothing of what they hold. Binary files are trees
// of records, text files are trees in braces; objects are the children of the record "Objects".

#include "fbx_objects.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "bytes.h"
#include "text.h"

namespace kaboum::io {
namespace {

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Kinds of objects that neither hold nor move a surface; Geometry, NodeAttribute and Model apart.
constexpr std::array<std::string_view, 30> kHarmless = {"AnimationCurve",
                                                        "AnimationCurveNode",
                                                        "AnimationLayer",
                                                        "AnimationStack",
                                                        "Audio",
                                                        "AudioLayer",
                                                        "BindingOperator",
                                                        "BindingTable",
                                                        "CollectionExclusive",
                                                        "ControlSetPlug",
                                                        "DisplayLayer",
                                                        "Document",
                                                        "GenericNode",
                                                        "GlobalSettings",
                                                        "Implementation",
                                                        "LayeredTexture",
                                                        "Light",
                                                        "Material",
                                                        "Model",
                                                        "NodeAttributeProperties",
                                                        "ObjectMetaData",
                                                        "Pose",
                                                        "SceneInfo",
                                                        "SelectionNode",
                                                        "SelectionSet",
                                                        "Texture",
                                                        "Thumbnail",
                                                        "UserData",
                                                        "Version",
                                                        "Video"};
constexpr std::array<std::string_view, 12> kAttributes = {
    "Camera", "CameraSwitcher", "Effector", "FKEffector", "IKEffector",    "Light",
    "Limb",   "LimbNode",       "Marker",   "Null",       "OpticalMarker", "Root"};

/// Judges the objects one by one, then how they are connected.
class ObjectCheck {
 public:
  using Id = std::int64_t;
  static constexpr Id kRoot = 0;  ///< of the scene, which is no object

  explicit ObjectCheck(const Source& source) : source_(source) {}

  /// @param type  its last text property, as "Mesh"; empty when it has none.
  void object(std::string_view kind, std::string_view type, std::optional<Id> id,
              const char* where) {
    judge(kind, type, where);
    if (!id || (kind != "Model" && kind != "Geometry")) return;
    if (!objects_.try_emplace(*id, Object{kind, type, where}).second)
      fail(source_, where,
           "a second object of the number " + std::to_string(*id) + "; the file is damaged");
  }

  /// An object and what it belongs to. @param type  "OO": of two objects as wholes
  void connection(std::string_view type, Id object, Id owner) {
    if (type == "OO") owned_.emplace(owner, object);
  }

  /// What the scene does not show.
  [[nodiscard]] std::vector<std::string> notes() const {
    const auto is_model = [&](Id id) {
      const auto found = objects_.find(id);
      return found != objects_.end() && found->second.kind == "Model";
    };
    std::set<Id> shown{kRoot};
    for (std::vector<Id> stack{kRoot}; !stack.empty();) {
      const auto [first, last] = owned_.equal_range(stack.back());
      stack.pop_back();
      for (auto c = first; c != last; ++c)
        if (is_model(c->second) && shown.insert(c->second).second) stack.push_back(c->second);
    }
    std::set<Id> placed;
    for (const auto& [owner, id] : owned_) {
      const auto found = objects_.find(id);
      if (found == objects_.end() || found->second.kind != "Geometry" ||
          found->second.type != "Mesh" || !is_model(owner))
        continue;
      if (!shown.contains(owner))
        fail(source_, objects_.at(owner).where,
             "a model with a mesh that is not connected to the scene's root; connect it, or "
             "delete it");
      placed.insert(id);
    }
    const auto hidden = std::ranges::count_if(objects_, [&](const auto& entry) {
      return entry.second.kind == "Geometry" && entry.second.type == "Mesh" &&
             !placed.contains(entry.first);
    });
    if (hidden == 0) return {};
    return {counted(static_cast<std::size_t>(hidden), "mesh that no model shows was",
                    "meshes that no model shows were") +
            " left out."};
  }

 private:
  struct Object {
    std::string_view kind, type;
    const char* where;
  };

  void judge(std::string_view kind, std::string_view type, const char* where) const {
    if (kind == "Geometry") {
      // A Shape is a mesh's deformation, which a Deformer would apply; a Line has no surface.
      if (type != "Mesh" && type != "Shape" && type != "Line")
        fail(source_, where,
             "geometry of type " + in_quotes(type) + " is not supported; export as meshes");
    } else if (kind == "NodeAttribute") {
      if (!contains(kAttributes, type))
        fail(source_, where,
             "a node of type " + in_quotes(type) + " is not supported; export as plain meshes");
    } else if (kind == "Deformer") {
      fail(source_, where,
           "deformed meshes (" + in_quotes(type) +
               ") are not supported; apply the deformation before exporting");
    } else if (!contains(kHarmless, kind)) {
      fail(source_, where,
           "objects of kind " + in_quotes(kind) +
               " are not known and might hold geometry; export without them");
    }
  }

  const Source& source_;
  std::map<Id, Object> objects_;  ///< models and geometry
  std::multimap<Id, Id> owned_;   ///< by owner
};

// --- binary ---

/// Records: end, number and size of properties (4 or 8 bytes each), name, properties, children.
class BinaryObjects {
 public:
  BinaryObjects(const Source& source, ObjectCheck& check) : source_(source), check_(check) {}

  void read() {
    constexpr std::size_t kVersionAt = 23, kFirst = 27;
    if (source_.bytes.size() < kFirst) fail_damaged(source_.bytes.size());
    const auto version = load_little<std::uint32_t>(source_.begin() + kVersionAt);
    width_ = version >= 7500 ? 8 : 4;
    for (std::size_t at = kFirst; at < source_.bytes.size();) {
      const Record r = record(at, source_.bytes.size());
      if (r.end == 0) return;
      if (r.name == "Objects") read_objects(r);
      if (r.name == "Connections") read_connections(r);
      at = r.end;
    }
  }

 private:
  struct Record {
    std::size_t at;
    std::size_t end;  ///< 0: the end of the list
    std::uint64_t properties;
    std::size_t first_property;
    std::size_t children;  ///< behind the properties
    std::string_view name;
  };

  [[noreturn]] void fail_damaged(std::size_t at) const {
    fail(source_, source_.begin() + std::min(at, source_.bytes.size()),
         "a record reaches beyond its end; the file is damaged, export it again");
  }

  [[nodiscard]] std::uint64_t word(std::size_t at) const {
    return width_ == 8 ? load_little<std::uint64_t>(source_.begin() + at)
                       : load_little<std::uint32_t>(source_.begin() + at);
  }

  [[nodiscard]] Record record(std::size_t at, std::size_t limit) const {
    const std::size_t head = 3 * width_ + 1;
    if (limit - at < head) fail_damaged(at);
    const std::uint64_t end = word(at);
    if (end == 0) return {at, 0, 0, 0, 0, {}};
    const std::uint64_t count = word(at + width_);
    const std::uint64_t size = word(at + 2 * width_);
    const std::size_t name_size = static_cast<unsigned char>(source_.bytes[at + head - 1]);
    const std::size_t first = at + head + name_size;
    if (end > limit || first > end || size > end - first) fail_damaged(at);
    return {
        at,    static_cast<std::size_t>(end),          count,
        first, first + static_cast<std::size_t>(size), source_.bytes.substr(at + head, name_size)};
  }

  void read_objects(const Record& objects) {
    for (std::size_t at = objects.children; at < objects.end;) {
      const Record r = record(at, objects.end);
      if (r.end == 0) return;
      const Values values = values_of(r);
      check_.object(r.name, values.last_text,
                    values.count > 0 ? std::optional(values.first[0]) : std::nullopt,
                    source_.begin() + at);
      at = r.end;
    }
  }

  void read_connections(const Record& connections) {
    for (std::size_t at = connections.children; at < connections.end;) {
      const Record r = record(at, connections.end);
      if (r.end == 0) return;
      const Values values = values_of(r);
      if (r.name == "C" && values.count == 2)
        check_.connection(values.first_text, values.first[0], values.first[1]);
      at = r.end;
    }
  }

  struct Values {
    std::string_view first_text, last_text;     ///< of type S
    std::array<ObjectCheck::Id, 2> first = {};  ///< of type L
    std::size_t count = 0;                      ///< of these
  };

  [[nodiscard]] Values values_of(const Record& r) const {
    Values values;
    std::size_t at = r.first_property;
    for (std::uint64_t i = 0; i < r.properties; ++i) {
      if (at >= r.children) fail_damaged(r.at);
      const char type = source_.bytes[at++];
      std::uint64_t size = 0;
      if (type == 'Y') {
        size = 2;
      } else if (type == 'C' || type == 'B') {
        size = 1;
      } else if (type == 'I' || type == 'F') {
        size = 4;
      } else if (type == 'D' || type == 'L') {
        size = 8;
      } else {
        const bool array = type != 'S' && type != 'R';
        const std::size_t head = array ? 12 : 4;
        if (r.children - at < head) fail_damaged(r.at);
        size = head + load_little<std::uint32_t>(source_.begin() + at + (array ? 8 : 0));
      }
      if (size > r.children - at) fail_damaged(r.at);
      if (type == 'S') {
        values.last_text = source_.bytes.substr(at + 4, static_cast<std::size_t>(size) - 4);
        if (values.first_text.empty()) values.first_text = values.last_text;
      }
      if (type == 'L' && values.count < values.first.size())
        values.first[values.count++] = load_little<std::int64_t>(source_.begin() + at);
      at += static_cast<std::size_t>(size);
    }
    return values;
  }

  const Source& source_;
  ObjectCheck& check_;
  std::size_t width_ = 4;
};

// --- text ---

/// `Name: values {` children `}`; `;` begins a comment. Kinds and types of objects are in the line
/// that opens their brace.
class TextObjects {
 public:
  TextObjects(const Source& source, ObjectCheck& check)
      : source_(source), check_(check), at_(without_byte_order_mark(source.bytes).data()) {}

  void read() {
    std::size_t depth = 0;
    std::string_view key, first_text, type;  // of the record that is being read
    std::vector<ObjectCheck::Id> numbers;    // its first ones
    const char* where = at_;
    std::string_view section;
    const auto end_record = [&] {
      if (depth == 1 && section == "Connections" && key == "C" && numbers.size() == 2)
        check_.connection(first_text, numbers[0], numbers[1]);
      key = first_text = type = {};
      numbers.clear();
    };
    while (at_ != source_.end()) {
      const char c = *at_;
      if (c == ';') {
        while (at_ != source_.end() && detail::char_class(*at_) != detail::kEol) ++at_;
      } else if (c == '"') {
        type = quoted();
        if (first_text.empty()) first_text = type;
      } else if (c == '{') {
        if (depth == 0) section = key;
        if (depth == 1 && section == "Objects")
          check_.object(key, type, numbers.empty() ? std::nullopt : std::optional(numbers[0]),
                        where);
        end_record();
        ++depth;
        ++at_;
      } else if (c == '}') {
        if (depth == 0) fail(source_, at_, "a brace too many; the file is damaged");
        end_record();
        --depth;
        ++at_;
      } else if (is_name(c)) {
        const char* const first = at_;
        while (at_ != source_.end() && is_name(*at_)) ++at_;
        const std::string_view word(first, static_cast<std::size_t>(at_ - first));
        ObjectCheck::Id number = 0;
        if (at_ != source_.end() && *at_ == ':') {
          end_record();
          key = word;
          where = first;
        } else if (depth == 1 && numbers.size() < 2 &&
                   std::from_chars(word.data(), word.data() + word.size(), number).ptr ==
                       word.data() + word.size()) {
          numbers.push_back(number);
        }
      } else {
        ++at_;
      }
    }
    if (depth != 0)
      fail(source_, source_.end(),
           "braces that are not closed; the file is truncated, get it again");
  }

 private:
  static bool is_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '|' || c == '-' || c == '+' || c == '.';
  }

  std::string_view quoted() {
    const char* const first = ++at_;
    while (at_ != source_.end() && *at_ != '"') ++at_;
    if (at_ == source_.end())
      fail(source_, first, "a string without closing quote; the file is damaged");
    const std::string_view text{first, static_cast<std::size_t>(at_ - first)};
    ++at_;
    return text;
  }

  const Source& source_;
  ObjectCheck& check_;
  const char* at_;
};

}  // namespace

std::vector<std::string> check_fbx_objects(const Source& source) {
  Source named = source;
  named.text = !source.bytes.starts_with("Kaydara FBX Binary");
  ObjectCheck check(named);
  if (named.text) {
    TextObjects(named, check).read();
  } else {
    BinaryObjects(named, check).read();
  }
  return check.notes();
}

}  // namespace kaboum::io
