#pragma once

#include <filesystem>

namespace kaboum::test {

/// The folder of the mesh collection, which the environment variable KABOUM_MESHES names. For tests
/// of suites that begin with Corpus, which are run only where it is.
/// @throws std::runtime_error without it: a test of nothing must not pass.
std::filesystem::path corpus();

}  // namespace kaboum::test
