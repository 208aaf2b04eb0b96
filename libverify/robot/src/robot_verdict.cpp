// The verdict on a robot, link by link.

#include <kaboum/base/error.h>
#include <kaboum/base/number_text.h>
#include <kaboum/geom/topology.h>
#include <kaboum/verify/held_shape.h>
#include <kaboum/verify/matching_shapes.h>
#include <kaboum/verify/motion_alike.h>
#include <kaboum/verify/region_excess.h>
#include <kaboum/verify/robot_verdict.h>
#include <kaboum/verify/subject.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace kaboum::verify {
namespace {

using robot::Geometry;

std::string counted(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + ' ' + (n == 1 ? one : many);
}

std::string text_of(const geom::Vec3& p) {
  return "(" + number_text(p.x()) + ", " + number_text(p.y()) + ", " + number_text(p.z()) + ")";
}

std::string in_words(const Bracket& b) {
  std::string text = std::isfinite(b.upper) ? "at most " + number_up(b.upper) : std::string();
  if (b.lower > 0)
    text += std::string(text.empty() ? "" : " and ") + "at least " + number_down(b.lower) +
            ", farthest at " + text_of(b.at);
  return text;
}

/// Calls `work`; its errors name the file.
template <class Work>
auto naming(const std::string& file, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Error(error.code(), file + ": " + error.what());
  }
}

/// The triangles of a file and what they bound, as far as that is judged.
struct JudgedFile : Subject {
  const MeshFile* file = nullptr;
};

JudgedFile judged_file(const MeshFile& file, const RobotQuestion& q) {
  JudgedFile out{{}, &file};
  static_cast<Subject&>(out) = naming(file.path, [&] {
    if (q.solid == Solid::AsFile) return unprepared_subject(file.mesh);
    if (q.solid == Solid::Enclosed) return unprepared_subject(file.mesh, file.quads);
    return prepared_subject(file.mesh, {.drop_sheets = q.drop_sheets,
                                        .holes = geom::Holes::Fill,
                                        .quads = file.quads,
                                        .diagonal = geom::PrepareOptions::Diagonal::Outward});
  });
  if (q.solid == Solid::AsFile) out.both_ways = false;
  return out;
}

/// A mesh and what holds it, decided.
class Judgement {
 public:
  Judgement(const JudgedFile& subject, const Holders& holders, const RobotQuestion& q)
      : subject_(subject), holders_(holders), q_(q) {}

  ShapeVerdict run() {
    out_.file = subject_.file;
    out_.name = subject_.file->path;
    out_.dropped_sheets = subject_.report.dropped_sheets;
    naming(out_.name, [&] { decide(); });
    return std::move(out_);
  }

 private:
  void decide() {
    const HeldShape held = subject_.both_ways
                               ? holders_.hold_any(subject_.mesh, q_.claims, q_.limits)
                               : holders_.hold(subject_.mesh, q_.claims, q_.limits);
    out_.answer = held.answer;
    out_.text = held.reason;
    if (held.prepare_helps && q_.solid == Solid::AsFile)
      out_.text += "; judged as prepared it may be decided";
    if (!held.inclusion) return;
    const SubjectClaims claims = decide_rest(
        subject_, subject_.mesh, q_.claims, *held.inclusion,
        [this](const geom::Mesh& mesh, bool surface_only) { return look(mesh, surface_only); });
    const Inclusion& in = claims.inclusion;
    out_.convex = holders_.convex();
    out_.closed = in.inner_closed;
    out_.triangles_without_area = in.triangles_without_area;
    out_.left_out = in.left_out;
    out_.limited = in.limited;
    measured_ = claims.surface_of_all ? &subject_.triangles : &subject_.mesh;
    if (held.surface) out_.triangles = in.surface;
    const bool has_solid =
        subject_.both_ways ? q_.claims != Claims::Surface && in.solid.answer != Answer::Undefined
                           : held.solid;
    if (has_solid) out_.solid = in.solid;
    if (!out_.triangles && !out_.solid) {
      out_.answer = Answer::Undefined;
      if (!subject_.is_prepared) out_.text = "which solid the triangles bound is not known";
      return;
    }
    out_.answer = Answer::Verified;
    for (const std::optional<Claim>* claim : {&out_.triangles, &out_.solid})
      if (*claim) out_.answer = worse(out_.answer, (*claim)->answer);
    look_at_exact_faces();
    if (out_.answer == Answer::Refuted && !holders_.refutes()) out_.answer = Answer::Undecided;
    measure();
    put_into_words();
  }

