#include "systems/device/repeat.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "systems/device/path.h"

namespace pliant {
namespace {

constexpr double kSamePlace = 1e-6;  // [1] of the path's length
constexpr double kSameTurn = 1e-12;  // [1] 1 - |cosine of half the angle|

bool ends_where_it_begins(const Path& path, const PathRow& begin) {
  const PathRow& end = path.rows.back();
  double way = 0.0;
  for (std::size_t i = 1; i < path.rows.size(); ++i) way += length(path.rows[i].position - path.rows[i - 1].position);
  return length(end.position - begin.position) <= kSamePlace * way &&
         1.0 - std::abs(dot(end.rotation, begin.rotation)) <= kSameTurn;
}

}  // namespace

double period_of(const Path& path) {
  const double last = std::max(0.0, path.rows.back().time);
  return ends_where_it_begins(path, sample_path(path, 0.0)) ? last : 2.0 * last;
}

Path repeated(const Path& path, double period) {
  const double last = path.rows.back().time;
  PathRow begin = sample_path(path, 0.0);
  begin.time = 0.0;
  Path all{{begin}, path.turns, true, path.grips};
  std::copy_if(path.rows.begin(), path.rows.end(), std::back_inserter(all.rows),
               [](const PathRow& row) { return row.time > 0.0; });
  if (ends_where_it_begins(path, begin)) {
    if (last > 0.0) all.rows.back() = {last, begin.position, begin.rotation, begin.grip};
  } else if (last > 0.0) {
    for (std::size_t i = all.rows.size() - 1; i-- > 0;)
      all.rows.push_back({2.0 * last - all.rows[i].time, all.rows[i].position, all.rows[i].rotation, all.rows[i].grip});
  }
  if (all.rows.back().time < period) all.rows.push_back({period, begin.position, begin.rotation, begin.grip});
  return all;
}

void repeat_scripts(World& world) {
  double period = 0.0;
  const auto each = [&world](auto act) {
    for (auto [entity, device] : world.registry.view<HapticDevice>())
      if (device.driver == DriverKind::kScript && device.path.valid() && !world.paths[device.path].repeats) act(device);
  };
  each([&](const HapticDevice& device) { period = std::max(period, period_of(world.paths[device.path])); });
  std::map<std::uint32_t, Handle<Path>> made;  // per path, which devices may share
  each([&](HapticDevice& device) {
    const auto [path, is_new] = made.try_emplace(device.path.index);
    if (is_new) path->second = world.paths.add(repeated(world.paths[device.path], period));
    device.path = path->second;
  });
}

}  // namespace pliant
