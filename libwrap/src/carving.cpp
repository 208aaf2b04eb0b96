// Alpha wrapping [portaneri2022]: a box of Delaunay tetrahedra, carved from outside.
#include "carving.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/float32.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>

#include "delaunay.h"

namespace kaboum::wrap {
namespace {

constexpr std::uint32_t kNone = Delaunay::kNone;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Sphere {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};

Sphere circumsphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const Vec3 vw = v.cross(w), wu = w.cross(u), uv = u.cross(v);
  const double det = u.dot(vw);
  const Vec3 x = (u.squaredNorm() * vw + v.squaredNorm() * wu + w.squaredNorm() * uv) / (2 * det);
  if (!x.allFinite()) return {(a + b + c + d) / 4, kInfinity};
  return {a + x, x.norm()};
}

Vec3 circumcenter(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a, n = u.cross(v);
  const Vec3 x =
      (u.squaredNorm() * v.cross(n) + v.squaredNorm() * n.cross(u)) / (2 * n.squaredNorm());
  return x.allFinite() ? Vec3(a + x) : Vec3((a + b + c) / 3);
}

class Carver {
 public:
  Carver(const geom::Mesh& input, const Obstacle& obstacle, const CarvingOptions& options)
      : obstacle_(obstacle), options_(options), delaunay_(box_round(input, options)) {
    double most = 0;
    for (std::uint32_t v = 0; v < 8; ++v)
      most = std::max(most, delaunay_.point(v).cwiseAbs().maxCoeff());
    const double spacing = options.float32 ? geom::float32_spacing(most) : most * 0x1p-51;
    apart_ = std::max(0.2 * options.offset, 2 * spacing);
    info_.resize(delaunay_.cell_count());
    for (std::uint32_t c = 0; c < delaunay_.cell_count(); ++c) take_up(c);
    for (std::uint32_t c = 0; c < delaunay_.cell_count(); ++c) push_gates_into(c);
  }

  void run() {
    while (!queue_.empty()) {
      const Gate gate = queue_.top();
      queue_.pop();
      if (delaunay_.cell(gate.cell).gone() || info_[gate.cell].stamp != gate.stamp ||
          info_[gate.cell].outside)
        continue;
      pass(gate);
    }
  }

  void make_manifold();
  [[nodiscard]] geom::Mesh boundary() const;
  [[nodiscard]] std::size_t points() const { return delaunay_.point_count(); }

 private:
  enum class Known : std::uint8_t { No, Clear, Met };
  struct Info {  // of a tetrahedron
    std::uint32_t stamp = 0;
    bool outside = false;
    bool measured = false;
    Known clear = Known::No;
    Sphere sphere;
    Foot foot{Vec3::Zero(), 0, 0};  ///< of the centre
  };
  struct Gate {  // a facet from outside into a tetrahedron that is not
    double radius;
    std::uint32_t number;
    std::uint32_t cell, side, stamp;
    bool operator<(const Gate& other) const {
      return std::tie(radius, other.number) < std::tie(other.radius, number);
    }
  };

  /// Tetrahedra round a vertex in groups that are connected through facets at it.
  struct Groups {
    std::vector<std::uint32_t> round, group;  ///< the tetrahedra, and the group of each
    std::vector<double> size;                 ///< of each group, six times its volume
    std::vector<char> outside;                ///< of each group
    std::uint32_t outer = 0, inner = 0;       ///< number of groups
    [[nodiscard]] std::size_t place_of(std::uint32_t c) const {
      return static_cast<std::size_t>(std::find(round.begin(), round.end(), c) - round.begin());
    }
  };
  [[nodiscard]] Groups groups_round(std::uint32_t v) const;
  [[nodiscard]] std::vector<std::uint32_t> bridge(std::uint32_t v, const Groups& groups) const;
  [[nodiscard]] std::vector<std::uint32_t> filling(std::uint32_t v) const;
  bool cut_off(std::uint32_t v, const std::vector<std::uint32_t>& cells);
  bool split(std::uint32_t from, std::uint32_t to, double distance);

