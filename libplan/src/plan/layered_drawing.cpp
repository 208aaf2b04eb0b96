// Layered drawing: order within rows by barycentres, then positions by least squares under the
// rows' order, both in sweeps down and up.

#include "plan/layered_drawing.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

namespace kaboum::plan {
namespace {

constexpr int kSweeps = 8;

double mean(const std::vector<double>& values, const std::vector<std::size_t>& of,
            double fallback) {
  if (of.empty()) return fallback;
  double sum = 0;
  for (const std::size_t n : of) sum += values[n];
  return sum / static_cast<double>(of.size());
}

}  // namespace

std::size_t LayeredGraph::add(std::size_t row, double width) {
  if (rows.size() <= row) rows.resize(row + 1);
  rows[row].push_back(nodes.size());
  nodes.push_back({width, {}, {}, 0});
  return nodes.size() - 1;
}

void LayeredGraph::connect(std::size_t upper, std::size_t lower) {
  nodes[upper].below.push_back(lower);
  nodes[lower].above.push_back(upper);
}

double LayeredGraph::place(const std::function<void()>& progress) {
  std::vector<double> at(nodes.size());  // place in the row, then x
  const auto number = [&](const std::vector<std::size_t>& row) {
    for (std::size_t i = 0; i < row.size(); ++i) at[row[i]] = static_cast<double>(i);
  };
  for (const auto& row : rows) number(row);
  const auto sweep = [&](const auto& look) {
    const auto visit = [&](std::vector<std::size_t>& row, std::vector<std::size_t> Node::*side) {
      if (progress) progress();
      look(row, side);
    };
    for (int s = 0; s < kSweeps; ++s) {
      for (std::size_t r = 1; r < rows.size(); ++r) visit(rows[r], &Node::above);
      for (std::size_t r = rows.size(); r-- > 1;) visit(rows[r - 1], &Node::below);
    }
    for (std::size_t r = 1; r < rows.size(); ++r) visit(rows[r], &Node::above);
  };
  sweep([&](std::vector<std::size_t>& row, std::vector<std::size_t> Node::*side) {
    std::vector<std::pair<double, std::size_t>> wished;
    wished.reserve(row.size());
    for (const std::size_t n : row) wished.emplace_back(mean(at, nodes[n].*side, at[n]), n);
    std::stable_sort(wished.begin(), wished.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = wished[i].second;
    number(row);
  });

  for (const auto& row : rows) {
    double x = 0;
    for (const std::size_t n : row) {
      at[n] = x + nodes[n].width / 2;
      x += nodes[n].width;
    }
  }
  // Nearest to the means of the neighbours with the rows' order and widths: isotonic regression by
  // pooling adjacent violators.
  sweep([&](const std::vector<std::size_t>& row, std::vector<std::size_t> Node::*side) {
    struct Pool {
      double sum;
      std::size_t count;
      [[nodiscard]] double level() const { return sum / static_cast<double>(count); }
    };
    std::vector<Pool> pools;
    std::vector<double> offset;
    double reached = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) reached += (nodes[row[i - 1]].width + nodes[row[i]].width) / 2;
      offset.push_back(reached);
      pools.push_back({mean(at, nodes[row[i]].*side, at[row[i]]) - reached, 1});
      while (pools.size() > 1 && pools[pools.size() - 2].level() > pools.back().level()) {
        const Pool last = pools.back();
        pools.pop_back();
        pools.back().sum += last.sum;
        pools.back().count += last.count;
      }
    }
    std::size_t i = 0;
    for (const Pool& p : pools)
      for (std::size_t k = 0; k < p.count; ++k, ++i) at[row[i]] = p.level() + offset[i];
  });

  double left = std::numeric_limits<double>::infinity(), right = -left;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    left = std::min(left, at[n] - nodes[n].width / 2);
    right = std::max(right, at[n] + nodes[n].width / 2);
  }
  for (std::size_t n = 0; n < nodes.size(); ++n) nodes[n].x = at[n] - left;
  return nodes.empty() ? 0 : right - left;
}

}  // namespace kaboum::plan
