// Packages as ROS 1 (rospack: crawls $ROS_PACKAGE_PATH), ROS 2 (ament: PREFIX/share/NAME) and
// people without either (the folder beside the robot's file) find them.

#include <kaboum/robot/mesh_files.h>

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cstdlib>

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
    if (package_name(place) == name_) add(place);
    add(place / name_);
    if (is_called(place, name_)) add(place);
    descend(place, depth);
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

}  // namespace

std::vector<fs::path> find_mesh(const std::string& reference, const fs::path& robot,
                                const std::vector<std::string>& packages) {
  const auto fail = [&](const std::string& why) -> std::vector<fs::path> {
    throw Error(ErrorCode::InvalidInput,
                robot.string() + ": no mesh file for '" + reference + "': " + why +
                    (reference.find("%20") != std::string::npos
                         ? "; %20 stands for a blank in URIs, but is not decoded here: name the "
                           "file with a blank"
                         : ""));
  };
  const fs::path folder = robot.has_parent_path() ? robot.parent_path() : fs::path(".");
  const std::string file = "file://", model = "model://";
  const std::string package = reference.starts_with(model) ? model : "package://";
  if (!reference.starts_with(package)) {
    if (reference.find("://") != std::string::npos && !reference.starts_with(file))
      return fail("only package://, model:// and file:// are known");
    fs::path path =
        reference.starts_with(file) ? fs::path(reference.substr(file.size())) : fs::path(reference);
    if (path.is_relative()) path = folder / path;
    if (is_file(path)) return {path};
    return fail("there is no file " + path.string());
  }
  // package:///NAME/FILE can only mean the same: no package is without a name.
  const std::string uri = reference.substr(
      std::min(reference.find_first_not_of('/', package.size()), reference.size()));
  const std::string name = uri.substr(0, uri.find('/'));
  const std::string rest =
      uri.substr(std::min(uri.find_first_not_of('/', name.size()), uri.size()));
  if (name.empty() || rest.empty()) return fail("it is not of the form package://NAME/FILE");

  constexpr int kDepth = 5;
  PackageSearch search(name);
  const std::vector<fs::path> given(packages.begin(), packages.end());
  const std::vector<fs::path> ros = places_of("ROS_PACKAGE_PATH");
  const std::vector<fs::path> ament = places_of("AMENT_PREFIX_PATH");
  for (const fs::path& place : given) search.place(place, kDepth);
  for (const fs::path& place : ros) search.place(place, kDepth);
  for (const fs::path& place : ament) search.add(place / "share" / name);
  for (const char* gazebo : {"GZ_SIM_RESOURCE_PATH", "SDF_PATH", "GAZEBO_MODEL_PATH"})
    for (const fs::path& place : places_of(gazebo)) search.add(place / name);
  std::error_code error;
  std::vector<fs::path> above;
  for (fs::path up = fs::absolute(folder, error).lexically_normal();; up = up.parent_path()) {
    search.place(up, 1);
    above.push_back(up);
    if (up == up.root_path() || up.empty()) break;
  }
  std::vector<fs::path> found;
  for (const fs::path& place : search.found())
    if (is_file(place / rest)) found.push_back(place / rest);
  if (!found.empty()) return found;
  if (!search.found().empty())
    return fail("the package is " + listed(search.found()) + ", without a file " + rest);
  return fail("no folder called " + name + ", or with a package.xml of that <name>, is in or is " +
              said("one of «package-path»", given) + ", " + said("$ROS_PACKAGE_PATH", ros) + ", " +
              said("share/ of $AMENT_PREFIX_PATH", ament) + ", " +
              said("the robot's folder and those above", above) +
              "; name it, or the folder that holds it, by «package-path»");
}

fs::path resolve_mesh(const std::string& reference, const fs::path& robot,
                      const std::vector<std::string>& packages) {
  return find_mesh(reference, robot, packages).front();
}

fs::path find_only_mesh(const std::string& reference, const fs::path& robot,
                        const std::vector<std::string>& packages) {
  const std::vector<fs::path> places = find_mesh(reference, robot, packages);
  const std::string hash = places.size() > 1 ? io::sha256(io::read_file(places.front())) : "";
  for (auto other = places.begin() + 1; other != places.end(); ++other)
    if (io::sha256(io::read_file(*other)) != hash)
      throw Error(ErrorCode::InvalidInput,
                  robot.string() + ": '" + reference + "' is found twice, as " +
                      places.front().string() + " and, with other contents, as " + other->string() +
                      "; which one it stands for is not known: name it without package://");
  return places.front();
}

}  // namespace kaboum::robot
