// Winding numbers at samples: signed crossings of a line along the face's axis with the chain,
// every sign exact, ties broken by an infinitesimal displacement within the face, then off the
// face.

#include <kaboum/base/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "allowance.h"
#include "cell_sample.h"

namespace kaboum::verify {
namespace {

/// Directions within a face, in barycentric coordinates (their sum is zero). For every finite set
/// of lines through a sample some of them lie on none; the list is long enough for what is met.
std::array<int, 3> direction(int attempt) {
  static constexpr std::array<std::array<int, 2>, 24> kPairs{
      {{3, 1},   {1, -4},  {5, -2},   {2, 7},    {-7, 3},  {11, 5},  {4, -13},  {-9, 17},
       {19, 8},  {6, 23},  {-29, 10}, {31, -12}, {14, 37}, {41, 15}, {-16, 43}, {47, -18},
       {20, 53}, {59, 21}, {-22, 61}, {67, -24}, {25, 71}, {73, 26}, {-27, 79}, {83, -28}}};
  const std::array<int, 2>& pair = kPairs[static_cast<std::size_t>(attempt) % kPairs.size()];
  const int turn = attempt / static_cast<int>(kPairs.size());
  const int x = pair[0] + 97 * turn, y = pair[1] - 89 * turn;
  return {x, y, -x - y};
}
constexpr int kAttempts = 2400;

/// Sign of Σ weight[i]·value(i): rounded first, exactly if that leaves it open.
template <class ApproxValue, class ExactValue>
Sign sign_of_sum(const Triple<Approx>& weight, const Triple<Exact>& exact_weight,
                 const ApproxValue& value, const ExactValue& exact_value) {
  const Triple<Approx> values{value(0), value(1), value(2)};
  if (const auto sign = sign_of(dot(weight, values))) return *sign;
  constexpr std::uint64_t kExact = 4000;  // about nanoseconds
  count_steps(kExact);
  return sign_of(dot(exact_weight, Triple<Exact>{exact_value(0), exact_value(1), exact_value(2)}));
}

/// A sample with a direction chosen, ready for queries.
class Line {
 public:
  Line(const MeshPair& meshes, const CellSample& sample, Side side)
      : meshes_(meshes),
        sample_(sample),
        face_(meshes.face(sample.face)),
        axis_(face_.axis),
        above_((side == kOuter) == face_.upward) {
    bound();
  }

  /// @return false when there is no such direction on the sample's side of its line.
  bool choose(int attempt) {
    std::array<int, 3> u = direction(attempt);
    if (sample_.line) {
      const Triple<Exact> exact{Exact(u[0]), Exact(u[1]), Exact(u[2])};
      const Sign sign = sign_of(dot(*sample_.line, exact));
      if (sign == Sign::Zero) return false;
      if (sign == Sign::Negative) u = {-u[0], -u[1], -u[2]};
    }
    direction_ = u;
    return true;
  }

  /// Signed crossings of the ray that goes up from the displaced sample; nullopt: choose another
  /// direction.
  [[nodiscard]] std::optional<int> crossings(int chain) const {
    int sum = 0;
    bool clear = true;
    std::uint64_t boxes = 0, faces = 0;
    const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
    meshes_.tree(chain).query(
        [&](const Bounds& box) {
          ++boxes;
          return clear && box.high[axis_] >= box_.low[axis_] && box.low[u] <= box_.high[u] &&
                 box.high[u] >= box_.low[u] && box.low[v] <= box_.high[v] &&
                 box.high[v] >= box_.low[v];
        },
        [&](std::uint32_t g) {
          ++faces;
          const std::optional<int> crossing = cross(g);
          if (crossing) {
            sum += *crossing;
          } else {
            clear = false;
          }
        });
    count_steps(kBox * boxes + kFace * faces);
    if (!clear) return std::nullopt;
    return sum;
  }

 private:
  // What looking at one takes, in about nanoseconds.
  static constexpr std::uint64_t kBox = 4, kFace = 150;

  /// A box that certainly contains the sample.
  void bound() {
    const Triple<Approx>& w = sample_.approx;
    const Approx total = w[0] + w[1] + w[2];
    for (int k = 0; k < 3; ++k) {
      box_.low[k] = std::min({corner(0)[k], corner(1)[k], corner(2)[k]});
      box_.high[k] = std::max({corner(0)[k], corner(1)[k], corner(2)[k]});
      Approx sum;
      for (int i = 0; i < 3; ++i) sum = sum + w[i] * Approx{corner(i)[k], 0};
      const double smallest = total.value - total.error;
      if (!(smallest > 0)) continue;
      const double q = sum.value / total.value;
      const double error =
          ((sum.error + std::abs(q) * total.error) / smallest + std::abs(q) * 2 * kUnit) * kGrowth +
          kTiny;
      if (!(error < 1e300)) continue;
      box_.low[k] = std::max(box_.low[k], q - 2 * error);
      box_.high[k] = std::min(box_.high[k], q + 2 * error);
    }
    for (int k = 0; k < 3; ++k) {
      middle_[k] = 0.5 * box_.low[k] + 0.5 * box_.high[k];
      half_[k] = std::max(box_.high[k] - middle_[k], middle_[k] - box_.low[k]) * kUp;
    }
  }

