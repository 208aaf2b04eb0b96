#pragma once

#include <kaboum/verify/held_shape.h>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "notes.h"
#include "robot_meshes.h"
#include "robot_verdict.h"
#include "verdict.h"
#include "verify_robot.h"

namespace kaboum::tools {

/// Meshes of a link of the original that have one frame, and those that are to hold them.
struct MeshGroup {
  std::vector<const RobotMeshes::File*> originals, bodies;
  geom::Vec3 scale;  ///< absolute
};

/// What was found of a group.
struct GroupFindings {
  std::vector<Finding> originals;
  std::optional<Finding> distance;  ///< of the bodies, where it was asked for and all are held
};

/// Judges meshes of robots as the options say, and keeps what is to be said with the verdict.
class RobotJudge {
 public:
  /// @param show  called with what is being decided
  /// @throws Error{InvalidArgument} on a malformed --epsilon
  RobotJudge(const VerifyRobotOptions& options, std::function<void(const std::string&)> show);

  /// The same meshes with the same bodies, as many links have them, are judged once.
  /// @throws Error naming the file
  const GroupFindings& judge(const MeshGroup& group);

  /// Whether distances are asked for.
  [[nodiscard]] bool measures() const { return epsilon_.has_value(); }
  /// Whether an open mesh was judged.
  [[nodiscard]] bool open() const { return open_; }
  [[nodiscard]] const DroppedSheets& dropped() const { return dropped_; }
  Notes notes;

 private:
  GroupFindings decide(const MeshGroup& group);
  geom::Mesh judged_mesh(const RobotMeshes::File& file);
  Finding hold(const RobotMeshes::File& file, const geom::Mesh& mesh,
               const verify::Holders& holders);
  Finding distance(const MeshGroup& group, const std::vector<geom::Mesh>& originals,
                   const verify::Holders& holders);
  void note(const std::string& path, const std::vector<std::string>& texts);

  const VerifyRobotOptions& o_;
  std::function<void(const std::string&)> show_;
  std::optional<kaboum::Length> epsilon_;
  verify::InclusionOptions limits_;
  using Key = std::tuple<std::vector<const RobotMeshes::File*>,
                         std::vector<const RobotMeshes::File*>, double, double, double>;
  std::map<Key, GroupFindings> judged_;
  bool open_ = false;
  DroppedSheets dropped_;
};

}  // namespace kaboum::tools
