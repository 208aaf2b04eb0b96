#include <kaboum/base/error.h>
#include <kaboum/base/parse_length.h>
#include <kaboum/certify/link_bodies.h>
#include <kaboum/certify/set_cache.h>
#include <kaboum/collide/bounding_set.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/robot/kinematics.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "common/cli.h"

/// Times of queries by kind of body: pairs of balls, capsules, boxes and polytopes near contact,
/// and robots in scenes at equal epsilon, whose links are held by polytopes, capsules, boxes or
/// whichever is cheapest. Of scenes there are two kinds: crowded ones, in which most poses are in
/// collision, and open ones, in which most are free.
///
///   kinds-benchmark                        the table of pairs
///   kinds-benchmark EPSILON ROBOT...       robots (URDF) among boxes; epsilon in metres or percent
namespace {

using namespace kaboum;
using collide::BoundingSet;
using collide::PosedSet;
using geom::Vec3;

/// Processor seconds of this thread's program: other programs of the machine do not count.
double processor() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Vec3 direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

geom::Transform turned(std::mt19937_64& random) {
  std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi);
  return {robot::rotation_about(direction(random), angle(random)), Vec3::Zero()};
}

/// A body of about the size 1. @param vertices  0: a ball; 2: a capsule; 8: a box
geom::ConvexBody body_of(int vertices, std::mt19937_64& random) {
  geom::ConvexBody out;
  if (vertices == 0) {
    out.core.vertices = {Vec3::Zero()};
    out.radius = 0.5;
  } else if (vertices == 2) {
    out.core.vertices = {{-0.5, 0, 0}, {0.5, 0, 0}};
    out.radius = 0.25;
  } else if (vertices == 8) {
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i)
      corners.emplace_back((i & 1) != 0 ? 0.6 : -0.6, (i & 2) != 0 ? 0.3 : -0.3,
                           (i & 4) != 0 ? 0.2 : -0.2);
    out.core = *geom::convex_hull(corners);
  } else {
    std::vector<Vec3> points;
    for (int i = 0; i < vertices; ++i)
      points.emplace_back(direction(random).cwiseProduct(Vec3(0.6, 0.35, 0.3)));
    out.core = *geom::convex_hull(points);
  }
  return out;
}

void pairs() {
  const std::vector<std::pair<const char*, int>> kinds{{"ball", 0}, {"capsule", 2}, {"box", 8},
                                                       {"16", 16},  {"32", 32},     {"64", 64}};
  std::printf("nanoseconds of one query, with a remembered axis at poses that change little\n%8s",
              "");
  for (const auto& [name, vertices] : kinds) std::printf("%9s", name);
  std::printf("\n");
  for (const auto& [first, n] : kinds) {
    std::printf("%8s", first);
    for (const auto& [second, m] : kinds) {
      std::mt19937_64 random(1);
      constexpr int kPlaces = 400, kSteps = 50;
      std::vector<double> all;
      const BoundingSet a({body_of(n, random)}, collide::Direction::Outer, 0),
          b({body_of(m, random)}, collide::Direction::Outer, 0);
      double total = 0;
      std::uniform_real_distribution<double> away(0.6, 1.3);
      std::size_t meet = 0;
      for (int place = 0; place < kPlaces; ++place) {
        geom::Transform pose = turned(random);
        const Vec3 at = away(random) * direction(random), along = 0.004 * direction(random);
        const PosedSet fixed(a, turned(random));
        PosedSet moving(b, pose);
        collide::Memory memory;
        const double start = processor();
        for (int step = 0; step < kSteps; ++step) {
          pose.translation = at + step * along;
          moving.place(pose);
          meet += collide::find_collision(fixed, moving, 0, &memory) ? 1U : 0U;
        }
        total += processor() - start;
      }
      std::printf("%9.0f", 1e9 * total / (kPlaces * kSteps));
    }
    std::printf("\n");
  }
}

/// The bodies of one link, ready for queries.
struct Link {
  std::uint32_t link;
  BoundingSet set;
};

std::vector<Link> links_of(const certify::CertifiedBodies& bodies, std::size_t count) {
  std::vector<Link> out;
  for (std::uint32_t l = 0; l < count; ++l) {
    std::vector<geom::ConvexBody> own;
    for (const robot::LinkBody& body : bodies.artefact()) {
      if (body.link != l) continue;
      geom::ConvexBody one{body.name, {}, body.margin};
      if (auto hull = geom::convex_hull(body.points))
        one.core = *std::move(hull);
      else
        one.core.vertices = body.points;
      own.push_back(std::move(one));
    }
    if (!own.empty()) out.push_back({l, {std::move(own), collide::Direction::Outer, 1}});
  }
  return out;
}

/// Boxes about the robot, in shares of its reach.
struct SceneKind {
  const char* name;
  int boxes;
  double smallest, largest;  ///< half of their edges
  double nearest, farthest;
};
constexpr SceneKind kCrowded{"crowded", 40, 0.02, 0.12, 0.3, 1.0},
    kOpen{"open", 40, 0.01, 0.06, 0.9, 1.4};

