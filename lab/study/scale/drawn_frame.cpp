#include "lab/study/scale/drawn_frame.h"

#include <ctime>
#include <utility>

#include "lab/study/processor_time.h"
#include "systems/touch/feed/publish.h"

namespace pliant {

bool draws_with_cpu(const std::string& renderer) {
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SwiftShader"})
    if (renderer.find(name) != std::string::npos) return true;
  return false;
}

Result<DrawnFrames> DrawnFrames::create(World& world, Entity surface, bool with_cpu) {
  const Mesh& mesh = world.meshes[world.registry.get<Deformable>(surface).mesh];
  DrawMesh draw;
  draw.vertices.reserve(mesh.vertex_count);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v)
    draw.vertices.push_back({.position = mesh.position(v), .normal = mesh.normal(v), .touch_vertex = v});
  draw.indices.reserve(3 * mesh.triangles.size());
  for (const uvec3 t : mesh.triangles) draw.indices.insert(draw.indices.end(), {t.x, t.y, t.z});
  draw.parts = {{0, static_cast<std::uint32_t>(draw.indices.size()), -1}};
  world.registry.add<Drawable>(surface, {world.draw_meshes.add(std::move(draw))});
  DrawnFrames frames;
  Result<std::unique_ptr<Renderer>> renderer = Renderer::create(world);
  if (!renderer) return renderer.error();
  frames.renderer_ = std::move(renderer).value();
  frames.viewpoint_ = default_viewpoint(world);
  frames.with_cpu_ = with_cpu;
  return frames;
}

double DrawnFrames::draw(World& world, Tick tick) {
  const clockid_t clock = with_cpu_ ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC;
  const std::uint64_t begin = processor_ns(clock);
  do {
    publish(world, tick);
    renderer_->take(world);
  } while (waits_to_be_published(world));
  picture_ = renderer_->picture(viewpoint_, kDrawnWidth, kDrawnHeight);
  return static_cast<double>(processor_ns(clock) - begin) * 1e-3;
}

}  // namespace pliant
