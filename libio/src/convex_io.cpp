// Sets of convex bodies in files and folders, one container for each of the formats.
#include <fcntl.h>
#include <kaboum/base/error.h>
#include <kaboum/base/read_json.h>
#include <kaboum/geom/topology.h>
#include <kaboum/io/convex_folder.h>
#include <kaboum/io/convex_io.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <system_error>
#include <utility>

#include "convex_formats.h"
#include "output.h"
#include "text.h"

namespace kaboum::io {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kRecordFile = "convex-set.json";
constexpr const char* kStem = "files";  // key of the stem of a folder's files in its record

/// One body per component connected through edges.
std::vector<geom::ConvexBody> split_components(const geom::Mesh& mesh) {
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> component = geom::components(mesh, true, &count);
  std::vector<geom::ConvexBody> bodies(count);
  for (std::size_t i = 0; i < component.size(); ++i)
    bodies[component[i]].core.triangles.push_back(mesh.triangles[i]);
  std::vector<std::uint32_t> number(mesh.vertices.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    bodies[i].name = default_name(i);
    geom::Mesh& hull = bodies[i].core;
    std::vector<std::uint32_t> used;
    for (const geom::Triangle& t : hull.triangles) used.insert(used.end(), t.begin(), t.end());
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (const std::uint32_t v : used) {
      number[v] = static_cast<std::uint32_t>(hull.vertices.size());
      hull.vertices.push_back(mesh.vertices[v]);
    }
    for (geom::Triangle& t : hull.triangles)
      for (std::uint32_t& v : t) v = number[v];
  }
  return bodies;
}

bool natural_less(const std::string& a, const std::string& b) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (digit(a[i]) && digit(b[j])) {
      std::size_t k = i, l = j;
      while (k < a.size() && digit(a[k])) ++k;
      while (l < b.size() && digit(b[l])) ++l;
      std::string_view m = std::string_view(a).substr(i, k - i);
      std::string_view n = std::string_view(b).substr(j, l - j);
      m.remove_prefix(std::min(m.find_first_not_of('0'), m.size()));
      n.remove_prefix(std::min(n.find_first_not_of('0'), n.size()));
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
      i = k;
      j = l;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  if (i < a.size() || j < b.size()) return j < b.size();
  return a < b;
}

/// The files of a folder that are bodies: STL, or where there is none, OBJ.
std::vector<fs::path> body_files(const fs::path& folder, std::error_code& error) {
  for (const char* extension : {".stl", ".obj"}) {
    std::vector<fs::path> files;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
      if (same_word(at->path().extension().string(), extension) &&
          at->path().filename().string().front() != '.')
        files.push_back(at->path());
    if (error || !files.empty()) return files;
  }
  return {};
}

geom::ConvexSet read_directory(const fs::path& path, SetReadDetails& details) {
  std::error_code error;
  std::vector<fs::path> files = body_files(path, error);
  const Source source{{}, path.native(), {}, true};
  if (error) fail(source, "the folder cannot be read: " + error.message());
  if (files.empty() && !fs::exists(path / kRecordFile, error))
    fail(source,
         "the folder holds no STL file (nor OBJ files); a set is stored as one STL file per body");
  std::ranges::sort(files, [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  geom::ConvexSet set;
  details.single_precision = true;
  for (const fs::path& file : files) {
    std::vector<char> bytes;
    ReadResult read = read_mesh(file, {}, &bytes);
    details.single_precision = details.single_precision && read.single_precision;
    details.bytes.insert(details.bytes.end(), bytes.begin(), bytes.end());
    for (const std::string& note : read.notes)
      details.notes.push_back(file.filename().string() + ": " + note);
    set.bodies.push_back({file.stem().string(), std::move(read.mesh)});
  }
  if (fs::exists(path / kRecordFile, error)) {
    const std::vector<char> bytes = read_file(path / kRecordFile);
    const std::string name = (path / kRecordFile).string();
    const Source record_source{{bytes.data(), bytes.size()}, name, {}, true};
    take_record(read_json<Json>(record_source.bytes, name, "write the set again"), record_source,
                set);
    details.has_record = true;
    details.unit = set.provenance.unit;
  }
  return set;
}

geom::ConvexSet parse(const Source& source, Format format, SetReadDetails& details) {
  if (format == Format::Glb || format == Format::Gltf) return read_gltf_set(source, details);
  if (format == Format::Obj) {
    if (auto set = read_obj_set(source, details)) return *std::move(set);
  }
  const ReadResult read =
      parse_mesh(source.bytes, format, std::string(source.name), source.directory);
  details.single_precision = read.single_precision;
  details.unit = read.unit;
  details.notes.insert(details.notes.end(), read.notes.begin(), read.notes.end());
  geom::ConvexSet set;
  set.bodies = split_components(read.mesh);
  return set;
}

/// A segment or a point, and a radius.
void require_rounded(const geom::ConvexBody& body, const std::string& name) {
  const std::size_t points = body.core.vertices.size();
  if (points < 1 || points > 2) throw Error(ErrorCode::InvalidArgument, name + "has no triangles");
  if (body.radius == 0)
    throw Error(ErrorCode::InvalidArgument,
                name + "is a segment or a point without a radius: it holds nothing");
  for (const geom::Vec3& p : body.core.vertices)
    if (!p.allFinite())
      throw Error(ErrorCode::InvalidArgument, name + "has a coordinate that is not finite");
}

/// Without unused vertices and −0. @throws Error{InvalidArgument} when a body is not valid.
geom::ConvexSet cleaned(const geom::ConvexSet& set) {
  geom::ConvexSet clean = set;
  for (std::size_t i = 0; i < clean.bodies.size(); ++i) {
    geom::ConvexBody& body = clean.bodies[i];
    if (body.name.empty()) body.name = default_name(i);
    const std::string name = "body " + std::to_string(i) + " of the set to be written ";
    if (!(body.radius >= 0) || !std::isfinite(body.radius))
      throw Error(ErrorCode::InvalidArgument, name + "has a radius that is negative or not finite");
    if (body.core.triangles.empty()) {
      require_rounded(body, name);
      continue;
    }
    for (const geom::Triangle& t : body.core.triangles)
      for (const std::uint32_t corner : t)
        if (corner >= body.core.vertices.size() || !body.core.vertices[corner].allFinite())
          throw Error(ErrorCode::InvalidArgument,
                      name + "has an invalid index or a coordinate that is not finite");
    body.core = geom::weld(body.core);
    for (geom::Vec3& p : body.core.vertices) p = p.array() + 0.0;  // −0 + 0 = +0
  }
  return clean;
}

void refuse_radii(const geom::ConvexSet& set, const char* format) {
  for (const geom::ConvexBody& body : set.bodies)
    if (body.radius > 0)
      throw Error(ErrorCode::OutputFailed,
                  std::string(format) + " cannot state the radius of a body ('" + body.name +
                      "'), and without it the body is too small; write glb, or enlarge the bodies "
                      "by their radii first");
}

/// The stem of the files that the folder's record speaks of; nullopt without a record.
std::optional<std::string> stem_of(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder / kRecordFile, error)) return std::nullopt;
  std::optional<std::string> stem = "body";
  try {
    const std::vector<char> bytes = read_file(folder / kRecordFile);
    const Json record = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
    if (record.is_object() && record.contains(kStem) && record[kStem].is_string())
      stem = record[kStem].get<std::string>();
  } catch (const Error&) {
    stem.reset();
  }
  return stem;
}

/// Whether a file of a folder has a name that write_convex_folder gives.
bool is_part_of_set(const fs::path& file, const std::string& files) {
  if (file.filename() == kRecordFile) return true;
  const std::string stem = file.stem().string(), start = files + "-";
  return (file.extension() == ".stl" || file.extension() == ".obj") &&
         stem.size() >= start.size() + 4 && stem.starts_with(start) &&
         stem.find_first_not_of("0123456789", start.size()) == std::string::npos;
}

/// The folder's path without a slash at the end. Behind a symbolic link, its target is replaced,
/// not the link.
fs::path target_of(const fs::path& path) {
  fs::path target = path.lexically_normal();
  if (target.filename().empty()) target = target.parent_path();
  std::error_code error;
  if (!fs::is_symlink(target, error)) return target;
  const fs::path behind = fs::canonical(target, error);
  return behind.empty() ? target : behind;
}

[[noreturn]] void cannot_write(const fs::path& path, const std::string& why) {
  throw Error(ErrorCode::OutputFailed, path.string() + ": cannot be written: " + why);
}

/// A folder under a name of its own beside a target, removed at the end of the scope with all that
/// is in it.
class NewFolder {
 public:
  /// @throws Error{OutputFailed}
  explicit NewFolder(const fs::path& target)
      : parent_(target.has_parent_path() ? target.parent_path() : fs::path(".")),
        path_(unused_name()) {
    // Whose name it is, on whatever machine, made the folder.
    std::error_code error;
    while (!fs::create_directory(path_, error)) {
      if (error)
        cannot_write(target,
                     "no folder can be created in '" + parent_.string() + "': " + error.message());
      path_ = unused_name();
    }
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  ~NewFolder() {
    std::error_code error;
    if (!path_.empty()) fs::remove_all(path_, error);
  }

  [[nodiscard]] const fs::path& path() const { return path_; }

  /// Gives it the target's name, and the folder that had that name before is removed. Of several
  /// writers at the same time, the last one wins; each puts whole folders there.
  /// @return 0, or errno: also where the name is a file's or a link's
  /// @throws Error{OutputFailed} where what was there before is now elsewhere, saying where
  [[nodiscard]] int take_place_of(const fs::path& target) {
    constexpr int kMostAttempts = 1000;  // each fails only where another writer was faster
    for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
      int why = move_to(target);  // where there is nothing, or an empty folder
      if (!is_in_the_way(why)) return why;
      // In one step: there is a folder of this name at every moment.
      if (::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) == 0)
        return 0;
      if (errno == ENOENT) continue;
      // A file system that cannot: in two.
      NewFolder old(target);
      if (::rename(target.c_str(), old.path_.c_str()) != 0) {
        if (errno == ENOENT) continue;
        return errno;
      }
      why = move_to(target);
      if (why == 0) return 0;
      if (!is_in_the_way(why)) {
        if (old.move_to(target) != 0)
          cannot_write(target, std::generic_category().message(why) +
                                   "; what was there is now in '" + old.let_go().string() + "'");
        return why;
      }
    }
    return EBUSY;
  }