  static geom::Box3 box_round(const geom::Mesh& input, const CarvingOptions& o) {
    geom::Box3 box = geom::bounding_box(input);
    const double border = 3 * (o.radius + o.offset) + 0.05 * box.diagonal();
    box.min -= Vec3::Constant(border);
    box.max += Vec3::Constant(border);
    if (o.float32) {
      box.min = geom::to_float32(box.min);
      box.max = geom::to_float32(box.max);
    }
    return box;
  }

  void take_up(std::uint32_t c) {
    if (c >= info_.size()) info_.resize(std::max<std::size_t>(c + 1, info_.size() * 2));
    info_[c] = {};
    info_[c].stamp = ++stamps_;
    const auto& v = delaunay_.cell(c).vertex;
    info_[c].sphere = circumsphere(delaunay_.point(v[0]), delaunay_.point(v[1]),
                                   delaunay_.point(v[2]), delaunay_.point(v[3]));
  }

  const Info& measured(std::uint32_t c, std::uint32_t hint) {
    Info& info = info_[c];
    if (!info.measured) {
      info.foot = obstacle_.rough_foot(info.sphere.center, hint);
      info.measured = true;
    }
    return info;
  }

  [[nodiscard]] bool is_outside(std::uint32_t c) const { return c == kNone || info_[c].outside; }

  [[nodiscard]] std::array<Vec3, 3> facet(std::uint32_t c, std::uint32_t side) const {
    const auto& f = Delaunay::kFacet[side];
    const auto& v = delaunay_.cell(c).vertex;
    return {delaunay_.point(v[f[0]]), delaunay_.point(v[f[1]]), delaunay_.point(v[f[2]])};
  }

  /// Gates into the tetrahedron, from whatever is outside.
  void push_gates_into(std::uint32_t c) {
    for (std::uint32_t i = 0; i < 4; ++i)
      if (is_outside(delaunay_.cell(c).next[i])) push(c, i);
  }

  void push(std::uint32_t c, std::uint32_t side) {
    const std::uint32_t from = delaunay_.cell(c).next[side];
    double radius = kInfinity;
    if (from != kNone) {
      // The smallest empty sphere through the facet's corners: its centre lies between those of
      // the tetrahedra.
      const Vec3 &a = info_[from].sphere.center, &b = info_[c].sphere.center;
      const Vec3 corner = delaunay_.point(delaunay_.cell(c).vertex[Delaunay::kFacet[side][0]]);
      const Vec3 way = b - a;
      const double square = way.squaredNorm();
      const double t = square > 0 ? std::clamp((corner - a).dot(way) / square, 0.0, 1.0) : 0;
      radius = (a + t * way - corner).norm();
      if (!(radius >= options_.radius)) return;
    }
    queue_.push({radius, pushed_++, c, side, info_[c].stamp});
  }

  /// The point of the input's offset below x.
  [[nodiscard]] Vec3 on_offset(const Vec3& x, std::uint32_t hint) const {
    const Foot foot = obstacle_.foot(x, hint);
    return foot.point + options_.offset / foot.distance * (x - foot.point);
  }

  /// Where the ball's centre, on its way into the tetrahedron, comes too near to the input: a point
  /// there on the input's offset.
  std::optional<Vec3> obstruction(std::uint32_t c, std::uint32_t side) {
    const std::uint32_t from = delaunay_.cell(c).next[side];
    const Vec3 b = info_[c].sphere.center;
    const Foot end = measured(c, from == kNone ? 0 : measured(from, 0).foot.triangle).foot;
    Vec3 a;
    Foot foot{};
    if (from == kNone) {
      const auto f = facet(c, side);
      const Vec3 n = (f[1] - f[0]).cross(f[2] - f[0]);
      a = circumcenter(f[0], f[1], f[2]);
      if ((b - f[0]).dot(n) >= 0) a = b;
      foot = obstacle_.rough_foot(a, end.triangle);
    } else {
      a = info_[from].sphere.center;
      foot = measured(from, 0).foot;
    }
    const double length = (b - a).norm(), tau = options_.offset;
    if (Obstacle::kRough * (foot.distance + end.distance) - length >
        2 * std::max(tau, options_.radius))
      return {};
    const Vec3 way = length > 0 ? Vec3((b - a) / length) : Vec3::Zero();
    const double least = 0.05 * tau;
    Vec3 x = a, nearest_x = a;
    Foot nearest = foot;
    double t = 0;
    while (true) {
      if (foot.distance < nearest.distance) {
        nearest = foot;
        nearest_x = x;
      }
      if (foot.distance <= tau + least) return on_offset(x, foot.triangle);
      t += std::max(Obstacle::kRough * foot.distance - tau, least);
      if (!(t < length)) break;
      x = a + t * way;
      foot = obstacle_.rough_foot(x, foot.triangle);
    }
    if (end.distance < nearest.distance) {
      nearest = end;
      nearest_x = b;
    }
    if (nearest.distance <= std::max(tau, options_.radius))
      return on_offset(nearest_x, nearest.triangle);
    return {};
  }

