// The tables of options, for the typed stub, the reference page and tests of both.

#include <kaboum/certify/mesh_options.h>
#include <kaboum/certify/set_options.h>
#include <kaboum/certify/sweep_options.h>

#include "request_options.h"
#include "robot.h"

namespace kaboum::python {

void bind_option_tables(py::module_& module) {
  module.def(
      "_option_tables",
      [] {
        py::dict out;
        out["decimate"] = table_of(keywords_of(certify::mesh_options()));
        out["decompose"] = table_of(keywords_of(certify::set_options()));
        out["decimate_robot"] = table_of(keywords_of(link_mesh_options()));
        out["certify_robot"] = table_of(keywords_of(link_options()));
        out["sweep"] = table_of(keywords_of(certify::swept_set_options()));
        return out;
      },
      "By function, its options as the library describes them: a list of dicts.");
}

}  // namespace kaboum::python
