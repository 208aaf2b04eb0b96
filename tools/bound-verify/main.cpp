// Decides from files alone whether what was made of a mesh, a robot or a motion keeps its promise.
#include "commands.h"

#include <CLI/CLI.hpp>
#include <iostream>

#include "mesh.h"
#include "progressive.h"
#include "robot.h"
#include "sweep.h"

namespace {

using namespace kaboum;
using tools::VerifyOptions;

int verify_mesh(const VerifyOptions& o) {
  tools::VerifyMeshOptions mesh;
  mesh.relation = o.cover   ? verify::Relation::Cover
                  : o.inner ? verify::Relation::Inner
                            : verify::Relation::Outer;
  mesh.original = o.original;
  mesh.approximation = o.approximation;
  mesh.original_format = o.original_format;
  mesh.approximation_format = o.approximation_format;
  mesh.unit = o.unit;
  mesh.epsilon = o.epsilon;
  mesh.witness = o.witness;
  mesh.claims = o.claims;
  mesh.prepare = is_prepared(o);
  mesh.drop_sheets = o.drop_sheets;
  mesh.set = o.set;
  mesh.max_contacts = o.max_contacts;
  mesh.max_work = o.max_work;
  mesh.exact_points = o.exact_points;
  return tools::verify_mesh(mesh, o.common);
}

int verify_robot(const VerifyOptions& o) {
  tools::VerifyRobotOptions robot;
  robot.original = o.original;
  robot.result = o.approximation;
  robot.claims = o.claims;
  robot.geometry = o.geometry;
  robot.epsilon = o.epsilon;
  robot.packages = o.packages;
  robot.links = tools::split_names(o.links);
  robot.prepare = o.prepare;
  robot.drop_sheets = o.drop_sheets;
  robot.max_contacts = o.max_contacts;
  robot.max_work = o.max_work;
  robot.exact_points = o.exact_points;
  return tools::verify_robot(robot, o.common);
}

int verify_sweep(const VerifyOptions& o) {
  tools::VerifySweepOptions sweep;
  sweep.files = o.sweep;
  sweep.links = o.links;
  sweep.geometry = o.geometry;
  sweep.gap = o.gap;
  sweep.claims = o.claims;
  sweep.witness = o.witness;
  sweep.set_format = o.approximation_format;
  sweep.packages = o.packages;
  sweep.joints = o.joints;
  sweep.base_pose = o.base_pose;
  sweep.prepare = is_prepared(o);
  sweep.drop_sheets = o.drop_sheets;
  sweep.degrees = o.degrees;
  sweep.max_cells = o.max_cells;
  sweep.exact_points = o.exact_points;
  return tools::verify_sweep(sweep, o.common);
}

int decide(const VerifyOptions& o) {
  if (!o.sweep.empty()) return verify_sweep(o);
  if (o.robot) return verify_robot(o);
  if (o.progressive)
    return tools::verify_progressive(o.original, o.original_format, o.unit, o.approximation,
                                     o.common);
  return verify_mesh(o);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Decides from files alone, in exact arithmetic, whether what was made of a mesh, a robot or "
      "a motion keeps its promise. Each command's own --help has its options:\n"
      "\n"
      "  bound-verify mesh --outer ORIGINAL RESULT    a mesh encloses the original\n"
      "  bound-verify mesh --inner ORIGINAL RESULT    a mesh is enclosed by it\n"
      "  bound-verify cover ORIGINAL SET              convex bodies cover a mesh\n"
      "  bound-verify robot ORIGINAL RESULT           a robot's shapes hold another's\n"
      "  bound-verify sweep ROBOT PATH SWEPT          convex bodies hold a motion\n"
      "  bound-verify progressive ORIGINAL FILE       all levels of a progressive file",
      "bound-verify");
  VerifyOptions options;
  tools::add_commands(app, options);
  app.footer(tools::kVerifyExitCodes);
  if (const std::string command = tools::command_instead(argc, argv); !command.empty()) {
    std::cerr << "bound-verify: " << command << " (see bound-verify --help)\n";
    return tools::kUsage;
  }
  return tools::run(app, argc, argv, [&] { return decide(options); });
}
