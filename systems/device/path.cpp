#include "systems/device/path.h"

#include <algorithm>
#include <cmath>

namespace pliant {

PathRow sample_path(const Path& path, double time) {
  const auto& rows = path.rows;
  const double first = rows.front().time, last = rows.back().time;
  if (path.repeats && last > first && time > last) time = first + std::fmod(time - first, last - first);
  if (time <= first) return rows.front();
  if (time >= last) return rows.back();
  const auto after =
      std::upper_bound(rows.begin(), rows.end(), time, [](double t, const PathRow& row) { return t < row.time; });
  const PathRow &a = *(after - 1), &b = *after;
  const double share = (time - a.time) / (b.time - a.time);
  return {time, a.position + share * (b.position - a.position), glm::slerp(a.rotation, b.rotation, share),
          a.grip + share * (b.grip - a.grip)};
}

}  // namespace pliant
