#pragma once

#include <string>
#include <utility>
#include <vector>

namespace kaboum::io::test {

/// A zip archive of these parts (name, bytes), compressed.
std::string package(const std::vector<std::pair<std::string, std::string>>& parts);

inline const std::string kCoreSpace =
    R"(xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02")";
inline const std::string kProductionSpace =
    R"(xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06")";

/// A package whose relationship leads to 3D/3dmodel.model, which holds `model`.
std::string three_mf(const std::string& model,
                     std::vector<std::pair<std::string, std::string>> more = {});

/// A tetrahedron from `x` to x + 1 as <mesh>.
std::string three_mf_mesh(const std::string& x);

/// A model with a component, transforms and a second object.
std::string three_mf_model();

}  // namespace kaboum::io::test
