// What was found of a motion, in words.
#include <iomanip>
#include <sstream>

#include "sweep_case.h"
#include "verdict.h"

namespace kaboum::tools {

using verify::Answer;

namespace {

std::string line(const char* title, const verify::Claim& claim, const std::string& what) {
  return std::string(title) + ": " + name_of(claim.answer) + ": " +
         (claim.answer == Answer::Verified ? what : claim.reason);
}

std::string say(const verify::SweepPlace& p, const SweepCase& run) {
  std::ostringstream text;
  text << std::setprecision(17) << run.shapes.shapes[p.shape].name << " at " << p.s
       << " of segment " << p.segment + 1 << ", " << point(p.point);
  return text.str();
}

}  // namespace

std::vector<std::string> lines_of(const SweepCase& run) {
  std::vector<std::string> lines;
  const verify::SweepClaims& claims = run.claims;
  const double margin = run.swept.set.margin;
  lines.push_back(
      line("convexity", claims.convex,
           "all " + std::to_string(run.swept.set.bodies.size()) + " bodies are convex"));
  lines.push_back(
      line("surface claim", claims.surface,
           "during the whole path " + std::to_string(run.shapes.shapes.size()) +
               " shapes of the links stay within " +
               (margin > 0 ? "the bodies, with the margin " + number(margin) + " included"
                           : std::string("the bodies"))));
  if (claims.refuting)
    lines.push_back("  " + say(*claims.refuting, run) + ": " + number(claims.refuting->distance) +
                    " from the nearest body, margin " + number(margin));
  else if (claims.undecided)
    lines.push_back("  " + say(*claims.undecided, run));
  if (!claims.refuting && run.knows_farthest())
    lines.push_back("  farthest of " + std::to_string(claims.samples) +
                    " places sampled: " + number(claims.farthest.distance) + ", " +
                    (claims.farthest.distance > 0 ? say(claims.farthest, run) : "none is outside"));
  if (run.asked.claims != "surface" && claims.solid.answer != Answer::Undefined)
    lines.push_back(line("solid claim", claims.solid, "so do the insides of the closed shapes"));
  if (claims.open_meshes > 0)
    lines.push_back(std::to_string(claims.open_meshes) +
                    " meshes are not closed: their surfaces alone are judged");
  const SweepShapes& shapes = run.shapes;
  lines.push_back(std::string(name_of(run.answer)) + ": " +
                  robot::links_judged(shapes.judged, shapes.asked, shapes.bare) +
                  except_sheets(shapes.dropped) +
                  (shapes.cad && run.answer == Answer::Verified ? kOfTriangles : ""));
  return lines;
}

}  // namespace kaboum::tools
