#include "io_test.h"

// assimp leaks a little on some damaged files; LeakSanitizer is about our code.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp"; }  // NOLINT

namespace kaboum::io::test {
namespace {

bool with_assimp() {
  const auto names = readable_formats();
  return std::ranges::find(names, "fbx") != names.end();
}

TEST(Assimp, Errors) {
  if (!with_assimp()) {
    expect_error("x", Format::Fbx, {"assimp"}, ErrorCode::NotBuilt);
    return;
  }
  expect_error("this is not such a file", Format::Fbx, {});
}

}  // namespace
}  // namespace kaboum::io::test
