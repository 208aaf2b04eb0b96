// Two meshes in one configuration: how far apart, or how deep in each other.

#include "contact.h"

#include <kaboum/base/radical_inverse.h>
#include <kaboum/geom/predicates.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <queue>

#include "numbers.h"

namespace kaboum::pairs::detail {
namespace {

constexpr std::size_t kStepsToTriangles = 40;  ///< down the trees, for each pair of triangles

constexpr std::size_t kRays = 64;  ///< from a point that may be shut off

using Corners = std::array<Vec3, 3>;
using geom::Sign;

/// Smallest distance of two segments, rounded: [ericson2005] §5.1.9, all ends besides.
double between_segments(const Vec3& p, const Vec3& p2, const Vec3& q, const Vec3& q2) {
  const Vec3 u = p2 - p, v = q2 - q, w = p - q;
  const double a = u.dot(u), e = v.dot(v), b = u.dot(v), c = u.dot(w), f = v.dot(w);
  const auto near = [&](double s, double t) { return (p + s * u - q - t * v).squaredNorm(); };
  const auto clamp = [](double x) { return std::clamp(x, 0.0, 1.0); };
  double best = kInfinite;
  for (const double s : {0.0, 1.0})
    best = std::min(best, near(s, e > 0 ? clamp((s * b + f) / e) : 0));
  for (const double t : {0.0, 1.0})
    best = std::min(best, near(a > 0 ? clamp((t * b - c) / a) : 0, t));
  const double determinant = a * e - b * b;
  if (determinant > 0) {
    const double s = (b * f - c * e) / determinant, t = (a * f - b * c) / determinant;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) best = std::min(best, near(s, t));
  }
  return std::sqrt(best);
}

/// How far an edge may be moved against a triangle that it goes through without leaving it: the
/// distance of its ends from the plane and of the edge from the triangle's. 0: it does not.
double margin(const Vec3& from, const Vec3& to, const Corners& t) {
  Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double length = n.norm();
  if (!(length > 0)) return 0;
  n /= length;
  const double start = n.dot(from - t[0]), end = n.dot(to - t[0]);
  if (!(start * end < 0)) return 0;
  const Vec3 at = from + start / (start - end) * (to - from);
  for (int i = 0; i < 3; ++i)
    if ((t[(i + 1) % 3] - t[i]).cross(at - t[i]).dot(n) <= 0) return 0;
  double out = std::min(std::abs(start), std::abs(end));
  for (int i = 0; i < 3; ++i) out = std::min(out, between_segments(from, to, t[i], t[(i + 1) % 3]));
  return out;
}

double margin(const Corners& s, const Corners& t) {
  double out = 0;
  for (int i = 0; i < 3; ++i) {
    out = std::max(out, margin(s[i], s[(i + 1) % 3], t));
    out = std::max(out, margin(t[i], t[(i + 1) % 3], s));
  }
  return out;
}

/// Whether a segment is seen not to meet a triangle, exactly: its ends are on one side, or the line
/// passes edges on both sides. Where it is not seen, it may still be so.
bool is_clear(const Vec3& p, const Vec3& q, const Corners& t) {
  const Sign at_p = geom::orient3d(t[0], t[1], t[2], p);
  if (at_p != Sign::Zero && at_p == geom::orient3d(t[0], t[1], t[2], q)) return true;
  bool left = false, right = false;
  for (int i = 0; i < 3; ++i) {
    const Sign side = geom::orient3d(p, q, t[i], t[(i + 1) % 3]);
    left = left || side == Sign::Positive;
    right = right || side == Sign::Negative;
  }
  return left && right;
}

/// Whether a segment may meet a box. @param more  that the box is wider to all sides
bool may_meet(const geom::Box3& box, const Vec3& p, const Vec3& q, double more) {
  double from = 0, to = 1;
  for (int k = 0; k < 3; ++k) {
    const double low = box.min[k] - more - p[k], high = box.max[k] + more - p[k],
                 along = q[k] - p[k];
    if (std::abs(along) <= more) {
      if (low > more || high < -more) return false;
      continue;
    }
    from = std::max(from, (along > 0 ? low : high) / along);
    to = std::min(to, (along > 0 ? high : low) / along);
  }
  return from <= to;
}

/// The i-th of directions that are spread all over; of length 1, rounded.
Vec3 spread_direction(std::size_t i) {
  const double z = 1 - 2 * radical_inverse(i, 2),
               turn = 2 * std::numbers::pi * radical_inverse(i, 3);
  const double across = std::sqrt(std::max(0.0, 1 - z * z));
  return {across * std::cos(turn), across * std::sin(turn), z};
}

Mesh away_from(const Mesh& mesh, const Vec3& point, double distance) {
  Mesh out{mesh.vertices, {}};
  for (const geom::Triangle& t : mesh.triangles)
    if (std::ranges::any_of(
            t, [&](std::uint32_t v) { return (mesh.vertices[v] - point).norm() > distance; }))
      out.triangles.push_back(t);
  return out;
}

}  // namespace

