// Speeds along a path with limits of velocity and acceleration.

#include "speed_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

namespace kaboum::motion {
namespace {

using Values = std::vector<double>;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kFastest = 1e100;  ///< the square is a number
constexpr int kGraded = 24;         ///< cells of a piece
constexpr int kSteps = 60;          ///< towards the largest square that is allowed

PathCell cell_of(const PathPiece& piece, std::size_t index, double from, double to) {
  PathCell out{index, from, to - from, piece.at(from).first, piece.at(to).first, {}};
  out.bend = piece.at(from).second;
  return out;
}

/// Bound of the square y at the end of a cell, of which that at its beginning is x:
/// y·factor is at most slope·x + free, and at least slope·x − free.
struct Band {
  double factor = 0, slope = 0, free = 0;
};

/// With w twice the cell's length, the parameter's acceleration is (y − x)/w. At the beginning of
/// the cell that of a joint is bend·x + in (y − x)/w, at its end bend·y + out (y − x)/w, and in
/// between on a straight line over the parameter.
void append_bands(std::vector<Band>& bands, const PathCell& cell, const Values& acceleration) {
  const double w = 2 * cell.length;
  for (std::size_t j = 0; j < acceleration.size(); ++j) {
    if (cell.in[j] == 0 && cell.out[j] == 0) continue;
    const double bent = w * cell.bend[j], free = w * acceleration[j];
    bands.push_back({cell.in[j], cell.in[j] - bent, free});
    bands.push_back({cell.out[j] + bent, cell.out[j], free});
  }
}

/// a + b·x
struct Line {
  double a = 0, b = 0;
};

/// The largest x in [0, most] for which some y in [0, end] is in all bands: of the least upper and
/// the greatest lower bound of y, the first is concave in x and the second convex. From above,
/// Newton's steps come to where they meet.
double largest_begin(std::span<const Band> bands, double most, double end) {
  double x = most;
  for (const Band& band : bands)
    if (band.factor == 0 && std::abs(band.slope) * x > band.free)
      x = band.free / std::abs(band.slope);
  for (int step = 0; step < kSteps; ++step) {
    Line high{end, 0}, low{0, 0};
    for (const Band& band : bands) {
      if (band.factor == 0) continue;
      const double sign = band.factor > 0 ? 1 : -1;
      const Line up{sign * band.free / band.factor, band.slope / band.factor},
          down{-sign * band.free / band.factor, band.slope / band.factor};
      if (up.a + up.b * x < high.a + high.b * x) high = up;
      if (down.a + down.b * x > low.a + low.b * x) low = down;
    }
    const double beyond = (low.a - high.a) + (low.b - high.b) * x;
    if (!(beyond > 0)) return x;
    const double next = (high.a - low.a) / (low.b - high.b);
    if (!(next >= 0)) return 0;
    if (!(next < x)) return x * (1 - 0x1p-50);
    x = next;
  }
  return x;
}

double largest_end(std::span<const Band> bands, double begin, double most) {
  double y = most;
  for (const Band& band : bands) {
    if (band.factor == 0) continue;
    const double sign = band.factor > 0 ? 1 : -1;
    y = std::min(y, (band.slope * begin + sign * band.free) / band.factor);
  }
  return std::max(y, 0.0);
}

double largest_square(const PathCell& cell, const Values& velocity) {
  double out = kFastest;
  for (std::size_t j = 0; j < velocity.size(); ++j) {
    const double first = std::max(std::abs(cell.in[j]), std::abs(cell.out[j]));
    if (first > 0) out = std::min(out, velocity[j] / first);
  }
  return out * out;
}

void set_times(SpeedProfile& profile) {
  profile.times.assign(1, 0);
  for (std::size_t i = 0; i < profile.cells.size(); ++i)
    profile.times.push_back(profile.times.back() + 2 * profile.cells[i].length /
                                                       (std::sqrt(profile.squares[i]) +
                                                        std::sqrt(profile.squares[i + 1])));
}

}  // namespace

std::vector<PathCell> graded_cells(std::span<const PathPiece> pieces) {
  std::vector<PathCell> out;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    double from = 0;
    for (int k = 1; k <= kGraded; ++k) {
      const double share = k == kGraded ? 1 : 0.5 - 0.5 * std::cos(std::numbers::pi * k / kGraded);
      const double to = share * pieces[i].length;
      if (to > from) out.push_back(cell_of(pieces[i], i, from, to));
      from = to;
    }
  }
  return out;
}

