// The driver here, and the example of a device in a process of its own: another hand's reading of the same document.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "devices/drivers/network_device.h"
#include "tests/drivers/until.h"

namespace pliant {
namespace {

struct OtherProcess {
  pid_t id = -1;
  int port = 0;
  explicit OtherProcess(const std::string& wanted_port) {
    int line[2];
    if (pipe2(line, O_CLOEXEC) != 0) return;
    id = fork();
    if (id == 0) {
      dup2(line[1], 1);
      execl(PLIANT_NETWORK_EXAMPLE, "network_device", wanted_port.c_str(), nullptr);
      _exit(127);
    }
    ::close(line[1]);
    char text[64] = {};
    const ssize_t got = ::read(line[0], text, sizeof text - 1);
    ::close(line[0]);
    if (got > 0) std::sscanf(text, "listening on %d", &port);
  }
  void end() {
    if (id <= 0) return;
    kill(id, SIGKILL);
    waitpid(id, nullptr, 0);
    id = -1;
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
  EXPECT_EQ(driver.counts().damaged, 0u);
  EXPECT_EQ(driver.counts().foreign, 0u);
  // A model is rendered there: a spring of 360 N/m to y = 10 mm beside its own 40 N/m to -10 mm holds it at 8 mm.
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
  // Nothing is written any more: it lets go by itself and its spring wins, while it goes on telling.
  bool down = false;
  for (const auto quiet = std::chrono::steady_clock::now() + std::chrono::milliseconds(900);
       !down && std::chrono::steady_clock::now() < quiet;) {
    driver.read(sample);
    down = sample.position.y < 0.0;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(down);
  // Killed, nothing comes; started again on its port, it is found.
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

}  // namespace
}  // namespace pliant
