#pragma once

#include <kaboum/io/mesh_io.h>

#include <string>
#include <vector>

namespace kaboum::io::test {

struct Sample {
  std::string name;
  Format format;
  std::string bytes;
};

/// Small valid files of every format that does not need assimp, with as many features as fit.
std::vector<Sample> samples();

}  // namespace kaboum::io::test
