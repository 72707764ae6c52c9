#include "player/record/csv.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "runtime/printable.h"

namespace pliant {

std::string csv_text(const std::string& name) {
  const std::string shown = printable(name);
  if (shown.find_first_of(",\"") == std::string::npos) return shown;
  std::string text = "\"";
  for (const char c : shown) {
    if (c == '"') text += '"';
    text += c;
  }
  return text + '"';
}

void put(std::string& line, double value) {
  fmt::format_to(std::back_inserter(line), ",{:.9g}", (std::abs(value) < 1e-100 ? 0.0 : value) + 0.0);
}

void put(std::string& line, const dvec3& v) {
  for (int axis = 0; axis < 3; ++axis) put(line, v[axis]);
}

void put(std::string& line, const dquat& q) {
  for (const double value : {q.w, q.x, q.y, q.z}) put(line, value);
}

}  // namespace pliant
