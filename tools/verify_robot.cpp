#include "verify_robot.h"

#include <kaboum/geom/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/cover.h>

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>

#include "prepared_original.h"
#include "robot_bodies.h"

namespace kaboum::tools {
namespace {

namespace fs = std::filesystem;
using sweep::Geometry;
using verify::Answer;

std::string number(double x) {
  std::ostringstream text;
  text << std::setprecision(6) << x;
  return text.str();
}

std::string point(const geom::Vec3& p) {
  std::ostringstream text;
  text << std::setprecision(17) << '(' << p.x() << ", " << p.y() << ", " << p.z() << ')';
  return text.str();
}

/// Refuted before undecided before undefined before verified.
Answer worse(Answer a, Answer b) {
  for (const Answer x : {Answer::Refuted, Answer::Undecided, Answer::Undefined})
    if (a == x || b == x) return x;
  return Answer::Verified;
}

bool same(const sweep::Transform& a, const sweep::Transform& b) {
  return a.linear == b.linear && a.translation == b.translation;
}
/// Whether a point of the one's frame is the same point of the link in the other's.
bool same_frame(const Geometry& a, const Geometry& b) {
  return a.shape == b.shape && a.size == b.size && same(a.origin, b.origin);
}

const char* name_of_shape(Geometry::Shape shape) {
  switch (shape) {
    case Geometry::Shape::Mesh:
      return "mesh";
    case Geometry::Shape::Box:
      return "box";
    case Geometry::Shape::Cylinder:
      return "cylinder";
    case Geometry::Shape::Sphere:
      break;
  }
  return "sphere";
}

/// Why the robots do not move alike; empty if they do. Limits of joints are no matter of shapes.
std::string difference_in_motion(const sweep::Robot& original, const sweep::Robot& result) {
  for (const sweep::Link& link : original.links)
    if (!result.find_link(link.name)) return "the result has no link '" + link.name + "'";
  for (std::size_t i = 0; i < original.joints.size(); ++i) {
    const sweep::Joint& a = original.joints[i];
    const auto at = std::find_if(result.joints.begin(), result.joints.end(),
                                 [&](const sweep::Joint& b) { return b.name == a.name; });
    if (at == result.joints.end()) return "the result has no joint '" + a.name + "'";
    const sweep::Joint& b = *at;
    const auto child = static_cast<std::size_t>(at - result.joints.begin()) + 1;
    const bool fixed = a.type == sweep::JointType::Fixed;
    const bool alike =
        a.type == b.type && same(a.origin, b.origin) &&
        original.links[a.parent].name == result.links[b.parent].name &&
        original.links[i + 1].name == result.links[child].name &&
        (fixed || (a.axis == b.axis && a.multiplier == b.multiplier && a.offset == b.offset &&
                   original.variables[a.variable].name == result.variables[b.variable].name));
    if (!alike) return "joint '" + a.name + "' moves its link in another way";
  }
  return {};
}

/// What was found of one mesh and the meshes that are to hold it.
struct Held {
  Answer answer = Answer::Undefined;
  std::string text;  ///< one clause
  Json json;
  std::vector<std::string> notes;
};

class RobotVerifier {
 public:
  RobotVerifier(const VerifyRobotOptions& options, const CommonOptions& common)
      : o_(options),
        common_(common),
        original_(read_robot(o_.original)),
        result_(read_robot(o_.result)),
        progress_(common.quiet) {
    if (o_.epsilon.empty()) return;
    epsilon_ = parse_length(o_.epsilon);
    if (!epsilon_)
      throw Error(ErrorCode::InvalidArgument,
                  "--epsilon: '" + o_.epsilon + "' is neither a positive length nor a percentage");
  }

  int run() {
    const std::string motion = difference_in_motion(original_.robot, result_.robot);
    lines_.push_back(motion.empty() ? "joints: verified: both robots move alike"
                                    : "joints: refuted: " + motion);
    answer_ = motion.empty() ? Answer::Verified : Answer::Refuted;
    for (const sweep::Link& link : original_.robot.links) check(link);
    if (shapes_ == 0)
      throw Error(ErrorCode::InvalidInput,
                  o_.original + ": no link has a shape" +
                      (o_.geometry == "visual" ? "" : "; try --geometry visual"));
    if (!common_.report.empty()) report(motion);
    for (const std::string& note : notes_) log(common_.quiet, note);
    if (!common_.quiet) {
      std::ostream& out = common_.report == "-" ? std::cerr : std::cout;
      for (const std::string& line : lines_) out << line << '\n';
      out << name_of(answer_) << '\n';
    }
    switch (answer_) {
      case Answer::Verified:
        return kDone;
      case Answer::Refuted:
        return kNo;
      case Answer::Undecided:
        return kLimit;
      case Answer::Undefined:
        break;
    }
    return kBadInput;
  }

