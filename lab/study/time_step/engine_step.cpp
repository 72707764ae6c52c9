#include "lab/study/time_step/engine_step.h"

#include <cmath>

#include "lab/study/driven_tool.h"
#include "lab/study/processor_time.h"
#include "scenes/tool_stage.h"

namespace pliant {
namespace {

constexpr int kBallCells = 10;     // 1,200 triangles
constexpr double kWideStep = 1.0;  // [m] width and depth of the ground

// Nearly prescribed motion: a newton moves the ball by 10 um.
Handle6 stiff_hold() {
  Handle6 handle;
  handle.translation = {1e5, 20.0};
  handle.rotation = {100.0, 0.1};
  handle.max_force = 1e4;
  handle.max_torque = 1e3;
  return handle;
}

}  // namespace

StepTrace engine_trace(const TissueScene& scene, StepMethod method, double step, double every, double* ms,
                       const std::function<bool(double)>& goes_on) {
  scenes::ToolStage stage(step);
  SoftBody body;
  body.young = scene.material.young;
  body.poisson = scene.material.poisson;
  body.density = scene.material.density;
  body.rayleigh = {scene.material.alpha, scene.material.beta};
  body.friction_static = body.friction_sliding = 0.0;
  body.velocity = scene.velocity;
  body.integrator = method;
  const Entity tissue = stage.add_soft(scene.mesh, body, {});
  RigidBody rigid;
  rigid.friction_static = rigid.friction_sliding = 0.0;
  const auto* ball = std::get_if<Ball>(&scene.obstacle);
  const Handle6 held = stiff_hold();
  if (ball) stage.add_rigid(scenes::sphere(kBallCells, ball->radius), rigid, {ball->middle(0.0)}, &held);
  if (const auto* ground = std::get_if<Ground>(&scene.obstacle)) {
    rigid.fixed = true;
    stage.add_rigid(scenes::box(dvec3(kWideStep), dvec3(0, ground->height - 0.5 * kWideStep, 0)), rigid, {});
  }
  stage.world.simulation.gravity = scene.gravity;
  stage.prepare();
  const int samples = static_cast<int>(std::lround(scene.seconds / every)),
            steps = static_cast<int>(std::lround(every / step));
  StepTrace trace;
  const std::uint64_t begin = process_ns();
  for (int i = 0; i < samples; ++i) {
    if (!goes_on(static_cast<double>(i) / samples)) return {};
    for (int k = 1; k <= steps; ++k) {
      const double end = every * i + step * k;
      if (ball) drive_tool(stage.world, {ball->middle(end)}, {ball->middle(end - step)}, step, end);
      stage.step();
    }
    trace.push_back(stage.tissue(tissue).tissue().position());
  }
  if (ms) *ms = static_cast<double>(process_ns() - begin) * 1e-6 / (samples * every);
  return trace;
}

}  // namespace pliant