Surface::Surface(Mesh mesh, Solid solid)
    : solid_(solid),
      mesh_(std::move(mesh)),
      tree_(mesh_),
      bvh_(std::make_shared<geom::Bvh>(mesh_)),
      query_(mesh_.triangles.empty() ? nullptr : std::make_shared<geom::DistanceQuery>(mesh_)),
      winding_(mesh_, bvh_) {
  // Equal corners are one; what they connect is a part.
  std::map<std::array<double, 3>, std::uint32_t> first;
  std::vector<std::uint32_t> same(mesh_.vertices.size()), up(mesh_.vertices.size());
  std::iota(up.begin(), up.end(), 0U);
  const auto root = [&](std::uint32_t v) {
    while (up[v] != v) v = up[v] = up[up[v]];
    return v;
  };
  for (std::uint32_t v = 0; v < same.size(); ++v) {
    const Vec3& p = mesh_.vertices[v];
    same[v] = first.emplace(std::array{p.x(), p.y(), p.z()}, v).first->second;
  }
  std::vector<char> used(up.size(), 0);
  for (const geom::Triangle& t : mesh_.triangles)
    for (const std::uint32_t v : t) {
      used[v] = 1;
      up[root(same[v])] = root(same[t[0]]);
    }
  for (std::uint32_t v = 0; v < used.size(); ++v)
    if (used[v] != 0) corners_.push_back(v);
  std::map<std::uint32_t, std::uint32_t> numbers;
  for (const geom::Triangle& t : mesh_.triangles) {
    const auto [at, is_new] =
        numbers.emplace(root(same[t[0]]), static_cast<std::uint32_t>(parts_.size()));
    if (is_new) parts_.push_back(t[0]);
    part_of_.push_back(at->second);
  }
  // Closed is a part with each directed edge as often as its reverse.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, std::uint32_t>> edges;
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t x = same[mesh_.triangles[i][k]],
                          y = same[mesh_.triangles[i][(k + 1) % 3]];
      if (x == y) continue;
      auto& [sum, part] = edges[{std::min(x, y), std::max(x, y)}];
      sum += x < y ? 1 : -1;
      part = part_of_[i];
    }
  closed_.assign(parts_.size(), 1);
  for (const auto& [ends, edge] : edges)
    if (edge.first != 0) closed_[edge.second] = 0;
}

Surface::Surface(const Surface& whole, const Vec3& point, double distance)
    : Surface(away_from(whole.mesh(), point, distance), whole.solid()) {
  whole_ = &whole;
  std::erase_if(corners_,
                [&](std::uint32_t v) { return !((mesh_.vertices[v] - point).norm() > distance); });
  // The other mesh may go through a part's triangles nearer to the point: one corner is not enough.
  parts_ = corners_;
}

