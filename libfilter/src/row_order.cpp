// Rows by the cells that they are in: the box of all is halved again and again, each time across
// the variable that moves the robot most in it.

#include "row_order.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace kaboum::filter::detail {
namespace {

constexpr std::size_t kFew = 64;  ///< rows that no order is worth it for
constexpr std::size_t kMostCuts = 16;
constexpr std::size_t kSteps = 32;  ///< from a row to the next one that are looked at

/// The cells of a box that rows are in.
class Cells {
 public:
  /// @param cuts  so many times the box is halved
  Cells(const Model& model, std::span<const double> rows, std::size_t cuts)
      : variables_(model.variables) {
    low_.assign(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(variables_));
    std::vector<double> high = low_;
    for (std::size_t i = 0; i < rows.size(); i += variables_)
      for (std::size_t k = 0; k < variables_; ++k) {
        low_[k] = std::min(low_[k], rows[i + k]);
        high[k] = std::max(high[k], rows[i + k]);
      }
    for (std::size_t k = 0; k < variables_; ++k)
      extents_.push_back(model.levers[k] * (high[k] - low_[k]));
    std::vector<std::size_t> halvings(variables_, 0);
    for (std::size_t i = 0; i < cuts; ++i) {
      const auto widest =
          static_cast<std::size_t>(std::ranges::max_element(extents_) - extents_.begin());
      cuts_.push_back({widest, halvings[widest]++});
      extents_[widest] /= 2;
    }
    for (std::size_t k = 0; k < variables_; ++k) {
      const double width = high[k] - low_[k];
      counts_.push_back(std::ldexp(1.0, static_cast<int>(halvings[k])));
      scales_.push_back(width > 0 ? counts_.back() / width : 0);
    }
    for (Cut& cut : cuts_) cut.bit = halvings[cut.variable] - 1 - cut.bit;
    numbers_.resize(variables_);
  }

  /// How far two places in a cell are from each other, about, as a robot moves. [length]
  [[nodiscard]] double size() const {
    return std::accumulate(extents_.begin(), extents_.end(), 0.0) / 3;
  }

  [[nodiscard]] std::uint32_t number_of(const double* row) {
    for (std::size_t k = 0; k < variables_; ++k) {
      const double at = (row[k] - low_[k]) * scales_[k];
      // What is no number, of rows that are too far apart for their difference, is in the first.
      numbers_[k] = at > 0 ? static_cast<std::uint32_t>(std::min(at, counts_[k] - 1)) : 0;
    }
    std::uint32_t out = 0;
    for (const Cut& cut : cuts_) out = out << 1U | (numbers_[cut.variable] >> cut.bit & 1U);
    return out;
  }

 private:
  struct Cut {
    std::size_t variable = 0;
    std::size_t bit = 0;  ///< of the variable's number that it gives
  };

  std::size_t variables_;
  std::vector<double> low_, extents_, counts_, scales_;
  std::vector<Cut> cuts_;
  std::vector<std::uint32_t> numbers_;
};

/// How far it is from a row to the next one, on average. [length]
double mean_step(const Model& model, std::span<const double> rows) {
  const std::size_t n = model.variables, count = rows.size() / n;
  double sum = 0;
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double* row = rows.data() + i * (count - 1) / kSteps * n;
    for (std::size_t k = 0; k < n; ++k) sum += model.levers[k] * std::abs(row[n + k] - row[k]);
  }
  return sum / kSteps;
}

}  // namespace

std::vector<std::uint32_t> order_of(const Model& model, std::span<const double> rows) {
  if (model.unusable || model.variables == 0 || rows.size() < kFew * model.variables) return {};
  const std::size_t count = rows.size() / model.variables;
  const std::size_t cuts = std::min<std::size_t>(std::bit_width(count), kMostCuts);
  Cells cells(model, rows, cuts);
  if (mean_step(model, rows) <= cells.size()) return {};
  std::vector<std::uint32_t> numbers, ends(std::size_t{1} << cuts, 0), out(count);
  numbers.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    numbers.push_back(cells.number_of(rows.data() + i * model.variables));
    ++ends[numbers.back()];
  }
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  for (std::size_t i = count; i-- > 0;) out[--ends[numbers[i]]] = static_cast<std::uint32_t>(i);
  return out;
}

}  // namespace kaboum::filter::detail
