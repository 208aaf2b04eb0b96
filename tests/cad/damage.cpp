// Damage to the text of CAD files, by seed.
#include "damage.h"

#include <kaboum/base/random.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <map>
#include <optional>
#include <regex>
#include <sstream>
#include <vector>

namespace kaboum::test {
namespace {

// --- STEP: records "#12 = NAME(...);" ---

struct Record {
  int number;
  std::size_t begin, end;  ///< in the text, with number and semicolon
  std::string name;        ///< of the first entity in it
};

std::vector<Record> records_of(const std::string& text) {
  std::vector<Record> out;
  std::size_t at = text.find("DATA;");
  while (at != std::string::npos && (at = text.find('#', at)) != std::string::npos) {
    std::size_t end = at;
    bool quoted = false;
    for (; end < text.size() && (quoted || text[end] != ';'); ++end)
      if (text[end] == '\'') quoted = !quoted;
    if (end == text.size()) break;
    Record record{std::atoi(text.c_str() + at + 1), at, end + 1, {}};
    std::size_t name = text.find('=', at);
    while (name < end && !std::isalpha(static_cast<unsigned char>(text[name]))) ++name;
    while (name < end &&
           (std::isalnum(static_cast<unsigned char>(text[name])) != 0 || text[name] == '_'))
      record.name += text[name++];
    out.push_back(record);
    at = end + 1;
  }
  return out;
}

/// A part of the text: where it is.
struct Span {
  std::size_t begin, end;
};

/// Where the pattern's first group, or all of it, is in a part of the text.
std::vector<Span> all_of(const std::string& text, Span in, const std::regex& pattern) {
  std::vector<Span> out;
  const auto begin = text.begin() + static_cast<std::ptrdiff_t>(in.begin),
             end = text.begin() + static_cast<std::ptrdiff_t>(in.end);
  for (std::sregex_iterator i(begin, end, pattern), none; i != none; ++i) {
    const int group = i->size() > 1 ? 1 : 0;
    out.push_back({in.begin + static_cast<std::size_t>(i->position(group)),
                   in.begin + static_cast<std::size_t>(i->position(group) + i->length(group))});
  }
  return out;
}

const std::regex& references() {
  static const std::regex pattern("#[0-9]+");
  return pattern;
}
const std::regex& numbers() {
  static const std::regex pattern("[(,]\\s*([-+]?[0-9]+\\.[0-9]*(?:E[-+]?[0-9]+)?)");
  return pattern;
}

/// Whether records of that name say where something is, or in which unit.
bool places(const std::string& name) {
  for (const char* word :
       {"UNIT", "CONTEXT", "TRANSFORMATION", "PLACEMENT", "MAPPED", "MAP", "RELATIONSHIP",
        "ASSEMBLY", "MEASURE", "UNCERTAINTY", "DIRECTION", "CARTESIAN_POINT", "DIMENSIONAL"})
    if (name.find(word) != std::string::npos) return true;
  return false;
}

std::string replaced(const std::string& text, Span at, const std::string& by) {
  return text.substr(0, at.begin) + by + text.substr(at.end);
}

class StepDamage {
 public:
  StepDamage(const std::string& text, std::uint64_t seed)
      : text_(text), records_(records_of(text)), random_(seed) {}

  Damage make() {
    for (;;) {  // until something can be done to the record that was drawn
      const Record& record = records_[random_.index(records_.size())];
      out_ = {};
      if (!damage(record, static_cast<int>(random_.index(16)))) continue;
      for (const Record& r : records_)
        if (out_.touched.contains(r.number) && places(r.name)) out_.placing.insert(r.number);
      out_.what += " of #" + std::to_string(record.number) + " = " + record.name;
      return out_;
    }
  }

 private:
  [[nodiscard]] Span body(const Record& record) const {
    return {text_.find('=', record.begin) + 1, record.end};
  }
  std::string slice(Span at) const { return text_.substr(at.begin, at.end - at.begin); }
  std::optional<Span> one_of(const std::vector<Span>& spans) {
    if (spans.empty()) return std::nullopt;
    return spans[random_.index(spans.size())];
  }

  bool put(const Record& record, const char* what, Span at, const std::string& by) {
    if (slice(at) == by) return false;
    out_.what = what;
    out_.text = replaced(text_, at, by);
    out_.touched.insert(record.number);
    return true;
  }

  bool swap(const Record& record, const char* what, const std::regex& pattern) {
    const std::vector<Span> all = all_of(text_, body(record), pattern);
    if (all.size() < 2) return false;
    const std::size_t i = random_.index(all.size() - 1);
    const Span a = all[i], b = all[i + 1];
    return put(record, what, {a.begin, b.end}, slice(b) + slice({a.end, b.begin}) + slice(a));
  }

