#include "tests/visual/golden.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "systems/visual/png.h"
#include "tests/visual/compare.h"
#include "tests/visual/scene.h"

namespace pliant::test {

void expect_golden(const std::string& name, const Image& on, const Image& off) {
  if (const char* folder = std::getenv("PLIANT_WRITE_GOLDEN")) {
    ASSERT_TRUE(write_png(on, std::filesystem::path(folder) / (name + ".png")));
    ASSERT_TRUE(write_png(off, std::filesystem::path(folder) / (name + "_off.png")));
  }
  EXPECT_GT(perceived_difference(on, off), kTolerance) << name << " looks the same when it is switched off";
  if (test::context()->renderer_name().find("llvmpipe") == std::string::npos)
    GTEST_SKIP() << "golden pictures are llvmpipe's; this is " << test::context()->renderer_name()
                 << ", where only on against off was compared";
  const std::filesystem::path path = std::filesystem::path(PLIANT_SOURCE_DIR) / "tests/visual/golden" / (name + ".png");
  const std::optional<Image> golden = test::read_png(path);
  ASSERT_TRUE(golden) << path << " cannot be read";
  const double now = perceived_difference(on, *golden), without = perceived_difference(off, *golden);
  if (now > kTolerance) {
    const std::filesystem::path seen = std::filesystem::path(::testing::TempDir()) / (name + "_seen.png");
    EXPECT_TRUE(write_png(on, seen));
    ADD_FAILURE() << name << " differs from its golden picture by " << now << " of 255; see " << seen;
  }
  EXPECT_GT(without, kTolerance) << name << " switched off passes for switched on";
}

}  // namespace pliant::test
