// FBX, and on request what has no reader of ours, through assimp, which delivers float32
// coordinates in a tree of nodes. No post-processing step runs: none of them may merge, drop or
// reorder geometry; polygons are split by our own splitter. It runs in a child process: damaged and
// even some valid files make it crash.

#include <assimp/scene.h>
#include <kaboum/base/error.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <memory>
#include <set>

#include "builder.h"
#include "bytes.h"
#include "child.h"
#include "fbx_objects.h"
#include "formats.h"
#include "scene_copier.h"
#include "text.h"

namespace kaboum::io {
namespace {

constexpr int kMaxNodeDepth = 1000;

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
  /// @param name  by which assimp knows the file, and its format
  OnlyThisFile(const Source& source, std::string name) : source_(source), name_(std::move(name)) {}

  bool Exists(const char* file) const override { return file == name_; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return Exists(file) && mode[0] == 'r' ? new MemoryStream(source_.bytes) : nullptr;
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  const Source& source_;
  std::string name_;
};

/// What assimp says of colours, pictures, cameras and animations, as errors, where all surfaces are
/// there.
constexpr std::array<std::string_view, 14> kOfAppearance = {
    "3DS: Failed to read ambient base color",
    "3DS: Skipping FOV animation track",
    "3DS: Unable to read proper camera look-at vector",
    "3DS: Unknown material: ",
    "Failed to find source file for material",
    "LWO2: Clip index is out of bounds",
    "LWO2: Clip referrer index is out of range",
    "LWO2: Clip references another clip reference",
    "LWO2: Clip type is not supported",
    "LWO2: Found gradient texture, this is not supported",
    "LWO2: Found procedural texture, this is not supported",
    "LWO2: Ill-formed SURF.BLOK ordinal string",
    "LWO2: Unsupported texture mapping: ",
    "LWOB: Unsupported legacy texture: "};

/// A message without numbers and names, of which assimp may have hundreds alike.
std::string kind_of(std::string_view message) {
  std::string kind;
  bool named = false;  // within `...`
  for (const char c : message) {
    if (c == '`') named = !named;
    if (!named && (c < '0' || c > '9')) kind += c;
  }
  return kind;
}

/// Messages of assimp: the first ones of the first few kinds, and how many others there were.
class Messages : public Assimp::LogStream {
 public:
  void write(const char* line) override {
    std::string_view text(line);
    while (text.ends_with('\n')) text.remove_suffix(1);
    constexpr std::string_view kThread = "T0: ";  // before it the kind of message
    const std::size_t at = text.find(kThread);
    if (at == std::string_view::npos)
      return;  // "Skipping one or more lines with the same contents"
    text.remove_prefix(at + kThread.size());
    const auto says = [&](std::string_view words) { return text.starts_with(words); };
    if (std::ranges::any_of(kOfAppearance, says)) return;
    if (kinds_.size() < kMost && kinds_.insert(kind_of(text)).second)
      first_.push_back(in_quotes(text, kLongest));
    else
      ++others_;
  }

  [[nodiscard]] bool empty() const { return first_.empty(); }
  /// "'this', 'that' and 3 more"
  [[nodiscard]] std::string words() const {
    std::string list;
    for (const std::string& message : first_) list.append(list.empty() ? "" : ", ").append(message);
    return others_ == 0 ? list : list.append(" and ").append(std::to_string(others_)) + " more";
  }

 private:
  static constexpr std::size_t kMost = 5, kLongest = 120;
  std::set<std::string> kinds_;
  std::vector<std::string> first_;
  std::size_t others_ = 0;
};

/// Has assimp say its messages while it lives.
class Listening {
 public:
  Listening(Messages& errors, Messages& warnings) : errors_(errors), warnings_(warnings) {
    Assimp::Logger* logger = Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
    logger->attachStream(&errors_, Assimp::Logger::Err);
    logger->attachStream(&warnings_, Assimp::Logger::Warn);
  }
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;
  ~Listening() {
    Assimp::DefaultLogger::get()->detachStream(&errors_, Assimp::Logger::Err);
    Assimp::DefaultLogger::get()->detachStream(&warnings_, Assimp::Logger::Warn);
    Assimp::DefaultLogger::kill();
  }

