// --epsilons: a file that says how near the shapes of single links are to be held.

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/io/mesh_io.h>

#include "robot_options.h"

#ifdef KABOUM_HAS_YAML
#include <yaml-cpp/yaml.h>
#endif

namespace kaboum::tools {

#ifdef KABOUM_HAS_YAML

namespace {

/// A line of the file.
struct Entry {
  std::string pattern;
  Length epsilon;
  int line = 0;
  bool used = false;

  [[nodiscard]] bool is_pattern() const { return pattern.find_first_of("*?") != std::string::npos; }
};

/// * stands for any characters, also none; ? for one.
bool fits(std::string_view pattern, std::string_view name) {
  std::vector<char> begins(name.size() + 1, 0);  // whether the pattern so far fits so much of it
  begins[0] = 1;
  for (const char c : pattern) {
    if (c == '*') {
      for (std::size_t i = 1; i <= name.size(); ++i) begins[i] = begins[i] | begins[i - 1];
      continue;
    }
    for (std::size_t i = name.size(); i > 0; --i)
      begins[i] = begins[i - 1] != 0 && (c == '?' || c == name[i - 1]) ? 1 : 0;
    begins[0] = 0;
  }
  return begins.back() != 0;
}

[[noreturn]] void fail(const std::string& file, const YAML::Mark& mark, const std::string& what) {
  throw Error(ErrorCode::InvalidInput, file + ":" + std::to_string(mark.line + 1) + ": " + what);
}

std::vector<Entry> read_entries(const std::string& file) {
  const std::vector<char> bytes = io::read_file(file);
  const std::string form = "give links with lengths, as in\n  wrist_*: 0.5%\n  base_link: 0.01";
  try {
    const YAML::Node root = YAML::Load(std::string(bytes.begin(), bytes.end()));
    if (!root.IsMap()) fail(file, root.Mark(), form);
    std::vector<Entry> out;
    for (const auto& item : root) {
      const YAML::Mark mark = item.first.Mark();
      if (!item.first.IsScalar() || !item.second.IsScalar()) fail(file, mark, form);
      const std::string name = item.first.Scalar(), value = item.second.Scalar();
      const auto length = parse_length(value);
      if (!length)
        fail(file, item.second.Mark(),
             "'" + name + "': '" + value +
                 "' must be a positive number, or a percentage such as 0.5%, without blanks or "
                 "units");
      for (const Entry& other : out)
        if (other.pattern == name)
          fail(file, mark,
               "'" + name + "' is there already, in line " + std::to_string(other.line));
      out.push_back({name, *length, mark.line + 1});
    }
    return out;
  } catch (const YAML::Exception& error) {
    fail(file, error.mark, error.msg);
  }
}

}  // namespace

certify::LinkEpsilons read_epsilons(const std::string& file, const robot::Robot& robot) {
  certify::LinkEpsilons out;
  if (file.empty()) return out;
  std::vector<Entry> entries = read_entries(file);
  std::vector<std::string> links;
  for (const robot::Link& link : robot.links) {
    links.push_back(link.name);
    for (const bool patterns : {false, true})
      for (Entry& entry : entries) {
        if (entry.is_pattern() != patterns) continue;
        if (patterns ? !fits(entry.pattern, link.name) : entry.pattern != link.name) continue;
        entry.used = true;
        out.emplace(link.name, entry.epsilon);  // the first stays
      }
  }
  for (const Entry& entry : entries)
    if (!entry.used)
      throw Error(ErrorCode::InvalidInput, file + ":" + std::to_string(entry.line) +
                                               ": no link is called '" + entry.pattern + "'" +
                                               did_you_mean(entry.pattern, links));
  return out;
}

#else

certify::LinkEpsilons read_epsilons(const std::string& file, const robot::Robot&) {
  if (file.empty()) return {};
  throw Error(ErrorCode::NotBuilt, "--epsilons: this build has no yaml-cpp to read " + file);
}

#endif

}  // namespace kaboum::tools
