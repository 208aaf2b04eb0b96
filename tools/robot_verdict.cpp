// What bound-verify says of a shape of a robot: answers of libverify as words and JSON.

#include "robot_verdict.h"

#include <algorithm>
#include <vector>

#include "verdict.h"

namespace kaboum::tools {

using verify::Answer;

namespace {

/// Triangles are numbered as read, or as prepared; not all of many are listed.
Json claim_json(const verify::Claim& claim) {
  Json json{{"answer", name_of(claim.answer)}, {"reason", claim.reason}};
  if (!claim.witness) return json;
  constexpr std::size_t kMost = 100;
  std::vector<std::uint32_t> triangles = claim.inner_triangles;
  std::sort(triangles.begin(), triangles.end());
  const std::size_t all = triangles.size();
  triangles.resize(std::min(all, kMost));
  const geom::Vec3& p = claim.witness->point;
  json["witness"] = {{"point", {p.x(), p.y(), p.z()}},
                     {"depth", claim.witness->depth},
                     {"triangles_outside", all},
                     {"triangles", triangles}};
  return json;
}

}  // namespace

std::string count(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

Finding finding_of(const verify::HeldShape& held, const verify::Holders& holders, bool prepared) {
  Finding f{held.answer, held.reason};
  if (held.prepare_helps && !prepared) f.text += "; --prepare judges it as bcd-decompose takes it";
  if (!held.inclusion) return f;
  f.json["claims"] = {{"convex", claim_json(holders.convex())},
                      {"solid", claim_json(held.inclusion->solid)},
                      {"surface", claim_json(held.inclusion->surface)}};
  f.json["triangles_without_area"] = held.inclusion->triangles_without_area;
  f.json["limited"] = held.inclusion->limited;
  f.json["triangles_left_out"] = held.inclusion->left_out;
  if (!held.decisive) return f;
  const bool convex = holders.all_convex();
  const std::string bodies =
      convex ? count(holders.set().bodies.size(), "convex body", "convex bodies")
             : count(holders.set().bodies.size(), "mesh", "meshes, not all convex");
  if (held.decisive->answer == Answer::Verified) {
    f.text = std::string(held.solid && held.surface ? "its solid and surface are"
                         : held.solid               ? "its solid is"
                                                    : "its surface is") +
             " within " + bodies;
  } else if (held.decisive->answer == Answer::Refuted) {
    f.text = (convex ? "it is not within the " : "it is not known to be within the ") + bodies +
             " of its pose";
    if (const auto& witness = held.decisive->witness)
      f.text += ": " + point(witness->point) + " is " + number(witness->depth) +
                " outside, in the mesh's own unit";
  }
  return f;
}

Finding finding_of(const verify::HeldDistance& held, const verify::ScaledBound& scaled) {
  Finding f{answer_of(held, scaled), {}};
  if (!held.claim) {
    f.text = "distances are decided of convex bodies only, and not all are";
    return f;
  }
  const verify::DistanceClaim& claim = *held.claim;
  f.json["distance"] = {{"answer", name_of(claim.answer)},
                        {"reason", claim.reason},
                        {"bound", scaled.bound},
                        {"largest_found", claim.largest}};
  f.text = f.answer == Answer::Verified
               ? "nowhere more than " + number(scaled.bound) + " from the solid"
               : "at least " + number(claim.largest) + " from the solid at " + point(claim.at) +
                     ", claimed " + number(scaled.bound);
  f.text += ", in the mesh's own unit";
  if (!held.to_solid) f.text += " (to the surface, as it is open)";
  if (f.answer == Answer::Undecided && scaled.uneven) f.text += "; the scale is uneven";
  return f;
}

Finding finding_of(const robot::Geometry& shape, const verify::MatchedShapes& match) {
  const Answer answer = find_again(shape, match);
  return {answer, answer == Answer::Verified  ? "the result has it as well"
                  : answer == Answer::Refuted ? "the result's link has no shape at all"
                                              : "the result has none of its size and pose"};
}

Finding beside_others(Finding f, const verify::MatchedShapes& match) {
  const Answer answer = verify::beside_others(f.answer, match);
  if (answer != f.answer)
    f.text += "; what the " + count(match.elsewhere, "shape", "shapes") +
              " of other poses hold is not looked at";
  f.answer = answer;
  return f;
}

}  // namespace kaboum::tools
