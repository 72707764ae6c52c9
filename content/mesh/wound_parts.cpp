#include "content/mesh/wound_parts.h"

#include <algorithm>

namespace pliant {
namespace {

constexpr std::uint32_t kNoPart = 0xffffffffu;

}  // namespace

// Propagates over edges of two triangles.
WoundParts::WoundParts(const Mesh& mesh, const std::vector<SideAgainst>& against) : mesh_(mesh) {
  part_of.assign(mesh_.triangles.size(), kNoPart);
  side.assign(mesh_.triangles.size(), 0);
  std::vector<std::uint32_t> waiting;
  for (std::uint32_t first = 0; first < part_of.size(); ++first) {
    if (part_of[first] != kNoPart) continue;
    const auto number = static_cast<std::uint32_t>(parts.size());
    WoundPart part;
    part.origin = dvec3(mesh_.position(mesh_.triangles[first].x));
    const auto reach = [&](std::uint32_t triangle, std::uint8_t as) {
      if (part_of[triangle] == kNoPart) {
        part_of[triangle] = number;
        side[triangle] = as;
        waiting.push_back(triangle);
      } else if (side[triangle] != as) {
        part.orientable = false;
      }
    };
    reach(first, 0);
    while (!waiting.empty()) {
      const std::uint32_t t = waiting.back();
      waiting.pop_back();
      ++part.count;
      part.area[side[t]] += 0.5 * length(twice_area(t));
      for (std::uint32_t i = 0; i < 3; ++i) {
        if (const std::uint32_t other = mesh_.across[t][static_cast<int>(i)]; other != kBorder) {
          reach(other, side[t]);
          continue;
        }
        const auto found = std::lower_bound(against.begin(), against.end(), SideAgainst{3 * t + i, 0});
        if (found != against.end() && found->edge == 3 * t + i)
          reach(found->other / 3, static_cast<std::uint8_t>(1 - side[t]));
        else
          part.closed = false;
      }
    }
    parts.push_back(std::move(part));
  }
}

std::uint32_t WoundParts::agree() {
  std::uint32_t turned = 0;
  for (std::size_t t = 0; t < side.size(); ++t) {
    const WoundPart& part = parts[part_of[t]];
    if (!part.orientable)
      side[t] = 0;
    else if (part.area[1] > part.area[0])
      side[t] = static_cast<std::uint8_t>(1 - side[t]);
    turned += side[t];
  }
  measure_volumes();
  return turned;
}

void WoundParts::measure_volumes() {
  for (std::uint32_t t = 0; t < side.size(); ++t) {
    WoundPart& part = parts[part_of[t]];
    if (!part.closed) continue;
    const uvec3 c = mesh_.triangles[t];
    const dvec3 a = dvec3(mesh_.position(c.x)) - part.origin, b = dvec3(mesh_.position(c.y)) - part.origin,
                d = dvec3(mesh_.position(c.z)) - part.origin;
    part.volume += (side[t] ? -1.0 : 1.0) * dot(a, cross(b, d)) / 6.0;
  }
}

dvec3 WoundParts::twice_area(std::uint32_t triangle) const {
  const uvec3 t = mesh_.triangles[triangle];
  const dvec3 a(mesh_.position(t.x));
  return cross(dvec3(mesh_.position(t.y)) - a, dvec3(mesh_.position(t.z)) - a);
}

}  // namespace pliant
