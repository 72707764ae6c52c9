// The field on the CPU against the field on the GPU, from 1e4 vertices up: the time of a whole evaluation on each, the
// CPU's time when only the reached zones move, the difference of the results, and the share of the GPU's measured copy
// bandwidth that the compute shader uses. GPU times are the GPU's own (timer queries); `until done` is the CPU's time
// from the call until the GPU has finished.
//   bench_field [--large] [--out FILE.json]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "runtime/clock.h"
#include "scenes/scenes.h"
#include "systems/touch/model/field_kernels.h"
#include "systems/visual/field_gpu.h"
#include "systems/visual/gpu/context.h"

namespace pliant {
namespace {

template <class Work>
double median_us(int repeats, Work work) {
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const std::uint64_t start = now_ns();
    work();
    times.push_back(static_cast<double>(now_ns() - start) * 1e-3);
  }
  return median(std::move(times));
}

// Median of the GPU's own time of `work`; of a renderer on the CPU, which starts with the wait, until it has finished.
// [us]
template <class Work>
double median_gpu_us(int repeats, bool on_cpu, Work work) {
  if (on_cpu)
    return median_us(repeats, [&] {
      work();
      glFinish();
    });
  GLuint query = 0;
  glCreateQueries(GL_TIME_ELAPSED, 1, &query);
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    glBeginQuery(GL_TIME_ELAPSED, query);
    work();
    glEndQuery(GL_TIME_ELAPSED);
    GLuint64 ns = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &ns);
    times.push_back(static_cast<double>(ns) * 1e-3);
  }
  glDeleteQueries(1, &query);
  return median(std::move(times));
}

// A compute shader that copies vec4 i: the bandwidth that a shader can have. 0 if the driver refuses it.
GLuint copy_program() {
  const char* text = R"(#version 450
layout(local_size_x = 128) in;
layout(std430, binding = 0) readonly buffer From { vec4 from[]; };
layout(std430, binding = 1) writeonly buffer To { vec4 to[]; };
void main() { if (gl_GlobalInvocationID.x < from.length()) to[gl_GlobalInvocationID.x] = from[gl_GlobalInvocationID.x]; }
)";
  return glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &text);
}

struct Row {
  std::uint32_t vertices = 0, reached = 0;
  double reached_us = 0, whole_us = 0, gpu_us = 0, until_done_us = 0, copy_us = 0;
  double height_error = 0;  // [1] of the largest height
  double normal_error = 0;  // [deg]
};

