// A level cannot open devices or connections by itself: the command with untrusted levels.
#include <arpa/inet.h>
#include <sys/socket.h>

#include "tests/player/command.h"

namespace pliant::testing {
namespace {

class LevelDevices : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_text(folder / "plate.obj", plate_obj(8));
    write_text(folder / "poses.csv", press_csv(0.002));
    ASSERT_EQ(pliant({"convert", "plate.obj", "level.gltf"}).status, 0);
    json = Json::parse(read_text(folder / "level.gltf"));
    for (Json& node : json["nodes"])
      if (node.contains("mesh")) node["extensions"]["PLIANT_deformable"] = Json::object();
    json["nodes"].push_back(
        {{"name", "stylus"},
         {"extensions", {{"PLIANT_probe", Json::object()}, {"PLIANT_haptic_device", {{"driver", "external"}}}}}});
    json["scenes"][0]["nodes"].push_back(json["nodes"].size() - 1);
    json["extensionsUsed"] = {"PLIANT_deformable", "PLIANT_probe", "PLIANT_haptic_device"};
  }
  void ask(const std::string& id) {
    json["nodes"].back()["extensions"]["PLIANT_haptic_device"]["id"] = id;
    write_text(folder / "level.gltf", json.dump());
  }
  std::vector<std::string> run(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"run", "level.gltf", "--seconds", "0.2",       "--frames",
                                 "0",   "--out",      "out",       "--lockstep"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Said said(const std::vector<std::string>& arguments) const {
    return pliant(arguments, "HOME=" + quoted((folder / "home").string()) + " XDG_CONFIG_HOME=");
  }
  Json json;
};

TEST_F(LevelDevices, FilesAreNeitherWrittenNorReadForALevel) {
  const std::string written = (folder / "stolen.csv").string();
  for (const std::string& id :
       {"simulated:touch,clock=tick|record=" + written, "simulated:touch,clock=tick|scale=2| record = " + written,
        std::string("simulated:touch,clock=tick|replay=poses.csv"),
        std::string("simulated:touch,clock=tick,path=poses.csv")}) {
    ask(id);
    const Said refused = said(run());
    EXPECT_EQ(refused.status, 1) << id << '\n' << refused.err;
    EXPECT_NE(refused.err.find("asks for more than it may"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("--probe "), std::string::npos) << refused.err;
    EXPECT_FALSE(fs::exists(written)) << id;
    EXPECT_EQ(said({"validate", "level.gltf"}).status, 1) << id;
    EXPECT_NE(said({"inspect", "level.gltf"}).out.find("asks for more than a level may"), std::string::npos) << id;
  }
  // The same words are permitted when they come from the user.
  const Said allowed = said(run({"--probe", "stylus=device:simulated:touch,clock=tick|record=" + written}));
  EXPECT_EQ(allowed.status, 0) << allowed.err;
  EXPECT_TRUE(fs::exists(written));
  const Said set =
      said(run({"--force", "--set", "stylus.haptic_device.id=simulated:touch,clock=tick|replay=poses.csv"}));
  EXPECT_EQ(set.status, 0) << set.err;
}

TEST_F(LevelDevices, NoHostOfALevelsChoosingIsTalkedTo) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(::bind(socket, reinterpret_cast<sockaddr*>(&own), sizeof own), 0);
  socklen_t size = sizeof own;
  ASSERT_EQ(::getsockname(socket, reinterpret_cast<sockaddr*>(&own), &size), 0);
  const std::string port = std::to_string(ntohs(own.sin_port));
  for (const std::string& id : {"network:" + port, "network:127.0.0.1:" + port, "mouse; network:localhost:" + port}) {
    ask(id);
    EXPECT_NE(said(run()).status, 0) << id;
    char byte = 0;
    EXPECT_LT(::recv(socket, &byte, 1, 0), 0) << id << ": a frame came";
  }
  ::close(socket);
}

TEST_F(LevelDevices, WhatIsLeftOfTheAlternativesIsOpenedAndTheRestIsSaid) {
  ask("network:10.0.0.7:1; simulated:touch,clock=tick");
  const Said run_of_it = said(run());
  EXPECT_EQ(run_of_it.status, 0) << run_of_it.err;
  EXPECT_NE(run_of_it.err.find("talks to an address of the network"), std::string::npos) << run_of_it.err;
  const Json report = Json::parse(read_text(folder / "out" / "report.json"));
  EXPECT_EQ(report["probes"][0]["source"], "device:simulated:touch,clock=tick");
  EXPECT_EQ(report["devices"][0]["probe"], "stylus");
}

TEST_F(LevelDevices, WrappersThatMultiplyAreRefusedFromTheUserToo) {
  ask("mouse");
  std::string words = "stylus=device:simulated:touch,clock=tick";
  for (int i = 0; i < 24; ++i) words += "|delay=1";
  const Said refused = said(run({"--probe", words}));
  EXPECT_NE(refused.status, 0);
  EXPECT_NE(refused.err.find("a device has at most 12"), std::string::npos) << refused.err;
  words.resize(words.size() - 16 * std::string("|delay=1").size());
  EXPECT_EQ(said(run({"--probe", words})).status, 0);
  const Said slow = said(run({"--probe", "stylus=device:simulated:touch,clock=tick,rate=0.01"}));
  EXPECT_NE(slow.status, 0);
  EXPECT_NE(slow.err.find("rate must be a rate from 10"), std::string::npos) << slow.err;
}

TEST_F(LevelDevices, AMisspelledProbeIsSaid) {
  ask("simulated:touch,clock=tick");
  const Said added = said(run({"--probe", "stilus=orbit"}));
  EXPECT_EQ(added.status, 0) << added.err;
  EXPECT_NE(added.err.find("did you mean stylus?"), std::string::npos) << added.err;
}

}  // namespace
}  // namespace pliant::testing
