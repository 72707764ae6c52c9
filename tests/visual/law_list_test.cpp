// The laws and shapes of components/built_in.h on the GPU, against the same text on the CPU.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/touch_laws.h"
#include "systems/touch/model/shape.h"
#include "systems/visual/gpu/context.h"
#include "systems/visual/gpu/program.h"
#include "systems/visual/gpu/shader_source.h"
#include "tests/visual/read_back.h"

namespace pliant {
namespace {

class LawList : public testing::Test {
 protected:
  void SetUp() override {
    Result<std::unique_ptr<HeadlessContext>> made = HeadlessContext::create();
    if (!made) GTEST_SKIP() << made.error().message();
    context_ = *std::move(made);
  }
  // One vec4 for each input.
  std::vector<vec4> run(const gpu::Program& program, const std::vector<vec4>& inputs) {
    program.use();
    const gpu::Buffer in = gpu::Buffer::fixed<vec4>(inputs);
    const gpu::Buffer out = gpu::Buffer::writable(nullptr, inputs.size() * sizeof(vec4));
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, in.id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, out.id());
    glDispatchCompute(static_cast<GLuint>(inputs.size()), 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    return read_back<vec4>(out, inputs.size());
  }

 private:
  std::unique_ptr<HeadlessContext> context_;
};

TEST_F(LawList, EveryLawHasTheGpusForceTangentAndMeanForceOfTheCpus) {
  Result<gpu::ShaderSource> source = gpu::expand_shader("laws.comp", R"(
#define SHARED
#include "law.glsl"
layout(local_size_x = 1) in;
layout(std430, binding = 0) readonly buffer In { vec4 given[]; };
layout(std430, binding = 1) writeonly buffer Out { vec4 result[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  LawAt at = law_between(given[i].x, given[i].y, law_keep(given[i].x));
  result[i] = vec4(law_force(given[i].x), law_slope(given[i].x), at.force, at.gradient);
}
)");
  ASSERT_TRUE(source) << source.error().message();
  Result<gpu::Program> program = gpu::Program::link({&*source, 1});
  ASSERT_TRUE(program) << program.error().message();
  std::vector<vec4> given;
  for (const float h : {-9e-3f, -1e-3f, -1e-6f, 1e-6f, 1e-3f, 5e-3f})
    for (const float d : {-4e-3f, -1e-5f, 2e-5f, 7e-3f}) given.emplace_back(h, d, 0, 0);
  for (const SpringLaw kind : kLaws)
    for (const double stiffening : {150.0, -80.0, 1e-6}) {
      RestoringLaw law{kind, 1e5, stiffening};
      law.table = restoring_law(frictionless(SpringLaw::kTable)).table;
      program->use();
      for (std::uint32_t i = 0; i < law.table.count; ++i) {
        const CubicPiece& p = law.table.piece[i];
        const vec4 place(p.at, p.value, p.slope, p.second), curve(p.third, p.integral, 0, 0);
        const auto row = [&](const char* name, const vec4& value) {
          const std::string at = std::string(name) + '[' + std::to_string(i) + ']';
          glUniform4fv(glGetUniformLocation(program->id(), at.c_str()), 1, &value.x);
        };
        row("table_place", place);
        row("table_curve", curve);
      }
      glUniform1i(glGetUniformLocation(program->id(), "table_count"), static_cast<GLint>(law.table.count));
      const auto number = [&](const char* name, double value) {
        glUniform1f(glGetUniformLocation(program->id(), name), static_cast<float>(value));
      };
      glUniform1ui(glGetUniformLocation(program->id(), "law"), static_cast<GLuint>(kind));
      number("cubic", law.cubic);
      number("stiffening", law.stiffening);
      const std::vector<vec4> got = run(*program, given);
      for (std::size_t i = 0; i < given.size(); ++i) {
        const double h0 = double(given[i].x), h1 = h0 + double(given[i].y);
        const double scale = std::abs(law.force(h0)) + std::abs(law.force(h1));
        SCOPED_TRACE(std::string(word_of(kind)) + ' ' + std::to_string(stiffening) + " at " + std::to_string(h0) +
                     " to " + std::to_string(h1));
        EXPECT_NEAR(got[i].x, law.force(h0), 1e-6 * std::abs(law.force(h0)));
        EXPECT_NEAR(got[i].y, law.slope(h0), 1e-6 * law.slope(h0));
        EXPECT_NEAR(got[i].z, law.force(h1), 2e-6 * scale);
        EXPECT_NEAR(got[i].w, law.discrete_gradient(h0, h1), 4e-6 * scale);
      }
    }
}

TEST_F(LawList, EveryShapeHasTheGpusTargetOfTheCpus) {
  Result<gpu::ShaderSource> source = gpu::expand_shader("shapes.comp", R"(
#define SHARED
  #include "shared/shape.glsl"
  #include "shared/field.glsl"
#include "shape_list.glsl"
uniform int shape;
uniform float parameter;
layout(local_size_x = 1) in;
layout(std430, binding = 0) readonly buffer In { vec4 given[]; };
layout(std430, binding = 1) writeonly buffer Out { vec4 result[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  vec3 up = vec3(0, 1, 0);
  result[i] = field_of_shape(shape, given[i].xyz, up, up, 1.0, 1.0, parameter);
}
)");
  ASSERT_TRUE(source) << source.error().message();
  Result<gpu::Program> program = gpu::Program::link({&*source, 1});
  ASSERT_TRUE(program) << program.error().message();
  std::vector<vec4> given;
  for (float r = 0.0f; r < 1.0f; r += 0.037f) given.emplace_back(0.6f * r, 0.0f, 0.8f * r, 0.0f);
  for (const Shape shape : kEveryShape) {
    SCOPED_TRACE(word_of(shape));
    FieldSource here;  // of reach 1
    here.amplitude = 1.0f;
    here.shape = shape;
    here.parameter = shape_parameter(shape, 0.2, 1.0, 1.0);
    program->use();
    glUniform1i(glGetUniformLocation(program->id(), "shape"), static_cast<GLint>(shape));
    glUniform1f(glGetUniformLocation(program->id(), "parameter"), here.parameter);
    const std::vector<vec4> got = run(*program, given);
    for (std::size_t i = 0; i < given.size(); ++i) {
      const vec4 want = target_at(here, vec3(given[i]), here.normal);
      EXPECT_LT(length(got[i] - want), 1e-5f * (1.0f + length(want))) << given[i].x;
    }
  }
}

}  // namespace
}  // namespace pliant
