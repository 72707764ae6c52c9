// The field on the GPU: shaders/field.comp writes an object's stream from the list of sources that the touch clock
// publishes (systems/touch/model/field.h). Rest positions and normals are uploaded once; per frame, 48 bytes per
// source.
#pragma once

#include <cstdint>
#include <span>
#include <utility>

#include "components/field_source.h"
#include "components/mesh.h"
#include "runtime/result.h"
#include "systems/visual/gpu/buffer.h"
#include "systems/visual/gpu/program.h"

namespace pliant {

// One source in the shader's layout.
struct GpuSource {
  vec4 place, push, kind;
};
GpuSource gpu_source(const FieldSource& source);

// Rest positions and normals in field.comp's layout: (P0, N0.x), and (N0.y, N0.z).
std::pair<gpu::Buffer, gpu::Buffer> rest_on_gpu(const Mesh& mesh);

// Compiles the shader; shared by all objects.
class FieldProgram {
 public:
  static Result<FieldProgram> make();

 private:
  friend class FieldOnGpu;
  gpu::Program program_;
  GLint source_count_ = -1, vertex_count_ = -1;
};

// One object's field.
class FieldOnGpu {
 public:
  FieldOnGpu() = default;
  explicit FieldOnGpu(const Mesh& mesh);

  // Writes the whole stream of whole zones into `stream` (kZoneSize x zones vec4). Returns the bytes uploaded. Does
  // nothing if the field was and is at rest.
  std::size_t evaluate(const FieldProgram& program, std::span<const FieldSource> sources, const gpu::Buffer& stream);
  bool at_rest() const { return at_rest_; }  // the stream is all zeros

 private:
  std::uint32_t vertices_ = 0;
  bool at_rest_ = true;
  gpu::Buffer rest_, rest_yz_;
  gpu::GrowingBuffer sources_;
};

}  // namespace pliant