  /// Whether all of a facet rests on the input (CarvingOptions::rest).
  [[nodiscard]] bool rests(std::uint32_t c, std::uint32_t side) const {
    const auto corners = facet(c, side);
    return obstacle_.covers({corners.begin(), corners.end()}, options_.rest(),
                            info_[c].foot.triangle);
  }

  bool clear(std::uint32_t c) {
    Info& info = info_[c];
    if (info.clear == Known::No) {
      const auto& v = delaunay_.cell(c).vertex;
      const Tetrahedron t{delaunay_.point(v[0]), delaunay_.point(v[1]), delaunay_.point(v[2]),
                          delaunay_.point(v[3])};
      info.clear = obstacle_.clear({&t, 1}) ? Known::Clear : Known::Met;
    }
    return info.clear == Known::Clear;
  }

  void pass(const Gate& gate) {
    const std::uint32_t c = gate.cell;
    std::optional<Vec3> point = obstruction(c, gate.side);
    if (!point) {
      if (clear(c)) {
        info_[c].outside = true;
        for (std::uint32_t i = 0; i < 4; ++i) {
          const std::uint32_t d = delaunay_.cell(c).next[i];
          if (d == kNone || info_[d].outside) continue;
          const auto& next = delaunay_.cell(d).next;
          push(d,
               static_cast<std::uint32_t>(std::find(next.begin(), next.end(), c) - next.begin()));
        }
        return;
      }
      point = on_offset(info_[c].sphere.center, info_[c].foot.triangle);
    }
    if (!point->allFinite() || rests(c, gate.side)) return;
    add(options_.float32 ? geom::to_float32(*point) : *point, c, delaunay_.cell(c).next[gate.side]);
  }

  void add(const Vec3& p, std::uint32_t c, std::uint32_t from) {
    const Sphere& s = info_[c].sphere;
    const bool inside = (p - s.center).norm() < s.radius;
    if (delaunay_.insert(p, inside || from == kNone ? c : from, apart_) == kNone) return;
    if (delaunay_.point_count() > options_.max_points) throw_too_fine(options_.max_points);
    for (const std::uint32_t d : delaunay_.made()) take_up(d);
    for (const std::uint32_t d : delaunay_.made()) push_gates_into(d);
  }

