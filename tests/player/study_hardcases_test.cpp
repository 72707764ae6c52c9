// Every hard case of the table (player/study/hard) holds, or is a known defect and exactly that.
#include "player/study/study_hardcases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <set>

namespace pliant {

void PrintTo(const HardCase& hard, std::ostream* out) {
  *out << hard.name;
}

namespace {

std::vector<HardCase> untimed() {
  std::vector<HardCase> cases;
  for (const HardCase& hard : hard_cases())
    if (!hard.timed) cases.push_back(hard);
  return cases;
}

class HardCases : public ::testing::TestWithParam<HardCase> {};

TEST_P(HardCases, Holds) {
  const HardCase& hard = GetParam();
  const HardFigure figure = hard.measure({PLIANT_CORPUS_DIR, true});
  if (figure.is_absent()) GTEST_SKIP() << figure.where() << " is not here; not judged";
  EXPECT_EQ(verdict_of(hard, figure), *hard.defect ? HardVerdict::kNo : HardVerdict::kYes)
      << hard.must << ": " << figure.value() << " of " << hard.bound << ' ' << hard.unit << " at " << figure.where();
}

INSTANTIATE_TEST_SUITE_P(Table, HardCases, ::testing::ValuesIn(untimed()),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(HardTable, HasEveryEntryOfBothListsAndNoNameTwice) {
  std::set<std::string> names, entries;
  for (const HardCase& hard : hard_cases()) {
    EXPECT_TRUE(names.insert(hard.name).second) << hard.name;
    entries.insert(hard.entry);
  }
  const auto count = [&](const std::string& list) {
    return std::count_if(entries.begin(), entries.end(), [&](const std::string& e) { return e.starts_with(list); });
  };
  EXPECT_EQ(count("methods.md 3.9: "), 21);       // vertex and edge are one entry of 22
  EXPECT_EQ(count("contact-energy.md 4: "), 14);  // ten cases, closed loops on three kinds of bodies, levels and corpus
}

// A figure that is no number, or a condition that fails, must never look like a small one.
TEST(HardFigure, IsTheWorstAndFailuresAreWorse) {
  HardFigure figure;
  figure.add(0.5, "a");
  figure.add(0.25, "b");
  EXPECT_EQ(figure.value(), 0.5);
  EXPECT_EQ(figure.where(), "a");
  figure.add(std::nan(""), "c");
  figure.add(2.0, "d");
  EXPECT_TRUE(std::isinf(figure.value()));
  EXPECT_EQ(figure.where(), "c");
  HardFigure needed;
  needed.need(true, "nothing");
  needed.add(0.0);
  needed.need(false, "this");
  EXPECT_EQ(needed.where(), "this");
  EXPECT_EQ(verdict_of({"", "", "", "", 1.0, nullptr}, needed), HardVerdict::kNo);
  EXPECT_EQ(verdict_of({"", "", "", "", 1.0, nullptr}, HardFigure()), HardVerdict::kNo) << "nothing was measured";
}

TEST(HardTable, TheSameCaseHasTheSameFigureToTheBit) {
  for (const HardCase& hard : hard_cases())
    if (std::string(hard.name) == "LoopsOnCoarseSpheresGiveOutNothing") {
      const HardSetting setting{{}, true};
      EXPECT_EQ(hard.measure(setting).value(), hard.measure(setting).value());
      return;
    }
  FAIL() << "the case is not in the table";
}

}  // namespace
}  // namespace pliant
