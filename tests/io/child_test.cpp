// Whatever a reader does in its child process, this process gets a mesh or an Error.

#include "child.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "io_test.h"

namespace kaboum::io::test {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMemoryLimited = false;
#else
constexpr bool kMemoryLimited = true;
#endif

const Source kSource{"some bytes", "sample", {}, true};
const ChildLimits kLimits{std::uint64_t{256} << 20U, 1};

ReadResult sample_result() {
  ReadResult r;
  r.mesh = tetrahedron();
  r.format = Format::Fbx;
  r.single_precision = true;
  r.file_vertices = 12;
  r.file_triangles = 5;
  r.split_polygons = 3;
  r.collapsed_triangles = 1;
  r.notes = {"one", "", std::string(100'000, 'x')};
  r.other_files = {"a file", "another"};
  return r;
}

/// The read fails with `code`, and the message names the file and holds `part`.
void expect_failure(const std::function<ReadResult()>& read, const std::string& part,
                    ErrorCode code = ErrorCode::InvalidInput) {
  try {
    read_in_child(kSource, kLimits, read);
    ADD_FAILURE() << "no error: " << part;
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), code);
    EXPECT_NE(std::string(e.what()).find("sample"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
  }
}

[[noreturn]] ReadResult die(int signal) {
  std::raise(signal);
  std::_Exit(0);
}

TEST(Child, ResultsAreTheSame) {
  const ReadResult r = read_in_child(kSource, kLimits, sample_result), s = sample_result();
  EXPECT_EQ(r.mesh.vertices, s.mesh.vertices);
  EXPECT_EQ(r.mesh.triangles, s.mesh.triangles);
  EXPECT_EQ(r.format, s.format);
  EXPECT_EQ(r.single_precision, s.single_precision);
  EXPECT_EQ(r.file_vertices, s.file_vertices);
  EXPECT_EQ(r.file_triangles, s.file_triangles);
  EXPECT_EQ(r.split_polygons, s.split_polygons);
  EXPECT_EQ(r.collapsed_triangles, s.collapsed_triangles);
  EXPECT_EQ(r.notes, s.notes);
  EXPECT_EQ(r.other_files, s.other_files);
}

TEST(Child, CrashesAreErrors) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL})
    expect_failure([&]() -> ReadResult { die(signal); }, "signal " + std::to_string(signal));
  expect_failure([]() -> ReadResult { die(SIGKILL); }, "stopped");
  expect_failure([]() -> ReadResult { std::_Exit(3); }, "broke down");
  expect_failure([]() -> ReadResult { std::_Exit(0); }, "broke down");
}

TEST(Child, ErrorsAndExceptionsPass) {
  expect_failure([]() -> ReadResult { throw Error(ErrorCode::LimitReached, "sample: too many"); },
                 "too many", ErrorCode::LimitReached);
  expect_failure([]() -> ReadResult { throw std::runtime_error("strange"); }, "strange");
  expect_failure([]() -> ReadResult { throw 3; }, "unknown exception");
}

TEST(Child, TimeAndMemoryAreLimited) {
  expect_failure(
      []() -> ReadResult {
        for (volatile unsigned i = 0;;) i = i + 1;
      },
      "CPU time");
  if (!kMemoryLimited) return;
  expect_failure(
      []() -> ReadResult {
        std::vector<std::vector<char>> hoard;
        for (;;)
          hoard.emplace_back().reserve(std::size_t{1}
                                       << 24U);  // pages that are touched take CPU time
      },
      "256 MiB");
}

TEST(Child, DamagedResultsAreRefused) {
  expect_failure(
      [] {
        ReadResult r = sample_result();
        r.mesh.triangles[1][2] = 4;
        return r;
      },
      "broke down");
  expect_failure(
      [] {
        ReadResult r = sample_result();
        r.mesh.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
        return r;
      },
      "broke down");
  expect_failure([] { return ReadResult{}; }, "broke down");
}

// The sanitizers' allocators, unlike glibc's, may be left locked in a child of several threads.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(Child, WorksBesideOtherThreads) {
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([] {
      for (int i = 0; i < 20; ++i) {
        std::vector<std::string> busy(100, std::string(100, 'x'));
        EXPECT_EQ(read_in_child(kSource, kLimits, sample_result).notes, sample_result().notes);
      }
    });
  }
  for (std::thread& t : threads) t.join();
}
#endif

}  // namespace
}  // namespace kaboum::io::test
