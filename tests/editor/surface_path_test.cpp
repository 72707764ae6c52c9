// A path along a surface: nowhere deeper than its keys. Measured on the saved script, with an independent distance: by
// brute force over triangles, and with inside by the winding number.
#include "editor/document/surface_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/gtc/constants.hpp>

#include "content/level/script.h"
#include "editor/core/path_editing.h"
#include "tests/editor/small_level.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

// A box, each side in n x n squares; `shape` moves its vertices.
template <class Shape>
LevelMesh block(int n, dvec3 half, const Shape& shape) {
  Primitive p;
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double sign = side % 2 ? -1 : 1;
    const auto first = static_cast<std::uint32_t>(p.position.size());
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        dvec3 at(0);
        at[axis] = sign * half[axis];
        at[u] = (2.0 * i / n - 1) * half[u];
        at[v] = (2.0 * j / n - 1) * half[v];
        p.position.push_back(vec3(shape(at)));
      }
    const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (n + 1) + i); };
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const std::uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
        if (sign > 0)
          p.index.insert(p.index.end(), {a, b, c, a, c, d});
        else
          p.index.insert(p.index.end(), {a, c, b, a, d, c});
      }
  }
  return {"block", {std::move(p)}};
}
LevelMesh box(int n, dvec3 half) {
  return block(n, half, [](dvec3 p) { return p; });
}
// About a liver: a flattened ball with a fold.
LevelMesh organ() {
  return block(14, dvec3(1), [](dvec3 p) {
    dvec3 q = 0.06 * normalize(p);
    q.y *= 0.5;
    q.y -= 0.012 * std::exp(-std::pow(q.x / 0.012, 2)) * (q.y > 0 ? 1 : 0);
    return q;
  });
}

double to_triangle(dvec3 p, dvec3 a, dvec3 b, dvec3 c) {
  const auto edge = [&](dvec3 s, dvec3 t) {
    return length(p - s - std::clamp(dot(p - s, t - s) / dot(t - s, t - s), 0.0, 1.0) * (t - s));
  };
  const dvec3 n = normalize(cross(b - a, c - a)), foot = p - dot(p - a, n) * n;
  const auto left = [&](dvec3 s, dvec3 t) { return dot(cross(t - s, foot - s), n) >= 0; };
  if (left(a, b) && left(b, c) && left(c, a)) return std::abs(dot(p - a, n));
  return std::min({edge(a, b), edge(b, c), edge(c, a)});
}

// [m] Depth of a sphere in the mesh (inside by van Oosterom and Strackee 1983).
double indentation(const LevelMesh& mesh, dvec3 middle, double radius) {
  double nearest = 1e300, solid = 0;
  const Primitive& p = mesh.primitives[0];
  for (std::size_t t = 0; t + 2 < p.index.size(); t += 3) {
    const dvec3 a(p.position[p.index[t]]), b(p.position[p.index[t + 1]]), c(p.position[p.index[t + 2]]);
    if (!(length(cross(b - a, c - a)) > 0)) continue;
    nearest = std::min(nearest, to_triangle(middle, a, b, c));
    const dvec3 x = a - middle, y = b - middle, z = c - middle;
    const double lx = length(x), ly = length(y), lz = length(z);
    solid += 2 * std::atan2(dot(x, cross(y, z)), lx * ly * lz + dot(x, y) * lz + dot(y, z) * lx + dot(z, x) * ly);
  }
  return radius + (solid > 2 * glm::pi<double>() ? nearest : -nearest);
}

struct Pressed {
  double most_beyond = -1e300;  // [m] beyond the keys' depth
  double least_missing = 1e300, longest_step = 0.0;
  std::size_t rows = 0;
};

