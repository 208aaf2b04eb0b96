// Masses of a robot's links: what is asked for, and what is said of it.

#include "inertia.h"

#include <kaboum/base/error.h>
#include <kaboum/base/number_text.h>
#include <kaboum/base/parse_numbers.h>
#include <kaboum/robot/inertial_edit.h>

#include <algorithm>
#include <cmath>

namespace kaboum::tools {

using certify::LinkInertia;

std::optional<double> density_of(const std::string& option) {
  if (option == "mass") return std::nullopt;
  char* end = nullptr;
  const double value = std::strtod(option.c_str(), &end);
  if (option.empty() || *end != '\0' || !(value > 0) || !std::isfinite(value))
    throw Error(
        ErrorCode::InvalidArgument,
        "--inertia: '" + option + "' is neither the word mass nor a density above 0 (kg/m^3)");
  return value;
}

std::vector<LinkInertia> find_inertia(const robot::RobotFile& robot,
                                      const certify::InertiaRequest& request) {
  std::vector<LinkInertia> out = certify::inertia_of_links(robot, request);
  const auto inertials = inertials_of(robot.robot, out);
  const std::vector<std::string> missing =
      robot::with_inertials(robot.text, robot.path.string(), inertials).missing;
  for (LinkInertia& link : out) {
    if (std::ranges::find(missing, robot.robot.links[link.link].name) == missing.end()) continue;
    link.found.reset();
    link.flaw = "the file has no element of its own for it, where its mass would be";
  }
  return out;
}

bool all_known(const std::vector<LinkInertia>& links) {
  return std::ranges::all_of(links, [](const LinkInertia& l) { return l.flaw.empty(); });
}

namespace {

std::string bounds_in_words(const geom::Bounds& mass) {
  const double middle = (mass.lower + mass.upper) / 2;
  return "between " + number_text(mass.lower) + " and " + number_text(mass.upper) + " kg (" +
         number_up(std::max(0.0, (mass.upper - middle) / middle * 100)) +
         " % round the middle); the report has the bounds of all";
}

}  // namespace

std::vector<std::string> in_words(const robot::Robot& robot,
                                  const std::vector<LinkInertia>& links) {
  std::size_t known = 0;
  double lower = 0, upper = 0;
  std::vector<std::string> kept;
  for (const LinkInertia& link : links) {
    const std::string name = "link '" + robot.links[link.link].name + "'";
    if (link.found) {
      ++known;
      lower += link.found->bounds.mass.lower;
      upper += link.found->bounds.mass.upper;
      if (link.overlaps)
        kept.push_back(name + ": surfaces of it cross, or its shapes may have points in common: " +
                       bounds_in_words(link.found->bounds.mass));
      if (link.hollow)
        kept.push_back(name +
                       ": a place that its surface encloses counts as outside, without mass");
    } else if (link.without_mass) {
      kept.push_back(name + " has no mass that could be kept; its file's <inertial> stays");
    } else {
      kept.push_back(name + ": NO inertia: " + link.flaw + "; its file's <inertial> stays");
    }
  }
  const double middle = (lower + upper) / 2;
  std::vector<std::string> out;
  out.push_back(
      "inertia of " + std::to_string(known) + (known == 1 ? " link" : " links") +
      " by exact integrals over their shapes" +
      (known == 0 ? ""
                  : ": " + number_text(middle) + " kg, " +
                        (lower == upper
                             ? "exactly"
                             : "proved within " +
                                   number_up(std::nextafter(upper - middle, HUGE_VAL)) + " kg")));
  out.insert(out.end(), kept.begin(), kept.end());
  return out;
}

namespace {

Json json_of(const geom::Bounds& b) { return Json::array({b.lower, b.upper}); }

template <class Numbers>
Json list_of(const Numbers& numbers) {
  Json out = Json::array();
  for (const geom::Bounds& b : numbers) out.push_back(json_of(b));
  return out;
}

}  // namespace

Json report_of(const robot::Robot& robot, const std::vector<LinkInertia>& links) {
  Json out = Json::array();
  for (const LinkInertia& link : links) {
    Json one = {{"link", robot.links[link.link].name}};
    if (link.found) {
      const geom::MassOf<geom::Bounds>& b = link.found->bounds;
      const geom::MassOf<double>& v = link.found->value;
      one["mass"] = v.mass;
      one["mass_bounds"] = json_of(b.mass);
      one["centre"] = v.centre;
      one["centre_bounds"] = list_of(b.centre);
      one["inertia"] = v.inertia;
      one["inertia_bounds"] = list_of(b.inertia);
      one["overlaps"] = link.overlaps;
      one["hollow"] = link.hollow;
    } else {
      one["kept"] = link.without_mass ? std::string("no mass in the file") : link.flaw;
    }
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace kaboum::tools
