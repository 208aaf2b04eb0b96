#pragma once

#include <kaboum/certify/convex_set.h>

#include <memory>

#include "bindings.h"

/// Convex sets that Python holds.
namespace kaboum::python {

/// Shared and never changed. `certified` is where it was made here.
struct SetValue {
  std::shared_ptr<const geom::ConvexSet> set;
};

/// A set as decompose made it.
struct CertifiedSetValue {
  certify::CertifiedSet made;
  bool cached = false;
  std::vector<std::string> notes;
  std::string file = {};  ///< that the mesh was read from; empty: from none
  std::shared_ptr<const geom::Mesh> mesh = nullptr;  ///< that it is of
  geom::PrepareOptions preparation = {};             ///< of the mesh

  /// Keeps what it looks into.
  [[nodiscard]] std::shared_ptr<const geom::ConvexSet> set() const {
    auto kept = std::make_shared<certify::CertifiedSet>(made);
    return {kept, &kept->artefact()};
  }
};

/// A ConvexSet or a result that is one; the name of a file or folder; or a list of meshes, its
/// bodies. Null: it is none of these.
/// @throws as io::read_convex_set
std::shared_ptr<const geom::ConvexSet> set_of(const py::object& value);

py::list bodies_of(const std::shared_ptr<const geom::ConvexSet>& set);
py::dict record_of(const geom::Provenance& provenance);

/// Writes a set whose container has these bytes; in other formats as io::write_convex_set.
void write_set(const geom::ConvexSet& set, const std::vector<char>& bytes, const py::object& path);

}  // namespace kaboum::python
