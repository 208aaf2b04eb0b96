// Spheres of robots as others write them: cuRobo's YAML, XRDF, SRDF and URDF.
#include <kaboum/robot/sphere_file.h>

#include <kaboum/base/counted.h>
#include <kaboum/base/error.h>
#include <kaboum/base/number_text.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/robot/sphere_approximation.h>

#include <tinyxml2.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#ifdef KABOUM_HAS_YAML
#include <yaml-cpp/yaml.h>
#endif

namespace kaboum::robot {
namespace {

[[noreturn]] void fail(const std::string& file, int line, const std::string& what) {
  throw Error(ErrorCode::InvalidInput,
              file + (line > 0 ? ":" + std::to_string(line) : "") + ": " + what);
}

void add_ball(LinkSpheres& link, const geom::Vec3& center, double radius, const std::string& file,
              int line) {
  if (!center.allFinite() || !std::isfinite(radius))
    fail(file, line, "link '" + link.link + "': a number is not finite");
  if (!(radius > 0))
    fail(
        file, line,
        "link '" + link.link + "': a sphere's radius must be above 0; leave out what is no sphere");
  geom::ConvexBody body;
  body.name = "sphere_" + std::to_string(link.balls.bodies.size());
  body.core.vertices = {center};
  body.radius = radius;
  link.balls.bodies.push_back(std::move(body));
}

/// All digits.
std::string exact_text(double x) {
  std::ostringstream out;
  out << std::setprecision(17) << x;
  return out.str();
}

std::string exact_text(const geom::Vec3& p) {
  return exact_text(p.x()) + " " + exact_text(p.y()) + " " + exact_text(p.z());
}

const LinkSpheres* find_link(const std::vector<LinkSpheres>& links, const char* name) {
  const auto at = std::ranges::find_if(
      links, [&](const LinkSpheres& link) { return name != nullptr && link.link == name; });
  return at == links.end() ? nullptr : &*at;
}

std::string printed(const tinyxml2::XMLDocument& document) {
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

tinyxml2::XMLElement* child_of(tinyxml2::XMLElement* element, const char* name) {
  tinyxml2::XMLElement* out = element->FirstChildElement(name);
  return out != nullptr ? out : element->InsertNewChildElement(name);
}

/// The URDF with other spheres.
std::string edited_urdf(const std::string& text, const std::vector<LinkSpheres>& wanted) {
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  tinyxml2::XMLElement* link = document.RootElement()->FirstChildElement("link");
  for (; link != nullptr; link = link->NextSiblingElement("link")) {
    const LinkSpheres* own = find_link(wanted, link->Attribute("name"));
    if (own == nullptr) continue;
    tinyxml2::XMLElement* collision = link->FirstChildElement("collision");
    for (const geom::ConvexBody& ball : own->balls.bodies) {
      if (collision == nullptr) collision = link->InsertNewChildElement("collision");
      child_of(collision, "origin")->SetAttribute("xyz", exact_text(ball.core.vertices[0]).c_str());
      child_of(child_of(collision, "geometry"), "sphere")
          ->SetAttribute("radius", exact_text(ball.radius).c_str());
      collision = collision->NextSiblingElement("collision");
    }
  }
  return printed(document);
}

/// The SRDF with other spheres.
std::string edited_srdf(const std::string& text, const std::vector<LinkSpheres>& wanted) {
  constexpr const char* kTag = "link_sphere_approximation";
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  tinyxml2::XMLElement* root = document.RootElement();
  for (const LinkSpheres& own : wanted) {
    tinyxml2::XMLElement* link = root->FirstChildElement(kTag);
    while (link != nullptr && own.link != link->Attribute("link"))
      link = link->NextSiblingElement(kTag);
    if (link == nullptr) {
      if (own.balls.bodies.empty()) continue;
      link = root->InsertNewChildElement(kTag);
      link->SetAttribute("link", own.link.c_str());
    }
    tinyxml2::XMLElement* sphere = link->FirstChildElement("sphere");
    for (const geom::ConvexBody& ball : own.balls.bodies) {
      if (sphere == nullptr) sphere = link->InsertNewChildElement("sphere");
      sphere->SetAttribute("center", exact_text(ball.core.vertices[0]).c_str());
      sphere->SetAttribute("radius", exact_text(ball.radius).c_str());
      sphere = sphere->NextSiblingElement("sphere");
    }
  }
  return printed(document);
}

/// What a well-formed SRDF calls its robot.
std::string robot_name_of(const std::string& text) {
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  const tinyxml2::XMLElement* root = document.RootElement();
  const char* name = root != nullptr ? root->Attribute("name") : nullptr;
  return name != nullptr ? name : "";
}

SphereFile read_urdf(const std::string& file, Robot robot) {
  SphereFile out{{}, "spheres of a URDF", {}, {}, robot.name};
  for (const Link& link : robot.links) {
    if (link.collision.empty()) continue;
    LinkSpheres one{link.name, link.collision.front().line, {}};
    for (const Geometry& g : link.collision) {
      if (g.shape != Geometry::Shape::Sphere)
        fail(file, g.line,
             "link '" + link.name + "': its collision shapes are to be spheres; this is a " +
                 describe(g));
      add_ball(one, g.origin.translation, g.size.x(), file, g.line);
    }
    out.links.push_back(std::move(one));
  }
  if (out.links.empty()) fail(file, 0, "no link has a sphere as a collision shape");
  out.robot = std::move(robot);
  return out;
}

SphereFile read_srdf(const std::string& file, const std::string& text) {
  SphereFile out{{}, "spheres of an SRDF", {}, {}, robot_name_of(text)};
  for (const SphereApproximation& link : parse_sphere_approximations(text, file)) {
    LinkSpheres one{link.link, link.line, {}};
    for (const LinkSphere& sphere : link.spheres) {
      // As MoveIt reads it: the link has no shape.
      if (sphere.radius == 0 && link.spheres.size() == 1) continue;
      add_ball(one, sphere.center, sphere.radius, file, sphere.line);
    }
    out.links.push_back(std::move(one));
  }
  if (out.links.empty())
    fail(file, 0,
         "no spheres; as SRDF has them:\n  <link_sphere_approximation link=\"arm\">\n    <sphere "
         "center=\"0 0 0.1\" radius=\"0.05\"/>\n  </link_sphere_approximation>");
  return out;
}

constexpr std::string_view kCountWords = "# spheres in this file: ";

#ifdef KABOUM_HAS_YAML

/// Where a text states the number of its spheres.
struct StatedCount {
  int line = 0;
  std::size_t at = 0, length = 0;  ///< of the digits
  std::size_t count = 0;
};

/// @throws Error{InvalidInput} on what is no number there
std::vector<StatedCount> stated_counts(const std::string& file, const std::string& text) {
  std::vector<StatedCount> out;
  int line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    // Also where the text was put below something, and behind a byte order mark.
    const std::size_t mark = begin == 0 && text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
    const std::size_t words = std::min(text.find_first_not_of(" \t", begin + mark), end);
    if (std::string_view(text).substr(words, end - words).starts_with(kCountWords)) {
      StatedCount one{line, words + kCountWords.size(), 0, 0};
      const char* first = text.data() + one.at;
      const auto [last, error] = std::from_chars(first, text.data() + end, one.count);
      one.length = static_cast<std::size_t>(last - first);
      if (error != std::errc() || one.at + one.length != text.find_last_not_of(" \r", end - 1) + 1)
        fail(file, line, "the number of spheres is to be stated here");
      out.push_back(one);
    }
    begin = end + 1;
  }
  return out;
}

int line_of(const YAML::Node& node) { return node.Mark().line + 1; }

double number_of(const YAML::Node& node, const std::string& file, const std::string& what) {
  if (node.IsScalar()) {
    double value = 0;
    if (YAML::convert<double>::decode(node, value)) return value;
  }
  fail(file, line_of(node), what + " must be a number");
}

/// Replacements in a text, by the places of what YAML has there.
class TextEdits {
 public:
  explicit TextEdits(const std::string& text) : text_(text) {
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n') lines_.push_back(i + 1);
    lines_.push_back(text.size());
  }