 private:
  /// It stays. @return its name
  fs::path let_go() { return std::exchange(path_, {}); }

  /// errno of a rename to the name of a folder that is not empty.
  static bool is_in_the_way(int why) { return why == ENOTEMPTY || why == EEXIST; }

  /// Its own name is then free for others, and no longer removed. @return 0, or errno
  [[nodiscard]] int move_to(const fs::path& target) {
    if (::rename(path_.c_str(), target.c_str()) != 0) return errno;
    path_.clear();
    return 0;
  }

  [[nodiscard]] fs::path unused_name() const {
    static std::atomic<std::uint64_t> counter{0};
    return parent_ /
           (".kaboum-new-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp");
  }

  fs::path parent_, path_;
};

}  // namespace

void require_replaceable(const fs::path& folder) {
  std::error_code error;
  const fs::path target = target_of(folder);
  if (!fs::exists(target, error)) return;
  if (!fs::is_directory(target, error)) cannot_write(folder, "it is a file; name a folder");
  const std::optional<std::string> ours = stem_of(target);
  fs::directory_iterator at(target, error);
  for (const fs::directory_iterator end; !error && at != end; at.increment(error))
    if (!ours || !is_part_of_set(at->path(), *ours))
      cannot_write(folder, "the folder holds '" + at->path().filename().string() +
                               "', which is no part of a convex set written here; name another "
                               "folder");
  const bool vanished = error == std::errc::no_such_file_or_directory;  // to be replaced
  if (error && !vanished) cannot_write(folder, error.message());
}

