#pragma once

#include <kaboum/verify/inclusion.h>

#include <optional>
#include <string>
#include <vector>

namespace kaboum::certify {

/// Evidence behind an answer.
enum class Basis {
  Bytes,     ///< decided by libverify from the bytes
  Meshes,    ///< decided by libverify from the meshes
  Steps,     ///< every step passed exact tests, or was made by a proof: docs/algorithms/
  Measured,  ///< a certified bracket of a distance
};

const char* name_of(Basis basis);

/// A statement about an artefact.
struct Claim {
  enum class Kind {
    Solid,             ///< outer: the artefact's solid, or union, holds the subject's solid; inner:
                       ///< the other way round
    Winding,           ///< of open meshes: the winding number nowhere falls (inner: rises)
    Surface,           ///< every triangle of the enclosed one lies in the other one's solid
    Nested,            ///< as Solid, about the finer results of a series
    OriginalToResult,  ///< no point of the original is farther from the result than `distance`
    ResultToOriginal,  ///< the other way round
    Convex,            ///< every body is convex
    Motion,            ///< at every configuration of the path, the robot's bodies are in the set
    Depth,             ///< no point of the solid that inner bodies leave out is deeper in it
  };
  Kind kind = Kind::Solid;
  Basis basis = Basis::Steps;
  verify::Answer answer = verify::Answer::Undefined;
  std::string reason = {};              ///< of what is not verified
  std::optional<double> distance = {};  ///< the bound, of claims about distances [length]
};

const char* name_of(Claim::Kind kind);

/// Certificate in the shape that all artefacts share: what is claimed, of what, and how far they
/// are apart. `certificate_of` a certified artefact makes it.
struct Certificate {
  /// Any: the artefact is near the subject, on both sides of it.
  enum class Direction { Outer, Inner, Any } direction = Direction::Outer;
  /// What the artefact holds, lies in or is near to, in words: "the input", and how it was changed.
  std::string subject;
  std::vector<Claim> claims;
  /// Largest distance of the artefact's points from the subject; of inner ones, the largest depth
  /// of what is left out. None: it was not measured. [length]
  struct Distance {
    double lower = 0, upper = 0;  ///< certified
  };
  std::optional<Distance> distance;

  /// True where something is claimed, and every claim that means something is verified.
  [[nodiscard]] bool holds() const;
};

/// As in reports: a JSON object with `direction`, `of`, `claims` and `distance`.
std::string to_json(const Certificate& certificate);

}  // namespace kaboum::certify
