// Faults that need processes: one that is killed, stopped or crashes while a device is under force, and two that want
// the same device. The other end of a socket pair is the device.
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <cstring>
#include <functional>
#include <limits>

#include "devices/guard/last_resort.h"
#include "devices/servo/claim.h"
#include "devices/servo/device_identity.h"
#include "devices/servo/servo.h"

namespace pliant {
namespace {

// A device at the end of a socket: a double a packet, [N].
class SocketDriver final : public Driver {
 public:
  SocketDriver(int line, bool safe_line) : line_(line), safe_line_(safe_line) {}
  Status open(const std::string&) override { return Done{}; }
  DeviceCapabilities capabilities() const override { return {.max_force = 3.0, .rate = 1000.0}; }
  bool read(DeviceSample& sample) override {
    sample = {};
    sample.position.x = 1e-5 * (++reads_ % 7);
    return true;
  }
  void write(const DeviceWrench& wrench) override { send(wrench.force.y); }
  void close() override {}
  bool safe_line(SafeLine& line) const override {
    const double zero = 0.0;
    line.descriptor = line_;
    line.size = sizeof zero;
    std::memcpy(line.bytes.data(), &zero, sizeof zero);
    return safe_line_;
  }

 private:
  void send(double force) {
    [[maybe_unused]] const ssize_t sent = ::send(line_, &force, sizeof force, MSG_NOSIGNAL | MSG_DONTWAIT);
  }
  int line_ = -1, reads_ = 0;
  bool safe_line_ = false;
};

// The next force within five seconds; NaN: none.
double receive(int line) {
  pollfd watched{line, POLLIN, 0};
  double force = std::numeric_limits<double>::quiet_NaN();
  if (::poll(&watched, 1, 5000) == 1 && ::recv(line, &force, sizeof force, 0) == sizeof force) return force;
  return std::numeric_limits<double>::quiet_NaN();
}

// Waits for a force of about `wanted`. False: time-out.
bool comes(int line, double wanted) {
  for (int i = 0; i < 20000; ++i) {
    const double force = receive(line);
    if (std::isnan(force)) return false;
    if (std::abs(force - wanted) < 1e-6) return true;
  }
  return false;
}

// A separate process that keeps the device under 1 N, until a fault is injected.
struct Child {
  pid_t pid = -1;
  int line = -1;
  ~Child() {
    if (pid > 0) {
      ::kill(pid, SIGKILL);
      ::waitpid(pid, nullptr, 0);
    }
    ::close(line);
  }
};

[[noreturn]] void hold(int line, bool safe_line, const std::function<void(Servo&)>& then) {
  Servo servo(std::make_unique<SocketDriver>(line, safe_line));
  if (!servo.open("") || !servo.start()) ::_exit(3);
  double wanted = 0.0;
  for (int held = 0;;) {
    DeviceModel model;
    const bool again = held == 0 || (then && held < 500);  // a busy machine
    if (again && servo.state() == DeviceState::kTripped) servo.arm();
    if (again && !servo.felt()) wanted = 0.0;
    if (servo.felt()) wanted = std::min(1.0, wanted + 0.02);
    if (servo.felt() && wanted >= 1.0) ++held;
    model.wrench.force.y = wanted;
    servo.write_model(model, model.wrench);
    if (held == 500 && then) then(servo);
    ::usleep(1000);
  }
}

void start(Child& child, bool safe_line, const std::function<void(Servo&)>& then = {}) {
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends), 0);
  child.pid = ::fork();
  ASSERT_GE(child.pid, 0);
  if (child.pid == 0) {
    ::close(ends[0]);
    make_devices_safe_on_signals();
    hold(ends[1], safe_line, then);
  }
  ::close(ends[1]);
  child.line = ends[0];
}

TEST(ProcessFault, AfterKillNineTheGuardProcessSwitchesTheForceOff) {
  Child child;
  start(child, true);
  ASSERT_TRUE(comes(child.line, 1.0));
  ::kill(child.pid, SIGKILL);
  double last = 1.0;
  for (double force = receive(child.line); !std::isnan(force); force = receive(child.line)) last = force;
  EXPECT_EQ(last, 0.0) << "the last that the device heard, before its line closed";
}