  void replace(const YAML::Node& scalar, const std::string& with) {
    const std::size_t at = place(scalar.Mark().line, scalar.Mark().column);
    const bool quoted = at < text_.size() && (text_[at] == '"' || text_[at] == '\'');
    edits_.push_back({at, scalar.Scalar().size() + (quoted ? 2 : 0), with});
    if (text_.substr(at + (quoted ? 1 : 0), scalar.Scalar().size()) != scalar.Scalar())
      wrong_ = scalar.Mark().line + 1;
  }
  void replace(std::size_t at, std::size_t length, const std::string& with) {
    edits_.push_back({at, length, with});
  }
  void insert(int line, int column, const std::string& what) {
    edits_.push_back({place(line, column), 0, what});
  }
  void insert_after_line(int line, const std::string& what) {
    const std::size_t at = lines_[std::min(static_cast<std::size_t>(line) + 1, lines_.size() - 1)];
    const bool ended = at == 0 || text_[at - 1] == '\n';
    edits_.push_back({at, 0, ended ? what : "\n" + what});
  }

  [[nodiscard]] std::string applied(const std::string& file) const {
    std::vector<Edit> edits = edits_;
    std::ranges::stable_sort(edits, {}, &Edit::at);
    std::string out;
    std::size_t done = 0;
    for (const Edit& edit : edits) {
      if (edit.at < done || wrong_ > 0)
        fail(file, wrong_, "its spheres are written in a way that is not edited here");
      out += text_.substr(done, edit.at - done) + edit.text;
      done = edit.at + edit.length;
    }
    return out + text_.substr(done);
  }