  /// Whether a mesh is inside; the look ends in any case.
  [[nodiscard]] Inclusion look(const geom::Mesh& mesh, bool surface_only) const {
    InclusionOptions options = q_.limits;
    options.max_work = options.max_work.value_or(usual_work(mesh.triangles.size()));
    options.surface_only = surface_only;
    return holders_.inclusion_of(mesh, options);
  }

  void look_at_exact_faces() {
    const std::optional<ExactPoints>& exact = subject_.file->exact;
    if (!exact) return;
    out_.exact_points =
        verify_points({exact->points, exact->of_face, exact->rounding}, holders_.sum());
    if (out_.exact_points->answer == Answer::Refuted) out_.answer = Answer::Refuted;
  }

  void measure() {
    if (!out_.triangles || out_.triangles->answer != Answer::Refuted) return;
    BracketEffort effort;
    effort.max_work = q_.limits.max_work.value_or(usual_work(measured_->triangles.size()));
    out_.sticks_out =
        bracket_distance(*measured_, out_.triangles->inner_triangles, holders_.sum(), true, effort);
    if (out_.limited) out_.sticks_out->upper = std::numeric_limits<double>::infinity();
  }

  void put_into_words() {
    const std::size_t n = holders_.set().bodies.size();
    const std::string bodies = holders_.all_convex() ? counted(n, "convex body", "convex bodies")
                                                     : counted(n, "mesh", "meshes, not all convex");
    if (out_.answer == Answer::Verified) {
      out_.text = std::string(out_.solid && out_.triangles ? "its solid and surface are"
                              : out_.solid                 ? "its solid is"
                                                           : "its surface is") +
                  " within " + bodies;
      return;
    }
    const bool refuted = out_.triangles && out_.triangles->answer == Answer::Refuted;
    if (refuted) {
      const std::size_t outside = out_.triangles->inner_triangles.size();
      out_.text = (out_.limited ? "at least " : "") + counted(outside, "triangle", "triangles") +
                  (holders_.refutes() ? outside == 1 ? " is" : " are" : std::string(" may be")) +
                  " not inside the " + bodies + " of its pose";
      if (out_.sticks_out) out_.text += ", by " + in_words(*out_.sticks_out);
      out_.text += ", in the mesh's own unit";
      return;
    }
    if (out_.solid && out_.solid->answer == Answer::Refuted) {
      out_.text = std::string(out_.triangles ? "every triangle is inside, but " : "") +
                  "not all that it encloses is within the " + bodies + " of its pose";
      if (const auto& witness = out_.solid->witness)
        out_.text += ": " + text_of(witness->point) + " is " + number_text(witness->depth) +
                     " outside, in the mesh's own unit";
      return;
    }
    for (const std::optional<Claim>* claim : {&out_.triangles, &out_.solid})
      if (*claim && (*claim)->answer != Answer::Verified) out_.text = (*claim)->reason;
    if (const auto& points = out_.exact_points; points && points->answer == Answer::Refuted)
      out_.text = (!out_.text.empty() ? out_.text
                   : out_.triangles   ? std::string("every triangle is inside")
                                      : std::string("its solid is inside")) +
                  ", but " + std::to_string(points->outside) + " of " +
                  std::to_string(points->points) + " points of its exact faces stick out of the " +
                  bodies + " of its pose, by up to " + number_up(points->farthest) + ", near " +
                  text_of(points->at) + ", in the mesh's own unit";
  }

