// SRDF, MJCF and Drake's filter groups: elements with their places in the text.

#include <kaboum/base/error.h>

#include <algorithm>
#include <map>
#include <set>

#include "matrix.h"

namespace kaboum::pairs::detail {
namespace {

struct Element {
  std::string name;
  std::map<std::string, std::string> attributes;
  Stretch place;  ///< with its end tag
  std::size_t end_tag = 0;
  int line = 0;
  std::size_t parent = 0;  ///< of the list; the element itself: it has none
};

[[noreturn]] void refuse(const std::string& name, int line, const std::string& what) {
  throw Error(ErrorCode::InvalidInput, name + ": line " + std::to_string(line) + ": " + what);
}

std::string unescaped(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    bool found = false;
    for (const auto& [entity, character] :
         {std::pair{"&amp;", '&'}, std::pair{"&lt;", '<'}, std::pair{"&gt;", '>'},
          std::pair{"&quot;", '"'}, std::pair{"&apos;", '\''}}) {
      const std::string word = entity;
      if (text.compare(i, word.size(), word) != 0) continue;
      out += character;
      i += word.size() - 1;
      found = true;
      break;
    }
    if (!found) out += text[i];
  }
  return out;
}

/// All elements of a document, in the order of their start tags.
class Scanner {
 public:
  Scanner(const std::string& text, const std::string& name) : text_(text), name_(name) {}

  std::vector<Element> run() {
    while ((at_ = text_.find('<', at_)) != std::string::npos) {
      if (skip("<!--", "-->") || skip("<![CDATA[", "]]>") || skip("<?", "?>") || skip("<!", ">"))
        continue;
      if (text_.compare(at_, 2, "</") == 0)
        end_tag();
      else
        start_tag();
    }
    if (!open_.empty())
      refuse(name_, elements_[open_.back()].line,
             "<" + elements_[open_.back()].name + "> has no end");
    return std::move(elements_);
  }

 private:
  bool skip(const char* begin, const char* end) {
    const std::string opening = begin;
    if (text_.compare(at_, opening.size(), opening) != 0) return false;
    const std::size_t to = text_.find(end, at_ + opening.size());
    if (to == std::string::npos) refuse(name_, line_at(text_, at_), opening + " has no end");
    at_ = to + std::string(end).size();
    return true;
  }

  void end_tag() {
    const std::size_t end = text_.find('>', at_);
    if (end == std::string::npos) refuse(name_, line_at(text_, at_), "a tag has no end");
    std::string word = text_.substr(at_ + 2, end - at_ - 2);
    word.erase(word.find_last_not_of(" \t\r\n") + 1);
    if (open_.empty() || elements_[open_.back()].name != word)
      refuse(name_, line_at(text_, at_), "</" + word + "> ends nothing");
    elements_[open_.back()].end_tag = at_;
    elements_[open_.back()].place.end = end + 1;
    open_.pop_back();
    at_ = end + 1;
  }

  void start_tag() {
    const int line = line_at(text_, at_);
    Element element;
    element.line = line;
    element.place.begin = at_++;
    const auto space = [&] {
      at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size());
    };
    const auto word = [&] {
      const std::size_t end = std::min(text_.find_first_of(" \t\r\n=/>", at_), text_.size());
      std::string out = text_.substr(at_, end - at_);
      at_ = end;
      return out;
    };
    element.name = word();
    for (;;) {
      space();
      if (at_ >= text_.size()) refuse(name_, line, "<" + element.name + " has no end");
      if (text_[at_] == '>' || text_[at_] == '/') break;
      const std::string key = word();
      space();
      if (key.empty() || at_ >= text_.size() || text_[at_] != '=')
        refuse(name_, line, "<" + element.name + ">: an attribute has no value");
      ++at_;
      space();
      const char quote = at_ < text_.size() ? text_[at_] : '\0';
      const std::size_t end =
          quote == '"' || quote == '\'' ? text_.find(quote, at_ + 1) : std::string::npos;
      if (end == std::string::npos)
        refuse(name_, line, "<" + element.name + ">: the value of '" + key + "' has no quotes");
      if (!element.attributes.emplace(key, unescaped(text_.substr(at_ + 1, end - at_ - 1))).second)
        refuse(name_, line, "<" + element.name + "> has '" + key + "' twice");
      at_ = end + 1;
    }
    const bool is_empty = text_[at_] == '/';
    if (is_empty && (at_ + 1 >= text_.size() || text_[at_ + 1] != '>'))
      refuse(name_, line, "<" + element.name + ">: '/' without '>'");
    at_ += is_empty ? 2 : 1;
    element.place.end = at_;
    element.parent = open_.empty() ? elements_.size() : open_.back();
    if (!is_empty) open_.push_back(elements_.size());
    elements_.push_back(std::move(element));
  }

  const std::string& text_;
  const std::string& name_;
  std::size_t at_ = 0;
  std::vector<Element> elements_;
  std::vector<std::size_t> open_;
};

