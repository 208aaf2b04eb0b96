// Lower bounds of the distance of two clusters over a box of joint values. docs/algorithms/pairs.md
// has the proof of each.

#include "gap.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numbers.h"
#include "simplex.h"

namespace kaboum::pairs::detail {
namespace {

constexpr double kUp = 1 + kRounding;

/// The farthest point of a cluster against a direction, its first derivatives included: the least
/// of d · p − Σ |c · p − e|. All in the cluster's frame.
struct Least {
  double value;
  std::uint32_t point;
};

Least least(const HullTree& tree, const Cluster& c, const Vec3& d,
            const BoxMotion::Linear* linear) {
  const double* x = tree.x(c);
  const double* y = x + c.count;
  const double* z = y + c.count;
  std::array<double, HullTree::kMostPoints> values{};
  const std::uint32_t n = c.count;
  for (std::uint32_t i = 0; i < n; ++i) values[i] = d.x() * x[i] + d.y() * y[i] + d.z() * z[i];
  if (linear != nullptr)
    for (std::size_t v = 0; v < linear->count; ++v) {
      const Vec3& k = linear->coefficients[v];
      const double e = linear->constants[v];
      for (std::uint32_t i = 0; i < n; ++i)
        values[i] -= std::abs(k.x() * x[i] + k.y() * y[i] + k.z() * z[i] - e);
    }
  Least out{values[0], 0};
  for (std::uint32_t i = 1; i < n; ++i)
    if (values[i] < out.value) out = {values[i], i};
  return out;
}

/// Coefficients for points that a transform places.
BoxMotion::Linear in_frame(const BoxMotion::Linear& linear, const Transform& t) {
  BoxMotion::Linear out = linear;
  for (std::size_t v = 0; v < linear.count; ++v) {
    out.coefficients[v] = t.linear.transpose() * linear.coefficients[v];
    out.constants[v] = linear.constants[v] - linear.coefficients[v].dot(t.translation);
  }
  return out;
}

}  // namespace

void BoxMotion::set(std::span<const double> middle, std::span<const double> half) {
  chain_->place(middle, placed_);
  const auto& joints = chain_->joints();
  half_.resize(joints.size());
  chord_.resize(joints.size());
  turned_.assign(joints.size() + 1, 0);
  turns_ = 0;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    half_[k] = std::abs(joints[k].multiplier) * half[joints[k].variable] * kUp;
    chord_[k] = joints[k].revolute ? 2 * std::sin(0.5 * std::min(half_[k], std::numbers::pi)) * kUp
                                   : half_[k];
    if (joints[k].revolute) turns_ += half_[k];
    turned_[k + 1] = turns_;
  }
}

BoxMotion::Sums BoxMotion::sums(const Vec3& center, double reach, bool of_b) const {
  const auto& joints = chain_->joints();
  const std::size_t n = joints.size();
  Sums out;  // of no joint: 0
  const auto add = [&](std::size_t k, std::size_t from, std::size_t to) {
    const double half = half_[k], both = turned_[k] + turned_[k + 1];
    double moved = half, share = half, turned = 2 * half * turned_[of_b ? k : k + 1];
    if (joints[k].revolute) {
      const double radius =
          placed_.axes[k].cross(center - placed_.origins[k]).norm() + reach + out.first[from];
      moved = chord_[k] * radius;
      share = half * radius;
      turned = share * both;
    }
    out.first[to] = out.first[from] + moved;
    out.share[to] = out.share[from] + share;
    out.turned[to] = out.turned[from] + turned;
  };
  if (of_b)
    for (std::size_t k = n; k-- > 0;) add(k, k + 1, k);
  else
    for (std::size_t k = 0; k < n; ++k) add(k, k, k + 1);
  return out;
}

