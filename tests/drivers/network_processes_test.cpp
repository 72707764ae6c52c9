// The driver here, and the example device in a separate process: an independent implementation of the same document.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "devices/drivers/network_device.h"
#include "devices/drivers/network_endpoint.h"
#include "devices/servo/servo.h"
#include "tests/drivers/until.h"

namespace pliant {
namespace {

struct OtherProcess {
  pid_t id = -1;
  int port = 0;
  int said = -1;  // its output; a pipe without a reader would end it
  explicit OtherProcess(const std::string& wanted_port, const std::string& key = {}) {
    int line[2];
    if (pipe2(line, O_CLOEXEC) != 0) return;
    id = fork();
    if (id == 0) {
      dup2(line[1], 1);
      execl(PLIANT_NETWORK_EXAMPLE, "network_device", wanted_port.c_str(), key.empty() ? nullptr : key.c_str(),
            nullptr);
      _exit(127);
    }
    ::close(line[1]);
    char text[64] = {};
    const ssize_t got = ::read(line[0], text, sizeof text - 1);
    said = line[0];
    if (got > 0) std::sscanf(text, "listening on %d", &port);
  }
  void end() {
    if (id <= 0) return;
    kill(id, SIGKILL);
    waitpid(id, nullptr, 0);
    id = -1;
    ::close(said);
  }
  ~OtherProcess() { end(); }
};

TEST(NetworkProcesses, AHandleInAnotherProcessIsPushedStoppedAndFoundAgain) {
  OtherProcess device("0");
  ASSERT_GT(device.port, 0);
  NetworkDevice driver;
  const std::string id = std::to_string(device.port);
  const auto opened = driver.open(id);
  ASSERT_TRUE(opened) << opened.error().message();
  EXPECT_EQ(driver.name(), "example of a network device");
  EXPECT_NEAR(driver.capabilities().max_force, 3.0, 1e-6);
  EXPECT_TRUE(driver.capabilities().renders_force);
  EXPECT_FALSE(driver.capabilities().senses_rotation);
  DeviceSample sample;
  // Its spring pulls it to y = -10 mm; 0.4 N lift it by 10 mm.
  EXPECT_TRUE(runs_until(driver, sample, {}, [&](bool) { return sample.position.y < -0.009; })) << sample.position.y;
  EXPECT_TRUE(runs_until(driver, sample, {.force = {0, 0.4, 0}}, [&](bool) { return sample.position.y > -0.001; }));
  EXPECT_EQ(driver.counts().damaged(), 0u);
  EXPECT_EQ(driver.counts().foreign, 0u);
  // The device renders a model: a spring of 360 N/m to y = 10 mm and its own 40 N/m to -10 mm are in equilibrium at 8
  // mm.
  DeviceModel model;
  model.position = {0, 0.01, 0};
  model.force_by_position = dmat3(-360.0);
  model.force_by_velocity = dmat3(-4.0);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (std::abs(sample.position.y - 0.008) > 2e-4 && std::chrono::steady_clock::now() < end) {
    driver.read(sample);
    driver.write_model(model, {});
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_NEAR(sample.position.y, 0.008, 3e-4);
  // Nothing is written any more: its watchdog removes the force and its spring pulls it down, while it continues to
  // report.
  bool down = false;
  for (const auto quiet = std::chrono::steady_clock::now() + std::chrono::milliseconds(900);
       !down && std::chrono::steady_clock::now() < quiet;) {
    driver.read(sample);
    down = sample.position.y < 0.0;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(down);
  // Killed, it does not respond; restarted on its port, it is found.
  device.end();
  int quiet = 0;
  EXPECT_TRUE(runs_until(driver, sample, {.force = {0, 0.4, 0}}, [&](bool came) {
    quiet = came ? 0 : quiet + 1;
    return quiet > 50;
  }));
  OtherProcess again(id);
  ASSERT_EQ(again.port, device.port);
  EXPECT_TRUE(runs_until(driver, sample, {}, [&](bool came) { return came && sample.ready; }));
  driver.close();
}

// A key in a file readable only by its user; removed afterwards.
struct KeyFile {
  std::string path;
  KeyFile(const char* name, const std::string& key, mode_t mode = 0600)
      : path(::testing::TempDir() + name + std::to_string(getpid())) {
    std::ofstream(path) << key << "\n";
    chmod(path.c_str(), mode);
  }
  ~KeyFile() { std::remove(path.c_str()); }
};

// An engine that keeps serving its device while this thread waits for something else.
struct Kept {
  explicit Kept(NetworkDevice& driver)
      : thread([&driver](const std::stop_token& stop) {
          for (DeviceSample sample; !stop.stop_requested(); usleep(1000)) {
            driver.read(sample);
            driver.write({});
          }
        }) {}
  void end() const { thread = {}; }
  mutable std::jthread thread;
};

TEST(NetworkProcesses, AKeyLetsInWhoHasItAndNobodyElse) {
  const KeyFile key("key", "a secret of some length"), other("other", "another one, as long as it");
  OtherProcess device("0", key.path);
  ASSERT_GT(device.port, 0);
  const std::string port = std::to_string(device.port);
  NetworkDevice without;
  const auto unheard = without.open(port);
  ASSERT_FALSE(unheard);
  EXPECT_NE(unheard.error().message().find("key"), std::string::npos) << unheard.error().message();
  NetworkDevice wrong;
  EXPECT_FALSE(wrong.open(port + ",key=" + other.path));
  NetworkDevice right;
  const auto opened = right.open(port + ",key=" + key.path);
  ASSERT_TRUE(opened) << opened.error().message();
  DeviceSample sample;
  EXPECT_TRUE(runs_until(right, sample, {.force = {0, 0.4, 0}}, [&](bool) { return sample.position.y > -0.001; }));
  EXPECT_EQ(right.dropped().damaged() + right.dropped().key, 0u);
  // A second engine gets the name of the one that has the device, but only with the key.
  NetworkDevice second;
  const Kept kept(right);
  const auto busy = second.open(port + ",key=" + key.path);
  kept.end();
  ASSERT_FALSE(busy);
  EXPECT_NE(busy.error().message().find("is in use by the engine at 127.0.0.1:"), std::string::npos)
      << busy.error().message();
  right.close();
  EXPECT_TRUE(second.open(port + ",key=" + key.path)) << "closed, it is free";
  second.close();
}

TEST(NetworkProcesses, AKeyedDeviceThatWasStartedAgainIsFound) {
  const KeyFile key("key", "a secret of some length");
  OtherProcess device("0", key.path);
  ASSERT_GT(device.port, 0);
  NetworkDevice driver;
  ASSERT_TRUE(driver.open(std::to_string(device.port) + ",key=" + key.path));
  DeviceSample sample;
  EXPECT_TRUE(runs_until(driver, sample, {}, [](bool came) { return came; }));
  device.end();
  int quiet = 0;
  EXPECT_TRUE(runs_until(driver, sample, {}, [&](bool came) {
    quiet = came ? 0 : quiet + 1;
    return quiet > 50;
  }));
  OtherProcess again(std::to_string(device.port), key.path);
  EXPECT_TRUE(runs_until(driver, sample, {}, [&](bool came) { return came && sample.ready; }));
}

TEST(NetworkProcesses, ASecondEngineHearsWhoHasTheDevice) {
  OtherProcess device("0");
  ASSERT_GT(device.port, 0);
  NetworkDevice first, second;
  ASSERT_TRUE(first.open(std::to_string(device.port)));
  const Kept kept(first);
  const auto busy = second.open(std::to_string(device.port));
  ASSERT_FALSE(busy);
  EXPECT_NE(busy.error().message().find("is in use by the engine at 127.0.0.1:"), std::string::npos)
      << busy.error().message();
}

TEST(NetworkProcesses, AKeyThatEveryoneMayReadOrThatIsTooShortIsNone) {
  const KeyFile open_to_all("open", "a secret of some length", 0644), brief("brief", "short");
  for (const auto& [words, why] : {std::pair<std::string, std::string>("17716,key=" + open_to_all.path, "chmod 600"),
                                   {"17716,key=" + brief.path, "16 to 4096"},
                                   {"17716,key=/nowhere", "cannot be read"},
                                   {"17716,key-env=PLIANT_NO_SUCH_KEY", "is not set"},
                                   {"17716,a secret", "never given there"}}) {
    NetworkDevice driver;
    const auto refused = driver.open(words);
    ASSERT_FALSE(refused) << words;
    EXPECT_NE(refused.error().message().find(why), std::string::npos) << refused.error().message();
  }
}

// Runs the real program: if it is killed, the guard process closes the device.
TEST(NetworkProcesses, AfterKillNineAGuardProcessClosesTheDevice) {
  const KeyFile key("key", "a secret of some length");
  auto port = UdpPort::listen({"127.0.0.1", "0"});
  ASSERT_TRUE(port);
  const int number = (*port)->port();
  NetworkEndpoint device(std::move(*port), {.max_force = 3.0, .rate = 1000.0}, "handle", monotonic_seconds,
                         *FrameKey::from_file(key.path));
  const pid_t engine = fork();
  if (engine == 0) {
    Servo servo(std::make_unique<NetworkDevice>());
    if (!servo.open(std::to_string(number) + ",key=" + key.path) || !servo.start()) _exit(3);
    for (;;) usleep(1000);
  }
  const auto turns = [&](double seconds, auto&& until) {
    for (const double end = monotonic_seconds() + seconds; monotonic_seconds() < end; usleep(500)) {
      device.tick({});
      if (until()) return true;
    }
    return false;
  };
  ASSERT_TRUE(turns(20.0, [&] { return device.counts().accepted > 300; }));
  kill(engine, SIGKILL);
  waitpid(engine, nullptr, 0);
  const double killed = monotonic_seconds();
  EXPECT_TRUE(turns(20.0, [&] { return !device.opened(); }));
  RecordProperty("closed_after_ms", std::to_string(1e3 * (monotonic_seconds() - killed)));
  EXPECT_TRUE(device.closed()) << "by a frame, and not because nothing came for a second";
}

}  // namespace
}  // namespace pliant
