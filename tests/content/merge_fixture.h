// Levels that are saved into the document they came from, and read again.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "content/files/file_io.h"
#include "content/level_file.h"
#include "tests/content/document_compare.h"
#include "tests/content/level_normal.h"

namespace pliant::test {

namespace fs = std::filesystem;

class MergeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("pliant-merge-") + info->name() + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  // Saves and reads again.
  Level again(const Level& level, const char* name = "again.glb") {
    const Status saved = save_level(level, folder_ / name);
    EXPECT_TRUE(saved.ok()) << (saved.ok() ? "" : saved.error().message());
    Result<Level> back = load_level(folder_ / name);
    EXPECT_TRUE(back.ok()) << (back ? "" : back.error().message());
    return back ? *back : Level{};
  }
  Bytes bytes(const char* name) { return *read_file(folder_ / name); }
  fs::path folder_;
};

inline std::string difference(const Level& a, const Level& b) {
  return Difference::of(normal_form(a), normal_form(b));
}

}  // namespace pliant::test