 private:
  struct Edit {
    std::size_t at, length;
    std::string text;
  };

  [[nodiscard]] std::size_t place(int line, int column) const {
    const std::size_t begin = lines_[std::min(static_cast<std::size_t>(line), lines_.size() - 1)];
    return std::min(begin + static_cast<std::size_t>(column), text_.size());
  }

  const std::string& text_;
  std::vector<std::size_t> lines_{0};  ///< where they begin, and the end
  std::vector<Edit> edits_;
  int wrong_ = 0;  ///< a line where the text is another one
};

/// Spheres in YAML: cuRobo's, or XRDF.
class YamlFile {
 public:
  explicit YamlFile(const std::string& file) : file_(file) {}

  SphereFile read(const std::string& text) {
    std::vector<YAML::Node> documents;
    try {
      documents = YAML::LoadAll(text);
    } catch (const YAML::Exception& error) {
      fail(file_, error.mark.line + 1, error.msg + " (is the file cut?)");
    }
    if (documents.size() > 1)
      fail(file_, line_of(documents[1]), "a second document; all spheres are to be in one");
    if (documents.empty() || !documents[0].IsMap()) fail(file_, 0, kForm);
    const YAML::Node root = documents[0];
    SphereFile out;
    if (const YAML::Node format = member(root, "format");
        format && format.IsScalar() && format.Scalar() == "xrdf")
      out = read_xrdf(root);
    else
      out = read_curobo(root);
    for (const StatedCount& stated : stated_counts(file_, text))
      if (stated.count != count_)
        fail(file_, stated.line,
             counted(stated.count, "sphere is", "spheres are") + " stated, and " +
                 counted(count_, "is", "are") +
                 " here: is the file cut? Who changes spheres by hand changes this number, too");
    if (!text.ends_with('\n'))
      out.notes.emplace_back("the file does not end with a line break: is it cut?");
    return out;
  }

  /// The text that was read with other spheres.
  [[nodiscard]] std::string edited(const std::string& text,
                                   const std::vector<LinkSpheres>& wanted) const {
    TextEdits edits(text);
    // What is added to a link comes before new links, which may begin where the last link ends.
    std::vector<const LinkSpheres*> added;
    std::size_t count = count_;
    for (const LinkSpheres& link : wanted) {
      YAML::Node list;
      for (const auto& entry : spheres_)
        if (entry.first.Scalar() == link.link) list = entry.second;
      const std::size_t known = list.IsSequence() ? list.size() : 0;
      count += std::max(link.balls.bodies.size(), known) - known;
      if (list.IsSequence())
        edit_link(link, list, edits);
      else
        added.push_back(&link);
    }
    for (const LinkSpheres* link : added) add_link(*link, edits);
    add_names(wanted, edits);
    for (const StatedCount& stated : stated_counts(file_, text))
      if (count != count_) edits.replace(stated.at, stated.length, std::to_string(count));
    return edits.applied(file_);
  }

