// Every hard case of the table (lab/study/hard) holds, or is a known defect with exactly its condition. Runs all of the
// study except costs; under a sanitizer the part of --quick.
#include "lab/study/hard/study_hardcases.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <ostream>
#include <set>

#include "lab/study/corpus_folder.h"

namespace pliant {

void PrintTo(const HardCase& hard, std::ostream* out) {
  *out << hard.name;
}

namespace {

#ifdef PLIANT_SANITIZED
constexpr bool kBrief = true;
#else
constexpr bool kBrief = false;
#endif

std::vector<HardCase> untimed() {
  std::vector<HardCase> cases;
  for (const HardCase& hard : hard_cases())
    if (!hard.timed) cases.push_back(hard);
  return cases;
}

class HardCases : public ::testing::TestWithParam<HardCase> {};

TEST_P(HardCases, Holds) {
  const HardCase& hard = GetParam();
  const HardFigure figure = hard.measure({corpus_folder(), kBrief});
  if (figure.is_absent()) GTEST_SKIP() << figure.where() << " is not here; not judged";
  EXPECT_EQ(verdict_of(hard, figure), *hard.defect ? HardVerdict::kNo : HardVerdict::kYes)
      << hard.must << ": " << figure.value() << " of " << hard.bound << ' ' << hard.unit << " at " << figure.where();
}

INSTANTIATE_TEST_SUITE_P(Table, HardCases, ::testing::ValuesIn(untimed()),
                         [](const auto& each) { return std::string(each.param.name); });

// The bold names in an item of docs/methods.md section 3, without the item's own name.
std::set<std::string> entries_of(int item) {
  std::ifstream file(std::string(PLIANT_SOURCE_DIR) + "/docs/methods.md");
  std::set<std::string> entries;
  bool in_section = false, in_item = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("## ")) in_section = line.starts_with("## 3. ");
    if (in_section && !line.empty() && std::isdigit(static_cast<unsigned char>(line[0]))) {
      in_item = line.starts_with(std::to_string(item) + ". ");
    } else if (in_section && in_item) {
      for (std::size_t open = line.find("**"); open != std::string::npos;) {
        const std::size_t close = line.find("**", open + 2);
        entries.insert("methods.md 3." + std::to_string(item) + ": " + line.substr(open + 2, close - open - 2));
        open = line.find("**", close + 2);
      }
    }
  }
  return entries;
}

TEST(HardTable, HasEveryEntryOfBothListsByNameAndNoOther) {
  std::set<std::string> wanted = entries_of(9), entries, names;
  EXPECT_GE(wanted.size(), 20u);
  wanted.merge(entries_of(10));
  EXPECT_GE(wanted.size(), 35u);
  for (const HardCase& hard : hard_cases()) {
    EXPECT_TRUE(names.insert(hard.name).second) << hard.name;
    entries.insert(hard.entry);
  }
  EXPECT_THAT(entries, ::testing::ContainerEq(wanted));
}

// A non-finite figure, or a failed condition, must never look like a small figure.
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

HardFigure scattering(double value, double low, double high) {
  HardFigure figure;
  figure.add(value);
  figure.between(low, high);
  return figure;
}

TEST(HardFigure, IsNotJudgedWhereItScattersAcrossItsBound) {
  const HardCase hard{"ATick", "", "", "us", 10.0, nullptr};
  EXPECT_EQ(verdict_of(hard, scattering(9.0, 8.5, 9.5)), HardVerdict::kYes);
  EXPECT_EQ(verdict_of(hard, scattering(9.5, 9.0, 10.5)), HardVerdict::kNotJudged);
  EXPECT_EQ(verdict_of(hard, scattering(10.2, 9.9, 10.5)), HardVerdict::kNotJudged);
  EXPECT_EQ(verdict_of(hard, scattering(11.0, 10.5, 12.0)), HardVerdict::kNo);
}

TEST(HardTable, AlwaysSaysTwoSentences) {
  const HardCase bounded{"AWall", "", "", "m", 2.0, nullptr}, exact{"NoForce", "", "", "N", 0.0, nullptr};
  HardFigure one, none, absent;
  one.add(1.0);
  none.add(0.0);
  absent.absent("the corpus");
  for (const std::vector<JudgedCase>& cases : {std::vector<JudgedCase>{{bounded, one}, {exact, none}},
                                               {{exact, none}},
                                               {{bounded, absent}},
                                               {{exact, one}},
                                               {}})
    EXPECT_EQ(sentences_of(cases).size(), 2u);
  const std::vector<std::string> both =
      sentences_of({{bounded, one}, {bounded, scattering(2.0, 1.5, 2.5)}, {exact, one}});
  EXPECT_THAT(both[0], ::testing::HasSubstr("1 of 3 hard cases hold"));
  EXPECT_THAT(both[0], ::testing::HasSubstr("a wall (2 (1.5 to 2.5) m, at most 2)"));
  EXPECT_THAT(both[0], ::testing::HasSubstr("these do not: no force (1 N, at most 0)"));
  EXPECT_THAT(both[1], ::testing::HasSubstr("a wall, at 50 % of it"));
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