  const JudgedFile& subject_;
  const Holders& holders_;
  const RobotQuestion& q_;
  const geom::Mesh* measured_ = nullptr;
  ShapeVerdict out_;
};

class RobotJudge {
 public:
  explicit RobotJudge(const RobotQuestion& q) : q_(q) {}

  RobotVerdict run(const std::function<void(const LinkVerdict&)>& judged) {
    out_.motion = difference_in_motion(q_.original, q_.result);
    if (!out_.motion.empty()) out_.answer = Answer::Refuted;
    std::size_t shapes = 0;
    for (const robot::Link& link : q_.original.links)
      if (q_.is_asked(link)) shapes += q_.shapes_of(link).size();
    if (shapes == 0)
      throw Error(ErrorCode::InvalidInput,
                  std::string("no link has a shape") +
                      (q_.visual ? "" : "; those for drawing may be meant"));
    for (const robot::Link& link : q_.original.links) {
      if (!q_.is_asked(link) || q_.shapes_of(link).empty()) continue;
      out_.links.push_back(judge(link));
      out_.answer = worse(out_.answer, out_.links.back().answer);
      if (judged) judged(out_.links.back());
    }
    const bool any_judged = std::ranges::any_of(out_.links, [](const LinkVerdict& link) {
      return std::ranges::any_of(link.shapes, &ShapeVerdict::is_judged);
    });
    if (first_error_ && !any_judged) throw Error(*first_error_);
    look_for_strangers();
    return std::move(out_);
  }

 private:
  [[nodiscard]] const std::vector<Geometry>& result_of(const std::string& link) const {
    static const std::vector<Geometry> kNone;
    const auto index = q_.result.find_link(link);
    return index ? q_.result.links[*index].collision : kNone;
  }

  void note(const std::string& file, const std::string& text) {
    if (std::pair line{file, text}; std::ranges::find(out_.notes, line) == out_.notes.end())
      out_.notes.push_back(std::move(line));
  }

  LinkVerdict judge(const robot::Link& link) {
    LinkVerdict out{link.name, Answer::Verified, {}, {}};
    const std::vector<Geometry>&shapes = q_.shapes_of(link), &there = result_of(link.name);
    for (const MatchedShapes& match : match_shapes(shapes, there)) {
      const Geometry& g = shapes[match.originals.front()];
      if (g.shape == Geometry::Shape::Mesh) {
        judge_meshes(link.name, shapes, there, match, out.shapes);
        continue;
      }
      ShapeVerdict verdict;
      verdict.shape = g.shape;
      verdict.name = describe(g);
      verdict.answer = find_again(g, match);
      verdict.text = verdict.answer == Answer::Verified ? "the result has it as well"
                     : verdict.answer == Answer::Refuted
                         ? "the result's link has no shape at all"
                         : "the result has none of its size and pose";
      out.shapes.push_back(std::move(verdict));
    }
    for (const ShapeVerdict& shape : out.shapes) out.answer = worse(out.answer, shape.answer);
    out.sentence = sentence_of(out);
    return out;
  }

  void judge_meshes(const std::string& link, const std::vector<Geometry>& shapes,
                    const std::vector<Geometry>& there, const MatchedShapes& match,
                    std::vector<ShapeVerdict>& out) {
    std::vector<const MeshFile*> originals, bodies;
    for (const std::size_t i : match.originals) originals.push_back(&q_.file_of(shapes[i], false));
    for (const std::size_t i : match.there) {
      const MeshFile& body = q_.file_of(there[i], true);
      if (body.error && std::ranges::none_of(originals, [&](const MeshFile* file) {
            return file->error && file->sha256 == body.sha256;
          }))
        throw Error(*body.error);
      bodies.push_back(&body);
    }
    const Geometry& g = shapes[match.originals.front()];
    const geom::Vec3 scale = g.size.cwiseAbs();
    const Key key{originals, bodies,    scale.x(),
                  scale.y(), scale.z(), bounds_key(link, match.originals.front())};
    auto at = judged_.find(key);
    if (at == judged_.end()) at = judged_.emplace(key, decide(link, originals, bodies, g)).first;
    for (ShapeVerdict verdict : at->second) {
      const Answer answer =
          verdict.is_judged ? beside_others(verdict.answer, match) : verdict.answer;
      if (answer != verdict.answer && !verdict.distance)
        verdict.text += "; what the " + counted(match.elsewhere, "shape", "shapes") +
                        " of other poses hold is not looked at";
      if (!verdict.distance) verdict.answer = answer;
      out.push_back(std::move(verdict));
    }
  }