TEST(ProcessFault, AStoppedProcessIsZeroedByItsGuardProcessAndTripsWhenItGoesOn) {
  Child child;
  start(child, true);
  ASSERT_TRUE(comes(child.line, 1.0));
  ::kill(child.pid, SIGSTOP);
  EXPECT_TRUE(comes(child.line, 0.0)) << "by the guard process";
  ::usleep(150'000);
  ::kill(child.pid, SIGCONT);
  for (int i = 0; i < 200; ++i) ASSERT_EQ(receive(child.line), 0.0) << "tripped: " << i;
}

// Sanitizers have handlers of their own.
#ifndef PLIANT_SANITIZED
void expect_zero_at_death(const std::function<void(Servo&)>& death, int signal) {
  Child child;
  start(child, false, death);
  ASSERT_TRUE(comes(child.line, 1.0));
  double last = 1.0;
  for (double force = receive(child.line); !std::isnan(force); force = receive(child.line)) last = force;
  EXPECT_EQ(last, 0.0);
  int status = 0;
  ASSERT_EQ(::waitpid(child.pid, &status, 0), child.pid);
  child.pid = -1;
  ASSERT_TRUE(WIFSIGNALED(status)) << "it still dies of its signal";
  EXPECT_EQ(WTERMSIG(status), signal);
}

TEST(ProcessFault, ACrashMakesEveryOpenDeviceSafeAndThenTakesItsCourse) {
  expect_zero_at_death([](Servo&) { ::raise(SIGSEGV); }, SIGSEGV);
  expect_zero_at_death([](Servo&) { std::abort(); }, SIGABRT);
  expect_zero_at_death([](Servo&) { ::raise(SIGTERM); }, SIGTERM);
}
#endif

TEST(ProcessFault, ByItselfNothingTouchesAProgramsSignalHandlers) {
  const pid_t child = ::fork();
  if (child == 0) {  // no test before this one has asked
    std::array<struct sigaction, NSIG> before{};
    for (int signal = 1; signal < NSIG; ++signal) ::sigaction(signal, nullptr, &before[signal]);
    Servo servo(std::make_unique<SocketDriver>(-1, false));
    if (!servo.open("")) ::_exit(100);
    for (int signal = 1; signal < NSIG; ++signal) {
      struct sigaction now {};
      if (::sigaction(signal, nullptr, &now) == 0 && now.sa_handler != before[signal].sa_handler) ::_exit(signal);
    }
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0) << "the handler of signal " << WEXITSTATUS(status) << " has changed";
}

TEST(ProcessFault, AWatchmanThatIsEndedInOrderWritesNothing) {
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends), 0);
  SafeLine line;
  line.descriptor = ends[1];
  line.size = 8;
  Watchman watchman;
  ASSERT_TRUE(watchman.start(line, 0.01));
  watchman.end();
  EXPECT_FALSE(watchman.watches());
  pollfd watched{ends[0], POLLIN, 0};
  EXPECT_EQ(::poll(&watched, 1, 0), 0);
  EXPECT_FALSE(watchman.start(SafeLine{})) << "no line";
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(ProcessFault, OneDeviceHasOneWriterHereAndInOtherPrograms) {
  const std::string device = "test-device:" + std::to_string(::getpid());
  DeviceClaim first, second;
  ASSERT_TRUE(first.take(device));
  const Status twice = second.take(device);
  ASSERT_FALSE(twice);
  EXPECT_THAT(twice.error().message(), testing::HasSubstr("moves another effector already"));
  int ready[2], done[2];
  ASSERT_EQ(::pipe(ready), 0);
  ASSERT_EQ(::pipe(done), 0);
  first.release();
  ASSERT_TRUE(second.take(device)) << "a claim that is released is free";
  second.release();
  const pid_t other = ::fork();
  if (other == 0) {
    DeviceClaim claim;
    const char held = claim.take(device) ? 'y' : 'n';
    char wait = 0;
    [[maybe_unused]] ssize_t size = ::write(ready[1], &held, 1);
    size = ::read(done[0], &wait, 1);
    ::_exit(0);
  }
  char held = 0;
  ASSERT_EQ(::read(ready[0], &held, 1), 1);
  ASSERT_EQ(held, 'y');
  const Status taken = first.take(device);
  EXPECT_FALSE(taken);
  if (!taken) EXPECT_THAT(taken.error().message(), testing::HasSubstr("is held by another program"));
  ASSERT_EQ(::write(done[1], &held, 1), 1);
  ::waitpid(other, nullptr, 0);
  EXPECT_TRUE(first.take(device)) << "a program that has ended holds nothing";
  for (const int end : {ready[0], ready[1], done[0], done[1]}) ::close(end);
}

