// The program xacro under limits.

#include "xacro.h"

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace kaboum::robot {
namespace {

namespace fs = std::filesystem;

class Xacro : public ::testing::Test {
 protected:
  Xacro() : folder_(fs::path(::testing::TempDir()) / ("xacro-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    before_ = std::getenv("PATH");
    ::setenv("PATH", (folder_.string() + ":" + before_).c_str(), 1);
  }
  ~Xacro() override {
    ::setenv("PATH", before_.c_str(), 1);
    fs::remove_all(folder_);
  }
  /// Makes the program, which is a script of this text.
  void program(const std::string& text) const {
    const fs::path file = folder_ / "xacro";
    std::ofstream(file) << text;
    fs::permissions(file, fs::perms::owner_all);
  }
  /// What is said where it fails.
  [[nodiscard]] static std::string refusal(const XacroLimits& limits) {
    try {
      expand_xacro("robot.xacro", {}, limits);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::InvalidInput);
      return e.what();
    }
    return {};
  }
  fs::path folder_;
  std::string before_;
};

double seconds_of(const auto& action) {
  const auto begin = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST_F(Xacro, GetsTheFileAndGivesItsOutput) {
  program("#!/bin/sh\necho \"<$1/>\"\necho words >&2\n");
  EXPECT_EQ(expand_xacro("a b/robot.xacro"), "<a b/robot.xacro/>\n");
}

TEST_F(Xacro, GetsArgumentsAfterTheFile) {
  program("#!/bin/sh\necho \"<$1|$2|$3/>\"\n");
  EXPECT_EQ(expand_xacro("robot.xacro", {"side:=left arm", "n:=2"}),
            "<robot.xacro|side:=left arm|n:=2/>\n");
  for (const char* argument : {"left", ":=left", "--deps", "--side:=left", ""})
    EXPECT_THROW(expand_xacro("robot.xacro", {argument}), Error) << argument;
}

TEST_F(Xacro, TakesNoPathForAnOptionOrArgument) {
  program("#!/bin/sh\necho \"<$1/>\"\n");
  EXPECT_EQ(expand_xacro("--help.xacro"), "<./--help.xacro/>\n");
  try {
    expand_xacro("side:=left/robot.xacro");
    FAIL() << "given to xacro as an argument";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("rename"), std::string::npos) << e.what();
  }
}

TEST_F(Xacro, SaysWhatItIncludes) {
  const std::string one = (folder_ / "one.xacro").string(),
                    two = (folder_ / "of two words.xacro").string();
  for (const std::string& file : {one, two}) std::ofstream(file) << "<robot/>";
  program("#!/bin/sh\n[ \"$1\" = --deps ] && printf '%s %s' '" + one + "' '" + two + "'\n");
  EXPECT_EQ(xacro_includes("robot.xacro"), (std::vector<std::string>{two, one}));
  program("#!/bin/sh\n[ \"$1\" = --deps ]\n");
  EXPECT_TRUE(xacro_includes("robot.xacro").empty());
  program("#!/bin/sh\nprintf '%s /absent/file.xacro' '" + one + "'\n");
  EXPECT_THROW(xacro_includes("robot.xacro"), Error);
}

TEST_F(Xacro, MayWriteMoreThanAPipeHolds) {
  program("#!/bin/sh\nhead -c 3000000 /dev/zero >&2\nhead -c 5000000 /dev/zero\n");
  EXPECT_EQ(expand_xacro("robot.xacro").size(), 5'000'000U);
}

TEST_F(Xacro, IsEndedWhenItWaits) {
  program("#!/bin/sh\nsleep 100 &\nwait\n");
  const double took = seconds_of(
      [] { EXPECT_NE(refusal({.seconds = 1}).find("more than 2 s"), std::string::npos); });
  EXPECT_LT(took, 20);
}

TEST_F(Xacro, IsEndedWhenItClosesItsOutputAndWaits) {
  program("#!/bin/sh\nexec >/dev/null 2>/dev/null\nsleep 100\n");
  EXPECT_NE(refusal({.seconds = 1}).find("more than 2 s"), std::string::npos);
}

TEST_F(Xacro, IsEndedWhenItComputes) {
  program("#!/bin/sh\nwhile :; do :; done\n");
  const std::string said = refusal({.seconds = 1});
  EXPECT_TRUE(said.find("limit of time") != std::string::npos ||
              said.find("more than 2 s") != std::string::npos)  // on a busy machine
      << said;
}

TEST_F(Xacro, HasItsMemoryLimited) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers take all addresses";
#endif
  program("#!/usr/bin/env python3\nprint('x' * 10)\ny = b'x' * (1 << 30)\n");
  EXPECT_NE(refusal({.memory = std::uint64_t{512} << 20U}).find("xacro fails"), std::string::npos);
}

TEST_F(Xacro, HasItsOutputLimited) {
  program("#!/bin/sh\nexec yes\n");
  EXPECT_NE(refusal({.output = std::uint64_t{1} << 20U}).find("more than 1 MiB"),
            std::string::npos);
}

TEST_F(Xacro, IsNotRunWhereItIsNoProgram) {
  ::setenv("PATH", folder_.c_str(), 1);
  EXPECT_NE(refusal({}).find("install xacro"), std::string::npos);
  program("#!/bin/sh\n");
  fs::permissions(folder_ / "xacro", fs::perms::owner_read);
  if (::access((folder_ / "xacro").c_str(), X_OK) != 0) {
    EXPECT_NE(refusal({}).find("install xacro"), std::string::npos);
  }
}

}  // namespace
}  // namespace kaboum::robot
