// Text that number fields accept, and text that is rejected rather than guessed.
#include "viewer/ui/quantity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pliant::ui {
namespace {

double value(const std::string& text, const std::string& unit) {
  const Result<double> read = parse_quantity(text, unit);
  EXPECT_TRUE(read.ok()) << text << " in " << unit << ": " << (read ? "" : read.error().what);
  return read ? *read : std::nan("");
}
std::string why(const std::string& text, const std::string& unit) {
  const Result<double> read = parse_quantity(text, unit);
  EXPECT_FALSE(read.ok()) << text << " in " << unit << " is " << (read ? *read : 0.0);
  if (read) return {};
  EXPECT_NE(read.error().cure, "") << read.error().what;
  return read.error().sentence();
}

TEST(Quantity, ANumberAloneIsInTheFieldsUnit) {
  for (const char* unit : {"", "1", "m", "mm", "N/m", "kg/m3", "%", "\u00b0", "\u00d7", "lx", "N s/m", "1/s"}) {
    EXPECT_EQ(value("5", unit), 5.0) << unit;
    EXPECT_EQ(value(" -0.25 ", unit), -0.25) << unit;
    EXPECT_EQ(value("1e-3", unit), 1e-3) << unit;
  }
}

TEST(Quantity, UnitsAreThoseThatStandThere) {
  EXPECT_EQ(value("5 mm", "m"), 5e-3);
  EXPECT_EQ(value("5mm", "mm"), 5.0);
  EXPECT_EQ(value("0.3 mm", "mm"), 0.3);
  EXPECT_EQ(value("2 cm", "mm"), 20.0);
  EXPECT_EQ(value("30 um", "mm"), 0.03);
  EXPECT_EQ(value("30 \u00b5m", "mm"), 0.03);
  EXPECT_EQ(value("30 \u03bcm", "mm"), 0.03);
  EXPECT_EQ(value("1 in", "mm"), 25.4);
  EXPECT_EQ(value("12 kPa", "Pa"), 12e3);
  EXPECT_EQ(value("0.1 MPa", "Pa"), 1e5);
  EXPECT_EQ(value("800 mN", "N"), 0.8);
  EXPECT_EQ(value("0.5 N/mm", "N/m"), 500.0);
  EXPECT_EQ(value("25 g", "kg"), 0.025);
  EXPECT_EQ(value("1.05 g/cm3", "kg/m3"), 1050.0);
  EXPECT_EQ(value("1.05 g/cm^3", "kg/m3"), 1050.0);
  EXPECT_EQ(value("1.05 g/cm\u00b3", "kg/m3"), 1050.0);
  EXPECT_EQ(value("200 ms", "s"), 0.2);
  EXPECT_EQ(value("2 kHz", "Hz"), 2000.0);
  EXPECT_EQ(value("2 cm/s", "mm/s"), 20.0);
  EXPECT_NEAR(value("45 deg", "rad"), 0.25 * 3.14159265358979, 1e-12);
  EXPECT_NEAR(value("1 rad", "\u00b0"), 57.29577951308232, 1e-9);
  EXPECT_EQ(value("90\u00b0", "\u00b0"), 90.0);
  EXPECT_EQ(value("35 %", "1"), 0.35);
  EXPECT_EQ(value("35 %", ""), 0.35);
  EXPECT_EQ(value("35 %", "%"), 35.0);
  EXPECT_EQ(value("981 cm/s2", "m/s2"), 9.81);
  EXPECT_EQ(value("12 N s/m", "N s/m"), 12.0);
  EXPECT_EQ(value("2 N m/rad", "N m/rad"), 2.0);
  EXPECT_EQ(value("20 mN m", "N m"), 0.02);
}

TEST(Quantity, ArithmeticIsWorkedOut) {
  EXPECT_EQ(value("1/10", "mm"), 0.1);
  EXPECT_EQ(value("1/10 mm", "mm"), 0.1);
  EXPECT_EQ(value("2*3", "mm"), 6.0);
  EXPECT_EQ(value("2*(3+1) cm", "mm"), 80.0);
  EXPECT_EQ(value("5 mm - 3 mm", "mm"), 2.0);
  EXPECT_EQ(value("1 cm + 2 mm", "mm"), 12.0);
  EXPECT_EQ(value("1 N / 2 mm", "N/m"), 500.0);
  EXPECT_EQ(value("6 mm / 2 mm", ""), 3.0);
  EXPECT_EQ(value("-(2 + 3)", ""), -5.0);
  EXPECT_EQ(value("2^3", ""), 8.0);
  EXPECT_EQ(value("10 - 2 - 3", ""), 5.0);
  EXPECT_EQ(value("100 / 10 / 2", ""), 5.0);
}

TEST(Quantity, ACommaIsADecimalPoint) {
  EXPECT_EQ(value("0,1", "m"), 0.1);
  EXPECT_EQ(value("0,125", "m"), 0.125);
  EXPECT_EQ(value("1,5 mm", "mm"), 1.5);
  EXPECT_EQ(value("12,3456", ""), 12.3456);
  EXPECT_NE(why("1,000", "").find("1000 or 1.000"), std::string::npos);
  why("1.000,5", "");
  why("1,000.5", "");
  why("1,000,000", "");
  why("1 000", "");
}

TEST(Quantity, WhatIsOfAnotherKindIsRefused) {
  EXPECT_NE(why("5 kg", "mm").find("of another kind than mm"), std::string::npos);
  why("5 mm", "N");
  why("5 mm2", "mm");
  why("5 mm", "");
  why("5 mm", "%");
  why("5 N", "N/m");
  why("5 Pa", "N/m");
  why("45 deg", "");
  why("5 s", "Hz");
  why("1 1/s", "\u00b0");
}

TEST(Quantity, WhatCannotBeReadIsRefused) {
  for (const char* text :
       {"",    " ",        "mm",       "abc",        "5 parsecs", "5 KPA",     "nan",      "inf",  "-inf",
        "5 +", "+",        "*5",       "5 mm 3",     "5 3",       "(5",        "5)",       "()",   "1/0",
        "0/0", "1e999",    "1e400 mm", "5e",         "5 e",       "0x10",      "0x5",      "1..2", ".",
        ",",   "5 mm + 3", "3 + 5 mm", "5 mm + 2 s", "5%%%2",     "2^",        "2^99",     "m5",   "5 m/",
        "5;",  "5\n6",     "$5",       "5 mm)",      "1'000",     "5 ft 3 in", "\xff\xfe", "5\xc2"})
    why(text, "mm");
  why(std::string(300, '('), "mm");
  why(std::string(150, '-') + "5", "mm");
  EXPECT_NE(why("5 KPA", "Pa").find("did you mean kPa?"), std::string::npos);
}

// Any text gives a finite number or an error with a remedy.
TEST(Quantity, NoTextBreaksIt) {
  const std::string parts[] = {"1",      "0",      ".",  ",", "e",    "-",   "+",     "*",     "/", "(",
                               ")",      "^",      "mm", "m", "N",    "kPa", "%",     " ",     "9", "\u00b0",
                               "\u00b5", "\u00b2", "x",  "g", "\xc3", "in",  "1e308", "1e-308"};
  const std::string units[] = {"", "m", "mm", "N/m", "rad", "%", "kg/m3", "N s/m"};
  std::mt19937 random(7);
  for (int i = 0; i < 200000; ++i) {
    std::string text;
    for (auto n = random() % 9; n-- > 0;) text += parts[random() % std::size(parts)];
    const Result<double> read = parse_quantity(text, units[random() % std::size(units)]);
    if (read) {
      ASSERT_TRUE(std::isfinite(*read)) << text;
    } else {
      ASSERT_NE(read.error().cure, "") << text << ": " << read.error().what;
    }
  }
}

// Against arithmetic that is done elsewhere: sums of products of numbers in millimetres.
TEST(Quantity, AgreesWithTheSameSumInMillimetres) {
  std::mt19937 random(3);
  const std::pair<const char*, double> units[] = {{"mm", 1}, {"cm", 10}, {"m", 1000}, {"um", 1e-3}, {"in", 25.4}};
  for (int i = 0; i < 2000; ++i) {
    double sum = 0;
    std::string text;
    for (int k = 0; k < 4; ++k) {
      const int number = static_cast<int>(random() % 1000), divisor = 1 + static_cast<int>(random() % 9);
      const auto& [unit, size] = units[random() % std::size(units)];
      const bool minus = k > 0 && random() % 2;
      text += (k == 0 ? "" : minus ? " - " : "+") + std::to_string(number) + " " + unit + "/" + std::to_string(divisor);
      sum += (minus ? -1 : 1) * number * size / divisor;
    }
    EXPECT_NEAR(value(text, "mm"), sum, 1e-9 * std::max(1.0, std::abs(sum))) << text;
  }
}

}  // namespace
}  // namespace pliant::ui
