#include <kaboum/base/error.h>
#include <kaboum/base/parse_length.h>
#include <kaboum/certify/link_bodies.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/mesh_files.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "common/cli.h"
#include "engine.h"
#include "queries.h"
#include "timing.h"

/// What convex sets buy in collision checking (the thesis's Fig. 4.9): the queries of RRT-Connect
/// for a six-axis robot that reaches from a window in one wall into a window in the other, replayed
/// on triangle meshes, on one hull per link, and on bounding sets of convex bodies. The scene fits
/// a robot that reaches SCALE · 0.9 m.
namespace {

using namespace kaboum;
using namespace kaboum::collide;

/// Two walls at y = ±0.5 · scale with a window each, as boxes.
std::vector<geom::Mesh> make_scene(double scale) {
  std::vector<geom::Mesh> boxes;
  const auto add = [&](const geom::Vec3& low, const geom::Vec3& high) {
    std::vector<geom::Vec3> corners;
    for (const double x : {low.x(), high.x()})
      for (const double y : {low.y(), high.y()})
        for (const double z : {low.z(), high.z()})
          corners.emplace_back(scale * geom::Vec3(x, y, z));
    boxes.push_back(*geom::convex_hull(corners));
  };
  for (const double y : {-0.5, 0.45}) {
    const double far = y + 0.05;
    add({-1, y, -0.5}, {-0.17, far, 1.5});
    add({0.17, y, -0.5}, {1, far, 1.5});
    add({-0.17, y, -0.5}, {0.17, far, 0.25});
    add({-0.17, y, 0.6}, {0.17, far, 1.5});
  }
  return boxes;
}

struct Shapes {
  Model triangles, hulls, sets;
};

Shapes load(const robot::RobotFile& file, const std::string& epsilon, double scale) {
  Shapes out;
  robot::MeshFiles meshes(file.path, {});
  out.triangles = {"triangle meshes", false, 0, {}, make_scene(scale)};
  out.hulls = {"hulls of links", true, 0, {}, make_scene(scale)};
  out.sets = {"bounding sets", true, 0, {}, make_scene(scale)};
  for (std::uint32_t l = 1; l < file.robot.links.size(); ++l) {
    geom::Mesh all;
    for (const robot::Geometry& g : file.robot.links[l].collision) {
      if (g.shape != robot::Geometry::Shape::Mesh) continue;
      geom::Mesh mesh = io::read_mesh(meshes.first(g.mesh)).mesh;
      for (geom::Vec3& v : mesh.vertices) v = g.origin * v.cwiseProduct(g.size);
      if (const auto hull = geom::convex_hull(mesh.vertices)) out.hulls.robot.push_back({l, *hull});
      out.triangles.robot.push_back({l, std::move(mesh)});
    }
  }
  certify::RobotRequest request;
  request.set.epsilon = parse_length(epsilon);
  request.set.effort = bcd::Effort::Fast;
  const certify::CertifiedBodies bodies = certify::certify_bodies(file, request);
  for (const robot::LinkBody& body : bodies.artefact())
    if (body.link > 0)
      if (const auto hull = geom::convex_hull(body.points))
        out.sets.robot.push_back({body.link, *hull});
  // The base stands between the walls and never moves.
  const auto base = [&](const Part& part) {
    return file.robot.links[part.link].name.find("base") != std::string::npos;
  };
  for (Model* model : {&out.triangles, &out.hulls, &out.sets}) std::erase_if(model->robot, base);
  return out;
}

/// A configuration whose last link is behind the window of one side, without collision.
Configuration reach_through(const robot::Robot& robot, Engine& engine, double side, double scale,
                            std::mt19937_64& random) {
  std::uniform_real_distribution<double> value(-3.1, 3.1);
  for (int i = 0; i < 5'000'000; ++i) {
    Configuration q(robot.variables.size());
    for (double& x : q) x = value(random);
    const auto poses = robot::forward(robot, q);
    const geom::Vec3 hand =
        poses[robot.find_link("tool0").value_or(static_cast<std::uint32_t>(poses.size() - 1))]
            .translation /
        scale;
    if (side * hand.y() < 0.6 || std::abs(hand.x()) > 0.2 || hand.z() < 0.2) continue;
    engine.place(poses);
    if (!engine.collide()) return q;
  }
  throw Error(ErrorCode::LimitReached, "no configuration reaches through the window");
}

int measure(const char* robot_path, std::size_t wanted, const char* csv, const char* epsilon,
            double scale) {
  const robot::RobotFile file = robot::read_robot(robot_path);
  const Shapes shapes = load(file, epsilon, scale);
  for (const Model* model : {&shapes.triangles, &shapes.hulls, &shapes.sets}) {
    std::size_t vertices = 0;
    for (const Part& part : model->robot) vertices += part.mesh.vertices.size();
    std::printf("%s: %zu parts, %zu vertices\n", model->name.c_str(), model->robot.size(),
                vertices);
  }
  const auto planner = make_fcl(shapes.sets);
  std::mt19937_64 random(1);
  const Configuration start = reach_through(file.robot, *planner, 1, scale, random);
  const Configuration goal = reach_through(file.robot, *planner, -1, scale, random);
  std::size_t solved = 0;
  const auto configurations = record_queries(
      start, goal, 3.1,
      [&](const Configuration& q) {
        planner->place(robot::forward(file.robot, q));
        return !planner->collide();
      },
      wanted, solved);
  std::vector<std::vector<robot::Transform>> queries;
  for (const Configuration& q : configurations) queries.push_back(robot::forward(file.robot, q));
  std::printf("%zu queries of RRT-Connect, %zu plans found\n", queries.size(), solved);
  FILE* out = csv != nullptr ? std::fopen(csv, "w") : nullptr;
  if (out != nullptr) std::fprintf(out, "library,model,query,microseconds\n");
  std::vector<double> times;
  const auto report = [&](const std::string& library, const Model& model, const Statistics& s,
                          const std::string& more) {
    std::fflush(stdout);
    std::printf("%-14s %-16s mean %8.2f  p99 %8.2f  max %8.2f us  %s\n", library.c_str(),
                model.name.c_str(), s.mean, s.p99, s.most, more.c_str());
    for (std::size_t i = 0; out != nullptr && i < times.size(); ++i)
      std::fprintf(out, "%s,%s,%zu,%.3f\n", library.c_str(), model.name.c_str(), i, times[i]);
  };
  std::vector<char> truth;
  for (const auto& [library, make] :
       {std::pair{"FCL", &make_fcl}, {"Bullet", &make_bullet}, {"ODE", &make_ode}}) {
    double triangles = 0;
    for (const Model* model : {&shapes.triangles, &shapes.hulls, &shapes.sets}) {
      const auto engine = make(*model);
      std::vector<char> answers;
      for (const auto& poses : queries) {
        engine->place(poses);
        answers.push_back(engine->collide() ? 1 : 0);
      }
      if (truth.empty()) truth = answers;
      std::size_t more = 0, missed = 0;
      for (std::size_t i = 0; i < truth.size(); ++i) {
        more += answers[i] > truth[i] ? 1 : 0;
        missed += answers[i] < truth[i] ? 1 : 0;
      }
      const Statistics s = times_of(
          queries.size(),
          [&](std::size_t i) {
            engine->place(queries[i]);
            engine->collide();
          },
          times);
      if (model == &shapes.triangles) triangles = s.most;
      char text[160];
      std::snprintf(text, sizeof text,
                    "%.1f times below the triangles' max; against FCL's triangles %zu more "
                    "collisions, %zu fewer",
                    triangles / s.most, more, missed);
      report(library, *model, s, text);
    }
  }
  double triangles = 0;
  queries.resize(std::min<std::size_t>(queries.size(), 1000));
  for (const Model* model : {&shapes.triangles, &shapes.hulls, &shapes.sets}) {
    const auto engine = make_fcl(*model);
    const Statistics s = times_of(
        queries.size(),
        [&](std::size_t i) {
          engine->place(queries[i]);
          engine->distance();
        },
        times);
    if (model == &shapes.triangles) triangles = s.most;
    char text[80];
    std::snprintf(text, sizeof text, "%.1f times below the triangles' max", triangles / s.most);
    report("FCL distance", *model, s, text);
  }
  if (out != nullptr) std::fclose(out);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr,
                 "usage: collision-benchmark ROBOT [QUERIES [TIMES.csv [EPSILON [SCALE]]]]\n");
    return 2;
  }
  try {
    return measure(argv[1], argc > 2 ? std::stoul(argv[2]) : 3000, argc > 3 ? argv[3] : nullptr,
                   argc > 4 ? argv[4] : "3%", argc > 5 ? std::stod(argv[5]) : 1);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "collision-benchmark: %s\n", error.what());
    return 1;
  }
}