BoxMotion::Bound BoxMotion::bound(const Vec3& center_a, double reach_a, const Vec3& center_b,
                                  double reach_b) const {
  Bound out{kInfinite, kInfinite, 0, 0};
  const Sums a = sums(center_a, reach_a, false), b = sums(center_b, reach_b, true);
  for (Split s = 0; s <= chain_->joints().size(); ++s) {
    const double first = a.first[s] + b.first[s];
    if (first < out.first) {
      out.first = first;
      out.first_split = s;
    }
    // Turns are counted from the frame between on: those up to joint k less those up to the frame.
    const double up_to = 2 * turned_[s];
    const double second =
        0.5 * (up_to * a.share[s] - a.turned[s] + b.turned[s] - up_to * b.share[s]) +
        kRounding * (up_to * (a.share[s] + b.share[s]) + a.turned[s] + b.turned[s]);
    if (second < out.second) {
      out.second = second;
      out.second_split = s;
    }
  }
  out.first *= kUp;
  out.second *= kUp;
  return out;
}

double BoxMotion::share_along(const Vec3& direction) const {
  const Vec3& axis = placed_.axes.front();
  return chain_->joints().front().revolute ? direction.cross(axis).norm()
                                           : std::abs(direction.dot(axis));
}

void BoxMotion::linear(const Vec3& direction, Split split, bool of_b, Linear& out) const {
  const auto& joints = chain_->joints();
  out.count = 0;
  const std::size_t from = of_b ? split : 0, to = of_b ? joints.size() : split;
  for (std::size_t k = from; k < to; ++k) {
    if (half_[k] == 0) continue;
    std::size_t v = 0;
    while (v < out.count && out.variables[v] != joints[k].variable) ++v;
    if (v == out.count) {
      out.variables[v] = joints[k].variable;
      out.coefficients[v].setZero();
      out.constants[v] = 0;
      ++out.count;
    }
    const double half = joints[k].multiplier < 0 ? -half_[k] : half_[k];
    if (joints[k].revolute) {
      const Vec3 c = half * direction.cross(placed_.axes[k]);
      out.coefficients[v] += c;
      out.constants[v] += c.dot(placed_.origins[k]);
    } else {
      out.constants[v] -= half * direction.dot(placed_.axes[k]);
    }
  }
}

Vec3 BoxMotion::displacement(const Vec3& point, Split split, bool of_b, const Linear& of,
                             std::span<const double> signs) const {
  const auto& joints = chain_->joints();
  Vec3 out = Vec3::Zero();
  const std::size_t from = of_b ? split : 0, to = of_b ? joints.size() : split;
  for (std::size_t k = from; k < to; ++k) {
    if (half_[k] == 0) continue;
    std::size_t v = 0;
    while (of.variables[v] != joints[k].variable) ++v;
    const double change = signs[v] * (joints[k].multiplier < 0 ? -half_[k] : half_[k]);
    out += joints[k].revolute ? (change * placed_.axes[k].cross(point - placed_.origins[k])).eval()
                              : (change * placed_.axes[k]).eval();
  }
  return out;
}

template <typename Support>
Gap Gaps::search(const Support& support, Vec3 direction, double allowed, double enough,
                 bool give_up) const {
  Gap best;
  Simplex simplex;
  const double length = direction.norm();
  direction = length > 0 ? (direction / length).eval() : Vec3::UnitZ().eval();
  for (int step = 0; step < 40; ++step) {
    Vec3 p, q;
    const double value = support(direction, p, q) - allowed;
    if (value > best.lower) {
      best.lower = value;
      best.direction = direction;
    }
    if (best.lower > enough || (give_up && best.upper - allowed <= enough)) break;
    if (step > 0 && best.upper - allowed - best.lower <= 1e-9 * (reach_ * 1e-3 + best.upper)) break;
    simplex.add(q - p, p, q);
    const Vec3 nearest = simplex.reduce();
    const double distance = nearest.norm();
    if (distance < best.upper) {
      best.upper = distance;
      best.on_a.setZero();
      best.on_b.setZero();
      for (int i = 0; i < simplex.size; ++i) {
        best.on_a += simplex.weights[i] * simplex.on_a[i];
        best.on_b += simplex.weights[i] * simplex.on_b[i];
      }
    } else if (step > 0) {
      break;  // rounding: no more comes of it
    }
    if (simplex.size == 4 || distance <= 1e-13 * reach_) break;
    direction = nearest / distance;
  }
  return best;
}

