// Bodies that are thrown at a thin plate stay on their side of it.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/soft/collision_shapes.h"
#include "tests/soft/contact_loop.h"

namespace pliant {
namespace {

using test::ContactLoop;

constexpr double kThinStep = 1.0 / 60.0;  // [s]

// A body thrown at a plate 2 mm thick must stay on its side: how far [m] its vertices get behind the plate's face at
// worst, and after half a second.
struct Depth {
  double worst = -1.0, last = -1.0;
};
Depth throw_at_plate(const Mesh& mesh, const RigidMass& mass, double radius, dvec3 direction, double speed,
                     dquat attitude) {
  const Mesh plate = test::voxel_mesh(8, 1, 8, vec3(0.05f, 0.002f, 0.05f), vec3(-0.2f, -0.001f, -0.2f),
                                      [](int, int, int) { return true; });
  ContactLoop loop;
  loop.gravity = dvec3(0);
  const dvec3 up = -direction;
  const dvec3 side = normalize(cross(std::abs(up.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 0, 1), up));
  const dquat turned = glm::quat_cast(dmat3(side, up, cross(side, up)));
  loop.add<FixedBody>(plate, Pose{dvec3(0), turned});
  RigidState& body = loop.add<RigidState>(mesh, Pose{(radius + 0.037) * up, attitude}, mass);
  body.set_velocity(speed * direction, dvec3(0));
  loop.set_friction(0.3, 0.3);
  Depth depth;
  for (int i = 0; i < 30; ++i) {
    loop.step(kThinStep);
    depth.last = -1.0;
    for (const dvec3& x : body.surface_position) {
      const dvec3 local = glm::conjugate(turned) * x;
      if (std::abs(local.x) < 0.19 && std::abs(local.z) < 0.19) depth.last = std::max(depth.last, 0.001 - local.y);
    }
    depth.worst = std::max(depth.worst, depth.last);
  }
  return depth;
}

TEST(Proximity, NothingTunnelsThroughAThinPlate) {
  const Mesh ball = test::sphere_mesh(0.02f, 2), block = test::block_mesh(vec3(0.03f));
  std::mt19937 random(1);
  for (const double speed : {1.0, 5.0})
    for (int trial = 0; trial < 20; ++trial) {
      dvec3 direction = test::random_direction(random);
      if (trial < 6) direction = dvec3(trial / 2 == 0, trial / 2 == 1, trial / 2 == 2) * (trial % 2 ? -1.0 : 1.0);
      const dquat attitude = trial == 0 ? dquat(1, 0, 0, 0) : glm::angleAxis(2.0, test::random_direction(random));
      for (const bool round : {true, false}) {
        const Depth depth = throw_at_plate(round ? ball : block,
                                           round ? test::sphere_mass(0.02, 0.1) : test::block_mass(dvec3(0.03), 0.1),
                                           0.026, direction, speed, attitude);
        EXPECT_LT(depth.worst, speed == 1.0 ? 2e-4 : 1.5e-3) << "round " << round << ", " << speed << " m/s, " << trial;
        EXPECT_LT(depth.last, 1e-4) << "round " << round << ", " << speed << " m/s, " << trial;
      }
    }
}

}  // namespace
}  // namespace pliant
