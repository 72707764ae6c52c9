// Strokes, fills and gradients against closed forms, and the cost of undo.
#include "editor/paint/stroke.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/editor/paint_shapes.h"

namespace pliant {
namespace {

using namespace test;

Ray straight_down(double x, double y) {
  return {{x, y, 10}, {0, 0, -1}};
}

struct PaintedSheet {
  LevelMesh mesh;
  PaintSurface surface;
  MeshPaint paint;
  explicit PaintedSheet(LevelMesh m, PaintAttribute attribute = PaintAttribute::kStiffness)
      : mesh(std::move(m)), surface(surface_of(mesh)), paint(paint_of(mesh, surface, attribute)) {}
  explicit PaintedSheet(Primitive p, PaintAttribute attribute = PaintAttribute::kStiffness)
      : PaintedSheet(LevelMesh{"mesh", {std::move(p)}}, attribute) {}
};

// Every place where two paints differ.
std::set<std::pair<std::uint32_t, std::uint32_t>> differences(const MeshPaint& a, const MeshPaint& b) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> out;
  for (std::uint32_t n = 0; n < a.layers.size(); ++n)
    for (std::uint32_t i = 0; i < a.layers[n].size(); ++i)
      if (a.layers[n].value(i) != b.layers[n].value(i)) out.insert({n, i});
  return out;
}

TEST(Stroke, OneDabOnAPlaneIsTheFalloffOfTheDistance) {
  const PaintedSheet on(sheet(80));
  const dvec3 center(0.5031, 0.4873, 0);
  const std::map<BrushFalloff, double (*)(double)> law{
      {BrushFalloff::kConstant, [](double) { return 1.0; }},
      {BrushFalloff::kLinear, [](double d) { return 1 - d; }},
      {BrushFalloff::kSmooth, [](double d) { return 1 - 3 * d * d + 2 * d * d * d; }},
      {BrushFalloff::kSharp, [](double d) { return (1 - d) * (1 - d); }}};
  for (const auto& [falloff, weight] : law) {
    Stroke stroke(on.surface, on.paint, {.radius = 0.2, .strength = 0.5, .falloff = falloff, .value = 9.0});
    stroke.move(straight_down(center.x, center.y), 0.8);
    const MeshPaint after = stroke.after();
    for (std::uint32_t i = 0; i < on.mesh.primitives[0].position.size(); ++i) {
      const double d = length(dvec3(on.mesh.primitives[0].position[i]) - center) / 0.2;
      if (std::abs(d - 1) < 1e-3) continue;
      EXPECT_NEAR(double(after.layers[0].value(i)), d < 1 ? 1 + 8 * 0.5 * 0.8 * weight(d) : 1.0, 0.03);
    }
  }
}

TEST(Stroke, GoingOverAPlaceAgainSetsItNoFartherThanTheStrength) {
  const PaintedSheet on(sheet(60));
  const Brush brush{.radius = 0.1, .strength = 0.5, .falloff = BrushFalloff::kConstant, .value = 5.0};
  Stroke stroke(on.surface, on.paint, brush);
  for (int i = 0; i < 40; ++i) stroke.move(straight_down(i % 2 ? 0.3 : 0.7, 0.5));
  EXPECT_GT(stroke.dabs(), 400u);
  const MeshPaint after = stroke.after();
  std::set<float> values;
  for (const float v : after.layers[0].flatten()) values.insert(v);
  EXPECT_EQ(values, (std::set<float>{1.0f, 3.0f}));
  // The next stroke begins where this one has ended.
  Stroke next(on.surface, after, brush);
  next.move(straight_down(0.5, 0.5));
  EXPECT_EQ(value_probe(next.after(), on.surface, on.surface.hit(straight_down(0.5, 0.5))), 4.0);
}

TEST(Stroke, DabsAreAQuarterRadiusApartHoweverThePointerMoves) {
  const PaintedSheet on(sheet(60));
  const Brush brush{.radius = 0.08, .falloff = BrushFalloff::kConstant, .mode = BrushMode::kAdd, .value = 0.25};
  for (const int moves : {1, 7, 100}) {
    Stroke stroke(on.surface, on.paint, brush);
    stroke.move(straight_down(0.2, 0.5));
    for (int i = 1; i <= moves; ++i) stroke.move(straight_down(0.2 + 0.601 * i / moves, 0.5));
    EXPECT_EQ(stroke.dabs(), 31u) << "0.6 m at 0.02 m, and the first";
    // A point in the middle is covered by every dab within a radius: 8 or 9 of them.
    const double added = value_probe(stroke.after(), on.surface, on.surface.hit(straight_down(0.5, 0.5))) - 1.0;
    EXPECT_GE(added, 8 * 0.25 - 1e-6);
    EXPECT_LE(added, 9 * 0.25 + 1e-6);
  }
}

TEST(Stroke, DabsThatWaitLeadToTheSamePaintAsDabsMadeAtOnce) {
  const PaintedSheet on(sheet(60));
  const Brush brush{.radius = 0.1, .mode = BrushMode::kSmooth};
  Primitive rough = on.mesh.primitives[0];
  for (std::size_t i = 0; i < rough.position.size(); ++i) rough.stiffness.push_back(1.0f + float(i * 7 % 13));
  const PaintedSheet from(rough);
  Stroke at_once(from.surface, from.paint, brush), in_pieces(from.surface, from.paint, brush);
  MeshPaint shown = from.paint;
  for (int i = 0; i < 5; ++i) {
    const Ray ray = straight_down(0.2 + 0.15 * i, 0.4 + 0.05 * (i % 2));
    at_once.move(ray);
    EXPECT_FALSE(at_once.waits());
    shown = with(shown, in_pieces.move(ray, 1.0, 0.0));
    if (i == 2) shown = with(shown, in_pieces.go_on(0.0));
  }
  EXPECT_TRUE(in_pieces.waits());
  EXPECT_EQ(in_pieces.dabs(), 6u) << "no time: one dab a call";
  while (in_pieces.waits()) shown = with(shown, in_pieces.go_on(0.0));
  EXPECT_TRUE(in_pieces.after() == at_once.after());
  EXPECT_TRUE(shown == at_once.after());
  EXPECT_EQ(in_pieces.dabs(), at_once.dabs());
}

TEST(Stroke, PressureIsInterpolatedBetweenMoves) {
  const PaintedSheet on(sheet(100));
  Stroke stroke(on.surface, on.paint,
                {.radius = 0.04, .falloff = BrushFalloff::kSmooth, .mode = BrushMode::kSet, .value = 2.0});
  stroke.move(straight_down(0.1, 0.5), 0.0);
  stroke.move(straight_down(0.9, 0.5), 1.0);
  const MeshPaint after = stroke.after();
  for (const double x : {0.3, 0.5, 0.7})
    EXPECT_NEAR(value_probe(after, on.surface, on.surface.hit(straight_down(x, 0.5))) - 1.0, (x - 0.1) / 0.8, 0.03)
        << x;
}

TEST(Stroke, SmoothingLeavesARampAloneAndFlattensASpike) {
  Primitive p = sheet(40);
  for (const vec3& x : p.position) p.stiffness.push_back(1.0f + x.x);
  const PaintedSheet ramp(p);
  const Brush brush{.radius = 0.2, .mode = BrushMode::kSmooth};
  Stroke over_ramp(ramp.surface, ramp.paint, brush);
  over_ramp.move(straight_down(0.4, 0.4));
  over_ramp.move(straight_down(0.6, 0.6));
  for (const auto& [n, i] : differences(ramp.paint, over_ramp.after()))
    EXPECT_NEAR(over_ramp.after().layers[n].value(i), p.stiffness[i], 1e-5f);

  p.stiffness.assign(p.position.size(), 1.0f);
  p.stiffness[20 * 41 + 20] = 50.0f;
  const PaintedSheet spike(p);
  Stroke over_spike(spike.surface, spike.paint, brush);
  double highest = 50.0;
  for (int i = 0; i < 5; ++i) {
    over_spike.move(straight_down(0.5 + 0.06 * (i % 2), 0.5));
    const std::vector<float> now = over_spike.after().layers[0].flatten();
    const double highest_now = double(*std::max_element(now.begin(), now.end()));
    EXPECT_LT(highest_now, highest);
    EXPECT_GE(*std::min_element(now.begin(), now.end()), 1.0f - 1e-6f);
    highest = highest_now;
  }
  EXPECT_LT(highest, 10.0);
}

TEST(Stroke, ErasingLeadsBackToWhatIsUnpainted) {
  for (const PaintAttribute attribute : {PaintAttribute::kFriction, PaintAttribute::kPinned}) {
    Primitive p = sheet(30);
    p.*painted_attribute(attribute).values = std::vector<float>(p.position.size(), 0.75f);
    const PaintedSheet on(p, attribute);
    Stroke stroke(on.surface, on.paint,
                  {.radius = 0.2, .falloff = BrushFalloff::kConstant, .mode = BrushMode::kErase, .value = 7});
    stroke.move(straight_down(0.5, 0.5));
    const SurfaceHit hit = on.surface.hit(straight_down(0.5, 0.5));
    EXPECT_EQ(value_probe(stroke.after(), on.surface, hit), attribute == PaintAttribute::kPinned ? 0.0 : 1.0);
  }
}

TEST(Stroke, ValuesStayWithinTheRangeOfTheirAttribute) {
  for (const auto& [attribute, low, high] :
       {std::tuple{PaintAttribute::kStiffness, 0.01f, 100.0f}, {PaintAttribute::kHandle, 0.0f, 1.0f}})
    for (const double value : {1e9, -1e9, double(INFINITY)})
      for (const BrushMode mode : {BrushMode::kSet, BrushMode::kAdd}) {
        const PaintedSheet on(sheet(20), attribute);
        Stroke stroke(on.surface, on.paint,
                      {.radius = 0.3, .falloff = BrushFalloff::kConstant, .mode = mode, .value = value});
        stroke.move(straight_down(0.5, 0.5));
        const SurfaceHit hit = on.surface.hit(straight_down(0.5, 0.5));
        EXPECT_EQ(float(value_probe(stroke.after(), on.surface, hit)), value > 0 ? high : low);
      }
}

TEST(Stroke, AMirroredStrokeIsSymmetricAndCountsOnceOnThePlane) {
  const dmat3 frame(2, 0, 0, 0, 0.5, 0, 0, 0, 1);
  const LevelMesh mesh{"sphere", {icosphere(4)}};
  for (const BrushMirror mirror : {BrushMirror::kX, BrushMirror::kY, BrushMirror::kZ})
    for (const dmat3& f : {dmat3(1), frame}) {
      const PaintSurface surface = surface_of(mesh, f);
      const MeshPaint before = paint_of(mesh, surface, PaintAttribute::kStiffness);
      Stroke stroke(surface, before, {.radius = 0.3, .mode = BrushMode::kAdd, .value = 0.5, .mirror = mirror});
      const auto onto = [&](dvec3 d) { return Ray{f * (5.0 * d), f * -d}; };
      stroke.move(onto({0.05, 0.1, 0.9}));
      stroke.move(onto({0.5, 0.5, 0.6}));
      const std::vector<float> after = stroke.after().layers[0].flatten();
      const int axis = static_cast<int>(mirror) - 1;
      std::map<std::tuple<int, int, int>, float> by_place;
      const auto place = [](vec3 p) {
        return std::tuple{int(p.x * 1e4f + (p.x > 0 ? 0.5f : -0.5f)), int(p.y * 1e4f + (p.y > 0 ? 0.5f : -0.5f)),
                          int(p.z * 1e4f + (p.z > 0 ? 0.5f : -0.5f))};
      };
      const std::vector<vec3>& position = mesh.primitives[0].position;
      for (std::size_t i = 0; i < after.size(); ++i) by_place[place(position[i])] = after[i];
      std::size_t painted = 0;
      for (std::size_t i = 0; i < after.size(); ++i) {
        vec3 image = position[i];
        image[axis] = -image[axis];
        const auto other = by_place.find(place(image));
        if (other == by_place.end()) continue;
        EXPECT_NEAR(after[i], other->second, 0.05f);
        painted += after[i] != 1.0f;
      }
      EXPECT_GT(painted, 100u);
    }
  // A dab on the plane and its image are one dab.
  const PaintedSheet on(sheet(40));
  LevelMesh centred = on.mesh;
  for (vec3& p : centred.primitives[0].position) p.x -= 0.5f;
  const PaintedSheet plane(centred);
  Stroke stroke(plane.surface, plane.paint,
                {.radius = 0.2,
                 .falloff = BrushFalloff::kConstant,
                 .mode = BrushMode::kAdd,
                 .value = 1.0,
                 .mirror = BrushMirror::kX});
  stroke.move(straight_down(0.0, 0.5));
  EXPECT_EQ(value_probe(stroke.after(), plane.surface, plane.surface.hit(straight_down(0.0, 0.5))), 2.0);
}

TEST(Stroke, CopiesOfAVertexAtASeamAlwaysGetTheSameValue) {
  Primitive right = unshared(sheet(15));
  for (vec3& p : right.position) p.x += 1.0f;
  const PaintedSheet on(LevelMesh{"seams", {unshared(sheet(15)), right}});
  Stroke stroke(on.surface, on.paint, {.radius = 0.3, .value = 20.0});
  stroke.move(straight_down(0.8, 0.5));
  stroke.move(straight_down(1.2, 0.6));
  std::map<std::tuple<float, float, float>, float> value;
  const MeshPaint after = stroke.after();
  std::size_t both = 0;
  for (std::uint32_t n = 0; n < 2; ++n)
    for (std::uint32_t i = 0; i < after.layers[n].size(); ++i) {
      const vec3 p = on.mesh.primitives[n].position[i];
      const auto [at, fresh] = value.try_emplace({p.x, p.y, p.z}, after.layers[n].value(i));
      EXPECT_EQ(at->second, after.layers[n].value(i));
      both += !fresh;
    }
  EXPECT_GT(both, 1000u);
}

TEST(Stroke, WhatItReportsIsExactlyWhatHasChanged) {
  const PaintedSheet on(LevelMesh{"two", {unshared(icosphere(3)), sheet(5)}});
  for (const BrushMode mode : {BrushMode::kSet, BrushMode::kAdd}) {
    Stroke stroke(on.surface, on.paint, {.radius = 0.3, .mode = mode, .value = 3.0});
    MeshPaint shown = on.paint;
    for (int i = 0; i < 6; ++i) {
      const PaintChanges changes = stroke.move({{5, 0.1 * i, 0.05 * i}, {-1, 0, 0}});
      std::set<std::pair<std::uint32_t, std::uint32_t>> reported;
      for (const PaintedValue& v : changes.values) {
        EXPECT_TRUE(reported.insert({v.at.primitive, v.at.index}).second) << "reported twice";
        bool within = false;
        for (const PaintedRange& r : changes.ranges)
          within = within || (r.primitive == v.at.primitive && v.at.index >= r.first && v.at.index < r.first + r.count);
        EXPECT_TRUE(within);
      }
      EXPECT_EQ(reported, differences(shown, stroke.after()));
      shown = with(shown, changes);
      EXPECT_TRUE(shown == stroke.after());
    }
    EXPECT_TRUE(stroke.before() == on.paint);
  }
}

TEST(Stroke, UndoKeepsEveryStepForWhatTheStrokesTouched) {
  const PaintedSheet on(sheet(400));  // 40 chunks
  std::vector<MeshPaint> steps{on.paint};
  std::size_t bytes = 0;
  for (int i = 0; i < 30; ++i) {
    Stroke stroke(on.surface, steps.back(), {.radius = 0.02, .value = 2.0 + i});
    stroke.move(straight_down(0.1 + 0.02 * i, 0.1 + 0.01 * i));
    stroke.move(straight_down(0.15 + 0.02 * i, 0.1 + 0.01 * i));
    steps.push_back(stroke.after());
    bytes += steps.back().layers[0].bytes_not_shared_with(steps[steps.size() - 2].layers[0]);
  }
  EXPECT_LT(bytes, 30u * 4 * PaintLayer::kChunk * sizeof(float)) << "a stroke is 16 rows of 401";
  // Repeating all strokes reproduces every step.
  MeshPaint again = on.paint;
  for (int i = 0; i < 30; ++i) {
    EXPECT_TRUE(again == steps[std::size_t(i)]);
    Stroke stroke(on.surface, again, {.radius = 0.02, .value = 2.0 + i});
    stroke.move(straight_down(0.1 + 0.02 * i, 0.1 + 0.01 * i));
    stroke.move(straight_down(0.15 + 0.02 * i, 0.1 + 0.01 * i));
    again = stroke.after();
  }
  Stroke nothing(on.surface, again, {.radius = 0.02});
  nothing.move(straight_down(5, 5));
  EXPECT_EQ(nothing.after().layers[0].bytes_not_shared_with(again.layers[0]), 0u);
}

TEST(Stroke, ItNeverCrossesAGapNorGoesThroughAThinWall) {
  Primitive slab = grid_cube(40), lid = slab;
  for (vec3& p : slab.position) p.z *= 0.001f;
  for (vec3& p : lid.position) p.z = p.z * 0.001f - 0.004f;  // another slab 2 mm below
  const PaintedSheet on(LevelMesh{"slabs", {slab, lid}});
  Stroke stroke(on.surface, on.paint, {.radius = 0.2, .value = 9.0});
  for (int i = 0; i <= 20; ++i) stroke.move(straight_down(-0.7 + 0.07 * i, 0.6 * std::sin(i)));
  const auto changed = differences(on.paint, stroke.after());
  EXPECT_GT(changed.size(), 500u);
  for (const auto& [n, i] : changed) {
    EXPECT_EQ(n, 0u);
    EXPECT_GT(on.mesh.primitives[n].position[i].z, 0.0f);
  }
}

TEST(Stroke, ThePointerLeavesThePartOnlyWhereTheMaskLetsIt) {
  Primitive right = sheet(30);
  for (vec3& p : right.position) p.x += 1.2f;
  const PaintedSheet on(LevelMesh{"two", {sheet(30), right}});
  for (const bool masked : {false, true}) {
    Stroke stroke(on.surface, on.paint, {.radius = 0.1, .value = 9.0, .mask = {.part = masked}});
    stroke.move(straight_down(0.5, 0.5));
    stroke.move(straight_down(1.7, 0.5));
    const auto changed = differences(on.paint, stroke.after());
    std::set<std::uint32_t> primitives;
    for (const auto& [n, i] : changed) primitives.insert(n);
    EXPECT_EQ(primitives.size(), masked ? 1u : 2u);
    // Up to both rims of the gap.
    EXPECT_TRUE(changed.count({0, 15 * 31 + 30}));
    EXPECT_EQ(changed.count({1, 15 * 31 + 0}), masked ? 0u : 1u);
  }
}

TEST(Paint, FillAndGradientAreWhatTheySay) {
  const PaintedSheet on(sheet(20));
  const SurfaceHit hit = on.surface.hit(straight_down(0.5, 0.5));
  const std::vector<std::uint32_t> part = on.surface.connected(hit);
  const MeshPaint filled = with(on.paint, fill(on.paint, on.surface, part, 4.0));
  EXPECT_TRUE(filled.layers[0] == PaintLayer::constant(21 * 21, 4.0f));
  EXPECT_TRUE(fill(filled, on.surface, part, 4.0).values.empty());
  EXPECT_EQ(fill(filled, on.surface, part, 1e6).values.front().value, 100.0f);

  const MeshPaint ramp = with(on.paint, gradient(on.paint, on.surface, part, {0.2, 0, 0}, {0.7, 0, 0}, 2.0, 12.0));
  for (const double x : {0.05, 0.2, 0.35, 0.6, 0.7, 0.9})
    EXPECT_NEAR(value_probe(ramp, on.surface, on.surface.hit(straight_down(x, 0.33))),
                2 + 10 * std::clamp((x - 0.2) / 0.5, 0.0, 1.0), 1e-4);
  EXPECT_TRUE(gradient(on.paint, on.surface, part, {0, 0, 0}, {0, 0, 0}, 1, 2).values.empty());
}

// As in build_mesh: an unpainted copy does not count.
TEST(Paint, PaintingAPrimitiveThatWasUnpaintedDoesNotChangeItsSeam) {
  Primitive left = sheet(20), right = sheet(20);
  for (vec3& p : right.position) p.x += 1.0f;
  left.stiffness.assign(left.position.size(), 3.0f);
  LevelMesh mesh{"two", {left, right}};
  const PaintedSheet on(mesh);
  Stroke stroke(on.surface, on.paint, {.radius = 0.05, .value = 50.0});
  stroke.move(straight_down(1.7, 0.5));
  LevelMesh after = mesh;
  store(on.paint, stroke.after(), after);
  EXPECT_EQ(after.primitives[0].stiffness, left.stiffness);
  EXPECT_EQ(after.primitives[1].stiffness.size(), right.position.size());
  const auto touched = [](const LevelMesh& m, vec3 p) {
    const auto built = build_mesh("mesh", m.primitives, mat4(1));
    for (std::uint32_t v = 0; v < built->mesh.vertex_count; ++v)
      if (built->mesh.position(v) == p) return built->mesh.stiffness_factor[v];
    return -1.0f;
  };
  for (const vec3& p : {vec3(1, 0.5f, 0), vec3(1.5f, 0, 0), vec3(0.5f, 0.5f, 0)})
    EXPECT_EQ(touched(after, p), touched(mesh, p));
  EXPECT_GT(touched(after, vec3(1.7f, 0.5f, 0)), 40.0f);

  LevelMesh untouched = mesh;
  store(on.paint, on.paint, untouched);
  EXPECT_TRUE(untouched.primitives[1].stiffness.empty());
}

}  // namespace
}  // namespace pliant