 private:
  /// A member of a mapping, of which YAML's readers take the first one or the last one where there
  /// are several.
  [[nodiscard]] YAML::Node member(const YAML::Node& map, const char* key) const {
    YAML::Node out(YAML::NodeType::Undefined);
    if (!map.IsMap()) return out;
    bool found = false;
    for (const auto& entry : map) {
      if (!entry.first.IsScalar() || entry.first.Scalar() != key) continue;
      if (found) fail(file_, line_of(entry.first), std::string("'") + key + "' is there already");
      found = true;
      out.reset(entry.second);
    }
    return out;
  }

  SphereFile read_curobo(const YAML::Node& root) {
    YAML::Node kinematics = root;
    if (const YAML::Node config = member(root, "robot_cfg"); config && config.IsMap())
      if (const YAML::Node inner = member(config, "kinematics"); inner && inner.IsMap()) {
        if (const YAML::Node outer = member(root, "collision_spheres"))
          fail(file_, line_of(outer), "there are spheres here, and in robot_cfg as well");
        kinematics.reset(inner);
      }
    const YAML::Node spheres = member(kinematics, "collision_spheres");
    if (!spheres && member(root, "geometry"))
      fail(file_, 0, "an XRDF says 'format: xrdf' and its format_version");
    if (!spheres) fail(file_, 0, kForm);
    if (spheres.IsScalar())
      fail(file_, line_of(spheres),
           "the spheres are in another file, '" + spheres.Scalar() + "': name that one");
    if (!spheres.IsMap()) fail(file_, line_of(spheres), kForm);
    spheres_ = spheres;
    read_buffer(member(kinematics, "collision_sphere_buffer"), "collision_sphere_buffer");
    SphereFile out{{}, "cuRobo YAML", {}, {}, {}};
    read_links(spheres, out);
    if (out.links.empty()) fail(file_, line_of(spheres), kForm);
    require_buffered(out);
    if (buffered_) out.notes.emplace_back("collision_sphere_buffer is added to the radii");
    compare_names(member(kinematics, "collision_link_names"), out);
    return out;
  }

  /// Spheres of links that `collision_link_names` does not name are none to cuRobo. Links that it
  /// names have some, unless the file is cut.
  void compare_names(const YAML::Node& names, SphereFile& out) {
    if (!names || names.IsNull()) return;
    if (!names.IsSequence())
      fail(file_, line_of(names), "collision_link_names: a list of links is expected");
    for (const YAML::Node& name : names)
      if (!name.IsScalar())
        fail(file_, line_of(name), "collision_link_names: the name of a link is expected");
    names_ = names;
    std::set<std::string> named = named_links();
    std::vector<std::string> unnamed;
    for (LinkSpheres& link : out.links) {
      if (link.balls.bodies.empty() || named.erase(link.link) > 0) continue;
      unnamed.push_back(link.link);
      link.balls.bodies.clear();
    }
    if (!named.empty())
      out.notes.push_back("collision_link_names names " + names_of({named.begin(), named.end()}) +
                          ", without a sphere here: is the file cut?");
    if (!unnamed.empty())
      out.notes.push_back("the spheres of " + names_of(unnamed) +
                          " are none: collision_link_names does not name them");
  }

  [[nodiscard]] std::set<std::string> named_links() const {
    std::set<std::string> out;
    for (const YAML::Node& name : names_) out.insert(name.Scalar());
    return out;
  }

  /// Links that get spheres are named where links have to be.
  void add_names(const std::vector<LinkSpheres>& wanted, TextEdits& edits) const {
    if (!names_.IsSequence()) return;
    const std::set<std::string> named = named_links();
    const std::string indent(static_cast<std::size_t>(names_.Mark().column), ' ');
    const bool flow = names_.Style() == YAML::EmitterStyle::Flow;
    std::string more;
    for (const LinkSpheres& link : wanted) {
      if (link.balls.bodies.empty() || named.contains(link.link)) continue;
      if (const YAML::Node list = spheres_[link.link]; list && list.size() > 0)
        fail(file_, line_of(list),
             "spheres of link '" + link.link +
                 "', which collision_link_names does not name: name it, or take them out");
      const std::string name = "\"" + link.link + "\"";
      if (!flow) more.append(indent).append("- ");
      more.append(name).append(flow ? ", " : "\n");
    }
    if (more.empty()) return;
    if (flow && named.empty()) more.resize(more.size() - 2);
    if (flow)
      edits.insert(names_.Mark().line, names_.Mark().column + 1, more);
    else
      edits.insert_after_line(last_line(names_), more);
  }

