// Values in a device's options: "5ms", "10%", "0.1mm", and lists KEY=VALUE.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pliant/math.h"

namespace pliant {

// Removes surrounding blanks.
std::string_view trimmed(std::string_view text);

// Splits at `mark` and trims the parts. An empty text has no part.
std::vector<std::string> split(std::string_view text, char mark);

struct Option {
  std::string key, value;  // "delay", "5ms"; without '=' the key is empty
};
Option option_of(std::string_view text);

// Finite numbers. Without a unit, the unit in brackets is meant.
std::optional<double> plain_number(std::string_view text);
std::optional<double> seconds_of(std::string_view text);  // s, ms, us [s]
std::optional<double> metres_of(std::string_view text);   // m, mm, um [m]
std::optional<double> newtons_of(std::string_view text);  // N, mN [N]
std::optional<double> share_of(std::string_view text);    // % [1], 0 to 1
std::optional<dvec3> vector_of(std::string_view text);    // X:Y:Z

}  // namespace pliant