// The script as loaded from its file, at a hundred points between any two rows of its keys.
Pressed pressed(const LevelMesh& mesh, ScriptKeys script) {
  PathSurface ground;
  auto surface = PaintSurface::make(mesh, dmat3(1));
  EXPECT_TRUE(surface.ok());
  ground.surface = std::make_shared<const PaintSurface>(*std::move(surface));
  for (PathKey& key : script.keys) {
    const SurfaceHit hit = ground.surface->closest(key.anchor, 1.0);
    key.anchor = hit.point;
    key.normal = hit.normal;
  }
  script.along = true;
  script.rows = std::make_shared<const std::vector<PathRow>>(rows_along(script, {ground}));
  const fs::path file = fs::temp_directory_path() / ("pliant_along_" + std::to_string(::getpid()) + ".csv");
  EXPECT_TRUE(save_keys(script, file).ok());
  const Result<ScriptKeys> again = load_keys(file);
  EXPECT_TRUE(again.ok() && *again == script) << "the keys come back as they were";
  const Result<Path> path = load_script(file);
  EXPECT_TRUE(path.ok());
  fs::remove(file);
  Pressed out;
  if (!path) return out;
  const std::vector<PathRow>& rows = path->rows;
  out.rows = rows.size();
  const double seconds = rows.back().time;
  constexpr int kSamples = 400;
  std::size_t k = 0;
  for (int i = 0; i <= kSamples; ++i) {
    const double t = seconds * i / kSamples;
    while (k + 2 < rows.size() && rows[k + 1].time < t) ++k;
    const double share = std::clamp((t - rows[k].time) / (rows[k + 1].time - rows[k].time), 0.0, 1.0);
    const dquat turn = glm::slerp(rows[k].rotation, rows[k + 1].rotation, share);
    const dvec3 middle = rows[k].position + share * (rows[k + 1].position - rows[k].position) + turn * script.tip.place;
    const double beyond = indentation(mesh, middle, script.tip.radius) + height_at(script, t);
    out.most_beyond = std::max(out.most_beyond, beyond);
    out.least_missing = std::min(out.least_missing, beyond);
  }
  for (std::size_t i = 1; i < rows.size(); ++i)
    out.longest_step = std::max(out.longest_step, length(rows[i].position - rows[i - 1].position));
  return out;
}

// 1e-4 of its size, doubled where rows are joined by straight lines.
double tolerance(const LevelMesh& mesh) {
  Box box;
  for (const vec3& p : mesh.primitives[0].position) box.add(p);
  return 2e-4 * static_cast<double>(box.diagonal());
}

ScriptKeys stroke(std::vector<dvec3> places, double depth, double radius) {
  ScriptKeys script;
  script.tip.radius = radius;
  double time = 0.0;
  script.keys.push_back({time, places.front(), {}, 0.02});
  for (const dvec3& place : places) script.keys.push_back({time += 2.0, place, {}, -depth});
  script.keys.push_back({time += 1.0, places.back(), {}, 0.02});
  return script;
}

TEST(SurfacePath, IsNowhereDeeperThanItsKeysSay) {
  const LevelMesh cube = box(8, {0.04, 0.04, 0.04}), plate = box(10, {0.05, 0.004, 0.05}), liver = organ();
  for (const double radius : {0.0, 0.003, 0.012})
    for (const double depth : {0.0, 0.005}) {
      const auto check = [&](const char* what, const LevelMesh& mesh, const std::vector<dvec3>& places) {
        const Pressed all = pressed(mesh, stroke(places, depth, radius));
        EXPECT_LT(all.most_beyond, tolerance(mesh)) << what << ' ' << radius << ' ' << depth;
        EXPECT_LT(all.longest_step, 0.02) << what << ": it does not leap " << radius << ' ' << depth;
        EXPECT_LT(all.rows, 10000u) << what;
      };
      check("over the organ", liver, {{-0.04, 0.05, 0.01}, {0.0, 0.05, 0.0}, {0.045, 0.05, -0.01}});
      check("to its far side", liver, {{0.01, 0.05, 0.0}, {-0.01, -0.05, 0.0}});
      check("around corners", cube, {{0.0, 0.05, 0.01}, {0.05, 0.0, 0.0}, {0.0, -0.05, 0.0}, {0.01, 0.0, -0.05}});
      if (depth == 0.0) check("around a plate", plate, {{0.03, 0.01, 0.0}, {0.03, -0.01, 0.01}});
    }
}

TEST(SurfacePath, HoldsItsDepthOnASmoothSurface) {
  const LevelMesh ball = block(20, dvec3(1), [](dvec3 p) { return 0.05 * normalize(p); });
  const Pressed all = pressed(ball, stroke({{0.0, 0.05, 0.0}, {0.05, 0.0, 0.01}, {0.0, -0.05, 0.01}}, 0.003, 0.004));
  EXPECT_LT(all.most_beyond, tolerance(ball));
  EXPECT_GT(all.least_missing, -1e-4) << "as deep as the keys say all the way";
}

