// The stream of one object, on the CPU and on the GPU. This class tracks which copy is newer, zone by zone; only
// changed zones are uploaded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "components/math.h"
#include "systems/visual/gpu/table.h"

namespace pliant {

class StreamCopies {
 public:
  StreamCopies() = default;
  // Both copies start as `initial` (whole zones), or as one zone of zeros if it is empty: a surface at rest.
  explicit StreamCopies(std::span<const vec4> initial);

  // Takes whole zones, packed in the order of `zones`; zones that do not exist are ignored. Nothing is uploaded yet.
  void take(std::span<const std::uint32_t> zones, std::span<const vec4> packed);
  // Updates the GPU's copy, neighbouring zones in one transfer. Returns the bytes uploaded.
  std::size_t upload();

  const gpu::Table& table() const { return table_; }
  const gpu::Buffer& buffer() const { return table_.buffer(); }
  std::span<const vec4> values() const { return here_; }

 private:
  std::vector<vec4> here_;              // [1,1,1,m] never older than the GPU's
  std::vector<bool> newer_here_;        // per zone
  std::vector<std::uint32_t> waiting_;  // zones with newer_here_, in order of arrival
  gpu::Table table_;
};

}  // namespace pliant
