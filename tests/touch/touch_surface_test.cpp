// Touch on faces, edges, ridges and grooves, against closed forms (methods.md 1.5).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "scenes/brute_force.h"
#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"
#include "systems/touch/collide/foot.h"
#include "systems/touch/collide/surface_query.h"
#include "systems/touch/feed/publish.h"

namespace pliant {
namespace {

// Intersection of the curved surface with a ray from the origin along a unit vector. [m]
dvec3 surface_on_the_way(const Mesh& mesh, dvec3 along) {
  const Entry entry = first_entry(mesh, dvec3(0), 0.1 * along);
  EXPECT_TRUE(entry.valid());
  dvec3 x = entry.fraction * 0.1 * along;
  for (int i = 0; i < 20; ++i) {
    const Foot foot = descend(mesh, entry.triangle, entry.barycentric, x);
    x -= foot.height / dot(along, foot.normal) * along;
  }
  return x;
}

// A patch through the mean normal of the point would bulge between the edges: 2 mm felt like 2.7.
// deep.
TEST(TouchSurface, AConeIsFeltAsACone) {
  constexpr int kSides = 24;
  constexpr double kRadius = 0.03, kHeight = 0.04, kDepth = 0.002, kStiffness = 300.0;
  Primitive cone;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    cone.position.push_back(vec3(dvec3(kRadius * std::cos(angle), 0, kRadius * std::sin(angle))));
  }
  cone.position.insert(cone.position.end(), {vec3(0, static_cast<float>(kHeight), 0), vec3(0)});
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const std::uint32_t next = (i + 1) % kSides;
    for (const std::uint32_t v : {i, std::uint32_t{kSides}, next, next, kSides + 1u, i}) cone.index.push_back(v);
  }
  Stage stage;
  stage.add(cone, frictionless());
  const double slope = std::hypot(kRadius, kHeight);
  const auto at = [&](double angle, double depth) {  // below the slope at half its height
    const dvec3 out(std::cos(angle), 0, std::sin(angle));
    return 0.5 * (kRadius * out + dvec3(0, kHeight, 0)) - depth / slope * (kHeight * out + dvec3(0, kRadius, 0));
  };
  const Entity probe = stage.add_probe(at(0.1, -0.001));
  stage.prepare();
  stage.move(probe, at(0.1, kDepth), 0.1);
  const double flat = 0.5 * kRadius * (1 - std::cos(std::numbers::pi / kSides));  // a side is so much below the cone
  for (double angle = 0.1; angle < 1.0; angle += 0.002) {
    stage.place(probe, at(angle, kDepth));
    stage.tick();
    EXPECT_LT(length(raw_force(stage, probe)), kStiffness * kDepth * 1.02) << angle;
    EXPECT_GT(length(raw_force(stage, probe)), kStiffness * (kDepth - 1.1 * flat)) << angle;
  }
}

// The force there is a hard case (player/study/hard).
TEST(TouchSurface, ASphereInAGrooveShowsAnArrowForEachWall) {
  Stage stage;
  stage.add(scenes::valley(40, 0.2, M_PI / 4), frictionless());
  const Entity probe = stage.add_probe({0, 0.06, 0}, 0.02);
  stage.prepare();
  for (const double aside : {0.0, 0.0039}) {
    stage.move(probe, {aside, (0.02 - 0.0031) * std::sqrt(2.0), 0}, 1.0);
    stage.wait(0.3);
    publish(stage.world, {});
    ASSERT_TRUE(stage.world.snapshots->acquire());
    const ProbeSnapshot& shown = stage.world.snapshots->read().probes[0];
    ASSERT_EQ(shown.contact_count, 2u);
    EXPECT_LT(length(shown.contacts[0].force + shown.contacts[1].force - raw_force(stage, probe)), 1e-12);
    stage.move(probe, {0, 0.06, 0}, 0.5);
  }
}

// Wherever along its length that is (flat on a surface: touch_capsule_test.cpp).
TEST(TouchSurface, ACapsuleAcrossABoxsEdgeTouchesInOnePlace) {
  Stage box;
  box.add(scenes::slab(4, 0.08, 0.06), frictionless());
  const Entity shaft = box.add_probe({0.03, 0.03, 0}, 0.004);
  box.world.registry.get<Probe>(shaft).length = 0.06;
  box.device(shaft).rotation = glm::angleAxis(-3 * M_PI / 4, dvec3(0, 0, 1));  // down and outwards, over the edge
  box.prepare();
  double low = 1e9, high = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double s = 0.02 * i / 1000;  // along its own axis; 2 mm of the shaft behind the edge
    const dvec3 axis = normalize(dvec3(1, -1, 0)), out = normalize(dvec3(1, 1, 0));
    box.place(shaft, dvec3(0.04, 0, 0) + 0.002 * out * (i < 100 ? 3 - 2 * i / 100.0 : 1.0) - axis * (0.02 + s));
    box.tick();
    if (i < 150) continue;
    low = std::min(low, length(raw_force(box, shaft)));
    high = std::max(high, length(raw_force(box, shaft)));
  }
  EXPECT_GT(low, 0.4);
  EXPECT_LT(high - low, 0.01 * high);
}

