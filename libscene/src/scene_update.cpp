// Scenes brought up to date: what has changed is looked for by hashes and made anew.

#include <kaboum/base/error.h>
#include <kaboum/certify/set_options.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/scene/scene_update.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <functional>

#include "set_maker.h"

namespace kaboum::scene {
namespace {

namespace fs = std::filesystem;
using Direction = certify::SetRequest::Direction;

class Update {
 public:
  explicit Update(const SceneUpdate& update) : o_(update), sets_(update.scene) {
    const std::vector<char> bytes = io::read_file(o_.scene);
    try {
      scene_ = Json::parse(world::scene_as_json({bytes.data(), bytes.size()}, o_.scene.string()));
      unit_ = scene_.at("unit").get<std::string>();
    } catch (const Json::exception&) {
      fail("it is no scene with a unit; kaboum-check says where it is wrong");
    }
  }

  MadeScene run() try {
    for (Json& robot : list("robots")) bring_up_to_date(robot);
    for (Json& object : list("objects")) {
      if (object.contains("shape")) continue;  // made of no file
      set(object, "outer", Direction::Outer);
      if (object.contains("inner")) set(object, "inner", Direction::Inner);
    }
    for (Json& region : list("regions"))
      if (!region.contains("shape")) set(region, "inner", Direction::Inner);
    return made_ ? sets_.write(scene_) : sets_.report();
  } catch (const Json::exception&) {
    fail("a part of it is missing, or of another kind; kaboum-check says where it is wrong");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::InvalidInput, o_.scene.string() + ": " + what);
  }

  Json& list(const char* name) {
    if (!scene_.contains(name)) scene_[name] = Json::array();
    return scene_[name];
  }

  [[nodiscard]] fs::path path_of(const Json& file) const {
    return o_.scene.parent_path() / file.at("file").get<std::string>();
  }

  [[nodiscard]] bool is_current(const Json& file) const {
    try {
      return io::sha256(io::read_file(path_of(file))) == file.at("sha256").get<std::string>();
    } catch (const Error&) {
      return false;
    }
  }

  /// @param made_of  hash of what else its record may name as its source: the robot's file
  [[nodiscard]] bool is_current_set(const Json& set, const std::string& made_of = {}) const {
    if (!is_current(set)) return false;
    if (!set.contains("made_from")) return true;
    // A hash that was put there by hand does not make a set one of the file as it is now.
    const std::string source_sha256 = record_of(set).source_sha256;
    bool known = source_sha256.empty() || source_sha256 == made_of;
    for (const Json& source : set.at("made_from")) {
      if (!is_current(source)) return false;
      known = known || source.at("sha256").get<std::string>() == source_sha256;
    }
    return known;
  }

  [[nodiscard]] geom::Provenance record_of(const Json& set) const {
    try {
      return io::read_convex_set(path_of(set)).provenance;
    } catch (const Error& error) {
      fail(std::string(error.what()) +
           "; so it is not known how it was made: make the scene anew (kaboum-scene make)");
    }
  }

  /// What this command makes anew for a link: a set that somebody else made, of another shape or by
  /// other options, is not thrown away or replaced by one that holds less.
  void require_ours(const Json& robot, const Json& link, const Json& fresh,
                    const std::string& parameters, const std::string& urdf_sha256) const {
    const std::string name = link.at("link").get<std::string>();
    const auto refuse = [&](const std::string& why) {
      fail("robot '" + robot.at("name").get<std::string>() + "', link '" + name + "': its set " +
           why + "; make the sets of this robot anew by hand (kaboum-scene make, bcd-decompose)");
    };
    if (std::none_of(fresh.begin(), fresh.end(),
                     [&](const Json& f) { return f.at("link") == link.at("link"); }))
      refuse("was not made from the robot file's shapes and would be lost");
    const Json& outer = link.at("outer");
    if (!outer.contains("made_from")) refuse("does not say what it was made from");
    if (!fs::exists(path_of(outer))) return;
    const geom::Provenance record = record_of(outer);
    if (record.source_sha256 != urdf_sha256)
      refuse("was made from something else than the robot file of the scene");
    if (record.parameters != parameters)
      refuse("was made with other options (" + record.parameters + ") than the others");
    if (!link.contains("inner")) return;
    if (!link.at("inner").contains("made_from"))
      refuse("would change beside an inner set that does not say what it was made from");
    if (std::none_of(fresh.begin(), fresh.end(), [&](const Json& f) {
          return f.at("link") == link.at("link") && f.contains("inner");
        }))
      refuse("would lose its inner one: nothing lies within the shapes any more");
    if (!fs::exists(path_of(link.at("inner")))) return;
    const std::string inner = record_of(link.at("inner")).parameters;
    if (without_direction(inner) != without_direction(parameters))
      refuse("and its inner one were made with different options (" + inner + ")");
  }

  /// A record as that of an outer set; as it is where not all of it is understood.
  static std::string without_direction(const std::string& record) {
    certify::RobotSetOptions options;
    if (!read_record(certify::robot_set_options(), record, options).empty()) return record;
    options.set.request.direction = certify::SetRequest::Direction::Outer;
    return kaboum::record_of(certify::robot_set_options(), options);
  }

