// Lower bounds of distances from all that links sweep, joint by joint. docs/algorithms/pairs.md.

#include "swept.h"

#include <kaboum/base/parallel.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <queue>

#include "numbers.h"

namespace kaboum::pairs::detail {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kMostCubes = 20'000;  ///< that a distance of two sets is searched in
constexpr std::size_t kMoreCubes = 500;     ///< after the sets are known to be apart

Transform inverse(const Transform& t) {
  const Eigen::Matrix3d back = t.linear.transpose();
  return {back, -(back * t.translation)};
}

/// A rotation that turns the axis, of length 1, to z. A quaternion between the two would not be one
/// next to -z.
Eigen::Matrix3d upright(const Vec3& axis) {
  const Vec3 first = axis.unitOrthogonal();
  Eigen::Matrix3d out;
  out.row(0) = first;
  out.row(1) = axis.cross(first);
  out.row(2) = axis;
  return out;
}

/// The values of a joint, those of its variable's limits. Without limits a turn, or nullopt of what
/// slides.
std::optional<std::pair<double, double>> values_of(const robot::Robot& robot,
                                                   const robot::Joint& joint) {
  const robot::Variable& variable = robot.variables[joint.variable];
  if (joint.multiplier == 0) return std::pair(joint.offset, joint.offset);
  if (!variable.lower || !variable.upper) {
    if (joint.type == robot::JointType::Prismatic) return std::nullopt;
    return std::pair(-4.0, 4.0);
  }
  const double x = joint.multiplier * *variable.lower + joint.offset,
               y = joint.multiplier * *variable.upper + joint.offset;
  const double more = kRounding * (1 + std::abs(x) + std::abs(y));
  return std::pair(std::min(x, y) - more, std::max(x, y) + more);
}

/// Of a point between two others whose distances are no less than that, half their distance from
/// each other from the middle.
double between_nodes(double least, double half) {
  return std::sqrt(std::max(0.0, least * least * (1 - kRounding) - half * half * (1 + kRounding)));
}

/// A little less, as far as rounding goes.
float below(double value) {
  constexpr double kMost = 0.5 * std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, 0.0, kMost) * (1 - 0x1p-22));
}

/// A lower bound of the distance of a point between two others, a share of the way from the first.
/// Squares of distances from a set, less those from a point, are concave.
double between_two(double u, double v, double share, double length) {
  return std::sqrt(std::max(0.0, ((1 - share) * u * u + share * v * v) * (1 - kRounding) -
                                     share * (1 - share) * length * length * (1 + kRounding)));
}

/// The same for points of an arc, by the nearest ones of its chord.
class Arc {
 public:
  /// @param angle  of the arc, less than half a turn
  Arc(double radius, double angle)
      : radius_(radius),
        length_(2 * radius * std::sin(0.5 * angle)),
        middle_(std::cos(0.5 * angle)) {}
  /// A place on arcs of some angle: the point of the chord in its direction, and how far that is,
  /// of a radius of 1.
  struct Place {
    double along, below;
    Place(double angle, double share) {
      const double aside = (share - 0.5) * angle;
      along = std::clamp(0.5 * (1 + std::tan(aside) / std::tan(0.5 * angle)), 0.0, 1.0);
      below = 1 - std::cos(0.5 * angle) / std::cos(aside);
    }
  };
  [[nodiscard]] double bound(double u, double v, const Place& place) const {
    return between_two(u, v, place.along, length_) - radius_ * place.below * (1 + kRounding);
  }
  /// Of all points between two of which the lesser bound is known.
  [[nodiscard]] double bound_all(double least) const {
    return between_nodes(least, 0.5 * length_) - radius_ * (1 - middle_) * (1 + kRounding);
  }

 private:
  double radius_, length_, middle_;
};

/// The places between the ends of arcs of so many equal parts, for any number of them.
class ArcPlaces {
 public:
  explicit ArcPlaces(double part) : part_(part) {}
  const std::vector<Arc::Place>& of(std::size_t parts) {
    if (known_.size() <= parts) known_.resize(parts + 1);
    std::vector<Arc::Place>& out = known_[parts];
    for (std::size_t m = out.size(); m < parts; ++m)
      out.emplace_back(static_cast<double>(parts) * part_,
                       static_cast<double>(m) / static_cast<double>(parts));
    return out;
  }

 private:
  double part_;
  std::vector<std::vector<Arc::Place>> known_;
};

