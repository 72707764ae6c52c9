// The parts of a touch tick, and of loading, one by one. For an approximation, a counter shows its error beside its
// time.
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "content/level_file.h"
#include "content/mesh/mesh_build.h"
#include "scenes/scenes.h"
#include "systems/touch/collide/box_tree.h"
#include "systems/touch/collide/surface_query.h"
#include "systems/touch/collide/triangle_tree.h"
#include "systems/touch/model/amplitude.h"
#include "systems/touch/model/field_kernels.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant {
namespace {

using scenes::Stage;

// The free motion of one zone (128 vertices) under each law.
void step_zone(benchmark::State& state) {
  Stage stage;
  Deformable d;
  d.reach = 0.03;
  d.spring = static_cast<SpringLaw>(state.range(0));
  const Entity surface = stage.add(scenes::sheet(40, 0.2), d);
  stage.prepare();
  HeightField& field = stage.field(surface);
  const Motion m = motion(d, 1e-3);
  std::vector<vec4> start(kZoneSize, vec4(0.1f, 0.1f, 0.1f, -0.004f));
  HeightState truth{-0.004, 0};
  double error = 0;
  int n = 0;
  for (auto _ : state) {
    if (n++ % 50 == 0) {  // restart before the motion has decayed
      std::copy(start.begin(), start.end(), field.residual.begin());
      std::fill_n(field.rate.begin(), kZoneSize, vec4(0));
      if (!field.arm.empty()) std::fill_n(field.arm.begin(), kZoneSize, vec4(0));
      truth = {-0.004, 0};
    }
    benchmark::DoNotOptimize(step_residual(m, {}, field, 0));
    truth = m.nonlinear() ? step_restoring(m.law, truth, m.mass, m.damping, 1, 0, m.dt)
                          : step_oscillator(truth, m.mass, m.damping, 1, 0, m.dt);
    if (d.spring != SpringLaw::kStandardLinearSolid)
      error = std::max(error, std::abs(field.residual[5].w - truth.height) / 0.004);
  }
  state.counters["error"] = error;
  state.counters["ns_per_vertex"] =
      benchmark::Counter(kZoneSize * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(step_zone)->Arg(0)->Arg(1)->Arg(2)->Arg(3)->ArgName("law");

// The targets of one zone under each shape.
void targets(benchmark::State& state) {
  Stage stage;
  const Entity surface = stage.add(scenes::sphere(40, 0.1), {});
  const Mesh& mesh = stage.mesh(surface);
  FieldSource source;
  source.center = mesh.position(0);
  source.normal = mesh.normal(0);
  source.amplitude = 0.004f;
  source.inv_reach2 = 1 / (0.05f * 0.05f);
  source.shape = static_cast<Shape>(state.range(0));
  source.parameter = shape_parameter(source.shape, 0.01, 0.05, 1.0);
  ZoneTargets out{};
  for (auto _ : state) {
    add_targets(mesh, 0, source, false, out);
    benchmark::ClobberMemory();
  }
  out = {};
  add_targets(mesh, 0, source, false, out);
  double error = 0;
  for (std::uint32_t v = mesh.zone_begin(0); v < mesh.zone_end(0); ++v) {
    const vec4 one = target_at(source, mesh.position(v), mesh.normal(v));
    error = std::max<double>(error, std::abs(out.h[v] - one.w) / source.amplitude);
  }
  state.counters["error"] = error;
}
BENCHMARK(targets)->DenseRange(0, std::size(kShapeRows) - 1)->ArgName("shape");

// Points within 4 mm of a sphere, inside and outside.
std::vector<dvec3> points_near_a_sphere(double radius) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<dvec3> points;
  points.reserve(1000);
  for (int i = 0; i < 1000; ++i)
    points.push_back((radius + 0.004 * unit(random)) * normalize(dvec3(unit(random), unit(random), unit(random))));
  return points;
}

void nearest_query(benchmark::State& state) {
  Stage stage;
  const Entity surface = stage.add(scenes::sphere(static_cast<int>(state.range(0)), 0.1), {});
  const Mesh& mesh = stage.mesh(surface);
  const std::vector<dvec3> points = points_near_a_sphere(0.1);
  std::size_t i = 0;
  double error = 0;
  for (auto _ : state) {
    const dvec3 x = points[i++ % points.size()];
    const SurfaceFoot p = nearest(mesh, x, 1);
    error = std::max(error, std::abs(p.height - (length(x) - 0.1)));  // the sphere's error includes that of its
                                                                      // triangulation
  }
  state.counters["error_m"] = error;
}
BENCHMARK(nearest_query)->Arg(41)->Arg(130)->Arg(409)->ArgName("n");

// The closest point of the flat triangles alone; `hint`: with the triangle found for a point 0.1 mm away.
void closest_query(benchmark::State& state) {
  Stage stage;
  const Entity surface = stage.add(scenes::sphere(static_cast<int>(state.range(0)), 0.1), {});
  const Mesh& mesh = stage.mesh(surface);
  const std::vector<dvec3> points = points_near_a_sphere(0.1);
  std::vector<std::uint32_t> hints;
  for (const dvec3& x : points)
    hints.push_back(state.range(1) ? closest_flat(mesh, x + dvec3(1e-4, 0, 0), 1).triangle : FlatPoint::kNone);
  std::size_t i = 0;
  double error = 0;
  for (auto _ : state) {
    const std::size_t k = i++ % points.size();
    const FlatPoint p = closest_flat(mesh, points[k], 1, hints[k]);
    error = std::max(error, std::abs(std::sqrt(p.distance2) - std::abs(length(points[k]) - 0.1)));
  }
  state.counters["error_m"] = error;
}
BENCHMARK(closest_query)->ArgsProduct({{41, 130, 409}, {0, 1}})->ArgNames({"n", "hint"});

// Objects of 20 mm side by side on a table: which ones a probe's box overlaps; one object moves after every second
// query.
void boxes_met(benchmark::State& state) {
  const auto side = static_cast<int>(std::sqrt(static_cast<double>(state.range(0))) + 0.5);
  std::vector<Box> boxes;
  for (int i = 0; i < side * side; ++i) {
    const vec3 at(0.03f * static_cast<float>(i % side), 0, 0.03f * static_cast<float>(i / side));
    boxes.push_back({at, at + vec3(0.02f)});
  }
  BoxTree tree(boxes);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0, 1);
  const float across = 0.03f * static_cast<float>(side);
  std::size_t met = 0, moves = 0;
  for (auto _ : state) {
    const vec3 at(across * unit(random), 0.01f, across * unit(random));
    tree.visit({at - vec3(0.005f), at + vec3(0.005f)}, [&](std::uint32_t) { ++met; });
    if (++moves % 2 == 0) {
      const std::uint32_t id = static_cast<std::uint32_t>(random() % boxes.size());
      const vec3 by(0.004f * unit(random), 0, 0.004f * unit(random));
      tree.move(id, {boxes[id].min + by, boxes[id].max + by});
    }
  }
  state.counters["met"] = benchmark::Counter(static_cast<double>(met), benchmark::Counter::kAvgIterations);
}
BENCHMARK(boxes_met)->Arg(36)->Arg(400)->Arg(4096)->ArgName("objects");

void track_along(benchmark::State& state) {
  Stage stage;
  const Entity surface = stage.add(scenes::sphere(static_cast<int>(state.range(0)), 0.1), {});
  const Mesh& mesh = stage.mesh(surface);
  SurfaceFoot p = nearest(mesh, {0, 0.098, 0}, 1);
  double a = 0, error = 0;
  for (auto _ : state) {
    a += 0.3 * mesh.mean_edge / 0.1;
    const dvec3 x = 0.098 * normalize(dvec3(std::sin(a), std::cos(a), 0.3 * std::sin(0.31 * a)));
    p = track(mesh, p, x).point;
    error = std::max(error, std::abs(p.height + 0.002));
  }
  state.counters["error_m"] = error;
}
BENCHMARK(track_along)->Arg(41)->Arg(409)->ArgName("n");

void amplitudes(benchmark::State& state) {
  const std::size_t n = static_cast<std::size_t>(state.range(0));
  std::vector<double> A(n * n), d(n), alpha(n);
  for (std::size_t i = 0; i < n; ++i) {
    d[i] = 0.004 + 0.0003 * static_cast<double>(i % 5);
    for (std::size_t j = 0; j < n; ++j)
      A[i * n + j] = i == j ? 1.0 : 0.3 * std::exp(-0.5 * std::abs(double(i) - double(j)));
  }
  double violation = 0;
  for (auto _ : state) {
    std::fill(alpha.begin(), alpha.end(), 0.0);
    violation = solve_amplitudes(A, d, alpha);
  }
  state.counters["violation_m"] = violation;
}
BENCHMARK(amplitudes)->Arg(2)->Arg(4)->Arg(16)->ArgName("contacts");

// A GLB of about a million triangles in the temporary folder, removed at the end; empty: not written.
struct MillionFile {
  std::filesystem::path path = std::filesystem::temp_directory_path() / "pliant_bench_million.glb";
  explicit MillionFile(benchmark::State& state) {
    Level level;
    level.name = "million";
    level.meshes.push_back({"ball", {scenes::sphere(289, 0.1)}});
    LevelNode node;
    node.name = "ball";
    node.mesh = 0;
    node.deformable = Deformable{};
    level.nodes.push_back(node);
    if (Status saved = save_level(level, path); !saved) state.SkipWithError(saved.error().message().c_str());
  }
  ~MillionFile() { std::filesystem::remove(path); }
};

// From the file to ready for touch: load, spawn, prepare.
void load_million(benchmark::State& state) {
  const MillionFile file(state);
  double bytes = 0, triangles = 0;
  for (auto _ : state) {
    Result<Level> loaded = load_level(file.path);
    Result<World> world = spawn(*loaded);
    if (!prepare_touch(*world)) state.SkipWithError("not touchable");
    for (auto [entity, d] : world->registry.view<Deformable>()) {
      const Mesh& mesh = world->meshes[d.mesh];
      triangles = static_cast<double>(mesh.triangles.size());
      bytes = static_cast<double>(touch_bytes(mesh, world->fields[d.field])) / mesh.vertex_count;
    }
  }
  state.counters["triangles"] = triangles;
  state.counters["touch_bytes_per_vertex"] = bytes;
}
BENCHMARK(load_million)->Unit(benchmark::kMillisecond)->Iterations(3);

// The file alone: container, checks, arrays.
void read_million(benchmark::State& state) {
  const MillionFile file(state);
  double triangles = 0;
  for (auto _ : state) {
    const Result<Level> loaded = load_level(file.path);
    triangles = static_cast<double>(loaded->meshes[0].primitives[0].index.size()) / 3.0;
  }
  state.counters["triangles"] = triangles;
}
BENCHMARK(read_million)->Unit(benchmark::kMillisecond)->Iterations(10);

}  // namespace
}  // namespace pliant

BENCHMARK_MAIN();
