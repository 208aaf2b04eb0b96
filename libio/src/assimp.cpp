// FBX through assimp, which delivers float32 coordinates in a tree of nodes. No post-processing
// step runs: none of them may merge, drop or reorder geometry; polygons are split by our own
// splitter. It runs in a child process: damaged and even some valid files make it crash.

#include <assimp/scene.h>
#include <kaboum/base/error.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <memory>

#include "builder.h"
#include "child.h"
#include "fbx_objects.h"
#include "formats.h"
#include "scene_copier.h"
#include "text.h"

namespace kaboum::io {
namespace {

constexpr int kMaxNodeDepth = 1000;
constexpr const char* kName = "kaboum-input.fbx";

class MemoryStream : public Assimp::IOStream {
 public:
  explicit MemoryStream(std::string_view bytes) : bytes_(bytes) {}

  size_t Read(void* buffer, size_t size, size_t count) override {
    if (size == 0) return 0;
    const std::size_t items = std::min(count, (bytes_.size() - at_) / size);
    if (items > 0) std::memcpy(buffer, bytes_.data() + at_, items * size);
    at_ += items * size;
    return items;
  }
  size_t Write(const void* /*buffer*/, size_t /*size*/, size_t /*count*/) override { return 0; }
  aiReturn Seek(size_t offset, aiOrigin origin) override {
    const std::size_t base = origin == aiOrigin_SET   ? 0
                             : origin == aiOrigin_CUR ? at_
                                                      : bytes_.size();
    // Backward offsets come as wrapped-around unsigned numbers.
    const std::size_t target = base + offset;
    if (target > bytes_.size()) return aiReturn_FAILURE;
    at_ = target;
    return aiReturn_SUCCESS;
  }
  [[nodiscard]] size_t Tell() const override { return at_; }
  [[nodiscard]] size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

/// Shows assimp the file in memory and no other.
class OnlyThisFile : public Assimp::IOSystem {
 public:
  explicit OnlyThisFile(const Source& source) : source_(source) {}

  bool Exists(const char* file) const override { return std::string_view(file) == kName; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return Exists(file) && mode[0] == 'r' ? new MemoryStream(source_.bytes) : nullptr;
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  const Source& source_;
};

Placement placement_of(const aiMatrix4x4& m) {
  Placement result;
  for (unsigned i = 0; i < 3; ++i) {
    for (unsigned k = 0; k < 3; ++k) result.linear(i, k) = static_cast<double>(m[i][k]);
    result.translation[i] = static_cast<double>(m[i][3]);
  }
  return result;
}

/// Copies the scene's meshes, once per node that refers to them, into the builder.
class AssimpReader {
 public:
  AssimpReader(const Source& source, const aiScene& scene, MeshBuilder& builder)
      : source_(source), scene_(scene), copier_(builder) {}

  void read() {
    if (scene_.mRootNode == nullptr)
      fail(source_, "the file has no scene; export it with its geometry");
    read_node(*scene_.mRootNode, {}, 0);
    copier_.add_notes();
  }

 private:
  void read_node(const aiNode& node, const Placement& parent, int depth) {
    if (depth > kMaxNodeDepth)
      fail(source_, "nodes are nested more than " + std::to_string(kMaxNodeDepth) +
                        " deep; flatten the scene");
    const Placement placement = parent * placement_of(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      if (node.mMeshes[i] >= scene_.mNumMeshes)
        fail(source_, "a node refers to a mesh that does not exist; the file is damaged");
      read_mesh(*scene_.mMeshes[node.mMeshes[i]], placement);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i)
      read_node(*node.mChildren[i], placement, depth + 1);
  }

  void read_mesh(const aiMesh& mesh, const Placement& placement) {
    points_.clear();
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& v = mesh.mVertices[i];
      points_.emplace_back(v.x, v.y, v.z);
    }
    copier_.add_points(points_, placement, source_.begin());
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      const std::span<const unsigned> corners(face.mIndices, face.mNumIndices);
      for (const unsigned corner : corners)
        if (corner >= mesh.mNumVertices)
          fail(source_, "a face refers to vertex " + std::to_string(corner) +
                            ", but its mesh has " + std::to_string(mesh.mNumVertices) +
                            "; the file is damaged");
      copier_.add_face(corners, source_.begin());
    }
  }

  const Source& source_;
  const aiScene& scene_;
  SceneCopier copier_;
  std::vector<geom::Vec3> points_;
};

/// The file's unit, a centimetre where it states none; 0: not known. The importer keeps it as a
/// float, as which 0.1 is another number: the decimal fraction that it was is taken.
double centimetres_of(const aiScene& scene) {
  float kept = 0;
  if (scene.mMetaData == nullptr || !scene.mMetaData->Get("UnitScaleFactor", kept)) return 0;
  std::array<char, 64> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), kept);
  double unit = 0;
  std::from_chars(text.data(), end, unit);
  return std::isfinite(unit) ? unit : 0;
}

ReadResult read_here(const Source& source) {
  Assimp::Importer importer;
  importer.SetIOHandler(std::make_unique<OnlyThisFile>(source).release());
  const aiScene* scene = nullptr;
  try {
    scene = importer.ReadFile(kName, 0);
  } catch (const std::exception& e) {
    fail(source, std::string("the importer failed: ") + e.what());
  }
  if (scene == nullptr)
    fail(source, std::string("the file cannot be read as fbx: ") + importer.GetErrorString() +
                     "; check its format");
  MeshBuilder builder(source);
  builder.note("The importer (assimp) delivers 32-bit floats; those are taken as the input.");
  AssimpReader(source, *scene, builder).read();
  if (const double unit = centimetres_of(*scene); unit > 0) {
    builder.set_unit(unit * 0.01);
    if (unit != 1)
      builder.note("The file's unit is " + shortest_digits(unit) +
                   " centimetres; coordinates were not scaled.");
  }
  return builder.finish(Format::Fbx, true);
}

}  // namespace

bool has_assimp() { return true; }

ReadResult read_fbx(const Source& source) {
  std::vector<std::string> notes = check_fbx_objects(source);
  ReadResult result =
      read_in_child(source, child_limits(source.bytes.size()), [&] { return read_here(source); });
  std::ranges::move(notes, std::back_inserter(result.notes));
  return result;
}

}  // namespace kaboum::io
