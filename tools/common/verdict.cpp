// Words that verdicts have in common: rounded numbers, points, claims.

#include "verdict.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "cli.h"

namespace kaboum::tools {

using verify::Answer;

std::string in_words(const verify::Bracket& bracket) {
  std::string text;
  if (bracket.lower > 0) text = "at least " + number_down(bracket.lower);
  if (std::isfinite(bracket.upper))
    text += std::string(text.empty() ? "" : " and ") + "at most " + number_up(bracket.upper);
  return text;
}

std::string point(const geom::Vec3& p) {
  std::ostringstream text;
  text << std::setprecision(17) << '(' << p.x() << ", " << p.y() << ", " << p.z() << ')';
  return text.str();
}

std::string text_of_radii(const geom::ConvexSet& set) {
  const nlohmann::ordered_json margin = margin_json(set);
  if (margin.is_array())
    return "with their radii, " + number(margin[0].get<double>()) + " to " +
           number(margin[1].get<double>()) + ", included";
  return margin.get<double>() > 0 ? "with the margin " + number(margin.get<double>()) + " included"
                                  : "";
}

nlohmann::ordered_json margin_json(const geom::ConvexSet& set) {
  if (const auto margin = geom::margin_of(set)) return *margin;
  const auto [least, largest] = std::ranges::minmax_element(
      set.bodies, {}, [](const geom::ConvexBody& body) { return body.radius; });
  return nlohmann::ordered_json::array({least->radius, largest->radius});
}

std::string except_sheets(const DroppedSheets& dropped) {
  std::string text;
  for (const auto& [file, count] : dropped) {
    if (count == 0) continue;
    text += text.empty() ? "; nothing is said of the " : ", the ";
    text += std::to_string(count) + " triangles of sheets dropped from " + file;
  }
  return text;
}

int exit_code(Answer answer) {
  switch (answer) {
    case Answer::Verified:
      return kDone;
    case Answer::Refuted:
      return kNo;
    case Answer::Undecided:
      return kLimit;
    case Answer::Undefined:
      break;
  }
  return kBadInput;
}

}  // namespace kaboum::tools
