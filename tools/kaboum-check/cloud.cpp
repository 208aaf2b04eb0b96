// The option --cloud of kaboum-check: points of a sensor as obstacles.

#include "cloud.h"

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/io/point_cloud.h>
#include <kaboum/robot/base_pose.h>
#include <kaboum/world/cloud.h>

#include <filesystem>
#include <sstream>

namespace kaboum::tools {
namespace {

/// @throws Error{InvalidInput} for what would be another cloud than is meant
void require_meant(const io::PointCloud& cloud, const CheckOptions& o, const std::string& file) {
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorCode::InvalidInput, file + ": " + what);
  };
  if (cloud.invalid > 0 && !o.cloud_drop_invalid)
    refuse("point " + std::to_string(cloud.first_invalid) +
           " has a coordinate that is NaN or infinite (" + std::to_string(cloud.invalid) + " of " +
           std::to_string(cloud.invalid + cloud.points.size()) +
           "); if these are where the sensor saw nothing, leave them out with "
           "--cloud-drop-invalid");
  if (cloud.has_viewpoint && o.cloud_pose.empty())
    refuse(
        "its VIEWPOINT says that the sensor was elsewhere than in the origin, not in which frame "
        "the points are; say where that frame is with --cloud-pose (0,0,0 where it is the "
        "scene's)");
}

/// How many points, and where: points in another unit or frame are noticed by that.
std::string words_of(const io::PointCloud& cloud, const geom::Transform& pose,
                     const std::string& unit) {
  geom::Box3 box;
  for (const geom::Vec3& p : cloud.points) box.extend(pose * p);
  std::ostringstream out;
  out.precision(4);
  out << cloud.points.size() << " points from [" << box.min.x() << ", " << box.min.y() << ", "
      << box.min.z() << "] to [" << box.max.x() << ", " << box.max.y() << ", " << box.max.z()
      << "] " << unit;
  if (cloud.invalid > 0) out << "; " << cloud.invalid << " without finite coordinates are left out";
  return out.str();
}

}  // namespace

void require_cloud_meaning(const CheckOptions& o) {
  const auto no = [](const std::string& text) { throw Error(ErrorCode::InvalidArgument, text); };
  if (o.clouds.empty()) {
    if (o.cloud_radius || !o.cloud_pose.empty() || o.cloud_drop_invalid || !o.cloud_allow.empty())
      no("--cloud-radius, --cloud-pose, --cloud-allow and --cloud-drop-invalid need --cloud");
    return;
  }
  if (!o.cloud_radius)
    no("--cloud needs --cloud-radius: how far from a point what the sensor saw may be");
  if (o.engine.library != engines::Library::Own) no("--cloud is for own predicates, not --engine");
}

void add_clouds(const CheckOptions& o, world::World& world, std::vector<std::string>& notes,
                Json& report) {
  if (o.clouds.empty()) return;
  const double radius = o.cloud_radius->in(world.unit).of(0);
  const geom::Transform pose =
      o.cloud_pose.empty() ? geom::Transform() : robot::parse_pose(o.cloud_pose, "--cloud-pose");
  for (const std::string& file : o.clouds) {
    const std::vector<char> bytes = io::read_file(file);
    io::PointCloud cloud = io::parse_point_cloud(bytes, file);
    require_meant(cloud, o, file);
    const std::string name = std::filesystem::path(file).stem().string();
    notes.push_back(file + ": " + words_of(cloud, pose, world.unit));
    report["clouds"].push_back({{"name", name},
                                {"file", file},
                                {"sha256", io::sha256(bytes)},
                                {"points", cloud.points.size()},
                                {"invalid", cloud.invalid},
                                {"radius", radius}});
    add_cloud(world, {.name = name,
                      .points = std::move(cloud.points),
                      .numbers = std::move(cloud.numbers),
                      .radius = radius,
                      .pose = pose,
                      .allow = o.cloud_allow});
  }
}

}  // namespace kaboum::tools