Surface::Winding Surface::winding(const Vec3& point) const {
  if (whole_ != nullptr) return whole_->winding(point);
  std::map<std::uint32_t, int> numbers;
  winding_.crossings(point, [&](std::uint32_t triangle, int sign) {
    const std::uint32_t part = part_of_[triangle];
    if (closed_[part] != 0) numbers[part] += sign;
  });
  Winding out;
  for (const auto& [part, number] : numbers) {
    out.sum += number;
    out.any = out.any || number != 0;
  }
  return out;
}

bool Surface::sees_out(const Vec3& point, std::size_t rays) const {
  if (whole_ != nullptr) return whole_->sees_out(point, rays);
  // The ball round the root holds all triangles: what is not in it is far away.
  const Cluster& root = tree_[0];
  const Vec3 from_center = point - root.center;
  const double reach =
      root.reach * (1 + 0x1p-30) + 0x1p-30 * (tree_.extent() + point.cwiseAbs().maxCoeff());
  const double far = reach + from_center.norm();
  if (from_center.norm() > reach) return true;
  const Vec3 away = from_center.norm() > 0 ? from_center.normalized() : Vec3::UnitZ();
  for (std::size_t i = 0; i < rays; ++i) {
    const Vec3 end = point + 2 * far * (i == 0 ? away : spread_direction(i));
    if (!((end - root.center).norm() > reach)) continue;
    bool clear = true;
    bvh_->traverse(
        [&](const geom::Box3& box) { return clear && may_meet(box, point, end, 0x1p-30 * far); },
        [&](std::uint32_t t) {
          const geom::Triangle& v = mesh_.triangles[t];
          clear =
              clear && is_clear(point, end,
                                {mesh_.vertices[v[0]], mesh_.vertices[v[1]], mesh_.vertices[v[2]]});
        });
    if (clear) return true;
  }
  return false;
}

Surface::Place Surface::place(const Vec3& point, std::size_t rays) const {
  const Winding found = winding(point);
  if (found.sum >= 1) return Place::Inside;
  if (solid_ == Solid::ShutOff) return sees_out(point, rays) ? Place::Outside : Place::Unclear;
  return found.any ? Place::Unclear : Place::Outside;
}

double Surface::distance(const Vec3& point, double least) const {
  if (whole_ != nullptr) return whole_->distance(point, least);
  if (least > 0 && query_->within(point, least) != geom::TriangleSearch::kNone) return 0;
  return query_->nearest(point).lower;
}

Contact::Nearest Contact::nearest(const BoxMotion& box, double gap, std::size_t most_steps) const {
  struct Open {
    double lower;
    std::uint32_t a, b;
    Vec3 direction;
    bool operator<(const Open& o) const {
      return lower != o.lower ? lower > o.lower : std::pair(a, b) > std::pair(o.a, o.b);
    }
  };
  const HullTree &ta = a_->tree(), &tb = b_->tree();
  Nearest out{0, kInfinite, {}, {}};
  double closed = kInfinite;  // least lower bound of what was left
  std::priority_queue<Open> open;
  const auto look = [&](std::uint32_t i, std::uint32_t j, const Vec3& hint) {
    const double balls = (box.placed().b * tb[j].center - ta[i].center).norm() - ta[i].reach -
                         tb[j].reach - rounding();
    if (balls > out.upper) {
      closed = std::min(closed, balls);
      return;
    }
    const Gap g = gaps_.at_middle(ta[i], tb[j], box, hint, out.upper);
    const bool leaf = ta[i].leaf() && tb[j].leaf();
    if (leaf && g.upper < out.upper) {
      out.upper = g.upper;
      out.on_a = g.on_a;
      out.on_b = g.on_b;
    }
    if (leaf || g.lower > out.upper)
      closed = std::min(closed, g.lower);
    else
      open.push({g.lower, i, j, g.direction});
  };
  look(0, 0, Vec3::Zero());
  const double touching = 0x1p-38 * gaps_.reach();
  std::size_t steps = 0;
  while (!open.empty() && open.top().lower < out.upper - gap && ++steps < most_steps) {
    const Open at = open.top();
    open.pop();
    const bool cut_a = !ta[at.a].leaf() && (tb[at.b].leaf() || ta[at.a].reach > tb[at.b].reach);
    if (cut_a) {
      look(ta[at.a].left, at.b, at.direction);
      look(ta[at.a].right, at.b, at.direction);
    } else {
      look(at.a, tb[at.b].left, at.direction);
      look(at.a, tb[at.b].right, at.direction);
    }
    if (out.upper <= std::max(gap, touching)) break;
  }
  if (!open.empty()) closed = std::min(closed, open.top().lower);
  out.lower = std::clamp(closed, 0.0, out.upper);
  return out;
}

