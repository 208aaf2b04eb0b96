// The checker of decimation logs. It is kept apart from the decimation on purpose: nothing here may
// use its predicates, its adjacency or its preparation.
#include <kaboum/base/error.h>
#include <kaboum/verify/replay.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "replay_fill.h"
#include "replay_solid.h"

namespace kaboum::verify {
namespace {

using bmesh::Direction;
using bmesh::Log;
using bmesh::Progressive;
using bmesh::Step;

using Point = ReplaySolid::Point;
using Corners = ReplaySolid::Corners;

std::string at_step(std::size_t i) { return "step " + std::to_string(i); }

bool repeated(const Corners& c) { return c[0] == c[1] || c[1] == c[2] || c[0] == c[2]; }

/// The same oriented triangle, beginning with its smallest corner.
template <class T>
std::array<T, 3> rotated(std::array<T, 3> c) {
  std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
  return c;
}

/// Surplus of forward over backward runs, edge by edge.
using EdgeBalance = std::map<std::pair<std::uint32_t, std::uint32_t>, std::int64_t>;

void add_edges(const Corners& c, EdgeBalance& balance) {
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t a = c[k], b = c[(k + 1) % 3];
    if (a != b) balance[std::minmax(a, b)] += a < b ? 1 : -1;
  }
}

class Replay {
 public:
  Replay(const geom::Mesh& original, const Log& log, const ReplayProgress& progress)
      : log_(log), progress_(progress) {
    if (original.triangles.size() >= (1ULL << 31))
      throw Error(ErrorCode::InvalidInput, "too many triangles to replay");
    merge_vertices(original);
  }

  ReplayResult run(const geom::Mesh& result) {
    if (!start() || !play_to(log_.steps.size()) || !has_area() || !same_as(result)) return report_;
    return verified();
  }

  ReplayResult run(const Progressive& p) {
    if (!start() || !is_base(p.base)) return report_;
    for (std::size_t i = 0; i < p.levels.size(); ++i) {
      if (!play_to(p.levels[i].steps) || !has_area() || !is_level(p.levels[i], i)) return report_;
      keep_present();
      ++report_.levels;
    }
    if (!play_to(log_.steps.size()) || !has_area()) return report_;
    return verified();
  }

 private:
  bool start() {
    report_.dropped = log_.dropped.size();
    report_.reversed = log_.reversed.size();
    if (!interpret()) return false;
    if (!has_area()) return false;
    find_border();
    if (report_.filled != 0 && !report_.closed)
      return violated("the triangles that fill holes leave the mesh open");
    keep_present();
    return true;
  }

  bool play_to(std::size_t steps) {
    for (; report_.steps < steps; ++report_.steps) {
      if (progress_ && report_.steps % 64 == 0)
        progress_(at_step(report_.steps) + " of " + std::to_string(log_.steps.size()));
      if (!step(report_.steps)) return false;
    }
    return true;
  }

  /// Of nothing nothing is verified.
  bool has_area() {
    const auto flat = [&](const Corners& c) {
      return repeated(c) || CGAL::collinear(points_[c[0]], points_[c[1]], points_[c[2]]);
    };
    return log_.direction == bmesh::Direction::Any || !std::ranges::all_of(triangles_, flat) ||
           violated("after " + std::to_string(report_.steps) +
                    " steps no triangle with an area is left, of which something could be claimed");
  }

  ReplayResult verified() {
    report_.verified = true;
    count_predicates();
    return report_;
  }

  void count_predicates() {
    if (solid_) report_.predicates += solid_->predicates();
  }

  /// The mesh of this moment is what later steps must keep.
  void keep_present() {
    count_predicates();
    solid_.reset();
    original_points_ = points_;
    original_triangles_.clear();
    for (const Corners& c : triangles_)
      if (!repeated(c)) original_triangles_.push_back(c);
  }

  /// Whether the base is the original as interpreted: numbering and orientation of triangles, and
  /// coordinates, but for the sign of zero.
  bool is_base(const geom::Mesh& base) {
    bool same =
        base.vertices.size() == points_.size() && base.triangles.size() == triangles_.size();
    for (std::size_t v = 0; same && v < points_.size(); ++v)
      same = base.vertices[v] == geom::Vec3(points_[v].x(), points_[v].y(), points_[v].z());
    for (std::size_t t = 0; same && t < triangles_.size(); ++t)
      same = rotated(Corners(base.triangles[t])) == rotated(triangles_[t]);
    return same || violated("the base mesh is not that of the original");
  }

  bool is_level(const Progressive::Level& level, std::size_t i) {
    std::size_t vertices = 0;
    for (const auto& around : around_) vertices += around.empty() ? 0 : 1;
    return vertices == level.vertices ||
           violated("level " + std::to_string(i) + " has " + std::to_string(vertices) +
                    " vertices instead of " + std::to_string(level.vertices));
  }

