// STEP and IGES: by a module that is loaded, in a child process, when such a file is read.
#include <dlfcn.h>
#include <kaboum/base/error.h>
#include <kaboum/base/program_file.h>
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
#include "formats.h"
#include "text.h"

namespace kaboum::io {
namespace {

/// Where the module may be: beside the program's libraries, where it was installed, where the
/// system looks.
std::vector<std::filesystem::path> places() {
  std::vector<std::filesystem::path> result;
  const std::filesystem::path program = program_file(reinterpret_cast<const void*>(&read_cad));
  if (!program.empty()) {
    // Beside bin/; of a library in its own folder, or so many above that of a Python module.
    const bool library = program.extension() == ".so";
    if (library) result.push_back(program.parent_path() / kCadModule);
    for (const int up : {2, 3, 5}) {
      auto folder = program;
      for (int i = 0; i < up; ++i) folder = folder.parent_path();
      if ((up > 2) == library) result.push_back(folder / KABOUM_LIBRARY_FOLDER / kCadModule);
    }
  }
  const std::filesystem::path installed(KABOUM_INSTALLED_LIBRARIES);
  if (!installed.empty()) result.push_back(installed / kCadModule);
  return result;
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
}

ReadResult read_here(const Source& source, Format format) {
  ReadCad* read = load();
  if (read == nullptr)
    throw Error(ErrorCode::NotBuilt, std::string(source.name) +
                                         ": the module that reads STEP and IGES (" + kCadModule +
                                         ") cannot be loaded; install the OpenCASCADE libraries "
                                         "that it was built with");
  const NamedBytes file(source.bytes);
  CadShape shape;
  read(file.name().c_str(), format == Format::Iges, shape);
  if (!shape.error.empty()) fail(source, shape.error + "; export it again, or make a mesh of it");
  if (shape.bare_faces > 0)
    fail(source, counted(shape.bare_faces, "face", "faces") +
                     " could not be made into triangles; mend the part, or make a mesh of it");
  MeshBuilder builder(source);
  for (const geom::Vec3& p : shape.points) builder.add_point(p, source.begin());
  for (const geom::Triangle& t : shape.triangles) builder.add_triangle(t);
  add_notes(shape, builder);
  if (!(shape.deviation >= 0) || !std::isfinite(shape.deviation))
    fail(source, "the deviation of its faces could not be measured; make a mesh of it");
  ReadResult result = builder.finish(format, false);
  result.file_vertices = result.mesh.vertices.size();
  result.unit = "mm";
  result.deviation = shape.deviation;
  result.exact_faces = shape.faces;
  result.notes.push_back(about_exact_faces(result) + " That is proved, in " +
                         std::to_string(shape.pieces) + " pieces.");
  return result;
}

}  // namespace

bool has_cad() {
  const auto all = places();
  return std::any_of(all.begin(), all.end(), [](const std::filesystem::path& file) {
    std::error_code none;
    return std::filesystem::exists(file, none);
  });
}

std::string about_exact_faces(const ReadResult& read) {
  if (!is_cad(read.format)) return {};
  std::ostringstream text;
  text.precision(3);
  text << "Triangles stand for its " << read.exact_faces << " exact faces, which are within "
       << read.deviation << (read.unit.empty() ? "" : " " + read.unit)
       << " of them. Only what keeps that clear (a wrap) holds the faces themselves; else what is "
          "said is about the triangles.";
  return text.str();
}

ReadResult read_cad(const Source& source, Format format) {
  if (!has_cad())
    throw Error(ErrorCode::NotBuilt,
                std::string(source.name) +
                    ": reading STEP and IGES needs OpenCASCADE, which this build leaves out; "
                    "make a mesh of it, for example by gmsh: gmsh " +
                    std::string(source.name) +
                    " -2 -clmax 5 -o part.stl (5: longest edge, in its unit)");
  // The libraries alone take half a gigabyte of addresses.
  ChildLimits limits = child_limits(source.bytes.size());
  limits.memory *= 2;
  limits.seconds = 30 + 20 * (source.bytes.size() >> 20U);
  return read_in_child(source, limits, [&] { return read_here(source, format); });
}

}  // namespace kaboum::io
