// STEP and IGES: by a module that is loaded, in a child process, when such a file is read.
#include <dlfcn.h>
#include <kaboum/base/error.h>
#include <kaboum/io/cad.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "builder.h"
#include "cad_shape.h"
#include "child.h"
#include "text.h"

namespace kaboum::io {
namespace {

/// Where the module may be: beside the program's libraries, where it was installed, where the
/// system looks.
std::vector<std::filesystem::path> places() {
  std::vector<std::filesystem::path> result;
  Dl_info here{};
  if (::dladdr(reinterpret_cast<const void*>(&is_cad_file), &here) != 0 &&
      here.dli_fname != nullptr) {
    std::error_code none;
    const auto program = std::filesystem::canonical(here.dli_fname, none);
    if (!none)
      result.push_back(program.parent_path().parent_path() / KABOUM_LIBRARY_FOLDER / kCadModule);
  }
  result.emplace_back(std::filesystem::path(KABOUM_INSTALLED_LIBRARIES) / kCadModule);
  return result;
}

bool has_module() {
  const auto all = places();
  return std::any_of(all.begin(), all.end(), [](const std::filesystem::path& file) {
    std::error_code none;
    return std::filesystem::exists(file, none);
  });
}

/// The file's bytes under a name that other libraries can open.
class NamedBytes {
 public:
  explicit NamedBytes(std::string_view bytes) : fd_(::memfd_create("kaboum", MFD_CLOEXEC)) {
    while (fd_ >= 0 && !bytes.empty()) {
      const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
      if (written <= 0) break;
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    if (fd_ < 0 || !bytes.empty())
      throw Error(ErrorCode::LimitReached,
                  "no memory for a copy of the file; close other programs");
  }
  NamedBytes(const NamedBytes&) = delete;
  NamedBytes& operator=(const NamedBytes&) = delete;
  ~NamedBytes() {
    if (fd_ >= 0) ::close(fd_);
  }
  [[nodiscard]] std::string name() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

/// A number that a child process leaves to this one.
class SharedNumber {
 public:
  SharedNumber()
      : at_(static_cast<double*>(::mmap(nullptr, sizeof(double), PROT_READ | PROT_WRITE,
                                        MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {
    if (at_ == MAP_FAILED) throw Error(ErrorCode::LimitReached, "no memory; close other programs");
    *at_ = std::nan("");
  }
  SharedNumber(const SharedNumber&) = delete;
  SharedNumber& operator=(const SharedNumber&) = delete;
  ~SharedNumber() { ::munmap(at_, sizeof(double)); }
  [[nodiscard]] double& value() { return *at_; }

 private:
  double* at_;
};

ReadCad* load() {
  for (const auto& file : places()) {
    void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) continue;
    if (void* function = ::dlsym(module, kReadCad)) return reinterpret_cast<ReadCad*>(function);
  }
  return nullptr;
}

std::string joined(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 10;
  std::string text;
  std::size_t named = 0;
  for (const std::string& name : names) {
    if (name.empty()) continue;
    if (++named > kMost) return text + ", ...";
    text += (text.empty() ? ": " : ", ") + in_quotes(name);
  }
  return text;
}

void add_notes(const CadShape& shape, MeshBuilder& builder) {
  builder.note(counted(shape.solids.size(), "solid", "solids") + joined(shape.solids) +
               "; coordinates are in millimetres.");
  if (shape.loose_faces > 0)
    builder.note(counted(shape.loose_faces, "face belongs", "faces belong") +
                 " to no solid, and were read as triangles like the others.");
  std::ostringstream text;
  text.precision(3);
  text << "Triangles stand for the exact faces, no point of which is farther than "
       << shape.deviation << " mm from them: proved, in " << shape.pieces
       << " pieces. Only a wrap (--prepare wrap) holds the faces themselves; else what is said is "
          "about the triangles.";
  builder.note(text.str());
}

ReadResult read_here(const Source& source, bool iges, double& deviation) {
  ReadCad* read = load();
  if (read == nullptr)
    throw Error(ErrorCode::NotBuilt, std::string(source.name) +
                                         ": the module that reads STEP and IGES (" + kCadModule +
                                         ") cannot be loaded; install the OpenCASCADE libraries "
                                         "that it was built with");
  const NamedBytes file(source.bytes);
  CadShape shape;
  read(file.name().c_str(), iges, shape);
  if (!shape.error.empty()) fail(source, shape.error + "; export it again, or make a mesh of it");
  if (shape.bare_faces > 0)
    fail(source, counted(shape.bare_faces, "face", "faces") +
                     " could not be made into triangles; mend the part, or make a mesh of it");
  MeshBuilder builder(source);
  for (const geom::Vec3& p : shape.points) builder.add_point(p, source.begin());
  for (const geom::Triangle& t : shape.triangles) builder.add_triangle(t);
  add_notes(shape, builder);
  deviation = shape.deviation;
  return builder.finish(Format::Obj, false);  // the message between processes has no better word
}

bool is_iges(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  return same_word(extension, ".iges") || same_word(extension, ".igs");
}

}  // namespace

bool is_cad_file(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  return is_iges(path) || same_word(extension, ".step") || same_word(extension, ".stp");
}

CadResult read_cad(const std::filesystem::path& path, std::vector<char>* bytes_out) {
  const std::string name = path.string();
  std::vector<char> bytes = read_file(path);
  const Source source{{bytes.data(), bytes.size()}, name, {}, true};
  if (bytes.empty()) fail(source, "the file is empty; get it again");
  if (!has_module())
    throw Error(ErrorCode::NotBuilt,
                name +
                    ": reading STEP and IGES needs OpenCASCADE, which this build leaves out; "
                    "make a mesh of it, for example by gmsh: gmsh " +
                    name + " -2 -clmax 5 -o part.stl (5: longest edge, in its unit)");
  // The libraries alone take half a gigabyte of addresses.
  ChildLimits limits = child_limits(bytes.size());
  limits.memory *= 2;
  limits.seconds *= 3;
  SharedNumber deviation;
  ReadResult read = read_in_child(
      source, limits, [&] { return read_here(source, is_iges(path), deviation.value()); });
  const double measured = deviation.value();
  if (!(measured >= 0) || !std::isfinite(measured))
    fail(source, "the deviation of its faces could not be measured; make a mesh of it");
  if (bytes_out != nullptr) *bytes_out = std::move(bytes);
  read.file_vertices = read.mesh.vertices.size();
  read.unit = "mm";
  return {std::move(read), measured};
}

}  // namespace kaboum::io