 private:
  void check(const sweep::Link& link) {
    const std::vector<Geometry>& shapes = o_.geometry == "visual" ? link.visual : link.collision;
    if (shapes.empty()) return;
    static const std::vector<Geometry> kNone;
    const auto index = result_.robot.find_link(link.name);
    const std::vector<Geometry>& there = index ? result_.robot.links[*index].collision : kNone;
    Json json{{"link", link.name}, {"shapes", Json::array()}};
    for (const Geometry& g : shapes) {
      ++shapes_;
      const std::string title = "link '" + link.name + "': " + name_of_shape(g.shape) +
                                (g.mesh.empty() ? "" : " " + g.mesh);
      const Held held = g.shape == Geometry::Shape::Mesh ? mesh(g, there) : primitive(g, there);
      answer_ = worse(answer_, held.answer);
      lines_.push_back(title + ": " + name_of(held.answer) + ": " + held.text);
      Json shape{{"shape", name_of_shape(g.shape)}, {"answer", name_of(held.answer)}};
      if (!held.json.is_null()) shape.update(held.json);
      json["shapes"].push_back(std::move(shape));
    }
    links_.push_back(std::move(json));
  }

  static Held primitive(const Geometry& g, const std::vector<Geometry>& there) {
    const bool found = std::any_of(there.begin(), there.end(),
                                   [&](const Geometry& h) { return same_frame(g, h); });
    if (found) return {Answer::Verified, "the result has it as well", {}, {}};
    return {Answer::Undecided, "the result has none of its size and pose", {}, {}};
  }

  Held mesh(const Geometry& g, const std::vector<Geometry>& there) {
    std::vector<std::string> files{resolve_mesh(g.mesh, original_.path, o_.packages).string()};
    for (const Geometry& h : there)
      if (same_frame(g, h))
        files.push_back(resolve_mesh(h.mesh, result_.path, o_.packages).string());
    std::sort(files.begin() + 1, files.end());
    Json json{{"file", files[0]}, {"bodies", files.size() - 1}};
    if (files.size() == 1)
      return {Answer::Undecided, "the result's link has no mesh of its pose and scale", json, {}};
    const double scale = g.size.cwiseAbs().maxCoeff();
    const auto key = std::pair{files, epsilon_ && !epsilon_->percent ? scale : 0.0};
    auto at = held_.find(key);
    if (at == held_.end()) {
      progress_.show("deciding: " + files[0]);
      at = held_.emplace(key, decide(files, scale)).first;
      for (const std::string& note : at->second.notes) notes_.push_back(files[0] + ": " + note);
    }
    Held held = at->second;
    if (!held.json.is_null()) json.update(held.json);
    held.json = std::move(json);
    return held;
  }

