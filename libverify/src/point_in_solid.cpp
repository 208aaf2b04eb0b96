// Whether points and segments are in closure{w ≥ 1}: winding numbers next to a point, one in each
// cone that the planes of the faces through it leave. docs/algorithms/exact-inclusion.md, "Segments
// and points".
#include "point_in_solid.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "allowance.h"

namespace kaboum::verify {
namespace {

// What one takes, in about nanoseconds.
constexpr std::uint64_t kBox = 4, kFace = 200, kExact = 8000;

Triple<Exact> exact(const Vec3& p) { return {Exact(p.x()), Exact(p.y()), Exact(p.z())}; }

template <class Number>
Triple<Number> cross(const Triple<Number>& a, const Triple<Number>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class Number>
Triple<Number> plus(const Triple<Number>& a, const Triple<Number>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

template <class Number>
Triple<Number> minus(const Triple<Number>& a, const Triple<Number>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Triple<Exact> times(const Exact& s, const Triple<Exact>& a) {
  return {s * a[0], s * a[1], s * a[2]};
}

bool is_zero(const Triple<Exact>& a) {
  return std::all_of(a.begin(), a.end(), [](const Exact& x) { return sign_of(x) == Sign::Zero; });
}

Exact dot(const Triple<Exact>& a, const Triple<Exact>& b) { return verify::dot<Exact>(a, b); }

/// (b − a) × (c − a).
template <class Number>
Triple<Number> normal_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  Triple<Number> u, v;
  for (int k = 0; k < 3; ++k) {
    u[static_cast<std::size_t>(k)] = difference<Number>(b[k], a[k]);
    v[static_cast<std::size_t>(k)] = difference<Number>(c[k], a[k]);
  }
  return cross<Number>(u, v);
}

/// A power of two of about the size of the largest component; 1 where that is no double.
double size_of(const Triple<Exact>& a) {
  double largest = 0;
  for (const Exact& x : a) largest = std::max(largest, std::abs(rounded(x).value));
  return largest > 1e-250 && largest < 1e250 ? std::exp2(std::round(std::log2(largest))) : 1;
}

/// Directions from a point, and what the chain winds about the places right next to it there.
class Neighbourhood {
 public:
  Neighbourhood(const MeshPair& meshes, int chain, const ExactPoint& point)
      : meshes_(meshes), chain_(chain), point_(point) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = point.box.low[k], high = point.box.high[k];
      const double middle = 0.5 * low + 0.5 * high;
      near_[k] = {middle, std::max(high - middle, middle - low) * kGrowth};
      if (low == high) near_[k] = {low, 0};
    }
    find_planes();
  }

  /// Whether w ≥ 1 somewhere as near as one likes.
  [[nodiscard]] bool touches_solid() const {
    if (planes_.empty()) return value({Exact(1), Exact(2), Exact(3)}) >= 1;
    if (planes_.size() == 1)
      return value(planes_[0]) >= 1 || value(times(Exact(-1), planes_[0])) >= 1;
    for (std::size_t g = 0; g < planes_.size(); ++g) {
      for (const Triple<Exact>& along : between_others(g)) {
        for (const int side : {1, -1})
          if (value(lifted(along, g, side)) >= 1) return true;
      }
    }
    return false;
  }

 private:
  /// The normals of the planes of faces that hold the point, each plane once.
  void find_planes() {
    std::vector<std::uint32_t> faces;
    std::uint64_t boxes = 0;
    meshes_.tree(chain_).query(
        [&](const Bounds& box) {
          ++boxes;
          return box.meets(point_.box);
        },
        [&](std::uint32_t f) { faces.push_back(f); });
    count_steps(kBox * boxes);
    for (const std::uint32_t f : faces) {
      count_steps(kExact);
      Triple<Exact> normal = normal_of<Exact>(corner(f, 0), corner(f, 1), corner(f, 2));
      if (sign_of(dot(normal, from(corner(f, 0)))) != Sign::Zero || !holds(f)) continue;
      const bool known = std::any_of(planes_.begin(), planes_.end(), [&](const auto& other) {
        return is_zero(cross<Exact>(other, normal));
      });
      if (!known) planes_.push_back(std::move(normal));
    }
  }

  /// The point seen from a vertex, times w.
  [[nodiscard]] Triple<Exact> from(const Vec3& a) const {
    return minus(point_.x, times(point_.w, exact(a)));
  }

  /// Whether a point of the face's plane is in the face, in the projection along its axis.
  [[nodiscard]] bool holds(std::uint32_t f) const {
    const Face& face = meshes_.face(f);
    const int u = (face.axis + 1) % 3, v = (face.axis + 2) % 3;
    const Sign outside = face.upward ? Sign::Negative : Sign::Positive;
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = corner(f, k), &b = corner(f, (k + 1) % 3);
      const Triple<Exact> p = from(a);
      const Exact turn = difference<Exact>(b[u], a[u]) * p[static_cast<std::size_t>(v)] -
                         difference<Exact>(b[v], a[v]) * p[static_cast<std::size_t>(u)];
      if (sign_of(turn) == outside) return false;
    }
    return true;
  }

