#include <kaboum/base/sha256.h>
#include <kaboum/io/mesh_io.h>

namespace kaboum::io {

std::string sha256(std::span<const char> bytes) { return kaboum::sha256(bytes); }

}  // namespace kaboum::io
