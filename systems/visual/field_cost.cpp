#include "systems/visual/field_cost.h"

#include <algorithm>
#include <array>

#include "systems/touch/model/field_kernels.h"
#include "systems/visual/field_gpu.h"

namespace pliant {
namespace {

constexpr int kRepeats = 9;

// Median of a few runs. [us]
template <class Work>
double median_us(Work work) {
  std::array<double, kRepeats> times;
  for (double& time : times) {
    const std::uint64_t start = now_ns();
    work();
    time = static_cast<double>(now_ns() - start) * 1e-3;
  }
  std::sort(times.begin(), times.end());
  return times[kRepeats / 2];
}

}  // namespace

Result<FieldCost> measure_field_cost(const World& world, double frame_rate) {
  if (gpu::is_es()) return Error{"field", "the GPU computes no field in OpenGL ES 3.0"};
  const Mesh* mesh = nullptr;
  const Deformable* deformable = nullptr;
  for (auto [entity, d] : world.registry.view<Deformable>()) {
    const Mesh& m = world.meshes[d.mesh];
    if (!has_closed_form(d, m)) continue;  // the CPU steps it in either case
    if (!mesh || m.vertex_count > mesh->vertex_count) mesh = &m, deformable = &d;
  }
  if (!mesh) return Error{"field", "no deformable's field is cheaper for the GPU"};
  Result<FieldProgram> program = FieldProgram::make();
  if (!program) return program.error();

  FieldSource source;
  source.center = mesh->position(0);
  source.normal = mesh->normal(0);
  source.amplitude = 1e-3f;
  const float reach = static_cast<float>(deformable->reach > 0 ? deformable->reach : default_reach(*mesh));
  source.inv_reach2 = 1 / (reach * reach);
  source.shape = deformable->shape;
  source.parameter = shape_parameter(source.shape, 0.2 * double(reach), double(reach), 1.0);

  FieldCost cost;
  std::vector<std::uint32_t> zones;
  for (std::uint32_t zone = 0; zone < mesh->zone_count(); ++zone) {
    const Box& box = mesh->zone_box[zone];
    const vec3 d = glm::max(glm::max(box.min - source.center, source.center - box.max), vec3(0));
    if (dot(d, d) < reach * reach) zones.push_back(zone);
  }
  float sink = 0;
  const double tick = median_us([&] {
    for (const std::uint32_t zone : zones) {
      ZoneTargets targets;
      add_targets(*mesh, zone, source, true, targets);
      sink += targets.h[0];
    }
  });
  cost.processor_us = tick * world.simulation.touch_rate / frame_rate + (sink > 1e30f ? 1 : 0);

  FieldOnGpu field(*mesh);
  const gpu::Buffer stream = gpu::Buffer::writable(nullptr, std::size_t{mesh->zone_count()} * kZoneSize * sizeof(vec4));
  const std::array<FieldSource, 2> sources{source, source};
  cost.gpu_us = median_us([&] {
    field.evaluate(*program, sources, stream);
    glFinish();
  });
  return cost;
}

}  // namespace pliant