  std::vector<ShapeVerdict> decide(const std::string& link,
                                   const std::vector<const MeshFile*>& originals,
                                   const std::vector<const MeshFile*>& bodies,
                                   const Geometry& shape) {
    std::vector<Holders::NamedMesh> named;
    named.reserve(bodies.size());
    for (const MeshFile* file : bodies)
      if (!file->error) named.push_back({file->path, &file->mesh});
    const Holders holders(named);
    for (const auto& [path, why] : holders.left_out()) note(path, why);
    std::vector<const MeshFile*> hold;
    for (const MeshFile* file : bodies)
      if (!file->error && std::ranges::none_of(holders.left_out(), [&](const auto& left) {
            return left.first == file->path;
          }))
        hold.push_back(file);
    std::vector<ShapeVerdict> out;
    std::vector<JudgedFile> subjects;
    bool held = true;
    for (const MeshFile* file : originals) {
      if (q_.progress) q_.progress("link " + link + ": " + file->path);
      for (const std::string& text : file->notes) note(file->path, text);
      try {
        if (file->error) throw Error(*file->error);
        subjects.push_back(judged_file(*file, q_));
        const JudgedFile& subject = subjects.back();
        if (!subject.refusal.empty())
          note(file->path,
               "every triangle is judged as it is, for which solid they bound cannot be "
               "told (" +
                   subject.refusal + ")");
        out.push_back(Judgement(subject, holders, q_).run());
        out.back().held_by = hold;
      } catch (const Error& error) {
        if (!is_of_one_mesh(error)) throw;
        out.push_back(not_held(*file, error));
      }
      if (!out.back().closed && q_.solid == Solid::AsFile) out_.open = true;
      held = held && out.back().answer == Answer::Verified;
    }
    const std::optional<Length> epsilon = q_.epsilon_of(link);
    const auto own = q_.bounds.regions.find(link);
    if (!held || (!epsilon && own == q_.bounds.regions.end())) return out;
    const Measured to = measured(subjects);
    if (epsilon) out.push_back(distance(link, *epsilon, to, holders, shape.size.cwiseAbs()));
    if (own == q_.bounds.regions.end()) return out;
    for (const robot::LinkRegion& region : own->second)
      out.push_back(region_distance(link, region, to, holders, shape));
    return out;
  }

  /// Nothing is known to hold a mesh that is not known.
  ShapeVerdict not_held(const MeshFile& file, const Error& error) {
    if (!first_error_) first_error_ = error;
    ShapeVerdict out;
    out.is_judged = false;
    out.file = &file;
    out.name = file.path;
    out.answer = error.code() == ErrorCode::LimitReached ? Answer::Undecided : Answer::Refuted;
    out.text = error.what();
    if (out.text.starts_with(file.path + ": ")) out.text.erase(0, file.path.size() + 2);
    out.text = "it is not held, for it cannot be judged: " + out.text;
    return out;
  }

  /// The meshes of one frame that distances are measured to.
  struct Measured {
    std::string path;  ///< of the first
    std::vector<geom::Mesh> meshes;
    double diagonal = 0;    ///< the largest [length, as the meshes]
    bool has_solid = true;  ///< else it is not known which solid the triangles bound
  };