  /// @throws Error{InvalidInput} where a link has a buffer and no spheres
  void require_buffered(const SphereFile& read) const {
    for (const auto& buffer : buffer_lines_)
      if (std::ranges::find(read.links, buffer.first, &LinkSpheres::link) == read.links.end())
        fail(file_, buffer.second,
             "a buffer of link '" + buffer.first + "', which has no spheres here");
  }

  /// A sphere with the radius that is stated, without the buffer.
  [[nodiscard]] std::pair<std::string, std::string> stated(const std::string& link,
                                                           const geom::ConvexBody& ball) const {
    const double radius = ball.radius - buffer_of(link);
    if (!(radius > 0))
      fail(file_, 0,
           "link '" + link + "': a sphere of radius " + number_text(ball.radius) +
               " is to be written, less than the buffer that is added to it");
    const geom::Vec3& c = ball.core.vertices[0];
    return {"[" + exact_text(c.x()) + ", " + exact_text(c.y()) + ", " + exact_text(c.z()) + "]",
            exact_text(radius)};
  }

  [[nodiscard]] double buffer_of(const std::string& link) const {
    const auto own = of_link_.find(link);
    return own == of_link_.end() ? buffer_ : own->second;
  }

  [[nodiscard]] std::string in_a_line(const std::string& link, const geom::ConvexBody& ball) const {
    const auto [center, radius] = stated(link, ball);
    return "{center: " + center + ", radius: " + radius + "}";
  }

  [[nodiscard]] std::string in_lines(const std::string& link, const geom::ConvexBody& ball,
                                     int indent) const {
    const auto [center, radius] = stated(link, ball);
    const std::string blanks(static_cast<std::size_t>(indent), ' ');
    return blanks + "- center: " + center + "\n" + blanks + "  radius: " + radius + "\n";
  }

  static int last_line(const YAML::Node& node) {
    int out = node.Mark().line;
    if (node.IsSequence())
      for (const YAML::Node& part : node) out = std::max(out, last_line(part));
    if (node.IsMap())
      for (const auto& part : node)
        out = std::max({out, last_line(part.first), last_line(part.second)});
    return out;
  }

  void edit_link(const LinkSpheres& link, const YAML::Node& list, TextEdits& edits) const {
    LinkSpheres known{link.link, 0, {}};
    read_link(list, known);
    const std::vector<geom::ConvexBody>&was = known.balls.bodies, &now = link.balls.bodies;
    for (std::size_t i = 0; i < was.size() && i < now.size(); ++i) {
      const geom::Vec3 &a = was[i].core.vertices[0], &b = now[i].core.vertices[0];
      for (std::size_t k = 0; k < 3; ++k)
        if (a[static_cast<int>(k)] != b[static_cast<int>(k)])
          edits.replace(list[i]["center"][k], exact_text(b[static_cast<int>(k)]));
      if (was[i].radius != now[i].radius)
        edits.replace(list[i]["radius"], stated(link.link, now[i]).second);
    }
    const bool flow = list.Style() == YAML::EmitterStyle::Flow;
    std::string more;
    for (std::size_t i = was.size(); i < now.size(); ++i)
      more += flow ? in_a_line(link.link, now[i]) + (i + 1 < now.size() || !was.empty() ? ", " : "")
                   : in_lines(link.link, now[i], list.Mark().column);
    if (more.empty()) return;
    if (flow)
      edits.insert(list.Mark().line, list.Mark().column + 1, more);
    else
      edits.insert_after_line(last_line(list), more);
  }

