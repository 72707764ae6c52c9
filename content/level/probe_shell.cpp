#include "content/level/probe_shell.h"

#include <glm/gtc/constants.hpp>

#include "components/probe_shape.h"
#include "content/mesh/mesh_build.h"

namespace pliant {
namespace {

constexpr std::uint32_t kAround = 16, kRings = 6;  // vertices around the axis; rings in each half from pole to equator

void add_part(const ProbePart& part, double radius, Primitive& out) {
  const auto first = static_cast<std::uint32_t>(out.position.size());
  const double length = glm::length(part.to - part.from);
  dmat3 frame(1.0);  // its second column is the axis
  if (const dvec3 axis = part.to - part.from; axis.x != 0.0 || axis.z != 0.0 || axis.y < 0.0) {
    frame[1] = normalize(axis);
    frame[0] = normalize(cross(frame[1], std::abs(frame[1].x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 0, 1)));
    frame[2] = cross(frame[0], frame[1]);
  }
  const auto add = [&](double polar, double around, double along) {
    const dvec3 way(std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around));
    out.position.emplace_back(part.from + frame * (dvec3(0, along, 0) + radius * way));
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
  for (const ProbePart& part : probe_parts(probe)) add_part(part, radius, surface);
  Result<BuiltMesh> built = build_mesh("probe", {&surface, 1}, mat4(1.0f));
  if (!built) return built.error();
  return std::move(built->mesh);
}

}  // namespace pliant
