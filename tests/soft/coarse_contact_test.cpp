// CollisionMeshes of few vertices: boxes of twelve triangles, whose vertices are far from where they touch.
#include <gtest/gtest.h>

#include <cmath>

#include "content/level/spawn_soft.h"
#include "scenes/tool_stage.h"
#include "systems/soft/body/soft_body_state.h"
#include "tests/soft/collision_shapes.h"
#include "tests/soft/contact_loop.h"

namespace pliant {
namespace {

using test::ContactLoop;
constexpr double kCoarseStep = 1.0 / 60.0;  // [s]
constexpr double kCoarseGravity = 9.81;     // [m/s2]

dquat yaw(double angle) {
  return glm::angleAxis(angle, dvec3(0, 1, 0));
}
double tilt(const RigidState& body) {
  return length(cross(body.rotation() * dvec3(0, 1, 0), dvec3(0, 1, 0)));
}

// A cube, a plate and a slender bar, whose mean edge is much longer than it is wide.
const std::array<vec3, 4> kShapes{vec3(0.1f), vec3(0.3f, 0.02f, 0.2f), vec3(0.02f, 0.3f, 0.02f),
                                  vec3(0.4f, 0.02f, 0.02f)};

TEST(CoarseContact, ABoxOfTwelveTrianglesLiesLevelOnAGroundOfTwelve) {
  const Mesh ground = test::block_mesh(vec3(1.0f, 0.2f, 1.0f));
  for (const vec3 size : kShapes)
    for (const double angle : {0.0, 0.4, M_PI / 4}) {
      const Mesh box = test::block_mesh(size);
      ContactLoop loop;
      loop.add<FixedBody>(ground, Pose{dvec3(0, -0.1, 0)});
      auto& body = loop.add<RigidState>(box, Pose{dvec3(0.013, 0.5 * size.y + 0.01, 0.007), yaw(angle)},
                                        test::block_mass(dvec3(size), 0.3));
      loop.set_friction(0.4, 0.3);
      for (int i = 0; i < 120; ++i) loop.step(kCoarseStep);
      SCOPED_TRACE(testing::Message() << size.x << " x " << size.y << " x " << size.z << ", turned " << angle);
      EXPECT_NEAR(body.centre().y, 0.5 * size.y, 1e-6);
      EXPECT_LT(tilt(body), 1e-6);
      EXPECT_LT(length(loop.force(1, 0) - dvec3(0, 0.3 * kCoarseGravity, 0)), 1e-5 * 0.3 * kCoarseGravity);
    }
}

// Larger on smaller, smaller on larger, and across each other: with corners on faces and edges over edges.
TEST(CoarseContact, BoxesOfAnySizeLieLevelOnEachOther) {
  const Mesh ground = test::block_mesh(vec3(1.0f, 0.2f, 1.0f));
  int crossed = 0;
  for (const vec3 low : {vec3(0.1f), vec3(0.3f, 0.1f, 0.3f), vec3(0.05f, 0.1f, 0.05f), vec3(0.4f, 0.1f, 0.05f)})
    for (const vec3 high : {vec3(0.1f), vec3(0.3f, 0.02f, 0.3f), vec3(0.05f, 0.1f, 0.4f), vec3(0.02f, 0.02f, 0.4f)})
      for (const double angle : {0.0, 0.4, M_PI / 4}) {
        const Mesh lower = test::block_mesh(low), upper = test::block_mesh(high);
        ContactLoop loop;
        loop.add<FixedBody>(ground, Pose{dvec3(0, -0.1, 0)});
        loop.add<RigidState>(lower, Pose{dvec3(0, 0.0501, 0)}, test::block_mass(dvec3(low), 0.5));
        auto& body = loop.add<RigidState>(upper, Pose{dvec3(0.003, 0.105 + 0.5 * high.y, 0.002), yaw(angle)},
                                          test::block_mass(dvec3(high), 0.3));
        loop.set_friction(0.4, 0.3);
        for (int i = 0; i < 60; ++i) loop.step(kCoarseStep);
        const dvec3 settled = body.centre();
        for (int i = 0; i < 60; ++i) loop.step(kCoarseStep);
        SCOPED_TRACE(testing::Message() << high.x << " x " << high.z << " on " << low.x << " x " << low.z << ", turned "
                                        << angle);
        EXPECT_LT(length(body.centre() - settled), 1e-6);
        EXPECT_NEAR(body.centre().y, 0.1 + 0.5 * high.y, 1e-5);
        EXPECT_LT(tilt(body), 1e-5);
        EXPECT_LT(length(loop.force(2, 1) - dvec3(0, 0.3 * kCoarseGravity, 0)), 1e-4 * kCoarseGravity);
        EXPECT_LT(length(loop.force(1, 0) - dvec3(0, 0.8 * kCoarseGravity, 0)), 1e-4 * kCoarseGravity);
        for (const ContactPoint& c : loop.contacts) {
          const auto inside = [](dvec3 w) { return (w.x > 0.01) + (w.y > 0.01) + (w.z > 0.01) == 2; };
          crossed += c.impulse.x > 0.0 && inside(c.a.barycentric) && inside(c.b.barycentric);
        }
      }
  EXPECT_GT(crossed, 50) << "edges over edges";
}

// A plank over two walls, loaded off its middle: each wall bears its share by the law of the lever.
TEST(CoarseContact, APlankOverTwoWallsBearsItsLoadByTheLever) {
  const Mesh wall = test::block_mesh(vec3(0.01f, 0.1f, 0.2f)), plank = test::block_mesh(vec3(0.4f, 0.02f, 0.06f)),
             load = test::block_mesh(vec3(0.03f));
  for (const double at : {-0.1, 0.0, 0.06}) {
    ContactLoop loop;
    for (const double side : {-1.0, 1.0}) loop.add<FixedBody>(wall, Pose{dvec3(0.15 * side, -0.05, 0)});
    auto& beam = loop.add<RigidState>(plank, Pose{dvec3(0, 0.0105, 0)}, test::block_mass(dvec3(0.4, 0.02, 0.06), 0.2));
    auto& box = loop.add<RigidState>(load, Pose{dvec3(at, 0.036, 0.005), yaw(0.5)}, test::block_mass(dvec3(0.03), 0.4));
    loop.set_friction(0.4, 0.3);
    for (int i = 0; i < 120; ++i) loop.step(kCoarseStep);
    EXPECT_LT(tilt(beam), 1e-5) << at;
    EXPECT_LT(tilt(box), 1e-5) << at;
    EXPECT_NEAR(box.centre().x, at, 1e-4);
    // Each wall pushes somewhere on its 10 mm: moments about the centre of these forces.
    double left = 0, right = 0, moment = 0;
    for (const ContactPoint& c : loop.contacts) {
      if (c.body_a > 1 && c.body_b > 1) continue;
      const double up = (c.body_a > c.body_b ? 1.0 : -1.0) * (c.axes * c.impulse).y / kCoarseStep;
      (c.a.position.x < 0 ? left : right) += up;
      moment += up * c.a.position.x;
    }
    EXPECT_NEAR(left + right, 0.6 * kCoarseGravity, 1e-4) << at;
    EXPECT_NEAR(moment, 0.4 * kCoarseGravity * at, 1e-4) << at;
    EXPECT_NEAR(right - left, 0.4 * kCoarseGravity * at / 0.15, 0.04 * 0.6 * kCoarseGravity) << at;
  }
}

Primitive primitive_of(const Mesh& mesh) {
  Primitive p;
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) p.position.push_back(mesh.position(v));
  for (const uvec3& t : mesh.triangles) p.index.insert(p.index.end(), {t.x, t.y, t.z});
  return p;
}

// Tissue as a level makes it of a box in `squares` squares a side.
SoftParts soft_box(vec3 size, int squares) {
  LevelNode node;
  node.name = "tissue";
  node.mesh = 0;
  node.soft_body = SoftBody{{.cell = 0.0125}};
  const LevelMesh mesh{"box", {primitive_of(test::block_mesh(size, squares))}};
  auto parts = make_soft_parts(node, &mesh, mat4(1), {});
  EXPECT_TRUE(parts) << parts.error().message();
  return std::move(*parts);
}

// How deep a small rigid box sinks into the middle of a soft plate, and how deep the plate's tissue into the ground.
struct Pressed {
  double box = 0.0, tissue = 0.0;  // [m]
};
Pressed press_middle(int squares) {
  const Mesh ground = test::block_mesh(vec3(1.0f, 0.2f, 1.0f)), small = test::block_mesh(vec3(0.03f));
  const SoftParts plate = soft_box(vec3(0.12f, 0.03f, 0.12f), squares);
  const SoftBody tissue{{.young = 2e4, .poisson = 0.4, .density = 1000.0, .rayleigh = {0.0, 0.02}}};
  ContactLoop loop;
  loop.add<FixedBody>(ground, Pose{dvec3(0, -0.1, 0)});
  const auto& body = loop.add<SoftBodyState>(plate.tets, plate.surface.mesh, tissue, nullptr,
                                             Pose{dvec3(0.003, 0.0151, 0.001)}, SolverKind::kAuto);
  auto& box =
      loop.add<RigidState>(small, Pose{dvec3(0.003, 0.046, 0.001), yaw(0.3)}, test::block_mass(dvec3(0.03), 0.2));
  loop.set_friction(0.4, 0.3);
  for (int i = 0; i < 80; ++i) loop.step(kCoarseStep);
  double weight = 0.2 * kCoarseGravity;
  EXPECT_LT(length(loop.force(2, 1) - dvec3(0, weight, 0)), 1e-3 * weight) << squares;
  for (const double m : body.tissue().mass()) weight += m * kCoarseGravity;
  EXPECT_LT(length(loop.force(1, 0) - dvec3(0, weight, 0)), 1e-3 * weight) << squares;
  EXPECT_LT(tilt(box), 0.01) << squares;
  Pressed out{0.03 - (box.centre().y - 0.015), 0.0};
  for (const dvec3& x : body.tissue().position()) out.tissue = std::max(out.tissue, -x.y);
  return out;
}

// The level's box of twelve triangles deforms like a finely meshed one.
TEST(CoarseContact, ASoftPlateOfTwelveTrianglesGivesWayWhereItIsPressed) {
  const Pressed coarse = press_middle(1), fine = press_middle(16);
  EXPECT_GT(fine.box, 5e-4);
  EXPECT_NEAR(coarse.box, fine.box, 0.15 * fine.box);
  EXPECT_LT(coarse.tissue, fine.tissue + 5e-4);
}

}  // namespace
}  // namespace pliant
