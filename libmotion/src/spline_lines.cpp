// Polynomials between waypoints, by straight lines with room about them.

#include <kaboum/base/error.h>
#include <kaboum/motion/spline_lines.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace kaboum::motion {
namespace {

constexpr double kMostLines = 5e6;
/// More than the spacing of rounded shares is above an even one.
constexpr double kUneven = 1 + 0x1p-25;
/// Of all sizes that a polynomial is made of: more than roundings of its points and of the bound
/// below (docs/algorithms/motion-planning.md#polynomials-between-waypoints).
constexpr double kRounding = 0x1p-44;

/// A polynomial of a variable between two waypoints, by its Bézier ordinates.
struct Bezier {
  std::array<double, 6> ordinates{};
  std::size_t degree = 0;
  double size = 0;  ///< of the numbers that it is made of

  /// A mean of the ordinates, each step between two of them.
  [[nodiscard]] double at(double u) const {
    std::array<double, 6> b = ordinates;
    for (std::size_t n = degree; n > 0; --n)
      for (std::size_t k = 0; k < n; ++k) b[k] += u * (b[k + 1] - b[k]);
    return b[0];
  }
  /// Bound of the second derivative: its ordinates are n (n − 1) times second differences.
  [[nodiscard]] double most_second() const {
    double out = 0;
    for (std::size_t k = 0; k + 2 <= degree; ++k)
      out = std::max(
          out, std::abs((ordinates[k + 2] - ordinates[k + 1]) - (ordinates[k + 1] - ordinates[k])));
    return static_cast<double>(degree * (degree - 1)) * out;
  }
};

Bezier bezier_of(const SplineWaypoints& spline, std::size_t segment, std::size_t variable) {
  const auto of = [&](const robot::Path& rows, std::size_t i) { return rows[i][variable]; };
  const std::size_t i = segment, k = segment + 1;
  const double h = spline.times[k] - spline.times[i], p0 = of(spline.positions, i),
               p1 = of(spline.positions, k), v0 = h * of(spline.velocities, i),
               v1 = h * of(spline.velocities, k);
  Bezier out;
  out.size = std::max(std::abs(p0), std::abs(p1)) + std::max(std::abs(v0), std::abs(v1));
  if (spline.accelerations.empty()) {
    out.degree = 3;
    out.ordinates = {p0, p0 + v0 / 3, p1 - v1 / 3, p1};
    return out;
  }
  const double a0 = h * h * of(spline.accelerations, i), a1 = h * h * of(spline.accelerations, k);
  out.size += std::max(std::abs(a0), std::abs(a1));
  out.degree = 5;
  out.ordinates = {p0,          p0 + v0 / 5, p0 + (0.4 * v0 + a0 / 20), p1 + (a1 / 20 - 0.4 * v1),
                   p1 - v1 / 5, p1};
  return out;
}

std::string between(std::size_t segment) {
  return "between waypoints " + std::to_string(segment + 1) + " and " + std::to_string(segment + 2);
}

void require_valid(const SplineWaypoints& spline) {
  const std::size_t count = spline.positions.size();
  const auto fits = [&](const robot::Path& rows) {
    return rows.size() == count && std::ranges::all_of(rows, [&](const std::vector<double>& row) {
             return row.size() == spline.positions.front().size() &&
                    std::ranges::all_of(row, [](double x) { return std::isfinite(x); });
           });
  };
  if (count == 0 || spline.times.size() != count || !fits(spline.positions) ||
      !fits(spline.velocities) || !(spline.accelerations.empty() || fits(spline.accelerations)))
    throw Error(ErrorCode::InvalidArgument,
                "polynomials need a time and finite derivatives of each variable at each waypoint");
  for (std::size_t i = 0; i + 1 < count; ++i) {
    if (!(spline.times[i + 1] > spline.times[i]))
      throw Error(ErrorCode::InvalidInput,
                  between(i) + " no time passes: no polynomial leads from one to the other");
    for (std::size_t j = 0; j < spline.positions.front().size(); ++j)
      if (const Bezier b = bezier_of(spline, i, j); !(b.size < 1e100))
        throw Error(ErrorCode::InvalidInput, between(i) + " a polynomial has numbers too large");
  }
}

}  // namespace

std::pair<std::size_t, double> SplineLines::place(std::size_t line, double share) const {
  const auto next = std::ranges::upper_bound(waypoints, line);
  const auto before = static_cast<std::size_t>(next - waypoints.begin()) - 1;
  if (next == waypoints.end()) return {before, share};
  const auto parts = static_cast<double>(*next - waypoints[before]);
  return {before, (static_cast<double>(line - waypoints[before]) + share) / parts};
}

std::vector<std::size_t> spline_parts(const SplineWaypoints& spline, double within) {
  if (!(within > 0)) throw Error(ErrorCode::InvalidArgument, "lines within a width above 0");
  require_valid(spline);
  std::vector<std::size_t> out;
  double all = 0;
  for (std::size_t i = 0; i + 1 < spline.positions.size(); ++i) {
    double most = 0;
    for (std::size_t j = 0; j < spline.positions.front().size(); ++j)
      most = std::max(most, bezier_of(spline, i, j).most_second());
    const double parts = std::max(1.0, std::ceil(std::sqrt(most / (8 * within))));
    all += parts;
    if (!(all <= kMostLines))
      throw Error(ErrorCode::LimitReached,
                  between(i) +
                      " the polynomials are bent so much that more than 5000000 straight "
                      "lines are needed: give a larger «resolution»");
    out.push_back(static_cast<std::size_t>(parts));
  }
  return out;
}

SplineLines spline_lines(const SplineWaypoints& spline, std::span<const std::size_t> parts) {
  require_valid(spline);
  const std::size_t count = spline.positions.size(), variables = spline.positions.front().size();
  if (parts.size() + 1 != count || std::ranges::find(parts, 0U) != parts.end())
    throw Error(ErrorCode::InvalidArgument, "one line or more between each waypoint and the next");
  SplineLines out{{}, std::vector<double>(variables, 0), {}};
  std::vector<Bezier> curves(variables);
  for (std::size_t i = 0; i + 1 < count; ++i) {
    out.waypoints.push_back(out.points.size());
    const auto m = static_cast<double>(parts[i]);
    for (std::size_t j = 0; j < variables; ++j) {
      curves[j] = bezier_of(spline, i, j);
      const double chord = curves[j].most_second() / (8 * m * m);
      out.around[j] = std::max(out.around[j], kUneven * chord + kRounding * curves[j].size);
    }
    out.points.push_back(spline.positions[i]);
    for (std::size_t k = 1; k < parts[i]; ++k) {
      std::vector<double>& q = out.points.emplace_back();
      for (const Bezier& curve : curves) q.push_back(curve.at(static_cast<double>(k) / m));
    }
  }
  out.waypoints.push_back(out.points.size());
  out.points.push_back(spline.positions.back());
  return out;
}

}  // namespace kaboum::motion
