// Packages as ROS 1 (rospack: crawls $ROS_PACKAGE_PATH), ROS 2 (ament: PREFIX/share/NAME) and
// people without either (the folder beside the robot's file) find them.

#include <kaboum/robot/mesh_files.h>

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "is_file.h"

namespace kaboum::robot {
namespace {

namespace fs = std::filesystem;

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

/// The <name> in a folder's package.xml; empty when there is none.
std::string package_name(const fs::path& folder) {
  const fs::path manifest = folder / "package.xml";
  if (!is_file(manifest)) return {};
  tinyxml2::XMLDocument xml;
  if (xml.LoadFile(manifest.c_str()) != tinyxml2::XML_SUCCESS || xml.RootElement() == nullptr)
    return {};
  const auto* element = xml.RootElement()->FirstChildElement("name");
  const char* text = element != nullptr ? element->GetText() : nullptr;
  std::string name = text != nullptr ? text : "";
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  std::erase_if(name, blank);
  return name;
}

/// Whether the folder is called so, as it is named or where links lead to.
bool is_called(const fs::path& folder, const std::string& name) {
  std::error_code error;
  return folder.filename() == name || fs::canonical(folder, error).filename() == name;
}

/// Folders within a folder, in the order of their names; none that are hidden.
std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (!it->path().filename().string().starts_with('.') && is_folder(it->path()))
      out.push_back(it->path());
  std::sort(out.begin(), out.end());
  return out;
}

/// Looks for the folders of one package.
class PackageSearch {
 public:
  explicit PackageSearch(std::string name) : name_(std::move(name)) {}

  void place(const fs::path& place, int depth) {
    const auto before = static_cast<std::ptrdiff_t>(found_.size());
    if (package_name(place) == name_) add(place);
    add(place / name_);
    if (is_called(place, name_)) add(place);
    descend(place, depth);
    // A repository is often called as the package in it, whose package.xml tells them apart.
    std::stable_partition(found_.begin() + before, found_.end(),
                          [&](const fs::path& folder) { return package_name(folder) == name_; });
  }
  void add(const fs::path& folder) {
    std::error_code error;
    if (!is_folder(folder)) return;
    fs::path whole = fs::canonical(folder, error);
    if (error || std::find(known_.begin(), known_.end(), whole) != known_.end()) return;
    known_.push_back(std::move(whole));
    found_.push_back(folder);
  }
  [[nodiscard]] const std::vector<fs::path>& found() const { return found_; }

 private:
  void descend(const fs::path& folder, int depth) {
    if (depth == 0) return;
    for (const fs::path& inner : folders_in(folder)) {
      if (looked_at_ == kMostFolders) return;
      ++looked_at_;
      const std::string name = package_name(inner);
      if (name == name_) add(inner);
      // Packages are not within packages.
      if (!name.empty() || is_file(inner / "CATKIN_IGNORE") || is_file(inner / "COLCON_IGNORE"))
        continue;
      if (depth > 1) {
        if (is_folder(inner / name_)) add(inner / name_);
        descend(inner, depth - 1);
      }
    }
  }

