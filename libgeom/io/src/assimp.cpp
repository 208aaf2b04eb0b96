// FBX through assimp, which delivers float32 coordinates in a tree of
// nodes. No post-processing step runs: none of them may merge, drop or reorder geometry; polygons
// are split by our own splitter. It runs in a child process: damaged and even some valid files make
// it crash.

#include <assimp/scene.h>
#include <kaboum/geom/error.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include <Eigen/Dense>
#include <algorithm>
#include <cstring>
#include <memory>
#include <set>

#include "builder.h"
#include "child.h"
#include "fbx_objects.h"
#include "formats.h"

namespace kaboum::io {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxNodeDepth = 1000;

class MemoryStream : public Assimp::IOStream {
 public:
  explicit MemoryStream(std::string_view bytes) : bytes_(bytes) {}
  MemoryStream(std::vector<char>&& owned)
      : owned_(std::move(owned)), bytes_(owned_.data(), owned_.size()) {}

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
  std::vector<char> owned_;
  std::string_view bytes_;
  std::size_t at_ = 0;
};

/// Shows assimp the file in memory and, read-only, the regular files of its directory.
class MemoryWithDirectory : public Assimp::IOSystem {
 public:
  MemoryWithDirectory(const Source& source, std::string main)
      : source_(source), main_(std::move(main)) {}

  bool Exists(const char* file) const override {
    std::error_code ignored;
    return file == main_ || (may_open(file) && fs::is_regular_file(resolve(file), ignored));
  }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (file == main_) return new MemoryStream(source_.bytes);
    if (mode[0] != 'r' || !Exists(file)) return nullptr;
    try {
      auto stream = std::make_unique<MemoryStream>(read_file(resolve(file)));
      others_.insert(resolve(file).string());
      return stream.release();
    } catch (const Error&) {
      return nullptr;  // assimp reports the missing file
    }
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

  [[nodiscard]] const std::set<std::string>& others() const { return others_; }

 private:
  [[nodiscard]] bool may_open(const char* file) const {
    return !source_.directory.empty() && *file != '\0' && fs::path(file).is_relative();
  }
  [[nodiscard]] fs::path resolve(const char* file) const { return source_.directory / file; }

  const Source& source_;
  std::string main_;
  std::set<std::string> others_;
};

Eigen::Matrix4d in_double(const aiMatrix4x4& m) {
  Eigen::Matrix4d result;
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned k = 0; k < 4; ++k) result(i, k) = static_cast<double>(m[i][k]);
  return result;
}

/// Copies the scene's meshes, once per node that refers to them, into the builder.
class SceneReader {
 public:
  SceneReader(const Source& source, const aiScene& scene, MeshBuilder& builder)
      : source_(source), scene_(scene), builder_(builder) {}

  void read() {
    if (scene_.mRootNode == nullptr)
      fail(source_, "the file has no scene; export it with its geometry");
    read_node(*scene_.mRootNode, Eigen::Matrix4d::Identity(), 0);
    if (placed_)
      builder_.note(
          "Coordinates are the importer's, moved by the nodes' transforms in rounded double "
          "precision.");
    if (mirrored_)
      builder_.note(
          "Transforms with negative determinant mirror meshes; their faces were reversed.");
    if (deformed_)
      builder_.note("Skins and morph targets were ignored; the mesh is in its rest pose.");
  }

 private:
  void read_node(const aiNode& node, const Eigen::Matrix4d& parent, int depth) {
    if (depth > kMaxNodeDepth)
      fail(source_, "nodes are nested more than " + std::to_string(kMaxNodeDepth) +
                        " deep; flatten the scene");
    const Eigen::Matrix4d placement = parent * in_double(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      if (node.mMeshes[i] >= scene_.mNumMeshes)
        fail(source_, "a node refers to a mesh that does not exist; the file is damaged");
      read_mesh(*scene_.mMeshes[node.mMeshes[i]], placement);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i)
      read_node(*node.mChildren[i], placement, depth + 1);
  }