/// The least of values[i + t] for each i and all t from low to high; indices are cyclic, or else
/// those beyond the ends are the ends.
/// @param between_at  of a share: what tells the value between two neighbours u and v
template <typename Between>
void least_of_shifts(std::vector<float>& values, double low, double high, bool cyclic,
                     const Between& between_at) {
  const auto n = static_cast<std::ptrdiff_t>(values.size());
  low -= 1e-9;
  high += 1e-9;
  // Numbers that no index can be.
  const bool all = !(std::max(std::abs(low), std::abs(high)) < 1e9) ||
                   (cyclic && high - low >= static_cast<double>(n) + 1);
  if (all) {
    std::ranges::fill(values, *std::ranges::min_element(values));
    return;
  }
  const auto first = static_cast<std::ptrdiff_t>(std::ceil(low)),
             last = static_cast<std::ptrdiff_t>(std::floor(high));
  const auto value = [&](std::ptrdiff_t i) {
    return values[cyclic ? ((i % n) + n) % n : std::clamp<std::ptrdiff_t>(i, 0, n - 1)];
  };
  std::vector<float> out(values.size(), std::numeric_limits<float>::infinity());
  for (const double end : {low, high}) {
    const auto before = static_cast<std::ptrdiff_t>(std::floor(end));
    const auto between = between_at(end - std::floor(end));
    for (std::ptrdiff_t i = 0; i < n; ++i)
      out[i] = std::min(out[i], below(between(value(i + before), value(i + before + 1))));
  }
  // Of each window the least one, and those behind it that are the least of what follows.
  if (last >= first) {
    std::vector<std::ptrdiff_t> waiting(static_cast<std::size_t>(n + last - first + 1));
    std::size_t head = 0, tail = 0;
    for (std::ptrdiff_t i = first; i < n + last; ++i) {
      while (tail > head && value(waiting[tail - 1]) >= value(i)) --tail;
      waiting[tail++] = i;
      const std::ptrdiff_t at = i - last;
      if (at < 0) continue;
      while (waiting[head] < at + first) ++head;
      out[at] = std::min(out[at], value(waiting[head]));
    }
  }
  values = std::move(out);
}

}  // namespace

double Swept::Grid::half_cell(std::size_t ring_of) const {
  const double r = static_cast<double>(ring_of) * ring;
  return (1 + kRounding) * 0.5 *
         std::sqrt(ring * ring + rise * rise + r * (r + 0.5 * ring) * turn * turn);
}

double Swept::Grid::distance(const Vec3& p) const {
  // From outside of a convex set that holds S, |x − s|² ≥ |x − c|² + |c − s|² with c nearest to x.
  const double r = std::hypot(p.x(), p.y());
  const double inner_r = std::min(r, radius), inner_z = std::clamp(p.z(), bottom, top);
  const double out = std::hypot(r - inner_r, p.z() - inner_z);
  // The point is a mean of the corners of a prism, whose sides are chords of the rings.
  const double turned = (std::atan2(p.y(), p.x()) + kPi) / turn;
  const double before = std::max(0.0, std::floor(turned));
  const double aside = (turned - before - 0.5) * turn;
  const double x = inner_r * std::cos(aside) / (std::cos(0.5 * turn) * ring),
               z = (inner_z - floor) / rise;
  const double part_t = std::clamp(0.5 * (1 + std::tan(aside) / std::tan(0.5 * turn)), 0.0, 1.0);
  const auto i = static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(rings - 2)));
  const auto j = static_cast<std::size_t>(std::clamp(z, 0.0, static_cast<double>(rises - 2)));
  const auto m = static_cast<std::size_t>(before) % turns, next = (m + 1) % turns;
  const double part_x = std::clamp(x - static_cast<double>(i), 0.0, 1.0),
               part_z = std::clamp(z - static_cast<double>(j), 0.0, 1.0);
  const double chord = 2 * std::sin(0.5 * turn) * ring;
  double mean = 0,
         apart = part_x * (1 - part_x) * ring * ring + part_z * (1 - part_z) * rise * rise;
  for (std::size_t a = i; a < i + 2; ++a) {
    const double weight_a = a == i ? 1 - part_x : part_x;
    const double across = chord * static_cast<double>(a);
    apart += weight_a * part_t * (1 - part_t) * across * across;
    for (std::size_t b = j; b < j + 2; ++b) {
      const double weight = weight_a * (b == j ? 1 - part_z : part_z);
      const float* row = values.data() + at(a, b);
      const double u = row[m], v = row[next];
      mean += weight * ((1 - part_t) * u * u + part_t * v * v);
    }
  }
  return std::sqrt(std::max(0.0, mean * (1 - kRounding) - apart * (1 + kRounding)) + out * out);
}