  const Obstacle& obstacle_;
  CarvingOptions options_;
  Delaunay delaunay_;
  double apart_ = 0;
  std::vector<Info> info_;
  std::priority_queue<Gate> queue_;
  std::uint32_t stamps_ = 0, pushed_ = 0;
  std::size_t splits_ = 0;
};

/// The groups of the tetrahedra round a vertex.
Carver::Groups Carver::groups_round(std::uint32_t v) const {
  const auto volume = [&](std::uint32_t c) {
    const auto& corner = delaunay_.cell(c).vertex;
    const Vec3& a = delaunay_.point(corner[0]);
    return (delaunay_.point(corner[1]) - a)
        .cross(delaunay_.point(corner[2]) - a)
        .dot(delaunay_.point(corner[3]) - a);
  };
  Groups out;
  delaunay_.cells_round(v, out.round);
  out.group.assign(out.round.size(), kNone);
  for (std::size_t first = 0; first < out.round.size(); ++first) {
    if (out.group[first] != kNone) continue;
    const auto number = static_cast<std::uint32_t>(out.size.size());
    const bool outside = info_[out.round[first]].outside;
    (outside ? out.outer : out.inner) += 1;
    out.size.push_back(0);
    out.outside.push_back(outside ? 1 : 0);
    std::vector<std::size_t> stack{first};
    out.group[first] = number;
    while (!stack.empty()) {
      const std::size_t k = stack.back();
      stack.pop_back();
      out.size[number] += volume(out.round[k]);
      const Delaunay::Cell& cell = delaunay_.cell(out.round[k]);
      for (std::uint32_t i = 0; i < 4; ++i) {
        if (cell.vertex[i] == v || cell.next[i] == kNone) continue;
        const std::size_t at = out.place_of(cell.next[i]);
        if (out.group[at] != kNone || info_[out.round[at]].outside != outside) continue;
        out.group[at] = number;
        stack.push_back(at);
      }
    }
  }
  return out;
}

/// The tetrahedra of a shortest way from the first group inside to another one.
std::vector<std::uint32_t> Carver::bridge(std::uint32_t v, const Groups& groups) const {
  std::uint32_t from = 0;
  while (groups.outside[from] != 0) ++from;
  std::vector<std::size_t> reached, parent(groups.round.size(), kNone);
  std::vector<char> seen(groups.round.size(), 0);
  for (std::size_t k = 0; k < groups.round.size(); ++k)
    if (groups.group[k] == from) {
      reached.push_back(k);
      seen[k] = 1;
    }
  for (std::size_t r = 0; r < reached.size(); ++r) {
    const std::size_t k = reached[r];
    const Delaunay::Cell& cell = delaunay_.cell(groups.round[k]);
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (cell.vertex[i] == v || cell.next[i] == kNone) continue;
      const std::size_t at = groups.place_of(cell.next[i]);
      if (seen[at] != 0) continue;
      seen[at] = 1;
      parent[at] = k;
      if (groups.outside[groups.group[at]] == 0) {
        std::vector<std::uint32_t> way;
        for (std::size_t b = k; groups.group[b] != from; b = parent[b])
          way.push_back(groups.round[b]);
        return way;
      }
      reached.push_back(at);
    }
  }
  return {};
}

/// What is to be taken inside so that there is one group outside, or a group inside fewer.
std::vector<std::uint32_t> Carver::filling(std::uint32_t v) const {
  const Groups groups = groups_round(v);
  if (groups.outer <= 1)
    return groups.inner > 1 && groups.outer > 0 ? bridge(v, groups) : std::vector<std::uint32_t>{};
  // All but the largest group outside is filled.
  std::uint32_t largest = kNone;
  for (std::uint32_t g = 0; g < groups.size.size(); ++g)
    if (groups.outside[g] != 0 && (largest == kNone || groups.size[g] > groups.size[largest]))
      largest = g;
  std::vector<std::uint32_t> fill;
  for (std::size_t k = 0; k < groups.round.size(); ++k)
    if (groups.outside[groups.group[k]] != 0 && groups.group[k] != largest)
      fill.push_back(groups.round[k]);
  return fill;
}

/// Splits edges at the vertex so that tetrahedra there reach no farther than half the ball's
/// radius: those that are to be taken inside are cut off from what is beyond.
/// @return whether any was
bool Carver::cut_off(std::uint32_t v, const std::vector<std::uint32_t>& cells) {
  const double most = 0.5 * options_.radius;
  std::vector<std::uint32_t> far;
  for (const std::uint32_t c : cells)
    for (const std::uint32_t w : delaunay_.cell(c).vertex)
      if (w != v && (delaunay_.point(w) - delaunay_.point(v)).norm() > 1.1 * most &&
          std::find(far.begin(), far.end(), w) == far.end())
        far.push_back(w);
  bool any = false;
  for (const std::uint32_t w : far) any |= split(v, w, most);
  return any;
}

