// Output of `pliant inspect --fit`: the models chosen by error budgets, with the measurements.
#pragma once

#include <nlohmann/json.hpp>

#include "content/level/level.h"

namespace pliant {

// `error` [1]: budget of every surface and soft body; 0: each one's own. An error if nothing has a budget.
Result<nlohmann::ordered_json> describe_fit(Level& level, double error);
void print_fit(const nlohmann::ordered_json& fit);

}  // namespace pliant
