// Settings without effect are reported; others are not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "content/keys/unused_keys.h"
#include "content/level/device_use.h"
#include "content/level_file.h"

namespace pliant {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Level level_with(const std::function<void(LevelNode&)>& write) {
  Level level;
  LevelNode node;
  node.name = "it";
  write(node);
  level.nodes.push_back(node);
  return level;
}

std::vector<std::string> unused(const Level& level) {
  std::vector<std::string> pointers;
  for (const UnusedKey& key : find_unused_keys(level)) {
    pointers.push_back(key.pointer);
    EXPECT_NE(key.cure, "") << key.what;
  }
  return pointers;
}

TEST(UnusedKeys, AScaleIsOfADeviceThatIsNoPath) {
  const auto with = [](DriverKind driver) {
    return level_with([&](LevelNode& n) {
      n.probe.emplace();
      n.device.emplace();
      n.device->driver = driver;
      n.device->scale = 2.0;
    });
  };
  EXPECT_THAT(unused(with(DriverKind::kOrbit)), ElementsAre("PLIANT_haptic_device/scale"));
  EXPECT_THAT(unused(with(DriverKind::kMouse)), ElementsAre("PLIANT_haptic_device/scale"));
  EXPECT_THAT(unused(with(DriverKind::kExternal)), IsEmpty());
}

TEST(UnusedKeys, WhatTheLawOfASoftBodysDentsDoesNotReadIsSaidOnce) {
  const auto both = [](const std::function<void(LevelNode&)>& change) {
    return level_with([&](LevelNode& n) {
      n.soft_body.emplace();
      n.deformable.emplace();
      change(n);
    });
  };
  EXPECT_THAT(unused(both([](LevelNode&) {})), IsEmpty());
  EXPECT_THAT(unused(both([](LevelNode& n) {
                n.deformable->stiffness = 90.0, n.deformable->friction_static = 0.6, n.deformable->reach = 0.01;
                n.deformable->contact_damping = 0.5;
              })),
              IsEmpty());
  EXPECT_THAT(unused(both([](LevelNode& n) {
                n.deformable->settling_time = 0.2, n.deformable->texture_wavelength = 2e-3;
                n.soft_body->friction_static = 0.9, n.soft_body->contact = SoftContact::kSplit;
              })),
              ::testing::UnorderedElementsAre("PLIANT_deformable/settling_time", "PLIANT_deformable/texture.wavelength",
                                              "PLIANT_soft_body/contact", "PLIANT_soft_body/friction_static"));
}

TEST(UnusedKeys, FrictionBesideWhatItSetsIsSaid) {
  const auto with = [](std::set<std::string> stated, double stribeck = 0.0) {
    return level_with([&](LevelNode& n) {
      n.deformable.emplace();
      n.deformable->friction_sliding = n.deformable->friction_static;
      n.deformable->friction_stribeck = stribeck;
      n.stated = std::move(stated);
    });
  };
  EXPECT_THAT(unused(with({"deformable.friction"})), IsEmpty());
  EXPECT_THAT(unused(with({"deformable.friction_static", "deformable.friction_sliding"})), IsEmpty());
  EXPECT_THAT(unused(with({"deformable.friction", "deformable.friction_static"})),
              ElementsAre("PLIANT_deformable/friction"));
  EXPECT_THAT(unused(with({"deformable.friction", "deformable.friction_stribeck"}, 0.1)),
              ElementsAre("PLIANT_deformable/friction_stribeck"));
}

TEST(UnusedKeys, ALawReadsItsOwnConstantsOnly) {
  const auto with = [](SpringLaw law) {
    return level_with([&](LevelNode& n) {
      n.deformable.emplace();
      n.deformable->spring = law;
      n.deformable->cubic += 1.0;
      n.deformable->stiffening += 1.0;
      n.deformable->relaxation_time += 1.0;
    });
  };
  const std::string cubic = "PLIANT_deformable/cubic", stiffening = "PLIANT_deformable/stiffening",
                    time = "PLIANT_deformable/relaxation.time";
  EXPECT_THAT(unused(with(SpringLaw::kLinear)), ElementsAre(cubic, stiffening, time));
  EXPECT_THAT(unused(with(SpringLaw::kCubic)), ElementsAre(stiffening, time));
  EXPECT_THAT(unused(with(SpringLaw::kExponential)), ElementsAre(cubic, time));
  EXPECT_THAT(unused(with(SpringLaw::kStandardLinearSolid)), ElementsAre(cubic, stiffening));
  EXPECT_THAT(unused(with(SpringLaw::kQuasiLinearCubic)), ElementsAre(stiffening));
  EXPECT_THAT(unused(with(SpringLaw::kQuasiLinearTable)), ElementsAre(cubic, stiffening));
}

TEST(UnusedKeys, PoissonAndThicknessNeedYoung) {
  const auto with = [](double young) {
    return level_with([&](LevelNode& n) {
      n.deformable.emplace();
      n.deformable->poisson = 0.3;
      n.deformable->thickness = 0.01;
      n.deformable->young = young;
    });
  };
  EXPECT_THAT(unused(with(0.0)), ElementsAre("PLIANT_deformable/poisson", "PLIANT_deformable/thickness"));
  EXPECT_THAT(unused(with(5e3)), IsEmpty());
}

TEST(UnusedKeys, ThicknessIsOfASurfaceAndOfAWall) {
  Level level = level_with([](LevelNode& n) {
    n.deformable.emplace();
    n.deformable->young = 5e3;
    n.deformable->thickness = 0.01;
  });
  Probe sphere;
  sphere.radius = 0.003;
  level.nodes.push_back({.name = "ball", .probe = sphere});
  EXPECT_THAT(unused(level), IsEmpty());
  level.nodes.push_back({.name = "tip", .probe = Probe{}});
  EXPECT_THAT(unused(level), IsEmpty());
  const auto body = [](Fill fill) {
    return level_with([&](LevelNode& n) {
      n.soft_body.emplace();
      n.soft_body->thickness = 0.002;
      n.soft_body->fill = fill;
    });
  };
  EXPECT_THAT(unused(body(Fill::kSolid)), ElementsAre("PLIANT_soft_body/thickness"));
  EXPECT_THAT(unused(body(Fill::kWall)), IsEmpty());
}

TEST(UnusedKeys, StiffeningIsOfTheExponentialLaw) {
  const auto body = [](TissueLaw law) {
    return level_with([&](LevelNode& n) {
      n.soft_body.emplace();
      n.soft_body->law = law;
      n.soft_body->stiffening = 3.0;
    });
  };
  EXPECT_THAT(unused(body(TissueLaw::kCorotational)), ElementsAre("PLIANT_soft_body/stiffening"));
  EXPECT_THAT(unused(body(TissueLaw::kNeoHookean)), ElementsAre("PLIANT_soft_body/stiffening"));
  EXPECT_THAT(unused(body(TissueLaw::kFung)), IsEmpty());
}

TEST(UnusedKeys, AVelocityIsOfBodiesThatMoveWithoutAHandle) {
  const auto body = [](bool fixed) {
    return level_with([&](LevelNode& n) {
      n.rigid_body.emplace();
      n.rigid_body->velocity = dvec3(1, 0, 0);
      n.rigid_body->fixed = fixed;
    });
  };
  EXPECT_THAT(unused(body(true)), ElementsAre("PLIANT_rigid_body/velocity"));
  EXPECT_THAT(unused(body(false)), IsEmpty());
}

TEST(UnusedKeys, ADeviceThatNoProbeNamesMovesNothing) {
  Level level = level_with([](LevelNode& n) { n.device.emplace(); });
  EXPECT_THAT(unused(level), ElementsAre("PLIANT_haptic_device"));
  level.nodes.push_back({.name = "tip", .probe = Probe{}, .probe_device = "it"});
  EXPECT_THAT(unused(level), IsEmpty());
}

TEST(UnusedKeys, ClocksAndGravityOfBodiesNeedBodies) {
  Level level = level_with([](LevelNode& n) { n.deformable.emplace(); });
  level.simulation.gravity = dvec3(0, -1, 0);
  EXPECT_THAT(unused(level), ElementsAre("PLIANT_simulation/gravity"));
  level.nodes[0].deformable.reset();
  level.nodes[0].rigid_body.emplace();
  EXPECT_THAT(unused(level), IsEmpty());
}

TEST(UnusedKeys, ANoteSaysEachKeyOnce) {
  Level level;
  for (int i = 0; i < 3; ++i) {
    LevelNode node;
    node.name = "body_" + std::to_string(i);
    node.deformable.emplace();
    node.deformable->poisson = 0.3;
    level.nodes.push_back(node);
  }
  const std::vector<Note> notes = unused_key_notes(level);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].what, "`body_0`: PLIANT_deformable/poisson is read with `young` only");
  EXPECT_EQ(notes[0].code, "key.unused");
  EXPECT_NE(notes[0].cure.find("(2 more nodes too)"), std::string::npos) << notes[0].cure;
}

