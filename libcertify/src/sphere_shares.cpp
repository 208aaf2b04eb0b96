// Spheres of a robot, shared out to its links: what each link takes for several distances, and the
// best choice of these within the number.
#include <kaboum/base/error.h>
#include <kaboum/certify/robot_budget.h>
#include <kaboum/certify/sphere_shares.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "link_shapes.h"

namespace kaboum::certify {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr int kRounds = 5;                      ///< of other epsilons for all links
constexpr double kApart = 1.04;                 ///< ratio of epsilons that are worth two searches
constexpr double kCoarser = 1.3;                ///< than the coarsest known
constexpr double kFinest = 0.6, kFiner = 0.92;  ///< of the distance of the finest known

/// Spheres that hold a link.
struct Holding {
  Length epsilon;  ///< that they were asked for with
  std::size_t count = 0;
  double distance = kFar;
  double largest = kFar;  ///< epsilon known to take so many
};

/// What is known of a link: more spheres are nearer.
class Holdings {
 public:
  /// Keeps those that no other ones are better than.
  void add(const Holding& one) {
    if (!one.epsilon.percent) asked_.push_back(one.epsilon.value);
    if (one.count == 0) return;  // none were found
    all_.push_back(one);
    std::ranges::stable_sort(all_, [](const Holding& a, const Holding& b) {
      return a.count != b.count ? a.count < b.count : a.distance < b.distance;
    });
    std::vector<Holding> better;
    for (const Holding& h : all_)
      if (better.empty() || h.distance < better.back().distance)
        better.push_back(h);
      else if (h.count == better.back().count)
        better.back().largest = std::max(better.back().largest, h.largest);
    all_ = std::move(better);
  }

  [[nodiscard]] const std::vector<Holding>& all() const { return all_; }

  /// An epsilon that may take fewer spheres more than the next finer holding does.
  /// @param rest  spheres that are left
  [[nodiscard]] double finer_than(std::size_t index, std::size_t rest) const {
    const Holding& now = all_[index];
    if (index + 1 < all_.size()) return between(now, all_[index + 1]);
    const double count = static_cast<double>(now.count);
    const double share = std::sqrt(count / (count + static_cast<double>(rest)));
    return fresh(std::clamp(share, kFinest, kFiner) * now.distance);
  }

  /// An epsilon that may take fewer spheres.
  [[nodiscard]] double coarser_than(std::size_t index) const {
    const Holding& now = all_[index];
    if (now.count == 1) return 0;
    return index > 0 ? between(all_[index - 1], now) : fresh(kCoarser * now.largest);
  }

 private:
  /// An epsilon between; 0: there is none that is worth a search.
  [[nodiscard]] double between(const Holding& coarse, const Holding& fine) const {
    if (fine.count <= coarse.count + 1 || !(coarse.distance > kApart * fine.largest)) return 0;
    return fresh(std::sqrt(coarse.distance * fine.largest));
  }

  /// 0 for one that was asked for, or nearly.
  [[nodiscard]] double fresh(double epsilon) const {
    for (const double known : asked_)
      if (epsilon < kApart * known && known < kApart * epsilon) return 0;
    return epsilon;
  }

  std::vector<Holding> all_;  ///< fewest spheres first
  std::vector<double> asked_;
};

/// Searches for the spheres of single links.
class LinkSearch {
 public:
  LinkSearch(const robot::RobotFile& robot, const RobotRequest& request, const SetCache* cache,
             const RobotHooks& hooks)
      : robot_(robot), request_(request), cache_(cache) {
    hooks_.progress = hooks.progress;
    request_.partial = false;  // larger spheres would be no answer
    for (const robot::LinkShape& shape : wanted_meshes(robot, request.shapes).shapes) {
      const robot::Link& link = robot.robot.links[shape.link];
      const bool is_new = links_.empty() || links_.back() != link.name;
      if (is_new && !robot::is_point(request.shapes.shapes_of(link)[shape.index]))
        links_.push_back(link.name);
    }
  }

  /// Of links that have bodies.
  [[nodiscard]] const std::vector<std::string>& links() const { return links_; }

  /// @return with the count 0 where none are found within epsilon
  [[nodiscard]] Holding at(const std::string& link, const Length& epsilon) const {
    RobotRequest own = request_;
    own.shapes.links = {link};
    own.set.epsilon = epsilon;
    RobotHooks hooks;
    if (hooks_.progress)
      hooks.progress = [&](const std::string& stage) {
        hooks_.progress("link '" + link + "': " + stage);
      };
    Holding out;
    out.epsilon = epsilon;
    try {
      const CertifiedBodies made = certify_bodies(robot_, own, cache_, hooks);
      out.count = made.artefact().size();
      out.distance = made.certificate().distance;
      out.largest = epsilon.percent ? out.distance : epsilon.value;
    } catch (const Error& error) {
      if (!is_of_mesh(error)) throw;
    }
    return out;
  }