// A tip that was pressed through a wall is not caught by it on its way back; a second wall behind it is touched. Seen
// from the inside, a bowl's curved surface is behind its triangles. A tip between the two does not touch yet, and is
// caught when it moves on, fast or slow.
TEST(TouchSurface, ATipBetweenATriangleAndItsCurvedSurfaceIsCaughtHoweverFastItGoesOn) {
  constexpr double kRadius = 0.05;
  const Primitive bowl = scenes::bowl(4, kRadius);
  int caught = 0;
  for (const double step : {2e-4, 1e-3, 3e-3, 8e-3})
    for (const double between : {1e-6, 0.5, 1.0}) {  // from the triangle to the curved surface
      Stage stage;
      const Entity surface = stage.add(bowl, frictionless());
      const Entity probe = stage.add_probe({0, 0.01, 0});
      stage.prepare();
      const Mesh& mesh = stage.mesh(surface);
      for (std::uint32_t t = 0; t < mesh.triangles.size(); t += 5) {
        const uvec3 corner = mesh.triangles[t];
        const dvec3 middle =
            (dvec3(mesh.position(corner.x)) + dvec3(mesh.position(corner.y)) + dvec3(mesh.position(corner.z))) / 3.0;
        if (middle.y > -0.4 * kRadius) continue;
        const dvec3 down = normalize(middle), curved = surface_on_the_way(mesh, down);
        ASSERT_GT(length(curved), length(middle) + 1e-5);
        const double from = length(middle) + between * (length(curved) - length(middle)) - 1e-12;
        for (const double r : {from - 1e-3, from, from + step}) {
          stage.place(probe, r * down);
          stage.tick();
        }
        const ProbeReading felt = stage.read(probe);
        EXPECT_NEAR(felt.depth, std::max(0.0, from + step - length(curved)), 0.02 * step + 1e-6)
            << step << " " << between << " " << t;
        caught += felt.depth > 0;
        for (const double r : {from - 1e-3, 0.5 * from}) {
          stage.place(probe, r * down);
          stage.tick();
        }
      }
    }
  EXPECT_GT(caught, 100);
}

TEST(TouchSurface, ATipPressedThroughAWallTouchesTheNextAndComesBackByTheSameForces) {
  for (const double radius : {0.0, 0.002}) {
    Primitive walls = scenes::slab(20, 0.1, 0.001);
    const auto count = static_cast<std::uint32_t>(walls.position.size());
    const Primitive wall = walls;
    for (const vec3& p : wall.position) walls.position.push_back(p - vec3(0, 0.004f, 0));
    for (const std::uint32_t i : wall.index) walls.index.push_back(i + count);
    Stage stage;
    stage.add(walls, frictionless());
    const Entity probe = stage.add_probe({0.003, 0.005, 0.002}, radius);
    stage.prepare();
    std::vector<std::pair<double, dvec3>> down;
    for (double y = 0.005; y > -0.008; y -= 5e-5) {
      stage.place(probe, {0.003, y, 0.002});
      stage.tick();
      down.push_back({y, raw_force(stage, probe)});
    }
    std::size_t contacts = 0;
    for (auto [entity, contact] : stage.world.registry.view<Contact>()) contacts += contact.probe == probe;
    EXPECT_EQ(contacts, 2u) << radius;
    EXPECT_GE(down.back().second.y, 0.99 * law(frictionless(), radius + 0.008)) << radius;
    for (; !down.empty(); down.pop_back()) {
      stage.place(probe, {0.003, down.back().first, 0.002});
      stage.tick();
      ASSERT_LT(length(raw_force(stage, probe) - down.back().second), 1e-6) << radius << ' ' << down.back().first;
    }
  }
}

// Where nothing is near, a tick searches nothing.
TEST(TouchSurface, NothingOfTheSurfaceIsInTheBallThatIsKnownToBeClear) {
  for (const double radius : {0.0, 0.004}) {
    Stage stage;
    const Entity surface = stage.add(scenes::sphere(12, 0.05), frictionless());
    const Entity probe = stage.add_probe({0, 0.06, 0}, radius);
    stage.prepare();
    const BruteForce brute(stage.mesh(surface));
    std::mt19937 engine(7);
    std::normal_distribution<double> step(0.0, 2e-4);
    dvec3 x(0, 0.06, 0), searched(0);
    int searches = 0, ticks = 0;
    for (; ticks < 4000; ++ticks) {
      x += dvec3(step(engine), step(engine), step(engine));
      const double far = length(x);
      x *= std::clamp(far, 0.042, 0.062) / far;
      stage.place(probe, x);
      stage.tick();
      const ClearBall& ball = stage.world.touch->objects[0].clear[0];
      if (ball.at == searched) continue;
      searched = ball.at;
      ++searches;
      const SurfaceFoot near = brute.closest(ball.at, 0.1);
      ASSERT_TRUE(near.valid());
      ASSERT_LE(ball.radius, near.distance()) << radius << ' ' << ticks;
    }
    EXPECT_GT(searches, 20) << radius;
    EXPECT_LT(searches, ticks / 2) << radius;
  }
}

}  // namespace
}  // namespace pliant
