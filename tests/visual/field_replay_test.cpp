// Fields without a closed form: the GPU's steps against the CPU's, frame by frame.
#include "systems/visual/field_replay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scenes/scenes.h"
#include "scenes/touch_laws.h"
#include "systems/touch/feed/publish.h"
#include "systems/touch/prepare/touch_state.h"
#include "systems/visual/gpu/context.h"
#include "systems/visual/upload.h"
#include "tests/visual/read_back.h"

namespace pliant {
namespace {

using scenes::Stage;

struct Twin {
  Stage stage;
  Entity surface;
  FieldReplay replay;
  StreamCopies copies;
  double largest = 0, height = 0, angle = 0;  // [m] [m] [degrees]

  Twin(const Primitive& primitive, const Deformable& d) {
    stage.world.field_place = FieldPlace::kGpu;
    surface = stage.add(primitive, d);
    copies = StreamCopies(std::vector<vec4>(std::size_t{mesh().zone_count()} * kZoneSize, vec4(0)));
    replay = FieldReplay(mesh(), stage.world.registry.get<Deformable>(surface), stage.dt());
  }
  const Mesh& mesh() const { return stage.mesh(surface); }
  std::uint32_t streamed = 0;  // zones of the last picture
  // A frame: the changes since the last one, and the difference between GPU and CPU.
  bool picture(const ReplayProgram& program) {
    publish(stage.world,
            {static_cast<std::uint64_t>(std::lround(stage.time() / stage.dt())), stage.time(), stage.dt()});
    stage.world.snapshots->acquire();
    const Snapshot& snapshot = stage.world.snapshots->read();
    const ObjectSnapshot& object = snapshot.objects[0];
    const bool fed = replay.take(*object.feed, object.fed, snapshot.tick);
    if (!fed) copies.take({object.zones.data(), object.zone_count}, object.stream);
    streamed = object.zone_count;
    copies.upload();
    replay.evaluate(program, copies.buffer());
    if (!fed && !snapshot.complete) return false;
    const std::vector<vec4> got = read_back<vec4>(copies.buffer(), mesh().vertex_count);
    for (std::uint32_t v = 0; v < mesh().vertex_count; ++v) {
      const vec4 want = stage.field(surface).stream[v];
      largest = std::max<double>(largest, std::abs(want.w));
      height = std::max<double>(height, std::abs(got[v].w - want.w));
      const dvec3 p = normalize(dvec3(mesh().normal(v) + vec3(got[v]))),
                  q = normalize(dvec3(mesh().normal(v) + vec3(want)));
      angle = std::max(angle, length(cross(p, q)) * 180 / M_PI);
    }
    return fed;
  }
};

Primitive painted_ball() {
  Primitive ball = scenes::sphere(24, 0.1);
  for (const vec3& p : ball.position) {
    ball.stiffness.push_back(p.x > 0 ? 3.0f : 0.6f);
    ball.damping.push_back(p.z > 0 ? 1.5f : 0.7f);
    ball.relaxation.push_back(p.x > 0.01f ? 0.5f : 2.0f);
  }
  return ball;
}

struct Case {
  SpringLaw law;
  Response response;
  Distance distance;
  bool painted;
  double stiffening = 100.0;
};

class FieldReplayTest : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    Result<std::unique_ptr<HeadlessContext>> made = HeadlessContext::create();
    if (!made) GTEST_SKIP() << made.error().message();
    context_ = std::move(*made);
    Result<ReplayProgram> program = ReplayProgram::make();
    ASSERT_TRUE(program.ok()) << program.error().message();
    program_ = *std::move(program);
  }
  std::unique_ptr<HeadlessContext> context_;
  ReplayProgram program_;
};

