// SHA-256: published examples, lengths about the block's, and both ways of computing it.

#include <gtest/gtest.h>
#include <kaboum/base/sha256.h>

#include <cstddef>
#include <string>
#include <vector>

#include "sha256_blocks.h"

namespace kaboum {
namespace {

std::string of(const std::string& text) { return sha256({text.data(), text.size()}); }

// FIPS 180-2, appendix B, and NIST's examples.
TEST(Sha256, GivesThePublishedValues) {
  EXPECT_EQ(of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(of(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

// sha256sum's values of so many letters a.
TEST(Sha256, PadsToWholeBlocks) {
  EXPECT_EQ(of(std::string(55, 'a')),
            "9f4390f8d30c2dd92ec9f095b65e2b9ae9b0a925a5258e241c9f1e910f734318");
  EXPECT_EQ(of(std::string(56, 'a')),
            "b35439a4ac6f0948b6d6f9e3c6af0f5f590ce20f1bde7090ef7970686ec6738a");
  EXPECT_EQ(of(std::string(63, 'a')),
            "7d3e74a05d7db15bce4ad9ec0658ea98e3f06eeecf16b4c6fff2da457ddc2f34");
  EXPECT_EQ(of(std::string(64, 'a')),
            "ffe054fe7ae0cb6dc65c3af9b61d5209f439851db43d0ba5997337df154668eb");
}

TEST(Sha256, IsTheSameOnEveryProcessor) {
  if (!detail::has_sha256_instructions()) GTEST_SKIP() << "no instructions for it";
  std::vector<char> bytes(50 * detail::kSha256Block);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * i / 7);
  detail::Sha256State one{1, 2, 3, 4, 5, 6, 7, 0xffffffff}, other = one;
  detail::sha256_by_processor(one, bytes.data(), 50);
  detail::sha256_portable(other, bytes.data(), 50);
  EXPECT_EQ(one, other);
}

}  // namespace
}  // namespace kaboum
