// XRDF and cuRobo's robots: lists of links by link, with their places in the text.

#include <kaboum/base/error.h>

#include "matrix.h"

#ifdef KABOUM_HAS_YAML
#include <yaml-cpp/yaml.h>
#endif

namespace kaboum::pairs::detail {

#ifdef KABOUM_HAS_YAML

namespace {

[[noreturn]] void refuse(const std::string& name, const YAML::Mark& mark, const std::string& what) {
  throw Error(ErrorCode::InvalidInput,
              name + ": line " + std::to_string(mark.line + 1) + ": " + what);
}

/// The value of a key anywhere below; cuRobo's is in robot_cfg, kinematics.
YAML::Node find(const YAML::Node& node, const std::string& key) {
  if (!node.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
  if (YAML::Node found = node[key]) return found;
  for (const auto& child : node)
    if (YAML::Node found = find(child.second, key); found.IsDefined()) return found;
  return YAML::Node(YAML::NodeType::Undefined);
}

/// A scalar's text, quotation marks included.
Stretch place_of(const YAML::Node& scalar, const std::string& text) {
  const auto begin = static_cast<std::size_t>(scalar.Mark().pos);
  const char quote = begin < text.size() ? text[begin] : '\0';
  if (quote == '"' || quote == '\'') {
    const std::size_t end = text.find(quote, begin + 1);
    return {begin, end == std::string::npos ? text.size() : end + 1};
  }
  return {begin, begin + scalar.Scalar().size()};
}

/// What to take out so that an item is none: of [a, b] with a comma, of a list by lines its line.
Stretch item(const std::string& text, const Stretch& scalar, bool flow) {
  if (!flow) {
    const std::size_t line = text.rfind('\n', scalar.begin) + 1;
    const std::size_t end = text.find('\n', scalar.end);
    return {line, end == std::string::npos ? text.size() : end + 1};
  }
  const auto next = text.find_first_not_of(" \t\r\n", scalar.end);
  if (next != std::string::npos && text[next] == ',') {
    std::size_t end = next + 1;
    while (end < text.size() && text[end] == ' ') ++end;
    return {scalar.begin, end};
  }
  const auto before = text.find_last_not_of(" \t\r\n", scalar.begin - 1);
  return {before != std::string::npos && text[before] == ',' ? before : scalar.begin, scalar.end};
}

}  // namespace

ReadMatrix read_yaml(const std::string& text, const std::string& name) {
  YAML::Node root;
  try {
    root = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    refuse(name, error.mark, error.msg);
  }
  ReadMatrix out;
  YAML::Node ignored = find(root, "self_collision_ignore");
  out.format = MatrixFormat::Curobo;
  if (!ignored.IsDefined()) {
    out.format = MatrixFormat::Xrdf;
    const YAML::Node self = root.IsMap() ? root["self_collision"] : YAML::Node();
    if (self && self.IsMap()) ignored = self["ignore"];
  }
  if (!ignored || (!ignored.IsMap() && !ignored.IsNull()))
    throw Error(ErrorCode::InvalidInput,
                name +
                    ": neither 'self_collision: ignore' (XRDF) nor 'self_collision_ignore' "
                    "(cuRobo) is in it, by links");
  for (const auto& entry : ignored) {
    const YAML::Node& others = entry.second;
    if (others.IsNull()) continue;
    if (!others.IsSequence())
      refuse(name, others.Mark(), "'" + entry.first.Scalar() + "' wants a list of links");
    const bool flow = others.Style() == YAML::EmitterStyle::Flow;
    const std::size_t before = out.pairs.size();
    for (const YAML::Node& other : others) {
      if (!other.IsScalar()) refuse(name, other.Mark(), "a link's name is wanted");
      out.pairs.push_back({{entry.first.Scalar(),
                            other.Scalar(),
                            "",
                            other.Mark().line + 1,
                            {item(text, place_of(other, text), flow)}}});
    }
    if (out.pairs.size() == before)
      out.faults.push_back({MatrixFault::Kind::EmptyGroup,
                            "the list of '" + entry.first.Scalar() + "' is empty",
                            entry.first.Mark().line + 1});
  }
  return out;
}

#else

ReadMatrix read_yaml(const std::string& /*text*/, const std::string& name) {
  throw Error(ErrorCode::NotBuilt, name + ": this build reads no YAML");
}

#endif

}  // namespace kaboum::pairs::detail
