// The compute shader against the CPU's field, on scripted scenes with several probes.
#include "systems/visual/field_gpu.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/scenes.h"
#include "scenes/touch_laws.h"
#include "systems/touch/prepare/touch_state.h"
#include "systems/visual/gpu/context.h"
#include "tests/visual/read_back.h"

namespace pliant {
namespace {

using scenes::Stage;

TEST(FieldOnGpu, ComputesWhatTheProcessorStepsForEveryShapeAndLawItSupports) {
  Result<std::unique_ptr<HeadlessContext>> context = HeadlessContext::create();
  if (!context) GTEST_SKIP() << context.error().message();
  Result<FieldProgram> program = FieldProgram::make();
  ASSERT_TRUE(program.ok()) << program.error().message();
  for (const SpringLaw law : kLaws) {
    if (row_of(law).step != SpringStep::kExact) continue;
    for (const Shape shape : kEveryShape) {
      Deformable d;
      d.reach = 0.03;
      d.spring = law;
      d.shape = shape;
      Stage cpu, gpu;
      Entity surface[2];
      int n = 0;
      for (Stage* stage : {&cpu, &gpu}) {
        surface[n++] = stage->add(scenes::sphere(24, 0.1), d);
        const Entity a = stage->add_probe({0, 0.11, 0.01}), b = stage->add_probe({0.03, 0.11, -0.01});
        stage->world.field_place = stage == &cpu ? FieldPlace::kProcessor : FieldPlace::kGpu;
        stage->prepare();
        for (int i = 0; i < 250; ++i) {  // press, slide, and one leaves
          stage->place(a, (0.1 - 0.005 * std::min(1.0, i / 60.0)) * normalize(dvec3(std::sin(0.004 * i), 1, 0.1)));
          stage->place(b, (0.1 - 0.004 * std::min(1.0, i / 60.0) + (i > 230 ? 0.02 : 0)) *
                              normalize(dvec3(std::sin(0.004 * i) + 0.25, 1, -0.1)));
          stage->tick();
        }
      }
      const Mesh& mesh = gpu.mesh(surface[1]);
      const std::size_t size = std::size_t{mesh.zone_count()} * kZoneSize;
      const gpu::Buffer stream = gpu::Buffer::writable(nullptr, size * sizeof(vec4));
      FieldOnGpu field(mesh);
      const std::vector<FieldSource>& terms = gpu.world.touch->objects[0].terms;
      ASSERT_GE(terms.size(), 2u);
      EXPECT_EQ(field.evaluate(*program, terms, stream), terms.size() * sizeof(GpuSource))
          << "what travels is the list";
      const std::vector<vec4> got = read_back<vec4>(stream, mesh.vertex_count);
      double largest = 0, height = 0, angle = 0;
      for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        const vec4 want = cpu.field(surface[0]).stream[v];
        largest = std::max<double>(largest, std::abs(want.w));
        height = std::max<double>(height, std::abs(got[v].w - want.w));
        const dvec3 p = normalize(dvec3(mesh.normal(v) + vec3(got[v]))),
                    q = normalize(dvec3(mesh.normal(v) + vec3(want)));
        angle = std::max(angle, length(cross(p, q)) * 180 / M_PI);
      }
      EXPECT_GT(largest, 0.003);
      EXPECT_LT(height, 1e-5 * largest) << int(law) << ' ' << int(shape);
      EXPECT_LT(angle, 0.1) << int(law) << ' ' << int(shape);

      EXPECT_EQ(field.evaluate(*program, {}, stream), 0u);  // everything is at rest: zeros once, then no work
      for (const vec4& s : read_back<vec4>(stream, mesh.vertex_count)) ASSERT_EQ(s, vec4(0));
    }
  }
}

}  // namespace
}  // namespace pliant