// The same device in two processes, in every spelling and with any folders.
TEST(ProcessFault, EverySpellingOfADeviceIsThatDevice) {
  const std::string link = ::testing::TempDir() + "pliant-by-id-" + std::to_string(::getpid());
  ::unlink(link.c_str());
  ASSERT_EQ(::symlink("/dev/null", link.c_str()), 0);
  const std::pair<std::string, std::string> same[] = {
      {"network", "network:17716"},
      {"network:127.0.0.1:17716", "network:localhost:17716"},
      {"network:17716", "network:[::1]:17716"},
      {"network:17716", "network:[::ffff:127.0.0.1]:17716"},
      {"network:17716", "network:127.0.0.2:017716|delay=5ms"},
      {"network:17716,key=/a", "network:17716 ,key-env=B"},
      {"network:10.1.2.3:5", "network:[::ffff:10.1.2.3]:5"},
      {"serial:/dev/null", "serial:" + link + "@1000000"},
      {"serial:/dev/null", "serial:/dev/../dev//null|scale=2"},
      {"forcedimension", "forcedimension:0"},
      {"falcon", "falcon:/some/firmware.bin"},
  };
  for (const auto& [ours, theirs] : same) {
    int started[2], done[2];
    ASSERT_EQ(::pipe(started), 0);
    ASSERT_EQ(::pipe(done), 0);
    const pid_t other = ::fork();
    if (other == 0) {
      ::close(done[1]);
      ::setenv("XDG_RUNTIME_DIR", "/nonexistent", 1);
      DeviceClaim claim;
      char held = claim.take(theirs) ? 'y' : 'n';
      [[maybe_unused]] ssize_t size = ::write(started[1], &held, 1);
      size = ::read(done[0], &held, 1);
      ::_exit(0);
    }
    char held = '?';
    ASSERT_EQ(::read(started[0], &held, 1), 1);
    EXPECT_EQ(held, 'y') << theirs;
    const Status taken = DeviceClaim().take(ours);
    EXPECT_FALSE(taken) << ours << " and " << theirs;
    if (!taken)
      EXPECT_THAT(taken.error().message(),
                  testing::HasSubstr("is held by another program (process " + std::to_string(other) + ")"));
    for (const int end : {started[0], started[1], done[0], done[1]}) ::close(end);
    ::waitpid(other, nullptr, 0);
    EXPECT_TRUE(DeviceClaim().take(ours)) << "a program that has ended holds nothing";
  }
  ::unlink(link.c_str());
  EXPECT_NE(device_identity("network:10.1.2.3:5"), device_identity("network:10.1.2.3:6"));
  EXPECT_NE(device_identity("serial:/dev/null"), device_identity("serial:/dev/zero"));
  EXPECT_NE(device_identity("haply:A"), device_identity("haply:B"));
}

// A reopened line: the guard process writes to the new one.
TEST(ProcessFault, AGuardProcessGetsANewLine) {
  int first[2], second[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, first), 0);
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, second), 0);
  SafeLine line;
  line.descriptor = first[1];
  line.size = 3;
  line.bytes = {1, 2, 3};
  {
    Watchman watchman;
    ASSERT_TRUE(watchman.start(line, 0.05));
    line.descriptor = second[1];
    line.size = 2;
    line.bytes = {7, 8};
    watchman.renew(line);
    watchman.beat();
    std::uint8_t bytes[8] = {};
    pollfd watched{second[0], POLLIN, 0};
    ASSERT_EQ(::poll(&watched, 1, 5000), 1);
    EXPECT_EQ(::recv(second[0], bytes, sizeof bytes, 0), 2);
    EXPECT_EQ(bytes[0], 7);
    watched.fd = first[0];
    EXPECT_EQ(::poll(&watched, 1, 0), 0) << "nothing on the old one";
  }
  for (const int end : {first[0], first[1], second[0], second[1]}) ::close(end);
}

// A maker's library of another version: it is there, and one function is not.
class LibraryDriver final : public Driver {
 public:
  Status open(const std::string&) override {
    void* const library = ::dlopen("libc.so.6", RTLD_NOW);
    if (library && ::dlsym(library, "dhd_not_in_here")) return Done{};
    return Error{"library `libc.so.6`", "has no function `dhd_not_in_here`; install a newer version"};
  }
  bool read(DeviceSample&) override { return false; }
  void write(const DeviceWrench&) override { ADD_FAILURE() << "it was never open"; }
  void close() override {}
};

TEST(ProcessFault, ALibraryThatLacksASymbolIsNeverWrittenTo) {
  Servo servo(std::make_unique<LibraryDriver>());
  const Status opened = servo.open("");
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message(), testing::HasSubstr("dhd_not_in_here"));
  EXPECT_FALSE(servo.start());
}

}  // namespace
}  // namespace pliant
