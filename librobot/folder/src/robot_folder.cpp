// The folder that is made of a robot: whose it is, names in it, what is written.

#include <fcntl.h>
#include <kaboum/base/error.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/robot_folder/robot_folder.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <set>
#include <string_view>

namespace kaboum::robot_folder {
namespace {

namespace fs = std::filesystem;

void create(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Error(ErrorCode::OutputFailed,
                folder.string() + ": cannot be created: " + error.message());
}

/// Programs that write into one folder at the same time take turns: it is one's or the other's, not
/// of both. Nothing stays when a program is ended. File systems that cannot lock folders, as NFS,
/// leave this undone.
class Turn {
 public:
  explicit Turn(const fs::path& folder)
      : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    do {
      is_mine_ = folder_ >= 0 && ::flock(folder_, LOCK_EX) == 0;
    } while (folder_ >= 0 && !is_mine_ && errno == EINTR);
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  ~Turn() {
    if (folder_ >= 0) ::close(folder_);
  }
  /// Whether no other program that takes turns is at work here.
  [[nodiscard]] bool is_mine() const { return is_mine_; }

 private:
  int folder_;
  bool is_mine_ = false;
};

/// Begins the name of a file that says that a folder is ours and its robot not whole: there while
/// it is written, one of each program, lest the first to end takes away what the others say.
constexpr const char* kUnfinished = ".kaboum-unfinished";

fs::path own_mark(const fs::path& folder) {
  std::array<char, 65> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  return folder / (std::string(kUnfinished) + "." + host.data() + "." + std::to_string(::getpid()));
}

std::vector<fs::path> marks_in(const fs::path& folder) {
  std::vector<fs::path> marks;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().filename().string().starts_with(kUnfinished)) marks.push_back(entry.path());
  return marks;
}

/// What makes a document ours, to be replaced when its robot is made anew: others are somebody's
/// own.
constexpr std::string_view kMadeByUs =
    "<!-- Made by KABouM, which replaces this file: the shapes are those in bodies/ or meshes/ -->";

/// Of all documents but the URDF.
constexpr std::array<const char*, 4> kExtensions{".xml", ".sdf", ".srdf", ".usda"};

bool is_made_by_us(const fs::path& document) {
  try {
    const std::vector<char> text = io::read_file(document);
    return std::string_view(text.data(), text.size()).find(kMadeByUs) != std::string_view::npos;
  } catch (const Error&) {
    return false;
  }
}

void refuse(const fs::path& place) {
  throw Error(ErrorCode::OutputFailed, place.string() +
                                           ": exists, and is not marked as a result of this "
                                           "program; remove it or name another folder");
}

/// The robot's name in the new folder, which says what is in it: the one that was read may not.
fs::path urdf_name(const robot::RobotFile& robot) {
  using Format = robot::RobotFile::Format;
  fs::path name = robot.path.filename();
  if (robot::is_xacro(name)) name.replace_extension();
  std::string extension = name.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto with = [&](const char* its) {
    for (const char* known : {".urdf", ".sdf", ".xml", ".mjcf"})
      if (extension == known) return name.replace_extension(its);
    return fs::path(name.string() + its);
  };
  switch (robot.format) {
    case Format::Urdf:
      return extension == ".urdf" ? name : with(".urdf");
    case Format::Sdf:
      return extension == ".sdf" ? name : with(".sdf");
    case Format::Mjcf:
      return extension == ".xml" || extension == ".mjcf" ? name : with(".xml");
    case Format::Rl:
      break;
  }
  return name;
}

}  // namespace

std::string marked(std::string document) {
  if (document.find(kMadeByUs) != std::string::npos) return document;
  if (document.starts_with("#usda")) document += "# ";
  document += std::string(kMadeByUs) + "\n";
  return document;
}

RobotFolder::RobotFolder(fs::path folder, const robot::RobotFile& robot, std::string part,
                         std::string extension)
    : folder_(std::move(folder)),
      urdf_(folder_ / urdf_name(robot)),
      part_(std::move(part)),
      extension_(std::move(extension)),
      robot_(robot.robot) {
  std::error_code error;
  if (fs::equivalent(urdf_, robot.path, error))
    throw Error(ErrorCode::InvalidArgument,
                urdf_.string() + ": would overwrite the input; name another folder");
  require_own();
}

fs::path RobotFolder::document(const std::string& extension) const {
  return fs::path(urdf_).replace_extension(extension);
}

/// What is new is named after its mesh: that of another robot in the folder would be replaced.
void RobotFolder::require_own() const {
  std::error_code error;
  if (fs::exists(urdf_, error) && !is_made_by_us(urdf_)) refuse(urdf_);
  if (fs::exists(urdf_, error) && !fs::exists(folder_ / part_, error))
    throw Error(ErrorCode::OutputFailed,
                urdf_.string() + ": exists, and not with " + part_ +
                    "/ beside it as a result of this kind would; remove it or name another folder");
  for (const auto& entry : fs::directory_iterator(folder_, error))
    if (entry.path().extension() == ".urdf" && entry.path().filename() != urdf_.filename())
      throw Error(ErrorCode::OutputFailed, entry.path().string() + ": another robot, whose " +
                                               part_ + " would be replaced; name another folder");
}

