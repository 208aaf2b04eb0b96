// The second reading of CAD files: loads the module in a child process and takes its points.
#include <kaboum/base/error.h>
#include <kaboum/base/program_file.h>
#include <kaboum/io/child_process.h>
#include <kaboum/verify/exact_points.h>

#include <dlfcn.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "point_list.h"

namespace kaboum::verify {
namespace {

namespace fs = std::filesystem;

/// Of an evaluation by OpenCASCADE, in the largest coordinate: trigonometry, splines of high
/// degree and chains of placements lose far less than this.
constexpr double kEvaluation = 0x1p-40;

/// Where the module may be: beside the program's libraries, where it was installed.
std::vector<fs::path> places() {
  std::vector<fs::path> out;
  const fs::path program = program_file(reinterpret_cast<const void*>(&read_exact_points));
  if (!program.empty()) {
    // Beside bin/; of a library in its own folder, or so many above that of a Python module.
    const bool library = program.extension() == ".so";
    if (library) out.push_back(program.parent_path() / kPointsModule);
    for (const int up : {2, 3, 5}) {
      auto folder = program;
      for (int i = 0; i < up; ++i) folder = folder.parent_path();
      if ((up > 2) == library) out.push_back(folder / KABOUM_LIBRARY_FOLDER / kPointsModule);
    }
  }
  const fs::path installed(KABOUM_INSTALLED_LIBRARIES);
  if (!installed.empty()) out.push_back(installed / kPointsModule);
  return out;
}

ListPoints* load() {
  for (const fs::path& file : places()) {
    void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) continue;
    if (void* function = ::dlsym(module, kListPoints))
      return reinterpret_cast<ListPoints*>(function);
  }
  return nullptr;
}

/// A file without a name in any folder; closed at the end of its scope.
class FileInMemory {
 public:
  explicit FileInMemory(std::span<const char> bytes) : fd_(::memfd_create("points", MFD_CLOEXEC)) {
    while (fd_ >= 0 && !bytes.empty()) {
      const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
      if (written <= 0) break;
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    if (fd_ < 0 || !bytes.empty())
      throw Error(ErrorCode::LimitReached,
                  "no memory for a copy of the file; close other programs");
  }
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;
  ~FileInMemory() {
    if (fd_ >= 0) ::close(fd_);
  }
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

template <class T>
void put(std::string& bytes, const T* values, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

/// What the child sends: four counts, the coordinates, the faces.
std::string message_of(std::span<const char> bytes, io::Format format, const std::string& name,
                       std::size_t density) {
  ListPoints* list_points = load();
  if (list_points == nullptr)
    throw Error(ErrorCode::NotBuilt,
                name + ": the module that evaluates exact faces (" + kPointsModule +
                    ") is not there or cannot be loaded; install it with the OpenCASCADE "
                    "libraries that it was built with, or judge the triangles alone "
                    "(«exact-points=0»)");
  const FileInMemory file(bytes);
  PointList list;
  list_points(file.path().c_str(), format == io::Format::Iges, density, list);
  if (!list.error.empty())
    throw Error(ErrorCode::InvalidInput,
                name + ": its exact faces, read a second time: " + list.error +
                    "; export it again, or judge the triangles alone («exact-points=0»)");
  const std::array<std::uint64_t, 3> counts{list.of_face.size(), list.faces, list.edges};
  std::string out;
  put(out, counts.data(), counts.size());
  put(out, list.coordinates.data(), list.coordinates.size());
  put(out, list.of_face.data(), list.of_face.size());
  return out;
}

/// The child's memory may be damaged: nothing in its message is believed unchecked.
ExactPoints points_of(const std::string& message, const std::string& name) {
  const auto broken = [&] {
    throw Error(ErrorCode::InvalidInput,
                name + ": the evaluation of its exact faces broke down; export it again");
  };
  std::array<std::uint64_t, 3> counts{};
  if (message.size() < sizeof counts) broken();
  std::memcpy(counts.data(), message.data(), sizeof counts);
  const std::uint64_t count = counts[0], rest = message.size() - sizeof counts;
  constexpr std::uint64_t kEach = 3 * sizeof(double) + sizeof(std::uint32_t);
  if (count == 0 || rest % kEach != 0 || rest / kEach != count) broken();
  ExactPoints out;
  out.faces = counts[1];
  out.edges = counts[2];
  out.points.resize(count);
  out.of_face.resize(count);
  const char* at = message.data() + sizeof counts;
  std::memcpy(static_cast<void*>(out.points.data()), at, count * 3 * sizeof(double));
  std::memcpy(out.of_face.data(), at + count * 3 * sizeof(double), count * sizeof(std::uint32_t));
  for (const geom::Vec3& p : out.points)
    if (!p.allFinite()) broken();
  for (const std::uint32_t face : out.of_face)
    if (face >= out.faces) broken();
  return out;
}

}  // namespace

ExactPoints read_exact_points(std::span<const char> bytes, io::Format format,
                              const std::string& name, std::size_t density, double scale,
                              std::size_t faces) {
  if (density == 0) throw Error(ErrorCode::InvalidArgument, "exact points: a density of 0");
  // The libraries alone take half a gigabyte of addresses, and points are many.
  io::ChildLimits limits = io::child_limits(bytes.size());
  limits.memory *= 4;
  limits.seconds *= 3;
  ExactPoints out = points_of(
      io::bytes_of_child(name, limits, [&] { return message_of(bytes, format, name, density); }),
      name);
  if (out.faces != faces)
    throw Error(ErrorCode::InvalidInput,
                name + ": " + std::to_string(out.faces) +
                    " exact faces were found where the triangles stand for " +
                    std::to_string(faces) +
                    ", so that one of both readings is wrong; make a mesh of it elsewhere");
  double largest = 0;
  for (geom::Vec3& p : out.points) {
    p *= scale;
    if (!p.allFinite())
      throw Error(ErrorCode::InvalidInput,
                  name + ": its points are beyond the range of doubles after scaling");
    largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  out.rounding = largest * kEvaluation;
  return out;
}

}  // namespace kaboum::verify
