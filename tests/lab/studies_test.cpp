// Every study from end to end at its smallest size: the files it writes and their contents.
#include "lab/study/studies.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "tests/player/command.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using testing::Json;

struct Ran {
  const char* name;
  Status (*run)(OutputFolder& out, StudySize size, const Interrupt& interrupt);
};
constexpr Ran kRuns[] = {
#define STUDY(name, what) {#name, study_##name},
    PLIANT_STUDIES(STUDY)
#undef STUDY
};

// Tables that are not cost against error.
const std::map<std::string, std::vector<std::string>> kColumns{
    {"walls", {"model", "delay_s", "stiffness_N_m", "damping_Ns_m", "verdict", "linear_stable", "passive"}},
    {"scale", {"panel", "curve", "size", "also", "also_size", "cost", "unit", "power", "power_within_95", "straight"}},
    {"hardcases", {"entry", "case", "must_hold", "verdict", "figure", "bound", "unit"}}};

// RFC 4180.
std::vector<std::vector<std::string>> cells_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows(1, {""});
  bool quoted = false;
  for (std::size_t i = 0; i < csv.size(); ++i) {
    const char c = csv[i];
    if (c == '"') {
      if (quoted && i + 1 < csv.size() && csv[i + 1] == '"')
        rows.back().back() += csv[++i];
      else
        quoted = !quoted;
    } else if (c == ',' && !quoted) {
      rows.back().emplace_back();
    } else if (c == '\n' && !quoted) {
      rows.push_back({""});
    } else {
      rows.back().back() += c;
    }
  }
  EXPECT_EQ(rows.back(), std::vector<std::string>{""}) << "the last line has an end";
  rows.pop_back();
  return rows;
}

bool reads_as_number(const std::string& words) {
  char* end = nullptr;
  std::strtod(words.c_str(), &end);
  return !words.empty() && *end == '\0';
}

class Studies : public ::testing::TestWithParam<Ran> {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / folder_name();
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string folder_name() const {
    return std::string("pliant-studies-") + GetParam().name + "-" + std::to_string(::getpid());
  }
  std::string read(const std::string& end) const {
    return testing::read_text(folder_ / (std::string(GetParam().name) + end));
  }
  fs::path folder_;
};

TEST_P(Studies, WritesATableAPictureAndTwoSentences) {
  const std::string name = GetParam().name;
  auto out = OutputFolder::create(folder_);
  ASSERT_TRUE(out) << out.error().message();
  const Interrupt interrupt;
  const Status done = GetParam().run(*out, StudySize::kSmall, interrupt);
  ASSERT_TRUE(done) << done.error().message();
  ASSERT_TRUE(out->commit());

  for (const std::string& file : out->written()) {
    const std::string text = testing::read_text(folder_ / file);
    if (file.ends_with(".png")) {
      EXPECT_EQ(text.substr(0, 8), "\x89PNG\r\n\x1a\n") << file;
      EXPECT_TRUE(fs::exists(folder_ / (file.substr(0, file.size() - 4) + ".svg"))) << file;
    } else if (file.ends_with(".svg")) {
      EXPECT_TRUE(text.starts_with("<?xml") && text.ends_with("</svg>\n")) << file;
    } else if (file.ends_with(".csv")) {
      const auto cells = cells_of(text);
      EXPECT_GT(cells.size(), 1u) << file;
      for (std::size_t i = 0; i < cells.size(); ++i)
        EXPECT_EQ(cells[i].size(), cells[0].size()) << file << ", line " << i + 1;
    }
  }
  for (const char* end : {".csv", ".json", ".svg", ".png"})
    EXPECT_TRUE(fs::exists(folder_ / (name + end))) << name << end;

  const Json json = Json::parse(read(".json"));
  EXPECT_EQ(json.at("study"), name);
  ASSERT_EQ(json.at("shows").size(), 2u);
  for (const std::string sentence : json.at("shows")) {
    EXPECT_FALSE(std::islower(static_cast<unsigned char>(sentence.front()))) << sentence;
    EXPECT_TRUE(sentence.ends_with('.')) << sentence;
    EXPECT_EQ(sentence.find(". "), std::string::npos) << "one sentence: " << sentence;
    for (const char* wrong : {"nan", "inf "}) EXPECT_EQ(sentence.find(wrong), std::string::npos) << sentence;
  }
  const auto cells = cells_of(read(".csv"));
  const std::set<std::string> columns(cells[0].begin(), cells[0].end());
  if (const auto known = kColumns.find(name); known != kColumns.end()) {
    for (const std::string& column : known->second) EXPECT_TRUE(columns.contains(column)) << column;
    return;
  }
  // In a table of cost against error, the JSON has the CSV's rows and columns, and its numbers are numbers.
  ASSERT_EQ(json.at("rows").size() + 1, cells.size());
  for (const Json& row : json.at("rows")) {
    std::set<std::string> keys{"on_front"};
    for (const auto& [key, value] : row.items()) {
      keys.insert(key);
      EXPECT_FALSE(value.is_string() && reads_as_number(value)) << key << ": " << value;
    }
    EXPECT_EQ(keys, columns);
  }
  EXPECT_FALSE(json.at("front").empty());
  for (const Json& point : json.at("front"))
    EXPECT_TRUE(std::any_of(json.at("rows").begin(), json.at("rows").end(), [&](const Json& row) {
      return row.at("group") == point.at("group") && row.at("label") == point.at("label");
    })) << point;
  // Costs and errors can be drawn on logarithmic axes.
  const auto at = [&](const std::string& column) {
    return static_cast<std::size_t>(std::find(cells[0].begin(), cells[0].end(), column) - cells[0].begin());
  };
  const std::size_t cost = cells[0].size() - 2, error = cost - 1;
  EXPECT_EQ(at("on_front"), cost + 1);
  for (std::size_t i = 1; i < cells.size(); ++i) {
    EXPECT_GT(std::stod(cells[i][cost]), 0.0) << cells[i][at("label")];
    if (cells[i][error] != "failed") EXPECT_GE(std::stod(cells[i][error]), 0.0) << cells[i][at("label")];
  }
}

INSTANTIATE_TEST_SUITE_P(Each, Studies, ::testing::ValuesIn(kRuns),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace pliant
