// Copies of robots' files with other shapes, each in its own format.

#include "robot_document.h"

#include <kaboum/robot/sdf.h>

#include <filesystem>
#include <set>
#include <utility>

#include "robot_urdf.h"

namespace kaboum::robot_folder {
namespace {

namespace fs = std::filesystem;

/// MJCF or SDF, which their readers edit.
class EditedDocument : public RobotDocument {
 public:
  EditedDocument(const robot::RobotFile& robot, fs::path folder)
      : robot_(robot), from_(fs::absolute(robot.path).parent_path()), folder_(std::move(folder)) {}

  [[nodiscard]] std::vector<std::string> mesh_stems() const override {
    std::vector<std::string> out;
    for (const robot::Link& link : robot_.robot.links)
      for (const auto* shapes : {&link.collision, &link.visual})
        for (const robot::Geometry& g : *shapes)
          if (g.shape == robot::Geometry::Shape::Mesh)
            out.push_back(fs::path(g.mesh).stem().string());
    return out;
  }

  void require_shapes(const std::string& /*link*/, bool /*visual*/,
                      std::size_t /*shapes*/) override {}  // they are read by the same reader

  void leave_out(const std::string& mesh) override { left_out_.insert(mesh); }

  std::string text(const NewShapes& shapes, bool visual, const MeshNames& names) override {
    const bool sdf = robot_.format == robot::RobotFile::Format::Sdf;
    robot::ShapeEdit edit;
    edit.visual = visual;
    edit.left_out = left_out_;
    edit.moved = [&](const std::string& file) { return moved_reference(file, from_, folder_); };
    for (const std::vector<NewShape>& link : shapes) {
      std::vector<robot::ShapeMeshes>& to = edit.links.emplace_back();
      for (const NewShape& shape : link) to.push_back(shape.meshes);
      if (!sdf) continue;
      for (robot::ShapeMeshes& meshes : to)
        if (meshes)
          for (std::string& mesh : *meshes) mesh.insert(0, names.prefix);
    }
    const std::string file = robot_.path.string();
    return sdf ? robot::sdf_with_shapes(robot_.text, file, edit)
               : robot::mjcf_with_shapes(robot_.text, file, edit);
  }

 private:
  const robot::RobotFile& robot_;
  fs::path from_, folder_;
  std::set<std::string> left_out_;
};

}  // namespace

std::unique_ptr<RobotDocument> document_of(const robot::RobotFile& robot, const fs::path& folder) {
  using Format = robot::RobotFile::Format;
  if (robot.format == Format::Mjcf || robot.format == Format::Sdf)
    return std::make_unique<EditedDocument>(robot, folder);
  return std::make_unique<RobotUrdf>(robot, folder);
}

}  // namespace kaboum::robot_folder
