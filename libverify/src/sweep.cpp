// Whether a set of convex bodies holds what moves: docs/algorithms/swept-volumes.md, "Checked from
// files alone".
#include <kaboum/base/error.h>
#include <kaboum/geom/inside_out.h>
#include <kaboum/verify/sweep.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>
#include <thread>
#include <utility>

#include "body_bounds.h"
#include "inside_out.h"
#include "parallel.h"
#include "rounding.h"
#include "swept_body.h"
#include "swept_cell.h"
#include "swept_inside.h"

namespace kaboum::verify {

using geom::Vec3;

namespace {

using Pose = Eigen::Matrix<double, 3, 4>;
using Waypoints = std::vector<std::vector<double>>;

constexpr std::size_t kCellsPerTask = 32;
constexpr int kMaxUncutHalvings = 16;

Vec3 apply(const Pose& pose, const Vec3& p) { return pose.leftCols<3>() * p + pose.col(3); }

std::vector<double> between(const std::vector<double>& a, const std::vector<double>& b, double s) {
  std::vector<double> q(a.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    q[i] = static_cast<double>(a[i] + s * (static_cast<long double>(b[i]) - a[i]));
  return q;
}

/// Part of a shape during a segment, and what was found.
struct Task {
  std::size_t shape = 0, segment = 0, first = 0, last = 0;  // cells of the shape
  std::size_t cells = 0, samples = 0, undecided_cells = 0;
  bool limited = false;
  std::optional<SweepPlace> refuting, undecided;
  SweepPlace farthest;
};

/// Part of a segment of the path.
struct Stretch {
  double begin, end;
};

/// Points whose hull the shape is within `bulge` of.
struct Outline {
  std::vector<Vec3> points;
  double bulge = 0;
};

Outline outline_of(const MovingShape& shape) {
  constexpr int kSides = 64;
  Outline out;
  const Vec3 half = 0.5 * shape.size;
  switch (shape.kind) {
    case MovingShape::Kind::Mesh: {
      std::vector<char> used(shape.mesh.vertices.size(), 0);
      for (const geom::Triangle& t : shape.mesh.triangles)
        for (const std::uint32_t v : t)
          if (std::exchange(used[v], 1) == 0) out.points.push_back(shape.mesh.vertices[v]);
      break;
    }
    case MovingShape::Kind::Box:
      for (unsigned i = 0; i < 8; ++i)
        out.points.emplace_back((i & 1U) != 0 ? half.x() : -half.x(),
                                (i & 2U) != 0 ? half.y() : -half.y(),
                                (i & 4U) != 0 ? half.z() : -half.z());
      break;
    case MovingShape::Kind::Cylinder: {
      const double radius = shape.size.x();
      for (int i = 0; i < kSides; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSides;
        for (const double z : {-half.y(), half.y()})
          out.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
      }
      // As of a patch of the surface: between neighbours the arc is within ℓ²/(3r) of the chord.
      const double edge = 2 * std::numbers::pi * radius / kSides;
      out.bulge = (edge * edge / (3 * radius) + 0x1p-48 * (radius + shape.size.y())) * kUp;
      break;
    }
    case MovingShape::Kind::Sphere:
      out.points.push_back(Vec3::Zero());
      out.bulge = shape.size.x();
      break;
  }
  return out;
}

/// Decides one task.
class Search {
 public:
  Search(Task& task, const MovingShape& shape, const Waypoints& path,
         const std::vector<SweptBody>& bodies, double margin, const SweepOptions& options)
      : task_(task),
        shape_(shape),
        from_(path[task.segment]),
        to_(path[std::min(task.segment + 1, path.size() - 1)]),
        bodies_(bodies),
        margin_(margin),
        options_(options),
        most_cells_(options.max_cells * (task.last - task.first)) {}

  void run(const std::vector<SweptCell>& cells, const std::vector<Stretch>& open) {
    double radius = 0;
    for (const SweptCell& c : cells) radius = std::max(radius, c.radius() + c.bulge());
    prepare(radius);
    const std::vector<std::uint32_t> all = all_bodies();
    for (const Stretch& s : open) {
      if (task_.refuting || task_.limited) return;
      stretch(s.begin, s.end, pose_at(s.begin), pose_at(moves_ ? s.end : s.begin), cells, all);
    }
  }

  /// Stretches during which no one body is known to hold the whole shape; in the others the claim
  /// holds.
  std::vector<Stretch> not_held_whole(const Outline& outline) {
    double radius = 0;
    for (const Vec3& p : outline.points) radius = std::max(radius, p.norm() * kUp);
    prepare(radius + outline.bulge);
    std::vector<Stretch> open;
    std::uint32_t body = 0;
    const Pose start = pose_at(0), finish = moves_ ? pose_at(1) : start;
    if (!bodies_.empty() && !outline.points.empty()) {
      as_one_cell(0, 1, start, finish, outline, all_bodies(), 0, body, open);
    } else {
      open.push_back({0, 1});
    }
    return open;
  }

 private:
  enum class Next { Held, HalveTime, HalveCurve, HalveFlat, Refuted, Undecided };

  void prepare(double radius) {
    bound_ = bound_motion(shape_.chain, from_, to_, radius);
    moves_ = bound_.speed > 0;
    task_.farthest.distance = -1;
  }

  [[nodiscard]] std::vector<std::uint32_t> all_bodies() const {
    std::vector<std::uint32_t> all(bodies_.size());
    std::iota(all.begin(), all.end(), 0U);
    return all;
  }

  /// The shape as one cell, halved in time only; where it is in one body at neither end, or the
  /// stretch is short, it is left to the cells.
  void as_one_cell(double begin, double end, const Pose& start, const Pose& finish,
                   const Outline& outline, const std::vector<std::uint32_t>& candidates,
                   int halvings, std::uint32_t& body, std::vector<Stretch>& open) {
    begin_ = begin;
    end_ = end;
    const std::size_t count = outline.points.size();
    std::vector<Vec3> places(2 * count);
    geom::Box3 box;
    for (std::size_t i = 0; i < count; ++i) {
      places[i] = apply(start, outline.points[i]);
      places[count + i] = apply(finish, outline.points[i]);
      box.extend(places[i]);
      box.extend(places[count + i]);
    }
    ++task_.cells;
    const std::vector<std::uint32_t> near = those_near(box, candidates);
    const std::span<const Vec3> both(places), at_start = both.first(count),
                                              at_end = both.last(count);
    const double length = end - begin;
    const double motion = moves_ ? length * length / 8 * bound_.acceleration * kUp : 0;
    const double still = margin_ - bound_.rounding - outline.bulge;
    if (holder(both, still - motion, body, near)) {
      // Part of a sphere is not at its centre: no place of it is sampled here.
      if (outline.points.size() > 1) {
        SweptCell cell;
        cell.body = body;
        sample(cell, at_start, begin, near);
        if (moves_) sample(cell, at_end, end, near);
        task_.farthest.triangle.clear();
      }
      return;
    }
    std::uint32_t first = body, last = body;
    const bool held = holder(at_start, still, first, near) || holder(at_end, still, last, near);
    if (!held || halvings == kMaxUncutHalvings || !(length * bound_.speed > options_.gap)) {
      open.push_back({begin, end});
      return;
    }
    const double middle = 0.5 * (begin + end);
    const Pose pose = pose_at(middle);
    as_one_cell(begin, middle, start, pose, outline, near, halvings + 1, body, open);
    as_one_cell(middle, end, pose, finish, outline, near, halvings + 1, body, open);
  }

  [[nodiscard]] Pose pose_at(double s) const {
    return pose_of(shape_.chain, between(from_, to_, s));
  }

  void stretch(double begin, double end, const Pose& start, const Pose& finish,
               std::vector<SweptCell> cells, const std::vector<std::uint32_t>& candidates) {
    begin_ = begin;
    end_ = end;
    start_ = &start;
    finish_ = &finish;
    const std::vector<std::uint32_t> near = those_near(cells, candidates);
    std::vector<SweptCell> later;
    while (!cells.empty()) {
      SweptCell cell = std::move(cells.back());
      cells.pop_back();
      if (++task_.cells > most_cells_) {
        task_.limited = true;
        give_up(cell);
        return;
      }
      switch (look_at(cell, near)) {
        case Next::Held:
          break;
        case Next::HalveTime:
          later.push_back(cell);
          break;
        case Next::HalveCurve:
        case Next::HalveFlat: {
          auto halves = cell.halves(next_along_curve_);
          cells.push_back(halves.second);
          cells.push_back(halves.first);
          break;
        }
        case Next::Refuted:
          return;
        case Next::Undecided:
          give_up(cell);
          break;
      }
    }
    if (later.empty()) return;
    const double middle = 0.5 * (begin + end);
    const Pose pose = pose_at(middle);
    stretch(begin, middle, start, pose, later, near);
    if (task_.refuting || task_.limited) return;
    stretch(middle, end, pose, finish, std::move(later), near);
  }

  /// Bodies that can hold a cell during the stretch.
  [[nodiscard]] std::vector<std::uint32_t> those_near(
      const std::vector<SweptCell>& cells, const std::vector<std::uint32_t>& candidates) const {
    geom::Box3 box;
    for (const SweptCell& cell : cells) {
      for (const Vec3& p : cell.points()) {
        box.extend(apply(*start_, p));
        box.extend(apply(*finish_, p));
      }
    }
    return those_near(box, candidates);
  }

  [[nodiscard]] std::vector<std::uint32_t> those_near(
      const geom::Box3& box, const std::vector<std::uint32_t>& candidates) const {
    // Between its ends no point is farther from the nearer one than half of what it moves.
    const Vec3 room = Vec3::Constant(
        (margin_ + 0.5 * (end_ - begin_) * bound_.speed + 2 * bound_.rounding) * kUp);
    std::vector<std::uint32_t> out;
    for (const std::uint32_t i : candidates) {
      const geom::Box3& b = bodies_[i].box();
      if ((b.min.array() <= (box.max + room).array()).all() &&
          (b.max.array() >= (box.min - room).array()).all())
        out.push_back(i);
    }
    return out;
  }

  Next look_at(SweptCell& cell, const std::vector<std::uint32_t>& near) {
    const std::size_t count = cell.points().size();
    std::array<Vec3, 8> places;
    for (std::size_t i = 0; i < count; ++i) {
      places[i] = apply(*start_, cell.points()[i]);
      places[count + i] = moves_ ? apply(*finish_, cell.points()[i]) : places[i];
    }
    const std::span<const Vec3> start(places.data(), count), finish(places.data() + count, count);
    const std::span<const Vec3> both(places.data(), moves_ ? 2 * count : count);
    sample(cell, start, begin_, near);
    if (moves_) sample(cell, finish, end_, near);
    const double length = end_ - begin_;
    const double motion = moves_ ? length * length / 8 * bound_.acceleration * kUp : 0;
    const double still = margin_ - bound_.rounding;  // what is left without motion and bulge
    const double left = still - motion - cell.bulge();
    if (holder(both, left, cell.body, near)) return Next::Held;

    const bool at_start = holder(start, still - cell.bulge(), cell.body, near);
    const bool at_finish = holder(finish, still - cell.bulge(), cell.body, near);
    const double gap = options_.gap;
    if (at_start && at_finish) {
      if (length * bound_.speed > gap) return Next::HalveTime;
      return Next::Undecided;
    }
    if (refute(cell, start, begin_, near) || refute(cell, finish, end_, near)) return Next::Refuted;
    if (cell.curved()) {
      std::uint32_t any = cell.body;
      const bool bulge_alone = holder(start, still, any, near) && holder(finish, still, any, near);
      next_along_curve_ = cell.bulge() > gap && (bulge_alone || cell.bulge() > margin_ / 8);
      if (next_along_curve_) return Next::HalveCurve;
    }
    next_along_curve_ = false;
    if (cell.size() > gap) return Next::HalveFlat;
    return Next::Undecided;
  }

  /// Whether one body holds all places; `body` is tried first, and becomes it.
  bool holder(std::span<const Vec3> places, double distance, std::uint32_t& body,
              const std::vector<std::uint32_t>& near) const {
    const auto holds = [&](std::uint32_t i) {
      return std::all_of(places.begin(), places.end(), [&](const Vec3& p) {
        return bodies_[i].distance_to_box(p) <= std::max(distance, 0.0) &&
               bodies_[i].holds(p, distance);
      });
    };
    if (bodies_.empty()) return false;
    if (holds(body)) return true;
    for (const std::uint32_t i : near) {
      if (i == body || !holds(i)) continue;
      body = i;
      return true;
    }
    return false;
  }

  /// Remembers the place farthest from the bodies.
  void sample(const SweptCell& cell, std::span<const Vec3> places, double s,
              const std::vector<std::uint32_t>& near) {
    for (const Vec3& p : places) {
      ++task_.samples;
      double nearest = std::numeric_limits<double>::infinity();
      // Distances above the margin, or what another body has, are not asked for.
      const auto look_at = [&](const SweptBody& body) {
        const double most = std::min(nearest, margin_);
        if (body.distance_to_box(p) <= most && !body.is_beyond(p, most))
          nearest = std::min(nearest, body.distance_from_above(p));
      };
      if (!bodies_.empty()) look_at(bodies_[cell.body]);
      for (const std::uint32_t i : near) {
        if (nearest <= task_.farthest.distance) break;
        look_at(bodies_[i]);
      }
      // Bodies that are not near are farther away than the margin; the claim is then refuted.
      if (nearest > task_.farthest.distance && nearest <= margin_) {
        task_.farthest = place(cell, p, s);
        task_.farthest.distance = nearest;
      }
    }
  }

  /// Whether a place is certainly farther from all bodies than the margin.
  bool refute(const SweptCell& cell, std::span<const Vec3> places, double s,
              const std::vector<std::uint32_t>& near) {
    for (const Vec3& p : places) {
      std::uint32_t held_by = cell.body;
      if (holder({&p, 1}, margin_, held_by, near)) continue;
      double nearest = std::numeric_limits<double>::infinity();
      bool outside = true;
      for (const SweptBody& body : bodies_) {
        const double away = body.distance_to_box(p);
        const double distance =
            away > margin_ + bound_.rounding && away > nearest ? away : body.distance_from_below(p);
        nearest = std::min(nearest, distance);
        outside = distance - bound_.rounding > margin_;
        if (!outside) break;
      }
      if (!outside) continue;
      task_.refuting = place(cell, p, s);
      task_.refuting->distance = nearest;
      return true;
    }
    return false;
  }

  [[nodiscard]] SweepPlace place(const SweptCell& cell, const Vec3& p, double s) const {
    SweepPlace out{task_.shape, task_.segment, s, p, 0, {}};
    const Pose pose = pose_at(s);
    for (const Vec3& corner : cell.points().last(3)) out.triangle.push_back(apply(pose, corner));
    return out;
  }

  void give_up(const SweptCell& cell) {
    ++task_.undecided_cells;
    if (!task_.undecided) task_.undecided = place(cell, apply(*start_, cell.points()[0]), begin_);
  }

  Task& task_;
  const MovingShape& shape_;
  const std::vector<double>&from_, &to_;
  const std::vector<SweptBody>& bodies_;
  double margin_;
  const SweepOptions& options_;
  std::size_t most_cells_;
  MotionBound bound_;
  bool moves_ = false, next_along_curve_ = false;
  double begin_ = 0, end_ = 1;
  const Pose *start_ = nullptr, *finish_ = nullptr;
};

void require_usable(std::span<const MovingShape> shapes, const Waypoints& path,
                    const SweepOptions& options) {
  if (path.empty()) throw Error(ErrorCode::InvalidArgument, "the path has no waypoint");
  if (!(options.gap > 0)) throw Error(ErrorCode::InvalidArgument, "the gap must be positive");
  for (const auto& waypoint : path)
    for (const double x : waypoint)
      if (!std::isfinite(x)) throw Error(ErrorCode::InvalidInput, "a waypoint is not finite");
  for (const MovingShape& shape : shapes) {
    geom::require_valid(shape.mesh);
    for (const KinematicStage& stage : shape.chain)
      for (const auto& waypoint : path)
        if (stage.motion != KinematicStage::Motion::None && stage.variable >= waypoint.size())
          throw Error(ErrorCode::InvalidArgument, "a waypoint has no value for every variable");
  }
}

/// Says how far the loops of a shape are, in the thread that made it alone.
struct StageTeller {
  const SweepOptions& options;
  const std::string& shape;
  std::thread::id caller = std::this_thread::get_id();

  void operator()(const char* what, std::size_t at, std::size_t of) const {
    if (!options.progress || std::this_thread::get_id() != caller) return;
    options.progress(shape + ": " + what + " " + std::to_string(at + 1) + " of " +
                     std::to_string(of));
  }
};

void surface_claim(std::span<const MovingShape> shapes, const Waypoints& path,
                   const std::vector<SweptBody>& bodies, double margin, const SweepOptions& options,
                   SweepClaims& claims) {
  claims.surface.answer = Answer::Verified;
  claims.farthest.distance = -1;
  const std::size_t segments = std::max<std::size_t>(path.size(), 2) - 1;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const StageTeller tell{options, shapes[i].name};
    const std::vector<SweptCell> cells = SweptCell::cells_of(shapes[i]);
    const Outline outline = outline_of(shapes[i]);
    std::vector<std::vector<Stretch>> open(segments);
    std::vector<Task> wholes(segments);
    verify::parallel_for(std::size_t{0}, segments, [&](std::size_t segment) {
      tell("segment", segment, segments);
      wholes[segment].shape = i;
      wholes[segment].segment = segment;
      open[segment] =
          Search(wholes[segment], shapes[i], path, bodies, margin, options).not_held_whole(outline);
    });
    for (const Task& task : wholes) {
      claims.cells += task.cells;
      claims.samples += task.samples;
      if (task.farthest.distance > claims.farthest.distance) claims.farthest = task.farthest;
    }
    std::vector<Task> tasks;
    for (std::size_t segment = 0; segment < segments; ++segment) {
      if (open[segment].empty()) continue;
      for (std::size_t c = 0; c < cells.size(); c += kCellsPerTask) {
        Task task;
        task.shape = i;
        task.segment = segment;
        task.first = c;
        task.last = std::min(c + kCellsPerTask, cells.size());
        tasks.push_back(std::move(task));
      }
    }
    // Tasks after the first one that refutes need not be done: all before it are.
    std::atomic<std::size_t> first_refuting = tasks.size();
    verify::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t t) {
      if (t > first_refuting) return;
      tell("part", t, tasks.size());
      Task& task = tasks[t];
      Search search(task, shapes[i], path, bodies, margin, options);
      search.run({cells.begin() + static_cast<std::ptrdiff_t>(task.first),
                  cells.begin() + static_cast<std::ptrdiff_t>(task.last)},
                 open[task.segment]);
      if (!task.refuting) return;
      std::size_t known = first_refuting;
      while (t < known && !first_refuting.compare_exchange_weak(known, t)) {
      }
    });
    const std::size_t done = std::min(first_refuting.load() + 1, tasks.size());
    for (std::size_t t = 0; t < done; ++t) {
      Task& task = tasks[t];
      claims.cells += task.cells;
      claims.samples += task.samples;
      claims.undecided_cells += task.undecided_cells;
      if (task.farthest.distance > claims.farthest.distance) claims.farthest = task.farthest;
      if (task.undecided && !claims.undecided) claims.undecided = task.undecided;
      if (task.refuting) claims.refuting = task.refuting;
    }
    if (claims.refuting) break;
  }
  if (claims.refuting) {
    claims.surface.answer = Answer::Refuted;
    claims.farthest = *claims.refuting;
    claims.surface.witness =
        Witness{claims.refuting->point, claims.refuting->distance - margin, false};
    claims.surface.reason = "a part of " + shapes[claims.refuting->shape].name + " is outside";
  } else if (claims.undecided) {
    claims.surface.answer = Answer::Undecided;
    std::ostringstream reason;
    reason << claims.undecided_cells << " parts of the motion are known to be inside only with a "
           << "larger margin, or more were looked at than allowed; the first is of "
           << shapes[claims.undecided->shape].name;
    claims.surface.reason = reason.str();
  }
}

