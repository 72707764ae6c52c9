// Integers of JSON files.
#pragma once

#include <nlohmann/json.hpp>

namespace pliant {

// Whether a value is an integer. One that stands as 1.0, as languages with one kind of number write it, becomes 1.
bool as_integer(nlohmann::json& json);

}  // namespace pliant