  /// The sign of a sum of products, given what rounding and the sample's box may take from it.
  /// @param size  of the products together; underflow would not show in the error of tiny ones
  static std::optional<Sign> certain_sign(double value, double error, double size) {
    constexpr double kLeast = 1e-200;
    if (!(size > kLeast)) return std::nullopt;
    if (value > error) return Sign::Positive;
    if (value < -error) return Sign::Negative;
    return std::nullopt;
  }

  /// Side of the sample with respect to a → b in the projection, as orient2d_value has it, where
  /// that is so for all of the sample's box: one evaluation in place of one for each corner.
  [[nodiscard]] std::optional<Sign> certain_turn(const Vec3& a, const Vec3& b) const {
    const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
    const double bu = b[u] - a[u], bv = b[v] - a[v];
    const double x = bu * (middle_[v] - a[v]), y = bv * (middle_[u] - a[u]);
    const double size = std::abs(x) + std::abs(y);
    // Each product has three roundings, their difference one.
    constexpr double kRoundings = 8 * kUnit;
    const double error =
        (kRoundings * size + std::abs(bu) * half_[v] + std::abs(bv) * half_[u]) * kUp;
    return certain_sign(x - y, error, size);
  }

  /// The same with respect to a triangle's plane, as orient3d_value has it.
  [[nodiscard]] std::optional<Sign> certain_side(const Vec3& a, const Vec3& b,
                                                 const Vec3& c) const {
    // What underflow takes from the normal's products would be multiplied by any distance.
    if (!meshes_.scaled()) return std::nullopt;
    const Vec3 ab = b - a, ac = c - a;
    double value = 0, size = 0, open = 0;
    for (int k = 0; k < 3; ++k) {
      const int u = (k + 1) % 3, v = (k + 2) % 3;
      const double x = ab[u] * ac[v], y = ab[v] * ac[u], d = middle_[k] - a[k];
      value += d * (x - y);
      size += std::abs(d) * (std::abs(x) + std::abs(y));
      open += half_[k] * (std::abs(x) + std::abs(y));
    }
    // In a component of the normal four roundings, three more in its product with d and the sum.
    constexpr double kRoundings = 16 * kUnit;
    return certain_sign(value, (kRoundings * size + open) * kUp, size);
  }

  [[nodiscard]] const Vec3& corner(int k) const { return meshes_.point(face_.v[k]); }

  /// Sign of an affine function, given by its values at the face's corners, at the displaced
  /// sample; Zero if it vanishes there and in the direction of displacement.
  template <class ApproxValue, class ExactValue>
  [[nodiscard]] Sign sign(const ApproxValue& value, const ExactValue& exact_value) const {
    const Sign at_spot = sign_of_sum(sample_.approx, sample_.exact, value, exact_value);
    if (at_spot != Sign::Zero) return at_spot;
    Triple<Approx> direction;
    Triple<Exact> exact_direction;
    for (int k = 0; k < 3; ++k) {
      direction[k] = integer<Approx>(direction_[k]);
      exact_direction[k] = integer<Exact>(direction_[k]);
    }
    return sign_of_sum(direction, exact_direction, value, exact_value);
  }

  [[nodiscard]] std::optional<int> cross(std::uint32_t gi) const {
    const Face& g = meshes_.face(gi);
    bool upward = g.upward;
    if (g.axis != axis_) {
      const Sign turn =
          orient2d(axis_, meshes_.point(g.v[0]), meshes_.point(g.v[1]), meshes_.point(g.v[2]));
      if (turn == Sign::Zero)
        return 0;  // upright: the line meets it nowhere, or is displaced off it
      upward = turn == Sign::Positive;
    }
    const Sign in = upward ? Sign::Positive : Sign::Negative;
    bool open = false;
    for (int e = 0; e < 3; ++e) {
      const std::uint32_t a = g.v[e], b = g.v[(e + 1) % 3];
      const auto value = [&]<class Number>(int i) {
        if (face_.v[i] == a || face_.v[i] == b) return integer<Number>(0);
        return orient2d_value<Number>(axis_, meshes_.point(a), meshes_.point(b), corner(i));
      };
      const std::optional<Sign> certain = certain_turn(meshes_.point(a), meshes_.point(b));
      const Sign s = certain ? *certain
                             : sign([&](int i) { return value.template operator()<Approx>(i); },
                                    [&](int i) { return value.template operator()<Exact>(i); });
      if (s == Sign::Zero) {
        open = true;
      } else if (s != in) {
        return 0;
      }
    }
    if (open) return std::nullopt;

    const auto value = [&]<class Number>(int i) {
      const std::uint32_t v = face_.v[i];
      if (v == g.v[0] || v == g.v[1] || v == g.v[2]) return integer<Number>(0);
      return orient3d_value<Number>(meshes_.point(g.v[0]), meshes_.point(g.v[1]),
                                    meshes_.point(g.v[2]), corner(i));
    };
    const std::optional<Sign> certain =
        certain_side(meshes_.point(g.v[0]), meshes_.point(g.v[1]), meshes_.point(g.v[2]));
    const Sign s = certain ? *certain
                           : sign([&](int i) { return value.template operator()<Approx>(i); },
                                  [&](int i) { return value.template operator()<Exact>(i); });
    if (s == Sign::Zero) {
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t v = face_.v[i];
        if (v != g.v[0] && v != g.v[1] && v != g.v[2] &&
            meshes_.side(gi, corner(i)) != Sign::Zero) {
          return std::nullopt;  // the displacement runs along the line where the planes meet
        }
      }
      // Coplanar: crossed if the sample is displaced downwards off the face.
      return above_ ? 0 : (upward ? 1 : -1);
    }
    // Below g: on the side away from an upward normal.
    const Sign below = upward ? Sign::Negative : Sign::Positive;
    return s == below ? (upward ? 1 : -1) : 0;
  }