  bool violated(const std::string& what) {
    report_.violation = what;
    return false;
  }

  /// Equal coordinates become one point of all_points_; triangles refer to those.
  void merge_vertices(const geom::Mesh& original) {
    for (const geom::Triangle& t : original.triangles) {
      Corners c;
      for (int k = 0; k < 3; ++k) {
        c[k] = point_at(original.vertices.at(t[k]));
      }
      input_.push_back(c);
    }
  }

  /// The index of p in all_points_; added if it is not there.
  std::uint32_t point_at(const geom::Vec3& p) {
    const auto [it, fresh] = known_.try_emplace({p.x() + 0.0, p.y() + 0.0, p.z() + 0.0},
                                                static_cast<std::uint32_t>(all_points_.size()));
    if (fresh) all_points_.emplace_back(p.x(), p.y(), p.z());
    return it->second;
  }

  /// Numbers the vertices of the triangles left by first use, as the input has them; applies the
  /// log's turns; checks its drops; fills its holes.
  bool interpret() {
    std::vector<char> dropped(input_.size(), 0);
    for (const std::uint32_t t : log_.dropped) {
      require_triangle(t);
      dropped[t] = 1;
    }
    std::vector<std::uint32_t> number(all_points_.size(), ~0U);
    for (std::size_t t = 0; t < input_.size(); ++t) {
      if (dropped[t] != 0) continue;
      if (repeated(input_[t]))
        return violated("input triangle " + std::to_string(t) + " has a repeated corner");
      for (const std::uint32_t v : input_[t]) {
        if (number[v] != ~0U) continue;
        number[v] = static_cast<std::uint32_t>(points_.size());
        points_.push_back(all_points_[v]);
      }
    }
    const std::vector<std::vector<std::uint32_t>> rims = rims_of_log();
    for (const std::uint32_t t : log_.reversed) {
      require_triangle(t);
      turn(input_[t]);
    }
    if (!drops_are_harmless(dropped)) return false;
    std::vector<Corners> fill;
    if (!fill_holes(rims, fill)) return false;
    known_.clear();
    number.resize(all_points_.size(), ~0U);
    for (std::size_t t = 0; t < input_.size(); ++t)
      if (dropped[t] == 0)
        triangles_.push_back({number[input_[t][0]], number[input_[t][1]], number[input_[t][2]]});
    const std::size_t first_fill = input_.size();
    for (std::size_t i = 0; i < fill.size(); ++i) {
      Corners c;
      for (int k = 0; k < 3; ++k) c[k] = numbered(fill[i][k], number);
      if (std::ranges::binary_search(log_.reversed_after_filling, first_fill + i)) turn(c);
      triangles_.push_back(c);
    }
    around_.resize(points_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      for (const std::uint32_t v : triangles_[t]) around_[v].push_back(t);
    return true;
  }

  static void turn(Corners& c) { std::swap(c[1], c[2]); }

  /// The number of a point of all_points_, given to it if it has none.
  std::uint32_t numbered(std::uint32_t v, std::vector<std::uint32_t>& number) {
    if (number[v] == ~0U) {
      number[v] = static_cast<std::uint32_t>(points_.size());
      points_.push_back(all_points_[v]);
    }
    return number[v];
  }

  /// Checks that the log's rims are those of holes of the triangles before the last turns, and that
  /// these turned closed chains; what fills the holes follows from the rims.
  /// @param fill  the triangles, before the last turns; they refer to all_points_.
  bool fill_holes(const std::vector<std::vector<std::uint32_t>>& rims, std::vector<Corners>& fill) {
    if (rims.empty() && log_.reversed_after_filling.empty()) return true;
    std::vector<Corners> before = input_;
    if (!std::ranges::is_sorted(log_.reversed_after_filling, std::ranges::less_equal{}))
      throw Error(ErrorCode::InvalidInput, "the log's turned triangles are not ascending");
    for (const std::uint32_t t : log_.reversed_after_filling)
      if (t < before.size()) turn(before[t]);
    std::erase_if(before, repeated);
    if (const std::string wrong = find_wrong_rim(before, rims); !wrong.empty())
      return violated(wrong);
    for (const auto& rim : rims) add_fan(rim, fill);
    report_.filled = fill.size();

    EdgeBalance balance;
    for (const std::uint32_t t : log_.reversed_after_filling) {
      if (t >= input_.size() + fill.size())
        return violated("a triangle turned after filling holes is not there");
      add_edges(t < input_.size() ? input_[t] : reversed(fill[t - input_.size()]), balance);
    }
    for (const auto& [edge, surplus] : balance)
      if (surplus != 0)
        return violated("the triangles turned after filling holes are no closed chain");
    return true;
  }

  static Corners reversed(Corners c) {
    turn(c);
    return c;
  }

  /// As points of all_points_. @pre no triangle is turned yet.
  std::vector<std::vector<std::uint32_t>> rims_of_log() const {
    std::vector<std::vector<std::uint32_t>> rims;
    for (const auto& named : log_.rims) {
      auto& rim = rims.emplace_back();
      for (const std::uint32_t corner : named) {
        require_triangle(corner / 3);
        rim.push_back(input_[corner / 3][corner % 3]);
      }
    }
    return rims;
  }

  /// One triangle, or a fan from the mean; triangles with repeated corners are left out.
  void add_fan(const std::vector<std::uint32_t>& rim, std::vector<Corners>& fill) {
    if (rim.size() == 3) {
      fill.push_back({rim[0], rim[1], rim[2]});
      return;
    }
    geom::Vec3 mean = geom::Vec3::Zero();
    for (const std::uint32_t v : rim) {
      const Point& p = all_points_[v];
      mean += geom::Vec3(p.x(), p.y(), p.z()) / static_cast<double>(rim.size());
    }
    const std::uint32_t tip = point_at(mean);
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const Corners c{rim[i], rim[(i + 1) % rim.size()], tip};
      if (!repeated(c)) fill.push_back(c);
    }
  }