void Swept::Grid::choose_steps(double low, double high, std::size_t most_nodes, double least) {
  const double r = std::max(radius, least), height = std::max(high - low, least);
  double step = std::cbrt(2 * kPi * r * r * height / static_cast<double>(most_nodes));
  const auto count = [](double length, double s) {
    return static_cast<std::size_t>(std::clamp(std::ceil(length / s), 1.0, 1e6)) + 1;
  };
  for (;; step *= 1.1) {
    rings = count(r, step);
    rises = count(height, step);
    turns = std::max<std::size_t>(12, count(2 * kPi * r, step));
    if (rings * rises * turns <= 2 * most_nodes) break;
  }
  rise = height / static_cast<double>(rises - 1);
  turn = 2 * kPi / static_cast<double>(turns);
  // The chords of the outermost ring are outside of the cylinder.
  ring = r / (std::cos(0.5 * turn) * static_cast<double>(rings - 1)) * (1 + kRounding);
  floor = low;
}

void Swept::Grid::sweep_turns(double from, double to) {
  std::vector<float> row(turns);
  for (std::size_t a = 0; a < rings; ++a) {
    const Arc arc(static_cast<double>(a) * ring, turn);
    for (std::size_t b = 0; b < rises; ++b) {
      float* at_row = values.data() + at(a, b);
      row.assign(at_row, at_row + turns);
      least_of_shifts(row, -to / turn, -from / turn, true, [&](double share) {
        return [&arc, place = Arc::Place(turn, share)](double u, double v) {
          return arc.bound(u, v, place);
        };
      });
      for (std::size_t m = 0; m < turns; ++m) at_row[m] = below(arc.bound_all(row[m]));
    }
  }
}

void Swept::Grid::sweep_rises(double from, double to) {
  std::vector<float> row(rises);
  for (std::size_t a = 0; a < rings; ++a)
    for (std::size_t m = 0; m < turns; ++m) {
      for (std::size_t b = 0; b < rises; ++b) row[b] = values[at(a, b) + m];
      least_of_shifts(row, -to / rise, -from / rise, false, [&](double share) {
        return [this, share](double u, double v) { return between_two(u, v, share, rise); };
      });
      for (std::size_t b = 0; b < rises; ++b)
        values[at(a, b) + m] = below(between_nodes(row[b], 0.5 * rise));
    }
}

Swept::Swept(const Surface& surface)
    : mesh_(surface.query()), surface_(&surface), extent_(surface.tree().extent()) {}

double Swept::distance(const Vec3& point) const {
  const Vec3 p = to_grid_ * point;
  const double found = mesh_ ? mesh_->nearest(p).lower : grid_->distance(p);
  return found - kRounding * (extent_ + point.norm());
}

Swept::Ball Swept::ball() const {
  const Transform back = inverse(to_grid_);
  if (mesh_) {
    const Cluster& root = surface_->tree()[0];
    return {back * root.center, root.reach + kRounding * extent_};
  }
  const double half = 0.5 * (grid_->top - grid_->bottom);
  return {back * Vec3(0, 0, 0.5 * (grid_->top + grid_->bottom)),
          std::hypot(grid_->radius, half) + kRounding * extent_};
}

double Swept::finest() const {
  return mesh_ ? 1e-3 * surface_->tree()[0].reach : 0.1 * std::max(grid_->ring, grid_->rise);
}

void Swept::bound(const Transform& to_frame, Grid& out) const {
  out.radius = 0;
  out.bottom = kInfinite;
  out.top = -kInfinite;
  const auto add = [&](const Vec3& p, double about) {
    out.radius = std::max(out.radius, std::hypot(p.x(), p.y()) + about);
    out.bottom = std::min(out.bottom, p.z() - about);
    out.top = std::max(out.top, p.z() + about);
  };
  const double rounding = kRounding * extent_;
  if (mesh_) {
    const Transform place = to_frame * inverse(to_grid_);
    for (const std::uint32_t v : surface_->corners())
      add(place * surface_->mesh().vertices[v], rounding);
    return;
  }
  // Every point of the set is in half a cell of a node, whose bound then is no more than that.
  const Transform place = to_frame * inverse(to_grid_);
  for (std::size_t a = 0; a < grid_->rings; ++a) {
    const double half = grid_->half_cell(a);
    for (std::size_t b = 0; b < grid_->rises; ++b)
      for (std::size_t m = 0; m < grid_->turns; ++m) {
        if (grid_->values[grid_->at(a, b) + m] > half) continue;
        const double r = static_cast<double>(a) * grid_->ring,
                     t = static_cast<double>(m) * grid_->turn - kPi;
        add(place * Vec3(r * std::cos(t), r * std::sin(t),
                         grid_->floor + static_cast<double>(b) * grid_->rise),
            half + rounding);
      }
  }
}

