#include "systems/effects/guide_path.h"

#include <algorithm>
#include <cmath>

#include "pliant/parameters.h"

namespace pliant {

GuidePath::GuidePath(const Path& path) {
  if (path.rows.empty()) return;
  std::vector<Box> boxes;
  dvec3 last = path.rows.front().position;
  for (const PathRow& row : path.rows) {
    const double size = length(row.position - last);
    if (!(size > 0.0)) continue;
    from_.push_back(last);
    direction_.push_back((row.position - last) / size);
    length_.push_back(size);
    Box& box = boxes.emplace_back();
    box.add(vec3(last));
    box.add(vec3(row.position));
    last = row.position;
  }
  closed_ = from_.size() > 1 && last == path.rows.front().position;
  boxes_.build(boxes);
}

bool GuidePath::find(dvec3 x, double within, PathFoot& foot) const {
  if (!(within > 0.0)) return false;
  double least = within * within;
  bool found = false;
  const double room = within * (1 + 1e-6) + 1e-6 * (1.0 + length(x));  // boxes are in single precision
  Box near;
  near.add(vec3(x - dvec3(room)));
  near.add(vec3(x + dvec3(room)));
  boxes_.visit(near, [&](std::uint32_t i) {
    const double along = std::clamp(dot(x - from_[i], direction_[i]), 0.0, length_[i]);
    const dvec3 v = x - from_[i] - along * direction_[i];
    if (!(dot(v, v) < least)) return;
    least = dot(v, v);
    foot = {i, along};
    found = true;
  });
  return found;
}

bool GuidePath::slide(dvec3 x, double most, PathFoot& foot) const {
  constexpr int kMostSegments = 1024;  // in one tick
  const auto count = static_cast<std::uint32_t>(from_.size());
  const auto projected = [&](std::uint32_t i) { return dot(x - from_[i], direction_[i]); };
  double left = most;
  for (int step = 0; step < kMostSegments; ++step) {
    const std::uint32_t i = foot.segment;
    const double to = std::clamp(projected(i), 0.0, length_[i]), way = to - foot.along;
    if (std::abs(way) > left) {
      foot.along += std::copysign(left, way);
      return false;
    }
    foot.along = to;
    left -= std::abs(way);
    const std::uint32_t next = i + 1 < count ? i + 1 : 0, previous = i > 0 ? i - 1 : count - 1;
    if (to == length_[i] && (closed_ || i + 1 < count) && projected(next) > 0.0)
      foot = {next, 0.0};
    else if (to == 0.0 && (closed_ || i > 0) && projected(previous) < length_[previous])
      foot = {previous, length_[previous]};
    else
      return true;
  }
  return false;
}

}  // namespace pliant
