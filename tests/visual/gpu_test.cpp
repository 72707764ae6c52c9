// The GPU's side by itself: context, shaders, P1's two lines, and which copy of a stream is newer.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "components/mesh.h"
#include "systems/visual/gpu/buffer.h"
#include "systems/visual/gpu/program.h"
#include "systems/visual/gpu/texture.h"
#include "systems/visual/upload.h"
#include "tests/visual/read_back.h"
#include "tests/visual/scene.h"

namespace pliant {
namespace {

TEST(Context, IsCurrentAndOfTheVersionThatShadersAreWrittenFor) {
  NEEDS_A_CONTEXT();
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  EXPECT_GE(10 * major + minor, 45);
  EXPECT_FALSE(test::context()->renderer_name().empty());
}

TEST(Context, CanBeMadeAgainAfterItWasGivenBack) {
  for (int i = 0; i < 2; ++i) {
    Result<std::unique_ptr<HeadlessContext>> made = HeadlessContext::create();
    if (!made) GTEST_SKIP() << made.error().message();
    GLint major = 0;
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    EXPECT_GE(major, 4);
  }
}

TEST(Deform, TheShadersTwoLinesAreTheArithmeticOfThePaper) {
  NEEDS_A_CONTEXT();
  constexpr std::size_t kCount = 1024;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> even(-1.0f, 1.0f);
  std::vector<vec4> stream, rest(kCount), normal(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    rest[i] = vec4(even(random), even(random), even(random), 0);
    normal[i] = vec4(normalize(vec3(even(random), even(random), even(random) + 2.0f)), 0);
    stream.push_back(0.4f * vec4(even(random), even(random), even(random), even(random)));
  }
  Result<gpu::ShaderSource> source = gpu::expand_shader("lines.comp", R"(
#include "deform.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 1) readonly buffer Rest { vec4 rest[]; };
layout(std430, binding = 2) readonly buffer Normal { vec4 unit[]; };
layout(std430, binding = 3) writeonly buffer Out { vec4 result[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  result[2 * i] = vec4(deformed_position(rest[i].xyz, unit[i].xyz, stream[i]), 1.0);
  result[2 * i + 1] = vec4(deformed_normal(unit[i].xyz, stream[i]), 0.0);
}
)");
  ASSERT_TRUE(source) << source.error().message();
  Result<gpu::Program> program = gpu::Program::link({&*source, 1});
  ASSERT_TRUE(program) << program.error().message();
  const gpu::Buffer in[3] = {gpu::Buffer::fixed<vec4>(stream), gpu::Buffer::fixed<vec4>(rest),
                             gpu::Buffer::fixed<vec4>(normal)};
  const gpu::Buffer out = gpu::Buffer::writable(nullptr, 2 * kCount * sizeof(vec4));
  for (GLuint i = 0; i < 3; ++i) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, in[i].id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, out.id());
  program->use();
  glDispatchCompute(kCount / 64, 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  const std::vector<vec4> result = read_back<vec4>(out, 2 * kCount);

  for (std::size_t i = 0; i < kCount; ++i) {
    const dvec3 P0(rest[i]), N0(normal[i]), correction(stream[i]);
    EXPECT_LT(length(dvec3(result[2 * i]) - (P0 + double{stream[i].w} * N0)), 1e-6) << i;
    EXPECT_LT(length(dvec3(result[2 * i + 1]) - normalize(N0 + correction)), 1e-6) << i;
  }
}

TEST(Shader, AMistakeIsReportedWithItsOwnFileAndLine) {
  NEEDS_A_CONTEXT();
  Result<gpu::ShaderSource> source = gpu::expand_shader("broken.comp", R"(layout(local_size_x = 1) in;
#include "deform.glsl"
void main() {
  vec3 p = nothing_of_this_name;
}
)");
  ASSERT_TRUE(source) << source.error().message();
  Result<gpu::Program> program = gpu::Program::link({&*source, 1});
  ASSERT_FALSE(program);
  EXPECT_NE(program.error().message().find("broken.comp:4: "), std::string::npos) << program.error().message();
}

TEST(Shader, AMistakeInAnIncludedFileIsReportedThere) {
  NEEDS_A_CONTEXT();
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "pliant_shaders";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "inner.glsl") << "// fine\n#include \"outer.glsl\"\nfloat f() { return wrong; }\n";
  std::ofstream(folder / "outer.glsl") << "#include \"inner.glsl\"\n";  // a cycle: each is taken once
  const char* before = std::getenv("PLIANT_SHADERS");
  const std::string kept = before ? before : "";
  setenv("PLIANT_SHADERS", folder.c_str(), 1);
  Result<gpu::ShaderSource> source = gpu::expand_shader("x.comp", "#include \"outer.glsl\"\nvoid main() {}\n");
  Result<gpu::ShaderSource> missing = gpu::expand_shader("x.comp", "\n#include \"none.glsl\"\n");
  if (before) setenv("PLIANT_SHADERS", kept.c_str(), 1);
  if (!before) unsetenv("PLIANT_SHADERS");
  ASSERT_TRUE(source) << source.error().message();
  Result<gpu::Program> program = gpu::Program::link({&*source, 1});
  ASSERT_FALSE(program);
  EXPECT_NE(program.error().message().find("inner.glsl:3: "), std::string::npos) << program.error().message();
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().where, "x.comp:2");
}

TEST(Shader, LogsOfBothKindsOfDriverAreReadable) {
  const gpu::ShaderSource source{.name = "a.frag", .text = "", .files = {"a.frag", "light.glsl"}};
  EXPECT_EQ(gpu::explain_log(source, "1:12(5): error: no\n"), "light.glsl:12: error: no");
  EXPECT_EQ(gpu::explain_log(source, "0(7) : error C1: no\n\nend\n"), "a.frag:7: error C1: no\nend");
  EXPECT_EQ(gpu::explain_log(source, "9:1(1): from nowhere"), "9:1(1): from nowhere");
}

TEST(Texture, APictureWhoseBytesDoNotMatchItsSizeIsRefusedByName) {
  NEEDS_A_CONTEXT();
  const Image image{.name = "skin.png", .width = 3, .height = 2, .rgba = std::vector<std::uint8_t>(23)};
  Result<gpu::Texture> texture = gpu::Texture::from_image(image, gpu::Meaning::kColor);
  ASSERT_FALSE(texture);
  EXPECT_EQ(texture.error().where, "skin.png");
}

TEST(Upload, OnlyZonesThatChangedTravelAndTheCardThenAgrees) {
  NEEDS_A_CONTEXT();
  constexpr std::size_t kZones = 9, kZoneBytes = kZoneSize * sizeof(vec4);
  StreamCopies copies(std::vector<vec4>(kZones * kZoneSize, vec4(0.5f)));
  EXPECT_EQ(copies.upload(), 0u);

  // Zones 7, 2, 3, and 2 again with newer values; 40 does not exist.
  std::vector<vec4> packed;
  for (const float value : {7.0f, 2.0f, 3.0f, 2.5f, 40.0f}) packed.insert(packed.end(), kZoneSize, vec4(value));
  copies.take(std::vector<std::uint32_t>{7, 2, 3, 2, 40}, packed);
  EXPECT_EQ(copies.upload(), 3 * kZoneBytes);
  EXPECT_EQ(copies.upload(), 0u);

  const std::vector<vec4> on_gpu = read_back<vec4>(copies.buffer(), kZones * kZoneSize);
  const float expected[kZones] = {0.5f, 0.5f, 2.5f, 3.0f, 0.5f, 0.5f, 0.5f, 7.0f, 0.5f};
  for (std::size_t i = 0; i < on_gpu.size(); ++i) EXPECT_EQ(on_gpu[i], vec4(expected[i / kZoneSize])) << i;
}

}  // namespace
}  // namespace pliant