std::string attribute(const Element& element, const char* key, const std::string& name) {
  const auto at = element.attributes.find(key);
  if (at == element.attributes.end())
    refuse(name, element.line, "<" + element.name + "> has no '" + key + "'");
  return at->second;
}

std::string attribute_or(const Element& element, const char* key) {
  const auto at = element.attributes.find(key);
  return at == element.attributes.end() ? std::string() : at->second;
}

void read_groups(const std::vector<Element>& elements, const std::string& name, ReadMatrix& out) {
  struct Group {
    int line = 0;
    std::vector<std::string> members, groups;
    std::vector<std::pair<std::string, int>> ignored;
    int members_line = 0;
  };
  std::map<std::string, Group> groups;
  std::vector<std::string> order;
  for (const Element& e : elements) {
    if (e.name == "drake:collision_filter_group") {
      const std::string group = attribute(e, "name", name);
      if (groups.contains(group))
        out.faults.push_back({MatrixFault::Kind::Doubled,
                              "the group '" + group + "' is stated in line " +
                                  std::to_string(groups[group].line) + " already",
                              e.line});
      else
        order.push_back(group);
      groups[group].line = e.line;
      continue;
    }
    const Element& parent = elements[e.parent];
    if (parent.name != "drake:collision_filter_group") continue;
    Group& group = groups[attribute(parent, "name", name)];
    if (e.name == "drake:member")
      group.members.push_back(attribute(e, "link", name));
    else if (e.name == "drake:member_group")
      group.groups.push_back(attribute(e, "name", name));
    else if (e.name == "drake:ignored_collision_filter_group")
      group.ignored.emplace_back(attribute(e, "name", name), e.line);
  }
  const auto expand = [&](const std::string& of) {
    std::vector<std::string> links;
    std::set<std::string> seen{of};
    std::vector<std::string> todo{of};
    while (!todo.empty()) {
      const std::string at = todo.back();
      todo.pop_back();
      const auto group = groups.find(at);
      if (group == groups.end()) continue;
      links.insert(links.end(), group->second.members.begin(), group->second.members.end());
      for (const std::string& other : group->second.groups)
        if (seen.insert(other).second) todo.push_back(other);
    }
    return links;
  };
  for (const std::string& of : order) {
    const Group& group = groups[of];
    const std::vector<std::string> links = expand(of);
    const auto empty = [&](const std::string& what, int line) {
      out.faults.push_back({MatrixFault::Kind::EmptyGroup, what, line});
    };
    if (links.empty()) empty("the group '" + of + "' has no links", group.line);
    for (const auto& [other, line] : group.ignored) {
      if (!groups.contains(other)) {
        empty("there is no group '" + other + "', so nothing is ignored", line);
        continue;
      }
      for (const std::string& a : links)
        for (const std::string& b : expand(other))
          out.pairs.push_back({{a, b, "", line}, false, true});
    }
  }
}

}  // namespace

ReadMatrix read_xml(const std::string& text, const std::string& name,
                    const std::vector<std::string>& links) {
  const std::vector<Element> elements = Scanner(text, name).run();
  if (elements.empty()) refuse(name, 1, "there is no element");
  const auto has = [&](const char* word) {
    return std::ranges::any_of(elements, [&](const Element& e) { return e.name == word; });
  };
  ReadMatrix out;
  if (elements.front().name == "mujoco") {
    out.format = MatrixFormat::Mjcf;
    for (const Element& e : elements)
      if (e.name == "exclude" && elements[e.parent].name == "contact")
        out.pairs.push_back({{attribute(e, "body1", name),
                              attribute(e, "body2", name),
                              "",
                              e.line,
                              {with_line(text, e.place)}}});
    return out;
  }
  if (has("drake:collision_filter_group")) {
    out.format = MatrixFormat::Drake;
    read_groups(elements, name, out);
    return out;
  }
  if (elements.front().name != "robot")
    refuse(name, elements.front().line,
           "<" + elements.front().name + "> is neither SRDF (<robot>) nor MJCF (<mujoco>)");
  if (std::ranges::any_of(elements, [](const Element& e) { return e.name.starts_with("xacro:"); }))
    refuse(name, elements.front().line, "this is xacro: give what xacro makes of it");
  for (const Element& e : elements)
    if (e.name == "link" && e.parent == 0)
      refuse(name, e.line, "<link>: this is a robot (URDF), which states no pairs: give its SRDF");
  out.end_of_statements = elements.front().end_tag;
  for (const Element& e : elements) {
    if (e.name == "disable_collisions" || e.name == "enable_collisions") {
      out.pairs.push_back({{attribute(e, "link1", name),
                            attribute(e, "link2", name),
                            attribute_or(e, "reason"),
                            e.line,
                            {with_line(text, e.place)}},
                           e.name == "enable_collisions"});
    } else if (e.name == "disable_default_collisions") {
      const std::string link = attribute(e, "link", name);
      for (const std::string& other : links)
        if (other != link || links.size() == 1)
          out.pairs.push_back({{link, other, attribute_or(e, "reason"), e.line}, false, true});
    }
  }
  return out;
}

}  // namespace kaboum::pairs::detail
