#include "verdict.h"

#include <iomanip>
#include <sstream>

#include "cli.h"

namespace kaboum::tools {

using verify::Answer;

std::string number(double x) {
  std::ostringstream text;
  text << std::setprecision(6) << x;
  return text.str();
}

std::string point(const geom::Vec3& p) {
  std::ostringstream text;
  text << std::setprecision(17) << '(' << p.x() << ", " << p.y() << ", " << p.z() << ')';
  return text.str();
}

Answer worse(Answer a, Answer b) {
  for (const Answer x : {Answer::Refuted, Answer::Undecided, Answer::Undefined})
    if (a == x || b == x) return x;
  return Answer::Verified;
}

int exit_code(Answer answer) {
  switch (answer) {
    case Answer::Verified:
      return kDone;
    case Answer::Refuted:
      return kNo;
    case Answer::Undecided:
      return kLimit;
    case Answer::Undefined:
      break;
  }
  return kBadInput;
}

}  // namespace kaboum::tools
