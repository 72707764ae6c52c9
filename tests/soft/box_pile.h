// Bodies over a floor.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "tests/soft/collision_shapes.h"

namespace pliant::test {

inline constexpr double kPileStep = 1.0 / 60.0;  // [s]
inline constexpr double kBoxSize = 0.03;         // [m] of the boxes
inline const dquat kUpright(1, 0, 0, 0);

inline dquat turned_about_y(double angle) {
  return glm::angleAxis(angle, dvec3(0, 1, 0));
}
inline RigidBody fixed() {
  RigidBody body;
  body.fixed = true;
  return body;
}
inline SoftBody pile_rubber() {
  SoftBody body;
  body.young = 3e4;
  body.poisson = 0.4;
  body.rayleigh = {1.0, 0.01};
  return body;
}

// A ball of tetrahedra: a cube's nodes moved outwards onto spheres.
inline TetMesh soft_ball(double radius) {
  TetMesh ball = tets::box(4, 4, 4, dvec3(-1), dvec3(1));
  for (dvec3& x : ball.nodes) {
    const double most = std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)});
    if (most > 0.0) x *= radius * most / length(x);
  }
  return ball;
}

// Bodies over a floor whose top is y = 0.
struct BoxPile {
  scenes::ToolStage stage{kPileStep};
  std::vector<Entity> bodies;
  Entity floor;
  BoxPile() : floor(stage.add_rigid(scenes::box(dvec3(1.0, 0.1, 1.0), dvec3(0, -0.05, 0)), fixed(), {})) {}

  void rigid(dvec3 at, dquat turned = kUpright, dvec3 size = dvec3(kBoxSize)) {
    bodies.push_back(stage.add_rigid(scenes::box(size), RigidBody{}, Pose{at, turned}));
  }
  void cube(dvec3 at, dquat turned = kUpright, int cells = 3) {
    const TetMesh tets = tets::box(cells, cells, cells, dvec3(-0.5 * kBoxSize), dvec3(0.5 * kBoxSize));
    bodies.push_back(stage.add_soft(tets, pile_rubber(), Pose{at, turned}));
  }
  void ball(dvec3 at) {
    bodies.push_back(stage.add_soft(soft_ball(0.5 * kBoxSize), pile_rubber(), Pose{at, kUpright}));
  }
  Entity wall(dvec3 size, dvec3 at) { return stage.add_rigid(scenes::box(size), fixed(), Pose{at, kUpright}); }
  void run(double seconds) {
    if (!stage.world.soft) stage.prepare();
    for (int i = 0; i < int(std::lround(seconds / kPileStep)); ++i) stage.step();
  }

  const std::vector<dvec3>& collision_mesh(std::size_t i) { return stage.body(bodies[i]).surface_position; }
  dvec3 centre(std::size_t i) {
    dvec3 sum(0);
    for (const dvec3& x : collision_mesh(i)) sum += x;
    return sum / double(collision_mesh(i).size());
  }
  double lowest(std::size_t i) {  // [m]
    double y = 1e300;
    for (const dvec3& x : collision_mesh(i)) y = std::min(y, x.y);
    return y;
  }
  double highest(std::size_t i) {
    double y = -1e300;
    for (const dvec3& x : collision_mesh(i)) y = std::max(y, x.y);
    return y;
  }
  double fastest() {  // [m/s] of all vertices
    double most = 0.0;
    std::vector<dvec3> v;
    for (const Entity e : bodies) {
      stage.body(e).move_surface(v);
      for (const dvec3& x : v) most = std::max(most, length(x));
    }
    return most;
  }
  SoftTally& tally() { return stage.soft().tally; }
};

}  // namespace pliant::test
