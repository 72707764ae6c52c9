#include "engine/scene_check.h"

#include <fmt/format.h>

#include <cmath>

#include "components/range.h"

namespace pliant {
namespace {

struct Bound {
  const char* what;
  double value;
  Range range;
};

Status within(const std::string& node, std::initializer_list<Bound> bounds) {
  for (const Bound& bound : bounds)
    if (!bound.range.holds(bound.value))
      return Error{"`" + node + "`: " + bound.what,
                   fmt::format("is {}; give a number {} {} and at most {}", bound.value,
                               bound.range.above_min ? "above" : "of at least", bound.range.min, bound.range.max)};
  return Done{};
}

bool finite(dvec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Status check_mesh(const LevelMesh& mesh) {
  const std::string where = "mesh `" + mesh.name + "`";
  for (const Primitive& p : mesh.primitives) {
    const std::size_t count = p.position.size();
    for (const std::size_t size :
         {p.normal.size(), p.tangent.size(), p.uv.size(), p.stiffness.size(), p.friction.size(), p.damping.size(),
          p.relaxation.size(), p.pinned.size(), p.handle.size()})
      if (size != 0 && size != count)
        return Error{where,
                     fmt::format("has {} positions and {} values beside them; give none or as many", count, size)};
    if (p.index.size() % 3 != 0)
      return Error{where, "the number of indices is no multiple of three; give whole triangles"};
    for (const std::uint32_t i : p.index)
      if (i >= count)
        return Error{where, fmt::format("index {} is beyond its {} positions; check the triangles", i, count)};
  }
  return Done{};
}

Status check_placement(const LevelNode& node) {
  const LocalTransform& at = node.local;
  const float turn = glm::length(at.rotation);
  if (finite(at.translation) && finite(at.scale) && std::abs(turn - 1.0f) < 0.01f &&
      at.scale.x * at.scale.y * at.scale.z != 0.0f)
    return Done{};
  return Error{"`" + node.name + "`",
               "its placement is not finite, its rotation not of unit length, or its scale zero"};
}

Status check_probe(const std::string& name, const Probe& probe) {
  for (const vec3 p : probe.points)
    if (!finite(p) || std::abs(p.x) + std::abs(p.y) + std::abs(p.z) > 3.0 * kProbeLengths.max)
      return Error{"`" + name + "`: points", "one of them is not finite or too far away"};
  return within(name, {{"radius", probe.radius, kProbeLengths},
                       {"length", probe.length, kProbeLengths},
                       {"coupling", probe.coupling[0], kPairRange},
                       {"coupling", probe.coupling[1], kPairRange}});
}

Status check_bodies(const LevelNode& node) {
  using R = SoftBodyRange;
  if (node.soft_body) {
    const SoftBody& body = *node.soft_body;
    if (Status s = within(node.name, {{"young", body.young, R::kYoung},
                                      {"poisson", body.poisson, R::kPoisson},
                                      {"density", body.density, R::kDensity},
                                      {"rayleigh", body.rayleigh[0], kPairRange},
                                      {"rayleigh", body.rayleigh[1], kPairRange},
                                      {"cell", body.cell, R::kCell},
                                      {"friction_static", body.friction_static, kFrictionRange},
                                      {"friction_sliding", body.friction_sliding, kFrictionRange}});
        !s)
      return s;
  }
  if (node.rigid_body) {
    const RigidBody& body = *node.rigid_body;
    if (Status s = within(node.name, {{"mass", body.mass, R::kMass},
                                      {"density", body.density, R::kDensity},
                                      {"friction_static", body.friction_static, kFrictionRange},
                                      {"friction_sliding", body.friction_sliding, kFrictionRange}});
        !s)
      return s;
  }
  if (!node.handle) return Done{};
  const Handle6& handle = *node.handle;
  return within(node.name, {{"coupling.translation", handle.translation[0], kPairRange},
                            {"coupling.translation", handle.translation[1], kPairRange},
                            {"coupling.rotation", handle.rotation[0], kPairRange},
                            {"coupling.rotation", handle.rotation[1], kPairRange},
                            {"coupling.max_force", handle.max_force, kSaturationRange},
                            {"coupling.max_torque", handle.max_torque, kSaturationRange}});
}

}  // namespace

Status check_device(const std::string& name, const DeviceParameters& device) {
  using R = DeviceRange;
  return within(name, {{"scale", device.scale, R::kScale},
                       {"max_force", device.max_force, R::kMaxForce},
                       {"max_stiffness", device.max_stiffness, R::kMaxStiffness},
                       {"max_slew", device.max_slew, R::kMaxSlew}});
}

Status check_scene(const Level& level) {
  const Simulation& s = level.simulation;
  if (Status ok = within("scene", {{"touch_rate", s.touch_rate, kTouchRateRange},
                                   {"soft_step", s.soft_step, kSoftStepRange},
                                   {"gravity", s.gravity.x, kGravityRange},
                                   {"gravity", s.gravity.y, kGravityRange},
                                   {"gravity", s.gravity.z, kGravityRange}});
      !ok)
    return ok;
  for (const LevelMesh& mesh : level.meshes)
    if (Status ok = check_mesh(mesh); !ok) return ok;
  for (const LevelNode& node : level.nodes) {
    if (Status ok = check_placement(node); !ok) return ok;
    if (node.probe)
      if (Status ok = check_probe(node.name, *node.probe); !ok) return ok;
    if (node.device)
      if (Status ok = check_device(node.name, *node.device); !ok) return ok;
    if (Status ok = check_bodies(node); !ok) return ok;
  }
  return Done{};
}

}  // namespace pliant