/// Puts a vertex onto an edge, so far from its first end.
bool Carver::split(std::uint32_t from, std::uint32_t to, double distance) {
  const Vec3 &a = delaunay_.point(from), &b = delaunay_.point(to);
  Vec3 p = a + distance / (b - a).norm() * (b - a);
  if (options_.float32) p = geom::to_float32(p);
  std::vector<std::uint32_t> ring, made;
  delaunay_.cells_round(from, ring);
  std::erase_if(ring, [&](std::uint32_t c) { return !delaunay_.cell(c).has(to); });
  // Outside stays clear though the new vertex is not exactly on the edge.
  std::vector<Tetrahedron> changed;
  for (const std::uint32_t c : ring) {
    if (!info_[c].outside) continue;
    for (const std::uint32_t end : {from, to}) {
      Tetrahedron t{p, p, p, p};
      std::size_t k = 0;
      for (const std::uint32_t w : delaunay_.cell(c).vertex)
        if (w != end && k < 3) t[k++] = delaunay_.point(w);
      changed.push_back(t);
    }
  }
  if (!obstacle_.clear(changed)) return false;
  if (delaunay_.split(from, to, p, ring, made) == kNone) return false;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    if (made[k] >= info_.size()) info_.resize(std::size_t{2} * made[k] + 1);
    info_[made[k]] = {};
    info_[made[k]].outside = info_[ring[k]].outside;
  }
  ++splits_;
  return true;
}

/// Where the tetrahedra outside, or those inside, form several groups round a vertex, connected
/// through facets at it, some that are outside are taken inside.
void Carver::make_manifold() {
  const std::size_t carved = delaunay_.point_count();
  std::vector<std::uint32_t> waiting;
  std::vector<char> waits(delaunay_.point_count(), 0);
  const auto wait = [&](std::uint32_t v) {
    if (v >= waits.size()) waits.resize(2 * v, 0);
    if (waits[v] == 0) waiting.push_back(v);
    waits[v] = 1;
  };
  for (std::uint32_t c = 0; c < delaunay_.cell_count(); ++c) {
    if (delaunay_.cell(c).gone() || info_[c].outside) continue;
    for (std::uint32_t i = 0; i < 4; ++i)
      if (is_outside(delaunay_.cell(c).next[i]))
        for (const std::uint8_t k : Delaunay::kFacet[i]) wait(delaunay_.cell(c).vertex[k]);
  }
  std::reverse(waiting.begin(), waiting.end());
  while (!waiting.empty()) {
    const std::uint32_t v = waiting.back();
    waiting.pop_back();
    waits[v] = 0;
    if (v < 8) continue;  // corners of the box
    for (auto fill = filling(v); !fill.empty(); fill = filling(v)) {
      if (v < carved && splits_ < 4 * carved && cut_off(v, fill)) continue;
      for (const std::uint32_t c : fill) {
        info_[c].outside = false;
        for (const std::uint32_t w : delaunay_.cell(c).vertex)
          if (w != v) wait(w);
      }
    }
  }
}

geom::Mesh Carver::boundary() const {
  geom::Mesh mesh;
  std::vector<std::uint32_t> number(delaunay_.point_count(), kNone);
  for (std::uint32_t c = 0; c < delaunay_.cell_count(); ++c) {
    const Delaunay::Cell& cell = delaunay_.cell(c);
    if (cell.gone() || info_[c].outside) continue;
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (!is_outside(cell.next[i])) continue;
      geom::Triangle t{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = cell.vertex[Delaunay::kFacet[i][k]];
        if (number[v] == kNone) {
          number[v] = static_cast<std::uint32_t>(mesh.vertices.size());
          mesh.vertices.push_back(delaunay_.point(v));
        }
        t[k] = number[v];
      }
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

}  // namespace

void throw_too_fine(std::size_t most) {
  throw Error(ErrorCode::LimitReached, "a wrap so fine needs more than " + std::to_string(most) +
                                           " points; seal larger gaps");
}

Carving carve(const geom::Mesh& input, const Obstacle& obstacle, const CarvingOptions& options) {
  Carver carver(input, obstacle, options);
  carver.run();
  carver.make_manifold();
  return {carver.boundary(), carver.points()};
}

}  // namespace kaboum::wrap
