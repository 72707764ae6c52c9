// Vectors are glm's. `vec3` is single precision (fields, pictures), `dvec3` double (contacts, solvers, studies). SI
// units, right-handed, Y up, metres; normals point outward.
//
// The library is compiled with glm's default configuration. A program whose GLM_FORCE_... macros change the memory
// layout of vectors or quaternions would be incompatible without an error, so it does not compile.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <type_traits>

#ifdef GLM_FORCE_QUAT_CTOR_XYZW
#error "pliant: quat(w, x, y, z) is the order of Pliant's headers; compile this file without GLM_FORCE_QUAT_CTOR_XYZW"
#endif
#ifdef GLM_FORCE_SINGLE_ONLY
#error "pliant: contacts are in double precision; compile this file without GLM_FORCE_SINGLE_ONLY"
#endif

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

static_assert(offsetof(quat, x) == 0 && offsetof(dquat, x) == 0 && offsetof(dquat, w) == 3 * sizeof(double),
              "pliant: glm's quaternions must lie in memory as x, y, z, w, as the library was compiled: every rotation "
              "would be read wrongly; compile this file without GLM_FORCE_QUAT_DATA_WXYZ");
static_assert(sizeof(vec3) == 3 * sizeof(float) && alignof(vec3) == alignof(float) &&
                  sizeof(dvec3) == 3 * sizeof(double) && alignof(dvec3) == alignof(double) &&
                  alignof(vec4) == alignof(float) && alignof(dquat) == alignof(double) &&
                  sizeof(mat4) == 16 * sizeof(float) && alignof(mat4) == alignof(float),
              "pliant: glm's vectors must be packed, as the library was compiled; compile this file without "
              "GLM_FORCE_DEFAULT_ALIGNED_GENTYPES");
static_assert(std::is_same_v<vec3, glm::vec<3, float, glm::packed_highp>> &&
                  std::is_same_v<dvec3, glm::vec<3, double, glm::packed_highp>> &&
                  std::is_same_v<uvec3, glm::vec<3, glm::uint, glm::packed_highp>> &&
                  std::is_same_v<dquat, glm::qua<double, glm::packed_highp>>,
              "pliant: glm's vectors must be packed and of high precision, as the library was compiled; compile this "
              "file without GLM_PRECISION_... and GLM_FORCE_DEFAULT_ALIGNED_GENTYPES");
static_assert(std::is_trivially_copyable_v<vec3> && std::is_trivially_copyable_v<dquat> &&
                  GLM_CONFIG_SWIZZLE != GLM_SWIZZLE_OPERATOR,
              "pliant: glm's vectors must be plain numbers, or a call would hand them over in another way than the "
              "library was compiled for; compile this file without GLM_FORCE_CTOR_INIT, GLM_FORCE_CXX98 and "
              "GLM_FORCE_SWIZZLE");

// An axis-aligned box; initially empty.
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

// The same in double precision, as written by a person.
struct DBox {
  dvec3 min{std::numeric_limits<double>::max()};
  dvec3 max{std::numeric_limits<double>::lowest()};
  bool empty() const { return min.x > max.x; }
  bool operator==(const DBox&) const = default;
};

}  // namespace pliant