 private:
  Messages &errors_, &warnings_;
};

Placement placement_of(const aiMatrix4x4& m) {
  Placement result;
  for (unsigned i = 0; i < 3; ++i) {
    for (unsigned k = 0; k < 3; ++k) result.linear(i, k) = static_cast<double>(m[i][k]);
    result.translation[i] = static_cast<double>(m[i][3]);
  }
  return result;
}

/// Whether (x, y, z) becomes (x, z, -y), perhaps scaled.
bool turns_up(const aiMatrix4x4& m) {
  const float scale = m.a1;
  aiMatrix4x4 turned(scale, 0, 0, 0, 0, 0, scale, 0, 0, -scale, 0, 0, 0, 0, 0, 1);
  return scale > 0 && m == turned;
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

  /// Meshes that no node shows.
  [[nodiscard]] std::size_t hidden() const { return scene_.mNumMeshes - shown_.size(); }

 private:
  void read_node(const aiNode& node, const Placement& parent, int depth) {
    if (depth > kMaxNodeDepth)
      fail(source_, "nodes are nested more than " + std::to_string(kMaxNodeDepth) +
                        " deep; flatten the scene");
    const Placement placement = parent * placement_of(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      if (node.mMeshes[i] >= scene_.mNumMeshes)
        fail(source_, "a node refers to a mesh that does not exist; the file is damaged");
      shown_.insert(node.mMeshes[i]);
      read_mesh(*scene_.mMeshes[node.mMeshes[i]], placement);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) {
      if (node.mChildren[i] == nullptr)
        fail(source_, "a part of the scene is lost in the importer; export it as one group");
      read_node(*node.mChildren[i], placement, depth + 1);
    }
  }

  void read_mesh(const aiMesh& mesh, const Placement& placement) {
    const auto called = [&] {
      const std::string_view name(mesh.mName.data, mesh.mName.length);
      return name.empty() ? std::string("a mesh") : "the mesh " + in_quotes(name);
    };
    if (mesh.mNumBones > 0 || mesh.mNumAnimMeshes > 0)
      fail(source_, called() +
                        " has a skin or morph targets, which are not supported; apply the "
                        "deformation before exporting");
    points_.clear();
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& v = mesh.mVertices[i];
      points_.emplace_back(v.x, v.y, v.z);
      if (!points_.back().allFinite())
        fail(source_,
             "vertex " + std::to_string(i) + " of " + called() + " is not finite; mend the file");
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
  std::set<unsigned> shown_;
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

/// The scene, as long as the importer lives.
const aiScene& imported(const Source& source, Assimp::Importer& importer,
                        const std::string& format) {
  const std::string name = "kaboum-input." + format;
  importer.SetIOHandler(std::make_unique<OnlyThisFile>(source, name).release());
  const aiScene* scene = nullptr;
  try {
    scene = importer.ReadFile(name, 0);
  } catch (const std::exception& e) {
    fail(source, std::string("the importer failed: ") + e.what());
  }
  if (scene == nullptr)
    fail(source, "the file cannot be read as " + format + ": " +
                     in_quotes(importer.GetErrorString(), 200) + "; check its format");
  return *scene;
}

ReadResult read_fbx_here(const Source& source) {
  Assimp::Importer importer;
  const aiScene& scene = imported(source, importer, "fbx");
  MeshBuilder builder(source);
  builder.note("The importer (assimp) delivers 32-bit floats; those are taken as the input.");
  AssimpReader(source, scene, builder).read();
  if (const double unit = centimetres_of(scene); unit > 0) {
    builder.set_unit(unit * 0.01);
    if (unit != 1)
      builder.note("The file's unit is " + shortest_digits(unit) +
                   " centimetres; coordinates were not scaled.");
  }
  return builder.finish(Format::Fbx, true);
}

/// Whether an AC3D file has as many objects and surfaces as it states.
bool has_all_of_ac3d(std::string_view text) {
  std::size_t objects = 1, surfaces = 0;  // the first object is nobody's kid
  std::size_t objects_found = 0, surfaces_found = 0;
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(" \t\r"));
    if (word == "OBJECT") ++objects_found;
    if (word == "SURF") ++surfaces_found;
    if (word != "kids" && word != "numsurf") continue;
    line.remove_prefix(word.size());
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    std::size_t count = 0;
    constexpr std::size_t kMost = 1'000'000'000;
    std::from_chars(line.data(), line.data() + line.size(), count);
    (word == "kids" ? objects : surfaces) += std::min(count, kMost);
  }
  return objects == objects_found && surfaces == surfaces_found;
}

/// Refuses a file that is cut, where it says how long it is or how it ends, and assimp does not
/// look.
void require_whole(const Source& source, std::string_view extension) {
  bool whole = true;
  if (extension == "dxf") {
    const std::size_t end = source.bytes.find_last_not_of(" \t\r\n");
    whole = source.bytes.substr(0, end + 1).ends_with("EOF");
  } else if (extension == "lwo" || extension == "lxo") {
    constexpr std::size_t kHead = 8;  // of an IFF file: its kind, and the size of what follows
    whole =
        source.bytes.size() >= kHead &&
        load<std::uint32_t>(source.begin() + 4, std::endian::big) <= source.bytes.size() - kHead;
  }
  if (extension.starts_with("ac") && !has_all_of_ac3d(source.bytes))
    fail(source,
         "the file has more or fewer objects (kids) or surfaces (numsurf) than it states; it may "
         "be cut: get it again");
  if (!whole) fail(source, "the file is cut: its end is not there; get it again");
}

ReadResult read_imported_here(const Source& source, std::string_view extension) {
  Messages errors, warnings;
  const Listening listening(errors, warnings);
  Assimp::Importer importer;
  const aiScene& scene = imported(source, importer, std::string(extension));
  if (!errors.empty())
    fail(source, "assimp says that something is wrong or left out: " + errors.words() +
                     "; mend the file, or export it as STL, OBJ or GLB");
  if ((scene.mFlags & AI_SCENE_FLAGS_INCOMPLETE) != 0)
    fail(source, "assimp says that its scene is incomplete; export it with its geometry");
  MeshBuilder builder(source);
  builder.note(
      "Warning: assimp read this file, and delivers 32-bit floats, which are taken as the "
      "input. It leaves out without a message what it does not know: what is claimed is "
      "about the triangles that it delivered.");
  if (!warnings.empty()) builder.note("assimp warns: " + warnings.words() + ".");
  AssimpReader reader(source, scene, builder);
  reader.read();
  if (turns_up(scene.mRootNode->mTransformation))
    builder.note("assimp turns what files of this format hold: their z is y here, their y is -z.");
  if (reader.hidden() > 0)
    builder.note(
        counted(reader.hidden(), "mesh that no node shows was", "meshes that no node shows were") +
        " left out.");
  if (scene.mNumAnimations > 0)
    builder.note("Animations were left out: the meshes are where they are without them.");
  return builder.finish(Format::Assimp, true);
}

}  // namespace

bool has_assimp() { return true; }

ReadResult read_fbx(const Source& source) {
  std::vector<std::string> notes = check_fbx_objects(source);
  ReadResult result = read_in_child(source, child_limits(source.bytes.size()),
                                    [&] { return read_fbx_here(source); });
  std::ranges::move(notes, std::back_inserter(result.notes));
  return result;
}

ReadResult read_by_assimp(const Source& source) {
  const std::string_view extension = imported_extension(source.name);
  if (extension.empty())
    fail(source, "assimp is not asked for files of this name: it knows formats by extensions");
  require_whole(source, extension);
  return read_in_child(source, child_limits(source.bytes.size()),
                       [&] { return read_imported_here(source, extension); });
}

}  // namespace kaboum::io
