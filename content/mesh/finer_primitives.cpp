#include "content/mesh/finer_primitives.h"

#include <algorithm>

#include "content/mesh/mesh_draw.h"

namespace pliant {

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

FinerPrimitives::FinerPrimitives(std::span<const Primitive> primitives, const mat4& to_object, const Gathered& gathered)
    : middles_(primitives.size()) {
  const Directions to(to_object);
  for (std::size_t n = 0; n < primitives.size(); ++n) {
    Primitive p = primitives[n];
    const std::size_t count = p.position.size();
    const auto only_whole = [&](auto& values) {
      if (values.size() != count) values.clear();
    };
    only_whole(p.normal), only_whole(p.tangent), only_whole(p.uv), only_whole(p.stiffness), only_whole(p.friction);
    only_whole(p.damping), only_whole(p.relaxation), only_whole(p.pinned), only_whole(p.handle);
    p.index.clear();
    for (std::size_t v = 0; v < count; ++v) {
      const std::size_t all = gathered.first_vertex[n] + v;
      const bool turned = !gathered.turned_normal.empty() && gathered.turned_normal[all] != 0;
      p.position[v] = gathered.position[all];
      if (!p.normal.empty()) p.normal[v] = vec3(to.normal * dvec3(p.normal[v]) * (turned ? -1.0 : 1.0));
      if (!p.tangent.empty())
        p.tangent[v] =
            vec4(vec3(to.tangent * dvec3(vec3(p.tangent[v]))), (p.tangent[v].w < 0.0f) != turned ? -to.hand : to.hand);
    }
    primitives_.push_back(std::move(p));
  }
}

std::uint32_t FinerPrimitives::middle(std::uint32_t primitive, std::uint32_t a, std::uint32_t b, vec3 position) {
  Primitive& p = primitives_[primitive];
  const auto [known, fresh] =
      middles_[primitive].try_emplace(edge_key(a, b), static_cast<std::uint32_t>(p.position.size()));
  if (!fresh) return known->second;
  p.position.push_back(position);
  const auto mean = [&](auto& values) {
    if (!values.empty()) values.push_back(0.5f * (values[a] + values[b]));
  };
  const auto direction = [](vec3 v, vec3 otherwise) {
    const float l = length(v);
    return l > 0.0f ? v / l : otherwise;
  };
  mean(p.uv), mean(p.stiffness), mean(p.friction), mean(p.damping), mean(p.relaxation), mean(p.pinned);
  mean(p.handle);
  if (!p.normal.empty()) p.normal.push_back(direction(p.normal[a] + p.normal[b], p.normal[a]));
  if (!p.tangent.empty()) {
    const vec4 first = p.tangent[a], second = p.tangent[b];
    p.tangent.emplace_back(direction(vec3(first) + vec3(second), vec3(first)), first.w);
  }
  return known->second;
}

}  // namespace pliant
