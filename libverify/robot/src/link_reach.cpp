// How far bodies of a link reach beyond its shapes.
#include <kaboum/base/error.h>
#include <kaboum/base/number_text.h>
#include <kaboum/geom/body_polytopes.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/exact_shapes.h>
#include <kaboum/robot/mesh_files.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/link_reach.h>
#include <kaboum/verify/region_excess.h>
#include <kaboum/verify/subject.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kaboum::verify {
namespace {

using geom::Vec3;
using robot::Geometry;

constexpr int kLevel = 3;  ///< of the sphere's points: 0.3 % of a radius
constexpr int kSides = 64;
constexpr double kInwards = 1 - 1e-12;

void append(geom::Mesh& all, const geom::Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(all.vertices.size());
  all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const geom::Triangle& t : mesh.triangles)
    all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

/// Points of a round shape whose hull is nearly all of it.
std::vector<Vec3> points_within(const Geometry& g) {
  std::vector<Vec3> out;
  if (g.shape == Geometry::Shape::Cylinder) {
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2 * std::numbers::pi * i / kSides;
      for (const double end : {-0.5, 0.5})
        out.emplace_back(g.size.x() * std::cos(angle), g.size.x() * std::sin(angle),
                         end * g.size.y());
    }
  } else {
    const bool ellipsoid = g.shape == Geometry::Shape::Ellipsoid;
    const Vec3 half = ellipsoid ? g.size : Vec3(Vec3::Constant(g.size.x()));
    const double along = g.shape == Geometry::Shape::Capsule ? 0.5 * g.size.y() : 0;
    for (const Vec3& p : geom::sphere_points(kLevel).points)
      for (const double end : {-along, along})
        out.emplace_back(p.cwiseProduct(half) + Vec3(0, 0, end));
  }
  for (Vec3& p : out) p = g.origin * (kInwards * p);
  return out;
}

}  // namespace

MeasuredLink measured_link(const std::vector<Geometry>& shapes, robot::MeshFiles& files) {
  MeasuredLink out;
  const auto take = [&](const geom::Mesh& inside, const geom::Mesh& round) {
    append(out.inside, inside);
    append(out.round, round);
  };
  for (const Geometry& g : shapes) {
    if (robot::is_point(g)) continue;
    if (g.shape == Geometry::Shape::Mesh) {
      const io::ReadResult read = io::read_mesh(files.only(g.mesh));
      const geom::Box3 box = geom::bounding_box(read.mesh);
      out.diagonal =
          std::max(out.diagonal, (box.max - box.min).cwiseProduct(g.size.cwiseAbs()).norm());
      const Subject subject =
          prepared_subject(read.mesh, {.holes = geom::Holes::Fill,
                                       .quads = read.bent_quads,
                                       .diagonal = geom::PrepareOptions::Diagonal::Outward});
      const geom::Mesh placed = robot::placed_mesh(measured_mesh(subject, read.mesh).mesh, g);
      take(placed, placed);
      continue;
    }
    const geom::Mesh round = *geom::convex_hull(robot::bounding_points(g));
    out.diagonal = std::max(out.diagonal, geom::bounding_box(round).diagonal());
    if (g.shape == Geometry::Shape::Box) {
      take(round, round);
    } else if (const auto inside = geom::convex_hull(points_within(g))) {
      take(*inside, round);
    } else {  // flat: nearly all of it
      append(out.round, round);
    }
  }
  return out;
}

namespace {

/// The answer that bodies round those that are meant and a polytope within the link's shapes
/// verify, and the others refute.
/// @param reaches_round, reaches_inside  decide it of bodies and shapes
template <class ReachesRound, class ReachesInside>
DistanceClaim between(const geom::ConvexSet& inside, const geom::ConvexSet& round,
                      const MeasuredLink& link, const ReachesRound& reaches_round,
                      const ReachesInside& reaches_inside) {
  DistanceClaim out;
  if (round.bodies.empty()) {
    out.answer = Answer::Verified;
    return out;
  }
  const auto of = [&](const geom::ConvexSet& set, const geom::Mesh& shapes, const auto& reaches) {
    DistanceClaim claim;
    claim.answer = Answer::Undecided;
    claim.reason = "the link's shapes have no area";
    return shapes.triangles.empty() ? claim : reaches(set, shapes);
  };
  out = of(round, link.inside, reaches_round);
  if (out.answer == Answer::Verified) return out;
  if (!inside.bodies.empty()) {
    DistanceClaim necessary = of(inside, link.round, reaches_inside);
    if (necessary.answer == Answer::Refuted) return necessary;
  }
  out.answer = Answer::Undecided;
  if (out.reason.empty())
    out.reason = "bodies a little larger are farther away, and a little smaller ones are not";
  return out;
}

}  // namespace

