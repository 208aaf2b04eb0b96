// Runs a fuzz target without a fuzzer: on each file named, on each of its beginnings (of files up
// to 4096 bytes), and on mutations of it that are the same each time.

#include <cstdint>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kMutations = 300;

Bytes mutated(Bytes bytes, std::mt19937_64& random) {
  for (std::size_t n = 1 + random() % 3; n > 0 && !bytes.empty(); --n) {
    const auto at = static_cast<std::ptrdiff_t>(random() % bytes.size());
    const auto length = std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(random() % 12),
                                                 static_cast<std::ptrdiff_t>(bytes.size()) - at);
    switch (random() % 4) {
      case 0:
        bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1U << (random() % 8)));
        break;
      case 1:
        bytes[at] = static_cast<std::uint8_t>(random());
        break;
      case 2:
        bytes.erase(bytes.begin() + at, bytes.begin() + at + length);
        break;
      default: {
        const Bytes copy(bytes.begin() + at, bytes.begin() + at + length);
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(random() % bytes.size()),
                     copy.begin(), copy.end());
      }
    }
  }
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "usage: " << argv[0] << " SEED...\n";
    return 2;
  }
  std::mt19937_64 random(1);
  for (int i = 1; i < argc; ++i) {
    std::ifstream file(argv[i], std::ios::binary);
    const Bytes seed{std::istreambuf_iterator<char>(file), {}};
    if (!file || seed.empty()) {
      std::cerr << argv[i] << ": cannot be read, or is empty\n";
      return 1;
    }
    LLVMFuzzerTestOneInput(seed.data(), seed.size());
    for (std::size_t n = 0; n < seed.size() && seed.size() <= 4096; ++n) {
      const Bytes beginning(seed.begin(), seed.begin() + static_cast<std::ptrdiff_t>(n));
      LLVMFuzzerTestOneInput(beginning.data(), beginning.size());
    }
    for (int k = 0; k < kMutations; ++k) {
      const Bytes bytes = mutated(seed, random);
      LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    }
  }
}
