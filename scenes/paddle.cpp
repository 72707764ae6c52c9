#include "scenes/paddle.h"

#include <cmath>

#include "scenes/tet_shapes.h"

namespace pliant::scenes {
namespace {

const dvec3 kPaddle(0.084, 0.018, 0.048);      // [m]
const dvec3 kBed(0.072, 0, 0.036);             // [m] extent of the studs
constexpr double kStud = 0.003;                // [m] wide and high
constexpr double kDepth = 1.5e-3;              // [m] prescribed depth of the paddle in the studs
constexpr double kCircle = 3e-3, kTurn = 2.0;  // [m] radius, [s] once around
constexpr double kFriction = 0.4;              // [1]

// Pyramids in rows, with their tips at y = 0.
Primitive studs(double from, double to, int along, int across) {
  Primitive p;
  for (int i = 0; i < along; ++i)
    for (int k = 0; k < across; ++k) {
      const dvec3 top(from + (to - from) * (i + 0.5) / along, 0, kBed.z * ((k + 0.5) / across - 0.5));
      const auto first = static_cast<std::uint32_t>(p.position.size());
      p.position.push_back(vec3(top));
      for (const dvec3 corner : {dvec3(-1, -2, -1), dvec3(-1, -2, 1), dvec3(1, -2, 1), dvec3(1, -2, -1)})
        p.position.push_back(vec3(top + 0.5 * kStud * corner));
      for (const std::uint32_t v : {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1, 1, 4, 3, 1, 3, 2}) p.index.push_back(first + v);
    }
  return p;
}

}  // namespace

Entity add_paddle(ToolStage& stage, PaddleCells cells) {
  TetMesh paddle =
      tets::box(cells.along, cells.high, cells.across, -0.5 * kPaddle * dvec3(1, 0, 1), 0.5 * kPaddle * dvec3(1, 2, 1));
  tets::hold(
      paddle, [](dvec3) { return false; }, [](dvec3 x) { return x.y > 0.999 * kPaddle.y; });
  SoftBody tissue;
  tissue.young = 1e4;
  tissue.poisson = 0.45;
  tissue.rayleigh = {1.0, 0.005};
  tissue.friction_static = tissue.friction_sliding = kFriction;
  Handle6 handle;
  handle.translation = {2000, 20};
  handle.rotation = {5, 0.05};
  handle.max_force = 50;
  handle.max_torque = 5;
  return stage.add_soft(std::move(paddle), tissue, {kPaddleStart}, &handle);
}

void add_bed(ToolStage& stage, StudBed bed) {
  RigidBody ground;
  ground.fixed = true;
  ground.friction_static = ground.friction_sliding = kFriction;
  for (int i = 0; i < bed.grounds; ++i) {
    const auto edge = [&](int k) { return kBed.x * (double(k) / bed.grounds - 0.5); };
    stage.add_rigid(studs(edge(i), edge(i + 1), bed.along, bed.across), ground, {});
  }
}

dvec3 paddle_path(double time) {
  const double down = std::min(1.0, time / kPaddlePressed),
               turned = std::max(0.0, time - kPaddlePressed) / kTurn * 2 * M_PI;
  return kPaddleStart +
         dvec3(kCircle * std::sin(turned), -down * (kPaddleStart.y + kDepth), kCircle * (1 - std::cos(turned)));
}

}  // namespace pliant::scenes