DistanceClaim verify_link_reach(const geom::ConvexSet& inside, const geom::ConvexSet& round,
                                const MeasuredLink& link, double epsilon) {
  const auto reaches = [&](const geom::ConvexSet& set, const geom::Mesh& shapes) {
    return verify_excess(set, shapes, epsilon, true);
  };
  return between(inside, round, link, reaches, reaches);
}

namespace {

/// @param what  it is of, for messages
double length_of(const Length& epsilon, const MeasuredLink& link, const std::string& what) {
  if (!epsilon.percent) return epsilon.in("m").value;
  const double out = epsilon.of(link.diagonal);
  if (!(out > 0))
    throw Error(ErrorCode::InvalidInput,
                what + ": a percentage of shapes without extent is no length");
  return out;
}

LinkReach::InRegion reach_in(const robot::LinkRegion& region, const geom::ConvexSet& inside,
                             const geom::ConvexSet& round, const MeasuredLink& link) {
  LinkReach::InRegion out{region.name,
                          length_of(region.epsilon, link, "the region " + region.name)};
  const auto in = [&](robot::Side side) {
    return [&, side](const geom::ConvexSet& set, const geom::Mesh& shapes) {
      const auto placed = robot::region_in_link(region, side);
      DistanceClaim claim;
      claim.answer = Answer::Undecided;
      claim.reason = "rounding leaves nothing of the region";
      return placed ? verify_region_excess(set, shapes, {region.name, placed->region, out.epsilon},
                                           true)
                    : claim;
    };
  };
  out.reached = may_reach(round, robot::region_in_link(region, robot::Side::Round)->region);
  out.claim = between(inside, round, link, in(robot::Side::Round), in(robot::Side::Within));
  return out;
}

}  // namespace

Answer LinkReach::answer() const {
  Answer out = all ? all->answer : Answer::Verified;
  for (const InRegion& one : regions) out = worse(out, one.claim.answer);
  return out;
}

std::string LinkReach::sentence() const {
  std::string out = all ? "; " + sentence_of_reach(*all, epsilon) : std::string();
  for (const InRegion& one : regions)
    out += "; in the region " + one.name + " " +
           (one.reached ? sentence_of_reach(one.claim, one.epsilon) : "there is no point of them");
  return out;
}

bool asks_how_far(const std::string& link, std::optional<double> epsilon,
                  const robot::LinkBounds& bounds) {
  return epsilon || bounds.epsilons.contains(link) || bounds.groups.contains(link);
}

std::string text_of_bare_link(const std::string& link) {
  return "link '" + link +
         "': undecided: it has no shape that bodies could be near to, and has bodies";
}

void add_farther(const std::string& link, const LinkReach& reach, std::vector<std::string>& out) {
  for (const LinkReach::InRegion& one : reach.regions)
    if (one.claim.answer == Answer::Refuted) out.push_back(one.name + " of '" + link + "'");
}

std::string text_of_farther(const std::vector<std::string>& regions) {
  constexpr std::size_t kNamed = 5;
  std::string out;
  for (std::size_t i = 0; i < std::min(regions.size(), kNamed); ++i)
    out += (i == 0 ? "; farther than asked in the region " : ", ") + regions[i];
  if (regions.size() > kNamed) out += " and " + std::to_string(regions.size() - kNamed) + " more";
  return out;
}

std::string text_of_points(const std::string& link) {
  return "link '" + link + "' has no shape but points: nothing of it is judged";
}

LinkReach decide_link_reach(const geom::ConvexSet& inside, const geom::ConvexSet& round,
                            const std::string& link, const std::vector<Geometry>& shapes,
                            robot::MeshFiles& files, std::optional<double> epsilon,
                            const robot::LinkBounds& bounds) {
  LinkReach out;
  const auto own = bounds.epsilons.find(link);
  const auto regions = bounds.regions.find(link);
  if (!epsilon && own == bounds.epsilons.end() && regions == bounds.regions.end()) return out;
  const MeasuredLink measured = measured_link(shapes, files);
  if (own != bounds.epsilons.end())
    epsilon = length_of(own->second, measured, "link '" + link + "'");
  if (epsilon) {
    out.epsilon = *epsilon;
    out.all = verify_link_reach(inside, round, measured, *epsilon);
  }
  if (regions != bounds.regions.end())
    for (const robot::LinkRegion& region : regions->second)
      out.regions.push_back(reach_in(region, inside, round, measured));
  return out;
}

std::string sentence_of_reach(const DistanceClaim& claim, double epsilon) {
  const std::string bound = number_text(epsilon);
  if (claim.answer == Answer::Verified)
    return "no point of them is farther than " + bound + " from it";
  if (claim.answer == Answer::Refuted)
    return "they reach " + number_down(claim.largest) + ", farther than " + bound + ", at (" +
           number_text(claim.at.x()) + ", " + number_text(claim.at.y()) + ", " +
           number_text(claim.at.z()) + ")";
  return "whether they reach farther than " + bound + " is not decided: " + claim.reason;
}

}  // namespace kaboum::verify
