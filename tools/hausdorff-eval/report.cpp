// What hausdorff-eval tells of the distances: lines and a report.

#include "report.h"

#include <kaboum/geom/topology.h>

#include <cstdio>
#include <sstream>

namespace kaboum::tools {

using distance::Comparison;
using distance::OneWay;
using geom::Vec3;

namespace {

Json to_json(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

std::string formatted(double x, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, x);
  return text;
}

double ComparisonReport::relative(double x) const {
  return comparison.diagonal() > 0 ? x / comparison.diagonal() : 0;
}

std::string ComparisonReport::table() const {
  std::ostringstream out;
  const auto row = [&](const char* name, const std::string& ab, const std::string& ba) {
    char line[200];
    std::snprintf(line, sizeof line, "%-6s %-34s %-34s\n", name, ab.c_str(), ba.c_str());
    std::string text = line;
    while (text.size() > 1 && text[text.size() - 2] == ' ') text.erase(text.size() - 2, 1);
    out << text;
  };
  const auto percent = [&](double x) { return formatted(100 * relative(x), 4) + "%"; };
  const auto interval = [&](double lower, double upper) {
    return "[" + formatted(lower) + ", " + formatted(upper) + "]";
  };
  const auto estimate = [](const distance::Estimate& e) {
    return formatted(e.value) + " ± " + formatted(e.standard_error, 2);
  };
  const OneWay &to_b = result.a_to_b, &to_a = result.b_to_a;
  const bool set = files[0].is_set || files[1].is_set;
  out << (solid ? "solid to solid (mean and rms: over the boundaries)"
          : set ? "surface to surface (sets: boundary of the union)"
                : "surface to surface")
      << "; percentages of the diagonal of both boxes, " << formatted(comparison.diagonal())
      << '\n';
  row("", "A to B", "B to A");
  const std::string least = interval(result.min.lower, result.min.upper);
  row("min", least, least);
  row("mean", estimate(to_b.sampled.mean), estimate(to_a.sampled.mean));
  row("", percent(to_b.sampled.mean.value), percent(to_a.sampled.mean.value));
  row("rms", estimate(to_b.sampled.rms), estimate(to_a.sampled.rms));
  row("", percent(to_b.sampled.rms.value), percent(to_a.sampled.rms.value));
  row("max", interval(to_b.max.max_lower, to_b.max.max_upper),
      interval(to_a.max.max_lower, to_a.max.max_upper));
  row("", percent(to_b.max.max_upper), percent(to_a.max.max_upper));
  out << "Hausdorff distance " << interval(result.lower(), result.upper()) << ", "
      << percent(result.upper()) << " of that diagonal\n";
  return out.str();
}

Json ComparisonReport::side(Comparison::Side s) const {
  const ShapeFile& file = files[s];
  Json j{{"file", file.shape.name},
         {"sha256", file.sha256},
         {"unit", file.unit},
         {"kind", file.is_set ? (solid ? "convex set: union" : "convex set: boundary of the union")
                              : (solid ? "mesh: its solid" : "mesh")}};
  if (file.is_set) j["bodies"] = file.bodies;
  if (file.is_set && solid) j["margin"] = file.margin;
  const geom::TopologyReport topology = geom::analyse(comparison.surface(s));
  j["vertices"] = topology.vertices;
  j["triangles"] = topology.triangles;
  j["components"] = topology.components;
  if (!file.is_set && !solid) j["closed"] = topology.closed();
  j["degenerate_triangles"] = topology.degenerate_triangles;
  j["surface_error"] = comparison.surface_error(s);
  if (file.deviation > 0) j["deviation"] = file.deviation;
  j["notes"] = file.notes;
  return j;
}

Json ComparisonReport::way(const OneWay& way) const {
  return {{"min", result.min.upper},
          {"min_lower", result.min.lower},
          {"min_upper", result.min.upper},
          {"mean", way.sampled.mean.value},
          {"mean_standard_error", way.sampled.mean.standard_error},
          {"rms", way.sampled.rms.value},
          {"rms_standard_error", way.sampled.rms.standard_error},
          {"mean_and_rms_rounding", way.sampled.rounding},
          {"max_lower", way.max.max_lower},
          {"max_upper", way.max.max_upper},
          {"max_at", to_json(way.max.at)},
          {"max_nearest", to_json(way.nearest)},
          {"max_within_gap", way.max.within_gap},
          {"max_inside", way.max.inside},
          {"relative",
           {{"min", relative(result.min.upper)},
            {"mean", relative(way.sampled.mean.value)},
            {"rms", relative(way.sampled.rms.value)},
            {"max_lower", relative(way.max.max_lower)},
            {"max_upper", relative(way.max.max_upper)}}},
          {"samples", way.sampled.samples},
          {"queries", way.max.queries},
          {"cells", way.max.cells}};
}

Json ComparisonReport::json() const {
  Json r;
  r["a"] = side(Comparison::A);
  r["b"] = side(Comparison::B);
  r["measure"] = solid ? "solid to solid" : "surface to surface";
  r["options"] = Json::object();
  r["bbox_diagonal"] = comparison.diagonal();
  r["a_to_b"] = way(result.a_to_b);
  r["b_to_a"] = way(result.b_to_a);
  r["hausdorff_lower"] = result.lower();
  r["hausdorff_upper"] = result.upper();
  r["hausdorff_relative"] = {{"lower", relative(result.lower())},
                             {"upper", relative(result.upper())}};
  r["min_at"] = {{"a", to_json(result.min.on_a)}, {"b", to_json(result.min.on_b)}};
  return r;
}

std::string ComparisonReport::csv() const {
  std::string out =
      "direction,min_lower,min_upper,mean,mean_standard_error,rms,rms_standard_error,max_lower,"
      "max_upper,bbox_diagonal\n";
  for (const OneWay* way : {&result.a_to_b, &result.b_to_a}) {
    out += way == &result.a_to_b ? "a_to_b" : "b_to_a";
    for (const double x :
         {result.min.lower, result.min.upper, way->sampled.mean.value,
          way->sampled.mean.standard_error, way->sampled.rms.value, way->sampled.rms.standard_error,
          way->max.max_lower, way->max.max_upper, comparison.diagonal()})
      out += "," + formatted(x, 17);
    out += "\n";
  }
  return out;
}

}  // namespace kaboum::tools
