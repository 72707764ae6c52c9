// The public interface, used as a program that embeds the engine does: public headers alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/engine/session_rig.h"

namespace pliant {
namespace {

using testing::HasSubstr;

TEST(Session, FeelsStiffnessTimesDepth) {
  Session session = opened(press_scene());
  EXPECT_THAT(session.effectors(), testing::ElementsAre("finger"));
  EXPECT_THAT(session.objects(), testing::ElementsAre("tissue"));
  press(session, 0.002);
  const Reading felt = *session.reading("finger");
  EXPECT_TRUE(felt.ready && felt.touching);
  EXPECT_NEAR(felt.force.y, 300.0 * 0.002, 1e-6);
  EXPECT_NEAR(felt.depth, 0.002, 1e-9);
  EXPECT_EQ(felt.object, 0u);
  ASSERT_EQ(felt.contacts, 1u);
  EXPECT_NEAR(length(felt.contact[0].normal - dvec3(0, 1, 0)), 0.0, 1e-6);
}

TEST(Session, TheSameInputGivesTheSameBitsAndRestartsGiveThemAgain) {
  Session session = opened(press_scene()), other = opened(press_scene());
  press(session, 0.003);
  press(other, 0.003);
  const dvec3 force = session.reading("finger")->force;
  EXPECT_EQ(force, other.reading("finger")->force);
  ASSERT_TRUE(session.restart());
  EXPECT_EQ(session.time(), 0.0);
  press(session, 0.003);
  EXPECT_EQ(force, session.reading("finger")->force);
}

TEST(Session, ShowsVerticesInTheOrderOfItsMeshAndWhatPressesOnThem) {
  const MeshData mesh = sheet();
  Scene scene;
  Placement placement;
  placement.position = {0, 0, 0};
  placement.scale = dvec3(2);
  MeshData half = mesh;
  for (vec3& p : half.position) p *= 0.5f;
  scene.add_surface("tissue", half, {.stiffness = 300.0}, placement);
  scene.add_probe("finger");
  Session session = opened(scene);
  std::vector<vec3> now, force;
  ASSERT_TRUE(session.vertices("tissue", now));
  EXPECT_EQ(now, mesh.position) << "at rest";
  press(session, 0.004);
  ASSERT_TRUE(session.vertices("tissue", now));
  ASSERT_EQ(now.size(), mesh.position.size());
  const std::size_t middle = 25 * 51 + 25;
  EXPECT_NEAR(now[middle].y, -0.004, 1e-5);
  EXPECT_EQ(now.front(), mesh.position.front()) << "far from the press nothing moves";
  ASSERT_TRUE(session.vertex_forces("tissue", force));
  vec3 sum(0);
  for (const vec3 f : force) sum += f;
  EXPECT_NEAR(sum.y, -session.reading("finger")->force.y, 1e-6) << "action and reaction";
  EXPECT_LT(force[middle].y, -0.1f);
}

TEST(Session, GeometryAndStreamAreTheDeformedVertices) {
  Session session = opened(press_scene());
  const Geometry geometry = *session.geometry("tissue");
  press(session, 0.004);
  std::vector<vec4> stream;
  ASSERT_TRUE(session.stream("tissue", stream));
  std::vector<vec3> vertices;
  ASSERT_TRUE(session.vertices("tissue", vertices));
  const mat4 to_world = *session.to_world("tissue");
  float lowest = 0.0f, lowest_vertex = 0.0f;
  for (std::size_t i = 0; i < geometry.position.size(); ++i) {
    const vec3 p = geometry.position[i] + stream[geometry.stream_vertex[i]].w * geometry.normal[i];
    lowest = std::min(lowest, vec3(to_world * vec4(p, 1)).y);
  }
  for (const vec3 p : vertices) lowest_vertex = std::min(lowest_vertex, p.y);
  EXPECT_EQ(lowest, lowest_vertex);
  EXPECT_LT(lowest, -0.003f);
}

TEST(Session, OnlyTheChangedPartsOfTheStreamAreCopied) {
  Session session = opened(press_scene());
  std::vector<vec4> whole, kept;
  std::vector<StreamPart> changed;
  const auto vertices = [&] {
    std::size_t sum = 0;
    for (const StreamPart& part : changed) sum += part.count;
    return sum;
  };
  ASSERT_TRUE(session.stream("tissue", kept, changed));
  ASSERT_EQ(vertices(), kept.size());
  ASSERT_TRUE(session.stream("tissue", kept, changed));
  EXPECT_TRUE(changed.empty()) << "nothing has moved";
  std::size_t least = kept.size();
  for (int i = 0; i < 5; ++i) {
    press(session, 0.001 * (1 + i));
    ASSERT_TRUE(session.stream("tissue", whole));
    const std::vector<vec4> before = kept;
    ASSERT_TRUE(session.stream("tissue", kept, changed));
    EXPECT_EQ(kept, whole);
    ASSERT_FALSE(changed.empty());
    least = std::min(least, vertices());
    std::vector<vec4> spliced = before;  // by the parts alone
    for (const StreamPart& part : changed)
      std::copy_n(whole.begin() + part.first, part.count, spliced.begin() + part.first);
    EXPECT_EQ(spliced, whole);
  }
  EXPECT_LT(least, kept.size()) << "a small press changes a part";
  ASSERT_TRUE(session.restart());
  ASSERT_TRUE(session.stream("tissue", kept, changed));
  EXPECT_EQ(vertices(), kept.size());
  EXPECT_EQ(kept.front(), vec4(0));
}

TEST(Session, ParametersChangeBetweenTicksAndStayThroughARestart) {
  Session session = opened(press_scene());
  ASSERT_TRUE(session.set("tissue", "stiffness", 500.0));
  EXPECT_EQ(*session.get("tissue", "stiffness"), 500.0);
  press(session, 0.002);
  EXPECT_NEAR(session.reading("finger")->force.y, 1.0, 1e-5);
  ASSERT_TRUE(session.restart());
  press(session, 0.002);
  EXPECT_NEAR(session.reading("finger")->force.y, 1.0, 1e-5);
  ASSERT_TRUE(session.set("finger", "max_force", 0.4));
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(session.step());
  EXPECT_NEAR(session.reading("finger")->force.y, 0.4, 1e-9);
  EXPECT_THAT(session.set("tissue", "stifness", 1.0).error().message(), HasSubstr("did you mean stiffness?"));
  EXPECT_FALSE(session.set("tissue", "stiffness", -1.0));
  EXPECT_FALSE(session.set("tissue", "stiffness", std::nan("")));
  EXPECT_FALSE(session.set("nothing", "stiffness", 1.0));
}

TEST(Session, MisuseIsASentence) {
  Session session = opened(press_scene());
  EXPECT_THAT(session.move("thumb", {}).error().message(), HasSubstr("they are: finger"));
  EXPECT_THAT(session.reading("thumb").error().message(), HasSubstr("they are: finger"));
  std::vector<vec3> vertices;
  EXPECT_THAT(session.vertices("liver", vertices).error().message(), HasSubstr("they are: tissue"));
  EXPECT_FALSE(session.move("finger", {std::nan(""), 0, 0}));
  EXPECT_FALSE(session.move("finger", {}, {0, 0, 0, 0}));
  EXPECT_FALSE(session.follow("finger", {}));
  EXPECT_THAT(session.pause(true).error().message(), HasSubstr("start()"));
  EXPECT_THAT(session.connect("finger", "nobody:1").error().message(), HasSubstr("driver"));
  EXPECT_THAT(session.connect("finger", std::unique_ptr<Driver>()).error().message(), HasSubstr("null"));
  ASSERT_TRUE(session.move("finger", {0, 1, 0}));
  EXPECT_THAT(session.orbit("finger").error().message(), HasSubstr("release()"));
  ASSERT_TRUE(session.release("finger"));
  EXPECT_TRUE(session.orbit("finger"));
  ASSERT_TRUE(session.step());
  EXPECT_THAT(session.start().error().message(), HasSubstr("restart()"));
  ASSERT_TRUE(session.restart());
  ASSERT_TRUE(session.start());
  EXPECT_THAT(session.step().error().message(), HasSubstr("stop()"));
  EXPECT_THAT(session.start().error().message(), HasSubstr("stop()"));
  EXPECT_THAT(session.release("finger").error().message(), HasSubstr("stop()"));
  EXPECT_TRUE(session.stop());
  EXPECT_TRUE(session.stop()) << "twice is once";
}

TEST(Session, AnUnusableSceneIsASentence) {
  Scene empty;
  empty.add_surface("nothing", {});
  EXPECT_FALSE(Session::open(empty));
  Scene twice = press_scene();
  twice.add_probe("finger");
  EXPECT_FALSE(Session::open(twice));
  Scene nameless;
  nameless.add_surface("", sheet());
  EXPECT_FALSE(Session::open(nameless));
  Scene wild = press_scene();
  wild.add_surface("wild", sheet(), {.stiffness = -5.0});
  EXPECT_THAT(Session::open(wild).error().message(), HasSubstr("stiffness"));
  MeshData torn = sheet();
  torn.index[7] = 1000000;
  Scene scene;
  scene.add_surface("torn", torn);
  EXPECT_FALSE(Session::open(scene));
  torn = sheet();
  torn.index.pop_back();
  Scene odd;
  odd.add_surface("odd", torn);
  EXPECT_FALSE(Session::open(odd));
  torn = sheet();
  torn.stiffness.assign(3, 1.0f);
  Scene painted;
  painted.add_surface("painted", torn);
  EXPECT_FALSE(Session::open(painted));
}

TEST(Session, AToolIsHeldByItsHandleAndLiesOnARigidFloor) {
  Scene scene;
  scene.add_rigid_body("floor", box(0.1f), {.fixed = true}, {.position = {0, -0.1, 0}});
  scene.add_rigid_body("stylus", box(0.01f), {.density = 500.0}, {.position = {0, 0.02, 0}});
  EXPECT_FALSE(scene.add_handle("lever"));
  ASSERT_TRUE(scene.add_handle("stylus"));
  Session session = opened(scene);
  EXPECT_THAT(session.effectors(), testing::ElementsAre("stylus"));
  double y = 0.02;
  for (int i = 0; i < 2000; ++i) {
    y = std::max(0.005, y - 5e-5);
    ASSERT_TRUE(session.move("stylus", {0, y, 0}));
    ASSERT_TRUE(session.step());
  }
  const Reading felt = *session.reading("stylus");
  EXPECT_TRUE(felt.touching);
  const HandleParameters handle;  // its coupling saturates at max_force
  EXPECT_NEAR(felt.force.y, handle.max_force * std::tanh(handle.translation[0] * 0.005 / handle.max_force), 1e-3);
  std::vector<vec3> vertices;
  ASSERT_TRUE(session.vertices("stylus", vertices));
  for (const vec3 p : vertices) EXPECT_GT(p.y, -2e-4f);
  // The floor supports it: the sum of its contact forces equals the force on its handle and on the device.
  std::vector<BodyContact> contacts;
  ASSERT_TRUE(session.body_contacts(contacts));
  ASSERT_GE(contacts.size(), 3u);
  double push = 0.0;
  for (const BodyContact& contact : contacts) {
    EXPECT_NEAR(std::abs(contact.normal.y), 1.0, 1e-3);
    EXPECT_NEAR(contact.position.y, 0.0, 1e-3);
    push += std::abs(contact.force.y);
  }
  EXPECT_NEAR(push, felt.force.y, 0.05 * felt.force.y);
  std::vector<HandleReading> handles;
  ASSERT_TRUE(session.handles(handles));
  ASSERT_EQ(handles.size(), 1u);
  EXPECT_EQ(handles[0].tool, "stylus");
  EXPECT_NEAR(handles[0].position.y, 0.01, 1e-3);
}

TEST(Session, ADriverIsReadAndWrittenEveryTickWithinItsLimit) {
  Log log;
  {
    Session session = opened(press_scene());
    EXPECT_THAT(session.connect("finger", std::make_unique<LoggedDevice>(log), "broken").error().message(),
                HasSubstr("mend it"));
    ASSERT_TRUE(session.connect("finger", std::make_unique<LoggedDevice>(log)));
    EXPECT_FALSE(session.connect("finger", std::make_unique<LoggedDevice>(log))) << "one device a probe";
    lower(session, log, -0.004);
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(session.step());
    EXPECT_EQ(log.reads, static_cast<int>(session.figures().ticks));
    EXPECT_EQ(log.writes, log.reads);
    EXPECT_NEAR(log.last, 0.5, 1e-9) << "the law would have it 1.2 N";
    EXPECT_LE(log.largest, 0.5 + 1e-9);
    log.ready = false;
    ASSERT_TRUE(session.step());
    EXPECT_EQ(log.last, 0.0) << "its state is unknown";
    log.ready = true;
    ASSERT_TRUE(session.step(50));
    EXPECT_EQ(log.last, 0.0) << "it comes back 4 mm deep: the gate is closed";
    log.height = 0.001;
    ASSERT_TRUE(session.step(5));
    lower(session, log, -0.001);
    EXPECT_GT(log.last, 0.1);
    log.silent = true;
    ASSERT_TRUE(session.step(15));
    EXPECT_EQ(log.last, 0.0) << "no sample for 10 ms";
  }
  EXPECT_EQ(log.closed, 1) << "of the two that were opened, one was connected";
  EXPECT_EQ(log.last, 0.0);
}

TEST(Session, ARecordingGivesTheSameBitsAgain) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "session_recording";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const std::filesystem::path file = folder / "press.rec", csv = folder / "press.csv";
  dvec3 force(0);
  std::uint64_t ran = 0;
  {
    Session session = opened(press_scene());
    EXPECT_FALSE(session.end_recording());
    ASSERT_TRUE(session.record(file));
    EXPECT_FALSE(session.record(folder / "other.rec")) << "one is under way";
    press(session, 0.003);
    force = session.reading("finger")->force;
    ran = session.figures().ticks;
    EXPECT_FALSE(std::filesystem::exists(file)) << "it appears whole";
    ASSERT_TRUE(session.end_recording());
    EXPECT_FALSE(session.record(file)) << "it is there";
    EXPECT_FALSE(session.replay(file)) << "ticks have run";
    ASSERT_TRUE(session.restart());
    EXPECT_FALSE(session.replay(folder / "nothing.rec"));
    ASSERT_TRUE(session.replay(file));
    EXPECT_FALSE(session.start()) << "a replay is lockstep";
    std::uint64_t ticks = 0;
    while (session.step()) ++ticks;
    EXPECT_EQ(ticks, ran);
    EXPECT_EQ(session.reading("finger")->force, force);
  }
  Scene other("other");
  other.add_surface("tissue", sheet());
  other.add_probe("thumb");
  EXPECT_THAT(opened(other).replay(file).error().message(), HasSubstr("other probes"));
  ASSERT_TRUE(export_recording(file, csv));
  EXPECT_FALSE(export_recording(file, csv)) << "it is there";
  std::ifstream in(csv);
  std::string line, first;
  std::size_t lines = 0;
  for (; std::getline(in, line); ++lines)
    if (lines == 1) first = line;
  EXPECT_EQ(lines, ran + 1);
  EXPECT_EQ(first, "0,0,\"finger\",0,0.0005,0,1,0,0,0,1");
  std::filesystem::remove_all(folder);
}

TEST(Session, InRealTimeAPauseLetsGoAndComesBackThroughTheGate) {
  Log log;
  Session session = opened(press_scene());
  ASSERT_TRUE(session.connect("finger", std::make_unique<LoggedDevice>(log)));
  ASSERT_TRUE(session.start());
  for (int i = 0; i < 150; ++i) {
    log.height = 0.005 - 5e-5 * i;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ASSERT_TRUE(within_five_seconds([&] { return log.last > 0.2; }));
  EXPECT_GT(session.reading("finger")->force.y, 0.2);
  ASSERT_TRUE(session.pause(true));
  ASSERT_TRUE(within_five_seconds([&] { return log.last == 0.0; }));
  log.largest = 0.0;
  const int writes = log.writes;
  ASSERT_TRUE(within_five_seconds([&] { return log.writes > writes + 20; })) << "its watchdog is fed";
  EXPECT_EQ(log.largest, 0.0);
  ASSERT_TRUE(session.pause(false));
  const int resumed = log.writes;
  ASSERT_TRUE(within_five_seconds([&] { return log.writes > resumed + 100; }));
  EXPECT_EQ(log.largest, 0.0) << "2.5 mm deep, the gate stays closed";
  log.height = 0.002;
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  for (int i = 0; i < 150; ++i) {
    log.height = 0.002 - 3e-5 * i;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_TRUE(within_five_seconds([&] { return log.last > 0.2; })) << "out of contact once, it is open";
  ASSERT_TRUE(session.stop());
  EXPECT_EQ(log.last, 0.0) << "the last tick has every device lost";
}

TEST(Session, WhatADriverThrowsEndsTheRunWithZeroForce) {
  Log log;
  Session session = opened(press_scene());
  ASSERT_TRUE(session.connect("finger", std::make_unique<LoggedDevice>(log)));
  ASSERT_TRUE(session.start());
  ASSERT_TRUE(within_five_seconds([&] { return log.writes > 10; }));
  log.throws = true;
  ASSERT_TRUE(within_five_seconds([&] { return !session.running(); }));
  const Status stopped = session.stop();
  ASSERT_FALSE(stopped);
  EXPECT_THAT(stopped.error().message(), HasSubstr("cable cut"));
  EXPECT_EQ(log.last, 0.0);
}

TEST(Session, APosePrescribedOncePerPictureIsReachedWithoutALoss) {
  Session session = opened(press_scene());
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "session_live.rec";
  std::filesystem::remove(file);
  ASSERT_TRUE(session.record(file));
  ASSERT_TRUE(session.move("finger", {0, 0.001, 0}));
  ASSERT_TRUE(session.start());
  EXPECT_FALSE(session.set("finger", "nothing", 1.0));
  for (int i = 0; i < 40; ++i) {
    ASSERT_TRUE(session.move("finger", {0, 0.001 - 1e-4 * i, 0}));
    std::this_thread::sleep_for(std::chrono::milliseconds(16));
  }
  ASSERT_TRUE(within_five_seconds([&] {
    EXPECT_TRUE(session.move("finger", {0, -0.003, 0}));
    return std::abs(session.reading("finger")->force.y - 0.9) < 1e-3;
  }));
  ASSERT_TRUE(within_five_seconds([&] { return session.reading("finger")->force.y == 0.0; })) << "silence is a loss";
  ASSERT_TRUE(session.stop());
  const std::uint64_t ticks = session.figures().ticks - session.figures().overruns;
  ASSERT_TRUE(session.restart());
  ASSERT_TRUE(session.replay(file));
  ASSERT_TRUE(session.step(ticks - 1));
  EXPECT_FALSE(session.step(3)) << "every tick was recorded, the last one too";
  std::filesystem::remove(file);
}

TEST(Driver, IsKnownByItsNameOnce) {
  static Log log;
  ASSERT_TRUE(register_driver("logged", [] { return std::make_unique<LoggedDevice>(log); }));
  EXPECT_THAT(register_driver("logged", [] { return std::make_unique<LoggedDevice>(log); }).error().message(),
              HasSubstr("twice"));
  EXPECT_FALSE(register_driver("a:b", [] { return std::make_unique<LoggedDevice>(log); }));
  EXPECT_FALSE(register_driver("empty", nullptr));
  EXPECT_THAT(driver_names(), testing::Contains("logged"));
  EXPECT_THAT(make_driver("loged").error().message(), HasSubstr("drivers are: "));
  Session session = opened(press_scene());
  EXPECT_THAT(session.connect("finger", "logged:broken").error().message(), HasSubstr("mend it"));
  ASSERT_TRUE(session.connect("finger", "logged:2"));
  ASSERT_TRUE(session.step(3));
  EXPECT_EQ(log.writes, 3);
}

}  // namespace
}  // namespace pliant
