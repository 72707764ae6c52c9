// Text from files, before it reaches a terminal.
#include "runtime/printable.h"

#include <gtest/gtest.h>

#include <string>

namespace pliant {
namespace {

TEST(Printable, WhatATerminalWouldActOnIsWrittenAsAnEscape) {
  EXPECT_EQ(printable("\x1b[31mred\x1b[0m"), "\\x1b[31mred\\x1b[0m");
  EXPECT_EQ(printable("bell\a, back\b, del\x7f"), "bell\\x07, back\\x08, del\\x7f");
  EXPECT_EQ(printable("a\nb\rc\td"), "a\\nb\\rc\\td");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\u009b31m"), "\\u009b31m") << "CSI as one character";
  EXPECT_EQ(printable("\x9b"
                      "31m"),
            "\\x9b31m")
      << "CSI as one byte";
}

TEST(Printable, WhatWouldReorderOrBreakTheLineIsWrittenAsAnEscape) {
  EXPECT_EQ(printable("txt\u202egnp"), "txt\\u202egnp");
  EXPECT_EQ(printable("\u061c\u200e\u200f\u202a\u2066\u2069"), "\\u061c\\u200e\\u200f\\u202a\\u2066\\u2069");
  EXPECT_EQ(printable("a\u2028b\u2029"), "a\\u2028b\\u2029");
}

TEST(Printable, BytesThatAreNoUtf8AreWrittenOneByOne) {
  EXPECT_EQ(printable("caf\xe9"), "caf\\xe9") << "Latin-1";
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf") << "overlong";
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond U+10FFFF";
  EXPECT_EQ(printable("\xe2\x80"), "\\xe2\\x80") << "cut off";
  EXPECT_EQ(printable("\xe2\x80z"), "\\xe2\\x80z");
}

TEST(Printable, TextIsKept) {
  for (const char* text : {"", "liver (left) 100 %", "a{b}%s%n", "Über α 肝臓 🫀", "C:\\mesh", "\u00a0"})
    EXPECT_EQ(printable(text), text);
}

// Every byte sequence becomes text that needs no escape any more.
TEST(Printable, WhatIsPrintableStaysAsItIs) {
  for (unsigned first = 0; first < 256; ++first)
    for (unsigned second = 0; second < 256; ++second) {
      const std::string text{static_cast<char>(first), static_cast<char>(second), 'x'}, once = printable(text);
      EXPECT_EQ(printable(once), once);
      for (const char c : once) EXPECT_GE(static_cast<unsigned char>(c), 0x20);
    }
}

}  // namespace
}  // namespace pliant