  void require_triangle(std::uint32_t t) const {
    if (t >= input_.size())
      throw Error(ErrorCode::InvalidInput, "the log refers to input triangle " + std::to_string(t) +
                                               ", but there are only " +
                                               std::to_string(input_.size()));
  }

  /// Dropped triangles have repeated corners, or their sum is a closed chain made of opposite pairs
  /// and of copies of triangles that stay.
  bool drops_are_harmless(const std::vector<char>& dropped) {
    std::map<Corners, std::int64_t> kept, gone;
    for (std::size_t t = 0; t < input_.size(); ++t)
      if (!repeated(input_[t])) ++(dropped[t] != 0 ? gone : kept)[rotated(input_[t])];
    EdgeBalance balance;
    for (const auto& [c, n] : gone) {
      const auto opposite = gone.find(rotated(Corners{c[0], c[2], c[1]}));
      const std::int64_t copies = n - (opposite == gone.end() ? 0 : opposite->second);
      if (copies <= 0) continue;
      if (!kept.contains(c))
        return violated(
            "a triangle is dropped that neither cancels nor is a copy of one that stays");
      for (std::int64_t i = 0; i < copies; ++i) add_edges(c, balance);
    }
    for (const auto& [edge, surplus] : balance)
      if (surplus != 0) return violated("the copies dropped are no closed chain");
    return true;
  }

  void find_border() {
    EdgeBalance balance;
    for (const Corners& c : triangles_) add_edges(c, balance);
    border_.assign(points_.size(), 0);
    report_.closed = true;
    for (const auto& [edge, surplus] : balance) {
      if (surplus == 0) continue;
      border_[edge.first] = border_[edge.second] = 1;
      report_.closed = false;
    }
  }

  /// Exact: what lies between triangle c and the point `to` may be added (outer) or taken away
  /// (inner), or has nothing to do with the solid that must be kept.
  bool harmless(const Corners& c, const Point& to) {
    const CGAL::Sign wrong = log_.direction == Direction::Outer ? CGAL::NEGATIVE : CGAL::POSITIVE;
    const Point &p = points_[c[0]], &q = points_[c[1]], &r = points_[c[2]];
    ++report_.predicates;
    if (CGAL::orientation(p, q, r, to) != wrong) return true;
    if (!report_.closed) return false;
    if (!solid_) solid_.emplace(original_points_, original_triangles_);
    ++report_.against_original;
    return solid_->contains({p, q, r, to}, log_.direction == Direction::Inner);
  }

  bool flip(std::size_t i) {
    const Step& s = log_.steps[i];
    for (const std::uint32_t v : {s.kept, s.gone, s.left, s.right})
      if (v >= points_.size())
        throw Error(ErrorCode::InvalidInput,
                    at_step(i) + " of the log refers to a vertex that is not there");
    const auto find = [&](const Corners& requested) {
      for (const std::uint32_t t : around_[s.kept])
        if (rotated(triangles_[t]) == rotated(requested)) return t;
      return ~0U;
    };
    const std::uint32_t first = find({s.kept, s.gone, s.left}),
                        second = find({s.gone, s.kept, s.right});
    if (first == ~0U || second == ~0U || s.left == s.right)
      return violated(at_step(i) + " flips an edge that is not there");
    if (log_.direction != Direction::Any && !harmless(triangles_[first], points_[s.right]))
      return violated(at_step(i) + " flips an edge through what must be kept");
    triangles_[first] = {s.right, s.left, s.kept};
    triangles_[second] = {s.left, s.right, s.gone};
    std::erase(around_[s.gone], first);
    std::erase(around_[s.kept], second);
    around_[s.right].push_back(first);
    around_[s.left].push_back(second);
    return true;
  }