  void read_mesh(const aiMesh& mesh, const Eigen::Matrix4d& placement) {
    // Shared meshes multiply: nodes are bounded by the file, their product is not.
    copied_ += mesh.mNumVertices + std::uint64_t{mesh.mNumFaces};
    if (copied_ > 10'000'000 + 64 * std::uint64_t{source_.bytes.size()})
      throw Error(ErrorCode::LimitReached,
                  std::string(source_.name) + ": instances repeat too much; simplify the scene");
    const Eigen::Matrix3d linear = placement.topLeftCorner<3, 3>();
    const geom::Vec3 offset = placement.topRightCorner<3, 1>();
    const bool identity = placement == Eigen::Matrix4d::Identity();
    const bool mirrored = linear.determinant() < 0;
    const std::size_t first = builder_.point_count();
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& v = mesh.mVertices[i];
      const geom::Vec3 p(v.x, v.y, v.z);
      builder_.add_point(identity ? p : geom::Vec3(linear * p + offset), source_.begin());
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) read_face(mesh, mesh.mFaces[i], first, mirrored);
    placed_ |= !identity;
    mirrored_ |= mirrored;
    deformed_ |= mesh.mNumBones > 0 || mesh.mNumAnimMeshes > 0;
  }

  void read_face(const aiMesh& mesh, const aiFace& face, std::size_t first, bool reversed) {
    corners_.clear();
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices)
        fail(source_, "a face refers to vertex " + std::to_string(face.mIndices[k]) +
                          ", but its mesh has " + std::to_string(mesh.mNumVertices) +
                          "; the file is damaged");
      corners_.push_back(static_cast<std::uint32_t>(first + face.mIndices[k]));
    }
    if (reversed) std::ranges::reverse(corners_);
    builder_.add_face(corners_, source_.begin());
  }

  const Source& source_;
  const aiScene& scene_;
  MeshBuilder& builder_;
  std::vector<std::uint32_t> corners_;
  std::uint64_t copied_ = 0;
  bool placed_ = false;
  bool mirrored_ = false;
  bool deformed_ = false;
};

void add_unit_notes(MeshBuilder& builder, const aiScene& scene, Format format) {
  if (format == Format::Fbx) {
    double unit = 0;
    if (scene.mMetaData != nullptr && scene.mMetaData->Get("UnitScaleFactor", unit) && unit != 1)
      builder.note("The file's unit is " + std::to_string(unit) +
                   " centimetres; coordinates were not scaled.");
  }
}

ReadResult read_here(const Source& source, Format format) {
  if (format == Format::Fbx) check_fbx_objects(source);
  const std::string main = "kaboum-input.fbx";
  Assimp::Importer importer;
  auto files = std::make_unique<MemoryWithDirectory>(source, main);
  const MemoryWithDirectory& opened = *files;
  importer.SetIOHandler(files.release());
  const aiScene* scene = nullptr;
  try {
    scene = importer.ReadFile(main, 0);
  } catch (const std::exception& e) {
    fail(source, std::string("the importer failed: ") + e.what());
  }
  if (scene == nullptr)
    fail(source, std::string("the file cannot be read as fbx: ") + importer.GetErrorString() +
                     "; check its format and that files it refers to are "
                     "beside it");
  MeshBuilder builder(source);
  builder.note("The importer (assimp) delivers 32-bit floats; those are taken as the input.");
  if (!opened.others().empty())
    builder.note(counted(opened.others().size(), "other file was", "other files were") +
                 " read besides (first: " + *opened.others().begin() + ").");
  SceneReader(source, *scene, builder).read();
  add_unit_notes(builder, *scene, format);
  return builder.finish(format, true);
}

}  // namespace

bool has_assimp() { return true; }

ReadResult read_with_assimp(const Source& source, Format format) {
  return read_in_child(source, child_limits(source.bytes.size()),
                       [&] { return read_here(source, format); });
}

}  // namespace kaboum::io
