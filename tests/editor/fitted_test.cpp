// Text that a box holds: all of it, or as much as fits and an ellipsis.
#include <gtest/gtest.h>

#include "viewer/ui/widgets.h"

namespace pliant::ui {
namespace {

class FittedText : public ::testing::Test {
 protected:
  void SetUp() override {
    ImGui::CreateContext();
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    font_ = atlas.AddFontDefault();
    unsigned char* pixels = nullptr;
    int wide = 0, high = 0;
    atlas.GetTexDataAsAlpha8(&pixels, &wide, &high);
  }
  void TearDown() override { ImGui::DestroyContext(); }
  bool fits(const std::string& text, float wide, float high) const {
    const ImVec2 size = font_->CalcTextSizeA(font_->FontSize, FLT_MAX, wide, text.c_str());
    return size.x <= wide && size.y <= high;
  }
  ImFont* font_ = nullptr;
};

TEST_F(FittedText, IsWholeWhereItFitsAndElseTheLongestBeginningWithAnEllipsis) {
  const std::string text = "A chrome cushion: what it mirrors b\u00e9nds with the dents of two fingers",
                    dots = "\u2026";
  for (const float wide : {8.0f, 30.0f, 60.0f, 128.0f, 300.0f, 2000.0f})
    for (const float lines : {1.0f, 2.0f, 3.0f}) {
      const float high = lines * font_->FontSize;
      const std::string shown = fitted(text, *font_, wide, high);
      if (fits(text, wide, high)) {
        EXPECT_EQ(shown, text);
        continue;
      }
      if (shown.empty()) {
        EXPECT_FALSE(fits("A" + dots, wide, high)) << wide;
        continue;
      }
      EXPECT_TRUE(fits(shown, wide, high)) << wide << ' ' << lines << ' ' << shown;
      ASSERT_TRUE(shown.ends_with(dots)) << shown;
      const std::string kept = shown.substr(0, shown.size() - dots.size());
      ASSERT_TRUE(text.starts_with(kept)) << shown;
      EXPECT_NE(static_cast<unsigned char>(text[kept.size()]) & 0xc0, 0x80) << "half a letter";
      // A letter more, with the blank before it, is too much.
      std::size_t next = text.find_first_not_of(' ', kept.size()) + 1;
      while (next < text.size() && (static_cast<unsigned char>(text[next]) & 0xc0) == 0x80) ++next;
      EXPECT_FALSE(fits(text.substr(0, next) + dots, wide, high)) << wide << ' ' << lines << ' ' << shown;
    }
}

}  // namespace
}  // namespace pliant::ui