  /// Directions within plane g, one between each two neighbours of those in which it meets others.
  [[nodiscard]] std::vector<Triple<Exact>> between_others(std::size_t g) const {
    std::vector<Triple<Exact>> rays;
    const Triple<Exact>& n = planes_[g];
    for (std::size_t h = 0; h < planes_.size(); ++h) {
      if (h == g) continue;
      rays.push_back(cross<Exact>(n, planes_[h]));
      rays.push_back(times(Exact(-1), rays.back()));
    }
    count_steps(kExact * rays.size());
    const Triple<Exact> first = rays.front();
    const auto turn = [&](const Triple<Exact>& a, const Triple<Exact>& b) {
      return to_int(sign_of(dot(cross<Exact>(a, b), n)));
    };
    // Half a turn from the first, or more.
    const auto late = [&](const Triple<Exact>& a) {
      const int t = turn(first, a);
      return t < 0 || (t == 0 && sign_of(dot(first, a)) == Sign::Negative);
    };
    std::vector<std::pair<bool, Triple<Exact>>> sorted;
    sorted.reserve(rays.size());
    for (Triple<Exact>& r : rays) sorted.emplace_back(late(r), std::move(r));
    std::sort(sorted.begin(), sorted.end(), [&](const auto& a, const auto& b) {
      return a.first != b.first ? b.first : turn(a.second, b.second) > 0;
    });
    const auto same = [&](const auto& a, const auto& b) {
      return a.first == b.first && turn(a.second, b.second) == 0;
    };
    sorted.erase(std::unique(sorted.begin(), sorted.end(), same), sorted.end());
    std::vector<Triple<Exact>> result;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      const Triple<Exact>& a = sorted[i].second;
      const Triple<Exact>& b = sorted[(i + 1) % sorted.size()].second;
      // All others meet it in one line: a quarter of a turn on.
      result.push_back(sorted.size() == 2 ? cross<Exact>(n, a) : plus(a, b));
    }
    return result;
  }

  /// A direction of plane g, lifted off it without passing another plane.
  [[nodiscard]] Triple<Exact> lifted(const Triple<Exact>& along, std::size_t g, int side) const {
    const Triple<Exact>& n = planes_[g];
    Exact share(side * std::ldexp(size_of(along) / size_of(n), -2));
    for (;; share = share * Exact(0x1p-8)) {
      count_steps(kExact * planes_.size());
      Triple<Exact> lifted = plus(along, times(share, n));
      if (same_cone(along, lifted, g)) return lifted;
    }
  }

  /// Whether two directions are on the same side of all planes but one.
  [[nodiscard]] bool same_cone(const Triple<Exact>& a, const Triple<Exact>& b,
                               std::size_t but) const {
    for (std::size_t h = 0; h < planes_.size(); ++h)
      if (h != but && sign_of(dot(planes_[h], a)) != sign_of(dot(planes_[h], b))) return false;
    return true;
  }

