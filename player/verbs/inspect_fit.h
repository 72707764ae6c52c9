// What `pliant inspect --fit` says: which models error budgets choose, and the evidence.
#pragma once

#include <nlohmann/json.hpp>

#include "content/level/level.h"

namespace pliant {

// `error` [1]: of every surface and soft body; 0: each one's own. An error where nothing has a budget.
Result<nlohmann::ordered_json> describe_fit(Level& level, double error);
void print_fit(const nlohmann::ordered_json& fit);

}  // namespace pliant