  bool step(std::size_t i) {
    const Step& s = log_.steps[i];
    if (s.kind == Step::Kind::Flip) return flip(i);
    if (s.kept >= points_.size() || s.gone >= points_.size())
      throw Error(ErrorCode::InvalidInput,
                  at_step(i) + " of the log refers to a vertex that is not there");
    if (!s.position.allFinite()) return violated(at_step(i) + " moves a vertex to no finite place");
    const Point to(s.position.x(), s.position.y(), s.position.z());
    for (const std::uint32_t v : {s.kept, s.gone})
      if (border_[v] != 0 && points_[v] != to)
        return violated(at_step(i) + " moves a border vertex");

    std::vector<std::uint32_t> star = around_[s.kept];
    if (s.gone != s.kept) star.insert(star.end(), around_[s.gone].begin(), around_[s.gone].end());
    std::sort(star.begin(), star.end());
    star.erase(std::unique(star.begin(), star.end()), star.end());
    if (star.empty()) return violated(at_step(i) + " moves a vertex without triangles");

    if (log_.direction != Direction::Any)
      for (const std::uint32_t t : star)
        if (!harmless(triangles_[t], to))
          return violated(at_step(i) + " moves to the wrong side of a triangle it replaces");

    points_[s.kept] = to;
    border_[s.kept] |= border_[s.gone];
    if (s.gone == s.kept) return true;
    std::vector<std::uint32_t> stay;
    for (const std::uint32_t t : star) {
      Corners& c = triangles_[t];
      std::replace(c.begin(), c.end(), s.gone, s.kept);
      if (!repeated(c)) {
        stay.push_back(t);
        continue;
      }
      for (const std::uint32_t v : c)
        if (v != s.kept) std::erase(around_[v], t);
    }
    around_[s.kept] = std::move(stay);
    around_[s.gone].clear();
    around_[s.gone].shrink_to_fit();
    return true;
  }

  /// Triangles as coordinates, without those that have two equal corners, sorted.
  using Coordinates = std::array<std::array<double, 3>, 3>;
  static void add_coordinates(const Coordinates& c, std::vector<Coordinates>& list) {
    if (c[0] != c[1] && c[1] != c[2] && c[0] != c[2]) list.push_back(rotated(c));
  }

  bool same_as(const geom::Mesh& result) {
    std::vector<Coordinates> mine, theirs;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const Corners& c = triangles_[t];
      if (repeated(c)) continue;
      Coordinates x;
      for (int k = 0; k < 3; ++k)
        x[k] = {points_[c[k]].x() + 0.0, points_[c[k]].y() + 0.0, points_[c[k]].z() + 0.0};
      add_coordinates(x, mine);
    }
    for (const geom::Triangle& t : result.triangles) {
      Coordinates x;
      for (int k = 0; k < 3; ++k) {
        const geom::Vec3& p = result.vertices.at(t[k]);
        x[k] = {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};
      }
      add_coordinates(x, theirs);
    }
    std::sort(mine.begin(), mine.end());
    std::sort(theirs.begin(), theirs.end());
    if (mine != theirs)
      return violated("the triangles that the log leads to are not those of the result");
    return true;
  }

  const Log& log_;
  const ReplayProgress& progress_;
  ReplayResult report_;
  std::map<std::array<double, 3>, std::uint32_t> known_;  // of all_points_, until holes are filled
  std::vector<Point> all_points_;
  std::vector<Corners> input_;
  std::vector<Point> points_;
  std::vector<Corners> triangles_;
  std::vector<std::vector<std::uint32_t>> around_;
  std::vector<char> border_;
  std::vector<Point> original_points_;
  std::vector<Corners> original_triangles_;
  std::optional<ReplaySolid> solid_;  // made when a step needs it
};

}  // namespace

ReplayResult replay(const geom::Mesh& original, const bmesh::Log& log, const geom::Mesh& result,
                    const ReplayProgress& progress) {
  return Replay(original, log, progress).run(result);
}

ReplayResult replay_progressive(const geom::Mesh& original, const bmesh::Progressive& progressive,
                                const ReplayProgress& progress) {
  return Replay(original, progressive.log, progress).run(progressive);
}

}  // namespace kaboum::verify