  /// Of files, the first is to be held by all others; lengths are those of the robot divided by
  /// `scale`.
  Held decide(const std::vector<std::string>& files, double scale) const {
    Held held;
    io::ReadResult read = io::read_mesh(files[0]);
    geom::Mesh original = std::move(read.mesh);
    held.notes = std::move(read.notes);
    if (o_.prepare) {
      PreparedOriginal prepared =
          naming(files[0], [&] { return prepare_original(original, o_.drop_sheets, true); });
      original = std::move(prepared.mesh);
      held.notes.insert(held.notes.end(), prepared.notes.begin(), prepared.notes.end());
    }
    geom::ConvexSet set;
    for (std::size_t i = 1; i < files.size(); ++i)
      set.bodies.push_back({fs::path(files[i]).stem().string(), io::read_mesh(files[i]).mesh});
    verify::InclusionOptions limits;
    limits.max_contacts = o_.max_contacts;
    const verify::Cover cover =
        naming(files[0], [&] { return verify::verify_cover(original, set, limits); });
    const verify::Inclusion& in = cover.inclusion;
    const auto add = [&](const char* name, Answer answer, const std::string& reason) {
      held.json["claims"][name] = {{"answer", name_of(answer)}, {"reason", reason}};
    };
    add("convex", cover.convex.answer, cover.convex.reason);
    add("solid", in.solid.answer, in.solid.reason);
    add("surface", in.surface.answer, in.surface.reason);

    // Claims that mean nothing for an open mesh do not count beside one that does.
    Answer enclosed = Answer::Undefined;
    const verify::Claim* worst = nullptr;
    for (const verify::Claim* claim : {&in.solid, &in.surface}) {
      if (o_.claims == (claim == &in.solid ? "surface" : "solid")) continue;
      if (claim->answer == Answer::Undefined) continue;
      const Answer both = worst != nullptr ? worse(enclosed, claim->answer) : claim->answer;
      if (both != enclosed) worst = claim;
      enclosed = both;
    }
    const bool convex = cover.convex.answer == Answer::Verified;
    const std::string bodies =
        std::to_string(set.bodies.size()) + (convex ? " convex bod" : " mesh") +
        (set.bodies.size() == 1 ? (convex ? "y" : "") : (convex ? "ies" : "es"));
    held.answer = enclosed;
    switch (enclosed) {
      case Answer::Verified:
        held.text =
            (in.inner_closed ? "its solid is within " : "its surface (it is open) is within ") +
            bodies + (convex ? "" : ", not all convex");
        break;
      case Answer::Refuted:
        held.text = "it is not within the " + bodies + " of its pose";
        if (worst->witness)
          held.text += ": " + point(worst->witness->point) + " is " +
                       number(worst->witness->depth) + " outside, in the mesh's own unit";
        break;
      case Answer::Undecided:
        held.text = worst->reason;
        break;
      case Answer::Undefined:
        held.text = "it, or what is to hold it, is not closed: no solid is defined";
        break;
    }
    if (!o_.prepare && enclosed != Answer::Verified)
      held.notes.emplace_back(
          "bcd-decompose speaks of the mesh as prepared; --prepare judges that");
    if (epsilon_ && enclosed == Answer::Verified)
      add_distance(held, set, original, in, convex, scale);
    return held;
  }

  void add_distance(Held& held, const geom::ConvexSet& set, const geom::Mesh& original,
                    const verify::Inclusion& in, bool convex, double scale) const {
    if (!convex) {
      held.answer = Answer::Undecided;
      held.text += "; of these no distance is decided";
      return;
    }
    const double bound = epsilon_->percent ? epsilon_->of(geom::bounding_box(original).diagonal())
                                           : epsilon_->value / scale;
    const verify::DistanceClaim claim = verify::verify_reach(set, original, bound, in.inner_closed);
    held.json["claims"]["distance"] = {{"answer", name_of(claim.answer)},
                                       {"reason", claim.reason},
                                       {"bound", bound},
                                       {"largest_found", claim.largest}};
    held.answer = worse(held.answer, claim.answer);
    held.text += claim.answer == Answer::Verified
                     ? ", these nowhere more than " + number(bound) + " from it"
                     : ", but whether these are within " + number(bound) + " of it is " +
                           name_of(claim.answer) + ": at least " + number(claim.largest) + " at " +
                           point(claim.at);
  }

  void report(const std::string& motion) const {
    const auto file = [](const std::string& path, const RobotFile& robot) {
      return Json{{"file", path}, {"sha256", robot.sha256}};
    };
    write_json(
        common_.report,
        {{"tool", "bound-verify"},
         {"version", version()},
         {"relation", "robot"},
         {"verdict", name_of(answer_)},
         {"deciding_claims", o_.claims},
         {"original", file(o_.original, original_)},
         {"result", file(o_.result, result_)},
         {"joints", {{"answer", motion.empty() ? "verified" : "refuted"}, {"reason", motion}}},
         {"shapes", shapes_},
         {"links", links_},
         {"resources", {{"user_seconds", user_seconds()}, {"peak_megabytes", peak_megabytes()}}}});
  }

  const VerifyRobotOptions& o_;
  const CommonOptions& common_;
  RobotFile original_, result_;
  Progress progress_;
  std::optional<Length> epsilon_;
  std::map<std::pair<std::vector<std::string>, double>, Held> held_;
  Answer answer_ = Answer::Verified;
  std::vector<std::string> lines_, notes_;
  Json links_ = Json::array();
  std::size_t shapes_ = 0;
};

}  // namespace

int verify_robot(const VerifyRobotOptions& options, const CommonOptions& common) {
  if (options.result.empty())
    throw Error(ErrorCode::InvalidArgument, "--robot takes ORIGINAL and APPROXIMATION, two URDFs");
  require_apart({{"--report", common.report}}, {options.original, options.result});
  const ThreadLimit threads(common.threads);
  return RobotVerifier(options, common).run();
}

}  // namespace kaboum::tools