void write_convex_folder(const fs::path& path, const geom::ConvexSet& set, const std::string& stem,
                         Format bodies) {
  if (bodies != Format::Stl && bodies != Format::Obj)
    throw Error(ErrorCode::InvalidArgument, "the bodies of a folder are STL or OBJ files");
  refuse_radii(set, "STL");
  const geom::ConvexSet clean = cleaned(set);
  require_replaceable(path);
  const fs::path target = target_of(path);
  NewFolder fresh(target);
  for (std::size_t i = 0; i < clean.bodies.size(); ++i)
    write_file(fresh.path() / (default_name(i, stem) + (bodies == Format::Obj ? ".obj" : ".stl")),
               serialise_mesh(clean.bodies[i].core, bodies));
  Json record = record_of(clean);
  record[kStem] = stem;
  write_file(fresh.path() / kRecordFile,
             record.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  if (const int why = fresh.take_place_of(target); why != 0)
    cannot_write(path, std::generic_category().message(why));
}

std::string default_name(std::size_t index, std::string_view stem) {
  const std::string digits = std::to_string(index);
  std::string name(stem);
  name += '-';
  if (digits.size() < 4) name.append(4 - digits.size(), '0');
  return name + digits;
}

Json record_of(const geom::ConvexSet& set) {
  const geom::Provenance& p = set.provenance;
  const std::optional<double> margin = geom::margin_of(set);
  Json radii = Json::array();
  if (!margin)
    for (const geom::ConvexBody& body : set.bodies) radii.push_back(body.radius);
  return {{"version", margin ? 1 : 2},  // readers of the first one know no radii
          {"bodies", set.bodies.size()},
          margin ? Json::object_t::value_type{"margin", *margin}
                 : Json::object_t::value_type{"radii", std::move(radii)},
          {"unit", p.unit},
          {"frame", p.frame},
          {"direction", p.direction},
          {"epsilon", p.epsilon ? Json(*p.epsilon) : Json(nullptr)},
          {"covers_solid", p.covers_solid},
          {"covers_surface", p.covers_surface},
          {"source", p.source},
          {"source_sha256", p.source_sha256},
          {"tool", p.tool},
          {"parameters", p.parameters}};
}

/// One for all bodies, or one of each.
static void take_radii(const Json& record, const Source& source, geom::ConvexSet& set) {
  const auto refuse_bad = [&](double radius) {
    if (!(radius >= 0) || !std::isfinite(radius))
      fail(source, "the record states a margin or radius that is negative or not finite");
  };
  if (record.at("version") == 1) {
    const auto margin = record.at("margin").get<double>();
    refuse_bad(margin);
    geom::set_margin(set, margin);
  } else {
    const Json& radii = record.at("radii");
    if (!radii.is_array() || radii.size() != set.bodies.size())
      fail(source, "the record does not state one radius for each body; write the set again");
    for (std::size_t i = 0; i < set.bodies.size(); ++i) radii.at(i).get_to(set.bodies[i].radius);
  }
  for (const geom::ConvexBody& body : set.bodies) {
    refuse_bad(body.radius);
    if (body.core.triangles.empty() && body.radius == 0)
      fail(source, "body '" + body.name +
                       "' is a segment or a point without a radius; write the set again");
  }
}

void take_record(const Json& record, const Source& source, geom::ConvexSet& set) {
  try {
    if (record.at("version") != 1 && record.at("version") != 2)
      fail(source, "the record is of a version that this program does not know; use a newer one");
    geom::Provenance& p = set.provenance;
    record.at("unit").get_to(p.unit);
    record.at("frame").get_to(p.frame);
    record.at("direction").get_to(p.direction);
    if (!record.at("epsilon").is_null()) p.epsilon = record.at("epsilon").get<double>();
    if (p.epsilon && !(*p.epsilon >= 0 && std::isfinite(*p.epsilon)))
      fail(source, "the record's epsilon is no length from 0 on; have the set made anew");
    record.at("covers_solid").get_to(p.covers_solid);
    record.at("covers_surface").get_to(p.covers_surface);
    record.at("source").get_to(p.source);
    record.at("source_sha256").get_to(p.source_sha256);
    record.at("tool").get_to(p.tool);
    record.at("parameters").get_to(p.parameters);
    if (record.at("bodies") != set.bodies.size())
      fail(source, "the record speaks of " + record.at("bodies").dump() +
                       " bodies, but there are " + std::to_string(set.bodies.size()) +
                       "; the set is incomplete, write it again");
    take_radii(record, source, set);
  } catch (const Json::exception& e) {
    fail(source, std::string("the record of the convex set is damaged: ") + e.what());
  }
}

std::optional<SetFormat> set_format_from_path(const fs::path& path) {
  std::error_code ignored;
  const std::string extension = path.extension().string();
  if (same_word(extension, ".glb")) return SetFormat::Glb;
  if (same_word(extension, ".obj")) return SetFormat::Obj;
  if (path != "-" && (extension.empty() || fs::is_directory(path, ignored)))
    return SetFormat::Directory;
  return std::nullopt;
}

geom::ConvexSet parse_convex_set(std::span<const char> bytes, Format format,
                                 const std::string& name, SetReadDetails* details,
                                 const fs::path& base_directory) {
  SetReadDetails ignored;
  const Source source{{bytes.data(), bytes.size()}, name, base_directory, true};
  if (bytes.empty()) fail(source, "the file is empty; get it again");
  return parse(source, format, details != nullptr ? *details : ignored);
}

geom::ConvexSet read_convex_set(const fs::path& path, std::optional<Format> format,
                                SetReadDetails* details) {
  SetReadDetails ignored;
  SetReadDetails& out = details != nullptr ? *details : ignored;
  std::error_code error;
  if (path != "-" && fs::is_directory(path, error)) return read_directory(path, out);
  const std::string name = path == "-" ? "standard input" : path.string();
  const Format known = format_of_file(path, format);
  out.bytes = read_file(path);
  fs::path directory;
  if (path != "-") directory = path.has_parent_path() ? path.parent_path() : ".";
  return parse_convex_set(out.bytes, known, name, &out, directory);
}

bool is_meant_as_set(const geom::ConvexSet& set, const SetReadDetails& details) {
  return details.has_record || (set.bodies.size() > 1 && !geom::find_not_convex(set));
}

std::optional<geom::ConvexSet> find_convex_set(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return read_convex_set(path);
  const auto format = format_from_name(fs::path(path).extension().string());
  if (format != Format::Glb && format != Format::Obj) return std::nullopt;
  const std::vector<char> bytes = read_file(path);
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : ".";
  try {
    SetReadDetails details;
    geom::ConvexSet set = parse_convex_set(bytes, *format, path, &details, folder);
    if (is_meant_as_set(set, details)) return set;
  } catch (const Error&) {  // NOLINT(bugprone-empty-catch): the reader of meshes says what is wrong
  }
  return std::nullopt;
}

std::vector<char> serialise_convex_set(const geom::ConvexSet& set, SetFormat format) {
  switch (format) {
    case SetFormat::Glb:
      return write_glb_set(cleaned(set));
    case SetFormat::Obj:
      refuse_radii(set, "OBJ");
      if (set.bodies.empty())
        throw Error(ErrorCode::InvalidArgument, "OBJ cannot hold a set without bodies; write glb");
      return write_obj_set(cleaned(set));
    case SetFormat::Directory:
      break;
  }
  throw Error(ErrorCode::InvalidArgument, "a folder of STL files has no bytes of its own");
}

void write_convex_set(const fs::path& path, const geom::ConvexSet& set,
                      std::optional<SetFormat> format, const std::string& stem) {
  if (!format) format = set_format_from_path(path);
  if (!format)
    throw Error(ErrorCode::InvalidArgument,
                path.string() +
                    ": convex sets are written as .glb, .obj, or a folder (a name without "
                    "extension)");
  if (*format == SetFormat::Directory) return write_convex_folder(path, set, stem, Format::Stl);
  write_file(path, serialise_convex_set(set, *format));
}

}  // namespace kaboum::io