template <typename Look>
void Contact::visit_meeting(const BoxMotion& box, std::size_t most_steps, const Look& look) const {
  const HullTree &ta = a_->tree(), &tb = b_->tree();
  struct Open {
    std::uint32_t a, b;
    Vec3 direction;
  };
  std::vector<Open> open{{0, 0, Vec3::Zero()}};
  for (std::size_t step = 0; !open.empty() && step < most_steps; ++step) {
    const Open top = open.back();
    open.pop_back();
    const Cluster &a = ta[top.a], &b = tb[top.b];
    // Balls round them tell most apart, at less expense.
    const double balls = a.reach + b.reach + rounding();
    if ((box.placed().b * b.center - a.center).squaredNorm() > balls * balls) continue;
    const Gap g = gaps_.at_middle(a, b, box, top.direction, 0);
    if (g.lower > 0) continue;
    if (a.leaf() && b.leaf()) {
      if (!look(a.triangle, b.triangle)) return;
    } else if (!a.leaf() && (b.leaf() || a.reach > b.reach)) {
      open.push_back({a.left, top.b, g.direction});
      open.push_back({a.right, top.b, g.direction});
    } else {
      open.push_back({top.a, b.left, g.direction});
      open.push_back({top.a, b.right, g.direction});
    }
  }
}

double Contact::margin_of(const BoxMotion& box, std::uint32_t of_a, std::uint32_t of_b) const {
  const auto corners = [](const Mesh& mesh, std::uint32_t t) {
    const geom::Triangle& v = mesh.triangles[t];
    return Corners{mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]};
  };
  Corners placed = corners(b_->mesh(), of_b);
  for (Vec3& p : placed) p = box.placed().b * p;
  return margin(corners(a_->mesh(), of_a), placed);
}

double Contact::pierced(const BoxMotion& box, std::size_t most_triangles) const {
  double best = 0;
  std::size_t looked = 0;
  visit_meeting(box, kStepsToTriangles * most_triangles, [&](std::uint32_t i, std::uint32_t j) {
    best = std::max(best, margin_of(box, i, j));
    return ++looked < most_triangles;
  });
  return best;
}

double Contact::some_depth(const BoxMotion& box, std::size_t most_steps) const {
  const Gap hulls = gaps_.at_middle(a_->tree()[0], b_->tree()[0], box, Vec3::Zero(), 0);
  if (hulls.lower > 0) return 0;
  double found = 0;
  visit_meeting(box, most_steps, [&](std::uint32_t i, std::uint32_t j) {
    found = margin_of(box, i, j) - rounding();
    return !(found > 0);
  });
  if (found > 0) return found;
  return std::max(0.0, inside(box, most_steps / 16, true) - rounding());
}

double Contact::farthest_meeting(const BoxMotion& box, const Vec3& in_a, const Vec3& in_b) const {
  double most = 0;
  std::size_t looked = 0;
  visit_meeting(box, std::numeric_limits<std::size_t>::max(),
                [&](std::uint32_t i, std::uint32_t j) {
                  for (const std::uint32_t v : a_->mesh().triangles[i])
                    most = std::max(most, (a_->mesh().vertices[v] - in_a).norm());
                  for (const std::uint32_t v : b_->mesh().triangles[j])
                    most = std::max(most, (b_->mesh().vertices[v] - in_b).norm());
                  return ++looked < 100'000;
                });
  return most;
}

