#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum {

/// The known name that was probably meant by one that is not known. It is the first of those with
/// the fewest insertions, deletions and replacements of one character; there may be at most two,
/// and fewer than half the name's characters. Before these come names that begin with it (of more
/// than three characters). Letters count as equal whatever their case.
std::optional<std::string> similar_name(std::string_view name,
                                        const std::vector<std::string>& known);

/// "; did you mean 'NAME'?" where there is a similar name, else empty.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known);

}  // namespace kaboum
