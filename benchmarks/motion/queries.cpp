// Queries for paths, timed, and paths judged by exact meshes.
//
//   path-query-benchmark plan SCENE PROBLEMS ANSWERS REPEATS [NODES]
//   path-query-benchmark judge SCENE URDF PROBLEMS PATHS ANSWERS STEP
//
// SCENE has a robot; PROBLEMS are lines of JSON: objects, start and goal; PATHS are lines of
// waypoints, one for each problem. planner_peers.py writes and reads all of them.

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/judge/cell.h>
#include <kaboum/motion/roadmap.h>
#include <kaboum/robot/mesh_files.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/world/motion_check.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

namespace {

using namespace kaboum;
using nlohmann::json;
using Values = std::vector<double>;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::vector<json> read_lines(const char* name) {
  std::ifstream file(name);
  std::vector<json> out;
  for (std::string line; std::getline(file, line);) out.push_back(json::parse(line));
  return out;
}

geom::Transform pose_of(const json& stated) {
  const auto p = stated["position"], q = stated["quaternion"];  // x, y, z, w
  const Eigen::Quaterniond turn(q[3].get<double>(), q[0].get<double>(), q[1].get<double>(),
                                q[2].get<double>());
  geom::Transform out;
  out.linear = turn.normalized().toRotationMatrix();
  out.translation = {p[0].get<double>(), p[1].get<double>(), p[2].get<double>()};
  return out;
}

world::World with_objects(const world::World& robot, const json& objects) {
  world::World out = robot;
  for (const json& stated : objects) {
    const std::string name = stated["name"];
    const world::Primitive shape = world::parse_primitive(stated["shape"].dump(), name);
    world::Object object{name, pose_of(stated), outer_set(shape), inner_set(shape), {}, {}};
    object.primitive = shape;
    out.objects.push_back(std::move(object));
  }
  out.attachments.resize(out.objects.size());
  return out;
}

double length_of(const robot::Path& path) {
  double out = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < path[i].size(); ++k)
      sum += (path[i][k] - path[i - 1][k]) * (path[i][k] - path[i - 1][k]);
    out += std::sqrt(sum);
  }
  return out;
}

/// A scene with the objects of a problem, kept while they are the same.
struct Cell {
  json objects;
  std::unique_ptr<world::World> world;
  std::unique_ptr<world::Checker> checker;
  std::unique_ptr<motion::PathFinder> finder;
  std::unique_ptr<motion::Roadmap> roadmap;
  double seconds = 0;  ///< to make it

  Cell(const world::World& robot, const json& of, std::size_t nodes) : objects(of) {
    world = std::make_unique<world::World>(with_objects(robot, of));
    const double start = now();
    checker = std::make_unique<world::Checker>(*world);
    finder = std::make_unique<motion::PathFinder>(*checker, initial_state(*world), 0);
    motion::RoadmapOptions options;
    options.nodes = nodes;
    if (nodes > 0) roadmap = std::make_unique<motion::Roadmap>(*finder, options);
    seconds = now() - start;
  }
};

int plan(int argc, char** argv) {
  const world::SceneFile scene = world::read_scene(argv[2]);
  const std::vector<json> problems = read_lines(argv[3]);
  std::ofstream out(argv[4]);
  const int repeats = argc > 5 ? std::atoi(argv[5]) : 5;
  const std::size_t nodes = argc > 6 ? std::strtoul(argv[6], nullptr, 10) : 0;
  std::unique_ptr<Cell> cell;
  for (const json& problem : problems) {
    if (!cell || cell->objects != problem["objects"])
      cell = std::make_unique<Cell>(scene.world, problem["objects"], nodes);
    const auto start = problem["start"].get<Values>();
    const std::vector<Values> goals{problem["goal"].get<Values>()};
    motion::PathOptions options;
    double least = HUGE_VAL;
    motion::PathAnswer answer;
    for (int k = 0; k < repeats; ++k) {
      const double begin = now();
      answer = cell->roadmap ? cell->roadmap->find(*cell->finder, start, goals, options)
                             : cell->finder->find(start, goals, options);
      least = std::min(least, now() - begin);
    }
    json said{{"problem", problem["problem"]},
              {"outcome", name_of(answer.outcome)},
              {"seconds", least},
              {"setup", cell->seconds},
              {"path", answer.path},
              {"length", length_of(answer.path)},
              {"straight", answer.straight},
              {"motions", answer.spent.motions},
              {"stretches", answer.spent.intervals},
              {"samples", answer.spent.samples},
              {"nodes", answer.spent.nodes},
              {"configurations", answer.spent.configurations}};
    if (answer.contact)
      said["contact"] = {cell->world->name_of(answer.contact->items[0]),
                         cell->world->name_of(answer.contact->items[1])};
    out << said << '\n';
  }
  return 0;
}