/// As an outer set.
BoundingSet scene(const SceneKind& kind, double reach, std::mt19937_64& random) {
  std::uniform_real_distribution<double> size(kind.smallest, kind.largest),
      away(kind.nearest, kind.farthest);
  std::vector<geom::ConvexBody> bodies;
  for (int i = 0; i < kind.boxes; ++i) {
    const geom::Transform pose{turned(random).linear, away(random) * reach * direction(random)};
    const Vec3 half = reach * Vec3(size(random), size(random), size(random));
    std::vector<Vec3> corners;
    for (int c = 0; c < 8; ++c)
      corners.push_back(pose * Vec3((c & 1) != 0 ? half.x() : -half.x(),
                                    (c & 2) != 0 ? half.y() : -half.y(),
                                    (c & 4) != 0 ? half.z() : -half.z()));
    bodies.push_back({"box", *geom::convex_hull(corners), 0});
  }
  return {std::move(bodies), collide::Direction::Outer, 0};
}

/// Time of a query and the share of those that find a collision.
struct Figures {
  double microseconds = 0, alarms = 0;
};

/// A robot along motions in some scenes; the least time of several runs, as other programs of the
/// machine disturb one.
Figures time_in(const SceneKind& kind, const robot::Robot& robot, const std::vector<Link>& links,
                double reach) {
  constexpr int kRuns = 5, kScenes = 5, kMotions = 60, kSteps = 25;
  Figures out;
  for (int run = 0; run < kRuns; ++run) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> value(-2, 2);
    const std::size_t joints = robot.variables.size();
    double total = 0;
    std::size_t alarms = 0;
    for (int s = 0; s < kScenes; ++s) {
      const BoundingSet boxes = scene(kind, reach, random);
      const PosedSet fixed(boxes);
      std::vector<PosedSet> moving;
      for (const Link& link : links) moving.emplace_back(link.set);
      std::vector<collide::Memory> memory(links.size());
      for (int motion = 0; motion < kMotions; ++motion) {
        std::vector<double> from(joints), to(joints), q(joints);
        for (std::size_t j = 0; j < joints; ++j) {
          from[j] = value(random);
          to[j] = from[j] + 0.2 * value(random);
        }
        std::vector<std::vector<geom::Transform>> poses;
        for (int step = 0; step < kSteps; ++step) {
          for (std::size_t j = 0; j < joints; ++j)
            q[j] = from[j] + step * (to[j] - from[j]) / kSteps;
          poses.push_back(robot::forward(robot, q));
        }
        // The clock takes as long as a query: it is asked once for a motion.
        const double start = processor();
        for (const std::vector<geom::Transform>& at : poses) {
          bool hit = false;
          for (std::size_t l = 0; l < links.size() && !hit; ++l) {
            moving[l].place(at[links[l].link]);
            hit = collide::find_collision(moving[l], fixed, 0, &memory[l]).has_value();
          }
          alarms += hit ? 1U : 0U;
        }
        total += processor() - start;
      }
    }
    constexpr double kQueries = kScenes * kMotions * kSteps;
    const double each = 1e6 * total / kQueries;
    out = {run == 0 ? each : std::min(out.microseconds, each),
           static_cast<double>(alarms) / kQueries};
  }
  return out;
}

void robot_in_scene(const std::string& file, const Length& epsilon) {
  const robot::RobotFile robot = robot::read_robot(file);
  std::printf("%s within %s\n%10s %8s %9s", file.c_str(), epsilon.text().c_str(), "kind", "bodies",
              "vertices");
  for (const SceneKind& scene : {kCrowded, kOpen})
    std::printf(" | %8s us %7s %9s", scene.name, "ratio", "alarms");
  std::printf("\n");
  using Kind = certify::SetRequest::BodyKind;
  std::array<double, 2> reference{};
  for (const auto& [name, kind] :
       {std::pair{"polytopes", Kind::Polytopes}, std::pair{"capsules", Kind::Capsules},
        std::pair{"boxes", Kind::Boxes}, std::pair{"mixed", Kind::Mixed}}) {
    certify::RobotRequest request;
    request.set.epsilon = epsilon;
    request.set.body_kind = kind;
    request.set.effort = bcd::Effort::Fast;
    const certify::SetCache cache(certify::SetCache::default_folder());
    const certify::CertifiedBodies bodies = certify::certify_bodies(robot, request, &cache);
    std::size_t points = 0;
    double reach = 0;
    for (const robot::LinkBody& body : bodies.artefact()) points += body.points.size();
    const std::vector<Link> links = links_of(bodies, robot.robot.links.size());
    const std::vector<double> zero(robot.robot.variables.size(), 0);
    for (const geom::Transform& pose : robot::forward(robot.robot, zero))
      reach = std::max(reach, pose.translation.norm());
    std::printf("%10s %8zu %9zu", name, bodies.artefact().size(), points);
    std::size_t column = 0;
    for (const SceneKind& scene : {kCrowded, kOpen}) {
      const Figures figures = time_in(scene, robot.robot, links, reach);
      double& first = reference[column++];
      if (first == 0) first = figures.microseconds;
      std::printf(" | %11.2f %7.2f %8.1f%%", figures.microseconds, figures.microseconds / first,
                  100 * figures.alarms);
    }
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 3) {
      pairs();
      return 0;
    }
    for (int i = 2; i < argc; ++i) robot_in_scene(argv[i], parse_length(argv[1]).value());
    return 0;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
