// Levels that `pliant author` and the editor make of a bare mesh: they spawn, and the requested parts are in place.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "components/world.h"
#include "content/author/edit_nodes.h"
#include "content/author/instruments.h"
#include "content/author/presets.h"
#include "content/author/staging.h"
#include "content/author/surface_nets.h"
#include "content/author/touchable.h"
#include "content/keys/extensions.h"
#include "content/level_file.h"
#include "content/mesh/mesh_build.h"
#include "systems/prepare_world.h"
#include "tests/content/mesh_shapes.h"

namespace pliant::test {
namespace {

constexpr double kRadius = 0.1;  // [m]

// A ball with a rotated and scaled node.
Level ball(quat turn = quat(1, 0, 0, 0), vec3 scale = vec3(1)) {
  const solids::Solid solid = [](dvec3 p) { return length(p) - kRadius; };
  Level level;
  const Box box{vec3(-0.12f), vec3(0.12f)};
  level.meshes.push_back({"ball", {solids::to_primitive(solids::cover_by_net(solid, box, 0.02), solid)}});
  LevelNode node;
  node.name = "ball";
  node.mesh = 0;
  node.local.rotation = turn;
  node.local.scale = scale;
  node.local.translation = {0.5f, 1.0f, -2.0f};
  level.nodes.push_back(node);
  return level;
}

std::int32_t named(const Level& level, const std::string& name) {
  for (std::size_t i = 0; i < level.nodes.size(); ++i)
    if (level.nodes[i].name == name) return static_cast<std::int32_t>(i);
  return kNoLevelNode;
}
const LevelNode& at(const Level& level, std::int32_t node) {
  return level.nodes.at(static_cast<std::size_t>(node));
}

Result<World> prepared(const Level& level) {
  Result<World> world = spawn(level);
  if (!world) return world;
  if (const Status status = prepare_world(*world); !status) return status.error();
  return world;
}

TEST(Author, EveryPresetIsWithinTheRangesOfItsKeysAndOfItsSource) {
  std::set<std::string> words;
  for (const TissuePreset& preset : tissue_presets()) {
    SCOPED_TRACE(preset.word);
    EXPECT_TRUE(words.insert(preset.word).second);
    EXPECT_GT(std::string(preset.source).size(), 30u);
    EXPECT_LE(preset.low, preset.young);
    EXPECT_GE(preset.high, preset.young);
    Level level = ball();
    ASSERT_TRUE(make_soft(level, 0, soft_body_of(preset)).ok());
    // The key table reads what was written and writes it again.
    LevelNode read;
    const Json json = node_extensions(level.nodes[0], Json());
    ASSERT_TRUE(parse_node_extensions(json, "", {}, read).ok());
    EXPECT_EQ(read.soft_body->young, preset.young);
    ASSERT_TRUE(make_touchable_surface(level, 0, surface_of(preset)).ok());
    const Json surface = node_extensions(level.nodes[0], Json());
    ASSERT_TRUE(parse_node_extensions(surface, "", {}, read).ok());
    // Hertz: a flat punch of radius a on a half-space has stiffness 2 E a / (1 - nu^2).
    EXPECT_NEAR(read.deformable->stiffness, 2 * preset.young * 0.004 / (1 - preset.poisson * preset.poisson), 1e-6);
  }
}

TEST(Author, ASideIsPinnedAlongGravityHoweverTheNodeIsTurnedAndScaled) {
  const quat turns[] = {quat(1, 0, 0, 0), quat(std::sqrt(0.5f), std::sqrt(0.5f), 0, 0), quat(0, 0, 0, 1)};
  for (const quat& turn : turns)
    for (const vec3 scale : {vec3(1), vec3(0.5f, 2.0f, 1.0f)}) {
      Level level = ball(turn, scale);
      ASSERT_TRUE(make_soft(level, 0).ok());
      ASSERT_TRUE(pin(level, 0, Side::kBottom, 0.2).ok());
      // By definition: exactly the vertices in the lowest fifth of the world's box are in the box.
      const ObjectFrame frame = object_frame(level, 0);
      const Box world = world_box(level);
      const double limit = static_cast<double>(world.min.y) + 0.2 * static_cast<double>(world.size().y);
      std::size_t inside = 0;
      for (const vec3& p : level.meshes[0].primitives[0].position) {
        const dvec3 local(frame.to_object * glm::dvec4(dvec3(p), 1.0));
        const Box& box = level.nodes[0].soft_body->pinned;
        bool is_inside = true;
        for (int i = 0; i < 3; ++i)
          is_inside =
              is_inside && local[i] >= static_cast<double>(box.min[i]) && local[i] <= static_cast<double>(box.max[i]);
        const double height = frame.pose.to_world(local).y;
        if (std::abs(height - limit) > 1e-5) EXPECT_EQ(is_inside, height < limit) << height << ' ' << limit;
        inside += is_inside;
      }
      EXPECT_GT(inside, 10u);
      EXPECT_TRUE(spawn(level).ok());
    }
}

TEST(Author, TwoPinnedSidesHoldBothAndUnpinningHoldsNone) {
  Level level = ball();
  EXPECT_FALSE(pin(level, 0, Side::kTop).ok()) << "nothing is soft";
  ASSERT_TRUE(make_soft(level, 0).ok());
  EXPECT_FALSE(pin(level, 0, Side::kTop, 0.0).ok());
  EXPECT_FALSE(pin(level, 0, Side::kTop, 1.5).ok());
  ASSERT_TRUE(pin(level, 0, Side::kTop).ok());
  unpin(level, 0);
  EXPECT_TRUE(level.nodes[0].soft_body->pinned.empty());
  // Vertices on either side, and only they, are in the box or painted; what is between two sides stays free.
  const Side all[] = {Side::kBottom, Side::kTop, Side::kLeft, Side::kRight, Side::kFront, Side::kBack};
  for (const Side first : all)
    for (const Side second : all) {
      Level both = ball();
      ASSERT_TRUE(make_soft(both, 0).ok());
      ASSERT_TRUE(pin(both, 0, first, 0.2).ok());
      ASSERT_TRUE(pin(both, 0, second, 0.2).ok());
      const ObjectFrame frame = object_frame(both, 0);
      const Primitive& primitive = both.meshes[0].primitives[0];
      const dvec3 middle = 0.5 * (dvec3(frame.box.min) + dvec3(frame.box.max)), half = 0.5 * dvec3(frame.box.size());
      for (std::size_t i = 0; i < primitive.position.size(); ++i) {
        const dvec3 local(frame.to_object * glm::dvec4(dvec3(primitive.position[i]), 1.0));
        double farthest = -1.0;  // [1] of the way out to a side
        for (const Side side : {first, second})
          farthest = std::max(
              farthest, dot((local - middle) / half, glm::conjugate(frame.pose.rotation) * direction_of(both, side)));
        if (std::abs(farthest - 0.6) < 1e-4) continue;
        const Box& box = both.nodes[0].soft_body->pinned;
        const bool in_box =
            glm::all(glm::greaterThanEqual(vec3(local), box.min)) && glm::all(glm::lessThanEqual(vec3(local), box.max));
        const bool painted = !primitive.pinned.empty() && primitive.pinned[i] > 0.5f;
        EXPECT_EQ(in_box || painted, farthest > 0.6) << word_of(first) << ' ' << word_of(second);
      }
      const Result<World> world = spawn(both);
      ASSERT_TRUE(world.ok()) << word_of(first) << ' ' << word_of(second) << world.error().message();
    }
}

TEST(Author, PickedVerticesArePinnedOfThisNodeAlone) {
  Level level = ball();
  const std::int32_t copy = copy_node(level, 0);
  ASSERT_TRUE(make_soft(level, copy).ok());
  const std::uint32_t picked[] = {0, 1, 2, 3, 4, 5, 6, 7};
  ASSERT_TRUE(pin_vertices(level, copy, 0, picked).ok());
  EXPECT_NE(at(level, copy).mesh, at(level, 0).mesh);
  EXPECT_TRUE(level.meshes[static_cast<std::size_t>(at(level, 0).mesh)].primitives[0].pinned.empty());
  const std::vector<float>& pinned = level.meshes[static_cast<std::size_t>(at(level, copy).mesh)].primitives[0].pinned;
  EXPECT_EQ(std::count(pinned.begin(), pinned.end(), 1.0f), 8);
  const std::uint32_t beyond[] = {1000000};
  EXPECT_FALSE(pin_vertices(level, copy, 0, beyond).ok());
  EXPECT_FALSE(pin_vertices(level, copy, 1, picked).ok());
}

TEST(Author, EveryInstrumentIsAClosedBodyOverTheObjectThatReachesItOnItsPathWhateverItsSize) {
  for (const Instrument& instrument : instruments())
    for (const float scale : {0.2f, 1.0f, 5.0f}) {
      SCOPED_TRACE(std::string(instrument.word) + " " + std::to_string(scale));
      Level level = ball(quat(1, 0, 0, 0), vec3(scale));
      ASSERT_TRUE(make_soft(level, 0).ok());
      ASSERT_TRUE(pin(level, 0, Side::kBottom).ok());
      const Result<std::int32_t> tool = add_instrument(level, instrument.kind, named(level, "ball"));
      ASSERT_TRUE(tool.ok());
      const double top = static_cast<double>(world_box(level, named(level, "ball")).max.y),
                   diagonal = static_cast<double>(world_box(level, named(level, "ball")).diagonal());
      EXPECT_NEAR(static_cast<double>(world_box(level, *tool).min.y), top + kClearance * diagonal, 0.01 * diagonal);
      EXPECT_EQ(at(level, *tool).handle->device, at(level, *tool).name);
      const Result<World> world = prepared(level);
      ASSERT_TRUE(world.ok()) << world.error().message();
      const LevelMesh& mesh = level.meshes[static_cast<std::size_t>(at(level, *tool).mesh)];
      const Result<BuiltMesh> built = build_mesh(mesh.name, mesh.primitives, mat4(1), {});
      ASSERT_TRUE(built.ok());
      EXPECT_EQ(built->report.border_edges, 0u);
      EXPECT_EQ(built->report.non_manifold_edges, 0u);
      EXPECT_EQ(built->report.degenerate_triangles, 0u);
      // At the path's lowest point, the instrument's lowest point is inside the ball.
      const Path path = press_path(level, *tool, named(level, "ball"));
      double down = 0.0;
      for (const PathRow& row : path.rows) down = std::max(down, path.rows[0].position.y - row.position.y);
      const double lowest = static_cast<double>(world_box(level, *tool).min.y) - down;
      EXPECT_LT(lowest, top - 0.01 * diagonal);
      EXPECT_GT(lowest, top - 0.15 * diagonal);
      EXPECT_EQ(path.rows.front().position, path.rows.back().position);
    }
}

TEST(Author, AProbeStandsOverTheObjectAndItsPathPressesIt) {
  Level level = ball();
  ASSERT_TRUE(make_touchable_surface(level, 0).ok());
  const Result<std::int32_t> probe = add_probe(level, 0, 0.005);
  ASSERT_TRUE(probe.ok());
  EXPECT_EQ(at(level, *probe).probe_device, at(level, *probe).name);
  const double top = 1.0 + kRadius;
  const Path path = press_path(level, *probe, named(level, "ball"), 0.01);
  double lowest = 1e9;
  for (const PathRow& row : path.rows) lowest = std::min(lowest, row.position.y);
  EXPECT_NEAR(lowest, top - 0.01 + 0.005, 2e-3);
  EXPECT_TRUE(prepared(level).ok());
}

TEST(Author, AnOpenDomeIsPressed) {
  Primitive dome = test::globe(24, 16);  // a vertex on top
  std::vector<std::uint32_t> upper;
  for (std::size_t i = 0; i < dome.index.size(); i += 3)
    if (dome.position[dome.index[i]].y > 0 && dome.position[dome.index[i + 1]].y > 0 &&
        dome.position[dome.index[i + 2]].y > 0)
      upper.insert(upper.end(), dome.index.begin() + static_cast<std::ptrdiff_t>(i),
                   dome.index.begin() + static_cast<std::ptrdiff_t>(i) + 3);
  dome.index = upper;
  Level level = test::level_of(dome);
  ASSERT_TRUE(make_touchable_surface(level, 0).ok());
  const Result<std::int32_t> probe = add_probe(level, 0, 0.05);
  ASSERT_TRUE(probe.ok());
  double lowest = 1e9;
  for (const PathRow& row : press_path(level, *probe, *probe == 0 ? 1 : 0).rows) lowest = std::min(lowest, row.position.y);
  EXPECT_LT(lowest, 1.0 + 0.05 - 0.05) << "a twentieth of its diagonal deep";
}

TEST(Author, AProbeStandsBesideATool) {
  for (const dvec3 gravity : {dvec3(0, -9.81, 0), dvec3(0, 0, -9.81)}) {
    Level level = ball();
    level.simulation.gravity = gravity;
    ASSERT_TRUE(make_soft(level, 0).ok());
    const Result<std::int32_t> tool = add_instrument(level, InstrumentKind::kRod, 0, {});
    const Result<std::int32_t> probe = add_probe(level, 0, 0.005);
    ASSERT_TRUE(tool.ok() && probe.ok());
    const Box rod = world_box(level, *tool);
    const vec3 place = at(level, *probe).local.translation;
    EXPECT_GT(length(place - glm::clamp(place, rod.min, rod.max)), 0.005f);
    double nearest = 1e9;
    for (const PathRow& row : press_path(level, *probe, named(level, "ball"), 0.01).rows)
      nearest = std::min(nearest, length(row.position - dvec3(0.5, 1, -2)));
    EXPECT_LT(nearest, kRadius) << "its path presses the ball";
  }
}

// A tall block at the end of a sheet that lies below the middle of the box.
TEST(Author, WhereTheMiddleIsThinWhatIsThickIsPressed) {
  Level level;
  Primitive shape;
  const auto add_box = [&](vec3 middle, vec3 half) {
    const Primitive part = test::box(half, false);
    const auto first = static_cast<std::uint32_t>(shape.position.size());
    for (const vec3& p : part.position) shape.position.push_back(middle + p);
    for (const std::uint32_t i : part.index) shape.index.push_back(first + i);
  };
  add_box({-0.02f, 0.001f, 0}, {0.08f, 0.001f, 0.02f});
  add_box({0.08f, 0.025f, 0}, {0.02f, 0.025f, 0.02f});
  level.meshes.push_back({"step", {shape}});
  LevelNode node;
  node.name = "step";
  node.mesh = 0;
  level.nodes.push_back(node);
  const Result<std::int32_t> probe = add_probe(level, 0, 0.004);
  ASSERT_TRUE(probe.ok());
  const Path path = press_path(level, *probe, 0);
  EXPECT_GT(path.rows[0].position.x, 0.06);
  double lowest = 1e9;
  for (const PathRow& row : path.rows) lowest = std::min(lowest, row.position.y);
  EXPECT_LT(lowest, 0.05 + 0.004 - 0.005);
}

TEST(Author, ARingIsPressedOnItsCrownAndASecondToolStandsBesideTheFirst) {
  constexpr double kRing = 0.05, kThick = 0.015;
  const solids::Solid solid = [](dvec3 p) { return std::hypot(std::hypot(p.x, p.z) - kRing, p.y) - kThick; };
  Level level = ball();
  level.meshes[0].primitives = {solids::to_primitive(
      solids::cover_by_net(solid, {vec3(-0.07f, -0.02f, -0.07f), vec3(0.07f, 0.02f, 0.07f)}, 0.004), solid)};
  dvec3 place[2];
  for (dvec3& each : place) {
    const Result<std::int32_t> tool = add_instrument(level, InstrumentKind::kRod, named(level, "ball"));
    ASSERT_TRUE(tool.ok()) << tool.error().sentence();
    each = dvec3(at(level, *tool).local.translation) - dvec3(0.5, 1.0, -2.0);
    EXPECT_NEAR(std::hypot(each.x, each.z), kRing, 0.5 * kThick);  // 30 degrees of the slope
  }
  EXPECT_GT(std::hypot(place[0].x - place[1].x, place[0].z - place[1].z), 0.005);
}

TEST(Author, AllOfTheObjectIsInTheCamerasPictureWhereverGravityPoints) {
  for (const dvec3 gravity : {dvec3(0, -9.81, 0), dvec3(0, 0, -9.81), dvec3(0), dvec3(1, 0, 0)}) {
    Level level = ball();
    level.simulation.gravity = gravity;
    const std::int32_t camera = add_camera(level, 0);
    const std::int32_t light = add_light(level, named(level, "ball"));
    const std::int32_t eye = named(level, "camera");
    EXPECT_EQ(camera, eye);
    const dmat4 world = glm::inverse(world_matrices(level.nodes)[static_cast<std::size_t>(eye)]);
    const double half = std::tan(0.5 * static_cast<double>(at(level, eye).camera->yfov));
    for (const vec3& p : level.meshes[0].primitives[0].position) {
      const dvec3 seen(world * glm::dvec4(dvec3(p) + dvec3(0.5, 1.0, -2.0), 1.0));
      ASSERT_LT(seen.z, -static_cast<double>(at(level, eye).camera->znear));
      ASSERT_LT(std::abs(seen.y), -seen.z * half);
      ASSERT_LT(std::abs(seen.x), -seen.z * half);
    }
    // The lamp shines along its -Z: towards the object, downwards.
    const dvec3 beam = dquat(at(level, light).local.rotation) * dvec3(0, 0, -1);
    if (length(gravity) > 0.0) EXPECT_GT(dot(beam, gravity), 0.0);
  }
}

TEST(Author, WhatHasNoSurfaceIsRefusedInASentence) {
  Level level;
  level.nodes.resize(1);
  level.nodes[0].name = "empty";
  EXPECT_FALSE(make_soft(level, 0).ok());
  EXPECT_FALSE(make_touchable_surface(level, 0).ok());
  EXPECT_FALSE(add_instrument(level, InstrumentKind::kRod, 0).ok());
  EXPECT_FALSE(add_probe(level, 0).ok());
}

TEST(EditNodes, ANodeMovedToAnotherParentStaysWhereItIsInTheWorld) {
  Level level = ball(normalize(quat(0.3f, 0.5f, -0.2f, 0.7f)));
  LevelNode frame;
  frame.name = "frame";
  frame.local.translation = {1, 2, 3};
  frame.local.rotation = normalize(quat(0.9f, 0.1f, 0.3f, -0.2f));
  frame.local.scale = vec3(2.0f);
  const std::int32_t parent = add_node(level, frame);
  const std::int32_t before = named(level, "ball");
  const dmat4 was = world_matrices(level.nodes)[static_cast<std::size_t>(before)];
  const Result<NodesMoved> moved = move_node(level, before, parent, 0);
  ASSERT_TRUE(moved.ok());
  const std::int32_t now = (*moved)[static_cast<std::size_t>(before)];
  EXPECT_EQ(now, named(level, "ball"));
  EXPECT_EQ(at(level, now).parent, named(level, "frame"));
  const dmat4 is = world_matrices(level.nodes)[static_cast<std::size_t>(now)];
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) EXPECT_NEAR(was[c][r], is[c][r], 1e-6);
  EXPECT_FALSE(move_node(level, named(level, "frame"), named(level, "ball"), 0).ok()) << "below itself";
  // Back among the roots, the first of them.
  ASSERT_TRUE(move_node(level, named(level, "ball"), kNoLevelNode, 0).ok());
  EXPECT_EQ(named(level, "ball"), 0);
  EXPECT_EQ(at(level, 0).parent, kNoLevelNode);
}

TEST(EditNodes, ACopyGoesByItsOwnDeviceAndARemovedDeviceIsForgotten) {
  Level level = ball();
  ASSERT_TRUE(make_soft(level, 0).ok());
  const Result<std::int32_t> tool = add_instrument(level, InstrumentKind::kRod, 0);
  ASSERT_TRUE(tool.ok());
  const std::int32_t copy = copy_node(level, *tool);
  EXPECT_EQ(at(level, copy).name, "rod_2");
  EXPECT_EQ(at(level, copy).handle->device, "rod_2");
  EXPECT_EQ(at(level, copy).mesh, at(level, named(level, "rod")).mesh);
  ASSERT_TRUE(rename_node(level, named(level, "rod"), "stick").ok());
  EXPECT_EQ(at(level, named(level, "stick")).handle->device, "stick");
  const Result<std::int32_t> probe = add_probe(level, named(level, "ball"));
  ASSERT_TRUE(probe.ok());
  level.nodes[static_cast<std::size_t>(*probe)].probe_device = "stick";
  remove_node(level, named(level, "stick"));
  EXPECT_EQ(at(level, named(level, "probe")).probe_device, "");
  EXPECT_EQ(level.meshes.size(), 2u) << "the copy still shows the rod";
  EXPECT_TRUE(check_references(level).ok());
}

TEST(EditNodes, AnEffectNamesTheProbesThatItMeans) {
  Level level = ball();
  ASSERT_TRUE(add_probe(level, 0).ok());
  LevelNode magnet;
  magnet.name = "magnet";
  magnet.effect.emplace().probes = {"probe"};
  add_node(level, magnet, named(level, "probe"));
  const auto names = [&](const char* effect) { return at(level, named(level, effect)).effect->probes; };
  using Names = std::vector<std::string>;
  copy_node(level, named(level, "probe"));
  EXPECT_EQ(names("magnet"), Names{"probe"});
  EXPECT_EQ(names("magnet_2"), Names{"probe_2"}) << "a copy is felt by its own";
  ASSERT_TRUE(rename_node(level, named(level, "probe"), "thumb").ok());
  EXPECT_EQ(names("magnet"), Names{"thumb"});
  LevelNode wall = magnet;
  wall.name = "wall";
  wall.effect->probes = {"thumb", "probe_2"};
  add_node(level, wall);
  EXPECT_TRUE(check_references(level).ok());
  remove_node(level, named(level, "thumb"));
  EXPECT_EQ(names("wall"), Names{"probe_2"});
  EXPECT_TRUE(check_references(level).ok());
  remove_node(level, named(level, "probe_2"));
  EXPECT_EQ(names("wall"), Names{"probe_2"}) << "with no name every probe would feel it";
  EXPECT_FALSE(check_references(level).ok());
}

}  // namespace
}  // namespace pliant::test