geom::Mesh mesh_of_link(const robot::Link& link, robot::MeshFiles& files) {
  geom::Mesh all;
  for (const robot::Geometry& g : link.collision) {
    using Shape = robot::Geometry::Shape;
    geom::Mesh mesh;
    geom::Vec3 scale = geom::Vec3::Ones();
    if (g.shape == Shape::Mesh) {
      mesh = io::read_mesh(files.first(g.mesh)).mesh;
      scale = g.size;
    } else {
      world::Primitive shape;
      shape.kind = g.shape == Shape::Box      ? world::Primitive::Kind::Box
                   : g.shape == Shape::Sphere ? world::Primitive::Kind::Sphere
                                              : world::Primitive::Kind::Cylinder;
      shape.size = g.size;
      shape.radius = g.size[0];
      shape.length = g.size[1];
      mesh = mesh_of(shape);
    }
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    for (const geom::Vec3& v : mesh.vertices)
      all.vertices.emplace_back(g.origin * v.cwiseProduct(scale));
    for (const geom::Triangle& t : mesh.triangles)
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return all;
}

/// Samples of a path that are in contact by the exact meshes.
struct Verdict {
  std::size_t samples = 0, contacts = 0;
  std::map<std::string, std::size_t> pairs;
};

Verdict judge(const judge::Cell& cell, judge::CellState& state, const robot::Path& path,
              double step) {
  Verdict out;
  for (std::size_t i = 1; i < path.size(); ++i) {
    double most = 0;
    for (std::size_t k = 0; k < path[i].size(); ++k)
      most = std::max(most, std::abs(path[i][k] - path[i - 1][k]));
    const auto parts = std::max(1.0, std::ceil(most / step));
    for (double p = i == 1 ? 0 : 1; p <= parts; ++p) {
      for (std::size_t k = 0; k < path[i].size(); ++k)
        state.q[0][k] = path[i - 1][k] + p / parts * (path[i][k] - path[i - 1][k]);
      ++out.samples;
      if (const auto meeting = cell.find_meeting(state)) {
        ++out.contacts;
        ++out.pairs[meeting->names[0] + " " + meeting->names[1]];
      }
    }
  }
  return out;
}

int judge_paths(int argc, char** argv) {
  const world::SceneFile scene = world::read_scene(argv[2]);
  const robot::RobotFile file = robot::read_robot(argv[3]);
  robot::MeshFiles files(file.path, {});
  const std::vector<json> problems = read_lines(argv[4]), paths = read_lines(argv[5]);
  std::ofstream out(argv[6]);
  const double step = std::atof(argv[7]);
  const world::RobotModel& model = scene.world.robots[0];
  std::vector<std::pair<std::uint32_t, geom::Mesh>> links;
  for (const world::LinkShape& shape : model.shapes)
    links.emplace_back(shape.link, mesh_of_link(file.robot.links[shape.link], files));
  std::unique_ptr<judge::Cell> cell;
  judge::CellState state;
  json objects;
  for (std::size_t i = 0; i < problems.size(); ++i) {
    if (!cell || objects != problems[i]["objects"]) {
      objects = problems[i]["objects"];
      cell = std::make_unique<judge::Cell>();
      cell->add_robot(model.name, model.kinematics, model.base);
      for (const auto& [link, mesh] : links) cell->add_link(0, link, mesh);
      for (const world::AllowedPair& pair : model.allowed)
        if (pair.reason == world::AllowedPair::Reason::Stated)
          cell->allow(model.name + "/" + model.kinematics.links[pair.a].name,
                      model.name + "/" + model.kinematics.links[pair.b].name);
      state = {{model.home}, {}};
      const world::World all = with_objects(scene.world, objects);
      for (const world::Object& object : all.objects) {
        cell->add_object(object.name, mesh_of(*object.primitive));
        state.objects.push_back({object.pose, {}, false});
      }
    }
    const Verdict v = judge(*cell, state, paths[i].get<robot::Path>(), step);
    out << json{{"samples", v.samples}, {"contacts", v.contacts}, {"pairs", v.pairs}} << '\n';
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc >= 5 && std::string(argv[1]) == "plan") return plan(argc, argv);
    if (argc >= 8 && std::string(argv[1]) == "judge") return judge_paths(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "path-query-benchmark: " << error.what() << '\n';
    return 1;
  }
  std::cerr << "usage: path-query-benchmark plan|judge ...\n";
  return 2;
}
