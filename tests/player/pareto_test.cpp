// What every study writes: the front of cost against error, and files that leave nothing out.
#include "player/study/pareto.h"

#include <gtest/gtest.h>

#include <limits>

namespace pliant {
namespace {

ParetoTable five_ways() {
  ParetoTable table;
  table.study = "ways";
  table.cost_name = "cost_us";
  table.error_name = "error";
  table.more = {"kind"};
  table.rows = {
      {"slow", 8, 0.1, "a", {"x"}},          {"worse and dearer", 9, 0.2, "a", {"x"}},
      {"quick", 1, 3.0, "b", {"y"}},         {"failed", 0.5, std::numeric_limits<double>::infinity(), "b", {"y"}},
      {"middle, twice", 2, 0.5, "b", {"y"}}, {"middle again", 2, 0.5, "b", {"y"}}};
  return table;
}

TEST(Pareto, TheFrontIsWhatNothingBettersInBothCostAndError) {
  EXPECT_EQ(pareto_front(five_ways().rows), (std::vector<std::size_t>{2, 4, 0}));
  EXPECT_TRUE(pareto_front({}).empty());
}

TEST(Pareto, TheCsvHasEveryRowAndQuotesWhatNeedsIt) {
  const std::string csv = to_csv(five_ways());
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "group,label,kind,error,cost_us,on_front");
  EXPECT_NE(csv.find("\nb,\"middle, twice\",y,0.5,2,1\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\na,worse and dearer,x,0.2,9,0\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\nb,failed,y,failed,0.5,0\n"), std::string::npos) << csv;
}

TEST(Pareto, TheJsonSaysNullWhereAWayFailed) {
  const std::string json = to_json(five_ways());
  EXPECT_NE(json.find("\"error\": null"), std::string::npos) << json;
  EXPECT_NE(json.find("\"quick\""), std::string::npos);
}

}  // namespace
}  // namespace pliant
