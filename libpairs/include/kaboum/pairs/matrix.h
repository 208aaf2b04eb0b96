#pragma once

#include <kaboum/pairs/decide.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// Matrices of allowed collisions: files that say which pairs of links are not checked.
namespace kaboum::pairs {

enum class MatrixFormat {
  Srdf,    ///< MoveIt's: disable_collisions, disable_default_collisions, enable_collisions
  Mjcf,    ///< MuJoCo's: exclude
  Drake,   ///< drake:collision_filter_group of URDF and SDF
  Xrdf,    ///< self_collision: ignore
  Curobo,  ///< self_collision_ignore
};
/// "SRDF", "MJCF", "Drake's filter groups", "XRDF", "cuRobo's YAML".
const char* name_of(MatrixFormat format);

/// A stretch of the file's text.
struct Stretch {
  std::size_t begin = 0, end = 0;
};

/// That a pair is not checked.
struct DisabledPair {
  std::string a, b;    ///< names of links, as the file has them
  std::string reason;  ///< as the file has it; empty: it has none
  int line = 0;
  /// What to take out of the file so that the pair is checked: all that states it by itself.
  std::vector<Stretch> statements = {};
  bool grouped = false;  ///< a statement about more pairs disables it as well
};

/// What is wrong with a file, whatever the robot does.
struct MatrixFault {
  enum class Kind {
    UnknownLink,
    SameLink,       ///< a pair of a link with itself
    Doubled,        ///< a pair is stated twice
    Contradicting,  ///< for two reasons, or both disabled and enabled
    EmptyGroup,     ///< a group without members, or that is not there
  };
  Kind kind;
  std::string text;  ///< a sentence without its full stop
  int line = 0;
};
/// "unknown-link", "same-link", "doubled", "contradicting", "empty-group".
const char* name_of(MatrixFault::Kind kind);

struct Matrix {
  MatrixFormat format = MatrixFormat::Srdf;
  std::string text;
  std::vector<DisabledPair> pairs;  ///< of links that the robot has, each once, in the file's order
  std::vector<MatrixFault> faults;  ///< by line
  /// Where enabled pairs may be written; of formats that have a word for it.
  std::optional<std::size_t> end_of_statements;
  /// Statements that change nothing: of links that the robot does not have, of a link with itself,
  /// and of a pair that is stated before.
  std::vector<Stretch> idle = {};
};

/// Reads a file of any of the formats; which one is seen from its text.
/// @param name  of the file, for messages
/// @throws Error{InvalidInput} naming the line: not well-formed, or none of the formats
Matrix parse_matrix(const std::string& text, const std::string& name, const robot::Robot& robot);

/// Refuses a matrix that states pairs, none of which is of the robot's links: another robot's.
/// @param name  of the file, for messages
/// @throws Error{InvalidInput} naming file, line and the first fault
void require_own(const Matrix& matrix, const std::string& name, const robot::Robot& robot);

/// What was found about a pair that a file disables.
enum class Judgement {
  Proved,  ///< it never touches, or one link has no shapes of any kind
  /// Fixed joints connect the links, or one joint does, away from which they never touch: a contact
  /// says nothing.
  Connected,
  Always,   ///< they touch in every configuration, which a check could only repeat
  Refuted,  ///< a configuration shows a contact that is not looked for
  Open,
};
/// "proved", "connected", "always", "refuted", "open".
const char* name_of(Judgement judgement);

struct JudgedPair {
  DisabledPair stated;
  Judgement judgement = Judgement::Open;
  std::optional<DecidedPair> found;  ///< none: a link has no shapes, or they were not looked at
  std::vector<double> q = {};        ///< shows the contact of a refuted pair; as DecidedPair::q
  std::string why = {};  ///< of a pair that stays open or is proved without having been found
};

/// Of every pair of the matrix, by what was decided.
std::vector<JudgedPair> judge(const Matrix& matrix, const robot::Robot& robot,
                              const std::vector<DecidedPair>& decided);

/// The file's text without refuted pairs, and without statements that change nothing where these
/// can be taken out; all else of it, its comments and its order stay. It has been read again: it
/// disables none of the refuted pairs, and all others as before.
/// @throws Error{InvalidArgument} where a refuted pair is part of a statement about several, and
///   the format has no word for an exception; or where pairs cannot be told apart in the text
std::string corrected(const Matrix& matrix, const std::vector<JudgedPair>& judged,
                      const robot::Robot& robot);

}  // namespace kaboum::pairs
