// Notes on surfaces inside of others, before a run.
#include "systems/touch/prepare/nested.h"

#include <gtest/gtest.h>

#include "scenes/scenes.h"
#include "scenes/touch_laws.h"

namespace pliant {
namespace {

TEST(Nested, ASurfaceInsideOfAnotherIsNamedAndOneBesideOrThroughItIsNot) {
  struct Case {
    dvec3 place;
    double radius;
    std::size_t notes;
  };
  for (const Case& each : {Case{{0.01, 0, 0}, 0.03, 1}, Case{{0, 0, 0}, 0.099, 1}, Case{{0.08, 0, 0}, 0.03, 0},
                           Case{{0.06, 0.06, 0.06}, 0.02, 0}, Case{{0.3, 0, 0}, 0.03, 0}}) {
    scenes::Stage stage;
    const Entity outer = stage.add(scenes::sphere(12, 0.1), frictionless());
    const Entity inner = stage.add(scenes::sphere(6, each.radius), frictionless(), Pose{each.place});
    stage.world.registry.get<Name>(outer).value = "organ";
    stage.world.registry.get<Name>(inner).value = "stone";
    stage.add_probe({0, 1, 0});
    stage.prepare();
    const std::vector<Note> notes = explain_nested(stage.world);
    ASSERT_EQ(notes.size(), each.notes) << each.place.x << ' ' << each.radius;
    if (!notes.empty()) EXPECT_EQ(notes[0].what.find("`stone` is inside of `organ`"), 0u) << notes[0].what;
  }
}

}  // namespace
}  // namespace pliant
