#include "systems/visual/skin.h"

#include <bit>
#include <cmath>
#include <glm/gtc/packing.hpp>

namespace pliant {

std::uint32_t folded(vec3 n) {
  const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  if (!(sum > 0.0f)) return 0;
  vec2 f = vec2(n) / sum;
  if (n.z < 0.0f) f = (1.0f - vec2(std::abs(f.y), std::abs(f.x))) * vec2(n.x >= 0 ? 1 : -1, n.y >= 0 ? 1 : -1);
  return glm::packSnorm2x16(f);
}

Skin::Skin(std::size_t vertices) : here_(vertices), table_(gpu::Table::Of::kBits, nullptr, vertices, vertices) {}

bool Skin::take(std::span<const vec3> position, std::span<const vec3> normal) {
  if (position.size() != here_.size() || normal.size() != here_.size() || here_.empty()) return false;
  box_ = Box();
  for (std::size_t i = 0; i < here_.size(); ++i) {
    const vec3 p = position[i];
    here_[i] = {std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y), std::bit_cast<std::uint32_t>(p.z),
                folded(normal[i])};
    box_.add(p);
  }
  newer_here_ = true;
  return true;
}

std::size_t Skin::upload() {
  if (!newer_here_) return 0;
  newer_here_ = false;
  const std::size_t travelled = table_.write(0, here_.data(), here_.size());
  table_.finish();
  return travelled;
}

}  // namespace pliant