  /// The winding number next to the point in a direction that is in no plane through it.
  [[nodiscard]] int value(const Triple<Exact>& direction) const {
    constexpr int kAttempts = 200;
    Triple<Exact> d = direction;
    for (int attempt = 1;; ++attempt) {
      if (const std::optional<int> found = crossings(d)) return *found;
      if (attempt == kAttempts)
        throw Error(ErrorCode::LimitReached,
                    "no direction off all edges from a point; too many triangles are round it");
      // Another direction of the same cone.
      const Triple<Exact> turn{Exact(attempt), Exact(7 - 3 * attempt), Exact(5 * attempt + 2)};
      Exact share(std::ldexp(size_of(direction), -8));
      do {
        share = share * Exact(0x1p-4);
        d = plus(direction, times(share, turn));
        count_steps(kExact * planes_.size());
      } while (!same_cone(direction, d, planes_.size()));
    }
  }

  /// Signed crossings of the ray from the point; nullopt where it meets an edge, or runs within a
  /// face's plane.
  [[nodiscard]] std::optional<int> crossings(const Triple<Exact>& d) const {
    const Triple<Approx> approx{rounded(d[0]), rounded(d[1]), rounded(d[2])};
    int sum = 0;
    bool clear = true;
    std::uint64_t boxes = 0, faces = 0;
    meshes_.tree(chain_).query(
        [&](const Bounds& box) {
          ++boxes;
          return clear && may_hit(box, approx);
        },
        [&](std::uint32_t f) {
          ++faces;
          const std::optional<int> crossing = cross_face(f, d, approx);
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

  /// Whether the ray may meet a box; true wherever it does.
  [[nodiscard]] bool may_hit(const Bounds& box, const Triple<Approx>& d) const {
    constexpr double kWide = 1e-12;
    double from = 0, to = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      if (d[k].value == 0 && d[k].error == 0) {
        if (box.high[k] < point_.box.low[k] || box.low[k] > point_.box.high[k]) return false;
        continue;
      }
      const bool up = d[k].value > 0;
      const double size = std::abs(d[k].value);
      if (!(size > 2 * d[k].error) || !(size > 1e-290)) continue;
      // How far the sides are along the axis, in the ray's direction.
      const double enter = up ? box.low[k] - point_.box.high[k] : point_.box.low[k] - box.high[k];
      const double leave = up ? box.high[k] - point_.box.low[k] : point_.box.high[k] - box.low[k];
      const double fast = (size + d[k].error) * (1 + kWide);
      const double slow = (size - d[k].error) * (1 - kWide);
      const double first = enter > 0 ? enter / fast : enter / slow;
      const double last = leave > 0 ? leave / slow : leave / fast;
      if (std::isnan(first) || std::isnan(last)) continue;
      from = std::max(from, first - kWide * std::abs(first));
      to = std::min(to, last + kWide * std::abs(last) + kTiny);
    }
    return from <= to;
  }

  /// Sign of a value: rounded first, exactly if that leaves it open.
  template <class ApproxValue, class ExactValue>
  static Sign certain(const ApproxValue& value, const ExactValue& exact_value) {
    if (const auto sign = sign_of(value())) return *sign;
    count_steps(kExact);
    return sign_of(exact_value());
  }

  /// 1 where the ray leaves through the face, −1 where it enters, 0 where it does not meet it.
  [[nodiscard]] std::optional<int> cross_face(std::uint32_t f, const Triple<Exact>& d,
                                              const Triple<Approx>& approx) const {
    const auto seen = [&](int k) {
      Triple<Approx> p;
      for (int i = 0; i < 3; ++i) {
        const auto j = static_cast<std::size_t>(i);
        p[j] = Approx{corner(f, k)[i], 0} - near_[j];
      }
      return p;
    };
    const Sign height = certain(
        [&] {
          const Triple<Approx> n = normal_of<Approx>(corner(f, 0), corner(f, 1), corner(f, 2));
          return -verify::dot<Approx>(n, seen(0));
        },
        [&] {
          return dot(normal_of<Exact>(corner(f, 0), corner(f, 1), corner(f, 2)),
                     from(corner(f, 0)));
        });
    if (height == Sign::Zero) {
      // The ray meets the plane in the point alone, from where the face is not crossed.
      const Exact rise = dot(normal_of<Exact>(corner(f, 0), corner(f, 1), corner(f, 2)), d);
      if (sign_of(rise) == Sign::Zero) return std::nullopt;
      return 0;
    }
    bool left = false, right = false, open = false;
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3;
      const Sign s =
          certain([&] { return verify::dot<Approx>(cross<Approx>(seen(k), seen(l)), approx); },
                  [&] {  // both factors are negated, and positive multiples
                    return dot(cross<Exact>(from(corner(f, k)), from(corner(f, l))), d);
                  });
      left = left || s == Sign::Positive;
      right = right || s == Sign::Negative;
      open = open || s == Sign::Zero;
    }
    if (left && right) return 0;
    if (open) return std::nullopt;
    // The face's normal times d has this sign; it is crossed ahead if the point is on the other
    // side of the face.
    const Sign rise = left ? Sign::Positive : Sign::Negative;
    return height == rise ? 0 : to_int(rise);
  }

  [[nodiscard]] const Vec3& corner(std::uint32_t f, int k) const { return meshes_.corner(f, k); }

  const MeshPair& meshes_;
  int chain_;
  const ExactPoint& point_;
  Triple<Approx> near_;
  std::vector<Triple<Exact>> planes_;
};

/// A place on a segment: the share of it from its beginning, from 0 to 1.
struct Place {
  Exact part, whole;  ///< whole > 0