  void add_link(const LinkSpheres& link, TextEdits& edits) const {
    if (link.balls.bodies.empty()) return;
    const YAML::Node first = spheres_.begin()->first;
    std::string more = "\"" + link.link + "\":";
    if (spheres_.Style() == YAML::EmitterStyle::Flow) {
      more += " [";
      for (const geom::ConvexBody& ball : link.balls.bodies)
        more += (&ball == link.balls.bodies.data() ? "" : ", ") + in_a_line(link.link, ball);
      edits.insert(first.Mark().line, first.Mark().column, more + "], ");
      return;
    }
    const int indent = first.Mark().column;
    more = std::string(static_cast<std::size_t>(indent), ' ') + more + "\n";
    for (const geom::ConvexBody& ball : link.balls.bodies)
      more += in_lines(link.link, ball, indent + 2);
    edits.insert_after_line(last_line(spheres_), more);
  }

  static constexpr const char* kXrdfForm =
      "no spheres; as XRDF has them:\n  geometry:\n    name:\n      spheres:\n        link_name:\n "
      "  "
      "       - center: [0, 0, 0.1]\n            radius: 0.05\n  collision:\n    geometry: name";
  static constexpr const char* kForm =
      "no spheres; as cuRobo has them:\n  collision_spheres:\n    link_name:\n      - center: [0, "
      "0, 0.1]\n        radius: 0.05";

  /// The spheres of a link by its name.
  void read_links(const YAML::Node& spheres, SphereFile& out) {
    std::set<std::string> names;
    for (const auto& entry : spheres) {
      LinkSpheres link{entry.first.Scalar(), line_of(entry.first), {}};
      if (!names.insert(link.link).second)
        fail(file_, link.line, "link '" + link.link + "' is there already");
      read_link(entry.second, link);
      count_ += link.balls.bodies.size();
      out.links.push_back(std::move(link));
    }
  }

  /// The group of spheres that `collision` names, with its buffer_distance; without `collision`
  /// the only group that there is.
  SphereFile read_xrdf(const YAML::Node& root) {
    const YAML::Node version = member(root, "format_version");
    const double stated = version ? number_of(version, file_, "format_version")
                                  : std::numeric_limits<double>::quiet_NaN();
    if (!(stated >= 1 && stated < 3))
      fail(file_, version ? line_of(version) : 0, "XRDF of format_version 1.0 or 2.0 is read");
    const YAML::Node groups = member(root, "geometry");
    if (!groups || !groups.IsMap() || groups.size() == 0)
      fail(file_, groups ? line_of(groups) : 0, kXrdfForm);
    YAML::Node group = groups.begin()->second;
    const YAML::Node collision = member(root, "collision");
    if (collision) {
      const YAML::Node name = member(collision, "geometry");
      if (!collision.IsMap() || !name || !name.IsScalar())
        fail(file_, line_of(collision), "'collision' must name its geometry");
      const YAML::Node named = member(groups, name.Scalar().c_str());
      if (!named) fail(file_, line_of(name), "there is no geometry '" + name.Scalar() + "'");
      group.reset(named);
      read_buffer(member(collision, "buffer_distance"), "buffer_distance");
    } else if (groups.size() > 1) {
      fail(file_, line_of(groups), "'collision' must say which geometry is meant");
    }
    if (!group.IsMap()) fail(file_, line_of(groups), kXrdfForm);
    for (const auto& entry : group)
      if (entry.first.Scalar() != "spheres")
        fail(file_, line_of(entry.first),
             "a geometry of spheres is read, no '" + entry.first.Scalar() + "'");
    const YAML::Node spheres = member(group, "spheres");
    if (!spheres || !spheres.IsMap()) fail(file_, line_of(group), kXrdfForm);
    spheres_ = spheres;
    SphereFile out{{}, "XRDF", {}, {}, {}};
    read_links(spheres, out);
    if (out.links.empty()) fail(file_, line_of(spheres), kXrdfForm);
    require_buffered(out);
    if (buffered_) out.notes.emplace_back("collision's buffer_distance is added to the radii");
    if (root["modifiers"])
      out.notes.emplace_back(
          "its modifiers of the URDF are not applied: links are those of the robot");
    return out;
  }