// Two overlapping contacts that reach about 2,000 vertices each.
Row measure(const FieldProgram& program, bool on_cpu, int n) {
  scenes::Stage stage;
  const Entity surface = stage.add(scenes::sphere(n, 0.1), {});
  const Mesh& mesh = stage.mesh(surface);
  Row row;
  row.vertices = mesh.vertex_count;
  const float reach = static_cast<float>(0.2 * std::sqrt(0.55 * 2000.0 / mesh.vertex_count));
  std::vector<FieldSource> sources;
  for (const std::uint32_t v : {0u, 40u}) {
    FieldSource s;
    s.center = mesh.position(v);
    s.normal = mesh.normal(v);
    s.amplitude = 0.1f * reach;
    s.inv_reach2 = 1 / (reach * reach);
    s.parameter = 5.0f;
    sources.push_back(s);
  }
  const std::uint32_t zones = mesh.zone_count();
  std::vector<vec4> here(std::size_t{zones} * kZoneSize);
  const auto zone_field = [&](std::uint32_t zone) {
    ZoneTargets t{};
    for (const FieldSource& s : sources) add_targets(mesh, zone, s, false, t);
    for (std::uint32_t i = 0; i < kZoneSize; ++i) here[zone * kZoneSize + i] = vec4(t.nx[i], t.ny[i], t.nz[i], t.h[i]);
  };
  std::vector<std::uint32_t> near;
  for (std::uint32_t zone = 0; zone < zones; ++zone) {
    for (const FieldSource& s : sources) {
      const Box& box = mesh.zone_box[zone];
      const vec3 d = glm::max(glm::max(box.min - s.center, s.center - box.max), vec3(0));
      if (dot(d, d) < reach * reach) {
        near.push_back(zone);
        break;
      }
    }
  }
  row.reached = static_cast<std::uint32_t>(near.size()) * kZoneSize;
  row.reached_us = median_us(51, [&] {
    for (const std::uint32_t zone : near) zone_field(zone);
  });
  row.whole_us = median_us(5, [&] {
    for (std::uint32_t zone = 0; zone < zones; ++zone) zone_field(zone);
  });

  const std::size_t bytes = here.size() * sizeof(vec4);
  const gpu::Buffer stream = gpu::Buffer::writable(nullptr, bytes);
  FieldOnGpu field(mesh);
  row.until_done_us = median_us(15, [&] {
    field.evaluate(program, sources, stream);
    glFinish();
  });
  row.gpu_us = median_gpu_us(15, on_cpu, [&] { field.evaluate(program, sources, stream); });
  std::vector<vec4> gpu(here.size());
  glGetNamedBufferSubData(stream.id(), 0, static_cast<GLsizeiptr>(bytes), gpu.data());
  double largest = 0;
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    largest = std::max<double>(largest, std::abs(here[v].w));
    row.height_error = std::max<double>(row.height_error, std::abs(here[v].w - gpu[v].w));
    const dvec3 a = normalize(dvec3(mesh.normal(v) + vec3(here[v]))),
                b = normalize(dvec3(mesh.normal(v) + vec3(gpu[v])));
    row.normal_error = std::max(row.normal_error, length(cross(a, b)) * 180 / M_PI);
  }
  row.height_error /= largest;
  // The shader reads 24 bytes per vertex and writes 16. A copy of 20 bytes reads and writes 20: the same 40.
  const std::size_t copied = std::size_t{20} * mesh.vertex_count / 16 * 16;
  const gpu::Buffer from = gpu::Buffer::writable(nullptr, copied), to = gpu::Buffer::writable(nullptr, copied);
  const GLuint copy = copy_program();
  glUseProgram(copy);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, from.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, to.id());
  row.copy_us =
      median_gpu_us(15, on_cpu, [&] { glDispatchCompute(static_cast<GLuint>((copied / 16 + 127) / 128), 1, 1); });
  glDeleteProgram(copy);
  return row;
}

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  using namespace pliant;
  const BenchArguments arguments(argc, argv, "--large");
  auto context = HeadlessContext::create();
  if (!context) {
    fmt::print("bench_field: {}\n", context.error().message());
    return 0;
  }
  const auto program = FieldProgram::make();
  if (!program) {
    fmt::print(stderr, "bench_field: {}\n", program.error().message());
    return 1;
  }
  GLint largest = 0;
  glGetIntegerv(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
  fmt::print("The field on {}\n", (*context)->renderer_name());
  fmt::print("{:>10} {:>9} {:>11} {:>11} {:>11} {:>14} {:>11} {:>8} {:>10} {:>10}\n", "vertices", "reached",
             "reached us", "whole us", "GPU us", "until done us", "copy us", "of copy", "height err", "normal deg");
  std::string json = fmt::format("{{\n  \"renderer\": \"{}\",\n  \"field\": [", (*context)->renderer_name());
  std::vector<int> sizes{41, 130, 409};
  if (arguments.on) sizes.push_back(1291);
  for (const int n : sizes) {
    if (std::size_t{6} * static_cast<std::size_t>(n * n) * 16 > static_cast<std::size_t>(largest)) {
      fmt::print("{:>10} vertices need more than the {} MiB that this driver gives a buffer\n", 6 * n * n,
                 largest >> 20);
      continue;
    }
    const Row r = measure(*program, (*context)->renderer_name().find("llvmpipe") != std::string::npos, n);
    fmt::print("{:>10} {:>9} {:>11.1f} {:>11.1f} {:>11.1f} {:>14.1f} {:>11.1f} {:>7.0f}% {:>10.1e} {:>10.1e}\n",
               r.vertices, r.reached, r.reached_us, r.whole_us, r.gpu_us, r.until_done_us, r.copy_us,
               100 * r.copy_us / r.gpu_us, r.height_error, r.normal_error);
    json += fmt::format(
        "{}\n    {{\"vertices\": {}, \"reached\": {}, \"processor_reached_us\": {:.2f}, \"processor_whole_us\": "
        "{:.1f}, "
        "\"gpu_us\": {:.1f}, \"gpu_until_done_us\": {:.1f}, \"gpu_copy_us\": {:.1f}, \"share_of_copy\": {:.3f}, "
        "\"height_error\": {:.2e}, "
        "\"normal_error_deg\": {:.2e}}}",
        n == 41 ? "" : ",", r.vertices, r.reached, r.reached_us, r.whole_us, r.gpu_us, r.until_done_us, r.copy_us,
        r.copy_us / r.gpu_us, r.height_error, r.normal_error);
  }
  json += "\n  ]\n}\n";
  arguments.save(json);
}
