// --epsilons: a file that says how near the shapes of single links are to be held.

#include "link_epsilons.h"

#include <kaboum/base/error.h>
#include <kaboum/base/parse_length.h>
#include <kaboum/base/similar_name.h>

#ifdef KABOUM_HAS_YAML
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <map>
#include <sstream>
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

constexpr const char* kForm = "give links with lengths, as in\n  wrist_*: 0.5%\n  base_link: 0.01";

[[noreturn]] void fail(const std::string& file, const YAML::Mark& mark, const std::string& what) {
  throw Error(ErrorCode::InvalidInput, file + ":" + std::to_string(mark.line + 1) + ": " + what);
}

/// Takes the parser's events: a mapping of names to lengths, and nothing else.
class Entries : public YAML::EventHandler {
 public:
  explicit Entries(const std::string& file) : file_(file) {}

  std::vector<Entry> take() {
    if (!begun_) throw Error(ErrorCode::InvalidInput, file_ + ": " + kForm);
    return std::move(entries_);
  }

  // One at most: after some errors the parser finds empty documents without end.
  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1) fail(file_, mark, "a second document; all links are to be in one");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override {
    if (!named_) fail(file_, mark, kForm);
    take_length(mark, "");
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override {
    fail(file_, mark, "anchors and aliases are not read: write out what is meant");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                const std::string& value) override {
    if (!begun_) fail(file_, mark, kForm);
    if (named_)
      take_length(mark, value);
    else
      take_name(mark, value);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/,
                       YAML::anchor_t /*anchor*/, YAML::EmitterStyle::value /*style*/) override {
    fail(file_, mark, kForm);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  YAML::EmitterStyle::value /*style*/) override {
    if (begun_) fail(file_, mark, kForm);
    begun_ = true;
  }
  void OnMapEnd() override {}

 private:
  void take_name(const YAML::Mark& mark, const std::string& name) {
    const auto [other, added] = lines_.emplace(name, mark.line + 1);
    if (!added)
      fail(file_, mark,
           "'" + name + "' is there already, in line " + std::to_string(other->second));
    entries_.push_back({name, {}, mark.line + 1});
    named_ = true;
  }
  void take_length(const YAML::Mark& mark, const std::string& value) {
    const auto length = parse_length(value);
    if (!length)
      fail(file_, mark,
           "'" + entries_.back().pattern + "': '" + value +
               "' must be a positive number, perhaps with a unit, as in 5mm, or a percentage such "
               "as "
               "0.5%, without blanks");
    entries_.back().epsilon = length->in("m");
    named_ = false;
  }

  const std::string& file_;
  std::vector<Entry> entries_;
  std::map<std::string, int> lines_;  ///< of the names
  int documents_ = 0;
  bool begun_ = false, named_ = false;  ///< the mapping; an entry that has no length yet
};

std::vector<Entry> entries_of(const std::string& text, const std::string& file) {
  Entries entries(file);
  std::istringstream stream(text);
  try {
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(entries)) {
    }
  } catch (const YAML::Exception& error) {
    fail(file, error.mark, error.msg);
  }
  return entries.take();
}

}  // namespace

certify::LinkEpsilons parse_epsilons(const std::string& text, const std::string& file,
                                     const robot::Robot& robot) {
  certify::LinkEpsilons out;
  std::vector<Entry> entries = entries_of(text, file);
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

certify::LinkEpsilons parse_epsilons(const std::string& /*text*/, const std::string& file,
                                     const robot::Robot& /*robot*/) {
  throw Error(ErrorCode::NotBuilt, "--epsilons: this build has no yaml-cpp to read " + file);
}

#endif

}  // namespace kaboum::tools