 private:
  const robot::RobotFile& robot_;
  RobotRequest request_;
  const SetCache* cache_;
  RobotHooks hooks_;
  std::vector<std::string> links_;
};

/// Of each link, which holding: those within the number whose distances have the least sum.
/// @param farthest  holdings that are farther are left out
/// @return empty: there are none
std::vector<std::size_t> least_sum(const std::vector<Holdings>& links, std::size_t spheres,
                                   double farthest) {
  // Sums by numbers of spheres, link by link, each with the holding that it has of the last link.
  std::vector<std::vector<std::size_t>> taken(links.size());
  std::vector<double> sums(spheres + 1, 0);
  for (std::size_t l = 0; l < links.size(); ++l) {
    std::vector<double> next(spheres + 1, kFar);
    taken[l].assign(spheres + 1, 0);
    for (std::size_t k = 0; k < links[l].all().size(); ++k) {
      const Holding& h = links[l].all()[k];
      if (h.distance > farthest) continue;
      for (std::size_t n = h.count; n <= spheres; ++n) {
        const double sum = sums[n - h.count] + h.distance;
        if (!(sum < next[n])) continue;
        next[n] = sum;
        taken[l][n] = k;
      }
    }
    sums = std::move(next);
  }
  if (sums[spheres] == kFar) return {};
  std::vector<std::size_t> out(links.size());
  std::size_t left = spheres;
  for (std::size_t l = links.size(); l-- > 0;) {
    out[l] = taken[l][left];
    left -= links[l].all()[out[l]].count;
  }
  return out;
}

std::vector<std::size_t> best_choice(const std::vector<Holdings>& links, std::size_t budget,
                                     SphereShare share) {
  std::size_t most = 0;
  for (const Holdings& link : links)
    if (!link.all().empty()) most += link.all().back().count;
  const std::size_t spheres = std::min(budget, most);
  if (share == SphereShare::Mean) return least_sum(links, spheres, kFar);
  std::vector<double> distances;
  for (const Holdings& link : links)
    for (const Holding& h : link.all()) distances.push_back(h.distance);
  std::ranges::sort(distances);
  // More are allowed by a larger one.
  const auto allows = [&](double farthest) { return !least_sum(links, spheres, farthest).empty(); };
  const auto least = std::ranges::partition_point(distances, [&](double d) { return !allows(d); });
  return least == distances.end() ? std::vector<std::size_t>{} : least_sum(links, spheres, *least);
}

/// Epsilons of a link that may lead to a better choice.
std::vector<double> worth_trying(const Holdings& link, std::size_t chosen, std::size_t rest,
                                 SphereShare share) {
  std::vector<double> out;
  if (rest > 0 || share == SphereShare::Mean)
    out.push_back(link.finer_than(chosen, std::max<std::size_t>(rest, 1)));
  if (share == SphereShare::Mean) out.push_back(link.coarser_than(chosen));
  std::erase_if(out, [](double epsilon) { return !(epsilon > 0); });
  return out;
}

std::size_t count_of(const std::vector<Holdings>& links, const std::vector<std::size_t>& choice) {
  std::size_t out = 0;
  for (std::size_t l = 0; l < links.size(); ++l) out += links[l].all()[choice[l]].count;
  return out;
}

}  // namespace

LinkEpsilons share_spheres(const robot::RobotFile& robot, const RobotRequest& request,
                           std::size_t spheres, SphereShare share, const SetCache* cache,
                           const RobotHooks& hooks) {
  RobotRequest coarse = request;
  coarse.set.nearest = false;  // the number is the same
  const Length one = epsilon_within(robot, coarse, {spheres, std::nullopt}, cache, hooks);
  const LinkSearch search(robot, request, cache, hooks);
  const std::vector<std::string>& names = search.links();
  std::vector<Holdings> links(names.size());
  for (std::size_t l = 0; l < names.size(); ++l) links[l].add(search.at(names[l], one));
  std::vector<std::size_t> choice = best_choice(links, spheres, share);
  for (int round = 0; round < kRounds && !choice.empty(); ++round) {
    const std::size_t rest = spheres - count_of(links, choice);
    bool is_new = false;
    for (std::size_t l = 0; l < names.size(); ++l) {
      for (const double epsilon : worth_trying(links[l], choice[l], rest, share)) {
        links[l].add(search.at(names[l], {epsilon, false}));
        is_new = true;
      }
    }
    if (!is_new) break;
    choice = best_choice(links, spheres, share);
  }
  LinkEpsilons out;
  for (std::size_t l = 0; l < names.size(); ++l)
    out[names[l]] = choice.empty() ? one : links[l].all()[choice[l]].epsilon;
  return out;
}

}  // namespace kaboum::certify
