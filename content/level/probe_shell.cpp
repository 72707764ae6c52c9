#include "content/level/probe_shell.h"

#include <glm/gtc/constants.hpp>

#include "content/mesh/mesh_build.h"

namespace pliant {
namespace {

constexpr std::uint32_t kAround = 16, kRings = 6;  // vertices around the axis; rings in each half from pole to equator

// A capsule along +Y from `from` to `from + length`; a sphere if length is 0.
void add_capsule(dvec3 from, double radius, double length, Primitive& out) {
  const auto first = static_cast<std::uint32_t>(out.position.size());
  const auto add = [&](double polar, double around, double along) {
    const dvec3 way(std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around));
    out.position.emplace_back(from + dvec3(0, along, 0) + radius * way);
  };
  // From the upper pole down; a capsule has two equators.
  const std::uint32_t rings = 2 * kRings - 1 + (length > 0.0 ? 1u : 0u);
  add(0.0, 0.0, length);
  for (std::uint32_t r = 1; r <= rings; ++r) {
    const bool lower = length > 0.0 ? r > kRings : r >= kRings;
    const std::uint32_t step = length > 0.0 && lower ? r - 1 : r;
    for (std::uint32_t k = 0; k < kAround; ++k)
      add(glm::half_pi<double>() * step / kRings, glm::two_pi<double>() * k / kAround, lower ? 0.0 : length);
  }
  add(glm::pi<double>(), 0.0, 0.0);

  const auto at = [&](std::uint32_t ring, std::uint32_t k) { return first + 1 + ring * kAround + k % kAround; };
  const std::uint32_t last = first + 1 + rings * kAround;
  for (std::uint32_t k = 0; k < kAround; ++k) {
    out.index.insert(out.index.end(), {first, at(0, k + 1), at(0, k)});
    for (std::uint32_t r = 0; r + 1 < rings; ++r)
      out.index.insert(out.index.end(), {at(r, k), at(r, k + 1), at(r + 1, k),  //
                                         at(r, k + 1), at(r + 1, k + 1), at(r + 1, k)});
    out.index.insert(out.index.end(), {last, at(rings - 1, k), at(rings - 1, k + 1)});
  }
}

}  // namespace

Result<Mesh> probe_shell(const Probe& probe) {
  const double radius = probe.radius > 0.0 ? probe.radius : kPointShell;
  Primitive surface;
  if (probe.points.empty())
    add_capsule(dvec3(0), radius, probe.length, surface);
  else
    for (const vec3& point : probe.points) add_capsule(dvec3(point), radius, 0.0, surface);
  Result<BuiltMesh> built = build_mesh("probe", {&surface, 1}, mat4(1.0f));
  if (!built) return built.error();
  return std::move(built->mesh);
}

}  // namespace pliant
