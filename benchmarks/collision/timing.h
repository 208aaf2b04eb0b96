#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <vector>

namespace kaboum::collide {

/// Of the times of queries. [microseconds]
struct Statistics {
  double mean, median, p99, most;
};

/// Runs query(0), …, query(count − 1) three to 12 times, fewer when they are slow, and keeps the
/// fastest run of each: other programs of the machine only ever add. All are 0 of no queries.
inline Statistics times_of(std::size_t count, const std::function<void(std::size_t)>& query,
                           std::vector<double>& times) {
  times.assign(count, 1e9);
  double total = 0;
  for (int run = 0; run < 12 && (run < 3 || total < 5e6); ++run) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto start = std::chrono::steady_clock::now();
      query(i);
      const std::chrono::duration<double, std::micro> took =
          std::chrono::steady_clock::now() - start;
      times[i] = std::min(times[i], took.count());
      total += took.count();
    }
  }
  if (count == 0) return {};
  std::vector<double> sorted = times;
  std::sort(sorted.begin(), sorted.end());
  double sum = 0;
  for (const double t : sorted) sum += t;
  const auto below = [&](double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(count - 1))];
  };
  return {sum / static_cast<double>(count), below(0.5), below(0.99), sorted.back()};
}

}  // namespace kaboum::collide