  const MeshPair& meshes_;
  const CellSample& sample_;
  const Face& face_;
  int axis_;
  bool above_;
  Bounds box_{};
  std::array<double, 3> middle_{}, half_{};  // of the box: from its middle to its sides
  std::array<int, 3> direction_{};
};

template <class Count>
int with_some_direction(const MeshPair& meshes, const CellSample& sample, Side side,
                        const Count& count) {
  Line line(meshes, sample, side);
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (!line.choose(attempt)) continue;
    if (const std::optional<int> result = count(line)) return *result;
  }
  throw Error(ErrorCode::LimitReached,
              "no direction off all planes through a point; too many triangles meet there");
}

}  // namespace

int winding(const MeshPair& meshes, const CellSample& sample, Side side, int chain) {
  return with_some_direction(meshes, sample, side,
                             [&](const Line& line) { return line.crossings(chain); });
}

int winding_difference(const MeshPair& meshes, const CellSample& sample, Side side) {
  return with_some_direction(meshes, sample, side, [&](const Line& line) -> std::optional<int> {
    const std::optional<int> inside = line.crossings(kInside);
    if (!inside) return std::nullopt;
    const std::optional<int> outside = line.crossings(kOutside);
    if (!outside) return std::nullopt;
    return *outside - *inside;
  });
}

namespace {

/// Whether a point of the triangle's plane is in the triangle, its border included: then, and only
/// then, it is so in the projections along all axes; those that are degenerate say nothing.
bool holds(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    bool left = false, right = false;
    for (const auto& [from, to] : {std::pair{&a, &b}, {&b, &c}, {&c, &a}}) {
      const Sign s = geom::orient2d((*from)[u], (*from)[v], (*to)[u], (*to)[v], p[u], p[v]);
      left = left || s == Sign::Positive;
      right = right || s == Sign::Negative;
    }
    if (left && right) return false;
  }
  return true;
}

}  // namespace

std::optional<int> winding_at(const MeshPair& meshes, int chain, const Vec3& p) {
  // A vertical ray from (x + ε, y + ε²): side of the displaced point with respect to a → b.
  const auto side = [&](const Vec3& a, const Vec3& b) {
    const Sign s = geom::orient2d(a.x(), a.y(), b.x(), b.y(), p.x(), p.y());
    if (s != Sign::Zero) return to_int(s);
    if (a.y() != b.y()) return a.y() > b.y() ? 1 : -1;
    if (a.x() != b.x()) return b.x() > a.x() ? 1 : -1;
    return 0;
  };
  int sum = 0;
  bool touches = false;
  std::uint64_t boxes = 0;
  meshes.tree(chain).query(
      [&](const Bounds& box) {
        ++boxes;
        return p.x() >= box.low[0] && p.x() <= box.high[0] && p.y() >= box.low[1] &&
               p.y() <= box.high[1] && p.z() <= box.high[2];
      },
      [&](std::uint32_t f) {
        const Vec3 &a = meshes.corner(f, 0), &b = meshes.corner(f, 1), &c = meshes.corner(f, 2);
        const Sign height = meshes.side(f, p);
        if (height == Sign::Zero && holds(a, b, c, p)) touches = true;
        const int s = side(a, b);
        if (s == 0 || side(b, c) != s || side(c, a) != s) return;
        if (to_int(height) == -s) sum += s;
      });
  constexpr std::uint64_t kEach = 20;  // a face among them, now and then; in about nanoseconds
  count_steps(kEach * boxes);
  if (touches) return std::nullopt;
  return sum;
}

}  // namespace kaboum::verify
