// Device requests by id that a level may make, in every spelling.
#include "content/level/device_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "content/device_answers.h"
#include "content/validate.h"

namespace pliant {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(DeviceRequest, KindsAndWhatMapsTheirWorkspaceAreALevelsToAskFor) {
  for (const char* id : {"any-force", "any-pose", "any", "mouse", "simulated", "simulated:falcon,hand=finger,delay=5ms",
                         "simulated:touch,at=0:0.01:-0.02,push=1:0:0", "falcon", "spacemouse", "any-force; mouse",
                         " any-force | scale = 2 | frame = 0:90:0 ; mouse ", "falcon|clutch=0|border=40mm,rate=4",
                         "simulated|drop=10%,seed=3|quantise=0.1mm"}) {
    const DeviceRequest request = device_request(id);
    EXPECT_THAT(request.refused, IsEmpty()) << id;
    EXPECT_FALSE(request.allowed.empty()) << id;
  }
  EXPECT_EQ(device_request(" any-force | scale = 2 ; mouse ").allowed, "any-force|scale=2; mouse");
}

TEST(DeviceRequest, AddressesPortsFilesAndWhatTouchesThemAreTheUsers) {
  for (const char* id : {"network",
                         "network:",
                         "network:10.0.0.7:17716",
                         "network:evil.example:53",
                         "NETWORK:1",
                         "network :1",
                         "serial:/dev/ttyACM0",
                         "serial",
                         "falcon:/etc/passwd",
                         "gamepad:/dev/input/event3",
                         "polhem:x?home=here",
                         "touch:default",
                         "simulated:touch,path=/etc/passwd",
                         "simulated:path=../x.csv",
                         "simulated|record=/tmp/x",
                         "simulated| record = x",
                         "simulated|replay=/etc/passwd",
                         "simulated|delay=1,record=/x",
                         "simulated|scale=2|record=x",
                         "simulated|delay=/etc/passwd",
                         "simulated:touch,hand=../../x",
                         "hand:x.csv",
                         "hand",
                         "|record=x",
                         "||",
                         "",
                         "simulated|delay=5ms\n|record=x",
                         "any-force\t;network:1",
                         "simulated:%70ath=x",
                         "any-force:1",
                         "mouse:0",
                         "simul\xc3\xa4ted",
                         "simulated|re\xe2\x80\x8b"
                         "cord=x",
                         "simulated|scale",
                         "nosuchdriver",
                         "forcedimension:0"}) {
    const DeviceRequest request = device_request(id);
    EXPECT_THAT(request.refused, ::testing::Not(IsEmpty())) << id;
    EXPECT_EQ(request.allowed.find("network"), std::string::npos) << id;
    EXPECT_EQ(request.allowed.find("record"), std::string::npos) << id;
    EXPECT_EQ(request.allowed.find('/'), std::string::npos) << id;
  }
}

TEST(DeviceRequest, WhatIsRefusedIsPassedOverAndTheOthersStay) {
  const DeviceRequest request = device_request("network:10.0.0.7:1; any-force|scale=2; serial:/dev/ttyUSB0; mouse");
  EXPECT_EQ(request.allowed, "any-force|scale=2; mouse");
  ASSERT_THAT(request.refused, SizeIs(2));
  EXPECT_THAT(request.refused[0], HasSubstr("`network:10.0.0.7:1` talks to an address of the network"));
  EXPECT_THAT(request.refused[1], HasSubstr("opens a serial line"));
}

TEST(DeviceRequest, WrappersAndAlternativesAreBounded) {
  std::string many = "simulated", more;
  for (int i = 0; i < 24; ++i) many += "|delay=1";
  for (int i = 0; i < 24; ++i) more += "mouse;";
  EXPECT_THAT(device_request(many).refused, SizeIs(1));
  EXPECT_THAT(device_request(more).refused, SizeIs(1));
  EXPECT_EQ(device_request(more).allowed, "");
}

Level level_with(const std::string& id, DriverKind driver = DriverKind::kExternal) {
  Level level;
  LevelNode node;
  node.name = "it's";
  node.probe.emplace();
  node.device.emplace();
  node.device->driver = driver;
  node.device->id = id;
  node.probe_device = node.name;
  level.nodes.push_back(node);
  return level;
}

TEST(DeviceRequest, ALevelsDevicesAreNamedWithWhatTheyMove) {
  const std::vector<LevelRequest> all = device_requests(level_with("network:1'; touch x"));
  ASSERT_THAT(all, SizeIs(1));
  EXPECT_EQ(all[0].moves, "it's");
  EXPECT_TRUE(all[0].used);
  EXPECT_THAT(device_cure(all[0]), HasSubstr("--probe 'it'\\''s=device:network:1'\\''; touch x'"));
  EXPECT_FALSE(device_requests(level_with("network:1", DriverKind::kOrbit))[0].used);
}

TEST(DeviceRequest, ValidateSaysWhatIsAskedForAndWhatIsRefused) {
  const auto said = [](const std::string& id, Severity severity) {
    std::string text;
    for (const Finding& finding : validate_level(level_with(id)))
      if (finding.severity == severity) text += finding.message() + "\n";
    return text;
  };
  EXPECT_THAT(said("network:10.0.0.7:1", Severity::kError), HasSubstr("talks to an address of the network"));
  EXPECT_THAT(said("network:10.0.0.7:1; mouse", Severity::kWarning), HasSubstr("talks to an address of the network"));
  EXPECT_THAT(said("any-force; mouse", Severity::kNote), HasSubstr("asks for the device `any-force; mouse`"));
}

TEST(DeviceAnswers, AreOfOneFileAndOneTextOnly) {
  const auto folder = std::filesystem::temp_directory_path() / ("pliant-answers-" + std::to_string(::getpid()));
  {
    DeviceAnswers answers = DeviceAnswers::load(folder);
    EXPECT_FALSE(answers.allows("/a/level.glb", "network:1"));
    ASSERT_TRUE(answers.allow("/a/level.glb", "network:1"));
  }
  const DeviceAnswers again = DeviceAnswers::load(folder);
  EXPECT_TRUE(again.allows("/a/level.glb", "network:1"));
  EXPECT_TRUE(again.allows("/a/b/../level.glb", "network:1"));
  EXPECT_FALSE(again.allows("/a/level.glb", "network:1|record=x"));
  EXPECT_FALSE(again.allows("/b/level.glb", "network:1"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace pliant
