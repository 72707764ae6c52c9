// Cracks too narrow for the mesh do not exist; gaps that it resolves are edges (methods.md 1.5).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"

namespace pliant {
namespace {

// A crack in one mesh: two sheets in one primitive, a gap of a hundredth of an edge between them.
TEST(TouchCrack, ACrackNarrowerThanTheMeshResolvesDoesNotExist) {
  Primitive p = scenes::sheet(10, 0.1);
  const std::size_t count = p.position.size();
  for (std::size_t i = 0; i < count; ++i) p.position.push_back(p.position[i] + vec3(0.10005f, 0, 0));
  const std::size_t indices = p.index.size();
  for (std::size_t i = 0; i < indices; ++i) p.index.push_back(p.index[i] + static_cast<std::uint32_t>(count));
  Stage stage;
  const Deformable d = frictionless();
  stage.add(p, d);
  const Entity probe = stage.add_probe({0.02, 0.002, 0.0037});
  stage.prepare();
  stage.move(probe, {0.02, -0.003, 0.0037}, 0.1);
  for (const double x : {0.08, 0.02})
    stage.move(probe, {x, -0.003, 0.0037}, 1.0, [&](const ProbeReading&) {
      ASSERT_LT(length(raw_force(stage, probe) - dvec3(0, law(d, 0.003), 0)), 0.01 * law(d, 0.003));
    });
}

// One that the mesh does resolve is an edge: the probe falls into it.
TEST(TouchCrack, AGapOfATenthOfAnEdgeIsAGap) {
  Primitive p = scenes::sheet(10, 0.1);
  const std::size_t count = p.position.size(), indices = p.index.size();
  for (std::size_t i = 0; i < count; ++i) p.position.push_back(p.position[i] + vec3(0.101f, 0, 0));
  for (std::size_t i = 0; i < indices; ++i) p.index.push_back(p.index[i] + static_cast<std::uint32_t>(count));
  Stage stage;
  stage.add(p, frictionless());
  const Entity probe = stage.add_probe({0.04, 0.002, 0.0037});
  stage.prepare();
  stage.move(probe, {0.04, -0.003, 0.0037}, 0.1);
  EXPECT_GT(raw_force(stage, probe).y, 0.8);
  stage.move(probe, {0.0505, -0.003, 0.0037}, 0.2);
  EXPECT_EQ(raw_force(stage, probe), dvec3(0));
}

// Closed parts that are flush in one node, or in two: a crack between them does not exist, however it is met.
TEST(TouchCrack, ACrackBetweenClosedPartsDoesNotExist) {
  constexpr double kSize = 0.1;
  const Primitive half = scenes::slab(10, kSize, 0.04);
  const Deformable d = frictionless();
  const double whole = law(d, 0.003);
  for (const bool one_node : {true, false})
    for (const double crack : {0.0, 1e-9, 1e-7, 1e-6, 1e-5, 4e-5, 1e-4})
      for (const double radius : {0.0, 0.006}) {
        const auto build = [&](Stage& stage) {
          const dvec3 way(kSize + crack, 0, 0);
          if (one_node) {
            Primitive both = half;
            const std::size_t count = half.position.size();
            for (std::size_t i = 0; i < count; ++i) both.position.push_back(vec3(dvec3(half.position[i]) + way));
            for (const std::uint32_t i : half.index) both.index.push_back(i + static_cast<std::uint32_t>(count));
            stage.add(both, d);
          } else {
            stage.add(half, d);
            stage.add(half, d, Pose{way});
          }
        };
        const double middle = kSize / 2 + crack / 2;
        const std::string what = std::to_string(one_node) + " crack " + std::to_string(crack * 1e6) + " um, radius " +
                                 std::to_string(radius);
        for (const double x : {0.0, 0.3 * crack, -0.3 * crack, crack, -crack, 1e-4, -1e-3})  // pressed
          for (const double z : {0.0037, 0.0}) {  // there, and at a vertex of both sides
            Stage stage;
            build(stage);
            const Entity probe = stage.add_probe({middle + x, radius + 0.002, z}, radius);
            stage.prepare();
            stage.move(probe, {middle + x, radius - 0.003, z}, 0.1);
            stage.wait(0.01);
            EXPECT_NEAR(raw_force(stage, probe).y, whole, (0.005 + crack / 0.003) * whole)
                << what << " pressed at " << x;
            EXPECT_LT(std::abs(raw_force(stage, probe).x), (1e-6 + crack / 0.003) * whole)
                << what << " pressed at " << x;
            stage.move(probe, {middle + x, radius + 0.001, z}, 0.1);
            EXPECT_EQ(raw_force(stage, probe), dvec3(0)) << what << " lifted at " << x;
          }
        Stage stage;  // slid over it, and back
        build(stage);
        const Entity probe = stage.add_probe({middle - 0.01, radius + 0.002, 0.0037}, radius);
        stage.prepare();
        stage.move(probe, {middle - 0.01, radius - 0.003, 0.0037}, 0.1);
        double least = 1e9, most = 0, sideways = 0;
        for (const double x : {0.01, -0.01})
          stage.move(probe, {middle + x, radius - 0.003, 0.0037}, 0.5, [&](const ProbeReading&) {
            least = std::min(least, raw_force(stage, probe).y);
            most = std::max(most, raw_force(stage, probe).y);
            sideways = std::max(sideways, std::abs(raw_force(stage, probe).x));
          });
        EXPECT_NEAR(least, whole, (0.005 + crack / 0.003) * whole) << what;
        EXPECT_NEAR(most, whole, (0.005 + crack / 0.003) * whole) << what;
        EXPECT_LT(sideways, (1e-6 + crack / 0.003) * whole) << what;
      }
}

// A welded box of cells on all six faces, its top at y = 0.
Primitive box_of_cells(int n, double size) {
  Primitive p;
  std::map<std::array<int, 3>, std::uint32_t> known;
  const auto vertex = [&](std::array<int, 3> at) {
    const auto [it, is_new] = known.emplace(at, static_cast<std::uint32_t>(p.position.size()));
    if (is_new) p.position.push_back(vec3(size / n * dvec3(at[0] - n / 2.0, at[1] - n, at[2] - n / 2.0)));
    return it->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          std::array<int, 3> at{};
          at[axis] = side;
          const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
          const auto corner = [&](int k, int l) {
            at[u] = i + k, at[v] = j + l;
            return vertex(at);
          };
          const std::uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          for (const std::uint32_t w : side ? std::array{a, b, c, a, c, d} : std::array{a, c, b, a, d, c})
            p.index.push_back(w);
        }
  return p;
}

// Where four parts meet in a corner, pressed exactly there and slid over it any way.
TEST(TouchCrack, ACornerWhereFourPartsMeetIsASurface) {
  constexpr double kSize = 0.1;
  const Deformable d = frictionless();
  const double whole = law(d, 0.003);
  for (const Primitive& quarter : {scenes::slab(8, kSize, 0.04), box_of_cells(8, kSize)})
    for (const bool one_node : {true, false})
      for (const double crack : {0.0, 1e-9, 1e-7, 1e-5, 4e-5})
        for (const double radius : {0.0, 0.006}) {
          const double half = kSize / 2 + crack / 2;
          const auto build = [&](Stage& stage) {
            Primitive all;
            for (const dvec3 at : {dvec3(half, 0, half), {-half, 0, half}, {half, 0, -half}, {-half, 0, -half}}) {
              if (!one_node) stage.add(quarter, d, Pose{at});
              const auto first = static_cast<std::uint32_t>(all.position.size());
              for (const vec3& p : quarter.position) all.position.push_back(vec3(dvec3(p) + at));
              for (const std::uint32_t v : quarter.index) all.index.push_back(first + v);
            }
            if (one_node) stage.add(all, d);
          };
          const std::string what = std::to_string(one_node) + " crack " + std::to_string(crack * 1e6) + " um, radius " +
                                   std::to_string(radius);
          const double most_off = (0.005 + 1.5 * crack / 0.003) * whole;
          for (const double angle : {0.0, 0.3, M_PI / 4, 2.0}) {
            const dvec3 way(std::cos(angle), 0, std::sin(angle));
            Stage stage;
            build(stage);
            const Entity probe = stage.add_probe({0, radius + 0.002, 0}, radius);
            stage.prepare();
            stage.move(probe, {0, radius - 0.003, 0}, 0.1);
            EXPECT_NEAR(raw_force(stage, probe).y, whole, most_off) << what << " pressed";
            double least = 1e9, most = 0, sideways = 0;
            for (const double x : {0.01, -0.01, 0.0})
              stage.move(probe, x * way + dvec3(0, radius - 0.003, 0), 0.3, [&](const ProbeReading&) {
                const dvec3 f = raw_force(stage, probe);
                least = std::min(least, f.y);
                most = std::max(most, f.y);
                sideways = std::max(sideways, std::hypot(f.x, f.z));
              });
            EXPECT_NEAR(least, whole, most_off) << what << " slid at " << angle;
            EXPECT_NEAR(most, whole, most_off) << what << " slid at " << angle;
            EXPECT_LT(sideways, (1e-4 + 1.5 * crack / 0.003) * whole) << what << " slid at " << angle;
            stage.move(probe, {0, radius + 0.001, 0}, 0.1);
            EXPECT_EQ(raw_force(stage, probe), dvec3(0)) << what << " lifted";
          }
        }
}

// The same of cells so small that a stroke crosses many, and of parts that meet in a T. On `mixed` boxes the diagonals
// of opposite faces differ: where two touch, no triangle of one is one of the other.
TEST(TouchCrack, InnerWallsAreNeverTouched) {
  constexpr double kSize = 0.04, kDeep = 0.003;
  const Deformable d = frictionless();
  const double whole = law(d, kDeep);
  const Primitive plain = box_of_cells(8, kSize);
  Primitive mixed = plain;  // faces turned about z by half a turn and back: the walls at +x get the diagonals of -x
  for (std::size_t t = 0; t + 5 < mixed.index.size(); t += 6) {
    const auto corner = [&](std::size_t k) { return mixed.position[mixed.index[t + k]]; };
    if (corner(0).x != corner(1).x || corner(1).x != corner(2).x || corner(0).x < 0) continue;
    // Two triangles a, b, c and a, c, d become b, c, d and b, d, a.
    const std::uint32_t a = mixed.index[t], b = mixed.index[t + 1], c = mixed.index[t + 2], e = mixed.index[t + 5];
    const std::array<std::uint32_t, 6> other{b, c, e, b, e, a};
    std::copy(other.begin(), other.end(), mixed.index.begin() + static_cast<std::ptrdiff_t>(t));
  }
  struct Part {
    dvec3 at, scale;
  };
  const double half = kSize / 2;
  for (const Primitive* const part : std::initializer_list<const Primitive*>{&plain, &mixed})
    for (const int kind : {2, 3, 4})
      for (const bool one_node : {true, false})
        for (const double crack : {0.0, 1e-9, 1e-6, 1e-5, 4e-5}) {
          const double far = half + crack / 2;
          std::vector<Part> parts;
          if (kind == 2) parts = {{{-far, 0, 0}, dvec3(1)}, {{far, 0, 0}, dvec3(1)}};
          if (kind == 3) parts = {{{-far, 0, 0}, {1, 1, 2}}, {{far, 0, -far}, dvec3(1)}, {{far, 0, far}, dvec3(1)}};
          if (kind == 4)
            parts = {{{-far, 0, -far}, dvec3(1)},
                     {{-far, 0, far}, dvec3(1)},
                     {{far, 0, -far}, dvec3(1)},
                     {{far, 0, far}, dvec3(1)}};
          for (const double radius : {0.0, 0.004})
            for (const dvec3& way : {dvec3(0.012, 0, 0), dvec3(0.0071, 0, 0.0097), dvec3(0, 0, 0.012)}) {
              Stage stage;
              Primitive all;
              for (const Part& at : parts) {
                Primitive one = *part;
                for (vec3& p : one.position) p = vec3(dvec3(p) * at.scale + at.at);
                if (!one_node) stage.add(one, d);
                const auto first = static_cast<std::uint32_t>(all.position.size());
                all.position.insert(all.position.end(), one.position.begin(), one.position.end());
                for (const std::uint32_t v : one.index) all.index.push_back(first + v);
              }
              if (one_node) stage.add(all, d);
              const Entity probe = stage.add_probe({0, radius + 0.005, 0}, radius);
              stage.prepare();
              stage.move(probe, {0, radius - kDeep, 0}, 0.25);
              const std::string what = std::to_string(kind) + " parts, one node " + std::to_string(one_node) +
                                       ", crack " + std::to_string(crack * 1e6) + " um, radius " +
                                       std::to_string(radius) + ", mixed " + std::to_string(part == &mixed) +
                                       ", way z " + std::to_string(way.z);
              double off = length(raw_force(stage, probe) - dvec3(0, whole, 0));
              for (const double to : {1.0, -1.0})
                stage.move(probe, to * way + dvec3(0, radius - kDeep, 0), 0.3, [&](const ProbeReading&) {
                  off = std::max(off, length(raw_force(stage, probe) - dvec3(0, whole, 0)));
                });
              EXPECT_LT(off, (0.005 + 2 * crack / kDeep) * whole) << what;
              stage.move(probe, -way + dvec3(0, radius + 0.001, 0), 0.2);
              EXPECT_EQ(raw_force(stage, probe), dvec3(0)) << what << " lifted";
            }
        }
}

}  // namespace
}  // namespace pliant
