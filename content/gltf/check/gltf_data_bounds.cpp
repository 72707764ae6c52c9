// check_data: the elements of every accessor against its declared bounds, and sparse indices.
#include <algorithm>
#include <cmath>

#include "content/gltf/check/gltf_data.h"

namespace pliant {

namespace {

// `slack`: tolerance, because exporters print bounds with six or more digits.
template <class T>
void compare_bounds(DataCheck& check, std::size_t i, std::size_t width, const std::vector<T>& values, double slack) {
  std::vector<double> low(width, INFINITY), high(width, -INFINITY);
  for (std::size_t e = 0; e * width < values.size(); ++e)
    for (std::size_t c = 0; c < width; ++c) {
      const double value = static_cast<double>(values[e * width + c]);
      if (!std::isfinite(value))
        return check.error(pointer_of(i), fmt::format("holds a number that is not finite in element {}", e));
      low[c] = std::min(low[c], value);
      high[c] = std::max(high[c], value);
    }
  const Json& json = check.accessor(i);
  for (std::size_t c = 0; c < width; ++c) {
    const double allowed = slack * std::max({std::abs(low[c]), std::abs(high[c]), 1e-30});
    if (json.contains("min") && std::abs(json["min"][c].get<double>() - low[c]) > allowed)
      return check.error(fmt::format("{}/min/{}", pointer_of(i), c),
                         fmt::format("is not the smallest element, {}", low[c]));
    if (json.contains("max") && std::abs(json["max"][c].get<double>() - high[c]) > allowed)
      return check.error(fmt::format("{}/max/{}", pointer_of(i), c),
                         fmt::format("is not the largest element, {}", high[c]));
  }
}

void check_sparse_indices(DataCheck& check, std::size_t i, std::uint64_t count) {
  const std::vector<std::uint32_t> indices = read_sparse_indices(check.document, i);
  for (std::size_t k = 0; k < indices.size(); ++k)
    if (indices[k] >= count || (k > 0 && indices[k] <= indices[k - 1]))
      return check.error(pointer_of(i) + "/sparse/indices", fmt::format("are out of range or not ascending at {}", k));
}

void check_bounds_of(DataCheck& check, std::size_t i) {
  const AccessorLayout layout = layout_of(check.accessor(i));
  if (!layout.known || !has_data(check.document, i)) return;
  if (check.accessor(i).contains("sparse")) check_sparse_indices(check, i, layout.count);
  const bool is_float = layout.component_type == kFloat;
  const bool declared = check.accessor(i).contains("min") || check.accessor(i).contains("max");
  if (!is_float && !declared) return;
  // Bounds refer to the stored values: integers for quantised data.
  if (is_float)
    compare_bounds(check, i, layout.components(), read_floats(check.document, i), 2e-6);
  else
    compare_bounds(check, i, layout.components(), read_stored(check.document, i), 0.0);
}

}  // namespace

void check_bounds(DataCheck& check) {
  for (std::size_t i = 0; i < array_of(check.document.json, "accessors").size(); ++i) check_bounds_of(check, i);
}

}  // namespace pliant
