// What bmesh-decimate says of its results: a summary of each, claims that do not hold, places to
// beware of.

#include <iomanip>
#include <sstream>

#include "decimation_case.h"
#include "verdict.h"

namespace kaboum::tools {
namespace {

using certify::MeshCertificate;
using verify::Answer;

constexpr double kFar = 0.05;  ///< of the diagonal: worth a warning

/// Says all about one result.
class Lines {
 public:
  Lines(const DecimationCase& run, std::size_t place)
      : run_(run),
        made_(run.series().meshes[place].certificate()),
        file_(run.files[place].empty() ? run.asked.progressive : run.files[place]) {}

  /// @return the exit code that this result gives
  [[nodiscard]] int conclude() const {
    say(summary());
    warn_of_distance();
    const int surface = made_.decided ? kDone : conclude_surface();
    const int verification = made_.decided ? conclude_verification(*made_.decided) : surface;
    const bool claims_nothing = !made_.closed && made_.direction != bmesh::Direction::Any;
    if (claims_nothing)
      complain(std::string("the mesh is open, so it has no solid that the result could ") +
               (run_.outer() ? "enclose" : "lie in") +
               "; the result is written. Leave out --holes keep to have the holes filled, or give "
               "--direction any if no enclosure is wished for");
    if (made_.stop == bmesh::Stop::OutOfWork) {
      complain("the work allowed has ended at " + std::to_string(made_.vertices) +
               " vertices; the result so far is written. Allow more with --max-work, or give "
               "--effort fast");
      return claims_nothing || verification == kNo ? kNo : kLimit;
    }
    if (made_.out_of_work)
      say("note: not as near as it might be: the work allowed has ended; allow more with "
          "--max-work");
    if (!made_.reached()) {
      complain(std::to_string(*made_.requested) + " vertices cannot be reached with --cost " +
               run_.asked.value("cost") + ": no further contraction is possible at " +
               std::to_string(made_.vertices) + "; the result so far is written");
      return kNo;
    }
    return claims_nothing ? kNo : verification;
  }

  [[nodiscard]] std::string summary() const {
    const double diagonal = run_.series().plan.diagonal;
    std::string line = file_ + ": " + std::to_string(made_.statistics.vertices_in) + " → " +
                       std::to_string(made_.vertices) + " vertices, " +
                       run_.asked.value("direction");
    if (made_.direction != bmesh::Direction::Any)
      line += !made_.closed ? ", NOTHING IS ENCLOSED: the mesh is open"
              : made_.surface_answer() == Answer::Verified ? ", certified"
                                                           : ", NOT ALL TRIANGLES ARE CERTIFIED";
    if (made_.original_to_result) {
      const double wrap = run_.wrap() ? run_.wrap()->farthest_upper : 0;
      const double within = made_.hausdorff_upper() + wrap;
      line += ", within " + formatted(within) + " (" + formatted(100 * within / diagonal) + "%)";
    }
    if (made_.requested && made_.stop == bmesh::Stop::ErrorBound)
      line += "; epsilon allows no fewer, " + std::to_string(*made_.requested) + " were wished";
    return line;
  }

 private:
  void say(const std::string& text) const { log(run_.asked.common.quiet, text); }
  /// An error, about the input.
  void complain(const std::string& text) const {
    log(false, "bmesh-decimate: " + run_.asked.input + ": " + text);
  }

  void warn_of_distance() const {
    const double diagonal = run_.series().plan.diagonal;
    const auto warn = [&](const std::string& what, double length, const char* where) {
      if (!(length > kFar * diagonal)) return;
      say("warning: " + what + formatted(100 * length / diagonal) + "% of the diagonal " + where +
          "; " +
          (run_.series().plan.epsilon ? "use a smaller --epsilon"
                                      : "use more vertices, or --epsilon to bound the distance"));
    };
    warn("the result reaches ", made_.outliers.beyond_box, "beyond the input's bounding box");
    warn("the input has vertices ", made_.outliers.away, "away from the result");
  }

  [[nodiscard]] static std::string not_looked_at(const certify::DecidedSurface& surface) {
    return "whether " + std::to_string(surface.left_out) +
           (surface.left_out == 1 ? " triangle sticks" : " triangles stick") +
           " out was not decided, for the work allowed was done; allow more with --max-work";
  }

