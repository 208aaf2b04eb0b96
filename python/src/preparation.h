#pragma once

#include <kaboum/certify/preparation_options.h>

#include <vector>

namespace kaboum::python {

/// The options of a preparation that wraps nothing: drop-sheets, holes, keep-orientation.
std::vector<Option<certify::PreparationOptions>> repair_options();

}  // namespace kaboum::python