/// Why the solid of a closed mesh need not be all that it encloses: a part of it is oriented
/// inwards; empty: it is.
std::string hollow_of(const geom::Mesh& mesh) {
  const std::optional<geom::InsideOut> found = geom::find_inside_out(mesh);
  if (found && found->refusal.empty()) return text_of(*found);
  return found && is_inside_out(mesh) ? "it is inside out: its volume is negative" : "";
}

/// Of the insides of all shapes.
void solid_claim(std::span<const MovingShape> shapes, const Waypoints& path,
                 const geom::ConvexSet& set, const std::vector<SweptBody>& bodies,
                 const SweepOptions& options, SweepClaims& claims) {
  Claim& solid = claims.solid;
  const auto take = [&](Claim claim) {  // the worst of all
    const auto rank = [](Answer a) {
      return a == Answer::Refuted ? 3 : a == Answer::Undecided ? 2 : a == Answer::Verified ? 1 : 0;
    };
    if (rank(claim.answer) > rank(solid.answer)) solid = std::move(claim);
  };
  for (const MovingShape& shape : shapes) {
    const bool mesh = shape.kind == MovingShape::Kind::Mesh;
    if (mesh && !is_closed(shape.mesh)) {
      ++claims.open_meshes;
      continue;
    }
    Claim claim = claims.surface;  // which the insides of boxes, cylinders and spheres are part of
    if (claim.answer != Answer::Verified) {
      claim = {};
      claim.answer = Answer::Undecided;
      claim.reason = "without the surface claim it is not looked at";
    } else if (const std::string why = mesh ? hollow_of(shape.mesh) : ""; !why.empty()) {
      claim = {};
      claim.answer = Answer::Undecided;
      claim.reason = shape.name + ": " + why;
    } else if (mesh) {
      if (options.progress) options.progress(shape.name + ", its inside");
      claim = verify_inside(shape, path, set, bodies, options);
    }
    take(std::move(claim));
  }
}

