// Contractions between the input and its offset: quadrics [garland1997] of the offset's tangent
// planes say where to, and what first; the surface decides whether it passes the input, samples
// whether it stays near.
#include "simplify.h"

#include <algorithm>
#include <array>
#include <optional>
#include <queue>
#include <tuple>

namespace kaboum::wrap {
namespace {

struct Candidate {
  double cost;
  std::uint32_t a, b;
  std::uint32_t version;
  bool operator<(const Candidate& other) const {  // the cheapest is taken first
    return std::tie(other.cost, other.a, other.b) < std::tie(cost, a, b);
  }
};

class Simplifier {
 public:
  Simplifier(Surface& surface, const Obstacle& obstacle, const Room& room, const Fit& fit)
      : surface_(surface),
        obstacle_(obstacle),
        room_(room),
        quadric_(surface.vertex_count()),
        version_(surface.vertex_count(), 0) {
    if (surface.vertex_count() > 0) origin_ = surface.point(0);
    for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) {
      if (surface.gone(t)) continue;
      const Plane plane = fit.plane_of(t);
      for (const std::uint32_t v : surface.triangle(t))
        quadric_[v].add_plane(plane.normal, plane.point - origin_, plane.area);
    }
  }

  /// @return contractions made
  std::size_t run() {
    for (std::uint32_t v = 0; v < surface_.vertex_count(); ++v)
      for (const std::uint32_t w : surface_.neighbours(v))
        if (v < w) push(v, w);
    std::size_t made = 0;
    while (!queue_.empty()) {
      const Candidate next = queue_.top();
      queue_.pop();
      if (next.version != version_[next.a] + version_[next.b]) continue;
      if (surface_.star(next.a).empty() || surface_.star(next.b).empty()) continue;
      if (!contract(next.a, next.b)) continue;
      ++made;
      for (const std::uint32_t w : surface_.neighbours(next.a)) push(next.a, w);
    }
    return made;
  }

 private:
  [[nodiscard]] Vec3 place(std::uint32_t a, std::uint32_t b) const {
    Quadric sum = quadric_[a];
    sum += quadric_[b];
    const Vec3 middle = 0.5 * (surface_.point(a) + surface_.point(b)) - origin_;
    sum.add_point(middle, 1e-4 * sum.weight);
    return sum.minimiser(middle);
  }

  [[nodiscard]] double cost(std::uint32_t a, std::uint32_t b, const Vec3& p) const {
    return std::max(0.0, quadric_[a].at(p) + quadric_[b].at(p));
  }

  void push(std::uint32_t a, std::uint32_t b) {
    const double length = (surface_.point(a) - surface_.point(b)).squaredNorm();
    // Short edges first where nothing is lost.
    const double c = cost(a, b, place(a, b)) + 1e-6 * length * room_.offset * room_.offset;
    queue_.push({c, std::min(a, b), std::max(a, b), version_[a] + version_[b]});
  }

  bool contract(std::uint32_t a, std::uint32_t b) {
    const Vec3 best = surface_.representable(place(a, b) + origin_);
    Vec3 other = surface_.point(a);
    if (cost(a, b, surface_.point(b) - origin_) < cost(a, b, other - origin_))
      other = surface_.point(b);
    const double weight = quadric_[a].weight + quadric_[b].weight;
    std::optional<double> allowed;
    for (const Vec3& p : {best, other}) {
      if (cost(a, b, p - origin_) > weight * room_.slack() * room_.slack()) continue;
      if (!room_.allows(p) || !keeps_shape(a, b, p) || !near(a, b, p, allowed)) continue;
      if (!surface_.contract(a, b, p)) continue;
      quadric_[a] += quadric_[b];
      ++version_[a];
      ++version_[b];
      return true;
    }
    return false;
  }

  /// The triangles that stay, as they would be: calls visit(before, after).
  template <class Visit>
  void for_each_changed(std::uint32_t a, std::uint32_t b, const Vec3& p, Visit&& visit) const {
    for (const std::uint32_t v : {a, b}) {
      for (const std::uint32_t t : surface_.star(v)) {
        const geom::Triangle& c = surface_.triangle(t);
        std::array<Vec3, 3> before, after;
        int ends = 0;
        for (int i = 0; i < 3; ++i) {
          const bool end = c[i] == a || c[i] == b;
          before[i] = surface_.point(c[i]);
          after[i] = end ? p : before[i];
          ends += end ? 1 : 0;
        }
        if (ends == 1) visit(before, after);
      }
    }
  }

  /// No triangle turns over, or becomes a needle that was none.
  [[nodiscard]] bool keeps_shape(std::uint32_t a, std::uint32_t b, const Vec3& p) const {
    bool keeps = true;
    for_each_changed(a, b, p, [&](const auto& before, const auto& after) {
      const Vec3 old_normal = (before[1] - before[0]).cross(before[2] - before[0]);
      const Vec3 normal = (after[1] - after[0]).cross(after[2] - after[0]);
      const auto longest = [](const std::array<Vec3, 3>& c) {
        return std::max({(c[1] - c[0]).squaredNorm(), (c[2] - c[1]).squaredNorm(),
                         (c[0] - c[2]).squaredNorm()});
      };
      const double round = normal.norm() / longest(after),
                   round_before = old_normal.norm() / longest(before);
      if (!(round > std::min(0.02, 0.5 * round_before))) keeps = false;
      if (round_before > 1e-3 && normal.dot(old_normal) < 0.2 * normal.norm() * old_normal.norm())
        keeps = false;
    });
    return keeps;
  }

  /// Samples of what would be there are within the offset, or not farther away than the farthest
  /// of what is there. @param allowed  that, once it is known
  [[nodiscard]] bool near(std::uint32_t a, std::uint32_t b, const Vec3& p,
                          std::optional<double>& allowed) {
    bool is_near = true;
    const auto sample = [&](const Vec3& x) {
      if (!is_near || obstacle_.within(x, allowed.value_or(room_.offset), hint_)) return;
      is_near = false;
      if (allowed) return;
      allowed = std::min(farthest(a, b), room_.farthest());
      is_near = *allowed > room_.offset && obstacle_.within(x, *allowed, hint_);
    };
    sample(p);
    for_each_changed(a, b, p, [&](const auto&, const auto& after) {
      sample((after[0] + after[1] + after[2]) / 3);
      for (int i = 0; i < 3; ++i)
        if (after[i] == p) sample(0.5 * (p + after[(i + 1) % 3]));
    });
    return is_near;
  }

  [[nodiscard]] double farthest(std::uint32_t a, std::uint32_t b) {
    double most = room_.offset;
    const auto sample = [&](const Vec3& x) {
      if (!obstacle_.within(x, most, hint_))
        most = std::max(most, obstacle_.foot(x, hint_).distance);
    };
    for (const std::uint32_t v : {a, b}) {
      sample(surface_.point(v));
      for (const std::uint32_t t : surface_.star(v)) {
        const geom::Triangle& c = surface_.triangle(t);
        sample((surface_.point(c[0]) + surface_.point(c[1]) + surface_.point(c[2])) / 3);
      }
    }
    return most;
  }

  Surface& surface_;
  const Obstacle& obstacle_;
  const Room& room_;
  Vec3 origin_ = Vec3::Zero();
  std::vector<Quadric> quadric_;
  std::vector<std::uint32_t> version_;
  std::priority_queue<Candidate> queue_;
  std::uint32_t hint_ = 0;
};

}  // namespace

void simplify(Surface& surface, const Obstacle& obstacle, const Room& room, const Fit& fit) {
  Simplifier(surface, obstacle, room, fit).run();
}

}  // namespace kaboum::wrap
