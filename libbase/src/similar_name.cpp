// Guesses what a misspelt name was to be, for messages.

#include <kaboum/base/similar_name.h>

#include <algorithm>
#include <cctype>

namespace kaboum {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// Fewest insertions, deletions and replacements of one character that turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row[b.size()];
}

}  // namespace

std::optional<std::string> similar_name(std::string_view name,
                                        const std::vector<std::string>& known) {
  constexpr std::size_t kLongest = 1000;  // of names that are worth a guess
  if (name.size() > kLongest) return std::nullopt;
  const std::string wanted = lower(name);
  std::optional<std::string> nearest;
  std::size_t least = 3;  // as many slips are no slip
  for (const std::string& candidate : known) {
    if (candidate.size() > name.size() + kLongest) continue;
    const std::string other = lower(candidate);
    const bool begins = wanted.size() > 3 && other.starts_with(wanted);
    const std::size_t distance = begins ? 0 : edit_distance(wanted, other);
    if (distance >= least || 2 * distance >= wanted.size()) continue;
    least = distance;
    nearest = candidate;
  }
  return nearest;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& known) {
  const std::optional<std::string> similar = similar_name(name, known);
  return similar ? "; did you mean '" + *similar + "'?" : std::string();
}

}  // namespace kaboum
