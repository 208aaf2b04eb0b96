// Enclosing meshes of a robot's links: several at a time, each from the cache where possible.

#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/certify/link_enclosures.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>

namespace kaboum::certify {
namespace {

EnclosureRequest request_of(const LinkEnclosuresRequest& request, const robot::LinkMesh& mesh,
                            const std::optional<Length>& epsilon) {
  EnclosureRequest out = request.mesh;
  if (epsilon) out.mesh.epsilon = epsilon;
  if (out.mesh.epsilon) out.mesh.epsilon = in_unit_of_mesh(*out.mesh.epsilon, mesh.scale);
  if (out.wrap)
    for (std::optional<Length>* length : {&out.wrap->offset, &out.wrap->seal})
      if (*length) *length = in_unit_of_mesh(**length, mesh.scale);
  return out;
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

std::vector<std::vector<robot::LinkShape>> LinkEnclosures::shapes_by_link() const {
  std::vector<std::vector<robot::LinkShape>> out;
  for (const robot::LinkShape& shape : shapes) {
    if (out.empty() || out.back().front().link != shape.link) out.emplace_back();
    out.back().push_back(shape);
  }
  return out;
}

LinkEnclosures enclose_links(const robot::RobotFile& robot, const LinkEnclosuresRequest& request,
                             const CacheFolder* cache,
                             const std::function<void(const std::string& stage)>& progress) {
  WantedMeshes found = wanted_meshes(robot, request.shapes, request.epsilons);
  if (found.meshes.empty())
    throw Error(ErrorCode::InvalidInput,
                robot.path.string() + ": no link has a mesh" +
                    (request.shapes.visual ? std::string() : "; try «geometry=visual»"));
  LinkEnclosures out;
  out.meshes.resize(found.meshes.size());
  std::vector<std::exception_ptr> flaws(found.meshes.size());
  std::mutex mutex;
  std::size_t done = 0;
  const auto caller = std::this_thread::get_id();
  parallel_for(
      std::size_t{0}, found.meshes.size(),
      [&](std::size_t i) {
        const double start = now();
        // Within a mesh only the calling thread tells: what it is told to end, ends.
        MeshHooks hooks;
        bool ended = false;  // by the hook: that is no mesh's flaw
        if (progress && std::this_thread::get_id() == caller)
          hooks.progress = [&](const std::string& stage) {
            const std::lock_guard lock(mutex);
            ended = true;
            progress(found.meshes[i].file.filename().string() + ": " + stage);
            ended = false;
          };
        EnclosedLinkMesh& mesh = out.meshes[i];
        mesh.mesh = found.meshes[i];
        if (!mesh.mesh.missing.empty()) {
          mesh.flaw = mesh.mesh.missing;
          flaws[i] = std::make_exception_ptr(Error(ErrorCode::InvalidInput, mesh.flaw));
          return;
        }
        const EnclosureRequest asked = request_of(request, mesh.mesh, found.epsilons[i]);
        mesh.epsilon = asked.mesh.epsilon;
        try {
          mesh.made = enclose_file(mesh.mesh.file, request.format, asked, cache, hooks);
        } catch (const Error& error) {
          if (ended || !request.partial ||
              (error.code() != ErrorCode::InvalidInput && error.code() != ErrorCode::LimitReached))
            throw;
          mesh.flaw = error.what();
          flaws[i] = std::current_exception();
        }
        mesh.seconds = now() - start;
        if (!progress) return;
        const std::lock_guard lock(mutex);
        progress(std::to_string(++done) + " of " + std::to_string(found.meshes.size()) +
                 " meshes enclosed");
      },
      {.alone = true});
  if (std::ranges::all_of(flaws, [](const auto& flaw) { return flaw != nullptr; }))
    std::rethrow_exception(flaws.front());
  for (const EnclosedLinkMesh& mesh : out.meshes) {
    if (mesh.mesh.missing.empty()) out.files.push_back(mesh.mesh.file);
    out.files.insert(out.files.end(), mesh.made.other_files.begin(), mesh.made.other_files.end());
  }
  out.files.insert(out.files.end(), found.files.begin(), found.files.end());
  out.shapes = std::move(found.shapes);
  return out;
}

}  // namespace kaboum::certify