/// Files are ours where the robot is, or where it was being written: its folder was looked at.
void RobotFolder::require_replaceable(const fs::path& place) const {
  std::error_code error;
  if (fs::exists(place, error) && !fs::exists(urdf_, error) && marks_in(folder_).empty())
    refuse(place);
}

bool RobotFolder::has_other_documents(const RobotContents& contents) const {
  return std::ranges::any_of(kExtensions, [&](const char* extension) {
    const auto is_this = [&](const auto& d) { return d.first == extension; };
    return document(extension) != urdf_ && std::ranges::none_of(contents.documents, is_this) &&
           is_made_by_us(document(extension));
  });
}

void RobotFolder::require_own_document(const std::string& extension) const {
  std::error_code error;
  const fs::path place = document(extension);
  if (fs::exists(place, error) && !is_made_by_us(place)) refuse(place);
}

/// What is known of an earlier robot here does not hold of the bodies that now come one by one: all
/// documents go, also those that are not made this time.
void RobotFolder::begin() const {
  io::write_file(own_mark(folder_), std::string_view("A robot is being written here.\n"));
  std::error_code error;
  fs::remove(urdf_, error);
  for (const char* extension : kExtensions)
    if (is_made_by_us(document(extension))) fs::remove(document(extension), error);
}

void RobotFolder::write(const RobotContents& contents) {
  create(folder_);
  const Turn turn(folder_);
  require_own();  // others may have been here meanwhile
  std::error_code error;
  for (const auto& [extension, text] : contents.documents) require_own_document(extension);
  begin();
  create(folder_ / part_);
  if (!contents.links.empty()) create(folder_ / "links");
  for (const StoredMesh& s : stored_)
    if (!s.left_out) contents.write_mesh(s, folder_ / place_of(s));
  const std::vector<std::string> links = link_files(contents);
  for (std::size_t i = 0; i < links.size(); ++i)
    io::write_file(folder_ / links[i], contents.links[i].second);
  for (const auto& [extension, text] : contents.documents)
    io::write_file(document(extension), text);
  io::write_file(urdf_, contents.urdf);
  // Those of programs that were ended are found here, too, where the folder can be locked.
  for (const fs::path& mark : turn.is_mine() ? marks_in(folder_) : std::vector{own_mark(folder_)})
    fs::remove(mark, error);
}

std::vector<std::string> RobotFolder::link_files(const RobotContents& contents) {
  std::vector<std::string> files;
  io::FileNames names;
  for (const auto& [link, container] : contents.links)
    files.push_back("links/" + names.unique(link) + ".glb");
  return files;
}

std::vector<std::string> RobotFolder::stale(const std::vector<std::string>& links) const {
  std::set<fs::path> written(links.begin(), links.end());
  for (const StoredMesh& s : stored_)
    if (!s.left_out) written.insert(place_of(s));
  std::vector<std::string> out;
  for (const std::string& part : {part_, std::string("links")}) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder_ / part, error)) {
      const fs::path name = fs::path(part) / entry.path().filename();
      if (!written.contains(name)) out.push_back(name.generic_string());
    }
  }
  std::ranges::sort(out);
  return out;
}

/// No new file is to get this stem: those of bodies end with a number.
void RobotFolder::reserve_stem(const std::string& stem) {
  if (!extension_.empty()) names_.reserve(stem);
  const std::size_t dash = stem.rfind('-');
  if (dash != std::string::npos && stem.size() - dash > 4 &&
      stem.find_first_not_of("0123456789", dash + 1) == std::string::npos)
    names_.reserve(stem.substr(0, dash));
}

void RobotFolder::name_meshes(const robot::LinkMeshes& meshes, const robot::ShapeChoice& choice,
                              const std::vector<std::string>& taken) {
  for (const std::string& stem : taken) reserve_stem(stem);
  for (const robot::Link& link : robot_.links) reserve_stem(io::plain_file_name(link.name));
  for (const robot::LinkShape& shape : meshes.shapes) {
    std::optional<std::size_t>& index = of_shape_.emplace_back();
    if (!shape.mesh) continue;
    const geom::Vec3& scale = choice.shapes_of(robot_.links[shape.link])[shape.index].size;
    const auto same = std::find_if(stored_.begin(), stored_.end(), [&](const StoredMesh& s) {
      return s.mesh == *shape.mesh && s.scale == scale;
    });
    index = static_cast<std::size_t>(same - stored_.begin());
    if (same != stored_.end()) continue;
    const fs::path& file = meshes.meshes[*shape.mesh].file;
    const std::string wish = file.stem().string() + (extension_.empty() ? "" : "-outer");
    stored_.push_back({*shape.mesh, scale, names_.unique(wish), extension_});
    require_replaceable(stored_.back());
  }
}

void RobotFolder::require_replaceable(const StoredMesh& stored) const {
  const fs::path place = folder_ / place_of(stored);
  stored.extension.empty() ? io::require_replaceable(place) : require_replaceable(place);
}

void RobotFolder::leave_out(std::size_t mesh) {
  for (StoredMesh& s : stored_)
    if (s.mesh == mesh) s.left_out = true;
}

void RobotFolder::set_extension(std::size_t mesh, const std::string& extension) {
  for (StoredMesh& s : stored_) {
    if (s.mesh != mesh) continue;
    s.extension = extension;
    require_replaceable(s);
  }
}

}  // namespace kaboum::robot_folder
