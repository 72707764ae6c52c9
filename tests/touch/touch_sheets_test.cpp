// A contact knows its sheet: thin-walled organs, slabs behind each other, walls beside a notch.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"

namespace pliant {
namespace {

enum class Organ { kLumpy, kFolded, kNotched };

double radius_of(Organ organ, dvec3 u) {
  switch (organ) {
    case Organ::kLumpy:
      return 1 + 0.08 * std::sin(5 * u.x + 1) * std::sin(6 * u.y) + 0.05 * std::sin(9 * u.z + 4 * u.x);
    case Organ::kFolded:  // with creases
      return 1 + 0.12 * std::abs(std::sin(5 * u.x + 2 * u.y)) - 0.1 * std::abs(std::sin(6 * u.y - 4 * u.z + 1)) +
             0.06 * std::abs(std::sin(9 * u.z));
    case Organ::kNotched:
      return 1 + 0.05 * std::sin(5 * u.x + 1) * std::sin(6 * u.y) - 0.35 * std::exp(-std::pow((u.x - 0.2) / 0.12, 2));
  }
  return 1;
}

// A closed organ of about 80 mm. `wall` [m] > 0: hollow, with an inner surface at this mean distance.
Primitive organ_of(Organ organ, int n, double wall) {
  const Primitive ball = scenes::sphere(n, 1.0);
  const auto outer = [&](dvec3 u) {
    u = normalize(u);
    return 0.045 * radius_of(organ, u) * dvec3(u.x, 0.75 * u.y, 0.85 * u.z);
  };
  Primitive out;
  out.index = ball.index;
  for (const vec3& u : ball.position) out.position.push_back(vec3(outer(dvec3(u))));
  if (wall == 0.0) return out;
  const auto first = static_cast<std::uint32_t>(ball.position.size());
  for (const vec3& at : ball.position) {
    const dvec3 u = normalize(dvec3(at)),
                a = normalize(cross(u, std::abs(u.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0))), b = cross(u, a);
    constexpr double h = 0.02;
    const dvec3 outward = normalize(cross(outer(u + h * a) - outer(u - h * a), outer(u + h * b) - outer(u - h * b)));
    out.position.push_back(vec3(outer(u) - wall * (1 + 0.4 * std::sin(3 * u.x + 2 * u.z)) * outward));
  }
  for (std::size_t i = 0; i < ball.index.size(); i += 3)
    for (const std::size_t k : {0, 2, 1}) out.index.push_back(first + ball.index[i + k]);
  return out;
}

// The two surfaces of a wall have nothing to do with each other: presses on a hollow organ feel as on a full one, and
// lifted, as on the way in.
TEST(TouchSheets, APressOnAThinWalledOrganFeelsItsOuterSurfaceWhereverAndHoweverDeep) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(0, 1);
  std::normal_distribution<double> g;
  int pressed = 0, same = 0;
  for (const auto& [organ, n, wall] : {std::tuple{Organ::kFolded, 8, 0.001},
                                       {Organ::kFolded, 12, 0.002},
                                       {Organ::kFolded, 12, 0.004},
                                       {Organ::kFolded, 20, 0.002},
                                       {Organ::kLumpy, 16, 0.001},
                                       {Organ::kNotched, 24, 0.002},
                                       {Organ::kNotched, 12, 0.002}}) {
    const dquat turn = normalize(dquat(g(random), g(random), g(random), g(random)));
    Stage hollow, full;
    hollow.add(organ_of(organ, n, wall), frictionless(), Pose{{0, 0, 0}, turn});
    const Entity outer = full.add(organ_of(organ, n, 0.0), frictionless(), Pose{{0, 0, 0}, turn});
    const std::array<Stage*, 2> stages{&hollow, &full};
    dvec3 at(0.2, 0, 0);
    std::array<Entity, 2> hands;
    for (int k = 0; k < 2; ++k) {
      hands[k] = stages[k]->add_probe(at);
      stages[k]->prepare();
    }
    const auto go = [&](dvec3 to) {
      for (int k = 0; k < 2; ++k) {
        stages[k]->place(hands[k], to);
        stages[k]->tick();
      }
    };
    const auto felt = [&](int k) { return raw_force(*stages[k], hands[k]); };
    const Mesh& mesh = full.mesh(outer);
    for (int place = 0; place < 150; ++place) {
      const uvec3 t = mesh.triangles[random() % mesh.triangles.size()];
      const dvec3 a(mesh.position(t.x)), b(mesh.position(t.y)), c(mesh.position(t.z));
      const double v = u(random), w = (1 - v) * u(random);
      const dvec3 p = turn * (a + v * (b - a) + w * (c - a)), normal = turn * normalize(cross(b - a, c - a)),
                  down = -normalize(normal + (place % 2 ? 0.3 : 0.0) * dvec3(g(random), g(random), g(random)));
      const dvec3 above = 0.2 * normalize(p);
      for (int i = 1; i <= 16; ++i) {  // around the organ
        const dvec3 way = at + (above - at) * (i / 16.0);
        go(0.2 * normalize(way + (length(way) < 0.02 ? dvec3(0, 0.1, 0) : dvec3(0))));
      }
      at = above;
      go(p - 0.004 * down);
      bool free = true;
      for (int k = 0; k < 2; ++k) free = free && felt(k) == dvec3(0);
      double most = 0, off = 0, pulls = 0, hangs = 0;
      for (int i = 0; free && i <= 360; ++i) {
        const double depth = i <= 160 ? 5e-5 * i - 0.004 : 0.004 - 1e-4 * (i - 160);
        go(p + depth * down);
        const dvec3 is = felt(0), should = felt(1);
        most = std::max(most, length(should));
        off = std::max(off, length(should) - length(is));
        pulls = std::max(pulls, dot(is, down) - std::max(0.0, dot(should, down)));
        if (i > 160) hangs = std::max(hangs, length(is) - length(should));
      }
      go(above);
      if (!free) continue;
      ++pressed;
      same += off < 0.02 * most;
      EXPECT_LT(off, 0.5 * most) << int(organ) << ' ' << n << ' ' << wall << " place " << place;  // never lost
      EXPECT_LT(pulls, 0.25) << int(organ) << ' ' << n << ' ' << wall << " place " << place;      // never pulled in
      EXPECT_LT(hangs, 0.35) << int(organ) << ' ' << n << ' ' << wall << " place " << place;      // nothing holds it
    }
  }
  EXPECT_GT(pressed, 1000);
  EXPECT_GT(same, 0.95 * pressed);
}

// Two closed slabs in one node, one behind the other: the point presses both.
TEST(TouchSheets, APointPressedThroughASlabAndIntoTheNextIsPushedByBoth) {
  for (const double thickness : {0.001, 0.002})
    for (const double apart : {0.004, 0.008}) {
      Primitive walls = scenes::slab(12, 0.08, thickness);
      const Primitive wall = walls;
      const auto count = static_cast<std::uint32_t>(wall.position.size());
      for (const vec3& p : wall.position) walls.position.push_back(p - vec3(0, static_cast<float>(apart), 0));
      for (const std::uint32_t i : wall.index) walls.index.push_back(i + count);
      for (const dvec3 at : {dvec3(0.003, 0, 0.002), dvec3(0.024, 0, 0.011), dvec3(-0.022, 0, 0.021)}) {
        const Deformable d = frictionless();
        Stage stage;
        stage.add(walls, d);
        const Entity probe = stage.add_probe(at + dvec3(0, 0.005, 0));
        stage.prepare();
        double before = 0;
        for (double y = 0.005; y > -1.4 * apart - 2e-5; y -= 5e-5) {
          stage.place(probe, at + dvec3(0, y, 0));
          stage.tick();
          const double felt = raw_force(stage, probe).y;
          ASSERT_GE(felt, 0.99 * law(d, std::max(0.0, -y))) << thickness << ' ' << apart << ' ' << at.x << ' ' << y;
          ASSERT_GE(felt, before - 1e-9);
          before = felt;
        }
        std::size_t contacts = 0;  // within the dent of the first, the second adds no force yet
        for (auto [entity, contact] : stage.world.registry.view<Contact>()) contacts += contact.probe == probe;
        EXPECT_EQ(contacts, 2u);
        stage.move(probe, at + dvec3(0, 0.03, 0), 0.5);
        EXPECT_EQ(raw_force(stage, probe), dvec3(0));
      }
    }
}

// A flat lens, smooth up to its rim, pressed towards the rim deeper than it is thick: the tip slips off, is let go, and
// is neither pulled down nor held on its way back. Then the same place feels a press as before.
TEST(TouchSheets, ATipThatSlipsOffARimComesBackFree) {
  Primitive lens = scenes::sphere(40, 1.0);
  for (vec3& p : lens.position) {
    const dvec3 u(p);
    const double out = std::sqrt(u.x * u.x + u.z * u.z), wide = std::sin(0.5 * 3.14159265358979 * out);  // dense rim
    p = vec3(0.02f * vec3(dvec3(u.x, 0, u.z) * (out > 0 ? wide / out : 0.0)) +
             vec3(0, 0.002 * std::sqrt(std::max(0.0, 1 - wide * wide)) * (u.y < 0 ? -1 : 1), 0));
  }
  int slips = 0;
  for (const double radius : {0.0, 0.003, 0.006})
    for (const double start : {0.008, 0.012, 0.015, 0.017, 0.018})
      for (const double aside : {0.0, 0.05}) {
        Stage stage;
        stage.add(lens, frictionless());
        const dvec3 above(start, 0.012 + radius, 0.001);
        const Entity probe = stage.add_probe(above, radius);
        stage.prepare();
        const auto press = [&](double down) {
          stage.place(probe, above + dvec3(aside * down, -down, 0));
          stage.tick();
          return raw_force(stage, probe);
        };
        double first = 0, again = 0;
        const double lowest = 0.0135 + 2 * radius;  // beyond, it leaves the lens, and touches its other side
        for (double down = 0; down < lowest; down += 2e-5) {
          const double felt = press(down).y;
          if (down < 0.0115) first = felt;
        }
        slips += (stage.world.dropped & kDroppedRim) != 0;
        for (double down = lowest; down > 0; down -= 2e-5) {
          const dvec3 felt = press(down);
          ASSERT_GE(felt.y, -1e-9) << radius << ' ' << start << ' ' << aside << " lifted to " << down;
        }
        EXPECT_EQ(press(0), dvec3(0));
        for (double down = 0; down < 0.0115; down += 2e-5) again = press(down).y;
        EXPECT_NEAR(again, first, 1e-3 * first) << radius << ' ' << start << ' ' << aside;
      }
  EXPECT_GT(slips, 6);
}

}  // namespace
}  // namespace pliant