  bool truncate(const Record& record) {
    const std::size_t at = record.begin + random_.index(record.end - record.begin);
    out_.what = "truncation in the middle";
    out_.text = text_.substr(0, at);
    // A careless end, so that some readers notice nothing.
    if (random_.index(2) == 0) out_.text += "\nENDSEC;\nEND-ISO-10303-21;\n";
    for (const Record& r : records_)
      if (r.end > at) out_.touched.insert(r.number);
    return true;
  }

  /// Leaves out an item of a list: a face of a shell, an edge of a loop.
  bool shorten(const Record& record) {
    static const std::regex pattern("(#[0-9]+,|,#[0-9]+)");
    const auto at = one_of(all_of(text_, body(record), pattern));
    return at && put(record, "an item left out", *at, "");
  }

  bool change_number(const Record& record) {
    const auto at = one_of(all_of(text_, body(record), numbers()));
    if (!at) return false;
    static constexpr std::array<double, 5> kFactors{-1, 10, 0.1, 1.5, 1 + 1e-3};
    std::array<char, 40> digits{};
    std::snprintf(digits.data(), digits.size(), "%.15E",
                  kFactors[random_.index(kFactors.size())] * std::atof(slice(*at).c_str()) +
                      (random_.index(4) == 0 ? 7 : 0));
    return put(record, "a number changed", *at, digits.data());
  }

  bool change_reference(const Record& record, bool missing) {
    const auto at = one_of(all_of(text_, body(record), references()));
    const int other = missing ? 999'999 : records_[random_.index(records_.size())].number;
    return at && put(record, missing ? "a reference to nothing" : "another reference", *at,
                     "#" + std::to_string(other));
  }

  bool change_name(const Record& record) {
    static const std::vector<std::string> kNames{
        "PLANE",        "CYLINDRICAL_SURFACE", "SPHERICAL_SURFACE",
        "OPEN_SHELL",   "CLOSED_SHELL",        "ADVANCED_FACE",
        "FACE_SURFACE", "EDGE_LOOP",           "CIRCLE",
        "LINE",         "FACE_BOUND",          "POLY_LOOP"};
    const std::size_t at = text_.find(record.name, record.begin);
    return put(record, "the name of another entity in place", {at, at + record.name.size()},
               kNames[random_.index(kNames.size())]);
  }

  bool change_unit() {
    static const std::array<std::array<const char*, 2>, 4> kChanges{
        {{".MILLI.", ".CENTI."}, {".MILLI.", "$"}, {"0.0254", "0.3048"}, {"25.4", "1."}}};
    const auto& [from, to] = kChanges[random_.index(kChanges.size())];
    const std::size_t at = text_.find(from);
    if (at == std::string::npos) return false;
    out_.what = std::string("the unit ") + from + " made " + to + ", beside that";
    out_.text = replaced(text_, {at, at + std::string(from).size()}, to);
    for (const Record& r : records_)
      if (at >= r.begin && at < r.end) out_.touched.insert(r.number);
    return true;
  }

  bool turn(const Record& record) {
    static const std::regex pattern("\\.[TF]\\.");
    const auto at = one_of(all_of(text_, body(record), pattern));
    return at && put(record, "a logical turned", *at, slice(*at) == ".T." ? ".F." : ".T.");
  }

  bool damage(const Record& record, int kind) {
    const Span whole{record.begin, record.end};
    const std::size_t name = text_.find(record.name, record.begin);
    switch (kind) {
      case 0:
        return put(record, "loss", whole, "");
      case 1:
        return put(record, "an unknown name", {name, name + record.name.size()},
                   "UNKNOWN_" + record.name);
      case 2:
        return change_reference(record, false);
      case 3:
        return change_reference(record, true);
      case 4:
        return truncate(record);
      case 5:
        return swap(record, "two numbers swapped", numbers());
      case 6:
      case 7:
        return change_number(record);
      case 8:
      case 9:
        return shorten(record);
      case 10:
        return change_unit();
      case 11:
        return turn(record);
      case 12:
        return swap(record, "two references swapped", references());
      case 13:
        return change_name(record);
      case 14: {
        const auto at = one_of(all_of(text_, body(record), numbers()));
        return at &&
               put(record, "nonsense for a number", *at, random_.index(2) == 0 ? "1.E400" : "abc");
      }
      default: {
        static const std::regex pattern("\\(((?:#[0-9]+,?)+)\\)");
        const auto at = one_of(all_of(text_, body(record), pattern));
        return at && put(record, "an emptied list", *at, "");
      }
    }
  }