  [[nodiscard]] Measured measured(const std::vector<JudgedFile>& subjects) const {
    Measured out{subjects.front().file->path, {}};
    for (const JudgedFile& subject : subjects) {
      MeasuredMesh to = q_.solid == Solid::AsFile ? MeasuredMesh{subject.mesh}
                                                  : measured_mesh(subject, subject.file->mesh);
      out.has_solid = out.has_solid && to.has_solid;
      out.diagonal = std::max(out.diagonal, geom::bounding_box(to.mesh).diagonal());
      out.meshes.push_back(std::move(to.mesh));
    }
    return out;
  }

  /// How far the bodies of one frame are from all of its meshes together.
  ShapeVerdict distance(const std::string& link, const Length& epsilon, const Measured& to,
                        const Holders& holders, const geom::Vec3& scale) {
    if (q_.progress) q_.progress("link " + link + ": distance");
    const ScaledBound scaled = scaled_bound(epsilon, to.diagonal, scale);
    require_length(scaled.bound, to.path, scale);
    const HeldDistance found =
        naming(to.path, [&] { return holders.distance(to.meshes, scaled.bound, q_.limits); });
    ShapeVerdict out;
    out.answer = answer_of(found, scaled);
    out.bound = scaled.bound;
    put_into_words(found, to, "", out);
    if (out.answer == Answer::Undecided && scaled.uneven) out.text += "; the scale is uneven";
    return out;
  }

  static void require_length(double bound, const std::string& path, const geom::Vec3& scale) {
    if (!(bound > 0) || !std::isfinite(bound))
      throw Error(ErrorCode::InvalidInput, "epsilon is no length in the unit of " + path +
                                               ", whose scale is " + number_text(scale.maxCoeff()));
  }

  /// How far what of them lies in a region is. A region round it verifies, one within it refutes.
  ShapeVerdict region_distance(const std::string& link, const robot::LinkRegion& region,
                               const Measured& to, const Holders& holders, const Geometry& shape) {
    if (q_.progress) q_.progress("link " + link + ": distance in the region " + region.name);
    ShapeVerdict out;
    HeldDistance found;
    const auto look = [&](robot::Side side) {
      const auto placed = robot::region_in_shape(region, shape, side);
      if (!placed) return Answer::Undecided;
      const geom::BoundedRegion bounded{placed->name, placed->region,
                                        placed->epsilon.of(to.diagonal)};
      require_length(bounded.epsilon, to.path, shape.size.cwiseAbs());
      found = naming(to.path,
                     [&] { return holders.distance_in_region(to.meshes, bounded, q_.limits); });
      if (side == robot::Side::Round) {
        out.bound = bounded.epsilon;
        out.reached = may_reach(holders.set(), bounded.region);
      }
      return found.claim ? found.claim->answer : Answer::Undecided;
    };
    out.answer = look(robot::Side::Round);
    if (out.answer != Answer::Verified) {
      out.answer = Answer::Undecided;
      if (look(robot::Side::Within) == Answer::Refuted) out.answer = Answer::Refuted;
    }
    out.region = region.name;
    put_into_words(found, to, "in the region " + region.name + " ", out);
    return out;
  }

  /// @param where  in front of what is said
  static void put_into_words(const HeldDistance& found, const Measured& to,
                             const std::string& where, ShapeVerdict& out) {
    out.name = "bodies";
    if (!found.claim) {
      out.text = where + "distances are decided of closed " + (where.empty() ? "" : "convex ") +
                 "meshes only, and not all are";
      return;
    }
    const DistanceClaim& claim = *found.claim;
    out.distance = claim;
    out.of_surface = found.of_surface;
    if (out.answer == Answer::Refuted && !to.has_solid) out.answer = Answer::Undecided;
    out.text = where;
    if (out.answer == Answer::Verified)
      out.text += (found.of_surface ? "its surface is nowhere more than "
                                    : std::string("nowhere more than ")) +
                  number_text(*out.bound) + " from the solid";
    else if (claim.answer == Answer::Refuted)
      out.text += "at least " + number_text(claim.largest) + " from the solid at " +
                  text_of(claim.at) + ", claimed " + number_text(*out.bound);
    else
      out.text += "not known to be within " + number_text(*out.bound) + " of the solid: " +
                  (claim.answer == Answer::Verified
                       ? "a little farther into the region than is certainly in it"
                       : claim.reason);
    out.text += ", in the mesh's own unit";
    if (!found.to_solid) out.text += " (to the surface, as it is open)";
    if (!to.has_solid) out.text += "; which solid its triangles bound is not known";
  }

