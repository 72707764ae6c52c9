#include "content/keys/json_integer.h"

#include <cmath>

namespace pliant {

namespace {

constexpr double kLargestWhole = 9007199254740992.0;  // 2^53: a double represents all integers up to here

}  // namespace

bool as_integer(nlohmann::json& json) {
  if (json.is_number_float())
    if (const double value = json.get<double>(); value == std::trunc(value) && std::abs(value) <= kLargestWhole) {
      if (value < 0.0)
        json = static_cast<std::int64_t>(value);
      else
        json = static_cast<std::uint64_t>(value);
    }
  return json.is_number_integer();
}

}  // namespace pliant
