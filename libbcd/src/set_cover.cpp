// Few sets that hold all points: local search with weights.
#include "set_cover.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace kaboum::bcd {
namespace {

/// Pairs of a set and a point that a search looks at, at most.
constexpr std::uint64_t kMostPairs = 200'000'000;
constexpr std::uint32_t kNoSet = std::numeric_limits<std::uint32_t>::max();

}  // namespace

SetCover::SetCover(std::size_t points, std::vector<std::vector<std::uint32_t>> sets)
    : sets_(std::move(sets)),
      of_point_(points),
      words_(points / 64 + 1),
      bits_(sets_.size() * words_, 0),
      times_(points, 0),
      place_(points, 0),
      weight_(points, 1),
      changed_(sets_.size(), 0),
      may_be_taken_(sets_.size(), 1),
      is_chosen_(sets_.size(), 0) {
  for (std::uint32_t s = 0; s < sets_.size(); ++s)
    for (const std::uint32_t p : sets_[s]) {
      of_point_[p].push_back(s);
      bits_[s * words_ + p / 64] |= std::uint64_t{1} << (p % 64);
    }
  free_.reserve(points);
  for (std::uint32_t p = 0; p < points; ++p) {
    place_[p] = p;
    free_.push_back(p);
  }
}

void SetCover::take(std::uint32_t set) {
  is_chosen_[set] = 1;
  chosen_.push_back(set);
  for (const std::uint32_t p : sets_[set]) {
    if (times_[p]++ > 0) continue;
    const std::uint32_t last = free_.back();
    free_[place_[p]] = last;
    place_[last] = place_[p];
    free_.pop_back();
  }
}

void SetCover::drop(std::uint32_t set) {
  is_chosen_[set] = 0;
  chosen_.erase(std::find(chosen_.begin(), chosen_.end(), set));
  for (const std::uint32_t p : sets_[set]) {
    if (--times_[p] > 0) continue;
    place_[p] = static_cast<std::uint32_t>(free_.size());
    free_.push_back(p);
    for (const std::uint32_t s : of_point_[p]) may_be_taken_[s] = 1;
  }
}

double SetCover::gain(std::uint32_t set) const {
  double out = 0;
  for (const std::uint32_t p : sets_[set])
    if (times_[p] == 0) out += weight_[p];
  return out;
}

double SetCover::loss(std::uint32_t set) const {
  double out = 0;
  for (const std::uint32_t p : sets_[set])
    if (times_[p] == 1) out += weight_[p];
  return out;
}

void SetCover::choose_greedily() {
  std::vector<std::pair<double, std::uint32_t>> heap;  // gains as they were, which only fall
  for (std::uint32_t s = 0; s < sets_.size(); ++s)
    if (!sets_[s].empty() && is_chosen_[s] == 0) heap.emplace_back(gain(s), s);
  std::ranges::make_heap(heap);
  while (!free_.empty() && !heap.empty()) {
    std::ranges::pop_heap(heap);
    const auto [known, set] = heap.back();
    heap.pop_back();
    const double now = gain(set);
    if (!(now > 0)) continue;
    if (!heap.empty() && now < heap.front().first) {
      heap.emplace_back(now, set);
      std::ranges::push_heap(heap);
      continue;
    }
    take(set);
  }
}

std::size_t SetCover::cheapest(std::uint32_t kept) const {
  std::size_t best = chosen_.size();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    if (chosen_[i] == kept) continue;
    const double loses = loss(chosen_[i]);
    if (loses < least || (loses == least && changed_[chosen_[i]] < changed_[chosen_[best]])) {
      least = loses;
      best = i;
    }
  }
  return best;
}

std::vector<std::uint32_t> SetCover::search(std::size_t steps, std::size_t enough) {
  choose_greedily();
  if (!free_.empty()) return {};
  std::vector<std::uint32_t> best;
  std::uint32_t last = kNoSet;
  std::uint64_t pairs = 0;
  for (std::size_t step = 1; step <= steps + 1; ++step) {
    while (free_.empty()) {
      best = chosen_;
      const std::size_t i = cheapest(kNoSet);
      if (best.size() <= std::max<std::size_t>(enough, 1) || i >= chosen_.size()) {
        std::ranges::sort(best);
        return best;
      }
      changed_[chosen_[i]] = step;
      drop(chosen_[i]);
    }
    if (step > steps || pairs > kMostPairs) break;
    for (const std::uint32_t s : chosen_) pairs += sets_[s].size();
    if (const std::size_t i = cheapest(last); i < chosen_.size()) {
      const std::uint32_t set = chosen_[i];
      drop(set);
      changed_[set] = step;
      may_be_taken_[set] = 0;
    }
    const std::uint32_t point = free_[random_.index(free_.size())];
    pairs += of_point_[point].size() * free_.size();
    std::uint32_t taken = kNoSet;
    double most = -1;
    for (const std::uint32_t s : of_point_[point]) {
      if (may_be_taken_[s] == 0) continue;
      double gains = 0;  // few points are free
      for (const std::uint32_t p : free_)
        if (has(s, p)) gains += weight_[p];
      if (gains > most || (gains == most && changed_[s] < changed_[taken])) {
        most = gains;
        taken = s;
      }
    }
    if (taken != kNoSet) {
      take(taken);
      changed_[taken] = step;
      last = taken;
    }
    for (const std::uint32_t p : free_) weight_[p] += 1;
  }
  std::ranges::sort(best);
  return best;
}

}  // namespace kaboum::bcd