std::vector<PathCell> even_cells(std::span<const PathPiece> pieces, const SpeedProfile& profile,
                                 std::size_t count) {
  std::vector<PathCell> out;
  std::size_t first = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    std::size_t last = first;  // cells of this piece
    while (last < profile.cells.size() && profile.cells[last].piece == i) ++last;
    const double begin = profile.times[first], time = profile.times[last] - begin;
    const auto parts = static_cast<std::size_t>(
        std::max(4.0, std::ceil(static_cast<double>(count) * time / profile.times.back())));
    double from = 0;
    std::size_t cell = first;
    for (std::size_t k = 1; k <= parts; ++k) {
      const double at = begin + time * static_cast<double>(k) / static_cast<double>(parts);
      while (cell + 1 < last && profile.times[cell + 1] <= at) ++cell;
      const double t = at - profile.times[cell];
      const double inside =
          t * (std::sqrt(profile.squares[cell]) + 0.5 * t * profile.acceleration(cell));
      const double to = k == parts ? pieces[i].length
                                   : std::min(profile.cells[cell].place + inside, pieces[i].length);
      if (!(to > from)) continue;
      out.push_back(cell_of(pieces[i], i, from, to));
      from = to;
    }
    first = last;
  }
  return out;
}

SpeedProfile fastest_profile(std::vector<PathCell> cells, const Values& velocity,
                             const Values& acceleration, const std::vector<double>& most) {
  SpeedProfile out{std::move(cells), {}, {}};
  const std::size_t count = out.cells.size();
  std::vector<Band> bands;
  std::vector<std::size_t> begins{0};
  std::vector<double> top(count + 1, kInfinite);  // of the square
  for (std::size_t i = 0; i < count; ++i) {
    append_bands(bands, out.cells[i], acceleration);
    begins.push_back(bands.size());
    const double here = largest_square(out.cells[i], velocity);
    top[i] = std::min(top[i], here);
    top[i + 1] = here;
  }
  for (std::size_t i = 0; i <= count && !most.empty(); ++i) top[i] = std::min(top[i], most[i]);
  top[0] = top[count] = 0;
  const auto bands_of = [&](std::size_t i) {
    return std::span<const Band>(bands).subspan(begins[i], begins[i + 1] - begins[i]);
  };
  for (std::size_t i = count; i-- > 1;) top[i] = largest_begin(bands_of(i), top[i], top[i + 1]);
  out.squares.assign(1, 0);
  for (std::size_t i = 0; i < count; ++i)
    out.squares.push_back(largest_end(bands_of(i), out.squares[i], top[i + 1]));
  set_times(out);
  return out;
}

SpeedProfile straight_profile(const PathPiece& piece, const Values& velocity,
                              const Values& acceleration, double even) {
  double most = kInfinite, fastest = kInfinite;
  for (std::size_t j = 0; j < piece.in.size(); ++j) {
    const double first = std::abs(piece.in[j]);
    if (first == 0) continue;
    fastest = std::min(fastest, velocity[j] / first);
    most = std::min(most, acceleration[j] / first);
  }
  // v²/most + v·even = length, without a difference of numbers that are nearly alike.
  const double root = std::sqrt(even * even + 4 * piece.length / most),
               speed = std::min(fastest, 2 * piece.length / (even + root)),
               ramp = std::min(0.5 * speed * speed / most, 0.5 * piece.length);
  SpeedProfile out;
  out.squares.assign(1, 0);
  for (const auto& [from, to, square] :
       {std::tuple{0.0, ramp, speed * speed}, std::tuple{ramp, piece.length - ramp, speed * speed},
        std::tuple{piece.length - ramp, piece.length, 0.0}}) {
    if (!(to > from)) continue;
    out.cells.push_back(cell_of(piece, 0, from, to));
    out.squares.push_back(square);
  }
  out.squares.back() = 0;
  set_times(out);
  return out;
}

}  // namespace kaboum::motion
