#pragma once

#include <kaboum/pairs/matrix.h>

#include <functional>
#include <string>
#include <vector>

namespace kaboum::pairs::detail {

/// A pair as a file states it, before it is looked at.
struct StatedPair {
  DisabledPair pair;
  bool enabled = false;   ///< stated to be checked
  bool expanded = false;  ///< of a statement about more pairs: said twice, it is no fault
};

struct ReadMatrix {
  std::vector<StatedPair> pairs;
  std::vector<MatrixFault> faults;
  MatrixFormat format = MatrixFormat::Srdf;
  std::optional<std::size_t> end_of_statements;
};

/// @param links  names of the robot's links
ReadMatrix read_xml(const std::string& text, const std::string& name,
                    const std::vector<std::string>& links);
ReadMatrix read_yaml(const std::string& text, const std::string& name);

/// A stretch with the whole line that it is alone on, its end included.
Stretch with_line(const std::string& text, Stretch stretch);
int line_at(const std::string& text, std::size_t place);

}  // namespace kaboum::pairs::detail