  const std::string& text_;
  std::vector<Record> records_;
  Random random_;
  Damage out_;
};

// --- IGES: lines of 80 columns; two of the directory and some of parameters make an entity ---

constexpr std::size_t kColumns = 80, kSection = 72, kParameters = 64;

struct Line {
  std::size_t begin, end;  ///< in the text, without its end
  char section;
  int number;  ///< in its section
  int owner;   ///< the directory entry that it belongs to; 0: none
};

std::vector<Line> lines_of(const std::string& text) {
  std::vector<Line> out;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = text.find('\n', at);
    if (end == std::string::npos) end = text.size();
    if (end - at >= kColumns) {
      Line line{at, end, text[at + kSection], std::atoi(text.substr(at + kSection + 1, 7).c_str()),
                0};
      if (line.section == 'D') line.owner = line.number - (line.number + 1) % 2;
      if (line.section == 'P') line.owner = std::atoi(text.substr(at + kParameters, 8).c_str());
      out.push_back(line);
    }
    at = end + 1;
  }
  return out;
}

class IgesDamage {
 public:
  IgesDamage(const std::string& text, std::uint64_t seed)
      : text_(text), lines_(lines_of(text)), random_(seed) {}

  Damage make() {
    for (;;) {
      const Line& line = lines_[random_.index(lines_.size())];
      out_ = {};
      if (!damage(line, static_cast<int>(random_.index(10)))) continue;
      out_.header = out_.header || line.section == 'G' || line.section == 'S';
      for (const Line& other : lines_)
        if (out_.touched.contains(other.owner) && is_matrix(other))
          out_.placing.insert(other.owner);
      out_.what += std::string(" in line ") + line.section + std::to_string(line.number);
      return out_;
    }
  }

 private:
  /// A transformation (type 124), or an entity's directory entry, which names one.
  [[nodiscard]] bool is_matrix(const Line& line) const {
    if (line.section == 'D') return true;
    return text_.compare(line.begin, 4, "124,") == 0;
  }

  bool put(const Line& line, const char* what, Span at, std::string by) {
    if (at.end - at.begin != by.size() && by.size() < at.end - at.begin)
      by.resize(at.end - at.begin, ' ');
    if (text_.substr(at.begin, at.end - at.begin) == by) return false;
    out_.what = what;
    out_.text = replaced(text_, at, by);
    if (line.owner > 0) out_.touched.insert(line.owner);
    return true;
  }

  /// The part of a line that is its entity's.
  [[nodiscard]] Span data(const Line& line) const {
    return {line.begin, line.begin + (line.section == 'P' ? kParameters : kSection)};
  }

  bool change(const Line& line, const char* what, const std::regex& pattern,
              const std::vector<std::string>& by) {
    const std::vector<Span> all = all_of(text_, data(line), pattern);
    if (all.empty()) return false;
    const Span at = all[random_.index(all.size())];
    std::string text = by[random_.index(by.size())];
    if (text.size() > at.end - at.begin) text.resize(at.end - at.begin);
    return put(line, what, at, text);
  }

  bool damage(const Line& line, int kind) {
    static const std::regex integers("[, ]([0-9]+)[,; ]"), reals("[-]?[0-9]+\\.[0-9]*"),
        digits("[1-9]");
    switch (kind) {
      case 0:  // the line is lost
        out_.what = "loss";
        out_.text =
            text_.substr(0, line.begin) + text_.substr(std::min(line.end + 1, text_.size()));
        if (line.owner > 0) out_.touched.insert(line.owner);
        return true;
      case 1:
        return put(line, "blanks", data(line), " ");
      case 2:
      case 3:
        return change(line, "another integer", integers, {"1", "3", "17", "999", "0"});
      case 4:
      case 5:
        return change(line, "another real", reals, {"1.5", "-2.", "0.", "9999."});
      case 6:
        return change(line, "another digit", digits, {"1", "2", "7", "9"});
      case 7: {  // cut off
        out_.what = "truncation";
        out_.text = text_.substr(0, line.begin + random_.index(line.end - line.begin));
        for (const Line& other : lines_)
          if (other.end > line.begin && other.owner > 0) out_.touched.insert(other.owner);
        return true;
      }
      case 8: {  // two lines change places
        const std::size_t i = static_cast<std::size_t>(&line - lines_.data());
        if (i + 1 >= lines_.size() || lines_[i + 1].section != line.section) return false;
        const Line& next = lines_[i + 1];
        const Span mine = data(line), others = data(next);
        out_.what = "lines swapped";
        out_.text = text_;
        std::swap_ranges(out_.text.begin() + static_cast<std::ptrdiff_t>(mine.begin),
                         out_.text.begin() + static_cast<std::ptrdiff_t>(mine.end),
                         out_.text.begin() + static_cast<std::ptrdiff_t>(others.begin));
        if (out_.text == text_) return false;
        out_.touched = {line.owner, next.owner};
        return true;
      }
      default:  // another type of entity
        if (line.section != 'P') return false;
        return change(line, "another type", std::regex("^ *([0-9]{3}),"),
                      {"100", "110", "124", "999", "144"});
    }
  }