TEST(UnusedKeys, WhatShipsHasNone) {
  int levels = 0;
  for (const auto& file : std::filesystem::directory_iterator(PLIANT_SOURCE_DIR "/content/levels")) {
    if (file.path().extension() != ".glb" && file.path().extension() != ".gltf") continue;
    const Result<Level> level = load_level(file.path());
    ASSERT_TRUE(level) << file.path();
    EXPECT_THAT(unused_key_notes(*level), IsEmpty()) << file.path();
    EXPECT_THAT(find_unmoved_probes(*level), IsEmpty()) << file.path();
    ++levels;
  }
  EXPECT_GT(levels, 5);
}

TEST(UnmovedProbes, AreThoseWithoutADeviceOrWithTheDriverNull) {
  Level level;
  level.nodes.push_back({.name = "alone", .probe = Probe{}});
  level.nodes.push_back({.name = "null", .probe = Probe{}, .device = HapticDevice{}});
  level.nodes.push_back({.name = "moved", .probe = Probe{}, .device = HapticDevice{}});
  level.nodes.back().device->driver = DriverKind::kMouse;
  level.nodes.push_back({.name = "elsewhere", .probe = Probe{}, .probe_device = "moved"});
  std::vector<std::size_t> nodes;
  for (const DeviceFault& fault : find_unmoved_probes(level)) nodes.push_back(fault.node);
  EXPECT_THAT(nodes, ElementsAre(0, 1));
}

TEST(UnmovedProbes, AreOfferedAnOrbitOnlyOverASurface) {
  Level level;
  level.nodes.push_back({.name = "alone", .probe = Probe{}});
  EXPECT_THAT(find_unmoved_probes(level).at(0).what.cure, HasSubstr("alone=script:"));
  level.nodes.push_back({.name = "skin", .deformable = Deformable{}});
  EXPECT_THAT(find_unmoved_probes(level).at(0).what.cure, HasSubstr("alone=orbit"));
}

}  // namespace
}  // namespace pliant
