// Vectors are glm's. `vec3` is single precision (fields, pictures), `dvec3` double (contacts, solvers, studies).
// SI units, right-handed, Y up, metres; normals point outward.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

namespace pliant {

using glm::cross;
using glm::dmat2;
using glm::dmat3;
using glm::dmat4;
using glm::dot;
using glm::dquat;
using glm::dvec2;
using glm::dvec3;
using glm::length;
using glm::mat3;
using glm::mat4;
using glm::normalize;
using glm::quat;
using glm::uvec3;
using glm::vec2;
using glm::vec3;
using glm::vec4;

// An axis-aligned box; empty until something is added.
struct Box {
  vec3 min{std::numeric_limits<float>::max()};
  vec3 max{std::numeric_limits<float>::lowest()};
  void add(vec3 p) {
    min = glm::min(min, p);
    max = glm::max(max, p);
  }
  void add(const Box& other) {
    min = glm::min(min, other.min);
    max = glm::max(max, other.max);
  }
  bool empty() const { return min.x > max.x; }
  vec3 center() const { return 0.5f * (min + max); }
  vec3 size() const { return max - min; }
  float diagonal() const { return empty() ? 0.0f : length(max - min); }
};

}  // namespace pliant