  /// How a set was made, by the record in its container.
  [[nodiscard]] SceneSetOptions options_of(const Json& set) const {
    const fs::path path = path_of(set);
    const std::string parameters = record_of(set).parameters;
    SceneSetOptions out;
    out.packages = o_.packages;
    out.cache = o_.cache;
    out.progress = o_.progress;
    out.format_of = o_.format_of;
    out.sets.unit = unit_;
    if (const auto unknown = apply_parameters(parameters, out))
      fail(path.string()
               .append(" is out of date and was made with '")
               .append(*unknown)
               .append("', which is not known here: make it anew with bcd-decompose, and put its "
                       "SHA-256 into the scene; it was made with ")
               .append(parameters));
    if (parameters.empty())
      fail(path.string() + " is out of date, and does not say how it was made: make it anew");
    return out;
  }

  /// The mesh that a set was made from: by its own record that of all in 'made_from' with this
  /// hash.
  [[nodiscard]] std::string mesh_of(const Json& set) const {
    const std::string sha256 = record_of(set).source_sha256;
    for (const Json& source : set.at("made_from"))
      if (!sha256.empty() && source.at("sha256").get<std::string>() == sha256)
        return path_of(source).string();
    return path_of(set.at("made_from").front()).string();  // the mesh itself comes first
  }

  void set(Json& thing, const char* member, Direction direction) {
    Json& set = thing.at(member);
    if (is_current_set(set)) return;
    if (!set.contains("made_from") || set.at("made_from").empty())
      fail(path_of(set).string() +
           " is out of date, and 'made_from' does not say which mesh it is made from");
    Json made = sets_.mesh(thing.at("name").get<std::string>(), mesh_of(set), direction,
                           path_of(set), options_of(set));
    if (made.is_null())
      fail("no body lies within " + mesh_of(set) + " any more at the epsilon of " +
           path_of(set).string() + ": make that anew with a smaller one, or take it out");
    set = std::move(made);
    made_ = true;
  }

  /// Names of the links whose sets are out of date; all where the robot's file has changed.
  [[nodiscard]] std::vector<std::string> stale_links(const Json& robot) const {
    const bool moved = !is_current(robot.at("urdf"));
    const std::string urdf_sha256 = robot.at("urdf").at("sha256");
    std::vector<std::string> out;
    for (const Json& link : robot.at("links")) {
      if (moved || !is_current_set(link.at("outer"), urdf_sha256) ||
          (link.contains("inner") && !is_current_set(link.at("inner"), urdf_sha256)))
        out.push_back(link.at("link").get<std::string>());
    }
    return out;
  }

  void bring_up_to_date(Json& robot) {
    Json& links = robot.at("links");
    const bool moved = !is_current(robot.at("urdf"));
    const std::vector<std::string> stale = stale_links(robot);
    if (stale.empty() && !moved) return;
    if (links.empty()) fail("robot '" + robot.at("name").get<std::string>() + "' has no links");
    // Sets that cannot be read do not say how they were made; the others do.
    const Json* known = &links.front().at("outer");
    for (const Json& link : links)
      if (is_current(link.at("outer"))) known = &link.at("outer");
    SceneSetOptions options = options_of(*known);
    options.visual = robot.contains("shapes") && robot.at("shapes") == "visual";
    if (!moved) options.links = stale;
    for (const Json& link : links)
      if (link.contains("inner")) {
        if (!options.inner_links) options.inner_links.emplace();
        options.inner_links->push_back(link.at("link").get<std::string>());
      }
    const Json made =
        sets_.robot(robot.at("name").get<std::string>(), path_of(robot.at("urdf")).string(),
                    path_of(*known).parent_path(), options);
    replace_links(robot, made, record_of(*known).parameters,
                  moved ? std::vector<std::string>{} : stale);
    robot["urdf"] = made.at("urdf");
    if (robot.erase("never_in_contact") > 0)
      sets_.notes.push_back(o_.scene.string() + ": robot '" + robot.at("name").get<std::string>() +
                            "': 'never_in_contact' was proved of the sets before and is taken "
                            "out; prove it anew (kaboum-scene pairs)");
    made_ = true;
  }

  /// @param only  the links that were made anew; empty: all
  void replace_links(Json& robot, const Json& made, const std::string& parameters,
                     const std::vector<std::string>& only) const {
    Json& links = robot.at("links");
    Json fresh = made.at("links");
    const auto is_fresh = [&](const Json& link) {
      return only.empty() || std::find(only.begin(), only.end(), link.at("link")) != only.end();
    };
    for (const Json& link : links)
      if (is_fresh(link))
        require_ours(robot, link, fresh, parameters, robot.at("urdf").at("sha256"));
    if (only.empty()) {
      links = std::move(fresh);
      return;
    }
    for (Json& link : links)
      for (const Json& one : fresh)
        if (one.at("link") == link.at("link")) link = one;
  }

  const SceneUpdate& o_;
  SetMaker sets_;
  Json scene_;
  std::string unit_;
  bool made_ = false;
};

}  // namespace

MadeScene update_scene(const SceneUpdate& update) { return Update(update).run(); }

std::vector<std::string> files_of(const fs::path& scene) {
  std::vector<std::string> out{scene.string()};
  const std::vector<char> bytes = io::read_file(scene);
  const std::string text = world::scene_as_json({bytes.data(), bytes.size()}, scene.string());
  const std::function<void(const Json&)> look_at = [&](const Json& value) {
    if (value.is_object() && value.contains("file") && value.at("file").is_string())
      out.push_back((scene.parent_path() / value.at("file").get<std::string>()).string());
    if (value.is_structured())
      for (const Json& part : value) look_at(part);
  };
  // What is no JSON names no files; whoever reads the scene says where it is wrong.
  look_at(Json::parse(text, nullptr, false));
  return out;
}

}  // namespace kaboum::scene