TEST_P(FieldReplayTest, StepsWhatTheProcessorSteps) {
  const Case c = GetParam();
  Deformable d;
  d.reach = 0.03;
  d.spring = c.law;
  d.table = frictionless(c.law).table;
  if (d.table.count > 0) d.stiffness = stiffness_of(d.table);
  d.response = c.response;
  d.distance = c.distance;
  d.relaxation_time = 0.05;
  d.stiffening = c.stiffening;
  Twin twin(c.painted ? painted_ball() : scenes::sphere(24, 0.1), d);
  Stage& stage = twin.stage;
  const Entity a = stage.add_probe({0, 0.11, 0.01}), b = stage.add_probe({0.03, 0.11, -0.01});
  stage.prepare();
  std::mt19937 random(7);
  const auto out = [](double depth, int i, double x) {
    return (0.1 - depth) * normalize(dvec3(std::sin(0.004 * i) + x, 1, 0.1 - 0.8 * x));
  };
  int next = 5, pictures = 0;
  for (int i = 0; i < 400; ++i) {  // press, slide, one leaves and returns, both leave
    const double pressed = std::min(1.0, i / 60.0);
    stage.place(a, out(i > 330 ? -0.02 : 0.005 * pressed, i, 0));
    stage.place(b, out((i > 180 && i < 230) || i > 340 ? -0.02 : 0.004 * pressed, i, 0.25));
    stage.tick();
    if (i < next) continue;
    next = i + 1 + static_cast<int>(random() % 40);
    ASSERT_TRUE(twin.picture(program_)) << i;
    ++pictures;
  }
  stage.wait(0.02);
  ASSERT_TRUE(twin.picture(program_));
  EXPECT_GT(pictures, 10);
  // A table that relaxes follows its lag the slowest.
  EXPECT_GT(twin.largest, c.law == SpringLaw::kQuasiLinearTable ? 0.0015 : 0.003);
  EXPECT_LT(twin.height, 1e-5 * twin.largest);
  EXPECT_LT(twin.angle, 0.1);

  for (int i = 0; i < 10; ++i) {  // all at rest: zeros, exactly
    stage.wait(0.3);
    ASSERT_TRUE(twin.picture(program_));
  }
  if (stage.field(twin.surface).awake.empty()) {
    EXPECT_TRUE(twin.replay.at_rest());
    for (const vec4& s : read_back<vec4>(twin.copies.buffer(), twin.mesh().vertex_count)) ASSERT_EQ(s, vec4(0));
  }
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const SpringLaw law : kLaws)
    for (const Response response : {Response::kFollow, Response::kLag})
      for (const Distance distance : {Distance::kChord, Distance::kSurface})
        for (const bool painted : {false, true}) {
          const bool closed = row_of(law).step == SpringStep::kExact && response == Response::kFollow &&
                              distance == Distance::kChord && !painted;
          if (!closed) all.push_back({law, response, distance, painted});
        }
  all.push_back({SpringLaw::kExponential, Response::kFollow, Distance::kChord, false, -60.0});
  return all;
}

std::string name_of(const ::testing::TestParamInfo<Case>& info) {
  const Case& c = info.param;
  return std::string(word_of(c.law)) + (c.response == Response::kLag ? "Lag" : "Follow") +
         (c.distance == Distance::kSurface ? "Surface" : "Chord") + (c.painted ? "Painted" : "Plain") +
         (c.stiffening < 0 ? "Softening" : "");
}

INSTANTIATE_TEST_SUITE_P(Laws, FieldReplayTest, ::testing::ValuesIn(cases()), name_of);

TEST(FieldReplay, AReaderThatComesLateIsGivenTheStreamsAndThenBegins) {
  Result<std::unique_ptr<HeadlessContext>> context = HeadlessContext::create();
  if (!context) GTEST_SKIP() << context.error().message();
  Result<ReplayProgram> program = ReplayProgram::make();
  ASSERT_TRUE(program.ok()) << program.error().message();
  Deformable d;
  d.reach = 0.03;
  d.spring = SpringLaw::kCubic;
  Twin twin(scenes::sphere(24, 0.1), d);
  Stage& stage = twin.stage;
  const Entity a = stage.add_probe({0, 0.11, 0});
  stage.prepare();
  stage.move(a, {0, 0.095, 0}, 0.05);
  ASSERT_TRUE(twin.picture(*program));
  twin.replay = FieldReplay(twin.mesh(), d, stage.dt());  // the window is empty again
  twin.picture(*program);                                 // and finds it out
  stage.tick();
  EXPECT_FALSE(twin.picture(*program));
  EXPECT_GT(twin.streamed, 0u);
  stage.move(a, {0, 0.2, 0}, 0.05);
  EXPECT_FALSE(twin.picture(*program));
  stage.wait(2.0);
  int pictures = 0;
  while (!twin.picture(*program)) ASSERT_LT(++pictures, 20);
  stage.move(a, {0, 0.095, 0}, 0.1);
  ASSERT_TRUE(twin.picture(*program));
  EXPECT_EQ(twin.streamed, 0u);
  EXPECT_LT(twin.height, 1e-5 * twin.largest);
}

}  // namespace
}  // namespace pliant
