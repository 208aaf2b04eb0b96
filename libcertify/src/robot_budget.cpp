// A budget for a whole robot: the epsilon that it allows, by halving.

#include <kaboum/base/error.h>
#include <kaboum/base/number_text.h>
#include <kaboum/certify/robot_budget.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "link_shapes.h"
#include "request.h"

namespace kaboum::certify {
namespace {

constexpr int kHalvings = 4;       // of an octave: within 5 %
constexpr int kOctaves = 11;       // below the hulls' distance
constexpr double kHullOnly = 1e6;  // percent: of whatever mesh one hull for each part suffices

struct Trial {
  std::size_t bodies = 0, vertices = 0;
  double distance = 0;
  bool reached = true;
};

class Trials {
 public:
  Trials(const robot::RobotFile& robot, RobotRequest request, const RobotBudget& budget,
         const SetCache* cache, const RobotHooks& hooks)
      : robot_(robot), request_(std::move(request)), budget_(budget), cache_(cache) {
    if (hooks.progress)
      hooks_.progress = [this, say = hooks.progress](const std::string& stage) {
        const std::optional<Length>& epsilon = request_.set.epsilon;
        say("epsilon " + (!epsilon || epsilon->percent ? "none" : number_text(epsilon->value)) +
            ": " + stage);
      };
    if (are_simple()) request_.partial = false;  // larger ones would be no answer
  }

  Trials(const Trials&) = delete;
  Trials& operator=(const Trials&) = delete;

  Trial at(const Length& epsilon) {
    request_.set.epsilon = epsilon;
    const CertifiedBodies made = certify_bodies(robot_, request_, cache_, hooks_);
    Trial t;
    t.bodies = made.artefact().size();
    t.distance = made.certificate().distance;
    for (const robot::LinkBody& body : made.artefact()) t.vertices += body.points.size();
    for (const CertifiedLinkMesh& mesh : made.certificate().meshes)
      t.reached = t.reached && mesh.made.found.set.certificate().reached();
    return t;
  }

  [[nodiscard]] bool fits(const Trial& t) const {
    return t.reached && t.bodies <= budget_.bodies.value_or(t.bodies) &&
           t.vertices <= budget_.vertices.value_or(t.vertices);
  }

  /// Whether the bodies within epsilon are; where a mesh has no bodies of the kind, they are not.
  bool fits_at(const Length& epsilon) {
    try {
      return fits(at(epsilon));
    } catch (const Error& error) {
      if (!are_simple() || !is_of_mesh(error)) throw;
      return false;
    }
  }

  [[nodiscard]] bool are_simple() const {
    return request_.set.body_kind != SetRequest::BodyKind::Polytopes;
  }

  /// The fewest that there are, in words.
  [[nodiscard]] std::string fewest(const Trial& t) const {
    if (are_simple())
      return ": one for each of its shapes are " + std::to_string(t.bodies) + " " +
             plural_of(request_.set.body_kind);
    return ": one convex body for each part of its shapes are " + std::to_string(t.bodies) +
           " bodies with " + std::to_string(t.vertices) + " vertices";
  }

 private:
  const robot::RobotFile& robot_;
  RobotRequest request_;
  RobotBudget budget_;
  const SetCache* cache_;
  RobotHooks hooks_;
};

}  // namespace

Length epsilon_within(const robot::RobotFile& robot, RobotRequest request,
                      const RobotBudget& budget, const SetCache* cache, const RobotHooks& hooks) {
  if (!request.epsilons.empty() || !request.regions.empty() || request.set.max_bodies ||
      request.set.max_total_vertices)
    throw Error(ErrorCode::InvalidArgument,
                "a robot's budget is shared out by one epsilon: no others and no limits of single "
                "meshes beside it");
  Trials trials(robot, std::move(request), budget, cache, hooks);
  const Trial hulls = trials.at({kHullOnly, true});
  if (!hulls.reached)
    throw Error(ErrorCode::LimitReached,
                robot.path.string() +
                    ": not even one hull for each part is made with the work that is allowed");
  if (!trials.fits(hulls))
    throw Error(ErrorCode::InvalidArgument,
                robot.path.string() + trials.fewest(hulls) + "; the budget is less");
  if (!(hulls.distance > 0)) return {kHullOnly, true};  // nothing to gain
  // Powers of two of the hulls' distance. From above, since small epsilons are dear.
  double most = 0, least = -1;
  const auto fits = [&](double power) {
    return trials.fits_at({hulls.distance * std::exp2(power), false});
  };
  while (least >= -kOctaves && fits(least)) most = least--;
  for (int i = 0; i < kHalvings && least >= -kOctaves; ++i) {
    const double middle = 0.5 * (least + most);
    (fits(middle) ? most : least) = middle;
  }
  return most == 0 ? Length{kHullOnly, true} : Length{hulls.distance * std::exp2(most), false};
}

}  // namespace kaboum::certify
