#pragma once

#include <string>

namespace kaboum::tools {

/// A word of a command, quoted where the shell would read it otherwise.
std::string shell_word(const std::string& word);

}  // namespace kaboum::tools
