#include <kaboum/geom/convex_hull.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/io/mesh_io.h>

#include <cstdio>
#include <numbers>
#include <random>
#include <string>

#include "engine.h"
#include "timing.h"

/// What convex sets of a mesh buy: collision queries between two copies of it near contact, with
/// FCL (libccd for convex bodies), on the triangle meshes and on each of the given sets. A false
/// alarm is a collision of the sets where the meshes are apart, a miss the opposite.
namespace {

using namespace kaboum;
using namespace kaboum::collision;

Model model_of(const std::string& name, bool convex, const std::vector<geom::Mesh>& bodies) {
  Model model{name, convex, 0, {}, bodies};
  for (const geom::Mesh& body : bodies) model.robot.push_back({0, body});
  return model;
}

/// Sets of other programs are convex up to rounding only: the hulls of their bodies.
Model load_set(const std::string& path, std::size_t& vertices) {
  std::vector<geom::Mesh> bodies;
  for (const geom::ConvexBody& body : io::read_convex_set(path).bodies)
    if (auto hull = geom::convex_hull(body.hull.vertices)) bodies.push_back(std::move(*hull));
  vertices = 0;
  for (const geom::Mesh& body : bodies) vertices += body.vertices.size();
  return model_of(path, true, bodies);
}

geom::Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return geom::Vec3(normal(random), normal(random), normal(random)).normalized();
}

/// Poses of the second copy: turned at random, moved along a random direction to the last contact
/// (by bisection), then between 1 % of the diagonal nearer and 2 % farther.
std::vector<sweep::Transform> near_contact(const geom::Mesh& mesh, Engine& engine,
                                           std::size_t count) {
  const geom::Box3 box = geom::bounding_box(mesh);
  const geom::Vec3 center = 0.5 * (box.min + box.max);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<sweep::Transform> poses;
  while (poses.size() < count) {
    sweep::Transform pose;
    pose.linear =
        sweep::rotation_about(random_direction(random), 2 * std::numbers::pi * unit(random));
    const geom::Vec3 direction = random_direction(random);
    // The line goes past the middle, so that not only the bulk of both meets.
    const geom::Vec3 aside = 0.4 * unit(random) * box.diagonal() *
                             direction.cross(random_direction(random)).normalized();
    const auto place = [&](double distance) {
      pose.translation = center + distance * direction + aside - pose.linear * center;
      return pose;
    };
    // From far to near, the first contact; none where the copies pass each other.
    double far = 1.1 * box.diagonal(), near = -1;
    for (int step = 0; step < 60 && near < 0; ++step) {
      const double d = far - 0.02 * box.diagonal();
      if (d < 0) break;
      engine.place({place(d)});
      if (engine.collide())
        near = d;
      else
        far = d;
    }
    if (near < 0) continue;
    for (int i = 0; i < 20; ++i) {
      const double middle = 0.5 * (near + far);
      engine.place({place(middle)});
      (engine.collide() ? near : far) = middle;
    }
    poses.push_back(place(far + (0.03 * unit(random) - 0.01) * box.diagonal()));
  }
  return poses;
}

int measure(std::size_t count, const std::string& path, const std::vector<std::string>& sets) {
  const geom::Mesh mesh = io::read_mesh(path).mesh;
  const auto triangles = make_fcl(model_of("triangles", false, {mesh}));
  const auto poses = near_contact(mesh, *triangles, count);
  std::vector<char> truth;
  for (const auto& pose : poses) {
    triangles->place({pose});
    truth.push_back(triangles->collide() ? 1 : 0);
  }
  const auto apart = static_cast<std::size_t>(std::count(truth.begin(), truth.end(), 0));
  std::vector<double> times;
  const auto time = [&](Engine& engine) {
    return times_of(
        poses.size(),
        [&](std::size_t i) {
          engine.place({poses[i]});
          engine.collide();
        },
        times);
  };
  const Statistics reference = time(*triangles);
  std::printf("%s: %zu triangles, %zu queries, %zu of them apart\n", path.c_str(),
              mesh.triangles.size(), poses.size(), apart);
  std::printf("  %-34s mean %8.2f  p99 %8.2f  max %8.2f us\n", "triangles", reference.mean,
              reference.p99, reference.most);
  for (const std::string& file : sets) {
    std::size_t vertices = 0;
    const Model model = load_set(file, vertices);
    const auto engine = make_fcl(model);
    std::size_t alarms = 0, missed = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      engine->place({poses[i]});
      const bool hit = engine->collide();
      alarms += hit && truth[i] == 0 ? 1 : 0;
      missed += !hit && truth[i] != 0 ? 1 : 0;
    }
    const Statistics s = time(*engine);
    const std::string name = file.substr(file.find_last_of('/') + 1);
    std::printf(
        "  %-34s mean %8.2f  p99 %8.2f  max %8.2f us; %zu bodies, %zu vertices; p99 %.1f, max %.1f "
        "times faster; %zu false alarms (%.2f %%), %zu misses\n",
        name.c_str(), s.mean, s.p99, s.most, model.robot.size(), vertices, reference.p99 / s.p99,
        reference.most / s.most, alarms,
        100 * static_cast<double>(alarms) / static_cast<double>(std::max<std::size_t>(apart, 1)),
        missed);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: set-collision-benchmark QUERIES MESH SET...\n");
    return 2;
  }
  try {
    return measure(std::stoul(argv[1]), argv[2], {argv + 3, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "set-collision-benchmark: %s\n", error.what());
    return 1;
  }
}
