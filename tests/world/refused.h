#pragma once

#include <gtest/gtest.h>
#include <kaboum/base/error.h>

#include <string>
#include <vector>

#include "worlds.h"

namespace kaboum::test {

/// Expects that a scene is refused as bad input, with its place in the file and these words.
inline void expect_refused(const SceneFiles& files, const std::string& text,
                           const std::vector<std::string>& words) {
  try {
    (void)files.world(text);
    FAIL() << "accepted: " << text;
  } catch (const Error& error) {
    const std::string what = error.what();
    EXPECT_EQ(error.code(), ErrorCode::InvalidInput) << what;
    EXPECT_TRUE(what.starts_with("scene.json: line ") || what.starts_with("scene.json: the JSON") ||
                what.starts_with("scene.json: not JSON"))
        << what;
    for (const std::string& word : words)
      EXPECT_NE(what.find(word), std::string::npos) << "no '" << word << "' in: " << what;
  }
}

}  // namespace kaboum::test