bool Swept::fill(const Transform& from_frame, Grid& out, const std::function<bool()>& stop) const {
  out.values.resize(out.rings * out.rises * out.turns);
  std::vector<double> row(out.turns + 1);
  std::vector<std::pair<double, double>> ways;  // to each node of a ring of radius 1
  for (std::size_t m = 0; m < out.turns; ++m) {
    const double t = static_cast<double>(m) * out.turn - kPi;
    ways.emplace_back(std::cos(t), std::sin(t));
  }
  ArcPlaces places(out.turn);
  for (std::size_t a = 0; a < out.rings; ++a)
    for (std::size_t b = 0; b < out.rises; ++b) {
      if (stop()) return false;
      const double r = static_cast<double>(a) * out.ring,
                   z = out.floor + static_cast<double>(b) * out.rise;
      const auto ask = [&](std::size_t m) {
        row[m] =
            std::max(0.0, distance(from_frame * Vec3(r * ways[m].first, r * ways[m].second, z)));
      };
      // Between two nodes of an arc that is short against the distances, these say enough.
      const auto between = [&](const auto& self, std::size_t i, std::size_t j) -> void {
        if (j - i < 2) return;
        const double angle = static_cast<double>(j - i) * out.turn;
        if (angle < 1 && r * angle < 0.4 * std::min(row[i], row[j])) {
          const Arc arc(r, angle);
          const std::vector<Arc::Place>& at = places.of(j - i);
          for (std::size_t m = i + 1; m < j; ++m)
            row[m] = std::max(0.0, arc.bound(row[i], row[j], at[m - i]));
          return;
        }
        const std::size_t middle = i + (j - i) / 2;
        ask(middle);
        self(self, i, middle);
        self(self, middle, j);
      };
      ask(0);
      row[out.turns] = row[0];
      between(between, 0, out.turns);
      for (std::size_t m = 0; m < out.turns; ++m) out.values[out.at(a, b) + m] = below(row[m]);
    }
  return true;
}

std::optional<Swept> Swept::above(const robot::Robot& robot, const robot::Joint& joint,
                                  std::size_t most_nodes, const std::function<bool()>& stop) const {
  Swept out = *this;
  out.extent_ += joint.origin.translation.norm();
  if (joint.type == robot::JointType::Fixed) {
    out.to_grid_ = to_grid_ * inverse(joint.origin);
    return out;
  }
  const auto values = values_of(robot, joint);
  if (!values) return std::nullopt;
  const auto [from, to] = *values;
  const bool slides = joint.type == robot::JointType::Prismatic;
  if (slides) out.extent_ += std::max(std::abs(from), std::abs(to));
  const Transform turned{upright(joint.axis), Vec3::Zero()};
  auto grid = std::make_shared<Grid>();
  bound(turned, *grid);
  if (!(grid->bottom <= grid->top)) return std::nullopt;
  const double low = grid->bottom + (slides ? std::min(0.0, from) : 0),
               high = grid->top + (slides ? std::max(0.0, to) : 0);
  grid->choose_steps(low, high, most_nodes, 1e-4 * extent_);
  if (!fill(inverse(turned), *grid, stop)) return std::nullopt;
  if (slides) {
    grid->sweep_rises(from, to);
    grid->bottom += from;
    grid->top += to;
  } else {
    grid->sweep_turns(from, to);
  }
  out.mesh_.reset();
  out.grid_ = std::move(grid);
  out.to_grid_ = turned * inverse(joint.origin);
  return out;
}