  static constexpr std::size_t kMostFolders = 20000;
  std::string name_;
  std::vector<fs::path> found_, known_;  // known: canonical
  std::size_t looked_at_ = 0;
};

std::vector<fs::path> places_of(const char* variable) {
  std::vector<fs::path> out;
  const char* value = std::getenv(variable);
  const std::string list = value != nullptr ? value : "";
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = std::min(list.find(':', begin), list.size());
    if (end > begin) out.emplace_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

std::string listed(const std::vector<fs::path>& paths) {
  std::string out;
  for (const fs::path& p : paths) out.append(out.empty() ? "" : ", ").append(p.string());
  return out;
}

std::string said(const char* title, const std::vector<fs::path>& places) {
  return std::string(title) + (places.empty() ? " (none)" : " (" + listed(places) + ")");
}

/// Where a package is, and where it was looked for.
class PackagePlaces {
 public:
  /// @param folder  of the robot
  PackagePlaces(const std::string& name, const fs::path& folder,
                const std::vector<std::string>& packages)
      : name_(name),
        search_(name),
        given_(packages.begin(), packages.end()),
        ros_(places_of("ROS_PACKAGE_PATH")),
        ament_(places_of("AMENT_PREFIX_PATH")) {
    constexpr int kDepth = 5;
    for (const fs::path& place : given_) search_.place(place, kDepth);
    for (const fs::path& place : ros_) search_.place(place, kDepth);
    for (const fs::path& place : ament_) search_.add(place / "share" / name);
    for (const char* gazebo : {"GZ_SIM_RESOURCE_PATH", "SDF_PATH", "GAZEBO_MODEL_PATH"})
      for (const fs::path& place : places_of(gazebo)) search_.add(place / name);
    std::error_code error;
    for (fs::path up = fs::absolute(folder, error).lexically_normal();; up = up.parent_path()) {
      search_.place(up, 1);
      above_.push_back(up);
      if (up == up.root_path() || up.empty()) break;
    }
  }

  [[nodiscard]] const std::vector<fs::path>& found() const { return search_.found(); }

  /// @pre none was found
  [[nodiscard]] std::string why_none() const {
    return "no folder called " + name_ + ", or with a package.xml of that <name>, is in or is " +
           said("one of «package-path»", given_) + ", " + said("$ROS_PACKAGE_PATH", ros_) + ", " +
           said("share/ of $AMENT_PREFIX_PATH", ament_) + ", " +
           said("the robot's folder and those above", above_) +
           "; name it, or the folder that holds it, by «package-path»";
  }

 private:
  std::string name_;
  PackageSearch search_;
  std::vector<fs::path> given_, ros_, ament_, above_;
};

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// The file of a model's folder.
fs::path model_in(const fs::path& folder) {
  constexpr int kLastMinor = 12;
  tinyxml2::XMLDocument xml;
  const fs::path config = folder / "model.config";
  if (xml.LoadFile(config.c_str()) == tinyxml2::XML_SUCCESS && xml.RootElement() != nullptr) {
    fs::path best;
    int newest = -1;
    for (const auto* e = xml.RootElement()->FirstChildElement("sdf"); e != nullptr;
         e = e->NextSiblingElement("sdf")) {
      const char* text = e->GetText();
      const char* version = e->Attribute("version");
      const std::string_view number = version == nullptr ? "1.0" : version;
      const int minor =
          number.starts_with("1.") ? std::atoi(std::string(number.substr(2)).c_str()) : 0;
      if (text == nullptr || minor <= newest || minor > kLastMinor) continue;
      std::string name = text;
      std::erase_if(name, [](char c) { return c == '\n' || c == '\r' || c == '\t'; });
      name.erase(0, std::min(name.find_first_not_of(' '), name.size()));
      name.erase(name.find_last_not_of(' ') + 1);
      newest = minor;
      best = folder / name;
    }
    if (!best.empty()) return best;
  }
  return folder / "model.sdf";
}

}  // namespace

class PackageFolders {
 public:
  /// @param folder  of the robot
  PackageFolders(fs::path folder, std::vector<std::string> packages)
      : folder_(std::move(folder)), packages_(std::move(packages)) {}

  [[nodiscard]] const fs::path& folder() const { return folder_; }

  const PackagePlaces& of(const std::string& name) {
    const auto at = found_.find(name);
    return at != found_.end() ? at->second
                              : found_.try_emplace(name, name, folder_, packages_).first->second;
  }

