#include "content/mesh/mesh_refine.h"

#include <array>
#include <map>

namespace pliant {
namespace {

constexpr int kMostPasses = 40;  // an edge halved this often is below single precision

using RefinedCorners = std::array<std::uint32_t, 3>;

class Pass {
 public:
  Pass(Primitive& primitive, const mat4& to_object, const LongestEdge& longest)
      : p_(primitive), to_object_(to_object), longest_(longest) {}

  // The resulting number of triangles.
  std::size_t count() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < p_.index.size(); i += 3) {
      const RefinedCorners c{p_.index[i], p_.index[i + 1], p_.index[i + 2]};
      ++count;
      for (std::size_t k = 0; k < 3; ++k) count += is_long(c[k], c[(k + 1) % 3]);
    }
    return count;
  }

  void cut() {
    std::vector<std::uint32_t> finer;
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) { finer.insert(finer.end(), {a, b, c}); };
    const std::vector<std::uint32_t> coarse = p_.index;
    for (std::size_t i = 0; i < coarse.size(); i += 3) {
      RefinedCorners c{coarse[i], coarse[i + 1], coarse[i + 2]};
      std::array<bool, 3> cut{};
      int cuts = 0;
      for (std::size_t k = 0; k < 3; ++k) cuts += cut[k] = is_long(c[k], c[(k + 1) % 3]);
      // Rotate so that the distinct edge of one or two cuts comes first.
      while (cuts == 1 ? !cut[0] : cuts == 2 && cut[0]) {
        c = {c[1], c[2], c[0]};
        cut = {cut[1], cut[2], cut[0]};
      }
      const std::uint32_t ab = cut[0] ? middle(c[0], c[1]) : 0, bc = cut[1] ? middle(c[1], c[2]) : 0,
                          ca = cut[2] ? middle(c[2], c[0]) : 0;
      if (cuts == 0) add(c[0], c[1], c[2]);
      if (cuts == 1) add(c[0], ab, c[2]), add(ab, c[1], c[2]);
      if (cuts == 2) add(bc, c[2], ca), add(c[0], c[1], bc), add(c[0], bc, ca);
      if (cuts == 3) add(c[0], ab, ca), add(ab, c[1], bc), add(ca, bc, c[2]), add(ab, bc, ca);
    }
    p_.index = std::move(finer);
  }

 private:
  bool is_long(std::uint32_t a, std::uint32_t b) const {
    const dvec3 first(p_.position[a]), second(p_.position[b]);
    const dvec3 along = dmat3(to_object_) * (second - first);
    const double most = longest_(dvec3(dmat4(to_object_) * glm::dvec4(0.5 * (first + second), 1.0)));
    return dot(along, along) > most * most;
  }

  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    const auto [known, fresh] = middles_.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(p_.position.size()));
    if (!fresh) return known->second;
    const auto mean = [&](auto& values) {
      if (!values.empty()) values.push_back(0.5f * (values[a] + values[b]));
    };
    const auto direction = [](vec3 v, vec3 otherwise) {
      const float l = length(v);
      return l > 0.0f ? v / l : otherwise;
    };
    mean(p_.position), mean(p_.uv), mean(p_.stiffness), mean(p_.friction), mean(p_.damping), mean(p_.relaxation),
        mean(p_.pinned), mean(p_.handle);
    if (!p_.normal.empty()) p_.normal.push_back(direction(p_.normal[a] + p_.normal[b], p_.normal[a]));
    if (!p_.tangent.empty()) {
      const vec4 first = p_.tangent[a], second = p_.tangent[b];
      p_.tangent.emplace_back(direction(vec3(first) + vec3(second), vec3(first)), first.w);
    }
    return known->second;
  }

  Primitive& p_;
  const mat4& to_object_;
  const LongestEdge& longest_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles_;
};

std::size_t triangles_of(const std::vector<Primitive>& primitives) {
  std::size_t count = 0;
  for (const Primitive& p : primitives) count += p.index.size() / 3;
  return count;
}

}  // namespace

bool refine(std::vector<Primitive>& primitives, const mat4& to_object, const LongestEdge& longest) {
  for (int pass = 0; pass < kMostPasses; ++pass) {
    std::size_t wanted = 0;
    for (Primitive& p : primitives) wanted += Pass(p, to_object, longest).count();
    if (wanted == triangles_of(primitives) || wanted > kMostRefined) return pass > 0;
    for (Primitive& p : primitives) Pass(p, to_object, longest).cut();
  }
  return true;
}

}  // namespace pliant
