#pragma once

#include <string>

namespace kaboum::tools {

/// A word of a command, quoted where the shell would read it otherwise.
std::string shell_word(const std::string& word);

/// A file so that it is no option, either: "-a.off" as "./-a.off".
std::string shell_file(const std::string& path);

}  // namespace kaboum::tools
