// A table of links that fits a terminal page.

#include "summary.h"

#include <kaboum/base/number_text.h>
#include <kaboum/base/parse_length.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace kaboum::tools {
namespace {

using certify::Outcome;

constexpr std::size_t kColumns = 6;
constexpr std::size_t kLongestName = 28;

using Cells = std::array<std::string, kColumns>;

std::string word_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::Held:
      return "inside";
    case Outcome::Late:
      return "inside, late";
    case Outcome::Far:
      return "inside, far";
    case Outcome::Undecided:
      return "NOT decided";
    case Outcome::Outside:
      return "NOT inside";
    case Outcome::Kept:
      return "NOT held";
    case Outcome::Missing:
      break;
  }
  return "NOT verified";
}

/// Characters that begin here: others of UTF-8 go on.
bool begins(char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, begins));
}

std::string shortened(const std::string& name) {
  if (width(name) <= kLongestName) return name;
  std::string out;
  std::size_t left = kLongestName;
  for (const char c : name) {
    if (begins(c) && --left == 0) break;
    out += c;
  }
  return out + "…";
}

/// Three digits, not below the length.
std::string length_up(double length) {
  if (!(length > 0) || !std::isfinite(length)) return number_up(length);
  const double step = std::pow(10, std::floor(std::log10(length)) - 2);
  return number_text(std::ceil(length / step * (1 - 1e-12)) * step);
}

std::string padded(const std::string& text, std::size_t to, bool right) {
  const std::string blanks(to - std::min(to, width(text)), ' ');
  return right ? blanks + text : text + blanks;
}

/// Places of the links that have a line, in order.
std::vector<std::size_t> shown(const std::vector<LinkLine>& links) {
  std::vector<std::size_t> order(links.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (links.size() <= kLinesOfLinks) return order;
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    if (links[a].outcome != links[b].outcome) return links[a].outcome > links[b].outcome;
    if ((links[a].dropped_sheets > 0) != (links[b].dropped_sheets > 0))
      return links[a].dropped_sheets > 0;
    return links[a].bodies > links[b].bodies;
  });
  order.resize(kLinesOfLinks - 1);
  std::ranges::sort(order);
  return order;
}

}  // namespace

std::vector<std::string> table_of(const std::vector<LinkLine>& links, const std::string& made,
                                  const std::string& unit) {
  const bool metres = unit == "m";
  // A length of a few roundings is no news.
  const auto length = [&](double x) {
    return length_up(metres ? std::max(1000 * x, x > 0 ? 1e-3 : 0.0) : x);
  };
  const auto epsilon = [&](const std::string& text) {
    const auto known = metres ? parse_length(text) : std::nullopt;
    return known && !known->percent ? number_text(1000 * known->value) + " mm" : text;
  };
  const auto cells = [&](const LinkLine& l) {
    const bool has = l.bodies > 0;
    return Cells{l.name,
                 has ? std::to_string(l.bodies) : std::string("-"),
                 l.vertices ? std::to_string(*l.vertices) : std::string("-"),
                 l.epsilon.empty() ? std::string("-") : epsilon(l.epsilon),
                 has ? length(l.within) : std::string("-"),
                 word_of(l.outcome) +
                     (l.dropped_sheets > 0 && l.outcome < Outcome::Undecided ? " but sheets" : "")};
  };
  std::vector<Cells> rows{
      {"link", made, "vertices", "epsilon",
       "within" + (unit.empty() ? std::string() : " [" + std::string(metres ? "mm" : unit) + "]"),
       "triangles"}};
  const std::vector<std::size_t> places = shown(links);
  for (const std::size_t at : places) {
    rows.push_back(cells(links[at]));
    rows.back()[0] = shortened(links[at].name);
  }
  if (places.size() < links.size()) {
    LinkLine rest;
    for (std::size_t i = 0; i < links.size(); ++i) {
      if (std::ranges::binary_search(places, i)) continue;
      rest.bodies += links[i].bodies;
      if (links[i].vertices) rest.vertices = rest.vertices.value_or(0) + *links[i].vertices;
      rest.within = std::max(rest.within, links[i].within);
      rest.outcome = std::max(rest.outcome, links[i].outcome);
      rest.dropped_sheets += links[i].dropped_sheets;
    }
    rest.name = std::to_string(links.size() - places.size()) + " others";
    rows.push_back(cells(rest));
    if (rest.outcome != Outcome::Held) rows.back().back() += " or better";
  }
  std::array<std::size_t, kColumns> widths{};
  for (const Cells& row : rows)
    for (std::size_t c = 0; c < kColumns; ++c)
      widths.at(c) = std::max(widths.at(c), width(row.at(c)));
  std::vector<std::string> out;
  for (const Cells& row : rows) {
    std::string line;
    for (std::size_t c = 0; c + 1 < kColumns; ++c) {
      if (widths.at(c) == 0) continue;
      line.append(padded(row.at(c), widths.at(c), c > 0)).append("  ");
    }
    out.push_back(line + row.back());
  }
  return out;
}

}  // namespace kaboum::tools
