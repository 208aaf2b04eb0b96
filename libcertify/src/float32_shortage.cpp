// Why float32 numbers do not do, and what helps.

#include <kaboum/certify/float32_shortage.h>
#include <kaboum/geom/float32.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace kaboum::certify {
namespace {

std::string four_digits(double x) {
  std::ostringstream s;
  s << std::setprecision(4) << x;
  return s.str();
}

/// Three digits, and no less.
std::string three_digits_above(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 2);
  return four_digits(std::ceil(x / unit * (1 + 1e-12)) * unit);
}

}  // namespace

std::optional<Float32Shortage> too_coarse(const geom::Box3& box, std::optional<double> epsilon,
                                          const SpacingShares& shares) {
  const double of_diagonal = shares.of_diagonal * box.diagonal();
  Float32Shortage shortage;
  shortage.limit = epsilon ? std::min(of_diagonal, shares.of_epsilon * *epsilon) : of_diagonal;
  if (shortage.limit == of_diagonal) shortage.of_diagonal = shares.of_diagonal;
  shortage.spacing =
      geom::float32_spacing(std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff()));
  if (shortage.spacing <= shortage.limit) return std::nullopt;
  shortage.near_origin = geom::float32_spacing((box.max - box.min).maxCoeff() / 2);
  if (shortage.spacing <= of_diagonal)
    shortage.least_epsilon = shortage.spacing / shares.of_epsilon;
  return shortage;
}

std::string reason_of(const Float32Shortage& s) {
  if (s.vertices == 0)
    return "float32 numbers are " + four_digits(s.spacing) +
           " apart at these coordinates, more than " + four_digits(s.limit) +
           (s.of_diagonal > 0 ? " (the diagonal times " + four_digits(s.of_diagonal) + ")"
                              : " (a hundredth of epsilon)");
  return std::to_string(s.vertices) + (s.vertices == 1 ? " vertex" : " vertices") +
         " without a certified float32 position" +
         (s.keeps_border ? ": an open mesh's border stays where it is, and its coordinates are no "
                           "float32 numbers"
                         : ": no float32 numbers near by are on the right side of all faces, as at "
                           "sheets and at walls without volume");
}

std::string remedy_of(const Float32Shortage& s) {
  if (s.vertices > 0)
    return s.keeps_border ? "round the input's coordinates to float32 first, or close its holes"
                          : "round the input's coordinates to float32 first, or have a wrap give "
                            "sheets a thickness";
  std::string text;
  if (s.near_origin <= s.limit) text = "move the mesh to the origin";
  if (s.least_epsilon > 0)
    text += (text.empty() ? "" : ", or ") +
            ("allow an epsilon of at least " + three_digits_above(s.least_epsilon));
  if (text.empty()) text = "move the mesh to the origin and allow a larger epsilon";
  return text;
}

}  // namespace kaboum::certify
