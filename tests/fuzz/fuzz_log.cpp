// Any bytes given to parse_log either make a log that is written as these bytes and that the
// checker verifies or refutes, or throw Error.

#include <kaboum/verify/replay.h>

#include <algorithm>

#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kaboum;
  const geom::Mesh cube{
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}},
      {{0, 2, 1},
       {1, 2, 3},
       {4, 5, 6},
       {5, 7, 6},
       {0, 1, 4},
       {1, 5, 4},
       {2, 6, 3},
       {3, 6, 7},
       {0, 4, 2},
       {2, 4, 6},
       {1, 3, 5},
       {3, 7, 5}}};
  fuzz::survive([&] {
    const std::vector<char> bytes(data, data + size);
    const bmesh::Log log = bmesh::parse_log(bytes, "fuzz");
    if (bmesh::serialise_log(log) != bytes) fuzz::broken("a log", "is written as another one");
    verify::replay(cube, log, cube);
  });
  return 0;
}