  [[nodiscard]] bool before(const Place& other) const {
    return sign_of(part * other.whole - other.part * whole) == Sign::Negative;
  }
};

/// The part of a segment that a face in whose plane it lies holds, as its two ends.
class Clip {
 public:
  /// Keeps where at_first + t (at_last − at_first) ≥ 0.
  void keep(const Exact& at_first, const Exact& at_last) {
    const Sign first = sign_of(at_first), last = sign_of(at_last);
    if (first == Sign::Negative && last == Sign::Negative) empty_ = true;
    if (first != Sign::Negative && last != Sign::Negative) return;
    if (first == Sign::Negative) {
      const Place enter{-at_first, at_last - at_first};
      if (from_.before(enter)) from_ = enter;
    } else {
      const Place leave{at_first, at_first - at_last};
      if (leave.before(to_)) to_ = leave;
    }
  }
  [[nodiscard]] bool empty() const { return empty_ || to_.before(from_); }
  [[nodiscard]] const Place& from() const { return from_; }
  [[nodiscard]] const Place& to() const { return to_; }

 private:
  Place from_{Exact(0), Exact(1)}, to_{Exact(1), Exact(1)};
  bool empty_ = false;
};

/// Places where a segment enters, leaves or pierces faces: between two neighbours it is either off
/// all of them, or the same faces hold it, each within or along the same edge.
class Breaks {
 public:
  Breaks(const MeshPair& meshes, int chain, const Vec3& p, const Vec3& q)
      : meshes_(meshes), p_(p), q_(q), places_{{Exact(0), Exact(1)}, {Exact(1), Exact(1)}} {
    Bounds all;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      all.low[i] = std::min(p[k], q[k]);
      all.high[i] = std::max(p[k], q[k]);
    }
    std::uint64_t boxes = 0;
    meshes.tree(chain).query(
        [&](const Bounds& box) {
          ++boxes;
          return box.meets(all);
        },
        [&](std::uint32_t f) { meet(f); });
    count_steps(kBox * boxes);
    std::sort(places_.begin(), places_.end(),
              [](const Place& a, const Place& b) { return a.before(b); });
    places_.erase(
        std::unique(places_.begin(), places_.end(),
                    [](const Place& a, const Place& b) { return !a.before(b) && !b.before(a); }),
        places_.end());
  }

  [[nodiscard]] const std::vector<Place>& places() const { return places_; }

