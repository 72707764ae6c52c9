// The stored energy on real meshes: one to eight probes move randomly on every mesh of the corpus, and no hand gets
// more work than it put in (methods.md 1.10: the force is minus the gradient of one energy; a vanishing minimum may
// lose energy).
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>

#include "content/author/touchable.h"
#include "content/level_file.h"
#include "scenes/touch_raw.h"
#include "systems/touch/collide/collision.h"
#include "systems/touch/collide/surface_query.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> meshes() {
  std::vector<std::string> found;
  const fs::path corpus(PLIANT_CORPUS_DIR);
  for (const char* folder : {"meshes-valid", "meshes-draco"}) {
    if (!fs::exists(corpus / folder)) continue;
    for (const fs::directory_entry& each : fs::recursive_directory_iterator(corpus / folder)) {
      const std::string kind = each.path().extension().string();
      if (kind == ".glb" || kind == ".obj") found.push_back(fs::relative(each.path(), corpus).string());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

// Under a sanitizer, the beginning.
#ifdef PLIANT_SANITIZED
constexpr int kTicks = 6400, kStrokes = 3;
#else
constexpr int kTicks = 16000, kStrokes = 20;
#endif

class CorpusTouch : public ::testing::TestWithParam<std::string> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(CorpusTouch);

TEST_P(CorpusTouch, GivesOutNoMoreThanWentIn) {
  Result<Level> level = load_level(fs::path(PLIANT_CORPUS_DIR) / GetParam());
  if (!level) GTEST_SKIP() << level.error().message();
  make_touchable(*level);
  Result<World> world = spawn(*level);
  ASSERT_TRUE(world.ok()) << world.error().message();
  Stage stage(16000.0);
  stage.world = std::move(*world);
  stage.world.simulation.touch_rate = 16000.0;
  std::vector<Entity> surfaces;
  Box box;
  for (auto [entity, deformable, pose] : stage.world.registry.view<Deformable, Pose>()) {
    deformable.friction_static = deformable.friction_sliding = 0.0;
    surfaces.push_back(entity);
    const Box& own = stage.world.meshes[deformable.mesh].box;
    for (const vec3 corner : {own.min, own.max}) box.add(vec3(pose.to_world(dvec3(corner))));
  }
  ASSERT_FALSE(surfaces.empty());
  const double size = box.diagonal();

  struct Hand {
    Entity probe;
    dvec3 x, v{0}, home, force{0};
  };
  std::vector<Hand> hands;
  std::mt19937 random(11);
  std::normal_distribution<double> g;
  // A hand that starts inside would be pushed out without input work: all start outside.
  const auto outside = [&](dvec3 x, double radius) {
    return std::all_of(surfaces.begin(), surfaces.end(), [&](Entity each) {
      const Mesh& mesh = stage.mesh(each);
      const dvec3 own = stage.world.registry.get<Pose>(each).to_local(x);
      if (!mesh.closed || length(own - glm::clamp(own, dvec3(mesh.box.min), dvec3(mesh.box.max))) > 0.02 * size)
        return true;
      const SurfaceFoot foot = nearest(mesh, own, 4 * size);
      return !foot.valid() || foot.height > radius + 1e-3 * size;
    });
  };
  dvec3 place(0), normal(0);
  for (int i = 0, tries = 0; i < 8 && tries < 1000; ++tries) {
    const bool beside = i % 2 == 1;  // next to the previous one
    if (!beside) {
      const Entity surface = surfaces[random() % surfaces.size()];
      const Mesh& mesh = stage.mesh(surface);
      const std::uint32_t v = static_cast<std::uint32_t>(random()) % mesh.vertex_count;
      const Pose& pose = stage.world.registry.get<Pose>(surface);
      place = pose.to_world(dvec3(mesh.position(v)));
      normal = pose.rotation * dvec3(mesh.normal(v));
    }
    const dvec3 off = (beside ? 0.01 : 0.0) * size * dvec3(g(random), g(random), g(random));
    const double radius = i % 3 == 2 ? 0.005 * size : 0.0;
    Hand hand;
    hand.x = place + (0.005 * size + radius) * normal + off;
    hand.home = place - (0.008 * size - radius) * normal + off;
    if (!outside(hand.x, radius)) continue;
    hand.probe = stage.add_probe(hand.x, radius);
    hands.push_back(hand);
    ++i;
  }
  ASSERT_EQ(hands.size(), 8u);
  stage.prepare();
  double work = 0.0, most = 0.0, gained = 0.0;
  for (int n = 0; n < kTicks; ++n) {
    const std::size_t moving = std::min<std::size_t>(hands.size(), 1 + static_cast<std::size_t>(10 * n / kTicks));
    for (std::size_t i = 0; i < moving; ++i) {
      Hand& hand = hands[i];
      hand.v += size * 0.0005 * dvec3(g(random), g(random), g(random)) + 0.025 * (hand.home - hand.x) - 0.005 * hand.v;
      hand.x += hand.v * stage.dt();
      stage.place(hand.probe, hand.x);
    }
    stage.tick();
    for (std::size_t i = 0; i < hands.size(); ++i) {
      Hand& hand = hands[i];
      const dvec3 now = raw_force(stage, hand.probe);
      if (i < moving) work += 0.5 * dot(now + hand.force, hand.v * stage.dt());
      hand.force = now;
    }
    most = std::max(most, stored(stage));
    gained = std::max(gained, work + stored(stage));
  }
  EXPECT_GT(most, 0.0);
  EXPECT_LT(gained, 2e-3 * most);
}

// A stage of the level, its tissue without friction.
void set_up(Stage& stage, const Level& level) {
  Result<World> world = spawn(level);
  ASSERT_TRUE(world.ok()) << world.error().message();
  stage.world = std::move(*world);
  stage.world.simulation.touch_rate = 16000.0;
  for (auto [entity, deformable] : stage.world.registry.view<Deformable>())
    deformable.friction_static = deformable.friction_sliding = 0.0;
}

// Number of walls that the segment enters, of all surfaces.
int walls_between(const Stage& stage, dvec3 from, dvec3 to) {
  int count = 0;
  for (auto [entity, deformable, pose] : stage.world.registry.view<const Deformable, const Pose>()) {
    const Mesh& mesh = stage.world.meshes[deformable.mesh];
    dvec3 a = pose.to_local(from);
    const dvec3 b = pose.to_local(to), step = 1e-6 * (b - a);
    for (Entry entry = first_entry(mesh, a, b); entry.valid() && count < 9; entry = first_entry(mesh, a, b)) {
      ++count;
      a += entry.fraction * (b - a) + step;
    }
  }
  return count;
}

// Whether the way enters one wall and leaves none.
bool one_wall(const Stage& stage, dvec3 from, dvec3 to) {
  return walls_between(stage, from, to) == 1 && walls_between(stage, to, from) == 0;
}

// A probe is in the stage only while it is tried: others would share its load.
void begin_at(Stage& stage, Entity probe, dvec3 x) {
  stage.world.registry.get<Probe>(probe).placed = false;
  stage.place(probe, x);
  stage.tick();
}
void take_away(Stage& stage, Entity probe, dvec3 up, dvec3 away) {
  for (const dvec3& x : {up, away}) {
    stage.place(probe, x);
    stage.tick();
  }
}

bool is_behind(const Stage& stage, Entity probe) {
  for (auto [entity, contact] : stage.world.registry.view<const Contact>())
    if (contact.probe == probe && contact.height < 0) return true;
  return false;
}

// Where a press meets one wall alone. Not on all meshes: docs/accuracy.md says where a place is off.
class CorpusStroke : public ::testing::TestWithParam<std::string> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(CorpusStroke);

TEST_P(CorpusStroke, FeelsWhatAFreshPressFeels) {
  Result<Level> level = load_level(fs::path(PLIANT_CORPUS_DIR) / GetParam());
  if (!level) GTEST_SKIP() << level.error().message();
  make_touchable(*level);
  Stage stroked(16000.0), pressed(16000.0);
  set_up(stroked, *level);
  set_up(pressed, *level);
  Box box;
  std::vector<Entity> surfaces;
  for (auto [entity, deformable, pose] : stroked.world.registry.view<Deformable, Pose>()) {
    surfaces.push_back(entity);
    const Box& own = stroked.mesh(entity).box;
    for (const vec3 corner : {own.min, own.max}) box.add(vec3(pose.to_world(dvec3(corner))));
  }
  const double size = box.diagonal(), depth = 0.008 * size, far = 0.1 * size;
  const dvec3 away = dvec3(box.max) + dvec3(10 * size);
  std::mt19937 random(5);
  struct Stroke {
    Entity hand, fresh;
    double radius;
    dvec3 x, normal, along;
  };
  std::vector<Stroke> strokes;
  for (int i = 0; i < kStrokes; ++i) {
    const Entity surface = surfaces[random() % surfaces.size()];
    const Mesh& mesh = stroked.mesh(surface);
    const Pose& pose = stroked.world.registry.get<Pose>(surface);
    const std::uint32_t v = static_cast<std::uint32_t>(random()) % mesh.vertex_count;
    const dvec3 n = pose.rotation * dvec3(mesh.normal(v));
    const dvec3 along = normalize(cross(n, std::abs(n.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    const double radius = i % 3 == 0 ? 0.0 : i % 3 == 1 ? 0.01 * size : 0.03 * size;
    const dvec3 x = pose.to_world(dvec3(mesh.position(v))) + (radius - depth) * n;
    strokes.push_back({stroked.add_probe(away, radius), pressed.add_probe(away, radius), radius, x, n, along});
  }
  stroked.prepare();
  pressed.prepare();
  int compared = 0;
  for (const Stroke& stroke : strokes) {
    const dvec3 up = far * stroke.normal;
    if (!one_wall(stroked, stroke.x + up, stroke.x - stroke.radius * stroke.normal)) continue;
    begin_at(stroked, stroke.hand, stroke.x + up);
    const bool behind = is_behind(stroked, stroke.hand);
    if (!behind) stroked.move(stroke.hand, stroke.x, 0.05);
    constexpr int kSteps = 1200;
    for (int i = 1; i <= kSteps && !behind; ++i) {
      const dvec3 x = stroke.x + 0.06 * size * i / kSteps * stroke.along;
      stroked.place(stroke.hand, x);
      stroked.tick();
      if (i % 100 || !one_wall(stroked, x + up, x - stroke.radius * stroke.normal)) continue;
      begin_at(pressed, stroke.fresh, x + up);
      if (!is_behind(pressed, stroke.fresh)) {
        pressed.move(stroke.fresh, x, 0.05);
        pressed.wait(0.02);
        stroked.wait(0.02);
        const double is = length(raw_force(stroked, stroke.hand)), should = length(raw_force(pressed, stroke.fresh));
        ++compared;
        EXPECT_NEAR(is, should, 0.02 * should + 0.003)
            << stroke.radius / size << " of the size, stroke " << &stroke - strokes.data() << " at " << i;
      }
      take_away(pressed, stroke.fresh, x + up, away);
    }
    take_away(stroked, stroke.hand, stroke.x + up, away);
  }
  EXPECT_GE(compared, 4 * kStrokes);
}

// Presses of a point and of spheres on the largest part, straight in and out, deeper than many walls are thick.
class CorpusPress : public ::testing::TestWithParam<std::string> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(CorpusPress);

TEST_P(CorpusPress, IsLetGoOnItsWayOut) {
  Result<Level> level = load_level(fs::path(PLIANT_CORPUS_DIR) / GetParam());
  if (!level) GTEST_SKIP() << level.error().message();
  std::int32_t largest = -1;
  std::size_t vertices = 0;
  for (std::size_t i = 0; i < level->nodes.size(); ++i) {
    if (level->nodes[i].mesh < 0) continue;
    std::size_t count = 0;
    for (const Primitive& each : level->meshes[static_cast<std::size_t>(level->nodes[i].mesh)].primitives)
      count += each.position.size();
    if (count > vertices) largest = static_cast<std::int32_t>(i), vertices = count;
  }
  ASSERT_TRUE(make_touchable_surface(*level, largest).ok());
  Stage stage(4000.0);
  set_up(stage, *level);
  const auto [surface, deformable, pose] = *stage.world.registry.view<const Deformable, const Pose>().begin();
  const Mesh& mesh = stage.world.meshes[deformable.mesh];
  const double size = mesh.box.diagonal(), far = 0.1 * size, depth = 0.03 * size;
  const std::array radii{0.0, 0.01 * size, 0.03 * size};
  const dvec3 away = pose.to_world(dvec3(mesh.box.max)) + dvec3(size);
  std::array<Entity, 3> hands;
  for (std::size_t i = 0; i < 3; ++i) hands[i] = stage.add_probe(away, radii[i]);
  stage.prepare();
  const auto appear = [&](Entity hand, dvec3 x) {  // not moved there, and without earlier contacts
    for (ObjectState& object : stage.world.touch->objects)
      for (SourceState& source : object.sources)
        if (source.tracked) drop_contact(source, stage.world.registry.get<Contact>(source.contact));
    stage.world.registry.get<Probe>(hand).placed = false;
    stage.world.dropped = 0;
    stage.place(hand, x);
    for (int i = 0; i < 2; ++i) stage.tick();
  };
  std::mt19937 random(8);
  std::normal_distribution<double> g;
  int presses = 0, held = 0;
  for (int place = 0; place < 40 * kStrokes; ++place) {
    const std::uint32_t v = static_cast<std::uint32_t>(random()) % mesh.vertex_count;
    const dvec3 n = normalize(pose.rotation * dvec3(mesh.normal(v)) + 0.3 * dvec3{g(random), g(random), g(random)});
    const std::size_t i = static_cast<std::size_t>(place) % 3;
    const dvec3 p = pose.to_world(dvec3(mesh.position(v))) + radii[i] * n, on = p + (1e-4 * size - radii[i]) * n;
    appear(hands[i], p + far * n);
    bool free = (stage.world.dropped & kDroppedInside) == 0 && walls_between(stage, p + far * n, on) == 0 &&
                walls_between(stage, on, p + far * n) == 0;
    for (auto [entity, contact] : stage.world.registry.view<const Contact>())
      free = free && !(contact.probe == hands[i] && contact.height < 0);
    if (!free) continue;
    ++presses;
    constexpr int kSteps = 300;
    for (int k = 1; k <= 2 * kSteps; ++k) {
      stage.place(hands[i], p + (far - (far + depth) * (k <= kSteps ? k : 2 * kSteps - k) / kSteps) * n);
      stage.tick();
    }
    held += raw_force(stage, hands[i]) != dvec3(0);
  }
  EXPECT_GE(presses, 20 * kStrokes);
  EXPECT_EQ(held, 0) << presses;
}

std::string name_of(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = fs::path(info.param).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Corpus, CorpusTouch, ::testing::ValuesIn(meshes()), name_of);
INSTANTIATE_TEST_SUITE_P(Corpus, CorpusPress, ::testing::ValuesIn(meshes()), name_of);
INSTANTIATE_TEST_SUITE_P(Corpus, CorpusStroke,
                         ::testing::Values("meshes-draco/Box_Draco.glb", "meshes-valid/gltf-transform/DenseSphere.glb",
                                           "meshes-valid/spot/spot_triangulated.obj",
                                           "meshes-valid/spot/spot_quadrangulated.obj", "meshes-valid/pmndrs/bunny.glb",
                                           "meshes-valid/draco-testdata/CesiumMan.glb",
                                           "meshes-valid/webxr-hand/right.glb"),
                         name_of);

}  // namespace
}  // namespace pliant
