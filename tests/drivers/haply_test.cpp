#include "devices/drivers/haply.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <optional>
#include <thread>

#include "devices/ports/web_socket_port.h"
#include "devices/servo/servo.h"
#include "tests/drivers/fake_haply_service.h"
#include "tests/drivers/until.h"

namespace pliant {
namespace {

using nlohmann::json;

PortOpener to_port(int port) {
  return [port](const std::string&) -> Result<std::unique_ptr<PacketPort>> {
    auto made = WebSocketPort::connect("localhost", port, 5.0, 256 * 1024);
    if (!made) return made.error();
    return std::unique_ptr<PacketPort>(std::move(*made));
  };
}

dvec3 commanded(FakeHaplyService& service) {
  const std::lock_guard lock(service.mutex);
  if (!service.force.is_object()) return dvec3(0);
  return {service.force["x"].get<double>(), service.force["y"].get<double>(), service.force["z"].get<double>()};
}

TEST(HaplyMessage, ThePublishedInventoryIsUnderstoodInWorldAxes) {
  const char* text = R"({"session_id":7,"inverse3":[{"device_id":"049D","config":{"type":"inverse3"},
    "state":{"cursor_position":{"x":0.25,"y":-0.125,"z":0.5},"cursor_velocity":{"x":1,"y":2,"z":3},
    "angular_position":{"a0":0.0,"a1":0.0,"a2":0.0},"control_mode":"idle"},"status":{"ready":true}}],
    "wireless_verse_grip":[{"device_id":"1","state":{"orientation":{"w":0.6,"x":0.0,"y":0.0,"z":0.8},
    "buttons":{"a":false,"b":true,"c":true}}}]})";
  const auto state = parse_haply(text, "");
  ASSERT_TRUE(state) << state.error().message();
  EXPECT_EQ(state->device, "049D");
  EXPECT_TRUE(state->sample.ready);
  EXPECT_EQ(state->sample.position, dvec3(0.25, 0.5, 0.125)) << "z is up there, y here";
  EXPECT_EQ(state->velocity, dvec3(1, 3, -2));
  EXPECT_NEAR(state->sample.rotation.y, 0.8, 1e-12) << "about the vertical in either";
  EXPECT_EQ(state->sample.buttons, 6u);
  EXPECT_EQ(parse_haply(text, "other")->device, "");
}

TEST(HaplyMessage, TheAxesOfAForceComeBackAsThoseOfAPosition) {
  const json command = json::parse(haply_command("a\"b", {1, 2, 3}, true));
  EXPECT_EQ(command["inverse3"][0]["device_id"], "a\"b");
  const json values = command["inverse3"][0]["commands"]["set_cursor_force"]["values"];
  json echo = {{"inverse3", {{{"device_id", "d"}, {"state", {{"cursor_position", values}}}}}}};
  EXPECT_FALSE(parse_haply(echo.dump(), "")) << "3 m are out of any arm's reach";
  for (auto& [key, value] : echo["inverse3"][0]["state"]["cursor_position"].items()) value = 0.1 * value.get<double>();
  const auto state = parse_haply(echo.dump(), "");
  ASSERT_TRUE(state);
  EXPECT_NEAR(length(state->sample.position - dvec3(0.1, 0.2, 0.3)), 0.0, 1e-9);
  EXPECT_TRUE(command.contains("session"));
  EXPECT_FALSE(json::parse(haply_command("d", {}, false)).contains("session"));
}

