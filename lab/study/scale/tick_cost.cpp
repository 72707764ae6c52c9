#include "lab/study/scale/tick_cost.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "lab/study/processor_time.h"
#include "lab/study/scale/drawn_frame.h"
#include "scenes/scenes.h"
#include "systems/touch/feed/publish.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant {
namespace {

using scenes::Stage;

double percentile(std::vector<double>& values, double q) {
  const auto at = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

constexpr int kTicksAFrame = 16;
constexpr int kWarmFrames = 1;  // includes shader compilation

// [us] Overhead of reading the clock.
double clock_us() {
  std::vector<double> times;
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t begin = processor_ns();
    times.push_back(static_cast<double>(processor_ns() - begin) * 1e-3);
  }
  return percentile(times, 0.5);
}

}  // namespace

TickCost measure_tick(std::uint32_t vertices, std::uint32_t awake, int ticks, int batches, DrawnCount drawn) {
  constexpr double kRadius = 0.1;  // [m]
  const int n = std::max(2, static_cast<int>(std::lround(std::sqrt((vertices - 2) / 6.0))));
  Stage stage;
  Deformable d;
  // Zones extend beyond the disc, so the disc must contain fewer vertices than are wanted awake.
  d.reach = 2 * kRadius * std::sqrt(std::min(0.9, 0.315 * awake / (6.0 * n * n + 2)));
  const Entity surface = stage.add(scenes::sphere(n, kRadius), d);
  const Entity probe = stage.add_probe({0, kRadius + 0.001, 0});
  stage.prepare();
  const Mesh& mesh = stage.mesh(surface);
  TickCost out;
  out.vertices = mesh.vertex_count;
  out.triangles = static_cast<std::uint32_t>(mesh.triangles.size());
  out.bytes = static_cast<double>(touch_bytes(mesh, stage.field(surface))) / mesh.vertex_count;
  const double depth = 0.1 * d.reach, clock = clock_us();
  stage.tick();
  std::vector<double> times, frames;
  const int warm = ticks / 20, batch = std::max(1, ticks / batches);
  out.p50_us = out.p99_us = out.frame_us = 1e30;
  const auto end_batch = [&] {
    out.batch_p50_us.push_back(percentile(times, 0.5));
    out.batch_p99_us.push_back(percentile(times, 0.99));
    out.p50_us = std::min(out.p50_us, out.batch_p50_us.back());
    out.p99_us = std::min(out.p99_us, out.batch_p99_us.back());
    out.frame_us = std::min(out.frame_us, percentile(frames, 0.5));
    times.clear();
    frames.clear();
  };
  const auto slide = [&](int i) {
    const double a = 0.33 * mesh.mean_edge / kRadius * i, b = 0.3 * std::sin(0.37 * a);
    stage.place(probe, normalize(dvec3(std::sin(a), std::cos(a), b)) * (kRadius - depth));
  };
  for (int i = 0; i < ticks + warm; ++i) {
    slide(i);
    std::uint64_t begin = processor_ns();
    stage.tick();
    const double us = std::max(0.0, static_cast<double>(processor_ns() - begin) * 1e-3 - clock);
    if (i < warm) continue;
    times.push_back(us);
    out.awake += stage.field(surface).awake_vertices / static_cast<double>(ticks);
    if (i % kTicksAFrame == 0) {
      begin = processor_ns();
      publish(stage.world, {});
      frames.push_back(std::max(0.0, static_cast<double>(processor_ns() - begin) * 1e-3 - clock));
      stage.world.snapshots->acquire();
    }
    if (times.size() == static_cast<std::size_t>(batch) && !frames.empty()) end_batch();
  }
  if (drawn.frames == 0) return out;
  Result<DrawnFrames> frame = DrawnFrames::create(stage.world, surface, drawn.with_cpu);
  if (!frame) {
    out.not_drawn = frame.error().message();
    return out;
  }
  frames.clear();
  for (int i = 0; i < kWarmFrames + drawn.frames; ++i) {
    for (int k = 0; k < kTicksAFrame; ++k) {
      slide(ticks + warm + kTicksAFrame * i + k);
      stage.tick();
    }
    const double us = frame->draw(stage.world, {});
    if (i >= kWarmFrames) frames.push_back(us);
  }
  out.drawn_us = percentile(frames, 0.5);
  return out;
}

}  // namespace pliant
