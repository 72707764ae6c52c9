// Integers in JSON files.
#pragma once

#include <nlohmann/json.hpp>

namespace pliant {

// Whether a value is an integer. 1.0, as written by languages with one number type, is replaced by 1.
bool as_integer(nlohmann::json& json);

}  // namespace pliant
