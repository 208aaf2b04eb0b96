// The cache's folder: what is found is what was stored; the longest unused goes first; many
// writers, readers and prunes at the same time; writers that are killed.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/certify/cache_folder.h>
#include <kaboum/io/mesh_io.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "support/temporary_folder.h"

namespace kaboum::certify {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr const char* kKind = "KABOUM-TEST 1";

std::string key_of(std::size_t i) { return io::sha256(std::to_string(i)); }

/// Content that tells its key, so that one of another key is seen.
std::string content_of(std::size_t i, std::size_t size = 1000) {
  std::string text = std::to_string(i) + " ";
  while (text.size() < size) text += key_of(i);
  return text.substr(0, size);
}

class CacheFolderTest : public ::testing::Test {
 protected:
  void TearDown() override { unsetenv("KABOUM_CACHE_SIZE"); }

  fs::path path_of(std::size_t i) const { return folder_ / (key_of(i) + ".set"); }

  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path() / "cache";  // made when it is needed
  std::string flaw_;
};

TEST_F(CacheFolderTest, FindsWhatWasStored) {
  const CacheFolder cache(folder_);
  EXPECT_FALSE(cache.find(kKind, key_of(1), flaw_));
  EXPECT_TRUE(cache.entries().empty());
  for (const std::string& content :
       {std::string(), std::string("a\nb\0c", 5), content_of(1, 100000)}) {
    cache.store(kKind, key_of(1), content);
    EXPECT_EQ(cache.find(kKind, key_of(1), flaw_), content);
    EXPECT_TRUE(flaw_.empty());
  }
  EXPECT_FALSE(cache.find("KABOUM-TEST 2", key_of(1), flaw_));
  EXPECT_NE(flaw_.find("another version"), std::string::npos);
  const CacheFolder none{fs::path()};
  none.store(kKind, key_of(1), "x");
  EXPECT_FALSE(none.find(kKind, key_of(1), flaw_));
  EXPECT_TRUE(none.entries().empty());
}

TEST_F(CacheFolderTest, NoDamagedByteIsUsed) {
  const CacheFolder cache(folder_);
  cache.store(kKind, key_of(1), content_of(1, 40));
  std::ifstream in(path_of(1), std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  const auto refused = [&](const std::string& bytes, const std::string& what) {
    std::ofstream(path_of(1), std::ios::binary | std::ios::trunc) << bytes;
    EXPECT_FALSE(cache.find(kKind, key_of(1), flaw_)) << what;
    EXPECT_FALSE(flaw_.empty()) << what;
    ASSERT_EQ(cache.entries().size(), 1U);
    EXPECT_FALSE(CacheFolder::flaw_of(cache.entries()[0]).empty()) << what;
  };
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    std::ofstream(path_of(1), std::ios::binary | std::ios::trunc) << damaged;
    EXPECT_FALSE(cache.find(kKind, key_of(1), flaw_)) << at;
    EXPECT_FALSE(flaw_.empty()) << at;
  }
  for (std::size_t size = 0; size < whole.size(); ++size)
    refused(whole.substr(0, size), "the first " + std::to_string(size) + " bytes");
  fs::copy_file(path_of(1), path_of(2));
  std::ofstream(path_of(2), std::ios::binary | std::ios::trunc) << whole;
  EXPECT_FALSE(cache.find(kKind, key_of(2), flaw_));
  EXPECT_NE(flaw_.find("another input"), std::string::npos);
}

TEST_F(CacheFolderTest, WhatWasNotUsedForLongestGoesFirst) {
  const CacheFolder cache(folder_);
  for (std::size_t i = 0; i < 10; ++i) {
    cache.store(kKind, key_of(i), content_of(i));
    fs::last_write_time(path_of(i), fs::file_time_type::clock::now() - std::chrono::hours(20 - i));
  }
  ASSERT_TRUE(cache.find(kKind, key_of(0), flaw_));  // used now
  std::ofstream(folder_ / "notes.set") << "not an entry";
  std::ofstream(folder_ / "readme.txt") << "nor this";
  const std::uintmax_t size = cache.entries()[0].bytes;
  const auto removed = cache.prune(4 * size + size / 2);
  ASSERT_EQ(removed.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(removed[i].path, path_of(i + 1));
  for (const std::size_t i : {std::size_t{0}, std::size_t{7}, std::size_t{9}})
    EXPECT_EQ(cache.find(kKind, key_of(i), flaw_), content_of(i));
  EXPECT_TRUE(fs::exists(folder_ / "notes.set") && fs::exists(folder_ / "readme.txt"));
  EXPECT_TRUE(cache.prune(4 * size).empty());
  EXPECT_EQ(cache.prune(0).size(), 4U);
}

TEST_F(CacheFolderTest, StaysNearItsLimitByItself) {
  setenv("KABOUM_CACHE_SIZE", "100K", 1);
  EXPECT_EQ(CacheFolder::size_limit(), 102400U);
  const CacheFolder cache(folder_);
  const auto sum = [&] {
    std::uintmax_t bytes = 0;
    for (const CacheFolder::Entry& entry : cache.entries()) bytes += entry.bytes;
    return bytes;
  };
  const auto key = [](std::size_t i, const char* end) { return key_of(i).substr(0, 62) + end; };
  for (std::size_t i = 0; i < 120; ++i) cache.store(kKind, key(i, "ff"), content_of(i));
  EXPECT_GT(sum(), 102400U);
  cache.store(kKind, key(200, "30"), content_of(200));  // one of the 64th part that makes room
  EXPECT_LE(sum(), 102400U);
  EXPECT_TRUE(cache.find(kKind, key(200, "30"), flaw_));
  EXPECT_FALSE(cache.find(kKind, key(0, "ff"), flaw_));
  for (const char* wrong : {"many", "5X", "-1", "99999999999T"}) {
    setenv("KABOUM_CACHE_SIZE", wrong, 1);
    EXPECT_THROW(CacheFolder::size_limit(), Error) << wrong;
  }
}

TEST_F(CacheFolderTest, ThreadsReadWriteAndPruneAtTheSameTime) {
  const CacheFolder cache(folder_);
  std::atomic<std::size_t> found{0}, wrong{0};
  const auto work = [&](std::size_t seed) {
    for (std::size_t n = 0; n < 300; ++n) {
      const std::size_t i = (n * 7 + seed * 3) % 20;
      std::string flaw;
      if (const auto content = cache.find(kKind, key_of(i), flaw)) {
        ++found;
        if (*content != content_of(i)) ++wrong;
      } else {
        cache.store(kKind, key_of(i), content_of(i));
      }
      if (!flaw.empty()) ++wrong;
      if (n % 50 == seed) cache.prune(8 * 1200);
    }
  };
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t) threads.emplace_back(work, t);
  for (std::thread& thread : threads) thread.join();
  EXPECT_GT(found, 100U);
  EXPECT_EQ(wrong, 0U);
}

TEST_F(CacheFolderTest, WritersThatAreKilledLeaveNothingThatIsUsed) {
  const CacheFolder cache(folder_);
  for (int round = 0; round < 20; ++round) {
    const pid_t writer = fork();
    ASSERT_GE(writer, 0);
    if (writer == 0) {
      for (std::size_t i = 0;; ++i) cache.store(kKind, key_of(i % 50), content_of(i % 50, 200000));
    }
    // A busy machine may take its time until the writer writes at all.
    while (cache.entries().empty()) std::this_thread::sleep_for(1ms);
    std::this_thread::sleep_for(std::chrono::milliseconds(3 + round));
    kill(writer, SIGKILL);
    waitpid(writer, nullptr, 0);
    for (const CacheFolder::Entry& entry : cache.entries())
      EXPECT_EQ(CacheFolder::flaw_of(entry), "") << entry.path;
  }
  EXPECT_FALSE(cache.entries().empty());
  // What they left is removed when it is old.
  const fs::path left = folder_ / ".kaboum-1-1.tmp";
  std::ofstream(left) << "half";
  cache.prune(UINTMAX_MAX);
  EXPECT_TRUE(fs::exists(left));
  fs::last_write_time(left, fs::file_time_type::clock::now() - 2h);
  cache.prune(UINTMAX_MAX);
  EXPECT_FALSE(fs::exists(left));
}

}  // namespace
}  // namespace kaboum::certify
