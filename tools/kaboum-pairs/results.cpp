// What kaboum-pairs prints, reports and writes.

#include "results.h"

#include <kaboum/pairs/srdf.h>
#include <kaboum/picture/png_file.h>
#include <kaboum/picture/render.h>
#include <kaboum/robot/kinematics.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace kaboum::tools {
namespace {

using pairs::DecidedPair;
using pairs::Relation;
using pairs::Verdict;

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

Json bracket_json(const pairs::Bracket& bracket) {
  Json out = {{"at_least", bracket.lower}};
  out["at_most"] = std::isfinite(bracket.upper) ? Json(bracket.upper) : Json(nullptr);
  return out;
}

Json configuration_json(const robot::Robot& robot, const std::vector<double>& q) {
  Json out = Json::object();
  for (std::size_t v = 0; v < q.size(); ++v) out[robot.variables[v].name] = q[v];
  return out;
}

bool touches(Verdict verdict) { return verdict == Verdict::Always || verdict == Verdict::CanTouch; }

std::string word_of(Verdict verdict, Span span) {
  if (span == Span::Limits || verdict == Verdict::Open) return pairs::name_of(verdict);
  return verdict == Verdict::Never ? "apart" : "in contact";
}

}  // namespace

bool is_contact(const DecidedPair& pair) {
  return touches(pair.verdict) && !pairs::is_connected(pair);
}

bool is_unknown(const DecidedPair& pair) {
  return pair.verdict == Verdict::Open && !pairs::is_connected(pair);
}

std::string words_of(const pairs::Bracket& bracket) {
  return std::isfinite(bracket.upper) ? number(bracket.lower) + " to " + number(bracket.upper)
                                      : "at least " + number(bracket.lower);
}

Json pairs_json(const robot::Robot& robot, const std::vector<DecidedPair>& pairs) {
  Json out = Json::array();
  for (const DecidedPair& pair : pairs) {
    Json j = {{"links", {robot.links[pair.a].name, robot.links[pair.b].name}},
              {"relation", pairs::name_of(pair.relation)},
              {"verdict", pairs::name_of(pair.verdict)},
              {"distance", bracket_json(pair.nearest)}};
    if (pair.depth.lower > 0) j["depth"] = bracket_json(pair.depth);
    if (!pair.q.empty()) j["configuration"] = configuration_json(robot, pair.q);
    if (!pair.why.empty()) j["why"] = pair.why;
    if (pair.unfinished) j["unfinished"] = true;
    j["boxes"] = pair.boxes;
    if (pair.away) {
      j["away_from_joint"] = {{"beyond", pair.away->beyond},
                              {"verdict", pairs::name_of(pair.away->verdict)},
                              {"distance", bracket_json(pair.away->nearest)}};
      if (!pair.away->q.empty())
        j["away_from_joint"]["configuration"] = configuration_json(robot, pair.away->q);
    }
    out.push_back(std::move(j));
  }
  return out;
}

std::string line_of(const robot::Robot& robot, const DecidedPair& pair, Span span) {
  std::string out = robot.links[pair.a].name + " " + robot.links[pair.b].name + ": ";
  if (pair.relation != Relation::Moving) {
    out += pairs::name_of(pair.relation);
    out += "; ";
  }
  // What is at the joint is open often: links that touch there exactly.
  const bool away_only = pair.away && pair.away->beyond > 0;
  const bool open_at_joint =
      pair.verdict == Verdict::Open && away_only && pair.away->verdict == Verdict::Never;
  out += word_of(pair.verdict, span);
  if (open_at_joint) out += " at the joint";
  if (pair.depth.lower > 0) {
    out += ", " + words_of(pair.depth) + " deep";
    if (!pair.q.empty() && span == Span::Limits) out += " at " + pairs::text_of(pair.q);
  } else if (pair.verdict != Verdict::Always) {
    out += (span == Span::Limits ? ", smallest distance " : ", distance ") + words_of(pair.nearest);
  }
  if (away_only) {
    out += "; farther than " + number(pair.away->beyond) + " from the joint: ";
    out += word_of(pair.away->verdict, span);
  }
  if (!pair.why.empty()) out += "; " + pair.why;
  if (pair.unfinished) out += "; a longer --timeout or more --max-boxes may decide it";
  return out;
}

