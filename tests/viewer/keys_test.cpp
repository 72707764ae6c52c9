// The table of keys that both programs show.
#include "viewer/window/keys.h"

#include <gtest/gtest.h>

#include <set>

#include "viewer/window/window_input.h"

namespace pliant {
namespace {

TEST(Keys, EveryNameIsReadBackAsItIsWritten) {
  for (const char* keys :
       {"A", "7", "F1", "F12", "Ctrl+Shift+S", "Alt+Left", "Shift+.", "Space", "Esc", "Home", "Tab"}) {
    int key = 0;
    std::uint8_t modifiers = 0;
    ASSERT_TRUE(parse_keys(keys, key, modifiers)) << keys;
    EXPECT_EQ(keys_text(key, modifiers), keys);
  }
  for (const char* wrong : {"", "F0", "F13", "F1.5", "Hyper+A", "Q9", "Ctrl+"}) {
    int key = 0;
    std::uint8_t modifiers = 0;
    EXPECT_FALSE(parse_keys(wrong, key, modifiers)) << wrong;
  }
}

TEST(Keys, EachKeyOfTheWindowDoesOneThingAndIsFoundByItsNumber) {
  std::set<std::string> ids, keys;
  for (const KeyRow& row : key_rows()) {
    EXPECT_TRUE(keys.insert(row.window).second) << row.window << " does two things";
    EXPECT_NE(std::string(row.words), "");
    if (*row.id == '\0') continue;
    EXPECT_TRUE(ids.insert(row.id).second) << row.id;
    int key = 0;
    std::uint8_t modifiers = 0;
    ASSERT_TRUE(parse_keys(row.window, key, modifiers)) << row.window;
    if (row.id != std::string(kStopAction)) EXPECT_EQ(window_key(key), &row);
    if (row.editor && *row.editor) EXPECT_TRUE(parse_keys(row.editor, key, modifiers)) << row.editor;
    EXPECT_EQ(row.editor != nullptr, row.label != nullptr) << row.id;
  }
  EXPECT_EQ(window_key(0), nullptr);
}

}  // namespace
}  // namespace pliant