double Contact::inside(const BoxMotion& box, std::size_t most_corners, bool few) const {
  const Transform& at = box.placed().b;
  const Transform back{at.linear.transpose(), -(at.linear.transpose() * at.translation)};
  double best = 0;
  const auto look = [&](const Surface& in, const Surface& of, const Transform& to) {
    const Cluster& root = in.tree()[0];
    std::vector<Vec3> found;
    const std::size_t apart = few ? of.corners().size() / most_corners + 1 : 1;
    for (std::size_t i = 0; i < of.corners().size(); i += apart) {
      const Vec3 p = to * of.mesh().vertices[of.corners()[i]];
      if ((p - root.center).norm() <= root.reach) found.push_back(p);
    }
    // Spread over all of them where these are too many.
    const std::size_t step = found.size() / most_corners + 1;
    for (std::size_t i = 0; i < found.size(); i += step) {
      const double distance = in.distance(found[i], best);
      if (distance > best && in.winding(found[i]).sum >= 1) best = distance;
    }
  };
  look(*a_, *b_, at);
  look(*b_, *a_, back);
  return best;
}

double Contact::depth_below(const BoxMotion& box, std::size_t most_corners,
                            std::size_t most_triangles) const {
  return std::max({0.0, pierced(box, most_triangles) - rounding(),
                   inside(box, most_corners, false) - rounding()});
}

double Contact::depth_above_roughly(const BoxMotion& box) const {
  const Cluster &a = a_->tree()[0], &b = b_->tree()[0];
  double best = kInfinite;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0)
          best = std::min(best, gaps_.overlap(a, b, box.placed(), Vec3(x, y, z)));
  return std::max(0.0, best);
}

double Contact::depth_above(const BoxMotion& box) const {
  std::vector<Vec3> directions;
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z)
        if (x != 0 || y != 0 || z != 0) directions.emplace_back(x, y, z);
  const Cluster &a = a_->tree()[0], &b = b_->tree()[0];
  double best = kInfinite;
  Vec3 at = Vec3::UnitX();
  const auto look = [&](const Vec3& d) {
    const double here = gaps_.overlap(a, b, box.placed(), d);
    if (here >= best) return false;
    best = here;
    at = d.normalized();
    return true;
  };
  for (const Vec3& d : directions) look(d);
  // Down from the best one, in smaller and smaller steps.
  Vec3 from = at;
  for (double step = 0.3; step > 1e-3;) {
    bool better = false;
    from = at;
    for (const Vec3& d : directions) better = look(from + step * d.normalized()) || better;
    if (!better) step /= 2;
  }
  return std::max(0.0, best);
}

Contact::Held Contact::held(const BoxMotion& box) const {
  const Transform& at = box.placed().b;
  const Transform back{at.linear.transpose(), -(at.linear.transpose() * at.translation)};
  // Hulls that are apart hold nothing of each other.
  if (gaps_.at_middle(a_->tree()[0], b_->tree()[0], box, Vec3::Zero(), 0).lower > 0)
    return Held::Nothing;
  Held out = Held::Nothing;
  const auto look = [&](const Surface& in, const Surface& of, const Transform& to) {
    for (const std::uint32_t v : of.parts()) {
      // What is unclear already does not become clear by more rays.
      const Surface::Place place =
          in.place(to * of.mesh().vertices[v], out == Held::Nothing ? kRays : 0);
      if (place == Surface::Place::Inside)
        out = Held::Part;
      else if (place == Surface::Place::Unclear && out == Held::Nothing)
        out = Held::Unclear;
    }
  };
  look(*a_, *b_, at);
  look(*b_, *a_, back);
  return out;
}

}  // namespace kaboum::pairs::detail
