// Files that say which pairs of links are not checked: what they state, judged and corrected.

#include "matrix.h"

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/base/xml_text.h>

#include <algorithm>
#include <map>
#include <set>

namespace kaboum::pairs {
namespace detail {

int line_at(const std::string& text, std::size_t place) {
  return 1 + static_cast<int>(
                 std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n'));
}

Stretch with_line(const std::string& text, Stretch stretch) {
  std::size_t begin = stretch.begin, end = stretch.end;
  while (begin > 0 && (text[begin - 1] == ' ' || text[begin - 1] == '\t')) --begin;
  while (end < text.size() && (text[end] == ' ' || text[end] == '\t' || text[end] == '\r')) ++end;
  const bool begins = begin == 0 || text[begin - 1] == '\n';
  const bool ends = end == text.size() || text[end] == '\n';
  if (!begins || !ends) return stretch;
  return {begin, std::min(text.size(), end + 1)};
}

}  // namespace detail

namespace {

using Pair = std::pair<std::string, std::string>;

Pair sorted(const std::string& a, const std::string& b) { return a < b ? Pair(a, b) : Pair(b, a); }

/// Of adjacent links a contact at the joint neither proves nor refutes anything.
Judgement judgement_of(const DecidedPair& pair) {
  if (pair.verdict == Verdict::Never) return Judgement::Proved;
  if (is_connected(pair)) return Judgement::Connected;
  if (pair.relation == Relation::Adjacent && !pair.away) return Judgement::Open;
  switch (pair.relation == Relation::Adjacent ? pair.away->verdict : pair.verdict) {
    case Verdict::Always:
      return Judgement::Always;
    case Verdict::CanTouch:
      return Judgement::Refuted;
    default:
      return Judgement::Open;
  }
}

std::string why_open(const DecidedPair& pair) {
  if (pair.relation != Relation::Adjacent || pair.verdict == Verdict::Open) return {};
  return pair.away ? "one joint connects them, and it is not known whether they touch away from it"
                   : "one joint connects them, and contacts at it are not told from others";
}

std::string quoted(const Pair& pair) { return "'" + pair.first + "', '" + pair.second + "'"; }

}  // namespace

const char* name_of(MatrixFormat format) {
  switch (format) {
    case MatrixFormat::Mjcf:
      return "MJCF";
    case MatrixFormat::Drake:
      return "Drake's filter groups";
    case MatrixFormat::Xrdf:
      return "XRDF";
    case MatrixFormat::Curobo:
      return "cuRobo's YAML";
    default:
      return "SRDF";
  }
}

const char* name_of(MatrixFault::Kind kind) {
  switch (kind) {
    case MatrixFault::Kind::UnknownLink:
      return "unknown-link";
    case MatrixFault::Kind::SameLink:
      return "same-link";
    case MatrixFault::Kind::Doubled:
      return "doubled";
    case MatrixFault::Kind::Contradicting:
      return "contradicting";
    default:
      return "empty-group";
  }
}

const char* name_of(Judgement judgement) {
  switch (judgement) {
    case Judgement::Proved:
      return "proved";
    case Judgement::Connected:
      return "connected";
    case Judgement::Always:
      return "always";
    case Judgement::Refuted:
      return "refuted";
    default:
      return "open";
  }
}

Matrix parse_matrix(const std::string& text, const std::string& name, const robot::Robot& robot) {
  std::vector<std::string> links;
  for (const robot::Link& link : robot.links) links.push_back(link.name);
  const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  const bool is_xml = first != std::string::npos && text[first] == '<';
  detail::ReadMatrix read =
      is_xml ? detail::read_xml(text, name, links) : detail::read_yaml(text, name);

  using Kind = MatrixFault::Kind;
  Matrix out{read.format, text, {}, std::move(read.faults), read.end_of_statements};
  const auto fault = [&](Kind kind, const std::string& what, int line) {
    out.faults.push_back({kind, what, line});
  };
  const auto idle = [&](const DisabledPair& pair) {
    out.idle.insert(out.idle.end(), pair.statements.begin(), pair.statements.end());
  };
  std::set<std::string> unknown;
  std::map<Pair, const detail::StatedPair*> disabled, enabled;
  for (const detail::StatedPair& stated : read.pairs) {
    const DisabledPair& pair = stated.pair;
    bool known = true;
    for (const std::string& link : {pair.a, pair.b}) {
      if (robot.find_link(link)) continue;
      known = false;
      if (!unknown.insert(link).second) continue;
      std::string what = "the robot has no link '" + link + "'";
      if (const auto similar = similar_name(link, links)) what += "; is '" + *similar + "' meant?";
      fault(Kind::UnknownLink, what, pair.line);
    }
    if (!known || pair.a == pair.b) idle(pair);
    if (!known) continue;
    if (pair.a == pair.b) {
      if (!stated.expanded)
        fault(Kind::SameLink, "link '" + pair.a + "' is paired with itself", pair.line);
      continue;
    }
    auto& side = stated.enabled ? enabled : disabled;
    const Pair key = sorted(pair.a, pair.b);
    const auto [at, is_new] = side.emplace(key, &stated);
    if (is_new) continue;
    const detail::StatedPair& before = *at->second;
    if (stated.expanded || before.expanded) {
      if (before.expanded && !stated.expanded) at->second = &stated;
      continue;
    }
    idle(pair);
    const bool differs = before.pair.reason != pair.reason;
    fault(differs ? Kind::Contradicting : Kind::Doubled,
          "the pair " + quoted(key) + " is stated in line " + std::to_string(before.pair.line) +
              (differs
                   ? " for the reason '" + before.pair.reason + "', here for '" + pair.reason + "'"
                   : " already"),
          pair.line);
  }
  for (const detail::StatedPair& stated : read.pairs) {
    const Pair key = sorted(stated.pair.a, stated.pair.b);
    const auto at = disabled.find(key);
    if (stated.enabled || at == disabled.end() || at->second != &stated) continue;
    const auto on = enabled.find(key);
    DisabledPair pair = stated.pair;
    pair.statements.clear();
    for (const detail::StatedPair& other : read.pairs) {
      if (other.enabled || sorted(other.pair.a, other.pair.b) != key) continue;
      pair.statements.insert(pair.statements.end(), other.pair.statements.begin(),
                             other.pair.statements.end());
      pair.grouped = pair.grouped || (other.expanded && on == enabled.end());
    }
    if (on == enabled.end()) {
      out.pairs.push_back(std::move(pair));
    } else if (!stated.expanded) {
      fault(Kind::Contradicting,
            "the pair " + quoted(key) + " is disabled here, and enabled in line " +
                std::to_string(on->second->pair.line),
            stated.pair.line);
      out.pairs.push_back(std::move(pair));
    }
  }
  std::ranges::stable_sort(out.faults, {}, &MatrixFault::line);
  return out;
}

void require_own(const Matrix& matrix, const std::string& name, const robot::Robot& robot) {
  if (!matrix.pairs.empty() || matrix.faults.empty()) return;
  const MatrixFault& first = matrix.faults.front();
  throw Error(ErrorCode::InvalidInput, name + ":" + std::to_string(first.line) +
                                           ": none of its pairs is one of links of robot '" +
                                           robot.name + "': are they another robot's? (" +
                                           first.text + ")");
}

std::vector<JudgedPair> judge(const Matrix& matrix, const robot::Robot& robot,
                              const std::vector<DecidedPair>& decided) {
  std::map<Pair, const DecidedPair*> found;
  for (const DecidedPair& pair : decided)
    found.emplace(sorted(robot.links[pair.a].name, robot.links[pair.b].name), &pair);
  std::vector<JudgedPair> out;
  for (const DisabledPair& stated : matrix.pairs) {
    JudgedPair judged{stated, Judgement::Open, std::nullopt};
    for (const std::string& name : {stated.a, stated.b}) {
      const robot::Link& link = robot.links[robot.find_link(name).value()];
      judged.why = "link '" + name + "' has no shapes";
      if (link.collision.empty() && link.visual.empty() && link.unread.empty()) {
        judged.judgement = Judgement::Proved;
        break;
      }
      judged.why = "shapes of a link are not looked at, be they for drawing only";
    }
    if (const auto at = found.find(sorted(stated.a, stated.b)); at != found.end()) {
      const DecidedPair& pair = *at->second;
      judged.found = pair;
      judged.why = pair.why;
      judged.judgement = judgement_of(pair);
      if (judged.judgement == Judgement::Refuted)
        judged.q = pair.relation == Relation::Adjacent ? pair.away->q : pair.q;
      if (judged.judgement == Judgement::Open && judged.why.empty()) judged.why = why_open(pair);
    }
    out.push_back(std::move(judged));
  }
  return out;
}

namespace {

/// A text without stretches of it, with some other text put in before.
std::string without(const std::string& text, std::vector<Stretch> gone, const std::string& added,
                    std::size_t place) {
  // From the end on; what is inside of another stretch is gone with it.
  std::ranges::sort(gone, [](const Stretch& x, const Stretch& y) {
    return x.begin != y.begin ? x.begin > y.begin : x.end > y.end;
  });
  std::string out = text;
  if (!added.empty()) out.insert(place, added);
  std::size_t next = std::string::npos;
  for (const Stretch& stretch : gone) {
    if (stretch.begin >= next) continue;
    const std::size_t end = std::min(stretch.end, next);
    out.erase(stretch.begin, end - stretch.begin);
    next = stretch.begin;
  }
  return out;
}

/// Whether a text disables just these pairs.
bool disables(const std::string& text, const std::set<Pair>& pairs, const robot::Robot& robot) {
  std::set<Pair> left;
  try {
    for (const DisabledPair& pair : parse_matrix(text, "the corrected file", robot).pairs)
      left.insert(sorted(pair.a, pair.b));
  } catch (const Error&) {
    return false;
  }
  return left == pairs;
}

}  // namespace

std::string corrected(const Matrix& matrix, const std::vector<JudgedPair>& judged,
                      const robot::Robot& robot) {
  std::vector<Stretch> gone;
  std::string enabled;
  std::set<Pair> kept;
  for (const JudgedPair& pair : judged) {
    if (pair.judgement != Judgement::Refuted) {
      kept.insert(sorted(pair.stated.a, pair.stated.b));
      continue;
    }
    gone.insert(gone.end(), pair.stated.statements.begin(), pair.stated.statements.end());
    if (!pair.stated.grouped) continue;
    if (!matrix.end_of_statements)
      throw Error(ErrorCode::InvalidArgument,
                  "line " + std::to_string(pair.stated.line) + " disables " +
                      quoted({pair.stated.a, pair.stated.b}) + " together with other pairs, and " +
                      name_of(matrix.format) +
                      " cannot state an exception: change the groups by hand");
    enabled += "  <enable_collisions link1=\"" + escape_xml(pair.stated.a) + "\" link2=\"" +
               escape_xml(pair.stated.b) + "\"/>\n";
  }
  const std::size_t place = matrix.end_of_statements.value_or(0);
  std::vector<Stretch> all = gone;
  all.insert(all.end(), matrix.idle.begin(), matrix.idle.end());
  for (const std::vector<Stretch>& stretches : {all, gone}) {
    std::string out = without(matrix.text, stretches, enabled, place);
    if (disables(out, kept, robot)) return out;
  }
  throw Error(ErrorCode::InvalidArgument,
              "the refuted pairs cannot be taken out without others: change the file by hand");
}

}  // namespace kaboum::pairs
