// What proofs about a robot's own pairs of links depend on, and what they prove, as hashes.

#include <kaboum/io/mesh_io.h>
#include <kaboum/world/scene.h>

#include <cmath>
#include <cstdio>
#include <set>

namespace kaboum::world {
namespace {

void append(std::string& text, double x) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%a ", x);
  text += buffer;
}

void append(std::string& text, const Transform& t) {
  for (int i = 0; i < 9; ++i) append(text, t.linear(i / 3, i % 3));
  for (int i = 0; i < 3; ++i) append(text, t.translation[i]);
}

}  // namespace

std::string fingerprint_of(const RobotModel& robot) {
  std::string text = "pairs 1\n";
  for (const robot::Joint& joint : robot.kinematics.joints) {
    text += std::to_string(static_cast<int>(joint.type)) + " " + std::to_string(joint.parent) +
            " " + std::to_string(joint.variable) + " ";
    append(text, joint.origin);
    for (int i = 0; i < 3; ++i) append(text, joint.axis[i]);
    append(text, joint.multiplier);
    append(text, joint.offset);
    text += "\n";
  }
  for (const robot::Variable& v : robot.kinematics.variables) {
    append(text, v.lower.value_or(-HUGE_VAL));
    append(text, v.upper.value_or(HUGE_VAL));
    text += "\n";
  }
  for (const LinkShape& shape : robot.shapes) {
    text += robot.kinematics.links[shape.link].name + "\n";
    for (std::size_t i = 0; i < shape.outer.size(); ++i) {
      append(text, shape.outer.body(i).radius);
      for (const Vec3& p : shape.outer.body(i).core.vertices)
        for (int k = 0; k < 3; ++k) append(text, p[k]);
      text += "\n";
    }
  }
  return io::sha256(text);
}

std::string proof_hash(const RobotModel& robot, const std::vector<AllowedPair>& pairs) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> links;
  for (const AllowedPair& pair : pairs) links.emplace(pair.a, pair.b);
  std::string text = robot.fingerprint + "\n";
  for (const auto& [a, b] : links)
    text += robot.kinematics.links[a].name + "\n" + robot.kinematics.links[b].name + "\n";
  return io::sha256(text);
}

}  // namespace kaboum::world
