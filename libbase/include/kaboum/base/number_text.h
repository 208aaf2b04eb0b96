#pragma once

#include <string>

namespace kaboum {

/// Six digits.
std::string number_text(double x);

/// Six digits, not above (not below) the number.
std::string number_down(double x);
std::string number_up(double x);

}  // namespace kaboum