std::string summary_of(const std::vector<DecidedPair>& pairs, Span span, double seconds) {
  const auto count = [&](const auto& is) {
    return std::to_string(std::ranges::count_if(pairs, is));
  };
  const auto has = [&](Verdict verdict) {
    return count([verdict](const DecidedPair& pair) { return pair.verdict == verdict; });
  };
  const std::string begin = std::to_string(pairs.size()) + " pairs: " + has(Verdict::Never),
                    end = " (" + number(seconds) + " s)";
  if (span == Span::Limits)
    return begin + " never touch, " + has(Verdict::Always) + " always do, " +
           has(Verdict::CanTouch) + " can, " + has(Verdict::Open) + " open" + end;
  return begin + " apart, " + count([](const DecidedPair& pair) {
           return pair.verdict != Verdict::Never && pairs::is_connected(pair);
         }) +
         " touch at a joint at most, " + count(is_contact) + " in contact, " + count(is_unknown) +
         " open" + end;
}

std::vector<char> picture_of(const robot::Robot& robot,
                             const std::vector<pairs::LinkSurface>& surfaces,
                             const std::vector<double>& q, const std::vector<DecidedPair>& pairs) {
  constexpr int kPanel = 1000;
  constexpr picture::Colour kLink{0.66F, 0.68F, 0.71F}, kTouching{0.95F, 0.62F, 0.22F};
  const std::vector<geom::Transform> poses = robot::forward(robot, q);
  picture::Image image(kPanel, kPanel, picture::Colour{1, 1, 1});
  geom::Mesh all;
  picture::Style style;
  for (const pairs::LinkSurface& surface : surfaces) {
    const bool touching = std::ranges::any_of(pairs, [&](const DecidedPair& pair) {
      return is_contact(pair) && (pair.a == surface.link || pair.b == surface.link);
    });
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    for (const geom::Vec3& p : surface.outer.vertices)
      all.vertices.emplace_back(poses[surface.link] * p);
    for (const geom::Triangle& t : surface.outer.triangles)
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    style.of_triangle.resize(all.triangles.size(), touching ? kTouching : kLink);
  }
  if (!all.triangles.empty()) {
    const picture::Camera camera(geom::bounding_box(all), {}, kPanel, kPanel);
    picture::draw_mesh(image, 0, 0, kPanel, kPanel, all, camera, style);
  }
  return picture::encode_png(image);
}

std::string to_srdf(const robot::Robot& robot, const std::vector<DecidedPair>& decided) {
  std::vector<pairs::UncheckedPair> disabled;
  for (const DecidedPair& pair : decided) {
    const bool never = pair.verdict == Verdict::Never;
    if (!never && !pairs::is_connected(pair)) continue;
    disabled.push_back(
        {pair.a, pair.b, pair.adjacent ? "Adjacent" : (never ? "Never" : "Default")});
  }
  return pairs::srdf_text(robot, disabled);
}

std::string left_out_of_srdf(const robot::Robot& robot, const std::vector<DecidedPair>& decided) {
  std::string names;
  std::size_t count = 0;
  for (const DecidedPair& pair : decided) {
    if (!pair.adjacent || pair.verdict == Verdict::Never || pairs::is_connected(pair)) continue;
    names += (count++ == 0 ? "" : "; ") + robot.links[pair.a].name + " " + robot.links[pair.b].name;
  }
  if (count == 0) return {};
  return std::to_string(count) +
         " pairs of adjacent links are not disabled, as they touch away from their joint, or it is "
         "not proved that they do not: " +
         names;
}

}  // namespace kaboum::tools
