// Output of every study: the front of cost against error, and complete files.
#include "lab/study/pareto.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace pliant {
namespace {

ParetoTable five_ways() {
  ParetoTable table;
  table.study = "ways";
  table.cost_name = "cost_us";
  table.error_name = "error";
  table.more = {"kind", "count", "share", "whole"};
  const double none = std::numeric_limits<double>::quiet_NaN();
  table.rows = {{"slow", 8, 0.1, "a", {"x", std::int64_t{3}, 0.25, true}},
                {"worse and dearer", 9, 0.2, "a", {"x", std::int64_t{4}, none, false}},
                {"quick", 1, 3.0, "b", {"y", std::int64_t{5}, 0.5, false}},
                {"failed", 0.5, std::numeric_limits<double>::infinity(), "b", {"y", std::int64_t{6}, 1.0, false}},
                {"middle, twice", 2, 0.5, "b", {"y", std::int64_t{7}, 1.0, false}},
                {"middle again", 2, 0.5, "b", {"y", std::int64_t{8}, 1.0, false}}};
  return table;
}

TEST(Pareto, TheFrontIsWhatNothingBettersInBothCostAndError) {
  EXPECT_EQ(pareto_front(five_ways().rows), (std::vector<std::size_t>{2, 4, 0}));
  EXPECT_TRUE(pareto_front({}).empty());
}

TEST(Pareto, TheCsvHasEveryRowAndQuotesWhatNeedsIt) {
  const std::string csv = to_csv(five_ways());
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "group,label,kind,count,share,whole,error,cost_us,on_front");
  EXPECT_NE(csv.find("\na,slow,x,3,0.25,1,0.1,8,1\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\nb,\"middle, twice\",y,7,1,0,0.5,2,1\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\na,worse and dearer,x,4,,0,0.2,9,0\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\nb,failed,y,6,1,0,failed,0.5,0\n"), std::string::npos) << csv;
}

TEST(Pareto, TheJsonHasNumbersAsNumbersAndNullWhereAWayFailed) {
  const auto json = nlohmann::json::parse(to_json(five_ways()).dump());
  const auto& rows = json.at("rows");
  EXPECT_EQ(rows[0].at("kind"), "x");
  EXPECT_TRUE(rows[0].at("count").is_number_integer());
  EXPECT_EQ(rows[0].at("share"), 0.25);
  EXPECT_EQ(rows[0].at("whole"), true);
  EXPECT_TRUE(rows[1].at("share").is_null());
  EXPECT_TRUE(rows[3].at("error").is_null());
}

TEST(Pareto, WhatIsNotResolvedIsNoBetterThanWhatIs) {
  ParetoTable table = five_ways();
  table.rows = {{"cheap", 1, 0.0, "a", {}, 0.01}, {"dear", 2, 0.001, "a", {}, 0.01}, {"dearest", 3, 0.005, "a", {}}};
  EXPECT_EQ(pareto_front(table.rows), (std::vector<std::size_t>{0, 2}));
}

}  // namespace
}  // namespace pliant
