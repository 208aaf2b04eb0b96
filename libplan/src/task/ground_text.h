#pragma once

#include <kaboum/plan/model.h>

#include <string>
#include <vector>

namespace kaboum::plan {

/// "p(a, b)", for messages.
inline std::string ground_text(const Model& model, const std::string& name,
                               const std::vector<Index>& arguments) {
  std::string text;
  for (const Index o : arguments) text += (text.empty() ? "" : ", ") + model.objects[o].name;
  return arguments.empty() ? name : name + "(" + text + ")";
}

}  // namespace kaboum::plan