/// Of bodies with radii of their own: what polytopes within them hold is held, and what polytopes
/// round them do not hold is not.
SweepClaims verify_sweep_between(std::span<const MovingShape> shapes, const Waypoints& path,
                                 const geom::ConvexSet& set, const SweepOptions& options,
                                 SweepClaims open) {
  for (Claim* claim : {&open.surface, &open.solid}) {
    claim->answer = Answer::Undecided;
    claim->reason = "the bodies are too many to be bounded by polytopes";
  }
  const auto with = [&](const geom::ConvexSet& polytopes) {
    return verify_sweep(shapes, path, polytopes, options);
  };
  return decide_between(
      set, std::move(open), [&](const BodyBounds& bounds) { return with(bounds.inside); },
      [&](const BodyBounds& bounds) { return with(bounds.outside); });
}

}  // namespace

double default_gap(const geom::ConvexSet& set) {
  geom::Box3 box;
  double radius = 0;
  for (const geom::ConvexBody& b : set.bodies) {
    for (const Vec3& p : b.core.vertices) box.extend(p);
    radius = std::max(radius, b.radius);
  }
  return std::max({1e-6 * radius, box.empty() ? 0 : 1e-9 * box.diagonal(), 1e-12});
}

SweepClaims verify_sweep(std::span<const MovingShape> shapes, const Waypoints& path,
                         const geom::ConvexSet& set, const SweepOptions& options) {
  require_usable(shapes, path, options);
  SweepClaims claims;
  claims.convex = verify_convexity(set).convex;
  if (claims.convex.answer != Answer::Verified) {
    for (Claim* claim : {&claims.surface, &claims.solid}) {
      claim->answer = Answer::Undecided;
      claim->reason = "not all bodies are convex";
    }
    return claims;
  }
  const std::optional<double> margin = geom::margin_of(set);
  if (!margin) return verify_sweep_between(shapes, path, set, options, std::move(claims));
  std::vector<SweptBody> bodies;
  for (const geom::ConvexBody& b : set.bodies) bodies.emplace_back(b.core);
  surface_claim(shapes, path, bodies, *margin, options, claims);
  if (options.solids) solid_claim(shapes, path, set, bodies, options, claims);
  return claims;
}

}  // namespace kaboum::verify