  void read_buffer(const YAML::Node& node, const std::string& name) {
    if (!node || node.IsNull()) return;
    const auto take = [&](const YAML::Node& number) {
      const double out = number_of(number, file_, name);
      buffered_ = buffered_ || out != 0;
      return out;
    };
    if (!node.IsMap()) {
      buffer_ = take(node);
      return;
    }
    for (const auto& entry : node) {
      const std::string link = entry.first.Scalar();
      const double buffer = take(entry.second);
      if (!of_link_.emplace(link, buffer).second)
        fail(file_, line_of(entry.first), "link '" + link + "' has a buffer already");
      if (buffer != 0) buffer_lines_.emplace_back(link, line_of(entry.first));
    }
  }

  void read_link(const YAML::Node& list, LinkSpheres& link) const {
    if (!list.IsSequence())
      fail(file_, list.IsNull() ? link.line : line_of(list),
           "link '" + link.link + "': a list of spheres is expected" +
               (list.IsNull() ? " (is the file cut?)" : ""));
    const double buffer = buffer_of(link.link);
    for (const YAML::Node& sphere : list) {
      const int line = line_of(sphere);
      const YAML::Node center = member(sphere, "center"), radius = member(sphere, "radius");
      if (!sphere.IsMap() || !center || !radius || !center.IsSequence() || center.size() != 3)
        fail(file_, line,
             "link '" + link.link + "': a sphere needs a center of three numbers and a radius" +
                 (radius ? "" : " (is the file cut?)"));
      for (const auto& entry : sphere)
        if (const std::string key = entry.first.Scalar(); key != "center" && key != "radius")
          fail(file_, line_of(entry.first),
               "link '" + link.link + "': a sphere has a center and a radius, no '" + key + "'");
      geom::Vec3 at;
      for (std::size_t k = 0; k < 3; ++k)
        at[static_cast<int>(k)] = number_of(center[k], file_, "a center's coordinate");
      const double stated = number_of(radius, file_, "a radius");
      if (!(stated > 0)) add_ball(link, at, stated, file_, line);
      add_ball(link, at, stated + buffer, file_, line);
    }
  }

  const std::string& file_;
  YAML::Node spheres_;     ///< by link
  YAML::Node names_;       ///< of links that may have some; none: all
  std::size_t count_ = 0;  ///< of all links' spheres
  double buffer_ = 0;
  std::map<std::string, double> of_link_;
  std::vector<std::pair<std::string, int>> buffer_lines_;  ///< of links
  bool buffered_ = false;
};

#endif

}  // namespace

std::string sphere_count_comment(std::size_t count) {
  return std::string(kCountWords) + std::to_string(count) + "\n";
}

bool is_sphere_file(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  return extension == ".yml" || extension == ".yaml" || extension == ".xrdf" ||
         extension == ".srdf";
}

SphereFile read_spheres(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension == ".urdf" || extension == ".xacro")
    return read_urdf(file, read_robot(file, Motions::None).robot);
  const std::vector<char> text = io::read_file(file);
  return parse_spheres(file, std::string(text.begin(), text.end()));
}

SphereFile parse_spheres(const std::string& file, const std::string& text) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension == ".urdf") return read_urdf(file, parse_urdf(text, file));
  if (extension == ".srdf") return read_srdf(file, text);
  if (!is_sphere_file(file))
    fail(file, 0, "spheres are read from .yml and .yaml (cuRobo, XRDF), .xrdf, .srdf and .urdf");
#ifdef KABOUM_HAS_YAML
  return YamlFile(file).read(text);
#else
  throw Error(ErrorCode::NotBuilt, "this build has no yaml-cpp to read " + file);
#endif
}

std::string edited_spheres(const std::string& file, const std::string& text,
                           const std::vector<LinkSpheres>& wanted) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension == ".urdf") return edited_urdf(text, wanted);
  if (extension == ".srdf") return edited_srdf(text, wanted);
  if (!is_sphere_file(file)) fail(file, 0, "its spheres cannot be written there");
#ifdef KABOUM_HAS_YAML
  YamlFile yaml(file);
  yaml.read(text);
  return yaml.edited(text, wanted);
#else
  throw Error(ErrorCode::NotBuilt, "this build has no yaml-cpp to read " + file);
#endif
}

}  // namespace kaboum::robot
