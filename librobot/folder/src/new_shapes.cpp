// New shapes of a robot's links, and the robot that has them.

#include <kaboum/robot/mesh_files.h>
#include <kaboum/robot_folder/new_shapes.h>

#include <algorithm>

namespace kaboum::robot_folder {
namespace {

namespace fs = std::filesystem;
using robot::Geometry;

std::string relative_to(const fs::path& file, const fs::path& folder,
                        const std::string& otherwise) {
  std::error_code error;
  const fs::path moved = fs::relative(file, fs::absolute(folder), error);
  return error ? otherwise : moved.generic_string();
}

/// Shapes that stay, named from the new folder.
class Keeper {
 public:
  Keeper(const robot::RobotFile& robot, const robot::ShapeChoice& choice, fs::path folder,
         KeptNames kept)
      : robot_(robot),
        choice_(choice),
        files_(robot.path, choice.packages),
        folder_(std::move(folder)),
        kept_(kept) {}

  void rename(std::vector<Geometry>& shapes) {
    for (Geometry& g : shapes) {
      if (g.shape != Geometry::Shape::Mesh) continue;
      g.mesh = kept_ == KeptNames::Files
                   ? relative_to(file_of(g.mesh), folder_, g.mesh)
                   : moved_reference(g.mesh, fs::absolute(robot_.path).parent_path(), folder_);
    }
  }

 private:
  [[nodiscard]] fs::path file_of(const std::string& reference) {
    if (!choice_.skip_missing) return files_.first(reference);
    const robot::FoundMesh found = files_.look_for(reference);
    return found.files.empty() ? fs::absolute(robot_.path).parent_path() / reference
                               : found.files.front();
  }

  const robot::RobotFile& robot_;
  const robot::ShapeChoice& choice_;
  robot::MeshFiles files_;
  fs::path folder_;
  KeptNames kept_;
};

/// The meshes that stand for a shape, or the shape.
void append(const Geometry& original, const NewShape& shape, const std::string& prefix,
            std::vector<Geometry>& out) {
  if (!shape.meshes) {
    out.push_back(original);
    return;
  }
  for (const std::string& mesh : *shape.meshes) {
    out.push_back(original);
    out.back().mesh = prefix + mesh;
  }
}

}  // namespace

std::string moved_reference(const std::string& reference, const fs::path& from,
                            const fs::path& to) {
  if (reference.find("://") != std::string::npos || fs::path(reference).is_absolute())
    return reference;
  return relative_to(from / reference, to, reference);
}

NewShapes new_shapes(
    const robot::RobotFile& robot, const robot::ShapeChoice& choice,
    const std::vector<robot::LinkShape>& shapes,
    const std::function<std::optional<std::vector<std::string>>(std::size_t shape)>& meshes_of) {
  NewShapes out(robot.robot.links.size());
  std::vector<std::size_t> count(out.size());
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    const robot::LinkShape& shape = shapes[s];
    NewShape& made = out[shape.link].emplace_back();
    made.first = count[shape.link];
    std::optional<std::vector<std::string>> meshes;
    if (shape.mesh) meshes = meshes_of(s);
    if (meshes) {
      count[shape.link] += meshes->size();
      made.meshes = std::move(meshes);
    } else if (shape.mesh) {
      ++count[shape.link];
    } else if (!robot::is_point(choice.shapes_of(robot.robot.links[shape.link])[shape.index])) {
      ++count[shape.link];
    }
  }
  const auto is_left_out = [](const NewShape& shape) {
    return shape.meshes && shape.meshes->empty();
  };
  robot::MeshFiles files(robot.path, choice.packages);
  const auto is_there = [&](const Geometry& g) {
    return g.shape != Geometry::Shape::Mesh || !files.look_for(g.mesh).files.empty();
  };
  if (choice.visual && choice.skip_missing)
    for (std::size_t l = 0; l < out.size(); ++l)
      if (std::ranges::all_of(out[l], is_left_out) &&
          std::ranges::all_of(robot.robot.links[l].collision, is_there))
        out[l].clear();  // what collided still does
  return out;
}

robot::Model new_model(const robot::RobotFile& robot, const robot::ShapeChoice& choice,
                       const NewShapes& shapes, const fs::path& folder, const std::string& prefix,
                       KeptNames kept) {
  robot::Model out{robot.robot, robot::dynamics_of(robot)};
  Keeper keeper(robot, choice, folder, kept);
  for (std::size_t l = 0; l < shapes.size(); ++l) {
    robot::Link& link = out.robot.links[l];
    if (shapes[l].empty()) {
      keeper.rename(link.collision);
    } else {
      std::vector<Geometry> originals = choice.shapes_of(robot.robot.links[l]);
      keeper.rename(originals);  // of those that stay
      link.collision.clear();
      for (std::size_t i = 0; i < shapes[l].size(); ++i)
        append(originals[i], shapes[l][i], prefix, link.collision);
    }
    if (kept == KeptNames::Files)
      link.visual.clear();  // of formats that have none
    else
      keeper.rename(link.visual);
  }
  return out;
}

}  // namespace kaboum::robot_folder