TEST(HaplyMessage, WhatIsNoStateIsRefusedAndWhatIsNotReadySaysSo) {
  for (const char* text :
       {"", "[", "null", "[]", "7", "{\"inverse3\":[{\"state\":{\"cursor_position\":{\"x\":NaN}}}]}",
        R"({"inverse3":[{"state":{"cursor_position":{"x":1e400,"y":0,"z":0}}}]})",
        R"({"inverse3":[{"state":{"cursor_position":{"x":"0","y":0,"z":0}}}]})",
        R"({"inverse3":[{"state":{"cursor_position":{"x":0,"y":0}}}]})",
        R"({"inverse3":[{"state":{"cursor_position":{"x":150,"y":0,"z":0}}}]})",
        R"({"inverse3":[{}],"wireless_verse_grip":[{"state":{"orientation":{"w":0,"x":0,"y":0,"z":0}}}]})"})
    EXPECT_FALSE(parse_haply(text, "")) << text;
  for (
      const char* text :
      {"{}", R"({"inverse3":{}})", R"({"inverse3":[]})", R"({"inverse3":[1]})", R"({"inverse3":[{"device_id":3}]})",
       R"({"inverse3":[{"device_id":"d","state":{"cursor_position":{"x":0,"y":0,"z":0}},"status":{"ready":false}}]})"}) {
    const auto state = parse_haply(text, "");
    ASSERT_TRUE(state) << text;
    EXPECT_FALSE(state->sample.ready) << text;
  }
  EXPECT_FALSE(parse_haply(std::string(100000, '['), ""));
}

TEST(Haply, PosesComeForcesGoAndThereIsOneStateForEachMessage) {
  FakeHaplyService service;
  service.grip = {{"orientation", {{"w", 1.0}, {"x", 0.0}, {"y", 0.0}, {"z", 0.0}}}, {"buttons", {{"a", true}}}};
  Haply haply(to_port(service.port));
  const auto opened = haply.open("");
  ASSERT_TRUE(opened) << opened.error().message();
  EXPECT_TRUE(haply.capabilities().senses_rotation);
  DeviceSample sample;
  EXPECT_TRUE(runs_until(haply, sample, {.force = {0, 1.5, 0.25}},
                         [&](bool came) { return came && commanded(service) == dvec3(0, -0.25, 1.5); }));
  EXPECT_NEAR(length(sample.position - dvec3(0, 0.15, 0.12)), 0.0, 1e-12);
  EXPECT_EQ(sample.buttons, 1u);
  EXPECT_TRUE(sample.ready);
  EXPECT_EQ(service.sessions, 1);
  // A force that is not renewed becomes zero.
  EXPECT_TRUE(soon([&] { return commanded(service) == dvec3(0); }));
  EXPECT_TRUE(
      runs_until(haply, sample, {.force = {1, 0, 0}}, [&](bool) { return commanded(service) == dvec3(1, 0, 0); }));
  haply.close();
  EXPECT_TRUE(soon([&] { return commanded(service) == dvec3(0); })) << "the last message";
  EXPECT_LE(service.asked - service.answered, 1) << "the last one may have found its line closed";
  EXPECT_GE(service.answered, 3);
}

TEST(Haply, DamagedMessagesAreDroppedAndGoodOnesTakenAgain) {
  FakeHaplyService service;
  Haply haply(to_port(service.port));
  ASSERT_TRUE(haply.open("049D"));
  DeviceSample sample;
  ASSERT_TRUE(runs_until(haply, sample, {}, [](bool came) { return came; }));
  for (const std::string bad :
       {"{\"inverse3\":", "NaN",
        R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":1e99,"y":0,"z":0}}}]})"}) {
    {
      const std::lock_guard lock(service.mutex);
      service.instead = bad;
    }
    const std::uint64_t before = haply.refused();
    EXPECT_TRUE(runs_until(haply, sample, {}, [&](bool) { return haply.refused() > before + 20; }));
    haply.read(sample);
    EXPECT_FALSE(haply.read(sample)) << bad;
    {
      const std::lock_guard lock(service.mutex);
      service.instead.clear();
    }
    EXPECT_TRUE(runs_until(haply, sample, {}, [](bool came) { return came; }));
  }
  EXPECT_EQ(haply.restarts(), 0u);
  // A message of a megabyte closes the connection, which is then reopened.
  {
    const std::lock_guard lock(service.mutex);
    service.instead = "\"" + std::string(1 << 20, 'x') + "\"";
  }
  EXPECT_TRUE(runs_until(haply, sample, {}, [&](bool) { return haply.restarts() > 0; }));
  {
    const std::lock_guard lock(service.mutex);
    service.instead.clear();
  }
  EXPECT_TRUE(runs_until(haply, sample, {}, [](bool came) { return came; }));
}