 private:
  fs::path folder_;
  std::vector<std::string> packages_;
  std::map<std::string, PackagePlaces> found_;
};

fs::path find_package(const std::string& name, const fs::path& robot,
                      const std::vector<std::string>& packages) {
  const PackagePlaces looked(name, folder_of(robot), packages);
  return looked.found().empty() ? fs::path() : looked.found().front();
}

fs::path find_model(const std::string& uri, const fs::path& from,
                    const std::vector<std::string>& packages) {
  const auto fail = [&](const std::string& why) {
    throw Error(ErrorCode::InvalidInput, "no model '" + uri + "': " + why);
  };
  const std::string file = "file://", model = "model://", package = "package://";
  std::vector<fs::path> places;
  std::string why;
  if (uri.starts_with(model) || uri.starts_with(package)) {
    const std::size_t scheme = uri.starts_with(model) ? model.size() : package.size();
    const std::string path = uri.substr(std::min(uri.find_first_not_of('/', scheme), uri.size()));
    const std::string name = path.substr(0, path.find('/'));
    const std::string rest =
        path.substr(std::min(path.find_first_not_of('/', name.size()), path.size()));
    if (name.empty()) fail("it names no folder");
    const PackagePlaces looked(name, folder_of(from), packages);
    for (const fs::path& place : looked.found())
      places.push_back(rest.empty() ? place : place / rest);
    why = places.empty() ? looked.why_none() : "the folder is " + listed(places);
  } else if (uri.find("://") != std::string::npos && !uri.starts_with(file)) {
    fail("only model://, package:// and file:// are known; get it onto this machine");
  } else {
    fs::path path = uri.starts_with(file) ? uri.substr(file.size()) : uri;
    if (path.is_relative()) path = folder_of(from) / path;
    why = "there is nothing of that name: " + path.string();
    places.push_back(std::move(path));
  }
  for (const fs::path& place : places) {
    if (is_file(place)) return place;
    if (!is_folder(place)) continue;
    fs::path found = model_in(place);
    if (is_file(found)) return found;
    why = "the folder has no " + found.filename().string() + ": " + place.string();
  }
  fail(why);
  return {};
}

MeshFiles::MeshFiles(const fs::path& robot, const std::vector<std::string>& packages)
    : robot_(robot), folders_(std::make_unique<PackageFolders>(folder_of(robot), packages)) {}

MeshFiles::~MeshFiles() = default;
MeshFiles::MeshFiles(MeshFiles&& other) noexcept = default;
MeshFiles& MeshFiles::operator=(MeshFiles&& other) noexcept = default;

FoundMesh MeshFiles::look_for(const std::string& reference) {
  const auto fail = [&](const std::string& why, const std::string& what = {}) {
    return FoundMesh{{},
                     why + (reference.find("%20") != std::string::npos
                                ? "; %20 stands for a blank in URIs, but is not decoded here: "
                                  "name the file with a blank"
                                : ""),
                     what.empty() ? why : what};
  };
  const std::string file = "file://", model = "model://";
  const std::string package = reference.starts_with(model) ? model : "package://";
  if (!reference.starts_with(package)) {
    if (reference.find("://") != std::string::npos && !reference.starts_with(file))
      return fail("only package://, model:// and file:// are known");
    fs::path path =
        reference.starts_with(file) ? fs::path(reference.substr(file.size())) : fs::path(reference);
    if (path.is_relative()) path = folders_->folder() / path;
    if (is_file(path)) return {{path}, {}, {}};
    return fail("there is no file " + path.string());
  }
  // package:///NAME/FILE can only mean the same: no package is without a name.
  const std::string uri = reference.substr(
      std::min(reference.find_first_not_of('/', package.size()), reference.size()));
  const std::string name = uri.substr(0, uri.find('/'));
  const std::string rest =
      uri.substr(std::min(uri.find_first_not_of('/', name.size()), uri.size()));
  if (name.empty() || rest.empty()) return fail("it is not of the form package://NAME/FILE");

  const PackagePlaces& looked = folders_->of(name);
  std::vector<fs::path> found;
  for (const fs::path& place : looked.found())
    if (is_file(place / rest)) found.push_back(place / rest);
  if (!found.empty()) return {std::move(found), {}, {}};
  if (!looked.found().empty())
    return fail("the package is " + listed(looked.found()) + ", without a file " + rest);
  return fail(looked.why_none(), "there is no package or folder " + name);
}

std::vector<fs::path> MeshFiles::all(const std::string& reference) {
  FoundMesh found = look_for(reference);
  if (found.files.empty())
    throw Error(ErrorCode::InvalidInput,
                robot_.string() + ": no mesh file for '" + reference + "': " + found.why);
  return std::move(found.files);
}

fs::path MeshFiles::first(const std::string& reference) { return all(reference).front(); }

fs::path MeshFiles::only(const std::string& reference) {
  const std::vector<fs::path> places = all(reference);
  const std::string hash = places.size() > 1 ? io::sha256(io::read_file(places.front())) : "";
  for (auto other = places.begin() + 1; other != places.end(); ++other)
    if (io::sha256(io::read_file(*other)) != hash)
      throw Error(ErrorCode::InvalidInput,
                  robot_.string() + ": '" + reference + "' is found twice, as " +
                      places.front().string() + " and, with other contents, as " + other->string() +
                      "; which one it stands for is not known: name it without package://");
  return places.front();
}

}  // namespace kaboum::robot
