// Meshes of robots: prepared as asked, judged by the verifier's library, each group once.
#include "robot_judge.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <cmath>

#include "prepared_original.h"

namespace kaboum::tools {

using verify::Answer;
using File = RobotMeshes::File;

namespace {

bool changes_by_preparing(const geom::Mesh& mesh) {
  try {
    return !prepare_original(mesh, false, true).report.notes.empty();
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

RobotJudge::RobotJudge(const VerifyRobotOptions& options,
                       std::function<void(const std::string&)> show)
    : o_(options), show_(std::move(show)), epsilon_(epsilon_of(options.epsilon)) {
  limits_.max_contacts = o_.max_contacts;
  limits_.max_work = o_.max_work;
}

const GroupFindings& RobotJudge::judge(const MeshGroup& group) {
  const Key key{group.originals, group.bodies, group.scale.x(), group.scale.y(), group.scale.z()};
  const auto at = judged_.find(key);
  return at != judged_.end() ? at->second : judged_.emplace(key, decide(group)).first->second;
}

GroupFindings RobotJudge::decide(const MeshGroup& group) {
  std::vector<verify::Holders::NamedMesh> named;
  named.reserve(group.bodies.size());
  for (const File* file : group.bodies) named.push_back({file->path, &file->mesh});
  const verify::Holders holders(named);
  for (const auto& [path, why] : holders.left_out()) note(path, {why});
  GroupFindings out;
  std::vector<geom::Mesh> meshes;
  bool held = true;
  for (const File* file : group.originals) {
    show_(file->path);
    meshes.push_back(judged_mesh(*file));
    out.originals.push_back(hold(*file, meshes.back(), holders));
    held = held && out.originals.back().answer == Answer::Verified;
  }
  if (epsilon_ && held) out.distance = distance(group, meshes, holders);
  return out;
}

/// As the file is, or as prepared.
geom::Mesh RobotJudge::judged_mesh(const File& file) {
  note(file.path, file.notes);
  if (!o_.prepare) {
    if (const auto found = find_inside_out(file.mesh)) note(file.path, {text_of(*found)});
    return file.mesh;
  }
  const geom::Prepared prepared =
      naming(file.path, [&] { return prepare_original(file.mesh, o_.drop_sheets, true); });
  note(file.path, prepared.report.notes);
  if (prepared.report.dropped_sheets > 0) dropped_[file.path] = prepared.report.dropped_sheets;
  return prepared.solid.mesh();
}

Finding RobotJudge::hold(const File& file, const geom::Mesh& mesh, const verify::Holders& holders) {
  const verify::HeldShape held =
      naming(file.path, [&] { return holders.hold(mesh, claims_of(o_.claims), limits_); });
  open_ = open_ || (held.decisive && !held.inclusion->inner_closed);
  if (held.decisive && held.answer != Answer::Verified && !o_.prepare && changes_by_preparing(mesh))
    note(file.path, {"bcd-decompose speaks of the mesh as prepared; --prepare judges that"});
  return finding_of(held, holders, o_.prepare);
}

/// How far the bodies of a group are from all of its originals together.
Finding RobotJudge::distance(const MeshGroup& group, const std::vector<geom::Mesh>& originals,
                             const verify::Holders& holders) {
  double diagonal = 0;
  for (const geom::Mesh& mesh : originals)
    diagonal = std::max(diagonal, geom::bounding_box(mesh).diagonal());
  const verify::ScaledBound scaled = verify::scaled_bound(*epsilon_, diagonal, group.scale);
  if (!(scaled.bound > 0) || !std::isfinite(scaled.bound))
    throw Error(ErrorCode::InvalidInput, o_.original + ": --epsilon is no length in the unit of " +
                                             group.originals.front()->path + ", whose scale is " +
                                             number(group.scale.maxCoeff()));
  show_("distance to " + group.originals.front()->path);
  return finding_of(holders.distance(originals, scaled.bound, limits_), scaled);
}

void RobotJudge::note(const std::string& path, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) notes.add(path, text);
}

}  // namespace kaboum::tools
