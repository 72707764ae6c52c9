#include "systems/visual/upload.h"

#include <algorithm>

#include "components/mesh.h"
#include "runtime/assert.h"

namespace pliant {
namespace {

// One snapshot's zones; more only occur if several snapshots were taken for one picture.
constexpr std::size_t kStagedZones = 512;

}  // namespace

StreamCopies::StreamCopies(std::span<const vec4> initial) : here_(initial.begin(), initial.end()) {
  const std::size_t zones = std::max<std::size_t>(1, (here_.size() + kZoneSize - 1) / kZoneSize);
  here_.resize(zones * kZoneSize, vec4(0));
  newer_here_.assign(zones, false);
  waiting_.reserve(zones);
  table_ = gpu::Table(gpu::Table::Of::kFloats, here_.data(), here_.size(), std::min(zones, kStagedZones) * kZoneSize);
}

void StreamCopies::take(std::span<const std::uint32_t> zones, std::span<const vec4> packed) {
  ASSERT(packed.size() >= zones.size() * kZoneSize);
  for (std::size_t i = 0; i < zones.size(); ++i) {
    const std::uint32_t zone = zones[i];
    if (zone >= newer_here_.size()) continue;
    std::copy_n(packed.begin() + static_cast<std::ptrdiff_t>(i * kZoneSize), kZoneSize,
                here_.begin() + static_cast<std::ptrdiff_t>(zone * kZoneSize));
    if (!newer_here_[zone]) waiting_.push_back(zone);
    newer_here_[zone] = true;
  }
}

std::size_t StreamCopies::upload() {
  std::sort(waiting_.begin(), waiting_.end());
  std::size_t travelled = 0;
  for (std::size_t i = 0; i < waiting_.size();) {
    const std::size_t first = waiting_[i];
    std::size_t count = 0;
    for (; i < waiting_.size() && waiting_[i] == first + count; ++i, ++count) newer_here_[waiting_[i]] = false;
    travelled += table_.write(first * kZoneSize, &here_[first * kZoneSize], count * kZoneSize);
  }
  table_.finish();
  waiting_.clear();
  return travelled;
}

}  // namespace pliant
