#pragma once

#include <Interface_InterfaceModel.hxx>

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

/// The faces that a CAD file states, counted from its entities, before anything is transferred.
namespace kaboum::io {

struct FaceUse {
  std::int64_t id = 0;    ///< STEP: the entity's #number; IGES: its number in the model
  std::string name;       ///< for messages
  double uses = 0;        ///< places of it in the product
  std::size_t edges = 0;  ///< that its bounds state
};

struct Census {
  std::vector<FaceUse> faces;
  std::unordered_set<std::int64_t> harmless;  ///< entities that hold no geometry themselves
};

/// @throws std::runtime_error naming the entity: unknown types, types that are not read, references
///   to nothing, faces and parts that no product reaches.
Census step_census(std::string text);

/// Numbers of an IGES file's parameters, from its text: OpenCASCADE takes those beyond 1e100 for
/// infinite.
///
/// @throws std::runtime_error naming the line and the number.
void check_iges_numbers(std::string_view text);

/// @throws std::runtime_error as step_census.
Census iges_census(const Handle(Interface_InterfaceModel) & model);

}  // namespace kaboum::io
