// Real scenes for tests: found through the environment variable SVDAG_SCENES, never shipped.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace svdag {

// The path of a shared scene. A folder that is set but lacks the file fails the test.
inline std::string shared_scene(const std::string& name) {
  const char* folder = std::getenv("SVDAG_SCENES");
  const std::string path = std::string(folder != nullptr ? folder : "") + "/" + name;
  if (folder != nullptr && !std::filesystem::exists(path)) {
    ADD_FAILURE() << "SVDAG_SCENES is set, but " << path << " is missing";
  }
  return path;
}

}  // namespace svdag

// First line of a test that needs the shared scenes.
#define SVDAG_NEEDS_SHARED_SCENES() \
  if (std::getenv("SVDAG_SCENES") == nullptr) GTEST_SKIP() << "SVDAG_SCENES is not set"
