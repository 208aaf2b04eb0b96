// $(find NAME) of xacro: packages are found as those of meshes are, with or without ROS.

#include "xacro_packages.h"

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/mesh_files.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <set>
#include <span>
#include <string_view>

#include "is_file.h"

namespace kaboum::robot {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 2000;
constexpr std::uintmax_t kLargestFile = std::uintmax_t{4} << 20U;
constexpr int kDeepest = 6;

/// As ament_index_python has it: that one is taken where it is installed.
constexpr const char* kModule =
    "import importlib.machinery as _machinery, os as _os, sys as _sys\n"
    "_here = _os.path.dirname(_os.path.dirname(_os.path.abspath(__file__)))\n"
    "_there = _machinery.PathFinder.find_spec(\n"
    "    __name__, [p for p in _sys.path if _os.path.abspath(p or '.') != _here])\n"
    "if _there is not None and _there.submodule_search_locations:\n"
    "    __path__[:] = list(_there.submodule_search_locations)\n";
constexpr const char* kPackages =
    "import os\n"
    "class PackageNotFoundError(KeyError):\n"
    "    def __str__(self):\n"
    "        return f\"package '{self.args[0]}' not found\"\n"
    "def get_package_prefix(name):\n"
    "    for prefix in os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep):\n"
    "        if os.path.isfile(os.path.join(prefix, 'share/ament_index/resource_index/packages', "
    "name)):\n"
    "            return prefix\n"
    "    raise PackageNotFoundError(name)\n"
    "def get_package_share_directory(name, print_warning=True):\n"
    "    return os.path.join(get_package_prefix(name), 'share', name)\n";

std::string lower_extension(const fs::path& path) {
  std::string out = path.extension().string();
  std::ranges::transform(out, out.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

bool is_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
}

/// Names in $(find NAME) and find('NAME'), each with its place.
std::vector<std::pair<std::string, std::size_t>> packages_in(std::string_view text) {
  std::vector<std::pair<std::string, std::size_t>> out;
  for (std::size_t at = text.find("find"); at != std::string_view::npos;
       at = text.find("find", at + 1)) {
    std::size_t i = at + 4;
    const bool word = at >= 2 && text.substr(at - 2, 2) == "$(";
    const bool call = text.substr(i, 2) == "('" || text.substr(i, 2) == "(\"";
    if (!word && !call) continue;
    if (call) i += 2;
    while (word && i < text.size() && (text[i] == ' ' || text[i] == '\t')) ++i;
    const std::size_t begin = i;
    while (i < text.size() && is_of_name(text[i])) ++i;
    const std::string_view name = text.substr(begin, i - begin);
    if (!name.empty() && name.front() != '.' && name.front() != '-') out.emplace_back(name, at);
  }
  return out;
}

/// Values of filename in elements that include.
std::vector<std::string> includes_in(std::string_view text) {
  std::vector<std::string> out;
  for (std::size_t at = text.find(":include"); at != std::string_view::npos;
       at = text.find(":include", at + 1)) {
    const std::string_view element = text.substr(at, text.find('>', at) - at);
    std::size_t i = element.find("filename");
    if (i == std::string_view::npos) continue;
    i = element.find_first_of("\"'", i);
    if (i == std::string_view::npos) continue;
    const std::size_t end = element.find(element[i], i + 1);
    if (end != std::string_view::npos) out.emplace_back(element.substr(i + 1, end - i - 1));
  }
  return out;
}

/// Texts that may name packages, one file after the other.
class Search {
 public:
  explicit Search(const std::vector<std::string>& places) : places_(places) {}

  XacroPackages run(const fs::path& file) {
    robot_ = file;
    waiting_.push_back(file);
    while (!waiting_.empty() && known_.size() < kMostFiles) {
      const fs::path next = waiting_.back();
      waiting_.pop_back();
      if (known_.insert(next.lexically_normal()).second) look_at(next);
    }
    return std::move(out_);
  }

 private:
  void look_at(const fs::path& file) {
    std::error_code error;
    if (!is_file(file) || fs::file_size(file, error) > kLargestFile || error) return;
    std::string text;
    try {
      const std::vector<char> bytes = io::read_file(file);
      text.assign(bytes.begin(), bytes.end());
    } catch (const Error&) {
      return;  // xacro says so
    }
    for (const auto& [name, at] : packages_in(text))
      ask(name, file,
          1 + static_cast<std::size_t>(
                  std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n')));
    for (const std::string& name : includes_in(text)) include(name, file);
  }

  void ask(const std::string& name, const fs::path& file, std::size_t line) {
    if (folders_.contains(name) || out_.missing.contains(name)) return;
    const fs::path folder = find_package(name, robot_, places_);
    if (folder.empty()) {
      out_.missing.emplace(name, file.string() + ":" + std::to_string(line));
      return;
    }
    std::error_code error;
    const fs::path whole = fs::absolute(folder, error);
    folders_[name] = whole;
    out_.found.emplace_back(name, whole);
    add_files_in(whole, kDeepest);
  }

  void add_files_in(const fs::path& folder, int depth) {
    std::error_code error;
    std::vector<fs::path> inner;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
      if (it->path().filename().string().starts_with('.')) continue;
      std::error_code of_kind;
      if (it->is_directory(of_kind) && !it->is_symlink(of_kind)) inner.push_back(it->path());
      const std::string extension = lower_extension(it->path());
      if (extension == ".xacro" || extension == ".urdf" || extension == ".xml")
        waiting_.push_back(it->path());
    }
    if (depth > 0 && waiting_.size() < kMostFiles)
      for (const fs::path& next : inner) add_files_in(next, depth - 1);
  }

  void include(std::string name, const fs::path& file) {
    for (const auto& [package, unused] : packages_in(name)) {
      const auto folder = folders_.find(package);
      const std::size_t begin = name.find("$(find"), end = name.find(')', begin);
      if (folder == folders_.end() || begin == std::string::npos || end == std::string::npos)
        return;
      name.replace(begin, end + 1 - begin, folder->second.string());
    }
    if (name.find('$') != std::string::npos) return;
    const fs::path path(name);
    waiting_.push_back(path.is_absolute() ? path : file.parent_path() / path);
  }

  const std::vector<std::string>& places_;
  fs::path robot_;
  XacroPackages out_;
  std::map<std::string, fs::path> folders_;
  std::vector<fs::path> waiting_;
  std::set<fs::path> known_;
};

void write_text(const fs::path& file, std::string_view text) {
  io::write_file(file, std::span<const char>(text.data(), text.size()));
}

}  // namespace

XacroPackages packages_of_xacro(const fs::path& file, const std::vector<std::string>& places) {
  return Search(places).run(file);
}

PackageView::PackageView(const XacroPackages& packages) {
  for (char** variable = environ; *variable != nullptr; ++variable)
    environment_.emplace_back(*variable);
  if (packages.found.empty()) return;
  std::error_code error;
  fs::path pattern = fs::temp_directory_path(error) / "kaboum-xacro-XXXXXX";
  std::string name = pattern.string();
  if (error || ::mkdtemp(name.data()) == nullptr)
    throw Error(ErrorCode::OutputFailed, "no folder for the packages of xacro can be made in " +
                                             pattern.parent_path().string() +
                                             "; set TMPDIR to a place that can be written");
  folder_ = name;
  const fs::path share = folder_ / "prefix" / "share", python = folder_ / "python";
  const fs::path index = share / "ament_index" / "resource_index" / "packages";
  fs::create_directories(index, error);
  fs::create_directories(python / "ament_index_python", error);
  write_text(python / "ament_index_python" / "__init__.py", kModule);
  write_text(python / "ament_index_python" / "packages.py", kPackages);
  std::string ros;
  for (const auto& [package, place] : packages.found) {
    write_text(index / package, "");
    fs::create_directory_symlink(place, share / package, error);  // else xacro says so
    ros += (ros.empty() ? "" : ":") + place.string();
  }
  const auto put_before = [&](const std::string& variable, const std::string& value) {
    const std::string begin = variable + "=";
    for (std::string& entry : environment_)
      if (entry.starts_with(begin)) {
        entry = begin + value +
                (entry.size() > begin.size() ? ":" + entry.substr(begin.size()) : std::string());
        return;
      }
    environment_.push_back(begin + value);
  };
  put_before("AMENT_PREFIX_PATH", (folder_ / "prefix").string());
  put_before("ROS_PACKAGE_PATH", ros);
  put_before("PYTHONPATH", python.string());
}

PackageView::~PackageView() {
  std::error_code error;
  if (!folder_.empty()) fs::remove_all(folder_, error);
}

}  // namespace kaboum::robot