  /// Says which claim holds and which does not, where they differ. @return the exit code
  [[nodiscard]] int conclude_surface() const {
    const bool outer = run_.outer();
    if (made_.surface_answer() == Answer::Verified || !made_.surface) return kDone;
    const certify::DecidedSurface& surface = *made_.surface;
    if (surface.claim.answer != Answer::Refuted) {
      complain(std::string(outer ? "the input's solid is enclosed; "
                                 : "the result's solid is inside the input's; ") +
               not_looked_at(surface) + ". The result is written");
      return kLimit;
    }
    complain(sticking_out(surface) + ". The result is written" +
             (outer ? remedy() : std::string("; only its solid lies in the input's")));
    return kNo;
  }

  /// How to have all triangles enclosed.
  [[nodiscard]] std::string remedy() const {
    const std::string why = run_.made.why_not_wrapped;
    if (run_.asked.records())
      return "; --prepare wrap encloses every triangle, or write the wrap with mesh-prepare first, "
             "if steps are wished for";
    if (!why.empty()) return "; a wrap would hold every triangle, but: " + why;
    return "; --prepare wrap encloses every triangle";
  }

  [[nodiscard]] std::string sticking_out(const certify::DecidedSurface& surface) const {
    const bool outer = run_.outer();
    const std::size_t count = surface.claim.inner_triangles.size();
    const verify::Bracket& out = surface.sticks_out;
    const std::string depth = in_words(out);
    std::string text =
        outer ? "the input's solid is enclosed, but not all of its triangles"
              : "the result's solid is inside the input's, but not all of its triangles";
    text += (surface.left_out > 0 ? ": at least " : ": ") + std::to_string(count) +
            (count == 1 ? " sticks out" : " stick out");
    if (!depth.empty()) text += ", by " + depth;
    if (out.lower > 0)
      text += ", farthest at " + point(out.at) +
              (surface.at_filling ? ", where a hole was filled"
                                  : ", triangle " + std::to_string(out.triangle) +
                                        (outer ? " of the input" : " of the result"));
    text += " (the input is folded or inside out there: such faces bound no solid)";
    if (surface.left_out > 0) text += "; " + not_looked_at(surface);
    return text;
  }

  /// Says which claims are not verified. @return the exit code that they give
  [[nodiscard]] int conclude_verification(const certify::DecidedMesh& decided) const {
    int code = kDone;
    const auto look = [&](const std::string& what, Answer answer, const std::string& detail) {
      if (answer == Answer::Verified) return;
      log(false, "bmesh-decimate: " + file_ + ": " + what + " is " + name_of(answer) +
                     (detail.empty() ? "" : ": " + detail));
      if (answer == Answer::Undecided && code == kDone) code = kLimit;
      if (answer != Answer::Undecided) code = kNo;
    };
    look("the solid claim", decided.inclusion.solid.answer, decided.inclusion.solid.reason);
    if (made_.surface) {  // open meshes have none
      const verify::Claim& surface = made_.surface->claim;
      look("the surface claim", surface.answer,
           surface.answer == Answer::Refuted ? sticking_out(*made_.surface) : surface.reason);
      if (surface.answer == Answer::Refuted && run_.outer())
        say("note" + remedy().replace(0, 1, ":"));
    }
    if (decided.nested) look("the nesting in the level before", *decided.nested, "");
    look("a distance", decided.original_to_result, "");
    look("a distance", decided.result_to_original, "");
    if (code == kDone) say("verified from the written bytes");
    return code;
  }

  const DecimationCase& run_;
  const MeshCertificate& made_;
  std::string file_;
};

}  // namespace

std::string formatted(double x) {
  std::ostringstream s;
  s << std::setprecision(4) << x;
  return s.str();
}

bool say_shortage(const DecimationCase& run, const certify::Float32Shortage& shortage) {
  const std::string why = reason_of(shortage);
  if (run.request().may_be_double()) {
    log(run.asked.common.quiet, "note: " + why + ": writing double");
    return true;
  }
  log(false,
      "bmesh-decimate: " + run.asked.input + ": " + why +
          "; nothing is written. Write .ply, .obj, .off or (--output-format) stl-ascii, "
          "which hold doubles" +
          (run.asked.value("precision") == "auto" ? "" : ", with --precision double") + "; or " +
          remedy_of(shortage) +
          (run.made.why_not_wrapped.empty() ? ""
                                            : ". Nor is it wrapped: " + run.made.why_not_wrapped));
  return false;
}

std::string summary_of(const DecimationCase& run, std::size_t place) {
  return Lines(run, place).summary();
}

int conclude(const DecimationCase& run) {
  bool no = false, limit = false;
  for (std::size_t i = 0; i < run.series().meshes.size(); ++i) {
    const int code = Lines(run, i).conclude();
    no = no || code == kNo;
    limit = limit || code == kLimit;
  }
  return no ? kNo : limit ? kLimit : kDone;
}

}  // namespace kaboum::tools
