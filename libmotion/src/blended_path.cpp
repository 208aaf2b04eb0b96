// Polylines with blended corners.

#include <kaboum/base/error.h>
#include <kaboum/motion/blended_path.h>

#include <algorithm>
#include <cmath>

namespace kaboum::motion {
namespace {

using Values = std::vector<double>;

constexpr double kTurnsBack = -0.99984769515639;  // cos 179°
constexpr double kLeast = 1e-6;                   ///< share of a segment
/// Of a longer segment a blend takes at most so many times what it takes of the shorter one: where
/// these differ much more, the curve is bent sharply next to one end.
constexpr double kLonger = 1.5;
/// Scales of the parameter along a path. Beyond, blends have legs of equal length: numbers of paths
/// with thousands of corners stay in range.
constexpr double kMostScale = 0x1p30;
constexpr double kSame = 1e-14;  // between waypoints that are the same [rad or length]

/// A velocity's limit as a unit of the parameter: limits that nothing reaches are one.
double unit_of(double velocity) {
  constexpr double kFastest = 1e9;
  return std::min(velocity, kFastest);
}

/// 0 where the waypoints are the same.
double parameter_length(const Values& a, const Values& b, const Values& velocity) {
  double out = 0, most = 0;
  for (std::size_t j = 0; j < a.size(); ++j) {
    most = std::max(most, std::abs(b[j] - a[j]));
    out = std::max(out, std::abs(b[j] - a[j]) / unit_of(velocity[j]));
  }
  return most > kSame ? out : 0;
}

/// a + share (b − a), between a and b whatever the roundings.
Values point_between(const Values& a, const Values& b, double share) {
  Values out = a;
  for (std::size_t j = 0; j < a.size(); ++j)
    out[j] = std::clamp(a[j] + share * (b[j] - a[j]), std::min(a[j], b[j]), std::max(a[j], b[j]));
  return out;
}

Values stretched(Values values, double factor) {
  for (double& x : values) x *= factor;
  return values;
}

void widen(PathPiece& piece, const Values& q) {
  for (std::size_t j = 0; j < q.size(); ++j) {
    piece.low[j] = std::min(piece.low[j], q[j]);
    piece.high[j] = std::max(piece.high[j], q[j]);
  }
}

struct Segment {
  std::size_t begin = 0, end = 0;  ///< waypoints
  double length = 0;
  Values direction;
};

/// What the blend of a corner takes of the segments before and behind it.
struct Legs {
  double before = 0, behind = 0;
};

/// @param before, behind  of the segments, what it may take at most
/// @param scale  of the segment before it: length by the length of its parameter
Legs legs_of(double before, double behind, double scale) {
  const Legs wished{std::min(before, kLonger * behind), std::min(behind, kLonger * before)};
  const double next = scale * (wished.behind / wished.before), most = std::max(next, 1 / next);
  if (most <= kMostScale || most <= std::max(scale, 1 / scale)) return wished;
  const double equal = std::min(before, behind);
  return {equal, equal};
}

std::vector<Segment> segments_of(const robot::Path& path, const Values& velocity) {
  std::vector<Segment> out;
  std::size_t begin = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double length = parameter_length(path[begin], path[i], velocity);
    if (length == 0) continue;
    Segment s{begin, i, length, path[i]};
    for (std::size_t j = 0; j < s.direction.size(); ++j)
      s.direction[j] = (path[i][j] - path[begin][j]) / length;
    out.push_back(std::move(s));
    begin = i;
  }
  return out;
}

}  // namespace

CurvePoint PathPiece::at(double s) const {
  CurvePoint point{from, in, Values(in.size(), 0)};
  for (std::size_t j = 0; j < in.size(); ++j) {
    if (is_blend) point.second[j] = (out[j] - in[j]) / length;
    point.q[j] += s * (in[j] + 0.5 * s * point.second[j]);
    point.q[j] = std::clamp(point.q[j], low[j], high[j]);
    point.first[j] += s * point.second[j];
  }
  return point;
}

bool turns_back(const Values& before, const Values& corner, const Values& after,
                const Values& velocity) {
  double product = 0, in = 0, out = 0;
  for (std::size_t j = 0; j < corner.size(); ++j) {
    const double unit = unit_of(velocity[j]);
    const double a = (corner[j] - before[j]) / unit, b = (after[j] - corner[j]) / unit;
    product += a * b;
    in += a * a;
    out += b * b;
  }
  return product <= kTurnsBack * std::sqrt(in) * std::sqrt(out);
}

BlendedPath::BlendedPath(const robot::Path& path, const Values& shares, const Values& velocity)
    : stops_{0}, at_{0} {
  if (shares.size() != path.size() || !std::all_of(shares.begin(), shares.end(), [](double x) {
        return x >= 0 && x <= kMostBlend;
      }))
    throw Error(ErrorCode::InvalidArgument, "a blend takes a share from 0 to 0.95 of a segment");
  const std::vector<Segment> segments = segments_of(path, velocity);
  std::vector<bool> stops_behind(segments.size(), true);
  for (std::size_t i = 0; i + 1 < segments.size(); ++i)
    stops_behind[i] = shares[segments[i].end] < kLeast ||
                      turns_back(path[segments[i].begin], path[segments[i].end],
                                 path[segments[i + 1].end], velocity);
  // Two blends of one segment share it.
  const auto most_of = [&](std::size_t i, double share) {
    const bool alone = i == 0 || stops_behind[i - 1] || stops_behind[i];
    return segments[i].length * (alone ? share : std::min(share, 0.5));
  };
  double taken = 0;  // of the segment, by the blend at its beginning
  double scale = 1;  // length of a segment by the length of its parameter
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& here = segments[i];
    const Values &a = path[here.begin], &b = path[here.end];
    const bool last = i + 1 == segments.size(), stops = stops_behind[i];
    const double share = shares[here.end];
    const Legs legs = stops ? Legs{} : legs_of(most_of(i, share), most_of(i + 1, share), scale);
    const double straight = here.length - taken - legs.before;
    const Values direction = stretched(here.direction, scale);
    PathPiece line{here.begin,
                   false,
                   straight / scale,
                   point_between(a, b, taken / here.length),
                   direction,
                   direction,
                   a,
                   a};
    widen(line, b);
    // What is shorter than roundings of its ends is none.
    if (straight > 1e-14 * here.length) pieces_.push_back(line);
    taken = legs.behind;
    if (!stops) {
      const double next_scale = scale * (taken / legs.before);
      PathPiece blend{here.end,
                      true,
                      2 * legs.before / scale,
                      point_between(b, a, legs.before / here.length),
                      direction,
                      stretched(segments[i + 1].direction, next_scale),
                      line.low,
                      line.high};
      widen(blend, path[segments[i + 1].end]);
      pieces_.push_back(std::move(blend));
      scale = next_scale;
    } else {
      stops_.push_back(pieces_.size());
      at_.push_back(last ? path.size() - 1 : here.end);
      scale = 1;
    }
  }
}

}  // namespace kaboum::motion