std::optional<double> between(const Swept& first, const Swept& second,
                              const std::function<bool()>& stop) {
  const bool swapped = second.ball().radius < first.ball().radius;
  const Swept &a = swapped ? second : first, &b = swapped ? first : second;
  // Points of a, in cubes; the least bound of the distance from b of any of them.
  struct Cube {
    double bound;
    Vec3 center;
    double half;
    bool operator<(const Cube& o) const { return bound > o.bound; }
  };
  std::priority_queue<Cube> cubes;
  std::size_t looked = 0;
  double proved = kInfinite;  // of cubes that are too small to be cut
  const auto look = [&](const Vec3& center, double half) {
    ++looked;
    const double about = half * std::sqrt(3.0) * (1 + kRounding);
    if (a.distance(center) > about) return;
    cubes.push({b.distance(center) - about, center, half});
  };
  const Swept::Ball ball = a.ball();
  look(ball.center, ball.radius);
  const double finest = std::min(a.finest(), b.finest());
  for (std::size_t more = 0; !cubes.empty() && looked < kMostCubes;) {
    const Cube top = cubes.top();
    if (top.bound > 0 && ++more > kMoreCubes) break;
    if (top.bound >= proved) break;
    if (looked % 256 < 8 && stop()) return std::nullopt;
    if (top.half < finest) {
      if (top.bound <= 0) return std::nullopt;
      proved = std::min(proved, top.bound);
      cubes.pop();
      continue;
    }
    cubes.pop();
    const double half = 0.5 * top.half * (1 + kRounding);
    for (unsigned corner = 0; corner < 8; ++corner) {
      const Vec3 side((corner & 1U) != 0 ? 1 : -1, (corner & 2U) != 0 ? 1 : -1,
                      (corner & 4U) != 0 ? 1 : -1);
      look(top.center + 0.5 * top.half * side, half);
    }
  }
  if (!cubes.empty()) proved = std::min(proved, cubes.top().bound);
  // A set has points: that no cube holds one says that a number was too large.
  if (!(proved > 0) || proved == kInfinite) return std::nullopt;
  return proved;
}

std::vector<double> apart_by_sweeping(const robot::Robot& robot,
                                      const std::vector<std::uint32_t>& links,
                                      const std::vector<const Surface*>& surfaces,
                                      const std::vector<PairOfSurfaces>& pairs,
                                      std::size_t most_nodes, const std::function<bool()>& stop) {
  const auto none = static_cast<std::uint32_t>(robot.links.size());
  // Of each link, the pairs that have it as the last one that both hang from; of each surface, how
  // far up it is asked for.
  std::vector<std::vector<std::size_t>> at(robot.links.size());
  std::vector<std::uint32_t> highest(surfaces.size(), none);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto [a, b] = pairs[i];
    std::uint32_t x = links[a], y = links[b];
    while (x != y) {
      std::uint32_t& later = x > y ? x : y;
      later = robot.joints[later - 1].parent;
    }
    at[x].push_back(i);
    for (const std::size_t s : {a, b}) highest[s] = std::min(highest[s], x);
  }
  struct Member {
    std::size_t surface;
    std::optional<Swept> swept;
  };
  std::vector<std::vector<Member>> members(robot.links.size());
  for (std::size_t s = 0; s < surfaces.size(); ++s)
    if (highest[s] != none && surfaces[s] != nullptr)
      members[links[s]].push_back({s, std::nullopt});
  std::vector<double> out(pairs.size(), 0);
  // Children come after their parents.
  for (std::size_t l = robot.links.size(); l-- > 0;) {
    std::vector<Member> here = std::move(members[l]);
    parallel_for(std::size_t{0}, here.size(),
                 [&](std::size_t i) {
                   if (!here[i].swept && !stop()) here[i].swept.emplace(*surfaces[here[i].surface]);
                 },
                 {.alone = true});
    std::map<std::size_t, const Swept*> of;
    for (const Member& member : here)
      if (member.swept) of[member.surface] = &*member.swept;
    parallel_for(std::size_t{0}, at[l].size(),
                 [&](std::size_t i) {
                   const auto [a, b] = pairs[at[l][i]];
                   if (stop() || !of.contains(a) || !of.contains(b)) return;
                   out[at[l][i]] = between(*of.at(a), *of.at(b), stop).value_or(0);
                 },
                 {.alone = true});
    if (l == 0) break;
    std::erase_if(
        here, [&](const Member& member) { return !member.swept || highest[member.surface] == l; });
    parallel_for(std::size_t{0}, here.size(),
                 [&](std::size_t i) {
                   here[i].swept =
                       stop() ? std::nullopt
                              : here[i].swept->above(robot, robot.joints[l - 1], most_nodes, stop);
                 },
                 {.alone = true});
    for (Member& member : here)
      if (member.swept) members[robot.joints[l - 1].parent].push_back(std::move(member));
  }
  return out;
}

}  // namespace kaboum::pairs::detail