  [[nodiscard]] std::string sentence_of(const LinkVerdict& link) const {
    std::size_t meshes = 0, others = 0, bodies = 0, sheets = 0, distances = 0, bad = 0;
    bool of_surface = false;
    std::vector<const MeshFile*> holders;
    const ShapeVerdict* worst = nullptr;
    for (const ShapeVerdict& s : link.shapes) {
      if (s.bound) {
        ++distances;
        of_surface = of_surface || s.of_surface;
      } else if (s.shape != Geometry::Shape::Mesh) {
        ++others;
      } else {
        ++meshes;
        sheets += s.dropped_sheets;
        for (const MeshFile* file : s.held_by)
          if (std::ranges::find(holders, file) == holders.end()) holders.push_back(file);
      }
      if (s.answer == Answer::Verified) continue;
      ++bad;
      if (worst == nullptr || worse(s.answer, worst->answer) != worst->answer) worst = &s;
    }
    bodies = holders.size();
    if (worst != nullptr)
      return worst->name + ": " + worst->text +
             (bad > 1 ? "; nor are " + counted(bad - 1, "other shape", "other shapes") : "");
    std::string out;
    if (meshes > 0) {
      out = q_.claims == Claims::Solid ? "its solid is inside: "
            : sheets > 0 ? "every triangle is inside but the " + counted(sheets, "one", "ones") +
                               " of sheets, which were dropped: "
                         : "every triangle is inside: ";
      out += counted(meshes, "mesh", "meshes") + " in " + counted(bodies, "body", "bodies");
      if (distances > 0)
        out += std::string(of_surface ? ", whose surface is" : ",") +
               " nowhere farther from it than asked";
    }
    if (others > 0)
      out += (out.empty() ? "" : "; ") + counted(others, "shape", "shapes") +
             (others == 1 ? " is as it was" : " are as they were");
    return out;
  }

  void look_for_strangers() {
    for (const robot::Link& link : q_.result.links) {
      if (!q_.is_asked(link) ||
          (!q_.epsilon_of(link.name) && !q_.bounds.groups.contains(link.name)))
        continue;
      const auto index = q_.original.find_link(link.name);
      const std::vector<Geometry> known =
          index ? q_.shapes_of(q_.original.links[*index]) : std::vector<Geometry>{};
      const std::size_t strangers = count_strangers(known, link.collision);
      if (strangers == 0) continue;
      out_.answer = worse(out_.answer, Answer::Undecided);
      out_.strangers.emplace_back(link.name, strangers);
    }
  }

  /// Of a link with bounds of its own the shape's name: it shares its verdict with no other one,
  /// for regions are elsewhere in other poses.
  [[nodiscard]] std::string bounds_key(const std::string& link, std::size_t shape) const {
    const bool has_own = q_.bounds.epsilons.contains(link) || q_.bounds.regions.contains(link);
    return has_own ? std::to_string(shape) + link : std::string();
  }

  using Key = std::tuple<std::vector<const MeshFile*>, std::vector<const MeshFile*>, double, double,
                         double, std::string>;
  const RobotQuestion& q_;
  RobotVerdict out_;
  std::optional<Error> first_error_;  // of a mesh that is not judged
  std::map<Key, std::vector<ShapeVerdict>> judged_;
};

}  // namespace

RobotVerdict decide(const RobotQuestion& question,
                    const std::function<void(const LinkVerdict&)>& judged) {
  return RobotJudge(question).run(judged);
}

}  // namespace kaboum::verify