TEST(Haply, AServiceThatIsRestartedIsFoundAgainAndStartsFromZeroForce) {
  std::optional<FakeHaplyService> service;
  service.emplace();
  const int port = service->port;
  Haply haply(to_port(port));
  ASSERT_TRUE(haply.open(""));
  DeviceSample sample;
  ASSERT_TRUE(
      runs_until(haply, sample, {.force = {1, 0, 0}}, [&](bool) { return commanded(*service) == dvec3(1, 0, 0); }));
  service.reset();
  int quiet = 0;
  EXPECT_TRUE(runs_until(haply, sample, {.force = {0, 0, 0}}, [&](bool came) {
    quiet = came ? 0 : quiet + 1;
    return quiet > 100;
  }));
  service.emplace(port);
  ASSERT_EQ(service->port, port);
  EXPECT_TRUE(runs_until(haply, sample, {.force = {0, 0, 0}}, [](bool came) { return came; }));
  EXPECT_EQ(haply.restarts(), 1u);
  EXPECT_EQ(commanded(*service), dvec3(0));
  EXPECT_EQ(service->sessions, 1);
}

TEST(Haply, AMissingServiceAndAMissingDeviceAreOneSentenceEach) {
  int port = 0;
  {
    FakeHaplyService service;
    port = service.port;
    service.unplugged = true;
    EXPECT_EQ(Haply(to_port(port)).open("").error().message(),
              "haply: the Inverse Service has no Inverse3; plug it in and switch it on");
    service.unplugged = false;
    EXPECT_EQ(Haply(to_port(port)).open("0001").error().message(),
              "haply: the Inverse Service has no Inverse3 called `0001`; see `pliant devices`");
  }
  EXPECT_FALSE(Haply(to_port(port)).open(""));
  const auto missing = Haply().open("");
  if (missing) GTEST_SKIP() << "a service runs on this machine";
  EXPECT_NE(missing.error().message().find("install Haply's Inverse Service or Hub and start it"), std::string::npos)
      << missing.error().message();
  const auto listed = list_haply();
  ASSERT_EQ(listed.size(), 1u);
  EXPECT_FALSE(listed[0].missing.empty());
}

// The process is killed under 1 N. What it leaves behind says one more thing on the same line.
TEST(HaplyDevice, AfterKillNineAGuardProcessSendsAMessageOfZeroForce) {
  int to_child[2];
  ASSERT_EQ(::pipe(to_child), 0);
  const pid_t engine = ::fork();  // before there is a thread
  if (engine == 0) {
    int port = 0;
    if (::read(to_child[0], &port, sizeof port) != sizeof port) ::_exit(3);
    Servo servo(std::make_unique<Haply>(to_port(port)));
    if (!servo.open("") || !servo.start()) ::_exit(4);
    for (double wanted = 0.0;;) {
      if (servo.state() == DeviceState::kTripped) servo.arm();
      wanted = servo.felt() ? std::min(1.0, wanted + 0.02) : 0.0;
      DeviceModel model;
      model.wrench.force.y = wanted;
      servo.write_model(model, model.wrench);
      ::usleep(1000);
    }
  }
  FakeHaplyService service;
  std::thread hand([&] {  // never quite still
    for (int i = 0; ::kill(engine, 0) == 0 && i < 60000; ++i) {
      {
        const std::lock_guard lock(service.mutex);
        service.state["cursor_position"]["x"] = 1e-4 * (i % 7);
      }
      ::usleep(1000);
    }
  });
  ASSERT_EQ(::write(to_child[1], &service.port, sizeof service.port), static_cast<ssize_t>(sizeof service.port));
  EXPECT_TRUE(soon([&] { return std::abs(commanded(service).z - 1.0) < 1e-4; })) << "up is z there";
  ::kill(engine, SIGKILL);
  ::waitpid(engine, nullptr, 0);
  EXPECT_TRUE(soon([&] { return commanded(service) == dvec3(0); }));
  hand.join();
  for (const int end : to_child) ::close(end);
}

}  // namespace
}  // namespace pliant