 private:
  void meet(std::uint32_t f) {
    count_steps(kFace);
    const Sign first = meshes_.side(f, p_), last = meshes_.side(f, q_);
    if (first == Sign::Zero && last == Sign::Zero) {
      meet_in_plane(f);
      return;
    }
    // At an end it begins or ceases to be in the face, between two places in any case.
    if (first == last || first == Sign::Zero || last == Sign::Zero) return;
    bool left = false, right = false;
    for (int k = 0; k < 3; ++k) {
      const Sign s = geom::orient3d(p_, q_, meshes_.corner(f, k), meshes_.corner(f, (k + 1) % 3));
      left = left || s == Sign::Positive;
      right = right || s == Sign::Negative;
    }
    if (left && right) return;
    count_steps(kExact);
    Exact above = height(f, p_), below = height(f, q_);
    if (sign_of(above) == Sign::Negative) {
      above = -above;
      below = -below;
    }
    places_.push_back({above, above - below});
  }

  void meet_in_plane(std::uint32_t f) {
    count_steps(kExact);
    const Face& face = meshes_.face(f);
    Clip clip;
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = meshes_.corner(f, k), &b = meshes_.corner(f, (k + 1) % 3);
      Exact first = orient2d_value<Exact>(face.axis, a, b, p_);
      Exact last = orient2d_value<Exact>(face.axis, a, b, q_);
      if (!face.upward) {
        first = -first;
        last = -last;
      }
      clip.keep(first, last);
    }
    if (clip.empty()) return;
    places_.push_back(clip.from());
    places_.push_back(clip.to());
  }

  [[nodiscard]] Exact height(std::uint32_t f, const Vec3& p) const {
    return orient3d_value<Exact>(meshes_.corner(f, 0), meshes_.corner(f, 1), meshes_.corner(f, 2),
                                 p);
  }

  const MeshPair& meshes_;
  const Vec3& p_;
  const Vec3& q_;
  std::vector<Place> places_;
};

/// The box of what doubles can say of x / w, within `all`.
Bounds box_of(const Triple<Exact>& x, const Exact& w, const Bounds& all) {
  Bounds box = all;
  const auto [least, most] = w.to_interval();
  if (!(least > 1e-290) || !(most < 1e290)) return box;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] = x[k].to_interval();
    constexpr double kUp = 1 + 0x1p-50;
    double a = low / (low > 0 ? most : least), b = high / (high > 0 ? least : most);
    a -= std::abs(a) * (kUp - 1) + kTiny;
    b += std::abs(b) * (kUp - 1) + kTiny;
    if (a > box.low[k]) box.low[k] = std::min(a, all.high[k]);
    if (b < box.high[k]) box.high[k] = std::max(b, all.low[k]);
  }
  return box;
}

}  // namespace

bool is_in_solid(const MeshPair& meshes, int chain, const ExactPoint& point) {
  return Neighbourhood(meshes, chain, point).touches_solid();
}

std::optional<Vec3> segment_outside(const MeshPair& meshes, int chain, const Vec3& p,
                                    const Vec3& q) {
  Bounds all;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    all.low[i] = std::min(p[k], q[k]);
    all.high[i] = std::max(p[k], q[k]);
  }
  if (p == q) {
    if (is_in_solid(meshes, chain, {exact(p), Exact(1), all})) return std::nullopt;
    return p;
  }
  const Breaks breaks(meshes, chain, p, q);
  const std::vector<Place>& places = breaks.places();
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const Exact part = places[i].part + places[i + 1].part;
    const Exact whole = places[i].whole + places[i + 1].whole;
    const Triple<Exact> x = plus(times(whole - part, exact(p)), times(part, exact(q)));
    const ExactPoint middle{x, whole, box_of(x, whole, all)};
    if (is_in_solid(meshes, chain, middle)) continue;
    Vec3 at;
    for (int k = 0; k < 3; ++k) {
      const auto j = static_cast<std::size_t>(k);
      at[k] = 0.5 * middle.box.low[j] + 0.5 * middle.box.high[j];
    }
    return at;
  }
  return std::nullopt;
}

}  // namespace kaboum::verify