double Gaps::lower(const Cluster& a, const Cluster& b, const BoxMotion& box, Vec3& direction,
                   double enough) const {
  const Transform& at = box.placed().b;
  const Vec3 center = at * b.center;
  const BoxMotion::Bound bound = box.bound(a.center, a.reach, center, b.reach);
  const double turned = 1 + box.turns();
  const double rounding = (2 * error_ + kRounding * reach_) * turned * turned;
  const double still = a.radius + b.radius + rounding;
  if (direction.isZero()) direction = center - a.center;

  const auto rests = [&](const Vec3& d, Vec3& p, Vec3& q) {
    const Vec3 in_b = at.linear.transpose() * d;
    const Least x = least(*a_, a, -d, nullptr), y = least(*b_, b, in_b, nullptr);
    p = a_->point(a, x.point);
    q = at * b_->point(b, y.point);
    return x.value + y.value + d.dot(at.translation);
  };
  const Gap plain = search(rests, direction, still + bound.first, enough, true);
  direction = plain.direction;
  double best = plain.lower;
  if (best <= enough && box.placed().axes.size() == 1) {
    // What turns about the direction, or slides across it, does not move along it.
    const Vec3 axis = box.placed().axes.front().normalized();
    for (const Vec3& d : {plain.direction, axis, (-axis).eval()}) {
      Vec3 p, q;
      const double share = box.share_along(d) + 8 * error_ / reach_ + kRounding;
      const double value = rests(d, p, q) - still - bound.first * std::min(1.0, share);
      if (value <= best) continue;
      best = value;
      direction = d;
    }
  }
  if (best > enough || bound.second >= bound.first || plain.upper - still - bound.second <= enough)
    return best;

  const BoxMotion::Split split = bound.second_split;
  const auto moves = [&](const Vec3& d, Vec3& p, Vec3& q) {
    BoxMotion::Linear of_a, of_b;
    box.linear(-d, split, false, of_a);
    box.linear(d, split, true, of_b);
    const BoxMotion::Linear local = in_frame(of_b, at);
    const Vec3 in_b = at.linear.transpose() * d;
    const Least x = least(*a_, a, -d, &of_a), y = least(*b_, b, in_b, &local);
    p = a_->point(a, x.point);
    q = at * b_->point(b, y.point);
    std::array<double, BoxMotion::Linear::kMost> signs{};
    // Towards each other: against −d for a, against d for b.
    for (std::size_t v = 0; v < of_a.count; ++v)
      signs[v] = of_a.coefficients[v].dot(p) - of_a.constants[v] > 0 ? -1 : 1;
    const Vec3 shift_a = box.displacement(p, split, false, of_a, signs);
    for (std::size_t v = 0; v < of_b.count; ++v)
      signs[v] = of_b.coefficients[v].dot(q) - of_b.constants[v] > 0 ? -1 : 1;
    q += box.displacement(q, split, true, of_b, signs);
    p += shift_a;
    return x.value + y.value + d.dot(at.translation);
  };
  // The balls round the clusters' hulls turn with them.
  const double allowed = still + (a.radius + b.radius) * box.turns() * kUp + bound.second;
  const Gap second = search(moves, direction, allowed, enough, true);
  if (second.lower <= best) return best;
  direction = second.direction;
  return second.lower;
}

Gap Gaps::at_middle(const Cluster& a, const Cluster& b, const BoxMotion& box, const Vec3& direction,
                    double enough) const {
  const Transform& at = box.placed().b;
  const auto rests = [&](const Vec3& d, Vec3& p, Vec3& q) {
    const Vec3 in_b = at.linear.transpose() * d;
    const Least x = least(*a_, a, -d, nullptr), y = least(*b_, b, in_b, nullptr);
    p = a_->point(a, x.point);
    q = at * b_->point(b, y.point);
    return x.value + y.value + d.dot(at.translation);
  };
  return search(rests, direction.isZero() ? (at * b.center - a.center).eval() : direction,
                a.radius + b.radius + 2 * error_ + kRounding * reach_, enough, false);
}

double Gaps::overlap(const Cluster& a, const Cluster& b, const Chain::Placed& placed,
                     const Vec3& direction) const {
  const Vec3 d = direction.normalized();
  const Least x = least(*a_, a, -d, nullptr),
              y = least(*b_, b, placed.b.linear.transpose() * d, nullptr);
  return -(x.value + y.value + d.dot(placed.b.translation)) + a.radius + b.radius + 2 * error_ +
         kRounding * reach_;
}

}  // namespace kaboum::pairs::detail
