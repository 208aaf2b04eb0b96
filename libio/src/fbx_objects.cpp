// The objects of FBX files: what kind they are, nothing of what they hold. Binary files are trees
// of records, text files are trees in braces; objects are the children of the record "Objects".

#include "fbx_objects.h"

#include <algorithm>
#include <array>
#include <cstdint>

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

/// Judges one object. @param type  its last text property, as "Mesh"; empty when it has none.
class ObjectCheck {
 public:
  explicit ObjectCheck(const Source& source) : source_(source) {}

  void operator()(std::string_view kind, std::string_view type, const char* where) {
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

 private:
  const Source& source_;
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
      check_(r.name, last_text(r), source_.begin() + at);
      at = r.end;
    }
  }

  /// The last property of type S.
  [[nodiscard]] std::string_view last_text(const Record& r) const {
    std::string_view text;
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
      if (type == 'S') text = source_.bytes.substr(at + 4, static_cast<std::size_t>(size) - 4);
      at += static_cast<std::size_t>(size);
    }
    return text;
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
    std::string_view key, type;  // of the record that is being read
    const char* where = at_;
    bool in_objects = false;
    while (at_ != source_.end()) {
      const char c = *at_;
      if (c == ';') {
        while (at_ != source_.end() && detail::char_class(*at_) != detail::kEol) ++at_;
      } else if (c == '"') {
        type = quoted();
      } else if (c == '{') {
        if (depth == 0) in_objects = key == "Objects";
        if (depth == 1 && in_objects) check_(key, type, where);
        ++depth;
        ++at_;
      } else if (c == '}') {
        if (depth == 0) fail(source_, at_, "a brace too many; the file is damaged");
        --depth;
        ++at_;
      } else if (is_name(c)) {
        const char* const first = at_;
        while (at_ != source_.end() && is_name(*at_)) ++at_;
        if (at_ != source_.end() && *at_ == ':') {
          key = {first, static_cast<std::size_t>(at_ - first)};
          type = {};
          where = first;
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

void check_fbx_objects(const Source& source) {
  Source named = source;
  named.text = !source.bytes.starts_with("Kaydara FBX Binary");
  ObjectCheck check(named);
  if (named.text) {
    TextObjects(named, check).read();
  } else {
    BinaryObjects(named, check).read();
  }
}

}  // namespace kaboum::io