TEST(SurfacePath, TravelsOverTheSurfaceBetweenKeysInTheAir) {
  const LevelMesh liver = organ();
  ScriptKeys script;
  script.tip.radius = 0.002;
  script.keys = {{0.0, {-0.05, 0.03, 0.0}, {}, 0.01}, {3.0, {0.0, -0.05, 0.02}, {}, 0.01}};
  EXPECT_LT(pressed(liver, script).most_beyond, tolerance(liver));
}

// --- The tip of the moved tool

State with_tool(LevelMesh mesh, LocalTransform local) {
  Level level = testing::sheet_and_finger();
  LevelNode tool;
  tool.name = "tool";
  tool.mesh = 1;
  tool.rigid_body.emplace();
  tool.handle.emplace();
  tool.handle->device = "tool";
  tool.device.emplace();
  tool.local = local;
  level.meshes.push_back(std::move(mesh));
  level.nodes.push_back(tool);
  NodeId next = 1;
  return state_of(std::move(level), next);
}

TEST(SurfacePath, ATipIsTheSphereThatFitsIntoTheLowestEndOfATool) {
  // A rod along its own z, upright in the scene, with a round end of 3 mm.
  LevelMesh rod = block(16, dvec3(1), [](dvec3 p) {
    const dvec3 q = 0.003 * normalize(p);
    return dvec3(q.x, q.y, q.z > 1e-9 ? q.z + 0.1 : q.z);
  });
  LocalTransform upright;
  upright.rotation = glm::angleAxis(-0.5f * glm::pi<float>(), vec3(1, 0, 0));  // z to +y
  upright.translation = {0.02f, 0.3f, 0.0f};
  const State state = with_tool(std::move(rod), upright);
  const std::optional<PathTip> tip = tip_of(state, state.find("tool")->id);
  ASSERT_TRUE(tip);
  EXPECT_NEAR(tip->radius, 0.003, 1e-4);
  EXPECT_LT(length(tip->place), 2e-4) << "the middle of the round end";
  EXPECT_LT(length(tip->axis - dvec3(0, 0, 1)), 1e-5);
  EXPECT_LT(length(tip->stands * tip->axis - dvec3(0, 1, 0)), 1e-5);
}

TEST(SurfacePath, AToolIsTurnedAlongTheNormalWithItsTipInPlace) {
  const LevelMesh ball = block(16, dvec3(1), [](dvec3 p) { return 0.05 * normalize(p); });
  auto made = PaintSurface::make(ball, dmat3(1));
  ASSERT_TRUE(made.ok());
  const PathSurface ground{std::make_shared<const PaintSurface>(*std::move(made)), dvec3(0)};
  ScriptKeys script;
  script.along = true;
  script.tip = {{0.01, -0.12, 0.0}, 0.003, {0, 1, 0}, {1, 0, 0, 0}};
  for (const dvec3 place : {dvec3(0, 0.05, 0), dvec3(0.05, 0, 0), dvec3(0, -0.05, 0.001)}) {
    const SurfaceHit hit = ground.surface->closest(place, 1.0);
    script.keys.push_back({2.0 * static_cast<double>(script.keys.size()), hit.point, hit.normal, -0.001});
  }
  script.rows = std::make_shared<const std::vector<PathRow>>(rows_along(script, {ground}));
  for (const PathKey& key : script.keys) {
    const PathRow at = pose_at(script, key.time);
    EXPECT_LT(length(at.rotation * script.tip.axis - key.normal), 1e-6) << key.time;
    EXPECT_NEAR(length(at.position + at.rotation * script.tip.place), 0.05 + 0.003 - 0.001, 5e-4) << key.time;
    EXPECT_LT(length(position_at(script, key.time) - key.position()), 5e-4) << key.time;
  }
  const Path path = path_of(script);
  EXPECT_TRUE(path.turns);
  for (std::size_t i = 1; i < path.rows.size(); ++i)
    EXPECT_GT(std::abs(dot(path.rows[i].rotation, path.rows[i - 1].rotation)), std::cos(0.05))
        << "turns without a jump";
}

TEST(SurfacePath, ACapsuleStandsUpOnItsEnd) {
  Level level = testing::sheet_and_finger();
  level.nodes[1].probe->radius = 0.004;
  level.nodes[1].probe->length = 0.05;
  NodeId next = 1;
  const State state = state_of(std::move(level), next);
  const std::optional<PathTip> tip = tip_of(state, state.find("finger")->id);
  ASSERT_TRUE(tip);
  EXPECT_EQ(tip->radius, 0.004);
  EXPECT_EQ(tip->axis, dvec3(0, 1, 0));
}

}  // namespace
}  // namespace pliant
