// A block of coarse tissue with split contacts, bonded at its bottom, and a sphere that a probe presses into it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>

#include "content/level/spawn_soft.h"
#include "content/tets/surface_samples.h"
#include "scenes/tool_stage.h"

namespace pliant {

using scenes::ToolStage;

inline constexpr double kSplitStep = 1.0 / 60.0;  // [s]

// A block with its top at y = 0: `squares` across its top, bonded at its bottom.
struct SplitBlock {
  double half_width = 0.025, thickness = 0.02, cell = 0.004;  // [m]
  double young = 1e4, poisson = 0.45, friction = 0.0;
  int squares = 12;
  SoftContact contact = SoftContact::kSplit;
  std::optional<Deformable> law;         // of its dents
  std::optional<Primitive> shape;        // in its place, and its size
  std::function<float(vec3)> stiffness;  // [1] painted
  double focus = 0.0;                    // [m] half width of a `focus` about the origin; 0: even cells
  std::optional<Handle6> handle;         // bonded to it instead, at its bottom
  Pose pose;
  double reduced() const { return young / (1 - poisson * poisson); }
};

inline Primitive block_surface(const SplitBlock& block) {
  Primitive p;
  const int n = block.squares;
  const auto at = [&](int i) { return static_cast<float>(block.half_width * (2.0 * i / n - 1.0)); };
  const auto corner = [&](int side, int i, int j) {
    return static_cast<std::uint32_t>(side * (n + 1) * (n + 1) + i * (n + 1) + j);
  };
  for (int side = 0; side < 2; ++side)
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j)
        p.position.emplace_back(at(i), side == 0 ? 0.0f : static_cast<float>(-block.thickness), at(j));
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    p.index.insert(p.index.end(), {a, b, c, a, c, d});
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      quad(corner(0, i, j), corner(0, i, j + 1), corner(0, i + 1, j + 1), corner(0, i + 1, j));
      quad(corner(1, i, j), corner(1, i + 1, j), corner(1, i + 1, j + 1), corner(1, i, j + 1));
    }
  for (int i = 0; i < n; ++i) {
    quad(corner(0, i, 0), corner(0, i + 1, 0), corner(1, i + 1, 0), corner(1, i, 0));
    quad(corner(0, i + 1, n), corner(0, i, n), corner(1, i, n), corner(1, i + 1, n));
    quad(corner(0, 0, i + 1), corner(0, 0, i), corner(1, 0, i), corner(1, 0, i + 1));
    quad(corner(0, n, i), corner(0, n, i + 1), corner(1, n, i + 1), corner(1, n, i));
  }
  return p;
}

// A cylinder with its lower face at y = 0.
inline Primitive cylinder_of_triangles(double radius) {
  constexpr std::uint32_t kSides = 32;
  Primitive p;
  for (const double y : {0.0, 2 * radius})
    for (std::uint32_t i = 0; i < kSides; ++i) {
      const double turn = 2 * M_PI * i / kSides;
      p.position.emplace_back(radius * std::cos(turn), y, radius * std::sin(turn));
    }
  p.position.emplace_back(0.0f, 0.0f, 0.0f);
  p.position.emplace_back(0.0f, static_cast<float>(2 * radius), 0.0f);
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const std::uint32_t j = (i + 1) % kSides, up = kSides;
    p.index.insert(p.index.end(), {2 * up, i, j, 2 * up + 1, j + up, i + up, i, i + up, j, j, i + up, j + up});
  }
  return p;
}

inline Entity add_block(ToolStage& stage, const SplitBlock& block) {
  LevelNode node;
  node.name = "tissue";
  node.mesh = 0;
  SoftBody body;
  body.young = block.young, body.poisson = block.poisson, body.cell = block.cell, body.contact = block.contact;
  body.rayleigh = {0.0, 0.01};
  body.friction_static = body.friction_sliding = block.friction;
  const auto wide = static_cast<float>(2 * block.half_width), deep = static_cast<float>(block.thickness);
  if (block.focus > 0.0) {
    body.focus.add(vec3(static_cast<float>(-block.focus)));
    body.focus.add(vec3(static_cast<float>(block.focus)));
  }
  if (block.handle) node.handle = block.handle;
  Box& bonded = block.handle ? node.handle->box : body.pinned;
  bonded.add(vec3(-wide, -2 * deep, -wide));
  bonded.add(vec3(wide, (block.shape && !block.handle ? -0.85f : -0.999f) * deep, wide));
  node.soft_body = body;
  if (block.law) node.deformable = *block.law;
  LevelMesh mesh{"block", {block.shape ? *block.shape : block_surface(block)}};
  Primitive& primitive = mesh.primitives.front();
  if (block.stiffness)
    for (const vec3 p : primitive.position) primitive.stiffness.push_back(block.stiffness(p));
  auto parts = make_soft_parts(node, &mesh, mat4(1), {});
  EXPECT_TRUE(parts) << parts.error().message();
  World& world = stage.world;
  if (block.contact == SoftContact::kSplit) parts->tets.samples = sample_surface(parts->surface.mesh, parts->tets);
  body.collision_mesh = world.meshes.add(std::move(parts->surface.mesh));
  body.tets = world.tet_meshes.add(std::move(parts->tets));
  const Entity entity = world.registry.create();
  world.registry.add(entity, Name{"tissue"});
  world.registry.add(entity, block.pose);
  world.registry.add(entity, body);
  if (node.handle) {
    world.registry.add(entity, *node.handle);
    HapticDevice device;
    device.driver = DriverKind::kExternal;
    device.position = block.pose.position, device.rotation = block.pose.rotation;
    device.max_force = 1e9, device.max_slew = 1e12;
    world.registry.add(entity, device);
  }
  if (block.law) {
    DentLaw& law = world.registry.add(entity, DentLaw{*block.law});
    law.mesh = body.collision_mesh;
    if (law.reach <= 0.0) law.reach = default_reach(world.meshes[law.mesh]);
  }
  world.simulation.gravity = dvec3(0);
  return entity;
}

struct SpherePress {
  double depth = 0.0, force = 0.0;  // [m] of the sphere below the undeformed surface, [N] upwards on it
  double aside = 0.0, felt = 0.0;   // [N] along the surface; of the touch clock
};

// A sphere held at (x, z), pressed `depth` deep by its device.
inline SpherePress press_sphere(const SplitBlock& block, double radius, double depth, dvec2 at) {
  ToolStage stage(kSplitStep);
  const Entity tissue = add_block(stage, block);
  const Entity probe = stage.add_probe({at.x, radius + 1e-3, at.y}, radius);
  stage.device(probe).max_force = 100.0;
  stage.world.registry.get<Probe>(probe).coupling = {3000.0, 10.0};
  stage.prepare();
  stage.lead(probe, dvec3(at.x, radius + 1e-3, at.y), 0.02);
  stage.lead(probe, dvec3(at.x, radius - depth, at.y), 0.1);
  stage.lead(probe, dvec3(at.x, radius - depth, at.y), 0.2);
  SpherePress out;
  const dvec3 on = stage.contact_force(probe, tissue);
  const auto* tool = stage.body(probe).as_tool();
  out.depth = radius - tool->handle().object_pose().position.y;
  out.force = on.y;
  out.aside = std::hypot(on.x, on.z);
  out.felt = stage.read(probe).force.y;
  return out;
}

}  // namespace pliant