  const std::string& text_;
  std::vector<Line> lines_;
  Random random_;
  Damage out_;
};

/// Directory entries that an IGES entity's parameters name. Of types that make no faces all odd
/// integers, some of which mean something else: too much is said to be below these.
std::set<int> pointers_in(const std::string& parameters) {
  std::vector<int> p;
  std::stringstream text(parameters.substr(0, parameters.find(';')));
  for (std::string word; std::getline(text, word, ',');) p.push_back(std::atoi(word.c_str()));
  std::set<int> out;
  const auto at = [&](std::size_t i) { return i < p.size() ? p[i] : 0; };
  const auto take = [&](std::initializer_list<std::size_t> places) {
    for (const std::size_t i : places)
      if (at(i) != 0) out.insert(std::abs(at(i)));
  };
  const auto take_each = [&](std::size_t first, std::size_t step, int count) {
    for (int i = 0; i < count; ++i) take({first + step * static_cast<std::size_t>(i)});
  };
  switch (at(0)) {
    case 100:  // curves, points, splines
    case 104:
    case 106:
    case 110:
    case 112:
    case 116:
    case 123:
    case 124:
    case 126:
    case 128:
    case 502:
      break;
    case 102:  // a curve of several
      take_each(2, 1, at(1));
      break;
    case 108:  // surfaces
    case 140:
      take({5});
      break;
    case 118:
    case 120:
      take({1, 2});
      break;
    case 122:
      take({1});
      break;
    case 142:  // a curve on a surface, a trimmed surface
      take({2, 3, 4});
      break;
    case 144:
      take({1, 4});
      take_each(5, 1, at(3));
      break;
    case 190:
      take({1, 2, 3});
      break;
    case 192:
    case 194:
    case 198:
      take({1, 2, 4, 5});
      break;
    case 196:
      take({1, 3, 4});
      break;
    case 504:  // lists of edges, loops, faces
      for (const std::size_t step : {0U, 1U, 3U}) take_each(2 + step, 5, at(1));
      break;
    case 508: {
      std::size_t k = 2;
      for (int i = 0; i < at(1) && k < p.size(); ++i) {
        const int curves = std::max(0, at(k + 4));
        take({k + 1});
        take_each(k + 6, 2, curves);
        k += 5 + 2 * static_cast<std::size_t>(curves);
      }
      break;
    }
    case 510:
      take({1});
      take_each(4, 1, at(2));
      break;
    default:
      for (const int number : p)
        if (number % 2 == 1) out.insert(number);
  }
  return out;
}

/// Entities that each record refers to.
std::map<int, std::set<int>> references_of(const std::string& text, bool iges) {
  std::map<int, std::set<int>> out;
  if (!iges) {
    for (const Record& record : records_of(text))
      for (const Span at : all_of(text, {text.find('=', record.begin), record.end}, references()))
        out[record.number].insert(std::atoi(text.c_str() + at.begin + 1));
    return out;
  }
  std::map<int, std::string> parameters;
  for (const Line& line : lines_of(text))
    if (line.section == 'P')
      parameters[line.owner] += text.substr(line.begin, kParameters);
    else if (line.section == 'D' && line.number % 2 == 1)  // its transformation
      if (const int matrix = std::atoi(text.substr(line.begin + 48, 8).c_str()); matrix > 0)
        out[line.owner].insert(matrix);
  for (const auto& [owner, words] : parameters) out[owner].merge(pointers_in(words));
  return out;
}

}  // namespace

Damage damaged(const std::string& text, bool iges, std::uint64_t seed) {
  return iges ? IgesDamage(text, seed).make() : StepDamage(text, seed).make();
}

std::set<int> all_below(const std::string& text, bool iges, int entity) {
  static std::map<std::string, std::map<int, std::set<int>>> known;
  auto at = known.find(text);
  if (at == known.end()) at = known.emplace(text, references_of(text, iges)).first;
  std::set<int> out{entity};
  std::vector<int> stack{entity};
  while (!stack.empty()) {
    const int next = stack.back();
    stack.pop_back();
    for (const int other : at->second[next])
      if (out.insert(other).second) stack.push_back(other);
  }
  return out;
}

}  // namespace kaboum::test
