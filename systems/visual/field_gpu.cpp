#include "systems/visual/field_gpu.h"

#include <algorithm>
#include <tuple>
#include <vector>

#include "systems/visual/gpu/desktop.h"

namespace pliant {

GpuSource gpu_source(const FieldSource& s) {
  return {vec4(s.center, s.inv_reach2), vec4(s.normal, s.amplitude),
          vec4(s.parameter, static_cast<float>(s.shape), 0, 0)};
}

Result<FieldProgram> FieldProgram::make() {
  Result<gpu::Program> program = gpu::Program::load({"field.comp"});
  if (!program) return program.error();
  FieldProgram made;
  made.program_ = *std::move(program);
  made.source_count_ = glGetUniformLocation(made.program_.id(), "source_count");
  made.vertex_count_ = glGetUniformLocation(made.program_.id(), "vertex_count");
  return made;
}

std::pair<gpu::Buffer, gpu::Buffer> rest_on_gpu(const Mesh& mesh) {
  std::vector<vec4> rest(mesh.vertex_count);
  std::vector<vec2> rest_yz(mesh.vertex_count);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    rest[v] = vec4(mesh.position(v), mesh.nx[v]);
    rest_yz[v] = vec2(mesh.ny[v], mesh.nz[v]);
  }
  return {gpu::Buffer::fixed(std::span<const vec4>(rest)), gpu::Buffer::fixed(std::span<const vec2>(rest_yz))};
}

FieldOnGpu::FieldOnGpu(const Mesh& mesh) : vertices_(mesh.vertex_count) {
  std::tie(rest_, rest_yz_) = rest_on_gpu(mesh);
}

std::size_t FieldOnGpu::evaluate(const FieldProgram& program, std::span<const FieldSource> sources,
                                 const gpu::Buffer& stream) {
  if (sources.empty() && at_rest_) return 0;
  at_rest_ = sources.empty();
  std::vector<GpuSource> packed(sources.size());
  std::transform(sources.begin(), sources.end(), packed.begin(), gpu_source);
  const std::size_t travelled = sources_.write(std::span<const GpuSource>(packed));
  program.program_.use();
  glUniform1i(program.source_count_, static_cast<GLint>(sources.size()));
  glUniform1ui(program.vertex_count_, vertices_);
  const GLuint bindings[] = {stream.id(), rest_.id(), rest_yz_.id(), sources_.id()};
  for (GLuint i = 0; i < 4; ++i) gpu::desktop::bind_storage(i, bindings[i]);
  gpu::desktop::dispatch((vertices_ + kZoneSize - 1) / kZoneSize);
  return travelled;
}

}  // namespace pliant
