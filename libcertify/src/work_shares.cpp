// One budget of work for all meshes of a robot.

#include "work_shares.h"

#include <bit>
#include <cstdint>
#include <system_error>

namespace kaboum::certify {
namespace {

std::optional<double> robot_work(const SetRequest& request) {
  if (request.improve_work || request.effort != bcd::Effort::Normal) return request.improve_work;
  return kRobotWork;
}

/// A file that is not there is told of when it is read.
double weight_of(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  return error ? 1 : static_cast<double>(std::bit_ceil(std::uint64_t{size}));
}

}  // namespace

std::vector<std::optional<double>> work_of_meshes(const robot::LinkMeshes& meshes,
                                                  const SetRequest& request) {
  std::vector<std::optional<double>> out(meshes.meshes.size());
  const std::optional<double> all = robot_work(request);
  if (!all) return out;
  std::vector<double> weights;
  double sum = 0;
  for (const robot::LinkMesh& mesh : meshes.meshes)
    sum += weights.emplace_back(weight_of(mesh.file));
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = *all * weights[i] / sum;
  return out;
}

}  // namespace kaboum::certify
