// Time of a frame: milliseconds from upload to the finished frame (median), and the bytes uploaded, for bodies of
// increasing resolution at two sizes. A tenth of the zones changes before every frame. The error is the largest
// component of the difference between the stream on the GPU and the one sent; it must be 0.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "scenes/scenes.h"
#include "systems/visual/gpu/context.h"
#include "systems/visual/renderer.h"
#include "systems/visual/upload.h"

namespace pliant {
namespace {

constexpr int kFrames = 11;

struct Row {
  std::uint32_t triangles = 0;
  int width = 0, height = 0;
  double ms = 0;              // median
  std::uint64_t bytes = 0;    // of the last frame
  std::uint64_t allowed = 0;  // 16 x awake vertices + 4 KiB
};

// The object's first tenth of zones, dented by `height` [m].
Snapshot tenth(const World& world, Entity object, float height) {
  const Mesh& mesh = world.meshes[world.registry.get<Deformable>(object).mesh];
  ObjectSnapshot changed;
  changed.object = object;
  changed.zone_count = std::max(1u, mesh.zone_count() / 10);
  for (std::uint32_t zone = 0; zone < changed.zone_count; ++zone) {
    changed.zones.push_back(zone);
    changed.awake_vertices += mesh.zone_end(zone) - mesh.zone_begin(zone);
  }
  changed.stream.assign(std::size_t{changed.zone_count} * kZoneSize, vec4(0, 0, 0, height));
  Snapshot snapshot;
  snapshot.objects.push_back(std::move(changed));
  return snapshot;
}

double error_of_upload() {
  std::vector<vec4> sent;
  for (std::size_t i = 0; i < 64 * kZoneSize; ++i)
    sent.push_back(vec4(0.1f, -0.2f, 0.3f, 1e-3f) * std::sin(static_cast<float>(i)));
  StreamCopies copies(std::vector<vec4>(sent.size(), vec4(0)));
  std::vector<std::uint32_t> zones;
  for (std::uint32_t zone = 0; zone < 64; ++zone) zones.push_back(zone);
  copies.take(zones, sent);
  copies.upload();
  std::vector<vec4> found(sent.size());
  glGetNamedBufferSubData(copies.buffer().id(), 0, static_cast<GLsizeiptr>(found.size() * sizeof(vec4)), found.data());
  double worst = 0;
  for (std::size_t i = 0; i < sent.size(); ++i)
    for (int c = 0; c < 4; ++c) worst = std::max(worst, std::abs(double{found[i][c]} - double{sent[i][c]}));
  return worst;
}

Result<std::vector<Row>> measure(int n) {
  scenes::Stage stage;
  const Entity object = stage.add(scenes::sphere(n, 0.1), Deformable{});
  const Mesh& mesh = stage.mesh(object);
  World& world = stage.world;
  DrawMesh draw;
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v)
    draw.vertices.push_back({.position = mesh.position(v), .normal = mesh.normal(v), .touch_vertex = v});
  for (const uvec3 t : mesh.triangles) draw.indices.insert(draw.indices.end(), {t.x, t.y, t.z});
  draw.parts = {{0, static_cast<std::uint32_t>(draw.indices.size()), -1}};
  world.registry.add<Drawable>(object, {world.draw_meshes.add(std::move(draw))});
  Result<std::unique_ptr<Renderer>> renderer = Renderer::create(world);
  if (!renderer) return renderer.error();
  std::vector<Row> rows;
  for (const int height : {180, 720}) {
    Row row{static_cast<std::uint32_t>(mesh.triangles.size()), height * 16 / 9, height, 0, 0, 0};
    std::vector<double> times;
    for (int i = 0; i < kFrames + 2; ++i) {
      const Snapshot snapshot = tenth(world, object, 1e-4f * static_cast<float>(i));
      (*renderer)->update(snapshot);
      FrameStats stats;
      (*renderer)->picture(default_viewpoint(world), row.width, row.height, &stats);
      row.bytes = stats.upload_bytes;
      row.allowed = std::uint64_t{16} * snapshot.objects[0].awake_vertices + 4096;
      if (i >= 2) times.push_back(stats.draw_ms);  // the first include shader compilation
    }
    row.ms = median(times);
    rows.push_back(row);
  }
  return rows;
}

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  using namespace pliant;
  const BenchArguments arguments(argc, argv);
  Result<std::unique_ptr<HeadlessContext>> context = HeadlessContext::create();
  if (!context) {
    fmt::print(stderr, "bench_visual: error: {}\n", context.error().message());
    return 1;
  }
  const double error = error_of_upload();
  fmt::print("{}; median of {} frames; upload error {:.1e}\n", (*context)->renderer_name(), kFrames, error);
  fmt::print("{:>10} {:>10} {:>9} {:>12} {:>12}\n", "triangles", "pixels", "ms", "bytes/frame", "allowed");
  std::string json = fmt::format("{{\n  \"renderer\": \"{}\",\n  \"upload_error\": {:.3e},\n  \"frames\": [",
                                 (*context)->renderer_name(), error);
  bool first = true;
  for (const int n : {20, 65, 205}) {
    Result<std::vector<Row>> rows = measure(n);
    if (!rows) {
      fmt::print(stderr, "bench_visual: error: {}\n", rows.error().message());
      return 1;
    }
    for (const Row& r : *rows) {
      fmt::print("{:>10} {:>10} {:>9.2f} {:>12} {:>12}\n", r.triangles, fmt::format("{}x{}", r.width, r.height), r.ms,
                 r.bytes, r.allowed);
      json += fmt::format(
          "{}\n    {{\"triangles\": {}, \"width\": {}, \"height\": {}, \"ms\": {:.3f}, \"upload_bytes\": {}, "
          "\"allowed_bytes\": {}}}",
          first ? "" : ",", r.triangles, r.width, r.height, r.ms, r.bytes, r.allowed);
      first = false;
    }
  }
  arguments.save(json + "\n  ]\n}\n");
}
